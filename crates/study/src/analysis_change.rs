//! Changes of the options of a study.

use crate::build::inflation;
use std::path::Path;
use std::sync::Arc;

use serde_json::Value as Json;

use crate::build::options;
use crate::entries::file::{AnalysisEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Faults, StudyError};
use crate::tree::{Key, Tree, Value};
use crate::{Study, deserializer as de};
use sensitol::method::Method;

impl Study {
    /// The study with the keys of this JSON object in place of its own keys of `[analysis]`, like options of the command line. If the
    /// method changes, the pairs, stencil, nodes and steps of the study are dropped, since it chose them for its own method.
    ///
    /// # Errors
    /// Fails for an unknown key or an impossible value. The error has a key but no place.
    ///
    /// ```
    /// use sensitol::Method;
    /// use sensitol_study::Study;
    /// let text = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n[characteristics]\ny = { formula = \"a^2\" }\n";
    /// let study = Study::from_toml(text, "study.toml")?;
    /// let full = study.with_analysis(r#"{"method": "full", "seed": 7}"#)?;
    /// assert_eq!((full.options.method, full.seed), (Method::Full, Some(7)));
    /// let error = study.with_analysis(r#"{"method": "fool"}"#).unwrap_err();
    /// assert_eq!((error.key.as_str(), error.span), ("analysis.method", None));
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn with_analysis(&self, keys: &str) -> Result<Self, StudyError> {
        let read = || -> Result<(_, _), Faults> {
            let keys = Tree::of_json(keys)?;
            let mut entry: AnalysisEntry = de::read(&keys).map_err(below_analysis)?;
            inflation::only_in_study(&entry)?;
            // Read from the expanded text: the original text may hold geometric elements that are not plain dimensions.
            let own = Tree::of_toml(&self.expanded).ok().map(|tree| de::read::<StudyFile>(&tree)).transpose()?;
            if let Some(own) = own {
                entry = merged(entry, own.analysis);
            }
            Ok((options::options(&entry, &self.problem)?, entry.seed.map(Spanned::into_inner)))
        };
        let (options, seed) = read().map_err(|mut faults| {
            // Places in the given keys are not places in the study.
            faults.0.iter_mut().for_each(|fault| fault.span = None);
            StudyError::of(faults.0, &self.name, &Arc::from("")).expect("keys that fail have a fault")
        })?;
        Ok(Self { options, seed, ..self.clone() })
    }

    /// Text that the study was read from.
    #[doc(hidden)]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Folder from which relative paths start.
    #[doc(hidden)]
    pub fn folder(&self) -> &Path {
        self.place.path()
    }

    /// The text as JSON, whatever its format.
    #[doc(hidden)]
    pub fn as_json(&self) -> String {
        self.tree().as_ref().map(as_json).unwrap_or_default()
    }
}

/// Tree as JSON. Keys keep the order of the study, which a map of `serde_json` does not.
fn as_json(tree: &Tree) -> String {
    let text = |text: &str| Json::from(text).to_string();
    let all = |parts: Vec<String>| parts.join(", ");
    match &tree.value {
        Value::Table(entries) => {
            let entry = |(key, value): &(Key, Tree)| format!("{}: {}", text(&key.name), as_json(value));
            format!("{{{}}}", all(entries.iter().map(entry).collect()))
        }
        Value::Array(values) => format!("[{}]", all(values.iter().map(as_json).collect())),
        Value::Text(value) => text(value),
        Value::Number(number) => Json::from(*number).to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Truth(truth) => truth.to_string(),
        Value::Other(_) => Json::Null.to_string(),
    }
}

/// Adds the name of the section to the keys of faults.
fn below_analysis(mut faults: Faults) -> Faults {
    for fault in &mut faults.0 {
        let below = if fault.key.is_empty() { "" } else { "." };
        fault.key = format!("analysis{below}{}", fault.key);
    }
    faults
}

/// Options of `given`, completed by those of `own` that still apply with its method.
fn merged(given: AnalysisEntry, own: AnalysisEntry) -> AnalysisEntry {
    let method = given.method.as_ref().and_then(|method| method.get_ref().parse::<Method>().ok());
    let other = |kept: &[Method]| method.is_some_and(|method| !kept.contains(&method));
    let reduction = [Method::DimensionReduction, Method::BivariateDimensionReduction];
    let (pairs, stencil) = if other(&[Method::SixN]) { (None, None) } else { (own.pairs, own.stencil) };
    let nodes = if other(&reduction) { None } else { own.nodes };
    let stepless = method.is_some_and(|method| reduction.contains(&method) || method == Method::ThreePoint);
    let exact = given.derivatives.as_ref().is_some_and(|source| source.get_ref() == "exact");
    let step = if stepless || exact { None } else { own.step };
    AnalysisEntry {
        method: given.method.or(own.method),
        accuracy: given.accuracy.or(own.accuracy),
        accuracy_skewness: given.accuracy_skewness.or(own.accuracy_skewness),
        accuracy_kurtosis: given.accuracy_kurtosis.or(own.accuracy_kurtosis),
        accuracy_yield: given.accuracy_yield.or(own.accuracy_yield),
        budget: given.budget.or(own.budget),
        step: given.step.or(step),
        pairs: given.pairs.or(pairs),
        stencil: given.stencil.or(stencil),
        nodes: given.nodes.or(nodes),
        sensitivities: given.sensitivities.or(own.sensitivities),
        derivatives: given.derivatives.or(own.derivatives),
        extremes: given.extremes.or(own.extremes),
        seed: given.seed.or(own.seed),
        verify: given.verify.or(own.verify),
        target_joint_yield: given.target_joint_yield.or(own.target_joint_yield),
        products: given.products.or(own.products),
        coverage: given.coverage.or(own.coverage),
        rss_factor: given.rss_factor.or(own.rss_factor),
        mean_shift: given.mean_shift.or(own.mean_shift),
    }
}
