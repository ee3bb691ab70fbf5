//! Points of the model: verification, samples where a surface is not trusted, resamples of measured values.

pub(in crate::analysis) mod accuracy_target;
pub(in crate::analysis) mod axis_effect;
pub(in crate::analysis) mod bootstrap;
pub(in crate::analysis) mod choice_sample;
pub(in crate::analysis) mod cross_fit;
pub(in crate::analysis) mod jump;
pub(in crate::analysis) mod known_answers;
pub(in crate::analysis) mod measured_interval;
pub(in crate::analysis) mod model_sample;
pub(in crate::analysis) mod nominal_kink;
pub(in crate::analysis) mod recorded_failures;
pub(in crate::analysis) mod recorded_points;
pub(in crate::analysis) mod resample_interval;
pub(in crate::analysis) mod sample_budget;
pub(in crate::analysis) mod surface_trust;
pub(in crate::analysis) mod tail_sample;
pub(in crate::analysis) mod verification_stage;
