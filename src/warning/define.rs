//! Macro that turns the list of warnings into the enumeration, with all code that follows from the list alone.
//!
//! # A new warning
//! Add one entry to the list of `warning` (variant, code, fields), one function of these fields to the file of its theme, and one entry to
//! the page `docs/reference/warnings.md`. The compiler and the tests report a missing one. A field named `characteristic` or `output` is
//! the characteristic that the warning concerns. A field named `dimension`, or `dimensions` with one name, is its dimension. A field named
//! `others` takes the further dimensions when `aggregated` joins warnings of one code.

/// Defines the enumeration, and all code that follows from the list alone.
macro_rules! warnings {
    ($(
        $(#[$doc:meta])*
        $variant:ident = $code:literal by $theme:ident :: $text:ident $({
            $( $(#[$field_doc:meta])* $field:ident : $type:ty, )*
        })?;
    )*) => {
        /// Message on an event that a reader of the results must consider.
        ///
        /// It serialises as `{ code, characteristic, dimension, message, data, advice }`, with its fields in `data`.
        ///
        /// ```
        /// use sensitol::{Method, Warning};
        /// use sensitol::warning::Advice;
        /// let warning = Warning::PairsNotExamined { examined: 10, possible: 45 };
        /// assert_eq!(warning.code(), "pairs-not-examined");
        /// assert_eq!(warning.advice(), [Advice::UseMethod { methods: vec![Method::Full, Method::Auto] }]);
        /// let json = serde_json::to_value(&warning).unwrap();
        /// assert_eq!(json["data"]["possible"], 45);
        /// assert_eq!(json["advice"][0], serde_json::json!({ "action": "use-method", "methods": ["full", "auto"] }));
        /// ```
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub enum Warning {
            $( $(#[$doc])* $variant $({ $( $(#[$field_doc])* $field: $type, )* })?, )*
        }

        impl Warning {
            /// Codes of all warnings.
            pub const CODES: &[&str] = &[$($code),*];

            /// Code of this kind of warning, which does not change between versions.
            pub fn code(&self) -> &'static str {
                match self {
                    $( Self::$variant { .. } => $code, )*
                }
            }

            /// Fields by name. Numbers that are not finite become null.
            pub fn data(&self) -> impl serde::Serialize + '_ {
                crate::warning::serialisation::WarningData(self)
            }

            /// Characteristic that the warning concerns. Returns None if it concerns none or all.
            #[allow(unused_variables, unused_mut, unused_assignments, reason = "many variants have no such field")]
            pub fn characteristic(&self) -> Option<&str> {
                let mut found = None;
                match self {
                    $( Self::$variant { $($($field),*)? } => { $($( characteristic!($field $field found); )*)? } )*
                }
                found
            }

            /// Dimension that the warning concerns, the worst of several. Returns None if it concerns none or many alike.
            #[allow(unused_variables, unused_mut, unused_assignments, reason = "many variants have no such field")]
            pub fn dimension(&self) -> Option<&str> {
                let mut found = None;
                match self {
                    $( Self::$variant { $($($field),*)? } => { $($( dimension!($field $field found); )*)? } )*
                }
                found
            }

            /// Serialises every field with its name.
            fn fields<M: serde::ser::SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
                let _ = &map;
                match self {
                    $( Self::$variant { $($($field),*)? } => {
                        $($( map.serialize_entry(stringify!($field), $field)?; )*)?
                    } )*
                }
                Ok(())
            }

            fn text(&self) -> crate::warning::text::Text {
                match self {
                    $( Self::$variant { $($($field),*)? } => $theme::$text($($($field),*)?), )*
                }
            }
        }
    };
}

macro_rules! characteristic {
    (characteristic $name:ident $found:ident) => {
        $found = Some($name.as_str())
    };
    (output $name:ident $found:ident) => {
        $found = Some($name.as_str())
    };
    ($other:ident $name:ident $found:ident) => {};
}

macro_rules! dimension {
    (dimension $name:ident $found:ident) => {
        $found = Some($name.as_str())
    };
    (dimensions $names:ident $found:ident) => {
        if let [only] = &$names[..] {
            $found = Some(only.as_str())
        }
    };
    ($other:ident $name:ident $found:ident) => {};
}
