//! Names and texts from outside: the nearest known name, removal of hidden characters, shortening, and lists.

/// The first names of a list, and the number of the others.
///
/// ```
/// use sensitol_numeric::names::first_of;
/// let names = ["a", "b", "c"].map(str::to_owned);
/// assert_eq!(first_of(&names, 2), "a, b and 1 more");
/// assert_eq!(first_of(&names, 3), "a, b, c");
/// ```
pub fn first_of(names: &[String], most: usize) -> String {
    let named = names[..names.len().min(most)].join(", ");
    match names.len().saturating_sub(most) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// True for characters that are invisible and move the visible ones: control characters, and those that turn the direction of text (Unicode
/// 16, `Bidi_Control`).
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Replaces hidden characters by U+FFFD, so that the text stays on one line and cannot move the cursor or turn the direction.
pub fn clean(text: &str) -> String {
    text.chars().map(|c| if is_hidden(c) { '\u{fffd}' } else { c }).collect()
}

/// Greatest number of characters of a text from outside in a message: about twenty lines of a terminal.
const MESSAGE: usize = 1600;
/// Greatest number of letters of a name with a suggestion. A longer one is no slip of the hand, and comparing it takes the square of its
/// length.
const SUGGESTED: usize = 64;

/// Text from outside that enters a message: an answer of a program, a quoted line, a name. The middle of a long one is removed.
pub fn clipped(text: &str) -> String {
    shortened_to(text, MESSAGE)
}

/// Removes the middle of a text that is longer than `most` characters.
pub fn shortened_to(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let head: String = text.chars().take(most / 2).collect();
    let tail: String = text.chars().skip(count - (most - most / 2 - 1)).collect();
    format!("{head}…{tail}")
}

/// Suffixes that dimension names add to the name of the geometric element that they belong to.
pub(crate) const ELEMENT_PARTS: [&str; 20] = [
    ".unit", ".unit_x", ".unit_y", ".pin_x", ".pin_y", ".slot", // elements of a plane
    ".at", ".at_x", ".at_y", ".at_z", ".end1", ".end2", ".end1_x", ".end1_y", ".end2_x",
    ".end2_y", // features in space
    ".tilt", ".tilt_x", ".tilt_y", ".form",
];

/// Name of the geometric element that a dimension belongs to, or else the dimension's own name. For an element that is measured from
/// another it is the name in the study.
pub fn element(dimension: &str) -> &str {
    let outer = |name: &'_ str| ELEMENT_PARTS.iter().find_map(|part| name.strip_suffix(part).map(str::len));
    let Some(length) = outer(dimension) else { return dimension };
    let element = dimension[..length].strip_suffix(".own").unwrap_or(&dimension[..length]);
    // An end of an axis with a bonus has parts of its own.
    outer(element).map_or(element, |length| &element[..length])
}

/// Known name most similar to `typed`. Returns None if no name is similar enough.
///
/// Differences in case, and between `-` and `_`, do not count. A name of more than 64 letters is like no other.
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let short = |name: &str| name.chars().nth(SUGGESTED).is_none();
    if !short(typed) {
        return None;
    }
    let folded = |name: &str| name.to_lowercase().replace('_', "-");
    let typed = folded(typed);
    let likeness = |name: &str| {
        let name = folded(name);
        let slips = slips(&typed, &name);
        let edit = 1.0 - slips as f64 / typed.chars().count().max(name.chars().count()).max(1) as f64;
        // A prefix, such as `dist` for `distribution`, is probably meant even if much is missing, and so is a short name with one slip.
        let begun = typed.len() >= 3 && name.starts_with(&typed);
        let slip = typed.len() >= 2 && slips == 1;
        if begun || slip { edit.max(0.75) } else { edit }
    };
    let mut best = None;
    for name in known.into_iter().filter(|name| short(name)) {
        let score = likeness(name);
        if score >= 0.6 && best.is_none_or(|(highest, _)| score > highest) {
            best = Some((score, name));
        }
    }
    best.map(|(_, name)| name)
}

