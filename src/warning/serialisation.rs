//! Serialisation of a warning: its code, characteristic, dimension, text and fields.

use serde::ser::{SerializeMap, SerializeStruct};
use serde::{Serialize, Serializer};

use crate::warning::text::Text;
use crate::warning::{Advice, Warning};

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Text { message, advice } = self.text();
        let mut shape = serializer.serialize_struct("Warning", 6)?;
        shape.serialize_field("code", self.code())?;
        shape.serialize_field("characteristic", &self.characteristic())?;
        shape.serialize_field("dimension", &self.dimension())?;
        shape.serialize_field("message", &message)?;
        shape.serialize_field("data", &self.data())?;
        shape.serialize_field("advice", &advice)?;
        shape.end()
    }
}

/// Fields of a warning by name. Serialises as a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct WarningData<'a>(pub(super) &'a Warning);

impl Serialize for WarningData<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        self.0.fields(&mut map)?;
        map.end()
    }
}

impl Warning {
    /// Event, and its meaning for the result, in sentences. The text names no option of any front end.
    pub fn message(&self) -> String {
        self.text().message
    }

    /// Actions to take, the most promising first. Empty if there are none.
    pub fn advice(&self) -> Vec<Advice> {
        self.text().advice
    }
}
