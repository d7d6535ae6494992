//! R. Fatehi & M. T. Manzari (2011), §6: what is said of the heat problem.

use super::{Assertion, Direction, Published, Sign, Variable};

const SOURCE: &str = "fatehi-manzari-2011";

fn statement(id: String, location: &str, text: String, published: Published) -> Assertion {
    Assertion { id: format!("fatehi-heat/{id}"), source: SOURCE, location: location.into(), text, published }
}

/// Which statement of §6.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatStatement {
    /// §6.1: S3 behaves like a first-order method at h = 3Δ and 3.5Δ.
    FirstOrderS3(f64),
    /// §6.1: S3 is virtually constant for h ≤ 2Δ.
    FlatS3(f64),
    /// §6.1: S3 is best at h = 2Δ.
    BestS3Regular,
    /// §6.1: S4 performs near second order for all radii.
    SecondOrderS4(f64),
    /// §6.1: errors of S4 are two to three orders lower: at least a hundred times.
    TwoOrdersLower,
    /// §6.1: EC follows the same pattern as the other norms (S3, S4).
    SamePattern(&'static str, f64),
    /// §6.1: at h = 1.5Δ a particle has 8 neighbours.
    EightNeighbours,
    /// §6.3: S4 at h = 1.5Δ is at least two orders better than S3 at 3.5Δ, N = 160².
    CheapAndBetter,
    /// Eqs. (49), (50): the error of S3 at large radii goes with h², that is with (h/Δ)² at constant Δ.
    GrowsWithRadius(&'static str),
    /// §6.2: of S3 on irregular particles h = 1.5Δ is the worst.
    WorstS3Irregular,
    /// §6.2: all other radii of S3 converge with about unity.
    UnityS3Irregular(f64),
    /// §6.2: of S3 on irregular particles h = 2.5Δ is the best.
    BestS3Irregular,
    /// §6.2: the best S3 has higher errors than the worst S4.
    BestS3WorseThanWorstS4,
    /// §6.2: S4 approximately obeys second order, h = 3Δ and 3.5Δ.
    SecondOrderS4Irregular(f64),
    /// §6.2: the behaviour of S4 changes little with ε.
    LittleChangeWithEpsilon,
    /// §6.2: two particles come nearer by 0.28Δ at most.
    Approach,
    /// §6.3: S4 takes 856/233 of the time of S3 at h = 3.5Δ, N = 160².
    CostOfS4,
    /// §6.3: S4 at h = 1.5Δ takes 239/233 of the time of S3 at 3.5Δ.
    CostOfSmallS4,
}

impl HeatStatement {
    /// All of them, for the radii h/Δ that the paper names.
    pub fn all() -> Vec<Self> {
        let mut all =
            vec![Self::FirstOrderS3(3.0), Self::FirstOrderS3(3.5), Self::FlatS3(1.5), Self::FlatS3(2.0)];
        let radii = [1.5, 2.0, 2.5, 3.0, 3.5];
        all.push(Self::BestS3Regular);
        all.extend(radii.map(Self::SecondOrderS4));
        all.push(Self::TwoOrdersLower);
        all.extend(radii.map(|h| Self::SamePattern("S3", h)));
        all.extend(radii.map(|h| Self::SamePattern("S4", h)));
        all.extend([Self::EightNeighbours, Self::CheapAndBetter]);
        all.extend([Self::GrowsWithRadius("S3"), Self::GrowsWithRadius("S4")]);
        all.push(Self::WorstS3Irregular);
        all.extend([2.0, 2.5, 3.0, 3.5].map(Self::UnityS3Irregular));
        all.extend([Self::BestS3Irregular, Self::BestS3WorseThanWorstS4]);
        all.extend([3.0, 3.5].map(Self::SecondOrderS4Irregular));
        all.extend([Self::LittleChangeWithEpsilon, Self::Approach, Self::CostOfS4, Self::CostOfSmallS4]);
        all
    }

    /// The statement with its citation.
    pub fn assertion(self) -> Assertion {
        let order = |value, margin| Published::Exponent { of: Variable::Dx, value, margin };
        let less = |left, right| Published::Relation { left, sign: Sign::Less, right };
        match self {
            Self::FirstOrderS3(h) => statement(
                format!("S3-first-order#h{h}"),
                "Sec. 6.1, Fig. 1 (left)",
                format!("for h = {h}Δ scheme S3 behaves like a first-order method, with a constant slope"),
                order(1.0, 0.25),
            ),
            Self::FlatS3(h) => statement(
                format!("S3-flat#h{h}"),
                "Sec. 6.1, Fig. 1 (left)",
                format!("for h = {h}Δ ≤ 2Δ the error of scheme S3 is virtually constant"),
                Published::Trend {
                    of: "L2 of S3",
                    against: "Δ",
                    direction: Direction::Constant,
                    margin: 0.25,
                },
            ),
            Self::BestS3Regular => statement(
                "S3-best#regular".into(),
                "Sec. 6.1, Fig. 1 (left)",
                "the best result of scheme S3 is obtained with h = 2Δ".into(),
                less("L2 of S3 at h = 2Δ", "the least L2 of S3 at any other radius"),
            ),
            Self::SecondOrderS4(h) => statement(
                format!("S4-second-order#h{h}"),
                "Sec. 6.1, Fig. 1 (right)",
                format!("scheme S4 performs near second order (h = {h}Δ)"),
                order(2.0, 0.25),
            ),
            Self::TwoOrdersLower => statement(
                "S4-two-orders-lower".into(),
                "Sec. 6.1, Fig. 1",
                "the errors of scheme S4 are 2 to 3 orders lower than those of S3".into(),
                Published::Relation { left: "L2 of S3 over L2 of S4", sign: Sign::Greater, right: "100" },
            ),
            Self::SamePattern(scheme, h) => statement(
                format!("EC-same-pattern#{scheme},h{h}"),
                "Sec. 6.1, Fig. 1 (bottom)",
                format!(
                    "the conservation error of {scheme} follows the same pattern as the other norms (h = {h}Δ)"
                ),
                Published::Trend {
                    of: "EC over L2",
                    against: "Δ",
                    direction: Direction::Constant,
                    margin: 0.25,
                },
            ),
            Self::EightNeighbours => statement(
                "eight-neighbours".into(),
                "Sec. 6.1",
                "at h = 1.5Δ the computation is done with only 8 neighbouring particles".into(),
                Published::Constant { value: 8.0, unit: "1", margin: 0.0 },
            ),
            Self::CheapAndBetter => statement(
                "cheap-and-better".into(),
                "Sec. 6.3",
                "at 160 × 160, S4 with h = 1.5Δ has an error at least two orders lower than S3 with h = 3.5Δ"
                    .into(),
                Published::Relation {
                    left: "L2 of S3 (3.5Δ) over L2 of S4 (1.5Δ)",
                    sign: Sign::Greater,
                    right: "100",
                },
            ),
            Self::GrowsWithRadius(scheme) => statement(
                format!("grows-with-radius#{scheme}"),
                if scheme == "S3" { "Eq. (49), second term" } else { "Eq. (50), first term" },
                format!("at constant Δ the error of {scheme} grows with (h/Δ)²"),
                Published::Exponent { of: Variable::DxOverH, value: -2.0, margin: 0.25 },
            ),
            Self::WorstS3Irregular => statement(
                "S3-worst#irregular".into(),
                "Sec. 6.2, Fig. 2 (left)",
                "of scheme S3 on irregular particles h = 1.5Δ has by far the highest errors".into(),
                less("the highest L2 of S3 at any other radius", "L2 of S3 at h = 1.5Δ"),
            ),
            Self::UnityS3Irregular(h) => statement(
                format!("S3-unity#irregular,h{h}"),
                "Sec. 6.2, Figs. 2, 3 (left)",
                format!("on irregular particles S3 with h = {h}Δ has a convergence rate about unity"),
                order(1.0, 0.25),
            ),
            Self::BestS3Irregular => statement(
                "S3-best#irregular".into(),
                "Sec. 6.2, Figs. 2, 3 (left)",
                "of scheme S3 on irregular particles h = 2.5Δ is the most accurate".into(),
                less("L2 of S3 at h = 2.5Δ", "the least L2 of S3 at any other radius"),
            ),
            Self::BestS3WorseThanWorstS4 => statement(
                "S3-best-worse-than-S4-worst".into(),
                "Sec. 6.2, Figs. 2, 3",
                "the most accurate case of S3 has errors higher than the worst case of S4".into(),
                less("the highest L2 of S4", "the least L2 of S3"),
            ),
            Self::SecondOrderS4Irregular(h) => statement(
                format!("S4-second-order#irregular,h{h}"),
                "Sec. 6.2, Figs. 2, 3 (right)",
                format!("on irregular particles S4 with h = {h}Δ approximately obeys second order"),
                order(2.0, 0.25),
            ),
            Self::LittleChangeWithEpsilon => statement(
                "S4-little-change".into(),
                "Sec. 6.2",
                "the change of behaviour of S4 between ε = 0.2 and 0.4 is not significant".into(),
                Published::Relation {
                    left: "slope of L2 of S4 at ε = 0.4",
                    sign: Sign::Equal,
                    right: "slope at ε = 0.2",
                },
            ),
            Self::Approach => statement(
                "approach".into(),
                "Sec. 6.2",
                "particles can approach each other by at most 0.28Δ (ε = 0.4)".into(),
                Published::Constant { value: 0.28, unit: "Δ", margin: 0.02 },
            ),
            Self::CostOfS4 => statement(
                "cost#S4,h3.5".into(),
                "Sec. 6.3",
                "at 160 × 160 and h = 3.5Δ, S4 takes 856 s where S3 takes 233 s".into(),
                Published::Ratio { value: 856.0 / 233.0, margin: 0.1 },
            ),
            Self::CostOfSmallS4 => statement(
                "cost#S4,h1.5".into(),
                "Sec. 6.3",
                "at 160 × 160, S4 with h = 1.5Δ takes 239 s where S3 with h = 3.5Δ takes 233 s".into(),
                Published::Ratio { value: 239.0 / 233.0, margin: 0.1 },
            ),
        }
    }
}
