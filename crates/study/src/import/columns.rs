//! The columns of a stack-up table, by their headers in English and German.

use super::sheet::Content;

/// A column that means something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The name of a dimension.
    Name,
    /// The part that it belongs to.
    Part,
    /// Words about it.
    Description,
    /// Its drawing.
    Drawing,
    /// The revision of that.
    Revision,
    /// The feature of the part, or its number on the drawing.
    Feature,
    /// Whether it adds or subtracts.
    Direction,
    /// By what it is multiplied.
    Factor,
    /// Its nominal value.
    Nominal,
    /// Its upper deviation.
    Upper,
    /// Its lower deviation, with its sign.
    Lower,
    /// Its lower deviation, which is negative without a sign too.
    Minus,
    /// Its tolerance in one cell.
    Tolerance,
    /// Its unit.
    Unit,
    /// How it is distributed.
    Distribution,
    /// Its process capability.
    Cp,
    /// Its standard deviation.
    Sigma,
}

/// Every role with its name and its headers, as [`plain`] leaves them.
pub const ROLES: [(Role, &str, &[&str]); 17] = [
    (Role::Name, "name", &["name", "dimension", "bezeichnung", "mass", "masz", "massbezeichnung", "symbol", "id"]),
    (Role::Part, "part", &["part", "component", "bauteil", "teil", "komponente"]),
    (
        Role::Description,
        "description",
        &["description", "remark", "comment", "beschreibung", "bemerkung", "kommentar", "benennung"],
    ),
    (Role::Drawing, "drawing", &["drawing", "drawing no", "zeichnung", "zeichnungsnummer", "zeichnungsnr"]),
    (Role::Revision, "revision", &["revision", "rev", "anderungsindex", "anderungsstand"]),
    (Role::Feature, "feature", &["feature", "balloon", "merkmal", "merkmalsnummer", "merkmalsnr"]),
    (Role::Direction, "direction", &["direction", "sign", "richtung", "vorzeichen", "+/-"]),
    (Role::Factor, "factor", &["factor", "lever", "sensitivity", "coefficient", "hebel", "faktor", "hebelarm"]),
    (
        Role::Nominal,
        "nominal",
        &["nominal", "nominal value", "nominal size", "nennmass", "nennwert", "nennmaß", "sollmass"],
    ),
    (
        Role::Upper,
        "upper",
        &[
            "upper",
            "upper deviation",
            "upper tolerance",
            "oberes abmass",
            "oberes grenzabmass",
            "tol +",
            "tol+",
            "+tol",
            "plus",
            "es",
        ],
    ),
    (Role::Lower, "lower", &["lower", "lower deviation", "unteres abmass", "unteres grenzabmass", "ei"]),
    (Role::Minus, "minus", &["lower tolerance", "tol -", "tol-", "-tol", "minus"]),
    (Role::Tolerance, "tolerance", &["tolerance", "tol", "toleranz", "toleranzklasse", "abmass"]),
    (Role::Unit, "unit", &["unit", "einheit"]),
    (Role::Distribution, "distribution", &["distribution", "verteilung"]),
    (Role::Cp, "cp", &["cp"]),
    (Role::Sigma, "sigma", &["sigma", "standard deviation", "standardabweichung", "s"]),
];

/// A header without case, accents, and the unit in brackets after it, which comes second.
pub(crate) fn plain(header: &str) -> (String, Option<String>) {
    let (name, unit) = match header.split_once(['[', '(']) {
        Some((name, rest)) if rest.trim_end().ends_with([']', ')']) => {
            (name, Some(rest.trim_end().trim_end_matches([']', ')']).trim().to_owned()).filter(|unit| !unit.is_empty()))
        }
        _ => (header, None),
    };
    let mut text = String::new();
    for c in name.trim().trim_end_matches(':').to_lowercase().chars() {
        match c {
            'ä' | 'à' | 'á' | 'â' => text.push('a'),
            'ö' | 'ó' | 'ô' => text.push('o'),
            'ü' | 'ú' => text.push('u'),
            'é' | 'è' | 'ê' => text.push('e'),
            'ß' => text += "ss",
            '\u{2212}' | '\u{2013}' => text.push('-'),
            '_' | '.' => text.push(' '),
            c => text.push(c),
        }
    }
    (text.split_whitespace().collect::<Vec<_>>().join(" "), unit)
}

/// The role of a header, and the unit that it names.
pub(crate) fn role(header: &Content) -> Option<(Role, Option<String>)> {
    let Content::Text(text) = header else { return None };
    let (name, unit) = plain(text);
    ROLES.iter().find(|(_, _, headers)| headers.contains(&name.as_str())).map(|(role, ..)| (*role, unit))
}

/// The roles that are texts of a dimension, in the order of its keys.
pub(super) const LABELLED: [Role; 5] = [Role::Description, Role::Part, Role::Drawing, Role::Revision, Role::Feature];

/// The role of this name.
pub fn named(name: &str) -> Option<Role> {
    ROLES.iter().find(|(_, known, _)| *known == name).map(|(role, ..)| *role)
}
