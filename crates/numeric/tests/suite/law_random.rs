//! Distributions of random surfaces, compared with independent counts. The surfaces have all distributions, one to six inputs, products,
//! and powers up to four.
//!
//! The count uses a Latin hypercube of every input's quantiles. Its variance is at most that of independent points (A. B. Owen, SIAM
//! Journal on Numerical Analysis 34 (1997)), so six standard errors of these bound its error.

use std::sync::{Arc, LazyLock};

use sensitol_numeric::distribution::{
    Beta, CurvilinearTrapezoid, Distribution, Drifting, Exponential, Gamma, Lognormal, Measured, Mixture, Normal, Part,
    PearsonLaw, Rayleigh, Student, Tabulated, Trapezoidal, Triangular, TruncatedNormal, TwoValues, UShaped, Uniform,
    Weibull,
};
use sensitol_numeric::law::{Branch, LawError, LawFigure};
use sensitol_numeric::law::{LawOptions, LawTail, Sought, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Surrogate, Univariate};

type Law = Arc<dyn Distribution>;

/// Number of random surfaces.
const CASES: u64 = 300;
/// Points of a sampled distribution: a quarter of the usual number, to save time.
const LAW_POINTS: usize = 1 << 11;
/// Number of points of the count.
const POINTS: usize = 1 << 15;
/// Standard errors that bound a count. 300 cases have about ten thousand counts, and a normal variable exceeds six with the probability
/// 2e-9.
const ERRORS: f64 = 6.0;
/// Accuracy of the distribution functions of inputs.
const ROUNDING: f64 = 1e-10;
/// Largest error for which a distribution is returned, with as few points as here.
const LARGEST_ERROR: f64 = 0.03;
/// Number of points by which the count of a rare event may differ, if no standard error is known.
const FEW: f64 = 8.0;

/// Generator SplitMix64 (Steele, Lea and Flood 2014), with the same numbers on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let word = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^ word >> 31
    }

    /// Uniform number between 0 and 1.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }

    /// Uniform number between -1 and 1, times a random one of these scales.
    fn scaled(&mut self, scales: &[f64]) -> f64 {
        let scale = scales[self.below(scales.len())];
        scale * (2.0 * self.share() - 1.0)
    }
}

/// All distributions that have probabilities, some in two shapes. The normal one is first.
fn distributions() -> Vec<Law> {
    let part = |weight: f64, mean: f64, sigma: f64| Part {
        name: String::new(),
        weight,
        distribution: Arc::new(Normal::new(mean, sigma).unwrap()),
    };
    let measured: Vec<f64> = (0..23u32).map(|i| f64::from(i * i % 23) + 0.1 * f64::from(i)).collect();
    vec![
        Arc::new(Normal::new(3.0, 0.5).unwrap()),
        Arc::new(Uniform::new(-1.0, 1.0).unwrap()),
        Arc::new(Triangular::new(0.0, 0.3, 1.0).unwrap()),
        Arc::new(Trapezoidal::new(0.0, 1.0, 0.4).unwrap()),
        Arc::new(Beta::new(0.0, 1.0, 2.0, 5.0).unwrap()),
        Arc::new(Beta::new(0.0, 1.0, 0.7, 1.3).unwrap()),
        Arc::new(Gamma::new(0.0, 1.5, 1.2).unwrap()),
        Arc::new(Weibull::new(0.0, 1.5, 0.8).unwrap()),
        Arc::new(Lognormal::new(0.0, 1.0, 0.4).unwrap()),
        Arc::new(Exponential::new(0.0, 1.0).unwrap()),
        Arc::new(Rayleigh::new(0.0, 1.0).unwrap()),
        Arc::new(TruncatedNormal::new(-1.0, 1.0, 0.1, 0.4).unwrap()),
        Arc::new(UShaped::new(-1.0, 1.0).unwrap()),
        Arc::new(CurvilinearTrapezoid::new(-1.0, 1.0, 0.2).unwrap()),
        Arc::new(Drifting::new(0.0, 1.0, 1.5).unwrap()),
        Arc::new(PearsonLaw::new(0.0, 1.0, 0.8, 1.2).unwrap()),
        Arc::new(Student::new(0.0, 1.0, 25.0).unwrap()),
        Arc::new(Tabulated::new(&[-3.0, -1.0, 0.0, 1.0, 3.0], &[-2.0, -0.8, 0.1, 1.0, 3.5]).unwrap()),
        Arc::new(Mixture::new(vec![part(1.0, -1.0, 0.5), part(2.0, 1.0, 0.8)]).unwrap()),
        Arc::new(TwoValues::new(-1.0, 1.0).unwrap()),
        Arc::new(Measured::new(&measured).unwrap()),
    ]
}

