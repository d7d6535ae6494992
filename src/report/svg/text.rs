//! Text in a figure: how wide it is at most, and how it is written.

use crate::report::rich::{Level, escaped, pieces};

/// The size of all text in a figure.
pub(super) const SIZE: f64 = 11.0;

/// The size of what is raised or lowered, over that of the line.
const SCRIPT: f64 = 0.75;

/// The width of the text at [`SIZE`], as wide as a common wide face (DejaVu Sans) makes it: which face a reader has is
/// not known.
pub(super) fn width(text: &str) -> f64 {
    let piece = |(level, text): (Level, String)| {
        let ems: f64 = text.chars().map(character).sum();
        ems * SIZE * if level == Level::Line { 1.0 } else { SCRIPT }
    };
    pieces(text).into_iter().map(piece).sum()
}

/// In ems.
fn character(c: char) -> f64 {
    match c {
        '\u{300}'..='\u{36f}' => 0.0,
        'i' | 'j' | 'l' | '|' | '\'' | 'I' => 0.34,
        ' ' | '.' | ',' | ':' | ';' | 'f' | 't' | '/' | '-' | '(' | ')' | '[' | ']' => 0.4,
        'r' | 's' => 0.52,
        'm' | 'w' | 'M' | 'W' | 'Ω' | '−' | '=' | '+' | '<' | '>' | '≤' | '≥' | '∇' | '∂' | '×' | 'Λ' => {
            0.88
        }
        c if c.is_ascii_digit() || c.is_ascii_lowercase() => 0.64,
        'A'..='Z' => 0.75,
        _ => 0.82,
    }
}

/// The text in lines of at most `most`, broken at spaces.
pub(super) fn wrapped(text: &str, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}")) <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Where a text stands on its anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A `<text>` element with powers raised.
pub(super) fn element(x: f64, y: f64, anchor: Anchor, text: &str) -> String {
    let class = match anchor {
        Anchor::Start => "",
        Anchor::Middle => " class=\"m\"",
        Anchor::End => " class=\"e\"",
    };
    let mut body = String::new();
    // What is raised has to be taken back by what follows.
    let mut shift = 0;
    for (level, piece) in pieces(text) {
        let target = match level {
            Level::Line => 0,
            Level::Superscript => -4,
            Level::Subscript => 3,
        };
        let safe = escaped(&piece);
        body += &match (target, target - shift) {
            (0, 0) => safe,
            (0, dy) => format!("<tspan dy=\"{dy}\">{safe}</tspan>"),
            (_, dy) => format!("<tspan class=\"s\" dy=\"{dy}\">{safe}</tspan>"),
        };
        shift = target;
    }
    format!("<text x=\"{}\" y=\"{}\"{class}>{body}</text>", number(x), number(y))
}

/// A coordinate, to a tenth of a pixel.
pub(super) fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    let (whole, part) = (tenths.abs() / 10, tenths.abs() % 10);
    let sign = if tenths < 0 { "-" } else { "" };
    if part == 0 { format!("{sign}{whole}") } else { format!("{sign}{whole}.{part}") }
}
