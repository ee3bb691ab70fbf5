//! Yields that depend on measured rows: the confidence that a sample gives about its process.

use std::sync::Arc;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use sensitol::analysis::YieldSource;
use sensitol::compare::{CompareOptions, compare};
use sensitol::correlation::Pair;
use sensitol::distribution::{
    Distribution, Exponential, Gamma, Lognormal, Measured, Mixture, Normal, Part, PearsonLaw, Triangular,
};
use sensitol::rare::{RareOptions, rare};
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::sweep::sweep;
use sensitol::{
    Characteristic, Closure, Dimension, Method, Options, Problem, Requirement, SpecLimits, Verdict, analyze,
};
use sensitol_numeric::sampling::clopper_pearson;
use sensitol_study::Study;

use sensitol_testing::{close, repository};

type Law = Arc<dyn Distribution>;

fn law(of: impl Distribution + 'static) -> Law {
    Arc::new(of)
}

/// Returns values of a distribution, which depend on the seed only.
fn drawn(of: &Law, n: usize, seed: u64) -> Vec<f64> {
    let mut values = vec![0.0; n];
    of.probability().unwrap().fill(&mut Xoshiro256PlusPlus::seed_from_u64(seed), &mut values);
    values
}

fn measured(name: &str, values: &[f64]) -> Dimension {
    Dimension::distributed(name, 0.0, None, law(Measured::new(values).unwrap())).unwrap()
}

/// Returns the problem of the sum of its dimensions, with an upper limit and a target yield.
fn sum(dimensions: Vec<Dimension>, upper: f64, target: f64) -> Problem {
    let limits = SpecLimits::new(None, Some(upper)).unwrap();
    let asked = Characteristic::new("y").with_limits(limits).with_target_yield(target).unwrap();
    Problem::new(dimensions, Closure::scalar("y", |x| x.iter().sum())).unwrap().asking([asked]).unwrap()
}