/// Distributions with their standardised quantiles at the middles of [`POINTS`] equal shares.
static INPUTS: LazyLock<Vec<(Law, Vec<f64>)>> = LazyLock::new(|| {
    let standardised = |law: Law| {
        let probability = law.probability().unwrap();
        let at = |i: usize| (probability.quantile((i as f64 + 0.5) / POINTS as f64) - law.mean()) / law.sigma();
        let column = (0..POINTS).map(at).collect();
        (law, column)
    };
    distributions().into_iter().map(standardised).collect()
});

/// Random orders of the points, one for every input of a surface.
static ORDERS: LazyLock<Vec<Vec<u32>>> = LazyLock::new(|| {
    let mut random = Random(7);
    let mut order = || {
        let mut order: Vec<u32> = (0..POINTS as u32).collect();
        (1..POINTS).rev().for_each(|last| order.swap(last, random.below(last + 1)));
        order
    };
    (0..6).map(|_| order()).collect()
});

/// A random surface over some of the distributions.
struct Case {
    number: u64,
    surrogate: Surrogate,
    /// Indices in [`INPUTS`].
    inputs: Vec<usize>,
}

impl Case {
    fn of(number: u64) -> Self {
        let mut random = Random(1000 + number);
        let n = 1 + (number % 6) as usize;
        // A third of the surfaces are of normal inputs only, and a third have half of them.
        let normal = [1.0, 0.5, 0.0][(number / 6 % 3) as usize];
        let inputs: Vec<usize> =
            (0..n).map(|_| if random.share() < normal { 0 } else { random.below(INPUTS.len()) }).collect();
        let degree = 2 + (number / 18 % 3) as usize;
        let part = |random: &mut Random| {
            let mut part = vec![
                random.scaled(&[0.0, 0.0, 0.1, 1.0, 10.0]),
                random.scaled(&[0.0, 0.1, 1.0]),
                random.scaled(&[0.0, 0.01, 0.3]),
                random.scaled(&[0.0, 1e-4, 0.05]),
            ];
            part.truncate(degree);
            Some(Univariate::of_coefficients(&part))
        };
        let parts = (0..n).map(|_| part(&mut random)).collect();
        let density = [0.3, 1.0][random.below(2)];
        let mut products = Vec::new();
        for j in 0..n {
            for k in j + 1..n {
                if random.share() < density {
                    products.push((j, k, random.scaled(&[0.05, 0.3, 1.0])));
                }
            }
        }
        let surrogate = Surrogate { centre: 5.0, parts, interactions: Interactions::of_pairs(n, products) };
        Self { number, surrogate, inputs }
    }

    fn laws(&self) -> Vec<Law> {
        self.inputs.iter().map(|&input| Arc::clone(&INPUTS[input].0)).collect()
    }

