//! Documents as text for a terminal, with tables without rules, in Unicode or plain ASCII.

use crate::document::sketch::{bars, sketch};
use crate::document::{Chart, DataTable, Document, Element, Flow, Line, List, Paragraph, Section, Tone};
use sensitol_numeric::names::{clean, shortened_to};

/// Amount of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Table of all results, without sections.
    Summary,
    /// Short sections, with the strongest contributions.
    Short,
    /// Everything.
    Full,
}

/// Style of a text report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Amount of detail.
    pub detail: Detail,
    /// True if signs such as ± may be used.
    pub unicode: bool,
    /// True if verdicts are coloured.
    pub color: bool,
    /// Greatest length of a line if it can be broken.
    pub width: usize,
}

impl Style {
    /// Width of text that is not written to a terminal.
    pub const WIDTH: usize = 80;
}

/// Spaces before every column.
const GAP: usize = 2;
/// Least length to which a name in the first column is shortened if a table is too wide.
const SHORTEST: usize = 8;
/// Greatest width that the column of labels keeps if a table is too wide. A longer label stands on a line of its own.
const LABEL: usize = 20;
/// Greatest number of lines of a list unless everything is shown.
const LINES: usize = 3;
/// Space for "and N more" in the last line of a list.
const MORE: usize = 20;
/// Signs of the report with their replacement in ASCII.
const ASCII: [(char, &str); 5] = [('±', "+-"), ('×', "x"), ('…', "~"), ('●', "*"), ('█', "#")];

/// Returns the escape sequence of a tone, or None if it has no colour.
fn escape(tone: Tone) -> Option<&'static str> {
    match tone {
        Tone::Plain => None,
        Tone::Good => Some("\u{1b}[32m"),
        Tone::Doubtful => Some("\u{1b}[33m"),
        Tone::Bad => Some("\u{1b}[1;31m"),
    }
}

/// Formats a document as text.
pub fn text(document: &Document, style: Style) -> String {
    let mut page = Page { text: String::new(), style, title: 0 };
    if let Some(title) = &document.title {
        page.folded(&title.as_str().into());
    }
    document.head.iter().for_each(|block| page.block(block));
    let sections = document.sections.iter().filter(|_| style.detail != Detail::Summary);
    for (index, section) in sections.enumerate() {
        if index > 0 || !page.text.is_empty() {
            page.gap();
        }
        page.section(section);
    }
    page.text
}

/// Formats a line that is never broken, as the last one of a report.
pub(crate) fn unbroken(line: &Line, style: Style) -> String {
    let mut page = Page { text: String::new(), style, title: 0 };
    let letters = page.letters(line);
    page.put(&letters);
    page.text
}

/// Letter with its tone.
type Letter = (char, Tone);

/// Shape of a table's columns.
struct TableShape {
    /// Width of the widest cell.
    widths: Vec<usize>,
    /// Least width as the first column.
    least: Vec<usize>,
    /// True for numbers, which are right-aligned.
    right: Vec<bool>,
    /// True for names of the study, which may be shortened.
    named: Vec<bool>,
}

struct Page {
    text: String,
    style: Style,
    /// Length of the text up to the title of the last section.
    title: usize,
}

impl Page {
    fn section(&mut self, section: &Section) {
        if !section.name.is_empty() {
            let unit = section.unit.as_deref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
            self.folded(&format!("{}{unit}{}", section.name, section.words).into());
        }
        self.title = self.text.len();
        section.blocks.iter().for_each(|block| self.block(block));
    }

    fn block(&mut self, block: &Element) {
        match block {
            Element::Gap => self.gap(),
            Element::Paragraph(paragraph) => self.paragraph(paragraph),
            Element::List(list) => self.list(list),
            Element::Table(table) => self.table(table),
            Element::Chart(Chart::Spread(spread)) => {
                if let Some(bins) = spread.bins.as_ref().filter(|_| spread.sampled) {
                    let together = if self.style.detail == Detail::Full { 2 } else { 4 };
                    self.table(&bars(bins, spread.sigma, together));
                } else if let Some(law) = &spread.law {
                    let picture = sketch(law, spread.limits, self.style.width, self.style.unicode);
                    picture.into_iter().for_each(|line| self.folded(&line.into()));
                }
            }
            Element::Detail(inner) if self.style.detail == Detail::Full => inner.iter().for_each(|one| self.block(one)),
            Element::Brief(inner) if self.style.detail == Detail::Short => inner.iter().for_each(|one| self.block(one)),
            Element::Detail(_) | Element::Brief(_) | Element::Markup(_) => {}
            Element::Chart(Chart::Plot(_) | Chart::Bars(_)) | Element::Aside(_) | Element::Finding(_) => {}
        }
    }

