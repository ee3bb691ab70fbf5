//! Analyses: unknown figures stay unknown, and doubtful results carry a warning.

use sensitol::{Characteristic, Closure, Dimension, Method, Options, Problem, ProblemError, SpecLimits, analyze};
use sensitol_testing::{close, normals, relative, standard};

fn codes(problem: &Problem, method: Method) -> Vec<&'static str> {
    analyze(problem, &method.into()).unwrap().warnings.iter().map(|warning| warning.code()).collect()
}

#[test]
fn rss_says_where_it_does_not_hold() {
    let flat = Problem::new(standard(2), Closure::scalar("y", |x| x[0] + x[1] + 0.01 * x[0] * x[0])).unwrap();
    assert!(codes(&flat, Method::Rss).is_empty());
    let curved = Problem::new(standard(2), Closure::scalar("y", |x| x[0] + x[1] + 0.3 * x[0] * x[0])).unwrap();
    assert_eq!(codes(&curved, Method::Rss), ["rss-invalid"]);
    assert_eq!(codes(&curved, Method::WorstCase), ["rss-invalid"]);
    assert!(codes(&curved, Method::Full).is_empty());
}

/// The curvature of a first-order method is null, not 0.
#[test]
fn first_order_knows_no_curvature() {
    let problem = Problem::new(standard(2), Closure::scalar("y", |x| x[0] + x[1] + 0.3 * x[0] * x[0])).unwrap();
    let found = analyze(&problem, &Method::Rss.into()).unwrap().characteristics.remove(0);
    let first = &found.sensitivities[0];
    assert_eq!((first.curvature_share, first.mean_shift, found.contributions.left_out_share), (None, None, None));
    relative(first.second.unwrap(), 0.6, 1e-14);
    relative(first.linear_share.unwrap() + found.sensitivities[1].linear_share.unwrap(), 1.0, 1e-14);
}

