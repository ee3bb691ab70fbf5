//! Cross-fitted sparse regression as control variate, on Sobol' points added in batches (strides) that double.
//!
//! Sobol' points are drawn in 16 scramblings (Owen 1997). Every stride doubles their number: 16, 32, 64, ... The scramblings are divided
//! into four parts. For each part a sparse regression `s` is fitted to the points of the other three, and to the points that the method has
//! evaluated before. With `v` 1 if the model has a value and 0 if not,
//!
//! ```text
//! E[v y^p] = E[s^p] + E[v y^p - s^p]        p = 1 .. 4, and likewise for the indicators of a share
//! ```
//!
//! The first term is computed from many points of `s`, which cost nothing, and the second from the held-out part. So the estimate has no
//! bias, regardless of the quality of the regression, and its error comes from the residuals (Glynn and Szechtman 2002 on control variates,
//! Chernozhukov and others 2018 on cross-fitting). Errors are those of the jackknife over the scramblings, and at least those of effects
//! that so few points overlook.

use crate::analysis::SampledModel;
use crate::analysis::sampling::known_answers::KnownAnswersFunction;
use crate::analysis::sampling::recorded_points::ranked;
use crate::assembly::{EvaluationError, Points};
use crate::estimate::{
    MOMENTS, REPLICATES, Share, carried_by, effective, jackknife, reported_quantiles, standard, student, totals,
};
use crate::evaluation::Evaluator;
use crate::method::{AutoAccount, Outcome};
use crate::plan::Point;
use crate::problem::Problem;
use crate::simulation::{BINS, CHOICE, Histogram};
use crate::verification::{OVERLOOKED, OVERLOOKED_BY, TOO_SMALL};
use sensitol_numeric::capability::EstimatedQuantile;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::sampling::{Draws, Estimate, Fine, Portion, SOBOL_DIMENSIONS, Sampler, Scale};
use sensitol_numeric::surrogate::{Chaos, Places, Sparse, Surrogate};

/// Number of parts into which the scramblings are divided.
const PARTS: usize = 4;
/// Greatest number of points evaluated by the method that a regression is also fitted to.
const FITTED: usize = 1 << 10;
/// Greatest number of points of a regression in each scrambling.
const KNOTS: usize = 1 << 12;
/// Smallest number of points of a regression in each scrambling.
const FEWEST: usize = 1 << 8;
/// Greatest number of random numbers for the points of all scramblings together.
const NUMBERS: usize = 1 << 21;
/// Root mean squares of the influence of a point on mean, sigma, skewness and kurtosis of a normal distribution, in its sigmas (Serfling
/// 1980).
const INFLUENCE: [f64; MOMENTS] = [1.0, 1.0, 4.3, 9.8];
/// Greatest deviation of the exact moments of a regression from those at its points, in standard errors. Beyond it the exact ones are not
/// used.
const EXACT: f64 = 4.0;
/// Ratio of scale to origin below which roundings would exceed 1e-8 of a fourth power.
const CANCELS: f64 = 1e-2;

/// A batch of points drawn together: `rows` of every scrambling, one scrambling after the other.
struct Stride {
    rows: usize,
    /// Standardised inputs, a column for every varying dimension.
    u: Vec<Vec<f64>>,
    /// Values, a column for every characteristic.
    y: Vec<Vec<f64>>,
}

/// All points drawn so far, with their answers.
pub(in crate::analysis) struct CrossFit<'p> {
    problem: &'p Problem,
    outcome: &'p Outcome,
    draws: Draws<'p>,
    strides: Vec<Stride>,
    /// Points for the means of the regressions, the same number for every scrambling.
    knots: Stride,
    failed: Vec<(usize, Option<EvaluationError>)>,
    /// All answers, so that a later sample can reuse them.
    pub(in crate::analysis) answers: KnownAnswersFunction,
}

/// Basis of the regression that serves as control variate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Basis {
    /// The known surface without a regression.
    Surface,
    Products,
    /// Products and powers of the known surface.
    Powers,
    /// The exponential of a regression on products, for values of one sign. Products and powers of the inputs become sums in the logarithm
    /// (Box and Cox 1964).
    Logarithm,
    /// Like `Logarithm`, but without products: each input has a factor of its own.
    Factors,
}

impl Basis {
    fn is_logarithm(self) -> bool {
        matches!(self, Self::Logarithm | Self::Factors)
    }
}

