//! Exact derivatives, of the functions that know them.

use sensitol_numeric::power::Power;

/// Where derivatives are asked for, and which.
#[derive(Debug, Clone, Copy)]
pub struct Directions<'a> {
    /// The point.
    pub point: &'a [f64],
    /// The inputs along which first and second derivatives are wanted.
    pub inputs: &'a [usize],
    /// The pairs of inputs whose mixed second derivative is wanted.
    pub pairs: &'a [(usize, usize)],
}

/// One output's derivatives at a point; None for those that do not exist there, as at a kink.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// By each input asked.
    pub first: Vec<Option<f64>>,
    /// Twice by each input asked.
    pub second: Vec<Option<f64>>,
    /// By both inputs of each pair asked.
    pub mixed: Vec<Option<f64>>,
}

impl Derivatives {
    /// Of the output times a power of two; None for one that a double cannot hold.
    pub(crate) fn times(mut self, power: Power) -> Self {
        let Self { first, second, mixed } = &mut self;
        for one in first.iter_mut().chain(second).chain(mixed) {
            *one = one.and_then(|value| power.checked(value));
        }
        self
    }

    /// Per unit of each input that is a power of two, from those per unit of 1.
    pub(crate) fn per(mut self, directions: &Directions<'_>, units: &dyn Fn(usize) -> Power) -> Self {
        let times = |value: &mut Option<f64>, power: Power| *value = value.and_then(|value| power.checked(value));
        for (place, &input) in directions.inputs.iter().enumerate() {
            times(&mut self.first[place], units(input));
            times(&mut self.second[place], units(input).squared());
        }
        for (mixed, &(j, k)) in self.mixed.iter_mut().zip(directions.pairs) {
            times(mixed, units(j).and(units(k)));
        }
        self
    }
}