/// Returns a study of `x + z`, where `x` has these values and the formula proves the surface.
fn study(values: &[f64], assumed: &str, upper: f64, target: f64) -> Study {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<String> = values.iter().map(|value| format!("{value}")).collect();
    std::fs::write(folder.path().join("x.csv"), format!("x\n{}\n", rows.join("\n"))).unwrap();
    let formula = if assumed.is_empty() { "x" } else { "x + z" };
    let text = format!(
        "[dimensions]\nx = {{ measured = \"x.csv\" }}\n{assumed}\n[characteristics]\ny = {{ formula = \"{formula}\", upper = {upper}, target_yield = {target} }}\n"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    Study::read(&path).unwrap()
}

/// Returns 195 rows of a normal process that all keep a limit, and the limit, which 5071 ppm of the process exceed.
fn kept() -> (Vec<f64>, f64) {
    let process = law(Normal::new(0.0, 1.0).unwrap());
    let upper = process.probability().unwrap().upper_quantile(5071e-6);
    let rows = (0..).map(|seed| drawn(&process, 195, seed)).find(|rows| rows.iter().all(|&x| x <= upper)).unwrap();
    (rows, upper)
}

/// Rows without a reject: if 195 have none, up to 1.87 % of the process may be rejected, in every command. No target is proven.
#[test]
fn rows_without_a_reject_meet_no_target_of_a_thousandth() {
    let (rows, upper) = kept();
    let most = 1.0 - 0.025_f64.powf(1.0 / 195.0);
    let study = study(&rows, "", upper, 0.999);
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let one = &analysis.characteristics[0];
    assert_ne!(one.distribution.yield_source, Some(YieldSource::Proof));
    assert_eq!(
        (one.distribution.capability.unwrap().yield_(), one.verdict()),
        (Some(1.0), Some(Verdict::Inconclusive))
    );
    let [low, high] = one.yield_interval().unwrap();
    close(low, 1.0 - most, 1e-12, 0.0);
    assert_eq!(high, 1.0);

    for sampler in [Sampler::Random, Sampler::Sobol] {
        for control in [None, Some(Options::default())] {
            let mut options = SimulationOptions::default().with_samples(20_000).with_sampler(sampler);
            options.control = control;
            let found = simulate(&study.problem, &options).unwrap();
            let one = &found.characteristics[0];
            // The errors of points and rows are independent.
            let [low, _] = one.yield_interval().unwrap();
            let points = 1.0 - one.yield_.unwrap().interval[0];
            close(1.0 - low, most.hypot(points), 1e-9, 0.0);
            assert_eq!(one.verdict(), Some(Verdict::Inconclusive), "{sampler}");
        }
    }
    let found = rare(&study.problem, &RareOptions::default().with_samples(1000)).unwrap();
    assert_eq!(found.characteristics[0].verdict(), Some(Verdict::Inconclusive));
    close(found.characteristics[0].yield_interval.unwrap()[0], 1.0 - most, 1e-9, 0.0);

    let swept = sweep(&study.problem, "x", &[one.nominal.unwrap()], &study.options).unwrap();
    let swept = &swept.analyses[0].as_ref().unwrap().characteristics[0];
    assert_eq!(
        (swept.verdict(), swept.distribution.yield_source),
        (Some(Verdict::Inconclusive), one.distribution.yield_source)
    );
    let compared = compare(&study.problem, &CompareOptions::default().with_reference(20_000)).unwrap();
    assert!(compared.ran.len() > 8);
    assert!(compared.ran.iter().all(|ran| ran.verdicts[0] != Some(Verdict::Met)), "{:?}", compared.ran);
}

/// The smallest of several samples decides. A formula that proves its surface proves no yield beside them.
#[test]
fn the_smallest_sample_rules() {
    let (rows, upper) = kept();
    let more = drawn(&law(Normal::new(0.0, 0.1).unwrap()), 2000, 5);
    let problem = sum(vec![measured("x", &rows), measured("z", &more)], upper + 1.0, 0.999);
    let found = analyze(&problem, &Method::Full.into()).unwrap();
    let one = &found.characteristics[0];
    let [low, _] = one.yield_interval().unwrap();
    close(1.0 - low, 1.0 - 0.025_f64.powf(1.0 / 195.0), 0.01, 0.0);
    assert_eq!(one.verdict(), Some(Verdict::Inconclusive));
    // The target is met by as many rows as it requires: ln(0.025)/ln(0.999) = 3688.
    let enough = drawn(&law(Triangular::new(-1.0, 0.0, 1.0).unwrap()), 3700, 5);
    let found = analyze(&sum(vec![measured("x", &enough)], 1.5, 0.999), &Method::Full.into()).unwrap();
    assert_eq!(found.characteristics[0].verdict(), Some(Verdict::Met));
}

/// A measured dimension with a small effect adds a small error, and the verdict is that of the others.
#[test]
fn a_small_share_leaves_little_open() {
    let rows = drawn(&law(Normal::new(0.0, 0.05).unwrap()), 60, 1);
    let study = study(&rows, "z = { nominal = 0.0, sigma = 1.0 }", 4.0, 0.999);
    let one = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0);
    assert_eq!((one.verdict(), one.distribution.yield_source), (Some(Verdict::Met), Some(YieldSource::SurfaceLaw)));
    let one = simulate(&study.problem, &SimulationOptions::default()).unwrap().characteristics.remove(0);
    assert_eq!(one.verdict(), Some(Verdict::Met));
}

/// A count of rejects in one sample has the exact interval of a count.
#[test]
fn rejects_among_rows_are_a_count() {
    let (mut rows, upper) = kept();
    (0..4).for_each(|i| rows[40 * i] = upper + 1.0);
    let study = study(&rows, "", upper, 0.9);
    let one = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0);
    let [low, high] = clopper_pearson(4.0, 195.0);
    let [least, most] = one.evidence.sampling.unwrap().rejected.unwrap();
    close(least, low, 1e-9, 0.0);
    close(most, high, 1e-9, 0.0);
}

