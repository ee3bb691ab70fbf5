//! View of an entity, whose arguments are parsed when they are requested.

use super::error::Part21Error;
use super::scan::{Cursor, line};
use super::value::{StepValue, arguments};

/// An entity of a Part 21 file.
#[derive(Debug, Clone, Copy)]
pub struct Entity<'a> {
    pub(super) bytes: &'a [u8],
    /// Names of all types of the file.
    pub(super) names: &'a [String],
    /// Indices of the types of the entity.
    pub(super) kinds: &'a [u32],
    pub(super) id: u64,
    /// Place after `=`.
    pub(super) start: u32,
}

impl<'a> Entity<'a> {
    /// Number of the entity.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Line of the entity in the file, from 1.
    ///
    /// # Cost
    /// A pass over the text before it.
    pub fn line(&self) -> usize {
        line(self.bytes, self.start as usize)
    }

    /// Names of the types: one, or those of a complex entity in the order of the file.
    pub fn kinds(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let names = self.names;
        self.kinds.iter().map(move |&kind| names[kind as usize].as_str())
    }

    /// Names of the types, joined by `+`.
    pub fn kind_text(&self) -> String {
        self.kinds().collect::<Vec<_>>().join("+")
    }

    /// True if the entity has this type. Supertypes count only if the file names them.
    pub fn is(&self, kind: &str) -> bool {
        self.kinds().any(|name| name == kind)
    }

    /// First of the types that the entity has. Returns None if it has none of them.
    pub fn first_of<'k>(&self, kinds: &[&'k str]) -> Option<&'k str> {
        kinds.iter().find(|kind| self.is(kind)).copied()
    }

    /// Arguments of every type, in the order of the file.
    ///
    /// # Errors
    /// If the text is damaged.
    pub fn all(&self) -> Result<Vec<(&'a str, Vec<StepValue<'a>>)>, Part21Error> {
        let mut cursor = Cursor::new(self.bytes, self.start as usize);
        let is_complex = cursor.peek() == Some(b'(');
        if is_complex {
            cursor.advance(1);
        }
        let mut found = Vec::new();
        loop {
            cursor.skip_space()?;
            if is_complex && cursor.peek() == Some(b')') {
                return Ok(found);
            }
            let name = cursor.keyword();
            cursor.skip_space()?;
            found.push((name, arguments(&mut cursor, self.id)?));
            if !is_complex {
                return Ok(found);
            }
        }
    }

    /// Arguments of a type. Returns None if the entity does not have it.
    ///
    /// # Errors
    /// If the text is damaged.
    pub fn arguments(&self, kind: &str) -> Result<Option<Vec<StepValue<'a>>>, Part21Error> {
        if !self.is(kind) {
            return Ok(None);
        }
        Ok(self.all()?.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(kind)).map(|(_, arguments)| arguments))
    }

    /// Arguments of a supertype in a complex entity, or those of the only type of a simple one, which begin with the supertype's.
    ///
    /// # Errors
    /// If the text is damaged.
    pub fn inherited(&self, supertype: &str) -> Result<Vec<StepValue<'a>>, Part21Error> {
        let mut all = self.all()?;
        let at = all.iter().position(|(name, _)| name.eq_ignore_ascii_case(supertype));
        Ok(match (at, all.len()) {
            (Some(at), _) => all.swap_remove(at).1,
            (None, 1) => all.swap_remove(0).1,
            (None, _) => Vec::new(),
        })
    }
}
