//! Interactions and Sobol' indices of a characteristic.

use serde::Serialize;

use crate::analysis::result::interaction::InteractionList;
use crate::analysis::result::interaction_remainder::Remainder;
use crate::analysis::result::sobol_indices::SobolIndices;
use sensitol_numeric::power::rescale;

/// Contributions to the variance beside those of single dimensions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContributionFigures {
    /// Examined interactions, strongest first.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<crate::analysis::Interaction<'_>>"))]
    pub interactions: InteractionList,
    /// Sum of the interactions that are not listed one by one. None if all are listed.
    pub interactions_remainder: Option<Remainder>,
    /// Number of possible interactions.
    pub possible_interactions: usize,
    /// Number of interactions that were examined, or are known from the formula.
    pub examined_interactions: usize,
    /// Share of the variance that no contribution explains. None if it is unknown.
    pub left_out_share: Option<f64>,
    /// Source of the Sobol' indices of the `sensitivities`. None if the characteristic does not vary.
    #[serde(rename = "sobol")]
    pub indices: Option<SobolIndices>,
}

rescale!(ContributionFigures { interactions } without {
    interactions_remainder, possible_interactions, examined_interactions, left_out_share, indices,
});
