//! True worst case: searched extremes against exhaustive enumeration, closed forms and random points.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::analysis::{Analysis, Extremes, Place};
use sensitol::assembly::Run;

use sensitol::warning::Ended;
use sensitol::{Closure, Dimension, Method, Options, Problem, StopReason, analyze, analyze_with};
use sensitol_study::Study;
use sensitol_testing::{
    Asked, among, close, normals, random_points, refusing, relative, repository, standard, vertices,
};

fn searched(problem: &Problem, method: Method) -> Analysis {
    analyze(problem, &Options::from(method).with_extremes(true)).unwrap()
}

/// Returns the extremes of a closure with one output.
fn of(
    dimensions: Vec<Dimension>,
    function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
    method: Method,
) -> Extremes {
    let problem = Problem::new(dimensions, Closure::scalar("y", function)).unwrap();
    searched(&problem, method).characteristics.remove(0).range.extremes.unwrap()
}

fn ends(extremes: &Extremes) -> [f64; 2] {
    [extremes.least.value, extremes.greatest.value]
}

fn places(extremes: &Extremes) -> [Vec<Place>; 2] {
    [&extremes.least, &extremes.greatest].map(|extreme| extreme.at.iter().map(|at| at.place).collect())
}

/// The extremes do not depend on the method, although each starts the search elsewhere. The expected values are the project's own figures
/// for this study, and no vertex or random point lies beyond them.
#[test]
fn the_engine_has_its_true_extremes() {
    let study = Study::read(&repository("examples/engine-balance/study.toml")).unwrap();
    let mut points = vertices(&study.problem);
    assert_eq!(points.len(), 1 << 10);
    points.extend(random_points(&study.problem, 100_000));
    points.push(study.problem.dimensions().iter().map(Dimension::nominal).collect());
    let sampled = among(&study.problem, &points);
    let mut counts = Vec::new();
    for method in [Method::Rss, Method::WorstCase, Method::SecondOrder, Method::SixN, Method::Full, Method::Classic] {
        let analysis = searched(&study.problem, method);
        let found: Vec<[f64; 2]> =
            analysis.characteristics.iter().map(|one| ends(one.range.extremes.as_ref().unwrap())).collect();
        // The published values have three decimals.
        for (found, published) in found.iter().zip([[12518.209, 12588.100], [936.988, 945.996]]) {
            for (found, published) in found.iter().zip(published) {
                assert!((found - published).abs() <= 0.0005, "{method:?}: {found} and {published}");
            }
        }
        for (found, sampled) in found.iter().zip(&sampled) {
            assert!(found[0] <= sampled[0] && sampled[1] <= found[1], "{method:?}: {found:?} and {sampled:?}");
        }
        counts.push(format!("{:<12} {}", method.name(), analysis.run.evaluations));
    }
    insta::assert_snapshot!("extremes-engine-counts", counts.join("\n"));
}

/// Two vertices and two points that test the surrogate are enough, for any number of dimensions.
#[test]
fn a_linear_characteristic_takes_four_evaluations() {
    for n in [2, 3, 10, 200] {
        let slope = move |j: usize| (j as f64 - 0.3 * n as f64 + 0.1) / n as f64;
        let function = move |x: &[f64]| 5.0 + x.iter().enumerate().map(|(j, x)| slope(j) * x).sum::<f64>();
        let asked = Asked::default();
        let problem = Problem::new(standard(n), asked.watching(function)).unwrap();
        let analysis = searched(&problem, Method::Rss);
        assert_eq!(analysis.run.evaluations, 2 * n as u64 + 1 + 4);
        assert_eq!(asked.distinct() as u64, analysis.run.evaluations);
        let one = &analysis.characteristics[0];
        let found = one.range.extremes.as_ref().unwrap();
        let reach: f64 = 3.0 * (0..n).map(|j| slope(j).abs()).sum::<f64>();
        // The tolerance allows about one rounding error for each of n terms.
        for (found, exact) in ends(found).into_iter().zip([5.0 - reach, 5.0 + reach]) {
            relative(found, exact, 4e-16 * n as f64);
        }
        for (found, linear) in ends(found).into_iter().zip(one.range.worst_case.unwrap()) {
            relative(found, linear, 1e-13);
        }
        let rising: Vec<Place> = (0..n).map(|j| if slope(j) > 0.0 { Place::Upper } else { Place::Lower }).collect();
        assert_eq!(places(found)[1], rising);
    }
}

