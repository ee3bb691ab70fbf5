//! Exact first four moments of a quadratic, or of univariate parts with products, in independent inputs.
//!
//! ```text
//! y = c + sum_j g_j(u_j) + sum_{j<k} A_jk u_j u_k        u_j independent, mean 0, variance 1
//! ```
//!
//! The univariate parts `g_j` are arbitrary. For the second-order model they are `g_j = b_j u_j + a_j (u_j^2 - 1)`. The third and fourth
//! moment are sums of joint cumulants (connected diagrams). Thus the Gaussian part of the fourth moment, `3 sigma^4`, is never formed and
//! subtracted. All coefficients are divided by sigma first, so that no scale overflows.
//!
//! Cost: one product `W = A A`, which is `O(N^3)` if dense and `O(sum of squared degrees)` if sparse, and `O(N^2)` besides.
//!
//! Source: the improved second-order method of Sadikhani and Hashemian (2018) and Glancy and Chase (1999, method of system moments), by
//! another derivation. Equations 8 to 10 and 18 to 25 of the 2018 paper have misprints that are not reproduced (see
//! `examples/stacked-blocks/README.md`).

mod cumulants;
mod interactions;
mod moment_slopes;
mod pairwise;
mod part;
mod sum;

pub(crate) use crate::moments::moment_slopes::growths;
pub use interactions::Interactions;
pub(crate) use interactions::Row;
pub use pairwise::Tables;
pub use part::{JointCumulants, Term};
pub use sum::exact;

use serde::Serialize;

use std::collections::BTreeMap;

use crate::distribution::StandardMoments;
use crate::json_form::Four;
use crate::moments::cumulants::Assembly;
use crate::power::rescale;

/// Mean, sigma, skewness and kurtosis of one characteristic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    mean: f64,
    sigma: f64,
    shape: Option<(f64, f64)>,
}

rescale!(Moments { mean, sigma } without { shape });
rescale!(Sampled { sigma } without { samples, skewness, kurtosis });

impl From<&Option<Moments>> for Four<Option<f64>> {
    fn from(moments: &Option<Moments>) -> Self {
        Self {
            mean: moments.map(|of| of.mean),
            sigma: moments.map(|of| of.sigma),
            skewness: moments.and_then(|of| of.skewness()),
            kurtosis: moments.and_then(|of| of.kurtosis()),
        }
    }
}

impl Serialize for Moments {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Four::from(&Some(*self)).serialize(serializer)
    }
}

impl Moments {
    /// Moments of a characteristic that varies.
    pub fn new(mean: f64, sigma: f64, skewness: f64, excess: f64) -> Self {
        Self { mean, sigma, shape: Some((skewness, excess)) }
    }

    /// Moments of a characteristic with the same value in every assembly: it has no skewness and no kurtosis.
    pub fn constant(mean: f64) -> Self {
        Self { mean, sigma: 0.0, shape: None }
    }

    /// Expected value.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Second central moment.
    pub fn variance(&self) -> f64 {
        self.sigma * self.sigma
    }

    /// Third standardised moment. Returns None if sigma is 0, or if the tail of an input makes it infinite.
    pub fn skewness(&self) -> Option<f64> {
        self.shape.map(|(skewness, _)| skewness).filter(|skewness| skewness.is_finite())
    }

    /// Fourth standardised moment, 3 for a normal. Returns None if sigma is 0, or if the tail of an input makes it infinite.
    pub fn kurtosis(&self) -> Option<f64> {
        self.excess().map(|excess| 3.0 + excess)
    }

    /// Fourth standardised moment minus 3, with the digits that the kurtosis of a nearly normal distribution has lost. Returns None if
    /// there is no kurtosis.
    pub fn excess(&self) -> Option<f64> {
        self.shape.map(|(_, excess)| excess).filter(|excess| excess.is_finite())
    }
}

/// Moments of a sum of terms and products, and the contribution of each.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Contributions {
    /// Moments of the whole sum.
    pub moments: Moments,
    /// Share of the variance that a straight line explains, for every term.
    pub linear: Vec<f64>,
    /// Share of the remaining variance of its own, for every term.
    pub curvature: Vec<f64>,
    /// Shift of the mean by every term.
    pub mean_shift: Vec<f64>,
    /// Factor that turns a coefficient into a number whose square is a share of the variance. 0 if sigma is 0.
    pub per_sigma: f64,
    /// Share of every product `j < k`, if inputs are correlated and shares are not squares of coefficients. None otherwise.
    pub products: Option<BTreeMap<(usize, usize), f64>>,
    /// Standard errors of sampling. None if everything is exact.
    pub sampled: Option<Sampled>,
}

/// Standard errors of moments that were sampled from a surrogate, not from the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Sampled {
    /// Number of points sampled.
    pub samples: usize,
    /// Standard error of sigma.
    pub sigma: f64,
    /// Standard error of the skewness.
    pub skewness: f64,
    /// Standard error of the kurtosis.
    pub kurtosis: f64,
}

impl Contributions {
    /// Share of the product of two inputs with this coefficient.
    pub fn share(&self, j: usize, k: usize, coefficient: f64) -> f64 {
        match &self.products {
            None => (coefficient * self.per_sigma).powi(2),
            Some(products) => products.get(&(j.min(k), j.max(k))).copied().unwrap_or(0.0),
        }
    }

