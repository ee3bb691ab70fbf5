//! Compensators: inputs that are chosen from a stock after the parts are made.
//!
//! ```text
//! chosen(x) = value v of the stock with the least |to(x with v) - target|
//! y(x)      = y(x with chosen(x) + deviation of the chosen part from its label)
//! ```
//!
//! Several choices are made one after the other. Each one is made with the values chosen before it, and with the nominal values of those
//! chosen after it. Of two values at the same distance from the target the one found first is taken, by ascending value.

mod search;

use std::sync::Arc;

use crate::assembly::adjusted::search::Choice;
use crate::assembly::evaluator_account::EvaluatorAccount;
use crate::assembly::formula::Interval;
use crate::assembly::{
    AssemblyFunction, Bounds, Derivatives, Directions, EvaluationError, ModelInfo, Points, Polynomial, Request,
    Responses, Run, Signature, Switch, SwitchKind, Switches,
};
use crate::warning::Warning;

/// Form of an output as a function of the adjusted input. It decides how many values of the stock are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StockResponse {
    /// Unknown form: every value of the stock is tried. A formula that is linear in the input is tried at two.
    #[default]
    Any,
    /// Monotone: the values are bisected.
    Monotone,
    /// Linear: the first and the last value are tried, and the chosen one. A point whose answer there is off their line has no value.
    Linear,
}

impl StockResponse {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::Any, Self::Monotone, Self::Linear];

    /// Name in studies.
    pub fn name(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Monotone => "monotone",
            Self::Linear => "linear",
        }
    }
}

/// Input that is chosen from a stock, so that an output is nearest its target.
#[derive(Debug, Clone, PartialEq)]
pub struct Adjustment {
    /// Index of the adjusted input.
    pub input: usize,
    /// Nominal value of the input. The difference of a point's value from it is the deviation of the chosen part from its label.
    pub nominal: f64,
    /// Values in stock, ascending, at least one.
    pub stock: Vec<f64>,
    /// Index of the output that is measured.
    pub to: usize,
    /// Value that this output should have.
    pub target: f64,
    /// Form of this output as a function of the input.
    pub response: StockResponse,
}

impl Adjustment {
    /// Greatest number of evaluations of the measured output for one choice. Cost: 3 of a linear output, the third of which tests that it is
    /// linear, and `2 + log2` of a monotone one.
    ///
    /// ```
    /// use sensitol::assembly::{Adjustment, StockResponse};
    /// let stock: Vec<f64> = (0..33).map(f64::from).collect();
    /// let shim = Adjustment { input: 0, nominal: 5.0, stock, to: 0, target: 0.1, response: StockResponse::Any };
    /// assert_eq!(shim.evaluations(), 33);
    /// assert_eq!(Adjustment { response: StockResponse::Monotone, ..shim.clone() }.evaluations(), 7);
    /// assert_eq!(Adjustment { response: StockResponse::Linear, ..shim }.evaluations(), 3);
    /// ```
    pub fn evaluations(&self) -> usize {
        let count = self.stock.len();
        match self.response {
            StockResponse::Linear => count.min(3),
            StockResponse::Monotone if count > 2 => 2 + (count - 1).next_power_of_two().ilog2() as usize,
            StockResponse::Any | StockResponse::Monotone => count,
        }
    }
}

/// Function with adjusted inputs.
pub(crate) struct Adjusted {
    signature: Signature,
    function: Arc<dyn AssemblyFunction>,
    adjustments: Vec<Adjustment>,
    /// True for each adjustment whose output is proven to be linear in the input.
    proven: Vec<bool>,
    /// True for each output that depends on a choice.
    chosen: Vec<bool>,
}

/// Points with the chosen values, and the choices by adjustment and row.
struct Chosen {
    points: Points,
    choices: Vec<Vec<Choice>>,
    /// Evaluations of a costly function for the choices.
    spent: i64,
    reused: usize,
}

