//! Data with which the page computes the results of other tolerances.

use serde::Serialize;

use sensitol::allocation::{Curve, CurveKind, Priced};
use sensitol::analysis::{Analysis, Branch, CharacteristicAnalysis, Fit, NoFit, YieldSource};
use sensitol::method::ErrorEstimate;
use sensitol::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::Rule;
use sensitol_numeric::law::TabulatedInput;
use sensitol_numeric::power::Power;
use sensitol_numeric::surrogate::{InputShape, shapes};

/// Entry of the study's `[dimensions]`: its name, and its keys with their values as TOML.
type Line = (String, Vec<(String, String)>);

/// Distributions whose tolerance the page can change: their shape is independent of it, and a study has it in one key.
const KINDS: [&str; 6] = ["normal", "truncated-normal", "uniform", "triangular", "trapezoidal", "beta"];
/// Greatest relative difference of equal standardised moments.
const SAME: f64 = 1e-9;

/// Dimensions, surrogates, limits and costs of the what-if.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WhatIf {
    shapes: Vec<Shape>,
    dimensions: Vec<Tried>,
    characteristics: Vec<Wanted>,
    lines: Vec<Line>,
    costs: Vec<Cost>,
    #[serde(skip)]
    paid: Option<f64>,
}

/// Cost of dimensions that share a process.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Cost {
    /// Indices of the members that the page lists.
    members: Vec<usize>,
    /// Half band of every listed member per unit of the tolerance. None if all are 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    shares: Option<Vec<f64>>,
    /// Tightest half-width of the other members. None if there are none.
    others: Option<f64>,
    parts: f64,
    offers: Vec<Offered>,
}

/// Cost curve `a + b T^-shape` or `a + b exp(-T/shape)`, or points `[T, cost]` joined by straight lines in `1/T`.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Offered {
    exponential: bool,
    a: f64,
    b: f64,
    shape: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Vec<[f64; 2]>>,
    min: f64,
    max: f64,
}

/// Skewness and excess kurtosis of a standardised input, and quadrature rules for its parts.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Shape {
    s: f64,
    k: f64,
    #[serde(flatten)]
    rule: Table,
    /// Rule for parabolas, exact for their fourth power. Left out if it is `rule`.
    #[serde(skip_serializing_if = "Option::is_none")]
    parabola: Option<Table>,
    /// Distribution of the input. None if only its moments are known, or if its table is too large for a page.
    law: Option<TabulatedInput>,
}

/// Nodes and weights of a quadrature rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Table {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

/// A dimension that varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Tried {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    shape: usize,
    pub(super) nominal: f64,
    /// Distance of the mean from nominal plus band middle.
    offset: f64,
    pub(super) sigma: f64,
    pub(super) band: Option<[f64; 2]>,
    middle: f64,
    /// Half-width of the band, or three sigma without a band.
    pub(super) half: f64,
    normal: bool,
    /// Reason why the dimension cannot be changed. None if it can.
    pub(super) fixed: Option<&'static str>,
}

/// Characteristic with the data of its surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Wanted {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    limits: [Option<f64>; 2],
    /// Rounding tolerance at a limit: a value that is beyond by less lies on it.
    rounding: f64,
    target: Option<f64>,
    /// Reason why nothing can be tried. None if something can.
    pub(super) why: Option<String>,
    centre: f64,
    parts: Vec<[f64; 4]>,
    pairs: Pairs,
    unexplained: Option<f64>,
    /// Power of two by which the surface and the limits are divided, so that their squares do not overflow. Left out if it is 1.
    #[serde(skip_serializing_if = "is_one")]
    scale: f64,
    /// True if the page computes the surface distribution.
    law: bool,
    /// True if the page counts the surface at points instead.
    counted: bool,
    /// Reason why the page does not compute the surface distribution. None if it does.
    why_fit: Option<&'static str>,
    /// Reject rates of the report below and above. The page adds the changes. None if there is no such limit, or no yield.
    rejects: [Option<Reported>; 2],
    /// Interval of the yield of the report. None if it is unknown.
    interval: Option<[f64; 2]>,
    /// Source of the yield of the report, in words.
    source: Option<&'static str>,
    /// Errors of mean, sigma, skewness and kurtosis, each None if it is unknown.
    errors: [Option<f64>; 4],
    /// Number of interactions that are screened guesses.
    #[serde(skip)]
    pub(super) screened: usize,
}

