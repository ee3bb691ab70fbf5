//! Sums with an error that does not depend on the order of the terms.

/// Compensated sum (Neumaier 1974), as accurate as a sum in twice the precision that is rounded once.
pub fn exact(terms: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0f64);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}
