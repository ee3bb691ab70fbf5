//! CSV as it is written: cells and rows.

/// A table as it grows.
pub(super) struct Table {
    pub(super) text: String,
    /// What every row begins with.
    lead: String,
}

impl Table {
    pub(super) fn new(header: &str) -> Self {
        Self { text: format!("{header}\n"), lead: String::new() }
    }

    /// Rows from now on begin with this cell.
    pub(super) fn lead(&mut self, cell: String) {
        self.lead = cell + ",";
    }

    pub(super) fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.text += &self.lead;
        self.text += &cells.join(",");
        self.text.push('\n');
    }
}

pub(super) fn text(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

pub(super) fn optional(value: Option<&str>) -> String {
    value.map_or(String::new(), text)
}

/// The shortest decimals that are this double again.
pub(super) fn number(value: impl Into<Option<f64>>) -> String {
    match value.into() {
        Some(value) if value.is_finite() => {
            // Without the sign of a zero.
            let text = format!("{:?}", value + 0.0);
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
        _ => empty(),
    }
}

pub(super) fn truth(value: Option<bool>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

pub(super) fn empty() -> String {
    String::new()
}
