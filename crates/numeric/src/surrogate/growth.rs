//! Derivatives of the moments of a surface by the tolerances.

use crate::moments::growths;
use crate::surrogate::{Inputs, Surrogate};

impl Surrogate {
    /// Derivatives of mean, `ln sigma`, skewness and excess by the logarithm of every input's scale, at fixed means. Returns None if inputs
    /// are correlated, a part is unknown, nothing varies, or a moment is infinite.
    ///
    /// Cost: about twice that of the moments.
    pub fn growths(&self, inputs: &Inputs) -> Option<Vec<[f64; 4]>> {
        if inputs.correlation().is_some() {
            return None;
        }
        let grown = self.parts.iter().zip(inputs.shapes());
        let growth: Vec<Vec<f64>> =
            grown.map(|(part, shape)| Some(part.as_ref()?.growth_at(&shape.rule.nodes))).collect::<Option<_>>()?;
        growths(&self.terms(inputs)?, &growth, &self.interactions)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::distribution::{Distribution, Normal, Triangular, Uniform};
    use crate::moments::Interactions;
    use crate::surrogate::{Relocation, Univariate, shapes};

    /// Half-step in the logarithm of a scale: truncation `h^2/6` of third derivatives near 100, and rounding `1e-14/h`, both below 1e-8.
    const STEP: f64 = 1e-5;

    /// Parabolas and quartics of normal, skewed and bounded inputs in turn, with this density of pairs.
    fn surface(n: usize, density: f64, rng: &mut Xoshiro256PlusPlus) -> Surrogate {
        let part = |j: usize, rng: &mut Xoshiro256PlusPlus| {
            let degree = if j.is_multiple_of(2) { 2 } else { 4 };
            let coefficient = |power: i32| rng.random_range(-1.0..1.0) / 4f64.powi(power);
            Univariate::of_coefficients(&(0..degree).map(coefficient).collect::<Vec<f64>>())
        };
        let parts = (0..n).map(|j| Some(part(j, rng))).collect();
        let mut pairs = Vec::new();
        for (j, k) in (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k))) {
            if rng.random::<f64>() < density {
                pairs.push((j, k, rng.random_range(-0.5..0.5)));
            }
        }
        Surrogate { centre: 0.3, parts, interactions: Interactions::of_pairs(n, pairs) }
    }

    /// Reference: differences of the moments themselves, over sparse and dense products.
    #[test]
    fn they_are_the_differences_of_the_moments() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let laws: [Box<dyn Distribution>; 3] = [
            Box::new(Normal::new(0.0, 1.0).unwrap()),
            Box::new(Triangular::new(0.0, 0.2, 1.0).unwrap()),
            Box::new(Uniform::new(-1.0, 1.0).unwrap()),
        ];
        for (n, density) in [(3, 1.0), (6, 0.5), (14, 1.0), (30, 0.05)] {
            let inputs = Inputs::new(shapes((0..n).map(|j| &*laws[j % laws.len()])), None);
            let surface = surface(n, density, &mut rng);
            let found = surface.growths(&inputs).unwrap();
            for (m, found) in found.iter().enumerate() {
                let at = |step: f64| {
                    let stretch = |j: usize| if j == m { step.exp() } else { 1.0 };
                    let moved: Vec<Relocation> =
                        (0..n).map(|j| Relocation { stretch: stretch(j), ..Relocation::NONE }).collect();
                    let of = surface.relocated(&moved).contributions(&inputs).unwrap().moments;
                    [of.mean(), of.sigma().ln(), of.skewness().unwrap(), of.excess().unwrap()]
                };
                let (up, down) = (at(STEP), at(-STEP));
                for (figure, found) in found.iter().enumerate() {
                    let expected = (up[figure] - down[figure]) / (2.0 * STEP);
                    assert!((found - expected).abs() <= 1e-7, "{n}: {m}, {figure}: {found} and {expected}");
                }
            }
        }
    }
}
