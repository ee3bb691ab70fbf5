//! HTML pages: no unintended content, no network, and a what-if that computes the results of the engine. Tests that need a browser are in
//! `tests/browser`.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::Command;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::analysis::distribution::relocated_law::law_at;
use sensitol::analysis::{LawFigure, Relocation, YieldSource};
use sensitol::capability::{Capability, Law};

use sensitol::{Analysis, Method, Options, analyze};
use sensitol_numeric::dimension::Dimension;
use sensitol_report::html::{WhatIf, analyze_html};
use sensitol_report::{About, CompareReport, Report, SimulationReport, ToDocument};
use sensitol_study::Study;
use serde_json::{Value, json};

use super::command::{run, sensitol};
use sensitol_testing::repository;

/// Every name and text of a study, as an attacker would write it.
const HOSTILE: &str = r##"
title = "<svg onload=alert(1)> & \"quotes\""
[dimensions]
"<img src=x onerror=alert(2)>" = { nominal = 10, tolerance = 0.3, unit = "\"><b>mm" }
"</script><script>alert(3)</script>" = { nominal = 5, tolerance = 0.1 }
[characteristics]
"<!--<script>" = { formula = "`<img src=x onerror=alert(2)>`*`</script><script>alert(3)</script>`", unit = "</style>", lower = 48, upper = 52, target_yield = 0.9 }
"##;

/// Distributions of every kind that scales with its tolerance, asymmetric bands, and a function of second degree.
const MIXED: &str = r##"
[dimensions]
a = { nominal = 10, tolerance = [-0.1, 0.3] }
b = { nominal = 4, tolerance = 0.2, distribution = "uniform" }
c = { nominal = 3, limits = [2.9, 3.2], distribution = { kind = "triangular", mode = 3.1 } }
d = { nominal = 2, tolerance = [0.0, 0.2], distribution = { kind = "beta", alpha = 2.0, beta = 5.0 } }
e = { nominal = 1, tolerance = 0.1, distribution = { kind = "trapezoidal", top = 0.4 } }
f = { nominal = 6, sigma = 0.05, shift = 0.02 }
"g h" = { nominal = 7, tolerance = 0.15, distribution = "truncated-normal", sigmas = 2.5 }
w = { nominal = 5, sigma = 0.1, distribution = { kind = "weibull", origin = 4.0 } }
fixed = { nominal = 1.5 }
[characteristics]
y = { formula = "a*b + c*c - d*e + 2*f*`g h` + 0.3*a*a - w*fixed + b*d", lower = 160, upper = 165, target_yield = 0.99 }
z = { formula = "a - b + c - w" , upper = 4.5 }
[analysis]
method = "full"
"##;

/// Sums only: inputs of every kind as linear, quadratic and higher terms, without products.
const SUMS: &str = r##"
[dimensions]
a = { nominal = 10, tolerance = [-0.1, 0.3] }
b = { nominal = 4, tolerance = 0.2, distribution = "uniform" }
c = { nominal = 3, limits = [2.9, 3.2], distribution = { kind = "triangular", mode = 3.1 } }
d = { nominal = 2, tolerance = [0.0, 0.2], distribution = { kind = "beta", alpha = 2.0, beta = 5.0 } }
e = { nominal = 1, tolerance = 0.1, distribution = { kind = "trapezoidal", top = 0.4 } }
"g h" = { nominal = 7, tolerance = 0.15, distribution = "truncated-normal", sigmas = 2.5 }
[characteristics]
y = { formula = "a + b - c - d + e + `g h`", lower = 18.6, upper = 19.7, target_yield = 0.99 }
curved = { formula = "b^2 + 3*c*c - sin(3*d) + e^3 + a", lower = 50, upper = 59 }
uniforms = { formula = "b + e", upper = 5.2 }
[analysis]
method = "full"
"##;

/// Products of inputs that are not normal with a normal one: the page counts points.
const PRODUCTS: &str = r##"
[dimensions]
a = { nominal = 10, tolerance = 0.3, distribution = "uniform" }
b = { nominal = 4, tolerance = 0.2, distribution = "triangular" }
c = { nominal = 3, tolerance = 0.2 }
d = { nominal = 2, tolerance = 0.3, distribution = { kind = "beta", alpha = 2.0, beta = 5.0 } }
[characteristics]
y = { formula = "a*b + 2*b*d - c*d + 3*c", lower = 54.5, upper = 61.5, target_yield = 0.95 }
[analysis]
method = "full"
"##;

fn study(text: &str) -> Study {
    Study::from_toml(text, "study.toml").unwrap()
}

fn example(name: &str) -> Study {
    Study::read(&repository(&format!("examples/{name}/study.toml"))).unwrap()
}

fn analysed(study: &Study, options: &Options) -> (Analysis, String) {
    let analysis = analyze(&study.problem, options).unwrap();
    let about = About { title: study.title.clone(), sha256: study.sha256.clone(), ..About::default() };
    let what_if = WhatIf::of(&study.problem, &analysis, &study.lines, &study.costs);
    let page = analyze_html(&Report::of(&study.problem, &analysis, about), Some(&what_if));
    (analysis, page)
}

fn page(study: &Study) -> String {
    analysed(study, &study.options).1
}

/// Checks the allowed content of a page: one style, at most one script with its data, all listed in the policy, and no address.
fn is_closed(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>"));
    let policy = page.split("Content-Security-Policy\" content=\"").nth(1).unwrap().split('"').next().unwrap();
    assert!(policy.starts_with("default-src &#x27;none&#x27;") || policy.starts_with("default-src 'none'"), "{policy}");
    assert!(!policy.contains("unsafe"), "{policy}");
    assert_eq!(page.matches("<style").count(), 1);
    let scripts = page.matches("<script").count();
    assert!(scripts == 0 || scripts == 2, "{scripts} scripts");
    for address in
        ["http:", "https:", "src=\"", "url(", "@import", "<link", "<iframe", "<object", "style=\"", " onclick"]
    {
        assert!(!page.contains(address), "the page holds {address}");
    }
}

#[test]
fn pages_ask_for_nothing() {
    for name in ["stacked-blocks", "engine-balance", "matched-pair", "fit-and-stack", "measured-pin", "two-suppliers"] {
        is_closed(&page(&example(name)));
    }
}

