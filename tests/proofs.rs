//! Up to which degree operators take polynomials exactly, in rational arithmetic: what a stencil makes of ∂_α u minus what it
//! should make of it is the number 0, and one degree higher it is not. The same from the symbolic side.
//!
//! Two modules are compared: `measured::stencil`, in rationals on arrangements without symmetry, and `derived`, whose proof
//! is that a coefficient vanishes identically. The target's coefficients come from `language::Target` and are themselves
//! checked against derivatives of monomials.
//!
//! Planted errors that were seen to fail: B̂ contracted with the indices of Σ ω r r ∇W, twice the second term of the rule that
//! cancels B̂, a Taylor series without its 1/m!, coefficients that are never shown not to vanish, mixed derivatives counted
//! once for each order of their indices, and r_j − r_i with its sign turned.
#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::derived::{Arrangement, DeriveError, Expansion};
use remainder::exact::{MultiIndex, Number, Order, Rational, Solution, int, ratio, solve};
use remainder::language::ground::{Ground, MissingQuantity};
use remainder::language::tree::OfParticle;
use remainder::language::{Derivative, Field, Operator, Target, operators};
use remainder::measured::{Stencil, StencilError, stencil};

/// Operators and the highest degree of polynomials that they take exactly on all particles.
const EXACT_TO: [(&str, u8); 14] = [
    ("F2", 0),
    ("G-", 0),
    ("MEA", 0),
    ("MCG", 0),
    ("S2-11", 0),
    ("S3", 0),
    ("E", 0),
    ("basa-17", 0),
    ("shepard", 0),
    ("shepard-gradient", 0),
    ("pressure-reduction", 0),
    ("F4", 1),
    ("mixed-correction", 1),
    ("S4", 2),
];

/// All index tuples of this rank, the first index the slowest.
fn tuples(dimension: usize, rank: u8) -> Vec<Vec<usize>> {
    (0..rank).fold(vec![Vec::new()], |tuples, _| {
        tuples.iter().flat_map(|t| (0..dimension).map(move |a| [t.as_slice(), &[a]].concat())).collect()
    })
}

/// The axes of ∂_α.
fn axes(alpha: &MultiIndex) -> Vec<usize> {
    (0..3).flat_map(|a| std::iter::repeat_n(a, alpha.powers[a].into())).collect()
}

/// What multiplies ∂_α in the stencil, minus what should: by component of the field, then of the value.
fn error<T: Number>(
    stencil: &Stencil<T>,
    target: &Target,
    alpha: &MultiIndex,
    ground: &dyn Ground<T>,
    i: usize,
) -> Vec<T> {
    let of = |quantity, power: i32| ground.of_particle(quantity, i).unwrap().power(power).unwrap();
    let scale = of(OfParticle::Density, target.density) * of(OfParticle::Viscosity, target.viscosity);
    let values = tuples(stencil.dimension, stencil.rank);
    let mut errors = Vec::new();
    for (component, moments) in stencil.moment(alpha).into_iter().enumerate() {
        assert_eq!(moments.len(), values.len());
        for (moment, value) in moments.into_iter().zip(&values) {
            let wanted = target.coefficient(stencil.field, value, &axes(alpha), component);
            errors.push(moment - scale.clone() * T::from_rational(&wanted));
        }
    }
    errors
}

/// By order 0, 1, … `to`: whether all coefficients of that order are what they should be.
fn exact_orders(id: &str, ground: &dyn Ground<Rational>, to: u8) -> Vec<bool> {
    let entry = operators::by_id(id).unwrap();
    let stencil =
        stencil(&entry.operator().unwrap(), ground, 0).unwrap_or_else(|error| panic!("{id}: {error}"));
    assert!(stencil.least_norm.is_empty(), "{id}");
    let order = |order| {
        let all = MultiIndex::all(ground.dimension(), order).unwrap();
        all.iter().all(|alpha| error(&stencil, &entry.target, alpha, ground, 0).iter().all(Number::is_nought))
    };
    (0..=to).map(order).collect()
}

