//! Studies: a scene becomes a plan, the plan is run, its blocks are stored, its claims judged.
//!
//! Emits events and prints nothing. The caller chooses threads (by the rayon pool it calls from), cancellation and the
//! sink of events. What a study returns is a pure function of the scene and its stored blocks.

mod advise;
mod analysis;
mod define_lattice;
mod derive;
mod error;
mod event;
mod judge;
mod ladder;
mod outcome;
mod plan;
mod run;
mod scene;
mod source;
mod store;
mod survey;
mod tables;

pub use advise::{Advice, Candidate, Request as AdviceRequest, advise, derived_error};
pub use analysis::Analysis;
pub use derive::DerivedColumn;
pub use error::StudyError;
pub use event::Event;
pub use outcome::{CaseId, JudgedCase, LadderFit, MeasuredColumn, Outcome, RolledClaim, Rung, Varies};
pub use plan::{Omission, Plan, Task};
pub use run::{RunOptions, Shard, run};
pub use scene::{KINDS as ORDER_KINDS, Scene, read_definitions, read_kernel};
pub use source::{SceneError, SceneText};
pub use store::{BlockStore, write_whole};
pub use survey::{
    Parameters, Row, Survey, SurveyScene, SurveyTask, TaskError, entry, run_survey, survey_kinds, table_row,
};
pub use tables::{DefineTable, RawScene};