    /// Appends an empty line, unless the last line is empty or a title.
    fn gap(&mut self) {
        let below_title = self.title > 0 && self.text.len() == self.title;
        if !self.text.ends_with("\n\n") && !below_title {
            self.text.push('\n');
        }
    }

    fn paragraph(&mut self, Paragraph { line, indent, flow }: &Paragraph) {
        match flow {
            Flow::Verbatim => {
                self.text += &line.text();
                self.text.push('\n');
            }
            Flow::Folded => self.folded(&Line::from(" ".repeat(*indent)).and(line.clone())),
            Flow::Wrapped => self.wrapped(*indent, line),
        }
    }

    /// Returns the letters of a line, replaced by ASCII if the style requests it.
    fn letters(&self, line: &Line) -> Vec<Letter> {
        let letters = |span: &crate::document::Span| {
            let text = clean(&span.text);
            let text = if self.style.unicode {
                text
            } else {
                ASCII.iter().fold(text, |text, (sign, plain)| text.replace(*sign, plain))
            };
            text.chars().map(|letter| (letter, span.tone)).collect::<Vec<_>>()
        };
        line.0.iter().flat_map(letters).collect()
    }

    /// Appends letters without trailing spaces, coloured by their tone.
    fn put(&mut self, letters: &[Letter]) {
        let end = letters.iter().rposition(|&(letter, _)| !letter.is_whitespace()).map_or(0, |last| last + 1);
        for part in letters[..end].chunk_by(|a, b| a.1 == b.1) {
            let text: String = part.iter().map(|&(letter, _)| letter).collect();
            match escape(part[0].1).filter(|_| self.style.color) {
                Some(escape) => self.text += &format!("{escape}{text}\u{1b}[0m"),
                None => self.text += &text,
            }
        }
        self.text.push('\n');
    }

    /// Appends a line. If it is too long, it continues in the next one, indented by four.
    fn folded(&mut self, line: &Line) {
        let mut rest = self.letters(line);
        let width = self.style.width;
        while trimmed(&rest) > width {
            let words = rest.iter().take_while(|letter| letter.0 == ' ').count();
            let Some(space) = (words + 1..=width).rev().find(|&at| rest[at].0 == ' ') else { break };
            self.put(&rest[..space]);
            let more = rest[space..].iter().copied().skip_while(|letter| letter.0 == ' ');
            rest = spaces(4).chain(more).collect();
        }
        self.put(&rest);
    }

    /// Appends text over several lines, those after the first indented by four. A percent sign stays with its number.
    fn wrapped(&mut self, indent: usize, line: &Line) {
        let letters = self.letters(line);
        let glued = |at: usize| letters[at].0 == ' ' && letters.get(at + 1).is_some_and(|next| next.0 == '%');
        let mut words: Vec<Vec<Letter>> = vec![Vec::new()];
        for (at, &letter) in letters.iter().enumerate() {
            match letter.0 == ' ' && !glued(at) {
                true => words.push(Vec::new()),
                false => words.last_mut().expect("never empty").push(letter),
            }
        }
        let mut line: Vec<Letter> = spaces(indent).collect();
        let mut empty = true;
        for word in words.into_iter().filter(|word| !word.is_empty()) {
            if !empty && line.len() + 1 + word.len() > self.style.width {
                self.put(&std::mem::replace(&mut line, spaces(4).collect()));
            } else if !empty {
                line.extend(spaces(1));
            }
            line.extend(word);
            empty = false;
        }
        self.put(&line);
    }

    /// Appends words with commas after a title, on at most `LINES` lines unless everything is shown. The other words are counted.
    fn list(&mut self, List { title, words }: &List) {
        let most = if self.style.detail == Detail::Full { usize::MAX } else { LINES };
        let (mut lines, mut line) = (0, title.clone());
        for (index, word) in words.iter().enumerate() {
            let last = index + 1 == words.len();
            let comma = if last || word.ends_with(';') { "" } else { "," };
            let word = format!(" {}{comma}", if last { word.trim_end_matches(';') } else { word });
            let room = self.style.width - if lines + 1 == most { MORE } else { 0 };
            let full = line.chars().count() + word.chars().count() > room;
            if full && lines + 1 == most {
                line += &format!(" and {} more", words.len() - index);
                break;
            }
            if full {
                self.folded(&std::mem::replace(&mut line, " ".repeat(title.chars().count())).into());
                lines += 1;
            }
            line += &word;
        }
        self.folded(&line.into());
    }

