//! Methods of the second-order paper on its three examples, side by side: `docs/method-comparison.md`, and the same figures from
//! independent code.

use std::fmt::Write;

use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{DerivativeSource, Method, Options, Problem, analyze};
use sensitol_study::Study;
use sensitol_testing::{data, generated, repository};
use serde_json::Value;

const PAGE: &str = "docs/method-comparison.md";

enum Ours {
    Method(Options),
    /// Vector loops of the same assembly, with exact derivatives.
    Loops,
    Points(Sampler, u64),
    /// Part of the surface of `full` that the paper's equations 7 to 14 keep, with 2N^2 + 1 evaluations.
    Printed,
}

fn methods() -> Vec<(&'static str, &'static str, Ours)> {
    let method = |method: Method| Ours::Method(Options::from(method));
    let three = Options::from(Method::DimensionReduction).with_nodes(3);
    vec![
        ("direct linearisation", "`rss`", method(Method::Rss)),
        ("direct linearisation by vector loops", "`rss --derivatives exact`", Ours::Loops),
        ("second order without mixed derivatives", "`second-order`", method(Method::SecondOrder)),
        ("improved second order, 6N + 1", "`six-n`", method(Method::SixN)),
        ("second order, every pair", "`full`", method(Method::Full)),
        ("the same with the paper's stencil", "`classic`", method(Method::Classic)),
        ("the same by the paper's equations 7 to 14", "from `classic`", Ours::Printed),
        ("dimension reduction, 3 nodes (Rahman and Xu)", "`dimension-reduction --nodes 3`", Ours::Method(three)),
        ("dimension reduction, 5 nodes", "`dimension-reduction`", method(Method::DimensionReduction)),
        ("response surface", "`response-surface`", method(Method::ResponseSurface)),
        ("full factorial, 3^N (Seo and Kwak)", "`three-point`", method(Method::ThreePoint)),
        ("quasi-Monte Carlo", "`simulate --sampler sobol`", Ours::Points(Sampler::Sobol, 32_768)),
        ("Monte Carlo", "`simulate`", Ours::Points(Sampler::Random, 30_000)),
    ]
}

fn problem(path: &str, characteristic: &str) -> Problem {
    let study = Study::read(&repository("examples").join(path)).unwrap();
    study.problem.only(&[characteristic]).unwrap()
}

fn analysed(problem: &Problem, options: &Options) -> Option<(u64, [f64; 4])> {
    let found = analyze(problem, options).ok()?;
    let moments = found.characteristics[0].moments.unwrap();
    let shape = [moments.mean(), moments.sigma(), moments.skewness().unwrap(), moments.kurtosis().unwrap()];
    Some((found.run.evaluations, shape))
}

fn sampled(problem: &Problem, options: &SimulationOptions) -> [f64; 4] {
    let one = simulate(problem, options).unwrap().characteristics.remove(0);
    [one.mean, one.sigma, one.skewness, one.kurtosis].map(|estimate| estimate.unwrap().value)
}

/// Returns the moments of second order, with first-order terms alone in the third and fourth raw moment.
fn printed(problem: &Problem) -> (u64, [f64; 4]) {
    let found = analyze(problem, &Options::from(Method::Classic).with_verify(0)).unwrap();
    let one = &found.characteristics[0];
    let (mean, sigma) = (one.moments.unwrap().mean(), one.moments.unwrap().sigma());
    let (shift, first) = (mean - one.nominal.unwrap(), one.linear.rss.unwrap() / 3.0);
    let raw = sigma * sigma + shift * shift;
    let skewness = (2.0 * shift.powi(3) - 3.0 * raw * shift) / sigma.powi(3);
    let kurtosis = (3.0 * first.powi(4) + 6.0 * raw * shift * shift - 3.0 * shift.powi(4)) / sigma.powi(4);
    (found.run.evaluations, [mean, sigma, skewness, kurtosis])
}

/// Characteristic of the three examples, with its reference.
struct Case {
    title: &'static str,
    problem: Problem,
    loops: Option<Problem>,
    reference: [f64; 4],
}

