//! Derivatives from an external model: fewer evaluations, the same figures, and a check of each. The child is `tests/children/flips.c`.

use sensitol::assembly::{AssemblyFunction, EvaluationError, ModelInfo, Request, Responses, Run, Signature};
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};

use sensitol::{Analysis, Dimension, Method, Options, Problem, analyze};
use sensitol_external::journal::Journaled;
use sensitol_testing::child_in_c;

/// A process without sentinels, whose evaluations would be counted too.
fn process(mode: &str, n: usize) -> Process {
    let names: Vec<String> = (0..n).map(|d| format!("x{d}")).collect();
    let settings = Settings::new([child_in_c(), mode.into(), "5".into()]).with_verify(0).with_sentinels(false);
    Process::new(Signature::of_names(names, ["y"]), Greeting::new(vec![1.0; n]), settings)
}

fn problem(function: impl AssemblyFunction + 'static, n: usize) -> Problem {
    // Sigma is 0.1, as in the child.
    let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
    Problem::new((0..n).map(dimension), function).unwrap()
}

/// Options without check points, whose evaluations would be counted too.
fn options(method: Method) -> Options {
    Options::from(method).with_verify(0)
}

fn of(mode: &str, n: usize, method: Method) -> Analysis {
    analyze(&problem(process(mode, n), n), &options(method)).unwrap()
}

/// The function is of second order, so differences and derivatives agree up to rounding. Values of about 10 and sigmas of about 2 leave
/// twelve digits.
#[test]
fn gradients_save_evaluations() {
    for n in [2, 4, 14] {
        for method in [Method::Rss, Method::SecondOrder, Method::Full] {
            let (plain, slopes) = (of("plain", n, method), of("slopes", n, method));
            let (expected, found) =
                (plain.characteristics[0].moments.unwrap(), slopes.characteristics[0].moments.unwrap());
            assert!((found.sigma() - expected.sigma()).abs() < 1e-11 * expected.sigma(), "{method:?} {n}: {found:?}");
            if method != Method::Rss {
                assert!((found.mean() - expected.mean()).abs() < 1e-11, "{n}");
                assert!((found.skewness().unwrap() - expected.skewness().unwrap()).abs() < 1e-10, "{n}");
                assert_eq!(
                    slopes.characteristics[0].contributions.interactions.len(),
                    plain.characteristics[0].contributions.interactions.len()
                );
            }
            let [few, many] = match method {
                // The means and a check.
                Method::Rss => [2, 2 * n + 1],
                // One side of the axes.
                Method::SecondOrder => [n + 1, 2 * n + 1],
                // The axes, instead of all pairs: 29 instead of 211 for 14 dimensions.
                _ => [2 * n + 1, n * n + n + 1],
            };
            assert_eq!([slopes.run.evaluations, plain.run.evaluations], [few as u64, many as u64], "{method:?} {n}");
        }
    }
    assert!(of("slopes", 4, Method::Full).warnings.is_empty(), "{:?}", of("slopes", 4, Method::Full).warnings);
}

/// Derivatives that contradict the values are refused with their names. So are derivatives that are declared but never sent.
#[test]
fn wrong_gradients_are_refused() {
    for method in [Method::Rss, Method::SecondOrder, Method::Full] {
        let error = |mode: &str| analyze(&problem(process(mode, 4), 4), &options(method)).unwrap_err().to_string();
        let wrong = error("wrong");
        assert!(
            wrong.starts_with("the gradients of `y`") && wrong.contains("are wrong: by them it changes by"),
            "{wrong}"
        );
        assert_eq!(wrong.contains("by `x1`"), method != Method::Rss, "{wrong}");
        assert_eq!(error("silence"), "the model says that it sends gradients, and its answers have none of `y`");
        // Differences do not need the derivatives.
        let plainly = options(method).with_derivatives(sensitol::DerivativeSource::Difference);
        assert!(analyze(&problem(process("wrong", 4), 4), &plainly).is_ok());
    }
}

/// A budget that only the smaller plan keeps. The journal keeps the derivatives too.
#[test]
fn gradients_are_kept_and_counted() {
    let budget = options(Method::Full).with_budget(29);
    let found = analyze(&problem(process("slopes", 14), 14), &budget).unwrap();
    assert!(found.characteristics[0].moments.is_some());
    assert!(analyze(&problem(process("plain", 14), 14), &budget).is_err());
    let folder = tempfile::tempdir().unwrap();
    let kept = || problem(Journaled::new(process("slopes", 4), folder.path().join("a.sqlite"), Vec::new()), 4);
    let first = analyze(&kept(), &options(Method::Full)).unwrap();
    let again = analyze(&kept(), &options(Method::Full)).unwrap();
    assert_eq!((first.run.cached, again.run.cached, again.run.evaluations), (0, 9, 1));
    assert_eq!(again.characteristics[0].moments, first.characteristics[0].moments);
}

/// A function of third order and its derivatives: `y = z + 0.3 z^2 + 0.1 z^3 + 2 w` with `z` and `w` in sigmas.
struct Cubic(Signature);

impl AssemblyFunction for Cubic {
    fn signature(&self) -> &Signature {
        &self.0
    }

    fn prepare(&self, _: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let mut info = ModelInfo::of_window(1);
        info.gradients = true;
        Ok(Some(info))
    }

    fn evaluate(&self, request: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
        for row in 0..request.points.rows() {
            let x = request.points.row(row);
            let [z, w] = [10.0 * (x[0] - 1.0), 10.0 * (x[1] - 1.0)];
            out.set(row, 0, z + 0.3 * z * z + 0.1 * z.powi(3) + 2.0 * w);
            out.set_gradient(row, 0, vec![10.0 * (1.0 + 0.6 * z + 0.3 * z * z), 20.0]);
        }
    }
}

/// Value and slope at two points determine a cubic. With the moments 1, 3, 15 of a normal variable its mean is 0.3 and its variance 1 + 2
/// 0.09 + 15 0.01 + 6 0.1 = 1.93. The other dimension adds 4, which gives 5.93. By values alone `second-order` has no third order. The
/// tolerance is ten roundings.
#[test]
fn slopes_at_one_node_tell_a_cubic() {
    let cubic = problem(Cubic(Signature::of_names(["x0", "x1"], ["y"])), 2);
    let of = |options: &Options| {
        let found = analyze(&cubic, options).unwrap();
        (found.characteristics[0].moments.unwrap(), found.run.evaluations)
    };
    let (moments, evaluations) = of(&options(Method::SecondOrder));
    assert_eq!(evaluations, 3);
    assert!((moments.mean() - 0.3).abs() < 1e-14, "{moments:?}");
    assert!((moments.variance() - 5.93).abs() < 1e-13, "{moments:?}");
    let plainly = options(Method::SecondOrder).with_derivatives(sensitol::DerivativeSource::Difference);
    let (moments, evaluations) = of(&plainly);
    assert_eq!(evaluations, 5);
    assert!((moments.variance() - 5.93).abs() > 0.05, "{moments:?}");
}
