//! `kernel`: the audit of one kernel.

use super::arguments::KernelArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use crate::kernel::{self, Audit, Kernel};
use crate::particles::{Lattice, lattice_among};
use crate::study::{read_definitions, read_kernel};
use std::fmt::Write as _;
use std::path::Path;

pub(super) fn audit(arguments: &KernelArguments) -> Result<Exit, Failure> {
    let audit = Audit::of(&named(&arguments.kernel, &[])?);
    if arguments.json {
        let text =
            serde_json::to_string_pretty(&audit).unwrap_or_else(|error| unreachable!("plain data: {error}"));
        print_out(&format!("{text}\n"));
    } else {
        print_out(&text(&audit));
    }
    Ok(Exit::AsExpected)
}

/// A file if there is one of this name or the name ends like one; else an entry of the catalogue, or one's own.
pub(super) fn named(name: &str, own: &[Kernel]) -> Result<Kernel, Failure> {
    let path = Path::new(name);
    let like_a_file = path.extension().is_some_and(|e| e == "toml" || e == "json");
    if like_a_file || path.is_file() {
        return Ok(read_kernel(path)?);
    }
    kernel::by_id_among(name, own).map_err(|error| Failure::Arguments(error.to_string()))
}

/// A kernel and a lattice by name, those that a scene defines among them.
pub(super) fn kernel_on(
    kernel: &str,
    lattice: &str,
    scene: Option<&Path>,
) -> Result<(Kernel, Lattice), Failure> {
    let (kernels, lattices) = scene.map(read_definitions).transpose()?.unwrap_or_default();
    let kernel = named(kernel, &kernels)?;
    let lattice = lattice_among(lattice, &lattices).map_err(|error| Failure::Arguments(error.to_string()))?;
    Ok((kernel, lattice))
}

fn text(audit: &Audit) -> String {
    let mut out = String::new();
    let mut line = |text: String| {
        let _ = writeln!(out, "{text}");
    };
    line(format!("{}: {}  [{}]", audit.id, audit.name, audit.citation));
    if let Some(remark) = &audit.remark {
        line(wrapped(&format!("Note: {remark}.")));
    }
    let odd = audit
        .first_odd_power
        .map_or("w is even at the origin".into(), |power| format!("first odd power at the origin q^{power}"));
    line(format!("R/h = {}, β = {}, {odd}", audit.support_over_h, audit.beta));
    let jumps = audit.jumps.iter().map(|(at, order)| match order {
        Some(order) => format!("derivative {order} at q = {at}"),
        None => format!("none at q = {at}"),
    });
    line(format!("lowest jump: {}", jumps.collect::<Vec<_>>().join(", ")));
    line("\nnormalisation (lengths in h, profile as in this entry)".into());
    for entry in &audit.normalisation {
        line(format!("  {}-D  σ = {}", entry.dimension, entry.sigma));
        line(format!("       ∫W = {}, ∫x²W = {} h²", entry.integral, entry.second_moment));
        for printed in &entry.printed {
            line(if printed.agrees {
                format!("       {} prints {}: right", printed.source, printed.printed)
            } else {
                format!(
                    "       {} prints {}: WRONG, right is {} (as printed ∫W = {:.6})",
                    printed.source, printed.printed, printed.right, printed.integrates_to
                )
            });
        }
    }
    line("\nshape (certified)".into());
    line(format!("  w ≥ 0: {}", answer(audit.nonnegative, "negative", &audit.negative_between)));
    line(format!("  w falls: {}", answer(audit.decreasing, "rises", &audit.rising_between)));
    line(wrapped(
        "\nS2 (Fatehi & Manzari 2011, Eqs. 10 to 12) keeps monotone data monotone on a line, square or cubic lattice if \
         ∇²W < 0 only nearer than the nearest neighbour, q* h ≤ Δ (they print the reverse)",
    ));
    for inflection in &audit.inflections {
        line(format!(
            "  {}-D  q* = {}: h/Δ ≤ {:.6}, R/Δ ≤ {:.6}",
            inflection.dimension,
            inflection.q,
            inflection.greatest_h_over_dx,
            inflection.greatest_support_over_dx
        ));
    }
    if audit.inflections.is_empty() {
        line("  ∇²W does not turn positive inside the support".into());
    }
    if !audit.conventions.is_empty() {
        line("\nh elsewhere (same R: h/Δ there = factor × h/Δ here)".into());
        line(format!("  {:26}  {:>8}  {:>8}  source", "", "R/h", "factor"));
        for convention in &audit.conventions {
            let dimension = convention.dimension.map(|d| format!(", {d}-D")).unwrap_or_default();
            line(format!(
                "  {:26}  {:>8.6}  {:>8.6}  {}",
                format!("{}{dimension}", convention.who),
                convention.value,
                convention.h_factor,
                convention.source
            ));
        }
    }
    out
}

fn answer(holds: bool, otherwise: &str, spans: &[(String, String)]) -> String {
    if holds {
        return "yes".into();
    }
    let spans = spans.iter().map(|(from, to)| match from == to {
        true => format!("at q = {from}"),
        false => format!("for {from} < q < {to}"),
    });
    format!("no, {otherwise} {}", spans.collect::<Vec<_>>().join(", "))
}

/// Broken at spaces before column 100.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if lines[last].chars().count() + word.chars().count() >= 99 {
            lines.push(format!("  {word}"));
        } else {
            let gap = if lines[last].is_empty() { "" } else { " " };
            lines[last] += &format!("{gap}{word}");
        }
    }
    lines.join("\n")
}