    /// Values of the surface at all points, ascending.
    fn values(&self) -> Vec<f64> {
        let mut values = vec![self.surrogate.centre; POINTS];
        let columns: Vec<Vec<f64>> = (self.inputs.iter().zip(ORDERS.iter()))
            .map(|(&input, order)| order.iter().map(|&place| INPUTS[input].1[place as usize]).collect())
            .collect();
        for (part, column) in self.surrogate.parts.iter().zip(&columns) {
            let [c1, c2, c3, c4] = part.unwrap().coefficients();
            values.iter_mut().zip(column).for_each(|(y, z)| *y += (((c4 * z + c3) * z + c2) * z + c1) * z);
        }
        for (j, k, product) in self.surrogate.interactions.pairs() {
            let both = columns[j].iter().zip(&columns[k]);
            values.iter_mut().zip(both).for_each(|(y, (a, b))| *y += product * a * b);
        }
        values.sort_unstable_by(f64::total_cmp);
        values
    }
}

/// Fractions of the points below and above a limit.
fn counted(values: &[f64], y: f64) -> [f64; 2] {
    let below = values.partition_point(|&value| value < y);
    let above = values.len() - values.partition_point(|&value| value <= y);
    [below, above].map(|count| count as f64 / values.len() as f64)
}

/// Error of a counted fraction.
fn error_of_count(share: f64) -> f64 {
    ERRORS * (share * (1.0 - share) / POINTS as f64).sqrt() + FEW / POINTS as f64
}

/// Fractions of the points below the tested limits.
const SHARES: [f64; 7] = [3e-4, 0.01, 0.1, 0.5, 0.9, 0.99, 0.9997];
/// Tested quantiles, ascending: tail and probability in it.
const QUANTILES: [(LawTail, f64); 3] = [(LawTail::Lower, 0.00135), (LawTail::Upper, 0.3), (LawTail::Upper, 0.00135)];

/// Faults of one distribution; empty if there are none.
fn faults(case: &Case, law: &SurfaceLaw) -> Vec<String> {
    let values = case.values();
    let mut faults = Vec::new();
    let mut check = |holds: bool, what: String| {
        if !holds {
            faults.push(what);
        }
    };
    // One in a hundred sampled figures may exceed its error, by Student's distribution with 15 degrees of freedom. Twice the error is
    // exceeded with 3e-5.
    let factor = if law.branch() == Branch::Sampled { 2.0 } else { 1.0 };
    let tolerance = 1e-9 * law.sigma() + 1e-12 * law.mean().abs();
    let mut before: Option<(f64, f64)> = None;
    for share in SHARES {
        // Between two values, so that a step of equal values is on the same side in both counts.
        let y = values[(share * POINTS as f64) as usize] + tolerance;
        let counts = counted(&values, y);
        let mut agrees = |tail: LawFigure, count: f64| {
            let off = (tail.value - count).abs();
            check(off <= error_of_count(count) + factor * tail.error, format!("{y}: {tail:?}, counted {count}"));
            check((0.0..=1.0).contains(&tail.value), format!("{y}: {tail:?} is no probability"));
            check(tail.error <= LARGEST_ERROR, format!("{y}: the error of {tail:?}"));
            tail
        };
        // The smaller tail is tested, and both near the middle.
        let below = if share <= 0.5 { Some(agrees(law.below(y), counts[0])) } else { None };
        let above = if share >= 0.5 { Some(agrees(law.above(y), counts[1])) } else { None };
        let complement = |above: LawFigure| 1.0 - above.value;
        let error = below.or(above).map_or(0.0, |tail| tail.error);
        let at_most = below.map(|below| below.value).or(above.map(complement)).unwrap_or(f64::NAN);
        if let (Some(below), Some(above)) = (below, above) {
            let off = (below.value - complement(above)).abs();
            check(off <= factor * (below.error + above.error) + ROUNDING, format!("{y}: {below:?} and {above:?}"));
        }
        if let Some((before, own)) = before {
            check(at_most >= before - factor * (own + error), format!("{y}: {at_most} after {before}"));
        }
        before = Some((at_most, error));
    }
    let quantiles = QUANTILES.map(|(tail, p)| law.quantile(tail, p));
    for pair in quantiles.windows(2) {
        check(pair[0].value <= pair[1].value, format!("quantiles fall: {pair:?}"));
    }
    for ((tail, p), quantile) in QUANTILES.into_iter().zip(quantiles) {
        // At a step the probability lies between that strictly beyond the quantile and that including it.
        let reach = tolerance + factor * quantile.error;
        let (outer, inner) = (quantile.value - reach, quantile.value + reach);
        let [least, most] = match tail {
            LawTail::Lower => [counted(&values, outer)[0], counted(&values, inner)[0]],
            LawTail::Upper => [counted(&values, inner)[1], counted(&values, outer)[1]],
        };
        let error = error_of_count(p);
        check(
            least - error <= p && p <= most + error,
            format!("{tail:?} {p}: {quantile:?}, counted {least} .. {most}"),
        );
    }
    faults
}

