//! `rms`: the RMS error of an operator or a moment sum on disordered particles, without a sample.

use super::arguments::{RmsArguments, RmsModel};
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::kernel::kernel_on;
use crate::derived::{DeriveError, Setting, finite, linearised};
use crate::exact::{parse_rational, rational_to_f64};
use crate::language::{Coefficient, Subject};
use crate::measured::{SampleSpec, sampled_error};
use crate::particles::{Disorder, VolumeRule};
use crate::report::{RmsReport, to_json};
use crate::sums::Moment;

/// R/Δ that may be asked for: beyond it there are more neighbours than any simulation has.
const LARGEST_SUPPORT: f64 = 64.0;

pub(super) fn rms(arguments: &RmsArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let (kernel, lattice) = kernel_on(&arguments.kernel, &arguments.lattice, arguments.define.as_deref())?;
    let rule = VolumeRule::by_id(&arguments.volume_rule).map_err(|error| fault(&error))?;
    let support_over_dx = support_of(&arguments.support_over_dx)?;
    let disorder = Disorder::parse(&arguments.disorder).map_err(|error| fault(&error))?;
    disorder.check_dimension(&lattice).map_err(|error| fault(&error))?;
    disorder.check_reach(&lattice).map_err(|error| fault(&error))?;
    let subject = match (&arguments.moment, &arguments.operator) {
        (Some(moment), _) => Subject::Moment(Moment::by_name(moment).map_err(|error| fault(&error))?),
        (None, Some(operator)) => {
            let coefficient = Coefficient::new(operator, arguments.field.order())
                .map_err(|error| Failure::Operator(operator.clone(), error))?;
            Subject::Coefficient(coefficient)
        }
        (None, None) => {
            return Err(Failure::Arguments(
                "name an operator (--operator F4) or a moment (--moment sum_dw)".into(),
            ));
        }
    };
    let nested = subject.coefficient().is_some_and(Coefficient::is_nested);
    if nested && arguments.sample.is_some() {
        return Err(Failure::Arguments(format!(
            "{} sums over neighbours of neighbours, which samples do not hold: leave --sample out",
            subject.name()
        )));
    }
    let setting = Setting { kernel: &kernel, lattice: &lattice, disorder: &disorder, support_over_dx, rule };
    let error = match (arguments.model, subject.moment()) {
        (None, Some(moment)) if rule == VolumeRule::Constant => finite(&setting, moment),
        (Some(RmsModel::Finite), Some(moment)) => finite(&setting, moment),
        (Some(RmsModel::Finite), None) => Err(DeriveError::Finite { what: "operators" }),
        _ => linearised(&setting, &subject),
    };
    let error = error.map_err(|error| fault(&error))?;
    let sampled = arguments.sample.map(|samples| {
        let spec = SampleSpec {
            kernel: kernel.clone(),
            lattice: lattice.clone(),
            amplitude: disorder.amplitude(),
            disorder: disorder.clone(),
            support_over_dx,
            rule,
            subjects: vec![subject.clone()],
            seed: arguments.seed,
        };
        sampled_error(&spec, samples)
    });
    let sampled = sampled.transpose().map_err(|error| fault(&error))?;
    let report = RmsReport::new(&subject, &error, sampled.as_ref());
    print_out(&if arguments.json { to_json(&report) } else { report.to_text() });
    Ok(Exit::AsExpected)
}

/// R/Δ from a decimal or p/q.
pub(super) fn support_of(text: &str) -> Result<f64, Failure> {
    let support = parse_rational(text).map_err(|error| Failure::Arguments(error.to_string()))?;
    let support = rational_to_f64(&support);
    if support > 0.0 && support <= LARGEST_SUPPORT {
        return Ok(support);
    }
    Err(Failure::Arguments(format!("R/Δ = {text} is not between 0 and {LARGEST_SUPPORT}")))
}
