//! Figures in sentences of the documents equal the present results. Each sentence is written here without its figures, filled in, and
//! searched on its page.

use sensitol::simulation::{SimulationOptions, simulate};
use serde_json::Value;

use super::command::sensitol;
use sensitol_testing::{repository, says};

const TUTORIAL: &str = "docs/tutorial.md";
const TRUST: &str = "docs/how-to/trust-a-result.md";
const MEASURED: &str = "docs/how-to/measured-data.md";

/// Returns the JSON that a command prints.
fn json(arguments: &[&str]) -> Value {
    let output = sensitol(&[arguments, &["--json", "-q"]].concat()).output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}"))
}

/// Returns the first characteristic of a report.
fn first(arguments: &[&str]) -> Value {
    json(arguments)["characteristics"][0].clone()
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

#[test]
fn the_tutorial_reads_its_output_right() {
    let study = "examples/first-study/study.toml";
    let report = json(&["analyze", study]);
    let gap = &report["characteristics"][0];
    let of = |key: &str| number(&gap[key]);
    says(TUTORIAL, &format!("- {} evaluations build the surface and check it.", report["evaluations"]));
    says(TUTORIAL, &format!("The mean is {:.4} mm above the nominal gap.", of("mean") - of("nominal")));
    let [spacer, tilt] = ["spacer", "tilt"].map(|name| {
        let all = report["dimensions"].as_array().unwrap();
        let at = all.iter().position(|one| one["name"] == name).unwrap();
        (all[at].clone(), gap["sensitivities"][at].clone())
    });
    let mean = number(&spacer.0["mean"]);
    says(TUTORIAL, &format!("so its mean is {mean:.3}: that is {:.3} mm.", number(&spacer.0["nominal"]) - mean));
    says(TUTORIAL, &format!("The tilt takes {:.4} mm away", -number(&tilt.1["mean_shift"])));
    let normal = 100.0 * number(&gap["normal_fit"]["yield"]);
    says(TUTORIAL, &format!("- Yield {:.3} %, target missed.", 100.0 * of("yield")));
    says(TUTORIAL, &format!("A normal distribution with the same mean and sigma would give {normal:.2} %."));
    let [low, high] = [0, 1].map(|end| number(&gap["worst_case"]["bounds"][end]));
    says(TUTORIAL, &format!("- Worst case {low:.3} .. {high:.3}:"));
    let bearing = gap["sensitivities"].as_array().unwrap().iter().find(|row| row["dimension"] == "bearing").unwrap();
    let share = 100.0 * number(&bearing["linear_share"]);
    says(TUTORIAL, &format!("{share:.0} % of the variance comes from the bearing."));
    says(TUTORIAL, &format!("The bearing has {share:.0} % of the variance."));

    // The program prints three digits of these rejects.
    let below = 10.0 * (0.1 * of("ppm_below")).round();
    says(TUTORIAL, &format!("{below:.0} ppm below the lower limit, and the target allows 2700 ppm."));
    let sample = first(&["simulate", study]);
    let sampled = number(&sample["ppm_below"]);
    let both = format!("{sampled:.0} ppm of the sample are below the lower limit, {below:.0} ppm in the analysis.");
    says(TUTORIAL, &both);
    let percent = |gap: &Value| 100.0 * number(&gap["yield"]);
    let tighter = "examples/first-study/tighter.toml";
    let [after, before] = [percent(&first(&["analyze", tighter])), percent(gap)];
    says(TUTORIAL, &format!("the yield is {after:.3} % instead of {before:.3} %."));
    let [after, before] = [percent(&first(&["simulate", tighter])), percent(&sample)];
    says(TUTORIAL, &format!("`simulate` gives {after:.2} % instead of {before:.2} %."));
}

/// Requirements of the first study, costs of its tolerances, and results of the model for them.
#[test]
fn the_tutorials_requirements_were_tried() {
    let study = std::fs::read_to_string(repository("examples/first-study/study.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    let confirmed = |requires: &str| {
        let changed = study.replace("target_yield = 0.9973", &format!("target_yield = 0.9973, {requires}"));
        assert_ne!(changed, study);
        std::fs::write(&path, changed).unwrap();
        let output = sensitol(&["allocate", path.to_str().unwrap(), "--confirm", "100000", "-q"]).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let line = text.lines().find(|line| line.contains("points of the model keep the limits")).unwrap();
        let percent = line.strip_prefix("gap: ").unwrap().split(' ').next().unwrap();
        percent.parse::<f64>().unwrap()
    };
    let kept = format!("{:.2} %", confirmed("require = { yield = 0.9973 }"));
    says(TUTORIAL, &format!("An independent sample gives {kept}."));
    let capable = json(&["allocate", "examples/first-study/capable.toml", "--confirm", "100000"]);
    let [after, before] = ["cost_after", "cost_before"].map(|key| number(&capable[key]));
    says(TUTORIAL, &format!("the cost is {after:.2} instead of {before:.2}, and"));
    let kept = number(&capable["confirmation"]["characteristics"][0]["yield"]);
    says(TUTORIAL, &format!("instead of {before:.2}, and {:.2} % keep the limits.", 100.0 * kept));
}

#[test]
fn the_tails_are_those_of_the_studies() {
    let ppm = |one: &Value| [&one["ppm_below"], &one["ppm_above"]].map(|ppm| format!("{:.0}", number(ppm))).join(", ");
    let analyzed = |study: &str| {
        let one = first(&["analyze", study]);
        (ppm(&one), format!("{} | {{}} | {}", ppm(&one["pearson_fit"]), ppm(&one["normal_fit"])))
    };
    let (own, others) = analyzed("examples/first-study/study.toml");
    let rare = first(&["simulate", "examples/first-study/study.toml", "--rare"]);
    let of_rare = |side: &str, digits: usize| {
        let [value, error] = ["probability", "standard_error"].map(|key| 1e6 * number(&rare[side][key]));
        format!("{value:.digits$} ± {error:.digits$}")
    };
    let model = format!("{}, {}", of_rare("below", 0), of_rare("above", 1));
    says(TRUST, &format!("| {own} | {} |", others.replace("{}", &model)));
    // Sampled by another program, as described in `tests/data/two-suppliers.info.json`.
    let (own, others) = analyzed("examples/two-suppliers/study.toml");
    let truth = ppm(&sensitol_testing::data("two-suppliers.json"));
    says(TRUST, &format!("| {own} | {} |", others.replace("{}", &truth)));
    // A thousand good points: Clopper and Pearson's bound, as in `simulate`.
    let least = 100.0 * 0.025_f64.powf(1e-3);
    says(TRUST, &format!("A yield of 100 % in 1000 points means above {least:.1} %, no more."));
    let study = sensitol_study::Study::read(&repository("examples/thermal-clearance/study.toml")).unwrap();
    let sample = simulate(&study.problem, &SimulationOptions::default().with_samples(1000)).unwrap();
    let [low, high] = sample.characteristics[0].yield_.as_ref().unwrap().interval;
    assert!(high == 1.0 && (100.0 * low - least).abs() < 0.05, "{low} .. {high}");
}

#[test]
fn one_chip_matters() {
    let below = |study: &str| number(&first(&["analyze", study, "-m", "full"])["ppm_below"]);
    let [chip, checked] = ["study", "checked"].map(|name| below(&format!("examples/measured-pin/{name}.toml")));
    says(MEASURED, &format!("makes the rejects below the lower limit {chip:.0} ppm instead of {checked:.0}."));
}