/// Lot of a process, with an assumed normal dimension or alone.
struct Lot {
    process: Law,
    n: usize,
    /// Sigma of the assumed dimension; 0 for none.
    assumed: f64,
    /// Share of the process that is rejected.
    rejected: f64,
    /// True if a smooth distribution is fitted to the values.
    smooth: bool,
}

impl Lot {
    /// Returns the limit that this share exceeds: the mean reject probability over 20 000 quantiles of the process, bisected to the last
    /// digit.
    fn upper(&self) -> f64 {
        let probability = self.process.probability().unwrap();
        let at = |i: i32| probability.quantile((f64::from(i) + 0.5) / 20_000.0);
        let values: Vec<f64> = (0..20_000).map(at).collect();
        let beyond = |upper: f64| {
            let of = |x: &f64| match self.assumed > 0.0 {
                true => 0.5 * libm::erfc((upper - x) / self.assumed / std::f64::consts::SQRT_2),
                false => f64::from(u8::from(*x > upper)),
            };
            values.iter().map(of).sum::<f64>() / 20_000.0
        };
        let (mut low, mut high) = (-50.0, 50.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if beyond(middle) > self.rejected { low = middle } else { high = middle }
        }
        high
    }

    /// Returns for these lots how many intervals of analysis and of simulation contain the true yield, and how many verdicts are wrongly
    /// met. The target lies just above the true yield.
    fn held(&self, lots: u64) -> [[usize; 2]; 2] {
        let (upper, target) = (self.upper(), 1.0 - 0.98 * self.rejected);
        let one = |seed: u64| {
            let values = drawn(&self.process, self.n, seed);
            let law: Law = match self.smooth {
                true => Arc::new(PearsonLaw::fitted(&values).ok()?),
                false => Arc::new(Measured::new(&values).unwrap()),
            };
            let mut dimensions = vec![Dimension::distributed("x", 0.0, None, law).unwrap()];
            if self.assumed > 0.0 {
                dimensions.push(Dimension::normal("z", 0.0, 3.0 * self.assumed).unwrap());
            }
            let problem = sum(dimensions, upper, target);
            let analysis = analyze(&problem, &Options::from(Method::Full).with_verify(0)).unwrap();
            let simulation = simulate(&problem, &SimulationOptions::default().with_samples(10_000)).unwrap();
            let (analysed, simulated) = (&analysis.characteristics[0], &simulation.characteristics[0]);
            let truth = 1.0 - self.rejected;
            let holds = |interval: Option<[f64; 2]>| interval.is_some_and(|[low, high]| low <= truth && truth <= high);
            let met = |verdict: Option<Verdict>| verdict == Some(Verdict::Met);
            Some([
                [holds(analysed.yield_interval()), met(analysed.verdict())],
                [holds(simulated.yield_interval()), met(simulated.verdict())],
            ])
        };
        let found: Vec<[[bool; 2]; 2]> = (0..lots).into_par_iter().filter_map(one).collect();
        // A fit that does not exist is an error of the study, and gives no result.
        assert!(10 * found.len() >= 7 * lots as usize, "{} of {lots}", found.len());
        let missing = lots as usize - found.len();
        let count = |of: usize, which: usize| found.iter().filter(|one| one[of][which]).count();
        [[count(0, 0) + missing, count(0, 1)], [count(1, 0) + missing, count(1, 1)]]
    }
}