#[test]
fn one_dimension_is_enough() {
    let linear = of(normals(&[10.0], &[0.3]), |x| 2.0 * x[0], Method::SecondOrder);
    assert_eq!((ends(&linear), linear.evaluations), ([19.4, 20.6], 3));
    // The vertex lies inside, at 10.1: the least value is interior, and the greatest is at the far end.
    let parabola = of(normals(&[10.0], &[0.3]), |x| (x[0] - 10.1).powi(2), Method::SecondOrder);
    // Near its vertex a parabola is as flat as the square of a rounding error of 10.
    close(parabola.least.value, 0.0, 1e-13, 1.0);
    relative(parabola.greatest.value, 0.16, 1e-12);
    assert_eq!(places(&parabola), [[Place::Interior], [Place::Lower]]);
    close(parabola.least.at[0].x, 10.1, 1e-7, 1.0);
}

/// Interior extremes: at the nominal, in a product of waves, and in a valley across the axes.
#[test]
fn extremes_within_the_box_are_found() {
    let at_nominal = of(normals(&[10.0, 3.0], &[0.3, 0.1]), |x| (x[0] - 10.0).powi(2) + x[1], Method::Full);
    close(at_nominal.least.value, 2.9, 1e-14, 1.0);
    assert_eq!(places(&at_nominal)[0], [Place::Interior, Place::Lower]);
    close(at_nominal.greatest.value, 3.19, 1e-14, 1.0);

    // cos(a) cos(b) is greatest at (0, 0) and least where one is 0 and the other -2 (cos 2 < 0).
    for method in [Method::SecondOrder, Method::Full] {
        let waves = of(normals(&[0.4, -0.5], &[2.4, 2.5]), |x| x[0].cos() * x[1].cos(), method);
        let least = [2.8f64, 3.0].map(f64::cos).into_iter().fold(f64::INFINITY, f64::min);
        // The search ends if a gain is below 1e-10 of the range.
        close(waves.greatest.value, 1.0, 1e-9, 1.0);
        close(waves.least.value, least, 1e-9, 1.0);
    }

    // A quadratic form with a strong product is least at its centre, far from the minimum along every axis.
    let valley = |x: &[f64]| (x[0] - 0.5).powi(2) + (x[1] + 0.7).powi(2) + 1.8 * (x[0] - 0.5) * (x[1] + 0.7);
    for method in [Method::SecondOrder, Method::SixN] {
        close(of(standard(2), valley, method).least.value, 0.0, 1e-8 * 40.0, 1.0);
    }
}

/// A piecewise linear function has its extremes at vertices or at the kink, which two straight lines locate.
#[test]
fn extremes_at_kinks_are_found() {
    for method in [Method::Rss, Method::SecondOrder, Method::SixN] {
        let v = of(normals(&[10.0], &[0.3]), |x| (x[0] - 10.07).abs(), method);
        close(v.least.value, 0.0, 1e-12, 1.0);
        close(v.greatest.value, 0.37, 1e-12, 1.0);
        let either = of(standard(3), |x| x[0].max(x[1]) - x[2].min(0.5), method);
        assert_eq!(ends(&either), [-3.5, 6.0], "{method:?}");
        // The minimum is where two kinks meet within the box, at (0.2, -1).
        let valley = of(standard(2), |x| (x[0] - 0.2).abs() + 2.0 * (x[1] + 1.0).abs(), method);
        close(valley.least.value, 0.0, 1e-12, 1.0);
        close(valley.greatest.value, 3.2 + 8.0, 1e-12, 1.0);
    }
}

