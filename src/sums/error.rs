//! What can be wrong with a request for sums.

use thiserror::Error;

/// Errors of the sums layer.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SumError {
    /// A moment beyond what is enumerated.
    #[error("moment sums are enumerated for p ≤ 6 and q ≤ 2, not for {what}")]
    Moment {
        /// What was asked for.
        what: String,
    },
    /// No moment of this name.
    #[error("there is no moment sum '{name}'{}; names are sum_, p times r, then w, dw, ddw or lapw, and b_inverse", nearest.as_ref().map(|n| format!(" (did you mean '{n}'?)")).unwrap_or_default())]
    UnknownMoment {
        /// The name given.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
    },
    /// A support without neighbours.
    #[error(
        "R/Δ = {support_over_dx} leaves particle i without neighbours on lattice '{lattice}': the nearest is at {nearest} Δ"
    )]
    NoNeighbours {
        /// R/Δ.
        support_over_dx: f64,
        /// The lattice.
        lattice: String,
        /// The distance of the nearest neighbour.
        nearest: f64,
    },
    /// R/Δ is not positive.
    #[error("R/Δ = {support_over_dx} must be finite and positive")]
    Support {
        /// R/Δ as given.
        support_over_dx: String,
    },
    /// The sum would not fit in memory.
    #[error(
        "R/Δ = {support_over_dx} on lattice '{lattice}' needs about {needed_mib} MiB for {sites:.3e} sites, more than the {allowed_mib} MiB allowed: lower R/Δ or raise memory_mib under [limits]"
    )]
    Memory {
        /// R/Δ.
        support_over_dx: f64,
        /// The lattice.
        lattice: String,
        /// Sites in the support.
        sites: f64,
        /// What it would take.
        needed_mib: u64,
        /// What is allowed.
        allowed_mib: u64,
    },
    /// Whole numbers of the lattice that would not fit their types.
    #[error(
        "lattice '{lattice}' has coordinates too fine for exact sums out to R/Δ = {support_over_dx}: lower R/Δ, the \
         order of the moments, or the denominators of its coordinates"
    )]
    TooFine {
        /// R/Δ.
        support_over_dx: f64,
        /// The lattice.
        lattice: String,
    },
    /// ΣW differs between the particles of a cell.
    #[error(
        "the particles of lattice '{lattice}' are not equivalent, so V = 1/ΣW differs between them and exact sums do not \
         apply: use the volume rule 'constant', or a lattice with equivalent particles"
    )]
    UnequalVolumes {
        /// The lattice.
        lattice: String,
    },
    /// ΣW vanishes, so V = 1/ΣW does not exist.
    #[error("ΣW vanishes at R/Δ = {support_over_dx}: V = 1/ΣW does not exist")]
    NoVolume {
        /// R/Δ.
        support_over_dx: f64,
    },
    /// D is not 1, 2 or 3.
    #[error("the dimension is {found}; give 1, 2 or 3")]
    Dimension {
        /// D as given.
        found: usize,
    },
    /// R cannot be used.
    #[error("the support radius is {found:e}; it must be positive, finite and within 1e-150 to 1e150")]
    SupportLength {
        /// R as given.
        found: f64,
    },
    /// A list without one entry for each particle.
    #[error("{what}: there are {found} where {expected} are needed")]
    Length {
        /// Which list.
        what: String,
        /// Its length.
        found: usize,
        /// What its length must be.
        expected: usize,
    },
    /// A number that is not finite, or a coordinate that cannot be squared.
    #[error(
        "particle {particle}: the {what} is {value:e}; remove the particle, or repair the input or its unit"
    )]
    NotFinite {
        /// Which number.
        what: String,
        /// The particle at fault.
        particle: usize,
        /// Its value.
        value: f64,
    },
    /// More particles than can be numbered.
    #[error("there are {found} particles, more than the {most} that one run takes: analyse a part of them")]
    TooManyParticles {
        /// How many were given.
        found: usize,
        /// How many one run takes.
        most: usize,
    },
}
