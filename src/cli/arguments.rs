//! The arguments of each command.

pub(super) use super::report_arguments::{
    CompletionArguments, DiffArguments, ExplainArguments, ManArguments, NewArguments, ReferenceArguments,
    ReportArguments, SceneKind, ViewArguments,
};
use crate::study::Shard;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Truncation errors of particle operators: published, derived and measured side by side, with a verdict.
#[derive(Debug, Parser)]
#[command(name = "remainder", version, about, after_help = EXIT_CODES)]
pub struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 all verdicts as the scene expects, 1 some differ, 2 the input is wrong, \
                          3 inconclusive, 130 interrupted.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Write a commented scene to start from
    New(NewArguments),
    /// Run a scene and write its report
    Run(RunArguments),
    /// Make the report of a scene whose shards have been run
    Merge(MergeArguments),
    /// Show reports again, or write them in other forms
    Report(ReportArguments),
    /// Say what changed from one report to another, in standard errors; exit code 1 if anything did
    Diff(DiffArguments),
    /// Say what a scene would compute, and what it leaves out
    Plan(PlanArguments),
    /// Certified moment sums over a lattice, to any number of digits or in closed form
    Sums(SumsArguments),
    /// Print the JSON Schema of scenes or reports
    Schema(SchemaArguments),
    /// Audit a kernel: normalisation, smoothness, sign, inflection point, what h means elsewhere
    Kernel(KernelArguments),
    /// Expand an operator: its truncation error term by term, what vanishes and why, what it conserves
    Expand(ExpandArguments),
    /// The RMS error of an operator or a moment sum on disordered particles, without a sample
    Rms(RmsArguments),
    /// The Fourier symbol of an operator on a lattice: modified wavenumber, its error, null modes
    Symbol(SymbolArguments),
    /// Derive the orders of moment sums: exponents, amplitudes and zero crossings on a lattice, exponents under disorder
    Orders(OrdersArguments),
    /// Name the operator, kernel and R/Δ of least cost that meet a tolerance
    Advise(AdviseArguments),
    /// List what can be named in a scene
    List(ListArguments),
    /// Tell a claim's story: what is printed where, what is checked, what the reports found
    Explain(ExplainArguments),
    /// Write the reference of all names, of scenes and of reports as Markdown
    Reference(ReferenceArguments),
    /// Print completions for a shell
    Completions(CompletionArguments),
    /// Print the manual page, or write those of all commands
    Man(ManArguments),
}

#[derive(Debug, Clone, Args)]
pub(super) struct RunArguments {
    /// A scene file, or a folder with scene.toml or scene.json
    pub(super) scene: PathBuf,
    /// Folder of the report [default: reports/NAME]
    #[arg(long)]
    pub(super) out: Option<PathBuf>,
    /// Folder of finished blocks
    #[arg(long, default_value = ".remainder")]
    pub(super) store: PathBuf,
    /// A first look in seconds: shorter ladders, fewer samples
    #[arg(long)]
    pub(super) quick: bool,
    /// Compute part I of N only, for `remainder merge` to join
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    pub(super) shard: Option<Shard>,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Print the report as JSON instead of a table
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) views: ViewArguments,
    /// Write a page to look at as well, report.html, and the index of reports/
    #[arg(long)]
    pub(super) html: bool,
    /// Further folders of finished blocks to read from
    #[arg(skip)]
    pub(super) from: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct MergeArguments {
    /// The scene whose shards were run
    pub(super) scene: PathBuf,
    /// Folders of finished blocks of other shards
    pub(super) from: Vec<PathBuf>,
    /// Folder of the report [default: reports/NAME]
    #[arg(long)]
    pub(super) out: Option<PathBuf>,
    /// Folder of finished blocks
    #[arg(long, default_value = ".remainder")]
    pub(super) store: PathBuf,
    /// The shards were run with --quick
    #[arg(long)]
    pub(super) quick: bool,
    /// Print the report as JSON instead of a table
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) views: ViewArguments,
    /// Write a page to look at as well, report.html, and the index of reports/
    #[arg(long)]
    pub(super) html: bool,
}

