//! Rasters from TIFF, with the place that GeoTIFF states.

use std::io::{BufRead, Seek};

use strew_core::server::Stop;
use tiff::{
    ColorType, TiffError,
    decoder::{ChunkType, Decoder, DecodingResult},
    tags::Tag,
};

use super::{
    chunks::Cut,
    embedded::Embedded,
    error::RasterError,
    image::{Image, Place},
    limits::Limits,
    samples::Samples,
    tags::{PALETTE, Tagged, WHITE_IS_ZERO},
    tiff_faults::{broken, damaged, kind, unsupported},
    tone::{self, Channels, Depth, Meaning},
    wanted::look,
};

/// A strip or tile may take this much when decoded.
const CHUNK_BYTES: usize = 128 << 20;
/// A tag may take this much: the places of a million tiles.
const TAG_BYTES: usize = 16 << 20;

type File<R> = Decoder<Tagged<R>>;

pub(super) fn read(
    from: impl BufRead + Seek,
    meaning: Meaning,
    limits: Limits,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let mut bounds = tiff::decoder::Limits::default();
    bounds.decoding_buffer_size = CHUNK_BYTES;
    bounds.intermediate_buffer_size = CHUNK_BYTES;
    bounds.ifd_value_size = TAG_BYTES;
    let from = Tagged::new(from)?;
    let directories = from.directories.clone();
    let photometric = directories[0].photometric;
    let mut decoder = Decoder::new(from).map_err(damaged)?.with_limits(bounds);
    let (width, height) = decoder.dimensions().map_err(damaged)?;
    let size = limits.check(width.into(), height.into())?;
    let keys = decoder.find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag);
    let keys = keys.map_err(damaged)?.unwrap_or_default();
    let place = place(&mut decoder, &keys)?;
    let orientation = decoder.find_tag_unsigned::<u16>(Tag::Orientation);
    let orientation = orientation.map_err(damaged)?.unwrap_or(1);
    let mut rows = Pixels::new(&mut decoder, size, meaning)?;
    rows.nodata = nodata(&mut decoder);
    rows.is_inverted = photometric == WHITE_IS_ZERO && meaning != Meaning::Numbers;
    if photometric == PALETTE && meaning != Meaning::Numbers {
        rows.palette = Some(palette(&mut decoder)?);
    }
    rows.read(&mut decoder, stop)?;
    let Layout { bits, channels } = rows.layout;
    let has_light = rows.palette.is_some() || !channels.are_plain(meaning);
    let mut image = rows.image()?;
    let others = directories.iter().enumerate().skip(1);
    for (index, _) in others.filter(|(_, directory)| directory.subfile == 4) {
        decoder.seek_to_image(index).map_err(damaged)?;
        let of = decoder.dimensions().map_err(damaged)?;
        if of == (width, height) {
            let mut rows = Pixels::new(&mut decoder, size, Meaning::Numbers)?;
            rows.read(&mut decoder, stop)?;
            let mask = rows.image()?.samples;
            image = image.without((0..mask.len()).map(|i| mask.get(i) == 0.0).collect());
        }
    }
    if bits < 8 && !has_light {
        image.full = f64::from((1 << bits) - 1);
    }
    (image.is_sharp, image.is_picture) = (bits == 1, has_light);
    let image = image.without_nan(stop)?;
    let image = match place {
        // What has a place on earth is not turned as telephones are.
        Georeference::Transform(transform) => image.at(transform, stop)?,
        Georeference::Unusable(why) => Image {
            place: Place::Unusable(why),
            ..image
        },
        Georeference::None => return image.upright(orientation, stop),
    };
    Ok(Image {
        epsg: epsg(&keys),
        ..image
    })
}

#[derive(Clone, Copy)]
struct Layout {
    channels: Channels,
    bits: u8,
}

