//! Reasons why a table cannot become a study.

use crate::import::columns::ROLES;
use sensitol_numeric::names::first_of;

/// A fault with the name of its cell in a spreadsheet.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{problem}", self.cell.as_ref().map(|cell| format!("{cell}: ")).unwrap_or_default())]
pub struct ImportFault {
    /// Name of the cell; None if the fault has none.
    pub(crate) cell: Option<String>,
    /// The fault.
    pub problem: ImportProblem,
}

/// The faults of tables.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImportProblem {
    /// The table is empty.
    #[error("the table is empty")]
    Empty,
    /// No row names the required columns.
    #[error("no row names the columns: one is needed for the name of each dimension and one for its nominal value")]
    NoHeader,
    /// Two columns with the same meaning.
    #[error("this column and {other} both hold the {role}")]
    Twice {
        /// Meaning of the columns.
        role: &'static str,
        /// Cell of the other header.
        other: String,
    },
    /// The table has no column of the requested name.
    #[error("there is no column `{header}`")]
    NoColumn {
        /// Header that was requested.
        header: String,
        /// Headers of the table.
        known: Vec<String>,
    },
    /// A cell with text in place of a number.
    #[error("`{text}` is not a number")]
    NoNumber {
        /// Text of the cell.
        text: String,
        /// True if a decimal comma is the reason.
        comma: bool,
    },
    /// A date in place of another value.
    #[error("the cell holds a date: spreadsheets make one of 1-2")]
    Date,
    /// Error value of a spreadsheet formula.
    #[error("the cell holds the error {text}")]
    Error {
        /// The error, such as #REF!.
        text: String,
    },
    /// A percentage in place of a number.
    #[error("`{text} %` is a percentage, where a number belongs")]
    Percent {
        /// The percentage, without its sign.
        text: String,
    },
    /// Two different decimal marks in one table.
    #[error("`{text}` has another decimal mark than {other}")]
    TwoMarks {
        /// Text of the cell.
        text: String,
        /// Name of the other cell.
        other: String,
    },
    /// A row with a nominal value but no name.
    #[error("the dimension of this row has no name")]
    NoName,
    /// A tolerance in an unknown form.
    #[error("`{text}` is not a tolerance")]
    NoTolerance {
        /// Text of the cell.
        text: String,
    },
    /// A tolerance that is given in two columns.
    #[error("the tolerance stands in {other} too")]
    ToleranceTwice {
        /// Name of the other cell.
        other: String,
    },
    /// A negative number where a tolerance on both sides belongs.
    #[error("a tolerance on both sides is not negative, and this one is {value}")]
    NegativeTolerance {
        /// The number.
        value: f64,
    },
    /// Two deviations of which one has a plus and the other no sign.
    #[error("one deviation of `{text}` has a sign and the other has none")]
    MissingSign {
        /// Text of the cell.
        text: String,
    },
    /// Two equal deviations or limits that are not 0.
    #[error("both deviations or limits are {value}, so that nothing varies")]
    EqualDeviations {
        /// The number.
        value: f64,
    },
    /// An upper deviation or limit below the lower one.
    #[error("the upper value {upper} lies below the lower value {lower}")]
    SwappedDeviations {
        /// The upper value.
        upper: f64,
        /// The lower value.
        lower: f64,
    },
    /// A lower deviation without a sign in a column where others are negative.
    #[error("this lower deviation has no sign, and {other} is negative")]
    MixedSigns {
        /// Name of the other cell.
        other: String,
    },
    /// Columns that hold limits or deviations.
    #[error("`{upper}` and `{lower}` may be limits or deviations")]
    LimitsOrDeviations {
        /// Header of the upper value.
        upper: String,
        /// Header of the lower value.
        lower: String,
    },
    /// A nominal value outside its own limits.
    #[error("the nominal value {nominal} lies outside of its limits {lower} .. {upper}")]
    NominalOutside {
        /// The nominal value.
        nominal: f64,
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
        /// Header of the upper limit.
        text: String,
    },
    /// Limits and deviations of a row that differ.
    #[error("the tolerance of this row gives the limits {lower} .. {upper}, and its limits are others")]
    LimitsDiffer {
        /// Lower limit by the tolerance.
        lower: f64,
        /// Upper limit by the tolerance.
        upper: f64,
    },
    /// Two units without a factor between them.
    #[error("the units `{unit}` and `{other}` are not of one kind, or the same number has both")]
    TwoUnits {
        /// One unit.
        unit: String,
        /// The other unit.
        other: String,
    },
    /// A unit beside a nominal value without one.
    #[error("this column is in {unit}, and `{nominal}` has no unit")]
    UnitAlone {
        /// The unit.
        unit: String,
        /// Header of the nominal value.
        nominal: String,
    },
    /// A class of ISO 286 beside a nominal value without a unit.
    #[error("the class {class} of ISO 286 is one of millimetres, and `{nominal}` has no unit")]
    ClassWithoutUnit {
        /// The class.
        class: String,
        /// Header of the nominal value.
        nominal: String,
    },
    /// A row with headers of which none is that of the nominal value.
    #[error("no column holds the nominal value; the headers of this row are {}", quoted(headers))]
    NoNominal {
        /// Headers of the row.
        headers: Vec<String>,
    },
    /// Columns of numbers without a meaning here.
    #[error("{} no known meaning: {}", if headers.len() == 1 { "a column of numbers has" } else { "columns of numbers have" }, quoted(headers))]
    Numbers {
        /// Headers of the columns.
        headers: Vec<String>,
    },
    /// A column of numbers without a header.
    #[error("this column holds numbers and has no header")]
    NumbersWithoutHeader,
    /// Dimensions without a tolerance.
    #[error("{} no tolerance: {}", if names.len() == 1 { "a dimension has" } else { "dimensions have" }, quoted(names))]
    Fixed {
        /// Names of the dimensions.
        names: Vec<String>,
    },
    /// A standard deviation that exceeds the tolerance.
    #[error("the standard deviation {value} exceeds the whole tolerance")]
    WideSigma {
        /// The standard deviation.
        value: f64,
    },
    /// A number of equal parts that is not a whole number from 1 to 1000.
    #[error("{value} is not a number of parts")]
    NoQuantity {
        /// The number.
        value: f64,
    },
    /// A row with the name of a total that is not the sum of the others.
    #[error("`{name}` is {value}, and the rows above add up to {sum}")]
    NoSum {
        /// Name of the row.
        name: String,
        /// Value of the row.
        value: f64,
        /// Sum of the rows above.
        sum: f64,
    },
    /// A lower limit of the characteristic that is not below the upper one.
    #[error("the lower limit {lower} is not below the upper limit {upper}")]
    SwappedLimits {
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
    /// A row of limits without two numbers.
    #[error("`{name}` stands before both limits of the characteristic, and this row does not hold two numbers")]
    NoLimits {
        /// Name of the row.
        name: String,
    },
    /// A deviation on one side only.
    #[error("the upper and the lower deviation belong together, and one of them is missing")]
    OneDeviation,
    /// A word that is not one of the permitted ones.
    #[error("`{text}` is not a {what}")]
    Unknown {
        /// Text of the cell.
        text: String,
        /// Kind of the word: direction or distribution.
        what: &'static str,
        /// Permitted words.
        known: &'static str,
    },
    /// No row has a nominal value.
    #[error("no row has a nominal value")]
    NoDimension,
    /// A number where the names of measured columns belong.
    #[error("the first row names the columns, and this cell is a number")]
    NoNames,
    /// No column of a measured table holds numbers.
    #[error("no column holds measured values")]
    NoMeasured,
    /// All factors are 0, so the characteristic would depend on nothing.
    #[error("every factor is 0: nothing is added up")]
    NoEffect,
}

