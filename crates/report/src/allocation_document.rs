//! The report of an allocation as a document.

mod heading;

use crate::allocation::{
    AllocatedCharacteristic, AllocatedReport, AllocationReport, BeforeAfter, OfCharacteristic, OfDimension,
};
use crate::analysis::analysis_document::CharacteristicSections;
use crate::document::number::{
    beside, index, known, plain, power_of_ten, share, short, significant, target_yield, yielded,
};
use crate::document::{
    Bar, Bars, Blocks, Cell, Chart, Columns, DataTable, Document, Element, Fill, Flow, Layer, Line, Paragraph, Plot,
    PlotAxis, PlotPoint, PlotScale, Section, Stroke, Tone, Value,
};
use crate::figures::{Figures, Named};
use crate::overview::verdict;
use crate::requirement::{axis_place, brief, demand, found, front_label, loud, measure};
use sensitol::allocation::{
    Allocated, Attainable, Bound, FrontRequirement, JointYield, Kept, Moved, ShadowPrice, Status,
};
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_numeric::json_form::finite;
use sensitol_numeric::verdict::{Judged, Verdict};

/// Significant digits of a cost.
const COST: usize = 5;
/// Greatest number of labels on the yield axis of the front. With more, only powers of ten of the rejects are labelled.
const LABELS: usize = 6;
/// Greatest number of dimensions named as the reason why a requirement cannot be kept.
const NAMED: usize = 5;

/// Bars of a quantity before and after a change.
fn bars_of_change(caption: &str, rows: Vec<Bar>) -> Bars {
    let legend = vec![(Fill::Before, "before"), (Fill::After, "after")];
    Bars { caption: caption.to_owned(), rows, marks: Vec::new(), legend }
}

/// Row of a quantity before and after a change, on a scale up to `greatest`.
fn changed(name: &str, amounts: [Option<f64>; 2], greatest: f64, text: String) -> Bar {
    let width = |amount: Option<f64>| (1e4 * (amount.unwrap_or(0.0) / greatest).clamp(0.0, 1.0)).round() / 1e2;
    let parts = [Fill::Before, Fill::After].into_iter().zip(amounts).map(|(fill, amount)| (fill, [0.0, width(amount)]));
    Bar { name: name.to_owned(), parts: parts.collect(), text, remark: Line::default() }
}

