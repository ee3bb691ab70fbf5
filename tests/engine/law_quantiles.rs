//! Quantiles, densities and counts of the surface distribution, as in an analysis.

use std::sync::Arc;

use sensitol::analysis::{Branch, Relocation, YieldSource};
use sensitol::distribution::{Distribution, Measured, Normal, Triangular, Uniform};

use sensitol::analysis::distribution::relocated_law::law_at;
use sensitol::{
    Analysis, Characteristic, CharacteristicAnalysis, Closure, Dimension, Method, Options, Problem, SpecLimits, analyze,
};
use sensitol_numeric::distribution::rule::Rule;
use sensitol_numeric::law::REPORTED_QUANTILES as QUANTILES;
use sensitol_numeric::law::{LawOptions, LawTail, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Surrogate, Univariate};
use sensitol_testing::relative;

type Law = Arc<dyn Distribution>;

fn uniform(half: f64) -> Law {
    Arc::new(Uniform::new(-half, half).unwrap())
}

fn triangular(half: f64) -> Law {
    Arc::new(Triangular::new(-half, 0.3 * half, half).unwrap())
}

fn normal(sigma: f64) -> Law {
    Arc::new(Normal::new(0.0, sigma).unwrap())
}

/// Returns a problem of these inputs without limits.
fn problem(laws: &[Law], function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Problem {
    let dimension =
        |(d, law): (usize, &Law)| Dimension::distributed(format!("x{d}"), law.mean(), None, Arc::clone(law)).unwrap();
    Problem::new(laws.iter().enumerate().map(dimension), Closure::scalar("y", function)).unwrap()
}

fn analysed(problem: &Problem) -> Analysis {
    analyze(problem, &Options::from(Method::Full).with_verify(0)).unwrap()
}

fn only(problem: &Problem) -> CharacteristicAnalysis {
    analysed(problem).characteristics.remove(0)
}

/// Sums of uniform inputs: next to its ends the distribution function is a power by volume, `d^n/(n! prod 2 a)`.
#[test]
fn quantiles_without_limits_are_those_of_the_surface() {
    for halves in [vec![1.0], vec![1.0, 0.7], vec![1.0, 0.9, 0.8], vec![1.0, 0.9, 1.1, 0.8]] {
        let laws: Vec<Law> = halves.iter().map(|&half| uniform(half)).collect();
        let found = only(&problem(&laws, |x| x.iter().sum()));
        let law = found.evidence.surface_law.unwrap();
        let quantiles = law.quantiles.unwrap();
        let n = halves.len();
        let volume: f64 = halves.iter().enumerate().map(|(i, half)| 2.0 * half * (i + 1) as f64).product();
        let end: f64 = halves.iter().sum();
        let (_, p) = QUANTILES[0];
        let exact = -end + (p * volume).powf(1.0 / n as f64);
        // The power holds while no input has reached its other end.
        assert!(exact + end < 2.0 * 0.7);
        let sigma = found.moments.unwrap().sigma();
        for (figure, exact) in [(quantiles[0], exact), (quantiles[3], 0.0), (quantiles[6], -exact)] {
            let off = (figure.value - exact).abs();
            // Quantiles are sought to 1e-7 sigma.
            assert!(
                off <= figure.error.max(2e-7 * sigma) && figure.error < 1e-6 * sigma,
                "{halves:?}: {figure:?} for {exact}"
            );
        }
        assert!(found.distribution.capability.unwrap().yield_().is_none() && found.distribution.yield_source.is_none());
    }
}

/// Returns a surface for every branch of the computation: sums, a form, a tree, two inputs, a cycle, a cycle beside a wide normal input.
fn surfaces() -> Vec<(Branch, Problem)> {
    let cycle =
        |x: &[f64]| x[0] + 0.8 * x[1] + 0.1 * x[1] * x[1] + x[2] + 0.3 * (x[0] * x[1] - x[1] * x[2] + x[0] * x[2]);
    let mixed = || vec![uniform(1.0), triangular(1.0), normal(0.4)];
    let all = vec![
        (Branch::Exact, problem(&mixed(), |x| x[0] + x[1] * x[1] + x[2])),
        (Branch::Exact, problem(&[normal(1.0), normal(0.5)], |x| x[0] + x[1] * x[0] - 0.2 * x[0] * x[0])),
        (Branch::Exact, problem(&mixed(), |x| x[0] + x[1] + 0.5 * x[0] * x[1] + x[2])),
        (Branch::Single, problem(&mixed()[..2], |x| x[0] + x[1] + 0.5 * x[0] * x[1])),
        (Branch::Sampled, problem(&[uniform(1.0), triangular(1.0), uniform(0.8)], cycle)),
        (
            Branch::Sampled,
            problem(&[uniform(1.0), triangular(1.0), uniform(0.8), normal(1.0)], move |x| cycle(x) + x[3]),
        ),
    ];
    // Wide limits: without limits the quantiles of a tree come from points.
    let limits = SpecLimits::new(Some(-50.0), Some(50.0)).unwrap();
    let limited = |(branch, problem): (Branch, Problem)| {
        (branch, problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap())
    };
    all.into_iter().map(limited).collect()
}

/// Quantiles that are sought together agree with the distribution's own search, which takes other contours, more panels, and a tilt for
/// each.
#[test]
fn quantiles_sought_together_are_those_sought_alone() {
    for (branch, problem) in surfaces() {
        let analysis = analysed(&problem);
        let still = vec![Relocation::NONE; problem.dimensions().len()];
        let law = law_at(&problem, &analysis.surface, 0, &still).unwrap().unwrap();
        assert_eq!(law.branch(), branch);
        let found = analysis.characteristics[0].evidence.surface_law.unwrap().quantiles.unwrap();
        for (together, (tail, p)) in found.iter().zip(QUANTILES) {
            let alone = law.quantile(tail, p);
            let off = (together.value - alone.value).abs();
            assert!(off <= together.error + alone.error, "{branch:?} {tail:?} {p}: {together:?} {alone:?}");
            let most = if branch == Branch::Sampled { 2e-2 } else { 1e-5 };
            assert!(together.error < most * law.sigma(), "{branch:?} {tail:?} {p}: {together:?}");
        }
        assert!(found.windows(2).all(|pair| pair[0].value < pair[1].value), "{found:?}");
    }
}

/// Quantiles of a tree (products of inputs that are not normal) without limits come from points. They agree with those of the contour
/// within their errors.
#[test]
fn quantiles_of_a_tree_without_limits_are_those_of_its_law() {
    let laws = [uniform(1.0), triangular(1.0), normal(0.4), uniform(0.7), triangular(0.5)];
    let tree = problem(&laws, |x| {
        x[0] + x[1] + x[2] + 0.5 * x[0] * x[1] - 0.4 * x[1] * x[2] + 0.3 * x[1] * x[3] + 0.2 * x[3] * x[4] + x[4]
    });
    let analysis = analysed(&tree);
    let found = analysis.characteristics[0].evidence.surface_law.unwrap();
    assert_eq!((found.branch, found.counted), (Branch::Sampled, None));
    let still = vec![Relocation::NONE; laws.len()];
    let law = law_at(&tree, &analysis.surface, 0, &still).unwrap().unwrap();
    assert_eq!(law.branch(), Branch::Exact);
    for (figure, (tail, p)) in found.quantiles.unwrap().iter().zip(QUANTILES) {
        let exact = law.quantile(tail, p);
        assert!((figure.value - exact.value).abs() <= figure.error + exact.error, "{tail:?} {p}: {figure:?} {exact:?}");
        // Points: 2^12, with one direction integrated.
        assert!(figure.error < 2e-2 * law.sigma(), "{tail:?} {p}: {figure:?}");
    }
}

/// Indices by percentiles use the surface's quantiles, and limits do not change them.
#[test]
fn percentiles_follow_the_surface() {
    let laws = [triangular(0.9), triangular(0.2)];
    let free = problem(&laws, |x| x[0] + x[1]);
    let limits = SpecLimits::new(Some(-1.0), Some(1.2)).unwrap();
    let limited = problem(&laws, |x| x[0] + x[1]).asking([Characteristic::new("y").with_limits(limits)]).unwrap();
    let (free, limited) = (only(&free), only(&limited));
    let all = free.evidence.surface_law.unwrap().quantiles.unwrap();
    assert_eq!(Some(all), limited.evidence.surface_law.unwrap().quantiles);
    let [low, middle, high] = [0, 3, 6].map(|at| all[at].value);
    let capability = limited.distribution.capability.unwrap();
    relative(capability.cp_percentile.unwrap(), 2.2 / (high - low), 1e-14);
    let cpk = ((1.2 - middle) / (high - middle)).min((middle + 1.0) / (middle - low));
    relative(capability.cpk_percentile.unwrap(), cpk, 1e-14);
    assert_eq!(limited.distribution.yield_source, Some(YieldSource::SurfaceLaw));
}

/// The density of a cycle by points agrees with differences of a distribution function by tensor panels, with the normal input last.
#[test]
fn a_sampled_density_is_within_its_error() {
    // y = z0 + 0.8 z1 + 0.5 z2 + b (z0 z1 + z1 z2 + z0 z2) is a line in the normal z2 for given uniform z0 and z1.
    for b in [0.05, 0.1] {
        let pairs = [(0, 1, b), (1, 2, b), (0, 2, b)];
        let parts = [1.0, 0.8, 0.5].map(|slope| Some(Univariate::of_coefficients(&[slope]))).to_vec();
        let surrogate = Surrogate { centre: 0.0, parts, interactions: Interactions::of_pairs(3, pairs) };
        let laws = [uniform(1.0), uniform(1.0), normal(1.0)];
        let law = SurfaceLaw::of(&surrogate, &laws, None, &LawOptions::default()).unwrap();
        assert_eq!(law.branch(), Branch::Sampled);
        let gauss = Rule::of(&Uniform::new(-1.0, 1.0).unwrap(), 64);
        let cdf = |y: f64| -> f64 {
            let at = |u: f64, v: f64| {
                let (line, slope) = (u + 0.8 * v + b * u * v, 0.5 + b * (u + v));
                // The normal input lies below this value, or above it if the slope is negative.
                let z = (y - line) / slope * slope.signum();
                0.5 * libm::erfc(-z / 2f64.sqrt())
            };
            let both = |(u, wu): (&f64, &f64)| {
                gauss.nodes.iter().zip(&gauss.weights).map(|(v, wv)| wu * wv * at(*u, *v)).sum::<f64>()
            };
            gauss.nodes.iter().zip(&gauss.weights).map(both).sum()
        };
        for k in [-2.5, -1.0, 0.0, 0.7, 2.0, 3.0] {
            let y = law.mean() + k * law.sigma();
            let step = 1e-3 * law.sigma();
            let exact =
                (8.0 * (cdf(y + step) - cdf(y - step)) - (cdf(y + 2.0 * step) - cdf(y - 2.0 * step))) / (12.0 * step);
            let found = law.density(y);
            // The stated error is exceeded in one of a hundred cases. Differences are accurate to 1e-9.
            assert!((found.value - exact).abs() <= 1.2 * found.error + 1e-8, "{b} {k}: {found:?} for {exact}");
            assert!(found.error < 0.03 * exact + 1e-3 / law.sigma(), "{b} {k}: {found:?} for {exact}");
        }
    }
}

/// Tables of the density for drawings exist for sampled distributions too, with errors. Each covers the whole probability except for that
/// beyond its ends.
#[test]
fn densities_of_every_branch_are_drawn() {
    for (branch, problem) in surfaces() {
        let options = Options::from(Method::Full).with_verify(0).with_densities(true);
        let found = analyze(&problem, &options).unwrap().characteristics.remove(0);
        let table = found.evidence.density.unwrap_or_else(|| panic!("{branch:?} has a density"));
        let area: f64 = table.windows(2).map(|two| 0.5 * (two[1][0] - two[0][0]) * (two[0][1] + two[1][1])).sum();
        let error: f64 = table.windows(2).map(|two| 0.5 * (two[1][0] - two[0][0]) * (two[0][2] + two[1][2])).sum();
        // The errors come from trapezia over corners, and over the logarithmic peak of a form of two normal inputs; 1e-4 lies beyond the
        // ends.
        assert!((area - 1.0).abs() < 4e-3 + error && error < 0.02, "{branch:?}: {area} ± {error}");
        assert!(table.iter().all(|[_, density, error]| *density >= 0.0 && *error >= 0.0));
    }
}

fn values(seed: u64, count: usize) -> Vec<f64> {
    // Pseudo-random values by a linear congruential generator.
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| next() + next() * next()).collect()
}

