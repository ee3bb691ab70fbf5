//! Kinds of distribution: their names, their parameters, and their construction from band, sigma and shift.

use std::ops::Range;
use std::sync::Arc;

use crate::decimal::{SAID, decimal};
use crate::dimension::conflict;
use crate::dimension::spread::{
    Spread, agree, is_flat, needs_band, nothing_to_spread, only_normal, shift, sigma, sigmas,
};
use crate::entries::file::{DimensionEntry, DistributionEntry};
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::{KINDS, Kind, SIGMAS};
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::DimensionFault;
use sensitol_numeric::distribution::{
    Beta, CentralMoments, CurvilinearTrapezoid, Distribution, DistributionError, Exponential, ExtremeEnd, Gamma,
    Gumbel, Lognormal, Rayleigh, SolidAxis, SolidCoordinate, SplitNormal, Student, Tabulated, Trapezoidal, Triangular,
    TruncatedNormal, TwoValues, UShaped, Uniform, Weibull,
};
use sensitol_numeric::names::nearest;

/// A distribution from a dimension's entry, nominal value and tolerance.
pub(super) type OfBand = fn(&DimensionEntry, f64, Option<[f64; 2]>) -> Result<Spread, Fault>;

/// A normal distribution from a dimension's entry, mean, sigma and tolerance.
pub(super) type OfProcess = fn(&DimensionEntry, f64, f64, Option<[f64; 2]>) -> Result<Spread, Fault>;

/// Distribution of a line of `[dimensions]`. Returns None if the dimension does not vary.
pub(super) fn distribution(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
    mixture: OfBand,
    process: OfProcess,
) -> Result<Spread, Fault> {
    let kind = kind(entry)?;
    if kind != Kind::Normal {
        let name = KINDS.iter().find(|known| known.1 == kind).map_or("moments", |known| known.0);
        only_normal(entry, &format!("the distribution `{name}`"))?;
    }
    match kind {
        Kind::Moments => moments(entry, nominal),
        Kind::Normal => normal(entry, nominal, tolerance, process),
        Kind::Mixture => mixture(entry, nominal, tolerance),
        over @ (Kind::TruncatedNormal
        | Kind::Uniform
        | Kind::TwoPoint
        | Kind::Triangular
        | Kind::Trapezoidal
        | Kind::Beta
        | Kind::Arcsine
        | Kind::UShaped
        | Kind::Octahedron
        | Kind::Bicone
        | Kind::CurvilinearTrapezoid
        | Kind::Any) => over_band(over, entry, nominal, tolerance),
        Kind::Student => student(entry, nominal, tolerance),
        Kind::Lognormal => {
            with_tail(entry, nominal, tolerance, |o, mean, sigma| shared(Lognormal::new(o, mean, sigma)))
        }
        Kind::Gamma => with_tail(entry, nominal, tolerance, |o, mean, sigma| shared(Gamma::new(o, mean, sigma))),
        Kind::Weibull => with_tail(entry, nominal, tolerance, |o, mean, sigma| shared(Weibull::new(o, mean, sigma))),
        Kind::Exponential => {
            of_mean(entry, nominal, "an exponential distribution", |o, mean| shared(Exponential::new(o, mean)))
        }
        Kind::Rayleigh => of_mean(entry, nominal, "a rayleigh distribution", |o, mean| shared(Rayleigh::new(o, mean))),
        Kind::Tabulated => tabulated(entry),
        Kind::SplitNormal => split_normal(entry, nominal, tolerance),
        Kind::GumbelLargest => gumbel(ExtremeEnd::Largest, entry, nominal, tolerance),
        Kind::GumbelSmallest => gumbel(ExtremeEnd::Smallest, entry, nominal, tolerance),
    }
}

