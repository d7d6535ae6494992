//! §III: consistency errors, Figs. 4 and 5.

use super::power::{Ladder, slope};
use super::results::{Results, axis, figure, interval, line, ratio};
use super::{LATTICES, TaskError};
use crate::claim::chaussonnet_2015::assertion;
use crate::claim::{Measured, Observed};
use crate::record::{Report, significant};
use crate::study::survey::{entry, table_row};
use serde::Serialize;

/// E by name; that of Eq. (7) as printed stands apart.
const ERRORS: [&str; 4] = ["E_0^0", "E_0^1", "E_1^0", "E_1^1"];
const PRINTED: &str = "E_1^1 printed";
/// Rounding of sums of some hundred terms of order one, and of V.
const ROUNDING: f64 = 1e-13;

pub(super) fn enter(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    regular(found, report);
    against_h(found, report)?;
    against_eta(found, report)?;
    comparisons(found, report);
    figures(found, report);
    Ok(())
}

fn least_h(found: &Results<'_>) -> f64 {
    found.table.consistency_h_m.last().copied().unwrap_or(1e-6)
}

fn value(found: &Results<'_>, lattice: &'static str, eta: f64, h: f64, name: &str) -> Option<(f64, f64)> {
    let squares = found.consistency(lattice, eta, h)?.squares.get(name)?;
    Some((squares.rms(), squares.rms_error()))
}

fn measured(found: &Results<'_>, lattice: &'static str, eta: f64, h: f64, name: &str) -> Option<Measured> {
    value(found, lattice, eta, h, name).map(interval)
}

fn regular(found: &Results<'_>, report: &mut Report) {
    let assertion = assertion("chaussonnet-consistency/regular");
    for lattice in LATTICES {
        for name in ERRORS.into_iter().chain([PRINTED]) {
            let largest = |h: &f64| value(found, lattice, 0.0, *h, name).map(|(rms, _)| rms);
            let largest = found.table.consistency_h_m.iter().filter_map(largest).fold(0.0_f64, f64::max);
            // r_b reaches to the far corner: its terms are that much larger.
            let floor = if name == PRINTED { 1e3 * ROUNDING } else { ROUNDING };
            let derived = found.model(lattice).filter(|_| name != PRINTED).map(|model| Observed::Zero {
                largest: model.consistency(name, 0.0, found.table.h_over_dx),
                floor,
            });
            let case = found.case(lattice, Some(0.0), &[("error", name.into())]);
            let measured = Some(Observed::Zero { largest, floor });
            report.claims.push(entry(&assertion, case, derived, measured, Vec::new()));
        }
    }
}

fn against_h(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let eta = found.table.largest_eta();
    if found.table.consistency_h_m.len() < 3 {
        return Ok(());
    }
    for lattice in LATTICES {
        for name in ERRORS {
            let points: Vec<(f64, f64, f64)> = found
                .table
                .consistency_h_m
                .iter()
                .filter_map(|h| value(found, lattice, eta, *h, name).map(|(y, error)| (*h, y, error)))
                .collect();
            let case = found.case(lattice, Some(eta), &[("error", name.into())]);
            let ladder = Ladder {
                id: format!("{lattice}/{name}/h"),
                quantity: name.into(),
                case: case.clone(),
                varies: "h",
                unit: "m",
            };
            let (slope, fit) = slope(ladder, &points)?;
            let fits = vec![fit.id.clone()];
            report.fits.push(fit);
            // All lengths scale with h.
            let claims = match name {
                "E_0^1" => vec![("h-independent", 0.0), ("C01-diverges", -1.0)],
                "E_1^0" => vec![("h-independent", 0.0), ("C10-recovered", 1.0)],
                _ => vec![("h-independent", 0.0)],
            };
            for (id, power) in claims {
                let assertion = assertion(&format!("chaussonnet-consistency/{id}"));
                let derived = Some(Observed::Number(Measured::exactly(power)));
                let measured = Some(Observed::Number(slope.plus(Measured::exactly(power))));
                report.claims.push(entry(&assertion, case.clone(), derived, measured, fits.clone()));
            }
        }
    }
    Ok(())
}

fn against_eta(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let h = least_h(found);
    for lattice in LATTICES {
        for name in ERRORS {
            let at = |eta: &f64| value(found, lattice, *eta, h, name).map(|(y, error)| (*eta, y, error));
            let points: Vec<(f64, f64, f64)> = found.table.eta.iter().filter_map(at).collect();
            let case = found.case(lattice, None, &[("error", name.into())]);
            let ladder = |id: &str| Ladder {
                id: format!("{lattice}/{name}/{id}"),
                quantity: name.into(),
                case: case.clone(),
                varies: "eta",
                unit: "1",
            };
            let (measured, fit) = slope(ladder("eta"), &points)?;
            let fits = vec![fit.id.clone()];
            report.fits.push(fit);
            let derived = |eta: &f64| Some((*eta, found.derived_consistency(lattice, *eta, name)?, 0.0));
            let derived: Vec<_> = found.table.eta.iter().filter_map(derived).collect();
            let derived = match derived.len() {
                0..3 => None,
                _ => Some(Observed::Number(slope(ladder("eta, derived"), &derived)?.0)),
            };
            let claim = assertion("chaussonnet-consistency/linear-in-eta");
            let observed = Some(Observed::Number(measured));
            report.claims.push(entry(&claim, case.clone(), derived, observed, fits));
            if name == "E_0^1" || name == "E_1^0" {
                let base = |eta: f64| value(found, lattice, eta, h, "E_0^0").map(|(y, _)| y);
                let ratios: Vec<_> = points
                    .iter()
                    .filter_map(|(eta, y, error)| base(*eta).map(|base| (*eta, y / base, error / base)))
                    .collect();
                let (trend, fit) = slope(ladder("eta, by E_0^0"), &ratios)?;
                let fits = vec![fit.id.clone()];
                report.fits.push(fit);
                let claim = assertion("chaussonnet-consistency/same-trend");
                let observed = Some(Observed::Number(trend));
                report.claims.push(entry(&claim, case, None, observed, fits));
            }
        }
    }
    Ok(())
}

