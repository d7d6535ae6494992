//! Verdicts as JUnit XML, for continuous integration: a suite per report, a test case per claim.
//!
//! | verdict | becomes |
//! | --- | --- |
//! | inconclusive, whatever is expected | skipped, with its reason |
//! | another than expected | a failure, with its reason |
//! | as expected, or nothing is expected | passed; its output says what was found (`refuted, as expected: …`) |
//!
//! No times: a report holds nothing that changes from run to run.

use crate::record::{Report, RolledVerdict, Verdict};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io;

/// What becomes of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    Skipped,
}

fn outcome(rolled: &RolledVerdict) -> Outcome {
    match rolled.expected {
        _ if rolled.verdict == Verdict::Inconclusive => Outcome::Skipped,
        Some(expected) if expected != rolled.verdict => Outcome::Failed,
        _ => Outcome::Passed,
    }
}

/// The reports as one document.
///
/// # Errors
/// None that writing to memory has.
pub fn junit(reports: &[Report]) -> io::Result<String> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let all = counts(reports.iter().flat_map(|report| &report.verdicts));
    let attributes = [("name", "remainder".to_owned())].into_iter().chain(all);
    let attributes: Vec<(&str, String)> = attributes.collect();
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    writer.create_element("testsuites").with_attributes(attributes).write_inner_content(|writer| {
        for report in reports {
            suite(writer, report)?;
        }
        Ok(())
    })?;
    let mut text = String::from_utf8_lossy(&writer.into_inner()).into_owned();
    text.push('\n');
    Ok(text)
}

fn counts<'a>(verdicts: impl Iterator<Item = &'a RolledVerdict> + Clone) -> [(&'static str, String); 4] {
    let count = |which| verdicts.clone().filter(|rolled| outcome(rolled) == which).count().to_string();
    [
        ("tests", verdicts.clone().count().to_string()),
        ("failures", count(Outcome::Failed)),
        ("errors", "0".to_owned()),
        ("skipped", count(Outcome::Skipped)),
    ]
}

fn suite(writer: &mut Writer<Vec<u8>>, report: &Report) -> io::Result<()> {
    let provenance = &report.provenance;
    let properties = [
        ("title", provenance.title.clone()),
        ("version", provenance.version.clone()),
        ("scene_sha256", provenance.scene_sha256.clone()),
        ("seed", provenance.seed.to_string()),
        ("quick", provenance.quick.to_string()),
    ];
    let mut element = writer.create_element("testsuite").with_attribute(("name", provenance.scene.as_str()));
    for (name, value) in &counts(report.verdicts.iter()) {
        element = element.with_attribute((*name, value.as_str()));
    }
    element.write_inner_content(|writer| {
        writer.create_element("properties").write_inner_content(|writer| {
            for (name, value) in &properties {
                let attributes = [("name", *name), ("value", value.as_str())];
                writer.create_element("property").with_attributes(attributes).write_empty()?;
            }
            Ok(())
        })?;
        for rolled in &report.verdicts {
            case(writer, report, rolled)?;
        }
        Ok(())
    })?;
    Ok(())
}

fn case(writer: &mut Writer<Vec<u8>>, report: &Report, rolled: &RolledVerdict) -> io::Result<()> {
    let source = report.claims.iter().find(|entry| entry.id == rolled.id).map(|entry| &entry.citation.source);
    let class = format!("{}.{}", report.provenance.scene, source.map_or("scene", String::as_str));
    let attributes = [("classname", class.as_str()), ("name", rolled.id.as_str())];
    let expected = match rolled.expected {
        Some(expected) if expected == rolled.verdict => ", as expected".to_owned(),
        Some(expected) => format!(", expected {expected}"),
        None => String::new(),
    };
    let message = format!("{}{expected}: {}", rolled.verdict, rolled.why);
    let message = message.as_str();
    let element = writer.create_element("testcase").with_attributes(attributes);
    element.write_inner_content(|writer| {
        match outcome(rolled) {
            Outcome::Skipped => {
                writer.create_element("skipped").with_attribute(("message", message)).write_empty()?;
            }
            Outcome::Failed => {
                let kind = rolled.verdict.to_string();
                let attributes = [("message", message), ("type", kind.as_str())];
                let failure = writer.create_element("failure").with_attributes(attributes);
                failure.write_text_content(BytesText::new(&cases(report, rolled)))?;
            }
            Outcome::Passed => {
                writer.create_element("system-out").write_text_content(BytesText::new(message))?;
            }
        }
        Ok(())
    })?;
    Ok(())
}

/// The cases behind a verdict, a line each.
fn cases(report: &Report, rolled: &RolledVerdict) -> String {
    let sections = super::table::sections(report);
    let rows = sections.iter().filter(|section| section.id == rolled.id).flat_map(|section| &section.rows);
    rows.map(|row| format!("{} {}: {}: {}\n", row.dimension, row.case, row.verdict, row.why)).collect()
}