impl Adjusted {
    pub(crate) fn new(function: Arc<dyn AssemblyFunction>, mut adjustments: Vec<Adjustment>) -> Self {
        let inner = function.signature();
        let mut proven = Vec::with_capacity(adjustments.len());
        for one in &mut adjustments {
            let only: Vec<bool> = (0..inner.inputs.len()).map(|input| input == one.input).collect();
            let linear = function.degree(one.to, &only).is_some_and(|degree| degree <= 1);
            if linear {
                one.response = StockResponse::Linear;
            }
            proven.push(linear);
        }
        let mut signature = inner.clone();
        let depends = |output: usize, input: usize| {
            inner.outputs[output].depends_on.as_ref().is_none_or(|all| all.contains(&input))
        };
        let chosen: Vec<bool> =
            (0..inner.outputs.len()).map(|output| adjustments.iter().any(|one| depends(output, one.input))).collect();
        for output in (0..chosen.len()).filter(|&output| chosen[output]) {
            for one in &adjustments {
                let more = inner.outputs[one.to].depends_on.clone();
                let own = signature.outputs[output].depends_on.take();
                signature.outputs[output].depends_on = own.zip(more).map(|(own, more)| {
                    let mut all = [own, more].concat();
                    all.sort_unstable();
                    all.dedup();
                    all
                });
            }
        }
        Self { signature, function, adjustments, proven, chosen }
    }

    /// Chooses a value of every adjusted input at each point. Returns None if the run was stopped before.
    fn choose(&self, points: &Points, run: &Run<'_>) -> Option<Chosen> {
        let mut at = points.clone();
        for one in &self.adjustments {
            at.column_mut(one.input).fill(one.nominal);
        }
        let mut found = Chosen { points: at, choices: Vec::new(), spent: 0, reused: 0 };
        for (one, &proven) in self.adjustments.iter().zip(&self.proven) {
            let choices = search::choices(&*self.function, one, proven, &mut found, run)?;
            for (value, choice) in found.points.column_mut(one.input).iter_mut().zip(&choices) {
                *value = choice.place().map_or(one.nominal, |place| one.stock[place]);
            }
            found.choices.push(choices);
        }
        for one in &self.adjustments {
            let deviations = points.column(one.input).iter().map(|x| x - one.nominal);
            found.points.column_mut(one.input).iter_mut().zip(deviations).for_each(|(value, off)| *value += off);
        }
        Some(found)
    }

    fn any_chosen(&self, outputs: &[usize]) -> bool {
        outputs.iter().any(|&output| self.chosen[output])
    }

    fn choice_of(&self, one: &Adjustment) -> String {
        // A closure does not name its inputs.
        match self.signature.inputs.get(one.input) {
            Some(input) => format!("the choice of `{}`", input.name),
            None => format!("the choice of input {}", one.input + 1),
        }
    }

    /// Places of the stock that can be chosen within a region, and the greatest distance from the target that a choice leaves.
    fn possible(&self, one: &Adjustment, region: &[[f64; 2]]) -> Option<(Vec<usize>, f64)> {
        /// Share by which a distance is widened for the rounding of a choice.
        const ROUNDED: f64 = 1.0 + 1e-9;
        let mut region = region.to_vec();
        let mut distances = Vec::with_capacity(one.stock.len());
        for &value in &one.stock {
            region[one.input] = [value; 2];
            let bounds = self.function.bounds(one.to, &region)?.value;
            let [low, high] = [bounds.lower() - one.target, bounds.upper() - one.target];
            distances.push(if bounds.is_empty() {
                [f64::INFINITY; 2]
            } else {
                [low.max(-high).max(0.0), low.abs().max(high.abs())]
            });
        }
        let most = distances.iter().map(|[_, most]| *most).fold(f64::INFINITY, f64::min) * ROUNDED;
        Some(((0..distances.len()).filter(|&place| distances[place][0] <= most).collect(), most))
    }

