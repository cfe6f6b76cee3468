//! `strew profiles`: lists the loaded tables.

use strew_catalog::{Catalog, Entry};

use super::{Failure, config, output};
use crate::cli::load::Load as _;

/// The titles of the columns.
const TITLES: [&str; 6] = [
    "profile",
    "points in",
    "alpha",
    "map",
    "blocks",
    "joint kinds",
];

fn cells(entry: &Entry, catalog: &Catalog) -> [String; 6] {
    [
        entry.key.profile.to_string(),
        entry.key.dimension.to_string(),
        entry.key.alpha.to_string(),
        entry.key.size.to_string(),
        entry.blocks().to_string(),
        catalog.joint_kinds(entry).join(" "),
    ]
}

/// Prints the tables.
pub(super) fn run(args: &config::Args) -> Result<(), Failure> {
    let catalog = args.merged(config::Uses::LOADED)?.tables()?;
    let tables = catalog.entries().chain(catalog.in_space());
    let tables = tables.map(|entry| cells(entry, &catalog));
    let rows: Vec<[String; 6]> = [TITLES.map(String::from)]
        .into_iter()
        .chain(tables)
        .collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths = [0, 1, 2, 3, 4, 5].map(|column| width(column).unwrap_or(0));
    let mut text = String::new();
    for row in &rows {
        let cells = row
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!("{cell:width$}"));
        let line: Vec<String> = cells.collect();
        text += line.join("  ").trim_end();
        text.push('\n');
    }
    output::print(&text)
}
