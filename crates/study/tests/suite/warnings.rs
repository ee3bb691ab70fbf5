//! Warnings: text, data and advice of each.

use std::collections::BTreeSet;

use sensitol::warning::aggregate::aggregated;

use sensitol::warning::{Advice, Change, ContactShare, Counted, Ended, Figure, Loss, NameKind, Warning};
use sensitol::{Method, StopReason, analyze};
use sensitol_study::Study;

fn text(text: &str) -> String {
    text.to_owned()
}

fn names(count: usize) -> Vec<String> {
    (0..count).map(|i| format!("d{i}")).collect()
}

/// At least one warning of each code, and of the cases with a text of their own.
fn every() -> Vec<Warning> {
    let (characteristic, dimension) = (|| text("gap"), || text("a"));
    let lost = |loss, dimensions: usize, others: usize| Warning::LostDerivative {
        characteristic: characteristic(),
        dimensions: names(dimensions),
        loss,
        others: names(others),
    };
    let proven = |ended, failure: Option<&str>, bounds| Warning::NotProven {
        characteristic: characteristic(),
        evaluations: 174,
        ended,
        failed: usize::from(failure.is_some()),
        failure: failure.map(text),
        bounds,
    };
    let stopped = |cause, limit_s, done, planned| {
        let counted = Counted::Points;
        Warning::Stopped { cause, limit_s, done, planned, counted }
    };
    let resolved = |figure, error, budget| Warning::UnderResolved {
        characteristic: characteristic(),
        figure,
        error,
        wanted: 0.01,
        budget,
    };
    let far = |directions, residual| Warning::FarResidual {
        characteristic: characteristic(),
        directions,
        residual,
        from: 2.0,
        share: 0.0228,
    };
    let contacts = |sampled, sets: usize| Warning::ContactSwitch {
        characteristic: characteristic(),
        switch: text("the contacts of joint `stand`"),
        change: Change::Kink,
        contacts: (0..sets)
            .map(|set| {
                let share = 1.0 / sets as f64;
                ContactShare { contacts: vec![text("leg1"), format!("leg{}", 2 + set)], share, error: 0.004 }
            })
            .collect(),
        sampled,
    };
    let (output, expected, found) = (|| text("gap"), Some(0.2), Some(0.3));
    let (times, points, suspects) = (2, 7, || vec![text("a = 1.5"), text("b = 2.5")]);
    vec![
        Warning::UnusedDimension { dimensions: names(1) },
        Warning::UnusedDimension { dimensions: names(997) },
        Warning::NominalOutsideLimits { dimensions: names(1) },
        Warning::NominalOutsideLimits { dimensions: names(2) },
        Warning::MeanOutsideLimits { characteristics: names(1) },
        Warning::MeanOutsideLimits { characteristics: names(2) },
        Warning::DominantDimension {
            characteristic: characteristic(),
            dimension: dimension(),
            share: 0.9985,
            factor: 250.0,
        },
        Warning::Overflow { characteristic: characteristic(), value: 1.5e200, limit: 1e100 },
        Warning::Unrepresentable { characteristic: characteristic() },
        Warning::OutsideModel { output: text("H_req"), reason: text("below 2 t the flanges of the section overlap") },
        Warning::UnitMismatch {
            formula: text("characteristics.gap.formula"),
            column: 1,
            part: text("a + phi"),
            what: text("a sum of mm and N"),
            instead: text("correct the unit of one of them, or the formula"),
            others: names(0),
        },
        Warning::UnitMismatch {
            formula: text("formulas.gap"),
            column: 7,
            part: vec!["a"; 100].join(" + "),
            what: text("a sum of mm and in (factor 25.4)"),
            instead: text("write 25.4[mm/in]*a, or units = \"convert\" at the top"),
            others: names(3),
        },
        Warning::RowsByCopula { dimensions: [text("bore"), text("pin")], correlation: [0.8581, 0.8422] },
        Warning::PeriodicInput { dimensions: names(1) },
        Warning::PeriodicInput { dimensions: names(2) },
        Warning::Interference { element: text("ds"), share: Some(0.004) },
        Warning::Interference { element: text("ds"), share: None },
        Warning::UnknownUnit { units: vec![text("furlong")] },
        Warning::UnmatchedRows { dimension: text("pin"), file: text("pin.csv"), unmatched: 1, lines: vec![12] },
        Warning::UnmatchedRows {
            dimension: text("pin"),
            file: text("pin.csv"),
            unmatched: 7,
            lines: vec![2, 3, 4, 5, 6],
        },
        Warning::UnknownUnit { units: names(30) },
        Warning::UnusedName { kind: NameKind::Constant, names: names(1) },
        Warning::UnusedName { kind: NameKind::Formula, names: names(2) },
        Warning::UnusedName { kind: NameKind::Unknown, names: names(30) },
        Warning::NearSingular { unknown: text("phi"), condition: 3e9 },
        Warning::MissingValues {
            dimension: dimension(),
            file: text("pin.csv"),
            missing: 3,
            rows: 125,
            lines: vec![19, 42],
        },
        Warning::Outliers {
            dimension: dimension(),
            file: text("pin.csv"),
            count: 1,
            values: 123,
            first: vec![(10.0084, 42)],
        },
        Warning::SmallSample { dimension: dimension(), values: 12, enough: 30, others: names(1) },
        Warning::NoSamplingInterval { dimensions: names(2), correlated: true },
        Warning::NoSamplingInterval { dimensions: names(1), correlated: false },
        Warning::CoarseResolution {
            dimension: dimension(),
            resolution: 0.01,
            sigma: 0.012,
            distinct: 6,
            others: names(0),
        },
        Warning::OutsideBand { dimension: dimension(), count: 2, values: 123, first: vec![(10.1, 42)], mean_too: true },
        Warning::OutsideBand {
            dimension: dimension(),
            count: 1,
            values: 123,
            first: vec![(10.1, 42)],
            mean_too: false,
        },
        Warning::FailedPoints {
            characteristic: characteristic(),
            failed: 2,
            points: 7,
            point: text("a = 1.5 (mean +1.732 sigma)"),
            error: text("no convergence"),
        },
        Warning::FailedSamples {
            characteristic: characteristic(),
            failed: 20,
            samples: 1000,
            error: text("no convergence"),
        },
        Warning::NotRepeatable { output: output(), expected, found, times, points, suspects: suspects() },
        Warning::BranchFlip { output: output(), expected, found: None, times: 1, points: 1, suspects: Vec::new() },
        Warning::Restarts {
            starts: 4,
            crashes: 2,
            timeouts: 1,
            garbage: 0,
            retried: 3,
            lost_s: 1.24,
            cause: text("the model ended while it evaluated this point (signal 11)"),
            stderr: vec![text("loading"), text("Segmentation fault")],
        },
        Warning::Restarts {
            starts: 2,
            crashes: 0,
            timeouts: 0,
            garbage: 1,
            retried: 0,
            lost_s: 0.0,
            cause: text("the model answered point 3 twice"),
            stderr: Vec::new(),
        },
        Warning::Unconfirmed { answers: 1, changed: true },
        Warning::Unconfirmed { answers: 12, changed: false },
        Warning::DamagedJournal { file: "gap.journal.sqlite".to_owned(), answers: 2 },
        Warning::OutdatedJournal { output: output(), expected, found, answers: 30 },
        Warning::NoReaction { characteristic: characteristic() },
        Warning::Atom { characteristic: characteristic(), points: 3 },
        Warning::Noise { characteristic: characteristic(), rounding: 2e-4 },
        Warning::Scatter { characteristic: characteristic(), scatter: 1e-3, drowned: 0 },
        Warning::Scatter { characteristic: characteristic(), scatter: 1e-3, drowned: 3 },
        lost(Loss::Centre, 0, 0),
        lost(Loss::Slope, 1, 0),
        lost(Loss::Curvature, 1, 12),
        lost(Loss::Mixed, 2, 1),
        lost(Loss::OneSidedMixed, 2, 0),
        lost(Loss::NotEvaluated { derivatives: 27 }, 0, 0),
        Warning::LostMoments {
            characteristic: characteristic(),
            because: text("2 of the 81 values of its quadrature are missing"),
        },
        Warning::DomainEdge {
            characteristic: characteristic(),
            dimension: dimension(),
            failed: 1.732,
            used: 1.0,
            others: names(0),
        },
        Warning::RecordedFailures { characteristic: characteristic(), failed: 1, point: text("b = 12.3") },
        Warning::RecordedFailures { characteristic: characteristic(), failed: 4, point: text("b = 12.3") },
        Warning::DomainEdgeWithin { characteristic: characteristic(), failed: 2, points: 12, share: None },
        Warning::DomainEdgeWithin { characteristic: characteristic(), failed: 2, points: 12, share: Some(0.067) },
        Warning::SupportEdge { dimension: dimension(), from: -2.287, to: -1.169, others: names(3) },
        Warning::LongTail {
            characteristic: characteristic(),
            dimension: dimension(),
            farthest: 3.2,
            reach: 9.0,
            share: 0.031,
            others: names(0),
        },
        Warning::InfiniteMoment { characteristic: characteristic(), figure: Figure::Kurtosis, dimensions: names(1) },
        Warning::InfiniteMoment { characteristic: characteristic(), figure: Figure::Sigma, dimensions: names(2) },
        Warning::PairsNotExamined { examined: 10, possible: 45 },
        Warning::RssInvalid { characteristic: characteristic(), mean_shift: 0.4, variance: 0.29 },
        Warning::HigherOrder {
            characteristic: characteristic(),
            dimension: dimension(),
            coefficients: [0.1, -0.02],
            held: true,
            others: names(1),
        },
        Warning::HigherOrder {
            characteristic: characteristic(),
            dimension: dimension(),
            coefficients: [0.1, -0.02],
            held: false,
            others: names(0),
        },
        Warning::ShallowRules { characteristic: characteristic(), share: 0.292 },
        Warning::PoorFit { characteristic: characteristic(), residual: 0.12 },
        Warning::ChoiceNotSampled { characteristic: characteristic(), choice: "the choice of `shim`".to_owned() },
        Warning::KinkAtNominal { characteristic: characteristic(), dimensions: names(3) },
        Warning::Kink {
            characteristic: characteristic(),
            dimension: dimension(),
            slopes: [-1.0, 1.0],
            between: [-1.73, 1.73],
            others: names(20),
        },
        Warning::Discontinuity {
            characteristic: characteristic(),
            dimension: dimension(),
            by: 2.5,
            between: [0.0, 1.0],
            at: Some([9.9, 10.0]),
            others: names(0),
        },
        Warning::InteractionsLeftOut { characteristic: characteristic(), share: 0.012 },
        Warning::ConditionalVerdict { characteristics: names(2) },
        far(vec![(dimension(), true), (text("pin"), false)], 3.2),
        far(Vec::new(), -0.7),
        Warning::UntrustedSurrogate { characteristic: characteristic(), share: 0.115, sampled: Some(16_384) },
        Warning::UntrustedSurrogate { characteristic: characteristic(), share: 0.115, sampled: None },
        resolved(Figure::Sigma, Some(0.02), true),
        resolved(Figure::Yield, Some(0.02), false),
        resolved(Figure::Skewness, None, false),
        resolved(Figure::Kurtosis, None, true),
        Warning::InfeasibleMoments {
            characteristic: characteristic(),
            reason: text("the kurtosis 0.9 is not above 1"),
        },
        Warning::NearInfeasibleMoments { characteristic: characteristic(), skewness: 0.0, kurtosis: 1.02 },
        Warning::PearsonDiffers { characteristic: characteristic(), pearson: 1017e-6, rejected: 3415e-6, error: 30e-6 },
        Warning::SeveralModes { characteristic: characteristic(), coefficient: 0.8 },
        Warning::Switch {
            characteristic: characteristic(),
            switch: text("`abs(a)`"),
            change: Change::Kink,
            probability: 0.3,
            points: None,
        },
        Warning::Switch {
            characteristic: characteristic(),
            switch: text("`sign(a)`"),
            change: Change::Jump,
            probability: 3e-6,
            points: Some(0.3),
        },
        Warning::Switch {
            characteristic: characteristic(),
            switch: text("`ln(a)`"),
            change: Change::Edge,
            probability: 0.01,
            points: None,
        },
        contacts(false, 2),
        contacts(true, 6),
        Warning::Pole { characteristic: characteristic(), switch: text("`1/a`"), probability: 1e-5 },
        Warning::FigureOff {
            characteristic: characteristic(),
            figure: "sigma",
            value: 0.057,
            model: 0.0467,
            error: 1e-4,
        },
        Warning::HeavyPoint { characteristic: characteristic(), limit: 3.5, part: 0.7 },
        Warning::NothingBeyond { characteristic: characteristic(), limit: 3.5, points: 10_000, most: 3e-4 },
        Warning::PlainSampling { characteristic: characteristic(), limit: 3.5, plain: 312.4, evaluations: 1000 },
        Warning::PlainFallback { characteristic: characteristic(), limit: 3.5, points: 7500 },
        Warning::UnsettledMoments {
            characteristic: characteristic(),
            figures: vec!["skewness", "kurtosis"],
            points: 100_000,
            largest: 0.51,
            ten_largest: 0.92,
            switch: None,
        },
        Warning::UnsettledMoments {
            characteristic: characteristic(),
            figures: vec!["mean"],
            points: 100_000,
            largest: 0.01,
            ten_largest: 0.03,
            switch: Some(text("`a > 4.5`")),
        },
        Warning::TargetErrorMissed { points: 4000 },
        proven(Ended::Converged, None, None),
        proven(Ended::Converged, None, Some(([0.1, 0.4], 1000))),
        proven(Ended::Budget, Some("no convergence"), None),
        proven(Ended::Stopped, None, None),
        Warning::SurfaceLawRefuted {
            characteristic: characteristic(),
            test: "count",
            limit: 0.14,
            law: 0.060_073,
            counted: 0.028_249,
            error: 6.5e-4,
        },
        Warning::SurfaceLawRefuted {
            characteristic: characteristic(),
            test: "monotone",
            limit: 0.14,
            law: 0.060_073,
            counted: 0.028_249,
            error: 6.5e-4,
        },
        Warning::FitReplaced { dimensions: names(1) },
        Warning::FitReplaced { dimensions: names(2) },
        Warning::NotConfirmed,
        Warning::CostNotConvex { dimensions: names(1) },
        Warning::CostNotConvex { dimensions: names(2) },
        Warning::JointConfirmationMisses { required: 0.99, interval: [0.96, 0.97] },
        Warning::ConfirmationMisses {
            characteristic: characteristic(),
            requirement: "yield",
            required: 0.9973,
            interval: [0.993346, 0.994316],
        },
        Warning::ConfirmationMisses {
            characteristic: characteristic(),
            requirement: "cpk",
            required: 1.33,
            interval: [1.2104, 1.2216],
        },
        Warning::ConfirmationMisses {
            characteristic: characteristic(),
            requirement: "worst-case",
            required: 1.0,
            interval: [1.0421, 1.0421],
        },
        Warning::NothingToWrite,
        Warning::NotWritten { reason: text("`a` has its tolerance in a list") },
        stopped(StopReason::TimeLimit, Some(2.6), 11, None),
        stopped(StopReason::TimeLimit, Some(1.0), 1, Some(7)),
        stopped(StopReason::TimeLimit, None, 3, None),
        stopped(StopReason::Interrupted, None, 0, None),
        Warning::Long { expected_s: 7200.0 },
        Warning::MissingPoints { count: 1, written: None },
        Warning::MissingPoints { count: 12, written: Some(text("next.csv")) },
        Warning::UnmatchedPoints { count: 12, lines: vec![2, 3] },
        Warning::FirstStageOnly,
    ]
}