impl ImportFault {
    pub(super) fn of(cell: String, problem: ImportProblem) -> Self {
        Self { cell: Some(cell), problem }
    }
}

impl ImportProblem {
    /// Advice for the user. Returns None if there is none.
    pub fn help(&self) -> Option<String> {
        if self.is_about_columns() {
            return self.column_help();
        }
        Some(match self {
            Self::NoNumber { comma: true, .. } => {
                "decimal commas need semicolons or tabs between the columns".to_owned()
            }
            Self::NoNumber { .. } => "write a number, or leave the nominal value of a heading empty".to_owned(),
            Self::Date => "format the cell as text or number, and write it again".to_owned(),
            Self::Error { .. } => "correct its formula, or write the value".to_owned(),
            Self::Percent { .. } => "percent of the nominal value belongs into the column of tolerances".to_owned(),
            Self::TwoMarks { .. } => "write all numbers of the table alike".to_owned(),
            Self::NoName => "write a name, or leave the nominal value of a total empty".to_owned(),
            Self::NoTolerance { .. } => {
                "write 0.1, ±0.1, +0.1/-0.05, 2 % or a class such as H7; a unit belongs into the header".to_owned()
            }
            Self::ToleranceTwice { .. } => "leave one of them empty".to_owned(),
            Self::OneDeviation => "write 0 for the one that does not exist".to_owned(),
            Self::Unknown { known, .. } => format!("write {known}"),
            Self::NegativeTolerance { .. } => "write it without sign, or both deviations: +0.1/-0.05".to_owned(),
            Self::MissingSign { .. } => "write both signs: +0.1/-0.2".to_owned(),
            Self::EqualDeviations { .. } => "write the lower one with its sign, or one value as a tolerance".to_owned(),
            Self::SwappedDeviations { .. } => "exchange them, or write the lower one with its sign".to_owned(),
            Self::MixedSigns { .. } => {
                "write a sign before each lower deviation: +0.02 lies above the nominal".to_owned()
            }
            Self::LimitsDiffer { .. } => "correct one of them, or leave one out".to_owned(),
            Self::Fixed { .. } => "write their tolerances".to_owned(),
            Self::WideSigma { .. } => "a number of sigmas in half the band belongs into a column `sigmas`".to_owned(),
            Self::NoQuantity { .. } => "write a whole number from 1 to 1000".to_owned(),
            Self::NoSum { .. } => {
                "leave the nominal value of a total empty, or give a dimension another name".to_owned()
            }
            Self::SwappedLimits { .. } => "exchange them".to_owned(),
            Self::NoLimits { .. } => {
                "write both as numbers: Limits; 0.2; 0.8, or give a dimension another name".to_owned()
            }
            _ => return None,
        })
    }

