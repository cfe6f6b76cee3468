//! Pictures of points, as PNG files.

use std::{fs, path::Path};

use strew_forge::figure::Drawing;

use crate::Outcome;

/// The space between panels.
const GAP: f64 = 12.0;
/// The longest side of a picture, in pixels.
const LONGEST: f64 = 4096.0;

/// Black dots of a panel: their places in pixels from the upper left corner, and their diameter.
pub type Dots = (Vec<[f64; 2]>, f64);

/// Draws panels of one size, in rows of two.
pub fn write(out: &Path, panels: &[Dots], size: [f64; 2]) -> Outcome {
    let sheet = [2, panels.len().div_ceil(2)];
    let sheet = [0, 1].map(|i| sheet[i] as f64 * (size[i] + GAP) - GAP);
    let mut drawing = Drawing::new(sheet[0], sheet[1]);
    for (number, (places, diameter)) in panels.iter().enumerate() {
        let at = [number % 2, number / 2];
        let corner = [0, 1].map(|i| at[i] as f64 * (size[i] + GAP));
        let places = places.iter().map(|p| [0, 1].map(|i| corner[i] + p[i]));
        drawing.dots(places, *diameter, [0; 3]);
    }
    save(out, &drawing, sheet)
}

/// Writes a drawing, a pixel a unit, or fewer if it is large.
pub fn save(out: &Path, drawing: &Drawing, [width, height]: [f64; 2]) -> Outcome {
    let size = width.max(height).min(LONGEST).round() as u32;
    Ok(fs::write(out, drawing.to_png(size)?)?)
}
