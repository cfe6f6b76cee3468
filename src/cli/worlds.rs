//! `strew worlds`: the worlds of the settings, and what is wrong with them.

use anyhow::anyhow;

use super::{Failure, config, output};
use crate::{
    config::Config,
    service::{
        Answer, Catalog, Draft, Encoding, Error, Planned, World, Worlds,
        world::{by_layer, with_path},
    },
};

/// The commands about worlds.
#[derive(Debug, clap::Subcommand)]
pub(super) enum Command {
    /// List the worlds that are loaded: names, digests, layers.
    List(Args),
    /// Check every world against the tables and fields that are loaded.
    Check(Args),
}

/// Flags of both.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    settings: config::Args,
}

/// Runs one of them.
pub(super) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::List(args) => list(&args.settings.merged(config::Uses::QUERIES)?),
        Command::Check(args) => check(&args.settings.merged(config::Uses::QUERIES)?),
    }
}

fn list(config: &Config) -> Result<(), Failure> {
    let catalog = config.tables()?;
    let worlds = Worlds::load(&config.worlds, &catalog, config.limits.max_vertices)
        .map_err(|error| Failure::Usage(error.into()))?;
    let lines: Vec<String> = worlds.iter().map(|world| line(world)).collect();
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

/// Prints those that are in order, and fails with what is wrong with the others.
fn check(config: &Config) -> Result<(), Failure> {
    let catalog = config.tables()?;
    let each = Worlds::each(&config.worlds, &catalog, config.limits.max_vertices)
        .map_err(|error| Failure::Usage(error.into()))?;
    let (mut good, mut wrong) = (String::new(), vec![]);
    for (found, world) in each {
        let checked = world.map_err(|error| error.to_string()).and_then(|world| {
            let draft = world.draft();
            let planned = (draft.clone()).and_then(|draft| plan(&draft, &catalog, config));
            let named = |error| match &draft {
                Ok(draft) => with_path(by_layer(error, draft), &found.name),
                Err(_) => error.to_string(),
            };
            planned.map_err(named).map(|()| world)
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

/// Plans a chunk of a world, which shows what only its tables know, distances that cannot be kept, and what only its
/// points show: a format that has no room for their attributes.
fn plan(draft: &Draft, catalog: &Catalog, config: &Config) -> Result<(), Error> {
    let draft = draft.tried("bbox=0,0,64,64");
    let (query, options) = draft.check(catalog, config.limits.max_vertices)?;
    let encoding = options.encoding.unwrap_or(Encoding::Json);
    let output = options.output(encoding)?;
    match Planned::at_once(query, &config.limits) {
        Ok(planned) => Answer::new(&planned, &output, config.limits.block_bytes).map(|_| ()),
        // It depends on the region, too.
        Err(Error::TooManyPoints { .. } | Error::TooManyRows { .. }) => Ok(()),
        Err(error) => Err(error),
    }
}