#[test]
fn every_code_has_an_example_here() {
    let shown: BTreeSet<&str> = every().iter().map(Warning::code).collect();
    assert_eq!(shown, Warning::CODES.iter().copied().collect());
}

/// Sentences of a text. Text in backquotes and decimal points do not end a sentence.
fn sentences(text: &str) -> Vec<&str> {
    text.split_inclusive(". ").map(str::trim).collect()
}

/// Rules for texts: one claim in a sentence, at most 25 words, no private words.
#[test]
fn warnings_are_short_sentences_of_plain_words() {
    const PRIVATE: [&str; 12] = [
        "nobody",
        "bought",
        "what is ",
        "asked",
        " wish",
        "known by",
        "told",
        "rest on",
        "rests on",
        "reaches far",
        "is not a number",
        "mind of",
    ];
    for warning in every() {
        let message = warning.message();
        let first = message.chars().next().unwrap();
        assert!(first == '`' || first.is_uppercase() || first.is_ascii_digit(), "{message}");
        assert!(message.ends_with('.') && !message.ends_with("..") && !message.contains("  "), "{message}");
        for sentence in sentences(&message) {
            let words = sentence.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count();
            assert!(words <= 25, "{words} words: {sentence}");
        }
        for word in PRIVATE {
            assert!(!message.to_lowercase().contains(word), "{word:?} in {message}");
        }
        for advice in warning.advice() {
            let sentence = advice.to_string();
            assert!(sentence.ends_with('.') && sentence.split_whitespace().count() <= 25, "{sentence}");
        }
    }
}

