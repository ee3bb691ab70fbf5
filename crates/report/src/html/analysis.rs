//! The page of an analysis.

use crate::Report;
use crate::document::html::{head, sections};
use crate::document::number::{plain, plural};
use crate::head::seed;
use crate::html::terms::terms;
use crate::html::verdict::{JudgedCharacteristic, Together, Words, verdict};
use crate::html::what_if::WhatIf;
use crate::html::{
    Fact, ScriptData, certainty as sure, evidence, fact, inputs, json, others, picture, provenance, render,
    what_if_section as tries,
};
use sensitol::analysis::Analysis;
use sensitol::method::Basis;
use sensitol::summary::RunSummary;

/// Writes an analysis as one page of HTML. With a [`WhatIf`], the script of the page computes results for other tolerances and means, as
/// [`Surface::at`](sensitol::analysis::Surface::at) does.
///
/// The page needs no network and loads nothing. Writing it evaluates nothing.
pub fn analyze_html(report: &Report, what_if: Option<&WhatIf>) -> String {
    let possible = what_if.filter(|what_if| what_if.possible());
    let mut document = report.brief_document();
    evidence::add(report, &mut document.sections);
    let tries = match (possible, what_if.and_then(WhatIf::impossible)) {
        (Some(what_if), _) => tries::section(what_if),
        (None, Some(why)) => tries::impossible(&why),
        (None, None) => String::new(),
    };
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
    // The summary repeats the verdict. It follows the sections if the verdict has a table, and precedes them otherwise.
    let [first, rest] = match rows.iter().any(JudgedCharacteristic::counts) {
        true => [judged, head(&document) + &sure],
        false => [judged + &head(&document), sure],
    };
    let (assembly, picture) = match picture::picture(report) {
        Some(picture) => (picture.section, Some(picture.data)),
        None => (String::new(), None),
    };
    let sections = assembly + &sections(&document) + &inputs::section(report);
    let parts = [first, sections, tries + &rest, terms("analyze", false)];
    render(&report.head, facts(report), parts, ScriptData { what_if: possible.map(json), picture })
}

/// Sentence with the method and the seed that reproduce the figures.
fn repeated(report: &Report) -> String {
    let run = &report.analysis.run;
    let spent = plural(run.evaluations as usize, "evaluation", "evaluations");
    let (method, seed) = (report.analysis.method.name(), seed(run));
    format!(
        "The analysis took {spent} by the method {method}{seed}, which give the same figures again. A simulation of a million points holds \
         them against the model itself."
    )
}

/// Formats the evaluations with the rounds in which they were sent and the failed points.
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
