//! `sensitol init`: a first study that runs unchanged.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::args::InitArgs;
use crate::commands::models::known;
use crate::failure::{Exit, Failure};
use crate::output::Destination;
use sensitol_models::{Model, ModelInput};
use sensitol_report::document::number::plain;
use sensitol_study::Format;
use sensitol_study::write::{inline, pair, quoted};

/// Tolerance of the inputs of a built-in model, relative to their nominal value.
const TOLERANCE: &str = "1%";

const FORMULA: &str = r#"# A stack of three parts in a housing. Everything after a # is a comment.
# `sensitol analyze` evaluates the formula at a few points and tells what the tolerances do to the gap.

[dimensions]
# The nominal value and half the tolerance band; the band is 3 sigma of a normal distribution unless said otherwise.
housing = { nominal = 50.20, tolerance = 0.10, unit = "mm" }
spacer  = { nominal = 10.00, tolerance = [-0.05, 0.0], unit = "mm" }                       # a one-sided tolerance
bearing = { nominal = 20.00, tolerance = 0.06, unit = "mm", distribution = "uniform" }     # or triangular, beta, lognormal ...
tilt    = { nominal = 0.0, tolerance = 0.5, unit = "deg" }

[characteristics]
# The limits say which assemblies work, and target_yield what share of them must.
gap = { formula = "housing*cos(tilt*deg) - spacer - 2*bearing", unit = "mm", lower = 0.05, upper = 0.45, target_yield = 0.9973 }

# [analysis]
# method = "full"        # auto unless said otherwise: as few evaluations as the wanted accuracy takes
# accuracy = 0.001       # the relative error of sigma that auto may leave

# What tolerances cost, for `sensitol allocate`: the cheapest ones that keep the target yield.
[costs]
housing = { model = "reciprocal", a = 1.0, b = 0.20, min = 0.02, max = 0.40 }              # a + b/T
bearing = { model = "reciprocal", a = 2.0, b = 0.24, min = 0.01, max = 0.20 }
"#;

const ASSEMBLY: &str = r#"# A cover on a housing: two parts in space. Everything after a # is a comment.
# `sensitol check` tells which motions the joints leave, `sensitol analyze` what the tolerances do to the gap.

[dimensions]
height = { nominal = 40.0, tolerance = 0.05, unit = "mm" }
pitch  = { nominal = 60.0, tolerance = 0.04, unit = "mm" }
reach  = { nominal = 90.0, tolerance = 0.10, unit = "mm" }
lip    = { nominal = 5.0, tolerance = 0.03, unit = "mm" }
wall   = { nominal = 89.6, tolerance = 0.08, unit = "mm" }
square = { nominal = 0.0, tolerance = 0.1, unit = "deg" }      # the seat is not quite square to the wall

# A part is a rigid body: features in its own frame. Numbers, dimensions by name, or formulas in quotes.
[parts.housing]                                                # the first part stands still
seat = { plane = [0, 0, "height"], normal = { turned = "square", about = "y", from = "z" } }
hole = { axis = [15, 10, "height"], along = "z" }
slot = { frame = ["15 + pitch", 10, "height"], z = "z", x = "x" }
wall = { plane = ["wall", 0, 20], normal = "x" }

[parts.cover]
at    = [0, 0, 40]                                             # where the search starts
face  = { plane = [0, 0, 0], normal = "-z" }
pin1  = { axis = [15, 10, 0], along = "z" }
pin2  = { axis = ["15 + pitch", 10, 0], along = "z" }
flange = { plane = ["reach", 0, "-lip"], normal = "-x" }

# Joints in the order of assembly. `takes` says how many of the six freedoms each one removes.
[joints]
face   = { on = "housing.seat", against = "cover.face", takes = 3 }
first  = { hole = "housing.hole", pin = "cover.pin1", takes = 2 }
second = { slot = "housing.slot", pin = "cover.pin2", takes = 1 }

[characteristics]
gap = { of = "cover.flange", from = "housing.wall", unit = "mm", lower = 0.15, upper = 0.65, target_yield = 0.9973 }
"#;

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

pub(crate) fn run(asked: &InitArgs) -> Result<Exit, Failure> {
    let path = study_path(asked.name.as_deref().unwrap_or("study"));
    let name = shell(&path);
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    match &asked.model {
        Some(model) => files.push((path.clone(), of_model(known(model)?))),
        None if asked.process => {
            let script = path.with_extension("py");
            let beside = script.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            files.push((path.clone(), process(&beside)));
            files.push((script, SCRIPT.to_owned()));
        }
        None if asked.assembly => files.push((path.clone(), ASSEMBLY.to_owned())),
        None => files.push((path.clone(), FORMULA.to_owned())),
    }
    if let Some((there, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(Failure::Exists { path: there.clone() });
    }
    let opened: Vec<(Destination, String)> =
        files.into_iter().map(|(path, text)| Ok((Destination::file(&path)?, text))).collect::<Result<_, Failure>>()?;
    for (destination, text) in opened {
        destination.write(&text)?;
    }
    let next = match () {
        () if asked.process => "probe",
        () if asked.assembly => "check",
        () => "analyze",
    };
    let more = if asked.process || asked.assembly || asked.model.is_some() {
        if asked.assembly { format!("\n      sensitol analyze {name}") } else { String::new() }
    } else {
        format!("\n      sensitol allocate {name}")
    };
    let said = format!("written: {}\nnext: sensitol {next} {name}{more}\n", path.display());
    Destination::Stdout.write(&said)?;
    Ok(Exit::Done)
}

/// Quotes a path for a shell.
fn shell(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "_-./:+,@%".contains(c) || cfg!(windows) && c == '\\';
    match text.chars().all(plain) {
        true => text,
        false if cfg!(windows) => format!("\"{text}\""),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
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