#[test]
fn hostile_names_are_text() {
    let study = study(HOSTILE);
    let page = page(&study);
    is_closed(&page);
    for markup in ["<img", "<svg onload", "<b>", "alert(3)</script>", "<!--", "</style><", "\"><b"] {
        assert!(!page.contains(markup), "{markup} is in the page as markup");
    }
    assert_eq!(page.matches("</script>").count(), 2);
    assert_eq!(page.matches("</style>").count(), 1);
    // The texts are still readable.
    assert!(page.contains("&lt;img src=x onerror=alert(2)&gt;"), "the name is shown");

    let simulation = sensitol::simulation::simulate(&study.problem, &Default::default()).unwrap();
    let about = About { title: study.title.clone(), ..About::default() };
    let simulated = SimulationReport::of(&study.problem, &simulation, about.clone()).html();
    let options = sensitol::compare::CompareOptions::default().with_reference(4096).with_seed(1);
    let comparison = sensitol::compare::compare_with(&study.problem, &options, &sensitol::assembly::Run::to_the_end());
    let compared = CompareReport::of(&comparison.unwrap(), about).html();
    for page in [simulated, compared] {
        is_closed(&page);
        for markup in ["<img", "<svg onload", "<b>", "<script", "<!--"] {
            assert!(!page.contains(markup), "{markup} is in the page as markup");
        }
    }
}

/// A name links to its section. Slopes are marked if they are differences; those of formulas are exact.
#[test]
fn pages_lead_to_what_they_name() {
    let exact = page(&example("fit-and-stack"));
    let links = exact.matches("<a href=\"#kc-").count();
    // Once in the verdict, once in the table of results.
    assert!(links > 0 && links == 2 * exact.matches("<section id=\"kc-").count(), "{links} links");
    assert!(!exact.contains(" ≈</td>"));
    assert!(page(&example("engine-balance")).contains(" ≈</td>"));
}

/// The largest page: every pair of 200 dimensions, with distinct products.
#[test]
fn two_hundred_dimensions_stay_below_two_megabytes() {
    let mut text = "[dimensions]\n".to_owned();
    let mut sum = String::new();
    for i in 0..200 {
        let _ = writeln!(text, "x{i} = {{ nominal = {}, tolerance = 0.1 }}", 1.0 + 0.01 * f64::from(i));
        let _ = write!(sum, "{}{}*x{i}", if i == 0 { "" } else { " + " }, 1.0 + 0.1 * f64::from(i % 7));
    }
    let _ = write!(text, "[characteristics]\ny = {{ formula = \"sqrt({sum})\", lower = 23 }}\n");
    let study = study(&text);
    let (analysis, page) = analysed(&study, &Method::Full.into());
    assert!(analysis.characteristics[0].moments.is_some());
    assert!(page.contains("\"j\":[0,0,0"), "the products are in the page");
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
    std::fs::write(cases().join("two-hundred.html"), page).unwrap();
}

/// A typical study gives a small page: 22 dimensions and 3 characteristics below 300 kB.
#[test]
fn a_usual_page_is_small() {
    let mut text = "[dimensions]\n".to_owned();
    let mut sum = String::new();
    for i in 0..22 {
        let _ = writeln!(text, "x{i} = {{ nominal = {}, tolerance = 0.1 }}", 1.0 + 0.1 * f64::from(i));
        let _ = write!(sum, "{}{}*x{i}", if i == 0 { "" } else { " + " }, 1.0 + 0.1 * f64::from(i % 7));
    }
    let _ = write!(
        text,
        "[characteristics]\ny = {{ formula = \"sqrt({sum})\", lower = 9 }}\nz = {{ formula = \"{sum}\", upper = 90 }}\nw = {{ formula = \"x0*x1 + x2*x3\", lower = 2, upper = 4 }}\n"
    );
    let page = page(&study(&text));
    assert!(page.len() < 300_000, "{} bytes", page.len());
}

/// Dimensions that cannot be changed are named with the reason.
#[test]
fn what_cannot_be_tried_is_said() {
    let mixed = page(&study(MIXED));
    assert!(mixed.contains("stays as it is: its shape"), "the Weibull law changes with its tolerance");
    let correlated = page(&example("matched-pair"));
    assert!(!correlated.contains("id=\"what-if\""), "correlated dimensions have no what-if");
    assert!(correlated.contains("Nothing can be changed in this page: dimensions are correlated"), "said why");
    let measured = page(&example("measured-pin"));
    assert!(measured.contains("stays as it is: measured"), "measured values stay");
    let zone = page(&example("fit-and-stack"));
    assert!(zone.contains("stays as it is: a coordinate of a circular zone"), "a position stays");
}

/// `--html` writes a page in addition to the printed report, and no page after a failure.
#[test]
fn the_command_line_writes_pages() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let blocks = "examples/stacked-blocks/study.toml";
    let housing = "examples/shaft-and-housing/study.toml";
    let calls: [&[&str]; 6] = [
        &["analyze", blocks],
        &["simulate", blocks, "--samples", "2000"],
        &["simulate", blocks, "--rare", "--samples", "600"],
        &["compare", blocks, "--samples", "4096"],
        &["sweep", blocks, "--over", "th=15:19:5"],
        &["allocate", housing],
    ];
    for call in calls {
        let file = path(&format!("{}.html", call[0]));
        let plain = sensitol(&[call, &["--html", &file, "-q"]].concat()).output().unwrap();
        assert!(plain.status.success(), "{plain:?}");
        assert!(!plain.stdout.is_empty(), "the report is printed too");
        let page = std::fs::read_to_string(&file).unwrap();
        is_closed(&page);
        let title = study_title(call[1]);
        assert!(page.contains(&format!("<h1>{title}</h1>")), "{title}");
        let missing = run(&[call, &["--html", &path("no/such/page.html")]].concat());
        assert!(missing.starts_with("exit 2") && missing.contains("there is no folder"), "{missing}");
        let of_folder = run(&[call, &["--html", folder.path().to_str().unwrap()]].concat());
        assert!(of_folder.starts_with("exit 2") && of_folder.contains("cannot be written"), "{of_folder}");
    }
    // Every dimension has bars of its tolerance and of its cost, before and after.
    let page = std::fs::read_to_string(path("allocate.html")).unwrap();
    let bars = |class: &str| page.matches(&format!("<rect class=\"{class}\"")).count();
    assert!(bars("was") == 8 && bars("was") == bars("after"), "{page}");
    let page = std::fs::read_to_string(path("simulate.html")).unwrap();
    assert!(page.contains("importance sampling") && page.contains("most likely above"), "{page}");
}

