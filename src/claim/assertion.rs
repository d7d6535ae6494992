//! Published statements about numbers that a survey takes: constants, ratios, single exponents, trends, inequalities.
//!
//! Each is judged by the same equivalence test as power laws: an interval decides if it lies wholly on one side.

use super::{Comparison, Judgement, Measured, Verdict, compare_exponent};

/// One published statement, typed in once beside its citation.
#[derive(Debug, Clone, PartialEq)]
pub struct Assertion {
    /// For example `chaussonnet-fit-25/h`.
    pub id: String,
    /// Key in `references.bib`.
    pub source: &'static str,
    /// Equation, figure, section.
    pub location: String,
    /// The statement as the paper makes it.
    pub text: String,
    /// What it states.
    pub published: Published,
}

/// What a power is a power of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// d̃, η or ε: the amplitude of the displacement.
    Displacement,
    /// h.
    H,
    /// Δ/h.
    DxOverH,
    /// Δ at constant h/Δ.
    Dx,
    /// The time step.
    Dt,
}

impl Variable {
    /// As a letter.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Displacement => "d̃",
            Self::H => "h",
            Self::DxOverH => "Δ/h",
            Self::Dx => "Δ",
            Self::Dt => "Δt",
        }
    }
}

/// Whether something rises, falls or stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// It grows with what it is held against.
    Rising,
    /// It shrinks.
    Falling,
    /// Its slope is within the margin of zero.
    Constant,
}

/// How two sides stand to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// The left side is smaller.
    Less,
    /// The left side is larger.
    Greater,
    /// They are equal within a relative margin of 5 %.
    Equal,
}

/// What a statement says.
#[derive(Debug, Clone, PartialEq)]
pub enum Published {
    /// A quantity has a value.
    Constant {
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Relative margin.
        margin: f64,
    },
    /// Two quantities stand in a ratio.
    Ratio {
        /// The ratio.
        value: f64,
        /// Relative margin.
        margin: f64,
    },
    /// A quantity follows a power.
    Exponent {
        /// Of what.
        of: Variable,
        /// The exponent.
        value: f64,
        /// Absolute margin.
        margin: f64,
    },
    /// A quantity is O(xᵖ) as x → 0: true, but no more than a bound, if it falls faster.
    Order {
        /// Of what.
        of: Variable,
        /// p.
        value: f64,
        /// Absolute margin.
        margin: f64,
    },
    /// A quantity vanishes.
    Zero,
    /// Something happens in none of the values looked at.
    Never,
    /// A quantity rises, falls or stays.
    Trend {
        /// The quantity.
        of: &'static str,
        /// What it depends on.
        against: &'static str,
        /// How.
        direction: Direction,
        /// Slopes within ± this are none.
        margin: f64,
    },
    /// One quantity is smaller or larger than another, or equal to it.
    Relation {
        /// Left side in words.
        left: &'static str,
        /// How it stands.
        sign: Sign,
        /// Right side in words.
        right: &'static str,
    },
}

/// What was derived or measured for a statement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observed {
    /// A constant, a ratio, an exponent or a trend's slope.
    Number(Measured),
    /// Of a zero.
    Zero {
        /// The largest magnitude found.
        largest: f64,
        /// Up to which magnitude rounding explains it; 0 where it vanishes exactly.
        floor: f64,
    },
    /// How often it happens after all.
    Exceptions {
        /// In so many values,
        count: usize,
        /// of so many.
        among: usize,
    },
    /// Both sides of a relation.
    Sides {
        /// Left.
        left: Measured,
        /// Right.
        right: Measured,
    },
}

