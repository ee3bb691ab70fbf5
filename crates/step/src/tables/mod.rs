//! Parts of a model as tables of a study: `[dimensions]`, `[parts.NAME]` and proposed joints.
//!
//! The text follows the syntax of studies, and nothing here needs the engine.

mod cluster;
mod datum_frame;
mod features;
mod joints;
mod part;
mod sizes;
mod text;
mod zone_keys;

use std::collections::BTreeSet;

use crate::part21::EntityTable;
use crate::semantic::{Placement, StepModel, StepPart, StepUnit};
use part::PartWriter;
use text::{UniqueNames, name_of};

pub use zone_keys::ReaderKeys;

/// Requests for the tables of a model.
#[derive(Debug, Clone, Default)]
pub struct TableRequest {
    /// Name of the part, or of the first of several. Without it, the name of the product.
    pub part: Option<String>,
    /// Unit of lengths as a study writes it. Without it, that of the first part.
    pub unit: Option<String>,
    /// Names of dimensions and parts that are taken.
    pub taken_dimensions: BTreeSet<String>,
    /// Names of parts that are taken.
    pub taken_parts: BTreeSet<String>,
    /// True if joints are proposed.
    pub joints: bool,
    /// True if names of dimensions begin with that of their part.
    pub prefixed: bool,
    /// Keys that the reader of studies takes.
    pub keys: ReaderKeys,
    /// True for a size in millimetres and a class that the reader of studies has in its tables. Without it, all classes are written.
    pub fit_is_known: Option<fn(f64, &str) -> bool>,
}

/// A tolerance or dimension that the tables do not hold, with its comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OpenItem {
    /// Reason.
    pub reason: OpenReason,
    /// Comment in the text, as a whole line.
    pub line: String,
}

/// Reason why a tolerance is not written as keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OpenReason {
    /// No face in the file.
    NoFace,
    /// The whole part.
    WholePart,
    /// No value in the file.
    NoValue,
    /// A kind, zone or datum frame for which there is no key.
    NoKey,
}

impl OpenReason {
    /// Words after a number of tolerances.
    pub fn words(self) -> &'static str {
        match self {
            Self::NoFace => "named no face",
            Self::WholePart => "of the whole part",
            Self::NoValue => "without a value",
            Self::NoKey => "without a key",
        }
    }
}

/// Tables of a study.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct StudyTables {
    /// Unit of lengths.
    pub unit: String,
    /// Lines of `[dimensions]`.
    pub dimensions: Vec<String>,
    /// Tables `[parts.NAME]`.
    pub parts: String,
    /// Names of the parts.
    pub part_names: Vec<String>,
    /// Number of features.
    pub features: usize,
    /// Comments with proposed joints.
    pub joints: Vec<String>,
    /// Number of tolerances in the file.
    pub tolerances: usize,
    /// Number of tolerances that are written as keys of a feature.
    pub written: usize,
    /// Number of tolerances that are keys of a feature once the reader takes them, and comments until then.
    pub waiting: usize,
    /// Tolerances that are comments.
    pub open: Vec<OpenItem>,
}

/// Reason why a model gives no tables.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TableFault {
    /// Neither tolerances nor datums nor dimensions.
    #[error("no semantic tolerances; {annotations} drawn annotations: export with semantic PMI")]
    OnlyDrawn {
        /// Number of drawn annotations.
        annotations: usize,
    },
    /// No coinciding faces, and nothing else.
    #[error("no semantic tolerances, and no faces of two placed parts that coincide")]
    NothingCoincides,
    /// A part of that name.
    #[error("part `{0}` is in the study already")]
    PartExists(String),
    /// A name that no part can have.
    #[error("`{0}` is no name of a part: use letters, digits, - and _")]
    PartName(String),
}