/// Every page has the parts of a review: the verdict first, the errors of the figures, and terms. Warnings stand below the figure that
/// they concern, and never at the end.
#[test]
fn pages_of_all_commands_have_the_same_parts() {
    let folder = tempfile::tempdir().unwrap();
    let text = r##"
title = "Cover \\ \"A\""
[about]
part = "Cover <7>"
revision = "C"
[dimensions]
a = { nominal = 10, tolerance = 0.3 }
b = { nominal = 6, tolerance = 0.1 }
idle = { nominal = 1, tolerance = 0.1 }
[characteristics]
gap = { formula = "a - b", lower = 3.8, upper = 4.5, target_yield = 0.9973 }
[costs]
a = { model = "reciprocal", a = 1.0, b = 0.1, min = 0.01, max = 0.5 }
b = { model = "reciprocal", a = 1.0, b = 0.1, min = 0.01, max = 0.5 }
"##;
    let study = folder.path().join("study.toml");
    std::fs::write(&study, text).unwrap();
    let study = study.to_str().unwrap();
    let calls: [(&str, &[&str]); 5] = [
        ("simulate", &["--samples", "2000"]),
        ("simulate", &["--rare", "--samples", "400"]),
        ("compare", &["--samples", "2048", "--budget", "100"]),
        ("sweep", &["--over", "a=9.8:10.2:9"]),
        ("allocate", &["--pareto", "4"]),
    ];
    for (command, more) in calls {
        let file = folder.path().join("page.html").to_str().unwrap().to_owned();
        let output = sensitol(&[&[command, study, "--html", &file, "-q"], more].concat()).output().unwrap();
        let page = std::fs::read_to_string(&file).unwrap_or_else(|_| panic!("{command}: {output:?}"));
        is_closed(&page);
        let at =
            |part: &str| page.find(part).unwrap_or_else(|| panic!("{command} {more:?}: {part} is not in the page"));
        let order = [
            "<h2 id=\"verdict\"",
            "class=\"gauge\"",
            "<h2 id=\"summary\"",
            "<h2 id=\"sure\"",
            "<h2 id=\"about\"",
            "<h2 id=\"terms\"",
        ];
        assert!(order.map(at).is_sorted(), "{command}: {:?}", order.map(at));
        assert!(
            page.contains("<dd>Cover &lt;7&gt;</dd>") && page.contains("<dd>C</dd>"),
            "the title block of {command}"
        );
        // Footer of every printed page, in which no part of a name acts as style.
        assert!(page.contains("content: \"Cover \\3c 7\\3e \\2c  revision C\\2c  study "), "{command}");
        if command != "allocate" {
            assert!(page.contains("gap misses its target"), "{command}");
        }
        // Of the commands that analyse.
        if command == "sweep" || command == "allocate" {
            let (warning, summary) = (at("unused-dimension"), at("<h2 id=\"summary\""));
            assert!(warning < summary, "{command}: a warning of the whole study stands below the verdict");
        }
    }
}

/// The axis of yields on the front has round numbers, for any required yields.
#[test]
fn ticks_of_a_front_are_round() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("front.svg").to_str().unwrap().to_owned();
    let study = "examples/first-study/study.toml";
    let output = sensitol(&["allocate", study, "--pareto", "4", "--svg", &file, "-q"]).output().unwrap();
    let drawing = std::fs::read_to_string(&file).unwrap_or_else(|_| panic!("{output:?}"));
    let ticks: Vec<&str> =
        drawing.split("<text").filter_map(|text| text.split('>').nth(1)?.strip_suffix(" %</text")).collect();
    assert!(ticks.len() > 1, "{drawing}");
    for tick in ticks {
        // 100 minus a single digit of 1, 2 or 5.
        let rejected = 100.0 - tick.parse::<f64>().unwrap();
        let digit = rejected / 10f64.powf((rejected.log10() + 1e-9).floor());
        assert!([1.0, 2.0, 5.0, 10.0].iter().any(|round| (digit - round).abs() < 1e-6), "{tick}");
    }
}

fn study_title(path: &str) -> String {
    let title = Study::read(&repository(path)).unwrap().title.unwrap();
    title.replace('&', "&amp;")
}

/// Returns the folder of the pages and settings that `tests/browser` uses.
fn cases() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("html");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Random factors of the tolerance and shifts of the mean for every dimension. Fixed dimensions stay unchanged.
fn settings(study: &Study, analysis: &Analysis, rng: &mut Xoshiro256PlusPlus) -> (Value, Vec<Relocation>) {
    let dimensions = analysis.surface.varying.iter().map(|&d| &study.problem.dimensions()[d]);
    let (given, moved) = dimensions
        .map(|dimension| {
            let kind = dimension.distribution().unwrap().name();
            let stays = matches!(kind, "weibull" | "mixture" | "measured") || dimension.zone().is_some();
            let (factor, shift) = match stays {
                true => (1.0, 0.0),
                false => (10f64.powf(rng.random_range(-1.0..0.5)), dimension.half_band() * rng.random_range(-1.0..1.0)),
            };
            // By the dimension's own rule for another tolerance.
            let scaled = if stays { dimension.clone() } else { dimension.scaled(factor).unwrap().unwrap() };
            let (mean, sigma) = (dimension.mean(), dimension.sigma());
            let to = Relocation { shift: (scaled.mean() + shift - mean) / sigma, stretch: scaled.sigma() / sigma };
            (json!({ "factor": factor, "shift": shift }), to)
        })
        .unzip::<_, _, Vec<_>, Vec<_>>();
    (Value::Array(given), moved)
}

