//! Mixtures. A part is written like a dimension and takes missing values from the dimension.

use crate::dimension::distribution;
use crate::dimension::kinds::{agreeing, placed, shared};
use crate::dimension::promise::refuse;
use crate::dimension::spread::{Spread, is_flat, nothing_to_spread, sigma, sigmas};
use crate::dimension::tolerance::tolerance;
use crate::entries::file::{DimensionEntry, PartEntry};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::distribution::{Mixture, Part};

/// Distribution of a mixture. Each part has the dimension's nominal and band unless it gives its own.
pub(super) fn mixture(entry: &DimensionEntry, nominal: f64, band: Option<[f64; 2]>) -> Result<Spread, Fault> {
    let table = entry.distribution.as_ref().expect("a mixture was named");
    let to = || "a mixture".to_owned();
    let instead = "give it to the parts";
    if let Some((key, span, _)) = sigmas(entry)? {
        return Err(fault(span, key, StudyFault::DoesNotApply { key, to: to(), instead }));
    }
    if let Some(shift) = &entry.shift {
        return Err(fault(shift.span(), "shift", StudyFault::DoesNotApply { key: "shift", to: to(), instead }));
    }
    if is_flat(entry) {
        sigma(entry, None)?;
        return nothing_to_spread(entry);
    }
    let Some(parts) = &table.get_ref().parts else {
        let instead = "write parts = { machine_1 = { weight = 0.6 }, machine_2 = { weight = 0.4, shift = 0.02 } }";
        let missing = StudyFault::MissingKey { key: "parts".into(), instead: instead.into() };
        return Err(fault(table.span(), "distribution", missing));
    };
    let built = parts.get_ref().0.iter().map(|(name, part)| {
        crate::dimension::mixture::part(name.get_ref(), part, nominal, band).map_err(|found| {
            let below = if found.key.is_empty() { String::new() } else { format!(".{}", found.key) };
            let span = found.span.filter(|span| !span.is_empty()).unwrap_or_else(|| name.span());
            let key = format!("distribution.parts.{}{below}", name.get_ref());
            Fault { span: Some(span), key, fault: found.fault }
        })
    });
    let parts = built.collect::<Result<Vec<_>, _>>()?;
    let distribution = placed(entry, shared(Mixture::new(parts)))?;
    agreeing(entry, &distribution, "distribution", "this mixture")?;
    Ok(distribution)
}

fn part(name: &str, entry: &Spanned<PartEntry>, nominal: f64, band: Option<[f64; 2]>) -> Result<Part, Fault> {
    let part = entry.get_ref();
    let weight = *part.weight.get_ref();
    if weight <= 0.0 {
        let out = StudyFault::OutOfRange { value: weight, range: "above 0" };
        return Err(fault(part.weight.span(), "weight", out));
    }
    let line = part.as_dimension();
    refuse(&line, "a part of a mixture")?;
    let middle = part.limits.as_ref().map(|limits| 0.5 * (limits.get_ref()[0] + limits.get_ref()[1]));
    let nominal = part.nominal.as_ref().map(|nominal| *nominal.get_ref()).or(middle).unwrap_or(nominal);
    let band = tolerance(&line, nominal)?.or(band.filter(|_| !is_flat(&line)));
    let Some(distribution) = distribution(&line, nominal, band)? else {
        let instead = "a part needs a spread: give it a tolerance or a sigma, or the dimension a tolerance".to_owned();
        return Err(fault(0..0, "", StudyFault::MissingKey { key: "tolerance".into(), instead }));
    };
    Ok(Part { name: name.to_owned(), weight, distribution })
}
