//! Names and texts of others: which known name did they mean, what of them is shown, and how much?

/// Whether a character is not seen and moves what is: control characters, and those that turn the direction of text (Unicode 16,
/// `Bidi_Control`).
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Text on one line that cannot move the cursor, turn or break the line: hidden characters become U+FFFD.
pub fn clean(text: &str) -> String {
    text.chars().map(|c| if is_hidden(c) { '\u{fffd}' } else { c }).collect()
}

/// Text without its middle, where it is longer than `most` characters.
pub fn shortened_to(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let head: String = text.chars().take(most / 2).collect();
    let tail: String = text.chars().skip(count - (most - most / 2 - 1)).collect();
    format!("{head}…{tail}")
}

/// The endings of the name of a geometric element in those of the dimensions that it is made of.
pub(crate) const ELEMENT_PARTS: [&str; 6] = [".unit", ".unit_x", ".unit_y", ".pin_x", ".pin_y", ".slot"];

/// The geometric element that a dimension is a part of; its own name where it is none. Of one that is measured from another, the name
/// that the study gives it.
pub fn element(dimension: &str) -> &str {
    match ELEMENT_PARTS.iter().find_map(|part| dimension.strip_suffix(part)) {
        Some(element) => element.strip_suffix(".own").unwrap_or(element),
        None => dimension,
    }
}

/// The known name most similar to `typed`, if any is similar enough to be meant.
///
/// Differences in case, and between `-` and `_`, count little.
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = |name: &str| name.to_lowercase().replace('_', "-");
    let typed = folded(typed);
    let likeness = |name: &str| {
        let name = folded(name);
        let slips = slips(&typed, &name);
        let edit = 1.0 - slips as f64 / typed.chars().count().max(name.chars().count()).max(1) as f64;
        // A beginning, such as `dist` for `distribution`, is meant even where much is missing, and so is a short name
        // with one slip.
        let begun = typed.len() >= 3 && name.starts_with(&typed);
        let slip = typed.len() >= 2 && slips == 1;
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

/// The fewest slips from one word to another, each a letter too many, too few or wrong, or two neighbours exchanged (Damerau and
/// Levenshtein).
fn slips(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    let most = from.len() + to.len();
    // `cost[i + 1][j + 1]`: from the first `i` letters to the first `j`; the outermost row and column are never the cheapest.
    let mut cost = vec![vec![most; to.len() + 2]; from.len() + 2];
    (0..=from.len()).for_each(|i| cost[i + 1][1] = i);
    (0..=to.len()).for_each(|j| cost[1][j + 1] = j);
    for i in 1..=from.len() {
        // Where the letter of `from` was last seen in `to`.
        let mut column = 0;
        for j in 1..=to.len() {
            let (a, b) = (from[i - 1], to[j - 1]);
            // Where the letter of `to` was last seen in `from`.
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

/// A name that stands for none of a list of things.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} `{name}`; {}", self.help())]
pub struct UnknownName {
    /// The kind of thing that the name should stand for, such as `method`.
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

    pub fn of(what: &'static str, name: &str, known: Vec<&'static str>) -> Self {
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

#[cfg(test)]
mod tests {
    use super::{nearest, slips};

    #[test]
    fn a_name_is_meant_by_one_like_it() {
        assert_eq!(nearest("tolerence", ["nominal", "tolerance", "unit"]), Some("tolerance"));
        assert_eq!(nearest("zebra", ["nominal", "tolerance", "unit"]), None);
    }

    /// Counted by hand.
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
            // An exchange of neighbours with a letter put between them.
            ("ca", "abc", 2),
            ("ab", "bca", 2),
        ] {
            assert_eq!((slips(from, to), slips(to, from)), (count, count), "{from} {to}");
        }
    }
}
