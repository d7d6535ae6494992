//! What was computed, as a drawing: the particles of a case, where they came from, and the support of one of them.

use super::names::disorder_name;
use super::{Axis, Dash, Figure, Layer, Mark, Point};
use crate::exact::rational_to_f64;
use crate::kernel;
use crate::particles::{Disorder, Draw, Lattice, Moves, SampleStream, Site, lattice_by_id};
use crate::record::{Case, Report};
use serde_json::Value;
use std::f64::consts::TAU;

/// The most drawings of one report: every lattice and every model is among them where that many suffice.
const MOST: usize = 14;

/// The smallest and the largest R/Δ that a drawing shows well.
const READABLE: [f64; 2] = [1.5, 9.0];

/// Lattices with their disorder, each once.
pub(super) fn figures(report: &Report) -> Vec<Figure> {
    let mut cases: Vec<(&Case, usize)> = Vec::new();
    for entry in &report.claims {
        let case = &entry.case;
        let same =
            |known: &Case| known.lattice == case.lattice && disorder_name(known) == disorder_name(case);
        match cases.iter_mut().find(|(known, _)| same(known)) {
            Some((_, count)) => *count += 1,
            None => cases.push((case, 1)),
        }
    }
    let drawn = chosen(&cases);
    drawn.into_iter().filter_map(|case| figure(report, case)).collect()
}

/// The commonest cases that between them show every lattice and every model of disorder.
fn chosen<'a>(cases: &[(&'a Case, usize)]) -> Vec<&'a Case> {
    fn model(case: &Case) -> &str {
        disorder_name(case).split(':').next().unwrap_or_default()
    }
    let mut order: Vec<&(&Case, usize)> = cases.iter().collect();
    // Disorder is best seen in the plane, and where it is strong.
    let amplitude = |case: &Case| {
        let disorder = Disorder::parse(case.disorder.as_deref().unwrap_or("none"));
        disorder.map_or(0.0, |disorder| disorder.amplitude())
    };
    order.sort_by(|(a, many), (b, few)| {
        let regular = |case: &Case| disorder_name(case) == "regular";
        (regular(a), a.dimension != 2)
            .cmp(&(regular(b), b.dimension != 2))
            .then(amplitude(b).total_cmp(&amplitude(a)))
            .then(few.cmp(many))
    });
    let mut found: Vec<&Case> = Vec::new();
    for round in 0..2 {
        for (case, _) in &order {
            let new_lattice = !found.iter().any(|known| known.lattice == case.lattice);
            let new_model = !found.iter().any(|known| model(known) == model(case));
            let taken = found.iter().any(|known| std::ptr::eq(*known, *case));
            if found.len() < MOST && !taken && (new_lattice || new_model || round == 1 && cases.len() <= MOST)
            {
                found.push(case);
            }
        }
    }
    found
}

fn figure(report: &Report, case: &Case) -> Option<Figure> {
    let lattice = lattice_by_id(case.lattice.as_deref()?).ok()?;
    let disorder = Disorder::parse(case.disorder.as_deref().unwrap_or("none")).ok()?;
    let own = kernel::by_id(&case.kernel).ok();
    let support_over_h = own.map_or(1.0, |kernel| rational_to_f64(kernel.support_over_h()));
    let support = support(report, case, support_over_h);
    let radius = support.unwrap_or(3.0);
    let axis = |name: &str| Axis { name: name.into(), unit: "1".into(), log: false };
    let title = match support {
        Some(support) => format!(
            "{}, {}: the support R = {} Δ of particle i",
            lattice.name(),
            disorder_name(case),
            crate::record::significant(support, 3)
        ),
        None => format!("{}, {}", lattice.name(), disorder_name(case)),
    };
    let id = format!("particles-{}-{}", lattice.id(), disorder_name(case));
    let mut figure = Figure::new(id, title, axis("x/Δ"), axis("y/Δ"));
    figure.same_scale = true;
    if lattice.dimension() == 3 {
        figure.notes.push("In 3-D, the layer through particle i, seen along z.".into());
    }
    let sites: Vec<Site> =
        lattice.sites_within(radius + 0.8).into_iter().filter(|site| site.position[2].abs() < 1e-6).collect();
    let places = places(report, &lattice, &sites, &disorder, radius / support_over_h);
    let centre = sites.iter().position(|site| site.position.iter().all(|x| x.abs() < 1e-9))?;
    let [x, y] = *places.get(centre)?;
    if support.is_some() {
        figure.layers.push(support_layer(lattice.dimension(), [x, y], radius));
    }
    let moved = disorder.entry().moves != Moves::Nothing;
    let point = |[x, y]: [f64; 2]| Point { x, y, error: None };
    if moved {
        let points = sites.iter().map(|site| point([site.position[0], site.position[1]])).collect();
        let mark = Mark::Points { points, hollow: true };
        figure.layers.push(Layer { name: Some("lattice".into()), colour: 0, mark });
    }
    let others = places.iter().enumerate().filter(|(index, _)| *index != centre);
    figure.layers.push(Layer::points("particles", 1, others.map(|(_, place)| point(*place)).collect()));
    figure.layers.push(Layer::points("particle i", 2, vec![point([x, y])]));
    Some(figure)
}

