//! Moments of a surrogate of correlated inputs: of its parabolas, plus a sampled correction if it is not a parabola.

use crate::correlation::Correlation;
use crate::moments::{Contributions, Moments};
use crate::surrogate::parabolas::Parabolas;
use crate::surrogate::{Inputs, Surrogate, Univariate, sampled_remainder as sampled};

/// Moments and contributions. Returns None if a part is unknown.
pub(super) fn correlated(surrogate: &Surrogate, inputs: &Inputs, correlation: &Correlation) -> Option<Contributions> {
    let parts: Vec<Univariate> = surrogate.parts.iter().copied().collect::<Option<_>>()?;
    let parabolas = Parabolas::of(surrogate, parts, inputs, correlation);
    let mean = parabolas.mean();
    let found = parabolas.contributions();
    if found.per_sigma == 0.0 && parabolas.constant() {
        return Some(Contributions { moments: Moments::constant(mean), ..found });
    }
    if parabolas.exact() { Some(found.about(mean)) } else { Some(sampled::contributions(&parabolas, &found, mean)) }
}
