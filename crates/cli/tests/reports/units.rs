//! Units of formulas: warnings, checks and conversion; units of models; numbers with units.

use sensitol::Method;
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol_study::Study;
use sensitol_testing::{analysed, close, example_studies, faults, parse, relative};

/// Formula that mixes mm, in and degrees.
const MIXED: &str = "[dimensions]\narm = { nominal = 118, tolerance = 0.4, unit = \"mm\" }\nshim = { nominal = 0.625, tolerance = 0.003, unit = \"in\" }\n\
                     tilt = { nominal = 14, tolerance = 0.25, unit = \"deg\" }\n[characteristics]\n\
                     h = { formula = \"arm*sin(tilt) + shim + 0.5[mm]\", unit = \"mm\" }\n";

fn mode(mode: &str, text: &str) -> String {
    format!("units = \"{mode}\"\n{text}")
}

fn at_nominal(study: &Study) -> f64 {
    let nominal: Vec<f64> = study.problem.dimensions().iter().map(|one| one.nominal()).collect();
    let mut out = Responses::open(1, 1);
    let points = Points::from_rows(&[nominal]);
    study.problem.function().evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut out);
    out.value(0, 0).unwrap()
}

/// Value by hand: 118 sin 14° + 0.625 · 25.4 + 0.5.
#[test]
fn conversion_gives_the_value_by_hand() {
    let study = parse(&mode("convert", MIXED)).unwrap();
    assert!(study.warnings.is_empty(), "{:?}", study.warnings);
    let exact = 118.0 * 14f64.to_radians().sin() + 0.625 * 25.4 + 0.5;
    // A few products and a quotient by a factor more than by hand.
    relative(at_nominal(&study), exact, 4e-15);
    // Slopes keep the study's units: mm per inch, mm per degree.
    let text = mode("convert", MIXED);
    let analysis = analysed(&text, Method::SecondOrder);
    let slope = |index: usize| analysis.characteristics[0].sensitivities[index].first.unwrap();
    relative(slope(1), 25.4, 1e-9);
    relative(slope(2), 118.0 * 14f64.to_radians().cos() * 1f64.to_radians(), 1e-5);
    // Without conversion, the numbers are taken as written.
    let raw = 118.0 * 14f64.sin() + 0.625 + 0.5;
    relative(at_nominal(&parse(&mode("labels", MIXED)).unwrap()), raw, 4e-15);
    relative(at_nominal(&parse(MIXED).unwrap()), raw, 4e-15);
}

/// Formulas, constants and unknowns with units, and loops in degrees: the same results as by hand in millimetres.
#[test]
fn conversion_follows_formulas_constants_unknowns_and_loops() {
    let text = "units = \"convert\"\n[constants]\nE = { value = 205, unit = \"GPa\" }\n[dimensions]\nA = { nominal = 100, tolerance = 1, unit = \"mm^2\" }\n\
                e = { nominal = 0.1, tolerance = 0.01, unit = \"%\" }\n[formulas]\nF = { formula = \"E*A*e\", unit = \"kN\" }\n\
                [characteristics]\ny = { formula = \"2*F\", unit = \"N\" }\n";
    // 205e9 · 100e-6 · 0.001 = 20500 N.
    relative(at_nominal(&parse(text).unwrap()), 41000.0, 1e-14);
    let text = "units = \"convert\"\n[dimensions]\na = { nominal = 30, tolerance = 0.1, unit = \"mm\" }\nb = { nominal = 4, tolerance = 0.01, unit = \"cm\" }\n\
                [unknowns]\nc = { start = 2, unit = \"in\" }\nphi = { start = 30, unit = \"deg\" }\n\
                [loops]\nl = [ { length = \"a\", angle = 0 }, { length = \"b\", angle = \"pi/2\" }, { length = \"c\", angle = \"phi + pi\" } ]\n\
                [characteristics]\nc = { unit = \"in\" }\n";
    // A right triangle of 30 and 40 mm: 50 mm.
    relative(at_nominal(&parse(text).unwrap()), 50.0 / 25.4, 1e-12);
}

