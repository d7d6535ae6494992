//! §IV: gradients, Figs. 6–10.

use super::compute::{CHECKED_ETA, GRADIENTS};
use super::power::{Ladder, mean, slope};
use super::results::{At, Results, axis, figure, line, ratio};
use super::{LATTICES, TaskError};
use crate::claim::chaussonnet_2015::assertion;
use crate::claim::{Measured, Observed};
use crate::derived::{Conservation, Conserved};
use crate::language::operators;
use crate::record::{Case, Report, significant};
use crate::study::survey::{entry, table_row};
use serde::Serialize;
use serde_json::Value;

/// What rounding makes of sums whose terms are of the order 1/δ, relative to the analytical gradient.
const ROUNDING: f64 = 1e-11;

/// What a ladder varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Along {
    H,
    Eta,
    Scale,
}

impl Along {
    pub(super) fn name(self) -> (&'static str, &'static str) {
        match self {
            Self::H => ("h", "m"),
            Self::Eta => ("eta", "1"),
            Self::Scale => ("field-scale", "1"),
        }
    }

    /// The cases along it through `at`.
    pub(super) fn cases(self, found: &Results<'_>, at: At) -> Vec<(f64, At)> {
        match self {
            Self::H => found.table.ladder(at.lattice).iter().map(|h| (*h, At { h: *h, ..at })).collect(),
            Self::Eta => found.table.eta.iter().map(|eta| (*eta, At { eta: *eta, ..at })).collect(),
            Self::Scale => {
                found.table.field_scales.iter().map(|scale| (*scale, At { scale: *scale, ..at })).collect()
            }
        }
    }
}

/// What was derived, what was measured, and the ids of the fits behind it.
type Columns = (Option<Observed>, Observed, Vec<String>);

/// The slopes of a named error along h, η or K_x, measured (with its fit entered) and derived.
pub(super) fn slopes(
    found: &Results<'_>,
    report: &mut Report,
    at: At,
    name: &str,
    along: Along,
) -> Result<Option<Columns>, TaskError> {
    let cases = along.cases(found, at);
    let points: Vec<_> =
        cases.iter().filter_map(|(x, at)| found.rms(*at, name).map(|(y, error)| (*x, y, error))).collect();
    if points.len() < 3 || points.iter().any(|(_, y, _)| *y <= 0.0) {
        return Ok(None);
    }
    let (varies, unit) = along.name();
    let held = match along {
        Along::H => format!("η = {}", at.eta),
        Along::Eta => format!("h = {:e}", at.h),
        Along::Scale => format!("η = {}, h = {:e}", at.eta, at.h),
    };
    let ladder = |id: String| Ladder {
        id,
        quantity: name.into(),
        case: found.case(at.lattice, (along != Along::Eta).then_some(at.eta), &[]),
        varies,
        unit,
    };
    let id = format!("{}/{name}/{varies} at {held}", at.lattice);
    let (measured, fit) = slope(ladder(id.clone()), &points)?;
    report.fits.push(fit);
    let derived: Vec<_> =
        cases.iter().filter_map(|(x, at)| found.derived(*at, name).map(|y| (*x, y, 0.0))).collect();
    // Along η the derived slope is that of the η at which there are derived errors.
    let derived = if derived.len() >= 3 && derived.iter().all(|(_, y, _)| *y > 0.0) {
        Some(Observed::Number(slope(ladder(format!("{id}, derived")), &derived)?.0))
    } else {
        None
    };
    Ok(Some((derived, Observed::Number(measured), vec![id])))
}

/// Enters a statement in one case.
pub(super) fn judge(
    report: &mut Report,
    id: &str,
    case: Case,
    derived: Option<Observed>,
    measured: Option<Observed>,
    fits: Vec<String>,
) {
    report.claims.push(entry(&assertion(&format!("chaussonnet-{id}")), case, derived, measured, fits));
}

/// The case at which figures hold what they do not vary: h = 1 mm, η = 0.0025 (Fig. 6), K_x = 1.
pub(super) fn reference(found: &Results<'_>, lattice: &'static str) -> At {
    let eta = found.table.eta[found.table.eta.len() / 2 - usize::from(found.table.eta.len() % 2 == 0)];
    At { lattice, eta, h: found.common_h(), scale: 1.0 }
}