/// Three lists of 110 values have 1.3 million sums, which are counted at points. The counts agree with all sums within the stated error, at
/// every limit and quantile of five such surfaces.
#[test]
fn counted_shares_are_within_their_errors() {
    for seed in 1..6 {
        let lists = [1, 2, 3].map(|list| values(17 * seed + list, 110));
        let laws: Vec<Law> = lists.iter().map(|list| Arc::new(Measured::new(list).unwrap()) as Law).collect();
        let mut sums: Vec<f64> = Vec::with_capacity(1_331_000);
        for a in &lists[0] {
            lists[1].iter().for_each(|b| sums.extend(lists[2].iter().map(|c| a + b + c)));
        }
        sums.sort_unstable_by(f64::total_cmp);
        let share_below = |y: f64| sums.partition_point(|&sum| sum < y) as f64 / 1_331_000.0;
        for p in [1e-5, 3e-4, 0.02, 0.4] {
            let [lower, upper] = [sums[(1.331e6 * p) as usize], sums[1_330_999 - (1.331e6 * p) as usize]];
            let limits = SpecLimits::new(Some(lower + 1e-9), Some(upper - 1e-9)).unwrap();
            let problem = problem(&laws, |x| x.iter().sum());
            let found = only(&problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap());
            let law = found.evidence.surface_law.unwrap();
            assert!(law.counted.is_some_and(|points| points >= 8192) && law.branch == Branch::Sampled);
            let (below, above) = (law.below.unwrap(), law.above.unwrap());
            let (exact_below, exact_above) = (share_below(lower + 1e-9), 1.0 - share_below(upper - 1e-9));
            assert!((below.value - exact_below).abs() <= below.error, "{p}: {below:?} for {exact_below}");
            assert!((above.value - exact_above).abs() <= above.error, "{p}: {above:?} for {exact_above}");
            // The error is not larger than necessary: three standard errors of as many points, and five points.
            assert!(below.error < 3.2 * (p / 65_536.0f64).sqrt() + 8.0 / 65_536.0, "{p}: {below:?}");
            for (figure, (tail, p)) in law.quantiles.unwrap().iter().zip(QUANTILES) {
                let rank = (1.331e6 * p) as usize;
                let exact = sums[if tail == LawTail::Lower { rank } else { 1_330_999 - rank }];
                assert!((figure.value - exact).abs() <= figure.error, "{tail:?} {p}: {figure:?} for {exact}");
            }
        }
    }
}

