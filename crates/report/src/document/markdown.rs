//! Documents as Markdown.

use crate::document::{DataTable, Document, Element};
use sensitol_numeric::names::clean;

/// Writes a document: its title as a heading, a heading for every section, tables with the columns that pages show.
pub fn markdown(document: &Document) -> String {
    let mut text = String::new();
    if let Some(title) = &document.title {
        text += &format!("# {}\n\n", escaped(title));
    }
    document.head.iter().for_each(|block| text += &shown(block));
    for section in &document.sections {
        if !section.name.is_empty() {
            let unit = section.unit.as_deref().map(|unit| format!(" ({})", escaped(unit))).unwrap_or_default();
            text += &format!("**{}**{unit}{}\n\n", escaped(&section.name), escaped(&section.words));
        }
        section.blocks.iter().for_each(|block| text += &shown(block));
    }
    format!("{}\n", text.trim_end())
}

fn shown(block: &Element) -> String {
    match block {
        Element::Gap | Element::Chart(_) | Element::Brief(_) | Element::Markup(_) => String::new(),
        Element::Detail(inner) => inner.iter().map(shown).collect(),
        Element::Paragraph(one) => format!("{}\n\n", escaped(one.line.text().trim())),
        Element::Aside(aside) => {
            let title = if aside.title.is_empty() { String::new() } else { format!("### {}\n\n", aside.title) };
            title + &aside.blocks.iter().map(shown).collect::<String>()
        }
        Element::List(list) => {
            format!("{}: {}\n\n", escaped(list.title.trim().trim_end_matches(':')), escaped(&list.words.join(" ")))
        }
        Element::Table(table) => tabled(table),
        Element::Finding(one) => {
            format!("- **{}** {} {}\n\n", one.code, escaped(&one.message), escaped(&one.actions.join(" ")))
        }
    }
}

fn tabled(table: &DataTable) -> String {
    let places = table.places(|column| column.page);
    if table.view.is_empty() || places.is_empty() || table.most[1] == 0 {
        return String::new();
    }
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let rule = places.iter().map(|&place| if table.right(place) { "--:" } else { "---" });
    let mut text = row(places.iter().map(|&place| escaped(table.columns[place].heading)).collect());
    text += &format!("|{}|\n", rule.collect::<Vec<_>>().join("|"));
    for &index in table.view.iter().take(table.most[1]) {
        text += &row(places.iter().map(|&place| escaped(&table.rows[index][place].on_page().text())).collect());
    }
    text + "\n"
}

/// Escapes the marks of Markdown.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in clean(text).chars() {
        if ['|', '\\', '`', '*', '_', '<', '[', ']'].contains(&c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}
