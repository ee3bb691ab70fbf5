//! Distributions at extreme parameters, compared with 150-digit results, and limits in which one kind becomes another.

use std::sync::Arc;

use proptest::prelude::*;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_numeric::distribution::{
    Beta, CurvilinearTrapezoid, Distribution, DistributionError, Exponential, Gamma, Jacobi, Lognormal, Mixture,
    Normal, Part, Rayleigh, SolidAxis, SolidCoordinate, StandardMoments, Student, Trapezoidal, Triangular,
    TruncatedNormal, UShaped, Uniform, Weibull,
};
use sensitol_testing::{close, data, fields, relative};

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn built(kind: &str, p: &[f64]) -> Result<Arc<dyn Distribution>, DistributionError> {
    Ok(match kind {
        "triangular" => Arc::new(Triangular::about(p[0], p[1], p[2])?),
        "trapezoidal" => Arc::new(Trapezoidal::about(p[0], p[1], p[2])?),
        "truncated-normal" => Arc::new(TruncatedNormal::about(p[0], p[1], p[2], p[3])?),
        "beta" => Arc::new(Beta::about(p[0], p[1], p[2], p[3])?),
        "u-shaped" => Arc::new(UShaped::new(p[0] - p[1], p[0] + p[1])?),
        "octahedron" => Arc::new(SolidCoordinate::about(SolidAxis::Octahedron, p[0], p[1])?),
        "bicone" => Arc::new(SolidCoordinate::about(SolidAxis::Bicone, p[0], p[1])?),
        "curvilinear-trapezoid" => Arc::new(CurvilinearTrapezoid::new(p[0] - p[1], p[0] + p[1], p[2])?),
        "student" => Arc::new(Student::new(p[0], p[1], p[2])?),
        "gamma" => Arc::new(Gamma::new(p[0], p[1], p[2])?),
        "lognormal" => Arc::new(Lognormal::new(p[0], p[1], p[2])?),
        "weibull" => Arc::new(Weibull::new(p[0], p[1], p[2])?),
        "exponential" => Arc::new(Exponential::new(p[0], p[1])?),
        "rayleigh" => Arc::new(Rayleigh::new(p[0], p[1])?),
        other => panic!("{other}"),
    })
}

/// Moments relative to their own size, odd ones relative to a skewness. Closed forms keep the digits of an excess of 1e-8. Moments that are
/// sums lose digits relative to 1 only.
#[test]
fn moments_and_recurrences_at_the_extremes() {
    for case in data("distributions.json").as_array().unwrap() {
        let (kind, parameters) = (case["kind"].as_str().unwrap(), numbers(&case["parameters"]));
        let about = |what: &str| format!("{kind} {parameters:?}: {what}");
        let distribution = built(kind, &parameters).unwrap();
        close(distribution.mean(), case["mean"].as_f64().unwrap(), 1e-14, distribution.sigma());
        relative(distribution.sigma(), case["sigma"].as_f64().unwrap(), 2e-13);
        let [m3, excess, m5, m6, m7, m8]: [f64; 6] = numbers(&case["moments"]).try_into().unwrap();
        let h = numbers(&case["h"]);
        let found = fields(distribution.standard_moments());
        let expected = [m3, excess, m5, m6, m7, m8, h[0], h[1], h[2]];
        let sums = matches!(kind, "truncated-normal" | "weibull" | "rayleigh");
        let scales = if sums {
            [1.0, 1.0, m6, m6, m8, m8, m6, m8, m8]
        } else {
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, m6, m8 * m3.abs().min(1.0), m8]
        };
        for (i, ((found, expected), scale)) in found.into_iter().zip(expected).zip(scales).enumerate() {
            let error = (found - expected).abs() / expected.abs().max(scale).max(1e-90);
            assert!(error <= 2e-12, "{}: {found} for {expected}, {error:e}", about(&format!("moment {i}")));
        }
        let jacobi = distribution.jacobi(9);
        let expected = Jacobi::new(numbers(&case["alpha"]), numbers(&case["beta"]));
        for (found, expected) in jacobi.gauss().nodes.iter().zip(expected.gauss().nodes) {
            // Eigenvalues are accurate relative to the largest of them.
            let far = jacobi.gauss().nodes[8].abs();
            assert!((found - expected).abs() <= 1e-11 * far.max(1.0), "{}: {found} for {expected}", about("node"));
        }
    }
}

