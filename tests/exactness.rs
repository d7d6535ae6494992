//! The exact layer keeps its promises: `==` is mathematical equality, and enclosures enclose.
//!
//! Where it can, a test reaches one number in two ways that share no code. Planted errors that were seen to fail: see the
//! line above each test that names one.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use std::cmp::Ordering;

use num_bigint::{BigInt, BigUint};
use num_traits::{One, Signed, Zero};
use proptest::prelude::*;
use remainder::exact::*;
use serde::{Deserialize, Serialize};

/// π cut (not rounded) after a hundred decimals, OEIS A000796.
const PI: &str =
    "3.1415926535897932384626433832795028841971693993751058209749445923078164062862089986280348253421170679";

/// How many times each property is tried.
const CASES: u32 = 200;

// ---------------------------------------------------------------------------------------------------------- strategies

fn rational() -> impl Strategy<Value = Rational> {
    let mixed = prop_oneof![-9i64..=9, any::<i32>().prop_map(i64::from), any::<i64>()];
    let denominator = prop_oneof![1i64..=12, 1..=i64::MAX];
    (mixed, denominator).prop_map(|(p, q)| ratio(p, q))
}

fn small_rational() -> impl Strategy<Value = Rational> {
    (-20i64..=20, 1i64..=12).prop_map(|(p, q)| ratio(p, q))
}

fn polynomial() -> impl Strategy<Value = Polynomial> {
    prop::collection::vec(small_rational(), 0..5).prop_map(Polynomial::new)
}

fn radical() -> impl Strategy<Value = Radical> {
    let term = (small_rational(), 0i64..=30, -3i32..=3);
    prop::collection::vec(term, 0..4).prop_map(|terms| {
        terms
            .iter()
            .fold(Radical::zero(), |sum, (c, n, k)| &sum + &(&root(*n) * &Radical::pi_power(*k)).scale(c))
    })
}

fn multivariate() -> impl Strategy<Value = Multivariate> {
    let term = (small_rational(), [0u8..3, 0..3, 0..3]);
    prop::collection::vec(term, 0..4).prop_map(|terms| {
        terms.into_iter().fold(Multivariate::zero(), |sum, (c, powers)| {
            &sum + &Multivariate::monomial(MultiIndex::new(powers), c)
        })
    })
}

/// An enclosure together with a number in it: the midpoint moved by a fraction of the radius.
fn enclosed() -> impl Strategy<Value = (Enclosure, Rational)> {
    let mid = prop_oneof![-40i64..=40, any::<i64>()];
    (mid, 0u32..2000, -70i64..=20, -64i64..=64).prop_map(|(mid, rad, exp, part)| {
        let enclosure = Enclosure::from_parts(mid.into(), rad.into(), exp);
        let inside = enclosure.midpoint() + enclosure.radius() * ratio(part, 64);
        (enclosure, inside)
    })
}

fn coefficient() -> impl Strategy<Value = Coefficient> {
    prop_oneof![
        small_rational().prop_map(Coefficient::from),
        radical().prop_map(Coefficient::from),
        (radical(), radical()).prop_filter_map("zero denominator", |(a, b)| Coefficient::quotient(a, b).ok()),
    ]
}

fn root(n: i64) -> Radical {
    Radical::sqrt_of(&int(n)).unwrap()
}

fn polynomial_of(coefficients: &[i64]) -> Polynomial {
    Polynomial::new(coefficients.iter().copied().map(int).collect())
}

fn power_of_two(bits: u32) -> Rational {
    Rational::from_integer(BigInt::one() << bits)
}

// ----------------------------------------------------------------------------------------------------------- rationals

#[test]
fn decimals_are_read_exactly() {
    for (text, expected) in [
        ("3", int(3)),
        ("+3", int(3)),
        ("-7/2", ratio(-7, 2)),
        ("2.5", ratio(5, 2)),
        ("-.5", ratio(-1, 2)),
        ("1e-3", ratio(1, 1000)),
        ("1.50E+2", int(150)),
        (" 6/4 ", ratio(3, 2)),
    ] {
        assert_eq!(parse_rational(text), Ok(expected), "{text}");
    }
}

