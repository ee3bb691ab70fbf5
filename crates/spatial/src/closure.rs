//! Nominal state of an assembly: the poses at which all joints close.

use faer::Mat;

use crate::assembly::{Assembly, FeatureId, JointKind, Quantity};
use crate::dual::Dual;
use crate::joint::{Equation, Holds, JointNumbers, equations, opening};
use crate::number::Number;
use crate::placement::{LocalFeature, Place, PlacedFeature, Pose, half_angle, product, rodrigues};
use crate::vector::Vector;

/// Greatest number of Newton steps.
const MOST: usize = 100;
/// Residual below which the joints are closed, as part of the size of the assembly.
const CLOSED: f64 = 1e-12;
/// Residual that rounding may leave after the last step that helps.
const NEARLY: f64 = 1e-9;
/// Greatest rotation of a part in one step, in radians: beyond it the linear prediction is worth nothing.
const TURN: f64 = 0.7;
/// Greatest number of halvings of a step that does not help.
const HALVINGS: usize = 12;
/// Singular value, as part of the largest, below which a direction is not determined.
pub(crate) const RANK: f64 = 1e-9;
/// Greatest number of choices of the equations of joints that take fewer freedoms than they could.
const CHOICES: usize = 4;

/// The equations of a joint that are used, by their places.
pub(crate) type Used = Vec<usize>;

/// An assembly with poses, and the equations that count.
#[derive(Clone)]
pub(crate) struct Closure<'a> {
    pub(crate) assembly: &'a Assembly,
    /// Indices of the parts that move, in the order of the unknowns.
    pub(crate) moving: Vec<usize>,
    /// Pose of every part.
    pub(crate) places: Vec<Place>,
    pub(crate) used: Vec<Used>,
    /// Length with which directions and distances are compared.
    pub(crate) size: f64,
}

/// Residuals and their derivatives, both without units.
pub(crate) struct Linear {
    /// Joint of every row.
    pub(crate) joints: Vec<usize>,
    /// Name of every row.
    pub(crate) names: Vec<&'static str>,
    pub(crate) residuals: Vec<f64>,
    pub(crate) jacobian: Mat<f64>,
}

impl<'a> Closure<'a> {
    pub(crate) fn new(assembly: &'a Assembly) -> Self {
        let start = |part: &crate::assembly::RigidPart| Place {
            rotation: constant_rotation(part.turned),
            translation: part.at,
        };
        Self {
            assembly,
            moving: assembly.moving(),
            places: assembly.parts.iter().map(start).collect(),
            used: vec![Vec::new(); assembly.joints.len()],
            size: assembly.size(),
        }
    }

    /// Poses with the six unknowns of every moving part: a half-angle vector from the present pose, and the place of the origin.
    pub(crate) fn poses(&self) -> Vec<Pose<Dual>> {
        let count = 6 * self.moving.len();
        let pose = |(part, place): (usize, &Place)| match self.moving.iter().position(|&moving| moving == part) {
            None => Pose::still(place),
            Some(index) => {
                let turn = Vector([0, 1, 2].map(|i| Dual::unknown(0.0, 6 * index + i, count)));
                let translation =
                    Vector([0, 1, 2].map(|i| Dual::unknown(place.translation[i], 6 * index + 3 + i, count)));
                Pose { rotation: Some(rodrigues(&turn)), start: place.rotation, translation }
            }
        };
        self.places.iter().enumerate().map(pose).collect()
    }

    pub(crate) fn placed(&self, poses: &[Pose<Dual>], id: FeatureId) -> PlacedFeature<Dual> {
        let number = |quantity: &Quantity| Dual::constant(quantity.value);
        poses[id.part].placed(&LocalFeature::new(self.assembly.feature(id), &number))
    }

    /// All equations of a joint at the present poses, one for each contact if it presses.
    pub(crate) fn equations(&self, poses: &[Pose<Dual>], joint: usize) -> Vec<Equation<Dual>> {
        let joint = &self.assembly.joints[joint];
        let kinds = joint.between.map(|id| self.assembly.feature(id).kind);
        let [a, b] = joint.between.map(|id| self.placed(poses, id));
        if let Some(press) = &joint.press {
            let gap = |&target: &FeatureId| opening(&a, &self.placed(poses, target));
            return press.targets.iter().map(gap).collect();
        }
        let value = |quantity: &Option<Quantity>| quantity.as_ref().map_or(0.0, |quantity| quantity.value);
        let two = |parts: &Option<[Quantity; 2]>| {
            parts.as_ref().map_or([0.0; 2], |parts| parts.each_ref().map(|part| part.value)).map(Dual::constant)
        };
        let numbers = JointNumbers {
            value: Dual::constant(value(&joint.value)),
            offset: two(&joint.offset),
            tilt: two(&joint.tilt),
        };
        equations(joint, kinds, [&a, &b], &numbers)
    }

    /// Quantity that an equation of a joint holds.
    pub(crate) fn holds(&self, joint: usize, place: usize) -> Holds {
        self.equations(&self.poses(), joint)[place].holds
    }

