//! Proofs: figures that are called exact are exact. Random polynomials are compared with an independent expansion, for every method.
//!
//! The expansion does not use the engine. A polynomial in standardised inputs is multiplied by itself, term by term in twice the precision
//! of doubles, and every power of an input has its moment in closed form.

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use sensitol::analysis::{CharacteristicAnalysis, DerivativeOrigin, VerificationKind, YieldSource};
use sensitol::method::registry::ALL;
use sensitol::{DerivativeSource, Method, Options, analyze};
use sensitol_study::Study;
use serde_json::{Value, json};

use sensitol_testing::data;

/// Number in twice the precision of a double (Dekker 1971).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Double(f64, f64);

impl Double {
    const ZERO: Self = Self(0.0, 0.0);

    fn of(value: f64) -> Self {
        Self(value, 0.0)
    }

    /// Returns `a/b` of two doubles in twice their precision.
    fn ratio(a: f64, b: f64) -> Self {
        let quotient = a / b;
        Self(quotient, (-quotient).mul_add(b, a) / b)
    }

    fn plus(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let part = sum - self.0;
        let lost = (self.0 - (sum - part)) + (other.0 - part);
        Self::normal(sum, lost + self.1 + other.1)
    }

    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let lost = self.0.mul_add(other.0, -product);
        Self::normal(product, lost + self.0 * other.1 + self.1 * other.0)
    }

    fn power(self, exponent: usize) -> Self {
        (0..exponent).fold(Self::of(1.0), |power, _| power.times(self))
    }

    fn normal(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }

    fn value(self) -> f64 {
        self.0 + self.1
    }
}

/// Kinds of inputs with closed forms for all moments of the standardised variable.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Normal,
    Uniform,
    Triangular,
    Exponential,
    TwoPoint,
}

const SHAPES: [Shape; 5] = [Shape::Normal, Shape::Uniform, Shape::Triangular, Shape::Exponential, Shape::TwoPoint];
/// Highest power of an input: the fourth power of a quartic.
const HIGHEST: usize = 16;

impl Shape {
    /// Returns the moments `E u^k`: normal `(k-1)!!`; uniform `3^(k/2)/(k+1)`; symmetric triangular `6^(k/2) 2/((k+1)(k+2))`; exponential
    /// the number of permutations of k without a fixed point; two points 1.
    fn moments(self) -> Vec<Double> {
        let even = |k: usize, value: Double| if k.is_multiple_of(2) { value } else { Double::ZERO };
        let half = |base: f64, k: usize| Double::of(base).power(k / 2);
        let mut derangements = vec![1.0, 0.0];
        (2..=HIGHEST).for_each(|k| derangements.push((k as f64 - 1.0) * (derangements[k - 1] + derangements[k - 2])));
        let moment = |k: usize| {
            let of = k as f64;
            match self {
                Self::Normal => {
                    even(k, (1..k).step_by(2).fold(Double::of(1.0), |all, odd| all.times(Double::of(odd as f64))))
                }
                Self::Uniform => even(k, half(3.0, k).times(Double::ratio(1.0, of + 1.0))),
                Self::Triangular => even(k, half(6.0, k).times(Double::ratio(2.0, (of + 1.0) * (of + 2.0)))),
                Self::Exponential => Double::of(derangements[k]),
                Self::TwoPoint => even(k, Double::of(1.0)),
            }
        };
        (0..=HIGHEST).map(moment).collect()
    }

    /// Returns sigma from the half-width, or from the mean of an exponential distribution: `T/3`, `T/sqrt 3`, `T/sqrt 6`, the mean itself,
    /// `T`.
    fn sigma(self, tolerance: f64) -> Double {
        let root = |square: f64| {
            let value = square.sqrt();
            Double(value, (-value).mul_add(value, square) / (2.0 * value))
        };
        let over = |by: Double| {
            let first = tolerance / by.0;
            let rest = Double::of(tolerance).plus(Double::of(-first).times(by));
            Double::normal(first, rest.value() / by.0)
        };
        match self {
            Self::Normal => over(Double::of(3.0)),
            Self::Uniform => over(root(3.0)),
            Self::Triangular => over(root(6.0)),
            Self::Exponential | Self::TwoPoint => Double::of(tolerance),
        }
    }

