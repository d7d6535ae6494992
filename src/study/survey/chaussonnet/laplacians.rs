//! §V: Laplacians, Figs. 11–14, and what 1/π stands for.

use super::gradients::{Along, all_points, judge, lines, ratios, reference, scale_exponent, slopes};
use super::power::mean;
use super::results::{At, Results, axis, figure};
use super::{KERNEL, LATTICES, TaskError};
use crate::claim::{Measured, Observed};
use crate::derived::regularisation_factor;
use crate::kernel;
use crate::particles::VolumeRule;
use crate::record::{Case, LaplacianFactor, Report, significant};
use crate::study::survey::table_row;
use serde::Serialize;
use serde_json::Value;
use std::f64::consts::PI;

/// What rounding makes of sums whose terms are of the order δ⁻², relative to the analytical Laplacian.
const ROUNDING: f64 = 1e-9;
/// θ²/h².
const THETA_SQUARE: f64 = 0.01;
/// As printed, and without 1/π.
const NAMES: [&str; 3] = ["MCG-pi", "MCG", "MEA"];

pub(super) fn enter(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    factors(found, report)?;
    zeros(found, report);
    linear(found, report)?;
    against_each_other(found, report)?;
    lattices(found, report);
    quadratic(found, report)?;
    floors(found, report);
    figures(found, report);
    Ok(())
}

fn text(value: impl Into<String>) -> Value {
    Value::String(value.into())
}

/// What the bare sums multiply u″ by.
fn factors(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let kernel = kernel::by_id(KERNEL)?;
    for lattice in LATTICES {
        let dimension: u8 = if lattice == "simple-cubic" { 3 } else { 2 };
        let j = regularisation_factor(&kernel, dimension.into(), THETA_SQUARE);
        for rule in VolumeRule::ALL {
            let printed = dimension == 3 && found.table.angles == "printed";
            let Some(model) = found.model_of(lattice, printed, rule) else { continue };
            for operator in ["MCG", "MCG-pi", "MEA"] {
                let (target, divisor, published) = match operator {
                    "MCG" => (3.0, 1.0, PI),
                    "MCG-pi" => (3.0, PI, 1.0),
                    _ => (1.0, 1.0, 1.0),
                };
                let bare = if operator == "MEA" { "MEA" } else { "MCG" };
                report.laplacian_factors.push(LaplacianFactor {
                    operator: operator.into(),
                    dimension,
                    lattice: lattice.into(),
                    h_over_dx: found.table.h_over_dx,
                    volume_rule: rule.id().into(),
                    continuum: significant(target * j / divisor, 10),
                    lattice_value: significant(model.factor(bare) / divisor, 10),
                    published: significant(published, 10),
                });
            }
            let measured = (rule == VolumeRule::NumberDensity).then(|| {
                let at = At { eta: 0.0, ..reference(found, lattice) };
                let mean = found.operators(at.lattice, at.eta, at.h, at.scale)?.means.get("MCG-pi/U2/x")?;
                Some(Observed::Number(Measured::exactly(PI * mean)))
            });
            let case = Case { volume_rule: rule.id().into(), ..found.case(lattice, Some(0.0), &[]) };
            let derived = Some(Observed::Number(Measured::exactly(model.factor("MCG"))));
            judge(report, "laplacian/prefactor", case, derived, measured.flatten(), Vec::new());
        }
        if lattice != "hexagonal" {
            for (of, theta_square) in [("continuum, θ² = 0.01 h²", THETA_SQUARE), ("continuum, θ = 0", 0.0)]
            {
                let factor = 3.0 * regularisation_factor(&kernel, dimension.into(), theta_square);
                let case = Case {
                    lattice: Some("continuum".into()),
                    ..found.case(lattice, None, &[("limit", text(of))])
                };
                let derived = Some(Observed::Number(Measured::exactly(factor)));
                judge(report, "laplacian/prefactor", case, derived, None, Vec::new());
            }
        }
    }
    Ok(())
}