impl AllocationReport {
    /// Builds the document: result and cost, tolerances (table `tolerances`), requirements (table `requirements`), characteristics, the
    /// front (table `front`), and the entries to paste into the study.
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        self.heading(&mut document.head);
        self.attainable.iter().for_each(|one| unattainable(&mut document.head, one, self.status == Status::Infeasible));
        // If no tolerances were found, the table is hidden, but CSV still has its header.
        let mut tolerances = self.tolerances();
        if self.cost_after.is_none() {
            tolerances.view.clear();
        }
        let mut section = Section::default();
        section.table(self.before_after());
        document.sections.push(section);
        let groups = [vec![tolerances], vec![self.recentred()], vec![self.requirements()]];
        for (group, tables) in groups.into_iter().enumerate() {
            let shown = tables.iter().any(|table| !table.view.is_empty());
            let mut section = Section::default();
            tables.into_iter().for_each(|table| section.table(table));
            if group == 0 && shown {
                section.aside("", vec![Element::Chart(Chart::Bars(self.tolerance_bars()))]);
            }
            if group == 0 && shown && self.paid() > 0.0 {
                section.aside("Costs", vec![Element::Chart(Chart::Bars(self.costs()))]);
            }
            if group == 2 {
                self.joint_required(&mut section);
                self.shadow_prices.iter().for_each(|price| self.prices(&mut section, price));
                self.bound_prices(&mut section);
            }
            match shown {
                true => document.sections.push(section),
                false => document.head.extend(section.blocks),
            }
        }
        let mut section = Section::default();
        self.loosest(&mut section);
        self.joint(&mut section);
        self.confirmed_by_samples(&mut section);
        section.table(self.front_points());
        document.sections.push(section);
        if !self.front.is_empty() {
            let mut section = Section::default();
            section.chart(Chart::Plot(self.plot()));
            section.table(self.front_table());
            document.sections.push(section);
        }
        if let Some(entries) = &self.dimensions_table {
            // Entries of features come with the heading of their part.
            let heading = if entries.starts_with('[') { "" } else { "[dimensions]\n" };
            let text = format!("{heading}{}", entries.trim_end_matches('\n'));
            let mut section = Section::default();
            section.blocks.push(Element::Paragraph(Paragraph { line: text.into(), indent: 0, flow: Flow::Verbatim }));
            document.sections.push(section);
        }
        document
    }

    fn status_tone(&self) -> Tone {
        match self.status {
            Status::Optimal | Status::LocalOptimum => Tone::Good,
            Status::Infeasible | Status::NoFeasiblePointFound => Tone::Bad,
            _ => Tone::Doubtful,
        }
    }

    fn tolerances(&self) -> DataTable {
        let side = |band: Option<[f64; 2]>, end: usize| Cell::data(band.map(|band| band[end]));
        let most = |one: &AllocatedReport, of: &dyn Fn(&BeforeAfter<Option<f64>>) -> Option<f64>| {
            let share = one.contributions.iter().filter_map(|one| of(&one.of)).reduce(f64::max);
            Cell::number(share, |share| format!("{:.1}", 100.0 * share))
        };
        let shares = if self.characteristics.len() == 1 { "share %" } else { "most %" };
        Columns::default()
            .named("dimension", "dimension", |one: &&AllocatedReport| Cell::name(&one.of.dimension))
            .data("unit", |one| Cell::optional(one.of.unit.as_deref()))
            .column("before", "before", |one| {
                Cell::both(Value::Number(Some(one.of.of.before)), band(one.of.of.before, one.deviations.before))
            })
            .column("after", "after", |one| {
                Cell::both(Value::Number(Some(one.of.of.after)), band(one.of.of.after, one.deviations.after))
            })
            .shown("", |one| Cell::optional(one.of.unit.as_deref()))
            .data("lower_before", move |one| side(one.deviations.before, 0))
            .data("upper_before", move |one| side(one.deviations.before, 1))
            .data("lower_after", move |one| side(one.deviations.after, 0))
            .data("upper_after", move |one| side(one.deviations.after, 1))
            .column("cost_before", "cost", |one| Cell::number(one.of.of.cost_before, money))
            .column("cost_after", "after", |one| Cell::number(one.of.of.cost_after, money))
            .shown(shares, move |one| most(one, &|one| one.before))
            .shown("after", move |one| most(one, &|one| one.after))
            .data("process", |one| Cell::optional(one.of.of.process.as_deref()))
            .data("at_bound", |one| Cell::optional(one.of.of.bound.map(bound)))
            .data("bound_price", |one| Cell::data(one.of.of.bound_price))
            .shown("", |one| {
                let bound = one.of.of.bound.map(|of| format!("at its {}", bound(of)));
                Cell::text(one.of.of.process.clone().into_iter().chain(bound).collect::<Vec<_>>().join(", "))
            })
            .table("tolerances", &self.tolerances)
    }

    /// Adds the saving for each tolerance at its bound if that bound is moved by 1 % of the tolerance.
    fn bound_prices(&self, section: &mut Section) {
        /// Dimensions that fit on one line.
        const MOST: usize = 3;
        let mut priced: Vec<(&str, f64)> = (self.tolerances.iter())
            .filter_map(|one| Some((one.of.dimension.as_str(), 0.01 * one.of.of.after * one.of.of.bound_price?)))
            .filter(|(_, saves)| *saves > 0.0)
            .collect();
        priced.sort_by(|a, b| b.1.total_cmp(&a.1));
        let named = priced.iter().take(MOST).map(|(name, saves)| format!("{} {}", short(name), significant(*saves, 3)));
        let named: Vec<String> = named.collect();
        if !named.is_empty() {
            let more = if priced.len() > MOST { ", ..." } else { "" };
            section.note(format!("shadow price of a bound, per 1 % of it: {}{more}", named.join(", ")));
        }
    }

    /// Adds the required joint yield with the values before, after and sampled.
    fn joint_required(&self, section: &mut Section) {
        let Some(one) = &self.joint_requirement else { return };
        let said = Line::from(format!(
            "joint yield {}: {} before, ",
            target_yield(one.requirement.amount()),
            found(&one.before)
        ));
        let said = match &one.after {
            Some(after) => said.and(format!("{} after, ", found(after))).and(loud(after.verdict)),
            None => said.and(loud(one.before.verdict)),
        };
        section.line(match &one.sampled {
            Some(sampled) => said.and(format!("; by a sample {}, ", found(sampled))).and(loud(sampled.verdict)),
            None => said,
        });
    }

    /// Returns the highest cost of a dimension, before or after.
    fn paid(&self) -> f64 {
        let costs = self.tolerances.iter().flat_map(|one| [one.of.of.cost_before, one.of.of.cost_after]);
        costs.flatten().fold(0.0, f64::max)
    }

    /// Builds bars of the cost of every dimension before and after.
    fn costs(&self) -> Bars {
        let highest = self.paid();
        let row = |one: &AllocatedReport| {
            let Allocated { cost_before, cost_after, .. } = one.of.of;
            let text = format!("{} → {}", known(cost_before, money), known(cost_after, money));
            changed(&one.of.dimension, [cost_before, cost_after], highest, text)
        };
        bars_of_change("Cost of every dimension, before and after", self.tolerances.iter().map(row).collect())
    }

    /// Builds bars of the tolerance of every dimension before and after. Dimensions with the same unit have one scale.
    fn tolerance_bars(&self) -> Bars {
        let row = |one: &AllocatedReport| {
            let alike = self.tolerances.iter().filter(|other| other.of.unit == one.of.unit);
            let greatest = alike.flat_map(|other| [other.of.of.before, other.of.of.after]).fold(0.0, f64::max);
            let Allocated { before, after, .. } = one.of.of;
            let unit = one.of.unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
            let deviations = &one.deviations;
            let text = format!("{} → {}{unit}", band(before, deviations.before), band(after, deviations.after));
            changed(&one.of.dimension, [Some(before), Some(after)], greatest, text)
        };
        bars_of_change("Tolerance of every dimension, before and after", self.tolerances.iter().map(row).collect())
    }

    fn recentred(&self) -> DataTable {
        Columns::default()
            .shown("nominal", |one: &&OfDimension<Moved>| Cell::name(&one.dimension))
            .shown("before", |one| Cell::number(one.of.before, plain))
            .shown("after", |one| Cell::number(one.of.after, |after| beside(after, (after - one.of.before).abs())))
            .shown("", |one| Cell::optional(one.unit.as_deref()))
            .table("", &self.recentred)
    }

    fn requirements(&self) -> DataTable {
        let price = |one: &OfCharacteristic<Kept>, of: fn(&ShadowPrice) -> Option<f64>| {
            let own = self.shadow_prices.iter().find(|price| price.characteristic == one.characteristic);
            Cell::data(own.and_then(|price| of(&price.of)))
        };
        let truth = |met: Option<bool>| Cell::both(Value::Truth(met), "");
        Columns::default()
            .column("characteristic", "required", |one: &&OfCharacteristic<Kept>| Cell::name(&one.characteristic))
            .data("requirement", |one| Cell::text(one.of.requirement.key()))
            .data("required", |one| Cell::data(one.of.requirement.amount()))
            .shown("", |one| Cell::text(brief(one.of.requirement)))
            .column("before", "before", |one| measured(Some(&one.of.before)))
            .column("after", "after", |one| measured(one.of.after.as_ref()))
            .data("met_before", move |one| truth(one.of.before.verdict.met()))
            .data("met", move |one| truth(one.of.after.and_then(|after| after.verdict.met())))
            .column("verdict", "", |one| {
                let verdict = one.of.after.map(|after| after.verdict);
                let value = verdict.map_or(Value::Empty, |verdict| Value::Text(Verdict::name(verdict).to_owned()));
                let before = loud(one.of.before.verdict).and(" before");
                // Without a result after the allocation there is only the verdict before.
                Cell::both(value, verdict.map_or(before.clone(), |verdict| loud(verdict).and(", ").and(before)))
            })
            .data("price_both", move |one| price(one, |price| price.both))
            .data("price_lower", move |one| price(one, |price| price.lower))
            .data("price_upper", move |one| price(one, |price| price.upper))
            .data("price_sigma", move |one| price(one, |price| price.sigma))
            .table("requirements", &self.requirements)
    }

    /// Adds the shadow prices per step of a readable size: 1 um for mm, else a power of ten below sigma.
    fn prices(&self, section: &mut Section, price: &OfCharacteristic<ShadowPrice>) {
        let one = self.characteristics.iter().find(|one| one.name == price.characteristic);
        let unit = one.and_then(|one| one.unit.as_deref());
        let sigma = one.and_then(|one| one.after.as_ref().or(Some(&one.before))).and_then(|after| after.sigma());
        let step = match unit {
            Some("mm") => 0.001,
            _ => power_of_ten(sigma.filter(|sigma| *sigma > 0.0).map_or(0.0, libm::log10).floor() - 1.0),
        };
        let by = format!("{}{}", plain(step), unit.map(|unit| format!(" {unit}")).unwrap_or_default());
        let part =
            |what: &str, price: Option<f64>| price.map(|price| format!("{what} {}", significant(price * step, 3)));
        if price.of.both.is_none() && price.of.sigma.is_none() && price.of.widen != price.of.narrow {
            let saved = match price.of.widen {
                Some(0.0) => {
                    "nothing for wider limits alone, because another requirement holds the cost too".to_owned()
                }
                Some(widen) => format!("{} for wider limits", significant(widen * step, 3)),
                None => "unknown for wider limits alone".to_owned(),
            };
            let lost = price.of.narrow.map(|narrow| format!("; {} for narrower ones", significant(narrow * step, 3)));
            let name = short(&price.characteristic);
            section.note(format!("shadow price of {name} per {by}: {saved}{}", lost.unwrap_or_default()));
            return;
        }
        let two = one.is_some_and(|one| one.before.lower().is_some() && one.before.upper().is_some());
        let all = [
            part("both limits", price.of.both.filter(|_| two)),
            part("lower limit", price.of.lower),
            part("upper limit", price.of.upper),
            part("sigma", price.of.sigma),
        ];
        let all: Vec<String> = all.into_iter().flatten().collect();
        if !all.is_empty() {
            section.note(format!("shadow price of {} per {by}: {}", short(&price.characteristic), all.join(", ")));
        }
    }

    fn before_after(&self) -> DataTable {
        type Row<'r> = (Option<&'r AllocatedCharacteristic>, &'static str, &'r CharacteristicAnalysis);
        let rows = self.characteristics.iter().flat_map(|one| {
            let after = one.after.as_ref().map(|after| (None, "after", after));
            std::iter::once((Some(one), "before", &one.before)).chain(after)
        });
        let name = |one: &AllocatedCharacteristic| {
            let unit = one.unit.as_deref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
            Cell::text(format!("{}{unit}", short(&one.name)))
        };
        let scaled = |of: &CharacteristicAnalysis, value: Option<f64>| {
            Cell::number(value, |value| beside(value, of.sigma().unwrap_or(0.0)))
        };
        Columns::default()
            .shown("", move |row: &Row<'_>| row.0.map_or_else(Cell::empty, name))
            .shown("", |row| Cell::text(row.1))
            .shown("mean", move |row| scaled(row.2, row.2.mean()))
            .shown("sigma", move |row| scaled(row.2, row.2.sigma()))
            .shown("Cpk", |row| Cell::known(row.2.distribution.capability.and_then(|of| of.cpk), index))
            .shown("yield", |row| Cell::known(row.2.yield_(), |_| row.2.rejects().yield_text().unwrap_or_default()))
            .terminal(!self.requirements.is_empty(), "verdict", |row| {
                let kept = self.requirements.iter().filter(|kept| kept.characteristic == row.2.name());
                let judged =
                    kept.filter_map(|kept| if row.1 == "before" { Some(kept.of.before) } else { kept.of.after });
                Cell { line: verdict(&judged.collect::<Vec<_>>()), ..Cell::empty() }
            })
            .table("", rows)
    }

    fn loosest(&self, section: &mut Section) {
        if self.requirements.is_empty() {
            return;
        }
        let of = |factor: Option<f64>| factor.map_or("no one factor".to_owned(), |factor| format!("{factor:.4}"));
        let before = of(self.loosest_scaling.before);
        section.line(match self.loosest_scaling.after {
            None if self.cost_after.is_some() => {
                format!("margin of the tolerances before: they can be scaled by {before}")
            }
            None => format!("margin: tolerances can be scaled by {before} before a requirement fails"),
            after => format!("margin: tolerances can be scaled by {}; those before by {before}", of(after)),
        });
    }

    fn joint(&self, section: &mut Section) {
        let of = |joint: &JointYield| {
            let error = joint.standard_error.map(|error| format!(" ± {}", significant(100.0 * error, 2)));
            format!("{:.4}{} %", 100.0 * joint.value, error.unwrap_or_default())
        };
        let text = match [&self.joint_yield.before, &self.joint_yield.after].map(|joint| joint.as_ref().map(of)) {
            [Some(before), Some(after)] => format!("{before} before, {after} after"),
            [Some(one), None] | [None, Some(one)] => one,
            [None, None] => return,
        };
        section.line(format!("all limits at once are kept by {text} (sampled from the surrogates, standard error)"));
    }

    fn confirmed_by_samples(&self, section: &mut Section) {
        let Some(confirmation) = &self.confirmation else { return };
        for one in &confirmation.characteristics {
            let Some(share) = one.yield_ else { continue };
            let [low, high] = one.yield_interval().unwrap_or(share.interval).map(yielded);
            let (name, value, points) = (short(one.name()), yielded(share.value), confirmation.samples);
            section.line(format!(
                "{name}: {value} of {points} points of the model keep the limits, 95 % interval {low} .. {high}"
            ));
        }
    }

    /// Table of the front for pages and terminals.
    fn front_table(&self) -> DataTable {
        type Row<'r> = (&'r FrontRequirement, Option<f64>);
        let rows = self.front.iter().filter_map(|point| Some((point.required.first()?, point.cost)));
        Columns::default()
            .shown("required", |(first, _): &Row<'_>| Cell::text(front_label(first.requirement, first.amount)))
            .shown("cost", |(_, cost)| Cell::number(*cost, money))
            .shown("", |(_, cost)| Cell::text(if cost.is_none() { "cannot be kept" } else { "" }).toned(Tone::Bad))
            .table("", rows)
    }

    /// Table of the front for CSV: a row for every dimension at every point.
    fn front_points(&self) -> DataTable {
        type Row<'r> = (u64, &'r FrontRequirement, Option<f64>, Option<(&'r str, f64)>);
        let rows = self.front.iter().enumerate().flat_map(|(place, point)| {
            point.required.iter().flat_map(move |wanted| {
                let names = self.tolerances.iter().map(|one| one.of.dimension.as_str());
                let held = point.tolerances.iter().flat_map(move |all| names.clone().zip(all));
                let held = held.map(|(name, &tolerance)| Some((name, tolerance)));
                let none = point.tolerances.is_none().then_some(None);
                held.chain(none).map(move |tolerance| (place as u64 + 1, wanted, point.cost, tolerance))
            })
        });
        Columns::default()
            .data("point", |row: &Row<'_>| Cell::count(row.0))
            .data("characteristic", |row| Cell::text(&row.1.characteristic))
            .data("requirement", |row| Cell::text(row.1.requirement.key()))
            .data("required", |row| Cell::data(row.1.amount))
            .data("cost", |row| Cell::data(row.2))
            .data("dimension", |row| Cell::optional(row.3.map(|(name, _)| name)))
            .data("tolerance", |row| Cell::data(row.3.map(|(_, tolerance)| tolerance)))
            .table("front", rows)
    }

    /// Plots cost over the requirement: the logarithm of the reject rate for a yield, the required value otherwise. The open circle shows
    /// the requirement and the cost at the tolerances before.
    fn plot(&self) -> Plot {
        let front: Vec<(f64, f64, String)> = (self.front.iter())
            .filter_map(|point| {
                let wanted = point.required.first()?;
                let (place, label) = axis_place(wanted.requirement, wanted.amount);
                Some((place, point.cost?, label))
            })
            .collect();
        let first = self.front.first().and_then(|point| point.required.first());
        let before = first.and_then(|FrontRequirement { characteristic, requirement: first, .. }| {
            let one = self.requirements.iter().find(|one| one.characteristic == *characteristic)?;
            let (had, cost) = (one.of.before.value.and_then(finite)?, self.cost_before?);
            let seen = had < 1.0 - 1e-12 || first.target_yield().is_none();
            seen.then(|| [axis_place(*first, had).0, cost])
        });
        let circle = |at: [f64; 2], strong: bool, name: &str, tip: String| PlotPoint {
            at,
            name: name.to_owned(),
            tip,
            strong,
            filled: strong,
        };
        let points = front.iter().map(|(place, cost, label)| {
            circle([*place, *cost], true, "", format!("{label}: {}", significant(*cost, 6)))
        });
        let points = points.chain(before.map(|at| circle(at, false, "before", String::new()))).collect();
        let mut x = PlotAxis::new(
            format!("{} required", first.map_or("yield", |wanted| wanted.requirement.key())),
            PlotScale::Linear(0.05),
        );
        if first.is_some_and(|wanted| wanted.requirement.target_yield().is_some()) {
            let places = front.iter().map(|(place, ..)| *place);
            x.ticks = round_yields(places.clone().fold(f64::INFINITY, f64::min), places.fold(0.0, f64::max));
        }
        let line = front.iter().map(|(place, cost, _)| (*place, Some(*cost))).collect();
        Plot {
            name: self.head.title.clone().unwrap_or_else(|| "Cost against what is required".to_owned()),
            x,
            y: PlotAxis::new("cost", PlotScale::Linear(0.05)),
            layers: vec![Layer::Curve(line, Stroke::Thin), Layer::Points(points)],
            words: "Filled: the cheapest tolerances that keep the requirements. Open: what the tolerances before keep and cost.".to_owned(),
        }
    }
}

fn money(cost: f64) -> String {
    significant(cost, COST)
}

fn unattainable(
    page: &mut Vec<Element>,
    OfCharacteristic { characteristic, of: one }: &OfCharacteristic<Attainable>,
    proven: bool,
) {
    let (name, required) = (short(characteristic), demand(one.requirement));
    let best = one.best.map_or("unknown".to_owned(), |best| measure(one.requirement, best));
    page.line(match proven {
        true => format!("`{name}` cannot keep {required}: the best that there is is {best}"),
        false => format!("no tolerances were found with which `{name}` keeps {required}: the best found is {best}"),
    });
    if one.together {
        page.line(match proven {
            true => "it could by itself: together with the other requirements it cannot",
            false => "by itself it is kept: together with the other requirements no such tolerances were found",
        });
    }
    if !one.because.is_empty() {
        let names: Vec<String> = one.because.iter().take(NAMED).map(|name| format!("`{}`", short(name))).collect();
        let more = if one.because.len() > NAMED { ", ..." } else { "" };
        page.line(format!("dimensions without a cost break it by themselves: {}{more}", names.join(", ")));
    }
}

fn measured(judged: Option<&Judged>) -> Cell {
    let value = judged.and_then(|judged| judged.value).and_then(finite);
    Cell::number(value, |_| judged.map_or_else(String::new, found))
}

fn bound(bound: Bound) -> &'static str {
    match bound {
        Bound::Least => "min",
        Bound::Greatest => "max",
    }
}

