//! All methods on the public test functions: evaluations, true errors, and tests of `auto` and of the error estimates. The document
//! `docs/accuracy.md` is written from the same numbers.

use std::fmt::Write as _;
use std::sync::OnceLock;

use rayon::prelude::*;
use sensitol::method::Stencil;
use sensitol::{Method, Options, analyze};
use sensitol_study::Study;

use super::coverage::{COLUMNS, checked, covered};
use super::external_models;
use sensitol_testing::{data, generated, repository, says};

/// Wanted accuracies of sigma for `auto`.
const ACCURACIES: [f64; 3] = [0.05, 0.01, 0.001];
/// Greatest error of the references, relative to sigma. The errors that they state are below 1e-7.
const FLOOR: f64 = 1e-7;

/// Test function with the results of all methods.
struct Row {
    name: String,
    n: usize,
    smooth: bool,
    runs: Vec<Ran>,
}

/// Result of one method on one function.
struct Ran {
    evaluations: usize,
    /// Relative error of sigma against the reference.
    error: f64,
    /// Relative error of sigma as estimated by the method.
    estimate: Option<f64>,
    /// True if points of the model replaced the surrogate.
    sampled: bool,
    /// Errors of mean, sigma, skewness and kurtosis with their estimates. The first two are in sigmas.
    figures: [(f64, Option<f64>); 4],
}

impl Ran {
    fn within(&self, wanted: f64) -> bool {
        self.error <= wanted
    }

    fn covered(&self) -> Option<bool> {
        Some(3.0 * self.estimate? >= self.error - FLOOR)
    }
}

fn contenders() -> Vec<(String, Options)> {
    let four_point = Options::from(Method::SixN).with_stencil(Stencil::FourPoint);
    let mut contenders: Vec<(String, Options)> = vec![
        ("`rss`".into(), Method::Rss.into()),
        ("`second-order`".into(), Method::SecondOrder.into()),
        ("`six-n --stencil four-point`".into(), four_point),
        ("`six-n`".into(), Method::SixN.into()),
        ("`full`".into(), Method::Full.into()),
        ("`classic`".into(), Method::Classic.into()),
    ];
    for accuracy in ACCURACIES {
        let options = Options::from(Method::Auto).with_accuracy(accuracy);
        contenders.push((format!("`auto` {} %", 100.0 * accuracy), options));
    }
    // Figures and estimates are those of the methods themselves. Those of a verification are tested in `trust`.
    contenders.iter_mut().for_each(|(_, options)| options.verify = Some(0));
    contenders
}

/// Returns the results on all functions, computed once for all tests.
fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let references = data("accuracy.json");
        let references: Vec<_> = references.as_object().unwrap().iter().collect();
        let row = |(name, truth): &(&String, &serde_json::Value)| {
            let study = Study::read(&repository(&format!("tests/data/accuracy/{name}.toml"))).unwrap();
            let run = |(_, options): (String, Options)| {
                let found = analyze(&study.problem, &options).unwrap();
                let one = &found.characteristics[0];
                let sigma = truth["sigma"].as_f64().unwrap();
                let (moments, estimate) = (one.moments.unwrap(), one.error_estimate.as_ref());
                let off = |figure: usize, found: Option<f64>| {
                    let unit = if figure < 2 { sigma } else { 1.0 };
                    let errors = estimate.map(|of| [of.mean, of.sigma, of.skewness, of.kurtosis]);
                    let error = (found.unwrap_or(f64::NAN) - truth[COLUMNS[figure]].as_f64().unwrap()).abs() / unit;
                    (error, errors.and_then(|errors| errors[figure]).map(|error| error / unit))
                };
                let values = [Some(moments.mean()), Some(moments.sigma()), moments.skewness(), moments.kurtosis()];
                Ran {
                    figures: std::array::from_fn(|figure| off(figure, values[figure])),
                    evaluations: found.run.evaluations as usize,
                    error: (one.moments.unwrap().sigma() / sigma - 1.0).abs(),
                    estimate: one.error_estimate.as_ref().and_then(|estimate| Some(estimate.sigma? / sigma)),
                    sampled: one.evidence.model_sampled.is_some(),
                }
            };
            Row {
                name: (*name).clone(),
                n: study.problem.dimensions().len(),
                smooth: truth["smooth"].as_bool().unwrap(),
                runs: contenders().into_iter().map(run).collect(),
            }
        };
        references.par_iter().map(row).collect()
    })
}

