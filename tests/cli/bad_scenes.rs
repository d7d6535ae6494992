//! Wrong scenes: what is wrong, at which line and column, and nothing written.

use crate::folder::{Folder, Ran};
use crate::scenes::{REGULAR, SMALL};

/// One fault in an otherwise good scene.
struct Fault {
    /// What is replaced.
    good: &'static str,
    /// By what; a `|` marks the place that the message must show, and is not written.
    bad: &'static str,
    /// What the message must say.
    says: &'static [&'static str],
}

/// Runs a scene with `|` before the fault and expects the error to show exactly that place, and nothing to change.
fn refused(name: &str, marked: &str, says: &[&str]) {
    let before_fault = marked.split_once('|').map(|(before, _)| before);
    let folder = Folder::new();
    folder.write(name, marked.replacen('|', "", 1));
    let before = folder.snapshot();
    for command in ["run", "plan", "merge", "run --quick", "run --shard 1/2"] {
        let ran: Ran = folder.run_to(2, &format!("{command} {name}"));
        ran.says(&["error: "]);
        ran.says(says);
        assert!(ran.stdout.is_empty(), "{}", ran.stdout);
        if let Some(text) = before_fault {
            let line = text.matches('\n').count() + 1;
            let column = text.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
            ran.says(&[&format!("--> {name}:{line}:{column}\n")]);
        }
        assert_eq!(before, folder.snapshot(), "something was written");
    }
}

fn all_refused(faults: &[Fault]) {
    for fault in faults {
        assert_eq!(SMALL.matches(fault.good).count(), 1, "'{}' must stand in the scene once", fault.good);
        refused("small.toml", &SMALL.replace(fault.good, fault.bad), fault.says);
    }
}

#[test]
fn unknown_names() {
    all_refused(&[
        Fault {
            good: "kernels = [\"wendland-c2\"]",
            bad: "kernels = [\"cubic-spline\", |\"wendlandc2\"]",
            says: &["no kernel 'wendlandc2'", "did you mean 'wendland-c2'?", "quintic-spline"],
        },
        Fault {
            good: "\"square\"]",
            bad: "|\"squares\"]",
            says: &["no lattice 'squares'", "did you mean 'square'?", "simple-cubic"],
        },
        Fault {
            good: "\"box:0.4\"]",
            bad: "|\"boxx:0.4\"]",
            says: &["no disorder model 'boxx'", "did you mean 'box'?", "canonical"],
        },
        Fault {
            good: "\"fatehi-eq-28\"",
            bad: "|\"fatehi-tabel-2\"",
            says: &["no claim 'fatehi-tabel-2'", "did you mean 'fatehi-table-2'?", "remainder list claims"],
        },
        Fault {
            good: "moment = \"sum_ddw\"",
            bad: "moment = |\"sum_ddww\"",
            says: &["no moment sum 'sum_ddww'", "did you mean 'sum_ddw'?"],
        },
        Fault {
            good: "quantity = \"regular-deviation\"",
            bad: "quantity = |\"regular\"",
            says: &["no quantity 'regular'", "regular-deviation"],
        },
        Fault {
            good: "seed = 7",
            bad: "seed = 7\nkind = |\"viscosimetry\"",
            says: &["no study of kind 'viscosimetry'", "moment-orders", "heat"],
        },
        Fault {
            good: "[claims]",
            bad: "volume_rules = [|\"constants\"]\n[claims]",
            says: &["no volume rule 'constants'", "did you mean 'constant'?"],
        },
        Fault { good: "seed = 7", bad: "|colour = 7", says: &["unknown field `colour`", "`seed`"] },
        Fault { good: "[samples]", bad: "[|simples]", says: &["unknown field `simples`", "`samples`"] },
        Fault {
            good: "name = \"mine\"",
            bad: "name = \"mine\"\n|dx_over_H = \"1\"",
            says: &["unknown field `dx_over_H`", "`dx_over_h`"],
        },
        Fault {
            good: "[limits]",
            bad: "[expect]\n\"fatehi-eq-34/sum_rrrdw#regular\" = |\"confirmed\"\n[limits]",
            says: &["fatehi-eq-34/sum_rrrdw#regular", "not among the scene's claims"],
        },
        Fault {
            good: "[limits]",
            bad: "[expect]\n\"own/mine\" = |\"maybe\"\n[limits]",
            says: &["unknown variant `maybe`", "`confirmed`", "`inconclusive`"],
        },
    ]);
}

