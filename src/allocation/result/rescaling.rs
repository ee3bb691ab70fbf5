//! Conversion of an allocation back to the units of its problem.

use crate::allocation::result::allocation::{Allocation, Attainable, FrontPoint, Kept, ShadowPrice};
use crate::allocation::task::AllocateError;
use crate::evaluation::{Restoration, Restore};
use sensitol_numeric::power::{Power, Rescaling};

impl Restore for Allocation {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        // The problem found has the function of the run, so it is restored in any case.
        self.problem = back.problem.restored(&self.problem);
        if back.is_nothing() {
            return;
        }
        self.before.rescale(back);
        self.after.iter_mut().for_each(|after| after.rescale(back));
        self.confirmation.iter_mut().for_each(|simulation| simulation.rescale(back));
        self.requirements.iter_mut().for_each(|kept| kept.times(back.power(kept.characteristic)));
        self.prices.iter_mut().for_each(|price| price.per(back.power(price.characteristic)));
        self.attainable.iter_mut().for_each(|best| best.times(back.power(best.characteristic)));
        self.front.iter_mut().for_each(|point| point.times(back));
        self.warnings.iter_mut().for_each(|warning| warning.rescale(|name| back.power_of(name)));
    }
}

impl Restore for AllocateError {
    fn restore(&mut self, back: &Restoration<'_>) {
        match self {
            Self::Method(error) => error.restore(back),
            Self::Simulation(error) => error.restore(back),
            _ => {}
        }
    }
}

impl Kept {
    fn times(&mut self, power: Power) {
        self.requirement = self.requirement.times(power);
        self.before = self.before.times(power);
        self.after = self.after.map(|after| after.times(power));
        self.sampled = self.sampled.map(|sampled| sampled.times(power));
    }
}

impl ShadowPrice {
    /// Converts the prices from the divided unit of the characteristic to its own, which is a power of two times as
    /// large or as small.
    fn per(&mut self, power: Power) {
        let Self { characteristic: _, both, widen, narrow, lower, upper, sigma } = self;
        for price in [both, widen, narrow, lower, upper, sigma] {
            *price = price.and_then(|price| power.inverse().checked(price));
        }
    }
}

impl Attainable {
    fn times(&mut self, power: Power) {
        if self.requirement.has_unit() {
            self.requirement = self.requirement.times(power);
            self.best = self.best.and_then(|best| power.checked(best));
        }
    }
}

impl FrontPoint {
    fn times(&mut self, back: &Restoration<'_>) {
        for required in &mut self.required {
            if required.requirement.has_unit() {
                let power = back.power_of(&required.characteristic);
                required.requirement = required.requirement.times(power);
                Rescaling::by(power).multiply(&mut required.amount);
            }
        }
    }
}
