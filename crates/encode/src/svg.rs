//! A picture of the points as SVG: a circle each, y upward, coordinates in pixels.

use super::{
    head::Head,
    members::write_json,
    number::Digits,
    preview::{COLORS, Coloring, Frame},
    rows::{Row, Rows},
    text::TextFormat,
    writer::Writer,
};

/// More circles than this are more than viewers and editors bear.
pub(super) const MOST_POINTS: u64 = 100_000;

#[derive(Debug)]
pub(super) struct Svg {
    head: Head,
    frame: Frame,
    coloring: Coloring,
    digits: Digits,
}

impl Svg {
    /// By default places have two decimals: a hundredth of a pixel.
    pub(super) fn new(rows: &Rows, head: Head, frame: Frame, decimals: Option<u8>) -> Self {
        Self {
            head,
            frame,
            coloring: Coloring::new(rows.schema()),
            digits: Digits::of(decimals.or(Some(2))),
        }
    }
}

impl TextFormat for Svg {
    fn begin(&self, out: &mut Vec<u8>) {
        let Frame { width, height, .. } = self.frame;
        let start = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n<metadata>"
        );
        out.extend_from_slice(start.as_bytes());
        let mut head = vec![];
        write_json(&self.head, &mut head);
        for byte in head {
            match byte {
                b'&' => out.extend_from_slice(b"&amp;"),
                b'<' => out.extend_from_slice(b"&lt;"),
                b'>' => out.extend_from_slice(b"&gt;"),
                byte => out.push(byte),
            }
        }
        out.extend_from_slice(
            b"</metadata>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<g>\n",
        );
    }

    fn row(&self, row: Row<'_>, _first: bool, out: &mut Writer<'_>) {
        let [x, y] = self.frame.place(row);
        out.constant(b"<circle cx=\"");
        out.number(self.digits, x);
        out.constant(b"\" cy=\"");
        out.number(self.digits, y);
        out.constant(b"\" r=\"");
        out.number(Digits::Fixed(2), self.frame.radius);
        if self.coloring.colors > 1 {
            let [red, green, blue] = COLORS[self.coloring.of(row)];
            let fill = format!("\" fill=\"#{red:02x}{green:02x}{blue:02x}");
            out.text(fill.as_bytes());
        }
        out.constant(b"\"/>\n");
    }

    fn end(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"</g>\n</svg>\n");
    }

    fn row_bytes(&self) -> usize {
        100
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        Answer, Encoding, Output,
        sample_rows::{answer, head, part},
    };

    #[test]
    fn a_circle_for_each_point_in_its_layers_color() {
        let (svg, _) = answer(&Output::new(Encoding::Svg), 4096);
        let svg = String::from_utf8(svg).expect("UTF-8");
        let (csv, _) = answer(&Output::new(Encoding::Csv), 4096);
        let csv = String::from_utf8(csv).expect("UTF-8");
        assert!(
            svg.starts_with(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"512\" height=\"454\""
            )
        );
        assert!(svg.contains("&gt;") || !svg.contains("->"));
        let circles: Vec<&str> = svg
            .lines()
            .filter(|line| line.contains("<circle"))
            .collect();
        assert_eq!(circles.len(), csv.lines().count() - 1);
        for (circle, line) in circles.iter().zip(csv.lines().skip(1)) {
            let color = if line.starts_with("trees") {
                "#000000"
            } else {
                "#e69f00"
            };
            assert!(circle.contains(color), "{circle}: {line}");
            let number = |name: &str| {
                let after = circle.split_once(&format!(" {name}=\"")).expect("there").1;
                let digits = after.split_once('"').expect("quoted").0;
                digits.parse::<f64>().expect("a number")
            };
            let mut fields = line.split(',').skip(2).map(str::parse::<f64>);
            let mut next = || fields.next().expect("a field").expect("a number");
            let (x, y) = (next(), next());
            assert!((number("cx") - (x + 10.0) * 12.8).abs() < 0.0051);
            assert!((number("cy") - (40.5 - y) * 12.8).abs() < 0.0051);
        }
        assert!(svg.ends_with("</g>\n</svg>\n"));
    }

    #[test]
    fn too_many_circles_are_refused_with_the_limit() {
        let dense = || part([0.0, 0.0, 400.0, 400.0], 1.0, 3);
        let error =
            Answer::new(dense(), head, &Output::new(Encoding::Svg), 4096).expect_err("many");
        let fault = &error.faults()[0];
        assert_eq!(fault.field, "format");
        assert!(
            fault.allowed.contains("100000")
                && fault.detail.contains(&dense()[0].plan.count().to_string()),
            "{fault}"
        );
        assert!(Answer::new(dense(), head, &Output::new(Encoding::Png), 4096).is_ok());
    }
}
