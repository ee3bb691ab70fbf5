//! Why a cost cannot be.

/// Why a cost cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// A constant that must not be negative is, or is not a number.
    #[error("{} must be 0 or above, but is {value}", if *name == "cost" { "a cost".to_owned() } else { format!("the cost constant {name}") })]
    Negative {
        /// The constant.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A constant that must be above 0 is not.
    #[error("the cost constant {name} must be above 0, but is {value}{}", if *value < 0.0 { ": the cost would rise with the tolerance" } else { "" })]
    NotPositive {
        /// The constant.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A tolerance that is not a positive number.
    #[error("a tolerance must be above 0, but {name} is {value}")]
    Tolerance {
        /// Which: `min`, `max` or `tolerance`.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The least tolerance is above the greatest.
    #[error("min {min} is above max {max}")]
    Swapped {
        /// The least.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// A tighter process that costs no more: the cost would rise with the tolerance.
    #[error("the cost rises with the tolerance: {loose} costs more than the tighter {tight}")]
    Rising {
        /// The looser tolerance.
        loose: f64,
        /// The tighter one.
        tight: f64,
    },
    /// A formula without a value.
    #[error("the cost has no value at T = {at}")]
    NoValue {
        /// The half band.
        at: f64,
    },
    /// A formula with a value below 0.
    #[error("the cost must be 0 or above, but is {value} at T = {at}")]
    BelowZero {
        /// The half band.
        at: f64,
        /// Its value.
        value: f64,
    },
    /// Too few points for a line.
    #[error("a table of costs needs two points or more, each a half band and a cost, but has {count}")]
    FewPoints {
        /// How many there are.
        count: usize,
    },
    /// Two costs of one half band.
    #[error("the table of costs has the half band {at} twice")]
    TwicePoint {
        /// The half band.
        at: f64,
    },
    /// A range that the table does not have.
    #[error("{name} is {value}, outside of the table of costs, which goes from {least} to {greatest}")]
    OutsideTable {
        /// Which: `min` or `max`.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least half band of the table.
        least: f64,
        /// The greatest.
        greatest: f64,
    },
    /// A list without a process.
    #[error("the list of processes is empty")]
    NoProcess,
    /// Nothing bears the cost.
    #[error("a cost needs at least one dimension")]
    NoMember,
}
