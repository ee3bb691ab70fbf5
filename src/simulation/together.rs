//! Results of a sample for several characteristics at once: the share that keeps all limits, and how they vary together.

use super::characteristic::{REJECTED, YieldEstimate};
use super::count::Lens;
use super::replicate::of_replicates;
use crate::assembly::Responses;
use crate::elementary::{Work, on_this_processor};
use crate::problem::Problem;
use crate::sampling::{Sampler, wilson};
use crate::verification::{OutputCorrelation, REPLICATES, student};

/// One part of a sample.
#[derive(Debug, Clone, Default)]
pub(super) struct Together {
    /// Points at which every characteristic has a value; their means, and the sums of products about them, a triangle by rows.
    count: f64,
    means: Vec<f64>,
    products: Vec<f64>,
    /// Points at which every characteristic with limits has a value, and those of them that keep all limits.
    known: u64,
    kept: u64,
}

impl Together {
    /// The parts of a portion, by their numbers; none of a single characteristic.
    pub(super) fn of(out: &Responses, lenses: &[Lens], sampler: Sampler, replicate: u64) -> Vec<(usize, Self)> {
        if lenses.len() < 2 {
            return Vec::new();
        }
        let groups = on_this_processor(Groups { out, lenses });
        match sampler {
            Sampler::Sobol => {
                let mut whole = Self::default();
                groups.iter().for_each(|group| whole.merge(group));
                vec![(replicate as usize, whole)]
            }
            Sampler::Random => groups.into_iter().enumerate().collect(),
        }
    }

    /// Takes in another part (Pébay 2008, equation 3.12).
    pub(super) fn merge(&mut self, other: &Self) {
        self.known += other.known;
        self.kept += other.kept;
        if other.count == 0.0 {
            return;
        }
        if self.count == 0.0 {
            (self.count, self.means, self.products) = (other.count, other.means.clone(), other.products.clone());
            return;
        }
        let count = self.count + other.count;
        let by = self.count * other.count / count;
        let apart: Vec<f64> = other.means.iter().zip(&self.means).map(|(other, own)| other - own).collect();
        let mut index = 0;
        for a in 0..apart.len() {
            for b in a..apart.len() {
                self.products[index] += other.products[index] + by * apart[a] * apart[b];
                index += 1;
            }
        }
        self.means.iter_mut().zip(&apart).for_each(|(mean, apart)| *mean += apart * other.count / count);
        self.count = count;
    }

    /// The coefficient of every pair, NaN where one of the two does not vary.
    fn coefficients(&self) -> Vec<f64> {
        let n = self.means.len();
        let at = |a: usize, b: usize| self.products[a * n - a * (a + 1) / 2 + b];
        let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
        let of = |(a, b): (usize, usize)| {
            let scale = at(a, a).sqrt() * at(b, b).sqrt();
            if scale > 0.0 { (at(a, b) / scale).clamp(-1.0, 1.0) } else { f64::NAN }
        };
        if self.count < 2.0 { vec![f64::NAN; n * n.saturating_sub(1) / 2] } else { pairs.map(of).collect() }
    }
}

/// Every sixteenth point of a portion is a part of its own.
struct Groups<'a> {
    out: &'a Responses,
    lenses: &'a [Lens],
}

impl Work for Groups<'_> {
    type Output = Vec<Together>;

    #[inline(always)]
    fn work(self) -> Vec<Together> {
        let Self { out, lenses } = self;
        let columns: Vec<&[f64]> = (0..lenses.len()).map(|output| out.column(output)).collect();
        let mut groups = vec![Together::default(); REPLICATES];
        let limited: Vec<usize> = (0..lenses.len()).filter(|&c| lenses[c].limits.exist()).collect();
        if limited.len() > 1 {
            let (mut known, mut kept) = (vec![1.0; out.rows()], vec![1.0; out.rows()]);
            for &c in &limited {
                let lower = lenses[c].limits.lower().unwrap_or(f64::NEG_INFINITY);
                let upper = lenses[c].limits.upper().unwrap_or(f64::INFINITY);
                for ((known, kept), &value) in known.iter_mut().zip(&mut kept).zip(columns[c]) {
                    *known = if value.is_nan() { 0.0 } else { *known };
                    *kept = if value >= lower && value <= upper { *kept } else { 0.0 };
                }
            }
            let counts = [by_group(&known), by_group(&kept)];
            for (group, together) in groups.iter_mut().enumerate() {
                [together.known, together.kept] = [counts[0][group] as u64, counts[1][group] as u64];
            }
        }
        if lenses.len() > OutputCorrelation::MOST {
            return groups;
        }
        let mut full = vec![1.0; out.rows()];
        for column in &columns {
            for (full, value) in full.iter_mut().zip(*column) {
                *full = if value.is_finite() { *full } else { 0.0 };
            }
        }
        let counts = by_group(&full);
        let Some(first) = full.iter().position(|&full| full > 0.0) else { return groups };
        let mut deviations: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
        for column in &columns {
            // About the first value, so that the sum of large values does not round.
            let at = column[first];
            let apart = column.iter().zip(&full).map(|(value, &full)| if full > 0.0 { value - at } else { 0.0 });
            let mut apart: Vec<f64> = apart.collect();
            let mut means = by_group(&apart);
            for (mean, count) in means.iter_mut().zip(counts) {
                *mean = if count > 0.0 { *mean / count } else { 0.0 };
            }
            for (apart, full) in apart.chunks_mut(REPLICATES).zip(full.chunks(REPLICATES)) {
                for ((apart, full), mean) in apart.iter_mut().zip(full).zip(&means) {
                    *apart = if *full > 0.0 { *apart - mean } else { 0.0 };
                }
            }
            groups.iter_mut().zip(means).for_each(|(together, mean)| together.means.push(at + mean));
            deviations.push(apart);
        }
        groups.iter_mut().zip(counts).for_each(|(together, count)| together.count = count);
        for (a, first) in deviations.iter().enumerate() {
            for second in &deviations[a..] {
                let sums = products_by_group(first, second);
                groups.iter_mut().zip(sums).for_each(|(together, sum)| together.products.push(sum));
            }
        }
        groups
    }
}

