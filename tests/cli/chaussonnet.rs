//! Scenes of `kind = "chaussonnet"`: all parameters have defaults, and a wrong one is named with its place.

use crate::folder::Folder;

#[test]
fn every_parameter_has_a_default() {
    let folder = Folder::new();
    folder.write("all.toml", "[study]\nkind = \"chaussonnet\"\n");
    let ran = folder.run_to(0, "plan all.toml");
    assert!(ran.stdout.contains("operators square η = 0.3125 h = 6.25e-5 K_x = 100"), "{}", ran.stdout);
}

#[test]
fn a_wrong_parameter_is_named_where_it_stands() {
    for (line, says) in [
        ("eta = [1e-3, 0.1, 0.5]", "neighbours can meet"),
        ("eta = [0.1, 0.01, 0.2]", "must rise"),
        ("h_m = [1e-3, 5e-4, 5e-4]", "must fall"),
        ("h_m = [1e-3, 5e-4, 1e-6]", "a side of"),
        ("h_m_3d = [5e-4, 2.5e-4]", "must start where h_m does"),
        ("field_scales = [0.1, 10]", "must hold 1"),
        ("angles = \"even\"", "printed or uniform"),
        ("points = [10, 1000]", "100 to 10000000"),
        ("domain_size_m = -1", "must be positive"),
        ("h_over_dx = 9", "not between 0.4 and 4"),
        ("origin_h = 20", "not between 0 and 16"),
        ("layers = 4", "layers"),
    ] {
        let folder = Folder::new();
        folder.write("bad.toml", format!("[study]\nkind = \"chaussonnet\"\n\n[survey]\n{line}\n"));
        for command in ["run bad.toml", "plan bad.toml"] {
            folder.run_to(2, command).says(&["error: ", says, "--> bad.toml:5:"]);
        }
    }
}

#[test]
fn expectations_are_of_claims_that_exist() {
    let folder = Folder::new();
    let text = "[study]\nkind = \"chaussonnet\"\n\n[expect]\n\"chaussonnet-fit-25/hh\" = \"confirmed\"\n";
    folder.write("bad.toml", text);
    folder
        .run_to(2, "plan bad.toml")
        .says(&["chaussonnet-fit-25/hh", "the nearest is 'chaussonnet-fit-25/h'"]);
}

/// The committed scene in its short form: every verdict as the whole one expects it, derived errors only where they hold.
#[test]
fn a_first_look_comes_out_as_expected() {
    let folder = Folder::new();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/analyses/chaussonnet-2015");
    folder.run_to(0, &format!("run {scene} --quick --out out --store store"));
    let report = folder.json("out/report.json");
    let claims = report["claims"].as_array().expect("claims");
    let at_large = |claim: &&serde_json::Value| {
        let errors = claim["id"].as_str().is_some_and(|id| id.starts_with("chaussonnet-laplacian/equal"));
        errors && claim["case"]["disorder"] == "canonical:0.3125"
    };
    assert!(claims.iter().filter(at_large).count() > 0);
    assert!(claims.iter().filter(at_large).all(|claim| claim["derived"].is_null()));
}
