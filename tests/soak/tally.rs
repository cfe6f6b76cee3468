//! Counts of what happened: requests by kind, points, errors, and wrong answers.

use std::{collections::BTreeMap, fmt::Write as _, sync::Mutex};

/// Why a request did not succeed.
#[derive(Debug)]
pub enum Trouble {
    /// The answer differs from the library's.
    Wrong(String),
    /// No answer, or an incomplete one.
    Failed(String),
    /// The server had no room, which is allowed.
    Busy,
}

/// The outcome of a request: the number of points compared.
pub type Done = Result<u64, Trouble>;

impl From<std::io::Error> for Trouble {
    fn from(error: std::io::Error) -> Self {
        Self::Failed(error.kind().to_string())
    }
}

#[derive(Default)]
struct Counts {
    requests: BTreeMap<&'static str, u64>,
    points: u64,
    errors: BTreeMap<String, u64>,
    wrong: Vec<String>,
    wrongs: u64,
}

/// The counts, shared by all clients.
#[derive(Default)]
pub struct Tally {
    counts: Mutex<Counts>,
}

/// The number of wrong answers shown.
const SHOWN: usize = 10;

impl Tally {
    /// Records the outcome of a request; `excused` if the daemon was down meanwhile.
    pub fn note(&self, action: &'static str, done: Done, excused: bool) {
        let mut counts = self.counts.lock().expect("no panic");
        *counts.requests.entry(action).or_default() += 1;
        let wrong = match done {
            Ok(points) => {
                counts.points += points;
                return;
            }
            Err(Trouble::Busy) => {
                *counts.errors.entry("busy (503)".into()).or_default() += 1;
                return;
            }
            Err(Trouble::Failed(what)) if excused => {
                let kind = format!("{what}, while the daemon was restarted");
                *counts.errors.entry(kind).or_default() += 1;
                return;
            }
            Err(Trouble::Failed(what)) => format!("{action}: no answer: {what}"),
            Err(Trouble::Wrong(what)) => format!("{action}: {what}"),
        };
        counts.wrongs += 1;
        if counts.wrong.len() < SHOWN {
            let wrong: String = wrong.chars().take(2000).collect();
            eprintln!("WRONG: {wrong}");
            counts.wrong.push(wrong);
        }
    }

    /// Records an event that is not a request.
    pub fn event(&self, name: &'static str) {
        let mut counts = self.counts.lock().expect("no panic");
        *counts.requests.entry(name).or_default() += 1;
    }

    /// Records a fault found at the end.
    pub fn wrong(&self, what: String) {
        self.note("the end", Err(Trouble::Wrong(what)), false);
    }

    /// The number of wrong answers.
    pub fn wrongs(&self) -> u64 {
        self.counts.lock().expect("no panic").wrongs
    }

    /// The totals so far, in one line.
    pub fn short(&self) -> String {
        let counts = self.counts.lock().expect("no panic");
        let requests: u64 = counts.requests.values().sum();
        let errors: u64 = counts.errors.values().sum();
        let (points, wrongs) = (counts.points, counts.wrongs);
        format!("{requests} requests, {points} points, {errors} errors, {wrongs} wrong")
    }

    /// All counts.
    pub fn report(&self) -> String {
        let mut text = self.short() + "\n";
        let counts = self.counts.lock().expect("no panic");
        for (name, number) in &counts.requests {
            let _ = writeln!(text, "  {number:>9}  {name}");
        }
        for (name, number) in &counts.errors {
            let _ = writeln!(text, "  {number:>9}  error: {name}");
        }
        text
    }
}
