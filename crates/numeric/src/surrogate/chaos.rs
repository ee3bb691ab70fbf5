//! Sparse polynomial chaos: a regression on few products of orthonormal polynomials of the inputs.
//!
//! ```text
//! y ~ c_0 + sum_k c_k product_j p_{k_j}(u_j) + sum_i d_i t^i        E[p_a(u_j) p_b(u_j)] = 1 if a = b, else 0
//! ```
//!
//! `p` are the polynomials of each input's own distribution, by the procedure of Stieltjes over its Gauss rule (Gautschi 2004). Their
//! degree is limited by the moments of the distribution. `t` is a known surface, in its own sigmas. Columns are added one by one, that with
//! the largest part in the residual first (Pati, Rezaiifar and Krishnaprasad 1993). Their number minimises the leave-one-out error,
//! corrected for the number of columns (Chapelle, Vapnik and Bengio 2002; Blatman and Sudret 2011).
//!
//! This module does not estimate the error of the regression: callers compare it with the model at held-out points.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::SolveLstsqCore;
use faer::{Accum, Conj, Mat, Par};

use crate::distribution::{Jacobi, Rule};
use crate::surrogate::{InputShape, Surrogate};

/// Highest degree of one input, and of a product. Nine nodes integrate the squares of no higher degree, and many inputs would have too many
/// products of it.
const HIGHEST: usize = 8;
/// Degree that is used for any number of inputs.
const LOWEST: usize = 4;
/// Greatest number of products of all inputs for a degree above the lowest.
const PRODUCTS: usize = 1000;
/// Nodes of the coarse rule that confirms a finer one.
const COARSE: usize = 7;
/// Greatest difference of two logarithms, by the fine and the coarse rule, at which the fine one is confirmed.
const CONFIRMED: f64 = 1e-6;
/// Highest power of the known surface.
const POWERS: i32 = 4;
/// Greatest number of factors of a product.
const FACTORS: usize = 4;
/// Greatest number of candidates of each kind, taken from the most important inputs.
const CANDIDATES: usize = 1200;
/// Number of the most important inputs that have products with curved factors.
const CURVED: usize = 16;
/// Number of the most important inputs that have products of three and four factors.
const SEVERAL: usize = 10;
/// Smallest number of points for every column that is chosen.
const POINTS: usize = 3;
/// Greatest number of columns in a regression.
const COLUMNS: usize = 80;
/// Columns that may be added in a row without an improvement before the search ends.
const PATIENCE: usize = 12;
/// Relative size of the new part of a column below which it counts as dependent on the others.
pub const DEPENDENT: f64 = 1e-8;

/// Three-term recurrence `sqrt(beta_(n+1)) p_(n+1) = (u - alpha_n) p_n - sqrt(beta_n) p_(n-1)`, up to the degree that the distribution
/// allows.
struct Recurrence {
    alpha: Vec<f64>,
    root: Vec<f64>,
    /// Gauss rule of [`COARSE`] nodes. None if the distribution has too few atoms for it.
    coarse: Option<Rule>,
}

impl Recurrence {
    fn of(rule: &Rule) -> Self {
        let mean = |of: &dyn Fn(usize) -> f64| (0..rule.nodes.len()).map(|i| rule.weights[i] * of(i)).sum::<f64>();
        let (mut before, mut own) = (vec![0.0; rule.nodes.len()], vec![1.0; rule.nodes.len()]);
        let (mut alpha, mut root): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        while alpha.len() < HIGHEST {
            let middle = mean(&|i| rule.nodes[i] * own[i] * own[i]);
            let last = root.last().copied().unwrap_or(0.0);
            let next: Vec<f64> = (0..own.len()).map(|i| (rule.nodes[i] - middle) * own[i] - last * before[i]).collect();
            let norm = mean(&|i| next[i] * next[i]).sqrt();
            // A distribution of n atoms has n orthogonal polynomials only.
            if norm.is_nan() || norm < 1e-6 {
                break;
            }
            before = std::mem::replace(&mut own, next.into_iter().map(|value| value / norm).collect());
            alpha.push(middle);
            root.push(norm);
        }
        let gauss = |alpha: &[f64]| {
            Jacobi::new(alpha.to_vec(), root[..COARSE].iter().map(|root| root * root).collect()).gauss()
        };
        let coarse = alpha.get(..COARSE).map(gauss);
        Self { alpha, root, coarse }
    }

