//! Tests that every field of every result is in its report. A new field that is missing from them does not compile, one that is missing
//! from the report fails.

use serde_json::{Value, to_value};

use crate::*;
use sensitol::allocation::{
    Allocated, Allocation, AllocationOptions, AllocationTask, Curve, Kept, Offer, Priced, allocate,
};
use sensitol::analysis::{
    CharacteristicAnalysis, ContributionFigures, DistributionFigures, Evidence, Interaction, LinearFigures,
    MissingPoints, RangeFigures, Sensitivity, analyze,
};
use sensitol::assembly::Closure;
use sensitol::compare::{CompareOptions, Comparison, Contender, NotRun, Ran, compare};
use sensitol::method::Method;
use sensitol::rare::{Beyond, RareCharacteristic, RareEvents, RareOptions, rare};
use sensitol::simulation::{SimulatedCharacteristic, Simulation, SimulationOptions, simulate};
use sensitol::summary::RunSummary;
use sensitol::sweep::{Sweep, sweep};
use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
use sensitol_numeric::requirement::Requirement;

/// Destructures a result by all of its field names, and looks up each in the JSON by its pointer.
macro_rules! complete {
    ($json:expr, $value:expr => $type:ident { $($field:ident: $pointer:literal),* $(,)? }) => {
        let $type { $($field: _),* } = $value;
        $(assert!(
            $json.pointer($pointer).is_some(),
            "{}.{} is not in the report at {}: {:#}", stringify!($type), stringify!($field), $pointer, $json
        );)*
    };
}

fn problem() -> Problem {
    let dimensions = [Dimension::normal("a", 10.0, 0.3).unwrap(), Dimension::normal("b", 5.0, 0.4).unwrap()];
    let limits = SpecLimits::new(Some(49.0), Some(51.5)).unwrap();
    let area = Characteristic::new("area").with_limits(limits).with_target_yield(0.9).unwrap();
    let area = area.with_requirement(Requirement::Cpk(1.0)).unwrap();
    Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1])).unwrap().asking([area]).unwrap()
}

fn json(report: &impl Serialize) -> Value {
    to_value(report).unwrap()
}

fn run_of(json: &Value, run: &RunSummary) {
    complete!(json, run => RunSummary {
        evaluations: "/evaluations", cached: "/cached", retried: "/retried", failed: "/failed", stages: "/stages",
        wall: "/wall_s", in_model: "/in_model_s", seed: "/seed", stopped: "/stopped", evaluator: "/evaluator",
    });
}

fn characteristic(json: &Value, one: &CharacteristicAnalysis) {
    // Keys of figures from sampling, resampling, search and fit are present here too, as null.
    complete!(json, one => CharacteristicAnalysis {
        characteristic: "/name", nominal: "/nominal", moments: "/kurtosis", error_estimate: "/error_estimate", distribution: "", range: "",
        linear: "", sensitivities: "/sensitivities/1", contributions: "", evidence: "", missing: "", constant: "/constant",
    });
    complete!(json, &one.distribution => DistributionFigures {
        yield_source: "/yield_source", capability: "/cpk", reject_intervals: "/ppm_above_interval", quantiles: "/quantiles",
        coverage: "/coverage", distribution_free_yield: "/distribution_free_yield", conditional: "/conditional_yield", inspection: "/inspection",
    });
    complete!(json, &one.range => RangeFigures {
        worst_case: "/worst_case/linear", curved: "", extremes: "/worst_case/extremes", bounds: "/worst_case/bounds",
    });
    complete!(json, &one.linear => LinearFigures {
        middle: "/middle", rss: "/rss", inflated_rss: "/inflated_rss", mean_shift_rss: "/mean_shift_rss", six_sigma: "/six_sigma",
    });
    complete!(json, &one.contributions => ContributionFigures {
        interactions: "/interactions/0", interactions_remainder: "/interactions_remainder",
        possible_interactions: "/possible_interactions", examined_interactions: "/examined_interactions",
        left_out_share: "/left_out_share", indices: "/sobol",
    });
    complete!(json, &one.evidence => Evidence {
        sampled: "/surrogate_sampling", model_sampled: "/model_sampling", tail_sampled: "/tail_sampling", verification: "/verification", surface_law: "/surface_law",
        density: "", residual: "/least_squares", law: "/distribution", pearson: "/pearson_fit", normal: "/normal_fit",
        sampling: "/sampling_interval",
    });
    complete!(json, &one.missing => MissingPoints { unfinished: "/unfinished", without_value: "/without_value" });
    let sensitivity = json.pointer("/sensitivities/0").unwrap();
    complete!(sensitivity, &one.sensitivities[0] => Sensitivity {
        dimension: "/dimension", first: "/first", second: "/second", exact: "/exact", origin: "/origin", rounding: "/rounding", steps: "/steps",
        linear_share: "/linear_share", curvature_share: "/curvature_share", mean_shift: "/mean_shift",
        first_order: "/first_order", total: "/total",
    });
    let interaction = json.pointer("/interactions/0").unwrap();
    complete!(interaction, one.contributions.interactions.get(0).unwrap() => Interaction {
        dimensions: "/dimensions", mixed: "/mixed", missing: "/missing", exact: "/exact", origin: "/origin", rounding: "/rounding",
        share: "/share", mean_shift: "/mean_shift",
    });
}

