//! Expands `[[joint]]`: copies the file of measured rows, or the distribution of a zone's coordinates, to the dimensions themselves.

use crate::build::zone::{OF_BALL, OF_DISC, OF_RIM};
use crate::expand::{Expanded, Tree, Value};
use crate::tree::Key;

/// Gives the dimensions of every block the keys that the block determines. Faults of a block are reported where it is read.
pub(super) fn expand(expanded: &mut Expanded) {
    let Some(Value::Array(blocks)) = expanded.tree.get("joint").map(|list| list.value.clone()) else { return };
    for block in &blocks {
        let Some(Value::Array(of)) = block.get("of").map(|of| &of.value) else { continue };
        let names: Vec<String> = (of.iter())
            .filter_map(|name| match &name.value {
                Value::Text(name) => Some(name.clone()),
                _ => None,
            })
            .collect();
        let given = |name: &str| block.get(name).filter(|given| matches!(given.value, Value::Text(_)));
        match (given("measured"), given("law")) {
            (Some(file), None) => {
                for name in &names {
                    let Some(line) = line(&mut expanded.tree, name) else { continue };
                    if line.iter().all(|(key, _)| key.name != "measured") {
                        line.push((key("measured", file), file.clone()));
                        if line.iter().all(|(key, _)| key.name != "column") {
                            let column = Tree { span: file.span.clone(), value: Value::Text(name.clone()) };
                            line.push((key("column", file), column));
                        }
                    }
                }
            }
            // Other faults are reported where the block is read. A fault of a distribution that the study does not contain would confuse.
            (None, Some(law)) if names.len() == 2 || names.len() == 3 => {
                for (coordinate, name) in names.iter().enumerate() {
                    let Some(distribution) = distribution(law, coordinate) else { continue };
                    let Some(line) = line(&mut expanded.tree, name) else { continue };
                    let spread = ["distribution", "measured", "moments", "position"];
                    let bands = ["tolerance", "limits", "fit"];
                    let has = |keys: &[&str]| line.iter().any(|(key, _)| keys.contains(&key.name.as_str()));
                    if has(&bands) && !has(&spread) {
                        line.push((key("distribution", law), distribution.clone()));
                    }
                }
            }
            _ => {}
        }
    }
}

fn key(name: &str, at: &Tree) -> Key {
    Key { span: at.span.clone(), name: name.to_owned() }
}

/// Keys of a dimension.
fn line<'t>(tree: &'t mut Tree, name: &str) -> Option<&'t mut Vec<(Key, Tree)>> {
    tree.get_mut("dimensions")?.get_mut(name)?.entries_mut()
}

/// Distribution of a coordinate of a zone. Returns None for an unknown zone.
fn distribution(law: &Tree, coordinate: usize) -> Option<Tree> {
    let Value::Text(name) = &law.value else { return None };
    let at = |value| Tree { span: law.span.clone(), value };
    let beta = |exponent: f64| {
        let exponents = ["alpha", "beta"].map(|name| (key(name, law), at(Value::Number(exponent))));
        let kind = (key("kind", law), at(Value::Text("beta".into())));
        at(Value::Table([kind].into_iter().chain(exponents).collect()))
    };
    match name.as_str() {
        "disc" => Some(beta(OF_DISC)),
        "rim" => Some(beta(OF_RIM)),
        "diamond" => Some(at(Value::Text("triangular".into()))),
        "ball" => Some(beta(OF_BALL)),
        "bicone" if coordinate > 0 => Some(at(Value::Text("bicone".into()))),
        "octahedron" | "bicone" => Some(at(Value::Text("octahedron".into()))),
        _ => None,
    }
}
