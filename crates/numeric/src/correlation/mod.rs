//! Correlation of inputs.
//!
//! Correlated normal inputs are jointly normal with the given matrix. Inputs of other distributions have Nataf's joint distribution (Liu
//! and Der Kiureghian 1986). Each input is its own quantile function of a normal variable, `u_j = T_j(z_j) = (F_j^-1(Phi(z_j)) -
//! mean_j)/sd_j`. The normal variables are correlated such that the inputs have the given correlations. With the Hermite coefficients `c_jn
//! = E[T_j(z) He_n(z)]/sqrt(n!)` that is Mehler's series (1866)
//!
//! ```text
//! rho_jk = sum_{n>=1} c_jn c_kn r_jk^n        rho: of the inputs,  r: of the normal variables
//! ```
//!
//! which is solved for `r_jk` pair by pair. The attainable correlations lie between the values of the series at -1 and 1.
//!
//! Rows of measured parts and zones are blocks beside them: each block is independent of everything else.

mod atom;
mod block;
mod correlated_normals;
mod error;
mod matrix;
mod solid_zone;
pub mod transform;

pub use crate::correlation::correlated_normals::Together;
pub use atom::Atom;
pub use block::{Block, JointLaw, Rows};
pub use error::{CorrelationError, Refusal};
pub use solid_zone::{SolidShape, SolidZone};
pub use transform::Transform;

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use faer::Mat;
use serde::Serialize;

use crate::dimension::Dimension;

/// Groups of dependent dimensions, as places in `dimensions`, ascending. An independent dimension is a group of its own.
pub fn factors(correlation: Option<&Correlation>, dimensions: &[usize]) -> Vec<Vec<usize>> {
    let mut factors: Vec<Vec<usize>> = Vec::new();
    for (place, &d) in dimensions.iter().enumerate() {
        let Some(of) = correlation.filter(|of| of.members().binary_search(&d).is_ok()) else {
            factors.push(vec![place]);
            continue;
        };
        let linked = |factor: &Vec<usize>| factor.iter().any(|&other| of.linked(d, dimensions[other]));
        // A dimension may link groups that were separate so far.
        let (together, apart): (Vec<_>, Vec<_>) = std::mem::take(&mut factors).into_iter().partition(linked);
        let mut own: Vec<usize> = together.into_iter().flatten().collect();
        own.push(place);
        own.sort_unstable();
        factors = apart;
        factors.push(own);
    }
    factors.sort_unstable();
    factors
}

/// Pair of dimensions with its coefficient of correlation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pair {
    /// Names of the two dimensions.
    pub between: [String; 2],
    /// Pearson's coefficient, from -1 to 1.
    pub value: f64,
}

/// Correlation of some of the dimensions. The others are independent of them and of each other.
///
/// ```
/// use sensitol_numeric::correlation::{Correlation, Pair};
/// use sensitol_numeric::dimension::Dimension;
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::uniform("b", 5.0, 0.1)?];
/// let pair = Pair { between: ["a".into(), "b".into()], value: 0.4 };
/// let correlation = Correlation::new(&dimensions, &[pair])?;
/// assert_eq!(correlation.of(0, 1), 0.4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Correlation {
    /// Correlated inputs, ascending: M of them.
    members: Vec<usize>,
    /// Correlation matrix of the inputs, M by M.
    target: Mat<f64>,
    /// Correlation matrix of the normal variables behind the inputs, M by M.
    normal: Mat<f64>,
    transforms: Vec<Arc<Transform>>,
    /// Members with a joint distribution of rows or a zone. Their normal variables are uncorrelated in `normal`.
    blocks: Vec<Block>,
}

impl Correlation {
    /// Correlation of these dimensions by these pairs. All other pairs are uncorrelated.
    ///
    /// # Errors
    /// See [`with_blocks`](Self::with_blocks).
    pub fn new(dimensions: &[Dimension], pairs: &[Pair]) -> Result<Self, CorrelationError> {
        Self::with_blocks(dimensions, pairs, Vec::new())
    }

