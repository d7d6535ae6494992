//! The derived orders of moment sums as a record and as text.

use crate::claim::{self, Statement};
use crate::derived::{DeriveError, DisorderOrder, Displaced, RegularOrder, Source};
use crate::exact::{Exponent, Rational, Truth, int, rational_text};
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::particles::Lattice;
use crate::sums::Moment;
use serde::Serialize;
use std::fmt::Write as _;

/// The widest line of the text.
const WIDTH: usize = 100;

/// What is asked of [`orders_report`].
#[derive(Debug, Clone)]
pub struct OrdersRequest<'a> {
    /// The kernel.
    pub kernel: &'a Kernel,
    /// The lattice.
    pub lattice: &'a Lattice,
    /// The moments.
    pub moments: &'a [Moment],
    /// The disorders, each with the name to print.
    pub disorders: &'a [(String, Displaced)],
    /// The R/Δ between which zero crossings are looked for.
    pub window: (f64, f64),
}

/// The derived orders of moment sums for one kernel on one lattice, volumes constant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrdersReport {
    /// The kernel.
    pub kernel: String,
    /// The lattice.
    pub lattice: String,
    /// D.
    pub dimension: usize,
    /// β.
    pub beta: i64,
    /// R/h.
    pub support_over_h: String,
    /// The R/Δ between which zero crossings are listed.
    pub window: [f64; 2],
    /// By moment.
    pub moments: Vec<MomentOrders>,
}

/// One moment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MomentOrders {
    /// `b_inverse`.
    pub name: String,
    /// `B⁻¹`.
    pub formula: String,
    /// Whether the sum vanishes by symmetry.
    pub vanishes: bool,
    /// The exponent of Δ/h of the sum itself.
    pub value: Option<Exponent>,
    /// The exponent of Δ/h of the sum less its continuum limit.
    pub deviation: Option<Exponent>,
    /// What the deviation is made of, exponents rising; of each source the lowest.
    pub contributions: Vec<ContributionReport>,
    /// The components that symmetry leaves.
    pub components: Vec<ComponentReport>,
    /// What disorder adds.
    pub disorder: Vec<DisorderReport>,
    /// What is printed of it.
    pub published: Vec<PublishedOrder>,
}

/// A power of Δ/h and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContributionReport {
    /// `origin` or `knot`.
    pub source: &'static str,
    /// s of an odd power r^s at the origin; m, the lowest derivative that jumps at a knot.
    pub power: usize,
    /// The knot over R.
    pub at: Option<String>,
    /// The exponent of Δ/h.
    pub exponent: Exponent,
    /// Whether it oscillates with R/Δ.
    pub oscillates: bool,
}

/// One component of a moment on regular particles, lengths in h.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComponentReport {
    /// `xx`.
    pub component: String,
    /// Its continuum limit.
    pub limit: f64,
    /// The exponent of Δ/h of its deviation.
    pub exponent: Option<Exponent>,
    /// What does not oscillate of the amplitude, and a bound of its error.
    pub constant: Option<[f64; 2]>,
    /// The same in closed form.
    pub exact: Option<String>,
    /// The supremum of |deviation| (Δ/h)^{−exponent} as Δ/h falls, and a bound of its error; null if there is none.
    pub envelope: Option<[f64; 2]>,
    /// The R/Δ from which on all further terms are below a tenth of the envelope.
    pub asymptotic_from: Option<f64>,
    /// The R/Δ at which the deviation crosses zero, each with how far off it may be; null if the amplitude has no bound.
    pub zero_crossings: Option<Vec<[f64; 2]>>,
}

/// What one disorder adds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DisorderReport {
    /// As asked.
    pub disorder: String,
    /// Why there is none, if so.
    pub refused: Option<String>,
    /// The dominant term first.
    pub terms: Vec<DisorderTermReport>,
    /// Which term dominates.
    pub why: String,
}

/// d̃^`displacement` h^`h` (Δ/h)^`dx_over_h`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DisorderTermReport {
    /// The exponent of d̃.
    pub displacement: Exponent,
    /// The exponent of h.
    pub h: Exponent,
    /// The exponent of Δ/h.
    pub dx_over_h: Exponent,
    /// Where it comes from.
    pub from: &'static str,
}

/// A published order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PublishedOrder {
    /// The claim.
    pub id: String,
    /// Where.
    pub location: String,
    /// `regular-deviation`, ….
    pub quantity: &'static str,
    /// The exponent of Δ/h as printed.
    pub printed: String,
    /// The same for this kernel's β.
    pub dx_over_h: Exponent,
}

/// Derives the orders.
///
/// # Errors
/// [`DeriveError`]; a disorder that has no meaning in this dimension is told in its place.
pub fn orders_report(request: &OrdersRequest<'_>) -> Result<OrdersReport, DeriveError> {
    let moments = request.moments.iter().map(|moment| moment_orders(request, *moment));
    let kernel = request.kernel;
    Ok(OrdersReport {
        kernel: kernel.id().into(),
        lattice: request.lattice.id().into(),
        dimension: request.lattice.dimension(),
        beta: kernel.beta(),
        support_over_h: rational_text(kernel.support_over_h()),
        window: [request.window.0, request.window.1],
        moments: moments.collect::<Result<_, _>>()?,
    })
}

