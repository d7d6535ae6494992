//! What is exact on constants, linear and quadratic functions, and why: §§ 4, 5.1 and 5.2.

use super::super::{SurveyTask, TaskError, table_row};
use super::part::{Common, Part, With, judge, nothing, number, sides, sides_within, stored, zero};
use crate::derived::{Expansion, Setting, linearised, second_derivative_of_one};
use crate::exact::{Rational, int, ratio, rational_from_decimal, rational_to_f64};
use crate::language::{Coefficient, Operator, Subject, operators};
use crate::measured::{Placed, RegularSpec, regular_rung};
use crate::particles::lattice::catalogue;
use crate::particles::{Disorder, Lattice, PointGroup, VolumeRule, lattice_by_id};
use crate::record::{Report, significant};
use crate::sums::{Component, LatticeSums, Moment, Reduction, Standing};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// Memory for shells.
const MEMORY_MIB: u64 = 64;
/// What counts as rounding of sums of order one.
const ROUNDING: f64 = 1e-11;
/// The disorder of the exactness table, and of the mirrored particles.
const DISORDER: &str = "canonical:0.1";
/// The operators of the exactness table.
const OPERATORS: [&str; 8] =
    ["A", "B", "C", "D", "E", "shepard-gradient", "shepard-hessian", "mixed-correction"];
/// Steps of the bisection of a zero crossing.
const BISECTIONS: usize = 45;
/// Fractional bits of its sums.
const BITS: u32 = 160;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Exactness {
    operator: String,
    dimension: usize,
    particles: String,
    degree: usize,
    /// `identically`, `by symmetry`, or empty.
    vanishes: String,
    /// What is left, h^{…} times the norm of the coefficient less the target's; of disordered particles its rms.
    left: f64,
    floor: f64,
}

/// One lattice, or mirrored particles, under the statements of § 5.1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Arrangement {
    name: String,
    dimension: usize,
    /// Coordinate planes at which it is mirrored, as `x`, `y`, `z`.
    planes: String,
    is_lattice: bool,
    /// By what is said of symmetry: mixed on constants, mixed on linear, first on constants; whether all unmixed ones are
    /// left by symmetry.
    by_symmetry: [bool; 3],
    unmixed_left: bool,
    /// The largest found, h^{…} Σ: mixed on constants, mixed on linear, first on constants, unmixed on constants.
    largest: [f64; 4],
    /// |Σ V W − 1| with constant volumes, and with V = 1/ΣW.
    interpolation: [f64; 2],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    arrangements: Vec<Arrangement>,
    /// R/Δ on both sides of a crossing of Σ V ∂²W/∂x² on the square lattice, as text, and the sums h² Σ there.
    crossing: Option<(String, String, [f64; 2])>,
    /// By claim: largest error on disordered particles.
    corrections: Vec<(String, f64)>,
    /// By disorder: rms error of (18) and of (17), each with its standard error.
    divergence: Vec<(String, [f64; 2], [f64; 2])>,
    /// Farthest particle in the stencil of two passes, over R.
    reach: f64,
}

pub(super) struct ConsistencyPart {
    common: Arc<Common>,
}

/// A name, and two pairs of numbers.
type Named = (String, [f64; 2], [f64; 2]);

