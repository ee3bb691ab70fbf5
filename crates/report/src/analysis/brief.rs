//! One line for every characteristic: yield, target, verdict, rejects beyond each limit, strongest contributors.

use crate::Report;
use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::statistics::{CharacteristicStatistics, strongest};
use crate::analysis::yield_source::{condition, distribution_free};
use crate::document::number::{plain, target_yield, yielded};
use crate::document::rejects::UNKNOWN_YIELD;
use crate::document::terminal::unbroken;
use crate::document::{Line, Style};
use crate::figures::{Figures, Named};
use crate::output_correlation::conditional_yield;
use crate::overview::verdict;
use crate::requirement::loud;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_numeric::verdict::Verdict;

/// Greatest number of characteristics that all have a line at the end of a report, and greatest number of lines there. More would push the
/// last section off the screen.
const CLOSING: usize = 10;
/// Number of contributors in a line. A line with two fits a terminal in most cases.
const NAMED: usize = 2;

impl Report {
    /// Formats a line for every characteristic, such as
    /// `gap 98.43 % (target 99.9 %) MISSED: 15661 ppm above 0.9; seal 41 %, left bearing 15 %`.
    pub fn brief(&self, style: Style) -> String {
        self.analysis.characteristics.iter().map(|one| unbroken(&self.brief_line(one), style)).collect()
    }

    /// Formats the end of a long report: an empty line, then the lines of [`brief`](Self::brief) and one of the joint yield. Of many
    /// characteristics only those that miss or may miss a requirement have a line.
    pub fn closing(&self, style: Style) -> String {
        let all = &self.analysis.characteristics;
        let concern = |one: &&CharacteristicAnalysis| {
            one.mean().is_none() || one.requirements().iter().any(|judged| judged.verdict != Verdict::Met)
        };
        let shown: Vec<_> = match all.len() > CLOSING {
            true => all.iter().filter(concern).take(CLOSING).collect(),
            false => all.iter().collect(),
        };
        let mut text = "\n".to_owned();
        shown.iter().for_each(|one| text += &unbroken(&self.brief_line(one), style));
        let rest = all.len() - shown.len();
        if rest > 0 {
            let more = if shown.is_empty() { "" } else { " more" };
            text +=
                &unbroken(&format!("{rest}{more} characteristics; the brief report has a line for each").into(), style);
        }
        if let Some(line) = self.joint_line() {
            text += &unbroken(&line, style);
        }
        text
    }

    /// Line of the share that keeps all limits at once. None if it is not required.
    fn joint_line(&self) -> Option<Line> {
        let judged = self.analysis.joint_requirement?;
        let target = judged.requirement.target_yield()?;
        let value = self.analysis.joint.map_or("unknown".to_owned(), |joint| yielded(joint.value));
        Some(Line::from(format!("all limits {value} (target {}) ", target_yield(target))).and(loud(judged.verdict)))
    }

    fn brief_line(&self, one: &CharacteristicAnalysis) -> Line {
        if one.mean().is_none() {
            return format!("{}: no result", one.name()).into();
        }
        let mut line = Line::from(one.name());
        if one.limited() {
            let known = one.rejects().yield_text().filter(|text| text != UNKNOWN_YIELD);
            let free = one.distribution.distribution_free_yield.as_ref().map(distribution_free);
            line = line.and(format!(" {}", free.as_deref().or(known.as_deref()).unwrap_or("yield unknown")));
            if let Some(given) = one.characteristic.given() {
                let of_those = one.distribution.conditional.as_ref().map_or("unknown".to_owned(), conditional_yield);
                line = line.and(format!(", given {given} {of_those}"));
            }
            if let Some(target) = one.target() {
                line = line.and(format!(" (target {})", target_yield(target)));
            }
            let judged = verdict(&one.requirements());
            if !judged.text().is_empty() {
                line = line.and(" ").and(judged);
            }
            line = line.and(condition(one));
            if known.is_some() {
                line = line.and(format!(": {}", rejects_by_limit(one)));
            }
        } else {
            let [_, mean, _, sigma, ..] = one.first_figures();
            let unit = one.unit().map_or(String::new(), |unit| format!(" {unit}"));
            line = line.and(format!(" mean {}, sigma {}{unit}, no limits", mean.text, sigma.text));
        }
        let strongest = strongest(one, &self.dimensions);
        let named: Vec<String> =
            strongest.iter().take(NAMED).map(|(name, share)| format!("{name} {share:.0} %")).collect();
        if named.is_empty() { line } else { line.and(format!("; {}", named.join(", "))) }
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
