//! Sampling: Sobol' points, sums that merge, histogram bins, and points that do not depend on the caller.

use proptest::prelude::*;
use sensitol_numeric::correlation::{Correlation, Pair};

use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::CentralMoments;
use sensitol_numeric::sampling::{Draws, Fine, Portion, SOBOL_DIMENSIONS, Scale, Sobol, Summary, wilson};
use sensitol_numeric::sampling::{Sampler, SamplingError};
use sensitol_testing::{close, normals, relative};

fn column(sobol: &Sobol, dimension: usize, key: Option<u64>, points: usize) -> Vec<f64> {
    let mut column = vec![0.0; points];
    sobol.column(dimension, 0, key, &mut column);
    column
}

/// Points of scipy 1.x, `qmc.Sobol(2048, scramble=False, bits=52)`. Its i-th point is ours at `i xor i/2` (Gray code).
#[test]
fn sobol_points_are_those_of_joe_and_kuo() {
    let sobol = Sobol::new(SOBOL_DIMENSIONS).unwrap();
    let dimensions = [0, 1, 2, 9, 99, 1110, 2047];
    let published = [
        (1, [0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]),
        (3, [0.75, 0.25, 0.25, 0.75, 0.75, 0.75, 0.75]),
        (2, [0.25, 0.75, 0.75, 0.25, 0.25, 0.25, 0.25]),
        (653, [0.6923828125, 0.9365234375, 0.1630859375, 0.3232421875, 0.5107421875, 0.5849609375, 0.2060546875]),
        (540, [0.2197265625, 0.0966796875, 0.5185546875, 0.0693359375, 0.1865234375, 0.3701171875, 0.8974609375]),
    ];
    for (&dimension, place) in dimensions.iter().zip(0..) {
        let column = column(&sobol, dimension, None, 1024);
        for (point, coordinates) in &published {
            assert_eq!(column[*point], coordinates[place], "point {point}, dimension {dimension}");
        }
    }
    assert!(Sobol::new(SOBOL_DIMENSIONS + 1).is_none());
}

/// All numbers of Joe and Kuo's text. Point 2^k of a dimension is `m_(k+1)/2^(k+1)`. The text has them up to the polynomial's degree `s`,
/// and the recurrence `m_k = 2 a_1 m_(k-1) xor .. 2^(s-1) a_(s-1) m_(k-s+1) xor 2^s m_(k-s) xor m_(k-s)` gives the others.
#[test]
fn every_direction_number_is_that_of_the_published_table() {
    let sobol = Sobol::new(SOBOL_DIMENSIONS).unwrap();
    let text = include_str!("../../../../tests/data/joe-kuo.txt");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let mut dimensions = 1;
    for (dimension, line) in (1..).zip(lines) {
        let numbers: Vec<u64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let [degree, middle, ref initial @ ..] = numbers[..] else { panic!("{line}") };
        let s = degree as usize;
        assert_eq!(initial.len(), s, "{line}");
        let mut m = initial.to_vec();
        for k in s..s + 4 {
            let sum = (1..s).filter(|i| middle >> (s - 1 - i) & 1 == 1).fold(0, |sum, i| sum ^ m[k - i] << i);
            m.push(sum ^ m[k - s] << s ^ m[k - s]);
        }
        for (k, number) in m.into_iter().enumerate() {
            let mut point = [0.0];
            sobol.column(dimension, 1 << k, None, &mut point);
            assert_eq!(point[0] * (2u64 << k) as f64, number as f64, "dimension {dimension}, m_{}", k + 1);
        }
        dimensions += 1;
    }
    assert_eq!(dimensions, SOBOL_DIMENSIONS);
}

/// Any block of points can be computed by itself.
#[test]
fn sobol_blocks_are_parts_of_the_whole() {
    let sobol = Sobol::new(5).unwrap();
    for key in [None, Some(7)] {
        let whole = column(&sobol, 4, key, 4096);
        let mut part = vec![0.0; 256];
        sobol.column(4, 1024, key, &mut part);
        assert_eq!(part, whole[1024..1280]);
        let mut odd = vec![0.0; 200];
        sobol.column(4, 512, key, &mut odd);
        assert_eq!(odd, whole[512..712]);
    }
}

