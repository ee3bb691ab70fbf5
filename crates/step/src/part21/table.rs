//! Places of all entities of a file.

use std::collections::HashMap;

use super::entity::Entity;
use super::error::{Part21Error, Part21Fault};
use super::scan::{Cursor, line};

/// First line of every file.
const MAGIC: &str = "ISO-10303-21";
/// Last line of every file.
const END: &str = "END-ISO-10303-21";

/// Place and type of an entity.
#[derive(Debug, Clone, Copy)]
struct Record {
    id: u64,
    /// Place after `=`.
    start: u32,
    /// Index of the combination of types.
    kinds: u32,
}

/// Entities of a Part 21 file, by their numbers and by their types.
///
/// # Cost
/// One pass over the text and 16 bytes an entity. Arguments are parsed when they are requested.
#[derive(Debug)]
pub struct EntityTable<'a> {
    bytes: &'a [u8],
    /// Sorted by number.
    records: Vec<Record>,
    /// Names of types.
    names: Vec<String>,
    /// Combinations of types that an entity has: one, or those of a complex entity.
    combinations: Vec<Vec<u32>>,
    /// Indices of records by the index of a type.
    members: Vec<Vec<u32>>,
}

/// Types found so far.
#[derive(Default)]
struct Types<'a> {
    names: HashMap<&'a str, u32>,
    combinations: HashMap<Vec<u32>, u32>,
    /// Last type and its combination: files list entities by type.
    last: Option<(&'a str, u32)>,
}

impl<'a> Types<'a> {
    fn name(&mut self, name: &'a str) -> u32 {
        let next = self.names.len() as u32;
        *self.names.entry(name).or_insert(next)
    }

    fn combination(&mut self, kinds: Vec<u32>) -> u32 {
        let next = self.combinations.len() as u32;
        *self.combinations.entry(kinds).or_insert(next)
    }

    fn simple(&mut self, name: &'a str) -> u32 {
        if let Some((last, combination)) = self.last
            && last == name
        {
            return combination;
        }
        let kind = self.name(name);
        let combination = self.combination(vec![kind]);
        self.last = Some((name, combination));
        combination
    }
}

impl<'a> EntityTable<'a> {
    /// Reads the places of all entities.
    ///
    /// # Errors
    /// If the bytes are no Part 21 file, are compressed, end early, or are damaged.
    pub fn read(bytes: &'a [u8]) -> Result<Self, Part21Error> {
        let whole = |fault| Part21Error { line: None, fault };
        if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(&[0x1f, 0x8b]) {
            return Err(whole(Part21Fault::Compressed));
        }
        if u32::try_from(bytes.len()).is_err() {
            return Err(whole(Part21Fault::TooLarge));
        }
        let start = if bytes.starts_with(&[0xEF, 0xBB, 0xBF]) { 3 } else { 0 };
        let mut cursor = Cursor::new(bytes, start);
        let begins = cursor.skip_space().is_ok() && cursor.continues(MAGIC);
        if !begins {
            // A part of the first line is the beginning of a file that was cut off.
            let rest = &bytes[cursor.at.min(bytes.len())..];
            let cut = !rest.is_empty() && MAGIC.as_bytes().starts_with(rest);
            return Err(whole(if cut { Part21Fault::CutOff } else { Part21Fault::NotPart21 }));
        }
        cursor.skip_statement()?;
        let mut types = Types::default();
        let mut records = Vec::new();
        sections(&mut cursor, &mut types, &mut records).map_err(|error| cut_off(bytes, error))?;
        if !records.is_sorted_by_key(|record: &Record| record.id) {
            records.sort_by_key(|record| record.id);
        }
        if let Some(pair) = records.windows(2).find(|pair| pair[0].id == pair[1].id) {
            let at = Some(line(bytes, pair[1].start as usize));
            return Err(Part21Error { line: at, fault: Part21Fault::Twice(pair[0].id) });
        }
        Ok(Self::with(bytes, records, types))
    }

    fn with(bytes: &'a [u8], records: Vec<Record>, types: Types<'a>) -> Self {
        let mut names = vec![String::new(); types.names.len()];
        types.names.into_iter().for_each(|(name, index)| names[index as usize] = name.to_ascii_uppercase());
        let mut combinations = vec![Vec::new(); types.combinations.len()];
        types.combinations.into_iter().for_each(|(kinds, index)| combinations[index as usize] = kinds);
        let mut members = vec![Vec::new(); names.len()];
        for (index, record) in records.iter().enumerate() {
            for &kind in &combinations[record.kinds as usize] {
                members[kind as usize].push(index as u32);
            }
        }
        Self { bytes, records, names, combinations, members }
    }

