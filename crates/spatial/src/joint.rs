//! Equations of the joints, by kind.

use crate::assembly::{FeatureKind, JointKind, PartJoint};
use crate::number::Number;
use crate::placement::PlacedFeature;
use crate::vector::Vector;

/// Quantity that an equation holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holds {
    /// A direction; the residual has no unit.
    Direction,
    /// A distance; the residual is a length.
    Distance,
}

/// An equation of a joint: its residual is 0 in the assembly.
#[derive(Debug, Clone)]
pub(crate) struct Equation<S> {
    pub(crate) name: &'static str,
    pub(crate) holds: Holds,
    pub(crate) residual: S,
}

/// A row of the joint table.
pub(crate) struct JointRow {
    pub(crate) kind: JointKind,
    /// Kinds of the two features that fit, with the number of freedoms that such a joint can take, the default first.
    pub(crate) fits: &'static [(&'static [FeatureKind], &'static [FeatureKind], &'static [usize])],
}

use FeatureKind::{Axis, Frame, Plane, Point};

/// The joints: which features they connect, and how many freedoms they take.
pub(crate) const JOINTS: [JointRow; 12] = [
    JointRow {
        kind: JointKind::Contact,
        fits: &[(&[Plane], &[Plane], &[3, 2, 1]), (&[Plane], &[Axis], &[2, 1]), (&[Plane], &[Point], &[1])],
    },
    JointRow { kind: JointKind::Pin, fits: &[(&[Axis], &[Axis], &[4, 2])] },
    JointRow { kind: JointKind::Slot, fits: &[(&[Frame], &[Axis], &[2, 1])] },
    JointRow { kind: JointKind::Ball, fits: &[(&[Point], &[Point], &[3])] },
    JointRow { kind: JointKind::BallInHole, fits: &[(&[Axis], &[Point], &[2])] },
    JointRow { kind: JointKind::Round, fits: &[(&[Axis], &[Axis], &[3, 2, 1])] },
    JointRow { kind: JointKind::Crossed, fits: &[(&[Axis], &[Axis], &[1])] },
    JointRow { kind: JointKind::Revolute, fits: &[(&[Frame, Axis], &[Frame, Axis], &[5])] },
    JointRow { kind: JointKind::Slide, fits: &[(&[Frame], &[Frame], &[5])] },
    JointRow { kind: JointKind::Rigid, fits: &[(&[Frame], &[Frame], &[6])] },
    JointRow { kind: JointKind::Rod, fits: &[(&[Point], &[Point], &[1])] },
    JointRow { kind: JointKind::Angle, fits: &[(&[Frame], &[Frame], &[1])] },
];

impl JointKind {
    /// Numbers of freedoms that a joint of these features can take, the default first. Returns None if the features do not fit.
    pub fn freedoms(self, features: [FeatureKind; 2]) -> Option<&'static [usize]> {
        let row = JOINTS.iter().find(|row| row.kind == self)?;
        let fits = row.fits.iter().find(|(a, b, _)| a.contains(&features[0]) && b.contains(&features[1]))?;
        Some(fits.2)
    }

    /// Kinds of features that a joint of this kind connects, in words.
    pub fn expected(self) -> String {
        let row = JOINTS.iter().find(|row| row.kind == self);
        let kinds = |kinds: &[FeatureKind]| {
            kinds.iter().map(|kind| format!("{} {}", article(*kind), kind.name())).collect::<Vec<_>>().join(" or ")
        };
        let pair = |(a, b, _): &(&[FeatureKind], &[FeatureKind], &[usize])| format!("{} and {}", kinds(a), kinds(b));
        row.map_or(String::new(), |row| row.fits.iter().map(pair).collect::<Vec<_>>().join(", or "))
    }
}

/// The indefinite article of a kind.
fn article(kind: FeatureKind) -> &'static str {
    if kind == Axis { "an" } else { "a" }
}

/// Numbers of a joint.
pub(crate) struct JointNumbers<S> {
    /// Gap, length or angle.
    pub(crate) value: S,
    pub(crate) offset: [S; 2],
    pub(crate) tilt: [S; 2],
}

