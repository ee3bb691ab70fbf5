//! Rewrites a study with other tolerances and nominal values. Everything else stays as it was written, comments included.
//!
//! Only the numbers concerned are replaced in the text. The new text is read again and must give the requested dimensions.

use std::ops::Range;

use crate::Study;
use crate::error::StudyError;
use crate::expand::ZonePlace;
use crate::external_settings::Externals;
use crate::folder::Format;
use crate::tree::{Key, Tree, Value};
use crate::write;
use sensitol::allocation::{Offer, ZonePart};
use sensitol::problem::Problem;
use sensitol_numeric::dimension::Dimension;

/// A rewritten study.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Rewritten {
    /// Text of the whole study.
    pub text: String,
    /// Changed entries as text, each with its name.
    pub entries: String,
    /// Names of the dimensions whose fit of ISO 286 was replaced by a plain tolerance.
    pub replaced_fits: Vec<String>,
}

/// Reasons why a study cannot be rewritten.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RewriteError {
    /// The entry has a form in which tolerances cannot be replaced.
    #[error("dimension `{dimension}` cannot be written anew: {why}; change it by hand")]
    ByHand {
        /// The dimension.
        dimension: String,
        /// Reason that the form gives.
        why: &'static str,
    },
    /// The new text cannot be read as a study.
    #[error("the study written anew cannot be read: {0}")]
    Unreadable(Box<StudyError>),
    /// The new text gives another dimension than requested.
    #[error("dimension `{dimension}` written anew is not what was wanted; change it by hand")]
    NotTheSame {
        /// The dimension.
        dimension: String,
    },
}

/// Significant digits of a tolerance. They are cut off, not rounded, so that a written tolerance is never wider than the requested one.
const DIGITS: usize = 6;
/// Greatest number of decimals that are written without an exponent.
const LONGEST: i32 = 20;
/// Relative tolerance of half-widths and sigmas that are read again. It covers the cut to six digits.
const SAME: f64 = 1e-5;
/// Tolerance of nominal values and means that are read again, in sigmas.
const SAME_PLACE: f64 = 1e-3;
/// Relative tolerance within which two distributions count as the same.
const ALIKE: f64 = 1e-9;

/// Text with other texts at these places, which do not overlap.
pub(crate) fn edited(old: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(place, _)| (place.start, place.end));
    let (mut text, mut at) = (String::with_capacity(old.len()), 0);
    for (place, new) in &edits {
        text += &old[at..place.start];
        text += new;
        at = place.end;
    }
    text + &old[at..]
}

impl Study {
    /// Rewrites the study with the tolerances and nominal values of `wanted`, a problem with the same dimensions.
    ///
    /// Tolerances have six digits and are cut off, so that they are never wider than requested; nominal values are rounded to a ten
    /// thousandth of their sigma.
    ///
    /// # Errors
    /// Fails if a dimension that has changed is a mixture of parts, or if the new text does not give the requested dimensions.
    ///
    /// ```
    /// use sensitol_study::Study;
    /// let text = "[dimensions]\na = { nominal = 10, tolerance = 0.3 } # turned\n[characteristics]\ny = { formula = \"2*a\" }\n";
    /// let study = Study::from_toml(text, "study.toml")?;
    /// let half = study.problem.dimensions()[0].scaled(0.5).expect("a normal dimension scales").unwrap();
    /// let wanted = study.problem.clone().with_dimensions(vec![half]).unwrap();
    /// assert_eq!(study.rewritten(&wanted).unwrap().text, text.replace("0.3", "0.15"));
    /// # Ok::<(), sensitol_study::StudyError>(())
    /// ```
    pub fn rewritten(&self, wanted: &Problem) -> Result<Rewritten, RewriteError> {
        Ok(self.rewritten_and_read(wanted)?.0)
    }

    /// Dimensions of `wanted` with the digits that a file would hold. Returns None if the study cannot be rewritten.
    pub fn written_dimensions(&self, wanted: &Problem) -> Option<Vec<Dimension>> {
        let (_, read) = self.rewritten_and_read(wanted).ok()?;
        Some(read.problem.dimensions().to_vec())
    }

