//! Orders, exponents and intervals: `Exactly` and `AtLeast` are not mixed up, exponents are rationals.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use remainder::exact::*;

#[test]
fn the_smaller_of_two_orders_is_only_as_exact_as_what_is_known() {
    use Order::{AtLeast, Exactly};
    // Read `AtLeast(p)` as the set of orders from p on; the set of possible minima is what `min` must return.
    let horizon = 12u32;
    let members = |order: Order| match order {
        Exactly(p) => p..=p,
        AtLeast(p) => p..=horizon,
    };
    for p in 0..6 {
        for q in 0..6 {
            for (a, b) in [(Exactly(p), Exactly(q)), (Exactly(p), AtLeast(q)), (AtLeast(p), AtLeast(q))] {
                let mut possible: Vec<u32> =
                    members(a).flat_map(|i| members(b).map(move |j| i.min(j))).collect();
                possible.sort_unstable();
                possible.dedup();
                let expected = if possible.len() == 1 { Exactly(possible[0]) } else { AtLeast(possible[0]) };
                assert_eq!(a.min(b), expected, "{a:?} {b:?}");
                assert_eq!(b.min(a), expected, "{b:?} {a:?}");
            }
        }
    }
    assert_eq!(Exactly(2).to_string(), "exactly 2");
    assert_eq!(AtLeast(5).to_string(), "at least 5");
    assert_eq!(serde_json::to_string(&AtLeast(5)).unwrap(), r#"{"at_least":5}"#);
    assert!(Exactly(1).is_exact() && !AtLeast(1).is_exact());
}

#[test]
fn exponents_are_rationals() {
    let exponent: Exponent = "2.5".parse().unwrap();
    assert_eq!(exponent.to_string(), "5/2");
    assert_eq!(&exponent - &Exponent::from(ratio(1, 2)), Exponent::from(2));
    assert_eq!(&exponent + &Exponent::from(-3), Exponent::from(ratio(-1, 2)));
    assert!(exponent > Exponent::from(2));
    assert_eq!(serde_json::to_string(&exponent).unwrap(), r#""5/2""#);
    assert_eq!(serde_json::from_str::<Exponent>(r#""5/2""#).unwrap(), exponent);
    let schema = serde_json::to_value(schemars::schema_for!(Exponent)).unwrap();
    assert_eq!(schema["type"], "string");
}

#[test]
fn intervals_hold_their_value() {
    let interval = Interval::new(1.5, 1.0, 2.25).unwrap();
    assert_eq!((interval.value(), interval.low(), interval.high(), interval.width()), (1.5, 1.0, 2.25, 1.25));
    assert!(interval.contains(1.0) && interval.contains(2.25) && !interval.contains(2.26));
    for (value, low, high) in
        [(3.0, 1.0, 2.0), (0.0, 1.0, 2.0), (f64::NAN, 0.0, 1.0), (1.0, 0.0, f64::INFINITY)]
    {
        assert!(matches!(Interval::new(value, low, high), Err(ExactError::NotAnInterval { .. })));
    }
    let text = serde_json::to_string(&interval).unwrap();
    assert_eq!(text, r#"{"value":1.5,"low":1.0,"high":2.25}"#);
    assert_eq!(serde_json::from_str::<Interval>(&text).unwrap(), interval);
    assert!(serde_json::from_str::<Interval>(r#"{"value":3.0,"low":1.0,"high":2.0}"#).is_err());
    let schema = serde_json::to_value(schemars::schema_for!(Interval)).unwrap();
    assert_eq!(schema["required"], serde_json::json!(["value", "low", "high"]));
}
