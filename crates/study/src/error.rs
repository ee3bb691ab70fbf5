//! The faults of a study, and their places.

use std::ops::Range;
use std::sync::Arc;

use super::data::DataFault;
use super::decimal::{SAID, decimal};
use super::slip::Slip;
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
use sensitol_numeric::names::UnknownName;
use sensitol_numeric::requirement::RequirementError;

/// A study that cannot be used: file, place, key, what is wrong, and what to write instead.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{}{}{}", self.place(), self.fault, self.help().map(|help| format!(" ({help})")).unwrap_or_default(), self.others())]
#[non_exhaustive]
pub struct StudyError {
    /// The file's name as it was given.
    pub file: String,
    /// The file's text, as far as it could be read.
    pub text: Arc<str>,
    /// Byte range in the text; None where the fault has no place.
    pub span: Option<Range<usize>>,
    /// The key concerned, with those around it, such as `dimensions.a.tolerance`; empty at the top.
    pub key: String,
    /// The fault.
    pub fault: Box<StudyFault>,
    /// The other faults of the same study, in the order of the file: 20 in all at most.
    pub more: Vec<StudyError>,
}

impl StudyError {
    /// Of the faults of one study, those that come first in its file; None without a fault.
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
        let mut errors = faults.into_iter().map(error).take(super::Study::MOST_FAULTS);
        let first = errors.next()?;
        Some(Self { more: errors.collect(), ..first })
    }

    /// Line and column, both from 1, the column in characters.
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

    /// The text to write instead, where that can be said.
    pub fn help(&self) -> Option<String> {
        self.fault.help()
    }

    /// How many faults there are beside the first.
    fn others(&self) -> String {
        match self.more.len() {
            0 => String::new(),
            1 => "; and one more fault".to_owned(),
            more => format!("; and {more} more faults"),
        }
    }

    /// `file:line:column: key: `, as far as they are known.
    fn place(&self) -> String {
        let at = self.line_column().map(|(line, column)| format!(":{line}:{column}")).unwrap_or_default();
        let key = if self.key.is_empty() { String::new() } else { format!("{}: ", self.key) };
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
        /// The operating system's words.
        reason: String,
    },
    /// A folder was given.
    #[error("this is a folder, not a study")]
    IsFolder {
        /// A study within it, if there is one.
        within: Option<String>,
    },
    /// The file is not text.
    #[error("the file is not UTF-8 text: byte {byte:#04x} at offset {offset}")]
    NotUtf8 {
        /// The first byte that is none.
        byte: u8,
        /// Where it stands.
        offset: usize,
    },
    /// No study format ends like this.
    #[error("a study is a .toml or a .json file")]
    UnknownFormat {
        /// The study of this name with such an ending, if there is one.
        beside: Option<String>,
    },
    /// The text is neither TOML nor JSON.
    #[error("{message}")]
    Syntax {
        /// The parser's words.
        message: String,
        /// The probable meaning.
        slip: Option<Slip>,
    },
    /// A key that means nothing here.
    #[error("there is no key `{key}` here")]
    UnknownKey {
        /// As written.
        key: String,
        /// The most similar valid key.
        nearest: Option<String>,
        /// The valid keys.
        valid: Vec<String>,
    },
    /// A key that stands twice.
    #[error("`{key}` is given twice")]
    DuplicateKey {
        /// The key.
        key: String,
    },
    /// A key that must be there is not.
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
    /// A word that none of the possible ones is.
    #[error("there is no {what} `{found}`")]
    UnknownWord {
        /// The kind of thing that the word should name.
        what: &'static str,
        /// As written.
        found: String,
        /// The most similar possible one.
        nearest: Option<String>,
        /// The possible ones.
        known: Vec<String>,
    },
    /// NaN or an infinity.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// As written.
        text: String,
    },
    /// A number outside its range.
    #[error("{} is not {range}", decimal(*.value, SAID))]
    OutOfRange {
        /// The number.
        value: f64,
        /// The range that it must be in.
        range: &'static str,
    },
    /// Two keys that exclude or contradict each other.
    #[error("`{a}` and `{b}` {why}")]
    Conflict {
        /// One key.
        a: &'static str,
        /// The other.
        b: &'static str,
        /// How they exclude each other.
        why: String,
    },
    /// A key that means nothing for this kind of distribution.
    #[error("`{key}` means nothing for {to}")]
    DoesNotApply {
        /// The key.
        key: &'static str,
        /// For what.
        to: String,
        /// The text to write instead.
        instead: &'static str,
    },
    /// Deviations or limits the wrong way round.
    #[error("the lower value {lower} must be below the upper value {upper}")]
    Swapped {
        /// The value given first.
        lower: f64,
        /// The value given second.
        upper: f64,
    },
    /// The dimension is impossible.
    #[error(transparent)]
    Dimension(#[from] DimensionFault),
    /// There is no such fit.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The limits are impossible.
    #[error(transparent)]
    Limits(#[from] LimitsError),
    /// The closure conditions determine nothing.
    #[error(transparent)]
    Conditions(#[from] ConditionsError),
    /// A formula is wrong.
    #[error("{0}")]
    Formula(FormulaFault),
    /// A name that formulas already use for something else.
    #[error("the name `{name}` is reserved in formulas")]
    ReservedName {
        /// The name.
        name: String,
    },
    /// A name of nothing.
    #[error("a name must not be empty")]
    EmptyName,
    /// A name with a character that is not seen, or that moves others.
    #[error("a name must not contain the invisible character U+{:04X}", *character as u32)]
    HiddenCharacter {
        /// The character.
        character: char,
    },
    /// A name that something else in the study bears.
    #[error("the name `{name}` is taken: {by} bears it already")]
    NameTaken {
        /// The name.
        name: String,
        /// The thing that bears it.
        by: &'static str,
    },
    /// A name that stands in two sections.
    #[error("`{name}` is a dimension and a formula")]
    DimensionAndFormula {
        /// The name.
        name: String,
    },
    /// Dimensions that are measured from each other.
    #[error("`{}` is measured from itself{}", path[0], way(path))]
    FromCircle {
        /// The dimensions, each measured from the next, and the last from the first.
        path: Vec<String>,
    },
    /// A configuration of something else.
    #[error("configuration `{configuration}` sets `{name}`, which is not a dimension or constant")]
    UnknownConfigured {
        /// The configuration.
        configuration: String,
        /// The name.
        name: String,
        /// The most similar dimension or constant.
        nearest: Option<String>,
        /// The dimensions and constants that there are.
        known: Vec<String>,
    },
    /// A configuration of a dimension whose limits do not move with its nominal value.
    #[error("configuration `{configuration}` sets `{name}`, whose limits are absolute")]
    ConfiguredLimits {
        /// The configuration.
        configuration: String,
        /// The dimension.
        name: String,
    },
    /// A configuration that bears the word for all of them.
    #[error("the name `all` stands for every configuration")]
    ReservedConfiguration,
    /// A configuration is asked for, and there is none.
    #[error("the study has no [configurations]")]
    NoConfigurations,
    /// A correlation of two columns of one measured file.
    #[error("the correlation between `{}` and `{}` is that of their rows, {value:.3}", between[0], between[1])]
    CorrelationOfRows {
        /// The dimensions.
        between: [String; 2],
        /// The correlation of the rows.
        value: f64,
    },
    /// A correlation of two dimensions of one zone.
    #[error("`{}` and `{}` lie within one zone, which says how they vary together", between[0], between[1])]
    CorrelationInZone {
        /// The dimensions.
        between: [String; 2],
    },
    /// A joint block of too few or too many dimensions.
    #[error("{}, and `of` names {found}", match law { Some(law) => format!("a {law} is of two dimensions"), None => "rows are of two dimensions or more".to_owned() })]
    JointCount {
        /// The law of the zone; None of measured rows.
        law: Option<String>,
        /// How many dimensions there are.
        found: usize,
    },
    /// A dimension of two blocks.
    #[error("`{name}` belongs to another [[joint]] already")]
    JointTwice {
        /// The dimension.
        name: String,
    },
    /// A dimension of a measured block whose values come from elsewhere.
    #[error("`{name}` is not measured in {file:?}")]
    JointFile {
        /// The dimension.
        name: String,
        /// The file of the block.
        file: String,
    },
    /// A dimension of a zone without a band.
    #[error("`{name}` has no tolerance: the half width of the {law} is unknown")]
    JointBand {
        /// The dimension.
        name: String,
        /// The law of the zone.
        law: String,
    },
    /// A dimension of a zone with a distribution of its own.
    #[error("`{name}` has a distribution, and the {law} says how it varies")]
    JointDistribution {
        /// The dimension.
        name: String,
        /// The law of the zone.
        law: String,
    },
    /// A correlation of a measured dimension that varies with others of its file, and one beside them.
    #[error(
        "`{inside}` varies with {others} as their rows or their zone say, so that nothing else is correlated with it"
    )]
    CorrelationBesideRows {
        /// The dimension.
        inside: String,
        /// The others of the same rows.
        others: String,
    },
    /// A feature whose size gives a bonus, and that has no band.
    #[error("`{name}` has no band: its maximum material is unknown")]
    NoMaterial {
        /// The dimension.
        name: String,
    },
    /// A hole that no pin passes.
    #[error("hole {} is smaller than pin {}: nothing floats", band(hole), band(pin))]
    NothingFloats {
        /// Least and greatest size of the hole.
        hole: [f64; 2],
        /// And of the pin.
        pin: [f64; 2],
    },
    /// A zone that is wider than its feature is long.
    #[error("length {length} is below the zone {zone}")]
    LengthBelowZone {
        /// The length.
        length: f64,
        /// The zone.
        zone: f64,
    },
    /// A fastener of more or fewer than two places or holes.
    #[error("`{key}` names {found}, and a fastener holds two parts together")]
    FastenerPair {
        /// `places` or `holes`.
        key: String,
        /// How many there are.
        found: usize,
    },
    /// Units that do not go together.
    #[error("{what}")]
    Units {
        /// The fault.
        what: String,
        /// The text to write instead.
        remedy: String,
    },
    /// A formula that drives the model and needs what it answers.
    #[error("formula `{name}` drives the model and needs its output `{output}`: a cycle")]
    DrivenByOutput {
        /// The formula.
        name: String,
        /// The output of the model.
        output: String,
    },
    /// A formula beside a program that nothing needs.
    #[error("formula `{name}` reaches neither a characteristic nor the model")]
    IdleFormula {
        /// The formula.
        name: String,
    },
    /// A formula that drives a program has no value where the program is greeted with one.
    #[error("formula `{name}` drives the model and has no value at the nominal dimensions: {reason}")]
    NoNominal {
        /// The formula.
        name: String,
        /// Why.
        reason: String,
    },
    /// A dimension or constant that the model does not have and no formula uses.
    #[error("the model `{model}` has no input `{name}`, and no formula uses it")]
    UnknownInput {
        /// The model.
        model: String,
        /// The name.
        name: String,
        /// The most similar input.
        nearest: Option<String>,
        /// The inputs that there are.
        known: Vec<String>,
    },
    /// A file that the model depends on is not there.
    #[error("there is no file {}", path.display())]
    MissingFile {
        /// Where it was looked for.
        path: std::path::PathBuf,
    },
    /// Answers evaluated elsewhere do not say for which value of a dimension.
    #[error(transparent)]
    MissingColumn(#[from] NoColumn),
    /// Answers evaluated elsewhere, for a study that runs no model.
    #[error(
        "points that were evaluated elsewhere answer a [model] command, or characteristics without a formula: the study has neither"
    )]
    NothingExternal,
    /// This build of the library runs no external programs.
    #[error("`{program}` cannot be run: external programs are not part of this build")]
    NoPrograms {
        /// The program of the study.
        program: String,
    },
    /// There is nothing to evaluate.
    #[error("the study has no {what}")]
    Nothing {
        /// `dimension` or `characteristic`.
        what: &'static str,
    },
    /// Dimensions cannot vary together like this.
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
        /// The line, from 1; None where the fault has none.
        line: Option<usize>,
        /// The key in it; empty where the fault has none.
        key: String,
        /// The fault.
        fault: Box<StudyFault>,
    },
    /// A dimension that would share its own tolerance.
    #[error("`{name}` is the dimension itself")]
    SameAsItself {
        /// The dimension.
        name: String,
    },
    /// A dimension that would share the tolerance of one that shares another's.
    #[error("`{name}` has no cost of its own: it is the same as `{end}`")]
    SameAsChain {
        /// The dimension named.
        name: String,
        /// The one that it is the same as.
        end: String,
    },
    /// A cost is impossible.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A step that no tolerance within the bounds is a multiple of.
    #[error("no multiple of the step {step} lies between min {min} and max {max}")]
    NoStep {
        /// The step.
        step: f64,
        /// The least half band.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// Grades from a coarser to a finer one.
    #[error("the grades go from {first} to {last}: write the finer one first")]
    OutOfOrder {
        /// The first.
        first: String,
        /// The last.
        last: String,
    },
    /// No grade between the bounds.
    #[error("no half of a grade from {first} to {last} lies between min and max")]
    NoGrade {
        /// The first.
        first: String,
        /// The last.
        last: String,
    },
    /// More steps than a list should have.
    #[error(
        "a step of {step} makes {count} tolerances between min and max, and {most} are the most: raise the step or leave it out"
    )]
    TooManySteps {
        /// The step.
        step: f64,
        /// How many.
        count: f64,
        /// The most.
        most: f64,
    },
    /// An inspection is impossible.
    #[error(transparent)]
    Inspection(#[from] InspectionError),
    /// A requirement is impossible.
    #[error(transparent)]
    Requirement(#[from] RequirementError),
    /// Dimensions, model and characteristics do not fit together.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

/// From the least to the greatest size.
fn band([least, greatest]: &[f64; 2]) -> String {
    let plain = |value: &f64| format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
    if least == greatest { plain(least) } else { format!("{} .. {}", plain(least), plain(greatest)) }
}

/// The way back to the first of these names.
fn way(path: &[String]) -> String {
    if path.len() < 2 { String::new() } else { format!(": {} -> {}", path.join(" -> "), path[0]) }
}

impl From<UnknownName> for StudyFault {
    fn from(UnknownName { what, name, nearest, known }: UnknownName) -> Self {
        let known = known.into_iter().map(str::to_owned).collect();
        Self::UnknownWord { what, found: name, nearest, known }
    }
}

/// A key after the place of a fault.
fn below(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!(", {key}") }
}

/// A fault with its place and its key, on its way to becoming a [`StudyError`].
pub(super) struct Fault {
    pub(super) span: Option<Range<usize>>,
    pub(super) key: String,
    pub(super) fault: Box<StudyFault>,
}

/// Faults that were found independently of each other, and what was found without one; `Err` where there is any.
#[derive(Default)]
pub(super) struct Faults(pub(super) Vec<Fault>);

impl Faults {
    /// The result of a part of the study; None where it is at fault, which is kept.
    pub(super) fn take<T>(&mut self, found: Result<T, impl Into<Self>>) -> Option<T> {
        found.map_err(|faults| self.0.extend(faults.into().0)).ok()
    }

    /// Everything so far, if nothing was at fault.
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
