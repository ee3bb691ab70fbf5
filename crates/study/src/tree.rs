//! TOML and JSON as one tree of values with their places in the file.

use std::ops::Range;

use jsonc_parser::ast;
use toml::de::{DeTable, DeValue};

use crate::error::{Fault, StudyFault, fault};
use crate::typing_habits::TypingHabit;

/// A value and its place in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tree {
    pub(super) span: Range<usize>,
    pub(super) value: Value,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Table(Vec<(Key, Tree)>),
    Array(Vec<Tree>),
    Text(String),
    Number(f64),
    Integer(i64),
    Truth(bool),
    /// A value that studies do not use: a date, or null.
    Other(&'static str),
}

/// A key and its place in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Key {
    pub(super) span: Range<usize>,
    pub(super) name: String,
}

impl Tree {
    /// Removes the value at this path, or the innermost list that holds it. Returns true if the path begins at an entry of this table.
    pub(super) fn remove(&mut self, path: &[String]) -> bool {
        let Some((first, rest)) = path.split_first() else { return false };
        let Value::Table(entries) = &mut self.value else { return false };
        let Some(place) = entries.iter().position(|(key, _)| key.name == *first) else { return false };
        if rest.is_empty() || !entries[place].1.remove(rest) {
            entries.remove(place);
        }
        true
    }

    pub(super) fn of_toml(text: &str) -> Result<Self, Fault> {
        let table = DeTable::parse(text).map_err(|error| {
            let key = error.span().map(|span| text[span].trim_matches(['"', '\'']).to_owned());
            let found = match key {
                Some(key) if error.message().contains("duplicate key") => StudyFault::DuplicateKey { key },
                _ => {
                    let message = error.message().lines().collect::<Vec<_>>().join("; ");
                    let slip = error.span().and_then(|span| TypingHabit::of_syntax(text, &span, &message));
                    StudyFault::Syntax { message, slip }
                }
            };
            Fault { span: error.span(), key: String::new(), fault: Box::new(found) }
        })?;
        let span = table.span();
        Ok(Self { span, value: toml_table(table.get_ref())? })
    }

    pub(super) fn of_json(text: &str) -> Result<Self, Fault> {
        let strict = jsonc_parser::ParseOptions {
            allow_comments: false,
            allow_loose_object_property_names: false,
            allow_trailing_commas: false,
            allow_missing_commas: false,
            allow_single_quoted_strings: false,
            allow_hexadecimal_numbers: false,
            allow_unary_plus_numbers: false,
            ..Default::default()
        };
        let parsed = jsonc_parser::parse_to_ast(text, &Default::default(), &strict).map_err(|error| {
            let range = error.range();
            let (span, message) = (range.start..range.end, error.kind().to_string());
            let slip = TypingHabit::of_syntax(text, &span, &message);
            fault(span, "", StudyFault::Syntax { message, slip })
        })?;
        match &parsed.value {
            Some(value) => json_value(value),
            None => Ok(Self { span: 0..text.len(), value: Value::Table(Vec::new()) }),
        }
    }
}

fn finite(text: &str, span: &Range<usize>) -> Result<f64, Fault> {
    match text.replace('_', "").parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(fault(span.clone(), "", StudyFault::NotFinite { text: text.to_owned() })),
    }
}

/// Fault of a value with the key of its table in front of its own.
fn below(name: &str, fault: Fault) -> Fault {
    let key = match fault.key.is_empty() {
        true => name.to_owned(),
        false => format!("{name}.{}", fault.key),
    };
    Fault { key, ..fault }
}

fn toml_table(table: &DeTable<'_>) -> Result<Value, Fault> {
    let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<DeValue<'_>>)| {
        let key: &toml::Spanned<std::borrow::Cow<'_, str>> = key;
        let name = key.get_ref().to_string();
        let value = toml_value(value).map_err(|fault| below(&name, fault))?;
        Ok((Key { span: key.span(), name }, value))
    };
    Ok(Value::Table(table.iter().map(entry).collect::<Result<_, _>>()?))
}

fn toml_value(value: &toml::Spanned<DeValue<'_>>) -> Result<Tree, Fault> {
    let span = value.span();
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(value) => Value::Integer(value),
            Err(_) => Value::Number(finite(integer.as_str(), &span)?),
        },
        DeValue::Float(number) => Value::Number(finite(number.as_str(), &span)?),
        DeValue::Boolean(truth) => Value::Truth(*truth),
        DeValue::Datetime(_) => Value::Other("a date"),
        DeValue::Array(items) => Value::Array(items.iter().map(toml_value).collect::<Result<_, _>>()?),
        DeValue::Table(table) => toml_table(table)?,
    };
    Ok(Tree { span, value })
}

fn json_value(value: &ast::Value<'_>) -> Result<Tree, Fault> {
    let range = |range: &jsonc_parser::common::Range| range.start..range.end;
    let (span, value) = match value {
        ast::Value::StringLit(text) => (range(&text.range), Value::Text(text.value.to_string())),
        ast::Value::NumberLit(number) => {
            let span = range(&number.range);
            let value = match number.value.parse::<i64>() {
                Ok(integer) => Value::Integer(integer),
                Err(_) => Value::Number(finite(number.value, &span)?),
            };
            (span, value)
        }
        ast::Value::BooleanLit(truth) => (range(&truth.range), Value::Truth(truth.value)),
        ast::Value::NullKeyword(null) => (range(&null.range), Value::Other("null")),
        ast::Value::Array(array) => {
            let items = array.elements.iter().map(json_value).collect::<Result<_, _>>()?;
            (range(&array.range), Value::Array(items))
        }
        ast::Value::Object(object) => (range(&object.range), json_object(object)?),
    };
    Ok(Tree { span, value })
}

/// JSON permits a repeated key. A study does not.
fn json_object(object: &ast::Object<'_>) -> Result<Value, Fault> {
    let mut entries: Vec<(Key, Tree)> = Vec::with_capacity(object.properties.len());
    let mut seen = std::collections::HashSet::new();
    for property in &object.properties {
        let name = property.name.as_str().to_owned();
        let range = match &property.name {
            ast::ObjectPropName::String(text) => text.range,
            ast::ObjectPropName::Word(word) => word.range,
        };
        let span = range.start..range.end;
        if !seen.insert(name.clone()) {
            return Err(fault(span, "", StudyFault::DuplicateKey { key: name }));
        }
        entries.push((Key { span, name }, json_value(&property.value)?));
    }
    Ok(Value::Table(entries))
}
