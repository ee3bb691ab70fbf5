//! Ranges of a characteristic: those that no assembly leaves, and those of slopes and tolerance bands.

use serde::Serialize;

use crate::extremes::{Extremes, ExtremesProof};
use sensitol_numeric::power::rescale;

/// Ranges that no assembly leaves. JSON has them in `worst_case`.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeFigures {
    /// Interval that no assembly of a linear model leaves: around the nominal, with every dimension at the unfavourable end of its band,
    /// and a point of a circular zone ([`Dimension::within_zone`](crate::Dimension::within_zone)) at its edge.
    pub worst_case: Option<[f64; 2]>,
    /// Greatest addition of curvatures and interactions to the worst case, by the surface. None if a curvature is missing.
    pub curved: Option<f64>,
    /// Least and greatest value in the box of the tolerance bands, if they were searched and found.
    pub extremes: Option<Extremes>,
    /// Interval that no assembly leaves, by interval arithmetic. Only for formulas that are verified, if no extremes were searched.
    pub bounds: Option<ExtremesProof>,
}

/// Half-widths about the middle of all bands, by slopes alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LinearFigures {
    /// Middle of the worst case and of the RSS: the value of a linear model with every dimension in the middle of its band. It is the
    /// nominal value if all bands are symmetric.
    pub middle: Option<f64>,
    /// `sqrt(t'R t)` with `t` = slope x half-width (three sigma if a dimension has no band) and the correlation `R`. Without correlation it
    /// is the root of the sum of squares.
    pub rss: Option<f64>,
    /// 1.5 times the RSS (Bender 1962, 1968), or by the factors of the study.
    pub inflated_rss: Option<f64>,
    /// RSS with means that are all shifted in the unfavourable direction by half of their half-widths, 1.5 sigma of 3: `0.5 sum of |slope|
    /// x half-width + 0.5 rss` (Greenwood and Chase 1987 with m = 0.5).
    pub mean_shift_rss: Option<f64>,
    /// `sqrt(sum of (slope x sigma/(1 - k))^2)` with the sigma of a lot and the shift `k` of its mean in half-widths, from `cpk`, `drift`
    /// or `shift` (Harry and Stewart 1988). It is a sigma, not an interval. None if every mean is in the middle of its band, or one is at
    /// an end.
    pub six_sigma: Option<f64>,
}

rescale!(RangeFigures { worst_case, curved, extremes, bounds } without {});
rescale!(LinearFigures { middle, rss, inflated_rss, mean_shift_rss, six_sigma } without {});
