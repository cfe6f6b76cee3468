//! TIFFs: which pixels are missing, what their numbers are, and where they lie. Expected values are those of GDAL 3.10.

use super::*;

/// The type and the bytes of a tag.
struct Value(u16, u32, Vec<u8>);

fn shorts(values: &[u16]) -> Value {
    let bytes = values.iter().flat_map(|v| v.to_le_bytes());
    Value(3, values.len() as u32, bytes.collect())
}

fn doubles(values: &[f64]) -> Value {
    let bytes = values.iter().flat_map(|v| v.to_le_bytes());
    Value(12, values.len() as u32, bytes.collect())
}

fn text(value: &str) -> Value {
    let bytes = [value.as_bytes(), &[0]].concat();
    Value(2, bytes.len() as u32, bytes)
}

/// The tags of one strip of pixels; further ones replace those of the same number.
fn directory(size: [u16; 2], bits: u16, pixels: &[u8], further: Vec<(u16, Value)>) -> Directory {
    let mut tags = vec![
        (256, shorts(&[size[0]])),
        (257, shorts(&[size[1]])),
        (258, shorts(&[bits])),
        (259, shorts(&[1])),
        (262, shorts(&[1])),
        (277, shorts(&[1])),
        (278, shorts(&[size[1]])),
    ];
    for (tag, value) in further {
        tags.retain(|(known, _)| *known != tag);
        tags.push((tag, value));
    }
    Directory(tags, pixels.to_vec())
}

struct Directory(Vec<(u16, Value)>, Vec<u8>);

fn file(directories: Vec<Directory>) -> Vec<u8> {
    let mut file = b"II*\0\x08\0\0\0".to_vec();
    let number = directories.len();
    for (i, Directory(mut tags, pixels)) in directories.into_iter().enumerate() {
        let long = |v: usize| Value(4, 1, (v as u32).to_le_bytes().to_vec());
        let start = file.len() + 2 + 12 * (tags.len() + 2) + 4;
        tags.push((273, long(start)));
        tags.push((279, long(pixels.len())));
        tags.sort_by_key(|(tag, _)| *tag);
        let mut further = pixels;
        let mut head = (tags.len() as u16).to_le_bytes().to_vec();
        for (tag, Value(kind, count, bytes)) in tags {
            head.extend(tag.to_le_bytes());
            head.extend(kind.to_le_bytes());
            head.extend(count.to_le_bytes());
            if bytes.len() <= 4 {
                head.extend([bytes, vec![0; 4]].concat().iter().take(4));
            } else {
                further.resize(further.len().next_multiple_of(8), 0);
                head.extend(((start + further.len()) as u32).to_le_bytes());
                further.extend(bytes);
            }
        }
        further.resize(further.len().next_multiple_of(8), 0);
        let next = if i + 1 < number {
            start + further.len()
        } else {
            0
        };
        head.extend((next as u32).to_le_bytes());
        file.extend(head);
        file.extend(further);
    }
    file
}

fn one(size: [u16; 2], bits: u16, pixels: &[u8], further: Vec<(u16, Value)>) -> Vec<u8> {
    file(vec![directory(size, bits, pixels, further)])
}

const NODATA: u16 = 42113;
const FORMAT: u16 = 339;

fn numbers(bytes: &[u8]) -> Image {
    read_as(bytes, Meaning::Numbers)
}

