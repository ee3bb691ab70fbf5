//! `auto`: counts, budgets, determinism, warnings, and extreme cases.

use std::collections::HashMap;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use sensitol::analysis::{YieldSource, analyze_with};
use sensitol::assembly::{EvaluationError, Run};
use sensitol::distribution::Exponential;

use sensitol::method::Accuracies;
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{
    Analysis, Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits, StopReason, analyze,
};
use sensitol_study::Study;
use sensitol_testing::{Asked, close, counted, normals, refusing, relative, repository, standard};

/// Options for the refinement and the sample that replaces an untrusted surface, without the verification, which takes points of its own.
fn auto(accuracy: f64) -> Options {
    Options::from(Method::Auto).with_accuracy(accuracy).with_verify(0)
}

fn of(dimensions: Vec<Dimension>, f: impl Fn(&[f64]) -> f64 + Send + Sync + 'static, options: &Options) -> Analysis {
    let options = options.clone().with_verify(0);
    analyze(&Problem::new(dimensions, Closure::scalar("y", f)).unwrap(), &options).unwrap()
}

fn codes(analysis: &Analysis) -> Vec<&'static str> {
    let mut codes: Vec<&'static str> = analysis.warnings.iter().map(|warning| warning.code()).collect();
    codes.sort_unstable();
    codes.dedup();
    codes
}

fn sigma(analysis: &Analysis) -> f64 {
    analysis.characteristics[0].moments.unwrap().sigma()
}

fn estimate(analysis: &Analysis) -> f64 {
    analysis.characteristics[0].error_estimate.as_ref().unwrap().sigma.unwrap()
}

/// Every point is evaluated once. A linear study ends within 2N + 1 + 24 evaluations, and none of them varies a fixed dimension.
#[test]
fn what_is_linear_is_soon_known() {
    for n in [1, 2, 3, 7, 25] {
        let asked = Asked::default();
        let mut dimensions = standard(n);
        dimensions.push(Dimension::fixed("still", 3.0).unwrap());
        let problem = Problem::new(dimensions, asked.watching(|x| x.iter().sum())).unwrap();
        let analysis = analyze(&problem, &auto(0.001)).unwrap();
        assert_eq!(analysis.run.evaluations, asked.distinct() as u64);
        assert_eq!(analysis.run.evaluations, 2 * n as u64 + 1 + 16);
        relative(sigma(&analysis), (n as f64).sqrt(), 1e-13);
        assert_eq!(analysis.characteristics[0].contributions.left_out_share, Some(0.0));
        assert!(codes(&analysis).is_empty(), "{:?}", codes(&analysis));
        assert!(estimate(&analysis) < 1e-12);
    }
}

/// The seed changes samples only, and nothing if a surface is enough. The number of threads changes nothing.
#[test]
fn the_same_study_gives_the_same_numbers() {
    let f = |x: &[f64]| (0.3 * x[0]).exp() * (1.0 + 0.2 * x[1]) + x[2] * x[2] * 0.1 + x[3] - x[4] * x[0] * 0.05;
    let one = of(standard(5), f, &auto(0.05));
    let other = of(standard(5), f, &auto(0.05).with_seed(99));
    assert!(one.characteristics[0].evidence.model_sampled.is_none());
    assert_eq!(one.characteristics, other.characteristics);
    assert_eq!(one.run.evaluations, other.run.evaluations);
    let fine = of(standard(5), f, &auto(0.001));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = pool.install(|| of(standard(5), f, &auto(0.001)));
    assert_eq!(fine.characteristics, alone.characteristics);
}

