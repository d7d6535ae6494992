//! The literature that claims cite, read from `references.bib`.

use biblatex::{Bibliography, ChunksExt as _, ParseError, RawBibliography};
use schemars::JsonSchema;
use serde::Serialize;

/// `references.bib` as it stands.
const SOURCE: &str = include_str!("../../references.bib");

/// A paper.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Paper {
    /// Its key in `references.bib`.
    pub key: String,
    /// Family names of the authors.
    pub authors: Vec<String>,
    /// Their names in full, `Family, Given`.
    #[serde(skip)]
    pub full_names: Vec<String>,
    /// Its title.
    pub title: String,
    /// Journal or proceedings.
    pub published_in: String,
    /// Volume, number, place and pages, each empty where there is none.
    #[serde(skip)]
    pub found_at: [String; 4],
    /// Year.
    pub year: String,
    /// Digital object identifier, without a resolver.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub doi: Option<String>,
    /// The entry as `references.bib` has it.
    pub bibtex: String,
}

/// All papers of `references.bib`, in its order.
///
/// # Errors
/// [`ParseError`] if it is no BibTeX, which a test excludes.
///
/// # Examples
/// ```
/// let papers = remainder::claim::literature()?;
/// let basa = papers.iter().find(|paper| paper.key == "basa-quinlan-lastiwka-2009").unwrap();
/// assert_eq!((basa.authors.as_slice(), basa.year.as_str()), (["Basa", "Quinlan", "Lastiwka"].map(String::from).as_slice(), "2009"));
/// # Ok::<(), biblatex::ParseError>(())
/// ```
pub fn literature() -> Result<Vec<Paper>, ParseError> {
    let raw = RawBibliography::parse(SOURCE)?;
    let read = Bibliography::parse(SOURCE)?;
    let papers = raw.entries.iter().filter_map(|entry| {
        let found = read.get(entry.v.key.v)?;
        let field = |names: &[&str]| {
            let chunks = names.iter().find_map(|name| found.get(name));
            chunks.map(|chunks| chunks.format_verbatim()).unwrap_or_default()
        };
        // The span ends before the brace that closes the entry.
        let rest = &SOURCE[entry.span.start..];
        let end = rest[entry.span.len()..].find('}').map_or(rest.len(), |brace| entry.span.len() + brace + 1);
        let doi = field(&["doi"]);
        let people = found.author().unwrap_or_default();
        Some(Paper {
            key: entry.v.key.v.to_owned(),
            full_names: people.iter().map(|p| format!("{}, {}", p.name, p.given_name)).collect(),
            found_at: [&["volume"][..], &["number"], &["location", "address"], &["pages"]].map(field),
            authors: people.into_iter().map(|person| person.name).collect(),
            title: field(&["title"]),
            published_in: field(&["journaltitle", "journal", "booktitle"]),
            year: field(&["year", "date"]),
            doi: (!doi.is_empty()).then_some(doi),
            bibtex: rest[..end].trim_end().to_owned(),
        })
    });
    Ok(papers.collect())
}

impl Paper {
    /// `Basa, Quinlan & Lastiwka (2009)`.
    pub fn short(&self) -> String {
        let authors = match self.authors.as_slice() {
            [] => self.key.clone(),
            [one] => one.clone(),
            [first, second] => format!("{first} & {second}"),
            [first, second, third] => format!("{first}, {second} & {third}"),
            [first, ..] => format!("{first} et al."),
        };
        format!("{authors} ({})", self.year)
    }
}

#[cfg(test)]
mod tests {
    use super::{SOURCE, literature};

    #[test]
    fn every_entry_is_read_whole() {
        let papers = literature().expect("BibTeX");
        assert_eq!(papers.len(), SOURCE.matches("\n@").count());
        for paper in &papers {
            assert!(paper.bibtex.starts_with('@') && paper.bibtex.ends_with("\n}"), "{}", paper.bibtex);
            assert_eq!(paper.bibtex.matches('@').count(), 1, "{}", paper.bibtex);
            assert!(paper.bibtex.contains(&format!("{{{},", paper.key)), "{}", paper.bibtex);
            assert_eq!(paper.year.len(), 4, "{paper:?}");
            assert!(!paper.authors.is_empty() && !paper.title.is_empty() && !paper.published_in.is_empty());
        }
        let chaussonnet = papers.iter().find(|paper| paper.key == "chaussonnet-2015").expect("there");
        assert_eq!(chaussonnet.short(), "Chaussonnet et al. (2015)");
        assert!(chaussonnet.bibtex.contains("J{\\\"o}rg"), "{}", chaussonnet.bibtex);
    }
}
