//! A drawing: marks in pixels, written as SVG.

use std::fmt::Write as _;

/// A finished figure.
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
    width: f64,
    height: f64,
    body: String,
}

/// A color, as red, green and blue.
pub(super) type Color = [u8; 3];

/// Where a text begins, relative to its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

pub(super) const INK: Color = [34, 34, 34];
pub(super) const GRAY: Color = [128, 128, 128];
pub(super) const PALE: Color = [232, 232, 232];

/// Colors that are told apart with every kind of color vision (Okabe and Ito, 2008).
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
    ///
    /// ```
    /// use strew_forge::figure;
    ///
    /// let svg = figure::index("1.6".parse()?, 24)?.to_svg();
    /// assert!(svg.ends_with("</svg>\n") && svg.contains("α = 8/5"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }

    pub(super) const fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            body: String::new(),
        }
    }

    fn add(&mut self, mark: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.body, "{mark}");
    }

    /// A filled rectangle from its upper left corner.
    pub(super) fn fill(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], color: Color, opacity: f64) {
        let color = hex(color);
        self.add(format_args!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"{color}\" \
             fill-opacity=\"{opacity}\" shape-rendering=\"crispEdges\"/>"
        ));
    }

    /// The outline of a rectangle from its upper left corner, dashed if `dash` is above 0.
    pub(super) fn outline(
        &mut self,
        [x, y]: [f64; 2],
        [w, h]: [f64; 2],
        (color, width): (Color, f64),
        dash: f64,
    ) {
        let color = hex(color);
        let dash = match dash > 0.0 {
            true => format!(" stroke-dasharray=\"{dash}\""),
            false => String::new(),
        };
        self.add(format_args!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"none\" \
             stroke=\"{color}\" stroke-width=\"{width}\"{dash}/>"
        ));
    }

    /// Lines between pairs of places, as one path.
    pub(super) fn lines(
        &mut self,
        lines: impl IntoIterator<Item = [[f64; 2]; 2]>,
        (color, width): (Color, f64),
    ) {
        let mut path = String::new();
        for [[a, b], [c, d]] in lines {
            let _ = write!(path, "M{a:.2} {b:.2}L{c:.2} {d:.2}");
        }
        self.stroke(&path, color, width);
    }

    /// One line through many places.
    pub(super) fn curve(&mut self, places: &[[f64; 2]], (color, width): (Color, f64)) {
        let mut path = String::new();
        for (i, [x, y]) in places.iter().enumerate() {
            let _ = write!(path, "{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' });
        }
        self.stroke(&path, color, width);
    }

    /// Dots of one diameter and color, as one path.
    pub(super) fn dots(
        &mut self,
        places: impl IntoIterator<Item = [f64; 2]>,
        diameter: f64,
        color: Color,
    ) {
        let mut path = String::new();
        for [x, y] in places {
            let _ = write!(path, "M{x:.2} {y:.2}h0");
        }
        self.stroke(&path, color, diameter);
    }

    fn stroke(&mut self, path: &str, color: Color, width: f64) {
        if !path.is_empty() {
            let color = hex(color);
            self.add(format_args!(
                "<path d=\"{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
                 stroke-linecap=\"round\" stroke-linejoin=\"round\"/>"
            ));
        }
    }

    /// A circle without filling.
    pub(super) fn ring(&mut self, [x, y]: [f64; 2], radius: f64, (color, width): (Color, f64)) {
        let color = hex(color);
        self.add(format_args!(
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"none\" stroke=\"{color}\" \
             stroke-width=\"{width}\"/>"
        ));
    }

    /// Fills what an odd number of rectangles covers, each from its upper left corner: stripes in both
    /// directions make a checkered field.
    pub(super) fn checkers(
        &mut self,
        rectangles: impl IntoIterator<Item = [[f64; 2]; 2]>,
        color: Color,
    ) {
        let mut path = String::new();
        for [[x, y], [w, h]] in rectangles {
            let _ = write!(path, "M{x:.2} {y:.2}h{w:.2}v{h:.2}h{:.2}z", -w);
        }
        let color = hex(color);
        self.add(format_args!(
            "<path d=\"{path}\" fill=\"{color}\" fill-rule=\"evenodd\"/>"
        ));
    }

    /// A text on the line of writing at a place. Characters of XML are escaped.
    pub(super) fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        let text = text
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        let (color, anchor) = (
            hex(INK),
            match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            },
        );
        self.add(format_args!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" fill=\"{color}\" \
             text-anchor=\"{anchor}\">{text}</text>"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