fn zeros(found: &Results<'_>, report: &mut Report) {
    let zero = |largest, floor| Some(Observed::Zero { largest, floor });
    for lattice in LATTICES {
        let at = reference(found, lattice);
        let etas = || std::iter::once(0.0).chain(found.table.eta.iter().copied());
        let largest = |name: &str, etas: &mut dyn Iterator<Item = f64>| {
            etas.filter_map(|eta| found.rms(At { eta, ..at }, name)).map(|(y, _)| y).fold(0.0, f64::max)
        };
        for operator in ["MCG-pi", "MEA"] {
            let more = [("operator", text(operator))];
            let name = format!("{operator}/U0/x");
            let measured = zero(largest(&name, &mut etas()), 0.0);
            let case = found.case(lattice, None, &more);
            judge(report, "laplacian/constant", case, zero(0.0, 0.0), measured, Vec::new());
            let name = format!("{operator}/U1/x");
            let measured = zero(largest(&name, &mut std::iter::once(0.0)), ROUNDING);
            let derived = found.model(lattice).map(|model| {
                let bare = if operator == "MEA" { "MEA[1]" } else { "MCG[1]" };
                Observed::Zero { largest: model.component(bare, 0).regular.abs(), floor: 1e-12 }
            });
            let case = found.case(lattice, Some(0.0), &more);
            judge(report, "laplacian/regular-linear", case, derived, measured, Vec::new());
        }
        for field in ["U1", "U2"] {
            let measured = zero(largest(&format!("MEA/{field}/y"), &mut etas()), 0.0);
            let case = found.case(lattice, None, &[("field", text(field))]);
            judge(report, "laplacian/MEA-y", case, zero(0.0, 0.0), measured, Vec::new());
            let sides = |observed: Option<Observed>| match observed {
                Some(Observed::Number(left)) => {
                    Some(Observed::Sides { left, right: Measured::exactly(10.0_f64.sqrt().recip()) })
                }
                _ => None,
            };
            let (y, x) = (format!("MCG-pi/{field}/y"), format!("MCG-pi/{field}/x"));
            let (derived, measured) = ratios(found, (at, &y), (at, &x));
            let case = found.case(lattice, Some(at.eta), &[("field", text(field))]);
            judge(report, "laplacian/MCG-y", case, sides(derived), sides(measured), Vec::new());
        }
    }
}

fn linear(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for operator in ["MCG-pi", "MEA"] {
        for lattice in LATTICES {
            let name = format!("{operator}/U1/x");
            let at = reference(found, lattice);
            for (along, id) in [(Along::H, "laplacian/linear-h"), (Along::Eta, "laplacian/linear-eta")] {
                if let Some((derived, measured, fits)) = slopes(found, report, at, &name, along)? {
                    let eta = (along == Along::H).then_some(at.eta);
                    let case = found.case(lattice, eta, &[("operator", text(operator))]);
                    judge(report, id, case, derived, Some(measured), fits);
                }
            }
        }
        for (lattice, field) in itertools::iproduct!(LATTICES, ["U1", "U2"]) {
            let points = all_points(found, lattice, &format!("{operator}/{field}/x"), true);
            if let Some(observed) = scale_exponent(&points)? {
                let case = found.case(lattice, None, &[("operator", text(operator)), ("field", text(field))]);
                let derived = Some(Observed::Number(Measured::exactly(0.0)));
                judge(report, "laplacian/falls-with-scale", case, derived, Some(observed), Vec::new());
            }
        }
    }
    Ok(())
}

/// The geometric mean over all h, η and K_x on the square lattice of the ratio of two errors; there is no derived one where
/// some of the η are beyond it.
fn mean_ratio(
    found: &Results<'_>,
    name: &str,
    other: &str,
    measured: bool,
) -> Result<Option<Observed>, TaskError> {
    let points = |name: &str, measured| all_points(found, "square", name, measured);
    let all = points(name, true).len();
    let (own, other) = (points(name, measured), points(other, measured));
    if own.is_empty() || own.len() != all || own.len() != other.len() {
        return Ok(None);
    }
    let logarithms: Vec<f64> = own.iter().zip(&other).map(|(a, b)| libm::log(a[3] / b[3])).collect();
    let mean = mean(&logarithms)?;
    let exp = |x: f64| significant(libm::exp(x), 8);
    let mut found = Measured { value: exp(mean.value), low: exp(mean.low), high: exp(mean.high) };
    if !measured {
        // Derived values are no sample.
        found = Measured::exactly(found.value);
    }
    Ok(Some(Observed::Number(found)))
}

