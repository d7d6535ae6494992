//! Published statements as data, and the verdicts on them.
//!
//! A claim names a moment sum or a coefficient of an operator's expansion, a quantity made of it and, for power laws, the exponents over the basis (d̃, h, Δ/h) as
//! rationals in β. A new paper is one file here and one line in [`catalogue`]; a new claim is one entry in its paper's
//! file, or one in a scene.

mod assertion;
pub mod basa_2009;
pub mod chaussonnet_2015;
mod compare;
mod error;
mod exponents;
mod fatehi_heat;
mod fatehi_manzari_2011;
mod known;
mod literature;
mod printed;
mod rollup;
mod verdict;

pub use assertion::{Assertion, Direction, Observed, Published, Sign, Variable};
pub use compare::{Comparison, Judgement, Measured, compare_exponent, judge_convergence, judge_power_law};
pub use error::ClaimError;
pub use exponents::{BetaExponent, Powers};
pub use fatehi_heat::HeatStatement;
pub use known::{Known, known};
pub use literature::{Paper, literature};
pub use printed::{PrintedCoefficient, printed_coefficients};
pub use rollup::{CaseVerdict, roll_up};
pub use verdict::Verdict;

use crate::language::Subject;
use crate::names::nearest;

/// What is made of a moment sum or a coefficient S.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// |S^reg| on the unperturbed lattice.
    RegularValue,
    /// |S^reg − continuum limit| on the unperturbed lattice; of a coefficient, |S^reg − what the operator approximates|.
    RegularDeviation,
    /// The root mean square of |S − S^reg| over samples of the disorder.
    DisorderDeviation,
}

impl Quantity {
    /// The name used in scenes.
    pub fn id(self) -> &'static str {
        match self {
            Self::RegularValue => "regular-value",
            Self::RegularDeviation => "regular-deviation",
            Self::DisorderDeviation => "disorder-deviation",
        }
    }

    /// The quantity of this name.
    pub fn by_id(id: &str) -> Option<Self> {
        [Self::RegularValue, Self::RegularDeviation, Self::DisorderDeviation]
            .into_iter()
            .find(|q| q.id() == id)
    }

    /// Whether it is taken on disordered particles.
    pub fn is_disordered(self) -> bool {
        self == Self::DisorderDeviation
    }

    /// As a formula.
    pub fn formula(self, subject: &Subject) -> String {
        let s = subject.formula();
        match self {
            Self::RegularValue => format!("|{s}|"),
            Self::RegularDeviation if subject.coefficient().is_some() => format!("|{s} − target|"),
            Self::RegularDeviation => format!("|{s} − lim|"),
            Self::DisorderDeviation => format!("rms |{s} − reg|"),
        }
    }
}

/// What a claim states.
#[derive(Debug, Clone, PartialEq)]
pub enum Statement {
    /// The quantity is of the order d̃^a h^b (Δ/h)^c.
    PowerLaw {
        /// The quantity.
        quantity: Quantity,
        /// a, b, c, each a rational in β.
        powers: Box<Powers>,
    },
    /// The moment or coefficient vanishes on regular particles.
    Zero,
    /// The quantity, with d̃ in proportion to Δ, vanishes as Δ → 0 exactly if Δ falls faster than a power of h: that power
    /// is 1 − L/c for S ~ Δ^c h^{L−c}, where S carries the length L.
    Convergence {
        /// The quantity.
        quantity: Quantity,
        /// c, from which the paper concludes.
        rate: BetaExponent,
    },
}

/// κ of "Δ must fall faster than h^κ" for a quantity ~ Δ^rate h^{length − rate}: 1 − length/rate.
pub fn convergence_power(rate: f64, length: i32) -> f64 {
    1.0 - f64::from(length) / rate
}

/// One published statement that can be checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// For example `fatehi-table-2/sum_dw#disorder`.
    pub id: String,
    /// Key in `references.bib`, or `scene`.
    pub source: String,
    /// Equation, table and row.
    pub location: String,
    /// The statement as the paper makes it.
    pub text: String,
    /// The moment sum, or the coefficient of an operator's expansion, that it is about.
    pub subject: Subject,
    /// The statement.
    pub statement: Statement,
    /// The dimensions it is made for.
    pub dimensions: &'static [usize],
}

impl Claim {
    /// What is to be measured for it; a zero is a matter of symmetry first.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.statement {
            Statement::PowerLaw { quantity, .. } | Statement::Convergence { quantity, .. } => Some(quantity),
            Statement::Zero => None,
        }
    }

    /// Whether it needs disordered particles.
    pub fn is_disordered(&self) -> bool {
        self.quantity().is_some_and(Quantity::is_disordered)
    }
}

/// All built-in claims.
pub fn catalogue() -> Vec<Claim> {
    fatehi_manzari_2011::claims()
}

/// The claims that a scene means by `name`: a claim's own id, or the part before a `/`, which stands for all with it.
///
/// # Errors
/// [`ClaimError::Unknown`] with the nearest known name.
pub fn select(name: &str) -> Result<Vec<Claim>, ClaimError> {
    let known = catalogue();
    let group = |claim: &Claim| claim.id.split('/').next().unwrap_or_default().to_owned();
    let chosen: Vec<Claim> =
        known.iter().filter(|claim| claim.id == name || group(claim) == name).cloned().collect();
    if chosen.is_empty() {
        let mut names: Vec<String> =
            known.iter().flat_map(|claim| [claim.id.clone(), group(claim)]).collect();
        names.dedup();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        return Err(ClaimError::Unknown { name: name.to_owned(), nearest: nearest(name, &names) });
    }
    Ok(chosen)
}
