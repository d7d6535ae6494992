//! M. Basa, N. J. Quinlan & M. Lastiwka, Robustness and accuracy of SPH formulations for viscous flow, Int. J. Numer.
//! Meth. Fluids 60 (2009) 1127–1148: density forms (8)–(10), (17), (18), corrections (20)–(26), viscous models A–E.

use super::super::target::{Derivative, Target};
use super::super::tree::Field;
use super::Entry;

const SOURCE: &str = "basa-quinlan-lastiwka-2009";

pub(super) fn entries() -> Vec<Entry> {
    let entry = |id, text, field, target, location, remark| Entry {
        id,
        text,
        field,
        target,
        source: SOURCE,
        location,
        remark,
    };
    let scalar = |id, text, derivative, location, remark| {
        entry(id, text, Field::Scalar, Target::plain(derivative), location, remark)
    };
    let vector = |id, text, derivative, location, remark| {
        entry(id, text, Field::Vector, Target::plain(derivative), location, remark)
    };
    let per_density = |derivative, factor| Target { factor, density: -1, ..Target::plain(derivative) };
    let viscous = |id, text, grad_div, location, remark| {
        let target = Target { viscosity: 1, ..per_density(Derivative::Laplacian { grad_div }, 1) };
        entry(id, text, Field::Vector, target, location, remark)
    };
    vec![
        entry(
            "basa-8",
            "sum_j m_j (u_i / rho_i^2 + u_j / rho_j^2) gradW_ij",
            Field::Scalar,
            per_density(Derivative::Gradient, 1),
            "Eq. (8)",
            "On the pressure, u = p: the term printed with σ = −p I, its sign turned.",
        ),
        entry(
            "basa-9",
            "sum_j m_j / (rho_i rho_j) (u_i + u_j) gradW_ij",
            Field::Scalar,
            per_density(Derivative::Gradient, 1),
            "Eq. (9)",
            "On the pressure, u = p: the term printed with σ = −p I, its sign turned.",
        ),
        entry(
            "basa-10",
            "sum_j m_j (v_i - v_j) . gradW_ij",
            Field::Vector,
            Target { factor: -1, density: 1, ..Target::plain(Derivative::Divergence) },
            "Eq. (10)",
            "",
        ),
        vector("basa-17", "1/rho_i sum_j m_j (v_j - v_i) . gradW_ij", Derivative::Divergence, "Eq. (17)", ""),
        vector("basa-18", "sum_j m_j / rho_j (v_j - v_i) . gradW_ij", Derivative::Divergence, "Eq. (18)", ""),
        entry(
            "pressure-reduction",
            "-sum_j m_j ((u_i - mean_k u_k) / rho_i^2 + (u_j - mean_k u_k) / rho_j^2) gradW_ij",
            Field::Scalar,
            per_density(Derivative::Gradient, -1),
            "Eq. (20)",
            "On the pressure, u = p. The mean counts particle i, as Sec. 2 does.",
        ),
        scalar("shepard", "(sum_j V_j u_j W_ij) / (sum_j V_j W_ij)", Derivative::Value, "Eq. (21)", ""),
        scalar(
            "shepard-gradient",
            "(sum_j V_j u_j gradW_ij) / (sum_k V_k W_ik) \
             - (sum_j V_j u_j W_ij) (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2",
            Derivative::Gradient,
            "Eq. (22)",
            "",
        ),
        scalar(
            "shepard-hessian",
            "(sum_j V_j u_j gradgradW_ij) / (sum_k V_k W_ik) \
             - ((sum_k V_k gradW_ik) (sum_j V_j u_j gradW_ij) + (sum_j V_j u_j gradW_ij) (sum_k V_k gradW_ik) \
             + (sum_j V_j u_j W_ij) (sum_k V_k gradgradW_ik)) / (sum_k V_k W_ik)^2 \
             + 2 (sum_j V_j u_j W_ij) (sum_k V_k gradW_ik) (sum_l V_l gradW_il) / (sum_k V_k W_ik)^3",
            Derivative::Hessian,
            "Eq. (23)",
            "",
        ),
        scalar(
            "mixed-correction",
            "inverse(-sum_l V_l (gradW_il / (sum_k V_k W_ik) \
             - W_il (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2) r_il) \
             . sum_j V_j u_j (gradW_ij / (sum_k V_k W_ik) - W_ij (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2)",
            Derivative::Gradient,
            "Eqs. (24)–(26)",
            "Eq. (26) prints r_b where −r_ab stands here: their sums are equal, as the corrected gradients add up to zero.",
        ),
        vector(
            "A",
            "sum_j V_j v_j gradgradW_ij",
            Derivative::Hessian,
            "Eq. (27), model A",
            "All second derivatives.",
        ),
        vector(
            "B",
            "sum_j V_j (sum_k V_k v_k gradW_jk) gradW_ij",
            Derivative::Hessian,
            "Eq. (29), model B",
            "All second derivatives.",
        ),
        viscous(
            "C",
            "sum_j m_j 8 / (rho_i + rho_j) (mu_i / rho_i + mu_j / rho_j) \
             ((v_i - v_j) . r_ij) / (|r_ij|^2 + 0.01 h^2) gradW_ij",
            2,
            "Eq. (33), model C",
            "What it is meant for, ∇²v, differs by 2∇(∇·v), which vanishes where the flow is incompressible.",
        ),
        viscous(
            "D",
            "sum_j m_j 4.96333 / (rho_i rho_j) 4 mu_i mu_j / (mu_i + mu_j) \
             ((v_i - v_j) . r_ij) / (|r_ij|^2 + 0.01 h^2) gradW_ij",
            2,
            "Eq. (34), model D with ξ = 4.96333",
            "What it is meant for, ∇²v, differs by 2∇(∇·v), which vanishes where the flow is incompressible.",
        ),
        viscous(
            "E",
            "sum_j m_j (mu_i + mu_j) / (rho_i rho_j) (r_ij . gradW_ij) / |r_ij|^2 (v_i - v_j)",
            0,
            "Eq. (35), model E",
            "",
        ),
    ]
}
