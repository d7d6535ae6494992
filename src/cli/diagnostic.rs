//! Errors as rustc prints them: what, where in the scene, what to do.

use super::exit::Failure;
use crate::study::SceneError;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::io::IsTerminal as _;

/// Prints a failure on standard error.
pub(super) fn print(failure: &Failure) {
    let text = match failure {
        Failure::Scene(error) | Failure::Study(crate::study::StudyError::Scene(error)) => scene(error),
        other => format!("error: {other}"),
    };
    eprintln!("{text}");
}

fn scene(error: &SceneError) -> String {
    let path = error.path().display().to_string();
    let styled = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
    let title = Level::ERROR.primary_title(error.message.as_str());
    let mut group = match &error.span {
        Some(span) => {
            // An empty span at the end of the text still points somewhere.
            let end = span.end.max(span.start + 1).min(error.scene.text.len());
            let start = span.start.min(end);
            let snippet = Snippet::source(error.scene.text.as_str())
                .path(path.as_str())
                .annotation(AnnotationKind::Primary.span(start..end));
            title.element(snippet)
        }
        None => title.element(annotate_snippets::Origin::path(path.as_str())),
    };
    if let Some(help) = &error.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}
