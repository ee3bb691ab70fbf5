//! Pages of all commands except `analyze`. Each has the verdict, the summary, a section for each characteristic, the errors of the
//! figures, and the terms.

use crate::document::html::{head as summary, sections};
use crate::document::number::{plain, plural, significant};
use crate::document::svg::escaped;
use crate::document::{Chart, Document, Element, Flow, Section};
use crate::head::{findings, seed};
use crate::html::certainty::Row;
use crate::html::verdict::{Asked, JudgedCharacteristic, Together, Words, verdict};
use crate::html::{ScriptData, certainty as sure, others, provenance, render, terms};
use crate::sweep::SweptReport;
use crate::{AllocationReport, CompareReport, Head, RareReport, SimulationReport, SweepReport, WarningReport};
use sensitol::summary::RunSummary;
use sensitol_numeric::json_form::finite;
use sensitol_numeric::sampling::one_error;
use sensitol_numeric::verdict::Verdict;

/// Greatest number of values of a sweep that are listed one by one.
const NAMED: usize = 6;

/// Parts of a page as markup.
struct Parts {
    verdict: String,
    sure: String,
    terms: String,
}

fn page(head: &Head, run: &RunSummary, document: &Document, parts: Parts) -> String {
    let markup = [parts.verdict + &summary(document), sections(document), parts.sure, parts.terms];
    render(head, provenance(head, run), markup, ScriptData::default())
}

/// Returns words with the warnings that belong to no section.
fn words(document: &Document, warnings: &[WarningReport]) -> Words {
    Words { warnings: others(document, warnings), ..Words::default() }
}

/// Writes a simulation as one page of HTML: every estimate with its standard error, the histogram with the error of every bar.
pub fn simulate_html(report: &SimulationReport) -> String {
    let (document, simulation) = (report.document(), &report.simulation);
    let all = simulation.characteristics.iter().enumerate();
    let rows: Vec<JudgedCharacteristic<'_>> =
        all.map(|(place, one)| JudgedCharacteristic::simulated(place, one).warned(&report.warnings)).collect();
    let judged = simulation.joint_requirement.as_ref();
    let joint = simulation.joint.as_ref().map(|share| Together::within(share, judged));
    let errors: Vec<Row> = simulation.characteristics.iter().flat_map(sure::simulated).collect();
    let said = format!(
        "{} points of the model by {}{} give the same figures again. Four times as many points halve the standard errors of random points.",
        simulation.samples,
        simulation.sampler.method(),
        seed(&simulation.run)
    );
    let parts = Parts {
        verdict: verdict(&rows, joint, &words(&document, &report.warnings)),
        sure: sure::section(&errors, sure::SAMPLED, &said),
        terms: terms::terms("simulate", false),
    };
    page(&report.head, &simulation.run, &document, parts)
}

/// Writes rare events as one page of HTML: every probability with its interval and its design point.
pub fn rare_html(report: &RareReport) -> String {
    let (mut document, found) = (report.document(), &report.found);
    warn(&mut document.sections, &report.warnings);
    let all = found.characteristics.iter().enumerate();
    let rows: Vec<JudgedCharacteristic<'_>> =
        all.map(|(place, one)| JudgedCharacteristic::rare(place, one).warned(&report.warnings)).collect();
    let joint = found.joint.zip(found.joint_interval);
    let joint =
        joint.map(|(value, ends)| Together::about(value, one_error(value, ends), found.joint_requirement.as_ref()));
    let errors: Vec<Row> = found.characteristics.iter().flat_map(sure::sought).collect();
    let said = format!(
        "{} points of the model, drawn where a surrogate of {} expects rejects{}, give the same figures again. An estimate rests on the points that lie \
         beyond its limit.",
        found.samples,
        plural(found.surrogate_evaluations as usize, "evaluation", "evaluations"),
        seed(&found.run)
    );
    let parts = Parts {
        verdict: verdict(&rows, joint, &words(&document, &report.warnings)),
        sure: sure::section(&errors, sure::SOUGHT, &said),
        terms: terms::terms("simulate", true),
    };
    page(&report.head, &found.run, &document, parts)
}

/// Puts the warnings of each characteristic first in its section.
fn warn(sections: &mut [Section], warnings: &[WarningReport]) {
    for section in sections {
        let found = findings(warnings, |name| name == Some(section.name.as_str()));
        section.blocks.splice(0..0, found);
    }
}

