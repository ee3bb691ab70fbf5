//! Reasons why a cost is not valid.

/// Reason why a cost is not valid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// Constant that is negative or not a number.
    #[error("{} must be 0 or above, but is {value}", if *name == "cost" { "a cost".to_owned() } else { format!("the cost constant {name}") })]
    Negative {
        /// Name of the constant.
        name: &'static str,
        /// Value of the constant.
        value: f64,
    },
    /// Constant that is not above 0.
    #[error("the cost constant {name} must be above 0, but is {value}{}", if *value < 0.0 { ": the cost would rise with the tolerance" } else { "" })]
    NotPositive {
        /// Name of the constant.
        name: &'static str,
        /// Value of the constant.
        value: f64,
    },
    /// Tolerance that is not a positive number.
    #[error("a tolerance must be above 0, but {name} is {value}")]
    Tolerance {
        /// Name of the tolerance: `min`, `max` or `tolerance`.
        name: &'static str,
        /// Value of the tolerance.
        value: f64,
    },
    /// Least tolerance that is above the greatest.
    #[error("min {min} is above max {max}")]
    Swapped {
        /// Least tolerance.
        min: f64,
        /// Greatest tolerance.
        max: f64,
    },
    /// Looser process that costs more than a tighter one: the cost would rise with the tolerance.
    #[error("the cost rises with the tolerance: {loose} costs more than the tighter {tight}")]
    Rising {
        /// Looser tolerance.
        loose: f64,
        /// Tighter tolerance.
        tight: f64,
    },
    /// Formula without a value.
    #[error("the cost has no value at T = {at}")]
    NoValue {
        /// Half band without a value.
        at: f64,
    },
    /// Formula with a value below 0.
    #[error("the cost must be 0 or above, but is {value} at T = {at}")]
    BelowZero {
        /// Half band of the value.
        at: f64,
        /// Cost there.
        value: f64,
    },
    /// Table with too few points for a line.
    #[error("a table of costs needs two points or more, each a half band and a cost, but has {count}")]
    FewPoints {
        /// Number of points.
        count: usize,
    },
    /// Table with two costs of one half band.
    #[error("the table of costs has the half band {at} twice")]
    TwicePoint {
        /// Half band that occurs twice.
        at: f64,
    },
    /// Range that the table does not cover.
    #[error("{name} is {value}, outside of the table of costs, which goes from {least} to {greatest}")]
    OutsideTable {
        /// Name of the bound: `min` or `max`.
        name: &'static str,
        /// Value of the bound.
        value: f64,
        /// Least half band of the table.
        least: f64,
        /// Greatest half band of the table.
        greatest: f64,
    },
    /// List without a process.
    #[error("the list of processes is empty")]
    NoProcess,
    /// Cost without a dimension.
    #[error("a cost needs at least one dimension")]
    NoMember,
}
