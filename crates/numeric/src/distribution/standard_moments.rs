//! Moments of a standardised variable, and the cumulant-like combinations that the moment formulas need.

/// Moments 3 to 8 of `u = (x - mean)/sigma`, with combinations from which the Gaussian part is already removed.
///
/// `excess`, `h6`, `h7` and `h8` are stored instead of derived. A distribution with closed forms for them keeps digits that the subtraction
/// would lose. For a normal distribution they are 0, 8, 0 and 48 exactly.
///
/// ```text
/// excess = m4 - 3
/// h6 = m6 - 3 m4 + 2 - 2 m3^2             = cum(v, v, u, u)   with v = u^2 - 1
/// h7 = m7 - 3 m5 + 6 m3 - 3 m3 m4         = cum(v, v, v, u)
/// h8 = m8 - 4 m6 + 6 m4 - 3 - 3 (m4-1)^2  = cum(v, v, v, v)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandardMoments {
    /// Third moment: the skewness.
    pub skewness: f64,
    /// Fourth moment minus 3: the excess kurtosis.
    pub excess: f64,
    /// Fifth moment.
    pub m5: f64,
    /// Sixth moment.
    pub m6: f64,
    /// Seventh moment.
    pub m7: f64,
    /// Eighth moment.
    pub m8: f64,
    /// Joint cumulant `cum(v, v, u, u)` with `v = u^2 - 1`.
    pub h6: f64,
    /// Joint cumulant `cum(v, v, v, u)` with `v = u^2 - 1`.
    pub h7: f64,
    /// Joint cumulant `cum(v, v, v, v)` with `v = u^2 - 1`.
    pub h8: f64,
}

impl StandardMoments {
    /// Moments of the standard normal distribution.
    pub const NORMAL: Self =
        Self { skewness: 0.0, excess: 0.0, m5: 0.0, m6: 15.0, m7: 0.0, m8: 105.0, h6: 8.0, h7: 0.0, h8: 48.0 };

    /// Standardises central moments `m2 ..= m8` of any scale. `m2` must be above 0.
    ///
    /// The standard deviation is divided out one power at a time, so that no power of it overflows or underflows.
    ///
    /// ```
    /// use sensitol_numeric::distribution::StandardMoments;
    /// // A normal distribution with sigma 2.
    /// let m = StandardMoments::from_central(&[4.0, 0.0, 48.0, 0.0, 960.0, 0.0, 26880.0]);
    /// assert_eq!(m, StandardMoments::NORMAL);
    /// ```
    pub fn from_central(central: &[f64; 7]) -> Self {
        let sigma = central[0].sqrt();
        let standard = |order: usize| {
            let mut moment = central[order - 2];
            for _ in 0..order {
                moment /= sigma;
            }
            moment
        };
        Self::from_standard([3, 4, 5, 6, 7, 8].map(standard))
    }

    /// Collects moments `m3 ..= m8` of a variable that has mean 0 and variance 1.
    pub fn from_standard([m3, m4, m5, m6, m7, m8]: [f64; 6]) -> Self {
        Self {
            skewness: m3,
            excess: m4 - 3.0,
            m5,
            m6,
            m7,
            m8,
            h6: m6 - 3.0 * m4 + 2.0 - 2.0 * m3 * m3,
            h7: m7 - 3.0 * m5 + 6.0 * m3 - 3.0 * m3 * m4,
            h8: m8 - 4.0 * m6 + 6.0 * m4 - 3.0 - 3.0 * (m4 - 1.0) * (m4 - 1.0),
        }
    }

    /// Collects moments `m3, m5 ..= m8` and the excess kurtosis, if that is known more accurately than `m4 - 3`.
    pub(super) fn with_excess(skewness: f64, excess: f64, [m5, m6, m7, m8]: [f64; 4]) -> Self {
        Self { excess, ..Self::from_standard([skewness, 3.0 + excess, m5, m6, m7, m8]) }
    }

    /// Computes moments from standardised cumulants `k3 ..= k8`. Nothing is subtracted, so that a nearly normal distribution keeps the
    /// digits of its difference from the normal one.
    ///
    /// ```
    /// use sensitol_numeric::distribution::StandardMoments;
    /// // Exponential: k_n = (n - 1)!
    /// let m = StandardMoments::from_cumulants([2.0, 6.0, 24.0, 120.0, 720.0, 5040.0]);
    /// assert_eq!((m.kurtosis(), m.m5, m.m8), (9.0, 44.0, 14833.0));
    /// ```
    pub fn from_cumulants([k3, k4, k5, k6, k7, k8]: [f64; 6]) -> Self {
        Self {
            skewness: k3,
            excess: k4,
            m5: k5 + 10.0 * k3,
            m6: k6 + 15.0 * k4 + 10.0 * k3 * k3 + 15.0,
            m7: k7 + 21.0 * k5 + 35.0 * k3 * k4 + 105.0 * k3,
            m8: k8 + 28.0 * k6 + 56.0 * k3 * k5 + 35.0 * k4 * k4 + 210.0 * k4 + 280.0 * k3 * k3 + 105.0,
            h6: k6 + 12.0 * k4 + 8.0 * k3 * k3 + 8.0,
            h7: k7 + 18.0 * k5 + 32.0 * k3 * k4 + 72.0 * k3,
            h8: k8 + 24.0 * k6 + 56.0 * k3 * k5 + 32.0 * k4 * k4 + 144.0 * k4 + 240.0 * k3 * k3 + 48.0,
        }
    }

    /// Moments of a distribution with Pearson's equation `(1 + c1 u + c2 u^2) p' = -(c1 + (1 + 3 c2) u) p` and `c2 <= 0`: beta and gamma.
    ///
    /// Formula: `m[n+1] = n (m[n-1] + c1 m[n]) / (1 - (n-1) c2)`, all of one sign. The excess is `3 (c1 m3 + 2 c2)/(1 - 2 c2)`.
    pub(super) fn of_pearson(c1: f64, c2: f64) -> Self {
        let mut m = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for n in 2..8 {
            let order = n as f64;
            m[n + 1] = order * (m[n - 1] + c1 * m[n]) / (1.0 - (order - 1.0) * c2);
        }
        let excess = 3.0 * (c1 * m[3] + 2.0 * c2) / (1.0 - 2.0 * c2);
        Self::with_excess(m[3], excess, [m[5], m[6], m[7], m[8]])
    }

    /// True if every moment is a finite number.
    pub fn are_finite(&self) -> bool {
        let of_fourth_powers = [self.h6, self.h7, self.h8];
        self.raw().iter().chain(&of_fourth_powers).all(|moment| moment.is_finite())
    }

    /// Fourth moment: the kurtosis, 3 for a normal distribution.
    pub fn kurtosis(&self) -> f64 {
        3.0 + self.excess
    }

    /// Moments `m0 ..= m8` in order: 1, 0, 1, skewness, kurtosis and so on.
    pub fn raw(&self) -> [f64; 9] {
        [1.0, 0.0, 1.0, self.skewness, self.kurtosis(), self.m5, self.m6, self.m7, self.m8]
    }
}