/// Every elementary interval of volume `2^(t-m)` holds `2^t` of `2^m` points, with t = 0 in two dimensions and 1 in three. Owen's
/// scrambling preserves this.
#[test]
fn points_are_balanced_scrambled_or_not() {
    let sobol = Sobol::new(3).unwrap();
    let m = 8u32;
    for seed in [None, Some(1u64), Some(99)] {
        let columns: Vec<Vec<f64>> = (0..3)
            .map(|d| column(&sobol, d, seed.map(|seed| seed.wrapping_mul(0x9e37_79b9) + d as u64), 1 << m))
            .collect();
        for (dimensions, t) in [(2, 0), (3, 1)] {
            let depth = m - t;
            for a in 0..=depth {
                for b in 0..=depth - a {
                    let c = depth - a - b;
                    if dimensions == 2 && c > 0 {
                        continue;
                    }
                    let mut counts = vec![0; 1 << depth];
                    for ((x, y), z) in columns[0].iter().zip(&columns[1]).zip(&columns[2]) {
                        let cell = |coordinate: &f64, digits: u32| (coordinate * f64::from(1 << digits)) as usize;
                        counts[((cell(x, a) << b) | cell(y, b)) << c | cell(z, c)] += 1;
                    }
                    assert!(counts.iter().all(|&count| count == 1 << t), "{dimensions} dimensions, {a} {b} {c}");
                }
            }
        }
    }
}

/// Scrambled coordinates are uniform over many keys, digit by digit. The digits of one point are independent.
#[test]
fn scrambling_is_uniform() {
    let sobol = Sobol::new(1).unwrap();
    let keys = 20_000;
    let (mut mean, mut product) = (0.0, 0.0);
    let mut first = [0.0; 2];
    for key in 0..keys {
        sobol.column(0, 0, Some(key), &mut first);
        mean += first[0];
        product += (first[0] - 0.5) * (first[1] - 0.5);
    }
    let n = keys as f64;
    // The tolerance is four standard errors, sqrt(1/12/n) each. The second point lies in the other half: E[product] = -1/16.
    close(mean / n, 0.5, 4.0 * (1.0 / 12.0 / n).sqrt(), 1.0);
    close(product / n, -1.0 / 16.0, 4.0 * 0.05 / n.sqrt(), 1.0);
}

/// The bit that flips a digit depends on the digits above it only. Any two nodes of the tree have independent bits, near the root and
/// below, within one tree of hashed digits and across trees.
#[test]
fn every_node_has_a_random_bit_of_its_own() {
    const POINTS: usize = 64;
    const LEVELS: u32 = 14;
    let sobol = Sobol::new(1).unwrap();
    let digits = |key: Option<u64>| -> Vec<u64> {
        column(&sobol, 0, key, POINTS).iter().map(|x| (x * f64::from(1 << LEVELS)) as u64).collect()
    };
    let plain = digits(None);
    let mut nodes: Vec<(u32, u64, usize)> = Vec::new();
    for level in 0..LEVELS {
        for (point, digits) in plain.iter().enumerate() {
            let above = digits >> (LEVELS - level);
            if !nodes.iter().any(|&(of, prefix, _)| (of, prefix) == (level, above)) {
                nodes.push((level, above, point));
            }
        }
    }
    assert_eq!(nodes.len(), 63 + 8 * POINTS);
    let keys = 4096usize;
    let mut flips: Vec<Vec<u64>> = vec![vec![0; keys / 64]; nodes.len()];
    for key in 0..keys {
        let scrambled = digits(Some(key as u64 * 0x1_0001));
        for (flips, &(level, _, point)) in flips.iter_mut().zip(&nodes) {
            let bit = (scrambled[point] ^ plain[point]) >> (LEVELS - 1 - level) & 1;
            flips[key / 64] |= bit << (key % 64);
        }
    }
    // Six standard errors of a fair coin. With 165 000 pairs, one run in 3000 has a pair beyond.
    let fair = |ones: u32| (f64::from(ones) - keys as f64 / 2.0).abs() < 6.0 * (keys as f64).sqrt() / 2.0;
    for (j, one) in flips.iter().enumerate() {
        assert!(fair(one.iter().map(|word| word.count_ones()).sum()), "{:?}", nodes[j]);
        for (k, other) in flips[..j].iter().enumerate() {
            let differ = one.iter().zip(other).map(|(a, b)| (a ^ b).count_ones()).sum();
            assert!(fair(differ), "{:?} and {:?}", nodes[j], nodes[k]);
        }
    }
    // Equal digits above give equal flips: points that differ from one level on agree before it.
    for (point, other) in (0..POINTS).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let scrambled = digits(Some(77));
        let shared = |a: u64, b: u64| (a ^ b).leading_zeros();
        assert_eq!(shared(plain[point], plain[other]), shared(scrambled[point], scrambled[other]));
    }
}

