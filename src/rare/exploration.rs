//! Exploration of the model before any points are drawn. It finds rejects that the surrogate does not predict, and a
//! bound if there are none.
//!
//! Groups of points are drawn from the inputs' own density, from wider ones `N(0, s^2)` in normal space, and beside the
//! switches of the model. No estimate rests on these points. They show where to draw.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::Columns;
use crate::estimate::seldom_points;
use crate::estimate::strata::length;
use crate::rare::design_point::{BEFORE, FARTHEST, Place, unit};
use crate::rare::model::{Answers, Model};
use crate::rare::plain_points::PlainPoints;
use crate::rare::target::Target;
use crate::rare::unmet::{Group, Unmet};
use sensitol_numeric::distribution::standard_normal;

/// Groups: the width in sigmas, and the part of all points. Wide ones meet a corner of three dimensions, narrow ones a
/// state that ends again farther out.
const GROUPS: [(f64, f64); 5] = [(1.0, 0.03), (1.5, 0.03), (2.0, 0.04), (3.0, 0.06), (4.0, 0.04)];
/// Groups for more than `MANY_VARIABLES` variables. Half of their points are modest, because all points of a wide group
/// lie far out there.
const MODEST_GROUPS: [(f64, f64); 4] = [(1.0, 0.04), (1.2, 0.03), (1.5, 0.03), (3.0, 0.06)];
/// Number of variables above which the modest widths are used.
const MANY_VARIABLES: usize = 30;
/// Width of a further group for limits that nothing has reached, relative to the widest group.
const WIDER: f64 = 2.0;
/// Part of all points for that group.
const LARGER: f64 = 0.1;
/// Part of all points for those beside switches, at most.
const BESIDE: f64 = 0.08;
/// Factor of all parts for few points, which leave a wide bound.
const SPARSE: f64 = 1.5;
/// Number of points up to which the parts have that factor. More points explore no less than these.
const FEW: u64 = 1000;
/// Number of points beyond which exploration takes no more of them.
const ENOUGH: u64 = 10_000;

/// Values of the model at the explored points.
pub(super) struct Explored {
    normals: Columns,
    answers: Vec<Answers>,
    /// Width of the group of every point. None for those beside switches.
    scales: Vec<Option<f64>>,
}

