//! Formats of columns: the Arrow IPC stream and file here, [Parquet](super::parquet) beside it. Rows go to a writer of
//! the format, which fills memory that blocks take.

use std::{fmt, mem};

use arrow_array::RecordBatch;
use arrow_ipc::writer::{FileWriter, StreamWriter};
use arrow_schema::ArrowError;
use bytes::Bytes;

use super::{EncodeError, batches::Batches, blocks::Blocks, rows::Rows};

/// A writer of a format.
pub(super) trait Writer: Send {
    /// Writes the next rows and returns their number, or writes the end if there are no more.
    fn write(&mut self, rows: &mut Rows) -> Result<Option<usize>, EncodeError>;
    /// The bytes written since they were last taken.
    fn written(&mut self) -> &mut Vec<u8>;
}

/// The blocks of an answer in columns.
pub(super) struct Columnar<W> {
    rows: Rows,
    /// `None` once the end is written.
    writer: Option<W>,
    points: u64,
}

impl<W: Writer> Columnar<W> {
    pub(super) const fn new(rows: Rows, writer: W) -> Self {
        Self {
            rows,
            writer: Some(writer),
            points: 0,
        }
    }
}

impl<W> fmt::Debug for Columnar<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
        let rows = match writer.write(&mut self.rows) {
            Ok(rows) => rows,
            Err(error) => return Some(Err(error)),
        };
        self.points += rows.unwrap_or_default() as u64;
        let written = mem::take(writer.written());
        self.writer = rows.is_some().then_some(writer);
        Some(Ok(written.into()))
    }
}

/// A writer of Arrow IPC.
pub(super) struct Arrow {
    batches: Batches,
    ipc: Ipc,
    /// The rows of a batch.
    fill: usize,
    is_empty: bool,
}

enum Ipc {
    /// A schema, record batches, an end mark.
    Stream(StreamWriter<Vec<u8>>),
    /// The file format, also known as Feather version 2: the stream with a footer that says where batches lie.
    File(FileWriter<Vec<u8>>),
}

impl Arrow {
    /// A stream or a file of batches, each of about so many bytes.
    pub(super) fn new(batches: Batches, is_file: bool, bytes: usize) -> Result<Self, EncodeError> {
        let schema = batches.schema();
        let ipc = match is_file {
            true => FileWriter::try_new(vec![], schema).map(Ipc::File),
            false => StreamWriter::try_new(vec![], schema).map(Ipc::Stream),
        };
        Ok(Self {
            ipc: ipc.map_err(EncodeError::of)?,
            fill: bytes / batches.row_bytes(),
            batches,
            is_empty: true,
        })
    }
}

impl Writer for Arrow {
    fn write(&mut self, rows: &mut Rows) -> Result<Option<usize>, EncodeError> {
        let Some(batch) = rows.next(self.fill) else {
            if self.is_empty {
                // This batch brings the names of dictionaries, which readers need even without points.
                self.ipc.write(&self.batches.none()?)?;
            }
            self.ipc.finish()?;
            return Ok(None);
        };
        self.is_empty = false;
        let count = batch.points.len();
        self.ipc.write(&self.batches.make(batch)?)?;
        Ok(Some(count))
    }

    fn written(&mut self) -> &mut Vec<u8> {
        match &mut self.ipc {
            Ipc::Stream(writer) => writer.get_mut(),
            Ipc::File(writer) => writer.get_mut(),
        }
    }
}

impl Ipc {
    fn write(&mut self, batch: &RecordBatch) -> Result<(), EncodeError> {
        done(match self {
            Self::Stream(writer) => writer.write(batch),
            Self::File(writer) => writer.write(batch),
        })
    }

    fn finish(&mut self) -> Result<(), EncodeError> {
        done(match self {
            Self::Stream(writer) => writer.finish(),
            Self::File(writer) => writer.finish(),
        })
    }
}

fn done(result: Result<(), ArrowError>) -> Result<(), EncodeError> {
    result.map_err(EncodeError::of)
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