impl Case {
    /// Returns the reference: mean and sigma to a hundred thousandth of sigma, skewness and kurtosis.
    fn shown(&self) -> String {
        let sigma = self.reference[1];
        let scales = [1e-4 * sigma, 1e-4 * sigma, 1e-4, 1e-4];
        let figures: Vec<String> = (0..4).map(|k| figure(self.reference[k], scales[k], 9)).collect();
        figures.join(" ")
    }

    /// Returns the evaluations of a method, and its errors of mean, sigma, skewness and kurtosis.
    fn cell(&self, ours: &Ours) -> String {
        let found = match ours {
            Ours::Method(options) => analysed(&self.problem, &options.clone().with_verify(0)),
            Ours::Loops => match &self.loops {
                Some(loops) => {
                    let exact = Options::from(Method::Rss).with_derivatives(DerivativeSource::Exact);
                    analysed(loops, &exact.with_verify(0))
                }
                None => return "-".to_owned(),
            },
            Ours::Points(sampler, samples) => {
                let options = SimulationOptions::default().with_sampler(*sampler).with_samples(*samples);
                Some((*samples, sampled(&self.problem, &options)))
            }
            Ours::Printed => Some(printed(&self.problem)),
        };
        let Some((evaluations, found)) = found else {
            let (linear, _) = analysed(&self.problem, &Options::from(Method::Rss).with_verify(0)).unwrap();
            return format!("3^{}", (linear - 1) / 2);
        };
        let errors = [
            (found[0] - self.reference[0]) / self.reference[1],
            found[1] / self.reference[1] - 1.0,
            found[2] - self.reference[2],
            found[3] - self.reference[3],
        ];
        let errors =
            errors.map(|error| if error.abs() < 1e-8 { "<1e-8".to_owned() } else { format!("{:.0e}", error.abs()) });
        format!("{evaluations}: {}", errors.join(" "))
    }
}

/// Returns a row for each method, and a column for each characteristic.
fn table(cases: &[Case]) -> String {
    let titles: Vec<&str> = cases.iter().map(|case| case.title).collect();
    let references: Vec<String> = cases.iter().map(Case::shown).collect();
    let mut table =
        format!("| in the paper | ours | {} |\n|---|---|{}\n", titles.join(" | "), "---|".repeat(cases.len()));
    writeln!(table, "| reference | | {} |", references.join(" | ")).unwrap();
    for (name, key, ours) in methods() {
        let cells: Vec<String> = cases.iter().map(|case| case.cell(&ours)).collect();
        writeln!(table, "| {name} | {key} | {} |", cells.join(" | ")).unwrap();
    }
    table
}

/// Formats a value to the second digit of its error, with at most `most` decimals.
fn figure(value: f64, error: f64, most: usize) -> String {
    let decimals = if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, most as f64) as usize } else { most };
    let text = format!("{value:.decimals$}");
    // A mean of -1e-17 is shown as 0.
    if text.trim_start_matches(['-', '0', '.']).is_empty() { text.trim_start_matches('-').to_owned() } else { text }
}

fn moments(value: &Value) -> [f64; 4] {
    ["mean", "sigma", "skewness", "kurtosis"].map(|key| value[key].as_f64().unwrap())
}

/// Returns the reference of a case, by tensor quadrature.
fn reference(case: &str) -> [f64; 4] {
    let listed = data("method-comparison.json")["computed"][case].as_object().unwrap().clone();
    moments(listed.iter().find(|(key, _)| key.starts_with("reference: tensor")).unwrap().1)
}

#[test]
fn the_comparison_of_methods_is_measured() {
    let mut cases = vec![Case {
        title: "blocks, gap",
        problem: problem("stacked-blocks/study.toml", "gap"),
        loops: Some(problem("stacked-blocks-loops/study.toml", "gap")),
        reference: reference("stacked_blocks"),
    }];
    for (title, output, case) in
        [("return, stroke", "stroke", "quick_return_stroke"), ("return, ratio", "ratio", "quick_return_time_ratio")]
    {
        let problem = problem("quick-return/study.toml", output);
        cases.push(Case { title, problem, loops: None, reference: reference(case) });
    }
    for (title, output) in [("gun, gap", "gap"), ("gun, flush 1", "flush1"), ("gun, flush 2", "flush2")] {
        let problem = problem("spot-weld/study.toml", output);
        // The reference is the model at 100 000 points, with the surface of `full` as control variate.
        let control = SimulationOptions::default().with_samples(100_000).with_control(Method::Full.into());
        let truth = sampled(&problem, &control);
        cases.push(Case { title, problem, loops: None, reference: truth });
    }
    generated(PAGE, "methods", &table(&cases));
}

