//! Cost of holding a tolerance.

use std::sync::Arc;

use crate::allocation::cost::cost_error::CostError;
use crate::allocation::cost::custom_curve::WrittenCost;
use crate::allocation::cost::priced_zone::PricedZone;
use crate::allocation::cost::process_option::Made;
use crate::assembly::formula::{Formula, FormulaError};
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;

/// Cost curve of one part over its half band `T`, falling as the tolerance opens.
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
/// The first four are convex in `T`. A formula or a table may bend either way. Units: `a` and the cost in money, `T`
/// and `c` in the unit of the dimension.
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
    /// Formula or table, for a written cost.
    written: Option<Arc<WrittenCost>>,
}

/// Kinds of [`Curve`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveKind {
    /// Constant at any tolerance: `a`.
    Fixed,
    /// Reciprocal: `a + b/T`.
    Reciprocal,
    /// Reciprocal power: `a + b/T^k`.
    ReciprocalPower,
    /// Exponential: `a + b exp(-T/c)`.
    Exponential,
    /// Formula or table.
    Written,
}

impl CurveKind {
    /// Kinds that have a name in study files.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("reciprocal", Self::Reciprocal),
        ("reciprocal-power", Self::ReciprocalPower),
        ("exponential", Self::Exponential),
    ];
}

impl Curve {
    /// Constant cost `a` at any tolerance.
    pub fn fixed(a: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::Fixed, a, 0.0, 1.0)
    }

    /// Cost `a + b/T`.
    pub fn reciprocal(a: f64, b: f64) -> Result<Self, CostError> {
        Self::new(CurveKind::Reciprocal, a, b, 1.0)
    }

    /// Cost `a + b/T^k`.
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

    /// Cost `a + b exp(-T/c)`.
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

    /// Cost by a formula of `T`, the half band in the unit of the dimension.
    ///
    /// [`Offer::between`] checks that it is positive and falls, because its bounds are known there.
    ///
    /// # Errors
    ///
    /// If the formula has another name than `T`.
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

    /// Cost by points of half band and cost, in any order.
    ///
    /// Between two points the cost is a straight line in `1/T`, so that `a + b/T` is reproduced. Corners are rounded
    /// over a thousandth of the shorter neighbouring piece.
    ///
    /// # Errors
    ///
    /// For fewer than two points, a half band that is not positive or occurs twice, a negative cost, or a cost that
    /// rises with the tolerance.
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

    /// Sum of costs at one tolerance, each with its number of parts.
    pub(in crate::allocation) fn sum(terms: Vec<(f64, Self)>) -> Self {
        Self::written(WrittenCost::sum(terms))
    }

    fn written(written: WrittenCost) -> Self {
        let written = Some(Arc::new(written));
        Self { kind: CurveKind::Written, a: 0.0, b: 0.0, shape: 1.0, written }
    }

    /// Least and greatest half band with a value, for a table. Returns None if every half band has one.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.written.as_ref()?.range()
    }

    /// True if the cost is convex in the half band between `min` and `max`.
    pub(crate) fn is_convex(&self, min: f64, max: f64) -> bool {
        self.written.as_ref().is_none_or(|written| written.is_convex(min, max))
    }

    /// Points with straight lines in `1/T` between them, for a formula or a table. A formula follows them nearly.
    pub fn points(&self, min: f64, max: f64) -> Option<Vec<[f64; 2]>> {
        self.written.as_ref().map(|written| written.points(min, max))
    }

    /// Kind of the curve.
    pub fn kind(&self) -> CurveKind {
        self.kind
    }

    /// Constants `a`, `b`, and the third of the kind: `k` of a power, 1 of a reciprocal, `c` of an exponential. `b` is
    /// 0 for a fixed cost.
    pub fn constants(&self) -> [f64; 3] {
        [self.a, self.b, self.shape]
    }

    /// Constants `b` and `k` of a reciprocal or a reciprocal power. Returns None for other kinds.
    pub(in crate::allocation) fn power(&self) -> Option<(f64, f64)> {
        matches!(self.kind, CurveKind::Reciprocal | CurveKind::ReciprocalPower).then_some((self.b, self.shape))
    }

    /// Cost of one part at the half band `t`.
    pub fn cost(&self, t: f64) -> f64 {
        self.a + self.varying(t, || libm::pow(t, -self.shape))
    }

    /// Cost of one part from `t` and `ln t`, for searches in `ln t`. It differs by a few roundings of `k ln t`.
    pub(in crate::allocation) fn cost_by(&self, t: f64, ln: f64) -> f64 {
        self.a + self.varying_by(t, ln)
    }

    fn varying_by(&self, t: f64, ln: f64) -> f64 {
        // This takes a fifth of the time of a power.
        self.varying(t, || libm::exp(-self.shape * ln))
    }

    /// Varying part of the cost; `power` is `t^-k`.
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
        // A written cost computes its derivatives without the varying part.
        let varying = if self.written.is_some() { f64::NAN } else { self.varying_by(t, ln) };
        self.derivatives_of(varying, t)
    }

    /// Cost of one part at the half band `t` and its logarithm, and its derivative by `ln t`.
    pub(in crate::allocation) fn with_slope(&self, t: f64, ln: f64) -> [f64; 2] {
        let varying = self.varying_by(t, ln);
        [self.a + varying, self.derivatives_of(varying, t)[0]]
    }

    /// First and second derivative by `ln t`, from the varying part of the cost.
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