    /// Correlation by pairs and by blocks. Block members are positions of dimensions, each in at most one block and in no pair.
    ///
    /// # Errors
    /// If a pair names an unknown or fixed dimension, appears twice, or has a value that its distributions do not allow. Also if no joint
    /// distribution has all pairs together: the matrix must not have a negative eigenvalue.
    pub fn with_blocks(dimensions: &[Dimension], pairs: &[Pair], blocks: Vec<Block>) -> Result<Self, CorrelationError> {
        let pairs = resolved(dimensions, pairs)?;
        let of_blocks = blocks.iter().flat_map(|block| block.members.iter().copied());
        let mut members: Vec<usize> = pairs.iter().flat_map(|&(ends, _)| ends).chain(of_blocks).collect();
        members.sort_unstable();
        members.dedup();
        let place = |d: usize| members.binary_search(&d).expect("an end of a pair is a member");
        // Check the pairs together first, so that the error names the nearest possible correlations.
        let mut target = Mat::identity(members.len(), members.len());
        for &([a, b], value) in &pairs {
            target[(place(a), place(b))] = value;
            target[(place(b), place(a))] = value;
        }
        let names = || members.iter().map(|&d| dimensions[d].name().to_owned()).collect::<Vec<_>>();
        if let Some(nearest) = matrix::nearest_if_indefinite(&target) {
            return Err(CorrelationError::indefinite(|nearest| Refusal::NoSuchMatrix { nearest }, &names(), &nearest));
        }
        // Solve for the correlation of the normal variables pair by pair. A correlation beyond the range of its two distributions is an
        // error.
        let transforms = transforms(dimensions, &members);
        let mut normal = Mat::identity(members.len(), members.len());
        for (index, &([a, b], value)) in pairs.iter().enumerate() {
            let (j, k) = (place(a), place(b));
            let behind = transforms[j].behind(&transforms[k], value).map_err(|range| CorrelationError {
                pair: Some(index),
                refusal: Refusal::Unreachable {
                    between: [a, b].map(|d| dimensions[d].name().to_owned()),
                    value,
                    range,
                },
            })?;
            normal[(j, k)] = behind;
            normal[(k, j)] = behind;
        }
        if let Some(nearest) = matrix::nearest_if_indefinite(&normal) {
            // Correlations of the inputs for the nearest matrix of the normal variables.
            let m = members.len();
            let seen = Mat::from_fn(m, m, |j, k| match j == k {
                true => 1.0,
                false => transforms[j].seen(&transforms[k], nearest[(j, k)]),
            });
            return Err(CorrelationError::indefinite(
                |nearest| Refusal::NotForTheseDistributions { nearest },
                &names(),
                &seen,
            ));
        }
        // Correlations within blocks follow from their joint distributions. The matrix of normal variables leaves them out, since blocks
        // have their own map.
        for Block { members, law } in &blocks {
            for (a, &d) in members.iter().enumerate() {
                for (b, &e) in members.iter().enumerate().filter(|&(b, _)| b != a) {
                    target[(place(d), place(e))] = law.correlation(a, b);
                }
            }
        }
        Ok(Self { members, target, normal, transforms, blocks })
    }

    /// Blocks, with members as positions of dimensions.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Block that a dimension belongs to, and its coordinate there. Returns None if it is in no block.
    pub fn block_of(&self, dimension: usize) -> Option<(usize, usize)> {
        let coordinate = |block: &Block| block.members.iter().position(|&member| member == dimension);
        self.blocks.iter().enumerate().find_map(|(index, block)| Some((index, coordinate(block)?)))
    }

    /// True if two dimensions are dependent, even if they are uncorrelated.
    pub(crate) fn linked(&self, a: usize, b: usize) -> bool {
        let by_block = || self.block_of(a).zip(self.block_of(b)).is_some_and(|((one, _), (other, _))| one == other);
        match (self.members.binary_search(&a), self.members.binary_search(&b)) {
            (Ok(j), Ok(k)) => self.normal[(j, k)] != 0.0 || by_block(),
            _ => false,
        }
    }

    /// Correlation without its blocks. Returns None if nothing is left.
    pub fn without_blocks(&self) -> Option<Self> {
        self.without(&|_| true)
    }

    /// Correlation without some of its blocks, given by their numbers. Returns None if nothing is left.
    pub(crate) fn without(&self, left_out: &dyn Fn(usize) -> bool) -> Option<Self> {
        let kept = |&d: &usize| self.block_of(d).is_none_or(|(block, _)| !left_out(block));
        let others: Vec<usize> = self.members.iter().copied().filter(kept).collect();
        let places: Vec<usize> = others.iter().filter_map(|d| self.members.binary_search(d).ok()).collect();
        let part = |of: &Mat<f64>| Mat::from_fn(places.len(), places.len(), |j, k| of[(places[j], places[k])]);
        (!others.is_empty()).then(|| Self {
            members: others,
            target: part(&self.target),
            normal: part(&self.normal),
            transforms: places.iter().map(|&j| Arc::clone(&self.transforms[j])).collect(),
            blocks: self.blocks.iter().enumerate().filter(|(b, _)| !left_out(*b)).map(|(_, of)| of.clone()).collect(),
        })
    }

