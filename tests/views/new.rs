//! New scenes run and pass as written, and nothing is overwritten.

use crate::folder::Folder;

const KINDS: [&str; 8] = [
    "moment-orders",
    "operator-orders",
    "heat",
    "stiff",
    "work-precision",
    "extremes",
    "basa",
    "chaussonnet",
];

#[test]
fn a_new_scene_runs_and_passes_as_written() {
    for kind in KINDS {
        let folder = Folder::new();
        let ran = folder.run_to(0, &format!("new try --kind {kind}"));
        assert!(ran.stdout.contains("remainder run analyses/try --quick"), "{}", ran.stdout);
        let scene = folder.text("analyses/try/scene.toml");
        assert!(scene.contains("title = \"try: ") && !scene.contains("NAME"), "{scene}");
        // Each line that is no blank has its comment, or is one whose key says all.
        assert!(scene.matches('#').count() > 10, "{scene}");
        folder.run_to(0, "run analyses/try --quick");
        assert!(folder.path("reports/try/report.json").is_file());
    }
}

#[test]
fn what_is_commented_out_is_right_too() {
    for kind in KINDS {
        let folder = Folder::new();
        folder.run_to(0, &format!("new try --kind {kind}"));
        let scene = folder.text("analyses/try/scene.toml");
        let tables = [
            "# volume_rules",
            "# [[define",
            "# id",
            "# support",
            "# pieces",
            "# [[ladders",
            "# dimension",
            "# from",
            "# to =",
            "# rungs",
            "# offsets",
            "# [expect",
            "# \"",
            "# boundaries",
            "# steady",
            "# operators",
            "# ladder",
            "# disorders",
            "# reference_",
            "# start_up",
            "# points",
        ];
        let opened: Vec<String> = scene
            .lines()
            .map(|line| match tables.iter().any(|start| line.starts_with(start)) {
                true => line.trim_start_matches("# ").to_owned(),
                false => line.to_owned(),
            })
            .collect();
        if kind == "extremes" {
            assert_eq!(opened.join("\n"), scene.trim_end(), "{kind}: nothing is commented out");
            continue;
        }
        assert_ne!(opened.join("\n"), scene.trim_end(), "{kind}: nothing is commented out");
        folder.write("analyses/open/scene.toml", opened.join("\n"));
        // A whole paper takes its time, and does the same as the test above but for what is opened here: planning reads that.
        let command = if ["basa", "chaussonnet"].contains(&kind) { "plan" } else { "run" };
        let ran = folder.run(&format!("{command} analyses/open --quick"));
        assert_eq!(ran.code, 0, "{kind}: {}\n{}", ran.stdout, ran.stderr);
    }
}

#[test]
fn nothing_is_overwritten_and_names_stay_in_the_folder() {
    let folder = Folder::new();
    folder.run_to(0, "new");
    let before = folder.snapshot();
    assert!(folder.path("analyses/mine/scene.toml").is_file());
    folder.run_to(2, "new mine").says(&["analyses/mine/scene.toml is there already"]);
    for name in ["../away", "a/b", ".hidden", ""] {
        let ran = folder.run_arguments(&["new", name]);
        assert_eq!(ran.code, 2, "{name}");
    }
    folder.run_to(2, "new other --kind nothing").says(&["moment-orders"]);
    assert_eq!(before, folder.snapshot());
}
