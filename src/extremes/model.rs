//! Local model of a characteristic in the box: quartics along the axes, and products. It predicts the place of the
//! least value.

/// Box of one characteristic's dimensions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Region {
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
}

/// Model `y(x) - y(base) ~ sum_j g_j(u_j) + sum_{j<k} A_jk u_j u_k` with `u_j = (x_j - base_j)/scale_j` and quartics
/// `g_j`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Model {
    pub(crate) base: Vec<f64>,
    pub(crate) scale: Vec<f64>,
    /// Coefficients of `u` to `u^4` for every dimension.
    pub(crate) parts: Vec<[f64; 4]>,
    /// Products `(k, A_jk)` for every dimension `j`. Each product is listed with both of its dimensions.
    pub(crate) products: Vec<Vec<(usize, f64)>>,
}

/// Sweeps over all coordinates after which a descent ends in any case.
const SWEEPS: usize = 100;
/// Halvings of an interval after which its ends are neighbouring doubles.
const HALVINGS: usize = 200;

impl Region {
    pub(super) fn len(&self) -> usize {
        self.lower.len()
    }

    pub(super) fn width(&self, d: usize) -> f64 {
        self.upper[d] - self.lower[d]
    }

    pub(super) fn clamp(&self, d: usize, x: f64) -> f64 {
        x.clamp(self.lower[d], self.upper[d])
    }

    /// Point at the given parts of the way from the lower to the upper bounds.
    pub(super) fn at(&self, part: impl Fn(usize) -> f64) -> Vec<f64> {
        let at = |d: usize| match part(d) {
            1.0 => self.upper[d], // lower + width may be rounded to its neighbour
            part => self.clamp(d, self.lower[d] + part * self.width(d)),
        };
        (0..self.len()).map(at).collect()
    }

    /// True if the box holds the point.
    pub(super) fn contains(&self, x: &[f64]) -> bool {
        (0..self.len()).all(|d| self.lower[d] <= x[d] && x[d] <= self.upper[d])
    }
}

impl Model {
    /// Model value at `x` minus the value at the base.
    pub(crate) fn rise(&self, x: &[f64]) -> f64 {
        let u: Vec<f64> = (0..x.len()).map(|d| (x[d] - self.base[d]) / self.scale[d]).collect();
        let own: f64 = u.iter().zip(&self.parts).map(|(&u, part)| quartic(part, u)).sum();
        // Half, because every product is listed with both of its dimensions.
        let along = |j: usize| self.products[j].iter().map(|&(k, a)| a * u[k]).sum::<f64>();
        own + 0.5 * (0..x.len()).map(|j| u[j] * along(j)).sum::<f64>()
    }

    /// Change of the value as one coordinate moves between two places, with the others at `x`.
    pub(super) fn rise_along(&self, x: &[f64], d: usize, [from, to]: [f64; 2]) -> f64 {
        let u = |d: usize, x: f64| (x - self.base[d]) / self.scale[d];
        let tilt: f64 = self.products[d].iter().map(|&(k, a)| a * u(k, x[k])).sum();
        let (from, to) = (u(d, from), u(d, to));
        quartic(&self.parts[d], to) - quartic(&self.parts[d], from) + tilt * (to - from)
    }

    /// Slope of the value along one coordinate, per unit of it.
    pub(crate) fn slope(&self, x: &[f64], d: usize) -> f64 {
        let u = |d: usize| (x[d] - self.base[d]) / self.scale[d];
        let tilt: f64 = self.products[d].iter().map(|&(k, a)| a * u(k)).sum();
        (steepness(&self.parts[d], u(d)) + tilt) / self.scale[d]
    }

    /// Model of the negated characteristic.
    pub(crate) fn negated(&self) -> Self {
        let mut negated = self.clone();
        negated.parts.iter_mut().flatten().for_each(|coefficient| *coefficient = -*coefficient);
        negated.products.iter_mut().flatten().for_each(|(_, value)| *value = -*value);
        negated
    }

    /// Model without its products.
    pub(super) fn separate(&self) -> Self {
        Self { products: vec![Vec::new(); self.parts.len()], ..self.clone() }
    }

    /// Descends from `start` by moves along one coordinate, each to the lowest value of its line within the box.
    /// Returns a point from which no such move leads further down.
    pub(super) fn descend(&self, region: &Region, start: &[f64]) -> Vec<f64> {
        let mut x = start.to_vec();
        for _ in 0..SWEEPS {
            let mut moved = false;
            for d in 0..x.len() {
                let (target, gain) = self.lowest(region, &x, d);
                if gain > 0.0 {
                    moved = true;
                    x[d] = target;
                }
            }
            if !moved {
                break;
            }
        }
        x
    }