impl ConsistencyPart {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        Self { common: Arc::clone(common) }
    }

    fn support(&self) -> Result<Rational, TaskError> {
        Ok(ratio(2, 1) / rational_from_decimal(self.common.parameters.dx_over_h)?)
    }

    fn h(&self) -> f64 {
        1.0 / self.common.parameters.dx_over_h
    }

    fn exactness(&self, id: &str) -> Result<Vec<Exactness>, TaskError> {
        let kernel = &self.common.kernel;
        let entry = operators::by_id(id)?;
        let expansion = Expansion::of(entry.operator()?, Some(entry.target), 2)?;
        let support = self.support()?;
        let mut rows = Vec::new();
        for lattice in catalogue() {
            let group = PointGroup::of(&lattice);
            let subjects = (0..=2).map(|degree| Coefficient::new(id, degree).map(Subject::Coefficient));
            let spec = RegularSpec {
                kernel: kernel.clone(),
                lattice: lattice.clone(),
                rule: VolumeRule::NumberDensity,
                subjects: subjects.collect::<Result<_, _>>()?,
                supports: vec![support.clone()],
                memory_mib: MEMORY_MIB,
            };
            let norms = &regular_rung(&spec, &group)?.norms[0];
            for (degree, norm) in norms.iter().enumerate() {
                let vanishes = if expansion.vanishes(degree) {
                    "identically"
                } else if expansion.vanishes_on(degree, &group) {
                    "by symmetry"
                } else {
                    ""
                };
                rows.push(Exactness {
                    operator: id.into(),
                    dimension: lattice.dimension(),
                    particles: lattice.id().into(),
                    degree,
                    vanishes: vanishes.into(),
                    left: norm.deviation,
                    floor: norm.radius,
                });
            }
        }
        // Displaced: what is left is a root mean square, derived to second order in the displacements.
        let (square, disorder) = (lattice_by_id("square")?, Disorder::parse(DISORDER)?);
        for degree in 0..=2 {
            let setting = Setting {
                kernel,
                lattice: &square,
                disorder: &disorder,
                support_over_dx: rational_to_f64(&support),
                rule: VolumeRule::NumberDensity,
            };
            let subject = Subject::Coefficient(Coefficient::new(id, degree)?);
            let vanishes = expansion.vanishes(usize::from(degree));
            let left = if vanishes { 0.0 } else { linearised(&setting, &subject)?.rms() };
            let to_h = libm::pow(self.h(), -f64::from(subject.length_power()));
            rows.push(Exactness {
                operator: id.into(),
                dimension: 2,
                particles: format!("square, {DISORDER}"),
                degree: degree.into(),
                vanishes: if vanishes { "identically" } else { "" }.into(),
                left: significant(left * to_h, 8),
                floor: 0.0,
            });
        }
        Ok(rows)
    }

    fn found(&self) -> Result<Found, TaskError> {
        let mut arrangements = Vec::new();
        for lattice in
            catalogue().into_iter().filter(|lattice| lattice.dimension() > 1).chain(own_lattices()?)
        {
            arrangements.push(self.of_lattice(&lattice)?);
        }
        for planes in ["x", "xy"] {
            arrangements.push(self.mirrored(planes)?);
        }
        Ok(Found {
            arrangements,
            crossing: self.crossing()?,
            corrections: self.corrections()?,
            divergence: self.divergence()?,
            reach: self.reach()?,
        })
    }

    fn of_lattice(&self, lattice: &Lattice) -> Result<Arrangement, TaskError> {
        let group = PointGroup::of(lattice);
        let dimension = lattice.dimension();
        let (second, linear, first) =
            (Moment::by_name("sum_ddw")?, Moment::by_name("sum_rddw")?, Moment::by_name("sum_dw")?);
        let standing = |moment: Moment, mixed: Option<bool>, all: &dyn Fn(&Standing) -> bool| {
            let reduction = Reduction::of(moment, lattice, &group);
            let chosen = reduction.components.iter().zip(&reduction.standing);
            let mut chosen =
                chosen.filter(|(component, _)| mixed.is_none_or(|mixed| is_mixed(component) == mixed));
            chosen.all(|(_, standing)| all(standing))
        };
        let zero = |standing: &Standing| *standing == Standing::ZeroBySymmetry;
        let support = self.support()?;
        let placed = Placed::regular(
            &self.common.kernel,
            lattice,
            rational_to_f64(&support),
            VolumeRule::Constant,
            1.0,
        )?;
        let sums = LatticeSums::new(
            &self.common.kernel,
            lattice,
            &support,
            &[Moment::by_name("sum_w")?],
            MEMORY_MIB,
        )?;
        let of_one = Moment::by_name("sum_w")?.components(dimension);
        let interpolation = VolumeRule::ALL.map(|rule| {
            let sum = sums.enclose(&support, &of_one, rule, BITS)?;
            Ok::<f64, TaskError>((sum[0].midpoint_f64() - 1.0).abs())
        });
        let [constant, density] = interpolation;
        let planes = (0..dimension).filter(|axis| group.has_reflection(*axis));
        Ok(Arrangement {
            name: lattice.id().into(),
            dimension,
            planes: planes.map(|axis| ["x", "y", "z"][axis]).collect(),
            is_lattice: true,
            by_symmetry: [
                standing(second, Some(true), &zero),
                standing(linear, Some(true), &zero),
                standing(first, None, &zero),
            ],
            unmixed_left: standing(second, Some(false), &|standing| !zero(standing)),
            largest: self.largest(&placed)?,
            interpolation: [constant?, density?],
        })
    }

    /// Displaced particles, mirrored at the planes through particle i.
    fn mirrored(&self, planes: &str) -> Result<Arrangement, TaskError> {
        let (square, support) = (lattice_by_id("square")?, rational_to_f64(&self.support()?));
        let disorder = Disorder::parse(DISORDER)?;
        let ball = Placed::disordered(
            &self.common.kernel,
            &square,
            support,
            VolumeRule::Constant,
            &disorder,
            support + 1.0,
            self.common.seed,
        )?;
        let turned: Vec<usize> = planes.chars().filter_map(|plane| "xy".find(plane)).collect();
        let mut places = vec![[0.0; 3]];
        for place in ball.cloud.positions() {
            // Those well on the near side of each plane, each with its images.
            if turned.iter().all(|axis| place[*axis] > 0.2) {
                let mut images = vec![*place];
                for axis in &turned {
                    let mirrored: Vec<[f64; 3]> = images
                        .iter()
                        .map(|image| {
                            let mut image = *image;
                            image[*axis] = -image[*axis];
                            image
                        })
                        .collect();
                    images.extend(mirrored);
                }
                places.extend(images);
            }
        }
        let placed = Placed::with_volumes(
            &self.common.kernel,
            &square,
            support,
            VolumeRule::Constant,
            places,
            vec![0],
        )?;
        Ok(Arrangement {
            name: format!("mirrored at {}", if planes == "x" { "x = 0" } else { "x = 0 and y = 0" }),
            dimension: 2,
            planes: planes.into(),
            is_lattice: false,
            // Images cancel in pairs: ∂²W/∂x∂y is odd in x and in y, so that x ∂²W/∂x∂y needs the other plane.
            by_symmetry: [true, planes == "xy", planes == "xy"],
            unmixed_left: true,
            largest: self.largest(&placed)?,
            interpolation: [0.0; 2],
        })
    }

    /// Largest mixed second derivatives of 1 and of linear functions, first of 1, unmixed second of 1; in units of h.
    fn largest(&self, placed: &Placed) -> Result<[f64; 4], TaskError> {
        let (kernel, h) = (&self.common.kernel, self.h());
        let dimension = placed.cloud.dimension();
        let second = Operator::parse("sum_j V_j u_j gradgradW_ij")?;
        let first = Operator::parse("sum_j V_j u_j gradW_ij")?;
        let pick = |values: &[f64], mixed: bool| {
            let places = (0..dimension * dimension).filter(|k| (k / dimension != k % dimension) == mixed);
            places.map(|k| values[k].abs()).fold(0.0, f64::max)
        };
        let of_one = placed.scalar(kernel, &second, |_| 1.0)?;
        let mut linear: f64 = 0.0;
        for axis in 0..dimension {
            linear = linear.max(pick(&placed.scalar(kernel, &second, |x| x[axis])?[0], true));
        }
        let gradient = placed.scalar(kernel, &first, |_| 1.0)?;
        let gradient = gradient[0].iter().map(|g| g.abs()).fold(0.0, f64::max);
        Ok([pick(&of_one[0], true) * h * h, linear * h, gradient * h, pick(&of_one[0], false) * h * h])
    }

    /// A crossing of Σ V ∂²W/∂x² on the square lattice, between R/Δ whose sums are shown to have opposite signs.
    fn crossing(&self) -> Result<Option<(String, String, [f64; 2])>, TaskError> {
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        let moment = Moment::by_name("sum_ddw")?;
        let sums = LatticeSums::new(kernel, &square, &int(6), &[moment], MEMORY_MIB)?;
        let components: Vec<Component> =
            moment.components(2).into_iter().filter(|c| c.name == "xx").collect();
        let sign = |support: &Rational| -> Result<Option<bool>, TaskError> {
            let (low, high) = sums.enclose(support, &components, VolumeRule::Constant, BITS)?[0].bounds_f64();
            Ok(if low > 0.0 {
                Some(true)
            } else if high < 0.0 {
                Some(false)
            } else {
                None
            })
        };
        let mut low = int(2);
        for k in 1..=64 {
            let high = int(2) + ratio(k, 16);
            if let (Some(before), Some(after)) = (sign(&low)?, sign(&high)?) {
                if before != after {
                    let (mut left, mut right) = (low, high);
                    for _ in 0..BISECTIONS {
                        let middle = (&left + &right) / int(2);
                        match sign(&middle)? {
                            Some(there) if there == before => left = middle,
                            Some(_) => right = middle,
                            None => break,
                        }
                    }
                    let value = |support: &Rational| {
                        let support = rational_to_f64(support);
                        let h = support / rational_to_f64(kernel.support_over_h());
                        h * h * second_derivative_of_one(kernel, &square, support, VolumeRule::Constant)
                    };
                    let values = [value(&left), value(&right)];
                    return Ok(Some((left.to_string(), right.to_string(), values)));
                }
            }
            low = high;
        }
        Ok(None)
    }

    /// Largest errors of corrected operators and of (17), (18) on displaced particles.
    fn corrections(&self) -> Result<Vec<(String, f64)>, TaskError> {
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        let disorder = Disorder::parse(DISORDER)?;
        let support = rational_to_f64(&self.support()?);
        let radius = 2.0 * support + 3.0;
        let rule = VolumeRule::NumberDensity;
        let placed = Placed::disordered(kernel, &square, support, rule, &disorder, radius, self.common.seed)?;
        let largest = |values: Vec<Vec<f64>>, exact: &[f64], scale: f64| {
            let errors = values.iter().flat_map(|v| v.iter().zip(exact).map(|(v, e)| scale * (v - e).abs()));
            errors.fold(0.0, f64::max)
        };
        let h = self.h();
        let scalar = |id: &str, linear: bool, exact: &[f64], scale: f64| -> Result<f64, TaskError> {
            let operator = operators::by_id(id)?.operator()?;
            let values = placed.scalar(kernel, &operator, |x| if linear { x[0] } else { 1.0 })?;
            Ok(largest(values, exact, scale))
        };
        let vector = |id: &str| -> Result<f64, TaskError> {
            let values = placed.vector(kernel, &operators::by_id(id)?.operator()?, |_| [1.0, -0.5, 0.0])?;
            Ok(largest(values, &[0.0], h))
        };
        Ok(vec![
            ("eq-21/order-0".into(), scalar("shepard", false, &[1.0], 1.0)?),
            ("eq-22/order-0".into(), scalar("shepard-gradient", false, &[0.0; 2], h)?),
            ("eq-23/order-0".into(), scalar("shepard-hessian", false, &[0.0; 4], h * h)?),
            ("eq-24/order-0".into(), scalar("mixed-correction", false, &[0.0; 2], h)?),
            ("eq-24/order-1".into(), scalar("mixed-correction", true, &[1.0, 0.0], 1.0)?),
            ("eq-17/constants".into(), vector("basa-17")?),
            ("eq-18/constants".into(), vector("basa-18")?),
        ])
    }

    /// Errors of Eqs. (18) and (17) on v = (x, −y/2) on displaced particles.
    fn divergence(&self) -> Result<Vec<Named>, TaskError> {
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        let support = rational_to_f64(&self.support()?);
        let mut all = Vec::new();
        for disorder in &self.common.disorders {
            let radius = self.common.parameters.ball_radius;
            let rule = VolumeRule::NumberDensity;
            let placed =
                Placed::disordered(kernel, &square, support, rule, disorder, radius, self.common.seed)?;
            let error = |id: &str| -> Result<[f64; 2], TaskError> {
                let values = placed
                    .vector(kernel, &operators::by_id(id)?.operator()?, |x| [x[0], -0.5 * x[1], 0.0])?;
                let squares: Vec<f64> = values.iter().map(|v| (v[0] - 0.5) * (v[0] - 0.5)).collect();
                let n = squares.len() as f64;
                let mean = squares.iter().sum::<f64>() / n;
                let variance = squares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / n;
                Ok([mean.sqrt(), (variance / n).sqrt() / (2.0 * mean.sqrt())])
            };
            all.push((disorder.to_string(), error("basa-18")?, error("basa-17")?));
        }
        Ok(all)
    }

    fn reach(&self) -> Result<f64, TaskError> {
        use crate::language::ground::CloudGround;
        let (kernel, square) = (&self.common.kernel, lattice_by_id("square")?);
        // R a little above a whole number of spacings, so that the farthest neighbour stands near R.
        let support = 8.0 + 1.0 / 64.0;
        let placed = Placed::regular(kernel, &square, support, VolumeRule::Constant, 2.0)?;
        let ground = CloudGround::new(&placed.cloud, &placed.lists, kernel);
        let operator = Operator::parse("sum_j V_j (sum_k V_k u_k gradW_jk) . gradW_ij")?;
        let stencil = crate::measured::stencil(&operator, &ground, placed.inner[0])?;
        let distance = |r: &[f64; 3]| (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
        let felt =
            stencil.entries.iter().filter(|entry| entry.weights.iter().flatten().any(|w| w.abs() > 0.0));
        Ok(felt.map(|entry| distance(&entry.displacement)).fold(0.0, f64::max) / support)
    }
}

