//! Citations from `references.bib`.

use super::text::rich;
use crate::report::rich::escaped;

/// The literature, as committed.
const REFERENCES: &str = include_str!("../../../references.bib");

/// One entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reference {
    fields: Vec<(String, String)>,
}

impl Reference {
    /// The entry of this key.
    pub(super) fn by_key(key: &str) -> Option<Self> {
        let entry = REFERENCES.split("\n@").find(|entry| {
            entry.split_once('{').is_some_and(|(_, rest)| rest.trim_start().starts_with(&format!("{key},")))
        })?;
        let field = |line: &str| {
            let (name, value) = line.split_once('=')?;
            let value = value.trim().trim_end_matches(',');
            Some((name.trim().to_owned(), plain(value)))
        };
        Some(Self { fields: entry.lines().skip(1).filter_map(field).collect() })
    }

    fn field(&self, name: &str) -> Option<&str> {
        self.fields.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    /// Authors and year, short.
    pub(super) fn short(&self) -> String {
        let authors = self.field("author").unwrap_or_default();
        let families: Vec<&str> =
            authors.split(" and ").map(|author| author.split(',').next().unwrap_or(author).trim()).collect();
        let names = match families.as_slice() {
            [one] => (*one).to_owned(),
            [one, two] => format!("{one} & {two}"),
            [one, ..] => format!("{one} et al."),
            [] => String::new(),
        };
        format!("{names} ({})", self.field("year").unwrap_or_default())
    }

    /// The whole entry in HTML.
    pub(super) fn html(&self) -> String {
        let authors = self.field("author").unwrap_or_default().replace(" and ", "; ");
        let mut parts = vec![
            escaped(&authors),
            format!("<cite>{}</cite>", rich(self.field("title").unwrap_or_default())),
        ];
        let mut place = escaped(self.field("journal").or(self.field("booktitle")).unwrap_or_default());
        if let Some(volume) = self.field("volume") {
            place += &format!(" {}", escaped(volume));
        }
        if let Some(number) = self.field("number") {
            place += &format!(" ({})", escaped(number));
        }
        parts.push(place);
        parts.extend(self.field("address").map(escaped));
        parts.extend(self.field("pages").map(escaped));
        parts.extend(self.field("year").map(escaped));
        let text = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
        let link = self.field("doi").map(|doi| {
            let doi = escaped(doi);
            format!(", <a href=\"https://doi.org/{doi}\">doi:{doi}</a>")
        });
        format!("{text}{}.", link.unwrap_or_default())
    }
}

/// A BibTeX value as text: accents composed, braces gone.
fn plain(value: &str) -> String {
    let accents =
        [("{\\\"o}", "ö"), ("{\\\"u}", "ü"), ("{\\\"a}", "ä"), ("{\\'e}", "é"), ("\\&", "&"), ("--", "–")];
    let text = accents.iter().fold(value.to_owned(), |text, (from, to)| text.replace(from, to));
    text.chars().filter(|c| !matches!(c, '{' | '}')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_are_found() {
        let paper = Reference::by_key("fatehi-manzari-2011").unwrap();
        assert_eq!(paper.short(), "Fatehi & Manzari (2011)");
        assert!(paper.html().contains("61 (2), 482–498, 2011"), "{}", paper.html());
        assert_eq!(Reference::by_key("chaussonnet-2015").unwrap().short(), "Chaussonnet et al. (2015)");
        assert!(Reference::by_key("scene").is_none());
    }
}
