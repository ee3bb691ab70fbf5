//! Faults of a study, and their places in the file.

use std::ops::Range;
use std::sync::Arc;

use crate::data::DataFault;
use crate::decimal::{SAID, decimal};
use crate::entries::vocabulary::SOLIDS;
use crate::faults::compensator_fault::CompensatorFault;
use crate::faults::zone_fault::ZoneFault;
use crate::typing_habits::TypingHabit;
use sensitol::allocation::CostError;
use sensitol::assembly::NoColumn;
use sensitol::assembly::formula::FormulaFault;
use sensitol::assembly::implicit::ConditionsError;
use sensitol::method::MethodError;
use sensitol::problem::ProblemError;
use sensitol_numeric::characteristic::LimitsError;
use sensitol_numeric::correlation::Refusal;
use sensitol_numeric::dimension::DimensionFault;
use sensitol_numeric::fits::FitError;
use sensitol_numeric::inspection::InspectionError;
use sensitol_numeric::names::{UnknownName, clipped};
use sensitol_numeric::requirement::RequirementError;
use sensitol_spatial::SpatialError;

/// A study that cannot be used: file, place, key, fault, and the text to write instead.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{}{}{}", self.place(), self.message(), self.help().map(|help| format!(" ({help})")).unwrap_or_default(), self.others())]
#[non_exhaustive]
pub struct StudyError {
    /// Name of the file as it was given.
    pub file: String,
    /// Text of the file, as far as it could be read.
    pub text: Arc<str>,
    /// Byte range in the text; None if the fault has no place.
    pub span: Option<Range<usize>>,
    /// Full name of the key at fault, such as `dimensions.a.tolerance`; empty if the fault concerns the whole study.
    pub key: String,
    /// The fault.
    pub fault: Box<StudyFault>,
    /// Other faults of the study, in the order of the file. At most 20 faults are reported in all.
    pub more: Vec<StudyError>,
}

impl StudyError {
    /// Error with the faults in the order of the file, the first of them at the top. Returns None if there is no fault.
    pub(super) fn of(faults: Vec<Fault>, file: &str, text: &Arc<str>) -> Option<Self> {
        let mut faults = faults;
        faults.sort_by_key(|fault| fault.span.as_ref().map_or(usize::MAX, |span| span.start));
        let error = |Fault { span, key, fault }| Self {
            file: file.to_owned(),
            text: Arc::clone(text),
            span,
            key,
            fault,
            more: Vec::new(),
        };
        let mut errors = faults.into_iter().map(error).take(crate::Study::MOST_FAULTS);
        let first = errors.next()?;
        Some(Self { more: errors.collect(), ..first })
    }

    /// Line and column of the fault. Both count from 1, columns in characters. Returns None if the fault has no place.
    ///
    /// ```
    /// use sensitol_study::Study;
    /// let error = Study::from_toml("[dimensions]\na = { nominal = 1, tolerance = -2 }", "gap.toml").unwrap_err();
    /// assert_eq!(error.line_column(), Some((2, 32)));
    /// assert_eq!(error.key, "dimensions.a.tolerance");
    /// ```
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let before = &self.text[..self.span.as_ref()?.start.min(self.text.len())];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Some((1 + before.matches('\n').count(), 1 + before[line_start..].chars().count()))
    }

    /// The fault in words. A long text of the file in it loses its middle.
    pub fn message(&self) -> String {
        clipped(&self.fault.to_string())
    }

    /// Name of the key at fault in a message. A long one loses its middle.
    pub fn place_name(&self) -> String {
        clipped(&self.key)
    }

    /// Text to write instead. Returns None if no general advice exists.
    pub fn help(&self) -> Option<String> {
        self.fault.help().map(|help| clipped(&help))
    }

    /// Text for the number of further faults.
    fn others(&self) -> String {
        match self.more.len() {
            0 => String::new(),
            1 => "; and one more fault".to_owned(),
            more => format!("; and {more} more faults"),
        }
    }

    /// Prefix `file:line:column: key: `, without the parts that are unknown.
    fn place(&self) -> String {
        let at = self.line_column().map(|(line, column)| format!(":{line}:{column}")).unwrap_or_default();
        let key = if self.key.is_empty() { String::new() } else { format!("{}: ", self.place_name()) };
        format!("{}{at}: {key}", self.file)
    }
}

