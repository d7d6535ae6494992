//! Multi-indices: complete, sorted, weighted; read, added, subtracted.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use num_bigint::BigUint;
use remainder::exact::*;

fn binomial(n: u32, k: u32) -> u32 {
    (0..k).fold(1, |product, i| product * (n - i) / (i + 1))
}

#[test]
fn multi_indices_are_complete_sorted_and_weighted() {
    for dimension in 1..=3usize {
        for order in 0..=7u8 {
            let all = MultiIndex::all(dimension, order).unwrap();
            let d = dimension as u32;
            assert_eq!(all.len() as u32, binomial(u32::from(order) + d - 1, d - 1));
            assert!(all.is_sorted_by(|a, b| a < b), "strictly increasing, hence distinct");
            assert!(all.iter().all(|index| index.order() == u32::from(order)));
            // Every one of the D^p sequences of axes belongs to one multi-index.
            let sequences: BigUint = all.iter().map(MultiIndex::multiplicity).sum();
            assert_eq!(sequences, BigUint::from(d).pow(order.into()));
        }
    }
    assert_eq!(MultiIndex::all(4, 1), Err(ExactError::Dimension { dimension: 4 }));
    let letters: Vec<_> = MultiIndex::all(3, 2).unwrap().iter().map(MultiIndex::letters).collect();
    assert_eq!(letters, ["xx", "xy", "xz", "yy", "yz", "zz"]);
}

#[test]
fn multi_indices_read_add_and_subtract() {
    let index = |text| MultiIndex::from_letters(text).unwrap();
    assert_eq!(index("yxx").to_string(), "xxy");
    assert_eq!(index("").to_string(), "1");
    assert_eq!(index("xxxyy").factorial(), BigUint::from(12u32));
    assert_eq!(index("xz") + index("xy"), index("xxyz"));
    assert_eq!(index("xxy").checked_sub(index("xy")), Some(index("x")));
    assert_eq!(index("xxy").checked_sub(index("z")), None);
    assert!(index("zz") < index("xxx"), "the order comes first");
    assert!(MultiIndex::from_letters("xq").is_err());
    assert!(MultiIndex::from_letters(&"x".repeat(256)).is_err());
    assert_eq!(MultiIndex::new([255, 0, 0]).checked_add(index("x")), None);
    assert_eq!(serde_json::to_string(&index("yx")).unwrap(), r#""xy""#);
    assert_eq!(serde_json::from_str::<MultiIndex>(r#""zx""#).unwrap(), index("xz"));
}