/// Regressions of one characteristic, one for every part, and its known surface with mean and sigma.
pub(in crate::analysis) struct Beside<'p> {
    kind: Basis,
    chaos: Chaos,
    surface: Option<(&'p Surrogate, Moments)>,
    /// True if the moments of the surface are exact.
    exact: bool,
    /// Regression of each of the parts. Empty if a logarithm is to be fitted and the values have both signs.
    parts: Vec<Sparse>,
    /// Sign of values that are fitted by their logarithm.
    sign: f64,
    rows: usize,
    /// Error of the regressions three sigma out, in the unit of the characteristic, at points that were not fitted.
    far: f64,
}

/// Mean, sigma, skewness and kurtosis, then the shares below and above the limits and within them.
#[derive(Clone)]
struct Figures {
    values: Vec<f64>,
    errors: Vec<f64>,
}

/// Estimates for one characteristic from the points.
pub(in crate::analysis) struct CrossFitFigures {
    /// Estimates of mean, sigma, skewness, kurtosis.
    pub(in crate::analysis) moments: [Estimate; MOMENTS],
    pub(in crate::analysis) sampled: SampledModel,
}

impl<'p> CrossFit<'p> {
    /// Returns None if a dimension cannot be sampled.
    pub(in crate::analysis) fn new(problem: &'p Problem, outcome: &'p Outcome, seed: u64) -> Option<Self> {
        let n = outcome.plan.varying().len();
        let all = problem.dimensions().iter().filter(|dimension| dimension.sigma() > 0.0).count();
        let sampler = if all <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
        let draws = |seed| Draws::new(problem.dimensions(), problem.correlation(), sampler, seed).ok();
        let rows = (NUMBERS / n.max(1) / REPLICATES).clamp(FEWEST, KNOTS).next_power_of_two();
        let (points, own) = (points(&draws(!seed)?, 0, rows), draws(seed)?);
        let knots = Stride { rows, u: problem.standardised(&points, outcome.plan.varying()), y: Vec::new() };
        let characteristics = problem.characteristics().len();
        Some(Self {
            problem,
            outcome,
            draws: own,
            strides: Vec::new(),
            knots,
            failed: vec![(0, None); characteristics],
            answers: KnownAnswersFunction::new(problem),
        })
    }

    /// Points of one scrambling so far.
    fn rows(&self) -> usize {
        self.strides.iter().map(|stride| stride.rows).sum()
    }

    /// Number of points of the next stride: as many as there are, within `most` in all.
    pub(in crate::analysis) fn next(&self, most: usize) -> usize {
        let rows = self.rows();
        REPLICATES * rows.max(1).min((most / REPLICATES).saturating_sub(rows))
    }

    /// Evaluates the points of the next stride. Returns true if all of it was answered.
    pub(in crate::analysis) fn draw(&mut self, most: usize, evaluator: &Evaluator<'_>) -> bool {
        let rows = self.next(most) / REPLICATES;
        let points = points(&self.draws, self.rows(), rows);
        let out = evaluator.ask(&points);
        let whole = !out.has_open_entries();
        for (_, output, error) in out.errors() {
            let (count, first) = &mut self.failed[output];
            *count += 1;
            first.get_or_insert_with(|| error.clone());
        }
        let u = self.problem.standardised(&points, self.outcome.plan.varying());
        let y = (0..out.outputs()).map(|output| out.column(output).to_vec()).collect();
        self.strides.push(Stride { rows, u, y });
        self.answers.keep(&points, out);
        whole
    }

