//! Words and numbers of study files that their types, readers and schema share.

/// Default number of sigmas in half a tolerance band.
pub(crate) const SIGMAS: f64 = 3.0;
/// Distributions for measured values. The first is the default.
pub(crate) const MEASURED_MODELS: [&str; 2] = ["empirical", "pearson"];
/// Choices of `sensitivities`.
pub(crate) const SENSITIVITIES: [&str; 2] = ["all", "varying"];
/// Requirements that are named by a word.
pub(crate) const REQUIREMENTS: [&str; 2] = ["worst-case", "rss"];
/// Form of `[[correlation]]`, for faults.
pub(crate) const CORRELATIONS: &str = "a list, each pair of dimensions below its own [[correlation]],";

/// Form of `[[adjust]]` in error messages.
pub(crate) const ADJUSTMENTS: &str = "a list, each adjusted dimension below its own [[adjust]],";

/// Form of `[[joint]]`, for faults.
pub(crate) const BLOCKS: &str = "a list, each block of dimensions below its own [[joint]],";
/// Zones of `[[joint]]`.
pub(crate) const ZONES: [&str; 6] = ["disc", "rim", "diamond", "octahedron", "bicone", "ball"];

/// Zones of three dimensions.
pub(crate) const SOLIDS: [&str; 3] = ["octahedron", "bicone", "ball"];

/// Kind of distribution in study files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Normal,
    TruncatedNormal,
    Uniform,
    TwoPoint,
    Triangular,
    Trapezoidal,
    Beta,
    Arcsine,
    UShaped,
    Octahedron,
    Bicone,
    CurvilinearTrapezoid,
    Student,
    Lognormal,
    Gamma,
    Weibull,
    Exponential,
    Rayleigh,
    Mixture,
    Tabulated,
    SplitNormal,
    GumbelLargest,
    GumbelSmallest,
    /// Any distribution within the band that keeps its promises.
    Any,
    /// Distribution by the key `moments`, which has no name.
    Moments,
}

/// Name and kind of a distribution, its parameters, and the text to write instead of others.
pub(crate) type KnownKind = (&'static str, Kind, &'static [&'static str], &'static str);

const NOTHING: &str = "it has no parameters of its own";
const ORIGIN: &str = "it knows `origin`";
pub(crate) const KINDS: [KnownKind; 24] = [
    ("normal", Kind::Normal, &[], NOTHING),
    ("truncated-normal", Kind::TruncatedNormal, &[], NOTHING),
    ("uniform", Kind::Uniform, &[], NOTHING),
    ("two-point", Kind::TwoPoint, &[], NOTHING),
    ("triangular", Kind::Triangular, &["mode"], "it knows `mode`"),
    ("trapezoidal", Kind::Trapezoidal, &["top"], "it knows `top`"),
    ("beta", Kind::Beta, &["alpha", "beta"], "it knows `alpha` and `beta`"),
    ("arcsine", Kind::Arcsine, &[], NOTHING),
    ("u-shaped", Kind::UShaped, &[], NOTHING),
    ("octahedron", Kind::Octahedron, &[], NOTHING),
    ("bicone", Kind::Bicone, &[], NOTHING),
    ("curvilinear-trapezoid", Kind::CurvilinearTrapezoid, &["inexactness"], "it knows `inexactness`"),
    ("student", Kind::Student, &["degrees", "scale"], "it knows `degrees` and `scale`"),
    ("lognormal", Kind::Lognormal, &["origin"], ORIGIN),
    ("gamma", Kind::Gamma, &["origin"], ORIGIN),
    ("weibull", Kind::Weibull, &["origin"], ORIGIN),
    ("exponential", Kind::Exponential, &["origin"], ORIGIN),
    ("rayleigh", Kind::Rayleigh, &["origin"], ORIGIN),
    ("mixture", Kind::Mixture, &["parts"], "it knows `parts`"),
    ("tabulated", Kind::Tabulated, &["scores", "values"], "it knows `scores` and `values`"),
    ("split-normal", Kind::SplitNormal, &["below", "above"], "it knows `below` and `above`"),
    ("gumbel-largest", Kind::GumbelLargest, &[], NOTHING),
    ("gumbel-smallest", Kind::GumbelSmallest, &[], NOTHING),
    (
        "any",
        Kind::Any,
        &["mean", "sigma_at_most", "symmetric", "unimodal"],
        "it knows `mean`, `sigma_at_most`, `symmetric` and `unimodal`",
    ),
];

/// Names of all kinds, with their parameters.
#[cfg(feature = "schema")]
pub(crate) fn kinds() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    KINDS.iter().map(|known| (known.0, known.2))
}

/// Modes of the check of units. The second is the default.
pub(crate) const UNIT_MODES: [&str; 4] = ["labels", "warn", "check", "convert"];
