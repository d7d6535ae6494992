//! Progress: bars on a terminal, a calm line now and then elsewhere.

use super::execute::note;
use crate::study::Event;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::IsTerminal as _;
use std::sync::{Mutex, PoisonError};

/// Draws events on standard error and keeps the seconds of each task for `timings.json`.
pub(super) struct Progress {
    bar: ProgressBar,
    interactive: bool,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    tasks: usize,
    finished: usize,
    stored: u64,
    cost: u64,
    done: u64,
    tenths: u64,
    seconds: BTreeMap<String, f64>,
    timed: serde_json::Value,
    /// What was finished last, and what it found.
    last: String,
}

impl Progress {
    pub(super) fn new() -> Self {
        // A terminal that cannot move its cursor, and a log that only looks like one, get lines.
        let set =
            |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "false");
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let interactive = std::io::stderr().is_terminal() && !dumb && !set("CI");
        let target =
            if interactive { ProgressDrawTarget::stderr_with_hz(8) } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {elapsed} + {eta}  {wide_msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, interactive, state: Mutex::default() }
    }

    /// Takes an event, from any thread.
    pub(super) fn take(&self, event: Event) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        match event {
            Event::Planned { tasks, cost } => {
                (state.tasks, state.cost) = (tasks, cost);
                self.bar.set_length(cost.max(1));
            }
            Event::Advanced { cost, stored } => {
                state.done = state.done.saturating_add(cost);
                state.stored += u64::from(stored);
                self.bar.inc(cost);
            }
            Event::Timed(value) => state.timed = value,
            Event::Finished { label, seconds, spared, found } => {
                state.done = state.done.saturating_add(spared);
                state.finished += 1;
                self.bar.inc(spared);
                let found = found.map(|found| format!(": {found}")).unwrap_or_default();
                state.last = format!("{label}{found}");
                self.bar.set_message(format!("{}/{} {}", state.finished, state.tasks, state.last));
                *state.seconds.entry(label).or_default() += seconds;
            }
        }
        let tenths = state.done.saturating_mul(10).checked_div(state.cost).unwrap_or(10);
        if !self.interactive && tenths > state.tenths {
            state.tenths = tenths;
            let last = if state.last.is_empty() { String::new() } else { format!("; {}", state.last) };
            note(&format!(
                "{} of {} tasks, {} % of the work{last}",
                state.finished,
                state.tasks,
                tenths * 10
            ));
        }
    }

    /// Clears the bar; seconds by task, how many blocks were found in the store, and what a survey timed.
    pub(super) fn finish(self) -> (BTreeMap<String, f64>, u64, serde_json::Value) {
        self.bar.finish_and_clear();
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        (state.seconds, state.stored, state.timed)
    }
}
