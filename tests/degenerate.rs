//! Neighbours that are too few, on a line or in a plane: what has no stencil is refused by name, what is not determined is
//! taken with the least norm and said to be, and nothing is ever NaN.
//!
//! Exact and floating-point arithmetic are compared, and `measured::stencil` with `derived`, which have each their own B̂.
//!
//! Planted errors that were seen to fail: a line not told from a plane, particle 0 blamed for its neighbour, B̂ of a bracket
//! that is all rounding, equations without a solution taken for solved, a least norm that is not flagged, B̂ with its
//! sign turned, and twice the second term of the rule that cancels it.
#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::derived::{DeriveError, Expansion};
use remainder::exact::{MultiIndex, Number, Rational, int, ratio, rational_to_f64};
use remainder::language::ground::{Ground, MissingQuantity};
use remainder::language::tree::OfParticle;
use remainder::language::{Operator, operators};
use remainder::measured::{Degeneracy, Stencil, StencilError, stencil};

/// A few particles that are all neighbours. In floating point they are turned and scaled, so that nothing is exact there.
struct Few {
    dimension: usize,
    places: Vec<[Rational; 3]>,
}

impl Few {
    /// Particle 0 at the origin, and these.
    fn new(dimension: usize, others: &[[i64; 3]]) -> Self {
        let places = [[0; 3]].iter().chain(others).map(|place| place.map(int)).collect();
        Self { dimension, places }
    }

    fn slope(&self, p: usize, q: usize) -> Rational {
        ratio(-3, 4 + (p + q) as i64)
    }
}

impl Ground<Rational> for Few {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [Rational; 3])> {
        let separation = |q: usize| std::array::from_fn(|a| &self.places[p][a] - &self.places[q][a]);
        (0..self.places.len()).map(|q| (q, separation(q))).collect()
    }

    fn of_particle(&self, _: OfParticle, p: usize) -> Result<Rational, MissingQuantity> {
        Ok(ratio(5 + p as i64, 7))
    }

    fn smoothing_length(&self) -> Rational {
        int(1)
    }

    fn kernel(&self, p: usize, q: usize, _: &[Rational; 3]) -> [Rational; 3] {
        [int(1), self.slope(p, q), int(0)]
    }
}

/// The same in floating point, turned by two angles and scaled.
struct Turned<'a>(&'a Few);

