//! Plans: exact counts, every point once, realised steps, and failed points.

use proptest::prelude::*;
use sensitol::assembly::formula::Formula;
use sensitol::assembly::{Composite, Input, Parts};
use sensitol::distribution::{CentralMoments, Normal, Uniform};

use sensitol::method::registry::procedure;
use sensitol::method::{Pairs, Stencil};
use sensitol::plan::{Nodes, Spread};
use sensitol::{Analysis, Closure, Dimension, Method, Options, Problem, RunSummary, StopReason, analyze};
use sensitol_testing::{Asked, close, normals, refusing, relative, standard};

/// Returns the number of evaluations of a black box with `n` dimensions, and checks that each point is evaluated once.
fn count(n: usize, options: &Options) -> usize {
    let asked = Asked::default();
    let problem = Problem::new(standard(n), asked.watching(|x| x.iter().sum())).unwrap();
    let plan = procedure(options.method).plan(&problem, options).unwrap();
    let analysis = analyze(&problem, options).unwrap();
    assert_eq!(analysis.run.evaluations, asked.distinct() as u64);
    assert_eq!(analysis.run.evaluations, plan.cost().0 as u64, "the plan said otherwise");
    assert_eq!(analysis.run.stages, plan.cost().1 as u64);
    analysis.run.evaluations as usize
}

