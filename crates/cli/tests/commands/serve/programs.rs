//! Programs start when the user asks for them, and studies read no file outside the folder.

use serde_json::{Value, json};

use super::{Server, task};

/// Program that leaves a file when it starts.
const PROGRAM: &str = r#"
import json, sys
open("started", "a").write("x")
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        print(json.dumps({"ready": True, "name": "sum"}), flush=True)
        continue
    print(json.dumps({"id": told["id"], "y": [sum(told["x"])]}), flush=True)
"#;
/// Dimensions and characteristic of a study whose model is a program.
const REST: &str = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.1 }\n\
                    [characteristics]\ny = { lower = 13, upper = 15, target_yield = 0.9 }\n";

/// Forms in which TOML writes the key `model.command`, before the rest of a study.
const FORMS: [&str; 9] = [
    "[model]\ncommand = [\"python3\", \"sum.py\"]\n",
    "model.command = [\"python3\", \"sum.py\"] # typed\n",
    "model = { command = [\"python3\", \"sum.py\"] }\n",
    "\"model\".\"command\" = [\"python3\", \"sum.py\"]\n",
    "'model' . 'command' = [\"python3\", \"sum.py\"]\n",
    "\"m\\u006fdel\".\"c\\u006fmmand\" = [\"python3\", \"sum.py\"]\n",
    "[model]\n\"comm\\u0061nd\" = [\n  # First the interpreter.\n  \"python3\",\n  'sum.py',\n]\n",
    "[ \"model\" ]\n# A comment.\ncommand=[\"\"\"python3\"\"\",'''sum.py''']\n",
    "model = { 'command' = [\"python3\", \"sum.py\"], workers = 1 }\n",
];

/// The engine says that a study starts a program, in whatever form the study has it.
#[test]
fn a_program_starts_only_when_it_is_asked_for() {
    let server = Server::with(&[("gap.toml", ""), ("sum.py", PROGRAM)]);
    let started = || server.studies().join("started").exists();
    let of_json = json!({
        "model": { "command": ["python3", "sum.py"] },
        "dimensions": { "a": { "nominal": 10, "tolerance": 0.3 }, "b": { "nominal": 4, "tolerance": 0.1 } },
        "characteristics": { "y": { "lower": 13, "upper": 15, "target_yield": 0.9 } },
    });
    let mut of_json = task(&of_json.to_string(), "gap.toml");
    of_json["format"] = json!("json");
    let commands = [
        json!({ "command": "analyze" }),
        json!({ "command": "simulate", "samples": 10 }),
        json!({ "command": "rare", "samples": 10 }),
        json!({ "command": "compare" }),
        json!({ "command": "sweep", "over": "a", "values": [9.0, 11.0] }),
        json!({ "command": "allocate" }),
    ];
    let tasks = FORMS.iter().map(|form| task(&format!("{form}{REST}"), "gap.toml"));
    for mut task in tasks.chain([of_json]) {
        for command in &commands {
            task["asked"] = command.clone();
            let lines = server.run("gap.toml", &task);
            let found = &lines.last().unwrap()["found"];
            assert_eq!(found["program"], json!(["python3", "sum.py"]), "{task}");
            assert!(found["error"].as_str().unwrap().contains("starts only when it is asked for"), "{found}");
            assert!(found["json"].is_null() && !started(), "{task}");
        }
        let keys = server.answer("POST", &server.at("keys?path=gap.toml"), &[], &task.to_string());
        assert_eq!(keys.json()["program"], json!(["python3", "sum.py"]));
        assert!(!started() && !server.studies().join("gap.journal.sqlite").exists());
    }
    // A word other than yes is no request.
    let analyze = task(&format!("{}{REST}", FORMS[1]), "gap.toml");
    for word in ["", "no", "true", "Yes"] {
        let lines = server.run(&format!("gap.toml&programs={word}"), &analyze);
        assert!(lines.last().unwrap()["found"]["error"].is_string() && !started(), "{word}");
    }
    let lines = server.run("gap.toml&programs=yes", &analyze);
    let found = &lines.last().unwrap()["found"];
    let report: Value = serde_json::from_str(found["json"].as_str().unwrap_or_else(|| panic!("{found}"))).unwrap();
    assert_eq!(report["characteristics"][0]["name"], "y");
    assert_eq!(found["program"], json!(["python3", "sum.py"]));
    assert!(started());
}

