//! Killed and interrupted runs lose nothing but the block in flight.
#![cfg(unix)]

use crate::folder::{Folder, PROGRAM};
use crate::scenes::{DISORDERED, SMALL};
use std::io::Read as _;
use std::os::unix::process::ExitStatusExt as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

fn start(folder: &Folder, arguments: &str) -> Child {
    Command::new(PROGRAM)
        .current_dir(folder.path(""))
        .args(arguments.split_whitespace())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

#[test]
fn a_run_killed_at_twenty_moments_resumes_to_the_same_bytes() {
    let folder = Folder::with_scene(SMALL);
    let started = Instant::now();
    folder.run_to(0, "run small.toml --store whole --out report");
    let duration = started.elapsed();
    let report = folder.text("report/report.json");
    let markdown = folder.text("report/report.md");
    let all = folder.blocks("whole");
    let (mut killed, mut partial) = (0, 0);
    // One moment in each twentieth of the run, at a place within it from a linear congruential sequence.
    let mut state = 20_260_101_u64;
    for moment in 0..20_u32 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let within = (state >> 40) as f64 / f64::from(1_u32 << 24);
        let (store, out) = (format!("store{moment}"), format!("out{moment}"));
        let command = format!("run small.toml --store {store} --out {out}");
        // What an earlier kill may have left.
        folder
            .write(&format!("{store}/.{}.1.tmp", all.keys().next().expect("a block")), b"{\"schema\": \"rem");
        folder.write(&format!("{out}/.report.json.1.tmp"), b"{");
        let mut child = start(&folder, &command);
        std::thread::sleep(duration.mul_f64((f64::from(moment) + within) / 20.0));
        child.kill().expect("a kill");
        let status = child.wait().expect("an end");
        killed += u32::from(status.signal() == Some(9));
        // Every block there is whole, and the one of the whole run.
        let kept = folder.blocks(&store);
        for (name, block) in &kept {
            assert_eq!(Some(block), all.get(name), "{name}");
        }
        partial += u32::from(!kept.is_empty() && kept.len() < all.len());
        folder.run_to(0, &command);
        assert!(folder.text(&format!("{out}/report.json")) == report, "killed at moment {moment}");
        assert!(folder.text(&format!("{out}/report.md")) == markdown, "killed at moment {moment}");
        assert_eq!(folder.blocks(&store), all);
        assert_eq!(folder.json(&format!("{out}/timings.json"))["blocks_found_stored"], kept.len());
    }
    assert!(killed >= 5 && partial >= 3, "{killed} runs were killed, {partial} of them with work half done");
}

#[test]
fn an_interrupt_ends_with_130_and_keeps_the_blocks() {
    let scene = format!(
        "[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"line\"]\ndisorders = [\"box:0.4\"]\n\
         [claims]\nuse = [\"fatehi-eq-38\"]\n{DISORDERED}\n\
         [samples]\nblock = 64\nprecision = 1e-9\nmost_blocks = 100\n"
    );
    let folder = Folder::with_scene(&scene);
    let mut child = start(&folder, "run small.toml --store store --out out");
    let patience = Instant::now();
    while folder.blocks("store").len() < 5 {
        assert!(patience.elapsed() < Duration::from_secs(60), "no block was stored");
        std::thread::sleep(Duration::from_millis(2));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    let mut stderr = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut stderr).expect("text");
    let status = child.wait().expect("an end");
    assert_eq!(status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted") && stderr.contains("every finished block is stored"), "{stderr}");
    assert!(!folder.path("out").exists(), "an interrupted run writes no report");
    let kept = folder.blocks("store");
    assert!(kept.len() >= 5 && kept.len() < 1000, "{} blocks", kept.len());
    folder.run_to(0, "run small.toml --store store --out out");
    let timings = folder.json("out/timings.json");
    assert_eq!(timings["blocks_found_stored"], kept.len(), "{timings}");
    let all = folder.blocks("store");
    assert_eq!(all.len(), 1000);
    assert!(kept.iter().all(|(name, block)| all.get(name) == Some(block)));
}

#[test]
fn a_second_interrupt_does_not_wait_for_the_task_in_hand() {
    // A short task, whose block shows that the run has begun, and one of some 10⁹ time steps.
    let run = |n: u32, integrator: &str| {
        format!(
            "[[survey.runs]]\nn = [{n}]\nh_over_dx = [2.5]\nschemes = [\"S3\"]\nepsilon = [0.0]\n\
             integrators = [\"{integrator}\"]\n"
        )
    };
    let folder = Folder::with_scene(&format!(
        "[study]\nkind = \"heat\"\ntitle = \"long\"\nseed = 1\n[survey]\ncourant = 1e-7\n{}{}",
        run(10, "exact"),
        run(40, "euler")
    ));
    let mut child = start(&folder, "run small.toml --store store --out out --threads 2");
    let interrupt = |child: &Child| {
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
        assert!(sent.success());
    };
    let mut stderr = child.stderr.take().expect("a pipe");
    let mut said = [0; 1];
    let mut text = String::new();
    let patience = Instant::now();
    while folder.blocks("store").is_empty() && patience.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    interrupt(&child);
    while !text.contains("once more") && patience.elapsed() < Duration::from_secs(60) {
        stderr.read_exact(&mut said).expect("a message");
        text.push(char::from(said[0]));
    }
    assert!(child.try_wait().expect("a child").is_none(), "the first interrupt waits for the task in hand");
    // Signals that come together are one request; nobody need read what is said.
    drop(stderr);
    let status = loop {
        interrupt(&child);
        std::thread::sleep(Duration::from_millis(300));
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        if patience.elapsed() > Duration::from_secs(120) {
            child.kill().expect("a kill");
        }
    };
    assert_eq!(status.code(), Some(130), "{text}");
    assert!(!folder.path("out").exists());
}