    /// Dimensions that are correlated or in a block, ascending.
    pub fn members(&self) -> &[usize] {
        &self.members
    }

    /// Correlation matrix of the members, M by M.
    pub(crate) fn matrix(&self) -> &Mat<f64> {
        &self.target
    }

    /// Correlation matrix of the normal variables behind the members, M by M.
    pub fn normal(&self) -> &Mat<f64> {
        &self.normal
    }

    /// Transforms from the normal variables to the members.
    pub fn transforms(&self) -> &[Arc<Transform>] {
        &self.transforms
    }

    /// Correlation of two dimensions.
    pub fn of(&self, a: usize, b: usize) -> f64 {
        match (self.members.binary_search(&a), self.members.binary_search(&b)) {
            _ if a == b => 1.0,
            (Ok(j), Ok(k)) => self.target[(j, k)],
            _ => 0.0,
        }
    }

    /// True if the members are jointly normal.
    pub(crate) fn is_normal(&self) -> bool {
        self.transforms.iter().all(|transform| transform.is_normal())
    }

    /// Factor `L` with `L L' = normal()`, M by M: by Cholesky, or from the eigenvalues if the matrix is singular.
    pub fn factor(&self) -> Mat<f64> {
        matrix::factor(&self.normal)
    }

    /// Correlation among these dimensions only, with their positions in `dimensions`. Returns None if no two of them are dependent.
    pub fn among(&self, dimensions: &[usize]) -> Option<Self> {
        let kept: Vec<(usize, usize)> = (dimensions.iter().enumerate())
            .filter_map(|(position, d)| Some((position, self.members.binary_search(d).ok()?)))
            .filter(|&(_, j)| {
                let linked = |&k: &usize| k != self.members[j] && self.linked(self.members[j], k);
                self.members.iter().filter(|k| linked(k)).any(|k| dimensions.contains(k))
            })
            .collect();
        if kept.is_empty() {
            return None;
        }
        let place = |member: usize| dimensions.iter().position(|&d| d == member);
        let blocks = self.blocks.iter().filter_map(|block| block.among(&place)).collect();
        let part = |of: &Mat<f64>| Mat::from_fn(kept.len(), kept.len(), |j, k| of[(kept[j].1, kept[k].1)]);
        Some(Self {
            members: kept.iter().map(|&(position, _)| position).collect(),
            target: part(&self.target),
            normal: part(&self.normal),
            transforms: kept.iter().map(|&(_, j)| Arc::clone(&self.transforms[j])).collect(),
            blocks,
        })
    }
}

/// Resolves names to indices, and checks that each pair appears once and each dimension varies.
fn resolved(dimensions: &[Dimension], pairs: &[Pair]) -> Result<Vec<([usize; 2], f64)>, CorrelationError> {
    let named: HashMap<&str, usize> =
        dimensions.iter().enumerate().map(|(d, dimension)| (dimension.name(), d)).collect();
    let (mut found, mut seen) = (Vec::with_capacity(pairs.len()), HashSet::new());
    for (index, pair) in pairs.iter().enumerate() {
        let refused = |refusal| CorrelationError { pair: Some(index), refusal };
        let mut ends = [0; 2];
        for (end, name) in ends.iter_mut().zip(&pair.between) {
            let Some(&position) = named.get(name.as_str()) else {
                return Err(refused(Refusal::unknown(name, dimensions)));
            };
            let name = || name.clone();
            match dimensions[position].distribution() {
                None => return Err(refused(Refusal::DoesNotVary { name: name() })),
                Some(law) if law.probability().is_none() => {
                    return Err(refused(Refusal::MomentsOnly { name: name() }));
                }
                Some(_) if dimensions[position].convention().promise.is_some() => {
                    return Err(refused(Refusal::AnyDistribution { name: name() }));
                }
                Some(_) => *end = position,
            }
        }
        if ends[0] == ends[1] {
            return Err(refused(Refusal::WithItself { name: pair.between[0].clone() }));
        }
        if !(-1.0..=1.0).contains(&pair.value) {
            return Err(refused(Refusal::NoCoefficient { value: pair.value }));
        }
        ends.sort_unstable();
        if !seen.insert(ends) {
            return Err(refused(Refusal::Twice { between: pair.between.clone() }));
        }
        found.push((ends, pair.value));
    }
    Ok(found)
}

fn transforms(dimensions: &[Dimension], members: &[usize]) -> Vec<Arc<Transform>> {
    let transform = |&d: &usize| {
        let distribution = dimensions[d].distribution().expect("a member varies");
        Arc::new(Transform::of(distribution).expect("a member is known whole"))
    };
    members.iter().map(transform).collect()
}