    /// Values of `p_degree` at every place.
    fn column(&self, u: &[f64], degree: usize) -> Vec<f64> {
        let value = |&u: &f64| {
            let (mut before, mut own) = (0.0, 1.0);
            for n in 0..degree {
                let last = if n == 0 { 0.0 } else { self.root[n - 1] };
                (before, own) = (own, ((u - self.alpha[n]) * own - last * before) / self.root[n]);
            }
            own
        };
        u.iter().map(value).collect()
    }
}

/// Product of polynomials, by input and degree, or a power of the known surface.
#[derive(Debug, Clone, PartialEq)]
enum Term {
    Product(Vec<(usize, usize)>),
    Power(i32),
}

/// Points: a column for every input, and the known surface in its sigmas, which is empty if there is none.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    /// Standardised values, one column for every input.
    pub u: &'a [Vec<f64>],
    /// Known surface at the points, in its own sigmas. Empty if there is none.
    pub surface: &'a [f64],
}

/// Candidate terms of a regression.
pub struct Chaos {
    recurrences: Vec<Recurrence>,
    terms: Vec<Term>,
}

/// Sparse regression: a constant, and the chosen terms with their coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Sparse {
    constant: f64,
    terms: Vec<(Term, f64)>,
}

impl Sparse {
    /// Regression that is the known surface itself, with this mean and sigma.
    pub fn surface(mean: f64, sigma: f64) -> Self {
        Self { constant: mean, terms: vec![(Term::Power(1), sigma)] }
    }
}

impl Chaos {
    /// Candidates for these inputs, `order` with the most important first. `surface` is None if no surface is known, and Some(true) if its
    /// higher powers are candidates too.
    pub fn new(shapes: &[InputShape], order: &[usize], surface: Option<bool>) -> Self {
        let recurrences: Vec<Recurrence> = shapes.iter().map(|shape| Recurrence::of(&shape.rule)).collect();
        let powers = surface.map_or(0, |higher| if higher { POWERS } else { 1 });
        let mut terms: Vec<Term> = (1..=powers).map(Term::Power).collect();
        products(order, 0, degree(order.len()), &mut Vec::new(), &mut terms);
        let known = |term: &Term| match term {
            Term::Power(_) => true,
            Term::Product(factors) => factors.iter().all(|&(j, degree)| degree <= recurrences[j].alpha.len()),
        };
        terms.retain(known);
        Self { recurrences, terms }
    }

    /// Removes all terms except those of a single input.
    pub fn apart(mut self) -> Self {
        self.terms.retain(|term| matches!(term, Term::Product(factors) if factors.len() == 1));
        self
    }

    fn column(&self, term: &Term, places: Places<'_>) -> Vec<f64> {
        match term {
            Term::Power(power) => places.surface.iter().map(|t| t.powi(*power)).collect(),
            Term::Product(factors) => {
                let columns = factors.iter().map(|&(j, degree)| self.recurrences[j].column(&places.u[j], degree));
                columns
                    .reduce(|mut all, one| {
                        all.iter_mut().zip(one).for_each(|(all, one)| *all *= one);
                        all
                    })
                    .unwrap_or_default()
            }
        }
    }

    /// Values of a regression at these places.
    pub fn values(&self, sparse: &Sparse, places: Places<'_>, rows: usize) -> Vec<f64> {
        let mut values = vec![sparse.constant; rows];
        for (term, factor) in &sparse.terms {
            let column = self.column(term, places);
            values.iter_mut().zip(column).for_each(|(value, part)| *value += factor * part);
        }
        values
    }

    /// Mean and mean square of a regression over independent inputs. The products are orthonormal, and the known surface consists of such
    /// products too. Returns None if a higher power of the known surface is in it, whose moments are unknown.
    pub fn squares(
        &self,
        sparse: &Sparse,
        shapes: &[InputShape],
        surface: Option<(&Surrogate, f64)>,
    ) -> Option<[f64; 2]> {
        let mut pairs: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        if let Some((surrogate, _)) = surface {
            let of_surface = surrogate.interactions.pairs().into_iter();
            pairs.extend(of_surface.map(|(j, k, value)| ((j.min(k), j.max(k)), value)));
        }
        // Coefficient of a product in the known surface.
        let part = |factors: &[(usize, usize)]| -> Option<f64> {
            let (surrogate, sigma) = surface?;
            let value = match *factors {
                [(j, degree)] => {
                    let (own, rule) = (surrogate.parts[j].as_ref()?, &shapes[j].rule);
                    let p = self.recurrences[j].column(&rule.nodes, degree);
                    let terms = rule.nodes.iter().zip(&rule.weights).zip(p);
                    terms.map(|((&u, weight), p)| weight * own.value(u) * p).sum()
                }
                [(j, 1), (k, 1)] => pairs.get(&(j.min(k), j.max(k))).copied().unwrap_or(0.0),
                _ => 0.0,
            };
            Some(value / sigma)
        };
        let (mut square, mut along, mut factor) = (0.0, 0.0, 0.0);
        for (term, own) in &sparse.terms {
            match term {
                Term::Product(factors) => {
                    square += own * own;
                    along += own * if surface.is_some() { part(factors)? } else { 0.0 };
                }
                Term::Power(1) => factor = *own,
                Term::Power(_) => return None,
            }
        }
        let constant = sparse.constant;
        Some([constant, constant * constant + square + factor * factor + 2.0 * factor * along])
    }

