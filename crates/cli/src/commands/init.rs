//! `sensitol init`: a first study that runs unchanged.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::args::InitArgs;
use crate::commands::models::known;
use crate::failure::{Exit, Failure};
use crate::new_study::{shell, with_schema};
use crate::output::Destination;
use sensitol_models::{Model, ModelInput};
use sensitol_report::document::number::plain;
use sensitol_study::Format;
use sensitol_study::write::{inline, pair, quoted};

/// Tolerance of the inputs of a built-in model, relative to their nominal value.
const TOLERANCE: &str = "1%";

const FORMULA: &str = include_str!("../../studies/formula.toml");
const STACK: &str = include_str!("../../studies/stack.toml");
const FIT: &str = include_str!("../../studies/fit.toml");
const POSITION: &str = include_str!("../../studies/position.toml");
const LOOP: &str = include_str!("../../studies/loop.toml");
const ASSEMBLY: &str = include_str!("../../studies/assembly.toml");
/// Study that names its file of values as `{file}`.
const MEASURED: &str = include_str!("../../studies/measured.toml");
/// Example values of a measured dimension.
const VALUES: &str = include_str!("../../studies/measured.csv");

/// Returns a study whose model is a program.
fn process(script: &str) -> String {
    format!(
        r#"# A model behind a program: it reads points as JSON lines and answers with values. {script} stands for what drives a CAD system.
# `sensitol probe` says whether the program can be trusted; answers are kept in a journal beside this file.

[model]
command = ["python3", "{script}"]   # from this folder; never a shell line
workers = 1                         # processes side by side
timeout_s = 60

[dimensions]
housing = {{ nominal = 50.20, tolerance = 0.10, unit = "mm" }}
spacer  = {{ nominal = 10.00, tolerance = [-0.05, 0.0], unit = "mm" }}
bearing = {{ nominal = 20.00, tolerance = 0.06, unit = "mm", distribution = "uniform" }}

[characteristics]
gap = {{ unit = "mm", lower = 0.05, upper = 0.45, target_yield = 0.9973 }}
"#
    )
}

const SCRIPT: &str = r#""""The model: one line in for every point, one line out. Put what drives your CAD system into `evaluate`."""

import json
import sys


def evaluate(housing, spacer, bearing):
    return {"gap": housing - spacer - 2 * bearing}


hello = json.loads(sys.stdin.readline())
print(json.dumps({"ready": True, "name": "three parts in a housing", "version": "1"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    point = dict(zip(hello["dimensions"], request["x"]))
    try:
        found = evaluate(**point)
        answer = {"id": request["id"], "y": [found[name] for name in hello["characteristics"]]}
    except Exception as error:  # a point without an assembly says why, and the next one is asked
        answer = {"id": request["id"], "error": str(error)}
    print(json.dumps(answer), flush=True)
"#;

/// Returns the study of a kind that needs no other file, and the commands to try next.
fn own_study(asked: &InitArgs) -> (&'static str, &'static [&'static str]) {
    match asked {
        InitArgs { stack: true, .. } => (STACK, &["analyze", "allocate"]),
        InitArgs { fit: true, .. } => (FIT, &["analyze"]),
        InitArgs { position: true, .. } => (POSITION, &["analyze"]),
        InitArgs { closed_loop: true, .. } => (LOOP, &["analyze"]),
        InitArgs { assembly: true, .. } => (ASSEMBLY, &["check", "analyze"]),
        _ => (FORMULA, &["analyze", "allocate"]),
    }
}

/// Files of a kind with their texts, and the commands to try next.
type KindFiles = (Vec<(PathBuf, String)>, &'static [&'static str]);

/// Returns the files that the options request.
fn written(asked: &InitArgs, path: &Path) -> Result<KindFiles, Failure> {
    // A study that reads a file names it without its folder.
    let beside = |extension: &str| {
        let file = path.with_extension(extension);
        let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        (file, name)
    };
    let study = |text: String| (path.to_owned(), with_schema(&text));
    if let Some(model) = &asked.model {
        return Ok((vec![study(of_model(known(model)?))], &["analyze"]));
    }
    if asked.process {
        let (file, name) = beside("py");
        return Ok((vec![study(process(&name)), (file, SCRIPT.to_owned())], &["probe", "analyze"]));
    }
    if asked.measured {
        let (file, name) = beside("csv");
        return Ok((vec![study(MEASURED.replace("{file}", &name)), (file, VALUES.to_owned())], &["analyze"]));
    }
    let (text, next) = own_study(asked);
    Ok((vec![study(text.to_owned())], next))
}

pub(crate) fn run(asked: &InitArgs) -> Result<Exit, Failure> {
    let path = study_path(asked.name.as_deref().unwrap_or("study"));
    let name = shell(&path);
    let (files, next) = written(asked, &path)?;
    if let Some((there, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(Failure::Exists { path: there.clone() });
    }
    let opened: Vec<(Destination, String)> =
        files.into_iter().map(|(path, text)| Ok((Destination::file(&path)?, text))).collect::<Result<_, Failure>>()?;
    for (destination, text) in opened {
        destination.write(&text)?;
    }
    let commands: Vec<String> = next.iter().map(|command| format!("sensitol {command} {name}")).collect();
    let said = format!("written: {}\nnext: {}\n", path.display(), commands.join("\n      "));
    Destination::Stdout.write(&said)?;
    Ok(Exit::Done)
}

/// Returns the path of the study: `gap` and `gap.toml` both mean gap.toml.
fn study_path(name: &str) -> PathBuf {
    let path = Path::new(name);
    match path.extension() {
        Some(extension) if extension == "toml" => path.to_owned(),
        _ => PathBuf::from(format!("{name}.toml")),
    }
}

/// Returns a study of a built-in model. Inputs with a unit and a nominal value other than 0 vary by a percent, the others are fixed.
fn of_model(model: &Model) -> String {
    let mut text = format!("# {}\n# {}\n\n[model]\nbuiltin = \"{}\"\n\n", model.title, model.source, model.name);
    text += "[dimensions]\n# A percent each: replace it by what the drawing says. What is left out has the nominal value shown.\n";
    let widest = model.inputs.iter().map(|input| input.name.len()).max().unwrap_or(0);
    for &ModelInput { name, unit, nominal, about } in model.inputs {
        let nominal_text = plain(nominal);
        let sized = !matches!(unit, "" | "-");
        let of = |key, value: &str| pair(Format::Toml, key, value);
        let tolerance = (nominal != 0.0 && sized).then(|| of("tolerance", &quoted(TOLERANCE)));
        let (active, width) = if tolerance.is_some() { ("", widest) } else { ("# ", 0) };
        let unit = sized.then(|| of("unit", &quoted(unit)));
        let keys = inline([Some(of("nominal", &nominal_text)), tolerance, unit].into_iter().flatten());
        let line = active.to_owned() + &of(&format!("{name:<width$}"), &keys);
        let _ = writeln!(text, "{line}  # {about}");
    }
    text +=
        "\n[characteristics]\n# With lower, upper and target_yield the report tells how many assemblies keep them.\n";
    for (index, output) in model.outputs.iter().enumerate() {
        let off = if index == 0 { "" } else { "# " };
        let keys = inline([pair(Format::Toml, "unit", &quoted(output.unit))]);
        let _ = writeln!(text, "{off}{}  # {}", pair(Format::Toml, output.name, &keys), output.about);
    }
    text
}