/// A built-in model in m and rad: mm and degrees are converted, or are an error.
#[test]
fn inputs_of_a_model_are_converted_or_refused() {
    let text = |units: &str| {
        format!(
            "{units}[model]\nbuiltin = \"engine-balance\"\n[dimensions]\na = {{ nominal = 78, tolerance = 0.1, unit = \"mm\" }}\n[characteristics]\nF = {{}}\nM = {{}}\n"
        )
    };
    let plain = text("").replace("nominal = 78, tolerance = 0.1, unit = \"mm\"", "nominal = 0.078, tolerance = 0.0001");
    let sigma = |text: &str| analysed(text, Method::SecondOrder).characteristics[1].moments.unwrap().sigma();
    // A linear input: the same differences except for rounding.
    relative(sigma(&text("units = \"convert\"\n")), sigma(&plain), 1e-9);
    for units in ["", "units = \"check\"\n"] {
        let error = parse(&text(units)).unwrap_err().to_string();
        assert!(
            error.contains("the input `a` of the model engine-balance is in m, unit says mm: factor 0.001"),
            "{error}"
        );
    }
    parse(&text("units = \"labels\"\n")).unwrap();
}

#[test]
fn units_that_do_not_go_together_are_faults() {
    let rest = "[dimensions]\narm = { nominal = 118, tolerance = 0.4, unit = \"mm\" }\nshim = { nominal = 0.625, unit = \"in\" }\n\
                tilt = { nominal = 14, unit = \"deg\" }\nF = { nominal = 3, unit = \"N\" }\nT = { nominal = 20, unit = \"degC\" }\nx = { nominal = 3 }\n\
                [constants]\nE = { value = 205, unit = \"GPa\" }\nA = { value = 2, unit = \"mm^2\" }\n";
    let formula = |formula: &str| {
        mode("check", &format!("{rest}[characteristics]\ny = {{ formula = \"{formula}\", unit = \"mm\" }}\n"))
    };
    let converted = |formula: &str| formula.replace("\"check\"", "\"convert\"");
    insta::assert_snapshot!(faults(&[
        &formula("arm + shim"),
        &formula("arm - x - (shim + arm)"),
        &formula("arm*sin(tilt)"),
        &formula("arm*exp(F)"),
        &formula("arm + F"),
        &formula("arm + 400*F"),
        &formula("arm*T"),
        &formula("arm*acos(shim)"),
        &formula("arm^F"),
        &formula("E*A"),
        &formula("arm + 2[furlong]"),
        &formula("arm + 2[mm"),
        &formula("arm + arm[mm]"),
        &converted(&formula("arm*sin(tilt*deg)")),
        &converted(&formula("arm + 2")),
        &converted(&formula("arm + x")),
        &converted(&formula("arm + F")),
        &converted(&formula("arm + shim"))
            .replace("\", unit = \"mm\" }\n", "\" }\n")
            .replace("shim\", unit = \"mm\"", "shim\""),
        &mode("metric", MIXED),
        &mode(
            "check",
            &format!(
                "{rest}[formulas]\ns = {{ formula = \"E\", unit = \"MPa\" }}\n[characteristics]\ny = {{ formula = \"s*x\" }}\n"
            )
        ),
        &mode(
            "check",
            &format!(
                "{rest}[unknowns]\nu = 3\nv = 2\n[loops]\nl = [ {{ length = \"arm\", angle = \"tilt\" }}, {{ length = \"u\", angle = \"v\" }}, {{ length = \"shim\", angle = 0 }} ]\n[characteristics]\nu = {{}}\n"
            )
        ),
    ]));
}

/// The default is a warning with its place. Plain numbers, which may hide a unit, and names without a unit give none.
#[test]
fn units_that_do_not_go_together_warn() {
    let warnings = |text: &str| {
        let warnings = parse(text).unwrap().warnings;
        warnings.iter().map(|warning| format!("[{}] {}", warning.code(), warning.message())).collect::<Vec<_>>()
    };
    assert_eq!(
        warnings(MIXED),
        [
            "[unit-mismatch] The units of characteristics.h.formula do not go together. Column 9, `tilt`, is sine of degrees. The numbers are used as \
             they are. To correct it, write tilt*deg."
        ]
    );
    let silent = MIXED.replace("arm*sin(tilt) + shim + 0.5[mm]", "arm*sin(tilt*deg) + 25.4*shim + 400*F");
    assert_eq!(
        warnings(&silent.replace("[characteristics]", "F = { nominal = 2, unit = \"N\" }\n[characteristics]")),
        [""; 0]
    );
    assert_eq!(
        warnings(&MIXED.replace(", unit = \"deg\"", "").replace(", unit = \"in\"", "").replace("0.5[mm]", "0.5")),
        [""; 0]
    );
    let unknown = warnings(&MIXED.replace("\"deg\"", "\"turns\""));
    assert_eq!(unknown.len(), 2);
    assert!(unknown[1].starts_with("[unknown-unit] Nothing is known of the unit `turns`."), "{unknown:?}");
}