/// Reject rate of the report on one side of the limits, with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Reported {
    value: f64,
    /// Ends of the 95 % interval. None if it is unknown.
    low: Option<f64>,
    high: Option<f64>,
}

fn is_one(scale: &f64) -> bool {
    *scale == 1.0
}

/// Products of the surface in columns: indices `j` and `k`, coefficients `a`.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
struct Pairs {
    j: Vec<usize>,
    k: Vec<usize>,
    a: Vec<f64>,
}

/// Returns the reason if the tail of an input makes moments infinite.
fn endless(found: &CharacteristicAnalysis) -> Option<String> {
    let lacks = found.moments.is_some_and(|moments| moments.sigma() > 0.0 && moments.kurtosis().is_none());
    lacks.then(|| "the tail of a dimension is so long that the kurtosis is infinite".to_owned())
}

/// Reject rates of the report below and above.
fn reported(found: &CharacteristicAnalysis) -> [Option<Reported>; 2] {
    let values = found.distribution.capability.map_or([None; 2], |of| [of.below, of.above]);
    [0, 1].map(|side| {
        let interval = found.distribution.reject_intervals[side];
        values[side].map(|value| Reported { value, low: interval.map(|of| of[0]), high: interval.map(|of| of[1]) })
    })
}

/// Degree that selects a numeric rule: every closed form has a lower one.
const DRAWN: usize = 5;

/// True if the part of an input is at most quadratic and the input is normal.
fn parabola(fit: &Fit, j: usize, normal: bool) -> bool {
    normal && fit.surrogate.parts[j].is_some_and(|part| part.coefficients()[2..] == [0.0; 2])
}

/// Reason for interactions of inputs that are not normal: the page cannot invert the transform of their products.
const INTERACT: &str = "dimensions interact that are not normal";

/// Returns the reason why the page shows the Pearson fit. Returns None if it computes the surface distribution, as it does for sums of
/// single inputs and products of normal ones.
fn why_fit(
    found: &CharacteristicAnalysis,
    fit: &Fit,
    laws: &[Option<TabulatedInput>],
    has_atoms: &dyn Fn(usize) -> bool,
) -> Option<&'static str> {
    let Fit { surrogate, .. } = fit;
    let counts = |j: &usize| {
        surrogate.parts[*j].is_some_and(|part| part.largest() > 0.0)
            || surrogate.interactions.pairs().iter().any(|&(a, b, product)| product != 0.0 && (a == *j || b == *j))
    };
    let counting = || (0..laws.len()).filter(counts);
    if counting().any(|j| laws[j].is_none()) {
        return Some("the distribution of a dimension is not in the page");
    }
    // At a value with a probability of its own, a sum over a contour gives only half of that probability.
    if counting().all(has_atoms) {
        return Some("every dimension has a few values only");
    }
    let parabola = |j: usize| parabola(fit, j, laws[j].as_ref().is_some_and(TabulatedInput::is_normal));
    if surrogate.interactions.pairs().iter().any(|&(j, k, product)| product != 0.0 && !(parabola(j) && parabola(k))) {
        return Some(INTERACT);
    }
    match found.evidence.surface_law {
        Some(law) if law.branch != Branch::Sampled => None,
        Some(_) => Some("the tail of a dimension is too heavy"),
        None => Some("there is no law of the surface"),
    }
}

