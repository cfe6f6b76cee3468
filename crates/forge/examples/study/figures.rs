//! Tables of figures, in Markdown.

use std::fmt::Display;

use strew_core::table::Figures;

/// The figures of measured sets, in columns. `strew measure` has the same names.
const NAMES: [&str; 7] = [
    "low_power",
    "peak_power",
    "peak_nu",
    "tallest_peak",
    "anisotropy_db",
    "delta_min",
    "delta_avg",
];

/// The head of a table: columns with bars between.
pub fn head(columns: &str) -> String {
    let rules = "---|".repeat(columns.split('|').count());
    format!("| {columns} |\n|{rules}")
}

/// A row: the subject, which may be several columns, and numbers.
pub fn row(subject: impl Display, numbers: &[f64]) -> String {
    let cells = numbers.iter().map(|&v| match v.abs() {
        _ if v.is_nan() => " |".into(),
        _ if v.fract() == 0.0 => format!(" {v:.0} |"),
        size if size < 0.001 => format!(" {v:.2e} |"),
        size if size < 10.0 => format!(" {v:.4} |"),
        _ => format!(" {v:.2} |"),
    });
    format!("| {subject} |{}", cells.collect::<String>())
}

/// Prints the head of a table of measured sets, with more columns.
pub fn print_head(more: &[&str]) {
    let columns = ["set", "points"].iter().chain(&NAMES).chain(more);
    let columns: Vec<&str> = columns.copied().collect();
    println!("{}", head(&columns.join(" | ")));
}

/// Prints the row of a measured set, with more numbers.
pub fn print(figures: &Figures, more: &[f64]) {
    let known = NAMES.map(|name| figures.value(name).unwrap_or(f64::NAN));
    let numbers = [&[figures.points as f64], &known[..], more].concat();
    println!("{}", row(&figures.subject, &numbers));
}
