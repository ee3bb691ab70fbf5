//! A report as a document: its content, apart from the format.
//!
//! A command fills a [`Document`] once. A writer prints it: [`terminal`], [`csv`], [`markdown`], [`html`] or [`svg`]. Every piece of text
//! and every cell carries a [`Tone`], so that a writer colours by meaning, not by the words in the text.

mod chart;
pub mod csv;
pub mod html;
mod labels;
pub mod markdown;
pub mod number;
pub(crate) mod rejects;
mod sketch;
mod spread;
pub mod svg;
mod table;
pub mod terminal;

pub use chart::{Bar, Bars, Chart, Fill, Layer, Plot, PlotAxis, PlotPoint, PlotScale, SpreadChart, Stroke};
pub(crate) use spread::Extent;
pub(crate) use table::Column;
pub use table::{Cell, Columns, DataTable, Value};
pub use terminal::{Detail, Style};

/// The meaning of a piece of text for the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tone {
    /// Neutral.
    #[default]
    Plain,
    /// Good, such as a requirement that is met.
    Good,
    /// Neither good nor bad for certain, such as an inconclusive verdict.
    Doubtful,
    /// Bad, such as a requirement that is missed.
    Bad,
}

/// A piece of text in one tone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    /// The text.
    pub text: String,
    /// Tone of the text.
    pub tone: Tone,
}

/// Line of text, as pieces with a tone each.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Line(pub Vec<Span>);

/// Treatment of a line that is too long for the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Breaks at spaces. The next line is indented by four.
    Folded,
    /// Breaks at spaces. A percent sign stays with its number.
    Wrapped,
    /// Never breaks, so that the text can be copied.
    Verbatim,
}

/// Paragraph of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Paragraph {
    /// The text.
    pub line: Line,
    /// Indentation in a terminal, in spaces.
    pub indent: usize,
    /// Rule for line breaks.
    pub flow: Flow,
}

/// Words after a title, cut to a few lines unless everything is requested.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct List {
    /// Title before the words.
    pub title: String,
    /// Words. One that ends with `;` ends a group.
    pub words: Vec<String>,
}

/// Notice for the reader of a result: a warning, and the actions to take.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// The code of the warning.
    pub code: &'static str,
    /// Event and its meaning.
    pub message: String,
    /// Actions to take.
    pub actions: Vec<String>,
    /// Severity.
    pub tone: Tone,
}

/// Part that only pages have.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Aside {
    /// Heading; empty for none.
    pub title: &'static str,
    /// The content.
    pub blocks: Vec<Element>,
}

/// Element of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// An empty line in a terminal.
    Gap,
    /// Paragraph of text.
    Paragraph(Paragraph),
    /// Additions on pages for which a terminal has no space.
    Aside(Aside),
    /// Details for pages, and for a terminal if everything is requested.
    Detail(Vec<Element>),
    /// Text of a terminal in place of the details.
    Brief(Vec<Element>),
    /// Words after a title.
    List(List),
    /// A table.
    Table(DataTable),
    /// Chart.
    Chart(Chart),
    /// Finished HTML, only for pages.
    Markup(String),
    /// A warning. Terminals print it on stderr instead.
    Finding(Notice),
}

/// Section of a document on one subject.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Name of the subject in the study.
    pub name: String,
    /// Unit of the subject.
    pub unit: Option<String>,
    /// Words after the name and the unit.
    pub words: String,
    /// The content.
    pub blocks: Vec<Element>,
}

/// A document.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document {
    /// Title of the study.
    pub title: Option<String>,
    /// Blocks before the sections.
    pub head: Vec<Element>,
    /// Sections. The first may have no name if it concerns everything.
    pub sections: Vec<Section>,
}

impl Paragraph {
    /// Returns an indented line below the line that it belongs to.
    pub(crate) fn note(line: impl Into<Line>) -> Self {
        Self { line: line.into(), indent: 2, flow: Flow::Folded }
    }
}

