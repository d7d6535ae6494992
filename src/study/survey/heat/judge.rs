//! What the runs say of the statements of §6, and the figures.

use super::super::{entry, table_row};
use super::run::{Configuration, Found, RunFound};
use crate::claim::{HeatStatement, Measured, Observed};
use crate::evolve::heat::Boundary;
use crate::measured::fit::line;
use crate::record::{Axis, Case, Line, Report, Series, TimeRun, significant};
use itertools::Itertools as _;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Ids of the claims.
pub(super) fn claims() -> Vec<String> {
    HeatStatement::all().into_iter().map(|statement| statement.assertion().id).collect()
}

/// Runs at hand.
struct Bench<'a> {
    all: Vec<(&'a Configuration, &'a Found)>,
    kernel: &'a str,
}

/// Which of the three norms.
const L2: usize = 0;
const EC: usize = 2;

pub(super) fn report(configurations: &[Configuration], kernel: &str, found: &[Found], report: &mut Report) {
    let bench = Bench { all: configurations.iter().zip(found).collect(), kernel };
    for statement in HeatStatement::all() {
        let assertion = statement.assertion();
        for (case, observed) in bench.observe(statement) {
            report.claims.push(entry(&assertion, case, None, Some(observed), Vec::new()));
        }
    }
    report.runs = bench.runs();
    report.series = bench.figures();
    report.tables.insert("errors".into(), bench.error_rows().iter().map(table_row).collect());
    report.tables.insert("slopes".into(), bench.slope_rows().iter().map(table_row).collect());
    report.cost.pairs =
        found.iter().map(|f| f.entries as u64 * f.runs.iter().map(|r| r.products).sum::<u64>()).sum();
}

fn exactly(value: f64) -> Measured {
    Measured::exactly(significant(value, 6))
}

/// The slope of ln y over ln x with its 95 % interval.
fn slope(points: &[(f64, f64)]) -> Option<Measured> {
    let logs = points.iter().map(|(x, y)| (libm::log(*x), libm::log(*y), 1.0)).collect_vec();
    let found = line(&logs).ok()?.fit.interval(1, 0.95).ok()?;
    Some(Measured { value: found.value, low: found.low, high: found.high })
}

impl<'a> Bench<'a> {
    /// Runs with Euler's method and supports cut off at the walls, by ascending n.
    fn euler(&self, scheme: &str, h: f64, epsilon: f64) -> Vec<(usize, [f64; 3])> {
        self.select(scheme, h, epsilon, Boundary::CutOff, "euler")
            .into_iter()
            .filter_map(|(c, _, run)| Some((c.problem.n, *run.errors.as_ref().ok()?)))
            .collect()
    }

    fn select(
        &self,
        scheme: &str,
        h: f64,
        epsilon: f64,
        boundary: Boundary,
        integrator: &str,
    ) -> Vec<(&'a Configuration, &'a Found, &'a RunFound)> {
        let is = |c: &Configuration| {
            let p = &c.problem;
            c.scheme == scheme && p.h_over_dx == h && p.epsilon == epsilon && p.boundary == boundary
        };
        let chosen = self.all.iter().filter(|(c, _)| is(c));
        chosen
            .filter_map(|(c, found)| {
                Some((*c, *found, found.runs.iter().find(|run| run.integrator == integrator)?))
            })
            .sorted_by_key(|(c, _, _)| c.problem.n)
            .collect()
    }

    fn radii(&self, scheme: &str, epsilon: f64) -> Vec<f64> {
        let of = self.all.iter().filter(|(c, _)| {
            c.scheme == scheme && c.problem.epsilon == epsilon && c.problem.boundary == Boundary::CutOff
        });
        of.map(|(c, _)| c.problem.h_over_dx).sorted_by(f64::total_cmp).dedup().collect()
    }

    fn sides(&self) -> Vec<usize> {
        self.all.iter().map(|(c, _)| c.problem.n).sorted().dedup().collect()
    }

    fn epsilons(&self) -> Vec<f64> {
        let all = self.all.iter().map(|(c, _)| c.problem.epsilon);
        all.filter(|e| *e > 0.0).sorted_by(f64::total_cmp).dedup().collect()
    }

    fn at(&self, scheme: &str, h: f64, epsilon: f64, n: usize) -> Option<[f64; 3]> {
        self.euler(scheme, h, epsilon).into_iter().find(|(side, _)| *side == n).map(|(_, errors)| errors)
    }

    fn rate(&self, scheme: &str, h: f64, epsilon: f64, norm: usize) -> Option<Measured> {
        let points = self.euler(scheme, h, epsilon).into_iter();
        slope(&points.map(|(n, errors)| (1.0 / (n - 1) as f64, errors[norm])).collect_vec())
    }