/// Measured and derived ratio of two named errors, each in its case.
pub(super) fn ratios(
    found: &Results<'_>,
    (at, name): (At, &str),
    (other, other_name): (At, &str),
) -> (Option<Observed>, Option<Observed>) {
    let derived = found.derived(at, name).zip(found.derived(other, other_name));
    let derived = derived.map(|(a, b)| Observed::Number(Measured::exactly(a / b)));
    let measured = found.measured(at, name).zip(found.measured(other, other_name));
    (derived, measured.map(|(a, b)| Observed::Number(ratio(a, b))))
}

pub(super) fn enter(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    lattices(found, report)?;
    directions(found, report);
    constant(found, report)?;
    factor_two(found, report);
    minus(found, report)?;
    quadratic(found, report);
    conservation(found, report)?;
    floors(found, report);
    figures(found, report);
    Ok(())
}

fn text(value: impl Into<String>) -> Value {
    Value::String(value.into())
}

fn lattices(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for operator in ["G0", "G+"] {
        for field in 0..3 {
            let name = format!("{operator}/F{field}/x");
            let more = [("operator", text(operator)), ("field", text(format!("F{field}")))];
            for lattice in LATTICES {
                let at = reference(found, lattice);
                for (along, id) in [(Along::H, "gradient/trend-h"), (Along::Eta, "gradient/trend-eta")] {
                    if let Some((derived, measured, fits)) = slopes(found, report, at, &name, along)? {
                        let case = found.case(lattice, (along == Along::H).then_some(at.eta), &more);
                        judge(report, id, case, derived, Some(measured), fits);
                    }
                }
                if lattice != "square" {
                    let id =
                        if lattice == "hexagonal" { "gradient/similar-in-2d" } else { "gradient/3d-lower" };
                    let square = At { lattice: "square", ..at };
                    let (derived, measured) = ratios(found, (at, &name), (square, &name));
                    judge(
                        report,
                        id,
                        found.case(lattice, Some(at.eta), &more),
                        derived,
                        measured,
                        Vec::new(),
                    );
                }
            }
        }
    }
    Ok(())
}

fn directions(found: &Results<'_>, report: &mut Report) {
    for lattice in LATTICES {
        let at = reference(found, lattice);
        let axes: &[&str] = if lattice == "simple-cubic" { &["y", "z"] } else { &["y"] };
        for operator in GRADIENTS {
            for field in 0..3 {
                for axis in axes.iter().filter(|_| operator != "G-" || field > 0) {
                    let name = |axis: &str| format!("{operator}/F{field}/{axis}");
                    let (derived, measured) = ratios(found, (at, &name(axis)), (at, &name("x")));
                    let case = found.case(
                        lattice,
                        Some(at.eta),
                        &[
                            ("operator", text(operator)),
                            ("field", text(format!("F{field}"))),
                            ("axis", text(*axis)),
                        ],
                    );
                    judge(report, "gradient/directivity", case, derived, measured, Vec::new());
                }
            }
        }
    }
}

fn constant(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for lattice in LATTICES {
        for operator in GRADIENTS {
            let name = format!("{operator}/F0/x");
            let at = At { eta: 0.0, ..reference(found, lattice) };
            let largest = Along::H.cases(found, at);
            let largest = largest.iter().filter_map(|(_, at)| found.rms(*at, &name)).map(|(y, _)| y);
            let largest = largest.fold(0.0, f64::max);
            let case = found.case(lattice, Some(0.0), &[("operator", text(operator))]);
            let derived =
                Some(Observed::Zero { largest: found.derived(at, &name).unwrap_or(0.0), floor: ROUNDING });
            let measured = Some(Observed::Zero { largest, floor: ROUNDING });
            judge(report, "gradient/regular-constant", case, derived, measured, Vec::new());
        }
        let name = "G-/F0/x";
        let cases = found.table.eta.iter().map(|eta| At { eta: *eta, ..reference(found, lattice) });
        let largest = cases.filter_map(|at| found.rms(at, name)).map(|(y, _)| y).fold(0.0, f64::max);
        // φ_b − φ_a of a constant is zero to the bit.
        let zero = |largest| Some(Observed::Zero { largest, floor: 0.0 });
        let case = found.case(lattice, None, &[]);
        judge(report, "gradient/minus-constant", case, zero(0.0), zero(largest), Vec::new());
    }
    for (lattice, operator, field) in itertools::iproduct!(LATTICES, GRADIENTS, 0..3) {
        if operator == "G-" && field == 0 {
            continue;
        }
        let name = format!("{operator}/F{field}/x");
        // Every h and η, each with its own particles for every K_x.
        let Some(observed) = scale_exponent(&all_points(found, lattice, &name, true))? else { continue };
        let more = [("operator", text(operator)), ("field", text(format!("F{field}")))];
        let case = found.case(lattice, None, &more);
        let derived = Some(Observed::Number(Measured::exactly(0.0)));
        judge(report, "gradient/falls-with-scale", case, derived, Some(observed), Vec::new());
    }
    Ok(())
}

