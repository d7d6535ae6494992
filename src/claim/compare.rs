//! The comparison of a published with a measured power law.
//!
//! Each exponent goes through an equivalence test: it *equals* the published one if its whole 95 % interval lies within
//! the margin, it is *larger* or *smaller* if the whole interval lies beyond the margin on that side, and else it is
//! *undecided*. The default margin is 1/4: exponents of lattice sums and of sums of independent displacements are
//! multiples of 1/2, so 1/4 is the widest margin that tells two of them apart.
//!
//! A printed order O(d̃^a h^b (Δ/h)^c) is an upper bound for all displacements below the spacing, d̃ = δΔ with δ < 1, and
//! all Δ/h < 1. The measured law divided by the printed one is δ^{a′−a} (Δ/h)^{(a′−a) + (c′−c)}; it stays bounded exactly
//! when both exponents are ≥ 0. So the verdict is `confirmed` if all exponents are equal, `bound` if the ratio stays
//! bounded without that, `refuted` if it does not.

use super::{Verdict, convergence_power};

/// A measured exponent with its 95 % interval, or one that is known without a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The exponent.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Measured {
    /// An exponent known without error.
    pub fn exactly(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// The sum of two exponents; its interval holds whatever lies in both.
    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, low: self.low + other.low, high: self.high + other.high }
    }
}

/// How a measured exponent stands to a published one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// The interval lies within the margin.
    Equal,
    /// The interval lies above the margin.
    Larger,
    /// The interval lies below the margin.
    Smaller,
    /// The interval crosses an end of the margin.
    Undecided,
}

/// The equivalence test.
pub fn compare_exponent(published: f64, measured: Measured, margin: f64) -> Comparison {
    let (low, high) = (published - margin, published + margin);
    if measured.low >= low && measured.high <= high {
        Comparison::Equal
    } else if measured.low > high {
        Comparison::Larger
    } else if measured.high < low {
        Comparison::Smaller
    } else {
        Comparison::Undecided
    }
}

/// A verdict with its reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// One sentence.
    pub why: String,
}

/// Compares the exponents of d̃ and Δ/h (that of h follows from the dimension, which both laws share).
pub fn judge_power_law(published: [f64; 2], measured: [Measured; 2], margin: f64) -> Judgement {
    let names = ["d̃", "Δ/h"];
    let show = |index: usize| {
        let m: Measured = measured[index];
        format!("{} exponent {:.2} [{:.2}, {:.2}]", names[index], m.value, m.low, m.high)
    };
    let each = [0, 1].map(|index| compare_exponent(published[index], measured[index], margin));
    if each == [Comparison::Equal; 2] {
        let shown = if published[0] == 0.0 && measured[0] == Measured::exactly(0.0) {
            show(1)
        } else {
            format!("{} and {}", show(0), show(1))
        };
        let claim = if published[0] == 0.0 {
            format!("{}", published[1])
        } else {
            format!("{} and {}", published[0], published[1])
        };
        return Judgement {
            verdict: Verdict::Confirmed,
            why: format!("{shown} equals the published {claim} within ±{margin}."),
        };
    }
    // The ratio of the measured law to the printed one, δ^first (Δ/h)^second.
    let difference = |index: usize| {
        let m: Measured = measured[index];
        Measured {
            value: m.value - published[index],
            low: m.low - published[index],
            high: m.high - published[index],
        }
    };
    let (first, x) = (difference(0), difference(1));
    let second = first.plus(x);
    let against: Vec<String> = (0..2)
        .filter(|index| each[*index] != Comparison::Equal)
        .map(|index| format!("{} where {} is published", show(index), published[index]))
        .collect();
    let against = against.join("; ");
    let compared = [first, second].map(|exponent| compare_exponent(0.0, exponent, margin));
    let bounded = |c: &Comparison| matches!(c, Comparison::Equal | Comparison::Larger);
    if compared.contains(&Comparison::Smaller) {
        let how = if compared[1] == Comparison::Smaller {
            format!("the sum outgrows the printed order by (h/Δ)^{:.2} at fixed d̃/Δ", -second.value)
        } else {
            format!("the sum outgrows the printed order by (d̃/Δ)^{:.2}", first.value)
        };
        return Judgement { verdict: Verdict::Refuted, why: format!("{against}: {how}.") };
    }
    if compared.iter().all(bounded) {
        return Judgement {
            verdict: Verdict::Bound,
            why: format!("{against}: the printed order holds as an upper bound and is not sharp."),
        };
    }
    Judgement {
        verdict: Verdict::Inconclusive,
        why: format!("{against}: the interval crosses the margin of ±{margin}."),
    }
}

/// Compares the exponent c of Δ at constant h, on which convergence hangs: S ~ Δ^c h^{length − c} falls with Δ exactly if Δ
/// falls faster than h^{1 − length/c}.
pub fn judge_convergence(published: f64, measured: Measured, length: i32, margin: f64) -> Judgement {
    let power = |rate: f64| convergence_power(rate, length);
    let found = format!(
        "Δ must fall faster than h^{:.2} [{:.2}, {:.2}], as it goes like Δ^{:.2} at constant h; h^{:.2} is published",
        power(measured.value),
        power(measured.high).min(power(measured.low)),
        power(measured.high).max(power(measured.low)),
        measured.value,
        power(published),
    );
    let (verdict, so) = match compare_exponent(published, measured, margin) {
        Comparison::Equal => (Verdict::Confirmed, "the same within the margin"),
        Comparison::Larger => (Verdict::Bound, "enough, and more than is needed"),
        Comparison::Smaller => (Verdict::Refuted, "not enough"),
        Comparison::Undecided => (Verdict::Inconclusive, "the interval crosses the margin"),
    };
    Judgement { verdict, why: format!("{found}: {so}.") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(value: f64, half: f64) -> Measured {
        Measured { value, low: value - half, high: value + half }
    }

    #[test]
    fn every_verdict_is_reached_from_both_sides() {
        let judge = |a, c| judge_power_law([1.0, 2.0], [a, c], 0.25).verdict;
        assert_eq!(judge(around(1.0, 0.1), around(2.0, 0.1)), Verdict::Confirmed);
        assert_eq!(judge(around(1.0, 0.1), around(3.0, 0.1)), Verdict::Bound);
        assert_eq!(judge(around(1.0, 0.1), around(1.0, 0.1)), Verdict::Refuted);
        assert_eq!(judge(around(1.0, 0.1), around(2.2, 0.1)), Verdict::Inconclusive);
        // d̃² (Δ/h)^{c−1} is d̃ (Δ/h)^c · δ: bounded; d̃² (Δ/h)^{c−2} is not.
        assert_eq!(judge(around(2.0, 0.1), around(1.0, 0.1)), Verdict::Bound);
        assert_eq!(judge(around(2.0, 0.1), around(0.0, 0.1)), Verdict::Refuted);
        // A weaker power of d̃ outgrows the printed law as d̃/Δ → 0.
        assert_eq!(judge(around(0.0, 0.1), around(9.0, 0.1)), Verdict::Refuted);
    }

    #[test]
    fn an_interval_wider_than_the_margin_decides_nothing() {
        assert_eq!(compare_exponent(2.0, around(2.0, 0.3), 0.25), Comparison::Undecided);
        assert_eq!(compare_exponent(2.0, around(2.0, 0.25), 0.25), Comparison::Equal);
    }
}
