//! Reads the options of `[analysis]`.

use std::str::FromStr;

use crate::entries::file::{AnalysisEntry, PairsEntry};
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::SENSITIVITIES;
use crate::error::{Fault, StudyFault, fault};
use sensitol::method::{Accuracies, MethodError, Options, Pairs};
use sensitol::problem::Problem;
use sensitol_numeric::names::{UnknownName, nearest};

/// Parses a word under a key of `[analysis]`.
fn named<T: FromStr<Err = UnknownName>>(word: &Spanned<String>, key: &str) -> Result<T, Fault> {
    word.get_ref().parse().map_err(|unknown: UnknownName| fault(word.span(), format!("analysis.{key}"), unknown))
}

/// Checks the target of the joint yield: a share between 0 and 1, in a study with at least two characteristics with limits.
fn joint_target(target: &Spanned<f64>, problem: &Problem) -> Result<f64, Fault> {
    let value = *target.get_ref();
    let at = |found| fault(target.span(), "analysis.target_joint_yield", found);
    if !(value > 0.0 && value < 1.0) {
        return Err(at(StudyFault::OutOfRange { value, range: "between 0 and 1" }));
    }
    if problem.characteristics().iter().filter(|one| one.limits().exist()).count() < 2 {
        let instead =
            "a joint yield is of two characteristics with limits at least: write target_yield at the one".to_owned();
        return Err(at(StudyFault::MissingKey { key: "lower".into(), instead }));
    }
    Ok(value)
}

/// Adds to the problem the pairs of dimensions with known products.
pub(crate) fn products(entry: &AnalysisEntry, problem: Problem) -> Result<Problem, Fault> {
    let Some(pairs) = &entry.products else { return Ok(problem) };
    let known: Vec<String> = problem.dimensions().iter().map(|dimension| dimension.name().to_owned()).collect();
    let name = |name: &Spanned<String>| {
        if known.contains(name.get_ref()) {
            return Ok(name.get_ref().clone());
        }
        let nearest = nearest(name.get_ref(), known.iter().map(String::as_str)).map(str::to_owned);
        let (what, found, known) = ("dimension", name.get_ref().clone(), known.clone());
        let unknown = StudyFault::UnknownWord { what, found, nearest, known };
        Err(fault(name.span(), "analysis.products", unknown))
    };
    let pairs = pairs.get_ref().iter().map(|(a, b)| Ok((name(a)?, name(b)?))).collect::<Result<Vec<_>, Fault>>()?;
    Ok(problem.with_products(pairs))
}

pub(crate) fn options(entry: &AnalysisEntry, problem: &Problem) -> Result<Options, Fault> {
    let positive = |given: &Option<Spanned<f64>>, key: &str| match given {
        Some(given) if *given.get_ref() <= 0.0 => {
            let out = StudyFault::OutOfRange { value: *given.get_ref(), range: "above 0" };
            Err(fault(given.span(), format!("analysis.{key}"), out))
        }
        given => Ok(given.as_ref().map(|given| *given.get_ref())),
    };
    let mut options = Options::default();
    options.accuracy = positive(&entry.accuracy, "accuracy")?;
    options.accuracies = Accuracies {
        skewness: positive(&entry.accuracy_skewness, "accuracy_skewness")?,
        kurtosis: positive(&entry.accuracy_kurtosis, "accuracy_kurtosis")?,
        yield_: positive(&entry.accuracy_yield, "accuracy_yield")?,
    };
    options.step = positive(&entry.step, "step")?;
    options.seed = entry.seed.as_ref().map(|seed| *seed.get_ref());
    options.extremes = entry.extremes.unwrap_or(false);
    options.verify = entry.verify.map(|points| usize::try_from(points).unwrap_or(usize::MAX));
    options.budget = entry.budget.as_ref().map(|budget| usize::try_from(*budget.get_ref()).unwrap_or(usize::MAX));
    if let Some(target) = &entry.target_joint_yield {
        options.target_joint_yield = Some(joint_target(target, problem)?);
    }
    if let Some(coverage) = &entry.coverage {
        let value = *coverage.get_ref();
        if !(0.5..1.0).contains(&value) {
            let out = StudyFault::OutOfRange { value, range: "from 0.5 to below 1" };
            return Err(fault(coverage.span(), "analysis.coverage", out));
        }
        options.coverage = Some(value);
    }
    if let Some(method) = &entry.method {
        options.method = named(method, "method")?;
    }
    if let Some(pairs) = &entry.pairs {
        options.pairs = Some(match pairs.get_ref() {
            PairsEntry::Listed(pairs) => Pairs::Listed(pairs.clone()),
            PairsEntry::Word(text) => named(&Spanned::new(pairs.span(), text.clone()), "pairs")?,
        });
    }
    if let Some(stencil) = &entry.stencil {
        options.stencil = Some(named(stencil, "stencil")?);
    }
    options.nodes = entry.nodes.as_ref().map(|nodes| usize::try_from(*nodes.get_ref()).unwrap_or(usize::MAX));
    if let Some(sensitivities) = &entry.sensitivities {
        options.all_sensitivities = match sensitivities.get_ref().as_str() {
            "all" => true,
            "varying" => false,
            found => {
                let unknown = UnknownName::of("choice of sensitivities", found, SENSITIVITIES.to_vec());
                return Err(fault(sensitivities.span(), "analysis.sensitivities", unknown));
            }
        };
    }
    if let Some(derivatives) = &entry.derivatives {
        options.derivatives = Some(named(derivatives, "derivatives")?);
    }
    // A conflict that the single keys do not show is reported at the pairs first, since these are the most likely cause.
    options.method.procedure().check(problem, &options).map_err(|error| {
        let of_derivatives = entry.derivatives.as_ref().map(Spanned::span);
        let of_nodes = entry.nodes.as_ref().map(Spanned::span);
        let of_pairs = entry.pairs.as_ref().map(Spanned::span);
        let spans = match &error {
            MethodError::BadNodes { .. } | MethodError::OptionDoesNotApply { option: "nodes", .. } => {
                [of_nodes, None, None]
            }
            _ => [of_pairs, entry.stencil.as_ref().map(Spanned::span), of_derivatives],
        };
        let span = spans.into_iter().flatten().next().or(entry.method.as_ref().map(Spanned::span));
        Fault { span, key: "analysis".into(), fault: Box::new(error.into()) }
    })?;
    Ok(options)
}