/// [h, η, K_x, y] of all cases on a lattice.
pub(super) fn all_points(
    found: &Results<'_>,
    lattice: &'static str,
    name: &str,
    measured: bool,
) -> Vec<[f64; 4]> {
    let mut points = Vec::new();
    for h in found.table.ladder(lattice) {
        for eta in &found.table.eta {
            for scale in &found.table.field_scales {
                let at = At { lattice, eta: *eta, h: *h, scale: *scale };
                let y = if measured { found.rms(at, name).map(|(y, _)| y) } else { found.derived(at, name) };
                points.extend(y.filter(|y| *y > 0.0).map(|y| [*h, *eta, *scale, y]));
            }
        }
    }
    points
}

/// The exponent of K_x within groups of equal h and η.
pub(super) fn scale_exponent(points: &[[f64; 4]]) -> Result<Option<Observed>, TaskError> {
    let mut slopes = Vec::new();
    let mut rest = points;
    while let Some(first) = rest.first() {
        let count = rest.iter().take_while(|p| p[..2] == first[..2]).count();
        let (group, after) = rest.split_at(count);
        rest = after;
        let x: Vec<f64> = group.iter().map(|p| libm::log(p[2])).collect();
        let y: Vec<f64> = group.iter().map(|p| libm::log(p[3])).collect();
        let middle = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (mx, my) = (middle(&x), middle(&y));
        let square: f64 = x.iter().map(|x| (x - mx) * (x - mx)).sum();
        let cross: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
        if square > 0.0 {
            slopes.push(cross / square);
        }
    }
    if slopes.is_empty() { Ok(None) } else { Ok(Some(Observed::Number(mean(&slopes)?))) }
}

fn factor_two(found: &Results<'_>, report: &mut Report) {
    for lattice in LATTICES {
        for (field, id) in [(0, "constant"), (1, "linear"), (2, "quadratic")] {
            for eta in found.table.eta.iter().copied() {
                let at = At { eta, ..reference(found, lattice) };
                let (plus, zero) = (format!("G+/F{field}/x"), format!("G0/F{field}/x"));
                let (derived, mut measured) = ratios(found, (at, &plus), (at, &zero));
                if field == 0 {
                    // The same particles: the error is twice that of G0 at each of them.
                    measured = measured.map(|observed| match observed {
                        Observed::Number(found) => Observed::Number(Measured::exactly(found.value)),
                        other => other,
                    });
                }
                let case = found.case(lattice, Some(eta), &[]);
                judge(report, &format!("gradient/factor-2-{id}"), case, derived, measured, Vec::new());
            }
        }
    }
}

