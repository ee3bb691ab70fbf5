//! An assembly as closure equations: unknowns, equations, and formulas of measures.

use std::collections::BTreeMap;

use crate::assembly::{Assembly, FeatureId, FeatureKind, JointKind, PartJoint, Quantity};
use crate::closure::{Closure, constant_rotation};
use crate::error::SpatialError;
use crate::expression::Expression;
use crate::joint::{Holds, JointNumbers, equations};
use crate::measure::measured;
use crate::mobility::{FreeMotion, Mobility};
use crate::number::Number;
use crate::part_pose::PartPose;
use crate::placement::{LocalFeature, PlacedFeature, Pose, Rotation, half_angle, product, rodrigues, rotation_vector};
use crate::press::check_features;
use crate::pressed_contacts::{PressedContacts, PressedFeatures};
use crate::vector::Vector;

/// An unknown of a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseUnknown {
    /// Name, such as `shaft.x`.
    pub name: String,
    /// Value at the nominal dimensions.
    pub start: f64,
    /// True if it is a length; a half-angle vector has no unit.
    pub is_length: bool,
    /// Index of the part.
    pub part: usize,
}

/// A formula with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedFormula {
    /// Name of the formula.
    pub name: String,
    /// Text of the formula.
    pub formula: String,
    /// True if its value is a length.
    pub is_length: bool,
}

/// An assembly as closure equations with as many unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedAssembly {
    /// Unknowns of the poses, six for every part that moves.
    pub unknowns: Vec<PoseUnknown>,
    /// Equations of the joints with the index of each joint, and of the free motions without one.
    pub equations: Vec<(NamedFormula, Option<usize>)>,
    /// Formulas of places and directions, each with the index of its part.
    pub formulas: Vec<(NamedFormula, usize)>,
    /// Formula of every measure.
    pub measures: Vec<String>,
    /// Unknowns, equations and free motions.
    pub mobility: Mobility,
    /// Poses at the nominal dimensions.
    pub poses: Vec<PartPose>,
    /// Contacts of the joints that press.
    pub pressed: Vec<PressedContacts>,
}

/// Greatest rotation from the start, in radians, that one half-angle vector describes. Half a turn is singular.
const FAR: f64 = 1.6;

impl Assembly {
    /// A constant length in a formula.
    fn length(&self, value: f64) -> Expression {
        match &self.length_unit {
            Some(unit) if value != 0.0 => Expression::length(value, unit),
            _ => Expression::constant(value),
        }
    }

    /// Closes the joints at the nominal dimensions, and writes the assembly as equations. Needs no evaluation of a study.
    ///
    /// The poses are unknowns: a half-angle vector of the rotation from the start (Rodrigues, 1840), which is rational, and the place of the
    /// part's origin. A motion that no joint stops and no measure depends on gets an equation that holds it at its nominal place.
    ///
    /// # Errors
    /// Fails if a joint does not fit its features, if joints repeat others or do not close, or if a measure depends on a motion that no
    /// joint stops.
    ///
    /// ```
    /// use sensitol_spatial::{Assembly, Direction, Feature, FeatureId, FeatureKind, PartJoint, JointKind, Measure, MeasureKind, RigidPart, Quantity};
    /// let plane = |name: &str, height: f64, up: f64| Feature {
    ///     name: name.into(),
    ///     kind: FeatureKind::Plane,
    ///     origin: [0.0, 0.0, height].map(Quantity::constant),
    ///     z: Direction::Along([0.0, 0.0, up].map(Quantity::constant)),
    ///     x: None,
    ///     diameter: None,
    ///     shift: None,
    ///     tilt: None,
    /// };
    /// let part = |name: &str, ground, features| RigidPart { name: name.into(), ground, at: [0.0; 3], turned: [0.0; 3], features };
    /// let id = |part, feature| FeatureId { part, feature };
    /// let assembly = Assembly {
    ///     parts: vec![
    ///         part("table", true, vec![plane("top", 0.0, 1.0)]),
    ///         part("block", false, vec![plane("bottom", 0.0, -1.0), plane("lid", 25.0, 1.0)]),
    ///     ],
    ///     joints: vec![PartJoint {
    ///         name: "seat".into(), kind: JointKind::Contact, between: [id(0, 0), id(1, 0)],
    ///         takes: None, value: None, offset: None, tilt: None, side_by_side: false, press: None,
    ///     }],
    ///     length_unit: None,
    ///     shown_unit: None,
    ///     measures: vec![Measure { name: "height".into(), kind: MeasureKind::Distance, between: [id(1, 1), id(0, 0)] }],
    /// };
    /// let closed = assembly.close()?;
    /// assert_eq!((closed.mobility.unknowns, closed.mobility.equations, closed.mobility.free.len()), (6, 3, 3));
    /// # Ok::<(), sensitol_spatial::SpatialError>(())
    /// ```
    pub fn close(&self) -> Result<ClosedAssembly, SpatialError> {
        self.check()?;
        let mut closure = Closure::new(self);
        let closed = closure.close();
        if let Some(index) = closure.without_direction() {
            return Err(SpatialError::NoDirection { joint: self.joints[index].name.clone(), index });
        }
        if let Some(index) = closure.arbitrary_choice() {
            return Err(self.wrong_order(index));
        }
        closure.check_presses()?;
        let doubtful = closure.check_redundancy()?;
        if !closed {
            return Err(self.open(&closure));
        }
        closure.check_rocking()?;
        self.check_facing(&closure)?;
        let motions = closure.free_motions();
        closure.check_free(&motions)?;
        let mut closed = Writer::new(self, &closure).written(&motions);
        closed.mobility.doubtful = doubtful;
        Ok(closed)
    }