#[test]
fn counts_are_exact() {
    for n in 1..=12 {
        for method in [Method::Rss, Method::WorstCase, Method::SecondOrder] {
            assert_eq!(count(n, &method.into()), 2 * n + 1);
        }
        // Twelve check points, two points that measure the scatter, and two far out.
        assert_eq!(count(n, &Method::Auto.into()), 2 * n + 17);
        assert_eq!(count(n, &Method::Full.into()), n * n + n + 1);
        assert_eq!(count(n, &Method::Classic.into()), 2 * n * n + 1);
        // With fewer than three dimensions there are fewer than N pairs.
        let pairs = n.min(n * (n - 1) / 2);
        let six_n = Options::from(Method::SixN);
        assert_eq!(count(n, &six_n), 4 * n + 1 + 2 * pairs);
        assert_eq!(count(n, &six_n.clone().with_pairs(Pairs::Adjacent)), 4 * n + 1 + 2 * pairs);
        let papers = six_n.with_stencil(Stencil::FourPoint);
        assert_eq!(count(n, &papers), 2 * n + 1 + 4 * pairs);
    }
    insta::assert_snapshot!(
        [1, 2, 3, 10, 30].map(|n| {
            let counts = sensitol::method::registry::ALL.iter().map(|method| {
                let problem = Problem::new(standard(n), Closure::scalar("y", |x| x[0])).unwrap();
                match method.fits(&problem, &method.method().into()) {
                    Ok(_) => count(n, &method.method().into()).to_string(),
                    Err(error) => format!("({})", error.needed().unwrap()),
                }
            });
            format!("N = {n:2}: {}", counts.collect::<Vec<_>>().join(" "))
        }).join("\n"),
        @r"
    N =  1: 19 3 3 3 5 3 3 5 5 3 5
    N =  2: 21 5 5 5 11 7 9 9 25 9 9
    N =  3: 23 7 7 7 19 13 19 13 61 27 15
    N = 10: 37 21 21 21 61 111 201 41 761 59049 149
    N = 30: 77 61 61 61 181 931 1801 121 7081 (205891132094649) 2109
    "
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Pairs are those of dimensions that some characteristic has together, counted one by one, and `full` evaluates two points for each.
    #[test]
    fn pairs_are_those_that_a_characteristic_has_together(
        sets in prop::collection::vec(prop::collection::btree_set(0..9_usize, 1..6), 1..7)
    ) {
        let names: Vec<String> = (0..9).map(|d| format!("x{d}")).collect();
        let product = |(c, set): (usize, &std::collections::BTreeSet<usize>)| {
            let text = set.iter().map(|&d| names[d].as_str()).collect::<Vec<_>>().join("*");
            (format!("y{c}"), Formula::parse(&text).unwrap())
        };
        let parts = Parts {
            inputs: names.iter().map(|name| Input { name: name.clone(), unit: None }).collect(),
            formulas: sets.iter().enumerate().map(product).collect(),
            outputs: (0..sets.len()).map(|c| (format!("y{c}"), None)).collect(),
            ..Parts::default()
        };
        let dimensions = names.iter().map(|name| Dimension::normal(name, 1.0, 0.1).unwrap());
        let problem = Problem::new(dimensions, Composite::new(parts).unwrap()).unwrap();
        let together = |j: usize, k: usize| sets.iter().any(|set| set.contains(&j) && set.contains(&k));
        let pairs = (0..9).flat_map(|j| (j + 1..9).map(move |k| (j, k))).filter(|&(j, k)| together(j, k)).count();
        let varying = (0..9).filter(|d| sets.iter().any(|set| set.contains(d))).count();
        let plan = procedure(Method::Full).plan(&problem, &Method::Full.into()).unwrap();
        prop_assert_eq!(plan.possible_pairs(), pairs);
        prop_assert_eq!(plan.cost().0, 1 + 2 * varying + 2 * pairs);
    }
}

#[test]
fn an_asymmetric_band_costs_one_evaluation_more() {
    let dimensions =
        [Dimension::normal_between("a", 10.0, [-0.1, 0.3]).unwrap(), Dimension::normal("b", 5.0, 0.1).unwrap()];
    let asked = Asked::default();
    let problem = Problem::new(dimensions, asked.watching(|x| x[0] * x[1])).unwrap();
    let analysis = analyze(&problem, &Method::SecondOrder.into()).unwrap();
    assert_eq!(analysis.run.evaluations, 6);
    assert!(asked.points().contains(&vec![10.0, 5.0]), "the nominal point");
    assert!(asked.points().contains(&vec![10.1, 5.0]), "the means");
    let found = &analysis.characteristics[0];
    assert_eq!(found.nominal, Some(50.0));
    relative(found.moments.unwrap().mean(), 50.5, 1e-14);
}

/// A nominal value that is also a node is not evaluated twice.
#[test]
fn a_point_of_two_purposes_is_evaluated_once() {
    // The mean lies one sigma above the nominal value, and the step is one sigma.
    let shifted = Dimension::distributed("a", 9.0, None, std::sync::Arc::new(Normal::new(10.0, 1.0).unwrap())).unwrap();
    let asked = Asked::default();
    let problem = Problem::new([shifted], asked.watching(|x| x[0])).unwrap();
    let analysis = analyze(&problem, &Options::from(Method::SecondOrder).with_step(1.0)).unwrap();
    assert_eq!((analysis.run.evaluations, asked.distinct() as u64), (3, 3));
    assert_eq!(analysis.characteristics[0].nominal, Some(9.0));
}

#[test]
fn what_does_not_vary_costs_nothing() {
    let mut dimensions = standard(3);
    dimensions.insert(1, Dimension::fixed("fixed", 4.0).unwrap());
    dimensions.push(Dimension::normal("zero", 2.0, 0.0).unwrap());
    let asked = Asked::default();
    let problem = Problem::new(dimensions, asked.watching(|x| x[0] + x[1] * x[2] + x[3] * x[4])).unwrap();
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    assert_eq!((analysis.run.evaluations, analysis.varying), (13, 3));
    assert_eq!(analysis.characteristics[0].sensitivities[1].first, None);
    let all = Options::from(Method::Full).with_all_sensitivities(true);
    let analysis = analyze(&problem, &all).unwrap();
    assert_eq!(analysis.run.evaluations, 13 + 4);
    let fixed = &analysis.characteristics[0].sensitivities[4];
    relative(fixed.first.unwrap() + 1.0, 1.0, 1e-12);
    assert_eq!(fixed.linear_share, Some(0.0));
}

/// The nominal value is 1e10 sigma, so that the realised step differs from the wanted one. The derivative is right nevertheless.
#[test]
fn differences_are_divided_by_the_realised_step() {
    for mean in [1e3, 1e6, 1e10, 1e13] {
        let asked = Asked::default();
        let dimension = Dimension::normal("a", mean, 3.0).unwrap();
        let problem = Problem::new([dimension], asked.watching(move |x| 2.0 * (x[0] - mean))).unwrap();
        let analysis = analyze(&problem, &Method::SecondOrder.into()).unwrap();
        relative(analysis.characteristics[0].sensitivities[0].first.unwrap(), 2.0, 1e-15);
        relative(analysis.characteristics[0].moments.unwrap().sigma(), 2.0, 1e-15);
    }
}

#[test]
fn a_tolerance_that_vanishes_beside_the_nominal_is_refused() {
    let error = Dimension::normal("a", 1e10, 1e-8).unwrap_err();
    assert!(error.to_string().contains("too small beside the mean"), "{error}");
}

/// Matched nodes, together with the mean, integrate degree 4, and for symmetric inputs degree 5.
#[test]
fn pair_nodes_are_matched_to_the_moments() {
    let nodes = |distribution: &dyn sensitol::distribution::Distribution| Nodes::matched(distribution, Spread::Pair).u;
    let normal = nodes(&Normal::new(0.0, 1.0).unwrap());
    close(normal[1], 3f64.sqrt(), 1e-15, 0.0);
    let uniform = nodes(&Uniform::new(0.0, 1.0).unwrap());
    close(uniform[1], 1.8f64.sqrt(), 1e-15, 0.0);
    let skewed = CentralMoments::new(0.0, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0]).unwrap();
    let [a, b]: [f64; 2] = nodes(&skewed).try_into().unwrap();
    // Weights of the three-point rule with nodes a, 0, b, mean 0 and variance 1.
    let (wa, wb) = (1.0 / (a * (a - b)), 1.0 / (b * (b - a)));
    for (order, expected) in [(1, 0.0), (2, 1.0), (3, 2.0), (4, 9.0)] {
        close(wa * a.powi(order) + wb * b.powi(order), expected, 1e-14, 1.0);
    }
}

