//! Exact derivatives, for functions that have them.

use sensitol_numeric::power::Power;

/// Point and directions of the requested derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Directions<'a> {
    /// Point at which derivatives are requested.
    pub point: &'a [f64],
    /// Inputs along which first and second derivatives are requested.
    pub inputs: &'a [usize],
    /// Pairs of inputs whose mixed second derivative is requested.
    pub pairs: &'a [(usize, usize)],
}

/// Derivatives of one output at a point; None for one that does not exist there, as at a kink.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// First derivative by each requested input.
    pub first: Vec<Option<f64>>,
    /// Second derivative by each requested input.
    pub second: Vec<Option<f64>>,
    /// Mixed derivative by both inputs of each requested pair.
    pub mixed: Vec<Option<f64>>,
}

impl Derivatives {
    /// Returns the derivatives of the output times a power of two; None for one that a double cannot hold.
    pub(crate) fn times(mut self, power: Power) -> Self {
        let Self { first, second, mixed } = &mut self;
        for one in first.iter_mut().chain(second).chain(mixed) {
            *one = one.and_then(|value| power.checked(value));
        }
        self
    }

    /// Converts derivatives per unit of 1 to derivatives per unit of each input, a power of two.
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