/// Products whose factors have no slope of their own: all derivatives of `second-order` are 0.
#[test]
fn what_no_derivative_sees_is_found() {
    for pairs in [1, 3, 20] {
        let product = move |x: &[f64]| x.chunks(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
        let found = of(standard(2 * pairs), product, Method::SecondOrder);
        assert_eq!(ends(&found), [-9.0 * pairs as f64, 9.0 * pairs as f64]);
        // All pairs are found at once, not one after the other: a few rounds for either side.
        assert!(found.evaluations <= 40 * pairs + 60, "{pairs}: {}", found.evaluations);
    }
}

/// 200 dimensions, curved and with interactions. A snapshot of the counts shows when a search becomes more expensive.
#[test]
fn two_hundred_dimensions_stay_affordable() {
    let sum = |x: &[f64], factor: f64| x.iter().enumerate().map(|(j, x)| (1.0 + j as f64 * factor) * x).sum::<f64>();
    type Function = fn(&dyn Fn(&[f64], f64) -> f64, &[f64]) -> f64;
    let cases: [(&str, Function, [f64; 2]); 3] = [
        ("exponential of a sum", |sum, x| (sum(x, 0.0) / 200.0).exp(), [(-3f64).exp(), 3f64.exp()]),
        // 200 + 0.01 (0 + .. + 199) = 399 times 3; the quotient is monotonic in every dimension.
        ("quotient of sums", |sum, x| sum(x, 0.01) / (3600.0 + sum(x, 0.0)), [-1197.0 / 3000.0, 1197.0 / 4200.0]),
        ("sum of squares", |_, x| x.iter().map(|x| x * x).sum(), [0.0, 1800.0]),
    ];
    let mut counts = Vec::new();
    for (name, function, exact) in cases {
        let asked = Asked::default();
        let problem = Problem::new(standard(200), asked.watching(move |x| function(&sum, x))).unwrap();
        let analysis = searched(&problem, Method::SecondOrder);
        let found = analysis.characteristics[0].range.extremes.as_ref().unwrap();
        for (found, exact) in ends(found).into_iter().zip(exact) {
            close(found, exact, 1e-12, 1.0);
        }
        assert_eq!(asked.distinct() as u64, analysis.run.evaluations, "{name}");
        counts.push(format!("{name}: {} of {}", found.evaluations, analysis.run.evaluations));
    }
    insta::assert_snapshot!("extremes-two-hundred-counts", counts.join("\n"));
}

/// Extremes of a model that fails in part of the box are found among the points with a value, and a warning is given.
#[test]
fn vertices_that_fail_are_left_out() {
    // Defined within a circle: the extremes of a + b there are at (1, 1) sqrt(8)/sqrt(2) = +-4, on its rim.
    let problem = Problem::new(standard(2), refusing(|x| x[0] + x[1], |x| x[0].hypot(x[1]) > 8f64.sqrt())).unwrap();
    let analysis = searched(&problem, Method::SecondOrder);
    let found = analysis.characteristics[0].range.extremes.as_ref().unwrap();
    assert!(found.failed > 0 && found.failed < found.evaluations);
    assert!(ends(found).iter().all(|value| value.abs() <= 4.0 + 1e-12 && value.abs() > 3.0), "{:?}", ends(found));
    let warning = analysis.warnings.iter().find(|warning| warning.code() == "not-proven").unwrap().message();
    let expected = format!("{} of its points have no value and were left out: ", found.failed);
    assert!(warning.contains(&expected) && warning.contains("does not assemble"), "{warning}");

    let nowhere = Problem::new(standard(2), refusing(|x| x[0], |_| true)).unwrap();
    let analysis = searched(&nowhere, Method::SecondOrder);
    assert_eq!(analysis.characteristics[0].range.extremes, None);
}

/// Two characteristics share their points, and dimensions on which a characteristic cannot depend are not moved.
#[test]
fn points_are_shared_and_idle_dimensions_left_alone() {
    let study = "[dimensions]\na = { nominal = 1, tolerance = [0.1, 0.3] }\nb = { nominal = 2, sigma = 0.1 }\n\
                 c = { nominal = 3, tolerance = 0.1 }\nidle = { nominal = 4 }\n\
                 [characteristics]\nsum = { formula = \"a + b\" }\ntwice = { formula = \"2*a + 2*b\" }\nother = { formula = \"c + idle\" }\n\
                 [analysis]\nmethod = \"rss\"\nextremes = true\n";
    let study = Study::from_toml(study, "shared.toml").unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let found: Vec<&Extremes> =
        analysis.characteristics.iter().map(|one| one.range.extremes.as_ref().unwrap()).collect();
    for (found, [least, greatest]) in found.iter().zip([[2.8, 3.6], [5.6, 7.2], [6.9, 7.1]]) {
        close(found.least.value, least, 1e-14, 1.0);
        close(found.greatest.value, greatest, 1e-14, 1.0);
    }
    let names = |index: usize| found[index].least.at.iter().map(|at| at.dimension.as_str()).collect::<Vec<_>>();
    assert_eq!((names(0), names(2)), (vec!["a", "b"], vec!["c"]));
    assert_eq!((found[0].evaluations, found[1].evaluations, found[2].evaluations), (4, 4, 3));
    // 2N+1 evaluations for the method, one for the nominal off the means, four that both share, and three.
    assert_eq!(analysis.run.evaluations, 7 + 1 + 4 + 3);
}

/// The search may spend the rest of the budget, and reports the best values found by then.
#[test]
fn the_budget_holds() {
    let function = |x: &[f64]| x.iter().map(|x| x.sin()).product::<f64>();
    for left in [0, 1, 5, 17] {
        let asked = Asked::default();
        let problem = Problem::new(normals(&[0.5; 6], &[2.0; 6]), asked.watching(function)).unwrap();
        let options = Options::from(Method::SecondOrder).with_extremes(true).with_budget(13 + left);
        let analysis = analyze(&problem, &options).unwrap();
        assert_eq!((asked.distinct(), analysis.run.evaluations as usize), (13 + left, 13 + left));
        let found = analysis.characteristics[0].range.extremes.as_ref().unwrap();
        assert_eq!((found.ended, found.evaluations), (Ended::Budget, left));
        let warning = analysis.warnings.iter().find(|warning| warning.code() == "not-proven").unwrap().message();
        assert!(warning.contains("The budget ended the search."), "{warning}");
    }
}

/// A stop in the middle of the search ends all evaluations, and the extremes so far are reported.
#[test]
fn a_stop_is_heeded() {
    let count = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&count);
    let function = move |x: &[f64]| {
        counted.fetch_add(1, Ordering::Relaxed);
        x.iter().map(|x| x.sin()).product::<f64>()
    };
    let problem = Problem::new(normals(&[0.5; 6], &[2.0; 6]), Closure::scalar("y", function)).unwrap();
    let stop = || (count.load(Ordering::Relaxed) > 13).then_some(StopReason::TimeLimit);
    let options = Options::from(Method::SecondOrder).with_extremes(true);
    let analysis = analyze_with(&problem, &options, &Run::to_the_end().stopping_when(&stop)).unwrap();
    let found = analysis.characteristics[0].range.extremes.as_ref().unwrap();
    assert!(analysis.run.stopped.is_some() && found.ended == Ended::Stopped);
    assert_eq!(analysis.run.evaluations, count.load(Ordering::Relaxed) as u64);
    assert!(analysis.characteristics[0].moments.is_some());
}

