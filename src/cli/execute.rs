//! `run`, `merge` and `plan`.

use super::arguments::{PlanArguments, RunArguments};
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::terminal;
use crate::report::{assemble, check_target, to_json, write_report};
use crate::study::{BlockStore, Plan, RunOptions, Scene, run as run_study};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

pub(super) fn run(arguments: &RunArguments, stored_only: bool) -> Result<Exit, Failure> {
    let started = Instant::now();
    let scene = Scene::read(&arguments.scene, arguments.quick)?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("reports").join(&scene.name));
    check_target(&out)?;
    let plan = Plan::within_budget(&scene)?;
    if let Some(missing) = arguments.from.iter().find(|folder| !folder.is_dir()) {
        let message = format!("{} is no folder: name the folders of finished blocks", missing.display());
        return Err(Failure::Arguments(message));
    }
    // None: rayon's own default, one per core.
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::Arguments(format!("cannot start {threads} threads: {error}")))?;
    let cancel = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&cancel);
    // The handler can be set once per process; where a caller has set one, theirs stays.
    let _ = ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed));
    let progress = Progress::new();
    let options = RunOptions {
        store: BlockStore::new(&arguments.store, arguments.from.clone()),
        shard: arguments.shard,
        stored_only,
        cancel: &cancel,
        events: &|event| progress.take(event),
    };
    let outcome = pool.install(|| run_study(&scene, &plan, &options));
    let (seconds, stored) = progress.finish();
    let Some(outcome) = outcome? else {
        let name = arguments.scene.display();
        eprintln!("this shard's blocks are stored; when all are, `remainder merge {name}` writes the report");
        return Ok(Exit::AsExpected);
    };
    let report = assemble(&outcome);
    let timings = json!({
        "wall_seconds": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
        "blocks_found_stored": stored,
        "task_seconds": seconds,
    });
    write_report(&out, &report, &timings)?;
    if arguments.json {
        print_out(&to_json(&report));
    } else {
        print_out(&terminal::table(&report));
        print_out(&format!("Written to {}.\n", out.display()));
    }
    Ok(Exit::of(&report))
}

pub(super) fn plan(arguments: &PlanArguments) -> Result<Exit, Failure> {
    let scene = Scene::read(&arguments.scene, arguments.quick)?;
    let plan = Plan::of(&scene);
    if arguments.json {
        let value = json!({
            "scene": scene.name,
            "claims": scene.claims.iter().map(|claim| &claim.id).collect::<Vec<_>>(),
            "tasks": plan.tasks.iter().map(|task| json!({"label": task.label(), "key": task.key(), "pairs": task.cost(&scene)})).collect::<Vec<_>>(),
            "exact_sums": plan.exact_sums,
            "most_samples": plan.most_samples,
            "most_pairs": plan.most_pairs,
            "left_out": plan.omissions.iter().map(|o| json!({"what": o.what, "why": o.why, "saved": o.saved})).collect::<Vec<_>>(),
        });
        print_out(&format!("{value:#}\n"));
        return Ok(Exit::AsExpected);
    }
    let mut text = format!("{}: {} claims, {} tasks\n", scene.name, scene.claims.len(), plan.tasks.len());
    text += &format!(
        "  {} exact sums; at most {} samples, about {:.2e} pairs\n",
        plan.exact_sums, plan.most_samples, plan.most_pairs as f64
    );
    text += "\nComputed:\n";
    for task in &plan.tasks {
        text += &format!("  {}: {:.1e} pairs\n", task.label(), task.cost(&scene) as f64);
    }
    text += "\nLeft out:\n";
    for omission in &plan.omissions {
        let saved = omission.saved.as_ref().map(|saved| format!(" (saves {saved})")).unwrap_or_default();
        text += &format!("  {}: {}{saved}\n", omission.what, omission.why);
    }
    print_out(&text);
    Ok(Exit::AsExpected)
}

/// Prints to standard output; a reader that has gone away (a closed pipe) is no error of ours.
pub(super) fn print_out(text: &str) {
    use std::io::Write as _;
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}
