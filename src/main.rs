//! The `remainder` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(remainder::cli::main(std::env::args_os()).code())
}
