//! `orders`: the derived orders of moment sums.

use super::arguments::OrdersArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::kernel::named;
use super::sums::moments_named;
use crate::derived::Displaced;
use crate::exact::parse_rational;
use crate::particles::{Disorder, Lattice, disorder, lattice, lattice_by_id};
use crate::report::{OrdersRequest, orders_report, to_json};

/// The lattice of a dimension when none is named.
const LATTICES: [&str; 3] = ["line", "square", "simple-cubic"];

/// The disorders when none is named: one of each kind, and the dimension it takes.
const DISORDERS: [(&str, usize); 5] =
    [("box", 1), ("offset", 1), ("wave,unit=h", 1), ("wave,unit=dx", 1), ("shear", 2)];

/// Farther than this the asymptotic terms are all there is to see, and each step takes time.
const FARTHEST: f64 = 64.0;

pub(super) fn orders(arguments: &OrdersArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let kernel = named(&arguments.kernel, &[])?;
    let lattice = lattice_for(arguments.lattice.as_deref(), arguments.dimension)?;
    let moments = moments_named(&arguments.moments)?;
    let (from, to) = (arguments.from, arguments.to);
    if !(from > 0.0 && from < to && to <= FARTHEST) {
        return Err(Failure::Arguments(format!(
            "zero crossings cannot be looked for between R/Δ = {from} and {to}: give 0 < --from < --to ≤ {FARTHEST}"
        )));
    }
    let request = OrdersRequest {
        kernel: &kernel,
        lattice: &lattice,
        moments: &moments,
        disorders: &chosen_disorders(arguments, lattice.dimension())?,
        window: (from, to),
    };
    let report = orders_report(&request).map_err(|error| fault(&error))?;
    print_out(&if arguments.json { to_json(&report) } else { report.to_text() });
    Ok(Exit::AsExpected)
}

/// The lattice of this id, or the simplest one of the dimension; if both are given they must agree.
pub(super) fn lattice_for(id: Option<&str>, dimension: Option<u8>) -> Result<Lattice, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    match (id, dimension) {
        (None, None) => Err(Failure::Arguments("say where: --dim 1, 2 or 3, or --lattice ID".into())),
        (None, Some(d)) => match LATTICES.get(usize::from(d).wrapping_sub(1)) {
            Some(id) => lattice_by_id(id).map_err(|error| fault(&error)),
            None => Err(Failure::Arguments(format!("--dim is {d}: it must be 1, 2 or 3"))),
        },
        (Some(id), dimension) => {
            let lattice = lattice_by_id(id).map_err(|error| fault(&error))?;
            let own = lattice.dimension();
            match dimension.map(usize::from) {
                Some(d) if d != own => {
                    let known = lattice::catalogue();
                    let fit: Vec<&str> =
                        known.iter().filter(|l| l.dimension() == d).map(|l| l.id()).collect();
                    let other = match fit.as_slice() {
                        [] => "--dim must be 1, 2 or 3".to_owned(),
                        fit => format!("for {d}-D name one of {}", fit.join(", ")),
                    };
                    Err(Failure::Arguments(format!(
                        "lattice '{id}' is {own}-D, not {d}-D: say --dim {own}, or {other}"
                    )))
                }
                _ => Ok(lattice),
            }
        }
    }
}

fn chosen_disorders(
    arguments: &OrdersArguments,
    dimension: usize,
) -> Result<Vec<(String, Displaced)>, Failure> {
    let texts: Vec<String> = match (arguments.disorders.as_slice(), &arguments.spectrum) {
        ([], None) => {
            let fit = DISORDERS.iter().filter(|(_, least)| *least <= dimension);
            fit.map(|(text, _)| (*text).to_owned()).collect()
        }
        (named, _) => named.to_vec(),
    };
    let mut all = Vec::new();
    for text in texts {
        if let Some(displaced) = displaced(&text)? {
            all.push((text, displaced));
        }
    }
    if let Some(text) = &arguments.spectrum {
        let spectral_exponent =
            parse_rational(text).map_err(|error| Failure::Arguments(error.to_string()))?;
        all.push((format!("spectrum k^{text}"), Displaced::Correlated { spectral_exponent }));
    }
    Ok(all)
}

/// A disorder by its model; orders do not depend on the amplitude and the wave's length, so that both may be left out.
fn displaced(text: &str) -> Result<Option<Displaced>, Failure> {
    let (model, rest) = text.split_at(text.find([':', ',']).unwrap_or(text.len()));
    let known = disorder::catalogue().into_iter().find(|entry| entry.id == model);
    let mut whole = match (known, rest.strip_prefix(':')) {
        (Some(entry), None) if entry.id != "none" => format!("{model}:0.1{rest}"),
        _ => text.to_owned(),
    };
    if model == "wave" && !text.contains("wavelength=") {
        whole += ",wavelength=4";
    }
    let disorder = Disorder::parse(&whole).map_err(|error| Failure::Arguments(error.to_string()))?;
    Ok(Displaced::by(&disorder))
}