#[test]
fn no_data_is_of_every_type() {
    macro_rules! bytes {
        ($values:expr) => {
            $values
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect::<Vec<u8>>()
        };
    }
    let [uint, int, float] = [1, 2, 3];
    let (nan, tenth, lowest) = (f32::NAN, "0.10000000000000001", "-3.4028234663852886e+38");
    // The bits and the format of three pixels, no data, and the pixels that are missing.
    for (bits, format, pixels, nodata, missing) in [
        (8, uint, vec![1, 200, 255], "255", &[2][..]),
        (8, uint, vec![0, 200, 255], "0", &[0]),
        // Outside of the type.
        (8, uint, vec![0, 241, 255], "-9999", &[]),
        (8, uint, vec![0, 1, 255], "256", &[]),
        (8, uint, vec![0, 1, 255], "0.5", &[]),
        (8, uint, vec![0, 1, 255], "nan", &[]),
        (8, int, bytes!([-128i8, 0, 127]), "-128", &[0]),
        (16, uint, bytes!([0u16, 9, 65535]), "65535", &[2]),
        (16, int, bytes!([-32768i16, 9, 5]), "-32768", &[0]),
        (32, uint, bytes!([0u32, 9, u32::MAX]), "4294967295", &[2]),
        (32, int, bytes!([i32::MIN, 9, 5]), "-2147483648", &[0]),
        (32, float, bytes!([-9999f32, 9.0, 5.0]), "-9999", &[0]),
        (32, float, bytes!([0.1f32, 9., 5.]), tenth, &[0]),
        (32, float, bytes!([1e20f32, nan, 5.]), "1e+20", &[0, 1]),
        (32, float, bytes!([f32::MIN, 9., 5.]), lowest, &[0]),
        (32, float, bytes!([f32::NEG_INFINITY, 9., 5.]), "-inf", &[0]),
        (32, float, bytes!([f32::NAN, 9.0, 5.0]), " nan ", &[0]),
        (64, float, bytes!([1e300f64, 9.0, 5.0]), "1e300", &[0]),
        (64, float, bytes!([0.1f64, 9.0, f64::NAN]), "0.1", &[0, 2]),
    ] {
        let further = vec![(FORMAT, shorts(&[format])), (NODATA, text(nodata))];
        let found = numbers(&one([3, 1], bits, &pixels, further)).missing;
        let found = found.unwrap_or(vec![false; 3]);
        let expected: Vec<bool> = (0..3).map(|i| missing.contains(&i)).collect();
        assert_eq!(found, expected, "{bits} {format} {nodata}");
    }
    let further = vec![(FORMAT, shorts(&[float]))];
    let infinite = one([1, 1], 32, &f32::INFINITY.to_le_bytes(), further);
    assert!(refusal(&infinite).starts_with("the pixel in column 0, row 0 is inf"));
}

#[test]
fn bands_of_alpha_and_colors_without_data_are_missing() {
    let channels = |n: u16, photometric: u16, further: Vec<(u16, Value)>| {
        let mut all = vec![
            (258, shorts(&vec![8; usize::from(n)])),
            (262, shorts(&[photometric])),
            (277, shorts(&[n])),
        ];
        all.extend(further);
        all
    };
    let alpha = || vec![(338, shorts(&[2]))];
    let gray = one([2, 1], 8, &[200, 0, 200, 51], channels(2, 1, alpha()));
    let image = read(&gray).expect("gray with alpha");
    assert_eq!(image.samples, Samples::U8(vec![0, 40]));
    assert_eq!(image.missing, Some(vec![true, false]));
    let colors = [255, 255, 255, 0, 255, 255, 255, 255];
    let image = read(&one([2, 1], 8, &colors, channels(4, 2, alpha()))).expect("colors with alpha");
    assert_eq!(image.samples, Samples::U16(vec![0, 65535]));
    assert_eq!(image.missing, Some(vec![true, false]));
    let nodata = vec![(NODATA, text("7"))];
    let image = read(&one([2, 1], 8, &[7, 7, 7, 7, 7, 8], channels(3, 2, nodata)));
    assert_eq!(image.expect("colors").missing, Some(vec![true, false]));
    let further = vec![(338, shorts(&[0, 0]))];
    let bands = one([1, 1], 8, &[1, 2, 3], channels(3, 1, further));
    assert!(refusal(&bands).starts_with("pixels of 3 channels of 8 bits"));
}

#[test]
fn masks_of_a_directory_of_their_own_are_masks() {
    let pixels = [10, 20, 30, 40];
    let mask = |size, bits, pixels: &[u8], subfile: u16| {
        let further = vec![(254, shorts(&[subfile])), (262, shorts(&[4]))];
        directory(size, bits, pixels, further)
    };
    let picture = || directory([2, 2], 8, &pixels, vec![]);
    let bits = mask([2, 2], 1, &[0b0100_0000, 0b1000_0000], 4);
    let bits = file(vec![picture(), bits]);
    let bytes = file(vec![picture(), mask([2, 2], 8, &[0, 255, 1, 0], 4)]);
    for masked in [bits, bytes] {
        let image = read(&masked).expect("a raster with a mask");
        assert_eq!(image.samples, Samples::U8(vec![0, 20, 30, 0]));
        assert_eq!(image.missing, Some(vec![true, false, false, true]));
    }
    // Of a smaller copy, and a copy that is no mask.
    let (copy, other) = (mask([1, 1], 8, &[0], 5), mask([2, 2], 8, &[0; 4], 1));
    let others = file(vec![picture(), copy, other]);
    assert_eq!(read(&others).expect("a raster").missing, None);
}