    /// Rewrites the study and reads the result.
    fn rewritten_and_read(&self, wanted: &Problem) -> Result<(Rewritten, Self), RewriteError> {
        let tree = self.tree();
        let lines = tree.as_ref().and_then(|tree| tree.entry("dimensions"));
        let mut edits: Vec<(Range<usize>, String)> = Vec::new();
        let (mut changed, mut replaced_fits) = (Vec::new(), Vec::new());
        let (mut changed_zones, mut zone_lines): (Vec<&str>, Vec<Vec<String>>) = (Vec::new(), Vec::new());
        for (d, (old, new)) in self.problem.dimensions().iter().zip(wanted.dimensions()).enumerate() {
            let process = if alike(old, new) { None } else { self.process_of(d, new) };
            if process.is_none() && old.half_band() == new.half_band() && old.nominal() == new.nominal() {
                continue;
            }
            if let Some((place, part, half)) = self.zone_of(d, new) {
                if !changed_zones.contains(&part) {
                    let at = tree.as_ref().and_then(|tree| self.width_of(tree, place));
                    let Some((span, line)) = at else {
                        let why = "its zone has no width that is a number";
                        return Err(RewriteError::ByHand { dimension: part.to_owned(), why });
                    };
                    edits.push((span, cut(2.0 * half)));
                    changed_zones.push(part);
                    // Two zones of a feature stand in one entry.
                    if !zone_lines.contains(&line) {
                        zone_lines.push(line);
                    }
                }
                continue;
            }
            let name = old.zone().unwrap_or(old.name());
            // The study writes a relative dimension `a` as `a`, and the problem holds its own part as `a.own`.
            let own = name.strip_suffix(".own").filter(|_| lines.is_some_and(|lines| lines.entry(name).is_none()));
            let name = own.unwrap_or(name);
            if changed.contains(&name) {
                continue;
            }
            changed.push(name);
            let Some(line) = lines.and_then(|lines| lines.entry(name)) else {
                let why = "it has no entry of its own";
                return Err(RewriteError::ByHand { dimension: name.to_owned(), why });
            };
            let spread = process.and_then(|(cost, process)| spread_of(tree.as_ref()?, cost, process));
            let entry = Entry { text: &self.text, format: self.format, line, old, new, spread };
            if entry.edits(&mut edits)? {
                replaced_fits.push(name.to_owned());
            }
        }
        let text = edited(&self.text, edits);
        // Read the text again, since a wrong replacement must not go unnoticed.
        let read = self.read_again(&text)?;
        for (found, new) in read.problem.dimensions().iter().zip(wanted.dimensions()) {
            let band = found.half_band() <= new.half_band() * (1.0 + 1e-12)
                && found.half_band() >= new.half_band() * (1.0 - SAME);
            let place = (found.mean() - new.mean()).abs().max((found.nominal() - new.nominal()).abs());
            let sigma = (found.sigma() - new.sigma()).abs() <= SAME * new.sigma();
            // The width of a zone is a nominal value, cut to six digits.
            let width = new.sigma() == 0.0 && place <= SAME * new.nominal().abs();
            if !(band && sigma && (width || place <= SAME_PLACE * new.sigma())) {
                return Err(RewriteError::NotTheSame { dimension: new.name().to_owned() });
            }
        }
        let entries = read.entries(&changed) + &read.feature_entries(&zone_lines);
        Ok((Rewritten { text, entries, replaced_fits }, read))
    }

