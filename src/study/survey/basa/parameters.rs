//! What a scene of this kind may set.

use super::super::{Parameters, Survey};
use super::BasaSurvey;
use super::part::Common;
use crate::claim::basa_2009::DX_OVER_H;
use crate::kernel;
use crate::particles::{Disorder, lattice_by_id};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// `[survey]` of a scene of kind `basa`; the defaults are the paper's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(in super::super) struct BasaParameters {
    /// The kernel of the paper: the cubic B-spline, R = 2h.
    pub kernel: String,
    /// Δx/h of § 6, with h = R/2.
    pub dx_over_h: f64,
    /// Further Δx/h, with h = R/2 for every kernel.
    pub ladder: Vec<f64>,
    /// Disorders on which gradients of the pressure are taken.
    pub disorders: Vec<String>,
    /// p₀ over gradient scale and length.
    pub reference_pressures: Vec<f64>,
    /// h over that length.
    pub smoothing_lengths: Vec<f64>,
    /// Radius of the disordered ball in Δ, of which what lies 2R from its rim is looked at.
    pub ball_radius: f64,
    /// R/Δ of displaced lines.
    pub line_supports: Vec<f64>,
    /// Samples of a displaced line.
    pub line_samples: u64,
    /// Rows of particles across the channel.
    pub rows: usize,
    /// t* of the start-up profiles, Eq. (39).
    pub start_up_times: Vec<f64>,
}

impl Default for BasaParameters {
    fn default() -> Self {
        Self {
            kernel: "cubic-spline".into(),
            dx_over_h: DX_OVER_H,
            ladder: vec![0.4, 0.5, 0.75, 1.0 / 1.2, 1.0],
            disorders: ["canonical:0.01", "canonical:0.05", "canonical:0.1", "canonical:0.2"]
                .map(Into::into)
                .into(),
            reference_pressures: vec![0.0, 1.0, 1e3, 1e6, 1e9],
            smoothing_lengths: vec![1.0, 0.5, 0.25, 0.125],
            ball_radius: 24.0,
            line_supports: vec![8.3, 11.9, 16.7, 23.4, 33.1, 46.7, 65.9],
            line_samples: 400,
            rows: 20,
            start_up_times: vec![0.006, 0.025, 0.1],
        }
    }
}

impl Parameters for BasaParameters {
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        let fault = |key: &str, what: String| (key.to_owned(), what);
        let kernel = kernel::by_id(&self.kernel).map_err(|error| fault("kernel", error.to_string()))?;
        let positive = |key: &str, values: &[f64], most: f64| match values
            .iter()
            .find(|value| !(**value > 0.0 && **value <= most))
        {
            Some(value) => Err(fault(key, format!("must be above 0 and at most {most}, not {value}"))),
            None => Ok(()),
        };
        positive("dx_over_h", &[self.dx_over_h], 1.2)?;
        positive("ladder", &self.ladder, 1.2)?;
        positive("smoothing_lengths", &self.smoothing_lengths, 1e3)?;
        positive("line_supports", &self.line_supports, 1e3)?;
        positive("ball_radius", &[self.ball_radius], 200.0)?;
        positive("start_up_times", &self.start_up_times, 10.0)?;
        if let Some(small) = self.ladder.iter().find(|x| **x < 0.2) {
            return Err(fault("ladder", format!("{small} takes more neighbours than it needs: 0.2 or more")));
        }
        if self.smoothing_lengths.len() < 3 {
            return Err(fault("smoothing_lengths", "needs three values or more for a slope".into()));
        }
        if self.line_supports.len() < 3 {
            return Err(fault("line_supports", "needs three values or more for a slope".into()));
        }
        if let Some(p) = self.reference_pressures.iter().find(|p| !p.is_finite() || **p < 0.0) {
            return Err(fault("reference_pressures", format!("must be finite and not negative, not {p}")));
        }
        if self.reference_pressures.iter().filter(|p| **p > 0.0).count() < 3 {
            return Err(fault(
                "reference_pressures",
                "needs three positive values or more for a slope".into(),
            ));
        }
        if !(8..=200).contains(&self.rows) {
            return Err(fault("rows", format!("must be 8 to 200, not {}", self.rows)));
        }
        if self.line_samples < 2 {
            return Err(fault("line_samples", "must be 2 or more".into()));
        }
        let inner = self.ball_radius - 4.0 / self.dx_over_h;
        if inner < 3.0 {
            return Err(fault(
                "ball_radius",
                format!("leaves {inner:.1} Δ inside 2R from the rim: make it larger"),
            ));
        }
        let square = lattice_by_id("square").map_err(|error| fault("kernel", error.to_string()))?;
        let disorders = self.disorders.iter().map(|text| {
            let disorder = Disorder::parse(text).map_err(|error| fault("disorders", error.to_string()))?;
            disorder.check_reach(&square).map_err(|error| fault("disorders", error.to_string()))?;
            Ok::<_, (String, String)>(disorder)
        });
        let disorders = disorders.collect::<Result<Vec<_>, _>>()?;
        if disorders.len() < 3 {
            return Err(fault("disorders", "needs three or more for a slope".into()));
        }
        let mut parameters = self;
        if quick {
            parameters.line_samples = parameters.line_samples.min(100);
            parameters.ladder.truncate(1);
            parameters.ball_radius = parameters.ball_radius.min(4.0 / parameters.dx_over_h + 6.0);
        }
        let common = Arc::new(Common { kernel, parameters, disorders, seed, quick });
        Ok(Box::new(BasaSurvey::new(&common)))
    }
}