impl MergeArguments {
    pub(super) fn as_run(&self) -> RunArguments {
        RunArguments {
            scene: self.scene.clone(),
            out: self.out.clone(),
            store: self.store.clone(),
            quick: self.quick,
            shard: None,
            threads: None,
            json: self.json,
            views: self.views.clone(),
            html: self.html,
            from: self.from.clone(),
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct PlanArguments {
    /// A scene file, or a folder with scene.toml or scene.json
    pub(super) scene: PathBuf,
    /// As for a first look
    #[arg(long)]
    pub(super) quick: bool,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct SumsArguments {
    /// Id of the kernel, or a TOML or JSON file with `pieces`
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) kernel: String,
    /// Id of the lattice
    #[arg(long)]
    pub(super) lattice: String,
    /// A scene whose `[[define.kernel]]` and `[[define.lattice]]` may be named as well
    #[arg(long, value_name = "SCENE")]
    pub(super) define: Option<PathBuf>,
    /// R/Δ, a decimal or p/q, read exactly
    #[arg(long, allow_hyphen_values = true)]
    pub(super) support_over_dx: String,
    /// Decimals, absolute, lengths in units of Δ
    #[arg(long, default_value_t = 15)]
    pub(super) digits: u32,
    /// Print the closed form as well: rational × √n × π^k, or a quotient of such
    #[arg(long)]
    pub(super) exact: bool,
    /// A moment sum; may be given several times [default: the seven of Fatehi & Manzari and Σ ωW]
    #[arg(long = "moment", value_name = "NAME")]
    pub(super) moments: Vec<String>,
    /// Volumes: constant or number-density
    #[arg(long, default_value = "constant")]
    pub(super) volume_rule: String,
    /// Memory that the sites may take
    #[arg(long, default_value_t = 2048)]
    pub(super) memory_mib: u64,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct OrdersArguments {
    /// Id of the kernel, or a TOML or JSON file with `pieces`
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) kernel: String,
    /// Number of dimensions, for its default lattice: line, square, simple-cubic
    #[arg(long = "dim", value_name = "D")]
    pub(super) dimension: Option<u8>,
    /// Id of the lattice
    #[arg(long, value_name = "ID")]
    pub(super) lattice: Option<String>,
    /// A moment sum; may be given several times [default: the seven that `sums` takes]
    #[arg(long = "moment", value_name = "NAME")]
    pub(super) moments: Vec<String>,
    /// A disorder, MODEL[:AMPLITUDE][,key=value…]; may be given several times [default: one of each kind]
    #[arg(long = "disorder", value_name = "MODEL")]
    pub(super) disorders: Vec<String>,
    /// A displacement field of spectrum S(k) ~ k^A up to 1/Δ
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    pub(super) spectrum: Option<String>,
    /// Zero crossings from this R/Δ
    #[arg(long, default_value_t = 2.0, value_name = "R/Δ")]
    pub(super) from: f64,
    /// Zero crossings to this R/Δ
    #[arg(long, default_value_t = 8.0, value_name = "R/Δ")]
    pub(super) to: f64,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct ExpandArguments {
    /// An id of the catalogue (F4), or an operator in the language
    #[arg(value_name = "OPERATOR", allow_hyphen_values = true)]
    pub(super) operator: Option<String>,
    /// The highest order
    #[arg(long, value_name = "ORDER", default_value_t = 4)]
    pub(super) to: usize,
    /// How to print
    #[arg(long, value_enum, default_value = "text")]
    pub(super) format: ExpandFormat,
    /// The same as --format json
    #[arg(long)]
    pub(super) json: bool,
    /// A lattice on which terms may vanish; may be given several times [default: all of the catalogue]
    #[arg(long = "lattice", value_name = "ID")]
    pub(super) lattices: Vec<String>,
    /// Write every operator of the catalogue to this folder, as text and as LaTeX
    #[arg(long, value_name = "FOLDER", conflicts_with = "operator")]
    pub(super) all: Option<PathBuf>,
}

/// How an expansion is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ExpandFormat {
    Text,
    Latex,
    Json,
}

#[derive(Debug, Args)]
pub(super) struct RmsArguments {
    /// An id of the catalogue (F4), or an operator in the language
    #[arg(long, value_name = "OPERATOR", allow_hyphen_values = true, required_unless_present = "moment")]
    pub(super) operator: Option<String>,
    /// A moment sum in place of an operator: its distance from the continuum limit
    #[arg(long, value_name = "NAME", conflicts_with_all = ["operator", "field"])]
    pub(super) moment: Option<String>,
    /// The field about particle i: 1, x or x²/2; operators on a vector take (field, 0, 0)
    #[arg(long, value_enum, default_value = "quadratic")]
    pub(super) field: FieldName,
    /// MODEL:AMPLITUDE[,key=value…]
    #[arg(long, value_name = "MODEL:AMPLITUDE")]
    pub(super) disorder: String,
    /// Id of the kernel, or a TOML or JSON file with `pieces`
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) kernel: String,
    /// Id of the lattice
    #[arg(long)]
    pub(super) lattice: String,
    /// R/Δ, a decimal or p/q
    #[arg(long, allow_hyphen_values = true)]
    pub(super) support_over_dx: String,
    /// Volumes: constant or number-density
    #[arg(long, default_value = "constant")]
    pub(super) volume_rule: String,
    /// To second order in the displacements, or over their whole law [default: finite for a moment with constant
    /// volumes, else linearised]
    #[arg(long, value_enum)]
    pub(super) model: Option<RmsModel>,
    /// Put N samples beside it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=100_000_000))]
    pub(super) sample: Option<u64>,
    /// Seed of the samples
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// A scene whose `[[define.kernel]]` and `[[define.lattice]]` may be named as well
    #[arg(long, value_name = "SCENE")]
    pub(super) define: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct SymbolArguments {
    /// An id of the catalogue (S1-7-F2), or an operator in the language
    #[arg(value_name = "OPERATOR", allow_hyphen_values = true)]
    pub(super) operator: String,
    /// Id of the kernel, or a TOML or JSON file with `pieces`
    #[arg(long, value_name = "NAME|FILE", default_value = "wendland-c2")]
    pub(super) kernel: String,
    /// Id of the lattice, all of whose sites must see the same
    #[arg(long, default_value = "square")]
    pub(super) lattice: String,
    /// R/Δ, a decimal or p/q
    #[arg(long, allow_hyphen_values = true, default_value = "3")]
    pub(super) support_over_dx: String,
    /// Direction of k: x, y, z, or components like 1,1
    #[arg(long, default_value = "x", allow_hyphen_values = true)]
    pub(super) direction: String,
    /// How many waves, evenly up to k Δ = π
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub(super) waves: u16,
    /// Volumes: constant or number-density
    #[arg(long, default_value = "constant")]
    pub(super) volume_rule: String,
    /// A scene whose `[[define.kernel]]` and `[[define.lattice]]` may be named as well
    #[arg(long, value_name = "SCENE")]
    pub(super) define: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct AdviseArguments {
    /// Laplacians of a scalar (the default)
    #[arg(long, conflicts_with = "gradient")]
    pub(super) laplacian: bool,
    /// Gradients of a scalar
    #[arg(long)]
    pub(super) gradient: bool,
    /// The largest relative error
    #[arg(long, allow_hyphen_values = true)]
    pub(super) tolerance: f64,
    /// MODEL:AMPLITUDE[,key=value…]; without it, the lattice itself
    #[arg(long, value_name = "MODEL:AMPLITUDE")]
    pub(super) disorder: Option<String>,
    /// Wavelength of the field over Δ
    #[arg(long, default_value_t = 100.0, allow_hyphen_values = true)]
    pub(super) wavelength: f64,
    /// The most neighbours
    #[arg(long, value_name = "N")]
    pub(super) budget_neighbours: Option<usize>,
    /// D: the line, the square or the simple cubic lattice
    #[arg(long = "dim", value_name = "D")]
    pub(super) dimension: Option<u8>,
    /// Id of the lattice
    #[arg(long)]
    pub(super) lattice: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// A field about particle i.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FieldName {
    /// u = 1
    Constant,
    /// u = x
    Linear,
    /// u = x²/2
    Quadratic,
}

impl FieldName {
    /// m of x^m/m!.
    pub(super) fn order(self) -> u8 {
        match self {
            Self::Constant => 0,
            Self::Linear => 1,
            Self::Quadratic => 2,
        }
    }
}

/// How an expectation is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum RmsModel {
    /// To second order in the displacements
    Linearised,
    /// Over the whole law of the displacements
    Finite,
}

#[derive(Debug, Args)]
pub(super) struct KernelArguments {
    /// An id of the catalogue, or a TOML or JSON file with `pieces`
    #[arg(value_name = "NAME|FILE")]
    pub(super) kernel: String,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct SchemaArguments {
    /// Of what
    pub(super) of: SchemaOf,
    /// Of scenes of this kind (`study.kind`); by default those of orders
    #[arg(long)]
    pub(super) kind: Option<String>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum SchemaOf {
    /// Scenes
    Scene,
    /// Reports
    Report,
}

#[derive(Debug, Args)]
pub(super) struct ListArguments {
    /// Only these
    pub(super) what: Option<Listed>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Listed {
    /// Kernels
    Kernels,
    /// Lattices
    Lattices,
    /// Disorder models
    Disorders,
    /// Volume rules
    VolumeRules,
    /// Moment sums
    Moments,
    Operators,
    /// Published claims
    Claims,
}

fn parse_shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((index, count)) if index >= 1 && index <= count => Ok(Shard { index, count }),
        _ => Err("write I/N with 1 ≤ I ≤ N, for example 1/4".into()),
    }
}
