//! Commands: output, exit codes, files.

mod allocation_cli;
mod allocation_verdicts;
mod brief;
mod cli;
#[path = "../support/command.rs"]
#[allow(dead_code, reason = "each test binary uses a part of it")]
mod command;
mod difference;
mod examples;
mod exit_codes;
mod groups;
mod hosted;
mod hostile;
mod import;
mod import_layouts;
mod import_meaning;
mod import_step;
mod init;
mod json_errors;
mod labels;
mod likely_mistakes;
mod lots;
mod memory;
mod outputs;
mod own_files;
#[cfg(unix)]
mod prints;
mod probabilities;
mod probe;
mod rare;
mod rejects;
mod reported_inputs;
mod sampled_cli;
mod serve;
mod several;
mod sobol;
mod sweep;
mod verdicts;
mod watch;
mod workbench;
mod workbooks;
mod worst_cases;
