//! Foreign and truncated files where a report or a stored block should be: refused, and left as they are.

use crate::folder::Folder;
use crate::scenes::{REGULAR, SMALL};

fn scene() -> String {
    format!("[claims]\nuse = [\"fatehi-eq-33\"]\n{REGULAR}")
}

#[test]
fn a_foreign_file_in_place_of_a_report_stays() {
    let folder = Folder::with_scene(&scene());
    folder.run_to(0, "run small.toml --out good --store elsewhere");
    let good = folder.text("good/report.json");
    let foreign = [
        ("report.json", "my own notes\n".into(), "expected value"),
        ("report.json", String::new(), "EOF"),
        ("report.json", "{\"schema\": \"somebody-else/3\"}".into(), "its schema is 'somebody-else/3'"),
        ("report.json", "{\"title\": \"x\"}".into(), "missing field `schema`"),
        ("report.json", "[1, 2]".into(), "invalid"),
        ("report.json", good[..good.len() / 2].to_owned(), "EOF while parsing"),
        ("report.md", "# My thesis\n".into(), "no report.json beside it"),
        ("timings.json", "{}".into(), "no report.json beside it"),
    ];
    for (name, text, why) in foreign {
        let folder = Folder::with_scene(&scene());
        folder.write(&format!("out/{name}"), text);
        let before = folder.snapshot();
        for command in
            ["run small.toml --out out", "merge small.toml --out out", "run small.toml --json --out out"]
        {
            let ran = folder.run_to(2, command);
            ran.says(&[name, "remainder-report/1", why, "left as it is", "--out"]);
            assert!(ran.stdout.is_empty(), "{}", ran.stdout);
            assert_eq!(before, folder.snapshot());
        }
    }
    // A report of ours is replaced, also that of another scene.
    folder.write("good/report.md", "stale");
    folder.write("small.toml", scene().replace("to = 32", "to = 40"));
    folder.run_to(0, "run small.toml --out good --store elsewhere");
    assert_ne!(folder.text("good/report.json"), good);
    assert!(folder.text("good/report.md").starts_with("# small"));
}

#[test]
fn files_and_folders_in_each_others_place() {
    let folder = Folder::with_scene(&scene());
    folder.write("file", "a file");
    folder.write("out/report.json/inside", "a folder of this name");
    let before = folder.snapshot();
    folder.run_to(2, "run small.toml --out file").says(&["file"]);
    folder.run_to(2, "run small.toml --out file/below").says(&["file"]);
    folder.run_to(2, "run small.toml --out out").says(&["out/report.json"]);
    folder.run_to(2, "run small.toml --store file").says(&["file", "ot a directory"]);
    folder.run_to(2, "merge small.toml file").says(&["file", "is no folder"]);
    assert_eq!(before, folder.snapshot());
}

/// Replaces a stored block by each of these and expects a refusal that names the file and leaves all as it is.
fn refused_in_place_of(folder: &Folder, name: &str, foreign: Vec<(&str, Vec<u8>)>) {
    let path = format!("store/{name}");
    let good = folder.bytes(&path);
    for (what, bytes) in foreign {
        assert_ne!(bytes, good, "{what} is no other block");
        folder.write(&path, bytes);
        let before = folder.snapshot();
        for command in
            ["run small.toml --store store --out again", "merge small.toml --store store --out again"]
        {
            let ran = folder.run_to(2, command);
            ran.says(&[name, "not a whole stored block of this study", "move it away or delete it"]);
            assert!(ran.stdout.is_empty(), "{}", ran.stdout);
            assert_eq!(before, folder.snapshot(), "{what}");
        }
    }
    folder.write(&path, good);
}

#[test]
fn a_foreign_or_truncated_block_is_refused_and_stays() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --store store --out out");
    let blocks = folder.blocks("store");
    let of = |field: &str| -> Vec<&String> {
        blocks.iter().filter(|(_, block)| !block["data"][field].is_null()).map(|(name, _)| name).collect()
    };
    for (field, list) in [("exact_sums", "norms"), ("samples", "moments")] {
        let [first, second, ..] = of(field)[..] else { panic!("two blocks with {field}") };
        let bytes = |block: &serde_json::Value| serde_json::to_vec(block).expect("JSON");
        let edited = |edit: &dyn Fn(&mut serde_json::Value)| {
            let mut block = blocks[first].clone();
            edit(&mut block);
            bytes(&block)
        };
        let whole = folder.bytes(&format!("store/{first}"));
        let foreign = vec![
            ("nothing", Vec::new()),
            ("half", whole[..whole.len() / 2].to_vec()),
            ("all but the end", whole[..whole.len() - 1].to_vec()),
            ("words", b"my own notes".to_vec()),
            ("no text", vec![0xff; 100]),
            ("other JSON", b"[]".to_vec()),
            ("another case's", folder.bytes(&format!("store/{second}"))),
            ("another schema's", edited(&|block| block["schema"] = "remainder-block/9".into())),
            ("another block's", edited(&|block| block["block"] = 77.into())),
            ("one without its end", edited(&|block| block["end"] = false.into())),
            ("one without data", edited(&|block| block["data"] = serde_json::json!({}))),
            ("one with an empty list", edited(&|block| block["data"][list] = serde_json::json!([]))),
            (
                "one with a list cut short",
                edited(&|block| {
                    block["data"][list].as_array_mut().expect("a list").pop();
                }),
            ),
            (
                "one that counts otherwise",
                edited(&|block| match field {
                    "samples" => block["data"]["samples"] = 7.into(),
                    _ => block["data"]["in_support"] = serde_json::json!([]),
                }),
            ),
        ];
        refused_in_place_of(&folder, first, foreign);
    }
    // With the blocks as they were, all is well again.
    folder.run_to(0, "run small.toml --store store --out again");
    assert_eq!(folder.bytes("out/report.json"), folder.bytes("again/report.json"));
    // A block taken away is computed again; the same file elsewhere is found by merge.
    let name = of("samples")[0];
    let taken = folder.bytes(&format!("store/{name}"));
    std::fs::remove_file(folder.path(&format!("store/{name}"))).expect("a block removed");
    folder.run_to(2, "merge small.toml --store store --out merged");
    folder.write(&format!("other/{name}"), &taken[..taken.len() / 2]);
    folder.run_to(2, "merge small.toml other --store store --out merged").says(&["other", name]);
    folder.write(&format!("other/{name}"), taken);
    folder.run_to(0, "merge small.toml other --store store --out merged");
    assert_eq!(folder.bytes("out/report.json"), folder.bytes("merged/report.json"));
}
