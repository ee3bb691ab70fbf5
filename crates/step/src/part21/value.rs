//! Values in the arguments of an entity.

use super::error::{Part21Error, Part21Fault};
use super::scan::Cursor;

/// Greatest number of lists inside lists. The schemas have at most five.
const DEEPEST: usize = 32;
/// Greatest number of values of one entity. The longest list of a valid part is that of the faces of its shell.
const MOST_VALUES: usize = 1 << 22;

/// A value of an argument. Texts are slices of the file.
#[derive(Debug, Clone, PartialEq)]
pub enum StepValue<'a> {
    /// `$`: no value.
    Omitted,
    /// `*`: a value that a subtype derives.
    Derived,
    /// An integer or a real number.
    Number(f64),
    /// A string as it is written, with its escapes.
    Text(&'a [u8]),
    /// A word between points.
    Word(&'a str),
    /// Digits of a binary.
    Binary(&'a [u8]),
    /// Number of an entity.
    Reference(u64),
    /// A value with the name of its type.
    Typed(&'a str, Vec<StepValue<'a>>),
    /// A list or set.
    List(Vec<StepValue<'a>>),
}

impl<'a> StepValue<'a> {
    /// Number of the entity to which the value refers. Returns None for other values.
    pub fn reference(&self) -> Option<u64> {
        match self {
            Self::Reference(id) => Some(*id),
            _ => None,
        }
    }

    /// Number, also with the name of its type. Returns None for other values, and unless it is finite.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number).filter(|number| number.is_finite()),
            Self::Typed(_, inside) => match &inside[..] {
                [Self::Number(number)] => Some(*number).filter(|number| number.is_finite()),
                _ => None,
            },
            _ => None,
        }
    }

    /// Word of an enumeration. Returns None for other values.
    pub fn word(&self) -> Option<&'a str> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    /// String with its escapes decoded. Returns None for other values.
    pub fn text(&self) -> Option<String> {
        match self {
            Self::Text(raw) => Some(decoded(raw)),
            _ => None,
        }
    }

    /// Items of a list, or of a typed list. Returns nothing for other values.
    pub fn items(&self) -> &[StepValue<'a>] {
        match self {
            Self::List(items) => items,
            Self::Typed(_, inside) => match &inside[..] {
                [Self::List(items)] => items,
                _ => inside,
            },
            _ => &[],
        }
    }

    /// Numbers of all entities to which the value refers, in the order of the text.
    pub fn references(&self) -> Vec<u64> {
        let mut found = Vec::new();
        let mut open = vec![self];
        while let Some(value) = open.pop() {
            match value {
                Self::Reference(id) => found.push(*id),
                Self::List(items) | Self::Typed(_, items) => open.extend(items.iter().rev()),
                _ => {}
            }
        }
        found
    }
}

/// Reads the arguments in parentheses at the cursor.
pub(super) fn arguments<'a>(cursor: &mut Cursor<'a>, id: u64) -> Result<Vec<StepValue<'a>>, Part21Error> {
    let mut left = MOST_VALUES;
    list(cursor, id, 0, &mut left)
}

fn list<'a>(
    cursor: &mut Cursor<'a>,
    id: u64,
    depth: usize,
    left: &mut usize,
) -> Result<Vec<StepValue<'a>>, Part21Error> {
    if depth > DEEPEST {
        return Err(cursor.error(Part21Fault::Deep(id, DEEPEST)));
    }
    cursor.expect(b'(', "`(`")?;
    let mut found = Vec::new();
    loop {
        cursor.skip_space()?;
        match cursor.peek() {
            Some(b')') => {
                cursor.advance(1);
                return Ok(found);
            }
            Some(b',') if !found.is_empty() => cursor.advance(1),
            _ if found.is_empty() => {}
            _ => return Err(cursor.syntax("`,` or `)`")),
        }
        *left = left.checked_sub(1).ok_or_else(|| cursor.error(Part21Fault::Long(id, MOST_VALUES)))?;
        found.push(value(cursor, id, depth, left)?);
    }
}

