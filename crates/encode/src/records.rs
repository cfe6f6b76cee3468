//! Rows as records of fixed size: coordinates and columns as little-endian numbers.

use bytes::Bytes;

use super::{
    EncodeError,
    blocks::Blocks,
    pose::Pose,
    posed,
    rows::{Batch, Rows},
    schema::{Column, Kind, Schema, Z},
};

/// How a record's fields are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// x, y and the columns as `f32`.
    F32,
    /// x, y and the columns as `f64`.
    F64,
    /// x, y, z (0 without a column of it) and the other columns as `f64`, but names as `i32` indices.
    Vertex,
    /// The records of a `MultiMesh`.
    Multimesh,
    /// Records of 16 bytes.
    Instance,
}

impl Layout {
    /// The bytes of a record.
    pub(super) fn record_bytes(self, schema: &Schema) -> usize {
        let columns = schema.columns();
        match self {
            Self::F32 => 4 * (2 + columns.len()),
            Self::F64 => 8 * (2 + columns.len()),
            Self::Vertex => {
                let bytes = |column: &Column| match column.kind {
                    Kind::Number if column.name == Z => 0,
                    Kind::Number => 8,
                    Kind::Dictionary(_) => 4,
                };
                24 + columns.iter().map(bytes).sum::<usize>()
            }
            Self::Multimesh => posed::MULTIMESH_BYTES,
            Self::Instance => posed::INSTANCE_BYTES,
        }
    }

    /// Whether a record without columns is just a pair of `f32`, or of `f64`; else nothing.
    pub(super) const fn plain_f32(self) -> Option<bool> {
        match self {
            Self::F32 => Some(true),
            Self::F64 => Some(false),
            Self::Vertex | Self::Multimesh | Self::Instance => None,
        }
    }

    /// Appends the records of some rows; a number that a row lacks is NaN, an index −1.
    fn write(self, schema: &Schema, pose: &Pose, batch: Batch<'_>, out: &mut Vec<u8>) {
        let ranges = pose.ranges(schema);
        for row in batch.rows() {
            let columns = row.columns.iter();
            let numbers = columns.map(|values| values.number(row.index).unwrap_or(f64::NAN));
            match self {
                Self::F32 => {
                    for v in batch.near[row.index] {
                        out.extend_from_slice(&v.to_le_bytes());
                    }
                    numbers.for_each(|v| out.extend_from_slice(&(v as f32).to_le_bytes()));
                }
                Self::F64 => {
                    for v in [row.point.x, row.point.y].into_iter().chain(numbers) {
                        out.extend_from_slice(&v.to_le_bytes());
                    }
                }
                Self::Vertex => {
                    for v in [row.point.x, row.point.y, pose.z(row)] {
                        out.extend_from_slice(&v.to_le_bytes());
                    }
                    for (column, values) in schema.columns().iter().zip(row.columns) {
                        match column.kind {
                            Kind::Number if column.name == Z => {}
                            Kind::Number => {
                                let number = values.number(row.index).unwrap_or(f64::NAN);
                                out.extend_from_slice(&number.to_le_bytes());
                            }
                            Kind::Dictionary(_) => {
                                let index = values.index(row.index).map(i32::try_from);
                                let index = index.and_then(Result::ok).unwrap_or(-1);
                                out.extend_from_slice(&index.to_le_bytes());
                            }
                        }
                    }
                }
                Self::Multimesh => {
                    for v in posed::multimesh(pose, row, batch.near[row.index]) {
                        out.extend_from_slice(&v.to_le_bytes());
                    }
                }
                Self::Instance => {
                    let near = batch.near[row.index];
                    out.extend_from_slice(&posed::instance(pose, &ranges, row, near));
                }
            }
        }
    }
}

/// The blocks of an answer of records.
#[derive(Debug)]
pub(super) struct Records {
    rows: Rows,
    layout: Layout,
    pose: Pose,
    block_bytes: usize,
    points: u64,
}

impl Records {
    pub(super) fn new(rows: Rows, layout: Layout, block_bytes: usize) -> Self {
        Self {
            pose: Pose::new(rows.schema()),
            rows,
            layout,
            block_bytes,
            points: 0,
        }
    }
}

impl Blocks for Records {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        let schema = self.rows.schema().clone();
        let bytes = self.layout.record_bytes(&schema);
        let batch = self.rows.next(self.block_bytes / bytes)?;
        let mut out = Vec::with_capacity(batch.points.len() * bytes);
        self.layout.write(&schema, &self.pose, batch, &mut out);
        self.points += batch.points.len() as u64;
        Some(Ok(out.into()))
    }
}

#[cfg(test)]
mod tests {
    use crate::{Encoding, Output, Place, sample_rows::answer};

    fn numbers<const N: usize>(bytes: &[u8], read: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        let chunks = bytes.chunks_exact(N);
        chunks
            .map(|bytes| read(bytes.try_into().expect("N bytes")))
            .collect()
    }

    #[test]
    fn columns_follow_the_coordinates_as_numbers() {
        let origin = [-10.0, 5.0];
        let (bytes, size) = answer(&Output::new(Encoding::F64), 1000);
        assert_eq!(size, Some(bytes.len() as u64));
        let wide = numbers(&bytes, f64::from_le_bytes);
        let (bytes, size) = answer(&Output::new(Encoding::F32), 1000);
        assert_eq!(size, Some(bytes.len() as u64));
        let near = numbers(&bytes, |bytes| f32::from_le_bytes(bytes).into());
        let relative = Output {
            relative_to: Some(Place::Plane(origin)),
            ..Output::new(Encoding::F64)
        };
        let relative = numbers(&answer(&relative, 1000).0, f64::from_le_bytes);
        assert_eq!((near.len(), relative.len()), (wide.len(), wide.len()));
        let records = wide.chunks_exact(5).zip(near.chunks_exact(5));
        for ((wide, near), relative) in records.zip(relative.chunks_exact(5)) {
            let moved = [wide[0] - origin[0], wide[1] - origin[1]];
            assert!(
                (relative[0] - moved[0]).abs() < 1e-14 && (relative[1] - moved[1]).abs() < 1e-14
            );
            assert!((near[0] - moved[0]).abs() < 4e-6 && (near[1] - moved[1]).abs() < 4e-6);
            let (layer, angle, variant) = (wide[2], wide[3], wide[4]);
            assert_eq!(angle.is_nan(), layer == 1.0);
            assert!((0.0..4.0).contains(&variant));
            assert_eq!((near[2], near[4]), (layer, variant));
            assert!(near[3] == angle || angle.is_nan() && near[3].is_nan());
        }
    }
}
