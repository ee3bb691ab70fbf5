//! Results of a sample for several characteristics at once: joint yield and correlations.

use serde::{Deserialize, Serialize};

use crate::assembly::{Responses, all_finite};
use crate::estimate::{ConditionalYield, OutputCorrelation, REPLICATES, pairs, student};
use crate::problem::Problem;
use crate::simulation::SimulatedCharacteristic;
use crate::simulation::characteristic::{REJECTED, YieldEstimate};
use crate::simulation::count::CountingScale;
use crate::simulation::replicate_error::of_replicates;
use sensitol_numeric::elementary::{Work, on_this_processor};
use sensitol_numeric::sampling::{Sampler, wilson};
use sensitol_numeric::verdict;

/// One number for every part of a sample.
type Parts<T> = [T; REPLICATES];

/// Sums of the parts of a sample.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Together {
    /// Points at which every characteristic has a value.
    count: Parts<f64>,
    /// Means of the characteristics over these points.
    means: Vec<Parts<f64>>,
    /// Sums of products about the means, an upper triangle by rows.
    products: Vec<Parts<f64>>,
    /// Points at which every characteristic with limits has a value.
    known: Parts<u64>,
    /// Points among `known` that keep all limits.
    kept: Parts<u64>,
    /// Points that keep the given limits with a value, and those among them that keep the own limits, for each characteristic that is given
    /// another.
    conditional: Vec<[Parts<u64>; 2]>,
}

impl Together {
    /// Sums of a portion, by parts. Returns None if there is a single characteristic.
    pub(super) fn of(out: &Responses, lenses: &[CountingScale], sampler: Sampler, replicate: u64) -> Option<Self> {
        if lenses.len() < 2 {
            return None;
        }
        let groups = on_this_processor(Groups { out, lenses });
        match sampler {
            Sampler::Sobol => {
                let mut whole = Self::default();
                (0..REPLICATES).for_each(|group| whole.merge_part(replicate as usize, &groups, group));
                Some(whole)
            }
            Sampler::Random => Some(groups),
        }
    }

    /// True if no count exceeds the number of points.
    pub(super) fn counts_up_to(&self, answered: u64) -> bool {
        let within = |counts: &Parts<u64>| {
            let total = counts.iter().try_fold(0u64, |sum, &count| sum.checked_add(count));
            total.is_some_and(|total| total <= answered)
        };
        let kept = self.kept.iter().zip(&self.known).all(|(kept, known)| kept <= known);
        kept && within(&self.known) && self.conditional.iter().flatten().all(within)
    }

    /// Adds another portion, part by part.
    pub(super) fn merge(&mut self, other: &Self) {
        (0..REPLICATES).for_each(|part| self.merge_part(part, other, part));
    }

    /// Adds one part of another sample to one of its own (Pébay 2008, equation 3.12).
    fn merge_part(&mut self, own: usize, other: &Self, part: usize) {
        self.known[own] += other.known[part];
        self.kept[own] += other.kept[part];
        self.conditional.resize(self.conditional.len().max(other.conditional.len()), [[0; REPLICATES]; 2]);
        for (counts, more) in self.conditional.iter_mut().zip(&other.conditional) {
            counts.iter_mut().zip(more).for_each(|(counts, more)| counts[own] += more[part]);
        }
        let [before, added] = [self.count[own], other.count[part]];
        if added == 0.0 {
            return;
        }
        self.means.resize(other.means.len(), [0.0; REPLICATES]);
        self.products.resize(other.products.len(), [0.0; REPLICATES]);
        let count = before + added;
        self.count[own] = count;
        if before == 0.0 {
            self.means.iter_mut().zip(&other.means).for_each(|(mean, other)| mean[own] = other[part]);
            self.products.iter_mut().zip(&other.products).for_each(|(sum, other)| sum[own] = other[part]);
            return;
        }
        let by = before * added / count;
        let mut sums = self.products.iter_mut().zip(&other.products);
        for a in 0..self.means.len() {
            let apart = |c: usize| other.means[c][part] - self.means[c][own];
            for (b, (sum, other)) in (a..self.means.len()).zip(&mut sums) {
                sum[own] += other[part] + by * apart(a) * apart(b);
            }
        }
        for (mean, other) in self.means.iter_mut().zip(&other.means) {
            mean[own] += (other[part] - mean[own]) * added / count;
        }
    }

    /// Correlation of every pair in the first part, NaN if one of the two does not vary.
    fn coefficients(&self) -> Vec<f64> {
        let n = self.means.len();
        let at = |a: usize, b: usize| self.products[a * n - a * (a + 1) / 2 + b][0];
        let of = |[a, b]: [usize; 2]| {
            let scale = at(a, a).sqrt() * at(b, b).sqrt();
            if scale > 0.0 { (at(a, b) / scale).clamp(-1.0, 1.0) } else { f64::NAN }
        };
        if self.count[0] < 2.0 { vec![f64::NAN; n * n.saturating_sub(1) / 2] } else { pairs(n).map(of).collect() }
    }
}

