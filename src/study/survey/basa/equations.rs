//! Eqs. (5), (28), (36), the number of neighbours, what is conserved, and Fig. 1.

use super::super::{SurveyTask, TaskError, table_row};
use super::part::{Common, Part, With, case, judge, nothing, number, series, sides, stored, zero};
use crate::derived::{ChannelFlow, Conservation, Conserved, stress_divergence};
use crate::exact::{Rational, ratio, rational_from_decimal, rational_to_f64};
use crate::kernel::Evaluator;
use crate::language::operators;
use crate::measured::{Placed, totals};
use crate::particles::{Disorder, VolumeRule, lattice_by_id};
use crate::record::{Report, significant};
use crate::sums::LatticeSums;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// What counts as rounding in totals over a few hundred particles.
const ROUNDING: f64 = 1e-12;
/// The disorder on which totals are taken.
const DISORDER: &str = "canonical:0.1";
/// Terms of the series are left out below this.
const SERIES_FLOOR: f64 = 1e-6;
/// Memory for one shell table.
const MEMORY_MIB: u64 = 64;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    neighbours: [u64; 2],
    /// Largest |∂²W of Eq. (28) − differences of the gradient|, over h⁻⁴.
    hessian: [f64; 2],
    /// By operator: id, linear and angular total, measured.
    totals: Vec<(String, [f64; 2])>,
    /// By t*, \[printed at the centre, rest of it at the wall, re-derived: largest at t = 0\].
    series: [f64; 5],
}

/// The operators whose totals are asked for, with the claim on the linear and on the angular one.
const CONSERVING: [(&str, &str, Option<&str>); 5] = [
    ("basa-8", "eq-8/momentum", None),
    ("basa-9", "eq-9/momentum", None),
    ("pressure-reduction", "eq-20/momentum", None),
    ("C", "eq-33/linear", Some("eq-33/angular")),
    ("E", "eq-35/linear", Some("eq-35/angular")),
];

pub(super) struct Equations {
    common: Arc<Common>,
}

impl Equations {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        Self { common: Arc::clone(common) }
    }

    fn found(&self) -> Result<Found, TaskError> {
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        let support = self.support()?;
        let sums = LatticeSums::new(kernel, &square, &support, &[], MEMORY_MIB)?;
        let as_float = rational_to_f64(&support);
        let placed = Placed::regular(kernel, &square, as_float, VolumeRule::Constant, 1.0)?;
        let counted = placed.lists.of(placed.inner[0]).len() as u64;
        let disorder = Disorder::parse(DISORDER)?;
        let body = Placed::disordered(
            kernel,
            &square,
            as_float,
            VolumeRule::NumberDensity,
            &disorder,
            9.0,
            self.common.seed,
        )?;
        let of = |id: &str| -> Result<(String, [f64; 2]), TaskError> {
            let found = totals(&body, kernel, &operators::by_id(id)?.operator()?)?;
            Ok((id.to_owned(), [found.linear, found.angular]))
        };
        let totals = CONSERVING.iter().map(|(id, ..)| of(id)).collect::<Result<Vec<_>, _>>()?;
        Ok(Found {
            neighbours: [sums.count(&support)?.in_support, counted],
            hessian: self.hessian(),
            totals,
            series: start_up(),
        })
    }

    /// R/Δ exactly.
    fn support(&self) -> Result<Rational, TaskError> {
        Ok(ratio(2, 1) / rational_from_decimal(self.common.parameters.dx_over_h)?)
    }

    /// ∂²W/∂x_i∂x_j from W″ and W′ as in Eq. (28), less central differences of the gradient; and what these leave.
    fn hessian(&self) -> [f64; 2] {
        let evaluator = Evaluator::<f64>::new(&self.common.kernel, 2, 2);
        let gradient =
            |x: f64, y: f64, axis: usize| evaluator.radial((x * x + y * y).sqrt())[1] * [x, y][axis];
        let step = 1.0 / f64::from(1 << 17);
        let (mut largest, mut size) = (0.0_f64, 0.0_f64);
        for k in 1..40 {
            // Off the knots of the kernel and the axes.
            let (x, y) = (0.0241 * f64::from(k) * 0.6, 0.0241 * f64::from(k) * 0.8);
            let r = (x * x + y * y).sqrt();
            let [_, g1, g2, _, _] = evaluator.radial(r);
            // W′ = r G₁, W″ = G₁ + r² G₂.
            let (slope, curvature) = (r * g1, g1 + r * r * g2);
            for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                let printed = [x, y][i] * [x, y][j] / (r * r) * (curvature - slope / r)
                    + if i == j { slope / r } else { 0.0 };
                let (dx, dy) = if j == 0 { (step, 0.0) } else { (0.0, step) };
                let difference = (gradient(x + dx, y + dy, i) - gradient(x - dx, y - dy, i)) / (2.0 * step);
                largest = largest.max((printed - difference).abs());
                size = size.max(printed.abs());
            }
        }
        // The jump of W‴ and rounding over the step.
        [largest / size, 1e-4]
    }
}

