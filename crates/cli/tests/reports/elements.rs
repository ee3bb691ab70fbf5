//! Short forms of a study: relative dimensions, configurations, and the expanded study.

use assert_cmd::Command;

use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_study::{Externals, StudyText};
use sensitol_testing::{analysed, case, close, faults, parse};

/// Compares a study with its expanded form: every figure agrees to the last digit.
#[track_caller]
pub fn same_as_expanded(text: &str, method: Method) {
    let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
    let expanded = parse(&study.expanded).unwrap_or_else(|error| panic!("{error}\n{}", study.expanded));
    assert_eq!(
        expanded.expanded,
        study.expanded.lines().map(|line| line.split(" # of ").next().unwrap().to_owned() + "\n").collect::<String>()
    );
    let figures = |study: &Study| {
        let analysis = analyze(&study.problem, &method.into()).unwrap();
        analysis
            .characteristics
            .iter()
            .map(|one| (one.moments, one.sensitivities.clone(), one.linear.rss, one.range.worst_case))
            .collect::<Vec<_>>()
    };
    assert_eq!(figures(&study), figures(&expanded));
}

const CHAIN: &str = "[dimensions]\nx1 = { nominal = 20, tolerance = 0.05 }\nx2 = { nominal = 40, tolerance = 0.05, from = \"x1\" }\n\
                     x3 = { nominal = 30, tolerance = 0.05, from = \"x2\" }\n";

/// Three dimensions in a row, two from a common face, and one: tolerances 0.15, 0.10, 0.05.
#[test]
fn chains_baselines_and_direct_dimensions() {
    let case = case("chain-baseline-direct");
    let printed = |key: &str| case["printed"][key]["value"].as_f64().unwrap();
    let half = |text: &str| {
        let [lower, upper] = analysed(text, Method::WorstCase).characteristics[0].range.worst_case.unwrap();
        0.5 * (upper - lower)
    };
    // Sums of three numbers of some tens: rounding of 1e-14.
    close(
        half(&format!("{CHAIN}[characteristics]\ny = {{ formula = \"x3\" }}\n")),
        printed("chain worst case"),
        1e-12,
        1.0,
    );
    let baseline = CHAIN
        .replace("from = \"x2\"", "from = \"x0\"")
        .replace("from = \"x1\"", "from = \"x0\"")
        .replace("x1 =", "x0 =");
    close(
        half(&format!("{baseline}[characteristics]\ny = {{ formula = \"x3 - x2\" }}\n")),
        printed("baseline worst case"),
        1e-12,
        1.0,
    );
    close(
        half(&format!("{CHAIN}[characteristics]\ny = {{ formula = \"x2 - x1\" }}\n")),
        printed("direct worst case"),
        1e-12,
        1.0,
    );
}

/// Angles from crank to crank. The reference is a sample of four million points: within two of its own standard errors.
#[test]
fn consecutive_cranks() {
    let case = case("engine-consecutive-cranks");
    let example = std::fs::read_to_string(sensitol_testing::repository("examples/engine-balance/study.toml")).unwrap();
    let model: &sensitol_models::Model = "engine-balance".parse().unwrap();
    let nominal = |name: &str| model.inputs.iter().find(|input| input.name == name).unwrap().nominal;
    let mut text = example;
    for (own, base) in [("phi2", "phi1"), ("phi3", "phi2"), ("phi4", "phi3")] {
        let relative = nominal(own) - nominal(base);
        text = text.replace(
            &format!("{own} = {{ tolerance = 0.00872 }}"),
            &format!("{own} = {{ nominal = {relative:?}, tolerance = 0.00872, from = \"{base}\" }}"),
        );
    }
    let analysis = analysed(&text, Method::Full);
    for (index, name) in ["F mean", "M mean"].into_iter().enumerate() {
        let mean = analysis.characteristics[index].moments.unwrap().mean();
        let exact = &case["exact"][name];
        assert!(
            (mean - exact["value"].as_f64().unwrap()).abs() < 2.0 * exact["uncertainty"].as_f64().unwrap(),
            "{name} {mean}"
        );
        let printed = &case["printed"][name];
        assert!(
            (mean - printed["value"].as_f64().unwrap()).abs() < printed["tolerance"].as_f64().unwrap(),
            "{name} {mean}"
        );
    }
    same_as_expanded(&text, Method::SixN);
}

