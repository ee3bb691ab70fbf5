//! Fits of ISO 286-1: from a tolerance class such as `H7` to limit deviations.
//!
//! ```text
//! holes  A..H:   EI = -es                  ES = EI + IT          es, ei: the shaft's upper and lower deviation
//! holes  K..ZC:  ES = -ei + delta          EI = ES - IT          delta = IT(n) - IT(n-1) to grade 8 (K, M, N), 7 (P..ZC)
//! shafts a..h:   es                        ei = es - IT
//! shafts k..zc:  ei                        es = ei + IT
//! JS, js:        both IT/2, not rounded; J, j: tables
//! ```
//!
//! The values are the rounded ones that the standard prints, since its formulas do not reproduce them. If the standard has no value for a
//! class, the error lists the existing ones.
//!
//! Source: ISO 286-1:2010, tables 1 to 5. The values of sizes to 500 mm are those of ISO 286-1:1988, with CD, EF and FG to 50 mm. A
//! footnote of the standard allows JS and js of grades 7 to 11 to be rounded down to whole micrometres. This is not done here.

mod class;
mod error;
mod fixed_end;
mod grade;
mod tables;
mod unit;

pub use crate::fits::fixed_end::FixedEnd;
pub use crate::fits::fixed_end::held_end;
pub use error::FitError;
pub use unit::tolerance_unit;

use class::Class;
use grade::{Grade, Side};
use tables::Letter;

/// Largest size in the tables, in mm.
const LARGEST: f64 = 500.0;

/// Lower and upper deviation of a tolerance class at a nominal size, both in mm.
///
/// Letters: A to ZC (holes) and a to zc (shafts). Grades: IT01 to IT18. Sizes: above 0 and up to 500 mm, as far as the standard has them. A
/// size range contains its upper end. Accuracy: the doubles nearest to the printed values.
///
/// # Errors
/// If `class` is not a tolerance class, or the standard has no value for it at this size. The error lists the existing ones.
///
/// ```
/// use sensitol_numeric::fits::deviations;
/// assert_eq!(deviations(25.0, "H7"), Ok([0.0, 0.021]));
/// assert_eq!(deviations(25.0, "g6"), Ok([-0.020, -0.007]));
/// assert_eq!(deviations(40.0, "N7"), Ok([-0.033, -0.008]));
/// let error = deviations(600.0, "H7").unwrap_err();
/// assert_eq!(error.to_string(), "ISO 286 fits are for sizes above 0 and up to 500 mm, not for 600 mm");
/// ```
pub fn deviations(nominal_mm: f64, class: &str) -> Result<[f64; 2], FitError> {
    let Class { letter, side, grade } = Class::parse(class)?;
    if !(nominal_mm > 0.0 && nominal_mm <= LARGEST) {
        return Err(FitError::Size { nominal: nominal_mm });
    }
    let sizes = letter.sizes();
    if !(nominal_mm > sizes[0] && nominal_mm <= sizes[1]) {
        return Err(FitError::SizeOfLetter {
            class: class.to_owned(),
            letter: letter.name(side),
            nominal: nominal_mm,
            above: sizes[0],
            to: sizes[1],
        });
    }
    let [first, last] = grades(letter, side, nominal_mm);
    if !(first..=last).contains(&grade) {
        return Err(FitError::GradeOfLetter {
            class: class.to_owned(),
            letter: letter.name(side),
            nominal: nominal_mm,
            first: first.to_string(),
            last: last.to_string(),
        });
    }
    Ok(limits(letter, side, grade, nominal_mm))
}

/// Width in mm of a standard grade, such as `7` for IT7, at this nominal size.
///
/// # Errors
/// If the standard has no value for it.
pub fn grade_width(nominal_mm: f64, grade: &str) -> Result<f64, FitError> {
    let [lower, upper] = deviations(nominal_mm, &format!("js{grade}"))?;
    Ok(upper - lower)
}

/// First and last grade of this letter at this size in the standard. All grades between them exist too.
fn grades(letter: Letter, side: Side, nominal: f64) -> [Grade; 2] {
    let last = if nominal <= 1.0 { Grade::number(13) } else { Grade::LAST };
    match (side, letter) {
        (Side::Hole, Letter::J) => [Grade::number(6), Grade::number(8)],
        (Side::Shaft, Letter::J) => [Grade::number(5), Grade::number(if nominal <= 3.0 { 8 } else { 7 })],
        // Delta is printed from grade 3 on. Above grade 8, K exists for the smallest sizes only, and N does not exist up to 1 mm.
        (Side::Hole, Letter::K) if nominal > 3.0 => [Grade::number(3), Grade::number(8)],
        (Side::Hole, Letter::N) if nominal <= 1.0 => [Grade::number(3), Grade::number(8)],
        (Side::Hole, letter) if letter >= Letter::K => [Grade::number(3), last],
        _ => [Grade::FIRST, last],
    }
}

/// Lower and upper deviation in mm, for a class that the standard has at this size.
fn limits(letter: Letter, side: Side, grade: Grade, nominal: f64) -> [f64; 2] {
    let it = tables::tolerance(grade, nominal);
    let from_lower = |lower: i32| [lower, lower + it];
    let from_upper = |upper: i32| [upper - it, upper];
    let tenths = match (letter, side) {
        // Computed apart, since half of an odd number is no whole number of tenths.
        (Letter::Js, _) => return [-f64::from(it) / 20_000.0, f64::from(it) / 20_000.0],
        (Letter::J, Side::Hole) => from_upper(tables::hole_j(grade, nominal)),
        (Letter::J, Side::Shaft) => from_lower(-tables::shaft_j(grade, nominal)),
        (letter, Side::Shaft) if letter <= Letter::H => from_upper(-tables::magnitude(letter, nominal)),
        (letter, Side::Hole) if letter <= Letter::H => from_lower(tables::magnitude(letter, nominal)),
        (Letter::K, Side::Shaft) if !(Grade::number(4)..=Grade::number(7)).contains(&grade) => from_lower(0),
        (letter, Side::Shaft) => from_lower(tables::magnitude(letter, nominal)),
        (letter, Side::Hole) => from_upper(hole_k_to_zc(letter, grade, nominal)),
    };
    tenths.map(|tenths| f64::from(tenths) / 10_000.0)
}

/// Upper deviation of holes K to ZC, in tenths of a micrometre. It mirrors the shaft's, moved towards the zero line by the difference of
/// the grade and the next finer one, so that H7/p6 and P7/h6 give the same fit.
fn hole_k_to_zc(letter: Letter, grade: Grade, nominal: f64) -> i32 {
    let mirrored = -tables::magnitude(letter, nominal);
    let last_with_delta = Grade::number(if letter <= Letter::N { 8 } else { 7 });
    match letter {
        Letter::M if grade == Grade::number(6) && nominal > 250.0 && nominal <= 315.0 => -90,
        Letter::N if grade > last_with_delta && nominal > 3.0 => 0,
        _ if grade > last_with_delta || nominal <= 3.0 => mirrored,
        _ => mirrored + tables::tolerance(grade, nominal) - tables::tolerance(grade.finer(), nominal),
    }
}
