//! The end of a tolerance band that a letter gives.

/// The end of a tolerance band that stays where it is when the band opens and closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeldEnd {
    /// The lower one, as of a hole H7.
    Lower,
    /// The upper one, as of a shaft h7.
    Upper,
}

impl HeldEnd {
    /// Where the middle of the band goes when its half width grows: up or down.
    pub(crate) fn lean(self) -> f64 {
        match self {
            Self::Lower => 1.0,
            Self::Upper => -1.0,
        }
    }
}

/// The end of the band that the letter of a class gives, the one nearer to the nominal size; None of J and JS, which lie about it, and of what
/// is not a class. The grade gives the other end.
pub fn held_end(class: &str) -> Option<HeldEnd> {
    let first = class.trim().chars().next()?;
    let lower = match first.to_ascii_lowercase() {
        'a'..='h' => first.is_ascii_uppercase(),
        'k'..='z' => first.is_ascii_lowercase(),
        _ => return None,
    };
    Some(if lower { HeldEnd::Lower } else { HeldEnd::Upper })
}

#[cfg(test)]
mod tests {
    use super::super::deviations;
    use super::{HeldEnd, held_end};

    /// Another grade of the same letter has the same deviation at the end that is held, in the standard's own tables; K to ZC of holes change
    /// it with the grade by their delta, and are left out but for the grades above 8, where it is 0.
    #[test]
    fn the_held_end_is_that_of_every_grade() {
        for class in ["D", "E", "F", "G", "H", "d", "e", "f", "g", "h", "m", "n", "p", "r", "s"] {
            let [fine, coarse] = [6, 7].map(|grade| deviations(25.0, &format!("{class}{grade}")).unwrap());
            let held = held_end(&format!("{class}7")).unwrap();
            let end = usize::from(held == HeldEnd::Upper);
            assert_eq!(fine[end], coarse[end], "{class}");
            assert_ne!(fine[1 - end], coarse[1 - end], "{class}");
        }
        let [fine, coarse] = [9, 10].map(|grade| deviations(25.0, &format!("P{grade}")).unwrap());
        assert_eq!((held_end("P9"), fine[1]), (Some(HeldEnd::Upper), coarse[1]));
        assert_eq!([held_end("js7"), held_end("J7"), held_end("7"), held_end("")], [None; 4]);
    }
}
