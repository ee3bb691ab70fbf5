//! Uncertainty of a characteristic at a linearization point.

use std::collections::BTreeMap;

use sensitol_numeric::requirement::Requirement;

/// Distances of the pessimistic ends of the intervals from the figures of trial tolerances, by kind of requirement and in its unit. A kind
/// that is missing has none.
#[derive(Debug, Clone, Default)]
pub(in crate::allocation) struct Uncertainty {
    by_kind: BTreeMap<&'static str, f64>,
}

impl Uncertainty {
    /// Uncertainty of the figure of a requirement, 0 if none is known.
    pub(in crate::allocation) fn of(&self, requirement: &Requirement) -> f64 {
        self.by_kind.get(requirement.key()).copied().unwrap_or(0.0)
    }

    /// Sets the uncertainty of the figure of a requirement.
    pub(in crate::allocation) fn set(&mut self, requirement: &Requirement, distance: f64) {
        self.by_kind.insert(requirement.key(), distance);
    }

    /// Adds another uncertainty.
    pub(in crate::allocation) fn add(&mut self, other: &Self) {
        for (kind, distance) in &other.by_kind {
            *self.by_kind.entry(kind).or_default() += distance;
        }
    }

    /// Raises every figure to that of another uncertainty, if that is greater.
    pub(in crate::allocation) fn raise_to(&mut self, other: &Self) {
        for (kind, distance) in &other.by_kind {
            let own = self.by_kind.entry(kind).or_insert(*distance);
            *own = own.max(*distance);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_add_and_rise_apart_from_each_other() {
        let (cpk, sigma) = (Requirement::Cpk(1.0), Requirement::Sigma(0.2));
        let (mut first, mut second) = (Uncertainty::default(), Uncertainty::default());
        first.set(&cpk, 0.125);
        second.set(&Requirement::Cpk(1.33), 0.5);
        second.set(&sigma, 0.25);
        let mut sum = first.clone();
        sum.add(&second);
        assert_eq!([sum.of(&cpk), sum.of(&sigma), sum.of(&Requirement::Rss)], [0.625, 0.25, 0.0]);
        second.raise_to(&first);
        assert_eq!([second.of(&cpk), second.of(&sigma)], [0.5, 0.25]);
    }
}
