//! `schema` and `list`.

use super::arguments::{ListArguments, Listed, SchemaArguments, SchemaOf};
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::terminal::fitted;
use crate::claim;
use crate::kernel;
use crate::language::operators;
use crate::particles::{VolumeRule, disorder, lattice};
use crate::report::Report;
use crate::study::{ORDER_KINDS, RawScene, survey_kinds};
use crate::sums::Moment;
use serde_json::{Value, json};

pub(super) fn schema(arguments: &SchemaArguments) -> Result<Exit, Failure> {
    let schema = match (arguments.of, &arguments.kind) {
        (SchemaOf::Report, _) => schemars::schema_for!(Report),
        (SchemaOf::Scene, None) => schemars::schema_for!(RawScene),
        (SchemaOf::Scene, Some(kind)) if ORDER_KINDS.contains(&kind.as_str()) => {
            schemars::schema_for!(RawScene)
        }
        (SchemaOf::Scene, Some(kind)) => {
            let found = survey_kinds().find(|(id, _)| id == kind).map(|(_, schema)| schema);
            found.ok_or_else(|| {
                let kinds = ORDER_KINDS.iter().copied().chain(survey_kinds().map(|(id, _)| id));
                let kinds = kinds.collect::<Vec<_>>().join(", ");
                Failure::Arguments(format!("there is no study of kind '{kind}': the kinds are {kinds}"))
            })?
        }
    };
    print_out(&format!("{:#}\n", schema.as_value()));
    Ok(Exit::AsExpected)
}

/// (id, what it is, where from).
pub(super) type Entry = (String, String, String);

/// All catalogues.
pub(super) fn catalogues() -> [(Listed, &'static str, Vec<Entry>); 7] {
    [
        (Listed::Kernels, "kernels", kernels()),
        (Listed::Lattices, "lattices", lattices()),
        (Listed::Disorders, "disorders", disorders()),
        (Listed::VolumeRules, "volume_rules", volume_rules()),
        (Listed::Moments, "moments", moments()),
        (Listed::Operators, "operators", operators()),
        (Listed::Claims, "claims", claims()),
    ]
}

pub(super) fn list(arguments: &ListArguments) -> Result<Exit, Failure> {
    let chosen =
        catalogues().into_iter().filter(|(which, _, _)| arguments.what.is_none_or(|what| what == *which));
    if arguments.json {
        let groups = chosen.map(|(_, name, entries)| {
            let entries: Vec<Value> = entries
                .iter()
                .map(|(id, what, source)| json!({"id": id, "what": what, "source": source}))
                .collect();
            (name.to_owned(), Value::from(entries))
        });
        let value = Value::Object(groups.collect());
        print_out(&format!("{value:#}\n"));
        return Ok(Exit::AsExpected);
    }
    for (_, name, entries) in chosen {
        let width = entries.iter().map(|(id, _, _)| id.chars().count()).max().unwrap_or(0);
        let mut text = format!("{}\n", name.replace('_', " "));
        for (id, what, source) in entries {
            let source = if source.is_empty() { String::new() } else { format!("  [{source}]") };
            text += &format!("  {id:width$}  {what}{source}\n");
        }
        print_out(&fitted(&text));
    }
    Ok(Exit::AsExpected)
}

fn operators() -> Vec<Entry> {
    let entry = |entry: operators::Entry| {
        let what = format!("≈ {}: {}", entry.target.formula(entry.field), entry.text);
        (entry.id.to_owned(), what, format!("{}, {}", entry.source, entry.location))
    };
    operators::catalogue().into_iter().map(entry).collect()
}

fn kernels() -> Vec<Entry> {
    let what = |k: &kernel::Kernel| format!("{}, R = {} h, β = {}", k.name(), k.support_over_h(), k.beta());
    kernel::catalogue().iter().map(|k| (k.id().into(), what(k), k.citation().into())).collect()
}

fn lattices() -> Vec<Entry> {
    let what = |l: &lattice::Lattice| {
        format!("{}, {}-D, {} particle(s) a cell", l.name(), l.dimension(), l.basis().len())
    };
    lattice::catalogue().iter().map(|l| (l.id().into(), what(l), String::new())).collect()
}

fn disorders() -> Vec<Entry> {
    disorder::catalogue().iter().map(|m| (m.id.into(), m.formula.into(), m.citation.into())).collect()
}

fn volume_rules() -> Vec<Entry> {
    let what = |rule| match rule {
        VolumeRule::Constant => {
            ("ω = volume of the cell over the particles in it", "fatehi-manzari-2011, §4.1")
        }
        VolumeRule::NumberDensity => ("V = 1/ΣW", "chaussonnet-2015, Eq. (1)"),
    };
    VolumeRule::ALL
        .iter()
        .map(|rule| (rule.id().into(), what(*rule).0.into(), what(*rule).1.into()))
        .collect()
}

fn moments() -> Vec<Entry> {
    let what = |m: &Moment| format!("{}, p = {}, q = {}", m.formula(), m.positions(), m.derivatives());
    Moment::all(4).iter().map(|m| (m.name(), what(m), String::new())).collect()
}

fn claims() -> Vec<Entry> {
    claim::catalogue().into_iter().map(|c| (c.id, c.text, format!("{}, {}", c.source, c.location))).collect()
}
