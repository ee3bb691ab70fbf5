//! Estimates of a small probability by weighted points.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use sensitol_numeric::sampling::Estimate;

/// Fewer effective points beyond the limit have an interval of counts, not of sums.
const MANY: f64 = 30.0;
/// A greatest weight above so many times the average of those beyond says that there are greater ones.
const HEAVY: f64 = 3.0;
/// The 97.5 % quantile of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;
/// No hit leaves room for so many, with 97.5 %: `-ln 0.025`.
const UNSEEN: f64 = 3.688_879_454_113_936;
/// A probability below this is told as a bound: some 26 sigmas out.
const FAINTEST: f64 = 1e-150;
/// Points of a weight up to so many times the greatest of those beyond the limit lie next to these; farther
/// where weights differ widely: those not seen differ more.
const NEXT: f64 = 3.0;

/// Points as they were weighed, and whether each lies beyond the limit.
///
/// Weights are as small as the probability, and their squares would be nothing at 27 sigma: all sums are of weights by the greatest of
/// those beyond, whose logarithm is `scale`.
#[derive(Debug, Clone)]
pub(super) struct Weighed {
    scale: f64,
    /// The sum and the sum of squares of those beyond.
    sum: f64,
    squares: f64,
    /// Of every stage.
    stages: Vec<Stage>,
    /// How many points there are, how many of these beyond, and how many of unknown value.
    points: u64,
    hits: u64,
    /// Logarithms of the weights of the others, and the sum of those without a value.
    others: Vec<f64>,
    unknown: f64,
    /// The most that lies beyond where no point does, as far as that is known otherwise.
    most: Option<f64>,
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
            most: None,
        }
    }
}

/// How many points a stage had, the sum of the weights beyond, and the variance of that.
#[derive(Debug, Clone, Copy, Default)]
struct Stage {
    points: f64,
    sum: f64,
    variance: f64,
}

/// Stages that differ by more than so many squared standard errors, on average, do not agree by chance.
const APART: f64 = 4.0;

/// A stage confirms the standard error of all points by one that is up to so many times that which its number of points allows,
const CONFIRMING: f64 = 1.5;
/// and by a value no more than so many standard errors of the difference away.
const AGREEING: f64 = 3.0;

/// A standard error that few points bear is itself uncertain, by about the root of one by their number: the interval is wider by so many times
/// that.
const UNSURE: f64 = 5.0;
/// A single point that bears more than this widens the interval by its part.
const ALONE: f64 = 0.1;

/// A probability, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ProbabilityEstimate {
    /// None where no point lies beyond.
    pub(super) probability: Option<Estimate>,
    pub(super) interval: [f64; 2],
    /// If no point without a value lies beyond, and if all do.
    pub(super) bounds: [f64; 2],
    pub(super) hits: u64,
    /// Points with a value, those beyond and the others.
    pub(super) points: u64,
    pub(super) effective: f64,
    /// The greatest part of it that is a single point's.
    pub(super) greatest_part: Option<f64>,
}

