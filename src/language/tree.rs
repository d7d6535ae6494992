//! The typed tree of an operator. Evaluators and the expansion read this and nothing else.

use crate::exact::Rational;
use std::ops::Range;

/// A particle of an operator: 0 is i, the others are bound by sums.
pub type Particle = usize;

/// Which field an operator acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Field {
    /// u, a scalar.
    Scalar,
    /// v, a vector.
    Vector,
}

impl Field {
    /// Rank of its value: 0 or 1.
    pub fn rank(self) -> u8 {
        u8::from(self == Self::Vector)
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "u",
            Self::Vector => "v",
        }
    }
}

/// A number that every particle carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum OfParticle {
    /// V, the volume (ω of Fatehi & Manzari).
    Volume,
    /// ρ.
    Density,
    /// m.
    Mass,
    /// μ, the dynamic viscosity.
    Viscosity,
}

/// What belongs to a pair p, q. Ranks 1, 0, 1, 0, 1, 2, 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum OfPair {
    /// r_pq = r_p − r_q.
    Separation,
    /// |r_pq|.
    Distance,
    /// e_pq = r_pq / |r_pq|; 0 where the particles are one.
    Direction,
    /// W_pq.
    Kernel,
    /// ∇W_pq, with respect to r_p.
    Gradient,
    /// ∇∇W_pq.
    Hessian,
    /// ∇·∇W_pq.
    Laplacian,
}

/// Exponents of what a quantity is measured in, the field's own unit left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Units {
    /// Of a length.
    pub length: i32,
    /// Of a length to the power D.
    pub volume: i32,
    /// Of a mass.
    pub mass: i32,
    /// Of a viscosity.
    pub viscosity: i32,
}

impl Units {
    pub(super) fn times(self, other: Self, power: i32) -> Self {
        Self {
            length: self.length + power * other.length,
            volume: self.volume + power * other.volume,
            mass: self.mass + power * other.mass,
            viscosity: self.viscosity + power * other.viscosity,
        }
    }
}

/// A node of the tree: a tensor field of the particles that are bound where it stands.
///
/// Index order of every product: left operand's indices, then the right one's.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What it is.
    pub kind: Kind,
    /// Rank of its value, the field's own index counted.
    pub rank: u8,
    /// Whether it is linear in the field, or free of it.
    pub linear: bool,
    /// What it is measured in.
    pub units: Units,
    /// Its bytes in the text.
    pub span: Range<usize>,
}

/// The kinds of nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A rational constant.
    Number(Rational),
    /// π.
    Pi,
    /// D.
    Dimension,
    /// h.
    SmoothingLength,
    /// I, the unit tensor of rank 2.
    Identity,
    /// u_p or v_p.
    Field(Particle),
    /// V_p, ρ_p, m_p, μ_p.
    OfParticle(OfParticle, Particle),
    /// B_p (Fatehi & Manzari 2011, Eq. 6).
    Renormalisation(Particle),
    /// B̂_p (Eq. 40).
    RenormalisationHat(Particle),
    /// r, |r|, e, W and its derivatives of a pair.
    OfPair(OfPair, Particle, Particle),
    /// The sum of operands of one rank.
    Add(Vec<Node>),
    /// −a.
    Negate(Box<Node>),
    /// a ⊗ b.
    Outer(Box<Node>, Box<Node>),
    /// The last `count` indices of a with the first of b, in order.
    Contract(Box<Node>, Box<Node>, u8),
    /// a / b, b a scalar free of the field.
    Divide(Box<Node>, Box<Node>),
    /// a^n of a scalar free of the field.
    Power(Box<Node>, i32),
    /// The inverse of a tensor of rank 2.
    Inverse(Box<Node>),
    /// Σ over the particles in the support of `centre`, the centre among them.
    Sum {
        /// The particle bound.
        bound: Particle,
        /// Whose neighbours.
        centre: Particle,
        /// What is summed.
        body: Box<Node>,
    },
}

/// A checked operator: linear in its field, with particle i alone unbound.
#[derive(Debug, Clone, PartialEq)]
pub struct Operator {
    /// The text it was read from.
    pub text: String,
    /// The field it acts on.
    pub field: Field,
    /// Its value at particle i.
    pub root: Node,
    /// Names of the particles, i first.
    pub particles: Vec<char>,
}

impl Operator {
    /// Rank of its value.
    pub fn rank(&self) -> u8 {
        self.root.rank
    }
}

impl Node {
    /// The nodes directly below.
    pub fn children(&self) -> Vec<&Node> {
        match &self.kind {
            Kind::Add(nodes) => nodes.iter().collect(),
            Kind::Negate(a) | Kind::Power(a, _) | Kind::Inverse(a) => vec![a],
            Kind::Outer(a, b) | Kind::Contract(a, b, _) | Kind::Divide(a, b) => vec![a, b],
            Kind::Sum { body, .. } => vec![body],
            _ => Vec::new(),
        }
    }

    /// Whether `test` holds for this node or one below.
    pub fn any(&self, test: &dyn Fn(&Kind) -> bool) -> bool {
        test(&self.kind) || self.children().into_iter().any(|child| child.any(test))
    }
}
