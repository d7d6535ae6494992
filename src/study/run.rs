//! Running a plan: every task, every block, from the store where it is there.

use super::StudyError;
use super::event::Event;
use super::judge::judge;
use super::outcome::Outcome;
use super::plan::{Omission, Plan, Task, sample_pairs};
use super::scene::Scene;
use super::store::BlockStore;
use crate::measured::{RegularRung, RegularSpec, SampleBlock, SampleSpec, Sampler, is_precise, regular_rung};
use crate::particles::PointGroup;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Part `index` of `count`, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which part.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

/// How a study is run.
pub struct RunOptions<'a> {
    /// Where blocks are kept.
    pub store: BlockStore,
    /// Only this part of the tasks.
    pub shard: Option<Shard>,
    /// Only what is stored: nothing is computed, and what is missing is an error.
    pub stored_only: bool,
    /// Set to stop after the block in flight.
    pub cancel: &'a AtomicBool,
    /// Told what happens, from several threads.
    pub events: &'a (dyn Fn(Event) + Sync),
}

/// The blocks of one task.
#[derive(Debug, Clone)]
pub(super) enum TaskResult {
    Regular(RegularRung),
    Samples { blocks: Vec<SampleBlock>, floors: Vec<f64> },
}

/// Runs a scene. `None` if only a shard was asked for: its blocks are stored, and merging them gives the outcome.
///
/// Uses the rayon pool it is called in; the outcome does not depend on the number of threads.
///
/// # Errors
/// [`StudyError`]; what was finished before stays stored.
pub fn run(scene: &Scene, plan: &Plan, options: &RunOptions<'_>) -> Result<Option<Outcome>, StudyError> {
    let mine = |index: usize| options.shard.is_none_or(|shard| index % shard.count == shard.index - 1);
    let mut order: Vec<usize> = (0..plan.tasks.len()).filter(|index| mine(*index)).collect();
    // The longest first, so that the end of the run keeps all threads busy.
    order.sort_by_key(|index| std::cmp::Reverse(plan.tasks[*index].cost(scene)));
    let cost = order.iter().map(|index| plan.tasks[*index].cost(scene)).fold(0, u64::saturating_add);
    (options.events)(Event::Planned { tasks: order.len(), cost });
    let results: Vec<(usize, Result<Option<TaskResult>, StudyError>)> = order
        .par_iter()
        .with_max_len(1)
        .map(|index| (*index, run_task(scene, &plan.tasks[*index], options)))
        .collect();
    let mut done: Vec<Option<TaskResult>> = vec![None; plan.tasks.len()];
    let mut missing = Vec::new();
    let mut first_error: Option<(usize, StudyError)> = None;
    for (index, result) in results {
        match result {
            Ok(Some(result)) => done[index] = Some(result),
            Ok(None) => missing.push(index),
            // Of several errors the one of the earliest task, whichever thread met it first; an interruption last.
            Err(error) => {
                let rank = |at: usize, error: &StudyError| (matches!(error, StudyError::Interrupted), at);
                if first_error.as_ref().is_none_or(|(at, known)| rank(index, &error) < rank(*at, known)) {
                    first_error = Some((index, error));
                }
            }
        }
    }
    if let Some((_, error)) = first_error {
        return Err(error);
    }
    if let Some(example) = missing.iter().min() {
        return Err(StudyError::Incomplete {
            missing: missing.len(),
            tasks: plan.tasks.len(),
            example: plan.tasks[*example].label(),
        });
    }
    if options.shard.is_some() {
        return Ok(None);
    }
    let results: Vec<TaskResult> = done.into_iter().flatten().collect();
    let mut outcome = judge(scene, plan, &results);
    let (blocks, precision) = scene.sampling();
    let taken: u64 = results
        .iter()
        .map(|r| if let TaskResult::Samples { blocks, .. } = r { blocks.len() as u64 } else { 0 })
        .sum();
    let tasks = results.iter().filter(|r| matches!(r, TaskResult::Samples { .. })).count() as u64;
    if taken < tasks * blocks {
        outcome.omissions.push(Omission {
            what: "samples past the wanted precision".into(),
            why: format!("sampling stopped where every root mean square had reached a relative standard error of {precision}"),
            saved: Some(format!(
                "{} of {} samples",
                (tasks * blocks - taken) * scene.raw.samples.block,
                tasks * blocks * scene.raw.samples.block
            )),
        });
    }
    Ok(Some(outcome))
}

