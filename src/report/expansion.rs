//! An operator's expansion as a record, as text and as LaTeX.

use crate::derived::{Conservation, Conserved, DeriveError, Expansion, Format, Printed, VanishingTerm};
use crate::exact::Order;
use crate::language::{Operator, Target, operators};
use crate::particles::{Lattice, PointGroup};
use serde::Serialize;
use std::fmt::Write as _;

/// An operator, its truncation error and what follows from it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpansionReport {
    /// Its id in the catalogue, or `own`.
    pub id: String,
    /// Its text.
    pub text: String,
    /// Where it is printed; empty for one's own.
    pub citation: String,
    /// Where the entry differs from the print.
    pub remark: String,
    /// What it approximates, if that is known.
    pub approximates: Option<String>,
    /// The truncation error, order by order.
    pub orders: Vec<OrderReport>,
    /// By dimension 1, 2, 3: the degree up to which polynomials are exact on every arrangement; null if not even constants.
    pub consistency: Vec<Option<Order>>,
    /// What is conserved.
    pub conserves: ConservationReport,
}

/// One order of an expansion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrderReport {
    /// m.
    pub order: usize,
    /// `∇∇u`.
    pub derivative: String,
    /// The terms; none if the coefficient vanishes identically.
    pub terms: Vec<TermReport>,
}

/// One term of an expansion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TermReport {
    /// As text.
    pub text: String,
    /// As LaTeX.
    pub latex: String,
    /// The lattices at whose sites it vanishes, and by what.
    pub vanishes: Vec<Vanishes>,
}

/// A term vanishes on a lattice.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Vanishes {
    /// The lattice.
    pub lattice: String,
    /// `point-group` or `inversion`.
    pub by: &'static str,
}

/// What an operator conserves: `yes`, `no`, or null where the question has no meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ConservationReport {
    /// Σ_i V_i ⟨Lu⟩_i: linear momentum of a force, heat of a source.
    pub total: Option<bool>,
    /// Σ_i V_i r_i × ⟨Lu⟩_i.
    pub angular: Option<bool>,
}

/// Expands an operator to order `to` and says what vanishes at the sites of the lattices.
///
/// # Errors
/// [`DeriveError`].
pub fn expansion_report(
    entry: Option<&operators::Entry>,
    operator: Operator,
    to: usize,
    lattices: &[Lattice],
) -> Result<ExpansionReport, DeriveError> {
    let target = entry.map_or_else(|| Target::inferred(&operator), |entry| Some(entry.target.clone()));
    let conservation = Conservation::of(&operator)?;
    let expansion = Expansion::of(operator, target, to)?;
    let groups: Vec<(&Lattice, PointGroup)> =
        lattices.iter().map(|lattice| (lattice, PointGroup::of(lattice))).collect();
    let (text, latex) = (expansion.printed(Format::Text), expansion.printed(Format::Latex));
    let orders = text.into_iter().zip(latex).map(|(text, latex)| order(&expansion, &text, latex, &groups));
    let orders = orders.collect();
    let said = |conserved| match conserved {
        Conserved::Yes => Some(true),
        Conserved::No => Some(false),
        Conserved::DoesNotApply => None,
    };
    let field = expansion.operator.field;
    Ok(ExpansionReport {
        id: entry.map_or_else(|| "own".into(), |entry| entry.id.into()),
        citation: entry.map_or_else(String::new, |entry| format!("{}, {}", entry.source, entry.location)),
        remark: entry.map_or_else(String::new, |entry| entry.remark.into()),
        approximates: expansion.target.as_ref().map(|target| target.formula(field)),
        orders,
        consistency: (1..=3).map(|d| expansion.consistency(d)).collect::<Result<_, _>>()?,
        conserves: ConservationReport {
            total: said(conservation.total),
            angular: said(conservation.angular),
        },
        text: expansion.operator.text,
    })
}

