//! Stipples of a picture, side by side, in 16 shades.

use std::{error::Error, f64::consts::PI, fs::File, io::BufWriter, path::Path};

use crate::pictures::Picture;

/// Pixels of a picture's longer side.
const LONGER: f64 = 450.0;
/// Pixels between two pictures.
const GAP: usize = 12;
/// The area of all dots over that of the paper.
const COVERED: f64 = 0.3;

/// Draws sets of points of a picture.
pub fn side_by_side(
    picture: &Picture,
    sets: &[Vec<[f64; 2]>],
    out: &Path,
) -> Result<(), Box<dyn Error>> {
    let [width, height] = picture.size();
    let scale = LONGER / width.max(height);
    let panels = sets.iter().map(|points| {
        let mut panel = Panel::blank([width, height].map(|v| (v * scale).round() as usize));
        let area = width * height * scale * scale;
        let radius = (area * COVERED / points.len() as f64 / PI).sqrt();
        for [x, y] in points {
            panel.disk([x * scale, (height - y) * scale], radius);
        }
        panel
    });
    write(&panels.collect::<Vec<_>>(), out)
}

/// Shades of paper, 0 for black.
struct Panel {
    width: usize,
    height: usize,
    gray: Vec<f64>,
}

impl Panel {
    fn blank([width, height]: [usize; 2]) -> Self {
        Self {
            width,
            height,
            gray: vec![1.0; width * height],
        }
    }

    fn disk(&mut self, at: [f64; 2], radius: f64) {
        let range = |v: f64, end: usize| {
            let low = (v - radius - 1.0).max(0.0) as usize;
            low..((v + radius + 2.0).max(0.0) as usize).min(end)
        };
        for row in range(at[1], self.height) {
            for column in range(at[0], self.width) {
                let far = (column as f64 + 0.5 - at[0]).hypot(row as f64 + 0.5 - at[1]);
                let covered = (radius + 0.5 - far).clamp(0.0, 1.0);
                self.gray[row * self.width + column] *= 1.0 - covered;
            }
        }
    }
}

/// Writes panels in two columns.
fn write(panels: &[Panel], out: &Path) -> Result<(), Box<dyn Error>> {
    let [across, down] = [panels[0].width, panels[0].height];
    let [width, height] = [(across, 2), (down, panels.len().div_ceil(2))]
        .map(|(side, number)| number * (side + GAP) - GAP);
    let mut gray = vec![1.0; width.next_multiple_of(2) * height];
    let rows = gray.chunks_exact_mut(width.next_multiple_of(2));
    for (y, row) in rows.enumerate() {
        let (line, place) = (y / (down + GAP), y % (down + GAP));
        for (column, panel) in panels.iter().skip(2 * line).take(2).enumerate() {
            if let Some(from) = panel.gray.chunks_exact(across).nth(place) {
                row[column * (across + GAP)..][..across].copy_from_slice(from);
            }
        }
    }
    let shades: Vec<u8> = gray.iter().map(|v| (v * 15.0).round() as u8).collect();
    let pairs = shades.chunks_exact(2).map(|two| two[0] << 4 | two[1]);
    let file = BufWriter::new(File::create(out)?);
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Four);
    encoder.set_compression(png::Compression::High);
    encoder
        .write_header()?
        .write_image_data(&pairs.collect::<Vec<_>>())?;
    Ok(())
}
