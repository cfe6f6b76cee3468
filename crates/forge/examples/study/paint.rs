//! Pictures of points, as PNG files.

use std::{fs, path::Path};

use strew_forge::figure::{Color, Drawing};

use crate::Outcome;

/// The space between panels.
const GAP: f64 = 12.0;
/// The longest side of a picture, in pixels.
const LONGEST: f64 = 4096.0;

/// Dots of a panel: their places in pixels from the upper left corner, their diameter and color.
pub type Dots = (Vec<[f64; 2]>, f64, Color);

/// Draws panels of one size, in rows of `across`.
pub fn write(out: &Path, panels: &[Vec<Dots>], size: [f64; 2], across: usize) -> Outcome {
    let sheet = [across.min(panels.len()), panels.len().div_ceil(across)];
    let sheet = [0, 1].map(|i| sheet[i] as f64 * (size[i] + GAP) - GAP);
    let mut drawing = Drawing::new(sheet[0], sheet[1]);
    for (number, panel) in panels.iter().enumerate() {
        let at = [number % across, number / across];
        let corner = [0, 1].map(|i| at[i] as f64 * (size[i] + GAP));
        for (places, diameter, color) in panel {
            let is_inside = |p: &&[f64; 2]| (0..2).all(|i| (0.0..size[i]).contains(&p[i]));
            let inside = places.iter().filter(is_inside);
            let inside = inside.map(|p| [0, 1].map(|i| corner[i] + p[i]));
            drawing.dots(inside, *diameter, *color);
        }
    }
    save(out, &drawing, sheet)
}

/// Writes a drawing, a pixel a unit, or fewer if it is large.
pub fn save(out: &Path, drawing: &Drawing, [width, height]: [f64; 2]) -> Outcome {
    let size = width.max(height).min(LONGEST).round() as u32;
    Ok(fs::write(out, drawing.to_png(size)?)?)
}
