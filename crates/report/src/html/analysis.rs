//! The page of an analysis.

use crate::Report;
use crate::document::Element;
use crate::document::html::{blocks, head};
use crate::document::number::{plain, plural};
use crate::head::seed;
use crate::html::characteristic::{PRINTED, screen};
use crate::html::part::Part;
use crate::html::terms::terms;
use crate::html::verdict::{JudgedCharacteristic, Together, Words, verdict};
use crate::html::what_if::WhatIf;
use crate::html::{
    Fact, ScriptData, certainty as sure, fact, inputs, json, others, picture, provenance, render,
    what_if_section as tries,
};
use sensitol::analysis::Analysis;
use sensitol::method::Basis;
use sensitol::summary::RunSummary;

/// Columns of the summary that the verdict has as well.
const OF_VERDICT: [&str; 3] = ["Cpk", "yield", "verdict"];

/// Writes an analysis as one page of HTML. With a [`WhatIf`], the script of the page computes results for other tolerances and means, as
/// [`Surface::at`](sensitol::analysis::Surface::at) does.
///
/// The page needs no network and loads nothing. Writing it evaluates nothing.
pub fn analyze_html(report: &Report, what_if: Option<&WhatIf>) -> String {
    let possible = what_if.filter(|what_if| what_if.possible());
    let mut document = report.brief_document();
    let all = &report.analysis.characteristics;
    let rows: Vec<JudgedCharacteristic<'_>> = all
        .iter()
        .enumerate()
        .map(|(place, one)| JudgedCharacteristic::analysed(place, one).warned(&report.warnings))
        .collect();
    let joint = report.analysis.joint.as_ref();
    let joint = joint.map(|of| Together::about(of.value, of.error, report.analysis.joint_requirement.as_ref()));
    let words = Words { warnings: others(&document, &report.warnings), ..Words::default() };
    let mut first = verdict(&rows, joint, &words);
    let is_judged = rows.iter().any(JudgedCharacteristic::counts);
    // The summary repeats the verdict, unless nothing is judged.
    let summary = match is_judged {
        true => {
            without_verdict(&mut document.head);
            Part::new("summary", "Summary", blocks(&document.head)).on_screen()
        }
        false => {
            first += &head(&document);
            String::new()
        }
    };
    let (assembly, picture) = match picture::picture(report) {
        Some(picture) => (picture.section, Some(picture.data)),
        None => (String::new(), None),
    };
    // A picture takes the room of a section.
    let printed = PRINTED - usize::from(picture.is_some());
    let (mut screens, mut details) = (String::new(), String::new());
    for (index, (one, section)) in all.iter().zip(std::mem::take(&mut document.sections)).enumerate() {
        let screen = screen(report, index, (one, section), index < printed);
        screens += &screen.first;
        details += &screen.details;
    }
    if let Some(left @ 1..) = all.len().checked_sub(printed) {
        let sections = plural(left, "more section is", "more sections are");
        screens += &format!("<p class=\"note print-only\">{sections} in the page itself.</p>\n");
    }
    match (possible, what_if.and_then(WhatIf::impossible)) {
        (Some(what_if), _) => screens += &tries::section(what_if),
        (None, Some(why)) => details += &tries::impossible(&why),
        (None, None) => {}
    }
    let errors: Vec<sure::Row> = all.iter().flat_map(|one| sure::analysed(one, None)).collect();
    let sure = sure::section(&errors, sure::ANALYSED, &repeated(report));
    let details = details + &inputs::section(report) + &summary + &sure;
    let parts = [first, assembly + &screens, details, terms("analyze", false)];
    render(&report.head, facts(report), parts, ScriptData { what_if: possible.map(json), picture })
}

/// Hides the columns of the summary that the verdict has: yield and Cpk stand once on a page.
fn without_verdict(head: &mut [Element]) {
    for block in head {
        if let Element::Table(table) = block {
            table.columns.iter_mut().for_each(|column| column.page &= !OF_VERDICT.contains(&column.heading));
        }
    }
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