    /// Logarithms of the means of `exp(p s)` with `s` the regression over independent inputs, for p = 1, 2, .. up to 4. Each input gives a
    /// mean over its Gauss rule. The list ends at the first power that a rule of fewer nodes does not confirm. Returns None if a term has
    /// several inputs.
    pub fn exponentials(&self, sparse: &Sparse, shapes: &[InputShape]) -> Option<Vec<f64>> {
        let mut parts: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for (term, factor) in &sparse.terms {
            let Term::Product(factors) = term else { return None };
            let [(j, degree)] = factors[..] else { return None };
            parts.entry(j).or_default().push((degree, *factor));
        }
        // Univariate part of an input at the nodes of a rule, with their weights.
        let at = |j: usize, terms: &[(usize, f64)], rule: &Rule| -> Vec<(f64, f64)> {
            let mut values: Vec<(f64, f64)> = rule.weights.iter().map(|&weight| (0.0, weight)).collect();
            for &(degree, factor) in terms {
                let column = self.recurrences[j].column(&rule.nodes, degree);
                values.iter_mut().zip(column).for_each(|((value, _), part)| *value += factor * part);
            }
            values
        };
        let both = |(&j, terms): (&usize, &Vec<(usize, f64)>)| {
            (at(j, terms, &shapes[j].rule), self.recurrences[j].coarse.as_ref().map(|coarse| at(j, terms, coarse)))
        };
        let inputs: Vec<_> = parts.iter().map(both).collect();
        let logarithm = |p: f64| {
            let own = |values: &[(f64, f64)]| {
                libm::log(values.iter().map(|(value, weight)| weight * libm::exp(p * value)).sum::<f64>())
            };
            let (mut whole, mut apart) = (p * sparse.constant, 0.0);
            for (fine, coarse) in &inputs {
                let fine = own(fine);
                whole += fine;
                // A distribution of few atoms has no coarse rule: its own rule holds all of them and is exact.
                apart += coarse.as_ref().map_or(0.0, |coarse| (fine - own(coarse)).abs());
            }
            (apart <= CONFIRMED).then_some(whole).filter(|whole| whole.is_finite())
        };
        Some([1.0, 2.0, 3.0, 4.0].into_iter().map_while(logarithm).collect())
    }

