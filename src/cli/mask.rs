//! `strew mask`: a tileable threshold mask as a picture or an array.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use strew_catalog::Ready;
use strew_forge::{figure, mask::Mask};
use strew_query::chosen;

use super::{
    Failure, config,
    failure::refused,
    flags::{Flags, Tabled},
    output::{self, Output, must_not_be_terminal},
    pattern::encoded,
    progress::Progress,
    refuse,
};

/// Flags of `strew mask`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The side of the mask in pixels, 16 to 1024.
    #[arg(long, value_name = "PIXELS", default_value_t = 256)]
    size: u32,
    /// The seed. Each seed makes another mask.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    seed: u64,
    /// The bits of a threshold: 8 or 16.
    #[arg(long, value_name = "BITS", default_value_t = 8)]
    bits: u8,
    /// The file to write, a PNG or by the ending .npy an array of NumPy; - is standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the spectrum of the mask at the levels 1/8, 1/4 and 1/2, as SVG or PNG by the file's ending.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
    #[command(flatten)]
    table: Flags<Tabled>,
    #[command(flatten)]
    settings: config::Args,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let is_array = is_array(args.output.as_deref())?;
    must_not_be_terminal(args.output.as_deref(), "a PNG")?;
    let config = args.settings.merged(config::Uses::LOADED)?;
    let catalog = config::tables(&config)?;
    let ready = chosen(&args.table.values(), &catalog).and_then(|entry| Ready::load(&entry));
    let ready = ready.map_err(refused)?;
    let output = Output::open(args.output.as_deref())?;
    let mut progress = Progress::new("pixels", Mask::steps(args.size), false);
    let mut done = 0;
    let mask = Mask::new_while(&ready.table, args.size, args.seed, |pixels| {
        done += pixels as u64;
        progress.reach(done, "");
        true
    });
    progress.finish();
    let mask = mask.map_err(Failure::of_setting)?.context("stopped")?;
    let written = match is_array {
        true => mask.to_npy(args.bits),
        false => mask.to_png(args.bits),
    };
    let written = written.map_err(Failure::of_setting)?;
    if let Some(path) = &args.spectrum {
        /// The longer side of a PNG.
        const SIZE: u32 = 1600;
        let drawing = figure::mask_spectrum(&mask);
        let drawn = encoded(&drawing, ("--spectrum", Some(path)), SIZE)?;
        output::write(Some(path), &drawn)?;
    }
    output.end_with(&written)
}

/// Whether the file is an array of NumPy, by its ending, else a PNG.
fn is_array(output: Option<&Path>) -> Result<bool, Failure> {
    let path = output.unwrap_or(Path::new("-"));
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().map(|ending| ending.to_str()) {
        Some(Some("npy")) => Ok(true),
        Some(Some("png")) | None => Ok(false),
        _ => refuse!(
            "--output {}: no format of masks; allowed: a file whose name ends in .png or .npy",
            path.display()
        ),
    }
}
