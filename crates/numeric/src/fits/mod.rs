//! ISO 286-1 fits: from a tolerance class such as `H7` to limit deviations.
//!
//! ```text
//! holes  A..H:   EI = -es                  ES = EI + IT          es, ei: the shaft's upper and lower deviation
//! holes  K..ZC:  ES = -ei + delta          EI = ES - IT          delta = IT(n) - IT(n-1) to grade 8 (K, M, N), 7 (P..ZC)
//! shafts a..h:   es                        ei = es - IT
//! shafts k..zc:  ei                        es = ei + IT
//! JS, js:        both IT/2, not rounded; J, j: tables
//! ```
//!
//! The values are the rounded ones that the standard prints, not formulas: those do not give them back. A class that the
//! standard has no value for is an error that says what there is.
//!
//! Source: ISO 286-1:2010, tables 1 to 5; the values of sizes to 500 mm are those of ISO 286-1:1988, with CD, EF and FG to 50 mm.
//! JS and js of the grades 7 to 11 may be rounded down to whole micrometres by a footnote of the standard; they are not here.

mod class;
mod error;
mod grade;
mod held;
mod tables;
mod unit;

pub use error::FitError;
pub use held::HeldEnd;
pub use held::held_end;
pub use unit::tolerance_unit;

use class::Class;
use grade::{Grade, Side};
use tables::Letter;

/// The largest size that the tables have, in mm.
const LARGEST: f64 = 500.0;

/// Lower and upper deviation of this tolerance class at this nominal size, both in mm.
///
/// Letters D to ZC (holes) and d to zc (shafts) with A, B, C; grades IT01 to IT18; sizes above 0 and up to 500 mm, as far as the
/// standard has them. A size range contains its upper end. Accuracy: the doubles nearest to the printed values.
///
/// # Errors
/// When `class` is not a tolerance class, or the standard has no value for it at this size: the error says what there is.
///
/// ```
/// use crate::fits::deviations;
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

/// The width in mm of a standard grade, such as `7` of IT7, at this nominal size.
///
/// # Errors
/// When the standard has no value for it.
pub fn grade_width(nominal_mm: f64, grade: &str) -> Result<f64, FitError> {
    let [lower, upper] = deviations(nominal_mm, &format!("js{grade}"))?;
    Ok(upper - lower)
}

/// The first and the last grade that the standard has for this letter at this size, with all between them.
fn grades(letter: Letter, side: Side, nominal: f64) -> [Grade; 2] {
    let last = if nominal <= 1.0 { Grade::number(13) } else { Grade::LAST };
    match (side, letter) {
        (Side::Hole, Letter::J) => [Grade::number(6), Grade::number(8)],
        (Side::Shaft, Letter::J) => [Grade::number(5), Grade::number(if nominal <= 3.0 { 8 } else { 7 })],
        // Delta is printed from grade 3; above grade 8 there is K for the smallest sizes alone, and no N to 1 mm.
        (Side::Hole, Letter::K) if nominal > 3.0 => [Grade::number(3), Grade::number(8)],
        (Side::Hole, Letter::N) if nominal <= 1.0 => [Grade::number(3), Grade::number(8)],
        (Side::Hole, letter) if letter >= Letter::K => [Grade::number(3), last],
        _ => [Grade::FIRST, last],
    }
}

/// Lower and upper deviation in mm, of a class that the standard has at this size.
fn limits(letter: Letter, side: Side, grade: Grade, nominal: f64) -> [f64; 2] {
    let it = tables::tolerance(grade, nominal);
    let from_lower = |lower: i32| [lower, lower + it];
    let from_upper = |upper: i32| [upper - it, upper];
    let tenths = match (letter, side) {
        // Not in tenths: half of an odd number of them is none.
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

/// The upper deviation of holes K to ZC, in tenths of a micrometre: the shaft's mirrored, and as much nearer to the zero line as
/// the grade is wider than the next finer one, so that H7/p6 and P7/h6 fit alike.
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
