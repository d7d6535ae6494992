//! Text of the record as LaTeX: what TeX takes for commands is escaped, what its fonts lack becomes a symbol of mathematics.

use crate::report::rich::{Level, pieces};

/// The text in LaTeX's text mode, with superscripts and subscripts.
pub(super) fn tex(text: &str) -> String {
    let pieces = pieces(text).into_iter().map(|(level, piece)| match level {
        Level::Line => plain(&piece),
        Level::Superscript => format!("\\textsuperscript{{{}}}", plain(&piece)),
        Level::Subscript => format!("\\textsubscript{{{}}}", plain(&piece)),
    });
    pieces.collect()
}

/// The text as it stands, for ids and names: no character is lost.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let accent = characters.peek().and_then(|next| match next {
            '\u{303}' => Some("tilde"),
            '\u{302}' => Some("hat"),
            _ => None,
        });
        match accent {
            Some(accent) => {
                characters.next();
                out += &format!("\\ensuremath{{\\{accent}{{{c}}}}}");
            }
            None => character(c, &mut out),
        }
    }
    out
}

fn character(c: char, out: &mut String) {
    if let Some(command) = escaped(c) {
        out.push_str(command);
    } else if let Some(symbol) = symbol(c) {
        *out += &format!("\\ensuremath{{{symbol}}}");
    } else if c.is_ascii() || ('\u{a1}'..='\u{17f}').contains(&c) {
        // What `inputenc` knows: letters with accents.
        out.push(c);
    } else {
        // Never silently: a reader sees what is missing, and a test finds it.
        *out += &format!("\\texttt{{U+{:04X}}}", u32::from(c));
    }
}

/// What TeX would take for a command, and typographic signs.
fn escaped(c: char) -> Option<&'static str> {
    Some(match c {
        '\\' => "\\textbackslash{}",
        '{' => "\\{",
        '}' => "\\}",
        '$' => "\\$",
        '&' => "\\&",
        '#' => "\\#",
        '%' => "\\%",
        '_' => "\\_",
        '^' => "\\textasciicircum{}",
        '~' => "\\textasciitilde{}",
        '|' => "\\ensuremath{|}",
        '<' => "\\ensuremath{<}",
        '>' => "\\ensuremath{>}",
        '"' => "''",
        '[' => "{[}",
        ']' => "{]}",
        '–' => "--",
        '—' => "---",
        '‘' => "`",
        '’' => "'",
        '“' => "``",
        '”' => "''",
        '…' => "\\dots{}",
        '§' => "\\S{}",
        '\n' => " ",
        _ => return None,
    })
}

/// What stands in mathematics only.
pub(super) fn symbol(c: char) -> Option<&'static str> {
    Some(match c {
        'α' => "\\alpha",
        'β' => "\\beta",
        'γ' => "\\gamma",
        'δ' => "\\delta",
        'ε' => "\\varepsilon",
        'ζ' => "\\zeta",
        'η' => "\\eta",
        'θ' => "\\theta",
        'κ' => "\\kappa",
        'λ' => "\\lambda",
        'μ' | 'µ' => "\\mu",
        'ν' => "\\nu",
        'ξ' => "\\xi",
        'π' => "\\pi",
        'ρ' => "\\rho",
        'σ' => "\\sigma",
        'τ' => "\\tau",
        'φ' => "\\varphi",
        'χ' => "\\chi",
        'ψ' => "\\psi",
        'ω' => "\\omega",
        'Γ' => "\\Gamma",
        'Δ' => "\\Delta",
        'Θ' => "\\Theta",
        'Λ' => "\\Lambda",
        'Ξ' => "\\Xi",
        'Π' => "\\Pi",
        'Σ' | '∑' => "\\Sigma",
        'Φ' => "\\Phi",
        'Ψ' => "\\Psi",
        'Ω' => "\\Omega",
        '∇' => "\\nabla",
        '∂' => "\\partial",
        '∫' => "\\int",
        '√' => "\\surd",
        '∞' => "\\infty",
        'ℓ' => "\\ell",
        '−' => "-",
        '±' => "\\pm",
        '×' => "\\times",
        '·' => "\\cdot",
        '⊗' => "\\otimes",
        '⋮' => "\\vdots",
        '≈' => "\\approx",
        '≠' => "\\neq",
        '≤' => "\\le",
        '≥' => "\\ge",
        '≪' => "\\ll",
        '≫' => "\\gg",
        '∝' => "\\propto",
        '∈' => "\\in",
        '→' => "\\to",
        '←' => "\\leftarrow",
        '↔' => "\\leftrightarrow",
        '⟨' => "\\langle",
        '⟩' => "\\rangle",
        '‖' => "\\|",
        '°' => "{}^\\circ",
        '′' => "{}'",
        '″' => "{}''",
        '‴' => "{}'''",
        '⁰' => "{}^0",
        '¹' => "{}^1",
        '²' => "{}^2",
        '³' => "{}^3",
        '⁴' => "{}^4",
        '⁵' => "{}^5",
        '⁶' => "{}^6",
        '⁷' => "{}^7",
        '⁸' => "{}^8",
        '⁹' => "{}^9",
        '⁺' => "{}^+",
        '⁻' => "{}^-",
        'ᵖ' => "{}^p",
        'ᵀ' => "{}^T",
        '₀' => "{}_0",
        '₁' => "{}_1",
        '₂' => "{}_2",
        '₃' => "{}_3",
        '₄' => "{}_4",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{plain, tex};

    #[test]
    fn commands_are_escaped_and_symbols_set() {
        assert_eq!(plain("50 % of a_b & {c}\\"), "50 \\% of a\\_b \\& \\{c\\}\\textbackslash{}");
        assert_eq!(plain("d\u{303}/h"), "\\ensuremath{\\tilde{d}}/h");
        assert_eq!(tex("(Δ/h)^{β+1}"), "(\\ensuremath{\\Delta}/h)\\textsuperscript{\\ensuremath{\\beta}+1}");
        assert_eq!(plain("\u{2603}"), "\\texttt{U+2603}");
    }
}
