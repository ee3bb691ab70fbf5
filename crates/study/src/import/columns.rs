//! Columns of a stack-up table, recognised by their headers in English and German.

use crate::import::sheet::Content;
use sensitol_numeric::unit::Unit;

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
    /// Number of equal parts.
    Quantity,
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
    /// Half-width of a band on both sides.
    PlusMinus,
    /// Greatest permitted value.
    Max,
    /// Least permitted value.
    Min,
    /// Unit.
    Unit,
    /// Kind of distribution.
    Distribution,
    /// Process capability.
    Cp,
    /// Process capability with the place of the mean.
    Cpk,
    /// Standard deviation.
    Sigma,
    /// Number of standard deviations in half the band.
    Sigmas,
    /// Distance of the mean from the middle of the band.
    Shift,
    /// A column that is left out.
    Ignore,
}

/// Roles with their names and headers. Headers are in the form that `plain` gives. Of two columns with a text role the one whose header
/// stands first counts.
pub const ROLES: [(ColumnRole, &str, &[&str]); 25] = [
    (
        ColumnRole::Name,
        "name",
        &[
            "name",
            "dimension",
            "dimension name",
            "bezeichnung",
            "massbezeichnung",
            "mass",
            "masz",
            "label",
            "symbol",
            "contributor",
            "feature name",
            "characteristic",
            "variable",
            "item name",
            "kurzzeichen",
            "measurement name",
            "code",
            "key",
            "dimension id",
            "characteristic id",
            "char id",
            "id",
        ],
    ),
    (
        ColumnRole::Part,
        "part",
        &["part", "part name", "component", "component name", "bauteil", "teil", "komponente", "einzelteil", "item"],
    ),
    (
        ColumnRole::Description,
        "description",
        &[
            "description",
            "desc",
            "beschreibung",
            "benennung",
            "requirement",
            "anforderung",
            "remark",
            "comment",
            "notes",
            "note",
            "bemerkung",
            "kommentar",
            "notiz",
            "notes source",
        ],
    ),
    (
        ColumnRole::Drawing,
        "drawing",
        &[
            "drawing",
            "drawing no",
            "drawing number",
            "zeichnung",
            "zeichnungsnummer",
            "zeichnungsnr",
            "zeichnungs nr",
            "p n",
        ],
    ),
    (ColumnRole::Revision, "revision", &["revision", "rev", "anderungsindex", "anderungsstand"]),
    (
        ColumnRole::Feature,
        "feature",
        &["feature", "balloon", "balloon number", "bubble number", "merkmal", "merkmalsnummer", "merkmalsnr"],
    ),
    (
        ColumnRole::Direction,
        "direction",
        &["direction", "dir", "sign", "richtung", "vorzeichen", "vz", "wirkrichtung", "richtungssinn"],
    ),
    (
        ColumnRole::Factor,
        "factor",
        &[
            "factor",
            "lever",
            "sensitivity",
            "sens",
            "coefficient",
            "coeff",
            "hebel",
            "faktor",
            "hebelarm",
            "empfindlichkeit",
            "sensitivitat",
            "ubersetzung",
            "einflussfaktor",
            "a",
        ],
    ),
    (
        ColumnRole::Quantity,
        "quantity",
        &["quantity", "qty", "count", "number of parts", "anzahl", "menge", "stuck", "stuckzahl", "stk"],
    ),
    (
        ColumnRole::Nominal,
        "nominal",
        &[
            "nominal",
            "nom",
            "nominal value",
            "nominal size",
            "nominal dimension",
            "basic size",
            "basic",
            "dim",
            "nennmass",
            "nennwert",
            "sollmass",
            "soll",
            "sollwert",
            "nenn",
        ],
    ),
    (
        ColumnRole::Upper,
        "upper",
        &[
            "upper deviation",
            "upper dev",
            "upper tolerance",
            "upper tol",
            "upper tol +",
            "upper tolerance +",
            "tolerance upper",
            "tol upper",
            "oberes abmass",
            "oberes grenzabmass",
            "ob abmass",
            "o tol",
            "otol",
            "obere toleranz",
            "tol +",
            "tol+",
            "+tol",
            "+ tol",
            "tolerance +",
            "+ tolerance",
            "+tolerance",
            "plus",
            "plus tol",
            "plus tolerance",
            "tol plus",
            "tolerance plus",
            "tol pos",
            "+",
            "es",
            "toleranz +",
            "plustoleranz",
            "toleranz plus",
            "plus toleranz",
        ],
    ),
    (
        ColumnRole::Lower,
        "lower",
        &["lower deviation", "lower dev", "unteres abmass", "unteres grenzabmass", "unt abmass", "ei"],
    ),
    (
        ColumnRole::Minus,
        "minus",
        &[
            "lower tolerance",
            "lower tol",
            "lower tol -",
            "lower tolerance -",
            "tolerance lower",
            "tol lower",
            "u tol",
            "utol",
            "untere toleranz",
            "tol -",
            "tol-",
            "-tol",
            "- tol",
            "tolerance -",
            "- tolerance",
            "-tolerance",
            "minus",
            "minus tol",
            "minus tolerance",
            "tol minus",
            "tolerance minus",
            "tol neg",
            "-",
            "toleranz -",
            "minustoleranz",
            "toleranz minus",
            "minus toleranz",
        ],
    ),
    (
        ColumnRole::Tolerance,
        "tolerance",
        &["tolerance", "tol", "toleranz", "toleranzklasse", "abmass", "abmasse", "passung", "fit", "tolerance class"],
    ),
    (
        ColumnRole::PlusMinus,
        "plus-minus",
        &[
            "plus minus",
            "+/- tol",
            "+/- tolerance",
            "± tol",
            "± tolerance",
            "±tol",
            "±tolerance",
            "tol ±",
            "tolerance ±",
            "toleranz ±",
            "± toleranz",
            "+/- toleranz",
            "toleranz +/-",
            "tol +/-",
            "tolerance +/-",
            "half tol",
            "half tolerance",
            "bilateral",
            "equal bilateral tolerance",
            "symmetric tolerance",
            "halbe toleranz",
        ],
    ),
    (
        ColumnRole::Max,
        "max",
        &[
            "usl",
            "upper limit",
            "upper spec limit",
            "upper specification limit",
            "maximum size",
            "max size",
            "upper size",
            "obere grenze",
            "oberes grenzmass",
            "hochstmass",
            "grosstmass",
            "otg",
            "osg",
            "obere toleranzgrenze",
            "obere spezifikationsgrenze",
            "maximalmass",
        ],
    ),
    (
        ColumnRole::Min,
        "min",
        &[
            "lsl",
            "lower limit",
            "lower spec limit",
            "lower specification limit",
            "minimum size",
            "min size",
            "lower size",
            "untere grenze",
            "unteres grenzmass",
            "mindestmass",
            "kleinstmass",
            "utg",
            "usg",
            "untere toleranzgrenze",
            "untere spezifikationsgrenze",
            "minimalmass",
        ],
    ),
    (ColumnRole::Unit, "unit", &["unit", "units", "einheit"]),
    (
        ColumnRole::Distribution,
        "distribution",
        &["distribution", "dist", "distribution type", "verteilung", "verteilungsform"],
    ),
    (ColumnRole::Cp, "cp", &["cp"]),
    (ColumnRole::Cpk, "cpk", &["cpk"]),
    (ColumnRole::Sigma, "sigma", &["sigma", "standard deviation", "std dev", "stddev", "standardabweichung", "s"]),
    (ColumnRole::Sigmas, "sigmas", &["sigmas", "half band in sigmas", "sigma level"]),
    (ColumnRole::Shift, "shift", &["shift", "mean off middle"]),
    (
        ColumnRole::Ignore,
        "ignore",
        // Numbers of rows, and results that an analysis computes anew.
        &[
            "#",
            "no",
            "nr",
            "pos",
            "position",
            "row",
            "zeile",
            "step",
            "index",
            "lfd nr",
            "lfd",
            "item no",
            "number",
            "nummer",
            "op number",
            "middle",
            "half band",
            "mean",
            "mittelwert",
            "mittenmass",
            "center",
            "centre",
            "standard dev",
            "effect",
            "rss %",
            "%",
            "contribution",
            "contribution %",
            "% contribution",
            "beitrag",
            "anteil",
            "variance",
            "varianz",
            "tol^2",
            "tol²",
            "share",
        ],
    ),
];

