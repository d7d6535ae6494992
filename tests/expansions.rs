//! The expansion of an operator against its stencil: for every operator of the catalogue and for random ones, what multiplies
//! ∂_α u at a particle is the moment of the weights, whatever the particles.
//!
//! Two modules are compared: `derived`, where the Taylor series is put into the operator and the sums are simplified before a
//! number is seen, and `measured::stencil`, where the tree is walked over particles and its weights are summed against
//! monomials. They have in common the tree, the ground and `exact::linear`.
//!
//! Planted errors that were seen to fail: a Taylor series without its 1/m!, ∇∇W without δ_ab W′/r or with W′/r added to its
//! other part, ∇·∇W with 2 for D, B_i for B_j, B̂ contracted with the indices of Σ ω r r ∇W, and twice the second term of the
//! rule that cancels B̂. By the random operators alone: e·e = 1 at j = i, and a sum in a divisor that takes the name of
//! the particle it belongs to.
#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

mod patches;

use patches::{Patch, Recipe, conditions};
use proptest::prelude::*;
use remainder::derived::{DeriveError, Expansion};
use remainder::exact::MultiIndex;
use remainder::kernel;
use remainder::language::ground::Ground;
use remainder::language::tree::{Kind, Node};
use remainder::language::{Operator, operators};
use remainder::measured::stencil;
use std::sync::LazyLock;

/// Relative to the terms that are summed and to the condition of the tensors that are inverted.
const TOLERANCE: f64 = 1e-12;

/// The catalogue, expanded once for all tests.
static CATALOGUE: LazyLock<Vec<(&'static str, Expansion)>> = LazyLock::new(|| {
    let expanded = |entry: operators::Entry| {
        let operator = entry.operator().unwrap();
        (entry.id, Expansion::of(operator, Some(entry.target), 4).unwrap())
    };
    operators::catalogue().into_iter().map(expanded).collect()
});

/// How many sums stand inside each other.
fn depth(node: &Node) -> usize {
    let below = node.children().into_iter().map(depth).max().unwrap_or(0);
    below + usize::from(matches!(node.kind, Kind::Sum { .. }))
}

/// The largest difference over orders 0 to `to`, in units of what rounding allows for.
fn disagreement(expansion: &Expansion, patch: &Patch, to: u8) -> Result<f64, DeriveError> {
    let (ground, i, d) = (patch.ground(), patch.centre, patch.cloud.dimension());
    let operator = &expansion.operator;
    let inverts = |kind: &Kind| {
        matches!(kind, Kind::Renormalisation(_) | Kind::RenormalisationHat(_) | Kind::Inverse(_))
    };
    let condition = match operator.root.any(&inverts) {
        true => ground.neighbours(i).into_iter().map(|(p, _)| conditions(&ground, p)).fold(1.0, f64::max),
        false => 1.0,
    };
    let stencil = stencil(operator, &ground, i).unwrap();
    // A particle met over one or two others is no further than R for each, and the expansion sums r_ij and r_jk apart.
    let reach = patch.cloud.support_of(i) * depth(&operator.root) as f64;
    let mut worst = 0.0_f64;
    for order in 0..=to {
        let coefficients = expansion.coefficients_at::<f64>(&ground, i, order.into())?;
        let allowed = TOLERANCE * condition * stencil.magnitude(0) * reach.powi(order.into());
        for (alpha, coefficient) in MultiIndex::all(d, order).unwrap().iter().zip(coefficients) {
            let moment = stencil.moment(alpha);
            assert_eq!(moment.len(), coefficient.len());
            for (moment, coefficient) in moment.iter().flatten().zip(coefficient.iter().flatten()) {
                let off = (moment - coefficient).abs() / allowed;
                worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
            }
        }
    }
    Ok(worst)
}

/// Every operator of the catalogue, to fourth order; to third where sums are nested in 3-D.
fn assert_the_catalogue_agrees(name: &str, patch: &Patch) {
    for (id, expansion) in CATALOGUE.iter() {
        let to = match (patch.cloud.dimension(), depth(&expansion.operator.root)) {
            (3, 2..) => 3,
            _ => 4,
        };
        let off =
            disagreement(expansion, patch, to).unwrap_or_else(|error| panic!("{id} on {name}: {error}"));
        eprintln!("{id} on {name}: {off:.1e}");
        assert!(off <= 1.0, "{id} on {name}: {off:e} times what rounding allows");
    }
}

