//! `strew table`: describes tables, checks their files, writes and reads their vectors as text.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};
use clap::Subcommand;
use strew_catalog::{Entry, Source};
use strew_core::{
    Alpha, Map, Table,
    table::{Digest, Provenance},
};
use strew_forge::ForgeError;

use super::{Failure, config, output, refuse};

/// Commands about tables.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Describe a table: its map, its making and its measurements.
    Show(Which),
    /// Check table files: every byte of them.
    Verify(Verify),
    /// Write a table's vectors.
    Export(Export),
    /// Make a table from vectors in the published text form.
    Import(Import),
}

/// Flags of `strew table verify`.
#[derive(Debug, clap::Args)]
pub(super) struct Verify {
    /// The files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// Flags of `strew table export`.
#[derive(Debug, clap::Args)]
pub(super) struct Export {
    #[command(flatten)]
    which: Which,
    /// As text: one line `x y` in grid units per block; row = block of dY, column = block of dX.
    #[arg(long)]
    text: bool,
    /// The file to write; - is standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Flags of `strew table import`.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("number").required(true).args(["alpha", "t_over_r"])))]
pub(super) struct Import {
    /// The text: one line `x y` in grid units per block; row = block of dY, column = block of dX.
    #[arg(value_name = "TEXT")]
    text: PathBuf,
    /// The number alpha.
    #[arg(long)]
    alpha: Option<Alpha>,
    /// t/r of the published tables, such as 191861/110771, instead of alpha = 1 + t/(t + r).
    #[arg(long, value_name = "T/R", value_parser = of_published)]
    t_over_r: Option<Alpha>,
    /// The half-width R of the map in grid units.
    #[arg(long, default_value_t = 49)]
    radius: u32,
    /// The name of the noise profile.
    #[arg(long)]
    profile: String,
    /// The file to write.
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Replace an existing file.
    #[arg(long)]
    force: bool,
}

/// α of the published t/r.
fn of_published(text: &str) -> Result<Alpha, String> {
    let read = || {
        let (t, r) = text.split_once('/')?;
        let (t, r): (u64, u64) = (t.parse().ok()?, r.parse().ok()?);
        let q = t.checked_add(r).filter(|_| t > 0 && r > 0)?;
        Some((q.checked_add(t)?, q))
    };
    let (p, q) = read().ok_or("allowed: two positive integers t/r")?;
    Alpha::from_fraction(p, q).map_err(|error| error.to_string())
}

/// A table: a file, or a loaded one.
#[derive(Debug, clap::Args)]
pub(super) struct Which {
    /// A table file [default: the loaded tables]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Only loaded tables of this profile.
    #[arg(long, conflicts_with = "file")]
    profile: Option<String>,
    /// Only loaded tables of this alpha.
    #[arg(long, conflicts_with = "file")]
    alpha: Option<Alpha>,
    /// Only loaded tables with a map of this size: s, m or l.
    #[arg(long, conflicts_with = "file")]
    map: Option<strew_core::map::Size>,
    #[command(flatten)]
    settings: config::Args,
}

pub(super) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Show(args) => show(args),
        Command::Verify(args) => verify(args),
        Command::Export(args) => export(args),
        Command::Import(args) => import(args),
    }
}

impl Which {
    /// The chosen tables, each with its source; at least one.
    fn tables(&self) -> Result<Vec<(String, AnyTable)>, Failure> {
        if let Some(file) = &self.file {
            let table = read(file).map_err(Failure::Other)?;
            return Ok(vec![(file.display().to_string(), table)]);
        }
        let config = self.settings.merged(config::Uses::LOADED)?;
        let catalog = config::catalog(&config)?;
        let meant = |entry: &Entry| {
            self.profile
                .as_ref()
                .is_none_or(|profile| **profile == *entry.key.profile)
                && self.alpha.is_none_or(|alpha| alpha == entry.key.alpha)
                && self.map.is_none_or(|size| size == entry.key.size)
        };
        let named = |entry: &Entry| {
            let place = match &entry.source {
                Source::Embedded(name) => format!("{name} (built in)"),
                Source::File(path) => path.display().to_string(),
                Source::Memory(_) | Source::Pattern => entry.source.to_string(),
            };
            let table = entry.table().map_err(Failure::other)?;
            Ok((place, AnyTable::Plane(table)))
        };
        let tables = catalog
            .entries()
            .filter(|entry| meant(entry))
            .map(|entry| named(entry));
        let tables: Vec<_> = tables.collect::<Result<_, Failure>>()?;
        if tables.is_empty() {
            let loaded: Vec<String> = catalog
                .entries()
                .map(|entry| entry.key.to_string())
                .collect();
            refuse!("no such table is loaded; loaded are: {}", loaded.join("; "));
        }
        Ok(tables)
    }
}

fn read(file: &Path) -> anyhow::Result<AnyTable> {
    // A file that is no table, or cannot be read, is that of the plane's reader, whose errors are complete.
    let is_regular = std::fs::metadata(file).is_ok_and(|found| found.is_file());
    match is_regular.then(|| strew_forge::space::read_table(file)) {
        Some(Ok(Some(table))) => Ok(AnyTable::Space(table)),
        Some(Err(error @ ForgeError::NotATable { .. })) => Err(error.into()),
        _ => Ok(AnyTable::Plane(Entry::from_file(file.to_owned())?.table()?)),
    }
}