    /// Unfitted control variates of one characteristic: its surface, a regression on products, one with powers of the surface too, and two
    /// of the logarithm.
    pub(in crate::analysis) fn beside(&self, c: usize) -> Vec<Beside<'p>> {
        let kinds = [Basis::Surface, Basis::Products, Basis::Powers, Basis::Logarithm, Basis::Factors];
        let kinds = kinds.map(|kind| self.kind(c, kind));
        let alone = |kind: Basis| kind == Basis::Products || kind.is_logarithm();
        kinds.into_iter().filter(|beside| alone(beside.kind) || beside.surface.is_some()).collect()
    }

    fn kind(&self, c: usize, kind: Basis) -> Beside<'p> {
        let plan = &self.outcome.plan;
        let fitted = self.outcome.fitted[c].surrogate.as_ref();
        let surface = fitted.and_then(|surrogate| {
            let found = surrogate.contributions(plan.inputs())?;
            (found.moments.sigma() > 0.0).then_some((surrogate, found))
        });
        let share = |j: usize| surface.as_ref().map_or(0.0, |(_, found)| found.linear[j] + found.curvature[j]);
        let mut order: Vec<usize> = (0..plan.varying().len()).filter(|&j| plan.depends(c, plan.varying()[j])).collect();
        order.sort_by(|&a, &b| share(b).total_cmp(&share(a)).then(a.cmp(&b)));
        let exact = surface.as_ref().is_some_and(|(_, found)| found.sampled.is_none());
        let surface = surface.map(|(surrogate, found)| (surrogate, found.moments));
        let known = surface.as_ref().filter(|_| !kind.is_logarithm());
        let chaos = Chaos::new(plan.inputs().shapes(), &order, known.map(|_| kind == Basis::Powers));
        let chaos = if kind == Basis::Factors { chaos.apart() } else { chaos };
        Beside { kind, chaos, surface, exact, parts: Vec::new(), sign: 1.0, rows: 0, far: 0.0 }
    }

    /// Estimates from all points drawn so far. Regressions are fitted anew if points were added.
    pub(in crate::analysis) fn found(&self, c: usize, beside: &mut [Beside<'_>], left: f64) -> Option<CrossFitFigures> {
        for beside in beside.iter_mut().filter(|beside| beside.rows < self.rows()) {
            self.fit(c, beside);
        }
        let values: Vec<f64> = self.strides.iter().flat_map(|stride| &stride.y[c]).copied().collect();
        let valid: Vec<f64> = values.iter().copied().filter(|y| y.is_finite()).collect();
        let n = valid.len() as f64;
        let origin = valid.iter().sum::<f64>() / n;
        let spread = (valid.iter().map(|y| (y - origin).powi(2)).sum::<f64>() / n).sqrt();
        if valid.len() < REPLICATES / 2 || spread.is_nan() {
            return None;
        }
        let unit = [origin, if spread > 0.0 { spread } else { 1.0 }];
        let plain = self.figures(c, None, unit)?;
        let error = |of: &Option<Figures>| of.as_ref().map_or(f64::INFINITY, |of| of.errors[1]);
        let each: Vec<Option<Figures>> = beside.iter().map(|beside| self.figures(c, Some(beside), unit)).collect();
        let best = (0..each.len()).min_by(|&a, &b| error(&each[a]).total_cmp(&error(&each[b])));
        let with = best.and_then(|best| each[best].as_ref());
        let best = with.map_or_else(|| plain.clone(), |with| chosen(&plain, with));
        let estimate = |i: usize| Estimate { value: best.values[i], standard_error: Some(best.errors[i]) };
        let limits = self.problem.characteristics()[c].limits();
        let share = |i: usize| best.values[i].clamp(0.0, 1.0);
        let around = |i: usize| [-2.0, 2.0].map(|times| (best.values[i] + times * best.errors[i]).clamp(0.0, 1.0));
        let (failed, error) = &self.failed[c];
        Some(CrossFitFigures {
            moments: [0, 1, 2, 3].map(estimate),
            sampled: SampledModel {
                samples: valid.len() as u64,
                failed: *failed as u64,
                error: error.as_ref().map(ToString::to_string),
                left: Some(left),
                standard_errors: [0, 1, 2, 3].map(|i| Some(best.errors[i])),
                yield_: limits.exist().then(|| share(MOMENTS + 2)),
                yield_interval: limits.exist().then(|| around(MOMENTS + 2)),
                beyond: [limits.lower().map(|_| share(MOMENTS)), limits.upper().map(|_| share(MOMENTS + 1))],
                intervals: [limits.lower().map(|_| around(MOMENTS)), limits.upper().map(|_| around(MOMENTS + 1))],
                quantiles: self.quantiles(c),
                histogram: histogram(&valid),
                ranks: self.ranks(c, &values),
            },
        })
    }

    /// Quantiles of the model's values at the points drawn so far.
    fn quantiles(&self, c: usize) -> [Option<EstimatedQuantile>; 7] {
        let points = self.strides.iter().flat_map(|stride| {
            let rows = stride.rows;
            stride.y[c].iter().enumerate().map(move |(row, &y)| (y, (row / rows) % REPLICATES))
        });
        reported_quantiles(points.filter(|(y, _)| y.is_finite()), REPLICATES)
    }

    /// First-order indices of the dimensions on which a characteristic depends, by the ranks of the points.
    fn ranks(&self, c: usize, values: &[f64]) -> Vec<(usize, Share)> {
        let plan = &self.outcome.plan;
        let column = |j: usize| -> Vec<f64> { self.strides.iter().flat_map(|stride| &stride.u[j]).copied().collect() };
        let depends = plan.varying().iter().enumerate().filter(|&(_, &d)| plan.depends(c, d));
        depends.filter_map(|(j, &d)| ranked(d, &column(j), values)).collect()
    }

    /// Fits the regression of every part to the points of the others, and to points that were evaluated before.
    fn fit(&self, c: usize, beside: &mut Beside<'_>) {
        let plan = &self.outcome.plan;
        let known = &self.outcome.evaluated.known;
        let n = plan.varying().len();
        let place = |point: &Point| {
            let mut u = vec![0.0; n];
            for at in point.at() {
                if let Ok(position) = plan.varying().binary_search(&(at.dimension as usize)) {
                    u[position] = plan.axis(at.dimension as usize).nodes[at.node as usize].u;
                }
            }
            u
        };
        // Only points off the axes: a point on an axis is not typical of the distribution, and the difference plan is exact there.
        let off_axes = |point: &&Point| point.at().len() > 2 || n <= 2 && point.at().len() == n;
        let looked = self.outcome.climbed.iter().flat_map(|climbed| &climbed.far);
        let far: Vec<&Point> = looked.filter(|(of, _)| *of == c).flat_map(|(_, points)| points).collect();
        let paid: Vec<(Vec<f64>, f64)> = (known.points().iter().filter(off_axes).filter(|point| !far.contains(point)))
            .filter_map(|point| Some((place(point), known.value(point, c)?)))
            .take(FITTED)
            .collect();
        beside.rows = self.rows();
        if beside.kind.is_logarithm() {
            let strided = || self.strides.iter().flat_map(|stride| &stride.y[c]).filter(|y| y.is_finite());
            let all = |sign: f64| paid.iter().map(|(_, y)| y).chain(strided()).all(|y| y * sign > 0.0);
            let Some(sign) = [1.0, -1.0].into_iter().find(|&sign| all(sign)) else {
                beside.parts.clear();
                return;
            };
            beside.sign = sign;
        }
        beside.parts = (0..PARTS)
            .map(|part| {
                if let Some((_, moments)) = beside.surface.as_ref().filter(|_| beside.kind == Basis::Surface) {
                    return Sparse::surface(moments.mean(), moments.sigma());
                }
                let mut u: Vec<Vec<f64>> = (0..n).map(|j| paid.iter().map(|(u, _)| u[j]).collect()).collect();
                let mut y: Vec<f64> = paid.iter().map(|(_, y)| *y).collect();
                for stride in &self.strides {
                    let own = |row: &usize| (row / stride.rows) % PARTS != part && stride.y[c][*row].is_finite();
                    for row in (0..REPLICATES * stride.rows).filter(own) {
                        u.iter_mut().zip(&stride.u).for_each(|(all, column)| all.push(column[row]));
                        y.push(stride.y[c][row]);
                    }
                }
                if beside.kind.is_logarithm() {
                    y.iter_mut().for_each(|y| *y = libm::log(y.abs()));
                }
                let surface = beside.surface(&u, y.len());
                beside.chaos.fit(Places { u: &u, surface: &surface }, &y)
            })
            .collect();
        // Points far out that no regression was fitted to show its error there.
        let seen: Vec<(Vec<f64>, f64)> =
            far.iter().filter_map(|point| Some((place(point), known.value(point, c)?))).collect();
        let columns: Vec<Vec<f64>> = (0..n).map(|j| seen.iter().map(|(u, _)| u[j]).collect()).collect();
        let surface = beside.surface(&columns, seen.len());
        let places = Places { u: &columns, surface: &surface };
        let off = |sparse: &Sparse| {
            let values = beside.of(sparse, places, seen.len());
            values.iter().zip(&seen).map(|(s, (_, y))| (y - s).abs()).fold(0.0, f64::max)
        };
        let off = beside.parts.iter().map(off).sum::<f64>() / PARTS as f64;
        // A point without a value is a jump that no regression follows.
        beside.far = if seen.len() < far.len() { f64::INFINITY } else { off };
    }

    /// Figures with a control variate, or without. Values are centred and scaled by `origin` and `scale`. Returns None if a figure is
    /// unknown.
    fn figures(&self, c: usize, beside: Option<&Beside<'_>>, [origin, scale]: [f64; 2]) -> Option<Figures> {
        if beside.is_some_and(|beside| beside.parts.is_empty()) {
            return None;
        }
        let limits = self.problem.characteristics()[c].limits();
        let kept = self.problem.kept_limits(c);
        let sides = |y: f64| kept.broken(y).map(|side| f64::from(u8::from(side)));
        // Four powers of a value, and the two sides of the limits.
        const TERMS: usize = MOMENTS + 2;
        let terms = |y: f64| {
            let v = (y - origin) / scale;
            let [below, above] = sides(y);
            [v, v * v, v.powi(3), v.powi(4), below, above]
        };
        let rows = self.rows() as f64;
        // Sums of the valid points, and of every term.
        let mut sums = vec![vec![0.0; REPLICATES]; 1 + TERMS];
        let mut carried: Vec<Vec<f64>> = vec![Vec::new(); MOMENTS];
        let (mut square, mut count) = (0.0, 0.0);
        for stride in &self.strides {
            let surface = beside.map(|beside| beside.values(stride));
            for (row, &y) in stride.y[c].iter().enumerate() {
                let replicate = row / stride.rows;
                let valid = y.is_finite();
                let model = if valid { terms(y) } else { [0.0; TERMS] };
                let control = surface.as_ref().map_or([0.0; TERMS], |surface| terms(surface[row]));
                sums[0][replicate] += f64::from(u8::from(valid)) / rows;
                for (term, (own, control)) in model.iter().zip(control).enumerate() {
                    sums[1 + term][replicate] += (own - control) / rows;
                    if term < MOMENTS {
                        carried[term].push(own - control);
                    }
                }
                if let Some(surface) = surface.as_ref().filter(|_| valid) {
                    square += ((y - surface[row]) / scale).powi(2);
                    count += 1.0;
                }
            }
        }
        let knots = beside.map(|beside| beside.values(&self.knots));
        if let (Some(beside), Some(knots)) = (beside, &knots) {
            self.integrate(beside, knots, [origin, scale], &terms, &mut sums[1..]);
        }
        let of = |total: &[f64]| {
            let raw: Vec<f64> = total[1..].iter().map(|sum| sum / total[0]).collect();
            let mut figures = standard(&raw, origin, scale);
            figures.push(1.0 - raw[MOMENTS] - raw[MOMENTS + 1]);
            figures
        };
        let values = of(&totals(&sums));
        let mut errors = jackknife(of, &sums);
        let all = self.rows() * REPLICATES;
        let floor = OVERLOOKED * OVERLOOKED_BY.sqrt() / all as f64;
        let units = [scale, scale, 1.0, 1.0];
        for (moment, error) in errors.iter_mut().enumerate().take(MOMENTS) {
            *error *= student(REPLICATES) * carried_by(effective(carried[moment].iter().copied()));
            *error = libm::hypot(*error, floor * INFLUENCE[moment] * units[moment]);
        }
        // A side may have rejects although no point shows any. Its allowance is the weight of one point, or the change of the share if the
        // limit moves by the residual, whichever is less.
        let rho = TOO_SMALL * (square / f64::max(count, 1.0)).sqrt() + OVERLOOKED * (OVERLOOKED_BY / all as f64).sqrt();
        let moved = |side: usize| {
            let limit = [limits.lower(), limits.upper()][side];
            let (Some(limit), Some(knots)) = (limit, &knots) else { return limit.map(|_| f64::INFINITY) };
            let by = rho * scale.max((limit - values[0]).abs());
            let share = |limit: f64| knots.iter().filter(|&&s| s < limit).count() as f64 / knots.len() as f64;
            Some((share(limit + by) - share(limit)).abs().max((share(limit) - share(limit - by)).abs()))
        };
        let one = [0, 1].map(|side| moved(side).map_or(0.0, |moved| moved.min(1.0 / all as f64)));
        for (error, one) in errors[MOMENTS..].iter_mut().zip([one[0], one[1], libm::hypot(one[0], one[1])]) {
            *error = libm::hypot(*error * student(REPLICATES), one);
        }
        if let Some(beside) = beside {
            let far = AutoAccount::far_out(beside.far / scale);
            let grown = [far * scale, far * scale, 6.0 * far, 20.0 * far];
            errors.iter_mut().zip(grown).for_each(|(error, far)| *error = libm::hypot(*error, far));
        }
        let whole = values.iter().chain(&errors).all(|value| value.is_finite());
        whole.then_some(Figures { values, errors })
    }

    /// Adds the means of the regressions' terms. Those of the powers come from the exact moments of the regression if possible, else from
    /// the moments of the surface and the differences of the regression from it at its points.
    fn integrate<const TERMS: usize>(
        &self,
        beside: &Beside<'_>,
        knots: &[f64],
        [origin, scale]: [f64; 2],
        terms: &dyn Fn(f64) -> [f64; TERMS],
        sums: &mut [Vec<f64>],
    ) {
        let rows = self.knots.rows as f64;
        // With the exact moments of the surface, only the differences of the regression from it are averaged over points.
        let anchor = beside.surface.as_ref().filter(|_| beside.exact).map(|(_, moments)| {
            let (m, s) = ((moments.mean() - origin) / scale, moments.sigma() / scale);
            let (skewness, kurtosis) = (moments.skewness().unwrap_or(0.0), moments.kurtosis().unwrap_or(0.0));
            let (second, third, fourth) = (s * s, skewness * s.powi(3), kurtosis * s.powi(4));
            let raw = [
                m,
                m * m + second,
                m.powi(3) + 3.0 * m * second + third,
                m.powi(4) + 6.0 * m * m * second + 4.0 * m * third + fourth,
            ];
            (m, s, raw)
        });
        let surface = beside.surface(&self.knots.u, knots.len());
        // Means of the terms, and of their differences from those of the surface.
        let mut plain = vec![vec![0.0; REPLICATES]; TERMS];
        let mut differences = plain.clone();
        for (row, &value) in knots.iter().enumerate() {
            let replicate = row / self.knots.rows;
            let own = terms(value);
            let v = (anchor.as_ref()).map_or(0.0, |(m, s, _)| m + s * surface[row]);
            for (index, term) in own.iter().enumerate() {
                plain[index][replicate] += term / rows;
                let other = if index < MOMENTS { v.powi(index as i32 + 1) } else { 0.0 };
                differences[index][replicate] += (term - other) / rows;
            }
        }
        let spread = |values: &[f64]| {
            let mean = values.iter().sum::<f64>() / REPLICATES as f64;
            let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (mean, (square / (REPLICATES * (REPLICATES - 1)) as f64).sqrt())
        };
        let exact = self.exact(beside, [origin, scale]);
        for index in 0..TERMS {
            let exact: Option<Vec<f64>> =
                exact.as_ref().and_then(|parts| parts.iter().map(|part| part.get(index).copied()).collect());
            let (mean, error) = spread(&plain[index]);
            // The exact moments of a regression are used only if they agree with those at its points.
            let believed =
                exact.filter(|exact| (exact.iter().sum::<f64>() / PARTS as f64 - mean).abs() <= EXACT * error + 1e-9);
            let anchored = anchor.as_ref().filter(|_| index < MOMENTS && spread(&differences[index]).1 < error);
            for replicate in 0..REPLICATES {
                sums[index][replicate] += match (&believed, anchored) {
                    (Some(exact), _) => exact[replicate % PARTS],
                    (None, Some((.., raw))) => raw[index] + differences[index][replicate],
                    (None, None) => plain[index][replicate],
                };
            }
        }
    }
}

