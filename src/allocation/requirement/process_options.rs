//! Process options with distributions of their own, as sums that the lists of a knapsack need.

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::surface::response::Responses;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::StandardMoments;
use sensitol_numeric::moments::Moments;

/// Difference of means, in sigmas, within which they are the same.
const SAME: f64 = 1e-12;

/// Process options of all groups.
#[derive(Clone, Copy)]
pub(in crate::allocation) struct ProcessOptions<'a> {
    pub(in crate::allocation) responses: &'a Responses,
    pub(in crate::allocation) priced: &'a [Priced],
    /// Dimensions of the members for every group and offer.
    pub(in crate::allocation) dimensions: &'a [Vec<Vec<Dimension>>],
}

/// Use of a slack by every option of every group. A choice keeps the constraint if its uses add up to at most the slack.
pub(in crate::allocation) struct OptionUses {
    pub(in crate::allocation) slack: f64,
    pub(in crate::allocation) of_options: Vec<Vec<f64>>,
}

impl ProcessOptions<'_> {
    /// Moments of a characteristic at the linearization point.
    pub(super) fn moments(&self, characteristic: usize) -> Option<Moments> {
        self.responses.moments(characteristic, &vec![1.0; self.responses.dimensions.len()])
    }

    /// Uses by the half bands of the options: `use_of(group, half band)`.
    pub(super) fn of_bands(&self, slack: f64, use_of: impl Fn(usize, f64) -> f64) -> OptionUses {
        let of_group = |(g, group): (usize, &Priced)| group.offers.iter().map(|offer| use_of(g, offer.min)).collect();
        OptionUses { slack, of_options: self.priced.iter().enumerate().map(of_group).collect() }
    }

    /// Uses by the variances of the options under a greatest sigma. Returns None unless variances add up.
    pub(super) fn variances(&self, characteristic: usize, most_sigma: f64) -> Option<OptionUses> {
        let slopes = self.responses.slopes_of_sum(characteristic)?;
        let is_priced = |d: usize| self.priced.iter().any(|group| group.members.contains(&d));
        let fixed = (0..slopes.len())
            .filter(|&d| !is_priced(d))
            .map(|d| (slopes[d] * self.responses.dimensions[d].sigma()).powi(2))
            .sum::<f64>();
        let of_option = |group: &Priced, dimensions: &Vec<Dimension>| -> f64 {
            let members = group.members.iter().zip(dimensions);
            members.map(|(&d, dimension)| (slopes[d] * dimension.sigma()).powi(2)).sum()
        };
        let of_group = |(group, options): (&Priced, &Vec<Vec<Dimension>>)| {
            options.iter().map(|dimensions| of_option(group, dimensions)).collect()
        };
        let of_options = self.priced.iter().zip(self.dimensions).map(of_group).collect();
        Some(OptionUses { slack: most_sigma * most_sigma - fixed, of_options })
    }

    /// True if every option of every group and every other dimension is normal.
    pub(super) fn all_normal(&self) -> bool {
        let normal = |dimension: &Dimension| {
            let law = dimension.distribution();
            law.is_none_or(|law| law.standard_moments() == StandardMoments::NORMAL)
        };
        self.dimensions.iter().flatten().flatten().all(normal) && self.responses.dimensions.iter().all(normal)
    }

    /// True if no option moves the mean of a characteristic.
    pub(super) fn means_stay(&self, characteristic: usize) -> bool {
        let stays = |(&d, dimension): (&usize, &Dimension)| {
            let old = &self.responses.dimensions[d];
            let blur = 8.0 * f64::EPSILON * old.mean().abs();
            (dimension.mean() - old.mean()).abs() <= SAME * old.sigma() + blur
        };
        self.priced.iter().zip(self.dimensions).all(|(group, options)| {
            !self.responses.depends(characteristic, group)
                || options.iter().all(|option| group.members.iter().zip(option).all(stays))
        })
    }
}
