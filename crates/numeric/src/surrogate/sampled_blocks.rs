//! Moments of a surface over blocks with too many places for pooling: sampled from the surface, with standard errors.
//!
//! No model is evaluated, the sample does not depend on the seed of a study, and blocks are drawn by their places.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::moments::{Contributions, Moments, Sampled};
use crate::parallel::prelude::*;
use crate::sampling::Summary;
use crate::surrogate::block_surface::Setting;
use crate::surrogate::sampled_remainder::BLOCKS;

/// Rough bound for the operations of the sample.
const EFFORT: usize = 1 << 27;
/// Smallest number of points of the sample, also if the bound for the operations is exceeded.
const FEWEST: usize = 1 << 14;
/// Greatest number of points of the sample.
const MOST: usize = 1 << 20;

/// Group of points of the sample, with its own seed.
struct Group {
    summary: Summary,
    /// Product of every part's line with the whole.
    lines: Vec<f64>,
    /// Product of every part's rest with the whole.
    rests: Vec<f64>,
    products: Vec<f64>,
}

/// Moments and contributions by a sample.
pub(super) fn contributions(setting: &Setting<'_>) -> Contributions {
    let n = setting.parts.len();
    let lines: Vec<f64> = (0..n).map(|j| setting.line(j)).collect();
    let means: Vec<f64> = (0..n).map(|j| mean_of(setting, j)).collect();
    let together = |&(j, k, value): &(usize, usize, f64)| value * setting.correlation.of(j, k);
    let mean = means.iter().sum::<f64>() + setting.pairs.iter().map(together).sum::<f64>();
    let draws = (EFFORT / (n + setting.pairs.len())).clamp(FEWEST, MOST) / BLOCKS as usize;
    let groups: Vec<Group> =
        (0..BLOCKS).into_par_iter().map(|seed| group(setting, (&lines, &means, mean), seed, draws)).collect();
    // Moments of all groups, and without each of them for the jackknife.
    let all = |except: Option<usize>| {
        let mut whole = Summary::default();
        groups.iter().enumerate().filter(|(g, _)| Some(*g) != except).for_each(|(_, of)| whole.merge(&of.summary));
        let sigma = whole.moment(2).sqrt();
        [sigma, whole.moment(3) / sigma.powi(3), whole.moment(4) / sigma.powi(4) - 3.0]
    };
    let found = all(None);
    let without: Vec<[f64; 3]> = (0..groups.len()).map(|g| all(Some(g))).collect();
    let errors = [0, 1, 2].map(|i| {
        let mean = without.iter().map(|of| of[i]).sum::<f64>() / BLOCKS as f64;
        let squares: f64 = without.iter().map(|of| (of[i] - mean).powi(2)).sum();
        (squares * (BLOCKS as f64 - 1.0) / BLOCKS as f64).sqrt()
    });
    // Divide the sampled covariances by their sum, so that the shares sum to 1.
    let sum = |of: &dyn Fn(&Group) -> f64| groups.iter().map(of).sum::<f64>();
    let total = sum(&|group| group.lines.iter().chain(&group.rests).chain(&group.products).sum());
    let share = |of: &dyn Fn(&Group) -> f64| if total > 0.0 { sum(of) / total } else { 0.0 };
    let sigma = found[0] * setting.scale;
    Contributions {
        moments: Moments::new(setting.centre + mean * setting.scale, sigma, found[1], found[2]),
        linear: (0..n).map(|j| share(&|group| group.lines[j])).collect(),
        curvature: (0..n).map(|j| share(&|group| group.rests[j])).collect(),
        mean_shift: means.iter().map(|mean| mean * setting.scale).collect(),
        per_sigma: 1.0 / sigma,
        products: Some(
            (setting.pairs.iter().enumerate())
                .map(|(index, &(j, k, _))| ((j, k), share(&|group| group.products[index])))
                .collect(),
        ),
        sampled: Some(Sampled {
            samples: draws * BLOCKS as usize,
            sigma: errors[0] * setting.scale,
            skewness: errors[1],
            kurtosis: errors[2],
        }),
    }
}

/// Mean of an input's univariate part.
fn mean_of(setting: &Setting<'_>, j: usize) -> f64 {
    match setting.block_of[j] {
        None => setting.parts[j].term(&setting.shapes[j]).mean(),
        Some((block, coordinate)) => {
            (setting.atoms[block].iter()).map(|atom| atom.weight * setting.parts[j].value(atom.u[coordinate])).sum()
        }
    }
}

fn group(setting: &Setting<'_>, (lines, means, mean): (&[f64], &[f64], f64), seed: u64, draws: usize) -> Group {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let n = setting.parts.len();
    let others = setting.correlation.without_blocks();
    let others = others.as_ref().map(|of| (of.members(), of.factor(), of.transforms()));
    // Running sums of the weights of each block, to draw its places by probability.
    let sums: Vec<Vec<f64>> = (setting.atoms.iter())
        .map(|atoms| {
            let mut below = 0.0;
            let running = atoms.iter().map(|atom| {
                below += atom.weight;
                below
            });
            running.collect()
        })
        .collect();
    let mut found = Group {
        summary: Summary::default(),
        lines: vec![0.0; n],
        rests: vec![0.0; n],
        products: vec![0.0; setting.pairs.len()],
    };
    let (mut values, mut u, mut own) = (Vec::with_capacity(draws), vec![0.0; n], vec![0.0; n]);
    for _ in 0..draws {
        let places: Vec<usize> = (sums.iter())
            .map(|sums| {
                let level: f64 = rng.random();
                sums.partition_point(|&below| below <= level).min(sums.len() - 1)
            })
            .collect();
        // Members take the coordinates of the place of their block, other inputs are drawn independently.
        for (j, u) in u.iter_mut().enumerate() {
            *u = match setting.block_of[j] {
                Some((block, coordinate)) => setting.atoms[block][places[block]].u[coordinate],
                None => setting.shapes[j].rule.at_level(rng.random()),
            };
        }
        // Replace correlated inputs outside the blocks by functions of correlated normal variables.
        if let Some((members, factor, transforms)) = &others {
            let independent: Vec<f64> = members.iter().map(|_| rng.sample(StandardNormal)).collect();
            for (a, &position) in members.iter().enumerate() {
                let z: f64 = independent.iter().enumerate().map(|(w, own)| factor[(a, w)] * own).sum();
                u[position] = transforms[a].value(z);
            }
        }
        own.iter_mut().zip(&setting.parts).zip(&u).for_each(|((own, part), u)| *own = part.value(*u));
        let products = setting.pairs.iter().map(|&(j, k, value)| value * u[j] * u[k]);
        let y = own.iter().sum::<f64>() + products.clone().sum::<f64>();
        // Add the covariances of lines, rests and products with the whole.
        let off = y - mean;
        for j in 0..n {
            let line = lines[j] * u[j];
            found.lines[j] += off * line;
            found.rests[j] += off * (own[j] - line - means[j]);
        }
        let together = setting.pairs.iter().map(|&(j, k, value)| value * setting.correlation.of(j, k));
        found.products.iter_mut().zip(products.zip(together)).for_each(|(sum, (at, mean))| *sum += off * (at - mean));
        values.push(y);
    }
    found.summary = Summary::of(&values);
    found
}