    /// Bounds of an output that depends on a choice: those over the values that can be chosen in the region.
    fn chosen_bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let mut at = region.to_vec();
        self.adjustments.iter().for_each(|one| at[one.input] = [one.nominal; 2]);
        let outputs = &self.function.signature().outputs;
        let depends =
            |output: usize, input: usize| outputs[output].depends_on.as_ref().is_none_or(|all| all.contains(&input));
        let (mut single, mut left) = (true, None);
        for one in &self.adjustments {
            let (places, most) = self.possible(one, &at)?;
            let ends = places.first().zip(places.last());
            let (&first, &last) = ends?;
            single &= first == last;
            at[one.input] = [one.stock[first], one.stock[last]];
            if one.to == output {
                left = Some(Interval::between(one.target - most, one.target + most));
            } else if depends(output, one.input) {
                // A later choice moves the output away again.
                left = None;
            }
        }
        let fixed = self.adjustments.iter().all(|one| region[one.input] == [one.nominal; 2]);
        for one in &self.adjustments {
            let [low, high] = region[one.input].map(|end| end - one.nominal);
            let [first, last] = at[one.input];
            at[one.input] = if low == 0.0 && high == 0.0 {
                [first, last]
            } else {
                [(first + low).next_down(), (last + high).next_up()]
            };
        }
        let mut bounds = self.function.bounds(output, &at)?;
        if let Some(left) = left.filter(|_| fixed && !single) {
            bounds.value = bounds.value.within(left.lower(), left.upper());
        }
        if !single {
            bounds.value = bounds.value.broken();
        }
        Some(bounds)
    }
}

impl AssemblyFunction for Adjusted {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let mut all = outputs.to_vec();
        all.extend(self.adjustments.iter().map(|one| one.to));
        let info = self.function.prepare(&all)?;
        // The slopes of a model ignore the choice.
        Ok(info.map(|info| ModelInfo { gradients: info.gradients && !self.any_chosen(outputs), ..info }))
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        if self.chosen[output] { self.chosen_bounds(output, region) } else { self.function.bounds(output, region) }
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        self.function.magnitudes(outputs, point)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        if !self.any_chosen(request.outputs) {
            return self.function.evaluate(request, run, out);
        }
        let Some(found) = self.choose(request.points, &run.apart()) else { return };
        self.function.evaluate(&Request::values(&found.points, request.outputs), &run.quiet(), out);
        for row in 0..request.points.rows() {
            let failed = found.choices.iter().find_map(|choices| choices[row].failure());
            let Some(error) = failed else { continue };
            for column in (0..request.outputs.len()).filter(|&column| self.chosen[request.outputs[column]]) {
                out.fail(row, column, error.clone());
            }
        }
        if self.signature.costly {
            out.spent(found.spent);
            out.reused(found.reused);
        }
        let rows: Vec<usize> = out.answered().collect();
        run.finished(&rows, out);
    }

    /// Returns none for an output that depends on a choice: its slope between two choices does not hold over the whole band.
    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        let found = self.function.derivatives(outputs, directions).into_iter().zip(outputs);
        found.map(|(found, &output)| found.filter(|_| !self.chosen[output])).collect()
    }

    fn switches(&self, output: usize) -> Option<Switches> {
        let mut switches = self.function.switches(output)?;
        if self.chosen[output] {
            switches.list.extend(self.adjustments.iter().map(|one| Switch {
                kind: SwitchKind::Choice,
                text: self.choice_of(one),
                formula: None,
                span: 0..0,
            }));
        }
        Some(switches)
    }

    fn choice(&self, output: usize) -> Option<String> {
        self.adjustments.first().filter(|_| self.chosen[output]).map(|one| self.choice_of(one))
    }

    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        if !self.chosen[output] {
            return self.function.margins(output, points);
        }
        if self.signature.costly {
            return None;
        }
        let found = self.choose(points, &Run::to_the_end())?;
        let mut margins = self.function.margins(output, &found.points)?;
        margins.extend(found.choices.iter().map(|choices| choices.iter().map(Choice::margin).collect()));
        Some(margins)
    }

    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        if self.chosen[output] { None } else { self.function.degree(output, varying) }
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        if self.chosen[output] { None } else { self.function.polynomial(output, centre, scale) }
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        self.function.account()
    }

    fn own_checks(&self, answers: usize) -> usize {
        self.function.own_checks(answers)
    }

    fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
        let own = self.function.evaluations_per_point(outputs);
        if !self.any_chosen(outputs) {
            return own;
        }
        let choice = |(one, &proven): (&Adjustment, &bool)| {
            let values = if proven { one.stock.len().min(2) } else { one.evaluations() };
            values * self.function.evaluations_per_point(&[one.to])
        };
        own + self.adjustments.iter().zip(&self.proven).map(choice).sum::<usize>()
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        self.function.warnings(outputs)
    }
}
