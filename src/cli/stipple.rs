//! `strew stipple`: a picture as dots.

use std::{
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};
use strew_catalog::field::{Document, NamedField};
use strew_core::{
    Raster, Region,
    field::{Edges, FieldSpec, Pixels},
};
use strew_encode::preview::MOST_SIZE;
use strew_query::{Draft, Value, parameters};
use strew_raster::{Image, Limits};

use super::{
    Failure, config, failure,
    flags::{Flags, Stippled},
    must_be_within,
    output::Output as Target,
    refuse,
    sample::{encoding_of, write},
};

/// Flags of `strew stipple`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The picture: a PNG, JPEG, WebP, TIFF or npy file.
    #[arg(value_name = "IMAGE")]
    image: PathBuf,
    /// The number of dots, exactly.
    #[arg(long, short = 'n', value_name = "NUMBER")]
    points: u64,
    /// The file to write; - is standard output. Its ending is the format: svg, png, csv, or another one of
    /// `strew sample`. Coordinates are pixels of the picture, x to the right and y upward.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The format, if the file's ending is not it.
    #[arg(long, value_name = "NAME")]
    format: Option<String>,
    /// Put dots where the picture is light, not where it is dark.
    #[arg(long)]
    invert: bool,
    /// The exponent of darkness for the density, 0.01 to 100: above 1 for more contrast, below 1 for less. At 1
    /// the dots are as dark as the picture, in linear light.
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0)]
    gamma: f64,
    /// The diameter of dots in svg and png, 0.01 to 10, in spacings of dots where they are densest.
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0)]
    dot: f64,
    /// The longer side of svg and png in pixels [default: that of the picture, 512 to 4096]
    #[arg(long, value_name = "NUMBER")]
    size: Option<u32>,
    /// The seed. Another seed places other dots.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// The noise profile of the dots.
    #[arg(long, value_name = "NAME", default_value = "blue")]
    profile: String,
    /// Print nothing but errors on standard error.
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    flags: Flags<Stippled>,
    #[command(flatten)]
    settings: config::Args,
}

const PICTURE: &str = "picture";

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::POINTS)?;
    must_be_within("--gamma", args.gamma, [0.01, 100.0])?;
    must_be_within("--dot", args.dot, [0.01, 10.0])?;
    let encoding = encoding_of(args.output.as_deref())?;
    // Before the work, which is in vain without an output.
    let output = Target::open(args.output.as_deref())?;
    let image = read(&args.image)?;
    let [width, height] = image.size;
    let catalog = config::tables(&config)?;
    let mut fields = catalog.fields().clone();
    fields.insert(NamedField::of_spec(PICTURE, darkness(&image, args)?));
    let catalog = catalog.with_fields(fields);
    let mut values = args.flags.values();
    let bbox = vec![0.0, 0.0, width as f64, height as f64];
    values.add_value(&parameters::BBOX, Value::Numbers(bbox));
    values.add_value(&parameters::COUNT, Value::Integer(args.points));
    values.add_value(&parameters::SEED, Value::Integer(args.seed));
    values.add_value(&parameters::PROFILE, Value::Text(args.profile.clone()));
    let field = Value::Field(Document::Name(PICTURE.into()).into());
    values.add_value(&parameters::FIELD, field);
    if let Some(format) = &args.format {
        values.add_text(parameters::FORMAT.name, format);
    }
    let longer = u32::try_from(width.max(height)).unwrap_or(u32::MAX);
    let size = args.size.unwrap_or_else(|| longer.clamp(512, MOST_SIZE));
    let planned = config::planned(&config, &Draft::of(values), &catalog.into());
    let (planned, options) = planned.map_err(|error| refused(args, error))?;
    let encoding = options.encoding.unwrap_or(encoding);
    let looks = options.output(encoding).map(|mut looks| {
        if encoding.traits().is_picture {
            looks.size = size;
            looks.dot = Some(args.dot);
        }
        looks
    });
    let looks = looks.map_err(|error| refused(args, error))?;
    let refused = |error| refused(args, error);
    write(
        &planned,
        &looks,
        &config,
        output,
        (args.quiet, "dots"),
        refused,
    )
}

fn refused(args: &Args, error: strew_error::Error) -> Failure {
    if let Some(fault) = error.faults().iter().find(|fault| fault.field == "count") {
        let (detail, allowed) = (&fault.detail, &fault.allowed);
        let text = format!("--points {}: {detail}; allowed: {allowed}", args.points);
        return Failure::Usage(anyhow!(text));
    }
    failure::refused(error)
}

fn read(path: &Path) -> Result<Image, Failure> {
    let read = || {
        let file = File::open(path)?;
        if file.metadata()?.is_dir() {
            return Err(anyhow!("it is a folder"));
        }
        let file = BufReader::with_capacity(1 << 16, file);
        Ok(Image::read_picture(file, Limits::FILES)?)
    };
    let image = read().with_context(|| format!("cannot read the picture {}", path.display()));
    image.map_err(Failure::Usage)
}

/// The share of dots at each place: darkness, or light if it is inverted.
fn darkness(image: &Image, args: &Args) -> Result<FieldSpec, Failure> {
    let [width, height] = image.size;
    // Rows of fields begin at the bottom.
    let words = image.darkness(args.invert);
    fn upward<T: Copy>(all: &[T], width: usize) -> Vec<T> {
        all.chunks_exact(width).rev().flatten().copied().collect()
    }
    let shares = upward(&words, width);
    let missing = image.missing.as_ref().map(|missing| upward(missing, width));
    if shares.iter().all(|share| *share == 0) {
        let (is, other) = match args.invert {
            true => ("black", "without --invert"),
            false => ("white", "with --invert"),
        };
        refuse!(
            "the picture {} is all {is}, so there is no place for dots; allowed: another picture, or {other}",
            args.image.display()
        );
    }
    let made = || {
        let region = Region::new([0.0, 0.0], [width as f64, height as f64])?;
        let pixels = Pixels::from_words(width, shares)?;
        let pixels = match missing {
            Some(missing) => pixels.without(|at| missing[at]),
            None => pixels,
        };
        let raster = Raster::of(region, pixels)?;
        FieldSpec::raster(raster.edges(Edges::Clamp).tone(0.0, 1.0, args.gamma)?)
    };
    Ok(made().context("the picture cannot be used")?)
}
