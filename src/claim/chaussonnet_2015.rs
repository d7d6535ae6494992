//! G. Chaussonnet et al., Influence of particle disorder and smoothing length on SPH operator accuracy, SPHERIC 2015: what the
//! text, the equations and the fitted constants state about numbers.
//!
//! Margins, fixed before anything was measured: ±0.05 on exponents of h and η (the paper's own fits of one law scatter by
//! 0.06); ±0.02 on those of K_x; ±10 % on a fit's value inside its range; n % lower is 1 − n/100 ± 0.02, ≈ n % ± 0.05; factors
//! ±5 %; "two orders" is a decadic logarithm of 2 ± 1/2.

use super::{Assertion, Direction, Published, Sign, Variable};

const SOURCE: &str = "chaussonnet-2015";
const EXPONENT: f64 = 0.05;

/// One of Eqs. (25)–(29), (36), (37): Λ or Ω = a₁ h^a₂ η^a₃ K_x^a₄, lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedFit {
    /// The equation.
    pub equation: u8,
    /// Id of the operator as it is printed.
    pub operator: &'static str,
    /// The field: `F0`, `U1`.
    pub field: &'static str,
    /// a₁, in m to the power −a₂.
    pub prefactor: f64,
    /// a₂.
    pub h: f64,
    /// a₃.
    pub eta: f64,
    /// a₄.
    pub scale: f64,
}

impl PublishedFit {
    /// Its value.
    pub fn value(&self, h: f64, eta: f64, scale: f64) -> f64 {
        self.prefactor * libm::pow(h, self.h) * libm::pow(eta, self.eta) * libm::pow(scale, self.scale)
    }
}

/// The fits.
pub const FITS: [PublishedFit; 7] = [
    fit(25, "G0", "F0", 3.12e-3, [-1.03, 0.985, -0.0857]),
    fit(26, "G+", "F0", 6.11e-3, [-1.04, 0.987, -0.0848]),
    fit(27, "G0", "F1", 4.36e-3, [-0.941, 0.988, -0.0847]),
    fit(28, "G+", "F1", 9.12e-3, [-0.936, 0.989, -0.0854]),
    fit(29, "G-", "F1", 1.70e-1, [-0.0406, 1.15, -0.0903]),
    fit(36, "MCG-pi", "U1", 8.89e-3, [-1.01, 0.979, -0.0844]),
    fit(37, "MEA", "U1", 6.07e-3, [-1.03, 0.986, -0.0849]),
];

const fn fit(
    equation: u8,
    operator: &'static str,
    field: &'static str,
    prefactor: f64,
    [h, eta, scale]: [f64; 3],
) -> PublishedFit {
    PublishedFit { equation, operator, field, prefactor, h, eta, scale }
}

/// A statement of the text.
struct Statement {
    id: &'static str,
    location: &'static str,
    text: &'static str,
    published: Published,
}

/// The statement with this id, which is one of [`ids`].
pub fn assertion(id: &str) -> Assertion {
    all()
        .into_iter()
        .find(|assertion| assertion.id == id)
        .unwrap_or_else(|| unreachable!("'{id}' is not among the statements of the paper"))
}

/// The statement with this id about the number `value`, which depends on the case.
pub fn assertion_of(id: &str, value: f64) -> Assertion {
    let mut assertion = assertion(id);
    if let Published::Constant { value: published, .. } = &mut assertion.published {
        *published = value;
    }
    assertion
}

/// The ids of all statements.
pub fn ids() -> Vec<String> {
    all().into_iter().map(|assertion| assertion.id).collect()
}

/// All statements.
pub fn all() -> Vec<Assertion> {
    let plain = [setup(), consistency(), gradients(), laplacians()].into_iter().flatten();
    let plain = plain.map(|statement| Assertion {
        id: format!("chaussonnet-{}", statement.id),
        source: SOURCE,
        location: statement.location.into(),
        text: statement.text.into(),
        published: statement.published,
    });
    plain.chain(FITS.iter().flat_map(of_fit)).collect()
}

