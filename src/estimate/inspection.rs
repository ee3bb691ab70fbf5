//! Risks of an inspection, from points of which the value is known.

use sensitol_numeric::capability::{EstimatedShare, InspectionRisks, acceptance};
use sensitol_numeric::characteristic::{KeptLimits, SpecLimits};
use sensitol_numeric::inspection::Inspection;

/// Probabilities that a part with this true value is bad and accepted, good and rejected, and accepted.
pub(crate) fn inspected_point(x: f64, good: bool, limits: KeptLimits, gauge: f64, guard: f64) -> [f64; 3] {
    let accepted = acceptance(x, limits, gauge, guard);
    if good { [0.0, 1.0 - accepted, accepted] } else { [accepted, 0.0, accepted] }
}

/// Risks with a guard, from the shares of parts that are bad and accepted, good and rejected, and accepted.
pub(crate) fn inspection_risks(
    (inspection, limits): (Inspection, SpecLimits),
    guard: Option<f64>,
    [false_accept, false_reject, accepted]: [Option<EstimatedShare>; 3],
) -> InspectionRisks {
    let tightened = |limit: Option<f64>, sign: f64| Some(limit? + sign * guard?);
    let some_accepted = accepted.filter(|accepted| accepted.value > 0.0);
    InspectionRisks {
        gauge: inspection.gauge(),
        guard,
        acceptance: [tightened(limits.lower(), 1.0), tightened(limits.upper(), -1.0)],
        false_accept,
        false_reject,
        accepted,
        bad_among_accepted: false_accept.zip(some_accepted).map(|(bad, accepted)| EstimatedShare {
            value: (bad.value / accepted.value).clamp(0.0, 1.0),
            error: bad.error.map(|error| error / accepted.value),
        }),
    }
}