/// Sums of a portion in which every sixteenth point belongs to the same part.
struct Groups<'a> {
    out: &'a Responses,
    lenses: &'a [CountingScale],
}

impl Work for Groups<'_> {
    type Output = Together;

    #[inline(always)]
    fn work(self) -> Together {
        let Self { out, lenses } = self;
        let columns: Vec<&[f64]> = (0..lenses.len()).map(|output| out.column(output)).collect();
        let mut groups = Together::default();
        let limited: Vec<usize> = (0..lenses.len()).filter(|&c| lenses[c].limits.exist()).collect();
        if limited.len() > 1 {
            let (mut known, mut kept) = (vec![1.0; out.rows()], vec![1.0; out.rows()]);
            for &c in &limited {
                for ((known, kept), &value) in known.iter_mut().zip(&mut kept).zip(columns[c]) {
                    *known = if value.is_nan() { 0.0 } else { *known };
                    *kept = if lenses[c].limits.contains(value) { *kept } else { 0.0 };
                }
            }
            groups.known = by_group(&known).map(|count| count as u64);
            groups.kept = by_group(&kept).map(|count| count as u64);
        }
        for (c, given) in (0..lenses.len()).filter_map(|c| Some((c, lenses[c].given?))) {
            let mut counts = [vec![0.0; out.rows()], vec![0.0; out.rows()]];
            for (row, (&own, &other)) in columns[c].iter().zip(columns[given]).enumerate() {
                if !own.is_nan() && lenses[given].limits.contains(other) {
                    counts[0][row] = 1.0;
                    counts[1][row] = if lenses[c].limits.contains(own) { 1.0 } else { 0.0 };
                }
            }
            groups.conditional.push(counts.map(|counts| by_group(&counts).map(|count| count as u64)));
        }
        if lenses.len() > OutputCorrelation::MOST {
            return groups;
        }
        // Usually every value is known, and none has to be left out.
        let complete = columns.iter().all(|column| all_finite(column));
        let full: Vec<f64> = if complete { Vec::new() } else { full(&columns, out.rows()) };
        let known =
            if complete { Some(0).filter(|_| out.rows() > 0) } else { full.iter().position(|&full| full > 0.0) };
        let Some(first) = known else { return groups };
        let counts = match complete {
            true => std::array::from_fn(|group| (out.rows() + REPLICATES - 1 - group) / REPLICATES).map(|n| n as f64),
            false => by_group(&full),
        };
        let mut deviations: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
        for column in &columns {
            // About the first value, so that the sum of large values has no rounding errors.
            let at = column[first];
            let mut apart: Vec<f64> = column.iter().map(|value| value - at).collect();
            if !complete {
                apart.iter_mut().zip(&full).for_each(|(apart, &full)| *apart = if full > 0.0 { *apart } else { 0.0 });
            }
            let mut means = by_group(&apart);
            for (mean, count) in means.iter_mut().zip(counts) {
                *mean = if count > 0.0 { *mean / count } else { 0.0 };
            }
            let (rows, rest) = apart.as_chunks_mut::<REPLICATES>();
            for row in rows {
                row.iter_mut().zip(&means).for_each(|(apart, mean)| *apart -= mean);
            }
            rest.iter_mut().zip(&means).for_each(|(apart, mean)| *apart -= mean);
            if !complete {
                apart.iter_mut().zip(&full).for_each(|(apart, &full)| *apart = if full > 0.0 { *apart } else { 0.0 });
            }
            groups.means.push(means.map(|mean| at + mean));
            deviations.push(apart);
        }
        groups.count = counts;
        for (a, first) in deviations.iter().enumerate() {
            for second in &deviations[a..] {
                groups.products.push(products_by_group(first, second));
            }
        }
        groups
    }
}

/// Returns 1 for a point at which every column is finite, 0 for any other.
#[inline(always)]
fn full(columns: &[&[f64]], rows: usize) -> Vec<f64> {
    let mut full = vec![1.0; rows];
    for column in columns {
        for (full, value) in full.iter_mut().zip(*column) {
            *full = if value.is_finite() { *full } else { 0.0 };
        }
    }
    full
}

/// Sums over the points of every group.
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

/// Sums of products over the points of every group.
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

