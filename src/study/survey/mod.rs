//! Surveys: studies of other kinds than ladders of Δ/h. Each is one file here and one line in [`KINDS`].
//!
//! A survey is a list of tasks whose results are plain data, stored as blocks, and a pure function from these to the
//! report. The runner does the rest: the store, shards, threads, progress, interruption, verdicts over all cases.

mod basa;
mod chaussonnet;
mod entry;
mod extremes;
mod heat;
mod run;
mod scene;
mod stiff;
mod work_precision;

pub use entry::{Row, entry, table_row};
pub use run::run_survey;
pub use scene::{Parameters, SurveyScene, survey_kinds};

use super::plan::Omission;
use crate::record::Report;
use serde_json::Value;
use std::error::Error;

/// Why a task could not be done.
pub type TaskError = Box<dyn Error + Send + Sync>;

/// A unit of work whose result is stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SurveyTask {
    /// For people.
    pub label: String,
    /// All inputs that its result depends on, as text: with the version of the engine, the key of its block.
    pub inputs: String,
    /// Estimated work in pairs.
    pub cost: u64,
}

/// One study: tasks, and what follows from their results.
pub trait Survey: Send + Sync {
    /// The tasks, in a fixed order.
    fn tasks(&self) -> Vec<SurveyTask>;

    /// The ids of the claims it judges.
    fn claims(&self) -> Vec<String>;

    /// What the scene does not need.
    fn omissions(&self) -> Vec<Omission>;

    /// The result of a task, a pure function of its inputs.
    ///
    /// # Errors
    /// [`TaskError`]: what was wrong, where, and what to do.
    fn compute(&self, task: usize) -> Result<Value, TaskError>;

    /// What a task found, in a few words, for those who wait.
    fn found(&self, _task: usize, _result: &Value) -> Option<String> {
        None
    }

    /// Enters claims, fits, series and tables into the report; `results` are those of the tasks, in their order. Provenance,
    /// rolled verdicts and what was left out are entered by the runner.
    ///
    /// # Errors
    /// [`TaskError`] if a result is not what [`Survey::compute`] makes.
    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError>;

    /// What its tasks timed, for `timings.json`: nothing of it may enter the report.
    fn timings(&self, _results: &[Value]) -> Value {
        Value::Null
    }
}
