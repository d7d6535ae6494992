//! The series of a report as figures, those of papers under their own number; crowded ones in panels.

use super::spectrum::is_spectrum;
use super::{Dash, Figure, Layer, Point};
use crate::record::{Line, Report, Series};

/// The most groups of lines (a measured line and its derived one are a group) that one panel holds.
const MOST_GROUPS: usize = 7;

/// Fewer points than this are drawn as points, more as a line.
const DENSE: usize = 30;

pub(super) fn figures(report: &Report) -> Vec<Figure> {
    // A caption names its series where the number and the axes alone do not tell which it is.
    let same = |a: &Series, b: &Series| a.figure == b.figure && a.x.name == b.x.name && a.y.name == b.y.name;
    let drawn = report.series.iter().filter(|series| !is_spectrum(series));
    drawn
        .flat_map(|series| {
            let twins = report.series.iter().filter(|other| same(series, other)).count();
            panels(series, series.figure.is_none() || twins > 1)
        })
        .collect()
}

/// What a line's name says, part by part, and whether it is the derived one of its group.
fn parts(line: &Line) -> (Vec<&str>, bool) {
    let mut parts: Vec<&str> = line.name.split(", ").collect();
    let derived = parts.len() > 1 && parts.last() == Some(&"derived");
    if derived {
        parts.pop();
    }
    (parts, derived)
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut known = Vec::new();
    for name in names {
        if !known.contains(&name) {
            known.push(name);
        }
    }
    known
}

/// The part of the names by which the lines fall into the fewest panels of at most [`MOST_GROUPS`].
fn panel_part(lines: &[Line]) -> Option<usize> {
    let groups = lines.iter().filter(|line| !parts(line).1).count();
    if groups <= MOST_GROUPS {
        return None;
    }
    let names: Vec<Vec<&str>> = lines.iter().map(|line| parts(line).0).collect();
    let longest = names.iter().map(Vec::len).max()?;
    let fits = |part: &usize| {
        let values = distinct(names.iter().filter_map(|name| name.get(*part).copied()));
        values.iter().all(|value| {
            let own = lines.iter().filter(|line| !parts(line).1 && parts(line).0.get(*part) == Some(value));
            own.count() <= MOST_GROUPS
        })
    };
    let count = |part: &usize| distinct(names.iter().filter_map(|name| name.get(*part).copied())).len();
    (0..longest).filter(fits).filter(|part| count(part) > 1).min_by_key(count)
}

fn panels(series: &Series, named: bool) -> Vec<Figure> {
    let spans_decades = spans_decades(&series.lines);
    let number = series.figure.as_ref().map(|figure| figure.trim_start_matches("Fig. ").to_owned());
    let subject = format!("{} against {}", series.y.name, series.x.name);
    let panel = |id: String, title: &str, lines: &[&Line], part: Option<usize>| {
        let mut figure = Figure::new(id, "", series.x.clone(), series.y.clone());
        figure.number.clone_from(&number);
        if spans_decades && !figure.y.log {
            figure.y.log = true;
            figure.notes.push("The ordinate spans decades and is drawn logarithmically.".into());
        }
        let common = common_parts(lines, part);
        let shared: Vec<&str> = common.iter().map(|(_, value)| *value).collect();
        let told: Vec<&str> = [title].into_iter().chain(shared).filter(|text| !text.is_empty()).collect();
        figure.title = match told.as_slice() {
            [] => subject.clone(),
            told => format!("{subject}: {}", told.join(", ")),
        };
        let skipped: Vec<usize> = part.into_iter().chain(common.iter().map(|(part, _)| *part)).collect();
        fill(&mut figure, lines, &skipped);
        if named {
            figure.notes.push(format!("Series {} of the report.", series.id));
        }
        figure
    };
    let Some(part) = panel_part(&series.lines) else {
        return vec![panel(series.id.clone(), "", &series.lines.iter().collect::<Vec<_>>(), None)];
    };
    let values = distinct(series.lines.iter().filter_map(|line| parts(line).0.get(part).copied()));
    let one = |value: &&str| {
        // Lines without this part, such as an exact solution, stand in every panel.
        let own = series.lines.iter().filter(|line| parts(line).0.get(part).is_none_or(|own| own == value));
        panel(format!("{}/{value}", series.id), value, &own.collect::<Vec<_>>(), Some(part))
    };
    values.iter().map(one).collect()
}

