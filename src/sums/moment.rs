//! Moment sums and their components.
//!
//! M = Σ_j ω_j r_ij⊗…⊗r_ij (p times) ∇^q W_ij, r_ij = r_i − r_j, ∇ with respect to r_i, j = i included. Its components are
//! named by the p position indices, sorted, then the q derivative indices, sorted; each independent one once.

use super::SumError;
use crate::exact::MultiIndex;
use crate::kernel::SummandTerm;
use crate::names::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The highest p of a moment.
pub const MAX_POSITIONS: u8 = 6;
/// The highest q of a moment.
pub const MAX_DERIVATIVES: u8 = 2;

/// Which moment sum; the default is Σ ω W.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Moment {
    /// p, the number of position vectors.
    p: u8,
    /// q, the number of derivatives.
    q: u8,
    /// Whether the two derivatives are contracted: ∇·∇W in place of ∇∇W.
    contracted: bool,
    /// Whether the sign is turned: B⁻¹ = −Σ ω r ∇W.
    negated: bool,
}

/// One component of a moment: its name and its summand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// `""`, `x`, `xx`, `xxxy`: position indices, then derivative indices.
    pub name: String,
    /// In how many places of the full tensor this value stands (a Frobenius norm counts each).
    pub multiplicity: u64,
    /// The summand, Σ_t c_t r^{μ_t} G_{k_t}.
    pub terms: Vec<SummandTerm>,
}

impl Moment {
    /// Σ ω r^{⊗p} ∇^q W.
    ///
    /// # Errors
    /// [`SumError::Moment`] if p > 6 or q > 2.
    pub fn new(p: u8, q: u8) -> Result<Self, SumError> {
        if p > MAX_POSITIONS || q > MAX_DERIVATIVES {
            return Err(SumError::Moment { what: format!("p = {p}, q = {q}") });
        }
        Ok(Self { p, q, contracted: false, negated: false })
    }

    /// B⁻¹ = −Σ ω r ∇W (Fatehi & Manzari 2011, Eq. 6).
    pub fn b_inverse() -> Self {
        Self { p: 1, q: 1, contracted: false, negated: true }
    }

    /// Σ ω r^{⊗p} ∇·∇W.
    ///
    /// # Errors
    /// [`SumError::Moment`] if p > 6.
    pub fn laplacian(p: u8) -> Result<Self, SumError> {
        Ok(Self { contracted: true, ..Self::new(p, 2)? })
    }

    /// All moments with p ≤ `max_p`, in the order p, q, then the contracted ones.
    pub fn all(max_p: u8) -> Vec<Self> {
        let max_p = max_p.min(MAX_POSITIONS);
        let plain = (0..=max_p).flat_map(|p| (0..=MAX_DERIVATIVES).map(move |q| (p, q)));
        let plain = plain.map(|(p, q)| match (p, q) {
            (1, 1) => Self::b_inverse(),
            _ => Self { p, q, contracted: false, negated: false },
        });
        plain.chain((0..=max_p).map(|p| Self { p, q: 2, contracted: true, negated: false })).collect()
    }

    /// The name used in scenes and reports: `sum_w`, `sum_dw`, `b_inverse`, `sum_rrdw`, `sum_lapw`, ….
    pub fn name(self) -> String {
        if self.negated {
            return "b_inverse".into();
        }
        let derivative = match (self.contracted, self.q) {
            (true, _) => "lap",
            (_, 0) => "",
            (_, 1) => "d",
            _ => "dd",
        };
        format!("sum_{}{derivative}w", "r".repeat(usize::from(self.p)))
    }

    /// The moment of this name.
    ///
    /// # Errors
    /// [`SumError::UnknownMoment`] with the nearest known name.
    ///
    /// # Examples
    /// ```
    /// use remainder::sums::Moment;
    /// let moment = Moment::by_name("sum_rrdw").unwrap();
    /// assert_eq!((moment.positions(), moment.derivatives()), (2, 1));
    /// ```
    pub fn by_name(name: &str) -> Result<Self, SumError> {
        let all = Self::all(MAX_POSITIONS);
        let names: Vec<String> = all.iter().map(|moment| moment.name()).collect();
        names.iter().position(|known| known == name).map(|index| all[index]).ok_or_else(|| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            SumError::UnknownMoment { name: name.to_owned(), nearest: nearest(name, &names) }
        })
    }

    /// p.
    pub fn positions(self) -> u8 {
        self.p
    }

    /// q.
    pub fn derivatives(self) -> u8 {
        self.q
    }

    /// The power of a length that the moment carries, p − q.
    pub fn length_power(self) -> i32 {
        i32::from(self.p) - i32::from(self.q)
    }

    /// As the papers print it.
    pub fn formula(self) -> String {
        if self.negated {
            return "B⁻¹".into();
        }
        let derivative = match (self.contracted, self.q) {
            (true, _) => "∇·∇",
            (_, 0) => "",
            (_, 1) => "∇",
            _ => "∇∇",
        };
        format!("Σω{}{derivative}W", "r".repeat(usize::from(self.p)))
    }

    /// The components in `dimension` dimensions, position indices in rising order, then derivative indices.
    ///
    /// ∂_a W = r_a G_1 and ∂_a∂_b W = δ_ab G_1 + r_a r_b G_2.
    pub fn components(self, dimension: usize) -> Vec<Component> {
        let sign = if self.negated { -1 } else { 1 };
        let term =
            |coefficient, monomial, radial| SummandTerm { coefficient: sign * coefficient, monomial, radial };
        let positions = indices(dimension, self.p);
        let derivatives =
            if self.contracted { vec![MultiIndex::default()] } else { indices(dimension, self.q) };
        let mut components = Vec::new();
        for position in &positions {
            for derivative in &derivatives {
                let both = add(*position, *derivative);
                let terms = match (self.contracted, self.q) {
                    (true, _) => {
                        let squares = (0..dimension).map(|a| {
                            let mut square = *position;
                            square.powers[a] += 2;
                            term(1, square, 2)
                        });
                        std::iter::once(term(dimension as i64, *position, 1)).chain(squares).collect()
                    }
                    (_, 2) if derivative.powers.contains(&2) => vec![term(1, *position, 1), term(1, both, 2)],
                    (_, q) => vec![term(1, both, usize::from(q))],
                };
                components.push(Component {
                    name: format!("{}{}", position.letters(), derivative.letters()),
                    multiplicity: small(position) * small(derivative),
                    terms,
                });
            }
        }
        components
    }
}

/// The independent index sets of a symmetric tensor of this rank; none for a dimension that does not exist.
fn indices(dimension: usize, rank: u8) -> Vec<MultiIndex> {
    MultiIndex::all(dimension, rank).unwrap_or_default()
}

/// α + β for the small orders that occur here.
fn add(a: MultiIndex, b: MultiIndex) -> MultiIndex {
    MultiIndex::new(std::array::from_fn(|axis| a.powers[axis] + b.powers[axis]))
}

/// |α|!/α! for the small orders that occur here.
fn small(index: &MultiIndex) -> u64 {
    u64::try_from(index.multiplicity()).unwrap_or(u64::MAX)
}

impl fmt::Display for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

impl From<Moment> for String {
    fn from(moment: Moment) -> Self {
        moment.name()
    }
}

impl TryFrom<String> for Moment {
    type Error = SumError;
    fn try_from(name: String) -> Result<Self, SumError> {
        Self::by_name(&name)
    }
}
