//! §II: neighbour numbers, and the distances of neighbours of Fig. 2.

use super::compute::BINS;
use super::results::{Results, axis, figure, line};
use super::{ChaussonnetTable, lattice};
use crate::claim::chaussonnet_2015::assertion_of;
use crate::claim::{Measured, Observed};
use crate::derived::{NeighbourDistance, neighbour_distance};
use crate::particles::Shape;
use crate::record::{Axis, Report};
use crate::study::survey::entry;

/// Printed numbers of neighbours.
const NEIGHBOURS: [(&str, f64); 3] = [("square", 29.0), ("hexagonal", 37.0), ("simple-cubic", 123.0)];

pub(super) fn enter(found: &Results<'_>, report: &mut Report) {
    neighbours(found, report);
    distances(found, report);
}

fn neighbours(found: &Results<'_>, report: &mut Report) {
    let support = 3.0 * found.table.h_over_dx;
    for (id, printed) in NEIGHBOURS {
        let Ok(lattice) = lattice(id) else { continue };
        // W vanishes at R: particles there do not count.
        let inside = |k: &[i64; 3]| crate::exact::rational_to_f64(&lattice.square(k)) < support * support;
        let count = lattice.indices_within(support).iter().filter(|k| inside(k)).count() as f64;
        let assertion = assertion_of("chaussonnet-setup/neighbours", printed);
        let derived = Some(Observed::Number(Measured::exactly(count)));
        report.claims.push(entry(&assertion, found.case(id, Some(0.0), &[]), derived, None, Vec::new()));
        for (of, eta, distances) in found.distances() {
            if of == id && (eta == found.table.eta[0] || eta == found.table.largest_eta()) {
                let measured = Some(Observed::Number(Measured::exactly(distances.neighbours)));
                let case = found.case(id, Some(eta), &[]);
                report.claims.push(entry(&assertion, case, None, measured, Vec::new()));
            }
        }
    }
}

fn derived(found: &Results<'_>, lattice: &str, eta: f64) -> Option<NeighbourDistance> {
    let three = ChaussonnetTable::is_3d(lattice);
    let printed = three && found.table.angles == "printed";
    let shape = if printed { Shape::Angles { axis: 2 } } else { Shape::Sphere };
    neighbour_distance(shape, if three { 3 } else { 2 }, eta)
}

fn distances(found: &Results<'_>, report: &mut Report) {
    let mut lines = Vec::new();
    for (lattice, eta, distances) in found.distances() {
        let n = distances.count as f64;
        let mean = distances.sum / n;
        let deviation = (distances.sum_square / n - mean * mean).max(0.0).sqrt();
        // Pairs share particles: of the pairs, each entered from both sides, as many as a quarter count as independent.
        let independent = n / 4.0;
        let around = |value: f64, error: f64| {
            Observed::Number(Measured { value, low: value - 1.96 * error, high: value + 1.96 * error })
        };
        let exactly = |value| Observed::Number(Measured::exactly(value));
        let of_mean = deviation / independent.sqrt();
        let of_deviation = deviation / (2.0 * independent).sqrt();
        let law = derived(found, lattice, eta);
        let rows = [
            ("least", 1.0 - 2.0 * eta, law.map(|law| law.least), exactly(distances.least)),
            ("largest", 1.0 + 2.0 * eta, law.map(|law| law.largest), exactly(distances.largest)),
            ("mean", 1.0, law.map(|law| law.mean), around(1.0 + mean, of_mean)),
            ("deviation", eta, law.map(|law| law.deviation), around(deviation, of_deviation)),
        ];
        for (what, published, derived, measured) in rows {
            let assertion = assertion_of(&format!("chaussonnet-setup/distance-{what}"), published);
            let case = found.case(lattice, Some(eta), &[]);
            report.claims.push(entry(&assertion, case, derived.map(exactly), Some(measured), Vec::new()));
        }
        let width = 4.0 * eta / BINS as f64;
        let bins = distances.bins.iter().enumerate().map(|(bin, count)| {
            let middle = 1.0 - 2.0 * eta + (bin as f64 + 0.5) * width;
            let density = *count as f64 / (n * width);
            (middle, density, (*count as f64).sqrt() * 2.0 / (n * width))
        });
        lines.push(line(format!("{lattice}, η = {eta}"), bins));
    }
    let x = Axis { log: false, ..axis("d/Δx", "1") };
    let y = Axis { log: false, ..axis("density", "1") };
    report.series.push(figure("chaussonnet-figure-2", "2", x, y, lines));
}
