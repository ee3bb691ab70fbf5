//! Imports the parts of a STEP file: a study of its own, or parts of another one.

use std::collections::BTreeSet;

use sensitol_spatial::SpatialError;
use sensitol_step::tables::{ReaderKeys, StepFault, StudyTables, TableFault, TableRequest, tables_of};

use crate::Study;
use crate::error::{StudyError, StudyFault};
use sensitol_numeric::unit::Unit;

/// Keys of features that this reader of studies takes.
const KEYS: ReaderKeys = ReaderKeys::Zones;
/// Sections whose names formulas use, so that a new dimension cannot have them.
const NAMED: [&str; 7] =
    ["dimensions", "constants", "formulas", "unknowns", "characteristics", "elements", "configurations"];

/// Request for the import of a STEP file.
#[derive(Debug, Clone, Default)]
pub struct StepRequest {
    /// Name of the file, for the first line.
    pub file: String,
    /// Name of the part. Without it, that of the product.
    pub part: Option<String>,
    /// True if joints are proposed.
    pub joints: bool,
    /// Lines with the next steps, each without a mark of a comment.
    pub next: Vec<String>,
}

/// Text of a study with the parts of a STEP file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepStudy {
    /// The study.
    pub text: String,
    /// Counts of tolerances, as in the last line.
    pub summary: String,
    /// Names of the new parts.
    pub parts: Vec<String>,
}

/// Reason why a STEP file is not imported.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum StepImportFault {
    /// The file, or its content.
    #[error(transparent)]
    Step(#[from] StepFault),
    /// The study to which parts are added cannot be read.
    #[error("{0}")]
    Target(String),
    /// The written text is not a study.
    #[error("the written study cannot be read: {0}")]
    Written(Box<StudyError>),
}

impl StepImportFault {
    /// True if another name of the part is the remedy.
    pub fn is_of_name(&self) -> bool {
        matches!(self, Self::Step(StepFault::Content(TableFault::PartExists(_) | TableFault::PartName(_))))
    }
}

/// True if bytes begin as a Part 21 file does.
pub fn is_step(bytes: &[u8]) -> bool {
    let start = bytes.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(bytes.len());
    bytes[start..].starts_with(b"ISO-10303-21")
}

/// True for a size and class that the tables of fits have.
fn fit_is_known(millimetres: f64, class: &str) -> bool {
    sensitol_numeric::fits::deviations(millimetres, class).is_ok()
}

fn table_request(request: &StepRequest) -> TableRequest {
    TableRequest {
        part: request.part.clone(),
        joints: request.joints,
        keys: KEYS,
        fit_is_known: Some(fit_is_known),
        ..TableRequest::default()
    }
}

/// Imports a STEP file as a study of its own.
///
/// # Errors
/// If the file is damaged, or has nothing for a study.
pub fn step_study(bytes: &[u8], request: &StepRequest) -> Result<StepStudy, StepImportFault> {
    let tables = tables_of(bytes, &table_request(request))?;
    let mut text = format!(
        "# Imported from {}: {}, {}, lengths in {}.\n",
        one_line(&request.file),
        counted(tables.part_names.len(), "part"),
        counted(tables.features, "feature"),
        tables.unit
    );
    request.next.iter().for_each(|line| text += &format!("# {line}\n"));
    if !tables.dimensions.is_empty() {
        text += &format!("\n[dimensions]\n{}\n", tables.dimensions.join("\n"));
    }
    finished(text, tables)
}

/// Adds the parts of a STEP file to a study in TOML. The text of the study stays as it is.
///
/// # Errors
/// If the file is damaged or has nothing for a study, the study is no TOML, or it has a part of that name.
pub fn step_into(bytes: &[u8], request: &StepRequest, study: &str) -> Result<StepStudy, StepImportFault> {
    let table: toml::Table = study.parse().map_err(|error: toml::de::Error| {
        StepImportFault::Target(format!("it is not TOML: {}", one_line(error.message())))
    })?;
    let names = |section: &str| {
        let section = table.get(section).and_then(toml::Value::as_table);
        section.into_iter().flat_map(|section| section.keys().cloned()).collect::<BTreeSet<String>>()
    };
    let asked = TableRequest {
        unit: length_unit(&table),
        taken_dimensions: NAMED.iter().flat_map(|section| names(section)).collect(),
        taken_parts: names("parts"),
        prefixed: true,
        ..table_request(request)
    };
    let tables = tables_of(bytes, &asked)?;
    let mut text = with_dimensions(study, &tables.dimensions);
    text += &format!("\n# Imported from {}.\n", one_line(&request.file));
    finished(text, tables)
}

