//! R. Fatehi & M. T. Manzari, Error estimation in Smoothed Particle Hydrodynamics and a new scheme for second
//! derivatives, Comput. Math. Appl. 61 (2011) 482–498: Tables 1–3 and Eqs. (28)–(30), (32)–(39), (42), (49), (50).
//!
//! A row of Table 2 with two terms is two claims, `#regular` for |S^reg − continuum limit| and `#disorder` for the root
//! mean square of S − S^reg. A printed Δ is h · Δ/h: d̃Δ(Δ/h)^n is d̃ h (Δ/h)^{n+1}. In Eqs. (36) and (37) the printed
//! orders are those of the sums' own values.

use super::{BetaExponent, Claim, Powers, Quantity, Statement};
use crate::exact::int;
use crate::language::{Coefficient, Subject};
use crate::sums::Moment;

const SOURCE: &str = "fatehi-manzari-2011";
const ALL: &[usize] = &[1, 2, 3];
const LINE: &[usize] = &[1];

/// id, where, moment, quantity, exponents of d̃, h and Δ/h, text, dimensions.
type Row =
    (&'static str, &'static str, &'static str, Quantity, [&'static str; 3], &'static str, &'static [usize]);

use Quantity::{DisorderDeviation as Rms, RegularDeviation as Deviation, RegularValue as Value};

const POWER_LAWS: &[Row] = &[
    (
        "fatehi-table-2/sum_dw#disorder",
        "Table 2, row 1",
        "sum_dw",
        Rms,
        ["1", "-2", "beta-1"],
        "Σω∇W = O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-2/b_inverse#regular",
        "Table 2, row 2",
        "b_inverse",
        Value,
        ["0", "0", "0"],
        "B⁻¹ = −Σωr∇W = O(1)",
        ALL,
    ),
    (
        "fatehi-table-2/i_minus_b_inverse#regular",
        "Table 2, row 3, first term; Eq. (33)",
        "b_inverse",
        Deviation,
        ["0", "0", "beta+1"],
        "I − B⁻¹ = O((Δ/h)^{β+1}) on regular particles",
        ALL,
    ),
    (
        "fatehi-table-2/i_minus_b_inverse#disorder",
        "Table 2, row 3, second term; Eq. (39)",
        "b_inverse",
        Rms,
        ["1", "-1", "beta+1"],
        "the disorder's part of I − B⁻¹ is O(d̃/h (Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-2/sum_rrdw#disorder",
        "Table 2, row 4",
        "sum_rrdw",
        Rms,
        ["1", "0", "beta+1"],
        "Σωrr∇W = O(d̃ (Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-2/sum_rrrdw#regular",
        "Table 2, row 5, first term",
        "sum_rrrdw",
        Value,
        ["0", "2", "0"],
        "Σωrrr∇W = O(h²) on regular particles; its continuum limit is not zero, so the value itself is meant",
        ALL,
    ),
    (
        "fatehi-table-2/sum_rrrdw#disorder",
        "Table 2, row 5, second term",
        "sum_rrrdw",
        Rms,
        ["1", "1", "beta+2"],
        "the disorder's part of Σωrrr∇W is O(d̃Δ (Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-2/sum_ddw#regular",
        "Table 2, row 6, first term",
        "sum_ddw",
        Deviation,
        ["0", "-2", "beta-1"],
        "Σω∇∇W = O(1/h² (Δ/h)^{β−1}) on regular particles",
        ALL,
    ),
    (
        "fatehi-table-2/sum_ddw#disorder",
        "Table 2, row 6, second term",
        "sum_ddw",
        Rms,
        ["1", "-3", "beta-1"],
        "the disorder's part of Σω∇∇W is O(d̃/h³ (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-2/sum_rddw#disorder",
        "Table 2, row 7",
        "sum_rddw",
        Rms,
        ["1", "-2", "beta-1"],
        "Σωr∇∇W = O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-eq-32/b_inverse#regular",
        "Eq. (32), first term",
        "b_inverse",
        Deviation,
        ["0", "0", "beta+1"],
        "in one dimension ΣωgW′ − g′ has g′ × O((Δ/h)^{β+1}) for odd β, β+2 for even β",
        LINE,
    ),
    (
        "fatehi-eq-32/sum_rrrdw#regular",
        "Eq. (32), last term",
        "sum_rrrdw",
        Deviation,
        ["0", "2", "beta+1"],
        "in one dimension the g‴ term is O(h²) + O(h²(Δ/h)^{β+1}) for odd β, β+2 for even β",
        LINE,
    ),
    (
        "fatehi-eq-33/b_inverse#regular",
        "Eq. (33)",
        "b_inverse",
        Deviation,
        ["0", "0", "beta+1"],
        "I − B⁻¹ = O((Δ/h)^{β+1}) in several dimensions",
        ALL,
    ),
    (
        "fatehi-eq-34/sum_rrrdw#regular",
        "Eq. (34), second term",
        "sum_rrrdw",
        Deviation,
        ["0", "2", "beta+1"],
        "Σωrrr∇W = O(h²) + O(h²(Δ/h)^{β+1}) on regular particles",
        ALL,
    ),
    (
        "fatehi-eq-35/sum_ddw#regular",
        "Eq. (35), first term",
        "sum_ddw",
        Deviation,
        ["0", "-2", "beta-1"],
        "in one dimension ΣωW″ = O(1/h² (Δ/h)^{β−1})",
        LINE,
    ),
    (
        "fatehi-eq-35/sum_rrddw#regular",
        "Eq. (35), second term",
        "sum_rrddw",
        Deviation,
        ["0", "0", "beta-1"],
        "in one dimension the g″ term of ΣωgW″ − g″ is O((Δ/h)^{β−1})",
        LINE,
    ),
    (
        "fatehi-eq-36/sum_lapw#regular",
        "Eq. (36)",
        "sum_lapw",
        Value,
        ["0", "-2", "beta-1"],
        "Σω∇·∇W = O(1/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-eq-37/sum_rrlapw#printed",
        "Eq. (37), as printed",
        "sum_rrlapw",
        Value,
        ["0", "0", "beta-1"],
        "Σωrr∇·∇W = O((Δ/h)^{β−1}): as printed, the value of the sum",
        ALL,
    ),
    (
        "fatehi-eq-37/sum_rrlapw#regular",
        "Eq. (37), read as the deviation",
        "sum_rrlapw",
        Deviation,
        ["0", "0", "beta-1"],
        "Σωrr∇·∇W − 2I = O((Δ/h)^{β−1}): read as the distance from the continuum limit 2I",
        ALL,
    ),
    (
        "fatehi-eq-38/sum_dw#disorder",
        "Eq. (38)",
        "sum_dw",
        Rms,
        ["1", "-2", "beta-1"],
        "Σω∇W ≈ d̃ Σω∇·∇W^reg = O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-eq-39/b_inverse#disorder",
        "Eq. (39)",
        "b_inverse",
        Rms,
        ["1", "-1", "beta+1"],
        "I − B⁻¹ = O((Δ/h)^{β+1}) + O(d̃/h (Δ/h)^{β+1})",
        ALL,
    ),
];

