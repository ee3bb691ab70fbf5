//! Place of a process within its band: `cpk` beside `cp`, its `side`, and the `drift` of its lots.

use crate::dimension::conflict;
use crate::dimension::kinds::{placed, shared};
use crate::dimension::off_centre::OffCentre;
use crate::dimension::spread::Spread;
use crate::entries::file::DimensionEntry;
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::Lot;
use sensitol_numeric::distribution::{Drifting, Mixture, Normal, Part};
use sensitol_numeric::names::nearest;

/// Signs of the two sides of the middle.
const SIDES: [&str; 2] = ["+", "-"];

/// Place of the mean of a process.
pub(super) struct Standing {
    /// Distance of the mean from the middle of the band, 0 or above.
    offset: f64,
    /// Side of the mean, 1 or -1; None if half of the parts come from either side.
    side: Option<f64>,
    /// Greatest distance of the mean of a lot from the mean of all parts.
    drift: f64,
}

impl Standing {
    /// True if the mean is off the middle or drifts.
    pub(super) fn known(&self) -> bool {
        self.offset + self.drift > 0.0
    }

    /// Lot of a process, in units of the half-width `half`. `shift` adds to its drift.
    pub(super) fn lot(&self, sigma: f64, half: f64, shift: f64) -> Lot {
        Lot { sigma: sigma / half, off: self.offset / half, further: self.drift + shift.abs() }
    }
}

/// Place of the mean: sigma is half/(3 cp), and the mean is off the middle by half (1 - cpk/cp).
pub(super) fn standing(entry: &DimensionEntry, tolerance: Option<[f64; 2]>) -> Result<Standing, Fault> {
    let drift = match &entry.drift {
        Some(drift) if *drift.get_ref() < 0.0 => {
            let out = StudyFault::OutOfRange { value: *drift.get_ref(), range: "0 or above" };
            return Err(fault(drift.span(), "drift", out));
        }
        drift => drift.as_ref().map_or(0.0, |drift| *drift.get_ref()),
    };
    let (Some(cp), Some(cpk)) = (&entry.cp, &entry.cpk) else {
        if let Some(side) = &entry.side {
            let instead = "`side` says to which side cp and cpk put the mean: write both beside it".to_owned();
            let key = if entry.cp.is_some() { "cpk" } else { "cp" };
            return Err(fault(side.span(), "side", StudyFault::MissingKey { key: key.into(), instead }));
        }
        return Ok(Standing { offset: 0.0, side: None, drift });
    };
    let side = entry.side.as_ref().map(sign).transpose()?;
    let half = tolerance.map_or(0.0, |[lower, upper]| 0.5 * (upper - lower));
    let offset = half * (1.0 - cpk.get_ref() / cp.get_ref());
    if let (Some(shift), true) = (&entry.shift, offset > 0.0) {
        let why = "both say where the mean lies: leave one out";
        return Err(fault(shift.span(), "shift", conflict("cpk", "shift", why)));
    }
    Ok(Standing { offset, side, drift })
}

fn sign(side: &Spanned<String>) -> Result<f64, Fault> {
    match side.get_ref().as_str() {
        "+" => Ok(1.0),
        "-" => Ok(-1.0),
        found => {
            let nearest = nearest(found, SIDES).map(str::to_owned);
            let known = SIDES.map(str::to_owned).to_vec();
            let unknown = StudyFault::UnknownWord { what: "side", found: found.to_owned(), nearest, known };
            Err(fault(side.span(), "side", unknown))
        }
    }
}

/// Normal distribution about the mean, or about two equally likely ones. With a drift the means of lots are uniform about these.
pub(super) fn normal(
    entry: &DimensionEntry,
    mean: f64,
    sigma: f64,
    tolerance: Option<[f64; 2]>,
) -> Result<Spread, Fault> {
    let of = standing(entry, tolerance)?;
    let about = |mean: f64| match of.drift > 0.0 {
        true => shared(Drifting::new(mean, sigma, of.drift)),
        false => shared(Normal::new(mean, sigma)),
    };
    let off = |by: f64| Ok(OffCentre { law: about(mean + by)?, by }.shared());
    match (of.offset > 0.0, of.side) {
        (false, _) => placed(entry, about(mean)),
        (true, Some(side)) => placed(entry, off(side * of.offset)),
        (true, None) => {
            let part = |name: &str, by: f64| Ok(Part { name: name.to_owned(), weight: 1.0, distribution: off(by)? });
            let parts = part("-", -of.offset).and_then(|low| Ok(vec![low, part("+", of.offset)?]));
            placed(entry, parts.and_then(|parts| shared(Mixture::new(parts))))
        }
    }
}
