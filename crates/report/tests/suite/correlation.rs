//! Correlated inputs: closed forms, Gauss rules over the normal variables, and impossible correlations.

use faer::Mat;
use proptest::prelude::*;
use sensitol::correlation::{Correlation, Pair, Refusal};
use sensitol::distribution::{CentralMoments, Distribution, Exponential, Gamma, Normal, Triangular, Uniform};
use sensitol_numeric::correlation::transform::Transform;

use sensitol::{Characteristic, Closure, Dimension, Method, Moments, Problem, analyze};
use sensitol_report::{About, Report};
use sensitol_study::Study;
use sensitol_testing::{close, normals, relative, standard};

fn pair(a: &str, b: &str, value: f64) -> Pair {
    Pair { between: [a.to_owned(), b.to_owned()], value }
}

fn refused(dimensions: &[Dimension], pairs: &[Pair]) -> Refusal {
    Correlation::new(dimensions, pairs).unwrap_err().refusal
}

/// Moments of `b'u + u'Hu` of correlated standard normals from traces (Searle 1971, theorem 2.5.1, with a linear term):
/// `kappa_1 = tr(HR)`, `kappa_r = 2^(r-1) (r-1)! tr((HR)^r) + 2^(r-2) r!/1 b'R(HR)^(r-2)b ...`, written out.
fn by_traces(b: &[f64], h: &Mat<f64>, r: &Mat<f64>) -> [f64; 4] {
    let n = b.len();
    let b = Mat::from_fn(n, 1, |j, _| b[j]);
    let hr = h * r;
    let trace = |of: &Mat<f64>| (0..n).map(|j| of[(j, j)]).sum::<f64>();
    let around = |of: &Mat<f64>| (b.transpose() * r * of * &b)[(0, 0)];
    let (hr2, identity) = (&hr * &hr, Mat::identity(n, n));
    let (hr3, hr4) = (&hr2 * &hr, &hr2 * &hr2);
    [
        trace(&hr),
        around(&identity) + 2.0 * trace(&hr2),
        6.0 * around(&hr) + 8.0 * trace(&hr3),
        48.0 * around(&hr2) + 48.0 * trace(&hr4),
    ]
}

/// Returns a correlation matrix of `n` inputs from any numbers: `G G'` with rows of length 1.
fn matrix(n: usize, numbers: &[f64]) -> Mat<f64> {
    let g = Mat::from_fn(n, n + 1, |j, k| numbers[(j * (n + 1) + k) % numbers.len()] + f64::from(u8::from(k == n)));
    let row = |j: usize| (0..=n).map(|k| g[(j, k)] * g[(j, k)]).sum::<f64>().sqrt();
    Mat::from_fn(n, n, |j, k| match j == k {
        true => 1.0,
        false => (0..=n).map(|l| g[(j, l)] * g[(k, l)]).sum::<f64>() / row(j) / row(k),
    })
}

fn pairs_of(r: &Mat<f64>) -> Vec<Pair> {
    let n = r.nrows();
    let pairs = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k)));
    pairs.map(|(j, k)| pair(&format!("x{j}"), &format!("x{k}"), r[(j, k)])).collect()
}

fn quadratic(b: Vec<f64>, h: Mat<f64>) -> Closure {
    Closure::scalar("y", move |x: &[f64]| {
        let n = x.len();
        let form = (0..n).flat_map(|j| (0..n).map(move |k| (j, k))).map(|(j, k)| h[(j, k)] * x[j] * x[k]).sum::<f64>();
        form + b.iter().zip(x).map(|(b, x)| b * x).sum::<f64>()
    })
}

fn of(moments: Moments) -> [f64; 4] {
    [moments.mean(), moments.sigma(), moments.skewness().unwrap(), moments.excess().unwrap()]
}

