//! Deserialises serde types from the tree, so that every error has its place and its key.

use std::fmt::Display;
use std::ops::Range;

use serde::de::value::StrDeserializer;
use serde::de::{self, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde_spanned::de::{SpannedDeserializer, is_spanned};

use crate::error::{Fault, Faults, StudyFault};
use crate::tree::{Key, Tree, Value};
use sensitol_numeric::names::nearest;

/// A fault on its way up through the tree. Its place is that of the innermost value with one. Each level adds its key in front of `path`.
#[derive(Debug)]
pub(super) struct Error {
    span: Option<Range<usize>>,
    path: Vec<String>,
    fault: Box<StudyFault>,
}

impl Error {
    fn new(fault: StudyFault) -> Self {
        Self { span: None, path: Vec::new(), fault: Box::new(fault) }
    }

    fn at(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }

    fn into_fault(self) -> Fault {
        Fault { span: self.span, key: self.path.join(".").replace(".[", "["), fault: self.fault }
    }

    #[cold]
    fn too_long(length: usize, expected: usize) -> Self {
        de::Error::invalid_length(length, &format!("a list of {expected}").as_str())
    }

    fn within(mut self, key: &str) -> Self {
        self.path.insert(0, key.to_owned());
        self
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.fault.fmt(f)
    }
}

impl std::error::Error for Error {}

impl de::Error for Error {
    fn custom<T: Display>(message: T) -> Self {
        Self::new(StudyFault::Syntax { message: message.to_string(), slip: None })
    }

    fn invalid_type(found: de::Unexpected<'_>, expected: &dyn de::Expected) -> Self {
        let found = match found {
            de::Unexpected::Bool(truth) => format!("`{truth}`"),
            de::Unexpected::Unsigned(value) => format!("the number {value}"),
            de::Unexpected::Signed(value) => format!("the number {value}"),
            de::Unexpected::Float(value) => format!("the number {value}"),
            de::Unexpected::Str(text) => format!("the text \"{text}\""),
            de::Unexpected::Seq => "a list".to_owned(),
            de::Unexpected::Map => "a table".to_owned(),
            other => other.to_string(),
        };
        Self::new(StudyFault::WrongType { expected: words(expected), found })
    }

    fn invalid_value(found: de::Unexpected<'_>, expected: &dyn de::Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn de::Expected) -> Self {
        let found = format!("a list of {length}");
        Self::new(StudyFault::WrongType { expected: words(expected), found })
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        let nearest = nearest(field, expected.iter().copied()).map(str::to_owned);
        let valid = expected.iter().map(|&key| key.to_owned()).collect();
        Self::new(StudyFault::UnknownKey { key: field.to_owned(), nearest, valid })
    }

    fn missing_field(field: &'static str) -> Self {
        Self::new(StudyFault::MissingKey { key: field.to_owned(), instead: format!("add `{field} = ...`") })
    }
}

/// Reads the tree into a type. After a fault the value at fault is removed and the rest is read again, so that all faults are reported
/// together.
pub(super) fn read<T: serde::de::DeserializeOwned>(tree: &Tree) -> Result<T, Faults> {
    let mut faults = Faults::default();
    let mut left = match T::deserialize(tree) {
        Ok(read) => return Ok(read),
        Err(error) => {
            let mut left = tree.clone();
            let more = left.remove(&error.path);
            faults.0.push(error.into_fault());
            if !more {
                return Err(faults);
            }
            left
        }
    };
    while faults.0.len() < crate::Study::MOST_FAULTS {
        let Err(error) = T::deserialize(&left) else { break };
        let on = left.remove(&error.path);
        let fault = error.into_fault();
        // A missing key is not reported if a wrong key was removed from the same entry: the wrong one is probably a misspelling of it.
        let entry = |key: &str| key.split('.').take(2).map(str::to_owned).collect::<Vec<_>>();
        let follows = matches!(*fault.fault, StudyFault::MissingKey { .. })
            && faults.0.iter().any(|earlier| entry(&earlier.key) == entry(&fault.key));
        if !follows {
            faults.0.push(fault);
        }
        if !on {
            break;
        }
    }
    Err(faults)
}

/// Text for a type that serde expects, in terms of a study file.
fn words(expected: &dyn de::Expected) -> String {
    let text = expected.to_string();
    match text.as_str() {
        "f64" => "a number".to_owned(),
        "u64" => "a whole number, 0 or above,".to_owned(),
        "a string" => "a text in quotes".to_owned(),
        "a sequence" => "a list such as [\"a\", \"b\"]".to_owned(),
        "a tuple of size 2" => "a pair of names".to_owned(),
        _ => match text.strip_prefix("an array of length ") {
            Some(length) => format!("a list of {length} numbers"),
            None => text,
        },
    }
}

impl Tree {
    /// Error for a value that is not of the kind `expected`.
    #[cold]
    fn mismatch(&self, expected: &dyn de::Expected) -> Error {
        let found = match &self.value {
            Value::Table(_) => de::Unexpected::Map,
            Value::Array(_) => de::Unexpected::Seq,
            Value::Text(text) => de::Unexpected::Str(text),
            Value::Number(value) => de::Unexpected::Float(*value),
            Value::Integer(value) => de::Unexpected::Signed(*value),
            Value::Truth(truth) => de::Unexpected::Bool(*truth),
            Value::Other(what) => de::Unexpected::Other(what),
        };
        <Error as de::Error>::invalid_type(found, expected).at(&self.span)
    }

    /// Passes all items of this list to the visitor. An item that is left over is a fault.
    fn items<'de, V: Visitor<'de>>(&'de self, values: &'de [Tree], visitor: V) -> Result<V::Value, Error> {
        let mut items = Items { items: values.iter(), index: 0 };
        let result = visitor.visit_seq(&mut items).and_then(|value| match items.items.len() {
            0 => Ok(value),
            left => Err(Error::too_long(values.len(), values.len() - left)),
        });
        result.map_err(|error| error.at(&self.span))
    }
}

impl<'de> IntoDeserializer<'de, Error> for &'de Tree {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for &'de Tree {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let result = match &self.value {
            Value::Table(entries) => visitor.visit_map(Entries { entries: entries.iter(), value: None }),
            Value::Array(values) => return self.items(values, visitor),
            Value::Text(text) => visitor.visit_borrowed_str(text),
            Value::Number(value) => visitor.visit_f64(*value),
            Value::Integer(value) => visitor.visit_i64(*value),
            Value::Truth(truth) => visitor.visit_bool(*truth),
            Value::Other(_) => return Err(self.mismatch(&visitor)),
        };
        result.map_err(|error| error.at(&self.span))
    }

    // Deserialise types with values of one kind only, so that their visitors need no code for the other kinds.

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Truth(truth) => visitor.visit_bool(*truth).map_err(|error: Error| error.at(&self.span)),
            _ => Err(self.mismatch(&visitor)),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let result = match &self.value {
            Value::Number(value) => visitor.visit_f64(*value),
            Value::Integer(value) => visitor.visit_i64(*value),
            _ => return Err(self.mismatch(&visitor)),
        };
        result.map_err(|error: Error| error.at(&self.span))
    }

    fn deserialize_i64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Integer(value) => visitor.visit_i64(*value).map_err(|error: Error| error.at(&self.span)),
            _ => Err(self.mismatch(&visitor)),
        }
    }

    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_i64(visitor)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_i64(visitor)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_i64(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Text(text) => visitor.visit_borrowed_str(text).map_err(|error: Error| error.at(&self.span)),
            _ => Err(self.mismatch(&visitor)),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Array(values) => self.items(values, visitor),
            _ => Err(self.mismatch(&visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Table(entries) => {
                let entries = Entries { entries: entries.iter(), value: None };
                visitor.visit_map(entries).map_err(|error| error.at(&self.span))
            }
            _ => Err(self.mismatch(&visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if is_spanned(name) {
            return visitor.visit_map(SpannedDeserializer::new(self, self.span.clone()));
        }
        // A list of values in the order of a structure's fields is refused: studies name their keys.
        self.deserialize_map(visitor)
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i32 i128 u16 u128 f32 char str bytes byte_buf unit unit_struct tuple_struct enum identifier ignored_any
    }
}

struct Entries<'de> {
    entries: std::slice::Iter<'de, (Key, Tree)>,
    value: Option<&'de (Key, Tree)>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: de::DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.value = self.entries.next();
        let Some((key, _)) = self.value else { return Ok(None) };
        // An unknown key is a fault at the key, not at its value.
        seed.deserialize(key).map(Some).map_err(|error| error.at(&key.span).within(&key.name))
    }

    fn next_value_seed<V: de::DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let (key, tree) = self.value.expect("a value follows its key");
        seed.deserialize(tree).map_err(|error| error.at(&tree.span).within(&key.name))
    }
}

