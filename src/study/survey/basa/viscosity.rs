//! Constants and effective viscosities of models A to E.
//!
//! One task per kernel: what each bare sum gives on three quadratic flows, derived at every spacing, measured on particles at
//! the paper's.

use super::super::{SurveyTask, TaskError, table_row};
use super::constants::{constant_rows, continuum_rows};
use super::part::{Common, Part, With, judge, number, series, sides, stored};
use crate::claim::basa_2009::{DX_OVER_H, MODEL_C_FACTOR, XI_CLEARY, XI_POISEUILLE};
use crate::claim::{Measured, Observed};
use crate::derived::{LatticeFlow, continuum_response};
use crate::kernel::{self, Kernel};
use crate::language::{FlowDirection, Operator, ViscousModel};
use crate::measured::{Placed, measured_response};
use crate::particles::lattice::catalogue;
use crate::particles::{Lattice, VolumeRule, lattice_by_id};
use crate::record::{Report, significant};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// One bare sum on one flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Response {
    pub model: String,
    pub dimension: usize,
    pub lattice: String,
    pub kernel: String,
    /// R/Δ.
    pub support: f64,
    /// Δ/h with the kernel's own h.
    pub dx_over_h: f64,
    pub rule: String,
    pub regularised: bool,
    pub direction: String,
    /// ⟨L v⟩·t on v = t (n·r)²/2.
    pub derived: Option<f64>,
    pub measured: Option<f64>,
}

impl Response {
    /// What was derived, or else measured.
    pub(super) fn value(&self) -> f64 {
        self.derived.or(self.measured).unwrap_or(f64::NAN)
    }

    fn is(&self, model: &str, lattice: &str, support: f64, rule: VolumeRule) -> bool {
        self.model == model && self.lattice == lattice && self.support == support && self.rule == rule.id()
    }
}

/// The models whose sums differ: D and MCG are C times a number.
const SUMS: [ViscousModel; 4] = [ViscousModel::A, ViscousModel::B, ViscousModel::C, ViscousModel::E];

pub(super) struct ViscosityPart {
    common: Arc<Common>,
    kernels: Vec<Kernel>,
}

impl ViscosityPart {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        let mut kernels = vec![common.kernel.clone()];
        // A first look takes one kernel of each family.
        let first_look = ["quintic-spline", "wendland-c2"];
        let wanted = |id: &str| id != common.kernel.id() && (!common.quick || first_look.contains(&id));
        kernels.extend(kernel::catalogue().into_iter().filter(|kernel| wanted(kernel.id())));
        Self { common: Arc::clone(common), kernels }
    }

    /// R/Δ at the paper's spacing.
    fn paper(&self) -> f64 {
        Common::support(self.common.parameters.dx_over_h)
    }

    /// All R/Δ, rising.
    fn supports(&self) -> Vec<f64> {
        let ladder = self.common.parameters.ladder.iter().map(|x| Common::support(*x));
        let mut supports: Vec<f64> = ladder.chain([self.paper()]).collect();
        supports.sort_by(f64::total_cmp);
        supports.dedup();
        supports
    }

    fn responses(&self, kernel: &Kernel) -> Result<Vec<Response>, TaskError> {
        let of_the_paper = kernel.id() == self.common.kernel.id();
        let mut all = Vec::new();
        let mut supports = self.supports();
        if kernel.id() == "quintic-spline" {
            // h/Δ = 1.05 of Chaussonnet et al., R = 3h.
            supports.push(3.15);
        }
        for lattice in catalogue() {
            for support in &supports {
                let chaussonnet = *support == 3.15;
                for rule in VolumeRule::ALL {
                    for regularised in [false, true] {
                        if !regularised && !of_the_paper && !chaussonnet {
                            continue;
                        }
                        let at = At { kernel, lattice: &lattice, support: *support, rule, regularised };
                        let measure = of_the_paper && *support == self.paper();
                        all.extend(at.responses(measure)?);
                    }
                }
            }
        }
        Ok(all)
    }
}

/// Where sums are taken.
struct At<'a> {
    kernel: &'a Kernel,
    lattice: &'a Lattice,
    support: f64,
    rule: VolumeRule,
    regularised: bool,
}