    /// Zone of a dimension with a cost: its place, its name and its new half width. Returns None for other dimensions.
    fn zone_of(&self, d: usize, new: &Dimension) -> Option<(&ZonePlace, &str, f64)> {
        for group in self.costs.iter().chain(&self.zone_groups) {
            let Some(zone) = &group.zone else { continue };
            let member = group.members.iter().position(|&member| member == d);
            let part = match member {
                Some(place) => zone.parts.iter().find(|part| part.members.contains(&place)),
                // A width has the name of its zone.
                None if zone.widths.iter().any(|&(width, _)| width == d) => {
                    let is_own =
                        |part: &&ZonePart| self.zones.iter().any(|of| of.cost == part.name && of.name() == new.name());
                    zone.parts.iter().find(is_own)
                }
                None => None,
            };
            let Some(part) = part else { continue };
            let place = self.zones.iter().find(|place| place.cost == part.name)?;
            let half = match member {
                Some(place) => new.half_band() / group.share(place),
                None => 0.5 * new.nominal(),
            };
            return Some((place, &part.name, half));
        }
        None
    }

    /// Place of the width of a zone in the text, and the keys that lead to the entry of its feature.
    fn width_of(&self, tree: &Tree, place: &ZonePlace) -> Option<(Range<usize>, Vec<String>)> {
        let mut found = tree.entry("parts")?;
        for key in &place.path {
            found = found.entry(key)?;
        }
        let width = found.entry("zone").unwrap_or(found);
        let line = place.path[..place.path.len() - 1].to_vec();
        matches!(width.value, Value::Number(_) | Value::Integer(_)).then(|| (width.span.clone(), line))
    }

    /// Text of the entries of features, below the table of their part.
    fn feature_entries(&self, lines: &[Vec<String>]) -> String {
        let Some(tree) = self.tree() else { return String::new() };
        let mut text = String::new();
        let mut last: Option<&[String]> = None;
        for line in lines {
            let Some((name, above)) = line.split_last() else { continue };
            let mut found = tree.entry("parts");
            for key in line {
                found = found.and_then(|found| found.entry(key));
            }
            let Some(entry) = found else { continue };
            if last != Some(above) {
                text += &format!("[parts.{}]\n", above.join("."));
                last = Some(above);
            }
            let own = &self.text[entry.span.clone()];
            let written = if own.starts_with('{') { own.to_owned() } else { inline(&self.text, entry) };
            text += &write::entry(self.format, name, 0, &written);
        }
        text
    }

    /// Name of the dimension with the cost, and of the process that gives the new distribution. Returns None if no process does.
    fn process_of(&self, d: usize, new: &Dimension) -> Option<(&str, &str)> {
        let group = self.costs.iter().find(|group| group.members.contains(&d))?;
        let place = group.members.iter().position(|&member| member == d)?;
        let made = |offer: &&Offer| offer.made.as_ref().is_some_and(|made| alike(&made.dimensions()[place], new));
        let process = group.offers.iter().find(made)?.process.as_deref()?;
        Some((self.problem.dimensions()[group.members[0]].name(), process))
    }

    /// Tree of the text that the study was read from.
    pub(super) fn tree(&self) -> Option<Tree> {
        match self.format {
            Format::Toml => Tree::of_toml(&self.text).ok(),
            Format::Json => Tree::of_json(&self.text).ok(),
        }
    }

    pub(super) fn read_again(&self, text: &str) -> Result<Self, RewriteError> {
        let externals = Externals { host: self.host.clone(), ..Externals::default() };
        Self::parse(text, self.format, &self.name, self.place.clone(), externals, None)
            .map_err(|error| RewriteError::Unreadable(Box::new(error)))
    }

    /// Text of the entries with these names.
    fn entries(&self, names: &[&str]) -> String {
        let tree = self.tree();
        let lines = tree.as_ref().and_then(|tree| tree.entry("dimensions"));
        let Some(Tree { value: Value::Table(lines), .. }) = lines else { return String::new() };
        let mut text = String::new();
        let width = |key: &Key| self.text[key.span.clone()].chars().count();
        let of_names = || lines.iter().filter(|(key, _)| names.contains(&key.name.as_str()));
        let widest = of_names().map(|(key, _)| width(key)).max().unwrap_or(0);
        for (key, line) in of_names() {
            let name = &self.text[key.span.clone()];
            let written = match self.text[line.span.clone()].starts_with('{') {
                true => self.text[line.span.clone()].to_owned(),
                // A section of its own, such as [dimensions.a], is shown as a table on one line.
                false => inline(&self.text, line),
            };
            text += &write::entry(self.format, name, widest - width(key), &written);
        }
        text
    }
}

