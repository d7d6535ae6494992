//! Reading a scene of any kind.

use super::scene::{KINDS, Scene, parse};
use super::source::{SceneError, SceneText};
use super::survey::SurveyScene;
use serde::Deserialize;
use std::path::Path;

/// A scene of one of the kinds there are.
pub enum Analysis {
    /// Orders of moment sums and of operators' coefficients, by ladders.
    Orders(Box<Scene>),
    /// Anything else.
    Survey(SurveyScene),
}

impl Analysis {
    /// Reads a scene from a file, or from `scene.toml` or `scene.json` in a folder.
    ///
    /// # Errors
    /// [`SceneError`] with line and column where there is one.
    pub fn read(path: &Path, quick: bool) -> Result<Self, SceneError> {
        let (text, name) = SceneText::open(path)?;
        #[derive(Deserialize)]
        struct Head {
            #[serde(default)]
            study: Study,
        }
        #[derive(Default, Deserialize)]
        struct Study {
            kind: Option<String>,
        }
        let head: Head = parse(&text)?;
        let kind = head.study.kind.as_deref().unwrap_or(KINDS[0]);
        match SurveyScene::from_text(&text, &name, kind, quick, KINDS)? {
            Some(survey) => Ok(Self::Survey(survey)),
            None => Ok(Self::Orders(Box::new(Scene::from_text(&text, &name, quick)?))),
        }
    }

    /// Name: that of its folder, or of its file.
    pub fn name(&self) -> &str {
        match self {
            Self::Orders(scene) => &scene.name,
            Self::Survey(scene) => &scene.name,
        }
    }
}
