//! `measured::window` on ladders whose power law is known: which points are kept, and what the interval covers.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use proptest::prelude::*;
use remainder::measured::fit::line;
use remainder::measured::window::{
    Coarse, LadderPoint, PowerLaw, Reason, Unsettled, WindowOptions, power_law,
};
use remainder::measured::{FitError, Input};

const DEFAULT: WindowOptions = WindowOptions {
    coarse: Coarse::Largest,
    max_bend: 0.25,
    min_points: 5,
    min_octaves: 2.0,
    coverage: 0.95,
};

fn ladder(xs: impl IntoIterator<Item = f64>, y: impl Fn(f64) -> f64) -> Vec<LadderPoint> {
    xs.into_iter().map(|x| LadderPoint { x, y: y(x), relative_error: None, floor: 0.0 }).collect()
}

/// 1, 1/√2, 1/2, … of `rungs` entries.
fn half_octaves(rungs: i32) -> impl Iterator<Item = f64> {
    (0..rungs).map(|k| libm::exp2(-0.5 * f64::from(k)))
}

fn indices_left_out(law: &PowerLaw, reason: Reason) -> Vec<usize> {
    law.left_out.iter().filter(|(_, r)| *r == reason).map(|(i, _)| *i).collect()
}

/// The slope through all points whatever they are.
fn plain_slope(points: &[LadderPoint]) -> f64 {
    line(&points.iter().map(|p| (libm::log(p.x), libm::log(p.y), 1.0)).collect::<Vec<_>>()).unwrap().slope
}

#[test]
fn default_options_are_the_documented_ones() {
    assert_eq!(WindowOptions::default(), DEFAULT);
}

#[test]
fn pure_power_law_is_exact() {
    for p in [-2.0, 0.5, 4.0, 12.0] {
        let law = power_law(&ladder(half_octaves(12), |x| 3.0 * libm::pow(x, p)), &DEFAULT).unwrap();
        // ln y is good to 1e-16 × |ln y| ≤ 5e-15, over a range of ln x of 4.
        assert!((law.slope.value - p).abs() < 1e-12);
        assert!((law.intercept.value - libm::log(3.0)).abs() < 1e-12);
        assert!(law.slope.high - law.slope.low < 1e-12 && law.drift.abs() < 1e-12);
        assert!(law.settled() && law.left_out.is_empty());
        assert_eq!((law.degrees_of_freedom, law.residuals.len()), (10, 12));
    }
}

#[test]
fn points_on_the_round_off_floor_are_left_out() {
    let floor = 1e-9;
    let mut points = ladder(half_octaves(20), |x| libm::pow(x, 4.0) + floor);
    for p in &mut points {
        p.floor = 2.0 * floor;
    }
    let law = power_law(&points, &DEFAULT).unwrap();
    // x⁴ ≤ 1e-9 from k = 15 on: 2^(−2·15) = 9.3e-10.
    assert_eq!(indices_left_out(&law, Reason::RoundOffFloor), [15, 16, 17, 18, 19]);
    assert!(law.slope.contains(4.0) && law.settled());
    // Neither too low a floor nor the strict comparison may pass unnoticed.
    let unaware: Vec<_> = points.iter().map(|p| LadderPoint { floor: 0.0, ..*p }).collect();
    assert!(plain_slope(&unaware) < 3.8);
    points[3].floor = points[3].y;
    let law = power_law(&points, &DEFAULT).unwrap();
    assert_eq!(indices_left_out(&law, Reason::RoundOffFloor), [3, 15, 16, 17, 18, 19]);
}

#[test]
fn pre_asymptotic_points_are_dropped_until_the_slope_settles() {
    let points = ladder(half_octaves(16), |x| libm::pow(x, 4.0) + 30.0 * libm::pow(x, 6.0));
    let plain = plain_slope(&points);
    assert!(plain > 4.4 && plain < 6.0, "plain {plain}");
    let law = power_law(&points, &DEFAULT).unwrap();
    let dropped = indices_left_out(&law, Reason::PreAsymptotic);
    assert!(law.settled() && law.bend.unwrap() <= 0.25);
    assert!(dropped.len() >= 2 && dropped.len() <= 11);
    assert_eq!(dropped, (0..dropped.len()).collect::<Vec<_>>(), "from the coarse end, without gaps");
    assert!(law.slope.contains(4.0), "{:?}", law.slope);
    assert!(law.intercept.contains(0.0), "{:?}", law.intercept);
    assert!(law.slope.value - 4.0 < 0.125 && law.slope.high - law.slope.low < 0.25);
    assert!(law.drift < 0.0, "the finer half is closer to 4 from above");
}

