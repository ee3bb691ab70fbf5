//! Errors of a comparison with a lot.

use crate::lot::{LotColumn, LotOptions, LotTable};
use crate::method::MethodError;
use crate::problem::Problem;
use sensitol_numeric::correlation::CorrelationError;
use sensitol_numeric::dimension::DimensionError;
use sensitol_numeric::distribution::DistributionError;
use sensitol_numeric::lot::LotSample;
use sensitol_numeric::names::nearest;

/// Smallest number of values of a measured dimension or characteristic.
pub(crate) const FEWEST: usize = 5;

/// Error of a comparison with a lot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LotError {
    /// There is no measured column.
    #[error("the lot measures nothing of the study: a column bears the name of a dimension or of a characteristic")]
    Nothing,
    /// A column is neither a dimension nor a characteristic.
    #[error("the study has no dimension or characteristic `{name}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownColumn {
        /// Name of the column.
        name: String,
        /// Most similar name, if any.
        nearest: Option<String>,
    },
    /// A dimension or characteristic stands in two columns.
    #[error("`{name}` is measured in two columns{}", twice(tables))]
    MeasuredTwice {
        /// Name of the column.
        name: String,
        /// Names of the two tables.
        tables: [String; 2],
    },
    /// A column has too few values.
    #[error(
        "`{name}` has {found} measured value{}{}, and at least {FEWEST} are needed: measure more parts, or leave the column out",
        if *found == 1 { "" } else { "s" },
        within(table)
    )]
    TooFewParts {
        /// Name of the column.
        name: String,
        /// Number of values.
        found: usize,
        /// Name of the table.
        table: String,
    },
    /// All values of a column are equal.
    #[error(
        "all measured values of `{name}` are {value}{}: a lot without variation has no sigma; write more digits, or leave the column out",
        within(table)
    )]
    AllEqual {
        /// Name of the column.
        name: String,
        /// The value.
        value: f64,
        /// Name of the table.
        table: String,
    },
    /// The values of a column are so far apart that they have no sigma.
    #[error("the measured values of `{name}`{} go from {:e} to {:e}, too far apart for a sigma: correct them", within(table), ends[0], ends[1])]
    TooFarApart {
        /// Name of the column.
        name: String,
        /// Least and greatest value.
        ends: [f64; 2],
        /// Name of the table.
        table: String,
    },
    /// A measured dimension does not vary in the study.
    #[error(
        "`{name}` has no tolerance and no distribution in the study, so that nothing was assumed of it: give it one"
    )]
    NotVarying {
        /// Name of the dimension.
        name: String,
    },
    /// A choice is out of range.
    #[error("{what} must be {range}, but is {value}")]
    Choice {
        /// Name of the choice.
        what: &'static str,
        /// Permitted range.
        range: &'static str,
        /// Value given.
        value: f64,
    },
    /// A measured dimension is impossible.
    #[error(transparent)]
    Dimension(#[from] DimensionError),
    /// A measured distribution is impossible.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// The measured correlations are impossible together.
    #[error(transparent)]
    Correlation(#[from] CorrelationError),
    /// The method does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
}

/// Words on the table of a value.
fn within(table: &str) -> String {
    if table.is_empty() { String::new() } else { format!(" in {table}") }
}

/// Words on the two tables of a column, and the way out.
fn twice([first, second]: &[String; 2]) -> String {
    if first == second {
        return format!("{}: leave one out", within(first));
    }
    format!(
        ", in {first} and {second}: join the rows of both in one table, with a column `lot` that names the lot of each row"
    )
}

/// Measured values of a column.
///
/// # Errors
/// If the values are too few, all equal, or too far apart.
pub(super) fn sample(table: &LotTable, column: &LotColumn) -> Result<LotSample, LotError> {
    let values: Vec<f64> = column.values.iter().copied().flatten().collect();
    let (name, table) = (column.name.clone(), table.name.clone());
    if values.len() < FEWEST {
        return Err(LotError::TooFewParts { name, found: values.len(), table });
    }
    let ends = [values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max)];
    LotSample::new(&values).ok_or(match ends[0] < ends[1] {
        true => LotError::TooFarApart { name, ends, table },
        false => LotError::AllEqual { name, value: values[0], table },
    })
}

/// Checks names, counts and choices.
pub(super) fn checked(problem: &Problem, tables: &[LotTable], options: &LotOptions) -> Result<(), LotError> {
    let range = |what, range, value| Err(LotError::Choice { what, range, value });
    if !(options.level > 0.0 && options.level < 1.0) {
        return range("the family-wise level", "between 0 and 1", options.level);
    }
    let parts = options.assumed_parts;
    if !(parts == 0.0 || parts >= 2.0 && parts.is_finite()) {
        return range("the weight of the study in parts", "0, or 2 or more", parts);
    }
    let columns: Vec<(&LotTable, &LotColumn)> =
        tables.iter().flat_map(|table| table.columns.iter().map(move |column| (table, column))).collect();
    if columns.is_empty() {
        return Err(LotError::Nothing);
    }
    for (place, (table, column)) in columns.iter().enumerate() {
        let name = column.name.clone();
        let dimension = problem.dimensions().iter().find(|one| one.name() == name);
        let known = problem.characteristics().iter().any(|one| one.name() == name);
        if dimension.is_none() && !known {
            let dimensions = problem.dimensions().iter().map(|one| one.name());
            let all = dimensions.chain(problem.characteristics().iter().map(|one| one.name()));
            return Err(LotError::UnknownColumn { nearest: nearest(&name, all).map(str::to_owned), name });
        }
        if let Some((earlier, _)) = columns[..place].iter().find(|(_, earlier)| earlier.name == name) {
            return Err(LotError::MeasuredTwice { name, tables: [earlier.name.clone(), table.name.clone()] });
        }
        if dimension.is_some_and(|one| one.distribution().is_none()) {
            return Err(LotError::NotVarying { name });
        }
        sample(table, column)?;
    }
    Ok(())
}
