//! Expands a position whose zone depends on the size of a feature: the bonus of maximum or least material.

use crate::error::{Fault, StudyFault};
use crate::expand::geometry::line::{Line, Part, literal};
use crate::expand::geometry::plain::{Of, Plain, key, number, others, pair};
use crate::expand::geometry::size;
use crate::expand::{Tree, Value, quoted, wrong_type};
use sensitol_numeric::names::nearest;

/// Plain lines of a position that is a table. Returns None for a plain zone.
pub(super) fn plain(line: &Line<'_>) -> Result<Option<Plain>, Fault> {
    if !matches!(line.value("position").value, Value::Table(_)) {
        return Ok(None);
    }
    let frame = line.table("position", &["zone", "hole", "pin", "at", "form", "most", "width"], "")?;
    let missing = "write the diameter in the feature control frame, such as zone = 0.2";
    frame.needed("zone", missing)?;
    let zone = frame.size("zone")?.unwrap_or(0.0);
    let at = frame.word("at", "modifier", &["RFS", "MMC", "LMC"])?.unwrap_or("RFS");
    let feature = feature(line, &frame)?;
    if at == "RFS" {
        if let Some(key) = ["most", "form"].into_iter().find(|key| frame.get(key).is_some()) {
            let (to, instead) = ("a zone without a bonus".to_owned(), "write at = \"MMC\" or leave it out");
            return Err(frame.at(key, StudyFault::DoesNotApply { key, to, instead }));
        }
        let mut made = Plain::default();
        let mut keys = others(line, &["position", "unit"]);
        keys.insert(0, (key(line, "position"), number(line, zone)));
        made.dimension(line, line.name().to_owned(), Of::Line, keys);
        return Ok(Some(made));
    }
    let Some((kind, size)) = feature else {
        let instead = format!("at = \"{at}\" needs hole = or pin =: the feature whose size gives the bonus");
        return Err(frame.whole(StudyFault::MissingKey { key: "hole".to_owned(), instead }));
    };
    let Some(([least, greatest], unit)) = size::limits(line.study, size) else {
        return Err(frame.at(kind, StudyFault::NoMaterial { name: size.to_owned() }));
    };
    if let Some((found, _)) = line.entry.entries().iter().find(|(key, _)| key.name == "sigma") {
        let (key, to) = ("sigma", "a zone that a bonus widens".to_owned());
        let instead = "write sigmas or cp, which follow the zone";
        return Err(line.at_key(&found.name, StudyFault::DoesNotApply { key, to, instead }));
    }
    let unit = unit.filter(|_| line.converted());
    // Least material is the greatest size of a hole and the least size of a pin.
    let (from, rises) = match (kind, at) {
        ("hole", "MMC") => (least, true),
        ("hole", _) => (greatest, false),
        (_, "MMC") => (greatest, false),
        _ => (least, true),
    };
    let (name, from) = (quoted(size), literal(from, unit));
    let departure = if rises { format!("{name} - {from}") } else { format!("{from} - {name}") };
    let own = line.unit().filter(|_| line.converted());
    let form = form(line, &frame)?;
    // Form and orientation make the mating envelope of a hole smaller and that of a pin larger. The bonus is never negative.
    let bonus = match &form {
        Some(form) => format!("max(0, {departure} - {})", form.text),
        None => departure,
    };
    let bonus = match frame.size("most")? {
        Some(most) => format!("min({bonus}, {})", literal(most, own)),
        None => format!("({bonus})"),
    };
    let width = frame.get("width").and_then(|width| match &width.value {
        Value::Text(name) => Some(quoted(name)),
        _ => None,
    });
    let sizes = std::iter::once(size.to_owned()).chain(form.map(|form| form.name)).collect();
    Ok(Some(widened(line, &Widened { zone, bonus, width, sizes, unit: own }, nominal(line)?)))
}

/// Zone that a bonus widens.
struct Widened<'a> {
    zone: f64,
    /// Text of the bonus in a formula.
    bonus: String,
    /// Text of the dimension that holds the width of a zone with a cost.
    width: Option<String>,
    /// Names of the sizes and of the form in the bonus.
    sizes: Vec<String>,
    /// Unit of numbers in formulas.
    unit: Option<&'a str>,
}

