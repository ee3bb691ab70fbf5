//! Intervals of rare events with rejects that the surrogate gives no sign of. Right values are closed forms and a
//! quadrature.

use rayon::prelude::*;
use sensitol::rare::{Beyond, RareOptions, rare};
use sensitol::{Characteristic, Closure, Problem, SpecLimits};
use sensitol_testing::standard;

/// Probability that a standard normal variable is greater than this.
pub(super) fn tail(z: f64) -> f64 {
    0.5 * libm::erfc(z / 2f64.sqrt())
}

/// Integral over a standard normal variable, by the trapezoidal rule, which converges faster than any power.
pub(super) fn mean(of: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1e-3;
    let density = |u: f64| (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt();
    (-10_000..=10_000).map(|i| STEP * f64::from(i)).map(|u| STEP * density(u) * of(u)).sum()
}

/// Results above the limit for so many seeds, with the evaluations.
pub(super) fn found(problem: &Problem, samples: u64, seeds: u64) -> Vec<(u64, Beyond)> {
    let one = |seed: u64| {
        let found = rare(problem, &RareOptions::default().with_samples(samples).with_seed(seed)).unwrap();
        (found.run.evaluations, found.characteristics[0].above.clone().unwrap())
    };
    (0..seeds).into_par_iter().map(one).collect()
}

/// Function of `n` standard normal variables, its upper limit, and the probability beyond.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) n: usize,
    pub(super) function: fn(&[f64]) -> f64,
    pub(super) limit: f64,
    pub(super) truth: f64,
}

impl Case {
    fn problem(&self) -> Problem {
        let limits = SpecLimits::new(None, Some(self.limit)).unwrap();
        let problem = Problem::new(standard(self.n), Closure::scalar("y", self.function)).unwrap();
        problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap()
    }

    /// Results above the limit for so many seeds, with the evaluations.
    pub(super) fn found(&self, samples: u64, seeds: u64) -> Vec<(u64, Beyond)> {
        found(&self.problem(), samples, seeds)
    }

    fn holds(&self, beyond: &Beyond) -> bool {
        beyond.interval[0] <= self.truth && self.truth <= beyond.interval[1]
    }
}

/// Functions that judge. The constants were chosen on others: corners, branches and steps of
/// other dimensions and places.
fn judges() -> Vec<Case> {
    let (two, branch) = (tail(2.6) * tail(1.3), tail(2.1));
    let far = tail(2.6).powi(3);
    vec![
        Case { name: "linear-100", n: 100, function: |x| x.iter().sum::<f64>() / 10.0, limit: 3.37, truth: tail(3.37) },
        Case {
            name: "linear-5",
            n: 5,
            function: |x| x[0] - x[1] + 0.5 * x[2] + x[3] + x[4],
            limit: 4.5 * 4.25f64.sqrt(),
            truth: tail(4.5),
        },
        Case {
            name: "two-large",
            n: 4,
            function: |x| x[0] + 0.5 * x[3] + if x[1] > 2.6 && x[2] < -1.3 { 8.0 } else { 0.0 },
            limit: 5.6,
            truth: two * tail(-2.4 / 1.25f64.sqrt()) + (1.0 - two) * tail(5.6 / 1.25f64.sqrt()),
        },
        Case {
            name: "corner-of-three",
            n: 5,
            function: |x| 0.2 * x[3] - 0.1 * x[4] + 2.0 * ((-x[0]).min(x[1]).min(x[2]) - 1.0).max(0.0),
            limit: 1.6,
            truth: mean(|u| tail(1.0 + (1.6 - 0.05f64.sqrt() * u) / 2.0).powi(3)),
        },
        Case {
            name: "second-branch",
            n: 3,
            function: |x| x[0] - 0.4 * x[1] + if x[2] < -2.1 { 2.5 } else { 0.0 },
            limit: 4.7,
            truth: branch * tail(2.2 / 1.16f64.sqrt()) + (1.0 - branch) * tail(4.7 / 1.16f64.sqrt()),
        },
        Case {
            name: "far-step",
            n: 6,
            function: |x| x[3] + 0.3 * x[4] - 0.3 * x[5] + if x[0].min(x[1]).min(x[2]) > 2.6 { 12.0 } else { 0.0 },
            limit: 6.2,
            truth: far * tail(-5.8 / 1.18f64.sqrt()) + (1.0 - far) * tail(6.2 / 1.18f64.sqrt()),
        },
    ]
}

/// At least 38 of 40 intervals contain the right value.
#[test]
fn intervals_reach_what_the_surrogate_gives_no_sign_of() {
    for case in judges() {
        let seeds = if case.n > 30 { 10 } else { 40 };
        for samples in [400, 900, 4000] {
            let found = case.found(samples, seeds);
            let held = found.iter().filter(|(_, above)| case.holds(above)).count() as u64;
            assert!(held * 40 >= 38 * seeds, "{} {samples}: {held} of {seeds}", case.name);
        }
    }
}

/// The median of the estimates with 4000 points is right to a quarter.
#[test]
fn rejects_in_a_corner_are_found() {
    for case in judges() {
        let found = case.found(4000, 9);
        let value = |above: &Beyond| above.probability.unwrap_or(0.0);
        let mut values: Vec<f64> = found.iter().map(|(_, above)| value(above)).collect();
        values.sort_by(f64::total_cmp);
        assert!((values[4] / case.truth - 1.0).abs() < 0.25, "{}: {values:?} for {}", case.name, case.truth);
    }
}

/// In a hundred variables a linear function is no worse than a plain sample of the same evaluations.
#[test]
fn a_sum_of_a_hundred_is_better_than_plain_points() {
    let case = judges().into_iter().find(|case| case.name == "linear-100").unwrap();
    for samples in [900, 2000, 4000] {
        let found = case.found(samples, 10);
        for (evaluations, above) in &found {
            let plain = (case.truth / *evaluations as f64).sqrt();
            let value = above.probability.unwrap();
            assert!((value - case.truth).abs() < plain, "{samples}: {value}");
            assert!(above.interval[1] < 5.0 / samples as f64, "{samples}: {:?}", above.interval);
        }
    }
}

/// The interval has the bound of what no point met, and the bound states its points.
#[test]
fn the_bound_is_in_the_interval() {
    let case = judges().into_iter().find(|case| case.name == "linear-5").unwrap();
    let [few, many] = [400, 4000].map(|samples| case.found(samples, 1).remove(0).1);
    let (first, second) = (few.unmet.unwrap(), many.unmet.unwrap());
    assert!(few.interval[1] >= few.probability.unwrap() + first.most, "{few:?}");
    assert!(second.most < 1e-3 * first.most && second.points > 5 * first.points, "{first:?} {second:?}");
    assert_eq!((first.directions, second.directions), (3, 3));
    // The points are counted: at most a third of the budget of few.
    assert!((90..=133).contains(&first.points), "{first:?}");
}
