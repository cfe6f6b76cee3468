//! A drawing: a list of marks in pixels, written as SVG or painted as PNG.

use std::fmt::{self, Write as _};

use base64::{Engine as _, prelude::BASE64_STANDARD};

/// A figure. Places and lengths are in pixels, from the upper left corner.
///
/// ```
/// use strew_forge::figure;
///
/// let drawing = figure::index("sqrt(3)".parse()?, 24)?;
/// assert!(drawing.to_svg().starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) marks: Vec<Mark>,
}

/// A color, as red, green and blue.
pub type Color = [u8; 3];

/// The part of a text that its place names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A color with the width of its line.
pub type Pen = (Color, f64);

/// The upper left corner and the size of a rectangle.
pub type Rectangle = [[f64; 2]; 2];

/// The marks on a drawing, one over another.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A filled rectangle: its upper left corner, its size, its color and opacity.
    Fill([f64; 2], [f64; 2], Color, f64),
    /// Lines with round ends. One between equal places is a disk.
    Lines(Vec<[[f64; 2]; 2]>, Pen),
    /// The area that an odd number of rectangles covers: stripes in both directions make a checkered field.
    Checkers(Vec<Rectangle>, Color),
    /// A rectangle of gray cells: its upper left corner, its size, the number of columns, and the cells by rows from the top.
    Cells([f64; 2], [f64; 2], usize, Vec<u8>),
    /// A text on the line of writing at a place, with its size.
    Text([f64; 2], f64, Anchor, String),
}

pub(super) const INK: Color = [34, 34, 34];
pub(super) const GRAY: Color = [128, 128, 128];
pub(super) const PALE: Color = [232, 232, 232];

/// Colors that differ with every kind of color vision (Okabe and Ito, 2008).
pub(super) const COLORS: [Color; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [148, 103, 40],
];

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

impl Drawing {
    /// The drawing as an SVG document.
    pub fn to_svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for mark in &self.marks {
            // Writing to a string cannot fail.
            let _ = writeln!(svg, "{mark}");
        }
        svg + "</svg>\n"
    }

    /// A white page.
    pub const fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            marks: vec![],
        }
    }

    /// A filled rectangle.
    pub(super) fn fill(&mut self, [at, size]: Rectangle, color: Color, opacity: f64) {
        self.marks.push(Mark::Fill(at, size, color, opacity));
    }

    /// The outline of a rectangle, dashed if `dash` is above 0.
    pub(super) fn outline(&mut self, rectangle: Rectangle, pen: Pen, dash: f64) {
        self.lines(sides(rectangle, dash), pen);
    }

    /// Lines between pairs of places, as one path.
    pub fn lines(&mut self, lines: impl IntoIterator<Item = [[f64; 2]; 2]>, pen: Pen) {
        let lines: Vec<_> = lines.into_iter().collect();
        self.unless_empty(lines.is_empty(), Mark::Lines(lines, pen));
    }

    /// One line through many places.
    pub(super) fn curve(&mut self, places: impl IntoIterator<Item = [f64; 2]>, pen: Pen) {
        let places: Vec<_> = places.into_iter().collect();
        self.lines(places.windows(2).map(|pair| [pair[0], pair[1]]), pen);
    }

    /// Dots of one diameter and color, as one path.
    pub fn dots(
        &mut self,
        places: impl IntoIterator<Item = [f64; 2]>,
        diameter: f64,
        color: Color,
    ) {
        self.lines(places.into_iter().map(|at| [at; 2]), (color, diameter));
    }

    fn unless_empty(&mut self, is_empty: bool, mark: Mark) {
        if !is_empty {
            self.marks.push(mark);
        }
    }

    /// Gray cells over a rectangle; rows of `columns` cells from the top.
    pub fn cells(&mut self, [at, size]: Rectangle, columns: usize, cells: Vec<u8>) {
        self.unless_empty(cells.is_empty(), Mark::Cells(at, size, columns, cells));
    }

    /// A text on the line of writing at a place.
    pub fn text(&mut self, at: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        self.unless_empty(text.is_empty(), Mark::Text(at, size, anchor, text.into()));
    }
}