proptest! {
    /// Quadratics of correlated normal inputs are exact for any matrix.
    #[test]
    fn quadratics_of_normals_are_exact(
        n in 2..6usize,
        numbers in prop::collection::vec(-1.0..1.0f64, 60),
    ) {
        let b = numbers[..n].to_vec();
        let h = Mat::from_fn(n, n, |j, k| numbers[6 + j.max(k) * 6 + j.min(k)]);
        let r = matrix(n, &numbers[20..]);
        let problem = Problem::new(standard(n), quadratic(b.clone(), h.clone())).unwrap();
        let problem = problem.correlated(&pairs_of(&r)).unwrap();
        let found = &analyze(&problem, &Method::Full.into()).unwrap().characteristics[0];
        let [mean, k2, k3, k4] = by_traces(&b, &h, &r);
        let [m, s, g, k] = of(found.moments.unwrap());
        // Sigma is of the order of the largest coefficient. Differences of values add some rounding.
        close(m, mean, 1e-12, 1.0);
        close(s * s, k2, 1e-12, 1.0);
        close(g * s.powi(3), k3, 1e-12, 10.0);
        close(k * s.powi(4), k4, 1e-12, 100.0);
        prop_assert!(found.evidence.sampled.is_none());
        let own: f64 = (0..n).map(|d| found.share(d).unwrap()).sum();
        let together: f64 = found.contributions.interactions.iter().map(|interaction| interaction.share.unwrap()).sum();
        close(own + together, 1.0, 1e-12, 0.0);
        let shifts: f64 = found.sensitivities.iter().map(|row| row.mean_shift.unwrap()).sum::<f64>()
            + found.contributions.interactions.iter().map(|interaction| interaction.mean_shift.unwrap()).sum::<f64>();
        close(shifts, mean, 1e-12, 1.0);
    }
}

/// Two inputs with correlation 1 act as one: `a + b` is `2 a`, and `a - b` is 0.
#[test]
fn full_correlation_is_one_input() {
    let of = |sign: f64, value: f64| {
        let problem = Problem::new(standard(2), Closure::scalar("y", move |x| x[0] + sign * x[1])).unwrap();
        let problem = problem.correlated(&[pair("x0", "x1", value)]).unwrap();
        let found = analyze(&problem, &Method::Full.into()).unwrap().characteristics.remove(0);
        (found.moments.unwrap().sigma(), found.linear.rss.unwrap())
    };
    for (sign, value, sigma) in [(1.0, 1.0, 2.0), (-1.0, -1.0, 2.0), (1.0, 0.5, 3f64.sqrt())] {
        relative(of(sign, value).0, sigma, 1e-15);
        relative(of(sign, value).1, 3.0 * sigma, 1e-15);
    }
    assert_eq!(of(-1.0, 1.0), (0.0, 0.0));
}

/// Two correlated normals, a uniform and a distribution known by moments, all interacting. The reference is Gauss rules, which integrate
/// the fourth power of a quadratic exactly.
#[test]
fn correlated_and_independent_inputs_mix() {
    let y = |a: f64, b: f64, c: f64, d: f64| {
        a + 0.5 * b - c + 0.2 * a * a + 0.3 * a * b - 0.4 * b * c + 0.1 * c * c + 0.2 * c * d + 0.3 * d * d
    };
    let skewed = CentralMoments::new(0.0, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0]).unwrap();
    let rule = skewed.jacobi(4).gauss_with_mean().unwrap();
    let dimensions = [
        Dimension::normal("a", 0.0, 3.0).unwrap(),
        Dimension::uniform("c", 0.0, 3f64.sqrt()).unwrap(),
        Dimension::normal("b", 0.0, 3.0).unwrap(),
        Dimension::distributed("d", 0.0, None, std::sync::Arc::new(skewed)).unwrap(),
    ];
    let problem = Problem::new(dimensions, Closure::scalar("y", move |x| y(x[0], x[2], x[1], x[3]))).unwrap();
    let problem = problem.correlated(&[pair("b", "a", -0.7)]).unwrap();
    let found = &analyze(&problem, &Method::Full.into()).unwrap().characteristics[0];
    let (normal, uniform) =
        (Normal::new(0.0, 1.0).unwrap().jacobi(6).gauss(), Uniform::new(-1.0, 1.0).unwrap().jacobi(6).gauss());
    let expect = |f: &dyn Fn(f64) -> f64| {
        normal.mean(|v| {
            normal.mean(|w| {
                let (a, b) = (v, -0.7 * v + (1.0f64 - 0.49).sqrt() * w);
                uniform.mean(|c| rule.mean(|d| f(y(a, b, c, d))))
            })
        })
    };
    let mean = expect(&|y| y);
    let central = |order: i32| expect(&|y| (y - mean).powi(order));
    let [m, s, g, k] = of(found.moments.unwrap());
    relative(m, mean, 1e-13);
    relative(s, central(2).sqrt(), 1e-13);
    relative(g, central(3) / central(2).powf(1.5), 1e-12);
    relative(k + 3.0, central(4) / central(2).powi(2), 1e-12);
    assert!(found.evidence.sampled.is_none());
    let shares: f64 = (0..4).map(|d| found.share(d).unwrap()).sum::<f64>()
        + found.contributions.interactions.iter().map(|interaction| interaction.share.unwrap()).sum::<f64>();
    close(shares, 1.0, 1e-12, 0.0);
}