/// Largest |Eq. (36) as printed| at t = 0, |re-derived| there; |printed| and |re-derived| at the wall over times; the
/// distance of the printed one from the parabola as t → ∞.
fn start_up() -> [f64; 5] {
    let heights = || (0..=100).map(|k| f64::from(k) / 100.0);
    let rest = ChannelFlow { time: 0.0 };
    let largest = |f: &dyn Fn(f64) -> f64| heights().map(|y| f(y).abs()).fold(0.0, f64::max);
    let times = [0.0, 0.01, 0.1, 1.0];
    let wall = |f: &dyn Fn(ChannelFlow) -> f64| {
        times.iter().map(|time| f(ChannelFlow { time: *time }).abs()).fold(0.0, f64::max)
    };
    let late = ChannelFlow { time: 60.0 };
    [
        largest(&|y| rest.as_printed(y)),
        largest(&|y| rest.velocity(y)),
        wall(&|flow| flow.as_printed(1.0)),
        wall(&|flow| flow.velocity(1.0)),
        largest(&|y| late.as_printed(y) - (1.0 - y * y)),
    ]
}

impl Part for Equations {
    fn tasks(&self) -> Vec<SurveyTask> {
        vec![self.common.task("equations", &self.common.parameters.dx_over_h, 500_000)]
    }

    fn compute(&self, _task: usize) -> Result<Value, TaskError> {
        Ok(serde_json::to_value(self.found()?)?)
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let [found] = results else { return Ok(()) };
        let found: Found = stored(found)?;
        let own = |lattice: &str| self.common.case(lattice, 2, VolumeRule::NumberDensity);
        let in_the_continuum = || case(self.common.kernel.id(), "continuum", 2, "constant");
        // λ = 2/3 μ with the sign of Eq. (4), then of Eq. (5).
        let [uxx, ..] = stress_divergence(&ratio(-2, 3));
        judge(report, "eq-4/uxx", in_the_continuum(), number(rational_to_f64(&uxx)), None)?;
        let [uxx, _, vxy] = stress_divergence(&ratio(2, 3));
        judge(report, "eq-5/uxx", in_the_continuum(), number(rational_to_f64(&uxx)), None)?;
        judge(report, "eq-5/vxy", in_the_continuum(), number(rational_to_f64(&vxy)), None)?;
        let [start, rederived, wall, rederived_wall, steady] = found.series;
        judge(report, "eq-36/start", in_the_continuum(), zero(start, SERIES_FLOOR), None)?;
        judge(report, "eq-36/wall", in_the_continuum(), zero(wall, SERIES_FLOOR), None)?;
        judge(report, "eq-36/steady", in_the_continuum(), zero(steady, SERIES_FLOOR), None)?;
        start_up_table(report, [start, rederived, wall, rederived_wall, steady]);
        let [exact, counted] = found.neighbours.map(|count| count as f64);
        let spacing = self.common.parameters.dx_over_h;
        judge(
            report,
            "6/neighbours",
            own("square").with("dx_over_h", spacing),
            number(exact),
            number(counted),
        )?;
        let [largest, floor] = found.hessian;
        judge(report, "eq-28/form", in_the_continuum(), nothing(), zero(largest, floor))?;
        self.totals(&found, report)?;
        report.series.push(self.figure_1());
        report.series.extend(start_up_figures());
        Ok(())
    }
}

