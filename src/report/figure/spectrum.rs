//! Eigenvalues in the complex plane, with the regions in which the explicit methods are stable.

use super::{Dash, Figure, Layer, Mark, Point};
use crate::evolve::Explicit;
use crate::evolve::spectrum::largest_step;
use crate::record::{Report, Series};
use nalgebra::Complex;
use std::f64::consts::PI;

/// Points on half the outline of a region.
const OUTLINE: usize = 64;

/// Whether a series holds eigenvalues.
pub(super) fn is_spectrum(series: &Series) -> bool {
    series.x.name == "Re λ" && series.y.name == "Im λ"
}

/// What `spectrum-S3-n20-h1.5-e0.4` says.
struct Told<'a> {
    scheme: &'a str,
    n: u64,
    h: &'a str,
    epsilon: &'a str,
}

fn told(id: &str) -> Option<Told<'_>> {
    let rest = id.strip_prefix("spectrum-")?;
    let (rest, epsilon) = rest.rsplit_once("-e")?;
    let (rest, h) = rest.rsplit_once("-h")?;
    let (scheme, n) = rest.rsplit_once("-n")?;
    Some(Told { scheme, n: n.parse().ok()?, h, epsilon })
}

/// One figure per scheme and h/Δ: the spectra of the finest particles, regular and disordered.
pub(super) fn figures(report: &Report) -> Vec<Figure> {
    let all: Vec<(&Series, Told<'_>)> = report
        .series
        .iter()
        .filter(|series| is_spectrum(series))
        .filter_map(|series| Some((series, told(&series.id)?)))
        .collect();
    let finest = all.iter().map(|(_, told)| told.n).max();
    let mut drawn: Vec<(&str, &str)> = Vec::new();
    let mut figures = Vec::new();
    for (_, first) in &all {
        if Some(first.n) != finest || drawn.contains(&(first.scheme, first.h)) {
            continue;
        }
        drawn.push((first.scheme, first.h));
        let own = all
            .iter()
            .filter(|(_, other)| other.n == first.n && other.scheme == first.scheme && other.h == first.h);
        figures.push(figure(first, &own.collect::<Vec<_>>()));
    }
    figures
}

fn figure(first: &Told<'_>, own: &[&(&Series, Told<'_>)]) -> Figure {
    let id = format!("spectrum-{}-h{}", first.scheme, first.h);
    let title = format!(
        "Eigenvalues of {} with h/Δ = {}, {} × {} particles, and where explicit steps are stable",
        first.scheme, first.h, first.n, first.n
    );
    let axes = own.first().map(|(series, _)| (series.x.clone(), series.y.clone()));
    let Some((x, y)) = axes else { unreachable!("a group holds its first member") };
    let mut figure = Figure::new(id, title, x, y);
    figure.same_scale = true;
    let values: Vec<Complex<f64>> = own
        .iter()
        .flat_map(|(series, _)| &series.lines)
        .flat_map(|line| &line.points)
        .filter_map(|point| Some(Complex::new(*point.first()?, *point.get(1)?)))
        .collect();
    let growing = values.iter().filter(|value| value.re >= 0.0).count();
    if growing > 0 {
        figure.notes.push(format!("{growing} eigenvalues do not decay: no step is stable."));
    } else {
        let methods = [(Explicit::Rk4, "RK4"), (Explicit::Rk2, "RK2"), (Explicit::Euler, "Euler")];
        for (colour, (method, name)) in methods.into_iter().enumerate() {
            let Some(step) = largest_step(&values, method) else { continue };
            let outline = region(method).into_iter().map(|z| [z.re / step, z.im / step]).collect();
            let name = format!("{name}, Δt = {} Δ²", crate::record::significant(step, 3));
            figure.layers.push(Layer { name: Some(name), colour: colour + 3, mark: Mark::Area { outline } });
        }
        figure.notes.push("Each region is that of the largest stable step of its method.".into());
    }
    let zero = vec![[0.0, -1e3], [0.0, 1e3]];
    figure.layers.push(Layer::line("", 0, zero, Dash::Dotted).unnamed());
    for (colour, (series, told)) in own.iter().enumerate() {
        let points = series.lines.iter().flat_map(|line| &line.points);
        let points =
            points.filter_map(|point| Some(Point { x: *point.first()?, y: *point.get(1)?, error: None }));
        let name = match told.epsilon {
            "0" => "regular".to_owned(),
            epsilon => format!("displaced, ε = {epsilon}"),
        };
        figure.layers.push(Layer::points(name, colour + 1, points.collect()));
    }
    figure
}

/// The outline of {z: |R(z)| ≤ 1} as seen from a point inside, one crossing per direction.
fn region(method: Explicit) -> Vec<Complex<f64>> {
    let inside = |z: Complex<f64>| method.amplification(z).norm() <= 1.0;
    let centre = Complex::new(-1.0, 0.0);
    let ray = |k: usize| {
        let angle = PI * k as f64 / OUTLINE as f64;
        let direction = Complex::new(libm::cos(angle), libm::sin(angle));
        // Far enough for all three; outward in steps, as a region need not be convex, then by halves.
        let mut low = 0.0;
        while low < 6.0 && inside(centre + direction * (low + 0.05)) {
            low += 0.05;
        }
        let mut high = low + 0.05;
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if inside(centre + direction * middle) { low = middle } else { high = middle }
        }
        centre + direction * low
    };
    let upper: Vec<Complex<f64>> = (0..=OUTLINE).map(ray).collect();
    let lower = upper.iter().rev().skip(1).take(OUTLINE - 1).map(|z| z.conj());
    upper.iter().copied().chain(lower.collect::<Vec<_>>()).collect()
}
