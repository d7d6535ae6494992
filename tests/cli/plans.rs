//! `plan` says what will run, and that is what runs; `schema` and `list`.

use crate::folder::Folder;
use crate::scenes::{DISORDERED, REGULAR, SMALL};
use serde_json::Value;
use std::collections::BTreeSet;

fn plan(folder: &Folder, scene: &str) -> Value {
    serde_json::from_str(&folder.run_to(0, &format!("plan {scene} --json")).stdout).expect("JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no count"))
}

/// Which case a stored block belongs to: its name up to the size of the block, and its number.
fn key_of(name: &str) -> String {
    name.split(['-', '.']).next().expect("a key").to_owned()
}

#[test]
fn a_plan_is_what_runs() {
    let folder = Folder::with_scene(SMALL);
    let plan = plan(&folder, "small.toml");
    assert!(!folder.path(".remainder").exists(), "planning computes nothing");
    folder.run_to(0, "run small.toml --store store");
    let cost = &folder.json("reports/small/report.json")["cost"];
    let blocks = folder.blocks("store");
    let sum = |field: &str| blocks.values().filter_map(|block| block["data"][field].as_u64()).sum::<u64>();

    assert_eq!(plan["exact_sums"], cost["exact_sums"]);
    assert_eq!(number(&cost["exact_sums"]), sum("exact_sums"));
    assert!(number(&cost["exact_sums"]) > 0);
    // 1 + 1 components of b_inverse and sum_ddw on the line; 1 + 1 left by the symmetry of the square.
    assert_eq!(number(&plan["exact_sums"]), 2 * 6 * 4 + 2 * 5 * 3);

    assert_eq!(number(&cost["samples"]), sum("samples"));
    assert_eq!(number(&cost["pairs"]), sum("pairs"));
    assert!(number(&cost["samples"]) <= number(&plan["most_samples"]));
    // offset: 7 rungs of 5 offsets, and 7 of 1 (eight steps from 3 to 12 round to seven whole R/Δ); box: the
    // half-integers alone; both: 9 and 10 amplitudes.
    let tasks = (7 * 5 + 7) + (7 + 7) + 2 * (9 + 10);
    assert_eq!(number(&plan["most_samples"]), tasks * 3 * 8);
    // The wanted precision was reached early somewhere, and the report says what that saved.
    let spared = number(&plan["most_samples"]) - number(&cost["samples"]);
    assert!(spared > 0 && number(&cost["samples"]) >= tasks * 2 * 8);
    let report = folder.json("reports/small/report.json");
    let saved = format!("{spared} of {} samples", plan["most_samples"]);
    let said =
        list(&report["left_out"]).iter().find(|item| item["what"] == "samples past the wanted precision");
    assert_eq!(said.map(|item| &item["saved"]), Some(&Value::from(saved)));
    // Some tasks took all their blocks and stay short of the precision: the report does not say they reached it.
    let least = list(&report["fits"]).iter().flat_map(|fit| list(&fit["points"])).filter(|point| {
        let ratio = point["y_error"].as_f64().zip(point["y"].as_f64()).map_or(0.0, |(error, y)| error / y);
        ratio > 0.1 && point["samples"] == 3 * 8
    });
    assert!(least.count() > 0);
    let why = said.and_then(|item| item["why"].as_str()).expect("a reason");
    assert!(why.starts_with("sampling stopped where"), "{why}");
    // Everything else that the report says was left out, the plan says too.
    let items = |value: &Value| -> Vec<[Value; 3]> {
        list(value).iter().map(|item| ["what", "why", "saved"].map(|field| item[field].clone())).collect()
    };
    let (planned, reported) = (items(&plan["left_out"]), items(&report["left_out"]));
    assert_eq!(reported[..reported.len() - 1], planned[..]);

    let planned: BTreeSet<String> =
        list(&plan["tasks"]).iter().map(|task| task["key"].as_str().expect("a key").to_owned()).collect();
    let ran: BTreeSet<String> = blocks.keys().map(|name| key_of(name)).collect();
    assert_eq!(planned, ran);
    let pairs: u64 = list(&plan["tasks"]).iter().map(|task| number(&task["pairs"])).sum();
    assert_eq!(pairs, number(&plan["most_pairs"]));
}