/// All equations that a joint of these features has: directions first.
pub(crate) fn equations<S: Number>(
    joint: &PartJoint,
    kinds: [FeatureKind; 2],
    [a, b]: [&PlacedFeature<S>; 2],
    numbers: &JointNumbers<S>,
) -> Vec<Equation<S>> {
    let across = b.origin.minus(&a.origin);
    let [x, y, z] = &a.axes;
    let tilts = || vec![direction("tilt about y", x.dot(&b.axes[2])), direction("tilt about x", y.dot(&b.axes[2]))];
    let turn = || direction("turn about z", x.dot(&b.axes[1]));
    let offsets = || vec![distance("offset along x", across.dot(x)), distance("offset along y", across.dot(y))];
    let along = || distance("offset along z", across.dot(z));
    match joint.kind {
        JointKind::Contact => {
            let mut all = match kinds[1] {
                Plane => tilts(),
                Axis => vec![direction("tilt", z.dot(&b.axes[2]))],
                Point | Frame => Vec::new(),
            };
            all.push(distance("distance", across.dot(z).minus(&b.radius).minus(&numbers.value)));
            all
        }
        JointKind::Pin => {
            let passes = passing([a, b]);
            let mut all = tilts();
            // A tilt of 0 leaves no term, so that the equations stay short.
            if joint.tilt.is_some() {
                let slopes = all.iter_mut().zip(&numbers.tilt);
                slopes.for_each(|(equation, slope)| equation.residual = equation.residual.minus(slope));
            }
            all.push(distance("offset along x", passes.dot(x).minus(&numbers.offset[0])));
            all.push(distance("offset along y", passes.dot(y).minus(&numbers.offset[1])));
            all
        }
        JointKind::Slot => vec![
            direction("tilt across the slot", y.dot(&b.axes[2])),
            distance("offset across the slot", passing([a, b]).dot(y).minus(&numbers.value)),
        ],
        JointKind::Ball => [offsets(), vec![along()]].concat(),
        JointKind::BallInHole => vec![
            distance("offset along x", across.dot(x).minus(&numbers.offset[0])),
            distance("offset along y", across.dot(y).minus(&numbers.offset[1])),
        ],
        JointKind::Round => {
            let mut all = tilts();
            all.push(distance("distance of the axes", off_round(joint, [a, b], numbers)));
            all
        }
        JointKind::Crossed => vec![distance("distance of the axes", off_crossed([a, b], numbers))],
        JointKind::Revolute => [tilts(), offsets(), vec![along()]].concat(),
        JointKind::Slide => [tilts(), vec![turn()], offsets()].concat(),
        JointKind::Rigid => [tilts(), vec![turn()], offsets(), vec![along()]].concat(),
        JointKind::Rod => vec![distance("length", across.length().minus(&numbers.value))],
        JointKind::Angle => vec![direction("angle", ahead([a, b], &numbers.value))],
    }
}

/// Opening of a contact that a force presses: the distance of a point from a plane, less its radius.
pub(crate) fn opening<S: Number>(plane: &PlacedFeature<S>, point: &PlacedFeature<S>) -> Equation<S> {
    let apart = point.origin.minus(&plane.origin).dot(&plane.axes[2]);
    distance("contact", apart.minus(&point.radius))
}

fn direction<S>(name: &'static str, residual: S) -> Equation<S> {
    Equation { name, holds: Holds::Direction, residual }
}

fn distance<S>(name: &'static str, residual: S) -> Equation<S> {
    Equation { name, holds: Holds::Distance, residual }
}

/// Place from the middle of a hole or slot at which the axis of the pin passes it.
fn passing<S: Number>([a, b]: [&PlacedFeature<S>; 2]) -> Vector<S> {
    let across = b.origin.minus(&a.origin);
    let forward = across.dot(&a.axes[2]).over(&b.axes[2].dot(&a.axes[2]));
    across.minus(&b.axes[2].scaled(&forward))
}

/// Distance of the axes of two round surfaces, less the one at which they touch.
fn off_round<S: Number>(joint: &PartJoint, [a, b]: [&PlacedFeature<S>; 2], numbers: &JointNumbers<S>) -> S {
    let across = b.origin.minus(&a.origin);
    let apart = across.dot(&a.axes[0]).length_with(&across.dot(&a.axes[1]));
    let wanted = match joint.side_by_side {
        true => a.radius.plus(&b.radius),
        false => a.radius.minus(&b.radius).absolute(),
    };
    apart.minus(&wanted).minus(&numbers.value)
}

/// Distance of two skew axes, less the one at which their surfaces touch.
fn off_crossed<S: Number>([a, b]: [&PlacedFeature<S>; 2], numbers: &JointNumbers<S>) -> S {
    let normal = a.axes[2].cross(&b.axes[2]);
    let apart = b.origin.minus(&a.origin).dot(&normal).over(&normal.length());
    // The side on which the other axis lies at the present poses.
    let side = S::constant(if apart.value() < 0.0 { -1.0 } else { 1.0 });
    side.times(&apart).minus(&a.radius.plus(&b.radius).plus(&numbers.value))
}

/// Angle by which x of the second frame is ahead of a driven angle from x of the first one. It has no jump near 0.
fn ahead<S: Number>([a, b]: [&PlacedFeature<S>; 2], angle: &S) -> S {
    let (cosine, sine) = (b.axes[0].dot(&a.axes[0]), b.axes[0].dot(&a.axes[1]));
    let ahead = sine.times(&angle.cosine()).minus(&cosine.times(&angle.sine()));
    let beside = cosine.times(&angle.cosine()).plus(&sine.times(&angle.sine()));
    ahead.angle_over(&beside)
}
