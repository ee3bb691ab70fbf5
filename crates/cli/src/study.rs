//! Studies with the changes of the command line.

use std::path::Path;

use crate::args::{DerivativesArg, HowArgs, SampledArgs, SensitivitiesArg, StencilArg, StudyArgs};
use crate::failure::Failure;
use crate::output::Look;
use crate::pairs;
use crate::running::externals;
use crate::table::{TableArgs, study_of};
use sensitol::method::{DerivativeSource, Method};
use sensitol::plan::Stencil;
use sensitol_study::{Externals, Study, StudyText};

/// Name that stands for every configuration of a study.
pub(super) const ALL: &str = "all";
/// Name of the characteristic of a table that is analysed without a study.
const GAP: &str = "gap";

/// Reads a study for sampling.
pub(super) fn read_sampled(asked: &SampledArgs, look: Look) -> Result<Study, Failure> {
    let externals = externals(asked.work.journal.as_deref(), look, None);
    let externals = configured(externals, asked.configuration.as_deref());
    asking(Study::read_with(&asked.study, externals)?, &asked.characteristics)
}

/// Selects a configuration, if one is named.
pub(super) fn configured(externals: Externals, name: Option<&str>) -> Externals {
    match name {
        Some(name) => externals.with_configuration(name),
        None => externals,
    }
}

/// Restricts the study to these characteristics, if any are named.
fn asking(mut study: Study, characteristics: &[String]) -> Result<Study, Failure> {
    if !characteristics.is_empty() {
        study.problem = study.problem.only(characteristics)?;
    }
    Ok(study)
}

/// Reads a study. Options of the command line override its `[analysis]`.
pub(super) fn read(asked: &StudyArgs, externals: Externals) -> Result<Study, Failure> {
    read_file(&asked.study, &asked.how, configured(externals, asked.how.configuration.as_deref()))
}

/// Reads a study, in all configurations at once if `all` is named.
pub(super) fn read_for_all(asked: &StudyArgs, externals: &dyn Fn() -> Externals) -> Result<Study, Failure> {
    if asked.how.configuration.as_deref() != Some(ALL) {
        return read(asked, externals());
    }
    let study = Study::read_with(&asked.study, externals())?;
    let names = study.configurations.clone();
    if names.is_empty() {
        // Reading with the name `all` gives the error that the study has no configurations.
        Study::read_with(&asked.study, externals().with_configuration(ALL))?;
    }
    let of = |name: String| Ok((name.clone(), Study::read_with(&asked.study, externals().with_configuration(name))?));
    let all: Vec<(String, Study)> = names.into_iter().map(of).collect::<Result<_, Failure>>()?;
    changed(study.in_configurations(&all)?, &asked.how)
}

/// Reads a study from a path of its own.
pub(super) fn read_file(path: &Path, asked: &HowArgs, externals: Externals) -> Result<Study, Failure> {
    changed(Study::read_with(path, externals)?, asked)
}

/// Reads a stack-up table as a study, and prints its content. The name of its characteristic is not needed.
pub(super) fn read_table(
    path: &Path,
    table: &TableArgs,
    asked: &HowArgs,
    externals: Externals,
    look: Look,
) -> Result<Study, Failure> {
    let table = study_of(path, table, GAP)?;
    look.note(&table.summary, &table.notes);
    let text = StudyText::toml(path.display().to_string(), table.text).with_externals(externals);
    changed(Study::from_text(text)?, asked)
}

/// Reads a study for a sweep over a parameter.
pub(super) fn read_sweeping(asked: &StudyArgs, externals: Externals, parameter: &str) -> Result<Study, Failure> {
    let externals = configured(externals, asked.how.configuration.as_deref());
    changed(Study::read_sweeping(&asked.study, externals, parameter)?, &asked.how)
}

fn changed(study: Study, asked: &HowArgs) -> Result<Study, Failure> {
    let mut study = asking(study, &asked.characteristics)?;
    let options = &mut study.options;
    if let Some(method) = asked.method {
        options.method = method.0;
        // The study's pairs belong to its own method.
        if method.0 != Method::SixN {
            (options.pairs, options.stencil) = (None, None);
        }
        // The same holds for its nodes and steps.
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
        // The study's step belongs to differences.
        if derivatives == DerivativesArg::Exact {
            options.step = asked.step;
        }
    }
    Ok(study)
}
