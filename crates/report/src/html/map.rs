//! Map of the interactions: a triangle below the contributions of the dimensions alone.

use std::fmt::Write;

use crate::document::number::percent;
use crate::document::svg::escaped;
use crate::figures::Named;
use sensitol::analysis::CharacteristicAnalysis;

/// Greatest number of dimensions of the map, the most influential first.
const MAPPED: usize = 16;
/// Least share of the variance at which an interaction is drawn.
const SEEN: f64 = 1e-4;
/// Shares of the variance at which a cell becomes darker.
const GREYS: [f64; 4] = [1e-3, 1e-2, 0.1, 0.5];

/// Draws the map of interactions. Returns None if no interaction is visible and no variance is left out.
pub(super) fn map(one: &CharacteristicAnalysis) -> Option<String> {
    let examined = one.contributions.examined_interactions;
    let strongest = one.contributions.interactions.iter().filter_map(|pair| pair.share).fold(0.0, f64::max);
    // Variance that is left out may come from interactions that were not examined.
    let left_out = one.contributions.left_out_share.unwrap_or(0.0);
    if one.contributions.possible_interactions == 0 || strongest.max(left_out) < 5.0 * SEEN {
        return None;
    }
    let own = |row: &sensitol::analysis::Sensitivity| {
        row.linear_share.map(|linear| linear + row.curvature_share.unwrap_or(0.0))
    };
    let mut rows: Vec<(&str, f64)> =
        one.sensitivities.iter().filter_map(|row| Some((row.dimension.as_str(), own(row)?))).collect();
    let in_pair = |name: &str| one.contributions.interactions.iter().any(|pair| pair.dimensions.contains(&name));
    rows.retain(|(name, share)| *share > SEEN || in_pair(name));
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let left = rows.len().saturating_sub(MAPPED);
    rows.truncate(MAPPED);
    if rows.len() < 2 {
        return None;
    }
    let shade = |share: f64| GREYS.iter().filter(|&&from| share >= from).count();
    let mut text = format!(
        "<table class=\"map\"><caption>Interactions of {}, % of the variance: {examined} of {} examined</caption><tbody>\n",
        escaped(one.name()),
        one.contributions.possible_interactions
    );
    for (i, (name, share)) in rows.iter().enumerate() {
        let _ = write!(text, "<tr><th scope=\"row\">{}</th>", escaped(name));
        for (other, _) in &rows[..i] {
            let pair = one.contributions.interactions.iter().find(|pair| {
                let [a, b] = pair.dimensions;
                (a == *name && b == *other) || (a == *other && b == *name)
            });
            text += &match pair.map(|pair| pair.share) {
                Some(Some(share)) if share >= SEEN => {
                    let level = shade(share);
                    format!(
                        "<td class=\"g{level}\" title=\"{} × {}\">{}</td>",
                        escaped(name),
                        escaped(other),
                        percent(share)
                    )
                }
                Some(Some(_)) => "<td class=\"g0\"></td>".to_owned(),
                Some(None) => "<td class=\"hatched\">?</td>".to_owned(),
                None if examined < one.contributions.possible_interactions => {
                    "<td class=\"hatched\"><span class=\"sr\">not examined</span></td>".to_owned()
                }
                None => "<td></td>".to_owned(),
            };
        }
        let level = shade(*share);
        let _ = writeln!(text, "<td class=\"own g{level}\">{}</td></tr>", percent(*share));
    }
    text += "</tbody></table>\n";
    let more = if left > 0 { format!(" {left} dimensions of less influence are not shown.") } else { String::new() };
    let hatched = if examined < one.contributions.possible_interactions {
        " Hatched: not examined, or without a joint effect."
    } else {
        ""
    };
    Some(
        text + &format!(
            "<p class=\"note\">On the diagonal what a dimension makes alone, below what two make jointly; darker is more.{hatched}{more}</p>\n"
        ),
    )
}