/// Independent code gives the same figures: with derivatives at the point to 1e-7, with nodes at sqrt 3 sigma and factorials to 1e-8.
#[test]
fn methods_are_those_of_the_comparison() {
    let all = data("method-comparison.json")["computed"].clone();
    for (path, output, case) in [
        ("stacked-blocks/study.toml", "gap", "stacked_blocks"),
        ("quick-return/study.toml", "stroke", "quick_return_stroke"),
        ("quick-return/study.toml", "ratio", "quick_return_time_ratio"),
    ] {
        let problem = problem(path, output);
        let at_the_point = |method: Method| Options::from(method).with_step(0.01);
        for (key, options) in [
            ("second order, exact moments of the quadratic, all pairs", at_the_point(Method::Full)),
            ("second order, exact moments, no mixed derivatives", at_the_point(Method::SecondOrder)),
            ("dimension reduction (univariate), 3 points", Options::from(Method::DimensionReduction).with_nodes(3)),
            ("dimension reduction (univariate), 5 points", Method::DimensionReduction.into()),
            ("three-point full factorial 3^N (Seo and Kwak)", Method::ThreePoint.into()),
            ("response surface, quadratic through pair nodes at sqrt 3 sigma", Method::Classic.into()),
        ] {
            let expected = moments(&all[case][key]);
            let (_, found) = analysed(&problem, &options.with_verify(0)).unwrap();
            let sigma = expected[1];
            assert!((found[0] - expected[0]).abs() < 2e-6 * sigma, "{case} {key}: {found:?} {expected:?}");
            assert!((found[1] / sigma - 1.0).abs() < 2e-6, "{case} {key}: {found:?} {expected:?}");
            // Shapes depend on second derivatives, which steps of 0.01 sigma give to five digits.
            assert!((found[2] - expected[2]).abs() < 2e-5, "{case} {key}: {found:?} {expected:?}");
            assert!((found[3] - expected[3]).abs() < 1e-4, "{case} {key}: {found:?} {expected:?}");
        }
        let expected = moments(&all[case]["printed eqs 7-14 (skewness and kurtosis terms dropped)"]);
        let (_, found) = printed(&problem);
        // Nodes at sqrt 3 sigma change sigma by 6e-5 of it.
        assert!((found[2] - expected[2]).abs() < 1e-4 && (found[3] - expected[3]).abs() < 1e-3, "{case} {found:?}");
    }
}

/// Eigenvector dimension reduction: along the eigenvectors of the correlation it needs as many points as with independent inputs.
#[test]
fn dimension_reduction_goes_by_eigenvectors() {
    let text = std::fs::read_to_string(repository("examples/stacked-blocks/study.toml")).unwrap();
    let correlated = format!(
        "{text}\n[[correlation]]\nbetween = [\"a\", \"b\"]\nvalue = 0.6\n[[correlation]]\nbetween = [\"R\", \"r\"]\nvalue = 0.8\n"
    );
    let study = Study::from_toml(&correlated, "blocks.toml").unwrap();
    let (evaluations, found) =
        analysed(&study.problem, &Options::from(Method::DimensionReduction).with_verify(0)).unwrap();
    let expected = moments(&data("method-comparison.json")["correlated_blocks"]);
    assert_eq!(evaluations, 33);
    // Univariate parts along eigenvectors leave out the interactions between them: 9e-5 of sigma for independent inputs.
    assert!((found[0] - expected[0]).abs() < 1e-5 * expected[1], "{found:?} {expected:?}");
    assert!((found[1] / expected[1] - 1.0).abs() < 2e-4, "{found:?} {expected:?}");
}
