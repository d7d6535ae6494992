//! G. Chaussonnet et al., Influence of particle disorder and smoothing length on SPH operator accuracy, SPHERIC 2015:
//! gradients (14)–(16) and Laplacians (30), (31).

use super::super::target::{Derivative, Target};
use super::super::tree::Field;
use super::Entry;

const SOURCE: &str = "chaussonnet-2015";

/// θ.
const THETA: &str = "In the paper r_ab = r_b − r_a and v_ab = v_b − v_a; both signs turn, so the product does not. It \
                     prints θ = 0.01 h² and adds θ² to r²: the units ask for θ² = 0.01 h².";

pub(super) fn entries() -> Vec<Entry> {
    let gradient = |id, text, location| Entry {
        id,
        text,
        field: Field::Scalar,
        target: Target::plain(Derivative::Gradient),
        source: SOURCE,
        location,
        remark: "",
    };
    let laplacian = |id, text, grad_div, location, remark| Entry {
        id,
        text,
        field: Field::Vector,
        target: Target::plain(Derivative::Laplacian { grad_div }),
        source: SOURCE,
        location,
        remark,
    };
    vec![
        gradient("G0", "sum_j V_j u_j gradW_ij", "Eq. (14)"),
        gradient("G+", "sum_j V_j (u_j + u_i) gradW_ij", "Eq. (15)"),
        gradient("G-", "sum_j V_j (u_j - u_i) gradW_ij", "Eq. (16)"),
        laplacian(
            "MCG",
            "2 (D + 2) sum_j V_j (r_ij . (v_i - v_j)) / (|r_ij|^2 + 0.01 h^2) gradW_ij",
            2,
            "Eq. (30) without 1/π",
            THETA,
        ),
        laplacian(
            "MCG-pi",
            "2/pi (D + 2) sum_j V_j (r_ij . (v_i - v_j)) / (|r_ij|^2 + 0.01 h^2) gradW_ij",
            2,
            "Eq. (30) as printed",
            THETA,
        ),
        laplacian(
            "MEA",
            "2 sum_j V_j (gradW_ij . r_ij) / (|r_ij|^2 + 0.01 h^2) (v_i - v_j)",
            0,
            "Eq. (31)",
            "Eq. (31) prints η², the letter of the disorder, where the θ² of Eq. (30) is meant. Both r_ab and v_ab turn \
             their signs.",
        ),
    ]
}