/// Smallest number of slips from one word to another (Damerau and Levenshtein). A slip is a letter too many, too few or wrong, or an
/// exchange of two neighbours.
fn slips(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    let most = from.len() + to.len();
    // `cost[i + 1][j + 1]` is the cost from the first `i` letters to the first `j`. The outermost row and column are never the cheapest.
    let mut cost = vec![vec![most; to.len() + 2]; from.len() + 2];
    (0..=from.len()).for_each(|i| cost[i + 1][1] = i);
    (0..=to.len()).for_each(|j| cost[1][j + 1] = j);
    for i in 1..=from.len() {
        // Last place in `to` of the letter of `from`.
        let mut column = 0;
        for j in 1..=to.len() {
            let (a, b) = (from[i - 1], to[j - 1]);
            // Last place in `from` of the letter of `to`.
            let row = from[..i - 1].iter().rposition(|&c| c == b).map_or(0, |at| at + 1);
            let exchanged = cost[row][column] + (i - row - 1) + 1 + (j - column - 1);
            let replaced = cost[i][j] + usize::from(a != b);
            cost[i + 1][j + 1] = replaced.min(cost[i + 1][j] + 1).min(cost[i][j + 1] + 1).min(exchanged);
            if a == b {
                column = j;
            }
        }
    }
    cost[from.len() + 1][to.len() + 1]
}

/// Name that is unknown in a list of things.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} `{}`; {}", clipped(name), self.help())]
#[non_exhaustive]
pub struct UnknownName {
    /// Kind of thing that the name should denote, such as `method`.
    pub what: &'static str,
    /// Name as typed.
    pub name: String,
    /// Most similar known name, if any is similar enough.
    pub nearest: Option<String>,
    /// Known names of this kind.
    pub known: Vec<&'static str>,
}

impl UnknownName {
    /// Finds the thing of this name among `all`.
    pub fn find<T: Copy>(
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

    /// Error for an unknown name, with the nearest known one.
    pub fn of(what: &'static str, name: &str, known: Vec<&'static str>) -> Self {
        let nearest = nearest(name, known.iter().copied()).map(str::to_owned);
        Self { what, name: name.to_owned(), nearest, known }
    }

    /// Name that was probably meant, or else all known names.
    pub fn help(&self) -> String {
        match &self.nearest {
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => format!("the names are {}", self.known.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MESSAGE, SUGGESTED, UnknownName, clipped, nearest, slips};

    #[test]
    fn a_name_is_meant_by_one_like_it() {
        assert_eq!(nearest("tolerence", ["nominal", "tolerance", "unit"]), Some("tolerance"));
        assert_eq!(nearest("zebra", ["nominal", "tolerance", "unit"]), None);
    }

    /// A name of a megabyte ends at once, and the message about it is short.
    #[test]
    fn a_long_name_has_no_suggestion() {
        let known = "n".repeat(SUGGESTED);
        assert_eq!(nearest(&known, [known.as_str()]), Some(known.as_str()));
        let typed = known.clone() + "n";
        assert_eq!(nearest(&typed, [known.as_str()]), None);
        assert_eq!(nearest(&known, [typed.as_str()]), None);
        let long = "n".repeat(1 << 20);
        assert_eq!(nearest(&long, ["nominal", long.as_str()]), None);
        let message = UnknownName::of("method", &long, vec!["six-n"]).to_string();
        assert!(message.chars().count() < MESSAGE + 100, "{}", message.len());
    }

    /// Beginning and end stay, whatever the letters.
    #[test]
    fn a_long_text_is_clipped() {
        assert_eq!(clipped("short"), "short");
        let text = format!("begin {} end", "\u{fc}".repeat(1 << 20));
        let said = clipped(&text);
        assert_eq!(said.chars().count(), MESSAGE);
        assert!(said.starts_with("begin ") && said.ends_with(" end"), "{said}");
        assert_eq!(clipped(&said), said);
    }

    /// Counts by hand.
    #[test]
    fn slips_are_counted() {
        for (from, to, count) in [
            ("", "", 0),
            ("", "gap", 3),
            ("sigma", "sigma", 0),
            ("sigma", "sigmas", 1),
            ("sigma", "sgima", 1),
            ("tolerence", "tolerance", 1),
            ("kitten", "sitting", 3),
            // Exchange of neighbours with a letter put between them.
            ("ca", "abc", 2),
            ("ab", "bca", 2),
        ] {
            assert_eq!((slips(from, to), slips(to, from)), (count, count), "{from} {to}");
        }
    }
}
