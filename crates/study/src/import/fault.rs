//! Why a table cannot become a study.

/// A fault with the cell that it is about, as a spreadsheet names it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{problem}", self.cell.as_ref().map(|cell| format!("{cell}: ")).unwrap_or_default())]
pub struct ImportFault {
    /// The cell; None where the fault has none.
    pub(crate) cell: Option<String>,
    /// The fault.
    pub problem: ImportProblem,
}

/// The faults of tables.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImportProblem {
    /// Nothing is in it.
    #[error("the table is empty")]
    Empty,
    /// No row names the columns that are needed.
    #[error("no row names the columns: one is needed for the name of each dimension and one for its nominal value")]
    NoHeader,
    /// Two columns of the same meaning.
    #[error("this column and {other} both hold the {role}")]
    Twice {
        /// Their meaning.
        role: &'static str,
        /// The cell of the other header.
        other: String,
    },
    /// A column is named that the table has not.
    #[error("there is no column `{header}`")]
    NoColumn {
        /// As asked for.
        header: String,
        /// The columns that there are.
        known: Vec<String>,
    },
    /// A cell that holds something else where a number belongs.
    #[error("`{text}` is not a number")]
    NoNumber {
        /// The cell.
        text: String,
        /// Whether a decimal comma is the reason.
        comma: bool,
    },
    /// A date where something else belongs.
    #[error("the cell holds a date: spreadsheets make one of 1-2")]
    Date,
    /// The result of a formula that cannot be computed.
    #[error("the cell holds the error {text}")]
    Error {
        /// Such as #REF!.
        text: String,
    },
    /// A percentage where a number belongs.
    #[error("`{text} %` is a percentage, where a number belongs")]
    Percent {
        /// The percentage.
        text: String,
    },
    /// Two styles of numbers.
    #[error("`{text}` has another decimal mark than {other}")]
    TwoMarks {
        /// The cell.
        text: String,
        /// The other cell.
        other: String,
    },
    /// A nominal value without a name.
    #[error("the dimension of this row has no name")]
    NoName,
    /// A name that stands twice.
    #[error("`{name}` stands in {other} already")]
    NameTwice {
        /// The name.
        name: String,
        /// The other cell.
        other: String,
    },
    /// A tolerance in no form that is known.
    #[error("`{text}` is not a tolerance")]
    NoTolerance {
        /// The cell.
        text: String,
    },
    /// A tolerance twice.
    #[error("the tolerance stands in {other} too")]
    ToleranceTwice {
        /// The other cell.
        other: String,
    },
    /// One deviation without the other.
    #[error("the upper and the lower deviation belong together, and one of them is missing")]
    OneDeviation,
    /// A word that is none of those that are known.
    #[error("`{text}` is not a {what}")]
    Unknown {
        /// The cell.
        text: String,
        /// A direction or a distribution.
        what: &'static str,
        /// The words that are known.
        known: &'static str,
    },
    /// No row is a dimension.
    #[error("no row has a nominal value")]
    NoDimension,
    /// All that is imported has no effect.
    #[error("every factor is 0: nothing is added up")]
    NoEffect,
}

impl ImportFault {
    pub(super) fn of(cell: String, problem: ImportProblem) -> Self {
        Self { cell: Some(cell), problem }
    }
}

impl ImportProblem {
    /// The way out, where one can be named.
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
