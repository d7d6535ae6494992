//! Basa, Quinlan & Lastiwka (2009), the static part: what its viscous models, corrections and walls do to given fields.
//!
//! Every part is a few tasks and what follows from them. Runs of the channel and the cavity are no part of it.

mod consistency;
mod constants;
mod equations;
mod parameters;
mod part;
mod pressure;
mod row;
mod viscosity;
mod walls;

pub(super) use parameters::BasaParameters;

use super::super::plan::Omission;
use super::{Survey, SurveyTask, TaskError};
use crate::claim::basa_2009::basa_2009;
use crate::record::Report;
use part::{Common, Part};
use serde_json::Value;
use std::sync::Arc;

/// The study.
struct BasaSurvey {
    parts: Vec<Box<dyn Part>>,
}

impl BasaSurvey {
    fn new(common: &Arc<Common>) -> Self {
        Self {
            parts: vec![
                Box::new(equations::Equations::new(common)),
                Box::new(consistency::ConsistencyPart::new(common)),
                Box::new(viscosity::ViscosityPart::new(common)),
                Box::new(row::RowPart::new(common)),
                Box::new(pressure::PressurePart::new(common)),
                Box::new(walls::WallPart::new(common)),
            ],
        }
    }

    /// The part of a task, and the task's number within it.
    fn part_of(&self, task: usize) -> Option<(&dyn Part, usize)> {
        let mut first = 0;
        for part in &self.parts {
            let count = part.tasks().len();
            if task < first + count {
                return Some((part.as_ref(), task - first));
            }
            first += count;
        }
        None
    }
}

impl Survey for BasaSurvey {
    fn tasks(&self) -> Vec<SurveyTask> {
        self.parts.iter().flat_map(|part| part.tasks()).collect()
    }

    fn claims(&self) -> Vec<String> {
        basa_2009().into_iter().map(|assertion| assertion.id).collect()
    }

    fn omissions(&self) -> Vec<Omission> {
        let flows = "a flow in time, not the error of an operator on a given field";
        let left_out = |what: &str, why: &str| Omission { what: what.into(), why: why.into(), saved: None };
        vec![
            left_out("Figs. 2, 5 to 10: channel and cavity runs, robustness, drift", flows),
            left_out(
                "Fig. 4: velocity profiles after a short time",
                "of a flow in time; the viscous term that drives it is here",
            ),
            left_out(
                "the error levels of Fig. 5",
                "they are printed as curves alone; effective viscosities are held against what the text says of them",
            ),
        ]
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        match self.part_of(task) {
            Some((part, task)) => part.compute(task),
            None => Err(format!("there is no task {task}").into()),
        }
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let mut rest = results;
        for part in &self.parts {
            let (own, others) = rest.split_at(part.tasks().len().min(rest.len()));
            part.report(own, report)?;
            rest = others;
        }
        let order: Vec<String> = self.claims();
        let place = |id: &String| order.iter().position(|known| known == id);
        report.claims.sort_by_key(|entry| place(&entry.id));
        Ok(())
    }
}
