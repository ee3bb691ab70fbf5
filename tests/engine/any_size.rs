//! Results do not depend on the unit: outputs and inputs are multiplied by powers of two, or of ten, from 1e-290 to 1e290.
//!
//! Every number of a report has a unit `y^n x^m`. Two runs in units of 8 and 32, which are of ordinary size, give the exponents of each
//! number. At every other size the number must be that of an ordinary size times the units to these exponents, to the last bit.
//!
//! A power of ten is a number from 1 to 2 times a power of two, and a run in units of that number has the same roundings. Roundings differ
//! between such numbers, and so do quantities that consist of roundings, such as some estimates of errors. The figures themselves agree to
//! 1e-9.

use std::collections::HashSet;
use std::sync::{Arc, Mutex};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Offer, Priced, QualityLoss, allocate};
use sensitol::assembly::formula::Formula;
use sensitol::assembly::{AssemblyFunction, Composite, Input, Parts, Request, Responses, Run, Signature, Source};
use sensitol::compare::{CompareOptions, compare};
use sensitol::inspection::Inspection;
use sensitol::rare::{RareOptions, rare};
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::sweep::sweep;
use sensitol::{
    Characteristic, Closure, DerivativeSource, Dimension, Method, Options, Problem, Requirement, SpecLimits, analyze,
};
use serde_json::Value;

use sensitol_testing::parse;

/// Units of outputs and inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Units {
    y: f64,
    x: f64,
}

impl Units {
    const ONE: Self = Self { y: 1.0, x: 1.0 };

    /// Returns two powers of a base as units.
    fn powers(base: f64, [y, x]: [i32; 2]) -> Self {
        // Powers of ten are parsed, so that they are rounded like decimal numbers in a file.
        let of = |power: i32| if base == 10.0 { format!("1e{power}").parse().unwrap() } else { base.powi(power) };
        Self { y: of(y), x: of(x) }
    }
}

