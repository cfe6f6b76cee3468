//! `strew profiles`, `strew periods` and `strew worlds`: lists of what the settings load.

use anyhow::anyhow;
use strew_catalog::{Catalog, Entry};
use strew_config::Config;
use strew_encode::Encoding;
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{
    self as query, Assets, Draft, Periods, World,
    world::{by_layer, with_path},
};

use super::{
    Failure, config,
    failure::refused,
    flags::{Flags, Listed},
    output,
};

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

pub(super) fn profiles(args: &config::Args) -> Result<(), Failure> {
    let catalog = config::tables(&args.merged(config::Uses::LOADED)?)?;
    let tables = catalog.entries().chain(catalog.in_space());
    let titles = [
        "profile",
        "points in",
        "alpha",
        "map",
        "blocks",
        "joint kinds",
    ];
    let mut rows = vec![titles.map(String::from)];
    rows.extend(tables.map(|entry| cells(entry, &catalog)));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [_; 6] = std::array::from_fn(|column| width(column).unwrap_or(0));
    let mut text = String::new();
    for row in &rows {
        let cells = row.iter().zip(widths);
        let cells = cells.map(|(cell, width)| format!("{cell:width$}"));
        text += cells.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    output::print(&text)
}

/// Flags of `strew periods`.
#[derive(Debug, clap::Args)]
pub(super) struct PeriodsArgs {
    /// Print the document of GET /v1/periods instead: the list with its table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Listed>,
    #[command(flatten)]
    settings: config::Args,
}

pub(super) fn periods(args: &PeriodsArgs) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::LOADED)?;
    let found = Periods::of(&args.flags.values(), &config::tables(&config)?);
    let found = found.map_err(refused)?;
    if args.json {
        return output::print_json([found]);
    }
    output::print_json(found.periods)
}

/// The commands of `strew worlds`.
#[derive(Debug, clap::Subcommand)]
pub(super) enum Worlds {
    /// List the loaded worlds: names, digests, layers.
    List(config::Args),
    /// Check every world against the loaded tables and fields.
    Check(config::Args),
}

pub(super) fn worlds(command: &Worlds) -> Result<(), Failure> {
    match command {
        Worlds::List(args) => list(&args.merged(config::Uses::QUERIES)?),
        Worlds::Check(args) => check(&args.merged(config::Uses::QUERIES)?),
    }
}

fn list(config: &Config) -> Result<(), Failure> {
    let catalog = config::assets(config)?;
    let lines: Vec<String> = catalog.worlds.iter().map(|world| line(world)).collect();
    output::print(&lines.concat())
}

fn line(world: &World) -> String {
    let line = format!(
        "{}  {}  {}",
        world.name,
        world.digest,
        world.layers.join(",")
    );
    format!("{}\n", line.trim_end())
}

/// Prints the valid worlds, and fails with the faults of the others.
fn check(config: &Config) -> Result<(), Failure> {
    let assets = Assets::from(config::tables(config)?);
    let each = query::Worlds::each(&config.worlds, &assets, config.limits.max_vertices)
        .map_err(Failure::usage)?;
    let (mut good, mut wrong) = (String::new(), vec![]);
    for (found, world) in each {
        let checked = world.map_err(|error| error.to_string()).and_then(|world| {
            let named = |error| with_path(by_layer(error, &world.draft), &found.name);
            plan(&world.draft, &assets, config).map_err(named)?;
            Ok(world)
        });
        match checked {
            Ok(world) => good += &line(&world),
            Err(error) => wrong.push(error),
        }
    }
    output::print(&good)?;
    match wrong.as_slice() {
        [] => Ok(()),
        wrong => Err(Failure::Usage(anyhow!("{}", wrong.join("\nerror: ")))),
    }
}

/// Plans a chunk of a world, which finds faults that only its tables show (distances that cannot be kept) or only its
/// points (a format without room for their attributes).
fn plan(draft: &Draft, assets: &Assets, config: &Config) -> Result<(), Error> {
    let draft = draft.tried("bbox=0,0,64,64");
    let (query, options) = draft.check(assets, config.limits.max_vertices)?;
    let encoding = options.encoding.unwrap_or(Encoding::Json);
    let output = options.output(encoding)?;
    match Planned::at_once(query, &config.limits) {
        Ok(planned) => planned
            .answer(&output, config.limits.block_bytes)
            .map(|_| ()),
        // These depend on the region, too.
        Err(Error::TooManyPoints { .. } | Error::TooManyRows { .. }) => Ok(()),
        Err(error) => Err(error),
    }
}
