//! A study as the command line changes it.

use std::path::Path;

use super::args::{DerivativesArg, HowArgs, SampledArgs, SensitivitiesArg, StencilArg, StudyArgs};
use super::failure::Failure;
use super::output::Look;
use super::pairs;
use super::running::externals;
use sensitol::method::{DerivativeSource, Method};
use sensitol::plan::Stencil;
use sensitol_study::{Externals, Study};

/// The word for every configuration of a study.
pub(super) const ALL: &str = "all";

/// Reads the study of which points are drawn.
pub(super) fn read_sampled(asked: &SampledArgs, look: Look) -> Result<Study, Failure> {
    let externals = externals(asked.work.journal.as_deref(), look, None);
    let externals = configured(externals, asked.configuration.as_deref());
    asking(Study::read_with(&asked.study, externals)?, &asked.characteristics)
}

/// The same of a configuration, where one is named.
pub(super) fn configured(externals: Externals, name: Option<&str>) -> Externals {
    match name {
        Some(name) => externals.with_configuration(name),
        None => externals,
    }
}

/// The study, asking for these characteristics only, where any is named.
fn asking(mut study: Study, characteristics: &[String]) -> Result<Study, Failure> {
    if !characteristics.is_empty() {
        study.problem = study.problem.only(characteristics)?;
    }
    Ok(study)
}

/// Reads the study; what the command line says wins over its `[analysis]`.
pub(super) fn read(asked: &StudyArgs, externals: Externals) -> Result<Study, Failure> {
    read_file(&asked.study, &asked.how, configured(externals, asked.how.configuration.as_deref()))
}

/// The same, in all configurations at once where `all` of them are asked for.
pub(super) fn read_for_all(asked: &StudyArgs, externals: &dyn Fn() -> Externals) -> Result<Study, Failure> {
    if asked.how.configuration.as_deref() != Some(ALL) {
        return read(asked, externals());
    }
    let study = Study::read_with(&asked.study, externals())?;
    let names = study.configurations.clone();
    if names.is_empty() {
        // The study's own error says that there is none.
        Study::read_with(&asked.study, externals().with_configuration(ALL))?;
    }
    let of = |name: String| Ok((name.clone(), Study::read_with(&asked.study, externals().with_configuration(name))?));
    let all: Vec<(String, Study)> = names.into_iter().map(of).collect::<Result<_, Failure>>()?;
    changed(study.in_configurations(&all)?, &asked.how)
}

/// The same of a file that stands for itself.
pub(super) fn read_file(path: &Path, asked: &HowArgs, externals: Externals) -> Result<Study, Failure> {
    changed(Study::read_with(path, externals)?, asked)
}

/// The same for a sweep over this parameter.
pub(super) fn read_sweeping(asked: &StudyArgs, externals: Externals, parameter: &str) -> Result<Study, Failure> {
    let externals = configured(externals, asked.how.configuration.as_deref());
    changed(Study::read_sweeping(&asked.study, externals, parameter)?, &asked.how)
}

fn changed(study: Study, asked: &HowArgs) -> Result<Study, Failure> {
    let mut study = asking(study, &asked.characteristics)?;
    let options = &mut study.options;
    if let Some(method) = asked.method {
        options.method = method.0;
        // The study's choice of pairs was made for its own method.
        if method.0 != Method::SixN {
            (options.pairs, options.stencil) = (None, None);
        }
        // So were its nodes, and steps.
        let reduction = matches!(method.0, Method::DimensionReduction | Method::BivariateDimensionReduction);
        if !reduction {
            options.nodes = None;
        }
        if reduction || method.0 == Method::ThreePoint {
            options.step = None;
        }
    }
    if let Some(text) = &asked.pairs {
        options.pairs = Some(pairs::parse(text)?);
    }
    if let Some(stencil) = asked.stencil {
        options.stencil = Some(match stencil {
            StencilArg::TwoPoint => Stencil::TwoPoint,
            StencilArg::FourPoint => Stencil::FourPoint,
        });
    }
    options.nodes = asked.nodes.or(options.nodes);
    if let Some(which) = asked.sensitivities {
        options.all_sensitivities = which == SensitivitiesArg::All;
    }
    options.accuracy = asked.accuracy.or(options.accuracy);
    let wanted = &mut options.accuracies;
    wanted.skewness = asked.accuracy_skewness.or(wanted.skewness);
    wanted.kurtosis = asked.accuracy_kurtosis.or(wanted.kurtosis);
    wanted.yield_ = asked.accuracy_yield.or(wanted.yield_);
    options.budget = asked.budget.or(options.budget);
    options.step = asked.step.or(options.step);
    if let Some(derivatives) = asked.derivatives {
        options.derivatives = Some(match derivatives {
            DerivativesArg::Exact => DerivativeSource::Exact,
            DerivativesArg::Difference => DerivativeSource::Difference,
        });
        // Steps of the study were chosen for its differences.
        if derivatives == DerivativesArg::Exact {
            options.step = asked.step;
        }
    }
    Ok(study)
}