#[test]
fn what_is_not_a_rational_is_refused_with_its_text() {
    for text in [
        "", "-", "--1", "1/2/3", "1/-2", "1.5/2", "e3", "1e", "1e-", ".", "0x10", "1_000", "½", "nan", "inf",
        "1 2",
    ] {
        let error = parse_rational(text).unwrap_err();
        assert_eq!(error, ExactError::NotARational { text: text.to_owned() });
        assert!(error.to_string().contains(&format!("`{text}`")));
    }
    assert!(matches!(parse_rational("1/0"), Err(ExactError::DivisionByZero { .. })));
    assert!(matches!(parse_rational("1e999999999999"), Err(ExactError::ExponentTooLarge { .. })));
}

#[test]
fn a_float_is_read_as_it_prints() {
    assert_eq!(rational_from_decimal(3.15), Ok(ratio(63, 20)));
    assert_eq!(rational_from_decimal(0.1), Ok(ratio(1, 10)));
    assert_eq!(rational_from_decimal(-2e-7), Ok(ratio(-1, 5_000_000)));
    assert_eq!(rational_from_decimal(-0.0), Ok(int(0)));
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(rational_from_decimal(value), Err(ExactError::NotFinite { .. })));
    }
}

#[test]
fn huge_fractions_have_floats() {
    let huge = Rational::from_integer(BigInt::from(10).pow(5000));
    assert_eq!(rational_to_f64(&(&huge / (&huge * int(3)))), 1.0 / 3.0);
    assert_eq!(rational_to_f64(&((&huge + int(1)) / (&huge * int(4) - int(1)))), 0.25);
    assert_eq!(rational_to_f64(&huge), f64::INFINITY);
    assert_eq!(rational_to_f64(&huge.recip()), 0.0);
}

