//! A report as a document: what it says, apart from how it is shown.
//!
//! A command fills a [`Document`] once. A writer shows it: [`terminal`], [`csv`], [`markdown`], [`html`] or [`svg`]. Every piece of text and
//! every cell carries a [`Tone`], so that a writer colours by meaning, not by the words that it finds.

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
    /// Nothing in particular.
    #[default]
    Plain,
    /// As it should be.
    Good,
    /// Neither shown to be good nor to be bad.
    Doubtful,
    /// Not as it should be.
    Bad,
}

/// A piece of text in one tone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    /// The text.
    pub text: String,
    /// Its tone.
    pub tone: Tone,
}

/// A line of text: pieces, each in its tone.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Line(pub Vec<Span>);

/// How a line that is too long for the page goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// In the next line, indented by four, where a space allows it.
    Folded,
    /// In the next line; a percent sign stays with its number.
    Wrapped,
    /// It stays as it is, to be copied.
    Verbatim,
}

/// A paragraph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Paragraph {
    /// The text.
    pub line: Line,
    /// Spaces before it in a terminal.
    pub indent: usize,
    /// How it is broken into lines.
    pub flow: Flow,
}

/// Words after a title, shortened to a few lines unless everything is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct List {
    /// The words of the list.
    pub title: String,
    /// The words; one that ends with `;` ends a group.
    pub words: Vec<String>,
}

/// Something that the reader should know of a result: a warning, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// The code of the warning.
    pub code: &'static str,
    /// The event, and its meaning.
    pub message: String,
    /// The actions to take.
    pub actions: Vec<String>,
    /// How serious it is.
    pub tone: Tone,
}

/// A part that only pages have.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Aside {
    /// Its heading; empty for none.
    pub title: &'static str,
    /// The content.
    pub blocks: Vec<Element>,
}

/// A part of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// An empty line in a terminal.
    Gap,
    /// Text.
    Paragraph(Paragraph),
    /// Additions on pages, for which a terminal has no room.
    Aside(Aside),
    /// Details for pages, and for a terminal where everything is asked for.
    Detail(Vec<Element>),
    /// The text of a terminal in place of the details.
    Brief(Vec<Element>),
    /// Words after a title.
    List(List),
    /// A table.
    Table(DataTable),
    /// A drawing.
    Chart(Chart),
    /// HTML that is drawn already, of which only pages know.
    Markup(String),
    /// A warning. Terminals have it from stderr.
    Finding(Notice),
}

/// The part of a document on one thing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// The thing, by the name that it has in the study.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// The words after the name and the unit.
    pub words: String,
    /// The content.
    pub blocks: Vec<Element>,
}

/// A document.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document {
    /// Its title.
    pub title: Option<String>,
    /// The text before its sections.
    pub head: Vec<Element>,
    /// Its sections; the first may be about everything, without a name.
    pub sections: Vec<Section>,
}

impl Paragraph {
    /// A line below what it belongs to.
    pub(crate) fn note(line: impl Into<Line>) -> Self {
        Self { line: line.into(), indent: 2, flow: Flow::Folded }
    }
}

impl Line {
    /// A line of one piece.
    pub fn toned(text: impl Into<String>, tone: Tone) -> Self {
        Self(vec![Span { text: text.into(), tone }])
    }

    /// The line with more after it.
    pub fn and(mut self, more: impl Into<Line>) -> Self {
        self.0.extend(more.into().0);
        self
    }

    /// The whole text.
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

/// A document or a part of it, to which blocks are added one after the other.
pub trait Blocks {
    /// The blocks so far.
    fn blocks(&mut self) -> &mut Vec<Element>;

    /// An empty line.
    fn gap(&mut self) {
        self.blocks().push(Element::Gap);
    }

    /// A line at the margin.
    fn line(&mut self, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph { line: line.into(), indent: 0, flow: Flow::Folded }));
    }

    /// A line below what it belongs to.
    fn note(&mut self, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph::note(line)));
    }

    /// Text of any length, this far from the margin.
    fn wrapped(&mut self, indent: usize, line: impl Into<Line>) {
        self.blocks().push(Element::Paragraph(Paragraph { line: line.into(), indent, flow: Flow::Wrapped }));
    }

    /// Words after a title.
    fn list(&mut self, title: &str, words: Vec<String>) {
        self.blocks().push(Element::List(List { title: title.to_owned(), words }));
    }

    /// Blocks for pages only, below a heading unless that is empty.
    fn aside(&mut self, title: &'static str, blocks: Vec<Element>) {
        self.blocks().push(Element::Aside(Aside { title, blocks }));
    }

    /// Blocks for pages, and for terminals where everything is asked for.
    fn detail(&mut self, blocks: Vec<Element>) {
        self.blocks().push(Element::Detail(blocks));
    }

    /// Blocks for a terminal where not everything is asked for.
    fn brief(&mut self, blocks: Vec<Element>) {
        self.blocks().push(Element::Brief(blocks));
    }

    /// A line for pages only.
    fn remark(&mut self, line: impl Into<Line>) {
        let mut blocks = Vec::new();
        Blocks::line(&mut blocks, line);
        self.aside("", blocks);
    }

    /// A table.
    fn table(&mut self, table: DataTable) {
        self.blocks().push(Element::Table(table));
    }

    /// A drawing.
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
    /// An empty section about this.
    pub fn of(name: &str, unit: Option<&str>) -> Self {
        Self { name: name.to_owned(), unit: unit.map(str::to_owned), ..Self::default() }
    }
}

impl Document {
    /// An empty document of this title.
    pub(crate) fn titled(title: Option<&str>) -> Self {
        Self { title: title.map(str::to_owned), ..Self::default() }
    }

    /// All blocks, in order, with those of the details.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Element> {
        let blocks = self.head.iter().chain(self.sections.iter().flat_map(|section| &section.blocks));
        blocks.flat_map(|block| match block {
            Element::Detail(inner) => inner.as_slice(),
            other => std::slice::from_ref(other),
        })
    }
}