#[test]
fn bits_and_palettes_have_their_numbers_and_their_light() {
    let bits = one([3, 2], 1, &[0b1010_0000, 0b0110_0000], vec![]);
    let image = read(&bits).expect("bits");
    assert_eq!(image.samples, Samples::U8(vec![1, 0, 1, 0, 1, 1]));
    assert!(image.is_sharp && image.full == 1.0);
    let white_is_zero = one([3, 1], 1, &[0b1010_0000], vec![(262, shorts(&[0]))]);
    let image = read(&white_is_zero).expect("bits");
    assert_eq!(image.samples, Samples::U8(vec![0, 1, 0]));
    assert_eq!(numbers(&white_is_zero).samples, Samples::U8(vec![1, 0, 1]));
    for (depth, bytes, expected, full) in [
        (2, [0b0111_1000, 0], vec![1, 3, 2], 3.0),
        (4, [0x1f, 0x30], vec![1, 15, 3], 15.0),
    ] {
        let image = read(&one([3, 1], depth, &bytes, vec![])).expect("few bits");
        assert_eq!((image.samples, image.full), (Samples::U8(expected), full));
    }
    // Black, red, green, white.
    let colors = [0, 65535, 0, 65535, 0, 0, 65535, 65535, 0, 0, 0, 65535];
    let further = [
        (262, shorts(&[3])),
        (320, shorts(&colors)),
        (NODATA, text("2")),
    ];
    let palette = one([4, 1], 2, &[0b0001_1011], further.into());
    let image = read(&palette).expect("a palette");
    assert_eq!(image.samples, Samples::U16(vec![0, 13933, 0, 65535]));
    assert_eq!(image.missing, Some(vec![false, false, true, false]));
    assert!(image.is_picture);
    let image = numbers(&palette);
    assert_eq!(image.samples, Samples::U8(vec![0, 1, 0, 3]));
    assert_eq!(image.missing, Some(vec![false, false, true, false]));
}

#[test]
fn a_place_is_whole_or_refused() {
    let place = |tags: Vec<(u16, Value)>| read(&one([2, 1], 8, &[1, 2], tags)).expect("a raster");
    let scale = || (33550, doubles(&[10.0, 5.0, 0.0]));
    let tied = [0.0, 0.0, 0.0, 100.0, 50.0, 0.0];
    let tie = |ties: usize| (33922, doubles(&tied.repeat(ties)));
    let matrix = |[a, b, c, d, e, f]: [f64; 6]| {
        let rows = [&[a, b, 0.0, c, d, e, 0.0, f, 0.0][..], &[0.0; 7]].concat();
        (34264, doubles(&rows))
    };
    let keys = |key: u16, value: u16| (34735, shorts(&[1, 1, 0, 1, key, 0, 1, value]));
    use Place::{Box, Unknown, Unusable};
    let turned = |b: f64, e: f64| vec![matrix([10.0, b, 100.0, 0.0, e, 50.0])];
    let upright = Box([100.0, 45.0, 120.0, 50.0]);
    for (tags, expected) in [
        (vec![], Unknown),
        (vec![scale(), tie(1)], upright),
        (
            vec![scale(), tie(1), keys(1025, 2)],
            Box([95.0, 47.5, 115.0, 52.5]),
        ),
        // As GDAL does, the size of a pixel and the first tie point.
        (vec![scale(), tie(2)], upright),
        (turned(0.0, -5.0), upright),
        (
            vec![tie(1)],
            Unusable("it has a tie point and no size of a pixel"),
        ),
        (
            vec![tie(4)],
            Unusable("it has control points and no place along the axes"),
        ),
        (
            vec![scale()],
            Unusable("it has the size of a pixel and no tie point"),
        ),
        (
            vec![keys(3072, 25832)],
            Unusable("it has a reference system and no place"),
        ),
        (turned(1.0, -5.0), Unusable("it is turned or sheared")),
        (turned(0.0, 0.0), Unusable("its place has no area")),
    ] {
        assert_eq!(place(tags).place, expected);
    }
    // Rows from the south, columns from the east.
    let south = matrix([-10.0, 0.0, 100.0, 0.0, 5.0, 50.0]);
    let image = read(&one([2, 2], 8, &[1, 2, 3, 4], vec![south])).expect("a raster");
    assert_eq!(image.place, Place::Box([80.0, 50.0, 100.0, 60.0]));
    assert_eq!(image.samples, Samples::U8(vec![4, 3, 2, 1]));
}

