//! Exit codes that scripts can use, and what led to them.

use crate::language::LanguageError;
use crate::report::{ReadError, Report, Verdict, WriteError};
use crate::study::{SceneError, StudyError};
use thiserror::Error;

/// How the program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// 0: all verdicts as the scene expects.
    AsExpected,
    /// 1: a verdict differs from what the scene expects, or two reports from each other.
    Differs,
    /// 2: the input is wrong.
    WrongInput,
    /// 3: a verdict is inconclusive where the scene does not expect that.
    Inconclusive,
    /// 130: interrupted.
    Interrupted,
}

impl Exit {
    /// The code.
    pub fn code(self) -> u8 {
        match self {
            Self::AsExpected => 0,
            Self::Differs => 1,
            Self::WrongInput => 2,
            Self::Inconclusive => 3,
            Self::Interrupted => 130,
        }
    }

    /// 1 before 3: a verdict that differs outweighs one that is open.
    pub fn of(report: &Report) -> Self {
        let mut exit = Self::AsExpected;
        for rolled in &report.verdicts {
            match rolled.expected {
                Some(expected) if expected == rolled.verdict => {}
                _ if rolled.verdict == Verdict::Inconclusive => exit = Self::Inconclusive,
                Some(_) => return Self::Differs,
                None => {}
            }
        }
        exit
    }
}

/// Why a command could not do its work.
#[derive(Debug, Error)]
pub(super) enum Failure {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("{1}")]
    Operator(String, LanguageError),
    #[error("{0}")]
    Arguments(String),
}

impl Failure {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Study(StudyError::Interrupted) => Exit::Interrupted,
            _ => Exit::WrongInput,
        }
    }
}
