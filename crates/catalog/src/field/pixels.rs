//! The pixels of a document: from a file, or from text that it holds.

use base64::{Engine as _, prelude::BASE64_STANDARD};
use strew_core::{Region, field::Pixels as Grid};
use strew_error::{Checked, Fault, Faults};
use strew_raster::{Image, Limits, MOST_SIDE, Meaning, Place, RasterError, Samples};

use super::{
    document::Pixels,
    sources::{Sources, problem},
};

/// The most pixels that are looked at in a row.
const FEW: usize = 1 << 16;

const SOURCES: &str = "one of png and f32, or in the daemon's configuration a file";

/// The pixels of a mask as shares, where they lie, and whether there is nothing between them.
pub(super) fn shares(
    path: &str,
    document: &Pixels,
    sources: &Sources<'_>,
) -> Checked<(Region, Grid, bool)> {
    let meaning = match (document.black, document.white) {
        (None, None) => Meaning::Data,
        _ => Meaning::Numbers,
    };
    let image = image(path, document, meaning, sources)?;
    let region = region(path, document, &image, sources)?;
    let is_sharp = image.is_sharp || is_mask(path, document, &image, sources)?;
    let width = image.size[0];
    let (black, white) = (
        document.black.unwrap_or(0.0),
        document.white.unwrap_or(image.full),
    );
    let is_scaled = black != 0.0 || white != image.samples.full();
    if is_scaled && !(black < white && black.is_finite() && white.is_finite()) {
        let field = format!("{path}.white");
        let allowed = "a finite number above black";
        return Err(Fault::new(&field, white, "no number above black", allowed).into());
    }
    let missing = image.missing;
    let made = match image.samples {
        samples if is_scaled => {
            let share = |v: f64| ((v - black) / (white - black)).clamp(0.0, 1.0) as f32;
            let all = numbers(path, &samples, share, sources)?;
            Grid::from_floats(width, flipped(all, width))
        }
        Samples::U8(values) => Grid::from_bytes(width, flipped(values, width)),
        Samples::U16(values) => Grid::from_words(width, flipped(values, width)),
        Samples::F32(values) => Grid::from_floats(width, flipped(values, width)),
    };
    let made = made.map_err(|error| refused(path, error.value(), &error))?;
    let made = without(made, missing, width);
    if made.ends()[0] < 0.0 || made.ends()[1] > 1.0 {
        let [least, most] = made.ends();
        let detail = format!("its numbers reach from {least} to {most}");
        let allowed =
            "shares from 0 to 1, or with black and white the numbers that count as 0 and 1";
        return Err(Fault::new(path, document.shown(), detail, allowed).into());
    }
    Ok((region, made, is_sharp))
}

/// Whether the numbers are 0 and 1, of which 1 is white. Integers of a file that is no picture are refused where they
/// use less than an eighth of their type: a mask of 0 and 1, or a height, is no share of 255 or 65535.
fn is_mask(path: &str, document: &Pixels, image: &Image, sources: &Sources<'_>) -> Checked<bool> {
    let (samples, full) = (&image.samples, image.full);
    let is_unscaled = document.white.is_none() && !image.is_picture;
    let is_mask = document.white == Some(1.0) && document.black.unwrap_or(0.0) == 0.0;
    if matches!(samples, Samples::F32(_)) || !is_unscaled && !is_mask {
        return Ok(false);
    }
    let mut most = 0f64;
    for start in (0..samples.len()).step_by(FEW) {
        sources.go_on(path)?;
        let some = start..samples.len().min(start + FEW);
        most = some.fold(most, |most, i| most.max(samples.get(i)));
    }
    if is_unscaled && most > 0.0 && most < full / 8.0 {
        let detail = format!(
            "its numbers reach to {most} of {full}, and none says which of them is a share of 1"
        );
        let allowed = format!(
            "a white: {most} if that is all of the density, {full} if they are shares of that"
        );
        return Err(Fault::new(&format!("{path}.white"), "", detail, allowed).into());
    }
    Ok(is_mask && most <= 1.0)
}

pub(super) fn heights(
    path: &str,
    document: &Pixels,
    sources: &Sources<'_>,
) -> Checked<(Region, Grid)> {
    let image = image(path, document, Meaning::Numbers, sources)?;
    let region = region(path, document, &image, sources)?;
    let (width, samples) = (image.size[0], image.samples);
    let all = numbers(path, &samples, |v| v as f32, sources)?;
    // Heights and slopes are floats.
    sources
        .bytes
        .set(sources.bytes.get() + 2 * size_of::<f32>() * samples.len());
    let made = Grid::from_floats(width, flipped(all, width));
    let made = made.map_err(|error| refused(path, error.value(), &error))?;
    Ok((region, without(made, image.missing, width)))
}

/// The pixels that have data, from those of rows from the top.
fn without(pixels: Grid, missing: Option<Vec<bool>>, width: usize) -> Grid {
    match missing.map(|missing| flipped(missing, width)) {
        Some(missing) => pixels.without(|at| missing[at]),
        None => pixels,
    }
}

fn numbers(
    path: &str,
    samples: &Samples,
    of: impl Fn(f64) -> f32,
    sources: &Sources<'_>,
) -> Checked<Vec<f32>> {
    let mut all = Vec::with_capacity(samples.len());
    while all.len() < samples.len() {
        sources.go_on(path)?;
        let places = (all.len()..samples.len()).take(FEW);
        all.extend(places.map(|i| of(samples.get(i))));
    }
    Ok(all)
}