#[test]
fn coarse_end_follows_the_option() {
    let y = |x: f64| libm::pow(x, -4.0) + 30.0 * libm::pow(x, -6.0);
    let points = ladder(half_octaves(16).map(|x| 1.0 / x), y);
    let law = power_law(&points, &WindowOptions { coarse: Coarse::Smallest, ..DEFAULT }).unwrap();
    assert!(law.settled() && law.slope.contains(-4.0));
    assert_eq!(law.window.1, points[15].x);
    let wrong_end = power_law(&points, &DEFAULT).unwrap();
    assert!(!wrong_end.slope.contains(-4.0) && wrong_end.window.0 == 1.0);
}

#[test]
fn order_of_points_does_not_matter() {
    let points = ladder(half_octaves(16), |x| libm::pow(x, 4.0) + 30.0 * libm::pow(x, 6.0));
    let forward = power_law(&points, &DEFAULT).unwrap();
    let backward = power_law(&points.iter().rev().copied().collect::<Vec<_>>(), &DEFAULT).unwrap();
    assert!((forward.slope.value - backward.slope.value).abs() < 1e-14);
    assert_eq!(forward.window, backward.window);
    assert_eq!(backward.left_out.last().unwrap().0, 15);
}

#[test]
fn a_slope_that_keeps_changing_is_reported_as_unsettled() {
    // ln y = ln²x: the slope changes by 2 per unit of ln x, everywhere.
    let points = ladder(half_octaves(12), |x| libm::exp(libm::log(x) * libm::log(x)));
    let law = power_law(&points, &DEFAULT).unwrap();
    // The smallest window is of 5 points, 2 octaves: bend = 2 · 2 ln 2.
    let bend = 4.0 * std::f64::consts::LN_2;
    assert!((law.bend.unwrap() - bend).abs() < 1e-9);
    assert!(matches!(law.unsettled, Some(Unsettled::StillBending { .. })));
    assert_eq!(indices_left_out(&law, Reason::PreAsymptotic), [0, 1, 2, 3, 4, 5, 6]);
    let patient = power_law(&points, &WindowOptions { max_bend: 10.0, ..DEFAULT }).unwrap();
    assert!(patient.settled() && patient.left_out.is_empty());
}

#[test]
fn short_ladders_are_fitted_but_not_settled() {
    let four = power_law(&ladder(half_octaves(4), |x| x * x), &DEFAULT).unwrap();
    assert_eq!(four.unsettled, Some(Unsettled::TooFewPoints { found: 4, needed: 5 }));
    let narrow = power_law(&ladder((0..9).map(|k| 1.0 - 0.05 * f64::from(k)), |x| x * x), &DEFAULT).unwrap();
    assert!(matches!(narrow.unsettled, Some(Unsettled::TooNarrow { octaves, .. }) if octaves < 1.0));
    assert!((four.slope.value - 2.0).abs() < 1e-12 && (narrow.slope.value - 2.0).abs() < 1e-12);
    let repeated = ladder(half_octaves(3).chain(half_octaves(3)), |x| x * x);
    let law = power_law(&repeated, &DEFAULT).unwrap();
    assert_eq!(law.unsettled, Some(Unsettled::TooFewPoints { found: 3, needed: 5 }));
    let five = power_law(&ladder(half_octaves(5), |x| x * x), &DEFAULT).unwrap();
    assert!(five.settled());
}

#[test]
fn oscillating_prefactor_is_covered() {
    let y = |x: f64| libm::pow(x, 4.5) * (1.0 + 0.3 * libm::sin(7.0 / x));
    let law = power_law(&ladder(half_octaves(14), y), &DEFAULT).unwrap();
    assert!(law.settled() && law.slope.contains(4.5), "{:?}", law.slope);
    // From the other side: not so wide that 4 or 5 would do as well.
    assert!(!law.slope.contains(4.0) && !law.slope.contains(5.0));
}

