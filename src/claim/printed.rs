//! Equations for truncation errors as printed: what an operator's expansion multiplies ∇^m u by, typed in once, in the
//! operator language. Index order: those contracted with ∇^m u, then those of the value.

/// One coefficient of a printed expansion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PrintedCoefficient {
    /// Key in `references.bib`.
    pub source: &'static str,
    /// The equation.
    pub location: &'static str,
    /// The operator: its id, or its text.
    pub operator: &'static str,
    /// m.
    pub order: u8,
    /// The coefficient of ∇^m u in the truncation error, as printed.
    pub text: &'static str,
}

/// B_i⁻¹ − I.
const B_INVERSE: &str = "-(sum_j V_j r_ij gradW_ij) - I";

/// The equation above (40): S4 before B̂ is contracted with it.
const BEFORE_S4: &str = "sum_j 2 V_j ((u_i - u_j) / |r_ij| - e_ij . F4[u]_i) e_ij gradW_ij";

/// Fatehi & Manzari 2011, Eqs. (17)–(27), the one above (40), and (48).
pub fn printed_coefficients() -> Vec<PrintedCoefficient> {
    let of = |location, operator, order, text| PrintedCoefficient {
        source: "fatehi-manzari-2011",
        location,
        operator,
        order,
        text,
    };
    vec![
        of("Eq. (17)", "F1", 0, "sum_j V_j gradW_ij"),
        of("Eq. (17)", "F1", 1, B_INVERSE),
        of("Eq. (18)", "F3", 0, "2 sum_j V_j gradW_ij"),
        of("Eq. (18)", "F3", 1, B_INVERSE),
        of("Eq. (19)", "F2", 1, B_INVERSE),
        of("Eq. (19)", "F2", 2, "1/2 sum_j V_j r_ij r_ij gradW_ij"),
        of("Eq. (20)", "F4", 2, "1/2 sum_j V_j r_ij r_ij B_i . gradW_ij"),
        of("Eq. (20)", "F4", 3, "-1/6 sum_j V_j r_ij r_ij r_ij B_i . gradW_ij"),
        of("Eqs. (21), (22)", "S1-7-F2", 1, "-sum_j V_j (sum_k V_k r_jk gradW_jk) . gradW_ij"),
        of(
            "Eqs. (21), (22)",
            "S1-7-F2",
            2,
            "-sum_j V_j ((sum_k V_k r_jk gradW_jk) . gradW_ij) r_ij \
             + 1/2 sum_j V_j (sum_k V_k r_jk r_jk gradW_jk) . gradW_ij - I",
        ),
        of(
            "Eq. (23)",
            "S1-8-F2",
            1,
            "-sum_j V_j (sum_k V_k r_jk gradW_jk - sum_k V_k r_ik gradW_ik) . gradW_ij",
        ),
        of(
            "Eq. (23)",
            "S1-8-F2",
            2,
            "-sum_j V_j ((sum_k V_k r_jk gradW_jk) . gradW_ij) r_ij \
             + 1/2 sum_j V_j (sum_k V_k r_jk r_jk gradW_jk - sum_k V_k r_ik r_ik gradW_ik) . gradW_ij - I",
        ),
        of(
            "Eq. (24)",
            "S1-9-F2",
            1,
            "-sum_j V_j (sum_k V_k r_jk gradW_jk + sum_k V_k r_ik gradW_ik) . gradW_ij",
        ),
        of(
            "Eq. (24)",
            "S1-9-F2",
            2,
            "-sum_j V_j ((sum_k V_k r_jk gradW_jk) . gradW_ij) r_ij \
             + 1/2 sum_j V_j (sum_k V_k r_jk r_jk gradW_jk + sum_k V_k r_ik r_ik gradW_ik) . gradW_ij - I",
        ),
        of("Eq. (25)", "S2-10", 0, "sum_j V_j lapW_ij"),
        of("Eq. (25)", "S2-10", 1, "-sum_j V_j r_ij lapW_ij"),
        of("Eq. (25)", "S2-10", 2, "1/2 sum_j V_j r_ij r_ij lapW_ij - I"),
        of("Eq. (26)", "S2-11", 1, "-sum_j V_j r_ij lapW_ij"),
        of("Eq. (26)", "S2-11", 2, "1/2 sum_j V_j r_ij r_ij lapW_ij - I"),
        of("Eq. (27)", "S3", 1, "2 sum_j V_j gradW_ij"),
        of("Eq. (27)", "S3", 2, B_INVERSE),
        of("Eqs. (27), (48)", "S3", 3, "1/3 sum_j V_j r_ij r_ij gradW_ij"),
        of("Eq. (48)", "S3", 4, "-1/12 sum_j V_j r_ij r_ij r_ij gradW_ij"),
        of(
            "Sec. 5, above Eq. (40)",
            BEFORE_S4,
            2,
            "-sum_j V_j r_ij e_ij e_ij gradW_ij \
             - (sum_j V_j r_ij r_ij gradW_ij) . B_i . (sum_k V_k gradW_ik e_ik e_ik)",
        ),
    ]
}
