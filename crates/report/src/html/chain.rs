//! Dimension chain of a characteristic as arrows, head to tail.

use std::fmt::Write;

use crate::DimensionReport;
use crate::document::Extent;
use crate::document::number::{band, plain, short};
use crate::document::svg::escaped;
use crate::figures::Named;
use sensitol::analysis::{CharacteristicAnalysis, Sensitivity};

/// Greatest deviation of a slope from 1 or -1 for a link of a dimension chain.
const STRAIGHT: f64 = 0.05;
/// Greatest number of links of a chain that is drawn.
const LINKS: usize = 24;

/// Draws the dimension chain as arrows, each from the end of the one before. Returns None if the characteristic is not a sum and
/// difference of its dimensions.
pub(super) fn chain(one: &CharacteristicAnalysis, dimensions: &[DimensionReport]) -> Option<String> {
    let nominal = one.nominal?;
    let straight = |row: &&Sensitivity| row.first.is_some_and(|first| first != 0.0);
    let rows: Vec<&Sensitivity> = one.sensitivities.iter().filter(straight).collect();
    let curved = |row: &&&Sensitivity| row.curvature_share.is_some_and(|share| share > 1e-6);
    if !(2..=LINKS).contains(&rows.len())
        || rows.iter().any(|row| curved(&row))
        || one.contributions.interactions.iter().any(|pair| pair.mixed != Some(0.0))
    {
        return None;
    }
    let links: Option<Vec<(&DimensionReport, f64)>> = (rows.iter())
        .map(|row| {
            let first = row.first?;
            let of = dimensions.iter().find(|of| of.name == row.dimension)?;
            ((first.abs() - 1.0).abs() <= STRAIGHT).then_some((of, first.signum()))
        })
        .collect();
    let links = links?;
    let sum: f64 = links.iter().map(|(of, sign)| sign * of.nominal).sum();
    let size = links.iter().map(|(of, _)| of.nominal.abs()).fold(nominal.abs(), f64::max);
    // A remainder would be a link without a name.
    if (sum - nominal).abs() > 1e-9 * size || size == 0.0 {
        return None;
    }
    Some([("wide", 736.0), ("narrow", 358.0)].map(|(class, width)| drawing(one, &links, class, width)).concat())
}

fn drawing(one: &CharacteristicAnalysis, links: &[(&DimensionReport, f64)], class: &str, width: f64) -> String {
    /// Height of a row in pixels.
    const ROW: f64 = 26.0;
    /// Width of a letter in pixels.
    const LETTER: f64 = 7.0;
    let longest = |texts: &mut dyn Iterator<Item = String>| texts.map(|text| text.chars().count()).max().unwrap_or(0);
    let band = |of: &DimensionReport| of.tolerance.map(band).unwrap_or_default();
    let notes = longest(&mut links.iter().map(|(of, _)| band(of)));
    let values = longest(&mut links.iter().map(|(of, _)| plain(of.nominal)));
    // A value beside a short link at the end of the scale must not reach into the column of bands.
    let room = LETTER * (notes as f64 + values as f64 + 2.0);
    let (left, right) = if width > 500.0 { (110.0, room.max(110.0)) } else { (84.0, room.max(74.0)) };
    let mut at = 0.0;
    let ends: Vec<[f64; 2]> = (links.iter())
        .map(|(of, sign)| {
            let from = at;
            at += sign * of.nominal;
            [from, at]
        })
        .collect();
    let Some(scale) = Extent::over(ends.iter().flatten().copied(), 0.02, width - left - right) else {
        return String::new();
    };
    let x = |value: f64| left + scale.at(value);
    let tall = ROW * (links.len() + 1) as f64 + 8.0;
    let unit = one.unit().map(|unit| format!(" {unit}")).unwrap_or_default();
    let named: Vec<String> = (links.iter())
        .map(|(of, sign)| format!("{}{} {}", if *sign < 0.0 { "minus " } else { "plus " }, of.name, plain(of.nominal)))
        .collect();
    let nominal = plain(one.nominal.unwrap_or(at));
    let label = format!("Chain of {}: {}, which is {nominal}{unit}", one.name(), named.join(", "));
    let mut svg = format!(
        "<svg class=\"density chain {class}\" viewBox=\"0 0 {width} {tall}\" role=\"img\" aria-label=\"{}\">\n",
        escaped(&label)
    );
    let datum = x(0.0);
    let _ = writeln!(svg, "<path class=\"datum\" d=\"M{datum:.1} 2V{}\"/>", tall - 4.0);
    let mut arrow = |row: usize, [from, to]: [f64; 2], (name, value, note, class): (&str, String, String, &str)| {
        let (y, a, b) = (ROW * (row as f64 + 0.5) + 4.0, x(from), x(to));
        let head = if b >= a { -7.0 } else { 7.0 };
        let _ = writeln!(svg, "<path class=\"{class}\" d=\"M{a:.1} {y}H{b:.1}m{head} -4l{} 4l{head} 4\"/>", -head);
        let _ = writeln!(svg, "<path class=\"axis\" d=\"M{b:.1} {y}V{}\"/>", y + ROW);
        let _ = writeln!(svg, "<text class=\"name\" x=\"0\" y=\"{:.1}\">{}</text>", y + 4.0, escaped(&short(name)));
        // The value of a short arrow stands beside it, where no other line crosses it.
        let is_short = (b - a).abs() < LETTER * value.chars().count() as f64;
        let (at, down, anchor) =
            if is_short { (a.max(b) + LETTER, y + 4.0, "start") } else { (0.5 * (a + b), y - 4.0, "middle") };
        let _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"{down:.1}\" text-anchor=\"{anchor}\">{value}</text>");
        let _ = writeln!(svg, "<text x=\"{width}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>", y + 4.0, escaped(&note));
    };
    for (row, ((of, _), ends)) in links.iter().zip(&ends).enumerate() {
        arrow(row, *ends, (&of.name, plain(of.nominal), band(of), "link"));
    }
    arrow(links.len(), [0.0, at], (one.name(), nominal, String::new(), "link gap"));
    svg + "</svg>\n"
}
