//! Contributions to the variance of a characteristic as bars, with their running sum and the unexplained part.

use std::fmt::Write;

use crate::analysis::statistics::CharacteristicStatistics;
use crate::analysis::statistics::derivative;
use crate::document::number::{NEWS, UNKNOWN, percent, percent_within, short, within};
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use crate::{DimensionReport, Report};
use sensitol::analysis::{CharacteristicAnalysis, EstimatedShare, Sensitivity};

/// Greatest number of rows of a diagram. Of more rows, those with shares below `SMALL` are folded into one.
const ROWS: usize = 12;
/// Share of the variance below which a row of a long diagram is folded.
const SMALL: f64 = 5e-3;
/// Greatest number of rows of a diagram, even if more have large shares.
const MOST: usize = 24;
/// Greatest number of dimensions without influence that are listed by name.
const NAMED: usize = 24;
/// Height of a row's drawing, in units of its view box. The running sum continues from row to row.
const TALL: u32 = 32;
/// Top and height of the bar within a row.
const BAR: [u32; 2] = [9, 14];
/// Distance between the lines of a hatched bar, in percent of the variance.
const HATCH: f64 = 0.8;

/// Contribution as a part of the variance.
struct Share {
    name: String,
    /// From a surface: slope, curvature, interaction. From the model: the dimension alone, its interactions, and 0.
    parts: [f64; 3],
    /// Sum of the contribution.
    value: f64,
    error: Option<f64>,
    /// Contribution with every interaction, if points of the model give it.
    total: Option<EstimatedShare>,
    /// True if the dimension varies independently of all others. Otherwise its share has no sigma of its own.
    alone: bool,
    /// Slope times half the tolerance.
    reach: Option<String>,
}

/// Draws the contributions to the variance, strongest first. Returns None if all are unknown.
pub(super) fn pareto(report: &Report, one: &CharacteristicAnalysis) -> Option<String> {
    let of_model = one.is_of_model();
    let mut all = if of_model { of_points(one, &report.dimensions) } else { of_surface(one, &report.dimensions) };
    let idle: Vec<String> = (one.sensitivities.iter())
        .filter(|row| all.iter().any(|share| share.name == row.dimension && none(share)))
        .map(|row| short(&row.dimension))
        .collect();
    all.retain(|share| !none(share));
    if all.is_empty() {
        return None;
    }
    all.sort_by(|a, b| b.parts.iter().sum::<f64>().total_cmp(&a.parts.iter().sum()));
    if !of_model {
        fold(&mut all);
    }
    all.truncate(MOST + 1);
    let open = unresolved(one).filter(|_| !of_model);
    let mut diagram = Diagram::new(one);
    all.iter().for_each(|share| diagram.add(share));
    if let Some(open) = &open {
        diagram.add_open(open);
    }
    let mut text = diagram.text;
    text += "</tbody></table>\n";
    let keys: &[[&str; 2]] = match of_model {
        true => &[["linear", "by itself"], ["interaction", "with others"]],
        false => {
            &[["linear", "linear"], ["curvature", "curvature"], ["interaction", "interaction"], ["step", "cumulative"]]
        }
    };
    let key = |[fill, name]: &[&str; 2]| format!("<li class=\"key {fill}\">{name}</li>");
    let _ = writeln!(text, "<ul class=\"legend\">{}</ul>", keys.iter().map(key).collect::<String>());
    notes(&mut text, (of_model, open.as_ref()), &all, &idle);
    Some(text)
}

/// The table of contributions, row by row.
struct Diagram {
    text: String,
    of_model: bool,
    /// Sigma of the characteristic with its error.
    sigma: Option<(f64, Option<f64>)>,
    /// The running sum after the last row.
    before: Sum,
}