const DISORDERED: [Recipe; 3] = [
    Recipe { lattice: "line", support: 2.6, reach: 2.2, jitter: 0.3, surface: None, seed: 1 },
    Recipe { lattice: "square", support: 2.1, reach: 2.4, jitter: 0.25, surface: None, seed: 2 },
    Recipe { lattice: "simple-cubic", support: 1.6, reach: 2.4, jitter: 0.15, surface: None, seed: 3 },
];

#[test]
fn on_disordered_particles() {
    for (recipe, kernel) in DISORDERED.iter().zip(["wendland-c2-1d", "cubic-spline", "wendland-c4"]) {
        assert_the_catalogue_agrees(recipe.lattice, &recipe.patch(&kernel::by_id(kernel).unwrap()));
    }
}

#[test]
fn on_lattices() {
    let lattices = [
        ("line", 2.5),
        ("square", 2.1),
        ("hexagonal", 1.9),
        ("staggered", 2.1),
        ("simple-cubic", 1.5),
        ("hcp", 1.5),
    ];
    for (lattice, support) in lattices {
        let recipe = Recipe { lattice, support, reach: 2.1, jitter: 0.0, surface: None, seed: 4 };
        assert_the_catalogue_agrees(lattice, &recipe.patch(&kernel::by_id("quintic-spline").unwrap()));
    }
}

#[test]
fn near_a_free_surface() {
    for (recipe, support) in DISORDERED.iter().zip([2.6, 2.6, 1.9]) {
        let recipe = Recipe { surface: Some(0.3), support, ..*recipe };
        let name = format!("{} near a surface", recipe.lattice);
        assert_the_catalogue_agrees(&name, &recipe.patch(&kernel::by_id("wendland-c2").unwrap()));
    }
}

/// Decisions taken one after the other; when they run out the first possibility is taken, which is the simplest.
struct Choices<'a> {
    bytes: std::slice::Iter<'a, u8>,
    letters: std::str::Chars<'static>,
    field: &'static str,
}

/// A piece of text and the rank of its value.
type Typed = (String, u8);

impl Choices<'_> {
    fn of(&mut self, possibilities: usize) -> usize {
        self.bytes.next().map_or(0, |byte| usize::from(*byte) % possibilities)
    }

    fn letter(&mut self) -> char {
        self.letters.next().unwrap()
    }

    fn product(&mut self, a: Typed, b: Typed) -> Typed {
        let most = a.1.min(b.1);
        let count = self.of(usize::from(most.min(2)) + 1) as u8;
        let rank = a.1 + b.1 - 2 * count;
        // The expansion of a nested sum holds tensors of the rank of all its factors: keep it low.
        let count = if rank > 3 { most.min(2) } else { count };
        let sign = ["*", ".", ":"][usize::from(count)];
        (format!("({} {sign} {})", a.0, b.0), a.1 + b.1 - 2 * count)
    }

    fn kernel(&mut self, p: char, q: char) -> Typed {
        let (text, rank) = [("W_", 0), ("h gradW_", 1), ("h^2 lapW_", 0), ("h^2 gradgradW_", 2)][self.of(4)];
        (format!("(V_{q} {text}{p}{q})"), rank)
    }

    /// Something of a pair, of one of its particles or of none: a pure number of any rank.
    fn factor(&mut self, p: char, q: char) -> Typed {
        let pq = format!("{p}{q}");
        let (text, rank) = match self.of(17) {
            0 => (format!("e_{pq}"), 1),
            1 => (format!("(r_{pq} / h)"), 1),
            2 => (format!("(|r_{pq}| / h)"), 0),
            3 => (format!("(h / |r_{pq}|)"), 0),
            4 => (format!("(h^2 / (|r_{pq}|^2 + 0.01 h^2))"), 0),
            5 => (format!("(|r_{pq}|^2 / h^2)"), 0),
            6 => (format!("B_{p}"), 2),
            7 => (format!("B_{q}"), 2),
            8 => (format!("(rho_{p} / (rho_{p} + rho_{q}))"), 0),
            9 => (format!("(mu_{p} / mu_{q})"), 0),
            10 => {
                let k = self.letter();
                (format!("(1 / (sum_{k} V_{k} W_{p}{k}))"), 0)
            }
            11 => {
                let k = self.letter();
                (format!("(sum_{k} V_{k} h gradW_{q}{k})"), 1)
            }
            12 => {
                let k = self.letter();
                (format!("inverse(-sum_{k} V_{k} r_{p}{k} gradW_{p}{k})"), 2)
            }
            13 => ("I".to_owned(), 2),
            14 => ("(2/3 - D)".to_owned(), 0),
            15 => ("pi".to_owned(), 0),
            _ => (format!("(h^2 |r_{pq}|^-2)"), 0),
        };
        (text, rank)
    }

    /// What is linear in the field; sums inside only where no other is.
    fn field(&mut self, p: char, q: char, nested: bool) -> Typed {
        let (f, rank) = (self.field, u8::from(self.field == "v"));
        match self.of(if nested { 5 } else { 7 }) {
            0 => (format!("{f}_{q}"), rank),
            1 => (format!("({f}_{q} - {f}_{p})"), rank),
            2 => (format!("({f}_i + 2 {f}_{q})"), rank),
            3 => (format!("{f}_{p}"), rank),
            4 => {
                let k = self.letter();
                (format!("(mean_{k} {f}_{k})"), rank)
            }
            5 => {
                let wanted = self.of(3) as u8;
                self.sum(q, wanted, true)
            }
            _ if f == "u" => (format!("(h F4[u]_{q})"), 1),
            _ => (format!("(h basa-18[v]_{q})"), 0),
        }
    }

    /// A sum over the neighbours of `p`, of the rank that is wanted.
    fn sum(&mut self, p: char, wanted: u8, nested: bool) -> Typed {
        let q = self.letter();
        let mut body = self.kernel(p, q);
        for _ in 0..self.of(3) {
            let factor = self.factor(p, q);
            body = self.product(body, factor);
        }
        let field = self.field(p, q, nested);
        body = self.product(body, field);
        while body.1 != wanted {
            let sign = if body.1 > wanted { '.' } else { '*' };
            let rank = if body.1 > wanted { body.1 - 1 } else { body.1 + 1 };
            body = (format!("({} {sign} e_{p}{q})", body.0), rank);
        }
        (format!("(sum_{q} {})", body.0), wanted)
    }

    fn operator(&mut self) -> String {
        self.field = ["u", "v"][self.of(2)];
        let rank = self.of(3) as u8;
        let first = self.sum('i', rank, false).0;
        match self.of(2) {
            0 => first,
            _ => format!("{first} - 1/3 {}", self.sum('i', rank, false).0),
        }
    }
}

