//! Dots on a white ground, anti-aliased, a byte for each pixel.
//!
//! A byte is a color and how much of it covers the pixel: with one color 255 steps, with eight 31.
//! That is just what an indexed picture of 256 colors holds, so that nothing is converted.

use super::preview::COLORS;

/// A picture under way.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    /// Steps of a color from white to full.
    steps: u8,
    /// 0 is white; a color's steps from 1 follow those of the color before.
    pixels: Vec<u8>,
}

impl Canvas {
    /// A white picture for this number of colors.
    pub(super) fn new(width: u32, height: u32, colors: usize) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self {
            width,
            height,
            steps: (255 / colors.clamp(1, COLORS.len())) as u8,
            pixels: vec![0; width * height],
        }
    }

    /// Draws a dot. Where dots of one color meet, their shares of a pixel add up; of two colors the
    /// one with the larger share stays.
    pub(super) fn dot(&mut self, [x, y]: [f64; 2], radius: f64, color: usize) {
        let reach = radius + 0.5;
        let range = |center: f64, pixels: usize| {
            let first = (center - reach).max(0.0) as usize;
            let end = ((center + reach).max(0.0) as usize + 1).min(pixels);
            first..end
        };
        let before = color as u8 * self.steps;
        for row in range(y, self.height) {
            let dy = row as f64 + 0.5 - y;
            for column in range(x, self.width) {
                let dx = column as f64 + 0.5 - x;
                let share = (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0);
                let share = (share * f64::from(self.steps)).round() as u8;
                if share == 0 {
                    continue;
                }
                let pixel = &mut self.pixels[row * self.width + column];
                let (other, has) = match *pixel {
                    0 => (before, 0),
                    value => (
                        (value - 1) / self.steps * self.steps,
                        (value - 1) % self.steps + 1,
                    ),
                };
                if other == before {
                    *pixel = before + has.saturating_add(share).min(self.steps);
                } else if share >= has {
                    *pixel = before + share;
                }
            }
        }
    }

    /// The rows from top to bottom.
    pub(super) fn rows(&self, rows: std::ops::Range<usize>) -> &[u8] {
        &self.pixels[rows.start * self.width..rows.end * self.width]
    }

    /// The colors of all values, red, green and blue by turns.
    pub(super) fn palette(&self) -> Vec<u8> {
        let mut palette = vec![255; 3];
        for color in COLORS.iter().take(255 / usize::from(self.steps)) {
            for step in 1..=u16::from(self.steps) {
                let steps = u16::from(self.steps);
                let mixed = |channel: u8| {
                    let missing = u16::from(255 - channel);
                    255 - ((missing * step + steps / 2) / steps) as u8
                };
                palette.extend(color.map(mixed));
            }
        }
        palette
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of black in all pixels, in pixels.
    fn ink(canvas: &Canvas) -> f64 {
        let sum: u32 = canvas.pixels.iter().map(|pixel| u32::from(*pixel)).sum();
        f64::from(sum) / 255.0
    }

    #[test]
    fn a_dot_has_the_area_of_its_circle_wherever_it_lies() {
        for radius in [1.0, 2.5, 8.0] {
            for at in [[20.0, 20.0], [20.5, 19.5], [20.3, 20.7]] {
                let mut canvas = Canvas::new(40, 40, 1);
                canvas.dot(at, radius, 0);
                let area = std::f64::consts::PI * radius * radius;
                let error = (ink(&canvas) - area).abs() / area;
                assert!(error < 0.12, "{radius} {at:?}: {}", ink(&canvas));
            }
        }
    }

    #[test]
    fn dots_at_the_edges_are_cut() {
        let mut canvas = Canvas::new(10, 4, 1);
        for at in [
            [0.0, 0.0],
            [10.0, 4.0],
            [9.99, 0.0],
            [5.0, -3.0],
            [-40.0, 2.0],
        ] {
            canvas.dot(at, 2.0, 0);
        }
        assert_eq!(canvas.rows(0..1)[0], 255);
        assert_eq!(canvas.rows(3..4)[9], 255);
        assert_eq!(canvas.rows(0..4).len(), 40);
    }

    #[test]
    fn colors_do_not_mix_and_the_palette_holds_them_all() {
        for colors in 1..=COLORS.len() {
            let mut canvas = Canvas::new(30, 30, colors);
            let palette = canvas.palette();
            assert!(palette.len() <= 3 * 256 && palette[..3] == [255; 3]);
            for (color, channels) in COLORS.iter().enumerate().take(colors) {
                canvas.dot([15.0, 15.0], 5.0, color);
                let value = usize::from(canvas.rows(15..16)[15]);
                assert_eq!(palette[3 * value..3 * value + 3], *channels);
            }
        }
    }
}