#[test]
fn targets_count_each_derivative_once() {
    let plain = Target::plain;
    let laplacian = plain(Derivative::Laplacian { grad_div: 0 });
    let count = |target: &Target, field, value: &[usize], alpha: &[usize], component| {
        target.coefficient(field, value, alpha, component)
    };
    // ∇²(xy) = 0, ∇²(x²/2) = 1; ∂_x∂_y(xy) = 1, and the tensor has it in xy and in yx.
    assert_eq!(count(&laplacian, Field::Scalar, &[], &[0, 1], 0), int(0));
    assert_eq!(count(&laplacian, Field::Scalar, &[], &[1, 1], 0), int(1));
    for value in [[0, 1], [1, 0]] {
        for alpha in [[0, 1], [1, 0]] {
            assert_eq!(count(&plain(Derivative::Hessian), Field::Scalar, &value, &alpha, 0), int(1));
        }
    }
    // ∇²v + 2∇(∇·v): of v = (0, xy) it is (2, 0), of v = (x²/2, 0) it is (3, 0), of v = (y²/2, 0) it is (1, 0).
    let mixed = plain(Derivative::Laplacian { grad_div: 2 });
    for (alpha, component, wanted) in [([0, 1], 1, [2, 0]), ([0, 0], 0, [3, 0]), ([1, 1], 0, [1, 0])] {
        for (value, wanted) in wanted.iter().enumerate() {
            assert_eq!(count(&mixed, Field::Vector, &[value], &alpha, component), int(*wanted));
        }
    }
    // −2∇·v of v = (x, y) is −2 once for each axis.
    let divergence = Target { factor: -2, ..plain(Derivative::Divergence) };
    assert_eq!(count(&divergence, Field::Vector, &[], &[1], 1), int(-2));
    assert_eq!(count(&divergence, Field::Vector, &[], &[1], 0), int(0));
    // v∇: its own index first.
    assert_eq!(count(&plain(Derivative::Gradient), Field::Vector, &[0, 1], &[1], 0), int(1));
    assert_eq!(count(&plain(Derivative::Gradient), Field::Vector, &[1, 0], &[1], 0), int(0));
}

#[test]
fn stencils_are_exact_to_their_degree_and_not_beyond() {
    for (id, degree) in EXACT_TO {
        for dimension in 1..=3 {
            let mut beyond = false;
            // Rationals with thousands of digits: one arrangement says enough.
            let numbers = if id == "S4" && dimension == 3 { 1 } else { 3 };
            for number in 0..numbers {
                let mut orders = exact_orders(id, &Arrangement::new(dimension, number), degree + 1);
                let last = orders.pop().unwrap();
                assert!(
                    orders.iter().all(|exact| *exact),
                    "{id} in {dimension}-D on arrangement {number}: {orders:?}"
                );
                beyond |= !last;
            }
            assert!(beyond, "{id} in {dimension}-D takes degree {} exactly", degree + 1);
        }
    }
}

#[test]
fn expansions_prove_the_same_degrees() {
    for (id, degree) in EXACT_TO {
        let entry = operators::by_id(id).unwrap();
        let expansion = Expansion::of(entry.operator().unwrap(), Some(entry.target), 3).unwrap();
        for order in 0..=degree {
            assert!(expansion.vanishes(order.into()), "{id}, order {order}");
        }
        assert!(!expansion.vanishes(usize::from(degree) + 1), "{id}");
        for dimension in 1..=3 {
            let found = expansion.consistency(dimension).unwrap();
            assert_eq!(found, Some(Order::Exactly(degree.into())), "{id} in {dimension}-D");
        }
    }
}

/// All operators of the catalogue in 2-D: what is exact on nothing, on constants, and on more.
#[test]
fn the_degree_of_every_operator() {
    let on_nothing = [
        "F1",
        "F3",
        "F4-symmetrised",
        "S1-7-F1",
        "S1-7-F3",
        "S1-8-F1",
        "S1-8-F3",
        "S1-9-F1",
        "S1-9-F3",
        "S2-10",
        "S2-12",
        "G0",
        "G+",
        "basa-8",
        "basa-9",
        "A",
        "B",
    ];
    for entry in operators::catalogue() {
        let expansion = Expansion::of(entry.operator().unwrap(), Some(entry.target), 2).unwrap();
        let wanted = match entry.id {
            id if on_nothing.contains(&id) => None,
            "S4" => Some(Order::AtLeast(2)),
            // The renormalised gradients of a linear field are one constant, whose differences vanish.
            "F4" | "mixed-correction" | "S1-8-F4" => Some(Order::Exactly(1)),
            _ => Some(Order::Exactly(0)),
        };
        assert_eq!(expansion.consistency(2).unwrap(), wanted, "{}", entry.id);
    }
}

