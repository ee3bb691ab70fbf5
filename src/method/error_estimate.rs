//! Estimated errors of the results of a method, from the effects that it did not examine.
//!
//! Every source of error changes the surrogate in the way in which the model might differ from it. The change of the moments is the part of
//! this source in the estimate. Parts of different sources add. A source of unknown size makes the estimate None.

use serde::Serialize;

use crate::assembly::Directions;
use crate::method::check_points::SurrogateCheck;
use crate::method::exact_derivatives::units;
use crate::method::hidden_terms::{hidden, ratio};
use crate::method::{AutoAccount, Basis, Order, Outcome, SurfaceProof};
use crate::problem::Problem;
use sensitol_numeric::moments::{Interactions, Moments, Term, contributions};
use sensitol_numeric::power::rescale;
use sensitol_numeric::surrogate::{Inputs, Surrogate, Univariate};

/// Greatest number of interactions for which exact derivatives are computed. More of them take too long.
const EXACT: usize = 2000;
/// Assumed factor `t` of the terms `u_j^2 u_k` that twist an interaction. It lies between 1 and 3.
const TWIST: f64 = 1.5;
/// Greatest ratio of curvature to slope that is used. If the product of two ratios exceeds it, both dimensions count as acting by their
/// squares.
const BENT: f64 = 0.3;
/// Greatest ratio of the variance of interactions of three dimensions to that of two.
const MOST: f64 = 0.5;

/// Estimated error of each result, in the unit of the result; None if the error is unknown.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ErrorEstimate {
    /// Error of the mean.
    pub mean: Option<f64>,
    /// Error of sigma.
    pub sigma: Option<f64>,
    /// Error of the skewness.
    pub skewness: Option<f64>,
    /// Error of the kurtosis.
    pub kurtosis: Option<f64>,
    /// Error of the share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Sources that the estimate is made of.
    pub sources: Vec<ErrorSource>,
}

rescale!(ErrorEstimate { mean, sigma } without { skewness, kurtosis, yield_, sources });

/// Source of an estimated error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ErrorSource {
    /// Comparison of model and surrogate at points of the dimensions' distribution.
    Checked {
        /// Number of check points with a value.
        points: usize,
    },
    /// Powers beyond those of the polynomials, extrapolated from the decrease of the known ones.
    Powers {
        /// Nodes of the axes with the fewest, including the mean.
        nodes: usize,
    },
    /// Powers beyond the second, extrapolated from exact derivatives.
    Taylor,
    /// Effect of curvature, which a first-order method leaves out.
    Curvature,
    /// Interactions that were not examined, from exact derivatives.
    ExactPairs {
        /// Number of pairs that were not examined.
        pairs: usize,
    },
    /// Interactions that were not examined, extrapolated from those that were.
    SimilarPairs {
        /// Number of pairs that were not examined.
        pairs: usize,
    },
    /// Interactions of which nothing is known, so that the error is unknown.
    UnknownPairs {
        /// Number of pairs that were not examined.
        pairs: usize,
    },
    /// Interactions of three and more dimensions, extrapolated from those of two.
    Triples,
    /// Scatter of the answers of a model that is noisy.
    Scatter,
    /// A derivative without a value, so that the error is unknown.
    Lost,
    /// A formula that is a polynomial, which the surface represents exactly.
    Proven {
        /// Degree of the polynomial that the formula is.
        degree: u32,
    },
    /// Standard errors of a sample of the model.
    Sampled {
        /// Number of points in the sample.
        points: u64,
    },
}

impl ErrorSource {
    /// Returns the source in words, for reports.
    pub fn words(self) -> String {
        match self {
            Self::Checked { points } => format!("model against surrogate at {points} points of the distribution"),
            Self::Powers { nodes } => format!("powers that {nodes} points a dimension do not show, extrapolated"),
            Self::Taylor => "powers beyond the second derivative, extrapolated".to_owned(),
            Self::Curvature => "curvature, which the method leaves out".to_owned(),
            Self::ExactPairs { pairs } => format!("{pairs} interactions not examined, by exact derivatives"),
            Self::SimilarPairs { pairs } => format!("{pairs} interactions not examined, taken to be like the others"),
            Self::UnknownPairs { pairs } => format!("nothing is known of {pairs} interactions"),
            Self::Triples => "interactions of three, extrapolated".to_owned(),
            Self::Scatter => "scatter of the answers".to_owned(),
            Self::Lost => "a derivative is lost".to_owned(),
            Self::Proven { degree } => format!("rounding alone: the formula is a polynomial of degree {degree}"),
            Self::Sampled { points } => format!("standard errors of {points} points of the model"),
        }
    }
}

