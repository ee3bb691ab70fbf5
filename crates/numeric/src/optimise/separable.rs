//! Separable problem with a choice of convex costs for every unknown, and its dual.
//!
//! ```text
//! min  sum_g w_g C_g(T_g)     subject to   constant_k + sum_g p_kg (T_g/at_kg)^q_kg <= 1  for every k,   min_g <= T_g <= max_g
//! D(lambda) = sum_k lambda_k (constant_k - 1) + sum_g min over options and T of [ w_g C_g(T) + sum_k lambda_k p_kg (T/at_kg)^q_kg ]
//! ```
//!
//! Losses are further such sums, which are added to the cost. Costs are convex in `T`, and `q` is 1, 2 or -2, with a
//! coefficient above 0 unless `q = 1`. With one option an unknown the problem is convex: the greatest `D` over `lambda >=
//! 0` is the least cost. With several, `D` of any `lambda` is a lower bound of the cost of every choice of options
//! (weak duality). The greatest one is the bound of the convex relaxation.

use faer::Mat;
use faer::linalg::solvers::Solve;

/// Convex cost of an unknown `T` between two bounds.
pub trait BoundedCost {
    /// Least and greatest `T`.
    fn bounds(&self) -> [f64; 2];

    /// Cost at `T`.
    fn cost(&self, t: f64) -> f64;

    /// Cost at `T`, whose logarithm is given.
    fn cost_by(&self, t: f64, ln: f64) -> f64;

    /// First and second derivative of the cost by `ln T`.
    fn log_derivatives(&self, t: f64, ln: f64) -> [f64; 2];

    /// Cost and its derivative by `ln T`.
    fn with_slope(&self, t: f64, ln: f64) -> [f64; 2];
}

/// Unknown whose cost is one of several curves, each with bounds.
pub trait CostedUnknown {
    /// Cost that may be chosen.
    type Option: BoundedCost;

    /// Factor of every cost.
    fn weight(&self) -> f64;

    /// Costs to choose from, at least one.
    fn options(&self) -> &[Self::Option];
}

/// One constraint.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerRow {
    /// Part that no unknown changes.
    pub constant: f64,
    /// Terms of all unknowns.
    pub terms: Vec<PowerTerm>,
}

/// Term `coefficient (T/at)^power`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerTerm {
    /// Value of the term at `at`.
    pub coefficient: f64,
    /// Power: 1, 2 or -2.
    pub power: f64,
    /// Unknown at which the coefficient is the value.
    pub at: f64,
}

impl PowerTerm {
    /// Value of the term.
    pub fn value(&self, t: f64) -> f64 {
        let x = t / self.at;
        self.coefficient
            * match self.power {
                1.0 => x,
                2.0 => x * x,
                _ => 1.0 / (x * x),
            }
    }
}

impl PowerRow {
    /// Value of the constraint. It is kept if the value is at most 1.
    pub fn value(&self, at: &[f64]) -> f64 {
        self.constant + self.terms.iter().zip(at).map(|(term, &t)| term.value(t)).sum::<f64>()
    }
}

