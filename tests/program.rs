//! Compiled operators against the typed tree walked node by node, pair by pair: `measured::Program` and the evaluator below
//! share the tree and the neighbour lists, and nothing else.

#![allow(clippy::unwrap_used, clippy::panic, clippy::explicit_counter_loop)] // A failed unwrap is a failed test.

use remainder::exact::rational_to_f64;
use remainder::kernel::{Evaluator, Kernel, by_id};
use remainder::language::operators::catalogue;
use remainder::language::tree::{Kind, Node, OfPair, OfParticle, Particle};
use remainder::language::{Field, Operator};
use remainder::measured::{Fields, Program, ProgramError};
use remainder::particles::{Cloud, Neighbours, Support};
use std::cell::RefCell;
use std::collections::HashMap;

/// Deterministic numbers in [-1/2, 1/2).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// A periodic lattice, spacing 0.37, jittered.
fn cloud(dimension: usize, per_axis: usize, support: f64) -> Cloud {
    let spacing = 0.37;
    let mut numbers = Numbers(7 + dimension as u64);
    let count = per_axis.pow(dimension as u32);
    let positions: Vec<[f64; 3]> = (0..count)
        .map(|site| {
            std::array::from_fn(|axis| {
                let place = site / per_axis.pow(axis as u32) % per_axis;
                let jitter = 0.2 * numbers.next();
                if axis < dimension { spacing * (place as f64 + jitter) } else { 0.0 }
            })
        })
        .collect();
    let mut about =
        |mean: f64| -> Vec<f64> { (0..count).map(|_| mean * (1.0 + 0.2 * numbers.next())).collect() };
    let volumes = about(spacing.powi(dimension as i32));
    let (density, mass, viscosity) = (about(1.3), about(0.8), about(0.02));
    let period = spacing * per_axis as f64;
    Cloud::new(dimension, positions, volumes, Support::Uniform(support * spacing))
        .unwrap()
        .with_periods(std::array::from_fn(|axis| (axis < dimension).then_some(period)))
        .unwrap()
        .with_field("density", density)
        .unwrap()
        .with_field("mass", mass)
        .unwrap()
        .with_field("viscosity", viscosity)
        .unwrap()
}

fn small_cloud(dimension: usize) -> Cloud {
    cloud(dimension, [40, 10, 5][dimension - 1], 2.2)
}

fn scalars(cloud: &Cloud) -> Vec<f64> {
    let mut numbers = Numbers(99);
    cloud.positions().iter().map(|_| 1.0 + numbers.next()).collect()
}

fn vectors(cloud: &Cloud) -> Vec<[f64; 3]> {
    let mut numbers = Numbers(98);
    cloud.positions().iter().map(|_| std::array::from_fn(|_| 1.0 + numbers.next())).collect()
}

/// A tensor and the sum of the magnitudes that went into each component.
#[derive(Clone, Debug)]
struct Value(Vec<(f64, f64)>);

impl Value {
    fn exact(values: impl IntoIterator<Item = f64>) -> Self {
        Self(values.into_iter().map(|v| (v, v.abs())).collect())
    }

    fn scalar(&self) -> f64 {
        self.0[0].0
    }
}

/// The tree, walked.
struct Walk<'a> {
    cloud: &'a Cloud,
    lists: &'a Neighbours,
    kernel: &'a Kernel,
    evaluator: Evaluator<f64>,
    u: &'a [f64],
    v: &'a [[f64; 3]],
    tensors: RefCell<HashMap<(bool, usize), Value>>,
}

/// Where the bound particles are: which one, and at what position of its image.
type Bound = HashMap<Particle, (usize, [f64; 3])>;

impl<'a> Walk<'a> {
    fn new(
        cloud: &'a Cloud,
        lists: &'a Neighbours,
        kernel: &'a Kernel,
        u: &'a [f64],
        v: &'a [[f64; 3]],
    ) -> Self {
        let evaluator = Evaluator::new(kernel, cloud.dimension(), 2);
        Self { cloud, lists, kernel, evaluator, u, v, tensors: RefCell::new(HashMap::new()) }
    }

    fn radial(&self, distance: f64) -> [f64; 3] {
        let support = self.cloud.support_of(0);
        let g = self.evaluator.evaluate(&[distance / support; 8]).g;
        let power = |k: usize| support.powi(-(self.cloud.dimension() as i32) - 2 * k as i32);
        [g[0][0] * power(0), g[1][0] * power(1), g[2][0] * power(2)]
    }