/// Returns labelled round yields between two places of the axis: 90 %, 95 %, 98 %, 99 % and so on. If these are too many, only powers of
/// ten of the rejects remain.
fn round_yields(from: f64, to: f64) -> Vec<(f64, String)> {
    let rejected = (1..=12).flat_map(|decade| [1.0, 0.5, 0.2].map(|digit| digit * 10f64.powi(-decade)));
    let all: Vec<f64> = rejected.filter(|rejected| (from..=to).contains(&-libm::log10(*rejected))).collect();
    let whole = |rejected: &&f64| (libm::log10(**rejected) - libm::log10(**rejected).round()).abs() < 1e-9;
    let decades: Vec<f64> = all.iter().filter(whole).copied().collect();
    let label = |rejected: f64| {
        let percent = 100.0 * rejected;
        // Decimals that show the single digit of the rejects.
        let decimals = (-libm::log10(percent * (1.0 + 1e-9)).floor()).max(0.0) as usize;
        (-libm::log10(rejected), format!("{:.decimals$} %", 100.0 - percent))
    };
    match (all.len() > LABELS && decades.len() > 1, all.is_empty()) {
        (true, _) => decades.into_iter().map(label).collect(),
        // The front spans less than one step: label its ends.
        (false, true) => [from, to].map(|place| (place, share(libm::pow(10f64, -place)))).into(),
        (false, false) => all.into_iter().map(label).collect(),
    }
}

/// Formats a tolerance band as on drawings: `±` if it is symmetric, else both deviations.
fn band(half: f64, deviations: Option<[f64; 2]>) -> String {
    let signed = |value: f64| format!("{}{}", if value >= 0.0 { "+" } else { "" }, significant(value, 4));
    match deviations {
        Some([lower, upper]) if (lower + upper).abs() > 1e-9 * half => format!("{} / {}", signed(lower), signed(upper)),
        _ => format!("± {}", significant(half, 4)),
    }
}