impl At<'_> {
    fn responses(&self, measure: bool) -> Result<Vec<Response>, TaskError> {
        let Self { kernel, lattice, support, rule, regularised } = *self;
        let dimension = lattice.dimension();
        let flow = LatticeFlow::new(kernel, lattice, support, rule);
        let mut all = Vec::new();
        for model in SUMS {
            // Only the central sum has an η.
            if !regularised && !model.is_central() {
                continue;
            }
            for direction in FlowDirection::in_dimension(dimension) {
                let derived = Some(flow.response(model, *direction, regularised));
                let measured = if measure {
                    Some(measured_response(model, kernel, lattice, support, rule, *direction, regularised)?)
                } else {
                    None
                };
                all.push(Response {
                    model: model.id().into(),
                    dimension,
                    lattice: lattice.id().into(),
                    kernel: kernel.id().into(),
                    support,
                    dx_over_h: Common::dx_over_h(kernel, support),
                    rule: rule.id().into(),
                    regularised,
                    direction: direction.id().into(),
                    derived,
                    measured,
                });
            }
        }
        Ok(all)
    }
}

/// What only the paper's own lattice is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct OnSquare {
    /// \[Δ/h, by model A, B, the central sum, E\], shear along an axis, then along the diagonal.
    curve: Vec<[f64; 9]>,
    /// The central sum with the first-order corrections of Eqs. (24) to (26), shear along an axis.
    corrected: f64,
    /// Relative errors at the centre of u = 1 − y²/d²: of ∂²u/∂y² direct, with Eq. (23); at y = d/2 of ∂u/∂y.
    parabola: [f64; 3],
    /// Model E at constant Δ/h: Δ/d, relative error of the viscous term at the centre of a channel.
    ladder: Vec<[f64; 2]>,
    /// Δ/h at which ξ is what Cleary calibrated, with and without η.
    cleary: [Option<f64>; 2],
}

impl ViscosityPart {
    fn on_square(&self) -> Result<OnSquare, TaskError> {
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        let (rule, support) = (VolumeRule::NumberDensity, self.paper());
        let lattice_flow = |support: f64| LatticeFlow::new(kernel, &square, support, rule);
        let curve = (0..=60).map(|k| {
            let dx_over_h = 0.3 + 0.0125 * f64::from(k);
            let flow = lattice_flow(Common::support(dx_over_h));
            let mut row = [dx_over_h; 9];
            for (d, direction) in
                [FlowDirection::ShearAxis, FlowDirection::ShearDiagonal].into_iter().enumerate()
            {
                for (m, model) in SUMS.into_iter().enumerate() {
                    row[1 + 4 * d + m] = flow.response(model, direction, true);
                }
            }
            row
        });
        let corrected = "sum_j V_j ((v_i - v_j) . r_ij) / (|r_ij|^2 + 0.01 h^2) \
            (inverse(-sum_l V_l (gradW_il / (sum_k V_k W_ik) - W_il (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2) r_il) \
            . (gradW_ij / (sum_k V_k W_ik) - W_ij (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2))";
        let placed = Placed::regular(kernel, &square, support, rule, 1.0)?;
        let flow = |x: &[f64; 3]| [0.5 * x[1] * x[1], 0.0, 0.0];
        let corrected = placed.vector(kernel, &Operator::parse(corrected)?, flow)?;
        // d = 10 Δ, as with 20 particles across.
        let half = 0.5 * self.common.parameters.rows as f64;
        let parabola = |x: &[f64; 3]| 1.0 - x[1] * x[1] / (half * half);
        let exact = -2.0 / (half * half);
        let direct = Operator::parse("sum_j V_j u_j gradgradW_ij")?;
        let shepard = crate::language::operators::by_id("shepard-hessian")?.operator()?;
        let second = |operator: &Operator| -> Result<f64, TaskError> {
            let value = placed.scalar(kernel, operator, parabola)?;
            Ok((value[0][3] - exact) / exact)
        };
        let first = placed.scalar(kernel, &Operator::parse("sum_j V_j u_j gradW_ij")?, |x| {
            let y = x[1] + 0.5 * half;
            1.0 - y * y / (half * half)
        })?;
        let slope = -1.0 / half;
        let parabola = [second(&direct)?, second(&shepard)?, (first[0][1] - slope) / slope];
        // Model E at the centre of channels with ever more particles across, the same Δ/h.
        let model_e = ViscousModel::E.bare(true)?;
        let ladder = [1.0, 2.0, 4.0, 8.0].map(|more: f64| {
            let half = more * half;
            let flow = |x: &[f64; 3]| [1.0 - x[1] * x[1] / (half * half), 0.0, 0.0];
            let term = placed.vector(kernel, &model_e, flow)?[0][0];
            let exact = -2.0 / (half * half);
            Ok::<_, TaskError>([1.0 / half, ((term - exact) / exact).abs()])
        });
        let ladder = ladder.into_iter().collect::<Result<Vec<_>, _>>()?;
        let cleary = [true, false].map(|regularised| {
            let xi = |x: f64| {
                let flow = lattice_flow(Common::support(x));
                0.5 / flow.response(ViscousModel::C, FlowDirection::ShearAxis, regularised)
            };
            crossing(xi, XI_CLEARY, 0.637, 0.95)
        });
        Ok(OnSquare { curve: curve.collect(), corrected: corrected[0][0], parabola, ladder, cleary })
    }
}