/// What a fit states: its exponents, and its value where it was fitted.
fn of_fit(fit: &PublishedFit) -> [Assertion; 4] {
    let assertion = |what: &str, text: String, published| Assertion {
        id: format!("chaussonnet-fit-{}/{what}", fit.equation),
        source: SOURCE,
        location: format!("Eq. ({})", fit.equation),
        text,
        published,
    };
    let error = if fit.field.starts_with('F') { "Λ" } else { "Ω" };
    let name = format!("{error}_x({}) on {}", fit.operator, fit.field);
    let power = |of, value| Published::Exponent { of, value, margin: EXPONENT };
    [
        assertion("h", format!("{name} ~ h^{}", fit.h), power(Variable::H, fit.h)),
        assertion("eta", format!("{name} ~ η^{}", fit.eta), power(Variable::Displacement, fit.eta)),
        assertion(
            "field-scale",
            format!("{name} ~ K_x^{}", fit.scale),
            Published::Constant { value: fit.scale, unit: "1", margin: 0.02 / fit.scale.abs() },
        ),
        assertion(
            "level",
            format!("{name} as fitted, inside the range of the fit"),
            Published::Constant { value: 0.0, unit: "1", margin: 0.1 },
        ),
    ]
}

fn constant(value: f64, margin: f64) -> Published {
    Published::Constant { value, unit: "1", margin }
}

fn exponent(of: Variable, value: f64) -> Published {
    Published::Exponent { of, value, margin: EXPONENT }
}

fn ratio(value: f64) -> Published {
    Published::Ratio { value, margin: 0.05 }
}

/// n % lower, to within `points` percentage points.
fn lower_by(percent: f64, points: f64) -> Published {
    let value = 1.0 - percent / 100.0;
    Published::Ratio { value, margin: points / 100.0 / value }
}

fn less(left: &'static str, right: &'static str) -> Published {
    Published::Relation { left, sign: Sign::Less, right }
}

fn greater(left: &'static str, right: &'static str) -> Published {
    Published::Relation { left, sign: Sign::Greater, right }
}

fn setup() -> Vec<Statement> {
    let s = |id, location, text, published| Statement { id, location, text, published };
    vec![
        s(
            "setup/neighbours",
            "§II.C",
            "The average number of neighbours is 29, 37 and 123 for 2-D Cartesian, 2-D triangular and 3-D Cartesian.",
            constant(29.0, 0.02),
        ),
        s("setup/distance-least", "§II.A", "The minimum of d/Δ is 1 − 2η.", constant(1.0, 0.01)),
        s("setup/distance-largest", "§II.A", "The maximum of d/Δ is 1 + 2η.", constant(1.0, 0.01)),
        s("setup/distance-mean", "§II.A", "The mean of d/Δ is 1.", constant(1.0, 0.005)),
        s("setup/distance-deviation", "§II.A", "The standard deviation of d/Δ is ≈ η.", constant(1.0, 0.05)),
    ]
}

fn consistency() -> Vec<Statement> {
    let s = |id, location, text, published| Statement { id, location, text, published };
    let constant_in_h =
        |of| Published::Trend { of, against: "ln h", direction: Direction::Constant, margin: EXPONENT };
    vec![
        s(
            "consistency/regular",
            "§III.C.1",
            "On regular particles all E are equal to 10⁻²⁰: the four consistencies are retrieved.",
            Published::Zero,
        ),
        s(
            "consistency/h-independent",
            "§III.C.1, Fig. 4",
            "The E are independent of h.",
            constant_in_h("ln E"),
        ),
        s(
            "consistency/C01-diverges",
            "§III.C.1, §III.D",
            "Without h the error of C_0^1 scales as 1/h.",
            exponent(Variable::H, -1.0),
        ),
        s(
            "consistency/C10-recovered",
            "§III.C.1, §III.D, §VI",
            "C_1^0 is recovered in proportion to h.",
            exponent(Variable::H, 1.0),
        ),
        s(
            "consistency/linear-in-eta",
            "§III.C.2, Fig. 5",
            "The E are proportional to η.",
            exponent(Variable::Displacement, 1.0),
        ),
        s(
            "consistency/E11-largest",
            "§III.C",
            "E_1^1 is larger than the other errors.",
            greater("E_1^1", "the largest of E_0^0, E_0^1, E_1^0"),
        ),
        s(
            "consistency/same-in-2d",
            "§III.C.2",
            "E_0^0, E_0^1 and E_1^0 are the same on the Cartesian and the triangular lattice.",
            ratio(1.0),
        ),
        s(
            "consistency/smaller-in-3d",
            "§III.C.2",
            "E_0^0 is slightly smaller in 3-D.",
            less("E_0^0 in 3-D", "E_0^0 in 2-D"),
        ),
        s(
            "consistency/same-trend",
            "§III.C.1",
            "E_0^1 and E_1^0 follow the trend of E_0^0: one ratio at every η.",
            Published::Trend {
                of: "ln of the ratio to E_0^0",
                against: "ln η",
                direction: Direction::Constant,
                margin: EXPONENT,
            },
        ),
    ]
}