fn minus(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    for lattice in LATTICES {
        for field in 1..3 {
            let name = format!("G-/F{field}/x");
            let more = [("field", text(format!("F{field}")))];
            for eta in [found.table.eta[0], found.table.largest_eta()] {
                let at = At { eta, ..reference(found, lattice) };
                if let Some((derived, measured, fits)) = slopes(found, report, at, &name, Along::H)? {
                    let case = found.case(lattice, Some(eta), &more);
                    judge(report, "gradient/minus-h", case, derived, Some(measured), fits);
                }
            }
            let at = At { eta: found.table.eta[0], ..reference(found, lattice) };
            let zero = |largest| Observed::Zero { largest, floor: ROUNDING };
            judge(
                report,
                "gradient/minus-small-eta",
                found.case(lattice, Some(at.eta), &more),
                found.derived(at, &name).map(zero),
                found.rms(at, &name).map(|(y, _)| zero(y)),
                Vec::new(),
            );
            for (h, other) in found.table.ladder(lattice).iter().flat_map(|h| [(*h, "G0"), (*h, "G+")]) {
                let at = At { h, ..reference(found, lattice) };
                let other_name = format!("{other}/F{field}/x");
                let (derived, measured) = ratios(found, (at, &other_name), (at, &name));
                let logarithm = |observed: Option<Observed>| match observed {
                    Some(Observed::Number(m)) => Some(Observed::Number(Measured {
                        value: libm::log10(m.value),
                        low: libm::log10(m.low.max(1e-300)),
                        high: libm::log10(m.high),
                    })),
                    _ => None,
                };
                let case = found.case(
                    lattice,
                    Some(at.eta),
                    &[
                        ("against", text(other)),
                        ("field", text(format!("F{field}"))),
                        ("h", text(format!("h = {h:e} m"))),
                    ],
                );
                let (derived, measured) = (logarithm(derived), logarithm(measured));
                judge(report, "gradient/minus-two-orders", case, derived, measured, Vec::new());
            }
        }
    }
    Ok(())
}

fn quadratic(found: &Results<'_>, report: &mut Report) {
    for lattice in LATTICES {
        let at = reference(found, lattice);
        for operator in GRADIENTS {
            for (reading, suffix) in [("local gradient", ""), ("one N₂ for the domain", "/whole")] {
                let (own, other) = (format!("{operator}/F2/x{suffix}"), format!("{operator}/F1/x"));
                let sides = |left: Option<Measured>, right: Option<Measured>| {
                    left.zip(right).map(|(left, right)| Observed::Sides { left, right })
                };
                let derived = |name: &str| found.derived(at, name).map(Measured::exactly);
                let derived = if suffix.is_empty() { sides(derived(&own), derived(&other)) } else { None };
                let measured = sides(found.measured(at, &own), found.measured(at, &other));
                let more = [("operator", text(operator)), ("normalised by", text(reading))];
                let case = found.case(lattice, Some(at.eta), &more);
                judge(report, "gradient/quadratic-lower", case, derived, measured, Vec::new());
            }
        }
    }
}

fn conservation(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    /// What rounding makes of a total relative to the sum of its terms' magnitudes.
    const CONSERVED: f64 = 1e-12;
    for (lattice, (_, checks)) in LATTICES.into_iter().zip(&found.checks) {
        let rows = [
            ("gradient/momentum-plus", "G+", false),
            ("gradient/momentum-others", "G0", false),
            ("gradient/momentum-others", "G-", false),
            ("laplacian/angular-MCG", "MCG", true),
            ("laplacian/angular-MEA", "MEA", true),
        ];
        for (id, operator, angular) in rows {
            let said = Conservation::of(&operators::by_id(operator)?.operator()?)?;
            let said = if angular { said.angular } else { said.total };
            let total = if angular { checks.angular.get(operator) } else { checks.linear.get(operator) };
            let total = total.copied().unwrap_or(0.0);
            // The derived side is 1 where what multiplies the field of a particle does not vanish.
            let not = if said == Conserved::Yes { 0.0 } else { 1.0 };
            let floor = Measured::exactly(CONSERVED);
            let (derived, measured) = if id.ends_with("plus") || id.ends_with("MCG") {
                let zero = |largest, floor| Observed::Zero { largest, floor };
                (zero(not, 0.0), zero(total, CONSERVED))
            } else {
                let sides = |left| Observed::Sides { left: Measured::exactly(left), right: floor };
                (sides(not), sides(total))
            };
            let case = found.case(lattice, Some(CHECKED_ETA), &[("operator", text(operator))]);
            judge(report, id, case, Some(derived), Some(measured), Vec::new());
        }
        let [largest, _] = checks.walls;
        let case = found.case(lattice, Some(CHECKED_ETA), &[("operator", text("G0"))]);
        let measured = Some(Observed::Zero { largest, floor: 1e-13 });
        judge(report, "gradient/walls", case, None, measured, Vec::new());
    }
    Ok(())
}