/// Writes a comparison as one page of HTML: error over evaluations, and a table for every characteristic.
pub fn compare_html(report: &CompareReport) -> String {
    let document = report.document();
    let all = report.characteristics.iter().enumerate();
    let rows: Vec<JudgedCharacteristic<'_>> =
        all.map(|(place, one)| JudgedCharacteristic::simulated(place, &one.reference)).collect();
    let errors: Vec<Row> = report.characteristics.iter().flat_map(|one| sure::simulated(&one.reference)).collect();
    let said = format!(
        "The errors of the reference, {} points by {}{}. A method that is off by less than two of them cannot be told from an exact one.",
        report.reference_samples,
        report.reference_method,
        seed(&report.run)
    );
    let cheapest = report.characteristics.iter().filter_map(|one| {
        // The methods are sorted by evaluations.
        let enough = one.methods.iter().find(|method| !method.error_vs_reference.resolved);
        let least = |a: &&crate::compare::MethodReport, b: &&crate::compare::MethodReport| {
            let error = |of: &crate::compare::MethodReport| of.error_vs_reference.overall.unwrap_or(f64::INFINITY);
            error(a).total_cmp(&error(b))
        };
        let (method, word) = match enough {
            Some(method) => (method, "is as good as the reference tells"),
            None => (one.methods.iter().min_by(least)?, "is nearest to the reference"),
        };
        let points = plural(method.evaluations as usize, "evaluation", "evaluations");
        Some(format!("<em>{}</em>: {} with {points} {word}.", escaped(&one.name), escaped(&method.method)))
    });
    let words =
        Words { before: cheapest.collect::<Vec<_>>().join(" "), gauge: " All by the reference.", ..Words::default() };
    let parts = Parts {
        verdict: verdict(&rows, None, &words),
        sure: sure::section(&errors, sure::SAMPLED, &said),
        terms: terms::terms("compare", false),
    };
    page(&report.head, &report.run, &document, parts)
}

/// Writes a sweep as one page of HTML: mean and band over the parameter, and a table for every characteristic.
pub fn sweep_html(report: &SweepReport) -> String {
    let (document, parameter) = (report.document(), report.parameter.name.as_str());
    let all = report.characteristics.iter().enumerate();
    let rows: Vec<JudgedCharacteristic<'_>> = all
        .filter_map(|(place, one)| Some(JudgedCharacteristic::swept(place, one, parameter)?.warned(&report.warnings)))
        .collect();
    let along: Vec<String> = report.characteristics.iter().filter_map(|one| along(one, parameter)).collect();
    let words = Words {
        after: along.join(" "),
        gauge: " Each row is the value at which the characteristic is worst.",
        ..words(&document, &report.warnings)
    };
    type Of = fn(&crate::sweep::SweptPointReport) -> Option<(f64, f64)>;
    let figures: [(&str, Of); 3] = [
        ("mean", |point| Some((point.mean?, point.error_estimate.as_ref()?.mean?))),
        ("sigma", |point| Some((point.sigma?, point.error_estimate.as_ref()?.sigma?))),
        ("yield", |point| Some((point.yield_?, point.error_estimate.as_ref()?.yield_?))),
    ];
    let errors: Vec<Row> = (report.characteristics.iter())
        .flat_map(|one| {
            figures.iter().filter_map(|(figure, of)| {
                let known =
                    one.points.iter().filter_map(|point| of(point).map(|(value, error)| (point.at, value, error)));
                sure::swept(&one.name, figure, parameter, &known.collect::<Vec<_>>())
            })
        })
        .collect();
    let said = "Estimated errors of the analyses, the greatest along the sweep.";
    let parts = Parts {
        verdict: verdict(&rows, None, &words),
        sure: sure::section(&errors, sure::SWEPT, said),
        terms: terms::terms("sweep", false),
    };
    page(&report.head, &report.run, &document, parts)
}

/// Sentence with the values at which the target is met and missed, or None if there are no verdicts.
fn along(one: &SweptReport, parameter: &str) -> Option<String> {
    let total = one.points.len();
    let of = |wanted: Verdict, word: &str| {
        let place = |point: &crate::sweep::SweptPointReport| point.verdict == Some(wanted);
        let held: Vec<(usize, f64)> =
            one.points.iter().enumerate().filter(|(_, point)| place(point)).map(|(i, point)| (i, point.at)).collect();
        let (first, last) = (held.first()?, held.last()?);
        let values = match held.len() {
            count if count == total => return Some(format!("{word} at all of them")),
            1 => plain(first.1),
            count if last.0 - first.0 + 1 == count => format!("{} to {}", plain(first.1), plain(last.1)),
            count if count <= NAMED => held.iter().map(|(_, at)| plain(*at)).collect::<Vec<_>>().join(", "),
            _ => format!("between {} and {}", plain(first.1), plain(last.1)),
        };
        Some(format!("{word} at {} ({values})", held.len()))
    };
    let parts: Vec<String> = [
        of(Verdict::Met, "met"),
        of(Verdict::Inconclusive, "neither shown to be met nor missed"),
        of(Verdict::Missed, "missed"),
    ]
    .into_iter()
    .flatten()
    .collect();
    let (name, parameter) = (escaped(&one.name), escaped(parameter));
    (!parts.is_empty()).then(|| {
        let values = plural(total, "value", "values");
        format!("Of {values} of {parameter} the target of {name} is {}.", parts.join(", "))
    })
}

