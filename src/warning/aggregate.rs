//! Aggregation of warnings: one warning for many dimensions.

use crate::warning::{Loss, Warning};

/// Joins warnings of one code and one characteristic that differ in their dimension.
///
/// The worst of them is kept, with its numbers. Its `others` names the dimensions of the rest. Thus a study of a thousand dimensions has
/// one such warning for a characteristic, not a thousand. The order is that of the first of each kind.
///
/// ```
/// use sensitol::Warning;
/// use sensitol::warning::aggregate::aggregated;
/// let edge = |dimension: &str, to| {
///     Warning::SupportEdge { dimension: dimension.into(), from: -1.5, to, others: Vec::new() }
/// };
/// let Warning::SupportEdge { dimension, others, .. } = &aggregated(vec![edge("a", -1.4), edge("b", -1.0)])[0] else { panic!() };
/// assert_eq!((dimension.as_str(), &others[..]), ("b", &["a".to_owned()][..]));
/// ```
pub fn aggregated(warnings: Vec<Warning>) -> Vec<Warning> {
    let mut kinds: Vec<Warning> = Vec::new();
    for mut warning in warnings {
        let known =
            if warning.others().is_some() { kinds.iter_mut().find(|known| known.alike(&warning)) } else { None };
        match known {
            None => kinds.push(warning),
            Some(known) => {
                if warning.weight() > known.weight() {
                    std::mem::swap(known, &mut warning);
                }
                let (place, mut more) = (warning.place(), warning.others().map(std::mem::take).unwrap_or_default());
                if let Some(others) = known.others() {
                    others.push(place);
                    others.append(&mut more);
                }
            }
        }
    }
    kinds
}

impl Warning {
    /// Field with the names of further dimensions. Returns None for a warning without one.
    fn others(&mut self) -> Option<&mut Vec<String>> {
        match self {
            Self::SmallSample { others, .. }
            | Self::CoarseResolution { others, .. }
            | Self::LostDerivative { others, .. }
            | Self::DomainEdge { others, .. }
            | Self::SupportEdge { others, .. }
            | Self::LongTail { others, .. }
            | Self::HigherOrder { others, .. }
            | Self::Kink { others, .. }
            | Self::Discontinuity { others, .. } => Some(others),
            _ => None,
        }
    }

    /// True if one sentence can report both warnings.
    fn alike(&self, other: &Self) -> bool {
        let (a, b) = (self.loss(), other.loss());
        let held = |one: &Self| matches!(one, Self::HigherOrder { held: true, .. });
        self.code() == other.code()
            && self.characteristic() == other.characteristic()
            && a == b
            && held(self) == held(other)
    }

    fn loss(&self) -> Option<Loss> {
        if let Self::LostDerivative { loss, .. } = self { Some(*loss) } else { None }
    }

    /// Name of the dimension, or of the pair as `a:b`.
    fn place(&self) -> String {
        match self {
            Self::LostDerivative { dimensions, .. } => dimensions.join(":"),
            _ => self.dimension().unwrap_or_default().to_owned(),
        }
    }

    /// Severity among warnings of the same kind.
    fn weight(&self) -> f64 {
        match self {
            Self::SmallSample { values, .. } => -(*values as f64),
            Self::CoarseResolution { resolution, sigma, .. } => resolution / sigma,
            Self::DomainEdge { failed, .. } => -failed.abs(),
            Self::SupportEdge { from, to, .. } => (from - to).abs(),
            Self::LongTail { share, .. } => *share,
            Self::HigherOrder { coefficients: [third, fourth], .. } => third.abs().max(fourth.abs()),
            Self::Kink { slopes: [left, right], .. } => (right - left).abs(),
            Self::Discontinuity { by, .. } => by.abs(),
            _ => 0.0,
        }
    }
}
