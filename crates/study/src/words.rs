//! Words and numbers of study files that their types, their readers and their schema share.

/// Sigmas that half a tolerance band has unless the study says otherwise.
pub(super) const SIGMAS: f64 = 3.0;
/// The models of measured values; the first one unless the study says otherwise.
pub(super) const MEASURED_MODELS: [&str; 2] = ["empirical", "pearson"];
/// Which sensitivities can be asked for.
pub(super) const SENSITIVITIES: [&str; 2] = ["all", "varying"];
/// The requirements that have a name.
pub(super) const REQUIREMENTS: [&str; 2] = ["worst-case", "rss"];
/// The form of `[[correlation]]`.
pub(super) const CORRELATIONS: &str = "a list, each pair of dimensions below its own [[correlation]],";

/// The form of `[[joint]]`.
pub(super) const BLOCKS: &str = "a list, each block of dimensions below its own [[joint]],";
/// The zones of `[[joint]]`.
pub(super) const ZONES: [&str; 3] = ["disc", "rim", "diamond"];

/// A kind of distribution by its name in study files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Normal,
    TruncatedNormal,
    Uniform,
    TwoPoint,
    Triangular,
    Trapezoidal,
    Beta,
    Arcsine,
    UShaped,
    CurvilinearTrapezoid,
    Student,
    Lognormal,
    Gamma,
    Weibull,
    Exponential,
    Rayleigh,
    Mixture,
    Tabulated,
    /// Told by the key `moments`, not by a name.
    Moments,
}

/// Name, the parameters that a kind knows, and what to write instead of others.
pub(super) type KnownKind = (&'static str, Kind, &'static [&'static str], &'static str);

const NOTHING: &str = "it has no parameters of its own";
const ORIGIN: &str = "it knows `origin`";
pub(super) const KINDS: [KnownKind; 18] = [
    ("normal", Kind::Normal, &[], NOTHING),
    ("truncated-normal", Kind::TruncatedNormal, &[], NOTHING),
    ("uniform", Kind::Uniform, &[], NOTHING),
    ("two-point", Kind::TwoPoint, &[], NOTHING),
    ("triangular", Kind::Triangular, &["mode"], "it knows `mode`"),
    ("trapezoidal", Kind::Trapezoidal, &["top"], "it knows `top`"),
    ("beta", Kind::Beta, &["alpha", "beta"], "it knows `alpha` and `beta`"),
    ("arcsine", Kind::Arcsine, &[], NOTHING),
    ("u-shaped", Kind::UShaped, &[], NOTHING),
    ("curvilinear-trapezoid", Kind::CurvilinearTrapezoid, &["inexactness"], "it knows `inexactness`"),
    ("student", Kind::Student, &["degrees", "scale"], "it knows `degrees` and `scale`"),
    ("lognormal", Kind::Lognormal, &["origin"], ORIGIN),
    ("gamma", Kind::Gamma, &["origin"], ORIGIN),
    ("weibull", Kind::Weibull, &["origin"], ORIGIN),
    ("exponential", Kind::Exponential, &["origin"], ORIGIN),
    ("rayleigh", Kind::Rayleigh, &["origin"], ORIGIN),
    ("mixture", Kind::Mixture, &["parts"], "it knows `parts`"),
    ("tabulated", Kind::Tabulated, &["scores", "values"], "it knows `scores` and `values`"),
];

/// The names of all kinds, with the parameters that each knows.
pub(super) fn kinds() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    KINDS.iter().map(|known| (known.0, known.2))
}

/// How units are held, the second where nothing is said.
pub(super) const UNIT_MODES: [&str; 4] = ["labels", "warn", "check", "convert"];
