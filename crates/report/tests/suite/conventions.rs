//! Capability of processes, and inflations of the RSS: printed stacks, and every form by hand.

use sensitol::distribution::{Distribution, Drifting};
use sensitol::{CharacteristicAnalysis, Method, Options, analyze};
use sensitol_report::{About, Detail, Report, Style, TotalKind, text};
use sensitol_study::Study;
use sensitol_study::StudyText;
use sensitol_testing::{case, close, dimension, faults, parse, relative, repository};

fn one(text: &str) -> CharacteristicAnalysis {
    let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
    analyze(&study.problem, &Method::SecondOrder.into()).unwrap().characteristics.remove(0)
}

/// Drake's motor: printed to four digits, and computed to full precision by an independent route.
#[test]
fn a_printed_stack_of_a_motor() {
    let case = case("motor");
    let halves: Vec<f64> =
        case["inputs"]["half bands"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect();
    let lines = halves.iter().enumerate().map(|(i, t)| format!("d{i} = {{ nominal = 1, tolerance = {t:?} }}\n"));
    let sum = (0..halves.len()).map(|i| format!("d{i}")).collect::<Vec<_>>().join(" + ");
    let text = format!(
        "[dimensions]\n{}[characteristics]\ngap = {{ formula = \"{sum}\" }}\n[analysis]\nrss_factor = \"modified\"\n",
        lines.collect::<String>()
    );
    let found = one(&text);
    let [lower, upper] = found.range.worst_case.unwrap();
    let ours = [0.5 * (upper - lower), found.linear.rss.unwrap(), found.linear.inflated_rss.unwrap()];
    for (found, key) in ours.into_iter().zip(["worst case", "rss", "modified rss"]) {
        let printed = &case["printed"][key];
        close(found, printed["value"].as_f64().unwrap(), printed["tolerance"].as_f64().unwrap(), 1.0);
    }
    // Slopes of 1 from differences of values of 11 are accurate to 1e-12.
    relative(found.linear.inflated_rss.unwrap(), case["exact"]["modified_rss"].as_f64().unwrap(), 1e-11);
    relative(found.linear.mean_shift_rss.unwrap(), case["exact"]["mean_shift_rss"].as_f64().unwrap(), 1e-11);
}

/// Seven processes, one of them off by a quarter of its half-width: cp 2 and cpk 1.5.
#[test]
fn a_printed_six_sigma_stack() {
    let case = case("mitcalc-six-sigma");
    let sigmas: Vec<f64> = case["inputs"]["sigmas"].as_array().unwrap().iter().map(|s| s.as_f64().unwrap()).collect();
    let line = |(i, sigma): (usize, &f64)| match i {
        0 => format!("d0 = {{ nominal = 1, tolerance = {:?}, cp = 2, cpk = 1.5 }}\n", 6.0 * sigma),
        _ => format!("d{i} = {{ nominal = 1, tolerance = {:?} }}\n", 3.0 * sigma),
    };
    let text = |at: &str| {
        let lines: String = sigmas.iter().enumerate().map(line).collect();
        format!(
            "[dimensions]\n{lines}[characteristics]\ny = {{ formula = \"d0 + d1 + d2 + d3 + d4 + d5 + d6\" }}\n{at}"
        )
    };
    let found = one(&text(""));
    let effective = found.linear.six_sigma.unwrap();
    // Slopes of 1 from differences of values of 7 are accurate to 1e-12.
    relative(effective, case["exact"]["effective sigma"].as_f64().unwrap(), 1e-11);
    relative(4.5 * effective, case["exact"]["half width"].as_f64().unwrap(), 1e-11);
    let printed = |key: &str| case["printed"][key]["value"].as_f64().unwrap();
    close(effective, printed("effective sigma"), 5e-6, 1.0);
    close(4.5 * effective, printed("half width"), 5e-6, 1.0);
    // The table has three effective sigmas, between the other totals.
    let study = parse(&text("")).unwrap();
    let analysis = analyze(&study.problem, &Method::SecondOrder.into()).unwrap();
    let stack = Report::of(&study.problem, &analysis, About::default()).stacks().remove(0);
    let total = stack.totals.iter().find(|total| total.kind == TotalKind::SixSigma).unwrap();
    relative(total.half_width.unwrap(), 3.0 * effective, 1e-15);
}

/// GUM Supplement 1, 9.5.4, table 11: four Student distributions, an arc sine, two curvilinear trapezoids, one rectangle, one normal.
#[test]
fn a_printed_calibration_of_a_gauge_block() {
    let case = case("gum-s1-9-5");
    let printed =
        |key: &str| [&case["printed"][key]["value"], &case["printed"][key]["tolerance"]].map(|v| v.as_f64().unwrap());
    let study = Study::read(&repository("examples/measurement-uncertainty/gauge-block.toml")).unwrap();
    let options = Options::from(Method::Full).with_verify(0).with_coverage(0.99);
    let found = analyze(&study.problem, &options).unwrap().characteristics.remove(0);
    let moments = found.moments.unwrap();
    let ([mean, of_mean], [sigma, of_sigma]) = (printed("mean"), printed("sigma"));
    assert!((moments.mean() - mean).abs() <= of_mean && (moments.sigma() - sigma).abs() <= of_sigma, "{moments:?}");
    for interval in [found.distribution.coverage.unwrap().equal_tails, found.distribution.coverage.unwrap().shortest] {
        for (end, printed) in interval.into_iter().zip(case["printed"]["99 % interval"].as_array().unwrap()) {
            // Printed to 1 nm. 65 536 points have an error of 0.7 nm at a tail of 0.5 %. The width of the shortest interval is flat about
            // its place.
            close(end, printed["value"].as_f64().unwrap(), 3.0, 1.0);
        }
    }
    // The printed ends are whole nanometres. Half a nanometre changes a share of 99 % by 4e-4, and 65 536 counted points have a similar
    // error.
    let law = found.evidence.surface_law.unwrap();
    close(1.0 - law.below.unwrap().value - law.above.unwrap().value, 0.99, 1.5e-3, 1.0);
}

/// Factors and shifts of single dimensions, by hand: half-widths 0.3 and 0.4.
#[test]
fn factors_and_shifts_of_single_dimensions() {
    let text = |a: &str, all: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.3{a} }}\nb = {{ nominal = 1, tolerance = 0.4 }}\n\
             [characteristics]\ny = {{ formula = \"a + b\" }}\n[analysis]\n{all}\n"
        )
    };
    let found = |a: &str, all: &str| {
        let found = one(&text(a, all));
        [found.linear.inflated_rss.unwrap(), found.linear.mean_shift_rss.unwrap()]
    };
    let rest = |a: f64, b: f64| f64::hypot((1.0 - a) * 0.3, (1.0 - b) * 0.4);
    for (a, all, inflated, shifted) in [
        ("", "", 0.75, 0.35 + 0.25),
        ("", "rss_factor = 1.2\nmean_shift = 0.2", 0.6, 0.14 + 0.4),
        (", rss_factor = 2", "", f64::hypot(0.6, 0.6), 0.6),
        (", rss_factor = 2, mean_shift = 1", "rss_factor = 1.2", f64::hypot(0.6, 0.48), 0.3 + 0.2 + rest(1.0, 0.5)),
        (", mean_shift = 0", "mean_shift = 0.25", 0.75, 0.1 + rest(0.0, 0.25)),
        // W = 0.7, R = 0.5, n = 2: 1 + 0.2/(2 0.5 (sqrt 2 - 1)).
        ("", "rss_factor = \"modified\"", 0.5 + 0.1 / (2f64.sqrt() - 1.0), 0.6),
    ] {
        let [first, second] = found(a, all);
        // Slopes of 1 from differences are accurate to 1e-12.
        relative(first, inflated, 1e-11);
        relative(second, shifted, 1e-11);
    }
}

