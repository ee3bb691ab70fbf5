//! Two-level factorial designs: full ones and regular fractions of resolution V.

use std::collections::HashSet;

/// Corners of a regular two-level design in `n` dimensions, the fewest that resolution V allows in the order below. A corner holds true for
/// each dimension that is up.
///
/// Every dimension is a product of some of `r` signs, given by the binary digits of a number. A number is taken, from 1 upward, if it is
/// none of those before it, nor the sum without carry of two or three of them. Thus all slopes and all interactions of two dimensions can
/// be separated. These are the Walsh indices of Sanchez and Sanchez (2005), "Very large fractional factorial and central composite
/// designs", ACM Transactions on Modeling and Computer Simulation 15, table 2: 1, 2, 4, 8, 15, 16, 32, 51, 64, 85, 106, 128 and so on. Up
/// to 17 dimensions no regular design of this resolution is smaller.
///
/// ```
/// use sensitol::plan::corners;
/// assert_eq!([1, 4, 5, 6, 8, 11, 17].map(|n| corners(n).len()), [2, 16, 16, 32, 64, 128, 256]);
/// ```
pub fn corners(n: usize) -> Vec<Vec<bool>> {
    let generators = generators(n);
    let signs = generators.last().map_or(0, |last| usize::BITS - last.leading_zeros());
    let corner = |row: usize| generators.iter().map(|generator| (row & generator).count_ones() % 2 == 1).collect();
    (0..1usize << signs).map(corner).collect()
}

fn generators(n: usize) -> Vec<usize> {
    let mut taken: Vec<usize> = Vec::with_capacity(n);
    let mut sums: HashSet<usize> = HashSet::new();
    let mut candidate = 1;
    while taken.len() < n {
        if !taken.contains(&candidate) && !sums.contains(&candidate) {
            for (i, a) in taken.iter().enumerate() {
                sums.insert(candidate ^ a);
                taken[..i].iter().for_each(|b| _ = sums.insert(candidate ^ a ^ b));
            }
            taken.push(candidate);
        }
        candidate += 1;
    }
    taken
}