    fn pair(&self, quantity: OfPair, r: [f64; 3]) -> Value {
        let dimension = self.cloud.dimension();
        let r = &r[..dimension];
        let square: f64 = r.iter().map(|x| x * x).sum();
        let distance = square.sqrt();
        let [w, g1, g2] = self.radial(distance);
        match quantity {
            OfPair::Separation => Value::exact(r.iter().copied()),
            OfPair::Distance => Value::exact([distance]),
            OfPair::Direction => {
                Value::exact(r.iter().map(|x| if distance > 0.0 { x / distance } else { 0.0 }))
            }
            OfPair::Kernel => Value::exact([w]),
            OfPair::Gradient => Value::exact(r.iter().map(|x| g1 * x)),
            OfPair::Hessian => Value::exact((0..dimension * dimension).map(|ab| {
                let (a, b) = (ab / dimension, ab % dimension);
                f64::from(u8::from(a == b)) * g1 + g2 * r[a] * r[b]
            })),
            OfPair::Laplacian => Value::exact([dimension as f64 * g1 + g2 * square]),
        }
    }

    /// Σ_q V_q f(r_pq, W′/r) over the list of p.
    fn moment(&self, p: usize, f: impl Fn(&[f64; 3], f64, f64) -> f64) -> f64 {
        let term = |pair: &remainder::particles::Neighbour| {
            let distance = pair.r_ij.iter().map(|x| x * x).sum::<f64>().sqrt();
            self.cloud.volumes()[pair.j as usize] * f(&pair.r_ij, distance, self.radial(distance)[1])
        };
        self.lists.of(p).iter().map(term).sum()
    }

    fn tensor(&self, hat: bool, p: usize) -> Value {
        if let Some(known) = self.tensors.borrow().get(&(hat, p)) {
            return known.clone();
        }
        let d = self.cloud.dimension();
        let over = |r: f64| if r > 0.0 { 1.0 / r } else { 0.0 };
        let value = if hat {
            let b = self.tensor(false, p);
            // Unknowns: all D² components of B̂, with its symmetry as further equations.
            let rows = d * d + d * (d - 1) / 2;
            let mut matrix = nalgebra::DMatrix::zeros(rows, d * d);
            let mut right = nalgebra::DVector::zeros(rows);
            for e in 0..d {
                for f in 0..d {
                    let row = e * d + f;
                    right[row] = if e == f { -1.0 } else { 0.0 };
                    for (x, y) in (0..d).flat_map(|x| (0..d).map(move |y| (x, y))) {
                        let mut k =
                            self.moment(p, |r, s, g| r[x] * r[y] * over(s) * r[e] * over(s) * g * r[f]);
                        for (c, h) in (0..d).flat_map(|c| (0..d).map(move |h| (c, h))) {
                            let left = self.moment(p, |r, s, g| r[x] * over(s) * r[y] * over(s) * g * r[c]);
                            k += left * b.0[c * d + h].0 * self.moment(p, |r, _, g| r[e] * r[f] * g * r[h]);
                        }
                        matrix[(row, x * d + y)] = k;
                    }
                }
            }
            let mut row = d * d;
            for (x, y) in (0..d).flat_map(|x| (x + 1..d).map(move |y| (x, y))) {
                matrix[(row, x * d + y)] = 1.0;
                matrix[(row, y * d + x)] = -1.0;
                row += 1;
            }
            let solution = matrix.svd(true, true).solve(&right, 1e-10).unwrap();
            Value::exact(solution.iter().copied())
        } else {
            let matrix = nalgebra::DMatrix::from_fn(d, d, |a, b| -self.moment(p, |r, _, g| r[a] * r[b] * g));
            let inverse = matrix.try_inverse().unwrap();
            Value::exact((0..d * d).map(|ab| inverse[(ab / d, ab % d)]))
        };
        self.tensors.borrow_mut().insert((hat, p), value.clone());
        value
    }