    /// Fits a regression to values at these points, all of them finite.
    pub fn fit(&self, places: Places<'_>, y: &[f64]) -> Sparse {
        let rows = y.len();
        let mean = y.iter().sum::<f64>() / rows.max(1) as f64;
        let nothing = Sparse { constant: mean, terms: Vec::new() };
        if rows < 2 * POINTS {
            return nothing;
        }
        // Tabulate the polynomials of each input once, since products share them.
        let table: Vec<Vec<Vec<f64>>> = (self.recurrences.iter().zip(places.u))
            .map(|(recurrence, u)| (1..=recurrence.alpha.len()).map(|degree| recurrence.column(u, degree)).collect())
            .collect();
        let column = |term: &Term| match term {
            Term::Power(_) => self.column(term, places),
            Term::Product(factors) => {
                let (j, degree) = factors[0];
                let mut column = table[j][degree - 1].clone();
                for &(j, degree) in &factors[1..] {
                    column.iter_mut().zip(&table[j][degree - 1]).for_each(|(all, one)| *all *= one);
                }
                column
            }
        };
        // Centre and normalise the columns, so that their products with the residual are comparable. A constant column stays 0.
        let mut columns = Mat::<f64>::zeros(rows, self.terms.len());
        for (index, term) in self.terms.iter().enumerate() {
            let column = column(term);
            let middle = column.iter().sum::<f64>() / rows as f64;
            let size = column.iter().map(|value| (value - middle).powi(2)).sum::<f64>().sqrt();
            if size.is_finite() && size > 0.0 {
                (0..rows).for_each(|row| columns[(row, index)] = (column[row] - middle) / size);
            }
        }
        let chosen = pursue(&columns, &y.iter().map(|y| y - mean).collect::<Vec<f64>>());
        if chosen.is_empty() {
            return nothing;
        }
        // Fit the chosen terms once more by least squares in their own scale, which gives the coefficients.
        let raw: Vec<Vec<f64>> = chosen.iter().map(|&index| self.column(&self.terms[index], places)).collect();
        let matrix = Mat::from_fn(rows, 1 + raw.len(), |i, j| if j == 0 { 1.0 } else { raw[j - 1][i] });
        let mut right = Mat::from_fn(rows, 1, |i, _| y[i]);
        matrix.col_piv_qr().solve_lstsq_in_place_with_conj(Conj::No, right.as_mut());
        let terms = chosen.iter().enumerate().map(|(k, &index)| (self.terms[index].clone(), right[(k + 1, 0)]));
        let found = Sparse { constant: right[(0, 0)], terms: terms.collect() };
        let whole = found.constant.is_finite() && found.terms.iter().all(|(_, factor)| factor.is_finite());
        if whole { found } else { nothing }
    }
}

/// Highest total degree for this number of inputs: there are `(n + d)!/(n! d!)` products.
fn degree(inputs: usize) -> usize {
    let count = |d: usize| (1..=d).fold(1.0, |count, i| count * (inputs + i) as f64 / i as f64);
    (LOWEST..=HIGHEST).rev().find(|&d| count(d) <= PRODUCTS as f64).unwrap_or(LOWEST)
}

/// Appends all products from position `first` of the order on, with at most `left` more in degree, and no more of each kind than allowed.
fn products(order: &[usize], first: usize, left: usize, part: &mut Vec<(usize, usize)>, terms: &mut Vec<Term>) {
    for place in first..order.len() {
        for degree in 1..=left {
            let factors = part.len() + 1;
            let curved = degree > 1 || part.iter().any(|&(_, degree)| degree > 1);
            let most = match (factors, curved) {
                (1, false) => usize::MAX,
                (1, true) => CANDIDATES / LOWEST,
                (2, false) => (2.0 * CANDIDATES as f64).sqrt() as usize,
                (2, true) => CURVED,
                _ => SEVERAL,
            };
            if place >= most {
                break;
            }
            part.push((order[place], degree));
            terms.push(Term::Product(part.clone()));
            if degree < left && factors < FACTORS {
                products(order, place + 1, left - degree, part, terms);
            }
            part.pop();
        }
    }
}

