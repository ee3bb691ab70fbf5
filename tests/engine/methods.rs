//! Methods: exactness, invariances, and the options of each.

use std::sync::Arc;

use proptest::prelude::*;
use sensitol::distribution::{CentralMoments, StandardMoments};
use sensitol::method::registry::ALL;

use sensitol::method::{MethodError, Pairs, Stencil};
use sensitol::warning::Advice;
use sensitol::{Analysis, Closure, Dimension, Method, Options, Problem, analyze};
use sensitol_testing::{close, normals, relative, standard};

const SECOND_ORDER: [Method; 4] = [Method::SecondOrder, Method::SixN, Method::Full, Method::Classic];

fn analysis(dimensions: Vec<Dimension>, method: Method, f: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Analysis {
    analyze(&Problem::new(dimensions, Closure::scalar("y", f)).unwrap(), &method.into()).unwrap()
}

/// Dimensions with every kind of distribution.
fn mixed() -> Vec<Dimension> {
    let skewed = CentralMoments::new(-2.0, [0.04, 0.016, 0.0144, 0.01408, 0.01696, 0.0237312, 0.03797248]).unwrap();
    vec![
        Dimension::normal("n", 10.0, 0.3).unwrap(),
        Dimension::uniform("u", 5.0, 0.2).unwrap(),
        Dimension::distributed("m", -2.0, None, Arc::new(skewed)).unwrap(),
        Dimension::normal_between("s", 3.0, [0.0, 0.6]).unwrap(),
    ]
}

fn shape(dimension: &Dimension) -> StandardMoments {
    dimension.distribution().unwrap().standard_moments()
}

/// Every method is exact for a linear function: sigma, skewness and kurtosis follow from the cumulants of the inputs.
#[test]
fn linear_functions_are_exact() {
    let slopes = [2.0, -7.0, 0.5, 1e-3];
    for method in ALL.iter().map(|procedure| procedure.method()) {
        let analysis = analysis(mixed(), method, move |x| slopes.iter().zip(x).map(|(a, x)| a * x).sum());
        let found = &analysis.characteristics[0];
        let dimensions = mixed();
        let cumulant = |order: i32, shape: fn(&Dimension) -> f64| -> f64 {
            dimensions.iter().zip(slopes).map(|(d, a)| shape(d) * (a * d.sigma()).powi(order)).sum()
        };
        let variance = cumulant(2, |_| 1.0);
        let skewness = cumulant(3, |d| shape(d).skewness) / variance.powf(1.5);
        let excess = cumulant(4, |d| shape(d).excess) / variance.powi(2);
        let moments = found.moments.unwrap();
        relative(moments.sigma(), variance.sqrt(), 1e-11);
        close(moments.skewness().unwrap(), skewness, 1e-10, 1.0);
        close(moments.excess().unwrap(), excess, 1e-10, 1.0);
        let mean: f64 = dimensions.iter().zip(slopes).map(|(d, a)| a * d.mean()).sum();
        close(moments.mean(), mean, 1e-13, 1.0);
        for (sensitivity, slope) in found.sensitivities.iter().zip(slopes) {
            relative(sensitivity.first.unwrap(), slope, 1e-9);
        }
        let worst: f64 = dimensions.iter().zip(slopes).map(|(d, a)| (a * d.half_band()).abs()).sum();
        let [low, high] = found.range.worst_case.unwrap();
        relative(high - low, 2.0 * worst, 1e-10);
    }
}

/// `full` and `classic` are exact for any quadratic, `six-n` for one with its pairs. Derivatives are exact too.
#[test]
fn quadratics_are_exact() {
    let f = |x: &[f64]| 1.0 + x[0] - 2.0 * x[1] + 0.3 * x[0] * x[0] + 0.7 * x[1] * x[2] - 0.2 * x[0] * x[3] + x[3];
    for method in [Method::Full, Method::Classic] {
        let found = analysis(standard(4), method, f).characteristics.remove(0);
        let variance = 1.0 + 4.0 + 2.0 * 0.09 + 0.49 + 0.04 + 1.0;
        relative(found.moments.unwrap().sigma(), f64::sqrt(variance), 1e-14);
        relative(found.moments.unwrap().mean(), 1.3, 1e-14);
        let strongest = found.contributions.interactions.get(0).unwrap();
        assert_eq!(strongest.dimensions, ["x1", "x2"]);
        relative(strongest.mixed.unwrap(), 0.7, 1e-13);
        relative(strongest.share.unwrap(), 0.49 / variance, 1e-13);
        relative(found.sensitivities[0].second.unwrap(), 0.6, 1e-13);
        relative(found.sensitivities[0].mean_shift.unwrap(), 0.3, 1e-13);
    }
}

/// Five-point axes are exact for a quartic: moments of `u^4` of a normal input from its moments up to the sixteenth.
#[test]
fn five_points_are_exact_for_quartics() {
    let found = analysis(standard(1), Method::SixN, |x| x[0].powi(4)).characteristics.remove(0);
    let moments = found.moments.unwrap();
    relative(moments.mean(), 3.0, 1e-13);
    relative(moments.variance(), 105.0 - 9.0, 1e-12);
    let third = 10395.0 - 3.0 * 3.0 * 105.0 + 2.0 * 27.0;
    relative(moments.skewness().unwrap(), third / 96f64.powf(1.5), 1e-12);
    let fourth = 2_027_025.0 - 4.0 * 3.0 * 10395.0 + 6.0 * 9.0 * 105.0 - 3.0 * 81.0;
    relative(moments.kurtosis().unwrap(), fourth / 96f64.powi(2), 1e-12);
    // The derivatives at the mean are 0.
    close(found.sensitivities[0].first.unwrap(), 0.0, 1e-13, 1.0);
    close(found.sensitivities[0].second.unwrap(), 0.0, 1e-12, 1.0);
}

/// Five points are exact for a uniform input and one that is known by its moments alone. Both are compared with the moments of `x^3` over
/// (-1, 1).
#[test]
fn five_points_of_other_inputs() {
    let (variance, fourth) = (1.0 / 7.0, 1.0 / 13.0);
    let uniform = Dimension::uniform("u", 0.0, 1.0).unwrap();
    let cubic =
        |dimension| analysis(vec![dimension], Method::SixN, |x| x[0].powi(3)).characteristics[0].moments.unwrap();
    let found = cubic(uniform);
    relative(found.variance(), variance, 1e-12);
    relative(found.kurtosis().unwrap(), fourth / (variance * variance), 1e-12);
    // Eight moments give the variance of a cubic exactly, but its fourth moment, of degree twelve, by a rule of degree 8.
    let moments = CentralMoments::new(0.0, [1.0 / 3.0, 0.0, 0.2, 0.0, 1.0 / 7.0, 0.0, 1.0 / 9.0]).unwrap();
    let found = cubic(Dimension::distributed("m", 0.0, None, Arc::new(moments)).unwrap());
    relative(found.variance(), variance, 1e-12);
    relative(found.kurtosis().unwrap(), fourth / (variance * variance), 0.06);
}

/// Curved function without a linear direction, for the properties below.
fn bent(x: &[f64]) -> f64 {
    (x[0] * x[1]).sin() + (0.3 * x[2]).exp() * x[3] - (1.0 + x[1] * x[1] + x[3] * x[3]).sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Other units of an input or the output change nothing but the units.
    #[test]
    fn units_do_not_matter(powers in prop::array::uniform4(-12..13i32), out in -12..13i32, which in 0..4usize) {
        let means = [0.4, -0.3, 0.2, 0.6];
        let tolerances = [0.3, 0.2, 0.4, 0.1];
        let unit = powers.map(|power| 10f64.powi(power));
        let scaled = |values: [f64; 4]| values.iter().zip(unit).map(|(value, unit)| value * unit).collect::<Vec<f64>>();
        let method = SECOND_ORDER[which];
        let one = analysis(normals(&means, &tolerances), method, bent);
        let factor = 10f64.powi(out);
        let other = analysis(normals(&scaled(means), &scaled(tolerances)), method, move |x| {
            factor * bent(&x.iter().zip(unit).map(|(x, unit)| x / unit).collect::<Vec<f64>>())
        });
        let (one, other) = (&one.characteristics[0], &other.characteristics[0]);
        let (a, b) = (one.moments.unwrap(), other.moments.unwrap());
        close(b.mean() / factor, a.mean(), 1e-11, 1.0);
        relative(b.sigma() / factor, a.sigma(), 1e-10);
        close(b.skewness().unwrap(), a.skewness().unwrap(), 1e-9, 1.0);
        close(b.excess().unwrap(), a.excess().unwrap(), 1e-9, 1.0);
        for ((a, b), unit) in one.sensitivities.iter().zip(&other.sensitivities).zip(unit) {
            close(b.first.unwrap() * unit / factor, a.first.unwrap(), 1e-9, 1.0);
            close(b.linear_share.unwrap(), a.linear_share.unwrap(), 1e-9, 1.0);
        }
    }

    /// Results do not depend on the order of the dimensions, or on the sign of the output or of an input.
    #[test]
    fn order_and_signs_do_not_matter(rotation in 0..4usize, minus: bool, flip in prop::array::uniform4(any::<bool>()), which in 0..4usize) {
        let means = [0.4, -0.3, 0.2, 0.6];
        let tolerances = [0.3, 0.2, 0.4, 0.1];
        let method = SECOND_ORDER[which];
        // A change of one sign turns the pair of corners both up and both down into another pair. With the two-point stencil all signs
        // change, or none.
        let alone = matches!(method, Method::SecondOrder | Method::Classic);
        let sign = |d: usize| if flip[if alone { d } else { 0 }] { -1.0 } else { 1.0 };
        let one = analysis(normals(&means, &tolerances), method, bent);
        let place = move |d: usize| (d + rotation) % 4;
        let mut moved = ([0.0; 4], [0.0; 4]);
        for d in 0..4 {
            (moved.0[place(d)], moved.1[place(d)]) = (sign(d) * means[d], tolerances[d]);
        }
        let outer = if minus { -1.0 } else { 1.0 };
        let signs = [0, 1, 2, 3].map(sign);
        let other = analysis(normals(&moved.0, &moved.1), method, move |x| {
            outer * bent(&[0, 1, 2, 3].map(|d| signs[d] * x[place(d)]))
        });
        let (a, b) = (one.characteristics[0].moments.unwrap(), other.characteristics[0].moments.unwrap());
        close(b.mean(), outer * a.mean(), 1e-12, 1.0);
        relative(b.sigma(), a.sigma(), 1e-11);
        close(b.skewness().unwrap(), outer * a.skewness().unwrap(), 1e-10, 1.0);
        close(b.excess().unwrap(), a.excess().unwrap(), 1e-10, 1.0);
        for d in 0..4 {
            let (a, b) = (&one.characteristics[0].sensitivities[d], &other.characteristics[0].sensitivities[place(d)]);
            close(b.first.unwrap(), outer * sign(d) * a.first.unwrap(), 1e-11, 1.0);
            close(b.curvature_share.unwrap(), a.curvature_share.unwrap(), 1e-10, 1.0);
        }
    }

    /// Shares sum to 1 for all inputs.
    #[test]
    fn shares_sum_to_one(which in 0..4usize, a in -2.0..2.0f64, b in -2.0..2.0f64) {
        let analysis = analysis(mixed(), SECOND_ORDER[which], move |x| {
            (a * x[0] - b * x[1] * x[2]).cos() + x[3] * x[2] + b * x[3].powi(3)
        });
        let found = &analysis.characteristics[0];
        let own: f64 = (0..4).map(|d| found.share(d).unwrap()).sum();
        let together: f64 = found.contributions.interactions.iter().map(|interaction| interaction.share.unwrap()).sum();
        close(own + together, 1.0, 1e-11, 1.0);
    }
}

/// A dimension with zero tolerance changes no bit of the result.
#[test]
fn zero_tolerance_changes_nothing() {
    for method in SECOND_ORDER {
        let four = normals(&[0.4, -0.3, 0.2, 0.6], &[0.3, 0.2, 0.4, 0.1]);
        let one = analysis(four.clone(), method, bent);
        let mut five = four;
        five.push(Dimension::normal("still", 7.0, 0.0).unwrap());
        let other = analysis(five, method, |x| bent(x) + 0.0 * x[4]);
        assert_eq!(one.characteristics[0].moments, other.characteristics[0].moments);
        assert_eq!(one.run.evaluations, other.run.evaluations);
    }
}

/// The strongest pairs have the largest variances, even if slopes are zero.
#[test]
fn six_n_picks_the_strongest_pairs() {
    // x4 and x5 have large curvature but no slope. x0 has the largest slope.
    let f = |x: &[f64]| 3.0 * x[0] + 0.1 * (x[1] + x[2] + x[3]) + 2.0 * x[4] * x[4] + x[5] * x[5] + 0.5 * x[4] * x[5];
    let found = analysis(standard(6), Method::SixN, f).characteristics.remove(0);
    assert_eq!(found.contributions.interactions.len(), 6);
    assert_eq!(found.contributions.interactions.get(0).unwrap().dimensions, ["x4", "x5"]);
    relative(found.contributions.interactions.get(0).unwrap().mixed.unwrap(), 0.5, 1e-13);
    assert_eq!((found.contributions.possible_interactions, found.contributions.left_out_share), (15, None));
    let three = analysis(standard(3), Method::SixN, |x| x[0] * x[1] + x[2]).characteristics.remove(0);
    assert_eq!(three.contributions.left_out_share, Some(0.0), "at N = 3 all pairs are examined");
}

#[test]
fn pairs_can_be_chosen() {
    let problem = Problem::new(standard(5), Closure::scalar("y", |x| x[0] * x[3] + x[1])).unwrap();
    let with = |pairs| Options::from(Method::SixN).with_pairs(pairs);
    let listed = |names: &[(&str, &str)]| {
        with(Pairs::Listed(names.iter().map(|&(a, b)| (a.to_owned(), b.to_owned())).collect()))
    };
    let examined = |options: &Options| {
        let found = analyze(&problem, options).unwrap().characteristics.remove(0);
        let mut pairs: Vec<String> =
            found.contributions.interactions.iter().map(|pair| pair.dimensions.join("-")).collect();
        pairs.sort();
        pairs.join(" ")
    };
    assert_eq!(examined(&with(Pairs::Adjacent)), "x0-x1 x0-x4 x1-x2 x2-x3 x3-x4");
    assert_eq!(examined(&listed(&[("x3", "x0"), ("x0", "x3"), ("x1", "x2")])), "x0-x3 x1-x2");
    let error = |options: &Options| analyze(&problem, options).unwrap_err().to_string();
    assert_eq!(error(&listed(&[("x0", "X3")])), "pair `x0:X3`: there is no dimension `X3`; did you mean `x3`?");
    assert_eq!(error(&listed(&[("x0", "x0")])), "pair `x0:x0`: a dimension does not interact with itself");
}

#[test]
fn options_that_mean_nothing_are_refused() {
    let problem = Problem::new(standard(10), Closure::scalar("y", |x| x[0])).unwrap();
    let refused = |options: Options| analyze(&problem, &options).unwrap_err();
    assert!(matches!(
        refused(Options::from(Method::Full).with_pairs(Pairs::Adjacent)),
        MethodError::OptionDoesNotApply { option: "pairs", .. }
    ));
    assert!(matches!(
        refused(Options::from(Method::Rss).with_stencil(Stencil::FourPoint)),
        MethodError::OptionDoesNotApply { option: "stencil", .. }
    ));
    assert!(matches!(refused(Options::from(Method::Rss).with_step(0.0)), MethodError::BadStep { .. }));
    let over = refused(Options::from(Method::Full).with_budget(100));
    assert_eq!(over.to_string(), "full needs 111 evaluations, more than the budget of 100; six-n needs 61");
    assert_eq!(over.advice(), [Advice::UseMethod { methods: vec![Method::SixN] }, Advice::RaiseBudget]);
    let none = refused(Options::from(Method::Full).with_budget(5));
    assert_eq!(none.to_string(), "full needs 111 evaluations, more than the budget of 5; no method does with so few");
    assert!(analyze(&problem, &Options::from(Method::Full).with_budget(111)).is_ok());
}
