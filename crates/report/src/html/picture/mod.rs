//! Section with the picture of an assembly in space: drawn for paper and without script, turned by the script of the page.
//!
//! | what | file |
//! |---|---|
//! | lines and curves in space | `drawing.rs` |
//! | faces around the features of a part | `envelope.rs` |
//! | projection | `camera.rs` |
//! | paths, and places of labels | `sheet.rs` |
//! | data for the script | `data.rs` |
//! | tables of contributions by feature and of joints | `owners.rs` |

mod camera;
mod data;
mod drawing;
mod envelope;
mod owners;
mod sheet;

use std::fmt::Write;

use crate::Report;
use crate::assembly::{OwnerShare, ReportedAssembly, ShareOwner, owner_shares};
use crate::document::number::plural;
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use drawing::{Drawing, DrawnPoint, MarkForm};
use sensitol_study::AssemblyScene;
use sheet::{AssemblySheet, LabelKind, SHEETS, SheetLabel};

/// Style of the picture, for pages that have one.
pub(super) const STYLE: &str = include_str!("picture.css");
/// Script of the picture.
pub(super) const SCRIPT: &str = include_str!("picture.js");
/// Shares of the variance from which a feature has the next colour and thickness.
const HEATS: [f64; 4] = [0.01, 0.05, 0.15, 0.35];
/// Greatest number of features with a number in the picture.
const NUMBERED: usize = 8;
/// Greatest number of features that the caption names.
const NAMED: usize = 3;

/// Section of a page with its data.
pub(super) struct Picture {
    pub(super) section: String,
    /// JSON for the script.
    pub(super) data: String,
}

/// Figures of a characteristic for its picture.
struct PicturedCharacteristic {
    name: String,
    /// Contributions, the strongest first; empty if none is known.
    shares: Vec<OwnerShare>,
    labels: Vec<SheetLabel>,
    /// Sentence on the content of the picture.
    words: String,
}

/// Class of the colour of a share, 0 for none.
fn heat(share: f64) -> usize {
    HEATS.iter().filter(|&&least| share >= least).count()
}

/// Draws the assembly of a report. Returns None if it has none.
pub(super) fn picture(report: &Report) -> Option<Picture> {
    let assembly = report.assembly.as_ref()?;
    let scene = &assembly.scene;
    let drawing = Drawing::of(scene);
    let pictured: Vec<PicturedCharacteristic> =
        (0..report.analysis.characteristics.len()).map(|of| pictured(report, assembly, &drawing, of)).collect();
    let first = worst(report);
    let view = sheet::default_view(&drawing);
    let sheets = SHEETS.map(|size| AssemblySheet::fitting(&drawing, size, view));
    let svgs: String = sheets.iter().map(|sheet| svg(scene, &drawing, sheet, &pictured, first)).collect();
    let data = data::json(report, assembly, (&drawing, &pictured), (&sheets, view, first));
    let section = format!(
        "<section aria-labelledby=\"picture-title\" id=\"picture\">\n<h2 id=\"picture-title\">Assembly</h2>\n<div class=\"beside\">\n\
         <figure>\n<div class=\"stage\">\n{svgs}</div>\n{}<figcaption><span data-words>{}</span> {}</figcaption>\n</figure>\n\
         <div>\n{}{}</div>\n</div>\n{}</section>\n",
        tools(&pictured, first),
        escaped(&pictured[first].words),
        KEY,
        owners::drivers(scene, &pictured, first),
        owners::LEGEND,
        owners::tables(scene, &pictured),
    );
    Some(Picture { section, data })
}

/// Key of the lines in the picture.
const KEY: &str = "Colour and thickness: contribution to the variance. Grey faces: envelope of the features of a part. Dashed: extent not \
                   given. Diamond: joint.";

/// Index of the characteristic of which most are rejected.
fn worst(report: &Report) -> usize {
    let rejected = |of: usize| {
        let one = &report.analysis.characteristics[of];
        one.ppm_below().unwrap_or(0.0) + one.ppm_above().unwrap_or(0.0)
    };
    let mut worst = 0;
    for of in 1..report.analysis.characteristics.len() {
        if rejected(of) > rejected(worst) {
            worst = of;
        }
    }
    worst
}

fn pictured(report: &Report, assembly: &ReportedAssembly, drawing: &Drawing, of: usize) -> PicturedCharacteristic {
    let (one, scene) = (&report.analysis.characteristics[of], &assembly.scene);
    let shares = owner_shares(assembly, one).unwrap_or_default();
    let mut labels = Vec::new();
    let measured = scene.measured.get(of).map_or(&[][..], Vec::as_slice);
    for mark in drawing.marks.iter().filter(|mark| mark.measure.is_some_and(|measure| measured.contains(&measure))) {
        let middle = match mark.form {
            MarkForm::Dimension => mark.points.clone(),
            MarkForm::Path(_) if mark.class == "arc" => vec![mark.points[mark.points.len() / 2]],
            _ => continue,
        };
        let text = scene.measures[mark.measure.unwrap_or(0)].name.clone();
        labels.push(SheetLabel { kind: LabelKind::Measure, text, at: middle });
    }
    for (number, share) in numbered(&shares).enumerate() {
        for at in anchors(drawing, scene, share) {
            labels.push(SheetLabel { kind: LabelKind::Balloon, text: (number + 1).to_string(), at });
        }
    }
    for (part, at) in scene.parts.iter().zip(&drawing.parts) {
        labels.push(SheetLabel { kind: LabelKind::Part, text: part.name.clone(), at: vec![*at] });
    }
    let words = words(scene, one.name(), &shares, measured);
    PicturedCharacteristic { name: one.name().to_owned(), shares, labels, words }
}