/// Other accuracies are reached too. `y = a + b + c + d + ab/10` of standard normals has the variance 4.01, the third central moment 3
/// (2/10) and the fourth cumulant 12 (2/100) + 3 (2/10^4).
///
/// These are 3 b'Hb + tr H^3 and 12 b'H^2 b + 3 tr H^4 of a quadratic form with H = [[0, 1/10], [1/10, 0]] and b = (1, 1). One percent of
/// sigma is reached without the interaction, but a skewness is not.
#[test]
fn other_accuracies_are_reached_too() {
    let f = |x: &[f64]| x[0] + x[1] + x[2] + x[3] + 0.1 * x[0] * x[1];
    let variance: f64 = 4.01;
    let skewness = 3.0 * 0.2 / variance.powf(1.5);
    let kurtosis = 3.0 + (12.0 * 0.02 + 3.0 * 2e-4) / variance.powi(2);
    let of_sigma = of(standard(4), f, &auto(0.05));
    let found = |analysis: &Analysis| analysis.characteristics[0].moments.unwrap();
    assert!((found(&of_sigma).skewness().unwrap() - skewness).abs() > 0.05);
    for accuracies in [Accuracies::default().with_skewness(0.01), Accuracies::default().with_kurtosis(0.01)] {
        let options = auto(0.05).with_accuracies(accuracies);
        let analysis = of(standard(4), f, &options);
        assert!(analysis.run.evaluations > of_sigma.run.evaluations);
        // A quadratic is exact once its interaction is known.
        relative(found(&analysis).skewness().unwrap(), skewness, 1e-9);
        relative(found(&analysis).kurtosis().unwrap(), kurtosis, 1e-9);
        assert!(codes(&analysis).is_empty(), "{:?}", analysis.warnings);
        // Too few evaluations for an accuracy cause a warning with the figure's name.
        let short = of(standard(4), f, &options.with_budget(of_sigma.run.evaluations as usize));
        let said = short.warnings.iter().find(|warning| warning.code() == "under-resolved").unwrap().message();
        let name = if accuracies.skewness.is_some() { "skewness" } else { "kurtosis" };
        let begins = format!("The estimated error of the {name} of `y` is ");
        assert!(said.starts_with(&begins) && said.contains("The budget was spent"), "{said}");
    }
}

/// A yield reaches the wanted accuracy. Two standard errors of a sample are enough if derivatives are not. A characteristic without limits
/// has no such accuracy.
#[test]
fn a_yield_is_known_as_well_as_wanted() {
    let accuracies = Accuracies::default().with_yield(1e-3);
    let options = auto(0.05).with_accuracies(accuracies);
    let f = |x: &[f64]| x[0] + x[1] + x[2] + x[3] + 0.1 * x[0] * x[1];
    let limited = Characteristic::new("y").with_limits(SpecLimits::new(None, Some(4.0)).unwrap());
    let problem = Problem::new(standard(4), Closure::scalar("y", f)).unwrap().asking([limited]).unwrap();
    let analysis = analyze(&problem, &options).unwrap();
    let one = &analysis.characteristics[0];
    assert!(one.error_estimate.as_ref().unwrap().yield_.unwrap() <= 1e-3);
    // For every a, the sum a + b (1 + a/10) + c + d <= 4 is normal. The trapezoidal rule over a converges faster than any power here.
    let normal = |z: f64| 0.5 * libm::erfc(-z / 2f64.sqrt());
    let share: f64 = (-900..=900)
        .map(|i| f64::from(i) * 0.01)
        .map(|a| {
            (-0.5 * a * a).exp() / (2.0 * std::f64::consts::PI).sqrt()
                * normal((4.0 - a) / (1.0 + 0.1 * a).hypot(2f64.sqrt()))
                * 0.01
        })
        .sum();
    assert!((one.distribution.capability.unwrap().yield_().unwrap() - share).abs() < 1e-3);
    let without = of(standard(4), f, &options);
    assert_eq!(without.run.evaluations, of(standard(4), f, &auto(0.05)).run.evaluations);
}