/// What the random operators below have found.
#[test]
fn what_cancels_and_what_is_bound_elsewhere() {
    let found = [
        // What divided by |r_ij| leaves j = i out, also when the distance cancels.
        "sum_j V_j u_j h^2 gradgradW_ij * e_ij . e_ij",
        "sum_j V_j u_j r_ij . r_ij |r_ij|^-2 W_ij",
        "sum_j V_j (sum_k V_k u_k (e_jk . e_jk) W_jk) (e_ij . r_ij) / |r_ij| W_ij",
        // The reciprocal belongs to j.
        "sum_j V_j W_ij (sum_k V_k u_k W_jk) / (sum_l V_l W_jl)",
        // A vector has one component on a line.
        "sum_j V_j v_j . gradW_ij",
    ];
    for text in found {
        for recipe in &DISORDERED[..2] {
            let patch = recipe.patch(&kernel::by_id("wendland-c2").unwrap());
            let expansion = Expansion::of(Operator::parse(text).unwrap(), None, 3).unwrap();
            let off = disagreement(&expansion, &patch, 3).unwrap();
            assert!(off <= 1.0, "{text} on {}: {off:e} times what rounding allows", recipe.lattice);
        }
    }
}

fn random_operator() -> impl Strategy<Value = String> {
    prop::collection::vec(any::<u8>(), 0..30).prop_map(|bytes| {
        let letters = "jklmnopqrstwxyzabcdefg".chars();
        Choices { bytes: bytes.iter(), letters, field: "u" }.operator()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_operators_agree(text in random_operator(), two in any::<bool>(), seed in any::<u64>()) {
        let operator = Operator::parse(&text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
        let recipe = match two {
            true => Recipe { lattice: "hexagonal", support: 1.4, reach: 3.1, jitter: 0.1, surface: None, seed },
            false => Recipe { lattice: "line", support: 2.2, reach: 3.1, jitter: 0.2, surface: None, seed },
        };
        let patch = recipe.patch(&kernel::by_id("wendland-c2").unwrap());
        let to = if two { 3 } else { 4 };
        let off = Expansion::of(operator, None, to).and_then(|expansion| disagreement(&expansion, &patch, to as u8));
        match off {
            Ok(off) => prop_assert!(off <= 1.0, "{text}: {off:e} times what rounding allows"),
            Err(DeriveError::TooLarge { .. }) => return Err(TestCaseError::reject("too many terms")),
            Err(error) => prop_assert!(false, "{text}: {error}"),
        }
    }
}
