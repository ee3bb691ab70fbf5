//! Expands play between a hole and a pin: the float of one part in another, or on a round pin and in a slot.

use crate::error::{Fault, StudyFault};
use crate::expand::geometry::line::{Diameter, Line, Part};
use crate::expand::geometry::plain::{Of, Plain, key, number, pair, text};
use crate::expand::geometry::size;
use crate::expand::{Closing, Tree, quoted};
use crate::tree::Key;
use sensitol::assembly::formula::Formula;
use sensitol_numeric::labels::LABELS;

/// Places of the pin in the hole.
const LAWS: [&str; 6] = ["uniform", "contact", "+", "-", "disc", "rim"];
/// Text to write instead of a key that play does not have.
const BESIDE: &str = "its law says how it varies: write law = \"contact\" or another in it";

/// Plain lines of `ds = { float = { hole = "A", pin = "B", law = "uniform" } }`.
pub(super) fn float(line: &Line<'_>) -> Result<Plain, Fault> {
    alone(line, "float")?;
    let expected = "a table such as { hole = \"A\", pin = \"B\" }";
    let frame = line.table("float", &["hole", "pin", "law"], expected)?;
    let law = frame.word("law", "law of a float", &LAWS)?.unwrap_or("uniform");
    let Clearance { formula: clearance, names, closing } = clearance(line, &frame, ["hole", "pin"])?;
    let mut made = Plain { closing: closing.into_iter().collect(), ..Plain::default() };
    let name = line.name();
    match law {
        "+" => made.formula(line, name.to_owned(), Of::Line, clearance),
        "-" => made.formula(line, name.to_owned(), Of::Line, format!("-({clearance})")),
        "uniform" | "contact" => {
            let law = if law == "contact" { "two-point" } else { law };
            made.dimension(line, format!("{name}.unit"), Of::Plain, unit_band(line, Some(law)));
            made.formula(line, format!("{name}.clearance"), Of::Line, clearance);
            made.formula(line, name.to_owned(), Of::Line, format!("{}*{}", of(line, "clearance"), of(line, "unit")));
            made.product(line, &names, &[format!("{name}.unit")]);
        }
        law => {
            made.formula(line, format!("{name}.clearance"), Of::Line, clearance);
            zone(&mut made, line, "unit", law);
            for axis in ["_x", "_y"] {
                let product = format!("{}*{}", of(line, "clearance"), of(line, &format!("unit{axis}")));
                made.formula(line, format!("{name}{axis}"), Of::Line, product);
                made.product(line, &names, &[format!("{name}.unit{axis}")]);
            }
        }
    }
    Ok(made)
}

/// Plain lines of `base = { locate = { hole = "H", pin = "P", slot = "S", pin2 = "Q", distance = 80 } }`.
pub(super) fn locate(line: &Line<'_>) -> Result<Plain, Fault> {
    alone(line, "locate")?;
    let expected = "a table such as { hole = \"H\", pin = \"P\", slot = \"S\", pin2 = \"Q\", distance = 80 }";
    let frame = line.table("locate", &["hole", "pin", "slot", "pin2", "distance"], expected)?;
    let in_hole = clearance(line, &frame, ["hole", "pin"])?;
    let in_slot = clearance(line, &frame, ["slot", "pin2"])?;
    let instead = "write the distance from the round pin to the one in the slot, such as distance = 80";
    let distance = frame.diameter(line.study, "distance", instead)?;
    if size::range(line, &distance.formula).is_some_and(|[least, _]| least <= 0.0) {
        let value = size::range(line, &distance.formula).map_or(0.0, |[least, _]| least);
        return Err(frame.at("distance", StudyFault::OutOfRange { value, range: "above 0" }));
    }
    let name = line.name();
    let mut made = Plain::default();
    zone(&mut made, line, "pin", "disc");
    made.dimension(line, format!("{name}.slot"), Of::Plain, unit_band(line, Some("uniform")));
    made.formula(line, format!("{name}.clearance"), Of::Line, in_hole.formula);
    made.formula(line, format!("{name}.slot_clearance"), Of::Line, in_slot.formula);
    made.product(line, &in_hole.names, &["_x", "_y"].map(|axis| format!("{name}.pin{axis}")));
    made.closing = in_hole.closing.into_iter().chain(in_slot.closing).collect();
    made.product(line, &in_slot.names, &[format!("{name}.slot")]);
    for axis in ["_x", "_y"] {
        let product = format!("{}*{}", of(line, "clearance"), of(line, &format!("pin{axis}")));
        made.formula(line, format!("{name}{axis}"), Of::Line, product);
    }
    let across = format!("{}*{}", of(line, "slot_clearance"), of(line, "slot"));
    let y = quoted(&format!("{name}_y"));
    made.formula(line, format!("{name}_rot"), Of::Angle, format!("({across} - {y})/{}", distance.text));
    Ok(made)
}

