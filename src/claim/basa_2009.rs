//! M. Basa, N. J. Quinlan & M. Lastiwka, Robustness and accuracy of SPH formulations for viscous flow, Int. J. Numer.
//! Meth. Fluids 60 (2009) 1127–1148: what its static part states.
//!
//! Constants are held to 2 %: the calibrated values of ξ are given to three digits and differ by 17 %.

use super::{Assertion, Direction, Published, Sign, Variable};

/// Cleary's ξ in Eq. (34), calibrated in a Couette flow.
pub const XI_CLEARY: f64 = 4.96333;
/// The ξ that the paper calibrates in a Poiseuille flow.
pub const XI_POISEUILLE: f64 = 4.24;
/// The factor of Eq. (33).
pub const MODEL_C_FACTOR: f64 = 8.0;
/// Δx/h of § 6.
pub const DX_OVER_H: f64 = 0.637;
/// The factor of Chaussonnet et al. (2015), Eq. (30), before 2 (d + 2): 1/π.
pub const CHAUSSONNET_FACTOR: f64 = std::f64::consts::FRAC_1_PI;

const SOURCE: &str = "basa-quinlan-lastiwka-2009";
/// Of constants.
const MARGIN: f64 = 0.02;
/// Of exponents, as for power laws.
const EXPONENT_MARGIN: f64 = 0.25;

/// The statements of the paper that can be checked without running a flow.
pub fn basa_2009() -> Vec<Assertion> {
    [equations(), pressure(), consistency(), second_derivatives(), models(), walls()].concat()
}

fn assertion(id: &str, location: &str, text: &str, published: Published) -> Assertion {
    Assertion {
        id: format!("basa-{id}"),
        source: SOURCE,
        location: location.into(),
        text: text.into(),
        published,
    }
}

fn relation(left: &'static str, sign: Sign, right: &'static str) -> Published {
    Published::Relation { left, sign, right }
}

fn constant(value: f64) -> Published {
    Published::Constant { value, unit: "1", margin: MARGIN }
}

fn order(of: Variable, value: f64) -> Published {
    Published::Order { of, value, margin: EXPONENT_MARGIN }
}

fn trend(of: &'static str, against: &'static str, direction: Direction) -> Published {
    Published::Trend { of, against, direction, margin: 0.1 }
}

fn equations() -> Vec<Assertion> {
    vec![
        assertion(
            "eq-5/uxx",
            "Eqs. (4)–(6)",
            "The coefficient of ∂²u/∂x² in Eq. (5) is that of Eq. (6), 4/3 μ",
            constant(4.0 / 3.0),
        ),
        assertion(
            "eq-5/vxy",
            "Eqs. (4)–(6)",
            "The coefficient of ∂²v/∂x∂y in Eq. (5) is that of Eq. (6), 1/3 μ",
            constant(1.0 / 3.0),
        ),
        assertion(
            "eq-4/uxx",
            "Eqs. (4), (6)",
            "The coefficient of ∂²u/∂x² in the divergence of Eq. (4) is that of Eq. (6), 4/3 μ",
            constant(4.0 / 3.0),
        ),
        assertion(
            "eq-36/start",
            "Eq. (36), §6.1",
            "The flow starts from a zero-velocity initial condition: Eq. (36) vanishes at t = 0",
            Published::Zero,
        ),
        assertion(
            "eq-36/wall",
            "Eq. (36), §6.1",
            "The walls at y = ±d are no-slip walls: Eq. (36) vanishes there at all times",
            Published::Zero,
        ),
        assertion(
            "eq-36/steady",
            "Eqs. (36), (37)",
            "As t → ∞ Eq. (36) becomes the parabola of Eq. (37)",
            Published::Zero,
        ),
        assertion(
            "6/neighbours",
            "§6",
            "Each particle has approximately 30 neighbours, itself counted, at Δx/h = 0.637",
            Published::Constant { value: 30.0, unit: "1", margin: 0.05 },
        ),
    ]
}

