//! Documents as fragments of HTML. The page around them holds the style sheet for their classes.

use crate::document::html;
use crate::document::svg::{escaped, figure};
use crate::document::{Bar, Bars, Cell, Chart, DataTable, Document, Element, Fill, Flow, Line, Section, Tone, spread};
use sensitol_numeric::names::clean;

/// Greatest number of rows of a sweep's table that is shown unfolded.
const FOLDED: usize = 6;

/// Writes the part before all sections as the summary.
pub fn head(document: &Document) -> String {
    format!(
        "<section aria-labelledby=\"summary\">\n<h2 id=\"summary\">Summary</h2>\n{}</section>\n",
        blocks(&document.head)
    )
}

/// Writes the sections, each as a `<section>`.
pub fn sections(document: &Document) -> String {
    document.sections.iter().enumerate().map(|(index, one)| section(index, one)).collect()
}

fn section(index: usize, section: &Section) -> String {
    if section.name.is_empty() {
        return format!("<section>\n{}</section>\n", blocks(&section.blocks));
    }
    let body = figure_first(&section.blocks, &format!("warned-{index}"));
    let unit = section.unit.as_deref().map(|unit| format!(" <small>[{}]</small>", escaped(unit))).unwrap_or_default();
    let title = format!("<h2 id=\"kc-title-{index}\">{}{unit}</h2>\n", escaped(&section.name));
    let remark = match section.words.trim_start_matches([',', ':', ' ']) {
        "" => String::new(),
        remark => format!("<p class=\"note\">{}</p>\n", escaped(remark)),
    };
    format!(
        "<section id=\"kc-{index}\" class=\"kc\" aria-labelledby=\"kc-title-{index}\">\n{title}{remark}{body}</section>\n"
    )
}

/// Writes bars as the rows of a table.
pub(crate) fn bars(bars: &Bars) -> String {
    let class = |fill: Fill| match fill {
        Fill::Linear => "linear",
        Fill::Span => "span",
        Fill::Over => "over",
        Fill::Before => "was",
        Fill::After => "after",
    };
    // Bars with a legend fill the height of the row. Intervals leave space for the limit marks and have a remark column.
    let (kind, place) = match bars.legend.is_empty() {
        true => ("spans", "y=\"2\" height=\"6\""),
        false => ("pareto", "height=\"10\""),
    };
    let mark = |at: &f64| format!("<path class=\"limit\" d=\"M{at} 0V10\"/>");
    let marks: String = bars.marks.iter().map(mark).collect();
    let caption = escaped(&bars.caption);
    let mut text = format!("<table class=\"{kind}\"><caption class=\"sr\">{caption}</caption><tbody>\n");
    for Bar { name, parts, text: amount, remark } in &bars.rows {
        let part = |&(fill, [x, width]): &(Fill, [f64; 2])| {
            let place = match fill {
                Fill::Before => "height=\"4.5\"",
                Fill::After => "y=\"5.5\" height=\"4.5\"",
                _ => place,
            };
            format!("<rect class=\"{}\" x=\"{x}\" width=\"{width}\" {place}/>", class(fill))
        };
        let parts: String = parts.iter().map(part).collect();
        let svg = format!(
            "<svg class=\"bar\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\">{parts}{marks}</svg>"
        );
        let remark = match kind {
            "spans" => format!("<td>{}</td>", toned(remark)),
            _ => String::new(),
        };
        let (name, amount) = (escaped(name), escaped(amount));
        text += &format!(
            "<tr><th scope=\"row\">{name}</th><td class=\"grow\">{svg}</td><td class=\"n\">{amount}</td>{remark}</tr>\n"
        );
    }
    text += "</tbody></table>\n";
    if !bars.legend.is_empty() {
        let key = |&(fill, name): &(Fill, &str)| format!("<li class=\"key {}\">{name}</li>", class(fill));
        text += &format!("<ul class=\"legend\">{}</ul>\n", bars.legend.iter().map(key).collect::<String>());
    }
    text
}

/// Writes blocks with the first figure first. The leading warnings concern the figure and stand below it, the facts beside both.
fn figure_first(all: &[Element], id: &str) -> String {
    let found = all.iter().take_while(|block| matches!(block, Element::Finding(_))).count();
    let (findings, rest) = all.split_at(found);
    let (facts, rest) = match rest {
        [Element::Markup(facts), rest @ ..] => (facts.as_str(), rest),
        _ => ("", rest),
    };
    let beside = |figure: String| match facts {
        "" => figure,
        facts => format!("<div class=\"beside\">\n<div>{figure}</div>\n{facts}</div>\n"),
    };
    let findings = blocks(findings).replacen("<ul", &format!("<ul id=\"{id}\""), 1);
    let drawn = |block: &Element| matches!(block, Element::Chart(Chart::Spread(_) | Chart::Plot(_)));
    for (place, block) in rest.iter().enumerate() {
        let without = |inside: &str| blocks(&rest[..place]) + inside + &blocks(&rest[place + 1..]);
        match block {
            one if drawn(one) => return beside(html::block(one) + &findings) + &without(""),
            Element::Detail(inner) => {
                let Some(inside) = inner.iter().position(drawn) else { continue };
                let others = blocks(&inner[..inside]) + &blocks(&inner[inside + 1..]);
                return beside(html::block(&inner[inside]) + &findings) + &without(&others);
            }
            _ => {}
        }
    }
    facts.to_owned() + &findings + &blocks(rest)
}

