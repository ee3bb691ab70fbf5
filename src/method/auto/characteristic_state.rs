//! State of one characteristic during the refinement: its surrogate, and the estimated error of the surrogate.

use std::collections::BTreeMap;

use crate::method::auto::chosen_points::{ChosenPoints, Probe};
use crate::method::auto::screened_interactions::{Bends, atoms};
use crate::method::auto::screening;
use crate::method::auto::screening::{Fit, Probed};
use crate::method::check_points::{SurrogateCheck, failed};
use crate::method::hidden_terms::hidden;
use crate::method::polynomial_surface::PolynomialSurface;
use crate::plan::{DifferencePlan, KnownAnswers, Mixed, Point};
use sensitol_numeric::distribution::StandardMoments;
use sensitol_numeric::moments::{Interactions, Moments};
use sensitol_numeric::surrogate::{DerivativeOrigin, Surrogate, Univariate};

/// Mixed derivatives by pair.
type Products = BTreeMap<(usize, usize), Mixed>;

/// Surrogate of one characteristic so far, with its moments and errors.
pub(super) struct View {
    pub(super) characteristic: usize,
    pub(super) surrogate: Surrogate,
    pub(super) moments: Moments,
    pub(super) check: Option<SurrogateCheck>,
    /// Variance that each part may hide, by position.
    pub(super) hidden: Vec<f64>,
    /// Variance of every part, and of its curved terms, as shares of the surrogate's variance.
    pub(super) shares: Vec<[f64; 2]>,
    /// Products of two positions, including those that are not complete.
    pub(super) products: Products,
    /// Mean square of the screening's residuals at the judging probes, as a share of the variance.
    pub(super) unscreened: Option<f64>,
    /// Scatter of the answers next to the means.
    pub(super) noise: Option<f64>,
    /// Largest difference of model and surrogate along the steepest line, in sigmas; infinite if the model fails.
    pub(super) tail: Option<f64>,
    /// Value of `tail` without the part that the check points explain.
    pub(super) beyond: Option<f64>,
    pub(super) bends: Bends,
}

/// Surface whose figures are not computed yet.
struct Draft {
    /// Value of the surface at the means.
    base: f64,
    parts: Vec<Option<Univariate>>,
    products: Products,
    bends: Bends,
    /// Variance of every part as evaluated.
    own: Vec<f64>,
    /// Mean square of the screening's residuals at the judging probes.
    unscreened: Option<f64>,
}

/// Answers of one characteristic so far.
#[derive(Clone, Copy)]
struct Answers<'a> {
    plan: &'a DifferencePlan,
    known: &'a KnownAnswers,
    bought: &'a ChosenPoints,
    characteristic: usize,
    /// Value of the model at the means.
    centre: f64,
}

impl Draft {
    /// Returns the surface of a formula that is a polynomial.
    fn of_polynomial(polynomial: &PolynomialSurface, answers: Answers<'_>) -> Self {
        let parts: Vec<Option<Univariate>> = polynomial.parts.iter().copied().map(Some).collect();
        let own = variances(answers.plan, &parts);
        let (bends, products) = (Bends::of(&parts), polynomial.products.clone());
        Self { base: answers.centre, bends, parts, products, own, unscreened: None }
    }

