//! Lots against studies: what is shifted is found and named, what is right is left alone, and what no part explains is said.

use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::assembly::Run;
use sensitol::lot::{LotColumn, LotComparison, LotError, LotOptions, LotTable, LotVerdict, compare_lot};
use sensitol::{Characteristic, Closure, Dimension, Method, Problem, SpecLimits};
use sensitol_numeric::correlation::Pair;
use sensitol_numeric::lot::{LotSample, fisher_sf, student_two_sided};
use sensitol_testing::close;

const NAMES: [&str; 3] = ["a", "b", "c"];
/// Assumed means and sigmas of the study.
const ASSUMED: [(f64, f64); 3] = [(10.0, 0.02), (4.0, 0.01), (5.0, 0.015)];

fn problem() -> Problem {
    let dimensions =
        NAMES.iter().zip(ASSUMED).map(|(name, (mean, sigma))| Dimension::normal(*name, mean, 3.0 * sigma).unwrap());
    let limits = SpecLimits::new(Some(0.9), Some(1.1)).unwrap();
    Problem::new(dimensions.collect::<Vec<_>>(), Closure::scalar("gap", |x| x[0] - x[1] - x[2]))
        .unwrap()
        .asking([Characteristic::new("gap").with_limits(limits)])
        .unwrap()
}

/// Parts and assemblies of a process with these means and sigmas. The model of the real assemblies has `missing` added.
fn lot(rng: &mut Xoshiro256PlusPlus, process: [(f64, f64); 3], counts: [usize; 2], missing: f64) -> [LotTable; 2] {
    let mut draw = |count: usize| -> Vec<Vec<f64>> {
        let column = |(mean, sigma): (f64, f64), rng: &mut Xoshiro256PlusPlus| {
            let law = Normal::new(mean, sigma).unwrap();
            (0..count).map(|_| law.sample(rng)).collect()
        };
        process.into_iter().map(|of| column(of, rng)).collect()
    };
    let (parts, others) = (draw(counts[0]), draw(counts[1]));
    let column = |name: &str, values: Vec<f64>| LotColumn {
        name: name.to_owned(),
        values: values.into_iter().map(Some).collect(),
    };
    let gaps = (0..counts[1]).map(|row| others[0][row] - others[1][row] - others[2][row] + missing).collect();
    let of_parts = NAMES.into_iter().zip(parts).map(|(name, values)| column(name, values)).collect();
    [
        LotTable { columns: of_parts, ..LotTable::default() },
        LotTable { columns: vec![column("gap", gaps)], ..LotTable::default() },
    ]
}

fn compared(tables: &[LotTable]) -> LotComparison {
    let options = LotOptions::default();
    compare_lot(&problem(), tables, &options, &Method::SecondOrder.into(), &Run::to_the_end()).unwrap()
}

/// 300 right lots: 5 % of them may be refuted, with a standard error of 1.3 %.
#[test]
fn right_studies_are_left_alone() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut refuted = 0;
    for _ in 0..300 {
        let found = compared(&lot(&mut rng, ASSUMED, [60, 40], 0.0));
        let departs = found.dimensions.iter().any(|one| one.departs(found.family_wise_level));
        refuted += usize::from(departs || found.characteristics[0].verdict != LotVerdict::AsAssumed);
    }
    assert!(refuted <= 27, "{refuted}");
}

/// `a` is 1.5 sigma too large. The difference of the linear prediction is the measured shift itself, and nothing remains.
#[test]
fn a_shifted_dimension_is_named() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut shifted = ASSUMED;
    shifted[0].0 += 0.03;
    let (mut named, mut held) = (0, 0);
    for _ in 0..200 {
        let found = compared(&lot(&mut rng, shifted, [60, 40], 0.0));
        let gap = &found.characteristics[0];
        let first = &gap.differences[0];
        close(first.mean.unwrap(), found.dimensions[0].mean.value - 10.0, 1e-9, 1e-9);
        close(gap.mean_remainder.unwrap(), 0.0, 1e-9, 1.0);
        close(gap.variance_remainder.unwrap(), 0.0, 1e-12, 1.0);
        named += usize::from(gap.verdict == LotVerdict::ByParts { dimension: Some("a".to_owned()) });
        // The true yield: mean 1.03, sigma 0.02693, so that 0.535 % lie above 1.1 by the normal distribution.
        let interval = gap.by_parts.unwrap().yield_interval.unwrap();
        held += usize::from(interval[0] <= 0.995_33 && 0.995_33 <= interval[1]);
    }
    assert!(named >= 190, "{named}");
    // 200 lots have a standard error of 1.5 %.
    assert!((180..=200).contains(&held), "{held}");
}