/// A distribution known by its moments has five points. One with few values has the pair instead.
#[test]
fn five_points_fall_back_where_there_are_none() {
    let two = CentralMoments::new(0.0, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0]).unwrap();
    assert_eq!(Nodes::matched(&two, Spread::Five), Nodes::matched(&two, Spread::Pair));
    let normal = CentralMoments::new(0.0, [1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0]).unwrap();
    close(Nodes::matched(&normal, Spread::Five).u[3], 2.856_970_013_872_806, 1e-12, 0.0);
}

#[test]
fn steps_can_be_set() {
    let asked = Asked::default();
    let mut dimensions = standard(2);
    dimensions[1] = dimensions[1].clone().with_step(0.25).unwrap();
    let problem = Problem::new(dimensions, asked.watching(|x| x[0] + x[1])).unwrap();
    analyze(&problem, &Options::from(Method::SixN).with_step(0.5)).unwrap();
    let along = |d: usize| {
        let on_axis = |point: &Vec<f64>| point[1 - d] == 0.0 && point[d] != 0.0;
        asked.points().iter().filter(|point| on_axis(point)).map(|point| point[d]).collect::<Vec<_>>()
    };
    assert_eq!(along(0), [-1.0, -0.5, 0.5, 1.0]);
    assert_eq!(along(1), [-0.5, -0.25, 0.25, 0.5]);
}

