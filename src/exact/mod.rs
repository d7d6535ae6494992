//! Exact arithmetic: the ground every derived number stands on.
//!
//! This is the lowest layer of the crate and knows nothing of particles or kernels. Two kinds of number live here.
//!
//! - **Exact** numbers: [`Rational`], and [`Radical`], a finite sum of `rational · √n · π^k` kept in a form in which `==` is
//!   mathematical equality. [`Polynomial`], [`Piecewise`] and [`Multivariate`] have rational coefficients.
//! - **Enclosed** numbers: [`Enclosure`], a midpoint and a radius between which the number is proved to lie.
//!
//! [`Coefficient`] holds either kind and stays exact for as long as its operands are. [`Order`], [`Exponent`] and
//! [`Interval`] are what the layers above report.
//!
//! No function of this layer rounds without saying so, and none uses a floating-point number except to hand one out.

mod coefficient;
mod enclosure;
mod error;
mod exponential;
mod float_bounds;
mod linear;
mod multi_index;
mod multivariate;
mod number;
mod order;
mod piecewise;
mod polynomial;
mod radical;
mod rational;
mod roots;

pub use coefficient::{Coefficient, Truth};
pub use enclosure::Enclosure;
pub use error::ExactError;
pub use linear::{Solution, inverse, solve};
pub use multi_index::MultiIndex;
pub use multivariate::Multivariate;
pub use number::Number;
pub use order::{Exponent, Interval, Order};
pub use piecewise::Piecewise;
pub use polynomial::Polynomial;
pub use radical::Radical;
pub use rational::{
    Rational, int, parse_rational, ratio, rational_from_decimal, rational_text, rational_to_f64,
    serde_rational,
};
pub use roots::Stretch;
