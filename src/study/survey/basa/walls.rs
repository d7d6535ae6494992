//! § 6.1.2: the viscous term near a wall, and the steady flow that each wall gives.

use super::super::{SurveyTask, TaskError, table_row};
use super::part::{Common, Part, With, judge, series, sides, stored};
use crate::claim::basa_2009::{MODEL_C_FACTOR, XI_POISEUILLE};
use crate::claim::{Measured, Observed};
use crate::derived::ChannelFlow;
use crate::language::{Operator, ViscousModel};
use crate::measured::{Channel, Wall, WallError};
use crate::particles::VolumeRule;
use crate::record::{Case, Report, significant};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// Rows from the wall that are reported.
const ROWS: usize = 5;

/// A model as it is used beside a wall, and the number that its bare sum is multiplied by.
const MODELS: [(&str, f64); 4] =
    [("B, first-order correction", 1.0), ("C", MODEL_C_FACTOR), ("D", 2.0 * XI_POISEUILLE), ("E", 1.0)];

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Term {
    wall: String,
    on_wall: bool,
    /// t*, or none for the parabola.
    time: Option<f64>,
    /// Row by row from the lower wall: y/d, the viscous term, what it should be, in U₀/d².
    rows: Vec<[f64; 3]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Steady {
    wall: String,
    on_wall: bool,
    /// None if the equations of the rows are singular: two passes of first derivatives do not see every other row.
    flow: Option<Calibration>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Calibration {
    /// Velocity of the rows next to the centre over the exact one.
    centre: f64,
    /// The number by which the model's own constant is to be multiplied for the least error of Eq. (38).
    factor: f64,
    /// That error.
    rms: f64,
    /// The error with the constant as it is.
    rms_as_it_is: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    model: String,
    terms: Vec<Term>,
    steady: Vec<Steady>,
    /// By wall: all particles of a column, y/d and velocity, at the first start-up time.
    seen: Vec<(String, Vec<[f64; 2]>)>,
}

pub(super) struct WallPart {
    common: Arc<Common>,
}

impl WallPart {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        Self { common: Arc::clone(common) }
    }

    fn operator(model: &str) -> Result<Operator, TaskError> {
        Ok(match model {
            "C" | "D" => ViscousModel::C.bare(true)?,
            "E" => ViscousModel::E.bare(true)?,
            _ => {
                // The corrected gradient of Eqs. (24) to (26), twice.
                let gradient = |i: &str, j: &str, k: &str| {
                    format!(
                        "(gradW_{i}{j} / (sum_{k} V_{k} W_{i}{k}) \
                         - W_{i}{j} (sum_{k} V_{k} gradW_{i}{k}) / (sum_{k} V_{k} W_{i}{k})^2)"
                    )
                };
                let matrix = |i: &str, l: &str, k: &str| {
                    format!("inverse(-sum_{l} V_{l} {} r_{i}{l})", gradient(i, l, k))
                };
                let first =
                    format!("({} . sum_m V_m u_m {})", matrix("j", "p", "q"), gradient("j", "m", "q"));
                Operator::parse(&format!(
                    "sum_j V_j {first} . ({} . {})",
                    matrix("i", "l", "k"),
                    gradient("i", "j", "k")
                ))?
            }
        })
    }

    fn found(&self, model: &str, constant: f64) -> Result<Found, TaskError> {
        let (p, kernel) = (&self.common.parameters, &self.common.kernel);
        let operator = Self::operator(model)?;
        let half = 0.5 * p.rows as f64;
        let (mut terms, mut steady, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        for on_wall in [false, true] {
            let channel = Channel::new(kernel, Common::support(p.dx_over_h), p.rows, on_wall)?;
            let heights = channel.heights();
            let times = p.start_up_times.iter().map(|time| Some(*time));
            for time in times.chain([None]) {
                let flow = ChannelFlow { time: time.unwrap_or(f64::INFINITY) };
                let fluid: Vec<f64> = heights.iter().map(|y| flow.velocity(*y)).collect();
                for wall in Wall::ALL {
                    let values = channel.viscous_term(kernel, &operator, wall, &fluid)?;
                    let rows = heights.iter().zip(values).take(ROWS);
                    let rows =
                        rows.map(|(y, value)| [*y, constant * value * half * half, flow.viscous_term(*y)]);
                    let rows = rows.collect();
                    terms.push(Term { wall: wall.id().into(), on_wall, time, rows });
                    if !on_wall && time == p.start_up_times.first().copied() {
                        seen.push((wall.id().to_owned(), channel.seen(wall, &fluid)));
                    }
                }
            }
            for wall in Wall::ALL {
                let flow = match channel.steady_flow(kernel, &operator, wall) {
                    Ok(velocities) => Some(calibrated(constant, half, &heights, &velocities)),
                    Err(WallError::Singular { .. }) => None,
                    Err(error) => return Err(error.into()),
                };
                steady.push(Steady { wall: wall.id().into(), on_wall, flow });
            }
        }
        Ok(Found { model: model.into(), terms, steady, seen })
    }
}

/// The steady flow of a model over the exact one, and the constant that brings it nearest.
fn calibrated(constant: f64, half: f64, heights: &[f64], velocities: &[f64]) -> Calibration {
    // ⟨∇²u⟩ = −1 in 1/Δ²: U₀ = d²/2.
    let ratios: Vec<f64> = heights
        .iter()
        .zip(velocities)
        .map(|(y, u)| u / constant / (0.5 * half * half * (1.0 - y * y)))
        .collect();
    let n = ratios.len() as f64;
    let (sum, squares) = (ratios.iter().sum::<f64>(), ratios.iter().map(|r| r * r).sum::<f64>());
    // Velocities are in inverse proportion to the constant: Σ (r/f − 1)² is least for f = Σ r²/Σ r.
    let factor = squares / sum;
    let rms = |f: f64| (ratios.iter().map(|r| (r / f - 1.0) * (r / f - 1.0)).sum::<f64>() / n).sqrt();
    // Below this it is rounding.
    let round = |value: f64| if value.abs() < 1e-12 { 0.0 } else { significant(value, 8) };
    Calibration {
        centre: round(ratios[ratios.len() / 2]),
        factor: round(factor),
        rms: round(rms(factor)),
        rms_as_it_is: round(rms(1.0)),
    }
}

impl Part for WallPart {
    fn tasks(&self) -> Vec<SurveyTask> {
        let p = &self.common.parameters;
        let more = (p.dx_over_h, p.rows, &p.start_up_times);
        MODELS
            .iter()
            .map(|(model, _)| self.common.task(&format!("walls {model}"), &more, 5_000_000))
            .collect()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let (model, constant) = MODELS.get(task).ok_or("no such task")?;
        Ok(serde_json::to_value(self.found(model, *constant)?)?)
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let all: Vec<Found> = results.iter().map(stored).collect::<Result<_, _>>()?;
        for found in &all {
            self.judge(found, report)?;
        }
        self.tables(&all, report);
        self.figures(&all, report);
        Ok(())
    }
}

impl Found {
    fn rows(&self, wall: Wall, on_wall: bool, time: Option<f64>) -> &[[f64; 3]] {
        let found = self.terms.iter().find(|t| t.wall == wall.id() && t.on_wall == on_wall && t.time == time);
        found.map_or(&[], |term| term.rows.as_slice())
    }

    /// Root mean square error of the viscous term over the rows next to the wall, over that of the steady flow, 2U₀/d².
    fn error(&self, wall: Wall, on_wall: bool, time: Option<f64>) -> f64 {
        let rows = self.rows(wall, on_wall, time);
        (rows.iter().map(|[_, found, exact]| (found - exact) * (found - exact)).sum::<f64>()
            / rows.len() as f64)
            .sqrt()
            / 2.0
    }

    /// Largest less smallest viscous term at the first row, over 2U₀/d².
    fn spread(&self, on_wall: bool, time: Option<f64>) -> f64 {
        let first = Wall::ALL.map(|wall| self.rows(wall, on_wall, time)[0][1]);
        let most = first.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let least = first.into_iter().fold(f64::INFINITY, f64::min);
        (most - least) / 2.0
    }
}

impl WallPart {
    fn case(&self, model: &str, on_wall: bool, time: Option<f64>) -> Case {
        let case = self.common.case("square", 2, VolumeRule::NumberDensity).with("model", model);
        let case = case.with("wall_particles", if on_wall { "on the wall" } else { "none on the wall" });
        match time {
            Some(time) => case.with("t*", time),
            None => case,
        }
    }

    fn judge(&self, found: &Found, report: &mut Report) -> Result<(), TaskError> {
        let others = [Wall::Linear, Wall::Quadratic, Wall::GlobalQuadratic];
        for on_wall in [false, true] {
            for time in self.common.parameters.start_up_times.iter().map(|time| Some(*time)) {
                let case = || self.case(&found.model, on_wall, time);
                let worst =
                    others.map(|wall| found.error(wall, on_wall, time)).into_iter().fold(0.0, f64::max);
                let mirrored = found.error(Wall::Mirroring, on_wall, time);
                judge(report, "6.1.2/mirroring-worst", case(), None, sides(mirrored, worst))?;
                // Forces point against the flow: their magnitudes.
                let force = |wall: Wall| -found.rows(wall, on_wall, time)[0][1];
                let exact = -found.rows(Wall::Mirroring, on_wall, time)[0][2];
                judge(report, "6.1.2/mirroring-reduces", case(), None, sides(force(Wall::Mirroring), exact))?;
                let pair = sides(force(Wall::Linear), force(Wall::Mirroring));
                judge(report, "6.1.2/extrapolation-stronger", case(), None, pair)?;
                // The text speaks of velocities, which are lowest at the start.
                let slow = |time: Option<f64>| {
                    let flow = ChannelFlow { time: time.unwrap_or(f64::INFINITY) };
                    flow.velocity(found.rows(Wall::Mirroring, on_wall, time)[0][0])
                };
                let spread = |time: Option<f64>| found.spread(on_wall, time);
                let relative = sides(spread(None) / slow(None), spread(time) / slow(time));
                let reading = |words: &str| case().with("reading", words);
                judge(report, "6.1.2/established", reading("over the velocity there"), None, relative)?;
                let absolute = sides(spread(None), spread(time));
                judge(report, "6.1.2/established", reading("over the body force"), None, absolute)?;
            }
        }
        if found.model == "D" {
            for steady in &found.steady {
                let Some(flow) = steady.flow else { continue };
                let xi = XI_POISEUILLE * flow.factor;
                let case = self.case(&found.model, steady.on_wall, None).with("wall", steady.wall.as_str());
                judge(report, "5.3/steady", case, None, Some(Observed::Number(Measured::exactly(xi))))?;
            }
        }
        Ok(())
    }

    fn tables(&self, all: &[Found], report: &mut Report) {
        #[derive(Serialize)]
        struct Row<'a> {
            model: &'a str,
            wall: &'a str,
            on_wall: bool,
            profile: String,
            distance_over_dx: f64,
            viscous_term: f64,
            exact: f64,
            relative_error: f64,
        }
        #[derive(Serialize)]
        struct SteadyRow<'a> {
            model: &'a str,
            wall: &'a str,
            on_wall: bool,
            velocity_next_to_centre: Option<f64>,
            best_constant_over_own: Option<f64>,
            rms_error: Option<f64>,
            least_rms_error: Option<f64>,
        }
        let (mut rows, mut steady) = (Vec::new(), Vec::new());
        for found in all {
            for term in &found.terms {
                rows.extend(term.rows.iter().enumerate().map(|(k, [_, value, exact])| {
                    table_row(&Row {
                        model: &found.model,
                        wall: &term.wall,
                        on_wall: term.on_wall,
                        profile: profile(term.time),
                        distance_over_dx: k as f64 + 0.5,
                        viscous_term: significant(*value, 6),
                        exact: significant(*exact, 6),
                        relative_error: significant((value - exact) / 2.0, 6),
                    })
                }));
            }
            steady.extend(found.steady.iter().map(|s| {
                table_row(&SteadyRow {
                    model: &found.model,
                    wall: &s.wall,
                    on_wall: s.on_wall,
                    velocity_next_to_centre: s.flow.map(|flow| flow.centre),
                    best_constant_over_own: s.flow.map(|flow| flow.factor),
                    rms_error: s.flow.map(|flow| flow.rms_as_it_is),
                    least_rms_error: s.flow.map(|flow| flow.rms),
                })
            }));
        }
        report.tables.insert("wall_viscous_term".into(), rows);
        report.tables.insert("steady_channel".into(), steady);
    }

    fn figures(&self, all: &[Found], report: &mut Report) {
        let Some(first) = all.iter().find(|found| found.model == "E") else { return };
        let time = self.common.parameters.start_up_times.first().copied();
        // Fig. 3: what the fluid sees of velocities, then of shear, then the viscous forces, near the lower wall.
        let near = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            points.iter().filter(|[y, _]| *y <= -0.3).copied().collect()
        };
        let velocities = first.seen.iter().map(|(wall, points)| {
            (wall.clone(), near(points).into_iter().map(|[y, u]| vec![y, u]).collect())
        });
        let shear = first.seen.iter().map(|(wall, points)| {
            let pairs = near(points);
            let slopes = pairs
                .windows(2)
                .map(|p| vec![0.5 * (p[0][0] + p[1][0]), (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])]);
            (wall.clone(), slopes.collect())
        });
        let y = ("y/d", "1", false);
        report.series.push(series(
            "figure-3-velocity",
            Some("Fig. 3"),
            y,
            ("u", "U₀", false),
            velocities.collect(),
        ));
        report.series.push(series(
            "figure-3-shear",
            Some("Fig. 3"),
            y,
            ("∂u/∂y", "U₀/d", false),
            shear.collect(),
        ));
        for found in all {
            let mut lines: Vec<(String, Vec<Vec<f64>>)> = Vec::new();
            for term in found.terms.iter().filter(|term| term.time == time) {
                let points = term.rows.iter().map(|[y, value, _]| vec![*y, *value]);
                let name = if term.on_wall { "particles on the wall" } else { "none" };
                lines.push((format!("{}, {name}", term.wall), points.collect()));
            }
            let exact = found.rows(Wall::Linear, false, time).iter().map(|[y, _, exact]| vec![*y, *exact]);
            lines.push(("exact".into(), exact.collect()));
            let id = format!("figure-3-force-{}", found.model.chars().next().unwrap_or('x'));
            report.series.push(series(&id, Some("Fig. 3"), y, ("∂²u/∂y²", "U₀/d²", false), lines));
        }
    }
}

fn profile(time: Option<f64>) -> String {
    match time {
        Some(time) => format!("start-up, t* = {time}"),
        None => "parabola".into(),
    }
}
