//! The differences of model and surrogate, counted, and what they and the exact moments make together.

use super::control::{Outside, Twin, sides};
use super::replicate::of_replicates;
use crate::moments::Sampled;
use crate::sampling::{Estimate, FEWEST, Joint, wilson};

/// `v^r - t^r` for r = 1 to 4, and where model and surrogate do not agree about the limits.
#[derive(Clone, Default)]
pub(super) struct Difference {
    powers: Joint<4>,
    /// Points below and above the limits for the model, less those for the surrogate.
    moved: [i64; 2],
    /// Points outside the limits for the model only, and for the surrogate only.
    only: [u64; 2],
}

impl Difference {
    /// Of values, NaN where there is none, and the surrogate's rises at the same points.
    pub(super) fn of(values: &[f64], rises: &[f64], twin: &Twin) -> Self {
        let mut difference = Self::default();
        let mut rows = Vec::with_capacity(values.len());
        for (&value, &rise) in values.iter().zip(rises).filter(|(value, _)| !value.is_nan()) {
            let t = (rise - (twin.moments.mean - twin.centre)) / twin.moments.sigma;
            let d = ((value - twin.centre) - rise) / twin.moments.sigma;
            let v = t + d;
            // In factors, so that nothing large is subtracted.
            rows.push([d, d * (v + t), d * (v * v + v * t + t * t), d * (v + t) * (v * v + t * t)]);
            let (model, surrogate) = (sides(&twin.limits, value), twin.sides(rise));
            for (side, moved) in difference.moved.iter_mut().enumerate() {
                *moved += i64::from(model[side]) - i64::from(surrogate[side]);
            }
            match (model.contains(&true), surrogate.contains(&true)) {
                (true, false) => difference.only[0] += 1,
                (false, true) => difference.only[1] += 1,
                _ => {}
            }
        }
        difference.powers = Joint::of(&rows);
        difference
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.powers.merge(&other.powers);
        (0..2).for_each(|side| {
            self.moved[side] += other.moved[side];
            self.only[side] += other.only[side];
        });
    }

    fn net(&self) -> f64 {
        (self.only[0] as f64 - self.only[1] as f64) / self.powers.count() as f64
    }
}

/// Mean, sigma, skewness and kurtosis with their gradients by the four means of the differences; None where the variance
/// came out as nothing.
fn standardised(differences: &[f64; 4], twin: &Twin) -> [Option<(f64, [f64; 4])>; 4] {
    let [d1, d2, d3, d4] = *differences;
    let (m, m2, m3, m4) = (d1, 1.0 + d2, twin.moments.skewness + d3, twin.moments.kurtosis + d4);
    let mean = Some((twin.moments.mean + twin.moments.sigma * m, [twin.moments.sigma, 0.0, 0.0, 0.0]));
    let c2 = m2 - m * m;
    let c3 = m3 - 3.0 * m * m2 + 2.0 * m.powi(3);
    let c4 = m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m.powi(4);
    if c2.is_nan() || c2 <= 0.0 {
        return [mean, None, None, None];
    }
    let by2 = [-2.0 * m, 1.0, 0.0, 0.0];
    let by3 = [6.0 * m * m - 3.0 * m2, -3.0 * m, 1.0, 0.0];
    let by4 = [12.0 * m * m2 - 4.0 * m3 - 12.0 * m.powi(3), 6.0 * m * m, -4.0 * m, 1.0];
    let root = c2.sqrt();
    let (skewness, kurtosis) = (c3 / (c2 * root), c4 / (c2 * c2));
    let sum = |by: &[f64; 4], factor: f64, less: f64| std::array::from_fn(|i| by[i] * factor - by2[i] * less);
    [
        mean,
        Some((twin.moments.sigma * root, sum(&by2, 0.5 * twin.moments.sigma / root, 0.0))),
        Some((skewness, sum(&by3, 1.0 / (c2 * root), 1.5 * skewness / c2))),
        Some((kurtosis, sum(&by4, 1.0 / (c2 * c2), 2.0 * kurtosis / c2))),
    ]
}

/// The four moments: exact ones of the surrogate and sampled differences of all replicates, with standard errors of the
/// sample where it is random, of the replicates where there are such; None where no point has a value.
pub(super) fn moments(replicates: &[&Difference], twin: &Twin) -> [Option<Estimate>; 4] {
    let all = pooled(replicates);
    if all.powers.count() == 0 {
        return [None; 4];
    }
    let own =
        twin.sampled.map_or([0.0; 4], |Sampled { sigma, skewness, kurtosis, .. }| [0.0, sigma, skewness, kurtosis]);
    let found = standardised(all.powers.means(), twin);
    let known = replicates.iter().all(|one| one.powers.count() >= FEWEST);
    std::array::from_fn(|moment| {
        let (value, gradient) = found[moment]?;
        let standard_error = match replicates.len() {
            1 => all.powers.standard_error(&gradient),
            _ => of_replicates(replicates.iter().map(|one| {
                let means = Some(one.powers.means()).filter(|_| one.powers.count() > 0)?;
                standardised(means, twin)[moment].map(|(value, _)| value)
            })),
        };
        let standard_error = standard_error.filter(|_| known).map(|error| error.hypot(own[moment]));
        Some(Estimate { value, standard_error })
    })
}

fn pooled(replicates: &[&Difference]) -> Difference {
    let mut all = Difference::default();
    replicates.iter().for_each(|one| all.merge(one));
    all
}

/// Shares outside the limits, and the interval of the share within.
pub(super) struct Shares {
    /// Below and above.
    pub(super) outside: [f64; 2],
    pub(super) interval: [f64; 2],
}

/// The surrogate's own share and the difference of the model's. The interval combines Wilson's of the surrogate's share and
/// of the points that only the one and only the other rejects (Zou and Donner 2008), so that no disagreement seen is not
/// taken for none; where there are `enough` disagreements and replicates, what these differ by.
pub(super) fn shares(replicates: &[&Difference], outside: &Outside, enough: u64) -> Option<Shares> {
    let all = pooled(replicates);
    let (n, points) = (all.powers.count() as f64, outside.points as f64);
    if n == 0.0 {
        return None;
    }
    let hits = (outside.hits[0] + outside.hits[1]) as f64;
    let (own, ends) = (hits / points, wilson(hits, points));
    let rejected = own + all.net();
    let [gained, lost] = all.only.map(|count| (count as f64 / n, wilson(count as f64, n)));
    let mut below = (gained.0 - gained.1[0]).hypot(lost.1[1] - lost.0);
    let mut above = (gained.1[1] - gained.0).hypot(lost.0 - lost.1[0]);
    if all.only[0] + all.only[1] >= enough {
        let nets = replicates.iter().map(|one| (one.powers.count() > 0).then(|| one.net()));
        if let Some(error) = of_replicates(nets).filter(|&error| error > 0.0) {
            (below, above) = (2.0 * error, 2.0 * error);
        }
    }
    let most = rejected + above.hypot(ends[1] - own);
    let least = rejected - below.hypot(own - ends[0]);
    Some(Shares {
        outside: [0, 1].map(|side| (outside.hits[side] as f64 / points + all.moved[side] as f64 / n).clamp(0.0, 1.0)),
        interval: [1.0 - most, 1.0 - least].map(|end| end.clamp(0.0, 1.0)),
    })
}