/// One stage has all points that are known in advance. Only the strongest pairs are evaluated later.
#[test]
fn stages_are_as_few_as_can_be() {
    let problem = Problem::new(standard(6), Closure::scalar("y", |x| x.iter().product())).unwrap();
    for (options, stages) in [
        (Options::from(Method::Full), 1),
        (Options::from(Method::Classic), 1),
        (Options::from(Method::SixN), 2),
        (Options::from(Method::SixN).with_pairs(Pairs::Adjacent), 1),
    ] {
        assert_eq!(analyze(&problem, &options).unwrap().run.stages, stages, "{options:?}");
    }
}

/// Points that no characteristic depends on are not evaluated, if the structure of the function is known.
#[test]
fn pairs_that_no_characteristic_shares_are_not_evaluated() {
    let study = sensitol_study::Study::from_toml(
        r#"
        [dimensions]
        a = { nominal = 1, tolerance = 0.1 }
        b = { nominal = 1, tolerance = 0.1 }
        c = { nominal = 1, tolerance = 0.1 }
        [characteristics]
        ab = { formula = "a*b" }
        bc = { formula = "b*c" }
        [analysis]
        method = "full"
        "#,
        "study.toml",
    )
    .unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    assert_eq!(analysis.run.evaluations, 1 + 6 + 2 * 2);
    assert_eq!(analysis.characteristics[0].contributions.possible_interactions, 1);
    assert_eq!(analysis.characteristics[0].contributions.left_out_share, Some(0.0));
    let alone = analyze(&study.problem.clone().only(&["ab"]).unwrap(), &study.options).unwrap();
    assert_eq!((alone.run.evaluations, alone.varying), (7, 2));
}

fn warnings(analysis: &Analysis, code: &str) -> usize {
    analysis.warnings.iter().filter(|warning| warning.code() == code).count()
}

/// A node at which the model fails is replaced by one at half the distance, and the derivative is as exact as before.
#[test]
fn a_failed_node_is_replaced_by_a_nearer_one() {
    let function = |x: &[f64]| 3.0 * x[0] + 0.5 * x[0] * x[0] + x[1];
    let problem = Problem::new(standard(2), refusing(function, |x| x[0] > 1.5)).unwrap();
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    let found = &analysis.characteristics[0];
    assert_eq!((found.sensitivities[0].first, analysis.run.failed), (Some(3.0), 2));
    relative(found.sensitivities[0].second.unwrap(), 1.0, 1e-14);
    relative(found.moments.unwrap().sigma(), (9.0f64 + 0.5 + 1.0).sqrt(), 1e-14);
    assert_eq!(warnings(&analysis, "domain-edge"), 1);
    assert_eq!(warnings(&analysis, "failed-points"), 1);
    assert_eq!(warnings(&analysis, "lost-derivative"), 0);
}

/// If a side fails at every distance, the curvature is lost. If both sides fail, the moments are lost.
#[test]
fn a_failed_side_costs_the_curvature_and_both_the_moments() {
    let function = |x: &[f64]| 3.0 * x[0] + x[1] * x[1];
    let one = Problem::new(standard(2), refusing(function, |x| x[0] > 0.0)).unwrap();
    let analysis = analyze(&one, &Method::SecondOrder.into()).unwrap();
    let found = &analysis.characteristics[0];
    relative(found.sensitivities[0].first.unwrap(), 3.0, 1e-14);
    assert_eq!((found.sensitivities[0].second, found.sensitivities[0].curvature_share), (None, None));
    assert_eq!(found.contributions.left_out_share, None);
    relative(found.moments.unwrap().sigma(), 11f64.sqrt(), 1e-14);
    assert_eq!(warnings(&analysis, "lost-derivative"), 1);

    let both = Problem::new(standard(2), refusing(function, |x| x[0] != 0.0)).unwrap();
    let analysis = analyze(&both, &Method::SecondOrder.into()).unwrap();
    let found = &analysis.characteristics[0];
    assert_eq!((found.moments, found.linear.rss, found.range.worst_case), (None, None, None));
    assert_eq!(found.sensitivities[1].second, Some(2.0), "the other dimension is known all the same");
    assert_eq!(warnings(&analysis, "lost-derivative"), 1);
}

