//! Pictures of panels, as PNG files.

use std::{fs::File, io::BufWriter, path::Path};

use crate::Outcome;

/// A picture among others: shades from 0 for black to 1, or colors of a palette over 255, row by row.
pub struct Panel {
    pub size: [usize; 2],
    pub shades: Vec<f64>,
}

impl Panel {
    pub fn blank(size: [usize; 2], shade: f64) -> Self {
        let shades = vec![shade; size[0] * size[1]];
        Self { size, shades }
    }

    /// Black dots on white, at places in pixels.
    pub fn dots(size: [usize; 2], places: impl IntoIterator<Item = [f64; 2]>, radius: f64) -> Self {
        let mut panel = Self::blank(size, 1.0);
        for at in places {
            panel.disk(at, radius, |shade, covered| *shade *= 1.0 - covered);
        }
        panel
    }

    /// Paints the pixels of a disk, each by the part of it that is covered.
    pub fn disk(&mut self, at: [f64; 2], radius: f64, paint: impl Fn(&mut f64, f64)) {
        let [columns, rows] = [0, 1].map(|axis| {
            let low = (at[axis] - radius - 1.0).max(0.0) as usize;
            low..((at[axis] + radius + 2.0).max(0.0) as usize).min(self.size[axis])
        });
        for row in rows {
            for column in columns.clone() {
                let far = (column as f64 + 0.5 - at[0]).hypot(row as f64 + 0.5 - at[1]);
                let covered = (radius + 0.5 - far).clamp(0.0, 1.0);
                paint(&mut self.shades[row * self.size[0] + column], covered);
            }
        }
    }
}

/// Writes panels of one size, in rows of `across`, with a gap between them. Gray has 2^`bits` shades, and so has a
/// palette, whose first color is the paper.
pub fn write(
    out: &Path,
    panels: &[Panel],
    [across, gap]: [usize; 2],
    bits: u8,
    palette: Option<Vec<u8>>,
) -> Outcome {
    let [w, h] = panels.first().ok_or("nothing to draw")?.size;
    let down = panels.len().div_ceil(across);
    let [width, height] = [(w, across), (h, down)].map(|(side, n)| n * (side + gap) - gap);
    let paper = if palette.is_some() { 0.0 } else { 1.0 };
    let level = |shade: &f64| (shade * f64::from((1u16 << bits) - 1)).round() as u16;
    let pixels = usize::from(8 / bits);
    let mut bytes = Vec::new();
    for y in 0..height {
        let mut line = vec![paper; width.next_multiple_of(pixels)];
        let shown = panels.iter().skip(y / (h + gap) * across).take(across);
        for (column, panel) in shown.enumerate() {
            if let Some(from) = panel.shades.chunks_exact(w).nth(y % (h + gap)) {
                line[column * (w + gap)..][..w].copy_from_slice(from);
            }
        }
        let packed = |some: &[f64]| some.iter().fold(0, |byte, v| byte << bits | level(v)) as u8;
        bytes.extend(line.chunks_exact(pixels).map(packed));
    }
    let file = BufWriter::new(File::create(out)?);
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    if let Some(palette) = palette {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
    }
    encoder.set_depth(png::BitDepth::from_u8(bits).ok_or("no depth of pixels")?);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(())
}
