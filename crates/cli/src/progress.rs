//! Progress bars on a terminal.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use sensitol::assembly::Progress;
use sensitol::simulation::Pace;

/// Interval of frames. A model may be silent for longer than a reader of the bar waits.
const FRAME: Duration = Duration::from_millis(200);
/// Greatest number of moments that a meter keeps: the middle of the run is then located within 3 % of its length.
const KEPT: usize = 128;
/// Least run of a meter, in seconds. The start of processes and caches rules the time before.
const LEAST_S: f64 = 1.0;
/// Least points in either half of the run: the spread of a rate of so few is some 30 %.
const LEAST_POINTS: u64 = 5;

/// Speed of a run, measured over its two halves.
#[derive(Default)]
struct Meter {
    /// Seconds since the start and points done by then.
    last: (f64, u64),
    /// Earlier moments, evenly spread over the run.
    moments: Vec<(f64, u64)>,
    /// Least seconds between two of them.
    spacing: f64,
}

impl Meter {
    /// Notes the number of points done at this time.
    fn note(&mut self, seconds: f64, points: u64) {
        self.last = (seconds, points);
        if self.moments.last().is_some_and(|(at, _)| seconds - at < self.spacing) {
            return;
        }
        self.moments.push(self.last);
        // Every second moment goes, and the later ones come half as often.
        if self.moments.len() == KEPT {
            let mut place = 0;
            self.moments.retain(|_| {
                place += 1;
                place % 2 == 0
            });
            self.spacing = 2.0 * seconds / KEPT as f64;
        }
    }

    /// Points a second since the start. None before the first measurable time.
    fn rate(&self) -> Option<f64> {
        let (seconds, points) = self.last;
        (seconds > 0.0 && points > 0).then(|| points as f64 / seconds)
    }

    /// Seconds for this many further points. None unless the two halves of the run agree within a factor of two.
    fn left_s(&self, more: u64) -> Option<f64> {
        let (seconds, points) = self.last;
        let &(half_s, half) = self.moments.iter().rev().find(|(at, _)| *at <= seconds / 2.0)?;
        let enough = seconds >= LEAST_S && half >= LEAST_POINTS && points - half.min(points) >= LEAST_POINTS;
        if !enough || half_s <= 0.0 {
            return None;
        }
        let (first, second) = (half as f64 / half_s, (points - half) as f64 / (seconds - half_s));
        let alike = first <= 2.0 * second && second <= 2.0 * first;
        alike.then(|| more as f64 / second)
    }

    /// Rate and time left for this many further points, as far as they are known.
    fn text(&self, more: Option<u64>) -> String {
        let rate = self.rate().map(|rate| format!(", {}/s", two_digits(rate))).unwrap_or_default();
        let left = more.filter(|more| *more > 0).and_then(|more| self.left_s(more));
        rate + &left.map(|left| format!(", {} left", duration(left))).unwrap_or_default()
    }
}

/// Number with two digits that count.
fn two_digits(value: f64) -> String {
    let exponent = value.abs().max(f64::MIN_POSITIVE).log10().floor();
    let unit = 10f64.powf(exponent - 1.0);
    let decimals = (1.0 - exponent).max(0.0) as usize;
    format!("{:.decimals$}", (value / unit).round() * unit)
}

/// Duration with two digits that count, in the unit that gives the shortest number.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "1 s".to_owned(),
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{} min", two_digits(s / 60.0)),
        s if s < 360_000.0 => format!("{} h", two_digits(s / 3600.0)),
        s => format!("{} d", two_digits(s / 86_400.0)),
    }
}

/// Bar with a count and a message.
fn bar(length: Option<u64>, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(length, target);
    style(&bar, "{bar:30} {pos}/{len} points{msg}");
    bar
}

fn style(bar: &ProgressBar, template: &str) {
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
}

/// Progress of evaluations. Invisible if stderr is not a terminal.
pub(super) struct Bar {
    bar: ProgressBar,
    planned: u64,
    begun: Instant,
    so_far: Mutex<(Progress, Meter)>,
}

impl Bar {
    /// Starts a bar for this many planned points.
    pub(super) fn new(points: usize, quiet: bool) -> Self {
        let planned = points as u64;
        let bar = bar(Some(planned), quiet);
        if !bar.is_hidden() {
            bar.enable_steady_tick(FRAME);
        }
        Self { bar, planned, begun: Instant::now(), so_far: Mutex::default() }
    }

