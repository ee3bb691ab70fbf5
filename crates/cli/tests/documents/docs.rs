//! The documentation shows the program's own output: every console block is run, every quoted study is a file, and
//! the measured table is measured again. `TRYCMD=overwrite` and `SENSITOL_UPDATE_DOCS=1` write what has changed.

use std::collections::BTreeSet;
use std::fmt::Write;

use sensitol::method::Stencil;
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Method, Options, Warning, analyze};
use sensitol_study::Study;

use super::reference;
use super::report_reference;
use sensitol_testing::{INSTALLED, data, generated, repository};

/// Console blocks of the README, the documents and every example, run from the repository's root. None of them is shortened.
#[test]
fn console_blocks_are_real() {
    for document in documents() {
        let elided = read(&document).lines().any(|line| line == "..." || line.contains("[..]"));
        assert!(!elided, "{document} leaves out some output");
    }
    // Commands of documents run at the repository's root, and so does everything in this binary.
    std::env::set_current_dir(repository("")).unwrap();
    let cases = trycmd::TestCases::new();
    cases.case("README.md").case("CONTRIBUTING.md").case("examples/*/README.md");
    cases.case("docs/*.md").case("docs/how-to/*.md").case("docs/reference/*.md");
    for example in INSTALLED {
        cases.skip(format!("examples/{example}/README.md"));
    }
    cases.env("LC_ALL", "C.UTF-8").env("COLUMNS", "80").run();
}

fn read(path: &str) -> String {
    std::fs::read_to_string(repository(path)).unwrap()
}

/// Returns the first block of this language in a Markdown file.
fn block<'t>(text: &'t str, language: &str) -> &'t str {
    let start = text.find(&format!("```{language}\n")).unwrap() + language.len() + 4;
    &text[start..start + text[start..].find("```").unwrap()]
}

#[test]
fn the_study_in_the_readme_is_the_example() {
    let (readme, study) = (read("README.md"), read("examples/shaft-and-bore/study.toml"));
    assert_eq!(block(&readme, "toml"), study);
    assert_eq!(study.lines().count(), 6, "the README promises six lines");
}

/// Table of evaluations against errors.
#[test]
fn the_measured_table_is_measured() {
    generated("docs/methods.md", "measured", &measured());
}

/// Every key of a study file, from the schema.
#[test]
fn the_reference_of_study_files_is_generated() {
    page("docs/reference/study-file.md", "the_reference_of_study_files_is_generated", &reference::study_file());
}

/// Every command and option, from the parser.
#[test]
fn the_reference_of_commands_is_generated() {
    page("docs/reference/commands.md", "the_reference_of_commands_is_generated", &reference::commands());
}

/// Every key of a report, from its schema.
#[test]
fn the_reference_of_reports_is_generated() {
    page("docs/reference/json-report.md", "the_reference_of_reports_is_generated", &report_reference::json_report());
}

/// Checks that a document equals the generated text, or writes it.
fn page(document: &str, test: &str, text: &str) {
    if std::env::var_os("SENSITOL_UPDATE_DOCS").is_some() {
        std::fs::write(repository(document), text).unwrap();
        return;
    }
    let found = std::fs::read_to_string(repository(document)).unwrap_or_default();
    let line = found.lines().zip(text.lines()).take_while(|(found, text)| found == text).count() + 1;
    assert!(
        found == text,
        "{document} is not what the program says, from line {line} on: SENSITOL_UPDATE_DOCS=1 cargo test -p sensitol-cli --test documents \
         docs::{test} writes it anew"
    );
}

/// Method of the papers: its name there, seconds on their computer, and the corresponding method here.
struct Published {
    name: &'static str,
    seconds: Option<f64>,
    ours: Ours,
}

enum Ours {
    Method(Method),
    MonteCarlo(u64),
}

/// Evaluations against accuracy, beside the times of Table 7 of the stacked-blocks paper. Its computer time is that of the CAD system, so
/// a time there corresponds to a number of evaluations here.
#[test]
fn the_trade_beside_the_paper_is_measured() {
    let method = |name, seconds, method| Published { name, seconds, ours: Ours::Method(method) };
    let drawn = |samples, seconds| Published { name: "Monte Carlo", seconds, ours: Ours::MonteCarlo(samples) };
    let blocks = [
        drawn(30_000, Some(1670.36)),
        method("full factorial (Seo and Kwak)", Some(342.13), Method::ThreePoint),
        method("dimension reduction", Some(6.128), Method::DimensionReduction),
        method("improved second order", Some(2.24), Method::SixN),
        method("direct linearisation", Some(1.35), Method::Rss),
    ];
    let truth = &data("stacked-blocks.json")["moments"];
    generated("examples/stacked-blocks/README.md", "trade", &trade("stacked-blocks", "gap", truth, &blocks, true));
    let engine = [
        drawn(100_000, None),
        method("full factorial", None, Method::ThreePoint),
        method("dimension reduction", None, Method::DimensionReduction),
        method("improved second order", None, Method::SixN),
        method("every interaction", None, Method::Full),
        method("root of the sum of squares", None, Method::Rss),
    ];
    let truth = &data("engine-balance.json")["table-3"]["F"];
    generated("examples/engine-balance/README.md", "trade", &trade("engine-balance", "F", truth, &engine, false));
}