/// Counts of random normal values, in cells of a tenth of sigma and in the far tails, against the distribution function.
#[test]
fn random_normals_are_normal() {
    let one = [Dimension::normal("z", 0.0, 3.0).unwrap()];
    let law = one[0].distribution().unwrap().probability().unwrap();
    let draws = Draws::new(&one, None, Sampler::Random, 3).unwrap();
    // One far edge is the beginning of the ziggurat's tail.
    let far = [-4.5, -4.0, -3.654_152_885_361_009];
    let middle = (-35..=35).map(|i| f64::from(i) / 10.0);
    let edges: Vec<f64> = far.into_iter().chain(middle).chain(far.into_iter().rev().map(|edge| -edge)).collect();
    let mut counts = vec![0u64; edges.len() + 1];
    let portions = 2048u64;
    for portion_of in 0..portions {
        for value in draws.points(portion(portion_of * 1024, 1024)).column(0) {
            counts[edges.partition_point(|edge| edge < value)] += 1;
        }
    }
    let n = (portions * 1024) as f64;
    let below = |i: usize| if i < edges.len() { law.cdf(edges[i]) } else { 1.0 };
    let mut chi_square = 0.0;
    for (i, &count) in counts.iter().enumerate() {
        let share = below(i) - if i == 0 { 0.0 } else { below(i - 1) };
        chi_square += (count as f64 - n * share).powi(2) / (n * share);
    }
    // With 77 degrees of freedom the mean is 77 and sigma 12.4. The bounds are five sigma.
    assert!((15.0..139.0).contains(&chi_square), "{chi_square}");
}

/// Quantiles of many probabilities at once equal those of each, in the centre, in the tails and far out.
#[test]
fn quantiles_by_the_block_are_those_one_by_one() {
    let one = Dimension::normal("z", 5.0, 0.3).unwrap();
    let law = one.distribution().unwrap().probability().unwrap();
    let p = (1..700).map(|i| if i < 500 { f64::from(i) / 1000.0 } else { 10f64.powi(-(i - 480)) });
    let tails: Vec<f64> = p.flat_map(|p| [p, -p]).collect();
    // Values beyond the middle, and values that are not probabilities, alone and among others.
    let beyond = [0.6, 0.95, 0.99, 1.0 - 1e-12, 1.0, 0.0, 1.5, f64::NAN].map(|p| [p, -p]).concat();
    for tails in beyond.chunks(1).chain([&beyond[..], &[&beyond[..], &tails].concat()]) {
        let mut found = tails.to_vec();
        law.quantiles(&mut found);
        for (&tail, found) in tails.iter().zip(found) {
            let expected = if tail < 0.0 { law.upper_quantile(-tail) } else { law.quantile(tail) };
            assert!(found == expected || (found.is_nan() && expected.is_nan()), "{tail}: {found}, not {expected}");
        }
    }
    for length in [1, 2, 255, 256, 257, tails.len()] {
        let mut found = tails[..length].to_vec();
        law.quantiles(&mut found);
        for (&tail, found) in tails.iter().zip(found) {
            let expected = if tail < 0.0 { law.upper_quantile(-tail) } else { law.quantile(tail) };
            assert_eq!(found, expected, "{tail:e}");
        }
    }
}

