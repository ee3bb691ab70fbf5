//! The command `sensitol` for tests.

use sensitol_testing::repository;
use std::process::Command;

/// Study of the four-cylinder engine.
pub const ENGINE: &str = "examples/engine-balance/study.toml";

/// Returns a command that runs the program at the repository's root in a UTF-8 locale.
pub fn sensitol(arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
    command
        .args(arguments)
        .current_dir(repository(""))
        .env("LC_ALL", "C.UTF-8")
        .env_remove("NO_COLOR")
        .env_remove("COLUMNS");
    command
}

/// Returns exit code, stdout and stderr as one text.
pub fn run(arguments: &[&str]) -> String {
    let output = sensitol(arguments).output().unwrap();
    let part = |name: &str, bytes: &[u8]| match String::from_utf8(bytes.to_vec()).unwrap() {
        empty if empty.is_empty() => String::new(),
        text => format!("--- {name}\n{text}"),
    };
    let code = output.status.code().expect("no signal");
    format!("exit {code}\n{}{}", part("stdout", &output.stdout), part("stderr", &output.stderr))
}

/// Rounds numbers to twelve digits, because the last ones depend on the machine's logarithm.
pub fn rounded(value: &mut serde_json::Value) {
    match value {
        serde_json::Value::Number(number) if number.is_f64() => {
            *value = format!("{:.11e}", number.as_f64().unwrap()).parse::<f64>().unwrap().into();
        }
        serde_json::Value::Array(items) => items.iter_mut().for_each(rounded),
        serde_json::Value::Object(fields) => fields.values_mut().for_each(rounded),
        _ => {}
    }
}