impl WhatIf {
    /// Collects the data of an analysis. `lines` and `costs` come from the study. They are empty if there is no study.
    pub fn of(problem: &Problem, analysis: &Analysis, lines: &[Line], costs: &[Priced]) -> Self {
        let surface = &analysis.surface;
        let clean = |fit: &Fit| Fit { surrogate: fit.surrogate.without_rounding(), ..fit.clone() };
        let fits: Vec<Result<Fit, NoFit>> =
            surface.characteristics.iter().map(|fit| fit.as_ref().map(clean).map_err(|&no| no)).collect();
        let laws = tabulated(problem, &surface.varying, &fits);
        let mut shapes: Vec<Shape> = Vec::new();
        let mut index = |dimension: &Dimension, shape: &InputShape, law: &Option<TabulatedInput>| {
            let shape = Shape::of(dimension, shape, law);
            shapes.iter().position(|known| *known == shape).unwrap_or_else(|| {
                shapes.push(shape);
                shapes.len() - 1
            })
        };
        let dimension = |((&d, shape), law): ((&usize, &InputShape), &Option<TabulatedInput>)| {
            let dimension = &problem.dimensions()[d];
            Tried::of(dimension, index(dimension, shape, law))
        };
        let dimensions = surface.varying.iter().zip(&surface.shapes).zip(&laws).map(dimension).collect();
        let has_atoms = |j: usize| {
            let law = problem.dimensions()[surface.varying[j]].law().and_then(|law| law.probability());
            law.is_some_and(|law| !law.atoms().is_empty())
        };
        let all = analysis.characteristics.iter().zip(&fits).enumerate();
        let characteristics =
            all.map(|(c, (found, fit))| Wanted::of(problem, c, (found, fit), &laws, &has_atoms)).collect();
        let paid = costs.iter().map(|group| group.cost_to_hold(group.tightest_member(problem))).sum();
        let costs = costs.iter().map(|group| Cost::of(problem, &surface.varying, group)).collect();
        Self { dimensions, characteristics, lines: lines.to_vec(), costs, paid, shapes }
    }

    /// True if there is something to change and a result that can follow.
    pub(super) fn possible(&self) -> bool {
        self.dimensions.iter().any(|one| one.fixed.is_none())
            && self.characteristics.iter().any(|one| one.why.is_none())
    }

    /// Returns the reason why nothing can be tried. Returns None if something can, or if nothing varies at all.
    pub(super) fn impossible(&self) -> Option<String> {
        if self.possible() || self.dimensions.is_empty() {
            return None;
        }
        let mut whys: Vec<&str> = self.characteristics.iter().filter_map(|one| one.why.as_deref()).collect();
        // Characteristics are possible: the dimensions are the reason then.
        if whys.len() < self.characteristics.len() {
            whys = self.dimensions.iter().filter_map(|one| one.fixed).collect();
        }
        whys.sort_unstable();
        whys.dedup();
        Some(whys.join("; "))
    }

    pub(super) fn dimensions(&self) -> &[Tried] {
        &self.dimensions
    }

    pub(super) fn characteristics(&self) -> &[Wanted] {
        &self.characteristics
    }

    /// Cost of the tolerances as analysed. None if there are no costs, and an inner None if no process reaches the tolerances.
    pub(super) fn paid(&self) -> Option<Option<f64>> {
        (!self.costs.is_empty()).then_some(self.paid)
    }

    /// True if the study's own lines are known, so that the page can write changed ones.
    pub(super) fn written(&self) -> bool {
        !self.lines.is_empty()
    }
}

/// The tabulated distributions of the varying dimensions; those that are near each other are one.
fn tabulated(problem: &Problem, varying: &[usize], fits: &[Result<Fit, NoFit>]) -> Vec<Option<TabulatedInput>> {
    let normal = |j: usize| problem.dimensions()[varying[j]].distribution().is_some_and(|law| law.name() == "normal");
    let interacts = |fit: &Fit| {
        let pairs = fit.surrogate.interactions.pairs();
        pairs
            .iter()
            .any(|&(j, k, product)| product != 0.0 && !(parabola(fit, j, normal(j)) && parabola(fit, k, normal(k))))
    };
    let drawn = fits.iter().flatten().any(interacts);
    let mut tables: Vec<TabulatedInput> = Vec::new();
    let mut table = |(j, &d): (usize, &usize)| {
        // A dimension takes nodes only where its part has a higher degree than its closed form, or points of it are drawn.
        let degree = if drawn { DRAWN } else { highest_degree(fits, j) };
        let own = TabulatedInput::of(problem.dimensions()[d].law()?, degree)?;
        let known = tables.iter().position(|known| known.is_near(&own)).unwrap_or_else(|| {
            tables.push(own);
            tables.len() - 1
        });
        Some(tables[known].clone())
    };
    varying.iter().enumerate().map(&mut table).collect()
}

