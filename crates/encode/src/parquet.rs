//! Parquet: row groups of a fixed number of rows, compressed by zstd.
//!
//! The file is GeoParquet 1.1: a column `geometry` of points in WKB beside x and y. WKB is what all
//! readers know. A row group is held until it is complete, so this takes more memory than the other
//! formats do, though not more for more rows. Coordinates and ids are all different: no dictionaries for
//! them. Floats are split into streams of their bytes, since the upper ones of neighbors are alike.
//!
//! Rows come in bands, so a row group is a compact part of the region. Its least and greatest x and y let readers
//! skip it. The metadata of the file has the box around all points.
//!
//! Columns go to the crate's own writer one by one. Its writer of Arrow batches would do the same and
//! takes two minutes longer to compile.

use std::sync::Arc;

use arrow_ipc::writer::{DictionaryTracker, IpcDataGenerator, IpcWriteOptions};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use parquet::{
    basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical, ZstdLevel},
    errors::ParquetError,
    file::{
        metadata::KeyValue,
        properties::{EnabledStatistics, WriterProperties, WriterVersion},
        writer::SerializedFileWriter,
    },
    schema::types::{ColumnPath, Type},
};
use serde_json::{Value, json};

use super::{
    EncodeError,
    batches::Batches,
    columnar::Writer,
    head::Head,
    row_group::RowGroup,
    rows::{Batch, Rows},
    schema::{Kind, Schema},
};

/// The columns id, x, y and geometry.
const COORDINATES: usize = 4;

/// Rows of a row group: about 5 MB before they are compressed.
pub(super) const GROUP_ROWS: usize = 1 << 16;

/// Rows that are taken at once.
const BATCH_ROWS: usize = 1 << 13;

/// The column of points as WKB.
const GEOMETRY: &str = "geometry";

/// A writer of a file: row groups, then the footer.
pub(super) struct Parquet {
    group: RowGroup,
    writer: SerializedFileWriter<Vec<u8>>,
    columns: usize,
    geo: Geo,
}

impl Parquet {
    /// The rows, compressed at a level of zstd, or plain at level 0. The reference system is PROJJSON.
    pub(super) fn new(
        schema: &Schema,
        head: &Head,
        crs: Option<Value>,
        level: u8,
    ) -> Result<Self, EncodeError> {
        let compression = match level {
            0 => Compression::UNCOMPRESSED,
            _ => Compression::ZSTD(ZstdLevel::try_new(level.into()).map_err(EncodeError::of)?),
        };
        let arrow = KeyValue::new("ARROW:schema".into(), arrow_schema(schema, head));
        let geometry = ColumnPath::from(GEOMETRY);
        let mut properties = WriterProperties::builder()
            .set_writer_version(WriterVersion::PARQUET_1_0)
            .set_compression(compression)
            .set_key_value_metadata(Some(vec![arrow]))
            .set_created_by(concat!("strew ", env!("CARGO_PKG_VERSION")).into())
            .set_column_dictionary_enabled(ColumnPath::from("id"), false)
            .set_column_dictionary_enabled(geometry.clone(), false)
            // The order of its bytes means nothing.
            .set_column_statistics_enabled(geometry, EnabledStatistics::None);
        let numbers = (schema.columns().iter()).filter(|column| column.kind == Kind::Number);
        let names = numbers.map(|column| column.name.as_str());
        for name in ["x", "y"].into_iter().chain(names) {
            let path = ColumnPath::from(name);
            properties = properties
                .set_column_dictionary_enabled(path.clone(), false)
                .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
        }
        let message = message(schema).map_err(EncodeError::of)?;
        let properties = properties.build().into();
        let writer = SerializedFileWriter::new(vec![], message.into(), properties);
        let mut writer = writer.map_err(EncodeError::of)?;
        // The mark of the format.
        writer.flush().map_err(EncodeError::of)?;
        Ok(Self {
            group: RowGroup::new(schema),
            geo: Geo::new(crs, schema.is_in_space()),
            writer,
            columns: COORDINATES + schema.columns().len(),
        })
    }
}

impl Writer for Parquet {
    /// Writes a row group, whose bytes depend on its rows alone.
    fn write(&mut self, rows: &mut Rows) -> Result<Option<usize>, EncodeError> {
        let mut count = 0;
        while count < GROUP_ROWS
            && let Some(batch) = rows.next((GROUP_ROWS - count).min(BATCH_ROWS))
        {
            self.geo.reach(&batch);
            count += batch.points.len();
            self.group.push(batch)?;
        }
        if count > 0 {
            let mut columns = self.writer.next_row_group().map_err(EncodeError::of)?;
            self.group.write(&mut columns).map_err(EncodeError::of)?;
            columns.close().map_err(EncodeError::of)?;
            return Ok(Some(count));
        }
        let geo = KeyValue::new("geo".into(), self.geo.text());
        self.writer.append_key_value_metadata(geo);
        self.writer.finish().map_err(EncodeError::of)?;
        know_order(self.writer.inner_mut(), self.columns);
        Ok(None)
    }