impl Equations {
    fn totals(&self, found: &Found, report: &mut Report) -> Result<(), TaskError> {
        #[derive(Serialize)]
        struct Row {
            operator: String,
            linear_derived: String,
            linear_measured: f64,
            angular_derived: String,
            angular_measured: f64,
        }
        let mut rows = Vec::new();
        for ((id, linear, angular), (_, measured)) in CONSERVING.iter().zip(&found.totals) {
            let derived = Conservation::of(&operators::by_id(id)?.operator()?)?;
            let case = || {
                let case = self.common.case("square", 2, VolumeRule::NumberDensity).disordered(DISORDER);
                case.with("operator", *id)
            };
            let claims =
                [(Some(*linear), derived.total, measured[0]), (*angular, derived.angular, measured[1])];
            for (claim, conserved, measured) in claims {
                let Some(claim) = claim else { continue };
                let is_relation = matches!(claim, "eq-20/momentum" | "eq-35/angular");
                let (of_algebra, of_particles) = match (is_relation, conserved) {
                    (true, _) => (None, sides(measured, ROUNDING)),
                    (false, Conserved::Yes) => (nothing(), zero(measured, ROUNDING)),
                    (false, _) => (None, zero(measured, ROUNDING)),
                };
                judge(report, claim, case(), of_algebra, of_particles)?;
            }
            let word = |conserved: Conserved| match conserved {
                Conserved::Yes => "conserved",
                Conserved::No => "not conserved",
                Conserved::DoesNotApply => "–",
            };
            rows.push(table_row(&Row {
                operator: (*id).into(),
                linear_derived: word(derived.total).into(),
                linear_measured: significant(measured[0], 3),
                angular_derived: word(derived.angular).into(),
                angular_measured: significant(measured[1], 3),
            }));
        }
        report.tables.insert("conservation".into(), rows);
        Ok(())
    }

    /// Fig. 1: second derivatives of the 2-D kernel, h = 1, along lines through the origin.
    fn figure_1(&self) -> crate::record::Series {
        let kernel = &self.common.kernel;
        let support = rational_to_f64(kernel.support_over_h());
        let evaluator = Evaluator::<f64>::new(kernel, 2, 2);
        let second = |x: f64, y: f64, i: usize, j: usize| {
            let [_, g1, g2, _, _] = evaluator.radial((x * x + y * y).sqrt() / support);
            let (place, square) = ([x, y], support * support);
            let value = place[i] * place[j] / square * g2 + if i == j { g1 } else { 0.0 };
            value / (square * square)
        };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let along = |[a, b]: [f64; 2], i: usize, j: usize| {
            let points = (-80..=80).map(|k| f64::from(k) * support / 80.0);
            points.map(|s| vec![s, second(a * s, b * s, i, j)]).collect::<Vec<_>>()
        };
        series(
            "figure-1",
            Some("Fig. 1"),
            ("distance from the origin along the line", "h", false),
            ("∂²W/∂x_i∂x_j", "h⁻⁴", false),
            vec![
                ("(a) ∂²W/∂x∂x along x".into(), along([1.0, 0.0], 0, 0)),
                ("(a) ∂²W/∂x∂x along y".into(), along([0.0, 1.0], 0, 0)),
                ("(a) ∂²W/∂x∂x along x = y".into(), along([half, half], 0, 0)),
                ("(b) ∂²W/∂x∂y along x".into(), along([1.0, 0.0], 0, 1)),
                ("(b) ∂²W/∂x∂y along x = y".into(), along([half, half], 0, 1)),
                ("(b) ∂²W/∂x∂y along x = −y".into(), along([half, -half], 0, 1)),
            ],
        )
    }
}

fn start_up_table(report: &mut Report, [start, rederived, wall, rederived_wall, steady]: [f64; 5]) {
    #[derive(Serialize)]
    struct Row {
        what: &'static str,
        as_printed: f64,
        rederived: f64,
    }
    let late = ChannelFlow { time: 60.0 };
    let parabola = (0..=100).map(|k| f64::from(k) / 100.0).map(|y| (late.velocity(y) - (1.0 - y * y)).abs());
    let row = |what, as_printed, rederived| {
        table_row(&Row { what, as_printed: significant(as_printed, 6), rederived: significant(rederived, 2) })
    };
    let rows = vec![
        row("largest |U|/U₀ at t = 0", start, rederived),
        row("largest |U|/U₀ at the wall", wall, rederived_wall),
        row("largest distance from the parabola as t → ∞", steady, parabola.fold(0.0, f64::max)),
    ];
    report.tables.insert("eq_36".into(), rows);
}

/// Eq. (36) as printed and re-derived, across half the channel.
fn start_up_figures() -> Vec<crate::record::Series> {
    let across =
        |f: &dyn Fn(f64) -> f64| (0..=100).map(|k| f64::from(k) / 100.0).map(|y| vec![y, f(y)]).collect();
    let times = [0.0, 0.025, 0.1, 1.0];
    let lines = times.into_iter().flat_map(|time| {
        let flow = ChannelFlow { time };
        [
            (format!("as printed, t* = {time}"), across(&|y| flow.as_printed(y))),
            (format!("re-derived, t* = {time}"), across(&|y| flow.velocity(y))),
        ]
    });
    vec![series("eq-36", None, ("y/d", "1", false), ("U/U₀", "1", false), lines.collect())]
}