#[test]
fn a_failed_corner_leaves_a_one_sided_interaction() {
    let function = |x: &[f64]| x[0] * x[1];
    let one = Problem::new(standard(2), refusing(function, |x| x[0] > 0.0 && x[1] > 0.0)).unwrap();
    let analysis = analyze(&one, &Method::Full.into()).unwrap();
    relative(analysis.characteristics[0].contributions.interactions.get(0).unwrap().mixed.unwrap(), 1.0, 1e-14);
    assert_eq!((warnings(&analysis, "lost-derivative"), analysis.run.failed), (1, 1));
    let both = Problem::new(standard(2), refusing(function, |x| x[0] * x[1] > 0.0)).unwrap();
    let analysis = analyze(&both, &Method::Full.into()).unwrap();
    let found = &analysis.characteristics[0];
    let pair = found.contributions.interactions.get(0).unwrap();
    assert_eq!((pair.mixed, pair.share, found.contributions.left_out_share), (None, None, None));
    // Two of four corners have a value.
    let analysis = analyze(&both, &Method::Classic.into()).unwrap();
    relative(analysis.characteristics[0].contributions.interactions.get(0).unwrap().mixed.unwrap(), 1.0, 1e-14);
}

#[test]
fn a_failed_centre_leaves_nothing() {
    let problem = Problem::new(standard(2), refusing(|x| x[0], |x| x.iter().all(|&x| x == 0.0))).unwrap();
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    let found = &analysis.characteristics[0];
    assert_eq!((found.moments, found.nominal, found.sensitivities[0].first), (None, None, None));
    assert_eq!(analysis.run.evaluations, 7, "nothing is gained by shorter steps");
    assert_eq!(warnings(&analysis, "failed-points"), 1);
}

/// A characteristic that fails does not affect another one at the same points.
#[test]
fn characteristics_fail_alone() {
    let function = |x: &[f64]| Ok([x[0] + x[1], (1.0 - x[0]).sqrt()]);
    let both = Problem::new(standard(2), Closure::fallible(["sum", "root"], function)).unwrap();
    let analysis = analyze(&both, &Method::SecondOrder.into()).unwrap();
    let alone = analyze(&both.only(&["sum"]).unwrap(), &Method::SecondOrder.into()).unwrap();
    assert_eq!(analysis.characteristics[0], alone.characteristics[0]);
    assert_eq!((alone.run.evaluations, analysis.run.evaluations), (5, 6));
    assert!(analysis.characteristics[1].moments.is_some());
}

/// Answers do not depend on the number of threads.
#[test]
fn threads_do_not_matter() {
    let n = 60;
    let means: Vec<f64> = (0..n).map(|i| 1.0 + 0.01 * i as f64).collect();
    let problem = || {
        let function = |x: &[f64]| x.iter().enumerate().map(|(i, x)| (x * (i + 1) as f64).sin() * x).product::<f64>();
        Problem::new(normals(&means, &vec![0.01; n]), Closure::scalar("y", function)).unwrap()
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut analysis = pool.install(|| analyze(&problem(), &Method::Full.into())).unwrap();
        analysis.run = RunSummary::default();
        analysis
    };
    assert_eq!(on(1), on(7));
}

#[test]
fn a_run_that_is_told_to_stop_stops() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let asked = AtomicUsize::new(0);
    let stop = || (asked.fetch_add(1, Ordering::Relaxed) >= 3).then_some(StopReason::TimeLimit);
    let run = sensitol::assembly::Run::to_the_end().stopping_when(&stop);
    let problem = Problem::new(standard(100), Closure::scalar("y", |x| x.iter().sum())).unwrap();
    let analysis = sensitol::analyze_with(&problem, &Method::Full.into(), &run).unwrap();
    assert_eq!(analysis.run.stopped, Some(StopReason::TimeLimit));
    assert!(analysis.run.evaluations > 0 && analysis.run.evaluations < 10_101, "{}", analysis.run.evaluations);
}