/// Where rational arithmetic ends: π, and distances between neighbours of i. There floating point says the same to rounding.
#[test]
fn where_rational_arithmetic_ends() {
    let entry = operators::by_id("MCG-pi").unwrap();
    let operator = entry.operator().unwrap();
    let expansion = Expansion::of(operator.clone(), Some(entry.target.clone()), 1).unwrap();
    for dimension in 1..=3 {
        let ground = Arrangement::new(dimension, 0);
        let exact = stencil::<Rational>(&operator, &ground, 0);
        assert_eq!(exact.unwrap_err(), StencilError::NotRational { what: "π" });
        assert!(matches!(
            expansion.coefficients_at::<Rational>(&ground, 0, 1),
            Err(DeriveError::NoValue { .. })
        ));
        let stencil = stencil::<f64>(&operator, &ground, 0).unwrap();
        let size = |order| {
            let all = MultiIndex::all(dimension, order).unwrap();
            let errors = all.iter().flat_map(|alpha| error(&stencil, &entry.target, alpha, &ground, 0));
            errors.map(f64::abs).fold(0.0, f64::max) / stencil.magnitude(order)
        };
        assert!(size(0) <= 1e-14, "{dimension}-D: {:e}", size(0));
        assert!(size(1) >= 1e-6, "{dimension}-D: {:e}", size(1));
        assert_eq!(expansion.consistency(dimension).unwrap(), Some(Order::Exactly(0)));
    }
    // |r_jk| of two neighbours of i.
    let nested = Operator::parse("sum_j V_j (sum_k V_k (u_k - u_j) |r_jk| W_jk) W_ij").unwrap();
    let exact = stencil::<Rational>(&nested, &Arrangement::new(2, 0), 0);
    assert_eq!(exact.unwrap_err(), StencilError::NotRational { what: "a distance" });
}

/// An arrangement and its mirror image about particle 0, kernels and weights alike on both.
struct Mirrored(Arrangement);

impl Mirrored {
    /// The particle of the arrangement that `p` is or mirrors, and its sign.
    fn original(&self, p: usize) -> (usize, i64) {
        if p < self.0.len() { (p, 1) } else { (p - self.0.len() + 1, -1) }
    }
}

