//! Reads `[loss]` and `[setup]`: the costs of deviations and rejects, and of setting up machines.

use crate::entries::file::StudyFile;
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use sensitol::allocation::{CostError, QualityLoss, SetUp};
use sensitol::problem::Problem;
use sensitol_numeric::names::nearest;

/// Losses, in the order of the file.
pub(crate) fn losses(file: &StudyFile, problem: &Problem) -> Result<Vec<QualityLoss>, Fault> {
    let characteristics = problem.characteristics();
    let mut losses = Vec::new();
    for (name, entry) in &file.loss.0 {
        let (text, entry) = (name.get_ref(), entry.get_ref());
        let key = format!("loss.{text}");
        let Some(c) = characteristics.iter().position(|one| one.name() == text) else {
            let known: Vec<String> = characteristics.iter().map(|one| one.name().to_owned()).collect();
            let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
            let unknown = StudyFault::UnknownWord { what: "characteristic", found: text.clone(), nearest, known };
            return Err(fault(name.span(), key, unknown));
        };
        let missing = |wanted: &'static str, instead: &str| {
            fault(name.span(), key.clone(), StudyFault::MissingKey { key: wanted.into(), instead: instead.to_owned() })
        };
        if entry.k.is_none() && entry.scrap.is_none() {
            return Err(missing(
                "k",
                "write k, the cost per square of the deviation, or scrap, that of a rejected assembly",
            ));
        }
        let limits = characteristics[c].limits();
        let middle = limits.lower().zip(limits.upper()).map(|(lower, upper)| 0.5 * (lower + upper));
        let target = match (&entry.target, &entry.k) {
            (Some(target), _) => *target.get_ref(),
            (None, None) => 0.0,
            (None, Some(_)) => {
                middle.ok_or_else(|| missing("target", "write the target, which only two limits have between them"))?
            }
        };
        let number = |given: &Option<Spanned<f64>>| given.as_ref().map_or(0.0, |given| *given.get_ref());
        let at = |given: &Option<Spanned<f64>>, sub: &str, error: CostError| {
            fault(given.as_ref().map_or(name.span(), Spanned::span), format!("{key}.{sub}"), error)
        };
        if let Some(scrap) = entry.scrap.as_ref().filter(|_| !limits.exist()) {
            let to = "a characteristic without limits".to_owned();
            let instead = "nothing is rejected without a limit: give the characteristic lower or upper";
            let apart = StudyFault::DoesNotApply { key: "scrap", to, instead };
            return Err(fault(scrap.span(), format!("{key}.scrap"), apart));
        }
        let loss = QualityLoss::new(c, number(&entry.k), target).map_err(|error| at(&entry.k, "k", error))?;
        losses.push(loss.with_scrap(number(&entry.scrap)).map_err(|error| at(&entry.scrap, "scrap", error))?);
    }
    Ok(losses)
}

/// Set-up costs in the order of the file, of the machines that some process needs.
pub(crate) fn setups(file: &StudyFile) -> Result<Vec<SetUp>, Fault> {
    let processes =
        || file.costs.0.iter().filter_map(|(name, entry)| Some((name, entry.get_ref().processes.as_ref()?)));
    let known: Vec<&str> = file.setup.0.iter().map(|(name, _)| name.get_ref().as_str()).collect();
    let mut needed: Vec<&str> = Vec::new();
    for (name, processes) in processes() {
        for (index, process) in processes.get_ref().iter().enumerate() {
            let Some(machine) = &process.get_ref().machine else { continue };
            let found = machine.get_ref();
            if !known.contains(&found.as_str()) {
                let nearest = nearest(found, known.iter().copied()).map(str::to_owned);
                let known = known.iter().map(|&name| name.to_owned()).collect();
                let unknown =
                    StudyFault::UnknownWord { what: "machine in [setup]", found: found.clone(), nearest, known };
                let key = format!("costs.{}.processes[{}].machine", name.get_ref(), index + 1);
                return Err(fault(machine.span(), key, unknown));
            }
            needed.push(found);
        }
    }
    let mut setups = Vec::new();
    for (name, cost) in &file.setup.0 {
        let key = format!("setup.{}", name.get_ref());
        if !needed.contains(&name.get_ref().as_str()) {
            let instead = "write machine = the name in the processes that need it, or leave it out";
            let to = "a study without a process on it".to_owned();
            return Err(fault(name.span(), key, StudyFault::DoesNotApply { key: "setup", to, instead }));
        }
        setups.push(SetUp::new(name.get_ref(), *cost.get_ref()).map_err(|error| fault(cost.span(), key, error))?);
    }
    Ok(setups)
}