/// Separable problem, in which every unknown has the options that are still allowed.
///
/// ```
/// use sensitol_numeric::optimise::separable::{BoundedCost, CostedUnknown, PowerRow, PowerTerm, SeparableProblem};
/// /// Cost `b/T`.
/// struct Reciprocal(f64);
/// impl BoundedCost for Reciprocal {
///     fn bounds(&self) -> [f64; 2] {
///         [0.01, 1.0]
///     }
///     fn cost(&self, t: f64) -> f64 {
///         self.0 / t
///     }
///     fn cost_by(&self, t: f64, _: f64) -> f64 {
///         self.cost(t)
///     }
///     fn log_derivatives(&self, t: f64, _: f64) -> [f64; 2] {
///         [-self.cost(t), self.cost(t)]
///     }
///     fn with_slope(&self, t: f64, _: f64) -> [f64; 2] {
///         [self.cost(t), -self.cost(t)]
///     }
/// }
/// struct Single([Reciprocal; 1]);
/// impl CostedUnknown for Single {
///     type Option = Reciprocal;
///     fn weight(&self) -> f64 {
///         1.0
///     }
///     fn options(&self) -> &[Reciprocal] {
///         &self.0
///     }
/// }
/// let unknowns = [0.1, 0.4].map(|b| Single([Reciprocal(b)]));
/// let term = PowerTerm { coefficient: 1.0, power: 1.0, at: 0.2 };
/// let rows = [PowerRow { constant: 0.0, terms: vec![term; 2] }];
/// let problem = SeparableProblem { unknowns: &unknowns, rows: &rows, losses: &[] };
/// // Lagrange: unknowns as the roots of the costs, 0.2 together.
/// let (_, found) = problem.solve(&[0.0]);
/// assert!((found[0] - 0.2 / 3.0).abs() < 1e-12 && (found[1] - 0.4 / 3.0).abs() < 1e-12);
/// ```
pub struct SeparableProblem<'a, U> {
    /// Unknowns with their costs.
    pub unknowns: &'a [U],
    /// Constraints.
    pub rows: &'a [PowerRow],
    /// Sums that are added to the cost.
    pub losses: &'a [PowerRow],
}

/// Best option and value of an unknown for given multipliers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestOption {
    /// Position of the option.
    pub option: usize,
    /// Value of the unknown.
    pub t: f64,
    /// Cost plus priced use of the constraints.
    pub value: f64,
    /// Second derivative of the value by `ln T`, 0 at a bound.
    curvature: f64,
}

/// Greatest relative excess of a constraint that is kept.
pub const KEPT: f64 = 1e-13;
/// Greatest relative rise of the dual that may be rounding.
const FLAT: f64 = 1e-12;
/// Most Newton steps on the dual between two sweeps.
const NEWTON: usize = 60;
/// Greatest number of sweeps over the multipliers.
const SWEEPS: usize = 40;