    fn node(&self, node: &Node, bound: &mut Bound) -> Value {
        let d = self.cloud.dimension();
        match &node.kind {
            Kind::Number(value) => Value::exact([rational_to_f64(value)]),
            Kind::Pi => Value::exact([std::f64::consts::PI]),
            Kind::Dimension => Value::exact([d as f64]),
            Kind::SmoothingLength => {
                Value::exact([self.cloud.support_of(0) / rational_to_f64(self.kernel.support_over_h())])
            }
            Kind::Identity => Value::exact((0..d * d).map(|ab| f64::from(u8::from(ab / d == ab % d)))),
            Kind::Field(p) if node.rank == 0 => Value::exact([self.u[bound[p].0]]),
            Kind::Field(p) => Value::exact(self.v[bound[p].0][..d].iter().copied()),
            Kind::OfParticle(quantity, p) => {
                let values = match quantity {
                    OfParticle::Volume => self.cloud.volumes(),
                    OfParticle::Density => self.cloud.field("density").unwrap(),
                    OfParticle::Mass => self.cloud.field("mass").unwrap(),
                    OfParticle::Viscosity => self.cloud.field("viscosity").unwrap(),
                };
                Value::exact([values[bound[p].0]])
            }
            Kind::Renormalisation(p) => self.tensor(false, bound[p].0),
            Kind::RenormalisationHat(p) => self.tensor(true, bound[p].0),
            Kind::OfPair(quantity, p, q) => {
                let (x, y) = (bound[p].1, bound[q].1);
                self.pair(*quantity, std::array::from_fn(|axis| x[axis] - y[axis]))
            }
            Kind::Add(nodes) => {
                let terms: Vec<Value> = nodes.iter().map(|node| self.node(node, bound)).collect();
                let at = |c: usize| terms.iter().fold((0.0, 0.0), |s, t| (s.0 + t.0[c].0, s.1 + t.0[c].1));
                Value((0..terms[0].0.len()).map(at).collect())
            }
            Kind::Negate(a) => Value(self.node(a, bound).0.iter().map(|(v, m)| (-v, *m)).collect()),
            Kind::Outer(a, b) => {
                let (a, b) = (self.node(a, bound), self.node(b, bound));
                let products = a.0.iter().flat_map(|a| b.0.iter().map(|b| (a.0 * b.0, a.1 * b.1)));
                Value(products.collect())
            }
            Kind::Contract(a, b, count) => {
                let (a, b) = (self.node(a, bound), self.node(b, bound));
                let inner = d.pow(u32::from(*count));
                let (rows, columns) = (a.0.len() / inner, b.0.len() / inner);
                let at = |rc: usize| {
                    let (row, column) = (rc / columns, rc % columns);
                    (0..inner).fold((0.0, 0.0), |s, k| {
                        let (a, b) = (a.0[row * inner + k], b.0[k * columns + column]);
                        (s.0 + a.0 * b.0, s.1 + a.1 * b.1)
                    })
                };
                Value((0..rows * columns).map(at).collect())
            }
            Kind::Divide(a, b) => {
                let (a, b) = (self.node(a, bound), self.node(b, bound).scalar());
                let inverse = if b == 0.0 { 0.0 } else { 1.0 / b };
                Value(a.0.iter().map(|(v, m)| (v * inverse, m * inverse.abs())).collect())
            }
            Kind::Power(a, n) => {
                let a = self.node(a, bound).scalar();
                Value::exact([if a == 0.0 && *n < 0 { 0.0 } else { a.powi(*n) }])
            }
            Kind::Inverse(a) => {
                let a = self.node(a, bound);
                let matrix = nalgebra::DMatrix::from_fn(d, d, |x, y| a.0[x * d + y].0);
                let inverse = matrix.try_inverse().unwrap();
                Value::exact((0..d * d).map(|ab| inverse[(ab / d, ab % d)]))
            }
            Kind::Sum { bound: particle, centre, body } => {
                let (i, x) = bound[centre];
                let mut sum = vec![(0.0, 0.0); d.pow(u32::from(node.rank))];
                for pair in self.lists.of(i) {
                    let y = std::array::from_fn(|axis| x[axis] - pair.r_ij[axis]);
                    // At the particle itself, and nowhere else, r is 0 to the bit.
                    let itself = pair.j as usize == i && pair.r_ij == [0.0; 3];
                    bound.insert(*particle, (pair.j as usize, if itself { x } else { y }));
                    for (sum, term) in sum.iter_mut().zip(self.node(body, bound).0) {
                        *sum = (sum.0 + term.0, sum.1 + term.1);
                    }
                    bound.remove(particle);
                }
                Value(sum)
            }
        }
    }
}

