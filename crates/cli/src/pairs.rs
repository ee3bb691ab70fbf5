//! Value of `--pairs`: strongest, adjacent, or names.

use crate::failure::Failure;
use sensitol::method::Pairs;

/// Parses `strongest`, `adjacent` or `A:B,C:D`. Names with `:` or `,` are in backquotes.
pub(super) fn parse(text: &str) -> Result<Pairs, Failure> {
    if let Ok(named) = text.parse::<Pairs>() {
        return Ok(named);
    }
    let failed = |fault| Failure::Pairs { text: text.to_owned(), fault };
    let (mut names, mut name, mut quoted) = (vec![Vec::new()], String::new(), false);
    for c in text.chars() {
        match c {
            '`' => quoted = !quoted,
            ':' | ',' if !quoted => {
                names.last_mut().expect("never empty").push(std::mem::take(&mut name));
                if c == ',' {
                    names.push(Vec::new());
                }
            }
            c => name.push(c),
        }
    }
    if quoted {
        return Err(failed("a backquote is not closed"));
    }
    names.last_mut().expect("never empty").push(name);
    let pair = |names: Vec<String>| match <[String; 2]>::try_from(names) {
        Ok([a, b]) if !a.is_empty() && !b.is_empty() => Ok((a, b)),
        _ => Err(failed("write strongest, adjacent, or pairs of dimensions such as a:b,c:d")),
    };
    names.into_iter().map(pair).collect::<Result<_, _>>().map(Pairs::Listed)
}
