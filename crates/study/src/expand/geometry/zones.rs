//! Expands zones that are bands or circles: profile, orientation, form, eccentricity and symmetry.

use crate::decimal::{KEPT, decimal};
use crate::error::{Fault, StudyFault};
use crate::expand::geometry::line::Line;
use crate::expand::geometry::plain::{Of, Plain, key, number, others, pair};
use crate::expand::{Value, wrong_type};

/// Plain lines of a profile: the offset along the normal of a face, and with `length` its tilt, which shares the zone.
pub(super) fn profile(line: &Line<'_>) -> Result<Plain, Fault> {
    without_band(line, "profile")?;
    let tree = line.value("profile");
    let (zone, outward) = match &tree.value {
        Value::Table(_) => {
            let frame = line.table("profile", &["zone", "outward"], "")?;
            frame.needed("zone", "write the number in the feature control frame, such as zone = 0.4")?;
            let zone = frame.size("zone")?.unwrap_or(0.0);
            let outward = frame.size("outward")?.unwrap_or(0.5 * zone);
            if outward > zone {
                let range = "within the zone: its part outside of the material, from 0 to the whole";
                return Err(frame.at("outward", StudyFault::OutOfRange { value: outward, range }));
            }
            (zone, outward)
        }
        _ => line.size("profile").map(|zone| (zone, 0.5 * zone))?,
    };
    let band = [-decimal(zone - outward, KEPT), decimal(outward, KEPT)];
    let Some(length) = line.length()? else { return Ok(banded(line, "profile", band, Of::Line)) };
    below(line, zone, length)?;
    if let Some(found) = ["distribution", "sigma", "sigmas", "cp", "cpk", "drift", "shift", "moments", "measured"]
        .into_iter()
        .find(|key| line.entry.get(key).is_some())
    {
        let why = "exclude each other: offset and tilt share the zone evenly".to_owned();
        return Err(line.at_key(found, StudyFault::Conflict { a: "length", b: found, why }));
    }
    let mut made = banded(line, "profile", band, Of::Line);
    if zone > 0.0 {
        let tilt = format!("{}_tilt", line.name());
        let keys = vec![
            (key(line, "nominal"), number(line, 0.0)),
            (key(line, "tolerance"), number(line, decimal(zone / length, KEPT))),
        ];
        made.dimension(line, tilt.clone(), Of::Angle, keys);
        made.block(line, [line.name().to_owned(), tilt], "diamond");
    } else {
        let keys = vec![(key(line, "nominal"), number(line, 0.0))];
        made.dimension(line, format!("{}_tilt", line.name()), Of::Angle, keys);
    }
    Ok(made)
}

/// Plain lines of perpendicularity, parallelism and angularity: an angle, or two for an axis.
pub(super) fn orientation(line: &Line<'_>, element: &'static str) -> Result<Plain, Fault> {
    without_band(line, element)?;
    let zone = line.size(element)?;
    let Some(length) = line.length()? else {
        let instead = format!("`{element}` needs the length over which the zone holds, such as length = 40");
        return Err(line.at_key(element, StudyFault::MissingKey { key: "length".into(), instead }));
    };
    below(line, zone, length)?;
    let reach = libm::asin(zone / length);
    match line.entry.get("axis").map(|axis| &axis.value) {
        None | Some(Value::Truth(false)) => Ok(banded(line, element, [-reach, reach], Of::Angle)),
        Some(Value::Truth(true)) => Ok(circular(line, element, 2.0 * reach, Of::Angle)),
        Some(_) => {
            let path = format!("dimensions.{}.axis", line.shown());
            Err(wrong_type(line.value("axis"), path, "true or false"))
        }
    }
}

/// Plain lines of flatness, straightness, roundness and cylindricity: half the zone on either side, or all of it outside.
pub(super) fn form(line: &Line<'_>, element: &'static str) -> Result<Plain, Fault> {
    without_band(line, element)?;
    let zone = line.size(element)?;
    match line.entry.get("side").map(|side| &side.value) {
        None => Ok(banded(line, element, [-0.5 * zone, 0.5 * zone], Of::Line)),
        Some(Value::Text(side)) if side == "out" => Ok(banded(line, element, [0.0, zone], Of::Line)),
        Some(Value::Text(side)) => {
            let (what, found, known) = ("side", side.clone(), vec!["out".to_owned()]);
            let nearest = Some("out".to_owned());
            Err(line.at_key("side", StudyFault::UnknownWord { what, found, nearest, known }))
        }
        Some(_) => {
            let path = format!("dimensions.{}.side", line.shown());
            Err(wrong_type(line.value("side"), path, "a text in quotes"))
        }
    }
}

/// Plain lines of runout, coaxiality and concentricity: the place of the axis in a circle about the datum axis.
pub(super) fn eccentricity(line: &Line<'_>, element: &'static str) -> Result<Plain, Fault> {
    without_band(line, element)?;
    let zone = line.size(element)?;
    Ok(circular(line, element, zone, Of::Line))
}

/// Plain lines of a symmetry: half the zone on either side of the middle.
pub(super) fn symmetry(line: &Line<'_>, element: &'static str) -> Result<Plain, Fault> {
    without_band(line, element)?;
    let zone = line.size(element)?;
    Ok(banded(line, element, [-0.5 * zone, 0.5 * zone], Of::Line))
}

/// One dimension with this band about the nominal value, which is 0 by default.
fn banded(line: &Line<'_>, element: &str, [lower, upper]: [f64; 2], of: Of) -> Plain {
    let tolerance = if lower == -upper { number(line, upper) } else { pair(line, [lower, upper]) };
    let mut keys = kept(line, element);
    if line.entry.get("nominal").is_none() {
        keys.insert(0, (key(line, "nominal"), number(line, 0.0)));
    }
    keys.push((key(line, "tolerance"), tolerance));
    let mut made = Plain::default();
    made.dimension(line, line.name().to_owned(), of, keys);
    made
}

/// Two dimensions within a circle of this diameter.
fn circular(line: &Line<'_>, element: &str, zone: f64, of: Of) -> Plain {
    let mut keys = kept(line, element);
    if line.entry.get("nominal").is_none() {
        keys.insert(0, (key(line, "nominal"), pair(line, [0.0; 2])));
    }
    keys.push((key(line, "position"), number(line, zone)));
    let mut made = Plain::default();
    made.dimension(line, line.name().to_owned(), of, keys);
    made
}

fn kept(line: &Line<'_>, element: &str) -> Vec<(crate::tree::Key, crate::expand::Tree)> {
    others(line, &[element, "length", "axis", "side", "unit"])
}

/// Checks that the line has no other band: the zone is the band.
fn without_band(line: &Line<'_>, element: &'static str) -> Result<(), Fault> {
    for b in ["tolerance", "limits", "fit"] {
        if line.entry.get(b).is_some() {
            let why = "say the same thing: leave one out".to_owned();
            return Err(line.at_key(b, StudyFault::Conflict { a: element, b, why }));
        }
    }
    Ok(())
}

/// Checks that the zone is not wider than the length of the feature. A wider one would bound no angle.
fn below(line: &Line<'_>, zone: f64, length: f64) -> Result<(), Fault> {
    if zone <= length { Ok(()) } else { Err(line.at_key("length", StudyFault::LengthBelowZone { length, zone })) }
}