    /// Returns a surface of evaluated parts and pairs, with estimates of all other pairs.
    fn of_points(answers: Answers<'_>, accuracy: f64) -> Option<Self> {
        let Answers { plan, known, bought, characteristic: c, centre } = answers;
        let parts: Vec<Option<Univariate>> = plan.varying().iter().map(|&d| plan.part(known, c, d)).collect();
        let bends = Bends::of(&parts);
        let mixed = plan.mixed(known, c, &bought.direct);
        let evaluated = bought.direct.iter().zip(mixed).filter_map(|(&pair, mixed)| Some((pair, mixed?)));
        let mut products: Products = evaluated.collect();
        products.extend(bought.given.get(c).into_iter().flatten().copied());
        let mut draft = Self { base: centre, parts, products, bends, own: Vec::new(), unscreened: None };
        if !bought.direct.is_empty() {
            draft.twist(answers);
        }
        draft.own = variances(plan, &draft.parts);
        let alone: f64 =
            draft.own.iter().sum::<f64>() + draft.products.values().map(|mixed| mixed.value.powi(2)).sum::<f64>();
        let screened = Screened::of(plan, known, bought, c, (centre, &draft.parts, &draft.products));
        let mut together = None;
        if let Some(screened) = screened {
            let fit = screened.fit(0.5 * accuracy * alone);
            screened.add(&fit, &mut draft.products);
            draft.unscreened = Some(fit.left / screened.unit);
            together = Some(fit.together);
        }
        draft.add_atoms(answers, together)?;
        Some(draft)
    }

    fn surrogate(&self) -> Surrogate {
        surrogate_of(self.base, &self.parts, &self.products)
    }

    /// Adds the terms that corners show beside products, if they lower the residuals at the check points.
    fn twist(&mut self, answers: Answers<'_>) {
        let Answers { plan, known, bought, characteristic: c, .. } = answers;
        let (mut parts, mut products, mut base) = (self.parts.clone(), self.products.clone(), self.base);
        for (&(j, k), corners) in bought.direct.iter().zip(plan.twists(known, c, &bought.direct)) {
            let Some(twist) = self.bends.twist((j, k), &corners) else { continue };
            if let Some(mixed) = products.get_mut(&(j, k)) {
                mixed.value = twist.product;
            }
            for (position, slope) in [(j, twist.slopes[0]), (k, twist.slopes[1])] {
                // The split of a corner's value into these terms is an assumption.
                let added = |part: Univariate| {
                    part.with_slope(slope).with_curvature(twist.square).with_origin(DerivativeOrigin::Screened)
                };
                parts[position] = parts[position].map(added);
            }
            base -= twist.square;
        }
        let left_by = |surrogate: &Surrogate| {
            let left = left_at(plan, known, c, bought, surrogate)?;
            Some(left.into_iter().flatten().map(|left| left * left).sum::<f64>())
        };
        let agree = left_by(&surrogate_of(base, &parts, &products)).zip(left_by(&self.surrogate()));
        if agree.is_some_and(|(twisted, plain)| twisted < plain) {
            (self.parts, self.products, self.base) = (parts, products, base);
        }
    }

    /// Adds estimates of all interactions that were not examined, if a single factor explains the residuals. `together` is the factor that
    /// the probes gave. Returns None if a part is unknown.
    fn add_atoms(&mut self, answers: Answers<'_>, together: Option<f64>) -> Option<()> {
        let Answers { plan, known, bought, characteristic: c, .. } = answers;
        let left = left_at(plan, known, c, bought, &self.surrogate())?;
        let atoms = atoms(plan, bought, &bought.known(c), &self.bends, &left, together);
        if let Some(together) = atoms.together {
            let n = self.parts.len();
            for (j, k) in (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k))) {
                let value = together * self.bends.slope(j) * self.bends.slope(k);
                if value != 0.0 && plan.joint(c, j, k) {
                    self.products.entry((j, k)).or_insert(Mixed::screened(value));
                }
            }
        }
        for (part, &more) in self.parts.iter_mut().zip(atoms.slopes.iter().flatten()).filter(|(_, more)| **more != 0.0)
        {
            *part = part.map(|part| part.with_slope(more).with_origin(DerivativeOrigin::Screened));
        }
        Some(())
    }
}

/// Returns the variance of every part; 0 for an unknown part.
fn variances(plan: &DifferencePlan, parts: &[Option<Univariate>]) -> Vec<f64> {
    let shapes = plan.inputs().shapes();
    parts.iter().zip(shapes).map(|(part, shape)| part.map_or(0.0, |part| part.term(shape).variance(1.0))).collect()
}