fn is_rung_of(rung: &RegularRung, spec: &RegularSpec) -> bool {
    let supports = spec.supports.len();
    rung.supports.len() == supports
        && rung.in_support.len() == supports
        && rung.norms.len() == supports
        && rung.norms.iter().all(|norms| norms.len() == spec.subjects.len())
}

/// What a rung found of its first subject, at the last of its R/Δ.
fn found_regular(spec: &RegularSpec, rung: &RegularRung) -> Option<String> {
    let (subject, support) = (spec.subjects.first()?, rung.supports.last()?);
    let norm = rung.norms.last()?.first()?;
    Some(format!("{} is off by {:.1e} at R/Δ = {support}", subject.name(), norm.deviation))
}

/// What samples found of their first subject.
fn found_samples(spec: &SampleSpec, blocks: &[SampleBlock]) -> Option<String> {
    let subject = spec.subjects.first()?;
    let square: f64 = blocks.iter().filter_map(|block| block.moments.first()).map(|m| m.sum_square).sum();
    let count: u64 = blocks.iter().map(|block| block.samples - block.degenerate).sum();
    let rms = (square / count as f64).sqrt();
    rms.is_finite().then(|| format!("{} varies by {rms:.1e}, {count} samples", subject.name()))
}

/// All blocks of a task; `None` if some are missing and nothing may be computed.
fn run_task(scene: &Scene, task: &Task, options: &RunOptions<'_>) -> Result<Option<TaskResult>, StudyError> {
    let started = Instant::now();
    let key = task.key();
    let advanced = |cost: u64, stored: bool| (options.events)(Event::Advanced { cost, stored });
    let finished = |spared: u64, found: Option<String>| {
        (options.events)(Event::Finished {
            label: task.label(),
            seconds: started.elapsed().as_secs_f64(),
            spared,
            found,
        });
    };
    let stop_if_asked =
        || if options.cancel.load(Ordering::Relaxed) { Err(StudyError::Interrupted) } else { Ok(()) };
    match task {
        Task::Regular(spec) => {
            let stored: Option<RegularRung> = options.store.load(&key, 0, |rung| is_rung_of(rung, spec))?;
            let was_stored = stored.is_some();
            let rung = match stored {
                Some(rung) => rung,
                None if options.stored_only => return Ok(None),
                None => {
                    stop_if_asked()?;
                    let group = PointGroup::of(&spec.lattice);
                    let rung = regular_rung(spec, &group)
                        .map_err(|source| StudyError::Regular { task: task.label(), source })?;
                    options.store.save(&key, 0, &rung)?;
                    rung
                }
            };
            advanced(task.cost(scene), was_stored);
            finished(0, found_regular(spec, &rung));
            Ok(Some(TaskResult::Regular(rung)))
        }
        Task::Samples { spec, .. } => {
            let fault = |source| StudyError::Sample { task: task.label(), source };
            let sampler = Sampler::new(spec.clone()).map_err(fault)?;
            let (most, precision) = scene.sampling();
            let size = scene.raw.samples.block;
            // A block's file is found by the block size too: another size is another block.
            let key = format!("{key}-{size}");
            let mut blocks: Vec<SampleBlock> = Vec::new();
            while (blocks.len() as u64) < most && !(blocks.len() >= 2 && is_precise(&blocks, precision)) {
                let number = blocks.len() as u64;
                let stored: Option<SampleBlock> =
                    options.store.load(&key, number, |block: &SampleBlock| {
                        block.samples == size
                            && block.degenerate <= size
                            && block.moments.len() == spec.subjects.len()
                    })?;
                let was_stored = stored.is_some();
                let block = match stored {
                    Some(block) => block,
                    None if options.stored_only => return Ok(None),
                    None => {
                        stop_if_asked()?;
                        let block = sampler.block(number * size, size).map_err(fault)?;
                        options.store.save(&key, number, &block)?;
                        block
                    }
                };
                blocks.push(block);
                advanced(size.saturating_mul(sample_pairs(spec)), was_stored);
            }
            let spared = ((most - blocks.len() as u64) * size).saturating_mul(sample_pairs(spec));
            finished(spared, found_samples(spec, &blocks));
            Ok(Some(TaskResult::Samples { blocks, floors: sampler.floors().to_vec() }))
        }
    }
}
