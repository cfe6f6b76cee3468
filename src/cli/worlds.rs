//! `strew worlds`: lists and checks the worlds of the settings.

use anyhow::anyhow;
use strew_config::Config;
use strew_encode::Encoding;
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{
    Assets, Draft, World, Worlds,
    world::{by_layer, with_path},
};

use super::{Failure, config, output};
use crate::cli::load::Load as _;

/// The commands about worlds.
#[derive(Debug, clap::Subcommand)]
pub(super) enum Command {
    /// List the loaded worlds: names, digests, layers.
    List(config::Args),
    /// Check every world against the loaded tables and fields.
    Check(config::Args),
}

/// Runs one of them.
pub(super) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::List(args) => list(&args.merged(config::Uses::QUERIES)?),
        Command::Check(args) => check(&args.merged(config::Uses::QUERIES)?),
    }
}

fn list(config: &Config) -> Result<(), Failure> {
    let catalog = config.with_worlds(config.tables()?)?;
    let lines: Vec<String> = catalog.worlds.iter().map(|world| line(world)).collect();
    output::print(&lines.concat())
}

/// A world in one line.
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
    let assets = Assets::from(config.tables()?);
    let each = Worlds::each(&config.worlds, &assets, config.limits.max_vertices)
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
