//! Assemblies in space on the command line: poses at points, and the same study behind an external process.

use std::io::Write;
use std::process::Stdio;

use serde_json::{Value, json};

use super::command::{run, sensitol};
use sensitol_testing::{close, read, repository};

const CRANK: &str = "examples/crank-slider-space/study.toml";

fn report(arguments: &[&str]) -> (Value, Option<i32>) {
    let output = sensitol(arguments).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {text}")), output.status.code())
}

fn vector(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().unwrap())
}

/// A vector that is turned by a rotation vector (Rodrigues' formula).
fn turned(w: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let angle = w.iter().map(|part| part * part).sum::<f64>().sqrt();
    if angle == 0.0 {
        return v;
    }
    let k = w.map(|part| part / angle);
    let (sine, cosine) = angle.sin_cos();
    let along: f64 = (0..3).map(|i| k[i] * v[i]).sum();
    let cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]];
    [0, 1, 2].map(|i| v[i] * cosine + cross[i] * sine + k[i] * along * (1.0 - cosine))
}

/// Place of the slider by the closed form of the loop.
fn slider(l: f64, th: f64) -> f64 {
    let th = th.to_radians();
    15.0 * th.cos() + (l * l - (15.0 * th.sin() - 5.0).powi(2) - 144.0).sqrt()
}

#[test]
fn evaluate_gives_the_pose_of_every_part() {
    let (found, code) = report(&["evaluate", CRANK, "--at", "nominal", "--at", "th=80,L=61", "--json"]);
    assert_eq!(
        (code, found["command"].as_str(), found["length_unit"].as_str()),
        (Some(0), Some("evaluate"), Some("mm"))
    );
    for (point, [l, th]) in found["points"].as_array().unwrap().iter().zip([[60.0, 35.0], [61.0, 80.0]]) {
        let x = slider(l, th);
        close(point["characteristics"][0]["value"].as_f64().unwrap(), x, 1e-11, 1.0);
        let parts = point["parts"].as_array().unwrap();
        let part = |name: &str| parts.iter().find(|part| part["name"] == name).unwrap();
        assert_eq!(parts.len(), 4);
        let crank = vector(&part("crank")["rotation"]);
        for (found, expected) in crank.iter().zip([0.0, 0.0, th.to_radians()]) {
            close(*found, expected, 1e-11, 1.0);
        }
        for (found, expected) in vector(&part("slider")["translation"]).iter().zip([x, 5.0, 0.0]) {
            close(*found, expected, 1e-10, 1.0);
        }
        // The link begins at the ball of the crank, and its far end is the ball of the slider.
        let (rotation, origin) = (vector(&part("link")["rotation"]), vector(&part("link")["translation"]));
        let begin = [15.0 * th.to_radians().cos(), 15.0 * th.to_radians().sin(), 20.0];
        let far = turned(rotation, [l, 0.0, 0.0]);
        for i in 0..3 {
            close(origin[i], begin[i], 1e-10, 1.0);
            close(origin[i] + far[i], [x, 5.0, 8.0][i], 1e-9, 1.0);
        }
        assert_eq!(vector(&part("base")["rotation"]), [0.0; 3]);
    }
}

/// Converted units change neither values nor poses.
#[test]
fn poses_are_in_the_unit_of_the_study() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, format!("units = \"convert\"\n{}", read(CRANK))).unwrap();
    let (plain, _) = report(&["evaluate", CRANK, "--at", "th=50", "--json"]);
    let (converted, _) = report(&["evaluate", path.to_str().unwrap(), "--at", "th=50", "--json"]);
    assert_eq!(converted["length_unit"], "mm");
    for part in 0..4 {
        for key in ["rotation", "translation"] {
            let [a, b] = [&plain, &converted].map(|found| vector(&found["points"][0]["parts"][part][key]));
            (0..3).for_each(|i| close(b[i], a[i], 1e-10, 60.0));
        }
    }
}

#[test]
fn evaluate_prints_a_table() {
    let text = run(&["evaluate", CRANK, "--at", "th=90"]);
    assert!(text.starts_with("exit 0"), "{text}");
    assert!(
        text.contains("th = 90")
            && text.contains("x = ")
            && text.contains("poses: rotation vector in rad, origin in mm"),
        "{text}"
    );
    let crank = text.lines().find(|line| line.trim_start().starts_with("crank")).unwrap();
    assert!(crank.contains("1.570796"), "{text}");
    // A study without parts has values only.
    let text = run(&["evaluate", "examples/stacked-blocks/study.toml", "--at", "R=40.1"]);
    assert!(text.contains("gap = ") && !text.contains("poses"), "{text}");
}

