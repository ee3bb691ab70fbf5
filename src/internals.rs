//! The inside of the library for the tests and the benchmarks of this repository: not part of the public interface, and no
//! promise.

pub use crate::allocation::knapsack::cheapest;
pub use crate::allocation::lists::{ListChoice, ListOption};
pub use crate::analysis::law_at::law_at;
pub use crate::analysis::surface_law::QUANTILES;
pub use crate::assembly::formula::interval::Interval;
pub use crate::assembly::formula::jet::Jet;
pub use crate::assembly::formula::parser::is_reserved;
pub use crate::assembly::formula::set::{FormulaSet, Meaning};
pub use crate::correlation::transform::Transform;
pub use crate::distribution::outliers::{extreme, outliers};
pub use crate::distribution::rule::Rule;
pub use crate::distribution::sample::{Resample, Sample};
#[cfg(feature = "journal")]
pub use crate::journal::store::{Store, StoredAnswer};
pub use crate::law::{LawOptions, LawTail, SurfaceLaw, joint_yield};
pub use crate::method::procedure::Procedure;
pub use crate::method::registry::{ALL, procedure};
pub use crate::moments::{Interactions, Tables, Term, contributions, of_quadratic};
pub use crate::plan::{Nodes, Plan, Spread, corners};
#[cfg(feature = "report")]
pub use crate::report::csv::{csv_file_names, csv_tables, stack_csv};
#[cfg(feature = "html")]
pub use crate::report::html::{WhatIf, analyze_html};
pub use crate::sampling::{
    Draws, Fine, Portion, SOBOL_DIMENSIONS, Scale, Sobol, Summary, clopper_pearson, rank_first, wilson,
};
#[cfg(feature = "cli")]
pub use crate::study::schema::schema;
pub use crate::surrogate::{InputShape, Inputs, Surrogate, Univariate, shapes};
#[cfg(feature = "task")]
pub use crate::task;
pub use crate::verdict::of_cpk;
pub use crate::verification::{SampledFigures, Target, unseen, variance_shares, verify_by_checks, verify_by_sampling};
pub use crate::warning::aggregate::aggregated;

/// The share that the outer quantiles of reports leave out on a side.
pub const TAIL: f64 = crate::capability::TAIL;

/// Functions and constants of public types that the library keeps to itself. Tests import them with their traits:
/// `use sensitol::internals::reach::*`.
#[allow(clippy::new_ret_no_self, reason = "a trait of a type returns the type")]
pub mod reach {
    use crate::allocation::Priced;
    use crate::analysis::{CharacteristicAnalysis, Relocation};
    use crate::assembly::formula::FormulaFault;
    #[cfg(feature = "process")]
    use crate::assembly::process::{Process, ProcessError};
    use crate::assembly::{EvaluationError, ModelInfo, Responses, Switch};
    use crate::capability::Capability;
    use crate::characteristic::SpecLimits;
    use crate::correlation::{Correlation, CorrelationError, Pair};
    use crate::dimension::{Dimension, DimensionError};
    use crate::distribution::{
        Beta, DistributionError, Jacobi, Rule, StandardMoments, Trapezoidal, Triangular, TruncatedNormal,
    };
    use crate::fits::FitError;
    use crate::method::{ErrorEstimate, MethodError};
    use crate::moments::Moments;
    use crate::pearson::{Pearson, PearsonError, TwoPoint};
    use crate::problem::Problem;
    #[cfg(feature = "report")]
    use crate::report::Style;
    use crate::requirement::Requirement;
    use crate::simulation::Pace;
    #[cfg(feature = "study")]
    use crate::study::{DataProblem, Study, StudyError};
    use crate::summary::RunSummary;
    use crate::verdict::Verdict;
    use crate::verification::Verified;
    use crate::warning::{Advice, Warning};