fn agrees(text: &str, id: &str, cloud: &Cloud, kernel: &Kernel, every: usize) {
    let operator = Operator::parse(text).unwrap();
    let lists = Neighbours::search(cloud).unwrap();
    let (u, v) = (scalars(cloud), vectors(cloud));
    let program = Program::new(&operator, kernel, cloud.dimension()).unwrap();
    let field = match operator.field {
        Field::Scalar => Fields::Scalar(&u),
        Field::Vector => Fields::Vector(&v),
    };
    let compiled = program.apply(cloud, &lists, field).unwrap();
    let width = program.components();
    assert_eq!(compiled.len(), width * cloud.len());
    assert_eq!(width, cloud.dimension().pow(u32::from(operator.rank())));
    let weights = match operator.field {
        Field::Scalar => program.weights(cloud, &lists).unwrap(),
        Field::Vector => Vec::new(),
    };
    assert!(weights.iter().flatten().all(|row| row.is_sorted_by(|a, b| a.0 < b.0)), "{id}");
    let walk = Walk::new(cloud, &lists, kernel, &u, &v);
    for i in (0..cloud.len()).step_by(every) {
        let mut bound = HashMap::from([(0, (i, cloud.positions()[i]))]);
        let expected = walk.node(&operator.root, &mut bound);
        for (component, (value, magnitude)) in expected.0.iter().enumerate() {
            let found = compiled[i * width + component];
            assert!(
                (found - value).abs() <= 1e-11 * magnitude,
                "{id} in {}-D with {}: component {component} of particle {i} is {found}, walked {value} of {magnitude}",
                cloud.dimension(),
                kernel.id()
            );
            if let Some(rows) = weights.get(component) {
                let found: f64 = rows[i].iter().map(|(j, weight)| weight * u[*j as usize]).sum();
                assert!(
                    (found - value).abs() <= 1e-11 * magnitude,
                    "{id} in {}-D with {}: weights of component {component} of particle {i} give {found}, walked {value} of {magnitude}",
                    cloud.dimension(),
                    kernel.id()
                );
            }
        }
    }
}

#[test]
fn catalogue_agrees_with_the_tree_walked() {
    let kernel = by_id("wendland-c2").unwrap();
    for dimension in 1..=3 {
        let cloud = small_cloud(dimension);
        for entry in catalogue() {
            agrees(entry.text, entry.id, &cloud, &kernel, [3, 7, 41][dimension - 1]);
        }
    }
}

#[test]
fn kernels_of_pieces_and_the_gaussian_agree() {
    let cloud = small_cloud(2);
    for kernel in ["wendland-c6", "cubic-spline", "quintic-spline", "gaussian", "gaussian:cut=2"] {
        let kernel = by_id(kernel).unwrap();
        for text in [
            "sum_j V_j u_j W_ij",
            "sum_j V_j (u_j - u_i) B_i . gradW_ij",
            "sum_j V_j (u_j - u_i) lapW_ij",
            "sum_j V_j u_j gradgradW_ij",
        ] {
            agrees(text, text, &cloud, &kernel, 7);
        }
    }
}

/// Sums inside sums in every position, powers, divisors that vanish at j = i, sums without a kernel.
#[test]
fn other_operators_agree() {
    let kernel = by_id("wendland-c4").unwrap();
    for text in [
        "u_i",
        "3/4 h^2 rho_i u_i / m_i",
        "sum_j u_j",
        "mean_j (u_j / rho_j)",
        "sum_j V_j |r_ij| / |r_ij| u_j W_ij",
        "sum_j V_j |r_ij|^3 |r_ij|^-3 u_j W_ij",
        "sum_j V_j u_j / (r_ij . r_ij) W_ij",
        "sum_j V_j u_j r_ji . gradW_ji",
        "sum_j V_j (sum_k V_k (u_k - u_j) W_ik) W_ij",
        "sum_j V_j (sum_k V_k (u_k - u_j) / (rho_j m_k) gradW_ik) . gradW_ij",
        "sum_j V_j (sum_k V_k u_k W_jk) / (sum_k V_k W_jk) gradW_ij",
        "sum_j V_j (u_j - sum_k V_k u_k W_ik) W_ij / (1 + sum_k V_k W_ik)",
        "sum_j V_j W_ij / (rho_j sum_k V_k W_ik + rho_i) u_j",
        "sum_j V_j (B_j . gradW_ij) . (B_i . (F4[u]_j - F4[u]_i))",
        "sum_j V_j S3[u]_j Bhat_j . e_ij",
        "inverse(sum_j V_j W_ij I + sum_j V_j r_ij gradW_ij) . F2[u]_i",
        "sum_j V_j u_j inverse(|r_ij|^2 I + 0.1 h^2 I + r_ij r_ij) : gradgradW_ij",
        "(1 - sum_j V_j W_ij)^2 u_i + (1 - sum_j V_j W_ij)^-2 u_i",
        "F2[u]_i . B_i . F2[u]_i / (1 + F2[u]_i . F2[u]_i)",
    ] {
        if Operator::parse(text).is_err() {
            assert!(text.starts_with("F2"), "{text}"); // the one that is not linear
            continue;
        }
        for dimension in 1..=3 {
            agrees(text, text, &small_cloud(dimension), &kernel, [3, 7, 41][dimension - 1]);
        }
    }
}