fn moment_orders(request: &OrdersRequest<'_>, moment: Moment) -> Result<MomentOrders, DeriveError> {
    let order = RegularOrder::of(request.kernel, request.lattice, moment)?;
    let disorder = request.disorders.iter().map(|(name, displaced)| {
        let entry = |refused, terms, why| DisorderReport { disorder: name.clone(), refused, terms, why };
        match DisorderOrder::of(request.kernel, request.lattice, moment, displaced) {
            Ok(order) => entry(None, order.terms.iter().map(disorder_term).collect(), order.reason),
            Err(error) => entry(Some(error.to_string()), Vec::new(), String::new()),
        }
    });
    let mut contributions: Vec<ContributionReport> = Vec::new();
    for contribution in &order.contributions {
        let (source, power, at) = match &contribution.source {
            Source::Origin { power } => ("origin", *power, None),
            Source::Knot { at, jump } => ("knot", *jump, Some(rational_text(at))),
        };
        // Of a knot the lowest term; the others follow in steps of one.
        if !contributions
            .iter()
            .any(|c| c.source == source && c.at == at && (at.is_some() || c.power == power))
        {
            contributions.push(ContributionReport {
                source,
                power,
                at,
                exponent: contribution.exponent.clone().into(),
                oscillates: contribution.source.oscillates(),
            });
        }
    }
    Ok(MomentOrders {
        name: moment.name(),
        formula: moment.formula(),
        vanishes: order.vanishes(),
        value: order.value_exponent().map(Exponent::from),
        deviation: order.exponent().cloned().map(Exponent::from),
        contributions,
        components: components(&order, request.window),
        disorder: disorder.collect(),
        published: published(request, moment),
    })
}

fn disorder_term(term: &crate::derived::DisorderTerm) -> DisorderTermReport {
    DisorderTermReport {
        displacement: term.displacement.clone().into(),
        h: term.h.clone().into(),
        dx_over_h: term.dx_over_h.clone().into(),
        from: term.from,
    }
}

fn components(order: &RegularOrder, (from, to): (f64, f64)) -> Vec<ComponentReport> {
    let (envelopes, starts) = (order.envelopes(), order.asymptotic_from());
    let crossings = order.zero_crossings(from, to).ok();
    let each = order.components.iter().enumerate().map(|(index, component)| {
        let constants: Vec<_> =
            component.leading_terms().filter_map(|term| term.amplitude.as_ref()).collect();
        let sum =
            |part: fn(&crate::derived::Amplitude) -> f64| constants.iter().map(|a| part(a)).sum::<f64>();
        let exact = constants.iter().map(|a| a.exact.clone()).collect::<Option<Vec<Rational>>>();
        ComponentReport {
            component: component.name.clone(),
            limit: if component.limit.is_zero() == Truth::True { 0.0 } else { component.limit.to_f64() },
            exponent: component.leading().cloned().map(Exponent::from),
            constant: (!constants.is_empty()).then(|| [sum(|a| a.value), sum(|a| a.radius)]),
            exact: exact.filter(|e| !e.is_empty()).map(|e| rational_text(&e.into_iter().sum())),
            envelope: envelopes[index].map(|envelope| [envelope.value, envelope.radius]),
            asymptotic_from: starts[index],
            zero_crossings: crossings
                .as_ref()
                .map(|all| all[index].iter().map(|c| [c.support_over_dx, c.radius]).collect()),
        }
    });
    each.collect()
}

/// The power laws of Fatehi & Manzari's Table 2 on this moment, for this kernel's β.
fn published(request: &OrdersRequest<'_>, moment: Moment) -> Vec<PublishedOrder> {
    let claims = claim::select("fatehi-table-2").unwrap_or_default().into_iter();
    claims
        .filter(|claim| claim.subject == Subject::Moment(moment))
        .filter(|claim| claim.dimensions.contains(&request.lattice.dimension()))
        .filter_map(|claim| match claim.statement {
            Statement::PowerLaw { quantity, powers } => Some(PublishedOrder {
                id: claim.id,
                location: claim.location,
                quantity: quantity.id(),
                printed: powers.dx_over_h.to_string(),
                dx_over_h: powers.dx_over_h.at(request.kernel.beta()).into(),
            }),
            Statement::Zero | Statement::Convergence { .. } => None,
        })
        .collect()
}

impl OrdersReport {
    /// As text, no line wider than a hundred columns.
    pub fn to_text(&self) -> String {
        let mut out = format!(
            "{} on {}, {}-D: R = {} h, β = {}; volumes constant, lengths in h\n",
            self.kernel, self.lattice, self.dimension, self.support_over_h, self.beta
        );
        for moment in &self.moments {
            let _ = writeln!(out, "\n{} ({})", moment.formula, moment.name);
            moment.write(&mut out, self.window);
        }
        out
    }
}

