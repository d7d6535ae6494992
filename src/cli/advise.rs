//! `advise`: which operator, kernel and R/Δ meet a tolerance at the least cost.

use super::arguments::AdviseArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::orders::lattice_for;
use crate::language::Derivative;
use crate::particles::Disorder;
use crate::report::{advice_text, to_json};
use crate::study::{AdviceRequest, advise as look};

pub(super) fn advise(arguments: &AdviseArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let lattice = lattice_for(arguments.lattice.as_deref(), arguments.dimension)?;
    let positive = |name: &str, value: f64| {
        let message = format!("--{name} is {value}: it must be finite and positive");
        if value.is_finite() && value > 0.0 { Ok(value) } else { Err(Failure::Arguments(message)) }
    };
    let tolerance = positive("tolerance", arguments.tolerance)?;
    let wavelength = positive("wavelength", arguments.wavelength)?;
    if wavelength < 2.0 {
        let message = format!("--wavelength is {wavelength}: particles do not see waves shorter than 2 Δ");
        return Err(Failure::Arguments(message));
    }
    let disorder = match &arguments.disorder {
        None => None,
        Some(text) => {
            let disorder = Disorder::parse(text).map_err(|error| fault(&error))?;
            disorder.check_dimension(&lattice).map_err(|error| fault(&error))?;
            disorder.check_reach(&lattice).map_err(|error| fault(&error))?;
            Some(disorder)
        }
    };
    let least = lattice.sites_within(1.0).len() - 1;
    if let Some(budget) = arguments.budget_neighbours.filter(|budget| *budget < least) {
        let message = format!(
            "--budget-neighbours is {budget}: lattice '{}' has {least} nearest neighbours, give at least that",
            lattice.id()
        );
        return Err(Failure::Arguments(message));
    }
    let derivative = match arguments.gradient {
        true => Derivative::Gradient,
        false => Derivative::Laplacian { grad_div: 0 },
    };
    let request = AdviceRequest {
        derivative,
        tolerance,
        lattice: &lattice,
        disorder: disorder.as_ref(),
        wavelength,
        budget: arguments.budget_neighbours,
    };
    let advice = look(&request);
    print_out(&if arguments.json { to_json(&advice) } else { advice_text(&request, &advice) });
    if advice.best.is_none() {
        let nearest = advice.most_accurate.as_ref().map(|c| {
            format!(
                ": the best is {} with {} at R/Δ = {}, {:.1e}",
                c.operator, c.kernel, c.support_over_dx, c.error
            )
        });
        return Err(Failure::Arguments(format!(
            "nothing meets a tolerance of {tolerance}{}; raise --tolerance, --wavelength or --budget-neighbours",
            nearest.unwrap_or_default()
        )));
    }
    Ok(Exit::AsExpected)
}
