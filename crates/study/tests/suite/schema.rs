//! The JSON Schema of study files with an independent validator: it accepts all studies of the repository and refuses invalid ones.

use jsonschema::Validator;
use sensitol_study::Study;
use sensitol_testing::{example_studies, repository};
use serde_json::Value;

fn validator() -> Validator {
    let schema = sensitol_study::schema::schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    jsonschema::draft202012::new(&schema).unwrap()
}

fn of_toml(text: &str) -> Value {
    toml::from_str(text).unwrap()
}

/// Every example, as TOML and converted to JSON, is accepted by the schema and by the reader.
#[test]
fn every_example_is_valid() {
    let validator = validator();
    for (_, path) in example_studies().iter().filter(|(_, path)| path.extension().is_some_and(|end| end == "toml")) {
        let value = of_toml(&std::fs::read_to_string(path).unwrap());
        let errors: Vec<String> = validator.iter_errors(&value).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", path.display());
        Study::read(path).unwrap();
        // Read as JSON, among copies of the files that it names.
        let root = tempfile::tempdir().unwrap();
        let beside = root.path().join("examples/copy");
        std::fs::create_dir_all(&beside).unwrap();
        std::os::unix::fs::symlink(repository("adapters"), root.path().join("adapters")).unwrap();
        for other in std::fs::read_dir(path.parent().unwrap()).unwrap() {
            let other = other.unwrap();
            std::fs::copy(other.path(), beside.join(other.file_name())).unwrap();
        }
        let json = beside.join("study.json");
        std::fs::write(&json, value.to_string()).unwrap();
        Study::read(&json).unwrap();
    }
}

const REST: &str = "[characteristics]\ny = { formula = \"a\" }\n";

/// All forms of a key.
#[test]
fn every_form_is_valid() {
    let validator = validator();
    for dimension in [
        "{ nominal = 10 }",
        "{ nominal = 10.0, tolerance = 0.3, unit = \"mm\" }",
        "{ nominal = 10.0, tolerance = [-0.1, 0.3] }",
        "{ nominal = 10.0, limits = [9, 11], cp = 1.33 }",
        "{ nominal = 10.0, tolerance = 0.3, distribution = \"uniform\" }",
        "{ nominal = 10.0, tolerance = 0.3, distribution = { kind = \"normal\" } }",
        "{ nominal = 10.0, sigma = 0.1, shift = 0.05, step = 1.5 }",
        "{ nominal = 10, moments = [1, 0, 3, 0, 15, 0, 105] }",
        "{ nominal = 10, fit = \"H7\", unit = \"mm\" }",
        "{ nominal = [10, 20], position = 0.2 }",
        "{ nominal = 10, tolerance = \"2 %\" }",
        "{ nominal = 10, tolerance = [\"-1%\", 0.3] }",
        "{ measured = \"a.csv\", column = \"d\", model = \"pearson\" }",
        "{ nominal = 10, tolerance = 0.3, distribution = { kind = \"beta\", alpha = 2, beta = 5.5 } }",
        "{ nominal = 10, tolerance = 0.3, distribution = { kind = \"mixture\", parts = { a = { weight = 1 }, b = { weight = 2, distribution = \"uniform\" } } } }",
    ] {
        let text = format!("\"$schema\" = \"study.schema.json\"\n[dimensions]\na = {dimension}\n{REST}");
        assert!(validator.is_valid(&of_toml(&text)), "{dimension}");
        // The file does not exist, and a position declares two dimensions instead of `a`.
        if !dimension.contains("measured") && !dimension.contains("position") {
            Study::from_toml(&text, "study.toml").unwrap();
        }
    }
    for analysis in [
        "method = \"six-n\"\npairs = [[\"a\", \"b\"]]",
        "method = \"six-n\"\npairs = \"adjacent\"\nstencil = \"four-point\"",
        "method = \"dimension-reduction\"\nnodes = 7",
        "method = \"three-point\"",
        "method = \"response-surface\"\nstep = 1.5",
        "extremes = true\nbudget = 100\nseed = 1\nsensitivities = \"all\"",
    ] {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, sigma = 1 }}\nb = {{ nominal = 1, sigma = 1 }}\n[characteristics]\ny = {{ formula = \"a*b\" }}\n[analysis]\n{analysis}\n"
        );
        assert!(validator.is_valid(&of_toml(&text)), "{analysis}");
        Study::from_toml(&text, "study.toml").unwrap();
    }
}