    fn case(&self, epsilon: f64, more: &[(&str, Value)]) -> Case {
        Case {
            source: "cloud".into(),
            dimension: 2,
            kernel: self.kernel.into(),
            lattice: Some("square".into()),
            disorder: Some(if epsilon > 0.0 { format!("box:{epsilon}") } else { "none".into() }),
            volume_rule: "constant".into(),
            more: more
                .iter()
                .map(|(key, value)| ((*key).to_owned(), value.clone()))
                .collect::<BTreeMap<_, _>>(),
        }
    }

    /// What there is to say of a statement, case by case.
    fn observe(&self, statement: HeatStatement) -> Vec<(Case, Observed)> {
        let regular = || self.case(0.0, &[]);
        let largest = self.sides().last().copied().unwrap_or(0);
        let of_n = |n: usize, epsilon: f64| self.case(epsilon, &[("n", Value::from(n))]);
        let irregular = |of: &dyn Fn(f64) -> Option<Observed>| {
            let cases = self.epsilons().into_iter();
            cases.filter_map(|e| Some((self.case(e, &[]), of(e)?))).collect_vec()
        };
        let each_n = |epsilon: f64, of: &dyn Fn(usize) -> Option<Observed>| {
            self.sides().into_iter().filter_map(|n| Some((of_n(n, epsilon), of(n)?))).collect_vec()
        };
        let at_regular =
            |found: Option<Observed>| found.map(|found| (regular(), found)).into_iter().collect_vec();
        let number = |found: Option<Measured>| found.map(Observed::Number);
        match statement {
            HeatStatement::FirstOrderS3(h) | HeatStatement::FlatS3(h) => {
                at_regular(number(self.rate("S3", h, 0.0, L2)))
            }
            HeatStatement::SecondOrderS4(h) => at_regular(number(self.rate("S4", h, 0.0, L2))),
            HeatStatement::UnityS3Irregular(h) => irregular(&|e| number(self.rate("S3", h, e, L2))),
            HeatStatement::SecondOrderS4Irregular(h) => irregular(&|e| number(self.rate("S4", h, e, L2))),
            HeatStatement::SamePattern(scheme, h) => {
                let points = self.euler(scheme, h, 0.0).into_iter();
                let points = points.map(|(n, errors)| (1.0 / (n - 1) as f64, errors[EC] / errors[L2]));
                at_regular(number(slope(&points.collect_vec())))
            }
            HeatStatement::BestS3Regular => {
                each_n(0.0, &|n| self.one_against_rest("S3", 2.0, 0.0, n, f64::min, false))
            }
            HeatStatement::BestS3Irregular => {
                self.at_irregular(|e, n| self.one_against_rest("S3", 2.5, e, n, f64::min, false))
            }
            HeatStatement::WorstS3Irregular => {
                self.at_irregular(|e, n| self.one_against_rest("S3", 1.5, e, n, f64::max, true))
            }
            HeatStatement::TwoOrdersLower => self
                .radii("S4", 0.0)
                .into_iter()
                .cartesian_product(self.sides())
                .filter_map(|(h, n)| {
                    let ratio = self.at("S3", h, 0.0, n)?[L2] / self.at("S4", h, 0.0, n)?[L2];
                    let case = self.case(0.0, &[("h_over_dx", Value::from(h)), ("n", Value::from(n))]);
                    Some((case, Observed::Sides { left: exactly(ratio), right: exactly(100.0) }))
                })
                .collect(),
            HeatStatement::CheapAndBetter => (|| {
                let ratio = self.at("S3", 3.5, 0.0, largest)?[L2] / self.at("S4", 1.5, 0.0, largest)?[L2];
                Some((of_n(largest, 0.0), Observed::Sides { left: exactly(ratio), right: exactly(100.0) }))
            })()
            .into_iter()
            .collect(),
            HeatStatement::EightNeighbours => {
                let found = self.select("S4", 1.5, 0.0, Boundary::CutOff, "euler");
                let count = found.last().map(|(_, found, _)| Measured::exactly(found.neighbours as f64));
                at_regular(number(count))
            }
            HeatStatement::GrowsWithRadius(scheme) => {
                // Of the error in space alone, where the step in time does not hide it.
                let of = |h: f64| self.select(scheme, h, 0.0, Boundary::CutOff, "exact");
                let radii = self.radii(scheme, 0.0).into_iter().filter(|h| *h >= 2.5).collect_vec();
                let finest = radii.iter().flat_map(|h| of(*h)).map(|(c, ..)| c.problem.n).max();
                finest
                    .and_then(|n| {
                        let points = radii.iter().filter_map(|h| {
                            let found = of(*h).into_iter().find(|(c, ..)| c.problem.n == n)?;
                            Some((1.0 / h, found.2.errors.as_ref().ok()?[L2]))
                        });
                        Some((of_n(n, 0.0), Observed::Number(slope(&points.collect_vec())?)))
                    })
                    .into_iter()
                    .collect()
            }
            HeatStatement::BestS3WorseThanWorstS4 => self.at_irregular(|e, n| {
                let of = |scheme| {
                    self.radii(scheme, e).into_iter().filter_map(move |h| Some(self.at(scheme, h, e, n)?[L2]))
                };
                let worst = of("S4").fold(0.0, f64::max);
                let best = of("S3").fold(f64::INFINITY, f64::min);
                (worst > 0.0 && best.is_finite())
                    .then(|| Observed::Sides { left: exactly(worst), right: exactly(best) })
            }),
            HeatStatement::LittleChangeWithEpsilon => {
                let (Some(low), Some(high)) =
                    (self.epsilons().first().copied(), self.epsilons().last().copied())
                else {
                    return Vec::new();
                };
                let radii = self.radii("S4", high).into_iter().filter(|_| low < high);
                radii
                    .filter_map(|h| {
                        let left = self.rate("S4", h, high, L2)?;
                        let right = self.rate("S4", h, low, L2)?;
                        Some((
                            self.case(high, &[("h_over_dx", Value::from(h))]),
                            Observed::Sides { left, right },
                        ))
                    })
                    .collect()
            }
            HeatStatement::Approach => {
                // By how much the closest two came nearer, at most: ε/2 along both axes of a diagonal pair.
                let reach = |epsilon: f64| 0.5 * epsilon * std::f64::consts::SQRT_2;
                let high = self.epsilons().last().copied();
                let high = high.map(|e| (self.case(e, &[]), Observed::Number(exactly(reach(e)))));
                high.into_iter().collect()
            }
            HeatStatement::CostOfS4 => self.cost("S4", 3.5, largest),
            HeatStatement::CostOfSmallS4 => self.cost("S4", 1.5, largest),
        }
    }