impl MomentOrders {
    fn write(&self, out: &mut String, window: [f64; 2]) {
        let mut line = |text: String| {
            let _ = writeln!(out, "{}", wrapped(&text));
        };
        match (&self.deviation, &self.value) {
            _ if self.vanishes => line("  regular: zero by symmetry, of no order".into()),
            (Some(deviation), Some(value)) => {
                let value =
                    if value.0 == int(0) { "has a limit".into() } else { format!("~ (Δ/h)^{value}") };
                line(format!("  regular: S − limit ~ (Δ/h)^{deviation}; S itself {value}"));
            }
            _ => line("  regular: equal to its limit".into()),
        }
        let sources: Vec<String> = self.contributions.iter().map(ContributionReport::text).collect();
        if !sources.is_empty() {
            line(format!("    from {}", sources.join("; ")));
        }
        for component in &self.components {
            component.lines(window).into_iter().for_each(&mut line);
        }
        for disorder in &self.disorder {
            match (&disorder.refused, disorder.terms.first()) {
                (Some(why), _) => line(format!("  {}: {why}", disorder.disorder)),
                (None, Some(first)) => {
                    let others: Vec<String> = disorder.terms[1..]
                        .iter()
                        .map(|term| format!("{} from {}", term.text(), term.from))
                        .collect();
                    line(format!("  {}: {}; {}", disorder.disorder, first.text(), disorder.why));
                    if !others.is_empty() {
                        line(format!("    then {}", others.join(", ")));
                    }
                }
                (None, None) => {}
            }
        }
        for published in &self.published {
            let value = published.dx_over_h.to_string();
            let of_beta = if value == published.printed { String::new() } else { format!(" = {value}") };
            line(format!(
                "  paper: {}{of_beta} ({}, {})",
                published.printed, published.quantity, published.location
            ));
        }
    }
}

impl ContributionReport {
    fn text(&self) -> String {
        match &self.at {
            None => format!("r^{} at the origin (Δ/h)^{}", self.power, self.exponent),
            Some(at) if at == "1" => {
                format!("the jump of derivative {} at R (Δ/h)^{}, oscillating", self.power, self.exponent)
            }
            Some(at) => {
                format!(
                    "the jump of derivative {} at {at} R (Δ/h)^{}, oscillating",
                    self.power, self.exponent
                )
            }
        }
    }
}

impl DisorderTermReport {
    fn text(&self) -> String {
        let power = |name: &str, exponent: &Exponent| match rational_text(&exponent.0).as_str() {
            "0" => String::new(),
            "1" => format!(" {name}"),
            text => format!(" {name}^{text}"),
        };
        let all = power("d̃", &self.displacement) + &power("h", &self.h) + &power("(Δ/h)", &self.dx_over_h);
        all.trim_start().to_owned()
    }
}

impl ComponentReport {
    fn lines(&self, [from, to]: [f64; 2]) -> Vec<String> {
        let name = if self.component.is_empty() { "S" } else { &self.component };
        let Some(exponent) = &self.exponent else { return vec![format!("    {name}: equal to its limit")] };
        let mut first = format!("    {name}: limit {}, (Δ/h)^{exponent}", short(self.limit));
        match (self.constant, &self.exact) {
            (Some(_), Some(exact)) => first += &format!(" × {exact}"),
            (Some([value, radius]), None) => first += &format!(" × {}", with_radius(value, radius)),
            (None, _) => {}
        }
        match self.envelope {
            Some([value, radius]) => first += &format!(", at most {}", with_radius(value, radius)),
            None => first += ", without a bound: its sum over shells does not converge absolutely",
        }
        if let Some(start) = self.asymptotic_from {
            first += &format!(", asymptotic from R/Δ = {start:.1}");
        }
        let crossings = match &self.zero_crossings {
            None => return vec![first],
            Some(crossings) if crossings.is_empty() => format!("      no zero for {from} < R/Δ < {to}"),
            Some(crossings) => {
                let all: Vec<String> = crossings.iter().map(|[u, radius]| place(*u, *radius)).collect();
                format!("      zero at R/Δ = {}", all.join(", "))
            }
        };
        vec![first, crossings]
    }
}

fn short(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.6}") }
}

/// Three decimals, and the radius where it is seen in them.
fn place(value: f64, radius: f64) -> String {
    if radius < 5e-4 { format!("{value:.3}") } else { format!("{value:.3} ± {radius:.0e}") }
}

/// Six digits, or as many as the radius leaves.
fn with_radius(value: f64, radius: f64) -> String {
    if radius < value.abs() * 5e-7 { format!("{value:.5e}") } else { format!("{value:.3e} ± {radius:.0e}") }
}

/// Broken at spaces before column 100, further lines indented.
fn wrapped(text: &str) -> String {
    let indent = text.len() - text.trim_start().len() + 4;
    let mut lines = vec![" ".repeat(indent - 4)];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let blank = lines[last].trim().is_empty();
        if !blank && lines[last].chars().count() + word.chars().count() + 1 > WIDTH {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            let gap = if blank { "" } else { " " };
            lines[last] += &format!("{gap}{word}");
        }
    }
    lines.join("\n")
}