/// Quantiles are accurate to 1e-12 sigma, or to the digits of the value.
#[test]
fn quantiles_at_the_extremes() {
    for case in data("distributions.json").as_array().unwrap() {
        let (kind, parameters) = (case["kind"].as_str().unwrap(), numbers(&case["parameters"]));
        let distribution = built(kind, &parameters).unwrap();
        let (law, mean, sigma) = (distribution.probability().unwrap(), distribution.mean(), distribution.sigma());
        for quantile in case["quantiles"].as_array().into_iter().flatten() {
            let (p, upper, u) =
                (quantile[0].as_f64().unwrap(), quantile[1].as_bool().unwrap(), quantile[2].as_f64().unwrap());
            let x = if upper { law.upper_quantile(p) } else { law.quantile(p) };
            let allowed = 1e-12 * u.abs().max(1.0) + 2.0 * f64::EPSILON * x.abs().max(mean.abs()) / sigma;
            let found = (x - mean) / sigma;
            assert!((found - u).abs() <= allowed, "{kind} {parameters:?} at {p} {upper}: {found} for {u}");
        }
    }
}

/// Asserts that two distributions agree: moments, and probabilities at every tenth of a sigma.
#[track_caller]
fn same(a: &dyn Distribution, b: &dyn Distribution, tolerance: f64) {
    close(a.mean(), b.mean(), tolerance, a.sigma());
    relative(a.sigma(), b.sigma(), tolerance);
    for (a, b) in fields(a.standard_moments()).into_iter().zip(fields(b.standard_moments())) {
        close(a, b, 10.0 * tolerance, 100.0);
    }
    let (first, second) = (a.probability().unwrap(), b.probability().unwrap());
    for i in -40..=40 {
        let x = a.mean() + 0.1 * f64::from(i) * a.sigma();
        close(first.cdf(x), second.cdf(x), tolerance, 1.0);
        close(first.sf(x), second.sf(x), tolerance, 1.0);
    }
}

#[test]
fn kinds_meet_at_their_limits() {
    let uniform = Uniform::new(-1.0, 3.0).unwrap();
    same(&Beta::new(-1.0, 3.0, 1.0, 1.0).unwrap(), &uniform, 1e-12);
    same(&Trapezoidal::new(-1.0, 3.0, 1.0).unwrap(), &uniform, 1e-13);
    same(&Trapezoidal::new(-1.0, 3.0, 0.0).unwrap(), &Triangular::new(-1.0, 1.0, 3.0).unwrap(), 1e-13);
    same(&Beta::new(-1.0, 3.0, 2.0, 1.0).unwrap(), &Triangular::new(-1.0, 3.0, 3.0).unwrap(), 1e-12);
    // A parent with a sigma of 1e5 half-widths is flat to 1e-10/2.
    same(&TruncatedNormal::new(-1.0, 3.0, 1.0, 2e5).unwrap(), &uniform, 1e-10);
    // The probability beyond nine sigma is 1e-19.
    let normal = Normal::new(1.0, 2.0 / 9.0).unwrap();
    same(&TruncatedNormal::new(-1.0, 3.0, 1.0, 2.0 / 9.0).unwrap(), &normal, 1e-13);
    same(&Weibull::with_shape(0.5, 2.0, 1.0).unwrap(), &Exponential::new(0.5, 2.0).unwrap(), 1e-12);
    same(&Gamma::new(0.5, 2.0, 1.5).unwrap(), &Exponential::new(0.5, 2.0).unwrap(), 1e-12);
    same(
        &Weibull::new(0.5, 2.0, Rayleigh::new(0.5, 2.0).unwrap().sigma()).unwrap(),
        &Rayleigh::new(0.5, 2.0).unwrap(),
        1e-12,
    );
    // Without inexactness it is a rectangle: the variance differs by a fraction of 1e-12, the density at the ends over 1e-6 of the width.
    same(&CurvilinearTrapezoid::new(-1.0, 3.0, 2e-6).unwrap(), &uniform, 1e-6);
    // A million degrees of freedom have an excess kurtosis of 6e-6.
    same(&Student::new(1.0, 0.5, 1e6).unwrap(), &Normal::new(1.0, 0.5).unwrap(), 1e-5);
    // Nearly normal distributions differ from the normal one by their skewness, 2e-6 and 3e-6.
    let normal = Normal::new(1.0, 1e-6).unwrap();
    same(&Gamma::new(0.0, 1.0, 1e-6).unwrap(), &normal, 1e-5);
    same(&Lognormal::new(0.0, 1.0, 1e-6).unwrap(), &normal, 1e-5);
    same(&Beta::new(-1.0, 3.0, 1e9, 1e9).unwrap(), &Normal::new(1.0, 2.0 / (2e9f64 + 1.0).sqrt()).unwrap(), 1e-7);
    // One part, or the same part twice, gives the distribution of the part.
    let part =
        |weight: f64| Part { name: "p".into(), weight, distribution: Arc::new(Gamma::new(0.0, 2.0, 1.0).unwrap()) };
    same(&Mixture::new(vec![part(3.0)]).unwrap(), &Gamma::new(0.0, 2.0, 1.0).unwrap(), 1e-12);
    same(&Mixture::new(vec![part(3.0), part(1.0)]).unwrap(), &Gamma::new(0.0, 2.0, 1.0).unwrap(), 1e-12);
}

