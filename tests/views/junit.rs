//! JUnit: a suite per report, a test case per claim; failures where the verdict is another than expected.

use crate::folder::Folder;
use crate::{committed, list, report, repository};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use serde_json::json;
use std::collections::BTreeMap;

/// A test case as a reader of JUnit sees it.
#[derive(Debug, Default)]
struct Case {
    name: String,
    /// `failure`, `skipped` or `system-out`.
    outcome: String,
    message: String,
}

/// The counts of each suite (the outermost first), and the cases.
fn read(text: &str) -> (Vec<BTreeMap<String, String>>, Vec<Case>) {
    let mut reader = Reader::from_str(text);
    let attributes = |tag: &BytesStart<'_>| -> BTreeMap<String, String> {
        let pairs = tag.attributes().map(|attribute| attribute.expect("an attribute"));
        let pair = |a: quick_xml::events::attributes::Attribute<'_>| {
            let value = quick_xml::escape::unescape(&a.value).expect("escaped").into_owned();
            (a.key.as_ref().to_owned(), value)
        };
        pairs.map(pair).collect()
    };
    let (mut suites, mut cases) = (Vec::new(), Vec::<Case>::new());
    let mut depth = 0;
    loop {
        let event = reader.read_event().unwrap_or_else(|error| panic!("{error}:\n{text}"));
        match event {
            Event::Start(tag) | Event::Empty(tag) => {
                let name = tag.name().as_ref().to_owned();
                match name.as_str() {
                    "testsuites" | "testsuite" => suites.push(attributes(&tag)),
                    "testcase" => {
                        cases.push(Case { name: attributes(&tag)["name"].clone(), ..Case::default() });
                    }
                    "failure" | "skipped" | "system-out" => {
                        let case = cases.last_mut().expect("inside a case");
                        assert!(case.outcome.is_empty(), "two outcomes: {case:?}");
                        case.message = attributes(&tag).remove("message").unwrap_or_default();
                        case.outcome = name;
                    }
                    "properties" | "property" => {}
                    other => panic!("<{other}>"),
                }
                depth += 1;
            }
            Event::Text(inner) if depth > 0 => {
                if let Some(case) = cases.last_mut().filter(|case| case.outcome == "system-out") {
                    if case.message.is_empty() {
                        case.message = inner.to_string();
                    }
                }
            }
            Event::Eof => return (suites, cases),
            _ => {}
        }
    }
}

#[test]
fn the_committed_reports_pass_and_say_what_was_refuted() {
    let folder = Folder::new();
    let names = committed();
    let paths = names.iter().map(|name| repository("reports").join(name).to_string_lossy().into_owned());
    let mut arguments = vec!["report".to_owned()];
    arguments.extend(paths);
    arguments.extend(["--junit".to_owned(), "deep/er/junit.xml".to_owned()]);
    let ran = folder.run_arguments(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let (suites, cases) = read(&folder.text("deep/er/junit.xml"));
    assert_eq!(suites.len(), 1 + names.len());
    let verdicts: Vec<_> = names.iter().flat_map(|name| list(&report(name)["verdicts"]).to_vec()).collect();
    assert_eq!(cases.len(), verdicts.len());
    assert_eq!(suites[0]["tests"], verdicts.len().to_string());
    assert_eq!(suites[0]["failures"], "0");
    let open = verdicts.iter().filter(|verdict| verdict["verdict"] == "inconclusive").count();
    assert_eq!(suites[0]["skipped"], open.to_string());
    for (case, verdict) in cases.iter().zip(&verdicts) {
        assert_eq!(case.name, verdict["id"].as_str().expect("an id"));
        if verdict["verdict"] == "refuted" {
            assert_eq!(case.outcome, "system-out", "{case:?}");
            assert!(case.message.starts_with("refuted, as expected: "), "{case:?}");
        }
    }
}

#[test]
fn another_verdict_fails_and_an_open_one_is_skipped() {
    let folder = Folder::new();
    let mut report = report("fatehi-table-1");
    let verdicts = report["verdicts"].as_array_mut().expect("verdicts");
    verdicts.truncate(5);
    let set = |index: usize, verdict: &str, expected: Option<&str>, verdicts: &mut Vec<serde_json::Value>| {
        verdicts[index]["verdict"] = json!(verdict);
        verdicts[index]["why"] = json!(format!("because <{index}> & \"so\""));
        match expected {
            Some(expected) => verdicts[index]["expected"] = json!(expected),
            None => drop(verdicts[index].as_object_mut().expect("a verdict").remove("expected")),
        }
    };
    set(0, "refuted", Some("confirmed"), verdicts);
    set(1, "inconclusive", Some("confirmed"), verdicts);
    set(2, "inconclusive", None, verdicts);
    set(3, "refuted", None, verdicts);
    set(4, "refuted", Some("refuted"), verdicts);
    folder.write("one/report.json", report.to_string());
    folder.run_to(0, "report one --junit junit.xml");
    let text = folder.text("junit.xml");
    let (suites, cases) = read(&text);
    for suite in &suites {
        let counts = ["tests", "failures", "errors", "skipped"].map(|key| suite[key].as_str());
        assert_eq!(counts, ["5", "1", "0", "2"]);
    }
    let outcomes: Vec<&str> = cases.iter().map(|case| case.outcome.as_str()).collect();
    assert_eq!(outcomes, ["failure", "skipped", "skipped", "system-out", "system-out"]);
    assert_eq!(cases[0].message, "refuted, expected confirmed: because <0> & \"so\"");
    assert_eq!(cases[1].message, "inconclusive, expected confirmed: because <1> & \"so\"");
    assert_eq!(cases[2].message, "inconclusive: because <2> & \"so\"");
    assert!(text.contains("refuted, as expected: because"), "{text}");
}

#[test]
fn a_run_writes_the_same() {
    let folder = Folder::with_scene(QUICK);
    let ran = folder.run_to(0, "run small.toml --junit out/run.xml --csv out/csv");
    ran.says(&["Written to out/csv.", "Written to out/run.xml."]);
    folder.run_to(0, "report reports/small --junit out/report.xml --csv out/again");
    assert_eq!(folder.bytes("out/run.xml"), folder.bytes("out/report.xml"));
    assert_eq!(folder.bytes("out/csv/small/fits.csv"), folder.bytes("out/again/small/fits.csv"));
}

/// Exact sums on a line, in a fraction of a second.
const QUICK: &str = r#"
[cases]
kernels = ["wendland-c2"]
lattices = ["line"]
[claims]
use = ["fatehi-eq-33"]
[[ladders.regular]]
dimension = 1
from = 4
to = 32
rungs = 6
offsets = 4
"#;
