//! Distributions in analyses: exact moments of quadratics, nodes within the support, long tails.

use sensitol::plan::{Nodes, Spread};
use sensitol::{Closure, Dimension, Method, Problem, analyze};
use sensitol_study::Study;

use sensitol_testing::densities::{Case, cases};
use sensitol_testing::{close, data, relative, repository};

/// Returns a dimension with the distribution of a case.
pub fn dimension(case: &Case) -> Dimension {
    Dimension::distributed("x", case.distribution.mean(), None, case.distribution.clone()).unwrap()
}

/// Mean, sigma, skewness and kurtosis by integration of the density.
fn integrated(case: &Case, f: impl Fn(f64) -> f64) -> [f64; 4] {
    let mean = case.mean(&f);
    let sigma = case.mean(|x| (f(x) - mean).powi(2)).sqrt();
    let standard = |order: i32| case.mean(|x| ((f(x) - mean) / sigma).powi(order));
    [mean, sigma, standard(3), standard(4)]
}

fn analysed(case: &Case, method: Method, f: impl Fn(f64) -> f64 + Send + Sync + 'static) -> [f64; 4] {
    let problem = Problem::new([dimension(case)], Closure::scalar("y", move |x| f(x[0]))).unwrap();
    let moments = analyze(&problem, &method.into()).unwrap().characteristics[0].moments.unwrap();
    [moments.mean(), moments.sigma(), moments.skewness().unwrap(), moments.kurtosis().unwrap()]
}

/// A quadratic has exact moments for every distribution and every position of the nodes.
#[test]
fn quadratics_are_exact() {
    for case in cases() {
        let (mean, sigma) = (case.distribution.mean(), case.distribution.sigma());
        let y = move |x: f64| {
            let u = (x - mean) / sigma;
            3.0 + u + 0.4 * u * u
        };
        let expected = integrated(&case, y);
        for method in [Method::SecondOrder, Method::Full] {
            let found = analysed(&case, method, y);
            for (found, expected) in found.into_iter().zip(expected) {
                // Differences divide by a node's distance. The integrator is accurate to 1e-12 of the eighth moment.
                assert!((found / expected - 1.0).abs() < 1e-9, "{}: {found} for {expected}", case.distribution.name());
            }
        }
    }
}

/// Two inputs with a product: `full` against the product of two one-dimensional integrations.
#[test]
fn a_product_of_two_inputs_is_exact() {
    let cases = cases();
    for (a, b) in cases.iter().zip(cases.iter().skip(5)) {
        let named = |case: &Case, name: &str| {
            Dimension::distributed(name, case.distribution.mean(), None, case.distribution.clone()).unwrap()
        };
        let problem = Problem::new([named(a, "a"), named(b, "b")], Closure::scalar("y", |x| x[0] * x[1])).unwrap();
        let moments = analyze(&problem, &Method::Full.into()).unwrap().characteristics[0].moments.unwrap();
        let raw = |case: &Case, order: i32| case.mean(|x| x.powi(order));
        let product = |order: i32| raw(a, order) * raw(b, order);
        close(moments.mean(), product(1), 1e-11, moments.sigma());
        close(moments.variance(), product(2) - product(1).powi(2), 1e-10, product(2));
        let third = product(3) - 3.0 * product(1) * product(2) + 2.0 * product(1).powi(3);
        close(
            moments.skewness().unwrap(),
            third / moments.sigma().powi(3),
            1e-9,
            (product(3).abs() + product(2).powf(1.5)) / moments.sigma().powi(3),
        );
    }
}