fn layout(decoder: &mut File<impl BufRead + Seek>) -> Result<Layout, RasterError> {
    let color = decoder.colortype().map_err(damaged)?;
    let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples);
    let is_alpha = extra
        .map_err(damaged)?
        .is_some_and(|extra| matches!(*extra, [1 | 2]));
    let (has_colors, has_alpha) = match color {
        ColorType::Gray(_) | ColorType::Multiband { num_samples: 1, .. } => (false, false),
        ColorType::Multiband { num_samples: 2, .. } if is_alpha => (false, true),
        ColorType::RGB(_) => (true, false),
        ColorType::YCbCr(8) if Embedded::of(decoder)?.is_some_and(|of| of.is_jpeg) => (true, false),
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
    let bits = color.bit_depth();
    let is_packed = matches!(bits, 1 | 2 | 4) && channels.count() == 1;
    if !is_packed && !matches!(bits, 8 | 16 | 32 | 64) {
        return Err(unsupported(format!("numbers of {bits} bits")));
    }
    Ok(Layout { channels, bits })
}

/// The pixels read so far.
struct Pixels {
    size: [usize; 2],
    layout: Layout,
    meaning: Meaning,
    /// The number that stands for no data.
    nodata: Option<f64>,
    /// Whether 0 is white.
    is_inverted: bool,
    palette: Option<Vec<u16>>,
    samples: Option<Samples>,
    missing: Vec<bool>,
}

impl Pixels {
    fn new(
        decoder: &mut File<impl BufRead + Seek>,
        size: [usize; 2],
        meaning: Meaning,
    ) -> Result<Self, RasterError> {
        Ok(Self {
            size,
            layout: layout(decoder)?,
            meaning,
            nodata: None,
            is_inverted: false,
            palette: None,
            samples: None,
            missing: vec![],
        })
    }

