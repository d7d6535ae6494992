//! Advice as text.

use crate::study::{Advice, AdviceRequest, Candidate};
use std::fmt::Write as _;

/// The answer for people: what to take, what comes next, and why.
pub fn advice_text(request: &AdviceRequest<'_>, advice: &Advice) -> String {
    let mut text = String::new();
    let disorder = request.disorder.map_or("no disorder".to_owned(), ToString::to_string);
    let _ = writeln!(
        text,
        "Relative error at most {} on a wave of length {} Δ; lattice {}, {disorder}\n",
        request.tolerance,
        request.wavelength,
        request.lattice.id()
    );
    let mut line = |title: &str, candidate: &Option<Candidate>| {
        let Some(c) = candidate else { return };
        let _ = writeln!(
            text,
            "{title:14} {:10} {:22} R/Δ = {:<5} {:>4} neighbours, {:>4} weights a row, error {:.2e} (disorder {:.1e})",
            c.operator, c.kernel, c.support_over_dx, c.neighbours, c.weights, c.error, c.disorder_part
        );
    };
    line("take", &advice.best);
    line("runner-up", &advice.runner_up);
    line("most accurate", &advice.most_accurate);
    if let Some(best) = &advice.best {
        let parts = best.by_order.iter().enumerate();
        let largest = parts.max_by(|a, b| a.1.total_cmp(b.1));
        if let Some((m, part)) = largest {
            let _ = writeln!(
                text,
                "\nIt is the cheapest of all {} looked at that meets the tolerance; its error is mostly what it makes of ∇^{m}u ({part:.1e}).",
                advice.evaluated
            );
        }
    }
    let _ = writeln!(
        text,
        "{} candidates looked at, {} without a value there, {} dearer ones left out.",
        advice.evaluated, advice.without_value, advice.left_out
    );
    text
}