/// Where a function that rises crosses a value.
fn crossing(f: impl Fn(f64) -> f64, value: f64, low: f64, high: f64) -> Option<f64> {
    let (mut low, mut high) = (low, high);
    if !(f(low) < value && f(high) > value) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

impl Part for ViscosityPart {
    fn tasks(&self) -> Vec<SurveyTask> {
        let more = (&self.common.parameters.ladder, self.common.parameters.dx_over_h);
        let one = |kernel: &Kernel| {
            let profile = kernel.canonical_profile();
            let inputs = (more, profile, VolumeRule::ALL.map(VolumeRule::id));
            self.common.task(&format!("viscosity {}", kernel.id()), &inputs, 4_000_000)
        };
        let mut tasks: Vec<SurveyTask> = self.kernels.iter().map(one).collect();
        let rows = self.common.parameters.rows;
        tasks.push(self.common.task("viscosity on the square lattice", &(more, rows), 1_000_000));
        tasks
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        Ok(match self.kernels.get(task) {
            Some(kernel) => serde_json::to_value(self.responses(kernel)?)?,
            None => serde_json::to_value(self.on_square()?)?,
        })
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let Some((square, kernels)) = results.split_last() else { return Ok(()) };
        let square: OnSquare = stored(square)?;
        let mut all: Vec<Response> = Vec::new();
        for value in kernels {
            all.extend(stored::<Vec<Response>>(value)?);
        }
        let own: Vec<&Response> = all.iter().filter(|r| r.kernel == self.common.kernel.id()).collect();
        continuum_rows(&self.common.kernel, report)?;
        constant_rows(&all, self.common.kernel.id(), self.paper(), report);
        self.constants(&own, report)?;
        self.accuracy(&own, &square, report)?;
        self.tables(&all, &square, report);
        Ok(())
    }
}

impl ViscosityPart {
    /// The claims on 8, 4.96333 and 4.24: in the continuum, on the paper's lattice, on others.
    fn constants(&self, own: &[&Response], report: &mut Report) -> Result<(), TaskError> {
        let claims = [
            ("eq-33/factor", ViscousModel::C),
            ("eq-34/cleary", ViscousModel::D),
            ("eq-34/poiseuille", ViscousModel::D),
        ];
        for (id, model) in claims {
            for dimension in [2, 3] {
                if id == "eq-34/poiseuille" && dimension == 3 {
                    continue;
                }
                let f = |regularised| {
                    continuum_response(
                        model,
                        &self.common.kernel,
                        dimension,
                        FlowDirection::ShearAxis,
                        regularised,
                    )
                };
                let case = |regularised: bool| {
                    let case = super::part::case(self.common.kernel.id(), "continuum", dimension, "constant");
                    case.with("direction", "shear").with("regularised", regularised)
                };
                let unit = model.unit_of_constant(dimension);
                judge(report, id, case(false), number(1.0 / (unit * f(false))), None)?;
            }
            for lattice in ["square", "hexagonal", "staggered"] {
                for direction in [FlowDirection::ShearAxis, FlowDirection::ShearDiagonal] {
                    let found = own.iter().find(|r| {
                        r.is("C", lattice, self.paper(), VolumeRule::NumberDensity)
                            && r.regularised
                            && r.direction == direction.id()
                    });
                    let Some(found) = found else { continue };
                    let constant =
                        |f: f64| Observed::Number(Measured::exactly(1.0 / (model.unit_of_constant(2) * f)));
                    let case = self.common.case(lattice, 2, VolumeRule::NumberDensity);
                    let case = case
                        .with("direction", direction.id())
                        .with("regularised", true)
                        .with("dx_over_h", found.dx_over_h);
                    judge(report, id, case, found.derived.map(constant), found.measured.map(constant))?;
                }
            }
        }
        Ok(())
    }

    /// What follows for the accuracy of the models as the text reports it.
    fn accuracy(&self, own: &[&Response], square: &OnSquare, report: &mut Report) -> Result<(), TaskError> {
        let rule = VolumeRule::NumberDensity;
        let response = |model: &str, measured: bool| {
            let found = own.iter().find(|r| {
                r.is(model, "square", self.paper(), rule) && r.regularised && r.direction == "shear-axis"
            });
            found.and_then(|r| if measured { r.measured } else { r.derived }).unwrap_or(f64::NAN)
        };
        let error =
            |model: &str, constant: f64, measured: bool| (constant * response(model, measured) - 1.0).abs();
        let case = || {
            let case = self.common.case("square", 2, rule).with("direction", "shear-axis");
            case.with("dx_over_h", self.common.parameters.dx_over_h)
        };
        let both = |left: (&str, f64), right: (&str, f64)| {
            [false, true]
                .map(|measured| sides(error(left.0, left.1, measured), error(right.0, right.1, measured)))
        };
        let (c, d) = (("C", MODEL_C_FACTOR), ("C", 2.0 * XI_POISEUILLE));
        let (cleary, e, b) = (("C", 2.0 * XI_CLEARY), ("E", 1.0), ("B", 1.0));
        for (id, left, right) in [
            ("5.3/inaccurate", cleary, d),
            ("6.1.3/c-d", c, d),
            ("6.1.3/c-e", c, e),
            ("6.1.3/b-accurate", b, c),
        ] {
            let [derived, measured] = both(left, right);
            judge(report, id, case(), derived, measured)?;
        }
        // On a lattice the correction divides by the component of B⁻¹ that model E takes.
        let corrected = |f: f64| (2.0 * XI_POISEUILLE * f - 1.0).abs();
        let derived = corrected(response("C", false) / response("E", false));
        judge(
            report,
            "6.1.3/over-fitted",
            case(),
            sides(derived, error("C", 2.0 * XI_POISEUILLE, false)),
            sides(corrected(square.corrected), error("C", 2.0 * XI_POISEUILLE, true)),
        )?;
        judge(report, "5.3/discrepancy", case(), number(XI_CLEARY / XI_POISEUILLE), None)?;
        let [direct, shepard, first] = square.parabola.map(f64::abs);
        let profile = |case: crate::record::Case| case.with("field", "1 − y²/d², d = 10 Δ");
        judge(report, "6.1.3/a-shepard", profile(case()), None, sides(shepard, direct))?;
        judge(report, "5.1/second-worse", profile(case()), None, sides(direct, first))?;
        let slope = super::part::slope(&square.ladder)?;
        // The sum has no length of its own: Δ drops out of its value on a quadratic flow.
        judge(report, "5.3/convergence", case(), number(0.0), Some(Observed::Number(slope)))
    }

    fn tables(&self, all: &[Response], square: &OnSquare, report: &mut Report) {
        #[derive(Serialize)]
        struct Explained {
            model: String,
            constant: f64,
            of_the_continuum: f64,
            of_the_lattice: f64,
            viscosity_error: f64,
            steady_velocity_error: f64,
            the_text_says: &'static str,
        }
        let rule = VolumeRule::NumberDensity;
        let value = |model: &str| {
            let found = all.iter().find(|r| {
                r.kernel == self.common.kernel.id()
                    && r.is(model, "square", self.paper(), rule)
                    && r.regularised
                    && r.direction == "shear-axis"
            });
            found.map_or(f64::NAN, Response::value)
        };
        let explained =
            |model: &str, sum: &str, unit: f64, constant: f64, continuum: f64, text: &'static str| {
                let ratio = unit * constant * value(sum);
                table_row(&Explained {
                    model: model.into(),
                    constant,
                    of_the_continuum: continuum,
                    of_the_lattice: significant(1.0 / (unit * value(sum)), 8),
                    viscosity_error: significant(ratio - 1.0, 6),
                    // A force is balanced by fewer velocities where the fluid is more viscous.
                    steady_velocity_error: significant(1.0 / ratio - 1.0, 6),
                    the_text_says: text,
                })
            };
        let rows = vec![
            explained("A", "A", 1.0, 1.0, 1.0, "unstable without correction"),
            explained("B", "B", 1.0, 1.0, 1.0, "accuracy is very good"),
            explained(
                "C",
                "C",
                1.0,
                MODEL_C_FACTOR,
                8.0,
                "some of the least accurate results of all the models",
            ),
            explained("D", "C", 2.0, XI_CLEARY, 4.0, "highly inaccurate velocities"),
            explained("D", "C", 2.0, XI_POISEUILLE, 4.0, "much better results, the best with E"),
            explained("E", "E", 1.0, 1.0, 1.0, "the best results"),
        ];
        report.tables.insert("viscosity_explained".into(), rows);
        report.tables.insert("effective_viscosity_error".into(), effective(all));
        #[derive(Serialize)]
        struct Cleary {
            xi: f64,
            regularised: bool,
            dx_over_h: Option<f64>,
        }
        let rows = square.cleary.iter().zip([true, false]).map(|(x, regularised)| {
            table_row(&Cleary { xi: XI_CLEARY, regularised, dx_over_h: x.map(|x| significant(x, 8)) })
        });
        report.tables.insert("spacing_at_which_cleary_is_right".into(), rows.collect());
        for (d, direction) in [FlowDirection::ShearAxis, FlowDirection::ShearDiagonal].into_iter().enumerate()
        {
            let constants = [
                ("A", 0, 1.0),
                ("B", 1, 1.0),
                ("C", 2, MODEL_C_FACTOR),
                ("D (ξ = 4.96333)", 2, 2.0 * XI_CLEARY),
                ("D (ξ = 4.24)", 2, 2.0 * XI_POISEUILLE),
                ("E", 3, 1.0),
            ];
            let lines = constants.map(|(name, place, constant)| {
                let points =
                    square.curve.iter().map(|row| vec![row[0], constant * row[1 + 4 * d + place] - 1.0]);
                (name.to_owned(), points.collect())
            });
            report.series.push(series(
                &format!("effective-viscosity-{}", direction.id()),
                None,
                ("Δx/h", "1", false),
                ("μ_eff/μ − 1", "1", false),
                lines.into(),
            ));
        }
    }
}

