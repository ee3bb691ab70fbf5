//! Reports as pages: one file each, which opens from disk without any network.
//!
//! Text from a study or an adapter is escaped on output. Drawings are made of numbers alone. Data for the page's script stand in a block
//! of JSON that contains no `<`. A content-security policy lists the parts that may run: this script and this style, by their hashes, and
//! nothing else.

mod analysis;
mod certainty;
mod chain;
mod characteristic;
mod evidence;
mod facts;
mod inputs;
mod map;
mod pages;
mod pareto;
mod part;
mod picture;
mod terms;
mod verdict;
mod what_if;
mod what_if_section;

pub use analysis::analyze_html;
pub use pages::{allocate_html, compare_html, rare_html, simulate_html, sweep_html};
pub use what_if::WhatIf;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::document::Document;
use crate::document::html::{blocks, head as summary, sections};
use crate::document::number::significant;
use crate::document::svg::escaped;
use crate::head::findings;
use crate::html::part::Part;
use crate::{DifferenceReport, Head, LotReport, WarningReport};
use sensitol::summary::RunSummary;

const STYLE: &str = include_str!("page.css");
/// Script of the what-if: first the mathematics, then the display.
const SCRIPT: &str = concat!(
    include_str!("moments.js"),
    include_str!("pearson.js"),
    include_str!("law.js"),
    include_str!("points.js"),
    include_str!("live.js"),
    include_str!("page.js")
);
/// Name of the cell with the file of the study.
const STUDY: &str = "Study";

/// Name and text of a fact about a run.
struct Fact {
    name: &'static str,
    text: String,
}

fn fact(name: &'static str, text: impl Into<String>) -> Fact {
    Fact { name, text: text.into() }
}

/// Facts at the end of every report.
fn provenance(head: &Head, run: &RunSummary) -> Vec<Fact> {
    let seconds = |time: std::time::Duration| format!("{} s", significant(time.as_secs_f64(), 3));
    let mut facts = vec![fact("known answers", run.cached.to_string())];
    if run.retried > 0 {
        facts.push(fact("sent again", run.retried.to_string()));
    }
    facts.extend(run.stopped.map(|reason| fact("stopped by", reason.to_string())));
    facts.push(fact("time", format!("{}, {} of it in the model", seconds(run.wall), seconds(run.in_model))));
    facts.extend(run.seed.map(|seed| fact("seed", seed.to_string())));
    facts.push(fact("sensitol", format!("{}, report schema {}", head.sensitol, head.schema)));
    if !head.study_sha256.is_empty() {
        facts.push(fact("SHA-256 of the study", head.study_sha256.clone()));
    }
    facts
}

/// Writes two revisions of a study as one page of HTML: changes of inputs, results and contributions.
pub(crate) fn difference_html(report: &DifferenceReport) -> String {
    let document = report.document();
    let [old, new] = &report.studies;
    let [of_old, of_new] = &report.sha256;
    let facts = vec![
        fact("was", format!("{old}, SHA-256 {of_old}")),
        fact("is", format!("{new}, SHA-256 {of_new}")),
        fact("evaluations", format!("{} and {}", report.evaluations[0], report.evaluations[1])),
        fact("sensitol", format!("{}, report schema {}", report.head.sensitol, report.head.schema)),
    ];
    let parts = [summary(&document), sections(&document), String::new(), terms::terms("analyze", false)];
    render(&report.head, facts, parts, ScriptData::default())
}

/// Writes a comparison with a lot as one page of HTML: verdicts, parts, and an overlay for every characteristic.
pub fn lot_html(report: &LotReport) -> String {
    let document = report.document();
    let mut facts = vec![fact("lot", report.lot.join(", "))];
    facts.extend(provenance(&report.head, &report.comparison.run));
    let parts = [summary(&document), sections(&document), String::new(), terms::terms("compare-lot", false)];
    render(&report.head, facts, parts, ScriptData::default())
}

/// Writes the warnings that no section shows.
fn others(document: &Document, warnings: &[WarningReport]) -> String {
    let told = |name: &str| document.sections.iter().any(|section| section.name == name);
    blocks(&findings(warnings, |name| name.is_none_or(|name| !told(name))))
}

/// Returns the cells of the title block: author, study, tool, as on a drawing.
fn block(head: &Head) -> Vec<(&str, &str)> {
    let mut cells: Vec<(&str, &str)> = head.block.iter().map(|(name, text)| (*name, text.as_str())).collect();
    if let Some(first) = head.study_sha256.get(..12) {
        cells.push(("SHA-256", first));
    }
    cells.push(("sensitol", head.sensitol));
    cells
}

