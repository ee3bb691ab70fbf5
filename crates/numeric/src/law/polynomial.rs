//! Quartics: values, extremes and real roots.

/// Coefficients of `c[0] + c[1] z + ... + c[4] z^4`.
pub(super) type Quartic = [f64; 5];

/// Value of the polynomial at `z`.
#[inline(always)]
pub(super) fn value(c: &Quartic, z: f64) -> f64 {
    (((c[4] * z + c[3]) * z + c[2]) * z + c[1]) * z + c[0]
}

pub(super) fn derivative(c: &Quartic) -> Quartic {
    [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0]
}

/// Up to four real numbers in ascending order: roots, or the boundaries between which a function is monotone.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Few {
    values: [f64; 4],
    count: usize,
}

impl Few {
    pub(super) fn push(&mut self, value: f64) {
        if self.count < self.values.len() {
            self.values[self.count] = value;
            self.count += 1;
        }
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Arguments between `low` and `high` at which the polynomial changes its sign, ascending.
///
/// Lines and parabolas are solved in closed form. A higher degree is solved between its extremes, where it is monotone, by Newton's method
/// between bounds. A double root is left out because the sign does not change there.
pub(super) fn roots(c: &Quartic, interval: [f64; 2]) -> Few {
    of_degree(4, c, interval)
}

/// Monotone pieces of a polynomial over an interval. They do not depend on its constant, so that its levels share them.
#[derive(Debug, Clone, Copy)]
pub(super) struct MonotonePieces {
    degree: usize,
    /// Extremes, from the third degree on.
    extremes: Few,
}

impl MonotonePieces {
    pub(super) fn of(c: &Quartic, interval: [f64; 2]) -> Self {
        Self::of_degree(4, c, interval)
    }

    /// MonotonePieces of a polynomial of degree `most` or less. The bound makes the recursion over derivatives end even if products overflow.
    fn of_degree(most: usize, c: &Quartic, [low, high]: [f64; 2]) -> Self {
        let reach = low.abs().max(high.abs());
        let mut degree = most;
        // Drop a leading coefficient that is negligible over the whole interval.
        let scale = (1..5).map(|k| c[k].abs() * reach.powi(k as i32)).fold(0.0, f64::max);
        while degree > 0 && c[degree].abs() * reach.powi(degree as i32) <= 1e-17 * scale {
            degree -= 1;
        }
        let extremes = if degree > 2 { of_degree(degree - 1, &derivative(c), [low, high]) } else { Few::default() };
        Self { degree, extremes }
    }

    /// [`roots`] of the polynomial with any constant.
    pub(super) fn roots(&self, c: &Quartic, [low, high]: [f64; 2]) -> Few {
        match self.degree {
            0 => Few::default(),
            1 => inside(&[-c[0] / c[1]], low, high),
            2 => parabola(c, low, high),
            _ => between_extremes(&self.extremes, c, low, high),
        }
    }
}

fn of_degree(most: usize, c: &Quartic, interval: [f64; 2]) -> Few {
    MonotonePieces::of_degree(most, c, interval).roots(c, interval)
}

fn inside(places: &[f64], low: f64, high: f64) -> Few {
    let mut found = Few::default();
    places.iter().filter(|&&z| z > low && z < high).for_each(|&z| found.push(z));
    found
}

fn parabola(c: &Quartic, low: f64, high: f64) -> Few {
    let discriminant = c[1] * c[1] - 4.0 * c[2] * c[0];
    if discriminant <= 0.0 {
        return Few::default();
    }
    // One root from the sum without cancellation, the other one from their product.
    let sum = -0.5 * (c[1] + discriminant.sqrt().copysign(c[1]));
    let (a, b) = (sum / c[2], if sum == 0.0 { 0.0 } else { c[0] / sum });
    if sum == 0.0 {
        let root = (-c[0] / c[2]).max(0.0).sqrt();
        return inside(&[-root, root], low, high);
    }
    inside(&[a.min(b), a.max(b)], low, high)
}

fn between_extremes(extremes: &Few, c: &Quartic, low: f64, high: f64) -> Few {
    let slope = derivative(c);
    let mut found = Few::default();
    let (mut from, mut at_from) = (low, value(c, low));
    for to in extremes.as_slice().iter().copied().chain([high]) {
        let at_to = value(c, to);
        if (at_from > 0.0) != (at_to > 0.0) {
            found.push(bracketed(c, &slope, from, to, at_from > 0.0));
        }
        (from, at_from) = (to, at_to);
    }
    found
}

/// Root between two arguments at which a polynomial has different signs.
fn bracketed(c: &Quartic, slope: &Quartic, mut low: f64, mut high: f64, falling: bool) -> f64 {
    let mut z = 0.5 * (low + high);
    let mut width = high - low;
    for _ in 0..120 {
        let error = value(c, z);
        if error == 0.0 {
            return z;
        }
        if (error > 0.0) == falling {
            low = z
        } else {
            high = z
        }
        let newton = z - error / value(slope, z);
        let next =
            if newton > low && newton < high && (newton - z).abs() < width { newton } else { 0.5 * (low + high) };
        width = (next - z).abs().max(0.5 * width);
        if (next - z).abs() <= 2e-16 * z.abs() || next == low || next == high {
            return next;
        }
        z = next;
    }
    z
}

/// Least and greatest value over an interval, whose ends may be infinite.
pub(super) fn range(c: &Quartic, [low, high]: [f64; 2]) -> [f64; 2] {
    let at = |z: f64| match z.is_finite() {
        true => value(c, z),
        // At infinity the leading coefficient decides, or the constant if there is no other.
        false => match (1..5).rev().find(|&k| c[k] != 0.0) {
            Some(k) => c[k] * z.signum().powi(k as i32) * f64::INFINITY,
            None => c[0],
        },
    };
    // Cauchy's bound encloses every extreme.
    let slope = derivative(c);
    let lead = (0..5).rev().find(|&k| slope[k] != 0.0);
    let bound = lead.map_or(0.0, |k| 1.0 + (0..k).map(|i| (slope[i] / slope[k]).abs()).fold(0.0, f64::max));
    let extremes = roots(&slope, [low.max(-bound), high.min(bound)]);
    let places = extremes.as_slice().iter().copied().chain([low, high]);
    places.map(at).fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], y| [least.min(y), most.max(y)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_roots(roots: [f64; 4]) -> Quartic {
        let mut c = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (degree, root) in roots.into_iter().enumerate() {
            for k in (0..=degree + 1).rev() {
                c[k] = if k > 0 { c[k - 1] } else { 0.0 } - root * c[k];
            }
        }
        c
    }

    /// Four simple roots at distances of about 1 are as well conditioned as their coefficients: some hundred units in the last place.
    #[test]
    fn roots_of_a_quartic_are_found_inside_the_interval_only() {
        let c = of_roots([-2.0, -0.5, 1.0, 3.0]);
        let found = roots(&c, [-10.0, 10.0]);
        for (root, expected) in found.as_slice().iter().zip([-2.0, -0.5, 1.0, 3.0]) {
            assert!((root - expected).abs() < 1e-13, "{root}");
        }
        assert_eq!(found.as_slice().len(), 4);
        assert_eq!(roots(&c, [-1.0, 2.0]).as_slice().len(), 2);
    }

    /// Found by a fuzz target: overflowing products become NaN, and every comparison with NaN is false.
    #[test]
    fn what_overflows_has_an_end() {
        let whole = [f64::NEG_INFINITY, f64::INFINITY];
        assert!(roots(&[0.0, 1.0, 1e300, 1e300, 0.0], [-1e300, 1e300]).as_slice().len() <= 3);
        assert!(roots(&[1.0, 0.0, 0.0, 0.0, f64::INFINITY], whole).as_slice().len() <= 4);
        assert!(roots(&[f64::NAN; 5], whole).as_slice().len() <= 4);
        assert!(range(&[0.0, 1e308, 1e308, 1e308, 1e-308], whole)[1] > 0.0);
    }

    #[test]
    fn a_root_of_a_parabola_keeps_its_digits_beside_a_large_one() {
        // z^2 - 1e8 z + 1: the roots 1e8 and 1e-8 (1 + 1e-16).
        let found = roots(&[1.0, -1e8, 1.0, 0.0, 0.0], [-1e9, 1e9]);
        assert!((found.as_slice()[0] * 1e8 - 1.0).abs() < 1e-15);
        assert!(roots(&[1.0, 0.0, 1.0, 0.0, 0.0], [-9.0, 9.0]).as_slice().is_empty());
        assert_eq!(roots(&[-4.0, 0.0, 1.0, 0.0, 0.0], [-9.0, 9.0]).as_slice(), [-2.0, 2.0]);
    }

    #[test]
    fn ranges_reach_to_infinity_where_the_interval_does() {
        let whole = [f64::NEG_INFINITY, f64::INFINITY];
        assert_eq!(range(&[1.0, 0.0, 2.0, 0.0, 0.0], whole), [1.0, f64::INFINITY]);
        assert_eq!(range(&[0.0, 2.0, 0.0, 0.0, 0.0], [-1.0, 3.0]), [-2.0, 6.0]);
        assert_eq!(range(&[0.0, 0.0, 1.0, 0.0, 0.0], [-1.0, 3.0]), [0.0, 9.0]);
        assert_eq!(range(&[5.0, 0.0, 0.0, 0.0, 0.0], whole), [5.0, 5.0]);
    }
}