/// Process option: one way of making a part, with its range of half bands and its cost.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Offer {
    /// Name of the process, if several compete.
    pub process: Option<String>,
    /// Cost curve.
    pub curve: Curve,
    /// Least half band.
    pub min: f64,
    /// Greatest half band.
    pub max: f64,
    /// Machine that the process needs, with a set-up cost of its own.
    pub machine: Option<String>,
    /// Dimensions with the distribution of the process, if the process gives one.
    pub made: Option<Made>,
}

impl Offer {
    /// Creates an offer from a curve between two half bands.
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

    /// Creates a process that holds one half band at one cost.
    pub fn process(name: impl Into<String>, tolerance: f64, cost: f64) -> Result<Self, CostError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(CostError::Tolerance { name: "tolerance", value: tolerance });
        }
        let curve = Curve::fixed(cost).map_err(|_| CostError::Negative { name: "cost", value: cost })?;
        Ok(Self { process: Some(name.into()), ..Self::between(curve, tolerance, tolerance)? })
    }

    /// Sets the machine of the process. Its set-up cost is shared by all dimensions that need it.
    #[must_use]
    pub fn on(self, machine: impl Into<String>) -> Self {
        Self { machine: Some(machine.into()), ..self }
    }

    /// Sets the name of the process, if several compete.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { process: Some(name.into()), ..self }
    }
}

/// Dimensions that share one tolerance and one process, and the ways of making them.
#[derive(Debug, Clone, PartialEq)]
pub struct Priced {
    /// Indices of the dimensions in the problem.
    pub members: Vec<usize>,
    /// Number of parts that are paid for: one for every member, but only one for the coordinates of one position.
    pub parts: f64,
    /// Ways of making each part. If there is only one, the tolerance is free within its range.
    pub offers: Vec<Offer>,
    /// Free tolerance whose steps or standard grades are the offers.
    pub rounded: Option<Offer>,
    /// Zone of a feature whose half width is the tolerance, if the members are its parts.
    pub zone: Option<PricedZone>,
}

impl Priced {
    /// Group of one dimension without a cost.
    pub(crate) fn without_cost(dimension: usize) -> Self {
        Self { members: vec![dimension], parts: 1.0, offers: Vec::new(), rounded: None, zone: None }
    }

    /// Creates a group of dimensions with one cost curve. Each part is paid for.
    ///
    /// # Errors
    ///
    /// If there is no dimension or no offer, and if a looser process costs more than a tighter one.
    pub fn new(members: Vec<usize>, offers: Vec<Offer>) -> Result<Self, CostError> {
        if members.is_empty() {
            return Err(CostError::NoMember);
        }
        if offers.is_empty() {
            return Err(CostError::NoProcess);
        }
        // A looser process with its own distribution may have a better mean, and cost more for it.
        let single = |offer: &Offer| {
            (offer.min == offer.max && offer.made.is_none()).then_some((offer.min, offer.curve.cost(offer.min)))
        };
        let mut points: Vec<(f64, f64)> = offers.iter().filter_map(single).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 < pair[1].0 && pair[1].1 > pair[0].1) {
            return Err(CostError::Rising { loose: pair[1].0, tight: pair[0].0 });
        }
        Ok(Self { parts: members.len() as f64, members, offers, rounded: None, zone: None })
    }

    /// Sets the free tolerance whose steps or standard grades are the offers.
    pub fn rounding(self, rounded: Option<Offer>) -> Self {
        Self { rounded, ..self }
    }

    /// Cost to hold this half band, which need not be one of the offers. A process has the same cost at any tolerance
    /// that it holds, and a curve continues beyond its bounds. Returns None if nothing holds it.
    pub fn cost_to_hold(&self, t: f64) -> Option<f64> {
        self.holding(t).map(|(cost, _)| cost)
    }

    /// Cost to hold this half band, with the cheapest offer that holds it.
    pub(in crate::allocation) fn holding(&self, t: f64) -> Option<(f64, &Offer)> {
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

    /// Sets the zone whose half width is the tolerance.
    #[must_use]
    pub fn of_zone(self, zone: PricedZone) -> Self {
        Self { zone: Some(zone), ..self }
    }

    /// Half band of the member at this place per unit of the tolerance. It is 1 unless the group is a zone.
    pub fn share(&self, place: usize) -> f64 {
        self.zone.as_ref().and_then(|zone| zone.shares.get(place)).copied().unwrap_or(1.0)
    }

    /// Members with their shares.
    pub(in crate::allocation) fn shared(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.members.iter().enumerate().map(|(place, &d)| (d, self.share(place)))
    }

    /// Present tolerance of the group: the half band of its first member by its share.
    pub(in crate::allocation) fn present(&self, dimensions: &[Dimension]) -> f64 {
        dimensions[self.members[0]].half_band() / self.share(0)
    }

    /// Tightest half band of the members in a problem, which their common process has to hold.
    pub fn tightest_member(&self, problem: &Problem) -> f64 {
        self.shared().map(|(d, share)| problem.dimensions()[d].half_band() / share).fold(f64::INFINITY, f64::min)
    }

    /// Least half band of all offers.
    pub(crate) fn tightest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.min).fold(f64::INFINITY, f64::min)
    }

    /// Greatest half band of all offers.
    pub(crate) fn loosest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.max).fold(0.0, f64::max)
    }
}