/// Footer of every printed page: part, revision, hash of the study.
fn footer(head: &Head) -> String {
    let cell = |wanted: &str| head.block.iter().find(|(name, _)| *name == wanted).map(|(_, text)| text.as_str());
    let revision = cell("Revision").map(|revision| format!("revision {revision}"));
    let hash = head.study_sha256.get(..12).map(|hash| format!("study {hash}"));
    let what = cell("Part").or(head.title.as_deref()).map(str::to_owned);
    let text: Vec<String> = [what, revision, hash].into_iter().flatten().collect();
    // Every other character than letters, digits and spaces is escaped: names come from studies.
    let safe = |c: char| match c {
        c if c.is_alphanumeric() || c == ' ' => c.to_string(),
        c => format!("\\{:x} ", u32::from(c)),
    };
    let text: String = text.join(", ").chars().filter(|c| !c.is_control()).map(safe).collect();
    format!("@page {{ @bottom-left {{ content: \"{text}\"; }} }}\n")
}

/// Data of the scripts of a page, as JSON. A script without data does not run.
#[derive(Default)]
struct ScriptData {
    what_if: Option<String>,
    picture: Option<String>,
}

/// Writes the page around its parts, which are markup in order.
fn render(head: &Head, facts: Vec<Fact>, [first, sections, rest, terms]: [String; 4], data: ScriptData) -> String {
    let of_picture = if data.picture.is_some() { picture::STYLE } else { "" };
    let style = format!("{STYLE}{of_picture}{}", footer(head));
    let scripts = [("data", data.what_if, SCRIPT), ("scene", data.picture, picture::SCRIPT)];
    let scripts = scripts.into_iter().filter_map(|(id, data, script)| Some((id, data?, script)));
    let mut allowed = String::new();
    let mut markup = String::new();
    for (id, data, script) in scripts {
        allowed += &format!(" '{}'", hash(script));
        markup +=
            &format!("<script type=\"application/json\" id=\"{id}\">{data}</script>\n<script>{script}</script>\n");
    }
    let allowed = if allowed.is_empty() { allowed } else { format!(" script-src{allowed};") };
    let policy =
        format!("default-src 'none'; style-src '{}';{allowed} base-uri 'none'; form-action 'none'", hash(&style));
    let (policy, command) = (escaped(&policy), escaped(head.command));
    let study = head.block.iter().find(|(name, _)| *name == STUDY).map(|(_, text)| format!("Tolerance report: {text}"));
    let title = head.title.as_deref().or(study.as_deref()).unwrap_or("Tolerance report");
    let title = escaped(title);
    let entry = |name: &str, text: &str| format!("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(name), escaped(text));
    let block: String = block(head).into_iter().map(|(name, text)| entry(name, text)).collect();
    let facts: String = facts.iter().map(|one| entry(one.name, &one.text)).collect();
    let about = Part::new("about", "What was done", format!("<dl class=\"facts\">\n{facts}</dl>\n")).on_screen();
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="sensitol">
<title>{title} – {command}</title>
<style>{style}</style>
</head>
<body>
<header class="head">
<div><p class="brand">sensitol {command}</p>
<h1>{title}</h1></div>
<dl class="block">
{block}</dl>
</header>
<main>
{first}
{sections}
<h2 class="details">Details</h2>
{rest}
{about}
{terms}
</main>
{markup}</body>
</html>"#
    )
}

/// Paper of a print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// ISO 216, 210 mm by 297 mm.
    A4,
    /// ANSI A, 8.5 in by 11 in.
    Letter,
}

/// Returns the page with the size of its paper, for a browser that prints it. The policy of the page allows the longer style.
pub fn on_paper(page: &str, paper: Paper) -> String {
    let styled = page.split_once("<style>").and_then(|(_, rest)| rest.split_once("</style>"));
    let Some((style, _)) = styled else { return page.to_owned() };
    let size = match paper {
        Paper::A4 => "A4",
        Paper::Letter => "letter",
    };
    let sized = format!("{style}@page {{ size: {size}; }}\n");
    let page = page.replacen(&hash(style), &hash(&sized), 1);
    page.replacen(&format!("<style>{style}</style>"), &format!("<style>{sized}</style>"), 1)
}

/// Returns the hash of a script or style as a content-security policy has it.
fn hash(text: &str) -> String {
    format!("sha256-{}", base64(&Sha256::digest(text.as_bytes())))
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = group.iter().enumerate().fold(0u32, |bits, (i, &byte)| bits | u32::from(byte) << (16 - 8 * i));
        for i in 0..4 {
            let digit = char::from(DIGITS[(bits >> (18 - 6 * i)) as usize & 63]);
            text.push(if i <= group.len() { digit } else { '=' });
        }
    }
    text
}

/// JSON that is safe in a page: no character in it can end a script or begin a comment.
fn json(value: &impl Serialize) -> String {
    let text = serde_json::to_string(value).expect("reports are plain data");
    text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_standard() {
        let pairs =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")];
        for (bytes, text) in pairs {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
