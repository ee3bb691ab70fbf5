//! Every method on the public test functions: evaluations, true error, and whether `auto` and its estimate keep their word.

use sensitol::plan::Stencil;
use sensitol::study::Study;
use sensitol::{Analysis, Method, Options, analyze};

use super::support::{data, repository};

/// The names of the functions, in the order of the references.
pub fn names() -> Vec<String> {
    data("accuracy.json").as_object().unwrap().keys().cloned().collect()
}

#[test]
fn dev() {
    let reference = data("accuracy.json");
    let only = std::env::var("CASE").ok();
    for name in names() {
        if only.as_ref().is_some_and(|only| !name.contains(only)) {
            continue;
        }
        let study = Study::read(&repository(&format!("tests/data/accuracy/{name}.toml"))).unwrap();
        let truth = &reference[&name];
        let get = |key: &str| truth[key].as_f64().unwrap();
        let n = study.problem.dimensions().len();
        let mut line = format!("{name:28}");
        for accuracy in [0.05, 0.01, 0.001] {
            let begun = std::time::Instant::now();
            let options = Options { accuracy: Some(accuracy), ..Method::Auto.into() };
            let found = analyze(&study.problem, &options).unwrap();
            let took = begun.elapsed().as_secs_f64();
            let one = &found.characteristics[0];
            let error = one.moments.map(|m| m.sigma() / get("sigma") - 1.0);
            let estimate = one.error_estimate.as_ref().and_then(|e| Some(e.sigma? / get("sigma")));
            let bound = (1.3 * (n * n + 3 * n + 1) as f64) as usize + 16;
            line += &format!(
                " | {:5}/{:5} {:+.1e} ({:.1e}){}{}{}",
                found.evaluations,
                bound,
                error.unwrap_or(f64::NAN),
                estimate.unwrap_or(f64::NAN),
                if error.is_none_or(|e| e.abs() > accuracy) { " MISS" } else { "" },
                if estimate.zip(error).is_none_or(|(s, e)| 3.0 * s < e.abs() - 1e-9) { " LIE" } else { "" },
                if took > 0.5 { format!(" {took:.1}s") } else { String::new() }
            );
        }
        println!("{line}");
    }
    let _ = (Stencil::TwoPoint, None::<Analysis>);
}
