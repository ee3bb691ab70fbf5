//! Columns of independent standard normal variables.

use crate::distribution::{standard_normal, ziggurat};
use crate::parallel::prelude::*;
use crate::sampling::draws::tails;
use crate::sampling::sobol::{Sobol, mixed};
use crate::sampling::stream::Stream;

/// Greatest number of variables for which Sobol' points are used. With more, a few thousand of them are no more even than random points.
const QUASI: usize = 256;

/// Smallest number of numbers in all columns for which every variable becomes a parallel task.
const MANY: usize = 1 << 17;

/// Points of independent standard normal variables: Sobol' points, scrambled anew in every stream, or random ones for many variables.
///
/// Every stream can be drawn at any time and is always the same.
pub struct Normals {
    dimensions: usize,
    sobol: Option<Sobol>,
    seed: u64,
}

impl Normals {
    /// Sobol' points up to 256 variables, random points beyond.
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let sobol = if dimensions <= QUASI { Sobol::new(dimensions) } else { None };
        Self { dimensions, sobol, seed }
    }

    /// Random points for any number of variables.
    pub fn random(dimensions: usize, seed: u64) -> Self {
        Self { dimensions, sobol: None, seed }
    }

    /// First `rows` points of a stream, as one column for every variable.
    pub fn columns(&self, stream: u64, rows: usize) -> Vec<Vec<f64>> {
        let column = |place: usize| {
            let key = mixed(mixed(mixed(self.seed).wrapping_add(stream)).wrapping_add(place as u64));
            let mut column = vec![0.0; rows];
            match &self.sobol {
                Some(sobol) => {
                    let mut digits = vec![0; rows];
                    sobol.digits(place, 0, &mut digits);
                    tails(&digits, key, &mut column);
                    standard_normal::quantiles(&mut column);
                }
                None => ziggurat::normals(&mut Stream::new(key), ziggurat::STANDARD, &mut column),
            }
            column
        };
        match rows * self.dimensions > MANY {
            true => (0..self.dimensions).into_par_iter().map(column).collect(),
            false => (0..self.dimensions).map(column).collect(),
        }
    }
}