/// Sections that only some studies have.
#[test]
fn every_section_is_valid() {
    let text = "[dimensions]\na = { nominal = 3, tolerance = 0.1 }\nb = { nominal = 4, tolerance = 0.1 }\n\
                [unknowns]\nc = 5\nphi = { start = 0.9, lower = 0 }\nd = { start = 1 }\n\
                [equations]\nsquare = \"d^2 - a/3\"\n\
                [loops]\ntriangle = [ { length = \"a\", angle = 0 }, { length = \"b\", angle = \"pi/2\" }, { length = \"-c\", angle = \"phi\" } ]\n\
                [characteristics]\nc = {}\ny = { formula = \"d + phi\" }\n\
                [[correlation]]\nbetween = [\"a\", \"b\"]\nvalue = 0.5\n[analysis]\nderivatives = \"exact\"\n";
    assert!(validator().is_valid(&of_toml(text)));
    Study::from_toml(text, "study.toml").unwrap();
}

/// A study that the schema refuses is also refused by the reader.
#[test]
fn wrong_studies_are_invalid() {
    let validator = validator();
    let dimension = |line: &str| format!("[dimensions]\na = {line}\n{REST}");
    let with = |section: &str| format!("{section}\n[dimensions]\na = {{ nominal = 1, tolerance = 0.1 }}\n{REST}");
    let wrong = [
        dimension("{ nominal = \"10\" }"),
        dimension("{ nominal = 10, tolerence = 0.3 }"),
        dimension("{ nominal = 10, tolerance = -0.3 }"),
        dimension("{ nominal = 10, tolerance = [0.1] }"),
        dimension("{ nominal = 10, tolerance = [-0.1, 0.2, 0.3] }"),
        dimension("{ nominal = 10, tolerance = \"0.3\" }"),
        dimension("{ nominal = 10, tolerance = 0.1, distribution = \"uniformly\" }"),
        dimension("{ nominal = 10, tolerance = 0.1, distribution = { kind = \"normal\", alpha = 2 } }"),
        dimension("{ nominal = 10, moments = [1, 0, 3] }"),
        dimension("10"),
        with("titel = \"gap\""),
        with("title = 5"),
        with("[constants]\ng = \"10\""),
        with("[formulas]\nf = 10"),
        with("[analysis]\nmethod = \"seven-n\""),
        with("[analysis]\nextremes = \"yes\""),
        with("[analysis]\nbudget = -1"),
        with("[analysis]\npairs = [[\"a\"]]"),
        with("[analysis]\nstencil = \"nine\""),
        with("[analysis]\nmethod = \"dimension-reduction\"\nnodes = 4"),
        with("[analysis]\nsensitivities = \"none\""),
        dimension("{ nominal = 10, tolerance = 0.1, distribution = { kind = \"beta\", alpha = 2, gamma = 3 } }"),
        dimension("{ nominal = 10, tolerance = \"two percent\" }"),
        with("[unknowns]\nu = { lower = 0 }\n[equations]\ne = \"u - a\""),
        with("[equations]\ne = 5"),
        with("[unknowns]\nu = 1\n[loops]\nl = [ { length = \"u\" } ]"),
        with("[[correlation]]\nbetween = [\"a\", \"b\"]"),
        with("[correlation]\nbetween = [\"a\", \"b\"]\nvalue = 0.5"),
        with("[analysis]\nderivatives = \"guessed\""),
        with("[model]\nbuiltin = \"engine\""),
        with("[model]\nworkers = 2"),
        with("[model]\nbuiltin = \"engine-balance\"\ncommand = [\"python3\"]"),
        with("[model]\ncommand = \"python3 gap.py\""),
        "[dimensions]\na = { nominal = 1 }\n".to_owned(),
        REST.to_owned(),
        "[dimensions]\na = { nominal = 1 }\n[characteristics]\ny = { formula = 5 }\n".to_owned(),
        "[dimensions]\na = { nominal = 1 }\n[characteristics]\ny = { formula = \"a\", limit = 5 }\n".to_owned(),
    ];
    for text in wrong {
        assert!(!validator.is_valid(&of_toml(&text)), "{text}");
        assert!(Study::from_toml(&text, "study.toml").is_err(), "{text}");
    }
    // JSON has a null, which is not a value of any key.
    let null = serde_json::json!({ "dimensions": { "a": { "nominal": null } }, "characteristics": { "y": { "formula": "a" } } });
    assert!(!validator.is_valid(&null) && Study::from_json(&null.to_string(), "study.json").is_err());
}