/// Without the option there is no search.
#[test]
fn nothing_is_searched_unless_asked() {
    let problem = Problem::new(standard(2), Closure::scalar("y", |x| x[0] * x[1])).unwrap();
    let analysis = analyze(&problem, &Method::SecondOrder.into()).unwrap();
    assert_eq!((analysis.run.evaluations, &analysis.characteristics[0].range.extremes), (5, &None));
    assert!(analysis.warnings.iter().all(|warning| warning.code() != "not-proven"));
}

fn of_formula(dimensions: &str, formula: &str, method: Method) -> Extremes {
    let study = format!("[dimensions]\n{dimensions}\n[characteristics]\ny = {{ formula = \"{formula}\" }}\n");
    let study = Study::from_toml(&study, "y.toml").unwrap();
    searched(&study.problem, method).characteristics.remove(0).range.extremes.unwrap()
}

/// A proof depends on interval arithmetic alone. Its bounds lie beyond the extremes by no more than 1e-9 of their range.
#[test]
fn extremes_of_formulas_are_proven() {
    let abc = "a = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 2, tolerance = 0.1 }\nc = { nominal = -1, tolerance = [-0.1, 0.5] }";
    let cases: &[(&str, [f64; 2])] = &[
        ("a - 2*b + c", [9.7 - 4.2 - 1.1, 10.3 - 3.8 - 0.5]),
        // An interior extreme: 0 at a = 10.1, and (10.1 - 9.7)^2 at the far end.
        ("(a - 10.1)^2", [0.0, 0.16]),
        // Extremes along a line: 0 wherever a = 5 b.
        ("(a - 5*b)^2", [0.0, 0.64]),
        ("sin(a)*cos(b)", [0.0; 2]),
        ("abs(a - 10.07) + max(b, 2.05)", [2.05, 0.37 + 2.1]),
        ("if(a < 10, 1, 2) + c", [1.0 - 1.1, 2.0 - 0.5]),
        ("a/b^2 + exp(c/a)", [0.0; 2]),
        ("floor(a) - hypot(b, c)", [9.0 - 2.1f64.hypot(1.1), 10.0 - 1.9f64.hypot(0.5)]),
        ("5", [5.0, 5.0]),
    ];
    for &(formula, exact) in cases {
        for method in [Method::Rss, Method::SixN] {
            let found = of_formula(abc, formula, method);
            let proof = found.proof.as_ref().unwrap();
            assert!(found.proven(), "{formula}: {found:?}");
            let range = found.greatest.value - found.least.value;
            let allowed = 1e-9 * range + 1e-12 * found.least.value.abs().max(found.greatest.value.abs());
            assert!(found.least.value - allowed <= proof.bounds[0] && proof.bounds[0] <= found.least.value);
            assert!(found.greatest.value <= proof.bounds[1] && proof.bounds[1] <= found.greatest.value + allowed);
            for (found, exact) in ends(&found).into_iter().zip(exact).filter(|_| exact != [0.0; 2]) {
                close(found, exact, 1e-9, 1.0);
            }
        }
    }
}