/// JSON has the documented keys, every field as data, and actions with their fields.
#[test]
fn the_fields_are_data() {
    for warning in every() {
        let json = serde_json::to_value(&warning).unwrap();
        let keys: BTreeSet<&str> = json.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, ["advice", "characteristic", "code", "data", "dimension", "message"].into());
        assert_eq!(json["data"], serde_json::to_value(warning.data()).unwrap());
        let actions = json["advice"].as_array().unwrap();
        assert_eq!(actions.len(), warning.advice().len());
        assert!(actions.iter().all(|advice| advice["action"].is_string()), "{json}");
        if let Some(characteristic) = warning.characteristic() {
            let known = ["characteristic", "output"].iter().any(|key| json["data"][key] == characteristic);
            assert!(known && json["characteristic"] == characteristic, "{json}");
        }
    }
    let fit = Warning::PearsonDiffers { characteristic: text("gap"), pearson: 1e-3, rejected: 3e-3, error: 1e-5 };
    let data = serde_json::json!({ "characteristic": "gap", "pearson": 1e-3, "rejected": 3e-3, "error": 1e-5 });
    assert_eq!(serde_json::to_value(fit.data()).unwrap(), data);
    let stopped = Warning::Stopped {
        cause: StopReason::TimeLimit,
        limit_s: Some(2.5),
        done: 11,
        planned: None,
        counted: Counted::Evaluations,
    };
    let data = serde_json::json!({
        "cause": "time-limit", "limit_s": 2.5, "done": 11, "planned": null, "counted": "evaluations"
    });
    assert_eq!(serde_json::to_value(stopped.data()).unwrap(), data);
    assert_eq!(serde_json::to_value(Advice::SmallerStep { dimension: None }).unwrap()["action"], "smaller-step");
}

