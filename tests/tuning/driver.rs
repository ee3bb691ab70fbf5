//! Runs every function on which constants may be tuned, as `measure.py` asks: one line for each run with what it took, how far it was off
//! and what it said of its errors. With the word `further` it runs what those runs do not reach: a costly model with a budget from which it
//! is sampled, a fixed stencil without verification, and more dimensions than pairs are examined one by one for. `measure.py` compiles it within a copy of the library whose constants can be scaled.

use std::path::Path;

use rayon::prelude::*;
use sensitol::assembly::{AssemblyFunction, Request, Responses, Run, Signature};
use sensitol::{Method, Options, Problem, analyze};
use sensitol_study::Study;

/// A formula as a model of which every evaluation costs something.
#[derive(Debug)]
struct Costly {
    signature: Signature,
    inner: Problem,
}

impl AssemblyFunction for Costly {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.inner.function().evaluate(request, run, out);
    }
}

fn costly(problem: &Problem) -> Problem {
    let mut signature = problem.function().signature().clone();
    (signature.costly, signature.cheap) = (true, false);
    let function = Costly { signature, inner: problem.clone() };
    Problem::new(problem.dimensions().to_vec(), function).unwrap().asking(problem.characteristics().to_vec()).unwrap()
}

/// Functions of more dimensions take most of the time and meet the same constants, but for those of screening: these are met by the others
/// with no more than `MANY`.
const MOST: usize = 20;
const MANY: usize = 60;
/// This one takes two fifths of the time of all.
const LONG: &str = "saturating-3";
/// These take half the time of the further runs.
const LONG_FURTHER: [&str; 3] = ["tied-gaps-4", "unequal-gaps-4", "position-2"];

fn main() {
    let folder = std::env::args().nth(1).expect("the folder of the functions");
    let truths: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(Path::new(&folder).join("../accuracy.json")).unwrap()).unwrap();
    let auto = |accuracy: f64| Options::from(Method::Auto).with_accuracy(accuracy);
    // Cheap models are sampled, the surface of costly ones has check points, and `auto` without either shows its own decisions.
    let first: Vec<(&str, bool, Options)> = vec![
        ("auto 1 %, sampled", false, auto(0.01)),
        ("full, check points", true, Method::Full.into()),
        ("auto 1 %, by itself", true, auto(0.01).with_verify(0)),
        ("auto 0.1 %, by itself", true, auto(0.001).with_verify(0)),
    ];
    let further: Vec<(&str, bool, Options)> = vec![
        ("auto 0.1 %, budget of 3000", true, auto(0.001).with_budget(3000).with_verify(0)),
        ("full, by itself", true, Options::from(Method::Full).with_verify(0)),
    ];
    let many: Vec<(&str, bool, Options)> = vec![("auto 1 %, by itself", true, auto(0.01).with_verify(0))];
    let is_further = std::env::args().nth(2).is_some_and(|word| word == "further");
    let each: Vec<(&String, &serde_json::Value)> = truths.as_object().unwrap().iter().collect();
    let lines = each.par_iter().flat_map_iter(|(name, truth)| {
        let study = Study::read(&Path::new(&folder).join(format!("{name}.toml"))).unwrap();
        let kinds = match study.problem.dimensions().len() {
            _ if *name == LONG => return Vec::new().into_iter(),
            _ if is_further && LONG_FURTHER.contains(&name.as_str()) => return Vec::new().into_iter(),
            0..=MOST if is_further => &further,
            0..=MOST => &first,
            0..=MANY if is_further => &many,
            _ => return Vec::new().into_iter(),
        };
        let cost = costly(&study.problem);
        let of = |(kind, is_costly, options): &(&str, bool, Options)| {
            let problem = if *is_costly { &cost } else { &study.problem };
            let found = analyze(problem, options).unwrap();
            let one = &found.characteristics[0];
            let (moments, estimate) = (one.moments.unwrap(), one.error_estimate.as_ref());
            let values = [Some(moments.mean()), Some(moments.sigma()), moments.skewness(), moments.kurtosis()];
            let errors = estimate.map_or([None; 4], |of| [of.mean, of.sigma, of.skewness, of.kurtosis]);
            let figures: Vec<serde_json::Value> = (["mean", "sigma", "skewness", "kurtosis"].iter().enumerate())
                .map(|(figure, key)| {
                    let off = values[figure].map(|value| (value - truth[*key].as_f64().unwrap()).abs());
                    serde_json::json!([values[figure], off, errors[figure]])
                })
                .collect();
            let warnings: Vec<String> = found.warnings.iter().map(|warning| warning.code().to_owned()).collect();
            let line = serde_json::json!({
                "name": name, "kind": kind, "evaluations": found.run.evaluations, "figures": figures,
                "sigma": truth["sigma"], "sampled": one.model_sampled.is_some(), "warnings": warnings,
            });
            line.to_string()
        };
        kinds.iter().map(of).collect::<Vec<String>>().into_iter()
    });
    let lines: Vec<String> = lines.collect();
    println!("{}", lines.join("\n"));
}