/// Problem as a function of the units, with its name.
type Study = (&'static str, fn(Units) -> Problem);

/// Two formulas, a curved one and a straight one.
fn formula(Units { y, x }: Units) -> Problem {
    let text = format!(
        "[dimensions]\n\
         a = {{ nominal = {}, tolerance = {} }}\n\
         b = {{ nominal = {}, tolerance = {}, distribution = \"uniform\" }}\n\
         c = {{ nominal = {}, tolerance = {} }}\n\
         [characteristics]\n\
         bent = {{ formula = \"{y:e}*(a/{x:e} + (b/{x:e})^2 - 0.3*sin(2*c/{x:e}))\", lower = {}, upper = {} }}\n\
         straight = {{ formula = \"{y:e}*(a/{x:e} - 2*c/{x:e})\", upper = {} }}\n",
        2.0 * x,
        0.3 * x,
        0.5 * x,
        0.6 * x,
        0.2 * x,
        0.3 * x,
        1.5 * y,
        2.9 * y,
        2.2 * y,
    );
    parse(&text).unwrap().problem
}

/// The larger of two dimensions, a formula with a kink that no surface follows.
fn kink(Units { y, x }: Units) -> Problem {
    let text = format!(
        "[dimensions]\n\
         a = {{ nominal = 0.0, sigma = {x:e} }}\n\
         b = {{ nominal = {}, sigma = {x:e} }}\n\
         [characteristics]\n\
         larger = {{ formula = \"{y:e}*max(a/{x:e}, b/{x:e})\", upper = {} }}\n",
        0.25 * x,
        3.0 * y,
    );
    parse(&text).unwrap().problem
}

fn limited(name: &str, lower: Option<f64>, upper: Option<f64>) -> Characteristic {
    Characteristic::new(name).with_limits(SpecLimits::new(lower, upper).unwrap())
}

/// Rust closure, with a dimension that does not vary.
fn closure(Units { y, x }: Units) -> Problem {
    let dimensions = [
        Dimension::normal("a", 2.0 * x, 0.3 * x).unwrap(),
        Dimension::normal_between("b", 0.4 * x, [-0.3 * x, 0.5 * x]).unwrap(),
        Dimension::fixed("c", 1.5 * x).unwrap(),
    ];
    let function = Closure::new(["power", "root"], move |at| {
        let [a, b, c] = [0, 1, 2].map(|d| at[d] / x);
        [y * ((0.4 * a).exp() * b + c), y * (a * a + b * b).sqrt()]
    });
    let asked = [
        limited("power", Some(1.4 * y), Some(3.6 * y)).with_requirement(Requirement::Sigma(0.4 * y)).unwrap(),
        limited("root", None, Some(2.3 * y)).with_inspection(Inspection::new(0.01 * y).unwrap()).unwrap(),
    ];
    Problem::new(dimensions, function).unwrap().asking(asked).unwrap()
}

/// Dimensions that vary together, one of which is not normal.
fn correlated(Units { y, x }: Units) -> Problem {
    let text = format!(
        "[dimensions]\n\
         a = {{ nominal = {}, tolerance = {} }}\n\
         b = {{ nominal = {}, sigma = {}, distribution = {{ kind = \"lognormal\", origin = 0 }} }}\n\
         c = {{ nominal = {}, tolerance = {} }}\n\
         [[correlation]]\n\
         between = [\"a\", \"b\"]\n\
         value = 0.6\n\
         [characteristics]\n\
         y = {{ formula = \"{y:e}*(a/{x:e}*(b/{x:e}) - c/{x:e} + (b/{x:e})^2)\", lower = {}, upper = {} }}\n",
        2.0 * x,
        0.3 * x,
        1.0 * x,
        0.1 * x,
        0.5 * x,
        0.2 * x,
        1.5 * y,
        4.5 * y,
    );
    parse(&text).unwrap().problem
}

/// Measured values and play on either side, whose sums are a step function.
fn discrete(Units { y, x }: Units) -> Problem {
    use sensitol::distribution::{Measured, TwoValues};
    let measured: Vec<f64> = [9.9, 10.0, 10.0, 10.1, 10.15, 9.95, 10.05, 10.0].map(|value| value * x).to_vec();
    let dimensions = [
        Dimension::distributed("a", 10.0 * x, None, std::sync::Arc::new(Measured::new(&measured).unwrap())).unwrap(),
        Dimension::distributed("b", 0.0, None, std::sync::Arc::new(TwoValues::new(-0.125 * x, 0.125 * x).unwrap()))
            .unwrap(),
        Dimension::normal("c", 3.0 * x, 0.15 * x).unwrap(),
    ];
    let function = Closure::scalar("gap", move |at| {
        let [a, b, c] = [0, 1, 2].map(|d| at[d] / x);
        y * (a + b - c + 0.2 * b * c)
    });
    Problem::new(dimensions, function).unwrap().asking([limited("gap", Some(6.8 * y), Some(7.27 * y))]).unwrap()
}

/// Returns `value * unit^exponents`, which is exact if the units are powers of two.
fn in_units(value: f64, units: Units, [n, m]: [i32; 2]) -> f64 {
    // Factors are multiplied one at a time, large and small ones in turn, so that no product overflows.
    let mut factors = Vec::new();
    for (unit, exponent) in [(units.y, n), (units.x, m)] {
        factors.extend(std::iter::repeat_n(
            if exponent > 0 { unit } else { 1.0 / unit },
            exponent.unsigned_abs() as usize,
        ));
    }
    factors.sort_by(f64::total_cmp);
    let mut product = value;
    while !factors.is_empty() {
        // The factor that brings the product nearest to 1 comes next.
        let next = if product.abs() > 1.0 { 0 } else { factors.len() - 1 };
        product *= factors.remove(next);
    }
    product
}

/// Splits units into units from 1 to 2 and powers of two.
fn ordinary(Units { y, x }: Units) -> (Units, Units) {
    let power = |unit: f64| 2f64.powi(unit.log2().floor() as i32);
    let powers = Units { y: power(y), x: power(x) };
    (Units { y: y / powers.y, x: x / powers.x }, powers)
}

/// Keys of numbers that do not depend on units, and change from run to run.
const TIMES: [&str; 6] = ["wall_s", "in_model_s", "engine_s", "evaluation_s", "lost_s", "projected_s"];

/// Collects the numbers of a result with their paths, in order; null as NaN.
fn numbers(value: &Value, path: &str, out: &mut Vec<(String, f64)>) {
    match value {
        Value::Object(all) => {
            for (key, value) in all.iter().filter(|(key, _)| !TIMES.contains(&key.as_str())) {
                numbers(value, &format!("{path}.{key}"), out);
            }
        }
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(place, value)| numbers(value, &format!("{path}[{place}]"), out))
        }
        Value::Number(number) => out.push((path.to_owned(), number.as_f64().unwrap())),
        Value::Null => out.push((path.to_owned(), f64::NAN)),
        Value::Bool(known) => out.push((path.to_owned(), f64::from(u8::from(*known)))),
        Value::String(_) => {}
    }
}

