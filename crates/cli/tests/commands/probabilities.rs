//! Every probability in any output lies in [0, 1], and is never NaN or infinite.

use serde_json::Value;

use super::command::sensitol;

/// Studies for which sums and ratios of probabilities were wrong or might be: limits on the far side of the means and out of reach, a
/// value with a jump, one that is undefined at some points, a heavy tail, no variation, a target at the very end.
const STUDIES: [(&str, &str); 7] = [
    ("far-side", "gap = { formula = \"b - a\", lower = 12, upper = 14, target_yield = 0.5 }"),
    ("out-of-reach", "gap = { formula = \"a + b + 1000\", lower = 0, upper = 1034, target_yield = 0.999999 }"),
    ("jump", "gap = { formula = \"a + if(b > 20.9, 12, 0)\", upper = 18, target_yield = 0.999 }"),
    ("edge", "gap = { formula = \"sqrt(a - 9.4) + b\", lower = 19, upper = 21.5, target_yield = 0.99 }"),
    ("heavy", "gap = { formula = \"exp(3*(a - 10) + b - 20)\", lower = 0, upper = 100, target_yield = 0.9973 }"),
    ("constant", "gap = { formula = \"0*a + 0*b + 1\", lower = 0, upper = 2, target_yield = 0.9 }"),
    (
        "two",
        "gap = { formula = \"b - a\", lower = 9, target_yield = 0.9 }\nsum = { formula = \"max(a, b - 10)\", upper = 10.1 }",
    ),
];

/// Arguments of the calls. Each call also gets the study and `--json`, and a folder for CSV if the flag is true.
const CALLS: [(&[&str], bool); 6] = [
    (&["analyze"], true),
    (&["simulate", "--samples", "3000"], true),
    (&["simulate", "--rare", "--samples", "600"], true),
    (&["compare", "--samples", "4096"], true),
    (&["sweep", "--over", "a=9:11:3"], true),
    (&["allocate"], false),
];

fn study(characteristics: &str) -> String {
    format!(
        "[dimensions]\na = {{ nominal = 10, tolerance = 0.9 }}\nb = {{ nominal = 20, tolerance = 0.6 }}\n\n[characteristics]\n\
         {characteristics}\n\n[costs]\na = {{ model = \"reciprocal\", b = 1, min = 0.01, max = 2 }}\n"
    )
}

/// Returns the unit of a key that holds a probability, or None for other keys.
fn scale(key: &str) -> Option<f64> {
    match key {
        "yield" | "target_yield" | "yield_interval" | "yield_bounds" | "probability" | "valid_share" => Some(1.0),
        "ppm" | "ppm_below" | "ppm_above" => Some(1e6),
        _ => None,
    }
}

/// Checks that every number below `value` lies between 0 and `most`. In a figure with an error, only the figure is checked.
fn within(value: &Value, most: f64, at: &str) {
    match value {
        Value::Number(number) => {
            let number = number.as_f64().unwrap();
            assert!((0.0..=most).contains(&number), "{at}: {number}");
        }
        Value::Array(items) => items.iter().for_each(|item| within(item, most, at)),
        Value::Object(fields) => {
            fields.iter().filter(|(key, _)| !key.contains("error")).for_each(|(_, field)| within(field, most, at));
        }
        _ => {}
    }
}

fn check(value: &Value, at: &str) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let at = format!("{at}.{key}");
                // Standard errors and error estimates have the names of the figures that they belong to.
                if key.contains("error") {
                    continue;
                }
                if let Some(most) = scale(key) {
                    within(field, most, &at);
                }
                check(field, &at);
            }
            if fields.get("hits").and_then(Value::as_u64).is_some_and(|hits| hits > 0) {
                let ends = fields["interval"].as_array().unwrap();
                assert!(ends.len() == 2 && ends.iter().all(Value::is_number), "{at}: {ends:?}");
                let [low, high] = [0, 1].map(|end| ends[end].as_f64().unwrap());
                assert!(0.0 <= low && low <= high && high <= 1.0, "{at}: {low} {high}");
            }
        }
        Value::Array(items) => items.iter().for_each(|item| check(item, at)),
        _ => {}
    }
}

/// Checks that no word is the text of a double that is not a finite number.
fn finite(text: &str, at: &str) {
    let odd = |word: &&str| matches!(word.trim_matches(['-', '+']).to_lowercase().as_str(), "nan" | "inf" | "infinity");
    let word = text.split(|c: char| !(c.is_alphanumeric() || "-+.".contains(c))).find(odd);
    assert!(word.is_none(), "{at}: {}\n{text}", word.unwrap_or_default());
}

#[test]
fn every_probability_is_one() {
    let folder = tempfile::tempdir().unwrap();
    for (name, characteristics) in STUDIES {
        let file = folder.path().join(format!("{name}.toml"));
        std::fs::write(&file, study(characteristics)).unwrap();
        let file = file.to_str().unwrap();
        for (index, (call, csv)) in CALLS.iter().enumerate() {
            let at = format!("{name}: {}", call.join(" "));
            let tables = folder.path().join(format!("{name}-{index}"));
            let mut all = vec![call[0], file];
            all.extend(&call[1..]);
            all.push("--json");
            if *csv {
                all.extend(["--csv", tables.to_str().unwrap()]);
            }
            let output = sensitol(&all).output().unwrap();
            // Codes 1, 3 and 4 are results too: a missed target, a partial result, an infeasible requirement.
            let code = output.status.code().unwrap();
            let errors = String::from_utf8(output.stderr).unwrap();
            assert!(code <= 4 && !errors.contains("panicked"), "{at}: {code} {errors}");
            finite(&errors, &at);
            if !output.stdout.is_empty() {
                check(&serde_json::from_slice(&output.stdout).unwrap(), &at);
            }
            for table in std::fs::read_dir(&tables).into_iter().flatten() {
                finite(&std::fs::read_to_string(table.unwrap().path()).unwrap(), &at);
            }
            let mut text = vec![call[0], file];
            text.extend(&call[1..]);
            finite(&String::from_utf8(sensitol(&text).output().unwrap().stdout).unwrap(), &at);
        }
    }
}
