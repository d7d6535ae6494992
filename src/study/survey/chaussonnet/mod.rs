//! `kind = "chaussonnet"`: the error study of Chaussonnet et al. (2015), all of it.
//!
//! ```text
//! compute: distances, consistency errors, operators on fields, arithmetic, derived moments  ─▶ stored blocks
//! report:  setup · consistency · gradients · laplacians · fits · precision, from the blocks alone
//! ```
//! `model` turns derived moments into the errors the paper defines; `results` finds measured ones.

mod compute;
mod consistency;
mod fits;
mod gradients;
mod laplacians;
mod model;
mod power;
mod precision;
mod results;
mod setup;

use self::compute::{Errors, Work};
use super::{Parameters, Survey, SurveyTask, TaskError};
use crate::claim::chaussonnet_2015 as published;
use crate::particles::{Lattice, VolumeRule, lattice_by_id};
use crate::record::Report;
use crate::study::plan::Omission;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// R = 3 h.
const KERNEL: &str = "quintic-spline";
/// 2-D Cartesian, 2-D triangular, 3-D Cartesian.
const LATTICES: [&str; 3] = ["square", "hexagonal", "simple-cubic"];

/// `[survey]`: the set-up of §II of the paper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ChaussonnetTable {
    /// h/Δ.
    pub h_over_dx: f64,
    /// η, rising. The text ends with 0.3215, Fig. 3 with 0.3125 = 5 · 0.0625.
    pub eta: Vec<f64>,
    /// K_x.
    pub field_scales: Vec<f64>,
    /// L in metres. The paper does not print it; this is what its fits imply.
    pub domain_size_m: f64,
    /// How far outside of the corner of the inner region ξ = 0 lies, in h. Not printed either: 4 is the corner of the fluid.
    pub origin_h: f64,
    /// h in metres of the operator tests in 2-D, falling.
    pub h_m: Vec<f64>,
    /// h in metres of the operator tests in 3-D, falling.
    pub h_m_3d: Vec<f64>,
    /// h in metres of the consistency tests, falling.
    pub consistency_h_m: Vec<f64>,
    /// Inner particles along a side in the consistency tests, in 2-D and in 3-D.
    pub consistency_side: [u32; 2],
    /// Thickness of the outer and of the wall layer, in h.
    pub layer_h: f64,
    /// The least number of data points, inner particles × grids, in 2-D and in 3-D.
    pub points: [u64; 2],
    /// In 3-D: `printed`, θ and φ even in [0, 2π] and [0, π], or `uniform` on the sphere.
    pub angles: String,
}

impl Default for ChaussonnetTable {
    fn default() -> Self {
        Self {
            h_over_dx: 1.05,
            eta: vec![1e-4, 5e-4, 2.5e-3, 1.25e-2, 6.25e-2, 0.3125],
            field_scales: vec![0.01, 0.1, 1.0, 10.0, 100.0],
            domain_size_m: 0.0115,
            origin_h: 4.0,
            h_m: vec![1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5],
            h_m_3d: vec![1e-3, 5e-4, 2.5e-4],
            consistency_h_m: vec![1e-3, 1e-4, 1e-5, 1e-6],
            consistency_side: [32, 12],
            layer_h: 4.0,
            points: [30_000, 12_000],
            angles: "printed".into(),
        }
    }
}

impl ChaussonnetTable {
    fn shortened(mut self) -> Self {
        let ends = |list: &mut Vec<f64>| {
            if let [first, .., last] = list[..] {
                *list = vec![first, last];
            }
        };
        self.h_m.truncate(3);
        self.h_m_3d.truncate(1);
        ends(&mut self.consistency_h_m);
        // With 1, for which the figures are drawn.
        let (first, last) = (self.field_scales.first().copied(), self.field_scales.last().copied());
        self.field_scales.retain(|scale| *scale == 1.0 || Some(*scale) == first || Some(*scale) == last);
        self.consistency_side = self.consistency_side.map(|side| side.min(16)).map(|side| side.max(4));
        self.points = self.points.map(|points| points.min(1500));
        self
    }