    /// Multiplications by assembled entries, as a ratio to S3 at h = 3.5Δ.
    fn cost(&self, scheme: &str, h: f64, n: usize) -> Vec<(Case, Observed)> {
        let work = |scheme: &str, h: f64| {
            let all = self.select(scheme, h, 0.0, Boundary::CutOff, "euler");
            let own = all.into_iter().find(|(c, _, _)| c.problem.n == n)?;
            Some((own.1.entries as u64 * own.2.products) as f64)
        };
        let ratio = work(scheme, h).zip(work("S3", 3.5)).map(|(own, base)| own / base);
        let case =
            self.case(0.0, &[("n", Value::from(n)), ("counted", Value::from("flops, assembled once"))]);
        ratio.map(|ratio| (case, Observed::Number(exactly(ratio)))).into_iter().collect()
    }

    fn at_irregular(&self, of: impl Fn(f64, usize) -> Option<Observed>) -> Vec<(Case, Observed)> {
        let pairs = self.epsilons().into_iter().cartesian_product(self.sides());
        pairs.filter_map(|(e, n)| Some((self.case(e, &[("n", Value::from(n))]), of(e, n)?))).collect()
    }

    /// One radius against the best (or worst) of the others; `swapped` puts the others on the left.
    fn one_against_rest(
        &self,
        scheme: &str,
        h: f64,
        epsilon: f64,
        n: usize,
        of: fn(f64, f64) -> f64,
        swapped: bool,
    ) -> Option<Observed> {
        let own = exactly(self.at(scheme, h, epsilon, n)?[L2]);
        let rest = self.radii(scheme, epsilon).into_iter().filter(|other| *other != h);
        let rest = rest.filter_map(|h| Some(self.at(scheme, h, epsilon, n)?[L2])).reduce(of)?;
        let rest = exactly(rest);
        Some(match swapped {
            true => Observed::Sides { left: rest, right: own },
            false => Observed::Sides { left: own, right: rest },
        })
    }

    fn runs(&self) -> Vec<TimeRun> {
        let each = self.all.iter().flat_map(|(c, found)| found.runs.iter().map(move |run| (c, run)));
        each.filter_map(|(c, run)| {
            let [l2, linf, ec] = *run.errors.as_ref().ok()?;
            Some(TimeRun {
                scheme: c.scheme.clone(),
                n: c.problem.n as u64,
                h_over_dx: c.problem.h_over_dx,
                epsilon: c.problem.epsilon,
                integrator: run.integrator.clone(),
                boundary: c.problem.boundary.id().into(),
                l2,
                linf,
                ec,
                steps: run.steps,
            })
        })
        .collect()
    }