/// The highest degree of the part of an input in all surfaces.
fn highest_degree(fits: &[Result<Fit, NoFit>], j: usize) -> usize {
    let own = |fit: &Fit| Some(fit.surrogate.parts.get(j)?.as_ref()?.coefficients());
    let degree = |c: [f64; 4]| c.iter().rposition(|&c| c != 0.0).map_or(0, |place| place + 1);
    fits.iter().flatten().filter_map(own).map(degree).max().unwrap_or(0)
}

impl Wanted {
    /// A characteristic with its surface, divided by a power of two.
    fn of(
        problem: &Problem,
        c: usize,
        (found, fit): (&CharacteristicAnalysis, &Result<Fit, NoFit>),
        laws: &[Option<TabulatedInput>],
        has_atoms: &dyn Fn(usize) -> bool,
    ) -> Self {
        let one = &found.characteristic;
        let limits = one.limits();
        let power = fit.as_ref().map_or(Power::ONE, size);
        let empty = || (0.0, Vec::new(), Pairs::default(), None);
        let (centre, parts, pairs, unexplained) = fit.as_ref().map_or_else(|_| empty(), |fit| contents(fit, power));
        let divided = limits.times(power.inverse());
        let why_fit = fit.as_ref().ok().and_then(|fit| why_fit(found, fit, laws, has_atoms));
        let law = fit.is_ok() && why_fit.is_none();
        let error = |of: fn(&ErrorEstimate) -> Option<f64>| found.error_estimate.as_ref().and_then(of);
        Self {
            name: one.name().to_owned(),
            unit: one.unit().map(str::to_owned),
            limits: [divided.lower(), divided.upper()],
            rounding: power.inverse().times(problem.kept_limits(c).rounding()),
            target: one.target_yield(),
            why: fit.as_ref().err().map(ToString::to_string).or_else(|| endless(found)),
            centre,
            parts,
            pairs,
            unexplained,
            scale: power.times(1.0),
            law,
            counted: why_fit == Some(INTERACT) && limits.exist(),
            why_fit,
            rejects: reported(found),
            interval: found.yield_interval().filter(|_| !found.missing.unfinished),
            source: found.distribution.yield_source.map(YieldSource::words),
            errors: [error(|of| of.mean), error(|of| of.sigma), error(|of| of.skewness), error(|of| of.kurtosis)],
            screened: fit.as_ref().map_or(0, |fit| fit.screened),
        }
    }
}

/// The power of two of the largest coefficient of a surface.
fn size(fit: &Fit) -> Power {
    let Fit { surrogate, .. } = fit;
    let parts = surrogate.parts.iter().flatten().map(|part| part.largest());
    let products = surrogate.interactions.pairs().into_iter().map(|(.., product)| product.abs());
    Power::of(parts.chain(products).fold(surrogate.centre.abs(), f64::max))
}

/// Centre, parts, products and unexplained variance of a surface, divided by a power of two.
fn contents(fit: &Fit, power: Power) -> (f64, Vec<[f64; 4]>, Pairs, Option<f64>) {
    let Fit { surrogate, unexplained_sigma, .. } = fit;
    let divided = |value: f64| power.inverse().times(value);
    let parts = surrogate.parts.iter().flatten().map(|part| part.coefficients().map(divided)).collect();
    let mut pairs = Pairs::default();
    for (j, k, a) in surrogate.interactions.pairs() {
        pairs.j.push(j);
        pairs.k.push(k);
        pairs.a.push(divided(a));
    }
    (divided(surrogate.centre), parts, pairs, unexplained_sigma.map(|sigma| divided(sigma).powi(2)))
}

