//! `strew completions` and `strew man`: scripts for shells, and manual pages.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap_complete::{Shell, env::Shells};

use super::{Failure, output::write};

/// Flags of `strew completions`.
#[derive(Debug, clap::Args)]
pub(super) struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Flags of `strew man`.
#[derive(Debug, clap::Args)]
pub(super) struct ManArgs {
    /// The folder for the pages, one for each command: strew.1, strew-sample.1, … [default: the page of strew itself on
    /// standard output]
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
}

/// Prints a script by which a shell runs the program itself to complete a line.
pub(super) fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    const NAME: &str = "strew";
    let shells = Shells::builtins();
    let shell = shells.completer(&args.shell.to_string());
    let shell = shell.context("this shell has no completions")?;
    let mut script = vec![];
    let written = shell.write_registration("COMPLETE", NAME, NAME, NAME, &mut script);
    written.context("the script cannot be made")?;
    write(None, &script)
}

/// Writes manual pages.
pub(super) fn man(args: &ManArgs, command: clap::Command) -> Result<(), Failure> {
    let Some(folder) = &args.out_dir else {
        return write(None, &page(command)?);
    };
    // Building puts the names of outer commands before those of inner ones.
    let mut command = command.disable_help_subcommand(true);
    command.build();
    write_pages(folder, &command)
}

fn write_pages(folder: &Path, command: &clap::Command) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let path = folder.join(format!("{name}.1"));
    write(Some(&path), &page(command.clone().name(name.to_owned()))?)?;
    command
        .get_subcommands()
        .filter(|inner| !inner.is_hide_set())
        .try_for_each(|inner| write_pages(folder, inner))
}

fn page(command: clap::Command) -> anyhow::Result<Vec<u8>> {
    let mut page = vec![];
    let written = clap_mangen::Man::new(command).render(&mut page);
    written.context("a manual page cannot be made")?;
    Ok(page)
}
