//! Central-difference plan: the centre, nodes on the axes, and corners for mixed derivatives.

use std::collections::{BTreeMap, HashSet};
use std::ops::Deref;
use std::sync::Arc;

use super::Plan;
use super::axis::Axis;
use super::geometry::Geometry;
use super::known_answers::KnownAnswers;
use super::nodes::{Reaches, Spread};
use super::pairs::{PairChoice, Side, Stencil, strongest};
use super::point::{AtNode, Point};
use super::stage::{Purpose, Stage};
use sensitol_numeric::correlation::Correlation;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::surrogate::{DerivativeOrigin, InputShape, Inputs, Univariate, shapes};

/// Layout of a difference plan: its nodes, pairs and stencil.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Number of nodes on each axis.
    pub spread: Spread,
    /// Choice of the mixed derivatives that are evaluated.
    pub pairs: PairChoice,
    /// Stencil of the mixed derivatives.
    pub stencil: Stencil,
    /// Step in sigmas that replaces the matched nodes, unless a dimension has a step of its own.
    pub step: Option<f64>,
    /// True if dimensions without tolerance are moved too, for their sensitivity.
    pub fixed_too: bool,
}

/// Difference plan of one problem. Positions count the dimensions that vary and matter.
#[derive(Debug, Clone)]
pub struct DifferencePlan {
    layout: Layout,
    geometry: Geometry,
}

/// Nodes of one dimension at which its pairs are evaluated.
#[derive(Debug, Clone, Copy)]
struct PairNodes {
    left: Option<u32>,
    right: Option<u32>,
}

impl DifferencePlan {
    /// Plan for these dimensions. A row of `depends` flags the dimensions that a characteristic can depend on.
    pub(crate) fn new(
        dimensions: &[Dimension],
        correlation: Option<&Correlation>,
        depends: Vec<Vec<bool>>,
        layout: Layout,
    ) -> Self {
        let matters = |d: usize| depends.iter().any(|row| row[d]);
        let of_sigma = |varies: bool| {
            (0..dimensions.len()).filter(move |&d| matters(d) && (dimensions[d].sigma() > 0.0) == varies)
        };
        let varying: Vec<usize> = of_sigma(true).collect();
        let fixed: Vec<usize> = if layout.fixed_too { of_sigma(false).collect() } else { Vec::new() };
        let mut axes: Vec<Axis> = dimensions.iter().map(Axis::still).collect();
        let mut reaches = Reaches::default();
        let mut axis = |d: usize| Axis::varying_with(&dimensions[d], layout.spread, layout.step, &mut reaches);
        varying.iter().for_each(|&d| axes[d] = axis(d));
        fixed.iter().for_each(|&d| axes[d] = Axis::fixed(&dimensions[d], layout.spread));
        let mut nominal = Vec::new();
        for (d, dimension) in dimensions.iter().enumerate() {
            if let Some(node) = axes[d].at_value(dimension.nominal()) {
                nominal.push(AtNode { dimension: d as u32, node });
            }
        }
        let distributions = varying.iter().filter_map(|&d| dimensions[d].distribution());
        let mut shapes = shapes(distributions);
        for (shape, &d) in shapes.iter_mut().zip(&varying) {
            // Integrate by the values at evaluated nodes, not by a polynomial through them that extrapolates.
            if let Some(rule) = axes[d].tail.as_ref().and_then(|tail| tail.rule.as_ref()) {
                shape.rule = Arc::new(rule.clone());
            }
        }
        let inputs = Inputs::new(shapes, correlation.and_then(|correlation| correlation.among(&varying)));
        let nominal = Point::of(&nominal);
        Self { layout, geometry: Geometry { axes, nominal, varying, fixed, inputs, depends } }
    }

    /// Adds two nodes to the axis of a dimension that has a pair. Returns false if there are no suitable nodes. `dimension` is the one with
    /// this index in the problem.
    pub(crate) fn refine(&mut self, dimension: &Dimension, index: usize) -> bool {
        let Geometry { axes, inputs, varying, .. } = &mut self.geometry;
        let refined = axes[index].refine(dimension, self.layout.step);
        let rule = axes[index].tail.as_ref().and_then(|tail| tail.rule.as_ref());
        if let (true, Some(rule), Ok(position)) = (refined, rule, varying.binary_search(&index)) {
            *inputs = inputs.clone().with_rule(position, Arc::new(rule.clone()));
        }
        refined
    }

