//! Reads the factors that inflate the RSS, of `[analysis]` and of dimensions.

use std::ops::Range;

use crate::entries::file::{AnalysisEntry, FactorEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::{Convention, Dimension, RssFactor};
use sensitol_numeric::names::nearest;

/// Word for the factor that follows from worst case and RSS.
const MODIFIED: &str = "modified";

fn above_zero(value: f64, span: Range<usize>, key: &str) -> Result<f64, Fault> {
    let out = || fault(span, key, StudyFault::OutOfRange { value, range: "above 0" });
    if value > 0.0 { Ok(value) } else { Err(out()) }
}

/// RSS factor of one dimension.
pub(crate) fn factor(given: &Spanned<f64>, key: &str) -> Result<RssFactor, Fault> {
    above_zero(*given.get_ref(), given.span(), key).map(RssFactor::Factor)
}

/// Fraction of the half-width by which a mean may be off.
pub(crate) fn mean_shift(given: &Spanned<f64>, key: &str) -> Result<f64, Fault> {
    let value = *given.get_ref();
    let out = || fault(given.span(), key, StudyFault::OutOfRange { value, range: "from 0 to 1" });
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err(out()) }
}

fn of_all(entry: &Spanned<FactorEntry>) -> Result<RssFactor, Fault> {
    let key = "analysis.rss_factor";
    match entry.get_ref() {
        FactorEntry::Number(value) => above_zero(*value, entry.span(), key).map(RssFactor::Factor),
        FactorEntry::Word(word) if word == MODIFIED => Ok(RssFactor::Modified),
        FactorEntry::Word(found) => {
            let nearest = nearest(found, [MODIFIED]).map(str::to_owned);
            let known = vec!["a number".to_owned(), MODIFIED.to_owned()];
            let unknown = StudyFault::UnknownWord { what: "RSS factor", found: found.clone(), nearest, known };
            Err(fault(entry.span(), key, unknown))
        }
    }
}

/// Dimensions with the factors of `[analysis]`, unless they have their own.
pub(crate) fn taken(file: &StudyFile, dimensions: Vec<Dimension>) -> Result<Vec<Dimension>, Fault> {
    let entry = &file.analysis;
    let rss_factor = entry.rss_factor.as_ref().map(of_all).transpose()?;
    let shift = entry.mean_shift.as_ref().map(|given| mean_shift(given, "analysis.mean_shift")).transpose()?;
    let with = |dimension: Dimension| {
        let own = *dimension.convention();
        let (rss_factor, mean_shift) = (own.rss_factor.or(rss_factor), own.mean_shift.or(shift));
        dimension.with_convention(Convention { rss_factor, mean_shift, ..own })
    };
    Ok(dimensions.into_iter().map(with).collect())
}

/// Refuses factors in later changes of options: they belong to the problem, which other options do not change.
pub(crate) fn only_in_study(entry: &AnalysisEntry) -> Result<(), Fault> {
    let given: [(&'static str, Option<Range<usize>>); 2] = [
        ("rss_factor", entry.rss_factor.as_ref().map(Spanned::span)),
        ("mean_shift", entry.mean_shift.as_ref().map(Spanned::span)),
    ];
    for (key, span) in given {
        if let Some(span) = span {
            let (to, instead) = ("a study that is read already".to_owned(), "write it below [analysis] of the study");
            return Err(fault(span, format!("analysis.{key}"), StudyFault::DoesNotApply { key, to, instead }));
        }
    }
    Ok(())
}
