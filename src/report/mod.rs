//! One record; JSON is the source, everything else is a view of it.

mod record;

pub use record::*;