impl Ground<Rational> for Mirrored {
    fn dimension(&self) -> usize {
        Ground::<Rational>::dimension(&self.0)
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [Rational; 3])> {
        let place = |p| {
            let (original, sign) = self.original(p);
            self.0.places()[original].clone().map(|x: Rational| x * int(sign))
        };
        let (here, count) = (place(p), 2 * self.0.len() - 1);
        let separation = |q: usize| {
            let there = place(q);
            std::array::from_fn(|a| &here[a] - &there[a])
        };
        (0..count).map(|q| (q, separation(q))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<Rational, MissingQuantity> {
        self.0.of_particle(quantity, self.original(p).0)
    }

    fn smoothing_length(&self) -> Rational {
        self.0.smoothing_length()
    }

    fn kernel(&self, p: usize, q: usize, r: &[Rational; 3]) -> [Rational; 3] {
        self.0.kernel(self.original(p).0, self.original(q).0, r)
    }
}

#[test]
fn inversion_gives_one_degree_more() {
    for (id, exact) in [
        // Gradients: their errors of even order vanish.
        ("F4", vec![true, true, true, false, true]),
        ("mixed-correction", vec![true, true, true, false, true]),
        ("F2", vec![true, false, true, false, true]),
        // Laplacians: those of odd order.
        ("S2-11", vec![true, true, false, true, false]),
        ("S3", vec![true, true, false, true, false]),
        ("S4", vec![true, true, true, true, false]),
    ] {
        for dimension in 1..=if id == "S4" { 2 } else { 3 } {
            let ground = Mirrored(Arrangement::new(dimension, 1));
            assert_eq!(exact_orders(id, &ground, 4), exact, "{id} in {dimension}-D");
        }
    }
}

/// Σ ω (W′/r) r^{2s} r_a r_b … over the neighbours of particle 0, s = 0 or −1.
fn sum(ground: &Arrangement, indices: &[usize], over_square: bool) -> Rational {
    let mut sum = int(0);
    for (j, r) in Ground::<Rational>::neighbours(ground, 0).into_iter().skip(1) {
        let volume: Rational = ground.of_particle(OfParticle::Volume, j).unwrap();
        let [_, slope, _]: [Rational; 3] = ground.kernel(0, j, &r);
        let mut term = indices.iter().fold(volume * slope, |product, a| product * &r[*a]);
        if over_square {
            term /= r.iter().map(|x| x * x).sum::<Rational>();
        }
        sum += term;
    }
    sum
}

/// Eq. (40) of Fatehi & Manzari 2011, B̂ : [Σ ω r e e ∇W + (Σ ω e e ∇W) · B · (Σ ω r r ∇W)] = −I, leaves open which of the
/// indices of the bracket B̂ meets. Those of the e's give S4 exact on quadratics; those of r r ∇W do not.
#[test]
fn b_hat_meets_the_indices_of_the_directions() {
    let bracketed = "sum_j 2 V_j ((u_i - u_j) / |r_ij| - e_ij . F4[u]_i) e_ij gradW_ij";
    let bracketed = Operator::parse(bracketed).unwrap();
    let laplacian = Target::plain(Derivative::Laplacian { grad_div: 0 });
    let dimension = 2;
    let ground = Arrangement::new(dimension, 2);
    let matrix: Vec<Vec<Rational>> = tuples(dimension, 2)
        .chunks(dimension)
        .map(|row| row.iter().map(|ab| -sum(&ground, ab, false)).collect())
        .collect();
    let b = remainder::exact::inverse(&matrix).unwrap();
    let bracket = |ab: &[usize], ef: &[usize]| {
        let mut entry = sum(&ground, &[ab, ef].concat(), true);
        for cg in tuples(dimension, 2) {
            let (outer, inner) = (&[ab, &cg[..1]].concat(), &[&cg[1..], ef].concat());
            entry += sum(&ground, outer, true) * &b[cg[0]][cg[1]] * sum(&ground, inner, false);
        }
        entry
    };
    let unknowns: Vec<Vec<usize>> = tuples(dimension, 2).into_iter().filter(|ab| ab[0] <= ab[1]).collect();
    let right: Vec<Rational> = unknowns.iter().map(|ef| int(-i64::from(ef[0] == ef[1]))).collect();
    let weights: Vec<Rational> = unknowns.iter().map(|ab| int(2 - i64::from(ab[0] == ab[1]))).collect();
    let solved = |entry: &dyn Fn(&[usize], &[usize]) -> Rational| -> Vec<Rational> {
        let row = |ef: &Vec<usize>| {
            unknowns.iter().zip(&weights).map(|(ab, weight)| entry(ab, ef) * weight).collect()
        };
        let matrix: Vec<Vec<Rational>> = unknowns.iter().map(row).collect();
        match solve(&matrix, &right, &weights) {
            Solution::One(solution) => solution,
            other => panic!("{other:?}"),
        }
    };
    let tensor = stencil::<Rational>(&bracketed, &ground, 0).unwrap();
    let values = tuples(dimension, 2);
    // B̂ : of the tensor's moments, B̂ symmetric.
    let contracted = |b_hat: &[Rational], alpha: &MultiIndex| -> Rational {
        let entry = |ab: &Vec<usize>| {
            let sorted = vec![ab[0].min(ab[1]), ab[0].max(ab[1])];
            &b_hat[unknowns.iter().position(|known| *known == sorted).unwrap()]
        };
        let moments = &tensor.moment(alpha)[0];
        values.iter().zip(moments).map(|(ab, moment)| entry(ab) * moment).sum()
    };
    let theirs = solved(&|ab, ef| bracket(ab, ef));
    let other = solved(&|ab, ef| bracket(ef, ab));
    let s4 = operators::by_id("S4").unwrap().operator().unwrap();
    let s4 = stencil::<Rational>(&s4, &ground, 0).unwrap();
    let mut off = false;
    for alpha in MultiIndex::all(dimension, 2).unwrap() {
        let wanted = laplacian.coefficient(Field::Scalar, &[], &axes(&alpha), 0);
        assert_eq!(contracted(&theirs, &alpha), wanted, "{alpha}");
        assert_eq!(s4.moment(&alpha)[0][0], wanted, "{alpha}");
        off |= contracted(&other, &alpha) != wanted;
    }
    assert!(off, "the other reading is exact too");
    // Constants and linear fields do not tell the two apart.
    for order in 0..2 {
        for alpha in MultiIndex::all(dimension, order).unwrap() {
            assert_eq!(contracted(&other, &alpha), int(0), "{alpha}");
        }
    }
}

/// F2 on three particles of a line, by hand: Σ ω (u_j − u_i)(W′/r)(x_i − x_j).
#[test]
fn a_stencil_by_hand() {
    struct Three;
    impl Ground<Rational> for Three {
        fn dimension(&self) -> usize {
            1
        }
        fn neighbours(&self, p: usize) -> Vec<(usize, [Rational; 3])> {
            let x = [0, 2, -3];
            (0..3).map(|q| (q, [int(x[p] - x[q]), int(0), int(0)])).collect()
        }
        fn of_particle(&self, _: OfParticle, p: usize) -> Result<Rational, MissingQuantity> {
            Ok(int([1, 5, 7][p]))
        }
        fn smoothing_length(&self) -> Rational {
            int(1)
        }
        fn kernel(&self, p: usize, q: usize, _: &[Rational; 3]) -> [Rational; 3] {
            [int(0), ratio(-1, (p + q) as i64 + 1), int(0)]
        }
    }
    let f2 = operators::by_id("F2").unwrap().operator().unwrap();
    let found = stencil(&f2, &Three, 0).unwrap();
    // 5 (u_1 − u_0)(−1/2)(−2) + 7 (u_2 − u_0)(−1/3)(3).
    assert_eq!(found.apply(|p| vec![int([10, 11, 13][p])]), [int(5 - 21)]);
    // x: 5·2 − 7·(−3) = 31; x²/2: (5·4 − 7·9)/2.
    assert_eq!(found.moment(&MultiIndex::new([1, 0, 0])), [[int(31)]]);
    assert_eq!(found.moment(&MultiIndex::new([2, 0, 0])), [[ratio(-43, 2)]]);
}
