//! Proof that a surface is the function itself.
//!
//! A formula has a degree as a polynomial, or a list of all its terms. A surface that has every derivative of such a formula is the
//! formula, unless a derivative is an estimate: [`DerivativeOrigin::Screened`](sensitol_numeric::surrogate::DerivativeOrigin).

use crate::method::polynomial_surface::PolynomialSurface;
use crate::method::{Fitted, Order, Outcome, SurfaceProof};
use crate::problem::Problem;
use sensitol_numeric::surrogate::{InputShape, Univariate};

impl Outcome {
    /// Adds to every characteristic the proof of its surface, if there is one, and the number of known interactions. `polynomials` holds
    /// the terms of the formulas.
    pub(super) fn with_proofs(mut self, problem: &Problem, polynomials: &[Option<PolynomialSurface>]) -> Self {
        let varying: Vec<bool> = problem.dimensions().iter().map(|dimension| dimension.sigma() > 0.0).collect();
        for (c, polynomial) in polynomials.iter().enumerate() {
            let degree = match polynomial {
                Some(polynomial) => Some(polynomial.degree),
                None => problem.function().degree(problem.outputs()[c], &varying),
            };
            let all = self.plan.pairs_of(c);
            // A linear function has no interactions. `auto` takes the interactions of a polynomial from the formula, even if no point shows
            // them.
            let from_formula =
                degree.is_some_and(|degree| degree < 2) || polynomial.is_some() && self.climbed.is_some();
            self.fitted[c].known_pairs = if from_formula { all } else { self.known_pairs(c) };
            self.fitted[c].proof = degree.and_then(|degree| self.proof(problem, c, degree, polynomial.as_ref()));
            if self.fitted[c].proof.is_some() {
                self.fitted[c].known_pairs = all;
            }
        }
        self
    }

    /// Returns the number of pairs of a characteristic whose mixed derivative was differentiated or evaluated, or whose effect was
    /// integrated.
    fn known_pairs(&self, c: usize) -> usize {
        let fitted = &self.fitted[c];
        let known = |index: usize| match &fitted.integrated {
            Some(integrated) => integrated.pairs.get(index).is_some_and(Option::is_some),
            None => fitted.mixed.get(index).copied().flatten().is_some_and(|mixed| mixed.origin.is_known()),
        };
        let joint = |&index: &usize| self.plan.joint(c, self.pairs[index].0, self.pairs[index].1);
        (0..self.pairs.len()).filter(joint).filter(|&index| known(index)).count()
    }

    fn proof(
        &self,
        problem: &Problem,
        c: usize,
        degree: u32,
        polynomial: Option<&PolynomialSurface>,
    ) -> Option<SurfaceProof> {
        let (plan, fitted) = (&*self.plan, &self.fitted[c]);
        let failed = self.evaluated.known.errors().any(|(_, of, _)| of == c);
        let surface = fitted.surrogate.as_ref().filter(|_| fitted.integrated.is_none() && !failed)?;
        let parts: Vec<Univariate> = surface.parts.iter().copied().collect::<Option<_>>()?;
        let shapes = plan.inputs().shapes();
        let integrated = |((part, shape), &d): ((&Univariate, &InputShape), &usize)| {
            let distribution = problem.dimensions()[d].distribution();
            // The fourth moment contains the fourth power of the part.
            let power = 4 * part.highest_power();
            // The moments of a parabola follow from those of the dimension, without a rule.
            part.highest_power() <= 2 || distribution.is_some_and(|law| shape.integrates(law, power))
        };
        if !parts.iter().zip(shapes).zip(plan.varying()).all(integrated) {
            return None;
        }
        let rounding = f64::EPSILON * surface.centre.abs() * (parts.len() as f64 + 1.0).sqrt();
        if let Some(polynomial) = polynomial {
            let [mean, sigma] = polynomial.rounding;
            let finite = mean.is_finite() && sigma.is_finite();
            return (finite && polynomial.is(surface)).then_some(SurfaceProof { degree, mean: rounding + mean, sigma });
        }
        // If only the degree is known, differences determine a polynomial up to the second degree, with one rounding each.
        let whole = match degree {
            0 | 1 => true,
            2 => self.order == Order::Second && fitted.known_pairs == plan.pairs_of(c) && self.are_parabolas(c, fitted),
            _ => false,
        };
        let known = fitted.screened == 0 && parts.iter().all(|part| part.origin().is_known());
        (whole && known).then_some(SurfaceProof { degree, mean: rounding, sigma: rounding })
    }

    /// True if every part of a characteristic has a curvature.
    fn are_parabolas(&self, c: usize, fitted: &Fitted) -> bool {
        let bent = |&d: &usize| fitted.parts[d].is_some_and(|part| part.degree() >= 2);
        self.plan.varying().iter().filter(|&&d| self.plan.depends(c, d)).all(bent)
    }
}
