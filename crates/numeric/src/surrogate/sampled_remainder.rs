//! Sampled correction to the moments of a surrogate, beyond those of its parabolas.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::moments::{Contributions, Moments, Sampled};
use crate::parallel::prelude::*;
use crate::surrogate::parabolas::Parabolas;

/// Blocks of the sample, each with its own seed. Their differences give the standard error (delete-one jackknife).
pub(super) const BLOCKS: u64 = 64;
/// Rough bound for the operations of a sample.
const EFFORT: usize = 1 << 26;
/// Smallest number of points of a sample, also if the bound for the operations is exceeded.
const FEWEST: usize = 1 << 13;
/// Greatest number of points of a sample.
const MOST: usize = 1 << 19;

/// Sums over the sample, one for every quantity that is estimated.
#[derive(Clone)]
struct Sums {
    /// Sums of `y^2 - l^2` and `y^2 - q^2`, their squares, `y^3 - q^3` and `y^4 - q^4`.
    differences: [f64; 6],
    /// Product of every part's line with the nonlinear rest of the whole.
    lines: Vec<f64>,
    /// Product of every part's rest with the whole.
    rests: Vec<f64>,
    products: Vec<f64>,
}

/// Part of the surrogate as the sample needs it.
struct OwnPart {
    /// Slope of the best straight line of the part.
    p: f64,
    mean: f64,
}

struct Sampler<'a> {
    parabolas: &'a Parabolas<'a>,
    own: Vec<OwnPart>,
    pairs: Vec<(usize, usize, f64)>,
    factor: faer::Mat<f64>,
    form_mean: f64,
    mean: f64,
    scale: f64,
}

/// Moments and contributions, sampled as differences from those of the parabolas.
pub(super) fn contributions(parabolas: &Parabolas<'_>, exact: &Contributions, mean: f64) -> Contributions {
    let sampler = Sampler::new(parabolas, exact, mean);
    let draws = (EFFORT / (sampler.own.len() + sampler.pairs.len())).clamp(FEWEST, MOST) / BLOCKS as usize;
    let blocks: Vec<Sums> = (0..BLOCKS).into_par_iter().map(|block| sampler.block(block, draws)).collect();
    let samples = draws * BLOCKS as usize;
    let all = blocks.iter().fold(sampler.nothing(), |sum, block| sum.with(block, 1.0));
    let of_parabolas = central(exact, sampler.scale);
    let linear = sampler.linear_variance();
    // Choose the control variate for the variance with less spread: the lines, or the parabolas.
    let spread = |mean: usize, square: usize| {
        let n = samples as f64;
        all.differences[square] / n - (all.differences[mean] / n).powi(2)
    };
    let by_lines = spread(0, 2) <= spread(1, 3);
    let shape = |sums: &Sums, count: f64| {
        let mean = |i: usize| sums.differences[i] / count;
        let variance = if by_lines { linear + mean(0) } else { of_parabolas[0] + mean(1) };
        let [third, fourth] = [of_parabolas[1] + mean(4), of_parabolas[2] + mean(5)];
        [variance.sqrt(), third / libm::pow(variance, 1.5), fourth / (variance * variance) - 3.0]
    };
    let found = shape(&all, samples as f64);
    let count = (samples - samples / BLOCKS as usize) as f64;
    let without: Vec<[f64; 3]> = blocks.iter().map(|block| shape(&all.clone().with(block, -1.0), count)).collect();
    let errors = [0, 1, 2].map(|i| {
        let mean = without.iter().map(|values| values[i]).sum::<f64>() / BLOCKS as f64;
        let squares: f64 = without.iter().map(|values| (values[i] - mean).powi(2)).sum();
        (squares * (BLOCKS as f64 - 1.0) / BLOCKS as f64).sqrt()
    });
    let sigma = found[0] / sampler.scale;
    let shares = sampler.shares(&all, samples as f64);
    Contributions {
        moments: Moments::new(mean, sigma, found[1], found[2]),
        linear: shares.lines,
        curvature: shares.rests,
        mean_shift: exact.mean_shift.clone(),
        per_sigma: 1.0 / sigma,
        products: Some(sampler.pairs.iter().zip(shares.products).map(|(&(j, k, _), share)| ((j, k), share)).collect()),
        sampled: Some(Sampled { samples, sigma: errors[0] / sampler.scale, skewness: errors[1], kurtosis: errors[2] }),
    }
}