fn against_each_other(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for prefactor in ["MCG-pi", "MCG"] {
        let what = if prefactor == "MCG" { "without 1/π" } else { "with 1/π" };
        for (id, fields) in [
            ("laplacian/18-percent", &["U1"][..]),
            ("laplacian/17-percent", &["U2"]),
            ("laplacian/20-percent", &["U1", "U2"]),
            ("laplacian/30-percent", &["U1", "U2"]),
        ] {
            for field in fields {
                let (own, other) = (format!("MEA/{field}/x"), format!("{prefactor}/{field}/x"));
                let derived = mean_ratio(found, &own, &other, false)?;
                let measured = mean_ratio(found, &own, &other, true)?;
                let more = [("MCG", text(what)), ("field", text(*field))];
                judge(report, id, found.case("square", None, &more), derived, measured, Vec::new());
            }
        }
        let at = reference(found, "hexagonal");
        for eta in found.table.eta.iter().copied() {
            let at = At { eta, ..at };
            let name = format!("{prefactor}/U1/x");
            let (derived, measured) = ratios(found, (at, "MEA/U1/x"), (at, &name));
            let case = found.case("hexagonal", Some(eta), &[("MCG", text(what))]);
            judge(report, "laplacian/equal-on-triangles", case, derived, measured, Vec::new());
        }
    }
    Ok(())
}

fn lattices(found: &Results<'_>, report: &mut Report) {
    let sides = |left: Option<Measured>, right: Option<Measured>| {
        left.zip(right).map(|(left, right)| Observed::Sides { left, right })
    };
    for field in ["U1", "U2"] {
        for operator in ["MCG-pi", "MEA"] {
            let name = format!("{operator}/{field}/x");
            let at = reference(found, "simple-cubic");
            let square = At { lattice: "square", ..at };
            let (derived, measured) = ratios(found, (at, &name), (square, &name));
            let case = found.case(
                "simple-cubic",
                Some(at.eta),
                &[("operator", text(operator)), ("field", text(field))],
            );
            judge(report, "laplacian/3d-lower", case, derived, measured, Vec::new());
        }
    }
    for prefactor in ["MCG-pi", "MCG"] {
        let what = if prefactor == "MCG" { "without 1/π" } else { "with 1/π" };
        let name = format!("{prefactor}/U2/x");
        for eta in std::iter::once(0.0).chain(found.table.eta.iter().copied()) {
            let at = At { eta, ..reference(found, "hexagonal") };
            let square = At { lattice: "square", ..at };
            let derived = |at: At, name: &str| found.derived(at, name).map(Measured::exactly);
            let case = found.case("hexagonal", Some(eta), &[("MCG", text(what))]);
            judge(
                report,
                "laplacian/MCG-worse-on-triangles",
                case.clone(),
                sides(derived(at, &name), derived(square, &name)),
                sides(found.measured(at, &name), found.measured(square, &name)),
                Vec::new(),
            );
            if eta < 1e-2 {
                judge(
                    report,
                    "laplacian/MCG-above-MEA-on-triangles",
                    case,
                    sides(derived(at, &name), derived(at, "MEA/U2/x")),
                    sides(found.measured(at, &name), found.measured(at, "MEA/U2/x")),
                    Vec::new(),
                );
            }
        }
    }
}

