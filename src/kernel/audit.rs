//! What can be said about a kernel with certainty: exact where the profile is polynomial, enclosed where it is not.

use super::convention::conventions;
use super::{Kernel, Profile, SummandTerm};
use crate::exact::{Coefficient, MultiIndex, Piecewise, Polynomial, Radical, Rational, Stretch, ratio};
use num_traits::Zero;
use serde::Serialize;
use std::cmp::Ordering;

/// Bits to which what is not rational is located.
const BITS: u32 = 96;
/// Decimals printed of it.
const DECIMALS: u32 = 12;

/// The audit of one kernel. Numbers are exact text where they have a closed form.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Audit {
    /// The id.
    pub id: String,
    /// Its name.
    pub name: String,
    /// Where it is printed.
    pub citation: String,
    /// Whether closed forms exist.
    pub polynomial: bool,
    /// What a reader of its numbers must know.
    pub remark: Option<String>,
    /// R/h.
    pub support_over_h: String,
    /// β.
    pub beta: i64,
    /// The lowest odd power of q at the origin; none if w is even there.
    pub first_odd_power: Option<usize>,
    /// Where w is not smooth: the knot, and the order of the lowest derivative that jumps.
    pub jumps: Vec<(String, Option<usize>)>,
    /// By dimension.
    pub normalisation: Vec<NormalisationAudit>,
    /// Whether w ≥ 0, by Sturm's theorem.
    pub nonnegative: bool,
    /// Where it is not.
    pub negative_between: Vec<(String, String)>,
    /// Whether w never rises with q.
    pub decreasing: bool,
    /// Where it rises; both ends equal for a jump upwards.
    pub rising_between: Vec<(String, String)>,
    /// By dimension: where ∇²W turns positive for good; empty where it does not within the support.
    pub inflections: Vec<Inflection>,
    /// What h means elsewhere.
    pub conventions: Vec<ConventionAudit>,
}

/// σ_D and what follows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NormalisationAudit {
    /// D.
    pub dimension: usize,
    /// σ_D for this profile, lengths in h.
    pub sigma: String,
    /// ∫ W dV over the support: 1 but for a kernel that is normalised over the whole space.
    pub integral: String,
    /// ∫ x² W dV in h².
    pub second_moment: String,
    /// What sources print.
    pub printed: Vec<PrintedAudit>,
}

/// One printed constant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PrintedAudit {
    /// Where.
    pub source: String,
    /// As printed.
    pub printed: String,
    /// What it should be, for the profile as scaled there.
    pub right: String,
    /// Whether they agree.
    pub agrees: bool,
    /// printed/right: what such a kernel integrates to.
    pub integrates_to: f64,
}

/// The distance q* beyond which ∇²W = W″ + (D − 1) W′/r is never negative: in 1-D the inflection
/// point of w.
///
/// Fatehi & Manzari 2011, below Eq. (12), ask for data to stay monotone that the inflection point be
/// farther than the nearest neighbour, q* h > Δ. That is the wrong way round. On a regular line
/// their Eqs. (10) to (12) weigh u_j with ω_j W″(r_ij), j ≠ i. For u_t = ∇²u and small time steps
/// they keep monotone data monotone if and only if no such weight is negative: q* h ≤ Δ. In D
/// dimensions the same holds of ∇²W (no new extrema), whose change of sign lies farther out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inflection {
    /// D.
    pub dimension: usize,
    /// q* = r/h, exact if it is rational.
    pub q: String,
    /// q*.
    pub value: f64,
    /// 1/q*: up to it, no neighbour at Δ or farther is weighed negatively.
    pub greatest_h_over_dx: f64,
    /// The same as R/Δ.
    pub greatest_support_over_dx: f64,
}

/// R/h elsewhere.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConventionAudit {
    /// The code or paper.
    pub who: String,
    /// The dimension, where R/h depends on it.
    pub dimension: Option<usize>,
    /// R/h there.
    pub support_over_h: String,
    /// R/h there.
    pub value: f64,
    /// h/Δ there over h/Δ here, at equal R.
    pub h_factor: f64,
    /// Where it is defined.
    pub source: String,
}

impl Audit {
    /// Audits a kernel.
    pub fn of(kernel: &Kernel) -> Self {
        let shape = match kernel.profile() {
            Profile::Polynomial(profile) => Shape::of(profile),
            // exp(−q²) is positive and falls; ∇² of it, (4q² − 2D) exp(−q²), turns positive at √(D/2), if that is inside.
            Profile::Gaussian { cut } => Shape {
                negative: Vec::new(),
                rising: Vec::new(),
                inflections: [1, 2, 3].map(|dimension| {
                    let square = ratio(dimension, 2);
                    (cut * cut > square)
                        .then(|| Coefficient::from(Radical::sqrt_of(&square).unwrap_or_default()))
                }),
            },
        };
        let support = Coefficient::from(kernel.support_over_h().clone()).to_f64();
        let inflections = shape.inflections.into_iter().zip(1..).filter_map(|(q, dimension)| {
            let q = q?;
            let value = q.to_f64();
            Some(Inflection {
                dimension,
                q: text(&q),
                value,
                greatest_h_over_dx: 1.0 / value,
                greatest_support_over_dx: support / value,
            })
        });
        let inflections = inflections.collect();
        let conventions = conventions(kernel).into_iter().map(|convention| {
            let value = Coefficient::from(convention.support_over_h.clone()).to_f64();
            ConventionAudit {
                who: convention.who.into(),
                dimension: convention.dimension,
                support_over_h: convention.support_over_h.to_string(),
                value,
                h_factor: support / value,
                source: convention.source.into(),
            }
        });
        Self {
            id: kernel.id().into(),
            name: kernel.name().into(),
            citation: kernel.citation().into(),
            polynomial: kernel.polynomial().is_some(),
            remark: kernel.remark(),
            support_over_h: kernel.support_over_h().to_string(),
            beta: kernel.beta(),
            first_odd_power: kernel.first_odd_power(),
            jumps: kernel.jumps().into_iter().map(|jump| (jump.at.to_string(), jump.order)).collect(),
            normalisation: (1..=3).map(|dimension| normalisation(kernel, dimension)).collect(),
            nonnegative: shape.negative.is_empty(),
            negative_between: shape.negative,
            decreasing: shape.rising.is_empty(),
            rising_between: shape.rising,
            inflections,
            conventions: conventions.collect(),
        }
    }