#[test]
fn a_plan_lists_what_the_scene_does_not_need() {
    let folder = Folder::with_scene(SMALL);
    let plan = plan(&folder, "small.toml");
    let left_out = |what: &str| {
        let found = list(&plan["left_out"])
            .iter()
            .find(|item| item["what"].as_str().is_some_and(|w| w.starts_with(what)));
        found.unwrap_or_else(|| panic!("'{what}' is not among {:#}", plan["left_out"])).clone()
    };
    let says = |item: &Value, field: &str, text: &str| {
        assert!(item[field].as_str().is_some_and(|said| said.contains(text)), "'{text}' is not in {item}");
    };
    // By symmetry: odd moments vanish at a site, and the square leaves one component of a symmetric second-rank tensor.
    says(&left_out("sum_dw on regular line"), "why", "symmetry");
    says(&left_out("sum_dw on regular square"), "why", "symmetry");
    let components = left_out("components of b_inverse on square");
    says(&components, "why", "2 vanish and 1 equal another");
    says(&components, "why", "(8 operations)");
    says(&components, "saved", "3 of 4 exact sums");
    // Moments, dimensions and kernels that nobody asks for.
    let moments = left_out("moments ");
    for name in ["sum_w", "sum_rrdw", "sum_rlapw"] {
        says(&moments, "what", name);
    }
    assert!(!moments["what"].as_str().is_some_and(|what| what.contains("b_inverse")), "{moments}");
    assert_eq!(left_out("dimension ")["what"], "dimension 3");
    says(&left_out("kernels "), "what", "wendland-c4");
    says(&left_out("offsets of R/Δ under box"), "why", "do not oscillate");
    // The same in words, and none of it is computed.
    let text = folder.run_to(0, "plan small.toml").stdout;
    let (computed, rest) = text.split_once("\nLeft out:\n").expect("two parts");
    for item in list(&plan["left_out"]) {
        assert!(rest.contains(item["what"].as_str().expect("text")), "{rest}");
    }
    assert!(computed.contains("wendland-c2") && computed.contains("square"), "{computed}");
    assert!(!computed.contains("wendland-c4") && !computed.contains("simple-cubic"), "{computed}");
    assert!(
        computed.contains(&format!(
            "{} exact sums; at most {} samples",
            plan["exact_sums"], plan["most_samples"]
        ))
    );
}

#[test]
fn regular_claims_take_no_samples() {
    let scene = SMALL.replace("\"fatehi-eq-33\", \"fatehi-eq-28\", \"fatehi-eq-38\"", "\"fatehi-eq-33\"");
    assert_ne!(scene, SMALL);
    let folder = Folder::with_scene(&scene);
    let plan = plan(&folder, "small.toml");
    assert_eq!((number(&plan["most_samples"]), list(&plan["tasks"]).len()), (0, 6 + 5));
    let omitted = list(&plan["left_out"]).iter().any(|item| item["what"] == "all disordered particles");
    assert!(omitted, "{:#}", plan["left_out"]);
    folder.run_to(0, "run small.toml --store store");
    let cost = &folder.json("reports/small/report.json")["cost"];
    assert_eq!((number(&cost["samples"]), number(&cost["pairs"])), (0, 0));
    assert_eq!(cost["exact_sums"], plan["exact_sums"]);
    assert!(folder.blocks("store").values().all(|block| block["data"]["samples"].is_null()));
    assert_eq!(folder.blocks("store").len(), 6 + 5);
}

#[test]
fn what_symmetry_settles_takes_nothing() {
    let folder = Folder::with_scene(&format!("[claims]\nuse = [\"fatehi-eq-28\"]\n{REGULAR}"));
    let plan = plan(&folder, "small.toml");
    assert_eq!((number(&plan["exact_sums"]), list(&plan["tasks"]).len()), (0, 0));
    folder.run_to(0, "run small.toml --store store");
    let report = folder.json("reports/small/report.json");
    assert_eq!(number(&report["cost"]["exact_sums"]), 0);
    assert!(!folder.path("store").exists());
    assert_eq!(report["claims"][0]["measured"]["zero"]["by"], "symmetry");
    assert_eq!(report["verdicts"][0]["verdict"], "confirmed");
}