fn quadratic(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for operator in NAMES {
        let name = format!("{operator}/U2/x");
        for lattice in LATTICES {
            let more = [("operator", text(operator))];
            let at = At { eta: 0.0, ..reference(found, lattice) };
            let floor = Measured::exactly(ROUNDING);
            let sides = |left: f64| Observed::Sides { left: Measured::exactly(left), right: floor };
            let derived = found.derived(at, &name).map(sides);
            let measured = found.rms(at, &name).map(|(y, _)| sides(y));
            let case = found.case(lattice, Some(0.0), &more);
            judge(report, "laplacian/regular-quadratic", case, derived, measured, Vec::new());

            // Between the two lowest η.
            let local = |value: &dyn Fn(At) -> Option<f64>| {
                let [low, next, ..] = found.table.eta[..] else { return None };
                let at = |eta| At { eta, ..reference(found, lattice) };
                let ratio = value(at(next))? / value(at(low))?;
                let left = libm::log(ratio) / libm::log(next / low);
                Some(Observed::Sides { left: Measured::exactly(left), right: Measured::exactly(0.5) })
            };
            let derived = local(&|at| found.derived(at, &name));
            let measured = local(&|at| found.rms(at, &name).map(|(y, _)| y));
            let case = found.case(lattice, None, &more);
            judge(report, "laplacian/eta-lost-at-low", case, derived, measured, Vec::new());

            let mut ends = Vec::new();
            for eta in [found.table.largest_eta(), found.table.eta[0]] {
                let at = At { eta, ..reference(found, lattice) };
                ends.push(slopes(found, report, at, &name, Along::H)?);
            }
            if let [Some(strong), Some(weak)] = &ends[..] {
                let from_one = |observed: &Observed| match observed {
                    Observed::Number(m) => {
                        let (a, b) = ((1.0 + m.low).abs(), (1.0 + m.high).abs());
                        let low = if m.low < -1.0 && m.high > -1.0 { 0.0 } else { a.min(b) };
                        Measured { value: (1.0 + m.value).abs(), low, high: a.max(b) }
                    }
                    _ => Measured::exactly(0.0),
                };
                let sides = |left: &Observed, right: &Observed| Observed::Sides {
                    left: from_one(left),
                    right: from_one(right),
                };
                let derived = strong.0.as_ref().zip(weak.0.as_ref()).map(|(s, w)| sides(s, w));
                let measured = Some(sides(&strong.1, &weak.1));
                let fits = strong.2.iter().chain(&weak.2).cloned().collect();
                let case = found.case(lattice, None, &more);
                judge(report, "laplacian/h-lost-at-strong", case, derived, measured, fits);
            }
        }
    }
    Ok(())
}

/// Ω² against η, and the lattice's own part of it.
#[derive(Serialize)]
struct Floor {
    lattice: &'static str,
    operator: &'static str,
    eta: f64,
    measured: Option<f64>,
    derived: Option<f64>,
    lattice_factor_minus_1: Option<f64>,
    share_of_lattice: Option<f64>,
}

fn floors(found: &Results<'_>, report: &mut Report) {
    let mut rows = Vec::new();
    for lattice in LATTICES {
        for operator in NAMES {
            for eta in std::iter::once(0.0).chain(found.table.eta.iter().copied()) {
                let at = At { eta, ..reference(found, lattice) };
                let name = format!("{operator}/U2/x");
                let regular = found.derived(At { eta: 0.0, ..at }, &name);
                let derived = found.derived(at, &name);
                let share = regular.zip(derived).map(|(r, d)| significant(r * r / (d * d), 4));
                rows.push(table_row(&Floor {
                    lattice,
                    operator,
                    eta,
                    measured: found.rms(at, &name).map(|(y, _)| significant(y, 6)),
                    derived: derived.map(|y| significant(y, 6)),
                    lattice_factor_minus_1: regular.map(|y| significant(y, 6)),
                    share_of_lattice: share,
                }));
            }
        }
    }
    report.tables.insert("laplacian_floor".into(), rows);
}

fn figures(found: &Results<'_>, report: &mut Report) {
    let at = |lattice| reference(found, lattice);
    let all = LATTICES.map(at);
    let strong = At { eta: found.table.largest_eta(), ..at("square") };
    let mut push = |number: &str, along: Along, cases: &[At], names: &[&str]| {
        let (x, unit) = match along {
            Along::H => ("h", "m"),
            Along::Eta => ("η", "1"),
            Along::Scale => ("K_x", "1"),
        };
        let id = format!("chaussonnet-figure-{number}");
        let lines = lines(found, cases, names, along);
        report.series.push(figure(&id, number, axis(x, unit), axis("Ω", "1"), lines));
    };
    let linear = ["MCG-pi/U1/x", "MEA/U1/x", "MCG/U1/x"];
    let quadratic = ["MCG-pi/U2/x", "MEA/U2/x", "MCG/U2/x"];
    push("11a", Along::Eta, &all[..2], &quadratic);
    push("11b", Along::H, &all, &linear);
    let both = ["MCG-pi/U2/x", "MCG-pi/U2/y", "MEA/U2/x", "MEA/U2/y"];
    push("12", Along::Scale, &all[..1], &both);
    for (figure, names) in [("13", linear), ("14", quadratic)] {
        push(&format!("{figure}a"), Along::H, &[strong, all[0]], &names);
        push(&format!("{figure}b"), Along::Eta, &all[..1], &names);
        push(&format!("{figure}c"), Along::Scale, &all[..1], &names);
    }
}
