//! The story of a claim, and what is said to a name that is none.

use crate::folder::Folder;
use crate::{committed, list, report, repository};
use serde_json::Value;

fn told(arguments: &[&str]) -> crate::folder::Ran {
    let reports = repository("reports");
    let mut all = vec!["explain"];
    all.extend_from_slice(arguments);
    all.extend(["--reports", reports.to_str().expect("UTF-8")]);
    Folder::new().run_arguments(&all)
}

#[test]
fn a_claim_is_told_with_formula_citation_and_evidence() {
    let ran = told(&["fatehi-table-2/sum_dw#disorder"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    for part in [
        "Σω∇W = O(d̃/h² (Δ/h)^{β−1})",
        "rms |Σω∇W − reg| = O(d̃ h^{-2} (Δ/h)^{β−1})",
        "Fatehi & Manzari (2011), Table 2, row 1",
        "Error estimation in Smoothed Particle Hydrodynamics",
        "doi:10.1016/j.camwa.2010.11.028 [fatehi-manzari-2011]",
        "Found by fatehi-table-2: conditional, as its scene expects",
        "Found by moment-orders: ",
        "published 1, 2, derived 1, 1/2",
        "cases more: add --all",
    ] {
        assert!(ran.stdout.contains(part), "'{part}' is not in:\n{}", ran.stdout);
    }
    let all = told(&["fatehi-table-2/sum_dw#disorder", "--all"]);
    assert!(all.stdout.len() > 2 * ran.stdout.len() && !all.stdout.contains("add --all"));
}

#[test]
fn every_claim_of_every_report_has_its_story() {
    let reports: Vec<(String, Value)> =
        committed().into_iter().map(|name| (name.clone(), report(&name))).collect();
    let group = |verdict: &Value| {
        let id = verdict["id"].as_str().expect("an id");
        id.split('/').next().unwrap_or_default().to_owned()
    };
    let mut groups: Vec<String> =
        reports.iter().flat_map(|(_, report)| list(&report["verdicts"]).iter().map(group)).collect();
    groups.sort();
    groups.dedup();
    let mut told_of = 0;
    for group in groups {
        let ran = told(&[&group, "--json"]);
        assert_eq!(ran.code, 0, "{group}: {}", ran.stderr);
        let stories: Value = serde_json::from_str(&ran.stdout).expect("JSON");
        for story in list(&stories) {
            let id = &story["id"];
            let cited =
                reports.iter().flat_map(|(_, report)| list(&report["claims"])).find(|c| c["id"] == *id);
            let of_paper = cited.is_none_or(|claim| claim["citation"]["source"] != "scene");
            assert_eq!(
                story["paper"]["bibtex"].as_str().is_some_and(|text| text.starts_with('@')),
                of_paper,
                "{id}"
            );
            for evidence in list(&story["evidence"]) {
                told_of += 1;
                let report = reports.iter().find(|(name, _)| evidence["scene"] == name.as_str());
                let report = report.map(|(_, report)| report).expect("a committed report");
                let verdict = list(&report["verdicts"]).iter().find(|verdict| verdict["id"] == *id);
                assert_eq!(Some(&evidence["rolled"]), verdict);
                let cases = list(&report["claims"]).iter().filter(|claim| claim["id"] == *id);
                assert_eq!(list(&evidence["cases"]).len(), cases.count(), "{id}");
            }
        }
    }
    let verdicts = reports.iter().map(|(_, report)| list(&report["verdicts"]).len());
    assert_eq!(told_of, verdicts.sum::<usize>());
}

#[test]
fn a_slip_gets_suggestions_and_no_reports_get_the_catalogue() {
    let ran = told(&["fatehi-table-2/sum_dw#disordr"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    ran.says(&[
        "there is no claim 'fatehi-table-2/sum_dw#disordr'",
        "did you mean fatehi-table-2/sum_dw#disorder, ",
    ]);
    assert_eq!(told(&["zzz"]).code, 2);
    let folder = Folder::new();
    let ran = folder.run_to(0, "explain basa-6/neighbours");
    for part in ["Basa, Quinlan & Lastiwka (2009)", "No report judges it yet", "Checked\n  value = "] {
        assert!(ran.stdout.contains(part), "'{part}' is not in:\n{}", ran.stdout);
    }
    // One report that cannot be read does not silence the others.
    folder.write("reports/bad/report.json", "{\"schema\": \"remainder-report/9\"}");
    folder.write("reports/good/report.json", report("fatehi-table-1").to_string());
    let ran = folder.run_to(0, "explain fatehi-table-1/F4");
    assert!(ran.stderr.is_empty(), "what says nothing of the claim is not read: {}", ran.stderr);
    assert!(ran.stdout.contains("Found by fatehi-table-1: confirmed"), "{}", ran.stdout);
    folder.write(
        "reports/bad/report.json",
        "{\"schema\": \"remainder-report/9\", \"of\": \"fatehi-table-1/F4\"}",
    );
    let again = folder.run_to(0, "explain fatehi-table-1/F4");
    again.says(&["left out: ", "newer than"]);
    assert_eq!(again.stdout, ran.stdout);
}
