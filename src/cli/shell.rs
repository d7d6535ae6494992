//! `completions` and `man`: what shells and manuals want to know of the command line.

use super::arguments::{Arguments, CompletionArguments, ManArguments};
use super::execute::print_out;
use super::exit::{Exit, Failure};
use clap::CommandFactory as _;
use clap_mangen::{Man, generate_to};

pub(super) fn completions(arguments: &CompletionArguments) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "remainder", &mut script);
    print_out(&String::from_utf8_lossy(&script));
    Ok(Exit::AsExpected)
}

pub(super) fn man(arguments: &ManArguments) -> Result<Exit, Failure> {
    // `remainder help run` prints what `run --help` does: a page of its own would say nothing more.
    let command = Arguments::command().disable_help_subcommand(true);
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        let rendered = Man::new(command).render(&mut page);
        rendered.map_err(|error| Failure::Arguments(format!("cannot render the page: {error}")))?;
        print_out(&String::from_utf8_lossy(&page));
        return Ok(Exit::AsExpected);
    };
    let written = std::fs::create_dir_all(folder).and_then(|()| generate_to(command, folder));
    written.map_err(|error| Failure::Arguments(format!("cannot write to {}: {error}", folder.display())))?;
    print_out(&format!("Written to {}.\n", folder.display()));
    Ok(Exit::AsExpected)
}
