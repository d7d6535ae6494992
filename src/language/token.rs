//! Text to tokens. ASCII and Unicode spellings give the same tokens.

use super::LanguageError;
use crate::exact::{Rational, parse_rational};
use std::ops::Range;

/// What a token is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TokenKind {
    /// A name and its subscript: `gradW_ij` is `gradW` of `ij`.
    Name(String, String),
    Number(Rational),
    Symbol(char),
    End,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token {
    pub kind: TokenKind,
    pub span: Range<usize>,
}

/// Longer texts are refused: the longest operator of the catalogue has under 600 bytes.
pub(super) const MOST_BYTES: usize = 16_384;

/// Spellings that stand for one name, longest first.
const SPELLINGS: &[(&str, &str)] = &[
    ("∇·∇W", "lapW"),
    ("∇²W", "lapW"),
    ("∇∇W", "gradgradW"),
    ("∇W", "gradW"),
    ("B̂", "Bhat"),
    ("Σ", "sum"),
    ("∑", "sum"),
    ("ω", "V"),
    ("ρ", "rho"),
    ("μ", "mu"),
    ("µ", "mu"),
    ("π", "pi"),
];

/// Characters that stand for a symbol.
fn symbol(c: char) -> Option<char> {
    Some(match c {
        '+' | '*' | '/' | '^' | '(' | ')' | '[' | ']' | '|' | ':' | '.' | '-' => c,
        '−' => '-',
        '·' => '.',
        '⊗' | '×' => '*',
        _ => return None,
    })
}

pub(super) fn tokens(text: &str) -> Result<Vec<Token>, LanguageError> {
    if text.len() > MOST_BYTES {
        let message = format!("the text has {} bytes, more than the {MOST_BYTES} allowed", text.len());
        return Err(LanguageError::new(MOST_BYTES..text.len(), message));
    }
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c.is_whitespace() {
            at += c.len_utf8();
            continue;
        }
        let (kind, length) = if c.is_ascii_digit() {
            number(rest, at)?
        } else if let Some((name, length)) = name(rest) {
            let (subscript, more) = subscript(&rest[length..], at + length)?;
            (TokenKind::Name(name, subscript), length + more)
        } else if let Some(symbol) = symbol(c) {
            (TokenKind::Symbol(symbol), c.len_utf8())
        } else if c == '_' {
            (TokenKind::Symbol('_'), 1)
        } else {
            return Err(LanguageError::new(
                at..at + c.len_utf8(),
                format!("'{c}' is not part of the language"),
            )
            .with_help("operators are written as in `sum_j V_j (u_j - u_i) gradW_ij`"));
        };
        tokens.push(Token { kind, span: at..at + length });
        at += length;
    }
    tokens.push(Token { kind: TokenKind::End, span: text.len()..text.len() });
    Ok(tokens)
}

/// An integer or a decimal, exactly. A dot that no digit follows is a contraction.
fn number(rest: &str, at: usize) -> Result<(TokenKind, usize), LanguageError> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(rest);
    let length = match rest[whole..].strip_prefix('.') {
        Some(fraction) if digits(fraction) > 0 => whole + 1 + digits(fraction),
        _ => whole,
    };
    let value = parse_rational(&rest[..length])
        .map_err(|error| LanguageError::new(at..at + length, error.to_string()))?;
    Ok((TokenKind::Number(value), length))
}

/// A name: one of the spellings above, else ASCII letters and digits.
fn name(rest: &str) -> Option<(String, usize)> {
    for (spelling, name) in SPELLINGS {
        if rest.starts_with(spelling) {
            return Some(((*name).to_owned(), spelling.len()));
        }
    }
    let length = rest.bytes().take_while(u8::is_ascii_alphanumeric).count();
    // A name may carry signs, as G+ and G- do, if what it applies to follows.
    let signed = rest[length..].starts_with("+[") || rest[length..].starts_with("-[");
    let hyphens = rest[length..].bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'-').count();
    let full = if signed {
        length + 1
    } else if rest[length + hyphens..].starts_with('[') {
        length + hyphens
    } else {
        length
    };
    (length > 0).then(|| (rest[..full].to_owned(), full))
}

/// `_ij`, or nothing. In braces too, as LaTeX writes it.
fn subscript(rest: &str, at: usize) -> Result<(String, usize), LanguageError> {
    let Some(after) = rest.strip_prefix('_') else { return Ok((String::new(), 0)) };
    let (inside, around) = match after.strip_prefix('{') {
        Some(inside) => (inside, 2),
        None => (after, 0),
    };
    let length = inside.bytes().take_while(u8::is_ascii_lowercase).count();
    let closed = around == 0 || inside[length..].starts_with('}');
    if length == 0 || !closed {
        return Err(LanguageError::new(at..at + 1, "particle indices, small letters, must follow '_'")
            .with_help("for example u_j or W_ij"));
    }
    Ok((inside[..length].to_owned(), 1 + around + length))
}