/// Checks the distribution of a case. Returns its branch, or None if it was refused for a reason.
fn checked(case: &Case) -> Result<Option<Branch>, String> {
    let options = LawOptions { points: LAW_POINTS, ..LawOptions::default() };
    let law = match SurfaceLaw::of(&case.surrogate, &case.laws(), None, &options) {
        Ok(law) => law,
        // An input whose tail falls as a power has no transform. A surface without remaining parts has no variance.
        Err(LawError::LongTail { .. } | LawError::NoVariance) => return Ok(None),
        Err(error) => return Err(format!("{}: {error}", case.number)),
    };
    let faults = faults(case, &law);
    if faults.is_empty() {
        return Ok(Some(law.branch()));
    }
    let names: Vec<&str> = case.inputs.iter().map(|&input| INPUTS[input].0.name()).collect();
    let (number, surrogate, branch) = (case.number, &case.surrogate, law.branch());
    Err(format!("{number} {names:?} {surrogate:?} {branch:?}:\n  {}", faults.join("\n  ")))
}

/// Checks every second case, beginning with `first`.
fn check(first: u64) {
    let found: Vec<_> = (first..CASES).step_by(2).map(|number| checked(&Case::of(number))).collect();
    let failed: Vec<&String> = found.iter().filter_map(|found| found.as_ref().err()).collect();
    assert!(failed.is_empty(), "{} laws fail:\n{failed:#?}", failed.len());
    // All branches occur among the surfaces.
    for branch in [Branch::Exact, Branch::Single, Branch::Sampled] {
        let count = found.iter().filter(|found| **found == Ok(Some(branch))).count();
        assert!(count > 10, "{branch:?}: {count}");
    }
}

#[test]
fn laws_of_even_random_surfaces_agree_with_counts() {
    check(0);
}

#[test]
fn laws_of_odd_random_surfaces_agree_with_counts() {
    check(1);
}

/// Far beyond a corner that a narrow normal input rounds, the tail is known to few digits only. No quantile may be found there.
#[test]
fn quantiles_beside_a_corner_are_those_of_the_law() {
    let part = Some(Univariate::of_coefficients(&[0.0, -0.5, 0.0, 2e-5]));
    for thin in [1e-4, 1e-3, 0.01, 0.1] {
        let parts = vec![part, part, Some(Univariate::of_coefficients(&[thin]))];
        let surrogate = Surrogate { centre: 5.0, parts, interactions: Interactions::of_pairs(3, vec![(0, 1, -1.0)]) };
        let case = Case { number: CASES, surrogate, inputs: vec![0; 3] };
        let law = SurfaceLaw::of(&case.surrogate, &case.laws(), None, &LawOptions::default()).unwrap();
        let values = case.values();
        let mut before = f64::NEG_INFINITY;
        for p in [0.3, 0.1, 0.025, 0.01, 1.35e-3, 1e-4] {
            let found = law.quantile(LawTail::Upper, p);
            let counted = counted(&values, found.value)[1];
            assert!((counted - p).abs() <= error_of_count(p), "{thin}, {p}: {found:?}, counted {counted}");
            assert!(found.error <= 0.5 * thin, "{thin}, {p}: {found:?}");
            assert!(found.value > before, "{thin}, {p}: {found:?} after {before}");
            before = found.value;
        }
    }
}