/// Writes an allocation as one page of HTML: the saving first, then tolerances, costs and requirements before and after.
pub fn allocate_html(report: &AllocationReport) -> String {
    let mut document = report.document();
    document.sections.iter_mut().for_each(headed);
    let found = report.cost_after.is_some() || report.characteristics.iter().any(|one| one.after.is_some());
    let rows: Vec<JudgedCharacteristic<'_>> = (report.characteristics.iter())
        .map(|one| {
            let now = one.after.as_ref().unwrap_or(&one.before);
            let mut row = JudgedCharacteristic::analysed(0, now).nowhere();
            row.before = one.after.as_ref().and(crate::figures::Figures::yield_(&one.before));
            // The requirements of the allocation replace those of the study, which may differ.
            let kept: Vec<_> = report.requirements.iter().filter(|kept| kept.characteristic == one.name).collect();
            if !kept.is_empty() {
                (row.target, row.verdict) = (None, None);
                row.asked.clear();
            }
            for kept in kept {
                let judged = kept.of.after.as_ref().unwrap_or(&kept.of.before);
                match kept.of.requirement.target_yield() {
                    Some(least) => (row.target, row.verdict) = (Some(least), Some(judged.verdict)),
                    None => row.asked.extend(Asked::of(kept.of.requirement, judged)),
                }
            }
            row
        })
        .collect();
    let joint = report.joint_yield.after.as_ref().or(report.joint_yield.before.as_ref());
    let judged = report.joint_requirement.as_ref().map(|one| one.after.as_ref().unwrap_or(&one.before));
    let joint = joint.and_then(|joint| Some(Together::about(joint.value, joint.standard_error?, judged)));
    let words = Words {
        before: if found {
            String::new()
        } else {
            "No tolerances were found: what follows is of those before.".to_owned()
        },
        after: cause(report).unwrap_or_default(),
        gauge: " Diamond: the yield before.",
        ..words(&document, &report.warnings)
    };
    let errors: Vec<Row> = (report.characteristics.iter())
        .flat_map(|one| {
            let sampled = report.confirmation.as_ref().filter(|_| one.after.is_some());
            let sampled = sampled
                .and_then(|of| of.characteristics.iter().find(|sampled| sampled.characteristic.name() == one.name));
            sure::analysed(one.after.as_ref().unwrap_or(&one.before), sampled)
        })
        .collect();
    let confirmed = match &report.confirmation {
        Some(of) => format!(" {} points of the model at the tolerances found confirm them.", of.samples),
        None => String::new(),
    };
    let said = format!("Of an analysis by the method {} at the tolerances found.{confirmed}", report.method.name());
    let parts = Parts {
        verdict: verdict(&rows, joint, &words),
        sure: sure::section(&errors, sure::ANALYSED, &said),
        terms: terms::terms("allocate", false),
    };
    page(&report.head, &report.run, &document, parts)
}

/// Adds a heading to a section of the page.
fn headed(section: &mut Section) {
    let title = section.blocks.iter().find_map(|block| match block {
        Element::Table(table) if table.view.is_empty() => None,
        Element::Table(table) => Some(match table.name {
            "tolerances" => "Tolerances",
            "requirements" => "What is required",
            "front" => "Margin and confirmation",
            _ => "Before and after",
        }),
        Element::Chart(Chart::Plot(_)) => Some("Cost against what is required"),
        Element::Paragraph(one) if one.flow == Flow::Verbatim => Some("For the study"),
        _ => None,
    });
    let heading = title.map(|title| Element::Markup(format!("<h3>{title}</h3>\n")));
    section.blocks.splice(0..0, heading);
}

/// Sentence on the change of the cost.
fn cause(report: &AllocationReport) -> Option<String> {
    let [before, after] = [report.cost_before.and_then(finite)?, report.cost_after.and_then(finite)?];
    let part = 100.0 * (1.0 - after / before);
    let word = if part < 0.0 { "more" } else { "less" };
    let [costs, cost] = [after, before].map(|cost| significant(cost, 5));
    Some(format!("The tolerances cost {costs}, {} % {word} than the {cost} before.", significant(part.abs(), 3)))
}