fn trade(example: &str, characteristic: &str, truth: &serde_json::Value, rows: &[Published], seconds: bool) -> String {
    let study = Study::read(&repository("examples").join(example).join("study.toml")).unwrap();
    let problem = study.problem.only(&[characteristic]).unwrap();
    let expected = |key: &str| truth[key].as_f64().unwrap();
    let figures = |ours: &Ours| match ours {
        Ours::Method(method) => {
            let found = analyze(&problem, &Options::from(*method)).unwrap();
            let moments = found.characteristics[0].moments.unwrap();
            let (skewness, kurtosis) = (moments.skewness().unwrap(), moments.kurtosis().unwrap());
            (method.name().to_owned(), found.run.evaluations, [moments.mean(), moments.sigma(), skewness, kurtosis])
        }
        Ours::MonteCarlo(samples) => {
            let options = SimulationOptions::default().with_samples(*samples);
            let one = simulate(&problem, &options).unwrap().characteristics.remove(0);
            let values = [one.mean, one.sigma, one.skewness, one.kurtosis].map(|estimate| estimate.unwrap().value);
            ("monte-carlo".to_owned(), *samples, values)
        }
    };
    let found: Vec<_> = rows.iter().map(|row| figures(&row.ours)).collect();
    let base = rows.iter().position(|row| matches!(row.ours, Ours::Method(Method::SixN))).unwrap();
    let (spent, took) = (found[base].1 as f64, rows[base].seconds.unwrap_or(1.0));
    let (columns, line) = if seconds { ("published | ratio | ", "--:|--:|") } else { ("", "") };
    let mut table = format!(
        "| in the paper | {columns}ours | evaluations | ratio | mean | sigma | skewness | kurtosis |\n\
         |---|{line}---|--:|--:|--:|--:|--:|--:|\n"
    );
    for (row, (name, evaluations, [mean, sigma, skewness, kurtosis])) in rows.iter().zip(found) {
        let published = row.seconds.map_or(String::new(), |seconds| format!(" {seconds} s | {:.1} |", seconds / took));
        let errors = [
            (mean - expected("mean")) / expected("sigma"),
            sigma / expected("sigma") - 1.0,
            skewness - expected("skewness"),
            kurtosis - expected("kurtosis"),
        ]
        .map(|error| one_digit(error.abs()));
        let ratio = evaluations as f64 / spent;
        let errors = errors.join(" | ");
        writeln!(table, "| {} |{published} `{name}` | {evaluations} | {ratio:.1} | {errors} |", row.name).unwrap();
    }
    table
}

/// Errors against quadrature: of the mean in sigmas, of sigma relative.
fn measured() -> String {
    let methods = [
        ("`rss`", Options::from(Method::Rss)),
        ("`second-order`", Method::SecondOrder.into()),
        ("`six-n --stencil four-point`", Options::from(Method::SixN).with_stencil(Stencil::FourPoint)),
        ("`six-n`", Method::SixN.into()),
        ("`full`", Method::Full.into()),
        ("`classic`", Method::Classic.into()),
        ("`dimension-reduction`", Method::DimensionReduction.into()),
        ("`bivariate-dimension-reduction`", Method::BivariateDimensionReduction.into()),
        ("`three-point`", Method::ThreePoint.into()),
        ("`response-surface`", Method::ResponseSurface.into()),
    ];
    let (clearance, engine, blocks) =
        (data("shaft-and-bore.json"), data("engine-balance.json"), data("stacked-blocks.json"));
    let cases = [
        ("shaft-and-bore/study.toml", "clearance", &clearance),
        ("engine-balance/study.toml", "F", &engine["table-3"]["F"]),
        ("stacked-blocks/study.toml", "gap", &blocks["moments"]),
    ];
    let mut table = String::from(
        "| method | shaft and bore | mean | sigma | engine force | mean | sigma | stacked blocks | mean | sigma |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for (name, options) in methods {
        write!(table, "| {name} |").unwrap();
        for (path, characteristic, truth) in cases {
            let problem = Study::read(&repository("examples").join(path)).unwrap().problem;
            let analysis = analyze(&problem.only(&[characteristic]).unwrap(), &options).unwrap();
            let moments = analysis.characteristics[0].moments.unwrap();
            let expected = |key: &str| truth[key].as_f64().unwrap();
            let mean = (moments.mean() - expected("mean")).abs() / expected("sigma");
            let sigma = (moments.sigma() / expected("sigma") - 1.0).abs();
            write!(table, " {} | {} | {} |", analysis.run.evaluations, one_digit(mean), one_digit(sigma)).unwrap();
        }
        table.push('\n');
    }
    table
}

