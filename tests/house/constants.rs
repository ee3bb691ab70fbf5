//! Numeric constants: each has a comment of its own that says what it means and where its value comes from.

use super::sources::sources;

const TYPES: [&str; 6] = ["f64", "f32", "usize", "u64", "u32", "i32"];

/// Numeric constants of a file that no comment precedes. Constants of a module within the file are left out: they name the columns of a
/// built-in model, whose table of inputs and outputs says what each is.
fn without_comment(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    let mut in_columns = false;
    for (at, line) in lines.iter().enumerate() {
        in_columns = (in_columns || ["mod input {", "mod output {"].contains(line)) && *line != "}";
        if in_columns {
            continue;
        }
        if line.trim() == "#[cfg(test)]" && lines.get(at + 1).is_some_and(|next| next.ends_with('{')) {
            break;
        }
        let Some(name) = constant(line) else { continue };
        let mut above = lines[..at].iter().rev().skip_while(|line| line.trim_start().starts_with("#["));
        if !above.next().is_some_and(|line| line.trim_start().starts_with("//")) {
            found.push(name);
        }
    }
    found
}

/// The name of the numeric constant that a line defines.
fn constant(line: &str) -> Option<String> {
    let line = line.trim_start();
    let line = ["pub(crate) ", "pub(super) ", "pub "].iter().find_map(|start| line.strip_prefix(start)).unwrap_or(line);
    let (name, rest) = line.strip_prefix("const ")?.split_once(": ")?;
    let (kind, _) = rest.split_once(" =")?;
    TYPES.contains(&kind).then(|| name.to_owned())
}

#[test]
fn every_constant_has_its_reason() {
    let mut lacking = Vec::new();
    for file in sources() {
        lacking.extend(without_comment(&file.text).into_iter().map(|name| format!("{}: {name}", file.name())));
    }
    assert!(lacking.is_empty(), "{} constants without a comment: {lacking:#?}", lacking.len());
}

#[test]
fn constants_are_found_in_every_form() {
    let text = "/// Reason.\nconst A: f64 = 1.0;\npub(crate) const B: usize = 1 << 3;\nfn f() {\n    const C: u64 = 7;\n}\nconst fn g() {}\n";
    assert_eq!(without_comment(text), ["B", "C"]);
}