    /// True if the fault concerns columns or their units.
    fn is_about_columns(&self) -> bool {
        matches!(
            self,
            Self::NoHeader
                | Self::Twice { .. }
                | Self::NoColumn { .. }
                | Self::LimitsOrDeviations { .. }
                | Self::NominalOutside { .. }
                | Self::TwoUnits { .. }
                | Self::UnitAlone { .. }
                | Self::ClassWithoutUnit { .. }
                | Self::NoNominal { .. }
                | Self::Numbers { .. }
                | Self::NumbersWithoutHeader
        )
    }

    /// The help on columns and their units.
    fn column_help(&self) -> Option<String> {
        Some(match self {
            Self::NoHeader => "name them in one row: name and nominal, in German Bezeichnung and Nennmaß".to_owned(),
            Self::Twice { .. } => "give one of them another header".to_owned(),
            Self::NoColumn { known, .. } => format!("its columns are {}", quoted(known)),
            Self::LimitsOrDeviations { .. } => "say which: limits, deviations with their signs, or without".to_owned(),
            Self::NominalOutside { .. } => "correct it, or say that these are deviations".to_owned(),
            Self::TwoUnits { .. } => "write units of one kind, such as mm and µm, and one for each number".to_owned(),
            Self::ClassWithoutUnit { nominal, .. } => format!("write the unit in its header: {nominal} [mm]"),
            Self::NoNominal { .. } => "write a column Nominal, in German Nennmaß".to_owned(),
            Self::UnitAlone { nominal, .. } => format!("write its unit in its header too: {nominal} [mm]"),
            Self::Numbers { .. } => {
                format!(
                    "say what they hold, or leave them out; meanings are {}",
                    ROLES.map(|(_, name, _)| name).join(", ")
                )
            }
            Self::NumbersWithoutHeader => {
                "write a header above it, or remove the column; decimal commas need semicolons between columns"
                    .to_owned()
            }
            _ => return None,
        })
    }
}

/// Number of names that a message lists.
pub(super) const NAMED: usize = 12;

/// Names in backquotes.
fn quoted(names: &[String]) -> String {
    first_of(&names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>(), NAMED)
}