    /// A trait of functions and constants that the type itself has within the crate.
    macro_rules! reach {
        ($($(#[$cfg:meta])* $name:ident of $type:ty {
            $(fn $method:ident(&self $(, $argument:ident: $argument_type:ty)*) -> $result:ty;)*
            $(new $made:ident($($part:ident: $part_type:ty),*) -> $out:ty;)*
            $(const $constant:ident: $constant_type:ty;)*
        })*) => {$(
            $(#[$cfg])*
            pub trait $name: Sized {
                $(fn $method(&self $(, $argument: $argument_type)*) -> $result;)*
                $(fn $made($($part: $part_type),*) -> $out;)*
                $(const $constant: $constant_type;)*
            }
            $(#[$cfg])*
            impl $name for $type {
                $(fn $method(&self $(, $argument: $argument_type)*) -> $result {
                    <$type>::$method(self $(, $argument)*)
                })*
                $(fn $made($($part: $part_type),*) -> $out {
                    <$type>::$made($($part),*)
                })*
                $(const $constant: $constant_type = <$type>::$constant;)*
            }
        )*};
    }

    reach! {
        OfPriced of Priced {
            fn cost_to_hold(&self, t: f64) -> Option<f64>;
            fn tightest_member(&self, problem: &Problem) -> f64;
        }
        OfCharacteristicAnalysis of CharacteristicAnalysis {
            fn met(&self) -> Option<bool>;
            fn share(&self, dimension: usize) -> Option<f64>;
        }
        OfRelocation of Relocation {
            const NONE: Relocation;
        }
        #[cfg(feature = "process")]
        OfProcess of Process {
            fn adapter(&self, outputs: &[usize]) -> Result<ModelInfo, ProcessError>;
        }
        OfFormulaFault of FormulaFault {
            fn help(&self) -> Option<String>;
        }
        OfResponses of Responses {
            fn column(&self, output: usize) -> &[f64];
            fn count_reused(&self) -> usize;
            fn extra(&self) -> i64;
            fn is_open(&self, row: usize, output: usize) -> bool;
            fn revoked(&self) -> &[Vec<f64>];
            fn errors(&self) -> impl Iterator<Item = (usize, usize, &EvaluationError)>;
        }
        OfSwitch of Switch {
            fn name(&self, output: &str) -> String;
        }
        OfCapability of Capability {
            fn rejected(&self) -> Option<f64>;
        }
        OfSpecLimits of SpecLimits {
            fn exist(&self) -> bool;
        }
        OfCorrelation of Correlation {
            new new(dimensions: &[Dimension], pairs: &[Pair]) -> Result<Correlation, CorrelationError>;
        }
        OfDimension of Dimension {
            fn moved(&self, nominal: f64) -> Option<Result<Dimension, DimensionError>>;
            fn reach(&self) -> [f64; 2];
            fn step(&self) -> Option<f64>;
            fn zone(&self) -> Option<&str>;
        }
        OfJacobi of Jacobi {
            fn gauss(&self) -> Rule;
            fn gauss_with_mean(&self) -> Option<Rule>;
            fn order(&self) -> usize;
        }
        OfBeta of Beta {
            new about(middle: f64, half: f64, alpha: f64, beta: f64) -> Result<Beta, DistributionError>;
        }
        OfTrapezoidal of Trapezoidal {
            new about(middle: f64, half: f64, top: f64) -> Result<Trapezoidal, DistributionError>;
        }
        OfTriangular of Triangular {
            new about(middle: f64, half: f64, lean: f64) -> Result<Triangular, DistributionError>;
        }
        OfTruncatedNormal of TruncatedNormal {
            new about(middle: f64, half: f64, shift: f64, sigma: f64) -> Result<TruncatedNormal, DistributionError>;
        }
        OfStandardMoments of StandardMoments {
            fn kurtosis(&self) -> f64;
            fn raw(&self) -> [f64; 9];
            new from_central(central: &[f64; 7]) -> StandardMoments;
            new from_cumulants(cumulants: [f64; 6]) -> StandardMoments;
            const NORMAL: StandardMoments;
        }
        OfFitError of FitError {
            fn help(&self) -> Option<String>;
        }
        OfErrorEstimate of ErrorEstimate {
            fn basis(&self) -> String;
        }
        OfMethodError of MethodError {
            fn advice(&self) -> Vec<Advice>;
            fn needed(&self) -> Option<u64>;
        }
        OfMoments of Moments {
            fn excess(&self) -> Option<f64>;
            fn variance(&self) -> f64;
            new constant(mean: f64) -> Moments;
        }
        OfPearson of Pearson {
            fn log_cdf(&self, x: f64) -> f64;
            fn log_pdf(&self, x: f64) -> f64;
            fn log_sf(&self, x: f64) -> f64;
            new normal(mean: f64, sigma: f64) -> Result<Pearson, PearsonError>;
            new with_excess(mean: f64, sigma: f64, skewness: f64, excess: f64) -> Result<Pearson, PearsonError>;
        }
        OfProblem of Problem {
            fn outputs(&self) -> &[usize];
        }
        OfVerdict of Verdict {
            new of(requirement: Requirement, interval: Option<[f64; 2]>) -> Verdict;
        }
        OfVerified of Verified {
            fn error_of(&self, value: f64) -> f64;
        }
        OfTwoPoint of TwoPoint {
            new with_skewness(skewness: f64) -> TwoPoint;
        }
        OfRequirement of Requirement {
            fn value(&self) -> Option<f64>;
        }
        OfPace of Pace {
            fn expected_s(&self) -> f64;
        }
        OfRunSummary of RunSummary {
            fn unfinished(&self) -> bool;
        }
        #[cfg(feature = "study")]
        OfDataProblem of DataProblem {
            fn help(&self) -> Option<String>;
        }
        #[cfg(feature = "study")]
        OfStudy of Study {
            const MOST_FAULTS: usize;
        }
        #[cfg(feature = "study")]
        OfStudyError of StudyError {
            fn help(&self) -> Option<String>;
        }
        #[cfg(feature = "report")]
        OfStyle of Style {
            const WIDTH: usize;
        }
        OfWarning of Warning {
            fn data(&self) -> impl serde::Serialize + '_;
            const CODES: &'static [&'static str];
        }
    }
}
