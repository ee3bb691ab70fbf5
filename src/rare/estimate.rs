//! Estimates of a small probability by weighted points.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::rare::unmet::{Group, Unmet};
use sensitol_numeric::sampling::Estimate;

/// Number of effective points beyond the limit from which the interval is that of a sum, not of counts.
const MANY: f64 = 30.0;
/// Ratio of the greatest weight beyond the limit to the average there above which still greater ones are likely.
const HEAVY: f64 = 3.0;
/// The 97.5 % quantile of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;
/// Mean number of hits for which a sample has none with a probability of 2.5 %: `-ln 0.025`.
const UNSEEN: f64 = 3.688_879_454_113_936;
/// Least probability that is given as a value, some 26 sigmas out. Below it only a bound is given.
const FAINTEST: f64 = 1e-150;
/// Greatest ratio of a weight to the greatest beyond the limit for a point that lies next to it. The ratio is larger if
/// weights differ widely, because unseen ones differ more.
const NEXT: f64 = 3.0;

/// Sums over weighted points, each beyond the limit or not.
///
/// Weights are as small as the probability, and their squares would underflow at 27 sigma. All sums are therefore of
/// weights divided by the greatest beyond the limit, whose logarithm is `scale`.
#[derive(Debug, Clone)]
pub(super) struct Weighed {
    scale: f64,
    /// Sum of the weights beyond the limit.
    sum: f64,
    /// Sum of their squares.
    squares: f64,
    stages: Vec<Stage>,
    /// Number of points, including those without a value.
    points: u64,
    /// Number of points beyond the limit.
    hits: u64,
    /// Logarithms of the weights of the points within the limit.
    others: Vec<f64>,
    /// Sum of the weights of the points without a value.
    unknown: f64,
    /// Bound of the probability that no explored point met.
    unmet: Option<Unmet>,
    /// Points of the components without a place, which may meet any region.
    watching: Vec<Group>,
}

impl Default for Weighed {
    fn default() -> Self {
        Self {
            scale: f64::NEG_INFINITY,
            sum: 0.0,
            squares: 0.0,
            stages: Vec::new(),
            points: 0,
            hits: 0,
            others: Vec::new(),
            unknown: 0.0,
            unmet: None,
            watching: Vec::new(),
        }
    }
}

/// Points of a stage, the sum of their weights beyond, and the variance of that sum.
#[derive(Debug, Clone, Copy, Default)]
struct Stage {
    points: f64,
    sum: f64,
    variance: f64,
}

/// Mean squared deviation of the stages, in squared standard errors, above which they disagree by more than chance.
const APART: f64 = 4.0;

/// Greatest ratio of a stage's standard error to the one that its number of points allows, if it confirms that of all
/// points.
const CONFIRMING: f64 = 1.5;
/// Greatest difference of a confirming stage from the others, in standard errors of the difference.
const AGREEING: f64 = 3.0;

/// Factor of the uncertainty of a standard error, by which the interval is wider. That uncertainty is about one by the
/// root of the number of points that bear it.
const UNSURE: f64 = 5.0;
/// Part of the estimate on a single point above which the interval is wider by this part.
const ALONE: f64 = 0.1;

/// Estimate of a probability.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ProbabilityEstimate {
    /// None if no point lies beyond.
    pub(super) probability: Option<Estimate>,
    pub(super) interval: [f64; 2],
    /// Probability if no point without a value lies beyond, and if all do.
    pub(super) bounds: [f64; 2],
    pub(super) hits: u64,
    /// Points with a value, beyond the limit or not.
    pub(super) points: u64,
    pub(super) effective: f64,
    /// Part of the estimate that the heaviest point has.
    pub(super) greatest_part: Option<f64>,
}