    fn entry(self, mean: f64, tolerance: f64) -> Value {
        let over = |name: &str| json!({ "nominal": mean, "tolerance": tolerance, "distribution": name });
        match self {
            Self::Normal => json!({ "nominal": mean, "tolerance": tolerance }),
            Self::Uniform => over("uniform"),
            Self::Triangular => over("triangular"),
            Self::TwoPoint => over("two-point"),
            Self::Exponential => {
                json!({ "nominal": mean, "distribution": { "kind": "exponential", "origin": mean - tolerance } })
            }
        }
    }
}

/// Powers of all inputs, with a coefficient for each.
type Terms = BTreeMap<Vec<u8>, Double>;

fn add(terms: &mut Terms, powers: Vec<u8>, more: Double) {
    let of = terms.entry(powers).or_insert(Double::ZERO);
    *of = of.plus(more);
}

fn product(a: &Terms, b: &Terms) -> Terms {
    let mut all = Terms::new();
    for (first, x) in a {
        for (second, y) in b {
            add(&mut all, first.iter().zip(second).map(|(a, b)| a + b).collect(), x.times(*y));
        }
    }
    all
}

/// Polynomial in standardised inputs, with their moments.
#[derive(Debug, Clone)]
struct Expansion {
    terms: Terms,
    moments: Vec<Vec<Double>>,
}

impl Expansion {
    fn mean_of(&self, powers: &[u8]) -> Double {
        let one = |(input, power): (usize, &u8)| self.moments[input][*power as usize];
        powers.iter().enumerate().filter(|(_, power)| **power > 0).map(one).fold(Double::of(1.0), Double::times)
    }

    fn mean(&self) -> Double {
        self.terms.iter().map(|(powers, of)| of.times(self.mean_of(powers))).fold(Double::ZERO, Double::plus)
    }

    /// Returns `E[a b]` of two polynomials over the same inputs.
    fn mean_of_product(&self, other: &Terms) -> Double {
        let mut sum = Double::ZERO;
        for (first, x) in &self.terms {
            for (second, y) in other {
                let powers: Vec<u8> = first.iter().zip(second).map(|(a, b)| a + b).collect();
                sum = sum.plus(x.times(*y).times(self.mean_of(&powers)));
            }
        }
        sum
    }

    /// Returns the polynomial minus its mean.
    fn centred(&self) -> Self {
        let mut terms = self.terms.clone();
        let mean = self.mean();
        add(&mut terms, vec![0; self.moments.len()], Double(-mean.0, -mean.1));
        Self { terms, ..self.clone() }
    }

    /// Returns the variance of the conditional mean given these inputs.
    fn variance_given(&self, given: &dyn Fn(usize) -> bool) -> f64 {
        let mut terms = Terms::new();
        for (powers, of) in &self.terms {
            let others: Vec<u8> =
                powers.iter().enumerate().map(|(input, &power)| if given(input) { 0 } else { power }).collect();
            let own: Vec<u8> =
                powers.iter().enumerate().map(|(input, &power)| if given(input) { power } else { 0 }).collect();
            add(&mut terms, own, of.times(self.mean_of(&others)));
        }
        let conditional = Self { terms, ..self.clone() }.centred();
        conditional.mean_of_product(&conditional.terms).value()
    }