impl CrossFit<'_> {
    /// Exact means of the powers of every part, centred and scaled by `origin` and `scale`: two of a polynomial, four of a product of
    /// functions of one input each. Returns None with correlated inputs.
    fn exact(&self, beside: &Beside<'_>, [origin, scale]: [f64; 2]) -> Option<Vec<Vec<f64>>> {
        if self.problem.correlation().is_some() {
            return None;
        }
        let shapes = self.outcome.plan.inputs().shapes();
        let surface = beside.surface.as_ref().map(|(surrogate, moments)| (*surrogate, moments.sigma()));
        let known = |sparse: &Sparse| -> Option<Vec<f64>> {
            if beside.kind.is_logarithm() {
                let logarithms = beside.chaos.exponentials(sparse, shapes)?;
                return Some(
                    logarithms
                        .iter()
                        .zip(1..)
                        .map(|(value, power)| beside.sign.powi(power) * libm::exp(*value))
                        .collect(),
                );
            }
            beside.chaos.squares(sparse, shapes, surface).map(Vec::from)
        };
        // About an origin many sigmas from 0, cancellation would leave nothing of a high power.
        let most = if scale.abs() > CANCELS * origin.abs() { MOMENTS } else { 2 };
        let about = |raw: Vec<f64>| -> Vec<f64> {
            let power = |p: usize| {
                let mut binomial = 1.0;
                let mut sum = 0.0;
                for k in 0..=p {
                    let moment = if k == 0 { 1.0 } else { raw[k - 1] };
                    sum += binomial * moment * (-origin).powi((p - k) as i32);
                    binomial *= (p - k) as f64 / (k + 1) as f64;
                }
                sum / scale.powi(p as i32)
            };
            (1..=raw.len().min(most)).map(power).collect()
        };
        beside.parts.iter().map(|sparse| known(sparse).map(about)).collect()
    }
}

