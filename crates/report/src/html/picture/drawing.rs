//! Drawing of a scene in space: marks of lines and curves, whose points move with the features and parts.
//!
//! Points are whole numbers of a grid about the middle of the assembly, so that the page and its script draw the same.

use super::envelope::envelope;
use sensitol_study::{AssemblyScene, FeatureOutline, MeasureMark, SceneFeature};

/// Steps of the grid over the extent of the assembly. A step is a tenth of a pixel of a drawing of 1000 pixels.
pub(super) const GRID: f64 = 10_000.0;
/// Side of a plane without extent, over the extent of the assembly.
const PLANE: f64 = 0.2;
/// Length of an axis without extent, over the extent of the assembly.
const AXIS: f64 = 0.25;
/// Length of the directions of a frame, over the extent of the assembly.
const TRIAD: f64 = 0.07;
/// Part of an axis beyond the ends of its cylinder.
const BEYOND: f64 = 0.12;
/// Distance of the control points of a quarter circle in Bezier form, over its radius: 4/3 (sqrt(2) - 1).
const BEZIER: f64 = 0.552_284_749_830_793_4;
/// Chords of an arc that shows an angle.
const CHORDS: usize = 12;

type Point = [f64; 3];

/// Point of a drawing, and the body that it moves with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DrawnPoint {
    pub(super) at: Point,
    pub(super) body: usize,
}

/// Form of a mark.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MarkForm {
    /// Lines and curves by the letters of SVG: M, L and C, with one point or three each, and Z.
    Path(String),
    /// Lines along a cylinder of this radius, as seen from the side, between two points of its axis.
    Sides(f64),
    /// Ball of this radius.
    Ball(f64),
    /// Dot of this radius in pixels.
    Dot(f64),
    /// Diamond of a joint.
    Diamond,
    /// Dimension line between two points.
    Dimension,
}

/// A mark of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DrawnMark {
    pub(super) form: MarkForm,
    pub(super) class: &'static str,
    /// Feature or joint whose contribution colours it, by its index among the features, then the joints.
    pub(super) owner: Option<usize>,
    /// Measure that it shows.
    pub(super) measure: Option<usize>,
    pub(super) points: Vec<DrawnPoint>,
}

/// Drawing of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drawing {
    pub(super) marks: Vec<DrawnMark>,
    /// Points about which bodies turn: the features, then the parts.
    pub(super) bodies: Vec<Point>,
    /// Place to which each part's name leads.
    pub(super) parts: Vec<DrawnPoint>,
    /// Length of a step of the grid.
    pub(super) step: f64,
    middle: Point,
}

