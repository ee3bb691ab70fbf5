//! Joints that press a part against contacts: the sets of contacts that can carry the force, and the one on which the part rests.
//!
//! Small motions `u` that the joints before leave open the contacts by `gap_i + r_i u >= 0`. The part goes as far along the force `f` as the
//! contacts allow: a linear program of one row a contact. Its dual has as many forces at a time as there are motions, with
//! `f + sum of mu_i r_i = 0` and `mu >= 0`. Such a set `T` of contacts would push the part back by `-sum of mu_i gap_i`, and the part rests on
//! the set that pushes most (duality of linear programming). The lever arms are those at the nominal sizes, so the sets that can carry the
//! force are listed once.

use crate::assembly::{FeatureId, PartJoint, Press};
use crate::closure::{Closure, add_orthogonal, norm, rest};
use crate::dual::Dual;
use crate::error::SpatialError;
use crate::number::Number;
use crate::placement::Pose;
use crate::press_fault::PressFault;
use crate::vector::Vector;

/// Greatest number of contacts of a joint: they have 220 sets of three, of which at most 72 carry a force.
const MOST_CONTACTS: usize = 12;
/// Part of the force that is moved to the first contact, with less for each further one, so that two contacts give distinct sets. It
/// decides among sets of equal push only.
const NUDGE: f64 = 1e-8;
/// Part of the force that counts as none at a contact: the part could rock about the line of the others.
const NOTHING: f64 = 1e-6;
/// Part of the force along the plane that is left to friction: that of a plane tilted by a degree at the nominal sizes.
const FRICTION: f64 = 0.02;
/// Part of the force that rounding leaves along motions that no contact stops.
const ROUNDING: f64 = 1e-9;
/// Advantage of a set, in sizes of the assembly, that counts for the choice at the nominal sizes.
const AHEAD: f64 = 1e-12;
/// Effect of a rocking motion on a measure, as part of the greatest possible one, that counts as none.
const UNFELT: f64 = 1e-7;

/// Set of contacts that can carry the force.
#[derive(Debug, Clone)]
pub(crate) struct ContactSet {
    /// Places of the contacts in the list of the joint, ascending.
    pub(crate) contacts: Vec<usize>,
    /// Forces at the contacts, as parts of the whole force, with the nudge.
    pub(crate) forces: Vec<f64>,
    /// Contacts, as places in the set, without a force. The part could rock off them.
    pub(crate) idle: Vec<usize>,
    /// Motions of length 1 that open one contact of the set each, as columns by the coordinates of the motions.
    pub(crate) inverse: Vec<Vec<f64>>,
}

/// Contacts of a joint that presses, by the motions that the joints before it leave.
pub(crate) struct PressRows {
    /// Openings of the contacts by the coordinates of the motions.
    rows: Vec<Vec<f64>>,
    /// Force that the contacts carry, by the same coordinates.
    load: Vec<f64>,
    /// Part of the force along motions that no contact and no joint before stops.
    sliding: f64,
    /// Number of motions that the contacts could stop without the joints before.
    own: usize,
}

impl PressRows {
    /// Rows of the contacts at the present poses. `before` spans the rows of the joints before, and `gaps` those of the contacts.
    fn new(before: &[Vec<f64>], gaps: &[Vec<f64>], force: &[f64]) -> Self {
        let (mut own, mut basis) = (Vec::new(), Vec::new());
        for gap in gaps {
            add_orthogonal(&mut own, gap);
            let left = rest(before, gap);
            // What rounding leaves of a row that the joints before hold is no motion.
            if norm(&left) > ROUNDING * norm(gap) {
                add_orthogonal(&mut basis, &left);
            }
        }
        let force = rest(before, force);
        let coordinates = |row: &[f64]| -> Vec<f64> {
            basis.iter().map(|motion: &Vec<f64>| motion.iter().zip(row).map(|(a, b)| a * b).sum()).collect()
        };
        Self {
            rows: gaps.iter().map(|gap| coordinates(gap)).collect(),
            load: coordinates(&force).into_iter().map(|part| -part).collect(),
            sliding: norm(&rest(&basis, &force)),
            own: own.len(),
        }
    }

    /// Number of motions that the contacts stop.
    fn motions(&self) -> usize {
        self.load.len()
    }

    /// Sets of contacts that can carry the force, in the order of the contacts.
    pub(crate) fn sets(&self) -> Vec<ContactSet> {
        self.carrying(&self.load)
    }