#[test]
fn a_characteristic_that_reacts_to_nothing_is_a_warning() {
    let problem = Problem::new(standard(2), Closure::scalar("y", |_| 4.0)).unwrap();
    assert_eq!(codes(&problem, Method::Full), ["no-reaction"]);
    let found = analyze(&problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let moments = found.moments.unwrap();
    assert_eq!((moments.sigma(), moments.skewness(), moments.kurtosis()), (0.0, None, None));
}

/// One rounding error of a value of 1e12 is a tenth of its change of 1e-3, and causes a warning.
#[test]
fn rounding_beside_sigma_is_a_warning() {
    let problem = Problem::new(standard(1), Closure::scalar("y", |x| 1e12 + 1e-3 * x[0])).unwrap();
    assert_eq!(codes(&problem, Method::Full), ["noise"]);
    let enough = Problem::new(standard(1), Closure::scalar("y", |x| 1e8 + 1e-3 * x[0])).unwrap();
    assert!(codes(&enough, Method::Full).is_empty());
}

#[test]
fn pairs_that_were_not_examined_are_counted() {
    let problem = Problem::new(standard(5), Closure::scalar("y", |x| x.iter().sum())).unwrap();
    let message = |method: Method| {
        let analysis = analyze(&problem, &method.into()).unwrap();
        analysis.warnings.iter().find(|warning| warning.code() == "pairs-not-examined").map(|warning| warning.message())
    };
    assert!(message(Method::SixN).unwrap().starts_with("5 of 10 interactions were examined"));
    assert!(message(Method::SecondOrder).unwrap().starts_with("0 of 10 interactions were examined"));
    assert_eq!(message(Method::Full), None);
    assert_eq!(message(Method::Rss), None, "first order does not claim to");
}

/// The worst case of an asymmetric band uses its own ends, and RSS half of its width.
#[test]
fn asymmetric_bands_have_asymmetric_worst_cases() {
    let dimensions = [
        Dimension::normal_between("a", 10.0, [-0.1, 0.3]).unwrap(),
        Dimension::normal_between("b", 5.0, [0.0, 0.2]).unwrap(),
    ];
    let problem = Problem::new(dimensions, Closure::scalar("y", |x| x[0] - x[1])).unwrap();
    let found = analyze(&problem, &Method::WorstCase.into()).unwrap().characteristics.remove(0);
    let [low, high] = found.range.worst_case.unwrap();
    close(low, 5.0 - 0.1 - 0.2, 1e-13, 1.0);
    close(high, 5.0 + 0.3, 1e-13, 1.0);
    relative(found.linear.rss.unwrap(), 0.2f64.hypot(0.1), 1e-12);
    relative(found.moments.unwrap().mean(), 10.1 - 5.1, 1e-13);
}

/// Mean and sigma at the extremes of scale in one study, and a thousand dimensions.
#[test]
fn extremes_of_scale_and_size() {
    let tolerances = [1e-12, 1e12, 1.0, 1e-6];
    let problem = Problem::new(
        normals(&[1e-11, -3e12, 0.0, 1e-5], &tolerances),
        Closure::scalar("y", |x| x[0] * 1e12 + x[1] * 1e-12 + x[2] + x[3] * 1e6),
    )
    .unwrap();
    let found = analyze(&problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    relative(found.moments.unwrap().sigma(), 2.0 / 3.0, 1e-11);
    for sensitivity in &found.sensitivities {
        relative(sensitivity.linear_share.unwrap(), 0.25, 1e-11);
    }
    let n = 1000;
    let thousand = Problem::new(standard(n), Closure::scalar("y", |x| x.iter().sum::<f64>() + x[3] * x[997])).unwrap();
    let analysis = analyze(&thousand, &Method::SixN.into()).unwrap();
    assert_eq!(analysis.run.evaluations, 6001);
    relative(analysis.characteristics[0].moments.unwrap().sigma(), 1000f64.sqrt(), 1e-3);
}

#[test]
fn problems_that_do_not_fit_are_refused() {
    let y = || Closure::scalar("y", |x| x[0]);
    let error = |problem: Result<Problem, ProblemError>| problem.err().unwrap().to_string();
    assert_eq!(error(Problem::new([], y())), "a problem needs at least one dimension");
    let twice = [Dimension::normal("a", 1.0, 0.1).unwrap(), Dimension::fixed("a", 1.0).unwrap()];
    assert_eq!(error(Problem::new(twice, y())), "the name `a` is given twice");
    let engine = || "engine-balance".parse::<&sensitol_models::Model>().unwrap().function();
    assert!(error(Problem::new(standard(2), engine())).starts_with("the assembly function's inputs are MP, MR,"));
    let gap = Characteristic::new("gap").with_limits(SpecLimits::new(None, Some(1.0)).unwrap());
    let asking = Problem::new(standard(1), y()).unwrap().asking([gap]);
    assert_eq!(error(asking), "there is no characteristic `gap`; known: y");
    let none = Problem::new(standard(1), y()).unwrap().asking([]);
    assert_eq!(error(none), "a problem needs at least one characteristic");
}

#[test]
fn impossible_dimensions_and_limits_are_refused() {
    let error = |dimension: Result<Dimension, sensitol::DimensionError>| dimension.unwrap_err().to_string();
    assert_eq!(
        error(Dimension::normal("a", 1.0, -0.1)),
        "dimension `a`: the tolerance must not be negative, but is -0.1"
    );
    assert_eq!(
        error(Dimension::normal("a", 1.0, f64::NAN)),
        "dimension `a`: tolerance must be a finite number, not NaN"
    );
    assert_eq!(
        error(Dimension::uniform("a", f64::INFINITY, 1.0)),
        "dimension `a`: nominal must be a finite number, not inf"
    );
    assert_eq!(
        error(Dimension::normal_between("a", 1.0, [0.2, -0.1])),
        "dimension `a`: sigma must be above 0, not -0.05000000000000001"
    );
    assert!(Dimension::normal("a", 1.0, 0.1).unwrap().with_step(-1.0).is_err());
    assert!(SpecLimits::new(Some(2.0), Some(1.0)).is_err());
    assert!(SpecLimits::new(Some(f64::NAN), None).is_err());
    assert!(Characteristic::new("y").with_target_yield(1.0).is_err());
}

/// A minimum distance has a kink at contact, because the model returns 0 if parts overlap. The kink is found.
#[test]
fn a_distance_that_ends_at_contact_is_found_out() {
    let gap = |least: f64| {
        let clipped = Closure::scalar("gap", move |x| (x[0] - x[1]).max(least));
        analyze(&Problem::new(normals(&[10.0, 9.95], &[0.3, 0.1]), clipped).unwrap(), &Method::Full.into()).unwrap()
    };
    let atoms = |least: f64| gap(least).warnings.iter().filter(|warning| warning.code() == "atom").count();
    assert_eq!((atoms(0.0), atoms(f64::NEG_INFINITY)), (1, 0));
}

/// A program that changes to a mirrored assembly causes a warning with the changed output and the doubtful points.
#[test]
fn a_program_that_flips_is_warned_of() {
    let script = sensitol_testing::repository("tests/children/child.py").display().to_string();
    let study = format!(
        "[model]\ncommand = [\"python3\", {script:?}, \"flips\"]\n[dimensions]\na = {{ nominal = 1, sigma = 1 }}\n\
         b = {{ nominal = 2, tolerance = 0.3 }}\n[characteristics]\nsum = {{}}\n"
    );
    let study = sensitol_study::Study::from_toml(&study, "flip.toml").unwrap();
    // The nodes are twelve sigma off, at a = 13, where the program flips.
    let options = Options::from(Method::SecondOrder).with_step(12.0);
    let analysis = analyze(&study.problem, &options).unwrap();
    let flip = analysis.warnings.iter().find(|warning| warning.code() == "branch-flip");
    let message = flip.unwrap_or_else(|| panic!("{:?}", analysis.warnings)).message();
    assert!(
        message.contains("at the same dimensions, depending on the points before")
            && message.contains("among them a ="),
        "{message}"
    );
}
