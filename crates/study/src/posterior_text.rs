//! Rewrites a study with other means and sigmas of its dimensions. Everything else stays as it was written, comments included.

use std::ops::Range;

use crate::Study;
use crate::folder::Format;
use crate::rewrite::{RewriteError, edited};
use crate::tree::{Key, Tree, Value};
use crate::write;
use sensitol_numeric::correlation::Pair;

/// Keys that mean and sigma replace.
const REPLACED: [&str; 8] = ["process", "cp", "cpk", "sigma", "sigmas", "drift", "shift", "distribution"];
/// Relative tolerance of figures that are read again: they are written with six digits.
const SAME: f64 = 1e-4;
/// Significant digits of a written sigma.
const DIGITS: i32 = 6;

/// Mean and sigma that a dimension is to have.
#[derive(Debug, Clone, PartialEq)]
pub struct UpdatedSpread {
    /// Name of the dimension.
    pub dimension: String,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sigma: f64,
}

/// A study with other means and sigmas.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct UpdatedStudy {
    /// Text of the whole study.
    pub text: String,
    /// Dimensions whose distribution was replaced by a normal one, since its sigma follows from its band.
    pub made_normal: Vec<String>,
    /// Correlations that stay as they are, since the study has no entry of its own for them: they are of a block or of another file.
    pub kept_correlations: Vec<Pair>,
}

impl Study {
    /// Rewrites the study with these means and sigmas: `sigma` and `shift` take the place of capabilities, and tolerances stay. A
    /// distribution other than a normal one becomes normal. A correlation of the study gets its new value, and new ones are added at the end.
    ///
    /// # Errors
    /// Fails if a dimension has no entry of its own or is measured, if correlations are to be added to a study in JSON, or if the new text
    /// does not give the requested figures.
    ///
    /// ```
    /// use sensitol_study::{Study, UpdatedSpread};
    /// let text = "[dimensions]\na = { nominal = 10, tolerance = 0.3, cp = 1.2 } # turned\n[characteristics]\ny = { formula = \"2*a\" }\n";
    /// let study = Study::from_toml(text, "study.toml")?;
    /// let wanted = UpdatedSpread { dimension: "a".into(), mean: 10.05, sigma: 0.08 };
    /// let updated = study.updated(&[wanted], &[]).unwrap();
    /// assert_eq!(updated.text, text.replace("cp = 1.2", "sigma = 0.08, shift = 0.05"));
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn updated(&self, spreads: &[UpdatedSpread], correlations: &[Pair]) -> Result<UpdatedStudy, RewriteError> {
        let tree = self.tree();
        let lines = tree.as_ref().and_then(|tree| tree.entry("dimensions"));
        let (mut edits, mut made_normal): (Vec<(Range<usize>, String)>, Vec<String>) = (Vec::new(), Vec::new());
        for wanted in spreads {
            let by_hand = |why| RewriteError::ByHand { dimension: wanted.dimension.clone(), why };
            let dimension = self.problem.dimensions().iter().find(|one| one.name() == wanted.dimension);
            let (Some(dimension), Some(line)) = (dimension, lines.and_then(|lines| lines.entry(&wanted.dimension)))
            else {
                return Err(by_hand("it has no entry of its own"));
            };
            let Value::Table(keys) = &line.value else { return Err(by_hand("it is no table")) };
            let given = |name: &str| keys.iter().any(|(key, _)| key.name == name);
            if given("measured") || given("moments") {
                return Err(by_hand("its distribution is given by values or moments"));
            }
            if dimension.distribution().is_some_and(|law| law.name() != "normal") {
                made_normal.push(wanted.dimension.clone());
            }
            let [lower, upper] = dimension.tolerance().unwrap_or([0.0; 2]);
            let off = wanted.mean - dimension.nominal() - 0.5 * (lower + upper);
            let pairs = [("sigma", written(wanted.sigma, wanted.sigma)), ("shift", written(off, wanted.sigma))];
            self.replace(keys, line, &pairs, &mut edits);
        }
        let (mut added, mut kept_correlations): (Vec<&Pair>, Vec<Pair>) = (Vec::new(), Vec::new());
        for pair in correlations {
            match (self.correlation_value(tree.as_ref(), pair), self.correlated(pair)) {
                (Some(place), _) => edits.push((place, format!("{:.4}", pair.value))),
                (None, false) => added.push(pair),
                (None, true) => kept_correlations.push(pair.clone()),
            }
        }
        let mut text = edited(&self.text, edits);
        for pair in added {
            if self.format == Format::Json {
                let why = "its correlation is new, and none is added to a study in JSON";
                return Err(RewriteError::ByHand { dimension: pair.between[0].clone(), why });
            }
            let between = write::array(pair.between.iter().map(|name| write::quoted(name)));
            let break_ = if text.ends_with('\n') { "" } else { "\n" };
            text += &format!("{break_}\n[[correlation]]\nbetween = {between}\nvalue = {:.4}\n", pair.value);
        }
        let read = self.read_again(&text)?;
        for wanted in spreads {
            let found = read.problem.dimensions().iter().find(|one| one.name() == wanted.dimension);
            let same = found.is_some_and(|found| {
                (found.mean() - wanted.mean).abs() <= SAME * wanted.sigma
                    && (found.sigma() - wanted.sigma).abs() <= SAME * wanted.sigma
            });
            if !same {
                return Err(RewriteError::NotTheSame { dimension: wanted.dimension.clone() });
            }
        }
        Ok(UpdatedStudy { text, made_normal, kept_correlations })
    }