fn numbers_of(value: &Value) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    numbers(value, "", &mut all);
    all
}

/// Returns the exponent of a unit of 2^k in a number, from its values in the unit of 1 and in this one. Returns None for a rounding error,
/// which has no unit.
fn exponent(one: f64, other: f64, k: i32, near_enough: f64) -> Option<i32> {
    let near = |n: &i32| (one * 2f64.powi(n * k) / other - 1.0).abs() < near_enough;
    match one == other || one.is_nan() && other.is_nan() {
        true => Some(0),
        false => (-2..=2).find(near),
    }
}

/// True for figures that do not depend on single roundings.
fn is_figure(path: &str) -> bool {
    let (before, key) = path.rsplit_once('.').unwrap_or(("", path));
    let moments = ["mean", "sigma", "skewness", "kurtosis", "yield", "ppm_below", "ppm_above", "rss", "middle", "cpk"];
    let places = before.ends_with("quantiles") || before.ends_with("worst_case") && key.starts_with("linear");
    let estimated =
        ["error", "control", "standard", "rounding", "verification"].iter().any(|part| before.contains(part));
    (moments.contains(&key) || places) && !estimated && !key.ends_with("_error")
}

/// Job that returns its results as JSON for some units.
type Job<'j> = &'j (dyn Fn(Units) -> Value + Sync);

