//! Steps from round to round: whole ones, and shorter ones if the model differs from the prediction of its derivatives.
//!
//! ```text
//! T_(k+1) = T_k exp(w_k r_k),   r_k = ln(T chosen / T_k),   w_k = -w_(k-1) r_(k-1).(r_k - r_(k-1))/|r_k - r_(k-1)|^2
//! ```
//!
//! if `r` does not at least halve by itself, and `w = 1` if it does. Source: B. M. Irons, R. C. Tuck, "A version of the
//! Aitken accelerator for computer iteration", Int. J. Numerical Methods in Engineering 1 (1969). Here `w` lies between
//! 0.1 and 1.

/// Last step and the part of it that was taken.
#[derive(Debug, Default)]
pub(in crate::allocation) struct Steps {
    last: Option<(Vec<f64>, f64)>,
}

impl Steps {
    /// Half bands of a shortened step from `from` to `to`. Returns None for a whole step.
    pub(in crate::allocation) fn shortened(&mut self, from: &[f64], to: &[f64]) -> Option<Vec<f64>> {
        let way: Vec<f64> = from.iter().zip(to).map(|(from, to)| libm::log(to / from)).collect();
        let longest = |way: &[f64]| way.iter().fold(0.0f64, |longest, way| longest.max(way.abs()));
        let part = match &self.last {
            Some((last, part)) if longest(&way) > 0.5 * longest(last) => {
                let (mut along, mut square) = (0.0, 0.0);
                for (way, last) in way.iter().zip(last) {
                    along += last * (way - last);
                    square += (way - last).powi(2);
                }
                if square > 0.0 { (-part * along / square).clamp(0.1, 1.0) } else { 1.0 }
            }
            _ => 1.0,
        };
        let shortened =
            (part < 1.0).then(|| from.iter().zip(&way).map(|(from, way)| from * libm::exp(part * way)).collect());
        self.last = Some((way, part));
        shortened
    }
}
