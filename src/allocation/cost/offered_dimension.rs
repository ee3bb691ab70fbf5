//! Dimensions as offers make them: one path for processes with distributions of their own and for plain tolerances.

use crate::allocation::cost::priced_group::{Offer, Priced};
use sensitol_numeric::dimension::{Dimension, DimensionError};

impl Offer {
    /// Dimension at a half band: that of the process about the present nominal value, or the present one scaled. `place`
    /// is the position among the members of the group. Returns None if the distribution cannot follow.
    pub(in crate::allocation) fn dimension(
        &self,
        place: usize,
        present: &Dimension,
        half_band: f64,
    ) -> Option<Result<Dimension, DimensionError>> {
        match &self.made {
            Some(process) => process.dimensions()[place].moved(present.nominal()),
            None => present.scaled(half_band / present.half_band()),
        }
    }
}

impl Priced {
    /// Dimensions of the members at a half band of an offer, in the order of the members. A dimension that cannot follow
    /// is None. `half_band` gives the half band of a member from its present dimension and its share.
    pub(in crate::allocation) fn offered<'p>(
        &'p self,
        offer: &'p Offer,
        present: &'p [Dimension],
        half_band: impl Fn(&Dimension, f64) -> f64 + 'p,
    ) -> impl Iterator<Item = (usize, Option<Result<Dimension, DimensionError>>)> + 'p {
        self.members.iter().enumerate().map(move |(place, &d)| {
            let own = &present[d];
            (d, offer.dimension(place, own, half_band(own, self.share(place))))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::allocation::cost::cost_curve::Curve;
    use crate::allocation::cost::process_option::Made;

    fn present() -> Vec<Dimension> {
        vec![Dimension::normal("a", 10.0, 0.25).unwrap(), Dimension::normal("b", 6.0, 0.5).unwrap()]
    }

    fn offered(offer: &Offer, half_band: f64) -> Vec<Dimension> {
        let group = Priced::new(vec![0, 1], vec![offer.clone()]).unwrap();
        let of = |made: Option<Result<Dimension, DimensionError>>| made.unwrap().unwrap();
        group.offered(offer, &present(), |_, share| share * half_band).map(|(_, made)| of(made)).collect()
    }

    #[test]
    fn a_plain_tolerance_scales_the_present_dimensions() {
        let plain = Offer::between(Curve::reciprocal(1.0, 0.1).unwrap(), 0.01, 1.0).unwrap();
        let found = offered(&plain, 0.125);
        assert_eq!([found[0].half_band(), found[1].half_band()], [0.125, 0.125]);
        // Normal dimensions have a third of the half band as sigma.
        assert!((found[0].sigma() - 0.125 / 3.0).abs() < 1e-15 && found[0].nominal() == 10.0);
    }

    #[test]
    fn a_process_gives_its_distributions_about_the_present_nominal_values() {
        let of_process =
            vec![Dimension::uniform("a", 1.0, 0.125).unwrap(), Dimension::uniform("b", 2.0, 0.125).unwrap()];
        let mut process = Offer::process("ground", 0.125, 4.0).unwrap();
        process.made = Some(Made::new(of_process));
        let found = offered(&process, 0.125);
        assert_eq!([found[0].nominal(), found[1].nominal()], [10.0, 6.0]);
        // Uniform over the band.
        assert!((found[1].sigma() - 0.125 / 3f64.sqrt()).abs() < 1e-15);
    }
}
