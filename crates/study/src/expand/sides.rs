//! Expands unlike sides: `sigma = [0.1, 0.2]` is a split normal distribution with one sigma below the nominal and one above.

use crate::error::{Faults, StudyFault, fault};
use crate::expand::{Expanded, Tree, Value, wrong_type};
use crate::tree::Key;

/// Kind of distribution with two sigmas.
const KIND: &str = "split-normal";

/// Replaces every pair of sigmas by the distribution that it stands for.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let mut faults = Faults::default();
    let Some(dimensions) = expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut) else { return Ok(()) };
    for (name, entry) in dimensions {
        let Some(sigma) = entry.get("sigma").filter(|sigma| matches!(sigma.value, Value::Array(_))).cloned() else {
            continue;
        };
        let at = format!("dimensions.{}.sigma", name.name);
        let Some([below, above]) = pair(&sigma) else {
            faults.0.push(wrong_type(&sigma, at, "a number, or those below and above the nominal such as [0.1, 0.2],"));
            continue;
        };
        let other = entry.get("distribution").filter(|kind| !matches!(&kind.value, Value::Text(kind) if kind == KIND));
        if other.is_some() {
            let why = "are two ways of giving a distribution: leave one out".to_owned();
            let conflict = StudyFault::Conflict { a: "distribution", b: "sigma", why };
            faults.0.push(fault(sigma.span.clone(), at, conflict));
            continue;
        }
        let key = |name: &str| Key { span: sigma.span.clone(), name: name.to_owned() };
        let kind = Tree { span: sigma.span.clone(), value: Value::Text(KIND.to_owned()) };
        let table = vec![(key("kind"), kind), (key("below"), below), (key("above"), above)];
        let table = Tree { span: sigma.span.clone(), value: Value::Table(table) };
        if let Some(keys) = entry.entries_mut() {
            keys.retain(|(key, _)| key.name != "sigma" && key.name != "distribution");
            keys.push((key("distribution"), table));
        }
    }
    faults.none()
}

/// Two numbers of a list. Returns None for another list.
fn pair(tree: &Tree) -> Option<[Tree; 2]> {
    let Value::Array(items) = &tree.value else { return None };
    let numbers = items.iter().all(|item| matches!(item.value, Value::Number(_) | Value::Integer(_)));
    <[Tree; 2]>::try_from(items.clone()).ok().filter(|_| numbers)
}
