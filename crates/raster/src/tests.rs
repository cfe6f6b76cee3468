//! Rasters of all formats, and the faults of bad ones.

use std::io::{BufReader, Cursor};

use ::png::{BitDepth::*, ColorType::*};

use super::*;

const SMALL: Limits = Limits {
    side: 64,
    pixels: 1000,
};

fn read(bytes: &[u8]) -> Result<Image, RasterError> {
    Image::from_bytes(bytes, Meaning::Data, SMALL, &Stop::default())
}

fn read_as(bytes: &[u8], meaning: Meaning) -> Image {
    let read = Image::from_bytes(bytes, meaning, SMALL, &Stop::default());
    read.expect("a raster")
}

fn refusal(bytes: &[u8]) -> String {
    read(bytes).expect_err("refused").to_string()
}

fn png(size: [u32; 2], color: ::png::ColorType, depth: ::png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut file = vec![];
    let mut encoder = ::png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(data).expect("written");
    writer.finish().expect("written");
    file
}

fn npy(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({shape}), }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(data);
    file
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

macro_rules! seed {
    ($name:literal) => {
        include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fuzz/seeds/raster/",
            $name
        ))
        .as_slice()
    };
}

mod tiff;

fn gray() -> &'static [u8] {
    seed!("gray.png")
}

#[test]
fn one_channel_of_a_png_is_taken_as_it_is() {
    for (width, color, depth, data, numbers) in [
        (3, Grayscale, Eight, &[0, 7, 255][..], vec![0, 7, 255]),
        (2, Grayscale, Sixteen, &[1, 2, 0, 3], vec![258, 3]),
        // Four pixels of one bit each.
        (4, Grayscale, One, &[0b1010_0000], vec![255, 0, 255, 0]),
        // Transparency multiplies.
        (2, GrayscaleAlpha, Eight, &[99, 255, 99, 51], vec![99, 20]),
    ] {
        let image = read(&png([width, 1], color, depth, data)).expect("gray");
        assert_eq!(image.size, [width as usize, 1]);
        assert_eq!((image.place, image.missing), (Place::Unknown, None));
        let samples = match depth {
            Sixteen => Samples::U16(numbers),
            _ => Samples::U8(numbers.into_iter().map(|v| v as u8).collect()),
        };
        assert_eq!(image.samples, samples);
    }
    // What is wholly transparent is missing, but not from a picture's paper.
    let clear = png([2, 1], GrayscaleAlpha, Eight, &[200, 0, 7, 255]);
    assert_eq!(read(&clear).expect("gray").missing, Some(vec![true, false]));
    assert_eq!(read_as(&clear, Meaning::Picture).missing, None);
}

#[test]
fn colors_become_linear_light() {
    let colors = [255, 255, 255, 0, 0, 0, 255, 0, 0, 188, 188, 188];
    let image = read(&png([4, 1], Rgb, Eight, &colors)).expect("colors");
    // 188 of 255 is half of the light.
    assert_eq!(image.samples, Samples::U16(vec![65535, 0, 13933, 32957]));
    let gray = png([1, 1], Grayscale, Eight, &[188]);
    let as_picture = read_as(&gray, Meaning::Picture).samples;
    assert_eq!(as_picture, Samples::U16(vec![32957]));
    // Pictures lie on white paper; a mask lets nothing through.
    let clear = png([1, 1], Rgba, Eight, &[9, 9, 9, 0]);
    let of = |meaning| read_as(&clear, meaning).samples;
    assert_eq!(of(Meaning::Picture), Samples::U16(vec![65535]));
    assert_eq!(of(Meaning::Data), Samples::U16(vec![0]));
}

#[test]
fn arrays_have_their_types_and_shapes() {
    let array = |descr, shape, data: &[u8]| {
        let image = read(&npy(descr, "False", shape, data)).expect("an array");
        (image.size, image.samples)
    };
    let expected = ([2, 1], Samples::F32(vec![0.5, -3.0]));
    assert_eq!(array("<f4", "1, 2", &floats(&[0.5, -3.0])), expected);
    let expected = ([1, 2], Samples::U16(vec![1, 256]));
    assert_eq!(array("<u2", "2, 1", &[1, 0, 0, 1]), expected);
    assert_eq!(array(">u2", "2, 1", &[0, 1, 1, 0]), expected);
    let columns = read(&npy("|u1", "True", "2, 3", &[1, 2, 3, 4, 5, 6])).expect("by columns");
    let expected = ([3, 2], Samples::U8(vec![1, 3, 5, 2, 4, 6]));
    assert_eq!((columns.size, columns.samples), expected);
    let image = read(&npy("|b1", "False", "1, 2", &[0, 1])).expect("truth");
    assert_eq!(image.samples, Samples::U8(vec![0, 255]));
    assert!(image.is_sharp);
    let image = read(&npy("<f4", "False", "1, 2", &floats(&[f32::NAN, 0.5]))).expect("a gap");
    assert_eq!(image.samples, Samples::F32(vec![0.0, 0.5]));
    assert_eq!(image.missing, Some(vec![true, false]));
    let expected = Samples::F32((0..12).map(|i| i as f32).collect());
    for file in [seed!("floats.npy"), seed!("doubles.npy")] {
        let image = read(file).expect("written by NumPy");
        assert_eq!((image.size, &image.samples), ([4, 3], &expected));
    }
    let file = Cursor::new(seed!("floats.f32"));
    let bare = Image::read_floats(file, [4, 3], SMALL, &Stop::default());
    assert_eq!(bare.expect("as long").samples, expected);
}