/// Formats an error with its first digit. Values below the reference's own error are printed as that bound.
fn one_digit(error: f64) -> String {
    if error < 1e-8 { "<1e-8".to_owned() } else { format!("{error:.0e}") }
}

/// Examples that only `tests/adapters/run` executes are shown there.
#[test]
fn examples_that_need_an_installation_are_run_elsewhere() {
    let scripts = ["freecad", "spreadsheet", "opencascade", "um_bridge", "octave", "fmi", "cluster"]
        .map(|name| read(&format!("tests/adapters/{name}.py")));
    for example in INSTALLED {
        assert!(scripts.iter().any(|script| script.contains(&format!("shown(\"{example}\")"))), "{example}");
    }
}

/// Every example has a study and a README that names it.
#[test]
fn every_example_is_described() {
    for folder in std::fs::read_dir(repository("examples")).unwrap() {
        let folder = folder.unwrap().path();
        let text =
            std::fs::read_to_string(folder.join("README.md")).unwrap_or_else(|_| panic!("{folder:?} has no README"));
        let name = folder.file_name().unwrap().to_str().unwrap();
        assert!(text.contains(&format!("$ sensitol analyze examples/{name}/")), "{name} is not run in its README");
    }
}

/// Returns the paths of all documents in the repository.
pub fn documents() -> Vec<String> {
    let examples = std::fs::read_dir(repository("examples")).unwrap();
    let of_example = |folder: std::io::Result<std::fs::DirEntry>| {
        format!("examples/{}/README.md", folder.unwrap().file_name().into_string().unwrap())
    };
    let own = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "SECURITY.md",
        "benches/README.md",
        "benches/python.md",
        "python/README.md",
        "packaging/README.md",
        "adapters/PROTOCOL.md",
        "adapters/python/README.md",
        "adapters/freecad/README.md",
        "adapters/spreadsheet/README.md",
        "adapters/opencascade/README.md",
        "adapters/umbridge/README.md",
        "adapters/octave/README.md",
        "adapters/fmi/README.md",
        "adapters/dask/README.md",
    ];
    let own = own.map(str::to_owned);
    let pages = ["docs", "docs/how-to", "docs/reference"].into_iter().flat_map(pages);
    own.into_iter().chain(pages).chain(examples.map(of_example)).collect()
}

/// Returns the Markdown files of a folder.
pub fn pages(folder: &str) -> Vec<String> {
    let files = std::fs::read_dir(repository(folder)).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".md")).map(|name| format!("{folder}/{name}")).collect()
}

/// The index lists every page.
#[test]
fn the_index_has_every_page() {
    let index = read("docs/README.md");
    for page in ["docs", "docs/how-to", "docs/reference"].into_iter().flat_map(pages) {
        let link = page.strip_prefix("docs/").unwrap();
        assert!(link == "README.md" || index.contains(&format!("]({link})")), "docs/README.md does not name {link}");
    }
}

/// Every warning code has an entry, and every entry has a code.
#[test]
fn every_warning_is_explained() {
    let codes: BTreeSet<&str> = Warning::CODES.iter().copied().collect();
    assert_eq!(codes.len(), Warning::CODES.len(), "two warnings have one code");
    let page = read("docs/reference/warnings.md");
    let explained = page.lines().filter_map(|line| line.strip_prefix("### `")?.strip_suffix('`'));
    assert_eq!(explained.collect::<BTreeSet<_>>(), codes);
}

/// The tutorial changes one line of its study at a time.
#[test]
fn the_tutorials_studies_differ_in_one_line() {
    let study = read("examples/first-study/study.toml");
    for other in ["tighter.toml", "capable.toml"] {
        let changed = read(&format!("examples/first-study/{other}"));
        assert_eq!(study.lines().count(), changed.lines().count());
        assert_eq!(study.lines().zip(changed.lines()).filter(|(line, other)| line != other).count(), 1, "{other}");
    }
}

#[test]
fn links_within_the_repository_lead_somewhere() {
    for document in documents() {
        let text = read(&document);
        let folder = repository(&document).parent().unwrap().to_path_buf();
        for target in text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap()) {
            if !target.contains("://") && !target.starts_with('#') {
                let file = target.split('#').next().unwrap();
                assert!(folder.join(file).exists(), "{document} links to {target}");
            }
        }
    }
}