/// For a uniform dimension beside a normal one, the four moments are right, but the tail of the Pearson fit is not. The share is the mean
/// of normal ones over the uniform dimension, by midpoints.
#[test]
fn tails_that_the_law_misses_are_told_of() {
    let dimensions = || vec![Dimension::normal("a", 0.0, 0.1).unwrap(), Dimension::uniform("b", 0.0, 0.06).unwrap()];
    let of = |lower: f64| {
        let limited = Characteristic::new("y").with_limits(SpecLimits::new(Some(lower), None).unwrap());
        let y = Closure::scalar("y", |x| x[0] - 2.0 * x[1]);
        let problem = Problem::new(dimensions(), y).unwrap().asking([limited]).unwrap();
        analyze(&problem, &Options::from(Method::Auto).with_verify(12)).unwrap()
    };
    let normal = |z: f64| 0.5 * libm::erfc(-z / 2f64.sqrt());
    let below = |lower: f64| {
        let at = |i: u32| -0.06 + 0.12 * (f64::from(i) + 0.5) / 20_000.0;
        (0..20_000).map(|i| normal((lower + 2.0 * at(i)) / (0.1 / 3.0))).sum::<f64>() / 20_000.0
    };
    for (lower, most) in [(-0.175, 0.7), (-0.2, 0.2)] {
        let found = of(lower);
        let (one, exact) = (&found.characteristics[0], below(lower));
        let (fit, rejected) = (
            one.evidence.pearson.unwrap().rejected().unwrap(),
            one.distribution.capability.unwrap().rejected().unwrap(),
        );
        assert!(fit < most * exact, "{fit} {exact}");
        assert_eq!(codes(&found), ["pearson-differs"]);
        // The surface is the model: their difference is 0 at every point. Midpoints 0.36 sigma/1000 apart cause an error of 3e-8 of the
        // share.
        assert!((rejected - exact).abs() < 1e-6 * exact, "{rejected} {exact}");
        // No point disagrees, so that the error is the weight of one of 32 768 points.
        let error = one.error_estimate.as_ref().unwrap().yield_.unwrap();
        assert!(error < 1.1 / 32_768.0, "{error}");
        assert_eq!(one.distribution.yield_source, Some(YieldSource::Samples));
    }
    // In the middle of the distribution the two are near each other, but still differ by more than the error.
    let found = of(-0.05);
    let one = &found.characteristics[0];
    let (fit, rejected) =
        (one.evidence.pearson.unwrap().rejected().unwrap(), one.distribution.capability.unwrap().rejected().unwrap());
    assert!((fit / rejected - 1.0).abs() < 0.1 && (rejected / below(-0.05) - 1.0).abs() < 1e-6, "{fit} {rejected}");
}

/// A verdict is met or missed, and inconclusive only if points have no value.
#[test]
fn verdicts_that_are_in_doubt_are_not_given() {
    let verdict = |f: fn(&[f64]) -> f64, lower: f64, target: f64, method: Method| {
        let dimensions = vec![Dimension::normal("a", 0.0, 0.1).unwrap(), Dimension::uniform("b", 0.0, 0.06).unwrap()];
        let limited = Characteristic::new("y").with_limits(SpecLimits::new(Some(lower), None).unwrap());
        let limited = limited.with_target_yield(target).unwrap();
        let problem = Problem::new(dimensions, Closure::scalar("y", f)).unwrap().asking([limited]).unwrap();
        analyze(&problem, &method.into()).unwrap().characteristics[0].met()
    };
    // 0.287 % lie below -0.175. The Pearson fit gives less than 0.2 % (see the test above).
    let straight = |x: &[f64]| x[0] - 2.0 * x[1];
    for (target, met) in [(0.99, Some(true)), (0.998, Some(false)), (0.9999, Some(false))] {
        assert_eq!(verdict(straight, -0.175, target, Method::Auto), met, "{target}");
    }
    assert_eq!(verdict(straight, -0.05, 0.9999, Method::Auto), Some(false), "a fifth is rejected by both");
    // A quarter of all assemblies has no value, because b is below -0.03. The yield of the others is not that of all.
    let failing = |x: &[f64]| if x[1] < -0.03 { f64::NAN } else { x[0] - 2.0 * x[1] };
    assert_eq!(verdict(failing, -0.5, 0.95, Method::Full), None);
    assert_eq!(verdict(failing, 0.5, 0.95, Method::Full), Some(false), "missed all the same");
    assert_eq!(verdict(straight, -0.5, 0.95, Method::Full), Some(true));
}