    /// Number of entities.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// True if the file has no entity.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Entity of this number. Returns None if there is none.
    pub fn get(&self, id: u64) -> Option<Entity<'_>> {
        let first = self.records.first()?.id;
        // Greatest number of files number their entities without gaps.
        let guess = usize::try_from(id.checked_sub(first)?).ok()?;
        let record = match self.records.get(guess) {
            Some(record) if record.id == id => record,
            _ => &self.records[self.records.binary_search_by_key(&id, |record| record.id).ok()?],
        };
        Some(self.entity(record))
    }

    /// Entity to which `from` refers.
    ///
    /// # Errors
    /// If the file does not contain it.
    pub fn referred(&self, from: u64, to: u64) -> Result<Entity<'_>, Part21Error> {
        self.get(to).ok_or_else(|| {
            let line = self.get(from).map(|entity| entity.line());
            Part21Error { line, fault: Part21Fault::Dangling { from, to } }
        })
    }

    /// Entities of a type, in the order of their numbers. Entities with several types are in the list of each.
    pub fn of_kind(&self, kind: &str) -> impl Iterator<Item = Entity<'_>> {
        let members = self.names.iter().position(|name| name == kind).map_or(&[][..], |at| &self.members[at]);
        members.iter().map(|&index| self.entity(&self.records[index as usize]))
    }

    /// Number of entities of a type.
    pub fn count(&self, kind: &str) -> usize {
        self.names.iter().position(|name| name == kind).map_or(0, |at| self.members[at].len())
    }

    fn entity(&self, record: &Record) -> Entity<'_> {
        let kinds = &self.combinations[record.kinds as usize];
        Entity { bytes: self.bytes, names: &self.names, kinds, id: record.id, start: record.start }
    }
}

/// Fault of a file that was cut off in the middle of a word, in place of the fault of the rest of the word.
fn cut_off(bytes: &[u8], error: Part21Error) -> Part21Error {
    let has_end = bytes.windows(END.len()).rev().any(|window| window == END.as_bytes());
    match error.fault {
        Part21Fault::Syntax { .. } if !has_end && error.line == Some(line(bytes, bytes.len())) => {
            Part21Error { fault: Part21Fault::CutOff, ..error }
        }
        _ => error,
    }
}

/// Reads all sections until the end of the file.
fn sections<'a>(cursor: &mut Cursor<'a>, types: &mut Types<'a>, records: &mut Vec<Record>) -> Result<(), Part21Error> {
    loop {
        cursor.skip_space()?;
        if cursor.continues(END) {
            return Ok(());
        }
        let start = cursor.clone();
        match cursor.keyword() {
            "HEADER" => {
                cursor.skip_statement()?;
                loop {
                    cursor.skip_space()?;
                    if cursor.peek().is_none() {
                        return Err(cursor.error(Part21Fault::CutOff));
                    }
                    let ends = cursor.continues("ENDSEC");
                    cursor.skip_statement()?;
                    if ends {
                        break;
                    }
                }
            }
            "DATA" => {
                cursor.skip_statement()?;
                entities(cursor, types, records)?;
            }
            name @ ("ANCHOR" | "REFERENCE") => {
                return Err(start.error(Part21Fault::Section(name.to_owned())));
            }
            "SIGNATURE" => cursor.skip_statement()?,
            _ => return Err(start.syntax("a section HEADER or DATA")),
        }
    }
}

/// Reads the entities of a section, and its end.
fn entities<'a>(cursor: &mut Cursor<'a>, types: &mut Types<'a>, records: &mut Vec<Record>) -> Result<(), Part21Error> {
    loop {
        cursor.skip_space()?;
        if cursor.peek() != Some(b'#') {
            if !cursor.continues("ENDSEC") {
                return Err(cursor.syntax("an entity such as #1=POINT()"));
            }
            return cursor.skip_statement();
        }
        let id = cursor.number_of_entity()?;
        cursor.expect(b'=', "`=` after the number of an entity")?;
        cursor.skip_space()?;
        // OK because the length of the file fits.
        let start = cursor.at as u32;
        let kinds = if cursor.peek() == Some(b'(') {
            cursor.advance(1);
            complex(cursor, types)?
        } else {
            let name = cursor.keyword();
            cursor.skip_space()?;
            if name.is_empty() || cursor.peek() != Some(b'(') {
                return Err(cursor.syntax("the type of an entity and `(`"));
            }
            types.simple(name)
        };
        cursor.skip_statement()?;
        records.push(Record { id, start, kinds });
    }
}

/// Reads the types of a complex entity until its closing parenthesis.
fn complex<'a>(cursor: &mut Cursor<'a>, types: &mut Types<'a>) -> Result<u32, Part21Error> {
    let mut kinds = Vec::new();
    loop {
        cursor.skip_space()?;
        if cursor.peek() == Some(b')') {
            cursor.advance(1);
            return Ok(types.combination(kinds));
        }
        let name = cursor.keyword();
        cursor.skip_space()?;
        if name.is_empty() || cursor.peek() != Some(b'(') {
            return Err(cursor.syntax("the type of an entity and `(`"));
        }
        cursor.skip_list()?;
        let kind = types.name(name);
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
}
