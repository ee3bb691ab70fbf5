//! Lines that show measures: a dimension line with its witness lines, or an arc.

use sensitol_spatial::{FeatureKind, FeaturePlace, FrameAxis, MeasureKind};

/// Lines that show a measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeasureMark {
    /// A dimension line.
    Line {
        /// End at the measured feature.
        of: [f64; 3],
        /// End at the feature from which it is measured.
        from: [f64; 3],
        /// Place of that feature to which a witness line leads.
        witness: [f64; 3],
    },
    /// An angle between two directions at a place.
    Arc {
        /// Vertex of the angle.
        at: [f64; 3],
        /// Direction of the measured feature.
        of: [f64; 3],
        /// Direction from which it is measured.
        from: [f64; 3],
    },
}

/// Scalar product.
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn plus(a: [f64; 3], direction: [f64; 3], by: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + by * direction[i])
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    plus(a, b, -1.0)
}

impl MeasureMark {
    /// Lines of a measure between two features at their places.
    pub(super) fn of(kind: &MeasureKind, kinds: [FeatureKind; 2], [of, from]: [&FeaturePlace; 2]) -> Self {
        let across = minus(of.origin, from.origin);
        match kind {
            MeasureKind::Angle => Self::Arc { at: of.origin, of: of.axes[2], from: from.axes[2] },
            MeasureKind::Along(coordinate) => {
                let axis = match coordinate {
                    FrameAxis::X => from.axes[0],
                    FrameAxis::Y => from.axes[1],
                    FrameAxis::Z => from.axes[2],
                };
                Self::Line { of: of.origin, from: plus(of.origin, axis, -dot(across, axis)), witness: from.origin }
            }
            MeasureKind::Profile(_) | MeasureKind::Distance => distance(kinds, of, from),
            MeasureKind::Gap => gap(distance(kinds, of, from), of.radius, from.radius),
        }
    }
}

/// Dimension line of a distance: along the normal of a plane, across an axis, or from a point.
fn distance(kinds: [FeatureKind; 2], of: &FeaturePlace, from: &FeaturePlace) -> MeasureMark {
    let across = minus(of.origin, from.origin);
    let witness = from.origin;
    match kinds {
        [_, FeatureKind::Plane] => {
            let normal = from.axes[2];
            MeasureMark::Line { of: of.origin, from: plus(of.origin, normal, -dot(across, normal)), witness }
        }
        [FeatureKind::Plane, _] => {
            let normal = of.axes[2];
            let foot = plus(from.origin, normal, dot(across, normal));
            MeasureMark::Line { of: foot, from: from.origin, witness: of.origin }
        }
        [_, FeatureKind::Axis] => {
            let axis = from.axes[2];
            MeasureMark::Line { of: of.origin, from: plus(from.origin, axis, dot(across, axis)), witness }
        }
        [FeatureKind::Axis, _] => {
            let axis = of.axes[2];
            let foot = plus(of.origin, axis, -dot(across, axis));
            MeasureMark::Line { of: foot, from: from.origin, witness: of.origin }
        }
        _ => MeasureMark::Line { of: of.origin, from: from.origin, witness },
    }
}

/// Dimension line between the surfaces of features with these radii.
fn gap(line: MeasureMark, of_radius: f64, from_radius: f64) -> MeasureMark {
    let MeasureMark::Line { of, from, witness } = line else { return line };
    let across = minus(of, from);
    let length = dot(across, across).sqrt();
    if length == 0.0 {
        return line;
    }
    let unit = across.map(|part| part / length);
    MeasureMark::Line { of: plus(of, unit, -of_radius), from: plus(from, unit, from_radius), witness }
}