/// Keys of the distribution within a band.
const SPREAD: [&str; 9] = ["process", "cp", "cpk", "sigma", "sigmas", "side", "drift", "shift", "distribution"];

/// Distribution keys of one process in the costs of a dimension.
fn spread_of<'t>(tree: &'t Tree, cost: &str, process: &str) -> Option<Vec<&'t (Key, Tree)>> {
    let Value::Array(list) = &tree.entry("costs")?.entry(cost)?.entry("processes")?.value else { return None };
    let is_named =
        |line: &&Tree| matches!(line.entry("name").map(|name| &name.value), Some(Value::Text(name)) if name == process);
    let Value::Table(keys) = &list.iter().find(is_named)?.value else { return None };
    Some(keys.iter().filter(|(key, _)| SPREAD.contains(&key.name.as_str())).collect())
}

/// True if two dimensions have the same band width and the same distribution relative to the nominal value.
fn alike(a: &Dimension, b: &Dimension) -> bool {
    let (Some(of), Some(found)) = (a.distribution(), b.distribution()) else { return false };
    let offset = |of: &Dimension| (of.mean() - of.nominal()) / of.sigma();
    let near = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.abs().max(b.abs()).max(1.0);
    let figures = [a.half_band() / b.half_band(), a.sigma() / b.sigma(), 1.0 + offset(a) - offset(b)];
    let (of, found) = (of.standard_moments().raw(), found.standard_moments().raw());
    figures.into_iter().all(|figure| near(figure, 1.0))
        && of.iter().zip(found).all(|(&a, b)| a.is_nan() && b.is_nan() || near(a, b))
}

/// Text of a section as a table on one line.
fn inline(text: &str, line: &Tree) -> String {
    let Value::Table(keys) = &line.value else { return String::new() };
    let of = |span: &Range<usize>| &text[span.clone()];
    write::inline(keys.iter().map(|(key, value)| write::pair(Format::Toml, of(&key.span), of(&value.span))))
}

impl Tree {
    pub(super) fn entry(&self, name: &str) -> Option<&Self> {
        let Value::Table(entries) = &self.value else { return None };
        entries.iter().find(|(key, _)| key.name == name).map(|(_, value)| value)
    }
}

/// Entry of a dimension or of a position, with the old and the new dimension.
struct Entry<'a> {
    text: &'a str,
    format: Format,
    line: &'a Tree,
    old: &'a Dimension,
    new: &'a Dimension,
    /// Distribution keys of the process; None if the distribution does not change.
    spread: Option<Vec<&'a (Key, Tree)>>,
}