    /// Adds these pairs of positions to those examined.
    pub(crate) fn examine(&mut self, pairs: impl IntoIterator<Item = (usize, usize)>) {
        let varying = &self.geometry.varying;
        let pairs = pairs.into_iter().map(|(j, k)| (varying[j], varying[k]));
        match &mut self.layout.pairs {
            PairChoice::Listed(listed) => listed.extend(pairs),
            choice => *choice = PairChoice::Listed(pairs.collect()),
        }
    }

    /// Switches to the stencil with all four corners for every pair.
    pub(crate) fn use_four_corners(&mut self) {
        self.layout.stencil = Stencil::FourPoint;
    }

    /// Point with these values of dimensions. Every other dimension is at its mean.
    pub(crate) fn point_at(&mut self, values: impl IntoIterator<Item = (usize, f64)>) -> Point {
        let at = values.into_iter().filter_map(|(d, x)| {
            let node = self.geometry.axes[d].at_value(x)?;
            Some(AtNode { dimension: d as u32, node })
        });
        Point::of(&at.collect::<Vec<AtNode>>())
    }

    /// Nodes of every position on the left and on the right at which its pairs are evaluated, with their places in sigmas.
    pub(crate) fn corners(&self, known: &KnownAnswers) -> Vec<[Option<(AtNode, f64)>; 2]> {
        let place =
            |(d, node): (usize, u32)| (AtNode { dimension: d as u32, node }, self.axes[d].nodes[node as usize].u);
        let both = |(&d, nodes): (&usize, &PairNodes)| [nodes.left, nodes.right].map(|node| Some(place((d, node?))));
        self.varying.iter().zip(&self.pair_nodes(known)).map(both).collect()
    }

    /// Place of a point in sigmas, one value for every position.
    pub(crate) fn standardised(&self, point: &Point) -> Vec<f64> {
        let mut u = vec![0.0; self.varying.len()];
        for at in point.at() {
            if let Ok(position) = self.varying.binary_search(&(at.dimension as usize)) {
                u[position] = self.axes[at.dimension as usize].nodes[at.node as usize].u;
            }
        }
        u
    }

    /// Adds every node, and the next replacement of each node at which some characteristic failed.
    fn add_axes(&self, stage: &mut Builder<'_, impl FnMut(Point, Purpose)>, dimensions: &[usize], purpose: Purpose) {
        for &d in dimensions {
            for slot in &self.axes[d].slots {
                for (rank, &node) in slot.iter().enumerate() {
                    let purpose = if rank == 0 { purpose } else { Purpose::Repair };
                    stage.add(self.on_axis(d, node), purpose);
                    let lacking = |c: usize| {
                        self.depends[c][d]
                            && stage.known.value(&Point::Centre, c).is_some()
                            && slot[..=rank].iter().all(|&node| stage.known.value(&self.on_axis(d, node), c).is_none())
                    };
                    let tried = stage.known.tried(&self.on_axis(d, node));
                    if !tried || !(0..self.depends.len()).any(lacking) {
                        break;
                    }
                }
            }
        }
    }

    /// Passes every point of the next stage to `take`.
    fn each_wanted(&self, known: &KnownAnswers, take: impl FnMut(Point, Purpose)) {
        let mut stage = Builder { known, seen: HashSet::new(), taken: 0, take };
        stage.add(Point::Centre, Purpose::Centre);
        stage.add(self.nominal.clone(), Purpose::Nominal);
        self.add_axes(&mut stage, &self.varying, Purpose::Axis);
        let axes_known = stage.taken == 0;
        if self.layout.spread != Spread::Bare && (axes_known || self.layout.pairs != PairChoice::Strongest) {
            self.add_pairs(&mut stage);
        }
        self.add_axes(&mut stage, &self.fixed, Purpose::Sensitivity);
    }

    fn add_pairs(&self, stage: &mut Builder<'_, impl FnMut(Point, Purpose)>) {
        let nodes = self.pair_nodes(stage.known);
        for (j, k) in self.pairs(Some(stage.known)) {
            for &corner in self.layout.stencil.corners(self.opposite(j, k)) {
                // No two pairs share a point, so half a million of them need no set.
                if let Some(point) = self.corner(&nodes, j, k, corner).filter(|point| *point != self.nominal) {
                    stage.add_distinct(point, Purpose::Pair);
                }
            }
        }
    }

