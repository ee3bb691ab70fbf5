//! Hole or shaft, and the grades.

use std::fmt;

/// Upper case letters are holes, lower case letters shafts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Hole,
    Shaft,
}

/// A standard tolerance grade, IT01 to IT18, as its place in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Grade(usize);

impl Grade {
    /// IT01.
    pub(super) const FIRST: Self = Self(0);
    /// IT18.
    pub(super) const LAST: Self = Self(19);

    /// IT1 to IT18.
    pub(super) const fn number(number: usize) -> Self {
        Self(number + 1)
    }

    /// Of `01` to `18`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        (0..=Self::LAST.0).map(Self).find(|grade| grade.to_string() == text)
    }

    /// The row of the table of tolerances.
    pub(super) fn row(self) -> usize {
        self.0
    }

    /// The next finer grade; IT01 has none and stays.
    pub(super) fn finer(self) -> Self {
        Self(self.0.saturating_sub(1))
    }
}

impl fmt::Display for Grade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => f.write_str("01"),
            row => write!(f, "{}", row - 1),
        }
    }
}
