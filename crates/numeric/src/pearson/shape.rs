//! The coefficients of Pearson's equation from skewness and kurtosis, and what their signs say.

use std::fmt;

use super::PearsonError;
use crate::elementary::Double;

/// The members of the Pearson system, as people know them. A label: nothing is computed by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PearsonType {
    /// Skewness 0, kurtosis 3.
    Normal,
    /// Beta, on a bounded interval.
    I,
    /// Symmetric beta.
    II,
    /// Gamma: on the line between types I and VI.
    III,
    /// On the whole line, skewed.
    IV,
    /// Inverse gamma: on the line between types IV and VI.
    V,
    /// Beta prime, on a half line.
    VI,
    /// Student's t.
    VII,
}

impl PearsonType {
    /// As in the literature: `normal`, `I` to `VII`.
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

/// Below this a skewness, or the coefficient of the square, changes no digit of any result.
const NOTHING: f64 = 1e-100;
/// Above this kurtosis the square of a coefficient leaves the range of a double.
const LARGEST: f64 = 1e100;

/// Pearson's equation `(1 + c1 z + c2 z^2) p' = -(c1 + d z) p` of a law with mean 0, variance 1 and this skewness, which is
/// not negative; `d = 1 + 3 c2`.
///
/// Every coefficient is computed in twice the precision of a double and rounded once: what tells the types apart are
/// small differences of large terms.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    pub(super) kind: PearsonType,
    /// Coefficient of z.
    pub(super) c1: f64,
    /// Coefficient of z squared.
    pub(super) c2: f64,
    /// Slope of the right-hand side.
    pub(super) d: f64,
    pub(super) roots: Roots,
}

/// Where `1 + c1 z + c2 z^2` is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Roots {
    /// Nowhere: the normal.
    None,
    /// At two places: the support begins at `near`, and ends at `far` where that is positive.
    Real {
        /// The negative root next to 0.
        near: f64,
        /// The other one, an infinity where there is none.
        far: f64,
        /// How the density ends at the two.
        ends: [End; 2],
    },
    /// Twice at one place, where the support begins.
    Double {
        /// The place.
        at: f64,
    },
    /// At `centre ± i width`.
    Complex {
        /// Real part.
        centre: f64,
        /// Imaginary part.
        width: f64,
    },
}

/// An end of the support as the density sees it: `p ~ x^(alpha - 1) (1 - k x)^(b - 1)` at distance `x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// Exponent, above 0; large where the density is flat there.
    pub(super) alpha: f64,
    /// One over the distance to the other root, negative when that lies outside.
    pub(super) k: f64,
    /// `b k`, which stays finite where the other root goes to infinity and `b` with it.
    pub(super) bk: f64,
}

/// How a Pearson law falls off towards infinity: `p ~ w^-(r+2) sum_i d_i w^-i` with `w = z - centre`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Infinity {
    pub(super) centre: f64,
    /// Square of half the distance of the two roots, with its sign turned: positive for complex ones.
    pub(super) kappa2: f64,
    pub(super) r: f64,
}

impl Shape {
    /// `kurtosis` is the sum of its two numbers, so that an excess keeps its digits.
    pub(super) fn new(skewness: f64, kurtosis: [f64; 2]) -> Result<Self, PearsonError> {
        if !skewness.is_finite() || !kurtosis.iter().all(|part| part.is_finite()) {
            return Err(PearsonError::NotFinite);
        }
        let s = if skewness < NOTHING { 0.0 } else { skewness };
        let rounded = kurtosis[0] + kurtosis[1];
        // Far outside: the square of the skewness would overflow.
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

    /// The derivatives of `c1` and `c2` by the skewness, and by the excess.
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

    /// The tail towards infinity, where the law has one that falls off as a power.
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

/// All forms stay finite and exact where the second coefficient goes through 0 and the far root through infinity.
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
        // Both ends alike, to the last bit.
        let (far, end) = (2.0 * c0 / root, End { alpha: -3.0 * gap / second, k: -second / root, bk: 3.0 * gap / root });
        return Roots::Real { near: -far, far, ends: [end, end] };
    }
    let q = -0.5 * (first + root);
    let near = c0 / q;
    // Infinite where the second coefficient is 0, and then on the right.
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
