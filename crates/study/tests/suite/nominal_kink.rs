//! Kinks of a costly model at the nominal point, beside the exact moments of lengths of normal components.

use sensitol::{Analysis, Closure, Dimension, Method, Options, Problem, analyze};
use sensitol_testing::{costly, relative};

/// Tilts by four dimensions, each with a sigma of 1/3.
fn dimensions() -> Vec<Dimension> {
    ["a", "b", "c", "d"].map(|name| Dimension::normal(name, 0.0, 1.0).unwrap()).to_vec()
}

fn analysed(model: fn(&[f64]) -> f64, options: &Options) -> Analysis {
    let (problem, _) = costly(&Problem::new(dimensions(), Closure::scalar("tilt", model)).unwrap());
    analyze(&problem, options).unwrap()
}

fn kinked(found: &Analysis) -> Option<String> {
    let kinks = found.warnings.iter().filter(|warning| warning.code() == "kink-at-nominal");
    kinks.map(|warning| warning.message()).next()
}

/// Length of two components: (a + b) across x and (c + d) across y.
fn tilt(x: &[f64]) -> f64 {
    (x[0] + x[1]).hypot(x[2] + x[3])
}

/// Mean and sigma of a Rayleigh distribution whose components have sigma sqrt(2)/3.
fn truth() -> [f64; 2] {
    let sigma = 2f64.sqrt() / 3.0;
    [sigma * (std::f64::consts::PI / 2.0).sqrt(), sigma * (2.0 - std::f64::consts::PI / 2.0).sqrt()]
}

#[test]
fn every_method_names_a_kink_at_the_nominal_point() {
    for method in [Method::SecondOrder, Method::Full, Method::SixN, Method::Auto] {
        let found = analysed(tilt, &method.into());
        let said = kinked(&found).unwrap_or_else(|| panic!("{method:?}: {:?}", found.warnings));
        assert!(said.contains("equal and opposite") && said.contains("`a`") && said.contains("`d`"), "{said}");
        let warning = found.warnings.iter().find(|warning| warning.code() == "kink-at-nominal").unwrap();
        assert!(warning.advice()[0].to_string().contains("return the two components"), "{:?}", warning.advice());
        // The general warning of a kink says less.
        assert!(found.warnings.iter().all(|warning| warning.code() != "kink"), "{method:?}: {:?}", found.warnings);
    }
}

/// `auto` takes the moments from points of the model: without a budget within their standard errors, with one as exactly as it allows.
#[test]
fn auto_samples_rather_than_fits() {
    let [mean, sigma] = truth();
    let few = analysed(tilt, &Method::Auto.into());
    let one = &few.characteristics[0];
    let (moments, errors) = (one.moments.unwrap(), one.error_estimate.as_ref().unwrap());
    assert!((moments.mean() - mean).abs() < 3.0 * errors.mean.unwrap(), "{moments:?} {errors:?}");
    assert!((moments.sigma() - sigma).abs() < 3.0 * errors.sigma.unwrap(), "{moments:?} {errors:?}");
    // Some 55 points have a standard error of 7 % of the mean. The estimate is wider, since few points tell their own scatter badly.
    assert!(errors.mean.unwrap() < 0.25 * mean, "{errors:?}");
    let many = analysed(tilt, &Options::from(Method::Auto).with_budget(6000));
    let moments = many.characteristics[0].moments.unwrap();
    // 6000 points have a standard error of 0.7 % of the mean and 1 % of sigma.
    relative(moments.mean(), mean, 0.02);
    relative(moments.sigma(), sigma, 0.03);
}

/// Smooth functions with a minimum at the nominal point have no kink there, and neither have kinks beside it.
#[test]
fn other_shapes_are_no_kink_at_the_nominal_point() {
    let models: [fn(&[f64]) -> f64; 5] = [
        |x| x[0] * x[0] + 0.5 * x[1] * x[1] + x[2] + x[3],
        |x| (x[0] + x[1]).cosh() + x[2] + x[3],
        |x| x[0].cos() + x[1] + x[2] + x[3],
        |x| (x[0] - 0.2).max(0.0) + x[1] + x[2] + x[3],
        |x| x[0] + x[1] - x[2] + x[3],
    ];
    for (index, model) in models.into_iter().enumerate() {
        for method in [Method::SecondOrder, Method::Auto] {
            let found = analysed(model, &method.into());
            assert_eq!(kinked(&found), None, "{index} {method:?}");
        }
    }
}

/// At most one evaluation for a characteristic decides, and none without verification.
#[test]
fn one_evaluation_decides() {
    let mut options = Options::from(Method::SecondOrder);
    let with = analysed(tilt, &options).run.evaluations;
    options.verify = Some(0);
    let without = analysed(tilt, &options);
    assert_eq!(kinked(&without), None);
    assert_eq!(without.run.evaluations, 9);
    // One for the kink, and at most 18 of the search for jumps beside the check points.
    assert!(with > 9, "{with}");
}
