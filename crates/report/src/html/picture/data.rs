//! Data of the picture for the script of the page.

use serde_json::{Value, json};

use super::camera::ViewAngles;
use super::drawing::{Drawing, DrawnMark, GRID, MarkForm};
use super::sheet::{AssemblySheet, LabelKind};
use super::{PicturedCharacteristic, heat, owned};
use crate::Report;
use crate::assembly::ReportedAssembly;
use crate::figures::{Figures, Named};
use sensitol_study::{RigidDisplacement, SceneDeviation};

/// Largest displacement at one sigma after enlargement, in steps of the grid.
const SHOWN: f64 = 0.05 * GRID;
/// Classes of lines that stay as a shadow of the nominal state.
const SHADOWS: [&str; 5] = ["face", "face guess", "round", "edge", "rod"];

/// JSON for the script.
pub(super) fn json(
    report: &Report,
    assembly: &ReportedAssembly,
    (drawing, pictured): (&Drawing, &[PicturedCharacteristic]),
    (sheets, view, first): (&[AssemblySheet], ViewAngles, usize),
) -> String {
    let scene = &assembly.scene;
    let bodies: Vec<[f64; 3]> = drawing.bodies.iter().map(|body| body.map(f64::round)).collect();
    let owners = scene.features.len() + scene.joints.len();
    let mut heats = Vec::new();
    let mut moves = Vec::new();
    let mut characteristics = Vec::new();
    for (index, (one, of)) in report.analysis.characteristics.iter().zip(pictured).enumerate() {
        heats.push((0..owners).map(|owner| heat(owned(scene, &of.shares, owner))).collect::<Vec<_>>());
        let deviation = assembly.deviations.get(index).and_then(Option::as_ref);
        let enlarged = deviation.and_then(|deviation| enlargement(drawing, deviation));
        moves.push(deviation.zip(enlarged).map(|(deviation, enlarged)| flat(drawing, deviation, enlarged)));
        let sigma = one.sigma().unwrap_or(0.0);
        characteristics.push(json!({
            "name": of.name,
            "words": of.words,
            "nominal": one.nominal,
            "sigma": sigma,
            "unit": one.unit().map_or_else(String::new, |unit| format!(" {unit}")),
            "decimals": decimals(sigma),
            "enlarged": enlarged,
        }));
    }
    let labels = |of: &PicturedCharacteristic| -> Value {
        let label = |label: &super::SheetLabel| {
            let points: Vec<Value> = label.at.iter().map(|point| json!([point.at.map(whole), point.body])).collect();
            json!([class(label.kind), label.text, points])
        };
        of.labels.iter().map(label).collect()
    };
    let sheet = |sheet: &AssemblySheet| {
        json!({
            "class": sheet.size.class,
            "width": sheet.size.width,
            "height": sheet.height,
            "scale": sheet.projection.scale,
            "middle": sheet.projection.middle,
        })
    };
    super::super::json(&json!({
        "of": first,
        "view": [view.azimuth, view.elevation],
        "sheets": sheets.iter().map(sheet).collect::<Vec<_>>(),
        "bodies": bodies.iter().map(|body| body.map(whole)).collect::<Vec<_>>(),
        "marks": drawing.marks.iter().map(mark).collect::<Vec<_>>(),
        "measured": scene.measured,
        "heat": heats,
        "moves": moves,
        "labels": pictured.iter().map(labels).collect::<Vec<_>>(),
        "characteristics": characteristics,
    }))
}

/// Whole number of a coordinate of the grid.
fn whole(value: f64) -> i64 {
    value.round() as i64
}

fn class(kind: LabelKind) -> &'static str {
    match kind {
        LabelKind::Balloon => "balloon",
        LabelKind::Measure => "of-measure",
        LabelKind::Part => "of-part",
    }
}

fn mark(mark: &DrawnMark) -> Value {
    let (form, size) = match &mark.form {
        MarkForm::Path(letters) => (letters.as_str(), 0.0),
        MarkForm::Sides(radius) => ("sides", *radius),
        MarkForm::Ball(radius) => ("ball", *radius),
        MarkForm::Dot(radius) => ("dot", *radius),
        MarkForm::Diamond => ("joint", 0.0),
        MarkForm::Dimension => ("size", 0.0),
    };
    let mut bodies: Vec<usize> = mark.points.iter().map(|point| point.body).collect();
    if bodies.iter().all(|body| *body == bodies[0]) {
        bodies.truncate(1);
    }
    json!({
        "form": form,
        "size": size,
        "owner": mark.owner,
        "measure": mark.measure,
        "ghost": SHADOWS.contains(&mark.class),
        "bodies": bodies,
        "points": mark.points.iter().map(|point| point.at.map(whole)).collect::<Vec<_>>(),
    })
}

/// Displacement of each body of the drawing.
fn of_bodies(deviation: &SceneDeviation) -> impl Iterator<Item = &RigidDisplacement> {
    deviation.features.iter().chain(&deviation.parts)
}

/// Factor by which displacements are enlarged: 1, 2 or 5 times a power of ten. Returns None if nothing moves.
fn enlargement(drawing: &Drawing, deviation: &SceneDeviation) -> Option<f64> {
    let moves: Vec<&RigidDisplacement> = of_bodies(deviation).collect();
    let moved = |point: &super::DrawnPoint| {
        let (body, of) = (drawing.bodies[point.body], moves[point.body]);
        let [x, y, z] = [0, 1, 2].map(|i| point.at[i] - body[i]);
        let [u, v, w] = of.rotation;
        let [a, b, c] = of.displacement.map(|part| part / drawing.step);
        let all = [a + v * z - w * y, b + w * x - u * z, c + u * y - v * x];
        all.iter().map(|part| part * part).sum::<f64>().sqrt()
    };
    let largest = drawing.marks.iter().flat_map(|mark| mark.points.iter().map(moved)).fold(0.0, f64::max);
    // A displacement below the rounding of a solved pose is none.
    if largest.is_nan() || largest < 1e-9 * GRID {
        return None;
    }
    let wanted = SHOWN / largest;
    let ten = libm::pow(10.0, libm::log10(wanted).floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * ten <= wanted).unwrap_or(1.0);
    Some(step * ten)
}

/// Enlarged displacement and rotation of all bodies, six numbers each.
fn flat(drawing: &Drawing, deviation: &SceneDeviation, enlarged: f64) -> Vec<f64> {
    let rounded = |value: f64, by: f64| (value * by).round() / by + 0.0;
    let numbers = |of: &RigidDisplacement| {
        let displacement = of.displacement.map(|part| rounded(part / drawing.step * enlarged, 10.0));
        let rotation = of.rotation.map(|part| rounded(part * enlarged, 1e5));
        [displacement, rotation].concat()
    };
    of_bodies(deviation).flat_map(numbers).collect()
}

/// Decimals with which a value shows a tenth of its sigma.
fn decimals(sigma: f64) -> usize {
    if sigma > 0.0 { (2.0 - libm::log10(sigma).floor()).clamp(0.0, 9.0) as usize } else { 3 }
}
