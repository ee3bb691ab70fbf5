//! Lines and tables without lines, in Unicode or plain ASCII.

use comfy_table::{CellAlignment, Table};

/// How much is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// The strongest contributions.
    Short,
    /// Everything.
    Full,
}

/// How a text report looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// How much is shown.
    pub detail: Detail,
    /// Whether signs such as ± may be used.
    pub unicode: bool,
    /// Whether verdicts are coloured.
    pub color: bool,
    /// No line is longer, if that can be.
    pub width: usize,
}

impl Style {
    /// The width of what is written to no terminal.
    pub const WIDTH: usize = 100;
}

/// Escape sequences of good, doubtful and bad, and what ends them.
const GREEN: &str = "\u{1b}[32m";
const YELLOW: &str = "\u{1b}[33m";
const RED: &str = "\u{1b}[1;31m";
const PLAIN: &str = "\u{1b}[0m";
/// Words that tell whether what was wanted is so, anywhere in a report.
const VERDICTS: [(&str, &str); 5] = [
    ("met", GREEN),
    ("within the limits", GREEN),
    ("MISSED", RED),
    ("EXCEEDS the limits", RED),
    ("inconclusive", YELLOW),
];
/// How an allocation ended, before a colon at the beginning of its line.
const STATUSES: [(&str, &str); 4] =
    [("optimal", GREEN), ("almost-optimal", YELLOW), ("out-of-time", YELLOW), ("infeasible", RED)];

/// Before every column.
const GAP: usize = 2;
/// Names longer than this are shortened in their middle, to no less than `SHORTEST` where a table would be too wide.
const NAME: usize = 30;
const SHORTEST: usize = 8;
/// Signs of the report, and what stands for them in ASCII.
const ASCII: [(char, &str); 3] = [('±', "+-"), ('×', "x"), ('…', "~")];

/// A text report as it grows.
pub(super) struct Page {
    text: String,
    style: Style,
}

impl Page {
    pub(super) fn new(style: Style) -> Self {
        Self { text: String::new(), style }
    }

    pub(super) fn style(&self) -> Style {
        self.style
    }

    pub(super) fn finish(self) -> String {
        if self.style.color { self.text.lines().map(|line| coloured(line) + "\n").collect() } else { self.text }
    }

    /// A line; on a narrow page what is too long for it goes on in the next one.
    pub(super) fn line(&mut self, text: &str) {
        let mut rest = self.signs(text).trim_end().to_owned();
        let width = self.style.width;
        while width < Style::WIDTH && rest.chars().count() > width {
            let letters: Vec<char> = rest.chars().collect();
            let words = letters.iter().take_while(|&&letter| letter == ' ').count();
            let Some(space) = (words + 1..=width).rev().find(|&at| letters[at] == ' ') else { break };
            let [line, more] = [&letters[..space], &letters[space..]].map(|part| part.iter().collect::<String>());
            self.verbatim(line.trim_end());
            rest = format!("    {}", more.trim_start());
        }
        self.verbatim(&rest);
    }

    /// A line that stays as it is, however long.
    pub(super) fn verbatim(&mut self, text: &str) {
        self.text += text;
        self.text.push('\n');
    }

    /// A text that may take several lines, those after the first indented by four; a percent sign stays with its number.
    pub(super) fn wrapped(&mut self, text: &str) {
        let indent = text.len() - text.trim_start().len();
        let mut line = " ".repeat(indent);
        let text = self.signs(text).replace(" %", "\u{a0}%");
        for word in text.split([' ', '\n']).filter(|word| !word.is_empty()) {
            if line.trim().is_empty() {
                line += word;
            } else if line.chars().count() + 1 + word.chars().count() <= self.style.width {
                line = line + " " + word;
            } else {
                self.line(&line.replace('\u{a0}', " "));
                line = format!("    {word}");
            }
        }
        self.line(&line.replace('\u{a0}', " "));
    }