impl ErrorEstimate {
    /// Returns all sources in words, for reports.
    pub fn basis(&self) -> String {
        self.sources.iter().map(|source| source.words()).collect::<Vec<_>>().join("; ")
    }
}

/// Possible contribution of the terms `u_j^2 u_k` to half the variance, and of the terms `u_j^2 u_k^2` to the mean.
///
/// In a product of functions, and in a function of a sum, the coefficient of `u_j^2 u_k` is `t a_j A_jk/b_j`, with slopes `b`, curvatures
/// `a` and `t` from 1 to 3. The mean of this term is a slope of dimension `k`. The coefficient of `u_j^2 u_k^2` in such functions is `a_j
/// a_k A_jk/(b_j b_k)`. If two dimensions act by their squares, two corners do not separate `u_j^2 u_k^2` from the product, and the whole
/// product is in doubt.
fn twists(parts: &[Univariate], products: &[(usize, usize, f64)]) -> [f64; 2] {
    let [slopes, curvatures]: [Vec<f64>; 2] =
        [0, 1].map(|i| parts.iter().map(|part| part.coefficients()[i].abs()).collect());
    let bend = |j: usize| if slopes[j] > 0.0 { (curvatures[j] / slopes[j]).min(BENT) } else { BENT };
    let term = |&(j, k, value): &(usize, usize, f64)| {
        let value = value.abs();
        let squares = curvatures[j] * curvatures[k] > BENT * slopes[j] * slopes[k];
        let doubt = if squares { 0.5 * value * value + value * (curvatures[j] + curvatures[k]) / 1.5 } else { 0.0 };
        let lines = TWIST * value * (bend(j) * slopes[k] + bend(k) * slopes[j]) + doubt;
        [lines, value * if squares { 1.0 / 3.0 } else { bend(j) * bend(k) }]
    };
    products.iter().map(term).fold([0.0; 2], |sum, more| [sum[0] + more[0], sum[1] + more[1]])
}

/// Contributions to the errors of mean, sigma, skewness and kurtosis.
type Errors = [f64; 4];

fn figures(moments: &Moments) -> Errors {
    [moments.mean(), moments.sigma(), moments.skewness().unwrap_or(0.0), moments.excess().unwrap_or(0.0)]
}

fn apart(a: &Moments, b: &Moments) -> Errors {
    let (a, b) = (figures(a), figures(b));
    std::array::from_fn(|i| (a[i] - b[i]).abs())
}

fn add(sum: &mut Errors, more: Errors) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// Estimates the errors of the moments of a characteristic. Returns None if the method gives no estimate, or if there is no surrogate.
pub fn estimate(problem: &Problem, outcome: &Outcome, c: usize, moments: &Moments) -> Option<ErrorEstimate> {
    if !matches!(outcome.basis, Basis::Exact | Basis::Differences) {
        return None;
    }
    let surrogate = outcome.fitted[c].surrogate.as_ref()?;
    let mut of = Estimate { problem, outcome, c, surrogate, errors: [0.0; 4], known: [true; 4], sources: Vec::new() };
    // Moments of correlated inputs may be sampled from the surface, so that a proof of the surface does not make them exact.
    match outcome.fitted[c].proof.filter(|_| outcome.plan.inputs().correlation().is_none()) {
        Some(proof) => of.proven(proof, moments),
        None => of.unproven(moments),
    }
    of.rounding(moments);
    let value = |i: usize| of.known[i].then_some(of.errors[i]);
    Some(ErrorEstimate {
        mean: value(0),
        sigma: value(1),
        skewness: value(2).filter(|_| moments.skewness().is_some()),
        kurtosis: value(3).filter(|_| moments.kurtosis().is_some()),
        yield_: None,
        sources: of.sources,
    })
}

struct Estimate<'a> {
    problem: &'a Problem,
    outcome: &'a Outcome,
    c: usize,
    surrogate: &'a Surrogate,
    errors: Errors,
    known: [bool; 4],
    sources: Vec<ErrorSource>,
}

