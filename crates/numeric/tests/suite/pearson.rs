//! Pearson system, compared with 25-digit results, closed forms and other libraries, and its properties.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use sensitol_numeric::pearson::{Pearson, PearsonError, PearsonType};
use sensitol_testing::repository;

/// A distribution of the system in 25 digits.
struct Member {
    id: u64,
    kind: String,
    law: Pearson,
    ends: [Option<f64>; 2],
    row: serde_json::Value,
}

impl Member {
    fn column(&self, name: &str) -> Vec<f64> {
        let number = |value: &serde_json::Value| match value {
            serde_json::Value::String(text) => text.parse().unwrap(),
            value => value.as_f64().unwrap(),
        };
        self.row[name].as_array().unwrap().iter().map(number).collect()
    }
}

fn members() -> Vec<Member> {
    let text = std::fs::read_to_string(repository("tests/data/pearson.jsonl")).unwrap();
    let member = |line: &str| {
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        let end = |index: usize| row["support"][index].as_str().map(|text| text.parse().unwrap());
        Member {
            id: row["id"].as_u64().unwrap(),
            kind: row["type"].as_str().unwrap().to_owned(),
            law: Pearson::new(0.0, 1.0, row["g1"].as_f64().unwrap(), row["b2"].as_f64().unwrap()).unwrap(),
            ends: [end(0), end(1)],
            row,
        }
    };
    let members: Vec<Member> = text.lines().map(member).collect();
    assert_eq!(members.len(), 97);
    members
}

fn off(found: f64, expected: f64) -> f64 {
    ((found - expected) / expected).abs()
}

#[test]
fn probabilities_have_all_their_digits() {
    let (mut worst, mut compared) = (0.0f64, 0);
    for member in members() {
        let [pdf, cdf, sf] = ["pdf", "cdf", "sf"].map(|name| member.column(name));
        for (index, z) in member.column("z").into_iter().enumerate() {
            if member.ends.iter().flatten().any(|end| (z - end).abs() < 1e-3) {
                continue;
            }
            let law = &member.law;
            let found = [law.pdf(z), law.cdf(z), law.sf(z)];
            let logs = [law.log_pdf(z), law.log_cdf(z), law.log_sf(z)];
            for (which, expected) in [pdf[index], cdf[index], sf[index]].into_iter().enumerate() {
                if expected > 1e-280 {
                    compared += 1;
                    let error = off(found[which], expected);
                    worst = worst.max(error);
                    assert!(error < 1e-11, "member {}: {which} at {z}: {} {expected}", member.id, found[which]);
                    let log = (logs[which] - expected.ln()).abs();
                    assert!(log < 1e-11 * expected.ln().abs().max(1.0), "member {}: log {which} at {z}", member.id);
                }
            }
        }
    }
    assert!(compared > 2900, "{compared}");
    println!("{compared} values, worst {worst:e}");
}

#[test]
fn quantiles_have_all_their_digits() {
    let mut worst = 0.0f64;
    for member in members() {
        let lower = (member.column("p_lower").into_iter().zip(member.column("q_lower")))
            .map(|(p, expected)| (p, member.law.quantile(p), expected));
        let upper = (member.column("p_upper").into_iter().zip(member.column("q_upper")))
            .map(|(p, expected)| (p, member.law.upper_quantile(p), expected));
        for (p, found, expected) in lower.chain(upper) {
            let error = (found - expected).abs() / expected.abs().max(1.0);
            worst = worst.max(error);
            assert!(error < 1e-11, "member {}: quantile of {p}: {found} {expected}", member.id);
        }
    }
    println!("worst {worst:e}");
}

#[test]
fn types_and_supports_are_the_oracle_s() {
    for member in members() {
        // A kurtosis on the line between two types is not a double, so it lies on one side or the other.
        if member.row["b2_exact"].is_null() {
            assert_eq!(member.law.kind().to_string(), member.kind, "member {}", member.id);
            for (found, expected) in member.law.support().into_iter().zip(member.ends) {
                match expected {
                    Some(expected) => assert!(off(found, expected) < 1e-14, "member {}: {found}", member.id),
                    None => assert!(found.is_infinite()),
                }
            }
        }
    }
}