#[test]
fn a_missing_dimension_is_no_fault_of_the_parts() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let found = compared(&lot(&mut rng, ASSUMED, [60, 40], 0.04));
    assert_eq!(found.characteristics[0].verdict, LotVerdict::Unexplained { mean: true, sigma: false });
    assert!(found.dimensions.iter().all(|one| !one.departs(found.family_wise_level)));
    // Without parts nothing but the study stands beside the assemblies.
    let [_, assemblies] = lot(&mut rng, ASSUMED, [60, 40], 0.04);
    let found = compared(&[assemblies]);
    assert!(matches!(found.characteristics[0].verdict, LotVerdict::Unexplained { mean: true, .. }));
    assert_eq!(found.not_measured, NAMES);
    let gap = &found.characteristics[0];
    assert!(gap.by_parts.is_none() && gap.against_parts.is_none() && gap.differences.is_empty());
    // The assemblies' mean and sigma are tested once.
    assert_eq!(found.tests, 2);
}

/// Parts that vary together widen the difference of two of them.
#[test]
fn a_correlation_of_the_rows_enters_the_prediction() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
    let [mut parts, _] = lot(&mut rng, ASSUMED, [200, 5], 0.0);
    // `b` follows `a`: correlation 1/sqrt(2).
    let (a, b) = (parts.columns[0].values.clone(), parts.columns[1].values.clone());
    parts.columns[1].values = a
        .iter()
        .zip(&b)
        .map(|(a, b)| Some(4.0 + (0.5 * (a.unwrap() - 10.0) + b.unwrap() - 4.0) / 2f64.sqrt()))
        .collect();
    let found = compared(&[parts]);
    let pair = &found.correlations[0];
    assert!(pair.between == ["a", "b"] && pair.value.interval[0] < 0.707 && 0.707 < pair.value.interval[1]);
    let [a, b, c] = [0, 1, 2].map(|place: usize| found.dimensions[place].sigma.value);
    let expected = a * a + b * b + c * c - 2.0 * pair.value.value * a * b;
    close(found.characteristics[0].by_parts.unwrap().sigma, expected.sqrt(), 1e-6, 1.0);
}

fn table_of(columns: &[(&str, Vec<f64>)]) -> LotTable {
    let column = |(name, values): &(&str, Vec<f64>)| LotColumn {
        name: (*name).to_owned(),
        values: values.iter().copied().map(Some).collect(),
    };
    LotTable { columns: columns.iter().map(column).collect(), ..LotTable::default() }
}

fn normal_values(rng: &mut Xoshiro256PlusPlus, (mean, sigma): (f64, f64), count: usize) -> Vec<f64> {
    let law = Normal::new(mean, sigma).unwrap();
    (0..count).map(|_| law.sample(rng)).collect()
}

fn problem_of(dimensions: &[(&str, f64, f64)], name: &str, model: fn(&[f64]) -> f64) -> Problem {
    let normal = |(name, mean, sigma): &(&str, f64, f64)| Dimension::normal(*name, *mean, 3.0 * sigma).unwrap();
    Problem::new(dimensions.iter().map(normal).collect::<Vec<_>>(), Closure::scalar(name, model)).unwrap()
}

fn compared_with(problem: &Problem, tables: &[LotTable]) -> LotComparison {
    compare_lot(problem, tables, &LotOptions::default(), &Method::SecondOrder.into(), &Run::to_the_end()).unwrap()
}

