//! Rows as Arrow record batches: `id` as text, `x` and `y`, then the columns.
//!
//! Ids are `utf8` and not integers, because `x:y`, or `x:y:z` in space, is what an id is everywhere else: what a
//! table of one format holds joins with what another holds. Dictionaries are dictionary-encoded
//! `utf8` with `int32` keys, which readers know best; their names are sent once. What a layer lacks
//! is null.

use std::{fmt::Write as _, sync::Arc};

use arrow_array::{
    ArrayRef, DictionaryArray, Float64Array, Int32Array, RecordBatch, StringArray,
    builder::StringBuilder, new_null_array, types::Int32Type,
};
use arrow_schema::{DataType, Field, Metadata};
use strew_core::Point;

use super::{
    EncodeError,
    head::Head,
    rows::Batch,
    schema::{Kind, Schema, Values},
};

/// Makes record batches of the rows of one schema.
#[derive(Debug)]
pub(super) struct Batches {
    schema: Arc<arrow_schema::Schema>,
    /// The names of each column, if it has any.
    names: Vec<Option<ArrayRef>>,
}

/// The approximate bytes of an id.
const ID_BYTES: usize = 16;

impl Batches {
    /// For rows of a schema; the head becomes metadata. A `geometry` is the name of a last column of
    /// binary values, which the schema then describes and [`Batches::make`] does not fill.
    pub(super) fn new(schema: &Schema, head: &Head, geometry: Option<&str>) -> Self {
        let mut fields = vec![
            Field::new("id", DataType::Utf8, false),
            Field::new("x", DataType::Float64, false),
            Field::new("y", DataType::Float64, false),
        ];
        let mut arrays: Vec<Option<ArrayRef>> = vec![];
        for column in schema.columns() {
            let (data_type, array) = match &column.kind {
                Kind::Number => (DataType::Float64, None),
                Kind::Dictionary(names) => {
                    let array: ArrayRef = Arc::new(StringArray::from_iter_values(names.iter()));
                    let (key, value) = (DataType::Int32, DataType::Utf8);
                    (DataType::Dictionary(key.into(), value.into()), Some(array))
                }
            };
            fields.push(Field::new(&column.name, data_type, column.optional));
            arrays.push(array);
        }
        fields.extend(geometry.map(|name| Field::new(name, DataType::Binary, false)));
        Self {
            schema: Arc::new(arrow_schema::Schema::new_with_metadata(
                fields,
                metadata(head),
            )),
            names: arrays,
        }
    }

    pub(super) const fn schema(&self) -> &Arc<arrow_schema::Schema> {
        &self.schema
    }

    /// The bytes of a row, roughly.
    pub(super) fn row_bytes(&self) -> usize {
        ID_BYTES + 4 + 8 * (2 + self.names.len())
    }

    /// A record batch without rows.
    pub(super) fn none(&self) -> Result<RecordBatch, EncodeError> {
        self.make(Batch {
            points: &[],
            near: &[],
            heights: &[],
            columns: &vec![Values::Missing; self.names.len()],
        })
    }

    /// Some rows as a record batch.
    pub(super) fn make(&self, batch: Batch<'_>) -> Result<RecordBatch, EncodeError> {
        let points = batch.points;
        let mut ids = StringBuilder::with_capacity(points.len(), points.len() * ID_BYTES);
        let (mut x, mut y) = (itoa::Buffer::new(), itoa::Buffer::new());
        for (i, point) in points.iter().enumerate() {
            // Writing to memory cannot fail.
            for part in [x.format(point.id.x), ":", y.format(point.id.y)] {
                let _ = ids.write_str(part);
            }
            if let Some(height) = batch.heights.get(i) {
                let _ = write!(ids, ":{}", height.address);
            }
            ids.append_value("");
        }
        let numbers = |of: fn(&Point) -> f64| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(points.iter().map(of)))
        };
        let mut columns: Vec<ArrayRef> = vec![
            Arc::new(ids.finish()),
            numbers(|point| point.x),
            numbers(|point| point.y),
        ];
        let fields = self.schema.fields().iter().skip(columns.len());
        for ((field, names), values) in fields.zip(&self.names).zip(batch.columns) {
            columns.push(match (values, names) {
                (Values::Numbers(values), None) => Arc::new(Float64Array::from(values.clone())),
                (Values::Indices(values), Some(names)) => {
                    let keys = values
                        .iter()
                        .map(|index| i32::try_from(*index).unwrap_or(i32::MAX));
                    let keys = Int32Array::from_iter_values(keys);
                    let array = DictionaryArray::<Int32Type>::try_new(keys, names.clone());
                    Arc::new(array.map_err(EncodeError::of)?)
                }
                (_, None) => new_null_array(field.data_type(), points.len()),
                (_, Some(names)) => {
                    let array =
                        DictionaryArray::new(Int32Array::new_null(points.len()), names.clone());
                    Arc::new(array)
                }
            });
        }
        RecordBatch::try_new(self.schema.clone(), columns).map_err(EncodeError::of)
    }
}

/// The head of an answer, by name: query and table as JSON, and the count.
fn metadata(head: &Head) -> Metadata {
    Metadata::from(head.entries())
}