/// Two pairs of values with a narrow density beside each: four clusters that empty gaps separate. With the uniform input `z` the clusters
/// are `±2.45 ± 0.13 - w z^4`, of probability 1/4 each, so every quantile has a closed form.
#[test]
fn quantiles_beside_a_gap_lie_in_their_cluster() {
    let two = || -> Law { Arc::new(TwoValues::new(-1.0, 1.0).unwrap()) };
    for width in [1e-5, 1e-3] {
        let parts = [vec![2.45], vec![0.13], vec![0.0, 0.0, 0.0, -width]];
        let parts = parts.iter().map(|terms| Some(Univariate::of_coefficients(terms))).collect();
        let surrogate = Surrogate { centre: 0.0, parts, interactions: Interactions::none(3) };
        let inputs = [two(), two(), Arc::new(Uniform::new(-1.0, 1.0).unwrap()) as Law];
        let law = SurfaceLaw::of(&surrogate, &inputs, None, &LawOptions::default()).unwrap();
        let range = law.range();
        let clusters = [-2.58, -2.32, 2.32, 2.58];
        let probabilities = [1.35e-3, 0.01, 0.05, 0.2, 0.3, 0.45, 0.55, 0.7, 0.8, 0.95, 0.99, 0.99865];
        let sought: Vec<Sought> = probabilities
            .iter()
            .map(|&p| {
                let (tail, p) = if p > 0.5 { (LawTail::Upper, 1.0 - p) } else { (LawTail::Lower, p) };
                Sought { tail, p, near: if tail == LawTail::Upper { 2.4 } else { -2.4 }, density: 0.2 }
            })
            .collect();
        let together = law.quantiles(&sought);
        let alone: Vec<LawFigure> = sought.iter().map(|of| law.quantile(of.tail, of.p)).collect();
        for found in [together, alone] {
            let mut before = f64::NEG_INFINITY;
            for (&p, found) in probabilities.iter().zip(&found) {
                let cluster = clusters[(4.0 * p) as usize];
                // Within a cluster the value falls as |z| rises, so that the share below it is that of larger |z|.
                let z = 3f64.sqrt() * (1.0 - (4.0 * p).fract());
                let exact = cluster - width * z.powi(4);
                // The width of a cluster is 9 w. Points resolve it to a fraction.
                let off = (found.value - exact).abs();
                assert!(off <= 9.0 * width, "{width} {p}: {found:?}, exact {exact}, {range:?}");
                assert!(off <= 3.0 * found.error, "{width} {p}: {found:?}, exact {exact}");
                assert!(found.error <= 0.02, "{width} {p}: {found:?}");
                assert!(found.value >= before - 9.0 * width, "{width} {p}: {found:?} after {before}");
                before = found.value;
            }
        }
    }
}

/// Clusters about -2.58, -2.32, 2.32 and 2.58, each with a quarter of the values: `width` is the sigma of each.
fn four_clusters(width: f64, beside: Law) -> SurfaceLaw {
    let two = || -> Law { Arc::new(TwoValues::new(-1.0, 1.0).unwrap()) };
    let parts = [2.45, 0.13, width].map(|factor| Some(Univariate::of_coefficients(&[factor])));
    let surrogate = Surrogate { centre: 0.0, parts: parts.to_vec(), interactions: Interactions::none(3) };
    SurfaceLaw::of(&surrogate, &[two(), two(), beside], None, &LawOptions::default()).unwrap()
}