#[test]
fn wrong_points_are_refused() {
    let text = run(&["evaluate", CRANK, "--at", "tth=3"]);
    assert!(
        text.starts_with("exit 2") && text.contains("no dimension `tth`") && text.contains("did you mean `th`"),
        "{text}"
    );
    for wrong in ["th", "th=", "th=x", "=3", "th=1,th=2", "th=inf"] {
        let text = run(&["evaluate", CRANK, "--at", wrong]);
        assert!(text.starts_with("exit 2"), "{wrong}: {text}");
    }
}

/// A point at which the joints do not close has neither values nor poses, and the joint is named.
#[test]
fn a_point_without_a_solution_has_no_poses() {
    let (found, code) = report(&["evaluate", CRANK, "--at", "L=9", "--json"]);
    assert_eq!(code, Some(3));
    let point = &found["points"][0];
    assert_eq!(point["characteristics"][0]["value"], Value::Null);
    let error = point["characteristics"][0]["error"].as_str().unwrap();
    assert!(error.starts_with("the joints do not close: joint `"), "{error}");
    assert!(point["parts"].as_array().unwrap().iter().all(|part| part["rotation"].is_null()), "{point}");
}

/// The protocol gives poses to a program that asks for them, and none to others.
#[test]
fn the_protocol_has_poses_on_demand() {
    let answers = |poses: Option<bool>| {
        let mut hello = json!({ "sensitol": 1, "dimensions": ["th"], "characteristics": ["x"] });
        poses.iter().for_each(|poses| hello["poses"] = (*poses).into());
        let mut child = sensitol(&["evaluate", CRANK]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        writeln!(stdin, "{hello}\n{}", json!({ "id": 1, "x": [35.0] })).unwrap();
        drop(stdin);
        let output = child.wait_with_output().unwrap();
        let lines = String::from_utf8(output.stdout).unwrap();
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect::<Vec<Value>>()
    };
    let with = answers(Some(true));
    assert_eq!(with[0]["length_unit"], "mm");
    let slider = &with[1]["poses"][3];
    assert_eq!(slider["name"], "slider");
    close(slider["translation"][0].as_f64().unwrap(), self::slider(60.0, 35.0), 1e-10, 1.0);
    for without in [answers(None), answers(Some(false))] {
        assert!(without[1].get("poses").is_none() && without[0].get("length_unit").is_none());
    }
}

/// The study in space as the external model of another study gives the analysis of the study itself.
#[test]
fn a_study_behind_a_process_is_the_study() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("behind.toml");
    let program = assert_cmd::cargo::cargo_bin!("sensitol").display().to_string();
    let text = read(CRANK);
    let dimensions = &text[text.find("[dimensions]").unwrap()..text.find("[parts.base]").unwrap()];
    let study = format!(
        "{dimensions}\n[characteristics]\nx = {{ unit = \"mm\", lower = 70.6, upper = 71.4 }}\n[model]\ncommand = [{program:?}, \"evaluate\", {:?}]\n",
        repository(CRANK).display().to_string()
    );
    std::fs::write(&path, study).unwrap();
    let analysed = |path: &str| {
        let (found, code) = report(&["analyze", path, "--method", "full", "--journal", "none", "--json"]);
        assert_eq!(code, Some(0));
        found["characteristics"][0].clone()
    };
    let (direct, behind) = (analysed(CRANK), analysed(path.to_str().unwrap()));
    // The numbers travel with all their digits. Without exact derivatives the slopes beside the means are differences of second order.
    for key in ["mean", "sigma"] {
        close(behind[key].as_f64().unwrap(), direct[key].as_f64().unwrap(), 1e-9, 1.0);
    }
    for (a, b) in behind["sensitivities"].as_array().unwrap().iter().zip(direct["sensitivities"].as_array().unwrap()) {
        assert_eq!(a["dimension"], b["dimension"]);
        close(a["first"].as_f64().unwrap(), b["first"].as_f64().unwrap(), 1e-4, 1.0);
    }
}

#[test]
fn check_tells_the_mobility() {
    let text = run(&["check", CRANK]);
    assert!(text.contains("4 parts, 5 joints: 18 unknowns, 17 equations"), "{text}");
    assert!(
        text.contains("link turns about the line from link.small to link.big: no effect on the characteristics"),
        "{text}"
    );
}
