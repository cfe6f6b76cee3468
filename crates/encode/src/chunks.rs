//! Rows in chunks of a fixed size, for formats that hold arrays: chunks lie close together in the plane, because
//! points come in the order of the bands, so engines can leave out those that are out of sight.
//!
//! A chunk is of one layer. Its points are sorted by the *thing* that stands there: the variant, or else the layer.

use std::collections::VecDeque;

use super::{
    pose::Pose,
    rows::{Batch, Row, Rows},
    schema::{Kind, Schema},
};

/// The points of a chunk. With their arrays they take less memory than the blocks of other formats.
pub(super) const CHUNK: usize = 1 << 13;

/// The rows of an answer in chunks.
#[derive(Debug)]
pub(super) struct Chunks {
    rows: Rows,
    /// The points left in each part, from the current one on.
    left: VecDeque<u128>,
    part: usize,
}

impl Chunks {
    /// The chunks of rows of which none was taken.
    pub(super) fn new(rows: Rows) -> Self {
        Self {
            left: rows.parts().map(|part| part.plan.count()).collect(),
            part: 0,
            rows,
        }
    }

    /// Visits the batches of the next chunk. Returns the number of its part, or nothing after the last.
    pub(super) fn next(&mut self, mut visit: impl FnMut(Batch<'_>)) -> Option<usize> {
        while *self.left.front()? == 0 {
            self.left.pop_front();
            self.part += 1;
        }
        let left = self.left.front_mut()?;
        let mut room = usize::try_from(*left).unwrap_or(CHUNK).min(CHUNK);
        *left -= room as u128;
        while room > 0 {
            let batch = self.rows.next(room)?;
            room -= batch.points.len();
            visit(batch);
        }
        Some(self.part)
    }
}

/// The things that stand at points: one for each variant, else for each layer, else one.
#[derive(Clone, Debug)]
pub(super) struct Things {
    column: Option<usize>,
    /// Their names.
    pub(super) names: Vec<String>,
}

/// The name of a thing without one.
const NAMELESS: &str = "point";

impl Things {
    pub(super) fn new(schema: &Schema, pose: &Pose) -> Self {
        let column = pose.variant.or(pose.layer);
        let mut names = vec![];
        let named = column.map(|i| &schema.columns()[i]);
        if let Some(column) = named
            && let Kind::Dictionary(list) = &column.kind
        {
            names.extend(list.iter().cloned());
        }
        if named.is_none_or(|column| column.optional) {
            names.push(NAMELESS.into());
        }
        Self { column, names }
    }

    /// The number of the thing at a point.
    pub(super) fn of(&self, row: Row<'_>) -> usize {
        let values = self.column.and_then(|column| row.columns.get(column));
        let index = values.and_then(|values| values.index(row.index));
        let last = self.names.len() - 1;
        index.map_or(last, |index| (index as usize).min(last))
    }

    /// Whether all points have the same.
    pub(super) const fn is_one(&self) -> bool {
        self.names.len() == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coordinates, sample_rows::parts};

    #[test]
    fn chunks_hold_every_row_once() {
        let counts: Vec<u128> = parts().iter().map(|part| part.plan.count()).collect();
        let mut rows = Rows::new(parts(), Coordinates::World);
        let mut chunks = Chunks::new(rows.again());
        let schema = rows.schema().clone();
        let things = Things::new(&schema, &Pose::new(&schema));
        assert_eq!(things.names, ["oak", "birch", "grey, \"old\"", "flint"]);
        let mut seen = vec![0; counts.len()];
        loop {
            let mut ids = vec![];
            let part = chunks.next(|batch| ids.extend(batch.points.iter().map(|p| p.id)));
            let Some(part) = part else { break };
            assert!((1..=CHUNK).contains(&ids.len()));
            seen[part] += ids.len() as u128;
            let mut expected = vec![];
            while expected.len() < ids.len() {
                let batch = rows.next(ids.len() - expected.len()).expect("as many");
                expected.extend(batch.points.iter().map(|p| p.id));
            }
            assert_eq!(ids, expected);
        }
        assert_eq!(seen, counts);
        assert!(rows.next(1).is_none());
    }
}
