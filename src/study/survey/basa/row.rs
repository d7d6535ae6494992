//! Eq. (15) on a line.

use super::super::{SurveyTask, TaskError, table_row};
use super::part::{Common, Part, With, case, judge, nothing, number, series, slope, stored, zero};
use crate::claim::{Measured, Observed};
use crate::derived::{row_amplitude, row_exponent, row_regular_exponent, row_second_exponent};
use crate::exact::{Rational, int, rational_to_f64};
use crate::kernel::{self, Kernel};
use crate::language::Subject;
use crate::measured::{RegularSpec, RowVolumes, regular_rung, row_errors};
use crate::particles::{Disorder, PointGroup, VolumeRule, lattice_by_id};
use crate::record::{Report, significant};
use crate::sums::{Moment, Reduction};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// ε of `box`: displacements up to Δ/4 of this, small enough for the first order to stand alone.
const SMALL: &str = "box:0.04";
/// Amplitudes along which the orders in ξ are taken.
const AMPLITUDES: [f64; 4] = [0.02, 0.04, 0.08, 0.16];
/// R/Δ at which they are.
const AT: f64 = 16.7;
/// 2h/Δ: every knot of a spline at a particle or half-way between two. At whole h/Δ B-splines are exact: their Fourier
/// transform vanishes at all waves of the lattice.
const ALIGNED: [i64; 5] = [7, 11, 15, 23, 31];
/// Offsets of R/Δ over which an envelope is taken, in 16ths.
const OFFSETS: i64 = 16;
/// Memory for shells.
const MEMORY_MIB: u64 = 64;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Ladder {
    kernel: String,
    volumes: String,
    /// \[R/Δ, odd rms, its error, even rms, its error, centroid rms\], units of F_a/h.
    supports: Vec<[f64; 6]>,
    /// \[amplitude, the same …\].
    amplitudes: Vec<[f64; 6]>,
    /// First-order rms by R/Δ, derived; for cells of their own and constant volumes.
    derived: Option<Vec<f64>>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Regular {
    kernel: String,
    /// \[Δ/h, |error| at h/Δ = n + 1/2\].
    aligned: Vec<[f64; 2]>,
    /// \[Δ/h, envelope\].
    envelope: Vec<[f64; 2]>,
}

pub(super) struct RowPart {
    common: Arc<Common>,
    kernels: Vec<&'static str>,
}

impl RowPart {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        Self { common: Arc::clone(common), kernels: vec!["cubic-spline", "quintic-spline", "wendland-c2"] }
    }

    fn jobs(&self) -> Vec<(&'static str, RowVolumes)> {
        let all = |kernel: &&'static str| RowVolumes::ALL.map(|volumes| (*kernel, volumes));
        self.kernels.iter().flat_map(all).collect()
    }

    fn ladder(&self, id: &str, volumes: RowVolumes) -> Result<Ladder, TaskError> {
        let (kernel, line) = (kernel::by_id(id)?, lattice_by_id("line")?);
        let p = &self.common.parameters;
        let at = |support: f64, disorder: &Disorder| {
            let e = row_errors(&kernel, &line, support, volumes, disorder, p.line_samples, self.common.seed);
            (e.odd, e.even, e.centroid)
        };
        let small = Disorder::parse(SMALL)?;
        let row = |first: f64, (odd, even, centroid): ([f64; 2], [f64; 2], f64)| {
            [first, odd[0], odd[1], even[0], even[1], centroid]
        };
        let supports = p.line_supports.iter().map(|support| row(*support, at(*support, &small))).collect();
        let amplitudes = AMPLITUDES.iter().map(|amplitude| {
            let disorder = Disorder::parse(&format!("box:{amplitude}"))?;
            Ok::<_, TaskError>(row(*amplitude, at(AT, &disorder)))
        });
        let amplitudes = amplitudes.collect::<Result<Vec<_>, _>>()?;
        // Uniform in ± ε/4: the root mean square is ε/4/√3.
        let deviation = small.amplitude() / 4.0 / 3.0_f64.sqrt();
        let derived = (volumes != RowVolumes::NumberDensity).then(|| {
            let own = volumes == RowVolumes::OwnCell;
            p.line_supports.iter().map(|s| deviation * row_amplitude(&kernel, *s, own)).collect()
        });
        Ok(Ladder { kernel: id.into(), volumes: volumes.id().into(), supports, amplitudes, derived })
    }

    fn regular(&self, id: &str) -> Result<Regular, TaskError> {
        let (kernel, line) = (kernel::by_id(id)?, lattice_by_id("line")?);
        let group = PointGroup::of(&line);
        let deviations = |supports: Vec<Rational>| -> Result<Vec<f64>, TaskError> {
            let spec = RegularSpec {
                kernel: kernel.clone(),
                lattice: line.clone(),
                rule: VolumeRule::Constant,
                subjects: vec![Subject::Moment(Moment::b_inverse())],
                supports,
                memory_mib: MEMORY_MIB,
            };
            Ok(regular_rung(&spec, &group)?.norms.iter().map(|norms| norms[0].deviation).collect())
        };
        let support = |n: i64| kernel.support_over_h() * int(n) / int(2);
        let dx_over_h = |n: i64| 2.0 / n as f64;
        let aligned = deviations(ALIGNED.iter().map(|n| support(*n)).collect())?;
        let aligned = ALIGNED.iter().zip(aligned).map(|(n, e)| [dx_over_h(*n), e]).collect();
        let envelope = ALIGNED.iter().map(|n| {
            let around = (0..OFFSETS).map(|k| support(*n) + int(k) / int(OFFSETS));
            let largest = deviations(around.collect())?.into_iter().fold(0.0, f64::max);
            Ok::<_, TaskError>([dx_over_h(*n), largest])
        });
        Ok(Regular { kernel: id.into(), aligned, envelope: envelope.collect::<Result<_, _>>()? })
    }
}

