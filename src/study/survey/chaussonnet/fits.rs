//! The fits (25)–(29), (36), (37) beside measured and derived ones, and what they tell of L and of the origin of ξ.
//!
//! Λ⁰(G0) = s η L/Δ and Ω¹ = t η L/Δ, with s and t derived, so that a fit's value inside its range gives L. Λ¹(G0) has the
//! root mean square of ξ beside it, and (27)/(25) that alone.

use super::gradients::all_points;
use super::model::Model;
use super::power::{FourCoefficients, four_coefficients};
use super::results::{At, Results};
use super::{RULE, TaskError};
use crate::claim::chaussonnet_2015::{FITS, PublishedFit, assertion, assertion_of};
use crate::claim::{Measured, Observed};
use crate::particles::VolumeRule;
use crate::record::{InferredDomainSize, Report, significant};
use crate::study::survey::{entry, table_row};
use serde::Serialize;

pub(super) fn enter(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    coefficients(found, report)?;
    domain_size(found, report);
    origin(found, report);
    Ok(())
}

/// One coefficient of a fit.
#[derive(Serialize)]
struct Row {
    equation: u8,
    quantity: String,
    coefficient: &'static str,
    published: f64,
    measured: f64,
    measured_low: f64,
    measured_high: f64,
    derived_fitted_where_derived: Option<f64>,
    derived_exponent: Option<f64>,
}

fn coefficients(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let mut rows = Vec::new();
    for published in &FITS {
        let name = format!("{}/{}/x", published.operator, published.field);
        let (points, derived_points) =
            (all_points(found, "square", &name, true), all_points(found, "square", &name, false));
        if points.len() < 8 {
            continue;
        }
        let measured = four_coefficients(&points)?;
        let derivable = points.iter().filter(|[_, eta, ..]| Results::is_derived_at(*eta)).count();
        let derived = if derived_points.len() == derivable && derivable >= 8 {
            Some(four_coefficients(&derived_points)?)
        } else {
            None
        };
        let id = |what: &str| format!("chaussonnet-fit-{}/{what}", published.equation);
        let more = [("points", points.len().into())];
        let case = || found.case("square", None, &more);
        for (place, what) in ["h", "eta", "field-scale"].into_iter().enumerate() {
            let number = |fit: &FourCoefficients| Observed::Number(fit.exponents[place]);
            // The coefficient of a law fitted to derived values is what its curvature makes of it: no interval. These values
            // end before the largest η of the published fit, so that they say nothing of its exponent of η.
            let of_derived = |fit: &FourCoefficients| {
                let exponent = fit.exponents[place].value;
                let exponent = if exponent.abs() < 1e-12 { 0.0 } else { exponent };
                Observed::Number(Measured::exactly(exponent))
            };
            let derived = derived.as_ref().filter(|_| what != "eta").map(of_derived);
            let measured = Some(number(&measured));
            report.claims.push(entry(&assertion(&id(what)), case(), derived, measured, Vec::new()));
        }
        let at = middle(found);
        let level = assertion_of(&id("level"), significant(published.value(at.h, at.eta, at.scale), 8));
        let derived_level = found.derived(at, &name).map(|y| Observed::Number(Measured::exactly(y)));
        let measured_level = found.measured(at, &name).map(Observed::Number);
        let more = [("h", format!("h = {:e} m", at.h).into())];
        let case = found.case("square", Some(at.eta), &more);
        report.claims.push(entry(&level, case, derived_level, measured_level, Vec::new()));
        rows.extend(table(published, &measured, derived.as_ref()));
    }
    report.tables.insert("fits".into(), rows);
    windows(found, report)
}

/// The exponent of η in Eq. (29) by the range of η that is fitted.
#[derive(Serialize)]
struct Window {
    eta_from: f64,
    eta_to: f64,
    measured: f64,
    without_the_lattice: Option<f64>,
    published: f64,
}

/// G− on a linear field has a floor, the lattice's own B⁻¹ − I, and grows faster than η where η is large: which exponent a fit
/// gives depends on where it begins.
fn windows(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let points = all_points(found, "square", "G-/F1/x", true);
    let regular = found.model("square").map(|model| model.component("G-[1]", 0).regular);
    let mut rows = Vec::new();
    for from in &found.table.eta[..found.table.eta.len() - 1] {
        let window: Vec<[f64; 4]> = points.iter().copied().filter(|point| point[1] >= *from).collect();
        if window.len() < 8 {
            continue;
        }
        let without: Option<Vec<[f64; 4]>> = regular.map(|regular| {
            let less = |p: &[f64; 4]| [p[0], p[1], p[2], (p[3] * p[3] - regular * regular).max(0.0).sqrt()];
            window.iter().map(less).filter(|point| point[3] > 0.0).collect()
        });
        let without = without.map(|points| four_coefficients(&points)).transpose()?;
        rows.push(table_row(&Window {
            eta_from: *from,
            eta_to: found.table.largest_eta(),
            measured: significant(four_coefficients(&window)?.exponents[1].value, 5),
            without_the_lattice: without.map(|fit| significant(fit.exponents[1].value, 5)),
            published: FITS[4].eta,
        }));
    }
    report.tables.insert("fit_29_by_window".into(), rows);
    Ok(())
}