impl View {
    /// Returns the view of a characteristic, or None if it has no value at the means or if a part is unknown.
    pub(super) fn of(
        plan: &DifferencePlan,
        known: &KnownAnswers,
        bought: &ChosenPoints,
        c: usize,
        accuracy: f64,
    ) -> Option<Self> {
        let centre = known.value(&Point::Centre, c)?;
        let answers = Answers { plan, known, bought, characteristic: c, centre };
        let polynomial = bought.polynomial(c);
        let draft = match polynomial {
            Some(polynomial) => Draft::of_polynomial(polynomial, answers),
            None => Draft::of_points(answers, accuracy)?,
        };
        let surrogate = draft.surrogate();
        let moments = surrogate.contributions(plan.inputs())?.moments;
        let variance = moments.variance();
        let share = |value: f64| if variance > 0.0 { value / variance } else { 0.0 };
        let part = |j: usize| {
            let part = surrogate.parts[j].expect("moments need every part");
            let (d, shape) = (plan.varying()[j], &plan.inputs().shapes()[j]);
            // Parts of a formula hide no terms.
            let hidden = plan
                .samples(known, c, d)
                .filter(|_| plan.depends(c, d) && polynomial.is_none())
                .and_then(|samples| hidden(&part, &samples, centre, shape));
            let shares = [share(draft.own[j]), share(part.term(shape).part(1.0).curved)];
            (hidden.map_or(0.0, |hidden| hidden.variance), shares)
        };
        let (hidden, shares) = (0..surrogate.parts.len()).map(part).unzip();
        let check = SurrogateCheck::of(plan, known, c, &bought.checks, (&surrogate, &moments));
        let even = check.as_ref().map_or(0.0, |check| share(check.even));
        let [tail, beyond] = [0.0, even].map(|even| tail(plan, known, c, bought, (&surrogate, moments.sigma()), even));
        let noise = bought.noise.as_ref().and_then(|points| scatter(plan, known, c, points, &surrogate));
        let unscreened = draft.unscreened.map(share);
        let Draft { products, bends, .. } = draft;
        Some(Self {
            characteristic: c,
            surrogate,
            moments,
            check,
            hidden,
            shares,
            products,
            unscreened,
            noise,
            tail,
            beyond,
            bends,
        })
    }

    /// Returns the number of products of the surrogate that are estimates.
    pub(super) fn screened(&self) -> usize {
        self.products.values().filter(|mixed| mixed.value != 0.0 && !mixed.origin.is_known()).count()
    }

    pub(super) fn variance(&self) -> f64 {
        self.moments.variance()
    }

    /// Returns a part of the variance as a share of it.
    pub(super) fn share(&self, part: f64) -> f64 {
        if self.variance() > 0.0 {
            part / self.variance()
        } else if part > 0.0 {
            f64::INFINITY
        } else {
            0.0
        }
    }

    /// Returns the variance of the residuals at the check points, as a share of the variance. Returns None if there are no check points.
    pub(super) fn left(&self) -> Option<f64> {
        self.check.as_ref().map(|check| self.share(check.variance))
    }

    /// Returns the relative error of sigma from terms that polynomials hide. The residuals at the check points bound it.
    pub(super) fn truncation(&self) -> f64 {
        let hidden = 0.5 * self.share(self.hidden.iter().sum());
        self.left().map_or(hidden, |left| hidden.min(1.5 * left.sqrt()))
    }

    /// Returns the estimated relative error of sigma.
    pub(super) fn error(&self) -> f64 {
        let sigma = self.moments.sigma().max(f64::MIN_POSITIVE);
        let unseen = |check: &SurrogateCheck| check.unseen(self.variance()) + check.shown(1) / sigma;
        let tail = self.beyond.map_or(0.0, SurrogateCheck::far_out);
        self.truncation() + self.left().unwrap_or(0.0) + self.check.as_ref().map_or(0.0, unseen) + tail
    }
}