#[test]
fn own_claims_that_make_no_sense() {
    const UNREADABLE: &str = "write a rational in beta such as";
    all_refused(&[
        Fault { good: "\"beta-1\"", bad: "|\"beta^2\"", says: &["'beta^2' is no exponent", UNREADABLE] },
        Fault { good: "\"beta-1\"", bad: "|\"1/0\"", says: &["'1/0' is no exponent", UNREADABLE] },
        Fault { good: "\"beta-1\"", bad: "|\"\"", says: &["'' is no exponent", UNREADABLE] },
        Fault { good: "h = \"-2\"", bad: "h = |\"two\"", says: &["'two' is no exponent", UNREADABLE] },
        Fault {
            good: "displacement = \"0\"",
            bad: "displacement = |\"x\"",
            says: &["'x' is no exponent", UNREADABLE],
        },
        Fault {
            good: "h = \"-2\"",
            bad: "h = |\"-1\"",
            says: &["add up to -1", "sum_ddw is a length to the power -2"],
        },
        Fault {
            good: "displacement = \"0\"\nh = \"-2\"",
            bad: "displacement = \"1\"\nh = |\"-2\"",
            says: &["add up to -1"],
        },
        Fault { good: "\"beta-1\"", bad: "|2", says: &["invalid type: integer `2`, expected a string"] },
    ]);
}

#[test]
fn supports_that_hold_nobody_or_too_many() {
    const ALONE: &str = "leaves particle i without neighbours on lattice 'square'";
    all_refused(&[
        Fault {
            good: "from = 4\nto = 16",
            bad: "from = |1\nto = 16",
            says: &["R/Δ = 1 ", ALONE, "nearest is at 1 Δ"],
        },
        Fault { good: "from = 3\nto = 12", bad: "from = |0\nto = 12", says: &["R/Δ must be positive"] },
        Fault { good: "support_over_dx = 3.5", bad: "support_over_dx = |0.9", says: &["R/Δ = 0.9 ", ALONE] },
        Fault {
            good: "to = 16",
            bad: "to = |30000",
            says: &[
                "R/Δ = 30000 on lattice 'square'",
                "needs about 1078",
                "2.83e9 sites",
                "more than the 64 MiB",
                "memory_mib",
            ],
        },
        Fault {
            good: "to = 12",
            bad: "to = |4000000000",
            says: &["R/Δ = 4000000000 on lattice 'square'", "MiB"],
        },
        Fault {
            good: "support_over_dx = 3.5",
            bad: "support_over_dx = |1e5",
            says: &["R/Δ = 100000 on lattice 'square'", "MiB", "memory_mib"],
        },
        Fault { good: "support_over_dx = 3.5", bad: "support_over_dx = |1e300", says: &["MiB"] },
    ]);
}

#[test]
fn numbers_that_are_none() {
    let support = "must be finite and positive";
    let amplitude = "which must be finite and positive";
    let precision = "must be finite and positive";
    for (good, written, says) in [
        ("support_over_dx = 3.5", "support_over_dx = ", support),
        ("precision = 0.1", "precision = ", precision),
        ("margin = 0.25", "margin = ", precision),
    ] {
        for bad in ["0.0", "-1.5", "nan", "inf", "-inf"] {
            assert_eq!(SMALL.matches(good).count(), 1);
            refused("small.toml", &SMALL.replace(good, &format!("{written}|{bad}")), &[says]);
        }
    }
    for bad in ["box:0", "box:-0.4", "box:nan", "box:inf", "offset:-inf", "canonical:1e999"] {
        refused("small.toml", &SMALL.replace("\"box:0.4\"", &format!("|\"{bad}\"")), &[bad, amplitude]);
    }
    all_refused(&[
        Fault { good: "\"box:0.4\"", bad: "|\"box\"", says: &["'box' has no amplitude", "MODEL:AMPLITUDE"] },
        Fault { good: "\"box:0.4\"", bad: "|\"box:\"", says: &["has no amplitude"] },
        Fault { good: "\"box:0.4\"", bad: "|\"box:much\"", says: &["amplitude 'much' that is no number"] },
        Fault {
            good: "\"box:0.4\"",
            bad: "|\"box:0.4,sigma=2\"",
            says: &["option 'sigma'", "does not know"],
        },
        Fault { good: "\"box:0.4\"", bad: "|\"none:1\"", says: &["takes no amplitude"] },
        Fault { good: "\"box:0.4\"", bad: "|\"offset:0.1\"", says: &["names 'offset:0.1' twice"] },
        Fault { good: "seed = 7", bad: "seed = |-7", says: &["integer `-7`"] },
        Fault { good: "from = 5", bad: "from = |-5", says: &["integer `-5`"] },
        Fault { good: "from = 5", bad: "from = |5.5", says: &["floating point `5.5`"] },
    ]);
}

