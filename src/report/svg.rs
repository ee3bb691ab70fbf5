//! What charts have in common: one below the other, each with a frame of its own.

use std::fmt::Write;

pub(super) const WIDTH: f64 = 720.0;
/// Height of one characteristic's chart.
pub(super) const HEIGHT: f64 = 420.0;
/// Left, right, above, below.
pub(super) const MARGIN: [f64; 4] = [80.0, 150.0, 48.0, 56.0];
/// The colour of what is to be looked at.
pub(super) const ACCENT: &str = "#1f6feb";

/// The beginning of a drawing on white.
pub(super) fn opened(title: &str, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>{}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        escaped(title)
    )
}

/// A drawing of charts, a name above each.
pub(super) fn charts<T>(title: &str, of: &[T], name: impl Fn(&T) -> String, draw: impl Fn(&mut String, &T)) -> String {
    let mut svg = opened(title, HEIGHT * of.len() as f64);
    for (index, one) in of.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate(0 {})\">", HEIGHT * index as f64);
        headline(&mut svg, &name(one));
        draw(&mut svg, one);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

/// What a chart is about, above it.
pub(super) fn headline(svg: &mut String, text: &str) {
    let [left, ..] = MARGIN;
    let text = escaped(text);
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"24\" font-size=\"15\" font-weight=\"bold\">{text}</text>");
}

/// A line of the grid at a place of the horizontal axis, with what it stands for, which may be markup.
pub(super) fn across(svg: &mut String, at: f64, label: &str) {
    let [_, _, above, below] = MARGIN;
    let _ = writeln!(svg, "<path d=\"M{at:.1} {above}V{}\" stroke=\"#ddd\"/>", HEIGHT - below);
    let _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", HEIGHT - below + 18.0);
}

/// The same of the vertical axis.
pub(super) fn up(svg: &mut String, at: f64, label: &str) {
    let [left, right, ..] = MARGIN;
    let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{}\" stroke=\"#ddd\"/>", WIDTH - right);
    let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>", left - 8.0, at + 4.0);
}

/// What the axes are.
pub(super) fn axes(svg: &mut String, horizontal: &str, vertical: &str) {
    let [left, right, above, below] = MARGIN;
    let (horizontal, vertical) = (escaped(horizontal), escaped(vertical));
    let middle = 0.5 * (left + WIDTH - right);
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{horizontal}</text>", HEIGHT - 12.0);
    let centre = 0.5 * (above + HEIGHT - below);
    let _ = writeln!(
        svg,
        "<text x=\"18\" y=\"{centre}\" text-anchor=\"middle\" transform=\"rotate(-90 18 {centre})\">{vertical}</text>"
    );
}

/// A dashed line at a height, named beside the chart.
pub(super) fn mark(svg: &mut String, at: f64, label: &str) {
    let [left, right, ..] = MARGIN;
    let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{}\" stroke=\"#888\" stroke-dasharray=\"4 4\"/>", WIDTH - right);
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{:.1}\" fill=\"#555\">{}</text>",
        WIDTH - right + 6.0,
        at + 4.0,
        escaped(label)
    );
}

/// Names come from studies: nothing in them is markup.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
