//! R. Fatehi & M. T. Manzari, Error estimation in Smoothed Particle Hydrodynamics and a new scheme for second
//! derivatives, Comput. Math. Appl. 61 (2011) 482–498: schemes F1–F4, S1–S4; and the symmetrised F4 of J.-P. Vila.

use super::super::target::{Derivative, Target};
use super::super::tree::Field;
use super::Entry;

const SOURCE: &str = "fatehi-manzari-2011";

fn entry(
    id: &'static str,
    text: &'static str,
    derivative: Derivative,
    location: &'static str,
    remark: &'static str,
) -> Entry {
    Entry {
        id,
        text,
        field: Field::Scalar,
        target: Target::plain(derivative),
        source: SOURCE,
        location,
        remark,
    }
}

pub(super) fn entries() -> Vec<Entry> {
    let gradient = |id, text, location| entry(id, text, Derivative::Gradient, location, "");
    let laplacian =
        |id, text, location, remark| entry(id, text, Derivative::Laplacian { grad_div: 0 }, location, remark);
    let vila = Entry {
        source: "vila-1999",
        ..entry(
            "F4-symmetrised",
            "sum_j V_j (u_j B_j + u_i B_i) . gradW_ij",
            Derivative::Gradient,
            "conservative form of the renormalised gradient",
            "In none of the three papers; Fatehi & Manzari cite Vila 2005 for it, below Eq. (6).",
        )
    };
    vec![
        gradient("F1", "sum_j V_j u_j gradW_ij", "Eq. (2)"),
        gradient("F2", "sum_j V_j (u_j - u_i) gradW_ij", "Eq. (3)"),
        gradient("F3", "sum_j V_j (u_j + u_i) gradW_ij", "Eq. (4)"),
        gradient("F4", "sum_j V_j (u_j - u_i) B_i . gradW_ij", "Eqs. (5), (6)"),
        vila,
        laplacian("S1-7-F1", "sum_j V_j F1[u]_j . gradW_ij", "Eq. (7) with F1", ""),
        laplacian("S1-7-F2", "sum_j V_j F2[u]_j . gradW_ij", "Eq. (7) with F2", ""),
        laplacian("S1-7-F3", "sum_j V_j F3[u]_j . gradW_ij", "Eq. (7) with F3", ""),
        laplacian("S1-7-F4", "sum_j V_j F4[u]_j . gradW_ij", "Eq. (7) with F4", ""),
        laplacian("S1-8-F1", "sum_j V_j (F1[u]_j - F1[u]_i) . gradW_ij", "Eq. (8) with F1", ""),
        laplacian("S1-8-F2", "sum_j V_j (F2[u]_j - F2[u]_i) . gradW_ij", "Eq. (8) with F2", ""),
        laplacian("S1-8-F3", "sum_j V_j (F3[u]_j - F3[u]_i) . gradW_ij", "Eq. (8) with F3", ""),
        laplacian("S1-8-F4", "sum_j V_j (F4[u]_j - F4[u]_i) . gradW_ij", "Eq. (8) with F4", ""),
        laplacian("S1-9-F1", "sum_j V_j (F1[u]_j + F1[u]_i) . gradW_ij", "Eq. (9) with F1", ""),
        laplacian("S1-9-F2", "sum_j V_j (F2[u]_j + F2[u]_i) . gradW_ij", "Eq. (9) with F2", ""),
        laplacian("S1-9-F3", "sum_j V_j (F3[u]_j + F3[u]_i) . gradW_ij", "Eq. (9) with F3", ""),
        laplacian("S1-9-F4", "sum_j V_j (F4[u]_j + F4[u]_i) . gradW_ij", "Eq. (9) with F4", ""),
        laplacian("S2-10", "sum_j V_j u_j lapW_ij", "Eq. (10)", ""),
        laplacian("S2-11", "sum_j V_j (u_j - u_i) lapW_ij", "Eq. (11)", ""),
        laplacian("S2-12", "sum_j V_j (u_j + u_i) lapW_ij", "Eq. (12)", ""),
        laplacian("S3", "sum_j 2 V_j (u_i - u_j) / |r_ij| e_ij . gradW_ij", "Eq. (13)", ""),
        laplacian(
            "S4",
            "Bhat_i : sum_j 2 V_j ((u_i - u_j) / |r_ij| - e_ij . F4[u]_i) e_ij gradW_ij",
            "Eqs. (40), (41)",
            "Eq. (41) names the index of its inner sum j, like the outer one; another is meant. B̂ contracts the indices \
             of Σωee∇W that are not contracted with B.",
        ),
    ]
}