    fn figures(&self) -> Truth {
        let n = self.moments.len();
        let centred = self.centred();
        let square = product(&centred.terms, &centred.terms);
        let squared = Self { terms: square.clone(), ..centred.clone() };
        let variance = squared.mean().value();
        let sigma = variance.sqrt();
        let third = centred.mean_of_product(&square).value();
        let fourth = squared.mean_of_product(&square).value();
        let first: Vec<f64> = (0..n).map(|j| self.variance_given(&|input| input == j) / variance).collect();
        let total = (0..n).map(|j| 1.0 - self.variance_given(&|input| input != j) / variance).collect();
        let linear = |j: usize| {
            let mut line = vec![0; n];
            line[j] = 1;
            centred.mean_of_product(&Terms::from([(line, Double::of(1.0))])).value().powi(2) / variance
        };
        let pairs = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k)));
        let pair = |(j, k): (usize, usize)| {
            let both = self.variance_given(&|input| input == j || input == k) / variance;
            ((j, k), both - first[j] - first[k])
        };
        Truth {
            mean: self.mean().value(),
            sigma,
            skewness: third / sigma.powi(3),
            kurtosis: fourth / (variance * variance),
            linear: (0..n).map(linear).collect(),
            pairs: pairs.map(pair).collect(),
            first,
            total,
        }
    }
}

/// Figures of an expansion.
#[derive(Debug)]
struct Truth {
    mean: f64,
    sigma: f64,
    skewness: f64,
    kurtosis: f64,
    linear: Vec<f64>,
    first: Vec<f64>,
    total: Vec<f64>,
    pairs: BTreeMap<(usize, usize), f64>,
}

/// Random study of one formula, with its expansion.
struct Case {
    study: Study,
    text: String,
    expansion: Expansion,
    degree: usize,
    /// True if all terms are powers of one input or products of two, so that a surface can hold them.
    is_surface: bool,
}

/// Kinds of polynomials: sparse, dense, and such as a surface can hold.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Sparse,
    Dense,
    Surface,
}

fn monomials(n: usize, degree: usize) -> Vec<Vec<u8>> {
    let mut all = vec![vec![0u8; n]];
    for _ in 0..degree {
        let longer: Vec<Vec<u8>> = all
            .iter()
            .flat_map(|powers| {
                (0..n).map(move |input| {
                    let mut powers = powers.clone();
                    powers[input] += 1;
                    powers
                })
            })
            .collect();
        all.extend(longer);
        all.sort_unstable();
        all.dedup();
    }
    all.retain(|powers| powers.iter().any(|power| *power > 0));
    all
}