impl Entry<'_> {
    /// Adds the replacements for this entry. Returns true if a fit was replaced by a tolerance.
    fn edits(&self, edits: &mut Vec<(Range<usize>, String)>) -> Result<bool, RewriteError> {
        let by_hand = |why| RewriteError::ByHand { dimension: self.old.name().to_owned(), why };
        let Value::Table(keys) = &self.line.value else { return Err(by_hand("it is no table")) };
        let half = cut(self.new.half_band());
        let width: f64 = half.parse().unwrap_or(self.new.half_band());
        let factor = width / self.old.half_band();
        let scales = self.old.half_band() != self.new.half_band();
        let moves = self.old.nominal() != self.new.nominal();
        let nominal = self.nominal();
        let mut fit = false;
        if let Some(spread) = &self.spread {
            self.respread(keys, spread, edits);
        }
        for (key, value) in keys {
            if self.spread.is_some() && SPREAD.contains(&key.name.as_str()) {
                continue;
            }
            let mut replace = |text: String| edits.push((value.span.clone(), text));
            match (key.name.as_str(), &value.value) {
                ("nominal", _) if moves => replace(nominal.0.clone()),
                ("tolerance", Value::Array(items)) if scales => {
                    for (side, (item, end)) in items.iter().zip(self.band(factor)).enumerate() {
                        edits.push((item.span.clone(), self.deviation(&item.value, end, width, side == 0)));
                    }
                }
                ("tolerance", Value::Text(_)) if scales => {
                    replace(self.deviation(&value.value, width, width, false));
                }
                ("tolerance", _) if scales => replace(half.clone()),
                // These keys hold the whole width of a zone. The other geometric elements have formulas of their own and no plain band.
                (
                    "position" | "profile" | "symmetry" | "flatness" | "straightness" | "roundness" | "cylindricity"
                    | "runout" | "total_runout" | "coaxiality" | "concentricity",
                    Value::Number(_) | Value::Integer(_),
                ) if scales => replace(cut(2.0 * self.new.half_band())),
                ("limits", _) => {
                    let [lower, upper] = self.band(factor);
                    let from = rounded(nominal.1 + lower, width, true);
                    let to = rounded(nominal.1 + upper, width, false);
                    replace(write::array([from, to]));
                }
                ("fit", _) if scales => {
                    let [lower, upper] = self.band(factor);
                    let (lower, upper) = (rounded(lower, width, true), rounded(upper, width, false));
                    let tolerance = write::pair(self.format, "tolerance", &write::array([lower, upper]));
                    edits.push((key.span.start..value.span.end, tolerance));
                    fit = true;
                }
                ("sigma", Value::Number(sigma)) if scales => replace(write::number(sigma * factor)),
                ("sigma", Value::Integer(sigma)) if scales => replace(write::number(*sigma as f64 * factor)),
                ("distribution", Value::Table(parameters)) => {
                    for (key, value) in parameters {
                        match (key.name.as_str(), &value.value) {
                            ("parts", _) => return Err(by_hand("it is a mixture of parts")),
                            ("mode", Value::Number(_) | Value::Integer(_)) => {
                                let mode = match value.value {
                                    Value::Integer(mode) => mode as f64,
                                    Value::Number(mode) => mode,
                                    _ => continue,
                                };
                                let [lower, upper] = self.old.tolerance().unwrap_or([0.0; 2]);
                                let from_middle = mode - self.old.nominal() - 0.5 * (lower + upper);
                                let [low, high] = self.band(factor);
                                let mode = nominal.1 + 0.5 * (low + high) + from_middle * factor;
                                edits.push((value.span.clone(), write::number(mode)));
                            }
                            _ => {}
                        }
                    }
                }
                _ => {}
            }
        }
        let known = |name: &str| keys.iter().any(|(key, _)| key.name == name);
        if moves && !known("nominal") && !known("limits") {
            self.insert_nominal(keys, &nominal.0, edits);
        }
        Ok(fit)
    }

    /// Replaces the distribution keys of the entry by those of the process.
    fn respread(&self, keys: &[(Key, Tree)], spread: &[&(Key, Tree)], edits: &mut Vec<(Range<usize>, String)>) {
        let inline = self.text[self.line.span.clone()].starts_with('{');
        let between = if inline { ", " } else { "\n" };
        let of = |(key, value): &&(Key, Tree)| {
            let text = |span: &Range<usize>| &self.text[span.clone()];
            write::pair(self.format, &key.name, text(&value.span))
        };
        let own: Vec<String> = spread.iter().map(of).collect();
        let own = own.join(between);
        let old = |(key, _): &(Key, Tree)| SPREAD.contains(&key.name.as_str());
        let mut written = false;
        for (at, (key, value)) in keys.iter().enumerate().filter(|(_, line)| old(line)) {
            match written {
                false => edits.push((key.span.start..value.span.end, own.clone())),
                true => edits.push((keys[at - 1].1.span.end..value.span.end, String::new())),
            }
            written = true;
        }
        if let (false, Some((_, last))) = (written, keys.last()) {
            edits.push((last.span.end..last.span.end, format!("{between}{own}")));
        }
    }

    /// Inserts a nominal value that the entry has left to the built-in model.
    fn insert_nominal(&self, keys: &[(Key, Tree)], nominal: &str, edits: &mut Vec<(Range<usize>, String)>) {
        let inline = self.text[self.line.span.clone()].starts_with('{');
        let at = keys.first().map_or(self.line.span.start + 1, |(key, _)| key.span.start);
        let comma = if keys.is_empty() { " " } else { ", " };
        let end = if self.format == Format::Json || inline { comma } else { "\n" };
        let text = write::pair(self.format, "nominal", nominal) + end;
        edits.push((at..at, text));
    }

    /// Text and value of the new nominal, rounded to a ten thousandth of sigma if it has changed. The width of a zone does not vary: it is cut
    /// as tolerances are.
    fn nominal(&self) -> (String, f64) {
        let value = self.new.nominal();
        if self.old.nominal() == value {
            return (write::number(value), value);
        }
        if self.new.sigma() == 0.0 {
            let text = cut(value);
            let read = text.parse().unwrap_or(value);
            return (text, read);
        }
        let decimals = 4 - libm::log10(self.new.sigma()).floor() as i32;
        if !(-LONGEST..=LONGEST).contains(&decimals) {
            let rounded = in_tenths(value, decimals, f64::round);
            return (write::number(rounded), rounded);
        }
        let decimals = decimals.max(0) as usize;
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') { text } else { format!("{text}.0") };
        let rounded = text.parse().unwrap_or(value);
        (text, rounded)
    }

    /// Deviations of the band with `factor` times its width.
    fn band(&self, factor: f64) -> [f64; 2] {
        self.old.opened(self.old.tolerance().unwrap_or_else(|| self.old.reach()), factor)
    }

    /// Text of one deviation in the form of the old one: a number, or percent of the nominal. It is rounded towards the inside of a band of
    /// half-width `width`.
    fn deviation(&self, written: &Value, end: f64, width: f64, up: bool) -> String {
        match written {
            Value::Text(_) => {
                let percent = 100.0 / self.new.nominal().abs();
                write::quoted(&format!("{}%", rounded(percent * end, percent * width, up)))
            }
            _ => rounded(end, width, up),
        }
    }
}

