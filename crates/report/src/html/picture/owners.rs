//! Tables beside the picture: contributions by feature, and joints with the freedoms that they take.

use std::fmt::Write;

use super::{NUMBERED, PicturedCharacteristic, heat};
use crate::assembly::{OwnerShare, ShareOwner};
use crate::document::number::{UNKNOWN, percent, plural};
use crate::document::svg::escaped;
use sensitol_study::AssemblyScene;

/// Greatest number of rows beside the picture.
const ROWS: usize = NUMBERED;
/// Share of the variance below which a row is left out.
const SMALL: f64 = 5e-4;

/// Key of the colours.
pub(super) const LEGEND: &str = "<ul class=\"legend heat\"><li class=\"h1\">from 1 %</li><li class=\"h2\">from 5 %</li>\
                                 <li class=\"h3\">from 15 %</li><li class=\"h4\">from 35 % of the variance</li></ul>\n";

/// Contributions of each characteristic beside the picture. The script shows those of the chosen one.
pub(super) fn drivers(scene: &AssemblyScene, pictured: &[PicturedCharacteristic], first: usize) -> String {
    let mut text = String::new();
    for (index, one) in pictured.iter().enumerate() {
        let hidden = if index == first { "" } else { " hidden" };
        let _ = writeln!(
            text,
            "<table class=\"owners\" data-owners=\"{index}\"{hidden}><caption>Contributions to the variance of {}</caption><tbody>",
            escaped(&one.name)
        );
        let shown: Vec<&OwnerShare> = one.shares.iter().filter(|share| share.value.abs() >= SMALL).take(ROWS).collect();
        for (place, share) in shown.iter().enumerate() {
            // A dimension of formulas alone has no place in the picture.
            let number = match heat(share.value) > 0 && share.owner != ShareOwner::Formula {
                true => format!("<span class=\"no\">{}</span>", place + 1),
                false => String::new(),
            };
            let _ = writeln!(
                text,
                "<tr><td>{number}</td><th scope=\"row\">{}<small>{}</small></th><td><svg class=\"bar\" viewBox=\"0 0 100 10\" \
                 preserveAspectRatio=\"none\" aria-hidden=\"true\"><rect class=\"h{}\" width=\"{:.2}\" height=\"10\"/></svg></td>\
                 <td class=\"n\">{} %</td></tr>",
                escaped(&share.name),
                escaped(&share.kind(scene)),
                heat(share.value),
                (100.0 * share.value).clamp(0.0, 100.0),
                percent(share.value)
            );
        }
        text += "</tbody></table>\n";
        if shown.is_empty() {
            let _ = writeln!(text, "<p class=\"note\" data-owners=\"{index}\"{hidden}>No contribution is known.</p>");
        }
    }
    text
}

/// Tables of all characteristics and of the joints, folded.
pub(super) fn tables(scene: &AssemblyScene, pictured: &[PicturedCharacteristic]) -> String {
    let mut names: Vec<(String, String)> = Vec::new();
    for share in pictured.iter().flat_map(|one| &one.shares) {
        if !names.iter().any(|(name, _)| *name == share.name) {
            names.push((share.name.clone(), share.kind(scene)));
        }
    }
    let heads: String =
        pictured.iter().map(|one| format!("<th scope=\"col\" class=\"n\">{}</th>", escaped(&one.name))).collect();
    let mut rows = String::new();
    for (name, kind) in &names {
        let mut cells = String::new();
        for one in pictured {
            let share = one.shares.iter().find(|share| share.name == *name);
            let cell = share.map_or(UNKNOWN.to_owned(), |share| format!("{} %", percent(share.value)));
            let _ = write!(cells, "<td class=\"n\">{cell}</td>");
        }
        let _ = writeln!(rows, "<tr><th scope=\"row\">{}</th><td>{}</td>{cells}</tr>", escaped(name), escaped(kind));
    }
    let mut joints = String::new();
    for joint in &scene.joints {
        let [a, b] = joint.between.map(|feature| escaped(&scene.features[feature].name));
        let _ = writeln!(
            joints,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{a}, {b}</td><td class=\"n\">{}</td><td>{}</td></tr>",
            escaped(&joint.name),
            joint.kind,
            joint.freedoms.len(),
            escaped(&joint.freedoms.join(", "))
        );
    }
    format!(
        "<details class=\"fold on-screen\"><summary>{} by contribution, {} by freedoms</summary>\n<div class=\"wide\" tabindex=\"0\"><table>\
         <thead><tr><th scope=\"col\">feature or joint</th><th scope=\"col\"></th>{heads}</tr></thead><tbody>\n{rows}</tbody></table></div>\n\
         <div class=\"wide\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">joint</th><th scope=\"col\">kind</th><th scope=\"col\">between</th>\
         <th scope=\"col\" class=\"n\">takes</th><th scope=\"col\">freedoms</th></tr></thead><tbody>\n{joints}</tbody></table></div>\n</details>\n",
        plural(scene.features.len(), "feature", "features"),
        plural(scene.joints.len(), "joint", "joints"),
    )
}