/// Returns the results of the engine for every characteristic.
fn engine(study: &Study, analysis: &Analysis, moved: &[Relocation], by_law: bool) -> Value {
    let one = |c: usize| {
        let found = analysis.surface.at(c, moved)?;
        let (moments, limits) = (found.moments, study.problem.characteristics()[c].limits());
        let law = Law::fit(&moments).ok();
        let capability = law.map(|law| Capability::of(&law, moments.mean(), moments.sigma(), limits));
        // Surface distribution: both reject rates with their stated errors.
        let surface = if by_law { law_at(&study.problem, &analysis.surface, c, moved)?.ok() } else { None };
        let figure = |figure: LawFigure| json!([figure.value, figure.error]);
        let below = limits.lower().and_then(|y| Some(figure(surface.as_ref()?.below(y))));
        let above = limits.upper().and_then(|y| Some(figure(surface.as_ref()?.above(y))));
        Some(json!({
            "mean": moments.mean(), "sigma": moments.sigma(), "skewness": moments.skewness(), "excess": moments.excess(),
            "below": capability.and_then(|one| one.below), "above": capability.and_then(|one| one.above),
            "cpk": capability.and_then(|one| one.cpk), "surface": { "below": below, "above": above },
            "linear": found.linear, "curvature": found.curvature,
        }))
    };
    Value::Array((0..study.problem.characteristics().len()).map(|c| json!(one(c))).collect())
}

/// Studies whose what-if is tested: interactions, curvature, quartics through a rule, all kinds of distribution.
fn tried() -> Vec<(&'static str, Study, Options)> {
    let with = |name: &'static str, study: Study, method: Option<Method>| {
        let options = method.map_or_else(|| study.options.clone(), Options::from);
        (name, study, options)
    };
    vec![
        with("stacked-blocks", example("stacked-blocks"), None),
        with("stacked-blocks-auto", example("stacked-blocks"), Some(Method::Auto)),
        with("four-bar", example("four-bar"), Some(Method::Full)),
        with("engine-balance", example("engine-balance"), None),
        with("measured-pin", example("measured-pin"), None),
        with("mixed", study(MIXED), None),
        with("sums", study(SUMS), None),
        with("products", study(PRODUCTS), None),
    ]
}

fn node() -> bool {
    Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success())
}