fn value<'a>(cursor: &mut Cursor<'a>, id: u64, depth: usize, left: &mut usize) -> Result<StepValue<'a>, Part21Error> {
    cursor.skip_space()?;
    Ok(match cursor.peek() {
        None => return Err(cursor.error(Part21Fault::CutOff)),
        Some(b'$') => {
            cursor.advance(1);
            StepValue::Omitted
        }
        Some(b'*') => {
            cursor.advance(1);
            StepValue::Derived
        }
        Some(b'#') => StepValue::Reference(cursor.number_of_entity()?),
        Some(b'\'') => StepValue::Text(cursor.quoted(b'\'')?),
        Some(b'"') => StepValue::Binary(cursor.quoted(b'"')?),
        Some(b'(') => StepValue::List(list(cursor, id, depth + 1, left)?),
        Some(b'.') => {
            cursor.advance(1);
            let word = cursor.keyword();
            cursor.expect(b'.', "`.` after a word")?;
            StepValue::Word(word)
        }
        Some(c) if c.is_ascii_digit() || c == b'-' || c == b'+' => StepValue::Number(cursor.number()?),
        Some(c) if c.is_ascii_alphabetic() || c == b'!' => {
            let name = cursor.keyword();
            cursor.skip_space()?;
            StepValue::Typed(name, list(cursor, id, depth + 1, left)?)
        }
        Some(_) => return Err(cursor.syntax("a value")),
    })
}

/// Text of a string: doubled quotes, `\X2\` and `\X4\` for Unicode, `\X\` and `\S\` for Latin 1. Other text is read as UTF-8 or Latin 1.
fn decoded(raw: &[u8]) -> String {
    let text = match std::str::from_utf8(raw) {
        Ok(text) => text.to_owned(),
        Err(_) => raw.iter().map(|&byte| char::from(byte)).collect(),
    };
    let text = text.replace("''", "'");
    let mut found = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find('\\') {
        found += &rest[..at];
        let (decoded, after) = escape(&rest[at..]);
        found.push_str(&decoded);
        rest = after;
    }
    found + rest
}

/// Decodes the escape at the beginning of a text. Returns the rest after it.
fn escape(text: &str) -> (String, &str) {
    for (start, digits) in [("\\X2\\", 4), ("\\X4\\", 8)] {
        if let Some(rest) = text.strip_prefix(start) {
            let Some((hex, after)) = rest.split_once("\\X0\\") else { return (String::new(), rest) };
            let units: Vec<u32> = (hex.as_bytes().chunks(digits))
                .map(|unit| std::str::from_utf8(unit).ok().and_then(|unit| u32::from_str_radix(unit, 16).ok()))
                .map(|unit| unit.unwrap_or(0xFFFD))
                .collect();
            let decoded = match digits {
                4 => String::from_utf16_lossy(&units.iter().map(|&unit| unit as u16).collect::<Vec<_>>()),
                _ => units.iter().map(|&unit| char::from_u32(unit).unwrap_or('\u{FFFD}')).collect(),
            };
            return (decoded, after);
        }
    }
    if let Some(rest) = text.strip_prefix("\\X\\")
        && let Some(code) = rest.get(..2).and_then(|hex| u8::from_str_radix(hex, 16).ok())
    {
        return (char::from(code).to_string(), &rest[2..]);
    }
    if let Some(rest) = text.strip_prefix("\\S\\")
        && let Some(c) = rest.chars().next().filter(char::is_ascii)
    {
        return (char::from(c as u8 | 0x80).to_string(), &rest[1..]);
    }
    if let Some(rest) = text.strip_prefix("\\\\") {
        return ("\\".to_owned(), rest);
    }
    ("\\".to_owned(), &text[1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_decoded() {
        // ISO 10303-21, 6.4.3: diameter sign by its code, Latin 1 by both escapes, doubled characters.
        assert_eq!(decoded(br"\X2\2300\X0\5 \X2\00B1\X0\ 0.1"), "\u{2300}5 \u{b1} 0.1");
        assert_eq!(decoded(br"\X\E4 \S\d it''s a\\b"), "\u{e4} \u{e4} it's a\\b");
        assert_eq!(decoded(br"\X4\0001F600\X0\"), "\u{1F600}");
        assert_eq!(decoded(br"\X2\23"), "23");
    }
}
