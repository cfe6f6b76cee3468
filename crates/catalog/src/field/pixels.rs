//! The pixels of a document: from a file, or from text that it holds.

use base64::{Engine as _, prelude::BASE64_STANDARD};
use strew_core::{Region, field::Pixels as Grid};
use strew_error::{Checked, Fault, Faults};
use strew_raster::{Image, Limits, MOST_SIDE, Meaning, RasterError, Samples};

use super::{
    document::Pixels,
    sources::{Sources, problem},
};

/// The sources of pixels that documents may have, in words.
const SOURCES: &str = "one of png and f32, or in the daemon's configuration a file";

/// The pixels of a mask as shares, and where they lie.
pub(super) fn shares(
    path: &str,
    document: &Pixels,
    sources: &Sources<'_>,
) -> Checked<(Region, Grid)> {
    let image = image(path, document, sources)?;
    let region = region(path, document, &image, sources)?;
    let width = image.size[0];
    let full = image.samples.full();
    let (black, white) = (
        document.black.unwrap_or(0.0),
        document.white.unwrap_or(full),
    );
    let is_scaled = black != 0.0 || white != full;
    if is_scaled && !(black < white && black.is_finite() && white.is_finite()) {
        let field = format!("{path}.white");
        let allowed = "a finite number above black";
        return Err(Fault::new(&field, white, "no number above black", allowed).into());
    }
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
    if made.ends()[0] < 0.0 || made.ends()[1] > 1.0 {
        let [least, most] = made.ends();
        let detail = format!("its numbers reach from {least} to {most}");
        let allowed =
            "shares from 0 to 1, or with black and white the numbers that count as 0 and 1";
        return Err(Fault::new(path, document.shown(), detail, allowed).into());
    }
    Ok((region, made))
}

/// The pixels of a terrain as heights, and where they lie.
pub(super) fn heights(
    path: &str,
    document: &Pixels,
    sources: &Sources<'_>,
) -> Checked<(Region, Grid)> {
    let image = image(path, document, sources)?;
    let region = region(path, document, &image, sources)?;
    let (width, samples) = (image.size[0], image.samples);
    let all = numbers(path, &samples, |v| v as f32, sources)?;
    // Heights and slopes are floats.
    sources
        .bytes
        .set(sources.bytes.get() + 2 * size_of::<f32>() * samples.len());
    let made = Grid::from_floats(width, flipped(all, width));
    Ok((
        region,
        made.map_err(|error| refused(path, error.value(), &error))?,
    ))
}

/// Numbers made of all pixels.
fn numbers(
    path: &str,
    samples: &Samples,
    of: impl Fn(f64) -> f32,
    sources: &Sources<'_>,
) -> Checked<Vec<f32>> {
    /// The most pixels that are looked at in a row.
    const FEW: usize = 1 << 16;
    let mut all = Vec::with_capacity(samples.len());
    while all.len() < samples.len() {
        sources.go_on(path)?;
        let places = (all.len()..samples.len()).take(FEW);
        all.extend(places.map(|i| of(samples.get(i))));
    }
    Ok(all)
}

/// Rows from the top as rows from the bottom.
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
    let bbox = document.bbox.or(image.frame);
    if document.bbox.is_none() {
        sources.meet(path, image.epsg)?;
    }
    let [min_x, min_y, max_x, max_y] = bbox.unwrap_or([0.0, 0.0, width, height]);
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

/// Reads the pixels, wherever they are.
fn image(path: &str, document: &Pixels, sources: &Sources<'_>) -> Checked<Image> {
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
            read(file, size).map_err(|error| wrong(&field, file, &error))
        }
        (None, Some(png), None) => {
            let field = format!("{path}.png");
            let bytes = decoded(&field, png, &shown)?;
            let read = match sources.files {
                // A file that the operator names may be of any format.
                Some(_) => Image::from_bytes(&bytes, Meaning::Data, limits, stop),
                None => Image::read_png(&bytes, Meaning::Data, limits, stop),
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
    let bytes = image.samples.len() * image.samples.width();
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
    let whole = "a whole PNG, GeoTIFF, npy or raw f32 raster of finite numbers";
    let (problem, allowed) = text.split_once("; allowed: ").unwrap_or((&text, whole));
    Fault::new(field, value, problem, allowed).into()
}

fn refused(path: &str, value: &str, error: &strew_core::Error) -> Faults {
    Fault::new(path, value, problem(error), error.allowed()).into()
}