fn by_node(page: &str, settings: &Value, name: &str) -> Value {
    let (html, file) = (cases().join(format!("{name}.html")), cases().join(format!("{name}.settings.json")));
    std::fs::write(&html, page).unwrap();
    std::fs::write(&file, settings.to_string()).unwrap();
    let output =
        Command::new("node").arg(repository("tests/browser/what_if.mjs")).args([&html, &file]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Costs by every model, a list of processes, dimensions that share one, and a dimension without cost.
const PRICED: &str = r##"
[dimensions]
a = { nominal = 10, tolerance = 0.1 }
b = { nominal = 4, tolerance = 0.2 }
c = { nominal = 3, tolerance = [-0.1, 0.3] }
d = { nominal = 2, tolerance = 0.1, distribution = "uniform" }
e = { nominal = 1, sigma = 0.02 }
f = { nominal = 6, tolerance = 0.05 }
free = { nominal = 1, tolerance = 0.05 }
[costs]
a = { model = "reciprocal", a = 1.5, b = 0.2, min = 0.01, max = 0.4 }
b = { model = "exponential", a = 0.5, b = 9.0, c = 0.15, min = 0.02, max = 0.6 }
c = { model = "reciprocal-power", b = 0.3, k = 0.6, min = 0.02, max = 0.6 }
d = { same_as = "a" }
e = { model = "reciprocal", b = 0.1, min = 0.001, max = 1.0 }
f = { processes = [{ name = "mill", tolerance = 0.06, cost = 1.0 }, { name = "grind", tolerance = 0.02, cost = 4.5 }, { name = "lap", model = "reciprocal", a = 1.0, b = 0.06, min = 0.008, max = 0.015 }] }
[characteristics]
y = { formula = "a + b - c + d - e - f - free", lower = 7, upper = 11, target_yield = 0.9 }
"##;

/// The cost of the copied study by the engine, which reads tolerances and costs again, equals that of the page except for rounding.
#[test]
fn costs_follow_the_tolerances() {
    if !node() {
        return skipped("costs");
    }
    let original = study(PRICED);
    let (analysis, page) = analysed(&original, &original.options);
    assert!(page.contains("Cost of the tolerances: analysed"), "the cost is shown");
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
    let given: Vec<Value> = (0..60).map(|_| settings(&original, &analysis, &mut rng).0).collect();
    let answer = by_node(&page, &Value::Array(given), "priced");
    let rest = &PRICED[PRICED.find("[costs]").unwrap()..];
    let mut unheld = 0;
    for found in answer["found"].as_array().unwrap() {
        let text = format!("{}{rest}", found["toml"].as_str().unwrap());
        let pasted = study(&text);
        let groups = pasted.costs.iter();
        let expected: Option<f64> =
            groups.map(|group| group.cost_to_hold(group.tightest_member(&pasted.problem))).sum();
        // A tolerance that no process reaches has infinite cost in the script, and null in JSON.
        match (found["cost"].as_f64(), expected) {
            (Some(found), Some(expected)) => {
                assert!((found / expected - 1.0).abs() < 1e-11, "{found}, not {expected}: {text}")
            }
            (None, None) => unheld += 1,
            other => panic!("{other:?}: {text}"),
        }
    }
    assert!((1..59).contains(&unheld), "{unheld} of 60 cannot be held");
    assert!(!self::page(&study(MIXED)).contains("Cost of the tolerances"), "no cost where there is none");
}

/// The verdict comes first: missed targets with number, side and cause, a gauge and a shape for each, and the title block.
#[test]
fn the_verdict_comes_first() {
    let text = r##"
title = "Cover"
[about]
part = "Cover <7>"
drawing = "4711-002"
revision = "C"
author = "A. Engineer"
[dimensions]
a = { nominal = 10, tolerance = 0.3 }
b = { nominal = 6, tolerance = 0.1 }
[characteristics]
gap = { formula = "a - b", lower = 3.8, upper = 4.5, target_yield = 0.9973 }
sum = { formula = "a + b", lower = 14, upper = 18, target_yield = 0.99 }
"##;
    let study = study(text);
    assert_eq!(study.about[0], ("Part", "Cover <7>".to_owned()));
    let about = About { block: study.about.clone(), sha256: study.sha256.clone(), ..About::default() };
    // Without the verification sample, which has an error of its own.
    let analysis = analyze(&study.problem, &study.options.clone().with_verify(0)).unwrap();
    let page = analyze_html(&Report::of(&study.problem, &analysis, about), None);
    for cell in
        ["<dd>Cover &lt;7&gt;</dd>", "<dd>4711-002</dd>", "<dd>C</dd>", "<dd>A. Engineer</dd>", &study.sha256[..12]]
    {
        assert!(page.contains(cell), "{cell}");
    }
    // sigma = sqrt(0.1^2 + (0.1/3)^2) = 0.10541. The lower limit is 0.2 or 1.8974 sigma below the mean, beyond which a normal
    // distribution has 28889.8 ppm. Above the other limit are 1.05 ppm.
    let verdict = page.split("id=\"verdict\"").nth(1).unwrap().split("</section>").next().unwrap();
    assert!(
        verdict.contains(
            "gap misses its target:</strong> 28891 ppm are rejected where 2700 are allowed, all of them below 3.8."
        ),
        "{verdict}"
    );
    assert!(verdict.contains("<em>a</em> makes 90 % of its variance."), "{verdict}");
    assert!(verdict.contains("sum meets its target with fewer than 0.001 ppm."), "{verdict}");
    assert_eq!(verdict.matches("class=\"gauge\"").count(), 3, "two characteristics and both together");
    assert!(verdict.contains("st missed\"") && verdict.contains("st met\""), "{verdict}");
    // The limit, the rejects beyond it, and the ranges are in the density, which is drawn twice.
    for (label, drawn) in [
        // Once more in the panel of its tail.
        (">lower 3.8<", 3),
        (">28890 ppm<", 2),
        (">mean \u{b1} 3\u{3c3}<", 4),
        (">RSS</text>", 4),
        (">worst case, linear</text>", 4),
    ] {
        assert_eq!(page.matches(label).count(), drawn, "{label}");
    }
    // Cpk = 0.2/(3 sigma). It stands in the verdict, and the facts beside each density do not repeat it.
    assert!(verdict.contains("<td class=\"n\" data-label=\"Cpk\">0.632</td>"), "{verdict}");
    assert_eq!(page.matches("<table class=\"figures\">").count(), 2);
    let beside = page.split("<div class=\"beside\">").nth(1).unwrap().split("</table>").next().unwrap();
    assert!(beside.contains("<svg class=\"density wide\"") && beside.contains("Sigma</th>"), "{beside}");
    assert!(!beside.contains("Yield</th>") && !beside.contains("Cpk</th>"), "{beside}");
    assert!(page.find("id=\"verdict\"").unwrap() < page.find("id=\"summary\"").unwrap());
    assert!(page.contains("id=\"terms\""));
}

/// The first screens have verdict, density, contributions and chain of every characteristic. Everything else is folded below one heading, in
/// the order of a review. Lines of the terminal do not stand between the charts.
#[test]
fn details_are_folded() {
    let text = r##"
[dimensions]
a = { nominal = 10, tolerance = 0.3 }
b = { nominal = 6, tolerance = 0.1 }
[characteristics]
gap = { formula = "a - b", lower = 3.8, upper = 4.5, target_yield = 0.9973 }
"##;
    let page = page(&study(text));
    let at = |part: &str| page.find(part).unwrap_or_else(|| panic!("{part} is not in the page"));
    let order = [
        "<h2 id=\"verdict\"",
        "<svg class=\"density wide\"",
        "<table class=\"drivers\"",
        "<svg class=\"density chain wide\"",
        "<h2 id=\"what-if-title\"",
        "<h2 class=\"details\">",
        "<h2 id=\"kc-details-0\"",
        "<h2 id=\"dimensions\"",
        "<h2 id=\"summary\"",
        "<h2 id=\"sure\"",
        "<h2 id=\"about\"",
        "<h2 id=\"terms\"",
    ];
    assert!(order.map(at).is_sorted(), "{:?}", order.map(at));
    let section = page.split("<section id=\"kc-0\"").nth(1).unwrap().split("</section>").next().unwrap();
    assert_eq!(section.matches("<p").count() - section.matches("<path").count(), 1, "limits alone: {section}");
    assert!(!page.contains("<li>yield ") && !page.contains("<li>Cp "), "yield and Cpk stand in the verdict");
    // Every line of the density has a key. Without a sample of the model there are no bars.
    for key in ["of-curve", "of-beyond", "of-quantile", "of-nominal"] {
        assert_eq!(section.matches(&format!("<li class=\"{key}\">")).count(), 1, "{key}: {section}");
    }
    // The law of a sum of normal dimensions is normal, so that no other fit stands beside it.
    assert!(!section.contains("of-bins") && !section.contains("of-fit"), "{section}");
    // Other folds than those of the details would be folded twice.
    let folds = page.split("<h2 class=\"details\">").nth(1).unwrap();
    assert_eq!(folds.matches("<details class=\"fold part").count(), 6, "{folds}");
}

/// A study without a title has the name of its file as heading, and the date of the report in its title block.
#[test]
fn a_page_without_title_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"2*a\" }\n";
    std::fs::write(path("lid & box.toml"), text).unwrap();
    let call = ["analyze", &path("lid & box.toml"), "--html", &path("page.html"), "-q"];
    // 2026-11-28 12:00 UTC by `date -u -d '2026-11-28 12:00' +%s`.
    let output = sensitol(&call).env("SOURCE_DATE_EPOCH", "1795867200").output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let page = std::fs::read_to_string(path("page.html")).unwrap();
    assert!(page.contains("<h1>Tolerance report: lid &amp; box.toml</h1>"), "{page}");
    assert!(
        page.contains("<dt>Date</dt><dd>2026-11-28</dd>") && page.contains("<dt>Study</dt><dd>lid &amp; box.toml</dd>")
    );
}

/// The variable with the date of a reproducible page is not replaced by today, and the run ends before its analysis.
#[test]
fn a_date_that_is_none_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let study = repository("examples/shaft-and-bore/study.toml");
    for date in ["abc", "-5", "1700000000.5"] {
        let call = ["analyze", study.to_str().unwrap(), "--html", page.to_str().unwrap()];
        let output = sensitol(&call).env("SOURCE_DATE_EPOCH", date).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("the variable SOURCE_DATE_EPOCH is `{date}`")), "{said}");
        assert!(!page.exists() && output.stdout.is_empty());
    }
}

