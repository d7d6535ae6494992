//! The text of a scene and the place of each of its keys, so that an error can point at line and column.

use jsonc_parser::ast::Value;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// A scene's text as read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneText {
    /// The file it came from.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

/// What is wrong with a scene, where, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneError {
    /// The scene.
    pub scene: SceneText,
    /// Byte range of the place in its text, if there is one.
    pub span: Option<Range<usize>>,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

impl SceneText {
    /// Reads a scene's text from a file, or from `scene.toml` or `scene.json` in a folder, and its name: that of its folder,
    /// or of its file.
    ///
    /// # Errors
    /// [`SceneError`] if there is no such file, or it is not text.
    pub fn open(path: &Path) -> Result<(Self, String), SceneError> {
        let file = match path.is_dir() {
            true => {
                ["scene.toml", "scene.json"].map(|name| path.join(name)).into_iter().find(|p| p.is_file())
            }
            false => Some(path.to_owned()),
        };
        let nowhere = Self { path: path.to_owned(), text: String::new() };
        let file =
            file.ok_or_else(|| nowhere.error("this folder holds neither scene.toml nor scene.json"))?;
        let text = std::fs::read_to_string(&file).map_err(|error| {
            nowhere.error(format!(
                "cannot be read as a scene ({error}): give a scene file, or a folder with scene.toml"
            ))
        })?;
        let named = if file.file_stem().is_some_and(|stem| stem == "scene") {
            file.canonicalize().ok().and_then(|full| full.parent().map(Path::to_owned))
        } else {
            Some(file.with_extension(""))
        };
        let name = named.as_deref().and_then(Path::file_name).and_then(|n| n.to_str());
        let name = name.unwrap_or("scene").to_owned();
        Ok((Self { path: file, text }, name))
    }

    /// Whether the text is JSON (by its file's ending); TOML otherwise.
    pub fn is_json(&self) -> bool {
        self.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
    }

    /// An error at the value of this path of keys, such as `cases.kernels.0`.
    pub fn error_at(&self, keys: &str, message: impl Into<String>, help: Option<&str>) -> SceneError {
        let keys: Vec<&str> = keys.split('.').filter(|key| !key.is_empty()).collect();
        let span = if self.is_json() { self.find_json(&keys) } else { self.find_toml(&keys) };
        SceneError { scene: self.clone(), span, message: message.into(), help: help.map(str::to_owned) }
    }

    /// An error without a place.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError { scene: self.clone(), span: None, message: message.into(), help: None }
    }

    /// The place of a path of keys, or of the longest part of it that exists.
    fn find_toml(&self, keys: &[&str]) -> Option<Range<usize>> {
        let root = DeTable::parse(&self.text).ok()?;
        let mut table: Option<&DeTable<'_>> = Some(root.get_ref());
        let mut list = None;
        let mut span = None;
        for key in keys {
            let found = match (table, list) {
                (Some(table), _) => {
                    table.iter().find(|(k, _)| k.get_ref().as_ref() == *key).map(|(_, value)| value)
                }
                (_, Some(list)) => key.parse::<usize>().ok().and_then(|index| {
                    let list: &toml::de::DeArray<'_> = list;
                    list.get(index)
                }),
                _ => None,
            };
            let Some(value) = found else { break };
            span = Some(value.span());
            (table, list) = match value.get_ref() {
                DeValue::Table(inner) => (Some(inner), None),
                DeValue::Array(inner) => (None, Some(inner)),
                _ => (None, None),
            };
        }
        span
    }

    fn find_json(&self, keys: &[&str]) -> Option<Range<usize>> {
        let parsed = jsonc_parser::parse_to_ast(&self.text, &Default::default(), &Default::default()).ok()?;
        let mut value = parsed.value?;
        let mut span = None;
        for key in keys {
            let inner = match value {
                Value::Object(mut object) => {
                    let index = object.properties.iter().position(|property| property.name.as_str() == *key);
                    index.map(|index| object.properties.swap_remove(index).value)
                }
                Value::Array(mut array) => {
                    let index = key.parse::<usize>().ok().filter(|index| *index < array.elements.len());
                    index.map(|index| array.elements.swap_remove(index))
                }
                _ => None,
            };
            let Some(inner) = inner else { break };
            let range = jsonc_parser::common::Ranged::range(&inner);
            span = Some(range.start..range.end);
            value = inner;
        }
        span
    }
}

impl SceneError {
    /// Line and column of the place, from 1.
    pub fn line_and_column(&self) -> Option<(usize, usize)> {
        let start = self.span.as_ref()?.start.min(self.scene.text.len());
        let before = &self.scene.text[..start];
        let line_start = before.rfind('\n').map_or(0, |index| index + 1);
        Some((before.matches('\n').count() + 1, before[line_start..].chars().count() + 1))
    }

    /// The file it is about.
    pub fn path(&self) -> &Path {
        &self.scene.path
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scene.path.display())?;
        if let Some((line, column)) = self.line_and_column() {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", self.message)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for SceneError {}