/// Headers that stand for the upper limit in one table and for the upper deviation in another.
const UPPER_OR_MAX: [&str; 8] = ["upper", "max", "maximum", "obere", "oberes", "oben", "ob", "obermass"];
/// Headers that stand for the lower limit in one table and for the lower deviation in another.
const LOWER_OR_MIN: [&str; 8] = ["lower", "min", "minimum", "untere", "unteres", "unten", "unt", "untermass"];
/// Headers that stand for the direction in one table and for a tolerance on both sides in another.
const SIGN_OR_BAND: [&str; 4] = ["+/-", "±", "+-", "-/+"];
/// Units that headers have as their last word, without brackets.
const LAST_WORDS: [&str; 15] =
    ["mm", "cm", "um", "\u{b5}m", "\u{3bc}m", "nm", "in", "inch", "inches", "mil", "thou", "deg", "rad", "micron", "%"];

/// Meaning of a header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Heading {
    /// One role.
    Role(ColumnRole),
    /// Upper limit or upper deviation: the numbers decide.
    UpperOrMax,
    /// Lower limit or lower deviation: the numbers decide.
    LowerOrMin,
    /// Direction or tolerance: the cells decide.
    SignOrBand,
}

/// Header in lower case without accents. `plusTolerance` becomes `plus tolerance`.
pub(crate) fn plain(header: &str) -> String {
    let mut text = String::new();
    let mut before = ' ';
    for c in header.trim().trim_end_matches(':').chars() {
        if c.is_uppercase() && before.is_lowercase() {
            text.push(' ');
        }
        before = c;
        match c.to_lowercase().next().unwrap_or(c) {
            'ä' | 'à' | 'á' | 'â' => text.push('a'),
            'ö' | 'ó' | 'ô' => text.push('o'),
            'ü' | 'ú' => text.push('u'),
            'é' | 'è' | 'ê' => text.push('e'),
            'ß' => text += "ss",
            '\u{2212}' | '\u{2013}' => text.push('-'),
            '_' | '.' | ':' | ',' | '\u{a0}' | '(' | ')' | '[' | ']' => text.push(' '),
            c => text.push(c),
        }
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut text = words.join(" ");
    // A hyphen or a slash between letters separates words.
    for mark in ["-", "/"] {
        let parts: Vec<&str> = text.split(mark).collect();
        let letters = |part: &&str| part.chars().all(|c| c.is_alphanumeric() || c == ' ') && !part.trim().is_empty();
        if parts.len() > 1 && parts.iter().all(letters) {
            text = parts.iter().map(|part| part.trim()).collect::<Vec<_>>().join(" ");
        }
    }
    text
}

/// Ways to read a header, each with the unit that stands in it: `Nennmaß [mm]`, `nominal_mm`.
fn readings(header: &str) -> Vec<(String, Option<String>)> {
    let trimmed = header.trim();
    let bracket = trimmed.rfind(['[', '(']).filter(|_| trimmed.ends_with([']', ')']));
    let mut all = Vec::new();
    if let Some(open) = bracket {
        let (name, rest) = trimmed.split_at(open);
        let inner = rest.trim_matches(['[', ']', '(', ')', ' ']);
        let unit = unit_of(inner);
        if unit.is_some() {
            all.push((plain(name), unit));
        } else {
            all.push((plain(&format!("{name} {inner}")), None));
            all.push((plain(name), None));
        }
        return all;
    }
    all.push((plain(trimmed), None));
    if let Some((name, last)) = trimmed.rsplit_once([' ', '_', ','])
        && LAST_WORDS.contains(&last)
    {
        let name = plain(name);
        all.push((name.strip_suffix(" in").map_or(name.clone(), str::to_owned), unit_of(last)));
    }
    all
}

/// Unit in a header. Returns None if the text is no unit.
pub(super) fn unit_of(text: &str) -> Option<String> {
    let text = match text {
        "inches" => "in",
        "mils" => "mil",
        text => text,
    };
    let is_unit = !["", "-", "1"].contains(&text) && Unit::parse(text).is_some();
    is_unit.then(|| text.to_owned())
}

/// Meaning of a header and the unit in it. Returns None for an unknown header.
pub(super) fn heading(header: &Content) -> Option<(Heading, Option<String>)> {
    let Content::Text(text) = header else { return None };
    readings(text).into_iter().find_map(|(name, unit)| {
        let name = name.as_str();
        let role = ROLES.iter().find(|(_, _, headers)| headers.contains(&name)).map(|(role, ..)| Heading::Role(*role));
        let either = [
            (Heading::UpperOrMax, &UPPER_OR_MAX[..]),
            (Heading::LowerOrMin, &LOWER_OR_MIN),
            (Heading::SignOrBand, &SIGN_OR_BAND),
        ];
        let either = || either.iter().find(|(_, headers)| headers.contains(&name)).map(|(heading, _)| *heading);
        Some((role.or_else(either)?, unit))
    })
}

/// Place of a header among those of its role. A column with a lower one comes before others with the same role.
pub(super) fn rank(role: ColumnRole, header: &str) -> usize {
    let known = ROLES.iter().find(|(known, ..)| *known == role).map_or(&[][..], |(_, _, headers)| headers);
    let readings = readings(header);
    let place = |(name, _): &(String, Option<String>)| known.iter().position(|header| header == name);
    readings.iter().find_map(place).unwrap_or(usize::MAX)
}

/// Roles of the texts of a dimension, in the order of its keys.
pub(super) const LABELLED: [ColumnRole; 5] =
    [ColumnRole::Description, ColumnRole::Part, ColumnRole::Drawing, ColumnRole::Revision, ColumnRole::Feature];
/// Roles that stand for the name of a dimension where no column has it, the best first.
pub(super) const NAMES: [ColumnRole; 4] =
    [ColumnRole::Name, ColumnRole::Feature, ColumnRole::Part, ColumnRole::Description];

/// ColumnRole of this name. Returns None if there is none.
pub fn named(name: &str) -> Option<ColumnRole> {
    ROLES.iter().find(|(_, known, _)| *known == name).map(|(role, ..)| *role)
}

/// Name of a role.
pub(super) fn role_name(role: ColumnRole) -> &'static str {
    ROLES.iter().find(|(known, ..)| *known == role).map_or("value", |(_, name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_read_in_their_spellings() {
        let of = |header: &str| heading(&Content::Text(header.to_owned()));
        let role = |role: ColumnRole| Some((Heading::Role(role), None));
        let in_unit = |role: ColumnRole, unit: &str| Some((Heading::Role(role), Some(unit.to_owned())));
        for header in ["plusTolerance", "Tol +", "Upper Tol (+)", "tol_plus", "+ Tol", "O-Tol", "Oberes Abmaß:", "PLUS"]
        {
            assert_eq!(of(header), role(ColumnRole::Upper), "{header}");
        }
        for header in ["minusTolerance", "Tol \u{2212}", "Lower Tol (-)", "toleranceMinus", "U-Tol", "tol_neg"] {
            assert_eq!(of(header), role(ColumnRole::Minus), "{header}");
        }
        assert_eq!(of("nominal_mm"), in_unit(ColumnRole::Nominal, "mm"));
        assert_eq!(of("Nennmaß [mm]"), in_unit(ColumnRole::Nominal, "mm"));
        assert_eq!(of("Toleranz [\u{b5}m]"), in_unit(ColumnRole::Tolerance, "\u{b5}m"));
        assert_eq!(of("Nominal in mm"), in_unit(ColumnRole::Nominal, "mm"));
        assert_eq!(of("\u{2212} Tol (mm)"), in_unit(ColumnRole::Minus, "mm"));
        assert_eq!(of("Tolerance (see drawing)"), role(ColumnRole::Tolerance));
        assert_eq!(of("Upper"), Some((Heading::UpperOrMax, None)));
        assert_eq!(of("Min"), Some((Heading::LowerOrMin, None)));
        for unknown in ["T1", "Sampling", "Method (Worst/RSS)", ""] {
            assert_eq!(of(unknown), None, "{unknown}");
        }
    }
}
