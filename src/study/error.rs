//! What can go wrong in a study.

use super::source::SceneError;
use crate::measured::{RegularError, SampleError};
use std::path::PathBuf;
use thiserror::Error;

/// Errors of the study layer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The plan is beyond the budget that the scene declares.
    #[error(
        "the plan needs about {needed:.3e} pairs, more than the {allowed:.3e} of limits.most_pairs: shorten the ladders, lower the samples, or raise the budget"
    )]
    Budget {
        /// Estimated pairs.
        needed: u64,
        /// `limits.most_pairs`.
        allowed: u64,
    },
    /// A rung of regular particles could not be taken.
    #[error("{task}: {source}")]
    Regular {
        /// The task.
        task: String,
        /// Why.
        source: RegularError,
    },
    /// A sample could not be taken.
    #[error("{task}: {source}")]
    Sample {
        /// The task.
        task: String,
        /// Why.
        source: SampleError,
    },
    /// A task of a survey could not be done.
    #[error("{task}: {source}")]
    Survey {
        /// The task.
        task: String,
        /// Why.
        source: super::TaskError,
    },
    /// A file could not be read or written.
    #[error("{action} {}: {source}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A file stands where a stored block should, and is none, or not whole.
    #[error("{} is not a whole stored block of this study ({what}): move it away or delete it, and run again", path.display())]
    ForeignBlock {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// Blocks are missing where all should be stored.
    #[error(
        "{missing} of {tasks} tasks are not complete in the store, for example {example}: run the remaining shards first"
    )]
    Incomplete {
        /// Tasks without all their blocks.
        missing: usize,
        /// All tasks.
        tasks: usize,
        /// One of them.
        example: String,
    },
    /// The caller asked to stop; every finished block is stored.
    #[error("interrupted; every finished block is stored, and the same command goes on from there")]
    Interrupted,
}