    fn written(&mut self) -> &mut Vec<u8> {
        self.writer.inner_mut()
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

/// The metadata of GeoParquet.
#[derive(Debug)]
struct Geo {
    geometry: Value,
    /// The least and the greatest x, y and z so far.
    bounds: [[f64; 2]; 3],
    axes: usize,
}

impl Geo {
    /// `null` is the way of GeoParquet to say that the plane is unknown; without the member readers would assume
    /// longitude and latitude.
    fn new(crs: Option<Value>, is_in_space: bool) -> Self {
        let geometry = json!({
            "encoding": "WKB",
            "geometry_types": [if is_in_space { "Point Z" } else { "Point" }],
            "crs": crs,
        });
        Self {
            geometry,
            bounds: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
            axes: if is_in_space { 3 } else { 2 },
        }
    }

    /// Takes rows into the box around all points.
    fn reach(&mut self, batch: &Batch<'_>) {
        let take = |[low, high]: &mut [f64; 2], v: f64| (*low, *high) = (low.min(v), high.max(v));
        let [x, y, z] = &mut self.bounds;
        for point in batch.points {
            take(x, point.x);
            take(y, point.y);
        }
        for height in batch.heights {
            take(z, height.z);
        }
    }

    fn text(&self) -> String {
        let mut geometry = self.geometry.clone();
        let axes = &self.bounds[..self.axes];
        if axes.iter().all(|[low, high]| low <= high) {
            let ends = [0, 1]
                .iter()
                .flat_map(|&end| axes.iter().map(move |axis| axis[end]));
            geometry["bbox"] = ends.collect();
        }
        json!({
            "version": "1.1.0",
            "primary_column": GEOMETRY,
            "columns": { GEOMETRY: geometry },
        })
        .to_string()
    }
}

// The footer states the order of numbers as all readers know it. The crate that writes the files states the order of
// IEEE 754, of 2025, for floats. Readers that do not know it pass over the least and greatest numbers of row groups:
// pyarrow 26 then reads every group. Finite numbers have the same least and greatest in the order that all readers
// know, so the footer names that one.

/// How the list of orders ends the metadata, in Thrift's compact protocol: a union of one member, an empty struct.
const KNOWN: [u8; 3] = [0x1c, 0, 0];
const NEW: [u8; 3] = [0x2c, 0, 0];

/// The bytes after the metadata: its length, and the mark of the format.
const END: usize = 8;

/// Puts the known order in the place of the new one, for each column of a footer. Leaves a footer alone that does not
/// end with the list of orders.
fn know_order(footer: &mut [u8], columns: usize) {
    // The struct's end comes last.
    let end = footer.len().saturating_sub(END + 1);
    let Some(start) = end.checked_sub(NEW.len() * columns) else {
        return;
    };
    let (orders, _) = footer[start..end].as_chunks_mut::<3>();
    if orders.iter().all(|order| [KNOWN, NEW].contains(order)) {
        orders.fill(KNOWN);
    }
}

#[cfg(test)]
mod tests {
    use parquet::{
        basic::{ColumnOrder, Compression, Encoding as Split},
        file::{
            reader::{FileReader as _, SerializedFileReader},
            statistics::Statistics,
        },
        record::Field,
    };
    use serde_json::Value;

    use crate::{Encoding, Output, sample_rows::answer};

    /// Readers pass over row groups that are elsewhere, and know where the file is without reading any.
    #[test]
    fn row_groups_have_bounds_that_all_readers_know() {
        let (file, _) = answer(&Output::new(Encoding::Parquet), 4096);
        let reader = SerializedFileReader::new(bytes::Bytes::from(file)).expect("a file");
        let metadata = reader.metadata();
        let file = metadata.file_metadata();
        let orders = file.column_orders().expect("orders");
        assert!(
            orders
                .iter()
                .all(|order| matches!(order, ColumnOrder::TYPE_DEFINED_ORDER(_))),
            "{orders:?}"
        );
        let entries = file.key_value_metadata().expect("entries");
        let geo = entries
            .iter()
            .find(|entry| entry.key == "geo")
            .expect("geo");
        let geo: Value = serde_json::from_str(geo.value.as_ref().expect("a text")).expect("JSON");
        let bbox: Vec<f64> = serde_json::from_value(geo["columns"]["geometry"]["bbox"].clone())
            .expect("four numbers");
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for group in metadata.row_groups() {
            for (axis, bounds) in bounds.iter_mut().enumerate() {
                let column = group.column(1 + axis);
                assert!(matches!(column.compression(), Compression::ZSTD(_)));
                assert!(
                    column
                        .encodings()
                        .any(|encoding| encoding == Split::BYTE_STREAM_SPLIT)
                );
                let Some(Statistics::Double(known)) = column.statistics() else {
                    panic!("no statistics");
                };
                bounds[0] = bounds[0].min(*known.min_opt().expect("a least"));
                bounds[1] = bounds[1].max(*known.max_opt().expect("a greatest"));
            }
        }
        assert_eq!(
            bbox,
            [bounds[0][0], bounds[1][0], bounds[0][1], bounds[1][1]]
        );
    }

    #[test]
    fn a_level_of_zero_is_plain_and_the_same_rows_are_the_same_bytes() {
        let of = |zstd| {
            let output = Output {
                zstd,
                ..Output::new(Encoding::Parquet)
            };
            answer(&output, 4096).0
        };
        let (plain, first, best) = (of(0), of(1), of(19));
        assert_eq!(first, of(1));
        assert!(first.len() < plain.len() && best.len() < plain.len());
    }

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