impl fmt::Display for Mark {
    /// As an element of SVG.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fill([x, y], [w, h], color, opacity) => write!(
                f,
                "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"{}\" \
                 fill-opacity=\"{opacity}\" shape-rendering=\"crispEdges\"/>",
                hex(*color)
            ),
            Self::Lines(lines, (color, width)) => {
                f.write_str("<path d=\"")?;
                let mut end = None;
                for &[from, to] in lines {
                    if end.replace(to) != Some(from) {
                        write!(f, "M{:.2} {:.2}", from[0], from[1])?;
                    }
                    match from == to {
                        true => f.write_str("h0")?,
                        false => write!(f, "L{:.2} {:.2}", to[0], to[1])?,
                    }
                }
                write!(
                    f,
                    "\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linecap=\"round\" \
                     stroke-linejoin=\"round\"/>",
                    hex(*color)
                )
            }
            Self::Checkers(rectangles, color) => {
                f.write_str("<path d=\"")?;
                for [[x, y], [w, h]] in rectangles {
                    write!(f, "M{x:.2} {y:.2}h{w:.2}v{h:.2}h{:.2}z", -w)?;
                }
                write!(f, "\" fill=\"{}\" fill-rule=\"evenodd\"/>", hex(*color))
            }
            // As an image: an element for each cell would take a hundred times as much.
            Self::Cells([x, y], [w, h], columns, cells) => {
                let size = [*columns, cells.len() / columns.max(&1)].map(|v| v as u32);
                let gray = (png::ColorType::Grayscale, png::BitDepth::Eight);
                // This level has a single implementation, whichever features of the compressor other parts of a
                // program enable. So the same picture has the same bytes.
                let file = png_file(size, gray, png::Compression::Fast, cells);
                write!(
                    f,
                    "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" \
                 preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
                 href=\"data:image/png;base64,{}\"/>",
                    BASE64_STANDARD.encode(file.map_err(|_| fmt::Error)?)
                )
            }
            Self::Text([x, y], size, anchor, text) => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let text = text
                    .replace('&', "&amp;")
                    .replace('<', "&lt;")
                    .replace('>', "&gt;");
                write!(
                    f,
                    "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" fill=\"{}\" \
                     text-anchor=\"{anchor}\">{text}</text>",
                    hex(INK)
                )
            }
        }
    }
}

/// Pixels of some kind, row by row from the top, as a PNG file.
pub(crate) fn png_file(
    [width, height]: [u32; 2],
    (color, depth): (png::ColorType, png::BitDepth),
    compression: png::Compression,
    bytes: &[u8],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(compression);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}

/// The sides of a rectangle, in dashes if their length is above 0.
pub(super) fn sides([[x, y], [w, h]]: Rectangle, dash: f64) -> Vec<[[f64; 2]; 2]> {
    let corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
    let sides = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]);
    if dash <= 0.0 {
        return sides.collect();
    }
    let mut all = vec![];
    for [a, b] in sides {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let at = |v: f64| {
            let part = if length > 0.0 {
                v.min(length) / length
            } else {
                0.0
            };
            [a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part]
        };
        let dashes = (length / (2.0 * dash)).ceil() as usize;
        all.extend((0..dashes).map(|i| {
            let start = 2.0 * dash * i as f64;
            [at(start), at(start + dash)]
        }));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_an_image_of_them() {
        let mut drawing = Drawing::new(100.0, 50.0);
        let cells = vec![0, 128, 255, 1, 2, 3];
        drawing.cells([[10.0, 20.0], [60.0, 30.0]], 3, cells.clone());
        let svg = drawing.to_svg();
        assert!(svg.contains("width=\"60.00\" height=\"30.00\""), "{svg}");
        let data = svg
            .split("base64,")
            .nth(1)
            .and_then(|d| d.split('"').next());
        let bytes = BASE64_STANDARD.decode(data.expect("data")).expect("valid");
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().expect("PNG");
        let mut found = vec![0; 6];
        reader.next_frame(&mut found).expect("an image");
        assert_eq!(found, cells);
    }

    #[test]
    fn texts_are_escaped_and_empty_paths_left_out() {
        let mut drawing = Drawing::new(10.0, 20.0);
        drawing.dots([], 2.0, INK);
        drawing.text([1.0, 2.0], 9.0, Anchor::End, "dX < t & dY");
        let svg = drawing.to_svg();
        assert!(svg.contains("dX &lt; t &amp; dY</text>"), "{svg}");
        assert!(!svg.contains("<path"), "{svg}");
    }
}
