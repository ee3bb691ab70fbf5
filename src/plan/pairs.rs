//! Pairs of dimensions that a plan examines, and the stencils for them.

use std::fmt;

use std::str::FromStr;

use sensitol_numeric::names::UnknownName;

/// Choice of the mixed derivatives that are evaluated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PairChoice {
    /// No mixed derivative.
    None,
    /// Every pair on which some characteristic can depend jointly.
    All,
    /// Pairs with the largest product of univariate variance shares, in the characteristic with the largest one: as many as there are
    /// dimensions. They are ranked after the axes are evaluated.
    Strongest,
    /// Neighbours in the order of the dimensions, the last with the first: as many pairs as dimensions.
    Adjacent,
    /// These pairs of dimensions.
    Listed(Vec<(usize, usize)>),
}

/// Stencil of a mixed derivative, in addition to the values on the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stencil {
    /// Two evaluations, with both dimensions up and both down. Exact up to the third order. A fourth-order term in `u_j^2 u_k^2` disturbs
    /// it.
    TwoPoint,
    /// Four evaluations, at all four corners, as in the published 6N+1 scheme: also free of even terms.
    FourPoint,
}

impl Stencil {
    /// Names of the stencils.
    pub const NAMES: [&str; 2] = ["two-point", "four-point"];

    /// Name in study files and on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::TwoPoint => "two-point",
            Self::FourPoint => "four-point",
        }
    }

    /// Number of evaluations per pair.
    pub(crate) fn evaluations(self) -> usize {
        match self {
            Self::TwoPoint => 2,
            Self::FourPoint => 4,
        }
    }

    /// Corners, as the sides of the first and of the second dimension. The first two lie where parts with a correlation of this sign are
    /// likely.
    pub(super) fn corners(self, opposite: bool) -> &'static [(Side, Side)] {
        const ALIKE: [(Side, Side); 4] = [
            (Side::Right, Side::Right),
            (Side::Left, Side::Left),
            (Side::Right, Side::Left),
            (Side::Left, Side::Right),
        ];
        const OPPOSITE: [(Side, Side); 4] = [ALIKE[2], ALIKE[3], ALIKE[0], ALIKE[1]];
        let all = if opposite { &OPPOSITE } else { &ALIKE };
        &all[..self.evaluations()]
    }
}

/// Side of the mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// Strongest pairs by the product of two shares, `count` of them, as positions `j < k`. Equal ones are taken in ascending order. `shares`
/// has a row per characteristic. `joint` returns true if a pair can matter to a characteristic.
pub(super) fn strongest(
    count: usize,
    shares: &[Vec<f64>],
    joint: impl Fn(usize, usize, usize) -> bool,
) -> Vec<(usize, usize)> {
    let dimensions = shares.first().map_or(0, Vec::len);
    let mut ranked = Vec::new();
    for j in 0..dimensions {
        for k in j + 1..dimensions {
            let of = |c: usize| joint(c, j, k).then(|| shares[c][j] * shares[c][k]);
            if let Some(score) = (0..shares.len()).filter_map(of).reduce(f64::max) {
                ranked.push((score, j, k));
            }
        }
    }
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut pairs: Vec<(usize, usize)> = ranked.into_iter().take(count).map(|(_, j, k)| (j, k)).collect();
    pairs.sort_unstable();
    pairs
}

impl fmt::Display for Stencil {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Stencil {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        UnknownName::find("stencil", name, &[Self::TwoPoint, Self::FourPoint], |stencil| stencil.name())
    }
}