impl Case {
    fn random(seed: u64, n: usize, degree: usize, kind: Kind) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let shapes: Vec<Shape> = (0..n).map(|_| SHAPES[rng.random_range(0..SHAPES.len())]).collect();
        let means: Vec<f64> = (0..n).map(|_| f64::from(rng.random_range(-8..=8)) / 4.0).collect();
        let tolerances: Vec<f64> = (0..n).map(|_| f64::from(rng.random_range(1..=12)) / 8.0).collect();
        let holds = |powers: &Vec<u8>| {
            let inputs: Vec<u8> = powers.iter().copied().filter(|power| *power > 0).collect();
            inputs.len() == 1 || inputs == [1, 1]
        };
        let mut candidates = monomials(n, degree);
        if kind == Kind::Surface {
            candidates.retain(holds);
        }
        let keep = if kind == Kind::Dense { 1.0 } else { (2.0 * n as f64 / candidates.len() as f64).min(0.7) };
        let highest = |powers: &Vec<u8>| powers.iter().map(|power| usize::from(*power)).sum::<usize>() == degree;
        let forced = candidates.iter().position(highest).unwrap();
        let mut place = 0;
        candidates.retain(|_| {
            place += 1;
            place - 1 == forced || rng.random::<f64>() < keep
        });
        let coefficients: Vec<f64> = candidates
            .iter()
            .map(|_| f64::from(rng.random_range(1..=32)) / 16.0 * if rng.random() { 1.0 } else { -1.0 })
            .collect();
        let text = |(powers, of): (&Vec<u8>, &f64)| {
            let factors = powers.iter().enumerate().filter(|(_, power)| **power > 0);
            let factor = |(input, power): (usize, &u8)| format!("*x{input}^{power}");
            format!("({of}){}", factors.map(factor).collect::<String>())
        };
        let text = candidates.iter().zip(&coefficients).map(text).collect::<Vec<_>>().join(" + ");
        let dimensions: serde_json::Map<String, Value> =
            (0..n).map(|input| (format!("x{input}"), shapes[input].entry(means[input], tolerances[input]))).collect();
        let study = json!({ "dimensions": dimensions, "characteristics": { "y": { "formula": text } } });
        let study = Study::from_json(&study.to_string(), "study").unwrap_or_else(|error| panic!("{text}: {error}"));
        // Replaces every input by its mean and its sigma times a standardised one.
        let standard = |input: usize| {
            let mut line = vec![0; n];
            let mean = Terms::from([(line.clone(), Double::of(means[input]))]);
            line[input] = 1;
            let mut terms = mean;
            add(&mut terms, line, shapes[input].sigma(tolerances[input]));
            terms
        };
        let mut terms = Terms::new();
        for (powers, of) in candidates.iter().zip(&coefficients) {
            let mut one = Terms::from([(vec![0; n], Double::of(*of))]);
            for (input, &power) in powers.iter().enumerate() {
                (0..power).for_each(|_| one = product(&one, &standard(input)));
            }
            one.into_iter().for_each(|(powers, of)| add(&mut terms, powers, of));
        }
        let moments = shapes.iter().map(|shape| shape.moments()).collect();
        // About other means a product of three may become one of two, but not vice versa.
        let is_surface =
            terms.iter().all(|(powers, of)| holds(powers) || of.value() == 0.0 || powers.iter().all(|of| *of == 0));
        Self { study, text, expansion: Expansion { terms, moments }, degree, is_surface }
    }
}

/// Largest relative difference of equal figures.
const SAME: f64 = 1e-12;

/// Compares all figures of a characteristic that is called exact. Returns the name and both values of a wrong one.
fn wrong(found: &CharacteristicAnalysis, truth: &Truth) -> Option<String> {
    let moments = found.moments.unwrap();
    let mut figures = vec![
        (
            "mean".to_owned(),
            moments.mean() / truth.sigma,
            truth.mean / truth.sigma,
            1.0 + (truth.mean / truth.sigma).abs(),
        ),
        ("sigma".to_owned(), moments.sigma() / truth.sigma, 1.0, 1.0),
        ("skewness".to_owned(), moments.skewness().unwrap(), truth.skewness, 1.0 + truth.skewness.abs()),
        ("kurtosis".to_owned(), moments.kurtosis().unwrap(), truth.kurtosis, truth.kurtosis),
    ];
    let place = |name: &str| name[1..].parse::<usize>().unwrap();
    for row in &found.sensitivities {
        let j = place(&row.dimension);
        let mut add = |name: &str, value: Option<f64>, truth: f64| {
            if let Some(value) = value {
                figures.push((format!("{name} of x{j}"), value, truth, 1.0));
            }
        };
        add("linear share", row.linear_share, truth.linear[j]);
        add("curvature share", row.curvature_share, truth.first[j] - truth.linear[j]);
        add("first order", row.first_order.map(|of| of.value), truth.first[j]);
        add("total", row.total.map(|of| of.value), truth.total[j]);
    }
    let mut listed = BTreeMap::new();
    for pair in found.contributions.interactions.iter() {
        let [j, k] = pair.dimensions.map(place);
        assert_ne!(pair.origin, Some(DerivativeOrigin::Screened), "an estimate in a proof");
        listed.insert((j.min(k), j.max(k)), pair.share.unwrap());
    }
    for (&(j, k), &share) in &truth.pairs {
        let value = listed.get(&(j, k)).copied().unwrap_or(0.0);
        figures.push((format!("share of x{j} and x{k}"), value, share, 1.0));
    }
    let off = |(_, value, truth, scale): &&(String, f64, f64, f64)| {
        let apart = (value - truth).abs();
        apart.is_nan() || apart > SAME * scale
    };
    figures.iter().find(off).map(|(name, value, truth, _)| format!("{name}: {value:e} for {truth:e}"))
}

