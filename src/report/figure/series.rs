//! The series of a report as figures, those of papers under their own number; crowded ones in panels.

use super::spectrum::is_spectrum;
use super::{Dash, Figure, Layer, Point};
use crate::record::{Line, Report, Series};

/// The most groups of lines (a measured line and its derived one are a group) that one panel holds.
const MOST_GROUPS: usize = 7;

/// Fewer points than this are drawn as points, more as a line.
const DENSE: usize = 30;

pub(super) fn figures(report: &Report) -> Vec<Figure> {
    report.series.iter().filter(|series| !is_spectrum(series)).flat_map(panels).collect()
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

fn panels(series: &Series) -> Vec<Figure> {
    let number = series.figure.as_ref().map(|figure| figure.trim_start_matches("Fig. ").to_owned());
    let subject = format!("{} against {}", series.y.name, series.x.name);
    let Some(part) = panel_part(&series.lines) else {
        let mut figure = Figure::new(series.id.clone(), subject, series.x.clone(), series.y.clone());
        figure.number = number;
        fill(&mut figure, series.lines.iter(), None);
        return vec![figure];
    };
    let values = distinct(series.lines.iter().filter_map(|line| parts(line).0.get(part).copied()));
    let panel = |value: &&str| {
        let (id, title) = (format!("{}/{value}", series.id), format!("{subject}: {value}"));
        let mut figure = Figure::new(id, title, series.x.clone(), series.y.clone());
        figure.number.clone_from(&number);
        // Lines without this part, such as an exact solution, stand in every panel.
        let own = series.lines.iter().filter(|line| parts(line).0.get(part).is_none_or(|own| own == value));
        fill(&mut figure, own, Some(part));
        figure
    };
    values.iter().map(panel).collect()
}

/// Puts lines into a figure; `panel` is the part of their names that the title says.
fn fill<'a>(figure: &mut Figure, lines: impl Iterator<Item = &'a Line>, panel: Option<usize>) {
    let mut groups: Vec<String> = Vec::new();
    let mut hidden = 0;
    for line in lines {
        let (name_parts, derived) = parts(line);
        let told = name_parts.iter().enumerate().filter(|(index, _)| Some(*index) != panel);
        let group = told.map(|(_, part)| *part).collect::<Vec<_>>().join(", ");
        // A name that comes twice is another group, unless it is the derived line of the first.
        let taken = figure.layers.iter().filter(|layer| layer.name.as_ref() == Some(&said(&group, derived)));
        let group = match taken.count() {
            0 => group,
            again => format!("{group} ({})", again + 1),
        };
        let colour = groups.iter().position(|known| *known == group).unwrap_or_else(|| {
            groups.push(group.clone());
            groups.len() - 1
        }) + 1;
        let name = said(&group, derived);
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
            figure.layers.push(Layer::line(name, colour, path, Dash::Dashed));
        } else if shown.len() >= DENSE {
            let dash = [Dash::Solid, Dash::Dashed, Dash::Dotted][(colour - 1) % 3];
            figure.layers.push(Layer::line(name, colour, path, dash));
        } else {
            figure.layers.push(Layer::line(name.clone(), colour, path, Dash::Solid).unnamed());
            figure.layers.push(Layer::points(name, colour, shown));
        }
    }
    if hidden > 0 {
        figure.notes.push(format!("{hidden} values at zero have no place on a logarithmic axis."));
    }
}

fn said(group: &str, derived: bool) -> String {
    if derived { format!("{group}, derived") } else { group.to_owned() }
}