/// A linear characteristic by formulas has the linear worst case, with four evaluations and a few boxes.
#[test]
fn linear_formulas_equal_the_linear_worst_case() {
    let study = Study::read(&repository("examples/quick-return-published/study.toml")).unwrap();
    let analysis = searched(&study.problem, Method::SecondOrder);
    for one in &analysis.characteristics {
        let found = one.range.extremes.as_ref().unwrap();
        assert!(found.proven() && found.evaluations == 4);
        // Two calls and the middle, for each side.
        assert_eq!(found.proof.as_ref().unwrap().boxes, 6);
        for (found, linear) in ends(found).into_iter().zip(one.range.worst_case.unwrap()) {
            relative(found, linear, 1e-13);
        }
    }
    assert!(analysis.warnings.iter().all(|warning| warning.code() != "not-proven"));
}

/// Closed form: the housing's coefficient is the greatest both where it is coldest and where it is hottest.
#[test]
fn thermal_clearance_has_its_extremes() {
    let study = Study::read(&repository("examples/thermal-clearance/study.toml")).unwrap();
    let least = 120.12 * (1.0 - 40.0 * 23.5e-6) - 120.02 * (1.0 - 40.0 * 11.2e-6);
    let greatest = 120.18 * (1.0 + 60.0 * 23.5e-6) - 119.86 * (1.0 + 60.0 * 11.2e-6);
    for method in [Method::Rss, Method::SecondOrder, Method::SixN, Method::Full] {
        let analysis = searched(&study.problem, method);
        let one = &analysis.characteristics[0];
        let found = one.range.extremes.as_ref().unwrap();
        assert!(found.proven(), "{method:?}");
        // The tolerance covers rounding errors of differences of lengths of 120.
        close(found.least.value, least, 1e-13, 1.0);
        close(found.greatest.value, greatest, 1e-13, 1.0);
        let linear = one.range.worst_case.unwrap();
        assert!(found.least.value < linear[0] && linear[1] < found.greatest.value);
    }
}

/// A search along coordinates ends in a valley beside the deepest one. The proof finds the deeper one, and the search continues from there.
#[test]
fn a_proof_mends_a_search() {
    // The deepest wave within -3 .. 3 is at -2.6, far from where the slope at 0 leads.
    let waves = "cos(3*a + 1.6) + 0.1*a + 0.02*(a + b)^2";
    let exact = |x: [f64; 2]| (3.0 * x[0] + 1.6).cos() + 0.1 * x[0] + 0.02 * (x[0] + x[1]).powi(2);
    let grid = |count: usize| (0..=count).map(move |i| -3.0 + 6.0 * i as f64 / count as f64);
    let sampled = grid(2000).flat_map(|a| grid(200).map(move |b| exact([a, b]))).fold(f64::INFINITY, f64::min);
    for method in [Method::Rss, Method::SecondOrder, Method::Full] {
        let found = of_formula("a = { nominal = 0, tolerance = 3 }\nb = { nominal = 0, tolerance = 3 }", waves, method);
        assert!(found.proven() && found.least.value <= sampled, "{found:?} and {sampled}");
        // The grid is accurate to its steps: slope and curvature below 10 over 0.0015.
        close(found.least.value, sampled, 1e-4, 1.0);
    }
}