/// No node lies outside the support. Pairs with a shifted node keep the third moment, and five points never move.
#[test]
fn nodes_stay_within_the_support() {
    for case in cases() {
        let distribution = &case.distribution;
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let [lower, upper] = distribution.support().map(|edge| (edge - mean) / sigma);
        for spread in [Spread::Pair, Spread::Five] {
            let nodes = Nodes::matched(distribution.as_ref(), spread);
            assert!(nodes.u.iter().all(|&u| u > lower && u < upper && u != 0.0), "{nodes:?}");
            assert!(nodes.u.windows(2).all(|pair| pair[0] < pair[1]), "{nodes:?}");
            if spread == Spread::Five && nodes.u.len() == 4 {
                assert!(nodes.moved.is_empty());
            }
        }
        let pair = Nodes::matched(distribution.as_ref(), Spread::Pair);
        let reaches = pair.u[0] > 0.949 * lower && pair.u[1] < 0.949 * upper;
        if !pair.moved.is_empty() && reaches {
            close(pair.u[0] + pair.u[1], distribution.standard_moments().skewness, 1e-12, 1.0);
        }
    }
}

/// Five points have smaller errors of mean and sigma than the parabola, for steep functions of inputs with tails.
#[test]
fn five_points_beat_the_parabola_on_tails() {
    for case in cases().into_iter().filter(|case| case.distribution.standard_moments().excess > 1.0) {
        let (mean, sigma) = (case.distribution.mean(), case.distribution.sigma());
        // The function is steep where most of the values are, and flat along the tail.
        let towards = case.distribution.standard_moments().skewness.signum();
        let y = move |x: f64| (-0.5 * towards * (x - mean) / sigma).exp();
        let truth = integrated(&case, y);
        let errors = |method: Method| {
            let found = analysed(&case, method, y);
            [
                (found[0] - truth[0]).abs() / truth[1],
                (found[1] / truth[1] - 1.0).abs(),
                (found[3] / truth[3] - 1.0).abs(),
            ]
        };
        let (five, parabola) = (errors(Method::SixN), errors(Method::SecondOrder));
        assert!(five[0] < 2e-2 && five[1] < 0.3 * parabola[1], "{}: {five:?} {parabola:?}", case.distribution.name());
        assert!(five[2] < 0.6, "{}: kurtosis {five:?} {parabola:?}", case.distribution.name());
    }
}

/// A long tail causes a warning if the model is curved along it, and only then.
#[test]
fn long_tails_are_warned_of_where_they_matter() {
    let codes = |line: &str, method: Method, f: fn(f64) -> f64| {
        let problem =
            Problem::new([sensitol_testing::dimension(line).unwrap()], Closure::scalar("y", move |x| f(x[0])));
        let warnings = analyze(&problem.unwrap(), &method.into()).unwrap().warnings;
        warnings.iter().map(|warning| warning.code()).collect::<Vec<_>>()
    };
    let film = "{ nominal = 0.5, distribution = \"exponential\" }";
    assert_eq!(codes(film, Method::SecondOrder, |x| x * x), ["support-edge", "long-tail"]);
    assert_eq!(codes(film, Method::SecondOrder, |x| 2.0 * x), ["support-edge"]);
    assert!(codes(film, Method::SixN, |x| x * x).is_empty(), "five points need not move, and reach far enough");
    let dirt = "{ nominal = 0.5, sigma = 0.25, distribution = \"lognormal\" }";
    assert_eq!(codes(dirt, Method::SixN, |x| (-x).exp()), ["long-tail", "higher-order"]);
    let slack = "{ nominal = 0.5, tolerance = 0.1, distribution = { kind = \"beta\", alpha = 2, beta = 5 } }";
    assert!(codes(slack, Method::SixN, |x| (-x).exp()).is_empty());
}

/// The example with a mixture, a truncated normal and an exponential, against product quadrature.
#[test]
fn two_suppliers_have_these_moments() {
    let truth = data("two-suppliers.json");
    let study = Study::read(&repository("examples/two-suppliers/study.toml")).unwrap();
    let moments = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics[0].moments.unwrap();
    let expected = |key: &str| truth[key].as_f64().unwrap();
    // The cosine of the tilt reduces the scatter of the depth by 4e-6 of it, a term of third order.
    relative(moments.mean(), expected("mean"), 1e-9);
    relative(moments.sigma(), expected("sigma"), 4e-6);
    close(moments.skewness().unwrap(), expected("skewness"), 4e-6, 1.0);
    close(moments.kurtosis().unwrap(), expected("kurtosis"), 4e-6, 1.0);
}
