//! Characteristics as functions of the tolerances, at fixed derivatives, without evaluations.
//!
//! With half bands `f_j` times those at which the derivatives were taken, the dimension `j` lies at `u_j = d_j(f_j) +
//! r_j(f_j) v_j` in its old sigmas, where `v_j` is standardised anew. A slope grows as `f`, a curvature as `f^2`, a
//! product as `f_j f_k`. The middle of a band stays in place. Only the mean of a skewed distribution over it moves.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::cost::priced_group::holder;
use crate::allocation::surface::band::{Reach, Scaling};
use crate::allocation::surface::reject_fit::RejectFit;
use crate::allocation::surface::sampled_moments::SampledCorrection;
use crate::allocation::surface::surface_slack::{About, Correction, Follows};
use crate::allocation::surface::uncertainty::Uncertainty;
use crate::allocation::surface::worst_case::{NO_CORRECTION, WorstCase, WorstCaseCorrection, correction, is_off};
use crate::analysis::{Analysis, CharacteristicAnalysis, law_over, surface_law};
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::Distribution;
use sensitol_numeric::law::SurfaceLaw;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::surrogate::{InputShape, Inputs, Relocation, Surrogate, shapes};

/// Characteristics at tolerances near a linearization point.
pub(in crate::allocation) struct Responses {
    /// Dimensions with the tolerances at which the derivatives were taken.
    pub(in crate::allocation) dimensions: Vec<Dimension>,
    /// Indices of the dimensions that vary and have an effect.
    pub(in crate::allocation) varying: Vec<usize>,
    pub(in crate::allocation) inputs: Inputs,
    pub(in crate::allocation) scaling: Vec<Scaling>,
    pub(in crate::allocation) reach: Vec<Reach>,
    pub(in crate::allocation) correlated: Vec<(usize, usize, f64)>,
    pub(in crate::allocation) of: Vec<Response>,
    /// Distributions of the varying dimensions. None if one of them has moments only.
    pub(in crate::allocation) laws: Option<Vec<Arc<dyn Distribution>>>,
    /// Corrections computed so far, by characteristic and the bits of the required yield.
    pub(in crate::allocation) corrections: Mutex<BTreeMap<(usize, u64), Arc<Correction>>>,
    /// Rejects of several characteristics together, by their indices.
    pub(in crate::allocation) reject_fits: Mutex<BTreeMap<Vec<usize>, Arc<RejectFit>>>,
    /// Additional rejects of the joint yield by its interval, beyond those of the surface distributions.
    pub(in crate::allocation) joint_uncertainty: f64,
}

pub(in crate::allocation) struct Response {
    pub(in crate::allocation) surrogate: Option<Surrogate>,
    /// Value at the nominal dimensions.
    pub(in crate::allocation) nominal: Option<f64>,
    /// Derivatives by every dimension at the means, in their own units. None if one is missing.
    pub(in crate::allocation) slopes: Option<Vec<f64>>,
    /// True for each dimension on which the characteristic can depend.
    pub(in crate::allocation) depends: Vec<bool>,
    pub(in crate::allocation) limits: SpecLimits,
    /// Greatest error of a value by rounding.
    pub(in crate::allocation) rounding: f64,
    /// Surface distribution, if it gives the yield.
    pub(in crate::allocation) law: Option<SurfaceLaw>,
    /// Uncertainty of the figures that are required, added to the requirements.
    pub(in crate::allocation) uncertainty: Uncertainty,
    /// Correction of the moments by samples of the model, if these refute the surface.
    pub(in crate::allocation) sampled: Option<SampledCorrection>,
    /// Worst case, if it is required. None if the slopes determine it.
    pub(in crate::allocation) worst: Option<WorstCase>,
    /// Corrections of the linear worst case below and above, if dimensions share a zone.
    pub(in crate::allocation) over_zones: [WorstCaseCorrection; 2],
}

/// Relative difference that counts as rounding.
const SAME: f64 = 1e-12;
/// Step in `ln T` of the central differences of moments. Truncation and rounding are both near 1e-10.
const STEP: f64 = 3e-5;

