//! Hole or shaft, and the tolerance grades.

use std::fmt;

/// Hole (upper case letters) or shaft (lower case letters).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Hole,
    Shaft,
}

/// Standard tolerance grade, IT01 to IT18, stored as a row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Grade(usize);

impl Grade {
    /// Finest grade, IT01, in row 0.
    pub(super) const FIRST: Self = Self(0);
    /// Coarsest grade, IT18, in row 19.
    pub(super) const LAST: Self = Self(19);

    /// Grade IT1 to IT18 by its number. Row 1 is IT0.
    pub(super) const fn number(number: usize) -> Self {
        Self(number + 1)
    }

    /// Reads `01`, `0` and `1` to `18`. Returns None for other text.
    pub(super) fn parse(text: &str) -> Option<Self> {
        (0..=Self::LAST.0).map(Self).find(|grade| grade.to_string() == text)
    }

    /// Row of the table of tolerances.
    pub(super) fn row(self) -> usize {
        self.0
    }

    /// Next finer grade. IT01 has none and is returned itself.
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
