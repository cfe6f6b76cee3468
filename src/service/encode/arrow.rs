//! The Arrow IPC stream format: a schema, record batches of about a block each, an end mark.

use arrow_ipc::writer::StreamWriter;
use bytes::Bytes;

use super::{Blocks, EncodeError, batches::Batches, head::Head, rows::Rows};

/// The blocks of an Arrow stream.
pub(super) struct Arrow {
    rows: Rows,
    batches: Batches,
    /// Gone when all is said.
    writer: Option<StreamWriter<Vec<u8>>>,
    block_bytes: usize,
    points: u64,
}

impl Arrow {
    pub(super) fn new(rows: Rows, head: &Head, block_bytes: usize) -> Result<Self, EncodeError> {
        let batches = Batches::new(rows.schema(), head);
        let writer = StreamWriter::try_new(vec![], batches.schema()).map_err(EncodeError::of)?;
        Ok(Self {
            rows,
            batches,
            writer: Some(writer),
            block_bytes,
            points: 0,
        })
    }

    /// Writes the next rows, or the end; gives what has been written.
    fn write(&mut self, writer: &mut StreamWriter<Vec<u8>>) -> Result<bool, EncodeError> {
        let most = self.block_bytes / self.batches.row_bytes();
        let Some(batch) = self.rows.next(most) else {
            writer.finish().map_err(EncodeError::of)?;
            return Ok(false);
        };
        self.points += batch.points.len() as u64;
        let batch = self.batches.make(batch)?;
        writer.write(&batch).map_err(EncodeError::of)?;
        Ok(true)
    }
}

impl std::fmt::Debug for Arrow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Arrow")
            .field("rows", &self.rows)
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}

impl Blocks for Arrow {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        let mut writer = self.writer.take()?;
        let more = match self.write(&mut writer) {
            Ok(more) => more,
            Err(error) => return Some(Err(error)),
        };
        let written = std::mem::take(writer.get_mut());
        self.writer = more.then_some(writer);
        Some(Ok(written.into()))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use arrow_array::{Array as _, cast::AsArray as _, types::Float64Type, types::Int32Type};
    use arrow_ipc::reader::StreamReader;

    use crate::service::encode::{Encoding, Output, sample_rows::answer};

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
}