impl Diagram {
    /// A table without rows.
    fn new(one: &CharacteristicAnalysis) -> Self {
        let of_model = one.is_of_model();
        let sigma = one.sigma().map(|sigma| (sigma, one.error_estimate.as_ref().and_then(|of| of.sigma)));
        let unit = one.unit().map(|unit| format!(", {}", escaped(unit))).unwrap_or_default();
        let (by, sum) = match of_model {
            true => (" by the model", ""),
            false => ("", "<th scope=\"col\" class=\"n opt\">cumulative</th>"),
        };
        let text = format!(
            "<table class=\"drivers\"><caption class=\"sr\">Contributions to the variance of {}{by}, strongest first</caption>\n\
             <thead><tr><th scope=\"col\">dimension</th><th scope=\"col\">of the variance, 0 to 100 %</th><th scope=\"col\" class=\"n\">share</th>{sum}\
             <th scope=\"col\" class=\"n\">sigma{unit}</th><th scope=\"col\" class=\"n opt\">slope × half tolerance{unit}</th></tr></thead><tbody>\n",
            escaped(one.name())
        );
        Self { text, of_model, sigma, before: Sum::default() }
    }

    /// Adds the row of a contribution.
    fn add(&mut self, share: &Share) {
        let after = self.before.and(share);
        let mut bars = self.bars(share);
        let (amount, cells) = match self.of_model {
            true => (of_model_text(share), String::new()),
            false => {
                bars += &step(self.before.value, after.value);
                (format!("{} %", percent_within(share.value, share.error).0), summed(&after))
            }
        };
        let alone = self.sigma.filter(|_| share.alone);
        let spread = alone.map_or(UNKNOWN.to_owned(), |sigma| spread(sigma, share.value, share.error));
        let reach = share.reach.as_deref().unwrap_or_default();
        row(&mut self.text, &share.name, "", &bars, &[amount, cells, spread, reach.to_owned()]);
        self.before = after;
    }

    /// The parts of a contribution, one after the other.
    fn bars(&self, share: &Share) -> String {
        let fills = if self.of_model { ["linear", "interaction", ""] } else { ["linear", "curvature", "interaction"] };
        let mut at = 0.0;
        let mut bars = String::new();
        for (fill, part) in fills.into_iter().zip(share.parts.map(|part| scaled(part.max(0.0)))) {
            if part > 0.0 {
                let _ = write!(
                    bars,
                    "<rect class=\"{fill}\" x=\"{at:.2}\" y=\"{}\" width=\"{part:.2}\" height=\"{}\"/>",
                    BAR[0], BAR[1]
                );
                at += part;
            }
        }
        bars
    }

    /// Adds the row of the unresolved part.
    fn add_open(&mut self, open: &Open) {
        let (bars, amount, cells, spread) = match *open {
            Open::LeftOut(share) => {
                let after = Sum { value: self.before.value + share, ..self.before };
                let bars = hatched(share) + &step(self.before.value, after.value);
                let spread = self.sigma.map_or(UNKNOWN.to_owned(), |sigma| spread(sigma, share, None));
                (bars, format!("{} %", percent(share)), summed(&after), spread)
            }
            Open::ByPoints(share) => (
                hatched(share),
                format!("{} %", percent(share)),
                "<td class=\"n sum opt\"></td>".to_owned(),
                String::new(),
            ),
            Open::Unknown => (
                String::new(),
                UNKNOWN.to_owned(),
                format!("<td class=\"n sum opt\">{UNKNOWN}</td>"),
                UNKNOWN.to_owned(),
            ),
        };
        row(&mut self.text, "not resolved", " class=\"unknown\"", &bars, &[amount, cells, spread, String::new()]);
    }
}

/// Writes the notes below the table: what is not resolved, shares of the model, shares below 0, and dimensions without influence.
fn notes(text: &mut String, (of_model, open): (bool, Option<&Open>), all: &[Share], idle: &[String]) {
    match open {
        Some(Open::ByPoints(_)) => {
            *text += "<p class=\"note\">Not resolved: by points of the model, the surface leaves this part of the variance.</p>\n"
        }
        Some(Open::LeftOut(_)) => {
            *text += "<p class=\"note\">Not resolved: part of the variance, and in no contribution.</p>\n"
        }
        Some(Open::Unknown) => {
            *text += "<p class=\"note\">Not resolved: what these contributions leave of the variance is unknown.</p>\n"
        }
        None => {}
    }
    if of_model {
        *text += "<p class=\"note\">Share by itself, and with every interaction; sigma is that of a dimension by itself.</p>\n";
    }
    if all.iter().any(|share| share.value <= -0.5 * NEWS) {
        *text += "<p class=\"note\">A share below 0 lowers the variance: the dimension is correlated with others and varies against them.</p>\n";
    }
    if !idle.is_empty() {
        let more = idle.len().saturating_sub(NAMED);
        let names = escaped(&idle[..idle.len() - more].join(", "));
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let _ =
            writeln!(text, "<p class=\"note\">Less than {} % of the variance each: {names}{more}.</p>", 50.0 * NEWS);
    }
}

