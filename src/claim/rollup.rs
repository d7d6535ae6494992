//! A claim's verdict over all its cases.

use super::{Judgement, Verdict};
use itertools::Itertools;

/// The verdict of one case with the labels that tell it apart, in the order in which a condition is looked for:
/// dimension, disorder, kernel, lattice, volume rule, and whatever else. All cases of a claim have equally many.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseVerdict {
    /// `3-D`, `box`, `wendland-c2`, `simple-cubic`, `constant`.
    pub labels: Vec<String>,
    /// The verdict of this case.
    pub verdict: Verdict,
}

/// One verdict for all cases. Where they differ it is `conditional`, and the reason names the fewest labels that decide
/// it. Inconclusive cases do not overrule the others, but the reason names them.
pub fn roll_up(cases: &[CaseVerdict]) -> Judgement {
    let decided: Vec<&CaseVerdict> =
        cases.iter().filter(|case| case.verdict != Verdict::Inconclusive).collect();
    let undecided = cases.iter().filter(|case| case.verdict == Verdict::Inconclusive).collect_vec();
    let caveat = if undecided.is_empty() || decided.is_empty() {
        String::new()
    } else {
        let axes: Vec<usize> = varying(cases);
        format!("; undecided for {}", undecided.iter().map(|case| label(case, &axes)).unique().join(", "))
    };
    let verdicts = decided.iter().map(|case| case.verdict).unique().sorted().collect_vec();
    match verdicts.as_slice() {
        [] => Judgement { verdict: Verdict::Inconclusive, why: "no case was decided".into() },
        [one] => Judgement { verdict: *one, why: format!("in {}{caveat}", count(decided.len())) },
        several => {
            let axes = deciding_axes(&decided);
            let parts = several.iter().map(|verdict| {
                let with = decided.iter().filter(|case| case.verdict == *verdict);
                format!("{verdict} for {}", with.map(|case| label(case, &axes)).unique().join(", "))
            });
            let parts = parts.collect_vec().join("; ");
            Judgement { verdict: Verdict::Conditional, why: format!("{parts}{caveat}") }
        }
    }
}

fn count(cases: usize) -> String {
    if cases == 1 { "the one decided case".into() } else { format!("all {cases} decided cases") }
}

fn label(case: &CaseVerdict, axes: &[usize]) -> String {
    axes.iter().map(|axis| case.labels[*axis].as_str()).join(" ")
}

/// The labels that tell all cases apart, without those that follow from earlier ones.
fn varying(cases: &[CaseVerdict]) -> Vec<usize> {
    let told_apart = |axes: &[usize]| cases.iter().map(|case| label(case, axes)).unique().count();
    (1..cases.first().map_or(1, |case| case.labels.len())).fold(vec![0], |axes, axis| {
        let more = [axes.as_slice(), &[axis]].concat();
        if told_apart(&more) > told_apart(&axes) { more } else { axes }
    })
}

/// The smallest set of labels, earlier ones first, of which the verdict is a function.
fn deciding_axes(cases: &[&CaseVerdict]) -> Vec<usize> {
    let all = cases.first().map_or(0, |case| case.labels.len());
    (1..=all)
        .flat_map(|size| (0..all).combinations(size))
        .find(|axes| {
            let pairs = cases.iter().map(|case| (label(case, axes), case.verdict)).unique().collect_vec();
            pairs.iter().map(|(label, _)| label).all_unique()
        })
        .unwrap_or_else(|| (0..all).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(dimension: &str, disorder: &str, verdict: Verdict) -> CaseVerdict {
        let labels = [dimension, disorder, "k", "l", "v"].map(str::to_owned).to_vec();
        CaseVerdict { labels, verdict }
    }

    #[test]
    fn the_condition_is_the_fewest_labels_that_decide() {
        use Verdict::{Bound, Confirmed, Inconclusive, Refuted};
        let by_model =
            [case("1-D", "offset", Confirmed), case("2-D", "offset", Confirmed), case("1-D", "box", Refuted)];
        let rolled = roll_up(&by_model);
        assert_eq!(rolled.verdict, Verdict::Conditional);
        assert_eq!(rolled.why, "confirmed for offset; refuted for box");
        let by_both = [
            case("1-D", "offset", Confirmed),
            case("2-D", "offset", Bound),
            case("1-D", "box", Refuted),
            case("2-D", "box", Confirmed),
        ];
        assert!(roll_up(&by_both).why.starts_with("confirmed for 1-D offset, 2-D box; bound for 2-D offset"));
        let undecided = [case("1-D", "box", Confirmed), case("2-D", "box", Inconclusive)];
        assert_eq!(roll_up(&undecided).verdict, Confirmed);
        assert!(roll_up(&undecided).why.ends_with("; undecided for 2-D"));
        assert_eq!(roll_up(&undecided[1..]).verdict, Inconclusive);
    }
}
