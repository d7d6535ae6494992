//! JSON for people and diffs: what fits on a line stays on it, the rest is broken and indented.

use serde::Serialize;

/// The longest line that is not broken, in bytes.
const WIDTH: usize = 118;

/// The document, with a newline at the end. The order of fields is that of the type.
pub fn to_json<T: Serialize>(value: &T) -> String {
    let compact = serde_json::to_string(value).unwrap_or_else(|error| unreachable!("plain data: {error}"));
    let mut text = String::with_capacity(2 * compact.len());
    lay(&compact, 0, 0, &mut text);
    text.push('\n');
    text
}

/// Appends one compact value; `before` bytes of its first line are taken.
fn lay(value: &str, indent: usize, before: usize, text: &mut String) {
    let is_list = value.starts_with(['[', '{']);
    if !is_list || indent + before + spaced_length(value) <= WIDTH {
        return space(value, text);
    }
    let line = |text: &mut String, depth: usize| {
        text.push('\n');
        text.extend(std::iter::repeat_n(' ', depth));
    };
    text.push_str(&value[..1]);
    for (index, item) in items(&value[1..value.len() - 1]).enumerate() {
        if index > 0 {
            text.push(',');
        }
        line(text, indent + 2);
        match key_length(item).filter(|_| value.starts_with('{')) {
            Some(key) => {
                text.push_str(&item[..key]);
                text.push_str(": ");
                lay(&item[key + 1..], indent + 2, key + 2, text);
            }
            None => lay(item, indent + 2, 0, text),
        }
    }
    line(text, indent);
    text.push_str(&value[value.len() - 1..]);
}

/// The members of a list or an object, without its brackets.
fn items(inside: &str) -> impl Iterator<Item = &str> {
    let mut rest = inside;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = outside(rest).find(|(byte, depth, _)| *byte == b',' && *depth == 0);
        let end = end.map_or(rest.len(), |(_, _, at)| at);
        let item = &rest[..end];
        rest = rest.get(end + 1..).unwrap_or_default();
        Some(item)
    })
}

/// Bytes up to the colon after a key.
fn key_length(member: &str) -> Option<usize> {
    outside(member).find(|(byte, _, _)| *byte == b':').map(|(_, _, at)| at)
}

/// Length with a space after every comma and colon.
fn spaced_length(value: &str) -> usize {
    value.len() + outside(value).filter(|(byte, _, _)| matches!(byte, b',' | b':')).count()
}

fn space(value: &str, text: &mut String) {
    let mut from = 0;
    for (_, _, at) in outside(value).filter(|(byte, _, _)| matches!(byte, b',' | b':')) {
        text.push_str(&value[from..=at]);
        text.push(' ');
        from = at + 1;
    }
    text.push_str(&value[from..]);
}

/// The bytes outside strings, with their depth and place.
fn outside(json: &str) -> impl Iterator<Item = (u8, usize, usize)> + '_ {
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    json.bytes().enumerate().filter_map(move |(at, byte)| {
        if in_string {
            in_string = escaped || byte != b'"';
            escaped = !escaped && byte == b'\\';
            return None;
        }
        match byte {
            b'"' => in_string = true,
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth -= 1,
            _ => {}
        }
        Some((byte, depth, at))
    })
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    #[test]
    fn nothing_is_lost_and_lines_are_short() {
        let tricky = json!({
            "a,b:{[": "quote \" backslash \\ brace } \\\"",
            "empty": [{}, [], ""],
            "points": (0..40).map(|n| json!({"x": n, "why": "α, β: γ"})).collect::<Vec<_>>(),
        });
        let text = super::to_json(&tricky);
        assert_eq!(serde_json::from_str::<Value>(&text).expect("still JSON"), tricky);
        assert!(text.lines().all(|line| line.len() <= super::WIDTH + 1), "{text}");
        assert!(text.lines().count() < 60, "{text}");
    }
}