impl Line {
    /// Returns a line of one piece.
    pub fn toned(text: impl Into<String>, tone: Tone) -> Self {
        Self(vec![Span { text: text.into(), tone }])
    }

    /// Appends text to the line.
    pub fn and(mut self, more: impl Into<Line>) -> Self {
        self.0.extend(more.into().0);
        self
    }

    /// Returns the whole text without tones.
    pub(crate) fn text(&self) -> String {
        self.0.iter().map(|span| span.text.as_str()).collect()
    }

    fn is_empty(&self) -> bool {
        self.0.iter().all(|span| span.text.is_empty())
    }
}

impl<T: Into<String>> From<T> for Line {
    fn from(text: T) -> Self {
        Self::toned(text, Tone::Plain)
    }
}

/// Builder of a document or a part of it: each method appends a block.
pub trait Blocks {
    /// Returns the blocks so far.
    fn blocks(&mut self) -> &mut Vec<Element>;

    /// Adds an empty line.
    fn gap(&mut self) {
        self.blocks().push(Element::Gap);
    }

    /// Adds a line at the margin.
    fn line(&mut self, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph { line: line.into(), indent: 0, flow: Flow::Folded }));
    }

    /// Adds an indented line below the line that it belongs to.
    fn note(&mut self, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph::note(line)));
    }

    /// Adds text of any length, indented by `indent` spaces.
    fn wrapped(&mut self, indent: usize, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph { line: line.into(), indent, flow: Flow::Wrapped }));
    }

    /// Adds words after a title.
    fn list(&mut self, title: &str, words: Vec<String>) {
        self.blocks().push(Element::List(List { title: title.to_owned(), words }));
    }

    /// Adds blocks for pages only, below a heading unless `title` is empty.
    fn aside(&mut self, title: &'static str, blocks: Vec<Element>) {
        self.blocks().push(Element::Aside(Aside { title, blocks }));
    }

    /// Adds blocks for pages, and for a terminal if everything is requested.
    fn detail(&mut self, blocks: Vec<Element>) {
        self.blocks().push(Element::Detail(blocks));
    }

    /// Adds blocks for a terminal if not everything is requested.
    fn brief(&mut self, blocks: Vec<Element>) {
        self.blocks().push(Element::Brief(blocks));
    }

    /// Adds a line for pages only.
    fn remark(&mut self, line: impl Into<Line>) {
        let mut blocks = Vec::new();
        Blocks::line(&mut blocks, line);
        self.aside("", blocks);
    }

    /// Adds a table.
    fn table(&mut self, table: DataTable) {
        self.blocks().push(Element::Table(table));
    }

    /// Adds a chart.
    fn chart(&mut self, chart: Chart) {
        self.blocks().push(Element::Chart(chart));
    }
}

impl Blocks for Document {
    fn blocks(&mut self) -> &mut Vec<Element> {
        &mut self.head
    }
}

impl Blocks for Section {
    fn blocks(&mut self) -> &mut Vec<Element> {
        &mut self.blocks
    }
}

impl Blocks for Vec<Element> {
    fn blocks(&mut self) -> &mut Vec<Element> {
        self
    }
}

impl Section {
    /// Returns an empty section about a subject.
    pub fn of(name: &str, unit: Option<&str>) -> Self {
        Self { name: name.to_owned(), unit: unit.map(str::to_owned), ..Self::default() }
    }
}

impl Document {
    /// Returns an empty document with a title.
    pub(crate) fn titled(title: Option<&str>) -> Self {
        Self { title: title.map(str::to_owned), ..Self::default() }
    }

    /// Iterates over all blocks in order, those inside details included.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Element> {
        let blocks = self.head.iter().chain(self.sections.iter().flat_map(|section| &section.blocks));
        blocks.flat_map(|block| match block {
            Element::Detail(inner) => inner.as_slice(),
            other => std::slice::from_ref(other),
        })
    }
}