/// Returns the sizes at which a job is run: the ends, and some between them. A job that takes long is run at four.
fn sizes(base: f64, long: bool) -> Vec<Units> {
    let most = if base == 2.0 { 963 } else { 290 };
    let mut all: Vec<[i32; 2]> = vec![[most, -most], [-most, most], [25, 0], [0, -30]];
    if !long {
        all.extend([[most, 0], [-most, 0], [0, most], [0, -most], [most, most], [-most, -most], [3, -3]]);
        let mut runner = TestRunner::new_with_rng(Config::default(), TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let mut draw = || (-most..=most).new_tree(&mut runner).unwrap().current();
        for _ in 0..2 {
            all.extend([[draw(), 0], [0, draw()], [draw(), draw()]]);
        }
    }
    all.into_iter().map(|powers| Units::powers(base, powers)).collect()
}

/// Removes the warning that figures exceed the range of doubles, also from analyses within the results. Returns true if it was there.
fn take_word(value: &mut Value) -> bool {
    match value {
        Value::Object(all) => {
            let mut said = false;
            all.values_mut().for_each(|value| said |= take_word(value));
            said
        }
        Value::Array(all) => {
            let before = all.len();
            all.retain(|one| one.get("code").is_none_or(|code| code != "unrepresentable"));
            let said = all.len() < before;
            all.iter_mut().fold(said, |said, value| take_word(value) || said)
        }
        _ => false,
    }
}

/// Checks that a job has the results of the unit of 1 in every unit.
#[track_caller]
fn the_same_in_every_unit(name: &str, job: Job<'_>) {
    the_same_within(Within::USUAL, name, job);
}

/// Returns the first path that is in only one of two results.
fn other_place<'n>(a: &'n [(String, f64)], b: &'n [(String, f64)]) -> Option<&'n str> {
    let lacks = |of: &'n [(String, f64)], in_: &'n [(String, f64)]| {
        let places: std::collections::HashSet<&str> = in_.iter().map(|(path, _)| path.as_str()).collect();
        of.iter().map(|(path, _)| path.as_str()).find(|path| !places.contains(path))
    };
    lacks(a, b).or_else(|| lacks(b, a))
}

/// Greatest relative differences of numbers.
#[derive(Clone, Copy)]
struct Within {
    /// Difference if all roundings are the same.
    numbers: f64,
    /// Difference if roundings differ; infinite if these decide which points are drawn.
    figures: f64,
    /// True if the job takes long, so that it is run at few sizes.
    long: bool,
}

impl Within {
    const USUAL: Self = Self { numbers: 1e-12, figures: 1e-9, long: false };
}

/// Checks that a job has the results of the unit of 1 in every unit, within these differences.
#[track_caller]
fn the_same_within(Within { numbers: near_enough, figures, long }: Within, name: &str, job: Job<'_>) {
    let one = numbers_of(&job(Units::ONE));
    let [by_y, by_x] = [Units { y: 8.0, x: 1.0 }, Units { y: 1.0, x: 32.0 }].map(|units| numbers_of(&job(units)));
    for by in [&by_y, &by_x] {
        assert_eq!(other_place(&one, by), None, "{name} in a unit of ordinary size");
    }
    let mut faults: Vec<String> = Vec::new();
    let mut exponents: Vec<Option<[i32; 2]>> = Vec::new();
    for ((path, one), ((_, by_y), (_, by_x))) in one.iter().zip(by_y.iter().zip(&by_x)) {
        let of = [exponent(*one, *by_y, 3, near_enough), exponent(*one, *by_x, 5, near_enough)];
        let found = of[0].zip(of[1]).map(|(n, m)| [n, m]);
        if found.is_none() && one.abs() > 1e-8 && !path.contains(".histogram.") {
            faults.push(format!("{path}: {one:e} in the unit of 1, {by_y:e} and {by_x:e} in those of 8 and 32"));
        }
        exponents.push(found);
    }
    let all = [2.0, 10.0].into_iter().flat_map(|base| sizes(base, long).into_iter().map(move |units| (base, units)));
    for (base, units) in all {
        let (near, powers) = ordinary(units);
        let reference = if base == 2.0 { one.clone() } else { numbers_of(&job(near)) };
        let mut value = job(units);
        let said = take_word(&mut value);
        let found = numbers_of(&value);
        if let Some(path) = other_place(&reference, &found) {
            faults.push(format!("{path} in {units:?} is not at an ordinary size, or there only"));
            continue;
        }
        // If roundings have led to other results, such as another warning, the paths do not correspond to those of the unit of 1.
        let alike = other_place(&reference, &one).is_none();
        for (i, ((path, found), (_, reference))) in found.iter().zip(&reference).enumerate() {
            let Some(exponents) = exponents.get(i).copied().flatten().filter(|_| alike) else { continue };
            let one = one[i].1;
            // A number that is 0 has no unit, and with other roundings it is a rounding error. The last digit decides in which of two bins
            // a value lies.
            let rounding = one == 0.0 && base != 2.0;
            if rounding || near_enough > 1e-12 && path.contains(".histogram.") {
                continue;
            }
            let expected = in_units(*reference, powers, exponents);
            let right = if reference.is_nan() || found.is_nan() {
                // The number is unknown in every unit, or beyond doubles, which a warning states.
                let beyond = !(expected.abs() > 1e-305 && expected.abs() < 1e305);
                let said = said || path.contains(".rounding");
                reference.is_nan() && found.is_nan() || beyond && *reference != 0.0 && said
            } else {
                // Bounds of interval arithmetic are rounded outwards, and further for smaller bounds.
                let back = in_units(*found, powers, exponents.map(|n| -n));
                *found == expected || (back - reference).abs() <= near_enough * reference.abs().max(1e-3)
            };
            let back = in_units(*found, units, exponents.map(|n| -n));
            let far = is_figure(path) && (back - one).abs() > figures * one.abs().max(1.0);
            if !right || far {
                faults.push(format!(
                    "{path} in {units:?}: {found:e}, expected {expected:e}; {one:e} in the unit of 1, {exponents:?}"
                ));
            }
        }
    }
    let count = faults.len();
    faults.truncate(12);
    assert!(faults.is_empty(), "{name}: {count} faults, {faults:#?}");
}

fn analysed(name: &'static str, problem: fn(Units) -> Problem, options: &Options) {
    let job = |units: Units| serde_json::to_value(analyze(&problem(units), options).unwrap()).unwrap();
    the_same_in_every_unit(name, &job);
}

#[test]
fn every_method_is_the_same_in_every_unit() {
    for method in [
        Method::Rss,
        Method::WorstCase,
        Method::SecondOrder,
        Method::Full,
        Method::Classic,
        Method::SixN,
        Method::DimensionReduction,
        Method::ResponseSurface,
        Method::ThreePoint,
        Method::BivariateDimensionReduction,
    ] {
        analysed("closure by a method", closure, &Options::from(method).with_coverage(0.9));
    }
    let options = Options::from(Method::Full).with_verify(0);
    let job = |units: Units| serde_json::to_value(analyze(&correlated(units), &options).unwrap()).unwrap();
    the_same_within(Within { long: true, ..Within::USUAL }, "dimensions that vary together", &job);
}

#[test]
fn auto_is_the_same_in_every_unit() {
    let studies: [Study; 4] = [("formula", formula), ("kink", kink), ("closure", closure), ("discrete", discrete)];
    studies.into_iter().for_each(|(name, problem)| analysed(name, problem, &Options::default()));
}

#[test]
fn exact_derivatives_and_extremes_are_the_same_in_every_unit() {
    let exact = Options::from(Method::Full).with_derivatives(DerivativeSource::Exact).with_verify(0);
    analysed("exact derivatives", formula, &exact);
    analysed("extremes", formula, &Options::from(Method::Full).with_verify(0).with_extremes(true));
    analysed("extremes of a function", closure, &Options::from(Method::Full).with_verify(0).with_extremes(true));
}

#[test]
fn samples_are_the_same_in_every_unit() {
    let plain = SimulationOptions::default().with_samples(2000);
    let sobol = plain.clone().with_sampler(Sampler::Sobol);
    let control = plain.clone().with_control(Method::Full.into());
    let indices = plain.clone().with_sobol(128).with_target_joint_yield(0.9);
    for (options, studies) in [
        (&plain, [("sample", formula as fn(Units) -> Problem), ("sample of steps", discrete)]),
        (&sobol, [("points of Sobol'", correlated), ("points of Sobol'", closure)]),
        (&control, [("control variate", closure), ("control variate", correlated)]),
        (&indices, [("indices", closure), ("indices", kink)]),
    ] {
        for (name, problem) in studies {
            let job = |units: Units| serde_json::to_value(simulate(&problem(units), options).unwrap()).unwrap();
            the_same_in_every_unit(name, &job);
        }
    }
}

#[test]
fn rare_events_are_the_same_in_every_unit() {
    let options = RareOptions::default().with_samples(600);
    for (name, problem) in [("rare", formula as fn(Units) -> Problem), ("rare beside a kink", kink)] {
        let job = |units: Units| serde_json::to_value(rare(&problem(units), &options).unwrap()).unwrap();
        the_same_within(Within { figures: f64::INFINITY, ..Within::USUAL }, name, &job);
    }
}

#[test]
fn comparisons_and_sweeps_are_the_same_in_every_unit() {
    let options = CompareOptions::default().with_reference(512);
    let job = |units: Units| serde_json::to_value(compare(&closure(units), &options).unwrap()).unwrap();
    the_same_within(Within { long: true, ..Within::USUAL }, "comparison", &job);
    let job = |units: Units| {
        let values = [1.0, 1.5, 2.5].map(|value| value * units.x);
        serde_json::to_value(sweep(&closure(units), "c", &values, &Method::SixN.into()).unwrap()).unwrap()
    };
    the_same_within(Within { long: true, ..Within::USUAL }, "sweep", &job);
}

/// Differences of allocations. Tolerances are sought by their logarithms, which are rounded differently in every unit.
const SOUGHT: Within = Within { numbers: 1e-7, figures: 1e-7, long: false };

/// Allocates with costs by tolerances in their unit, and requirements in the characteristics' unit.
fn allocated(units: Units, requirement: Requirement, loss: bool) -> Value {
    let Units { y, x } = units;
    let cost = |d: usize, b: f64| {
        let curve = Curve::reciprocal(1.0, b * x).unwrap();
        Priced::new(vec![d], vec![Offer::between(curve, 0.01 * x, 0.8 * x).unwrap()]).unwrap()
    };
    let task = AllocationTask::new(vec![cost(0, 0.3), cost(1, 0.2)], vec![Some(requirement), None]);
    let losses = if loss { vec![QualityLoss::new(0, 3.0 / (y * y), 2.5 * y).unwrap()] } else { Vec::new() };
    let options =
        AllocationOptions::default().with_analysis(Options::from(Method::Full).with_verify(0)).with_confirm(2000);
    serde_json::to_value(allocate(&closure(units), &task.with_losses(losses), &options).unwrap()).unwrap()
}

#[test]
fn allocations_are_the_same_in_every_unit() {
    the_same_within(SOUGHT, "allocation by yield", &|units| allocated(units, Requirement::Yield(0.99), false));
    the_same_within(SOUGHT, "allocation by sigma", &|units| allocated(units, Requirement::Sigma(0.3 * units.y), false));
    the_same_within(SOUGHT, "allocation by worst case", &|units| allocated(units, Requirement::WorstCase, false));
}

/// The cost of a deviation is per square of the unit. If a double cannot hold it, the allocation is refused with an explanation.
#[test]
fn a_loss_has_its_place_among_doubles() {
    let near = |units: Units| allocated(units, Requirement::Yield(0.99), true);
    let [one, other] = [Units::ONE, Units { y: 2f64.powi(400), x: 1.0 }].map(near);
    assert_eq!(one["cost_after"], other["cost_after"]);
    let cost =
        Priced::new(vec![0], vec![Offer::between(Curve::reciprocal(1.0, 0.3).unwrap(), 0.01, 0.8).unwrap()]).unwrap();
    let task =
        AllocationTask::new(vec![cost], vec![None, None]).with_losses(vec![QualityLoss::new(0, 1e300, 0.0).unwrap()]);
    let huge = closure(Units { y: 1e200, x: 1.0 });
    let refused = allocate(&huge, &task, &AllocationOptions::default()).unwrap_err().to_string();
    assert!(refused.contains("`power`") && refused.contains("double-precision"), "{refused}");
}

/// The joint yield and its verdict are the same in every unit.
#[test]
fn a_joint_yield_is_the_same_in_every_unit() {
    let mut options = Options::from(Method::Full);
    options.target_joint_yield = Some(0.8);
    analysed("joint yield", formula, &options);
}

/// Every command has the figures of closed forms for y = a + b^2 with standard normal a and b, times 1e-200 and times 1e200.
#[test]
fn every_command_has_the_figures_of_closed_forms_at_every_size() {
    let truth = sensitol_testing::data("any-size.json");
    let truth = |key: &str| truth[key].as_f64().unwrap();
    for (file, scale) in [("scale-tiny.toml", 1e-200), ("scale-huge.toml", 1e200)] {
        let text = std::fs::read_to_string(sensitol_testing::repository("tests/data/any-size").join(file)).unwrap();
        let problem = parse(&text).unwrap().problem;
        for method in [Method::Full, Method::SecondOrder, Method::Auto] {
            let found = &analyze(&problem, &method.into()).unwrap().characteristics[0];
            let (moments, rejected) = (found.moments.unwrap(), found.distribution.capability.unwrap().above.unwrap());
            sensitol_testing::relative(moments.mean(), truth("mean") * scale, 1e-12);
            sensitol_testing::relative(moments.sigma(), truth("sigma") * scale, 1e-12);
            sensitol_testing::relative(moments.skewness().unwrap(), truth("skewness"), 1e-10);
            sensitol_testing::relative(moments.kurtosis().unwrap(), truth("kurtosis"), 1e-10);
            // Three times the printed error reaches the right value.
            let error = found.error_estimate.as_ref().unwrap().yield_.unwrap();
            assert!((1e6 * rejected - truth("ppm_above")).abs() <= 3e6 * error && error < 2e-3, "{rejected} {error}");
        }
        // The single point of exact derivatives, at the means, has the value 0 and gives no size.
        let exact = Options::from(Method::Full).with_derivatives(DerivativeSource::Exact);
        let found = analyze(&problem, &exact).unwrap();
        let rejected = found.characteristics[0].distribution.capability.unwrap().above.unwrap();
        sensitol_testing::relative(1e6 * rejected, truth("ppm_above"), 1e-9);
        assert!(found.warnings.iter().all(|warning| warning.code() == "pearson-differs"), "{:?}", found.warnings);
        let found = &simulate(&problem, &SimulationOptions::default()).unwrap().characteristics[0];
        let figures = [found.mean, found.sigma, found.skewness, found.kurtosis].map(Option::unwrap);
        for (estimate, truth) in
            figures.iter().zip([truth("mean") * scale, truth("sigma") * scale, truth("skewness"), truth("kurtosis")])
        {
            let error = estimate.standard_error.unwrap();
            assert!(error > 0.0 && (estimate.value - truth).abs() < 4.0 * error, "{estimate:?} for {truth}");
        }
        let found = rare(&problem, &RareOptions::default().with_samples(2000)).unwrap();
        let [low, high] = found.characteristics[0].above.as_ref().unwrap().interval;
        assert!(1e6 * low < truth("ppm_above") && truth("ppm_above") < 1e6 * high);
    }
}

/// Costly model times a size. It stores the points at which it was evaluated.
struct Costly {
    signature: Signature,
    size: f64,
    asked: Arc<Mutex<Vec<Vec<u64>>>>,
}

impl Costly {
    fn new(size: f64) -> (Self, Arc<Mutex<Vec<Vec<u64>>>>) {
        let signature = Signature { costly: true, ..Signature::of_names(["p", "q"], ["y"]) };
        let asked: Arc<Mutex<Vec<Vec<u64>>>> = Arc::default();
        (Self { signature, size, asked: Arc::clone(&asked) }, asked)
    }
}

impl AssemblyFunction for Costly {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
        for row in 0..request.points.rows() {
            let point = request.points.row(row);
            self.asked.lock().unwrap().push(point.iter().map(|x| x.to_bits()).collect());
            out.set(row, 0, self.size * (point[0] * point[1] - 0.01 * point[0].powi(3)));
        }
    }
}