/// Band 9.6 to 10.8: half-width 0.6, middle 10.2.
#[test]
fn a_process_places_the_mean() {
    let figures = |line: &str| {
        let found = dimension(&format!("{{ nominal = 10, tolerance = [-0.4, 0.8], {line} }}")).unwrap();
        (found.mean(), found.sigma(), found.distribution().unwrap().name())
    };
    for (line, mean, sigma, name) in [
        ("cpk = 2", 10.2, 0.1, "normal"),
        ("cp = 2, cpk = 2", 10.2, 0.1, "normal"),
        ("cp = 2, cpk = 1.5, side = \"+\"", 10.35, 0.1, "normal"),
        ("cp = 2, cpk = 1.5, side = \"-\"", 10.05, 0.1, "normal"),
        ("cp = 2, cpk = 1.5", 10.2, f64::hypot(0.1, 0.15), "mixture"),
        ("cp = 2, drift = 0.3", 10.2, f64::hypot(0.1, 0.3 / 3f64.sqrt()), "drifting-normal"),
        ("sigma = 0.1, drift = 0", 10.2, 0.1, "normal"),
        ("cp = 2, shift = 0.05, drift = 0.3", 10.25, f64::hypot(0.1, 0.3 / 3f64.sqrt()), "drifting-normal"),
    ] {
        let found = figures(line);
        close(found.0, mean, 1e-14, 1.0);
        relative(found.1, sigma, 1e-12);
        assert_eq!(found.2, name, "{line}");
    }
    // A lot has sigma 0.1. Its mean is off by cpk, or by 0.3: the effective sigma is sigma/(1 - k) with k = 0.25, 0.5.
    for (line, effective) in
        [("cp = 2, cpk = 1.5", 0.1 / 0.75), ("cp = 2, drift = 0.3", 0.2), ("cp = 2, shift = 0.3", 0.2)]
    {
        let text = format!(
            "[dimensions]\na = {{ nominal = 10, tolerance = [-0.4, 0.8], {line} }}\n[characteristics]\ny = {{ formula = \"2*a\" }}\n"
        );
        relative(one(&text).linear.six_sigma.unwrap(), 2.0 * effective, 1e-11);
    }
    let centred = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n[characteristics]\ny = { formula = \"a\" }\n";
    assert_eq!(one(centred).linear.six_sigma, None);
}

/// Halving the tolerance keeps cp and cpk, in the problem and in the rewritten study.
#[test]
fn capabilities_stay_where_a_tolerance_changes() {
    for (line, mean, sigma) in [
        ("cp = 2, cpk = 1.5, side = \"+\"", 10.2 + 0.075, 0.05),
        ("cp = 2, cpk = 1.5", 10.2, f64::hypot(0.05, 0.075)),
        // A drift and a shift stay unchanged.
        ("cp = 2, drift = 0.3", 10.2, f64::hypot(0.05, 0.3 / 3f64.sqrt())),
        ("cp = 2, shift = 0.05, drift = 0.3", 10.25, f64::hypot(0.05, 0.3 / 3f64.sqrt())),
    ] {
        let text = format!(
            "[dimensions]\na = {{ nominal = 10, tolerance = [-0.4, 0.8], {line} }}\n[characteristics]\ny = {{ formula = \"2*a\" }}\n"
        );
        let study = parse(&text).unwrap();
        let half = study.problem.dimensions()[0].scaled(0.5).unwrap().unwrap();
        let wanted = study.problem.clone().with_dimensions(vec![half]).unwrap();
        let written = parse(&study.rewritten(&wanted).unwrap().text).unwrap();
        for problem in [&wanted, &written.problem] {
            let found = &problem.dimensions()[0];
            close(found.mean(), mean, 1e-14, 1.0);
            relative(found.sigma(), sigma, 1e-12);
        }
    }
}

const SHOP: &str = "turning = { cp = 2, cpk = 1.5, side = \"+\" }\nlapping = { sigma = 0.05, drift = 0.03 }\nsawing = { distribution = \"uniform\" }\n";

/// A database of processes, in the study or in a file: the line's own keys have priority.
#[test]
fn dimensions_take_what_their_process_holds() {
    let lines = "a = { nominal = 10, tolerance = 0.6, process = \"turning\" }\nb = { nominal = 10, tolerance = 0.6, process = \"turning\", cp = 1 }\n\
                 c = { nominal = 10, tolerance = 0.6, process = \"lapping\" }\nd = { nominal = 10, tolerance = 0.6, process = \"sawing\" }\n";
    let rest = "[characteristics]\ny = { formula = \"a + b + c + d\" }\n";
    let within = parse(&format!("[processes]\n{SHOP}[dimensions]\n{lines}{rest}")).unwrap();
    let text = format!("processes = \"shop.toml\"\n[dimensions]\n{lines}{rest}");
    let beside = Study::from_text(StudyText::toml("study.toml", text).with_file("shop.toml", SHOP)).unwrap();
    let expanded = parse(&within.expanded).unwrap_or_else(|error| panic!("{error}\n{}", within.expanded));
    for study in [&within, &beside, &expanded] {
        let found: Vec<(f64, f64)> = study.problem.dimensions().iter().map(|one| (one.mean(), one.sigma())).collect();
        let sigmas = [0.1, 0.2, f64::hypot(0.05, 0.03 / 3f64.sqrt()), 0.6 / 3f64.sqrt()];
        for ((mean, sigma), (expected, own)) in found.into_iter().zip([10.15, 10.0, 10.0, 10.0].into_iter().zip(sigmas))
        {
            close(mean, expected, 1e-13, 1.0);
            relative(sigma, own, 1e-12);
        }
    }
}

/// Every fault is reported with its place and the text to write instead.
#[test]
fn processes_at_fault() {
    let line = |line: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1, {line} }}\n[characteristics]\ny = {{ formula = \"a\", lower = 0 }}\n"
        )
    };
    for (keys, expected) in [
        ("tolerance = 0.1, cp = 1.33, cpk = 1.5", "`cp` and `cpk` disagree: cpk 1.5 is above cp 1.33"),
        ("tolerance = 0.1, cpk = 0", "dimensions.a.cpk: 0 is not above 0"),
        ("tolerance = 0.1, cpk = 1.33, sigma = 0.03", "`cpk` and `sigma` disagree"),
        ("tolerance = 0.1, cpk = 1.33, sigmas = 3", "`sigmas` and `cpk` disagree"),
        ("cpk = 1.33", "`cpk` needs a tolerance"),
        ("tolerance = 0.1, side = \"+\"", "write both beside it"),
        ("tolerance = 0.1, cp = 1.33, side = \"+\"", "`cpk` is missing"),
        ("tolerance = 0.1, cp = 1.33, cpk = 1, side = \"up\"", "there is no side `up`"),
        ("tolerance = 0.1, cp = 1.33, cpk = 1, shift = 0.01", "both say where the mean lies"),
        ("tolerance = 0.1, drift = -0.1", "dimensions.a.drift: -0.1 is not 0 or above"),
        ("drift = 0.1", "`drift` needs a tolerance"),
        (
            "tolerance = 0.1, drift = 0.01, distribution = \"uniform\"",
            "`drift` means nothing for the distribution `uniform`",
        ),
        (
            "tolerance = 0.1, cp = 1.33, cpk = 1, distribution = { kind = \"student\", degrees = 5 }",
            "`cpk` means nothing for the distribution `student`",
        ),
        ("tolerance = 0.1, rss_factor = 0", "dimensions.a.rss_factor: 0 is not above 0"),
        ("tolerance = 0.1, mean_shift = 1.5", "dimensions.a.mean_shift: 1.5 is not from 0 to 1"),
        ("tolerance = 0.1, process = \"turning\"", "processes = \"shop.toml\""),
        ("tolerance = 0.1, process = 3", "dimensions.a.process"),
    ] {
        let found = faults(&[&line(keys)]);
        assert!(found.contains(expected), "{keys}: {found}");
    }
    let study = |head: &str, process: &str, tail: &str| {
        format!(
            "{head}\n[dimensions]\na = {{ nominal = 1, tolerance = 0.1{process} }}\n[characteristics]\ny = {{ formula = \"a\"{tail} }}\n"
        )
    };
    for (text, expected) in [
        (study("[processes]\nturning = { cp = 1 }", ", process = \"turnig\"", ""), "did you mean `turning`?"),
        (study("[processes]\nturning = { cpp = 1 }", "", ""), "processes.turning.cpp"),
        (study("[processes]\nturning = 3", "", ""), "processes.turning"),
        (study("processes = 3", "", ""), "or the name of a file with one"),
        (study("processes = \"none.toml\"", ", process = \"turning\"", ""), "the file cannot be read"),
        (study("analysis = { rss_factor = -1 }", "", ""), "analysis.rss_factor: -1 is not above 0"),
        (study("analysis = { rss_factor = \"modifed\" }", "", ""), "did you mean `modified`?"),
        (study("analysis = { mean_shift = -0.1 }", "", ""), "analysis.mean_shift: -0.1 is not from 0 to 1"),
        (study("", "", ", lower = 0, target_cpk = -1"), "characteristics.y.target_cpk"),
        (study("", "", ", lower = 0, target_cpk = 1.33, require = \"rss\""), "leave one out"),
        (study("", "", ", target_cpk = 1.33"), "it needs limits"),
    ] {
        let found = faults(&[&text]);
        assert!(found.contains(expected), "{found}");
    }
}

