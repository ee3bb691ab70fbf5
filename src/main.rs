//! The `sensitol` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    sensitol::cli::run(std::env::args_os())
}