/// `2[mm]` is allowed wherever a number is.
#[test]
fn numbers_with_units_are_numbers() {
    let text = "[dimensions]\na = { nominal = 3, tolerance = 0.1, unit = \"mm\" }\n[characteristics]\ny = { formula = \"2[mm]*a + 25.4[mm/in]^2 - -1[mm]\" }\n";
    close(at_nominal(&parse(text).unwrap()), 6.0 + 25.4 * 25.4 + 1.0, 1e-15, 1.0);
}

/// Every example has units and passes `check`.
#[test]
fn every_example_passes_check() {
    let mut without = Vec::new();
    for (name, path) in example_studies() {
        let text = std::fs::read_to_string(&path).unwrap();
        let json = path.extension().is_some_and(|extension| extension == "json");
        let checked = match (json, text.contains("units = ")) {
            (_, true) => text.clone(),
            (true, _) => text.replacen('{', "{ \"units\": \"check\",", 1),
            (false, _) => format!("units = \"check\"\n{text}"),
        };
        let folder = path.parent().unwrap();
        let file = tempfile::Builder::new().suffix(if json { ".json" } else { ".toml" }).tempfile_in(folder).unwrap();
        std::fs::write(file.path(), checked).unwrap();
        let study = Study::read(file.path()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!study.warnings.iter().any(|warning| warning.code() == "unknown-unit"), "{name}");
        // Parts of geometric elements are plain numbers between -1 and 1.
        let part = |name: &str| {
            name.contains('.')
                && [".unit", ".unit_x", ".unit_y", ".pin_x", ".pin_y", ".slot"].iter().any(|end| name.ends_with(end))
        };
        let dimensions = study.problem.dimensions().iter().filter(|one| !part(one.name()));
        let bare = dimensions.filter(|one| one.unit().is_none()).map(|one| one.name().to_owned());
        let bare: Vec<String> = bare.collect();
        if !bare.is_empty() {
            without.push(format!("{}: {}", path.display(), bare.join(", ")));
        }
    }
    assert!(without.is_empty(), "dimensions without a unit:\n{}", without.join("\n"));
}

/// Program that states its own units.
const PROGRAM: &str = r#"
import json, sys
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        print(json.dumps({"ready": True, "name": "gap", "units": UNITS}), flush=True)
    else:
        print(json.dumps({"id": told["id"], "y": [told["x"][0]]}), flush=True)
"#;

