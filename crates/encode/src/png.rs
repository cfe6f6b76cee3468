//! A picture of the points as PNG: drawn first, then compressed and sent row by row.
//!
//! The picture is all that is held, whatever the number of points.

use std::{
    fmt, io,
    sync::{Arc, Mutex, PoisonError},
};

use bytes::Bytes;
use png::{BitDepth, ColorType, Compression, Encoder, StreamWriter};

use super::{
    EncodeError,
    blocks::Blocks,
    canvas::Canvas,
    head::Head,
    preview::{Coloring, Frame},
    rows::Rows,
};

/// The dots drawn at once; after each batch the request can be cancelled.
const DOTS_AT_ONCE: usize = 1 << 16;

/// The blocks of a picture.
pub(super) struct Png {
    head: Head,
    rows: Rows,
    frame: Frame,
    coloring: Coloring,
    canvas: Canvas,
    block_bytes: usize,
    points: u64,
    state: State,
}

enum State {
    Drawing,
    Writing {
        writer: Box<StreamWriter<'static, Sink>>,
        sink: Sink,
        row: usize,
    },
    Over,
}

impl Png {
    pub(super) fn new(rows: Rows, head: Head, frame: Frame, block_bytes: usize) -> Self {
        let coloring = Coloring::new(rows.schema());
        Self {
            head,
            rows,
            frame,
            coloring,
            canvas: Canvas::new(frame.width, frame.height, coloring.colors),
            block_bytes,
            points: 0,
            state: State::Drawing,
        }
    }

    /// Draws some dots. Returns whether there were any.
    fn draw(&mut self) -> bool {
        let mut drawn = 0;
        while drawn < DOTS_AT_ONCE {
            let Some(batch) = self.rows.next(1024) else {
                break;
            };
            for row in batch.rows() {
                let color = self.coloring.of(row);
                let place = self.frame.place(row);
                self.canvas.dot(place, self.frame.radius, color);
            }
            drawn += batch.points.len();
        }
        self.points += drawn as u64;
        drawn > 0
    }

    /// Writes the header.
    fn start(&self) -> Result<State, EncodeError> {
        let sink = Sink::default();
        let mut encoder = Encoder::new(sink.clone(), self.frame.width, self.frame.height);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(self.canvas.palette());
        encoder.set_compression(Compression::Balanced);
        // Neighboring indices have nothing in common that a difference would show.
        encoder.set_filter(png::Filter::NoFilter);
        for (name, text) in self.head.entries() {
            encoder
                .add_itxt_chunk(name.into(), text)
                .map_err(EncodeError::of)?;
        }
        let writer = encoder.write_header().map_err(EncodeError::of)?;
        let writer = writer.into_stream_writer().map_err(EncodeError::of)?;
        Ok(State::Writing {
            writer: Box::new(writer),
            sink,
            row: 0,
        })
    }

    fn step(&mut self) -> Result<Bytes, EncodeError> {
        match std::mem::replace(&mut self.state, State::Over) {
            State::Drawing => {
                self.state = if self.draw() {
                    State::Drawing
                } else {
                    self.start()?
                };
                Ok(Bytes::new())
            }
            State::Writing {
                mut writer,
                sink,
                mut row,
            } => {
                let height = self.frame.height as usize;
                while row < height && sink.len() < self.block_bytes {
                    let rows = self.canvas.rows(row..row + 1);
                    io::Write::write_all(&mut *writer, rows).map_err(EncodeError::of)?;
                    row += 1;
                }
                if row < height {
                    let written = sink.take();
                    self.state = State::Writing { writer, sink, row };
                    return Ok(written);
                }
                writer.finish().map_err(EncodeError::of)?;
                Ok(sink.take())
            }
            State::Over => Ok(Bytes::new()),
        }
    }
}

impl Blocks for Png {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        (!matches!(self.state, State::Over)).then(|| self.step())
    }
}

impl fmt::Debug for Png {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Png")
            .field("frame", &self.frame)
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}

/// Memory that the writer fills and we empty: it keeps its own end to itself.
#[derive(Clone, Default)]
struct Sink(Arc<Mutex<Vec<u8>>>);

impl Sink {
    fn len(&self) -> usize {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    fn take(&self) -> Bytes {
        let mut written = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *written).into()
    }
}

impl io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut written = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        written.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use crate::{
        Answer, Encoding, Output,
        sample_rows::{answer, head, part},
    };

    #[test]
    fn a_picture_has_the_shape_of_the_region_and_a_color_for_each_layer() {
        let output = Output {
            size: 320,
            ..Output::new(Encoding::Png)
        };
        let (bytes, size) = answer(&output, 1000);
        assert_eq!(size, None);
        let mut decoder = png::Decoder::new(Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().expect("a picture");
        let texts = &reader.info().utf8_text;
        assert!(texts.iter().any(|text| text.keyword == "strew.query"));
        assert_eq!((reader.info().width, reader.info().height), (320, 284));
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("whole");
        let has = |color: [u8; 3]| pixels.chunks_exact(3).any(|pixel| pixel == color);
        assert!(has([255; 3]) && has([0; 3]) && has([0xe6, 0x9f, 0]));
        assert_eq!(bytes, answer(&output, 4096).0, "whatever the blocks");
    }

    #[test]
    fn a_picture_costs_what_it_shows() {
        // 10¹⁴ points on 64 × 64 pixels, and 10⁸ in a strip thinner than one.
        for (bbox, seeds) in [
            ([0.0, 0.0, 1e7, 1e7], &[0][..]),
            ([0.0, 0.0, 1e5, 1e5], &[3]),
            ([0.0, 0.0, 1e8, 1.0], &[0]),
        ] {
            for &seed in seeds {
                let output = Output {
                    size: 64,
                    ..Output::new(Encoding::Png)
                };
                let dense = part(bbox, 1.0, seed);
                let mut dense = Answer::new(dense, head, &output, 4096).expect("drawn");
                let mut bytes = vec![];
                for block in dense.by_ref() {
                    bytes.extend_from_slice(&block.expect("made"));
                }
                assert!(dense.points() < 1_000_000, "{} were made", dense.points());
                let mut decoder = png::Decoder::new(Cursor::new(&bytes));
                decoder.set_transformations(png::Transformations::EXPAND);
                let mut reader = decoder.read_info().expect("a picture");
                let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
                reader.next_frame(&mut pixels).expect("whole");
                let ink = pixels.iter().map(|v| f64::from(255 - v)).sum::<f64>();
                let share = ink / 255.0 / pixels.len() as f64;
                assert!(share > 0.97, "{share} of the picture is black");
            }
        }
    }
}