/// G− on a linear field.
#[derive(Serialize)]
struct Floor {
    lattice: &'static str,
    eta: f64,
    measured: Option<f64>,
    derived: Option<f64>,
    lattice_b_inverse_minus_1: Option<f64>,
    share_of_lattice: Option<f64>,
    published_fit_29: f64,
}

fn floors(found: &Results<'_>, report: &mut Report) {
    let mut rows = Vec::new();
    for lattice in LATTICES {
        for eta in std::iter::once(0.0).chain(found.table.eta.iter().copied()) {
            let at = At { eta, ..reference(found, lattice) };
            let regular = found.model(lattice).map(|model| model.component("G-[1]", 0).regular);
            let derived = found.derived(at, "G-/F1/x");
            let share = regular.zip(derived).map(|(r, d)| significant(r * r / (d * d), 4));
            rows.push(table_row(&Floor {
                lattice,
                eta,
                measured: found.rms(at, "G-/F1/x").map(|(y, _)| significant(y, 6)),
                derived: derived.map(|y| significant(y, 6)),
                lattice_b_inverse_minus_1: regular.map(|y| significant(y, 6)),
                share_of_lattice: share,
                published_fit_29: significant(
                    crate::claim::chaussonnet_2015::FITS[4].value(at.h, eta, 1.0),
                    4,
                ),
            }));
        }
    }
    report.tables.insert("g_minus_floor".into(), rows);
}

/// The lines of names along h, η or K_x, measured and derived.
pub(super) fn lines(
    found: &Results<'_>,
    cases: &[At],
    names: &[&str],
    along: Along,
) -> Vec<crate::record::Line> {
    let mut lines = Vec::new();
    for at in cases {
        // Where a lattice comes twice, its disorder tells the lines apart.
        let twice = cases.iter().any(|other| other.lattice == at.lattice && other.eta != at.eta);
        let of = if twice { format!("{}, η = {}", at.lattice, at.eta) } else { at.lattice.to_owned() };
        for name in names {
            let mut all = along.cases(found, *at);
            if along == Along::Eta {
                all.insert(0, (0.0, At { eta: 0.0, ..*at }));
            }
            let measured = all.iter().filter_map(|(x, at)| found.rms(*at, name).map(|(y, e)| (*x, y, e)));
            lines.push(line(format!("{name}, {of}"), measured));
            let derived = all.iter().filter_map(|(x, at)| found.derived(*at, name).map(|y| (*x, y, 0.0)));
            let derived: Vec<_> = derived.collect();
            if !derived.is_empty() {
                lines.push(line(format!("{name}, {of}, derived"), derived.into_iter()));
            }
        }
    }
    lines
}

fn figures(found: &Results<'_>, report: &mut Report) {
    let at = |lattice| reference(found, lattice);
    let strong = At { eta: found.table.largest_eta(), ..at("square") };
    let all = LATTICES.map(at);
    let mut push = |number: &str, along: Along, cases: &[At], names: &[&str]| {
        let (x, unit) = match along {
            Along::H => ("h", "m"),
            Along::Eta => ("η", "1"),
            Along::Scale => ("K_x", "1"),
        };
        let id = format!("chaussonnet-figure-{number}");
        let lines = lines(found, cases, names, along);
        report.series.push(figure(&id, number, axis(x, unit), axis("Λ", "1"), lines));
    };
    let one = ["G0/F1/x", "G+/F1/x", "G-/F1/x"];
    push("6a", Along::Eta, &all[..2], &one);
    push("6b", Along::H, &all, &one);
    let both = ["G0/F1/x", "G0/F1/y", "G+/F1/x", "G+/F1/y", "G-/F1/x", "G-/F1/y"];
    push("7", Along::Scale, &all[..1], &both);
    for (figure, field) in [("8", 0), ("9", 1), ("10", 2)] {
        let names: Vec<String> = GRADIENTS.map(|operator| format!("{operator}/F{field}/x")).to_vec();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let names = if field == 0 { &names[..2] } else { &names[..] };
        push(&format!("{figure}a"), Along::H, &[strong], names);
        push(&format!("{figure}b"), Along::Eta, &all[..1], names);
        push(&format!("{figure}c"), Along::Scale, &all[..1], names);
    }
}
