//! Fields for tests.

use std::{fs, path::Path};

use base64::{Engine as _, prelude::BASE64_STANDARD};

/// A gray PNG whose pixels follow from their columns and rows, the first row at the top.
pub fn png(size: [u32; 2], gray: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let pixels: Vec<u8> = rows.map(|(x, y)| gray(x, y)).collect();
    writer.write_image_data(&pixels).expect("written");
    writer.finish().expect("written");
    file
}

/// A PNG of one gray.
pub fn gray(size: [u32; 2], shade: u8) -> Vec<u8> {
    png(size, |_, _| shade)
}

/// A TIFF whose tiles of one row are far wider than the picture; all of them are the same bytes.
pub fn wide_tiff([width, height]: [u32; 2], tile: usize) -> Vec<u8> {
    use std::io::Write as _;
    let best = flate2::Compression::best();
    let mut packed = flate2::write::ZlibEncoder::new(vec![], best);
    packed.write_all(&vec![0; tile]).expect("in memory");
    let packed = packed.finish().expect("in memory");
    let mut file = b"II*\0\0\0\0\0".to_vec();
    file.extend(&packed);
    let length = packed.len() as u32;
    let [places, lengths] = [8, length].map(|value| {
        let start = file.len() as u32;
        file.extend(value.to_le_bytes().repeat(height as usize));
        start
    });
    let start = (file.len() as u32).to_le_bytes();
    file[4..8].copy_from_slice(&start);
    let tags: [(u16, u32, u32); 10] = [
        (256, 1, width),
        (257, 1, height),
        (258, 1, 8),
        (259, 1, 8),
        (262, 1, 1),
        (277, 1, 1),
        (322, 1, tile as u32),
        (323, 1, 1),
        (324, height, places),
        (325, height, lengths),
    ];
    file.extend((tags.len() as u16).to_le_bytes());
    for (tag, count, value) in tags {
        file.extend(tag.to_le_bytes());
        // All are integers of 32 bits.
        file.extend(4_u16.to_le_bytes());
        file.extend(count.to_le_bytes());
        file.extend(value.to_le_bytes());
    }
    file.extend([0; 4]);
    file
}

/// A mask whose left half is white.
pub fn left_half() -> Vec<u8> {
    png([8, 8], |x, _| if x < 4 { 255 } else { 0 })
}

/// Bytes as JSON has them.
pub fn base64(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// A folder with a mask, `left`, of which a document says that it lies on the box from (0, 0) to (40, 40), and
/// a ramp, `ramp`, from 0 to 1 over the same x.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "left.png", &left_half());
    let document = "[raster]\nfile = 'left.png'\nbbox = [0, 0, 40, 40]\nfilter = 'nearest'\n";
    write(folder.path(), "left.toml", document.as_bytes());
    let ramp = br#"{"ramp": {"from": [0, 0], "to": [40, 0]}}"#;
    write(folder.path(), "ramp.json", ramp);
    folder
}

/// Writes a file, in the place of another one at once.
pub fn write(folder: &Path, name: &str, content: &[u8]) {
    let new = folder.join(format!("{name}.new"));
    fs::write(&new, content).expect("writable");
    fs::rename(new, folder.join(name)).expect("renamed");
}