#[test]
fn accuracies_are_positive() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let accuracies = Accuracies::default().with_yield(bad);
        let problem = Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap();
        let error = analyze(&problem, &auto(0.05).with_accuracies(accuracies)).unwrap_err().to_string();
        assert!(
            error.starts_with("the accuracy of the yield is the share that it may be off, a number above 0"),
            "{error}"
        );
    }
}

/// Reported steps are the points of evaluation in the dimension's unit: the matched nodes of a normal distribution, or the points with a
/// value.
#[test]
fn realised_steps_are_reported() {
    let dimensions = vec![Dimension::normal("a", 10.0, 0.3).unwrap(), Dimension::normal("b", 0.0, 3.0).unwrap()];
    let edge = |x: &[f64]| if x[1] > 1.0 { f64::NAN } else { x[0] + (1.2 - x[1]).sqrt() };
    let analysis = of(dimensions, edge, &Method::SecondOrder.into());
    let [a, b] = [0, 1].map(|d| &analysis.characteristics[0].sensitivities[d].steps);
    let root = 0.1 * 3f64.sqrt();
    assert!((a[0] + root).abs() < 1e-12 && (a[1] - root).abs() < 1e-12, "{a:?}");
    assert!((b[0] + 3f64.sqrt()).abs() < 1e-12 && b[1] > 0.0 && b[1] <= 1.0, "{b:?}");
}

/// A budget is kept, and a warning names the omitted evaluations.
#[test]
fn a_budget_is_kept() {
    let f = |x: &[f64]| (0..9).map(|j| x[j] + 0.3 * x[j] * x[j + 1]).sum::<f64>() + x[9];
    let mut errors = Vec::new();
    for budget in [21, 25, 40, 60, 90, 200] {
        let asked = Asked::default();
        let problem = Problem::new(standard(10), asked.watching(f)).unwrap();
        let analysis = analyze(&problem, &auto(0.001).with_budget(budget)).unwrap();
        assert_eq!(analysis.run.evaluations, asked.distinct() as u64);
        assert!(analysis.run.evaluations <= budget as u64, "{} of {budget}", analysis.run.evaluations);
        let exact = (10.0 + 9.0 * 0.09f64).sqrt();
        errors.push((sigma(&analysis) / exact - 1.0).abs());
        if budget == 60 {
            assert!(codes(&analysis).contains(&"under-resolved"), "{:?}", codes(&analysis));
        }
    }
    assert!(errors[5] < 1e-12, "{errors:?}");
    // Without check points nothing is known of interactions: the error of the variance is their variance.
    relative(errors[0], 1.0 - (10.0f64 / 10.81).sqrt(), 1e-6);
    let too_few = analyze(&Problem::new(standard(10), Closure::scalar("y", f)).unwrap(), &auto(0.1).with_budget(20));
    assert!(too_few.unwrap_err().to_string().contains("needs 21 evaluations, more than the budget of 20"));
}

/// All characteristics share every point, and a linear one is not affected by the others.
#[test]
fn characteristics_share_points() {
    let function = Closure::fallible(["line", "product"], |x: &[f64]| {
        Ok::<[f64; 2], EvaluationError>([x[0] + 2.0 * x[1] + x[2], x[0] + x[0] * x[1] + 0.5 * x[2]])
    });
    let analysis = analyze(&Problem::new(standard(3), function).unwrap(), &auto(0.001)).unwrap();
    relative(analysis.characteristics[0].moments.unwrap().sigma(), 6f64.sqrt(), 1e-12);
    relative(analysis.characteristics[1].moments.unwrap().sigma(), (1.0 + 1.0 + 0.25f64).sqrt(), 1e-12);
}

