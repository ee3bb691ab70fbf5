//! Why there is no such fit, and what there is.

use super::grade::Side;
use super::tables::Letter;
use crate::names::nearest;

/// A tolerance class that is none, or that the standard does not have at a size.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Not letters followed by one number.
    #[error("`{found}` is not a tolerance class")]
    NoClass {
        /// As written.
        found: String,
    },
    /// Letters that stand for no fundamental deviation.
    #[error("there is no fundamental deviation `{found}`")]
    UnknownLetter {
        /// As written.
        found: String,
        /// The most similar one.
        nearest: Option<String>,
        /// Those that there are, of holes or of shafts.
        known: Vec<&'static str>,
    },
    /// A number that is not a grade.
    #[error("there is no tolerance grade IT{found}")]
    UnknownGrade {
        /// As written.
        found: String,
    },
    /// A size outside the tables.
    #[error("ISO 286 fits are for sizes above 0 and up to 500 mm, not for {nominal} mm")]
    Size {
        /// The nominal size in mm.
        nominal: f64,
    },
    /// A size at which the standard does not have the letter.
    #[error("there is no {class} at {nominal} mm")]
    SizeOfLetter {
        /// The tolerance class.
        class: String,
        /// Its letters.
        letter: &'static str,
        /// The nominal size in mm.
        nominal: f64,
        /// The sizes at which there is one begin above this, in mm,
        above: f64,
        /// and end here, included, in mm.
        to: f64,
    },
    /// A grade in which the standard does not have the letter at this size.
    #[error("there is no {class} at {nominal} mm")]
    GradeOfLetter {
        /// The tolerance class.
        class: String,
        /// Its letters.
        letter: &'static str,
        /// The nominal size in mm.
        nominal: f64,
        /// The finest grade that the letter has there.
        first: String,
        /// The coarsest.
        last: String,
    },
}

impl FitError {
    pub(super) fn unknown_letter(found: &str) -> Self {
        let shaft = found.starts_with(|c: char| c.is_ascii_lowercase());
        let side = if shaft { Side::Shaft } else { Side::Hole };
        let known = Letter::ALL.map(|letter| letter.name(side)).to_vec();
        // `Js` is `JS` or `js`, and no other that an edit may turn it into.
        let same = known.iter().copied().find(|name| name.eq_ignore_ascii_case(found));
        let nearest = same.or_else(|| nearest(found, known.iter().copied())).map(str::to_owned);
        Self::UnknownLetter { found: found.to_owned(), nearest, known }
    }

    /// The text to write instead.
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
