//! Risks of an inspection, in words.

use crate::document::number::{known, limits, plain, significant};
use crate::document::{Blocks, Section};
use sensitol::analysis::{EstimatedShare, InspectionRisks};

/// Adds the shares of parts that an inspection accepts and rejects wrongly.
pub(super) fn inspected(section: &mut Section, of: &InspectionRisks) {
    let gauge = format!("inspection with gauge sigma {}", plain(of.gauge));
    let Some(guard) = of.guard else {
        return section.note(format!("{gauge}: no guard band reaches the wanted share of bad parts accepted"));
    };
    let share = |of: Option<EstimatedShare>| known(of.map(|of| of.value), risk);
    let accepted = limits(of.acceptance[0], of.acceptance[1]);
    let guarded = if guard > 0.0 {
        format!(", guard {}: accepted {accepted}", plain(significant(guard, 4).parse().unwrap_or(guard)))
    } else {
        String::new()
    };
    section.note(format!("{gauge}{guarded}"));
    section.note(format!(
        "  bad and accepted {}, good and rejected {}; {} accepted, of which {} are bad",
        share(of.false_accept),
        share(of.false_reject),
        share(of.accepted),
        share(of.bad_among_accepted)
    ));
}

/// Formats a share of parts in percent, or in parts per million if it is small.
fn risk(share: f64) -> String {
    /// Least share that is printed in percent.
    const FEW: f64 = 1e-3;
    match share {
        share if share > 0.0 && share < FEW => format!("{} ppm", significant(1e6 * share, 3)),
        share => format!("{} %", significant(100.0 * share, 4)),
    }
}