/// Correlations of Nataf's normal variables that are known in closed form (Liu and Der Kiureghian 1986, table 4).
#[test]
fn normal_variables_are_correlated_as_in_closed_form() {
    let normal = Transform::of(&Normal::new(3.0, 0.1).unwrap()).unwrap();
    let uniform = Transform::of(&Uniform::new(5.0, 9.0).unwrap()).unwrap();
    for value in [-0.9, -0.3, 0.0, 0.1, 0.6, 0.95] {
        let of_uniforms = 2.0 * (std::f64::consts::PI * value / 6.0).sin();
        close(uniform.behind(&uniform, value).unwrap(), of_uniforms, 1e-12, 1.0);
        close(normal.behind(&uniform, value).unwrap(), value * (std::f64::consts::PI / 3.0).sqrt(), 1e-12, 1.0);
        assert_eq!(normal.behind(&normal, value), Ok(value));
    }
    // Greatest correlation of a normal and a uniform variable: sqrt(3/pi).
    let [least, most] = normal.behind(&uniform, 0.99).unwrap_err();
    close(most, (3.0 / std::f64::consts::PI).sqrt(), 1e-12, 1.0);
    close(least, -most, 1e-15, 1.0);
    relative(uniform.behind(&uniform, 1.0).unwrap(), 1.0, 1e-6);
}

/// The table between its places, and the omitted terms of the series, against the quantiles themselves.
#[test]
fn the_table_and_the_series_of_a_transform_are_good() {
    let laws: [Box<dyn Distribution>; 4] = [
        Box::new(Uniform::new(0.0, 1.0).unwrap()),
        Box::new(Exponential::new(0.0, 1.0).unwrap()),
        Box::new(Gamma::new(0.0, 1.0, 0.5).unwrap()),
        Box::new(Triangular::new(0.0, 0.3, 1.0).unwrap()),
    ];
    for law in &laws {
        let (transform, whole) = (Transform::of(&**law).unwrap(), law.probability().unwrap());
        for i in 0..400 {
            let z = -5.0 + 0.025_13 * f64::from(i);
            let half = 0.5 * libm::erfc(z.abs() / 2f64.sqrt());
            let x = if z < 0.0 { whole.quantile(half) } else { whole.upper_quantile(half) };
            // A cubic over 1/64. The mode of a triangle is a jump of the second derivative, which leaves an error of second order there.
            let allowed = if law.name() == "triangular" { 1e-6 } else { 1e-8 };
            close(transform.value(z), (x - law.mean()) / law.sigma(), allowed, 1.0);
        }
        // An input has correlation 1 with itself. The series at 1 omits the terms after its last one.
        let left_out = if law.name() == "triangular" { 1e-7 } else { 1e-14 };
        relative(transform.seen(&transform, 1.0), 1.0, left_out);
    }
}

/// Expectation over two correlated normal variables by the trapezoidal rule, which exceeds double precision for smooth functions.
fn over_two(r: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let (step, places) = (1.0 / 16.0, 160);
    let density = |v: f64| (-0.5 * v * v).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let grid = || (-places..=places).map(|i| step * f64::from(i));
    let inner = |v: f64| grid().map(|w| f(v, r * v + (1.0 - r * r).sqrt() * w) * density(w)).sum::<f64>();
    grid().map(|v| inner(v) * density(v)).sum::<f64>() * step * step
}