/// Name of a part of the line, in the form that formulas need.
fn of(line: &Line<'_>, part: &str) -> String {
    quoted(&format!("{}.{part}", line.name()))
}

/// Keys of a dimension with a band from -1 to 1.
fn unit_band(line: &Line<'_>, distribution: Option<&str>) -> Vec<(Key, Tree)> {
    let mut keys = vec![(key(line, "nominal"), number(line, 0.0)), (key(line, "tolerance"), number(line, 1.0))];
    keys.extend(distribution.map(|kind| (key(line, "distribution"), text(line, kind))));
    keys
}

/// Adds the two coordinates of a disc or rim of radius 1.
fn zone(made: &mut Plain, line: &Line<'_>, part: &str, law: &str) {
    let name = format!("{}.{part}", line.name());
    if law == "disc" {
        let keys = vec![
            (key(line, "nominal"), pair(line, [0.0; 2])),
            (key(line, "position"), number(line, 2.0)),
            (key(line, "distribution"), text(line, "uniform")),
        ];
        made.dimension(line, name, Of::Plain, keys);
        return;
    }
    let both = ["_x", "_y"].map(|axis| format!("{name}{axis}"));
    for coordinate in &both {
        made.dimension(line, coordinate.clone(), Of::Plain, unit_band(line, None));
    }
    made.block(line, both, law);
}

/// Radial clearance of a hole and a pin.
struct Clearance {
    formula: String,
    /// Names that the formula uses.
    names: Vec<String>,
    /// Sizes of which the pin may be the larger; None if the bands exclude that.
    closing: Option<Closing>,
}

/// Radial clearance of a hole and a pin. It is 0 if they touch, for bands that permit it.
fn clearance(line: &Line<'_>, frame: &Part<'_>, keys: [&str; 2]) -> Result<Clearance, Fault> {
    let instead = ["the diameter of the hole, or the width of the slot", "the diameter of the pin"]
        .map(|what| format!("write {what}: a dimension, a number or a formula"));
    let hole = frame.diameter(line.study, keys[0], &instead[0])?;
    let pin = frame.diameter(line.study, keys[1], &instead[1])?;
    let band = |of: &Diameter| size::range(line, &of.formula);
    if let (Some(hole), Some(pin)) = (band(&hole), band(&pin))
        && hole[1] <= pin[0]
    {
        return Err(frame.at(keys[0], StudyFault::NothingFloats { hole, pin }));
    }
    let difference = format!("{} - {}", hole.text, pin.text);
    // The maximum makes a kink, so it is only written if the bands let the pin be larger than the hole.
    let closes = match (band(&hole), band(&pin)) {
        (Some([least, _]), Some([_, greatest])) => least < greatest - ROUNDING * greatest.abs(),
        _ => false,
    };
    let formula = if closes { format!("max(0, {difference})/2") } else { format!("({difference})/2") };
    let names = [&hole, &pin].into_iter().filter_map(|of| Formula::parse(&of.formula).ok());
    let names = names.flat_map(|of| of.names().map(|(name, _)| name.to_owned()).collect::<Vec<_>>()).collect();
    let closing = closes.then(|| Closing { element: line.shown().to_owned(), hole: hole.formula, pin: pin.formula });
    Ok(Clearance { formula, names, closing })
}

/// Relative difference up to which two sizes count as equal: decimals have rounding errors.
const ROUNDING: f64 = 1e-12;

/// Checks that play has no band and no distribution of its own.
fn alone(line: &Line<'_>, element: &'static str) -> Result<(), Fault> {
    const NONE: [&str; 19] = [
        "nominal",
        "tolerance",
        "limits",
        "fit",
        "from",
        "distribution",
        "sigma",
        "sigmas",
        "cp",
        "cpk",
        "drift",
        "rss_factor",
        "mean_shift",
        "shift",
        "moments",
        "measured",
        "column",
        "model",
        "step",
    ];
    let valid: Vec<&str> = [element, "unit"].into_iter().chain(LABELS).collect();
    for (found, _) in line.entry.entries() {
        if let Some(&key) = NONE.iter().find(|key| **key == found.name) {
            let to = format!("a `{element}`");
            return Err(line.at_key(key, StudyFault::DoesNotApply { key, to, instead: BESIDE }));
        }
        if !valid.contains(&found.name.as_str()) {
            let nearest = sensitol_numeric::names::nearest(&found.name, valid.iter().copied()).map(str::to_owned);
            let valid = valid.into_iter().map(str::to_owned).collect();
            let unknown = StudyFault::UnknownKey { key: found.name.clone(), nearest, valid };
            return Err(line.at_key(&found.name, unknown));
        }
    }
    Ok(())
}
