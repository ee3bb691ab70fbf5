//! Points of equal weight in ascending order: shares, quantiles and density, each with the error of a count.
//!
//! The points are one set without randomisations, so that the error is that of a binomial count.

use sensitol_numeric::law::{LawFigure, LawTail, QUANTILE};

/// Points added on either side of a count for its error, so that a count of zero has an error too. Three errors then reach 5/n. With no hit
/// among `n` points, the share exceeds 4.6/n with a probability of 1 % only.
const UNSEEN: f64 = 3.0;
/// Share of the points that a density leaves out on either side.
pub(super) const OUTSIDE: f64 = 1e-3;

/// Values in ascending order.
pub(crate) struct OrderedPoints(Vec<f64>);

impl OrderedPoints {
    /// Sorts the values.
    pub(crate) fn new(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self(values)
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Greatest absolute value, 0 without points.
    pub(crate) fn largest(&self) -> f64 {
        self.0.first().into_iter().chain(self.0.last()).fold(0.0, |largest: f64, y| largest.max(y.abs()))
    }

    /// Share of the points strictly beyond a value.
    pub(crate) fn beyond(&self, tail: LawTail, y: f64) -> f64 {
        self.count_beyond(tail, y) as f64 / self.len() as f64
    }

    /// [`beyond`](Self::beyond) with its error.
    pub(crate) fn estimate_beyond(&self, tail: LawTail, y: f64) -> LawFigure {
        let error = self.error(self.count_beyond(tail, y) as f64);
        LawFigure::counted(self.beyond(tail, y), error / self.len() as f64)
    }

    fn count_beyond(&self, tail: LawTail, y: f64) -> usize {
        match tail {
            LawTail::Lower => self.0.partition_point(|&own| own < y),
            LawTail::Upper => self.len() - self.0.partition_point(|&own| own <= y),
        }
    }

    /// Value of the quantile at probability `p`. Its error comes from the values at the count plus and minus its error.
    pub(crate) fn quantile(&self, tail: LawTail, p: f64) -> LawFigure {
        let n = self.len();
        let at = |beyond: f64| {
            let rank = (beyond.max(0.0) as usize).min(n - 1);
            self.0[if tail == LawTail::Lower { rank } else { n - 1 - rank }]
        };
        let count = p * n as f64;
        let off = self.error(count);
        let (value, inner, outer) = (at(count), at(count + off), at(count - off));
        LawFigure::counted(value, (value - inner).abs().max((value - outer).abs()))
    }

    /// Density `[y, density, error]` at equal distances between far quantiles. Returns None if the values do not spread.
    pub(crate) fn density(&self, places: usize) -> Option<Vec<[f64; 3]>> {
        let n = self.len();
        let cut = (OUTSIDE * n as f64) as usize;
        let (from, to) = (*self.0.get(cut)?, *self.0.get(n.checked_sub(cut + 1)?)?);
        let step = (to - from) / places as f64;
        let at = |place: usize| {
            let y = from + step * place as f64;
            let below = |y: f64| self.0.partition_point(|&own| own < y);
            let count = (below(y + 0.5 * step) - below(y - 0.5 * step)) as f64;
            [y, count / (n as f64 * step), self.error(count) / (n as f64 * step)]
        };
        (step > 0.0).then(|| (0..=places).map(at).collect())
    }

    /// Error of a count, in points.
    fn error(&self, count: f64) -> f64 {
        let n = self.len() as f64 + 2.0 * UNSEEN;
        let share = (count + UNSEEN) / n;
        QUANTILE * (n * share * (1.0 - share)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middles of ten thousand equal parts of 0 to 1.
    fn uniform() -> OrderedPoints {
        OrderedPoints::new((0..10_000).rev().map(|i| (f64::from(i) + 0.5) / 1e4).collect())
    }

    /// Shares, quantiles and density of a uniform distribution are known.
    #[test]
    fn uniform_points_have_the_figures_of_a_uniform_distribution() {
        let points = uniform();
        let tail = points.estimate_beyond(LawTail::Upper, 0.99);
        // A count of 100 has a standard error of 10 points.
        assert!((tail.value - 0.01).abs() < 1e-12 && (9e-4..4e-3).contains(&tail.error), "{tail:?}");
        for (side, exact) in [(LawTail::Lower, 0.2), (LawTail::Upper, 0.8)] {
            let found = points.quantile(side, 0.2);
            // Half the distance of two points.
            assert!((found.value - exact).abs() < 1e-4 && found.error > 0.0, "{found:?}");
        }
        // The first and the last place reach beyond the support.
        for [y, density, error] in &points.density(10).unwrap()[1..10] {
            assert!((density - 1.0).abs() < 2e-3 && *error > 0.0, "{density} at {y}");
        }
    }

    /// Without a hit among n points the share exceeds 4.6/n with a probability of 1 %, which three errors reach.
    #[test]
    fn a_count_of_zero_has_an_error() {
        let none = uniform().estimate_beyond(LawTail::Lower, -1.0);
        assert!(none.value == 0.0 && 3.0 * none.error >= 4.6e-4, "{none:?}");
    }

    #[test]
    fn equal_points_have_no_density() {
        assert_eq!(OrderedPoints::new(vec![1.0; 5000]).density(10), None);
    }
}
