//! Coefficients of Pearson's equation from skewness and kurtosis, and the type that follows from their signs.

use std::fmt;

use crate::elementary::Double;
use crate::pearson::PearsonError;

/// Classical types of the Pearson system. A label: no computation uses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PearsonType {
    /// Normal distribution: skewness 0, kurtosis 3.
    Normal,
    /// Beta distribution, on a bounded interval.
    I,
    /// Symmetric beta distribution, on a bounded interval.
    II,
    /// Gamma distribution: on the line between types I and VI.
    III,
    /// Skewed distribution on the whole line.
    IV,
    /// Inverse gamma distribution: on the line between types IV and VI.
    V,
    /// Beta prime distribution, on a half line.
    VI,
    /// Student's t distribution, scaled to variance 1.
    VII,
}

impl PearsonType {
    /// Name in the literature: `normal`, `I` to `VII`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::I => "I",
            Self::II => "II",
            Self::III => "III",
            Self::IV => "IV",
            Self::V => "V",
            Self::VI => "VI",
            Self::VII => "VII",
        }
    }
}

impl fmt::Display for PearsonType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Bound for the skewness and the quadratic coefficient. Smaller values are treated as 0, since they change no digit of any result.
const NOTHING: f64 = 1e-100;
/// Greatest kurtosis. Above it the square of a coefficient overflows.
const LARGEST: f64 = 1e100;

/// Pearson's equation `(1 + c1 z + c2 z^2) p' = -(c1 + d z) p` for mean 0, variance 1 and a skewness that is not negative. `d = 1 + 3 c2`.
///
/// Every coefficient is computed in twice the precision of a double and rounded once, since small differences of large terms separate the
/// types.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    pub(super) kind: PearsonType,
    pub(super) c1: f64,
    pub(super) c2: f64,
    /// Slope of the right-hand side.
    pub(super) d: f64,
    pub(super) roots: Roots,
}

/// Roots of `1 + c1 z + c2 z^2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Roots {
    /// No root: the normal distribution.
    None,
    /// Two real roots. The support begins at `near`, and ends at `far` if that is positive.
    Real {
        /// Negative root next to 0.
        near: f64,
        /// Other root, infinite if there is none.
        far: f64,
        /// Form of the density at `near` and `far`.
        ends: [End; 2],
    },
    /// Double root, at which the support begins.
    Double { at: f64 },
    /// Complex roots `centre ± i width`.
    Complex { centre: f64, width: f64 },
}

/// Form of the density at an end of the support: `p ~ x^(alpha - 1) (1 - k x)^(b - 1)` at distance `x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// Exponent, above 0. It is large if the density is flat there.
    pub(super) alpha: f64,
    /// One over the distance to the other root, negative if that lies outside.
    pub(super) k: f64,
    /// Product `b k`, which stays finite if the other root and with it `b` go to infinity.
    pub(super) bk: f64,
}

/// Decay of a Pearson distribution towards infinity: `p ~ w^-(r+2) sum_i d_i w^-i` with `w = z - centre`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Infinity {
    pub(super) centre: f64,
    /// Square of half the distance of the two roots, with its sign turned: positive for complex ones.
    pub(super) kappa2: f64,
    pub(super) r: f64,
}

impl Shape {
    /// Shape from skewness and kurtosis. `kurtosis` is the sum of its two numbers, so that an excess keeps its digits.
    pub(super) fn new(skewness: f64, kurtosis: [f64; 2]) -> Result<Self, PearsonError> {
        if !skewness.is_finite() || !kurtosis.iter().all(|part| part.is_finite()) {
            return Err(PearsonError::NotFinite);
        }
        let s = if skewness < NOTHING { 0.0 } else { skewness };
        let rounded = kurtosis[0] + kurtosis[1];
        // Reject early: the square of the skewness would overflow.
        if s >= rounded.max(1.0) {
            return Err(PearsonError::infeasible(skewness, rounded));
        }
        if rounded > LARGEST {
            return Err(PearsonError::TooLarge { kurtosis: rounded });
        }
        let b2 = Double::sum(kurtosis[0], kurtosis[1]);
        let b1 = Double::product(s, s);
        let gap = f64::from(b2 - 1.0 - b1);
        if gap <= 0.0 {
            return Err(PearsonError::infeasible(skewness, rounded));
        }
        let c0 = 4.0 * b2 - 3.0 * b1;
        let first = (b2 + 3.0) * s;
        let mut second = 2.0 * (b2 - 3.0) - 3.0 * b1;
        if f64::from(second).abs() < NOTHING {
            second = Double::from(0.0);
        }
        let discriminant = f64::from(first * first - 4.0 * c0 * second);
        let [c0, first, second] = [c0, first, second].map(f64::from);
        Ok(Self {
            kind: kind(s, second, discriminant),
            c1: first / c0,
            c2: second / c0,
            d: 1.0 + 3.0 * (second / c0),
            roots: roots(s, gap, c0, first, second, discriminant),
        })
    }