fn is_exact(found: &CharacteristicAnalysis) -> bool {
    found.evidence.verification.as_ref().is_some_and(|of| matches!(of.kind, VerificationKind::Exact))
}

/// Budget of the analyses. It allows a dozen check points and no sample, because figures that are not proven need no accuracy here.
const BUDGET: usize = 700;

#[test]
fn whatever_is_called_exact_is_exact() {
    let kinds = [Kind::Sparse, Kind::Dense, Kind::Surface];
    let sizes = |degree: usize, kind: Kind| match (degree, kind) {
        (1, _) => vec![2, 12],
        (2, Kind::Dense) => vec![2, 4, 7],
        (2, _) => vec![2, 5, 12],
        (3, Kind::Dense) => vec![2, 3],
        (4, Kind::Dense) => vec![2],
        _ => vec![2, 6],
    };
    let mut cases = Vec::new();
    for degree in 1..=4 {
        for kind in kinds {
            for n in sizes(degree, kind) {
                let seed = (1000 * degree + 10 * n) as u64 + kind as u64;
                cases.push((degree, n, kind, seed));
            }
        }
    }
    // Sources of derivatives beside the usual one, for a method of each kind.
    let sources = |method: Method| match method {
        Method::Auto | Method::Full => vec![None, Some(DerivativeSource::Difference), Some(DerivativeSource::Exact)],
        Method::ResponseSurface | Method::SixN => vec![None, Some(DerivativeSource::Difference)],
        _ => vec![None],
    };
    let of = |&(degree, n, kind, seed): &(usize, usize, Kind, u64)| {
        let case = Case::random(seed, n, degree, kind);
        let truth = case.expansion.figures();
        let (mut called, mut faults) = (Vec::new(), Vec::new());
        for method in ALL.iter().map(|procedure| procedure.method()) {
            for source in sources(method) {
                let mut options = Options::from(method).with_budget(BUDGET);
                options.derivatives = source;
                // Fails for a method that needs more points, or has no choice of derivatives.
                let Ok(found) = analyze(&case.study.problem, &options) else { continue };
                let found = &found.characteristics[0];
                if !is_exact(found) {
                    continue;
                }
                called.push((method, source));
                if let Some(figure) = wrong(found, &truth) {
                    faults.push(format!("{} {source:?}, seed {seed}: {figure}\n{}", method.name(), case.text));
                }
            }
        }
        (case, called, faults)
    };
    let found: Vec<_> = cases.par_iter().map(of).collect();
    let faults: Vec<&String> = found.iter().flat_map(|(_, _, faults)| faults).collect();
    assert!(faults.is_empty(), "{} figures are not exact: {faults:#?}", faults.len());
    // A formula that a surface can hold is exact by default. No method is exact for any other one.
    for (case, called, _) in &found {
        let by_default = called.contains(&(Method::Auto, None));
        assert_eq!(by_default, case.is_surface, "degree {}: {}", case.degree, case.text);
        assert!(case.is_surface || called.is_empty(), "{called:?}: {}", case.text);
        if case.degree == 2 {
            assert!(
                called.contains(&(Method::Full, None)) && called.contains(&(Method::Classic, None)),
                "{}",
                case.text
            );
        }
    }
}