    /// Fault of a joint that leaves out a tilt before another one holds it.
    fn wrong_order(&self, index: usize) -> SpatialError {
        let joint = &self.joints[index];
        let all = |joint: &PartJoint| {
            let kinds = joint.between.map(|id| self.feature(id).kind);
            joint.kind.freedoms(kinds).map_or(0, |known| known[0])
        };
        let parts = |joint: &PartJoint| {
            let mut parts = joint.between.map(|id| id.part);
            parts.sort_unstable();
            parts
        };
        let is_primary = |other: &&PartJoint| {
            other.kind == joint.kind
                && parts(other) == parts(joint)
                && other.takes.is_none_or(|takes| takes == all(other))
        };
        SpatialError::WrongOrder {
            joint: joint.name.clone(),
            index,
            takes: joint.takes.unwrap_or(all(joint)),
            all: all(joint),
            primary: self.joints[index..].iter().find(is_primary).map(|other| other.name.clone()),
        }
    }

    /// Checks the kinds of features and the numbers of freedoms.
    fn check(&self) -> Result<(), SpatialError> {
        if self.moving().is_empty() {
            return Err(SpatialError::NothingMoves);
        }
        for (index, joint) in self.joints.iter().enumerate() {
            let name = joint.name.clone();
            let [a, b] = joint.between;
            if a.part == b.part || (self.parts[a.part].ground && self.parts[b.part].ground) {
                let what = match a.part == b.part {
                    true => format!("part `{}`", self.parts[a.part].name),
                    false => "parts that stand still".into(),
                };
                return Err(SpatialError::SamePart { joint: name, index, what });
            }
            if let Some(press) = &joint.press {
                let wrong = |fault| SpatialError::Press { joint: name.clone(), index, fault: Box::new(fault) };
                check_features(self, joint, press).map_err(wrong)?;
                continue;
            }
            let kinds = joint.between.map(|id| self.feature(id).kind);
            let Some(known) = joint.kind.freedoms(kinds) else {
                let shown = |id: FeatureId| format!("{} `{}`", self.feature(id).kind.name(), self.feature_name(id));
                let found = format!("{} and {}", shown(a), shown(b));
                return Err(SpatialError::Features { joint: name, index, found, expected: joint.kind.expected() });
            };
            if let Some(found) = joint.takes.filter(|takes| !known.contains(takes)) {
                let known = known.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
                return Err(SpatialError::Takes { joint: name, index, found, known });
            }
        }
        for index in self.moving() {
            if !self.joints.iter().any(|joint| joint.between.iter().any(|id| id.part == index)) {
                return Err(SpatialError::NoJoint { part: self.parts[index].name.clone(), index });
            }
        }
        Ok(())
    }