#[test]
fn alternating_zeros_are_left_out() {
    let mut points = ladder(half_octaves(14), |x| x.powi(3));
    for p in points.iter_mut().step_by(2) {
        p.y = 0.0;
    }
    let law = power_law(&points, &DEFAULT).unwrap();
    assert_eq!(indices_left_out(&law, Reason::ZeroByValue), [0, 2, 4, 6, 8, 10, 12]);
    assert!((law.slope.value - 3.0).abs() < 1e-12 && law.settled());
    assert_eq!(law.window, (points[13].x, points[1].x));
}

#[test]
fn too_few_usable_points_is_an_error() {
    let mut points = ladder(half_octaves(6), |x| x);
    for p in &mut points[2..] {
        p.y = 0.0;
    }
    assert_eq!(power_law(&points, &DEFAULT), Err(FitError::TooFewPoints { found: 2, needed: 3 }));
    points[4].y = points[4].x;
    assert!(power_law(&points, &DEFAULT).is_ok());
    assert_eq!(power_law(&[], &DEFAULT), Err(FitError::TooFewPoints { found: 0, needed: 3 }));
    let same_x = ladder([0.5; 6], |x| x);
    assert_eq!(power_law(&same_x, &DEFAULT), Err(FitError::RankDeficient { column: 1 }));
}

#[test]
fn faults_are_named_with_their_place() {
    let good = ladder(half_octaves(6), |x| x);
    let with = |change: &dyn Fn(&mut LadderPoint)| {
        let mut points = good.clone();
        change(&mut points[2]);
        power_law(&points, &DEFAULT).map(|_| ())
    };
    let out_of_domain =
        |result, input| matches!(result, Err(FitError::OutOfDomain { what, index: 2, .. }) if what == input);
    assert!(out_of_domain(with(&|p| p.x = 0.0), Input::X));
    assert!(out_of_domain(with(&|p| p.y = -1.0), Input::Y));
    assert!(out_of_domain(with(&|p| p.floor = -1.0), Input::Floor));
    assert!(out_of_domain(with(&|p| p.relative_error = Some(-0.1)), Input::RelativeError));
    assert!(matches!(with(&|p| p.y = f64::NAN), Err(FitError::NonFinite { what: Input::Y, index: 2, .. })));
    let option = |options: WindowOptions| power_law(&good, &options).map(|_| ());
    assert!(matches!(
        option(WindowOptions { min_points: 3, ..DEFAULT }),
        Err(FitError::WindowOption { option: "min_points", .. })
    ));
    assert!(matches!(
        option(WindowOptions { max_bend: f64::NAN, ..DEFAULT }),
        Err(FitError::WindowOption { option: "max_bend", .. })
    ));
    assert!(matches!(option(WindowOptions { coverage: 1.0, ..DEFAULT }), Err(FitError::Coverage { .. })));
}

#[test]
fn known_errors_weigh_points_and_bound_the_interval_from_below() {
    // Without scatter the residuals alone would claim certainty; the quoted 10 % may not be forgotten.
    let mut points = ladder(half_octaves(9), |x| x * x);
    for p in &mut points {
        p.relative_error = Some(0.1);
    }
    let law = power_law(&points, &DEFAULT).unwrap();
    // Σ(u − ū)² = (ln 2 / 2)² · 60 for nine rungs; t(0.975, 7) = 2.364624.
    let expected = 2.364_624 * 0.1 / (0.5 * std::f64::consts::LN_2 * 60.0_f64.sqrt());
    assert!((0.5 * (law.slope.high - law.slope.low) / expected - 1.0).abs() < 1e-6);
    // A point that is off by a factor and says so is nearly ignored; one that does not say so is not.
    points[8].y *= 1.5;
    points[8].relative_error = Some(100.0);
    assert!((power_law(&points, &DEFAULT).unwrap().slope.value - 2.0).abs() < 1e-5);
    points[8].relative_error = None;
    assert!((power_law(&points, &DEFAULT).unwrap().slope.value - 2.0).abs() > 1e-2);
}