/// Returns the results of `auto` at its three accuracies.
fn auto(row: &Row) -> &[Ran] {
    &row.runs[row.runs.len() - ACCURACIES.len()..]
}

/// Returns the number of items for which a property holds, and of all items.
fn count<T>(of: impl IntoIterator<Item = T>, holds: impl Fn(&T) -> bool) -> (usize, usize) {
    of.into_iter().fold((0, 0), |(held, all), one| (held + usize::from(holds(&one)), all + 1))
}

fn smooth() -> impl Iterator<Item = &'static Row> {
    rows().iter().filter(|row| row.smooth)
}

fn wanted() -> impl Iterator<Item = (f64, &'static Ran)> {
    smooth().flat_map(|row| ACCURACIES.into_iter().zip(auto(row)))
}

fn bound(n: usize) -> usize {
    (1.3 * (n * n + 3 * n + 1) as f64) as usize + 16
}

#[test]
fn there_are_enough_functions() {
    assert!(rows().len() >= 40, "{}", rows().len());
    assert_eq!(rows().iter().map(|row| row.n).min(), Some(1));
    assert_eq!(rows().iter().map(|row| row.n).max(), Some(200));
}

/// At least 95 % of the smooth functions reach the wanted accuracy.
#[test]
fn auto_keeps_what_it_promises() {
    let (kept, all) = count(wanted(), |(wanted, ran)| ran.within(*wanted));
    assert!(100 * kept >= 95 * all, "{kept} of {all}");
}

/// Three times the estimated error covers the true one in at least 95 % of all cases, including kinks.
#[test]
fn the_estimates_of_auto_can_be_believed() {
    let (covered, all) = count(rows().iter().flat_map(auto), |ran| ran.covered() == Some(true));
    assert!(100 * covered >= 95 * all, "{covered} of {all}");
}

/// Smooth formulas that a surface describes completely cause no warning, with the usual verification.
#[test]
fn clean_functions_warn_of_nothing() {
    let clean = [
        "area-2",
        "cantilever-5",
        "cosine-1",
        "cylinder-force-4",
        "diagonal-3",
        "distance-4",
        "four-bar-5",
        "gear-train-8",
        "linear-3",
        "linear-20",
        "one-way-clutch-4",
        "orifice-4",
        "otl-circuit-6",
        "ratio-2",
        "reciprocal-1",
        "resonance-2",
        "slider-crank-4",
        "spring-rate-4",
        "stacked-blocks-8",
        "volume-3",
    ];
    let warned = |name: &&str| {
        let study = Study::read(&repository(&format!("tests/data/accuracy/{name}.toml"))).unwrap();
        let found = analyze(&study.problem, &Method::Auto.into()).unwrap().warnings;
        (!found.is_empty()).then(|| format!("{name}: {found:?}"))
    };
    let warned: Vec<String> = clean.par_iter().filter_map(warned).collect();
    assert!(warned.is_empty(), "{warned:#?}");
}

/// A smooth function that a surrogate follows costs little more than all second derivatives, and 16 evaluations.
#[test]
fn auto_does_not_waste_evaluations() {
    for row in smooth() {
        for ran in auto(row).iter().filter(|ran| !ran.sampled) {
            assert!(ran.evaluations <= bound(row.n), "{}: {} of {}", row.name, ran.evaluations, bound(row.n));
        }
    }
}

#[test]
fn auto_is_quick_with_what_is_linear_and_what_is_sparse() {
    for row in rows().iter().filter(|row| row.name.starts_with("linear")) {
        for ran in auto(row) {
            assert!(ran.evaluations <= 2 * row.n + 1 + 24, "{}: {}", row.name, ran.evaluations);
            assert!(ran.error < 1e-9, "{}: {}", row.name, ran.error);
        }
    }
    for row in rows().iter().filter(|row| row.name.starts_with("sparse") && row.n >= 50) {
        let full = row.n * row.n + row.n + 1;
        for ran in auto(row) {
            assert!(5 * ran.evaluations <= full, "{}: {} of {full}", row.name, ran.evaluations);
        }
    }
}

/// Compares `docs/accuracy.md` and the table of every function with the measured numbers, to the last character.
#[test]
fn the_documents_show_what_was_measured() {
    for (page, text) in [("docs/accuracy.md", summary_page()), ("tests/accuracy/README.md", every_function())] {
        let path = repository(page);
        if std::env::var_os("SENSITOL_UPDATE_DOCS").is_some() {
            std::fs::write(path, text).unwrap();
            continue;
        }
        assert_eq!(std::fs::read_to_string(path).unwrap(), text, "{page}: SENSITOL_UPDATE_DOCS=1 writes it anew");
    }
}

