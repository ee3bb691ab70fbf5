//! Block-triangular order of equations: blocks that are solved one after the other, each with as few unknowns as possible.
//!
//! A maximum matching gives every equation an unknown of its own. Equations that need each other's unknowns are a strongly connected
//! component (Tarjan 1972), which is a block (Duff, Erisman, Reid, "Direct methods for sparse matrices", section 6).

/// Equations that are solved together, with as many unknowns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) equations: Vec<usize>,
    pub(super) unknowns: Vec<usize>,
}

/// Unknowns in the equations.
pub(super) struct Structure {
    /// Unknowns by which every equation has a derivative, ascending.
    pub(super) slopes: Vec<Vec<usize>>,
    /// Unknowns on which the value of every equation depends, ascending. They include those with a derivative.
    pub(super) uses: Vec<Vec<usize>>,
}

/// Search for strongly connected components.
struct Components<'s> {
    structure: &'s Structure,
    /// Equation of every unknown.
    owner: &'s [usize],
    /// Order in which equations were reached, 0 if they were not.
    reached: Vec<usize>,
    /// Earliest equation that is reached from an equation.
    earliest: Vec<usize>,
    open: Vec<usize>,
    is_open: Vec<bool>,
    count: usize,
    found: Vec<Vec<usize>>,
}

impl Structure {
    /// Returns the blocks in the order of solution, or None if the equations are singular for any values.
    pub(super) fn blocks(&self) -> Option<Vec<Block>> {
        let owner = self.matching()?;
        let count = self.uses.len();
        let mut unknown_of = vec![0; count];
        owner.iter().enumerate().for_each(|(unknown, &equation)| unknown_of[equation] = unknown);
        let mut search = Components {
            structure: self,
            owner: &owner,
            reached: vec![0; count],
            earliest: vec![0; count],
            open: Vec::new(),
            is_open: vec![false; count],
            count: 0,
            found: Vec::new(),
        };
        for equation in 0..count {
            if search.reached[equation] == 0 {
                search.visit(equation);
            }
        }
        let block = |mut equations: Vec<usize>| {
            equations.sort_unstable();
            let mut unknowns: Vec<usize> = equations.iter().map(|&equation| unknown_of[equation]).collect();
            unknowns.sort_unstable();
            Block { equations, unknowns }
        };
        Some(search.found.into_iter().map(block).collect())
    }

    /// Returns an equation for every unknown, each once, or None if there is no such assignment.
    fn matching(&self) -> Option<Vec<usize>> {
        let mut owner = vec![None; self.slopes.len()];
        for equation in 0..self.slopes.len() {
            if !self.assign(equation, &mut owner, &mut vec![false; self.slopes.len()]) {
                return None;
            }
        }
        owner.into_iter().collect()
    }

    /// Assigns an unknown to an equation, where others may change theirs. Returns false if that is impossible.
    fn assign(&self, equation: usize, owner: &mut [Option<usize>], tried: &mut [bool]) -> bool {
        self.slopes[equation].iter().any(|&unknown| {
            if std::mem::replace(&mut tried[unknown], true) {
                return false;
            }
            let free = owner[unknown].is_none_or(|other| self.assign(other, owner, tried));
            if free {
                owner[unknown] = Some(equation);
            }
            free
        })
    }
}

impl Components<'_> {
    /// Visits an equation after all equations whose unknowns it uses. A component is complete before any other equation that uses it.
    fn visit(&mut self, equation: usize) {
        self.count += 1;
        (self.reached[equation], self.earliest[equation]) = (self.count, self.count);
        self.open.push(equation);
        self.is_open[equation] = true;
        let structure = self.structure;
        for &unknown in &structure.uses[equation] {
            let next = self.owner[unknown];
            if self.reached[next] == 0 {
                self.visit(next);
                self.earliest[equation] = self.earliest[equation].min(self.earliest[next]);
            } else if self.is_open[next] {
                self.earliest[equation] = self.earliest[equation].min(self.reached[next]);
            }
        }
        if self.earliest[equation] == self.reached[equation] {
            let first = self.open.iter().position(|&other| other == equation).expect("it is open");
            let component = self.open.split_off(first);
            component.iter().for_each(|&member| self.is_open[member] = false);
            self.found.push(component);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Block, Structure};

    fn blocks(uses: &[&[usize]]) -> Option<Vec<Block>> {
        let uses: Vec<Vec<usize>> = uses.iter().map(|uses| uses.to_vec()).collect();
        Structure { slopes: uses.clone(), uses }.blocks()
    }

    fn block(equations: &[usize], unknowns: &[usize]) -> Block {
        Block { equations: equations.to_vec(), unknowns: unknowns.to_vec() }
    }

    #[test]
    fn equations_wait_for_the_unknowns_that_they_use() {
        // Equations 0 and 2 need unknown 1, which equation 1 determines alone.
        assert_eq!(
            blocks(&[&[1, 2], &[1], &[0, 1]]),
            Some(vec![block(&[1], &[1]), block(&[0], &[2]), block(&[2], &[0])])
        );
        // A ring is one block, and what hangs on it comes after it.
        let ring = blocks(&[&[3, 0], &[0, 1], &[1, 2], &[2, 0]]);
        assert_eq!(ring, Some(vec![block(&[1, 2, 3], &[0, 1, 2]), block(&[0], &[3])]));
    }

    #[test]
    fn equations_without_an_unknown_of_their_own_have_no_order() {
        assert_eq!(blocks(&[&[0], &[0]]), None);
        assert_eq!(blocks(&[&[0, 1], &[0, 1], &[]]), None);
    }

    /// An equation that uses an unknown in steps only waits for it, but cannot determine it.
    #[test]
    fn a_value_without_a_derivative_counts_for_the_order() {
        let structure = Structure { slopes: vec![vec![0], vec![1]], uses: vec![vec![0, 1], vec![1]] };
        assert_eq!(structure.blocks(), Some(vec![block(&[1], &[1]), block(&[0], &[0])]));
    }
}
