//! What an order is stated of: a moment sum, or what an operator's expansion multiplies ∇^m u by.

use super::operators;
use super::target::Target;
use super::tree::{Field, Operator};
use super::{LanguageError, tree::Kind};
use crate::particles::{Lattice, PointGroup};
use crate::sums::{Moment, Reduction};
use serde::{Serialize, Serializer};
use std::cmp::Ordering;
use std::fmt;
use std::sync::Arc;

/// The coefficient C_m of ∇^m u in an operator's expansion, ⟨Lu⟩ = Σ_m C_m ⋮ ∇^m u.
#[derive(Debug, Clone)]
pub struct Coefficient {
    id: String,
    order: u8,
    operator: Arc<Operator>,
    target: Option<Target>,
}

impl Coefficient {
    /// Of an operator named by its id, or given as text.
    ///
    /// # Errors
    /// [`LanguageError`] if it is neither.
    pub fn new(operator: &str, order: u8) -> Result<Self, LanguageError> {
        if let Ok(entry) = operators::by_id(operator) {
            let tree = Arc::new(entry.operator()?);
            return Ok(Self { id: entry.id.into(), order, operator: tree, target: Some(entry.target) });
        }
        let tree = Operator::parse(operator).map_err(|error| match operators::by_id(operator) {
            // One word is meant as a name.
            Err(unknown) if operator.chars().all(|c| c.is_alphanumeric() || "+-".contains(c)) => {
                LanguageError::new(0..operator.len(), unknown.to_string())
            }
            _ => error,
        })?;
        let target = Target::inferred(&tree);
        Ok(Self { id: operator.to_owned(), order, operator: Arc::new(tree), target })
    }

    /// The operator's id, or its text.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// m.
    pub fn order(&self) -> u8 {
        self.order
    }

    /// The operator.
    pub fn operator(&self) -> &Operator {
        &self.operator
    }

    /// What it approximates, if that is known.
    pub fn target(&self) -> Option<&Target> {
        self.target.as_ref()
    }

    /// Whether it sums over the neighbours of neighbours.
    pub fn is_nested(&self) -> bool {
        let reaches = |kind: &Kind| match kind {
            Kind::Sum { centre, .. } => *centre != 0,
            Kind::Renormalisation(p) | Kind::RenormalisationHat(p) => *p != 0,
            _ => false,
        };
        self.operator.root.any(&reaches)
    }

    /// Whether inversion at the site makes it vanish on regular particles: as many indices as an odd tensor has.
    fn vanishes(&self, group: &PointGroup) -> bool {
        let own = u8::from(self.operator.field == Field::Vector);
        group.has_inversion() && (self.operator.rank() + self.order + own) % 2 == 1
    }
}

/// What an order is stated of.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A moment sum.
    Moment(Moment),
    /// A coefficient of an operator's expansion.
    Coefficient(Coefficient),
}

impl Subject {
    /// The name used in reports: `sum_dw`, `F4[2]`.
    pub fn name(&self) -> String {
        match self {
            Self::Moment(moment) => moment.name(),
            Self::Coefficient(coefficient) => format!("{}[{}]", coefficient.id, coefficient.order),
        }
    }

    /// As a formula: `Σω∇W`, `C₂(F4)`.
    pub fn formula(&self) -> String {
        match self {
            Self::Moment(moment) => moment.formula(),
            Self::Coefficient(coefficient) => {
                let digit = char::from_u32(0x2080 + u32::from(coefficient.order)).unwrap_or('ₘ');
                format!("C{digit}({})", coefficient.id)
            }
        }
    }

    /// The power of a length that it carries.
    pub fn length_power(&self) -> i32 {
        match self {
            Self::Moment(moment) => moment.length_power(),
            Self::Coefficient(coefficient) => {
                coefficient.operator.root.units.length + i32::from(coefficient.order)
            }
        }
    }

    /// Whether it vanishes on a regular lattice by the symmetry of the site.
    pub fn vanishes(&self, lattice: &Lattice, group: &PointGroup) -> bool {
        match self {
            Self::Moment(moment) => Reduction::of(*moment, lattice, group).vanishes(),
            Self::Coefficient(coefficient) => coefficient.vanishes(group),
        }
    }

    /// The moment sum, if it is one.
    pub fn moment(&self) -> Option<Moment> {
        match self {
            Self::Moment(moment) => Some(*moment),
            Self::Coefficient(_) => None,
        }
    }

    /// The coefficient, if it is one.
    pub fn coefficient(&self) -> Option<&Coefficient> {
        match self {
            Self::Moment(_) => None,
            Self::Coefficient(coefficient) => Some(coefficient),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

/// By name: that tells them apart.
impl Serialize for Subject {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

impl PartialEq for Coefficient {
    fn eq(&self, other: &Self) -> bool {
        (&self.id, self.order) == (&other.id, other.order)
    }
}

impl Eq for Coefficient {}

impl PartialOrd for Coefficient {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Coefficient {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.id, self.order).cmp(&(&other.id, other.order))
    }
}
