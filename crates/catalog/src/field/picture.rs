//! Pictures of fields.

use png::{BitDepth, ColorType, Encoder};
use strew_core::{Field as _, Region, server::Stop};
use strew_error::{Error, Fault};

use super::NamedField;

/// The side of a picture in pixels.
pub const SIDE: usize = 256;

impl NamedField {
    /// The price of a picture of a chunk, in microseconds.
    pub fn picture_price(&self, size: f64, cell: [i64; 2]) -> u128 {
        /// The nanoseconds to place and pack a pixel.
        const PIXEL: f64 = 20.0;
        let look = Region::chunk(size, cell).map_or(0.0, |region| self.spec.nanoseconds(region));
        ((SIDE * SIDE) as f64 * (PIXEL + look) / 1e3) as u128
    }

    /// The shares at the centers of the pixels of a chunk, as a gray PNG: black for 0.
    pub fn picture(&self, size: f64, cell: [i64; 2], stop: &Stop) -> Result<Vec<u8>, Error> {
        let refused = |detail: String| {
            let value = format!("{size}/{}/{}", cell[0], cell[1]);
            Error::from(Fault::new(
                "chunk",
                value,
                detail,
                "a chunk of finite coordinates",
            ))
        };
        let region = Region::chunk(size, cell).map_err(|error| refused(error.to_string()))?;
        let (min, max) = (region.min(), region.max());
        let step = [0, 1].map(|axis| (max[axis] - min[axis]) / SIDE as f64);
        let share = |i: usize| {
            let (column, row) = (i % SIDE, SIDE - 1 - i / SIDE);
            let at = [
                min[0] + (column as f64 + 0.5) * step[0],
                min[1] + (row as f64 + 0.5) * step[1],
            ];
            (self.spec.share(at) * 255.0 + 0.5) as u8
        };
        let mut pixels = Vec::with_capacity(SIDE * SIDE);
        for row in 0..SIDE {
            if stop.is_raised() {
                return Err(Error::Internal("a picture was not wanted any more"));
            }
            pixels.extend((row * SIDE..(row + 1) * SIDE).map(share));
        }
        write(&pixels).map_err(|_| Error::Internal("a picture cannot be written"))
    }
}

fn write(pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let side = SIDE as u32;
    let mut file = vec![];
    let mut encoder = Encoder::new(&mut file, side, side);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}