/// A fault in a file beside the study is reported with its line in that file.
#[test]
fn a_file_of_processes_at_fault() {
    let text = "processes = \"shop.toml\"\n[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a\" }\n";
    let found = |shop: &str| {
        let study = StudyText::toml("study.toml", text).with_file("shop.toml", shop);
        Study::from_text(study).unwrap_err().to_string()
    };
    for (shop, expected) in [
        ("\nturning = { cpp = 1 }\n", "shop.toml, line 2, processes.turning.cpp"),
        ("\n\nturning = {", "shop.toml, line 3"),
    ] {
        let message = found(shop);
        assert!(message.contains(expected), "{message}");
    }
}

/// Second and fourth moments in closed form: of the arc sine, the u-shaped distribution and the curvilinear trapezoid over -1 .. 1, and
/// of Student's, which has no sigma with 2 degrees and no kurtosis with 4.
#[test]
fn moments_of_the_laws_of_measurement() {
    let found = |line: &str| {
        let text =
            format!("[dimensions]\nx = {{ nominal = 0, {line} }}\n[characteristics]\ny = {{ formula = \"x\" }}\n");
        one(&text).moments.unwrap()
    };
    for (name, law) in [
        ("moments arcsine", "\"arcsine\""),
        ("moments u-shaped", "\"u-shaped\""),
        ("moments curvilinear-trapezoid w 1 d 0.2", "{ kind = \"curvilinear-trapezoid\", inexactness = 0.2 }"),
    ] {
        let case = case(name);
        let exact = |key: &str| case["exact"][key].as_f64().unwrap();
        let moments = found(&format!("tolerance = 1, distribution = {law}"));
        relative(moments.sigma().powi(2), exact("m2"), 1e-12);
        relative(moments.kurtosis().unwrap(), exact("m4") / exact("m2").powi(2), 1e-12);
    }
    let case = case("moments student");
    let student =
        |degrees: u32| found(&format!("distribution = {{ kind = \"student\", degrees = {degrees}, scale = 1 }}"));
    relative(student(3).sigma(), case["exact"]["sigma, 3 degrees"].as_f64().unwrap(), 1e-12);
    relative(student(10).kurtosis().unwrap(), case["exact"]["kurtosis, 10 degrees"].as_f64().unwrap(), 1e-12);
    assert_eq!(student(4).kurtosis(), None);
}

