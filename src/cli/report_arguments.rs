//! The arguments of what is done with reports, and of what helps to begin.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct NewArguments {
    /// Name of the analysis: analyses/NAME/scene.toml is written
    #[arg(default_value = "mine")]
    pub(super) name: String,
    /// What it studies
    #[arg(long, value_enum, default_value = "moment-orders")]
    pub(super) kind: SceneKind,
}

/// What a new scene studies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SceneKind {
    /// Orders of moment sums
    MomentOrders,
    /// Orders of the coefficients of operators' expansions
    OperatorOrders,
    /// Heat conduction in time
    Heat,
    /// Spectra of assembled Laplacians
    Stiff,
    /// Error against cost, operator by operator
    WorkPrecision,
    /// Digits lost in extreme cases
    Extremes,
    /// Viscous models, corrections and walls, as Basa et al.
    Basa,
    /// Consistency, gradients and Laplacians on disordered particles, as Chaussonnet et al.
    Chaussonnet,
}

#[derive(Debug, Args)]
pub(super) struct ExplainArguments {
    /// A claim's id, or what several share before the `/`
    #[arg(value_name = "CLAIM")]
    pub(super) claim: String,
    /// Folder of reports, whose evidence is told
    #[arg(long, value_name = "DIR", default_value = "reports")]
    pub(super) reports: PathBuf,
    /// Every case of every report, not the first few
    #[arg(long)]
    pub(super) all: bool,
    /// Print JSON, with every case
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct CompletionArguments {
    /// Which shell
    #[arg(value_enum)]
    pub(super) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Write remainder.1 and a page for each command to this folder
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
}

/// Other forms of a report.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct ViewArguments {
    /// Write every table, fit and series as comma-separated values to DIR/NAME
    #[arg(long, value_name = "DIR")]
    pub(super) csv: Option<PathBuf>,
    /// Write the verdicts as JUnit XML, for continuous integration
    #[arg(long, value_name = "FILE")]
    pub(super) junit: Option<PathBuf>,
    /// Write tables, figures, equations and the literature for LaTeX to DIR
    #[arg(long, value_name = "DIR")]
    pub(super) latex: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// Folders with a report.json, such files, or folders of such folders
    #[arg(required = true, value_name = "REPORT")]
    pub(super) reports: Vec<PathBuf>,
    /// Print the record as JSON, several as a list
    #[arg(long)]
    pub(super) json: bool,
    /// Write a page for each, report.html
    #[arg(long)]
    pub(super) html: bool,
    /// Write every figure as an SVG file to a folder of the report's name under this one
    #[arg(long, value_name = "DIR")]
    pub(super) figures: Option<PathBuf>,
    /// Folder of the pages and their index [default: each page beside its report]
    #[arg(long, value_name = "DIR", requires = "html")]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) views: ViewArguments,
}

#[derive(Debug, Args)]
pub(super) struct DiffArguments {
    /// The first report: a folder that holds report.json, or such a file
    #[arg(value_name = "A")]
    pub(super) before: PathBuf,
    /// The second report
    #[arg(value_name = "B")]
    pub(super) after: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct ReferenceArguments {
    /// Folder of the pages
    #[arg(value_name = "DIR")]
    pub(super) out: PathBuf,
}