impl Estimate<'_> {
    /// Adds the errors of a surface that may differ from the function.
    fn unproven(&mut self, moments: &Moments) {
        let outcome = self.outcome;
        let checked = outcome.climbed.as_ref().and_then(|climbed| Some((climbed, climbed.checked[self.c].as_ref()?)));
        match self.hidden(moments) {
            None => {
                self.known = [false; 4];
                self.sources.push(ErrorSource::Lost);
            }
            Some(hidden) => match checked {
                Some((climbed, check)) if check.points > 1 => self.checked(climbed, check, hidden, moments),
                _ => self.unchecked(hidden, moments),
            },
        }
    }

    /// Adds the rounding errors of a surface that is the function itself.
    fn proven(&mut self, SurfaceProof { degree, mean, sigma }: SurfaceProof, moments: &Moments) {
        let part = if moments.sigma() > 0.0 { sigma / moments.sigma() } else { 0.0 };
        add(&mut self.errors, [mean, sigma, 4.0 * part, 8.0 * part]);
        self.sources.push(ErrorSource::Proven { degree });
    }

    /// Returns the univariate parts of all varying dimensions, with curvatures even if the method is of first order.
    fn parts(&self) -> Option<Vec<Univariate>> {
        self.outcome.plan.varying().iter().map(|&d| self.outcome.fitted[self.c].parts[d]).collect()
    }

    /// Returns the possible contribution of powers beyond the polynomials. Returns None if a part is not even a parabola.
    fn hidden(&self, moments: &Moments) -> Option<Errors> {
        let plan = &self.outcome.plan;
        let parts = self.parts()?;
        let mut values = Vec::with_capacity(parts.len());
        for ((part, shape), &d) in parts.iter().zip(plan.inputs().shapes()).zip(plan.varying()) {
            let samples = match self.outcome.basis == Basis::Exact {
                // Exact derivatives are differences over no distance.
                true => vec![(0.0, 0.0); 2],
                false => plan.samples(&self.outcome.evaluated.known, self.c, d)?,
            };
            let samples = if plan.depends(self.c, d) { samples } else { vec![(0.0, 0.0); 2] };
            values.push(hidden(part, &samples, self.surrogate.centre, shape)?);
        }
        let shapes = plan.inputs().shapes();
        let known: Vec<Term<'_>> = parts.iter().zip(shapes).map(|(part, shape)| part.term(shape)).collect();
        let other = values.iter().zip(shapes).map(|(hidden, shape)| Term::Tabulated {
            values: hidden.values.clone(),
            rule: &shape.rule,
            moments: &shape.moments,
        });
        let other: Vec<Term<'_>> = other.collect();
        let interactions = &self.surrogate.interactions;
        // The moments of a surface of independent inputs are known already, except that `errors[0]` is replaced below, so that the mean is
        // not needed.
        let own = self.outcome.order == Order::Second
            && self.outcome.fitted[self.c].integrated.is_none()
            && self.outcome.climbed.is_none()
            && plan.inputs().correlation().is_none()
            && self.surrogate.parts.iter().copied().eq(parts.iter().copied().map(Some));
        let known = if own { *moments } else { contributions(0.0, &known, interactions).moments };
        let mut errors = apart(&contributions(0.0, &other, interactions).moments, &known);
        // The signs of the hidden terms are guesses, so terms that cancel here may add in the model.
        let sigma = moments.sigma();
        let variance: f64 = values.iter().map(|hidden| hidden.variance).sum();
        errors[0] = values.iter().map(|hidden| hidden.mean.abs()).sum();
        if sigma > 0.0 {
            errors[1] = errors[1].max(0.5 * variance / sigma);
        }
        Some(errors)
    }

    /// Adds the errors of a surrogate that was compared with the model. The residuals at the check points bound the hidden powers.
    fn checked(&mut self, climbed: &AutoAccount, check: &SurrogateCheck, hidden: Errors, moments: &Moments) {
        let sigma = moments.sigma();
        let left = if sigma > 0.0 { check.variance / (sigma * sigma) } else { 0.0 };
        let root = left.sqrt();
        let [mean, spread, skewness, kurtosis] = hidden;
        add(
            &mut self.errors,
            [
                mean.min(root * sigma) + check.effect(0),
                spread.min(1.5 * root * sigma) + (left + check.unseen(moments.variance())) * sigma + check.shown(1),
                skewness.min(3.0 * root) + check.effect(2) + 1.5 * left,
                kurtosis.min(6.0 * root) + check.effect(3) + 6.0 * left,
            ],
        );
        let [far, beyond] =
            [&climbed.tails, &climbed.beyond].map(|tails| tails[self.c].map_or(0.0, SurrogateCheck::far_out));
        // The parabola that explains residuals at the check points is in sigma already (`left`). The other moments depend on its position
        // relative to the slopes, so they get the whole difference.
        add(&mut self.errors, [far * sigma, beyond * sigma, 6.0 * far, 20.0 * far]);
        self.sources.push(ErrorSource::Checked { points: check.points });
        self.powers();
        let scatter = climbed.noise[self.c].unwrap_or(0.0);
        if sigma > 0.0 && scatter > 1e-9 * sigma {
            let (n, part) = (self.surrogate.parts.len() as f64, scatter / sigma);
            add(
                &mut self.errors,
                [scatter * (1.0 + n / 3.0), 0.41 * scatter + 0.08 * n * part * scatter, 2.0 * part, 4.0 * part],
            );
            self.sources.push(ErrorSource::Scatter);
        }
    }

    fn powers(&mut self) {
        let nodes = |&d: &usize| Some(self.outcome.fitted[self.c].parts[d]?.degree() + 1);
        let fewest = self.outcome.plan.varying().iter().filter_map(nodes).min().unwrap_or(1);
        self.sources.push(if self.outcome.basis == Basis::Exact {
            ErrorSource::Taylor
        } else {
            ErrorSource::Powers { nodes: fewest }
        });
    }

    fn unchecked(&mut self, hidden: Errors, moments: &Moments) {
        let plan = &self.outcome.plan;
        let parts: Vec<Option<Univariate>> = self.parts().into_iter().flatten().map(Some).collect();
        let independent = Inputs::independent(plan.inputs().shapes().to_vec());
        let curved = || Surrogate { parts: parts.clone(), ..self.surrogate.clone() };
        if self.outcome.order == Order::First {
            let [first, second] = [self.surrogate.contributions(&independent), curved().contributions(&independent)]
                .map(|found| found.map(|found| found.moments));
            if let Some((first, second)) = first.zip(second) {
                add(&mut self.errors, apart(&first, &second));
            }
            self.sources.push(ErrorSource::Curvature);
        }
        add(&mut self.errors, hidden);
        self.powers();
        let variance = moments.variance();
        if variance == 0.0 {
            return;
        }
        let left = self.left_pairs();
        let mut products = self.examined_products();
        let mut share = products.iter().map(|(.., value)| value * value).sum::<f64>() / variance;
        if left > 0 {
            share += self.unexamined(left, (&curved(), &independent), variance, &mut products);
        }
        // Interactions that are extrapolated from others twist as these do.
        let seen: f64 = products.iter().map(|(.., value)| value * value).sum::<f64>() / variance;
        let times = if seen > 0.0 { (share / seen).max(1.0) } else { 1.0 };
        let known: Vec<Univariate> = parts.iter().flatten().copied().collect();
        let [lines, mean] = twists(&known, &products);
        let twisted = times * lines / variance;
        add(&mut self.errors, [times.sqrt() * mean, twisted * moments.sigma(), 3.0 * twisted, 6.0 * twisted]);
        let ratios: f64 = parts.iter().flatten().map(|part| ratio(part, self.surrogate.centre)).sum();
        let factor = (5.0 * ratios).max(share).min(MOST);
        let triples = share * factor;
        if triples > 0.0 {
            let root = share.sqrt() * factor;
            add(
                &mut self.errors,
                [0.0, 0.5 * triples * moments.sigma(), 4.0 * root, 24.0 * triples + 10.0 * triples.sqrt()],
            );
            self.sources.push(ErrorSource::Triples);
        }
    }

    /// Returns the pairs that were examined, in order. Pairs whose interaction was estimated do not count.
    fn examined_pairs(&self) -> Vec<(usize, usize)> {
        let mixed = &self.outcome.fitted[self.c].mixed;
        let own = self.outcome.pairs.iter().zip(mixed.iter().copied().chain(std::iter::repeat(None)));
        let mut examined: Vec<(usize, usize)> = own
            .filter(|(_, mixed)| mixed.is_none_or(|mixed| mixed.origin.is_known()))
            .map(|(&pair, _)| pair)
            .filter(|&(j, k)| self.outcome.plan.joint(self.c, j, k))
            .collect();
        examined.sort_unstable();
        examined
    }

    /// Returns the products of the surface that were examined.
    fn examined_products(&self) -> Vec<(usize, usize, f64)> {
        let mut products = self.surrogate.interactions.pairs();
        if self.outcome.fitted[self.c].screened > 0 {
            let examined = self.examined_pairs();
            products.retain(|&(j, k, _)| examined.binary_search(&(j, k)).is_ok());
        }
        products
    }

    /// Returns the number of pairs that matter to the characteristic and were not examined.
    fn left_pairs(&self) -> usize {
        self.outcome.plan.pairs_of(self.c).saturating_sub(self.examined_pairs().len())
    }

    /// Iterates over the pairs that `left_pairs` counts.
    fn each_left_pair(&self) -> impl Iterator<Item = (usize, usize)> {
        let n = self.outcome.plan.varying().len();
        let examined = self.examined_pairs();
        let all = (0..n).flat_map(move |j| (j + 1..n).map(move |k| (j, k)));
        all.filter(move |&(j, k)| self.outcome.plan.joint(self.c, j, k) && examined.binary_search(&(j, k)).is_err())
    }

    /// Adds the possible effect of interactions that were not examined. Returns the share of the variance that they are assumed to have.
    fn unexamined(
        &mut self,
        pairs: usize,
        (surrogate, independent): (&Surrogate, &Inputs),
        variance: f64,
        products: &mut Vec<(usize, usize, f64)>,
    ) -> f64 {
        if let Some(exact) = self.exact_pairs(pairs) {
            let more = exact.iter().copied();
            let all = products.iter().copied().chain(more).filter(|&(.., value)| value != 0.0);
            let interactions = Interactions::of_pairs(surrogate.parts.len(), all);
            let whole = Surrogate { interactions, ..surrogate.clone() };
            let [whole, without] = [&whole, surrogate].map(|of| Some(of.contributions(independent)?.moments));
            if let Some((whole, without)) = whole.zip(without) {
                add(&mut self.errors, apart(&whole, &without));
            }
            let share = exact.iter().map(|(.., value)| value * value).sum::<f64>() / variance;
            products.extend(exact);
            self.sources.push(ErrorSource::ExactPairs { pairs });
            return share;
        }
        let Some(share) = self.similar_pairs(variance) else {
            self.known = [self.outcome.plan.inputs().correlation().is_none(), false, false, false];
            self.sources.push(ErrorSource::UnknownPairs { pairs });
            return 0.0;
        };
        let sigma = variance.sqrt();
        add(&mut self.errors, [0.0, 0.5 * share * sigma, 4.0 * share.sqrt(), 24.0 * share]);
        self.sources.push(ErrorSource::SimilarPairs { pairs });
        share
    }

    /// Returns the pairs that were not examined, with their interactions in sigmas from exact derivatives. Returns None if there are too
    /// many, or if the assembly function has no such derivatives.
    fn exact_pairs(&self, pairs: usize) -> Option<Vec<(usize, usize, f64)>> {
        let plan = &self.outcome.plan;
        if pairs > EXACT {
            return None;
        }
        let left: Vec<(usize, usize)> = self.each_left_pair().collect();
        let dimensions: Vec<(usize, usize)> =
            left.iter().map(|&(j, k)| (plan.varying()[j], plan.varying()[k])).collect();
        let directions = Directions { point: &plan.centre(), inputs: &[], pairs: &dimensions };
        let outputs = [self.problem.outputs()[self.c]];
        let units = units(&**plan);
        let exponents: Vec<i32> = units.iter().map(|unit| unit.exponent()).collect();
        let function = self.problem.function();
        let derivatives = function.derivatives_per(&outputs, &directions, &exponents).into_iter().next()??;
        let scale = |position: usize| {
            let d = plan.varying()[position];
            units[d].inverse().times(plan.axis(d).scale)
        };
        let scaled = |(&(j, k), value): (&(usize, usize), &Option<f64>)| Some((j, k, scale(j) * scale(k) * (*value)?));
        left.iter().zip(&derivatives.mixed).map(scaled).collect()
    }

    /// Extrapolates the share of the variance of the interactions that were not examined. They are assumed to have the ratio to the shares
    /// of their dimensions that the examined ones have. Returns None if no examined pair has an expected share.
    fn similar_pairs(&self, variance: f64) -> Option<f64> {
        let plan = &self.outcome.plan;
        let own: Vec<f64> = (self.parts()?.iter().zip(plan.inputs().shapes()))
            .map(|(part, shape)| part.term(shape).variance(1.0) / variance)
            .collect();
        let expected =
            |pairs: &mut dyn Iterator<Item = (usize, usize)>| pairs.map(|(j, k)| own[j] * own[k]).sum::<f64>();
        let seen = expected(&mut self.examined_pairs().into_iter());
        if seen <= 0.0 || seen.is_nan() {
            return None;
        }
        let found = self.examined_products().iter().map(|(.., value)| value * value).sum::<f64>() / variance;
        Some(found / seen * expected(&mut self.each_left_pair()))
    }

    /// Adds one rounding of a value in every difference.
    fn rounding(&mut self, moments: &Moments) {
        let one = f64::EPSILON * self.surrogate.centre.abs() * (self.surrogate.parts.len() as f64 + 1.0).sqrt();
        let part = if moments.sigma() > 0.0 { one / moments.sigma() } else { 0.0 };
        add(&mut self.errors, [one, one, 4.0 * part, 8.0 * part]);
    }
}