/// Uniform inputs and parts of third and fourth degree are sampled from the surrogate: within their standard errors.
#[test]
fn sampled_moments_keep_their_standard_errors() {
    let uniform = |z: f64| 3f64.sqrt() * libm::erf(z / 2f64.sqrt());
    let value = 0.5;
    let behind = 2.0 * (std::f64::consts::PI * value / 6.0).sin();
    type Case = (Vec<Dimension>, Method, fn(f64, f64) -> f64);
    let uniforms = || ["a", "b"].map(|name| Dimension::uniform(name, 0.0, 3f64.sqrt()).unwrap()).to_vec();
    let normals = || ["a", "b"].map(|name| Dimension::normal(name, 0.0, 3.0).unwrap()).to_vec();
    let cases: [(Case, f64, bool); 4] = [
        ((uniforms(), Method::Full, |a, b| 2.0 * a + b), behind, true),
        ((uniforms(), Method::Full, |a, b| a + 0.5 * b + a * b + 0.2 * a * a), behind, true),
        ((normals(), Method::SixN, |a, b| a + 0.1 * a * a * a + b - 0.05 * b.powi(4) + 0.3 * a * b), value, false),
        ((normals(), Method::SixN, |a, b| 0.2 * a * a * a + 0.1 * b * b), value, false),
    ];
    for (index, ((dimensions, method, y), r, flat)) in cases.into_iter().enumerate() {
        let problem = Problem::new(dimensions, Closure::scalar("y", move |x| y(x[0], x[1]))).unwrap();
        let problem = problem.correlated(&[pair("a", "b", value)]).unwrap();
        let found = &analyze(&problem, &method.into()).unwrap().characteristics[0];
        let sampled = found.evidence.sampled.expect("not exact");
        let expect = |f: &dyn Fn(f64) -> f64| match flat {
            true => over_two(r, |a, b| f(y(uniform(a), uniform(b)))),
            false => over_two(r, |a, b| f(y(a, b))),
        };
        let mean = expect(&|y| y);
        let central = |order: i32| expect(&|y| (y - mean).powi(order));
        let [m, s, g, k] = of(found.moments.unwrap());
        close(m, mean, 1e-12, 1.0);
        let exact = [central(2).sqrt(), central(3) / central(2).powf(1.5), central(4) / central(2).powi(2) - 3.0];
        for (found, expected, error) in
            [(s, exact[0], sampled.sigma), (g, exact[1], sampled.skewness), (k, exact[2], sampled.kurtosis)]
        {
            // Four standard errors. The sample is fixed, so this always holds.
            assert!((found - expected).abs() <= 4.0 * error + 1e-12, "case {index}: {found} {expected} +- {error}");
        }
        // Plain sampling has sqrt((kurtosis - 1)/(4 n)) of sigma. The controls are never worse.
        let plain = s * ((exact[2] + 2.0) / 4.0 / sampled.samples as f64).sqrt();
        assert!(sampled.sigma < plain, "case {index}: {} against {plain}", sampled.sigma);
        let shares: f64 = (0..2).map(|d| found.share(d).unwrap()).sum::<f64>()
            + found.contributions.interactions.iter().map(|interaction| interaction.share.unwrap()).sum::<f64>();
        close(shares, 1.0, 1e-12, 0.0);
        if index == 0 {
            // A linear function needs no sample for its variance.
            relative(s * s, 4.0 + 1.0 + 4.0 * value, 1e-14);
        }
    }
}

#[test]
fn the_sample_is_the_same_for_any_number_of_threads() {
    let uniforms = ["a", "b"].map(|name| Dimension::uniform(name, 0.0, 1.0).unwrap());
    let problem = Problem::new(uniforms, Closure::scalar("y", |x| x[0] * x[1] + x[0])).unwrap();
    let problem = problem.correlated(&[pair("a", "b", 0.3)]).unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| analyze(&problem, &Method::Full.into()).unwrap().characteristics[0].moments)
    };
    assert_eq!(with(1), with(3));
}

