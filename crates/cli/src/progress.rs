//! Progress bars on a terminal.

use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use sensitol::assembly::Progress;
use sensitol::simulation::Pace;

/// Progress of evaluations. Invisible if stderr is not a terminal.
pub(super) struct Bar {
    bar: ProgressBar,
    so_far: Mutex<Progress>,
}

impl Bar {
    /// Starts a bar for this many points. Repeated points make it longer.
    pub(super) fn new(points: usize, quiet: bool) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(points as u64), target);
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} points, {per_sec}, {eta} left{msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        Self { bar, so_far: Mutex::new(Progress::default()) }
    }

    pub(super) fn show(&self, more: Progress) {
        let Ok(mut so_far) = self.so_far.lock() else { return };
        so_far.points += more.points;
        so_far.failed += more.failed;
        so_far.reused += more.reused;
        let part = |count: usize, what: &str| if count == 0 { String::new() } else { format!(", {count} {what}") };
        self.bar.set_message(part(so_far.failed, "failed") + &part(so_far.reused, "known"));
        // A search may need more points than planned: the bar grows.
        if self.bar.length().is_some_and(|length| length < so_far.points as u64) {
            self.bar.set_length(so_far.points as u64);
        }
        self.bar.set_position(so_far.points as u64);
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// Progress of a simulation. Invisible if stderr is not a terminal.
pub(super) struct Samples {
    bar: ProgressBar,
}

impl Samples {
    pub(super) fn new(quiet: bool) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(1), target);
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} points, {per_sec}, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar }
    }

    pub(super) fn show(&self, pace: &Pace) {
        self.bar.set_length(pace.expected as u64);
        self.bar.set_position(pace.samples);
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
