//! What the documentation shows is what the program does: every console block is run, every quoted study is a file, and
//! the measured table is measured again. `TRYCMD=overwrite` and `SENSITOL_UPDATE_DOCS=1` write what has changed.

use std::fmt::Write;

use sensitol::plan::Stencil;
use sensitol::{Method, Options, Study, analyze};

use super::support::{data, repository};

/// Console blocks of the README and of every example, run from the repository's root; none leaves anything out.
#[test]
fn console_blocks_are_real() {
    for document in documents() {
        let elided = read(&document).lines().any(|line| line == "..." || line.contains("[..]"));
        assert!(!elided, "{document} leaves out some output");
    }
    trycmd::TestCases::new()
        .case("README.md")
        .case("CONTRIBUTING.md")
        .case("examples/*/README.md")
        .env("LC_ALL", "C.UTF-8")
        .run();
}

fn read(path: &str) -> String {
    std::fs::read_to_string(repository(path)).unwrap()
}

/// The first block of this language in a Markdown file.
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

/// The table of evaluations against errors, as the README shows it.
#[test]
fn the_measured_table_is_measured() {
    let table = measured();
    let path = repository("README.md");
    let readme = read("README.md");
    let (begin, end) = ("<!-- measured: begin -->\n", "<!-- measured: end -->");
    let start = readme.find(begin).unwrap() + begin.len();
    let stop = readme.find(end).unwrap();
    if std::env::var_os("SENSITOL_UPDATE_DOCS").is_some() {
        std::fs::write(path, format!("{}{table}{}", &readme[..start], &readme[stop..])).unwrap();
        return;
    }
    assert_eq!(&readme[start..stop], table, "SENSITOL_UPDATE_DOCS=1 writes it anew");
}

/// Errors against quadrature: of the mean in sigmas, of sigma relative.
fn measured() -> String {
    let methods = [
        ("`rss`", Options::from(Method::Rss)),
        ("`second-order`", Method::SecondOrder.into()),
        ("`six-n --stencil four-point`", Options { stencil: Some(Stencil::FourPoint), ..Method::SixN.into() }),
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
            write!(table, " {} | {} | {} |", analysis.evaluations, one_digit(mean), one_digit(sigma)).unwrap();
        }
        table.push('\n');
    }
    table
}

/// An error to its first digit, and what is below the reference's own error as that.
fn one_digit(error: f64) -> String {
    if error < 1e-8 { "<1e-8".to_owned() } else { format!("{error:.0e}") }
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

/// Every document of the repository, by its path in it.
fn documents() -> Vec<String> {
    let examples = std::fs::read_dir(repository("examples")).unwrap();
    let of_example = |folder: std::io::Result<std::fs::DirEntry>| {
        format!("examples/{}/README.md", folder.unwrap().file_name().into_string().unwrap())
    };
    let own = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "benches/README.md",
        "docs/accuracy.md",
        "adapters/PROTOCOL.md",
        "adapters/python/README.md",
    ];
    let own = own.map(str::to_owned);
    own.into_iter().chain(examples.map(of_example)).collect()
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