    /// The printed constants that are wrong, with their dimension.
    pub fn misprints(&self) -> impl Iterator<Item = (usize, &PrintedAudit)> {
        let all = self.normalisation.iter().flat_map(|n| n.printed.iter().map(move |p| (n.dimension, p)));
        all.filter(|(_, printed)| !printed.agrees)
    }
}

fn normalisation(kernel: &Kernel, dimension: usize) -> NormalisationAudit {
    let whole = SummandTerm { coefficient: 1, monomial: MultiIndex::default(), radial: 0 };
    let sigma = match kernel.normalisation(dimension) {
        Some(sigma) => Coefficient::from(sigma),
        None => Coefficient::from(kernel.enclose_normalisation(dimension, BITS)),
    };
    let printed = kernel.printed().iter().filter_map(|entry| {
        let printed = Coefficient::from(entry.constants[dimension - 1].clone()?);
        let right = sigma.div(&Coefficient::from(entry.factor.clone())).ok()?;
        Some(PrintedAudit {
            source: entry.source.clone(),
            printed: printed.to_string(),
            right: right.to_string(),
            agrees: printed == right,
            integrates_to: printed.to_f64() / right.to_f64(),
        })
    });
    NormalisationAudit {
        dimension,
        integral: text(&kernel.continuum_limit(dimension, &[whole], BITS)),
        second_moment: text(&kernel.second_moment(dimension, BITS)),
        printed: printed.collect(),
        sigma: text(&sigma),
    }
}

/// Exact text, or twelve decimals of an enclosure.
fn text(value: &Coefficient) -> String {
    match value {
        Coefficient::Enclosed(enclosure) => format!("{}…", enclosure.decimal(DECIMALS).0),
        exact => exact.to_string(),
    }
}

struct Shape {
    negative: Vec<(String, String)>,
    rising: Vec<(String, String)>,
    /// By dimension.
    inflections: [Option<Coefficient>; 3],
}

impl Shape {
    fn of(profile: &Piecewise) -> Self {
        let slope = profile.derivative();
        let mut rising = spans(&stretches(&slope), Ordering::Greater);
        // Jumps upwards at a knot; at the last one, up to zero.
        let knots = profile.knots();
        for (k, piece) in profile.pieces().iter().enumerate() {
            let right =
                profile.pieces().get(k + 1).map_or_else(Rational::zero, |p| p.evaluate(&knots[k + 1]));
            if right > piece.evaluate(&knots[k + 1]) {
                rising.push((knots[k + 1].to_string(), knots[k + 1].to_string()));
            }
        }
        let inflections = [0, 1, 2].map(|more| {
            // q ∇²w = q w″ + (D − 1) w′, where its last negative stretch ends.
            let curvature = slope.derivative().times(&Polynomial::monomial(ratio(1, 1), 1));
            let laplacian = curvature.plus(&slope.scale(&ratio(more, 1)));
            let stretches = stretches(&laplacian);
            let last = stretches.iter().rposition(|stretch| stretch.sign == Ordering::Less)?;
            (last + 1 < stretches.len()).then(|| between(&stretches[last].to))
        });
        Self { negative: spans(&stretches(profile), Ordering::Less), rising, inflections }
    }
}

/// A place known exactly or between bounds.
fn between((low, high): &(Rational, Rational)) -> Coefficient {
    if low == high {
        return Coefficient::from(low.clone());
    }
    // Half the width covers the place; so does an enclosure of the middle widened by it.
    let middle = crate::exact::Enclosure::exact(&((low + high) * ratio(1, 2)), BITS + 8);
    let width = crate::exact::Enclosure::from_parts(0.into(), 1_u32.into(), -i64::from(BITS));
    Coefficient::from(&middle + &width)
}

/// The stretches of constant sign over all pieces.
fn stretches(profile: &Piecewise) -> Vec<Stretch> {
    let ends = profile.knots().windows(2);
    let pieces = profile.pieces().iter().zip(ends);
    pieces.flat_map(|(piece, ends): (&Polynomial, _)| piece.stretches(&ends[0], &ends[1], BITS)).collect()
}

fn spans(stretches: &[Stretch], sign: Ordering) -> Vec<(String, String)> {
    let of_sign = stretches.iter().filter(|stretch| stretch.sign == sign);
    of_sign.map(|stretch| (text(&between(&stretch.from)), text(&between(&stretch.to)))).collect()
}