fn gradients() -> Vec<Statement> {
    let s = |id, location, text, published| Statement { id, location, text, published };
    vec![
        s(
            "gradient/similar-in-2d",
            "§IV.E.1, Fig. 6a",
            "2-D Cartesian and triangular lattices have very similar errors.",
            ratio(1.0),
        ),
        s(
            "gradient/3d-lower",
            "§IV.E.1, Fig. 6b",
            "3-D errors are ≈ 15 % lower than 2-D ones.",
            lower_by(15.0, 5.0),
        ),
        s(
            "gradient/trend-h",
            "§IV.E.1",
            "All lattices have the same trend: Λ of G0 and G+ is proportional to 1/h.",
            exponent(Variable::H, -1.0),
        ),
        s(
            "gradient/trend-eta",
            "§IV.E.1",
            "All lattices have the same trend: Λ of G0 and G+ is proportional to η.",
            exponent(Variable::Displacement, 1.0),
        ),
        s(
            "gradient/directivity",
            "§IV.E.2, Fig. 7",
            "The deviation is the same in all directions, Λ_y = Λ_x.",
            ratio(1.0),
        ),
        s(
            "gradient/regular-constant",
            "§IV.E.3, Fig. 8b",
            "At η = 0 no operator deviates on a constant field.",
            Published::Zero,
        ),
        s(
            "gradient/falls-with-scale",
            "§IV.E.3, Fig. 8c",
            "Λ decreases slightly as K_x increases.",
            Published::Trend { of: "ln Λ", against: "ln K_x", direction: Direction::Falling, margin: 0.02 },
        ),
        s(
            "gradient/factor-2-constant",
            "Eqs. (18), (19)",
            "G+ deviates twice as much as G0 on a constant field.",
            Published::Ratio { value: 2.0, margin: 1e-9 },
        ),
        s(
            "gradient/factor-2-linear",
            "§IV.E.3, §IV.F",
            "G+ deviates twice as much as G0 on a linear field.",
            ratio(2.0),
        ),
        s("gradient/factor-2-quadratic", "§IV.E.5", "Λ²(G+) ≈ 2 Λ²(G0) on a quadratic field.", ratio(2.0)),
        s(
            "gradient/minus-constant",
            "§IV.A, §IV.E.3",
            "G− takes the gradient of a constant as zero.",
            Published::Zero,
        ),
        s(
            "gradient/minus-h",
            "§IV.E.4",
            "h has no influence on G−.",
            Published::Trend {
                of: "ln Λ",
                against: "ln h",
                direction: Direction::Constant,
                margin: EXPONENT,
            },
        ),
        s(
            "gradient/minus-small-eta",
            "§IV.E.4",
            "G− does not deviate but for large disorder or strong gradients.",
            Published::Zero,
        ),
        s(
            "gradient/minus-two-orders",
            "§VI",
            "G− is two orders of magnitude better than G0 and G+: log₁₀ of the ratio.",
            constant(2.0, 0.25),
        ),
        s(
            "gradient/quadratic-lower",
            "§IV.E.5",
            "Errors on a quadratic field are slightly lower than on a linear one.",
            less("Λ²", "Λ¹"),
        ),
        s("gradient/momentum-plus", "§IV.A", "G+ conserves linear momentum: f_ab = −f_ba.", Published::Zero),
        s(
            "gradient/momentum-others",
            "§IV.A, §IV.F",
            "G− and G0 do not conserve linear momentum.",
            greater("|Σ V ∇φ| / Σ |V ∇φ| on an open cloud", "what rounding explains"),
        ),
        s(
            "gradient/walls",
            "§II.C",
            "Inner particles feel no influence of the wall particles.",
            Published::Zero,
        ),
    ]
}