/// Adds parts, joints and the last line to a text, and checks that it can be read.
fn finished(mut text: String, tables: StudyTables) -> Result<StepStudy, StepImportFault> {
    text += &tables.parts;
    if !tables.joints.is_empty() {
        text += "\n# Faces that coincide, in the order of assembly. Take off the # of those that hold the parts:\n# [joints]\n";
        text += &format!("{}\n", tables.joints.join("\n"));
    }
    let summary = summary(&tables, &text);
    text += &format!("\n# {summary}\n");
    check(&text).map_err(|error| StepImportFault::Written(Box::new(error)))?;
    Ok(StepStudy { text, summary, parts: tables.part_names })
}

/// Counts of tolerances, with the lines of those that are comments.
fn summary(tables: &StudyTables, text: &str) -> String {
    let mut counts = Vec::new();
    if tables.written > 0 || tables.waiting == 0 {
        counts.push(format!("{} written", tables.written));
    }
    if tables.waiting > 0 {
        counts.push(format!("{} written as comments beside their features", tables.waiting));
    }
    let mut reasons: Vec<_> = tables.open.iter().map(|item| item.reason).collect();
    reasons.sort_unstable();
    reasons.dedup();
    for reason in reasons {
        let items: Vec<&str> =
            tables.open.iter().filter(|item| item.reason == reason).map(|item| item.line.as_str()).collect();
        let known: BTreeSet<&str> = items.iter().copied().collect();
        let lines = text.lines().enumerate().filter(|(_, line)| known.contains(line)).map(|(at, _)| at + 1);
        counts.push(format!("{} {} ({})", items.len(), reason.words(), ranges(&lines.collect::<Vec<_>>())));
    }
    format!("{}: {}", counted(tables.tolerances, "tolerance"), counts.join(", "))
}

/// Text such as "lines 12-15, 18".
fn ranges(lines: &[usize]) -> String {
    let mut found: Vec<[usize; 2]> = Vec::new();
    for &line in lines {
        match found.last_mut() {
            Some([_, last]) if *last + 1 == line => *last = line,
            _ => found.push([line, line]),
        }
    }
    let texts: Vec<String> = (found.iter())
        .map(|[first, last]| if first == last { first.to_string() } else { format!("{first}-{last}") })
        .collect();
    format!("line{} {}", if lines.len() == 1 { "" } else { "s" }, texts.join(", "))
}

fn counted(count: usize, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Unit of the first length of a study. Returns None if it has none.
fn length_unit(study: &toml::Table) -> Option<String> {
    let metre = Unit::parse("m")?;
    let entries = ["dimensions", "constants", "characteristics"].iter().filter_map(|name| study.get(*name)?.as_table());
    let units = entries.flatten().filter_map(|(_, entry)| entry.get("unit")?.as_str());
    units.filter(|unit| Unit::parse(unit).is_some_and(|unit| unit.same_kind(&metre))).map(str::to_owned).next()
}

/// Adds lines to the section `[dimensions]` of a study, or a section with them.
fn with_dimensions(study: &str, dimensions: &[String]) -> String {
    if dimensions.is_empty() {
        return study.trim_end().to_owned() + "\n";
    }
    let lines: Vec<&str> = study.lines().collect();
    let header = lines.iter().position(|line| line.split('#').next().unwrap_or("").trim() == "[dimensions]");
    let Some(header) = header else {
        return format!("{}\n\n[dimensions]\n{}\n", study.trim_end(), dimensions.join("\n"));
    };
    let next = lines[header + 1..].iter().position(|line| line.trim_start().starts_with('['));
    let mut end = next.map_or(lines.len(), |next| header + 1 + next);
    // Before the comments and blank lines above the next section.
    while end > header + 1 && (lines[end - 1].trim().is_empty() || lines[end - 1].trim_start().starts_with('#')) {
        end -= 1;
    }
    let (before, after) = (lines[..end].join("\n"), lines[end..].join("\n"));
    format!("{before}\n{}\n{}\n", dimensions.join("\n"), after.trim_end())
}

/// Reads the written study. An assembly that lacks joints is not at fault: those are for the user to write.
fn check(text: &str) -> Result<(), StudyError> {
    let has_joints = text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("joints"));
    let complete = if has_joints { text.to_owned() } else { format!("{text}[joints]\n") };
    match Study::from_toml(&complete, "imported study") {
        Ok(_) => Ok(()),
        Err(error) => match &*error.fault {
            StudyFault::Spatial(SpatialError::NothingMoves | SpatialError::NoJoint { .. }) if error.more.is_empty() => {
                Ok(())
            }
            _ => Err(error),
        },
    }
}