/// Numbers that are not finite are null in JSON.
#[test]
fn what_is_not_finite_is_null() {
    let warning = Warning::NearSingular { unknown: text("phi"), condition: f64::INFINITY };
    assert_eq!(serde_json::to_value(&warning).unwrap()["data"]["condition"], serde_json::Value::Null);
}

/// The worst warning keeps its numbers. The order is that of the first warning of each kind.
#[test]
fn warnings_of_one_kind_become_one() {
    let kink = |characteristic: &str, dimension: &str, right| Warning::Kink {
        characteristic: text(characteristic),
        dimension: text(dimension),
        slopes: [0.0, right],
        between: [0.0, 1.0],
        others: Vec::new(),
    };
    let lost = |dimensions: &[&str], loss| Warning::LostDerivative {
        characteristic: text("gap"),
        dimensions: dimensions.iter().map(|name| text(name)).collect(),
        loss,
        others: Vec::new(),
    };
    let all = vec![
        kink("gap", "a", 1.0),
        lost(&["a", "b"], Loss::Mixed),
        kink("gap", "b", 3.0),
        kink("step", "a", 1.0),
        kink("gap", "c", 2.0),
        lost(&["a", "c"], Loss::Mixed),
        lost(&["c"], Loss::Curvature),
    ];
    let joined = aggregated(all);
    assert_eq!(joined.len(), 4, "{joined:?}");
    let others = |warning: &Warning| serde_json::to_value(warning.data()).unwrap()["others"].clone();
    assert_eq!((joined[0].dimension(), others(&joined[0])), (Some("b"), serde_json::json!(["a", "c"])));
    assert_eq!(others(&joined[1]), serde_json::json!(["a:c"]));
    assert_eq!((joined[2].characteristic(), others(&joined[2])), (Some("step"), serde_json::json!([])));
    assert_eq!(joined[3].dimension(), Some("c"));
}