/// Inside the range of h and η.
fn middle(found: &Results<'_>) -> At {
    let h = found.table.h_m[found.table.h_m.len() / 2];
    let eta = found.table.eta[found.table.eta.len() / 2];
    At { lattice: "square", eta, h, scale: 1.0 }
}

fn table(
    published: &PublishedFit,
    measured: &FourCoefficients,
    derived: Option<&FourCoefficients>,
) -> Vec<crate::study::survey::Row> {
    let error = if published.field.starts_with('F') { "Λ" } else { "Ω" };
    let row = |coefficient, printed: f64, found: Measured, fitted: Option<f64>, power: Option<f64>| {
        table_row(&Row {
            equation: published.equation,
            quantity: format!("{error}_x({}) on {}", published.operator, published.field),
            coefficient,
            published: printed,
            measured: significant(found.value, 6),
            measured_low: significant(found.low, 6),
            measured_high: significant(found.high, 6),
            derived_fitted_where_derived: fitted
                .map(|x| if x.abs() < 1e-12 { 0.0 } else { significant(x, 6) }),
            derived_exponent: power,
        })
    };
    let fitted = |place: usize| derived.map(|fit| fit.exponents[place].value);
    let [h, eta, scale] = measured.exponents;
    let of_h = if published.equation == 29 { 0.0 } else { -1.0 };
    vec![
        row(
            "a1 (m^-a2)",
            published.prefactor,
            measured.prefactor,
            derived.map(|fit| fit.prefactor.value),
            None,
        ),
        row("a2 (h)", published.h, h, fitted(0), Some(of_h)),
        row("a3 (η)", published.eta, eta, fitted(1), Some(1.0)),
        row("a4 (K_x)", published.scale, scale, fitted(2), Some(0.0)),
    ]
}

/// Where ξ = 0 may be, by where the inner particles then stand: from a to b in domain sizes, of h/L.
#[derive(Debug, Clone, Copy)]
struct Origin {
    name: &'static str,
    from: fn(f64) -> f64,
    to: fn(f64) -> f64,
}

const ORIGINS: [Origin; 6] = [
    Origin { name: "corner of the inner region", from: |_| 0.0, to: |_| 1.0 },
    Origin { name: "centre", from: |_| -0.5, to: |_| 0.5 },
    Origin { name: "corner of the fluid, 4h outside", from: |h| 4.0 * h, to: |h| 1.0 + 4.0 * h },
    Origin { name: "corner of the walls, 8h outside", from: |h| 8.0 * h, to: |h| 1.0 + 8.0 * h },
    Origin { name: "corner of the fluid, L between the walls", from: |h| 4.0 * h, to: |h| 1.0 - 4.0 * h },
    Origin { name: "corner of the walls, both layers within L", from: |h| 8.0 * h, to: |h| 1.0 - 8.0 * h },
];

impl Origin {
    /// √⟨ξ²⟩ over an even spread from a to b; `None` where no inner particle is left.
    fn xi_rms(&self, h_over_size: f64) -> Option<f64> {
        let (a, b) = ((self.from)(h_over_size), (self.to)(h_over_size));
        (a < b).then(|| ((a * a + a * b + b * b) / 3.0).sqrt())
    }
}

/// The quantity whose multiple L is: L = value · Δ/(c η), c derived.
fn coefficient(model: Model<'_>, published: &PublishedFit, without_pi: bool) -> f64 {
    match published.operator {
        "G0" => model.gradient_of_one(0),
        "G+" => 2.0 * model.gradient_of_one(0),
        "MCG-pi" if without_pi => model.laplacian_of_x("MCG", 0),
        operator => model.laplacian_of_x(operator, 0),
    }
}

/// Geometric mean and extremes of L over the range of h and η, of K_x = 1 to which the exponents of K_x are symmetric.
fn sizes(found: &Results<'_>, at: impl Fn(f64, f64) -> Option<f64>) -> Option<[f64; 3]> {
    let mut logarithms = Vec::new();
    for h in &found.table.h_m {
        for eta in &found.table.eta {
            logarithms.push(libm::log(at(*h, *eta)?));
        }
    }
    let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
    let low = logarithms.iter().copied().fold(f64::INFINITY, f64::min);
    let high = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some([mean, low, high].map(|x| significant(libm::exp(x), 6)))
}

/// One assumption about the set-up, and the L that follows from a fit.
#[derive(Serialize)]
struct Assumption {
    fit: String,
    assumption: &'static str,
    size_m: Option<f64>,
    low_m: Option<f64>,
    high_m: Option<f64>,
}

