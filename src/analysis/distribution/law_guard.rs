//! Tests of the distribution of a surface before any of its figures is reported.
//!
//! | test | a distribution passes if |
//! |---|---|
//! | monotone | its quantiles rise, and the share beyond a limit lies between those of the quantiles on either side |
//! | count | every share agrees with the count of points beyond its limit: points of the surface, and of the sample of the model if there is one |
//!
//! Agreement is within six standard errors of the count and the errors of the distribution. A distribution that fails is not reported:
//! points of the surface replace it.

use serde::Serialize;

use crate::analysis::result::verification::{Verification, VerificationKind};
use crate::estimate::OrderedPoints;
use sensitol_numeric::characteristic::{KeptLimits, SpecLimits};
use sensitol_numeric::law::{LawFigure, LawTail};
use sensitol_numeric::power::rescale;

/// Greatest deviation of a count, in standard errors: a right distribution fails in one of 500 million tests.
const ERRORS: f64 = 6.0;
/// Points that are added to the tolerance of a count, because the standard error of a small count is itself uncertain.
const FEW: f64 = 8.0;

/// Failed test of a surface distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LawTest {
    /// Quantiles and shares rise with the limit.
    Monotone,
    /// Shares agree with the count of points.
    Count,
}

impl LawTest {
    /// Returns the name of the test in warnings.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Monotone => "monotone",
            Self::Count => "count",
        }
    }
}

/// Contradiction that refutes the distribution of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LawRefutation {
    /// Failed test.
    pub test: LawTest,
    /// Limit at which it failed.
    pub limit: f64,
    /// Share of assemblies below the limit by the distribution.
    pub law: f64,
    /// Share of points below the limit.
    pub counted: f64,
    /// Standard error of that share.
    pub error: f64,
}

rescale!(LawRefutation { limit } without { test, law, counted, error });

/// Quantiles of a distribution that give no intervals.
pub(in crate::analysis) enum FaultyQuantiles {
    /// At least one quantile is unknown.
    Unknown,
    /// A probability and its quantile, which is lower than that of a smaller probability.
    Fall(f64, f64),
}

/// Points of a surface, for the tests of its distribution.
pub(in crate::analysis) struct LawGuard<'a> {
    points: &'a OrderedPoints,
    /// Greatest change of a value by rounding, on a limit or at a quantile.
    rounding: f64,
}

impl<'a> LawGuard<'a> {
    /// Creates the guard. Rounding moves values by `rounding`, or in proportion to the largest point if that is more.
    pub(in crate::analysis) fn new(points: &'a OrderedPoints, rounding: f64) -> Self {
        Self { points, rounding: rounding.max(KeptLimits::rounding_of(points.largest())) }
    }

    /// Tests the quantiles, in ascending order of their probabilities.
    pub(in crate::analysis) fn quantiles(&self, quantiles: &[((LawTail, f64), LawFigure)]) -> Option<LawRefutation> {
        let falls = quantiles.windows(2).find(|pair| {
            let [(_, low), (_, high)] = [pair[0], pair[1]];
            low.value > high.value + low.error + high.error
        });
        if let Some([_, (of, figure)]) = falls {
            return Some(self.refutation(LawTest::Monotone, figure.value, below_of(*of)));
        }
        quantiles.iter().find_map(|&((tail, p), figure)| {
            let reach = figure.error + self.rounding;
            let [outer, inner] = [figure.value - reach, figure.value + reach];
            // With a step at the quantile the probability lies between the shares beyond it and at it.
            let [least, most] = match tail {
                LawTail::Lower => [self.points.beyond(tail, outer), self.points.beyond(tail, inner)],
                LawTail::Upper => [self.points.beyond(tail, inner), self.points.beyond(tail, outer)],
            };
            let room = ERRORS * self.error(p) + FEW / self.points.len() as f64;
            let agrees = figure.error.is_nan() || least - room <= p && p <= most + room;
            (!agrees).then(|| self.refutation(LawTest::Count, figure.value, below_of((tail, p))))
        })
    }

    /// Tests the share beyond a limit against the count and against the quantiles.
    pub(in crate::analysis) fn tail(
        &self,
        (limit, tail): (f64, LawTail),
        share: LawFigure,
        quantiles: &[((LawTail, f64), LawFigure)],
    ) -> Option<LawRefutation> {
        // A value that differs from the limit by rounding only keeps it.
        let counted = self.points.beyond(tail, limit + tail.sign() * self.rounding);
        let room = ERRORS * self.error(counted.max(share.value)) + FEW / self.points.len() as f64 + share.error;
        let law = if tail == LawTail::Lower { share.value } else { 1.0 - share.value };
        // The share below the limit lies between those of the quantiles on either side.
        let crosses = |&((of, p), figure): &((LawTail, f64), LawFigure)| {
            let p = below_of((of, p));
            let rounding = share.error + NEAR * p.min(1.0 - p);
            let reach = figure.error + self.rounding;
            figure.value + reach < limit && law < p - rounding || figure.value - reach > limit && law > p + rounding
        };
        let test = match (quantiles.iter().any(crosses), (share.value - counted).abs() <= room) {
            (_, false) => LawTest::Count,
            (true, true) => LawTest::Monotone,
            (false, true) => return None,
        };
        Some(self.refutation(test, limit, law))
    }