    fn read(
        &mut self,
        decoder: &mut File<impl BufRead + Seek>,
        stop: &Stop,
    ) -> Result<(), RasterError> {
        let [width, height] = self.size.map(|side| side as u32);
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
            size: self.size,
            channels: self.layout.channels.count(),
            across: [across, columns],
            chunks: expected,
        };
        cut.check(decoder)?;
        let embedded = Embedded::of(decoder)?;
        let bytes = u64::from(across) * u64::from(tall) * cut.channels as u64;
        match self.layout.bits {
            _ if embedded.is_none() => {}
            8 if bytes <= CHUNK_BYTES as u64 => {}
            8 => return Err(damaged(TiffError::LimitsExceeded)),
            bits => return Err(unsupported(format!("JPEGs or WebPs of {bits} bits"))),
        }
        for chunk in 0..expected as u32 {
            look(stop)?;
            let corner = [chunk % columns * across, chunk / columns * tall].map(|v| v as usize);
            let whole = [across as usize, tall as usize];
            let sides = [0, 1].map(|axis| whole[axis].min(self.size[axis] - corner[axis]));
            let decoded = match &embedded {
                #[cfg(feature = "compressions")]
                Some(embedded) => {
                    let from = decoder.inner();
                    let read = embedded.read(from, chunk as usize, whole, sides, cut.channels);
                    DecodingResult::U8(read?)
                }
                _ => decoder.read_chunk(chunk).map_err(damaged)?,
            };
            self.put(decoded, corner, sides)?;
        }
        Ok(())
    }

    fn put(
        &mut self,
        decoded: DecodingResult,
        corner: [usize; 2],
        sides: [usize; 2],
    ) -> Result<(), RasterError> {
        let Layout { channels, bits } = self.layout;
        let (samples, missing) = match decoded {
            DecodingResult::U8(values) if bits < 8 => {
                let mut all = vec![];
                let rows = values.chunks_exact(sides[0].div_ceil(usize::from(8 / bits)));
                rows.for_each(|row| tone::unpacked(row, bits, sides[0], &mut all));
                self.integers(&all, (1 << bits) - 1)
            }
            DecodingResult::U8(values) => self.integers(&values, u8::MAX),
            DecodingResult::U16(values) => self.integers(&values, u16::MAX),
            other if channels.count() == 1 => self.floats(other)?,
            _ => return Err(unsupported("colors that are not 8 or 16 bits deep".into())),
        };
        let cell = Cell {
            width: self.size[0],
            corner,
            sides,
        };
        if !self.missing.is_empty() || missing.contains(&true) {
            let mut missing = missing;
            missing.resize(samples.len(), false);
            cell.copy(&missing, &mut self.missing)?;
        }
        let all = self.samples.get_or_insert(match samples {
            Samples::U8(_) => Samples::U8(vec![]),
            Samples::U16(_) => Samples::U16(vec![]),
            Samples::F32(_) => Samples::F32(vec![]),
        });
        match (all, samples) {
            (Samples::U8(all), Samples::U8(some)) => cell.copy(&some, all),
            (Samples::U16(all), Samples::U16(some)) => cell.copy(&some, all),
            (Samples::F32(all), Samples::F32(some)) => cell.copy(&some, all),
            _ => Err(broken("its strips or tiles have different types")),
        }
    }

    /// Integers as they are or as light, and which of them are missing.
    fn integers<D: Depth>(&self, values: &[D], full: D) -> (Samples, Vec<bool>) {
        let (channels, meaning) = (self.layout.channels, self.meaning);
        let mut missing = vec![];
        tone::clear(values, channels, meaning, &mut missing);
        if let Some(nodata) = self.nodata {
            let colors = channels.count() - usize::from(channels.has_alpha);
            let is_nodata = |value: &D| Into::<u64>::into(*value) as f64 == nodata;
            let pixels = values.chunks_exact(channels.count());
            missing.resize(pixels.len(), false);
            for (missing, pixel) in missing.iter_mut().zip(pixels) {
                *missing |= pixel[..colors].iter().all(is_nodata);
            }
        }
        let inverted: Vec<D>;
        let values = match self.is_inverted {
            true => {
                let invert = |value: &D| D::cut(full.into() - Into::<u64>::into(*value));
                inverted = values.iter().map(invert).collect();
                &inverted
            }
            false => values,
        };
        let samples = if let Some(palette) = &self.palette {
            let light = |value: &D| palette.get(Into::<u64>::into(*value) as usize);
            let all = values.iter().map(|value| light(value).copied());
            Samples::U16(all.map(Option::unwrap_or_default).collect())
        } else if channels.are_plain(meaning) {
            let mut plain = vec![];
            tone::plain(values, channels, &mut plain);
            D::samples(plain)
        } else {
            let mut light = vec![];
            match full.into() {
                full if full == D::FULL => tone::light(values, channels, meaning, &mut light),
                full => {
                    let widened = values
                        .iter()
                        .map(|value| (Into::<u64>::into(*value) * 255 / full) as u8);
                    tone::light(&widened.collect::<Vec<_>>(), channels, meaning, &mut light);
                }
            }
            Samples::U16(light)
        };
        (samples, missing)
    }

    /// Numbers as floats, and which of them are missing. NaN is found later.
    fn floats(&self, decoded: DecodingResult) -> Result<(Samples, Vec<bool>), RasterError> {
        fn each<T: Copy + Into<f64>>(
            values: &[T],
            nodata: impl Fn(f64) -> bool,
        ) -> (Samples, Vec<bool>) {
            let floats = values.iter().map(|value| (*value).into() as f32).collect();
            let missing = values.iter().map(|value| nodata((*value).into())).collect();
            (Samples::F32(floats), missing)
        }
        let exact = |value: f64| Some(value) == self.nodata;
        // The tag may have more digits than the number.
        let narrow = |value: f64| {
            self.nodata
                .is_some_and(|nodata| nodata as f32 == value as f32)
        };
        Ok(match decoded {
            DecodingResult::F32(values) => each(&values, narrow),
            DecodingResult::F64(values) => each(&values, exact),
            DecodingResult::I8(values) => each(&values, exact),
            DecodingResult::I16(values) => each(&values, exact),
            DecodingResult::I32(values) => each(&values, exact),
            DecodingResult::U32(values) => each(&values, exact),
            _ => return Err(unsupported("numbers of 64 bits, or floats of 16".into())),
        })
    }

    fn image(self) -> Result<Image, RasterError> {
        let samples = self.samples.ok_or_else(|| broken("it has no pixels"))?;
        let mut missing = self.missing;
        missing.resize(samples.len(), false);
        Ok(Image::new(self.size, samples).without(missing))
    }
}