/// Returns the cells of every row of the contributions, without markup.
fn drivers(page: &str) -> Vec<Vec<String>> {
    let table = page.split("<table class=\"drivers\">").nth(1).unwrap().split("</table>").next().unwrap();
    let text = |cell: &str| {
        let pieces = cell.split('<').map(|piece| piece.split_once('>').map_or(piece, |(_, text)| text));
        pieces.collect::<String>()
    };
    let rows = table.split("<tbody>").nth(1).unwrap().split("<tr>").skip(1);
    rows.map(|row| {
        let cells = row.replace("</th>", "</td>");
        let cells: Vec<String> = cells.split("</td>").map(|cell| text(cell).trim().to_owned()).collect();
        cells[..cells.len() - 1].to_vec()
    })
    .collect()
}

/// A contribution has its sigma and its slope times half tolerance in the unit of the characteristic, with the digits that errors
/// support.
#[test]
fn contributions_have_their_sigma_and_reach() {
    let text = r##"
[dimensions]
a = { nominal = 10, tolerance = 0.3 }
b = { nominal = 6, tolerance = [-0.2, 0.1], unit = "mm" }
c = { nominal = 1, sigma = 0.04 }
idle = { nominal = 1, tolerance = 0.1 }
[characteristics]
gap = { formula = "a - b + c + 0*idle", unit = "mm", upper = 5.5 }
"##;
    // Variances 0.0100, 0.0025 and 0.0016 of 0.0141. The half-widths are 0.3 and 0.15; `c` has none.
    let exact = page(&study(text));
    let rows: Vec<String> = drivers(&exact).iter().map(|row| row.join(" | ")).collect();
    let expected = [
        "a |  | 70.92 % | 70.92 % | 0.100 | +0.300",
        "b |  | 17.73 % | 88.65 % | 0.0500 | -0.150",
        "c |  | 11.35 % | 100.00 % | 0.0400 | -",
    ];
    assert_eq!(rows, expected);
    // The step goes down to the running sum of the row.
    assert!(exact.contains("d=\"M0.00 0H70.92V32\"") && exact.contains("d=\"M88.65 0H100.00V32\""));
    assert!(exact.contains("Less than 0.005 % of the variance each: idle."), "said of which there is no row");
    assert!(exact.contains(">sigma, mm</th>") && exact.contains(">slope × half tolerance, mm</th>"));
}

/// The variance that no contribution explains has a row with its size, or with the note that it is unknown.
#[test]
fn what_is_not_resolved_has_a_row() {
    // sin has a third power, which a second-order surface cannot have.
    let text = r##"
[dimensions]
a = { nominal = 0, tolerance = 1.5 }
b = { nominal = 0, tolerance = 0.3 }
[characteristics]
y = { formula = "sin(a) + b" }
"##;
    let study = study(text);
    let row = |options: &Options| {
        let (analysis, page) = analysed(&study, options);
        let rows = drivers(&page);
        (analysis, rows.iter().find(|row| row[0] == "not resolved").cloned(), rows)
    };
    let (analysis, known, rows) = row(&Method::SecondOrder.into());
    let left = analysis.characteristics[0]
        .evidence
        .verification
        .as_ref()
        .and_then(|of| of.left)
        .expect("a formula is sampled");
    let known = known.expect("a surface that misses something leaves it");
    assert!((known[2].trim_end_matches(" %").parse::<f64>().unwrap() / 100.0 - left).abs() < 1e-4, "{known:?} {left}");
    // Error within 2 sqrt(S U) + U: its second digit is the last one printed.
    let share = &rows[0][2];
    assert!(share.trim_end_matches(" %").split('.').nth(1).is_none_or(|decimals| decimals.len() < 2), "{share}");
    let (_, unknown, _) = row(&Options::from(Method::Rss).with_verify(0));
    assert_eq!(unknown.expect("slopes alone leave what is unknown")[2..5], ["-", "-", "-"]);
}

/// All dimensions are in one table. Folded rows are still in the page.
#[test]
fn dimensions_stand_in_one_table() {
    let section = |page: &str| {
        page.split("<h2 id=\"dimensions\">").nth(1).unwrap().split("</section>").next().unwrap().to_owned()
    };
    let two = section(&page(&example("stacked-blocks")));
    assert_eq!(two.matches("<table").count(), 1, "{two}");
    assert!(two.contains(">slope</th>") && !two.contains("<details"), "{two}");
    // 14 dimensions, of which two have less effect than the others, and 8 sums of them.
    let mut text = "[dimensions]\n".to_owned();
    for i in 0..14 {
        let tolerance = if i == 3 || i == 5 { 0.01 } else { 0.1 };
        let _ = writeln!(text, "x{i} = {{ nominal = 1, tolerance = {tolerance} }}");
    }
    let sum: Vec<String> = (0..14).map(|i| format!("x{i}")).collect();
    text += "[characteristics]\n";
    for i in 0..8 {
        let _ = writeln!(text, "y{i} = {{ formula = \"{}\" }}", sum.join(" + "));
    }
    let many = section(&page(&study(&text)));
    // 12 parts of 1 and two of 0.01.
    assert!(many.contains("<summary>2 more dimensions, at most 0.08 % of a variance each</summary>"), "{many}");
    assert!(
        many.contains("<summary>Shares in 2 more characteristics</summary>") && !many.contains(">slope<"),
        "{many}"
    );
    let shown = many.split("<details").next().unwrap();
    assert!(shown.contains(">x4</th>") && !shown.contains(">x3</th>") && !shown.contains(">y6</th>"), "{shown}");
    // Once beside six characteristics and once beside two.
    assert_eq!(many.matches(">x3</th>").count(), 2);
    assert_eq!(many.matches("<td class=\"n\">0.08</td>").count(), 2 * 8);
}