impl Weighed {
    /// Adds a stage. Each point has the component that it was drawn from, the logarithm of its weight, and true if it
    /// is sought. The last is None if the model has no value.
    ///
    /// The number of points of each component is fixed, so that the variance is the sum of the components' own.
    pub(super) fn add(&mut self, components: usize, points: &[(usize, f64, Option<bool>)]) {
        let hits = points.iter().filter(|point| point.2 == Some(true));
        self.rescale(hits.map(|point| point.1).fold(self.scale, f64::max));
        let mut sums = vec![[0.0; 3]; components];
        for &(component, weight, beyond) in points {
            self.points += 1;
            sums[component][0] += 1.0;
            match beyond {
                Some(true) => {
                    self.hits += 1;
                    let weight = libm::exp(weight - self.scale);
                    sums[component][1] += weight;
                    sums[component][2] += weight * weight;
                }
                Some(false) => self.others.push(weight),
                None => self.unknown += libm::exp(weight),
            }
        }
        let mut stage = Stage::default();
        for [n, sum, squares] in sums {
            stage.points += n;
            stage.sum += sum;
            self.squares += squares;
            // A single point gives no deviation, so its square is used.
            let apart = if n > 1.0 { (squares - sum * sum / n).max(0.0) * n / (n - 1.0) } else { squares };
            stage.variance += apart;
        }
        self.sum += stage.sum;
        self.stages.push(stage);
    }

    /// Sets the bound of the probability that no explored point met.
    pub(super) fn bound(&mut self, unmet: Option<Unmet>) {
        self.unmet = unmet;
    }

    /// Counts points of a component without a place.
    pub(super) fn watch(&mut self, more: Group) {
        match self.watching.iter_mut().find(|group| group.scale == more.scale) {
            Some(group) => group.points += more.points,
            None => self.watching.push(more),
        }
    }

    /// Bound of the probability of a region that is not in the sum.
    ///
    /// Explored rejects that nothing explains raise it. The points of the sum have met such a region too, or they bound
    /// it on their own.
    pub(super) fn unmet(&self) -> Option<Unmet> {
        self.unmet.map(|unmet| unmet.least(&self.watching))
    }

    /// Drops all points, and keeps the bound.
    pub(super) fn forget(&mut self) {
        *self = Self { unmet: self.unmet, ..Self::default() };
    }

    /// Part of the sum that is borne by points with these logarithms of weights.
    pub(super) fn part(&self, logarithms: impl Iterator<Item = f64>) -> f64 {
        logarithms.map(|weight| libm::exp(weight - self.scale)).sum::<f64>() / self.sum
    }

    /// True if the last stage agrees with those before, and its standard error is at most 1.5 times that of its number of points.
    pub(super) fn confirmed(&self, wanted: f64) -> bool {
        let Some((last, before)) = self.stages.split_last().filter(|(_, before)| !before.is_empty()) else {
            return false;
        };
        let all = before.iter().fold(Stage::default(), |all, stage| Stage {
            points: all.points + stage.points,
            sum: all.sum + stage.sum,
            variance: all.variance + stage.variance,
        });
        let apart = (last.sum / last.points - all.sum / all.points).abs();
        let error = libm::hypot(last.variance.sqrt() / last.points, all.variance.sqrt() / all.points);
        let allowed = CONFIRMING * wanted * (self.points as f64 / last.points).sqrt();
        last.variance.sqrt() <= allowed * last.sum && apart <= AGREEING * error
    }

    /// Changes the scale of all sums to a greater weight with this logarithm.
    fn rescale(&mut self, scale: f64) {
        if scale > self.scale {
            let by = libm::exp(self.scale - scale);
            self.sum *= by;
            self.squares *= by * by;
            for stage in &mut self.stages {
                stage.sum *= by;
                stage.variance *= by * by;
            }
            self.scale = scale;
        }
    }

    /// Variance of the sum: the sum over all components of all stages.
    ///
    /// It is greater if the stages disagree (Birge 1932), because a late stage has then found rejects that earlier ones
    /// missed.
    fn variance(&self) -> f64 {
        let (mean, all) = (self.sum / self.points as f64, self.stages.iter().map(|stage| stage.variance).sum::<f64>());
        let apart = |stage: &Stage| {
            // A stage without a hit has no variance of its own, so it gets its part of that of all.
            let variance = stage.variance.max(all * stage.points / self.points as f64);
            (stage.sum - mean * stage.points).powi(2) / variance
        };
        let ratio = self.stages.iter().map(apart).sum::<f64>() / (self.stages.len() as f64 - 1.0).max(1.0);
        if ratio > APART { all * ratio } else { all }
    }

