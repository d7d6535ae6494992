//! The program as a process: what it prints, writes, refuses and returns.
//!
//! Every run here is a process of its own in a folder of its own. [`folder::Ran`] refuses a panic in whatever the
//! process printed, whatever a test is about.

#![allow(clippy::panic, reason = "a test fails by panicking, also in the functions that it shares")]

#[path = "cli/advise.rs"]
mod advise;
#[path = "cli/bad_files.rs"]
mod bad_files;
#[path = "cli/bad_scenes.rs"]
mod bad_scenes;
#[path = "cli/chaussonnet.rs"]
mod chaussonnet;
#[path = "cli/exit_codes.rs"]
mod exit_codes;
#[path = "cli/expand.rs"]
mod expand;
#[path = "cli/extremes.rs"]
mod extremes;
#[path = "cli/folder.rs"]
mod folder;
#[path = "cli/interruptions.rs"]
mod interruptions;
#[path = "cli/orders.rs"]
mod orders;
#[path = "cli/pages.rs"]
mod pages;
#[path = "cli/plans.rs"]
mod plans;
#[path = "cli/reports.rs"]
mod reports;
#[path = "cli/rms.rs"]
mod rms;
#[path = "cli/same_bytes.rs"]
mod same_bytes;
#[path = "cli/scenes.rs"]
mod scenes;
#[path = "cli/time.rs"]
mod time;