    /// Sets of contacts that can carry a load.
    fn carrying(&self, load: &[f64]) -> Vec<ContactSet> {
        let size = norm(load);
        if self.motions() == 0 || size == 0.0 {
            return Vec::new();
        }
        let mut nudged = load.to_vec();
        for (index, row) in self.rows.iter().enumerate() {
            // No two parts are equal, so that symmetric contacts leave no tie.
            let part =
                NUDGE * (1.0 - 0.618_033_988_749_895 * index as f64 / self.rows.len() as f64) / (1 + index) as f64;
            let length = norm(row).max(ROUNDING);
            nudged.iter_mut().zip(row).for_each(|(nudged, row)| *nudged += part * size * row / length);
        }
        let mut found = Vec::new();
        for contacts in combinations(self.rows.len(), self.motions()) {
            let Some(inverse) = inverse(&contacts.iter().map(|&contact| &self.rows[contact][..]).collect::<Vec<_>>())
            else {
                continue;
            };
            // The forces solve G^T mu = load.
            let forces = |load: &[f64]| -> Vec<f64> {
                (0..contacts.len()).map(|i| (0..load.len()).map(|q| inverse[q][i] * load[q]).sum()).collect()
            };
            let (plain, nudged) = (forces(load), forces(&nudged));
            if nudged.iter().all(|&force| force > 0.0) {
                let idle = (0..contacts.len()).filter(|&i| plain[i].abs() <= NOTHING * size).collect();
                found.push(ContactSet { contacts, forces: nudged, idle, inverse });
            }
        }
        found
    }
}

impl ContactSet {
    /// Distance by which the set pushes the part back against the force.
    pub(crate) fn push(&self, gaps: &[f64]) -> f64 {
        -self.contacts.iter().zip(&self.forces).map(|(&contact, force)| force * gaps[contact]).sum::<f64>()
    }

    /// Contacts that carry a part of the force.
    pub(crate) fn carrying(&self) -> impl Iterator<Item = usize> {
        (0..self.contacts.len()).filter(|place| !self.idle.contains(place)).map(|place| self.contacts[place])
    }
}

impl Closure<'_> {
    /// Rows of a joint that presses at the present poses. `before` spans the rows of the joints before it.
    pub(crate) fn press_rows(&self, joint: usize, press: &Press, before: &[Vec<f64>]) -> PressRows {
        let poses = self.poses();
        let gaps: Vec<Vec<f64>> = self.equations(&poses, joint).iter().map(|equation| self.row(equation).1).collect();
        let along = Vector::<Dual>::constant(press.force);
        let force = self.force_point(&poses, &self.assembly.joints[joint], press).dot(&along);
        let force: Vec<f64> = self.gradient(&force).iter().map(|slope| slope / self.size).collect();
        PressRows::new(before, &gaps, &force)
    }

    /// Point at which the force acts: the given feature, or the middle of the contacts, or the origin of the plane of the pressed part.
    fn force_point(&self, poses: &[Pose<Dual>], joint: &PartJoint, press: &Press) -> Vector<Dual> {
        let origin = |id: FeatureId| self.placed(poses, id).origin;
        match press.weight {
            Some(id) => origin(id),
            None if press.part(self.assembly, joint) == joint.between[0].part => origin(joint.between[0]),
            None => {
                let sum = press.targets[1..].iter().fold(origin(press.targets[0]), |sum, &id| sum.plus(&origin(id)));
                sum.scaled(&Dual::constant(1.0 / press.targets.len() as f64))
            }
        }
    }

    /// Contacts on which the part rests at the present poses, ascending. If no set carries the force, the first contacts that are independent.
    pub(crate) fn resting(&self, joint: usize, press: &Press, before: &[Vec<f64>]) -> Vec<usize> {
        let rows = self.press_rows(joint, press, before);
        let equations = self.equations(&self.poses(), joint);
        let gaps: Vec<f64> = equations.iter().map(|equation| equation.residual.value() / self.size).collect();
        let sets = rows.sets();
        let Some(mut best) = sets.first() else {
            let mut basis = Vec::new();
            return (0..gaps.len()).filter(|&contact| add_orthogonal(&mut basis, &rows.rows[contact])).collect();
        };
        for set in &sets[1..] {
            if set.push(&gaps) > best.push(&gaps) + AHEAD {
                best = set;
            }
        }
        best.contacts.clone()
    }

    /// Orthonormal rows of the joints before one.
    pub(crate) fn rows_before(&self, joint: usize) -> Vec<Vec<f64>> {
        let poses = self.poses();
        let mut before = Vec::new();
        for index in 0..joint {
            let all = self.equations(&poses, index);
            for &place in &self.used[index] {
                add_orthogonal(&mut before, &self.row(&all[place]).1);
            }
        }
        before
    }

    /// Checks that contacts stop every part that is pressed.
    pub(crate) fn check_presses(&self) -> Result<(), SpatialError> {
        for (index, joint) in self.assembly.joints.iter().enumerate() {
            let Some(press) = &joint.press else { continue };
            let wrong = |fault: PressFault| {
                Err(SpatialError::Press { joint: joint.name.clone(), index, fault: Box::new(fault) })
            };
            let part = || self.assembly.parts[press.part(self.assembly, joint)].name.clone();
            let rows = self.press_rows(index, press, &self.rows_before(index));
            if rows.own < 3 {
                return wrong(PressFault::InLine { contacts: self.assembly.contact_names(press) });
            }
            if rows.motions() == 0 {
                return wrong(PressFault::NothingLeft { part: part() });
            }
            if rows.sliding > FRICTION {
                let plane = self.assembly.feature_name(joint.between[0]);
                return wrong(PressFault::Slides { part: part(), plane });
            }
            if rows.sets().is_empty() {
                let back: Vec<f64> = rows.load.iter().map(|part| -part).collect();
                return match rows.carrying(&back).is_empty() {
                    true => wrong(PressFault::Tips { part: part() }),
                    false => wrong(PressFault::Away { part: part() }),
                };
            }
        }
        Ok(())
    }

    /// Checks that no measure depends on the side to which a part rocks. No joint may repeat others.
    pub(crate) fn check_rocking(&self) -> Result<(), SpatialError> {
        for (index, joint) in self.assembly.joints.iter().enumerate() {
            let Some(press) = &joint.press else { continue };
            let contacts = self.assembly.contact_names(press);
            for set in self.press_rows(index, press, &self.rows_before(index)).sets() {
                let Some(measure) = self.felt_rocking(index, &set) else { continue };
                let fault = PressFault::Rocks {
                    part: self.assembly.parts[press.part(self.assembly, joint)].name.clone(),
                    about: set.carrying().map(|contact| contacts[contact].clone()).collect(),
                    measure: self.assembly.measures[measure].name.clone(),
                };
                return Err(SpatialError::Press { joint: joint.name.clone(), index, fault: Box::new(fault) });
            }
        }
        Ok(())
    }

    /// The first measure that depends on a motion that opens a contact without a force. Returns None if there is none.
    fn felt_rocking(&self, joint: usize, set: &ContactSet) -> Option<usize> {
        if set.idle.is_empty() {
            return None;
        }
        let mut resting = self.clone();
        resting.used[joint].clone_from(&set.contacts);
        let linear = resting.linear();
        let first = linear.joints.iter().position(|&of| of == joint)?;
        for &idle in &set.idle {
            let opened: Vec<f64> =
                (0..linear.joints.len()).map(|row| if row == first + idle { -1.0 } else { 0.0 }).collect();
            let motion = crate::closure::least_step(&linear.jacobian, &opened);
            for measure in 0..self.assembly.measures.len() {
                for gradient in resting.measure_gradients(measure) {
                    let along: f64 = gradient.iter().zip(&motion).map(|(a, b)| a * b).sum();
                    if along.abs() > UNFELT * norm(&gradient) * norm(&motion) {
                        return Some(measure);
                    }
                }
            }
        }
        None
    }
}

