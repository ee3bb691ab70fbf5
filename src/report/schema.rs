//! The schemas of what is written as a map of names, which serde does not know by itself.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator};

use super::{OptionalQuantiles, PointReport, Quantiles};

macro_rules! map {
    ($name:ident, $value:ty) => {
        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                BTreeMap::<String, $value>::json_schema(generator)
            }
        }
    };
}

map!(Quantiles, f64);
map!(OptionalQuantiles, Option<f64>);
map!(PointReport, f64);
