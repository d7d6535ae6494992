//! Every number that a claim's columns hold, by name: what CSV lists and what two reports are compared by.

use crate::record::{ClaimEntry, Column, Estimate};

/// One statement of a column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named<'a> {
    /// `published`, `derived` or `measured`.
    pub(super) column: &'static str,
    /// What it is: `exponent of Δ/h`, `value`, `slope`, ….
    pub(super) quantity: &'static str,
    /// What it says.
    pub(super) held: Held<'a>,
    /// Its unit; empty for words.
    pub(super) unit: &'a str,
}

/// A number with its interval, a bound, or a word.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Held<'a> {
    /// With an interval.
    Estimate(&'a Estimate),
    /// Without one.
    Bound(f64),
    /// `rising`, `holds`, ….
    Word(String),
}

impl Held<'_> {
    /// Where the number comes from, as the record writes it.
    #[cfg(feature = "views")]
    pub(super) fn by(&self) -> &'static str {
        use crate::record::Source;
        let Self::Estimate(Estimate { by: Some(by), .. }) = self else { return "" };
        match by {
            Source::Print => "print",
            Source::Derivation => "derivation",
            Source::Fit => "fit",
            Source::Identity => "identity",
            Source::Exact => "exact",
        }
    }
}

/// All that the columns of a claim in a case hold, in a fixed order.
pub(super) fn numbers(entry: &ClaimEntry) -> Vec<Named<'_>> {
    let columns =
        [("published", &entry.published), ("derived", &entry.derived), ("measured", &entry.measured)];
    columns
        .into_iter()
        .filter_map(|(name, column)| Some(of_column(name, column.as_ref()?)))
        .flatten()
        .collect()
}

fn of_column<'a>(name: &'static str, column: &'a Column) -> Vec<Named<'a>> {
    let mut found = Vec::new();
    let mut add = |quantity, held, unit| found.push(Named { column: name, quantity, held, unit });
    if let Some(e) = &column.exponents {
        let exponents = [
            ("exponent of d̃", &e.displacement),
            ("exponent of h", &e.h),
            ("exponent of Δ/h", &e.dx_over_h),
            ("exponent of Δ", &e.dx),
            ("exponent of Δt", &e.dt),
        ];
        for (quantity, exponent) in exponents {
            if let Some(exponent) = exponent {
                add(quantity, Held::Estimate(exponent), "1");
            }
        }
    }
    if let Some(value) = &column.value {
        add("value", Held::Estimate(value), column.unit.as_deref().unwrap_or("1"));
    }
    let truth = |holds: bool| Held::Word(if holds { "holds" } else { "does not hold" }.into());
    if let Some(zero) = &column.zero {
        add("zero", truth(zero.holds), "");
        if let Some(bound) = zero.bound {
            add("largest magnitude", Held::Bound(bound), column.unit.as_deref().unwrap_or("1"));
        }
    }
    if let Some(trend) = &column.trend {
        add("trend", Held::Word(trend.direction.clone()), "");
        if let Some(slope) = &trend.slope {
            add("slope", Held::Estimate(slope), "1");
        }
    }
    if let Some(relation) = &column.relation {
        add("relation", truth(relation.holds), "");
        for (quantity, side) in [("left side", &relation.left_value), ("right side", &relation.right_value)] {
            if let Some(side) = side {
                add(quantity, Held::Estimate(side), column.unit.as_deref().unwrap_or("1"));
            }
        }
    }
    found
}