/// Formats the contribution alone and with every interaction, in percent.
fn of_model_text(share: &Share) -> String {
    let (first, _) = percent_within(share.value, share.error);
    match share.total {
        Some(total) => format!("{first} to {} %", percent_within(total.value, total.error).0),
        None => format!("{first} %"),
    }
}

/// True if the dimension varies together with another one.
fn varies_with(one: &CharacteristicAnalysis, dimension: &str) -> bool {
    let mut together =
        one.contributions.indices.iter().flat_map(|of| &of.factors).flat_map(|factor| &factor.dimensions);
    together.any(|of| of == dimension)
}

/// True if the share is too small for a row.
fn none(share: &Share) -> bool {
    share.parts.iter().sum::<f64>().abs() <= 0.5 * NEWS
}

fn of_surface(one: &CharacteristicAnalysis, dimensions: &[DimensionReport]) -> Vec<Share> {
    let own = one.sensitivities.iter().zip(dimensions).filter_map(|(row, of)| {
        let parts = [row.linear_share?, row.curvature_share.unwrap_or(0.0), 0.0];
        let value = parts.iter().sum();
        let error = row.first_order.map_or_else(|| one.share_error(value), |index| index.error);
        let alone = !varies_with(one, &row.dimension);
        Some(Share {
            name: row.dimension.clone(),
            parts,
            value,
            error,
            total: None,
            alone,
            reach: Some(reach(row, of)),
        })
    });
    let joint = one.contributions.interactions.iter().filter_map(|pair| {
        let value = pair.share?;
        let name = pair.dimensions.join(" \u{d7} ");
        let alone = !pair.dimensions.iter().any(|dimension| varies_with(one, dimension));
        let error = one.share_error(value);
        Some(Share { name, parts: [0.0, 0.0, value], value, error, total: None, alone, reach: None })
    });
    own.chain(joint).collect()
}

/// Contributions by points of the model: each dimension alone, and the interactions in addition.
fn of_points(one: &CharacteristicAnalysis, dimensions: &[DimensionReport]) -> Vec<Share> {
    let share = |(row, of): (&Sensitivity, &DimensionReport)| {
        let index = row.first_order?;
        let joint = row.total.map_or(0.0, |total| total.value - index.value.max(0.0)).max(0.0);
        let parts = [index.value.max(0.0), joint, 0.0];
        Some(Share {
            name: row.dimension.clone(),
            parts,
            value: index.value,
            error: index.error,
            total: row.total,
            alone: true,
            reach: Some(reach(row, of)),
        })
    };
    one.sensitivities.iter().zip(dimensions).filter_map(share).collect()
}

/// Folds the weakest rows of a long diagram into one last row.
fn fold(all: &mut Vec<Share>) {
    let first =
        if all.len() > ROWS { all.partition_point(|share| share.value >= SMALL).clamp(ROWS, MOST) } else { MOST };
    // A single row takes no more space than the row that would replace it.
    if all.len() <= first + 1 {
        return;
    }
    let rest = all.split_off(first);
    let mut parts = [0.0; 3];
    rest.iter().for_each(|share| (0..3).for_each(|i| parts[i] += share.parts[i]));
    let error = rest.iter().map(|share| share.error).sum();
    let alone = rest.iter().all(|share| share.alone);
    let name = format!("{} others", rest.len());
    all.push(Share { name, parts, value: parts.iter().sum(), error, total: None, alone, reach: None });
}

/// Formats slope times half tolerance with its sign, to the digits that the rounding error of the slope supports.
fn reach(row: &Sensitivity, dimension: &DimensionReport) -> String {
    let (Some(first), Some([lower, upper])) = (row.first, dimension.tolerance) else { return UNKNOWN.to_owned() };
    if slope(row, 1) == "0" {
        return "0".to_owned();
    }
    let half = 0.5 * (upper - lower);
    let text = within(first * half, 3, row.rounding.map(|rounding| rounding[0] * half));
    if first * half > 0.0 { format!("+{text}") } else { text }
}