fn pressure() -> Vec<Assertion> {
    vec![
        assertion(
            "eq-15/h",
            "Eq. (15)",
            "The first error term scales with F_a/h at constant Δx/h and ξ",
            Published::Exponent { of: Variable::H, value: -1.0, margin: EXPONENT_MARGIN },
        ),
        assertion(
            "eq-15/dimension",
            "Eq. (15)",
            "With ξ the distance between a particle and the centroid of its volume, Eq. (15) scales with 1/length as a \
             derivative does",
            Published::Exponent { of: Variable::H, value: -1.0, margin: 0.0 },
        ),
        assertion(
            "eq-15/first-dx",
            "Eq. (15), first term",
            "The first error term is F_a/h ξ O(Δx/h)³",
            order(Variable::DxOverH, 3.0),
        ),
        assertion(
            "eq-15/first-xi",
            "Eq. (15), first term",
            "The first error term is of first order in ξ",
            order(Variable::Displacement, 1.0),
        ),
        assertion(
            "eq-15/second-dx",
            "Eq. (15), second term",
            "The second error term is F_a/h ξ²/2 O(Δx/h)⁴",
            order(Variable::DxOverH, 4.0),
        ),
        assertion(
            "eq-15/second-xi",
            "Eq. (15), second term",
            "The second error term is of second order in ξ",
            order(Variable::Displacement, 2.0),
        ),
        assertion(
            "eq-15/regular",
            "Eq. (15), last term",
            "On uniform particles the error of a derivative falls as O(Δx/h)^(β+2), cubic spline: β = 2",
            order(Variable::DxOverH, 4.0),
        ),
        assertion(
            "eq-15/regular-quintic",
            "Eq. (15), last term",
            "On uniform particles the error of a derivative falls as O(Δx/h)^(β+2), quintic spline: β = 4",
            order(Variable::DxOverH, 6.0),
        ),
        assertion(
            "eq-15/regular-wendland",
            "Eq. (15), last term",
            "On uniform particles the error of a derivative falls as O(Δx/h)^(β+2), Wendland C2: β = 3",
            order(Variable::DxOverH, 5.0),
        ),
        assertion(
            "eq-15/uniform",
            "Eq. (15)",
            "For uniformly distributed particles, ξ = 0, nothing is left of the terms that scale with F_a",
            Published::Zero,
        ),
        assertion(
            "3/value",
            "§3",
            "The error of a gradient grows with the absolute value of the function",
            trend("log error of ∇p", "log p₀", Direction::Rising),
        ),
        assertion(
            "3/h",
            "§3",
            "The sensitivity to function values is strongest when h is small",
            trend("log error of ∇p", "log h", Direction::Falling),
        ),
        assertion(
            "3/disorder",
            "§3",
            "The sensitivity to function values is strongest when the non-uniformity of the particles is high",
            trend("log error of ∇p", "log of the displacement", Direction::Rising),
        ),
        assertion(
            "eq-20/reduces",
            "§3, Eq. (20)",
            "Subtracting the local mean pressure reduces the error of ∇p",
            relation("error of ∇p with Eq. (20)", Sign::Less, "error without"),
        ),
        assertion(
            "eq-20/closer",
            "§3",
            "Subtracting the local mean brings pressure values closer to zero than a global method would",
            relation("rms of p − p_avg", Sign::Less, "rms of p − p_h"),
        ),
        assertion(
            "3/hydrostatic",
            "§3",
            "Subtracting the hydrostatic pressure reduces the error of ∇p",
            relation("error of ∇p without hydrostatic pressure", Sign::Less, "error with it"),
        ),
        assertion(
            "eq-17/constants",
            "§3, Eq. (17)",
            "The form with u_b − u_a takes the value of the function out: constants have no divergence",
            Published::Zero,
        ),
        assertion(
            "eq-18/constants",
            "§3, Eqs. (18), (19)",
            "The form of Watkins et al. takes the value of the function out: constants have no divergence",
            Published::Zero,
        ),
        assertion(
            "eq-18/better",
            "§3",
            "Eq. (18) gives better results than Eq. (17)",
            relation("error of Eq. (18)", Sign::Less, "error of Eq. (17)"),
        ),
        assertion(
            "eq-8/momentum",
            "§2.1.1",
            "The symmetric form of Eq. (8) conserves linear momentum",
            Published::Zero,
        ),
        assertion(
            "eq-9/momentum",
            "§2.1.1",
            "The symmetric form of Eq. (9) conserves linear momentum",
            Published::Zero,
        ),
        assertion(
            "eq-20/momentum",
            "§3",
            "With Eq. (20) momentum is no longer exactly conserved",
            relation("|Σ m a| / Σ |m a| with Eq. (20)", Sign::Greater, "rounding"),
        ),
    ]
}

