//! Pages: whole, small, safe, complete and the same every time; and the figures that they show.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::record::{Report, Verdict};
use remainder::report::figure::{Dash, Figure, Mark, figures, ladders};
use remainder::report::html::{IndexEntry, Links, MOST_BYTES, index_page, page};
use remainder::report::svg;
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const LINKS: Links<'static> = Links { index: Some("../index.html"), json: Some("report.json") };

/// The committed reports with their folders.
fn committed() -> Vec<(PathBuf, Report)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports");
    let mut folders: Vec<PathBuf> = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let read = |folder: PathBuf| {
        let bytes = fs::read(folder.join("report.json")).ok()?;
        Some((folder, serde_json::from_slice(&bytes).unwrap()))
    };
    let all: Vec<(PathBuf, Report)> = folders.into_iter().filter_map(read).collect();
    assert!(all.len() >= 9, "only {} reports were found", all.len());
    all
}

fn parsed(text: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).unwrap_or_else(|error| panic!("no XML: {error}"))
}

fn elements<'a, 'input>(
    document: &'a Document<'input>,
    name: &'a str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    document.descendants().filter(move |node| node.tag_name().name() == name)
}

/// Nothing is loaded, nothing runs, every anchor leads somewhere, no id comes twice.
fn assert_self_contained(document: &Document<'_>) {
    let mut ids = BTreeSet::new();
    for node in document.descendants() {
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            assert!(!name.starts_with("on"), "a handler {name}");
            assert!(name != "src" && name != "srcset", "{value} would be loaded");
            if name == "id" {
                assert!(ids.insert(value), "{value} is the id of two elements");
            }
        }
    }
    for name in ["script", "link", "img", "iframe", "object", "embed", "base", "form", "use", "image"] {
        assert_eq!(elements(document, name).count(), 0, "there is a <{name}>");
    }
    for anchor in elements(document, "a") {
        let href = anchor.attribute("href").unwrap();
        match href.strip_prefix('#') {
            Some(id) => assert!(ids.contains(id), "{href} leads nowhere"),
            None => assert!(
                href.starts_with("https://doi.org/") || !href.contains(':'),
                "{href} leads elsewhere than to a paper or a neighbour"
            ),
        }
    }
    for style in elements(document, "style") {
        let text = style.text().unwrap();
        assert!(!text.contains("url(") && !text.contains("@import"), "a style sheet loads something");
    }
}

#[test]
fn every_committed_report_has_a_whole_and_small_page_of_its_own() {
    for (folder, report) in committed() {
        let name = folder.display();
        let text = page(&report, LINKS);
        assert_eq!(text, page(&report, LINKS), "{name}: two renderings differ");
        assert!(text.len() <= MOST_BYTES, "{name}: {} bytes", text.len());
        let document = parsed(&text);
        assert_self_contained(&document);
        for word in ["NaN", "inf<", "infinity", ">null<"] {
            assert!(!text.contains(word), "{name}: {word} is shown");
        }
        let claims: BTreeSet<&str> =
            elements(&document, "details").filter_map(|d| d.attribute("id")).collect();
        let known: BTreeSet<&str> = report.verdicts.iter().map(|rolled| rolled.id.as_str()).collect();
        assert_eq!(claims, known, "{name}: claims of the page and of the report");
        let cases = elements(&document, "details").filter(|d| d.attribute("class") == Some("case")).count();
        assert_eq!(cases, report.claims.len(), "{name}: cases");
        for series in report.series.iter().filter(|series| series.figure.is_some()) {
            let number = series.figure.as_deref().unwrap().trim_start_matches("Fig. ");
            let caption = format!("Fig. {number} of the paper");
            let shown =
                elements(&document, "title").any(|title| title.text().unwrap_or("").starts_with(&caption));
            assert!(shown, "{name}: no figure '{caption}'");
        }
        let committed = fs::read_to_string(folder.join("report.html"))
            .unwrap_or_else(|error| panic!("{name}/report.html: {error}; `just pages` makes it"));
        assert!(text == committed, "{name}/report.html is not what the report gives; `just pages` makes it");
    }
}

#[test]
fn the_index_names_every_analysis() {
    let entry = |(folder, report): &(PathBuf, Report)| {
        let name = folder.file_name().unwrap().to_string_lossy();
        IndexEntry::of(report, format!("{name}/report.html"))
    };
    let all = committed();
    let entries: Vec<IndexEntry> = all.iter().map(entry).collect();
    let text = index_page(&entries);
    let document = parsed(&text);
    assert_self_contained(&document);
    let links: Vec<&str> = elements(&document, "a").filter_map(|a| a.attribute("href")).collect();
    assert_eq!(links, entries.iter().map(|entry| entry.href.as_str()).collect::<Vec<_>>());
    let committed = all[0].0.with_file_name("index.html");
    assert!(text == fs::read_to_string(committed).unwrap(), "the index is old; `just pages` makes it");
}

