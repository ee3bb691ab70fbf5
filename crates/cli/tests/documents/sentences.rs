//! Plain sentences of pages that are written by hand: their length, and words that data cannot do.

use super::docs::pages;
use sensitol_testing::read;

/// Most words of a sentence. A source in parentheses and a piece of code count as one word or none.
const MOST_WORDS: usize = 25;

/// Returns the paragraphs and items of a page as single lines, without code, tables, headings, pictures and comments.
fn paragraphs(page: &str) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut code = false;
    let mut comment = false;
    for line in page.lines().map(str::trim) {
        code ^= line.starts_with("```");
        comment |= line.starts_with("<!--");
        let item = line
            .split_once(' ')
            .is_some_and(|(mark, _)| mark == "-" || mark.trim_end_matches('.').parse::<u32>().is_ok());
        let left_out = code || comment || line.starts_with("```") || line.starts_with(['#', '|', '!']);
        if left_out || line.is_empty() || item {
            found.push(String::new());
        }
        if !left_out {
            let last = found.last_mut().unwrap();
            *last += line.strip_prefix("- ").unwrap_or(line);
            last.push(' ');
        }
        comment &= !line.ends_with("-->");
    }
    found
}

/// Replaces pieces of code by a word, and removes targets of links and texts in parentheses.
fn plain(text: &str) -> String {
    let mut words = String::new();
    for (index, part) in text.split('`').enumerate() {
        words += if index % 2 == 0 { part } else { "code" };
    }
    let mut depth = 0_usize;
    words
        .chars()
        .filter(|&sign| {
            depth += usize::from(sign == '(');
            let kept = depth == 0;
            depth -= usize::from(sign == ')' && depth > 0);
            kept
        })
        .collect()
}

/// Returns the sentences of more words than allowed. A colon ends a sentence too: a list or an example follows.
fn long(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    for paragraph in paragraphs(page) {
        let mut sentence: Vec<&str> = Vec::new();
        let text = plain(&paragraph);
        for word in text.split_whitespace() {
            sentence.push(word);
            if word.trim_end_matches(['*', ']', '"']).ends_with(['.', '?', '!', ':']) {
                if sentence.len() > MOST_WORDS {
                    found.push(sentence.join(" "));
                }
                sentence.clear();
            }
        }
        if sentence.len() > MOST_WORDS {
            found.push(sentence.join(" "));
        }
    }
    found
}

/// Words that give data the mind of a person, or that need a second reading. Terms of the glossary take their place.
const REJECTED: [&str; 9] = ["knows", "sees", "wants", "buys", "bought", "believes", "nobody", "somebody", "haven"];

#[test]
fn data_of_pages_are_not_persons() {
    let mut wrong = Vec::new();
    for page in ["docs", "docs/how-to"].into_iter().flat_map(pages) {
        for paragraph in paragraphs(&read(&page)) {
            let text = plain(&paragraph).to_lowercase();
            let found =
                text.split_whitespace().find(|word| REJECTED.contains(&word.trim_end_matches(['.', ',', ':', ';'])));
            wrong.extend(found.map(|word| format!("{page}: {word}: {text}")));
            if text.contains(" is no ") && !text.contains("here is no ")
                || text.starts_with("what ") && !text.contains('?')
            {
                wrong.push(format!("{page}: {text}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn sentences_of_pages_are_short() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for page in ["docs", "docs/how-to"].into_iter().flat_map(pages) {
        seen += 1;
        wrong.extend(long(&read(&page)).into_iter().map(|sentence| format!("{page}: {sentence}")));
    }
    wrong.extend(long(&read("docs/reference/warnings.md")).into_iter().map(|sentence| format!("warnings: {sentence}")));
    assert!(seen > 30, "{seen} pages");
    assert!(wrong.is_empty(), "more than {MOST_WORDS} words: {wrong:#?}");
}

#[test]
fn long_sentences_are_found() {
    let words = |count: usize| vec!["word"; count].join(" ");
    let page = format!(
        "# {0}\n\n| {0} |\n\n- {1}.\n- {0}. Short.\n\n```text\n{0}\n```\n\n{1} ({0}) `{0}`.\n",
        words(30),
        words(24)
    );
    assert_eq!(long(&page), [format!("{}.", words(30))]);
}
