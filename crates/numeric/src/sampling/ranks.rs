//! First-order Sobol' indices from an existing sample: neighbours in the order of an input have nearly the same value of that input.
//!
//! ```text
//! S = (1/n sum y_(i) y_(i+1) - m^2) / v        y_(i) in the order of the input, the last beside the first;  m, v: mean and variance of y
//! ```
//!
//! Source: Gamboa, Gremaud, Klein and Lagnoux (2022), Bernoulli 28, 2345. The error is that of the jackknife that leaves out one point.

/// Smallest number of points of a sample. With fewer, neighbours are too far apart.
const FEWEST: usize = 16;

/// First-order index of an input and its standard error. Returns None if there are too few points or if `y` does not vary.
///
/// Shapes: `x` and `y` have equal lengths. Points with a value that is not finite are left out. Cost: `n log n`.
///
/// ```
/// use sensitol_numeric::sampling::rank_first;
/// let x: Vec<f64> = (0..512).map(|i| (f64::from(i) * 0.618_033_988_749_895).fract()).collect();
/// let (share, error) = rank_first(&x, &x).unwrap();
/// assert!((share - 1.0).abs() < 0.02 && error < 0.02); // all of it, but for the step from the last to the first
/// ```
pub fn rank_first(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let mut rows: Vec<(f64, f64)> =
        x.iter().copied().zip(y.iter().copied()).filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let count = rows.len();
    if count < FEWEST {
        return None;
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = count as f64;
    let mean = rows.iter().map(|row| row.1).sum::<f64>() / n;
    // Count from the mean, so that nothing large is subtracted.
    let y: Vec<f64> = rows.iter().map(|row| row.1 - mean).collect();
    let squares: f64 = y.iter().map(|y| y * y).sum();
    let sum: f64 = y.iter().sum();
    let products: f64 = (0..count).map(|i| y[i] * y[(i + 1) % count]).sum();
    let index = |products: f64, sum: f64, squares: f64, n: f64| {
        let square = (sum / n).powi(2);
        (products / n - square) / (squares / n - square)
    };
    let share = index(products, sum, squares, n);
    if squares <= 0.0 || !share.is_finite() {
        return None;
    }
    let without: Vec<f64> = (0..count)
        .map(|i| {
            let (before, after) = (y[(i + count - 1) % count], y[(i + 1) % count]);
            let products = products - before * y[i] - y[i] * after + before * after;
            index(products, sum - y[i], squares - y[i] * y[i], n - 1.0)
        })
        .collect();
    let middle = without.iter().sum::<f64>() / n;
    let variance = (n - 1.0) / n * without.iter().map(|value| (value - middle).powi(2)).sum::<f64>();
    Some((share, variance.sqrt()))
}