impl Responses {
    /// Responses from the outcome and analysis of a method. `over_box` is true for each characteristic whose extremes
    /// over the box of the bands are required.
    pub(in crate::allocation) fn of(
        problem: &Problem,
        outcome: &Outcome,
        analysis: &Analysis,
        over_box: &[bool],
    ) -> Self {
        let dimensions = problem.dimensions().to_vec();
        let varying = outcome.plan.varying().to_vec();
        let scaling = varying.iter().map(|&d| Scaling::of(&dimensions[d])).collect();
        let reach: Vec<Reach> = dimensions.iter().map(Reach::of).collect();
        let n = dimensions.len();
        let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
        let correlated = problem.correlation().map_or(Vec::new(), |correlation| {
            pairs.map(|(a, b)| (a, b, correlation.of(a, b))).filter(|&(_, _, value)| value != 0.0).collect()
        });
        let of = (outcome.fitted.iter().enumerate())
            .map(|(c, fitted)| {
                let depends: Vec<bool> = (0..n).map(|d| outcome.plan.depends(c, d)).collect();
                let slope = |d: usize| match &fitted.exact {
                    _ if !depends[d] || dimensions[d].sigma() == 0.0 => Some(0.0),
                    Some(exact) if exact.first[d].is_some() => exact.first[d],
                    _ => Some(fitted.parts[d]?.slope() / outcome.plan.axis(d).scale),
                };
                let found = &analysis.characteristics[c];
                let limits = found.characteristic.limits();
                let by_law = is_judged_by_law(found);
                Response {
                    surrogate: fitted.surrogate.clone(),
                    nominal: fitted.nominal,
                    slopes: (0..n).map(slope).collect(),
                    depends,
                    limits,
                    rounding: problem.kept_limits(c).rounding(),
                    law: by_law.then(|| surface_law(problem, outcome, c)?.ok()).flatten(),
                    uncertainty: Uncertainty::default(),
                    sampled: None,
                    worst: over_box[c]
                        .then(|| worst_case(problem, &varying, &reach, fitted.surrogate.as_ref(), found))
                        .flatten(),
                    over_zones: [NO_CORRECTION; 2],
                }
            })
            .collect();
        let laws = varying.iter().map(|&d| dimensions[d].law().cloned()).collect();
        let inputs = outcome.plan.inputs().clone();
        let (corrections, reject_fits) = (Mutex::default(), Mutex::default());
        let mut all = Self {
            dimensions,
            varying,
            inputs,
            scaling,
            reach,
            correlated,
            of,
            laws,
            corrections,
            reject_fits,
            joint_uncertainty: 0.0,
        };
        for (c, found) in analysis.characteristics.iter().enumerate() {
            if over_box[c] && shares_a_zone(problem, &all.varying) {
                all.of[c].over_zones = all.zone_corrections(c, found).unwrap_or([NO_CORRECTION; 2]);
            }
        }
        if let Some([low, _]) = analysis.joint_requirement.and_then(|of| of.interval) {
            let ones = vec![1.0; n];
            let own = all.rejects(&all.limited()).share(&all, &ones, None);
            all.joint_uncertainty = own.map_or(0.0, |own| (1.0 - low - own).max(0.0));
        }
        all
    }

    /// Indices of the characteristics with limits.
    pub(in crate::allocation) fn limited(&self) -> Vec<usize> {
        (0..self.of.len()).filter(|&c| self.of[c].limits.exist()).collect()
    }

    /// Surface distribution of a characteristic, if it gives the yield.
    pub(in crate::allocation) fn law(&self, c: usize) -> Option<&SurfaceLaw> {
        self.of[c].law.as_ref()
    }

    /// True if the varying dimension at this position keeps mean and shape when its tolerance changes.
    pub(in crate::allocation) fn keeps_mean_and_shape(&self, position: usize) -> bool {
        matches!(self.scaling[position], Scaling::Similar { alpha } if alpha == 0.0)
    }