/// Text of a number with [`DIGITS`] significant digits relative to `scale`, rounded up or down, without trailing zeros.
fn rounded(value: f64, scale: f64, up: bool) -> String {
    if scale == 0.0 || !value.is_finite() {
        return "0.0".to_owned();
    }
    // The blur keeps a round number that misses its last digit by floating-point rounding only.
    let magnitude = libm::log10(scale.abs() * (1.0 + 8.0 * f64::EPSILON)).floor() as i32;
    let decimals = DIGITS as i32 - 1 - magnitude;
    let inside = |scaled: f64| {
        let blur = 8.0 * f64::EPSILON * scaled.abs();
        if up { (scaled - blur).ceil() } else { (scaled + blur).floor() }
    };
    if !(-LONGEST..=LONGEST).contains(&decimals) {
        return write::number(in_tenths(value, decimals, inside));
    }
    let unit = 10f64.powi(decimals);
    let text = format!("{:.*}", decimals.max(0) as usize, inside(value * unit) / unit);
    if !text.contains('.') {
        return text + ".0";
    }
    let text = text.trim_end_matches('0');
    match text.strip_suffix('.') {
        Some(whole) => {
            if whole == "-0" {
                "0.0".to_owned()
            } else {
                format!("{whole}.0")
            }
        }
        None => text.to_owned(),
    }
}

/// Rounds a number to this many decimals, which may be negative.
fn in_tenths(value: f64, decimals: i32, round: impl Fn(f64) -> f64) -> f64 {
    // The decimal exponent goes through text: parsing rounds once only, however many decimals there are.
    let whole = round(value * power_of_ten(decimals));
    format!("{whole}e{}", -decimals).parse().unwrap_or(value)
}

fn power_of_ten(decimals: i32) -> f64 {
    format!("1e{decimals}").parse().unwrap_or(f64::NAN)
}

/// Text of a number cut to [`DIGITS`] significant digits.
fn cut(value: f64) -> String {
    rounded(value, value, false)
}