/// id, where, operator, order m of ∇^m u, quantity, exponents of d̃, h and Δ/h, text, dimensions.
type OperatorRow = (
    &'static str,
    &'static str,
    &'static str,
    u8,
    Quantity,
    [&'static str; 3],
    &'static str,
    &'static [usize],
);

/// Tables 1 and 3, what the text adds to them, and Eqs. (42), (49), (50).
const OPERATORS: &[OperatorRow] = &[
    (
        "fatehi-table-1/F1",
        "Table 1, row 1",
        "F1",
        1,
        Deviation,
        ["0", "0", "beta+1"],
        "on regular particles the leading error of F1 is |∇u| O((Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-1/F4",
        "Table 1, row 2",
        "F4",
        3,
        Value,
        ["0", "2", "0"],
        "on regular particles the leading error of F4 is |∇³u| O(h²)",
        ALL,
    ),
    (
        "fatehi-table-1/S2-10",
        "Table 1, row 3",
        "S2-10",
        0,
        Value,
        ["0", "-2", "beta-1"],
        "on regular particles the leading error of S2, Eq. (10), is u O(1/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-1/S2-11",
        "Table 1, row 4",
        "S2-11",
        2,
        Deviation,
        ["0", "0", "beta-1"],
        "on regular particles the leading error of S2, Eq. (11), is |∇²u| O((Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-1/S3",
        "Table 1, row 5",
        "S3",
        2,
        Deviation,
        ["0", "0", "beta+1"],
        "on regular particles the leading error of S3 is |∇²u| O((Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-1-text/F2",
        "Sec. 4.1, below Eq. (37)",
        "F2",
        1,
        Deviation,
        ["0", "0", "beta+1"],
        "on regular particles the order of F2 is that of F1",
        ALL,
    ),
    (
        "fatehi-table-1-text/F3",
        "Sec. 4.1, below Eq. (37)",
        "F3",
        1,
        Deviation,
        ["0", "0", "beta+1"],
        "on regular particles the order of F3 is that of F1",
        ALL,
    ),
    (
        "fatehi-table-1-text/S1-as-S2",
        "Sec. 4.1, below Eq. (37)",
        "S1-8-F2",
        2,
        Deviation,
        ["0", "0", "beta-1"],
        "on regular particles the order of S1 (Eq. 8 with F2) is that of S2, Eq. (11)",
        LINE,
    ),
    (
        "fatehi-table-1-text/S1-as-S3",
        "Sec. 4.1, below Eq. (37)",
        "S1-8-F2",
        2,
        Deviation,
        ["0", "0", "beta+1"],
        "on regular particles the order of S1 (Eq. 8 with F2) is that of S3",
        LINE,
    ),
    (
        "fatehi-eq-49/S3",
        "Eq. (49), second term",
        "S3",
        4,
        Value,
        ["0", "2", "0"],
        "on regular particles S3 multiplies ∇⁴u by O(Δ²(h/Δ)²) = O(h²)",
        ALL,
    ),
    (
        "fatehi-eq-50/S4",
        "Eq. (50)",
        "S4",
        4,
        Value,
        ["0", "2", "0"],
        "on regular particles S4 multiplies ∇⁴u by O(Δ²(h/Δ)²) = O(h²)",
        ALL,
    ),
    (
        "fatehi-table-3/F1",
        "Table 3, row 1",
        "F1",
        0,
        Rms,
        ["1", "-2", "beta-1"],
        "on irregular particles the leading error of F1 is u O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-3/F2",
        "Table 3, row 2, second term",
        "F2",
        1,
        Rms,
        ["1", "-1", "beta+1"],
        "on irregular particles F2 multiplies ∇u by O((Δ/h)^{β+1}) and the disorder's O(d̃/h (Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-3/F4",
        "Table 3, row 3",
        "F4",
        2,
        Rms,
        ["1", "0", "beta+1"],
        "on irregular particles the leading error of F4 is |∇²u| O(d̃ (Δ/h)^{β+1})",
        ALL,
    ),
    (
        "fatehi-table-3/S2-10",
        "Table 3, row 4, second term",
        "S2-10",
        0,
        Rms,
        ["1", "-3", "beta-1"],
        "on irregular particles S2, Eq. (10), multiplies u by O(1/h² (Δ/h)^{β−1}) and the disorder's O(d̃/h³ (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-3/S2-11",
        "Table 3, row 5",
        "S2-11",
        1,
        Rms,
        ["1", "-2", "beta-1"],
        "on irregular particles the leading error of S2, Eq. (11), is |∇u| O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-3/S3",
        "Table 3, row 6",
        "S3",
        1,
        Rms,
        ["1", "-2", "beta-1"],
        "on irregular particles the leading error of S3 is |∇u| O(d̃/h² (Δ/h)^{β−1})",
        ALL,
    ),
    (
        "fatehi-table-3-text/F3",
        "Sec. 4.2, below Table 3",
        "F3",
        0,
        Rms,
        ["1", "-2", "beta-1"],
        "on irregular particles F3 has the same condition as F1",
        ALL,
    ),
    (
        "fatehi-eq-42/S4",
        "Eq. (42)",
        "S4",
        3,
        Rms,
        ["1", "0", "beta+1"],
        "on irregular particles the leading error of S4 is |∇³u| O(d̃ (Δ/h)^{β+1})",
        ALL,
    ),
];

/// What Sec. 4.2 concludes from Table 3: id, where, operator, m, quantity, exponent of Δ, text.
const CONVERGENCE: &[(&str, &str, &str, u8, Quantity, &str, &str)] = &[
    (
        "fatehi-convergence/F1",
        "Sec. 4.2, below Table 3",
        "F1",
        0,
        Rms,
        "beta",
        "F1 needs Δ to decrease faster than h^{1+1/β}",
    ),
    (
        "fatehi-convergence/S2-10",
        "Sec. 4.2, below Table 3",
        "S2-10",
        0,
        Value,
        "beta-1",
        "the error of S2, Eq. (10), does not vanish except when Δ decreases faster than h^{(β+1)/(β−1)}",
    ),
];

const ZEROS: &[(&str, &str, &str, &str)] = &[
    ("fatehi-eq-28/sum_dw#zero", "Eq. (28)", "sum_dw", "Σω∇W vanishes on regular particles"),
    ("fatehi-eq-29/sum_rrdw#zero", "Eq. (29)", "sum_rrdw", "Σωrr∇W vanishes on regular particles"),
    ("fatehi-eq-30/sum_rlapw#zero", "Eq. (30)", "sum_rlapw", "Σωr∇·∇W vanishes on regular particles"),
];

pub(super) fn claims() -> Vec<Claim> {
    let moment =
        |name: &str| Subject::Moment(Moment::by_name(name).unwrap_or_else(|error| unreachable!("{error}")));
    let power_laws = POWER_LAWS.iter().map(|(id, location, name, quantity, [d, h, x], text, dimensions)| {
        let mut powers = Powers::parse(d, h, x).unwrap_or_else(|error| unreachable!("{error}"));
        if id.starts_with("fatehi-eq-32/") {
            powers.dx_over_h = powers.dx_over_h.with_even(int(1));
        }
        Claim {
            id: (*id).into(),
            source: SOURCE.into(),
            location: (*location).into(),
            text: (*text).into(),
            subject: moment(name),
            statement: Statement::PowerLaw { quantity: *quantity, powers: Box::new(powers) },
            dimensions,
        }
    });
    let zeros = ZEROS.iter().map(|(id, location, name, text)| Claim {
        id: (*id).into(),
        source: SOURCE.into(),
        location: (*location).into(),
        text: (*text).into(),
        subject: moment(name),
        statement: Statement::Zero,
        dimensions: ALL,
    });
    let operators =
        OPERATORS.iter().map(|(id, location, name, order, quantity, [d, h, x], text, dimensions)| {
            let coefficient = Coefficient::new(name, *order).unwrap_or_else(|error| unreachable!("{error}"));
            let powers = Powers::parse(d, h, x).unwrap_or_else(|error| unreachable!("{error}"));
            Claim {
                id: (*id).into(),
                source: SOURCE.into(),
                location: (*location).into(),
                text: (*text).into(),
                subject: Subject::Coefficient(coefficient),
                statement: Statement::PowerLaw { quantity: *quantity, powers: Box::new(powers) },
                dimensions,
            }
        });
    let convergence = CONVERGENCE.iter().map(|(id, location, name, order, quantity, rate, text)| {
        let coefficient = Coefficient::new(name, *order).unwrap_or_else(|error| unreachable!("{error}"));
        let rate = BetaExponent::parse(rate).unwrap_or_else(|error| unreachable!("{error}"));
        Claim {
            id: (*id).into(),
            source: SOURCE.into(),
            location: (*location).into(),
            text: (*text).into(),
            subject: Subject::Coefficient(coefficient),
            statement: Statement::Convergence { quantity: *quantity, rate },
            dimensions: ALL,
        }
    });
    power_laws.chain(zeros).chain(operators).chain(convergence).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    #[test]
    fn the_conditions_are_those_that_the_text_prints() {
        for (id, printed) in [("F1", ratio(4, 3)), ("S2-10", int(2))] {
            let id = format!("fatehi-convergence/{id}");
            let claim = claims().into_iter().find(|claim| claim.id == id);
            let Some(Claim { statement: Statement::Convergence { rate, .. }, subject, .. }) = claim else {
                unreachable!("{id} is a claim on convergence")
            };
            // 1 + 1/β and (β+1)/(β−1) for β = 3.
            assert_eq!(int(1) - int(i64::from(subject.length_power())) / rate.at(3), printed);
        }
    }

    #[test]
    fn every_claim_has_the_dimension_of_what_it_is_about() {
        for claim in claims() {
            if let Statement::PowerLaw { powers, .. } = &claim.statement {
                assert_eq!(powers.check(&claim.subject), Ok(()), "{}", claim.id);
            }
        }
    }
}