/// A dimension without effect is removed with its correlations. The order of dimensions does not matter.
#[test]
fn only_what_matters_is_correlated() {
    let y = || Closure::scalar("y", |x| x[0] * x[1]);
    let tolerances = [0.3, 0.6];
    let plain =
        Problem::new(normals(&[3.0, 2.0], &tolerances), y()).unwrap().correlated(&[pair("x0", "x1", 0.5)]).unwrap();
    let moments =
        |problem: &Problem| analyze(problem, &Method::Full.into()).unwrap().characteristics[0].moments.unwrap();
    let text = "[dimensions]\nz = { nominal = 0, tolerance = 1 }\nb = { nominal = 2, tolerance = 0.6 }\n\
                a = { nominal = 3, tolerance = 0.3 }\n[characteristics]\ny = { formula = \"a*b\" }\n\
                [[correlation]]\nbetween = [\"z\", \"a\"]\nvalue = 0.2\n[[correlation]]\nbetween = [\"a\", \"b\"]\nvalue = 0.5\n";
    let study = Study::from_toml(text, "study.toml").unwrap();
    let (expected, found) = (of(moments(&plain)), of(moments(&study.problem)));
    for (found, expected) in found.into_iter().zip(expected) {
        relative(found, expected, 1e-13);
    }
    let alone = text.replace("a*b", "a");
    let study = Study::from_toml(&alone, "study.toml").unwrap();
    relative(moments(&study.problem).sigma(), 0.1, 1e-13);
}

/// Example of Higham (2002, section 4): its nearest matrix has 0.7607 and 0.1573.
#[test]
fn contradictions_name_the_nearest_matrix() {
    let pairs = [pair("x0", "x1", 1.0), pair("x1", "x2", 1.0)];
    let Refusal::NoSuchMatrix { nearest } = refused(&standard(3), &pairs) else { panic!("no such matrix") };
    let values: Vec<f64> = nearest.iter().map(|(_, value)| *value).collect();
    for (found, expected) in values.into_iter().zip([0.760_689_9, 0.157_298_0, 0.760_689_9]) {
        close(found, expected, 1e-6, 1.0);
    }
}

#[test]
fn what_cannot_be_correlated_is_refused() {
    let moments = CentralMoments::new(0.0, [1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0]).unwrap();
    let dimensions = [
        Dimension::normal("a", 1.0, 0.1).unwrap(),
        Dimension::uniform("b", 1.0, 0.1).unwrap(),
        Dimension::fixed("still", 1.0).unwrap(),
        Dimension::distributed("known", 0.0, None, std::sync::Arc::new(moments)).unwrap(),
        Dimension::uniform("c", 1.0, 0.1).unwrap(),
    ];
    let one = |a: &str, b: &str, value: f64| refused(&dimensions, &[pair(a, b, value)]);
    assert!(matches!(one("a", "bb", 0.1), Refusal::UnknownDimension { nearest: Some(name), .. } if name == "b"));
    assert!(matches!(one("a", "still", 0.1), Refusal::DoesNotVary { .. }));
    assert!(matches!(one("known", "a", 0.1), Refusal::MomentsOnly { .. }));
    assert!(matches!(one("a", "a", 0.1), Refusal::WithItself { .. }));
    assert!(matches!(one("a", "b", 1.1), Refusal::NoCoefficient { .. }));
    assert!(matches!(one("a", "b", f64::NAN), Refusal::NoCoefficient { .. }));
    assert!(matches!(one("a", "b", 0.98), Refusal::Unreachable { .. }));
    let twice = [pair("a", "b", 0.1), pair("b", "a", 0.1)];
    assert!(matches!(refused(&dimensions, &twice), Refusal::Twice { .. }));
    assert_eq!(Correlation::new(&dimensions, &twice).unwrap_err().pair, Some(1));
    // A correlation that is possible for uniform variables, but not for any normal variables behind them.
    let tight = [pair("b", "a", 0.97), pair("c", "a", -0.97), pair("b", "c", -0.9)];
    let Refusal::NotForTheseDistributions { nearest } = refused(&dimensions, &tight) else { panic!("too tight") };
    assert!(nearest.iter().all(|(_, value)| value.abs() < 0.98));
}

