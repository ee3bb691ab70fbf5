//! Share of the assemblies that points have not shown.

use sensitol_numeric::sampling::clopper_pearson;

/// Confidence of intervals, and of the bound for the share of the assemblies that differs from all points.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// 95 % interval of a share that `seen` of `points` have: Clopper and Pearson (1934), one-sided if there are none.
///
/// ```
/// use sensitol::verification::unseen;
/// // 1 - 0.05^(1/14) = 19.3 %.
/// assert!((unseen(14, 0)[1] - 0.1926).abs() < 1e-4 && unseen(14, 0)[0] == 0.0);
/// // The exact interval of 1 of 10 is 0.25 % to 44.5 %.
/// let [low, high] = unseen(10, 1);
/// assert!((low - 0.00253).abs() < 1e-5 && (high - 0.44502).abs() < 1e-5);
/// ```
pub fn unseen(points: usize, seen: usize) -> [f64; 2] {
    let (n, k) = (points as f64, seen as f64);
    match seen {
        _ if points == 0 => [0.0, 1.0],
        0 => [0.0, 1.0 - libm::pow(1.0 - CONFIDENCE, 1.0 / n)],
        all if all >= points => [libm::pow(1.0 - CONFIDENCE, 1.0 / n), 1.0],
        _ => clopper_pearson(k, n),
    }
}
