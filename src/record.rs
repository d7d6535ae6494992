//! The report as a record: what `report.json` holds, field by field. JSON is the source, every other form is a view.
//!
//! Schema `remainder-report/1`. Later versions only add: what is optional here may be missing, and a reader ignores what
//! it does not know under `case`.

pub use crate::claim::Verdict;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// The value of `schema`.
pub const SCHEMA: &str = "remainder-report/1";

/// One analysis: where it came from, what was claimed, derived and measured, and the verdicts.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Always `remainder-report/1`.
    pub schema: String,
    /// What made the report; nothing in it changes from run to run of the same scene.
    pub provenance: Provenance,
    /// One entry per claim and case.
    pub claims: Vec<ClaimEntry>,
    /// One entry per claim: its verdict over all cases.
    pub verdicts: Vec<RolledVerdict>,
    /// The fits behind the measured exponents, with every point.
    pub fits: Vec<Fit>,
    /// Data for figures.
    pub series: Vec<Series>,
    /// What the plan left out because the scene does not need it.
    pub left_out: Vec<LeftOut>,
    /// What was computed, counted.
    pub cost: Cost,
    /// Time-dependent runs, where the scene has any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<TimeRun>,
    /// The constants of viscous models.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub viscosity_constants: Vec<ViscosityConstant>,
    /// By what bare Laplacians multiply u″.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub laplacian_factors: Vec<LaplacianFactor>,
    /// Sizes of a domain that a paper does not print, inferred from its fits.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inferred_domain_size: Vec<InferredDomainSize>,
    /// Other tables, each a list of rows with one set of keys.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tables: BTreeMap<String, Vec<BTreeMap<String, Value>>>,
}

/// The factor that makes a viscous model consistent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViscosityConstant {
    /// `C`, `D`, `MCG`.
    pub model: String,
    /// D, a whole number.
    pub dimension: u8,
    /// Id of the kernel.
    pub kernel: String,
    /// Id of the lattice, or `continuum`.
    pub lattice: String,
    /// Δ/h, a pure number; 0 in the continuum.
    pub dx_over_h: f64,
    /// `constant` or `number-density`.
    pub volume_rule: String,
    /// Whether 0.01 h² is added to r².
    pub regularised: bool,
    /// `shear-axis`, `shear-diagonal`, `compression`.
    pub direction: String,
    /// What it should be, a pure number.
    pub derived: f64,
    /// What is printed, a pure number.
    pub published: f64,
}

/// The factor by which the bare sum of a Laplacian multiplies u″ on the quadratic field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaplacianFactor {
    /// Id of the operator.
    pub operator: String,
    /// D, a whole number.
    pub dimension: u8,
    /// Id of the lattice.
    pub lattice: String,
    /// h/Δ, a pure number.
    pub h_over_dx: f64,
    /// `constant` or `number-density`.
    pub volume_rule: String,
    /// In the continuum, a pure number.
    pub continuum: f64,
    /// On the lattice, a pure number.
    pub lattice_value: f64,
    /// What is printed, a pure number.
    pub published: f64,
}

/// The size of a domain as one of a paper's fits implies it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InferredDomainSize {
    /// Which fit.
    pub fit: String,
    /// In metres.
    pub value_m: f64,
    /// Lower end of the interval, in metres.
    pub low: f64,
    /// Upper end, in metres.
    pub high: f64,
}

/// What made a report.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Name of the scene.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// SHA-256 of the scene's canonical form, in hexadecimal.
    pub scene_sha256: String,
    /// Seed of all random numbers, a whole number.
    pub seed: u64,
    /// Cargo features the program was built with.
    pub features: Vec<String>,
    /// Whether this was a first look with shortened ladders.
    pub quick: bool,
}

/// The kinds of claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ClaimKind {
    /// A quantity follows powers of d̃, h and Δ/h.
    PowerLaw,
    /// A quantity has a value.
    Constant,
    /// Two quantities stand in a ratio.
    Ratio,
    /// A quantity vanishes.
    Zero,
    /// A quantity rises, falls or stays.
    Trend,
    /// One quantity is smaller than another.
    Inequality,
}