    /// Estimate from the mean of the weights beyond the limit and its standard error. Returns None if there is no
    /// point.
    ///
    /// The interval is lognormal if many points bear it, and wider by the uncertainty of the standard error. If few
    /// points bear it or their weights differ widely, it is that of a weighted count (Fay and Feuer 1997), in the
    /// second case with a greater weight than any seen. The region next to the farthest of them, where no point was
    /// beyond, may hold as much as the bound for no hit. The two are joined by the method of Zou and Donner (2008). The
    /// region farther out is taken to be empty, as the points show.
    pub(super) fn found(&self) -> Option<ProbabilityEstimate> {
        if self.points == 0 {
            return None;
        }
        let n = self.points as f64;
        if self.hits == 0 {
            let heaviest = libm::exp(self.others.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let most = (UNSEEN * heaviest.max(self.unknown) / n).min(1.0);
            let interval = [0.0, self.unmet().map_or(most, |unmet| unmet.most.min(most))];
            let bounds = [0.0, (self.unknown / n).min(1.0)];
            return Some(ProbabilityEstimate {
                points: self.seen(),
                interval,
                bounds,
                ..ProbabilityEstimate::default()
            });
        }
        let value = self.sum / n;
        let error = self.variance().sqrt() / n;
        let effective = self.sum * self.sum / self.squares;
        let heavy = self.spread() / HEAVY;
        let ratio = libm::exp(Z * error / value * (1.0 + UNSURE / effective.sqrt()));
        let [low, high] = match (effective >= MANY, heavy <= 1.0) {
            (true, true) => [value / ratio, value * ratio],
            (many, _) => {
                let [low, high] = counted(value, self.squares / (n * n), heavy.max(1.0) / n);
                if many { [low.min(value / ratio), high.max(value * ratio)] } else { [low, high] }
            }
        };
        let alone = Some(1.0 / self.sum).filter(|&part| part > ALONE).unwrap_or(0.0);
        let [low, high] = [low * (1.0 - alone).max(0.0), high * (1.0 + alone)];
        let unseen = UNSEEN * self.next() / n;
        let high = value + libm::hypot(high - value, unseen);
        let probability = |scaled: f64| libm::exp(libm::log(scaled) + self.scale).min(1.0);
        let found = ProbabilityEstimate {
            probability: Some(Estimate {
                value: probability(value),
                standard_error: (self.points > 1).then(|| probability(error)),
            }),
            interval: [low, high].map(probability),
            bounds: [0.0, self.unknown / n].map(|unknown| (probability(value) + unknown).min(1.0)),
            hits: self.hits,
            points: self.seen(),
            effective,
            greatest_part: Some(1.0 / self.sum),
        };
        let found = if probability(value) < FAINTEST { found.out_of_reach() } else { found };
        Some(found.with_unmet(self.unmet()))
    }

    /// Number of points with a value.
    fn seen(&self) -> u64 {
        self.hits + self.others.len() as u64
    }
}

impl ProbabilityEstimate {
    /// Bound in place of an estimate, for a probability below `FAINTEST`.
    fn out_of_reach(self) -> Self {
        let bound = |high: f64| high.max(FAINTEST);
        let (interval, bounds) = ([0.0, bound(self.interval[1])], [0.0, bound(self.bounds[1])]);
        Self { probability: None, interval, bounds, greatest_part: None, ..self }
    }

    /// Estimate whose interval has the bound of unseen rejects, joined by the method of Zou and Donner (2008).
    fn with_unmet(self, unmet: Option<Unmet>) -> Self {
        let value = self.probability.map_or(0.0, |found| found.value);
        let apart = libm::hypot(self.interval[1] - value, unmet.map_or(0.0, |unmet| unmet.most));
        Self { interval: [self.interval[0], (value + apart).min(1.0)], ..self }
    }

    /// Estimate for the complement of the sought values. If none of those was seen, its probability is 1.
    pub(super) fn complement(self) -> Self {
        let all = Estimate { value: 1.0, standard_error: None };
        let rest = |Estimate { value, standard_error }: Estimate| Estimate { value: 1.0 - value, standard_error };
        Self {
            probability: Some(self.probability.map_or(all, rest)),
            interval: [1.0 - self.interval[1], 1.0 - self.interval[0]],
            bounds: [1.0 - self.bounds[1], 1.0 - self.bounds[0]],
            hits: self.points - self.hits,
            ..self
        }
    }
}

impl Weighed {
    /// Greatest weight beyond the limit divided by the average there.
    fn spread(&self) -> f64 {
        self.hits as f64 / self.sum
    }