/// Whether the last two letters, those of the derivatives, differ.
fn is_mixed(component: &Component) -> bool {
    let mut letters = component.name.chars().rev();
    letters.next() != letters.next()
}

/// Regular particles that the catalogue does not hold: rows that are mirrored at x = 0 alone, and a rectangular lattice that
/// is not aligned with the axes.
fn own_lattices() -> Result<Vec<Lattice>, TaskError> {
    let zero = [0, 0, 0];
    let paired = Lattice::new(
        "paired-rows",
        "rows 3/5 and 9/10 apart in turn",
        2,
        [int(1), ratio(1, 100), int(1)],
        [[1, 0, 0], [0, 15, 0], zero],
        vec![zero, [0, 6, 0]],
    )?;
    let tilted = Lattice::new(
        "tilted-rectangular",
        "cells of 1 by 3/2, turned by arctan 1/2",
        2,
        [ratio(1, 20), ratio(1, 20), int(1)],
        [[4, 2, 0], [-3, 6, 0], zero],
        vec![zero],
    )?;
    Ok(vec![paired, tilted])
}

impl Part for ConsistencyPart {
    fn tasks(&self) -> Vec<SurveyTask> {
        let p = &self.common.parameters;
        let more = (p.dx_over_h, &p.disorders, p.ball_radius);
        let exactness =
            OPERATORS.iter().map(|id| self.common.task(&format!("exactness {id}"), &more, 2_000_000));
        let rest = std::iter::once(self.common.task("symmetry and corrections", &more, 3_000_000));
        exactness.chain(rest).collect()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        Ok(match OPERATORS.get(task) {
            Some(id) => serde_json::to_value(self.exactness(id)?)?,
            None => serde_json::to_value(self.found()?)?,
        })
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let Some((found, exactness)) = results.split_last() else { return Ok(()) };
        let found: Found = stored(found)?;
        let mut rows: Vec<Exactness> = Vec::new();
        for value in exactness {
            rows.extend(stored::<Vec<Exactness>>(value)?);
        }
        exactness_table(&rows, report);
        for arrangement in &found.arrangements {
            self.judge_symmetry(arrangement, report)?;
        }
        self.judge_crossing(&found, report)?;
        self.judge_corrections(&found, report)?;
        Ok(())
    }
}