    /// Fault of joints that do not close.
    fn open(&self, closure: &Closure<'_>) -> SpatialError {
        let linear = closure.linear();
        let worst = (0..linear.residuals.len())
            .max_by(|&i, &j| linear.residuals[i].abs().total_cmp(&linear.residuals[j].abs()))
            .unwrap_or(0);
        let index = linear.joints.get(worst).copied().unwrap_or(0);
        let same_way = (0..self.joints.len()).find_map(|joint| self.same_way(closure, joint));
        SpatialError::Open {
            joint: self.joints[index].name.clone(),
            index,
            off: linear
                .residuals
                .get(worst)
                .map_or_else(String::new, |off| self.off(closure, (index, worst), off.abs())),
            equation: linear.names.get(worst).copied().unwrap_or(""),
            same_way: same_way.map(|features| format!("wrong sign of a normal? {features} look the same way")),
        }
    }

    /// Residual of an equation in words: a length, or an angle for a direction.
    fn off(&self, closure: &Closure<'_>, (joint, row): (usize, usize), residual: f64) -> String {
        let first: usize = closure.used[..joint].iter().map(Vec::len).sum();
        match closure.holds(joint, closure.used[joint][row - first]) {
            Holds::Direction => format!("{:.4} deg", libm::asin(residual.min(1.0)).to_degrees()),
            Holds::Distance => {
                let (unit, size) = self.shown_unit.as_ref().map_or(("", 1.0), |(unit, size)| (unit.as_str(), *size));
                let text = format!("{:.6} {unit}", residual * closure.size / size);
                text.trim_end().to_owned()
            }
        }
    }

    /// Names of the planes of a contact, if they look the same way.
    fn same_way(&self, closure: &Closure<'_>, joint: usize) -> Option<String> {
        let joint = &self.joints[joint];
        let planes = joint.between.iter().all(|&id| self.feature(id).kind == FeatureKind::Plane);
        if joint.kind != JointKind::Contact || !planes {
            return None;
        }
        let normals = joint.between.map(|id| {
            let number = |quantity: &Quantity| Expression::constant(quantity.value);
            let local = LocalFeature::new(self.feature(id), &number);
            Pose::still(&closure.places[id.part]).placed(&local).axes[2].values()
        });
        let along: f64 = (0..3).map(|i| normals[0][i] * normals[1][i]).sum();
        let names = joint.between.map(|id| format!("`{}`", self.feature_name(id)));
        (along > 0.5).then(|| format!("{} and {}", names[0], names[1]))
    }

    fn check_facing(&self, closure: &Closure<'_>) -> Result<(), SpatialError> {
        for index in 0..self.joints.len() {
            if let Some(features) = self.same_way(closure, index) {
                return Err(SpatialError::SameWay { joint: self.joints[index].name.clone(), index, features });
            }
        }
        Ok(())
    }
}

/// Writes the equations of an assembly whose nominal state is known.
struct Writer<'a> {
    assembly: &'a Assembly,
    closure: &'a Closure<'a>,
    unknowns: Vec<PoseUnknown>,
    formulas: Vec<(NamedFormula, usize)>,
    poses: Vec<Pose<Expression>>,
    features: BTreeMap<FeatureId, PlacedFeature<Expression>>,
}

impl<'a> Writer<'a> {
    fn new(assembly: &'a Assembly, closure: &'a Closure<'a>) -> Self {
        let mut writer = Self {
            assembly,
            closure,
            unknowns: Vec::new(),
            formulas: Vec::new(),
            poses: Vec::new(),
            features: BTreeMap::new(),
        };
        for part in 0..assembly.parts.len() {
            let pose = writer.pose(part);
            writer.poses.push(pose);
        }
        writer
    }