#[test]
fn pictures_are_turned_upright_and_maps_are_not() {
    // A corner of a picture of 3 × 2 pixels, as Exif 2.32 places row 0 and column 0.
    let pixels = [1, 2, 3, 4, 5, 6];
    for (orientation, size, expected) in [
        (0, [3, 2], [1, 2, 3, 4, 5, 6]),
        (1, [3, 2], [1, 2, 3, 4, 5, 6]),
        (2, [3, 2], [3, 2, 1, 6, 5, 4]),
        (3, [3, 2], [6, 5, 4, 3, 2, 1]),
        (4, [3, 2], [4, 5, 6, 1, 2, 3]),
        (5, [2, 3], [1, 4, 2, 5, 3, 6]),
        (6, [2, 3], [4, 1, 5, 2, 6, 3]),
        (7, [2, 3], [6, 3, 5, 2, 4, 1]),
        (8, [2, 3], [3, 6, 2, 5, 1, 4]),
    ] {
        let tags = || vec![(274, shorts(&[orientation]))];
        let image = read(&one([3, 2], 8, &pixels, tags())).expect("a picture");
        let expected = Samples::U8(expected.to_vec());
        assert_eq!((image.size, image.samples), (size, expected));
        let place = [
            (33550, doubles(&[1.0, 1.0, 0.0])),
            (33922, doubles(&[0.0; 6])),
        ];
        let placed = tags().into_iter().chain(place).collect();
        let map = read(&one([3, 2], 8, &pixels, placed))
            .expect("a map")
            .samples;
        assert_eq!(map, Samples::U8(pixels.to_vec()));
        // In PNG, JPEG and WebP the same tag stands in a small TIFF.
        let exif = one([1, 1], 8, &[0], tags());
        assert_eq!(image::orientation(&exif), orientation);
        let marked = [b"Exif\0\0", &exif[..]].concat();
        assert_eq!(image::orientation(&marked), orientation);
        let png = with_chunk(b"eXIf", &exif);
        let mut stored = read(gray()).expect("a PNG").size;
        if (5..=8).contains(&orientation) {
            stored.reverse();
        }
        assert_eq!(read(&png).expect("a PNG").size, stored);
    }
    assert_eq!(image::orientation(b"II"), 1);
    assert_eq!(image::orientation(&[]), 1);
}

#[test]
fn what_is_not_read_has_its_true_name() {
    for (tags, found) in [
        (vec![(259, shorts(&[3]))], "compression by CCITT fax 3"),
        (vec![(259, shorts(&[34887]))], "compression by LERC"),
        (vec![(258, shorts(&[12]))], "numbers of 12 bits"),
        (
            vec![(262, shorts(&[3]))],
            "the TIFF is damaged or truncated: its palette is missing",
        ),
    ] {
        let refusal = refusal(&one([1, 1], 8, &[1, 0], tags));
        assert!(refusal.starts_with(found), "{refusal}");
    }
}

/// Written by GDAL.
#[test]
fn compressions_of_gdal_are_read() {
    let close = |file: &[u8], meaning, expected: [f64; 3], most: f64| {
        let samples = read_as(file, meaning).samples;
        let found = [0, 8, 15].map(|column| samples.get(16 * 8 + column));
        let is_close = found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() <= most);
        assert!(is_close, "{found:?}");
    };
    use Meaning::{Data, Picture};
    close(seed!("zstd.tif"), Data, [0.8, 8.8, 15.8], 1e-6);
    close(seed!("fax4.tif"), Data, [0.0, 0.0, 1.0], 0.0);
    close(seed!("jpeg_gray.tif"), Data, [0.0, 128.0, 240.0], 1.0);
    let (ycbcr, clear) = (seed!("jpeg_ycbcr.tif"), seed!("webp_alpha.tif"));
    close(ycbcr, Picture, [10556.0, 14388.0, 22563.0], 200.0);
    close(clear, Picture, [65535.0, 14146.0, 23280.0], 200.0);
    let missing = read_as(clear, Data).missing.into_iter().flatten();
    assert_eq!(missing.filter(|is| *is).count(), 64);
    for file in [ycbcr, clear, seed!("zstd.tif")] {
        // The pixels are the last of the file.
        let cut = refusal(&file[..file.len() - 8]);
        assert!(cut.contains("is damaged or truncated"), "{cut}");
    }
}
