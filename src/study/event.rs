//! What a running study tells its caller.

/// Something that happened.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// The tasks are known; `cost` is the sum of all [`Event::Advanced`] to come if every sample is needed.
    Planned {
        /// Number of tasks.
        tasks: usize,
        /// Estimated work in pairs.
        cost: u64,
    },
    /// A block was finished or found in the store.
    Advanced {
        /// Its share of the work in pairs.
        cost: u64,
        /// Whether it was found in the store.
        stored: bool,
    },
    /// What was timed, for `timings.json`.
    Timed(serde_json::Value),
    /// A task has all its blocks.
    Finished {
        /// What it was.
        label: String,
        /// Seconds from its start, for `timings.json`.
        seconds: f64,
        /// Work that turned out not to be needed, in pairs.
        spared: u64,
        /// What it found, in a few words.
        found: Option<String>,
    },
}
