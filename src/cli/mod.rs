//! The command line: arguments in, events drawn, exit code out.

mod advise;
mod arguments;
mod catalogue;
mod diagnostic;
mod diff;
mod execute;
mod exit;
mod expand;
mod explain;
mod files;
mod kernel;
mod new;
mod orders;
mod pages;
mod progress;
mod reference;
mod report;
mod report_arguments;
mod rms;
mod shell;
mod sums;
mod symbol;
mod terminal;
mod views;

pub use arguments::Arguments;
pub use exit::Exit;

use arguments::Command;
use clap::Parser as _;
use std::ffi::OsString;

/// Runs the program with these arguments (the first is its name) and returns its exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> Exit {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are not errors; clap prints each where it belongs.
            let _ = error.print();
            return if error.use_stderr() { Exit::WrongInput } else { Exit::AsExpected };
        }
    };
    let done = match &arguments.command {
        Command::New(new) => new::new(new),
        Command::Run(run) => execute::run(run, false),
        Command::Merge(merge) => execute::run(&merge.as_run(), true),
        Command::Report(arguments) => report::report(arguments),
        Command::Diff(arguments) => diff::diff(arguments),
        Command::Plan(plan) => execute::plan(plan),
        Command::Sums(arguments) => sums::sums(arguments),
        Command::Schema(schema) => catalogue::schema(schema),
        Command::Kernel(named) => kernel::audit(named),
        Command::Expand(operator) => expand::expand(operator),
        Command::Rms(arguments) => rms::rms(arguments),
        Command::Symbol(arguments) => symbol::symbol(arguments),
        Command::Orders(arguments) => orders::orders(arguments),
        Command::Advise(arguments) => advise::advise(arguments),
        Command::List(list) => catalogue::list(list),
        Command::Explain(claim) => explain::explain(claim),
        Command::Reference(arguments) => reference::reference(arguments),
        Command::Completions(arguments) => shell::completions(arguments),
        Command::Man(arguments) => shell::man(arguments),
    };
    match done {
        Ok(exit) => exit,
        Err(failure) => {
            diagnostic::print(&failure);
            failure.exit()
        }
    }
}