#[test]
fn more_claims_on_one_moment_take_no_more_sums() {
    let folder = Folder::with_scene(&format!("[claims]\nuse = [\"fatehi-eq-33\"]\n{REGULAR}"));
    folder.write(
        "more.toml",
        format!("[claims]\nuse = [\"fatehi-eq-32/b_inverse#regular\", \"fatehi-eq-33\"]\n{REGULAR}"),
    );
    let (one, two) = (plan(&folder, "small.toml"), plan(&folder, "more.toml"));
    assert_eq!(one["tasks"], two["tasks"]);
    assert_eq!(one["exact_sums"], two["exact_sums"]);
    // Another moment is another case: no block of the one stands for the other.
    folder.write("other.toml", format!("[claims]\nuse = [\"fatehi-eq-36\"]\n{REGULAR}"));
    let keys = |plan: &Value| -> BTreeSet<String> {
        list(&plan["tasks"]).iter().map(|task| task["key"].to_string()).collect()
    };
    assert!(keys(&one).is_disjoint(&keys(&plan(&folder, "other.toml"))));
}

#[test]
fn the_scene_schema_takes_scenes_and_refuses_others() {
    let folder = Folder::new();
    let schema: Value = serde_json::from_str(&folder.run_to(0, "schema scene").stdout).expect("JSON");
    assert!(jsonschema::meta::is_valid(&schema), "not a JSON Schema");
    let validator = jsonschema::validator_for(&schema).expect("a JSON Schema");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let table = std::fs::read_to_string(root.join("analyses/fatehi-table-2/scene.toml")).expect("the scene");
    for text in [table.as_str(), SMALL] {
        let scene: Value = toml::from_str(text).expect("TOML");
        let faults: Vec<String> = validator.iter_errors(&scene).map(|error| error.to_string()).collect();
        assert!(faults.is_empty(), "{faults:#?}");
        let mut unknown = scene.clone();
        unknown["study"]["colour"] = "red".into();
        assert!(!validator.is_valid(&unknown));
        let mut without = scene.clone();
        without.as_object_mut().expect("a table").remove("cases");
        assert!(!validator.is_valid(&without));
    }
}