/// The faults of a study.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyFault {
    /// The file cannot be read.
    #[error("the file cannot be read: {reason}")]
    Unreadable {
        /// Message of the operating system.
        reason: String,
    },
    /// A folder was given.
    #[error("this is a folder, not a study")]
    IsFolder {
        /// Path of a study within the folder; None if there is none.
        within: Option<String>,
    },
    /// The file is not text.
    #[error("the file is not UTF-8 text: byte {byte:#04x} at offset {offset}")]
    NotUtf8 {
        /// First byte that is not valid UTF-8.
        byte: u8,
        /// Offset of that byte in the file.
        offset: usize,
    },
    /// The file name does not end in `.toml` or `.json`.
    #[error("a study is a .toml or a .json file")]
    UnknownFormat {
        /// True if the ending is that of a table.
        table: bool,
        /// Path of a study with the same name and a valid ending; None if there is none.
        beside: Option<String>,
    },
    /// The text is neither TOML nor JSON.
    #[error("{message}")]
    Syntax {
        /// Message of the parser.
        message: String,
        /// Probable mistake behind the fault.
        slip: Option<TypingHabit>,
    },
    /// A key that does not exist here.
    #[error("there is no key `{key}` here")]
    UnknownKey {
        /// The key as written.
        key: String,
        /// The most similar valid key.
        nearest: Option<String>,
        /// The valid keys.
        valid: Vec<String>,
    },
    /// A key that is given twice.
    #[error("`{key}` is given twice")]
    DuplicateKey {
        /// The key.
        key: String,
    },
    /// A required key is missing.
    #[error("`{key}` is missing")]
    MissingKey {
        /// The key.
        key: String,
        /// The action to take.
        instead: String,
    },
    /// A value of the wrong kind.
    #[error("{found} stands where {expected} is needed")]
    WrongType {
        /// The kind of value that is needed.
        expected: String,
        /// The kind of value that is there.
        found: String,
    },
    /// A word that is not one of the permitted ones.
    #[error("there is no {what} `{found}`")]
    UnknownWord {
        /// The kind of thing that the word should name.
        what: &'static str,
        /// The word as written.
        found: String,
        /// Most similar permitted word.
        nearest: Option<String>,
        /// Permitted words.
        known: Vec<String>,
    },
    /// NaN or an infinity.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// The number as written.
        text: String,
    },
    /// A number outside its range.
    #[error("{} is not {range}", decimal(*.value, SAID))]
    OutOfRange {
        /// The number.
        value: f64,
        /// Permitted range.
        range: &'static str,
    },
    /// Two keys that exclude or contradict each other.
    #[error("`{a}` and `{b}` {why}")]
    Conflict {
        /// The first key.
        a: &'static str,
        /// The second key.
        b: &'static str,
        /// Reason, as the end of the sentence "`a` and `b` ...".
        why: String,
    },
    /// A key that has no effect for this kind of distribution.
    #[error("`{key}` means nothing for {to}")]
    DoesNotApply {
        /// The key.
        key: &'static str,
        /// Thing that the key does not apply to.
        to: String,
        /// The text to write instead.
        instead: &'static str,
    },
    /// Deviations or limits in the wrong order.
    #[error("the lower value {lower} must be below the upper value {upper}")]
    Swapped {
        /// The value given first.
        lower: f64,
        /// The value given second.
        upper: f64,
    },
    /// The dimension is not possible.
    #[error(transparent)]
    Dimension(#[from] DimensionFault),
    /// The fit is not a tolerance class of ISO 286.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The limits are not possible.
    #[error(transparent)]
    Limits(#[from] LimitsError),
    /// The closure conditions do not determine the unknowns.
    #[error(transparent)]
    Conditions(#[from] ConditionsError),
    /// The assembly in space determines no state.
    #[error(transparent)]
    Spatial(#[from] SpatialError),
    /// A zone or float of an assembly in space is not usable.
    #[error(transparent)]
    Zone(#[from] ZoneFault),
    /// A compensator, an extreme over a motion or a condition is not usable.
    #[error(transparent)]
    Compensator(#[from] CompensatorFault),
    /// A formula is not valid.
    #[error("{0}")]
    Formula(FormulaFault),
    /// A group of equal parts in a formula as if it were one dimension.
    #[error("`{name}` is a group of {count} equal parts, which vary independently")]
    GroupName {
        /// Name of the group.
        name: String,
        /// Number of its parts.
        count: i64,
    },
    /// A name that formulas already use for something else.
    #[error("the name `{name}` is reserved in formulas")]
    ReservedName {
        /// The name.
        name: String,
    },
    /// An empty name.
    #[error("a name must not be empty")]
    EmptyName,
    /// A name with an invisible character, or one that changes the direction of the text.
    #[error("a name must not contain the invisible character U+{:04X}", *character as u32)]
    HiddenCharacter {
        /// The character.
        character: char,
    },
    /// A name that is already in use.
    #[error("the name `{name}` is taken: {by} bears it already")]
    NameTaken {
        /// The name.
        name: String,
        /// Thing that has the name already.
        by: &'static str,
    },
    /// A name in both `[dimensions]` and `[formulas]`.
    #[error("`{name}` is a dimension and a formula")]
    DimensionAndFormula {
        /// The name.
        name: String,
    },
    /// Dimensions that are measured from each other in a circle.
    #[error("`{}` is measured from itself{}", path[0], way(path))]
    FromCircle {
        /// Dimensions of the circle: each is measured from the next, and the last from the first.
        path: Vec<String>,
    },
    /// A configuration that sets a name which is neither a dimension nor a constant.
    #[error("configuration `{configuration}` sets `{name}`, which is not a dimension or constant")]
    UnknownConfigured {
        /// The configuration.
        configuration: String,
        /// The name that it sets.
        name: String,
        /// The most similar dimension or constant.
        nearest: Option<String>,
        /// Dimensions and constants of the study.
        known: Vec<String>,
    },
    /// A configuration that sets a dimension with absolute limits, which do not move with the nominal value.
    #[error("configuration `{configuration}` sets `{name}`, whose limits are absolute")]
    ConfiguredLimits {
        /// The configuration.
        configuration: String,
        /// The dimension.
        name: String,
    },
    /// A configuration with the reserved name `all`.
    #[error("the name `all` stands for every configuration")]
    ReservedConfiguration,
    /// A configuration is requested, but the study has none.
    #[error("the study has no [configurations]")]
    NoConfigurations,
    /// A correlation between two columns of one measured file.
    #[error("the correlation between `{}` and `{}` is that of their rows, {value:.3}", between[0], between[1])]
    CorrelationOfRows {
        /// The dimensions.
        between: [String; 2],
        /// Correlation of their rows.
        value: f64,
    },
    /// A correlation between two dimensions of one zone.
    #[error("`{}` and `{}` lie within one zone, which says how they vary together", between[0], between[1])]
    CorrelationInZone {
        /// The dimensions.
        between: [String; 2],
    },
    /// A joint block with too few or too many dimensions.
    #[error("{}, and `of` names {found}", match law { Some(law) => format!("a {law} is of {} dimensions", if SOLIDS.contains(&law.as_str()) { "three" } else { "two" }), None => "rows are of two dimensions or more".to_owned() })]
    JointCount {
        /// Distribution of the zone; None for measured rows.
        law: Option<String>,
        /// Number of dimensions in `of`.
        found: usize,
    },
    /// A dimension that belongs to two joint blocks.
    #[error("`{name}` belongs to another [[joint]] already")]
    JointTwice {
        /// The dimension.
        name: String,
    },
    /// A dimension of a measured block with values from another file.
    #[error("`{name}` is not measured in {file:?}")]
    JointFile {
        /// The dimension.
        name: String,
        /// The file of the block.
        file: String,
    },
    /// A dimension of a zone without a tolerance band.
    #[error("`{name}` has no tolerance: the half width of the {law} is unknown")]
    JointBand {
        /// The dimension.
        name: String,
        /// Distribution of the zone.
        law: String,
    },
    /// A dimension of a zone that also has a distribution of its own.
    #[error("`{name}` has a distribution, and the {law} says how it varies")]
    JointDistribution {
        /// The dimension.
        name: String,
        /// Distribution of the zone.
        law: String,
    },
    /// A correlation between a dimension of a block of rows or a zone and a dimension outside of it.
    #[error(
        "`{inside}` varies with {others} as their rows or their zone say, so that nothing else is correlated with it"
    )]
    CorrelationBesideRows {
        /// The dimension of the block.
        inside: String,
        /// The other dimensions of the block.
        others: String,
    },
    /// A feature of size without a tolerance band, so that its bonus cannot be computed.
    #[error("`{name}` has no band: its maximum material is unknown")]
    NoMaterial {
        /// The dimension.
        name: String,
    },
    /// A hole that no pin fits into.
    #[error("hole {} is smaller than pin {}: nothing floats", band(hole), band(pin))]
    NothingFloats {
        /// Least and greatest size of the hole.
        hole: [f64; 2],
        /// Least and greatest size of the pin.
        pin: [f64; 2],
    },
    /// A zone wider than the length of its feature.
    #[error("length {length} is below the zone {zone}")]
    LengthBelowZone {
        /// Length of the feature.
        length: f64,
        /// Width of the zone.
        zone: f64,
    },
    /// A fastener with a number of places or holes other than two.
    #[error("`{key}` names {found}, and a fastener holds two parts together")]
    FastenerPair {
        /// The key, `places` or `holes`.
        key: String,
        /// Number of places or holes.
        found: usize,
    },
    /// Units that do not fit together.
    #[error("{what}")]
    Units {
        /// Description of the fault.
        what: String,
        /// The text to write instead.
        remedy: String,
    },
    /// A formula that drives the model and also needs an output of the model.
    #[error("formula `{name}` drives the model and needs its output `{output}`: a cycle")]
    DrivenByOutput {
        /// The formula.
        name: String,
        /// The output that it needs.
        output: String,
    },
    /// A formula that nothing needs, in a study with a program.
    #[error("formula `{name}` reaches neither a characteristic nor the model")]
    IdleFormula {
        /// The formula.
        name: String,
    },
    /// A formula that drives a program has no value at the nominal dimensions, so the program cannot be greeted with one.
    #[error("formula `{name}` drives the model and has no value at the nominal dimensions: {reason}")]
    NoNominal {
        /// The formula.
        name: String,
        /// Reason why it has no value.
        reason: String,
    },
    /// A dimension or constant that is not an input of the model and that no formula uses.
    #[error("the model `{model}` has no input `{name}`, and no formula uses it")]
    UnknownInput {
        /// Name or command of the model.
        model: String,
        /// The dimension or constant.
        name: String,
        /// The most similar input.
        nearest: Option<String>,
        /// Inputs of the model.
        known: Vec<String>,
    },
    /// A file that the model depends on does not exist.
    #[error("there is no file {}", path.display())]
    MissingFile {
        /// Path at which the file was expected.
        path: std::path::PathBuf,
    },
    /// A file that the model depends on is outside the folder that files of the study are read from.
    #[error("{} is outside the folder of studies", path.display())]
    OutsideFile {
        /// Path of the file.
        path: std::path::PathBuf,
    },
    /// A table of answers evaluated elsewhere has no column for a dimension.
    #[error(transparent)]
    MissingColumn(#[from] NoColumn),
    /// Answers evaluated elsewhere are given for a study that runs no external model.
    #[error(
        "points that were evaluated elsewhere answer a [model] command, or characteristics without a formula: the study has neither"
    )]
    NothingExternal,
    /// The study needs an external program, and this build of the library runs none.
    #[error("`{program}` cannot be run: external programs are not part of this build")]
    NoPrograms {
        /// The program of the study.
        program: String,
    },
    /// The study has no dimension or no characteristic.
    #[error("the study has no {what}")]
    Nothing {
        /// `dimension` or `characteristic`.
        what: &'static str,
    },
    /// The correlations of the study are not possible.
    #[error(transparent)]
    Correlation(Refusal),
    /// The analysis options do not fit the study.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// A file of measured values cannot be used.
    #[error(transparent)]
    Data(#[from] DataFault),
    /// A file of processes that cannot be used.
    #[error("{file}{}{}: {fault}", line.map(|line| format!(", line {line}")).unwrap_or_default(), below(key))]
    ProcessFile {
        /// The file as the study names it.
        file: String,
        /// Line in that file, from 1; None if the fault has none.
        line: Option<usize>,
        /// Key in that file; empty if the fault has none.
        key: String,
        /// Fault in that file.
        fault: Box<StudyFault>,
    },
    /// A dimension whose `same_as` names itself.
    #[error("`{name}` is the dimension itself")]
    SameAsItself {
        /// The dimension.
        name: String,
    },
    /// A dimension whose `same_as` names a dimension that has `same_as` too.
    #[error("`{name}` has no cost of its own: it is the same as `{end}`")]
    SameAsChain {
        /// Dimension that `same_as` names.
        name: String,
        /// Dimension whose tolerance that one shares.
        end: String,
    },
    /// The cost is not possible.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A step without a multiple between the bounds.
    #[error("no multiple of the step {step} lies between min {min} and max {max}")]
    NoStep {
        /// The step.
        step: f64,
        /// Least permitted half-width.
        min: f64,
        /// Greatest permitted half-width.
        max: f64,
    },
    /// Tolerance grades with the coarser one first.
    #[error("the grades go from {first} to {last}: write the finer one first")]
    OutOfOrder {
        /// Grade given first.
        first: String,
        /// Grade given last.
        last: String,
    },
    /// No tolerance grade lies between the bounds.
    #[error("no half of a grade from {first} to {last} lies between min and max")]
    NoGrade {
        /// Finest grade.
        first: String,
        /// Coarsest grade.
        last: String,
    },
    /// More steps between the bounds than are permitted.
    #[error(
        "a step of {step} makes {count} tolerances between min and max, and {most} are the most: raise the step or leave it out"
    )]
    TooManySteps {
        /// The step.
        step: f64,
        /// Number of multiples between the bounds.
        count: f64,
        /// Greatest permitted number.
        most: f64,
    },
    /// The inspection is not possible.
    #[error(transparent)]
    Inspection(#[from] InspectionError),
    /// The requirement is not possible.
    #[error(transparent)]
    Requirement(#[from] RequirementError),
    /// Dimensions, model and characteristics do not fit together.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

/// Text of a size or of a range of sizes.
fn band([least, greatest]: &[f64; 2]) -> String {
    let plain = |value: &f64| format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
    if least == greatest { plain(least) } else { format!("{} .. {}", plain(least), plain(greatest)) }
}

/// Text of the chain of names that leads back to the first of them.
fn way(path: &[String]) -> String {
    if path.len() < 2 { String::new() } else { format!(": {} -> {}", path.join(" -> "), path[0]) }
}

impl From<UnknownName> for StudyFault {
    fn from(UnknownName { what, name, nearest, known, .. }: UnknownName) -> Self {
        let known = known.into_iter().map(str::to_owned).collect();
        Self::UnknownWord { what, found: name, nearest, known }
    }
}

/// Text of a key, to follow the place of a fault.
fn below(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!(", {key}") }
}

/// Fault with its place and key, before it becomes a [`StudyError`] with file and text.
pub(super) struct Fault {
    pub(super) span: Option<Range<usize>>,
    pub(super) key: String,
    pub(super) fault: Box<StudyFault>,
}

/// Faults that were found independently of each other.
#[derive(Default)]
pub(super) struct Faults(pub(super) Vec<Fault>);

impl Faults {
    /// Value of a result. Returns None and keeps the faults if the result is an error.
    pub(super) fn take<T>(&mut self, found: Result<T, impl Into<Self>>) -> Option<T> {
        found.map_err(|faults| self.0.extend(faults.into().0)).ok()
    }

    /// Returns `Ok` if no fault was kept.
    pub(super) fn none(self) -> Result<(), Self> {
        if self.0.is_empty() { Ok(()) } else { Err(self) }
    }
}

impl From<Fault> for Faults {
    fn from(fault: Fault) -> Self {
        Self(vec![fault])
    }
}

pub(super) fn fault(span: Range<usize>, key: impl Into<String>, fault: impl Into<StudyFault>) -> Fault {
    Fault { span: Some(span), key: key.into(), fault: Box::new(fault.into()) }
}
