//! What a verdict on one case rests on: formula, reason, fits with their points.

use super::Detail;
use super::column::Which;
use super::math::order;
use super::text::{estimate, key, number, rich, value};
use crate::record::{ClaimEntry, Fit, FitPoint, Number};
use crate::report::figure::Ladder;
use crate::report::rich::escaped;
use crate::report::svg::{self, Size};
use std::fmt::Write as _;

/// A fit with its figure.
pub(super) type Fitted<'a> = (&'a Fit, &'a Ladder);

/// The evidence of one entry.
pub(super) fn evidence(page: &mut String, entry: &ClaimEntry, fits: &[Fitted<'_>], detail: Detail) {
    page.push_str("<div class=\"evidence\">");
    if detail == Detail::Full {
        formulas(page, entry);
    }
    let _ = write!(page, "<p>{}</p>", rich(&entry.why));
    if detail == Detail::Full {
        let _ = write!(page, "<p class=\"small\">Case: {}.</p>", case(entry));
    }
    for (index, fitted) in fits.iter().enumerate() {
        // The first fit is the one that the verdict is about.
        fit(page, *fitted, detail, index == 0);
    }
    page.push_str("</div>");
}

fn formulas(page: &mut String, entry: &ClaimEntry) {
    let of = |which: Which| {
        let exponents = which.of(entry)?.exponents.as_ref()?;
        Some(format!("<li>{}: {}</li>", which.name(), order(exponents)))
    };
    let lines: String = Which::ALL.into_iter().filter_map(of).collect();
    if !lines.is_empty() {
        let _ = write!(page, "<ul class=\"formulas\">{lines}</ul>");
    }
    if let Some(relation) = Which::Published.of(entry).and_then(|column| column.relation.as_ref()) {
        let _ = write!(
            page,
            "<p>Published: {} {} {}.</p>",
            rich(&relation.left),
            escaped(&relation.sign),
            rich(&relation.right)
        );
    }
    let from = Which::Derived.of(entry).and_then(|column| column.from.as_ref());
    // The reason of the verdict mostly says it already.
    if let Some(from) = from.filter(|from| !entry.why.contains(from.as_str())) {
        let _ = write!(page, "<p>The derived order: {}.</p>", rich(from));
    }
}

fn case(entry: &ClaimEntry) -> String {
    let case = &entry.case;
    let mut parts = vec![format!("{}-D", case.dimension), escaped(&case.kernel)];
    parts.extend(case.lattice.as_deref().map(escaped));
    parts.push(match case.disorder.as_deref() {
        None | Some("none") => "no disorder".into(),
        Some(disorder) => escaped(disorder),
    });
    parts.push(format!("{} volumes", escaped(&case.volume_rule)));
    // The expansion has its own line above the cases.
    let more = case.more.iter().filter(|(name, _)| !["expansion", "conserves"].contains(&name.as_str()));
    parts.extend(more.map(|(name, held)| format!("{} {}", key(name), value(Some(held)))));
    if let Some(margin) = entry.margin {
        parts.push(format!("margin ±{}", number(margin)));
    }
    parts.join(", ")
}

/// Why points were left out, each reason once with how many.
fn left_out(points: &[FitPoint]) -> Vec<(usize, &str)> {
    let mut reasons: Vec<(usize, &str)> = Vec::new();
    for point in points.iter().filter(|point| !point.kept) {
        let why = point.why.as_deref().unwrap_or("no reason given");
        match reasons.iter_mut().find(|(_, known)| *known == why) {
            Some((count, _)) => *count += 1,
            None => reasons.push((1, why)),
        }
    }
    reasons
}

fn fit(page: &mut String, (fit, ladder): Fitted<'_>, detail: Detail, first: bool) {
    let drawn = match detail {
        Detail::Full => Some(Size::FULL),
        Detail::Compact if first => Some(Size::SMALL),
        Detail::Compact | Detail::Least => None,
    };
    page.push_str("<div class=\"fit\">");
    if let Some(size) = drawn {
        page.push_str(&svg::inline(&ladder.figure, size));
    }
    page.push_str("<div>");
    let kept: Vec<&FitPoint> = fit.points.iter().filter(|point| point.kept).collect();
    let ends = |points: &[&FitPoint]| {
        let least = points.iter().map(|point| point.x).reduce(f64::min)?;
        let most = points.iter().map(|point| point.x).reduce(f64::max)?;
        Some(format!(", {} from {} to {}", rich(&fit.x.name), number(least), number(most)))
    };
    let slope = match &fit.slope.value {
        Number::Float(_) => estimate(&crate::record::Estimate {
            value: two(&fit.slope.value),
            low: two(&fit.slope.low),
            high: two(&fit.slope.high),
            by: None,
        }),
        Number::Rational(_) => estimate(&fit.slope),
    };
    let _ = write!(
        page,
        "<p>{} against {}: slope {slope}; window of {} of {} points{}; residual sd {} of ln y, {} degrees of freedom.</p>",
        rich(&fit.quantity),
        rich(&fit.x.name),
        kept.len(),
        fit.points.len(),
        ends(&kept).unwrap_or_default(),
        number(crate::record::significant(fit.residual_sd, 2)),
        fit.degrees_of_freedom
    );
    for (count, why) in left_out(&fit.points) {
        let _ = write!(page, "<p>Left out: {count}, {}.</p>", rich(why));
    }
    if detail == Detail::Full {
        points(page, fit);
    }
    page.push_str("</div></div>");
}

/// Three digits behind the point are more than an exponent's interval resolves.
fn two(value: &Number) -> Number {
    match value {
        Number::Float(value) => Number::Float((value * 1000.0).round() / 1000.0),
        exact => exact.clone(),
    }
}

fn points(page: &mut String, fit: &Fit) {
    let sampled = fit.points.iter().any(|point| point.samples.is_some());
    let on_lattice = fit.points.iter().any(|point| point.support_over_dx.is_some());
    let with_errors = fit.points.iter().any(|point| point.y_error.is_some());
    let _ = write!(
        page,
        "<details><summary>Points and residuals</summary><p class=\"small\">Interval: {}.</p>\
         <div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Points of the fit\"><table><thead><tr>",
        rich(&fit.interval)
    );
    let mut heads = vec![rich(&fit.x.name), "y".into()];
    heads.extend(with_errors.then(|| "± se".to_owned()));
    heads.extend(sampled.then(|| "samples".to_owned()));
    heads.extend(on_lattice.then(|| "R/Δ".to_owned()));
    heads.extend(["residual of ln y".to_owned(), "used".to_owned()]);
    for head in heads {
        let _ = write!(page, "<th scope=\"col\">{head}</th>");
    }
    page.push_str("</tr></thead><tbody>");
    for point in &fit.points {
        let mut cells = vec![number(point.x), number(point.y)];
        let optional = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), number);
        let short = |value: Option<f64>| optional(value.map(|value| crate::record::significant(value, 2)));
        cells.extend(with_errors.then(|| short(point.y_error)));
        cells.extend(sampled.then(|| point.samples.map_or_else(|| "–".to_owned(), |n| n.to_string())));
        cells.extend(on_lattice.then(|| optional(point.support_over_dx)));
        cells.push(short(point.residual));
        cells.push(if point.kept { "yes".into() } else { "no".into() });
        page.push_str("<tr>");
        for cell in cells {
            let _ = write!(page, "<td>{cell}</td>");
        }
        page.push_str("</tr>");
    }
    page.push_str("</tbody></table></div></details>");
}