#[test]
fn tiffs_know_their_place() {
    let expected = Samples::F32((0..12).map(|i| i as f32).collect());
    let image = read(seed!("float.tif")).expect("floats");
    assert_eq!(image.place, Place::Unknown);
    assert_eq!(image.samples, expected);
    let image = read(seed!("geo.tif")).expect("floats");
    assert_eq!(image.samples, expected);
    assert_eq!(image.place, Place::Box([100.0, 194.0, 108.0, 200.0]));
    let gray = read(seed!("gray.png")).expect("gray").samples;
    for file in [seed!("gray.tif"), seed!("deflate.tif")] {
        assert_eq!(read(file).expect("gray").samples, gray);
    }
}

#[test]
fn pictures_are_read_from_all_their_formats() {
    for file in [
        seed!("picture.jpg"),
        seed!("progressive.jpg"),
        seed!("picture.webp"),
        seed!("lossy.webp"),
        seed!("color.png"),
        seed!("gray.tif"),
    ] {
        let image = Image::read_picture(Cursor::new(file), SMALL).expect("a picture");
        let Samples::U16(light) = image.samples else {
            panic!("light has 16 bits");
        };
        assert_eq!(light.len(), image.size[0] * image.size[1]);
        assert!(light.iter().any(|v| *v != light[0]) || image.size == [3, 2]);
    }
}

#[test]
fn what_is_truncated_is_damaged_wherever_it_ends() {
    for file in [
        seed!("gray.png"),
        seed!("alpha.png"),
        seed!("floats.npy"),
        seed!("doubles.npy"),
        seed!("gray.tif"),
        seed!("float.tif"),
    ] {
        assert!(read(file).is_ok());
        // The last bytes of a PNG and of some TIFFs do not affect the pixels.
        for end in 0..file.len() - 40 {
            let error = read(&file[..end]).expect_err("truncated");
            use RasterError::{Damaged, Unknown, Unsupported};
            let is_named = matches!(error, Damaged { .. } | Unknown(_) | Unsupported { .. });
            assert!(is_named, "{end}: {error}");
        }
    }
    for file in [
        seed!("picture.jpg"),
        seed!("progressive.jpg"),
        seed!("picture.webp"),
    ] {
        for end in 0..file.len() - 1 {
            let read = Image::read_picture(Cursor::new(&file[..end]), SMALL);
            assert!(read.is_err() || end > file.len() - 8, "{end}");
        }
    }
}

#[test]
fn headers_are_checked_before_memory_is_taken() {
    let mut wide = png([4, 1], Grayscale, Eight, &[0; 4]);
    wide[16..20].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff]);
    let crc = crc(&wide[12..29]);
    wide[29..33].copy_from_slice(&crc.to_be_bytes());
    assert_eq!(
        refusal(&wide),
        "it has 2147483647 × 1 pixels; allowed: 1 to 64 along each side and 1000 in all"
    );
    let huge = npy("<f4", "False", "18446744073709551615, 2", &[]);
    assert!(refusal(&huge).starts_with("it has 2 × 18446744073709551615 pixels"));
    assert!(refusal(&npy("<f4", "False", "60, 60", &[])).starts_with("it has 60 × 60 pixels"));
    assert!(refusal(&npy("<f4", "False", "0, 2", &[])).starts_with("it has 2 × 0 pixels"));
    let short = npy("<f4", "False", "2, 2", &[0; 15]);
    assert_eq!(
        refusal(&short),
        "the array is damaged or truncated: 2 × 2 pixels take 16 bytes, there are 15"
    );
}

fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc))
    })
}

#[test]
fn what_is_not_read_is_named() {
    let array = |descr, order, shape| npy(descr, order, shape, &[0; 4]);
    let infinite = [[0; 8], 1e300_f64.to_le_bytes()].concat();
    for (file, expected) in [
        (array(">i4", "False", "1, 1"), "an array of type >i4"),
        (array("<f4", "False", "1, 1, 1"), "an array of 3 dimensions"),
        (array("<f4", "False", "x"), "the array is damaged"),
        (b"GIF89a".to_vec(), "it is of no known format"),
        (vec![], "it is of no known format"),
        (
            npy("<f8", "False", "2, 1", &infinite),
            "the pixel in column 0, row 1 is inf; allowed: finite numbers",
        ),
    ] {
        assert!(refusal(&file).starts_with(expected), "{}", refusal(&file));
    }
    assert!(refusal(seed!("picture.jpg")).starts_with("it is of no known format"));
}

