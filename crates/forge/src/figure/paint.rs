//! A painter: marks as pixels.
//!
//! Everything is painted in the order in which it was drawn, without vectors of processors, so that the same drawing has
//! the same bytes everywhere.

use tiny_skia::{
    ColorU8, FillRule, LineCap, Paint, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, Transform,
};

use super::{
    Drawing, FigureError,
    drawing::{Anchor, Color, INK, Mark, Pen, Rectangle, png_file},
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
    let size = size.map(|v| ((v * scale).round() as u32).max(1));
    let pixels = painted(size, scale, marks);
    let bytes: Vec<u8> = pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
    let kind = (png::ColorType::Rgb, png::BitDepth::Eight);
    png_file(size, kind, png::Compression::default(), &bytes)
}

/// The pixels, row by row; none of a picture without area.
fn painted([width, height]: [u32; 2], scale: f64, marks: &[Mark]) -> Vec<[u8; 4]> {
    let Some(mut pixels) = Pixmap::new(width, height) else {
        return vec![];
    };
    pixels.fill(tiny_skia::Color::WHITE);
    let scaled = Transform::from_scale(scale as f32, scale as f32);
    for mark in marks {
        // What has no area is none.
        let _ = paint(&mut pixels, scaled, mark);
    }
    pixels.data().as_chunks().0.to_vec()
}

fn paint(pixels: &mut Pixmap, scaled: Transform, mark: &Mark) -> Option<()> {
    match mark {
        Mark::Fill(at, size, color, opacity) => {
            let area = rectangle([*at, *size])?;
            pixels.fill_rect(area, &shade(*color, *opacity), scaled, None);
        }
        Mark::Lines(lines, pen) => stroke(pixels, scaled, lines, *pen)?,
        Mark::Checkers(rectangles, color) => {
            let mut path = PathBuilder::new();
            let areas = rectangles.iter().filter_map(|&area| rectangle(area));
            areas.for_each(|area| path.push_rect(area));
            let (path, paint) = (path.finish()?, shade(*color, 1.0));
            pixels.fill_path(&path, &paint, FillRule::EvenOdd, scaled, None);
        }
        Mark::Cells(at, size, columns, cells) => {
            let [x, y, width, height] = single([*at, *size].as_flattened());
            let [columns, rows] = [*columns, cells.len() / columns].map(|v| v as u32);
            let mut grays = Pixmap::new(columns, rows)?;
            for (pixel, &gray) in grays.pixels_mut().iter_mut().zip(cells) {
                *pixel = ColorU8::from_rgba(gray, gray, gray, 255).premultiply();
            }
            let placed = scaled.pre_translate(x, y);
            let placed = placed.pre_scale(width / columns as f32, height / rows as f32);
            pixels.draw_pixmap(0, 0, grays.as_ref(), &PixmapPaint::default(), placed, None);
        }
        Mark::Text([x, y], size, anchor, text) => {
            let length = letters::length(text, *size);
            let left = match anchor {
                Anchor::Start => *x,
                Anchor::Middle => x - length / 2.0,
                Anchor::End => x - length,
            };
            let lines = letters::strokes([left, *y], *size, text);
            stroke(pixels, scaled, &lines, (INK, size * letters::WIDTH))?;
        }
    }
    Some(())
}

/// Lines with round ends, covered once where they cross.
fn stroke(
    pixels: &mut Pixmap,
    scaled: Transform,
    lines: &[[[f64; 2]; 2]],
    (color, width): Pen,
) -> Option<()> {
    let mut path = PathBuilder::new();
    for line in lines {
        let [ax, ay, bx, by] = single(line.as_flattened());
        path.move_to(ax, ay);
        path.line_to(bx, by);
    }
    let pen = Stroke {
        width: width as f32,
        line_cap: LineCap::Round,
        ..Stroke::default()
    };
    pixels.stroke_path(&path.finish()?, &shade(color, 1.0), &pen, scaled, None);
    Some(())
}

fn shade([r, g, b]: Color, opacity: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, (opacity * 255.0).round() as u8);
    paint
}

fn rectangle(area: Rectangle) -> Option<Rect> {
    let [x, y, width, height] = single(area.as_flattened());
    Rect::from_xywh(x, y, width, height)
}

fn single(numbers: &[f64]) -> [f32; 4] {
    std::array::from_fn(|i| numbers[i] as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::drawing::sides;

    /// The area that is painted black, in units of the drawing.
    fn area(mark: Mark) -> f64 {
        let pixels = painted([20; 2], 2.0, &[mark]);
        let shares = pixels.iter().map(|p| 1.0 - f64::from(p[0]) / 255.0);
        shares.sum::<f64>() / 4.0
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
        let dashed = Mark::Lines(sides([[1.0; 2], [8.0; 2]], 2.0), (black, 1.0));
        // Eight dashes with round ends.
        near(dashed, 8.0 * (2.0 + 0.785));
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