/// Compares the table of coverage in `docs/validation.md` with the measured numbers.
#[test]
fn the_validation_page_shows_the_coverage() {
    let mut text = String::from("| errors within three estimates | covered |\n|---|--:|\n");
    let (held, all) = count(rows().iter().flat_map(auto), |ran| ran.covered() == Some(true));
    writeln!(text, "| sigma by `auto`, {} functions at three accuracies | {held} of {all} |", rows().len()).unwrap();
    for (figure, name) in COLUMNS.iter().enumerate() {
        let (held, all, _) = covered(checked().iter().filter(|case| case.figure == figure));
        writeln!(text, "| {name} by every method, costly models at check points | {held} of {all} |").unwrap();
    }
    text += &external_models::coverage();
    generated("docs/validation.md", "coverage", &text);
}

fn summary_page() -> String {
    let mut text = String::from(
        "# Cost and accuracy of every method\n\n\
         [Tests](../tests/accuracy/README.md) measure these tables, and list every function with its evaluations, error and source. References come\n\
         from quadrature, closed forms and exact moments by [another program](../tests/data/generators/accuracy.py), to 1e-7 of sigma.\n\n\
         Constants of the methods may be chosen on these functions. Errors are judged on other functions\n\
         ([trust.jsonl](../tests/data/trust.jsonl)), on which no constant is chosen.\n\n",
    );
    summary(&mut text);
    text
}

/// Returns the table of evaluations and errors by function and method, with the sources of the functions.
fn every_function() -> String {
    let references = data("accuracy.json");
    let mut text = String::from(
        "# Accuracy by function\n\n\
         [accuracy.rs](accuracy.rs) writes these tables and [docs/accuracy.md](../../docs/accuracy.md) from the studies in\n\
         [tests/data/accuracy](../data/accuracy): `SENSITOL_UPDATE_DOCS=1 cargo test --test accuracy accuracy`.\n\n\
         Evaluations, and the relative error of sigma in brackets. A star: the surrogate was not trusted, and the model was\n\
         sampled with it as control variate. Functions with a kink are in italics.\n\n| function | N |",
    );
    let contenders = contenders();
    contenders.iter().for_each(|(name, _)| write!(text, " {name} |").unwrap());
    text += "\n|---|--:|";
    contenders.iter().for_each(|_| text += "--:|");
    text.push('\n');
    for row in rows() {
        let name = if row.smooth { row.name.clone() } else { format!("*{}*", row.name) };
        write!(text, "| {name} | {} |", row.n).unwrap();
        for ran in &row.runs {
            let star = if ran.sampled { "\\*" } else { "" };
            write!(text, " {}{star} ({}) |", ran.evaluations, digit(ran.error)).unwrap();
        }
        text.push('\n');
    }
    text += "\n## Sources\n\n| function | source | reference |\n|---|---|---|\n";
    for (name, truth) in references.as_object().unwrap() {
        let word = |key: &str| truth[key].as_str().unwrap();
        writeln!(text, "| {name} | {} | {} |", word("source"), word("reference")).unwrap();
    }
    text
}

fn summary(text: &mut String) {
    let share = |(held, all): (usize, usize)| format!("{held} of {all} ({:.1} %)", 100.0 * held as f64 / all as f64);
    let kinked = rows().len() - smooth().count();
    writeln!(text, "{} functions, {kinked} of them with a kink, of 1 to 200 dimensions.\n", rows().len()).unwrap();
    *text += "| required of `auto` | reached |\n|---|--:|\n";
    for (index, accuracy) in ACCURACIES.into_iter().enumerate() {
        let kept = count(smooth().map(|row| &auto(row)[index]), |ran| ran.within(accuracy));
        writeln!(text, "| sigma of smooth functions to {} % | {} |", 100.0 * accuracy, share(kept)).unwrap();
    }
    let kinks = count(
        rows().iter().filter(|row| !row.smooth).flat_map(|row| ACCURACIES.into_iter().zip(auto(row))),
        |(wanted, ran)| ran.within(*wanted),
    );
    writeln!(text, "| the same of functions with a kink, at all three | {} |", share(kinks)).unwrap();
    let covered = count(rows().iter().flat_map(auto), |ran| ran.covered() == Some(true));
    writeln!(text, "| true error within three times the estimated one | {} |", share(covered)).unwrap();
    let within = count(smooth().flat_map(|row| auto(row).iter().map(move |ran| (row.n, ran))), |(n, ran)| {
        ran.evaluations <= bound(*n)
    });
    writeln!(text, "| at most 1.3 (N² + 3N + 1) + 16 evaluations, smooth functions | {} |", share(within)).unwrap();
    let sampled = count(smooth().flat_map(auto), |ran| ran.sampled);
    writeln!(text, "| smooth functions whose model was sampled | {} |", share(sampled)).unwrap();
    figures(text);
}