fn flipped<T>(mut pixels: Vec<T>, width: usize) -> Vec<T> {
    let height = pixels.len() / width.max(1);
    for row in 0..height / 2 {
        let (upper, lower) = pixels.split_at_mut((height - 1 - row) * width);
        upper[row * width..][..width].swap_with_slice(&mut lower[..width]);
    }
    pixels
}

fn region(path: &str, document: &Pixels, image: &Image, sources: &Sources<'_>) -> Checked<Region> {
    let [width, height] = image.size.map(|side| side as f64);
    let [min_x, min_y, max_x, max_y] = match (document.bbox, image.place) {
        (Some(bbox), _) | (None, Place::Box(bbox)) => bbox,
        (None, Place::Unknown) => [0.0, 0.0, width, height],
        (None, Place::Unusable(why)) => {
            let allowed = "a place along the axes, a world file, or a bbox (--raster-bbox): min x, min y, max x, max y";
            return Err(Fault::new(&format!("{path}.bbox"), document.shown(), why, allowed).into());
        }
    };
    if document.bbox.is_none() {
        sources.meet(path, image.epsg)?;
    }
    let region = Region::new([min_x, min_y], [max_x, max_y]);
    let region = region.ok().filter(|_| min_x < max_x && min_y < max_y);
    if region.is_some() {
        let frame = sources
            .frame
            .get()
            .map_or([min_x, min_y, max_x, max_y], |[a, b, c, d]| {
                [a.min(min_x), b.min(min_y), c.max(max_x), d.max(max_y)]
            });
        sources.frame.set(Some(frame));
    }
    region.ok_or_else(|| {
        let value = format!("{min_x}, {min_y}, {max_x}, {max_y}");
        let allowed = "four finite numbers min x, min y, max x, max y in ascending order";
        Fault::new(&format!("{path}.bbox"), value, "not a box", allowed).into()
    })
}

fn image(path: &str, document: &Pixels, meaning: Meaning, sources: &Sources<'_>) -> Checked<Image> {
    let size = match (document.width, document.height) {
        (Some(width), Some(height)) => Some([width, height]),
        _ => None,
    };
    let stop = sources.allowance.stop;
    let shown = document.shown();
    let limits = Limits {
        side: MOST_SIDE,
        pixels: sources.pixels.get(),
    };
    if document.file.is_none() {
        // Before the work, which is done even if nothing comes of it.
        let price = document.price();
        sources.take(path, price)?;
    }
    let read = match (&document.file, &document.png, &document.f32) {
        (Some(file), None, None) => {
            let field = format!("{path}.file");
            let Some(read) = sources.files else {
                let detail = "queries name no files";
                return Err(Fault::new(&field, file, detail, SOURCES).into());
            };
            read(file, meaning, size).map_err(|error| wrong(&field, file, &error))
        }
        (None, Some(png), None) => {
            let field = format!("{path}.png");
            let bytes = decoded(&field, png, &shown)?;
            let read = match sources.files {
                // A file that the operator names may be of any format.
                Some(_) => Image::from_bytes(&bytes, meaning, limits, stop),
                None => Image::read_png(&bytes, meaning, limits, stop),
            };
            read.map_err(|error| wrong(&field, &shown, &error))
        }
        (None, None, Some(floats)) => {
            let field = format!("{path}.f32");
            let Some(size) = size else {
                let allowed = format!("an integer from 1 to {MOST_SIDE}");
                let name = document.width.map_or("width", |_| "height");
                return Err(Fault::missing(&format!("{path}.{name}"), allowed).into());
            };
            let bytes = std::io::Cursor::new(decoded(&field, floats, &shown)?);
            let read = Image::read_floats(bytes, size, limits, stop);
            read.map_err(|error| wrong(&field, &shown, &error))
        }
        (None, None, None) => return Err(Fault::missing(&format!("{path}.png"), SOURCES).into()),
        _ => {
            let detail = "more than one of file, png and f32";
            return Err(Fault::new(path, shown, detail, SOURCES).into());
        }
    };
    let image = read?;
    // Those that are missing are marked, also in the field.
    let marks = image.missing.as_ref().map_or(0, Vec::len);
    let bytes = image.samples.len() * image.samples.width() + marks;
    sources.bytes.set(sources.bytes.get() + bytes);
    Ok(image)
}

fn decoded(field: &str, text: &str, shown: &str) -> Result<Vec<u8>, Faults> {
    let bytes = BASE64_STANDARD.decode(text);
    bytes.map_err(|error| {
        let allowed = "base64 with the standard alphabet and padding";
        Fault::new(field, shown, format!("not base64: {error}"), allowed).into()
    })
}

fn wrong(field: &str, value: &str, error: &RasterError) -> Faults {
    let text = error.to_string();
    let whole = "a whole PNG, GeoTIFF, npy or raw f32 raster of finite numbers and NaN";
    let (problem, allowed) = text.split_once("; allowed: ").unwrap_or((&text, whole));
    Fault::new(field, value, problem, allowed).into()
}

fn refused(path: &str, value: &str, error: &strew_core::Error) -> Faults {
    Fault::new(path, value, problem(error), error.allowed()).into()
}
