//! Parquet, for files: row groups of a fixed number of rows, nothing compressed.
//!
//! The file is GeoParquet 1.1: a column `geometry` of points in WKB beside x and y. WKB is what all
//! readers know. A row group is held until it is complete, so this takes more memory than the other
//! formats do, though not more for more rows. Coordinates and ids are all different: no dictionaries for
//! them.
//!
//! Columns go to the crate's own writer one by one. Its writer of Arrow batches would do the same and
//! takes two minutes longer to compile.

use std::{fmt, sync::Arc};

use arrow_ipc::writer::{DictionaryTracker, IpcDataGenerator, IpcWriteOptions};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use bytes::Bytes;
use parquet::{
    basic::{Compression, LogicalType, Repetition, Type as Physical},
    errors::ParquetError,
    file::{
        metadata::KeyValue,
        properties::{WriterProperties, WriterVersion},
        writer::SerializedFileWriter,
    },
    schema::types::{ColumnPath, Type},
};
use serde_json::json;

use super::{
    EncodeError,
    batches::Batches,
    blocks::Blocks,
    crs::Crs,
    head::Head,
    row_group::RowGroup,
    rows::Rows,
    schema::{Kind, Schema},
};

/// Rows of a row group: about 5 MB.
const GROUP_ROWS: usize = 1 << 16;

/// Rows that are taken at once.
const BATCH_ROWS: usize = 1 << 13;

/// The column of points as WKB.
const GEOMETRY: &str = "geometry";

/// The blocks of a file: a row group each, then the footer.
pub(super) struct Parquet {
    rows: Rows,
    group: RowGroup,
    /// `None` once the end is written.
    writer: Option<SerializedFileWriter<Vec<u8>>>,
    points: u64,
}

impl Parquet {
    pub(super) fn new(rows: Rows, head: &Head, crs: Option<&Crs>) -> Result<Self, EncodeError> {
        let schema = rows.schema();
        let metadata = [
            ("geo", geo(crs, schema.is_in_space())),
            ("ARROW:schema", arrow_schema(schema, head)),
        ];
        let metadata = metadata.map(|(key, value)| KeyValue::new(key.into(), value));
        let mut properties = WriterProperties::builder()
            .set_writer_version(WriterVersion::PARQUET_1_0)
            .set_compression(Compression::UNCOMPRESSED)
            .set_key_value_metadata(Some(metadata.into()))
            .set_created_by(concat!("strew ", env!("CARGO_PKG_VERSION")).into());
        for column in ["id", "x", "y", GEOMETRY] {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(column), false);
        }
        let message = message(schema).map_err(EncodeError::of)?;
        let writer = SerializedFileWriter::new(vec![], message.into(), properties.build().into());
        Ok(Self {
            group: RowGroup::new(schema),
            writer: Some(writer.map_err(EncodeError::of)?),
            rows,
            points: 0,
        })
    }

    /// Writes a row group or the end. Returns whether there is more.
    fn write(&mut self, writer: &mut SerializedFileWriter<Vec<u8>>) -> Result<bool, EncodeError> {
        let mut room = GROUP_ROWS;
        while room > 0
            && let Some(batch) = self.rows.next(room.min(BATCH_ROWS))
        {
            self.points += batch.points.len() as u64;
            self.group.push(batch)?;
            room -= batch.points.len();
        }
        if room < GROUP_ROWS {
            let mut columns = writer.next_row_group().map_err(EncodeError::of)?;
            self.group.write(&mut columns).map_err(EncodeError::of)?;
            columns.close().map_err(EncodeError::of)?;
        }
        if room > 0 {
            writer.finish().map_err(EncodeError::of)?;
        }
        Ok(room == 0)
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

impl fmt::Debug for Parquet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Parquet")
            .field("rows", &self.rows)
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}

