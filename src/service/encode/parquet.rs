//! Parquet, for files: row groups of a fixed number of rows, nothing compressed.
//!
//! The file is GeoParquet 1.1: a column `geometry` of points in WKB beside x and y. WKB is what all
//! readers know. A row group is held until it is complete, so this takes more memory than the other
//! formats do, though not more for more rows. Coordinates and ids are all different: no dictionaries for
//! them.

use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use parquet::{
    arrow::{ArrowWriter, arrow_writer::ArrowWriterOptions},
    basic::Compression,
    file::{
        metadata::KeyValue,
        properties::{WriterProperties, WriterVersion},
    },
    schema::types::ColumnPath,
};
use serde_json::json;

use super::{EncodeError, batches::GEOMETRY, columnar::Writer, crs::Crs};

/// Rows of a row group: about 14 MB with ids.
const GROUP_ROWS: usize = 1 << 18;

/// A writer of Parquet in memory.
pub(super) fn writer(
    schema: &SchemaRef,
    crs: Option<&Crs>,
) -> Result<impl Writer + 'static, EncodeError> {
    let mut properties = WriterProperties::builder()
        .set_writer_version(WriterVersion::PARQUET_1_0)
        .set_compression(Compression::UNCOMPRESSED)
        .set_max_row_group_row_count(Some(GROUP_ROWS))
        .set_key_value_metadata(Some(vec![KeyValue::new("geo".into(), geo(crs))]))
        .set_created_by(concat!("strew ", env!("CARGO_PKG_VERSION")).into());
    for column in ["id", "x", "y", GEOMETRY] {
        properties = properties.set_column_dictionary_enabled(ColumnPath::from(column), false);
    }
    let options = ArrowWriterOptions::new().with_properties(properties.build());
    ArrowWriter::try_new_with_options(vec![], schema.clone(), options).map_err(EncodeError::of)
}

/// The metadata of GeoParquet. `null` is its way to say that the plane is unknown; without the member
/// readers would assume longitude and latitude.
fn geo(crs: Option<&Crs>) -> String {
    let geometry = json!({
        "encoding": "WKB",
        "geometry_types": ["Point"],
        "crs": crs.and_then(Crs::projjson),
    });
    json!({
        "version": "1.1.0",
        "primary_column": GEOMETRY,
        "columns": { GEOMETRY: geometry },
    })
    .to_string()
}

impl Writer for ArrowWriter<Vec<u8>> {
    const BATCH_ROWS: Option<usize> = Some(1 << 13);

    fn write(&mut self, batch: &RecordBatch) -> Result<(), EncodeError> {
        Self::write(self, batch).map_err(EncodeError::of)
    }

    fn finish(&mut self) -> Result<(), EncodeError> {
        Self::finish(self).map(drop).map_err(EncodeError::of)
    }

    fn written(&mut self) -> &mut Vec<u8> {
        self.inner_mut()
    }
}