    /// True if two dimensions are negatively correlated.
    fn opposite(&self, j: usize, k: usize) -> bool {
        self.inputs.correlation().is_some_and(|correlation| correlation.of(j, k) < 0.0)
    }

    fn corner(&self, nodes: &[PairNodes], j: usize, k: usize, (of_j, of_k): (Side, Side)) -> Option<Point> {
        let at = |position: usize, side: Side| {
            Some(AtNode { dimension: self.varying[position] as u32, node: nodes[position].on(side)? })
        };
        Some(Point::of(&[at(j, of_j)?, at(k, of_k)?]))
    }

    /// Pairs examined, as positions `j < k`. The strongest pairs require known values on the axes.
    pub(crate) fn pairs(&self, known: Option<&KnownAnswers>) -> Vec<(usize, usize)> {
        match known {
            None => self.pairs_by(None),
            Some(known) => self.pairs_by(Some(&|c, d| self.part(known, c, d))),
        }
    }

    /// Pairs examined, with the univariate parts by characteristic and dimension from any source.
    pub(crate) fn pairs_by(&self, part: Option<&dyn Fn(usize, usize) -> Option<Univariate>>) -> Vec<(usize, usize)> {
        let n = self.varying.len();
        let mut pairs: Vec<(usize, usize)> = match &self.layout.pairs {
            PairChoice::None => return Vec::new(),
            PairChoice::All => return self.coupled_pairs(),
            PairChoice::Strongest => {
                let Some(part) = part else { return Vec::new() };
                let shares: Vec<Vec<f64>> = (0..self.depends.len()).map(|c| self.shares(part, c)).collect();
                return strongest(n, &shares, |c, j, k| self.joint(c, j, k));
            }
            PairChoice::Adjacent => (0..n).map(|j| (j, (j + 1) % n)).map(|(j, k)| (j.min(k), j.max(k))).collect(),
            PairChoice::Listed(pairs) => {
                let position = |d: usize| self.varying.iter().position(|&varying| varying == d);
                let place = |&(a, b): &(usize, usize)| {
                    let (j, k) = (position(a)?, position(b)?);
                    Some((j.min(k), j.max(k)))
                };
                pairs.iter().filter_map(place).collect()
            }
        };
        pairs.sort_unstable();
        pairs.dedup();
        pairs.retain(|&(j, k)| j != k && self.matters(j, k));
        pairs
    }

    /// Univariate variance of every position, as a share of their sum.
    fn shares(&self, part: &dyn Fn(usize, usize) -> Option<Univariate>, characteristic: usize) -> Vec<f64> {
        let scale = |part: Univariate| part.largest();
        let parts: Vec<Option<Univariate>> = self.varying.iter().map(|&d| part(characteristic, d)).collect();
        let largest = parts.iter().flatten().copied().map(scale).fold(0.0, f64::max);
        if largest == 0.0 {
            return vec![0.0; parts.len()];
        }
        let variance = |(part, shape): (&Option<Univariate>, &InputShape)| {
            part.map_or(0.0, |part| part.term(shape).variance(1.0 / largest))
        };
        let variances: Vec<f64> = parts.iter().zip(self.inputs.shapes()).map(variance).collect();
        let total: f64 = variances.iter().sum();
        variances.into_iter().map(|variance| variance / total).collect()
    }

    /// Univariate part of a characteristic in one dimension, through all its nodes with a value. Returns None if no node has one.
    pub(crate) fn part(&self, known: &KnownAnswers, characteristic: usize, dimension: usize) -> Option<Univariate> {
        if !self.depends[characteristic][dimension] {
            return Some(Univariate::of_coefficients(&[0.0, 0.0]));
        }
        Univariate::through(&self.samples(known, characteristic, dimension)?)
    }