    /// Lowest place within the box on the line through `x` along one coordinate, and the gain from `x` to it.
    pub(super) fn lowest(&self, region: &Region, x: &[f64], d: usize) -> (f64, f64) {
        let u_of = |d: usize, x: f64| (x - self.base[d]) / self.scale[d];
        let [c1, c2, c3, c4] = self.parts[d];
        let tilt: f64 = self.products[d].iter().map(|&(k, a)| a * u_of(k, x[k])).sum();
        let line = [c1 + tilt, c2, c3, c4];
        let (from, to) = (u_of(d, region.lower[d]), u_of(d, region.upper[d]));
        let here = quartic(&line, u_of(d, x[d]));
        // A change of the line within rounding is not a gain.
        let size = [from, to].map(|u| u.abs().max(1.0)).into_iter().fold(0.0, f64::max);
        let noise =
            8.0 * f64::EPSILON * line.iter().enumerate().map(|(n, c)| c.abs() * size.powi(n as i32 + 1)).sum::<f64>();
        let mut best = (x[d], 0.0);
        let ends = [(region.lower[d], from), (region.upper[d], to)];
        let inner = stationary(&line, from, to).into_iter();
        let inner = inner.map(|u| (region.clamp(d, self.base[d] + u * self.scale[d]), u));
        for (target, u) in ends.into_iter().chain(inner) {
            let gain = here - quartic(&line, u);
            if gain > best.1 + noise {
                best = (target, gain);
            }
        }
        best
    }
}

fn quartic(coefficients: &[f64; 4], u: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |value, coefficient| (value + coefficient) * u)
}

fn steepness([c1, c2, c3, c4]: &[f64; 4], u: f64) -> f64 {
    c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * 4.0 * c4))
}

/// Candidates for the least value of the quartic between `from` and `to`: every zero of its derivative, and some other
/// places.
fn stationary(coefficients: &[f64; 4], from: f64, to: f64) -> Vec<f64> {
    let [_, c2, c3, c4] = *coefficients;
    let slope = |u: f64| steepness(coefficients, u);
    // Between two zeros of its own derivative the slope is monotonic and has at most one zero.
    let mut ends = vec![from, to];
    ends.extend(quadratic_roots(2.0 * c2, 6.0 * c3, 12.0 * c4).into_iter().filter(|u| from < *u && *u < to));
    ends.sort_unstable_by(f64::total_cmp);
    // The slope keeps its sign at a zero that is one of these points, so the bisection misses it.
    let inner = ends[1..ends.len() - 1].to_vec();
    ends.windows(2).filter_map(|ends| bisect(slope, ends[0], ends[1])).chain(inner).collect()
}

/// Real roots of `a + b u + c u^2`.
fn quadratic_roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    let q = -0.5 * (b + b.signum() * discriminant.sqrt());
    [q / c, a / q].into_iter().filter(|root| root.is_finite()).collect()
}

fn bisect(slope: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> Option<f64> {
    let falls = slope(from) < 0.0;
    if slope(from) == 0.0 || slope(to) == 0.0 || falls == (slope(to) < 0.0) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        match slope(middle) {
            0.0 => return Some(middle),
            _ if middle <= from || middle >= to => break,
            value if (value < 0.0) == falls => from = middle,
            _ => to = middle,
        }
    }
    Some(0.5 * (from + to))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `u^4 - 2 u^2` has its minima at -1 and 1. A tilt by a product makes one of them the lower.
    #[test]
    fn the_lower_of_two_minima_is_found() {
        let region = Region { lower: vec![-3.0, -1.0], upper: vec![3.0, 1.0] };
        let products = vec![vec![(1, 0.1)], vec![(0, 0.1)]];
        let model =
            Model { base: vec![0.0; 2], scale: vec![1.0; 2], parts: vec![[0.0, -2.0, 0.0, 1.0], [0.0; 4]], products };
        let at = model.descend(&region, &[0.5, 1.0]);
        // 4 u^3 - 4 u + 0.1 = 0 at u = -1.0121..; the other coordinate stays at its bound.
        assert!((4.0 * at[0].powi(3) - 4.0 * at[0] + 0.1).abs() < 1e-12 && at[0] < -1.0, "{at:?}");
        assert_eq!(at[1], 1.0);
        assert!((model.rise(&at) - (at[0].powi(4) - 2.0 * at[0].powi(2) + 0.1 * at[0])).abs() < 1e-15);
    }

    #[test]
    fn a_line_that_is_flat_up_to_rounding_is_left_alone() {
        let region = Region { lower: vec![-3.0], upper: vec![3.0] };
        let flat = |slope: f64| Model {
            base: vec![0.0],
            scale: vec![1.0],
            parts: vec![[slope, 0.0, 0.0, 0.0]],
            products: vec![vec![]],
        };
        assert_eq!(flat(0.0).descend(&region, &[1.5]), [1.5]);
        assert_eq!(flat(1e-300).descend(&region, &[1.5]), [-3.0]);
    }
}