/// A reader whose bytes are no longer wanted once some of them were read.
struct Leaving<'a> {
    from: Cursor<&'a [u8]>,
    after: u64,
    stop: &'a Stop,
}

impl Read for Leaving<'_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        if self.from.position() > self.after {
            self.stop.raise();
        }
        self.from.read(out)
    }
}

impl Seek for Leaving<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.from.seek(to)
    }
}

#[test]
fn decoding_ends_soon_after_it_is_not_wanted_any_more() {
    // Noise, which is hardly compressed.
    let noise: Vec<u8> = (0..512 * 512_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8 ^ (i >> 3) as u8)
        .collect();
    let numbers: Vec<f32> = noise.iter().map(|v| f32::from(*v)).collect();
    for file in [
        png([512, 512], Grayscale, Eight, &noise),
        npy("<f4", "False", "512, 512", &floats(&numbers)),
        npy("|u1", "False", "512, 512", &noise),
    ] {
        let after = file.len() as u64 / 2;
        let stop = Stop::new();
        let from = Cursor::new(&file[..]);
        let stop = &stop;
        let mut from = BufReader::with_capacity(1 << 10, Leaving { from, after, stop });
        let read = Image::read(&mut from, Meaning::Data, Limits::FILES, stop);
        assert!(matches!(read, Err(RasterError::Stopped)), "{read:?}");
        let end = from.get_ref().from.position();
        assert!(end < after + (20 << 10), "{end}");
    }
}

#[test]
fn queries_are_read_as_png_alone() {
    let stop = Stop::NEVER;
    let read = |file: &[u8]| Image::read_png(file, Meaning::Data, SMALL, &stop);
    assert!(read(seed!("gray.png")).is_ok());
    for (file, found) in [
        (seed!("gray.tif"), "it is a TIFF; allowed: a PNG"),
        (seed!("floats.npy"), "it is a npy array; allowed: a PNG"),
        (seed!("picture.jpg"), "it is a JPEG; allowed: a PNG"),
        (seed!("picture.webp"), "it is a WebP; allowed: a PNG"),
        (b"GIF89a", "it is of no known format; allowed: a PNG"),
    ] {
        assert_eq!(read(file).expect_err("no PNG").to_string(), found);
    }
}

/// A PNG with a chunk of this kind before its pixels.
fn with_chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let gray = seed!("gray.png");
    let mut chunk = (data.len() as u32).to_be_bytes().to_vec();
    chunk.extend(kind);
    chunk.extend(data);
    let crc = crc(&chunk[4..]);
    chunk.extend(crc.to_be_bytes());
    [&gray[..33], &chunk, &gray[33..]].concat()
}

#[test]
fn what_pngs_hold_besides_their_pixels_is_not_inflated() {
    use std::io::Write as _;
    let mut packed = flate2::write::ZlibEncoder::new(vec![], flate2::Compression::best());
    packed.write_all(&vec![0; 64 << 20]).expect("in memory");
    let packed = packed.finish().expect("in memory");
    let expected = read(seed!("gray.png")).expect("gray").samples;
    for (kind, head) in [
        (b"zTXt", b"a\0\0".as_slice()),
        (b"iCCP", b"a\0\0"),
        (b"iTXt", b"a\0\x01\0\0\0"),
    ] {
        let file = with_chunk(kind, &[head, &packed].concat());
        assert_eq!(read(&file).expect("gray").samples, expected);
    }
    // Pixels beyond those in the header.
    let mut rows = with_chunk(b"IDAT", &packed);
    assert_eq!(read(&rows).expect("black").samples.get(0), 0.0);
    rows.truncate(40);
    assert!(read(&rows).is_err());
}

/// An indexed PNG of 2 bits: black, red and white, of which red is transparent.
#[test]
fn a_palette_is_light_or_its_indices() {
    let mut file = vec![];
    let mut encoder = ::png::Encoder::new(&mut file, 3, 1);
    encoder.set_color(Indexed);
    encoder.set_depth(Two);
    encoder.set_palette(vec![0, 0, 0, 255, 0, 0, 255, 255, 255]);
    encoder.set_trns(vec![255, 0, 255]);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[0b1000_0100]).expect("written");
    writer.finish().expect("written");
    let image = read(&file).expect("a palette");
    assert_eq!(image.samples, Samples::U16(vec![65535, 0, 0]));
    assert_eq!(image.missing, Some(vec![false, false, true]));
    let image = read_as(&file, Meaning::Numbers);
    assert_eq!(image.samples, Samples::U8(vec![2, 0, 0]));
    assert_eq!(image.missing, Some(vec![false, false, true]));
    // Gray of 4 bits, as GDAL has it.
    let gray = png([2, 1], Grayscale, Four, &[0x3f]);
    let image = read_as(&gray, Meaning::Numbers);
    assert_eq!(image.samples, Samples::U8(vec![3, 15]));
    let image = read(&gray).expect("gray");
    assert_eq!(image.samples, Samples::U8(vec![51, 255]));
}