/// Measured values already include their drift.
#[test]
fn measured_values_drift_already() {
    let text = "[dimensions]\na = { nominal = 1, measured = \"lot.csv\", drift = 0.1 }\n[characteristics]\ny = { formula = \"a\", lower = 0 }\n";
    let study = StudyText::toml("study.toml", text).with_file("lot.csv", "a\n1\n1.1\n1.2\n1.3\n1.4\n");
    let message = Study::from_text(study).unwrap_err().to_string();
    assert!(message.contains("`drift` means nothing for measured values"), "{message}");
}

/// A target Cpk is a requirement. With sigma 0.1, a limit 0.5 away gives 1.67.
#[test]
fn a_target_of_cpk_is_judged() {
    let met = |target: f64| {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.3 }}\n[characteristics]\ny = {{ formula = \"a\", lower = 0.5, target_cpk = {target:?} }}\n"
        );
        one(&text).requirements().iter().map(|judged| judged.verdict.met()).collect::<Vec<_>>()
    };
    assert_eq!(met(1.5), [Some(true)]);
    assert_eq!(met(1.8), [Some(false)]);
}

/// Distribution of a drifting mean at its extremes: normal without drift, uniform with a wide one.
#[test]
fn drifting_meets_its_limits() {
    let near = |law: &Drifting, x: f64, expected: f64| {
        relative(law.probability().unwrap().sf(x), expected, 1e-12);
    };
    // Tails of the normal distribution by mpmath 1.3: ncdf(-1), ncdf(-6). A drift of 1e-9 sigma changes them by 1e-17 relatively.
    let still = Drifting::new(0.0, 1.0, 1e-9).unwrap();
    near(&still, 1.0, 0.158_655_253_931_457_05);
    near(&still, 6.0, 9.865_876_450_376_98e-10);
    // Between lots that are far apart, the share is that of the lots.
    let wide = Drifting::new(0.0, 1.0, 1e4).unwrap();
    near(&wide, 5e3, 0.25);
    relative(wide.sigma(), (1.0f64 + 1e8 / 3.0).sqrt(), 1e-15);
}

