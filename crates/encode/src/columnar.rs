//! Formats of columns: the Arrow IPC stream and file. Batches of rows go to a writer of the format, which
//! fills memory that blocks take.

use arrow_array::RecordBatch;
use arrow_ipc::writer::{FileWriter, StreamWriter};
use arrow_schema::{ArrowError, SchemaRef};
use bytes::Bytes;

use super::{EncodeError, batches::Batches, blocks::Blocks, rows::Rows};

/// A writer of a format.
pub(super) trait Writer: Send {
    fn write(&mut self, batch: &RecordBatch) -> Result<(), EncodeError>;
    /// Writes the end.
    fn finish(&mut self) -> Result<(), EncodeError>;
    /// The bytes written since they were last taken.
    fn written(&mut self) -> &mut Vec<u8>;
}

/// The Arrow IPC stream format: a schema, record batches, an end mark.
pub(super) fn arrow_stream(schema: &SchemaRef) -> Result<impl Writer + 'static, EncodeError> {
    StreamWriter::try_new(vec![], schema).map_err(EncodeError::of)
}

/// The Arrow IPC file format, also known as Feather version 2: the stream with a footer that says where
/// batches lie.
pub(super) fn arrow_file(schema: &SchemaRef) -> Result<impl Writer + 'static, EncodeError> {
    FileWriter::try_new(vec![], schema).map_err(EncodeError::of)
}

impl Writer for StreamWriter<Vec<u8>> {
    fn write(&mut self, batch: &RecordBatch) -> Result<(), EncodeError> {
        done(Self::write(self, batch))
    }

    fn finish(&mut self) -> Result<(), EncodeError> {
        done(Self::finish(self))
    }

    fn written(&mut self) -> &mut Vec<u8> {
        self.get_mut()
    }
}

impl Writer for FileWriter<Vec<u8>> {
    fn write(&mut self, batch: &RecordBatch) -> Result<(), EncodeError> {
        done(Self::write(self, batch))
    }

    fn finish(&mut self) -> Result<(), EncodeError> {
        done(Self::finish(self))
    }

    fn written(&mut self) -> &mut Vec<u8> {
        self.get_mut()
    }
}

fn done(result: Result<(), ArrowError>) -> Result<(), EncodeError> {
    result.map_err(EncodeError::of)
}

/// The blocks of an answer in columns.
pub(super) struct Columnar<W> {
    rows: Rows,
    batches: Batches,
    /// `None` once the end is written.
    writer: Option<W>,
    block_bytes: usize,
    points: u64,
}

impl<W: Writer> Columnar<W> {
    pub(super) fn new(rows: Rows, batches: Batches, writer: W, block_bytes: usize) -> Self {
        Self {
            rows,
            batches,
            writer: Some(writer),
            block_bytes,
            points: 0,
        }
    }

    /// Writes a block of rows, or the end. Returns whether there is more.
    fn write(&mut self, writer: &mut W) -> Result<bool, EncodeError> {
        let fill = self.block_bytes / self.batches.row_bytes();
        let Some(batch) = self.rows.next(fill) else {
            if self.points == 0 {
                // This batch brings the names of dictionaries, which readers need even without points.
                writer.write(&self.batches.none()?)?;
            }
            writer.finish()?;
            return Ok(false);
        };
        self.points += batch.points.len() as u64;
        writer.write(&self.batches.make(batch)?)?;
        Ok(true)
    }
}

impl<W> std::fmt::Debug for Columnar<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Columnar")
            .field("rows", &self.rows)
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}

impl<W: Writer> Blocks for Columnar<W> {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        let mut writer = self.writer.take()?;
        let more = match self.write(&mut writer) {
            Ok(more) => more,
            Err(error) => return Some(Err(error)),
        };
        let written = std::mem::take(writer.written());
        self.writer = more.then_some(writer);
        Some(Ok(written.into()))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use arrow_array::{Array as _, cast::AsArray as _, types::Float64Type, types::Int32Type};
    use arrow_ipc::reader::{FileReader, StreamReader};

    use crate::{Encoding, Output, sample_rows::answer};

    #[test]
    fn the_stream_has_the_rows_of_csv() {
        let (csv, _) = answer(&Output::new(Encoding::Csv), 4096);
        let csv = String::from_utf8(csv).expect("UTF-8");
        let (arrow, size) = answer(&Output::new(Encoding::Arrow), 4096);
        assert_eq!(size, None);
        let reader = StreamReader::try_new(Cursor::new(&arrow), None).expect("a stream");
        let metadata = reader.schema().metadata().clone();
        let count = metadata.get("strew.count").map(|count| count.to_string());
        assert_eq!(count, Some((csv.lines().count() - 1).to_string()));
        let mut lines = csv.lines().skip(1);
        let mut batches = 0;
        for batch in reader {
            let batch = batch.expect("whole");
            batches += 1;
            let ids = batch.column(0).as_string::<i32>();
            let [x, y, angle] = [1, 2, 4].map(|i| batch.column(i).as_primitive::<Float64Type>());
            let [layer, variant] = [3, 5].map(|i| batch.column(i).as_dictionary::<Int32Type>());
            let name = |array: &arrow_array::DictionaryArray<Int32Type>, row: usize| {
                let key = array.keys().value(row) as usize;
                array.values().as_string::<i32>().value(key).to_owned()
            };
            for row in 0..batch.num_rows() {
                let mut line = lines.next().expect("as many").splitn(6, ',');
                assert_eq!(line.next(), Some(&*name(layer, row)));
                assert_eq!(line.next(), Some(ids.value(row)));
                for column in [x, y] {
                    let number = line.next().expect("a field").parse();
                    assert_eq!(number, Ok(column.value(row)));
                }
                let number = line.next().expect("a field");
                assert_eq!(number.is_empty(), angle.is_null(row));
                assert!(number.is_empty() || number.parse() == Ok(angle.value(row)));
                let text = line.next().expect("a field");
                let inside = text
                    .strip_prefix('"')
                    .and_then(|text| text.strip_suffix('"'));
                let text = inside.unwrap_or(text);
                assert_eq!(text.replace("\"\"", "\""), name(variant, row));
            }
        }
        assert_eq!(lines.next(), None);
        assert!(batches > 10);
    }

    #[test]
    fn the_same_answer_has_the_same_bytes() {
        let output = Output::new(Encoding::Arrow);
        assert_eq!(answer(&output, 4096), answer(&output, 4096));
    }

    #[test]
    fn the_file_has_the_batches_of_the_stream() {
        let (stream, _) = answer(&Output::new(Encoding::Arrow), 4096);
        let (file, size) = answer(&Output::new(Encoding::Feather), 4096);
        assert_eq!(size, None);
        assert!(file.starts_with(b"ARROW1") && file.ends_with(b"ARROW1"));
        let stream = StreamReader::try_new(Cursor::new(&stream), None).expect("a stream");
        let file = FileReader::try_new(Cursor::new(&file), None).expect("a file");
        assert_eq!(file.schema().fields(), stream.schema().fields());
        // The metadata names the format.
        let [stream, file]: [Vec<_>; 2] = [
            stream
                .map(|batch| batch.expect("whole").columns().to_vec())
                .collect(),
            file.map(|batch| batch.expect("whole").columns().to_vec())
                .collect(),
        ];
        assert_eq!(file, stream);
    }
}
