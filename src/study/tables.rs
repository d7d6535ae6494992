//! The tables of a scene as written: what TOML and JSON are read into, and what `remainder schema scene` describes.

use super::define_lattice::OwnLattice;
use crate::claim::Verdict;
use crate::kernel::KernelDefinition;
use crate::particles::VolumeRule;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A scene as written. Everything but `cases` has defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawScene {
    /// What kind of study, its title and seed.
    #[serde(default)]
    pub study: StudyTable,
    /// What to place: one `[cases]`, or several `[[cases]]`.
    pub cases: CaseTables,
    /// What the scene adds to the catalogues.
    #[serde(default, skip_serializing_if = "DefineTable::is_empty")]
    pub define: DefineTable,
    /// What to check.
    #[serde(default)]
    pub claims: ClaimsTable,
    /// How far to vary Δ/h and d̃; defaults by dimension.
    #[serde(default)]
    pub ladders: LaddersTable,
    /// How many samples of disorder.
    #[serde(default)]
    pub samples: SamplesTable,
    /// How columns are compared.
    #[serde(default)]
    pub comparison: ComparisonTable,
    /// What is admitted.
    #[serde(default)]
    pub limits: LimitsTable,
    /// The verdict expected of each claim; exit code 1 if another comes out.
    #[serde(default)]
    pub expect: BTreeMap<String, Verdict>,
}

/// `[study]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StudyTable {
    /// `moment-orders`: exponents of moment sums; `operator-orders`: of the coefficients of operators' expansions. A scene
    /// of either kind may hold claims of both.
    pub kind: String,
    /// A title for the report.
    pub title: String,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for StudyTable {
    fn default() -> Self {
        Self { kind: "moment-orders".into(), title: String::new(), seed: 1 }
    }
}

/// `[define]`: entries of one's own, named by their ids in `[cases]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DefineTable {
    /// `[[define.kernel]]`
    pub kernel: Vec<KernelDefinition>,
    /// `[[define.lattice]]`
    pub lattice: Vec<OwnLattice>,
}

impl DefineTable {
    /// Whether the scene adds nothing.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// One `[cases]`, or several `[[cases]]`: the cases of all of them, each once.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseTables {
    /// The tables.
    pub tables: Vec<CasesTable>,
    /// Whether they were written as a list.
    pub listed: bool,
}

impl CaseTables {
    /// The path of keys of a field of a table.
    pub(super) fn place(&self, table: usize, field: &str) -> String {
        if self.listed { format!("cases.{table}.{field}") } else { format!("cases.{field}") }
    }
}

impl Serialize for CaseTables {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self.listed, self.tables.first()) {
            (false, Some(table)) => table.serialize(serializer),
            _ => self.tables.serialize(serializer),
        }
    }
}

// By hand, not untagged: an error in a table keeps its own words and its place.
impl<'de> Deserialize<'de> for CaseTables {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;
        impl<'de> Visitor<'de> for OneOrMany {
            type Value = CaseTables;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("a table [cases], or several [[cases]]")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<CaseTables, A::Error> {
                let table = CasesTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(CaseTables { tables: vec![table], listed: false })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<CaseTables, A::Error> {
                let tables = Vec::deserialize(SeqAccessDeserializer::new(list))?;
                Ok(CaseTables { tables, listed: true })
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}

impl JsonSchema for CaseTables {
    fn schema_name() -> Cow<'static, str> {
        "CaseTables".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<CasesTable>();
        let many = generator.subschema_for::<Vec<CasesTable>>();
        json_schema!({ "anyOf": [one, many] })
    }
}

/// `[cases]`: every combination is a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CasesTable {
    /// Ids of kernels.
    pub kernels: Vec<String>,
    /// Ids of lattices; they bring their dimension with them.
    pub lattices: Vec<String>,
    /// `MODEL:AMPLITUDE`; the amplitude holds at the finest rung of a Δ/h ladder and is the largest of a d̃ ladder.
    #[serde(default)]
    pub disorders: Vec<String>,
    /// `constant`, `number-density`.
    #[serde(default = "constant_volumes")]
    pub volume_rules: Vec<String>,
}

fn constant_volumes() -> Vec<String> {
    vec![VolumeRule::Constant.id().into()]
}

/// `[claims]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ClaimsTable {
    /// Ids of claims, or groups of them (`fatehi-table-2`).
    #[serde(rename = "use")]
    pub chosen: Vec<String>,
    /// Claims of one's own.
    pub own: Vec<OwnClaim>,
}

