//! The cost of holding a tolerance.

use std::sync::Arc;

use super::cost_error::CostError;
use super::made::Made;
use super::written_cost::WrittenCost;
use crate::assembly::formula::{Formula, FormulaError};
use crate::problem::Problem;

/// Cost of one part over its half band `T`, falling as the tolerance opens.
///
/// ```text
/// fixed              a
/// reciprocal         a + b/T
/// reciprocal power   a + b/T^k
/// exponential        a + b exp(-T/c)
/// formula            of T, as it is written
/// table              points (T, cost), straight lines in 1/T between them
/// ```
///
/// The first four are convex in `T`; a formula or a table is where it bends so. Units: `a` and the cost in money, `T` and `c` in the unit of the dimension.
///
/// Sources: K. W. Chase, W. H. Greenwood, B. G. Loosli, L. F. Hauglund, "Least cost tolerance allocation for mechanical assemblies with
/// automated process selection", Manufacturing Review 3 (1990), for reciprocal powers fitted to process data; F. H. Speckhart,
/// "Calculation of tolerance based on a minimum cost approach", J. Eng. Industry 94 (1972), for the exponential.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    kind: CurveKind,
    a: f64,
    b: f64,
    shape: f64,
    /// Of a formula or a table.
    written: Option<Arc<WrittenCost>>,
}

/// The kinds of [`Curve`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveKind {
    /// The same at any tolerance.
    Fixed,
    /// `a + b/T`.
    Reciprocal,
    /// `a + b/T^k`.
    ReciprocalPower,
    /// `a + b exp(-T/c)`.
    Exponential,
    /// A formula or a table.
    Written,
}

impl CurveKind {
    /// The kinds that have a name in study files.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("reciprocal", Self::Reciprocal),
        ("reciprocal-power", Self::ReciprocalPower),
        ("exponential", Self::Exponential),
    ];
}

