//! A figure by the model itself, with its error.

use serde::Serialize;

use sensitol_numeric::power::{Losable, Rescale, Rescaling};

/// A figure by the model itself, with its error. The true value lies within three of these errors whenever it lies within three standard
/// errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Verified {
    /// The value.
    pub value: f64,
    /// Estimated error of the value.
    pub error: f64,
}

impl Rescale for Verified {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.value.rescale(by);
        self.error.rescale(by);
    }
}

impl Losable for Verified {
    fn is_unknown(&self) -> bool {
        self.value.is_nan()
    }
}

impl Verified {
    /// Error of another value for the same figure: `hypot(value - own, error)`. The true value lies within three of it whenever it lies
    /// within three of the own error.
    ///
    /// ```
    /// use sensitol::analysis::Verified;
    /// assert_eq!(Verified { value: 1.0, error: 3.0 }.error_of(5.0), 5.0);
    /// ```
    pub fn error_of(&self, value: f64) -> f64 {
        libm::hypot(value - self.value, self.error)
    }

    /// Adds the weight of one point to the error of a share, because a rare event may exist although no point shows it.
    pub(crate) fn with_point(self, weight: f64) -> Self {
        Self { error: libm::hypot(self.error, weight), ..self }
    }
}