/// Writes the table of all figures: of these functions without verification, and of those of `trust.jsonl` at check points.
fn figures(text: &mut String) {
    *text += "\n## All figures\n\nMedian error of each figure on smooth functions without verification, mean and sigma in sigmas. In brackets: errors within \
              three\nestimates, kinks included.\n\n| method | mean | sigma | skewness | kurtosis | largest of sigma |\n|---|--:|--:|--:|--:|--:|\n";
    for (index, (name, _)) in contenders().iter().enumerate() {
        write!(text, "| {name} |").unwrap();
        for figure in 0..4 {
            let mut errors: Vec<f64> = smooth().map(|row| row.runs[index].figures[figure].0).collect();
            errors.sort_by(f64::total_cmp);
            // References are accurate to 1e-7 of sigma, and to some multiples of that for higher moments.
            let floor = FLOOR * [1.0, 1.0, 10.0, 100.0][figure];
            let known = rows().iter().filter_map(|row| {
                let (error, estimate) = row.runs[index].figures[figure];
                Some(3.0 * estimate? >= error - floor)
            });
            let (held, all) = count(known, |held| *held);
            write!(text, " {} ({held} of {all}) |", digit(errors[errors.len() / 2])).unwrap();
        }
        writeln!(text, " {} |", median_and_largest(index)[1]).unwrap();
    }
    *text += "\n## Error estimates\n\nThe functions of `trust.jsonl` as costly models, verified at check points: errors within three estimates, and in brackets the \
              median of\nestimate over error. Estimates exceed errors because a dozen check points may by chance miss the worst places. A cheap \
              model is sampled instead, and\nits estimates are standard errors. For methods that integrate, the errors are \
              those of the surface through their points.\n\n\
              | method | mean | sigma | skewness | kurtosis | yield |\n|---|--:|--:|--:|--:|--:|\n";
    for method in Method::ALL {
        write!(text, "| `{}` |", method.name()).unwrap();
        for figure in 0..COLUMNS.len() {
            let own = checked().iter().filter(|case| case.method == method && case.figure == figure);
            let (held, all, ratio) = covered(own);
            match ratio {
                Some(ratio) => write!(text, " {held} of {all} ({ratio:.1}) |").unwrap(),
                None => text.push_str(" - |"),
            }
        }
        text.push('\n');
    }
    *text += "\nExternal models with contacts, steps and second states that 0.01 % to 5 % of the assemblies meet, and smooth models. A verdict is \
              wrong if a\ntarget is called met although the model has ten times the rejects.\n\n\
              | method | within 3 estimates, functions that judge | functions for constants | wrong verdicts |\n|---|--:|--:|--:|\n";
    *text += &external_models::table();
}

/// Returns the median and the largest error of a contender on smooth functions.
fn median_and_largest(contender: usize) -> [String; 2] {
    let mut errors: Vec<f64> = smooth().map(|row| row.runs[contender].error).collect();
    errors.sort_by(f64::total_cmp);
    [errors[errors.len() / 2], errors[errors.len() - 1]].map(digit)
}