/// Central moments 2 to 4 of the scaled whole.
fn central(contributions: &Contributions, scale: f64) -> [f64; 3] {
    let moments = &contributions.moments;
    let sigma = moments.sigma() * scale;
    let [skewness, excess] = [moments.skewness(), moments.excess()].map(|value| value.unwrap_or(0.0));
    [sigma.powi(2), skewness * sigma.powi(3), (excess + 3.0) * sigma.powi(4)]
}

impl<'a> Sampler<'a> {
    fn new(parabolas: &'a Parabolas<'a>, exact: &Contributions, mean: f64) -> Self {
        let own: Vec<OwnPart> = (parabolas.parts.iter().enumerate())
            .map(|(j, part)| {
                let term = part.term(parabolas.shape(j));
                OwnPart { p: term.part(1.0).p, mean: term.mean() }
            })
            .collect();
        let normal = parabolas.correlation.normal();
        let m = parabolas.slopes.len();
        let form_mean = (0..m)
            .flat_map(|a| (0..m).map(move |b| (a, b)))
            .map(|(a, b)| parabolas.form[(a, b)] * normal[(a, b)])
            .sum();
        let mut sampler = Self {
            parabolas,
            own,
            pairs: parabolas.surrogate.interactions.pairs(),
            factor: parabolas.correlation.factor(),
            form_mean,
            mean,
            scale: 1.0,
        };
        let sigma = sampler.linear_variance().max(0.0).sqrt().max(exact.moments.sigma());
        let largest = parabolas.parts.iter().map(|part| part.largest()).fold(0.0, f64::max);
        sampler.scale = 1.0 / if sigma > 0.0 { sigma } else { largest };
        sampler
    }

    /// Variance of the scaled best straight lines: `p'R p`, exact for any inputs.
    fn linear_variance(&self) -> f64 {
        let n = self.own.len();
        let p = |j: usize| self.own[j].p * self.scale;
        let among_members = |j: usize| -> f64 {
            let members = self.parabolas.correlation.members();
            members.iter().filter(|&&k| k != j).map(|&k| p(k) * self.parabolas.together(j, k)).sum()
        };
        (0..n).map(|j| p(j) * (p(j) + self.parabolas.member[j].map_or(0.0, |_| among_members(j)))).sum()
    }

    fn nothing(&self) -> Sums {
        let n = self.own.len();
        Sums { differences: [0.0; 6], lines: vec![0.0; n], rests: vec![0.0; n], products: vec![0.0; self.pairs.len()] }
    }

    /// Sums over `draws` points of one block, with its own seed. (Antithetic points would help odd moments and double the error of even
    /// ones.)
    fn block(&self, block: u64, draws: usize) -> Sums {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(block);
        let mut sums = self.nothing();
        let (n, m) = (self.own.len(), self.parabolas.slopes.len());
        let (mut independent, mut z, mut u, mut rests) = (vec![0.0; m], vec![0.0; m], vec![0.0; n], vec![0.0; n]);
        for _ in 0..draws {
            independent.iter_mut().for_each(|w| *w = rng.sample(StandardNormal));
            for (j, value) in u.iter_mut().enumerate().filter(|(j, _)| self.parabolas.member[*j].is_none()) {
                *value = self.parabolas.shape(j).rule.at_level(rng.random());
            }
            for (a, z) in z.iter_mut().enumerate() {
                *z = independent.iter().enumerate().map(|(w, own)| self.factor[(a, w)] * own).sum();
            }
            for (a, &position) in self.parabolas.correlation.members().iter().enumerate() {
                u[position] = self.parabolas.correlation.transforms()[a].value(z[a]);
            }
            self.add(&z, &u, &mut rests, &mut sums);
        }
        sums
    }

