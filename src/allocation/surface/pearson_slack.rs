//! Slack for sigma with a required yield, by the Pearson fit of four moments.
//!
//! ```text
//! F(s) = P(z < -below/s) + P(z > above/s) = q       z standardised, with the skewness g and the excess e of the moments
//! d ln s/d mean = (p_b - p_a)/(below p_b + above p_a)      p_b, p_a: densities at the limits
//! d ln s/d g = -(dF/dg)/(dF/d ln s),  dF/d ln s = (below p_b + above p_a)/s,  and alike for e
//! ```

use sensitol_numeric::capability::Law;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::optimise::root::root;
use sensitol_numeric::pearson::Pearson;

/// Step of differences in skewness and excess. Truncation and rounding are both near 1e-8.
const STEP: f64 = 1e-4;

/// Greatest sigma for an allowed reject rate, with limits at these distances from the mean and a fit of this shape.
pub(in crate::allocation) struct YieldSlack {
    law: Box<Pearson>,
    shape: [f64; 2],
    below: Option<f64>,
    above: Option<f64>,
    sigma: f64,
}

impl YieldSlack {
    /// Computes the slack. Returns None if no distribution has these moments, and if no sigma rejects so little.
    pub(in crate::allocation) fn of(
        moments: &Moments,
        [below, above]: [Option<f64>; 2],
        rejected: f64,
    ) -> Option<Self> {
        let shape = [moments.skewness().unwrap_or(0.0), moments.excess().unwrap_or(0.0)];
        let room = Self { law: law_of(shape)?, shape, below, above, sigma: f64::NAN };
        Some(Self { sigma: room.solved(rejected)?, ..room })
    }

    /// Sigma at which just the allowed share is rejected.
    pub(in crate::allocation) fn sigma(&self) -> f64 {
        self.sigma
    }

    fn solved(&self, rejected: f64) -> Option<f64> {
        let Self { law, below, above, .. } = self;
        let single = |distance: f64, quantile: f64| match (distance > 0.0, quantile > 0.0) {
            (true, true) => Some(distance / quantile),
            // At least half of the assemblies keep this limit at any sigma, which is enough.
            (true, false) => Some(f64::INFINITY),
            (false, _) => None,
        };
        let alone = [
            below.map(|distance| single(distance, -law.quantile(rejected))),
            above.map(|distance| single(distance, law.upper_quantile(rejected))),
        ];
        let (low, high) = match alone {
            [None, None] => return None,
            [Some(only), None] | [None, Some(only)] => return only,
            [Some(low), Some(high)] => (low?, high?),
        };
        // Each limit may use the whole allowed share, or half of it. The root lies between these two sigmas.
        let most = low.min(high);
        if !most.is_finite() {
            return None;
        }
        let miss = |ln: f64| libm::log(self.share(law, libm::exp(ln)) / rejected);
        let half = [(below, -law.quantile(0.5 * rejected)), (above, law.upper_quantile(0.5 * rejected))];
        let least = half.iter().filter_map(|&(distance, quantile)| single((*distance)?, quantile)).fold(most, f64::min);
        Some(libm::exp(root(miss, [libm::log(least), libm::log(most)], 0.0)))
    }

    /// Derivatives of the logarithm of sigma by mean, skewness and excess.
    pub(in crate::allocation) fn slopes(&self) -> Option<[f64; 3]> {
        let sigma = self.sigma;
        if !sigma.is_finite() {
            return None;
        }
        let at =
            |distance: Option<f64>, sign: f64| distance.map_or(0.0, |distance| self.law.pdf(sign * distance / sigma));
        let (p_below, p_above) = (at(self.below, -1.0), at(self.above, 1.0));
        let over = self.below.unwrap_or(0.0) * p_below + self.above.unwrap_or(0.0) * p_above;
        let by_sigma = over / sigma;
        let limits = [self.below.map(|distance| -distance / sigma), self.above.map(|distance| distance / sigma)];
        let exact = self.law.outside_by_shape(limits[0], limits[1]);
        let [by_skewness, by_excess] = exact.or_else(|| self.by_differences())?.map(|slope| -slope / by_sigma);
        let slopes = [(p_below - p_above) / over, by_skewness, by_excess];
        slopes.iter().all(|slope| slope.is_finite()).then_some(slopes)
    }

    /// Derivatives of the rejected share by skewness and excess, if the density ends too abruptly for formulas.
    fn by_differences(&self) -> Option<[f64; 2]> {
        let here = self.share(&self.law, self.sigma);
        let by_shape = |index: usize| {
            let share = |step: f64| {
                let mut shape = self.shape;
                shape[index] += step;
                law_of(shape).map(|law| self.share(&law, self.sigma))
            };
            Some(match (share(STEP), share(-STEP)) {
                (Some(up), Some(down)) => (up - down) / (2.0 * STEP),
                // Beside the least kurtosis only one side exists.
                (Some(up), None) => (up - here) / STEP,
                (None, Some(down)) => (here - down) / STEP,
                (None, None) => return None,
            })
        };
        Some([by_shape(0)?, by_shape(1)?])
    }

    /// Rejected share of a standardised fit at a sigma.
    fn share(&self, law: &Pearson, sigma: f64) -> f64 {
        let below = self.below.map_or(0.0, |distance| law.cdf(-distance / sigma));
        below + self.above.map_or(0.0, |distance| law.sf(distance / sigma))
    }
}

fn law_of([skewness, excess]: [f64; 2]) -> Option<Box<Pearson>> {
    match Law::fit(&Moments::new(0.0, 1.0, skewness, excess)).ok()? {
        Law::Pearson(law) => Some(law),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences of the slack itself, whose root is found to 1e-13. With steps of 1e-4 the rounding is 1e-8, and
    /// truncation is as large.
    #[test]
    fn slopes_are_the_differences_of_the_room() {
        let at = |[mean, skewness, excess]: [f64; 3], limits: [Option<f64>; 2]| {
            let moments = Moments::new(mean, 1.0, skewness, excess);
            YieldSlack::of(&moments, [limits[0].map(|low| mean - low), limits[1].map(|high| high - mean)], 0.0027)
                .unwrap()
        };
        let sides = [[Some(-1.0), Some(1.2)], [Some(-1.0), None], [None, Some(1.2)]];
        for place in [[0.1, 0.2, 0.3], [-0.2, -0.4, 0.5], [0.0, 0.1, -0.3], [0.05, 0.6, 0.55]] {
            for limits in sides {
                let found = at(place, limits).slopes().unwrap();
                for (index, found) in found.into_iter().enumerate() {
                    let ln = |step: f64| {
                        let mut place = place;
                        place[index] += step;
                        at(place, limits).sigma().ln()
                    };
                    let expected = (ln(1e-4) - ln(-1e-4)) / 2e-4;
                    assert!((found - expected).abs() <= 1e-6, "{place:?}, {limits:?}: {found} and {expected}");
                }
            }
        }
    }
}
