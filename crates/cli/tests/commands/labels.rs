//! Descriptions, parts and drawings of dimensions and characteristics: where they are shown, and that nothing loses them.
//!
//! Oracle: the texts as written, and the report of the same study without them.

use serde_json::{Value, json};

use super::command::sensitol;

const PLAIN: &str = "[dimensions]\n\"housing depth\" = { nominal = 84.6, tolerance = 0.1, unit = \"mm\", LABELS }\n\
                     lip = { nominal = 4, tolerance = 0.05, unit = \"mm\" }\n[characteristics]\n\
                     play = { formula = \"`housing depth` - lip\", unit = \"mm\", lower = 80.3, ABOUT }\n";
const LABELS: &str = "description = \"bored <after> assembly, \\\"100 %\\\"\", part = \"housing\", drawing = \"4711\", revision = \"B\", feature = \"12\"";
const KEYS: [&str; 5] = ["description", "part", "drawing", "revision", "feature"];

fn run(arguments: &[&str]) -> String {
    let output = sensitol(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Writes studies with these texts as `0.toml` and so on, and returns their paths.
fn studies(texts: &[&str]) -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let write = |(place, text): (usize, &&str)| {
        let path = folder.path().join(format!("{place}.toml")).to_str().unwrap().to_owned();
        std::fs::write(&path, text).unwrap();
        path
    };
    let paths = texts.iter().enumerate().map(write).collect();
    (folder, paths)
}

fn labelled() -> String {
    PLAIN.replace("LABELS", LABELS).replace("ABOUT", "description = \"axial play\", drawing = \"4700\"")
}

fn json_of(path: &str) -> Value {
    serde_json::from_str(&run(&["analyze", path, "-m", "full", "--json"])).unwrap()
}

#[test]
fn reports_show_labels_and_numbers_stay() {
    let plain = PLAIN.replace(", LABELS", "").replace(", ABOUT", "");
    let (folder, paths) = studies(&[&labelled(), &plain]);
    let (mut with, mut without) = (json_of(&paths[0]), json_of(&paths[1]));
    let expected = ["bored <after> assembly, \"100 %\"", "housing", "4711", "B", "12"];
    for (key, text) in KEYS.into_iter().zip(expected) {
        assert_eq!(with["dimensions"][0][key], json!(text));
        // A missing label is left out, so that old reports stay unchanged.
        assert!(with["dimensions"][1].get(key).is_none() && without["dimensions"][0].get(key).is_none());
    }
    assert_eq!(with["characteristics"][0]["description"], json!("axial play"));
    for report in [&mut with, &mut without] {
        for key in ["study_sha256", "wall_s", "in_model_s"] {
            report.as_object_mut().unwrap().remove(key);
        }
        for list in ["dimensions", "characteristics"] {
            let one = report[list][0].as_object_mut().unwrap();
            KEYS.iter().for_each(|key| drop(one.remove(*key)));
        }
    }
    assert_eq!(with, without);
    // In the text report a label stands below the characteristic; -v prints all labels.
    let short = run(&["analyze", &paths[0], "-m", "full", "--color", "never"]);
    assert!(short.contains("\n  axial play, drawing 4700\n") && !short.contains("4711"), "{short}");
    let long = run(&["analyze", &paths[0], "-m", "full", "--color", "never", "-v"]);
    let row = long.lines().find(|line| line.contains("4711")).unwrap_or_else(|| panic!("{long}"));
    assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["housing", "depth", "housing", "4711", "B", "12"]);
    assert!(!run(&["analyze", &paths[1], "-m", "full", "--color", "never", "-v"]).contains("drawing"));
    // The page, in which no label is markup, and CSV.
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    run(&["analyze", &paths[0], "-m", "full", "--html", &at("page.html"), "--csv", &at("tables")]);
    let page = std::fs::read_to_string(at("page.html")).unwrap();
    assert!(page.contains("bored &lt;after&gt; assembly") && !page.contains("<after>"));
    let csv = std::fs::read_to_string(at("tables/dimensions.csv")).unwrap();
    assert!(csv.lines().next().unwrap().ends_with("sigma,description,part,drawing,revision,feature"), "{csv}");
    assert!(csv.contains("\"bored <after> assembly, \"\"100 %\"\"\",housing,4711,B,12"), "{csv}");
    let csv = std::fs::read_to_string(at("tables/characteristics.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().ends_with(",axial play,,4700,,"), "{csv}");
}

#[test]
fn written_studies_keep_labels() {
    let element = "[dimensions]\nA = { nominal = 10.2, tolerance = 0.1, part = \"plate\" }\nB = { nominal = 10, tolerance = 0.1 }\n\
                   h = { nominal = [50, 30], position = { zone = 0.2, hole = \"A\", at = \"MMC\" }, drawing = \"4711\", feature = \"7\" }\n\
                   ds = { float = { hole = \"A\", pin = \"B\", law = \"uniform\" }, part = \"cover\", description = \"play\" }\n\
                   t = { flatness = 0.05, revision = \"C\" }\nx2 = { nominal = 4, tolerance = 0.1, from = \"A\", feature = \"9\" }\n\
                   [characteristics]\ny = { formula = \"h_x + ds + t + x2\", part = \"all\" }\n";
    let (folder, paths) = studies(&[element, &labelled()]);
    let expanded = run(&["expand", &paths[0]]);
    std::fs::write(&paths[0], &expanded).unwrap();
    let report = json_of(&paths[0]);
    let of = |key: &str, text: &str| -> Vec<String> {
        let all = report["dimensions"].as_array().unwrap().iter();
        all.filter(|one| one[key] == text).map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    // Both coordinates of a position, the single input of a play, and the own part of a relative dimension.
    assert_eq!(of("feature", "7").len(), 2, "{expanded}");
    assert_eq!(of("drawing", "4711"), of("feature", "7"));
    assert_eq!((of("part", "cover").len(), of("description", "play").len()), (1, 1), "{expanded}");
    assert_eq!((of("revision", "C"), of("feature", "9")), (vec!["t".to_owned()], vec!["x2.own".to_owned()]));
    assert_eq!(report["characteristics"][0]["part"], json!("all"));
    // A study that `allocate` writes.
    let costs = "[costs]\n\"housing depth\" = { model = \"reciprocal\", a = 1, b = 0.1, min = 0.02, max = 0.2 }\n";
    std::fs::write(
        &paths[1],
        labelled().replace("ABOUT", "").replace("lower = 80.3", "lower = 80.4, target_yield = 0.99") + costs,
    )
    .unwrap();
    let written = folder.path().join("written.toml").to_str().unwrap().to_owned();
    run(&["allocate", &paths[1], "-m", "full", "--write", &written]);
    let text = std::fs::read_to_string(&written).unwrap();
    assert!(text.contains(LABELS) && text != std::fs::read_to_string(&paths[1]).unwrap(), "{text}");
}

#[test]
fn a_label_is_text() {
    let wrong = PLAIN.replace("LABELS", "drawing = 4711").replace(", ABOUT", "");
    let blank = PLAIN.replace("LABELS", "drawing = \" \"").replace(", ABOUT", "");
    let unknown = PLAIN.replace("LABELS", "drawng = \"4711\"").replace(", ABOUT", "");
    let (_folder, paths) = studies(&[&wrong, &blank, &unknown]);
    let error = |path: &str| String::from_utf8(sensitol(&["check", path]).output().unwrap().stderr).unwrap();
    let text = error(&paths[0]);
    assert!(text.contains("drawing") && text.contains("4711") && text.contains("text"), "{text}");
    assert!(error(&paths[2]).contains("did you mean `drawing`?"), "{}", error(&paths[2]));
    assert!(json_of(&paths[1])["dimensions"][0].get("drawing").is_none());
}
