//! Errors of unknown fits, with the existing ones.

use crate::fits::grade::Side;
use crate::fits::tables::Letter;
use crate::names::nearest;

/// Error for text that is not a tolerance class, or for a class that the standard does not have at a size.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The text is not letters followed by one number.
    #[error("`{found}` is not a tolerance class")]
    NoClass {
        /// Text as written.
        found: String,
    },
    /// The letters denote no fundamental deviation.
    #[error("there is no fundamental deviation `{found}`")]
    UnknownLetter {
        /// Letters as written.
        found: String,
        /// Most similar letters, if any.
        nearest: Option<String>,
        /// All letters, of holes or of shafts.
        known: Vec<&'static str>,
    },
    /// The number is not a tolerance grade.
    #[error("there is no tolerance grade IT{found}")]
    UnknownGrade {
        /// Number as written.
        found: String,
    },
    /// The size is outside the tables.
    #[error("ISO 286 fits are for sizes above 0 and up to 500 mm, not for {nominal} mm")]
    Size {
        /// Nominal size in mm.
        nominal: f64,
    },
    /// The standard does not have the letter at this size.
    #[error("there is no {class} at {nominal} mm")]
    SizeOfLetter {
        /// Tolerance class as written.
        class: String,
        /// Letters of the class.
        letter: &'static str,
        /// Nominal size in mm.
        nominal: f64,
        /// Lower bound of the sizes with this letter, in mm, excluded.
        above: f64,
        /// Upper bound of the sizes with this letter, in mm, included.
        to: f64,
    },
    /// The standard does not have the letter in this grade at this size.
    #[error("there is no {class} at {nominal} mm")]
    GradeOfLetter {
        /// Tolerance class as written.
        class: String,
        /// Letters of the class.
        letter: &'static str,
        /// Nominal size in mm.
        nominal: f64,
        /// Finest grade of the letter at this size.
        first: String,
        /// Coarsest grade of the letter at this size.
        last: String,
    },
}

impl FitError {
    pub(super) fn unknown_letter(found: &str) -> Self {
        let shaft = found.starts_with(|c: char| c.is_ascii_lowercase());
        let side = if shaft { Side::Shaft } else { Side::Hole };
        let known = Letter::ALL.map(|letter| letter.name(side)).to_vec();
        // Prefer `JS` or `js` for `Js` to any other name within one edit.
        let same = known.iter().copied().find(|name| name.eq_ignore_ascii_case(found));
        let nearest = same.or_else(|| nearest(found, known.iter().copied())).map(str::to_owned);
        Self::UnknownLetter { found: found.to_owned(), nearest, known }
    }

    /// Advice on the text to write instead. Returns None if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::NoClass { .. } => Some("write letters and one grade: H7 for a hole, g6 for a shaft".into()),
            Self::UnknownLetter { nearest, known, .. } => {
                let nearest = nearest.as_ref().map(|name| format!("did you mean {name}? ")).unwrap_or_default();
                Some(format!("{nearest}there are {}", known.join(", ")))
            }
            Self::UnknownGrade { .. } => Some("grades are 01, 0 and 1 to 18".into()),
            Self::Size { .. } => None,
            Self::SizeOfLetter { letter, above, to, .. } => {
                Some(format!("{letter} is there for sizes above {above} and up to {to} mm"))
            }
            Self::GradeOfLetter { letter, first, last, .. } => {
                Some(format!("at this size {letter} has the grades {first} to {last}"))
            }
        }
    }
}
