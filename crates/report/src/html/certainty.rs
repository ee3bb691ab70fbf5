//! Section of a page with the error of each figure.

use std::fmt::Write;

use crate::document::number::{beside, estimated, estimated_beside, percent, plain, significant, uncertainty, yielded};
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use crate::html::part::Part;
use crate::reject_rate::rejects;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol::rare::RareCharacteristic;
use sensitol::simulation::SimulatedCharacteristic;
use sensitol_numeric::sampling::{Estimate, one_error};

pub(super) struct Row {
    characteristic: String,
    figure: &'static str,
    value: String,
    error: String,
    /// Second figure: the model's own value, or an interval.
    beside: String,
}

/// Greatest number of rows that are printed: the five figures of three characteristics. More would take a page of their own.
const PRINTED_ROWS: usize = 15;

/// Headings of an analysis: value, error, second figure.
pub(super) const ANALYSED: [&str; 3] = ["value", "estimated error", "points of the model say"];
/// Headings of a simulation.
pub(super) const SAMPLED: [&str; 3] = ["value", "standard error", "95 % interval"];
/// Headings of rare events.
pub(super) const SOUGHT: [&str; 3] = ["ppm", "standard error", "points there"];
/// Headings of a sweep.
pub(super) const SWEPT: [&str; 3] = ["value", "greatest estimated error", "at"];

/// Writes the section, or nothing if there is no figure.
pub(super) fn section(rows: &[Row], titles: [&str; 3], words: &str) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let titles = titles.map(|title| format!("<th scope=\"col\" class=\"n\">{title}</th>")).concat();
    let mut text = format!(
        "<div class=\"wide\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">characteristic</th><th scope=\"col\">figure</th>{titles}</tr></thead><tbody>\n"
    );
    let mut last = None;
    for Row { characteristic, figure, value, error, beside } in rows {
        let first = match last == Some(characteristic) {
            true => "<td></td>".to_owned(),
            false => format!("<th scope=\"row\">{}</th>", escaped(characteristic)),
        };
        last = Some(characteristic);
        let cells = [value, error, beside].map(|cell| format!("<td class=\"n\">{}</td>", escaped(cell))).concat();
        let _ = writeln!(text, "<tr>{first}<td>{figure}</td>{cells}</tr>");
    }
    text += &format!("</tbody></table></div>\n<p class=\"note\">{}</p>\n", escaped(words));
    let part = Part::new("sure", "How sure is this", text);
    if rows.len() <= PRINTED_ROWS { part.folded() } else { part.on_screen() }
}

/// Rows of an analysis, beside the values by points of the model. Those of a simulation are preferred if there is one.
pub(super) fn analysed(one: &CharacteristicAnalysis, simulated: Option<&SimulatedCharacteristic>) -> Vec<Row> {
    let estimate = one.error_estimate.as_ref();
    let by_model = one.evidence.verification.as_ref();
    let figure =
        |place: usize| by_model.and_then(|found| found.figures.moments[place]).map(|found| (found.value, found.error));
    let sampled = |of: Option<Estimate>| of.and_then(|of| Some((of.value, of.standard_error?)));
    let model = match simulated {
        Some(of) => [
            sampled(of.mean),
            sampled(of.sigma),
            sampled(of.skewness),
            sampled(of.kurtosis),
            of.yield_.map(|share| (share.value, one_error(share.value, share.interval))),
        ],
        None => {
            let yield_ = by_model.and_then(|found| found.figures.yield_).map(|found| (found.value, found.error));
            [figure(0), figure(1), figure(2), figure(3), yield_]
        }
    };
    let all = [
        ("mean", one.mean(), estimate.and_then(|of| of.mean)),
        ("sigma", one.sigma(), estimate.and_then(|of| of.sigma)),
        ("skewness", one.skewness(), estimate.and_then(|of| of.skewness)),
        ("kurtosis", one.kurtosis(), estimate.and_then(|of| of.kurtosis)),
        ("yield", one.yield_(), estimate.and_then(|of| of.yield_)),
    ];
    let row = |(of, model): (Figure, Option<(f64, f64)>)| {
        let (name, value, error) = of;
        let value = value?;
        let sigma = one.sigma().filter(|_| ["mean", "sigma"].contains(&name));
        let scale = sigma.unwrap_or(1.0);
        let shown = |value: f64, error: Option<f64>| match error {
            // An error of rounding alone needs no further digits.
            Some(error) if error > 1e-6 * scale => estimated_beside(value, sigma, Some(error)),
            _ => beside(value, scale),
        };
        Some(Row {
            characteristic: one.name().to_owned(),
            figure: name,
            value: shown(value, error),
            error: error.map_or("unknown".to_owned(), |error| format!("± {}", uncertainty(error))),
            beside: model.map_or("–".to_owned(), |(value, error)| {
                format!("{} ± {}", shown(value, Some(error)), uncertainty(error))
            }),
        })
    };
    all.into_iter().zip(model).filter_map(row).collect()
}

/// The name of a figure, its value and its error.
type Figure = (&'static str, Option<f64>, Option<f64>);

pub(super) fn simulated(one: &SimulatedCharacteristic) -> Vec<Row> {
    let row = |figure, value: String, error: Option<String>, beside| Row {
        characteristic: one.name().to_owned(),
        figure,
        value,
        error: error.map_or("unknown".to_owned(), |error| format!("± {error}")),
        beside,
    };
    let moments = [("mean", one.mean), ("sigma", one.sigma), ("skewness", one.skewness), ("kurtosis", one.kurtosis)];
    let moments = moments.into_iter().filter_map(|(name, of)| {
        let Estimate { value, standard_error } = of?;
        let ends =
            standard_error.map(|error| [-2.0, 2.0].map(|by| estimated(value + by * error, standard_error)).join(" – "));
        Some(row(name, estimated(value, standard_error), standard_error.map(uncertainty), ends.unwrap_or_default()))
    });
    let yield_ = one.yield_.map(|share| {
        let interval = one.yield_interval().unwrap_or(share.interval);
        let error = one_error(share.value, interval);
        let ends = interval.map(yielded).join(" – ");
        row("yield", yielded(share.value), Some(format!("{} %", significant(100.0 * error, 2))), ends)
    });
    moments.chain(yield_).collect()
}

pub(super) fn sought(one: &RareCharacteristic) -> Vec<Row> {
    let side = |(figure, of): (&'static str, Option<&sensitol::rare::Beyond>)| {
        let of = of?;
        let error = of.probability.zip(of.standard_error);
        Some(Row {
            characteristic: one.name().to_owned(),
            figure,
            value: rejects(of, 3),
            error: error.map_or("unknown".to_owned(), |(value, error)| {
                format!("± {}, {} % of it", significant(1e6 * error, 2), percent(error / value))
            }),
            beside: of.hits.to_string(),
        })
    };
    [("rejects below", one.below.as_ref()), ("rejects above", one.above.as_ref())]
        .into_iter()
        .filter_map(side)
        .collect()
}

/// Row of a sweep: a figure at the value with its greatest error.
pub(super) fn swept(name: &str, figure: &'static str, at: &str, all: &[(f64, f64, f64)]) -> Option<Row> {
    let (place, value, error) = all.iter().copied().max_by(|a, b| a.2.total_cmp(&b.2))?;
    Some(Row {
        characteristic: name.to_owned(),
        figure,
        value: estimated(value, Some(error)),
        error: format!("± {}", uncertainty(error)),
        beside: format!("{at} = {}", plain(place)),
    })
}