    /// Pose of a part, with its unknowns.
    fn pose(&mut self, part: usize) -> Pose<Expression> {
        let place = self.closure.places[part];
        if self.assembly.parts[part].ground {
            let translation = Vector(place.translation.map(|at| self.assembly.length(at)));
            return Pose { translation, ..Pose::still(&place) };
        }
        let name = &self.assembly.parts[part].name;
        let start = self.start(part);
        let turn = half_angle(rotation_vector(&product(&place.rotation, &transposed(&start))));
        let mut vectors = [turn, place.translation].into_iter().enumerate();
        let mut unknown = || {
            let (kind, values) = vectors.next().expect("a rotation and a displacement");
            let letters = [["rx", "ry", "rz"], ["x", "y", "z"]][kind];
            Vector([0, 1, 2].map(|i| {
                let (name, is_length) = (format!("{name}.{}", letters[i]), kind == 1);
                // Rounding of the search is no place.
                let least = if is_length { 1e-15 * self.closure.size } else { 1e-15 };
                let value = if values[i].abs() < least { 0.0 } else { values[i] };
                self.unknowns.push(PoseUnknown { name: name.clone(), start: value, is_length, part });
                Expression::name(&name, value)
            }))
        };
        let (turn, translation) = (unknown(), unknown());
        let rows = rodrigues(&turn);
        let mut number = 0;
        let name = name.clone();
        let rows = rows.map(|row| {
            row.map(|entry| {
                let place = format!("{name}.r{}{}", number / 3 + 1, number % 3 + 1);
                number += 1;
                self.named(place, (part, false), entry)
            })
        });
        Pose { rotation: Some(rows), start, translation }
    }

    /// Rotation from which the unknowns of a part start. The one that the study gives has simple numbers, and serves unless the part has
    /// turned far from it.
    fn start(&self, part: usize) -> Rotation {
        let start = constant_rotation(self.assembly.parts[part].turned);
        let reached = self.closure.places[part].rotation;
        let turn = rotation_vector(&product(&reached, &transposed(&start)));
        let far = turn.iter().map(|part| part * part).sum::<f64>().sqrt() > FAR;
        if far { reached } else { start }
    }

    /// Pose of a part as rotation vector and displacement.
    fn part_pose(&self, part: usize) -> PartPose {
        let (place, given) = (&self.closure.places[part], &self.assembly.parts[part]);
        PartPose {
            part: given.name.clone(),
            rotation: rotation_vector(&place.rotation),
            translation: place.translation,
            start: (!given.ground).then(|| rotation_vector(&self.start(part))),
        }
    }

    /// Gives a long formula a name, so that it is evaluated once.
    fn named(&mut self, name: String, (part, is_length): (usize, bool), formula: &Expression) -> Expression {
        if formula.is_short() {
            return formula.clone();
        }
        let short = Expression::name(&name, formula.value());
        self.formulas.push((NamedFormula { name, formula: formula.text(), is_length }, part));
        short
    }

    /// A feature at its place, with names for its coordinates.
    fn feature(&mut self, id: FeatureId) -> PlacedFeature<Expression> {
        if let Some(known) = self.features.get(&id) {
            return known.clone();
        }
        let local = LocalFeature::new(self.assembly.feature(id), &number);
        let placed = self.poses[id.part].placed(&local);
        let name = self.assembly.feature_name(id);
        let letters = ["x", "y", "z"];
        let mut vector = |what: &str, vector: &Vector<Expression>| {
            let mut place = 0;
            vector.map(|part| {
                let name = format!("{name}.{what}{}", letters[place]);
                place += 1;
                self.named(name, (id.part, what == "p"), part)
            })
        };
        let origin = vector("p", &placed.origin);
        let axes = [0, 1, 2].map(|axis| vector(letters[axis], &placed.axes[axis]));
        let named = PlacedFeature { origin, axes, radius: placed.radius };
        self.features.insert(id, named.clone());
        named
    }