fn laplacians() -> Vec<Statement> {
    let s = |id, location, text, published| Statement { id, location, text, published };
    vec![
        s(
            "laplacian/prefactor",
            "§V.A.1, Eq. (30)",
            "1/π matches the analytical Laplacian: the bare sum multiplies u″ by π.",
            constant(std::f64::consts::PI, 0.02),
        ),
        s(
            "laplacian/constant",
            "§V.D.3",
            "The Laplacian of a constant field is always zero.",
            Published::Zero,
        ),
        s(
            "laplacian/regular-linear",
            "§V.D.4",
            "Without disorder both Laplacians are exact on a linear field.",
            Published::Zero,
        ),
        s("laplacian/MEA-y", "§V.D.2, Fig. 12", "The y component of MEA is zero.", Published::Zero),
        s(
            "laplacian/MCG-y",
            "§V.D.2, Fig. 12",
            "MCG has the same order of magnitude in both directions.",
            greater("Ω_y/Ω_x of MCG", "10^(−1/2)"),
        ),
        s(
            "laplacian/linear-h",
            "§V.D.4, Fig. 13a",
            "Ω¹ is proportional to 1/h.",
            exponent(Variable::H, -1.0),
        ),
        s(
            "laplacian/linear-eta",
            "§V.D.4, Fig. 13b",
            "Ω¹ is proportional to η.",
            exponent(Variable::Displacement, 1.0),
        ),
        s(
            "laplacian/falls-with-scale",
            "§V.D.4, §V.D.5",
            "Ω decreases slightly as K_x increases.",
            Published::Trend { of: "ln Ω", against: "ln K_x", direction: Direction::Falling, margin: 0.02 },
        ),
        s(
            "laplacian/18-percent",
            "§V.D.4",
            "On a linear field the error of MEA is 18 % lower than that of MCG.",
            lower_by(18.0, 2.0),
        ),
        s(
            "laplacian/17-percent",
            "§V.D.5",
            "On a quadratic field the error of MEA is 17 % lower than that of MCG.",
            lower_by(17.0, 2.0),
        ),
        s(
            "laplacian/20-percent",
            "§V.E",
            "On linear and quadratic fields the error of MEA is ≈ 20 % lower.",
            lower_by(20.0, 5.0),
        ),
        s(
            "laplacian/30-percent",
            "§VI",
            "The error of MEA is generally 30 % lower than that of MCG.",
            lower_by(30.0, 5.0),
        ),
        s(
            "laplacian/3d-lower",
            "§V.D.1, Fig. 11b",
            "3-D errors are ≈ 20 % lower than 2-D ones.",
            lower_by(20.0, 5.0),
        ),
        s(
            "laplacian/equal-on-triangles",
            "§V.E",
            "On triangular lattices and linear fields MEA and MCG deliver the same error.",
            ratio(1.0),
        ),
        s(
            "laplacian/MCG-worse-on-triangles",
            "§V.D.1, Fig. 11a",
            "On quadratic fields MCG deviates more on triangular than on Cartesian lattices.",
            greater("Ω²(MCG) on triangles", "Ω²(MCG) on squares"),
        ),
        s(
            "laplacian/MCG-above-MEA-on-triangles",
            "§V.E",
            "On triangular lattices and quadratic fields MCG is worse than MEA for η < 10⁻².",
            greater("Ω²(MCG)", "Ω²(MEA)"),
        ),
        s(
            "laplacian/regular-quadratic",
            "§V.D.5, Fig. 14b",
            "On regular lattices neither is exact on a quadratic field.",
            greater("Ω² at η = 0", "what rounding explains"),
        ),
        s(
            "laplacian/eta-lost-at-low",
            "§V.D.5, Fig. 14b",
            "On a quadratic field linearity in η is lost at low disorder.",
            less("d ln Ω²/d ln η at the lowest η", "1/2"),
        ),
        s(
            "laplacian/h-lost-at-strong",
            "§V.D.5, Fig. 14a",
            "On a quadratic field proportionality to 1/h is lost for a strong disorder, not for a weak one.",
            greater("|1 + d ln Ω²/d ln h| at the largest η", "that at the lowest η"),
        ),
        s("laplacian/angular-MCG", "§V.A.1", "MCG conserves angular momentum.", Published::Zero),
        s(
            "laplacian/angular-MEA",
            "§V.A.2",
            "MEA does not conserve angular momentum.",
            greater("|Σ V r × Δv| / Σ |V r × Δv| on an open cloud", "what rounding explains"),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_statement_has_its_own_id() {
        let mut ids = ids();
        let count = ids.len();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), count);
    }

    #[test]
    fn fits_are_evaluated_as_printed() {
        // 3.12e-3 · (1e-3)^-1.03 · 0.01^0.985, by logarithms: −2.50585 + 3.09 − 1.97 = −1.38585.
        assert!((FITS[0].value(1e-3, 0.01, 1.0) - 0.041_130).abs() < 1e-5);
    }
}
