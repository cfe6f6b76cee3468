//! `strew profiles`: the tables that would answer.

use serde::Serialize;

use super::{Failure, config, output};
use crate::service::{Catalog, Entry};

/// Flags of `strew profiles`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print each table as JSON, one a line.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    settings: config::Args,
}

/// A table, as `GET /v1/profiles` describes it, without its provenance.
#[derive(Serialize)]
struct Listed<'a> {
    profile: &'a str,
    alpha: String,
    map: String,
    radius: u32,
    blocks: usize,
    joint_kinds: Vec<String>,
    bytes: u64,
    digest: &'a str,
}

impl<'a> Listed<'a> {
    fn new(entry: &'a Entry, catalog: &Catalog) -> Self {
        Self {
            profile: &entry.key.profile,
            alpha: entry.key.alpha.to_string(),
            map: entry.key.size.to_string(),
            radius: entry.radius,
            blocks: entry.blocks(),
            joint_kinds: catalog.joint_kinds(entry),
            bytes: entry.bytes,
            digest: &entry.digest,
        }
    }

    /// The columns of the list.
    fn cells(&self) -> [String; 5] {
        [
            self.profile.into(),
            self.alpha.clone(),
            self.map.clone(),
            format!("{}", self.blocks),
            self.joint_kinds.join(" "),
        ]
    }
}

/// Prints the tables.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let catalog = args.settings.merged()?.tables()?;
    let listed = || catalog.entries().map(|entry| Listed::new(entry, &catalog));
    if args.json {
        return output::print_json(listed());
    }
    let head = ["profile", "alpha", "map", "blocks", "joint kinds"].map(String::from);
    let rows: Vec<[String; 5]> = [head]
        .into_iter()
        .chain(listed().map(|table| table.cells()))
        .collect();
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths = [0, 1, 2, 3, 4].map(width);
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