impl Ground<f64> for Turned<'_> {
    fn dimension(&self) -> usize {
        self.0.dimension
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [f64; 3])> {
        let turn = |x: [Rational; 3]| {
            let [x, y, z] = x.map(|x| 0.7 * rational_to_f64(&x));
            let (sine, cosine) = 0.4_f64.sin_cos();
            match self.0.dimension {
                1 => [x, 0.0, 0.0],
                2 => [cosine * x - sine * y, sine * x + cosine * y, 0.0],
                _ => {
                    let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
                    let (sine, cosine) = 1.1_f64.sin_cos();
                    [x, cosine * y - sine * z, sine * y + cosine * z]
                }
            }
        };
        self.0.neighbours(p).into_iter().map(|(q, r)| (q, turn(r))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<f64, MissingQuantity> {
        self.0.of_particle(quantity, p).map(|value| rational_to_f64(&value))
    }

    fn smoothing_length(&self) -> f64 {
        1.0
    }

    fn kernel(&self, p: usize, q: usize, _: &[f64; 3]) -> [f64; 3] {
        [1.0, rational_to_f64(&self.0.slope(p, q)), 0.0]
    }
}

fn operator(id: &str) -> Operator {
    operators::by_id(id).unwrap().operator().unwrap()
}

/// The stencil of an operator in both arithmetics.
fn both(id: &str, few: &Few) -> [Result<Vec<usize>, StencilError>; 2] {
    fn tried<T: Number>(id: &str, ground: &dyn Ground<T>) -> Result<Vec<usize>, StencilError> {
        let stencil: Stencil<T> = stencil(&operator(id), ground, 0)?;
        let weights = stencil.entries.iter().flat_map(|entry| entry.weights.iter().flatten());
        assert!(weights.clone().all(|weight| weight.size().is_finite()), "{id}: {:?}", stencil.entries);
        Ok(stencil.least_norm)
    }
    [tried::<Rational>(id, few), tried(id, &Turned(few))]
}

fn refused_by_the_expansion(id: &str, few: &Few) {
    let expansion = Expansion::of(operator(id), None, 3).unwrap();
    // In the lower orders B and B̂ cancel, whether they exist or not.
    let orders = |exact: &dyn Fn(usize) -> Option<DeriveError>| (0..=3).find_map(exact);
    let exact = orders(&|order| expansion.coefficients_at::<Rational>(few, 0, order).err());
    let float = orders(&|order| expansion.coefficients_at::<f64>(&Turned(few), 0, order).err());
    for error in [exact, float] {
        assert!(matches!(error, Some(DeriveError::NoValue { particle: 0, .. })), "{id}: {error:?}");
    }
}

#[test]
fn b_is_refused_where_neighbours_do_not_span_space() {
    use Degeneracy::{InAPlane, OnALine, TooFew};
    let cases: [(usize, &[[i64; 3]], Degeneracy); 9] = [
        (1, &[], TooFew { neighbours: 0 }),
        (2, &[], TooFew { neighbours: 0 }),
        (2, &[[3, 4, 0]], TooFew { neighbours: 1 }),
        (2, &[[3, 4, 0], [6, 8, 0], [-3, -4, 0]], OnALine),
        (3, &[[1, 0, 0], [0, 1, 0]], TooFew { neighbours: 2 }),
        (3, &[[1, 2, 2], [2, 4, 4], [-1, -2, -2]], OnALine),
        (3, &[[1, 2, 2], [2, 1, -2], [11, 10, -2], [-2, 5, 14]], InAPlane),
        (3, &[[1, 2, 2], [2, 1, -2], [11, 10, -2]], InAPlane),
        (3, &[[1, 0, 0], [0, 1, 0], [3, 4, 0], [-4, 3, 0], [5, 12, 0], [-1, 0, 0]], InAPlane),
    ];
    for (dimension, others, why) in cases {
        let few = Few::new(dimension, others);
        for id in ["F4", "S4", "F4-symmetrised"] {
            let wanted = StencilError::Singular { tensor: "B", particle: 0, why };
            for found in both(id, &few) {
                assert_eq!(found.as_ref(), Err(&wanted), "{id} with {others:?}");
            }
        }
        refused_by_the_expansion("F4", &few);
        refused_by_the_expansion("S4", &few);
        // What needs no B has a value.
        for id in ["F2", "S3", "S2-11", "shepard", "MEA"] {
            assert!(both(id, &few).iter().all(Result::is_ok), "{id} with {others:?}");
        }
    }
    // The message says which particle, and what to look for.
    let [exact, _] = both("F4", &Few::new(2, &[[3, 4, 0], [-3, -4, 0]]));
    assert_eq!(exact.unwrap_err().to_string(), "B of particle 0 is singular: its neighbours lie on a line");
}

/// Of a particle that is not i: S1-7-F4 asks for B of every neighbour.
#[test]
fn the_particle_at_fault_is_named() {
    struct Chain;
    impl Ground<Rational> for Chain {
        fn dimension(&self) -> usize {
            2
        }
        fn neighbours(&self, p: usize) -> Vec<(usize, [Rational; 3])> {
            let places = [[0, 0], [1, 0], [0, 1]];
            let separation =
                |q: usize| [int(places[p][0] - places[q][0]), int(places[p][1] - places[q][1]), int(0)];
            // Particle 2 sees only 0; the others see all.
            let seen: &[usize] = if p == 2 { &[0, 2] } else { &[0, 1, 2] };
            seen.iter().map(|q| (*q, separation(*q))).collect()
        }
        fn of_particle(&self, _: OfParticle, _: usize) -> Result<Rational, MissingQuantity> {
            Ok(int(1))
        }
        fn smoothing_length(&self) -> Rational {
            int(1)
        }
        fn kernel(&self, _: usize, _: usize, _: &[Rational; 3]) -> [Rational; 3] {
            [int(1), int(-1), int(0)]
        }
    }
    let found = stencil::<Rational>(&operator("S1-7-F4"), &Chain, 0).unwrap_err();
    let why = Degeneracy::TooFew { neighbours: 1 };
    assert_eq!(found, StencilError::Singular { tensor: "B", particle: 2, why });
}

/// Neighbours whose equations for B̂ have many solutions: the Laplacian is exact on quadratics with each of them.
#[test]
fn the_least_b_hat_is_taken_and_said_to_be() {
    let cases: [(usize, &[[i64; 3]]); 3] = [
        // The cross: no neighbour has both x and y.
        (2, &[[2, 0, 0], [-2, 0, 0], [0, 2, 0], [0, -2, 0]]),
        // Arms of different length.
        (2, &[[1, 0, 0], [-2, 0, 0], [0, 3, 0], [0, -1, 0]]),
        (3, &[[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -2]]),
    ];
    for (dimension, others) in cases {
        let few = Few::new(dimension, others);
        let exact: Stencil<Rational> = stencil(&operator("S4"), &few, 0).unwrap();
        let float: Stencil<f64> = stencil(&operator("S4"), &Turned(&few), 0).unwrap();
        assert_eq!((&exact.least_norm[..], &float.least_norm[..]), (&[0][..], &[0][..]), "{others:?}");
        for order in 0..=2 {
            for alpha in MultiIndex::all(dimension, order).unwrap() {
                // ∇² of x², and of xy.
                let wanted = i64::from(order == 2 && alpha.powers.contains(&2));
                assert_eq!(exact.moment(&alpha), [[int(wanted)]], "{others:?}, {alpha}");
                let off = (float.moment(&alpha)[0][0] - wanted as f64).abs();
                assert!(off <= 1e-13 * float.magnitude(order), "{others:?}, {alpha}: off by {off:e}");
            }
        }
        let expansion = Expansion::of(operator("S4"), None, 3).unwrap();
        for (order, alpha) in
            (0..=3).flat_map(|n| MultiIndex::all(dimension, n).unwrap().into_iter().enumerate())
        {
            let n = alpha.order() as usize;
            let found = expansion.coefficients_at::<Rational>(&few, 0, n).unwrap();
            assert_eq!(found[order], exact.moment(&alpha), "{others:?}, {alpha}");
        }
    }
}

/// What is least is the norm: on the cross the component of B̂ that nothing determines is 0, and the weights are the five-point
/// star, 1/Δ² on each arm.
#[test]
fn the_cross_gives_the_five_point_star() {
    let few = Few::new(2, &[[2, 0, 0], [-2, 0, 0], [0, 2, 0], [0, -2, 0]]);
    struct Alike<'a>(&'a Few);
    impl Ground<Rational> for Alike<'_> {
        fn dimension(&self) -> usize {
            2
        }
        fn neighbours(&self, p: usize) -> Vec<(usize, [Rational; 3])> {
            self.0.neighbours(p)
        }
        fn of_particle(&self, _: OfParticle, _: usize) -> Result<Rational, MissingQuantity> {
            Ok(ratio(1, 3))
        }
        fn smoothing_length(&self) -> Rational {
            int(1)
        }
        fn kernel(&self, _: usize, _: usize, _: &[Rational; 3]) -> [Rational; 3] {
            [int(1), ratio(-2, 5), int(0)]
        }
    }
    let star = stencil(&operator("S4"), &Alike(&few), 0).unwrap();
    let weight = |p: usize| star.apply(|q| vec![int(i64::from(p == q))]);
    assert_eq!(
        [0, 1, 2, 3, 4].map(weight),
        [-1, 1, 1, 1, 1].map(|n| vec![ratio(n, if n < 0 { 1 } else { 4 })])
    );
}