    pub(super) fn show(&self, more: Progress) {
        let Ok(mut so_far) = self.so_far.lock() else { return };
        let (points, meter) = &mut *so_far;
        points.points += more.points;
        points.failed += more.failed;
        points.reused += more.reused;
        // Known answers cost no time, and say nothing about the speed of the model.
        meter.note(self.begun.elapsed().as_secs_f64(), points.points.saturating_sub(points.reused) as u64);
        let done = points.points as u64;
        let beyond = done > self.planned;
        if beyond {
            // A search may need more points than planned. How many is not known, so that neither a total nor a full bar is shown.
            style(&self.bar, "{pos} points{msg}");
        }
        self.bar.set_message(message(points, meter, self.planned));
        self.bar.set_position(done);
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// Text behind the count: the planned number if it is passed, the speed, and the numbers of failed and of known points.
fn message(so_far: &Progress, meter: &Meter, planned: u64) -> String {
    let part = |count: usize, what: &str| if count == 0 { String::new() } else { format!(", {count} {what}") };
    let more = planned.checked_sub(so_far.points as u64);
    let plan = if more.is_none() { format!(", {planned} planned") } else { String::new() };
    plan + &meter.text(more) + &part(so_far.failed, "failed") + &part(so_far.reused, "known")
}

/// Progress of a simulation. Invisible if stderr is not a terminal.
pub(super) struct Samples {
    bar: ProgressBar,
    meter: Mutex<Meter>,
}

impl Samples {
    /// Starts a bar whose length is known with the first points.
    pub(super) fn new(quiet: bool) -> Self {
        Self { bar: bar(None, quiet), meter: Mutex::default() }
    }

    pub(super) fn show(&self, pace: &Pace) {
        let Ok(mut meter) = self.meter.lock() else { return };
        let expected = pace.expected as u64;
        meter.note(pace.elapsed.as_secs_f64(), pace.samples);
        self.bar.set_length(expected.max(pace.samples));
        self.bar.set_message(meter.text(expected.checked_sub(pace.samples)));
        self.bar.set_position(pace.samples);
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Meter of a run with these counts, one a second.
    fn meter(counts: impl IntoIterator<Item = u64>) -> Meter {
        let mut meter = Meter::default();
        counts.into_iter().enumerate().for_each(|(second, count)| meter.note(second as f64, count));
        meter
    }

    fn progress(points: usize, failed: usize, reused: usize) -> Progress {
        let mut progress = Progress::default();
        (progress.points, progress.failed, progress.reused) = (points, failed, reused);
        progress
    }

    /// The first frame claims nothing: no rate, and never that no time is left.
    #[test]
    fn nothing_is_known_at_first() {
        assert_eq!(message(&progress(0, 0, 0), &Meter::default(), 61), "");
        assert_eq!(message(&progress(1, 0, 0), &meter([1]), 61), "");
        assert_eq!(message(&progress(9, 0, 0), &meter([0, 9]), 61), ", 9.0/s");
    }

    /// A steady run has an estimate of its time left, which is exact for a constant rate.
    #[test]
    fn a_steady_run_knows_its_end() {
        let steady = meter((0..=20).map(|second| 3 * second));
        assert_eq!(steady.text(Some(90)), ", 3.0/s, 30 s left");
        assert_eq!(message(&progress(60, 2, 0), &steady, 360), ", 3.0/s, 1.7 min left, 2 failed");
        assert_eq!(steady.text(Some(0)), ", 3.0/s");
    }

    /// A run whose halves differ by more than a factor of two has no estimate of its end.
    #[test]
    fn an_uneven_run_does_not() {
        let slowing = meter((0..=20).map(|second| if second <= 10 { 10 * second } else { 100 + 4 * (second - 10) }));
        assert_eq!(slowing.text(Some(90)), ", 7.0/s");
        let hurrying = meter((0..=20).map(|second| if second <= 10 { second } else { 10 + 5 * (second - 10) }));
        assert_eq!(hurrying.text(Some(90)), ", 3.0/s");
        // Within a factor of two it does, at the rate of the second half.
        let easing = meter((0..=20).map(|second| if second <= 10 { 10 * second } else { 100 + 6 * (second - 10) }));
        assert_eq!(easing.text(Some(90)), ", 8.0/s, 15 s left");
    }

    /// Points beyond the plan have neither a total nor a time left.
    #[test]
    fn a_passed_plan_is_named() {
        let steady = meter((0..=20).map(|second| 3 * second));
        assert_eq!(message(&progress(62, 0, 2), &steady, 61), ", 61 planned, 3.0/s, 2 known");
    }

    /// A long run keeps few moments, and still finds its middle.
    #[test]
    fn a_meter_stays_small() {
        let long = meter((0..100_000).map(|second| 2 * second));
        assert!(long.moments.len() <= KEPT);
        let left = long.left_s(2000).unwrap();
        assert!((left - 1000.0).abs() < 1e-9, "{left}");
    }

    #[test]
    fn numbers_have_two_digits() {
        let rates = [0.001234, 0.0994, 1.0, 9.94, 23.4, 12_345.6, 987_654.0].map(two_digits);
        assert_eq!(rates, ["0.0012", "0.099", "1.0", "9.9", "23", "12000", "990000"]);
        let times = [0.2, 7.4, 99.4, 130.0, 3600.0, 9000.0, 400_000.0].map(duration);
        assert_eq!(times, ["1 s", "7 s", "99 s", "2.2 min", "60 min", "2.5 h", "4.6 d"]);
    }
}
