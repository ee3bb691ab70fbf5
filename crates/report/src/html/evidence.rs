//! Answers to the next questions of a review, for each characteristic: the tails, and the difference of mean and nominal value.

use std::fmt::Write;

use crate::DimensionReport;
use crate::document::number::{band, beside, estimated, plain, power_of_ten};
use crate::document::svg::escaped;
use crate::document::{Bar, Bars, Extent, Fill, Line, html};
use crate::figures::FittedFigures;
use crate::figures::{Figures, Named};
use sensitol::analysis::CharacteristicAnalysis;
use sensitol::verification::TailPoint;
use sensitol_numeric::capability::Law;
use sensitol_numeric::pearson::Pearson;

/// Least visible shift of the mean, as a part of sigma.
const SEEN: f64 = 0.01;
/// Greatest number of rows of the table of shifts.
const SHIFTS: usize = 12;
/// Share at which the drawing of a tail begins.
const FROM: f64 = 0.1;
/// Share to which a tail is drawn at least.
const TO: f64 = 1e-5;

/// One limit with the tail of the Pearson fit and the reject rates by surface and model.
struct Tail<'l> {
    name: &'static str,
    limit: f64,
    upper: bool,
    law: &'l Pearson,
    /// Reject rate by the surface.
    surface: Option<f64>,
    /// Reject rate by points of the model, with its error.
    model: Option<(f64, f64)>,
    /// Values with the shares at or beyond them, by points of the model.
    seen: &'l [TailPoint],
}

/// Draws the reject rate near each limit on a logarithmic scale: the Pearson fit as a line, surface and model as marks at the limit.
pub(super) fn tails(one: &CharacteristicAnalysis) -> Option<String> {
    let Some(Law::Pearson(law)) = one.fitted() else { return None };
    let of_surface = one.evidence.surface_law.as_ref();
    let by_model = one.evidence.verification.as_ref().map_or([None, None], |found| found.figures.beyond);
    let seen = one.evidence.verification.as_ref().and_then(|found| found.tails.as_ref());
    let seen = seen.map_or([&[][..], &[]], |tails| [&tails.below[..], &tails.above[..]]);
    let all = [
        ("lower", one.lower(), false, of_surface.and_then(|law| law.below), by_model[0], seen[0]),
        ("upper", one.upper(), true, of_surface.and_then(|law| law.above), by_model[1], seen[1]),
    ];
    let panels: Vec<String> = all
        .into_iter()
        .filter_map(|(name, limit, upper, surface, model, seen)| {
            let surface = surface.map(|figure| figure.value);
            let model = model.map(|found| (found.value, found.error));
            panel(one, &Tail { name, limit: limit?, upper, law, surface, model, seen })
        })
        .collect();
    (!panels.is_empty()).then(|| {
        format!(
            "<div class=\"tails\">{}</div>\n<p class=\"note\">Share of the assemblies beyond a value, on a logarithmic scale. Line: the Pearson fit; small \
             dots: points of the model, with the band of two standard errors. At the limit: diamond, the surface; dot and bar, points of the model.</p>\n",
            panels.concat()
        )
    })
}

/// Draws one tail. Returns None if the limit is too far out for a picture.
fn panel(one: &CharacteristicAnalysis, tail: &Tail<'_>) -> Option<String> {
    let panel = Panel::new(tail)?;
    let unit = one.unit().map(|unit| format!(" {unit}")).unwrap_or_default();
    let mut svg = format!(
        "<svg class=\"tail\" viewBox=\"0 0 {WIDTH} {}\" role=\"img\" aria-label=\"{}\">\n",
        TALL + 30.0,
        escaped(&tail.spoken(one.name(), &unit))
    );
    panel.background(&mut svg);
    panel.shares(&mut svg);
    panel.limit(&mut svg, &unit);
    panel.marks(&mut svg);
    Some(svg + "</svg>")
}

/// Width of a panel: two stand beside each other on a page.
const WIDTH: f64 = 340.0;
/// Height between the largest share and the least.
const TALL: f64 = 150.0;
/// Width of the numbers at the left.
const LEFT: f64 = 56.0;

impl Tail<'_> {
    /// The share beyond a value by the Pearson fit.
    fn beyond(&self, x: f64) -> f64 {
        if self.upper { self.law.sf(x) } else { self.law.cdf(x) }
    }

    /// The value with this share beyond it.
    fn at(&self, share: f64) -> f64 {
        if self.upper { self.law.upper_quantile(share) } else { self.law.quantile(share) }
    }

    /// The text for readers who do not see the panel.
    fn spoken(&self, name: &str, unit: &str) -> String {
        let said = |share: f64| format!("{} ppm", estimated(1e6 * share, None));
        let mut spoken = vec![format!("Tail of {name} at the {} limit {}{unit}", self.name, plain(self.limit))];
        spoken.push(format!("Pearson fit {}", said(self.beyond(self.limit))));
        spoken.extend(self.surface.map(|share| format!("surface {}", said(share))));
        spoken.extend(self.model.map(|(share, error)| format!("model {} ± {}", said(share), said(error))));
        spoken.join(", ")
    }
}

