//! Measures between two features.

use crate::assembly::{FeatureKind, FrameAxis, MeasureKind, Quantity};
use crate::number::Number;
use crate::placement::PlacedFeature;

/// Value of a measure, and the smooth numbers that it consists of.
pub(crate) struct Measured<S> {
    pub(crate) value: S,
    /// Numbers without a kink. A norm has a kink at 0, and its components have none.
    pub(crate) smooth: Vec<S>,
}

impl<S: Number> Measured<S> {
    fn smooth(value: S) -> Self {
        Self { smooth: vec![value.clone()], value }
    }
}

/// Measure of feature `of` from feature `from`. `number` makes a number of a quantity, and `length` one of a constant length.
pub(crate) fn measured<S: Number>(
    kind: &MeasureKind,
    kinds: [FeatureKind; 2],
    [of, from]: [&PlacedFeature<S>; 2],
    (number, length): (&impl Fn(&Quantity) -> S, &impl Fn(f64) -> S),
) -> Measured<S> {
    match kind {
        MeasureKind::Distance => distance(kinds, of, from),
        MeasureKind::Gap => {
            let apart = distance(kinds, of, from);
            let radii = of.radius.plus(&from.radius);
            Measured { value: apart.value.minus(&radii), smooth: apart.smooth }
        }
        MeasureKind::Along(coordinate) => {
            let axis = match coordinate {
                FrameAxis::X => 0,
                FrameAxis::Y => 1,
                FrameAxis::Z => 2,
            };
            Measured::smooth(of.origin.minus(&from.origin).dot(&from.axes[axis]))
        }
        MeasureKind::Angle => angle(kinds, of, from),
        MeasureKind::Profile(points) => profile(of, from, points, (number, length)),
    }
}

/// Distance along the normal of a plane, across an axis, or from a point.
fn distance<S: Number>(kinds: [FeatureKind; 2], of: &PlacedFeature<S>, from: &PlacedFeature<S>) -> Measured<S> {
    let across = of.origin.minus(&from.origin);
    let [x, y, z] = &from.axes;
    match kinds {
        [_, FeatureKind::Plane] => Measured::smooth(across.dot(z)),
        // From a point or an axis the distance to a plane is the same with the other sign.
        [FeatureKind::Plane, _] => Measured::smooth(across.dot(&of.axes[2]).negative()),
        [_, FeatureKind::Axis] => {
            let parts = [across.dot(x), across.dot(y)];
            Measured { value: parts[0].length_with(&parts[1]), smooth: parts.to_vec() }
        }
        [FeatureKind::Axis, _] => {
            let parts = [across.dot(&of.axes[0]), across.dot(&of.axes[1])];
            Measured { value: parts[0].length_with(&parts[1]), smooth: parts.to_vec() }
        }
        _ => {
            let parts = from.axes.each_ref().map(|axis| across.dot(axis));
            Measured { value: parts[0].length_with(&parts[1]).length_with(&parts[2]), smooth: parts.to_vec() }
        }
    }
}

/// Angle between two directions, or of an axis above a plane.
fn angle<S: Number>(kinds: [FeatureKind; 2], of: &PlacedFeature<S>, from: &PlacedFeature<S>) -> Measured<S> {
    let other = &of.axes[2];
    let parts = from.axes.each_ref().map(|axis| axis.dot(other));
    let across = parts[0].length_with(&parts[1]);
    let mixed = kinds.contains(&FeatureKind::Plane) && kinds[0] != kinds[1];
    match mixed {
        true => Measured { value: parts[2].angle_over(&across), smooth: vec![parts[2].clone()] },
        false => Measured { value: across.angle_over(&parts[2]), smooth: parts.to_vec() },
    }
}

/// Greatest deviation of points of a feature from their nominal distances from a plane.
fn profile<S: Number>(
    of: &PlacedFeature<S>,
    from: &PlacedFeature<S>,
    points: &[[Quantity; 2]],
    (number, length): (&impl Fn(&Quantity) -> S, &impl Fn(f64) -> S),
) -> Measured<S> {
    let across = of.origin.minus(&from.origin);
    let mut smooth = Vec::new();
    for [x, y] in points {
        let point = across.plus(&of.axes[0].scaled(&number(x))).plus(&of.axes[1].scaled(&number(y)));
        let height = point.dot(&from.axes[2]);
        smooth.push(height.minus(&length(height.value())));
    }
    let mut value = S::constant(0.0);
    for (index, height) in smooth.iter().enumerate() {
        value = if index == 0 { height.absolute() } else { value.greater(&height.absolute()) };
    }
    Measured { value, smooth }
}
