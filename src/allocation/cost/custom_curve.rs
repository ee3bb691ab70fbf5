//! Costs from a formula of the half band, or from a table.
//!
//! ```text
//! formula   C(T); derivatives by ln T are exact: T C', T C' + T^2 C''
//! table     between two points C = C_i + m_i (u - u_i) with u = 1/T; a corner is a parabola over u_i ± h, h a thousandth of the shorter
//!           piece beside it, so that slopes are continuous
//! ```

use crate::allocation::cost::cost_curve::Curve;
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