/// Joint effects of two dimensions are in a map below the effects of each alone.
#[test]
fn interactions_are_a_map() {
    let text = r##"
[dimensions]
a = { nominal = 0, tolerance = 3 }
b = { nominal = 0, tolerance = 3 }
[characteristics]
y = { formula = "a + b + a*b" }
"##;
    // Variances 1, 1 and 1: a third each, with means 0.
    let page = page(&study(text));
    let map = page.split("<table class=\"map\">").nth(1).unwrap().split("</table>").next().unwrap();
    assert_eq!(map.matches(">33.33</td>").count(), 3, "{map}");
    let straight = study(
        "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a + b\" }\n",
    );
    assert!(!self::page(&straight).contains("class=\"map\""), "nothing is joint in a sum");
}

/// If a surrogate is not trusted and the model is sampled, the density is drawn over the sample.
#[test]
fn a_sample_of_the_model_is_drawn() {
    let text = r##"
[dimensions]
a = { nominal = 0, tolerance = 3 }
b = { nominal = 0, tolerance = 3 }
[characteristics]
y = { formula = "max(a, b)", lower = -2, upper = 3 }
"##;
    let study = study(text);
    let options = study.options.clone().with_verify(0);
    let (analysis, page) = analysed(&study, &options);
    let sampled = analysis.characteristics[0].evidence.model_sampled.as_ref().expect("a kink is sampled");
    let histogram = sampled.histogram.as_ref().unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>(), sampled.samples);
    // Drawn twice, for wide and for narrow pages.
    assert_eq!(page.matches("<rect class=\"bin").count(), 2 * histogram.counts.len());
    assert!(page.contains("<rect class=\"bin out\""), "what lies outside the limits is told apart");
    assert!(
        page.contains("Nothing can be changed in this page: its moments come from points of the model"),
        "said why"
    );
}

/// Number of settings for which counted reject rates are compared.
const COUNTED: usize = 24;

/// Script and engine at 200 random settings of every study. Both round each step once, in different orders. Skewness and kurtosis are
/// sums of terms that cancel, and probabilities far out multiply the errors of sigma by the squared distance.
#[test]
fn the_page_computes_what_the_engine_computes() {
    if !node() {
        return skipped("the what-if beside the engine");
    }
    let (mut worst, mut by_law) = (0.0f64, Vec::new());
    for (name, study, options) in tried() {
        let (analysis, page) = analysed(&study, &options);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(20_261_121);
        let (given, moved): (Vec<Value>, Vec<_>) = (0..200).map(|_| settings(&study, &analysis, &mut rng)).unzip();
        let answer = by_node(&page, &Value::Array(given), name);
        // The surface distribution of a tree takes the engine half a second: if the page counts points, some settings are enough.
        let by =
            |found: &Value, by: &str| found["characteristics"].as_array().unwrap().iter().any(|one| one["by"] == by);
        let found = answer["found"].as_array().unwrap().iter();
        let expected: Vec<Value> = moved
            .iter()
            .zip(found)
            .enumerate()
            .map(|(i, (moved, found))| {
                let wanted = by(found, "surface") || by(found, "points") && i < COUNTED;
                engine(&study, &analysis, moved, wanted)
            })
            .collect();
        std::fs::write(cases().join(format!("{name}.expected.json")), json!(expected).to_string()).unwrap();
        for (i, (found, expected)) in answer["found"].as_array().unwrap().iter().zip(&expected).enumerate() {
            for (found, expected) in
                found["characteristics"].as_array().unwrap().iter().zip(expected.as_array().unwrap())
            {
                assert!(!expected.is_null(), "{name} has a surrogate");
                if found["by"] == "surface" && by_law.last() != Some(&name) {
                    by_law.push(name);
                }
                worst = worst.max(compared(found, expected, &format!("{name}, setting {i}")));
            }
        }
    }
    // Sums and products of normal inputs use a contour. Products of other inputs are counted, and compared as well. Without limits, such
    // as for the engine's forces, no distribution is needed.
    assert_eq!(by_law, ["stacked-blocks", "stacked-blocks-auto", "four-bar", "measured-pin", "mixed", "sums"]);
    assert!(worst > 0.0, "something was compared");
    assert!(worst < 1e-9, "{worst:e}");
}

/// Returns the largest relative difference, each with its own scale.
fn compared(found: &Value, expected: &Value, what: &str) -> f64 {
    let sigma = expected["sigma"].as_f64().unwrap();
    let off = |key: &str, found: &Value, expected: &Value, scale: f64| match (found.as_f64(), expected.as_f64()) {
        (None, None) => 0.0,
        (Some(a), Some(b)) => {
            let off = (a - b).abs() / b.abs().max(scale);
            assert!(off < 1e-9, "{what}: {key} is {a}, and the engine says {b}");
            off
        }
        _ => panic!("{what}: {key} is {found}, and the engine says {expected}"),
    };
    let mut worst = 0.0f64;
    for (key, scale) in [("mean", sigma), ("sigma", 0.0), ("skewness", 1.0), ("excess", 1.0), ("cpk", 1.0)] {
        worst = worst.max(off(key, &found[key], &expected[key], scale));
    }
    for (side, key) in ["below", "above"].into_iter().enumerate() {
        let stated = &found["errors"][side];
        match found["by"].as_str().unwrap() {
            "pearson" => worst = worst.max(off(key, &found[key], &expected[key], 1e-6)),
            "points" => {
                // There is no such limit, or the distribution of a tree gives no figure far out, in a few settings of 200.
                if found[key].is_null() && expected["surface"][key].is_null() || expected["surface"][key][0].is_null() {
                    continue;
                }
                let of_engine = |at: usize| expected["surface"][key][at].as_f64().unwrap();
                let (own, stated) = (found[key].as_f64().unwrap(), stated.as_f64().unwrap());
                let (value, error) = (of_engine(0), of_engine(1));
                assert!(
                    (own - value).abs() <= stated + error,
                    "{what}: {key} is {own} ± {stated:e}, the engine says {value}"
                );
                // Four standard errors if all of some 30,000 points change sides.
                assert!(stated <= 0.025, "{what}: {stated:e}");
            }
            // Two inversions along different contours agree within the errors that both state, which are small.
            _ => match (found[key].as_f64(), expected["surface"][key].as_array()) {
                (None, None) => {}
                (Some(own), Some(engine)) => {
                    let [value, error] = [0, 1].map(|at| engine[at].as_f64().unwrap());
                    let stated = stated.as_f64().unwrap();
                    let allowed = stated + error + 1e-9 * value + 1e-14;
                    assert!(
                        (own - value).abs() <= allowed,
                        "{what}: {key} is {own} ± {stated:e}, the engine says {value} ± {error:e}"
                    );
                    assert!(stated <= 1e-3 * value.min(1.0 - value) + 1e-12 || stated <= 1e-3, "{what}: {stated:e}");
                }
                other => panic!("{what}: {key}: {other:?}"),
            },
        }
    }
    for key in ["linear", "curvature"] {
        let lists = found[key].as_array().unwrap().iter().zip(expected[key].as_array().unwrap());
        worst = lists.fold(worst, |worst, (a, b)| worst.max(off(key, a, b, 1.0)));
    }
    worst
}