/// The engine as formulas. Its least values are vertices and proven. The greatest lie along a line that no number of boxes covers. The
/// bounds state their greatest error.
#[test]
fn bounds_are_named_where_a_proof_does_not_end() {
    let angles: String = (1..=4)
        .map(|n| {
            format!(
                "phi{n} = {{ nominal = {}, tolerance = 0.00872 }}\n",
                [0.0, 1.0, 3.0, 2.0][n - 1] * std::f64::consts::PI
            )
        })
        .collect();
    let dimensions =
        format!("{angles}t = {{ nominal = 0, tolerance = 0.00872 }}\nR = {{ nominal = 0.0425, tolerance = 4e-5 }}");
    let share = |n: usize| format!("cos(t + phi{n}) + R/0.1345*cos(2*(t + phi{n}))");
    let formula = (1..=4).map(share).collect::<Vec<_>>().join(" + ");
    let found = of_formula(&dimensions, &formula, Method::SecondOrder);
    let proof = found.proof.as_ref().unwrap();
    assert!(!found.proven());
    close(proof.bounds[0], found.least.value, 1e-11, 1.0);
    assert!(proof.bounds[1] > found.greatest.value && proof.bounds[1] < found.greatest.value + 1e-3);
    // All shafts are at their place: 4 R/L, with R at its upper end.
    close(found.greatest.value, 4.0 * 0.04254 / 0.1345, 1e-9, 1.0);
}

/// A formula without a value in part of the box: the other values are enclosed.
#[test]
fn a_proof_leaves_out_what_has_no_value() {
    let found = of_formula("a = { nominal = 1, tolerance = 1.5 }", "2 - sqrt(a)", Method::SecondOrder);
    let proof = found.proof.as_ref().unwrap();
    assert!(found.failed > 0);
    relative(found.least.value, 2.0 - 2.5f64.sqrt(), 1e-12);
    // The greatest value, 2 at the very edge of the domain, is only approached.
    assert!(found.greatest.value > 1.9 && proof.bounds[1] >= found.greatest.value && proof.bounds[1] <= 2.0 + 1e-12);
}

/// Three sigma below the mean lies outside of an exponential distribution, which begins at its origin.
#[test]
fn extremes_stay_within_the_support() {
    let text = "[dimensions]\nx = { nominal = 1, distribution = \"exponential\" }\ny = { nominal = 5, tolerance = 0.1 }\n\
                [characteristics]\nz = { formula = \"y - sqrt(x)\" }\n";
    let study = Study::from_toml(text, "study.toml").unwrap();
    let found = searched(&study.problem, Method::SecondOrder).characteristics.remove(0).range.extremes.unwrap();
    for (found, expected) in ends(&found).into_iter().zip([4.9 - 2.0, 5.1]) {
        relative(found, expected, 1e-12);
    }
    assert_eq!((found.failed, found.proven()), (0, true));
}

/// Coordinates of a position stay within their circle: `3 x + 4 y` reaches 5 radii, not 7, and `x^2 - y^2 + x` the extremes of a scan along
/// the edge.
#[test]
fn positions_keep_their_circle() {
    let hole = || ["x", "y"].map(|name| Dimension::normal(name, 0.0, 0.1).unwrap().within_zone("hole")).to_vec();
    let straight = of(hole(), |at| 3.0 * at[0] + 4.0 * at[1], Method::SecondOrder);
    for (found, expected) in ends(&straight).into_iter().zip([-0.5, 0.5]) {
        close(found, expected, 1e-7, 1.0);
    }
    let saddle = |x: f64, y: f64| x * x - y * y + 0.05 * x;
    let found = of(hole(), move |at| saddle(at[0], at[1]), Method::SecondOrder);
    let edge = (0..100_000).map(|i| f64::from(i) * std::f64::consts::TAU / 1e5);
    let values: Vec<f64> = edge.map(|angle| saddle(0.1 * angle.cos(), 0.1 * angle.sin())).collect();
    let [least, greatest] =
        [values.iter().copied().fold(f64::INFINITY, f64::min), values.into_iter().fold(f64::MIN, f64::max)];
    let [low, high] = ends(&found);
    // The steps of the scan cause errors of 1e-11.
    close(low, least, 1e-6, 0.0);
    close(high, greatest, 1e-6, 0.0);
    for extreme in [&found.least, &found.greatest] {
        assert!(extreme.at[0].x.hypot(extreme.at[1].x) <= 0.1 * (1.0 + 1e-12));
    }
}

