//! Scenes of surveys: `[study]`, `[survey]` with the parameters of the kind, `[expect]`.

use super::super::scene::parse;
use super::super::source::{SceneError, SceneText};
use super::super::tables::StudyTable;
use super::Survey;
use super::chaussonnet::ChaussonnetTable;
use crate::claim::Verdict;
use crate::names::nearest;
use schemars::{JsonSchema, Schema};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The parameters of a kind of survey, all with defaults.
pub trait Parameters: Serialize + DeserializeOwned + JsonSchema + Default {
    /// The survey; `quick` shortens it for a first look.
    ///
    /// # Errors
    /// The key below `[survey]` that is wrong, and what is wrong with it.
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)>;
}

/// A kind of survey: its name in `study.kind`, how its scene is read, what its scene may hold.
struct Kind {
    id: &'static str,
    read: fn(&SceneText, &str, bool) -> Result<SurveyScene, SceneError>,
    schema: fn() -> Schema,
}

const KINDS: &[Kind] = &[
    kind::<super::basa::BasaParameters>("basa"),
    kind::<ChaussonnetTable>("chaussonnet"),
    kind::<super::extremes::Extremes>("extremes"),
    kind::<super::heat::Heat>("heat"),
    kind::<super::stiff::Stiff>("stiff"),
    kind::<super::work_precision::WorkPrecision>("work-precision"),
];

/// The names of the kinds, and the schemas of their scenes.
pub fn survey_kinds() -> impl Iterator<Item = (&'static str, Schema)> {
    KINDS.iter().map(|kind| (kind.id, (kind.schema)()))
}

/// A survey as written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawSurvey<T: Default> {
    /// What kind of study, its title and seed.
    study: StudyTable,
    /// What the survey takes.
    #[serde(default)]
    survey: T,
    /// The verdict expected of each claim; exit code 1 if another comes out.
    #[serde(default)]
    expect: BTreeMap<String, Verdict>,
}

/// A survey with its scene.
pub struct SurveyScene {
    /// Name: that of its folder, or of its file.
    pub name: String,
    /// Kind, title and seed.
    pub study: StudyTable,
    /// SHA-256 of the canonical form of the scene, in hexadecimal.
    pub sha256: String,
    /// Whether it was shortened for a first look.
    pub quick: bool,
    /// The verdicts expected.
    pub expect: BTreeMap<String, Verdict>,
    /// The survey.
    pub survey: Box<dyn Survey>,
}

impl SurveyScene {
    /// Reads the scene if its kind is one of a survey's; `None` for other kinds that exist.
    pub(in super::super) fn from_text(
        text: &SceneText,
        name: &str,
        kind: &str,
        quick: bool,
        others: &[&str],
    ) -> Result<Option<Self>, SceneError> {
        if let Some(known) = KINDS.iter().find(|known| known.id == kind) {
            return (known.read)(text, name, quick).map(Some);
        }
        if others.contains(&kind) {
            return Ok(None);
        }
        let all: Vec<&str> = others.iter().copied().chain(KINDS.iter().map(|known| known.id)).collect();
        let help = match nearest(kind, &all) {
            Some(near) => format!("write kind = \"{near}\""),
            None => format!("write one of {}", all.join(", ")),
        };
        Err(text.error_at("study.kind", format!("there is no study of kind '{kind}'"), Some(&help)))
    }
}

/// Reads a scene with the parameters `T`.
fn read<T: Parameters>(text: &SceneText, name: &str, quick: bool) -> Result<SurveyScene, SceneError> {
    let raw: RawSurvey<T> = parse(text)?;
    let canonical = serde_json::to_string(&raw).map_err(|error| text.error(error.to_string()))?;
    let sha256 = Sha256::digest(canonical.as_bytes()).iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    });
    let RawSurvey { study, survey, expect } = raw;
    let survey = survey
        .survey(study.seed, quick)
        .map_err(|(key, message)| text.error_at(&format!("survey.{key}"), message, None))?;
    let known = survey.claims();
    if let Some(id) = expect.keys().find(|id| !known.contains(id)) {
        let message = format!("expects a verdict on '{id}', which is not among the claims of this study");
        let near = nearest(id, &known.iter().map(String::as_str).collect::<Vec<_>>());
        let help = near.map(|near| format!("the nearest is '{near}'"));
        return Err(text.error_at(&format!("expect.{id}"), message, help.as_deref()));
    }
    Ok(SurveyScene { name: name.to_owned(), study, sha256, quick, expect, survey })
}

/// The kind `id` with the parameters `T`.
const fn kind<T: Parameters>(id: &'static str) -> Kind {
    Kind { id, read: read::<T>, schema: || schemars::schema_for!(RawSurvey<T>) }
}