#[test]
fn b_hat_without_a_solution_is_refused() {
    use Degeneracy::{TooFew, Unsolvable};
    let cases: [(usize, &[[i64; 3]], Degeneracy); 6] = [
        // One neighbour tells the first derivative and not the second.
        (1, &[[1, 0, 0]], Unsolvable { rank: 0 }),
        (2, &[[1, 0, 0], [0, 1, 0]], TooFew { neighbours: 2 }),
        (2, &[[3, 4, 0], [5, 0, 0]], TooFew { neighbours: 2 }),
        (2, &[[1, 0, 0], [-1, 0, 0], [0, 1, 0]], Unsolvable { rank: 1 }),
        (3, &[[1, 0, 0], [0, 1, 0], [0, 3, 4]], TooFew { neighbours: 3 }),
        // x² and y² stand as 9 to 16 on every neighbour, and their Laplacians are alike.
        (2, &[[3, 4, 0], [-3, -4, 0], [-3, 4, 0], [3, -4, 0]], Unsolvable { rank: 2 }),
    ];
    for (dimension, others, why) in cases {
        let few = Few::new(dimension, others);
        let wanted = StencilError::Singular { tensor: "B̂", particle: 0, why };
        for (arithmetic, found) in ["exact", "floating"].iter().zip(both("S4", &few)) {
            assert_eq!(found.as_ref(), Err(&wanted), "{arithmetic} arithmetic, {others:?}");
        }
        refused_by_the_expansion("S4", &few);
        assert_eq!(both("F4", &few), [Ok(Vec::new()), Ok(Vec::new())]);
    }
}