impl Part for RowPart {
    fn tasks(&self) -> Vec<SurveyTask> {
        let p = &self.common.parameters;
        let more = (&p.line_supports, p.line_samples);
        let task = |name: String| self.common.task(&name, &more, 3_000_000);
        let ladders =
            self.jobs().into_iter().map(|(kernel, volumes)| task(format!("line {kernel} {}", volumes.id())));
        let regular = self.kernels.iter().map(|kernel| task(format!("regular line {kernel}")));
        ladders.chain(regular).collect()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let jobs = self.jobs();
        Ok(match jobs.get(task) {
            Some((kernel, volumes)) => serde_json::to_value(self.ladder(kernel, *volumes)?)?,
            None => serde_json::to_value(self.regular(self.kernels[task - jobs.len()])?)?,
        })
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let (ladders, regular) = results.split_at(self.jobs().len().min(results.len()));
        let ladders: Vec<Ladder> = ladders.iter().map(stored).collect::<Result<_, _>>()?;
        let regular: Vec<Regular> = regular.iter().map(stored).collect::<Result<_, _>>()?;
        for ladder in &ladders {
            judge_ladder(ladder, report)?;
        }
        for found in &regular {
            judge_regular(found, report)?;
        }
        judge_scaling(report)?;
        table(&ladders, report)?;
        let dx = |kernel: &str, support: f64| {
            kernel::by_id(kernel).map_or(f64::NAN, |kernel| Common::dx_over_h(&kernel, support))
        };
        let line = |ladder: &Ladder, column: usize, name: &str| {
            let points = ladder
                .supports
                .iter()
                .map(|row| vec![dx(&ladder.kernel, row[0]), row[column], row[column + 1]]);
            (format!("{name}, {}, V {}", ladder.kernel, ladder.volumes), points.collect())
        };
        let lines =
            ladders.iter().flat_map(|l| [line(l, 1, "first order in ξ"), line(l, 3, "second order in ξ")]);
        report.series.push(series(
            "eq-15",
            None,
            ("Δx/h", "1", true),
            ("rms Σ V ∂W", "F_a/h", true),
            lines.collect(),
        ));
        Ok(())
    }
}

fn on_line(kernel: &str, rule: &str) -> crate::record::Case {
    case(kernel, "line", 1, rule)
}

