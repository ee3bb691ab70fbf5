//! The JSON Schema of study files, with an independent validator: it takes every study that there is and refuses wrong ones.

use jsonschema::Validator;
use sensitol::Study;
use serde_json::Value;

use super::support::repository;

fn validator() -> Validator {
    let schema = sensitol::study::schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    jsonschema::draft202012::new(&schema).unwrap()
}

fn of_toml(text: &str) -> Value {
    toml::from_str(text).unwrap()
}

/// Every example, as TOML and written as JSON: what the schema takes, the reader takes too.
#[test]
fn every_example_is_valid() {
    let validator = validator();
    let mut studies = 0;
    for folder in std::fs::read_dir(repository("examples")).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let value = of_toml(&std::fs::read_to_string(&path).unwrap());
            let errors: Vec<String> = validator.iter_errors(&value).map(|error| error.to_string()).collect();
            assert!(errors.is_empty(), "{}: {errors:?}", path.display());
            Study::read(&path).unwrap();
            if value.get("model").is_none() {
                Study::from_json(&value.to_string(), "study.json").unwrap();
            }
            studies += 1;
        }
    }
    assert!(studies >= 6);
}

const REST: &str = "[characteristics]\ny = { formula = \"a\" }\n";

/// Every form that a key has.
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
    ] {
        let text = format!("\"$schema\" = \"study.schema.json\"\n[dimensions]\na = {dimension}\n{REST}");
        assert!(validator.is_valid(&of_toml(&text)), "{dimension}");
        Study::from_toml(&text, "study.toml").unwrap();
    }
    for analysis in [
        "method = \"six-n\"\npairs = [[\"a\", \"b\"]]",
        "method = \"six-n\"\npairs = \"adjacent\"\nstencil = \"four-point\"",
        "extremes = true\nbudget = 100\nseed = 1\nsensitivities = \"all\"",
    ] {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, sigma = 1 }}\nb = {{ nominal = 1, sigma = 1 }}\n[characteristics]\ny = {{ formula = \"a*b\" }}\n[analysis]\n{analysis}\n"
        );
        assert!(validator.is_valid(&of_toml(&text)), "{analysis}");
        Study::from_toml(&text, "study.toml").unwrap();
    }
}

/// What the schema refuses, the reader refuses.
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
        with("[analysis]\nsensitivities = \"none\""),
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
    // JSON has a null, which is no value of any key.
    let null = serde_json::json!({ "dimensions": { "a": { "nominal": null } }, "characteristics": { "y": { "formula": "a" } } });
    assert!(!validator.is_valid(&null) && Study::from_json(&null.to_string(), "study.json").is_err());
}

/// Whoever edits a study sees what a key is for: every one is described.
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
    walk(&sensitol::study::schema(), "");
}
