//! Prepares a study file for a sweep: the swept parameter becomes a dimension.

use crate::dimension;
use crate::entries::file::{DimensionEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::entries::values::NominalEntry;
use crate::error::{Fault, StudyFault, fault};
use sensitol_models::Model;
use sensitol_numeric::names::nearest;

/// Makes a dimension without tolerance of a constant, or of an input of the built-in model that the study leaves out.
pub(crate) fn as_dimension(file: &mut StudyFile, name: &str) -> Result<(), Fault> {
    if let Some(one) = file.adjust.0.iter().map(Spanned::get_ref).find(|one| one.dimension.get_ref() == name) {
        let to = "a dimension that is chosen from stock".to_owned();
        let does_not =
            StudyFault::DoesNotApply { key: "sweep", to, instead: "sweep another dimension, or leave [[adjust]] out" };
        return Err(fault(one.dimension.span(), "adjust", does_not));
    }
    let dimensions = dimension::names(&file.dimensions);
    if dimensions.iter().any(|dimension| dimension.get_ref() == name) {
        return Ok(());
    }
    let model = file.model.as_ref().map(Spanned::get_ref);
    let builtin = model.and_then(|model| model.builtin.as_ref()).and_then(|name| name.get_ref().parse::<&Model>().ok());
    let constant = file.constants.0.iter().position(|(constant, _)| constant.get_ref() == name);
    let input = builtin.and_then(|model| model.inputs.iter().find(|input| input.name == name));
    let mut unit = None;
    let (key, nominal) = match (constant, input) {
        (Some(at), _) => {
            let key = file.constants.0[at].0.clone();
            if model.is_some_and(|model| model.command.is_some()) {
                // A program receives constants once only, but dimensions at every point.
                let (what, instead) = ("a constant of a program".to_owned(), "make it a dimension without tolerance");
                let does_not = StudyFault::DoesNotApply { key: "sweep", to: what, instead };
                return Err(fault(key.span(), format!("constants.{name}"), does_not));
            }
            let constant = file.constants.0.remove(at).1.into_inner();
            unit = constant.unit;
            (key, constant.value)
        }
        (None, Some(input)) => (Spanned::new(0..0, name.to_owned()), input.nominal),
        (None, None) => {
            let mut known: Vec<String> = dimensions.iter().map(|name| name.get_ref().clone()).collect();
            known.extend(file.constants.names().into_iter().map(|name| name.get_ref().clone()));
            let left_out = builtin.iter().flat_map(|model| model.inputs).map(|input| input.name.to_owned());
            let left_out: Vec<String> = left_out.filter(|name| !known.contains(name)).collect();
            known.extend(left_out);
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            let what = "dimension, constant or input of the model to sweep:";
            let unknown = StudyFault::UnknownWord { what, found: name.to_owned(), nearest, known };
            return Err(Fault { span: None, key: "sweep".to_owned(), fault: Box::new(unknown) });
        }
    };
    let span = key.span();
    let nominal = Some(Spanned::new(span.clone(), NominalEntry::One(nominal)));
    let entry = DimensionEntry { nominal, unit, ..DimensionEntry::default() };
    file.dimensions.0.push((key, Spanned::new(span, entry)));
    Ok(())
}