#[test]
fn figures_have_names_of_their_own_and_stand_as_files() {
    for (folder, report) in committed() {
        let all = figures(&report);
        let mut stems = BTreeSet::new();
        for figure in &all {
            let stem = figure.file_stem();
            assert!(stems.insert(stem.to_lowercase()), "{}: two figures are {stem}", folder.display());
        }
        // A sample of each report is enough to see that files are whole.
        for figure in all.iter().step_by(all.len() / 12 + 1) {
            let file = svg::standalone(figure);
            let document = parsed(&file);
            assert_self_contained(&document);
            assert!(!file.contains("var(") && !file.contains("NaN"), "{}", figure.id);
            assert!(document.root_element().attribute("width").is_some(), "{}", figure.id);
        }
    }
}

/// The triangle, the published line and the hollow points of a ladder are those of its claim and its fit.
#[test]
fn a_ladder_shows_what_its_claim_and_its_fit_say() {
    let (_, report) = committed().into_iter().find(|(folder, _)| folder.ends_with("fatehi-table-2")).unwrap();
    let mut hollow = 0;
    for ladder in ladders(&report) {
        let (fit, Figure { layers, .. }) = (&report.fits[ladder.fit], ladder.figure);
        let entry = &report.claims[*ladder.claims.first().unwrap()];
        let of = |column: &Option<remainder::record::Column>| {
            let exponents = column.as_ref()?.exponents.clone()?;
            if fit.varies == "displacement" { exponents.displacement } else { exponents.dx_over_h }
        };
        let label = |estimate: remainder::record::Estimate| match estimate.value {
            remainder::record::Number::Rational(text) => text.replace('-', "−"),
            remainder::record::Number::Float(value) => panic!("{value} should be exact"),
        };
        let triangles: Vec<String> = layers
            .iter()
            .filter_map(|layer| match &layer.mark {
                Mark::Slope { label, .. } => Some(label.clone()),
                _ => None,
            })
            .collect();
        assert_eq!(triangles, of(&entry.derived).map(label).into_iter().collect::<Vec<_>>(), "{}", fit.id);
        let published = of(&entry.published).map(label).unwrap();
        let dashed = layers.iter().find(|layer| matches!(layer.mark, Mark::Line { dash: Dash::Dashed, .. }));
        assert_eq!(dashed.unwrap().name.as_deref(), Some(format!("published slope {published}").as_str()));
        for layer in &layers {
            if let Mark::Points { points, hollow: true } = &layer.mark {
                assert_eq!(points.len(), fit.points.iter().filter(|point| !point.kept).count());
                hollow += points.len();
            }
        }
    }
    assert!(hollow > 0, "no point left out was drawn");
}

#[test]
fn text_of_a_report_is_never_markup() {
    let (_, mut report) =
        committed().into_iter().find(|(folder, _)| folder.ends_with("fatehi-heat")).unwrap();
    let hostile = "<script>alert(1)</script> & \"quoted\" ]]> \u{1} 'x'";
    report.provenance.title = hostile.into();
    report.provenance.scene = hostile.into();
    for entry in &mut report.claims {
        entry.statement = hostile.into();
        entry.why = hostile.into();
        entry.citation.location = hostile.into();
        entry.case.kernel = hostile.into();
        entry.case.more.insert(hostile.into(), hostile.into());
    }
    for series in &mut report.series {
        series.x.name = hostile.into();
        series.lines.iter_mut().for_each(|line| line.name = hostile.into());
    }
    for rows in report.tables.values_mut() {
        rows.iter_mut().for_each(|row| {
            row.insert(hostile.into(), hostile.into());
        });
    }
    report.left_out.push(remainder::record::LeftOut {
        what: hostile.into(),
        why: hostile.into(),
        saved: None,
    });
    let text = page(&report, LINKS);
    assert_self_contained(&parsed(&text));
}

#[test]
fn a_report_of_nothing_has_a_page() {
    let text = page(&Report::default(), Links::default());
    assert_self_contained(&parsed(&text));
    assert_eq!(
        elements(&parsed(&text), "a").filter(|a| a.attribute("href") == Some("report.json")).count(),
        0
    );
}

#[test]
fn a_verdict_is_a_word_as_well_as_a_colour() {
    let (_, report) = committed().into_iter().find(|(folder, _)| folder.ends_with("fatehi-table-3")).unwrap();
    let text = page(&report, LINKS);
    let document = parsed(&text);
    let badges: Vec<Node<'_, '_>> = elements(&document, "span")
        .filter(|span| span.attribute("class").is_some_and(|class| class.starts_with("v ")))
        .collect();
    assert_eq!(badges.len(), report.claims.len() + report.verdicts.len());
    for badge in &badges {
        assert_eq!(badge.attribute("class"), Some(format!("v {}", badge.text().unwrap()).as_str()));
    }
    let refuted = badges.iter().filter(|badge| badge.text() == Some("refuted")).count();
    let known = report.claims.iter().filter(|entry| entry.verdict == Verdict::Refuted).count()
        + report.verdicts.iter().filter(|rolled| rolled.verdict == Verdict::Refuted).count();
    assert_eq!(refuted, known);
}