/// The oracle is the gap of each row: the prediction by correlated parts is a sample of gaps, so that the tests are those of two samples,
/// by Welch and by Fisher. The differences of both programs are rounding, and 1e-6 leaves room for the derivatives of the model.
#[test]
fn correlated_parts_predict_like_the_gaps_of_their_rows() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let problem = problem_of(&[("a", 10.0, 0.03), ("b", 9.0, 0.02)], "gap", |x| x[0] - x[1]);
    let [rows, others] = [60, 40].map(|count| {
        let [common, own] = [0, 1].map(|_| normal_values(&mut rng, (0.0, 1.0), count));
        let a: Vec<f64> = common.iter().map(|u| 10.0 + 0.03 * u).collect();
        let b: Vec<f64> = common
            .iter()
            .zip(&own)
            .map(|(u, v)| 9.0 + 0.02 * (0.98 * u + (1.0 - 0.98_f64 * 0.98).sqrt() * v))
            .collect();
        [a, b]
    });
    let gaps = |[a, b]: &[Vec<f64>; 2]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    let [predicted, measured] = [&rows, &others].map(|of| LotSample::new(&gaps(of)).unwrap());
    let [a, b] = rows;
    let tables = [table_of(&[("a", a), ("b", b)]), table_of(&[("gap", measured.values().to_vec())])];
    let found = &compared_with(&problem, &tables).characteristics[0];
    let [mean, sigma] = found.against_parts.unwrap();
    let [own, part] = [&measured, &predicted].map(|of| of.sigma().powi(2) / of.count() as f64);
    let freedom = (own + part).powi(2) / (own * own / 39.0 + part * part / 59.0);
    let t = (measured.mean() - predicted.mean()) / (own + part).sqrt();
    close(mean.p, student_two_sided(t, freedom), 1e-6, 1e-6);
    let ratio = (measured.sigma() / predicted.sigma()).powi(2);
    let above = fisher_sf(ratio, [39.0, 59.0]);
    close(sigma.p, 2.0 * above.min(1.0 - above), 1e-6, 1e-6);
    let interval = found.by_parts.unwrap().mean_interval.unwrap();
    let expected = predicted.mean_figure().interval;
    close(interval[0], expected[0], 1e-6, 1e-3);
    close(interval[1], expected[1], 1e-6, 1e-3);
    assert!(!matches!(found.verdict, LotVerdict::Unexplained { .. }), "{:?}", found.verdict);
}

/// An assumed correlation that the rows do not refute counts with the measured sigmas: the mean has the variance of the rows' gaps, as
/// far as their correlation is the assumed one. 5 % of 200 right lots may be refuted, with a standard error of 1.6 %.
#[test]
fn assumed_correlations_are_counted() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
    let pair = Pair { between: ["a".to_owned(), "b".to_owned()], value: 0.9 };
    let problem = problem_of(&[("a", 10.0, 0.03), ("b", 9.0, 0.02)], "gap", |x| x[0] - x[1]);
    let problem = problem.jointly(&[pair], Vec::new()).unwrap();
    let mut refuted = 0;
    for _ in 0..200 {
        let [rows, others] = [60, 40].map(|count| {
            let [u, v] = [0, 1].map(|_| normal_values(&mut rng, (0.0, 1.0), count));
            let b: Vec<f64> =
                u.iter().zip(&v).map(|(u, v)| 9.0 + 0.02 * (0.9 * u + (1.0 - 0.81_f64).sqrt() * v)).collect();
            [u.iter().map(|u| 10.0 + 0.03 * u).collect::<Vec<f64>>(), b]
        });
        let gaps = others[0].iter().zip(&others[1]).map(|(a, b)| a - b).collect();
        let [a, b] = rows;
        let found = compared_with(&problem, &[table_of(&[("a", a), ("b", b)]), table_of(&[("gap", gaps)])]);
        let [mean, sigma] = found.characteristics[0].against_parts.unwrap();
        refuted += usize::from(mean.p <= 0.05) + usize::from(sigma.p <= 0.05);
    }
    // 400 tests of 5 % with a standard error of 1.1 %, by approximate degrees of freedom.
    assert!((6..=36).contains(&refuted), "{refuted}");
}