proptest! {
    /// A sample merged from any parts has the sums of the whole.
    #[test]
    fn summaries_merge(values in prop::collection::vec(-1.0..1.0f64, 3..200), cuts in prop::collection::vec(0.0..1.0f64, 0..5)) {
        // Far from 0, where sums about the origin would lose all digits.
        let values: Vec<f64> = values.iter().map(|value| 1e6 + value).collect();
        let mut ends: Vec<usize> = cuts.iter().map(|cut| (cut * values.len() as f64) as usize).collect();
        ends.sort_unstable();
        ends.push(values.len());
        let (mut merged, mut from) = (Summary::default(), 0);
        for to in ends {
            merged.merge(&Summary::of(&values[from..to]));
            from = to;
        }
        let whole = Summary::of(&values);
        prop_assert_eq!(merged.count(), whole.count());
        prop_assert_eq!(merged.range(), whole.range());
        close(merged.mean(), whole.mean(), 1e-15, 0.0);
        for order in 2..=8 {
            // A mean of 1e6 has an ulp of 1e-10, which is the error of every deviation.
            close(merged.moment(order), whole.moment(order), 1e-8, 1.0);
        }
    }

    /// Quantiles from bins equal those of the sorted sample, to the square of a bin's width.
    #[test]
    fn bins_know_quantiles(values in prop::collection::vec(-3.0..3.0f64, 100..500), p in 0.01..0.99f64) {
        let scale = Scale::about(0.5, 2.0);
        let mut fine = Fine::new(scale);
        fine.count(&scale.bins(&values));
        prop_assert_eq!(scale.bins(&values), values.iter().map(|&value| scale.bin(value)).collect::<Vec<_>>());
        let mut sorted = values.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let rank = (p * values.len() as f64).ceil();
        let found = fine.at_rank(rank).unwrap();
        // At a whole rank the value is the upper end of the values in its bin. A bin is 1e-3 of the spread, and wider far out.
        close(found, sorted[rank as usize - 1], 1e-3 * 2.0 * 2.0, 1.0);
    }
}

#[test]
fn a_histogram_counts_everything_once() {
    let scale = Scale::about(0.0, 1.0);
    let mut fine = Fine::new(scale);
    let values: Vec<f64> = (0..1000).map(|i| (f64::from(i) / 250.0 - 2.0).powi(3)).collect();
    fine.count(&scale.bins(&values));
    let (edges, counts) = fine.histogram([-8.0, values[999]], [-6.0, 6.0], 20);
    assert_eq!(edges.len(), counts.len() + 1);
    assert!(edges.windows(2).all(|pair| pair[0] < pair[1]));
    for (pair, &count) in edges.windows(2).zip(&counts) {
        let last = pair[1] == values[999];
        let inside = |value: &&f64| pair[0] <= **value && (**value < pair[1] || last);
        assert_eq!(values.iter().filter(inside).count() as u64, count, "{pair:?}");
    }
}

/// Wilson intervals for 8 of 10 and 0 of 50, as given by scipy's `binomtest(...).proportion_ci(method='wilson')`.
#[test]
fn intervals_of_shares_are_wilson_s() {
    let [low, high] = wilson(8.0, 10.0);
    close(low, 0.490_162_471_536_641_8, 1e-14, 1.0);
    close(high, 0.943_317_848_545_624_8, 1e-14, 1.0);
    let [low, high] = wilson(0.0, 50.0);
    assert_eq!(low, 0.0);
    close(high, 0.071_347_599_133_358_72, 1e-14, 1.0);
}

fn portion(first: u64, rows: usize) -> Portion {
    Portion { replicate: 0, first, rows }
}