/// GUM H.1: contributions, u_c, effective degrees, factor and expanded uncertainty as printed.
#[test]
fn a_printed_budget_of_uncertainty() {
    let case = case("gum-h1");
    let study = Study::read(&repository("examples/measurement-uncertainty/gauge-block-gum.toml")).unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let budget = Report::of(&study.problem, &analysis, About::default()).budgets().remove(0);
    let printed = |key: &str| case["printed"][key]["value"].as_f64().unwrap();
    let of = |name: &str| budget.rows.iter().find(|row| row.dimension.name == name).unwrap();
    let terms = case["inputs"]["c u"].as_array().unwrap();
    let all = ["LS", "D0", "d1", "d2", "alpha", "theta0", "dalpha", "dtheta"];
    for (name, printed) in all.into_iter().zip(terms) {
        // Printed to 0.1 nm, the last two from rounded factors: 0.58e-6 instead of 1e-6/sqrt 3 changes one by 0.4 %.
        close(of(name).contribution.unwrap(), printed.as_f64().unwrap(), 0.1, 1.0);
    }
    for (name, printed) in all.into_iter().zip(case["inputs"]["degrees"].as_array().unwrap()) {
        assert_eq!(of(name).degrees, printed.as_f64().unwrap_or(f64::INFINITY), "{name}");
    }
    close(budget.combined.unwrap(), printed("u_c"), 0.5, 1.0);
    let degrees = budget.degrees.unwrap();
    assert_eq!(degrees.floor(), printed("effective degrees"));
    // From the printed terms, which are rounded to 0.1 of 32, to the fourth power.
    relative(degrees, case["exact"]["effective degrees"].as_f64().unwrap(), 0.02);
    // scipy's quantile. The inversion of the library is accurate to 1e-8.
    relative(budget.factor.unwrap(), case["exact"]["coverage factor"].as_f64().unwrap(), 1e-7);
    close(budget.expanded.unwrap(), printed("expanded"), 0.5, 1.0);
    close(budget.estimate.unwrap(), 50_000_838.0, 0.5, 1.0);
}