/// Function of a zone's two coordinates and of one more dimension.
type Planar = fn(f64, f64, f64) -> f64;

/// Formulas with extremes on the edge of a zone and inside it. Each is monotonic in `a`.
const PLANAR: [(&str, Planar); 6] = [
    ("a + x + y", |a, x, y| a + x + y),
    ("a + x - 0.4*y + x*y", |a, x, y| a + x - 0.4 * y + x * y),
    ("a + x^2 + 3*y^2 - x*y", |a, x, y| a + x * x + 3.0 * y * y - x * y),
    ("2*a + sin(7*x)*cos(5*y)", |a, x, y| 2.0 * a + (7.0 * x).sin() * (5.0 * y).cos()),
    ("a*exp(x) + abs(y - 0.05)", |a, x, y| a * x.exp() + (y - 0.05).abs()),
    ("a + hypot(x + 0.1, y)", |a, x, y| a + (x + 0.1).hypot(y)),
];

/// Points of a zone with half-widths 0.2 and 0.3, at distances of 1e-4 along its edge.
fn zone(law: &str) -> Vec<[f64; 2]> {
    let turn = |angle: f64, radius: f64| [0.2 * radius * angle.cos(), 0.3 * radius * angle.sin()];
    let angles = |count: usize| (0..count).map(move |k| std::f64::consts::TAU * k as f64 / count as f64);
    match law {
        "rim" => angles(20_000).map(|angle| turn(angle, 1.0)).collect(),
        "disc" => {
            let inner = (0..200).flat_map(|r| angles(400).map(move |angle| turn(angle, r as f64 / 200.0)));
            angles(20_000).map(|angle| turn(angle, 1.0)).chain(inner).collect()
        }
        _ => {
            let grid =
                (-200..=200).flat_map(|i| (-200..=200).map(move |j| [f64::from(i) / 200.0, f64::from(j) / 200.0]));
            let within = |[x, y]: &[f64; 2]| x.abs() + y.abs() <= 1.0;
            let edge = (0..=5000).flat_map(|k| {
                let x = f64::from(k) / 5000.0;
                [[x, 1.0 - x], [-x, 1.0 - x], [x, x - 1.0], [-x, x - 1.0]]
            });
            grid.filter(within).chain(edge).map(|[x, y]| [0.2 * x, 0.3 * y]).collect()
        }
    }
}

/// Coordinates that share a zone stay within it, also in a proof: no point lies beyond the proven ends, and some lie next to them. Within a
/// disc the samples are 1e-3 apart, which causes an error of the square of that at a stationary value.
#[test]
fn a_proof_over_a_zone_is_that_of_its_points() {
    for law in ["disc", "rim", "diamond"] {
        let points = zone(law);
        for (formula, value) in PLANAR {
            let text = format!(
                "[dimensions]\na = {{ nominal = 1, tolerance = 0.1 }}\nx = {{ nominal = 0, tolerance = 0.2 }}\n\
                 y = {{ nominal = 0, tolerance = 0.3 }}\n[[joint]]\nof = [\"x\", \"y\"]\nlaw = \"{law}\"\n\
                 [characteristics]\nf = {{ formula = \"{formula}\" }}\n"
            );
            let study = Study::from_toml(&text, "zone.toml").unwrap();
            let of = |a: f64| points.iter().map(move |[x, y]| value(a, *x, *y));
            let least = of(0.9).fold(f64::INFINITY, f64::min);
            let greatest = of(1.1).fold(f64::NEG_INFINITY, f64::max);
            let one = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0);
            let bounds = one.range.bounds.unwrap();
            let searched = searched(&study.problem, Method::Full).characteristics.remove(0).range.extremes.unwrap();
            for (what, proof) in [("bounds", &bounds), ("extremes", searched.proof.as_ref().unwrap())] {
                let [low, high] = proof.bounds;
                assert!(proof.proven, "{law}, {formula}, {what}: {proof:?}");
                assert!(
                    low <= least + 1e-12 && greatest <= high + 1e-12,
                    "{law}, {formula}, {what}: {proof:?} {least} {greatest}"
                );
                assert!(
                    least - low < 2e-5 && high - greatest < 2e-5,
                    "{law}, {formula}, {what}: {proof:?} {least} {greatest}"
                );
            }
        }
    }
}