impl ConsistencyPart {
    fn case(&self, name: &str, dimension: usize, is_lattice: bool) -> crate::record::Case {
        let mut case = self.common.case(name, dimension, VolumeRule::Constant);
        if !is_lattice {
            case.source = "cloud".into();
            case = case.disordered(DISORDER);
        }
        case
    }

    fn judge_symmetry(&self, found: &Arrangement, report: &mut Report) -> Result<(), TaskError> {
        let case = || {
            let planes = match found.planes.as_str() {
                "" => "mirrored at no coordinate plane".to_owned(),
                planes => format!("mirrored at {planes}"),
            };
            self.case(&found.name, found.dimension, found.is_lattice).with("planes", planes)
        };
        let column = |by_symmetry: bool| if by_symmetry { nothing() } else { None };
        let claims = [("5.1/mixed-constants", 0), ("5.1/mixed-linear", 1), ("5.1/first", 2)];
        for (id, k) in claims {
            // The statements on second derivatives presuppose a plane, that on first ones a regular arrangement.
            if (k < 2 && found.planes.is_empty()) || (k == 2 && !found.is_lattice) {
                continue;
            }
            judge(report, id, case(), column(found.by_symmetry[k]), zero(found.largest[k], ROUNDING))?;
        }
        if found.is_lattice {
            let left = if found.unmixed_left { 1.0 } else { 0.0 };
            judge(report, "5.1/unmixed-symmetry", case(), sides(left, 0.0), None)?;
            judge(report, "4/regular", case(), None, sides(found.largest[3], ROUNDING))?;
            for (rule, value) in VolumeRule::ALL.into_iter().zip(found.interpolation) {
                let case = crate::record::Case { volume_rule: rule.id().into(), ..case() };
                judge(report, "5.1/interpolation", case, None, sides(value, ROUNDING))?;
            }
        }
        Ok(())
    }