impl Default for ClaimsTable {
    fn default() -> Self {
        Self { chosen: vec!["fatehi-table-2".into()], own: Vec::new() }
    }
}

/// `[[claims.own]]`: the quantity is of the order d̃^displacement h^h (Δ/h)^dx_over_h.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OwnClaim {
    /// A name; it appears as `own/NAME`.
    pub name: String,
    /// A moment sum: `sum_dw`, `b_inverse`, …; or `operator` and `order` in its place.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub moment: String,
    /// An operator, by its id or as text in the language.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    /// m: the claim is about what the operator's expansion multiplies ∇^m u by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u8>,
    /// `regular-value`, `regular-deviation` or `disorder-deviation`.
    pub quantity: String,
    /// Exponent of d̃, a rational in beta.
    #[serde(default = "zero_text")]
    pub displacement: String,
    /// Exponent of h.
    #[serde(default = "zero_text")]
    pub h: String,
    /// Exponent of Δ/h.
    pub dx_over_h: String,
}

fn zero_text() -> String {
    "0".into()
}

/// `[ladders]`: entries for single dimensions; a dimension without one has the default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LaddersTable {
    /// Δ/h on regular particles, by exact sums.
    pub regular: Vec<DxLadder>,
    /// Δ/h on disordered particles, d̃ and h held.
    pub disorder: Vec<DxLadder>,
    /// d̃ at one Δ/h.
    pub displacement: Vec<DisplacementLadder>,
}

/// A ladder in Δ/h: whole R/Δ in geometric steps, each with offsets over one spacing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DxLadder {
    /// D.
    pub dimension: u8,
    /// Smallest R/Δ.
    pub from: u32,
    /// Largest R/Δ.
    pub to: u32,
    /// How many rungs.
    pub rungs: u32,
    /// Offsets of R/Δ per spacing over which the envelope is taken; they span one spacing of h/Δ.
    pub offsets: u32,
}

/// A ladder in d̃: from the scene's amplitude down in factors of two.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementLadder {
    /// D.
    pub dimension: u8,
    /// R/Δ at which it stands.
    pub support_over_dx: f64,
    /// How many rungs.
    pub rungs: u32,
}

/// `[samples]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SamplesTable {
    /// Samples in a block: what is stored at once.
    pub block: u64,
    /// The relative standard error of every root mean square at which sampling stops.
    pub precision: f64,
    /// The most blocks.
    pub most_blocks: u64,
}

impl Default for SamplesTable {
    fn default() -> Self {
        Self { block: 64, precision: 0.02, most_blocks: 32 }
    }
}

/// `[comparison]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ComparisonTable {
    /// Margin of the equivalence test of exponents.
    pub margin: f64,
}

impl Default for ComparisonTable {
    fn default() -> Self {
        Self { margin: 0.25 }
    }
}

/// `[limits]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LimitsTable {
    /// Admit disorder under which neighbours can meet; affected cases become `inconclusive` instead of numbers.
    pub allow_degenerate: bool,
    /// Memory that one task may take.
    pub memory_mib: u64,
    /// The pairs that the study may take, as `remainder plan` estimates them; none is no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_pairs: Option<u64>,
}

impl Default for LimitsTable {
    fn default() -> Self {
        Self { allow_degenerate: false, memory_mib: 2048, most_pairs: None }
    }
}