impl Beside<'_> {
    /// Standardised values of the known surface.
    fn surface(&self, u: &[Vec<f64>], rows: usize) -> Vec<f64> {
        let Some((surrogate, moments)) = &self.surface else { return Vec::new() };
        let rises = surrogate.rises(u).unwrap_or_else(|| vec![0.0; rows]);
        rises.into_iter().map(|rise| (surrogate.centre + rise - moments.mean()) / moments.sigma()).collect()
    }

    /// Values of one of its regressions.
    fn of(&self, sparse: &Sparse, places: Places<'_>, rows: usize) -> Vec<f64> {
        let mut values = self.chaos.values(sparse, places, rows);
        if self.kind.is_logarithm() {
            values.iter_mut().for_each(|value| *value = self.sign * libm::exp(*value));
        }
        values
    }

    /// Held-out values of the regressions: at every point those of the regression that was not fitted to it.
    fn values(&self, stride: &Stride) -> Vec<f64> {
        let rows = REPLICATES * stride.rows;
        let surface = self.surface(&stride.u, rows);
        let places = Places { u: &stride.u, surface: &surface };
        let each: Vec<Vec<f64>> = self.parts.iter().map(|sparse| self.of(sparse, places, rows)).collect();
        (0..rows).map(|row| each[(row / stride.rows) % PARTS][row]).collect()
    }
}

