//! Cost of holding a tolerance: by parameters, by a formula of the half band, or from a table.
//!
//! ```text
//! formula   C(T); derivatives by ln T are exact: T C', T C' + T^2 C''
//! table     between two points C = C_i + m_i (u - u_i) with u = 1/T; a corner is a parabola over u_i ± h, h a thousandth of the shorter
//!           piece beside it, so that slopes are continuous
//! ```

use std::sync::Arc;

use crate::allocation::cost::cost_error::CostError;
use crate::assembly::formula::{Formula, FormulaError, FormulaSet, Jet, Meaning};

const NAME: &str = "T";
/// Number of half bands at which a formula is checked, evenly in `ln T`.
const LOOKED: usize = 129;
/// Half of a corner's rounding, relative to the shorter piece beside it.
const CORNER: f64 = 1e-3;
/// Greatest relative rise of a cost that counts as rounding.
const ROUNDING: f64 = 1e-12;
/// Greatest negative curvature in `T`, relative to the slope, that counts as rounding.
const BENT: f64 = 1e-9;
/// Half of the relative step of differences at a kink of a formula. Truncation is 1e-12, rounding 1e-10.
const STEP: f64 = 1e-6;

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
    /// [`Offer::between`](crate::allocation::Offer::between) checks that it is positive and falls, because its bounds are known there.
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

    /// Checks that a formula or a table has costs between two half bands, none of them negative, and falls.
    pub(in crate::allocation) fn check(&self, min: f64, max: f64) -> Result<(), CostError> {
        self.written.as_ref().map_or(Ok(()), |written| written.check(min, max))
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

/// Cost by a formula, by a table, or as a sum of costs.
#[derive(Debug)]
pub(in crate::allocation) struct WrittenCost(Form);

#[derive(Debug)]
enum Form {
    Formula {
        text: String,
        set: Box<FormulaSet>,
    },
    /// Points `(1/T, cost)`, ascending.
    Table(Vec<[f64; 2]>),
    /// Sum of costs, each with its number of parts.
    Sum(Vec<(f64, Curve)>),
}

impl PartialEq for WrittenCost {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Form::Formula { text, .. }, Form::Formula { text: other, .. }) => text == other,
            (Form::Table(points), Form::Table(other)) => points == other,
            (Form::Sum(terms), Form::Sum(other)) => terms == other,
            _ => false,
        }
    }
}

impl WrittenCost {
    pub(in crate::allocation) fn formula(formula: Formula) -> Result<Self, FormulaError> {
        let text = formula.text().to_owned();
        let set = FormulaSet::new(vec![("cost".to_owned(), formula)], [(NAME, Meaning::Variable(0))]);
        set.map(|set| Self(Form::Formula { text, set: Box::new(set) })).map_err(|(_, error)| error)
    }

    pub(in crate::allocation) fn table(points: &[[f64; 2]]) -> Result<Self, CostError> {
        if points.len() < 2 {
            return Err(CostError::FewPoints { count: points.len() });
        }
        for &[at, value] in points {
            if !(at.is_finite() && at > 0.0) {
                return Err(CostError::Tolerance { name: "a half band of the table", value: at });
            }
            if !(value.is_finite() && value >= 0.0) {
                return Err(CostError::BelowZero { at, value });
            }
        }
        let mut points = points.to_vec();
        points.sort_by(|a, b| b[0].total_cmp(&a[0]));
        for pair in points.windows(2) {
            let ([loose, low], [tight, high]) = (pair[0], pair[1]);
            if loose == tight {
                return Err(CostError::TwicePoint { at: loose });
            }
            if low > high {
                return Err(CostError::Rising { loose, tight });
            }
        }
        Ok(Self(Form::Table(points.into_iter().map(|[t, cost]| [t.recip(), cost]).collect())))
    }

    /// Sum of costs, each with its number of parts.
    pub(in crate::allocation) fn sum(terms: Vec<(f64, Curve)>) -> Self {
        Self(Form::Sum(terms))
    }

    /// Least and greatest half band of a table. Returns None for a formula.
    pub(in crate::allocation) fn range(&self) -> Option<[f64; 2]> {
        match &self.0 {
            Form::Formula { .. } => None,
            Form::Table(points) => Some([points[points.len() - 1][0].recip(), points[0][0].recip()]),
            Form::Sum(terms) => {
                (terms.iter().filter_map(|(_, curve)| curve.range())).reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
            }
        }
    }

    /// Checks that the cost is valid between two half bands: it has values, none of them negative, and falls.
    pub(in crate::allocation) fn check(&self, min: f64, max: f64) -> Result<(), CostError> {
        if let Some([least, greatest]) = self.range() {
            let outside = |t: f64| t < least * (1.0 - ROUNDING) || t > greatest * (1.0 + ROUNDING);
            let named = [("min", min), ("max", max)].into_iter().find(|&(_, value)| outside(value));
            return match named {
                Some((name, value)) => Err(CostError::OutsideTable { name, value, least, greatest }),
                None => Ok(()),
            };
        }
        let mut last: Option<(f64, f64)> = None;
        for at in looked(min, max) {
            let value = self.cost(at);
            if !value.is_finite() {
                return Err(CostError::NoValue { at: told(at) });
            }
            if value < 0.0 {
                return Err(CostError::BelowZero { at: told(at), value: told(value) });
            }
            if let Some((tight, _)) = last.filter(|(_, before)| value > before * (1.0 + ROUNDING)) {
                return Err(CostError::Rising { loose: told(at), tight: told(tight) });
            }
            last = Some((at, value));
        }
        Ok(())
    }