/// Writes the tables of a model.
///
/// # Errors
/// If there is nothing to write, or the name of a part is taken.
pub fn tables(model: &StepModel, request: &TableRequest) -> Result<StudyTables, TableFault> {
    let occurrences = occurrences(model);
    let has_tolerances = model.parts.iter().any(has_semantics);
    let may_coincide = request.joints && occurrences.len() > 1;
    if !has_tolerances && !may_coincide {
        return Err(TableFault::OnlyDrawn { annotations: model.annotations });
    }
    let unit = unit(model, request);
    let prefixed = request.prefixed || occurrences.len() > 1;
    let mut found = StudyTables { unit: unit.1.clone(), tolerances: model.tolerance_count(), ..StudyTables::default() };
    let names = part_names(&occurrences, request)?;
    let mut writers = Vec::new();
    let mut dimensions = UniqueNames::with(&request.taken_dimensions);
    for ((part, occurrence), name) in occurrences.iter().zip(&names) {
        let scale = match part.unit {
            StepUnit::Length(scale) => scale / unit.0,
            _ => 1.0,
        };
        let placement = occurrence.map(|(_, placement)| placement);
        let is_first = writers.iter().all(|writer: &PartWriter<'_>| writer.part.definition != part.definition);
        writers.push(PartWriter::new(part, name.clone(), scale, placement, is_first));
    }
    if request.joints {
        found.joints = joints::propose(&mut writers);
        if !has_tolerances && found.joints.is_empty() {
            return Err(TableFault::NothingCoincides);
        }
    }
    for writer in &mut writers {
        writer.write(request, prefixed, &unit.1, unit.0, &mut dimensions, &mut found);
    }
    found.part_names = names;
    Ok(found)
}

/// Reads a file and writes its tables.
///
/// # Errors
/// If the file is damaged, or there is nothing to write.
pub fn tables_of(bytes: &[u8], request: &TableRequest) -> Result<StudyTables, StepFault> {
    let table = EntityTable::read(bytes)?;
    let model = StepModel::read(&table, request.joints)?;
    Ok(tables(&model, request)?)
}

/// Fault of a file or of its content.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StepFault {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] crate::part21::Part21Error),
    /// The file has nothing for a study.
    #[error(transparent)]
    Content(#[from] TableFault),
}

/// A part, with name and placement if it is in an assembly.
type Occurrence<'m> = (&'m StepPart, Option<(&'m str, Placement)>);

/// Parts of a model at their places; those that carry something if there is no assembly.
fn occurrences(model: &StepModel) -> Vec<Occurrence<'_>> {
    let mut found: Vec<Occurrence<'_>> = Vec::new();
    for placed in &model.placed {
        if let Some(part) = model.parts.iter().find(|part| part.definition == placed.definition) {
            found.push((part, Some((placed.name.as_str(), placed.placement))));
        }
    }
    // Tolerances of the assembly itself, or of a part that is in none.
    let rest = model.parts.iter().filter(|part| has_semantics(part));
    let alone = rest.filter(|part| model.placed.iter().all(|placed| placed.definition != part.definition));
    found.extend(alone.map(|part| (part, None)));
    found
}

fn has_semantics(part: &StepPart) -> bool {
    !part.tolerances.is_empty() || !part.dimensions.is_empty() || !part.datums.is_empty()
}

/// Metres in the unit of lengths, and its name.
fn unit(model: &StepModel, request: &TableRequest) -> (f64, String) {
    let asked = request.unit.as_deref();
    let known = [1e-3, 0.0254, 1.0, 1e-2, 1e-6, 0.3048].map(StepUnit::Length);
    let of_parts = model.parts.iter().map(|part| part.unit).find(|unit| unit.name().is_some());
    let wanted = known.into_iter().find(|unit| asked.is_some() && unit.name() == asked);
    let chosen = wanted.or(of_parts).unwrap_or(StepUnit::MILLIMETRE);
    match (chosen, chosen.name()) {
        (StepUnit::Length(scale), Some(name)) => (scale, name.to_owned()),
        _ => (1e-3, "mm".to_owned()),
    }
}

/// Names of the parts, each different and none taken.
fn part_names(occurrences: &[Occurrence<'_>], request: &TableRequest) -> Result<Vec<String>, TableFault> {
    let mut names = UniqueNames::with(&request.taken_parts);
    let mut found = Vec::new();
    for (index, (part, occurrence)) in occurrences.iter().enumerate() {
        let asked = request.part.as_deref().filter(|_| index == 0);
        if let Some(asked) = asked {
            let is_name = !asked.is_empty() && asked.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
            if !is_name {
                return Err(TableFault::PartName(asked.to_owned()));
            }
        }
        let wanted = match (asked, occurrence) {
            (Some(asked), _) => asked.to_owned(),
            // An occurrence is named by its product: occurrences often have numbers alone.
            (None, _) => name_of(&part.name, "part"),
        };
        if occurrences.len() == 1 && request.taken_parts.contains(&wanted) {
            return Err(TableFault::PartExists(wanted));
        }
        if asked.is_some() && request.taken_parts.contains(&wanted) {
            return Err(TableFault::PartExists(wanted));
        }
        found.push(names.take(&wanted));
    }
    Ok(found)
}
