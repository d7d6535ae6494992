//! The five verdicts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What the comparison of the columns says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It holds as printed, and is sharp.
    Confirmed,
    /// It holds as an upper bound but is not sharp.
    Bound,
    /// It does not hold.
    Refuted,
    /// It holds for some cases and not for others; `why` says which.
    Conditional,
    /// The evidence does not decide; `why` says what is missing.
    Inconclusive,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Confirmed => "confirmed",
            Self::Bound => "bound",
            Self::Refuted => "refuted",
            Self::Conditional => "conditional",
            Self::Inconclusive => "inconclusive",
        })
    }
}
