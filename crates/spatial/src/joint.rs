//! Equations of the joints, by kind.

use crate::assembly::{FeatureKind, Joint, JointKind};
use crate::number::Number;
use crate::placement::PlacedFeature;

/// What an equation holds.
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
}

/// All equations that a joint of these features has: directions first.
pub(crate) fn equations<S: Number>(
    joint: &Joint,
    kinds: [FeatureKind; 2],
    [a, b]: [&PlacedFeature<S>; 2],
    numbers: &JointNumbers<S>,
) -> Vec<Equation<S>> {
    let across = b.origin.minus(&a.origin);
    let [x, y, z] = &a.axes;
    let direction = |name, residual| Equation { name, holds: Holds::Direction, residual };
    let distance = |name, residual| Equation { name, holds: Holds::Distance, residual };
    let tilts = || vec![direction("tilt about y", x.dot(&b.axes[2])), direction("tilt about x", y.dot(&b.axes[2]))];
    let offsets = || vec![distance("offset along x", across.dot(x)), distance("offset along y", across.dot(y))];
    match joint.kind {
        JointKind::Contact => {
            let off = across.dot(z).minus(&b.radius).minus(&numbers.value);
            let mut all = match kinds[1] {
                Plane => tilts(),
                Axis => vec![direction("tilt", z.dot(&b.axes[2]))],
                Point | Frame => Vec::new(),
            };
            all.push(distance("distance", off));
            all
        }
        JointKind::Pin => {
            // Where the axis of the pin passes the middle of the hole.
            let forward = across.dot(z).over(&b.axes[2].dot(z));
            let passes = across.minus(&b.axes[2].scaled(&forward));
            let mut all = tilts();
            all.push(distance("offset along x", passes.dot(x).minus(&numbers.offset[0])));
            all.push(distance("offset along y", passes.dot(y).minus(&numbers.offset[1])));
            all
        }
        JointKind::Slot => {
            let forward = across.dot(z).over(&b.axes[2].dot(z));
            let passes = across.minus(&b.axes[2].scaled(&forward));
            vec![
                direction("tilt across the slot", y.dot(&b.axes[2])),
                distance("offset across the slot", passes.dot(y).minus(&numbers.value)),
            ]
        }
        JointKind::Ball => {
            let mut all = offsets();
            all.push(distance("offset along z", across.dot(z)));
            all
        }
        JointKind::BallInHole => vec![
            distance("offset along x", across.dot(x).minus(&numbers.offset[0])),
            distance("offset along y", across.dot(y).minus(&numbers.offset[1])),
        ],
        JointKind::Round => {
            let apart = across.dot(x).length_with(&across.dot(y));
            let wanted = match joint.side_by_side {
                true => a.radius.plus(&b.radius),
                false => a.radius.minus(&b.radius).absolute(),
            };
            let mut all = tilts();
            all.push(distance("distance of the axes", apart.minus(&wanted).minus(&numbers.value)));
            all
        }
        JointKind::Crossed => {
            let normal = z.cross(&b.axes[2]);
            let apart = across.dot(&normal).over(&normal.length());
            let side = S::constant(if apart.value() < 0.0 { -1.0 } else { 1.0 });
            let wanted = a.radius.plus(&b.radius).plus(&numbers.value);
            vec![distance("distance of the axes", side.times(&apart).minus(&wanted))]
        }
        JointKind::Revolute => {
            let mut all = tilts();
            all.extend(offsets());
            all.push(distance("offset along z", across.dot(z)));
            all
        }
        JointKind::Slide => {
            let mut all = tilts();
            all.push(direction("turn about z", x.dot(&b.axes[1])));
            all.extend(offsets());
            all
        }
        JointKind::Rigid => {
            let mut all = tilts();
            all.push(direction("turn about z", x.dot(&b.axes[1])));
            all.extend(offsets());
            all.push(distance("offset along z", across.dot(z)));
            all
        }
        JointKind::Rod => vec![distance("length", across.length().minus(&numbers.value))],
        JointKind::Angle => {
            let (cosine, sine) = (b.axes[0].dot(x), b.axes[0].dot(y));
            let (turn_cosine, turn_sine) = (numbers.value.cosine(), numbers.value.sine());
            // The difference of the angles, which has no jump near 0.
            let ahead = sine.times(&turn_cosine).minus(&cosine.times(&turn_sine));
            let beside = cosine.times(&turn_cosine).plus(&sine.times(&turn_sine));
            vec![direction("angle", ahead.angle_over(&beside))]
        }
    }
}