/// More neighbours than a block has lanes, in a box smaller than the support.
#[test]
fn long_lists_agree() {
    let kernel = by_id("wendland-c2").unwrap();
    for text in ["sum_j V_j (u_j - u_i) B_i . gradW_ij", "sum_j V_j F2[u]_j . gradW_ij"] {
        agrees(text, text, &cloud(3, 3, 4.3), &kernel, 13);
        agrees(text, text, &cloud(2, 6, 9.7), &kernel, 13);
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let cloud = cloud(2, 40, 2.5);
    let (lists, u) = (Neighbours::search(&cloud).unwrap(), scalars(&cloud));
    let operator = Operator::parse("sum_j V_j S4[u]_j W_ij").unwrap();
    let program = Program::new(&operator, &by_id("wendland-c2").unwrap(), 2).unwrap();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| program.apply(&cloud, &lists, Fields::Scalar(&u)).unwrap())
    };
    assert_eq!(on(1), on(3));
}

/// Weight w_ij is the value at i of the field that is 1 at j alone: to the bit, where no neighbour's own sums enter.
#[test]
fn a_weight_is_the_value_on_one_particle() {
    let kernel = by_id("wendland-c2").unwrap();
    let cloud = small_cloud(2);
    let lists = Neighbours::search(&cloud).unwrap();
    for (id, exact) in [("S4", true), ("F4", true), ("shepard", true), ("F3", true), ("S1-8-F4", false)] {
        let entry = remainder::language::operators::by_id(id).unwrap();
        let program = Program::new(&entry.operator().unwrap(), &kernel, 2).unwrap();
        let (weights, width) = (program.weights(&cloud, &lists).unwrap(), program.components());
        let largest = weights.iter().flatten().flatten().fold(0.0_f64, |m, (_, weight)| m.max(weight.abs()));
        for j in [0, 37, 99] {
            let u: Vec<f64> = (0..cloud.len()).map(|k| f64::from(u8::from(k == j))).collect();
            let values = program.apply(&cloud, &lists, Fields::Scalar(&u)).unwrap();
            for (place, value) in values.iter().enumerate() {
                let row = &weights[place % width][place / width];
                let weight = row.iter().find(|(k, _)| *k as usize == j).map_or(0.0, |(_, weight)| *weight);
                let apart = if exact { 0.0 } else { 1e-13 * largest };
                assert!((weight - value).abs() <= apart, "{id}: {weight} is {value} at {place}");
            }
        }
    }
}

#[test]
fn one_pass_is_enough_where_factors_can_be_taken_out() {
    let kernel = by_id("wendland-c2").unwrap();
    let passes = |id: &str| {
        let entry = remainder::language::operators::by_id(id).unwrap();
        Program::new(&entry.operator().unwrap(), &kernel, 2).unwrap().passes()
    };
    for id in ["F4", "S4", "shepard-hessian", "mixed-correction", "E"] {
        assert_eq!(passes(id), 1, "{id}");
    }
    for id in ["S1-9-F4", "F4-symmetrised", "B", "pressure-reduction"] {
        assert_eq!(passes(id), 2, "{id}");
    }
}