struct Items<'de> {
    items: std::slice::Iter<'de, Tree>,
    index: usize,
}

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Error;

    fn next_element_seed<T: de::DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some(tree) = self.items.next() else { return Ok(None) };
        self.index += 1;
        seed.deserialize(tree).map(Some).map_err(|error| error.at(&tree.span).within(&format!("[{}]", self.index)))
    }
}

impl<'de> IntoDeserializer<'de, Error> for &'de Key {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// A key is a text that also gives its place.
impl<'de> Deserializer<'de> for &'de Key {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        StrDeserializer::new(&self.name).deserialize_any(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if is_spanned(name) {
            return visitor.visit_map(SpannedDeserializer::new(self, self.span.clone()));
        }
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize)]
    #[allow(dead_code, reason = "the test reads faults, and no field")]
    struct Entry {
        nominal: f64,
        count: u64,
        name: Option<String>,
        pair: Option<[f64; 2]>,
    }

    /// Reads one entry. Returns the text of its first fault.
    fn read_entry(entry: &str) -> Result<Entry, String> {
        let tree = Tree::of_json(&format!("{{\"entry\": {entry}}}")).map_err(|fault| fault.fault.to_string())?;
        let found = read::<std::collections::BTreeMap<String, Entry>>(&tree);
        found.map(|mut found| found.remove("entry").unwrap()).map_err(|faults| faults.0[0].fault.to_string())
    }

    #[test]
    fn values_of_a_wrong_type_are_named() {
        let entry = read_entry(r#"{"nominal": 1, "count": 2, "name": "a", "pair": [1, 2.5]}"#).unwrap();
        assert_eq!((entry.nominal, entry.count, entry.pair), (1.0, 2, Some([1.0, 2.5])));
        for (wrong, said) in [
            (r#"[1, 2, "a"]"#, "a list stands"),
            (r#"{"nominal": "1", "count": 2}"#, "the text \"1\" stands where a number is needed"),
            (r#"{"nominal": 1, "count": 2.5}"#, "the number 2.5 stands"),
            (r#"{"nominal": 1, "count": 2, "name": true}"#, "`true` stands where a text in quotes is needed"),
            (r#"{"nominal": 1, "count": 2, "pair": [1, 2, 3]}"#, "a list of 3 stands"),
            (r#"{"nominal": 1, "count": 2, "pair": {"a": 1}}"#, "a table stands"),
        ] {
            let found = read_entry(wrong).unwrap_err();
            assert!(found.starts_with(said), "{wrong}: {found}");
        }
    }
}