enum AnyTable {
    Plane(Table),
    Space(strew_core::space::Table),
}

/// A property of a table of either kind.
macro_rules! of_either {
    ($($name:ident: $type:ty = |$table:ident| $value:expr;)+) => {
        impl AnyTable {
            $(fn $name(&self) -> $type {
                match self {
                    Self::Plane($table) => $value,
                    Self::Space($table) => $value,
                }
            })+
        }
    };
}

of_either! {
    map: &Map = |table| table.map();
    profile: &str = |table| table.profile();
    provenance: &Provenance = |table| table.provenance();
    digest: Digest = |table| table.digest();
    to_bytes: Vec<u8> = |table| table.to_bytes();
    has_ranks: bool = |table| table.ranks().is_some();
}

fn show(which: &Which) -> Result<(), Failure> {
    let mut text = String::new();
    for (i, (place, table)) in which.tables()?.iter().enumerate() {
        if i > 0 {
            text.push('\n');
        }
        describe(&mut text, place, table).context("cannot format")?;
    }
    output::print(&text)
}

fn describe(text: &mut String, place: &str, table: &AnyTable) -> std::fmt::Result {
    let (map, provenance) = (table.map(), table.provenance());
    let n = map.intervals();
    writeln!(text, "{place}")?;
    writeln!(text, "  profile    {}", table.profile())?;
    if let AnyTable::Space(_) = table {
        writeln!(text, "  points     in space")?;
    }
    let alpha = map.alpha();
    writeln!(text, "  alpha      {alpha} = {}", alpha.to_f64())?;
    writeln!(
        text,
        "  map        R = {}, {n} intervals, {} blocks",
        map.radius(),
        match table {
            AnyTable::Plane(_) => n.pow(2),
            AnyTable::Space(_) => n.pow(3),
        }
    )?;
    writeln!(text, "  bytes      {}", table.to_bytes().len())?;
    writeln!(text, "  digest     {}", table.digest())?;
    let ranks = match table.has_ranks() {
        true => "yes",
        false => "none: thinned sets are no more even than random ones",
    };
    writeln!(text, "  ranks      {ranks}")?;
    if let AnyTable::Plane(table) = table
        && let Some(mix) = table.mix()
    {
        let (kinds, shares) = (mix.shares().kinds(), mix.shares());
        writeln!(text, "  kinds      {kinds}, in the ratio {shares}")?;
    }
    writeln!(
        text,
        "  optimizer  {}, seed {}",
        provenance.optimizer, provenance.seed
    )?;
    for (name, value) in &provenance.parameters {
        writeln!(text, "             {name} = {value}")?;
    }
    if !provenance.twins.is_empty() {
        let twins: Vec<String> = provenance.twins.iter().map(ToString::to_string).collect();
        writeln!(text, "  made on    {}", twins.join(", "))?;
    }
    for figures in &provenance.figures {
        let seen = if figures.seen { "made on it" } else { "unseen" };
        writeln!(
            text,
            "  measured   {}, {} points, {seen}",
            figures.subject, figures.points
        )?;
        for (name, value) in &figures.values {
            writeln!(text, "             {name} = {value}")?;
        }
    }
    Ok(())
}

fn verify(args: &Verify) -> Result<(), Failure> {
    let mut bad = 0;
    for file in &args.files {
        match read(file) {
            Ok(table) => output::print(&format!(
                "{}: good, {}profile {}, alpha {}, digest {}\n",
                file.display(),
                match table {
                    AnyTable::Plane(_) => "",
                    AnyTable::Space(_) => "points in space, ",
                },
                table.profile(),
                table.map().alpha(),
                table.digest()
            ))?,
            Err(error) => {
                bad += 1;
                eprintln!("{error:#}");
            }
        }
    }
    match bad {
        0 => Ok(()),
        _ => Err(Failure::Other(anyhow!(
            "{bad} of {} tables are not good",
            args.files.len()
        ))),
    }
}

fn export(args: &Export) -> Result<(), Failure> {
    let tables = args.which.tables()?;
    let [(place, table)] = &tables[..] else {
        refuse!(
            "{} tables are loaded: choose one with --profile, --alpha and --map, or name a file",
            tables.len()
        );
    };
    let bytes = if args.text {
        let AnyTable::Plane(table) = table else {
            refuse!(
                "--text: {place} is a table of points in space, which has no text form; allowed: no \
                 --text, for the bytes of its file"
            );
        };
        let mut text = String::new();
        table.write_text(&mut text).context("cannot format")?;
        text.into_bytes()
    } else {
        table.to_bytes()
    };
    output::write(args.output.as_deref(), &bytes)
}

fn import(args: &Import) -> Result<(), Failure> {
    output::must_be_new(&args.output, args.force)?;
    let Some(alpha) = args.alpha.or(args.t_over_r) else {
        refuse!("--alpha or --t-over-r is missing");
    };
    let map = Map::new(alpha, args.radius)
        .map_err(|error| Failure::Usage(anyhow!("--radius: {error}")))?;
    let text = std::fs::read_to_string(&args.text)
        .with_context(|| format!("cannot read {}", args.text.display()))?;
    let table = Table::from_text(map, &args.profile, &text)
        .with_context(|| format!("{} is not a table", args.text.display()))?;
    strew_forge::write_table(&args.output, &table).map_err(anyhow::Error::from)?;
    output::print(&format!("{}  {}\n", table.digest(), args.output.display()))
}