    /// Place of the value of a correlation that the study writes.
    fn correlation_value(&self, tree: Option<&Tree>, pair: &Pair) -> Option<Range<usize>> {
        let Value::Array(entries) = &tree?.entry("correlation")?.value else { return None };
        let same = |entry: &&Tree| match entry.entry("between").map(|between| &between.value) {
            Some(Value::Array(names)) => {
                names.len() == 2
                    && pair.between.iter().all(|wanted| {
                        names.iter().any(|name| matches!(&name.value, Value::Text(name) if name == wanted))
                    })
            }
            _ => false,
        };
        Some(entries.iter().find(same)?.entry("value")?.span.clone())
    }

    /// True if two dimensions are correlated in the study, or one of them is in a block.
    fn correlated(&self, pair: &Pair) -> bool {
        let Some(correlation) = self.problem.correlation() else { return false };
        let place = |name: &String| self.problem.dimensions().iter().position(|one| one.name() == name);
        let [Some(a), Some(b)] = [&pair.between[0], &pair.between[1]].map(place) else { return false };
        correlation.of(a, b) != 0.0 || [a, b].iter().any(|place| correlation.block_of(*place).is_some())
    }

    /// Puts the pairs in the place of the keys that they replace.
    fn replace(
        &self,
        keys: &[(Key, Tree)],
        line: &Tree,
        pairs: &[(&str, String)],
        edits: &mut Vec<(Range<usize>, String)>,
    ) {
        let inline = self.text[line.span.clone()].starts_with('{');
        let between = if inline { ", " } else { "\n" };
        let new: Vec<String> = pairs.iter().map(|(key, value)| write::pair(self.format, key, value)).collect();
        let new = new.join(between);
        let mut placed = false;
        for (at, (key, value)) in keys.iter().enumerate().filter(|(_, (key, _))| REPLACED.contains(&key.name.as_str()))
        {
            match placed {
                false => edits.push((key.span.start..value.span.end, new.clone())),
                true => edits.push((keys[at - 1].1.span.end..value.span.end, String::new())),
            }
            placed = true;
        }
        if let (false, Some((_, last))) = (placed, keys.last()) {
            edits.push((last.span.end..last.span.end, format!("{between}{new}")));
        }
    }
}

/// Text of a number with six digits relative to a scale.
fn written(value: f64, scale: f64) -> String {
    let decimals = DIGITS - 1 - libm::log10(scale).floor() as i32;
    if !(0..=20).contains(&decimals) {
        return write::number(value);
    }
    let text = format!("{value:.*}", decimals as usize);
    let text = text.trim_end_matches('0');
    if text.ends_with('.') || text == "-0." { format!("{text}0") } else { text.to_owned() }
}