    /// Contributions after an independent part with this standard deviation is added. The part is assumed normal.
    pub fn beside(self, sigma: f64) -> Self {
        let sigma = libm::hypot(self.moments.sigma(), sigma);
        if sigma == self.moments.sigma() {
            return self;
        }
        let part = self.moments.sigma() / sigma;
        let (skewness, excess) = self.moments.shape.unwrap_or((0.0, 0.0));
        let shares = |shares: Vec<f64>| shares.into_iter().map(|share| share * part * part).collect();
        let products = self.products.map(|mut products| {
            products.values_mut().for_each(|share| *share = *share * part * part);
            products
        });
        Self {
            moments: Moments::new(self.moments.mean(), sigma, skewness * part.powi(3), excess * part.powi(4)),
            linear: shares(self.linear),
            curvature: shares(self.curvature),
            per_sigma: self.per_sigma * part,
            products,
            ..self
        }
    }

    /// Contributions with another mean, and all else unchanged.
    pub(crate) fn about(self, mean: f64) -> Self {
        Self { moments: Moments { mean, ..self.moments }, ..self }
    }
}

/// Moments of `constant + sum_j term_j + sum_{j<k} A_jk u_j u_k`, with the contributions of the terms.
///
/// Shapes: `terms` has length N, `interactions` is N by N. Accuracy: 1e-12 relative against exact rationals, at any scale of the
/// coefficients. If terms cancel, so that sigma is a part q of the largest of them, the kurtosis is accurate to `q^-4` roundings only. Line
/// and parabola of an input with only two values cancel in this way.
///
/// ```
/// use sensitol_numeric::distribution::StandardMoments;
/// use sensitol_numeric::moments::{Interactions, Term, contributions};
/// // y = u1 u2 of two normal inputs: kurtosis 9.
/// let normal = &StandardMoments::NORMAL;
/// let nothing = Term::Quadratic { linear: 0.0, curvature: 0.0, moments: normal };
/// let product = Interactions::of_pairs(2, [(0, 1, 1.0)]);
/// let moments = contributions(0.0, &[nothing.clone(), nothing], &product).moments;
/// assert_eq!((moments.sigma(), moments.skewness(), moments.kurtosis()), (1.0, Some(0.0), Some(9.0)));
/// ```
pub fn contributions(constant: f64, terms: &[Term<'_>], interactions: &Interactions) -> Contributions {
    assert_eq!(terms.len(), interactions.dimensions(), "as many terms as the interactions have rows");
    let mean_shift: Vec<f64> = terms.iter().map(Term::mean).collect();
    let mean = sum::exact([constant].into_iter().chain(mean_shift.iter().copied()));
    let Some((sigma, per_sigma)) = unit_of(terms, interactions) else {
        let none = vec![0.0; terms.len()];
        let moments = Moments::constant(mean);
        return Contributions {
            moments,
            linear: none.clone(),
            curvature: none,
            mean_shift,
            per_sigma: 0.0,
            products: None,
            sampled: None,
        };
    };
    let parts: Vec<JointCumulants> = terms.iter().map(|term| term.part(per_sigma)).collect();
    let assembly = Assembly::of(&parts, interactions, per_sigma);
    Contributions {
        moments: Moments::new(mean, sigma, assembly.skewness, assembly.excess),
        linear: parts.iter().map(|part| part.p * part.p).collect(),
        curvature: parts.iter().map(|part| part.curved).collect(),
        mean_shift,
        per_sigma,
        products: None,
        sampled: None,
    }
}

/// Sigma, and the factor for the coefficients that makes sigma 1. Returns None if nothing varies.
fn unit_of(terms: &[Term<'_>], interactions: &Interactions) -> Option<(f64, f64)> {
    let largest = terms.iter().map(Term::largest).fold(interactions.largest(), f64::max);
    if largest == 0.0 {
        return None;
    }
    // Divide by the largest coefficient first and then by sigma, so that no square overflows or underflows.
    let variances = terms.iter().map(|term| term.variance(1.0 / largest));
    let relative = (sum::exact(variances) + interactions.variance(1.0 / largest)).sqrt();
    Some((largest * relative, 1.0 / largest / relative))
}

/// Moments of a second-order model, the case of the published methods: `y = c + sum_j [b_j u_j + a_j (u_j^2 - 1)] + sum_{j<k} A_jk u_j
/// u_k`.
///
/// Shapes: `linear` (`b`), `curvature` (`a`) and `inputs` have length N. With derivatives of a function `F` at the means,
/// `b_j = sd_j dF/dx_j`, `a_j = sd_j^2/2 d2F/dx_j^2`, `A_jk = sd_j sd_k d2F/dx_j dx_k`, and `c = F + sum_j a_j` is the mean.
///
/// ```
/// use sensitol_numeric::distribution::StandardMoments;
/// use sensitol_numeric::moments::{Interactions, of_quadratic};
/// // u^2 - 1 of a normal input is chi-squared with one degree of freedom: skewness sqrt 8, kurtosis 15.
/// let moments = of_quadratic(0.0, &[0.0], &[1.0], &Interactions::none(1), &[StandardMoments::NORMAL]);
/// assert!((moments.skewness().unwrap() - 8f64.sqrt()).abs() < 1e-14);
/// assert!((moments.kurtosis().unwrap() - 15.0).abs() < 1e-13);
/// ```
pub fn of_quadratic(
    mean: f64,
    linear: &[f64],
    curvature: &[f64],
    interactions: &Interactions,
    inputs: &[StandardMoments],
) -> Moments {
    let terms: Vec<Term<'_>> = (linear.iter().zip(curvature).zip(inputs))
        .map(|((&linear, &curvature), moments)| Term::Quadratic { linear, curvature, moments })
        .collect();
    let moments = contributions(0.0, &terms, interactions).moments;
    Moments { mean, ..moments }
}