/// Two normal machines at a distance of 2 d: kurtosis and cumulants in closed form.
#[test]
fn a_mixture_of_two_normals() {
    for d in [1e-4, 0.3, 5.0] {
        let part =
            |mean: f64| Part { name: "m".into(), weight: 1.0, distribution: Arc::new(Normal::new(mean, 1.0).unwrap()) };
        let mixture = Mixture::new(vec![part(10.0 - d), part(10.0 + d)]).unwrap();
        let v = 1.0 + d * d;
        relative(mixture.sigma(), v.sqrt(), 1e-13);
        // The cumulants of the two values +-d are -2 d^4, 16 d^6 and -272 d^8.
        let cumulants =
            [0.0, -2.0 * d.powi(4) / v.powi(2), 0.0, 16.0 * d.powi(6) / v.powi(3), 0.0, -272.0 * d.powi(8) / v.powi(4)];
        let expected = StandardMoments::from_cumulants(cumulants);
        for (found, expected) in fields(mixture.standard_moments()).into_iter().zip(fields(expected)) {
            // The means are 10 +- d, so d has lost the digits of 10.
            close(found, expected, 1e-12, 1.0);
        }
        // Far out only the nearer machine matters.
        if d > 1.0 {
            relative(mixture.probability().unwrap().sf(10.0 + d + 6.0), 0.5 * 9.865_876_450_376_98e-10, 1e-12);
        }
    }
}

