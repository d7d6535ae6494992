//! The options of a disorder, `key=value`.

use crate::names::nearest;
use std::collections::BTreeMap;
use std::fmt;

/// Options as written, each key known to the model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options(BTreeMap<String, String>);

impl Options {
    /// Reads `key=value` parts.
    pub(super) fn parse<'a>(
        parts: impl Iterator<Item = &'a str>,
        model: &str,
        known: &[&str],
    ) -> Result<Self, String> {
        let mut options = BTreeMap::new();
        for part in parts {
            let (key, value) = part
                .split_once('=')
                .map(|(key, value)| (key.trim(), value.trim()))
                .ok_or_else(|| format!("has an option '{part}' that is no key=value"))?;
            if !known.contains(&key) {
                let hint = nearest(key, known).map(|k| format!(" (did you mean '{k}'?)")).unwrap_or_default();
                let known = if known.is_empty() {
                    "it takes none".to_owned()
                } else {
                    format!("it knows {}", known.join(", "))
                };
                return Err(format!(
                    "has an option '{key}' that model '{model}' does not know{hint}: {known}"
                ));
            }
            if options.insert(key.to_owned(), value.to_owned()).is_some() {
                return Err(format!("has the option '{key}' twice"));
            }
        }
        Ok(Self(options))
    }

    /// Whether the scene says something of this key.
    pub fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    /// Which of the `known` values a key has; the first of them if the scene says nothing.
    ///
    /// # Errors
    /// A value that is not among them, in words.
    pub fn choice(&self, key: &str, known: &[&'static str]) -> Result<usize, String> {
        let Some(value) = self.0.get(key) else { return Ok(0) };
        known.iter().position(|candidate| candidate == value).ok_or_else(|| {
            let hint = nearest(value, known).map(|k| format!(" (did you mean '{k}'?)")).unwrap_or_default();
            format!("has {key} '{value}'{hint}; it is one of {}", known.join(", "))
        })
    }

    /// A positive finite number; `None` if the scene says nothing.
    ///
    /// # Errors
    /// A value that is none, in words.
    pub fn positive(&self, key: &str) -> Result<Option<f64>, String> {
        let Some(value) = self.0.get(key) else { return Ok(None) };
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() && number > 0.0 => Ok(Some(number)),
            _ => Err(format!("has {key} '{value}', which must be a positive number")),
        }
    }
}

impl fmt::Display for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|(key, value)| write!(f, ",{key}={value}"))
    }
}
