//! A painter: marks as pixels.
//!
//! Lines, dots and letters are covered by the distance of a pixel from them, rectangles by exact areas, and
//! checkers by 4 × 4 samples of a pixel. Everything is painted in the order in which it was drawn.

use super::{
    Drawing, FigureError,
    drawing::{Anchor, Color, INK, Mark, Pen, png_file},
    letters,
};

/// The sides of pictures in pixels.
const SIZES: std::ops::RangeInclusive<u32> = 64..=4096;

impl Drawing {
    /// The drawing as a PNG file, `size` pixels on its longer side, 64 to 4096. Texts have a plain line font of the
    /// crate's own.
    pub fn to_png(&self, size: u32) -> Result<Vec<u8>, FigureError> {
        let wrong = |allowed: String| FigureError::new("size", size, allowed);
        if !SIZES.contains(&size) {
            let (least, most) = (SIZES.start(), SIZES.end());
            return Err(wrong(format!("an integer from {least} to {most} pixels")));
        }
        let scale = f64::from(size) / self.width.max(self.height);
        png([self.width, self.height], scale, &self.marks).map_err(|error| wrong(error.to_string()))
    }
}

/// The picture of some marks on white, `scale` pixels for each unit of the drawing, as a PNG file.
fn png(size: [f64; 2], scale: f64, marks: &[Mark]) -> Result<Vec<u8>, png::EncodingError> {
    let [width, height] = size.map(|v| ((v * scale).round() as usize).max(1));
    let mut canvas = Canvas {
        width,
        height,
        scale,
        pixels: vec![[255.0; 3]; width * height],
    };
    for mark in marks {
        canvas.mark(mark);
    }
    let bytes = canvas.pixels.iter().flatten();
    let bytes: Vec<u8> = bytes.map(|&v| (v + 0.5) as u8).collect();
    let size = [width, height].map(|v| v as u32);
    let kind = (png::ColorType::Rgb, png::BitDepth::Eight);
    png_file(size, kind, png::Compression::default(), &bytes)
}

struct Canvas {
    width: usize,
    height: usize,
    scale: f64,
    pixels: Vec<[f32; 3]>,
}

/// A box of pixels: the first and the one after the last, along x and y.
type Pixels = [[usize; 2]; 2];

impl Canvas {
    fn mark(&mut self, mark: &Mark) {
        match mark {
            Mark::Fill(at, size, color, opacity) => self.fill(*at, *size, *color, *opacity),
            Mark::Lines(lines, pen) => self.lines(lines, *pen),
            Mark::Checkers(rectangles, color) => self.checkers(rectangles, *color),
            Mark::Cells([x, y], [w, h], columns, cells) => {
                let [w, h] = [
                    w / *columns as f64,
                    h * *columns as f64 / cells.len() as f64,
                ];
                for (i, &gray) in cells.iter().enumerate() {
                    let [column, row] = [i % columns, i / columns].map(|v| v as f64);
                    self.fill([x + column * w, y + row * h], [w, h], [gray; 3], 1.0);
                }
            }
            Mark::Text([x, y], size, anchor, text) => {
                let length = letters::length(text, *size);
                let left = match anchor {
                    Anchor::Start => *x,
                    Anchor::Middle => x - length / 2.0,
                    Anchor::End => x - length,
                };
                let strokes = letters::strokes([left, *y], *size, text);
                self.lines(&strokes, (INK, size * letters::WIDTH));
            }
        }
    }

    /// The pixels of a box between two places of the drawing, with a border in pixels.
    fn pixels(&self, low: [f64; 2], high: [f64; 2], border: f64) -> Pixels {
        let most = [self.width, self.height];
        [0, 1].map(|axis| {
            let first = (low[axis] * self.scale - border).floor().max(0.0) as usize;
            let end = (high[axis] * self.scale + border).ceil().max(0.0) as usize;
            [first.min(most[axis]), end.min(most[axis])]
        })
    }

    /// Covers pixels of a box by a color, from 0 not at all to 1 wholly.
    fn cover(
        &mut self,
        [columns, rows]: Pixels,
        color: Color,
        share: impl Fn(usize, usize) -> f64,
    ) {
        for y in rows[0]..rows[1] {
            for x in columns[0]..columns[1] {
                let share = share(x, y) as f32;
                for (v, color) in self.pixels[y * self.width + x].iter_mut().zip(color) {
                    *v += (f32::from(color) - *v) * share;
                }
            }
        }
    }

    fn fill(&mut self, at: [f64; 2], size: [f64; 2], color: Color, opacity: f64) {
        let end = [at[0] + size[0], at[1] + size[1]];
        let scale = self.scale;
        let covered = |axis: usize, pixel: usize| {
            let (low, high) = (at[axis] * scale, end[axis] * scale);
            (high.min(pixel as f64 + 1.0) - low.max(pixel as f64)).clamp(0.0, 1.0)
        };
        let pixels = self.pixels(at, end, 0.0);
        self.cover(pixels, color, |x, y| {
            opacity * covered(1, y) * covered(0, x)
        });
    }

