//! Figures as SVG: inside a page, whose style sheet holds [`STYLE`], or as files of their own.
//!
//! Every layer has a colour of the palette of Okabe and Ito (as their hues, dark or light enough for the ground they
//! stand on) and a marker or a dash of its own, so that nothing is said by colour alone.

mod layout;
mod marks;
mod text;
mod ticks;

pub use layout::Size;

use super::figure::Figure;
use super::rich::escaped;
use layout::{LINE, Layout, SWATCH};
use std::fmt::Write as _;
use text::{Anchor, SIZE, element, number};

/// What the drawings need of a style sheet.
pub const STYLE: &str = include_str!("figure.css");

/// The figure as an `<svg>` element for a page.
pub fn inline(figure: &Figure, size: Size) -> String {
    drawing(figure, size, None)
}

/// The figure as a file with its own style, dark on light whoever looks at it, and in plain colours, as converters to PDF
/// know no variables.
pub fn standalone(figure: &Figure) -> String {
    let mut rules = STYLE.lines();
    let light = rules.next().and_then(|rule| rule.strip_prefix(".figure{")).unwrap_or_default();
    let mut style: String = rules.filter(|rule| !rule.starts_with("@media")).collect();
    for declaration in light.trim_end_matches('}').split(';') {
        if let Some((name, value)) = declaration.split_once(':') {
            style = style.replace(&format!("var({name})"), value);
        }
    }
    let svg = drawing(figure, Size::FULL, Some(&style));
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{svg}\n")
}

fn drawing(figure: &Figure, size: Size, own_style: Option<&str>) -> String {
    let layout = Layout::of(figure, size);
    let [width, height] = layout.size.map(number);
    let mut svg = format!("<svg class=\"figure\" role=\"img\" viewBox=\"0 0 {width} {height}\"");
    if own_style.is_some() {
        // A page sets the size of its drawings, a file has its own.
        let _ = write!(svg, " xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"");
    }
    let title = title(figure);
    // Beside its fit, what is drawn of which case has been said.
    let short = title.split(": ").next().filter(|_| !size.alone).unwrap_or(&title);
    let _ = write!(svg, "><title>{}</title>", escaped(short));
    if size.alone {
        let _ = write!(svg, "<desc>{}</desc>", escaped(&description(figure)));
    }
    if let Some(style) = own_style {
        let _ = write!(svg, "<style>{style}</style>");
    }
    axes(&mut svg, &layout);
    for layer in &figure.layers {
        svg += &marks::layer(layer, &layout);
    }
    for entry in &layout.legend {
        let Some(layer) = figure.layers.get(entry.layer) else { continue };
        let [x, y] = entry.at;
        svg += &marks::swatch(layer, [x, y + 0.5 * LINE], SWATCH - 4.0);
        for (index, line) in entry.lines.iter().enumerate() {
            let baseline = y + LINE * index as f64 + 0.5 * LINE + 0.35 * SIZE;
            svg += &element(x + SWATCH, baseline, Anchor::Start, line);
        }
    }
    svg + "</svg>"
}

/// The title with the number in the paper.
pub fn title(figure: &Figure) -> String {
    match &figure.number {
        Some(number) => format!("Fig. {number} of the paper: {}", figure.title),
        None => figure.title.clone(),
    }
}

/// The figure in words, for who cannot see it.
fn description(figure: &Figure) -> String {
    let scale = |log: bool| if log { "logarithmic" } else { "linear" };
    let names: Vec<&str> = figure.layers.iter().filter_map(|layer| layer.name.as_deref()).collect();
    format!(
        "{} ({}) against {} ({}): {}.",
        figure.y.name,
        scale(figure.y.log),
        figure.x.name,
        scale(figure.x.log),
        names.join("; ")
    )
}

fn axes(svg: &mut String, layout: &Layout) {
    let plot = layout.plot;
    let (mut grid, mut small) = (String::new(), String::new());
    let mut labels = String::new();
    for tick in &layout.x_ticks {
        let x = layout.place(tick.at, layout.range.y[0])[0];
        match &tick.label {
            Some(label) => {
                let _ = write!(grid, "M{} {}V{}", number(x), number(plot.top), number(plot.bottom));
                // A label never leaves the drawing, even at the end of the axis.
                let half = 0.5 * text::width(label);
                let x = x.min(layout.size[0] - half - 1.0).max(half + 1.0);
                labels += &element(x, plot.bottom + 5.0 + SIZE, Anchor::Middle, label);
            }
            None => {
                let _ = write!(small, "M{} {}v-4", number(x), number(plot.bottom));
            }
        }
    }
    for tick in &layout.y_ticks {
        let y = layout.place(layout.range.x[0], tick.at)[1];
        match &tick.label {
            Some(label) => {
                let _ = write!(grid, "M{} {}H{}", number(plot.left), number(y), number(plot.right));
                labels += &element(plot.left - 5.0, y + 0.35 * SIZE, Anchor::End, label);
            }
            None => {
                let _ = write!(small, "M{} {}h4", number(plot.left), number(y));
            }
        }
    }
    let _ = write!(svg, "<path class=\"g\" d=\"{grid}\"/>");
    let _ = write!(
        svg,
        "<path class=\"x\" d=\"M{} {}V{}H{}V{}z{small}\"/>{labels}",
        number(plot.left),
        number(plot.top),
        number(plot.bottom),
        number(plot.right),
        number(plot.top)
    );
    for (index, line) in layout.y_title.iter().enumerate() {
        *svg += &element(3.0, 3.0 + SIZE + LINE * index as f64, Anchor::Start, line);
    }
    for (index, line) in layout.x_title.iter().enumerate() {
        let y = plot.bottom + 5.0 + SIZE + LINE * (index + 1) as f64;
        *svg += &element(0.5 * (plot.left + plot.right), y, Anchor::Middle, line);
    }
}