    /// Derivatives of `c1` and `c2`, by skewness and by excess.
    pub(super) fn growth(skewness: f64, excess: f64) -> [[f64; 2]; 2] {
        let square = skewness * skewness;
        let c0 = 12.0 + 4.0 * excess - 3.0 * square;
        let (first, second) = ((6.0 + excess) * skewness, 2.0 * excess - 3.0 * square);
        let quotient = |c0_by: f64, first_by: f64, second_by: f64| {
            [(first_by - first / c0 * c0_by) / c0, (second_by - second / c0 * c0_by) / c0]
        };
        let by = -6.0 * skewness;
        [quotient(by, 6.0 + excess, by), quotient(4.0, skewness, 2.0)]
    }

    /// Tail towards infinity. Returns None if the distribution has no tail that decays as a power.
    pub(super) fn infinity(&self) -> Option<Infinity> {
        if self.c2 <= 0.0 {
            return None;
        }
        let (centre, kappa2) = match self.roots {
            Roots::Complex { centre, width } => (centre, width * width),
            Roots::Double { at } => (at, 0.0),
            Roots::Real { near, ends, .. } => {
                let half = 0.5 / ends[0].k.abs();
                (near - half, -half * half)
            }
            Roots::None => return None,
        };
        Some(Infinity { centre, kappa2, r: self.d / self.c2 - 2.0 })
    }
}

fn kind(s: f64, second: f64, discriminant: f64) -> PearsonType {
    let symmetric = s == 0.0;
    if second == 0.0 {
        return if symmetric { PearsonType::Normal } else { PearsonType::III };
    }
    match (second < 0.0, symmetric) {
        (true, true) => PearsonType::II,
        (true, false) => PearsonType::I,
        (false, true) => PearsonType::VII,
        (false, false) if discriminant > 0.0 => PearsonType::VI,
        (false, false) if discriminant < 0.0 => PearsonType::IV,
        _ => PearsonType::V,
    }
}

/// Roots in forms that stay finite and exact if the quadratic coefficient goes through 0 and the far root through infinity.
fn roots(s: f64, gap: f64, c0: f64, first: f64, second: f64, discriminant: f64) -> Roots {
    if s == 0.0 && second == 0.0 {
        return Roots::None;
    }
    if discriminant < 0.0 {
        return Roots::Complex { centre: -first / (2.0 * second), width: (-discriminant).sqrt() / (2.0 * second) };
    }
    if discriminant == 0.0 {
        return Roots::Double { at: -first / (2.0 * second) };
    }
    let root = discriminant.sqrt();
    if s == 0.0 {
        // Both ends are equal to the last bit.
        let (far, end) = (2.0 * c0 / root, End { alpha: -3.0 * gap / second, k: -second / root, bk: 3.0 * gap / root });
        return Roots::Real { near: -far, far, ends: [end, end] };
    }
    let q = -0.5 * (first + root);
    let near = c0 / q;
    // Infinite if the quadratic coefficient is 0, and then on the right.
    let far = if second == 0.0 { f64::INFINITY } else { q / second };
    let delta = s * (3.0 * gap - second) / root;
    let alpha = 12.0 * gap * (6.0 * gap - second) / (discriminant * (1.0 + delta));
    let beta = -3.0 * gap * (1.0 + delta) / second;
    let k = -second / root;
    Roots::Real {
        near,
        far,
        ends: [End { alpha, k, bk: 3.0 * gap * (1.0 + delta) / root }, End { alpha: beta, k, bk: alpha * k }],
    }
}
