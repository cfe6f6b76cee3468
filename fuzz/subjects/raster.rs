//! Rasters and pictures: any file, in each of the ways in which it is read.

use std::io::Cursor;

use strew_core::server::Stop;
use strew_raster::{Image, Limits, Meaning, Place, RasterError, Samples};

const LIMITS: Limits = Limits {
    side: 256,
    pixels: 1 << 14,
};

pub fn run(data: &[u8]) {
    let stop = Stop::default();
    for read in [
        Image::from_bytes(data, Meaning::Data, LIMITS, &stop),
        Image::from_bytes(data, Meaning::Numbers, LIMITS, &stop),
        Image::from_bytes(data, Meaning::Picture, LIMITS, &stop),
        Image::read_picture(Cursor::new(data), LIMITS),
        Image::read_floats(Cursor::new(data), [4, data.len() / 16], LIMITS, &stop),
    ] {
        check(read);
    }
}

fn check(read: Result<Image, RasterError>) {
    let image = match read {
        Ok(image) => image,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    let [width, height] = image.size;
    assert!(width.max(height) <= LIMITS.side);
    assert_eq!(image.samples.len(), width * height);
    if let Samples::F32(values) = &image.samples {
        assert!(values.iter().all(|value| value.is_finite()));
    }
    let missing = image.missing.iter().flatten();
    assert!(image.missing.is_none() || missing.count() == width * height);
    if let Place::Box([min_x, min_y, max_x, max_y]) = image.place {
        assert!(min_x < max_x && min_y < max_y);
    }
}