/// The circle of the support; on a line, its ends.
fn support_layer(dimension: usize, [x, y]: [f64; 2], radius: f64) -> Layer {
    if dimension == 1 {
        let (left, right, end) = (x - radius, x + radius, 0.3);
        let points = vec![[left, end], [left, -end], [left, 0.0], [right, 0.0], [right, end], [right, -end]];
        return Layer::line("support", 4, points, Dash::Solid);
    }
    let corner = |k: u32| {
        let angle = TAU * f64::from(k) / 72.0;
        [x + radius * libm::cos(angle), y + radius * libm::sin(angle)]
    };
    Layer {
        name: Some("support".into()),
        colour: 4,
        mark: Mark::Area { outline: (0..72).map(corner).collect() },
    }
}

fn places(
    report: &Report,
    lattice: &Lattice,
    sites: &[Site],
    disorder: &Disorder,
    h_over_dx: f64,
) -> Vec<[f64; 2]> {
    let motion = disorder.motion();
    let centre_only = disorder.entry().moves == Moves::CentreOnly;
    let mut stream = SampleStream::new(report.provenance.seed, 0);
    let place = |site: &Site| {
        let [x, y, _] = site.position;
        if centre_only && (x != 0.0 || y != 0.0) {
            return [x, y];
        }
        let u = (motion.unit)(&mut Draw::new(lattice, site, h_over_dx, &mut stream));
        [x + disorder.amplitude() * u[0], y + disorder.amplitude() * u[1]]
    };
    sites.iter().map(place).collect()
}

/// R/Δ of the case: of its coarsest rung, or as the case says it.
fn support(report: &Report, case: &Case, support_over_h: f64) -> Option<f64> {
    let readable = |support: &f64| (READABLE[0]..=READABLE[1]).contains(support);
    let same = |other: &Case| other.lattice == case.lattice && other.disorder == case.disorder;
    let of_fits = report
        .fits
        .iter()
        .filter(|fit| same(&fit.case))
        .flat_map(|fit| &fit.points)
        .filter_map(|point| point.support_over_dx)
        .filter(readable)
        .reduce(f64::min);
    let told = |name: &str| case.more.get(name).and_then(Value::as_f64);
    of_fits
        .or_else(|| told("support_over_dx"))
        .or_else(|| Some(told("h_over_dx")? * support_over_h))
        .or_else(|| Some(support_over_h / told("dx_over_h")?))
        .or_else(|| {
            let factor = report.laplacian_factors.iter().find(|f| Some(&f.lattice) == case.lattice.as_ref());
            Some(factor?.h_over_dx * support_over_h)
        })
        .or_else(|| {
            let of_runs = report.runs.iter().map(|run| run.h_over_dx * support_over_h);
            of_runs.reduce(f64::min)
        })
        .filter(|support| *support <= READABLE[1])
}