impl<U: CostedUnknown> SeparableProblem<'_, U> {
    /// Best option and value of one unknown among the options of `range`.
    pub fn best(&self, g: usize, multipliers: &[f64], range: std::ops::Range<usize>) -> BestOption {
        self.best_near(g, multipliers, range, None)
    }

    /// Best option and value, found sooner if it is near a known one.
    fn best_near(
        &self,
        g: usize,
        multipliers: &[f64],
        range: std::ops::Range<usize>,
        near: Option<&BestOption>,
    ) -> BestOption {
        let options = self.unknowns[g].options()[range.clone()].iter().zip(range);
        let best = options.map(|(option, index)| {
            let near = near.filter(|near| near.option == index).map(|near| near.t);
            self.of_option(g, option, index, multipliers, near)
        });
        best.reduce(|a, b| if b.value < a.value { b } else { a }).expect("every unknown has an option")
    }

    fn of_option(
        &self,
        g: usize,
        option: &U::Option,
        index: usize,
        multipliers: &[f64],
        near: Option<f64>,
    ) -> BestOption {
        let weight = self.unknowns[g].weight();
        let slope = |t: f64, ln: f64| {
            let [first, second] = option.log_derivatives(t, ln);
            let (mut first, mut second) = (weight * first, weight * second);
            for (row, multiplier) in self.weighted(multipliers) {
                let term = &row.terms[g];
                if term.coefficient != 0.0 {
                    let use_ = multiplier * term.power * term.value(t);
                    first += use_;
                    second += term.power * use_;
                }
            }
            (first, second)
        };
        let [min, max] = option.bounds();
        let (t, cost, curvature) = if min == max {
            (min, option.cost(min), 0.0)
        } else {
            let bounds = [min, max].map(|t| (t, libm::log(t)));
            let (t, ln, curvature) = least(&slope, bounds, near);
            (t, option.cost_by(t, ln), curvature)
        };
        let used: f64 = self.weighted(multipliers).map(|(row, multiplier)| multiplier * row.terms[g].value(t)).sum();
        BestOption { option: index, t, value: weight * cost + used, curvature }
    }

    /// Rows with a price: constraints by their multipliers, and losses at 1.
    fn weighted<'m>(&'m self, multipliers: &'m [f64]) -> impl Iterator<Item = (&'m PowerRow, f64)> {
        let priced = self.rows.iter().zip(multipliers.iter().copied()).filter(|(_, multiplier)| *multiplier > 0.0);
        priced.chain(self.losses.iter().map(|row| (row, 1.0)))
    }

    fn all(&self, multipliers: &[f64]) -> Vec<BestOption> {
        (0..self.unknowns.len()).map(|g| self.best(g, multipliers, 0..self.unknowns[g].options().len())).collect()
    }

    /// Best options and values of all unknowns, searched near known ones.
    fn all_near(&self, multipliers: &[f64], near: &[BestOption]) -> Vec<BestOption> {
        let of = |(g, near): (usize, &BestOption)| {
            self.best_near(g, multipliers, 0..self.unknowns[g].options().len(), Some(near))
        };
        near.iter().enumerate().map(of).collect()
    }

    fn bound(&self, multipliers: &[f64], best: &[BestOption]) -> f64 {
        let constants = self.rows.iter().zip(multipliers).map(|(row, multiplier)| multiplier * (row.constant - 1.0));
        let lost: f64 = self.losses.iter().map(|row| row.constant).sum();
        lost + constants.sum::<f64>() + best.iter().map(|best| best.value).sum::<f64>()
    }

    /// Multipliers with the greatest dual value, and the unknowns that belong to them. This is the optimum if every
    /// unknown has one option and the problem has a solution.
    ///
    /// Each multiplier alone comes first, which brings any start near the optimum. Newton steps follow on those above
    /// 0, whose Hessian is `-sum_g j_g j_g' / curvature_g` over the unknowns within their bounds.
    pub fn solve(&self, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut multipliers = start.to_vec();
        let mut best = self.all(&multipliers);
        for round in 0..SWEEPS {
            if self.newton(&mut multipliers, &mut best) {
                break;
            }
            for k in 0..multipliers.len() {
                self.alone(k, &mut multipliers);
            }
            best = self.all(&multipliers);
            // With one constraint, a second search of its multiplier alone changes nothing.
            if multipliers.len() == 1 && round > 0 {
                break;
            }
        }
        (multipliers, best.iter().map(|best| best.t).collect())
    }

    fn misses(&self, best: &[BestOption]) -> Vec<f64> {
        let at: Vec<f64> = best.iter().map(|best| best.t).collect();
        self.rows.iter().map(|row| row.value(&at) - 1.0).collect()
    }

    /// Violation of the conditions of an optimum: constraints exceeded, or with slack and a price.
    fn error(multipliers: &[f64], misses: &[f64]) -> f64 {
        let one = |(&multiplier, &miss): (&f64, &f64)| if multiplier > 0.0 { miss.abs() } else { miss.max(0.0) };
        multipliers.iter().zip(misses).map(one).fold(0.0, f64::max)
    }

    /// Newton steps as long as the dual rises. Steps that only lower the violations could alternate with
    /// [`alone`](Self::alone) without end.
    fn newton(&self, multipliers: &mut Vec<f64>, best: &mut Vec<BestOption>) -> bool {
        for _ in 0..NEWTON {
            let misses = self.misses(best);
            let error = Self::error(multipliers, &misses);
            if error <= KEPT {
                return true;
            }
            let active: Vec<usize> =
                (0..multipliers.len()).filter(|&k| multipliers[k] > 0.0 || misses[k] > 0.0).collect();
            let value = self.bound(multipliers, best);
            let n = active.len();
            let mut matrix = Mat::<f64>::zeros(n, n);
            for (g, best) in best.iter().enumerate().filter(|(_, best)| best.curvature > 0.0) {
                let slopes: Vec<f64> = (active.iter())
                    .map(|&k| self.rows[k].terms[g].power * self.rows[k].terms[g].value(best.t))
                    .collect();
                for (a, slope) in slopes.iter().enumerate() {
                    slopes.iter().enumerate().for_each(|(b, other)| matrix[(a, b)] += slope * other / best.curvature);
                }
            }
            let largest = (0..n).map(|a| matrix[(a, a)]).fold(0.0, f64::max);
            if largest == 0.0 {
                return false;
            }
            // Two rows may use the unknowns in the same proportions. Any split of the price
            // between them is then right.
            (0..n).for_each(|a| matrix[(a, a)] += 1e-13 * largest);
            let right = Mat::from_fn(n, 1, |a, _| misses[active[a]]);
            let step = matrix.partial_piv_lu().solve(&right);
            if step.col_as_slice(0).iter().any(|step| !step.is_finite()) {
                return false;
            }
            let mut accepted = false;
            for halved in 0..12 {
                let part = 0.5f64.powi(halved);
                let mut trial = multipliers.clone();
                active
                    .iter()
                    .zip(step.col_as_slice(0))
                    .for_each(|(&k, step)| trial[k] = (trial[k] + part * step).max(0.0));
                let there = self.all_near(&trial, best);
                let found = self.misses(&there);
                let rise = self.bound(&trial, &there) - value;
                let foretold: f64 =
                    active.iter().map(|&k| misses[k] * (trial[k] - multipliers[k])).sum::<f64>().max(0.0);
                // Near the optimum the dual is flat to its last digits, and the violations are the better measure.
                let flat =
                    rise.abs() <= FLAT * value.abs() && Self::error(&trial, &found) < error * (1.0 - 1e-4 * part);
                if flat || rise > 1e-4 * foretold {
                    (*multipliers, *best, accepted) = (trial, there, true);
                    break;
                }
            }
            if !accepted {
                // The step failed, but the error may be as small as rounding allows.
                return error <= 1e3 * KEPT;
            }
        }
        false
    }

    /// Finds the multiplier of one constraint that makes it active, with the others fixed.
    fn alone(&self, k: usize, multipliers: &mut [f64]) {
        let mut miss = |value: f64| {
            multipliers[k] = value;
            let at: Vec<f64> = self.all(multipliers).iter().map(|best| best.t).collect();
            self.rows[k].value(&at) - 1.0
        };
        if miss(0.0) <= 0.0 {
            multipliers[k] = 0.0;
            return;
        }
        let dearest = |unknown: &U| {
            let option = &unknown.options()[0];
            unknown.weight() * option.cost(option.bounds()[0])
        };
        let scale: f64 = self.unknowns.iter().map(dearest).sum();
        let (mut low, mut high) = (0.0, scale.max(f64::MIN_POSITIVE) * 1e-6);
        while miss(high) > 0.0 {
            (low, high) = (high, 16.0 * high);
            if high > 1e30 * scale.max(1.0) {
                multipliers[k] = high;
                return;
            }
        }
        for _ in 0..80 {
            let middle = if low == 0.0 { 1e-3 * high } else { (low * high).sqrt() };
            if low > 0.0 && high / low - 1.0 < 1e-9 {
                break;
            }
            if miss(middle) > 0.0 { low = middle } else { high = middle }
        }
        multipliers[k] = high;
    }

    /// Near the greatest lower bound of the cost of any choice from these ranges of options. It takes at most `steps`
    /// steps from `multipliers`, which are set to the best ones found. `known` is the cost of a known choice.
    pub fn bounded(
        &self,
        ranges: &[std::ops::Range<usize>],
        multipliers: &mut Vec<f64>,
        known: f64,
        steps: usize,
    ) -> (f64, Vec<BestOption>) {
        let all = |multipliers: &[f64]| -> Vec<BestOption> {
            ranges.iter().enumerate().map(|(g, range)| self.best(g, multipliers, range.clone())).collect()
        };
        let mut at = multipliers.clone();
        let mut best = all(&at);
        let mut greatest = self.bound(&at, &best);
        let mut of_greatest = best.clone();
        let mut patience = 0;
        let mut length = 1.0;
        let target = if known.is_finite() { known } else { greatest.abs().max(1.0) * 1.05 };
        for _ in 0..steps {
            if greatest >= known {
                break;
            }
            let slopes: Vec<f64> = (self.rows.iter())
                .map(|row| {
                    row.constant - 1.0 + row.terms.iter().zip(&best).map(|(term, best)| term.value(best.t)).sum::<f64>()
                })
                .collect();
            let useful = |k: usize| at[k] > 0.0 || slopes[k] > 0.0;
            let square: f64 = (0..at.len()).filter(|&k| useful(k)).map(|k| slopes[k] * slopes[k]).sum();
            if square <= 1e-24 {
                break;
            }
            // Polyak's step towards the known cost.
            let value = self.bound(&at, &best);
            let step = length * (target - value).max(1e-3 * target.abs()) / square;
            at.iter_mut().zip(&slopes).for_each(|(at, slope)| *at = (*at + step * slope).max(0.0));
            best = all(&at);
            let value = self.bound(&at, &best);
            if value > greatest {
                (greatest, patience) = (value, 0);
                multipliers.clone_from(&at);
                of_greatest.clone_from(&best);
            } else {
                patience += 1;
                if patience >= 4 {
                    (length, patience) = (0.5 * length, 0);
                    at.clone_from(multipliers);
                    best.clone_from(&of_greatest);
                }
                if length < 1e-3 {
                    break;
                }
            }
        }
        (greatest, of_greatest)
    }
}