fn judge_ladder(ladder: &Ladder, report: &mut Report) -> Result<(), TaskError> {
    let kernel: Kernel = kernel::by_id(&ladder.kernel)?;
    let own = ladder.volumes == RowVolumes::OwnCell.id();
    let of_case = || on_line(&ladder.kernel, &ladder.volumes).disordered(SMALL);
    let along = |rows: &[[f64; 6]], column: usize, x: &dyn Fn(f64) -> f64| {
        let points: Vec<[f64; 2]> = rows.iter().map(|row| [x(row[0]), row[column]]).collect();
        slope(&points).map(|found| Some(Observed::Number(found)))
    };
    let dx_over_h = |support: f64| Common::dx_over_h(&kernel, support);
    let first = number(rational_to_f64(&row_exponent(&kernel, own)));
    judge(report, "eq-15/first-dx", of_case(), first, along(&ladder.supports, 1, &dx_over_h)?)?;
    let second = number(rational_to_f64(&row_second_exponent()));
    judge(report, "eq-15/second-dx", of_case(), second, along(&ladder.supports, 3, &dx_over_h)?)?;
    let same = |amplitude: f64| amplitude;
    let at = |case: crate::record::Case| case.with("support_over_dx", AT);
    judge(report, "eq-15/first-xi", at(of_case()), number(1.0), along(&ladder.amplitudes, 1, &same)?)?;
    judge(report, "eq-15/second-xi", at(of_case()), number(2.0), along(&ladder.amplitudes, 3, &same)?)
}

fn judge_regular(found: &Regular, report: &mut Report) -> Result<(), TaskError> {
    let kernel = kernel::by_id(&found.kernel)?;
    let id = match found.kernel.as_str() {
        "cubic-spline" => "eq-15/regular",
        "quintic-spline" => "eq-15/regular-quintic",
        _ => "eq-15/regular-wendland",
    };
    for (points, aligned, words) in
        [(&found.aligned, true, "h/Δ = n + 1/2"), (&found.envelope, false, "any h/Δ, envelope")]
    {
        let derived = number(row_regular_exponent(&kernel, aligned) as f64);
        let measured = Some(Observed::Number(slope(points)?));
        let case = on_line(&found.kernel, VolumeRule::Constant.id()).with("support", words);
        judge(report, id, case, derived, measured)?;
    }
    let line = lattice_by_id("line")?;
    let moment = Moment::by_name("sum_dw")?;
    let vanishes = Reduction::of(moment, &line, &PointGroup::of(&line)).vanishes();
    let derived = if vanishes { nothing() } else { zero(f64::INFINITY, 0.0) };
    judge(report, "eq-15/uniform", on_line(&found.kernel, VolumeRule::Constant.id()), derived, None)
}

/// What multiplies both sides by a power when all lengths are.
fn judge_scaling(report: &mut Report) -> Result<(), TaskError> {
    let of_case = || on_line("cubic-spline", RowVolumes::OwnCell.id());
    // Σ V ∂W carries 1/length: with ξ in Δ, F_a/h is all that has one.
    judge(report, "eq-15/h", of_case(), number(-1.0), None)?;
    for (reading, exponent) in
        [("ξ in units of Δ", -1.0), ("ξ a length, first term", 0.0), ("ξ a length, second term", 1.0)]
    {
        judge(report, "eq-15/dimension", of_case().with("reading", reading), number(exponent), None)?;
    }
    Ok(())
}

fn table(ladders: &[Ladder], report: &mut Report) -> Result<(), TaskError> {
    #[derive(Serialize)]
    struct Row {
        kernel: String,
        volumes: String,
        first_derived: String,
        first_measured: f64,
        second_derived: String,
        second_measured: f64,
        first_rms_over_derived: Option<f64>,
    }
    let mut rows = Vec::new();
    for ladder in ladders {
        let kernel = kernel::by_id(&ladder.kernel)?;
        let measured = |column: usize| -> Result<Measured, TaskError> {
            let points: Vec<[f64; 2]> =
                ladder.supports.iter().map(|row| [Common::dx_over_h(&kernel, row[0]), row[column]]).collect();
            slope(&points)
        };
        let last = ladder.supports.last().zip(ladder.derived.as_ref().and_then(|derived| derived.last()));
        rows.push(table_row(&Row {
            kernel: ladder.kernel.clone(),
            volumes: ladder.volumes.clone(),
            first_derived: row_exponent(&kernel, ladder.volumes == RowVolumes::OwnCell.id()).to_string(),
            first_measured: significant(measured(1)?.value, 4),
            second_derived: row_second_exponent().to_string(),
            second_measured: significant(measured(3)?.value, 4),
            first_rms_over_derived: last.map(|(row, derived)| significant(row[1] / derived, 4)),
        }));
    }
    report.tables.insert("eq_15_exponents".into(), rows);
    Ok(())
}