    /// The first key that is wrong, and what is wrong with it.
    fn check(&self) -> Result<(), (String, String)> {
        let fault = |key: &str, what: String| Err((key.to_owned(), what));
        let positive = |x: &f64| x.is_finite() && *x > 0.0;
        if !(0.4..=4.0).contains(&self.h_over_dx) {
            return fault("h_over_dx", format!("is {}, not between 0.4 and 4", self.h_over_dx));
        }
        let lists = [
            ("eta", &self.eta, 3, true),
            ("field_scales", &self.field_scales, 2, true),
            ("h_m", &self.h_m, 3, false),
            ("h_m_3d", &self.h_m_3d, 2, false),
            ("consistency_h_m", &self.consistency_h_m, 2, false),
        ];
        for (key, list, least, rising) in lists {
            if list.len() < least || list.len() > 32 {
                return fault(key, format!("has {} numbers, not {least} to 32", list.len()));
            }
            if let Some(bad) = list.iter().find(|x| !positive(x)) {
                return fault(key, format!("holds {bad}; all must be positive"));
            }
            if list.windows(2).any(|pair| (pair[0] < pair[1]) != rising || pair[0] == pair[1]) {
                let order = if rising { "rise" } else { "fall" };
                return fault(key, format!("must {order} from one number to the next"));
            }
        }
        if let Some(bad) = self.eta.iter().find(|eta| **eta >= 0.5) {
            return fault("eta", format!("holds {bad}; neighbours can meet from 0.5 on"));
        }
        if !self.field_scales.contains(&1.0) {
            return fault("field_scales", "must hold 1, for which the figures are drawn".into());
        }
        if !positive(&self.domain_size_m) {
            return fault("domain_size_m", format!("is {}; it must be positive", self.domain_size_m));
        }
        let most = self.domain_size_m * self.h_over_dx;
        for (key, list, side) in [("h_m", &self.h_m, 1000.0), ("h_m_3d", &self.h_m_3d, 60.0)] {
            if let Some(bad) = list.iter().find(|h| 4.0 * **h > most || most > side * **h) {
                return fault(
                    key,
                    format!("holds {bad:e}: a side of {:.0} particles, not 4 to {side}", most / bad),
                );
            }
        }
        if self.h_m[0] != self.h_m_3d[0] {
            return fault("h_m_3d", "must start where h_m does: lattices are compared there".into());
        }
        if self.consistency_side.iter().any(|side| !(4..=128).contains(side)) || self.consistency_side[1] > 40
        {
            return fault("consistency_side", "must be 4 to 128, and to 40 in 3-D".into());
        }
        if !(2.0..=8.0).contains(&self.layer_h) {
            return fault("layer_h", format!("is {}, not between 2 and 8", self.layer_h));
        }
        if self.points.iter().any(|points| !(100..=10_000_000).contains(points)) {
            return fault("points", "must be 100 to 10000000".into());
        }
        if !(0.0..=16.0).contains(&self.origin_h) {
            return fault("origin_h", format!("is {}, not between 0 and 16", self.origin_h));
        }
        if !["printed", "uniform"].contains(&self.angles.as_str()) {
            return fault("angles", format!("is '{}': write printed or uniform", self.angles));
        }
        Ok(())
    }

    fn is_3d(lattice: &str) -> bool {
        lattice == "simple-cubic"
    }

    /// h of the operator tests.
    fn ladder(&self, lattice: &str) -> &[f64] {
        if Self::is_3d(lattice) { &self.h_m_3d } else { &self.h_m }
    }

    /// `canonical:η` with the angles of the scene, `none` at η = 0.
    fn disorder(&self, lattice: &str, eta: f64) -> String {
        match (eta, Self::is_3d(lattice), self.angles.as_str()) {
            (0.0, ..) => "none".into(),
            (_, true, "printed") => format!("canonical:{eta},angles=printed"),
            _ => format!("canonical:{eta}"),
        }
    }

    fn largest_eta(&self) -> f64 {
        self.eta.last().copied().unwrap_or(0.0)
    }
}

impl Parameters for ChaussonnetTable {
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        self.check()?;
        let table = if quick { self.shortened() } else { self };
        let works = compute::works(&table, quick);
        Ok(Box::new(Chaussonnet { table, seed, works }))
    }
}

/// The survey.
struct Chaussonnet {
    table: ChaussonnetTable,
    seed: u64,
    works: Vec<Work>,
}

impl Survey for Chaussonnet {
    fn tasks(&self) -> Vec<SurveyTask> {
        self.works.iter().map(|work| work.task(&self.table, self.seed)).collect()
    }

    fn claims(&self) -> Vec<String> {
        published::ids()
    }

    fn omissions(&self) -> Vec<Omission> {
        let cases = |h: usize| h * (self.table.eta.len() + 1) * self.table.field_scales.len();
        let all: usize = LATTICES.iter().map(|lattice| cases(self.table.ladder(lattice).len())).sum();
        let taken = self.works.iter().filter(|work| matches!(work, Work::Operators { .. })).count();
        vec![Omission {
            what: "K_x other than 1 on the triangular and the cubic lattice at all h but the largest".into(),
            why: "the operators are linear in the field; all K_x at all h are taken on the square lattice, to which the fits belong"
                .into(),
            saved: Some(format!("{} of {all} sets of particles", all - taken)),
        }]
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        self.works[task].compute(&self.table, self.seed)
    }

    fn found(&self, task: usize, result: &Value) -> Option<String> {
        if !matches!(self.works[task], Work::Consistency { .. } | Work::Operators { .. }) {
            return None;
        }
        let found: Errors = serde_json::from_value(result.clone()).ok()?;
        let (name, error) = found.squares.iter().find(|(_, error)| error.sum > 0.0)?;
        Some(format!("{name} = {:.2e}", (error.sum / error.count as f64).sqrt()))
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let found = results::Results::new(&self.table, &self.works, results)?;
        setup::enter(&found, report);
        consistency::enter(&found, report)?;
        gradients::enter(&found, report)?;
        laplacians::enter(&found, report)?;
        fits::enter(&found, report)?;
        precision::enter(&found, report)?;
        report.cost.samples = found.samples;
        report.cost.pairs = found.pairs;
        Ok(())
    }
}

/// A lattice of [`LATTICES`].
fn lattice(id: &str) -> Result<Lattice, TaskError> {
    Ok(lattice_by_id(id)?)
}

/// Eq. (1).
const RULE: VolumeRule = VolumeRule::NumberDensity;
