//! `sums`: certified moment sums over a lattice.

use super::arguments::SumsArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::kernel::kernel_on;
use crate::exact::{Enclosure, Rational, Truth, parse_rational, rational_text};
use crate::particles::{PointGroup, VolumeRule};
use crate::sums::{Component, LatticeSums, Moment, Reduction, Standing, SumError, SupportCount};
use serde_json::{Value, json};

/// What is summed when no moment is named.
const USUAL: [&str; 7] = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw", "sum_rrrdw", "sum_ddw", "sum_rddw"];

/// Decimal digits that may be asked for; each costs time, and past this it is a slip of the finger.
const MOST_DIGITS: u32 = 100_000;

/// One component, summed.
struct Line {
    moment: Moment,
    component: String,
    value: String,
    radius: String,
    zero_by: Option<&'static str>,
    exact: Option<String>,
}

pub(super) fn sums(arguments: &SumsArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let (kernel, lattice) = kernel_on(&arguments.kernel, &arguments.lattice, arguments.define.as_deref())?;
    let rule = VolumeRule::by_id(&arguments.volume_rule).map_err(|error| fault(&error))?;
    let support = parse_rational(&arguments.support_over_dx).map_err(|error| fault(&error))?;
    if arguments.digits > MOST_DIGITS {
        return Err(Failure::Arguments(format!(
            "{} digits are more than the {MOST_DIGITS} allowed",
            arguments.digits
        )));
    }
    let moments = moments_named(&arguments.moments)?;
    let group = PointGroup::of(&lattice);
    let sums = LatticeSums::new(&kernel, &lattice, &support, &moments, arguments.memory_mib)
        .map_err(|error| fault(&error))?;
    let count = sums.count(&support).map_err(|error| fault(&error))?;
    let mut lines = Vec::new();
    for moment in moments {
        let reduction = Reduction::of(moment, &lattice, &group);
        let lines_of = moment_lines(&sums, &support, moment, &reduction, rule, arguments);
        lines.extend(lines_of.map_err(|error| fault(&error))?);
    }
    if arguments.json {
        print_out(&format!("{:#}\n", as_json(&lines, count)));
    } else {
        print_out(&as_text(&lines, count, &support, arguments));
    }
    Ok(Exit::AsExpected)
}

/// The moments of these names, or those that are usual.
pub(super) fn moments_named(names: &[String]) -> Result<Vec<Moment>, Failure> {
    let names: Vec<&str> = match names {
        [] => USUAL.to_vec(),
        named => named.iter().map(String::as_str).collect(),
    };
    let moments: Result<_, _> = names.iter().map(|name| Moment::by_name(name)).collect();
    moments.map_err(|error| Failure::Arguments(error.to_string()))
}

/// Every component of a moment: the free ones summed, the others copied from them.
fn moment_lines(
    sums: &LatticeSums,
    support: &Rational,
    moment: Moment,
    reduction: &Reduction,
    rule: VolumeRule,
    arguments: &SumsArguments,
) -> Result<Vec<Line>, SumError> {
    let mut lines: Vec<Line> = Vec::with_capacity(reduction.components.len());
    for (component, standing) in reduction.components.iter().zip(&reduction.standing) {
        let name = component.name.clone();
        let line = match standing {
            Standing::ZeroBySymmetry => Line {
                moment,
                component: name,
                value: "0".into(),
                radius: "0".into(),
                zero_by: Some("symmetry"),
                exact: arguments.exact.then(|| "0".into()),
            },
            Standing::Free => free_line(sums, support, moment, component, rule, arguments)?,
            Standing::Equal { index, negative } => {
                let free = &lines[*index];
                let turn = |text: &str| match (negative, text.strip_prefix('-')) {
                    (false, _) => text.to_owned(),
                    (true, Some(rest)) => rest.to_owned(),
                    (true, None) if text.trim_matches(['0', '.']).is_empty() => text.to_owned(),
                    (true, None) => format!("-{text}"),
                };
                Line {
                    moment,
                    component: name,
                    value: turn(&free.value),
                    radius: free.radius.clone(),
                    zero_by: free.zero_by,
                    exact: match (&free.exact, negative) {
                        (Some(text), true) => Some(format!("-({text})")),
                        (text, _) => text.clone(),
                    },
                }
            }
        };
        lines.push(line);
    }
    Ok(lines)
}

fn free_line(
    sums: &LatticeSums,
    support: &Rational,
    moment: Moment,
    component: &Component,
    rule: VolumeRule,
    arguments: &SumsArguments,
) -> Result<Line, SumError> {
    let enclosure = certified(sums, support, component, rule, arguments.digits)?;
    // A sum that may be zero is decided in the closed form: √n of distinct squarefree n are independent.
    let exact = match arguments.exact || enclosure.contains_zero() {
        true => Some(sums.exact(support, component, rule)?),
        false => None,
    };
    let zero = exact.as_ref().is_some_and(|exact| exact.is_zero() == Truth::True);
    let (value, radius) = if zero { ("0".into(), "0".into()) } else { enclosure.decimal(arguments.digits) };
    Ok(Line {
        moment,
        component: component.name.clone(),
        value,
        radius,
        zero_by: zero.then_some("value"),
        exact: exact.filter(|_| arguments.exact).map(|exact| exact.to_string()),
    })
}

/// An enclosure whose radius is below a quarter of the last digit asked for.
fn certified(
    sums: &LatticeSums,
    support: &Rational,
    component: &Component,
    rule: VolumeRule,
    digits: u32,
) -> Result<Enclosure, SumError> {
    // log₂ 10 < 10/3; the sums of a moment lose as many bits as its terms are large, which doubling makes up for.
    let goal = digits * 10 / 3 + 3;
    let mut bits = goal + 40;
    loop {
        let mut enclosed = sums.enclose(support, std::slice::from_ref(component), rule, bits)?;
        let enclosure = enclosed.swap_remove(0);
        if enclosure.radius_is_below(goal) {
            return Ok(enclosure);
        }
        bits += bits / 2;
    }
}

fn as_json(lines: &[Line], count: SupportCount) -> Value {
    let moments = lines.iter().map(|line| {
        let mut entry = json!({
            "name": line.moment.name(),
            "p": line.moment.positions(),
            "q": line.moment.derivatives(),
            "component": line.component,
            "value": line.value,
            "radius": line.radius,
            "zero_by": line.zero_by,
        });
        if let Some(exact) = &line.exact {
            entry["exact"] = json!(exact);
        }
        entry
    });
    json!({"neighbours": count.neighbours, "in_support": count.in_support, "moments": moments.collect::<Vec<_>>()})
}

fn as_text(lines: &[Line], count: SupportCount, support: &Rational, arguments: &SumsArguments) -> String {
    let mut text = format!(
        "{} on {}, R/Δ = {}: {} neighbours, {} with the particle itself; lengths in Δ\n",
        arguments.kernel,
        arguments.lattice,
        rational_text(support),
        count.neighbours,
        count.in_support
    );
    let width =
        lines.iter().map(|line| line.moment.name().len() + line.component.len() + 1).max().unwrap_or(0);
    for line in lines {
        let name = format!("{} {}", line.moment.name(), line.component);
        let shown = match (line.zero_by, &line.exact) {
            (Some(by), _) => format!("0 by {by}"),
            (None, Some(exact)) => format!("{} ± {}\n  {:width$}  = {exact}", line.value, line.radius, ""),
            (None, None) => format!("{} ± {}", line.value, line.radius),
        };
        text += &format!("  {name:width$}  {shown}\n");
    }
    text
}