impl Explored {
    /// Evaluates the groups: a fifth of `samples`, or three tenths of few. More points follow if the surrogate has not
    /// `reached` a target, and beside switches.
    pub(super) fn new(
        targets: &[Target<'_>],
        reached: &[bool],
        samples: u64,
        seed: u64,
        model: &mut Model<'_>,
    ) -> Self {
        let n = model.space.len();
        let mut explored = Self { normals: vec![Vec::new(); n], answers: Vec::new(), scales: Vec::new() };
        let size = (SPARSE * samples.min(FEW) as f64).max(samples.min(ENOUGH) as f64);
        let points = |part: f64| (part * size) as usize;
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut group = |rows: usize, scale: f64| -> Columns {
            (0..n).map(|_| (0..rows).map(|_| scale * rng.sample::<f64, _>(StandardNormal)).collect()).collect()
        };
        let groups: &[(f64, f64)] = if n > MANY_VARIABLES { &MODEST_GROUPS } else { &GROUPS };
        let mut first: Columns = vec![Vec::new(); n];
        let mut scales = Vec::new();
        for &(scale, part) in groups {
            first.iter_mut().zip(group(points(part), scale)).for_each(|(all, more)| all.extend(more));
            scales.extend(std::iter::repeat_n(Some(scale), points(part)));
        }
        explored.ask(first, scales, model);
        let seen =
            |target: &Target<'_>| explored.values(target.characteristic).flatten().any(|value| target.sought(value));
        if targets.iter().zip(reached).any(|(target, &reached)| !reached && !seen(target)) {
            let (rows, scale) = (points(LARGER), WIDER * groups[groups.len() - 1].0);
            let wider = group(rows, scale);
            explored.ask(wider, vec![Some(scale); rows], model);
        }
        explored.beside_switches(targets, points(BESIDE), seed, model);
        explored
    }

    /// Evaluates points in the half-spaces beyond switches that are seldom met.
    fn beside_switches(&mut self, targets: &[Target<'_>], most: usize, seed: u64, model: &mut Model<'_>) {
        let n = self.normals.len();
        let varying: Vec<usize> = model.space.dimensions().collect();
        let mut characteristics: Vec<usize> = targets.iter().map(|target| target.characteristic).collect();
        characteristics.dedup();
        let points: Vec<Vec<f64>> =
            characteristics.iter().flat_map(|&c| seldom_points(model.problem(), c, &varying, seed)).collect();
        let rows = (most / points.len().max(1)).min(most / 4).max(2);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(!seed);
        let mut beside: Columns = vec![Vec::new(); n];
        for point in points {
            let distance = length(&point);
            let Some(direction) = unit(point).filter(|_| distance < FARTHEST) else { continue };
            for _ in 0..rows {
                let tail = rng.sample::<f64, _>(rand_distr::Open01) * standard_normal::sf(distance - BEFORE);
                let across: Vec<f64> = (0..n).map(|_| rng.sample(StandardNormal)).collect();
                let along: f64 = across.iter().zip(&direction).map(|(z, part)| z * part).sum();
                let moved = standard_normal::upper_quantile(tail) - along;
                for (column, (z, part)) in beside.iter_mut().zip(across.iter().zip(&direction)) {
                    column.push(z + moved * part);
                }
            }
        }
        let rows = beside.first().map_or(0, Vec::len);
        self.ask(beside, vec![None; rows], model);
    }

    fn ask(&mut self, normals: Columns, scales: Vec<Option<f64>>, model: &mut Model<'_>) {
        if !scales.is_empty() {
            self.answers.push(model.ask(&normals));
            self.scales.extend(scales);
            self.normals.iter_mut().zip(normals).for_each(|(all, more)| all.extend(more));
        }
    }

    /// Value of a characteristic at every point. None if it has none.
    fn values(&self, characteristic: usize) -> impl Iterator<Item = Option<f64>> + '_ {
        self.answers.iter().flat_map(move |answers| answers.values(characteristic))
    }

    /// Counts the points of the inputs' own density for a target.
    pub(super) fn plain(&self, target: &Target<'_>) -> PlainPoints {
        let mut plain = PlainPoints::default();
        let own: Vec<usize> = (0..self.scales.len()).filter(|&row| self.scales[row] == Some(1.0)).collect();
        let normals = self.normals.iter().map(|column| own.iter().map(|&row| column[row]).collect()).collect();
        let values: Vec<Option<f64>> = self.values(target.characteristic).collect();
        for (&row, margin) in own.iter().zip(target.margins(&normals)) {
            plain.add(values[row].map(|value| target.sought(value)), margin > 0.0);
        }
        plain
    }

    /// Rejects of a target, sorted with the nearest to the means first.
    pub(super) fn rejects(&self, target: &Target<'_>) -> Vec<Vec<f64>> {
        let sought = self.values(target.characteristic).enumerate();
        let sought = sought.filter(|(_, value)| value.is_some_and(|value| target.sought(value)));
        let mut points: Vec<(f64, Vec<f64>)> = sought
            .map(|(row, _)| self.normals.iter().map(|column| column[row]).collect::<Vec<f64>>())
            .map(|point| (length(&point), point))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.into_iter().map(|(_, point)| point).collect()
    }

    /// Points in normal space.
    pub(super) fn normals(&self) -> &Columns {
        &self.normals
    }

    /// Bound of the probability of a region without a sampled point. `dense` is true for each point near which the mixture draws enough
    /// points.
    ///
    /// A reject there, at a place, or where the surrogate has one shows no other region, and is left out.
    pub(super) fn unmet(&self, target: &Target<'_>, places: &[&Place], dense: &[bool]) -> Option<Unmet> {
        let margins = target.margins(&self.normals);
        let mut groups: Vec<Group> = Vec::new();
        let mut strayed = 0;
        for (row, (value, scale)) in self.values(target.characteristic).zip(&self.scales).enumerate() {
            let (Some(value), &Some(scale)) = (value, scale) else { continue };
            if target.sought(value) {
                let point: Vec<f64> = self.normals.iter().map(|column| column[row]).collect();
                if margins[row] > 0.0 || dense[row] || places.iter().any(|place| place.holds(&point)) {
                    continue;
                }
                strayed += 1;
            }
            match groups.iter_mut().find(|group| group.scale == scale) {
                Some(group) => group.points += 1,
                None => groups.push(Group { scale, points: 1 }),
            }
        }
        Unmet::new(&groups, strayed, self.normals.len())
    }
}