    /// Lines with round ends, covered once where they cross.
    fn lines(&mut self, lines: &[[[f64; 2]; 2]], (color, width): Pen) {
        let ends = || lines.iter().flatten();
        let least = |axis: usize| ends().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let most = |axis: usize| ends().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        if lines.is_empty() {
            return;
        }
        let width = width * self.scale;
        let border = width / 2.0 + 1.0;
        let all = self.pixels([least(0), least(1)], [most(0), most(1)], border);
        let [columns, rows] = all;
        let across = columns[1] - columns[0];
        let mut shares = vec![0f32; across * (rows[1] - rows[0])];
        for &[a, b] in lines {
            let (low, high) = (
                [a[0].min(b[0]), a[1].min(b[1])],
                [a[0].max(b[0]), a[1].max(b[1])],
            );
            let [own_columns, own_rows] = self.pixels(low, high, border);
            let [a, b] = [a, b].map(|p| p.map(|v| v * self.scale));
            for y in own_rows[0]..own_rows[1] {
                for x in own_columns[0]..own_columns[1] {
                    let away = distance([x as f64 + 0.5, y as f64 + 0.5], [a, b]);
                    let share = covered(away, width);
                    let place = &mut shares[(y - rows[0]) * across + x - columns[0]];
                    *place = place.max(share as f32);
                }
            }
        }
        self.cover(all, color, |x, y| {
            shares[(y - rows[0]) * across + x - columns[0]].into()
        });
    }

    fn checkers(&mut self, rectangles: &[[[f64; 2]; 2]], color: Color) {
        /// Samples of a pixel along an axis.
        const SAMPLES: usize = 4;
        let fine = self.scale * SAMPLES as f64;
        // The first sample at or after a place: samples lie in the middle of their part.
        let sample = |v: f64, most: usize| ((v * fine - 0.5).ceil().max(0.0) as usize).min(most);
        let columns = self.width * SAMPLES;
        let mut counts = vec![0u8; self.width];
        let mut flips = vec![false; columns + 1];
        for y in 0..self.height {
            counts.fill(0);
            for row in y * SAMPLES..(y + 1) * SAMPLES {
                flips.fill(false);
                let at = (row as f64 + 0.5) / fine;
                for [[left, top], [w, h]] in rectangles {
                    if (*top..top + h).contains(&at) {
                        for end in [*left, left + w] {
                            flips[sample(end, columns)] ^= true;
                        }
                    }
                }
                let mut is_inside = false;
                for (column, flip) in flips[..columns].iter().enumerate() {
                    is_inside ^= flip;
                    counts[column / SAMPLES] += u8::from(is_inside);
                }
            }
            let row = [[0, self.width], [y, y + 1]];
            let share = |x: usize, _| f64::from(counts[x]) / (SAMPLES * SAMPLES) as f64;
            self.cover(row, color, share);
        }
    }
}

/// The part of a pixel that a line covers, by the distance of their middles. A line thinner than a pixel is paler.
fn covered(away: f64, width: f64) -> f64 {
    (width.max(1.0) / 2.0 + 0.5 - away).clamp(0.0, 1.0) * width.min(1.0)
}

/// The distance of a place from a line between two others.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let from = [p[0] - a[0], p[1] - a[1]];
    let part = if length > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from[0] - part * along[0]).hypot(from[1] - part * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::drawing::sides;

    fn painted(mark: Mark) -> Canvas {
        let mut canvas = Canvas {
            width: 20,
            height: 20,
            scale: 2.0,
            pixels: vec![[255.0; 3]; 400],
        };
        canvas.mark(&mark);
        canvas
    }

    /// The area that is painted black, in units of the drawing.
    fn area(mark: Mark) -> f64 {
        let sum: f32 = painted(mark)
            .pixels
            .iter()
            .map(|p| 1.0 - p[0] / 255.0)
            .sum();
        f64::from(sum) / 4.0
    }

    #[test]
    fn marks_cover_their_areas() {
        let black = [0; 3];
        let near = |mark: Mark, expected: f64| {
            let area = area(mark.clone());
            assert!(
                (area - expected).abs() < 0.06 * expected,
                "{mark:?}: {area}"
            );
        };
        near(Mark::Fill([1.3, 2.1], [3.3, 4.4], black, 1.0), 3.3 * 4.4);
        near(Mark::Fill([1.3, 2.1], [3.3, 4.4], black, 0.5), 1.65 * 4.4);
        near(Mark::Lines(vec![[[5.0, 5.2]; 2]], (black, 6.0)), 28.27);
        // Ends reach half a pixel farther.
        near(
            Mark::Lines(vec![[[2.0, 2.0], [8.0, 2.0]]], (black, 0.2)),
            6.5 * 0.2,
        );
        let stripes = vec![[[1.0, 1.0], [4.0, 8.0]], [[3.0, 1.0], [4.0, 8.0]]];
        near(Mark::Checkers(stripes, black), 32.0);
        near(
            Mark::Cells([1.0, 1.0], [6.0, 4.0], 3, vec![0, 255, 0, 0, 255, 255]),
            12.0,
        );
        let dashed = Mark::Lines(sides([[1.0; 2], [8.0; 2]], 1.0), (black, 0.1));
        // Sixteen dashes, half a pixel longer at both ends.
        near(dashed, 16.0 * 1.5 * 0.1);
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        for mark in [
            Mark::Lines(vec![[[-50.0, 3.0]; 2], [[500.0, 5.0]; 2]], ([0; 3], 3.0)),
            Mark::Fill([11.0, -9.0], [40.0, 4.0], [0; 3], 1.0),
        ] {
            assert_eq!(area(mark), 0.0);
        }
    }
}