/// Indices of the columns to use, in the order of their choice.
fn pursue(columns: &Mat<f64>, y: &[f64]) -> Vec<usize> {
    let (rows, count) = (columns.nrows(), columns.ncols());
    let most = (rows / POINTS).min(COLUMNS);
    let mut left = y.to_vec();
    let mut leverage = vec![1.0 / rows as f64; rows];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let (mut chosen, mut barred): (Vec<usize>, Vec<bool>) = (Vec::new(), vec![false; count]);
    // Corrected leave-one-out error: residuals are divided by one minus the leverage.
    let score = |left: &[f64], leverage: &[f64], taken: usize| {
        let out: f64 = left.iter().zip(leverage).map(|(r, h)| (r / (1.0 - h).max(1e-3)).powi(2)).sum();
        let p = 1.0 + taken as f64;
        out * (rows as f64 / (rows as f64 - p)) * (1.0 + p / rows as f64)
    };
    let (mut best, mut length) = (score(&left, &leverage, 0), 0);
    let whole: f64 = y.iter().map(|y| y * y).sum();
    while chosen.len() < most && chosen.len() < length + PATIENCE {
        // Choose the column with the largest product with the residual. Equal ones are decided by their order.
        let residual = Mat::from_fn(rows, 1, |i, _| left[i]);
        let mut parts = Mat::<f64>::zeros(count, 1);
        matmul(&mut parts, Accum::Replace, columns.transpose(), &residual, 1.0, Par::Seq);
        let largest = (0..count)
            .filter(|&index| !barred[index])
            .max_by(|&a, &b| parts[(a, 0)].abs().total_cmp(&parts[(b, 0)].abs()).then(b.cmp(&a)));
        let Some(index) = largest.filter(|&index| parts[(index, 0)].abs() > 0.0) else { break };
        barred[index] = true;
        let mut own: Vec<f64> = (0..rows).map(|row| columns[(row, index)]).collect();
        // Orthogonalise twice, which is enough (Parlett 1980).
        for _ in 0..2 {
            for known in &basis {
                let along: f64 = known.iter().zip(&own).map(|(a, b)| a * b).sum();
                own.iter_mut().zip(known).for_each(|(own, known)| *own -= along * known);
            }
        }
        let size = own.iter().map(|value| value * value).sum::<f64>().sqrt();
        if size <= DEPENDENT {
            continue;
        }
        // Subtract the part along the new column from the residual, and update the leverages.
        own.iter_mut().for_each(|value| *value /= size);
        let along: f64 = own.iter().zip(&left).map(|(a, b)| a * b).sum();
        for ((left, leverage), own) in left.iter_mut().zip(&mut leverage).zip(&own) {
            *left -= along * own;
            *leverage += own * own;
        }
        basis.push(own);
        chosen.push(index);
        let found = score(&left, &leverage, chosen.len());
        if found < best {
            (best, length) = (found, chosen.len());
        }
        // Stop at a residual of rounding errors.
        if left.iter().map(|r| r * r).sum::<f64>() < 1e-26 * whole {
            break;
        }
    }
    chosen.truncate(length);
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::{Exponential, Normal};
    use crate::surrogate::shapes;

    /// Numbers between 0 and 1 by a linear congruence: any will do.
    fn numbers(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
        };
        (0..count).map(|_| next()).collect()
    }

    /// Reference: Laguerre's polynomials for an exponential variable (Abramowitz and Stegun 1964, 22.3.9). With x = 1 + u, `L_3 = (6 - 18 x
    /// + 9 x^2 - x^3)/6`. Its sign is turned if the leading coefficient is to be positive.
    #[test]
    fn polynomials_are_those_of_the_distribution() {
        let shape = shapes([&Exponential::new(0.0, 2.0).unwrap() as _]);
        let places = [-1.0, -0.3, 0.0, 2.0, 7.0];
        let found = Recurrence::of(&shape[0].rule).column(&places, 3);
        for (u, found) in places.iter().zip(found) {
            let x = 1.0 + u;
            let expected = -(6.0 - 18.0 * x + 9.0 * x * x - x.powi(3)) / 6.0;
            // A rule of nine nodes has its moments to some roundings.
            assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} for {expected} at {u}");
        }
    }

    /// Function `x^2 + z` with an exponential x of mean 1 and a normal z: mean 2, mean square 4! + 1. With Laguerre's polynomials `p_1 = x
    /// - 1` and `p_2 = (x^2 - 4 x + 2)/2` it is `2 p_2 + 4 p_1 + 2 + z`.
    #[test]
    fn squares_are_those_of_the_distributions() {
        let shapes = shapes([&Exponential::new(0.0, 1.0).unwrap() as _, &Normal::new(0.0, 1.0).unwrap() as _]);
        let chaos = Chaos::new(&shapes, &[0, 1], None);
        let product = |j: usize, degree: usize| Term::Product(vec![(j, degree)]);
        let terms = vec![(product(0, 2), 2.0), (product(0, 1), 4.0), (product(1, 1), 1.0)];
        let found = Sparse { constant: 2.0, terms };
        let u = [vec![-1.0, -0.3, 0.0, 2.5], vec![0.2, -1.0, 0.0, 1.5]];
        let values = chaos.values(&found, Places { u: &u, surface: &[] }, 4);
        for (value, (u, z)) in values.iter().zip(u[0].iter().zip(&u[1])) {
            assert!((value - ((1.0 + u).powi(2) + z)).abs() < 1e-9, "{value} at {u} and {z}");
        }
        let [mean, square] = chaos.squares(&found, &shapes, None).unwrap();
        assert_eq!(mean, 2.0);
        assert!((square - 25.0).abs() < 1e-12, "{square}");
    }

    /// The known surface consists of the same products: its part in the mean square is the same as a power and as products.
    #[test]
    fn a_known_surface_has_its_part_in_the_square() {
        use crate::moments::Interactions;
        use crate::surrogate::Univariate;
        let shapes = shapes([&Normal::new(0.0, 1.0).unwrap() as _, &Normal::new(0.0, 1.0).unwrap() as _]);
        let parts = vec![Some(Univariate::of_coefficients(&[2.0, 0.5])), Some(Univariate::of_coefficients(&[1.0]))];
        let surrogate = Surrogate { centre: 3.0, parts, interactions: Interactions::of_pairs(2, [(0, 1, 0.7)]) };
        let chaos = Chaos::new(&shapes, &[0, 1], Some(false));
        // 3 t + 0.4 z_0 - 0.2 z_0 z_1, with t = (2 z_0 + (z_0^2 - 1)/2 + z_1 + 0.7 z_0 z_1)/sigma, sigma^2 = 4 + 1/2 + 1 + 0.49.
        let terms = vec![
            (Term::Power(1), 3.0),
            (Term::Product(vec![(0, 1)]), 0.4),
            (Term::Product(vec![(0, 1), (1, 1)]), -0.2),
        ];
        let sigma = 5.99f64.sqrt();
        let [mean, square] =
            chaos.squares(&Sparse { constant: 1.5, terms }, &shapes, Some((&surrogate, sigma))).unwrap();
        let part = |own: f64, more: f64| (3.0 * own / sigma + more).powi(2);
        let expected = 2.25 + part(2.0, 0.4) + part(0.5f64.sqrt(), 0.0) + part(1.0, 0.0) + part(0.7, -0.2);
        // Uses E (z^2 - 1)^2 = 2. The tolerance is for the rounding of nine nodes.
        assert!((mean - 1.5).abs() < 1e-15 && (square - expected).abs() < 1e-9, "{square} for {expected}");
    }

    /// Function `exp(1 + 0.3 z + 0.2 t)` with normal z and t is lognormal. With `0.1 (z^2 - 1)/sqrt(2)` beside `0.3 z` the mean of the
    /// power p is `exp(a^2/(2 (1 - 2 b)) - b)/sqrt(1 - 2 b)` times the rest, with `a = 0.3 p` and `b = 0.1 p/sqrt(2)`.
    #[test]
    fn means_of_exponentials_are_those_of_their_factors() {
        let shapes = shapes([&Normal::new(0.0, 1.0).unwrap() as _, &Normal::new(0.0, 1.0).unwrap() as _]);
        let chaos = Chaos::new(&shapes, &[0, 1], None);
        let alone = |j: usize, degree: usize| Term::Product(vec![(j, degree)]);
        let mut terms = vec![(alone(0, 1), 0.3), (alone(1, 1), 0.2)];
        let of = |terms: &[(Term, f64)]| chaos.exponentials(&Sparse { constant: 1.0, terms: terms.to_vec() }, &shapes);
        let found = of(&terms).unwrap();
        assert!(found.len() >= 3, "{found:?}");
        for (found, p) in found.iter().zip([1.0, 2.0, 3.0, 4.0]) {
            let expected = p + 0.5 * p * p * (0.09 + 0.04);
            // Nine nodes have a far smaller error for exp(1.2 z) than seven.
            assert!((found - expected).abs() < 1e-8, "{found} for {expected}");
        }
        terms.push((alone(0, 2), 0.1));
        let found = of(&terms).unwrap();
        let b = 0.1 / 2f64.sqrt();
        let expected = 1.0 + 0.045 / (1.0 - 2.0 * b) - b - 0.5 * (1.0 - 2.0 * b).ln() + 0.02;
        assert!((found[0] - expected).abs() < 1e-8, "{} for {expected}", found[0]);
        // The fourth power is rejected: nine nodes give 4 % too little for it (NumPy's rule: 6.0738 for 6.1119).
        assert!(found.len() < 4, "{found:?}");
        terms.push((Term::Product(vec![(0, 1), (1, 1)]), 0.1));
        assert_eq!(of(&terms), None);
        assert!(chaos.apart().terms.iter().all(|term| matches!(term, Term::Product(of) if of.len() == 1)));
    }

    /// Noise that no polynomial explains stays unexplained: a worse fit never replaces the constant.
    #[test]
    fn noise_is_left() {
        let shapes = shapes([&Normal::new(0.0, 1.0).unwrap() as _]);
        let u = [numbers(30, 3)];
        let y = numbers(30, 4);
        let chaos = Chaos::new(&shapes, &[0], None);
        let found = chaos.fit(Places { u: &u, surface: &[] }, &y);
        assert!(found.terms.len() <= 2, "{found:?}");
    }
}