fn simulated(json: &Value, one: &SimulatedCharacteristic) {
    complete!(json, one => SimulatedCharacteristic {
        characteristic: "/name", samples: "/samples", failed: "/failed", error: "/error", mean: "/mean", sigma: "/sigma",
        skewness: "/skewness", kurtosis: "/kurtosis", quantiles: "/distribution/quantiles", yield_: "/yield",
        below: "/ppm_below", above: "/ppm_above", reject_intervals: "/ppm_below_interval", cp: "/cp", cpk: "/cpk", unfinished: "/unfinished", range: "/range",
        histogram: "/histogram", control: "/control", indices: "/sobol", inspection: "/inspection",
        sampling: "/sampling_interval", unsettled: "", conditional: "/conditional_yield",
    });
}

#[test]
fn an_analysis_is_all_in_its_report() {
    let found = analyze(&problem(), &Method::Full.into()).unwrap();
    let json = json(&Report::of(&problem(), &found, About::default()));
    run_of(&json, &found.run);
    // The surface is not in the JSON: it is for pages that try other tolerances.
    complete!(json, &found => Analysis {
        method: "/method", varying: "/varying", run: "/evaluations", characteristics: "/characteristics/0",
        joint: "/joint_yield", joint_interval: "/joint_yield_interval", joint_requirement: "/joint_requirement",
        correlations: "/characteristic_correlation", account: "/account", derivatives: "/derivatives", basis: "/basis", surface: "", warnings: "/warnings",
    });
    characteristic(json.pointer("/characteristics/0").unwrap(), &found.characteristics[0]);
}

#[test]
fn samples_are_all_in_their_reports() {
    let found = simulate(&problem(), &SimulationOptions::default().with_samples(2000)).unwrap();
    let of = json(&SimulationReport::of(&problem(), &found, About::default()));
    run_of(&of, &found.run);
    // Doubts are in the report as warnings.
    complete!(of, &found => Simulation {
        sampler: "/sampler", run: "/evaluations", samples: "/samples", surrogate_evaluations: "/surrogate_evaluations",
        reached: "/reached", non_repeatable: "/warnings", joint: "/joint_yield", joint_requirement: "/joint_requirement",
        correlations: "/characteristic_correlation", characteristics: "/characteristics/0", warnings: "/warnings",
    });
    simulated(of.pointer("/characteristics/0").unwrap(), &found.characteristics[0]);

    let found = rare(&problem(), &RareOptions::default().with_samples(200)).unwrap();
    let of = json(&RareReport::of(&problem(), &found, About::default()));
    run_of(&of, &found.run);
    complete!(of, &found => RareEvents {
        method: "/surrogate", run: "/evaluations", samples: "/samples", surrogate_evaluations: "/surrogate_evaluations",
        reached: "/reached", non_repeatable: "/warnings", joint: "/joint_yield", joint_interval: "/joint_yield_interval",
        joint_requirement: "/joint_requirement", characteristics: "/characteristics/0", warnings: "/warnings",
    });
    let one = of.pointer("/characteristics/0").unwrap();
    complete!(one, &found.characteristics[0] => RareCharacteristic {
        characteristic: "/name", failed: "/failed", error: "/error", below: "/below", above: "/above", yield_: "/yield",
        yield_interval: "/yield_interval", sampling: "/sampling_interval", unfinished: "/unfinished",
    });
    let above = one.pointer("/above").unwrap();
    complete!(above, found.characteristics[0].above.as_ref().unwrap() => Beyond {
        limit: "/limit", probability: "/probability", standard_error: "/standard_error", ppm: "/ppm", interval: "/interval", bounds: "/bounds", hits: "/hits",
        effective_samples: "/effective_samples", greatest_part: "/greatest_part", plain_samples: "/plain_samples",
        design_point: "/design_point", unmet: "/unmet", plain_points: "",
    });
}

