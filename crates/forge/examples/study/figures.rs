//! Tables of figures, in Markdown.

use std::fmt::Display;

use strew_forge::{Report, Resolution, measure::Sample};

/// The figures of measured sets, in columns. `strew measure` has the same names.
const NAMES: &str =
    "low_power | peak_power | peak_nu | tallest_peak | anisotropy_db | delta_min | delta_avg";

/// Prints the head of a table: columns with bars between.
pub fn head(columns: &str) {
    let rules = "---|".repeat(columns.split('|').count());
    println!("\n| {columns} |\n|{rules}");
}

/// Prints a row: the subject, which may be several columns, and numbers.
pub fn row(subject: impl Display, numbers: &[f64]) {
    let cells = numbers.iter().map(|&v| match v.abs() {
        _ if v.is_nan() => " |".into(),
        _ if v.fract() == 0.0 => format!(" {v:.0} |"),
        size if size < 0.001 => format!(" {v:.2e} |"),
        size if size < 10.0 => format!(" {v:.4} |"),
        _ => format!(" {v:.2} |"),
    });
    println!("| {subject} |{}", cells.collect::<String>());
}

/// Prints the head of a table of measured sets, with more columns.
pub fn head_of_sets(more: &str) {
    head(&format!("set | points | {NAMES}{more}"));
}

/// Measures a set and prints its row, with more numbers.
pub fn measured(subject: String, set: &Sample, more: &[f64]) {
    let figures = Report::of(subject, false, set, Resolution::default()).figures;
    let known = { NAMES.split(" | ") }.map(|name| figures.value(name).unwrap_or(f64::NAN));
    let numbers = [figures.points as f64].into_iter().chain(known);
    let numbers = numbers.chain(more.iter().copied());
    row(&figures.subject, &numbers.collect::<Vec<_>>());
}
