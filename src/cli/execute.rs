//! `run`, `merge` and `plan`.

use super::arguments::{PlanArguments, RunArguments};
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::{pages, terminal, views};
use crate::report::{assemble, check_target, to_json, write_report};
use crate::study::{
    Analysis, BlockStore, Omission, Plan, RunOptions, SurveyScene, run as run_study, run_survey,
};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub(super) fn run(arguments: &RunArguments, stored_only: bool) -> Result<Exit, Failure> {
    let started = Instant::now();
    let analysis = Analysis::read(&arguments.scene, arguments.quick)?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("reports").join(analysis.name()));
    check_target(&out)?;
    let plan = match &analysis {
        Analysis::Orders(scene) => Some(Plan::within_budget(scene)?),
        Analysis::Survey(_) => None,
    };
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
    stop_when_asked(&cancel);
    let progress = Progress::new();
    let options = RunOptions {
        store: BlockStore::new(&arguments.store, arguments.from.clone()),
        shard: arguments.shard,
        stored_only,
        cancel: &cancel,
        events: &|event| progress.take(event),
    };
    let report = pool.install(|| match (&analysis, &plan) {
        (Analysis::Orders(scene), Some(plan)) => {
            run_study(scene, plan, &options).map(|outcome| outcome.as_ref().map(assemble))
        }
        (Analysis::Orders(_), None) => unreachable!("a study of orders has a plan"),
        (Analysis::Survey(scene), _) => run_survey(scene, &options),
    });
    let (seconds, stored, timed) = progress.finish();
    let Some(report) = report? else {
        let name = arguments.scene.display();
        note(&format!(
            "this shard's blocks are stored; when all are, `remainder merge {name}` writes the report"
        ));
        return Ok(Exit::AsExpected);
    };
    let mut timings = json!({
        "wall_seconds": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
        "blocks_found_stored": stored,
        "task_seconds": seconds,
    });
    if !timed.is_null() {
        timings["timed"] = timed;
    }
    write_report(&out, &report, &timings)?;
    views::write(&arguments.views, std::slice::from_ref(&report))?;
    if arguments.html {
        pages::beside(&out, arguments.out.is_none())?;
    }
    if arguments.json {
        print_out(&to_json(&report));
    } else {
        print_out(&terminal::table(&report));
        print_out(&format!("Written to {}.\n", out.display()));
    }
    Ok(Exit::of(&report))
}

/// Has an interrupt set `cancel`, and another one, later on, end the program at once.
fn stop_when_asked(cancel: &Arc<AtomicBool>) {
    /// What ends a program may send its signal to the process and to its group: that is one request.
    const ONE_REQUEST: Duration = Duration::from_secs(1);
    let cancel = Arc::clone(cancel);
    let mut first = None;
    // The handler can be set once per process; where a caller has set one, theirs stays.
    let _ = ctrlc::set_handler(move || {
        cancel.store(true, Ordering::Relaxed);
        match first {
            // What is finished is stored by then, each file whole.
            Some(first) if Instant::elapsed(&first) > ONE_REQUEST => {
                std::process::exit(Exit::Interrupted.code().into());
            }
            Some(_) => {}
            None => {
                first = Some(Instant::now());
                note(
                    "\nstopping after the work in hand; once more stops at once (what is finished is stored)",
                );
            }
        }
    });
}

pub(super) fn plan(arguments: &PlanArguments) -> Result<Exit, Failure> {
    let scene = match Analysis::read(&arguments.scene, arguments.quick)? {
        Analysis::Orders(scene) => scene,
        Analysis::Survey(scene) => return Ok(plan_survey(&scene, arguments.json)),
    };
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
    text += &left_out(&plan.omissions);
    print_out(&terminal::fitted(&text));
    Ok(Exit::AsExpected)
}

fn plan_survey(scene: &SurveyScene, as_json: bool) -> Exit {
    let (tasks, omissions) = (scene.survey.tasks(), scene.survey.omissions());
    let cost = tasks.iter().map(|task| task.cost).fold(0, u64::saturating_add);
    if as_json {
        let value = json!({
            "scene": scene.name,
            "claims": scene.survey.claims(),
            "tasks": tasks.iter().map(|task| json!({"label": task.label, "key": task.key(), "pairs": task.cost})).collect::<Vec<_>>(),
            "most_pairs": cost,
            "left_out": omissions.iter().map(|o| json!({"what": o.what, "why": o.why, "saved": o.saved})).collect::<Vec<_>>(),
        });
        print_out(&format!("{value:#}\n"));
        return Exit::AsExpected;
    }
    let claims = scene.survey.claims().len();
    let mut text = format!(
        "{}: {claims} claims, {} tasks\n  about {:.2e} pairs\n",
        scene.name,
        tasks.len(),
        cost as f64
    );
    text += "\nComputed:\n";
    for task in &tasks {
        text += &format!("  {}: {:.1e} pairs\n", task.label, task.cost as f64);
    }
    text += &left_out(&omissions);
    print_out(&terminal::fitted(&text));
    Exit::AsExpected
}

fn left_out(omissions: &[Omission]) -> String {
    let mut text = "\nLeft out:\n".to_owned();
    for omission in omissions {
        let saved = omission.saved.as_ref().map(|saved| format!(" (saves {saved})")).unwrap_or_default();
        text += &format!("  {}: {}{saved}\n", omission.what, omission.why);
    }
    text
}

/// Prints a line to standard error, whether or not anyone reads it.
pub(super) fn note(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Prints to standard output; a reader that has gone away (a closed pipe) is no error of ours.
pub(super) fn print_out(text: &str) {
    use std::io::Write as _;
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}