/// A pattern shares a datum shift, which cancels in the pitch.
#[test]
fn a_shared_shift_cancels_in_a_pitch() {
    let text = "[dimensions]\nshift = { nominal = 0, tolerance = 0.3 }\nh1 = { nominal = [10, 0], position = 0.2, from = \"h0\" }\n\
                h2 = { nominal = [50, 0], position = 0.2, from = \"h0\" }\nh0 = { nominal = [0, 0], position = 0.6 }\n\
                edge = { nominal = 5, tolerance = 0.1, from = [\"h1_x\", \"shift\"] }\n\
                [characteristics]\npitch = { formula = \"h2_x - h1_x\" }\nplace = { formula = \"edge\" }\n[correlation]\n";
    let text = text.replace("[correlation]\n", "");
    let analysis = analysed(&text, Method::SecondOrder);
    // Coordinates within a zone of 0.2 have sigma 0.1/3; of 0.6, 0.1.
    close(analysis.characteristics[0].moments.unwrap().sigma(), (2.0f64 / 900.0).sqrt(), 1e-12, 1.0);
    close(analysis.characteristics[1].moments.unwrap().variance(), 0.01 + 0.01 / 9.0 + 0.01 + 0.01 / 9.0, 1e-12, 1.0);
    same_as_expanded(&text, Method::SecondOrder);
}

/// Costs and correlations of a relative dimension apply to its own part.
#[test]
fn costs_and_correlations_belong_to_the_own_part() {
    let text = format!(
        "{CHAIN}[characteristics]\ny = {{ formula = \"x3\", upper = 90.1, target_yield = 0.99 }}\n[costs]\nx2 = {{ model = \"reciprocal\", b = 1 }}\n\
         x3 = {{ same_as = \"x2\" }}\n[[correlation]]\nbetween = [\"x1\", \"x2\"]\nvalue = 0.5\n"
    );
    let study = parse(&text).unwrap();
    assert_eq!(study.costs.len(), 1);
    // 1 + 1 + 1 + 2 0.5, in squares of sigma = 0.05/3.
    let analysis = analyze(&study.problem, &Method::SecondOrder.into()).unwrap();
    close(analysis.characteristics[0].moments.unwrap().variance(), 4.0 * (0.05f64 / 3.0).powi(2), 1e-12, 1.0);
    same_as_expanded(&text, Method::SecondOrder);
}

const SIZES: &str = "[dimensions]\nL = { nominal = 20, tolerance = \"1%\" }\nD = { nominal = 5, fit = \"h7\", unit = \"mm\" }\n\
                     h = { nominal = [1, 2], position = 0.1 }\n[constants]\nk = 2\n[characteristics]\ny = { formula = \"k*L + D + h_y\" }\n\
                     [configurations]\nsmall = { L = 10, k = 3 }\nlarge = { L = 100, D = 8, h = [1, 7] }\n";

fn configured(text: &str, name: &str) -> Result<Study, sensitol_study::StudyError> {
    Study::from_text(StudyText::toml("study.toml", text).with_externals(Externals::default().with_configuration(name)))
}

#[test]
fn configurations_set_nominals_and_constants() {
    let nominals = |study: &Study| {
        study.problem.dimensions().iter().map(|one| (one.nominal(), one.half_band())).collect::<Vec<_>>()
    };
    let written = parse(SIZES).unwrap();
    assert_eq!(written.configurations, ["small", "large"]);
    assert_eq!(nominals(&written)[0], (20.0, 0.2));
    let small = configured(SIZES, "small").unwrap();
    assert_eq!(nominals(&small)[0], (10.0, 0.1));
    // Constants too: 3*10 + 5 + 2, minus half of h7 of 5 mm, 0.012/2.
    let mean = analyze(&small.problem, &Method::SecondOrder.into()).unwrap().characteristics[0].moments.unwrap().mean();
    close(mean, 37.0 - 0.006, 1e-12, 1.0);
    let large = configured(SIZES, "large").unwrap();
    // h7 of 8 mm is 0.015 wide.
    close(nominals(&large)[1].1, 0.0075, 1e-9, 1.0);
    assert!(large.problem.dimensions().iter().any(|one| one.name() == "h_y" && one.nominal() == 7.0));
    let again = parse(&large.expanded).unwrap();
    assert_eq!(nominals(&again), nominals(&large));
}