#[test]
fn displacements_that_let_neighbours_meet() {
    const REMEDY: &str = "allow_degenerate = true";
    all_refused(&[
        Fault {
            good: "\"box:0.4\"",
            bad: "|\"canonical:0.5\"",
            says: &["'canonical:0.5' moves particles by up to 0.5 Δ", "neighbours can meet", REMEDY],
        },
        Fault { good: "\"box:0.4\"", bad: "|\"box:2\"", says: &["up to 0.5 Δ", REMEDY] },
        Fault { good: "\"box:0.4\"", bad: "|\"offset:1\"", says: &["up to 1 Δ", REMEDY] },
    ]);
    // Admitted, they still have a limit.
    for amplitude in ["1e6", "1e300"] {
        let marked = SMALL
            .replace("\"box:0.4\"", &format!("|\"canonical:{amplitude}\""))
            .replace("[limits]", "[limits]\nallow_degenerate = true");
        refused("small.toml", &marked, &[&format!("'canonical:{amplitude}'"), "more than 16 Δ"]);
    }
    // Just below the limit all is well.
    let folder = Folder::with_scene(&SMALL.replace("box:0.4", "canonical:0.4999"));
    folder.run_to(0, "plan small.toml");
}

#[test]
fn windows_and_counts_that_contradict_themselves() {
    all_refused(&[
        Fault {
            good: "from = 5\nto = 32",
            bad: "from = 9\nto = |32",
            says: &["9 … 32 spans less than two octaves", "at least 36"],
        },
        Fault { good: "from = 5\nto = 32", bad: "from = 32\nto = |5", says: &["less than two octaves"] },
        Fault {
            good: "from = 5\nto = 32",
            bad: "from = 2000000000\nto = |4000000000",
            says: &["less than two octaves", "at least 8000000000"],
        },
        Fault { good: "rungs = 6", bad: "rungs = |4", says: &["4 rungs decide no order", "at least 5"] },
        Fault { good: "rungs = 7", bad: "rungs = |0", says: &["0 rungs decide no order"] },
        Fault { good: "rungs = 9", bad: "rungs = |4", says: &["4 rungs: give 5 to 40"] },
        Fault { good: "rungs = 10", bad: "rungs = |41", says: &["41 rungs: give 5 to 40"] },
        Fault { good: "rungs = 6", bad: "rungs = |4000000000", says: &["4000000000 rungs", "at most 1000"] },
        Fault {
            good: "offsets = 5",
            bad: "offsets = |4000000000",
            says: &["4000000000 offsets", "at most 1000"],
        },
        Fault { good: "offsets = 5", bad: "offsets = |0", says: &["at least one offset"] },
        Fault {
            good: "dimension = 1\nfrom = 5",
            bad: "dimension = |4\nfrom = 5",
            says: &["dimension 4 is not 1, 2 or 3"],
        },
        Fault {
            good: "dimension = 2\nfrom = 4",
            bad: "dimension = |1\nfrom = 4",
            says: &["two [[ladders.regular]] for dimension 1"],
        },
        Fault {
            good: "dimension = 2\nsupport_over_dx",
            bad: "dimension = |1\nsupport_over_dx",
            says: &["two [[ladders.displacement]] for dimension 1"],
        },
        Fault { good: "block = 8", bad: "block = |1", says: &["at least 2 samples"] },
        Fault {
            good: "block = 8",
            bad: "block = |9000000000000000000",
            says: &["9000000000000000000 is too many"],
        },
        Fault {
            good: "blocks = 3",
            bad: "blocks = |9000000000000000000",
            says: &["9000000000000000000 is too many"],
        },
        Fault { good: "blocks = 3", bad: "blocks = 0", says: &["at least one block"] },
        Fault { good: "kernels = [\"wendland-c2\"]", bad: "kernels = |[]", says: &["names no kernels"] },
        Fault {
            good: "lattices = [\"line\", \"square\"]",
            bad: "lattices = |[]",
            says: &["names no lattices"],
        },
        Fault {
            good: "disorders = [\"offset:0.1\", \"box:0.4\"]",
            bad: "",
            says: &["the claims need disorder", "disorders = ["],
        },
    ]);
    refused("small.toml", &format!("[claims]\nuse = []\n{REGULAR}"), &["checks no claim"]);
}

