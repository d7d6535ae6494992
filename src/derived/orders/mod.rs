//! Orders of moment sums, derived: which power of Δ/h, of what amplitude, and why. Nothing is summed over particles.
//!
//! A moment component is a lattice sum of f(r) = Σ_t c_t r^{μ_t} G_{k_t}(r). By Poisson's formula
//!
//! S − continuum limit = Σ_{K≠0} A(K) f̂(K),  A(K) = mean over the basis b of e^{−iK·b},
//!
//! over the reciprocal lattice. f̂ is built from Φ_n\[G_k\], the Fourier transform of a radial function in n dimensions:
//!
//! f̂(K) = i^{|μ|} Σ_j C(μ, j) K^{μ−2j} (−1/2π)^T Φ_{D+2T}\[G_k\](|K|),  T = |μ| − |j|,  C(μ, j) = Π n!/(j! (n−2j)! 2^j),
//!
//! since (1/κ d/dκ) Φ_n = −Φ_{n+2}/2π. With ((1/ρ) d/dρ)^l G_k = G_{k+l}, integration by parts leaves the points where the
//! kernel is not smooth (ν = n/2 − 1, \[·\]_a the value right of the knot ρ_a less that left of it):
//!
//! Φ_n\[G_k\](κ) = (2π)^{n/2} κ^{−ν} Σ_a Σ_l (−1)^{l+1} κ^{−l−1} \[G_{k+l}\]_a ρ_a^{ν+1+l} J_{ν+1+l}(κρ_a) + origin,
//!
//! and each odd power w_s r^s at the origin adds a power of κ alone. In Δ/h:
//!
//! | source | exponent | |
//! | --- | --- | --- |
//! | r^s at the origin, s odd | D + s + p − q | does not oscillate |
//! | knot, lowest jump in the m-th derivative | (D + 1)/2 + max(m − q, 0), and all whole numbers above | oscillates |
//!
//! The maximum stands there because lattice sums leave out the delta functions that ∇^q W has at a knot where m < q. In one
//! and three dimensions the series of a knot ends, as that of its Bessel functions does.
//!
//! - `singular`: where a kernel is not smooth, exactly.
//! - `tail`: what each such point leaves of a component, as exact polynomials in K/|K|.
//! - `epstein`: the amplitude of an origin term, Σ' x^μ |x|^e continued analytically.
//! - `spheres`: the reciprocal lattice by shells.
//! - `oscillation`: sums over shells, their bounds and extremes.
//! - `regular`, `series`: [`RegularOrder`], its terms and its values.
//! - `disorder`: [`DisorderOrder`].
//! - `coefficient`: [`CoefficientOrder`], of operators.

mod coefficient;
mod disorder;
mod epstein;
mod oscillation;
mod regular;
mod series;
mod singular;
mod spheres;
mod tail;

pub use coefficient::CoefficientOrder;
pub use disorder::{DisorderOrder, DisorderTerm, Displaced};
pub use regular::{Amplitude, ComponentOrder, Contribution, RegularOrder, Source, Term};
pub use series::{Crossing, Deviation, Envelope};
