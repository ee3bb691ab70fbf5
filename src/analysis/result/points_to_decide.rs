//! Number of plain points of the model that would decide a target yield.

use sensitol_numeric::sampling::clopper_pearson;

/// Greatest number of points that are stated. A model that answers in a microsecond takes a quarter of an hour for as many.
const MOST: u64 = 1_000_000_000;

/// Smallest number of plain points whose 95 % interval (Clopper and Pearson 1934) excludes the share `allowed`, if the share `rejected` is
/// right. Returns None if no practicable number decides it.
///
/// ```
/// use sensitol::analysis::points_to_decide;
/// // 0.025^(1/n) = 1 - 0.0027 without a reject: 1365 points.
/// assert_eq!(points_to_decide(0.0, 0.0027), Some(1365));
/// // The nearer the share is to the allowed one, the more points it takes.
/// assert!(points_to_decide(0.002, 0.0027) > points_to_decide(0.001, 0.0027));
/// assert_eq!(points_to_decide(0.0027, 0.0027), None);
/// ```
pub fn points_to_decide(rejected: f64, allowed: f64) -> Option<u64> {
    let decided = |n: u64| {
        let [low, high] = clopper_pearson(rejected * n as f64, n as f64);
        if rejected < allowed { high <= allowed } else { low > allowed }
    };
    if !decided(MOST) {
        return None;
    }
    // The interval shrinks with the number of points.
    let (mut too_few, mut enough) = (0, MOST);
    while enough - too_few > 1 {
        let middle = too_few + (enough - too_few) / 2;
        if decided(middle) { enough = middle } else { too_few = middle }
    }
    Some(enough)
}