/// For every process, 95 % intervals contain its yield in 93 % of the lots or more, and no more verdicts are wrongly met.
#[test]
fn intervals_of_lots_hold_the_yield_of_the_process() {
    const LOTS: u64 = 40;
    let two = || {
        let part = |name: &str, mean| Part {
            name: name.to_owned(),
            weight: 1.0,
            distribution: law(Normal::new(mean, 0.5).unwrap()),
        };
        law(Mixture::new(vec![part("low", -1.0), part("high", 1.0)]).unwrap())
    };
    let exponential = || law(Exponential::new(0.0, 1.0).unwrap());
    let lognormal = || law(Lognormal::new(0.0, 1.0, 0.4).unwrap());
    let triangular = || law(Triangular::new(-2.0, 1.0, 2.0).unwrap());
    let gamma = || law(Gamma::new(0.0, 1.0, 0.6).unwrap());
    let lot = |process, n, assumed, rejected| Lot { process, n, assumed, rejected, smooth: false };
    let mut lots = vec![
        lot(exponential(), 120, 0.0, 0.01),
        lot(exponential(), 120, 0.5, 0.01),
        lot(lognormal(), 60, 0.4, 0.004),
        lot(lognormal(), 300, 0.1, 0.003),
        lot(triangular(), 50, 0.3, 0.01),
        lot(triangular(), 200, 0.0, 0.004),
        lot(two(), 80, 0.6, 0.005),
        lot(gamma(), 150, 1.5, 0.002),
    ];
    lots.push(Lot { smooth: true, ..lot(gamma(), 150, 0.3, 0.005) });
    let (mut held, mut wrong) = ([0; 2], [0; 2]);
    for lot in &lots {
        let found = lot.held(LOTS);
        for of in 0..2 {
            held[of] += found[of][0];
            wrong[of] += found[of][1];
            // Three of 40 lots are more than 7 % already. Six would be more than chance.
            assert!(found[of][0] >= 34 && found[of][1] <= 6, "{} of {}: {found:?}", lot.process.name(), lot.n);
        }
    }
    let all = LOTS as usize * lots.len();
    for of in 0..2 {
        assert!(100 * held[of] >= 93 * all && 100 * wrong[of] <= 7 * all, "{held:?} {wrong:?} of {all}");
    }
}

/// Cpk, sigma and joint yields include the uncertainty of the rows in their verdicts.
#[test]
fn every_requirement_knows_the_size_of_the_sample() {
    let rows = drawn(&law(Normal::new(0.0, 1.0).unwrap()), 50, 3);
    let values = Measured::new(&rows).unwrap();
    let limits = SpecLimits::new(Some(-4.0), Some(4.0)).unwrap();
    let judged = |requirement: Requirement| {
        let asked = Characteristic::new("y").with_limits(limits).with_requirement(requirement).unwrap();
        let z = Dimension::normal("z", 0.0, 0.3).unwrap();
        let problem = Problem::new([measured("x", &rows), z], Closure::scalar("y", |x| x[0] + x[1])).unwrap();
        let problem = problem.asking([asked]).unwrap();
        let analysed = analyze(&problem, &Method::Full.into()).unwrap().characteristics[0].requirements();
        let simulated = simulate(&problem, &SimulationOptions::default()).unwrap().characteristics[0].requirements();
        [analysed[0].verdict, simulated[0].verdict]
    };
    let sigma = values.sigma().hypot(0.1);
    // The standard error of sigma from 50 rows is a tenth of it, 1/sqrt(100), so that 2 % are not decided.
    assert_eq!(judged(Requirement::Sigma(1.02 * sigma)), [Verdict::Inconclusive; 2]);
    assert_eq!(judged(Requirement::Sigma(1.5 * sigma)), [Verdict::Met; 2]);
    assert_eq!(judged(Requirement::Sigma(0.6 * sigma)), [Verdict::Missed; 2]);
    let cpk = (4.0 - values.mean().abs()) / (3.0 * sigma);
    assert_eq!(judged(Requirement::Cpk(0.98 * cpk)), [Verdict::Inconclusive; 2]);
    assert_eq!(judged(Requirement::Cpk(0.6 * cpk)), [Verdict::Met; 2]);

    let limits = |upper| SpecLimits::new(None, Some(upper)).unwrap();
    let both = Closure::new(["up", "down"], |x| [x[0], -x[0]]);
    let asked =
        [Characteristic::new("up").with_limits(limits(5.0)), Characteristic::new("down").with_limits(limits(5.0))];
    let problem = Problem::new([measured("x", &rows)], both).unwrap().asking(asked).unwrap();
    let mut options = Options::from(Method::Full);
    options.target_joint_yield = Some(0.99);
    let found = analyze(&problem, &options).unwrap();
    assert_eq!(found.joint_requirement.unwrap().verdict, Verdict::Inconclusive);
    let options = SimulationOptions::default().with_target_joint_yield(0.99);
    assert_eq!(simulate(&problem, &options).unwrap().joint_requirement.unwrap().verdict, Verdict::Inconclusive);
}