fn plus(a: Point, direction: Point, by: f64) -> Point {
    [0, 1, 2].map(|i| a[i] + by * direction[i])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Points of a feature for the envelope of its part: the corners of a face, the ends of an axis, or its origin.
fn corners(feature: &SceneFeature) -> Vec<Point> {
    let [x, y, z] = feature.axes;
    match feature.outline {
        FeatureOutline::Rectangle(Some([a, b])) => {
            let ends = [plus(feature.origin, x, 0.5 * a), plus(feature.origin, x, -0.5 * a)];
            ends.into_iter().flat_map(|end| [plus(end, y, 0.5 * b), plus(end, y, -0.5 * b)]).collect()
        }
        FeatureOutline::Cylinder { length: Some(length), .. } => {
            vec![plus(feature.origin, z, 0.5 * length), plus(feature.origin, z, -0.5 * length)]
        }
        _ => vec![feature.origin],
    }
}

/// Points on the rim of a disc or a cylinder, along x and y of the feature.
fn rims(feature: &SceneFeature) -> Vec<Point> {
    let radius = match feature.outline {
        FeatureOutline::Disc(diameter) | FeatureOutline::Cylinder { diameter: Some(diameter), .. } => 0.5 * diameter,
        _ => return Vec::new(),
    };
    let [x, y, _] = feature.axes;
    let about = |end: Point| [plus(end, x, radius), plus(end, x, -radius), plus(end, y, radius), plus(end, y, -radius)];
    corners(feature).into_iter().flat_map(about).collect()
}

impl Drawing {
    /// Draws a scene at its nominal state.
    pub(super) fn of(scene: &AssemblyScene) -> Self {
        let mut points: Vec<Point> = scene.features.iter().flat_map(corners).collect();
        points.extend(scene.measures.iter().flat_map(|measure| match measure.mark {
            MeasureMark::Line { of, from, .. } => vec![of, from],
            MeasureMark::Arc { at, .. } => vec![at],
        }));
        points.extend(scene.features.iter().flat_map(rims));
        let ends = [0, 1, 2].map(|i| {
            let values = points.iter().map(|point| point[i]);
            [values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max)]
        });
        let extent = ends.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let extent = if extent > 0.0 { extent } else { 1.0 };
        let bodies = scene.features.iter().map(|feature| feature.origin);
        let mut drawing = Self {
            marks: Vec::new(),
            bodies: bodies.chain(scene.parts.iter().map(|part| part.origin)).collect(),
            parts: Vec::new(),
            step: extent / GRID,
            middle: ends.map(|[low, high]| 0.5 * (low + high)),
        };
        for part in 0..scene.parts.len() {
            drawing.add_part(scene, part);
        }
        // Joints lie below the points of features, whose colour is seen then.
        for index in 0..scene.joints.len() {
            drawing.add_joint(scene, index, extent);
        }
        for index in 0..scene.features.len() {
            drawing.add_feature(scene, index, extent);
        }
        for index in 0..scene.measures.len() {
            drawing.add_measure(scene, index, extent);
        }
        drawing
            .bodies
            .iter_mut()
            .for_each(|body| *body = [0, 1, 2].map(|i| (body[i] - drawing.middle[i]) / drawing.step));
        drawing
    }

    /// Point on the grid.
    fn point(&self, at: Point, body: usize) -> DrawnPoint {
        DrawnPoint { at: [0, 1, 2].map(|i| ((at[i] - self.middle[i]) / self.step).round()), body }
    }

    fn add(&mut self, form: MarkForm, class: &'static str, owner: Option<usize>, points: &[Point], body: usize) {
        let points = points.iter().map(|&at| self.point(at, body)).collect();
        let form = match form {
            MarkForm::Sides(radius) => MarkForm::Sides((radius / self.step).round()),
            MarkForm::Ball(radius) => MarkForm::Ball((radius / self.step).round()),
            other => other,
        };
        self.marks.push(DrawnMark { form, class, owner, measure: None, points });
    }

    /// Draws the envelope of the features of a part.
    fn add_part(&mut self, scene: &AssemblyScene, part: usize) {
        let body = scene.features.len() + part;
        let own: Vec<Point> =
            (scene.features.iter().filter(|feature| feature.part == part)).flat_map(corners).collect();
        let middle = [0, 1, 2].map(|i| own.iter().map(|point| point[i]).sum::<f64>() / own.len().max(1) as f64);
        self.parts.push(self.point(middle, body));
        for face in envelope(&own) {
            let (class, letters) = match face.len() {
                2 => ("bone", "ML".to_owned()),
                count => ("env", format!("M{}Z", "L".repeat(count - 1))),
            };
            self.add(MarkForm::Path(letters), class, None, &face, body);
        }
    }

    fn add_feature(&mut self, scene: &AssemblyScene, index: usize, extent: f64) {
        let feature = &scene.features[index];
        let (origin, [x, y, z]) = (feature.origin, feature.axes);
        let owner = Some(index);
        match feature.outline {
            FeatureOutline::Rectangle(size) => {
                let class = if size.is_some() { "face" } else { "face guess" };
                let [a, b] = size.unwrap_or([PLANE * extent; 2]).map(|side| 0.5 * side);
                let corner = |i: f64, j: f64| plus(plus(origin, x, i * a), y, j * b);
                let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
                self.add(path("MLLLZ"), class, owner, &corners, index);
            }
            FeatureOutline::Disc(diameter) => {
                self.add(path(CIRCLE), "face", owner, &circle(origin, [x, y], 0.5 * diameter), index);
            }
            FeatureOutline::Cylinder { diameter, length } => {
                let half = 0.5 * length.unwrap_or(AXIS * extent);
                let ends = [plus(origin, z, half), plus(origin, z, -half)];
                if let Some(diameter) = diameter {
                    let radius = 0.5 * diameter;
                    let rings = if length.is_some() { &ends[..] } else { &[origin][..] };
                    for &ring in rings {
                        self.add(path(CIRCLE), "round", owner, &circle(ring, [x, y], radius), index);
                    }
                    let class = if length.is_some() { "edge" } else { "edge guess" };
                    self.add(MarkForm::Sides(radius), class, owner, &ends, index);
                }
                let reach = half * (1.0 + BEYOND);
                let axis = [plus(origin, z, reach), plus(origin, z, -reach)];
                self.add(path("ML"), "axis", owner, &axis, index);
            }
            FeatureOutline::Ball(diameter) => {
                if let Some(diameter) = diameter {
                    self.add(MarkForm::Ball(0.5 * diameter), "round", owner, &[origin], index);
                }
                self.add(MarkForm::Dot(3.0), "dot", owner, &[origin], index);
            }
            FeatureOutline::Triad => {
                for axis in [x, y, z] {
                    self.add(path("ML"), "triad", owner, &[origin, plus(origin, axis, TRIAD * extent)], index);
                }
            }
        }
    }

    /// Draws a rod as a line, other joints as a diamond with lines to their features.
    fn add_joint(&mut self, scene: &AssemblyScene, index: usize, extent: f64) {
        let joint = &scene.joints[index];
        let owner = Some(scene.features.len() + index);
        let ends = joint.between.map(|feature| self.point(scene.features[feature].origin, feature));
        if joint.is_rod {
            let points = ends.to_vec();
            self.marks.push(DrawnMark { form: path("ML"), class: "rod", owner, measure: None, points });
            return;
        }
        let at = self.point(joint.at, joint.between[1]);
        for (end, feature) in ends.into_iter().zip(joint.between) {
            // Faces and axes reach to the joint.
            if !matches!(scene.features[feature].outline, FeatureOutline::Ball(_) | FeatureOutline::Triad) {
                continue;
            }
            let across = [0, 1, 2].map(|i| end.at[i] - at.at[i]);
            if dot(across, across).sqrt() * self.step > 1e-3 * extent {
                let points = vec![at, end];
                self.marks.push(DrawnMark { form: path("ML"), class: "tie", owner: None, measure: None, points });
            }
        }
        self.marks.push(DrawnMark { form: MarkForm::Diamond, class: "joint", owner, measure: None, points: vec![at] });
    }

    fn add_measure(&mut self, scene: &AssemblyScene, index: usize, extent: f64) {
        let measure = &scene.measures[index];
        let [of_body, from_body] = measure.between;
        let first = self.marks.len();
        match measure.mark {
            MeasureMark::Line { of, from, witness } => {
                let (of, from) = (self.point(of, of_body), self.point(from, from_body));
                let witness = self.point(witness, from_body);
                let (class, form) = ("witness", path("ML"));
                self.marks.push(DrawnMark { form, class, owner: None, measure: None, points: vec![from, witness] });
                let (class, form) = ("measure", MarkForm::Dimension);
                self.marks.push(DrawnMark { form, class, owner: None, measure: None, points: vec![of, from] });
            }
            MeasureMark::Arc { at, of, from } => {
                let (radius, ray) = (0.16 * extent, 0.2 * extent);
                for direction in [of, from] {
                    self.add(path("ML"), "witness", None, &[at, plus(at, direction, ray)], of_body);
                }
                self.add(path(ARC), "arc", None, &arc(at, of, from, radius), of_body);
            }
        }
        self.marks[first..].iter_mut().for_each(|mark| mark.measure = Some(index));
    }
}