/// One claim in one case, published, derived and measured side by side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClaimEntry {
    /// For example `fatehi-table-2/sum_dw#disorder`.
    pub id: String,
    /// What kind of statement it is.
    pub kind: ClaimKind,
    /// Where it is printed.
    pub citation: Citation,
    /// The statement in words.
    pub statement: String,
    /// For what it was checked.
    pub case: Case,
    /// As printed.
    pub published: Option<Column>,
    /// From algebra.
    pub derived: Option<Column>,
    /// From particles.
    pub measured: Option<Column>,
    /// Margin of the equivalence test, in the unit of what is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// The comparison.
    pub verdict: Verdict,
    /// Its reason, in one sentence.
    pub why: String,
}

/// Where a statement is printed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Citation {
    /// Key in `references.bib`, or `scene`.
    pub source: String,
    /// Equation, table, section.
    pub location: String,
}

/// What a claim was checked for. Fields that do not apply are missing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Case {
    /// `lattice` or `cloud`.
    pub source: String,
    /// D, a whole number.
    pub dimension: u8,
    /// Id of the kernel.
    pub kernel: String,
    /// Id of the lattice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lattice: Option<String>,
    /// `MODEL:AMPLITUDE[,key=value…]`, or `none`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disorder: Option<String>,
    /// `constant` or `number-density`.
    pub volume_rule: String,
    /// Everything else that tells cases apart: operator, file, particles, integrator, ….
    #[serde(flatten)]
    pub more: BTreeMap<String, Value>,
}

/// One of the three columns.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Column {
    /// Exponents of a power law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exponents: Option<Exponents>,
    /// A constant or a ratio, in the unit of the next field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Estimate>,
    /// Unit of `value`, `1` for a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Whether something vanishes, and by what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zero: Option<Zero>,
    /// A trend.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trend: Option<Trend>,
    /// An inequality.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relation: Option<Relation>,
    /// Ids of the fits behind the numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fits: Vec<String>,
    /// Of a derived order: what it comes from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
}

/// Exponents of a power law by what it is a power of.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exponents {
    /// Of d̃, the amplitude of the displacement; a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Estimate>,
    /// Of h; a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub h: Option<Estimate>,
    /// Of Δ/h; a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dx_over_h: Option<Estimate>,
    /// Of Δ at constant h/Δ; a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dx: Option<Estimate>,
    /// Of the time step; a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dt: Option<Estimate>,
}

/// A number with its interval; exact numbers are "p/q".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// The number, in the unit of what holds the estimate: a pure number unless that says otherwise.
    pub value: Number,
    /// Lower end of the interval, in the unit of `value`.
    pub low: Number,
    /// Upper end of the interval, in the unit of `value`.
    pub high: Number,
    /// Where it comes from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<Source>,
}

/// Where a number comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Printed in a paper.
    Print,
    /// Derived.
    Derivation,
    /// Fitted to measurements.
    Fit,
    /// Not fitted: it follows from the scaling of all lengths, or from the quantity not depending on it.
    Identity,
    /// Exact arithmetic on particles.
    Exact,
}

/// An exact rational as "p/q", or a floating-point number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Number {
    /// Floating point.
    Float(f64),
    /// "p/q" or "p".
    Rational(String),
}

/// Whether something vanishes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zero {
    /// Whether it does.
    pub holds: bool,
    /// `symmetry` if the site's point group forces it, `value` if it happens to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// The largest magnitude found, in the unit of what vanishes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<f64>,
}

/// A quantity that rises, falls or stays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trend {
    /// The quantity.
    pub of: String,
    /// What it depends on.
    pub against: String,
    /// `rising`, `falling` or `constant`.
    pub direction: String,
    /// The measured slope, in the unit of `of` over the unit of `against`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<Estimate>,
}

/// An inequality.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Relation {
    /// Left side in words.
    pub left: String,
    /// `<`, `≤`, `=`, `≥`, `>`.
    pub sign: String,
    /// Right side in words.
    pub right: String,
    /// Whether it holds.
    pub holds: bool,
    /// Value of the left side, in the unit of the right side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_value: Option<Estimate>,
    /// Value of the right side, in the unit of the left side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_value: Option<Estimate>,
}

/// A claim's verdict over all its cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RolledVerdict {
    /// The claim.
    pub id: String,
    /// The verdict.
    pub verdict: Verdict,
    /// What it depends on, or why.
    pub why: String,
    /// What the scene expects, if it says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<Verdict>,
    /// How many cases, a count.
    pub cases: usize,
}