/// One E in one reading.
#[derive(Serialize)]
struct Row {
    lattice: &'static str,
    eta: f64,
    e00: Option<f64>,
    e01: Option<f64>,
    e10: Option<f64>,
    e11_by_r_ab: Option<f64>,
    e11_by_r_b_as_printed: Option<f64>,
    e11_by_r_ab_derived: Option<f64>,
    b_inverse_minus_i: Option<f64>,
    b_inverse_share: Option<f64>,
}

fn comparisons(found: &Results<'_>, report: &mut Report) {
    let h = least_h(found);
    let mut rows = Vec::new();
    for lattice in LATTICES {
        for eta in found.table.eta.iter().copied() {
            let of = |name: &str| measured(found, lattice, eta, h, name);
            let derived = |name: &str, eta: f64| found.derived_consistency(lattice, eta, name);
            let exactly = |value: Option<f64>| value.map(Measured::exactly);
            let largest = |values: [Option<Measured>; 3]| {
                values.into_iter().flatten().max_by(|a, b| a.value.total_cmp(&b.value))
            };
            let others = ["E_0^0", "E_0^1", "E_1^0"];
            let claim = assertion("chaussonnet-consistency/E11-largest");
            let sides = |left: Option<Measured>, right: Option<Measured>| {
                Some(Observed::Sides { left: left?, right: right? })
            };
            for (reading, name) in [("r_ab", "E_1^1"), ("r_b as printed", PRINTED)] {
                let derived = (name != PRINTED).then(|| {
                    let right = largest(others.map(|name| exactly(derived(name, eta))));
                    sides(exactly(derived(name, eta)), right)
                });
                let case = found.case(lattice, Some(eta), &[("reading", reading.into())]);
                let observed = sides(of(name), largest(others.map(of)));
                report.claims.push(entry(&claim, case, derived.flatten(), observed, Vec::new()));
            }
            if lattice != "square" {
                let ids: &[(&str, &str)] = if lattice == "hexagonal" {
                    &[("same-in-2d", "E_0^0"), ("same-in-2d", "E_0^1"), ("same-in-2d", "E_1^0")]
                } else {
                    &[("smaller-in-3d", "E_0^0")]
                };
                for (id, name) in ids {
                    let claim = assertion(&format!("chaussonnet-consistency/{id}"));
                    let square = measured(found, "square", eta, h, name);
                    let square_derived = found.derived_consistency("square", eta, name);
                    let pair = |own: Option<Measured>, other: Option<Measured>| {
                        if lattice == "hexagonal" {
                            Some(Observed::Number(ratio(own?, other?)))
                        } else {
                            sides(own, other)
                        }
                    };
                    let case = found.case(lattice, Some(eta), &[("error", (*name).into())]);
                    let derived = pair(exactly(derived(name, eta)), exactly(square_derived));
                    report.claims.push(entry(&claim, case, derived, pair(of(name), square), Vec::new()));
                }
            }
            let round = |m: Option<Measured>| m.map(|m| significant(m.value, 6));
            let floor = derived("E_1^1", 0.0);
            let total = derived("E_1^1", eta);
            rows.push(table_row(&Row {
                lattice,
                eta,
                e00: round(of("E_0^0")),
                e01: round(of("E_0^1")),
                e10: round(of("E_1^0")),
                e11_by_r_ab: round(of("E_1^1")),
                e11_by_r_b_as_printed: round(of(PRINTED)),
                e11_by_r_ab_derived: total.map(|x| significant(x, 6)),
                b_inverse_minus_i: floor.map(|x| significant(x, 6)),
                b_inverse_share: floor.zip(total).map(|(f, t)| significant(f * f / (t * t), 4)),
            }));
        }
    }
    report.tables.insert("consistency".into(), rows);
}

fn figures(found: &Results<'_>, report: &mut Report) {
    let (mut of_h, mut of_eta) = (Vec::new(), Vec::new());
    let etas = || std::iter::once(0.0).chain(found.table.eta.iter().copied());
    for lattice in LATTICES {
        for name in ERRORS.into_iter().chain([PRINTED]) {
            let h = found.table.consistency_h_m.iter().filter_map(|h| {
                value(found, lattice, found.table.largest_eta(), *h, name).map(|(y, e)| (*h, y, e))
            });
            of_h.push(line(format!("{name}, {lattice}"), h));
            let h = least_h(found);
            let eta = etas().filter_map(|eta| value(found, lattice, eta, h, name).map(|(y, e)| (eta, y, e)));
            of_eta.push(line(format!("{name}, {lattice}"), eta));
        }
    }
    let series = [("4", axis("h", "m"), of_h), ("5", axis("η", "1"), of_eta)];
    for (number, x, lines) in series {
        let id = format!("chaussonnet-figure-{number}");
        report.series.push(figure(&id, number, x, axis("E", "1"), lines));
    }
}
