//! Reasons why a table cannot become a study.

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
        /// Header that was asked for.
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
    /// A name that occurs twice.
    #[error("`{name}` stands in {other} already")]
    NameTwice {
        /// The name.
        name: String,
        /// Name of the other cell.
        other: String,
    },
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
        let list = |known: &[String]| known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        Some(match self {
            Self::NoHeader => "name them in one row: name and nominal, in German Bezeichnung and Nennmaß".to_owned(),
            Self::Twice { .. } => "give one of them another header".to_owned(),
            Self::NoColumn { known, .. } => format!("its columns are {}", list(known)),
            Self::NoNumber { comma: true, .. } => {
                "decimal commas need semicolons or tabs between the columns".to_owned()
            }
            Self::NoNumber { .. } => "write a number, or leave the nominal value of a heading empty".to_owned(),
            Self::Date => "format the cell as text or number, and write it again".to_owned(),
            Self::Error { .. } => "correct its formula, or write the value".to_owned(),
            Self::Percent { .. } => "percent of the nominal value belongs into the column of tolerances".to_owned(),
            Self::TwoMarks { .. } => "write all numbers of the table alike".to_owned(),
            Self::NoName => "write a name, or leave the nominal value of a total empty".to_owned(),
            Self::NameTwice { .. } => "one of the two needs another name".to_owned(),
            Self::NoTolerance { .. } => "write 0.1, ±0.1, +0.1/-0.05, 2 % or a class such as H7".to_owned(),
            Self::ToleranceTwice { .. } => "leave one of them empty".to_owned(),
            Self::OneDeviation => "write 0 for the one that does not exist".to_owned(),
            Self::Unknown { known, .. } => format!("write {known}"),
            Self::Empty | Self::NoDimension | Self::NoEffect => return None,
        })
    }
}