/// A dimension's values depend neither on other dimensions nor on the portions that are requested.
#[test]
fn points_are_the_same_for_anybody() {
    let three = normals(&[1.0, 2.0, 3.0], &[0.1, 0.2, 0.3]);
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let draws = Draws::new(&three, None, sampler, 5).unwrap();
        let two = Draws::new(&three[..2], None, sampler, 5).unwrap();
        let (all, fewer) = (draws.points(portion(1024, 1024)), two.points(portion(1024, 512)));
        assert_eq!(all.column(1)[..512], *fewer.column(1));
        assert_ne!(all.column(0), draws.points(portion(0, 1024)).column(0));
        assert_ne!(all.column(0), Draws::new(&three, None, sampler, 6).unwrap().points(portion(1024, 1024)).column(0));
    }
    // Value stability: the values of seed 5 never change.
    let first = Draws::new(&three, None, Sampler::Random, 5).unwrap().points(portion(0, 3));
    insta::assert_debug_snapshot!([first.row(0), first.row(1), first.row(2)]);
    let first = Draws::new(&three, None, Sampler::Sobol, 5).unwrap().points(portion(0, 3));
    insta::assert_debug_snapshot!([first.row(0), first.row(1), first.row(2)]);
}

/// Correlated inputs keep their distributions and have their correlation, for random and Sobol' points.
#[test]
fn correlated_points_are_as_asked() {
    let dimensions = [
        Dimension::normal("a", 10.0, 0.3).unwrap(),
        Dimension::fixed("still", 4.0).unwrap(),
        Dimension::uniform("b", 5.0, 0.1).unwrap(),
        Dimension::uniform("c", 5.0, 0.1).unwrap(),
    ];
    let pair = |a: &str, b: &str, value| Pair { between: [a.into(), b.into()], value };
    let correlation = Correlation::new(&dimensions, &[pair("a", "b", 0.6), pair("c", "b", -0.5)]).unwrap();
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let draws = Draws::new(&dimensions, Some(&correlation), sampler, 1).unwrap();
        let points = draws.points(portion(0, 1 << 16));
        assert!(points.column(1).iter().all(|&value| value == 4.0));
        let of = |j: usize, k: usize| {
            let (a, b) = (Summary::of(points.column(j)), Summary::of(points.column(k)));
            let product = points.column(j).iter().zip(points.column(k)).map(|(x, y)| (x - a.mean()) * (y - b.mean()));
            product.sum::<f64>() / points.rows() as f64 / a.sigma() / b.sigma()
        };
        // The tolerance is four standard errors of a correlation, (1 - r^2)/sqrt n each.
        for (j, k, value) in [(0, 2, 0.6), (2, 3, -0.5), (0, 3, 0.0)] {
            close(of(j, k), value, 4.0 / 256.0, 1.0);
        }
        let uniform = Summary::of(points.column(2));
        relative(uniform.sigma(), 0.1 / 3f64.sqrt(), 0.01);
        assert!(uniform.range()[0] >= 4.9 && uniform.range()[1] <= 5.1);
    }
}

#[test]
fn what_cannot_be_sampled_is_refused() {
    let moments = CentralMoments::new(0.0, [1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0]).unwrap();
    let known = [Dimension::distributed("wear", 0.0, None, std::sync::Arc::new(moments)).unwrap()];
    let error = Draws::new(&known, None, Sampler::Random, 1).err().unwrap();
    assert_eq!(error, SamplingError::MomentsOnly { dimension: "wear".into() });
    let many = normals(&vec![0.0; SOBOL_DIMENSIONS + 1], &vec![1.0; SOBOL_DIMENSIONS + 1]);
    assert!(Draws::new(&many, None, Sampler::Random, 1).is_ok());
    let error = Draws::new(&many, None, Sampler::Sobol, 1).err().unwrap();
    assert_eq!(error, SamplingError::TooManyDimensions { dimensions: SOBOL_DIMENSIONS + 1 });
}