    /// True if the cost is convex in `T` between `min` and `max`. A table is checked everywhere, a formula at many half
    /// bands.
    pub(in crate::allocation) fn is_convex(&self, min: f64, max: f64) -> bool {
        match &self.0 {
            // Between points the cost is a + b/T, which is convex. At a point the slope in 1/T must not fall.
            Form::Table(points) => {
                let slopes: Vec<f64> = points.windows(2).map(slope).collect();
                slopes.windows(2).all(|pair| pair[1] >= pair[0] * (1.0 - ROUNDING))
            }
            Form::Sum(terms) => terms.iter().all(|(_, curve)| curve.is_convex(min, max)),
            Form::Formula { .. } => looked(min, max).all(|t| {
                let [first, second] = self.log_derivatives(t);
                // The difference is T^2 C''.
                second - first >= -BENT * first.abs()
            }),
        }
    }

    /// Points with straight lines in `1/T` between them, which are the cost of a table, and nearly that of a formula.
    pub(in crate::allocation) fn points(&self, min: f64, max: f64) -> Vec<[f64; 2]> {
        match &self.0 {
            Form::Table(points) => points.iter().rev().map(|&[u, cost]| [u.recip(), cost]).collect(),
            Form::Formula { .. } | Form::Sum(_) => looked(min, max).map(|t| [t, self.cost(t)]).collect(),
        }
    }

    pub(in crate::allocation) fn cost(&self, t: f64) -> f64 {
        match &self.0 {
            Form::Formula { set, .. } => set.jets(&[0], |_| Jet::variable(t, [0.0; 2]))[0].value(),
            Form::Table(points) => interpolated(points, t.recip())[0],
            Form::Sum(terms) => terms.iter().map(|(parts, curve)| parts * curve.cost(t)).sum(),
        }
    }

    /// First and second derivative by `ln T`.
    pub(in crate::allocation) fn log_derivatives(&self, t: f64) -> [f64; 2] {
        match &self.0 {
            Form::Formula { set, .. } => {
                let jet = set.jets(&[0], |_| Jet::variable(t, [1.0; 2]))[0];
                match (jet.first(0), jet.second()) {
                    (Some(first), Some(second)) => [t * first, t * first + t * t * second],
                    // A kink has no derivative, so the slope of a difference across it is used.
                    _ => {
                        let [up, down] = [1.0 + STEP, 1.0 - STEP].map(|factor| self.cost(t * factor));
                        let slope = (up - down) / (2.0 * STEP);
                        [slope, slope.abs()]
                    }
                }
            }
            Form::Table(points) => {
                let u = t.recip();
                let [_, first, second] = interpolated(points, u);
                [-u * first, u * first + u * u * second]
            }
            Form::Sum(terms) => {
                let mut sum = [0.0; 2];
                for (parts, curve) in terms {
                    let own = curve.log_derivatives(t, libm::log(t));
                    sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += parts * own);
                }
                sum
            }
        }
    }
}

/// Value rounded to the digits that distinguish it from its neighbours, for messages.
fn told(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Half bands between two bounds, evenly in their logarithms, the tightest first.
fn looked(min: f64, max: f64) -> impl Iterator<Item = f64> {
    let count = if min < max { LOOKED } else { 1 };
    (0..count).map(move |place| match place {
        0 => min,
        _ if place + 1 == count => max,
        _ => min * libm::pow(max / min, place as f64 / (count - 1) as f64),
    })
}

fn slope(pair: &[[f64; 2]]) -> f64 {
    (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])
}

/// Value and two derivatives by `u`, continued as a straight line beyond the ends.
fn interpolated(points: &[[f64; 2]], u: f64) -> [f64; 3] {
    let last = points.len() - 2;
    let piece = points[1..=last].partition_point(|point| point[0] <= u);
    let line = slope(&points[piece..piece + 2]);
    let straight = points[piece][1] + line * (u - points[piece][0]);
    // Corner at either end of the piece, within which the line of the other piece counts too.
    for corner in [piece, piece + 1] {
        if corner == 0 || corner > last {
            continue;
        }
        let [at, cost] = points[corner];
        let half = CORNER * (at - points[corner - 1][0]).min(points[corner + 1][0] - at);
        if (u - at).abs() < half {
            let [before, after] = [slope(&points[corner - 1..=corner]), slope(&points[corner..=corner + 1])];
            let way = u - (at - half);
            let bend = (after - before) / (2.0 * half);
            return [cost - before * half + before * way + 0.5 * bend * way * way, before + bend * way, bend];
        }
    }
    [straight, line, 0.0]
}