/// Plain lines of a zone that a bonus widens. The places in a zone with a cost are dimensions of its width, and others are those on a zone of
/// radius 1.
fn widened(line: &Line<'_>, of: &Widened<'_>, nominal: [f64; 2]) -> Plain {
    let Widened { zone, bonus, width, sizes, unit } = of;
    let [unit_zone, of_zone] = ["unit", "zone"].map(|part| format!("{}.{part}", line.name()));
    let mut made = Plain::default();
    let mut keys = others(line, &["position", "nominal", "unit"]);
    keys.insert(0, (key(line, "nominal"), pair(line, [0.0; 2])));
    let (diameter, kind, text) = match width {
        None => (2.0, Of::Plain, literal(*zone, *unit)),
        Some(width) => (*zone, Of::Line, width.clone()),
    };
    keys.insert(1, (key(line, "position"), number(line, diameter)));
    made.dimension(line, unit_zone.clone(), kind, keys);
    made.formula(line, of_zone.clone(), Of::Line, format!("{text} + {bonus}"));
    for (axis, nominal) in ["_x", "_y"].into_iter().zip(nominal) {
        let divisor = width.clone().unwrap_or_else(|| "2".to_owned());
        let deviation = format!("{}/{divisor}*{}", quoted(&of_zone), quoted(&format!("{unit_zone}{axis}")));
        let formula = match nominal {
            0.0 => deviation,
            nominal => format!("{} + {deviation}", literal(nominal, *unit)),
        };
        made.formula(line, format!("{}{axis}", line.name()), Of::Line, formula);
    }
    made.product(line, sizes, &["_x", "_y"].map(|axis| format!("{unit_zone}{axis}")));
    made
}

/// Feature whose size gives the bonus: `hole` or `pin`, with its name. Returns None if there is none.
fn feature<'t>(line: &Line<'t>, frame: &Part<'t>) -> Result<Option<(&'static str, &'t str)>, Fault> {
    let (key, tree) = match (frame.get("hole"), frame.get("pin")) {
        (Some(_), Some(_)) => {
            let why = "are two features: the bonus follows the size of one".to_owned();
            return Err(frame.at("pin", StudyFault::Conflict { a: "hole", b: "pin", why }));
        }
        (Some(hole), None) => ("hole", hole),
        (None, Some(pin)) => ("pin", pin),
        (None, None) => return Ok(None),
    };
    let Value::Text(name) = &tree.value else {
        let expected = "the name of a dimension such as \"D\"";
        return Err(wrong_type(tree, format!("dimensions.{}.position.{key}", line.shown()), expected));
    };
    let dimensions = line.study.get("dimensions").map_or(&[][..], Tree::entries);
    if !dimensions.iter().any(|(key, _)| key.name == *name) {
        let known: Vec<String> = dimensions.iter().map(|(key, _)| key.name.clone()).collect();
        let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownWord { what: "dimension", found: name.clone(), nearest, known };
        return Err(frame.at(key, unknown));
    }
    Ok(Some((key, name)))
}

/// Difference of the mating envelope from the size, by form or orientation of the feature. Returns None if it is not given.
fn form(line: &Line<'_>, frame: &Part<'_>) -> Result<Option<Form>, Fault> {
    let Some(tree) = frame.get("form") else { return Ok(None) };
    let form = frame.diameter(line.study, "form", "")?;
    if let Some([value, _]) = size::range(line, &form.formula).filter(|[least, _]| *least < 0.0) {
        return Err(frame.at("form", StudyFault::OutOfRange { value, range: "0 or above" }));
    }
    let name = match &tree.value {
        Value::Text(name) => name.clone(),
        _ => String::new(),
    };
    Ok(Some(Form { text: form.text, name }))
}

/// Form deviation that reduces a bonus.
struct Form {
    /// Text of the form in a formula.
    text: String,
    /// Name of its dimension; empty if it is a number.
    name: String,
}

/// Nominal place, which is required.
fn nominal(line: &Line<'_>) -> Result<[f64; 2], Fault> {
    let Some(tree) = line.entry.get("nominal") else {
        let instead = "write the place on the drawing, such as nominal = [50.0, 30.0]".to_owned();
        return Err(line.at_key("position", StudyFault::MissingKey { key: "nominal".into(), instead }));
    };
    crate::expand::geometry::line::place(tree).ok_or_else(|| {
        let expected = "the nominal place of a position, two numbers such as [50.0, 30.0],";
        wrong_type(tree, format!("dimensions.{}.nominal", line.shown()), expected)
    })
}