/// Answers scatter by 1e-6 to 1e-2 of sigma, as a function of the point. The scatter is noticed, and sigma is off by no more than it
/// causes.
#[test]
fn scatter_is_noticed_and_spoils_no_more_than_it_must() {
    let scatter = |x: &[f64]| {
        let mut hash = 0u64;
        for value in x {
            hash = (hash ^ value.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 29;
        }
        // Uniform over ±sqrt 3: sigma 1.
        ((hash >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0) * 3f64.sqrt()
    };
    for noise in [1e-6, 1e-4, 1e-3, 1e-2] {
        let f = move |x: &[f64]| x.iter().sum::<f64>() + 0.2 * x[0] * x[1] + 8f64.sqrt() * noise * scatter(x);
        let analysis = of(standard(8), f, &auto(0.01));
        let exact = (8.0 + 0.04 + 8.0 * noise * noise).sqrt();
        let error = (sigma(&analysis) / exact - 1.0).abs();
        assert!(error <= 0.01 && error <= 3.0 * estimate(&analysis) / exact, "{noise}: {error}");
        // In between, the result depends on the two points that measure the scatter.
        if !(1e-5..5e-4).contains(&noise) {
            assert_eq!(codes(&analysis).contains(&"scatter"), noise > 5e-4, "{noise}: {:?}", codes(&analysis));
        }
    }
}

/// The sample that replaces a surface depends on the given seed: another seed gives other figures, the same one the same.
#[test]
fn the_seed_reaches_points_that_stand_in_for_a_surface() {
    let f = |x: &[f64]| (x[0] - x[1]).min(x[2] - x[3]);
    let with = |seed: u64| of(standard(4), f, &auto(0.05).with_seed(seed));
    let (one, other, again) = (with(1), with(2), with(1));
    assert!(one.characteristics[0].evidence.model_sampled.is_some());
    assert_ne!(sigma(&one), sigma(&other));
    assert_eq!(one.characteristics, again.characteristics);
}

/// The model is the smaller of two equal gaps. The kink is named, the model is sampled, and a long simulation agrees.
#[test]
fn a_kink_is_named_and_sampled() {
    let f = |x: &[f64]| (x[0] - x[1]).min(x[2] - x[3]);
    let problem = || Problem::new(normals(&[10.0, 9.0, 12.0, 11.0], &[0.15; 4]), Closure::scalar("gap", f)).unwrap();
    let analysis = analyze(&problem(), &auto(0.01)).unwrap();
    let found = codes(&analysis);
    assert!(found.contains(&"kink") && found.contains(&"untrusted-surrogate"), "{found:?}");
    let one = &analysis.characteristics[0];
    let sampled = one.evidence.model_sampled.as_ref().expect("the model was sampled");
    let reference = simulate(&problem(), &SimulationOptions::default().with_samples(400_000)).unwrap();
    let truth = reference.characteristics[0].sigma.unwrap();
    let error = sampled.standard_errors[1].unwrap().hypot(truth.standard_error.unwrap());
    // The tolerance of four standard errors is exceeded once in ten thousand cases.
    assert!((sigma(&analysis) - truth.value).abs() < 4.0 * error);
}

/// Symmetric points do not distinguish a kink at the mean from curvature, or a jump from a slope. Both are found nevertheless.
#[test]
fn kinks_and_jumps_are_told_from_curves() {
    let kink = of(standard(2), |x| x[0].abs() + x[1], &auto(0.01));
    assert!(codes(&kink).contains(&"kink"), "{:?}", codes(&kink));
    let jump = of(standard(2), |x| x[0] + if x[0] > 0.5 { 3.0 } else { 0.0 } + x[1], &Method::SixN.into());
    assert!(codes(&jump).contains(&"discontinuity"), "{:?}", codes(&jump));
    let smooth = of(standard(2), |x| (0.3 * x[0]).exp() + x[1], &auto(0.001));
    assert!(!codes(&smooth).contains(&"kink"), "{:?}", codes(&smooth));
}

/// An arc cosine and a root whose domain ends within two sigma cause warnings, and no panic.
#[test]
fn domain_edges_are_not_passed_in_silence() {
    let edge = |x: &[f64]| x[0] + x[1] > 2.0;
    let root = refusing(|x| (2.0 - x[0] - x[1]).max(0.0).sqrt() + x[2], edge);
    let analysis = analyze(&Problem::new(standard(3), root).unwrap(), &auto(0.01)).unwrap();
    let found = codes(&analysis);
    assert!(found.contains(&"domain-edge") || found.contains(&"failed-points"), "{found:?}");
    assert!(analysis.run.failed > 0);
    // If the edge lies beyond every axis point, only points that move several dimensions cross it.
    let far = refusing(|x| x.iter().sum(), |x| x.iter().map(|x| x * x).sum::<f64>() > 8.0);
    let analysis = analyze(&Problem::new(standard(6), far).unwrap(), &auto(0.01)).unwrap();
    assert!(codes(&analysis).contains(&"domain-edge-within"), "{:?}", codes(&analysis));
}

/// Results do not depend on scales: dimensions from 1e-12 to 1e12, a nominal value of 1e10 sigma, and one dominant dimension.
#[test]
fn scales_do_not_matter() {
    let scales = [1e-12, 1e-6, 1.0, 1e6, 1e12];
    let dimensions = normals(&scales.map(|scale| 3.0 * scale), &scales.map(|scale| 0.3 * scale));
    let f = move |x: &[f64]| {
        let v: Vec<f64> = x.iter().zip(scales).map(|(x, scale)| x / scale).collect();
        v[0] * v[1] + v[2] + v[3] * v[4]
    };
    let analysis = of(dimensions, f, &auto(0.001));
    let pair = 2.0 * 9.0 * 0.01 + 1e-4;
    relative(sigma(&analysis), (2.0 * pair + 0.01f64).sqrt(), 1e-4);
    let far = of(normals(&[1e10, 5.0], &[3.0, 3.0]), |x| (x[0] - 1e10) + x[1] * x[1], &auto(0.01));
    // Sigma of u + (5 + v)^2 - 25: 1 + 100 + 2.
    relative(sigma(&far), 103f64.sqrt(), 1e-6);
    let dominated = of(standard(4), |x| 1e6 * x[0] + (x[1] * x[2]).sin() + x[3], &auto(0.01));
    assert_eq!(dominated.run.evaluations, 9 + 16);
}

/// A formula of a thousand dimensions without interactions takes two points for each, and sixteen more.
#[test]
fn a_thousand_dimensions() {
    let analysis =
        of(standard(1000), |x| x.iter().enumerate().map(|(j, x)| (1.0 + 0.001 * j as f64) * x).sum(), &auto(0.01));
    assert_eq!(analysis.run.evaluations, 2001 + 16);
    let exact: f64 = (0..1000).map(|j| (1.0 + 0.001 * f64::from(j)).powi(2)).sum();
    relative(sigma(&analysis), exact.sqrt(), 1e-10);
}

/// A function that saturates is smooth, but no polynomial follows it, so that the model is sampled. A constant function causes no warning.
#[test]
fn saturation_and_nothing_at_all() {
    let tanh = of(standard(2), |x| (2.0 * x[0]).tanh() + (2.0 * x[1]).tanh(), &auto(0.01));
    assert!(tanh.characteristics[0].evidence.model_sampled.is_some());
    // Variance of tanh(2 z): by Gauss quadrature with 150 and 200 nodes, numpy.
    relative(sigma(&tanh), (2.0 * 0.635_261_3f64).sqrt(), 0.02);
    let flat = of(standard(3), |_| 4.0, &auto(0.01));
    assert_eq!(sigma(&flat), 0.0);
    assert!(codes(&flat).contains(&"no-reaction"));
}

/// Exponential inputs: nodes at the edge of the support, long tails.
#[test]
fn exponential_inputs_stay_within_their_support() {
    let film = Exponential::new(0.0, 2.0).unwrap();
    let dimensions = vec![
        Dimension::distributed("film", 2.0, None, Arc::new(film)).unwrap(),
        Dimension::normal("gap", 10.0, 0.9).unwrap(),
    ];
    let function = refusing(|x| x[1] - x[0].sqrt(), |x| x[0] < 0.0);
    let analysis = analyze(&Problem::new(dimensions, function).unwrap(), &auto(0.01)).unwrap();
    assert_eq!(analysis.run.failed, 0, "a node beyond the support");
    // Var sqrt(x) = mean (1 - pi/4).
    let exact = (0.09 + 2.0 * (1.0 - std::f64::consts::FRAC_PI_4)).sqrt();
    let error = (sigma(&analysis) / exact - 1.0).abs();
    assert!(error <= 3.0 * estimate(&analysis) / exact, "{error} and {}", estimate(&analysis) / exact);
}

/// Other methods estimate the errors of effects that they did not examine.
#[test]
fn other_methods_say_what_they_did_not_see() {
    let f = |x: &[f64]| x[0] + x[1] + 0.3 * x[0] * x[1] + 0.1 * x[2] * x[2] + x[2];
    let estimate =
        |method: Method| of(standard(3), f, &method.into()).characteristics.remove(0).error_estimate.unwrap();
    let second = estimate(Method::SecondOrder);
    assert_eq!((second.sigma, second.kurtosis), (None, None), "nothing is known of interactions");
    assert!(second.mean.is_some() && second.basis().contains("nothing is known of 3 interactions"));
    let rss = estimate(Method::Rss);
    // Curvature moves the mean by 0.1, which rss does not include.
    assert!(rss.mean.unwrap() >= 0.1 && rss.basis().contains("curvature"));
    let full = estimate(Method::Full);
    assert!(full.sigma.is_some() && full.basis().contains("extrapolated"), "{}", full.basis());
    let ring = |x: &[f64]| (0..6).map(|j| x[j] + 0.2 * x[j] * x[(j + 1) % 6]).sum::<f64>();
    let six = of(standard(6), ring, &Method::SixN.into()).characteristics.remove(0).error_estimate.unwrap();
    assert!(six.basis().contains("9 interactions not examined"), "{}", six.basis());
    close(six.mean.unwrap(), 0.0, 1e-12, 1.0);
}

#[test]
fn an_accuracy_is_a_positive_number() {
    for accuracy in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let problem = Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap();
        assert!(analyze(&problem, &auto(accuracy)).unwrap_err().to_string().starts_with("the accuracy is"));
    }
}

/// Check points are the same for every study, and no coordinate lies outside of its distribution.
#[test]
fn points_that_check_are_of_the_distribution() {
    let asked = Asked::default();
    let uniform = (0..4).map(|j| Dimension::uniform(format!("u{j}"), 0.0, 1.0).unwrap()).collect::<Vec<_>>();
    let problem = Problem::new(uniform, asked.watching(|x| x.iter().sum())).unwrap();
    analyze(&problem, &auto(0.01)).unwrap();
    let points = asked.points();
    assert!(points.iter().flatten().all(|x| x.abs() <= 1.0));
}

/// A budget limits all points of a cheap model: of its plan, its verification, the joint yield, correlations and Sobol' indices.
#[test]
fn a_budget_limits_every_point_of_a_cheap_model() {
    let kink = |x: &[f64]| x[0].max(0.5 * x[1]) + 0.2 * x[2] * x[2];
    let sum = |x: &[f64]| (x[0] + x[1]).exp() + x[2];
    let limits = SpecLimits::new(Some(-2.0), Some(6.0)).unwrap();
    let asked = ["kink", "sum"].map(|name| Characteristic::new(name).with_limits(limits));
    let function = Closure::new(["kink", "sum"], move |x| [kink(x), sum(x)]);
    let problem = Problem::new(standard(3), function).unwrap().asking(asked).unwrap();
    for method in [Method::Auto, Method::SecondOrder, Method::Full] {
        for budget in [40, 5_000, 60_000, 90_000, 130_000, 200_000, 400_000] {
            let (counted, asked) = counted(&problem, false);
            analyze(&counted, &Options::from(method).with_budget(budget)).unwrap();
            let points = asked.load(Ordering::Relaxed);
            assert!(points <= budget, "{method:?}: {points} points with a budget of {budget}");
        }
    }
}

/// The reason why a refinement ended is reported: a budget, or the caller.
#[test]
fn the_account_says_what_ended_it() {
    let problem = || {
        let function = Closure::scalar("y", |x: &[f64]| (x[0] * x[1]).exp() * x[2].sin() + x[3].powi(4));
        Problem::new(normals(&[0.5, 0.6, 0.7, 0.8], &[0.3; 4]), function).unwrap()
    };
    let account = |options: &Options, stop: bool| {
        let stop = || stop.then_some(StopReason::Requested);
        let run = Run::to_the_end().stopping_when(&stop);
        analyze_with(&problem(), options, &run).unwrap().account.unwrap().to_string()
    };
    let stopped = account(&Method::Auto.into(), true);
    assert!(
        stopped.ends_with("; stopped before it was done") && stopped.contains("no interaction of 6 examined"),
        "{stopped}"
    );
    assert!(stopped.contains("0 points check") && !stopped.contains("budget"), "{stopped}");
    let short = account(&Options::from(Method::Auto).with_budget(26).with_accuracy(1e-6), false);
    assert!(short.ends_with("the budget ended it") && !short.contains("needed"), "{short}");
    let whole = account(&Method::Auto.into(), false);
    assert!(!whole.contains("budget") && !whole.contains("interrupted"), "{whole}");
}

/// If no regression follows the model, the points of its batches are part of the sample: 1024 points in all, none of them twice.
#[test]
fn a_sample_goes_on_from_the_strides() {
    let seen: Arc<Mutex<HashMap<Vec<u64>, usize>>> = Arc::default();
    let counted = Arc::clone(&seen);
    let gaps = move |x: &[f64]| {
        let key = x.iter().map(|x| x.to_bits()).collect();
        *counted.lock().unwrap().entry(key).or_default() += 1;
        (x[0] + x[1]).min(x[2] + x[3])
    };
    let found = of(standard(4), gaps, &auto(0.05));
    let seen = seen.lock().unwrap();
    let calls: usize = seen.values().sum();
    assert_eq!(found.characteristics[0].evidence.model_sampled.as_ref().unwrap().samples, 1024);
    assert_eq!(found.run.evaluations as usize, calls);
    assert_eq!(calls, seen.len(), "points that were evaluated twice");
    // The plan before the sample has all second derivatives, and check points.
    assert!((1024..1024 + 80).contains(&calls), "{calls}");
}

/// A surface does not follow this ratio to 1 %, but a sparse regression over a few batches of points does. The sample alone took 1024
/// points and more. The errors of such regressions are tested on other functions, in `coverage`.
#[test]
fn strides_end_where_a_regression_follows() {
    let engine = Study::read(&repository("examples/engine-balance/study.toml")).unwrap().problem;
    let one = engine.characteristics()[0].clone();
    let engine = engine.asking([one]).unwrap();
    let wish = SimulationOptions::default().with_samples(1 << 16).with_sampler(Sampler::Sobol);
    let truth = simulate(&engine, &wish).unwrap().characteristics[0].sigma.unwrap();
    for accuracy in [0.01, 0.001] {
        let found = analyze(&engine, &auto(accuracy)).unwrap();
        let (evaluations, off) = (found.run.evaluations, (sigma(&found) - truth.value).abs());
        assert!(evaluations < 1024 / 4, "{accuracy}: {evaluations}");
        // The tolerance is the wanted accuracy and three errors of the sample.
        assert!(off < accuracy * truth.value + 3.0 * truth.standard_error.unwrap(), "{accuracy}: {off}");
    }
}

/// A finer accuracy takes no fewer evaluations than a coarser one, because it is reached through the same steps.
#[test]
fn a_finer_error_never_takes_fewer_evaluations() {
    let functions: [fn(&[f64]) -> f64; 4] = [
        |x| x.iter().map(|x| (0.3 * x).exp()).sum(),
        |x| x.iter().map(|x| 0.2 * x + 0.02 * x * x * x).sum(),
        |x| x[0] * x[1] + 0.1 * x[2] * x[3] + x[4],
        |x| (1.0 + 0.1 * x[0]).hypot(0.5 + 0.1 * x[1]) + 0.1 * x[2],
    ];
    for (index, function) in functions.into_iter().enumerate() {
        let counts = [0.1, 0.05, 0.02, 0.01, 0.005, 0.001]
            .map(|accuracy| of(standard(5), function, &auto(accuracy)).run.evaluations);
        assert!(counts.is_sorted(), "{index}: {counts:?}");
    }
}