/// Ascending choices of `count` among `all`.
fn combinations(all: usize, count: usize) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut chosen: Vec<usize> = (0..count).collect();
    if count > all {
        return found;
    }
    loop {
        found.push(chosen.clone());
        let Some(place) = (0..count).rev().find(|&place| chosen[place] < all - count + place) else { return found };
        chosen[place] += 1;
        for next in place + 1..count {
            chosen[next] = chosen[next - 1] + 1;
        }
    }
}

/// Inverse of a matrix by rows. Returns None if a row lies in the span of those before it.
fn inverse(rows: &[&[f64]]) -> Option<Vec<Vec<f64>>> {
    use faer::linalg::solvers::DenseSolveCore;
    let mut basis = Vec::new();
    if !rows.iter().all(|row| add_orthogonal(&mut basis, row)) {
        return None;
    }
    let n = rows.len();
    let inverse = faer::Mat::from_fn(n, n, |i, j| rows[i][j]).partial_piv_lu().inverse();
    Some((0..n).map(|i| (0..n).map(|j| inverse[(i, j)]).collect()).collect())
}

/// Checks the features of a joint that presses.
pub(crate) fn check_features(
    assembly: &crate::assembly::Assembly,
    joint: &PartJoint,
    press: &Press,
) -> Result<(), PressFault> {
    let name = |id: FeatureId| assembly.feature_name(id);
    let (plane, targets) = (joint.between[0], &press.targets);
    if assembly.feature(plane).kind != crate::assembly::FeatureKind::Plane {
        return Err(PressFault::NoPlane { feature: name(plane), kind: assembly.feature(plane).kind.name() });
    }
    for (place, &target) in targets.iter().enumerate() {
        if assembly.feature(target).kind != crate::assembly::FeatureKind::Point {
            return Err(PressFault::NoPoint { feature: name(target), kind: assembly.feature(target).kind.name() });
        }
        if targets[..place].contains(&target) {
            return Err(PressFault::Twice { feature: name(target) });
        }
        if target.part != targets[0].part || target.part == plane.part {
            return Err(PressFault::OtherPart { feature: name(target), plane: name(plane) });
        }
    }
    if targets.len() < 3 || targets.len() > MOST_CONTACTS {
        return Err(PressFault::Count { found: targets.len(), most: MOST_CONTACTS });
    }
    let part = press.part(assembly, joint);
    let owners = [plane.part, targets[0].part];
    if assembly.parts[part].ground || !owners.contains(&part) {
        let weight = press.weight.map_or_else(|| assembly.parts[part].name.clone(), name);
        return Err(PressFault::Still { weight });
    }
    Ok(())
}