#[test]
fn texts_that_are_no_scene() {
    let half = &SMALL[..SMALL.find("\"square\"").expect("a place") + 4];
    refused("small.toml", half, &["small.toml:7:"]);
    refused("small.toml", "", &["missing field `cases`"]);
    refused("small.toml", "\n\n", &["missing field `cases`"]);
    refused("small.toml", "[study]\nseed = 1\n|seed = 2\n", &["duplicate key"]);
    refused("small.toml", "just words\n", &["small.toml:1:"]);
    // Columns count characters, not bytes.
    let accents =
        SMALL.replace("disorders = [\"offset:0.1\", ", "disorders = [\"offset:0.1\", \"none\", |\"Δδé:1\", ");
    refused("small.toml", &accents, &["no disorder model 'Δδé'"]);

    let folder = Folder::new();
    folder.write("binary.toml", [0x7f, b'E', b'L', b'F', 0, 0xff, 0xfe, 0, 1]);
    folder.write("binary/scene.toml", [0xff; 64]);
    folder.write("zeros.json", [0; 64]);
    folder.write("empty/readme.txt", "no scene");
    let before = folder.snapshot();
    folder.run_to(2, "run binary.toml").says(&["binary.toml", "cannot be read as a scene", "UTF-8"]);
    folder.run_to(2, "run binary").says(&["cannot be read as a scene"]);
    folder.run_to(2, "run zeros.json").says(&["zeros.json:1:1"]);
    folder.run_to(2, "run nowhere.toml").says(&["nowhere.toml", "No such file", "give a scene file"]);
    folder.run_to(2, "run empty").says(&["empty", "neither scene.toml nor scene.json"]);
    assert_eq!(before, folder.snapshot());
}

#[test]
fn json_scenes_show_their_faults_in_place_too() {
    let good = r#"{
  "cases": {
    "kernels": ["wendland-c2"],
    "lattices": ["line"]
  },
  "claims": {"use": ["fatehi-eq-33"]},
  "ladders": {
    "regular": [{"dimension": 1, "from": 4, "to": 32, "rungs": 6, "offsets": 4}]
  }
}
"#;
    let folder = Folder::new();
    folder.write("small.json", good);
    folder.run_to(0, "run small.json");
    for (from, to, says) in [
        ("\"wendland-c2\"", "|\"wendland-c3\"", "no kernel 'wendland-c3'"),
        ("[\"line\"]", "[\"line\", |\"lines\"]", "no lattice 'lines'"),
        ("\"to\": 32", "\"to\": |15", "less than two octaves"),
        ("\"from\": 4", "\"from\": |1", "without neighbours"),
        ("[\"fatehi-eq-33\"]", "[|\"fatehi-eq-99\"]", "no claim 'fatehi-eq-99'"),
    ] {
        assert_eq!(good.matches(from).count(), 1, "{from}");
        refused("small.json", &good.replace(from, to), &[says]);
    }
    refused(
        "small.json",
        &good.replace("\"lattices\"", "\"lattice\""),
        &["unknown field `lattice`", "small.json:4:"],
    );
    refused("small.json", &good[..good.len() / 2], &["EOF while parsing", "small.json:"]);
    refused("small.json", "", &["EOF while parsing", "small.json:1:1"]);
}
