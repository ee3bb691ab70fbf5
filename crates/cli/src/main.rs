//! The `sensitol` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    sensitol_cli::run(std::env::args_os())
}
