//! Expands groups of equal parts: `disc = { nominal = 2, tolerance = 0.1, count = 4 }` is four dimensions `disc.1` to `disc.4`, which vary
//! independently, and `sum(disc)` in a formula adds them up.
//!
//! The sum becomes a formula of its own. Its name has the length of the call in bytes, so that places in formulas stay.

use std::ops::Range;

use crate::error::{Faults, StudyFault, fault};
use crate::expand::{Expanded, Origin, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol::assembly::formula::Formula;

/// Greatest number of equal parts: more are a typing error.
const MOST: i64 = 1000;
/// Ending of the name of the formula that adds a group up: three bytes, so that the name in backquotes is as long as `sum(..)`.
const SUM: &str = ".\u{3a3}";
/// Sections with formulas.
const FORMULAS: [&str; 3] = ["characteristics", "formulas", "equations"];

/// A group of equal parts.
struct Group {
    name: String,
    count: i64,
    span: Range<usize>,
    from: Range<usize>,
}

/// Replaces every group by its dimensions and the formula of their sum.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let mut faults = Faults::default();
    let groups = groups(&expanded.tree, &mut faults);
    faults.none()?;
    if groups.is_empty() {
        return Ok(());
    }
    let mut faults = Faults::default();
    for section in FORMULAS {
        let Some(entries) = expanded.tree.get_mut(section).and_then(Tree::entries_mut) else { continue };
        for (name, entry) in entries {
            let is_text = section != "characteristics" && matches!(entry.value, Value::Text(_));
            let text = match is_text {
                true => Some(entry),
                false => entry
                    .entries_mut()
                    .and_then(|keys| keys.iter_mut().find(|(key, _)| key.name == "formula").map(|(_, text)| text)),
            };
            if let Some(text) = text {
                rewrite(text, &groups, &format!("{section}.{}", name.name), &mut faults);
            }
        }
    }
    faults.none()?;
    for group in &groups {
        replace(expanded, group);
    }
    Ok(())
}

/// Dimensions with the key `count`.
fn groups(tree: &Tree, faults: &mut Faults) -> Vec<Group> {
    let mut found = Vec::new();
    for (key, entry) in tree.get("dimensions").map_or(&[][..], Tree::entries) {
        let Some(count) = entry.get("count") else { continue };
        let at = format!("dimensions.{}.count", key.name);
        match count.value {
            Value::Integer(value) if (1..=MOST).contains(&value) => found.push(Group {
                name: key.name.clone(),
                count: value,
                span: key.span.clone(),
                from: count.span.clone(),
            }),
            Value::Integer(value) => {
                let outside = StudyFault::OutOfRange { value: value as f64, range: "1 to 1000" };
                faults.0.push(fault(count.span.clone(), at, outside));
            }
            _ => faults.0.push(wrong_type(count, at, "a number of equal parts such as 4")),
        }
    }
    found
}

/// Replaces `sum(group)` in a formula. A group elsewhere in it is a fault.
fn rewrite(tree: &mut Tree, groups: &[Group], at: &str, faults: &mut Faults) {
    let Value::Text(text) = &mut tree.value else { return };
    for group in groups {
        for called in [group.name.clone(), format!("`{}`", group.name)] {
            *text = with_sums(text, &called, &group.name);
        }
    }
    let Ok(formula) = Formula::parse(text) else { return };
    let names: Vec<String> = formula.names().map(|(name, _)| name.to_owned()).collect();
    for group in groups.iter().filter(|group| names.contains(&group.name)) {
        let found = StudyFault::GroupName { name: group.name.clone(), count: group.count };
        faults.0.push(fault(tree.span.clone(), at, found));
    }
}

/// Formula with the name of the sum in place of every `sum(called)`, padded to its length.
fn with_sums(text: &str, called: &str, name: &str) -> String {
    let mut written = String::new();
    let mut rest = text;
    while let Some(start) = rest.find("sum") {
        let (before, call) = rest.split_at(start);
        let inside = call["sum".len()..].trim_start().strip_prefix('(').map(str::trim_start);
        let behind = inside.and_then(|inside| inside.strip_prefix(called)).map(str::trim_start);
        let behind = behind.and_then(|behind| behind.strip_prefix(')'));
        let word = before.chars().next_back().is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != '`');
        written += before;
        match behind.filter(|_| word) {
            Some(behind) => {
                let sum = format!("`{name}{SUM}`");
                let length = call.len() - behind.len();
                written += &format!("{sum}{}", " ".repeat(length.saturating_sub(sum.len())));
                rest = behind;
            }
            None => {
                written += "sum";
                rest = &call["sum".len()..];
            }
        }
    }
    written + rest
}

/// Puts the dimensions of a group in its place, and adds the formula of their sum.
fn replace(expanded: &mut Expanded, group: &Group) {
    let names: Vec<String> = (1..=group.count).map(|number| format!("{}.{number}", group.name)).collect();
    let Some(dimensions) = expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut) else { return };
    let Some(place) = dimensions.iter().position(|(key, _)| key.name == group.name) else { return };
    let (_, mut entry) = dimensions.remove(place);
    if let Some(keys) = entry.entries_mut() {
        keys.retain(|(key, _)| key.name != "count");
    }
    let key = format!("dimensions.{}", group.name);
    for (index, name) in names.iter().enumerate() {
        dimensions.insert(place + index, (Key { span: group.span.clone(), name: name.clone() }, entry.clone()));
        let (name, key, span) = (name.clone(), key.clone(), group.span.clone());
        expanded.origins.push(Origin { section: "dimensions", name, key, span });
    }
    let sum = format!("{}{SUM}", group.name);
    let text = names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(" + ");
    if let Some(formulas) = expanded.tree.section("formulas") {
        let formula = Tree { span: group.from.clone(), value: Value::Text(text) };
        formulas.push((Key { span: group.span.clone(), name: sum.clone() }, formula));
    }
    expanded.origins.push(Origin { section: "formulas", name: sum.clone(), key, span: group.span.clone() });
    expanded.elements.made.push(sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_replaced_at_their_places() {
        let of = |text: &str, called: &str| with_sums(text, called, "disc");
        assert_eq!(of("a - sum(disc) - b", "disc"), "a - `disc.\u{3a3}` - b");
        assert_eq!(of("sum( disc )*2", "disc"), "`disc.\u{3a3}`  *2");
        assert_eq!(of("sum(`disc`)", "`disc`"), "`disc.\u{3a3}`  ");
        for text in ["sum(discs)", "checksum(disc)", "sum + disc", "sum(a)"] {
            assert_eq!(of(text, "disc"), text);
        }
        let text = "a - sum(disc) - b";
        assert_eq!(of(text, "disc").len(), text.len());
    }
}