impl Cost {
    fn of(problem: &Problem, varying: &[usize], group: &Priced) -> Self {
        let place = |d: &usize| varying.iter().position(|known| known == d);
        let share = |d: usize| group.members.iter().position(|&own| own == d).map_or(1.0, |at| group.share(at));
        let others = group.members.iter().filter(|d| place(d).is_none());
        let offer = |curve: &Curve, min: f64, max: f64| {
            let [a, b, shape] = curve.constants();
            let points = curve.points(min, max);
            Offered { exponential: curve.kind() == CurveKind::Exponential, a, b, shape, points, min, max }
        };
        Self {
            members: group.members.iter().filter_map(place).collect(),
            shares: group.zone.as_ref().map(|_| {
                let listed = |(at, d): (usize, &usize)| place(d).map(|_| group.share(at));
                group.members.iter().enumerate().filter_map(listed).collect()
            }),
            others: others.map(|&d| problem.dimensions()[d].half_band() / share(d)).reduce(f64::min),
            parts: group.parts,
            offers: group.offers.iter().map(|one| offer(&one.curve, one.min, one.max)).collect(),
        }
    }
}

impl Shape {
    fn of(dimension: &Dimension, shape: &InputShape, law: &Option<TabulatedInput>) -> Self {
        // The nodes of a long tail, which replace the Gauss rule, are exact for no parabola.
        let gauss = dimension.distribution().and_then(|distribution| shapes([distribution]).pop());
        let replaced = gauss.filter(|gauss| gauss.rule != shape.rule);
        Self {
            s: shape.moments.skewness,
            k: shape.moments.excess,
            rule: Table::of(&shape.rule),
            parabola: replaced.map(|gauss| Table::of(&gauss.rule)),
            law: law.clone(),
        }
    }
}

impl Table {
    fn of(rule: &Rule) -> Self {
        Self { nodes: rule.nodes.clone(), weights: rule.weights.clone() }
    }
}

impl Tried {
    fn of(dimension: &Dimension, shape: usize) -> Self {
        let band = dimension.tolerance();
        let middle = band.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
        let kind = dimension.distribution().map_or("", |law| law.name());
        let half = match band {
            Some([lower, upper]) => 0.5 * (upper - lower),
            None => 3.0 * dimension.sigma(),
        };
        Self {
            name: dimension.name().to_owned(),
            unit: dimension.unit().map(str::to_owned),
            shape,
            nominal: dimension.nominal(),
            offset: dimension.mean() - dimension.nominal() - middle,
            sigma: dimension.sigma(),
            band,
            middle,
            half,
            normal: kind == "normal",
            fixed: fixed(dimension, kind),
        }
    }
}

/// Returns the reason why a dimension cannot be changed, or None if it can.
fn fixed(dimension: &Dimension, kind: &str) -> Option<&'static str> {
    if dimension.zone().is_some() {
        return Some("a coordinate of a circular zone");
    }
    match kind {
        "mixture" => return Some("a mixture is changed in the study, part by part"),
        _ if dimension.distribution().is_some_and(|law| law.measured().is_some()) => return Some("measured"),
        kind if !KINDS.contains(&kind) => return Some("its shape or its tolerance does not follow a factor"),
        _ => {}
    }
    // The shape must be the same at half and at twice the tolerance.
    let same = |factor: f64| {
        let scaled = dimension.scaled(factor)?.ok()?;
        let [before, after] =
            [dimension, &scaled].map(|one| one.distribution().map(|law| law.standard_moments().raw()));
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs().max(1.0);
        Some(before?.iter().zip(&after?).all(near))
    };
    match same(0.5).zip(same(2.0)) {
        Some((true, true)) => None,
        _ => Some("its shape changes with its tolerance"),
    }
}
