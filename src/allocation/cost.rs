//! What a tolerance costs to hold.

use crate::problem::Problem;

/// Cost of one part over its half band `T`, falling as the tolerance opens.
///
/// ```text
/// fixed              a
/// reciprocal         a + b/T
/// reciprocal power   a + b/T^k
/// exponential        a + b exp(-T/c)
/// ```
///
/// All of them are convex in `T`. Units: `a` and the cost in money, `T` and `c` in the unit of the dimension.
///
/// Sources: K. W. Chase, W. H. Greenwood, B. G. Loosli, L. F. Hauglund, "Least cost tolerance allocation for mechanical assemblies with
/// automated process selection", Manufacturing Review 3 (1990), for reciprocal powers fitted to process data; F. H. Speckhart,
/// "Calculation of tolerance based on a minimum cost approach", J. Eng. Industry 94 (1972), for the exponential.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    kind: CurveKind,
    a: f64,
    b: f64,
    shape: f64,
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
}

impl CurveKind {
    /// The kinds that have a name in study files.
    pub(crate) const NAMED: [(&'static str, Self); 3] = [
        ("reciprocal", Self::Reciprocal),
        ("reciprocal-power", Self::ReciprocalPower),
        ("exponential", Self::Exponential),
    ];
}

/// Why a cost cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// A constant that must not be negative is, or is no number.
    #[error("{} must be 0 or above, but is {value}", if *name == "cost" { "a cost".to_owned() } else { format!("the cost constant {name}") })]
    Negative {
        /// The constant.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A constant that must be above 0 is not.
    #[error("the cost constant {name} must be above 0, but is {value}{}", if *value < 0.0 { ": the cost would rise with the tolerance" } else { "" })]
    NotPositive {
        /// The constant.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A tolerance that is no positive number.
    #[error("a tolerance must be above 0, but {name} is {value}")]
    Tolerance {
        /// Which: `min`, `max` or `tolerance`.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The least tolerance is above the greatest.
    #[error("min {min} is above max {max}")]
    Swapped {
        /// The least.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// A tighter process that costs no more: the cost would rise with the tolerance.
    #[error("the cost rises with the tolerance: {loose} costs more than the tighter {tight}")]
    Rising {
        /// The looser tolerance.
        loose: f64,
        /// The tighter one.
        tight: f64,
    },
    /// A list without a process.
    #[error("the list of processes is empty")]
    NoProcess,
    /// Nothing bears the cost.
    #[error("a cost needs at least one dimension")]
    NoMember,
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
        Ok(Self { kind, a, b, shape })
    }

    /// Its kind.
    pub(crate) fn kind(&self) -> CurveKind {
        self.kind
    }

    /// `a`, `b`, and the third of its kind: `k` of a power, 1 of a reciprocal, `c` of an exponential. `b` is 0 where the cost is fixed.
    pub(crate) fn constants(&self) -> [f64; 3] {
        [self.a, self.b, self.shape]
    }

    /// `b` and, of a power, `k`: None where the cost is no reciprocal power.
    pub(super) fn power(&self) -> Option<(f64, f64)> {
        matches!(self.kind, CurveKind::Reciprocal | CurveKind::ReciprocalPower).then_some((self.b, self.shape))
    }

    /// Cost of one part at the half band `t`.
    pub fn cost(&self, t: f64) -> f64 {
        self.a + self.varying(t)
    }

    fn varying(&self, t: f64) -> f64 {
        match self.kind {
            CurveKind::Fixed => 0.0,
            CurveKind::Reciprocal => self.b / t,
            CurveKind::ReciprocalPower => self.b * t.powf(-self.shape),
            CurveKind::Exponential => self.b * (-t / self.shape).exp(),
        }
    }

    /// First and second derivative of the cost by `ln t`.
    pub(crate) fn log_derivatives(&self, t: f64) -> [f64; 2] {
        let cost = self.varying(t);
        match self.kind {
            CurveKind::Fixed => [0.0, 0.0],
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
    /// What it costs.
    pub curve: Curve,
    /// Least half band.
    pub min: f64,
    /// Greatest half band.
    pub max: f64,
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
        Ok(Self { process: None, curve, min, max })
    }

    /// A process that holds one half band at one cost.
    pub fn process(name: impl Into<String>, tolerance: f64, cost: f64) -> Result<Self, CostError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(CostError::Tolerance { name: "tolerance", value: tolerance });
        }
        let curve = Curve::fixed(cost).map_err(|_| CostError::Negative { name: "cost", value: cost })?;
        Ok(Self { process: Some(name.into()), ..Self::between(curve, tolerance, tolerance)? })
    }

    /// With a name, where several compete.
    pub(crate) fn named(self, name: impl Into<String>) -> Self {
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
}

impl Priced {
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
        let single = |offer: &Offer| (offer.min == offer.max).then_some((offer.min, offer.curve.cost(offer.min)));
        let mut points: Vec<(f64, f64)> = offers.iter().filter_map(single).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 < pair[1].0 && pair[1].1 > pair[0].1) {
            return Err(CostError::Rising { loose: pair[1].0, tight: pair[0].0 });
        }
        Ok(Self { parts: members.len() as f64, members, offers })
    }

    /// What it costs to hold this half band, which no offer need name: a process costs what it costs at any tolerance that it
    /// holds, and a curve goes on beyond its bounds.
    pub(crate) fn cost_to_hold(&self, t: f64) -> Option<f64> {
        let holds = |offer: &&Offer| self.offers.len() == 1 && offer.min < offer.max || offer.min <= t * (1.0 + 1e-12);
        let at = |offer: &Offer| offer.curve.cost(if self.offers.len() == 1 { t } else { t.min(offer.max) });
        self.offers.iter().filter(holds).map(|offer| self.parts * at(offer)).reduce(f64::min)
    }

    /// The tightest half band among its members as they stand in a problem, which the process that they share has to hold.
    pub(crate) fn tightest_member(&self, problem: &Problem) -> f64 {
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
