//! The part of the text report that is about the true worst case.

use super::CharacteristicReport;
use super::number::beside;
use super::page::{Detail, Page, clean, short};
use crate::extremes::{Extreme, Place};

/// Lines that say where an extreme is, unless everything is shown.
const LINES: usize = 3;

/// The extremes, whether they are proven, and where they are.
pub(super) fn extremes(page: &mut Page, one: &CharacteristicReport) {
    let Some(found) = &one.worst_case.found else { return };
    let scale = one.sigma.filter(|&sigma| sigma > 0.0).or(one.rss).unwrap_or(0.0);
    let [least, greatest] = [&found.least, &found.greatest].map(|extreme| beside(extreme.value, scale));
    let proven = if found.proven() { "proven" } else { "not proven" };
    let evaluations = match found.evaluations {
        1 => "1 evaluation".to_owned(),
        count => format!("{count} evaluations"),
    };
    page.line(&format!("  extremes  {least} .. {greatest}  {proven}, {evaluations}"));
    for (name, extreme) in [("least at", &found.least), ("greatest at", &found.greatest)] {
        wrapped(page, &format!("    {name:<11}"), &words(extreme));
    }
}

/// The dimensions by the end of their bands, and the others by their values.
fn words(extreme: &Extreme) -> Vec<String> {
    let of = |place: Place| extreme.at.iter().filter(move |at| at.place == place);
    let mut words = Vec::new();
    for (place, title) in [(Place::Lower, "lower"), (Place::Upper, "upper")] {
        for (index, at) in of(place).enumerate() {
            let title = if index == 0 { format!("{title} ") } else { String::new() };
            words.push(format!("{title}{}", short(&clean(&at.dimension))));
        }
        if let Some(last) = words.last_mut().filter(|_| of(place).next().is_some()) {
            last.push(';');
        }
    }
    words.extend(
        of(Place::Interior)
            .map(|at| format!("{} = {}", short(&clean(&at.dimension)), beside(at.x, at.band[1] - at.band[0]))),
    );
    words
}

/// Words with commas after a title, on as many lines as it takes; the rest is counted.
fn wrapped(page: &mut Page, title: &str, words: &[String]) {
    let most = if page.style().detail == Detail::Full { usize::MAX } else { LINES };
    let (mut lines, mut line, mut shown) = (0, title.to_owned(), 0);
    for (index, word) in words.iter().enumerate() {
        let comma = if index + 1 == words.len() || word.ends_with(';') { "" } else { "," };
        let word = format!(" {}{comma}", if index + 1 == words.len() { word.trim_end_matches(';') } else { word });
        let full =
            line.chars().count() + word.chars().count() > page.style().width - if lines + 1 == most { 20 } else { 0 };
        if full && lines + 1 == most {
            line += &format!(" and {} more", words.len() - shown);
            break;
        }
        if full {
            page.line(&line);
            (lines, line) = (lines + 1, " ".repeat(title.chars().count()));
        }
        line += &word;
        shown += 1;
    }
    page.line(&line);
}