    /// Row of an equation: residual and derivatives in units of the assembly's size. The columns are rotations in radians and displacements
    /// in units of the size.
    pub(crate) fn row(&self, equation: &Equation<Dual>) -> (f64, Vec<f64>) {
        let unit = if equation.holds == Holds::Distance { self.size } else { 1.0 };
        (equation.residual.value() / unit, self.gradient(&equation.residual).iter().map(|slope| slope / unit).collect())
    }

    /// Derivatives of a number by rotations in radians and displacements in units of the size.
    pub(crate) fn gradient(&self, number: &Dual) -> Vec<f64> {
        // A half-angle vector is half a rotation.
        let scale = |column: usize| if column % 6 < 3 { 0.5 } else { self.size };
        (0..6 * self.moving.len()).map(|column| number.slope(column) * scale(column)).collect()
    }

    /// The equations that count, at the present poses.
    pub(crate) fn linear(&self) -> Linear {
        let poses = self.poses();
        let (mut joints, mut names, mut residuals, mut rows) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for joint in 0..self.assembly.joints.len() {
            let all = self.equations(&poses, joint);
            for &place in &self.used[joint] {
                let (residual, row) = self.row(&all[place]);
                joints.push(joint);
                names.push(all[place].name);
                residuals.push(residual);
                rows.push(row);
            }
        }
        let jacobian = Mat::from_fn(rows.len(), 6 * self.moving.len(), |i, j| rows[i][j]);
        Linear { joints, names, residuals, jacobian }
    }

    /// The first joint with a distance of 0, which has no derivatives. Returns None if there is none.
    pub(crate) fn without_direction(&self) -> Option<usize> {
        let linear = self.linear();
        let is_finite = |i: usize| (0..linear.jacobian.ncols()).all(|j| linear.jacobian[(i, j)].is_finite());
        (0..linear.joints.len()).find(|&i| !is_finite(i)).map(|i| linear.joints[i])
    }

    /// The first contact of two planes that leaves out a tilt although no joint before it holds one, so that the choice is arbitrary. Returns
    /// None if there is none.
    pub(crate) fn arbitrary_choice(&self) -> Option<usize> {
        let poses = self.poses();
        let mut before: Vec<Vec<f64>> = Vec::new();
        for index in 0..self.assembly.joints.len() {
            let all = self.equations(&poses, index);
            let rows: Vec<Vec<f64>> = all.iter().map(|equation| self.row(equation).1).collect();
            let used = &self.used[index];
            let is_direction = |place: &usize| all[*place].holds == Holds::Direction;
            let held = used.iter().filter(|place| is_direction(place)).count();
            let mut own = before.clone();
            for place in (0..all.len()).filter(|place| !is_direction(place)) {
                add_orthogonal(&mut own, &rows[place]);
            }
            let open =
                (0..all.len()).filter(is_direction).filter(|&place| add_orthogonal(&mut own, &rows[place])).count();
            let is_contact = self.assembly.joints[index].kind == JointKind::Contact;
            if is_contact && held > 0 && open > held {
                return Some(index);
            }
            for &place in used {
                add_orthogonal(&mut before, &rows[place]);
            }
        }
        None
    }

    /// Derivatives of the smooth numbers of a measure.
    pub(crate) fn measure_gradients(&self, measure: usize) -> Vec<Vec<f64>> {
        let poses = self.poses();
        let measure = &self.assembly.measures[measure];
        let kinds = measure.between.map(|id| self.assembly.feature(id).kind);
        let [of, from] = measure.between.map(|id| self.placed(&poses, id));
        let number = |quantity: &Quantity| Dual::constant(quantity.value);
        let measured = crate::measure::measured(&measure.kind, kinds, [&of, &from], (&number, &Dual::constant));
        measured.smooth.iter().map(|number| self.gradient(number)).collect()
    }

    /// Chooses the equations of every joint at the present poses. A joint that takes fewer freedoms than it could leaves out the direction
    /// that the equations before it determine most. Returns true if the choice has changed.
    fn choose(&mut self) -> bool {
        let poses = self.poses();
        let mut before: Vec<Vec<f64>> = Vec::new();
        let mut used = Vec::new();
        for (index, joint) in self.assembly.joints.iter().enumerate() {
            let all = self.equations(&poses, index);
            let rows: Vec<Vec<f64>> = all.iter().map(|equation| self.row(equation).1).collect();
            if let Some(press) = &joint.press {
                let chosen = self.resting(index, press, &before);
                for &row in &chosen {
                    add_orthogonal(&mut before, &rows[row]);
                }
                used.push(chosen);
                continue;
            }
            let directions = all.iter().filter(|equation| equation.holds == Holds::Direction).count();
            let takes = joint.takes.unwrap_or(all.len()).min(all.len());
            // The distances stay, and the directions are taken in the order of their new part.
            let wanted = takes.saturating_sub(all.len() - directions);
            let mut own = before.clone();
            for row in &rows[directions..] {
                add_orthogonal(&mut own, row);
            }
            let mut left: Vec<usize> = (0..directions).collect();
            let mut chosen: Vec<usize> = (directions..all.len()).collect();
            if wanted == directions {
                chosen.append(&mut left);
            }
            while chosen.len() < takes {
                let new = |&row: &usize| norm(&rest(&own, &rows[row]));
                // The first of equals, so that rounding does not choose.
                let mut best = 0;
                for place in 1..left.len() {
                    if new(&left[place]) > new(&left[best]) * (1.0 + 1e-6) + 1e-9 {
                        best = place;
                    }
                }
                let row = left.remove(best);
                add_orthogonal(&mut own, &rows[row]);
                chosen.push(row);
            }
            chosen.sort_unstable();
            for &row in &chosen {
                add_orthogonal(&mut before, &rows[row]);
            }
            used.push(chosen);
        }
        let changed = used != self.used;
        self.used = used;
        changed
    }