fn surrogate_of(centre: f64, parts: &[Option<Univariate>], products: &Products) -> Surrogate {
    let pairs = products.iter().map(|(&(j, k), mixed)| (j, k, mixed.value)).filter(|&(.., value)| value != 0.0);
    let interactions = Interactions::of_pairs(parts.len(), pairs.collect::<Vec<_>>());
    Surrogate { centre, parts: parts.to_vec(), interactions }
}

/// Returns the residuals (model minus surrogate) at the check points.
fn left_at(
    plan: &DifferencePlan,
    known: &KnownAnswers,
    c: usize,
    bought: &ChosenPoints,
    surrogate: &Surrogate,
) -> Option<Vec<Option<f64>>> {
    let points: Vec<&Point> = bought.checks.iter().flatten().collect();
    let places: Vec<Vec<f64>> = points.iter().map(|point| plan.standardised(point)).collect();
    let column = |position: usize| places.iter().map(|place| place[position]).collect::<Vec<f64>>();
    let inputs: Vec<Vec<f64>> = (0..plan.varying().len()).map(column).collect();
    let rises = surrogate.rises(&inputs)?;
    let left = |(point, rise): (&&Point, &f64)| Some((known.value(point, c)? - surrogate.centre) - rise);
    Some(points.iter().zip(&rises).map(left).collect())
}

/// Returns the scatter of answers next to the means, beyond the change of the surrogate.
fn scatter(
    plan: &DifferencePlan,
    known: &KnownAnswers,
    c: usize,
    points: &[Point; 2],
    surrogate: &Surrogate,
) -> Option<f64> {
    let places = [0, 1].map(|i| plan.standardised(&points[i]));
    let inputs: Vec<[f64; 2]> = (0..plan.varying().len()).map(|j| [places[0][j], places[1][j]]).collect();
    let rises = surrogate.rises(&inputs)?;
    let rise = |i: usize| Some((known.value(&points[i], c)? - surrogate.centre) - rises[i]);
    // The second difference of three values with equal scatter has six times its variance.
    Some((rise(0)? + rise(1)?).abs() / 6f64.sqrt())
}

/// Returns the largest difference between model and surrogate far out along the examined lines, in sigmas.
///
/// The part that both ends of a line have in common may be a parabola that the check points show already. A parabola `c s^2` along the line
/// has the variance `2 c^2` and 9 c at the ends. The explained part is the one of a parabola that leaves the share `even` of the variance
/// at the check points.
fn tail(
    plan: &DifferencePlan,
    known: &KnownAnswers,
    c: usize,
    bought: &ChosenPoints,
    (surrogate, sigma): (&Surrogate, f64),
    even: f64,
) -> Option<f64> {
    let off = |point: &Point| {
        let place = plan.standardised(point);
        let rise = surrogate.rises(&place.iter().map(std::slice::from_ref).collect::<Vec<_>>())?[0];
        match known.value(point, c) {
            Some(value) => Some(((value - surrogate.centre) - rise) / sigma),
            None => failed(known, point, c).then_some(f64::INFINITY),
        }
    };
    let explained = 9.0 * (0.5 * even).sqrt();
    let largest = |points: &[Point; 2]| {
        let ends: Vec<f64> = points.iter().filter_map(off).collect();
        let alike = match *ends {
            [a, b] if a * b > 0.0 => a.abs().min(b.abs()),
            _ => 0.0,
        };
        let beyond = |end: &f64| if end.is_finite() { end.abs() - alike.min(explained) } else { f64::INFINITY };
        ends.iter().map(beyond).reduce(f64::max)
    };
    if sigma <= 0.0 {
        return None;
    }
    bought.tails.iter().filter(|(of, _)| *of == c).filter_map(|(_, points)| largest(points)).reduce(f64::max)
}

