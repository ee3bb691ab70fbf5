//! Verification of a costly model: its surfaces at check points near the means, and where decisions fall.

use crate::assembly::{EvaluationError, Responses};
use crate::estimate::strata::{dot, length};
use crate::estimate::{Columns, NormalSpace};
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use crate::verification::Verified;
use crate::verification::check_points::{Design, FEWEST, MOST, Wish};
use crate::verification::check_ray::{CheckRay, rays, to_locate};
use crate::verification::checked_surface::CheckedSurface;
use crate::verification::decision_points;
use crate::verification::far_effect::FarEffect;
use crate::verification::far_residual::FarResidual;
use crate::verification::likeliest_point::likeliest;
use crate::verification::plan_nodes::{NodesOnRays, PlanNode};
use crate::verification::refuted_limit;
use crate::verification::residual_error::{Judged, judge, regression};
use crate::verification::unseen_share::unseen;
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Check points near the means, if none are requested by number.
const NEAR: usize = 12;

/// Number of check points for a number of varying dimensions, `asked` if they are requested by number.
///
/// Without a number these are 12 near the means, and a third as many as those and the `2 N + 1` points of a second-order method where
/// decisions fall, at least 6 and at most 18. [`verify_by_checks`] evaluates up to 8 more if the surface is refuted.
///
/// ```
/// use sensitol::verification::check_points;
/// assert_eq!(check_points(None, 3), 12 + 6);
/// assert_eq!(check_points(None, 10), 12 + 11);
/// assert_eq!(check_points(Some(12), 10), 12);
/// assert_eq!(check_points(Some(5), 10), 0); // too few for an error
/// assert_eq!(check_points(Some(100), 10), 18 + 11);
/// ```
pub fn check_points(asked: Option<usize>, varying: usize) -> usize {
    let decisions = decision_points::count(varying);
    match asked {
        None => NEAR + decisions,
        Some(asked) if asked < FEWEST => 0,
        Some(asked) => asked.min(MOST + decisions),
    }
}

/// A characteristic whose surface is verified.
#[derive(Debug, Clone, Copy)]
pub struct Target<'s> {
    /// Surface over the varying dimensions. None if the method has none.
    pub surrogate: Option<&'s Surrogate>,
    /// Share of the variance of every varying dimension, straight line and curvature.
    pub shares: &'s [f64],
    /// Points of the method's plan, if some of them have no value: those without one, and those of a single input.
    pub nodes: &'s [PlanNode],
}

/// Figures of one characteristic from the check points.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CheckedFigures {
    /// Errors of mean, sigma, skewness and kurtosis. None if the model has a value at hardly any point, or no surface is known.
    pub errors: Option<[f64; 4]>,
    /// Share within the limits by the surface, and its error. Also None if there are no limits.
    pub yield_: Option<Verified>,
    /// Shares beyond the lower and beyond the upper limit.
    pub beyond: [Option<Verified>; 2],
    /// Share of the variance that the surface leaves unexplained.
    pub left: Option<f64>,
    /// Error of the share of the variance of every varying dimension.
    pub shares: Option<Vec<f64>>,
    /// Points at which the model has no value.
    pub failed: usize,
    /// Greatest share of the assemblies without a value, by the places of the points without one. 0 if all points have a value.
    pub lost: f64,
    /// Largest residual far from the means that changes the figures. None if there is none.
    pub far: Option<FarResidual>,
    /// Points in normal space that are probably rejected, if a sudden residual refutes the surface at a limit. None if none does.
    pub(crate) refuted: Option<Vec<Vec<f64>>>,
    /// Mean, sigma, skewness and kurtosis of the surface over the integration points.
    pub surface: Option<[f64; 4]>,
}

/// Results of the check points.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// Figures of every characteristic.
    pub characteristics: Vec<CheckedFigures>,
    /// Number of check points.
    pub count: usize,
    /// True for every characteristic of which a check point has no answer.
    pub unanswered: Vec<bool>,
}

