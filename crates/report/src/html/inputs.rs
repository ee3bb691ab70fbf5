//! Table of the dimensions, with their slopes and shares in every characteristic side by side.

use std::fmt::Write;

use crate::analysis::statistics::part;
use crate::document::number::{UNKNOWN, known, percent, percent_within, plain, plural, significant};
use crate::document::svg::escaped;
use crate::figures::Named;
use crate::html::pareto::slope;
use crate::html::part::Part;
use crate::{DimensionReport, Report};
use sensitol::analysis::{CharacteristicAnalysis, Sensitivity};

/// Dimensions that are shown; the others are folded.
const ROWS: usize = 12;
/// Greatest number of characteristics side by side.
const SIDE: usize = 6;
/// Greatest number of characteristics whose slopes fit on paper.
const SLOPES: usize = 2;
/// Titles of the columns of a dimension itself; true if right-aligned.
const OWN: [(&str, bool); 7] = [
    ("dimension", false),
    ("unit", false),
    ("nominal", true),
    ("tolerance", true),
    ("distribution", false),
    ("mean", true),
    ("sigma", true),
];

/// Writes the section of the dimensions.
pub(super) fn section(report: &Report) -> String {
    let all = &report.analysis.characteristics;
    let shares: Vec<Option<f64>> = (0..report.dimensions.len()).map(|d| greatest(all, d)).collect();
    let mut rows: Vec<usize> = (0..shares.len()).collect();
    rows.sort_by(|&a, &b| shares[b].unwrap_or(-1.0).total_cmp(&shares[a].unwrap_or(-1.0)));
    let mut rest = rows.split_off(rows.len().min(ROWS));
    let least = rest.first().and_then(|&d| shares[d]).filter(|share| *share > 0.0);
    // Within both parts the order of the study, which the reader knows from drawings.
    rows.sort_unstable();
    rest.sort_unstable();
    let (first, others) = all.split_at(all.len().min(SIDE));
    let table = Table { report, slopes: all.len() <= SLOPES };
    let mut text = table.of(&rows, 0, first, true);
    if !rest.is_empty() {
        let most = least.map(|share| format!(", at most {} % of a variance each", percent(share))).unwrap_or_default();
        let more = plural(rest.len(), "more dimension", "more dimensions");
        text += &folded(&format!("{more}{most}"), &table.of(&rest, 0, first, true));
    }
    if !others.is_empty() {
        rows.append(&mut rest);
        let beside = others.chunks(SIDE).enumerate();
        let tables: String = beside.map(|(i, some)| table.of(&rows, SIDE * (i + 1), some, false)).collect();
        let more = plural(others.len(), "more characteristic", "more characteristics");
        text += &folded(&format!("Shares in {more}"), &tables);
    }
    let exact = all.iter().flat_map(|one| &one.sensitivities).all(|row| row.exact || row.first.is_none());
    let marked = if exact || !table.slopes { "" } else { " ≈ marks differences." };
    let slopes = if table.slopes { "Slope: at the means, per unit of the dimension. " } else { "" };
    let _ =
        writeln!(text, "<p class=\"note\">{slopes}Share: of the variance, in %, by the dimension alone.{marked}</p>");
    Part::new("dimensions", "Dimensions", text).folded()
}

fn folded(title: &str, inner: &str) -> String {
    format!("<details class=\"fold on-screen\"><summary>{title}</summary>\n{inner}</details>\n")
}

/// Returns the greatest share of a dimension in any characteristic, or None if all are unknown.
fn greatest(all: &[CharacteristicAnalysis], d: usize) -> Option<f64> {
    all.iter().filter_map(|one| part(&one.sensitivities[d])).reduce(f64::max)
}

struct Table<'r> {
    report: &'r Report,
    slopes: bool,
}

impl Table<'_> {
    /// Writes rows of these dimensions with columns of these characteristics. `from` is the index of the first one in the report.
    fn of(&self, rows: &[usize], from: usize, characteristics: &[CharacteristicAnalysis], own: bool) -> String {
        let own = if own { &OWN[..] } else { &OWN[..1] };
        let class = |right: bool| if right { " class=\"n\"" } else { "" };
        let title =
            |&(name, right): &(&str, bool)| format!("<th scope=\"col\" rowspan=\"2\"{}>{name}</th>", class(right));
        let span = if self.slopes { " colspan=\"2\"" } else { "" };
        let name = |one: &CharacteristicAnalysis| {
            let unit = one.unit().map(|unit| format!(" <small>{}</small>", escaped(unit))).unwrap_or_default();
            format!("<th scope=\"colgroup\"{span} class=\"n\">{}{unit}</th>", escaped(one.name()))
        };
        let below = if self.slopes {
            "<th scope=\"col\" class=\"n\">slope</th><th scope=\"col\" class=\"n\">share</th>"
        } else {
            "<th scope=\"col\" class=\"n\">share</th>"
        };
        let mut text = format!(
            "<div class=\"wide\" tabindex=\"0\"><table class=\"inputs\"><thead><tr>{}{}</tr><tr>{}</tr></thead><tbody>\n",
            own.iter().map(title).collect::<String>(),
            characteristics.iter().map(name).collect::<String>(),
            below.repeat(characteristics.len())
        );
        for &d in rows {
            let of = &self.report.dimensions[d];
            let _ = write!(text, "<tr><th scope=\"row\">{}</th>", escaped(&of.name));
            if own.len() > 1 {
                text += &inputs(of);
            }
            let all = &self.report.analysis.characteristics[from..from + characteristics.len()];
            text.extend(all.iter().map(|one| self.effect(&one.sensitivities[d])));
            text += "</tr>\n";
        }
        text + "</tbody></table></div>\n"
    }

    /// Writes slope and share of a dimension in a characteristic.
    fn effect(&self, row: &Sensitivity) -> String {
        let about = if row.exact || row.first.is_none() { "" } else { " ≈" };
        let slope = if self.slopes { format!("<td class=\"n\">{}{about}</td>", slope(row, 5)) } else { String::new() };
        let error = row.first_order.and_then(|index| index.error);
        let share = part(row);
        let bar = share.map(|share| (100.0 * share).clamp(0.0, 100.0)).filter(|width| *width >= 1.0).map_or(String::new(), |width| {
            format!("<svg class=\"mini\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\"><rect class=\"linear\" width=\"{width:.0}\" height=\"10\"/></svg>")
        });
        format!("{slope}<td class=\"n\">{bar}{}</td>", known(share, |share| percent_within(share, error).0))
    }
}

/// Writes the cells of a dimension itself.
fn inputs(of: &DimensionReport) -> String {
    let unit = escaped(of.unit.as_deref().unwrap_or_default());
    let sigma = if of.sigma > 0.0 { significant(of.sigma, 3) } else { "0".to_owned() };
    let tolerance = if of.tolerance.is_none() { UNKNOWN.to_owned() } else { of.tolerance() };
    format!(
        "<td>{unit}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{sigma}</td>",
        plain(of.nominal),
        escaped(&tolerance),
        of.distribution.unwrap_or_default(),
        plain(of.mean)
    )
}