    fn judge_crossing(&self, found: &Found, report: &mut Report) -> Result<(), TaskError> {
        #[derive(Serialize)]
        struct Row<'a> {
            lattice: &'static str,
            kernel: &'a str,
            support_over_dx_below: &'a str,
            support_over_dx_above: &'a str,
            support_over_dx: f64,
            dx_over_h: f64,
            sum_below: f64,
            sum_above: f64,
        }
        let case = self.common.case("square", 2, VolumeRule::Constant);
        let Some((below, above, values)) = &found.crossing else {
            return judge(report, "5.1/unmixed-never", case, None, None);
        };
        let support = rational_to_f64(&below.parse::<Rational>().map_err(|_| "a stored fraction is none")?);
        let of_case = case.with("support_over_dx", significant(support, 12));
        judge(report, "5.1/unmixed-never", of_case, sides(0.0, 0.0), None)?;
        let row = table_row(&Row {
            lattice: "square",
            kernel: self.common.kernel.id(),
            support_over_dx_below: below,
            support_over_dx_above: above,
            support_over_dx: significant(support, 12),
            dx_over_h: significant(Common::dx_over_h(&self.common.kernel, support), 12),
            sum_below: significant(values[0], 3),
            sum_above: significant(values[1], 3),
        });
        report.tables.insert("crossing_of_unmixed_second_derivatives".into(), vec![row]);
        Ok(())
    }

    fn judge_corrections(&self, found: &Found, report: &mut Report) -> Result<(), TaskError> {
        let of = |id: &str| match id {
            "eq-21/order-0" => ("shepard", 0),
            "eq-22/order-0" => ("shepard-gradient", 0),
            "eq-23/order-0" => ("shepard-hessian", 0),
            "eq-24/order-0" => ("mixed-correction", 0),
            "eq-24/order-1" => ("mixed-correction", 1),
            "eq-17/constants" => ("basa-17", 0),
            _ => ("basa-18", 0),
        };
        for (id, largest) in &found.corrections {
            let (operator, degree) = of(id);
            let entry = operators::by_id(operator)?;
            let expansion = Expansion::of(entry.operator()?, Some(entry.target), degree)?;
            let derived = if expansion.vanishes(degree) { nothing() } else { None };
            let case = self.common.case("square", 2, VolumeRule::NumberDensity).disordered(DISORDER);
            judge(report, id, case.with("operator", operator), derived, zero(*largest, ROUNDING))?;
        }
        for (disorder, eighteen, seventeen) in &found.divergence {
            let case = self.common.case("square", 2, VolumeRule::NumberDensity).disordered(disorder);
            judge(report, "eq-18/better", case, None, sides_within(*eighteen, *seventeen))?;
        }
        let case = self.common.case("square", 2, VolumeRule::Constant);
        // Every neighbour of a neighbour near R in one direction is felt: 2R is the bound.
        judge(report, "5.2/reach", case, number(2.0), number(found.reach))
    }
}

fn exactness_table(rows: &[Exactness], report: &mut Report) {
    #[derive(Serialize)]
    struct Row<'a> {
        operator: &'a str,
        dimension: usize,
        particles: &'a str,
        degree: usize,
        exact: &'a str,
        left: f64,
    }
    let row = |e: &Exactness| {
        let exact = match e.vanishes.as_str() {
            "" if e.left <= e.floor => "by value",
            "" => "no",
            how => how,
        };
        // What is proved to vanish is not a small float.
        let left = if exact == "no" { significant(e.left, 6) } else { 0.0 };
        table_row(&Row {
            operator: &e.operator,
            dimension: e.dimension,
            particles: &e.particles,
            degree: e.degree,
            exact,
            left,
        })
    };
    report.tables.insert("exactness".into(), rows.iter().map(row).collect());
}
