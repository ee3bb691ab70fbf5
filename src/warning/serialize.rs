//! Serialisation of results with their warnings as the last key.

/// Serialises a result by the function that serde derives for its own fields, and its warnings last.
macro_rules! warnings_last {
    ($result:ty) => {
        impl serde::Serialize for $result {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                #[derive(serde::Serialize)]
                struct Whole<'r, W> {
                    #[serde(flatten, serialize_with = "own")]
                    own: &'r $result,
                    warnings: &'r [W],
                }
                fn own<S: serde::Serializer>(result: &&$result, serializer: S) -> Result<S::Ok, S::Error> {
                    <$result>::serialize(result, serializer)
                }
                serde::Serialize::serialize(&Whole { own: self, warnings: &self.warnings }, serializer)
            }
        }
    };
}
pub(crate) use warnings_last;