/// Many values beside an input with a density that is wide enough have an exact distribution, a mean of normal distributions.
#[test]
fn many_values_beside_a_density_are_exact() {
    let list = values(3, 400);
    let measured: Law = Arc::new(Measured::new(&list).unwrap());
    let sigma = 0.1 * measured.sigma();
    let limit = measured.mean() + 2.0 * measured.sigma();
    let limits = SpecLimits::new(None, Some(limit)).unwrap();
    let problem = problem(&[measured, normal(sigma)], |x| x[0] + x[1]);
    let law =
        only(&problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap()).evidence.surface_law.unwrap();
    assert_eq!(law.counted, None);
    let exact: f64 = list.iter().map(|x| 0.5 * libm::erfc((limit - x) / (sigma * 2f64.sqrt()))).sum::<f64>() / 400.0;
    let found = law.above.unwrap();
    assert!((found.value - exact).abs() <= found.error + 1e-12 * exact && found.error < 1e-8, "{found:?} for {exact}");
}

/// Two lists of 300 values have 90 000 sums: the distribution is a step function.
#[test]
fn two_lists_are_a_step_function() {
    let lists = [values(5, 300), values(6, 300)];
    let laws: Vec<Law> = lists.iter().map(|list| Arc::new(Measured::new(list).unwrap()) as Law).collect();
    let mut sums: Vec<f64> = lists[0].iter().flat_map(|a| lists[1].iter().map(move |b| a + b)).collect();
    sums.sort_unstable_by(f64::total_cmp);
    let limit = sums[89_000] + 1e-9;
    let limits = SpecLimits::new(None, Some(limit)).unwrap();
    let problem = problem(&laws, |x| x[0] + x[1]);
    let law =
        only(&problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap()).evidence.surface_law.unwrap();
    assert!(law.steps && law.counted.is_none());
    relative(law.above.unwrap().value, 999.0 / 90_000.0, 1e-9);
}