/// Serialises a result by itself: each key has the value that it has in the report, warnings included.
#[test]
fn a_result_is_written_as_in_its_report() {
    fn same(result: &impl Serialize, report: &impl Serialize) {
        let (own, report) = (json(result), json(report));
        for (key, value) in own.as_object().unwrap() {
            assert_eq!(report.get(key), Some(value), "{key}");
        }
    }
    let problem = problem();
    let mut found = analyze(&problem, &Method::Rss.into()).unwrap();
    found.warnings.push(Warning::NothingToWrite);
    same(&found, &Report::of(&problem, &found, About::default()));
    let found = simulate(&problem, &SimulationOptions::default().with_samples(2000)).unwrap();
    same(&found, &SimulationReport::of(&problem, &found, About::default()));
    let found = rare(&problem, &RareOptions::default().with_samples(200)).unwrap();
    same(&found, &RareReport::of(&problem, &found, About::default()));
}

#[test]
fn comparisons_and_sweeps_are_all_in_their_reports() {
    let options = CompareOptions::default().with_budget(100).with_reference(500).with_seed(1);
    let found = compare(&problem(), &options).unwrap();
    let of = json(&CompareReport::of(&found, About::default()));
    run_of(&of, &found.run);
    complete!(of, &found => Comparison {
        reference: "/characteristics/0/reference", ran: "/characteristics/0/methods/0", not_run: "/not_run/0",
        run: "/evaluations",
    });
    complete!(of, &found.ran[0] => Ran {
        contender: "/characteristics/0/methods/0/method", run: "/characteristics/0/methods/0/run",
        evaluations: "/characteristics/0/methods/0/evaluations", evaluation: "/characteristics/0/methods/0/evaluation_s",
        engine: "/characteristics/0/methods/0/engine_s", figures: "/characteristics/0/methods/0/sigma",
        errors: "/characteristics/0/methods/0/error_vs_reference", verdicts: "/characteristics/0/methods/0/verdict",
        pareto: "/characteristics/0/methods/0/pareto",
    });
    run_of(of.pointer("/characteristics/0/methods/0/run").unwrap(), &found.ran[0].run);
    complete!(of, &found.not_run[0] => NotRun {
        contender: "/not_run/0/method", evaluations: "/not_run/0/evaluations", projected_s: "/not_run/0/projected_s",
        reason: "/not_run/0/reason/kind",
    });
    assert!(found.ran.iter().any(|ran| ran.contender == Contender::Method(Method::Full)));

    let found = sweep(&problem(), "a", &[9.0, 10.0], &Method::Full.into()).unwrap();
    let of = json(&SweepReport::of(&problem(), &found, About::default()));
    run_of(&of, &found.run);
    complete!(of, &found => Sweep {
        dimension: "/parameter/name", values: "/parameter/values/1", analyses: "/characteristics/0/points/1/verdict",
        run: "/evaluations",
    });
}

#[test]
fn an_allocation_is_all_in_its_report() {
    let offer =
        |d| Priced::new(vec![d], vec![Offer::between(Curve::reciprocal(1.0, 0.1).unwrap(), 0.01, 1.0).unwrap()]);
    let priced = vec![offer(0).unwrap(), offer(1).unwrap()];
    let task = AllocationTask::new(priced, vec![Some(Requirement::Cpk(1.0))]);
    let found = allocate(&problem(), &task, &AllocationOptions::default()).unwrap();
    let json = json(&AllocationReport::of(&problem(), &found, None, About::default()));
    run_of(&json, &found.run);
    // The found problem appears as tolerances and as the rewritten study.
    complete!(json, &found => Allocation {
        status: "/status", problem: "/tolerances", before: "/characteristics/0/before", after: "/characteristics/0/after",
        confirmed: "/confirmed", cost_before: "/cost_before", cost_after: "/cost_after", tolerances: "/tolerances/1",
        loss: "/loss/after", cost_unrounded: "/cost_unrounded", setups: "/setups", joint_requirement: "/joint_requirement",
        goal: "/goal", cost_basis: "/cost_basis", moved: "/recentred", requirements: "/requirements/0", prices: "/shadow_prices", proof: "/proof",
        attainable: "/attainable", loosest_before: "/loosest_scaling/before", loosest_after: "/loosest_scaling/after",
        joint: "/joint_yield/after", front: "/front", confirmation: "/confirmation", run: "/evaluations", rounds: "/rounds",
        model_points: "/model_points",
        warnings: "/warnings",
    });
    let one = json.pointer("/tolerances/0").unwrap();
    complete!(one, &found.tolerances[0] => Allocated {
        dimension: "/dimension", zone: "/dimension", before: "/before", after: "/after", cost_before: "/cost_before", cost_after: "/cost_after",
        process: "/process", bound: "/at_bound", bound_price: "/bound_price",
    });
    let one = json.pointer("/requirements/0").unwrap();
    complete!(one, &found.requirements[0] => Kept {
        characteristic: "/characteristic", requirement: "/requirement", before: "/before", after: "/interval",
        sampled: "/sampled",
    });
}