/// Figures with the smaller error, chosen one by one. If such moments are impossible, all moments come from the estimate with the smaller
/// error of sigma.
fn chosen(plain: &Figures, with: &Figures) -> Figures {
    let pick = |better: &dyn Fn(usize) -> bool| {
        let of = |i: usize| if better(i) { with } else { plain };
        Figures {
            values: (0..plain.values.len()).map(|i| of(i).values[i]).collect(),
            errors: (0..plain.errors.len()).map(|i| CHOICE * of(i).errors[i]).collect(),
        }
    };
    let shares = |i: usize| i >= MOMENTS;
    // All shares come from one estimate, so that they add up.
    let within = with.errors[MOMENTS + 2] < plain.errors[MOMENTS + 2];
    let each = pick(&|i| if shares(i) { within } else { with.errors[i] < plain.errors[i] });
    let [.., skewness, kurtosis] = [each.values[0], each.values[1], each.values[2], each.values[3]];
    if kurtosis >= skewness * skewness + 1.0 && each.values[1] > 0.0 {
        return each;
    }
    let sigma = with.errors[1] < plain.errors[1];
    pick(&|i| if shares(i) { within } else { sigma })
}

/// Returns `rows` points of every scrambling from `first` on, one scrambling after the other.
fn points(draws: &Draws<'_>, first: usize, rows: usize) -> Points {
    let portion = |replicate: usize| draws.points(Portion { replicate: replicate as u64, first: first as u64, rows });
    let each: Vec<Points> = (0..REPLICATES).map(portion).collect();
    let dimensions = each[0].dimensions();
    Points::written(REPLICATES * rows, dimensions, |d, column| {
        column.chunks_mut(rows).zip(&each).for_each(|(own, points)| own.copy_from_slice(points.column(d)));
    })
}

fn histogram(values: &[f64]) -> Option<Histogram> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    let [least, greatest] = [*sorted.first()?, *sorted.last()?];
    let scale = Scale::about(at(0.5), at(0.75) - at(0.25));
    let mut fine = Fine::new(scale);
    fine.count(&scale.bins(values));
    let (edges, counts) = fine.histogram([least, greatest], [at(0.001), at(0.999)], BINS);
    Some(Histogram { edges, counts })
}
