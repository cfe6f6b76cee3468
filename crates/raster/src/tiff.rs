//! Rasters from TIFF, with the place that GeoTIFF states.

use std::io::{BufRead, Seek, SeekFrom};

use strew_core::server::Stop;
use tiff::{
    ColorType,
    decoder::{ChunkType, Decoder, DecodingResult},
    tags::Tag,
};

use super::{
    chunks::Cut,
    error::RasterError,
    image::Image,
    limits::Limits,
    samples::Samples,
    tags,
    tiff_faults::{askew, broken, damaged, kind, unsupported},
    tone::{self, Channels, Meaning},
    wanted::look,
};

/// A strip or tile may take this much when decoded.
const CHUNK_BYTES: usize = 128 << 20;
/// A tag may take this much: the places of a million tiles.
const TAG_BYTES: usize = 16 << 20;

pub(super) fn read(
    mut from: impl BufRead + Seek,
    meaning: Meaning,
    limits: Limits,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let mut bounds = tiff::decoder::Limits::default();
    bounds.decoding_buffer_size = CHUNK_BYTES;
    bounds.intermediate_buffer_size = CHUNK_BYTES;
    bounds.ifd_value_size = TAG_BYTES;
    let length = from.seek(SeekFrom::End(0))?;
    tags::check(&mut from, length)?;
    let mut decoder = Decoder::new(from).map_err(damaged)?.with_limits(bounds);
    let (width, height) = decoder.dimensions().map_err(damaged)?;
    let size = limits.check(width.into(), height.into())?;
    let color = decoder.colortype().map_err(damaged)?;
    let (has_colors, has_alpha) = match color {
        ColorType::Gray(_) | ColorType::Multiband { num_samples: 1, .. } => (false, false),
        ColorType::GrayA(_) => (false, true),
        ColorType::RGB(_) => (true, false),
        ColorType::RGBA(_) => (true, true),
        other => return Err(unsupported(kind(other))),
    };
    let channels = Channels {
        has_colors,
        has_alpha,
    };
    let planar = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration);
    if channels.count() > 1 && planar.map_err(damaged)?.unwrap_or(1) != 1 {
        return Err(unsupported("channels in planes of their own".into()));
    }
    let keys = decoder.find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag);
    let keys = keys.map_err(damaged)?.unwrap_or_default();
    let frame = frame(&mut decoder, size, &keys)?;
    let missing = missing(&mut decoder);
    let mut rows = Pixels {
        size,
        channels,
        meaning,
        missing,
        samples: None,
    };
    let (across, tall) = decoder.chunk_dimensions();
    if across == 0 || tall == 0 {
        return Err(broken("its strips or tiles are empty"));
    }
    let columns = width.div_ceil(across);
    let chunks = match decoder.get_chunk_type() {
        ChunkType::Strip => decoder.strip_count(),
        ChunkType::Tile => decoder.tile_count(),
    };
    let expected = u64::from(columns) * u64::from(height.div_ceil(tall));
    if u64::from(chunks.map_err(damaged)?) < expected {
        return Err(broken("it has too few strips or tiles"));
    }
    let cut = Cut {
        size,
        channels: channels.count(),
        across: [across, columns],
        chunks: expected,
    };
    cut.check(&mut decoder)?;
    for chunk in 0..expected as u32 {
        look(stop)?;
        let decoded = decoder.read_chunk(chunk).map_err(damaged)?;
        let corner = [chunk % columns * across, chunk / columns * tall].map(|v| v as usize);
        let sides = [across as usize, tall as usize];
        let sides = [0, 1].map(|axis| sides[axis].min(size[axis] - corner[axis]));
        rows.put(decoded, corner, sides)?;
    }
    let samples = rows.samples.ok_or_else(|| broken("it has no pixels"))?;
    let samples = match samples {
        Samples::F32(values) => Samples::floats(values, size[0], stop)?,
        integers => integers,
    };
    Ok(Image {
        size,
        samples,
        epsg: frame.and_then(|_| epsg(&keys)),
        frame,
    })
}

/// The pixels read so far.
struct Pixels {
    size: [usize; 2],
    channels: Channels,
    meaning: Meaning,
    /// The number that stands for no data.
    missing: Option<f64>,
    samples: Option<Samples>,
}

/// Copies a strip or tile into its place. Memory grows by whole bands of tiles.
macro_rules! place {
    ($self:ident, $variant:ident, $values:expr, $corner:ident, $sides:ident) => {{
        let samples = $self.samples.get_or_insert(Samples::$variant(vec![]));
        let Samples::$variant(all) = samples else {
            return Err(broken("its strips or tiles have different types"));
        };
        let width = $self.size[0];
        let end = ($corner[1] + $sides[1]) * width;
        if all.len() < end {
            all.resize(end, Default::default());
        }
        let values = $values;
        if values.len() < $sides[0] * $sides[1] {
            return Err(broken("a strip or tile is too short"));
        }
        for (row, values) in values.chunks_exact($sides[0]).take($sides[1]).enumerate() {
            let start = ($corner[1] + row) * width + $corner[0];
            all[start..start + $sides[0]].copy_from_slice(values);
        }
    }};
}