#[test]
fn rationals_travel_through_json_as_text() {
    #[derive(Serialize, Deserialize)]
    struct Holder {
        #[serde(with = "serde_rational")]
        value: Rational,
    }
    let text = serde_json::to_string(&Holder { value: ratio(-6, 4) }).unwrap();
    assert_eq!(text, r#"{"value":"-3/2"}"#);
    assert_eq!(serde_json::from_str::<Holder>(&text).unwrap().value, ratio(-3, 2));
    assert!(serde_json::from_str::<Holder>(r#"{"value":"1/0"}"#).is_err());
}

// --------------------------------------------------------------------------------------------------------- polynomials

#[test]
fn polynomials_are_trimmed_and_print() {
    let p = Polynomial::new(vec![int(1), int(0), ratio(-3, 2), ratio(3, 4), int(0)]);
    assert_eq!(p.degree(), Some(3));
    assert_eq!(p.to_string(), "1 - 3/2·x^2 + 3/4·x^3");
    assert_eq!(polynomial_of(&[0, -1]).to_string(), "-x");
    assert_eq!(Polynomial::zero().to_string(), "0");
    assert_eq!(Polynomial::zero().degree(), None);
    assert_eq!(Polynomial::constant(int(0)), Polynomial::zero());
    assert_eq!(p.first_odd_power(), Some(3));
    assert_eq!(polynomial_of(&[1, 0, 5]).first_odd_power(), None);
    assert_eq!(polynomial_of(&[0, 2, 0, 1]).first_odd_power(), Some(1));
}

#[test]
fn powers_of_x_divide_only_what_they_divide() {
    let p = polynomial_of(&[0, 0, 3, 1]);
    assert_eq!(p.shift_divide(2), Some(polynomial_of(&[3, 1])));
    assert_eq!(p.shift_divide(3), None);
    assert_eq!(p.shift_divide(99), None);
    assert_eq!(Polynomial::zero().shift_divide(4), Some(Polynomial::zero()));
    assert_eq!(Polynomial::monomial(int(5), 3), polynomial_of(&[0, 0, 0, 5]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn rationals_print_and_parse(value in rational()) {
        prop_assert_eq!(parse_rational(&rational_text(&value)), Ok(value));
    }

    #[test]
    fn any_float_returns_from_its_decimal(value in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO) {
        prop_assert_eq!(rational_to_f64(&rational_from_decimal(value).unwrap()), value);
    }

    #[test]
    fn polynomials_form_a_ring(a in polynomial(), b in polynomial(), c in polynomial()) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!(&(&a + &b) + &c, &a + &(&b + &c));
        prop_assert_eq!(&(&a * &b) * &c, &a * &(&b * &c));
        prop_assert_eq!(&a * &(&b + &c), &(&a * &b) + &(&a * &c));
        prop_assert_eq!(&(&a - &b) + &b, a.clone());
        prop_assert_eq!(&a + &-&a, Polynomial::zero());
        prop_assert_eq!(a.pow(3), &(&a * &a) * &a);
        prop_assert_eq!(a.shift_multiply(3).shift_divide(3), Some(a));
    }

    #[test]
    fn evaluation_is_a_homomorphism(a in polynomial(), b in polynomial(), x in small_rational()) {
        prop_assert_eq!((&a * &b).evaluate(&x), a.evaluate(&x) * b.evaluate(&x));
        prop_assert_eq!((&a - &b).evaluate(&x), a.evaluate(&x) - b.evaluate(&x));
        prop_assert_eq!(a.compose(&b).evaluate(&x), a.evaluate(&b.evaluate(&x)));
        prop_assert_eq!(a.scale(&x).evaluate(&x), a.evaluate(&x) * &x);
    }

    #[test]
    fn derivative_undoes_antiderivative(a in polynomial(), b in polynomial()) {
        prop_assert_eq!(a.antiderivative().derivative(), a.clone());
        prop_assert_eq!(a.antiderivative().evaluate(&int(0)), int(0));
        prop_assert_eq!((&a * &b).derivative(), &(&a.derivative() * &b) + &(&a * &b.derivative()));
    }
}

// ------------------------------------------------------------------------------------------------ piecewise polynomials

/// The cubic B-spline of Monaghan & Lattanzio (Astron. Astrophys. 149, 1985) without its normalisation:
/// `1 − 3q²/2 + 3q³/4` up to 1, `(2 − q)³/4` up to 2.
fn cubic_spline() -> Piecewise {
    let inner = Polynomial::new(vec![int(1), int(0), ratio(-3, 2), ratio(3, 4)]);
    let outer = polynomial_of(&[2, -1]).pow(3).scale(&ratio(1, 4));
    Piecewise::new(vec![int(0), int(1), int(2)], vec![inner, outer]).unwrap()
}

// Fails if the difference of two pieces is taken around 0 instead of around their knot.
#[test]
fn the_cubic_spline_jumps_in_its_third_derivative() {
    let mut w = cubic_spline();
    for expected in [3, 2, 1, 0] {
        assert_eq!((w.jump_order(1), w.jump_order(2)), (Some(expected), Some(expected)));
        w = w.derivative();
    }
    assert_eq!(
        (w.jump_order(0), w.jump_order(1), w.jump_order(2), w.jump_order(3)),
        (None, None, None, None)
    );
}

#[test]
fn smooth_knots_and_the_end_of_the_support_are_told_apart() {
    let p = polynomial_of(&[1, -2, 1]); // (1 - x)^2
    let cut = Piecewise::new(vec![int(0), ratio(1, 3), int(1)], vec![p.clone(), p]).unwrap();
    assert_eq!(cut.jump_order(1), None);
    assert_eq!(cut.jump_order(2), Some(2));
}

#[test]
fn the_cubic_spline_integrates_to_its_known_normalisations() {
    // 2/3, 10/(7π) and 1/π in one, two and three dimensions (Monaghan, Annu. Rev. Astron. Astrophys. 30, 1992).
    let w = cubic_spline();
    let x = |power| Polynomial::monomial(int(1), power);
    assert_eq!(w.integrate() * int(2), ratio(3, 2));
    assert_eq!(w.times(&x(1)).integrate() * int(2), ratio(7, 10));
    assert_eq!(w.times(&x(2)).integrate() * int(4), int(1));
    assert_eq!(w.scale(&ratio(2, 3)).integrate(), ratio(1, 2));
}

#[test]
fn knots_belong_to_the_piece_on_their_right_and_the_last_to_the_left() {
    let step =
        Piecewise::new(vec![int(0), int(1), int(2)], vec![polynomial_of(&[5]), polynomial_of(&[7])]).unwrap();
    let at = |x| step.evaluate(&x);
    assert_eq!([at(int(0)), at(ratio(99, 100)), at(int(1)), at(int(2))], [int(5), int(5), int(7), int(7)]);
    assert_eq!([at(ratio(-1, 9)), at(ratio(201, 100))], [int(0), int(0)]);
    assert_eq!(step.piece_at(&int(3)), None);
    assert_eq!((step.jump_order(1), step.jump_order(2)), (Some(0), Some(0)));
    assert_eq!(step.support(), &int(2));
}

#[test]
fn bad_knots_are_refused() {
    let piece = || polynomial_of(&[1]);
    assert_eq!(Piecewise::new(vec![int(0)], vec![]), Err(ExactError::KnotCount { knots: 1, pieces: 0 }));
    assert!(matches!(Piecewise::new(vec![int(1), int(2)], vec![piece()]), Err(ExactError::FirstKnot { .. })));
    let repeated = Piecewise::new(vec![int(0), int(1), int(1)], vec![piece(), piece()]);
    assert!(matches!(repeated, Err(ExactError::KnotsNotIncreasing { index: 2, .. })));
}

// -------------------------------------------------------------------------------------------------------- multi-indices

#[test]
fn a_rotation_by_a_pythagorean_angle_keeps_the_radius() {
    let index = |text| MultiIndex::from_letters(text).unwrap();
    let square = |text| Multivariate::monomial(index(text), int(1));
    let radius = &(&square("xx") + &square("yy")) + &square("zz");
    let rotation =
        [[ratio(3, 5), ratio(-4, 5), int(0)], [ratio(4, 5), ratio(3, 5), int(0)], [int(0), int(0), int(1)]];
    assert_eq!(radius.substitute_linear(&rotation), radius);
    // The first index of the matrix is the variable that is replaced: x becomes 3/5 x - 4/5 y.
    assert_eq!(square("x").substitute_linear(&rotation).to_string(), "3/5·x - 4/5·y");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn multivariate_evaluation_is_a_homomorphism(
        a in multivariate(), b in multivariate(), x in [small_rational(), small_rational(), small_rational()],
        m in prop::array::uniform3(prop::array::uniform3(small_rational()))
    ) {
        prop_assert_eq!((&a * &b).evaluate(&x), a.evaluate(&x) * b.evaluate(&x));
        prop_assert_eq!((&a - &b).evaluate(&x), a.evaluate(&x) - b.evaluate(&x));
        prop_assert!((&a - &a).is_zero());
        let mx = [0, 1, 2].map(|row: usize| (0..3).map(|column| &m[row][column] * &x[column]).sum::<Rational>());
        prop_assert_eq!(a.substitute_linear(&m).evaluate(&x), a.evaluate(&mx));
    }
}

// ------------------------------------------------------------------------------------------------------------- radicals

// Fails if the product of √m and √n leaves the gcd under the root.
#[test]
fn products_of_roots_are_recognised() {
    assert_eq!(&root(2) * &root(8), Radical::from(int(4)));
    let one = Radical::one();
    assert_eq!((&(&one + &root(2)) * &(&one - &root(2))).as_rational(), Some(int(-1)));
    assert_eq!(&root(6) * &root(10), root(15).scale(&int(2)));
    assert_eq!(Radical::sqrt_of(&ratio(3, 8)).unwrap(), root(6).scale(&ratio(1, 4)));
    assert_eq!(&Radical::pi_power(3) * &Radical::pi_power(-3), one);
}

#[test]
fn zero_is_recognised_and_near_zero_is_not_taken_for_it() {
    let sum = &root(2) + &root(3);
    let zero = &(&(&sum * &sum) - &Radical::from(int(5))) - &root(6).scale(&int(2));
    assert!(zero.is_zero());
    // √10 + √11 and √5 + √18 differ in the fourth digit only.
    let [a, b] = [[10, 11], [5, 18]].map(|[m, n]| &root(m) + &root(n));
    assert!(!(&a - &b).is_zero());
    // A convergent of π, 3.8e-30 below it: a transcendental number is no rational.
    let close = &Radical::pi_power(1) - &Radical::from(ratio(428_224_593_349_304, 136_308_121_570_117));
    assert!(!close.is_zero());
    assert_eq!(close.enclose(60).sign(), None);
    assert_eq!(close.enclose(200).sign(), Some(Ordering::Greater));
    assert_eq!(close.as_rational(), None);
}

#[test]
fn squares_are_taken_out_of_large_integers() {
    // 999983 is a prime; 10^12 + 39 is a prime.
    let prime = 999_983i64;
    assert_eq!(root(prime * prime).as_rational(), Some(int(prime)));
    assert_eq!(root(prime * prime * 12), root(3).scale(&int(2 * prime)));
    assert_eq!(root(1_000_000_000_039).to_string(), "√1000000000039");
    assert_eq!(root(0), Radical::zero());
    assert!(matches!(Radical::sqrt_of(&int(-4)), Err(ExactError::NegativeRadicand { .. })));
    // Two primes above the largest trial divisor: their square is recognised, their cube's squarefree part is not found.
    let large = Rational::from_integer(BigInt::from(2_147_483_647u64));
    assert_eq!(Radical::sqrt_of(&(&large * &large)).unwrap().as_rational(), Some(large.clone()));
    assert!(matches!(Radical::sqrt_of(&(&large * &large * &large)), Err(ExactError::NotFactored { .. })));
}

#[test]
fn radicals_print_in_the_order_of_their_powers_of_pi() {
    let number = &(&root(3) * &Radical::pi_power(-1)).scale(&ratio(7, 2)) + &Radical::from(ratio(1, 4));
    assert_eq!(number.to_string(), "7/2·√3·π^-1 + 1/4");
    assert_eq!((-&Radical::pi_power(1)).to_string(), "-π");
    assert_eq!(serde_json::to_string(&number).unwrap(), r#""7/2·√3·π^-1 + 1/4""#);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn radicals_form_a_ring(a in radical(), b in radical(), c in radical()) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!(&(&a * &b) * &c, &a * &(&b * &c));
        prop_assert_eq!(&a * &(&b + &c), &(&a * &b) + &(&a * &c));
        prop_assert!((&a - &a).is_zero());
        prop_assert_eq!((&a + &b).pow(2), &(&(&a * &a) + &(&a * &b).scale(&int(2))) + &(&b * &b));
        prop_assert_eq!((&a * &b).is_zero(), a.is_zero() || b.is_zero());
    }

    #[test]
    fn roots_square_to_their_radicand(p in 0i64..1_000_000, q in 1i64..1_000_000) {
        let root = Radical::sqrt_of(&ratio(p, q)).unwrap();
        prop_assert_eq!((&root * &root).as_rational(), Some(ratio(p, q)));
        prop_assert!(root.terms().all(|(_, n, _)| (2..1000u32).all(|d| !(n % (d * d)).is_zero())));
    }

    /// Radical arithmetic and enclosure arithmetic reach one number.
    #[test]
    fn radical_arithmetic_agrees_with_enclosures(a in radical(), b in radical(), bits in 0u32..150) {
        let (x, y) = (a.enclose(bits), b.enclose(bits));
        prop_assert!((&a * &b).enclose(bits + 40).overlaps(&(&x * &y)));
        prop_assert!((&a - &b).enclose(bits + 40).overlaps(&(&x - &y)));
        prop_assert!(x.radius() <= power_of_two(bits).recip());
        prop_assert!(x.overlaps(&a.enclose(2 * bits + 30)));
    }
}

// ----------------------------------------------------------------------------------------------------------- enclosures

#[test]
fn pi_has_its_known_digits() {
    let below = parse_rational(PI).unwrap();
    let above = &below + parse_rational("1e-100").unwrap();
    for bits in [0, 1, 10, 64, 300] {
        let pi = Enclosure::pi(bits);
        assert!(pi.radius() <= power_of_two(bits).recip(), "{bits} bits");
        // π lies between `below` and `above`, and at 300 bits the enclosure is wider than the two are apart.
        assert!(pi.contains(&below) || pi.contains(&above), "{bits} bits: {pi}");
    }
    let wide = Enclosure::pi(1000);
    let (lowest, highest) = (wide.midpoint() - wide.radius(), wide.midpoint() + wide.radius());
    assert!(below < lowest && highest < above);
    let (digits, radius) = Enclosure::pi(200).decimal(50);
    assert_eq!(digits, "3.14159265358979323846264338327950288419716939937511");
    assert!(parse_rational(&radius).unwrap() < parse_rational("5.1e-51").unwrap());
}

// Fails if the upper end of a square root is rounded down.
#[test]
fn two_ways_to_one_root_overlap() {
    for n in 1..200i64 {
        let by_integer = root(n).enclose(120);
        let by_enclosure = Enclosure::exact(&int(n), 90).sqrt(90).unwrap();
        assert!(by_integer.overlaps(&by_enclosure), "√{n}");
        assert!(!by_integer.overlaps(&Enclosure::exact(&int(n), 90).sqrt(90).map(|x| &x + &tiny()).unwrap()));
    }
    fn tiny() -> Enclosure {
        Enclosure::from_parts(1.into(), BigUint::zero(), -80)
    }
}

#[test]
fn undefined_and_cannot_tell_are_different() {
    let around_zero = Enclosure::from_parts(1.into(), 2u32.into(), -3);
    let one = Enclosure::from_i64(1);
    assert!(matches!(one.div(&around_zero, 10), Err(ExactError::DivisorMayVanish { .. })));
    assert!(matches!(one.div(&Enclosure::from_i64(0), 10), Err(ExactError::DivisionByZero { .. })));
    assert!(matches!(around_zero.sqrt(10), Err(ExactError::RadicandMayBeNegative { .. })));
    assert!(matches!(Enclosure::from_i64(-2).sqrt(10), Err(ExactError::NegativeRadicand { .. })));
    assert!(Enclosure::from_parts(1.into(), 1u32.into(), 0).sqrt(10).unwrap().contains(&int(0)));
    assert_eq!(around_zero.sign(), None);
    assert_eq!(Enclosure::from_i64(0).sign(), Some(Ordering::Equal));
    assert_eq!((-&one).sign(), Some(Ordering::Less));
    assert_eq!(around_zero.relative_accuracy_bits(), None);
    assert_eq!(one.relative_accuracy_bits(), Some(i64::MAX));
}

// Fails if the nearest float is handed out as a bound.
#[test]
fn float_bounds_are_outward_at_the_edges() {
    let ball = |mid: i64, rad: u32, exp| Enclosure::from_parts(mid.into(), rad.into(), exp);
    assert_eq!(ball(3, 0, -1).bounds_f64(), (1.5, 1.5));
    assert_eq!(ball(1, 0, 2000).bounds_f64(), (f64::MAX, f64::INFINITY));
    assert_eq!(ball(-1, 0, 2000).bounds_f64(), (f64::NEG_INFINITY, -f64::MAX));
    assert_eq!(ball(1, 0, -5000).bounds_f64(), (0.0, f64::from_bits(1)));
    assert_eq!(ball(-1, 0, -5000).bounds_f64(), (-f64::from_bits(1), 0.0));
    assert_eq!(ball(1, 0, -5000).midpoint_f64(), 0.0);
    assert!(ball(1, 1, -5000).radius_f64() > 0.0);
    assert_eq!(ball(-5, 1, 0).abs_upper_f64(), 6.0);
}

#[test]
fn decimals_print_as_expected() {
    let ball = |mid: i64, rad: u32, exp| Enclosure::from_parts(mid.into(), rad.into(), exp);
    let text = |(value, radius): (String, String)| format!("{value} ± {radius}");
    assert_eq!(text(ball(-1, 0, -1).decimal(3)), "-0.500 ± 0");
    assert_eq!(text(ball(1, 0, -6).decimal(3)), "0.016 ± 3.75e-4");
    assert_eq!(text(ball(7, 1, 0).decimal(0)), "7 ± 1e0");
    assert_eq!(text(ball(1000, 9991, 0).decimal(0)), "1000 ± 1e4");
    assert_eq!(text(ball(1, 1000, 0).decimal(1)), "1.0 ± 1e3");
    assert_eq!(ball(3, 0, -1).to_string(), "[1.5 ± 0]");
    assert!(Enclosure::pi(20).to_string().starts_with("[3.14159"), "{}", Enclosure::pi(20));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4 * CASES))]

    // Fails if the radius of a product is rounded inward (a·s without b·r) or a quotient forgets its remainder.
    #[test]
    fn operations_enclose_the_exact_result((a, x) in enclosed(), (b, y) in enclosed(), bits in 0u32..120) {
        prop_assert!(a.contains(&x));
        prop_assert!((&a + &b).contains(&(&x + &y)));
        prop_assert!((&a - &b).contains(&(&x - &y)));
        prop_assert!((&a * &b).contains(&(&x * &y)));
        prop_assert!((-&a).contains(&-&x));
        prop_assert!(a.round(bits).contains(&x));
        prop_assert!(a.round(bits).radius() <= a.radius() + power_of_two(bits).recip() * int(2));
        prop_assert!(a.trimmed().contains(&x));
        prop_assert!(a.scale(&y, bits).contains(&(&x * &y)));
        match a.div(&b, bits) {
            Ok(quotient) => {
                prop_assert!(quotient.contains(&(&x / &y)));
                // No wider than the bound in closed form and the rounding that the contract allows.
                let size = b.midpoint().abs();
                let propagated = (a.radius() * &size + a.midpoint().abs() * b.radius()) / (&size * (&size - b.radius()));
                prop_assert!(quotient.radius() <= propagated + power_of_two(bits).recip() * int(2));
            }
            Err(_) => prop_assert!(b.contains_zero()),
        }
        if let Ok(root) = a.sqrt(bits) {
            // √x ∈ [l, h] if and only if x ∈ [l², h²], where l may be below zero.
            let (low, high) = (root.midpoint() - root.radius(), root.midpoint() + root.radius());
            prop_assert!(low.is_negative() || &low * &low <= x);
            prop_assert!(x <= &high * &high);
        }
    }

    #[test]
    fn powers_enclose_the_exact_power((a, x) in enclosed(), n in -4i32..=4, bits in 0u32..120) {
        if let Ok(power) = a.pow_i32(n, bits) {
            prop_assert!(power.contains(&x.pow(n)));
        }
    }

    #[test]
    fn rationals_are_enclosed_at_any_precision(x in rational(), bits in 0u32..200) {
        let enclosure = Enclosure::exact(&x, bits);
        prop_assert!(enclosure.contains(&x));
        prop_assert!(enclosure.radius() <= power_of_two(bits).recip());
        let dyadic = (&x * power_of_two(bits)).is_integer();
        prop_assert_eq!(enclosure.radius().is_zero(), dyadic);
    }

    // Fails if the digits that rounding drops are not added to the radius.
    #[test]
    fn rounding_many_digits_stays_outward(x in rational(), y in rational(), bits in 0u32..100) {
        let product = &Enclosure::exact(&x, 150) * &Enclosure::exact(&y, 150);
        prop_assert!(product.round(bits).contains(&(&x * &y)));
        prop_assert!(product.trimmed().contains(&(&x * &y)));
        let divisor = Enclosure::exact(&y, 150);
        if !divisor.contains_zero() {
            prop_assert!(product.div(&divisor, bits).unwrap().contains(&x));
        }
    }

    #[test]
    fn float_bounds_are_outward((a, x) in enclosed(), far in -1200i64..1200) {
        let exact = |value: f64| Rational::from_float(value).unwrap();
        let (low, high) = a.bounds_f64();
        prop_assert!(exact(low) <= x && x <= exact(high));
        prop_assert!(exact(a.radius_f64()) >= a.radius());
        prop_assert!(exact(a.abs_upper_f64()) >= x.abs());
        let shifted = &a * &Enclosure::from_parts(1.into(), BigUint::zero(), far);
        let (low, high) = shifted.bounds_f64();
        let middle = shifted.midpoint();
        prop_assert!(low.is_infinite() || exact(low) <= middle);
        prop_assert!(high.is_infinite() || exact(high) >= middle);
    }

    // Fails if the printed radius leaves out the rounding of the printed value.
    #[test]
    fn printed_decimals_enclose_the_enclosure((a, x) in enclosed(), digits in 0u32..30) {
        let (value, radius) = a.decimal(digits);
        let decimals = value.split_once('.').map_or(0, |(_, fraction)| fraction.len());
        prop_assert_eq!(decimals, digits as usize);
        let (value, radius) = (parse_rational(&value).unwrap(), parse_rational(&radius).unwrap());
        // Every number of the enclosure is covered, and not much more.
        let needed = (&value - a.midpoint()).abs() + a.radius();
        prop_assert!((&value - &x).abs() <= radius);
        prop_assert!(needed <= radius && radius <= &needed * ratio(102, 100));
    }

    #[test]
    fn relative_accuracy_is_a_lower_bound((a, _) in enclosed()) {
        if let Some(bits) = a.relative_accuracy_bits().filter(|&bits| bits < 1000) {
            let quality = a.midpoint().abs() / a.radius();
            prop_assert!(quality >= power_of_two(bits as u32));
            prop_assert!(quality < power_of_two(bits as u32 + 2));
        }
    }
}

// --------------------------------------------------------------------------------------------------------- coefficients

#[test]
fn coefficients_take_the_simplest_form() {
    let one_plus = |n| &Radical::one() + &root(n);
    let kind = |a: Radical, b: Radical| Coefficient::quotient(a, b).unwrap().kind();
    assert_eq!(Coefficient::from(&root(2) * &root(2)), Coefficient::Exact(int(2)));
    assert_eq!(kind(root(2), root(8)), "exact");
    assert_eq!(kind(one_plus(2), &root(3) * &Radical::pi_power(2)), "radical");
    assert_eq!(kind(one_plus(2).scale(&int(3)), one_plus(2)), "exact");
    assert_eq!(kind(&one_plus(2) * &root(6), one_plus(2)), "radical");
    assert_eq!(kind(one_plus(2), one_plus(3)), "quotient");
    assert!(matches!(
        Coefficient::quotient(root(2), Radical::zero()),
        Err(ExactError::DivisionByZero { .. })
    ));
    assert_eq!(
        Coefficient::from(Enclosure::from_parts(3.into(), BigUint::zero(), -1)),
        Coefficient::Exact(ratio(3, 2))
    );
}

#[test]
fn different_quotients_of_one_number_are_recognised_as_equal() {
    // 1/(1 + √2) = √2 − 1.
    let quotient = Coefficient::quotient(Radical::one(), &Radical::one() + &root(2)).unwrap();
    let radical = Coefficient::from(&root(2) - &Radical::one());
    assert_eq!(quotient.kind(), "quotient");
    assert_eq!(quotient.equals(&radical), Truth::True);
    assert_eq!(&quotient - &radical, Coefficient::zero());
    assert_eq!(quotient.equals(&Coefficient::one()), Truth::False);
}

#[test]
fn an_enclosure_never_becomes_exact_and_says_when_it_cannot_tell() {
    let third = Coefficient::from(Enclosure::exact(&ratio(1, 3), 50));
    let difference = &third - &Coefficient::from(ratio(1, 3));
    assert_eq!((difference.kind(), difference.is_zero()), ("enclosed", Truth::Unknown));
    assert_eq!(third.is_zero(), Truth::False);
    assert!(matches!(Coefficient::one().div(&difference), Err(ExactError::DivisorMayVanish { .. })));
    assert!(matches!(third.div(&Coefficient::zero()), Err(ExactError::DivisionByZero { .. })));
    assert_eq!(&third * &Coefficient::zero(), Coefficient::zero());
    assert_eq!(Coefficient::zero().div(&third).unwrap(), Coefficient::zero());
    // A tiny exact factor does not cost relative accuracy.
    let tiny = Coefficient::from(root(2).scale(&parse_rational("1e-200").unwrap()));
    let accuracy = |c: &Coefficient| c.enclose(0).relative_accuracy_bits().unwrap();
    assert!(accuracy(&(&third * &tiny)) >= accuracy(&third) - 2);
    assert!(accuracy(&third.div(&tiny).unwrap()) >= accuracy(&third) - 2);
    assert!(accuracy(&tiny.div(&third).unwrap()) >= accuracy(&third) - 2);
}

#[test]
fn coefficients_serialize_with_their_kind() {
    let json = |c: &Coefficient| serde_json::to_string(c).unwrap();
    assert_eq!(json(&Coefficient::from(ratio(7, 2))), r#"{"kind":"exact","text":"7/2"}"#);
    assert_eq!(json(&Coefficient::from(root(12))), r#"{"kind":"radical","text":"2·√3"}"#);
    let quotient = Coefficient::quotient(&Radical::one() + &root(2), &Radical::one() + &root(3)).unwrap();
    assert_eq!(json(&quotient), r#"{"kind":"quotient","text":"(1 + √2)/(1 + √3)"}"#);
    assert_eq!(quotient.to_f64(), (1.0 + 2f64.sqrt()) / (1.0 + 3f64.sqrt()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    /// Exact arithmetic and arithmetic on enclosures of the same operands reach one number.
    #[test]
    fn exact_and_enclosed_arithmetic_overlap(a in coefficient(), b in coefficient(), bits in 20u32..100) {
        let ball = |c: &Coefficient| Coefficient::from(c.enclose(bits));
        let agree = |exact: &Coefficient, enclosed: &Coefficient| exact.enclose(2 * bits).overlaps(&enclosed.enclose(2 * bits));
        let (x, y) = (ball(&a), ball(&b));
        for (x, y) in [(&x, &y), (&a, &y), (&x, &b)] {
            prop_assert!(agree(&(&a + &b), &(x + y)));
            prop_assert!(agree(&(&a - &b), &(x - y)));
            prop_assert!(agree(&(&a * &b), &(x * y)));
            if let (Ok(exact), Ok(enclosed)) = (a.div(&b), x.div(y)) {
                prop_assert!(agree(&exact, &enclosed));
            }
        }
        prop_assert!(a.enclose(bits).radius() <= power_of_two(bits).recip());
        prop_assert!((&a + &b).kind() != "enclosed");
    }

    #[test]
    fn exact_coefficients_form_a_field(a in coefficient(), b in coefficient()) {
        prop_assert_eq!((&a - &a).is_zero(), Truth::True);
        prop_assert_eq!((&a + &b).equals(&(&b + &a)), Truth::True);
        prop_assert_eq!((&(&a + &b) * &a).equals(&(&(&a * &a) + &(&b * &a))), Truth::True);
        if b.is_zero() == Truth::False {
            prop_assert_eq!((&a.div(&b).unwrap() * &b).equals(&a), Truth::True);
        } else {
            prop_assert!(a.div(&b).is_err());
        }
    }
}
