//! `expand`: what it prints, in three formats, and where it points when the operator is wrong.

use crate::folder::Folder;
use serde_json::Value;

#[test]
fn an_operator_is_expanded_as_the_paper_prints_it() {
    let folder = Folder::new();
    let ran = folder.run_to(0, "expand F4 --to 3 --lattice square --lattice hcp");
    // Fatehi & Manzari 2011, Eq. (20).
    for line in [
        "1/2 ∇∇u : Σ_j ω_j r_ij r_ij B_i·∇W_ij",
        "− 1/6 ∇∇∇u ⋮ Σ_j ω_j r_ij r_ij r_ij B_i·∇W_ij",
        "vanishes on square by the point group",
        "Exactly(1)",
        "Conserves the total: no",
    ] {
        assert!(ran.stdout.contains(line), "{line}:\n{}", ran.stdout);
    }
    assert!(!ran.stdout.contains("vanishes on square, hcp"), "hcp has no inversion at its sites");
    let latex = folder.run_to(0, "expand S3 --to 2 --format latex").stdout;
    assert!(latex.contains("\\begin{align*}") && latex.contains("\\mathbf{B}_i^{-1}"), "{latex}");
}

#[test]
fn text_gives_what_the_id_gives() {
    let folder = Folder::new();
    let json = |operator: &str| -> Value {
        let ran = folder.run_arguments(&["expand", operator, "--to", "3", "--json"]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        serde_json::from_str(&ran.stdout).expect("JSON")
    };
    let (named, own) = (json("F4"), json("Σ_j ω_j (u_j − u_i) B_i · ∇W_ij"));
    assert_eq!(named["orders"], own["orders"]);
    assert_eq!(named["consistency"], own["consistency"]);
    assert_eq!(named["consistency"][1]["exactly"], 1);
    assert_eq!(own["approximates"], "∇u");
    assert_eq!(json("S4")["consistency"][2]["exactly"], 2);
}

#[test]
fn faults_are_shown_in_the_text() {
    let folder = Folder::new();
    for (operator, says) in [
        ("sum_j V_j u_j gradw_ij", "did you mean gradW?"),
        ("sum_j V_j u_j u_j gradW_ij", "not linear"),
        ("sum_j V_j (u_j gradW_ij", "expected ')'"),
        ("F5", "there is no operator 'F5'"),
        ("-", "no operator '-'"),
    ] {
        let ran = folder.run_arguments(&["expand", operator]);
        assert_eq!(ran.code, 2, "{operator}: {}", ran.stdout);
        assert!(ran.stderr.contains("error: ") && ran.stderr.contains(says), "{operator}: {}", ran.stderr);
        assert!(ran.stdout.is_empty());
    }
    let ran = folder.run_arguments(&["expand", "F4", "--to", "99"]);
    assert!(ran.code == 2 && ran.stderr.contains("order 99"), "{}", ran.stderr);
}

/// A scene asks of an operator of one's own what it asks of a moment sum.
#[test]
fn a_scene_judges_an_operator_of_its_own() {
    let scene = |claim: &str| {
        format!(
            "[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"line\"]\ndisorders = [\"box:0.4\"]\n[claims]\nuse = []\n\
             [[claims.own]]\nname = \"mine\"\n{claim}\n[[ladders.regular]]\ndimension = 1\nfrom = 6\nto = 48\nrungs = 7\n\
             offsets = 8\n"
        )
    };
    let f2 = "operator = \"sum_j V_j (u_j - u_i) gradW_ij\"\norder = 1\nquantity = \"regular-deviation\"\n\
              dx_over_h = \"beta+1\"";
    let folder = Folder::with_scene(&scene(f2));
    folder.run_to(0, "run small.toml");
    let report: Value = serde_json::from_slice(&folder.bytes("reports/small/report.json")).expect("JSON");
    // β + 1 = 4 is sharp on a line, by derivation: the kernel's first odd power is 3, 1 + 3 + 1 − 1 = 4.
    assert_eq!(report["verdicts"][0]["verdict"], "confirmed", "{}", report["verdicts"]);
    assert_eq!(report["claims"][0]["case"]["order"], 1);
    for (claim, says) in [
        (
            "operator = \"sum_j V_j u_j gradw_ij\"\norder = 1\nquantity = \"regular-value\"\ndx_over_h = \"1\"",
            "gradw",
        ),
        ("operator = \"F2\"\nquantity = \"regular-value\"\ndx_over_h = \"1\"", "needs order"),
        (
            "operator = \"F2\"\nmoment = \"sum_w\"\norder = 1\nquantity = \"regular-value\"\ndx_over_h = \"1\"",
            "not about both",
        ),
        (
            "operator = \"S1-8-F2\"\norder = 1\nquantity = \"disorder-deviation\"\nh = \"-1\"\ndx_over_h = \"1\"",
            "neighbours of neighbours",
        ),
    ] {
        let folder = Folder::with_scene(&scene(claim));
        let ran = folder.run_to(2, "run small.toml --quick");
        ran.says(&[says]);
    }
}

#[test]
fn the_catalogue_is_written_as_files() {
    let folder = Folder::new();
    folder.run_to(0, "expand --all out");
    let printed = folder.text("out/printed-equations.md");
    assert!(printed.contains("| Eq. (20) | F4 | 2 | the same |"), "{printed}");
    assert!(folder.text("out/S4.txt").contains("Exactly(2)"));
    assert!(folder.text("out/F4.tex").contains("\\nabla W_{ij}"));
}