struct Cell {
    /// The width of the picture.
    width: usize,
    corner: [usize; 2],
    sides: [usize; 2],
}

impl Cell {
    /// Copies its pixels into their place. Memory grows by whole bands of tiles.
    fn copy<T: Copy + Default>(&self, values: &[T], all: &mut Vec<T>) -> Result<(), RasterError> {
        let Self {
            width,
            corner,
            sides,
        } = self;
        let end = (corner[1] + sides[1]) * width;
        if all.len() < end {
            all.resize(end, T::default());
        }
        if values.len() < sides[0] * sides[1] {
            return Err(broken("a strip or tile is too short"));
        }
        for (row, values) in values.chunks_exact(sides[0]).take(sides[1]).enumerate() {
            let start = (corner[1] + row) * width + corner[0];
            all[start..start + sides[0]].copy_from_slice(values);
        }
        Ok(())
    }
}

fn palette(decoder: &mut File<impl BufRead + Seek>) -> Result<Vec<u16>, RasterError> {
    let colors = decoder.find_tag_unsigned_vec::<u16>(Tag::ColorMap);
    let colors = colors.map_err(damaged)?.unwrap_or_default();
    let third = colors.len() / 3;
    if third == 0 {
        return Err(broken("its palette is missing"));
    }
    let color = |i: usize| [colors[i], colors[third + i], colors[2 * third + i]];
    let pixels: Vec<u16> = (0..third).flat_map(color).collect();
    let channels = Channels {
        has_colors: true,
        has_alpha: false,
    };
    let mut light = vec![];
    tone::light(&pixels, channels, Meaning::Picture, &mut light);
    Ok(light)
}

enum Georeference {
    None,
    /// From columns and rows to x and y: see [`Image::at`].
    Transform([f64; 6]),
    Unusable(&'static str),
}

/// The place of the raster, as GDAL takes it: the size of a pixel and the first tie point before a matrix.
fn place(
    decoder: &mut File<impl BufRead + Seek>,
    keys: &[u16],
) -> Result<Georeference, RasterError> {
    let mut numbers = |tag| {
        let value = decoder.find_tag(tag).map_err(damaged)?;
        value.map(|v| v.into_f64_vec().map_err(damaged)).transpose()
    };
    let (scale, tie, matrix) = (
        numbers(Tag::ModelPixelScaleTag)?,
        numbers(Tag::ModelTiepointTag)?,
        numbers(Tag::ModelTransformationTag)?,
    );
    let unusable = |why| Ok(Georeference::Unusable(why));
    let scale = scale.filter(|scale| scale.len() >= 2 && scale[0] != 0.0 && scale[1] != 0.0);
    let [a, b, c, d, e, f] = match (scale.as_deref(), tie.as_deref(), matrix.as_deref()) {
        (Some([sx, sy, ..]), Some([i, j, _, x, y, _, ..]), _) => {
            [*sx, 0.0, x - i * sx, 0.0, -sy.abs(), y + j * sy.abs()]
        }
        (_, _, Some([a, b, _, c, d, e, _, f, ..])) => [*a, *b, *c, *d, *e, *f],
        (_, Some([_, _, _, _, _, _, _, ..]), _) => {
            return unusable("it has control points and no place along the axes");
        }
        (_, Some(_), _) => return unusable("it has a tie point and no size of a pixel"),
        (Some(_), ..) => return unusable("it has the size of a pixel and no tie point"),
        _ if epsg(keys).is_some() => return unusable("it has a reference system and no place"),
        _ => return Ok(Georeference::None),
    };
    // GTRasterTypeGeoKey 2: places are those of the pixels' centers.
    let shift = if key(keys, 1025) == Some(2) { 0.5 } else { 0.0 };
    let corner = [c - shift * (a + b), f - shift * (d + e)];
    Ok(Georeference::Transform([a, b, corner[0], d, e, corner[1]]))
}

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
fn nodata(decoder: &mut File<impl BufRead + Seek>) -> Option<f64> {
    let value = decoder.find_tag(Tag::GdalNodata).ok()??;
    let text = value.into_string().ok()?;
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace())
        .parse()
        .ok()
}
