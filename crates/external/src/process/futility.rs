//! Programs that fail at every point: at the nominal one and at the first others, for one reason.

use sensitol::assembly::{ProcessError, ProcessFault};

/// Failed points besides the nominal one after which a program without any value is not asked again. A program with values at half of all
/// points, but with none at the nominal one, fails at five others in 3 % of the runs.
const FEW: usize = 5;
/// Failed points after which it is not asked again if the nominal point was not among them. A program with values at 15 % of all points
/// fails at twenty in 4 % of the runs.
const MANY: usize = 20;

/// Outcomes of all points so far.
#[derive(Debug, Default)]
pub(super) struct Futility {
    /// True if some point had a value, or if points failed for different reasons.
    is_of_use: bool,
    /// True if the nominal point failed.
    nominal: bool,
    /// Number of other failed points.
    others: usize,
    /// First failure.
    first: Option<ProcessError>,
}

impl Futility {
    /// True once it is known that the program is worth asking, so that outcomes need not be noted.
    pub(super) fn is_ruled_out(&self) -> bool {
        self.is_of_use
    }

    /// Notes a point with a value.
    pub(super) fn note_value(&mut self) {
        self.is_of_use = true;
    }

    /// Notes a point without any value.
    pub(super) fn note_failure(&mut self, is_nominal: bool, error: &ProcessError) {
        let first = self.first.get_or_insert_with(|| error.clone());
        self.is_of_use |= without_numbers(&first.fault) != without_numbers(&error.fault);
        match is_nominal {
            true => self.nominal = true,
            false => self.others += 1,
        }
    }

    /// Error with which all further points fail; None while the program may be of use.
    pub(super) fn verdict(&self) -> Option<ProcessError> {
        let enough = self.others >= if self.nominal { FEW } else { MANY };
        let first = self.first.as_ref().filter(|_| enough && !self.is_of_use)?;
        let fault = ProcessFault::FailsEverywhere {
            nominal: self.nominal,
            others: self.others,
            message: first.fault.to_string(),
        };
        Some(ProcessError { fault, stderr: first.stderr.clone() })
    }
}

/// Message of a fault without its numbers, which may be coordinates of the point.
fn without_numbers(fault: &ProcessFault) -> String {
    fault.to_string().chars().filter(|c| !c.is_ascii_digit() && !['+', '-', '.'].contains(c)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sensitol::assembly::StderrTail;

    fn error(message: &str) -> ProcessError {
        ProcessError { fault: ProcessFault::NoValue { message: message.to_owned() }, stderr: StderrTail::default() }
    }

    #[test]
    fn one_reason_at_all_points_is_final() {
        let mut futility = Futility::default();
        futility.note_failure(true, &error("no licence at 1.5"));
        for point in 1..=FEW {
            assert_eq!(futility.verdict(), None, "{point}");
            futility.note_failure(false, &error(&format!("no licence at -{point}.25")));
        }
        let fault =
            ProcessFault::FailsEverywhere { nominal: true, others: FEW, message: "no licence at 1.5".to_owned() };
        assert_eq!(futility.verdict().map(|error| error.fault), Some(fault));
    }

    #[test]
    fn a_value_or_another_reason_is_not() {
        let all = |messages: &[&str]| {
            let mut futility = Futility::default();
            futility.note_failure(true, &error(messages[0]));
            messages
                .iter()
                .cycle()
                .skip(1)
                .take(2 * MANY)
                .for_each(|message| futility.note_failure(false, &error(message)));
            futility
        };
        assert!(all(&["does not assemble"]).verdict().is_some());
        assert_eq!(all(&["does not assemble", "face 7 is gone"]).verdict(), None);
        let mut some = all(&["does not assemble"]);
        some.note_value();
        assert_eq!(some.verdict(), None);
    }

    #[test]
    fn without_the_nominal_point_more_points_are_asked() {
        let mut futility = Futility::default();
        (1..MANY).for_each(|_| futility.note_failure(false, &error("no licence")));
        assert_eq!(futility.verdict(), None);
        futility.note_failure(false, &error("no licence"));
        assert!(futility.verdict().is_some());
    }
}
