//! Risks of an inspection, from the distribution that the yield comes from, and from the sample of the model if there is one.

use crate::analysis::{CharacteristicAnalysis, YieldSource};
use crate::estimate::{OrderedPoints, inspected_point, inspection_risks};
use sensitol_numeric::capability::{EstimatedShare, InspectionRisks, Law, Risks, Tails, guard_for};
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::inspection::{Guard, Inspection};
use sensitol_numeric::law::{LawTail, SurfaceLaw};

/// Risks of the inspection of a characteristic whose yield is settled. Returns None if there is no inspection, and if nothing is known of
/// its distribution.
///
/// `points` of the surface replace a distribution that is refuted.
pub(in crate::analysis) fn inspected(
    one: &CharacteristicAnalysis,
    kept: KeptLimits,
    surface: Option<&SurfaceLaw>,
    points: Option<&OrderedPoints>,
) -> Option<InspectionRisks> {
    let inspection = one.characteristic.inspection()?;
    let limits = one.characteristic.limits();
    let fit = one.evidence.law.as_ref().and_then(|law| law.as_ref().ok());
    // The distribution of a surface that does not vary is a step: the closed form is more accurate than the integrals.
    let surface = surface.filter(|_| !matches!(fit, Some(Law::Point { .. })));
    match (surface, fit) {
        (Some(surface), _) => {
            let (below, above) = (|x: f64| surface.below(x).value, |x: f64| surface.above(x).value);
            Some(by(one, inspection, (limits, kept), &Tails { below: &below, above: &above }, surface_error(one)))
        }
        (None, Some(Law::Point { at })) => {
            // A value that keeps a limit except for rounding is moved onto it.
            let [least, most] = [limits.lower(), limits.upper()];
            let on = |at: f64| at.max(least.unwrap_or(at)).min(most.unwrap_or(at));
            let at = if kept.contains(*at) { on(*at) } else { *at };
            let (below, above) = (|x: f64| f64::from(u8::from(at < x)), |x: f64| f64::from(u8::from(at > x)));
            let exact = |guard: f64| {
                let good = kept.contains(at);
                let [false_accept, false_reject, _] = inspected_point(at, good, kept, inspection.gauge(), guard);
                Risks { false_accept, false_reject, error: 0.0 }
            };
            let guard = guard(inspection, limits, &Tails { below: &below, above: &above });
            Some(told(one, inspection, guard, guard.map(|guard| (exact(guard), [Some(0.0); 2]))))
        }
        (None, Some(_))
            if let Some(points) =
                points.filter(|_| one.evidence.surface_law.is_some_and(|law| law.refuted.is_some())) =>
        {
            let (below, above) = (|x: f64| points.beyond(LawTail::Lower, x), |x: f64| points.beyond(LawTail::Upper, x));
            Some(by(one, inspection, (limits, kept), &Tails { below: &below, above: &above }, None))
        }
        (None, Some(fit)) => {
            let (below, above) = (|x: f64| fit.below(x), |x: f64| fit.above(x));
            Some(by(one, inspection, (limits, kept), &Tails { below: &below, above: &above }, None))
        }
        (None, None) => None,
    }
}

/// Numerical error of the surface distribution, if it is the only error.
fn surface_error(one: &CharacteristicAnalysis) -> Option<f64> {
    let proven = one.distribution.yield_source == Some(YieldSource::Proof);
    one.evidence.surface_law.filter(|_| proven).map(|law| law.error())
}

fn guard(inspection: Inspection, limits: SpecLimits, tails: &Tails<'_>) -> Option<f64> {
    match inspection.guard() {
        Guard::Width(width) => Some(width),
        Guard::FalseAccept(rate) => guard_for(tails, limits, inspection.gauge(), rate),
    }
}

/// Risks from a distribution, and from the sample of the model if there is one. Without a trusted surface distribution the values are those
/// of the sample.
fn by(
    one: &CharacteristicAnalysis,
    inspection: Inspection,
    (limits, kept): (SpecLimits, KeptLimits),
    tails: &Tails<'_>,
    proven: Option<f64>,
) -> InspectionRisks {
    let (gauge, guard) = (inspection.gauge(), guard(inspection, limits, tails));
    let sample = one.evidence.verification.as_ref().and_then(|of| of.sample.as_deref());
    let of = |guard: f64| {
        let mut risks = Risks::of(tails, limits, gauge, guard);
        // Proven yields bound the risk: no more bad parts are accepted than there are rejects.
        if let Some(rejected) = one.distribution.capability.and_then(|of| of.rejected()).filter(|_| proven.is_some()) {
            risks.false_accept = risks.false_accept.min(rejected);
        }
        let Some(sample) = sample else {
            let error = proven.or(one.error_estimate.as_ref().and_then(|of| of.yield_));
            return (risks, [error.map(|error| error + risks.error); 2]);
        };
        let found = sample.shares(|x| inspected_point(x, kept.contains(x), kept, gauge, guard));
        // Points of the model take precedence over a count of the surface.
        if one.evidence.surface_law.is_none_or(|law| law.refuted.is_some()) {
            (risks.false_accept, risks.false_reject) = (found[0].value, found[1].value);
        }
        let errors = [found[0].error_of(risks.false_accept), found[1].error_of(risks.false_reject)];
        (risks, errors.map(Some))
    };
    told(one, inspection, guard, guard.map(of))
}

fn told(
    one: &CharacteristicAnalysis,
    inspection: Inspection,
    guard: Option<f64>,
    found: Option<(Risks, [Option<f64>; 2])>,
) -> InspectionRisks {
    let share = |value: f64, error: Option<f64>| Some(EstimatedShare { value: value.clamp(0.0, 1.0), error });
    let yield_ = one.distribution.capability.and_then(|of| of.yield_());
    let yield_error = match one.constant {
        true => Some(0.0),
        false => one.error_estimate.as_ref().and_then(|of| of.yield_),
    };
    let accepted = found.zip(yield_).map(|((risks, errors), yield_)| {
        let error = yield_error.zip(errors[0]).zip(errors[1]);
        let error = error.map(|((yield_, accept), reject)| libm::hypot(libm::hypot(yield_, accept), reject));
        EstimatedShare { value: (yield_ - risks.false_reject + risks.false_accept).clamp(0.0, 1.0), error }
    });
    let false_accept = found.and_then(|(risks, errors)| share(risks.false_accept, errors[0]));
    let false_reject = found.and_then(|(risks, errors)| share(risks.false_reject, errors[1]));
    let limits = one.characteristic.limits();
    inspection_risks((inspection, limits), guard, [false_accept, false_reject, accepted])
}
