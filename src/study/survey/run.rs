//! Running a survey: every task, from the store where it is there, then the report.

use super::super::StudyError;
use super::super::event::Event;
use super::super::plan::ENGINE;
use super::super::run::RunOptions;
use super::{SurveyScene, SurveyTask};
use crate::claim::{CaseVerdict, roll_up};
use crate::record::{Case, ClaimEntry, LeftOut, Provenance, Report, RolledVerdict, SCHEMA};
use itertools::Itertools as _;
use rayon::prelude::*;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::sync::atomic::Ordering;
use std::time::Instant;

impl SurveyTask {
    /// The key of its block.
    pub fn key(&self) -> String {
        let digest = Sha256::digest(format!("{ENGINE}\n{}", self.inputs).as_bytes());
        digest.iter().fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        })
    }
}

/// Runs a survey. `None` if only a shard was asked for.
///
/// Uses the rayon pool it is called in; the report does not depend on the number of threads.
///
/// # Errors
/// [`StudyError`]; what was finished before stays stored.
pub fn run_survey(scene: &SurveyScene, options: &RunOptions<'_>) -> Result<Option<Report>, StudyError> {
    let tasks = scene.survey.tasks();
    let mine = |index: &usize| options.shard.is_none_or(|shard| index % shard.count == shard.index - 1);
    let mut order = (0..tasks.len()).filter(mine).collect_vec();
    order.sort_by_key(|index| std::cmp::Reverse(tasks[*index].cost));
    let cost = order.iter().map(|index| tasks[*index].cost).fold(0, u64::saturating_add);
    (options.events)(Event::Planned { tasks: order.len(), cost });
    let mut results: Vec<(usize, Result<Option<Value>, StudyError>)> = order
        .par_iter()
        .with_max_len(1)
        .map(|index| (*index, run_task(scene, &tasks[*index], *index, options)))
        .collect();
    results.sort_by_key(|(index, _)| *index);
    let (mut done, mut missing) = (Vec::new(), Vec::new());
    let mut interrupted = false;
    for (index, result) in results {
        match result {
            Ok(Some(value)) => done.push(value),
            Ok(None) => missing.push(index),
            Err(StudyError::Interrupted) => interrupted = true,
            Err(error) => return Err(error),
        }
    }
    if interrupted {
        return Err(StudyError::Interrupted);
    }
    if let Some(example) = missing.first() {
        return Err(StudyError::Incomplete {
            missing: missing.len(),
            tasks: tasks.len(),
            example: tasks[*example].label.clone(),
        });
    }
    if options.shard.is_some() {
        return Ok(None);
    }
    let timed = scene.survey.timings(&done);
    if !timed.is_null() {
        (options.events)(Event::Timed(timed));
    }
    report(scene, &done).map(Some)
}

fn run_task(
    scene: &SurveyScene,
    task: &SurveyTask,
    index: usize,
    options: &RunOptions<'_>,
) -> Result<Option<Value>, StudyError> {
    let started = Instant::now();
    let key = task.key();
    let stored: Option<Value> = options.store.load(&key, 0, |_: &Value| true)?;
    let was_stored = stored.is_some();
    let result = match stored {
        Some(result) => result,
        None if options.stored_only => return Ok(None),
        None => {
            if options.cancel.load(Ordering::Relaxed) {
                return Err(StudyError::Interrupted);
            }
            let fault = |source| StudyError::Survey { task: task.label.clone(), source };
            let result = scene.survey.compute(index).map_err(fault)?;
            options.store.save(&key, 0, &result)?;
            result
        }
    };
    (options.events)(Event::Advanced { cost: task.cost, stored: was_stored });
    let seconds = started.elapsed().as_secs_f64();
    let found = scene.survey.found(index, &result);
    (options.events)(Event::Finished { label: task.label.clone(), seconds, spared: 0, found });
    Ok(Some(result))
}

fn report(scene: &SurveyScene, results: &[Value]) -> Result<Report, StudyError> {
    let mut report = Report {
        schema: SCHEMA.into(),
        provenance: Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: scene.name.clone(),
            title: scene.study.title.clone(),
            scene_sha256: scene.sha256.clone(),
            seed: scene.study.seed,
            features: Vec::new(),
            quick: scene.quick,
        },
        ..Report::default()
    };
    scene
        .survey
        .report(results, &mut report)
        .map_err(|source| StudyError::Survey { task: "the report".into(), source })?;
    let ids = report.claims.iter().map(|entry| entry.id.clone()).unique().collect_vec();
    report.verdicts = ids.into_iter().map(|id| rolled(scene, id, &report.claims)).collect();
    let left_out = scene.survey.omissions().into_iter();
    let left_out =
        left_out.map(|omission| LeftOut { what: omission.what, why: omission.why, saved: omission.saved });
    report.left_out.extend(left_out);
    Ok(report)
}

fn rolled(scene: &SurveyScene, id: String, entries: &[ClaimEntry]) -> RolledVerdict {
    let entries = entries.iter().filter(|entry| entry.id == id).collect_vec();
    let more = entries.iter().flat_map(|entry| entry.case.more.keys()).unique().sorted().collect_vec();
    let cases = entries
        .iter()
        .map(|entry| CaseVerdict { labels: labels(&entry.case, &more), verdict: entry.verdict })
        .collect_vec();
    let judgement = roll_up(&cases);
    // One case speaks for itself.
    let why = match entries.as_slice() {
        [only] => only.why.clone(),
        _ => judgement.why,
    };
    let expected = scene.expect.get(&id).copied();
    RolledVerdict { id, verdict: judgement.verdict, why, expected, cases: cases.len() }
}

/// What tells one case of a claim from another.
fn labels(case: &Case, more: &[&String]) -> Vec<String> {
    let first = [
        format!("{}-D", case.dimension),
        case.disorder.clone().unwrap_or_default(),
        case.kernel.clone(),
        case.lattice.clone().unwrap_or_default(),
        case.volume_rule.clone(),
    ];
    let rest = more.iter().map(|key| match case.more.get(*key) {
        Some(Value::String(text)) => text.clone(),
        Some(value) => format!("{key} {value}"),
        None => String::new(),
    });
    first.into_iter().chain(rest).collect()
}
