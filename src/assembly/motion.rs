//! Least and greatest values of an output over the range of an input, as outputs of their own.
//!
//! ```text
//! y(x) = min f(x, t) over from <= t <= to
//! ```
//!
//! The range is scanned at equal steps. Brent's search refines the two lowest places, without derivatives. An extreme narrower than a
//! step can be missed.
//!
//! Derivatives of a formula are exact: the slopes by the envelope theorem, the second derivatives with the move of the extreme.
//!
//! ```text
//! dy/dx_i         = f_i
//! d2y/dx_i dx_j   = f_ij - f_it f_jt / f_tt    at an extreme within the range
//! d2y/dx_i dx_j   = f_ij                       at an end of the range
//! ```
//!
//! Source: R. P. Brent, Algorithms for Minimization Without Derivatives (1973), chapter 5; P. Milgrom, I. Segal, Econometrica 70 (2002) 583.

mod brent;
mod scan;

use std::sync::Arc;

use crate::assembly::evaluator_account::EvaluatorAccount;
use crate::assembly::formula::Interval;
use crate::assembly::{
    AssemblyFunction, Bounds, Derivatives, Directions, EvaluationError, ModelInfo, Output, Points, Polynomial, Request,
    Responses, Run, Signature, Switches,
};
use crate::warning::Warning;

/// End of the values over a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionEnd {
    /// The least value.
    Minimum,
    /// The greatest value.
    Maximum,
}

/// Extreme of an output over the range of an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Name of the extreme as an output.
    pub name: String,
    /// Index of the output whose extreme it is.
    pub of: usize,
    /// Index of the input that moves.
    pub over: usize,
    /// Range of this input.
    pub range: [f64; 2],
    /// Least or greatest value.
    pub end: MotionEnd,
    /// Number of equal steps of the scan.
    pub steps: usize,
}

impl Motion {
    /// Steps of the scan unless others are requested: a sine over a whole turn is followed to 0.1 % between them, before the refinement.
    pub const STEPS: usize = 64;
    /// Evaluations of one refinement that a costly function gets at most.
    const COSTLY: usize = 8;
    /// Evaluations of one refinement that a cheap function gets at most: a kink takes 40.
    const CHEAP: usize = 60;

    /// Factor by which values are multiplied, so that the least one is searched.
    fn sign(&self) -> f64 {
        match self.end {
            MotionEnd::Minimum => 1.0,
            MotionEnd::Maximum => -1.0,
        }
    }

    fn place(&self, step: usize) -> f64 {
        let [from, to] = self.range;
        if step == self.steps { to } else { from + (to - from) * (step as f64 / self.steps as f64) }
    }
}

/// Outputs of a function, followed by extremes of them over motions.
pub struct MotionExtremes {
    signature: Signature,
    function: Arc<dyn AssemblyFunction>,
    /// Number of outputs of the function itself.
    own: usize,
    motions: Vec<Motion>,
}

impl MotionExtremes {
    /// Adds extremes to the outputs of a function. They have the units of the outputs that they are made of.
    ///
    /// # Cost
    /// `steps + 1` evaluations for each extreme and point, and the refinement: about 20 of a cheap function, at most 16 of a costly one.
    ///
    /// # Example
    /// The least of `a cos t + b sin t` over a turn is `-sqrt(a^2 + b^2)`.
    ///
    /// ```
    /// use sensitol::assembly::{AssemblyFunction, Closure, Motion, MotionEnd, MotionExtremes, Points, Request, Responses, Run};
    /// let wave = Closure::scalar("wave", |x| x[0] * x[2].cos() + x[1] * x[2].sin());
    /// let range = [0.0, std::f64::consts::TAU];
    /// let least = Motion { name: "least".into(), of: 0, over: 2, range, end: MotionEnd::Minimum, steps: Motion::STEPS };
    /// let function = MotionExtremes::new(std::sync::Arc::new(wave), vec![least]);
    /// let mut out = Responses::open(1, 1);
    /// let points = Points::from_rows(&[[3.0, 4.0, 0.0]]);
    /// function.evaluate(&Request::values(&points, &[1]), &Run::to_the_end(), &mut out);
    /// assert!((out.value(0, 0).unwrap() + 5.0).abs() < 1e-14);
    /// ```
    pub fn new(function: Arc<dyn AssemblyFunction>, motions: Vec<Motion>) -> Self {
        let mut signature = function.signature().clone();
        let own = signature.outputs.len();
        for motion in &motions {
            let of = &signature.outputs[motion.of];
            let depends_on =
                of.depends_on.as_ref().map(|all| all.iter().copied().filter(|&d| d != motion.over).collect());
            let output = Output { name: motion.name.clone(), unit: of.unit.clone(), depends_on };
            signature.outputs.push(output);
        }
        Self { signature, function, own, motions }
    }

