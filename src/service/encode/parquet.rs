//! Parquet, for files: row groups of a fixed number of rows, nothing compressed.
//!
//! A row group is held until it is complete, so this takes more memory than the other formats do,
//! though not more for more rows. Coordinates and ids are all different: no dictionaries for them.

use bytes::Bytes;
use parquet::{
    arrow::{ArrowWriter, arrow_writer::ArrowWriterOptions},
    basic::Compression,
    file::properties::{WriterProperties, WriterVersion},
    schema::types::ColumnPath,
};

use super::{Blocks, EncodeError, batches::Batches, head::Head, rows::Rows};

/// Rows of a row group: about 8 MB with ids.
const GROUP_ROWS: usize = 1 << 18;
/// Rows that are encoded at once.
const BATCH_ROWS: usize = 1 << 13;

/// The blocks of a Parquet file.
pub(super) struct Parquet {
    rows: Rows,
    batches: Batches,
    /// Gone when all is said.
    writer: Option<ArrowWriter<Vec<u8>>>,
    block_bytes: usize,
    points: u64,
}

impl Parquet {
    pub(super) fn new(rows: Rows, head: &Head, block_bytes: usize) -> Result<Self, EncodeError> {
        let batches = Batches::new(rows.schema(), head);
        let mut properties = WriterProperties::builder()
            .set_writer_version(WriterVersion::PARQUET_1_0)
            .set_compression(Compression::UNCOMPRESSED)
            .set_max_row_group_row_count(Some(GROUP_ROWS))
            .set_created_by(concat!("strew ", env!("CARGO_PKG_VERSION")).into());
        for column in ["id", "x", "y"] {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(column), false);
        }
        let options = ArrowWriterOptions::new().with_properties(properties.build());
        let writer = ArrowWriter::try_new_with_options(vec![], batches.schema().clone(), options);
        Ok(Self {
            rows,
            batches,
            writer: Some(writer.map_err(EncodeError::of)?),
            block_bytes,
            points: 0,
        })
    }

    /// Writes rows until there is a block, or the end; gives whether there is more.
    fn write(&mut self, writer: &mut ArrowWriter<Vec<u8>>) -> Result<bool, EncodeError> {
        while writer.inner().len() < self.block_bytes {
            let Some(batch) = self.rows.next(BATCH_ROWS) else {
                writer.finish().map_err(EncodeError::of)?;
                return Ok(false);
            };
            self.points += batch.points.len() as u64;
            let batch = self.batches.make(batch)?;
            writer.write(&batch).map_err(EncodeError::of)?;
        }
        Ok(true)
    }
}

impl std::fmt::Debug for Parquet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Parquet")
            .field("rows", &self.rows)
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}

impl Blocks for Parquet {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        let mut writer = self.writer.take()?;
        let more = match self.write(&mut writer) {
            Ok(more) => more,
            Err(error) => return Some(Err(error)),
        };
        let written = std::mem::take(writer.inner_mut());
        self.writer = more.then_some(writer);
        Some(Ok(written.into()))
    }
}