/// Two pairs of values with a narrow normal distribution beside each: the same clusters, of a law without ends. Quantiles are those of the
/// normal distribution in each cluster, whose neighbours have less than 1e-300 of it.
#[test]
fn quantiles_of_a_law_without_ends_lie_in_their_cluster() {
    for width in [1e-5, 1e-3] {
        let law = four_clusters(width, Arc::new(Normal::new(0.0, 1.0).unwrap()));
        let clusters = [-2.58, -2.32, 2.32, 2.58];
        for p in [1.35e-3, 0.01, 0.05, 0.2, 0.3, 0.45f64] {
            let exact = clusters[(4.0 * p) as usize]
                + width * sensitol_numeric::distribution::standard_normal::quantile((4.0 * p).fract());
            for (tail, sign) in [(LawTail::Lower, 1.0), (LawTail::Upper, -1.0)] {
                let sought = Sought { tail, p, near: -2.4 * sign, density: 0.2 };
                for found in [law.quantile(tail, p), law.quantiles(&[sought])[0]] {
                    let off = (sign * found.value - exact).abs();
                    assert!(off <= 3.0 * found.error, "{width} {p}: {found:?}, exact {exact}");
                    assert!(found.error <= 0.02, "{width} {p}: {found:?}");
                }
            }
        }
    }
}

/// The median of four clusters of equal probability is any value between the second and the third, and the quartile any value between the
/// first and the second. The error of what is found covers both ends of the gap.
#[test]
fn error_of_a_quantile_on_a_gap_covers_the_gap() {
    for width in [1e-5, 1e-3] {
        let law = four_clusters(width, Arc::new(Normal::new(0.0, 1.0).unwrap()));
        for (p, ends) in [(0.5, [-2.32, 2.32]), (0.25, [-2.58, -2.32])] {
            for tail in [LawTail::Lower, LawTail::Upper] {
                let sign = if tail == LawTail::Lower { 1.0 } else { -1.0 };
                let sought = Sought { tail, p, near: -2.4 * sign, density: 0.2 };
                for found in [law.quantile(tail, p), law.quantiles(&[sought])[0]] {
                    let value = sign * found.value;
                    // Within a few widths of the clusters on both sides.
                    assert!(
                        value >= ends[0] - 6.0 * width - 1e-3 && value <= ends[1] + 6.0 * width + 1e-3,
                        "{found:?}"
                    );
                    let reach = (value - ends[0]).max(ends[1] - value) - 6.0 * width;
                    assert!(found.error >= 0.99 * reach, "{width} {p}: {found:?} in {ends:?}");
                    assert!(found.error <= 5.0 * (ends[1] - ends[0]), "{width} {p}: {found:?} in {ends:?}");
                }
            }
        }
    }
}

/// Tails beside a cluster of any width, from one that the transform resolves to one that is a single value but for its rounding. The error
/// covers the closed form: the share of the third cluster beyond the limit, and the fourth.
#[test]
fn tails_at_the_edge_of_a_narrow_cluster_have_an_honest_error() {
    for power in -9..=-2 {
        let width = 10f64.powi(power);
        let normal = Arc::new(Normal::new(0.0, 1.0).unwrap()) as Law;
        let uniform = Arc::new(Uniform::new(-1.0, 1.0).unwrap()) as Law;
        for (last, is_normal) in [(normal, true), (uniform, false)] {
            let law = four_clusters(width, last);
            for off in [-20.0, -5.0, -1.0, -0.3, 0.0, 0.5, 1.0, 3.0, 20.0, 100.0f64] {
                let found = law.tail(2.32 + off * width, LawTail::Upper);
                let beyond = |z: f64| match is_normal {
                    true => sensitol_numeric::distribution::standard_normal::sf(z),
                    false => (0.5 - 0.5 * z / 3f64.sqrt()).clamp(0.0, 1.0),
                };
                // The share of the fourth cluster, at 2.58, is below 1 for the widest ones only.
                let exact = 0.25 * beyond(off - 0.26 / width) + 0.25 * beyond(off);
                // The limit itself is rounded to 4e-16, which the cluster's density turns into a probability.
                let allowed = 1.01 * found.error + 1e-15 / width;
                assert!((found.value - exact).abs() <= allowed, "{width:e} {off}: {found:?}, exact {exact}");
                // A few widths from the cluster, and for wide clusters everywhere but in the middle of a jump, the tail is exact.
                let sharp = off.abs() * width > 1e-4 || power >= -5;
                assert!(!sharp || found.error < 3e-4, "{width:e} {off}: {found:?}");
            }
        }
    }
}