    /// Average weight of the points next to those sought, on the side of the means. If none is near, the weight of the
    /// nearest.
    fn next(&self) -> f64 {
        let times = NEXT * (if self.spread() > HEAVY { self.spread() } else { 1.0 });
        let above = || self.others.iter().map(|weight| weight - self.scale).filter(|&by| by > 0.0);
        let (sum, count) = above()
            .filter(|by| *by <= libm::log(times))
            .fold((0.0, 0.0), |(sum, n), by| (sum + libm::exp(by), n + 1.0));
        if count > 0.0 {
            return sum / count;
        }
        let nearest = above().fold(f64::INFINITY, f64::min);
        if nearest.is_finite() { libm::exp(nearest) } else { 0.0 }
    }
}

/// The 95 % interval of a weighted count with this value, this sum of squares and this greatest weight.
fn counted(value: f64, squares: f64, greatest: f64) -> [f64; 2] {
    let quantile = |p: f64, freedom: f64| ChiSquared::new(freedom).map_or(f64::NAN, |law| law.inverse_cdf(p));
    let low = squares / (2.0 * value) * quantile(0.025, 2.0 * value * value / squares);
    let (more, wide) = (value + greatest, squares + greatest * greatest);
    [low, wide / (2.0 * more) * quantile(0.975, 2.0 * more * more / wide)]
}

/// Parts of the components that minimise the variance of the weights.
///
/// Minimises `sum_i w_i / sum_k a_k h_ik`, the second moment of the weights estimated from `hits`, over the parts `a`.
/// This is a convex function. The multiplicative steps never leave the simplex (Silvey, Titterington and Torsney 1978,
/// with the exponent 1/2 of Yu 2010).
///
/// Shapes: a hit has the logarithm of its weight, and the logarithms of the heights of the K components there. `start`
/// has length K.
pub(super) fn best_parts(hits: &[(f64, Vec<f64>)], start: &[f64]) -> Vec<f64> {
    let highest = |heights: &[f64]| heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Gains of all hits relative to the greatest: w h / d^2 is of the size of w / h.
    let sizes: Vec<f64> = hits.iter().map(|(weight, heights)| weight - highest(heights)).collect();
    let greatest = highest(&sizes);
    let scaled: Vec<(f64, Vec<f64>)> = (hits.iter().zip(&sizes))
        .map(|((_, heights), size)| {
            let highest = highest(heights);
            (libm::exp(size - greatest), heights.iter().map(|height| libm::exp(height - highest)).collect())
        })
        .collect();
    let mut parts = start.to_vec();
    for _ in 0..60 {
        let mut gains = vec![0.0; parts.len()];
        for (weight, heights) in &scaled {
            let density: f64 = parts.iter().zip(heights).map(|(part, height)| part * height).sum();
            let factor = weight / density / density;
            gains.iter_mut().zip(heights).for_each(|(gain, height)| *gain += factor * height);
        }
        parts.iter_mut().zip(&gains).for_each(|(part, gain)| *part *= gain.sqrt());
        let total: f64 = parts.iter().sum();
        parts.iter_mut().for_each(|part| *part /= total);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equal weights are a plain count, with the exact interval of a Poisson mean (Garwood 1936, to three decimals as in every
    /// table of it).
    #[test]
    fn a_count_has_the_interval_of_a_count() {
        for (count, interval) in [(1.0, [0.025, 5.572]), (2.0, [0.242, 7.225]), (10.0, [4.795, 18.390])] {
            let [low, high] = counted(count, count, 1.0);
            assert!((low - interval[0]).abs() < 6e-4 && (high - interval[1]).abs() < 6e-4, "{low} {high}");
        }
    }

    /// All goes to the first of two components with heights (4, 0) at the hits.
    #[test]
    fn parts_go_where_hits_are() {
        let (none, four) = (f64::NEG_INFINITY, 4f64.ln());
        let parts = best_parts(&[(0.0, vec![four, none]), (0.0, vec![four, 0.0])], &[0.5, 0.5]);
        assert!(parts[0] > 0.999, "{parts:?}");
    }
}