/// A table of sizes: the first column is the name. An empty cell keeps the value of the study.
#[test]
fn configurations_stand_in_a_file() {
    let text = SIZES.split("[configurations]").next().unwrap().to_owned() + "[configurations]\nfile = \"sizes.csv\"\n";
    let study = StudyText::toml("study.toml", text).with_file("sizes.csv", "size;L;k\nA;10,5;\nB;12;4\n");
    let of = |name: &str| {
        Study::from_text(study.clone().with_externals(Externals::default().with_configuration(name))).unwrap()
    };
    let l = |study: &Study| study.problem.dimensions().iter().find(|one| one.name() == "L").unwrap().nominal();
    assert_eq!((l(&of("A")), l(&of("B"))), (10.5, 12.0));
    assert_eq!(of("A").configurations, ["A", "B"]);
}

#[test]
fn wrong_elements_are_said() {
    let rest = "[characteristics]\ny = { formula = \"x1\" }\n";
    let configured_wrongly = |line: &str| format!("{}{line}", SIZES);
    insta::assert_snapshot!(faults(&[
        &format!("[dimensions]\nx1 = {{ nominal = 1, tolerance = 0.1, from = \"x0\" }}\n{rest}"),
        &format!("[dimensions]\nx1 = {{ nominal = 1, tolerance = 0.1, from = \"x1\" }}\n{rest}"),
        &format!(
            "[dimensions]\nx1 = {{ nominal = 1, from = \"x2\" }}\nx2 = {{ nominal = 1, from = [\"x3\"] }}\nx3 = {{ nominal = 1, from = \"x1\" }}\n{rest}"
        ),
        &format!("[dimensions]\nx0 = {{ nominal = 1 }}\nx1 = {{ tolerance = 0.1, from = \"x0\" }}\n{rest}"),
        &format!("[dimensions]\nx0 = {{ nominal = 1 }}\nx1 = {{ nominal = 3, tolerance = 0.1, from = 4 }}\n{rest}"),
        &format!(
            "[dimensions]\nx0 = {{ nominal = 1 }}\nx1 = {{ nominal = [3, 2], position = 0.1, from = \"x0\" }}\n{rest}"
        ),
        &format!(
            "[dimensions]\nx0 = {{ nominal = 1 }}\n\"x1.own\" = {{ nominal = 2 }}\nx1 = {{ nominal = 3, from = \"x0\" }}\n{rest}"
        ),
        &configured_wrongly("tiny = { LL = 3 }\n"),
        &configured_wrongly("tiny = { L = \"3\" }\n"),
        &configured_wrongly("tiny = 3\n"),
        &configured_wrongly("all = { L = 3 }\n"),
        &SIZES.replace("tolerance = \"1%\"", "limits = [19, 21]"),
    ]));
    let error = |text: &str, name: &str| configured(text, name).err().unwrap().to_string();
    assert_eq!(
        error(SIZES, "smal"),
        "study.toml: configurations: there is no configuration `smal` (did you mean `small`?)"
    );
    assert_eq!(error(&format!("{CHAIN}{rest}"), "small"), "study.toml: the study has no [configurations]");
}

/// The commands: an expanded study, one configuration, all of them.
#[test]
fn expand_and_configurations_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, SIZES.replace("D = {", "D2 = { nominal = 3, tolerance = 0.1, from = \"L\" }\nD = {"))
        .unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        let output = command.current_dir(folder.path()).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    insta::assert_snapshot!(run(&["expand", "study.toml", "--configuration", "small"]));
    let all: serde_json::Value = serde_json::from_str(&run(&[
        "analyze",
        "study.toml",
        "--configuration",
        "all",
        "--json",
        "-m",
        "second-order",
    ]))
    .unwrap();
    let mean = |index: usize| all[index]["characteristics"][0]["mean"].as_f64();
    let names: Vec<&str> = all.as_array().unwrap().iter().map(|one| one["study"].as_str().unwrap()).collect();
    assert_eq!(names, ["study.toml (small)", "study.toml (large)"]);
    let one: serde_json::Value = serde_json::from_str(&run(&[
        "analyze",
        "study.toml",
        "--configuration",
        "small",
        "--json",
        "-m",
        "second-order",
    ]))
    .unwrap();
    assert_eq!(mean(0), one["characteristics"][0]["mean"].as_f64());
    assert_ne!(mean(0), mean(1));
}
