//! Names that people type: which known one did they mean?

/// Whether a character is not seen and moves what is: control characters, and those that turn the direction of text (Unicode 16,
/// `Bidi_Control`).
pub(crate) fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Text on one line that cannot move the cursor, turn or break the line: hidden characters become U+FFFD.
pub(crate) fn clean(text: &str) -> String {
    text.chars().map(|c| if is_hidden(c) { '\u{fffd}' } else { c }).collect()
}

/// The known name most similar to `typed`, if any is similar enough to be meant.
///
/// Differences in case, and between `-` and `_`, count little.
///
/// ```
/// use sensitol::names::nearest;
/// assert_eq!(nearest("tolerence", ["nominal", "tolerance", "unit"]), Some("tolerance"));
/// assert_eq!(nearest("zebra", ["nominal", "tolerance", "unit"]), None);
/// ```
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = |name: &str| name.to_lowercase().replace('_', "-");
    let typed = folded(typed);
    let likeness = |name: &str| {
        let name = folded(name);
        let edit = strsim::normalized_damerau_levenshtein(&typed, &name);
        // A beginning, such as `dist` for `distribution`, is meant even where much is missing, and so is a short name
        // with one slip.
        let begun = typed.len() >= 3 && name.starts_with(&typed);
        let slip = typed.len() >= 2 && strsim::damerau_levenshtein(&typed, &name) == 1;
        if begun || slip { edit.max(0.75) } else { edit }
    };
    let mut best = None;
    for name in known {
        let score = likeness(name);
        if score >= 0.6 && best.is_none_or(|(highest, _)| score > highest) {
            best = Some((score, name));
        }
    }
    best.map(|(_, name)| name)
}

/// A name that stands for none of a list of things.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} `{name}`; {}", self.help())]
pub struct UnknownName {
    /// What the name should stand for, such as `method`.
    pub what: &'static str,
    /// The name as typed.
    pub name: String,
    /// The most similar known name.
    pub nearest: Option<String>,
    /// The known names.
    pub known: Vec<&'static str>,
}

impl UnknownName {
    /// The thing of this name among `all`.
    pub(crate) fn find<T: Copy>(
        what: &'static str,
        name: &str,
        all: &[T],
        name_of: impl Fn(&T) -> &'static str,
    ) -> Result<T, Self> {
        match all.iter().find(|one| name_of(one) == name) {
            Some(one) => Ok(*one),
            None => Err(Self::of(what, name, all.iter().map(name_of).collect())),
        }
    }

    pub(crate) fn of(what: &'static str, name: &str, known: Vec<&'static str>) -> Self {
        let nearest = nearest(name, known.iter().copied()).map(str::to_owned);
        Self { what, name: name.to_owned(), nearest, known }
    }

    /// The name that was probably meant, or all that there are.
    pub fn help(&self) -> String {
        match &self.nearest {
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => format!("the names are {}", self.known.join(", ")),
        }
    }
}