impl Curve {
    /// The same at any tolerance.
    pub fn fixed(a: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::Fixed, a, 0.0, 1.0)
    }

    /// `a + b/T`.
    pub fn reciprocal(a: f64, b: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::Reciprocal, a, b, 1.0)
    }

    /// `a + b/T^k`.
    ///
    /// ```
    /// use sensitol::allocation::Curve;
    /// let turned = Curve::reciprocal_power(1.0, 0.15997, 0.43899)?;
    /// assert!((turned.cost(0.008) - 2.332174).abs() < 1e-6);
    /// # Ok::<(), sensitol::allocation::CostError>(())
    /// ```
    pub fn reciprocal_power(a: f64, b: f64, k: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::ReciprocalPower, a, b, k)
    }

    /// `a + b exp(-T/c)`.
    pub fn exponential(a: f64, b: f64, c: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::Exponential, a, b, c)
    }

    fn new(kind: CurveKind, a: f64, b: f64, shape: f64) -> Result<Self, CostError> {
        if !(a.is_finite() && a >= 0.0) {
            return Err(CostError::Negative { name: "a", value: a });
        }
        if kind != CurveKind::Fixed && !(b.is_finite() && b > 0.0) {
            return Err(CostError::NotPositive { name: "b", value: b });
        }
        if !(shape.is_finite() && shape > 0.0) {
            let name = if kind == CurveKind::Exponential { "c" } else { "k" };
            return Err(CostError::NotPositive { name, value: shape });
        }
        Ok(Self { kind, a, b, shape, written: None })
    }

    /// A formula of `T`, the half band in the unit of the dimension.
    ///
    /// That it is positive and falls is checked where its bounds are known, by [`Offer::between`].
    ///
    /// # Errors
    /// When the formula has another name than `T`.
    ///
    /// ```
    /// use sensitol::allocation::Curve;
    /// use sensitol::assembly::formula::Formula;
    /// let curve = Curve::formula(Formula::parse("0.02/T + 0.0004/T^2")?)?;
    /// assert!((curve.cost(0.1) - 0.24).abs() < 1e-15);
    /// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
    /// ```
    pub fn formula(formula: Formula) -> Result<Self, FormulaError> {
        Ok(Self::written(WrittenCost::formula(formula)?))
    }

    /// Points of half band and cost, in any order; between two of them the cost is a straight line in `1/T`, so that
    /// `a + b/T` is reproduced. Corners are rounded over a thousandth of the shorter neighbouring piece.
    ///
    /// # Errors
    /// With fewer than two points, a half band that is not positive or is there twice, a negative cost, or a cost that rises with
    /// the tolerance.
    ///
    /// ```
    /// use sensitol::allocation::Curve;
    /// let curve = Curve::table(&[[0.01, 5.0], [0.02, 3.0], [0.05, 2.0]])?;
    /// // Half way in 1/T between 0.01 and 0.02.
    /// assert!((curve.cost(1.0 / 75.0) - 4.0).abs() < 1e-12);
    /// # Ok::<(), sensitol::allocation::CostError>(())
    /// ```
    pub fn table(points: &[[f64; 2]]) -> Result<Self, CostError> {
        Ok(Self::written(WrittenCost::table(points)?))
    }

    fn written(written: WrittenCost) -> Self {
        let written = Some(Arc::new(written));
        Self { kind: CurveKind::Written, a: 0.0, b: 0.0, shape: 1.0, written }
    }

    /// The half bands between which it has a value: those of a table.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.written.as_ref()?.range()
    }

    /// Whether it is convex in the half band between two of them.
    pub(crate) fn is_convex(&self, min: f64, max: f64) -> bool {
        self.written.as_ref().is_none_or(|written| written.is_convex(min, max))
    }

    /// Points between which straight lines in `1/T` are the cost, or nearly so: of a formula or a table.
    pub fn points(&self, min: f64, max: f64) -> Option<Vec<[f64; 2]>> {
        self.written.as_ref().map(|written| written.points(min, max))
    }

    /// Its kind.
    pub fn kind(&self) -> CurveKind {
        self.kind
    }

    /// `a`, `b`, and the third of its kind: `k` of a power, 1 of a reciprocal, `c` of an exponential. `b` is 0 where the cost is fixed.
    pub fn constants(&self) -> [f64; 3] {
        [self.a, self.b, self.shape]
    }

    /// `b` and, of a power, `k`: None where the cost is not a reciprocal power.
    pub(super) fn power(&self) -> Option<(f64, f64)> {
        matches!(self.kind, CurveKind::Reciprocal | CurveKind::ReciprocalPower).then_some((self.b, self.shape))
    }

    /// Cost of one part at the half band `t`.
    pub fn cost(&self, t: f64) -> f64 {
        self.a + self.varying(t, || libm::pow(t, -self.shape))
    }

    /// The same where `ln t` is known, for searches by it: off by a few roundings more, of `k ln t`.
    pub(super) fn cost_by(&self, t: f64, ln: f64) -> f64 {
        self.a + self.varying_by(t, ln)
    }

    fn varying_by(&self, t: f64, ln: f64) -> f64 {
        // A fifth of the time of a power.
        self.varying(t, || libm::exp(-self.shape * ln))
    }

    /// The part of the cost that varies; `power` is `t^-k`.
    fn varying(&self, t: f64, power: impl Fn() -> f64) -> f64 {
        match self.kind {
            CurveKind::Fixed => 0.0,
            CurveKind::Reciprocal => self.b / t,
            CurveKind::ReciprocalPower => self.b * power(),
            CurveKind::Exponential => self.b * libm::exp(-t / self.shape),
            CurveKind::Written => self.written.as_ref().map_or(f64::NAN, |written| written.cost(t)),
        }
    }

    /// First and second derivative of the cost by `ln t`, at the half band `t` and its logarithm.
    pub(crate) fn log_derivatives(&self, t: f64, ln: f64) -> [f64; 2] {
        // A written cost does without.
        let varying = if self.written.is_some() { f64::NAN } else { self.varying_by(t, ln) };
        self.derivatives_of(varying, t)
    }

    /// Cost of one part at the half band `t` and its logarithm, and its derivative by `ln t`.
    pub(super) fn with_slope(&self, t: f64, ln: f64) -> [f64; 2] {
        let varying = self.varying_by(t, ln);
        [self.a + varying, self.derivatives_of(varying, t)[0]]
    }

    /// First and second derivative by `ln t`, from the part of the cost that varies.
    fn derivatives_of(&self, cost: f64, t: f64) -> [f64; 2] {
        if let Some(written) = &self.written {
            return written.log_derivatives(t);
        }
        match self.kind {
            CurveKind::Fixed | CurveKind::Written => [0.0, 0.0],
            CurveKind::Reciprocal | CurveKind::ReciprocalPower => [-self.shape * cost, self.shape * self.shape * cost],
            CurveKind::Exponential => {
                let x = t / self.shape;
                [-x * cost, x * (x - 1.0) * cost]
            }
        }
    }
}

/// One way of making a part: over which half bands, and what it costs there.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Offer {
    /// Its name, where several compete.
    pub process: Option<String>,
    /// Its cost.
    pub curve: Curve,
    /// Least half band.
    pub min: f64,
    /// Greatest half band.
    pub max: f64,
    /// The machine that it needs, which has a set-up cost of its own.
    pub machine: Option<String>,
    /// The dimensions as it makes them, where it says how its parts lie.
    pub made: Option<Made>,
}

