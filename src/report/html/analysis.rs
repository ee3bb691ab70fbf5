//! The page of an analysis.

use serde::Serialize;

use super::super::Report;
use super::super::head::seed;
use super::terms::terms;
use super::verdict::{JudgedCharacteristic, Together, Words, verdict};
use super::what_if::WhatIf;
use super::{Fact, evidence, fact, inputs, json, others, provenance, render, sure};
use crate::analysis::Analysis;
use crate::document::html::{head, sections};
use crate::document::number::{plain, plural, significant};
use crate::method::Basis;
use crate::summary::RunSummary;

#[derive(Serialize)]
struct Analysed<'r> {
    what_if: Option<Tries<'r>>,
    /// Why there is nothing to try.
    no_what_if: Option<String>,
}

/// The dimensions and characteristics that can be tried.
#[derive(Serialize)]
struct Tries<'r> {
    dimensions: Vec<Try<'r>>,
    characteristics: Vec<(&'r str, &'r str, Option<&'r str>)>,
    written: bool,
    cost: Option<String>,
}

#[derive(Serialize)]
struct Try<'r> {
    name: &'r str,
    unit: &'r str,
    nominal: String,
    half: f64,
    band: bool,
    fixed: Option<&'static str>,
}

/// An analysis as one page of HTML. With a [`WhatIf`] the page computes the results of other tolerances and means by itself, as
/// [`Surface::at`](crate::analysis::Surface::at) does.
///
/// The page needs no network and loads nothing. No evaluation.
pub fn analyze_html(report: &Report, what_if: Option<&WhatIf>) -> String {
    let possible = what_if.filter(|what_if| what_if.possible());
    let mut document = report.brief_document();
    evidence::add(report, &mut document.sections);
    let analysed = Analysed { what_if: possible.map(tries), no_what_if: what_if.and_then(WhatIf::impossible) };
    let all = &report.analysis.characteristics;
    let rows: Vec<JudgedCharacteristic<'_>> = all
        .iter()
        .enumerate()
        .map(|(place, one)| JudgedCharacteristic::analysed(place, one).warned(&report.warnings))
        .collect();
    let joint = report.analysis.joint.as_ref();
    let joint = joint.map(|of| Together::about(of.value, of.error, report.analysis.joint_requirement.as_ref()));
    let words = Words { warnings: others(&document, &report.warnings), ..Words::default() };
    let errors: Vec<sure::Row> = all.iter().flat_map(|one| sure::analysed(one, None)).collect();
    let sure = sure::section(&errors, sure::ANALYSED, &repeated(report));
    let judged = verdict(&rows, joint, &words);
    // The verdict's own words are not repeated before the figures.
    let [first, rest] = match rows.iter().any(JudgedCharacteristic::counts) {
        true => [judged, head(&document) + &sure],
        false => [judged + &head(&document), sure],
    };
    let parts = [first, sections(&document) + &inputs::section(report), rest, terms("analyze", false)];
    render("what_if.html", &report.head, facts(report), parts, possible.map(json), analysed)
}

/// The method and the seed that give the same figures again.
fn repeated(report: &Report) -> String {
    let run = &report.analysis.run;
    let spent = plural(run.evaluations as usize, "evaluation", "evaluations");
    let (method, seed) = (report.analysis.method.name(), seed(run));
    format!(
        "The analysis took {spent} by the method {method}{seed}, which give the same figures again. A simulation of a million points holds \
         them against the model itself."
    )
}

/// How many there were, and how often the next ones waited for the last.
fn evaluations(run: &RunSummary) -> String {
    let rounds = plural(run.stages as usize, "round", "rounds");
    format!("{} in {rounds}, {} of them failed", run.evaluations, run.failed)
}

fn facts(report: &Report) -> Vec<Fact> {
    let Analysis { method, account, varying, run, basis, .. } = &report.analysis;
    let procedure = method.procedure();
    let method = format!("{method}: {}; evaluations: {}", procedure.about(), procedure.count());
    let mut facts = vec![fact("method", method)];
    facts.extend(account.as_ref().map(|account| fact("what its points went to", account.to_string())));
    facts.push(fact("varying dimensions", varying.to_string()));
    facts.push(fact("evaluations", evaluations(run)));
    let derivatives = match basis {
        Basis::Exact => "exact",
        Basis::Differences => "differences",
        Basis::LeastSquares | Basis::Quadrature => "none: the moments rest on values or on a fitted surface",
    };
    facts.push(fact("derivatives", derivatives));
    let pairs = report.correlation.iter();
    let pairs: Vec<String> =
        pairs.map(|pair| format!("{} and {}: {}", pair.between[0], pair.between[1], plain(pair.value))).collect();
    if !pairs.is_empty() {
        facts.push(fact("correlations", pairs.join("; ")));
    }
    facts.extend(provenance(&report.head, run));
    facts
}

fn tries(what_if: &WhatIf) -> Tries<'_> {
    let dimensions = what_if.dimensions().iter().map(|one| Try {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        nominal: plain(one.nominal),
        half: one.half,
        band: one.band.is_some(),
        fixed: one.fixed,
    });
    let characteristics = what_if.characteristics().iter();
    Tries {
        dimensions: dimensions.collect(),
        characteristics: characteristics
            .map(|one| (one.name.as_str(), one.unit.as_deref().unwrap_or_default(), one.why.as_deref()))
            .collect(),
        written: what_if.written(),
        cost: what_if
            .paid()
            .map(|paid| paid.map_or("no process holds these tolerances".to_owned(), |paid| significant(paid, 6))),
    }
}
