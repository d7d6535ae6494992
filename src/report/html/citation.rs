//! Citations in HTML.

use super::text::rich;
use crate::claim::{Paper, literature};
use crate::report::rich::escaped;
use std::sync::LazyLock;

static PAPERS: LazyLock<Vec<Paper>> = LazyLock::new(|| literature().unwrap_or_default());

/// The paper of this key.
pub(super) fn paper(key: &str) -> Option<&'static Paper> {
    PAPERS.iter().find(|paper| paper.key == key)
}

/// The whole entry.
pub(super) fn cited(paper: &Paper) -> String {
    let [volume, number, address, pages] =
        paper.found_at.each_ref().map(|text| escaped(&text.replace("--", "–")));
    let mut place = escaped(&paper.published_in);
    if !volume.is_empty() {
        place += &format!(" {volume}");
    }
    if !number.is_empty() {
        place += &format!(" ({number})");
    }
    let title = format!("<cite>{}</cite>", rich(&paper.title));
    let parts = [escaped(&paper.full_names.join("; ")), title, place, address, pages, escaped(&paper.year)];
    let text = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    let link = paper.doi.as_ref().map(|doi| {
        let doi = escaped(doi);
        format!(", <a href=\"https://doi.org/{doi}\">doi:{doi}</a>")
    });
    format!("{text}{}.", link.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_are_cited_whole() {
        let fatehi = cited(paper("fatehi-manzari-2011").unwrap());
        assert!(fatehi.starts_with("Fatehi, R.; Manzari, M. T., <cite>Error estimation"), "{fatehi}");
        assert!(
            fatehi.contains("61 (2), 482–498, 2011") && fatehi.contains("Computers &amp; Math"),
            "{fatehi}"
        );
        let chaussonnet = cited(paper("chaussonnet-2015").unwrap());
        assert!(
            chaussonnet.contains("Bauer, Hans-Jörg") && chaussonnet.contains("on SPH operator"),
            "{chaussonnet}"
        );
        assert!(paper("scene").is_none());
    }
}
