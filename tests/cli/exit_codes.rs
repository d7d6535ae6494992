//! 0 as expected, 1 a verdict differs, 2 wrong input, 3 inconclusive; 2 before 1 before 3.

use crate::folder::Folder;
use crate::scenes::{DISORDERED, REGULAR};

/// |B⁻¹ − I| on a line is of fourth order for Wendland C2 (β = 3): so says Euler–Maclaurin, and `exactness` the program.
const TRUE_CLAIM: &str = "fatehi-eq-33/b_inverse#regular";

fn expecting(verdicts: &[(&str, &str)]) -> String {
    let lines = verdicts.iter().map(|(id, verdict)| format!("\"{id}\" = \"{verdict}\"\n"));
    format!("{REGULAR}\n[expect]\n{}", lines.collect::<String>())
}

fn claims(chosen: &str) -> String {
    format!("\n[claims]\nuse = {chosen}\n")
}

/// |B⁻¹ − I| with an exponent of one's own.
fn own(name: &str, dx_over_h: &str) -> String {
    format!(
        "[[claims.own]]\nname = \"{name}\"\nmoment = \"b_inverse\"\nquantity = \"regular-deviation\"\n\
         dx_over_h = \"{dx_over_h}\"\n"
    )
}

/// In 1-D, particles displaced by Δ/2 one way or the other meet their neighbours.
fn meeting(chosen: &str, expect: &str) -> String {
    format!(
        "[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"line\"]\ndisorders = [\"canonical:0.5\"]\n\
         [claims]\nuse = {chosen}\n{DISORDERED}\n[[ladders.regular]]\ndimension = 1\nfrom = 4\nto = 32\nrungs = 6\n\
         offsets = 4\n[samples]\nblock = 16\nmost_blocks = 2\n[limits]\nallow_degenerate = true\n[expect]\n{expect}"
    )
}

#[test]
fn as_expected_is_0() {
    let folder =
        Folder::with_scene(&(claims("[\"fatehi-eq-33\"]") + &expecting(&[(TRUE_CLAIM, "confirmed")])));
    let ran = folder.run_to(0, "run small.toml");
    assert!(ran.stdout.contains("1 confirmed"), "{}", ran.stdout);
    assert_eq!(folder.json("reports/small/report.json")["verdicts"][0]["expected"], "confirmed");
    // Where nothing is expected, a refuted claim is a result.
    folder.write("none.toml", claims("[]") + &own("ninth", "9") + REGULAR);
    let ran = folder.run_to(0, "run none.toml");
    assert!(ran.stdout.contains("1 refuted"), "{}", ran.stdout);
    let expects = [("own/ninth", "refuted"), ("own/first", "bound"), (TRUE_CLAIM, "confirmed")];
    let scene = claims("[\"fatehi-eq-33\"]") + &own("ninth", "9") + &own("first", "1") + &expecting(&expects);
    folder.write("all.toml", scene);
    folder.run_to(0, "run all.toml");
}

#[test]
fn another_verdict_is_1_and_is_reported() {
    for wrong in ["refuted", "bound", "conditional", "inconclusive"] {
        let scene = claims("[\"fatehi-eq-33\"]") + &expecting(&[(TRUE_CLAIM, wrong)]);
        let folder = Folder::with_scene(&scene);
        let ran = folder.run_to(1, "run small.toml");
        assert!(ran.stdout.contains(&format!("confirmed, expected {wrong}")), "{}", ran.stdout);
        let verdict = &folder.json("reports/small/report.json")["verdicts"][0];
        assert_eq!((&verdict["verdict"], &verdict["expected"]), (&"confirmed".into(), &wrong.into()));
        assert!(folder.text("reports/small/report.md").contains(&format!("(expected {wrong})")));
        folder.run_to(1, "merge small.toml");
    }
}