/// Formats a slope with `digits` digits, or fewer if its rounding error supports only those.
pub(super) fn slope(row: &Sensitivity, digits: usize) -> String {
    let rounding = row.rounding.map(|rounding| rounding[0]);
    let text = derivative(row.first, rounding, digits);
    match row.first {
        Some(first) if text != "0" => within(first, digits, rounding),
        _ => text,
    }
}

/// Formats the sigma that this share alone would cause, with the digits that both errors support. A negative share, possible for
/// dimensions that vary together, has none.
fn spread((sigma, of_sigma): (f64, Option<f64>), share: f64, of_share: Option<f64>) -> String {
    if share <= 0.0 {
        return UNKNOWN.to_owned();
    }
    let root = share.sqrt();
    let error = of_sigma.unwrap_or(0.0).mul_add(root, 0.5 * sigma * of_share.unwrap_or(0.0) / root);
    within(sigma * root, 3, Some(error))
}

/// Part of the variance that no contribution explains.
enum Open {
    /// Part that the contributions leave out.
    LeftOut(f64),
    /// Part that the model has in addition to its surface, by points.
    ByPoints(f64),
    Unknown,
}

/// Returns the unexplained part, or None if it is too small for a row.
fn unresolved(one: &CharacteristicAnalysis) -> Option<Open> {
    let seen = |share: &f64| *share > 0.5 * NEWS;
    match (one.contributions.left_out_share, one.left()) {
        (Some(left_out), _) if seen(&left_out) => Some(Open::LeftOut(left_out)),
        (_, Some(left)) => Some(left).filter(seen).map(Open::ByPoints),
        (Some(_), None) => None,
        (None, None) => Some(Open::Unknown),
    }
}

/// Running sum, with the decimals that all its terms support.
#[derive(Clone, Copy)]
struct Sum {
    value: f64,
    decimals: usize,
}

impl Default for Sum {
    fn default() -> Self {
        Self { value: 0.0, decimals: 2 }
    }
}

impl Sum {
    fn and(self, share: &Share) -> Self {
        let (_, decimals) = percent_within(share.value, share.error);
        Self { value: self.value + share.value, decimals: self.decimals.min(decimals) }
    }
}

fn summed(sum: &Sum) -> String {
    format!("<td class=\"n sum opt\">{:.*} %</td>", sum.decimals, 100.0 * sum.value)
}

/// Returns a share in percent, within 0 and 100, as the drawings of rows use it.
fn scaled(share: f64) -> f64 {
    (100.0 * share).clamp(0.0, 100.0)
}

/// Draws a step of the running sum: across at the top of its row, then down to the next row.
fn step(from: f64, to: f64) -> String {
    format!("<path class=\"step\" d=\"M{:.2} 0H{:.2}V{TALL}\"/>", scaled(from), scaled(to))
}

fn hatched(share: f64) -> String {
    let width = scaled(share);
    let [top, tall] = BAR;
    let lines = (1..=(width / HATCH) as usize).map(|i| format!("M{:.2} {top}v{tall}", HATCH * i as f64));
    format!("<path class=\"open\" d=\"M0 {top}h{width:.2}v{tall}h-{width:.2}z{}\"/>", lines.collect::<String>())
}

/// Writes a row: name, drawing, share, cells of the sum, sigma, slope times half tolerance.
fn row(text: &mut String, name: &str, class: &str, bars: &str, [amount, cells, spread, reach]: &[String; 4]) {
    let _ = writeln!(
        text,
        "<tr><th scope=\"row\"{class}>{}</th><td class=\"grow\"><svg viewBox=\"0 0 100 {TALL}\" preserveAspectRatio=\"none\" aria-hidden=\"true\">{bars}</svg></td>\
         <td class=\"n\">{amount}</td>{cells}<td class=\"n\">{spread}</td><td class=\"n opt\">{reach}</td></tr>",
        escaped(name)
    );
}
