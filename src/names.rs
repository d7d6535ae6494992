//! The nearest known name, for error messages.

/// The known name most like `given`, if any is close enough to be what was meant.
///
/// # Examples
/// ```
/// assert_eq!(remainder::names::nearest("wendlandc2", &["cubic-spline", "wendland-c2"]), Some("wendland-c2".into()));
/// assert_eq!(remainder::names::nearest("xyz", &["cubic-spline"]), None);
/// ```
pub fn nearest(given: &str, known: &[&str]) -> Option<String> {
    alike(given, known).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name.to_owned())
}

/// The known names most like `given`, the nearest first, `most` at most.
///
/// # Examples
/// ```
/// let known = ["cubic-spline", "wendland-c2", "wendland-c4"];
/// assert_eq!(remainder::names::nearest_few("wendland-c3", &known, 2), ["wendland-c2", "wendland-c4"]);
/// ```
pub fn nearest_few(given: &str, known: &[&str], most: usize) -> Vec<String> {
    let mut found: Vec<(f64, &str)> = alike(given, known).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(most).map(|(_, name)| name.to_owned()).collect()
}

/// Names close enough to be what was meant, and how close.
fn alike<'a>(given: &str, known: &[&'a str]) -> impl Iterator<Item = (f64, &'a str)> {
    let given = given.to_lowercase();
    let likeness = move |name: &str| strsim::jaro_winkler(&given, &name.to_lowercase());
    known.iter().map(move |name| (likeness(name), *name)).filter(|(likeness, _)| *likeness > 0.75)
}
