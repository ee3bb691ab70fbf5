//! Moments of a surrogate with correlated inputs.
//!
//! The mean is exact for inputs of any distribution. With `R` the correlation of the inputs,
//!
//! ```text
//! mean = centre + sum_j E g_j + sum_{j<k} A_jk R_jk
//! ```
//!
//! If the correlated inputs are normal and their parts parabolas, the other moments are exact too. With `R = L L'` the inputs are `u = L w`
//! of independent normal `w`, in which the surrogate has the same form: `b_w = L'b`, `H_w = L'H L`, where `H` has the curvatures on its
//! diagonal and half the mixed coefficients beside it.
//!
//! Otherwise (correlated inputs of other distributions, or parts of third and fourth degree) the inputs are replaced by the best parabolas
//! of the normal variables behind them, whose moments are exact. The difference is sampled from the surrogate. No model is evaluated, the
//! sample does not depend on any seed, and its standard errors are reported.

use faer::Mat;

use crate::correlation::Correlation;
use crate::distribution::StandardMoments;
use crate::moments::{Contributions, Interactions, Term, contributions};
use crate::surrogate::{InputShape, Inputs, Surrogate, Univariate};

/// Surrogate in independent variables: correlated inputs are replaced by normal variables, each with its best parabola.
pub(super) struct Parabolas<'a> {
    pub(super) surrogate: &'a Surrogate,
    pub(super) parts: Vec<Univariate>,
    pub(super) inputs: &'a Inputs,
    pub(super) correlation: &'a Correlation,
    /// Place of every input among the members. None if it is not a member.
    pub(super) member: Vec<Option<usize>>,
    /// Slopes of the members in the normal variables.
    pub(super) slopes: Vec<f64>,
    /// Quadratic form of the members in the normal variables: curvatures, and half the products beside them.
    pub(super) form: Mat<f64>,
    /// Products of a member and another input.
    pub(super) across: Vec<(usize, usize, f64)>,
    /// Products of two inputs that are not members.
    pub(super) apart: Vec<(usize, usize, f64)>,
}

impl<'a> Parabolas<'a> {
    pub(super) fn of(
        surrogate: &'a Surrogate,
        parts: Vec<Univariate>,
        inputs: &'a Inputs,
        correlation: &'a Correlation,
    ) -> Self {
        let members = correlation.members();
        let m = members.len();
        let mut member = vec![None; parts.len()];
        members.iter().enumerate().for_each(|(place, &position)| member[position] = Some(place));
        let (mut slopes, mut form) = (vec![0.0; m], Mat::zeros(m, m));
        // Slope of a member's own value in the normal variable behind it: 1 for a normal member.
        let mut straight = vec![1.0; m];
        for (place, (&position, transform)) in members.iter().zip(correlation.transforms()).enumerate() {
            let part = &parts[position];
            let [slope, curvature] = match part.parabola().filter(|_| transform.is_normal()) {
                Some(parabola) => parabola,
                None => transform.projected(|u| part.value(u)),
            };
            (slopes[place], form[(place, place)]) = (slope, curvature);
            if !transform.is_normal() {
                straight[place] = transform.projected(|u| u)[0];
            }
        }
        let (mut across, mut apart) = (Vec::new(), Vec::new());
        for (j, k, value) in surrogate.interactions.pairs() {
            match (member[j], member[k]) {
                (Some(a), Some(b)) => {
                    let half = 0.5 * value * straight[a] * straight[b];
                    form[(a, b)] = half;
                    form[(b, a)] = half;
                }
                (Some(a), None) => across.push((a, k, value * straight[a])),
                (None, Some(b)) => across.push((b, j, value * straight[b])),
                (None, None) => apart.push((j, k, value)),
            }
        }
        Self { surrogate, parts, inputs, correlation, member, slopes, form, across, apart }
    }

    /// True if the parabolas are the surrogate itself.
    pub(super) fn exact(&self) -> bool {
        let parabola = |position: &usize| self.parts[*position].parabola().is_some();
        self.correlation.is_normal() && self.correlation.members().iter().all(parabola)
    }

    pub(super) fn constant(&self) -> bool {
        self.parts.iter().all(|part| part.largest() == 0.0) && self.surrogate.interactions.pairs().is_empty()
    }