    /// Nodes at which pairs are evaluated: those next to the mean, or the replacement at which most characteristics have a value.
    fn pair_nodes(&self, known: &KnownAnswers) -> Vec<PairNodes> {
        let of_slot = |d: usize, slot: &[u32]| {
            let answered = |node: u32| {
                let answered = |&c: &usize| known.value(&self.on_axis(d, node), c).is_some();
                (0..self.depends.len()).filter(answered).count()
            };
            if !known.has_failures() {
                return slot[0];
            }
            let best = slot.iter().map(|&node| answered(node)).max().unwrap_or(0);
            slot.iter().copied().find(|&node| answered(node) == best).expect("a slot is never empty")
        };
        let nodes = |&d: &usize| {
            let [left, right] = &self.axes[d].inner;
            PairNodes {
                left: left.as_ref().map(|slot| of_slot(d, slot)),
                right: right.as_ref().map(|slot| of_slot(d, slot)),
            }
        };
        self.varying.iter().map(nodes).collect()
    }

    /// Mixed derivatives of a characteristic in sigma units, for these pairs. A derivative is None if no corner has a value, and flagged if
    /// some corner has none.
    ///
    /// With `d = f(j, k) - f(j) - f(k) + f(centre)` at each corner, `A_jk = sum of sign(u_j u_k) d / sum of |u_j u_k|` over the corners
    /// with a value. For all corners this is the usual formula with unequal steps, for fewer a one-sided one.
    pub(crate) fn mixed(
        &self,
        known: &KnownAnswers,
        characteristic: usize,
        pairs: &[(usize, usize)],
    ) -> Vec<Option<Mixed>> {
        let nodes = self.pair_nodes(known);
        let Some(centre) = known.value(&Point::Centre, characteristic) else { return vec![None; pairs.len()] };
        // Look each axis value up once, since N - 1 pairs need it.
        let on_axis: Vec<[Option<(f64, f64)>; 2]> = (0..self.varying.len())
            .map(|j| {
                [Side::Left, Side::Right].map(|side| self.axis_value(known, characteristic, j, nodes[j].on(side)?))
            })
            .collect();
        let mixed = |&(j, k): &(usize, usize)| {
            if !self.joint(characteristic, j, k) {
                return Some(Mixed::exact(0.0));
            }
            let corners = self.layout.stencil.corners(self.opposite(j, k));
            let (mut sum, mut weight, mut found) = (0.0, 0.0, 0);
            for &(of_j, of_k) in corners {
                let corner =
                    self.corner(&nodes, j, k, (of_j, of_k)).and_then(|point| known.value(&point, characteristic));
                if let (Some(corner), Some((u, at_j)), Some((v, at_k))) =
                    (corner, on_axis[j][of_j as usize], on_axis[k][of_k as usize])
                {
                    sum += (u * v).signum() * (corner - at_j - at_k + centre);
                    weight += (u * v).abs();
                    found += 1;
                }
            }
            (found > 0).then(|| Mixed { complete: found == corners.len(), ..Mixed::evaluated(sum / weight) })
        };
        // Work in parallel, since looking two points up in a million takes most of the time.
        pairs.par_iter().map(mixed).collect()
    }

    /// Corners of every pair, if they have values, with those of the two-point stencil first. A corner holds its two places in sigmas, and
    /// the difference that [`mixed`](Self::mixed) averages.
    pub(crate) fn twists(
        &self,
        known: &KnownAnswers,
        characteristic: usize,
        pairs: &[(usize, usize)],
    ) -> Vec<[Option<Corner>; 4]> {
        let nodes = self.pair_nodes(known);
        let centre = known.value(&Point::Centre, characteristic);
        let twist = |&(j, k): &(usize, usize)| {
            let corners = Stencil::FourPoint.corners(self.opposite(j, k));
            std::array::from_fn(|i| {
                let (of_j, of_k) = corners[i];
                let at = known.value(&self.corner(&nodes, j, k, (of_j, of_k))?, characteristic)?;
                let (u, at_j) = self.axis_value(known, characteristic, j, nodes[j].on(of_j)?)?;
                let (v, at_k) = self.axis_value(known, characteristic, k, nodes[k].on(of_k)?)?;
                Some((u, v, at - at_j - at_k + centre?))
            })
        };
        pairs.iter().map(twist).collect()
    }

    /// Place of a node in sigmas, and the value there.
    fn axis_value(
        &self,
        known: &KnownAnswers,
        characteristic: usize,
        position: usize,
        node: u32,
    ) -> Option<(f64, f64)> {
        let d = self.varying[position];
        let value = known.value(&self.on_axis(d, node), characteristic)?;
        Some((self.axes[d].nodes[node as usize].u, value))
    }
}