impl Offer {
    /// A curve between two half bands.
    pub fn between(curve: Curve, min: f64, max: f64) -> Result<Self, CostError> {
        for (name, value) in [("min", min), ("max", max)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(CostError::Tolerance { name, value });
            }
        }
        if min > max {
            return Err(CostError::Swapped { min, max });
        }
        if let Some(written) = &curve.written {
            written.check(min, max)?;
        }
        Ok(Self { process: None, curve, min, max, machine: None, made: None })
    }

    /// A process that holds one half band at one cost.
    pub fn process(name: impl Into<String>, tolerance: f64, cost: f64) -> Result<Self, CostError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(CostError::Tolerance { name: "tolerance", value: tolerance });
        }
        let curve = Curve::fixed(cost).map_err(|_| CostError::Negative { name: "cost", value: cost })?;
        Ok(Self { process: Some(name.into()), ..Self::between(curve, tolerance, tolerance)? })
    }

    /// On a machine, whose set-up cost all dimensions share that need it.
    #[must_use]
    pub fn on(self, machine: impl Into<String>) -> Self {
        Self { machine: Some(machine.into()), ..self }
    }

    /// With a name, where several compete.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { process: Some(name.into()), ..self }
    }
}

/// Dimensions that share one tolerance and one process, and the ways of making them.
#[derive(Debug, Clone, PartialEq)]
pub struct Priced {
    /// Indices of the dimensions in the problem.
    pub members: Vec<usize>,
    /// How many parts cost: one for every member, but for the coordinates of one position.
    pub parts: f64,
    /// The ways of making each part; with one of them the tolerance is free within it.
    pub offers: Vec<Offer>,
    /// The free tolerance of which the offers are steps or standard grades.
    pub rounded: Option<Offer>,
}

impl Priced {
    /// A dimension by itself, that costs nothing.
    pub(crate) fn without_cost(dimension: usize) -> Self {
        Self { members: vec![dimension], parts: 1.0, offers: Vec::new(), rounded: None }
    }

    /// One cost for these dimensions; each part costs.
    ///
    /// # Errors
    /// Without a dimension or an offer, and when a looser process costs more than a tighter one.
    pub fn new(members: Vec<usize>, offers: Vec<Offer>) -> Result<Self, CostError> {
        if members.is_empty() {
            return Err(CostError::NoMember);
        }
        if offers.is_empty() {
            return Err(CostError::NoProcess);
        }
        // A looser process may hold its mean better, and cost more for that.
        let single = |offer: &Offer| {
            (offer.min == offer.max && offer.made.is_none()).then_some((offer.min, offer.curve.cost(offer.min)))
        };
        let mut points: Vec<(f64, f64)> = offers.iter().filter_map(single).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 < pair[1].0 && pair[1].1 > pair[0].1) {
            return Err(CostError::Rising { loose: pair[1].0, tight: pair[0].0 });
        }
        Ok(Self { parts: members.len() as f64, members, offers, rounded: None })
    }

    /// With the free tolerance of which the offers are steps or standard grades.
    pub fn rounding(self, rounded: Option<Offer>) -> Self {
        Self { rounded, ..self }
    }

    /// The cost to hold this half band, which no offer need name: a process costs what it costs at any tolerance that it
    /// holds, and a curve goes on beyond its bounds.
    pub fn cost_to_hold(&self, t: f64) -> Option<f64> {
        self.holding(t).map(|(cost, _)| cost)
    }

    /// The same with the offer that holds it at the least cost.
    pub(super) fn holding(&self, t: f64) -> Option<(f64, &Offer)> {
        let known = |curve: &Curve| curve.range().is_none_or(|[least, most]| (least..=most).contains(&t));
        let alone = self.offers.len() == 1;
        let holds = |offer: &&Offer| match alone && offer.min < offer.max {
            true => known(&offer.curve),
            false => offer.min <= t * (1.0 + 1e-12),
        };
        let at = |offer: &Offer| offer.curve.cost(if self.offers.len() == 1 { t } else { t.min(offer.max) });
        let costs = self.offers.iter().filter(holds).map(|offer| (self.parts * at(offer), offer));
        costs.reduce(|best, other| if other.0 < best.0 { other } else { best })
    }

    /// The tightest half band among its members as they stand in a problem, which the process that they share has to hold.
    pub fn tightest_member(&self, problem: &Problem) -> f64 {
        self.members.iter().map(|&d| problem.dimensions()[d].half_band()).fold(f64::INFINITY, f64::min)
    }

    /// The least half band that any offer holds.
    pub(crate) fn tightest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.min).fold(f64::INFINITY, f64::min)
    }

    /// The greatest half band that any offer holds.
    pub(crate) fn loosest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.max).fold(0.0, f64::max)
    }
}
