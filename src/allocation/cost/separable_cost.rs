//! Costs of tolerances as a separable problem.

use crate::allocation::cost::priced_group::{Offer, Priced};
use sensitol_numeric::optimise::separable::{BoundedCost, CostedUnknown};

impl BoundedCost for Offer {
    fn bounds(&self) -> [f64; 2] {
        [self.min, self.max]
    }

    fn cost(&self, t: f64) -> f64 {
        self.curve.cost(t)
    }

    fn cost_by(&self, t: f64, ln: f64) -> f64 {
        self.curve.cost_by(t, ln)
    }

    fn log_derivatives(&self, t: f64, ln: f64) -> [f64; 2] {
        self.curve.log_derivatives(t, ln)
    }

    fn with_slope(&self, t: f64, ln: f64) -> [f64; 2] {
        self.curve.with_slope(t, ln)
    }
}

impl CostedUnknown for Priced {
    type Option = Offer;

    fn weight(&self) -> f64 {
        self.parts
    }

    fn options(&self) -> &[Offer] {
        &self.offers
    }
}