fn consistency() -> Vec<Assertion> {
    let zero = |id, location, text| assertion(id, location, text, Published::Zero);
    vec![
        assertion(
            "4/regular",
            "§4",
            "Some operations of traditional SPH are not zero-order consistent even for regular particles",
            relation("h² |Σ V ∂²W/∂x²|", Sign::Greater, "rounding"),
        ),
        zero("eq-21/order-0", "Eq. (21)", "Shepard interpolation is exact for constants"),
        zero("eq-22/order-0", "Eq. (22)", "The corrected first derivative vanishes for constants"),
        zero("eq-23/order-0", "Eq. (23)", "The corrected second derivative vanishes for constants"),
        zero("eq-24/order-0", "Eqs. (24)–(26)", "The mixed correction vanishes for constants"),
        zero("eq-24/order-1", "Eqs. (24)–(26)", "The mixed correction is exact for linear functions"),
    ]
}

fn second_derivatives() -> Vec<Assertion> {
    let zero = |id, text| assertion(id, "§5.1", text, Published::Zero);
    vec![
        assertion("eq-28/form", "Eq. (28)", "∂²W/∂x_i∂x_j is that of Eq. (28)", Published::Zero),
        zero(
            "5.1/mixed-constants",
            "Where neighbours are mirrored at a coordinate plane, mixed second derivatives of a constant vanish",
        ),
        zero(
            "5.1/mixed-linear",
            "Where neighbours are mirrored at a coordinate plane, mixed second derivatives of linear functions vanish",
        ),
        assertion(
            "5.1/unmixed-symmetry",
            "§5.1",
            "There is no regular particle distribution for which the symmetry of the particles makes unmixed second \
             derivatives of a constant vanish",
            relation("invariants of ∂²/∂x² under the point group", Sign::Greater, "none"),
        ),
        assertion(
            "5.1/unmixed-never",
            "§5.1",
            "There is no regular particle distribution for which unmixed second derivatives of a constant vanish",
            relation("least h² |Σ V ∂²W/∂x²|, between two R/Δ of opposite signs", Sign::Greater, "zero"),
        ),
        zero(
            "5.1/first",
            "The first derivative of a constant vanishes on regular particles, also where they are not aligned with the axes",
        ),
        assertion(
            "5.1/interpolation",
            "§5.1",
            "The interpolation operation has no consistency bonus on regular particles",
            relation("|Σ V W − 1|", Sign::Greater, "rounding"),
        ),
        assertion(
            "5.1/second-worse",
            "§5.1",
            "Direct second derivatives are less accurate than first derivatives on regular particles",
            relation("error of ∂²u/∂y² on y²/2 and 1", Sign::Greater, "error of ∂u/∂y on y and 1"),
        ),
        assertion(
            "5.2/reach",
            "§5.2",
            "Two passes gather information from an area of twice the radius",
            Published::Ratio { value: 2.0, margin: 0.05 },
        ),
    ]
}