/// A thousand dimensions of which two matter give one line.
#[test]
fn a_thousand_dimensions_without_effect_are_one_warning() {
    let dimensions: String = (0..1000).map(|d| format!("d{d} = {{ nominal = 1, tolerance = 0.1 }}\n")).collect();
    let study = format!("[dimensions]\n{dimensions}[characteristics]\ngap = {{ formula = \"d0 - d1\" }}\n");
    let problem = Study::from_toml(&study, "wide.toml").unwrap().problem;
    let warnings = analyze(&problem, &Method::SecondOrder.into()).unwrap().warnings;
    let unused: Vec<&Warning> = warnings.iter().filter(|warning| warning.code() == "unused-dimension").collect();
    let [Warning::UnusedDimension { dimensions }] = unused[..] else { panic!("{unused:?}") };
    assert_eq!(dimensions.len(), 998);
    assert!(unused[0].message().contains("`d2`, `d3`, `d4`, `d5`, `d6` and 993 more"), "{}", unused[0].message());
    assert_eq!(unused[0].dimension(), None);
}

/// A reversed sign and a misplaced decimal point are told, and neither is where the study is right.
#[test]
fn likely_mistakes_are_told() {
    let codes = |b: &str, formula: &str, more: &str| -> Vec<String> {
        let study = format!(
            "[dimensions]\na = {{ nominal = 20.5, tolerance = 0.02, unit = \"mm\" }}\nb = {{ nominal = 20, {b}, unit = \"mm\" }}\n\
             [characteristics]\ngap = {{ formula = \"{formula}\", unit = \"mm\", {more} }}\n"
        );
        let problem = Study::from_toml(&study, "stack.toml").unwrap().problem;
        let warnings = analyze(&problem, &Method::SecondOrder.into()).unwrap().warnings;
        warnings.iter().map(|warning| warning.code().to_owned()).collect()
    };
    let limits = "lower = 0.2, upper = 0.8";
    assert_eq!(codes("tolerance = 0.03", "a - b", limits), [""; 0]);
    assert_eq!(codes("tolerance = 0.03", "b - a", limits), ["mean-outside-limits"]);
    assert_eq!(codes("tolerance = 3", "a - b", limits), ["dominant-dimension"]);
    // 99 times as wide is not told, nor is a dimension that stands alone or one in another unit.
    assert_eq!(codes("tolerance = 1.98", "a - b", limits), [""; 0]);
    assert_eq!(codes("tolerance = 3", "b", "lower = 10"), ["unused-dimension"]);
    // A mean that its tolerance alone moves out is no mistake of signs.
    assert_eq!(codes("tolerance = [-1, 0]", "a - b", "upper = 0.8"), [""; 0]);
}