/// Unchanged settings show the report's own reject rates and yield interval to the last digit, from any source.
#[test]
fn an_unchanged_what_if_is_the_verdict() {
    if !node() {
        return skipped("unchanged what-if");
    }
    let mut sources = Vec::new();
    for (name, study, options) in
        tried().into_iter().chain([("first-study", example("first-study"), Options::default())])
    {
        let (analysis, page) = analysed(&study, &options);
        let still = vec![json!({ "factor": 1.0, "shift": 0.0 }); analysis.surface.varying.len()];
        let answer = by_node(&page, &json!([still]), &format!("{name}-unchanged"));
        let all = answer["found"][0]["characteristics"].as_array().unwrap();
        for (found, one) in all.iter().zip(&analysis.characteristics) {
            let shown = |side: usize| found["rejects"][side].as_f64().map(f64::to_bits);
            let own = one.distribution.capability.unwrap();
            assert_eq!([shown(0), shown(1)], [own.below, own.above].map(|share| share.map(f64::to_bits)), "{name}");
            let Some([low, high]) = one.yield_interval().filter(|_| own.yield_().is_some()) else { continue };
            let interval = [0, 1].map(|end| found["interval"][end].as_f64().unwrap());
            assert!((interval[0] - low).abs() + (interval[1] - high).abs() < 1e-15, "{name}: {interval:?}");
            sources.push(one.distribution.yield_source.unwrap());
        }
    }
    sources.sort_unstable();
    sources.dedup();
    assert_eq!(sources, [YieldSource::Proof, YieldSource::Samples]);
}

/// Reject rates that the page shows for other tolerances and means against an analysis of the changed study, whose model is sampled: the
/// two intervals meet.
#[test]
fn a_changed_study_has_the_rejects_of_the_page() {
    if !node() {
        return skipped("the changed study");
    }
    let mut compared = 0;
    for name in ["first-study", "stacked-blocks", "shaft-and-bore"] {
        let text = std::fs::read_to_string(repository(&format!("examples/{name}/study.toml"))).unwrap();
        let (head, rest) = text.split_once("[dimensions]").unwrap();
        let rest = &rest[rest.find("\n[").unwrap()..];
        let original = example(name);
        let (analysis, page) = analysed(&original, &original.options);
        let set = |factor: f64, part: f64| {
            let dimensions = analysis.surface.varying.iter().map(|&d| &original.problem.dimensions()[d]);
            let one = |of: &Dimension| json!({ "factor": factor, "shift": part * of.half_band() });
            Value::Array(dimensions.map(one).collect())
        };
        let given = json!([set(1.0, 0.2), set(1.2, 0.0), set(1.6, -0.1), set(0.8, 0.1)]);
        for found in by_node(&page, &given, &format!("{name}-changed"))["found"].as_array().unwrap() {
            let changed = format!("{head}{}{rest}", found["toml"].as_str().unwrap());
            let pasted = study(&changed);
            let analysis = analyze(&pasted.problem, &pasted.options).unwrap();
            let (one, found) = (&analysis.characteristics[0], &found["characteristics"][0]);
            let [low, high] = one.yield_interval().unwrap();
            let [from, to] = [0, 1].map(|end| found["interval"][end].as_f64().unwrap());
            assert!(from <= high && low <= to, "{name}: {from} .. {to}, and {low} .. {high}: {changed}");
            // A few hundred ppm at most: two samples of some 40,000 points.
            assert!(to - from < 1e-3 && high - low < 1e-3, "{name}: {from} .. {to}, and {low} .. {high}");
            let sigma = one.moments.unwrap().sigma();
            assert!((found["sigma"].as_f64().unwrap() / sigma - 1.0).abs() < 1e-3, "{name}: {found} {sigma}");
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
}

/// The copied text is a section of a study: pasted, it gives the results of the page. They are exact if the surrogate equals the
/// function, which has second degree. The bound comes from differences of values near 160 in a kurtosis.
#[test]
fn what_is_copied_analyses_to_the_same() {
    if !node() {
        return skipped("copied TOML");
    }
    let original = study(MIXED);
    let (analysis, page) = analysed(&original, &original.options);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let given: Vec<Value> = (0..12).map(|_| settings(&original, &analysis, &mut rng).0).collect();
    let answer = by_node(&page, &Value::Array(given), "copied");
    let rest = &MIXED[MIXED.find("[characteristics]").unwrap()..];
    for found in answer["found"].as_array().unwrap() {
        let text = format!("{}{rest}", found["toml"].as_str().unwrap());
        let pasted = study(&text);
        let analysis = analyze(&pasted.problem, &pasted.options).unwrap();
        for (one, found) in analysis.characteristics.iter().zip(found["characteristics"].as_array().unwrap()) {
            let moments = one.moments.unwrap();
            let number = |key: &str| found[key].as_f64().unwrap();
            assert!((moments.mean() - number("mean")).abs() < 1e-9 * moments.sigma(), "{text}");
            assert!((moments.sigma() / number("sigma") - 1.0).abs() < 1e-9, "{text}");
            assert!((moments.skewness().unwrap() - number("skewness")).abs() < 1e-8, "{text}");
            assert!((moments.excess().unwrap() - number("excess")).abs() < 1e-8, "{text}");
        }
    }
}

fn skipped(what: &str) {
    let _ =
        writeln!(std::io::stderr(), "skipped: {what}; install Node 18 or newer (nodejs.org, or apt install nodejs)");
}