fn order(
    expansion: &Expansion,
    text: &Printed,
    latex: Printed,
    groups: &[(&Lattice, PointGroup)],
) -> OrderReport {
    let vanishing: Vec<Vec<Option<VanishingTerm>>> =
        groups.iter().map(|(_, group)| expansion.vanishing(text.order, group)).collect();
    let terms = text.terms.iter().zip(latex.terms).enumerate().map(|(place, (text, latex))| {
        let vanishes = groups.iter().zip(&vanishing).filter_map(|((lattice, _), terms)| {
            let by = match terms.get(place).copied().flatten()? {
                VanishingTerm::ByThePointGroup => "point-group",
                VanishingTerm::ByInversion => "inversion",
            };
            Some(Vanishes { lattice: lattice.id().to_owned(), by })
        });
        TermReport { text: text.clone(), latex, vanishes: vanishes.collect() }
    });
    OrderReport { order: text.order, derivative: text.derivative.clone(), terms: terms.collect() }
}

impl ExpansionReport {
    /// For people.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        let mut line = |text: String| {
            let _ = writeln!(out, "{text}");
        };
        line(format!("{}: {}", self.id, self.text));
        if !self.citation.is_empty() {
            line(format!("  [{}]", self.citation));
        }
        if !self.remark.is_empty() {
            line(format!("  Note: {}", self.remark));
        }
        match &self.approximates {
            Some(target) if target.starts_with('−') => {
                line(format!("Truncation error ⟨L⟩_i − ({target}) ="))
            }
            Some(target) => line(format!("Truncation error ⟨L⟩_i − {target} =")),
            None => line("What it approximates cannot be told from its units; ⟨L⟩_i =".into()),
        }
        for order in &self.orders {
            if order.terms.is_empty() {
                line(format!("  {:8} vanishes identically", order.derivative));
            }
            for (place, term) in order.terms.iter().enumerate() {
                let head = if place == 0 { order.derivative.as_str() } else { "" };
                line(format!("  {head:8} {}", term.text));
                for (by, why) in [("point-group", "by the point group"), ("inversion", "by inversion")] {
                    let on: Vec<&str> =
                        term.vanishes.iter().filter(|v| v.by == by).map(|v| v.lattice.as_str()).collect();
                    if !on.is_empty() {
                        line(format!("  {:8}   vanishes on {} {why}", "", on.join(", ")));
                    }
                }
            }
        }
        line(format!("Exact on polynomials: {}", self.consistency_text()));
        let answer = |conserved| match conserved {
            Some(true) => "yes",
            Some(false) => "no",
            None => "does not apply",
        };
        line(format!("Conserves the total: {}", answer(self.conserves.total)));
        line(format!("Conserves angular momentum: {}", answer(self.conserves.angular)));
        out
    }

    fn consistency_text(&self) -> String {
        let said = |order: &Option<Order>| match order {
            None => "not even of degree 0".to_owned(),
            Some(Order::Exactly(p)) => format!("up to degree {p}, and not of degree {}: Exactly({p})", p + 1),
            Some(Order::AtLeast(p)) => format!("up to degree {p}: AtLeast({p})"),
        };
        if self.consistency.windows(2).all(|pair| pair[0] == pair[1]) {
            return self.consistency.first().map(said).unwrap_or_default();
        }
        let each = self.consistency.iter().zip(1..).map(|(order, d)| format!("{d}-D {}", said(order)));
        each.collect::<Vec<_>>().join("; ")
    }

    /// As LaTeX: an `align*` with one line per term.
    pub fn to_latex(&self) -> String {
        let mut out = format!("% {}: {}\n", self.id, self.text);
        if !self.citation.is_empty() {
            let _ = writeln!(out, "% {}", self.citation);
        }
        out += "\\begin{align*}\nEr_i ={}";
        let terms: Vec<&str> =
            self.orders.iter().flat_map(|order| &order.terms).map(|term| term.latex.as_str()).collect();
        for (place, term) in terms.iter().enumerate() {
            let term = if place == 0 { term.strip_prefix("+ ").unwrap_or(term) } else { term };
            let _ = writeln!(out, "& {term}{}", if place + 1 < terms.len() { " \\\\" } else { " + \\dots" });
        }
        if terms.is_empty() {
            out += "& 0 + \\dots\n";
        }
        out + "\\end{align*}\n"
    }
}
