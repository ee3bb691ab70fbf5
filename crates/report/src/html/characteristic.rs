//! Section of a characteristic on the page of an analysis: density, facts, contributions and chain first, everything else folded.

use crate::Report;
use crate::analysis::analysis_document::{CharacteristicSections, SHARES};
use crate::analysis::statistics::is_of_statistics;
use crate::analysis::yield_source::{distribution_free, stand_in};
use crate::document::html::{blocks, table};
use crate::document::svg::escaped;
use crate::document::{Aside, Chart, DataTable, Element, Flow, List, Paragraph, Section};
use crate::html::facts::facts;
use crate::html::part::Part;
use crate::html::{chain, evidence, map, pareto};
use sensitol::analysis::CharacteristicAnalysis;

/// Columns that the table of all dimensions has as well.
const OF_INPUTS: [&str; 3] = ["nominal", "tolerance", "unit"];
/// Greatest number of characteristics whose details are printed. Paper of more would have more than five pages.
const DETAILED: usize = 1;
/// Greatest number of characteristics that are printed with density and contributions. The verdict has all of them.
pub(super) const PRINTED: usize = 3;

/// Section of a characteristic in two parts.
pub(super) struct CharacteristicScreen {
    /// Density, facts, contributions, chain.
    pub(super) first: String,
    /// Everything else, folded.
    pub(super) details: String,
}

/// Blocks of a section, by their place on the page.
#[derive(Default)]
struct Sorted {
    findings: Vec<Element>,
    figure: Option<Element>,
    asides: Vec<Element>,
    tables: String,
    derivatives: String,
    notes: Vec<String>,
}

/// Writes the section with this index. Paper leaves out its first part unless `is_printed`.
pub(super) fn screen(
    report: &Report,
    index: usize,
    (one, section): (&CharacteristicAnalysis, Section),
    is_printed: bool,
) -> CharacteristicScreen {
    let unit = section.unit.as_deref().map(|unit| format!(" <small>[{}]</small>", escaped(unit))).unwrap_or_default();
    let name = escaped(&section.name);
    let remark = match section.words.trim_start_matches([',', ':', ' ']) {
        "" => String::new(),
        remark => format!("<p class=\"note\">{}</p>\n", escaped(remark)),
    };
    let free = one.distribution.distribution_free_yield.as_ref();
    let free = free.map(|of| {
        format!("<p class=\"note\">yield {}; {}</p>\n", escaped(&distribution_free(of)), escaped(&stand_in(of)))
    });
    let remark = remark + &free.unwrap_or_default();
    let sorted = Sorted::of(one, section.blocks);
    let findings = blocks(&sorted.findings).replacen("<ul", &format!("<ul id=\"warned-{index}\""), 1);
    let figures = facts(one);
    let figure = match &sorted.figure {
        Some(figure) => {
            let figure = blocks(std::slice::from_ref(figure));
            format!("<div class=\"beside\">\n<div>{figure}{findings}</div>\n{figures}</div>\n")
        }
        None => figures + &findings,
    };
    let pareto = headed(SHARES, pareto::pareto(report, one));
    let chain = headed("Dimension chain", chain::chain(one, &report.dimensions));
    let paper = if is_printed { "" } else { " on-screen" };
    let first = format!(
        "<section id=\"kc-{index}\" class=\"kc{paper}\" aria-labelledby=\"kc-title-{index}\">\n<h2 id=\"kc-title-{index}\">{name}{unit}</h2>\n\
         {remark}{figure}{pareto}{chain}</section>\n"
    );
    let body = sorted.details(report, one);
    let part = Part::new(format!("kc-details-{index}"), format!("{name}: tails, ranges, quantiles, slopes"), body);
    let is_detailed = report.analysis.characteristics.len() <= DETAILED;
    CharacteristicScreen { first, details: if is_detailed { part.folded() } else { part.on_screen() } }
}

/// Writes markup below a heading, or nothing if there is none.
fn headed(title: &str, markup: Option<String>) -> String {
    markup.map(|markup| format!("<h3>{title}</h3>\n{markup}")).unwrap_or_default()
}

impl Sorted {
    fn of(one: &CharacteristicAnalysis, all: Vec<Element>) -> Self {
        let mut sorted = Self::default();
        // The verdict has yield and indices.
        let verdict = [Some(one.yield_line()), one.index_line()];
        let is_in_verdict = |text: &str| verdict.iter().flatten().any(|line| text.starts_with(line.as_str()));
        all.into_iter().for_each(|block| sorted.add(block, &is_in_verdict));
        sorted
    }

    fn add(&mut self, block: Element, is_in_verdict: &dyn Fn(&str) -> bool) {
        match block {
            Element::Finding(_) => self.findings.push(block),
            Element::Chart(Chart::Spread(_)) if self.figure.is_none() => self.figure = Some(block),
            // The contributions are on the first screen.
            Element::Aside(Aside { title: SHARES, blocks }) => {
                blocks.into_iter().for_each(|block| self.add(block, is_in_verdict));
            }
            Element::Aside(Aside { title: "", blocks }) | Element::Detail(blocks) => {
                blocks.into_iter().for_each(|block| self.add(block, is_in_verdict));
            }
            Element::Aside(_) | Element::Chart(_) | Element::Markup(_) => self.asides.push(block),
            Element::Table(of) => self.add_table(of),
            Element::Paragraph(Paragraph { flow: Flow::Verbatim, .. }) => self.asides.push(block),
            Element::Paragraph(Paragraph { line, .. }) => {
                let text = line.text();
                if !is_in_verdict(&text) {
                    self.notes.push(text);
                }
            }
            Element::List(List { title, words }) => {
                self.notes.push(format!("{}: {}", title.trim().trim_end_matches(':'), words.join(" ")));
            }
            Element::Gap | Element::Brief(_) => {}
        }
    }

    fn add_table(&mut self, mut of: DataTable) {
        // The facts beside the density replace the table of statistics.
        if is_of_statistics(&of) {
            return;
        }
        if of.name == "sensitivities" {
            of.columns.iter_mut().for_each(|column| column.page &= !OF_INPUTS.contains(&column.heading));
            self.derivatives += &table(&of);
        } else {
            self.tables += &table(&of);
        }
    }

    /// Writes everything that is not on the first screen.
    fn details(&self, report: &Report, one: &CharacteristicAnalysis) -> String {
        let derivatives = Some(self.derivatives.clone()).filter(|markup| !markup.is_empty());
        let tables = Some(self.tables.clone()).filter(|markup| !markup.is_empty());
        let note = |text: &String| format!("<li>{}</li>\n", escaped(text.trim()));
        let notes: String = self.notes.iter().map(note).collect();
        let notes = Some(format!("<ul class=\"notes\">\n{notes}</ul>\n")).filter(|_| !self.notes.is_empty());
        [
            headed("Tails", evidence::tails(one)),
            blocks(&self.asides),
            headed("From the nominal value to the mean", evidence::shifts(one, &report.dimensions)),
            headed("Interactions", map::map(one)),
            headed("Quantiles and other tables", tables),
            headed("Slopes, curvatures and shifts of the mean", derivatives),
            headed("Notes", notes),
        ]
        .concat()
    }
}