    /// Figs. 1 to 3: three norms of two schemes against Δ, a line for each radius.
    fn figures(&self) -> Vec<Series> {
        let mut all = Vec::new();
        for (figure, epsilon) in [("1", 0.0), ("2", 0.2), ("3", 0.4)] {
            for ((norm, name), scheme) in
                [(0, "L2"), (1, "L∞"), (2, "EC")].into_iter().cartesian_product(["S3", "S4"])
            {
                let line = |h: f64| {
                    let points = self.euler(scheme, h, epsilon).into_iter();
                    let points =
                        points.map(|(n, errors)| vec![1.0 / (n - 1) as f64, errors[norm]]).collect_vec();
                    Line { name: format!("η = {h}"), points }
                };
                let lines = self.radii(scheme, epsilon).into_iter().map(line);
                let lines = lines.filter(|line| !line.points.is_empty()).collect_vec();
                if lines.is_empty() {
                    continue;
                }
                let axis = |name: &str| Axis { name: name.into(), unit: "1".into(), log: true };
                let id = ["l2", "linf", "ec"][norm];
                all.push(Series {
                    id: format!("fig-{figure}-{scheme}-{id}"),
                    figure: Some(format!("{figure} ({scheme}, {name})")),
                    x: axis("Δ"),
                    y: axis(name),
                    lines,
                });
            }
        }
        all
    }

    fn error_rows(&self) -> Vec<ErrorRow> {
        let each = self.all.iter().flat_map(|(c, found)| found.runs.iter().map(move |run| (c, found, run)));
        each.map(|(c, found, run)| ErrorRow {
            scheme: c.scheme.clone(),
            n: c.problem.n,
            h_over_dx: c.problem.h_over_dx,
            epsilon: c.problem.epsilon,
            boundary: c.problem.boundary.id(),
            integrator: run.integrator.clone(),
            l2: run.errors.as_ref().ok().map(|errors| errors[L2]),
            rms_near_walls: run.near_far.map(|[near, _]| near),
            rms_inside: run.near_far.map(|[_, far]| far),
            l2_in_time: run.in_time,
            l2_steady: found.steady.map(|errors| errors[L2]),
            l2_transient: run.transient,
            steps: run.steps,
            entries: found.entries,
            bytes: found.bytes,
            flops: 2 * found.entries as u64 * run.products,
            stopped: run.errors.as_ref().err().cloned(),
        })
        .collect()
    }

    /// Exponents of Δ of each part of the error, where at least three n were run.
    fn slope_rows(&self) -> Vec<SlopeRow> {
        let rows = self.error_rows();
        let key = |row: &ErrorRow| {
            (
                row.scheme.clone(),
                row.h_over_dx.to_bits(),
                row.epsilon.to_bits(),
                row.boundary,
                row.integrator.clone(),
            )
        };
        rows.iter()
            .map(key)
            .unique()
            .filter_map(|wanted| {
                let own =
                    rows.iter().filter(|row| key(row) == wanted).sorted_by_key(|row| row.n).collect_vec();
                let rate = |of: &dyn Fn(&ErrorRow) -> Option<f64>| {
                    let points = own.iter().filter_map(|row| Some((1.0 / (row.n - 1) as f64, of(row)?)));
                    let points = points.filter(|(_, y)| *y > 0.0).collect_vec();
                    slope(&points).map(|found| significant(found.value, 6))
                };
                let first = own.first().filter(|_| own.len() >= 3)?;
                Some(SlopeRow {
                    scheme: first.scheme.clone(),
                    h_over_dx: first.h_over_dx,
                    epsilon: first.epsilon,
                    boundary: first.boundary,
                    integrator: first.integrator.clone(),
                    l2: rate(&|row| row.l2),
                    near_walls: rate(&|row| row.rms_near_walls),
                    inside: rate(&|row| row.rms_inside),
                    in_time: rate(&|row| row.l2_in_time),
                    steady: rate(&|row| row.l2_steady),
                    transient: rate(&|row| row.l2_transient),
                })
            })
            .collect()
    }
}

#[derive(Serialize)]
struct ErrorRow {
    scheme: String,
    n: usize,
    h_over_dx: f64,
    epsilon: f64,
    boundary: &'static str,
    integrator: String,
    l2: Option<f64>,
    rms_near_walls: Option<f64>,
    rms_inside: Option<f64>,
    l2_in_time: Option<f64>,
    l2_steady: Option<f64>,
    l2_transient: Option<f64>,
    steps: u64,
    entries: usize,
    bytes: usize,
    flops: u64,
    stopped: Option<String>,
}

#[derive(Serialize)]
struct SlopeRow {
    scheme: String,
    h_over_dx: f64,
    epsilon: f64,
    boundary: &'static str,
    integrator: String,
    l2: Option<f64>,
    near_walls: Option<f64>,
    inside: Option<f64>,
    in_time: Option<f64>,
    steady: Option<f64>,
    transient: Option<f64>,
}
