//! Facts about the entries of an assembly as written.

/// A feature or joint with the names that its numbers use.
#[derive(Debug, Clone)]
pub(crate) struct EntryUses {
    /// Full name, such as `housing.bore`, or that of a joint.
    pub(crate) name: String,
    /// Names of dimensions, constants and formulas.
    pub(crate) uses: Vec<String>,
}

/// Features and joints as written, before zones and floats are replaced.
#[derive(Debug, Clone, Default)]
pub(crate) struct AssemblyUses {
    pub(crate) features: Vec<EntryUses>,
    pub(crate) joints: Vec<EntryUses>,
    /// Patterns by their full names, such as `flange.patterns.bolts`, with the full names of their features.
    pub(crate) patterns: Vec<(String, Vec<String>)>,
}

/// Zone whose datums leave something free that it bounds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OpenZone {
    pub(crate) feature: String,
    pub(crate) zone: &'static str,
    pub(crate) datums: Vec<String>,
    pub(crate) open: Vec<String>,
}
