//! Errors: all of the library fit into one type, and names that mean nothing say what was meant.

use sensitol::method::{Pairs, Stencil};
use sensitol::simulation::Sampler;
use sensitol::{DerivativeSource, Error, Method, UnknownName};
use sensitol_models::Model;

use super::sources::sources;

/// Every error type that a public function of the library returns, by its path.
macro_rules! converts {
    ($($error:ty),* $(,)?) => {
        [$({
            // That it compiles is the test of the conversion.
            let _: fn($error) -> Error = Error::from;
            stringify!($error).rsplit("::").next().unwrap().trim()
        }),*]
    };
}

#[test]
fn every_error_of_the_library_becomes_the_one() {
    let known = converts![
        sensitol::DimensionError,
        sensitol::LimitsError,
        sensitol::MethodError,
        sensitol::ProblemError,
        sensitol::allocation::AllocateError,
        sensitol::allocation::CostError,
        sensitol::RequirementError,
        sensitol::analysis::LawError,
        sensitol::analysis::NoFit,
        sensitol::assembly::CompositeError,
        sensitol::assembly::EvaluationError,
        sensitol::assembly::NoColumn,
        sensitol::assembly::formula::FormulaError,
        sensitol::assembly::implicit::ConditionsError,
        sensitol::assembly::ProcessError,
        sensitol::compare::CompareError,
        sensitol::correlation::CorrelationError,
        sensitol::distribution::DistributionError,
        sensitol::fits::FitError,
        sensitol::inspection::InspectionError,
        sensitol::UnknownName,
        sensitol::lot::LotError,
        sensitol::pearson::PearsonError,
        sensitol::rare::RareError,
        sensitol::simulation::SamplingError,
        sensitol::simulation::ShardError,
        sensitol::simulation::SimulationError,
        sensitol::sweep::SweepError,
    ];
    // Every public type of engine and mathematics that is called an error is in the list.
    let mut seen = 0;
    for file in sources().into_iter().filter(|file| ["engine", "numeric"].contains(&file.package.as_str())) {
        for start in ["pub enum ", "pub struct "] {
            for name in file.text.split(start).skip(1) {
                let name: String = name.chars().take_while(|c| c.is_alphanumeric()).collect();
                if name.ends_with("Error") && name != "Error" {
                    seen += 1;
                    assert!(known.contains(&name.as_str()), "{name} of {}", file.name());
                }
            }
        }
    }
    assert!(seen > 20, "the sources were read");
}

/// Errors of studies, and all of the engine's, become one error of the package that reads studies.
#[test]
fn errors_of_studies_become_one() {
    let _: fn(sensitol_study::StudyError) -> sensitol_study::AnyError = sensitol_study::AnyError::from;
    let _: fn(sensitol_study::RewriteError) -> sensitol_study::AnyError = sensitol_study::AnyError::from;
    let _: fn(sensitol::MethodError) -> sensitol_study::AnyError = sensitol_study::AnyError::from;
}

/// The error says what the error of the part says.
#[test]
fn the_words_stay() {
    let unknown = "sixn".parse::<Method>().unwrap_err();
    assert_eq!(Error::from(unknown.clone()).to_string(), unknown.to_string());
    let method = sensitol::MethodError::BadNodes { nodes: 4 };
    assert_eq!(Error::from(method).to_string(), "a quadrature rule has 3, 5 or 7 nodes, not 4");
}

#[test]
fn names_are_read_back() {
    for method in Method::ALL {
        assert_eq!(method.name().parse(), Ok(method));
        assert_eq!(sensitol::method::registry::procedure(method).name(), method.name());
    }
    assert_eq!(
        sensitol::method::registry::ALL.iter().map(|procedure| procedure.method()).collect::<Vec<_>>(),
        Method::ALL
    );
    for stencil in [Stencil::TwoPoint, Stencil::FourPoint] {
        assert_eq!(stencil.to_string().parse(), Ok(stencil));
    }
    for source in [DerivativeSource::Exact, DerivativeSource::Difference] {
        assert_eq!(source.to_string().parse(), Ok(source));
    }
    for sampler in [Sampler::Random, Sampler::Sobol] {
        assert_eq!(sampler.to_string().parse(), Ok(sampler));
    }
    for model in sensitol_models::ALL {
        assert_eq!(model.name.parse::<&Model>().unwrap().name, model.name);
    }
    assert_eq!("adjacent".parse(), Ok(Pairs::Adjacent));
}

#[test]
fn a_wrong_name_says_what_was_meant() {
    let of = |error: UnknownName| (error.to_string(), error.nearest, error.known.len());
    let (text, nearest, known) = of("worst_case".parse::<Method>().unwrap_err());
    assert_eq!(text, "there is no method `worst_case`; did you mean `worst-case`?");
    assert_eq!((nearest.as_deref(), known), (Some("worst-case"), 11));
    let (text, nearest, _) = of("zebra".parse::<Stencil>().unwrap_err());
    assert_eq!((text.as_str(), nearest), ("there is no stencil `zebra`; the names are two-point, four-point", None));
    assert_eq!("strongst".parse::<Pairs>().unwrap_err().nearest.as_deref(), Some("strongest"));
    let (text, ..) = of("engine-balanc".parse::<&Model>().map(|model| model.name).unwrap_err());
    assert_eq!(text, "there is no built-in model `engine-balanc`; did you mean `engine-balance`?");
}
