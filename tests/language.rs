//! The operator language: what it reads, what it refuses and where it points, and that no text breaks it.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use proptest::prelude::*;
use remainder::language::{Operator, Target, operators};

#[test]
fn every_operator_of_the_catalogue_has_the_rank_and_the_units_of_what_it_approximates() {
    for entry in operators::catalogue() {
        let operator = entry.operator().unwrap_or_else(|error| panic!("{}: {error:?}", entry.id));
        assert_eq!(operator.field, entry.field, "{}", entry.id);
        assert_eq!(operator.rank(), entry.target.rank(entry.field), "{}", entry.id);
        assert_eq!(operator.root.units, entry.target.units(), "{}", entry.id);
        let inferred = Target::inferred(&operator).unwrap_or_else(|| panic!("{}", entry.id));
        assert_eq!(inferred.order(), entry.target.order(), "{}", entry.id);
    }
}

#[test]
fn unicode_and_ascii_give_one_tree() {
    let pairs = [
        ("Σ_j ω_j (u_j − u_i) B_i · ∇W_ij", "sum_j V_j (u_j - u_i) B_i . gradW_ij"),
        ("Σ_j ω_j u_j ∇²W_ij", "sum_j V_j u_j lapW_ij"),
        ("Σ_j ω_j u_j ∇·∇W_ij", "sum_j V_j u_j lapW_ij"),
        ("Σ_{j} V_{j} u_{j} ∇∇W_{ij}", "sum_j V_j u_j gradgradW_ij"),
        ("B̂_i : Σ_j ω_j u_j r_ij ⊗ ∇W_ij", "Bhat_i : sum_j V_j u_j r_ij * gradW_ij"),
        ("Σ_j m_j / ρ_j μ_i/μ_j u_j W_ij / π", "sum_j m_j / rho_j mu_i/mu_j u_j W_ij / pi"),
    ];
    fn bare(text: &str) -> String {
        // The tree without its places.
        let debug = format!("{:?}", Operator::parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")).root);
        let mut out = String::new();
        let mut rest = debug.as_str();
        while let Some(at) = rest.find("span: ") {
            out += &rest[..at];
            rest = &rest[at..][rest[at..].find(['}', ',']).unwrap()..];
        }
        out + rest
    }
    for (unicode, ascii) in pairs {
        assert_eq!(bare(unicode), bare(ascii), "{unicode}");
    }
}

/// What each fault points at, and what it says.
#[test]
fn faults_point_at_their_place() {
    let faults = [
        ("", "", "expected a quantity"),
        ("sum_j V_j gradW_ij", "sum_j V_j gradW_ij", "contains no field"),
        ("sum_j V_j u_j u_j W_ij", "V_j u_j u_j", "not linear"),
        ("sum_j V_j u_j / u_i W_ij", "u_i", "not linear"),
        ("sum_j V_j (u_j + 1) W_ij", "1", "not linear"),
        ("sum_j V_j u_j^2 W_ij", "u_j", "not linear"),
        ("sum_j V_j u_k W_ij", "u_k", "index k is not bound"),
        ("sum_j V_j u_j W_j", "W_j", "belongs to a pair"),
        ("sum_j V_ij u_j W_ij", "V_ij", "belongs to one particle"),
        ("sum_j V_j u_j W_jj", "W_jj", "pairs a particle with itself"),
        ("sum_j V_j u_j . gradW_ij", "V_j u_j", "its left side has rank 0"),
        ("sum_j V_j u_j (W_ij + gradW_ij)", "gradW_ij", "rank 1 is added to one of rank 0"),
        ("sum_j V_j u_j (W_ij + lapW_ij)", "lapW_ij", "is added to"),
        ("sum_j V_j u_j lapw_ij", "lapw_ij", "no quantity 'lapw'"),
        ("sum_j V_j W_ij (u_j - u_i", "", "expected ')'"),
        ("sum_j V_j u_j W_ij)", ")", "expected the end"),
        ("sum_j V_j u_j W_ij / 0", "0", "divides by zero"),
        ("sum_j V_j u_j W_ij / gradW_ij", "gradW_ij", "the divisor has rank 1"),
        ("sum_j V_j sum_j V_j u_j W_ij", "sum_j", "bound already"),
        ("sum_i V_i u_i W_ij", "sum_i", "the particle of the operator"),
        ("sum_j V_j (sum_k V_k u_k W_ik W_jk) W_ij", "V_k u_k W_ik W_jk", "paired with"),
        ("sum_j V_j u_j W_ij $", "$", "not part of the language"),
        ("sum_j V_j F5[u]_j . gradW_ij", "F5", "no operator 'F5'"),
        ("sum_j V_j MEA[u]_j W_ij", "MEA[u]_j", "acts on v"),
        ("sum_j V_j (u_j + v_j . gradW_ij) W_ij", "v_j", "not on both"),
        ("sum_j V_j F4[u_j]_i W_ij", "u_j", "only the field itself"),
        ("sum_j V_j u_j r_ij^2 W_ij", "r_ij", "has no power"),
        ("sum_j V_j u_j inverse(r_ij) W_ij", "r_ij", "only a tensor of rank 2"),
        ("sum_j V_j u_j W_ij^0.5", "0.5", "whole number"),
        ("sum_j V_j u_ W_ij", "_", "must follow '_'"),
    ];
    for (text, place, message) in faults {
        let error = Operator::parse(text).expect_err(text);
        assert!(error.message.contains(message), "{text}: {error:?}");
        assert_eq!(&text[error.span.clone()], place, "{text}: {error:?}");
    }
    let near = Operator::parse("sum_j V_j u_j gradw_ij").unwrap_err();
    assert!(near.help.unwrap().contains("gradW"));
}

#[test]
fn long_and_deep_texts_are_refused_and_do_not_hang() {
    let deep =
        |open: &str, close: &str| format!("sum_j V_j {}u_j{} W_ij", open.repeat(5000), close.repeat(5000));
    for text in [
        deep("(", ")"),
        "-".repeat(5000),
        "(".repeat(16_000),
        "sum_j ".repeat(2000),
        format!("sum_j V_j u_j W_ij {}", "+ sum_j V_j u_j W_ij ".repeat(700)),
        "inverse(".repeat(2000),
        format!("sum_j V_j u_j {} W_ij", "r_ij ".repeat(2000)),
        "é".repeat(10_000),
    ] {
        assert!(Operator::parse(&text).is_err());
    }
}

/// Texts as found: the corpus, cut, doubled and with bytes changed.
fn corpus() -> Vec<String> {
    let files = ["valid", "invalid"].map(|name| {
        std::fs::read_to_string(format!("{}/tests/fixtures/operators/{name}.txt", env!("CARGO_MANIFEST_DIR")))
            .unwrap()
    });
    let catalogue = operators::catalogue().into_iter().map(|entry| entry.text.to_owned());
    files.iter().flat_map(|text| text.lines()).map(str::to_owned).chain(catalogue).collect()
}

#[test]
fn the_corpus_is_read_or_refused_as_its_file_says() {
    let read = |name: &str| {
        std::fs::read_to_string(format!("{}/tests/fixtures/operators/{name}.txt", env!("CARGO_MANIFEST_DIR")))
            .unwrap()
    };
    for line in read("valid").lines().filter(|line| !line.starts_with('#')) {
        Operator::parse(line).unwrap_or_else(|error| panic!("{line}: {error:?}"));
    }
    for line in read("invalid").lines().filter(|line| !line.starts_with('#')) {
        let error = Operator::parse(line).expect_err(line);
        assert!(line.get(error.span.clone()).is_some(), "{line}: {error:?}");
    }
}

/// Every example of the grammar's page is an operator, and every operator that a scene may name is told of there.
#[test]
fn the_examples_of_the_grammar_are_read() {
    let page = std::fs::read_to_string(format!("{}/docs/operators.md", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let examples: Vec<&str> =
        page.split("```operator\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(examples.len() >= 10, "{}", examples.len());
    for example in examples {
        let text = example.split_whitespace().collect::<Vec<_>>().join(" ");
        Operator::parse(&text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn no_text_breaks_the_parser(
        pick in 0..1000_usize,
        other in 0..1000_usize,
        cut in 0..600_usize,
        from in 0..600_usize,
        byte in any::<char>(),
    ) {
        let corpus = corpus();
        let (a, b) = (&corpus[pick % corpus.len()], &corpus[other % corpus.len()]);
        let head: String = a.chars().take(cut).collect();
        let tail: String = b.chars().skip(from).collect();
        for text in [format!("{head}{tail}"), format!("{head}{byte}{tail}"), format!("{head}{b}")] {
            if let Err(error) = Operator::parse(&text) {
                prop_assert!(text.get(error.span.clone()).is_some(), "{text}: {error:?}");
            }
        }
    }

    #[test]
    fn no_bytes_break_the_parser(text in ".{0,80}") {
        if let Err(error) = Operator::parse(&text) {
            prop_assert!(text.get(error.span.clone()).is_some(), "{text}: {error:?}");
        }
    }
}