/// Correlations of every pair of characteristics. Empty with a single one, and with more than 40. Errors come from the jackknife over the
/// parts.
pub(super) fn correlations(problem: &Problem, parts: &Together) -> Vec<OutputCorrelation> {
    let names: Vec<&str> = problem.characteristics().iter().map(|one| one.name()).collect();
    if !(2..=OutputCorrelation::MOST).contains(&names.len()) {
        return Vec::new();
    }
    let all = |except: Option<usize>| {
        let mut whole = Together::default();
        (0..REPLICATES).filter(|part| Some(*part) != except).for_each(|part| whole.merge_part(0, parts, part));
        whole.coefficients()
    };
    let values = all(None);
    let known = parts.count.iter().filter(|count| **count > 0.0).count();
    let without: Vec<Vec<f64>> =
        if known == REPLICATES { (0..known).map(|part| all(Some(part))).collect() } else { Vec::new() };
    let of = |(index, pair): (usize, [usize; 2])| {
        let n = without.len() as f64;
        let mean = without.iter().map(|of| of[index]).sum::<f64>() / n;
        let squares: f64 = without.iter().map(|of| (of[index] - mean).powi(2)).sum();
        let error = student(REPLICATES) * (squares * (n - 1.0) / n).sqrt();
        let value = values.get(index).copied().filter(|value| value.is_finite());
        OutputCorrelation {
            between: pair.map(|c| names[c].to_owned()),
            value,
            error: value.and(Some(error).filter(|error| error.is_finite())),
        }
    };
    pairs(names.len()).enumerate().map(of).collect()
}

/// Share that keeps all limits, of `answered` points. Returns None if fewer than two characteristics have limits.
pub(super) fn joint(parts: &Together, sampler: Sampler, answered: u64) -> Option<YieldEstimate> {
    let (value, interval) = share(&parts.known, &parts.kept, sampler)?;
    let [known, kept] = [&parts.known, &parts.kept].map(|counts| counts.iter().sum::<u64>());
    let bounds = [kept, kept + answered.saturating_sub(known)].map(|most| most as f64 / answered.max(1) as f64);
    Some(YieldEstimate { value, interval, bounds })
}

/// Sets the yields of the assemblies that keep given limits.
pub(super) fn condition(
    parts: &Together,
    sampler: Sampler,
    lenses: &[CountingScale],
    characteristics: &mut [SimulatedCharacteristic],
) {
    let conditions = (0..lenses.len()).filter_map(|c| Some([c, lenses[c].given?]));
    for ([c, given], [known, kept]) in conditions.zip(&parts.conditional) {
        let Some((value, interval)) = share(known, kept, sampler) else { continue };
        let measured = [c, given].map(|c| {
            let one = &characteristics[c];
            (one.yield_.map_or(0.0, |of| 1.0 - of.value), one.sampling.as_ref().map(|of| of.rejected))
        });
        let name = characteristics[given].characteristic.name();
        characteristics[c].conditional = Some(ConditionalYield::new(name, value, interval, measured));
    }
}

/// Share of `kept` among `known` points, with its 95 % interval. Returns None if there is no point.
fn share(known: &Parts<u64>, kept: &Parts<u64>, sampler: Sampler) -> Option<(f64, [f64; 2])> {
    let shares = known.iter().zip(kept);
    let each = shares.map(|(&known, &kept)| (known > 0).then(|| kept as f64 / known as f64));
    let [known, kept] = [known, kept].map(|counts| counts.iter().sum::<u64>());
    if known == 0 {
        return None;
    }
    let value = kept as f64 / known as f64;
    let few = kept.min(known - kept) < REJECTED * REPLICATES as u64;
    let interval = match of_replicates(each).filter(|_| sampler == Sampler::Sobol) {
        Some(error) if !few && error > 0.0 => [(value - 2.0 * error).max(0.0), (value + 2.0 * error).min(1.0)],
        _ => wilson(kept as f64, known as f64),
    };
    Some((value, interval))
}

/// Widens a joint yield by the uncertainty of measured samples: the rejects lie between those of one characteristic and the sum over all.
pub(super) fn with_sampling(joint: YieldEstimate, characteristics: &[SimulatedCharacteristic]) -> YieldEstimate {
    let (mut most, mut least, mut measured) = (1.0 - joint.value, 0.0f64, false);
    for one in characteristics {
        let open = one.yield_.zip(one.sampling.as_ref().and_then(|of| of.rejected));
        let Some((own, [low, high])) = open else { continue };
        most += (high - (1.0 - own.value)).max(0.0);
        (least, measured) = (least.max(low), true);
    }
    if !measured {
        return joint;
    }
    let ends = [1.0 - most, 1.0 - least.min(1.0 - joint.value)];
    YieldEstimate { interval: verdict::share(verdict::joined(joint.value, joint.interval, ends)), ..joint }
}