    fn written(mut self, motions: &[FreeMotion]) -> ClosedAssembly {
        let (mut lines, mut pressed) = (Vec::new(), Vec::new());
        for (index, joint) in self.assembly.joints.iter().enumerate() {
            if let Some(press) = &joint.press {
                let targets = press.targets.iter().map(|&target| self.feature(target)).collect();
                let features = PressedFeatures { plane: self.feature(joint.between[0]), targets };
                let part = (press.targets[0].part, true);
                let closure = self.closure;
                let named = |name: String, formula: &Expression| self.named(name, part, formula);
                let (equations, contacts) = closure.pressed(index, press, &features, named);
                let line = |(name, formula)| (NamedFormula { name, formula, is_length: true }, Some(index));
                lines.extend(equations.into_iter().map(line));
                pressed.push(contacts);
                continue;
            }
            let kinds = joint.between.map(|id| self.assembly.feature(id).kind);
            let [a, b] = joint.between.map(|id| self.feature(id));
            let zero = || Expression::constant(0.0);
            let two = |parts: &Option<[Quantity; 2]>| match parts {
                Some(parts) => parts.each_ref().map(number),
                None => [zero(), zero()],
            };
            let numbers = JointNumbers {
                value: joint.value.as_ref().map_or_else(zero, number),
                offset: two(&joint.offset),
                tilt: two(&joint.tilt),
            };
            let all = equations(joint, kinds, [&a, &b], &numbers);
            for &place in &self.closure.used[index] {
                let name = format!("{}: {}", joint.name, all[place].name);
                let is_length = all[place].holds == Holds::Distance;
                let formula = all[place].residual.text();
                lines.push((NamedFormula { name, formula, is_length }, Some(index)));
            }
        }
        debug_assert!(lines.len() + motions.len() == self.unknowns.len());
        let equations = lines.len();
        for motion in motions {
            let name = format!("free: {}", motion.text);
            let formula = self.held(&motion.vector).text();
            lines.push((NamedFormula { name, formula, is_length: false }, None));
        }
        let poses = (0..self.assembly.parts.len()).map(|part| self.part_pose(part)).collect();
        let mut measures = Vec::new();
        for measure in &self.assembly.measures {
            let kinds = measure.between.map(|id| self.assembly.feature(id).kind);
            let [of, from] = measure.between.map(|id| self.feature(id));
            measures.push(
                measured(&measure.kind, kinds, [&of, &from], (&number, &|value| self.assembly.length(value)))
                    .value
                    .text(),
            );
        }
        let texts: Vec<&str> =
            lines.iter().map(|(line, _)| line.formula.as_str()).chain(measures.iter().map(String::as_str)).collect();
        let formulas = needed(self.formulas, &texts);
        ClosedAssembly {
            mobility: Mobility {
                parts: self.assembly.parts.len(),
                joints: self.assembly.joints.len(),
                unknowns: self.unknowns.len(),
                equations,
                free: motions.iter().map(|motion| motion.text.clone()).collect(),
                doubtful: Vec::new(),
            },
            poses,
            pressed,
            unknowns: self.unknowns,
            equations: lines,
            formulas,
            measures,
        }
    }

    /// Equation that holds a free motion at its nominal place.
    fn held(&self, vector: &[f64]) -> Expression {
        let mut sum = Expression::constant(0.0);
        for (index, unknown) in self.unknowns.iter().enumerate().filter(|&(index, _)| vector[index].abs() > 1e-12) {
            let start = if unknown.is_length {
                self.assembly.length(unknown.start)
            } else {
                Expression::constant(unknown.start)
            };
            let moved = Expression::name(&unknown.name, unknown.start).minus(&start);
            // A displacement counts in units of the size, a half-angle vector twice.
            let moved = match unknown.is_length {
                true => moved.over(&self.assembly.length(self.closure.size)),
                false => Expression::constant(2.0).times(&moved),
            };
            sum = sum.plus(&Expression::constant(vector[index]).times(&moved));
        }
        sum
    }
}

/// A quantity as formula.
fn number(quantity: &Quantity) -> Expression {
    match &quantity.formula {
        None => Expression::constant(quantity.value),
        Some(text) => Expression::formula(text, quantity.value),
    }
}

/// Rotation back.
fn transposed(rotation: &Rotation) -> Rotation {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| rotation[j][i]))
}

/// The formulas that some text uses, directly or through others. A formula stands behind those that it uses.
fn needed(formulas: Vec<(NamedFormula, usize)>, texts: &[&str]) -> Vec<(NamedFormula, usize)> {
    let mut kept: Vec<(NamedFormula, usize)> = Vec::new();
    for (formula, part) in formulas.into_iter().rev() {
        let name = format!("`{}`", formula.name);
        let used = texts.iter().any(|text| text.contains(&name))
            || kept.iter().any(|(other, _)| other.formula.contains(&name));
        if used {
            kept.push((formula, part));
        }
    }
    kept.reverse();
    kept
}
