//! One record; JSON is the source, every other form is a view of it.

mod advise;
mod assemble;
#[cfg(feature = "views")]
mod csv;
mod diff;
mod expansion;
mod explain;
#[cfg(feature = "views")]
pub mod figure;
#[cfg(feature = "views")]
pub mod html;
#[cfg(feature = "views")]
mod junit;
#[cfg(feature = "views")]
mod latex;
mod layout;
mod markdown;
mod numbers;
mod orders;
mod printed;
mod read;
#[cfg(feature = "views")]
mod rich;
mod rms;
#[cfg(feature = "views")]
pub mod svg;
mod symbol;
mod table;
mod write;

pub use crate::record::*;
pub use advise::advice_text;
pub use assemble::assemble;
#[cfg(feature = "views")]
pub use csv::{csv_files, file_names};
pub use diff::{Difference, ListChange, Place, ValueChange, VerdictChange, difference_text};
pub use expansion::{
    ConservationReport, ExpansionReport, OrderReport, TermReport, Vanishes, expansion_report,
};
pub use explain::{Evidence, Story, UnknownClaim, stories};
#[cfg(feature = "views")]
pub use junit::junit;
#[cfg(feature = "views")]
pub use latex::{LatexError, latex_files, latex_shared};
pub use layout::to_json;
pub use markdown::markdown;
pub use orders::{
    ComponentReport, ContributionReport, DisorderReport, DisorderTermReport, MomentOrders, OrdersReport,
    OrdersRequest, PublishedOrder, orders_report,
};
pub use printed::{PrintedError, PrintedVerdict, printed_markdown, printed_verdicts};
pub use read::{ReadError, read_report};
pub use rms::{RmsReport, SampledReport};
pub use symbol::{NullMode, SymbolReport, WaveReport, symbol_report};
pub use table::{Row, Section, sections};
pub use write::{WriteError, check_target, write_report};