/// The sum over the points of every group.
#[inline(always)]
fn by_group(values: &[f64]) -> [f64; REPLICATES] {
    let (rows, rest) = values.as_chunks::<REPLICATES>();
    let mut sums = [0.0; REPLICATES];
    for row in rows {
        for group in 0..REPLICATES {
            sums[group] += row[group];
        }
    }
    sums.iter_mut().zip(rest).for_each(|(sum, value)| *sum += value);
    sums
}

/// The same of products.
#[inline(always)]
fn products_by_group(first: &[f64], second: &[f64]) -> [f64; REPLICATES] {
    let (rows, rest) = first.as_chunks::<REPLICATES>();
    let (others, other_rest) = second.as_chunks::<REPLICATES>();
    let mut sums = [0.0; REPLICATES];
    for (row, other) in rows.iter().zip(others) {
        for group in 0..REPLICATES {
            sums[group] += row[group] * other[group];
        }
    }
    sums.iter_mut().zip(rest.iter().zip(other_rest)).for_each(|(sum, (a, b))| *sum += a * b);
    sums
}

/// The parts of a whole sample, in the order of their numbers.
pub(super) fn parts() -> Vec<Together> {
    vec![Together::default(); REPLICATES]
}

/// The correlation of every pair of characteristics; none of a single one, and of more than 40. Errors by the jackknife over the parts.
pub(super) fn correlations(problem: &Problem, parts: &[Together]) -> Vec<OutputCorrelation> {
    let names: Vec<&str> = problem.characteristics().iter().map(|one| one.name()).collect();
    if !(2..=OutputCorrelation::MOST).contains(&names.len()) {
        return Vec::new();
    }
    let all = |except: Option<usize>| {
        let mut whole = Together::default();
        parts.iter().enumerate().filter(|(p, _)| Some(*p) != except).for_each(|(_, part)| whole.merge(part));
        whole.coefficients()
    };
    let values = all(None);
    let known = parts.iter().filter(|part| part.count > 0.0).count();
    let without: Vec<Vec<f64>> =
        if known == parts.len() { (0..known).map(|part| all(Some(part))).collect() } else { Vec::new() };
    let pairs = (0..names.len()).flat_map(|a| (a + 1..names.len()).map(move |b| (a, b)));
    let of = |(index, (a, b)): (usize, (usize, usize))| {
        let n = without.len() as f64;
        let mean = without.iter().map(|of| of[index]).sum::<f64>() / n;
        let squares: f64 = without.iter().map(|of| (of[index] - mean).powi(2)).sum();
        let error = student(REPLICATES) * (squares * (n - 1.0) / n).sqrt();
        let value = values.get(index).copied().filter(|value| value.is_finite());
        OutputCorrelation {
            between: [a, b].map(|c| names[c].to_owned()),
            value,
            error: value.and(Some(error).filter(|error| error.is_finite())),
        }
    };
    pairs.enumerate().map(of).collect()
}

/// The share that keeps all limits, of `answered` points; None with fewer than two characteristics that have limits.
pub(super) fn joint(parts: &[Together], sampler: Sampler, answered: u64) -> Option<YieldEstimate> {
    let (known, kept) = parts.iter().fold((0, 0), |(known, kept), part| (known + part.known, kept + part.kept));
    if known == 0 {
        return None;
    }
    let value = kept as f64 / known as f64;
    let few = kept.min(known - kept) < REJECTED * parts.len() as u64;
    let each = parts.iter().map(|part| (part.known > 0).then(|| part.kept as f64 / part.known as f64));
    let interval = match of_replicates(each).filter(|_| sampler == Sampler::Sobol) {
        Some(error) if !few && error > 0.0 => [(value - 2.0 * error).max(0.0), (value + 2.0 * error).min(1.0)],
        _ => wilson(kept as f64, known as f64),
    };
    let bounds = [kept, kept + answered.saturating_sub(known)].map(|most| most as f64 / answered.max(1) as f64);
    Some(YieldEstimate { value, interval, bounds })
}