#[test]
fn impossible_shapes_are_refused() {
    let error = |found: Result<Arc<dyn Distribution>, DistributionError>| found.unwrap_err().to_string();
    let lines = [
        error(built("triangular", &[0.0, 1.0, 1.5])),
        error(built("triangular", &[0.0, 0.0, 0.0])),
        error(Triangular::new(0.0, 3.0, 2.0).map(|law| Arc::new(law) as _)),
        error(built("trapezoidal", &[0.0, 1.0, -0.1])),
        error(built("truncated-normal", &[0.0, 1.0, 0.0, 0.0])),
        error(built("truncated-normal", &[0.0, 1.0, 50.0, 1.0])),
        error(built("beta", &[0.0, 1.0, 0.0, 2.0])),
        error(built("beta", &[0.0, 1.0, 2.0, f64::NAN])),
        error(built("u-shaped", &[0.0, 0.0])),
        error(built("curvilinear-trapezoid", &[0.0, 1.0, 0.0])),
        error(built("curvilinear-trapezoid", &[0.0, 1.0, 1.0])),
        error(built("curvilinear-trapezoid", &[0.0, 1.0, f64::NAN])),
        error(built("student", &[0.0, 1.0, 2.0])),
        error(built("student", &[0.0, 1.0, f64::INFINITY])),
        error(built("student", &[0.0, 0.0, 5.0])),
        error(built("gamma", &[0.0, -1.0, 0.1])),
        error(built("gamma", &[0.0, 1.0, 100.0])),
        error(built("gamma", &[0.0, 1.0, -1.0])),
        error(built("lognormal", &[2.0, 2.0, 0.1])),
        error(built("lognormal", &[0.0, 1.0, 1e5])),
        error(built("weibull", &[0.0, 1.0, 1e4])),
        error(Weibull::with_shape(0.0, 1.0, 0.0).map(|law| Arc::new(law) as _)),
        error(built("exponential", &[1.0, 0.5])),
        error(built("rayleigh", &[f64::INFINITY, 0.5])),
        error(Mixture::new(Vec::new()).map(|law| Arc::new(law) as _)),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// A kind with parameters of any size.
fn anything() -> impl Strategy<Value = (&'static str, Vec<f64>)> {
    let logarithmic = |from: f64, to: f64| (from.ln()..to.ln()).prop_map(f64::exp);
    let band = (-10.0..10.0f64, logarithmic(1e-3, 1e3));
    let tail = (-5.0..5.0f64, logarithmic(1e-2, 1e2), logarithmic(1e-3, 5.0));
    prop_oneof![
        (band.clone(), -1.0..=1.0f64).prop_map(|((m, h), lean)| ("triangular", vec![m, h, lean])),
        (band.clone(), 0.0..=1.0f64).prop_map(|((m, h), top)| ("trapezoidal", vec![m, h, top])),
        (band.clone(), -2.0..2.0f64, logarithmic(0.1, 100.0))
            .prop_map(|((m, h), shift, sigma)| ("truncated-normal", vec![m, h, h * shift, h * sigma])),
        (band.clone(), 0.0..1.0f64).prop_map(|((m, h), _)| ("u-shaped", vec![m, h])),
        (band.clone(), prop_oneof![Just("octahedron"), Just("bicone")]).prop_map(|((m, h), kind)| (kind, vec![m, h])),
        (band.clone(), logarithmic(1e-6, 0.999))
            .prop_map(|((m, h), part)| ("curvilinear-trapezoid", vec![m, h, part * h])),
        // A mixture needs eight moments.
        (band.clone(), logarithmic(8.5, 1e6)).prop_map(|((m, h), degrees)| ("student", vec![m, h, degrees])),
        (band, logarithmic(0.02, 1e6), logarithmic(0.02, 1e6)).prop_map(|((m, h), a, b)| ("beta", vec![m, h, a, b])),
        (tail.clone(), prop_oneof![Just("gamma"), Just("lognormal"), Just("weibull")])
            .prop_map(|((o, d, ratio), kind)| (kind, vec![o, o + d, d * ratio])),
        (tail, prop_oneof![Just("exponential"), Just("rayleigh")]).prop_map(|((o, d, _), kind)| (kind, vec![o, o + d])),
    ]
}

proptest! {
    /// Properties of all distributions: no NaN, possible moments, probabilities that rise and sum to 1, quantiles and samples inside the
    /// support, and a rule with mean 0 and variance 1.
    #[test]
    fn every_distribution_is_one(law in anything(), other in anything(), weight in 0.01..1.0f64) {
        let [law, other] = [law, other].map(|(kind, parameters)| built(kind, &parameters).unwrap());
        let part = |weight: f64, distribution: &Arc<dyn Distribution>| {
            Part { name: "p".into(), weight, distribution: Arc::clone(distribution) }
        };
        let mixture = Arc::new(Mixture::new(vec![part(weight, &law), part(1.0 - 0.9 * weight, &other)]).unwrap());
        for law in [law, mixture] {
            let (mean, sigma, [lower, upper]) = (law.mean(), law.sigma(), law.support());
            let moments = law.standard_moments();
            prop_assert!(mean > lower && mean < upper && sigma > 0.0);
            prop_assert!(fields(moments).iter().all(|moment| moment.is_finite()));
            prop_assert!(moments.excess + 2.0 >= moments.skewness.powi(2) * (1.0 - 1e-12) - 1e-12);
            let rule = law.jacobi(5).gauss();
            prop_assert!(rule.mean(|u| u).abs() < 1e-10 && (rule.mean(|u| u * u) - 1.0).abs() < 1e-9);
            let whole = law.probability().unwrap();
            let mut last = 0.0;
            for i in -60..=60 {
                let x = mean + 0.1 * f64::from(i) * sigma;
                let (below, above) = (whole.cdf(x), whole.sf(x));
                prop_assert!((0.0..=1.0).contains(&below) && (0.0..=1.0).contains(&above), "{below} {above}");
                prop_assert!((below + above - 1.0).abs() < 1e-12 && below >= last - 1e-13, "{below} {last} {above}");
                prop_assert!(whole.density(x).unwrap() >= 0.0);
                last = below;
            }
            for p in [1e-12, 1e-3, 0.4, 0.9, 1.0 - 1e-9] {
                for x in [whole.quantile(p), whole.upper_quantile(p)] {
                    prop_assert!(x >= lower && x <= upper, "{x} at {p}");
                }
                // If the last digit of x changes the probability by more, p lies between the values of the neighbours. The digits of x are
                // those of the band that it was computed from.
                let band = [mean, lower, upper].map(f64::abs).into_iter().filter(|end| end.is_finite()).fold(sigma, f64::max);
                let (x, step) = (whole.quantile(p), 8.0 * f64::EPSILON * band);
                let (low, high) = (whole.cdf(x - step), whole.cdf(x + step));
                prop_assert!(low <= p + 1e-11 && high >= p - 1e-11, "{low} {high} for {p} at {x}");
            }
            let mut sample = [0.0; 20];
            whole.fill(&mut Xoshiro256PlusPlus::seed_from_u64(1), &mut sample);
            prop_assert!(sample.iter().all(|x| *x >= lower && *x <= upper), "{sample:?}");
        }
    }
}
