//! The progress of long work: a bar on a terminal, elsewhere a line at intervals.

use std::{
    io::IsTerminal as _,
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use parking_lot::Mutex;

/// The interval between lines where there is no terminal.
const EVERY: Duration = Duration::from_secs(10);

pub(super) struct Progress {
    bar: Option<ProgressBar>,
    what: &'static str,
    total: u64,
    /// Units that an earlier run did.
    first: u64,
    quiet: bool,
    started: Instant,
    said: Instant,
}

impl Progress {
    /// Work of `total` units called `what`; `quiet` shows nothing.
    pub(super) fn new(what: &'static str, total: u64, quiet: bool) -> Self {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let style = ProgressStyle::with_template(
                "{bar:30} {percent:>3}% of {human_len} {msg} [{elapsed} < {eta}]",
            );
            let bar = ProgressBar::new(total);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_message(what);
            bar
        });
        let now = Instant::now();
        Self {
            bar,
            what,
            total,
            first: 0,
            quiet,
            started: now,
            said: now,
        }
    }

    /// Starts at `first` units, which an earlier run did.
    pub(super) fn going_on_at(mut self, first: u64) -> Self {
        self.first = first;
        if let Some(bar) = &self.bar {
            // The time left follows from the work of this run.
            bar.set_position(first);
            bar.reset_eta();
        }
        self
    }

    pub(super) fn reach(&mut self, done: u64, note: &str) {
        if let Some(bar) = &self.bar {
            if !note.is_empty() {
                bar.set_message(format!("{} {note}", self.what));
            }
            bar.set_position(done);
        } else if !self.quiet && Instant::now().saturating_duration_since(self.said) >= EVERY {
            self.said = Instant::now();
            eprintln!("{}", self.line(done, note));
        }
    }

    fn line(&self, done: u64, note: &str) -> String {
        let share = done as f64 / self.total.max(1) as f64;
        let elapsed = self.started.elapsed();
        let here = done.saturating_sub(self.first);
        let left = left(elapsed, here, self.total.saturating_sub(done));
        format!(
            "{:.0}% of {} {} {note} ({} so far, {left})",
            100.0 * share,
            self.total,
            self.what,
            HumanDuration(elapsed),
        )
    }

    pub(super) fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The progress of work on several threads.
pub(super) struct Steps {
    progress: Mutex<Progress>,
    done: AtomicU64,
}

impl Steps {
    /// Begins at `done` units, which an earlier run did.
    pub(super) fn new(progress: Progress, done: u64) -> Self {
        Self {
            progress: Mutex::new(progress.going_on_at(done)),
            done: AtomicU64::new(done),
        }
    }

    pub(super) fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Notes another unit. Threads do not wait for each other to show it.
    pub(super) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if let Some(mut progress) = self.progress.try_lock() {
            progress.reach(done, "");
        }
    }

    pub(super) fn finish(self) {
        self.progress.into_inner().finish();
    }
}

/// The time left at the same speed, in words.
fn left(elapsed: Duration, done: u64, to_do: u64) -> String {
    const YEAR: f64 = 365.25 * 86_400.0;
    let seconds = elapsed.as_secs_f64() * (to_do as f64 / done as f64);
    if done == 0 {
        "the time left is not known yet".into()
    } else if seconds > 100.0 * YEAR {
        "more than 100 years left".into()
    } else {
        format!(
            "about {} left",
            HumanDuration(Duration::from_secs_f64(seconds))
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_the_work_done() {
        let ten = Duration::from_secs(10);
        assert_eq!(left(ten, 1_000, 6_000), "about 60 seconds left");
        assert_eq!(left(ten, 0, 6_000), "the time left is not known yet");
        // 10⁹ points of 10¹⁷: no cap makes this weeks.
        assert_eq!(
            left(ten, 1_000_000_000, 100_000_000_000_000_000),
            "about 32 years left"
        );
        assert_eq!(left(ten, 1, u64::MAX), "more than 100 years left");
    }
}