/// Whether a straight axis would press most of the values onto zero.
fn spans_decades(lines: &[Line]) -> bool {
    let mut values: Vec<f64> =
        lines.iter().flat_map(|line| &line.points).filter_map(|point| point.get(1)).copied().collect();
    values.sort_by(f64::total_cmp);
    match (values.first(), values.get(values.len() / 2), values.last()) {
        (Some(least), Some(middle), Some(most)) => *least >= 0.0 && *most > 100.0 * middle,
        _ => false,
    }
}

/// The parts that all names have and share, beside that of the panel: they are said once.
fn common_parts<'a>(lines: &[&'a Line], panel: Option<usize>) -> Vec<(usize, &'a str)> {
    let names: Vec<Vec<&str>> = lines.iter().map(|line| parts(line).0).collect();
    let Some(first) = names.first().filter(|_| names.len() > 1) else { return Vec::new() };
    // One part at least has to stay as the name.
    let shared = |(part, value): &(usize, &'a str)| {
        Some(*part) != panel && names.iter().all(|name| name.get(*part) == Some(value))
    };
    let all: Vec<(usize, &str)> = first.iter().copied().enumerate().filter(shared).collect();
    if all.len() + usize::from(panel.is_some()) < first.len() { all } else { Vec::new() }
}

/// Puts lines into a figure; what the parts `skipped` of their names say stands in the title.
fn fill(figure: &mut Figure, lines: &[&Line], skipped: &[usize]) {
    let mut groups: Vec<String> = Vec::new();
    let mut measured: Vec<String> = Vec::new();
    let (mut hidden, mut any_derived) = (0, false);
    for line in lines {
        let (name_parts, derived) = parts(line);
        let told = name_parts.iter().enumerate().filter(|(index, _)| !skipped.contains(index));
        let name = told.map(|(_, part)| *part).collect::<Vec<_>>().join(", ");
        // A name that comes twice is another group; a derived line belongs to the measured one before it.
        let again = measured.iter().filter(|known| **known == name).count();
        let group = match again + usize::from(!derived) {
            0 | 1 => name.clone(),
            count => format!("{name} ({count})"),
        };
        if !derived {
            measured.push(name);
        }
        let colour = groups.iter().position(|known| *known == group).unwrap_or_else(|| {
            groups.push(group.clone());
            groups.len() - 1
        }) + 1;
        let shown: Vec<Point> = line
            .points
            .iter()
            .filter_map(|point| match point.as_slice() {
                [x, y] => Some(Point { x: *x, y: *y, error: None }),
                [x, y, error, ..] => Some(Point { x: *x, y: *y, error: Some(*error).filter(|e| *e > 0.0) }),
                _ => None,
            })
            .filter(|point| figure.shows(point.x, point.y))
            .collect();
        hidden += line.points.len() - shown.len();
        let path: Vec<[f64; 2]> = shown.iter().map(|point| [point.x, point.y]).collect();
        if derived {
            any_derived = true;
            figure.layers.push(Layer::line("", colour, path, Dash::Dashed).unnamed());
        } else if shown.len() >= DENSE {
            let dash = [Dash::Solid, Dash::Dashed, Dash::Dotted][(colour - 1) % 3];
            figure.layers.push(Layer::line(group, colour, path, dash));
        } else {
            figure.layers.push(Layer::line("", colour, path, Dash::Solid).unnamed());
            figure.layers.push(Layer::points(group, colour, shown));
        }
    }
    if any_derived {
        // One entry of the legend for all of them: their colours are those of what was measured.
        figure.layers.push(Layer::line("derived", 0, Vec::new(), Dash::Dashed));
    }
    if hidden > 0 {
        figure.notes.push(format!("{hidden} values at zero have no place on a logarithmic axis."));
    }
}