/// Contributions with a number in the picture.
fn numbered(shares: &[OwnerShare]) -> impl Iterator<Item = &OwnerShare> {
    shares.iter().take(NUMBERED).take_while(|share| heat(share.value) > 0)
}

/// Places of a contribution in the picture: of its feature or joint, or of each feature that shares it.
fn anchors(drawing: &Drawing, scene: &AssemblyScene, share: &OwnerShare) -> Vec<Vec<DrawnPoint>> {
    let of_feature = |&feature: &usize| vec![DrawnPoint { at: drawing.bodies[feature].map(f64::round), body: feature }];
    match &share.owner {
        ShareOwner::Feature(feature) => vec![of_feature(feature)],
        ShareOwner::Joint(joint) => {
            let owner = Some(scene.features.len() + joint);
            let mark = drawing.marks.iter().find(|mark| mark.owner == owner);
            mark.map(|mark| mark.points.clone()).into_iter().collect()
        }
        ShareOwner::Shared(features) => features.iter().map(of_feature).collect(),
        ShareOwner::Formula => Vec::new(),
    }
}

/// Sentences on the content of the picture.
fn words(scene: &AssemblyScene, name: &str, shares: &[OwnerShare], measured: &[usize]) -> String {
    let still: Vec<&str> = scene.parts.iter().filter(|part| part.ground).map(|part| part.name.as_str()).collect();
    let stand = if still.len() == 1 { "stands" } else { "stand" };
    let mut text = format!(
        "{} and {} at nominal sizes; {} {stand} still.",
        plural(scene.parts.len(), "part", "parts"),
        plural(scene.joints.len(), "joint", "joints"),
        still.join(" and ")
    );
    let [from, to] =
        [1, 0].map(|end| move |measure: usize| scene.features[scene.measures[measure].between[end]].name.clone());
    let spans: Vec<String> = measured
        .iter()
        .map(|&measure| {
            format!("{} is measured from {} to {}", scene.measures[measure].name, from(measure), to(measure))
        })
        .collect();
    if !spans.is_empty() {
        let _ = write!(text, " {}.", spans.join(", "));
    }
    let named: Vec<String> = (shares.iter().take(NAMED).filter(|share| heat(share.value) > 0))
        .map(|share| format!("{} {:.0} %", share.name, 100.0 * share.value))
        .collect();
    if !named.is_empty() {
        let _ = write!(text, " Most of the variance of {name} comes from {}.", named.join(", "));
    }
    text
}

/// Markup of a sheet.
fn svg(
    scene: &AssemblyScene,
    drawing: &Drawing,
    sheet: &AssemblySheet,
    pictured: &[PicturedCharacteristic],
    of: usize,
) -> String {
    let measured = scene.measured.get(of).map_or(&[][..], Vec::as_slice);
    let one = &pictured[of];
    let mut marks = String::new();
    for mark in &drawing.marks {
        let heat = mark.owner.map_or(0, |owner| heat(owned(scene, &one.shares, owner)));
        let heat = if heat > 0 { format!(" h{heat}") } else { String::new() };
        let off = if mark.measure.is_some_and(|measure| !measured.contains(&measure)) { " off" } else { "" };
        let _ = write!(marks, "<path class=\"{}{heat}{off}\" d=\"{}\"/>", mark.class, sheet.path(mark));
    }
    format!(
        "<svg class=\"assembly {}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\"><path class=\"ghost\"/><g class=\"marks\">{marks}</g>\
         <g class=\"axes\">{}</g><g class=\"labels\">{}</g></svg>\n",
        sheet.size.class,
        sheet.size.width,
        sheet.height,
        escaped(&one.words),
        sheet.axes(),
        sheet.labels(&one.labels)
    )
}

/// Contribution of a feature or joint by its index among the features, then the joints; 0 if it has none.
fn owned(scene: &AssemblyScene, shares: &[OwnerShare], owner: usize) -> f64 {
    let wanted = match owner.checked_sub(scene.features.len()) {
        None => ShareOwner::Feature(owner),
        Some(joint) => ShareOwner::Joint(joint),
    };
    shares.iter().find(|share| share.owner == wanted).map_or(0.0, |share| share.value)
}

/// Markup of the controls, which the script shows.
fn tools(pictured: &[PicturedCharacteristic], first: usize) -> String {
    let mut options = String::new();
    for (index, one) in pictured.iter().enumerate() {
        let selected = if index == first { " selected" } else { "" };
        let _ = write!(options, "<option value=\"{index}\"{selected}>{}</option>", escaped(&one.name));
    }
    let select = match pictured.len() {
        1 => String::new(),
        _ => format!("<label>Characteristic <select>{options}</select></label>\n"),
    };
    let buttons = [
        ("front", "Front"),
        ("side", "Side"),
        ("top", "Top"),
        ("back", "Reset"),
        ("farther", "\u{2212}"),
        ("nearer", "+"),
    ];
    let button = |(view, text): (&str, &str)| {
        let label = match view {
            "farther" => " aria-label=\"Zoom out\"",
            "nearer" => " aria-label=\"Zoom in\"",
            _ => "",
        };
        format!("<button type=\"button\" data-view=\"{view}\"{label}>{text}</button>")
    };
    let buttons: String = buttons.into_iter().map(button).collect();
    format!(
        "<div class=\"tools\" hidden>\n{select}{buttons}\n<label>Deviation <input type=\"range\" data-sigma min=\"-3\" max=\"3\" step=\"0.1\" \
         value=\"0\" aria-label=\"Deviation of the characteristic in sigma\"></label>\n<output></output>\n</div>\n"
    )
}
