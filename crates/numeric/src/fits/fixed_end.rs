//! End of a tolerance band that the letter of a class defines.

/// End of a tolerance band that stays in place when the band opens and closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FixedEnd {
    /// Lower end, as for a hole H7.
    Lower,
    /// Upper end, as for a shaft h7.
    Upper,
}

impl FixedEnd {
    /// Direction in which the middle of the band moves when its half-width grows: 1 up, -1 down.
    pub(crate) fn lean(self) -> f64 {
        match self {
            Self::Lower => 1.0,
            Self::Upper => -1.0,
        }
    }
}

/// End of the band that the letter of a class defines: the one nearer to the nominal size. The grade defines the other end. Returns None
/// for J and JS, whose band lies about the nominal size, and for text that is not a class.
pub fn held_end(class: &str) -> Option<FixedEnd> {
    let first = class.trim().chars().next()?;
    let lower = match first.to_ascii_lowercase() {
        'a'..='h' => first.is_ascii_uppercase(),
        'k'..='z' => first.is_ascii_lowercase(),
        _ => return None,
    };
    Some(if lower { FixedEnd::Lower } else { FixedEnd::Upper })
}

#[cfg(test)]
mod tests {
    use super::{FixedEnd, held_end};
    use crate::fits::deviations;

    /// Grades of the same letter share the deviation at the held end, in the tables of the standard. K to ZC of holes change it with the
    /// grade by their delta. They are left out, except for grades above 8, where the delta is 0.
    #[test]
    fn the_held_end_is_that_of_every_grade() {
        for class in ["D", "E", "F", "G", "H", "d", "e", "f", "g", "h", "m", "n", "p", "r", "s"] {
            let [fine, coarse] = [6, 7].map(|grade| deviations(25.0, &format!("{class}{grade}")).unwrap());
            let held = held_end(&format!("{class}7")).unwrap();
            let end = usize::from(held == FixedEnd::Upper);
            assert_eq!(fine[end], coarse[end], "{class}");
            assert_ne!(fine[1 - end], coarse[1 - end], "{class}");
        }
        let [fine, coarse] = [9, 10].map(|grade| deviations(25.0, &format!("P{grade}")).unwrap());
        assert_eq!((held_end("P9"), fine[1]), (Some(FixedEnd::Upper), coarse[1]));
        assert_eq!([held_end("js7"), held_end("J7"), held_end("7"), held_end("")], [None; 4]);
    }
}
