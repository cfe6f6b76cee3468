//! Interleaved rounds, their medians, and how they are printed. Ratios within one run hold on busy
//! machines, absolute figures do not.

use std::time::Instant;

/// How thorough a run is.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Only checks that everything runs.
    pub quick: bool,
    /// The number of rounds of which medians are taken.
    pub rounds: usize,
    /// The number of points of a long stream.
    pub points: u64,
}

/// One way to do some work.
pub struct Way<'a> {
    pub name: &'a str,
    /// Does the work and returns its amount.
    pub work: Box<dyn FnMut() -> f64 + 'a>,
}

impl<'a> Way<'a> {
    pub fn new(name: &'a str, work: impl FnMut() -> f64 + 'a) -> Self {
        Self {
            name,
            work: Box::new(work),
        }
    }
}

/// The amount per second of each way, as the median over interleaved rounds.
pub fn rates(rounds: usize, ways: &mut [Way<'_>]) -> Vec<f64> {
    let mut rates = vec![vec![]; ways.len()];
    // The first round warms up and is not counted, unless it is the only one.
    for round in 0..=rounds {
        for (way, rates) in ways.iter_mut().zip(&mut rates) {
            let start = Instant::now();
            let amount = (way.work)();
            let rate = amount / start.elapsed().as_secs_f64();
            if round > 0 || rounds == 1 {
                rates.push(rate);
            }
        }
    }
    rates.into_iter().map(median).collect()
}

/// The median; the upper one of an even number.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Prints a line for each way: its rate, and the first way's rate divided by it.
pub fn print(title: &str, unit: &str, scale: f64, ways: &[Way<'_>], rates: &[f64]) {
    println!("\n{title}");
    println!("{:<34} {unit:>12} {:>14}", "", "first ÷ this");
    for (way, rate) in ways.iter().zip(rates) {
        println!(
            "{:<34} {:>12.3} {:>14.2}",
            way.name,
            rate * scale,
            rates[0] / rate
        );
    }
}