/// The square of a distance is exponential: its kurtosis is 9, and the variance of 60 values has the degrees of freedom of some 15 normal
/// ones. 5 % of 100 right lots may be refuted, with a standard error of 2.2 %; the degrees of freedom are approximate.
#[test]
fn the_spread_of_a_curved_characteristic_has_the_freedom_of_its_kurtosis() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let problem = problem_of(&[("x", 0.0, 1.0), ("y", 0.0, 1.0)], "q", |x| x[0] * x[0] + x[1] * x[1]);
    let (mut below, mut unexplained) = (0, 0);
    for _ in 0..100 {
        let [x, y, u, v] = [0; 4].map(|_| normal_values(&mut rng, (0.0, 1.0), 60));
        let q = u.iter().zip(&v).map(|(u, v)| u * u + v * v).collect();
        let found = compared_with(&problem, &[table_of(&[("x", x), ("y", y)]), table_of(&[("q", q)])]);
        let q = &found.characteristics[0];
        below += usize::from(q.against_parts.unwrap()[1].p <= 0.05);
        unexplained += usize::from(matches!(q.verdict, LotVerdict::Unexplained { .. }));
    }
    assert!(below <= 14 && unexplained <= 5, "{below} {unexplained}");
}

/// Five parts with the means of the study cannot explain assemblies that are off, even if their tests refute nothing.
#[test]
fn few_parts_explain_nothing() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
    let [_, assemblies] = lot(&mut rng, ASSUMED, [60, 40], 0.019);
    let around = |(mean, sigma): (f64, f64), order: [f64; 5]| order.map(|u| mean + sigma * u).to_vec();
    // Five values with the mean 0 and the sigma 1, in three orders.
    let (far, near) = (1.9_f64.sqrt(), 0.1_f64.sqrt());
    let parts = table_of(&[
        ("a", around(ASSUMED[0], [-far, -near, 0.0, near, far])),
        ("b", around(ASSUMED[1], [near, -far, far, 0.0, -near])),
        ("c", around(ASSUMED[2], [0.0, near, -near, far, -far])),
    ]);
    let found = compared(&[parts, assemblies]);
    let gap = &found.characteristics[0];
    assert!(gap.against_assumed.unwrap()[0].refutes(0.05), "the assemblies differ from the study");
    assert!(!gap.against_parts.unwrap()[0].refutes(0.05), "five parts refute nothing");
    assert_eq!(gap.verdict, LotVerdict::TooFewParts { mean: true, sigma: false });
}

#[test]
fn wrong_lots_are_refused() {
    let column = |name: &str, values: &[f64]| LotColumn {
        name: name.to_owned(),
        values: values.iter().copied().map(Some).collect(),
    };
    let refused = |columns: Vec<LotColumn>| {
        let table = LotTable { columns, ..LotTable::default() };
        compare_lot(&problem(), &[table], &LotOptions::default(), &Method::SecondOrder.into(), &Run::to_the_end())
            .unwrap_err()
    };
    let some = [1.0, 2.0, 3.0, 4.0, 5.0];
    assert_eq!(refused(Vec::new()), LotError::Nothing);
    assert_eq!(
        refused(vec![column("gapp", &some)]).to_string(),
        "the study has no dimension or characteristic `gapp`; did you mean `gap`?"
    );
    assert!(matches!(refused(vec![column("a", &some), column("a", &some)]), LotError::MeasuredTwice { .. }));
    assert!(matches!(refused(vec![column("a", &some[..4])]), LotError::TooFewParts { found: 4, .. }));
    assert!(matches!(refused(vec![column("a", &[1.0; 5])]), LotError::AllEqual { .. }));
    let options = LotOptions::default().with_assumed_parts(1.0);
    let table = LotTable { columns: vec![column("a", &some)], ..LotTable::default() };
    let found = compare_lot(&problem(), &[table], &options, &Method::SecondOrder.into(), &Run::to_the_end());
    assert!(matches!(found, Err(LotError::Choice { .. })));
}
