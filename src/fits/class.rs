//! A tolerance class: letter, hole or shaft, grade.

use std::fmt;

use super::error::FitError;
use super::tables::Letter;

/// `H7`, `js6`, `zc11`.
pub(super) struct Class {
    pub(super) letter: Letter,
    pub(super) side: Side,
    pub(super) grade: Grade,
}

/// Upper case letters are holes, lower case letters shafts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Hole,
    Shaft,
}

/// A standard tolerance grade, IT01 to IT18, as its place in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Grade(usize);

impl Class {
    pub(super) fn parse(text: &str) -> Result<Self, FitError> {
        let digits = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (letters, number) = text.split_at(digits);
        if number.is_empty() || letters.is_empty() || !number.chars().all(|c| c.is_ascii_digit()) {
            return Err(FitError::NoClass { found: text.to_owned() });
        }
        // `Js7` is neither a hole nor a shaft.
        let all = [Side::Hole, Side::Shaft].into_iter().flat_map(|side| Letter::ALL.map(|letter| (letter, side)));
        let known = all.into_iter().find(|(letter, side)| letter.name(*side) == letters);
        let (letter, side) = known.ok_or_else(|| FitError::unknown_letter(letters))?;
        let grade = Grade::parse(number).ok_or_else(|| FitError::UnknownGrade { found: number.to_owned() })?;
        Ok(Self { letter, side, grade })
    }
}

impl Grade {
    /// IT01.
    pub(super) const FIRST: Self = Self(0);
    /// IT18.
    pub(super) const LAST: Self = Self(19);

    /// IT1 to IT18.
    pub(super) const fn number(number: usize) -> Self {
        Self(number + 1)
    }

    fn parse(text: &str) -> Option<Self> {
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