/// Minimum of a convex function of `T` between two bounds, each with its logarithm, from its first and second
/// derivative by `ln T`. Returns `T`, its logarithm, and the second derivative there, 0 at a bound. From a place near
/// it, if one is given, Newton's method alone is used.
fn least(slope: &impl Fn(f64, f64) -> (f64, f64), bounds: [(f64, f64); 2], near: Option<f64>) -> (f64, f64, f64) {
    if let Some(found) = near.and_then(|near| least_near(slope, bounds, near)) {
        return found;
    }
    let [(min, mut low), (max, mut high)] = bounds;
    if slope(min, low).0 >= 0.0 {
        return (min, low, 0.0);
    }
    if slope(max, high).0 <= 0.0 {
        return (max, high, 0.0);
    }
    let mut x = 0.5 * (low + high);
    let mut last = f64::INFINITY;
    for _ in 0..200 {
        let (first, second) = slope(libm::exp(x), x);
        if first == 0.0 {
            return (libm::exp(x), x, second.max(f64::MIN_POSITIVE));
        }
        if first > 0.0 {
            high = x
        } else {
            low = x
        }
        let newton = x - first / second;
        let inside = second > 0.0 && newton > low && newton < high && (newton - x).abs() < 0.7 * last;
        let next = if inside { newton } else { 0.5 * (low + high) };
        last = (next - x).abs();
        x = next;
        if last <= 4.0 * f64::EPSILON * x.abs().max(1.0) {
            break;
        }
    }
    let t = libm::exp(x).clamp(min, max);
    (t, x, slope(t, x).1.max(f64::MIN_POSITIVE))
}

/// Minimum by Newton's method alone. Returns None if a step leaves the bounds or the steps do not end soon. A convex
/// function has no other minimum.
fn least_near(
    slope: &impl Fn(f64, f64) -> (f64, f64),
    [(min, low), (max, high)]: [(f64, f64); 2],
    near: f64,
) -> Option<(f64, f64, f64)> {
    /// Greatest number of steps of Newton's method from a near place.
    const STEPS: usize = 8;
    let mut x = libm::log(near);
    for _ in 0..STEPS {
        let (first, second) = slope(libm::exp(x), x);
        let next = x - first / second;
        if !(second > 0.0 && next > low && next < high) {
            return None;
        }
        if (next - x).abs() <= 4.0 * f64::EPSILON * next.abs().max(1.0) {
            return Some((libm::exp(next).clamp(min, max), next, second));
        }
        x = next;
    }
    None
}
