//! Truncation errors of particle operators: published, derived and measured side by side, with a verdict.
//!
//! ```text
//! scene ─▶ plan ─▶ kernel × particles ─▶ sums ─┬▶ derived  ─┐
//!                                              └▶ measured ─┼▶ verdict ─▶ report
//!                                       claim (published) ──┘
//! ```
//!
//! Each layer uses the ones above it in this list and never one below:
//!
//! | layer | what it holds |
//! | --- | --- |
//! | [`exact`] | rationals, sums of rational × √n × π^k, polynomials, enclosures, orders |
//! | [`kernel`] | radial kernels as exact piecewise polynomials, and all that follows from them |
//! | [`particles`] | lattices, disorder models, volume rules, clouds and neighbours |
//! | [`sums`] | moment sums: exact on lattices, in floating point over pairs |
//! | [`language`] | operators as text: parser, types, catalogue |
//! | [`derived`] | symbolic expansions, proofs of exactness, conservation; orders of moment sums, amplitudes, zero crossings |
//! | [`measured`] | ladders of sums, samples of disorder, fitted power laws |
//! | [`evolve`] | operators as sparse matrices, time integrators, spectra |
//! | [`claim`] | published statements as data, and verdicts |
//! | [`record`] | what `report.json` holds, field by field |
//! | [`study`] | scenes, plans, runs that resume |
//! | [`report`] | one record and its views |
//! | [`cli`] | the command line |
//!
//! # Features
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `cli` (on unless turned off) | [`cli`], the program `remainder`, and `views` |
//! | `views` | pages, figures, LaTeX, CSV and JUnit of a report |
//!
//! Without them (`default-features = false`) everything up to [`study`] and the record itself remain.
//!
//! # Notation
//!
//! | symbol | meaning |
//! | --- | --- |
//! | D | number of space dimensions |
//! | Δ | spacing of the unperturbed lattice: cell edge for cubic lattices, nearest distance for the others |
//! | h, R | smoothing length as its paper defines it; support radius, where W becomes zero |
//! | ω_j | weight (volume) of particle j |
//! | r_ij | r_i − r_j; ∇ is with respect to r_i |
//! | M_{p,q} | Σ_j ω_j r_ij^{⊗p} ∇^q W_ij, j = i included |
//! | B_i | [−Σ_j ω_j r_ij ∇W_ij]⁻¹ |
//! | β | largest integer such that W and its derivatives up to the β-th vanish at R |
//! | d̃ | amplitude of the displacement |
//!
//! # Example
//! ```
//! use remainder::{exact::ratio, kernel, particles::{VolumeRule, lattice_by_id}, sums::{LatticeSums, Moment}};
//!
//! let (kernel, lattice) = (kernel::by_id("wendland-c2").unwrap(), lattice_by_id("line").unwrap());
//! let (support, moment) = (ratio(5, 2), Moment::b_inverse());
//! let sums = LatticeSums::new(&kernel, &lattice, &support, &[moment], 64).unwrap();
//! let component = &moment.components(1)[0];
//! let b_inverse = sums.exact(&support, component, VolumeRule::Constant).unwrap();
//! assert_eq!(b_inverse.to_string(), "2976/3125");
//! ```

pub mod claim;
#[cfg(feature = "cli")]
pub mod cli;
pub mod derived;
pub mod evolve;
pub mod exact;
pub mod kernel;
pub mod language;
pub mod measured;
pub mod names;
pub mod particles;
pub mod record;
pub mod report;
pub mod study;
pub mod sums;