/// Skewness, kurtosis and a probability, over all magnitudes at which an error is likely.
fn random(cases: usize) -> impl Iterator<Item = (f64, f64, f64)> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(20_261_121);
    std::iter::repeat_with(move || {
        let mut power = |from: f64, to: f64| 10f64.powf(rng.random_range(from..to));
        let skewness = power(-9.0, 1.5);
        let bound = 1.0 + skewness * skewness;
        // Kurtosis from next to its bound to far from it, or next to the line of type III, where most assemblies are.
        let third = 3.0 + 1.5 * skewness * skewness;
        let kurtosis =
            [bound + power(-7.0, 4.0), third + power(-15.0, 0.0), third - power(-15.0, 0.0)][rng.random_range(0..3)];
        let p = 0.5 * power_of(&mut rng);
        (if rng.random() { skewness } else { -skewness }, kurtosis.max(bound * (1.0 + 1e-9)), p)
    })
    .take(cases)
}

fn power_of(rng: &mut Xoshiro256PlusPlus) -> f64 {
    let lowest = [-0.5, -12.0, -290.0][rng.random_range(0..3)];
    10f64.powf(rng.random_range(lowest..0.0))
}

/// A quantile has the probability that it was computed for. If neighbouring doubles differ by more than that, the probability lies between
/// theirs. This happens next to an end of the support only.
#[test]
fn quantiles_and_probabilities_invert_each_other() {
    let mut steep = 0;
    for (skewness, kurtosis, p) in random(10_000) {
        let law = Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap();
        let what = format!("skewness {skewness:e} kurtosis {kurtosis:e} p {p:e}");
        for upper in [false, true] {
            let q = if upper { law.upper_quantile(p) } else { law.quantile(p) };
            let probability = |z: f64| if upper { law.sf(z) } else { law.cdf(z) };
            assert!(q.is_finite(), "{what}: {q}");
            if off(probability(q), p) > 1e-10 {
                steep += 1;
                let near = law.support().into_iter().any(|end| (q - end).abs() < 1e-3);
                assert!(near, "{what} upper {upper}: {:e} at {q}", probability(q));
                let mut around = [probability(q.next_down()), probability(q.next_up())];
                around.sort_by(f64::total_cmp);
                assert!(around[0] <= p * (1.0 + 1e-10) && p * (1.0 - 1e-10) <= around[1], "{what}: {around:?}");
            }
        }
    }
    println!("{steep} of 20000 next to an end");
}

#[test]
fn a_law_and_its_mirror_image_agree_to_the_last_bit() {
    for (skewness, kurtosis, p) in random(2000) {
        let [law, mirror] = [skewness, -skewness].map(|skewness| Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap());
        assert_eq!(law.quantile(p), -mirror.upper_quantile(p));
        for z in [-7.0, -1.2, -0.3, 0.0, 0.1, 2.0, 30.0] {
            assert_eq!(law.pdf(z), mirror.pdf(-z));
            assert_eq!(law.cdf(z), mirror.sf(-z));
            assert_eq!(law.log_cdf(z), mirror.log_sf(-z));
        }
        // A symmetric distribution is its own mirror image.
        let symmetric = Pearson::new(0.0, 1.0, 0.0, kurtosis).unwrap();
        assert_eq!(symmetric.quantile(p), -symmetric.upper_quantile(p));
        assert_eq!(symmetric.cdf(-1.3), symmetric.sf(1.3));
    }
}

/// Both probabilities sum to 1 and are monotone.
#[test]
fn probabilities_are_monotone_and_sum_to_one() {
    for (skewness, kurtosis, _) in random(300) {
        let law = Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap();
        let mut before = [0.0, 1.0];
        for step in -400..=400 {
            let z = 0.05 * f64::from(step);
            let now = [law.cdf(z), law.sf(z)];
            assert!((now[0] + now[1] - 1.0).abs() < 1e-13, "{skewness} {kurtosis} {z}: {now:?}");
            // Allows for rounding of values that hardly differ.
            assert!(now[0] >= before[0] * (1.0 - 1e-13) && now[1] <= before[1] * (1.0 + 1e-13));
            before = now;
        }
    }
}