/// Budgets by hand: a Student distribution counts by its scale, infinite degrees give the factor of the normal distribution, and
/// correlation removes the degrees.
#[test]
fn budgets_by_hand() {
    let budget = |text: &str| {
        let study = parse(text).unwrap();
        let analysis = analyze(&study.problem, &study.options).unwrap();
        Report::of(&study.problem, &analysis, About::default()).budgets().remove(0)
    };
    let of = |a: &str, rest: &str| {
        budget(&format!(
            "[dimensions]\na = {{ nominal = 1, {a} }}\nb = {{ nominal = 1, sigma = 4 }}\n[characteristics]\ny = {{ formula = \"a - b\" }}\n{rest}"
        ))
    };
    let plain = of("sigma = 3", "");
    // Slopes of 1 are exact, so only rounding remains. 1.959963984540054 is the normal 97.5 % quantile by mpmath.
    relative(plain.combined.unwrap(), 5.0, 1e-12);
    assert_eq!((plain.degrees, plain.probability), (Some(f64::INFINITY), 0.95));
    relative(plain.expanded.unwrap(), 5.0 * 1.959_963_984_540_054, 1e-12);
    // (5/3)^4 10 = 77.16.
    for a in ["sigma = 3, degrees = 10", "distribution = { kind = \"student\", degrees = 10, scale = 3 }"] {
        let counted = of(a, "");
        relative(counted.combined.unwrap(), 5.0, 1e-12);
        relative(counted.degrees.unwrap(), 10.0 * (5.0f64 / 3.0).powi(4), 1e-11);
    }
    let correlated = of("sigma = 3, degrees = 10", "[[correlation]]\nbetween = [\"a\", \"b\"]\nvalue = 0.5\n");
    // 9 + 16 - 2 0.5 3 4.
    relative(correlated.combined.unwrap(), 13f64.sqrt(), 1e-12);
    assert_eq!((correlated.degrees, correlated.factor, correlated.expanded), (None, None, None));
    assert_eq!(of("sigma = 3", "[analysis]\ncoverage = 0.9\n").probability, 0.9);
}