#[test]
fn correlations_at_fault() {
    let head = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 1, tolerance = 0.1, distribution = \"uniform\" }\n\
                c = { nominal = 1, tolerance = 0.1 }\nd = { nominal = 1 }\n[characteristics]\ny = { formula = \"a + b + c + d\" }\n";
    let with = |rest: &str| format!("{head}{rest}");
    let between =
        |a: &str, b: &str, value: &str| format!("[[correlation]]\nbetween = [\"{a}\", \"{b}\"]\nvalue = {value}\n");
    let texts = [
        with(&between("a", "bb", "0.5")),
        with(&between("a", "d", "0.5")),
        with(&between("a", "a", "0.5")),
        with(&between("a", "b", "1.5")),
        with(&between("a", "b", "\"0.5\"")),
        with(&between("a", "b", "0.99")),
        with(&(between("a", "b", "0.5") + &between("b", "a", "0.5"))),
        with(&(between("a", "b", "0.9") + &between("b", "c", "0.9") + &between("a", "c", "-0.5"))),
        with("[[correlation]]\nbetween = [\"a\"]\nvalue = 0.5\n"),
        with("[[correlation]]\nbetween = [\"a\", \"b\"]\n"),
        with("[correlation]\nbetween = [\"a\", \"b\"]\nvalue = 0.5\n"),
        with("[[correlation]]\nbetwen = [\"a\", \"b\"]\nvalue = 0.5\n"),
    ];
    insta::assert_snapshot!(sensitol_testing::faults(&texts.each_ref().map(String::as_str)));
}

/// For a negative correlation, the corners of a pair follow the distribution: a model without value if both inputs are large is never
/// evaluated there. `x y` of normals with means 5, sigma 1 and correlation r has mean 25 + r and variance 50 (1 + r) + 1 + r^2.
#[test]
fn corners_lie_where_parts_are() {
    let r: f64 = -0.9;
    let dimensions = ["x", "y"].map(|name| Dimension::normal(name, 5.0, 3.0).unwrap());
    let product = |x: &[f64]| if x[0] + x[1] > 12.0 { f64::NAN } else { x[0] * x[1] };
    let problem =
        Problem::new(dimensions, Closure::scalar("z", product)).unwrap().correlated(&[pair("x", "y", r)]).unwrap();
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    assert_eq!(analysis.run.failed, 0, "{:?}", analysis.warnings);
    let moments = analysis.characteristics[0].moments.unwrap();
    // The surface is the product. Its coefficients are differences of values near 25.
    relative(moments.mean(), 25.0 + r, 1e-12);
    relative(moments.sigma(), (50.0 * (1.0 + r) + 1.0 + r * r).sqrt(), 1e-10);
}

/// A constant cannot be correlated.
#[test]
fn a_constant_stays_constant() {
    let problem = Problem::new(standard(2), Closure::scalar("y", |_| 4.0)).unwrap();
    let problem = problem.correlated(&[pair("x0", "x1", 0.5)]).unwrap().asking([Characteristic::new("y")]).unwrap();
    let found = &analyze(&problem, &Method::Full.into()).unwrap().characteristics[0];
    assert_eq!(found.moments, Some(Moments::constant(4.0)));
}

/// A stack of three dimensions with sigma 0.1, two of them with correlation 1/2: `rss^2 = 0.09 (3 + 1)`. Shares refer to the sum of
/// squares, and add up to 1.
#[test]
fn stacks_take_correlation_into_the_rss() {
    let problem = Problem::new(normals(&[1.0; 3], &[0.3; 3]), Closure::scalar("y", |x| x[0] + x[1] - x[2])).unwrap();
    let problem = problem.correlated(&[pair("x0", "x1", 0.5)]).unwrap();
    let analysis = analyze(&problem, &Method::Full.into()).unwrap();
    let report = Report::of(&problem, &analysis, About::default());
    let stack = report.stacks().remove(0);
    relative(stack.totals[1].half_width.unwrap(), 0.3 * 2.0, 1e-12);
    close(stack.rows.iter().map(|row| row.share.unwrap()).sum(), 1.0, 1e-12, 0.0);
    assert!(stack.notes.iter().any(|note| note.to_string().starts_with("x0, x1 are correlated")));
    assert_eq!(serde_json::to_value(&report).unwrap()["correlation"].as_array().unwrap().len(), 1);
}