/// Writes blocks one after the other. Adjacent findings become one list.
pub fn blocks(blocks: &[Element]) -> String {
    let mut text = String::new();
    for part in blocks.chunk_by(|a, b| matches!((a, b), (Element::Finding(_), Element::Finding(_)))) {
        match part {
            [Element::Finding(_), ..] => {
                text += &format!("<ul class=\"warnings\">\n{}</ul>\n", part.iter().map(block).collect::<String>());
            }
            _ => text.extend(part.iter().map(block)),
        }
    }
    text
}

fn block(block: &Element) -> String {
    match block {
        Element::Gap => String::new(),
        Element::Paragraph(one) if one.flow == Flow::Verbatim => {
            format!("<pre tabindex=\"0\">{}</pre>\n", escaped(&one.line.text()))
        }
        Element::Paragraph(one) => {
            let class = if one.indent > 0 { " class=\"note\"" } else { "" };
            format!("<p{class}>{}</p>\n", toned(&one.line))
        }
        Element::Detail(inner) => blocks(inner),
        Element::Markup(one) => one.clone(),
        Element::Brief(_) => String::new(),
        Element::Aside(aside) if aside.title.is_empty() => blocks(&aside.blocks),
        Element::Aside(aside) => format!("<h3>{}</h3>\n{}", aside.title, blocks(&aside.blocks)),
        Element::List(list) => {
            format!(
                "<p class=\"note\">{}: {}</p>\n",
                escaped(list.title.trim().trim_end_matches(':')),
                escaped(&list.words.join(" "))
            )
        }
        Element::Table(one) => table(one),
        Element::Chart(Chart::Plot(one)) => figure(one),
        Element::Chart(Chart::Bars(one)) => bars(one),
        Element::Chart(Chart::Spread(one)) => spread::figure(one).unwrap_or_default(),
        Element::Finding(one) => {
            let actions: String =
                one.actions.iter().map(|action| format!(" <span>{}</span>", escaped(action))).collect();
            format!("<li><strong>{}</strong> {}{actions}</li>\n", one.code, escaped(&one.message))
        }
    }
}

/// Writes text with marked tones.
fn toned(line: &Line) -> String {
    let span = |span: &crate::document::Span| {
        let text = escaped(&clean(&span.text));
        match span.tone {
            Tone::Plain => text,
            Tone::Good => format!("<span class=\"badge good\">{text}</span>"),
            Tone::Doubtful => format!("<span class=\"badge unsure\">{text}</span>"),
            Tone::Bad => format!("<span class=\"badge bad\">{text}</span>"),
        }
    };
    line.0.iter().map(span).collect()
}

/// Writes a table with the columns that pages show. The first cell of a row is its heading unless it is a number.
pub fn table(table: &DataTable) -> String {
    let places = table.places(|column| column.page);
    if table.view.is_empty() || places.is_empty() || table.most[1] == 0 {
        return String::new();
    }
    let class = |place: usize| if table.right(place) { " class=\"n\"" } else { "" };
    // A table that is wider than the window can be scrolled by keys.
    let mut text = "<div class=\"wide\" tabindex=\"0\"><table>\n".to_owned();
    if places.iter().any(|&place| !table.columns[place].heading.is_empty()) {
        let title = |&place: &usize| match table.columns[place].heading {
            // An empty heading must not be read out as the title of a column.
            "" => "<td></td>".to_owned(),
            heading => format!("<th scope=\"col\"{}>{}</th>", class(place), escaped(heading)),
        };
        text += &format!("<thead><tr>{}</tr></thead>\n", places.iter().map(title).collect::<String>());
    }
    text += "<tbody>\n";
    for &index in table.view.iter().take(table.most[1]) {
        let cell = |(rank, &place): (usize, &usize)| {
            let of: &Cell = &table.rows[index][place];
            let text = toned(&of.on_page());
            let text = of.leads_to.map_or(text.clone(), |section| format!("<a href=\"#kc-{section}\">{text}</a>"));
            match rank == 0 && !table.right(place) && !text.is_empty() {
                true => format!("<th scope=\"row\">{text}</th>"),
                false => format!("<td{}>{text}</td>", class(place)),
            }
        };
        text += &format!("<tr>{}</tr>\n", places.iter().enumerate().map(cell).collect::<String>());
    }
    text += "</tbody></table></div>\n";
    // The chart says more than many rows: the numbers stay available for readers who open them, and on paper.
    if table.name == "sweep" && table.view.len() > FOLDED {
        let rows = table.view.len();
        return format!("<details class=\"fold\"><summary>The {rows} values as a table</summary>\n{text}</details>\n");
    }
    text
}
