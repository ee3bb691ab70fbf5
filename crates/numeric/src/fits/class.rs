//! Tolerance class: letter, hole or shaft, grade.

use crate::fits::error::FitError;
use crate::fits::grade::{Grade, Side};
use crate::fits::tables::Letter;

/// Tolerance class such as `H7`, `js6` or `zc11`.
pub(super) struct Class {
    pub(super) letter: Letter,
    pub(super) side: Side,
    pub(super) grade: Grade,
}

impl Class {
    pub(super) fn parse(text: &str) -> Result<Self, FitError> {
        let digits = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (letters, number) = text.split_at(digits);
        if number.is_empty() || letters.is_empty() || !number.chars().all(|c| c.is_ascii_digit()) {
            return Err(FitError::NoClass { found: text.to_owned() });
        }
        // Mixed case is rejected: `Js7` is neither a hole nor a shaft.
        let all = [Side::Hole, Side::Shaft].into_iter().flat_map(|side| Letter::ALL.map(|letter| (letter, side)));
        let known = all.into_iter().find(|(letter, side)| letter.name(*side) == letters);
        let (letter, side) = known.ok_or_else(|| FitError::unknown_letter(letters))?;
        let grade = Grade::parse(number).ok_or_else(|| FitError::UnknownGrade { found: number.to_owned() })?;
        Ok(Self { letter, side, grade })
    }
}