/// The default method is exact for all of a hundred and fifty random quadratics.
#[test]
fn quadratics_are_exact_by_default() {
    let of = |seed: u64| {
        let (n, kind) = (2 + seed as usize % 5, if seed.is_multiple_of(2) { Kind::Sparse } else { Kind::Dense });
        let case = Case::random(seed, n, 2, kind);
        let found = analyze(&case.study.problem, &Options::default()).unwrap().characteristics.remove(0);
        assert!(is_exact(&found), "seed {seed}: {}", case.text);
        wrong(&found, &case.expansion.figures()).map(|figure| format!("seed {seed}: {figure}\n{}", case.text))
    };
    let faults: Vec<String> = (0..150).into_par_iter().filter_map(of).collect();
    assert!(faults.is_empty(), "{} of 150: {faults:#?}", faults.len());
}

fn studied(dimensions: &Value, formula: &str, limits: [Option<f64>; 2]) -> Study {
    let mut characteristic = json!({ "formula": formula });
    for (limit, value) in ["lower", "upper"].into_iter().zip(limits) {
        value.into_iter().for_each(|value| characteristic[limit] = json!(value));
    }
    let study = json!({ "dimensions": dimensions, "characteristics": { "result": characteristic } });
    Study::from_json(&study.to_string(), "study").unwrap_or_else(|error| panic!("{formula}: {error}"))
}

/// Returns the cases of tests/data/proofs.json: name, study and figures.
fn cases() -> Vec<(String, Study, Value)> {
    let of = |case: &Value| {
        let limits = ["lower", "upper"].map(|limit| case[limit].as_f64());
        let study = studied(&case["dimensions"], case["formula"].as_str().unwrap(), limits);
        (case["name"].as_str().unwrap().to_owned(), study, case["figures"].clone())
    };
    data("proofs.json").as_array().unwrap().iter().map(of).collect()
}

/// Screening finds interactions that do not exist. By default the interactions come from the formula, without evaluations.
#[test]
fn quadratics_are_known_from_their_formulas() {
    for (name, study, truth) in cases() {
        let all = analyze(&study.problem, &Options::default()).unwrap();
        let found = &all.characteristics[0];
        assert!(is_exact(found), "{name}: {:?}", found.evidence.verification);
        assert_eq!(found.distribution.yield_source, Some(YieldSource::Proof), "{name}");
        assert_eq!(found.contributions.examined_interactions, found.contributions.possible_interactions, "{name}");
        let moments = found.moments.unwrap();
        let figures = [
            ("sigma", moments.sigma(), 0.0),
            ("skewness", moments.skewness().unwrap(), 1.0),
            ("kurtosis", moments.kurtosis().unwrap(), 1.0),
        ];
        for (figure, value, scale) in figures {
            let expected = truth[figure].as_f64().unwrap();
            assert!(
                (value - expected).abs() <= SAME * (scale + expected.abs()),
                "{name} {figure}: {value} for {expected}"
            );
        }
        assert!(moments.mean().abs() <= SAME * moments.sigma(), "{name}: {}", moments.mean());
        let capability = found.distribution.capability.unwrap();
        let error = found.error_estimate.as_ref().unwrap().yield_.unwrap();
        for (side, value) in [("below", capability.below), ("above", capability.above)] {
            let Some(expected) = truth[side].as_f64() else { continue };
            let off = (value.unwrap() - expected).abs();
            assert!(off <= 3.0 * error + 1e-10 * expected, "{name} {side}: {value:?} for {expected}, ± {error:e}");
        }
        let account = all.account.as_ref().unwrap();
        assert_eq!((account.examined, account.from_formulas), (0, account.possible_interactions), "{name}: {account}");
    }
}

