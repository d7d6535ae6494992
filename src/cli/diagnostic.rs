//! Errors as rustc prints them: what, where in the scene, what to do.

use super::execute::note;
use super::exit::Failure;
use crate::study::SceneError;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::io::IsTerminal as _;
use std::ops::Range;

/// Prints a failure on standard error.
pub(super) fn print(failure: &Failure) {
    let text = match failure {
        Failure::Scene(error) | Failure::Study(crate::study::StudyError::Scene(error)) => scene(error),
        Failure::Operator(text, error) => {
            snippet(&error.message, text, Some(error.span.clone()), "operator", error.help.as_deref())
        }
        other => format!("error: {other}"),
    };
    note(&text);
}

fn scene(error: &SceneError) -> String {
    let path = error.path().display().to_string();
    snippet(&error.message, &error.scene.text, error.span.clone(), &path, error.help.as_deref())
}

fn snippet(message: &str, text: &str, span: Option<Range<usize>>, path: &str, help: Option<&str>) -> String {
    let styled = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
    let title = Level::ERROR.primary_title(message);
    let mut group = match span {
        Some(span) => {
            // An empty span at the end of the text still points somewhere.
            let end = span.end.max(span.start + 1).min(text.len());
            let start = span.start.min(end);
            let snippet =
                Snippet::source(text).path(path).annotation(AnnotationKind::Primary.span(start..end));
            title.element(snippet)
        }
        None => title.element(annotate_snippets::Origin::path(path)),
    };
    if let Some(help) = help {
        group = group.element(Level::HELP.message(help));
    }
    renderer.render(&[group])
}
