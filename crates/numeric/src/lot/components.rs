//! Between and within: variance components of parts in groups (lots, machines, operators).
//!
//! `x = mean + group + rest`. The components follow from the mean squares (ANOVA by moments): the rest has the mean square within, and
//! the groups the difference of the mean squares over the number of parts in a group. Groups of unequal size have the size
//! `n0 = (N - sum n^2/N)/(k - 1)`. The interval of the rest is exact for normal parts. That of the groups is by Williams, at least 95 %
//! for groups of equal size and approximate otherwise.
//!
//! Source: J. S. Williams, A confidence interval for variance components, Biometrika 49 (1962); S. R. Searle, G. Casella,
//! C. E. McCulloch, Variance Components (1992), chapter 3.

use std::collections::BTreeMap;

use crate::lot::reference_law::{chi_squared_quantile, fisher_quantile, fisher_sf};
use crate::lot::{LotFigure, LotTest, SIDE};

/// Variance components of parts in groups.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupComparison {
    /// Standard deviation between the groups; 0 if the groups differ by less than their parts explain.
    pub between: LotFigure,
    /// Standard deviation within a group.
    pub within: LotFigure,
    /// Test against equal means of all groups.
    pub test: LotTest,
    /// Name, number of parts and mean of each group.
    pub groups: Vec<(String, usize, f64)>,
}

/// Variance components of values with the name of the group of each. Returns None of fewer than two groups, if no group has two
/// values, or if all values are equal. Where no group has two different values, all the variance is between the groups: its interval is that
/// of the means alone.
///
/// ```
/// use sensitol_numeric::lot::compare_groups;
/// let parts = [("a", 1.0), ("a", 3.0), ("b", 5.0), ("b", 7.0)];
/// let found = compare_groups(&parts).unwrap();
/// // Mean squares 16 and 2, so that 7 remains for the groups.
/// assert!((found.within.value.powi(2) - 2.0).abs() < 1e-12 && (found.between.value.powi(2) - 7.0).abs() < 1e-12);
/// ```
pub fn compare_groups(parts: &[(&str, f64)]) -> Option<GroupComparison> {
    let origin = parts.first()?.1;
    let mut groups: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (name, value) in parts {
        groups.entry(name).or_default().push(value - origin);
    }
    let (total, count) = (parts.len() as f64, groups.len() as f64);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let grand = parts.iter().map(|(_, value)| value - origin).sum::<f64>() / total;
    let around = |values: &Vec<f64>| {
        let centre = mean(values);
        values.iter().map(|value| (value - centre).powi(2)).sum::<f64>()
    };
    let inside: f64 = groups.values().map(around).sum();
    let outside: f64 = groups.values().map(|values| values.len() as f64 * (mean(values) - grand).powi(2)).sum();
    let freedom = [count - 1.0, total - count];
    if freedom[0] < 1.0 || freedom[1] < 1.0 || !(inside + outside > 0.0 && inside >= 0.0) {
        return None;
    }
    let (between, within) = (outside / freedom[0], inside / freedom[1]);
    let squares: f64 = groups.values().map(|values| (values.len() as f64).powi(2)).sum();
    let size = (total - squares / total) / freedom[0];
    let f = between / within;
    let end = |p: f64| {
        let left = outside * (1.0 - fisher_quantile(p, freedom) / f) / (size * chi_squared_quantile(p, freedom[0]));
        left.max(0.0).sqrt()
    };
    let of_rest = |p: f64| (inside / chi_squared_quantile(p, freedom[1])).sqrt();
    let listed = groups.iter().map(|(name, values)| ((*name).to_owned(), values.len(), origin + mean(values)));
    Some(GroupComparison {
        between: LotFigure {
            value: ((between - within) / size).max(0.0).sqrt(),
            interval: [end(1.0 - SIDE), end(SIDE)],
        },
        within: LotFigure { value: within.sqrt(), interval: [of_rest(1.0 - SIDE), of_rest(SIDE)] },
        test: LotTest::of(fisher_sf(f, freedom)),
        groups: listed.collect(),
    })
}