#[test]
fn lists_of_some_particles_give_their_values() {
    let cloud = small_cloud(2);
    let u = scalars(&cloud);
    let kernel = by_id("wendland-c2").unwrap();
    let compiled = |text: &str| Program::new(&Operator::parse(text).unwrap(), &kernel, 2).unwrap();
    let f4 = compiled("sum_j V_j (u_j - u_i) B_i . gradW_ij");
    let all = f4.apply(&cloud, &Neighbours::search(&cloud).unwrap(), Fields::Scalar(&u)).unwrap();
    let some = Neighbours::search_at(&cloud, &[31, 4]).unwrap();
    let at = f4.apply(&cloud, &some, Fields::Scalar(&u)).unwrap();
    assert_eq!(at, [all[62], all[63], all[8], all[9]]);
    let rows = f4.weights(&cloud, &Neighbours::search(&cloud).unwrap()).unwrap();
    let rows_at = f4.weights(&cloud, &some).unwrap();
    assert_eq!(rows_at[1], [rows[1][31].clone(), rows[1][4].clone()]);
    let nested = compiled("sum_j V_j F2[u]_j . gradW_ij");
    let error = nested.apply(&cloud, &some, Fields::Scalar(&u)).unwrap_err();
    assert_eq!(error, ProgramError::Lists { found: 2, expected: 100 });
    assert_eq!(nested.weights(&cloud, &some).unwrap_err(), error);
}

#[test]
fn what_cannot_be_computed_is_said() {
    let kernel = by_id("wendland-c2").unwrap();
    let compile = |text: &str, dimension| Program::new(&Operator::parse(text).unwrap(), &kernel, dimension);
    let f4 = compile("sum_j V_j (u_j - u_i) B_i . gradW_ij", 2).unwrap();
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0, 0.0, 0.0]];
    let open = |support| Cloud::new(2, positions.clone(), vec![1.0; 4], support).unwrap();
    let apply = |program: &Program, cloud: &Cloud, field: Fields<'_>| {
        program.apply(cloud, &Neighbours::search(cloud).unwrap(), field).unwrap_err()
    };
    let u = [1.0, 2.0, 3.0, 4.0];
    let alone = open(Support::Uniform(1.6));
    let singular = apply(&f4, &alone, Fields::Scalar(&u));
    assert_eq!(singular, ProgramError::Singular { particle: 3, tensor: "B" });
    // In the corner of a square of three particles B exists, B̂ does not.
    let corner = Cloud::new(2, positions[..3].to_vec(), vec![1.0; 3], Support::Uniform(1.6)).unwrap();
    let s4 = remainder::language::operators::by_id("S4").unwrap();
    let hat = apply(&compile(s4.text, 2).unwrap(), &corner, Fields::Scalar(&u[..3]));
    assert!(matches!(hat, ProgramError::Singular { tensor: "B̂", .. }), "{hat}");
    let missing = apply(&compile("sum_j m_j u_j W_ij", 2).unwrap(), &alone, Fields::Scalar(&u));
    assert_eq!(missing, ProgramError::MissingField { name: "mass" });
    let other = apply(&f4, &alone, Fields::Vector(&[[0.0; 3]; 4]));
    assert_eq!(other, ProgramError::OtherField { expected: "u" });
    let short = apply(&f4, &alone, Fields::Scalar(&u[..3]));
    assert_eq!(short, ProgramError::Length { found: 3, expected: 4 });
    let uneven = open(Support::PerParticle(vec![1.6, 1.6, 1.5, 1.6]));
    assert_eq!(apply(&f4, &uneven, Fields::Scalar(&u)), ProgramError::Supports { particle: 2 });
    let line = compile("sum_j V_j u_j W_ij", 1).unwrap();
    let flat = apply(&line, &alone, Fields::Scalar(&u));
    assert_eq!(flat, ProgramError::OtherDimension { expected: 1, found: 2 });
    assert_eq!(compile("u_i", 4).unwrap_err(), ProgramError::Dimension { found: 4 });
    let zero = apply(&compile("u_i / (V_i - V_i)", 2).unwrap(), &alone, Fields::Scalar(&u));
    assert!(matches!(zero, ProgramError::NotFinite { particle: 0, .. }), "{zero}");
    let text = "sum_j V_j (sum_k V_k u_k / (rho_j + rho_k) W_ik) W_ij";
    let entangled = compile(text, 2).unwrap_err();
    assert_eq!(entangled, ProgramError::Entangled { span: 11..47 });
    assert_eq!(&text[11..47], "sum_k V_k u_k / (rho_j + rho_k) W_ik");
}
