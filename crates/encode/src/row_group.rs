//! The rows of one row group of Parquet, column by column, until they are written.

use std::{io::Write, mem};

use bytes::Bytes;
use parquet::{
    data_type::{ByteArray, ByteArrayType, DoubleType},
    errors::ParquetError,
    file::writer::{SerializedColumnWriter, SerializedRowGroupWriter},
};
use strew_core::Point;

use super::{
    EncodeError,
    place::Height,
    rows::Batch,
    schema::{Kind, Schema, Values},
};

/// Byte arrays that are handed over at once.
const SOME: usize = 1 << 12;

/// The rows gathered for a row group.
#[derive(Debug)]
pub(super) struct RowGroup {
    ids: Texts,
    x: Vec<f64>,
    y: Vec<f64>,
    columns: Vec<Column>,
    geometry: Texts,
}

/// The values of a column besides id, x and y.
#[derive(Debug)]
struct Column {
    present: Present,
    /// For each row whether it has a value, where some may lack it: Parquet's definition levels.
    levels: Option<Vec<i16>>,
}

/// The values of the rows that have one.
#[derive(Debug)]
enum Present {
    Numbers(Vec<f64>),
    Names {
        names: Vec<ByteArray>,
        indices: Vec<u32>,
    },
}

impl RowGroup {
    pub(super) fn new(schema: &Schema) -> Self {
        let columns = schema.columns().iter().map(|column| Column {
            present: match &column.kind {
                Kind::Number => Present::Numbers(vec![]),
                Kind::Dictionary(names) => Present::Names {
                    names: names.iter().map(|name| name.as_str().into()).collect(),
                    indices: vec![],
                },
            },
            levels: column.optional.then(Vec::new),
        });
        Self {
            columns: columns.collect(),
            ids: Texts::default(),
            x: vec![],
            y: vec![],
            geometry: Texts::default(),
        }
    }

    /// Takes further rows.
    pub(super) fn push(&mut self, batch: Batch<'_>) -> Result<(), EncodeError> {
        let points = batch.points;
        for (i, point) in points.iter().enumerate() {
            let height = batch.heights.get(i);
            // Writing to memory cannot fail.
            let _ = write!(self.ids.bytes, "{}:{}", point.id.x, point.id.y);
            if let Some(height) = height {
                let _ = write!(self.ids.bytes, ":{}", height.address);
            }
            self.ids.end();
            write_wkb(point, height, &mut self.geometry.bytes);
            self.geometry.end();
        }
        self.x.extend(points.iter().map(|point| point.x));
        self.y.extend(points.iter().map(|point| point.y));
        for (column, values) in self.columns.iter_mut().zip(batch.columns) {
            column.push(values, points.len())?;
        }
        Ok(())
    }

    /// Writes all rows, and forgets them.
    pub(super) fn write(
        &mut self,
        group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    ) -> Result<(), ParquetError> {
        self.ids.write(next(group)?)?;
        for numbers in [&mut self.x, &mut self.y] {
            write_numbers(next(group)?, numbers, None)?;
            numbers.clear();
        }
        for column in &mut self.columns {
            column.write(next(group)?)?;
        }
        self.geometry.write(next(group)?)
    }
}

impl Column {
    fn push(&mut self, values: &Values, rows: usize) -> Result<(), EncodeError> {
        let level = match (values, &mut self.present) {
            (Values::Numbers(values), Present::Numbers(numbers)) => {
                numbers.extend_from_slice(values);
                1
            }
            (Values::Indices(values), Present::Names { names, indices })
                if values.iter().all(|index| (*index as usize) < names.len()) =>
            {
                indices.extend_from_slice(values);
                1
            }
            (Values::Missing, _) if self.levels.is_some() => 0,
            _ => return Err(EncodeError("values do not fit their column".into())),
        };
        if let Some(levels) = &mut self.levels {
            levels.resize(levels.len() + rows, level);
        }
        Ok(())
    }

    fn write(&mut self, mut writer: SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        let levels = self.levels.as_deref();
        match &mut self.present {
            Present::Numbers(numbers) => {
                write_numbers(writer, numbers, levels)?;
                numbers.clear();
            }
            Present::Names { names, indices } => {
                let named = indices.iter().map(|index| names[*index as usize].clone());
                let named: Vec<ByteArray> = named.collect();
                let typed = writer.typed::<ByteArrayType>();
                typed.write_batch(&named, levels, None)?;
                writer.close()?;
                indices.clear();
            }
        }
        if let Some(levels) = &mut self.levels {
            levels.clear();
        }
        Ok(())
    }
}

/// Byte arrays, one after another.
#[derive(Debug, Default)]
struct Texts {
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

impl Texts {
    /// Ends an array: the bytes since the last end.
    fn end(&mut self) {
        self.ends.push(self.bytes.len());
    }

    fn write(&mut self, mut writer: SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        let bytes = Bytes::from(mem::take(&mut self.bytes));
        let mut start = 0;
        for ends in self.ends.chunks(SOME) {
            let slices = ends.iter().map(|&end| {
                let slice = bytes.slice(start..end);
                start = end;
                ByteArray::from(slice)
            });
            let slices: Vec<ByteArray> = slices.collect();
            let typed = writer.typed::<ByteArrayType>();
            typed.write_batch(&slices, None, None)?;
        }
        self.ends.clear();
        writer.close()
    }
}

fn write_numbers(
    mut writer: SerializedColumnWriter<'_>,
    numbers: &[f64],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let typed = writer.typed::<DoubleType>();
    typed.write_batch(numbers, levels, None)?;
    writer.close()
}

/// The writer of the column whose turn it is.
fn next<'a>(
    group: &'a mut SerializedRowGroupWriter<'_, Vec<u8>>,
) -> Result<SerializedColumnWriter<'a>, ParquetError> {
    let none = || ParquetError::General("more columns than the schema has".into());
    group.next_column()?.ok_or_else(none)
}

/// A point as WKB: byte order, type (1, or 1001 with a z), x, y and z.
fn write_wkb(point: &Point, height: Option<&Height>, out: &mut Vec<u8>) {
    let kind: u32 = if height.is_some() { 1001 } else { 1 };
    out.push(1);
    out.extend_from_slice(&kind.to_le_bytes());
    for v in [point.x, point.y]
        .into_iter()
        .chain(height.map(|height| height.z))
    {
        out.extend_from_slice(&v.to_le_bytes());
    }
}