/// Rows of a block, and values that are correlated with others by a matrix, are counted too.
#[test]
fn blocks_and_correlated_samples_are_counted_too() {
    let folder = tempfile::tempdir().unwrap();
    let (rows, upper) = kept();
    let text: Vec<String> = rows.iter().map(|x| format!("{x};{}", 0.5 * x)).collect();
    std::fs::write(folder.path().join("lot.csv"), format!("a;b\n{}\n", text.join("\n"))).unwrap();
    let path = folder.path().join("study.toml");
    let study = format!(
        "[dimensions]\na = {{ measured = \"lot.csv\", column = \"a\" }}\nb = {{ measured = \"lot.csv\", column = \"b\" }}\n[characteristics]\ny = {{ formula = \"a + b\", upper = {}, target_yield = 0.999 }}\n",
        1.5 * upper
    );
    std::fs::write(&path, study).unwrap();
    let study = Study::read(&path).unwrap();
    let most = 1.0 - 0.025_f64.powf(1.0 / 195.0);
    let one = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0);
    close(1.0 - one.yield_interval().unwrap()[0], most, 0.01, 0.0);
    let one = simulate(&study.problem, &SimulationOptions::default()).unwrap().characteristics.remove(0);
    close(1.0 - one.yield_interval().unwrap()[0], most, 0.01, 0.0);
    let sampling = one.sampling.unwrap();
    // Sigma of 195 rows is accurate to 2/sqrt(390), a tenth.
    let [low, high] = sampling.sigma.unwrap();
    assert!((1.15..1.35).contains(&(high / low)), "{low} {high}");

    let dimensions = [measured("x", &rows), Dimension::normal("z", 0.0, 3.0).unwrap()];
    let pair = Pair { between: ["x".to_owned(), "z".to_owned()], value: 0.3 };
    let asked = Characteristic::new("y").with_limits(SpecLimits::new(None, Some(8.0)).unwrap());
    let asked = asked.with_target_yield(0.999).unwrap().with_requirement(Requirement::Cpk(0.5)).unwrap();
    let problem = Problem::new(dimensions, Closure::scalar("y", |x| x[0] + x[1])).unwrap();
    let problem = problem.asking([asked]).unwrap().correlated(&[pair]).unwrap();
    let analysed = analyze(&problem, &Method::Full.into()).unwrap().characteristics[0].requirements();
    let simulated = simulate(&problem, &SimulationOptions::default()).unwrap().characteristics[0].requirements();
    for judged in analysed.iter().chain(&simulated) {
        assert_eq!(judged.verdict, Verdict::Inconclusive, "{judged:?}");
    }
    assert!(analysed[1].interval.is_none() && analysed[0].interval.is_some(), "unknown is not zero: {analysed:?}");
}

/// In the example with twelve columns of sixty rows, distant limits leave the uncertainty of sixty rows.
#[test]
fn an_example_of_measured_parts_proves_nothing() {
    let study = Study::read(&repository("examples/compression-clearance/measured.toml")).unwrap();
    let limits = SpecLimits::new(Some(0.5), Some(1.2)).unwrap();
    let asked = Characteristic::new("clearance").with_limits(limits).with_target_yield(0.997).unwrap();
    let problem = study.problem.asking([asked]).unwrap();
    let one = analyze(&problem, &study.options).unwrap().characteristics.remove(0);
    close(1.0 - one.yield_interval().unwrap()[0], 1.0 - 0.025_f64.powf(1.0 / 60.0), 0.02, 0.0);
    assert_eq!(one.verdict(), Some(Verdict::Inconclusive));
    assert_ne!(one.distribution.yield_source, Some(YieldSource::Proof));
}
