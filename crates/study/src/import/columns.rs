//! Columns of a stack-up table, recognised by their headers in English and German.

use crate::import::sheet::Content;

/// Meaning of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnRole {
    /// Name of the dimension.
    Name,
    /// Part of the dimension.
    Part,
    /// Description of the dimension.
    Description,
    /// Number of the drawing.
    Drawing,
    /// Revision of the drawing.
    Revision,
    /// Feature of the part, or its number on the drawing.
    Feature,
    /// Sign of the dimension in the sum.
    Direction,
    /// Factor of the dimension in the sum.
    Factor,
    /// Nominal value.
    Nominal,
    /// Upper deviation.
    Upper,
    /// Lower deviation with its sign.
    Lower,
    /// Lower deviation that is negative even without a sign.
    Minus,
    /// Tolerance in one cell.
    Tolerance,
    /// Unit.
    Unit,
    /// Kind of distribution.
    Distribution,
    /// Process capability.
    Cp,
    /// Standard deviation.
    Sigma,
}

/// Roles with their names and headers. Headers are in the form that `plain` gives.
pub const ROLES: [(ColumnRole, &str, &[&str]); 17] = [
    (
        ColumnRole::Name,
        "name",
        &["name", "dimension", "bezeichnung", "mass", "masz", "massbezeichnung", "symbol", "id"],
    ),
    (ColumnRole::Part, "part", &["part", "component", "bauteil", "teil", "komponente"]),
    (
        ColumnRole::Description,
        "description",
        &["description", "remark", "comment", "beschreibung", "bemerkung", "kommentar", "benennung"],
    ),
    (ColumnRole::Drawing, "drawing", &["drawing", "drawing no", "zeichnung", "zeichnungsnummer", "zeichnungsnr"]),
    (ColumnRole::Revision, "revision", &["revision", "rev", "anderungsindex", "anderungsstand"]),
    (ColumnRole::Feature, "feature", &["feature", "balloon", "merkmal", "merkmalsnummer", "merkmalsnr"]),
    (ColumnRole::Direction, "direction", &["direction", "sign", "richtung", "vorzeichen", "+/-"]),
    (ColumnRole::Factor, "factor", &["factor", "lever", "sensitivity", "coefficient", "hebel", "faktor", "hebelarm"]),
    (
        ColumnRole::Nominal,
        "nominal",
        &["nominal", "nominal value", "nominal size", "nennmass", "nennwert", "nennmaß", "sollmass"],
    ),
    (
        ColumnRole::Upper,
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
    (ColumnRole::Lower, "lower", &["lower", "lower deviation", "unteres abmass", "unteres grenzabmass", "ei"]),
    (ColumnRole::Minus, "minus", &["lower tolerance", "tol -", "tol-", "-tol", "minus"]),
    (ColumnRole::Tolerance, "tolerance", &["tolerance", "tol", "toleranz", "toleranzklasse", "abmass"]),
    (ColumnRole::Unit, "unit", &["unit", "einheit"]),
    (ColumnRole::Distribution, "distribution", &["distribution", "verteilung"]),
    (ColumnRole::Cp, "cp", &["cp"]),
    (ColumnRole::Sigma, "sigma", &["sigma", "standard deviation", "standardabweichung", "s"]),
];

/// Header in lower case without accents, and the unit in brackets behind it, if any.
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

/// ColumnRole of a header and the unit in it. Returns None for an unknown header.
pub(crate) fn role(header: &Content) -> Option<(ColumnRole, Option<String>)> {
    let Content::Text(text) = header else { return None };
    let (name, unit) = plain(text);
    ROLES.iter().find(|(_, _, headers)| headers.contains(&name.as_str())).map(|(role, ..)| (*role, unit))
}

/// Roles of the texts of a dimension, in the order of its keys.
pub(super) const LABELLED: [ColumnRole; 5] =
    [ColumnRole::Description, ColumnRole::Part, ColumnRole::Drawing, ColumnRole::Revision, ColumnRole::Feature];

/// ColumnRole of this name. Returns None if there is none.
pub fn named(name: &str) -> Option<ColumnRole> {
    ROLES.iter().find(|(_, known, _)| *known == name).map(|(role, ..)| *role)
}