/// At every boundary between types, a small step in the moments gives a small step in all results.
#[test]
fn nothing_jumps_where_types_meet() {
    let mut boundaries = vec![(0.0, 3.0), (0.0, 9.0 / 5.0)];
    boundaries.extend([1.5, 2.5, 4.0, 9.0].map(|kurtosis| (0.0, kurtosis)));
    for skewness in [1e-8f64, 1e-3, 0.1, 0.5, 1.0, 2.0, 4.0] {
        let b1 = skewness * skewness;
        boundaries.extend([(skewness, 3.0 + 1.5 * b1), (skewness, 1.8 + 1.2 * b1)]);
    }
    let fifth = members().into_iter().filter(|member| member.kind == "V");
    boundaries.extend(fifth.map(|member| (member.row["g1"].as_f64().unwrap(), member.row["b2"].as_f64().unwrap())));
    assert_eq!(boundaries.len(), 26);
    for (skewness, kurtosis) in boundaries {
        let at = |skewness: f64, kurtosis: f64| {
            let law = Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap();
            let probabilities = [-2.5, -0.9, 0.0, 0.7, 1.5, 4.0].map(|z| [law.pdf(z), law.cdf(z), law.sf(z)]);
            let quantiles = [1e-12, 1e-3, 0.4].map(|p| [law.quantile(p), law.upper_quantile(p), 0.0]);
            [probabilities.concat(), quantiles.concat()].concat()
        };
        let law = Pearson::new(0.0, 1.0, skewness, kurtosis).unwrap();
        // Near an end with an infinite or vanishing density the end itself moves, so it is left out.
        let ends = law.support();
        let inside = |z: f64| ends.iter().all(|end| (z - end).abs() > 0.05);
        let keep: Vec<bool> =
            [-2.5, -0.9, 0.0, 0.7, 1.5, 4.0].into_iter().flat_map(|z| [inside(z); 3]).chain([true; 9]).collect();
        let here = at(skewness, kurtosis);
        for (ds, dk) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            let along = |step: f64| at(skewness + ds * step, kurtosis + dk * step);
            let slopes: Vec<f64> = here.iter().zip(along(1e-5)).map(|(a, b)| (a - b).abs() / 1e-5).collect();
            for power in 6..=15 {
                let step = 10f64.powi(-power);
                let there = along(step);
                for index in (0..here.len()).filter(|&index| keep[index]) {
                    let scale = here[index].abs().max(if index < 18 { 1e-300 } else { 1.0 });
                    // The step in the moments is itself rounded, to 4e-16.
                    let allowed = 3.0 * slopes[index] * (step + 1e-15) + 2e-12 * scale;
                    let jump = (here[index] - there[index]).abs();
                    assert!(
                        jump <= allowed,
                        "({skewness}, {kurtosis}) + ({ds}, {dk}) {step:e}: {index} jumps by {jump:e}"
                    );
                }
            }
        }
    }
}

/// Every pair of doubles gives a distribution or an error in a short time.
#[test]
fn any_pair_of_doubles_is_a_law_or_an_error() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut laws = 0;
    let special =
        [0.0, -0.0, 1.0, 3.0, 1.8, 1e-300, -1e300, 1e50, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::NAN, f64::INFINITY];
    let mut number = |index: usize| match index % 4 {
        0 => f64::from_bits(rng.random()),
        1 => special[rng.random_range(0..special.len())],
        2 => 10f64.powf(rng.random_range(-320.0..308.0)),
        _ => 10f64.powf(rng.random_range(-3.0..3.0)),
    };
    for index in 0..40_000 {
        let (skewness, kurtosis) = (number(index), number(index / 4));
        // Half of them are near the bound.
        let kurtosis = if index % 2 == 0 { kurtosis } else { (1.0 + skewness * skewness) * (1.0 + number(2).min(1.0)) };
        match Pearson::new(0.0, 1.0, skewness, kurtosis) {
            Ok(law) => {
                laws += 1;
                assert!(kurtosis >= (1.0 + skewness * skewness) * (1.0 - 1e-15));
                for z in [-1e300, -40.0, -1.0, 0.0, 1e-10, 3.0, 1e10, f64::INFINITY, f64::NEG_INFINITY] {
                    let [pdf, cdf, sf] = [law.pdf(z), law.cdf(z), law.sf(z)];
                    assert!(pdf >= 0.0, "{skewness:e} {kurtosis:e} {z}: {pdf}");
                    assert!((cdf + sf - 1.0).abs() < 1e-9, "{skewness:e} {kurtosis:e} {z}: {cdf} {sf}");
                }
                for p in [0.0, 5e-324, 1e-200, 1e-9, 0.5, 1.0] {
                    assert!(
                        !law.quantile(p).is_nan() && !law.upper_quantile(p).is_nan(),
                        "{skewness:e} {kurtosis:e} {p}"
                    );
                }
            }
            Err(PearsonError::NotFinite) => assert!(!skewness.is_finite() || !kurtosis.is_finite()),
            Err(PearsonError::Infeasible { bound, .. }) => assert!(kurtosis <= bound * (1.0 + 1e-15)),
            Err(error) => assert!(matches!(error, PearsonError::TooLarge { .. }) && kurtosis > 1e99),
        }
    }
    assert!(laws > 5000, "{laws}");
}