    fn motion(&self, output: usize) -> Option<&Motion> {
        output.checked_sub(self.own).map(|index| &self.motions[index])
    }

    /// Outputs of the function that these outputs need.
    fn needed(&self, outputs: &[usize]) -> Vec<usize> {
        let mut all: Vec<usize> =
            outputs.iter().map(|&output| self.motion(output).map_or(output, |motion| motion.of)).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Splits outputs into places with outputs of the function, and places with extremes.
    fn split(&self, outputs: &[usize]) -> (Vec<usize>, Vec<usize>) {
        (0..outputs.len()).partition(|&place| outputs[place] < self.own)
    }

    fn refined(&self) -> usize {
        if self.signature.costly { Motion::COSTLY } else { Motion::CHEAP }
    }

    /// Derivatives of an extreme at a point. Returns None if two places are equally extreme, or if the function has none.
    fn of_extreme(&self, motion: &Motion, directions: &Directions<'_>) -> Option<Derivatives> {
        let points = Points::from_rows(&[directions.point]);
        let found = scan::extremes(&*self.function, motion, self.refined(), &points, &Run::to_the_end());
        let at = found.places[0].filter(|place| place.alone)?.at;
        let t = motion.over;
        let mut inputs: Vec<usize> = directions.inputs.to_vec();
        let mut pairs: Vec<(usize, usize)> = directions.pairs.to_vec();
        for &(i, j) in directions.pairs {
            inputs.extend([i, j]);
        }
        inputs.retain(|&input| input != t);
        inputs.sort_unstable();
        inputs.dedup();
        pairs.retain(|&(i, j)| i != t && j != t);
        let own_pairs = pairs.len();
        let moved = inputs.len();
        pairs.extend(inputs.iter().map(|&input| (input, t)));
        inputs.push(t);
        let mut point = directions.point.to_vec();
        point[t] = at;
        let mut ask = |at: f64| {
            point[t] = at;
            let there = Directions { point: &point, inputs: &inputs, pairs: &pairs };
            self.function.derivatives(&[motion.of], &there).pop()?
        };
        let mut all = ask(at)?;
        let [from, to] = motion.range;
        // A place within the range is polished by one step of Newton.
        let within = from < at && at < to;
        if within {
            let step = all.first[moved]? / all.second[moved]?;
            if step.is_finite() && step.abs() < 1e-3 * (to - from) / motion.steps as f64 {
                all = ask((at - step).clamp(from, to))?;
            }
        }
        let curvature = motion.sign() * all.second[moved]?;
        // At an end where the slope is 0 the extreme may leave the end with the inputs: a second derivative is one-sided there.
        let flat = !within && all.first[moved]?.abs() * (to - from) <= 1e-6 * curvature.abs() * (to - from).powi(2);
        let place = |input: usize| inputs[..moved].iter().position(|&one| one == input);
        let cross = |input: usize| all.mixed[own_pairs + place(input)?];
        let moves = |i: usize, j: usize| -> Option<f64> {
            match within {
                true if curvature > 0.0 => Some(cross(i)? * cross(j)? / all.second[moved]?),
                false if !flat => Some(0.0),
                _ => None,
            }
        };
        let first = |&input: &usize| if input == t { Some(0.0) } else { all.first[place(input)?] };
        let second = |&i: &usize| if i == t { Some(0.0) } else { Some(all.second[place(i)?]? - moves(i, i)?) };
        let mixed = |&(i, j): &(usize, usize)| {
            if i == t || j == t {
                return Some(0.0);
            }
            let index = pairs[..own_pairs].iter().position(|&pair| pair == (i, j))?;
            Some(all.mixed[index]? - moves(i, j)?)
        };
        Some(Derivatives {
            first: directions.inputs.iter().map(first).collect(),
            second: directions.inputs.iter().map(second).collect(),
            mixed: directions.pairs.iter().map(mixed).collect(),
        })
    }

    /// Bounds of an extreme: over every step of the range for one end, at the steps for the other.
    fn bounds_of(&self, motion: &Motion, region: &[[f64; 2]]) -> Option<Bounds> {
        let mut at = region.to_vec();
        let mut of = |ends: [f64; 2]| {
            at[motion.over] = ends;
            let bounds = self.function.bounds(motion.of, &at)?;
            Some(if motion.sign() < 0.0 { bounds.negated() } else { bounds })
        };
        let mut most = f64::INFINITY;
        let mut parts = Vec::with_capacity(motion.steps);
        for step in 0..motion.steps {
            let there = of([motion.place(step); 2])?.value;
            most = if there.is_whole() { most.min(there.upper()) } else { most };
            parts.push(of([motion.place(step), motion.place(step + 1)])?);
        }
        most = most.min(of([motion.place(motion.steps); 2])?.value.upper());
        let least = parts.iter().map(|part| part.value.lower()).fold(f64::INFINITY, f64::min);
        let whole = parts.iter().all(|part| part.value.is_whole());
        // The extreme lies in a step that can reach the least value.
        let holding = parts.into_iter().filter(|part| part.value.is_empty() || part.value.lower() <= most);
        let bounds = holding.reduce(|a, b| Bounds {
            value: a.value.hull(&b.value),
            slopes: a.slopes.iter().zip(&b.slopes).map(|(a, b)| a.hull(b)).collect(),
        })?;
        let value = Interval::between(least, most.min(bounds.value.upper()).max(least));
        let mut bounds = Bounds { value: if whole { value } else { value.broken() }, ..bounds };
        bounds.slopes[motion.over] = Interval::between(0.0, 0.0);
        Some(if motion.sign() < 0.0 { bounds.negated() } else { bounds })
    }
}

impl AssemblyFunction for MotionExtremes {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let info = self.function.prepare(&self.needed(outputs))?;
        let own = outputs.iter().all(|&output| output < self.own);
        Ok(info.map(|info| ModelInfo { gradients: info.gradients && own, ..info }))
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        match self.motion(output) {
            Some(motion) => self.bounds_of(motion, region),
            None => self.function.bounds(output, region),
        }
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let of: Vec<usize> =
            outputs.iter().map(|&output| self.motion(output).map_or(output, |motion| motion.of)).collect();
        self.function.magnitudes(&of, point)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let (plain, moved) = self.split(request.outputs);
        if moved.is_empty() {
            return self.function.evaluate(request, run, out);
        }
        let rows = request.points.rows();
        let quiet = run.quiet();
        if !plain.is_empty() {
            let own: Vec<usize> = plain.iter().map(|&place| request.outputs[place]).collect();
            let mut answers = Responses::open(rows, own.len());
            self.function.evaluate(&Request::values(request.points, &own), &quiet, &mut answers);
            for (column, &place) in plain.iter().enumerate() {
                (0..rows).for_each(|row| out.pass_on(row, place, &answers, row, column));
            }
            out.spent(answers.answered().count() as i64 + answers.extra() + answers.count_reused() as i64);
            out.reused(answers.count_reused());
        }
        for place in moved {
            let Some(motion) = self.motion(request.outputs[place]) else { continue };
            let found = scan::extremes(&*self.function, motion, self.refined(), request.points, &run.apart());
            for (row, (extreme, error)) in found.places.iter().zip(&found.errors).enumerate() {
                match (extreme, error) {
                    (Some(extreme), _) => out.set(row, place, motion.sign() * extreme.value),
                    (None, Some(error)) => out.fail(row, place, error.clone()),
                    (None, None) => {}
                }
            }
            out.spent(found.spent);
            out.reused(found.reused);
        }
        // A point of a cheap function counts as one evaluation.
        let answered = out.answered().count() as i64;
        let spent = if self.signature.costly { -answered } else { -out.extra() };
        out.spent(spent);
        let rows: Vec<usize> = out.answered().collect();
        run.finished(&rows, out);
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        let (plain, moved) = self.split(outputs);
        let mut all = vec![None; outputs.len()];
        let own: Vec<usize> = plain.iter().map(|&place| outputs[place]).collect();
        for (place, found) in plain.into_iter().zip(self.function.derivatives(&own, directions)) {
            all[place] = found;
        }
        if self.signature.cheap {
            for place in moved {
                all[place] = self.motion(outputs[place]).and_then(|motion| self.of_extreme(motion, directions));
            }
        }
        all
    }

    fn switches(&self, output: usize) -> Option<Switches> {
        self.motion(output).is_none().then(|| self.function.switches(output))?
    }

    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        self.motion(output).is_none().then(|| self.function.margins(output, points))?
    }

    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        self.motion(output).is_none().then(|| self.function.degree(output, varying))?
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        self.motion(output).is_none().then(|| self.function.polynomial(output, centre, scale))?
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        self.function.account()
    }

    fn own_checks(&self, answers: usize) -> usize {
        self.function.own_checks(answers)
    }

    fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
        let (plain, moved) = self.split(outputs);
        let own = if plain.is_empty() { 0 } else { self.function.evaluations_per_point(&self.needed(outputs)) };
        let of = |place: usize| {
            let motion = self.motion(outputs[place])?;
            Some((motion.steps + 1 + 2 * self.refined()) * self.function.evaluations_per_point(&[motion.of]))
        };
        (own + moved.into_iter().filter_map(of).sum::<usize>()).max(1)
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        self.function.warnings(&self.needed(outputs))
    }
}
