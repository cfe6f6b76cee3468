//! The lines that a process prints.

use std::{
    collections::VecDeque,
    io::{BufRead as _, BufReader, Read},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::JoinHandle,
    time::Instant,
};

use crate::wait::PATIENCE;

/// The number of lines kept; a daemon that runs for hours may log more.
const KEPT: usize = 10_000;

/// The lines of a pipe. A thread reads them as they come, so the process never waits for a reader.
pub struct Output {
    shared: Arc<Shared>,
    reader: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    lines: Mutex<Lines>,
    changed: Condvar,
}

#[derive(Default)]
struct Lines {
    kept: VecDeque<String>,
    /// How many of the kept lines [`Output::next`] has passed.
    passed: usize,
    is_closed: bool,
}

impl Shared {
    fn lines(&self) -> MutexGuard<'_, Lines> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, line: String) {
        let mut lines = self.lines();
        if lines.kept.len() == KEPT {
            lines.kept.pop_front();
            lines.passed = lines.passed.saturating_sub(1);
        }
        lines.kept.push_back(line);
        self.changed.notify_all();
    }
}

impl Output {
    /// Reads `pipe` until it is closed.
    pub fn of(pipe: impl Read + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let reader = std::thread::spawn({
            let shared = shared.clone();
            move || {
                let mut lines = BufReader::new(pipe).split(b'\n');
                while let Some(Ok(line)) = lines.next() {
                    shared.push(String::from_utf8_lossy(&line).trim_end().to_owned());
                }
                shared.lines().is_closed = true;
                shared.changed.notify_all();
            }
        });
        let reader = Some(reader);
        Self { shared, reader }
    }

    /// Waits for the next line that contains `part`, passing over others. `None` if the pipe is
    /// closed before, or after [`PATIENCE`].
    pub fn next(&self, part: &str) -> Option<String> {
        let end = Instant::now() + PATIENCE;
        let mut lines = self.shared.lines();
        loop {
            while let Some(line) = lines.kept.get(lines.passed).cloned() {
                lines.passed += 1;
                if line.contains(part) {
                    return Some(line);
                }
            }
            let left = end.saturating_duration_since(Instant::now());
            if lines.is_closed || left.is_zero() {
                return None;
            }
            let waited = self.shared.changed.wait_timeout(lines, left);
            lines = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    pub fn is_closed(&self) -> bool {
        self.shared.lines().is_closed
    }

    /// Everything printed so far.
    pub fn text(&self) -> String {
        let lines = self.shared.lines();
        lines.kept.iter().flat_map(|line| [line, "\n"]).collect()
    }

    /// Waits until the pipe is closed.
    pub fn close(&mut self) {
        if let Some(reader) = self.reader.take() {
            let _ = reader.join();
        }
    }
}
