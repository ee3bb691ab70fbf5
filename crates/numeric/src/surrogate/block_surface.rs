//! Surface over blocks and other inputs, prepared for pooling or sampling.

use crate::correlation::{Atom, Correlation};
use crate::surrogate::{InputShape, Inputs, Surrogate, Univariate};

/// Degrees that the places of blocks must integrate: the fourth power of a parabola, and of a quartic.
const DEGREES: [usize; 2] = [8, 16];

/// Surface over blocks and other inputs, divided by its largest coefficient.
pub(super) struct Setting<'a> {
    pub(super) parts: Vec<Univariate>,
    pub(super) pairs: Vec<(usize, usize, f64)>,
    pub(super) shapes: &'a [InputShape],
    pub(super) correlation: &'a Correlation,
    /// Block and coordinate of every input. None if it is in no block.
    pub(super) block_of: Vec<Option<(usize, usize)>>,
    /// Places of every block.
    pub(super) atoms: Vec<Vec<Atom>>,
    pub(super) scale: f64,
    pub(super) centre: f64,
}

impl<'a> Setting<'a> {
    pub(super) fn of(surrogate: &Surrogate, inputs: &'a Inputs, correlation: &'a Correlation) -> Option<Self> {
        let parts: Vec<Univariate> = surrogate.parts.iter().copied().collect::<Option<_>>()?;
        let pairs = surrogate.interactions.pairs();
        let of_pairs = pairs.iter().map(|(_, _, value)| value.abs());
        let scale = parts.iter().map(|part| part.largest()).chain(of_pairs).fold(0.0, f64::max);
        let by = if scale > 0.0 { 1.0 / scale } else { 1.0 };
        let parabolas = correlation.members().iter().all(|&j| parts[j].parabola().is_some());
        let degree = DEGREES[usize::from(!parabolas)];
        Some(Self {
            parts: parts.iter().map(|part| part.sum(by, part, 0.0)).collect(),
            pairs: pairs.into_iter().map(|(j, k, value)| (j, k, by * value)).collect(),
            shapes: inputs.shapes(),
            correlation,
            block_of: (0..parts.len()).map(|j| correlation.block_of(j)).collect(),
            atoms: correlation.blocks().iter().map(|block| block.law.atoms(degree)).collect(),
            scale,
            centre: surrogate.centre,
        })
    }

    /// Slope of the best straight line of an input's part.
    pub(super) fn line(&self, j: usize) -> f64 {
        match self.block_of[j] {
            None => self.parts[j].term(&self.shapes[j]).part(1.0).p,
            Some((block, coordinate)) => (self.atoms[block].iter())
                .map(|atom| atom.weight * atom.u[coordinate] * self.parts[j].value(atom.u[coordinate]))
                .sum(),
        }
    }
}