impl Published {
    /// The verdict on what was observed. An observation of another kind decides nothing.
    pub fn judge(&self, observed: &Observed) -> Judgement {
        let (verdict, why) = match (self, observed) {
            (Self::Constant { value, unit, margin }, Observed::Number(found)) => {
                let unit = if *unit == "1" { String::new() } else { format!(" {unit}") };
                equals(*value, *found, margin * value.abs(), &unit)
            }
            (Self::Ratio { value, margin }, Observed::Number(found)) => {
                equals(*value, *found, margin * value.abs(), "")
            }
            (Self::Exponent { of, value, margin }, Observed::Number(found)) => {
                equals(*value, *found, *margin, &format!(" as exponent of {}", of.symbol()))
            }
            (Self::Order { of, value, margin }, Observed::Number(found)) => {
                let (verdict, why) =
                    equals(*value, *found, *margin, &format!(" as order in {}", of.symbol()));
                match compare_exponent(*value, *found, *margin) {
                    Comparison::Larger => (Verdict::Bound, why),
                    _ => (verdict, why),
                }
            }
            (Self::Zero, Observed::Zero { largest, floor }) => {
                if largest <= floor {
                    let how = if *floor == 0.0 {
                        "exactly".to_owned()
                    } else {
                        format!("up to rounding ({floor:.1e})")
                    };
                    (Verdict::Confirmed, format!("vanishes {how}"))
                } else {
                    (
                        Verdict::Refuted,
                        format!("reaches {largest:.3e}, above what rounding explains ({floor:.1e})"),
                    )
                }
            }
            (Self::Never, Observed::Exceptions { count, among }) => match (count, among) {
                (_, 0) => (Verdict::Inconclusive, "there was no value to look at".to_owned()),
                (0, _) => (Verdict::Confirmed, format!("no exception among {among} values")),
                _ => (Verdict::Refuted, format!("{count} of {among} values are exceptions")),
            },
            (Self::Trend { direction, margin, .. }, Observed::Number(slope)) => {
                trend(*direction, *slope, *margin)
            }
            (Self::Relation { left, sign, right }, Observed::Sides { left: first, right: second }) => {
                let (verdict, ending) = relation(*sign, *first, *second);
                let text = format!("{left}: {}, {right}: {}", shown(*first), shown(*second));
                (verdict, format!("{text}{ending}"))
            }
            _ => (Verdict::Inconclusive, "nothing of the kind was found".to_owned()),
        };
        Judgement { verdict, why: format!("{why}.") }
    }
}

fn shown(found: Measured) -> String {
    if found.low == found.high {
        number(found.value)
    } else {
        format!("{} [{}, {}]", number(found.value), number(found.low), number(found.high))
    }
}

/// Four decimals, or four digits of what these would not show.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-2..1e5).contains(&value.abs()) {
        format!("{value:.4}")
    } else {
        format!("{value:.3e}")
    }
}

fn equals(published: f64, found: Measured, margin: f64, unit: &str) -> (Verdict, String) {
    let compared = compare_exponent(published, found, margin);
    // What is printed has six digits at most.
    let printed = (published * 1e6).round() / 1e6;
    let text = format!("{}{unit} where {printed} is published", shown(found));
    match compared {
        Comparison::Equal => (Verdict::Confirmed, format!("{text}: equal within ±{margin:.3}")),
        Comparison::Larger => (Verdict::Refuted, format!("{text}: larger")),
        Comparison::Smaller => (Verdict::Refuted, format!("{text}: smaller")),
        Comparison::Undecided => {
            (Verdict::Inconclusive, format!("{text}: the interval crosses ±{margin:.3}"))
        }
    }
}

fn trend(direction: Direction, slope: Measured, margin: f64) -> (Verdict, String) {
    let compared = compare_exponent(0.0, slope, margin);
    let found = match compared {
        Comparison::Equal => Direction::Constant,
        Comparison::Larger => Direction::Rising,
        Comparison::Smaller => Direction::Falling,
        Comparison::Undecided => {
            let why = format!("slope {}: the interval crosses ±{margin:.3}", shown(slope));
            return (Verdict::Inconclusive, why);
        }
    };
    let word = |direction| match direction {
        Direction::Rising => "rises",
        Direction::Falling => "falls",
        Direction::Constant => "stays",
    };
    let verdict = if found == direction { Verdict::Confirmed } else { Verdict::Refuted };
    (verdict, format!("it {} (slope {})", word(found), shown(slope)))
}