/// Every key has a description, which editors show.
#[test]
fn every_key_is_described() {
    fn walk(value: &Value, path: &str) {
        if let Some(properties) = value.get("properties").and_then(Value::as_object) {
            for (name, property) in properties {
                assert!(property["description"].as_str().is_some_and(|text| !text.is_empty()), "{path}.{name}");
            }
        }
        match value {
            Value::Object(object) => object.iter().for_each(|(name, inner)| walk(inner, &format!("{path}.{name}"))),
            Value::Array(items) => items.iter().for_each(|inner| walk(inner, path)),
            _ => {}
        }
    }
    walk(&sensitol_study::schema::schema(), "");
}

/// The default in the schema is the value of a study without the key.
#[test]
fn defaults_are_what_is_left_out() {
    let schema = sensitol_study::schema::schema();
    let read = |dimension: &Value, analysis: &Value| {
        let study = serde_json::json!({
            "dimensions": { "a": dimension, "b": { "nominal": 2, "tolerance": 0.1 }, "c": { "nominal": 1 } },
            "characteristics": { "y": { "formula": "a*b + c" } },
            "analysis": analysis,
        });
        Study::from_json(&study.to_string(), "study.json").unwrap_or_else(|error| panic!("{study}: {error}"))
    };
    let with = |base: &Value, key: &str, value: &Value| {
        let mut table = base.clone();
        table[key] = value.clone();
        table
    };
    let defaults = |entry: &str| -> Vec<(String, Value)> {
        let keys = schema["$defs"][entry]["properties"].as_object().unwrap();
        keys.iter().filter_map(|(key, value)| Some((key.clone(), value.get("default")?.clone()))).collect()
    };
    let plain = serde_json::json!({ "nominal": 1, "tolerance": 0.3 });
    let of_dimension = defaults("DimensionEntry");
    assert_eq!(
        of_dimension.iter().map(|(key, _)| key.as_str()).collect::<Vec<_>>(),
        ["distribution", "model", "shift", "sigmas"]
    );
    for (key, value) in of_dimension.iter().filter(|(key, _)| key != "model") {
        let (with, without) =
            (read(&with(&plain, key, value), &serde_json::json!({})), read(&plain, &serde_json::json!({})));
        assert_eq!(format!("{:?}", with.problem.dimensions()), format!("{:?}", without.problem.dimensions()), "{key}");
    }
    let of_analysis = defaults("AnalysisEntry");
    assert_eq!(of_analysis.len(), 8, "{of_analysis:?}");
    for (key, value) in of_analysis {
        let base = match key.as_str() {
            "nodes" => serde_json::json!({ "method": "dimension-reduction" }),
            _ => serde_json::json!({}),
        };
        let found = |analysis: &Value| {
            let study = read(&plain, analysis);
            let analysis = sensitol::analyze(&study.problem, &study.options).unwrap();
            (study.options.method, analysis.run.evaluations, format!("{:?}", analysis.characteristics))
        };
        assert_eq!(found(&with(&base, &key, &value)), found(&base), "{key}");
    }
}
