//! Thousands of dots as one SVG path, thousands of gray cells as one embedded PNG. The plotting
//! library would write an element for each.

use std::{fmt::Write as _, ops::Range};

use base64::{Engine as _, prelude::BASE64_STANDARD};

/// The diameter of a dot, in pixels.
const DOT: f64 = 4.0;

/// The extent of a panel's plot, in pixels from the upper left corner of the picture.
pub(super) struct Frame {
    pub(super) x: Range<f64>,
    pub(super) y: Range<f64>,
}

/// Returns a path of dots. Places are in [0, 1]² from the lower left corner of the frame.
pub(super) fn dots(frame: &Frame, places: impl Iterator<Item = [f64; 2]>) -> String {
    let mut path = String::new();
    for [x, y] in places {
        let px = frame.x.start + x * (frame.x.end - frame.x.start);
        let py = frame.y.end - y * (frame.y.end - frame.y.start);
        let _ = write!(path, "M{px:.1} {py:.1}h0");
    }
    format!(
        "<path fill=\"none\" stroke=\"#000000\" stroke-width=\"{DOT}\" stroke-linecap=\"round\" \
         d=\"{path}\"/>\n"
    )
}

/// Returns an image of gray cells over the whole frame; rows of `columns` cells from the top.
pub(super) fn gray(
    frame: &Frame,
    columns: u32,
    cells: &[u8],
) -> Result<String, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns, cells.len() as u32 / columns.max(1));
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    // This level has a single implementation, whichever features of the compressor other parts of a
    // program enable. So the same picture has the same bytes.
    encoder.set_compression(png::Compression::Fast);
    encoder.write_header()?.write_image_data(cells)?;
    let (width, height) = (frame.x.end - frame.x.start, frame.y.end - frame.y.start);
    Ok(format!(
        "<image x=\"{}\" y=\"{}\" width=\"{width}\" height=\"{height}\" \
         preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{}\"/>\n",
        frame.x.start,
        frame.y.start,
        BASE64_STANDARD.encode(bytes)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_and_cells_are_in_their_frame() {
        let frame = Frame {
            x: 10.0..110.0,
            y: 20.0..70.0,
        };
        let path = dots(&frame, [[0.0, 0.0], [0.5, 1.0]].into_iter());
        assert!(path.contains("M10.0 70.0h0M60.0 20.0h0"), "{path}");
        let image = gray(&frame, 3, &[0, 128, 255, 1, 2, 3]).expect("small");
        assert!(image.contains("width=\"100\" height=\"50\""), "{image}");
        let data = image
            .split("base64,")
            .nth(1)
            .and_then(|d| d.split('"').next());
        let bytes = BASE64_STANDARD.decode(data.expect("data")).expect("valid");
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .expect("PNG");
        let mut cells = vec![0; 6];
        reader.next_frame(&mut cells).expect("an image");
        assert_eq!(cells, [0, 128, 255, 1, 2, 3]);
    }
}
