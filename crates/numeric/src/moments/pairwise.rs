//! Exact first four moments of a sum of functions of one and of two independent discrete variables.
//!
//! ```text
//! y = constant + sum_j g_j(i_j) + sum_{j<k} g_jk(i_j, i_k)        i_j: a node of variable j, with its probability
//! ```
//!
//! The conditional means of every `g_jk` are moved to `g_j`, `g_k` and the constant, so that all parts are uncorrelated (the decomposition
//! of Hoeffding 1948, known from analysis of variance):
//!
//! ```text
//! y - mean = sum_j a_j + sum_{j<k} B_jk                E a_j = 0,  E[B_jk | i_j] = E[B_jk | i_k] = 0
//! var      = sum_j E a_j^2 + sum_{j<k} E B_jk^2
//! ```
//!
//! The square of this deviation is decomposed in the same way, into functions of none, one, two, three and four variables:
//!
//! ```text
//! (y - mean)^2 = var + sum S_j + sum S_jk + sum S_jkl + sum S_jklm
//! E (y - mean)^3 = sum_j E[a_j S_j] + sum_{j<k} E[B_jk S_jk]
//! E (y - mean)^4 = var^2 + sum E S_j^2 + sum E S_jk^2 + sum E S_jkl^2 + sum E S_jklm^2
//!
//! S_jklm = 2 (B_jk B_lm + B_jl B_km + B_jm B_kl)
//! S_jkl  = 2 (a_j B_kl + a_k B_jl + a_l B_jk) + 2 (B_jk B_kl + B_kl B_lj + B_lj B_jk, less their conditional means)
//! ```
//!
//! The fourth moment is a sum of squares, so nothing cancels in it. The squares of the functions of four variables are summed by pairs of
//! opposite corners, `sum over 4-cycles = 1/4 sum_{j<m} (|sum_k P_k|^2 - sum_k |P_k|^2)` with `P_k = E[B_jk B_km | i_j, i_m]`. Thus no loop
//! runs over four variables.
//!
//! Cost: `O(N^3 m^3)` multiplications for N variables of m nodes, and no evaluation. Accuracy: rounding of `1e-15` times the number of
//! parts, relative to 1 for the skewness and to 3 for the kurtosis.

use crate::moments::Moments;
use crate::moments::sum::exact;
use crate::parallel::prelude::*;

/// Function of independent discrete variables, as tables of its parts.
#[derive(Debug, Clone)]
pub struct Tables<'a> {
    /// Constant part of the function.
    pub constant: f64,
    /// Probabilities of the nodes for every variable, which sum to 1.
    pub weights: Vec<&'a [f64]>,
    /// Univariate part at the nodes, for every variable.
    pub own: Vec<Vec<f64>>,
    /// Parts of two variables `j < k`, each pair at most once. The value at node `a` of `j` and `b` of `k` has the index `a nodes(k) + b`.
    pub pairs: Vec<(usize, usize, Vec<f64>)>,
}

/// Moments of the function, and its uncorrelated parts.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Pairwise {
    /// Moments of the whole function.
    pub moments: Moments,
    /// Uncorrelated part `a_j` at the nodes for every variable, in sigmas. 0 if sigma is 0.
    pub own: Vec<Vec<f64>>,
    /// Share of the variance for every pair, in the order given.
    pub shares: Vec<f64>,
    /// Shift of the mean by every pair.
    pub mean_shifts: Vec<f64>,
}

