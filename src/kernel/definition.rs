//! A kernel of one's own, as written in a scene or in a file of its own.

use super::{Kernel, KernelError, catalogue};
use crate::exact::{Piecewise, Polynomial, Radical, Rational, int, parse_rational, rational_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A piecewise polynomial w(q), q = r/h, from q = 0 to R/h, not normalised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KernelDefinition {
    /// The id by which cases name it; in a file of its own, the name of the file if it is left out.
    #[serde(default)]
    pub id: String,
    /// Where it is printed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
    /// Its pieces, from the origin outwards.
    pub pieces: Vec<PieceDefinition>,
    /// Normalisations as printed, for 1-D, 2-D and 3-D, to be audited: `2/3`, `10/(7 pi)`, `1/pi`. They are not used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normalisation: Option<Vec<String>>,
    /// Admit pieces that do not meet.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub allow_jumps: bool,
}

/// One piece: it begins where the one before ends, the first at 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PieceDefinition {
    /// Where it ends, a rational.
    pub to: String,
    /// Its coefficients, rationals, in ascending powers of q.
    pub coefficients: Vec<String>,
}

impl KernelDefinition {
    /// The kernel.
    ///
    /// # Errors
    /// A [`KernelError`] whose [`field`](KernelError::field) is the place at fault.
    pub fn build(&self) -> Result<Kernel, KernelError> {
        let id = self.id.as_str();
        if id.is_empty() || !id.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c)) {
            return Err(KernelError::BadId { id: id.into() });
        }
        if catalogue().iter().any(|known| known.id() == id) {
            return Err(KernelError::Shadows { id: id.into() });
        }
        if self.pieces.is_empty() {
            return Err(KernelError::NoPieces { id: id.into() });
        }
        let number = |text: &str, field: String| {
            parse_rational(text).map_err(|source| KernelError::Number { field, source })
        };
        let (mut knots, mut pieces) = (vec![int(0)], Vec::<Polynomial>::new());
        for (index, piece) in self.pieces.iter().enumerate() {
            let to = number(&piece.to, format!("pieces.{index}.to"))?;
            let from = &knots[index];
            if to <= *from {
                let (from, to) = (rational_text(from), rational_text(&to));
                return Err(KernelError::Knots { piece: index, from, to });
            }
            let coefficients = piece.coefficients.iter().enumerate();
            let coefficients =
                coefficients.map(|(c, text)| number(text, format!("pieces.{index}.coefficients.{c}")));
            let polynomial = Polynomial::new(coefficients.collect::<Result<_, _>>()?);
            if let (Some(before), false) = (pieces.last(), self.allow_jumps) {
                let (left, right) = (before.evaluate(from), polynomial.evaluate(from));
                if left != right {
                    return Err(KernelError::DoNotMeet {
                        piece: index,
                        at: rational_text(from),
                        jump: rational_text(&(&right - &left)),
                        left: rational_text(&left),
                        right: rational_text(&right),
                    });
                }
            }
            knots.push(to);
            pieces.push(polynomial);
        }
        let profile = Piecewise::new(knots, pieces)
            .map_err(|source| KernelError::Number { field: "pieces".into(), source })?;
        let citation = self.citation.as_deref().unwrap_or("own");
        let kernel = Kernel::new(id, id, citation, profile)?;
        let Some(printed) = &self.normalisation else { return Ok(kernel) };
        if printed.len() != 3 {
            return Err(KernelError::Constants { given: printed.len() });
        }
        let mut constants = [const { None }; 3];
        for (index, text) in printed.iter().enumerate() {
            constants[index] = Some(printed_constant(text, index + 1)?);
        }
        Ok(kernel.printed_by(citation, int(1), constants))
    }
}

/// Reads `p/q` in 1-D and `p/(q pi)`, `p/q pi^-1` or `p/pi` in 2-D and 3-D; `π`, `*` and `·` are understood.
fn printed_constant(text: &str, dimension: usize) -> Result<Radical, KernelError> {
    let expected =
        if dimension == 1 { "a rational such as 2/3" } else { "a rational over π, such as 10/(7 pi)" };
    let refuse = || KernelError::Constant { text: text.to_owned(), dimension, expected };
    let plain: String = text.replace('π', "pi").chars().filter(|c| !" ()*·".contains(*c)).collect();
    let rational: Rational = if dimension == 1 {
        parse_rational(&plain).map_err(|_| refuse())?
    } else {
        let rest = match (plain.strip_suffix("pi^-1"), plain.strip_suffix("pi")) {
            (Some(rest), _) => rest,
            (_, Some(rest)) if rest.contains('/') => rest.strip_suffix('/').unwrap_or(rest),
            _ => return Err(refuse()),
        };
        parse_rational(rest).map_err(|_| refuse())?
    };
    Ok(Radical::pi_power(if dimension == 1 { 0 } else { -1 }).scale(&rational))
}
