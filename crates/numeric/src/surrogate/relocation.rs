//! Change of a surrogate to inputs with another mean and sigma.

use crate::surrogate::{Surrogate, Univariate};

/// Move of an input's distribution: `u = shift + stretch v`, in the old sigmas about the old mean, with `v` standardised anew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relocation {
    /// Move of the mean, in old sigmas.
    pub shift: f64,
    /// New sigma, in old sigmas.
    pub stretch: f64,
}

impl Relocation {
    /// Relocation of an input that does not move.
    pub const NONE: Self = Self { shift: 0.0, stretch: 1.0 };
}

impl Surrogate {
    /// Surrogate as the same function of the dimensions, in terms of the moved inputs `v`.
    ///
    /// A part is expanded about its new mean. A product `A_jk u_j u_k` becomes `A_jk (d_j d_k + d_j r_k v_k + d_k r_j v_j + r_j r_k v_j
    /// v_k)` with shifts `d` and stretches `r`. Thus an interaction turns into a slope of `k` if the mean of `j` moves.
    ///
    /// Shapes: `moved` has length N. No evaluation is needed.
    ///
    /// ```
    /// use sensitol_numeric::moments::Interactions;
    /// use sensitol_numeric::surrogate::{Surrogate, Univariate};
    /// use sensitol_numeric::surrogate::Relocation;
    /// // y = u0 + u0 u1, and the mean of u1 moves by half a sigma: y = 1.5 u0 + u0 v1.
    /// let parts = vec![Some(Univariate::of_coefficients(&[1.0])), Some(Univariate::of_coefficients(&[0.0]))];
    /// let product = Interactions::of_pairs(2, [(0, 1, 1.0)]);
    /// let moved = Surrogate { centre: 0.0, parts, interactions: product }
    ///     .relocated(&[Relocation::NONE, Relocation { shift: 0.5, stretch: 1.0 }]);
    /// assert_eq!(moved.parts[0].unwrap().slope(), 1.5);
    /// ```
    pub fn relocated(&self, moved: &[Relocation]) -> Self {
        let interactions = &self.interactions;
        let mut centre = self.centre;
        let mut parts = Vec::with_capacity(self.parts.len());
        for (j, (part, to)) in self.parts.iter().zip(moved).enumerate() {
            let slope: f64 = interactions.neighbours(j).map(|(k, a)| a * moved[k].shift).sum();
            // Halve the term, since the loop meets every product from both of its sides.
            centre += 0.5 * slope * to.shift;
            parts.push(part.map(|part| {
                let (constant, part) = part.relocated(*to);
                centre += constant;
                part.with_slope(slope * to.stretch)
            }));
        }
        let stretches: Vec<f64> = moved.iter().map(|to| to.stretch).collect();
        Self { centre, parts, interactions: interactions.scaled(&stretches) }
    }
}

impl Univariate {
    /// Expansion `g(shift + stretch v) = constant + part(v)`.
    fn relocated(&self, to: Relocation) -> (f64, Self) {
        if to == Relocation::NONE {
            return (0.0, *self);
        }
        let constant = self.value(to.shift);
        let [c1, c2, c3, c4] = self.coefficients;
        let (d, r) = (to.shift, to.stretch);
        // Taylor's series, which is finite: derivatives at the new mean, divided by factorials.
        let first = c1 + d * (2.0 * c2 + d * (3.0 * c3 + d * 4.0 * c4));
        let second = c2 + d * (3.0 * c3 + d * 6.0 * c4);
        let third = c3 + d * 4.0 * c4;
        let coefficients = [r * first, r * r * second, r * r * r * third, r * r * r * r * c4];
        (constant, Self { coefficients, ..*self })
    }

    /// Adds to the coefficient of the square.
    pub fn with_curvature(mut self, more: f64) -> Self {
        self.coefficients[1] += more;
        self
    }

    /// Sets coefficients of higher powers to 0 if they are at most `least` in size.
    pub(crate) fn without_bends(mut self, least: f64) -> Self {
        self.coefficients[1..].iter_mut().filter(|c| c.abs() <= least).for_each(|c| *c = 0.0);
        self
    }

    /// Adds to the slope.
    pub fn with_slope(mut self, more: f64) -> Self {
        self.coefficients[0] += more;
        self
    }
}
