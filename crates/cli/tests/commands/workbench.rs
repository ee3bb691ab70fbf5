//! `sensitol workbench`: a study is inserted into the page of web/build. The page itself is tested in a browser.

use std::path::Path;
use std::process::Output;

use super::command::sensitol;
use sensitol_testing::repository;

/// Parts of a page that the command checks.
const PAGE: &str = concat!(
    "<!DOCTYPE html>\n<meta name=\"generator\" content=\"sensitol ",
    env!("CARGO_PKG_VERSION"),
    " workbench\">\n<script type=\"application/json\" id=\"study-data\">null</script>\n"
);

fn within(folder: &Path, arguments: &[&str]) -> Output {
    sensitol(arguments).current_dir(folder).output().unwrap()
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str], said: &str) {
    let output = within(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains(said), "{error}");
}

/// The page holds the study's text and its files, and no text ends the element around it.
#[test]
fn a_study_goes_into_the_page() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("page.html"), PAGE).unwrap();
    let given = |arguments: &[&str]| -> serde_json::Value {
        let output = within(folder.path(), &[&["workbench", "--page", "page.html"], arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let page = std::fs::read_to_string(folder.path().join("workbench.html")).unwrap();
        assert_eq!(page.matches("</script>").count(), 1);
        let data = page.split("id=\"study-data\">").nth(1).unwrap().split("</script>").next().unwrap();
        serde_json::from_str(data).unwrap()
    };
    assert!(given(&[]).is_null());
    let example = repository("examples/measured-pin/study.toml");
    let found = given(&[example.to_str().unwrap()]);
    assert_eq!(found["text"], std::fs::read_to_string(&example).unwrap());
    assert_eq!(found["name"], "study.toml");
    let (name, content) = found["files"].as_object().unwrap().iter().next().unwrap();
    assert_eq!(content, &std::fs::read_to_string(example.parent().unwrap().join(name)).unwrap());
    // A JSON study is inserted as equivalent TOML.
    let hostile = r#"{ "title": "</script><b>", "dimensions": { "a": { "nominal": 1, "tolerance": 0.1 } }, "characteristics": { "y": { "formula": "2*a" } } }"#;
    std::fs::write(folder.path().join("hostile.json"), hostile).unwrap();
    let found = given(&["hostile.json"]);
    assert_eq!(found["name"], "hostile.toml");
    let text = found["text"].as_str().unwrap();
    assert!(text.contains("</script><b>"), "{text}");
    assert_eq!(sensitol_study::Study::from_toml(text, "hostile.toml").unwrap().title.unwrap(), "</script><b>");
}

#[test]
fn what_no_page_can_show_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("page.html", PAGE);
    write("old.html", &PAGE.replace(env!("CARGO_PKG_VERSION"), "0.0.1"));
    write("other.html", "<p>something else</p>");
    write(
        "study.toml",
        "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"2*a\" }\n",
    );
    refused(
        folder.path(),
        &["workbench", "--page", "none.html"],
        "none.html is not a page for `sensitol workbench`: it cannot be read",
    );
    refused(folder.path(), &["workbench", "--page", "other.html"], "it is not a workbench without a study");
    refused(folder.path(), &["workbench", "--page", "old.html"], "its engine is not that of this program");
    refused(
        folder.path(),
        &["workbench", "study.toml", "-o", "study.toml", "--page", "page.html"],
        "which would be lost",
    );
    refused(folder.path(), &["workbench", "-o", "page.html", "--page", "page.html"], "which would be lost");
    let external = repository("examples/external-python/study.toml");
    let arguments = ["workbench", external.to_str().unwrap(), "--page", "page.html"];
    refused(folder.path(), &arguments, "its model is an external program, and a page runs none");
    assert!(!folder.path().join("workbench.html").exists());
}
