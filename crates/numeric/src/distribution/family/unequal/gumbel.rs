//! Gumbel distributions of largest and of smallest values.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use crate::distribution::family::discretised::{Discretised, ORDER, legendre};
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, positive,
};

/// Euler's constant: the distance of the mean from the mode, in scales (OEIS A001620).
const EULER: f64 = 0.577_215_664_901_532_9;
/// Values of Riemann's zeta function at 3 to 8 (OEIS A002117, A013662 to A013666).
const ZETA: [f64; 6] = [
    1.202_056_903_159_594_3,
    1.082_323_233_711_138_2,
    1.036_927_755_143_37,
    1.017_343_061_984_449_2,
    1.008_349_277_381_922_8,
    1.004_077_356_197_944_3,
];
/// Ends of the quadrature in scales from the mode: beyond them the density times any power of the order that is kept is below 1e-17.
const ENDS: [i32; 2] = [-5, 130];
/// Nodes of the quadrature in each piece, one scale wide.
const NODES: usize = 16;

/// End of a sample that a Gumbel distribution describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExtremeEnd {
    /// Largest of many values: the long tail is above.
    Largest,
    /// Smallest of many values: the long tail is below.
    Smallest,
}

/// Gumbel distribution: the largest or the smallest of many values whose own tails fall exponentially, such as the deepest of many
/// scratches.
///
/// Formula: `F(x) = exp(-exp(-(x - mode)/scale))` of the largest, with `mean = mode + 0.5772 scale` and `sigma = pi/sqrt(6) scale`. That of the
/// smallest is its mirror image. All cumulants are known: `(n - 1)! zeta(n) scale^n`.
///
/// Source: Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions 2 (1995), chapter 22.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, ExtremeEnd, Gumbel};
/// let scratch = Gumbel::new(ExtremeEnd::Largest, 8.0, 1.5)?;
/// assert!((scratch.standard_moments().skewness - 1.139_547_099_404_648_7).abs() < 1e-14);
/// // The probability below the mode is 1/e.
/// let mode = 8.0 - 0.577_215_664_901_532_9 * 1.5 * 6f64.sqrt() / std::f64::consts::PI;
/// let law = scratch.probability().expect("it is known whole");
/// assert!((law.cdf(mode) - (-1f64).exp()).abs() < 1e-14);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Gumbel {
    end: ExtremeEnd,
    mean: f64,
    sigma: f64,
}

impl Gumbel {
    /// Distribution with this mean and sigma above 0.
    ///
    /// # Errors
    /// Returns an error if a parameter is not finite, or if sigma is not above 0.
    pub fn new(end: ExtremeEnd, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        Ok(Self { end, mean: finite("mean", mean)?, sigma: positive("sigma", sigma)? })
    }

    fn scale(&self) -> f64 {
        self.sigma * 6f64.sqrt() / PI
    }

    /// 1 of largest values, -1 of smallest.
    fn sign(&self) -> f64 {
        if self.end == ExtremeEnd::Largest { 1.0 } else { -1.0 }
    }

    /// Distance from the mode in scales, positive towards the long tail.
    fn y(&self, x: f64) -> f64 {
        self.sign() * (x - self.mean) / self.scale() + EULER
    }

    fn x(&self, y: f64) -> f64 {
        self.mean + self.sign() * self.scale() * (y - EULER)
    }

    /// Probability on the side of the short tail.
    fn short(&self, x: f64) -> f64 {
        libm::exp(-libm::exp(-self.y(x)))
    }

    /// Probability on the side of the long tail.
    fn long(&self, x: f64) -> f64 {
        -libm::expm1(-libm::exp(-self.y(x)))
    }

    fn with_short(&self, p: f64) -> f64 {
        self.x(-libm::log(-libm::log(checked(p))))
    }

    fn with_long(&self, p: f64) -> f64 {
        self.x(-libm::log(-libm::log1p(-checked(p))))
    }
}

/// Recurrence of the standardised distribution of largest values.
fn recurrence() -> &'static Jacobi {
    static RECURRENCE: OnceLock<Jacobi> = OnceLock::new();
    RECURRENCE.get_or_init(|| {
        let (mut points, rule) = (Discretised::default(), legendre(NODES));
        for from in ENDS[0]..ENDS[1] {
            let ends = [f64::from(from), f64::from(from) + 1.0];
            points.piece(ends, &rule, |y| libm::exp(-y - libm::exp(-y)));
        }
        points.standardise();
        points.jacobi(ORDER)
    })
}

impl Distribution for Gumbel {
    fn name(&self) -> &'static str {
        match self.end {
            ExtremeEnd::Largest => "gumbel-largest",
            ExtremeEnd::Smallest => "gumbel-smallest",
        }
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments from the cumulants `(n - 1)! zeta(n) (sqrt(6)/pi)^n`.
    fn standard_moments(&self) -> StandardMoments {
        let (mut factorial, mut power) = (1.0, 6.0 / (PI * PI));
        let mut cumulants = [0.0; 6];
        for (place, zeta) in ZETA.into_iter().enumerate() {
            let order = place as f64 + 3.0;
            factorial *= order - 1.0;
            power *= self.sign() * 6f64.sqrt() / PI;
            cumulants[place] = factorial * zeta * power;
        }
        StandardMoments::from_cumulants(cumulants)
    }

    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        let largest = recurrence().truncated(order);
        if self.end == ExtremeEnd::Largest { largest } else { largest.mirrored() }
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::new(self.end, self.mean + moved, self.sigma * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Gumbel {
    fn density(&self, x: f64) -> Option<f64> {
        let y = self.y(x);
        Some(libm::exp(-y - libm::exp(-y)) / self.scale())
    }

    fn cdf(&self, x: f64) -> f64 {
        if self.end == ExtremeEnd::Largest { self.short(x) } else { self.long(x) }
    }

    fn sf(&self, x: f64) -> f64 {
        if self.end == ExtremeEnd::Largest { self.long(x) } else { self.short(x) }
    }

    fn quantile(&self, p: f64) -> f64 {
        if self.end == ExtremeEnd::Largest { self.with_short(p) } else { self.with_long(p) }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        if self.end == ExtremeEnd::Largest { self.with_long(p) } else { self.with_short(p) }
    }
}
