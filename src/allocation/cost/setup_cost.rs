//! Cost of setting up machines.

use serde::Serialize;

use crate::allocation::cost::cost_error::CostError;
use crate::allocation::cost::priced_group::Offer;

/// Greatest number of machines. More would have too many sets to examine.
pub(in crate::allocation) const MOST: usize = 12;

/// Machine with its set-up cost, which is paid once for all dimensions whose processes need it.
///
/// ```
/// use sensitol::allocation::SetUp;
/// assert_eq!(SetUp::new("grinder", 8.0)?.cost, 8.0);
/// assert!(SetUp::new("grinder", -8.0).is_err());
/// # Ok::<(), sensitol::allocation::CostError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SetUp {
    /// Name of the machine.
    pub machine: String,
    /// Cost of setting it up.
    pub cost: f64,
}

impl SetUp {
    /// Creates the set-up cost of a machine.
    ///
    /// # Errors
    ///
    /// If the cost is negative or not finite.
    pub fn new(machine: impl Into<String>, cost: f64) -> Result<Self, CostError> {
        match cost.is_finite() && cost >= 0.0 {
            true => Ok(Self { machine: machine.into(), cost }),
            false => Err(CostError::Negative { name: "set-up", value: cost }),
        }
    }
}

/// Set-ups that some offers need, each once.
pub(in crate::allocation) fn needed<'s>(setups: &'s [SetUp], offers: &[&Offer]) -> Vec<&'s SetUp> {
    let needs = |setup: &&SetUp| offers.iter().any(|offer| offer.machine.as_ref() == Some(&setup.machine));
    setups.iter().filter(needs).collect()
}
