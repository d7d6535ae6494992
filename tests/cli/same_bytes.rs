//! The same scene and seed give the same bytes: on any number of threads, whole, resumed or in shards, in TOML or JSON.

use crate::folder::Folder;
use crate::scenes::SMALL;
use std::fs;

/// Both forms of the report, byte for byte.
fn report(folder: &Folder, out: &str) -> (String, String) {
    (folder.text(&format!("{out}/report.json")), folder.text(&format!("{out}/report.md")))
}

/// Expects two reports to be the same, and shows the first line in which they differ.
fn assert_same(folder: &Folder, one: &str, other: &str) {
    let (one, other) = (report(folder, one), report(folder, other));
    for (one, other) in [(&one.0, &other.0), (&one.1, &other.1)] {
        let differs = one.lines().zip(other.lines()).enumerate().find(|(_, (a, b))| a != b);
        assert!(one == other, "line and text: {differs:?}");
    }
}

#[test]
fn one_thread_and_two_write_the_same() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --threads 1 --store one --out first");
    folder.run_to(0, "run small.toml --threads 2 --store two --out second");
    assert_same(&folder, "first", "second");
    assert_eq!(folder.blocks("one"), folder.blocks("two"));
    // Another seed gives another report, so the comparison can fail.
    folder.write("small.toml", SMALL.replace("seed = 7", "seed = 8"));
    folder.run_to(0, "run small.toml --store three --out third");
    assert_ne!(report(&folder, "first").0, report(&folder, "third").0);
    let fits = |out: &str| folder.json(&format!("{out}/report.json"))["fits"].clone();
    assert_ne!(fits("first"), fits("third"));
}

#[test]
fn a_resumed_run_writes_the_same_and_uses_what_is_stored() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --store store --out whole");
    let stored = folder.blocks("store");
    for name in stored.keys().step_by(2) {
        fs::remove_file(folder.path("store").join(name)).expect("a block removed");
    }
    let kept = folder.blocks("store").len();
    assert!(kept > 10, "{kept} blocks");
    folder.run_to(0, "run small.toml --store store --out resumed");
    assert_same(&folder, "whole", "resumed");
    assert_eq!(stored, folder.blocks("store"));
    assert_eq!(folder.json("resumed/timings.json")["blocks_found_stored"], kept);
    // A third run finds everything.
    folder.run_to(0, "run small.toml --store store --out again");
    assert_eq!(folder.json("again/timings.json")["blocks_found_stored"], stored.len());
    assert_same(&folder, "whole", "again");
}

#[test]
fn shards_merge_to_the_same() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --store store --out whole");
    let mut union = folder.blocks("nothing");
    for shard in 1..=3 {
        let ran = folder.run_to(0, &format!("run small.toml --shard {shard}/3 --store s{shard} --out part"));
        ran.says(&["remainder merge small.toml"]);
        assert!(!folder.path("part").exists(), "a shard has no report");
        let mine = folder.blocks(&format!("s{shard}"));
        assert!(mine.len() > 10, "shard {shard} has {} blocks", mine.len());
        let before = union.len();
        union.extend(mine.clone());
        assert_eq!(union.len(), before + mine.len(), "shards share no block");
    }
    assert_eq!(union, folder.blocks("store"));
    folder.run_to(0, "merge small.toml s2 s3 --store s1 --out merged");
    assert_same(&folder, "whole", "merged");
    // A shard may find blocks of another beside its own: one store for all.
    folder.run_to(0, "run small.toml --shard 1/2 --store both");
    folder.run_to(0, "run small.toml --shard 2/2 --store both");
    folder.run_to(0, "merge small.toml --store both --out joined");
    assert_same(&folder, "whole", "joined");
}

#[test]
fn a_merge_without_all_shards_writes_nothing() {
    let folder = Folder::with_scene(SMALL);
    for shard in [1, 3] {
        folder.run_to(0, &format!("run small.toml --shard {shard}/3 --store s{shard}"));
    }
    let before = folder.snapshot();
    let ran = folder.run_to(2, "merge small.toml s3 --store s1 --out merged");
    ran.says(&["tasks are not complete", "run the remaining shards first", "R/Δ = "]);
    let ran = folder.run_to(2, "merge small.toml s2 s3 --store s1 --out merged");
    ran.says(&["s2", "is no folder"]);
    assert_eq!(before, folder.snapshot());
}

#[test]
fn blocks_of_another_scene_are_not_taken() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --store fresh --out fresh-out");
    folder.write("other/small.toml", SMALL.replace("seed = 7", "seed = 8").replace("block = 8", "block = 9"));
    folder.run_to(0, "run other/small.toml --store store --out other-out");
    folder.run_to(0, "run small.toml --store store --out out");
    assert_same(&folder, "fresh-out", "out");
}

#[test]
fn a_scene_in_json_is_the_scene_in_toml() {
    let folder = Folder::with_scene(SMALL);
    let value: serde_json::Value = toml::from_str(SMALL).expect("the scene is TOML");
    folder.write("small.json", serde_json::to_string_pretty(&value).expect("JSON"));
    folder.run_to(0, "run small.toml --store one --out toml");
    folder.run_to(0, "run small.json --store two --out json");
    assert_same(&folder, "toml", "json");
    folder.write("folder/scene.json", folder.text("small.json"));
    folder.run_to(0, "run folder --store two --out in-folder");
    assert_eq!(folder.json("in-folder/report.json")["claims"], folder.json("toml/report.json")["claims"]);
}