/// The relative error of the effective viscosity of every model as printed, by kernel, lattice, volume rule, Δ/h and
/// direction.
fn effective(all: &[Response]) -> Vec<super::super::Row> {
    #[derive(Serialize)]
    struct Effective<'a> {
        kernel: &'a str,
        lattice: &'a str,
        dimension: usize,
        volume_rule: &'a str,
        dx_over_h: f64,
        support_over_dx: f64,
        direction: &'a str,
        a: f64,
        b: f64,
        c: f64,
        d_4_96333: f64,
        d_4_24: f64,
        e: f64,
    }
    let as_printed = |r: &&Response| r.regularised && r.support != 3.15;
    let (mut rows, chosen): (Vec<_>, Vec<&Response>) = (Vec::new(), all.iter().filter(as_printed).collect());
    for first in chosen.iter().filter(|r| r.model == "A") {
        let of = |model: ViscousModel, sum: &str, constant: f64| {
            let found = chosen.iter().find(|r| {
                r.model == sum
                    && r.rule == first.rule
                    && (r.kernel == first.kernel && r.lattice == first.lattice)
                    && (r.support == first.support && r.direction == first.direction)
            });
            let target = FlowDirection::in_dimension(3).iter().find(|d| d.id() == first.direction);
            let target = target.map_or(1.0, |direction| model.target(*direction));
            significant(found.map_or(f64::NAN, |r| constant * r.value() / target - 1.0), 6)
        };
        rows.push(table_row(&Effective {
            kernel: &first.kernel,
            lattice: &first.lattice,
            dimension: first.dimension,
            volume_rule: &first.rule,
            dx_over_h: significant(first.dx_over_h, 6),
            support_over_dx: significant(first.support, 6),
            direction: &first.direction,
            a: of(ViscousModel::A, "A", 1.0),
            b: of(ViscousModel::B, "B", 1.0),
            c: of(ViscousModel::C, "C", MODEL_C_FACTOR),
            d_4_96333: of(ViscousModel::D, "C", 2.0 * XI_CLEARY),
            d_4_24: of(ViscousModel::D, "C", 2.0 * XI_POISEUILLE),
            e: of(ViscousModel::E, "E", 1.0),
        }));
    }
    rows
}

/// Δx/h of the paper, for those who ask whether a row is its.
pub(super) fn is_of_the_paper(dx_over_h: f64) -> bool {
    (dx_over_h - DX_OVER_H).abs() < 1e-9
}