/// Problem of a costly model, with its inputs themselves or six dimensions that drive them.
fn costly(size: f64, driven: bool) -> (Problem, Arc<Mutex<Vec<Vec<u64>>>>) {
    let (model, asked) = Costly::new(size);
    let characteristic = |name: &str| [limited(name, Some(5.5 * size), None)];
    if !driven {
        let dimensions = [Dimension::normal("p", 3.0, 0.3).unwrap(), Dimension::normal("q", 2.0, 0.2).unwrap()];
        return (Problem::new(dimensions, model).unwrap().asking(characteristic("y")).unwrap(), asked);
    }
    let names: Vec<String> = (0..6).map(|i| format!("x{i}")).collect();
    let formula = |text: &str| Formula::parse(text).unwrap();
    let parts = Parts {
        inputs: names.iter().map(|name| Input { name: name.clone(), unit: None }).collect(),
        model: Some((Arc::new(model), vec![Source::Formula(0), Source::Formula(1)])),
        formulas: vec![
            ("p".into(), formula("x0 + x1 + x2")),
            ("q".into(), formula("x3 + x4*x5")),
            ("z".into(), formula("y")),
        ],
        outputs: vec![("z".into(), None)],
        ..Parts::default()
    };
    let dimensions = names.iter().map(|name| Dimension::normal(name, 1.0, 0.1).unwrap());
    (Problem::new(dimensions, Composite::new(parts).unwrap()).unwrap().asking(characteristic("z")).unwrap(), asked)
}

/// Finding the size of an output costs no evaluations of its own. A costly model is evaluated at no point twice, and as often as at an
/// ordinary size.
#[test]
fn a_costly_model_of_extreme_size_is_asked_no_more() {
    for driven in [false, true] {
        for method in [Method::SecondOrder, Method::Full, Method::Auto, Method::ResponseSurface] {
            let run = |size: f64| {
                let (problem, asked) = costly(size, driven);
                let found = analyze(&problem, &method.into()).unwrap();
                let points = asked.lock().unwrap().clone();
                assert_eq!(
                    points.iter().collect::<HashSet<_>>().len(),
                    points.len(),
                    "{method} {size:e}: a point twice"
                );
                assert_eq!(found.run.evaluations as usize, points.len(), "{method} {size:e} {driven}");
                let moments = found.characteristics[0].moments.unwrap();
                (
                    points,
                    moments.mean() / size,
                    moments.sigma() / size,
                    moments.skewness(),
                    found.characteristics[0].distribution.capability.unwrap().below,
                )
            };
            let one = run(1.0);
            // At powers of two the results agree to the last bit.
            for size in [2f64.powi(700), 2f64.powi(-900)] {
                assert_eq!(run(size), one, "{method} {size:e} {driven}");
            }
        }
    }
}