impl Pixels {
    fn put(
        &mut self,
        decoded: DecodingResult,
        corner: [usize; 2],
        sides: [usize; 2],
    ) -> Result<(), RasterError> {
        let (channels, meaning) = (self.channels, self.meaning);
        let is_plain = channels.are_plain(meaning);
        let missing = self.missing;
        match decoded {
            DecodingResult::U8(values) if is_plain => {
                let mut plain = vec![];
                tone::plain(&values, channels, &mut plain);
                place!(self, U8, plain, corner, sides);
            }
            DecodingResult::U16(values) if is_plain => {
                let mut plain = vec![];
                tone::plain(&values, channels, &mut plain);
                place!(self, U16, plain, corner, sides);
            }
            DecodingResult::U8(values) => {
                let mut light = vec![];
                tone::light(&values, channels, meaning, &mut light);
                place!(self, U16, light, corner, sides);
            }
            DecodingResult::U16(values) => {
                let mut light = vec![];
                tone::light(&values, channels, meaning, &mut light);
                place!(self, U16, light, corner, sides);
            }
            other if channels.count() == 1 => {
                place!(self, F32, floats(other, missing)?, corner, sides);
            }
            _ => return Err(unsupported("colors that are not 8 or 16 bits deep".into())),
        }
        Ok(())
    }
}

/// Numbers as floats; those that stand for no data are 0.
fn floats(decoded: DecodingResult, missing: Option<f64>) -> Result<Vec<f32>, RasterError> {
    fn each<T: Copy + Into<f64>>(values: &[T], missing: Option<f64>) -> Vec<f32> {
        let is_missing = |value: f64| {
            missing.is_some_and(|missing| {
                missing == value
                    || missing as f32 == value as f32
                    || missing.is_nan() && value.is_nan()
            })
        };
        let float = |value: &T| {
            let value = (*value).into();
            if is_missing(value) { 0.0 } else { value as f32 }
        };
        values.iter().map(float).collect()
    }
    Ok(match decoded {
        DecodingResult::F32(values) => each(&values, missing),
        DecodingResult::F64(values) => each(&values, missing),
        DecodingResult::I8(values) => each(&values, missing),
        DecodingResult::I16(values) => each(&values, missing),
        DecodingResult::I32(values) => each(&values, missing),
        DecodingResult::U32(values) => each(&values, missing),
        _ => return Err(unsupported("numbers of 64 bits, or floats of 16".into())),
    })
}

/// The place of the raster, if the file states one.
fn frame(
    decoder: &mut Decoder<impl BufRead + Seek>,
    [width, height]: [usize; 2],
    keys: &[u16],
) -> Result<Option<[f64; 4]>, RasterError> {
    let mut numbers = |tag| {
        let value = decoder.find_tag(tag).map_err(damaged)?;
        value.map(|v| v.into_f64_vec().map_err(damaged)).transpose()
    };
    let (scale, tie, matrix) = (
        numbers(Tag::ModelPixelScaleTag)?,
        numbers(Tag::ModelTiepointTag)?,
        numbers(Tag::ModelTransformationTag)?,
    );
    // The place of the corner of the first pixel, and the step of a pixel.
    let (corner, step) = match (scale.as_deref(), tie.as_deref(), matrix.as_deref()) {
        (Some([sx, sy, ..]), Some([i, j, _, x, y, _, ..]), _) => {
            ([x - i * sx, y + j * sy], [*sx, *sy])
        }
        (_, _, Some([sx, rx, _, x, ry, sy, _, y, ..])) => {
            if *rx != 0.0 || *ry != 0.0 {
                return Err(askew("a raster that is turned"));
            }
            ([*x, *y], [*sx, -sy])
        }
        _ => return Ok(None),
    };
    // GTRasterTypeGeoKey 2: places are those of the pixels' centers.
    let is_point = key(keys, 1025) == Some(2);
    let shift = if is_point { 0.5 } else { 0.0 };
    let [x, y] = [corner[0] - shift * step[0], corner[1] + shift * step[1]];
    let frame = [
        x,
        y - height as f64 * step[1],
        x + width as f64 * step[0],
        y,
    ];
    let is_box = frame[0] < frame[2] && frame[1] < frame[3];
    if !is_box || frame.iter().any(|v| !v.is_finite()) {
        return Err(askew("a raster that is mirrored or has no area"));
    }
    Ok(Some(frame))
}

/// A key of GeoTIFF that is a short number.
fn key(keys: &[u16], name: u16) -> Option<u16> {
    // The first four numbers are the directory's own.
    let mut entries = keys.chunks_exact(4).skip(1);
    entries.find_map(|entry| (entry[..3] == [name, 0, 1]).then_some(entry[3]))
}

/// The code of the plane: that of the projected system, else of the geographic one. Larger numbers stand for systems
/// that have no code.
fn epsg(keys: &[u16]) -> Option<u16> {
    let code = key(keys, 3072).or_else(|| key(keys, 2048));
    code.filter(|code| (1024..32767).contains(code))
}

/// The number that stands for no data, if there is one.
fn missing(decoder: &mut Decoder<impl BufRead + Seek>) -> Option<f64> {
    let value = decoder.find_tag(Tag::GdalNodata).ok()??;
    let text = value.into_string().ok()?;
    text.trim_matches(['\0', ' ']).parse().ok()
}
