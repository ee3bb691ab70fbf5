//! Least and greatest yields against closed forms: Chebyshev, Cantelli, Markov, Camp and Meidell, Hoeffding.

use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::distribution_bounds::{
    DistributionPromise, LinearYield, PromiseFault, YieldBounds, yield_bounds,
};

/// Certified and attained ends differ by 1e-6 unless the mean has a range.
const CLOSE: f64 = 3e-6;

/// Tails of a rest that is 0.
fn step(x: f64) -> [f64; 2] {
    [x > 0.0, x < 0.0].map(|of| f64::from(u8::from(of)))
}

fn within(promise: &DistributionPromise, limits: [Option<f64>; 2]) -> YieldBounds {
    yield_bounds(promise, &LinearYield { slope: 1.0, offset: 0.0, limits, tails: &step })
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < CLOSE, "{found}, not {expected}");
}

fn wide() -> DistributionPromise {
    DistributionPromise::new([-50.0, 50.0]).unwrap().with_mean([0.0, 0.0]).unwrap()
}

/// Bienaymé and Chebyshev (1867): at least `1 - 1/k^2` within `k` sigma; one side by Cantelli (1928), `k^2/(1 + k^2)`.
#[test]
fn chebyshev_and_cantelli_are_met() {
    for k in [1.25, 2.0, 3.5, 6.0] {
        let promise = wide().with_sigma(1.0).unwrap();
        let both = within(&promise, [Some(-k), Some(k)]);
        near(both.certified[0], 1.0 - 1.0 / (k * k));
        near(both.attained[0], 1.0 - 1.0 / (k * k));
        near(both.certified[1], 1.0);
        near(within(&promise, [None, Some(k)]).certified[0], k * k / (1.0 + k * k));
    }
}

/// Symmetric and unimodal (Gauss 1823; Camp 1922, Meidell 1922): `1 - 4/(9 k^2)` from `k = 2/sqrt(3)` on, below that `k/sqrt(3)`.
#[test]
fn camp_and_meidell_are_met() {
    for k in [0.5, 1.0, 1.5, 2.0, 3.0] {
        let promise = wide().with_sigma(1.0).unwrap().symmetric_and_unimodal().unwrap();
        let expected = if k >= 2.0 / 3f64.sqrt() { 1.0 - 4.0 / (9.0 * k * k) } else { k / 3f64.sqrt() };
        let found = within(&promise, [Some(-k), Some(k)]);
        // A mixture of uniform distributions is bounded by slices, which leaves 2e-3.
        assert!(found.certified[0] <= expected + 1e-9 && found.certified[0] > expected - 8e-3, "{k}: {found:?}");
        assert!((found.attained[0] - expected).abs() < 8e-3, "{k}: {} {expected}", found.attained[0]);
    }
}

/// Markov's inequality in a band: with a mean `m` in `[0, 1]` at most `m/t` lies at or above `t`. The least and greatest share follow from
/// distributions at two points.
#[test]
fn two_points_are_extreme_for_a_mean() {
    for mean in [0.1, 0.3, 0.45] {
        let promise = DistributionPromise::new([0.0, 1.0]).unwrap().with_mean([mean, mean]).unwrap();
        near(within(&promise, [None, Some(0.5)]).certified[0], 1.0 - mean / 0.5);
        near(within(&promise, [Some(0.5), None]).certified[1], mean / 0.5);
        // A range of means: the worst is at its upper end.
        let ranged = DistributionPromise::new([0.0, 1.0]).unwrap().with_mean([0.05, mean]).unwrap();
        near(within(&ranged, [None, Some(0.5)]).certified[0], 1.0 - mean / 0.5);
    }
    // Nothing but the band: all or nothing.
    let alone = DistributionPromise::new([0.0, 1.0]).unwrap();
    let found = within(&alone, [Some(0.2), None]);
    near(found.certified[0], 0.0);
    near(found.certified[1], 1.0);
}

/// Symmetric with a known sigma: a pair of points beyond the limits takes `1/k^2`, as without symmetry.
#[test]
fn symmetric_pairs_are_extreme() {
    let promise = wide().with_sigma(1.0).unwrap().symmetric().unwrap();
    near(within(&promise, [Some(-2.0), Some(2.0)]).certified[0], 0.75);
    // Beyond one limit alone it is half of that.
    near(within(&promise, [None, Some(2.0)]).certified[0], 0.875);
}