/// 95 % coverage intervals: of a gamma distribution in closed form, of four rectangles as printed in GUM Supplement 1, table 3.
#[test]
fn coverage_intervals_hold_their_share() {
    let gamma = "[dimensions]\na = { nominal = 3, sigma = 1.7320508075688772, distribution = { kind = \"gamma\", origin = 0 } }\n\
                 [characteristics]\ny = { formula = \"a\" }\n[analysis]\ncoverage = 0.95\n";
    let coverage = |text: &str| {
        let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
        analyze(&study.problem, &study.options).unwrap().characteristics.remove(0).distribution.coverage.unwrap()
    };
    let ends = |value: &serde_json::Value| [0, 1].map(|i| value[i].as_f64().unwrap());
    let exact = &case("shortest-gamma")["exact"];
    let found = coverage(gamma);
    for (found, expected) in found.equal_tails.into_iter().zip(ends(&exact["symmetric"])) {
        // Quantiles are computed to 1e-7 sigma.
        close(found, expected, 1e-6, 1.0);
    }
    let shortest = ends(&exact["shortest"]);
    // The width is flat about its minimum: it is accurate to 1e-6, and the place to the root of that.
    close(found.shortest[1] - found.shortest[0], shortest[1] - shortest[0], 1e-5, 1.0);
    found.shortest.into_iter().zip(shortest).for_each(|(found, expected)| close(found, expected, 5e-3, 1.0));
    let four = "[dimensions]\na = { nominal = 0, tolerance = 1.7320508075688772, distribution = \"uniform\" }\n\
                b = { nominal = 0, tolerance = 1.7320508075688772, distribution = \"uniform\" }\n\
                c = { nominal = 0, tolerance = 1.7320508075688772, distribution = \"uniform\" }\n\
                d = { nominal = 0, tolerance = 1.7320508075688772, distribution = \"uniform\" }\n\
                [characteristics]\ny = { formula = \"a + b + c + d\" }\n[analysis]\ncoverage = 0.95\n";
    let printed = &case("gum-s1-9-2-3")["printed"]["95 % interval half width"];
    let half = printed["value"].as_f64().unwrap();
    for [low, high] in [coverage(four).equal_tails, coverage(four).shortest] {
        close(high, half, printed["tolerance"].as_f64().unwrap(), 1.0);
        close(low, -half, printed["tolerance"].as_f64().unwrap(), 1.0);
    }
}

#[test]
fn uncertainties_at_fault() {
    let text = |a: &str, analysis: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1, {a} }}\n[characteristics]\ny = {{ formula = \"a\" }}\n[analysis]\n{analysis}\n"
        )
    };
    for (a, analysis, expected) in [
        ("sigma = 1, degrees = 0", "", "dimensions.a.degrees: 0 is not 1 or above"),
        ("distribution = { kind = \"student\", degrees = 5, scale = 1 }, degrees = 5", "", "say the same thing"),
        ("sigma = 1", "coverage = 95", "analysis.coverage: 95 is not from 0.5 to below 1"),
        ("sigma = 1", "coverage = 0.4", "analysis.coverage: 0.4 is not from 0.5 to below 1"),
    ] {
        let found = faults(&[&text(a, analysis)]);
        assert!(found.contains(expected), "{a} {analysis}: {found}");
    }
}

/// Indices by quantiles are named Cp and Cpk for an assumed process, and Pp and Ppk for measured values.
#[test]
fn measured_values_have_a_performance() {
    let report = |line: &str| {
        let written = format!(
            "[dimensions]\na = {{ {line} }}\n[characteristics]\ny = {{ formula = \"a\", lower = 0, upper = 3 }}\n"
        );
        let values: String = (0..40).map(|i| format!("{}\n", 1.0 + 0.01 * f64::from((7 * i) % 40))).collect();
        let study = Study::from_text(StudyText::toml("study.toml", written).with_file("a.csv", format!("a\n{values}")));
        let study = study.unwrap_or_else(|error| panic!("{error}"));
        let analysis = analyze(&study.problem, &Options::from(Method::SecondOrder)).unwrap();
        let report = Report::of(&study.problem, &analysis, About::default());
        text(&report.document(), Style { detail: Detail::Full, unicode: true, color: false, width: 100 })
    };
    let (assumed, measured) = (report("nominal = 1, tolerance = 0.3"), report("measured = \"a.csv\", nominal = 1"));
    assert!(assumed.contains("by quantiles (ISO 22514-2): Cp ") && !assumed.contains("Ppk"), "{assumed}");
    assert!(measured.contains("by quantiles (ISO 22514-2): Pp ") && measured.contains("Ppk"), "{measured}");
}