fn models() -> Vec<Assertion> {
    vec![
        assertion(
            "eq-33/factor",
            "Eq. (33)",
            "Model C is a viscous term with the factor 8",
            constant(MODEL_C_FACTOR),
        ),
        assertion(
            "eq-34/cleary",
            "Eq. (34)",
            "Model D is a viscous term with the recommended ξ = 4.96333",
            constant(XI_CLEARY),
        ),
        assertion(
            "eq-34/poiseuille",
            "§5.3",
            "Model D is a viscous term with ξ = 4.24, calibrated in a Poiseuille flow at Δx/h = 0.637",
            constant(XI_POISEUILLE),
        ),
        assertion(
            "5.3/discrepancy",
            "§5.3",
            "The two calibrated values of ξ differ by 17 %",
            Published::Ratio { value: 1.17, margin: 0.01 },
        ),
        assertion(
            "5.3/inaccurate",
            "§5.3",
            "ξ = 4.96333 gives highly inaccurate velocities, ξ = 4.24 much better ones",
            relation("viscosity error with 4.96333", Sign::Greater, "viscosity error with 4.24"),
        ),
        assertion(
            "5.3/steady",
            "§5.3",
            "ξ = 4.24 is what a steady Poiseuille flow of 20 particles across calibrates to",
            constant(XI_POISEUILLE),
        ),
        assertion("eq-33/linear", "§5.3", "Model C conserves linear momentum", Published::Zero),
        assertion("eq-33/angular", "§5.3", "Model C conserves angular momentum", Published::Zero),
        assertion("eq-35/linear", "§5.3", "Model E conserves linear momentum exactly", Published::Zero),
        assertion(
            "eq-35/angular",
            "§5.3",
            "Model E preserves angular momentum only approximately",
            relation("|Σ m r × a| / Σ |m r × a|", Sign::Greater, "rounding"),
        ),
        assertion(
            "5.3/convergence",
            "§5.3, of Graham & Hughes",
            "The viscous term of model E does not converge with more particles at constant Δx/h",
            trend("log viscosity error of model E", "log Δ", Direction::Constant),
        ),
        assertion(
            "6.1.3/c-d",
            "§6.1.3",
            "Model C gives some of the least accurate results, model D (ξ = 4.24) some of the best",
            relation("viscosity error of C", Sign::Greater, "viscosity error of D"),
        ),
        assertion(
            "6.1.3/c-e",
            "§6.1.3",
            "Model C gives some of the least accurate results, model E some of the best",
            relation("viscosity error of C", Sign::Greater, "viscosity error of E"),
        ),
        assertion(
            "6.1.3/b-accurate",
            "§6.1.3",
            "The accuracy of model B is very good",
            relation("viscosity error of B", Sign::Less, "viscosity error of C"),
        ),
        assertion(
            "6.1.3/a-shepard",
            "§6.1.3",
            "The zero-order correction makes model A more accurate",
            relation("error of A with Eq. (23)", Sign::Less, "error of A"),
        ),
        assertion(
            "6.1.3/over-fitted",
            "§6.1.3",
            "First-order corrections degrade model D: ξ was fitted to the uncorrected sums",
            relation("viscosity error of D, corrected", Sign::Greater, "uncorrected"),
        ),
    ]
}

fn walls() -> Vec<Assertion> {
    let at = "§6.1.2";
    vec![
        assertion(
            "6.1.2/mirroring-worst",
            at,
            "The worst results at flow start-up are obtained with mirroring",
            relation(
                "error of the viscous term with mirroring",
                Sign::Greater,
                "the largest with extrapolation",
            ),
        ),
        assertion(
            "6.1.2/mirroring-reduces",
            at,
            "With mirroring the viscous forces on particles near the wall are erroneously reduced at start-up",
            relation("viscous force with mirroring", Sign::Less, "exact viscous force"),
        ),
        assertion(
            "6.1.2/extrapolation-stronger",
            at,
            "At start-up particles react more strongly to the wall with extrapolation than with mirroring",
            relation(
                "viscous force with linear extrapolation",
                Sign::Greater,
                "viscous force with mirroring",
            ),
        ),
        assertion(
            "6.1.2/established",
            at,
            "The largest differences between wall treatments are found at the start; in established flow they are similar",
            relation("spread of the viscous term among wall treatments, parabola", Sign::Less, "at start-up"),
        ),
    ]
}