/// Probes with the answers of one characteristic.
struct Screened<'a> {
    fitted: Probed<'a>,
    judging: Probed<'a>,
    /// Half the distance of the two nodes, by position.
    half: Vec<f64>,
    slopes: Vec<f64>,
    /// Ratio of a mean square of the probes to a variance.
    unit: f64,
}

impl<'a> Screened<'a> {
    fn of(
        plan: &DifferencePlan,
        known: &KnownAnswers,
        bought: &'a ChosenPoints,
        c: usize,
        (centre, parts, products): (f64, &[Option<Univariate>], &Products),
    ) -> Option<Self> {
        if bought.judging.is_empty() {
            return None;
        }
        let corners = plan.corners(known);
        let ends = |j: usize| Some([corners[j][0]?, corners[j][1]?]);
        let half: Vec<f64> =
            (0..parts.len()).map(|j| ends(j).map_or(0.0, |[left, right]| 0.5 * (right.1 - left.1))).collect();
        let bends: f64 = (0..parts.len())
            .filter_map(|j| {
                let rise = |(at, _): (crate::plan::AtNode, f64)| Some(known.value(&Point::of(&[at]), c)? - centre);
                let [left, right] = ends(j)?;
                Some(0.5 * (rise(left)? + rise(right)?))
            })
            .sum();
        let seen = |probe: &Probe| {
            let rise = |point: &Point| Some(known.value(point, c)? - centre);
            let axis = |(j, sign): (usize, &f64)| match corners[j][usize::from(*sign > 0.0)] {
                Some((at, _)) => rise(&Point::of(&[at])),
                None => Some(0.0),
            };
            let direct: f64 = products
                .iter()
                .map(|(&(j, k), mixed)| mixed.value * half[j] * half[k] * probe.signs[j] * probe.signs[k])
                .sum();
            let beside = match probe.points.as_slice() {
                [one, other] => 0.5 * (rise(one)? + rise(other)?) - bends,
                points => rise(&points[0])? - probe.signs.iter().enumerate().map(axis).sum::<Option<f64>>()?,
            };
            Some(beside - direct)
        };
        let probed = |probes: &'a [Probe]| {
            let (signs, seen) = probes.iter().filter_map(|probe| Some((probe.signs.as_slice(), seen(probe)?))).unzip();
            Probed { signs, seen }
        };
        let slope = |j: usize| half[j] * parts[j].map_or(0.0, |part| part.slope());
        let squares = half.iter().map(|half| half * half).sum::<f64>() / half.len().max(1) as f64;
        let (fitted, judging) = (probed(&bought.fitted), probed(&bought.judging));
        let enough = !judging.seen.is_empty() && fitted.seen.len() >= 2;
        let slopes = (0..parts.len()).map(slope).collect();
        enough.then_some(Self { fitted, judging, half, slopes, unit: squares * squares })
    }

    /// Returns the best fit. `enough` is the variance that may be left.
    fn fit(&self, enough: f64) -> Fit {
        screening::fit(&self.fitted, &self.judging, &self.slopes, enough * self.unit)
    }

    fn add(&self, fit: &Fit, products: &mut Products) {
        let mut add = |j: usize, k: usize, value: f64| {
            let over = self.half[j] * self.half[k];
            if over != 0.0 && value != 0.0 {
                let mixed = products.entry((j, k)).or_insert(Mixed::screened(0.0));
                (mixed.value, mixed.origin) = (mixed.value + value / over, DerivativeOrigin::Screened);
            }
        };
        if fit.together != 0.0 {
            for j in 0..self.slopes.len() {
                (j + 1..self.slopes.len()).for_each(|k| add(j, k, fit.together * self.slopes[j] * self.slopes[k]));
            }
        }
        fit.pairs.iter().for_each(|&(j, k, value)| add(j, k, value));
    }
}

/// True if a distribution is so skewed that mirrored points do not separate even from odd powers.
pub(super) fn skewed(moments: &StandardMoments) -> bool {
    moments.skewness.abs() > 0.3
}