impl Tables<'_> {
    /// Moments of the sum, by its uncorrelated parts.
    ///
    /// ```
    /// use sensitol_numeric::moments::Tables;
    /// // The product of two coins that show -1 or 1: mean 0, and always of size 1.
    /// let coin = [0.5, 0.5];
    /// let product = Tables {
    ///     constant: 7.0,
    ///     weights: vec![&coin, &coin],
    ///     own: vec![vec![0.0; 2]; 2],
    ///     pairs: vec![(0, 1, vec![1.0, -1.0, -1.0, 1.0])],
    /// };
    /// let moments = product.moments().moments;
    /// assert_eq!((moments.mean(), moments.sigma()), (7.0, 1.0));
    /// assert_eq!((moments.skewness(), moments.kurtosis()), (Some(0.0), Some(1.0)));
    /// ```
    ///
    /// # Panics
    /// If a table does not fit its variables, or a pair is not `j < k`.
    pub fn moments(&self) -> Pairwise {
        let n = self.weights.len();
        let largest = self.own.iter().chain(self.pairs.iter().map(|(_, _, table)| table)).flatten();
        let scale = largest.fold(0.0f64, |largest, value| largest.max(value.abs()));
        let nothing = || Pairwise {
            moments: Moments::constant(self.constant),
            own: self.own.iter().map(|own| vec![0.0; own.len()]).collect(),
            shares: vec![0.0; self.pairs.len()],
            mean_shifts: vec![0.0; self.pairs.len()],
        };
        if scale == 0.0 {
            return nothing();
        }
        let mut parts = self.uncorrelated(1.0 / scale);
        let variance = parts.variance();
        // Rounding errors of parts that cancel each other are not taken as a variation.
        if variance <= (4.0 * f64::EPSILON).powi(2) * (n + self.pairs.len()) as f64 {
            let mean = self.constant + scale * parts.mean;
            return Pairwise { moments: Moments::constant(mean), ..nothing() };
        }
        let sigma = variance.sqrt();
        parts.scale(1.0 / sigma);
        let [skewness, fourth] = parts.third_and_fourth();
        Pairwise {
            moments: Moments::new(self.constant + scale * parts.mean, scale * sigma, skewness, fourth - 3.0),
            shares: (self.pairs.iter()).map(|&(j, k, _)| parts.norm(j, k, parts.table(j, k))).collect(),
            mean_shifts: parts.shifts.iter().map(|shift| scale * shift).collect(),
            own: parts.own,
        }
    }

    fn uncorrelated(&self, factor: f64) -> Parts<'_> {
        let n = self.weights.len();
        let mut own: Vec<Vec<f64>> =
            self.own.iter().map(|own| own.iter().map(|value| factor * value).collect()).collect();
        let mut both = vec![Vec::new(); n * n];
        let mut means = Vec::new();
        let mut shifts = Vec::with_capacity(self.pairs.len());
        for (j, k, table) in &self.pairs {
            let (j, k) = (*j, *k);
            assert!(j < k, "a pair is named in ascending order");
            let (of_j, of_k) = (self.weights[j], self.weights[k]);
            assert_eq!(table.len(), of_j.len() * of_k.len(), "a table of a value for every two nodes");
            let value = |a: usize, b: usize| factor * table[a * of_k.len() + b];
            let given_j: Vec<f64> = (0..of_j.len()).map(|a| mean(of_k, |b| value(a, b))).collect();
            let given_k: Vec<f64> = (0..of_k.len()).map(|b| mean(of_j, |a| value(a, b))).collect();
            let middle = mean(of_j, |a| given_j[a]);
            let centred = |a: usize, b: usize| value(a, b) - given_j[a] - given_k[b] + middle;
            both[j * n + k] = (0..of_j.len())
                .flat_map(|a| (0..of_k.len()).map(move |b| (a, b)))
                .map(|(a, b)| centred(a, b))
                .collect();
            both[k * n + j] = (0..of_k.len())
                .flat_map(|b| (0..of_j.len()).map(move |a| (a, b)))
                .map(|(a, b)| centred(a, b))
                .collect();
            own[j].iter_mut().zip(&given_j).for_each(|(own, given)| *own += given - middle);
            own[k].iter_mut().zip(&given_k).for_each(|(own, given)| *own += given - middle);
            shifts.push(middle);
            means.push(middle);
        }
        for (own, weights) in own.iter_mut().zip(&self.weights) {
            let middle = mean(weights, |a| own[a]);
            own.iter_mut().for_each(|value| *value -= middle);
            means.push(middle);
        }
        Parts { weights: &self.weights, own, both, mean: exact(means), shifts }
    }
}

/// Uncorrelated parts of a sum.
struct Parts<'a> {
    weights: &'a [&'a [f64]],
    own: Vec<Vec<f64>>,
    /// Table of the pair at `j N + k`, with the nodes of `j` as rows. Empty without such a part.
    both: Vec<Vec<f64>>,
    mean: f64,
    shifts: Vec<f64>,
}

fn mean(weights: &[f64], value: impl Fn(usize) -> f64) -> f64 {
    weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
}