/// An estimate is reported as one, counts as not examined, and proves nothing: for the same functions by differences, and as black boxes.
#[test]
fn an_estimate_stays_an_estimate() {
    let mut screened = 0;
    for (name, study, _) in cases() {
        let by_differences = Options::default().with_derivatives(DerivativeSource::Difference);
        let found = analyze(&study.problem, &by_differences).unwrap().characteristics.remove(0);
        let estimated = |found: &CharacteristicAnalysis| {
            let of = |pair: &sensitol::analysis::Interaction<'_>| pair.origin == Some(DerivativeOrigin::Screened);
            found.contributions.interactions.iter().filter(of).count()
        };
        if estimated(&found) == 0 {
            continue;
        }
        screened += 1;
        assert!(!is_exact(&found) && found.distribution.yield_source != Some(YieldSource::Proof), "{name}");
        let examined = found.contributions.interactions.len() - estimated(&found);
        assert!(
            found.contributions.examined_interactions <= examined,
            "{name}: {}",
            found.contributions.examined_interactions
        );
        assert!(found.contributions.examined_interactions < found.contributions.possible_interactions, "{name}");
    }
    assert!(screened > 0, "no case is screened any more");
}

/// The error includes the rounding of coefficients that cancel: `x^2 + y` as the remainder of numbers near a million.
#[test]
fn rounding_of_coefficients_is_in_the_error() {
    let dimensions = json!({ "x": { "nominal": 0.0, "sigma": 1.0 }, "y": { "nominal": 0.0, "sigma": 1.0 } });
    for (formula, mean) in [
        ("(x + 1000.1)^2 - 2000.2*x - 1000200.01 + y", 1.0),
        ("(x + 1000.1)*(x - 1000.1) + y + 1000200.01", 1.0),
        ("(100.1*x + y/0.3)^2 - 10020.01*x^2 - 200.2/0.3*x*y - y^2/0.09 + x^2 + y", 1.0),
    ] {
        let study = studied(&dimensions, formula, [None; 2]);
        for method in [Method::Auto, Method::Full, Method::Classic, Method::ResponseSurface] {
            let found = analyze(&study.problem, &method.into()).unwrap().characteristics.remove(0);
            assert!(is_exact(&found), "{} {formula}", method.name());
            let (moments, estimate) = (found.moments.unwrap(), found.error_estimate.unwrap());
            // The variance is 2 for the square, plus 1.
            let off = [(moments.mean() - mean).abs(), (moments.sigma() - 3f64.sqrt()).abs()];
            let errors = [estimate.mean.unwrap(), estimate.sigma.unwrap()];
            for (off, error) in off.into_iter().zip(errors) {
                assert!(off <= error && error < 1e-7, "{} {formula}: {off:e} ± {error:e}", method.name());
            }
        }
    }
}

/// A budget below the cost of the default sample gives a smaller sample, whose error grows with the root of the ratio.
#[test]
fn a_budget_makes_the_sample_of_a_formula_smaller() {
    let dimensions = json!({
        "a": { "nominal": 1.0, "tolerance": 0.3 },
        "b": { "nominal": 2.0, "tolerance": 0.3 },
        "c": { "nominal": 3.0, "tolerance": 0.4 },
    });
    let study = studied(&dimensions, "exp(a)*sin(b*c) + a*b*c", [Some(0.0), None]);
    let error = |budget: Option<usize>| {
        let options = budget.map_or(Options::default(), |budget| Options::default().with_budget(budget));
        let found = analyze(&study.problem, &options).unwrap().characteristics.remove(0);
        let verified = found.evidence.verification.unwrap();
        assert_eq!(verified.kind, VerificationKind::Sample, "{budget:?}");
        assert!(budget.is_none_or(|budget| verified.points < budget), "{budget:?}: {}", verified.points);
        found.error_estimate.unwrap().sigma.unwrap()
    };
    let whole = error(None);
    for (budget, part) in [(60_000, 1.0), (40_000, 2.0), (20_000, 4.0), (15_000, 8.0)] {
        // Errors fall with the root of the points in the core, and so few randomisations measure them to a quarter.
        let found = error(Some(budget));
        assert!(found <= 3.0 * f64::sqrt(part) * whole, "{budget}: {found} for {whole}");
    }
}
