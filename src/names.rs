//! The nearest known name, for error messages.

/// The known name most like `given`, if any is close enough to be what was meant.
///
/// # Examples
/// ```
/// assert_eq!(remainder::names::nearest("wendlandc2", &["cubic-spline", "wendland-c2"]), Some("wendland-c2".into()));
/// assert_eq!(remainder::names::nearest("xyz", &["cubic-spline"]), None);
/// ```
pub fn nearest(given: &str, known: &[&str]) -> Option<String> {
    known
        .iter()
        .map(|name| (strsim::jaro_winkler(&given.to_lowercase(), &name.to_lowercase()), *name))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name.to_owned())
}