/// A tail on its scales: values across, shares downwards by decades.
struct Panel<'t> {
    tail: &'t Tail<'t>,
    scale: Extent,
    decades: f64,
    /// The share at the bottom.
    least: f64,
    /// Place of the limit across.
    limit: f64,
}

impl<'t> Panel<'t> {
    /// Chooses the scales. Returns None if the limit is too far out.
    fn new(tail: &'t Tail<'t>) -> Option<Self> {
        let seen = [tail.surface, tail.model.map(|model| model.0), Some(tail.beyond(tail.limit))];
        let least = seen.into_iter().flatten().filter(|share| *share > 0.0).fold(TO, f64::min);
        // Further out than this a picture says nothing.
        const FARTHEST: f64 = 1e-9;
        if least < FARTHEST {
            return None;
        }
        let decades = -libm::log10(least).floor();
        let least = power_of_ten(-decades);
        let shown = tail.seen.iter().filter(|point| point.share >= least);
        let values = [tail.at(FROM), tail.at(least), tail.limit].into_iter().chain(shown.map(|point| point.at));
        let scale = Extent::over(values, 0.04, WIDTH - LEFT)?;
        let limit = LEFT + scale.at(tail.limit);
        Some(Self { tail, scale, decades, least, limit })
    }

    /// Place of a value across.
    fn x(&self, value: f64) -> f64 {
        LEFT + self.scale.at(value)
    }

    /// Place of a share downwards.
    fn y(&self, share: f64) -> f64 {
        let least = self.least;
        let part = (libm::log10(FROM) - libm::log10(share.max(least))) / (libm::log10(FROM) - libm::log10(least));
        (10.0 * TALL * part.clamp(0.0, 1.0)).round() / 10.0 + 8.0
    }

    /// Draws the zone beyond the limit, and a line for each decade.
    fn background(&self, svg: &mut String) {
        let (from, to) = if self.tail.upper { (self.limit, WIDTH) } else { (LEFT, self.limit) };
        let _ = writeln!(
            svg,
            "<rect class=\"zone\" x=\"{from:.1}\" y=\"8\" width=\"{:.1}\" height=\"{TALL}\"/>",
            (to - from).max(0.0)
        );
        for decade in 1..=self.decades as i32 {
            let share = 10f64.powi(-decade);
            let name = match decade {
                1 => "10 %".to_owned(),
                2 => "1 %".to_owned(),
                3 => "0.1 %".to_owned(),
                4..=6 => format!("{} ppm", 10i32.pow(6 - decade as u32)),
                _ => format!("{} ppm", plain(10f64.powi(6 - decade))),
            };
            let at = self.y(share);
            let _ = writeln!(
                svg,
                "<path class=\"axis\" d=\"M{LEFT} {at}H{WIDTH}\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{name}</text>",
                LEFT - 6.0,
                at + 4.0
            );
        }
    }

    /// Draws the Pearson fit, the limit, and points of the model with their band.
    fn shares(&self, svg: &mut String) {
        let (line, limit) = (self.fit(), self.limit);
        let _ = writeln!(
            svg,
            "<path class=\"line\" d=\"{line}\"/><path class=\"limit\" d=\"M{limit:.1} 2V{}\"/>",
            TALL + 12.0
        );
        let (dots, band) = self.points();
        if !dots.is_empty() {
            let _ = writeln!(
                svg,
                "<polygon class=\"seen-within\" points=\"{}\"/><path class=\"seen\" d=\"{dots}\"/>",
                band.trim_end()
            );
        }
    }

    /// The line of the Pearson fit.
    fn fit(&self) -> String {
        let mut line = String::new();
        for i in 0..=60 {
            let value = self.scale.from + (self.scale.to - self.scale.from) * f64::from(i) / 60.0;
            let share = self.tail.beyond(value);
            if share <= FROM && share >= self.least {
                let start = if line.is_empty() { "M" } else { "L" };
                let _ = write!(line, "{start}{:.1} {:.1}", self.x(value), self.y(share));
            }
        }
        line
    }

    /// Points of the model, and their band.
    fn points(&self) -> (String, String) {
        let shown = || self.tail.seen.iter().filter(|point| point.share >= self.least);
        // Lines without length and with round ends are dots, and shorter than circles. The band is that of two standard errors.
        let (mut dots, mut band) = (String::new(), String::new());
        shown().for_each(|point| {
            let _ = write!(dots, "M{:.1} {:.1}h0", self.x(point.at), self.y(point.share));
        });
        let known: Vec<(&TailPoint, f64)> = shown().filter_map(|point| Some((point, point.error?))).collect();
        for (point, error) in &known {
            let _ = write!(band, "{:.1} {:.1} ", self.x(point.at), self.y(point.share + 2.0 * error));
        }
        for (point, error) in known.iter().rev() {
            let low = (point.share - 2.0 * error).max(self.least);
            let _ = write!(band, "{:.1} {:.1} ", self.x(point.at), self.y(low));
        }
        (dots, band)
    }