/// An input in its band beside a normal rest: without a mean the worst place is an end, and the best one the middle.
#[test]
fn an_ordinary_rest_stays_as_it_is() {
    let sigma = 0.1;
    let below = |x: f64| standard_normal::cdf(x / sigma);
    let limits = [Some(-0.5), Some(0.5)];
    let yield_at = |x: f64| below(0.5 - x) - below(-0.5 - x);
    let sum = LinearYield { slope: 2.0, offset: 0.0, limits, tails: &|x: f64| [below(x), below(-x)] };
    let promise = DistributionPromise::new([-0.2, 0.2]).unwrap();
    let found = yield_bounds(&promise, &sum);
    near(found.certified[0], yield_at(0.4));
    near(found.certified[1], yield_at(0.0));
    // With its mean at 0, mass at both ends keeps the mean and is as bad.
    let centred = promise.clone().with_mean([0.0, 0.0]).unwrap();
    near(yield_bounds(&centred, &sum).certified[0], yield_at(0.4));
    // Hoeffding (1963), theorem 2, for the mean of one value in a band: the bound holds for all that the program covers.
    let one_sided = LinearYield { slope: 1.0, offset: 0.0, limits: [None, Some(0.1)], tails: &step };
    let hoeffding = 1.0 - (-2.0 * 0.1f64.powi(2) / 0.4f64.powi(2)).exp();
    assert!(yield_bounds(&centred, &one_sided).certified[0] >= hoeffding - 1e-9);
}

/// The certified end is below the yield of any distribution that keeps the promise: uniform and triangular ones, by integration.
#[test]
fn certified_ends_hold_for_distributions_of_the_promise() {
    let below = |x: f64| standard_normal::cdf(x / 0.05);
    let sum = LinearYield {
        slope: 1.0,
        offset: 0.02,
        limits: [Some(-0.15), Some(0.12)],
        tails: &|x: f64| [below(x), below(-x)],
    };
    let promise =
        DistributionPromise::new([-0.2, 0.2]).unwrap().with_mean([-0.03, 0.05]).unwrap().with_sigma(0.08).unwrap();
    let found = yield_bounds(&promise, &sum);
    for (mean, half) in [(0.0, 0.1), (0.05, 0.13), (-0.03, 0.138), (0.02, 0.02)] {
        const PLACES: u32 = 20_000;
        let at = |place: u32| mean + half * (2.0 * (f64::from(place) + 0.5) / f64::from(PLACES) - 1.0);
        let share = |x: f64| below(0.12 - 0.02 - x) - below(-0.15 - 0.02 - x);
        let uniform = (0..PLACES).map(|place| share(at(place))).sum::<f64>() / f64::from(PLACES);
        assert!(found.certified[0] < uniform && uniform < found.certified[1], "{uniform} {found:?}");
    }
    assert!(found.certified[0] <= found.attained[0] + 1e-12 && found.attained[1] <= found.certified[1] + 1e-12);
    // 32 ranges of the mean leave some thousandths.
    assert!(found.attained[0] - found.certified[0] < 0.01, "{found:?}");
}

#[test]
fn promises_that_contradict_themselves_are_refused() {
    let band = || DistributionPromise::new([0.0, 1.0]).unwrap();
    assert!(matches!(DistributionPromise::new([1.0, 1.0]), Err(PromiseFault::Band { .. })));
    assert!(matches!(band().with_mean([0.2, 1.2]), Err(PromiseFault::Mean { .. })));
    assert!(matches!(band().with_sigma(0.0), Err(PromiseFault::Sigma { .. })));
    assert!(matches!(band().symmetric().unwrap().with_mean([0.6, 0.7]), Err(PromiseFault::Symmetric { .. })));
}

/// A limit that the end of the band reaches is kept there, on either side.
#[test]
fn the_end_of_a_band_on_a_limit_is_kept() {
    let promise = DistributionPromise::new([-1.0, 1.0]).unwrap();
    for limits in [[None, Some(1.0)], [Some(-1.0), None], [Some(-1.0), Some(1.0)]] {
        assert_eq!(within(&promise, limits).certified, [1.0, 1.0], "{limits:?}");
    }
}