/// Name, type and moments of a distribution, with independent probabilities below and above.
type KnownMember = (&'static str, PearsonType, [f64; 4], Box<dyn Fn(f64) -> [f64; 2]>);

fn raw(kind: PearsonType, mean: f64, variance: f64, skewness: f64, excess: f64) -> (PearsonType, [f64; 4]) {
    (kind, [mean, variance.sqrt(), skewness, 3.0 + excess])
}

/// Closed forms, exact to a few roundings.
fn closed_forms() -> Vec<KnownMember> {
    let poisson = |n: i32, m: f64| -> f64 {
        let term = |k: i32| (1..=k).fold(1.0, |product, j| product * m / f64::from(j));
        (-m).exp() * (0..n).map(term).sum::<f64>()
    };
    let mut known: Vec<KnownMember> = Vec::new();
    let mut add = |name, (kind, moments): (PearsonType, [f64; 4]), of: Box<dyn Fn(f64) -> [f64; 2]>| {
        known.push((name, kind, moments, of));
    };
    add("uniform", raw(PearsonType::II, 0.5, 1.0 / 12.0, 0.0, -1.2), Box::new(|x| [x, 1.0 - x]));
    add(
        "arcsine",
        raw(PearsonType::II, 0.5, 0.125, 0.0, -1.5),
        Box::new(|x| {
            let below = |x: f64| 2.0 / std::f64::consts::PI * x.sqrt().asin();
            [below(x), below(1.0 - x)]
        }),
    );
    // Beta(1, 3): 1 - (1 - x)^3.
    let skewness = 2.0 * 2.0 * 5f64.sqrt() / (6.0 * 3f64.sqrt());
    add(
        "beta 1 3",
        raw(PearsonType::I, 0.25, 3.0 / 80.0, skewness, 6.0 * (4.0 * 5.0 - 3.0 * 6.0) / (3.0 * 6.0 * 7.0)),
        Box::new(|x| {
            let above = (1.0 - x).powi(3);
            [x * (3.0 - 3.0 * x + x * x), above]
        }),
    );
    add("exponential", raw(PearsonType::III, 1.0, 1.0, 2.0, 6.0), Box::new(|x| [-(-x).exp_m1(), (-x).exp()]));
    add(
        "gamma 3",
        raw(PearsonType::III, 3.0, 3.0, 2.0 / 3f64.sqrt(), 2.0),
        Box::new(move |x| [f64::NAN, poisson(3, x)]),
    );
    // Student's t with 5 degrees of freedom.
    add(
        "t 5",
        raw(PearsonType::VII, 0.0, 5.0 / 3.0, 0.0, 6.0),
        Box::new(|x| {
            let angle = (x / 5f64.sqrt()).atan();
            let half =
                (angle + angle.sin() * angle.cos() * (1.0 + 2.0 / 3.0 * angle.cos().powi(2))) / std::f64::consts::PI;
            [0.5 + half, if x > 2.0 { f64::NAN } else { 0.5 - half }]
        }),
    );
    // F with 2 and 12 degrees of freedom: (1 + x/6)^-6 above.
    let variance = 1.44 * 2.0 * 12.0 / (2.0 * 8.0);
    let skewness = (2.0 * 2.0 + 10.0) * 64f64.sqrt() / (6.0 * (2.0 * 12.0f64).sqrt());
    let excess = 12.0 * (2.0 * 38.0 * 12.0 + 8.0 * 100.0) / (2.0 * 6.0 * 4.0 * 12.0);
    add(
        "F 2 12",
        raw(PearsonType::VI, 1.2, variance, skewness, excess),
        Box::new(|x| {
            let above = (1.0 + x / 6.0).powi(-6);
            [1.0 - above, above]
        }),
    );
    // Inverse gamma with shape 6: the Poisson sum of 1/x below.
    let excess = 6.0 * (5.0 * 6.0 - 11.0) / (3.0 * 2.0);
    add(
        "inverse gamma 6",
        raw(PearsonType::V, 0.2, 0.04 / 4.0, 4.0 * 2.0 / 3.0, excess),
        Box::new(move |x| [poisson(6, 1.0 / x), f64::NAN]),
    );
    known
}

fn agree(known: &[KnownMember], tolerance: f64) {
    for (name, kind, [mean, sigma, skewness, kurtosis], of) in known {
        let law = Pearson::new(*mean, *sigma, *skewness, *kurtosis).unwrap();
        // The number 8/3 is not a double, so the inverse gamma lies beside its line.
        assert!(
            law.kind() == *kind || *kind == PearsonType::V || *kind == PearsonType::III,
            "{name}: {:?}",
            law.kind()
        );
        for p in [1e-9, 1e-4, 0.02, 0.2, 0.5, 0.8, 0.98, 0.9999, 1.0 - 1e-9] {
            let x = law.quantile(p);
            // Next to an end the rounding of the end itself dominates.
            if law.support().into_iter().any(|end| (x - end).abs() < 1e-3 * sigma) {
                continue;
            }
            for (found, expected) in [law.cdf(x), law.sf(x)].into_iter().zip(of(x)) {
                if !expected.is_nan() && expected > 1e-7 {
                    assert!(off(found, expected) < tolerance, "{name} at {x}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn members_are_the_distributions_that_have_names() {
    // The moments are rounded. Far out that amounts to some hundred roundings.
    agree(&closed_forms(), 2e-12);
}

/// Library statrs 0.19. Its incomplete beta and gamma functions have ten to twelve digits, except in the tails.
#[test]
fn members_are_those_of_another_library() {
    use statrs::distribution::{Beta, ContinuousCDF, FisherSnedecor, Gamma, InverseGamma, StudentsT};
    let both = |law: Box<dyn ContinuousCDF<f64, f64>>| -> Box<dyn Fn(f64) -> [f64; 2]> {
        Box::new(move |x| [law.cdf(x), f64::NAN])
    };
    let beta = |a: f64, b: f64| {
        let n = a + b;
        let skewness = 2.0 * (b - a) * (n + 1.0).sqrt() / ((n + 2.0) * (a * b).sqrt());
        let excess = 6.0 * ((a - b).powi(2) * (n + 1.0) - a * b * (n + 2.0)) / (a * b * (n + 2.0) * (n + 3.0));
        raw(PearsonType::I, a / n, a * b / (n * n * (n + 1.0)), skewness, excess)
    };
    let f = |m: f64, n: f64| {
        let variance = 2.0 * n * n * (m + n - 2.0) / (m * (n - 2.0).powi(2) * (n - 4.0));
        let skewness = (2.0 * m + n - 2.0) * (8.0 * (n - 4.0)).sqrt() / ((n - 6.0) * (m * (m + n - 2.0)).sqrt());
        let top = m * (5.0 * n - 22.0) * (m + n - 2.0) + (n - 4.0) * (n - 2.0).powi(2);
        let excess = 12.0 * top / (m * (n - 6.0) * (n - 8.0) * (m + n - 2.0));
        raw(PearsonType::VI, n / (n - 2.0), variance, skewness, excess)
    };
    let mut known: Vec<KnownMember> = Vec::new();
    let mut add = |name, (kind, moments): (PearsonType, [f64; 4]), of| known.push((name, kind, moments, of));
    add("beta 2.3 4.1", beta(2.3, 4.1), both(Box::new(Beta::new(2.3, 4.1).unwrap())));
    add("beta 0.4 0.7", beta(0.4, 0.7), both(Box::new(Beta::new(0.4, 0.7).unwrap())));
    let gamma = raw(PearsonType::III, 3.7, 3.7, 2.0 / 3.7f64.sqrt(), 6.0 / 3.7);
    add("gamma 3.7", gamma, both(Box::new(Gamma::new(3.7, 1.0).unwrap())));
    let t = raw(PearsonType::VII, 0.0, 7.5 / 5.5, 0.0, 6.0 / 3.5);
    add("t 7.5", t, both(Box::new(StudentsT::new(0.0, 1.0, 7.5).unwrap())));
    add("F 7 15", f(7.0, 15.0), both(Box::new(FisherSnedecor::new(7.0, 15.0).unwrap())));
    let a = 6.2f64;
    let excess = 6.0 * (5.0 * a - 11.0) / ((a - 3.0) * (a - 4.0));
    let variance = 1.0 / ((a - 1.0).powi(2) * (a - 2.0));
    let inverse = raw(PearsonType::V, 1.0 / (a - 1.0), variance, 4.0 * (a - 2.0).sqrt() / (a - 3.0), excess);
    add("inverse gamma 6.2", inverse, both(Box::new(InverseGamma::new(a, 1.0).unwrap())));
    agree(&known, 1e-9);
}

/// Far out, where the probabilities themselves vanish, their logarithms follow the known distributions.
#[test]
fn logarithms_go_on_where_probabilities_vanish() {
    let normal = Pearson::normal(0.0, 1.0).unwrap();
    for z in [10.0f64, 40.0, 1e3, 1e6] {
        // Mills' ratio of the normal: 1/z (1 - 1/z^2 + 3/z^4 - 15/z^6 ...). The first omitted term is 105/z^8.
        let y = 1.0 / (z * z);
        let expected = -0.5 * z * z - 0.5 * (2.0 * std::f64::consts::PI).ln() - z.ln()
            + (1.0 - y + 3.0 * y * y - 15.0 * y * y * y).ln();
        let found = normal.log_sf(z);
        assert!((found - expected).abs() < 105.0 * y.powi(4) + 1e-14 * expected.abs(), "{z}: {found} {expected}");
        assert_eq!(normal.log_cdf(-z), found);
    }
    // Exponential: -(1 + z).
    let exponential = Pearson::new(0.0, 1.0, 2.0, 9.0).unwrap();
    for z in [50.0, 1e3, 1e8] {
        assert!(off(exponential.log_sf(z), -1.0 - z) < 1e-14, "{z}");
    }
}

#[test]
fn mean_and_sigma_only_move_and_stretch() {
    let standard = Pearson::new(0.0, 1.0, 0.4, 3.3).unwrap();
    for (mean, sigma) in [(5.99, 0.289), (-1e9, 1e-3), (1e-12, 1e12)] {
        let law = Pearson::new(mean, sigma, 0.4, 3.3).unwrap();
        for z in [-2.0, 0.3, 4.0] {
            let x = mean + sigma * z;
            // Digits of z that are lost by adding the mean.
            let lost = 10.0 * f64::EPSILON * (1.0 + (mean / sigma).abs()) * 10.0;
            assert!(off(law.cdf(x), standard.cdf(z)) < lost && off(law.pdf(x) * sigma, standard.pdf(z)) < lost);
        }
        let x = law.quantile(0.01);
        assert!((x - (mean + sigma * standard.quantile(0.01))).abs() <= f64::EPSILON * x.abs());
    }
}

#[test]
fn impossible_moments_are_named() {
    let Err(PearsonError::Infeasible { bound, law, .. }) = Pearson::new(0.0, 1.0, -1.5, 3.0) else {
        panic!("infeasible")
    };
    assert_eq!(bound, 3.25);
    // The two values have the requested skewness.
    let moment = |power| law.values.iter().zip(law.probabilities).map(|(value, p)| p * value.powi(power)).sum::<f64>();
    for (power, expected) in [(0, 1.0), (1, 0.0), (2, 1.0), (3, -1.5), (4, 3.25)] {
        assert!((moment(power) - expected).abs() < 1e-14);
    }
    let message = Pearson::new(0.0, 1.0, 0.5071, 1.2).unwrap_err().to_string();
    assert!(message.contains("1.257") && message.contains("two values"), "{message}");
    assert!(matches!(Pearson::new(0.0, 0.0, 0.0, 3.0), Err(PearsonError::Sigma { .. })));
    assert!(matches!(Pearson::new(f64::NAN, 1.0, 0.0, 3.0), Err(PearsonError::NotFinite)));
    let law = Pearson::normal(0.0, 1.0).unwrap();
    for p in [-0.1, 1.1, f64::NAN] {
        assert!(law.quantile(p).is_nan() && law.upper_quantile(p).is_nan());
    }
    assert!(law.cdf(f64::NAN).is_nan() && law.pdf(f64::NAN).is_nan());
}

/// Variates follow the distribution: Kolmogorov's distance of 100 000 values is below 1.95/sqrt n with the probability 0.999.
#[test]
fn variates_follow_the_law() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    for (skewness, kurtosis) in [(0.0, 3.0), (-0.8, 4.5), (1.2, 4.0), (2.0, 9.0)] {
        let law = Pearson::new(10.0, 0.5, skewness, kurtosis).unwrap();
        let mut sample: Vec<f64> = (&mut rng).sample_iter(&law).take(100_000).collect();
        sample.sort_by(f64::total_cmp);
        let n = sample.len() as f64;
        let distance = |(index, x): (usize, &f64)| (law.cdf(*x) - (index as f64 + 0.5) / n).abs();
        let worst = sample.iter().enumerate().map(distance).fold(0.0, f64::max);
        assert!(worst < 1.95 / n.sqrt(), "{skewness} {kurtosis}: {worst}");
    }
}
