//! Interactions of a characteristic, of two dimensions each.

use std::fmt;

use serde::{Serialize, Serializer};

use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::surrogate::DerivativeOrigin;
/// Joint effect of two dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Interaction<'a> {
    /// Names of the two dimensions.
    pub dimensions: [&'a str; 2],
    /// Mixed second derivative at the means. None if it is missing.
    pub mixed: Option<f64>,
    /// Reason why the derivative is missing. None if it is known.
    pub missing: Option<Missing>,
    /// True if the derivative is exact rather than a difference.
    pub exact: bool,
    /// Source of the share: `exact`, `evaluated`, or `screened` if it is an estimate without an evaluation of its own. None if
    /// there is no share.
    pub origin: Option<DerivativeOrigin>,
    /// Largest effect of a rounding error of the characteristic on the derivative.
    pub rounding: Option<f64>,
    /// Share of the variance.
    pub share: Option<f64>,
    /// Mean shift by the interaction: none unless the two dimensions are correlated.
    pub mean_shift: Option<f64>,
}

/// Reason why a derivative is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Missing {
    /// A point that it needs has no value.
    Failed,
    /// A point that it needs was not evaluated before the run was stopped.
    NotEvaluated,
}

/// List of interactions. A thousand dimensions have half a million of them: each takes 48 bytes, and every name is stored once.
///
/// ```
/// use sensitol::{Closure, Dimension, Method, Problem, analyze};
/// let dimensions = [Dimension::normal("width", 20.0, 0.3)?, Dimension::normal("height", 10.0, 0.3)?];
/// let area = Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1]))?;
/// let found = analyze(&area, &Method::Full.into())?;
/// let strongest = found.characteristics[0].contributions.interactions.get(0).unwrap();
/// assert_eq!(strongest.dimensions, ["width", "height"]);
/// assert!((strongest.mixed.unwrap() - 1.0).abs() < 1e-9);
/// # Ok::<(), sensitol::Error>(())
/// ```
#[derive(Clone, Default)]
pub struct InteractionList {
    names: Vec<String>,
    rows: Vec<Row>,
}

/// Stored form of an interaction: its dimensions by the indices of their names, NaN for an unknown number.
#[derive(Debug, Clone, Copy)]
pub(in crate::analysis) struct Row {
    pub(in crate::analysis) dimensions: [u32; 2],
    pub(in crate::analysis) mixed: f64,
    pub(in crate::analysis) missing: Option<Missing>,
    pub(in crate::analysis) exact: bool,
    pub(in crate::analysis) origin: Option<DerivativeOrigin>,
    pub(in crate::analysis) rounding: f64,
    pub(in crate::analysis) share: f64,
    pub(in crate::analysis) mean_shift: f64,
}

impl Row {
    fn interaction<'a>(&self, names: &'a [String]) -> Interaction<'a> {
        let known = |value: f64| Some(value).filter(|value| !value.is_nan());
        Interaction {
            dimensions: self.dimensions.map(|place| &*names[place as usize]),
            mixed: known(self.mixed),
            missing: self.missing,
            exact: self.exact,
            origin: self.origin,
            rounding: known(self.rounding),
            share: known(self.share),
            mean_shift: known(self.mean_shift),
        }
    }
}

impl Rescale for InteractionList {
    fn rescale(&mut self, by: &mut Rescaling) {
        // Mixed derivatives and their rounding are in the characteristic's unit already.
        self.rows.iter_mut().for_each(|row| row.mean_shift.rescale(by));
    }
}

impl InteractionList {
    /// Number of interactions.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True if there are no interactions.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Interaction at a place of the list. Returns None beyond its end.
    pub fn get(&self, place: usize) -> Option<Interaction<'_>> {
        self.rows.get(place).map(|row| row.interaction(&self.names))
    }

    /// All interactions, in order.
    pub fn iter(&self) -> impl Iterator<Item = Interaction<'_>> + Clone {
        self.rows.iter().map(|row| row.interaction(&self.names))
    }

    /// Creates a list of interactions. The rows refer to `names` by index.
    pub(in crate::analysis) fn of(names: Vec<String>, rows: Vec<Row>) -> Self {
        Self { names, rows }
    }

    /// Keeps the interactions for which `keep` returns true. Its first argument is the rank, from 0 on.
    pub(in crate::analysis) fn retain(&mut self, mut keep: impl FnMut(usize, &Interaction<'_>) -> bool) {
        let Self { names, rows } = self;
        let mut rank = 0;
        rows.retain(|row| {
            rank += 1;
            keep(rank - 1, &row.interaction(names))
        });
        rows.shrink_to_fit();
    }

    /// Sets all shares of the variance to unknown.
    pub(in crate::analysis) fn without_shares(mut self) -> Self {
        self.rows.iter_mut().for_each(|row| row.share = f64::NAN);
        self
    }
}

impl PartialEq for InteractionList {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl fmt::Debug for InteractionList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl Serialize for InteractionList {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}