impl Checked {
    /// Greatest share of the assemblies that may behave differently if all points agree, at 95 % confidence: `1 - 0.05^(1/n)`.
    pub fn unseen(&self) -> f64 {
        unseen(self.count, 0)[1]
    }
}

/// Judges the surfaces of all characteristics by the model's values at check points: near the means, and where decisions fall.
///
/// Shapes: a target for every characteristic; surrogate and shares over the dimensions at `varying`. Evaluations: `most` within the
/// evaluator's budget, and up to [`MOST_LOCATING`](crate::verification::MOST_LOCATING) more if the budget has them and the surface is
/// refuted. Returns None, without an evaluation, if fewer than 6 are allowed or no characteristic has a surface.
///
/// Accuracy: three estimates reach the true error of at least 97 % of the figures (`tests/accuracy`).
pub fn verify_by_checks(
    evaluator: &Evaluator<'_>,
    varying: &[usize],
    targets: &[Target<'_>],
    most: usize,
) -> Option<Checked> {
    if varying.is_empty() {
        return None;
    }
    let (problem, seed) = (evaluator.problem(), evaluator.seed());
    let space = NormalSpace::new(problem, varying);
    let normals = Normals::new(varying.len(), seed);
    // The surface at many points gives the direction of its line and the figures that residuals change.
    let surfaces: Vec<Option<CheckedSurface<'_>>> =
        targets.iter().map(|target| CheckedSurface::new(&space, &normals, target.surrogate?)).collect();
    let wishes = wishes(problem, varying, targets, &surfaces);
    let known: Vec<Wish> = wishes.iter().flatten().cloned().collect();
    let most = check_points(Some(evaluator.remaining().map_or(most, |left| left.min(most))), varying.len());
    let decisions = decision_points::count(varying.len()).min(most.saturating_sub(NEAR));
    let design = Design::new(&known, seed, most - decisions)?;
    let likeliest = likeliest_points(problem, &surfaces, &wishes);
    let decisions = decision_points::choose(&design, &known, &likeliest, decisions, seed);
    let mut rays = rays(&design, &decisions);
    let mut answers = Answers::new(&space, &surfaces);
    answers.ask(evaluator, design.points.iter().chain(&decisions).cloned().collect());
    // A large residual is located, so that its share of the assemblies is known.
    let located = to_locate(&rays, &answers.residuals, design.random()..design.points.len());
    for index in located {
        let enough = evaluator.remaining().is_none_or(|left| left >= CheckRay::LOCATING);
        if enough && !evaluator.run().stopped() {
            let mut located = rays[index].clone();
            let points = located.locate(answers.count);
            // Points that were not answered before the end of the run change nothing.
            if answers.ask_whole(evaluator, points) {
                rays[index] = located;
            }
        }
    }
    // Points of the plan without a value bound the share of the assemblies without one, as check points do.
    let plans: Vec<&[PlanNode]> = targets.iter().map(|target| target.nodes).collect();
    let nodes = NodesOnRays::add(&space, &plans, &mut rays, answers.count);
    let figures = |c: usize| {
        let d = &answers.residuals[c];
        let with_nodes = [d.as_slice(), &nodes.residuals[c]].concat();
        let nothing = CheckedFigures { failed: d.iter().filter(|d| d.is_nan()).count(), ..CheckedFigures::nothing() };
        let (Some(surface), Some(wish)) = (&surfaces[c], &wishes[c]) else { return nothing };
        // Ends of the kept limits, so that rounding does not reject a value on a limit.
        let [low, high] = problem.kept_limits(c).ends();
        let within = [[low, high], [low, f64::INFINITY], [f64::NEG_INFINITY, high]];
        let effect = |ray| FarEffect::new(surface, &normals, ray, ray.profile(&with_nodes), &within);
        let far: Vec<FarEffect<'_>> = rays.iter().filter_map(effect).collect();
        let judged = judge(&design, wish, surface, d, &answers.surfaces[c], &far, &within);
        let of_shares = |judged: &Judged| {
            let error = |share: &f64| judged.share_of_variance(*share, design.pairs);
            targets[c].shares.iter().map(error).collect::<Vec<f64>>()
        };
        let shares = judged.as_ref().map(of_shares);
        let lost = lost(&design, d, &far, &nodes.beside[c]);
        let kept = within.map(|interval| surface.share(interval));
        let random = design.random()..design.points.len();
        let refuting: Vec<&FarEffect<'_>> =
            far.iter().filter(|of| of.ray.refutes(&with_nodes, random.clone())).collect();
        let refuted = refuted_limit::refuted(surface, &wish.line, &refuting, &kept, [low, high]);
        let far = FarResidual::largest(surface, &far, &kept, varying);
        let figures = nothing.judged(surface, judged, within);
        CheckedFigures { surface: Some(surface.figures), shares, far, lost, refuted, ..figures }
    };
    let characteristics = (0..targets.len()).map(figures).collect();
    Some(Checked { characteristics, count: answers.count, unanswered: answers.unanswered })
}

/// Requests of all characteristics for check points. None for a characteristic without a surface that varies.
fn wishes(
    problem: &Problem,
    varying: &[usize],
    targets: &[Target<'_>],
    surfaces: &[Option<CheckedSurface<'_>>],
) -> Vec<Option<Wish>> {
    let dependence = problem.dependence();
    let mut wishes = Vec::new();
    for ((surface, target), depends) in surfaces.iter().zip(targets).zip(&dependence) {
        let varies = surface.as_ref().filter(|surface| surface.figures[1] > 0.0);
        wishes.push(varies.map(|surface| Wish {
            line: regression(surface),
            shares: target.shares.to_vec(),
            depends: varying.iter().map(|&d| depends[d]).collect(),
        }));
    }
    wishes
}

/// Likeliest points of all surfaces beyond all limits, the nearest first.
fn likeliest_points(
    problem: &Problem,
    surfaces: &[Option<CheckedSurface<'_>>],
    wishes: &[Option<Wish>],
) -> Vec<Vec<f64>> {
    let mut points = Vec::new();
    for (c, (surface, wish)) in surfaces.iter().zip(wishes).enumerate() {
        let (Some(surface), Some(wish)) = (surface, wish) else { continue };
        let [low, high] = problem.kept_limits(c).ends();
        points.extend(likeliest(surface, &wish.line, low, false));
        points.extend(likeliest(surface, &wish.line, high, true));
    }
    points.sort_by(|a, b| length(a).total_cmp(&length(b)));
    points
}

/// Greatest share of the assemblies without a value.
///
/// A point without one along a single input stands for its half-space. Any other such point outside of these half-spaces belongs to a region
/// of an unknown shape. The random points bound its share then, with the upper end of their 95 % interval. `beside` are points of the plan that
/// several inputs deviate at.
fn lost(design: &Design, d: &[f64], far: &[FarEffect<'_>], beside: &[Vec<f64>]) -> f64 {
    let failing = far.iter().filter(|effect| effect.profile.is_without_value());
    let (alone, several): (Vec<_>, Vec<_>) = failing.partition(|effect| effect.ray.is_of_one_input());
    let holds = |effect: &&FarEffect<'_>, point: &[f64]| dot(&effect.ray.direction, point) > effect.profile.from();
    let explained = |point: &[f64]| alone.iter().any(|effect| holds(effect, point));
    let random = design.random()..design.points.len();
    let open = random.clone().filter(|&row| d[row].is_nan() && !explained(&design.points[row])).count();
    let unknown =
        several.iter().map(|effect| effect.ray.end()).chain(beside.iter().cloned()).any(|end| !explained(&end));
    let counted = if open > 0 || unknown { unseen(random.len(), open)[1] } else { 0.0 };
    (alone.iter().map(|effect| effect.lost).sum::<f64>() + counted).min(1.0)
}

/// Answers to check points, and the surfaces there.
struct Answers<'s> {
    space: &'s NormalSpace<'s>,
    of: &'s [Option<CheckedSurface<'s>>],
    /// Number of points.
    count: usize,
    /// Residuals in sigmas of every characteristic, NaN without a value.
    residuals: Vec<Vec<f64>>,
    /// Values of the surface of every characteristic.
    surfaces: Vec<Vec<f64>>,
    /// True for every characteristic of which a point has no answer.
    unanswered: Vec<bool>,
}

impl<'s> Answers<'s> {
    fn new(space: &'s NormalSpace<'s>, of: &'s [Option<CheckedSurface<'s>>]) -> Self {
        let (residuals, surfaces) = (vec![Vec::new(); of.len()], vec![Vec::new(); of.len()]);
        Self { space, of, count: 0, residuals, surfaces, unanswered: vec![false; of.len()] }
    }

    /// Evaluates the model at further points. Returns false, and keeps none of them, if some were not answered.
    fn ask_whole(&mut self, evaluator: &Evaluator<'_>, points: Vec<Vec<f64>>) -> bool {
        let (count, unanswered) = (self.count, self.unanswered.clone());
        self.ask(evaluator, points);
        if self.unanswered == unanswered {
            return true;
        }
        self.unanswered = unanswered;
        self.count = count;
        self.residuals.iter_mut().chain(&mut self.surfaces).for_each(|column| column.truncate(count));
        false
    }

    /// Evaluates the model at further points.
    fn ask(&mut self, evaluator: &Evaluator<'_>, points: Vec<Vec<f64>>) {
        let columns: Columns = (0..self.space.len()).map(|j| points.iter().map(|point| point[j]).collect()).collect();
        let answers = evaluator.ask(&self.space.points(&columns));
        self.count += points.len();
        for c in 0..self.of.len() {
            self.unanswered[c] |= has_no_answer(&answers, c);
            let model = answers.column(c);
            // Without a surface there is no residual: only points without a value are told apart.
            let at = self.of[c].as_ref().and_then(|surface| surface.at(&columns)).unwrap_or_else(|| model.to_vec());
            let sigma =
                self.of[c].as_ref().map(|surface| surface.figures[1]).filter(|sigma| *sigma > 0.0).unwrap_or(1.0);
            self.residuals[c].extend(model.iter().zip(&at).map(|(y, q)| (y - q) / sigma));
            self.surfaces[c].extend(at);
        }
    }
}

/// True if a characteristic has a point that was not answered. Points without an answer give no information.
fn has_no_answer(answers: &Responses, c: usize) -> bool {
    let given = |row: usize| !matches!(answers.error(row, c), Some(EvaluationError::NotGiven));
    (0..answers.rows()).any(|row| !given(row) || answers.is_open(row, c))
}

impl CheckedFigures {
    fn nothing() -> Self {
        Self {
            errors: None,
            yield_: None,
            beyond: [None; 2],
            left: None,
            shares: None,
            failed: 0,
            lost: 0.0,
            far: None,
            refuted: None,
            surface: None,
        }
    }

    fn judged(self, surface: &CheckedSurface<'_>, judged: Option<Judged>, within: [[f64; 2]; 3]) -> Self {
        let Some(judged) = judged else { return self };
        let share = |index: usize| {
            let error = judged.shares[index];
            let finite = within[index].iter().any(|end| end.is_finite());
            finite.then(|| Verified { value: surface.share(within[index]), error })
        };
        let rejected =
            |within: Option<Verified>| within.map(|share| Verified { value: 1.0 - share.value, error: share.error });
        Self {
            errors: Some(judged.errors),
            yield_: share(0),
            beyond: [rejected(share(1)), rejected(share(2))],
            left: Some(judged.left),
            ..self
        }
    }
}