    /// Prints a table that is indented by two and no wider than the page: names, in the first column, give way, and columns
    /// that have no room stand in a table of their own below, with the names again.
    pub(super) fn print<const N: usize>(&mut self, table: &Grid<N>) {
        let mut widths = [0; N];
        for row in table.rows.iter().chain([&table.titles.map(str::to_owned)]) {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(self.signs(cell).chars().count());
            }
        }
        let least = widths[0].min(SHORTEST) + GAP;
        let (mut columns, mut taken) = (vec![0], least);
        for (column, width) in widths.iter().enumerate().skip(1) {
            if taken + width + GAP > self.style.width && columns.len() > 1 {
                self.part(table, &columns, &widths);
                (columns, taken) = (vec![0], least);
            }
            columns.push(column);
            taken += width + GAP;
        }
        self.part(table, &columns, &widths);
    }

    /// Some columns of a table.
    fn part<const N: usize>(&mut self, table: &Grid<N>, columns: &[usize], widths: &[usize; N]) {
        let total: usize = columns.iter().map(|&column| widths[column] + GAP).sum();
        let name = widths[0].saturating_sub(total.saturating_sub(self.style.width)).max(SHORTEST);
        let mut printed = Table::new();
        printed.load_style(comfy_table::presets::NOTHING);
        printed.set_header(columns.iter().map(|&column| self.signs(table.titles[column])));
        for row in &table.rows {
            let cell =
                |&column: &usize| self.signs(&if column == 0 { shortened(&row[0], name) } else { row[column].clone() });
            printed.add_row(columns.iter().map(cell));
        }
        let alignments = columns.iter().filter_map(|&column| table.alignment.chars().nth(column));
        for (column, alignment) in printed.column_iter_mut().zip(alignments) {
            column.set_padding((GAP as u16, 0));
            if alignment == '>' {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        for line in printed.lines().filter(|line| !line.trim().is_empty()) {
            self.text += line.trim_end();
            self.text.push('\n');
        }
    }

    fn signs(&self, text: &str) -> String {
        if self.style.unicode {
            return text.to_owned();
        }
        ASCII.iter().fold(text.to_owned(), |text, (sign, plain)| text.replace(*sign, plain))
    }
}

/// Rows of a table, and how its columns are aligned: left (`<`) or right (`>`).
pub(super) struct Grid<const N: usize> {
    titles: [&'static str; N],
    alignment: &'static str,
    rows: Vec<[String; N]>,
}

impl<const N: usize> Grid<N> {
    /// All empty titles make a table without header.
    pub(super) fn new(titles: [&'static str; N], alignment: &'static str) -> Self {
        Self { titles, alignment, rows: Vec::new() }
    }

    pub(super) fn row(&mut self, cells: [String; N]) {
        self.rows.push(cells);
    }
}

/// A line with its verdicts in colour: at the end, as escape sequences have no width.
fn coloured(line: &str) -> String {
    for (status, color) in STATUSES {
        if let Some(rest) = line.strip_prefix(status).filter(|rest| rest.starts_with(':')) {
            return format!("{color}{status}{PLAIN}{rest}");
        }
    }
    VERDICTS.iter().fold(line.to_owned(), |line, (verdict, color)| {
        let (mut text, mut rest) = (String::new(), line.as_str());
        while let Some(at) = rest.find(verdict) {
            let (before, after) = (&rest[..at], &rest[at + verdict.len()..]);
            let inside = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
            let word = !inside(before.chars().next_back()) && !inside(after.chars().next());
            text += before;
            text += &if word { format!("{color}{verdict}{PLAIN}") } else { (*verdict).to_owned() };
            rest = after;
        }
        text + rest
    })
}

/// A name on one line that does not push everything else off it.
pub(super) fn short(name: &str) -> String {
    shortened(&clean(name), NAME)
}

/// Without its middle, where it is longer than `most` characters.
fn shortened(name: &str, most: usize) -> String {
    let count = name.chars().count();
    if count <= most {
        return name.to_owned();
    }
    let head: String = name.chars().take(most / 2).collect();
    let tail: String = name.chars().skip(count - (most - most / 2 - 1)).collect();
    format!("{head}…{tail}")
}

/// What came from a file cannot move the cursor or break a line.
pub(super) fn clean(text: &str) -> String {
    crate::names::clean(text)
}