    /// Correction of the slack (four-moment estimate in `slack`) by the surface distribution, for a required yield and
    /// the reject rate that is then allowed. Returns None if there is no surface distribution, and if none is needed.
    pub(in crate::allocation) fn correction(
        &self,
        c: usize,
        (required, allowed): (f64, f64),
        slack: &dyn Fn(&Moments) -> Option<f64>,
        slack_slopes: &dyn Fn(&Moments) -> Option<[f64; 3]>,
    ) -> Option<Arc<Correction>> {
        let one = &self.of[c];
        let law = one.law.as_ref().filter(|_| !self.is_plain(c))?;
        let key = (c, required.to_bits());
        let known = || self.corrections.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&key) {
            return Some(Arc::clone(found));
        }
        let follows = |(&d, scaling): (&usize, &Scaling)| match scaling {
            Scaling::Still => (d, Follows::Still),
            _ if !one.depends[d] => (d, Follows::Still),
            Scaling::Similar { alpha } if *alpha == 0.0 => (d, Follows::Similar),
            Scaling::Similar { .. } | Scaling::Reshaped => (d, Follows::Otherwise),
        };
        let about = About {
            law,
            limits: one.limits,
            dimensions: self.dimensions.len(),
            varying: self.varying.iter().zip(&self.scaling).map(follows).collect(),
            moments: &|factors| self.moments(c, factors),
            law_at: &|factors| self.law_at(c, factors),
            slack,
            slack_slopes,
            slopes: self.exact_slopes(c, &vec![1.0; self.dimensions.len()]),
        };
        let found = Correction::of(&about, allowed).unwrap_or_else(|| Correction::none(self.dimensions.len()));
        let found = Arc::new(found);
        known().insert(key, Arc::clone(&found));
        Some(found)
    }

    /// Surface distribution of a characteristic at other tolerances.
    pub(in crate::allocation) fn law_at(&self, c: usize, factors: &[f64]) -> Option<SurfaceLaw> {
        let (surrogate, inputs) = self.relocated(c, factors, None)?;
        let mut laws = self.laws.clone()?;
        for (position, (&d, law)) in self.varying.iter().zip(&mut laws).enumerate() {
            if matches!(self.scaling[position], Scaling::Reshaped) && factors[d] != 1.0 {
                *law = Arc::clone(self.dimensions[d].scaled(factors[d])?.ok()?.law()?);
            }
        }
        law_over(&surrogate, &laws, inputs.correlation(), self.of[c].rounding).ok()
    }

    /// Factors of all dimensions for these half bands of the groups.
    pub(in crate::allocation) fn factors(&self, priced: &[Priced], at: &[f64]) -> Vec<f64> {
        let mut factors = vec![1.0; self.dimensions.len()];
        for (group, &t) in priced.iter().zip(at) {
            group.shared().for_each(|(d, share)| factors[d] = share * t / self.dimensions[d].half_band());
        }
        factors
    }

    /// True if the characteristic depends on a member of the group.
    pub(in crate::allocation) fn depends(&self, characteristic: usize, group: &Priced) -> bool {
        group.members.iter().any(|&d| self.of[characteristic].depends[d] && self.varying.contains(&d))
    }

    /// Relocation of the inputs for `factors` times their tolerances, and nominals moved by `shifts` sigmas.
    fn moved(&self, factors: &[f64], shifts: Option<&[f64]>) -> Option<(Vec<Relocation>, Cow<'_, Inputs>)> {
        let mut inputs = Cow::Borrowed(&self.inputs);
        let mut moved = Vec::with_capacity(self.varying.len());
        for (position, (&d, scaling)) in self.varying.iter().zip(&self.scaling).enumerate() {
            let factor = factors[d];
            let more = shifts.map_or(0.0, |shifts| shifts[d]);
            let mut to = match scaling {
                _ if factor == 1.0 => Relocation::NONE,
                Scaling::Still => Relocation::NONE,
                Scaling::Similar { alpha } => Relocation { shift: alpha * (factor - 1.0), stretch: factor },
                Scaling::Reshaped => {
                    let old = &self.dimensions[d];
                    let new = old.scaled(factor)?.ok()?;
                    let mut shapes: Vec<InputShape> = inputs.shapes().to_vec();
                    shapes[position] = shapes_of(&new)?;
                    inputs = Cow::Owned(Inputs::new(shapes, inputs.correlation().cloned()));
                    Relocation { shift: (new.mean() - old.mean()) / old.sigma(), stretch: new.sigma() / old.sigma() }
                }
            };
            to.shift += more;
            moved.push(to);
        }
        Some((moved, inputs))
    }

    /// Surrogate of a characteristic and its inputs at other tolerances.
    pub(in crate::allocation) fn relocated(
        &self,
        characteristic: usize,
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<(Surrogate, Cow<'_, Inputs>)> {
        let (moved, inputs) = self.moved(factors, shifts)?;
        Some((self.of[characteristic].surrogate.as_ref()?.relocated(&moved), inputs))
    }

    /// Four moments of a characteristic at other tolerances. Returns None if they are unknown.
    pub(in crate::allocation) fn moments(&self, characteristic: usize, factors: &[f64]) -> Option<Moments> {
        self.moments_shifted(characteristic, factors, None)
    }

    /// Four moments at other tolerances, with nominals moved by `shifts` sigmas.
    pub(in crate::allocation) fn moments_shifted(
        &self,
        characteristic: usize,
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<Moments> {
        let (surrogate, inputs) = self.relocated(characteristic, factors, shifts)?;
        let moments = surrogate.contributions(&inputs)?.moments;
        match &self.of[characteristic].sampled {
            Some(sampled) => sampled.corrected(&moments, factors),
            None => Some(moments),
        }
    }

    /// Derivatives of mean, `ln sigma`, skewness and excess by `ln T` of every group.
    pub(in crate::allocation) fn moment_slopes(
        &self,
        characteristic: usize,
        priced: &[Priced],
        factors: &[f64],
    ) -> Option<Vec<[f64; 4]>> {
        if let Some(slopes) = self.exact_moment_slopes(characteristic, priced, factors) {
            return Some(slopes);
        }
        let mut slopes = vec![[0.0; 4]; priced.len()];
        let mut trial = factors.to_vec();
        for (group, slope) in priced.iter().zip(&mut slopes) {
            if !self.depends(characteristic, group) {
                continue;
            }
            let mut at = |step: f64| {
                group.members.iter().for_each(|&d| trial[d] = factors[d] * libm::exp(step));
                let moments = self.moments(characteristic, &trial)?;
                Some([moments.mean(), libm::log(moments.sigma()), moments.skewness()?, moments.excess()?])
            };
            let (up, down) = (at(STEP)?, at(-STEP)?);
            group.members.iter().for_each(|&d| trial[d] = factors[d]);
            for (slope, (up, down)) in slope.iter_mut().zip(up.into_iter().zip(down)) {
                *slope = (up - down) / (2.0 * STEP);
            }
        }
        Some(slopes)
    }

    /// Exact derivatives of the moments for independent inputs with fixed means. Returns None for other inputs.
    fn exact_moment_slopes(&self, characteristic: usize, priced: &[Priced], factors: &[f64]) -> Option<Vec<[f64; 4]>> {
        let by_dimension = self.exact_slopes(characteristic, factors)?;
        let of = |group: &Priced| {
            let mut slope = [0.0; 4];
            for &d in &group.members {
                slope.iter_mut().zip(&by_dimension[d]).for_each(|(all, own)| *all += own);
            }
            slope
        };
        Some(priced.iter().map(of).collect())
    }

    /// Exact derivatives of the moments by every dimension. They are 0 for one that does not follow its tolerance.
    fn exact_slopes(&self, characteristic: usize, factors: &[f64]) -> Option<Vec<[f64; 4]>> {
        if self.is_sampled(characteristic) || !self.means_stay() {
            return None;
        }
        let (surrogate, inputs) = self.relocated(characteristic, factors, None)?;
        let by_position = surrogate.growths(&inputs)?;
        let mut slopes = vec![[0.0; 4]; self.dimensions.len()];
        for ((&d, scaling), slope) in self.varying.iter().zip(&self.scaling).zip(by_position) {
            if !matches!(scaling, Scaling::Still) {
                slopes[d] = slope;
            }
        }
        Some(slopes)
    }

    /// Distance of the linear worst case from the nominal value as `constant + sum_g coefficient_g T_g`: upwards, or
    /// downwards with the sign turned.
    pub(in crate::allocation) fn worst_case(
        &self,
        characteristic: usize,
        priced: &[Priced],
        above: bool,
    ) -> Option<(f64, Vec<f64>)> {
        let slopes = self.of[characteristic].slopes.as_ref()?;
        let sign = if above { 1.0 } else { -1.0 };
        let mut coefficients = vec![0.0; priced.len()];
        let mut constant = 0.0;
        /// Group of priced dimensions, with the share of a member in its tolerance.
        type Holder = Option<(usize, f64)>;
        let mut zones: Vec<(&str, Holder, f64)> = Vec::new();
        for (d, &slope) in slopes.iter().enumerate() {
            let reach = self.reach[d];
            let group = holder(priced, d);
            constant += sign * slope * (reach.middle - reach.lean * reach.half);
            // Values are per half band of the derivatives; coefficients are per unit of T.
            let mut add = |value: f64| match group {
                Some((g, share)) => coefficients[g] += value * share / self.dimensions[d].half_band(),
                None => constant += value,
            };
            let wide = (slope * reach.half).abs();
            match self.dimensions[d].zone() {
                None => add(wide + sign * slope * reach.lean * reach.half),
                Some(zone) => match zones.iter_mut().find(|(name, ..)| *name == zone) {
                    Some((_, _, radius)) => *radius = libm::hypot(*radius, wide),
                    None => zones.push((zone, group, wide)),
                },
            }
        }
        for (zone, group, radius) in zones {
            let member = self.dimensions.iter().find(|dimension| dimension.zone() == Some(zone));
            match group.zip(member) {
                Some(((g, share), member)) => coefficients[g] += radius * share / member.half_band(),
                None => constant += radius,
            }
        }
        let (factor, more) = self.of[characteristic].over_zones[usize::from(above)];
        coefficients.iter_mut().for_each(|coefficient| *coefficient *= factor);
        Some((factor * constant + more, coefficients))
    }

    /// True if the slopes determine the worst case of a characteristic.
    pub(in crate::allocation) fn has_linear_worst_case(&self, characteristic: usize) -> bool {
        let of = &self.of[characteristic];
        of.worst.is_none() && !of.over_zones.iter().any(is_off)
    }

    /// Corrections of the linear worst case below and above, from the worst case of the analysis over the zones.
    /// Returns None if that is unknown.
    fn zone_corrections(
        &self,
        characteristic: usize,
        found: &CharacteristicAnalysis,
    ) -> Option<[WorstCaseCorrection; 2]> {
        let nominal = found.nominal?;
        let proof = found.proof().filter(|proof| proof.proven).map(|proof| proof.bounds);
        let [low, high] = proof.or(found.range.worst_case.filter(|_| found.is_proven_linear()))?;
        let all = self.every_dimension();
        let of = |above: bool, truth: f64| {
            let (constant, coefficients) = self.worst_case(characteristic, &all, above)?;
            let half = |group: &Priced| self.dimensions[group.members[0]].half_band();
            let wide = all.iter().zip(&coefficients).map(|(group, coefficient)| coefficient * half(group));
            let by = correction(constant + wide.sum::<f64>(), truth);
            Some(if is_off(&by) { by } else { NO_CORRECTION })
        };
        Some([of(false, nominal - low)?, of(true, high - nominal)?])
    }

    /// Value of the linear model with every dimension in the middle of its band. The rss is taken about it, as in an
    /// analysis. `shifts` moves the nominals, in sigmas.
    pub(in crate::allocation) fn middle(
        &self,
        characteristic: usize,
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        let of = &self.of[characteristic];
        let middle = |d: usize| {
            let Reach { middle, half, lean } = self.reach[d];
            middle + lean * half * (factors[d] - 1.0)
        };
        let moved = |d: usize| middle(d) + shifts.map_or(0.0, |by| by[d] * self.dimensions[d].sigma());
        let slopes = of.slopes.as_ref()?.iter().enumerate();
        Some(of.nominal? + slopes.map(|(d, slope)| slope * moved(d)).sum::<f64>())
    }

    /// Derivatives of [`middle`](Self::middle) by `ln T` of every group. They are not 0 for bands with one end held.
    pub(in crate::allocation) fn middle_slopes(
        &self,
        characteristic: usize,
        priced: &[Priced],
        factors: &[f64],
    ) -> Option<Vec<f64>> {
        let slopes = self.of[characteristic].slopes.as_ref()?;
        let of = |&d: &usize| slopes[d] * self.reach[d].lean * self.reach[d].half * factors[d];
        Some(priced.iter().map(|group| group.members.iter().map(of).sum()).collect())
    }

    /// Square of the rss, and its derivatives by `ln T` of every group.
    pub(in crate::allocation) fn rss_squared(
        &self,
        characteristic: usize,
        priced: &[Priced],
        factors: &[f64],
    ) -> Option<(f64, Vec<f64>)> {
        let slopes = self.of[characteristic].slopes.as_ref()?;
        let mut member_of = vec![None; slopes.len()];
        priced.iter().enumerate().for_each(|(g, group)| group.members.iter().for_each(|&d| member_of[d] = Some(g)));
        let part = |d: usize| slopes[d] * self.reach[d].half * factors[d];
        let mut slope = vec![0.0; priced.len()];
        let mut total = 0.0;
        let squares = (0..slopes.len()).map(|d| (d, d, 0.5));
        for (a, b, coefficient) in squares.chain(self.correlated.iter().copied()) {
            let value = 2.0 * coefficient * part(a) * part(b);
            total += value;
            for d in [a, b] {
                if let Some(g) = member_of[d] {
                    slope[g] += value;
                }
            }
        }
        Some((total, slope))
    }

    /// Variance of a plain characteristic, and the part of every group.
    pub(in crate::allocation) fn plain_squares(
        &self,
        characteristic: usize,
        priced: &[Priced],
        factors: &[f64],
    ) -> Option<(f64, Vec<f64>)> {
        let surrogate = self.of[characteristic].surrogate.as_ref()?;
        let square = |position: usize| {
            let factor = factors[self.varying[position]];
            surrogate.parts[position].map_or(0.0, |part| (part.slope() * factor).powi(2))
        };
        let total = (0..self.varying.len()).map(square).sum();
        let of = |group: &Priced| {
            let positions = group.members.iter().filter_map(|d| self.varying.iter().position(|varying| varying == d));
            positions.map(square).sum()
        };
        Some((total, priced.iter().map(of).collect()))
    }

    /// Variation of a characteristic by a dimension alone: the largest coefficient of its univariate part, or its
    /// reach.
    pub(in crate::allocation) fn spread(&self, characteristic: usize, d: usize) -> f64 {
        let one = &self.of[characteristic];
        let part = self
            .varying
            .iter()
            .position(|&varying| varying == d)
            .and_then(|position| one.surrogate.as_ref()?.parts[position]);
        let reach = one.slopes.as_ref().map_or(0.0, |slopes| (slopes[d] * self.reach[d].half).abs());
        part.map_or(reach, |part| reach.max(part.largest()))
    }

    /// True if samples of the model correct the surface.
    pub(in crate::allocation) fn is_sampled(&self, characteristic: usize) -> bool {
        self.of[characteristic].sampled.is_some()
    }

    /// True if mean and shape of the characteristic cannot change with the tolerances, so that sigma alone determines
    /// every figure. That is so for a linear surrogate of normal inputs with fixed means and no correlation.
    pub(in crate::allocation) fn is_plain(&self, characteristic: usize) -> bool {
        let Some(surrogate) = self.of[characteristic].surrogate.as_ref().filter(|_| !self.is_sampled(characteristic))
        else {
            return false;
        };
        is_straight(surrogate) && self.are_normal() && self.means_stay() && self.correlated.is_empty()
    }

    /// True if sigma alone determines every figure and is a convex norm of the tolerances: as
    /// [`is_plain`](Self::is_plain), with any correlation.
    pub(in crate::allocation) fn is_norm(&self, characteristic: usize) -> bool {
        let surrogate = self.of[characteristic].surrogate.as_ref().filter(|_| !self.is_sampled(characteristic));
        surrogate.is_some_and(is_straight) && self.are_normal() && self.means_stay()
    }

    /// True if the characteristic is a sum of independent dimensions with fixed means, of any distribution. Its mean is
    /// then fixed, and its variance is a sum of squares of the tolerances.
    pub(in crate::allocation) fn is_still_sum(&self, characteristic: usize) -> bool {
        let surrogate = self.of[characteristic].surrogate.as_ref().filter(|_| !self.is_sampled(characteristic));
        surrogate.is_some_and(is_straight) && self.means_stay() && self.correlated.is_empty()
    }

    fn are_normal(&self) -> bool {
        self.inputs
            .shapes()
            .iter()
            .all(|shape| shape.moments == sensitol_numeric::distribution::StandardMoments::NORMAL)
    }

    fn means_stay(&self) -> bool {
        self.scaling.iter().all(|scaling| {
            matches!(scaling, Scaling::Similar { alpha } if *alpha == 0.0) || matches!(scaling, Scaling::Still)
        })
    }
}

/// True if the surface distribution gives the yield. A counted one has no slopes.
pub(in crate::allocation) fn is_judged_by_law(found: &CharacteristicAnalysis) -> bool {
    found.characteristic.limits().exist() && found.evidence.surface_law.is_some_and(|law| law.counted.is_none())
}

/// True if some of these dimensions share a zone, so that they do not reach the whole box of their bands.
fn shares_a_zone(problem: &Problem, varying: &[usize]) -> bool {
    let block = |d: usize| problem.correlation().is_some_and(|of| of.block_of(d).is_some());
    varying.iter().any(|&d| problem.dimensions()[d].zone().is_some() || block(d))
}

/// Worst case of a characteristic that the slopes do not determine: a curved surface, or a formula with better bounds
/// by interval arithmetic. Returns None for a straight surface, and if dimensions share a zone, for which the linear
/// worst case is corrected.
fn worst_case(
    problem: &Problem,
    varying: &[usize],
    reach: &[Reach],
    surrogate: Option<&Surrogate>,
    found: &CharacteristicAnalysis,
) -> Option<WorstCase> {
    let surrogate = surrogate?;
    let dimensions = problem.dimensions();
    let linear = found.is_proven_linear() || shares_a_zone(problem, varying);
    let reached = found.nominal.zip(found.proof()).map(|(nominal, proof)| {
        let [low, high] = proof.bounds;
        [nominal - low, high - nominal]
    });
    // Without a proof, the slopes of a straight surface are all that is known.
    if linear || reached.is_none() && is_straight(surrogate) {
        return None;
    }
    let band = |&d: &usize| {
        let (dimension, reach) = (&dimensions[d], reach[d]);
        let of_sigma = |length: f64| length / dimension.sigma();
        [of_sigma(dimension.nominal() + reach.middle - dimension.mean()), of_sigma(reach.half), reach.lean]
    };
    WorstCase::of(surrogate, varying, varying.iter().map(band).collect(), found.nominal?, reached)
}

/// True if a surface has neither curvature nor products, within rounding.
pub(in crate::allocation) fn is_straight(surrogate: &Surrogate) -> bool {
    surrogate.parts.iter().all(|part| part.is_some_and(|part| part.is_straight(SAME)))
        && surrogate.interactions.pairs().iter().all(|&(j, k, product)| {
            let slope = |at: usize| surrogate.parts[at].map_or(0.0, |part| part.slope().abs());
            product.abs() <= SAME * slope(j).max(slope(k))
        })
}

pub(in crate::allocation) fn shapes_of(dimension: &Dimension) -> Option<InputShape> {
    shapes(dimension.distribution()).pop()
}

impl Responses {
    /// Groups of every varying dimension, or zone, alone, as if all tolerances were free.
    pub(in crate::allocation) fn every_dimension(&self) -> Vec<Priced> {
        let mut groups: Vec<Priced> = Vec::new();
        for (d, dimension) in self.dimensions.iter().enumerate().filter(|(_, dimension)| dimension.sigma() > 0.0) {
            let zone = dimension.zone();
            let known =
                groups.iter_mut().find(|group| zone.is_some() && self.dimensions[group.members[0]].zone() == zone);
            match known {
                Some(group) => group.members.push(d),
                None => groups.push(Priced::without_cost(d)),
            }
        }
        groups
    }
}

impl Responses {
    /// Indices of the dimensions that vary and have an effect.
    pub(in crate::allocation) fn varying(&self) -> &[usize] {
        &self.varying
    }
}