    /// Standard error of the count of a share.
    fn error(&self, share: f64) -> f64 {
        (share * (1.0 - share) / self.points.len() as f64).max(0.0).sqrt()
    }

    /// Refutation for a share `law` below a limit.
    pub(in crate::analysis) fn refutation(&self, test: LawTest, limit: f64, law: f64) -> LawRefutation {
        let counted = self.points.beyond(LawTail::Lower, limit);
        LawRefutation { test, limit, law, counted, error: self.error(counted) }
    }
}

/// Relative accuracy of the probabilities of quantiles.
const NEAR: f64 = 1e-4;

/// Probability below the quantile of this tail.
fn below_of((tail, p): (LawTail, f64)) -> f64 {
    if tail == LawTail::Lower { p } else { 1.0 - p }
}

/// Tests the shares beyond the limits by the sample of the model: the share of its points that are beyond them on the surface.
pub(in crate::analysis) fn by_sample(
    verification: &Verification,
    limits: SpecLimits,
    shares: [Option<LawFigure>; 2],
) -> Option<LawRefutation> {
    if verification.kind != VerificationKind::Sample {
        return None;
    }
    let [_, differences @ ..] = verification.difference?;
    let places = [(LawTail::Lower, limits.lower()), (LawTail::Upper, limits.upper())];
    (0..2).find_map(|side| {
        let ((tail, limit), own, difference) = (places[side], verification.figures.beyond[side]?, differences[side]);
        let (limit, share) = (limit?, shares[side]?);
        let (counted, error) = (own.value - difference.value, own.error + difference.error);
        let below = |share: f64| if tail == LawTail::Lower { share } else { 1.0 - share };
        let refutation =
            LawRefutation { test: LawTest::Count, limit, law: below(share.value), counted: below(counted), error };
        ((share.value - counted).abs() > ERRORS * error + share.error).then_some(refutation)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(value: f64) -> LawFigure {
        LawFigure::counted(value, 1e-9)
    }

    /// Returns ten thousand evenly spaced points between 0 and 1.
    fn even() -> OrderedPoints {
        OrderedPoints::new((0..10_000).map(|i| (f64::from(i) + 0.5) / 1e4).collect())
    }

    const AT: [(LawTail, f64); 3] = [(LawTail::Lower, 0.05), (LawTail::Lower, 0.5), (LawTail::Upper, 0.05)];

    fn with(values: [f64; 3]) -> Vec<((LawTail, f64), LawFigure)> {
        AT.into_iter().zip(values.map(figure)).collect()
    }

    #[test]
    fn a_right_law_passes() {
        let points = even();
        let guard = LawGuard::new(&points, 0.0);
        let quantiles = with([0.05, 0.5, 0.95]);
        assert_eq!(guard.quantiles(&quantiles), None);
        assert_eq!(guard.tail((0.2, LawTail::Lower), figure(0.2), &quantiles), None);
        assert_eq!(guard.tail((0.97, LawTail::Upper), figure(0.03), &quantiles), None);
    }

    #[test]
    fn quantiles_that_fall_are_refuted() {
        let points = even();
        let found = LawGuard::new(&points, 0.0).quantiles(&with([0.05, 0.5, 0.49])).unwrap();
        assert_eq!((found.test, found.limit, found.law), (LawTest::Monotone, 0.49, 0.95));
        assert!((found.counted - 0.49).abs() < 1e-12);
    }

    /// Six standard errors of 10 000 points are 0.03 in the middle.
    #[test]
    fn shares_that_points_contradict_are_refuted() {
        let points = even();
        let guard = LawGuard::new(&points, 0.0);
        assert_eq!(guard.quantiles(&with([0.05, 0.54, 0.95])).unwrap().test, LawTest::Count);
        let found = guard.tail((0.3, LawTail::Upper), figure(0.66), &with([0.05, 0.5, 0.95])).unwrap();
        assert_eq!((found.test, found.limit), (LawTest::Count, 0.3));
        assert!((found.law - 0.34).abs() < 1e-12 && (found.counted - 0.3).abs() < 1e-12);
        assert!((found.error - (0.21f64 / 1e4).sqrt()).abs() < 1e-12);
    }

    /// The share agrees with the count within its error, but contradicts a quantile.
    #[test]
    fn a_tail_that_crosses_a_quantile_is_refuted() {
        let points = even();
        let found = LawGuard::new(&points, 0.0).tail((0.06, LawTail::Lower), figure(0.049), &with([0.05, 0.5, 0.95]));
        assert_eq!(found.unwrap().test, LawTest::Monotone);
    }
}