/// Columns of one file without tolerances of their own have the measured rows as worst case. With a tolerance on the drawing every value of
/// the band is possible.
#[test]
fn measured_rows_are_the_worst_case_of_their_columns() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let rows: Vec<[f64; 2]> = (0..60)
        .map(|_| {
            let x: f64 = rng.random_range(-0.2..0.2);
            [x, 0.7 * x + rng.random_range(-0.05..0.05)]
        })
        .collect();
    let lines: Vec<String> = rows.iter().map(|[x, y]| format!("{x},{y}")).collect();
    std::fs::write(folder.path().join("rows.csv"), format!("x,y\n{}\n", lines.join("\n"))).unwrap();
    let of = |tolerances: [&str; 2], formula: &str| {
        let [x, y] = tolerances;
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.1 }}\nx = {{ measured = \"rows.csv\", column = \"x\"{x} }}\n\
             y = {{ measured = \"rows.csv\", column = \"y\"{y} }}\n[characteristics]\nf = {{ formula = \"{formula}\" }}\n"
        );
        let path = folder.path().join("study.toml");
        std::fs::write(&path, text).unwrap();
        let study = Study::read(&path).unwrap();
        let bounds = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0).range.bounds.unwrap();
        assert!(bounds.proven, "{formula}: {bounds:?}");
        bounds.bounds
    };
    let cases: [(&str, Planar); 3] = [
        ("a + x - y", |a, x, y| a + x - y),
        ("a + x*y - x", |a, x, y| a + x * y - x),
        ("a*cos(x) + 3*y^2", |a, x, y| a * x.cos() + 3.0 * y * y),
    ];
    for (formula, value) in cases {
        let [low, high] = of(["", ""], formula);
        let ends = |a: f64| rows.iter().map(move |[x, y]| value(a, *x, *y));
        let (least, greatest) = (ends(0.9).fold(f64::INFINITY, f64::min), ends(1.1).fold(f64::NEG_INFINITY, f64::max));
        close(low, least, 1e-6, 1.0);
        close(high, greatest, 1e-6, 1.0);
    }
    let bands = [", nominal = 0, tolerance = 0.2", ", nominal = 0, tolerance = 0.2"];
    let [low, high] = of(bands, "a + x - y");
    close(low, 0.9 - 0.4, 1e-9, 1.0);
    close(high, 1.1 + 0.4, 1e-9, 1.0);
}

/// A required worst case holds over the zone: the cheapest tolerances use all of the limits, by the closed form of a disc.
#[test]
fn a_required_worst_case_is_that_of_the_zone() {
    use sensitol::allocation::{AllocationOptions, Status, allocate};
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.05 }\nh = { nominal = [0, 0], position = 0.1 }\n[characteristics]\n\
                y = { formula = \"a + h_x + h_y + 0.5*h_x*h_y\", upper = 1.2, require = \"worst-case\" }\n[costs]\n\
                a = { model = \"reciprocal\", b = 0.1 }\nh = { model = \"reciprocal\", b = 0.1 }\n";
    let study = Study::from_toml(text, "zone.toml").unwrap();
    let options = AllocationOptions::default().with_analysis(study.options.clone());
    let found = allocate(&study.problem, &study.allocation_task(), &options).unwrap();
    let half = |name: &str| {
        let all = found.problem.dimensions();
        all.iter().find(|dimension| dimension.name() == name).unwrap().half_band()
    };
    let (a, r) = (half("a"), half("h_x"));
    // The value is greatest if both coordinates are r/sqrt 2.
    let greatest = 1.0 + a + 2f64.sqrt() * r + 0.25 * r * r;
    assert!(greatest <= 1.2 + 1e-6 && greatest > 1.2 - 1e-3, "{greatest}");
    assert!(!matches!(found.status, Status::Optimal | Status::NoFeasiblePointFound), "{:?}", found.status);
    assert!(found.cost_after.unwrap() < found.cost_before.unwrap());
}