#[test]
fn inconclusive_is_3_unless_expected() {
    let folder = Folder::with_scene(&meeting("[\"fatehi-eq-38\"]", ""));
    folder.run_to(3, "run small.toml");
    let claim = &folder.json("reports/small/report.json")["claims"][0];
    assert_eq!(claim["verdict"], "inconclusive");
    let why = claim["why"].as_str().expect("a reason");
    assert!(why.contains("two particles within 1e-12 Δ"), "{why}");
    assert!(claim["measured"]["exponents"].is_null(), "a typed result instead of numbers: {claim}");
    folder.write(
        "small.toml",
        meeting("[\"fatehi-eq-38\"]", "\"fatehi-eq-38/sum_dw#disorder\" = \"inconclusive\""),
    );
    folder.run_to(0, "run small.toml");
    // Number-density volumes meet the same pairs.
    let rule = "lattices = [\"line\"]\nvolume_rules = [\"number-density\"]";
    folder.write("small.toml", meeting("[\"fatehi-eq-38\"]", "").replace("lattices = [\"line\"]", rule));
    folder.run_to(3, "run small.toml");
    // A ladder whose samples scatter more than the margin decides nothing either; where an order is derived, that does.
    let noisy = meeting("[\"fatehi-eq-38\"]", "")
        .replace("canonical:0.5", "box:0.4")
        .replace("16\nmost_blocks = 2", "2\nmost_blocks = 1")
        .replace("[limits]", "[comparison]\nmargin = 1e-3\n[limits]");
    folder.write("small.toml", noisy.replace("lattices = [\"line\"]", rule));
    folder.run_to(3, "run small.toml");
    folder.write("small.toml", noisy);
    folder.run_to(0, "run small.toml");
    let claim = &folder.json("reports/small/report.json")["claims"][0];
    assert_eq!(
        (&claim["verdict"], &claim["derived"]["exponents"]["dx_over_h"]["value"]),
        (&"refuted".into(), &"1/2".into())
    );
    let why = claim["why"].as_str().expect("a reason");
    assert!(why.contains("Judged by the derived d̃ (Δ/h)^1/2 (the random walk over the neighbours"), "{why}");
}

#[test]
fn a_difference_outweighs_what_is_open_and_wrong_input_both() {
    let wrong = format!("\"{TRUE_CLAIM}\" = \"refuted\"");
    let folder = Folder::new();
    for chosen in ["[\"fatehi-eq-38\", \"fatehi-eq-33\"]", "[\"fatehi-eq-33\", \"fatehi-eq-38\"]"] {
        folder.write("small.toml", meeting(chosen, ""));
        folder.run_to(3, "run small.toml");
        folder.write("small.toml", meeting(chosen, &wrong));
        folder.run_to(1, "run small.toml");
    }
    folder.write("foreign/report.json", "mine");
    folder.run_to(2, "run small.toml --out foreign");
}

#[test]
fn wrong_arguments_are_2_and_help_is_0() {
    let folder = Folder::with_scene(REGULAR);
    let before = folder.snapshot();
    for wrong in [
        "",
        "rum small.toml",
        "run",
        "run small.toml --shard 0/3",
        "run small.toml --shard 4/3",
        "run small.toml --shard x",
        "run small.toml --shard 1/",
        "run small.toml --shard 1/0",
        "run small.toml --shard -1/3",
        "run small.toml --threads none",
        "run small.toml --threads 0",
        "run small.toml --threads 99999999",
        "run small.toml --colour",
        "plan",
        "schema",
        "schema everything",
        "list nothing",
        "merge",
    ] {
        let ran = folder.run_to(2, wrong);
        assert!(ran.stdout.is_empty(), "`{wrong}`: {}", ran.stdout);
        ran.says(
            &["Usage: remainder"]
                .map(|usage| if wrong.contains("--") || wrong.contains(' ') { "" } else { usage }),
        );
        assert!(!ran.stderr.is_empty(), "`{wrong}` says nothing");
    }
    folder.run("run small.toml --shard 4/3").says(&["4/3", "write I/N with 1 ≤ I ≤ N"]);
    folder.run("rum small.toml").says(&["rum", "'run'"]);
    for right in
        ["--help", "--version", "run --help", "merge --help", "plan --help", "list --help", "schema --help"]
    {
        let ran = folder.run_to(0, right);
        assert!(ran.stdout.contains("remainder") && ran.stderr.is_empty(), "`{right}`: {}", ran.stderr);
    }
    let help = folder.run("--help").stdout;
    for code in ["0 all verdicts as the scene expects", "1 some differ", "2 the input is wrong", "3", "130"] {
        assert!(help.contains(code), "'{code}' is not in:\n{help}");
    }
    assert_eq!(before, folder.snapshot());
}