impl Deref for DifferencePlan {
    type Target = Geometry;

    fn deref(&self) -> &Geometry {
        &self.geometry
    }
}

impl Plan for DifferencePlan {
    fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    fn cost(&self) -> (usize, usize) {
        let nodes: usize = self.varying.iter().chain(&self.fixed).map(|&d| self.axes[d].slots.len()).sum();
        let on_an_axis = |point: &Point| match point.at() {
            [] => true,
            [at] => self.axes[at.dimension as usize].slots.iter().any(|slot| slot[0] == at.node),
            _ => false,
        };
        let pairs = self.possible_pairs().min(match &self.layout.pairs {
            _ if self.layout.spread == Spread::Bare => 0,
            PairChoice::None => 0,
            PairChoice::All => usize::MAX,
            PairChoice::Strongest => self.varying.len(),
            PairChoice::Adjacent | PairChoice::Listed(_) => self.pairs(None).len(),
        });
        let stages = if self.layout.pairs == PairChoice::Strongest && pairs > 0 { 2 } else { 1 };
        let extra = usize::from(!on_an_axis(&self.nominal));
        (1 + extra + nodes + pairs.saturating_mul(self.layout.stencil.evaluations()), stages)
    }

    fn next(&self, known: &KnownAnswers) -> Option<Stage> {
        let mut stage = Stage::default();
        let whole = self.cost();
        // Return early for a plan of all pairs whose points are all known: looking them up one by one takes long.
        if self.layout.pairs == PairChoice::All && whole == (known.points().len(), 1) && !known.has_failures() {
            return None;
        }
        if !known.tried(&Point::Centre) {
            stage.points.reserve_exact(whole.0);
        }
        self.each_wanted(known, |point, purpose| stage.points.push((point, purpose)));
        (!stage.points.is_empty()).then_some(stage)
    }

    fn first(&self) -> BTreeMap<Purpose, usize> {
        let mut counts = BTreeMap::new();
        let (mut purpose, mut points) = (Purpose::Centre, 0);
        // Count runs of equal purposes, since most points follow one of the same purpose.
        self.each_wanted(&KnownAnswers::nothing(self.depends.len()), |_, of| {
            if of != purpose {
                *counts.entry(purpose).or_default() += points;
                (purpose, points) = (of, 0);
            }
            points += 1;
        });
        *counts.entry(purpose).or_default() += points;
        counts
    }
}

/// Corner of a pair: both places in sigmas, and `f(j, k) - f(j) - f(k) + f(centre)`.
pub type Corner = (f64, f64, f64);

/// Mixed derivative in sigma units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixed {
    /// Value `A_jk = sd_j sd_k d2F/dx_j dx_k`.
    pub value: f64,
    /// True if every corner of the stencil had a value.
    pub complete: bool,
    /// Origin of the derivative.
    pub origin: DerivativeOrigin,
}

impl Mixed {
    /// Derivative of a formula.
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, complete: true, origin: DerivativeOrigin::Exact }
    }

    /// Derivative from values at points of its own.
    pub(crate) fn evaluated(value: f64) -> Self {
        Self { value, complete: true, origin: DerivativeOrigin::Evaluated }
    }

    /// Estimate by a fit that many pairs share, or 0.
    pub(crate) fn screened(value: f64) -> Self {
        Self { value, complete: true, origin: DerivativeOrigin::Screened }
    }
}

impl PairNodes {
    fn on(self, side: Side) -> Option<u32> {
        match side {
            Side::Left => self.left,
            Side::Right => self.right,
        }
    }
}

/// Passes on points that are neither known nor passed on yet.
struct Builder<'k, T> {
    known: &'k KnownAnswers,
    seen: HashSet<Point>,
    taken: usize,
    take: T,
}

impl<T: FnMut(Point, Purpose)> Builder<'_, T> {
    /// Adds a point that cannot have been added before.
    #[inline(always)]
    fn add_distinct(&mut self, point: Point, purpose: Purpose) {
        if !self.known.tried(&point) {
            self.taken += 1;
            (self.take)(point, purpose);
        }
    }

    fn add(&mut self, point: Point, purpose: Purpose) {
        if self.seen.insert(point.clone()) {
            self.add_distinct(point, purpose);
        }
    }
}