#[test]
fn interval_reaches_the_finer_slope() {
    // Slope changing by 0.2 across four octaves: within max_bend, so kept, with residuals too small to tell of it.
    let c2 = 0.2 / (2.0 * 4.0 * std::f64::consts::LN_2);
    let points =
        ladder(half_octaves(9), |x| libm::exp(2.0 * libm::log(x) + c2 * libm::log(x) * libm::log(x)));
    let law = power_law(&points, &DEFAULT).unwrap();
    assert!(law.left_out.is_empty());
    // For a parabola, the line through a stretch has the slope of its midpoint, here a quarter of the range apart.
    assert!((law.drift + 0.05).abs() < 1e-9, "{}", law.drift);
    // The curve is an exact parabola, so its bend is certain and the interval reaches the slope at the fine end, 0.1 away.
    assert!((law.slope.value - law.slope.low - 0.1).abs() < 1e-9);
    // Alternating scatter of 3 % hides the bend, and the finer half is what remains.
    let mut hidden = points;
    for p in hidden.iter_mut().step_by(2) {
        p.y *= 1.06;
    }
    let law = power_law(&hidden, &DEFAULT).unwrap();
    let half_width = law.slope.value - law.slope.low;
    assert!(half_width >= law.drift.abs() * (1.0 - 1e-12) && half_width < 0.1, "{law:?}");
}

/// SplitMix64 (Steele, Lea & Flood 2014).
struct SplitMix(u64);

impl SplitMix {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Box–Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }
}

/// Intervals that hold the true slope 3 out of 200 ladders of ten rungs with 5 % noise, and their mean half-width.
fn coverage_over_200(options: &WindowOptions, quoted: Option<f64>) -> (usize, f64) {
    let sigma = 0.05;
    let laws = (0..200).map(|seed| {
        let mut noise = SplitMix(seed);
        let mut points = ladder(half_octaves(10), |x| x * x * x);
        for p in &mut points {
            p.y *= libm::exp(sigma * noise.normal());
            p.relative_error = quoted;
        }
        power_law(&points, options).unwrap().slope
    });
    laws.fold((0, 0.0), |(hits, width), slope| {
        (hits + usize::from(slope.contains(3.0)), width + 0.5 * (slope.high - slope.low) / 200.0)
    })
}

#[test]
fn intervals_cover_the_true_slope() {
    // Standard error of the slope for ten rungs: Σ(u − ū)² = (ln 2 / 2)² · 82.5; t(0.975, 8) = 2.306.
    let honest = 2.306 * 0.05 / (0.5 * std::f64::consts::LN_2 * 82.5_f64.sqrt());
    for quoted in [None, Some(0.05)] {
        let (hits, width) = coverage_over_200(&DEFAULT, quoted);
        println!("quoted {quoted:?}: {hits} of 200, half-width {:.2} of honest", width / honest);
        assert!(hits >= 180);
        // Widening for drift may cost something, but not twice the interval.
        assert!(width > 0.9 * honest && width < 2.0 * honest);
    }
    // From the other side: asked for less, the intervals deliver less.
    let (hits, _) = coverage_over_200(&WindowOptions { coverage: 0.2, ..DEFAULT }, None);
    println!("coverage 0.2: {hits}");
    assert!(hits < 180);
}

proptest! {
    #[test]
    fn slope_does_not_depend_on_units(
        log_x_unit in -6.0..6.0_f64,
        log_y_unit in -20.0..20.0_f64,
        seed in 0..1000_u64,
        p in -1.0..6.0_f64,
    ) {
        let (x_unit, y_unit) = (libm::exp(log_x_unit), libm::exp(log_y_unit));
        let mut noise = SplitMix(seed);
        let factors: Vec<f64> = half_octaves(12).map(|_| libm::exp(0.1 * noise.normal())).collect();
        let mut points = ladder(half_octaves(12), |x| libm::pow(x, p) * (1.0 + 4.0 * x * x));
        for (point, factor) in points.iter_mut().zip(factors) {
            point.y *= factor;
            point.floor = 1e-5;
        }
        let scaled: Vec<_> = points
            .iter()
            .map(|q| LadderPoint { x: x_unit * q.x, y: y_unit * q.y, floor: y_unit * q.floor, ..*q })
            .collect();
        let (a, b) = (power_law(&points, &DEFAULT).unwrap(), power_law(&scaled, &DEFAULT).unwrap());
        // Logarithms up to 40, good to 1e-14, over a range of ln x of at least 1.4.
        prop_assert!((a.slope.value - b.slope.value).abs() < 1e-12);
        prop_assert!((a.slope.high - b.slope.high).abs() < 1e-12);
        prop_assert_eq!(a.left_out, b.left_out);
        prop_assert!(
            (b.intercept.value - a.intercept.value - log_y_unit + a.slope.value * log_x_unit).abs() < 1e-10
        );
    }
}