fn domain_size(found: &Results<'_>, report: &mut Report) {
    let Some(model) = found.model("square") else { return };
    let per_eta = |h: f64, eta: f64| h / found.table.h_over_dx / eta;
    let mut rows = Vec::new();
    let mut enter = |fit: String, size: Option<[f64; 3]>| {
        if let Some([value_m, low, high]) = size {
            report.inferred_domain_size.push(InferredDomainSize { fit, value_m, low, high });
        }
    };
    let mut direct = Vec::new();
    for published in FITS.iter().filter(|fit| fit.operator != "G-" && fit.field != "F1") {
        let c = coefficient(model, published, false);
        let size = sizes(found, |h, eta| Some(published.value(h, eta, 1.0) * per_eta(h, eta) / c));
        direct.extend(size);
        enter(format!("Eq. ({})", published.equation), size);
    }
    // What lies in all four intervals.
    let low = direct.iter().map(|size| size[1]).fold(0.0, f64::max);
    let high = direct.iter().map(|size| size[2]).fold(f64::INFINITY, f64::min);
    if low <= high {
        let value = significant((low * high).sqrt(), 6);
        enter("Eqs. (25), (26), (36), (37) together".into(), Some([value, low, high]));
    }
    for published in FITS.iter().filter(|fit| fit.operator != "G-" && fit.field == "F1") {
        let c = coefficient(model, published, false);
        for origin in ORIGINS {
            let size = sizes(found, |h, eta| {
                // L √⟨ξ²⟩ is known; the spread of ξ may depend on h/L.
                let product = published.value(h, eta, 1.0) * per_eta(h, eta) / c;
                let mut size = product;
                for _ in 0..200 {
                    let next = product / origin.xi_rms(h / size)?;
                    size = (size * next).sqrt();
                }
                Some(size)
            });
            enter(format!("Eq. ({}), ξ = 0 at the {}", published.equation, origin.name), size);
        }
    }
    let assumptions: [(&str, &str, VolumeRule, bool); 4] = [
        ("as printed, square lattice", "square", RULE, false),
        ("constant volumes", "square", VolumeRule::Constant, false),
        ("MCG without 1/π", "square", RULE, true),
        ("triangular lattice", "hexagonal", RULE, false),
    ];
    for (assumption, lattice, rule, without_pi) in assumptions {
        let Some(model) = found.model_of(lattice, false, rule) else { continue };
        for published in FITS.iter().filter(|fit| fit.operator != "G-" && fit.field != "F1") {
            let c = coefficient(model, published, without_pi);
            let size = sizes(found, |h, eta| Some(published.value(h, eta, 1.0) * per_eta(h, eta) / c));
            rows.push(table_row(&Assumption {
                fit: format!("Eq. ({})", published.equation),
                assumption,
                size_m: size.map(|s| s[0]),
                low_m: size.map(|s| s[1]),
                high_m: size.map(|s| s[2]),
            }));
        }
    }
    report.tables.insert("domain_size_by_assumption".into(), rows);
}

/// √⟨ξ²⟩ from the ratio of two fits at one h, beside what an origin gives.
#[derive(Serialize)]
struct OriginRow {
    ratio: String,
    h_m: f64,
    published: f64,
    published_low: f64,
    published_high: f64,
    inner_corner: Option<f64>,
    centre: Option<f64>,
    fluid_corner: Option<f64>,
    wall_corner: Option<f64>,
    within_walls: Option<f64>,
    layers_within: Option<f64>,
}

fn origin(found: &Results<'_>, report: &mut Report) {
    let mut rows = Vec::new();
    let size = found.table.domain_size_m;
    for (linear, constant) in [(FITS[2], FITS[0]), (FITS[3], FITS[1])] {
        for h in &found.table.h_m {
            let ratios: Vec<f64> = found
                .table
                .eta
                .iter()
                .map(|eta| linear.value(*h, *eta, 1.0) / constant.value(*h, *eta, 1.0))
                .collect();
            let mean = ratios.iter().map(|ratio| libm::log(*ratio)).sum::<f64>() / ratios.len() as f64;
            let by = |place: usize| ORIGINS[place].xi_rms(h / size).map(|xi| significant(xi, 5));
            rows.push(table_row(&OriginRow {
                ratio: format!("({})/({})", linear.equation, constant.equation),
                h_m: *h,
                published: significant(libm::exp(mean), 5),
                published_low: significant(ratios.iter().copied().fold(f64::INFINITY, f64::min), 5),
                published_high: significant(ratios.iter().copied().fold(0.0, f64::max), 5),
                inner_corner: by(0),
                centre: by(1),
                fluid_corner: by(2),
                wall_corner: by(3),
                within_walls: by(4),
                layers_within: by(5),
            }));
        }
    }
    report.tables.insert("origin_of_xi".into(), rows);
}
