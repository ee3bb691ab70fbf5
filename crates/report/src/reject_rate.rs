//! Text of small reject rates and their yields, with no digit below the bound of unseen rejects.

use crate::document::number::{known, significant, within, yielded};
use sensitol::rare::{Beyond, RareCharacteristic};

/// Formats the rejects on one side in ppm, with no digit below the bound of unseen rejects. If there is no estimate, or the bound is
/// greater, it is the upper end of the interval.
pub(crate) fn rejects(of: &Beyond, digits: usize) -> String {
    let unmet = of.unmet.map(|unmet| unmet.most);
    match of.probability {
        Some(value) if unmet.is_none_or(|most| most < value) => {
            within(1e6 * value, digits, unmet.map(|most| 1e6 * most))
        }
        _ => format!("< {}", significant(1e6 * of.interval[1], 2)),
    }
}

/// Formats the yield. If a bound of what no point met is greater than the reject rate, it is the lower end of the
/// interval.
pub(crate) fn yield_text(one: &RareCharacteristic) -> String {
    let unmet = [&one.below, &one.above].into_iter().flatten().filter_map(|side| side.unmet);
    let unmet = unmet.map(|unmet| unmet.most).fold(0.0, f64::max);
    match (one.yield_, one.yield_interval) {
        (Some(value), Some([low, _])) if 1.0 - value < unmet => format!("> {}", yielded(low)),
        (value, _) => known(value, yielded),
    }
}