#[test]
fn the_units_of_a_program_are_held_against_the_study() {
    let folder = tempfile::tempdir().unwrap();
    let run = |units: &str, mode: &str, unit: &str| {
        std::fs::write(folder.path().join("gap.py"), PROGRAM.replace("UNITS", units)).unwrap();
        let study = format!(
            "units = \"{mode}\"\n[dimensions]\na = {{ nominal = 10, tolerance = 0.3, unit = \"{unit}\" }}\n\
             [model]\ncommand = [\"python3\", \"gap.py\"]\n[characteristics]\ny = {{ unit = \"{unit}\" }}\n"
        );
        std::fs::write(folder.path().join("gap.toml"), study).unwrap();
        let arguments = ["analyze", "gap.toml", "--method", "second-order", "--verify", "0", "--journal", "none"];
        let output = super::command::sensitol(&arguments).current_dir(folder.path()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    for mode in ["warn", "check"] {
        let (code, error) = run(r#"{"a": "in"}"#, mode, "mm");
        assert_eq!(code, Some(2), "{error}");
        assert!(error.contains("the model has `a` in in, and the study in mm (factor 0.03937"), "{error}");
        assert!(error.contains("write `a` in in, or units = \"convert\""), "{error}");
    }
    for mode in ["warn", "convert"] {
        let (code, error) = run(r#"{"y": "N"}"#, mode, "mm");
        assert!(code == Some(2) && error.contains("they measure different things; write `y` in N"), "{error}");
        // Units with another zero cannot be converted by a factor.
        let (code, error) = run(r#"{"a": "K"}"#, mode, "degC");
        assert!(code == Some(2) && error.contains("write `a` in K"), "{error}");
    }
    // The same unit, another spelling of one, an unknown unit, and values that are not units.
    for units in
        [r#"{"a": "mm", "y": "mm"}"#, r#"{"a": "furlong"}"#, r#"{"b": "in"}"#, "{}", "None", "[1, 2]", r#"{"a": 3}"#]
    {
        let (code, error) = run(units, "check", "mm");
        assert_eq!(code, Some(0), "{units}: {error}");
    }
    assert_eq!(run(r#"{"a": "m/s^2"}"#, "check", "m/s²").0, Some(0));
    assert_eq!(run(r#"{"a": "in"}"#, "labels", "mm").0, Some(0));
}

/// Program in inches and radians with derivatives: the height of an arm of length `arm`, tilted by `tilt`, on a shim.
const IMPERIAL: &str = r#"
import json, math, sys
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        units = {"arm": "in", "shim": "in", "tilt": "rad", "height": "in"}
        print(json.dumps({"ready": True, "units": units, "gradients": True}), flush=True)
        names = told["dimensions"]
    else:
        x = dict(zip(names, told["x"]))
        y = x["arm"] * math.sin(x["tilt"]) + x["shim"]
        slopes = {"arm": math.sin(x["tilt"]), "shim": 1.0, "tilt": x["arm"] * math.cos(x["tilt"])}
        print(json.dumps({"id": told["id"], "y": [y], "dy": [[slopes[name] for name in names]]}), flush=True)
"#;

/// Three studies: a program in other units, a formula in the study's units, and the program with unconverted numbers. The last one must
/// not find the answers of the first in the journal.
#[test]
fn a_program_in_other_units_is_converted() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("height.py"), IMPERIAL).unwrap();
    let dimensions = "[dimensions]\narm = { nominal = 80, tolerance = 0.3, unit = \"mm\" }\n\
                      shim = { nominal = 4, tolerance = 0.1, unit = \"mm\" }\ntilt = { nominal = 30, tolerance = 0.5, unit = \"deg\" }\n";
    let program = "[model]\ncommand = [\"python3\", \"height.py\"]\n[characteristics]\nheight = { unit = \"mm\" }\n";
    let run = |name: &str, mode: &str, rest: &str, method: &str| {
        let text = format!("units = \"{mode}\"\n{dimensions}{rest}");
        std::fs::write(folder.path().join(name), text).unwrap();
        let arguments = ["analyze", name, "--method", method, "--verify", "0", "--json", "-q"];
        let output = super::command::sensitol(&arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let formula = "[characteristics]\nheight = { formula = \"arm*sin(tilt) + shim\", unit = \"mm\" }\n";
    for method in ["full", "second-order"] {
        let [found, known] =
            [run("study.toml", "convert", program, method), run("formula.toml", "convert", formula, method)];
        for key in ["nominal", "mean", "sigma"] {
            let of = |report: &serde_json::Value| report["characteristics"][0][key].as_f64().unwrap();
            // Second differences of the program lose half of the digits. Those of the formula are exact.
            relative(of(&found), of(&known), if key == "nominal" { 1e-14 } else { 1e-6 });
        }
    }
    let raw = run("study.toml", "labels", program, "full");
    let nominal = raw["characteristics"][0]["nominal"].as_f64().unwrap();
    relative(nominal, 80.0 * 30.0_f64.sin() + 4.0, 1e-14);
}

/// Output of a built-in model in another unit: the characteristic, and every formula that uses its name, have the requested unit.
#[test]
fn outputs_of_built_in_models_are_converted() {
    let study = |mode: &str, unit: &str, half: &str| {
        format!(
            "units = \"{mode}\"\n[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = {{ tolerance = 0.00004, unit = \"m\" }}\n\
             phi1 = {{ tolerance = 0.00872, unit = \"rad\" }}\n[characteristics]\nF = {{ unit = \"{unit}\" }}\n\
             half = {{ formula = \"F/2\", unit = \"{half}\" }}\n"
        )
    };
    let analysed = |text: &str| {
        let analysis = analysed(text, Method::SecondOrder);
        [0, 1].map(|index| {
            let one = &analysis.characteristics[index];
            let moments = one.moments.unwrap();
            [one.nominal.unwrap(), moments.mean(), moments.sigma(), one.sensitivities[0].first.unwrap()]
        })
    };
    let own = analysed(&study("check", "N", "N"));
    for (unit, factor) in [("kN", 1e-3), ("lbf", 1.0 / 4.4482216152605)] {
        let found = analysed(&study("convert", unit, "N"));
        for figure in 0..4 {
            // One product more than in N. Differences of the model lose some digits of its slopes.
            relative(found[0][figure], own[0][figure] * factor, 1e-9);
            relative(found[1][figure], own[1][figure], 1e-9);
        }
    }
    let refused = faults(&[&study("check", "kN", "N")]);
    assert!(refused.contains("units = \"convert\" at the top"), "{refused}");
    let refused = faults(&[&study("convert", "m", "N")]);
    assert!(refused.contains("the output `F` of the model engine-balance is in N, unit says m"), "{refused}");
}

/// Returns a study of dimensions with the units of a case, and a characteristic of this formula and unit.
fn with_units(inputs: &serde_json::Value, formula: &str, unit: Option<&str>) -> String {
    let dimensions: String = (inputs.as_object().unwrap().iter())
        .map(|(name, unit)| format!("{name} = {{ nominal = 2, tolerance = 0.001, unit = {unit} }}\n"))
        .collect();
    let unit = unit.map(|unit| format!(", unit = \"{unit}\"")).unwrap_or_default();
    format!("[dimensions]\n{dimensions}[characteristics]\ny = {{ formula = \"{formula}\"{unit} }}\n")
}

/// Printed factors of NIST SP 811, and formulas that are right, wrong or doubtful by definition.
#[test]
fn factors_and_formulas_of_the_sources() {
    let factors = sensitol_testing::case("units-sp811");
    for (pair, printed) in factors["printed"].as_object().unwrap() {
        let (from, to) = pair.split_once(' ').unwrap();
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.1, unit = \"{from}\" }}\n[characteristics]\ny = {{ formula = \"a\", unit = \"{to}\" }}\n"
        );
        let found = at_nominal(&parse(&mode("convert", &text)).unwrap());
        // Seven digits are printed. The exact factor is a quotient of two doubles.
        close(found, printed["value"].as_f64().unwrap(), printed["tolerance"].as_f64().unwrap(), 1.0);
        relative(found, factors["exact"][pair].as_f64().unwrap(), 1e-15);
    }
    let accepted = sensitol_testing::case("units-check-accepts");
    let inputs = &accepted["inputs"];
    let faulty = |unit_mode: &str, formula: &str, unit: Option<&str>| {
        parse(&mode(unit_mode, &with_units(inputs, formula, unit))).err().map(|error| error.to_string())
    };
    for (formula, unit) in accepted["printed"].as_object().unwrap() {
        assert_eq!(faulty("check", formula, unit.as_str()), None, "{formula}");
    }
    for formula in sensitol_testing::case("units-check-refuses")["printed"].as_object().unwrap().keys() {
        let error = faulty("check", formula, None).unwrap_or_else(|| panic!("{formula} is accepted"));
        assert!(error.contains("characteristics.y.formula"), "{formula}: {error}");
        let warned = parse(&mode("warn", &with_units(inputs, formula, None))).unwrap().warnings;
        assert!(warned.iter().any(|warning| warning.code() == "unit-mismatch"), "{formula}");
    }
    for formula in sensitol_testing::case("units-check-doubts")["printed"].as_object().unwrap().keys() {
        let error = faulty("check", formula, None).unwrap_or_else(|| panic!("{formula} is accepted"));
        assert!(error.contains('['), "a unit is asked for: {error}");
        let silent = parse(&mode("warn", &with_units(inputs, formula, None))).unwrap().warnings;
        assert!(silent.iter().all(|warning| warning.code() != "unit-mismatch"), "{formula}: {silent:?}");
    }
}