#[test]
fn what_is_listed_can_be_named() {
    let folder = Folder::new();
    let all: Value = serde_json::from_str(&folder.run_to(0, "list --json").stdout).expect("JSON");
    let names: Vec<&String> = all.as_object().expect("an object").keys().collect();
    assert_eq!(names, ["claims", "disorders", "kernels", "lattices", "moments", "operators", "volume_rules"]);
    let claims: Value = serde_json::from_str(&folder.run_to(0, "list claims --json").stdout).expect("JSON");
    assert_eq!(claims.as_object().map(serde_json::Map::len), Some(1));
    assert_eq!(claims["claims"], all["claims"]);
    let ids = |group: &str| -> Vec<String> {
        list(&all[group]).iter().map(|entry| entry["id"].as_str().expect("an id").to_owned()).collect()
    };
    // The rows of Table 2 with their citation.
    let table = list(&all["claims"]).iter().filter(|entry| {
        entry["id"].as_str().is_some_and(|id| id.starts_with("fatehi-table-2/"))
            && entry["source"]
                .as_str()
                .is_some_and(|source| source.starts_with("fatehi-manzari-2011, Table 2, row "))
    });
    let rows: BTreeSet<String> = table
        .map(|entry| {
            entry["source"]
                .as_str()
                .expect("text")
                .chars()
                .filter(char::is_ascii_digit)
                .skip(5)
                .take(1)
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 7, "{rows:?}");
    let text = folder.run_to(0, "list").stdout;
    let scene = format!(
        "[cases]\nkernels = {:?}\nlattices = {:?}\nvolume_rules = {:?}\ndisorders = [{}]\n[claims]\nuse = {:?}\n",
        ids("kernels"),
        ids("lattices"),
        ids("volume_rules"),
        ids("disorders")
            .iter()
            // Rows slide in a plane; this scene has a line as well.
            .filter(|id| *id != "shear")
            .map(|id| match id.as_str() {
                "none" => "\"none\"".into(),
                "wave" => "\"wave:0.05,wavelength=1\"".into(),
                _ => format!("\"{id}:0.03\""),
            })
            .collect::<Vec<_>>()
            .join(", "),
        ids("claims")
    );
    let own = ids("moments").into_iter().enumerate().map(|(index, moment)| {
        assert!(text.contains(&moment), "{text}");
        let letters = |letter: char| moment.trim_start_matches("sum_").chars().filter(|c| *c == letter).count() as i64;
        // p − q, the power of h that each moment has: b_inverse is Σ ω r ∇W.
        let power = match moment.as_str() {
            "b_inverse" => 0,
            name if name.ends_with("lapw") => letters('r') - 2,
            _ => letters('r') - letters('d'),
        };
        format!(
            "[[claims.own]]\nname = \"own{index}\"\nmoment = \"{moment}\"\nquantity = \"regular-value\"\nh = \"{power}\"\ndx_over_h = \"0\"\n"
        )
    });
    folder.write("all.toml", scene + &own.collect::<String>());
    let plan = plan(&folder, "all.toml");
    assert_eq!(list(&plan["claims"]).len(), ids("claims").len() + ids("moments").len());
    assert!(
        !list(&plan["left_out"])
            .iter()
            .any(|item| item["what"].as_str().is_some_and(|what| what.starts_with("moments ")))
    );
}

/// Exact sums and samples that each needs, by hand: what symmetry settles takes nothing, a component that equals another is
/// summed once, and so is a moment that two claims ask for; disorder is laid only where it is asked for.
#[test]
fn ten_scenes_take_what_they_need() {
    // Places on the ladders: 6 steps of 4 offsets, 5 of 3, 5 of 2; under disorder 5 steps and 5 amplitudes of 8 samples.
    let [line, square, cube, disordered] = [6 * 4, 5 * 3, 5 * 2, (5 + 5) * 8];
    let scenes = [
        // Σω∇W and Σωrr∇W are odd.
        (["wendland-c2"].as_slice(), ["line"].as_slice(), "fatehi-eq-28\", \"fatehi-eq-29", 0, 0),
        // B⁻¹ is a multiple of 1 on all three lattices: one of 1, 4 and 9 components.
        (&["wendland-c2"], &["line"], "fatehi-eq-33", line, 0),
        (&["wendland-c2"], &["square"], "fatehi-eq-33", square, 0),
        (&["wendland-c2"], &["simple-cubic"], "fatehi-eq-33", cube, 0),
        // Offsets go through one spacing of h, which is two of R for the spline.
        (&["wendland-c2", "cubic-spline"], &["line", "square"], "fatehi-eq-33", (1 + 2) * (line + square), 0),
        // A symmetric tensor of rank 4 has xxxx and xxyy there.
        (&["wendland-c2"], &["square"], "fatehi-eq-34", 2 * square, 0),
        (&["wendland-c2"], &["simple-cubic"], "fatehi-eq-34", 2 * cube, 0),
        // Two claims on one moment.
        (&["wendland-c2"], &["line"], "fatehi-eq-32/b_inverse#regular\", \"fatehi-eq-33", line, 0),
        // A scalar.
        (&["wendland-c2"], &["square"], "fatehi-eq-36", square, 0),
        // Its regular value is zero: samples alone.
        (&["wendland-c2"], &["line"], "fatehi-eq-38", 0, disordered),
    ];
    for (kernels, lattices, claims, exact_sums, samples) in scenes {
        let folder = Folder::new();
        let disorders = if samples > 0 { "disorders = [\"box:0.4\"]\n" } else { "" };
        let mut scene = format!(
            "[cases]\nkernels = {kernels:?}\nlattices = {lattices:?}\n{disorders}\n[claims]\nuse = [\"{claims}\"]\n\
             [samples]\nblock = 8\nmost_blocks = 1\n"
        );
        for (dimension, to, rungs, offsets) in [(1, 32, 6, 4), (2, 16, 5, 3), (3, 16, 5, 2)] {
            scene += &format!(
                "[[ladders.regular]]\ndimension = {dimension}\nfrom = 4\nto = {to}\nrungs = {rungs}\noffsets = {offsets}\n"
            );
        }
        folder.write("small.toml", scene + DISORDERED);
        let plan = plan(&folder, "small.toml");
        folder.run("run small.toml --store store");
        let cost = &folder.json("reports/small/report.json")["cost"];
        let found = |of: &Value, samples: &str| [number(&of["exact_sums"]), number(&of[samples])];
        assert_eq!(found(cost, "samples"), [exact_sums, samples], "{claims} {lattices:?}");
        assert_eq!(found(&plan, "most_samples"), [exact_sums, samples], "{claims} {lattices:?}");
    }
}
