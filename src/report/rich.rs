//! Text of the record in levels: what `^` and `_` raise and lower, for every view that can show it.

/// Where a piece of text stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    /// On the line.
    Line,
    /// Raised.
    Superscript,
    /// Lowered.
    Subscript,
}

/// The text in pieces: `(Δ/h)^{β+1}` is on the line and raised, `r_ij` on the line and lowered. `sum_dw` is a name and
/// stays whole: only a single letter takes a subscript.
pub(super) fn pieces(text: &str) -> Vec<(Level, String)> {
    let characters: Vec<char> = text.chars().collect();
    let mut found: Vec<(Level, String)> = Vec::new();
    let mut line = String::new();
    let mut at = 0;
    while let Some(&c) = characters.get(at) {
        let level = match c {
            '^' if at > 0 => Level::Superscript,
            '_' if stands_alone(&characters[..at]) => Level::Subscript,
            _ => Level::Line,
        };
        let length = if level == Level::Line { 0 } else { script_length(&characters[at + 1..], level) };
        if length == 0 {
            line.push(c);
            at += 1;
            continue;
        }
        if !line.is_empty() {
            found.push((Level::Line, std::mem::take(&mut line)));
        }
        let script: String = characters[at + 1..at + 1 + length].iter().collect();
        let bare = |open, close| script.strip_prefix(open).and_then(|inner: &str| inner.strip_suffix(close));
        let inner = bare('{', '}').or_else(|| bare('(', ')')).unwrap_or(&script);
        found.push((level, inner.replace('-', "−")));
        at += 1 + length;
    }
    if !line.is_empty() {
        found.push((Level::Line, line));
    }
    found
}

/// Whether what stands before an underscore is one letter, not the end of a word.
fn stands_alone(before: &[char]) -> bool {
    let base = before.iter().rev().take_while(|c| c.is_alphanumeric()).count();
    // After a superscript (E_0^0) or a bracket there is no letter at all.
    base == 1 || (base == 0 && before.last().is_some_and(|c| ")]|⟩".contains(*c)))
}

/// How many characters after `^` or `_` belong to the script: a group in braces, a signed number or fraction, letters.
fn script_length(rest: &[char], level: Level) -> usize {
    match rest.first() {
        Some('{') => rest.iter().position(|c| *c == '}').map_or(0, |end| end + 1),
        Some('(') if level == Level::Superscript => {
            rest.iter().position(|c| *c == ')').map_or(0, |end| end + 1)
        }
        Some('-' | '−' | '+') if rest.get(1).is_some_and(char::is_ascii_digit) => {
            1 + number_length(&rest[1..])
        }
        Some(c) if c.is_ascii_digit() => number_length(rest),
        Some(c) if c.is_alphabetic() => {
            let letters = rest.iter().take_while(|c| c.is_alphanumeric()).count();
            // r_ij, but not x_some_name; T and ⊗p are one character.
            if letters <= if level == Level::Subscript { 2 } else { 1 } { letters } else { 0 }
        }
        _ => 0,
    }
}

fn number_length(rest: &[char]) -> usize {
    let digits = |from: usize| rest.iter().skip(from).take_while(|c| c.is_ascii_digit()).count();
    let whole = digits(0);
    match rest.get(whole) {
        Some('/' | '.') if digits(whole + 1) > 0 => whole + 1 + digits(whole + 1),
        _ => whole,
    }
}

/// The text with `&`, `<`, `>` and quotes escaped, for XML and HTML.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            // Other control characters are not allowed in XML at all.
            c if c.is_control() && c != '\n' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(text: &str) -> String {
        let part = |(level, text): (Level, String)| match level {
            Level::Line => text,
            Level::Superscript => format!("⌈{text}⌉"),
            Level::Subscript => format!("⌊{text}⌋"),
        };
        pieces(text).into_iter().map(part).collect()
    }

    #[test]
    fn powers_and_indices_leave_the_line() {
        assert_eq!(marked("d̃/h^{2} (Δ/h)^{β+1}"), "d̃/h⌈2⌉ (Δ/h)⌈β+1⌉");
        assert_eq!(marked("(h/Δ)^3/2 at"), "(h/Δ)⌈3/2⌉ at");
        assert_eq!(marked("O(Δx/h)^(β+2),"), "O(Δx/h)⌈β+2⌉,");
        assert_eq!(marked("h^-1, E_0^1"), "h⌈−1⌉, E⌊0⌋⌈1⌉");
        assert_eq!(marked("u_i Σ_j ω_j ∇W_ij"), "u⌊i⌋ Σ⌊j⌋ ω⌊j⌋ ∇W⌊ij⌋");
    }

    #[test]
    fn names_stay_whole() {
        assert_eq!(marked("sum_dw and dx_over_h^"), "sum_dw and dx_over_h^");
    }
}