/// The columns as Parquet describes them, in the order of [`RowGroup`].
fn message(schema: &Schema) -> Result<Type, ParquetError> {
    let leaf = |name: &str, physical, logical, optional| {
        let repetition = match optional {
            true => Repetition::OPTIONAL,
            false => Repetition::REQUIRED,
        };
        let leaf = Type::primitive_type_builder(name, physical)
            .with_logical_type(logical)
            .with_repetition(repetition);
        leaf.build().map(Arc::new)
    };
    let text = Some(LogicalType::String);
    let mut fields = vec![
        leaf("id", Physical::BYTE_ARRAY, text.clone(), false)?,
        leaf("x", Physical::DOUBLE, None, false)?,
        leaf("y", Physical::DOUBLE, None, false)?,
    ];
    for column in schema.columns() {
        let (physical, logical) = match column.kind {
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Dictionary(_) => (Physical::BYTE_ARRAY, text.clone()),
        };
        fields.push(leaf(&column.name, physical, logical, column.optional)?);
    }
    fields.push(leaf(GEOMETRY, Physical::BYTE_ARRAY, None, false)?);
    let message = Type::group_type_builder("strew").with_fields(fields);
    message.build()
}

/// The schema of the columns in Arrow's terms, with the head of the answer: an IPC message as base64, where readers of
/// Arrow look for it.
fn arrow_schema(schema: &Schema, head: &Head) -> String {
    let batches = Batches::new(schema, head, Some(GEOMETRY));
    let message = IpcDataGenerator::default().schema_to_bytes_with_dictionary_tracker(
        batches.schema(),
        &mut DictionaryTracker::new(true),
        &IpcWriteOptions::default(),
    );
    let message = message.ipc_message;
    let length = u32::try_from(message.len()).unwrap_or(u32::MAX);
    let framed = [&[0xff; 4], &length.to_le_bytes(), &*message].concat();
    BASE64_STANDARD.encode(framed)
}

/// The metadata of GeoParquet. `null` is its way to say that the plane is unknown; without the member
/// readers would assume longitude and latitude.
fn geo(crs: Option<&Crs>, is_in_space: bool) -> String {
    let geometry = json!({
        "encoding": "WKB",
        "geometry_types": [if is_in_space { "Point Z" } else { "Point" }],
        "crs": crs.and_then(Crs::projjson),
    });
    json!({
        "version": "1.1.0",
        "primary_column": GEOMETRY,
        "columns": { GEOMETRY: geometry },
    })
    .to_string()
}

#[cfg(test)]
mod tests {
    use parquet::{
        file::reader::{FileReader as _, SerializedFileReader},
        record::Field,
    };

    use crate::{Encoding, Output, sample_rows::answer};

    /// Every value of every row is the one that csv has.
    #[test]
    fn the_file_has_the_rows_of_csv() {
        let (csv, _) = answer(&Output::new(Encoding::Csv), 4096);
        let csv = String::from_utf8(csv).expect("UTF-8");
        let (file, size) = answer(&Output::new(Encoding::Parquet), 4096);
        assert_eq!(size, None);
        let reader = SerializedFileReader::new(bytes::Bytes::from(file)).expect("a file");
        let mut lines = csv.lines();
        let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
        for row in reader.get_row_iter(None).expect("rows") {
            let row = row.expect("whole");
            let row: std::collections::HashMap<_, _> = row
                .get_column_iter()
                .map(|(name, value)| (name.as_str(), value))
                .collect();
            let line = lines.next().expect("as many");
            let (fields, variant) = line.split_at(
                line.match_indices(',')
                    .nth(head.len() - 2)
                    .expect("fields")
                    .0,
            );
            for (name, text) in head.iter().zip(fields.split(',')) {
                match row[name] {
                    Field::Str(value) => assert_eq!(value, text, "{name}"),
                    Field::Double(value) => assert_eq!(text.parse(), Ok(*value), "{name}"),
                    Field::Null => assert_eq!(text, "", "{name}"),
                    other => panic!("{name} is {other:?}"),
                }
            }
            let quoted = &variant[1..];
            let quoted = quoted
                .strip_prefix('"')
                .and_then(|text| text.strip_suffix('"'))
                .unwrap_or(quoted);
            let value = quoted.replace("\"\"", "\"");
            assert_eq!(row["variant"], &Field::Str(value));
            let (Field::Bytes(wkb), Field::Double(x), Field::Double(y)) =
                (row["geometry"], row["x"], row["y"])
            else {
                panic!("{row:?}");
            };
            let expected = [&[1, 1, 0, 0, 0], &x.to_le_bytes()[..], &y.to_le_bytes()].concat();
            assert_eq!(wkb.data(), expected);
        }
        assert_eq!(lines.next(), None);
    }
}