impl Parts<'_> {
    fn len(&self) -> usize {
        self.own.len()
    }

    fn table(&self, j: usize, k: usize) -> &[f64] {
        &self.both[j * self.len() + k]
    }

    /// Variables that share a part with variable `j`.
    fn partners(&self, j: usize) -> Vec<usize> {
        (0..self.len()).filter(|&k| !self.table(j, k).is_empty()).collect()
    }

    /// Mean square `E f^2` of a table of two variables.
    fn norm(&self, j: usize, k: usize, table: &[f64]) -> f64 {
        let (of_j, of_k) = (self.weights[j], self.weights[k]);
        table.chunks(of_k.len()).zip(of_j).map(|(row, weight)| weight * mean(of_k, |b| row[b] * row[b])).sum()
    }

    fn variance(&self) -> f64 {
        let own = (0..self.len()).map(|j| mean(self.weights[j], |a| self.own[j][a] * self.own[j][a]));
        exact(own.chain(self.edges().map(|(j, k)| self.norm(j, k, self.table(j, k)))))
    }

    fn edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let n = self.len();
        (0..n).flat_map(move |j| (j + 1..n).map(move |k| (j, k))).filter(|&(j, k)| !self.table(j, k).is_empty())
    }

    fn scale(&mut self, factor: f64) {
        self.own.iter_mut().chain(&mut self.both).flatten().for_each(|value| *value *= factor);
    }

    /// Third and fourth central moment of parts whose variance is 1.
    fn third_and_fourth(&self) -> [f64; 2] {
        // One task for each variable. The sums are added in order, whatever the number of threads.
        let of_one: Vec<[f64; 2]> = (0..self.len()).into_par_iter().map(|j| self.of_one(j)).collect();
        let of_two: Vec<[f64; 3]> = (0..self.len()).into_par_iter().map(|j| self.of_two(j)).collect();
        let of_three: Vec<f64> = (0..self.len()).into_par_iter().map(|j| self.of_three(j)).collect();
        let third = exact(of_one.iter().map(|one| one[0]).chain(of_two.iter().map(|two| two[0])));
        let cycles = exact(of_two.iter().map(|two| two[2]));
        let squares = of_one.iter().map(|one| one[1]).chain(of_two.iter().map(|two| two[1])).chain(of_three);
        let fourth = exact(std::iter::once(1.0).chain(squares).chain([4.0 * self.apart(), 2.0 * cycles]));
        [third, fourth]
    }

    /// Contributions `E[a_j S_j]` and `E S_j^2` of one variable.
    fn of_one(&self, j: usize) -> [f64; 2] {
        let partners = self.partners(j);
        let weights = self.weights[j];
        let mut s: Vec<f64> = self.own[j].iter().map(|a| a * a).collect();
        for &k in &partners {
            let of_k = self.weights[k];
            for (s, row) in s.iter_mut().zip(self.table(j, k).chunks(of_k.len())) {
                *s += mean(of_k, |b| row[b] * (row[b] + 2.0 * self.own[k][b]));
            }
        }
        let middle = mean(weights, |a| s[a]);
        s.iter_mut().for_each(|s| *s -= middle);
        [mean(weights, |a| self.own[j][a] * s[a]), mean(weights, |a| s[a] * s[a])]
    }

    /// Contributions of all pairs `j < k` for one `j`: `E[B_jk S_jk]`, `E S_jk^2`, and `|sum_l P_l|^2 - sum_l |P_l|^2`.
    fn of_two(&self, j: usize) -> [f64; 3] {
        let (n, of_j) = (self.len(), self.weights[j]);
        let partners = self.partners(j);
        let mut sums = [0.0; 3];
        for k in j + 1..n {
            let of_k = self.weights[k];
            let (rows, columns) = (of_j.len(), of_k.len());
            // Sum the conditional means of products through a third variable, and their squares one by one for the 4-cycles.
            let mut through = vec![0.0; rows * columns];
            let mut each = 0.0;
            for &l in partners.iter().filter(|&&l| !self.table(k, l).is_empty()) {
                let of_l = self.weights[l];
                let (from, to) = (self.table(j, l), self.table(k, l));
                let mut one = vec![0.0; rows * columns];
                for a in 0..rows {
                    for b in 0..columns {
                        one[a * columns + b] = mean(of_l, |c| from[a * of_l.len() + c] * to[b * of_l.len() + c]);
                    }
                }
                each += self.norm(j, k, &one);
                through.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
            }
            sums[2] += self.norm(j, k, &through) - each;
            // Assemble S_jk from these, the products of the univariate parts, and the direct part.
            let direct = self.table(j, k);
            let mut s: Vec<f64> = (0..rows * columns)
                .map(|at| {
                    let (a, b) = (self.own[j][at / columns], self.own[k][at % columns]);
                    let bent = direct.get(at).map_or(0.0, |both| both * (both + 2.0 * (a + b)));
                    2.0 * (a * b + through[at]) + bent
                })
                .collect();
            if !direct.is_empty() {
                // Without a direct part nothing has to be centred: only squares and products with one variable have conditional means.
                centre(&mut s, of_j, of_k);
            }
            sums[0] += if direct.is_empty() {
                0.0
            } else {
                mean(of_j, |a| mean(of_k, |b| direct[a * columns + b] * s[a * columns + b]))
            };
            sums[1] += self.norm(j, k, &s);
        }
        sums
    }

    /// Contribution `E S_jkl^2` of all `j < k < l` for one `j`.
    fn of_three(&self, j: usize) -> f64 {
        let n = self.len();
        let mut sum = 0.0;
        for k in j + 1..n {
            for l in k + 1..n {
                let tables = [self.table(j, k), self.table(k, l), self.table(j, l)];
                if tables.iter().any(|table| !table.is_empty()) {
                    sum += self.of_these([j, k, l], tables);
                }
            }
        }
        sum
    }

    fn of_these(&self, [j, k, l]: [usize; 3], [jk, kl, jl]: [&[f64]; 3]) -> f64 {
        let (of_j, of_k, of_l) = (self.weights[j], self.weights[k], self.weights[l]);
        let (q, r) = (of_k.len(), of_l.len());
        let at = |table: &[f64], place: usize| table.get(place).copied().unwrap_or(0.0);
        // Conditional mean of the product of two tables, over the variable that they share.
        let meet = |rows: &[f64], columns: &[f64], through: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..rows.len()).flat_map(|a| (0..columns.len()).map(move |b| (a, b))).map(|(a, b)| through(a, b)).collect()
        };
        let through_k = meet(of_j, of_l, &|a, c| mean(of_k, |b| at(jk, a * q + b) * at(kl, b * r + c)));
        let through_l = meet(of_j, of_k, &|a, b| mean(of_l, |c| at(jl, a * r + c) * at(kl, b * r + c)));
        let through_j = meet(of_k, of_l, &|b, c| mean(of_j, |a| at(jk, a * q + b) * at(jl, a * r + c)));
        let value = |a: usize, b: usize, c: usize| {
            let (x, y, z) = (at(jk, a * q + b), at(kl, b * r + c), at(jl, a * r + c));
            let own = self.own[j][a] * y + self.own[k][b] * z + self.own[l][c] * x;
            let joint = x * y - through_k[a * r + c] + y * z - through_l[a * q + b] + z * x - through_j[b * r + c];
            2.0 * (own + joint)
        };
        mean(of_j, |a| mean(of_k, |b| mean(of_l, |c| value(a, b, c).powi(2))))
    }

    /// Sum of `E B_jk^2 E B_lm^2` over pairs that share no variable.
    fn apart(&self) -> f64 {
        let norms: Vec<(usize, usize, f64)> =
            self.edges().map(|(j, k)| (j, k, self.norm(j, k, self.table(j, k)))).collect();
        let mut meeting = vec![0.0; self.len()];
        for &(j, k, norm) in &norms {
            meeting[j] += norm;
            meeting[k] += norm;
        }
        let total: f64 = norms.iter().map(|&(_, _, norm)| norm).sum();
        0.5 * exact(norms.iter().map(|&(j, k, norm)| norm * (total - meeting[j] - meeting[k] + norm)))
    }
}

/// Subtracts both conditional means from a table of two variables.
fn centre(table: &mut [f64], of_j: &[f64], of_k: &[f64]) {
    let columns = of_k.len();
    for row in table.chunks_mut(columns) {
        let middle = mean(of_k, |b| row[b]);
        row.iter_mut().for_each(|value| *value -= middle);
    }
    for b in 0..columns {
        let middle = mean(of_j, |a| table[a * columns + b]);
        (0..of_j.len()).for_each(|a| table[a * columns + b] -= middle);
    }
}