/// Checks that the how-to pages quote these tables.
#[test]
fn the_how_to_pages_quote_what_was_measured() {
    const CHOOSE: &str = "docs/how-to/choose-a-method.md";
    let all = contenders();
    let contender = |name: &str| all.iter().position(|(known, _)| known == name).unwrap();
    let kinked = ["none", "one", "two", "three", "four", "five", "six"][rows().len() - smooth().count()];
    says(CHOOSE, &format!("{} functions of 1 to 200 dimensions, {kinked} of them with a kink", rows().len()));
    for (name, shown) in
        [("rss", "`rss`"), ("second-order", "`second-order`"), ("six-n", "`six-n`"), ("full", "`full`")]
    {
        let [median, largest] = median_and_largest(contender(&format!("`{name}`")));
        says(CHOOSE, &format!("| {shown} | {median} | {largest} |"));
    }
    let auto = contender("`auto` 1 %");
    let [median, largest] = median_and_largest(auto);
    says(CHOOSE, &format!("| `auto`, 1 % wanted | {median} | {largest} |"));
    let ran =
        |function: &str, contender: usize| &rows().iter().find(|row| row.name == function).unwrap().runs[contender];
    let [rss, six_n, full] = ["`rss`", "`six-n`", "`full`"].map(contender);
    let figures = |function: &str, contender: usize| {
        let ran = ran(function, contender);
        (ran.evaluations, digit(ran.error).replace('<', "below "))
    };
    let [one, two, three] = [rss, full, auto].map(|of| figures("product-200", of));
    says(
        CHOOSE,
        &format!(
            "`rss` {} evaluations and an error of {}, `full` {} and {}, `auto` {} and {}.",
            one.0, one.1, two.0, two.1, three.0, three.1
        ),
    );
    let [one, two, three] = [six_n, full, auto].map(|of| figures("sparse-25-of-50", of));
    says(
        CHOOSE,
        &format!(
            "`six-n` takes {} evaluations with an error of sigma of {}, `full` {} and {}, `auto` {} and {}.",
            one.0, one.1, two.0, two.1, three.0, three.1
        ),
    );
    let kink: Vec<f64> = (0..auto - 1).map(|of| ran("tied-gaps-4", of).error).collect();
    let percent = |error: f64| 100.0 * digit(error).parse::<f64>().unwrap();
    let least = kink.iter().copied().fold(f64::INFINITY, f64::min);
    let most = kink.iter().copied().fold(0.0, f64::max);
    let (evaluations, error) = figures("tied-gaps-4", auto);
    says(
        CHOOSE,
        &format!(
            "every derivative method {:.0} % to {:.0} % off, `auto` at 1 % by {evaluations} evaluations {error}.",
            percent(least),
            percent(most)
        ),
    );
    let covered = count(rows().iter().flat_map(self::auto), |ran| ran.covered() == Some(true));
    let derivative = [full, six_n, contender("`classic`"), contender("`six-n --stencil four-point`")];
    let runs = rows().iter().flat_map(|row| derivative.map(|of| &row.runs[of]));
    let others = count(runs.filter_map(Ran::covered), |covered| *covered);
    says(
        "docs/how-to/trust-a-result.md",
        &format!(
            "Over {} functions the error of sigma was within three times its estimate in {} of {} cases for `auto`. It was in {} of {} \
             cases for `six-n`, `full`, `classic` and the four-point `six-n`",
            rows().len(),
            covered.0,
            covered.1,
            others.0,
            others.1
        ),
    );
}

/// Formats an error to its first digit. An error below that of the reference is shown as the latter.
fn digit(error: f64) -> String {
    if error < FLOOR { "<1e-7".to_owned() } else { format!("{error:.0e}") }
}

/// Functions that tune constants are not used for tests. The functions that measure the errors of all methods have other names, and other
/// inputs if the formula is the same.
#[test]
fn functions_that_tune_are_not_those_that_test() {
    let bare = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let inputs = |study: &Study| -> Vec<[f64; 2]> {
        study.problem.dimensions().iter().map(|dimension| [dimension.mean(), dimension.sigma()]).collect()
    };
    let lines = std::fs::read_to_string(repository("tests/data/trust.jsonl")).unwrap();
    let testing: Vec<(String, String, Vec<[f64; 2]>)> = lines
        .lines()
        .map(|line| {
            let of: serde_json::Value = serde_json::from_str(line).unwrap();
            let word = |key: &str| of[key].as_str().unwrap().to_owned();
            let study = serde_json::json!({
                "dimensions": of["dimensions"],
                "characteristics": { "y of it": { "formula": of["formula"] } },
            });
            let study = Study::from_json(&study.to_string(), "testing").unwrap();
            (word("name"), bare(&word("formula")), inputs(&study))
        })
        .collect();
    assert!(testing.len() >= 50, "{}", testing.len());
    let tuning = data("accuracy.json");
    assert!(tuning.as_object().unwrap().len() >= 40);
    for name in tuning.as_object().unwrap().keys() {
        let path = repository(&format!("tests/data/accuracy/{name}.toml"));
        let own = inputs(&Study::read(&path).unwrap());
        let text = bare(&std::fs::read_to_string(&path).unwrap());
        let same = testing.iter().find(|(other, formula, inputs)| {
            other == name || text.contains(&format!("\"{formula}\"")) && *inputs == own
        });
        assert!(same.is_none(), "{name}: {same:?}");
    }
}