    /// Appends a table, indented by two and no wider than the page. Names in the first column are shortened first. A label that is no
    /// name is never shortened: if it is too long, it stands above its row. Columns without space go into a table below, with the labels
    /// again. Columns that have labels of their own go there beside these labels.
    fn table(&mut self, table: &DataTable) {
        let most = if self.style.detail == Detail::Full { usize::MAX } else { table.most[0] };
        let places = table.places(|column| column.terminal);
        if table.view.is_empty() || places.is_empty() || most == 0 {
            return;
        }
        let titles = places.iter().map(|&place| self.letters(&table.columns[place].title.into()));
        let mut rows = vec![titles.collect::<Vec<_>>()];
        for &index in table.view.iter().take(most) {
            rows.push(places.iter().map(|&place| self.letters(&table.rows[index][place].line)).collect());
        }
        let right: Vec<bool> = places.iter().map(|&place| table.right(place)).collect();
        let widest = |column: usize| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0).max(1);
        let widths: Vec<usize> = (0..places.len()).map(widest).collect();
        let labels: Vec<bool> = places.iter().map(|&place| table.columns[place].label).collect();
        let named = |place: usize| table.view.iter().any(|&index| table.rows[index][place].full.is_some());
        let named: Vec<bool> = places.iter().map(|&place| named(place)).collect();
        let least: Vec<usize> = (named.iter().zip(&widths))
            .map(|(named, width)| *width.min(if *named { &SHORTEST } else { &LABEL }))
            .collect();
        let shape = TableShape { widths, least, right, named };
        for (index, columns) in self.parts(&shape, &labels).iter().enumerate() {
            self.part(&rows, columns, &shape, index > 0);
        }
        if table.view.len() > most && !table.rest.is_empty() {
            self.folded(&format!("  {}", table.rest).into());
        }
    }

    /// Groups the columns into parts that fit side by side. Each part begins with the label of its columns: the first column, or the last
    /// label column before them.
    fn parts(&self, TableShape { widths, least, .. }: &TableShape, labels: &[bool]) -> Vec<Vec<usize>> {
        let least = |label: usize| least[label] + GAP;
        let mut parts: Vec<Vec<usize>> = Vec::new();
        let (mut columns, mut taken, mut label) = (vec![0], least(0), 0);
        for column in 1..widths.len() {
            // Columns up to the next label stay together if they fit at all.
            let end = (column + 1..widths.len()).find(|&next| labels[next]).unwrap_or(widths.len());
            let group: usize = widths[column..end].iter().map(|width| width + GAP).sum();
            let needed = if labels[column] { group } else { widths[column] + GAP };
            if taken + needed > self.style.width && columns.len() > 1 {
                parts.push(std::mem::take(&mut columns));
                // A label column that begins a part serves as its names.
                let own = if labels[column] { column } else { label };
                (columns, taken) = (vec![own], least(own));
            }
            if labels[column] {
                label = column;
            }
            if columns[0] != column {
                columns.push(column);
                taken += widths[column] + GAP;
            }
        }
        parts.push(columns);
        parts
    }

    /// Appends some columns of a table. In parts below the first one, rows without content are left out.
    fn part(&mut self, rows: &[Vec<Vec<Letter>>], columns: &[usize], shape: &TableShape, below: bool) {
        let TableShape { widths, least, right, named } = shape;
        let total: usize = columns.iter().map(|&column| widths[column] + GAP).sum();
        let label = columns[0];
        let most = widths[label].saturating_sub(total.saturating_sub(self.style.width)).max(least[label]);
        let said = |row: &&Vec<Vec<Letter>>| columns.iter().skip(1).any(|&column| trimmed(&row[column]) > 0);
        for row in rows.iter().filter(|row| !below || said(row)) {
            let mut name = if named[label] { self.fitted(&row[label], most) } else { row[label].clone() };
            if width(&name) > most && said(&row) {
                self.put(&spaces(GAP).chain(std::mem::take(&mut name)).collect::<Vec<_>>());
            }
            let mut line: Vec<Letter> = Vec::new();
            for &column in columns {
                let first = column == label;
                let cell = if first { std::mem::take(&mut name) } else { row[column].clone() };
                let wanted = if first { widths[label].min(most) } else { widths[column] };
                let missing = wanted.saturating_sub(width(&cell));
                let [before, after] = if right[column] { [missing, 0] } else { [0, missing] };
                line.extend(spaces(GAP + before).chain(cell).chain(spaces(after)));
            }
            if trimmed(&line) > 0 {
                self.put(&line);
            }
        }
    }

    /// Shortens a name longer than `most` in the middle.
    fn fitted(&self, cell: &[Letter], most: usize) -> Vec<Letter> {
        if cell.len() <= most {
            return cell.to_vec();
        }
        let name: String = cell.iter().map(|&(letter, _)| letter).collect();
        self.letters(&Line::toned(shortened_to(&name, most), cell[0].1))
    }
}