    fn add(&self, z: &[f64], u: &[f64], rests: &mut [f64], sums: &mut Sums) {
        let line: f64 = self.own.iter().zip(u).map(|(own, u)| own.p * u).sum::<f64>() * self.scale;
        let mut rest = self.parabolas.surrogate.centre - self.mean;
        for ((value, part), (own, u)) in rests.iter_mut().zip(&self.parabolas.parts).zip(self.own.iter().zip(u)) {
            let raw = part.value(*u) - own.p * u;
            rest += raw;
            *value = (raw - own.mean) * self.scale;
        }
        rest += self.pairs.iter().map(|&(j, k, value)| value * u[j] * u[k]).sum::<f64>();
        let y = line + rest * self.scale;
        let q = self.parabola(z, u) * self.scale;
        let (lines, parabolas) = (y * y - line * line, y * y - q * q);
        let added =
            [lines, parabolas, lines * lines, parabolas * parabolas, y.powi(3) - q.powi(3), y.powi(4) - q.powi(4)];
        sums.differences.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
        let not_linear = y - line;
        for (sum, (own, u)) in sums.lines.iter_mut().zip(self.own.iter().zip(u)) {
            *sum += own.p * self.scale * u * not_linear;
        }
        sums.rests.iter_mut().zip(rests.iter()).for_each(|(sum, rest)| *sum += rest * y);
        for (sum, &(j, k, value)) in sums.products.iter_mut().zip(&self.pairs) {
            *sum += value * self.scale * (u[j] * u[k] - self.parabolas.together(j, k)) * y;
        }
    }

    /// Value of the parabolas in place of the surrogate, about its mean.
    fn parabola(&self, z: &[f64], u: &[f64]) -> f64 {
        let parabolas = self.parabolas;
        let m = z.len();
        let mut value = -self.form_mean;
        for a in 0..m {
            let form: f64 = (0..m).map(|b| parabolas.form[(a, b)] * z[b]).sum();
            value += z[a] * (parabolas.slopes[a] + form);
        }
        for (j, (part, own)) in parabolas.parts.iter().zip(&self.own).enumerate() {
            if parabolas.member[j].is_none() {
                value += part.value(u[j]) - own.mean;
            }
        }
        value += parabolas.across.iter().map(|&(a, k, value)| value * z[a] * u[k]).sum::<f64>();
        value + parabolas.apart.iter().map(|&(j, k, value)| value * u[j] * u[k]).sum::<f64>()
    }

    /// Covariances with the whole as shares that sum to 1. The linear ones are exact, the others sampled.
    fn shares(&self, sums: &Sums, samples: f64) -> Sums {
        let parabolas = self.parabolas;
        let p = |j: usize| self.own[j].p * self.scale;
        let among = |j: usize| match parabolas.member[j] {
            None => p(j),
            Some(_) => parabolas.correlation.members().iter().map(|&k| p(k) * parabolas.together(j, k)).sum::<f64>(),
        };
        let mut shares = self.nothing();
        for j in 0..self.own.len() {
            shares.lines[j] = p(j) * among(j) + sums.lines[j] / samples;
            shares.rests[j] = sums.rests[j] / samples;
        }
        shares.products.iter_mut().zip(&sums.products).for_each(|(share, sum)| *share = sum / samples);
        let each = |shares: &mut Sums, f: &mut dyn FnMut(&mut f64)| {
            let Sums { lines, rests, products, .. } = shares;
            lines.iter_mut().chain(rests).chain(products).for_each(f);
        };
        let mut total = 0.0;
        each(&mut shares, &mut |share| total += *share);
        each(&mut shares, &mut |share| *share /= total);
        shares
    }
}

impl Sums {
    fn with(mut self, other: &Self, factor: f64) -> Self {
        self.differences.iter_mut().zip(other.differences).for_each(|(sum, value)| *sum += factor * value);
        for (into, from) in
            [(&mut self.lines, &other.lines), (&mut self.rests, &other.rests), (&mut self.products, &other.products)]
        {
            into.iter_mut().zip(from).for_each(|(sum, value)| *sum += factor * value);
        }
        self
    }
}
