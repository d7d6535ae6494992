//! `symbol`: the Fourier symbol of an operator on a lattice.

use super::arguments::SymbolArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::kernel::kernel_on;
use super::rms::support_of;
use crate::language::Coefficient;
use crate::measured::Symbol;
use crate::particles::VolumeRule;
use crate::report::{symbol_report, to_json};

pub(super) fn symbol(arguments: &SymbolArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let (kernel, lattice) = kernel_on(&arguments.kernel, &arguments.lattice, arguments.define.as_deref())?;
    let rule = VolumeRule::by_id(&arguments.volume_rule).map_err(|error| fault(&error))?;
    let support = support_of(&arguments.support_over_dx)?;
    let direction = direction(&arguments.direction, lattice.dimension())?;
    let operator = Coefficient::new(&arguments.operator, 0)
        .map_err(|error| Failure::Operator(arguments.operator.clone(), error))?;
    let symbol = Symbol::of(&operator, &kernel, &lattice, support, rule).map_err(|error| fault(&error))?;
    let report =
        symbol_report(&operator, &symbol, lattice.dimension(), direction, usize::from(arguments.waves));
    print_out(&if arguments.json { to_json(&report) } else { report.to_text() });
    Ok(Exit::AsExpected)
}

/// A unit vector from `x`, `y`, `z` or components.
fn direction(text: &str, dimension: usize) -> Result<[f64; 3], Failure> {
    let wrong = |what: String| Failure::Arguments(format!("direction '{text}' {what}"));
    let mut n = [0.0; 3];
    match ["x", "y", "z"].iter().position(|axis| *axis == text) {
        Some(axis) => n[axis] = 1.0,
        None => {
            let parts: Vec<&str> = text.split(',').map(str::trim).collect();
            if parts.len() != dimension {
                return Err(wrong(format!("has {} components, not {dimension}", parts.len())));
            }
            for (n, part) in n.iter_mut().zip(parts) {
                *n = part.parse().map_err(|_| wrong("is neither x, y, z nor components like 1,1".into()))?;
            }
        }
    }
    if n[dimension..].iter().any(|x| *x != 0.0) {
        return Err(wrong(format!("leaves the {dimension} dimensions of the lattice")));
    }
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !length.is_finite() || length == 0.0 {
        return Err(wrong("has no direction".into()));
    }
    Ok(n.map(|x| x / length))
}