fn spaces(count: usize) -> impl Iterator<Item = Letter> {
    std::iter::repeat_n((' ', Tone::Plain), count)
}

/// Returns the length without trailing spaces.
fn trimmed(letters: &[Letter]) -> usize {
    letters.iter().rposition(|&(letter, _)| letter != ' ').map_or(0, |last| last + 1)
}

/// Returns the terminal columns that letters take: two for East Asian letters and pictures, none for combining marks.
fn width(letters: &[Letter]) -> usize {
    let columns = |&(letter, _): &Letter| match u32::from(letter) {
        0x300..=0x36f | 0x200b..=0x200f | 0xfe00..=0xfe0f => 0,
        0x1100..=0x115f | 0x2e80..=0xa4cf | 0xac00..=0xd7a3 | 0xf900..=0xfaff | 0xfe30..=0xfe6f => 2,
        0xff00..=0xff60 | 0xffe0..=0xffe6 | 0x1f300..=0x1faff | 0x20000..=0x3fffd => 2,
        _ => 1,
    };
    letters.iter().map(columns).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::document::{Blocks, Cell, Columns};

    const STYLE: Style = Style { detail: Detail::Short, unicode: true, color: true, width: 20 };

    fn shown(blocks: impl FnOnce(&mut Document), style: Style) -> String {
        let mut document = Document::default();
        blocks(&mut document);
        text(&document, style)
    }

    /// Colour follows the tone, also in the continuation of a line. Words have no colour of their own.
    #[test]
    fn colour_follows_the_tone() {
        let line = || Line::from("met: the yield is ").and(Line::toned("met by far", Tone::Good));
        let page = shown(|page| page.wrapped(0, line()), STYLE);
        assert_eq!(
            page,
            "met: the yield is\n    \u{1b}[32mmet\u{1b}[0m \u{1b}[32mby\u{1b}[0m \u{1b}[32mfar\u{1b}[0m\n"
        );
        let plain = shown(|page| page.wrapped(0, line()), Style { color: false, ..STYLE });
        assert_eq!(plain, "met: the yield is\n    met by far\n");
    }

    /// Names are shortened, and columns without space stand below with the names again.
    #[test]
    fn tables_fit_the_page() {
        let row =
            |name: &str| [Cell::name(name), Cell::number(1.25, |x| format!("{x:.3}")), Cell::text("a word or two")];
        let table = DataTable::untitled([row("a"), row("a name that is long")]);
        let page = shown(|page| page.table(table), Style { color: false, ..STYLE });
        let lines: Vec<&str> = page.lines().collect();
        let expected =
            ["  a            1.250", "  a nam… long  1.250", "  a         a word or two", "  a na…ong  a word or two"];
        assert_eq!(lines, expected);
    }

    /// Labels within a table move down with the columns that they label.
    #[test]
    fn labels_stay_beside_their_columns() {
        let row = |[label, value, other, interval]: [&'static str; 4]| [label, value, other, interval].map(Cell::text);
        let rows = [row(["mean", "1.25", "RSS", "0.5 .. 2"]), row(["", "", "worst case", "0 .. 3"])];
        let page = |width: usize| {
            let table = DataTable::untitled(rows.clone()).labelled_by(&[2]);
            shown(|page| page.table(table), Style { color: false, width, ..STYLE })
        };
        assert_eq!(page(40), "  mean  1.25  RSS         0.5 .. 2\n              worst case  0 .. 3\n");
        assert_eq!(page(24), "  mean  1.25\n  RSS         0.5 .. 2\n  worst case  0 .. 3\n");
    }

    /// Table of random groups. Every row has a label and its values, each with distinct letters.
    #[derive(Debug, Clone)]
    struct Groups {
        /// Lengths of the label and of the values, by group and row; 0 for an empty cell.
        lengths: Vec<Vec<Vec<usize>>>,
        titled: bool,
        width: usize,
    }

    fn groups() -> impl Strategy<Value = Groups> {
        let shapes = (1..6usize, proptest::collection::vec(1..4usize, 1..4));
        (shapes, any::<bool>(), 40..200usize).prop_flat_map(|((rows, values), titled, width)| {
            let group = |values: usize| {
                // Values up to the length of two numbers of 17 digits, labels up to the length of names.
                let row = (1..45usize, proptest::collection::vec(0..40usize, values));
                let row = row.prop_map(|(label, values)| std::iter::once(label).chain(values).collect::<Vec<_>>());
                proptest::collection::vec(row, rows)
            };
            let lengths = values.into_iter().map(group).collect::<Vec<_>>();
            lengths.prop_map(move |lengths| Groups { lengths, titled, width })
        })
    }

    /// Returns letters that occur in one cell only.
    fn token(kind: char, [group, row, column]: [usize; 3], length: usize) -> String {
        let name = format!("{kind}{group}{row}{column}");
        if length == 0 { String::new() } else { format!("{name}{}", "-".repeat(length.saturating_sub(name.len()))) }
    }

    proptest! {
        /// At every width, a value stands on a line that begins with its own label. In a table with titles it stands below its own title.
        #[test]
        fn every_value_stands_beside_its_own_label(Groups { lengths, titled, width } in groups()) {
            const TITLES: [[&str; 3]; 3] = [["t00", "t01", "t02"], ["t10", "t11", "t12"], ["t20", "t21", "t22"]];
            let rows = lengths[0].len();
            let mut columns = Columns::default();
            let mut labels = Vec::new();
            let mut place = 0;
            for (group, of) in lengths.iter().enumerate() {
                labels.push(place);
                let label = move |row: &usize| Cell::text(token('n', [group, *row, 0], of[*row][0].max(4)));
                columns = if titled { columns.named("", "", label) } else { columns.shown("", label) };
                for column in 1..of[0].len() {
                    let value = move |row: &usize| Cell::text(token('v', [group, *row, column], of[*row][column]));
                    columns = columns.shown(if titled { TITLES[group][column - 1] } else { "" }, value);
                }
                place += of[0].len();
            }
            let table = columns.table("", 0..rows).labelled_by(&labels[1..]);
            let page = shown(|page| page.table(table), Style { color: false, width, ..STYLE });
            let mut header: &str = "";
            let mut seen = 0;
            let mut above = "";
            for line in page.lines() {
                if line.trim_start().starts_with('t') {
                    header = line;
                    continue;
                }
                // A long label stands alone on the line above its values, and nowhere else.
                let mut label = std::mem::take(&mut above);
                for (at, word) in line.split(' ').scan(0, |at, word| {
                    let begins = *at;
                    *at += word.chars().count() + 1;
                    Some((begins, word))
                }) {
                    match word.chars().next() {
                        Some('n') => label = &word[1..3],
                        Some('v') => {
                            prop_assert_eq!(&word[1..3], label, "{}", &page);
                            if titled {
                                let title = format!("t{}{}", &word[1..2], word[3..4].parse::<usize>().unwrap() - 1);
                                prop_assert_eq!(header.find(&title), Some(at), "{}\n{}", title, &page);
                            }
                            seen += 1;
                        }
                        _ => {}
                    }
                }
                above = if line.contains('v') { "" } else { label };
            }
            prop_assert!(!page.contains('…'), "labels are never shortened: {}", page);
            let filled = lengths.iter().flatten().flat_map(|row| &row[1..]).filter(|&&length| length > 0).count();
            prop_assert_eq!(seen, filled, "{}", page);
        }
    }

    /// Columns stay aligned with letters that take two terminal columns, or none.
    #[test]
    fn wide_letters_are_counted_twice() {
        let letters = |text: &str| text.chars().map(|letter| (letter, Tone::Plain)).collect::<Vec<_>>();
        assert_eq!(["gap", "隙間", "gap\u{301}"].map(|text| width(&letters(text))), [3, 4, 3]);
    }
}