/// The verdict, and what is to be said beside both values.
fn relation(sign: Sign, left: Measured, right: Measured) -> (Verdict, &'static str) {
    let margin = match sign {
        Sign::Equal => 0.05 * left.value.abs().max(right.value.abs()),
        Sign::Less | Sign::Greater => 0.0,
    };
    let difference =
        Measured { value: left.value - right.value, low: left.low - right.high, high: left.high - right.low };
    let found = if difference.low == 0.0 && difference.high == 0.0 {
        Comparison::Equal
    } else {
        compare_exponent(0.0, difference, margin)
    };
    let holds = match (sign, found) {
        (_, Comparison::Undecided) => None,
        (Sign::Less, found) => Some(found == Comparison::Smaller),
        (Sign::Greater, found) => Some(found == Comparison::Larger),
        (Sign::Equal, found) => Some(found == Comparison::Equal),
    };
    match holds {
        Some(true) => (Verdict::Confirmed, ""),
        Some(false) => (Verdict::Refuted, ""),
        None => (Verdict::Inconclusive, "; the intervals overlap"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(value: f64, half: f64) -> Measured {
        Measured { value, low: value - half, high: value + half }
    }

    #[test]
    fn each_kind_is_confirmed_refuted_and_left_open() {
        use Verdict::{Confirmed, Inconclusive, Refuted};
        let number = |value, half| Observed::Number(around(value, half));
        let ratio = Published::Ratio { value: 2.0, margin: 0.05 };
        assert_eq!(
            [number(2.01, 0.02), number(3.0, 0.02), number(2.08, 0.05)].map(|o| ratio.judge(&o).verdict),
            [Confirmed, Refuted, Inconclusive]
        );
        let power = Published::Exponent { of: Variable::H, value: -1.0, margin: 0.1 };
        assert_eq!(
            [number(-1.05, 0.02), number(-0.8, 0.02), number(-0.9, 0.02)].map(|o| power.judge(&o).verdict),
            [Confirmed, Refuted, Inconclusive]
        );
        let order = Published::Order { of: Variable::DxOverH, value: 3.0, margin: 0.25 };
        assert_eq!(
            [number(3.1, 0.1), number(3.5, 0.1), number(1.5, 0.1), number(3.25, 0.1)]
                .map(|o| order.judge(&o).verdict),
            [Confirmed, Verdict::Bound, Refuted, Inconclusive]
        );
        let falling = |direction| Published::Trend { of: "E", against: "h", direction, margin: 0.1 };
        assert_eq!(falling(Direction::Falling).judge(&number(-1.0, 0.2)).verdict, Confirmed);
        assert_eq!(falling(Direction::Constant).judge(&number(-1.0, 0.2)).verdict, Refuted);
        assert_eq!(falling(Direction::Constant).judge(&number(0.0, 0.05)).verdict, Confirmed);
        assert_eq!(falling(Direction::Rising).judge(&number(0.1, 0.05)).verdict, Inconclusive);
        let less = Published::Relation { left: "a", sign: Sign::Less, right: "b" };
        let sides = |a, b| Observed::Sides { left: around(a, 0.1), right: around(b, 0.1) };
        assert_eq!(
            [sides(1.0, 2.0), sides(2.0, 1.0), sides(1.0, 1.1)].map(|o| less.judge(&o).verdict),
            [Confirmed, Refuted, Inconclusive]
        );
        let zero = |largest, floor| Published::Zero.judge(&Observed::Zero { largest, floor }).verdict;
        assert_eq!([zero(0.0, 0.0), zero(1e-17, 1e-16), zero(1e-3, 1e-16)], [Confirmed, Confirmed, Refuted]);
        let never = |count, among| Published::Never.judge(&Observed::Exceptions { count, among }).verdict;
        assert_eq!([never(0, 9), never(1, 9), never(0, 0)], [Confirmed, Refuted, Inconclusive]);
    }

    #[test]
    fn what_is_exactly_equal_is_not_less() {
        let one = Measured::exactly(1.0);
        let less = Published::Relation { left: "a", sign: Sign::Less, right: "b" };
        assert_eq!(less.judge(&Observed::Sides { left: one, right: one }).verdict, Verdict::Refuted);
    }
}