impl Weighed {
    /// Adds a stage: points with the component that each was drawn from, the logarithm of its weight, and whether it is one of those
    /// sought, None where the model has no value.
    ///
    /// How many points a component has is not left to chance, so that the variance is the sum of the components' own.
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
            // Of a single point nothing is known but its square.
            let apart = if n > 1.0 { (squares - sum * sum / n).max(0.0) * n / (n - 1.0) } else { squares };
            stage.variance += apart;
        }
        self.sum += stage.sum;
        self.stages.push(stage);
    }

    /// Takes what lies beyond to be no more than this, should no point lie there.
    pub(super) fn bound(&mut self, most: Option<f64>) {
        self.most = most;
    }

    /// Begins anew.
    pub(super) fn forget(&mut self) {
        *self = Self { most: self.most, ..Self::default() };
    }

    /// The part of the sum that points of these logarithms of weights bear.
    pub(super) fn part(&self, logarithms: impl Iterator<Item = f64>) -> f64 {
        logarithms.map(|weight| libm::exp(weight - self.scale)).sum::<f64>() / self.sum
    }

    /// Whether the last stage by itself agrees with those before, and has the standard error that its part of the points allows, half as
    /// much again at most.
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

    /// Measures all sums by a greater weight, whose logarithm this is.
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

    /// The variance of the sum: of all components of all stages; more where stages do not agree (Birge 1932), because
    /// something has been found that some of them knew nothing of.
    fn variance(&self) -> f64 {
        let (mean, all) = (self.sum / self.points as f64, self.stages.iter().map(|stage| stage.variance).sum::<f64>());
        let apart = |stage: &Stage| {
            // A stage that saw nothing has no variance of its own: it has its part of that of all.
            let variance = stage.variance.max(all * stage.points / self.points as f64);
            (stage.sum - mean * stage.points).powi(2) / variance
        };
        let ratio = self.stages.iter().map(apart).sum::<f64>() / (self.stages.len() as f64 - 1.0).max(1.0);
        if ratio > APART { all * ratio } else { all }
    }

    /// The mean of the weights beyond; its standard error is that of the mean.
    ///
    /// The interval is lognormal where many points bear it, wider by what these leave uncertain of the standard error, and that of a weighted count where few do or their weights
    /// differ widely (Fay and Feuer 1997; with a greater weight than any seen in the second case).
    /// The region next to the farthest of them, where no point was beyond, may hold as much as no hit leaves room for: the
    /// two are joined as Zou and Donner (2008) do. The region that lies farther is taken to be as the points say: empty.
    pub(super) fn found(&self) -> Option<ProbabilityEstimate> {
        if self.points == 0 {
            return None;
        }
        let n = self.points as f64;
        if self.hits == 0 {
            let heaviest = libm::exp(self.others.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let most = (UNSEEN * heaviest.max(self.unknown) / n).min(1.0);
            let interval = [0.0, self.most.map_or(most, |bound| bound.min(most))];
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
        Some(if probability(value) < FAINTEST { found.out_of_reach() } else { found })
    }

    /// Points with a value.
    fn seen(&self) -> u64 {
        self.hits + self.others.len() as u64
    }
}

impl ProbabilityEstimate {
    /// Of what is so improbable that only a bound is told.
    fn out_of_reach(self) -> Self {
        let bound = |high: f64| high.max(FAINTEST);
        let (interval, bounds) = ([0.0, bound(self.interval[1])], [0.0, bound(self.bounds[1])]);
        Self { probability: None, interval, bounds, greatest_part: None, ..self }
    }

    /// Of everything else than what was sought. Where nothing of that was seen, everything else is all.
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
    /// The greatest weight of those sought by the average of them.
    fn spread(&self) -> f64 {
        self.hits as f64 / self.sum
    }

    /// The weight, on average, of the points next to those sought, on the side of the means, of which none is sought; of the
    /// nearest of them where none is near.
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

/// The 95 % interval of a sum of weighted counts with this value, this sum of squares and this greatest weight.
fn counted(value: f64, squares: f64, greatest: f64) -> [f64; 2] {
    let quantile = |p: f64, freedom: f64| ChiSquared::new(freedom).map_or(f64::NAN, |law| law.inverse_cdf(p));
    let low = squares / (2.0 * value) * quantile(0.025, 2.0 * value * value / squares);
    let (more, wide) = (value + greatest, squares + greatest * greatest);
    [low, wide / (2.0 * more) * quantile(0.975, 2.0 * more * more / wide)]
}

/// By which part of a function's variance each component of a mixture should be drawn.
///
/// Minimises `sum_i w_i / sum_k a_k h_ik`, the second moment of the weights as `hits` estimate it, over the parts `a`: a
/// convex function, by multiplicative steps that never leave the simplex (Silvey, Titterington and Torsney 1978, with the
/// exponent 1/2 of Yu 2010).
///
/// Shapes: a hit is the logarithm of its weight and those of the heights of the K components there; `start` has length K.
pub(super) fn best_parts(hits: &[(f64, Vec<f64>)], start: &[f64]) -> Vec<f64> {
    let highest = |heights: &[f64]| heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The gains of all hits by the greatest of them: w h / d^2 is of the size of w / h.
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

    /// Of two components with heights (4, 0) where hits lie, all goes to the first.
    #[test]
    fn parts_go_where_hits_are() {
        let (none, four) = (f64::NEG_INFINITY, 4f64.ln());
        let parts = best_parts(&[(0.0, vec![four, none]), (0.0, vec![four, 0.0])], &[0.5, 0.5]);
        assert!(parts[0] > 0.999, "{parts:?}");
    }
}