/// Letters of a circle of four curves.
const CIRCLE: &str = "MCCCCZ";
/// Letters of an arc of [`CHORDS`] chords.
const ARC: &str = "MLLLLLLLLLLLL";
/// Path of these letters.
fn path(letters: &str) -> MarkForm {
    MarkForm::Path(letters.to_owned())
}

/// Circle about a point: the start, and three points for each quarter.
fn circle(origin: Point, [x, y]: [Point; 2], radius: f64) -> Vec<Point> {
    let at = |a: f64, b: f64| plus(plus(origin, x, a * radius), y, b * radius);
    let quarters = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)];
    let mut points = vec![at(1.0, 0.0)];
    for pair in quarters.windows(2) {
        let [(a, b), (c, d)] = [pair[0], pair[1]];
        points.extend([at(a + BEZIER * c, b + BEZIER * d), at(c + BEZIER * a, d + BEZIER * b), at(c, d)]);
    }
    points
}

/// Arc from one direction to another.
fn arc(at: Point, of: Point, from: Point, radius: f64) -> Vec<Point> {
    let mut across = plus(of, from, -dot(of, from));
    let length = dot(across, across).sqrt();
    // The angle of two parallel directions is drawn as a point.
    if length > 0.0 {
        across = across.map(|part| part / length);
    }
    let angle = libm::atan2(length, dot(of, from));
    let chord = |i: usize| {
        let part = angle * i as f64 / CHORDS as f64;
        plus(plus(at, from, radius * libm::cos(part)), across, radius * libm::sin(part))
    };
    (0..=CHORDS).map(chord).collect()
}
