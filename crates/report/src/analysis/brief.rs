//! One line for every characteristic: yield, target, verdict, rejects beyond each limit, strongest contributors.

use crate::Report;
use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::statistics::{CharacteristicStatistics, strongest};
use crate::analysis::yield_source::condition;
use crate::document::number::plain;
use crate::document::rejects::UNKNOWN_YIELD;
use crate::figures::{Figures, Named};
use crate::overview::verdict;
use sensitol::analysis::CharacteristicAnalysis;

/// Number of contributors in a line. A line with two fits a terminal in most cases.
const NAMED: usize = 2;

impl Report {
    /// Returns a line for every characteristic, such as
    /// `gap 98.43 % (target 99.9 %) MISSED: 15661 ppm above 0.9; seal 41 %, left bearing 15 %`.
    pub fn brief(&self) -> String {
        self.analysis.characteristics.iter().map(|one| self.brief_line(one) + "\n").collect()
    }

    fn brief_line(&self, one: &CharacteristicAnalysis) -> String {
        if one.mean().is_none() {
            return format!("{}: no result", one.name());
        }
        let mut line = one.name().to_owned();
        if one.limited() {
            let known = one.rejects().yield_text().filter(|text| text != UNKNOWN_YIELD);
            line += &format!(" {}", known.as_deref().unwrap_or("yield unknown"));
            if let Some(target) = one.target() {
                line += &format!(" (target {} %)", plain(100.0 * target));
            }
            let judged = verdict(&one.requirements());
            if !judged.text().is_empty() {
                line += &format!(" {}", judged.text());
            }
            line += &condition(one);
            if known.is_some() {
                line += &format!(": {}", rejects_by_limit(one));
            }
        } else {
            let [_, mean, _, sigma, ..] = one.first_figures();
            let unit = one.unit().map_or(String::new(), |unit| format!(" {unit}"));
            line += &format!(" mean {}, sigma {}{unit}, no limits", mean.text, sigma.text);
        }
        let strongest = strongest(one, &self.dimensions);
        let named: Vec<String> =
            strongest.iter().take(NAMED).map(|(name, share)| format!("{name} {share:.0} %")).collect();
        if named.is_empty() { line } else { format!("{line}; {}", named.join(", ")) }
    }
}

/// Rejects beyond each limit, with the limit itself.
fn rejects_by_limit(one: &CharacteristicAnalysis) -> String {
    let [below, above] = one.rejects().by_side();
    let side = |rejects: Option<String>, limit: Option<f64>, word: &str| {
        Some(format!("{} {word} {}", rejects?, plain(limit?)))
    };
    let sides = [side(below, one.lower(), "below"), side(above, one.upper(), "above")];
    let sides: Vec<String> = sides.into_iter().flatten().collect();
    if sides.is_empty() { "rejects unknown".to_owned() } else { sides.join(", ") }
}