/// A power-law fit along a ladder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// Unique in the report.
    pub id: String,
    /// What was fitted.
    pub quantity: String,
    /// For what.
    pub case: Case,
    /// What the ladder varies.
    pub varies: String,
    /// What it holds.
    pub held: BTreeMap<String, String>,
    /// The abscissa.
    pub x: Axis,
    /// The ordinate.
    pub y: Axis,
    /// Every point, kept or left out and why; each number in the unit of its axis.
    pub points: Vec<FitPoint>,
    /// The exponent, a pure number.
    pub slope: Estimate,
    /// ln of the prefactor, a pure number: y in the unit of its axis.
    pub intercept: Estimate,
    /// Residual standard deviation of ln y, a pure number.
    pub residual_sd: f64,
    /// Kept points minus two, a whole number.
    pub degrees_of_freedom: usize,
    /// Coverage of the intervals, a pure number from 0 to 1.
    pub coverage: f64,
    /// How the interval was made.
    pub interval: String,
}

/// One rung of a ladder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitPoint {
    /// Abscissa, in the unit of the x axis.
    pub x: f64,
    /// Ordinate: the envelope or the root mean square, in the unit of the y axis.
    pub y: f64,
    /// Standard error of y, for sampled quantities, in the unit of the y axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_error: Option<f64>,
    /// Mean of the norm over the samples, in the unit of the y axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Largest norm over the samples, in the unit of the y axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Samples taken, a count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u64>,
    /// R/Δ at which the envelope was reached, a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support_over_dx: Option<f64>,
    /// Whether the fit uses it.
    pub kept: bool,
    /// Why not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Residual of ln y, a pure number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
}

/// An axis of a fit or a figure.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// As in the paper.
    pub name: String,
    /// Unit, `1` for a pure number.
    pub unit: String,
    /// Whether it is logarithmic.
    pub log: bool,
}

/// Data of one figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Series {
    /// Unique in the report.
    pub id: String,
    /// The figure of the paper that it belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure: Option<String>,
    /// The abscissa.
    pub x: Axis,
    /// The ordinate.
    pub y: Axis,
    /// The lines.
    pub lines: Vec<Line>,
}

/// One line of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Name in the legend.
    pub name: String,
    /// Points as \[x, y\] or \[x, y, error of y\], each number in the unit of its axis.
    pub points: Vec<Vec<f64>>,
}

/// Something not computed because the scene does not need it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
    /// What that saved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saved: Option<String>,
}

/// What was computed, counted; the same on every run of the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Exact sums over a support, one per component: a count.
    pub exact_sums: u64,
    /// Disordered neighbourhoods, a count.
    pub samples: u64,
    /// Pairs for which the kernel was evaluated in floating point, a count.
    pub pairs: u64,
}

/// One time-dependent run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeRun {
    /// Operator.
    pub scheme: String,
    /// Particles a side, a count.
    pub n: u64,
    /// h/Δ, a pure number.
    pub h_over_dx: f64,
    /// Randomness factor, a pure number.
    pub epsilon: f64,
    /// Time integrator.
    pub integrator: String,
    /// Boundary treatment.
    pub boundary: String,
    /// L2 error, a pure number: temperatures are without unit.
    pub l2: f64,
    /// L∞ error, a pure number.
    pub linf: f64,
    /// Conservation error, a pure number.
    pub ec: f64,
    /// Time steps, a count.
    pub steps: u64,
}

impl Estimate {
    /// A number known without error.
    pub fn exact(value: impl Into<String>, by: Source) -> Self {
        let value = Number::Rational(value.into());
        Self { value: value.clone(), low: value.clone(), high: value, by: Some(by) }
    }

    /// A measured number.
    pub fn float(value: f64, low: f64, high: f64, by: Source) -> Self {
        Self { value: Number::Float(value), low: Number::Float(low), high: Number::Float(high), by: Some(by) }
    }
}

/// The number with `digits` significant digits: what passed through statrs or nalgebra's factorisations may differ in its
/// last bits from one processor to another, so reports keep eight.
pub fn significant(value: f64, digits: usize) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // The shortest way to a decimal rounding that is the same everywhere: print and read.
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}