    pub(super) fn shape(&self, position: usize) -> &'a InputShape {
        &self.inputs.shapes()[position]
    }

    /// Mean product `E[u_j u_k]` of two inputs.
    pub(super) fn together(&self, j: usize, k: usize) -> f64 {
        match (self.member[j], self.member[k]) {
            (Some(a), Some(b)) => self.correlation.matrix()[(a, b)],
            _ => f64::from(j == k),
        }
    }

    /// Exact mean of the surrogate.
    pub(super) fn mean(&self) -> f64 {
        let own: f64 = (0..self.parts.len()).map(|j| self.parts[j].term(self.shape(j)).mean()).sum();
        let pairs = self.surrogate.interactions.pairs();
        self.surrogate.centre + own + pairs.iter().map(|&(j, k, value)| value * self.together(j, k)).sum::<f64>()
    }

    /// Exact moments and contributions of the parabolas.
    pub(super) fn contributions(&self) -> Contributions {
        let n = self.parts.len();
        let others: Vec<usize> = (0..n).filter(|&j| self.member[j].is_none()).collect();
        let place = |j: usize| self.slopes.len() + others.binary_search(&j).expect("no member");
        let factor = self.correlation.factor();
        let independent = factor.transpose() * &self.form * &factor;
        let m = self.slopes.len();
        let normal = &StandardMoments::NORMAL;
        let mut terms: Vec<Term<'_>> = (0..m)
            .map(|a| {
                let linear = (0..m).map(|j| factor[(j, a)] * self.slopes[j]).sum();
                Term::Quadratic { linear, curvature: independent[(a, a)], moments: normal }
            })
            .collect();
        terms.extend(others.iter().map(|&j| self.parts[j].term(self.shape(j))));
        let mut pairs: Vec<(usize, usize, f64)> = (0..m)
            .flat_map(|a| (a + 1..m).map(move |b| (a, b)))
            .map(|(a, b)| (a, b, 2.0 * independent[(a, b)]))
            .collect();
        let mut mixed = Mat::<f64>::zeros(m, others.len());
        for &(a, k, value) in &self.across {
            for w in 0..m {
                mixed[(w, place(k) - m)] += factor[(a, w)] * value;
            }
        }
        let across = (0..others.len()).flat_map(|k| (0..m).map(move |a| (a, k)));
        pairs.extend(across.map(|(a, k)| (a, m + k, mixed[(a, k)])));
        pairs.extend(self.apart.iter().map(|&(j, k, value)| (place(j), place(k), value)));
        pairs.retain(|&(_, _, value)| value != 0.0);
        let whole = contributions(0.0, &terms, &Interactions::of_pairs(terms.len(), pairs));
        self.shared(&whole, &|j| terms[place(j)].clone())
    }

    /// Contributions of the inputs themselves: the covariance of each with the whole, so that they sum to 1.
    fn shared(&self, whole: &Contributions, other: &dyn Fn(usize) -> Term<'a>) -> Contributions {
        let (n, m) = (self.parts.len(), self.slopes.len());
        let (per_sigma, normal) = (whole.per_sigma, self.correlation.normal());
        let scaled = |value: f64| value * per_sigma;
        let slopes = Mat::from_fn(m, 1, |j, _| scaled(self.slopes[j]));
        let form = Mat::from_fn(m, m, |j, k| scaled(self.form[(j, k)]));
        let along = normal * &slopes;
        let around = normal * &form * normal;
        let (mut linear, mut curvature, mut mean_shift) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            mean_shift[j] = self.parts[j].term(self.shape(j)).mean();
            match self.member[j] {
                Some(a) => {
                    linear[j] = slopes[(a, 0)] * along[(a, 0)];
                    curvature[j] = 2.0 * form[(a, a)] * around[(a, a)];
                }
                None => {
                    let part = other(j).part(per_sigma);
                    (linear[j], curvature[j]) = (part.p * part.p, part.curved);
                }
            }
        }
        let share = |j: usize, k: usize, value: f64| match (self.member[j], self.member[k]) {
            (Some(a), Some(b)) => 4.0 * form[(a, b)] * around[(a, b)],
            (None, None) => scaled(value).powi(2),
            (Some(a), None) => self.across_share(a, k, per_sigma),
            (None, Some(b)) => self.across_share(b, j, per_sigma),
        };
        let pairs = self.surrogate.interactions.pairs();
        Contributions {
            moments: whole.moments,
            linear,
            curvature,
            mean_shift,
            per_sigma,
            products: Some(pairs.iter().map(|&(j, k, value)| ((j, k), share(j, k, value))).collect()),
            sampled: None,
        }
    }

    /// Covariance of the product of a member and another input with all products of that other input.
    fn across_share(&self, a: usize, k: usize, per_sigma: f64) -> f64 {
        let normal = self.correlation.normal();
        let of = |&(b, other, value): &(usize, usize, f64)| (other == k).then_some((b, value * per_sigma));
        let all: Vec<(usize, f64)> = self.across.iter().filter_map(of).collect();
        let own = all.iter().find(|&&(b, _)| b == a).map_or(0.0, |&(_, value)| value);
        own * all.iter().map(|&(b, value)| normal[(a, b)] * value).sum::<f64>()
    }
}