    /// Moves the parts until the joints close. Returns true if they do.
    pub(crate) fn close(&mut self) -> bool {
        let mut closed = false;
        for _ in 0..CHOICES {
            if !self.choose() && closed {
                break;
            }
            closed = self.search();
        }
        closed
    }

    /// Newton steps of least norm, so that a motion that no joint constrains is not changed.
    pub(crate) fn search(&mut self) -> bool {
        for _ in 0..MOST {
            let linear = self.linear();
            let off = largest(&linear.residuals);
            if off <= CLOSED {
                return true;
            }
            let step = least_step(&linear.jacobian, &linear.residuals);
            let turn = step.chunks(6).map(|part| norm(&part[..3])).fold(0.0, f64::max);
            let mut part = if turn > TURN { TURN / turn } else { 1.0 };
            let (before, goal) = (self.places.clone(), norm(&linear.residuals));
            let mut moved = false;
            for _ in 0..HALVINGS {
                self.places.clone_from(&before);
                self.advance(&step, part);
                if norm(&self.linear().residuals) < goal {
                    moved = true;
                    break;
                }
                part *= 0.5;
            }
            if !moved {
                self.places = before;
                return off <= NEARLY;
            }
        }
        largest(&self.linear().residuals) <= NEARLY
    }

    /// Moves every part by its share of a step.
    pub(crate) fn advance(&mut self, step: &[f64], part: f64) {
        for (index, &moving) in self.moving.iter().enumerate() {
            let place = &mut self.places[moving];
            let turn = [0, 1, 2].map(|i| part * step[6 * index + i]);
            place.rotation = product(&constant_rotation(turn), &place.rotation);
            (0..3).for_each(|i| place.translation[i] += part * step[6 * index + 3 + i] * self.size);
        }
    }
}

/// Rotation matrix of a rotation vector.
pub(crate) fn constant_rotation(vector: [f64; 3]) -> crate::placement::Rotation {
    let rows = rodrigues::<Dual>(&Vector::constant(half_angle(vector)));
    rows.map(|row| row.values())
}

/// Shortest step with the least residual, along the directions that are determined.
pub(crate) fn least_step(jacobian: &Mat<f64>, residuals: &[f64]) -> Vec<f64> {
    let columns = jacobian.ncols();
    let Ok(svd) = jacobian.thin_svd() else { return vec![0.0; columns] };
    let (u, s, v) = (svd.U(), svd.S().column_vector(), svd.V());
    let mut step = vec![0.0; columns];
    for k in (0..s.nrows()).filter(|&k| s[k] > RANK * s[0]) {
        let along: f64 = residuals.iter().enumerate().map(|(i, residual)| u[(i, k)] * residual).sum::<f64>() / s[k];
        (0..columns).for_each(|j| step[j] -= along * v[(j, k)]);
    }
    step
}

/// Length of a vector.
pub(crate) fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

fn largest(residuals: &[f64]) -> f64 {
    residuals
        .iter()
        .fold(0.0, |largest, residual| if residual.is_nan() { f64::INFINITY } else { largest.max(residual.abs()) })
}

/// Part of a row outside the span of orthonormal rows.
pub(crate) fn rest(basis: &[Vec<f64>], row: &[f64]) -> Vec<f64> {
    let mut rest = row.to_vec();
    // Twice, since the first pass leaves rounding of the size of the row.
    for _ in 0..2 {
        for known in basis {
            let along: f64 = known.iter().zip(&rest).map(|(a, b)| a * b).sum();
            rest.iter_mut().zip(known).for_each(|(rest, known)| *rest -= along * known);
        }
    }
    rest
}

/// Adds the new part of a row to orthonormal rows, if there is one. Returns true if there was.
pub(crate) fn add_orthogonal(basis: &mut Vec<Vec<f64>>, row: &[f64]) -> bool {
    new_part(basis, row) > RANK
}

/// Adds the new part of a row to orthonormal rows, if there is one. Returns its length as part of the row.
pub(crate) fn new_part(basis: &mut Vec<Vec<f64>>, row: &[f64]) -> f64 {
    let rest = rest(basis, row);
    let length = norm(&rest);
    let part = length / norm(row).max(RANK);
    if part > RANK {
        basis.push(rest.iter().map(|part| part / length).collect());
    }
    part
}
