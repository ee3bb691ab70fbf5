//! Properties of an input that the moments need, computed once per study.

use std::sync::Arc;

use crate::distribution::{Distribution, Jacobi, Rule, StandardMoments};

/// Standardised moments of an input, and a rule to integrate parts that are not quadratic.
#[derive(Debug, Clone, PartialEq)]
pub struct InputShape {
    /// Standardised moments 3 to 8.
    pub moments: StandardMoments,
    /// Rule that is exact for the fourth power of a quartic if the distribution is known. If only the eight moments are known, it is the
    /// five-point rule matched to them.
    pub rule: Arc<Rule>,
}

impl InputShape {
    /// True if the rule integrates powers up to this one exactly, for a distribution with this shape.
    pub fn integrates(&self, distribution: &dyn Distribution, power: usize) -> bool {
        let jacobi = distribution.jacobi(NODES);
        let enough = jacobi.is_whole() || power < 2 * jacobi.order();
        // The rule may have been replaced by the nodes of a long tail.
        enough && *self.rule == jacobi.gauss()
    }
}

/// Number of nodes that integrate the fourth power of a quartic, of degree 16, exactly.
const NODES: usize = 9;
/// Order of the rule that eight moments determine. Student's distribution with few degrees of freedom has fewer moments.
const MOMENTS_ORDER: usize = 4;

/// Shapes of these distributions. Equal distributions share a rule.
pub fn shapes<'a>(distributions: impl IntoIterator<Item = &'a dyn Distribution>) -> Vec<InputShape> {
    let mut rules: Vec<(Jacobi, Arc<Rule>)> = Vec::new();
    let shape = |distribution: &dyn Distribution| {
        let jacobi = distribution.jacobi(NODES);
        let known = rules.iter().find(|(of, _)| *of == jacobi).map(|(_, rule)| Arc::clone(rule));
        let rule = known.unwrap_or_else(|| {
            let rule = match jacobi.order() {
                ..=MOMENTS_ORDER => jacobi.gauss_with_mean().unwrap_or_else(|| jacobi.gauss()),
                _ => jacobi.gauss(),
            };
            rules.push((jacobi, Arc::new(rule)));
            Arc::clone(&rules[rules.len() - 1].1)
        });
        InputShape { moments: distribution.standard_moments(), rule }
    };
    distributions.into_iter().map(shape).collect()
}
