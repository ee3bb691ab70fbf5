//! The facts about an input that moments need, computed once per study.

use std::sync::Arc;

use crate::distribution::{Distribution, Jacobi, Rule, StandardMoments};

/// The standardised moments of an input, and a rule to integrate parts that are not quadratic.
#[derive(Debug, Clone, PartialEq)]
pub struct InputShape {
    /// Moments 3 to 8.
    pub moments: StandardMoments,
    /// Exact for the fourth power of a quartic where the distribution is known; the five-point rule matched to the
    /// eight moments where nothing else is.
    pub rule: Arc<Rule>,
}

impl InputShape {
    /// Whether the rule integrates powers up to this one of a distribution with this shape exactly.
    pub fn integrates(&self, distribution: &dyn Distribution, power: usize) -> bool {
        let jacobi = distribution.jacobi(NODES);
        let enough = jacobi.is_whole() || power < 2 * jacobi.order();
        // Nodes of a long tail may stand in its place.
        enough && *self.rule == jacobi.gauss()
    }
}

/// Nodes that integrate the fourth power of a quartic, of degree 16, exactly.
const NODES: usize = 9;
/// The order that eight moments determine; fewer are known of Student's distribution with few degrees.
const MOMENTS_ORDER: usize = 4;

/// The shapes of these distributions; equal ones share a rule.
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