    /// Writes the limit below the panel.
    fn limit(&self, svg: &mut String, unit: &str) {
        let limit = self.limit;
        let anchor = if limit > 0.75 * WIDTH {
            "end"
        } else if limit < 0.35 * WIDTH {
            "start"
        } else {
            "middle"
        };
        let _ = writeln!(
            svg,
            "<text class=\"name\" x=\"{limit:.1}\" y=\"{}\" text-anchor=\"{anchor}\">{} {}{}</text>",
            TALL + 25.0,
            self.tail.name,
            plain(self.tail.limit),
            escaped(unit)
        );
    }

    /// Marks the shares of surface and model at the limit.
    fn marks(&self, svg: &mut String) {
        let (limit, least) = (self.limit, self.least);
        if let Some(share) = self.tail.surface.filter(|share| *share > 0.0) {
            let top = self.y(share) - 5.0;
            let _ = writeln!(svg, "<path class=\"of-surface\" d=\"M{limit:.1} {top:.1}l5 5l-5 5l-5 -5z\"/>");
        }
        if let Some((share, error)) = self.tail.model.filter(|(share, error)| share + 2.0 * error > least) {
            let [low, high] = [-2.0, 2.0].map(|by| self.y((share + by * error).max(least)));
            let _ = writeln!(svg, "<path class=\"reach\" d=\"M{limit:.1} {low:.1}V{high:.1}\"/>");
            if share > least {
                let _ = writeln!(svg, "<circle cx=\"{limit:.1}\" cy=\"{:.1}\" r=\"4\"/>", self.y(share));
            }
        }
    }
}

/// Bars from the nominal value to the mean, a step for each cause. Returns None if the two nearly agree, or are unknown.
pub(super) fn shifts(one: &CharacteristicAnalysis, dimensions: &[DimensionReport]) -> Option<String> {
    let (nominal, mean, sigma) = (one.nominal?, one.mean()?, one.sigma()?);
    let seen = SEEN * sigma;
    if !(sigma > 0.0 && (mean - nominal).abs() >= seen) {
        return None;
    }
    let mut found: Vec<(String, f64, String)> = Vec::new();
    for row in &one.sensitivities {
        let Some(dimension) = dimensions.iter().find(|of| of.name == row.dimension) else { continue };
        let off = dimension.mean - dimension.nominal;
        if let Some(first) = row.first.filter(|_| off != 0.0) {
            // Shift from the nominal value to the mean of the dimension, by the derivatives at the mean.
            let moved = first * off - 0.5 * row.second.unwrap_or(0.0) * off * off;
            let one_sided = dimension.tolerance.filter(|[lower, upper]| lower + upper != 0.0);
            let cause = one_sided
                .map_or("its mean is off the nominal value".to_owned(), |ends| format!("tolerance {}", band(ends)));
            found.push((row.dimension.clone(), moved, cause));
        }
        found.extend(row.mean_shift.map(|moved| (row.dimension.clone(), moved, "curvature".to_owned())));
    }
    for pair in one.contributions.interactions.iter() {
        let name = || pair.dimensions.join(" × ");
        found.extend(pair.mean_shift.map(|moved| (name(), moved, "correlation".to_owned())));
    }
    found.retain(|(_, moved, _)| moved.abs() >= seen);
    found.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    found.truncate(SHIFTS);
    let rest = mean - nominal - found.iter().map(|(_, moved, _)| moved).sum::<f64>();
    if rest.abs() >= seen {
        found.push(("all others".to_owned(), rest, "together".to_owned()));
    }
    let mut at = nominal;
    let ends: Vec<[f64; 2]> = (found.iter())
        .map(|(_, moved, _)| {
            let from = at;
            at += moved;
            [from, at]
        })
        .collect();
    let scale = Extent::over(ends.iter().flatten().copied().chain([nominal, mean]), 0.04, 100.0)?;
    let place = |value: f64| vec![(Fill::Span, [(scale.at(value) - 0.3).max(0.0), 0.6])];
    let end = |name: &str, value: f64| Bar {
        name: name.to_owned(),
        parts: place(value),
        text: beside(value, sigma),
        remark: Line::default(),
    };
    let mut rows = vec![end("nominal value", nominal)];
    rows.extend(found.into_iter().zip(ends).map(|((name, moved, cause), [from, to])| {
        let (low, high) = (from.min(to), from.max(to));
        let sign = if moved > 0.0 { "+" } else { "" };
        Bar {
            name,
            parts: vec![(Fill::Span, [scale.at(low), (scale.at(high) - scale.at(low)).max(0.2)])],
            text: format!("{sign}{}", beside(moved, sigma)),
            remark: Line::from(cause),
        }
    }));
    rows.push(end("mean", mean));
    let caption = format!("Shifts of the mean of {} above 1 % of sigma", one.name());
    Some(html::bars(&Bars { caption, rows, marks: Vec::new(), legend: Vec::new() }))
}