/// Studies whose text only looks like a program run at once.
#[test]
fn a_formula_is_no_program() {
    let server = Server::with(&[("gap.toml", "")]);
    let text = "title = \"\"\"\ncommand = ['python3']\"\"\"\n[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n\
                [characteristics]\ny = { formula = \"a\" }\n";
    let lines = server.run("gap.toml", &task(text, "gap.toml"));
    let found = &lines.last().unwrap()["found"];
    assert!(found["json"].is_string() && found["program"].is_null(), "{found}");
}

/// Measured values and files of a model are read within the folder alone.
#[test]
fn no_file_outside_the_folder_is_read() {
    let values = "pin\n7.99\n8.01\n8.02\n7.98\n8.00\n8.01\n7.99\n8.00\n";
    let server = Server::with(&[("in/gap.toml", ""), ("pins.csv", values), ("in/own.csv", values)]);
    let outside = server.folder.path().join("outside.csv");
    std::fs::write(&outside, values.replace("7.99", "secret")).unwrap();
    let measured = |file: &str| {
        format!(
            "[dimensions]\npin = {{ nominal = 8.0, measured = '{file}' }}\nbore = {{ nominal = 8.1, tolerance = 0.03 }}\n\
             [characteristics]\ny = {{ formula = \"bore - pin\" }}\n"
        )
    };
    // The answers of a reading and of a run.
    let both = |text: &str| {
        let task = task(text, "in/gap.toml");
        let keys = server.answer("POST", &server.at("keys?path=in%2Fgap.toml"), &[], &task.to_string()).json();
        [keys, server.run("in%2Fgap.toml&programs=yes", &task).last().unwrap()["found"].clone()]
    };
    let absolute = outside.display().to_string();
    let mut wrong = vec!["../../outside.csv", &absolute];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&outside, server.studies().join("link.csv")).unwrap();
        std::os::unix::fs::symlink(server.folder.path(), server.studies().join("up")).unwrap();
        wrong.extend(["../link.csv", "../up/outside.csv", "/dev/zero"]);
    }
    for file in wrong {
        let refused = |text: &str, key: &str| {
            for answer in both(text) {
                let fault = &answer["faults"][0];
                assert_eq!(fault["key"], key, "{file}: {answer}");
                assert!(fault["fault"].as_str().unwrap().contains("outside the folder"), "{file}: {answer}");
                assert!(!answer.to_string().contains("secret"), "{file}: {answer}");
            }
        };
        refused(&measured(file), "dimensions.pin.measured");
        refused(&format!("[model]\ncommand = [\"python3\"]\nfiles = ['{file}']\n{REST}"), "model.files");
    }
    let inside = server.studies().join("pins.csv").display().to_string();
    for file in ["own.csv", "../pins.csv", &inside] {
        for answer in both(&measured(file)) {
            assert!(answer["faults"].is_null(), "{file}: {answer}");
        }
    }
    // A study in JSON is shown as TOML, for which its files are read.
    let json = json!({
        "dimensions": { "pin": { "nominal": 8, "measured": "../outside.csv" } },
        "characteristics": { "y": { "formula": "2*pin" } },
    });
    std::fs::write(server.studies().join("old.json"), json.to_string()).unwrap();
    let shown = server.get("study?path=old.json");
    assert_eq!(shown.status, 400, "{}", shown.body);
    assert!(shown.body.contains("outside the folder"), "{}", shown.body);
}