fn kind(entry: &DimensionEntry) -> Result<Kind, Fault> {
    if entry.moments.is_some() {
        let why = || "are two ways of giving a distribution: leave one out".to_owned();
        let excluded: [(&'static str, Option<Range<usize>>); 5] = [
            ("distribution", entry.distribution.as_ref().map(Spanned::span)),
            ("sigma", entry.sigma.as_ref().map(Spanned::span)),
            ("sigmas", entry.sigmas.as_ref().map(Spanned::span)),
            ("cp", entry.cp.as_ref().map(Spanned::span)),
            ("cpk", entry.cpk.as_ref().map(Spanned::span)),
        ];
        for (key, span) in excluded {
            if let Some(span) = span {
                return Err(fault(span, key, StudyFault::Conflict { a: "moments", b: key, why: why() }));
            }
        }
        return Ok(Kind::Moments);
    }
    let Some(distribution) = &entry.distribution else { return Ok(Kind::Normal) };
    let found = distribution.get_ref().kind.as_str();
    let names = || KINDS.iter().map(|known| known.0);
    let Some((name, kind, knows, instead)) = KINDS.iter().find(|known| known.0 == found) else {
        let nearest = nearest(found, names()).map(str::to_owned);
        let known = names().map(str::to_owned).collect();
        let unknown = StudyFault::UnknownWord { what: "distribution", found: found.to_owned(), nearest, known };
        return Err(fault(distribution.span(), "distribution", unknown));
    };
    for (key, span) in parameters(distribution.get_ref()) {
        if let Some(span) = span.filter(|_| !knows.contains(&key)) {
            let to = format!("the distribution `{name}`");
            return Err(fault(span, within(key), StudyFault::DoesNotApply { key, to, instead }));
        }
    }
    Ok(*kind)
}

/// Every parameter of the table `distribution`, with its place if it is given.
fn parameters(entry: &DistributionEntry) -> [(&'static str, Option<Range<usize>>); 17] {
    let span = |parameter: &Option<Spanned<f64>>| parameter.as_ref().map(Spanned::span);
    [
        ("mode", span(&entry.mode)),
        ("top", span(&entry.top)),
        ("alpha", span(&entry.alpha)),
        ("beta", span(&entry.beta)),
        ("origin", span(&entry.origin)),
        ("inexactness", span(&entry.inexactness)),
        ("degrees", span(&entry.degrees)),
        ("scale", span(&entry.scale)),
        ("below", span(&entry.below)),
        ("above", span(&entry.above)),
        ("parts", entry.parts.as_ref().map(Spanned::span)),
        ("scores", entry.scores.as_ref().map(Spanned::span)),
        ("values", entry.values.as_ref().map(Spanned::span)),
        ("mean", entry.mean.as_ref().map(Spanned::span)),
        ("sigma_at_most", span(&entry.sigma_at_most)),
        ("symmetric", entry.symmetric.as_ref().map(Spanned::span)),
        ("unimodal", entry.unimodal.as_ref().map(Spanned::span)),
    ]
}

pub(super) fn within(parameter: &str) -> String {
    format!("distribution.{parameter}")
}

/// Normal distribution. Its mean is the middle of the band plus `shift`, its sigma is given or half the band by `sigmas`.
fn normal(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
    process: OfProcess,
) -> Result<Spread, Fault> {
    let Some(sigma) = sigma(entry, tolerance)? else { return nothing_to_spread(entry) };
    if sigma == 0.0 && tolerance.is_none() && entry.shift.is_none() {
        return Ok(None);
    }
    let middle = tolerance.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
    process(entry, nominal + middle + shift(entry), sigma, tolerance)
}

/// Student distribution, with mean and sigma like the normal one. Sigma may be given by the scale instead.
fn student(entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Spread, Fault> {
    let degrees = parameter(entry, "degrees", |entry| &entry.degrees)?;
    let middle = tolerance.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
    let mean = nominal + middle + shift(entry);
    let scale = entry.distribution.as_ref().and_then(|table| table.get_ref().scale.as_ref());
    let Some(scale) = scale else {
        let Some(sigma) = sigma(entry, tolerance)? else { return nothing_to_spread(entry) };
        return placed(entry, shared(Student::new(mean, sigma, degrees)));
    };
    let again = entry.sigma.as_ref().map(|sigma| ("sigma", sigma.span()));
    if let Some((key, span)) = again.or(sigmas(entry)?.map(|(key, span, _)| (key, span))) {
        let why = "say the same thing: sigma is scale sqrt(degrees/(degrees - 2)), so leave one out";
        return Err(fault(span, key, conflict("scale", key, why)));
    }
    let value = *scale.get_ref();
    if value <= 0.0 {
        return Err(fault(scale.span(), within("scale"), StudyFault::OutOfRange { value, range: "above 0" }));
    }
    if is_flat(entry) {
        return nothing_to_spread(entry);
    }
    placed(entry, shared(Student::with_scale(mean, value, degrees)))
}

/// Gumbel distribution, with mean and sigma like the normal one.
fn gumbel(end: ExtremeEnd, entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Spread, Fault> {
    let Some(sigma) = sigma(entry, tolerance)? else { return nothing_to_spread(entry) };
    if sigma == 0.0 && is_flat(entry) {
        return Ok(None);
    }
    let middle = tolerance.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
    placed(entry, shared(Gumbel::new(end, nominal + middle + shift(entry), sigma)))
}

/// Split normal distribution about the nominal plus `shift`. Its sigmas are given, or each deviation by `sigmas`.
fn split_normal(entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Spread, Fault> {
    const INSTEAD: &str = "write sigma = [0.1, 0.2], { kind = \"split-normal\", below = 0.1, above = 0.2 }, or a tolerance such as [-0.3, 0.6]: three sigmas on either side";
    let table = entry.distribution.as_ref().expect("its kind was told by it");
    if let Some(given) = &entry.sigma {
        let found =
            StudyFault::DoesNotApply { key: "sigma", to: "a split normal distribution".to_owned(), instead: INSTEAD };
        return Err(fault(given.span(), "sigma", found));
    }
    let per_band = sigmas(entry)?;
    let [below, above] = [&table.get_ref().below, &table.get_ref().above];
    let (below, above) = match (below, above, tolerance) {
        (Some(below), Some(above), _) => {
            if let Some((key, span, _)) = per_band {
                let why = "are two ways of giving the sigmas: leave one out";
                return Err(fault(span, key, conflict("distribution", key, why)));
            }
            (*below.get_ref(), *above.get_ref())
        }
        (None, None, Some([lower, upper])) if lower < 0.0 && upper > 0.0 => {
            let sigmas = per_band.map_or(SIGMAS, |(_, _, sigmas)| sigmas);
            (-lower / sigmas, upper / sigmas)
        }
        (None, None, None) if is_flat(entry) => return nothing_to_spread(entry),
        (below, _, _) => {
            let key = if below.is_none() { "below" } else { "above" };
            let missing = StudyFault::MissingKey { key: key.to_owned(), instead: INSTEAD.to_owned() };
            return Err(fault(table.span(), "distribution", missing));
        }
    };
    placed(entry, shared(SplitNormal::new(nominal + shift(entry), below, above)))
}

/// Distribution whose support is the band. Mean and sigma follow from the shape. Only the curvilinear trapezoid reaches beyond the band.
fn over_band(kind: Kind, entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Spread, Fault> {
    let name = KINDS.iter().find(|known| known.1 == kind).map_or("", |known| known.0);
    let to = || match kind {
        Kind::Any => "an unknown distribution".to_owned(),
        _ => format!("a {name} distribution"),
    };
    if let (Kind::Any, Some(sigma)) = (kind, &entry.sigma) {
        let instead = "write { kind = \"any\", sigma_at_most = 0.01 }";
        return Err(fault(sigma.span(), "sigma", StudyFault::DoesNotApply { key: "sigma", to: to(), instead }));
    }
    let per_band = sigmas(entry)?;
    if kind != Kind::TruncatedNormal {
        if let Some((key, span, _)) = per_band {
            let instead = "its sigma follows from the band";
            return Err(fault(span, key, StudyFault::DoesNotApply { key, to: to(), instead }));
        }
        if let Some(shift) = &entry.shift {
            let instead = "move the limits instead";
            return Err(fault(shift.span(), "shift", StudyFault::DoesNotApply { key: "shift", to: to(), instead }));
        }
    }
    let Some([lower, upper]) = tolerance else {
        if let Some(sigma) = &entry.sigma {
            return Err(fault(sigma.span(), "sigma", needs_band("sigma")));
        }
        return nothing_to_spread(entry);
    };
    let (offset, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    let middle = nominal + offset;
    let distribution = match kind {
        Kind::TruncatedNormal => {
            let per_band = per_band.map_or(SIGMAS, |(_, _, sigmas)| sigmas);
            shared(TruncatedNormal::about(middle, half, shift(entry), half / per_band))
        }
        Kind::Triangular => shared(Triangular::about(middle, half, lean(entry, nominal, offset, half)?)),
        Kind::Trapezoidal => shared(Trapezoidal::about(middle, half, parameter(entry, "top", |entry| &entry.top)?)),
        Kind::Beta => {
            let alpha = parameter(entry, "alpha", |entry| &entry.alpha)?;
            shared(Beta::about(middle, half, alpha, parameter(entry, "beta", |entry| &entry.beta)?))
        }
        Kind::Arcsine => shared(Beta::about(middle, half, 0.5, 0.5)),
        Kind::UShaped => shared(UShaped::about(middle, half)),
        Kind::Octahedron => shared(SolidCoordinate::about(SolidAxis::Octahedron, middle, half)),
        Kind::Bicone => shared(SolidCoordinate::about(SolidAxis::Bicone, middle, half)),
        Kind::CurvilinearTrapezoid => {
            let inexactness = parameter(entry, "inexactness", |entry| &entry.inexactness)?;
            shared(CurvilinearTrapezoid::about(middle, half, inexactness))
        }
        Kind::TwoPoint => shared(TwoValues::about(middle, half)),
        // A uniform distribution stands in for an unknown one.
        _ => shared(Uniform::about(middle, half)),
    };
    let distribution = placed(entry, distribution)?;
    if let (Kind::TruncatedNormal, Some(sigma), Some(own)) = (kind, &entry.sigma, &distribution)
        && !agree(*sigma.get_ref(), own.sigma())
    {
        let instead = "its sigma follows from the cut: write sigmas, half the band by the sigma before the cut";
        return Err(fault(sigma.span(), "sigma", StudyFault::DoesNotApply { key: "sigma", to: to(), instead }));
    }
    agreeing(entry, &distribution, "tolerance", &format!("{name} over this band"))?;
    Ok(distribution)
}

/// Place of the mode within the band, from -1 to 1. The study gives it as a value of the dimension, like `limits`.
fn lean(entry: &DimensionEntry, nominal: f64, offset: f64, half: f64) -> Result<f64, Fault> {
    let Some(mode) = entry.distribution.as_ref().and_then(|entry| entry.get_ref().mode.as_ref()) else {
        return Ok(0.0);
    };
    let lean = ((mode.get_ref() - nominal) - offset) / half;
    // The allowance of 1e-9 admits a mode at an end of the band in spite of rounding.
    if lean.abs() > 1.0 + 1e-9 {
        let (value, range) = (*mode.get_ref(), "within the tolerance band");
        let outside = DistributionError::OutOfRange { parameter: "mode", value, range };
        return Err(fault(mode.span(), within("mode"), DimensionFault::from(outside)));
    }
    Ok(lean.clamp(-1.0, 1.0))
}

/// Distribution with a tail. Its mean is the nominal plus `shift`, whatever the band. Sigma is given or half the band by `sigmas`.
fn with_tail(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
    build: impl Fn(f64, f64, f64) -> Result<Arc<dyn Distribution>, DistributionError>,
) -> Result<Spread, Fault> {
    let flat = is_flat(entry);
    let sigma = match (sigma(entry, tolerance)?, &entry.distribution) {
        (Some(sigma), _) => sigma,
        (None, Some(table)) if !flat => {
            let instead = "give it, or a tolerance of which it is a third: the mean is the nominal".to_owned();
            return Err(fault(table.span(), "distribution", StudyFault::MissingKey { key: "sigma".into(), instead }));
        }
        _ => return nothing_to_spread(entry),
    };
    if sigma == 0.0 && flat {
        return Ok(None);
    }
    placed(entry, build(origin(entry), nominal + shift(entry), sigma))
}

/// Distribution with the mean at the nominal plus `shift`. Its distance from the origin determines sigma.
fn of_mean(
    entry: &DimensionEntry,
    nominal: f64,
    to: &str,
    build: impl Fn(f64, f64) -> Result<Arc<dyn Distribution>, DistributionError>,
) -> Result<Spread, Fault> {
    if let Some((key, span, _)) = sigmas(entry)? {
        let instead = "its sigma follows from mean and origin";
        return Err(fault(span, key, StudyFault::DoesNotApply { key, to: to.to_owned(), instead }));
    }
    if is_flat(entry) {
        // A tolerance of 0 beside a sigma contradicts it; alone it makes the dimension fixed.
        sigma(entry, None)?;
        return nothing_to_spread(entry);
    }
    let distribution = placed(entry, build(origin(entry), nominal + shift(entry)))?;
    agreeing(entry, &distribution, "distribution", &format!("{to} with this mean and origin"))?;
    Ok(distribution)
}

/// Distribution known by its central moments, with the mean at the nominal plus `shift`, whatever the band.
fn moments(entry: &DimensionEntry, nominal: f64) -> Result<Spread, Fault> {
    let moments = entry.moments.as_ref().expect("the kind was told by them");
    match CentralMoments::new(nominal + shift(entry), *moments.get_ref()) {
        Ok(distribution) => Ok(Some(Arc::new(distribution))),
        Err(error) => Err(fault(moments.span(), "moments", DimensionFault::from(error))),
    }
}

/// Tabulated distribution: the table holds values of the dimension over normal scores, so nothing else may be given.
fn tabulated(entry: &DimensionEntry) -> Result<Spread, Fault> {
    const TO: &str = "a tabulated distribution";
    let table = entry.distribution.as_ref().expect("its kind was told by it");
    if let Some((key, span, _)) = sigmas(entry)? {
        let instead = "its sigma follows from the table";
        return Err(fault(span, key, StudyFault::DoesNotApply { key, to: TO.to_owned(), instead }));
    }
    if let Some(shift) = &entry.shift {
        let instead = "move the values of the table instead";
        let found = StudyFault::DoesNotApply { key: "shift", to: TO.to_owned(), instead };
        return Err(fault(shift.span(), "shift", found));
    }
    let (Some(scores), Some(values)) = (&table.get_ref().scores, &table.get_ref().values) else {
        let key = if table.get_ref().scores.is_none() { "scores" } else { "values" };
        let instead = "write { kind = \"tabulated\", scores = [-3, 0, 3], values = [9.9, 10.0, 10.2] }".to_owned();
        return Err(fault(table.span(), "distribution", StudyFault::MissingKey { key: key.to_owned(), instead }));
    };
    match Tabulated::new(scores.get_ref(), values.get_ref()) {
        Ok(law) => {
            let law: Spread = Some(Arc::new(law));
            agreeing(entry, &law, "distribution", "the law of this table")?;
            Ok(law)
        }
        Err(error) => Err(fault(table.span(), "distribution", DimensionFault::from(error))),
    }
}

fn origin(entry: &DimensionEntry) -> f64 {
    let table = entry.distribution.as_ref().map(Spanned::get_ref);
    table.and_then(|table| table.origin.as_ref()).map_or(0.0, |origin| *origin.get_ref())
}

/// Value of a required parameter.
fn parameter(
    entry: &DimensionEntry,
    key: &'static str,
    of: impl Fn(&DistributionEntry) -> &Option<Spanned<f64>>,
) -> Result<f64, Fault> {
    let distribution = entry.distribution.as_ref().expect("a kind with parameters was named");
    of(distribution.get_ref()).as_ref().map(|value| *value.get_ref()).ok_or_else(|| {
        let instead = match key {
            "top" => "write { kind = \"trapezoidal\", top = 0.5 }: the share of the band over which it is flat",
            "inexactness" => {
                "write { kind = \"curvilinear-trapezoid\", inexactness = 0.01 }: by how much the ends of the band may be off"
            }
            "degrees" => {
                "write { kind = \"student\", degrees = 18 }: the degrees of freedom, one less than the number of readings"
            }
            _ => "write { kind = \"beta\", alpha = 2, beta = 5 }",
        };
        let missing = StudyFault::MissingKey { key: key.to_owned(), instead: instead.to_owned() };
        fault(distribution.span(), "distribution", missing)
    })
}

/// Checks that a given sigma equals that of a distribution which determines its own.
pub(super) fn agreeing(entry: &DimensionEntry, spread: &Spread, a: &'static str, what: &str) -> Result<(), Fault> {
    let (Some(given), Some(distribution)) = (&entry.sigma, spread) else { return Ok(()) };
    if agree(*given.get_ref(), distribution.sigma()) {
        return Ok(());
    }
    let why = format!("disagree: {what} has sigma {}", decimal(distribution.sigma(), SAID));
    Err(fault(given.span(), "sigma", conflict(a, "sigma", &why)))
}

/// The distribution, or its error at the key that caused it.
pub(super) fn placed(
    entry: &DimensionEntry,
    distribution: Result<Arc<dyn Distribution>, DistributionError>,
) -> Result<Spread, Fault> {
    let error = match distribution {
        Ok(distribution) => return Ok(Some(distribution)),
        Err(error) => error,
    };
    let table = entry.distribution.as_ref().map(|entry| (entry.span(), parameters(entry.get_ref())));
    let of_table = |key: &str| {
        let (_, parameters) = table.as_ref()?;
        let (key, span) = parameters.iter().find(|(known, _)| *known == key)?;
        Some((span.clone()?, within(key)))
    };
    let of_line = |key: &str, span: Option<Range<usize>>| Some((span?, key.to_owned()));
    let sigma = of_line("sigma", entry.sigma.as_ref().map(Spanned::span));
    let whole = table.as_ref().map(|(span, _)| (span.clone(), "distribution".to_owned()));
    let blamed = match &error {
        DistributionError::OutOfRange { parameter: "the mean before the cut", .. } => {
            of_line("shift", entry.shift.as_ref().map(Spanned::span))
        }
        DistributionError::OutOfRange { parameter, .. } => of_table(parameter),
        DistributionError::NotAboveOrigin { .. } => of_table("origin").or(whole),
        DistributionError::NoSigma { .. } => of_table("degrees"),
        DistributionError::SigmaToMean { .. } => sigma.or(whole),
        _ => sigma.or(whole),
    };
    let (span, key) = blamed.unwrap_or((0..0, String::new()));
    Err(fault(span, key, DimensionFault::from(error)))
}

pub(super) fn shared<D: Distribution + 'static>(
    distribution: Result<D, DistributionError>,
) -> Result<Arc<dyn Distribution>, DistributionError> {
    Ok(Arc::new(distribution?))
}
