//! glTF, binary: one mesh for each thing, drawn at every point by `EXT_mesh_gpu_instancing`.
//!
//! A node has the points of one chunk and thing. Its arrays lie one after another: TRANSLATION, ROTATION and SCALE
//! where points have them, `_ID` (in space `_ID_Z`, too), then further numbers. All is relative to the region's lower corner, where the
//! parent of the nodes stands, so that `f32` is exact enough; y is up, as glTF demands.
//!
//! The document stands before the arrays and says how long they are. So where there are several things, the points
//! are walked twice: first they are counted. Documents of many nodes are written in pieces.

mod arrays;
mod document;
mod placeholder;

use bytes::Bytes;
use strew_error::{Error, Fault};

use self::{
    document::{Described, Document, Node},
    placeholder::Placeholder,
};
use crate::{
    EncodeError,
    blocks::Blocks,
    chunks::{CHUNK, Chunks, Things},
    head::Head,
    ids,
    place::Place,
    pose::{Pose, y_up},
    rows::{Batch, Rows},
};
use arrays::Arrays;

/// The most points. Their arrays and the document fit into the 4 GiB that the format can state.
const MOST_POINTS: u128 = 1 << 24;

/// The blocks of a file.
#[derive(Debug)]
pub(super) struct Glb {
    head: Head,
    layers: Vec<Option<String>>,
    origin: Place,
    pose: Pose,
    things: Things,
    arrays: Arrays,
    placeholder: Placeholder,
    /// Counts the points of each node, until all are counted.
    counting: Option<Chunks>,
    nodes: Vec<Node>,
    /// The document, and the next of its pieces.
    document: Option<(Document, usize)>,
    chunks: Chunks,
    count: u64,
    points: u64,
    size: Option<u64>,
}

impl Glb {
    /// The file of rows of which none was taken.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there are too many points, or ids that it cannot hold.
    pub(super) fn new(rows: Rows, head: Head) -> Result<Self, Error> {
        ids::check("glb", &rows, 32)?;
        let count = rows.count();
        if count > MOST_POINTS {
            let detail = format!("the answer has {count} points");
            let allowed = format!("glb for at most {MOST_POINTS} points; multimesh for any number");
            return Err(Fault::new("format", "glb", detail, allowed).into());
        }
        let pose = Pose::new(rows.schema());
        let things = Things::new(rows.schema(), &pose);
        let spacing = rows.parts().next().map(|part| part.plan.spacing());
        let mut glb = Self {
            head,
            layers: rows.parts().map(|part| part.layer.clone()).collect(),
            origin: rows
                .coordinates()
                .origin()
                .unwrap_or(Place::Plane([0.0; 2])),
            arrays: Arrays::new(rows.schema(), &pose),
            placeholder: Placeholder::new(spacing.unwrap_or(1.0)),
            pose,
            counting: Some(Chunks::new(rows.again())),
            nodes: uncounted(rows.parts().map(|part| part.plan.count())),
            document: None,
            chunks: Chunks::new(rows),
            count: u64::try_from(count).unwrap_or(u64::MAX),
            points: 0,
            size: None,
            things,
        };
        if glb.things.is_one() {
            glb.counting = None;
            let document = glb.described();
            glb.size = Some(document.file_bytes());
            glb.document = Some((document, 0));
        } else {
            glb.nodes.clear();
        }
        Ok(glb)
    }

    /// The size of the file, where it is known without counting.
    pub(super) const fn size(&self) -> Option<u64> {
        self.size
    }

    /// The document of the nodes, once they are counted.
    fn described(&mut self) -> Document {
        let of = Described {
            head: &self.head,
            layers: &self.layers,
            origin: self.origin,
            things: &self.things,
            arrays: &self.arrays,
            placeholder: &self.placeholder,
        };
        Document::new(of, std::mem::take(&mut self.nodes))
    }

    /// Counts the points of some more chunks. The document follows the last.
    fn count(&mut self, mut counting: Chunks) {
        let mut counts = vec![0u16; self.things.names.len()];
        // A few at a time, so that a client that leaves is noticed.
        for _ in 0..16 {
            counts.fill(0);
            let things = &self.things;
            let part = counting.next(|batch| {
                for row in batch.rows() {
                    counts[things.of(row)] += 1;
                }
            });
            let Some(part) = part else {
                self.document = Some((self.described(), 0));
                return;
            };
            let some = counts.iter().enumerate().filter(|(_, count)| **count > 0);
            for (thing, count) in some {
                let before = self.nodes.last();
                self.nodes.push(Node {
                    first: before.map_or(0, |node| node.first + u32::from(node.count)),
                    count: *count,
                    thing: u16::try_from(thing).unwrap_or(u16::MAX),
                    part: u16::try_from(part).unwrap_or(u16::MAX),
                });
            }
        }
        self.counting = Some(counting);
    }

    /// The arrays of the next chunk; empty after the last.
    fn chunk(&mut self) -> Vec<u8> {
        let Self {
            pose,
            things,
            arrays,
            chunks,
            points,
            ..
        } = self;
        let mut made = vec![vec![vec![]; arrays.listed().count()]; things.names.len()];
        chunks.next(|batch| {
            *points += batch.points.len() as u64;
            push(batch, pose, things, &mut made);
        });
        made.into_iter().flatten().flatten().collect()
    }
}

/// The nodes of parts with one thing: a node for each chunk.
fn uncounted(counts: impl Iterator<Item = u128>) -> Vec<Node> {
    let mut nodes: Vec<Node> = vec![];
    for (part, count) in counts.enumerate() {
        let mut left = u32::try_from(count).unwrap_or(u32::MAX);
        while left > 0 {
            let count = left.min(CHUNK as u32);
            let before = nodes.last();
            nodes.push(Node {
                first: before.map_or(0, |node| node.first + u32::from(node.count)),
                count: count as u16,
                thing: 0,
                part: u16::try_from(part).unwrap_or(u16::MAX),
            });
            left -= count;
        }
    }
    nodes
}

/// Appends some points to the arrays of their things.
fn push(batch: Batch<'_>, pose: &Pose, things: &Things, made: &mut [Vec<Vec<u8>>]) {
    fn floats<const N: usize>(out: Option<&mut Vec<u8>>, values: [f64; N]) {
        if let Some(out) = out {
            for v in values {
                out.extend_from_slice(&(v as f32).to_le_bytes());
            }
        }
    }
    for row in batch.rows() {
        let mut arrays = made[things.of(row)].iter_mut();
        let [x, y] = batch.near[row.index];
        let place = y_up([f64::from(x), f64::from(y), pose.z(row)]);
        floats(arrays.next(), place);
        if pose.is_turned() {
            floats(arrays.next(), y_up(pose.rotation(row)));
        }
        if pose.is_scaled() {
            floats(arrays.next(), [pose.scale(row); 3]);
        }
        if let Some(out) = arrays.next() {
            for part in [row.point.id.x, row.point.id.y] {
                out.extend_from_slice(&ids::halves(part));
            }
        }
        if let Some(height) = row.height
            && let Some(out) = arrays.next()
        {
            out.extend_from_slice(&ids::halves(height.address));
        }
        for (out, column) in arrays.zip(&pose.others) {
            let value = row.columns.get(*column).and_then(|v| v.number(row.index));
            floats(Some(out), [value.unwrap_or(0.0)]);
        }
    }
}

impl Blocks for Glb {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        if let Some(counting) = self.counting.take() {
            self.count(counting);
            return Some(Ok(Bytes::new()));
        }
        if let Some((document, piece)) = &mut self.document {
            let written = document.framed(*piece, &self.placeholder);
            *piece += 1;
            if let Some(written) = written {
                return Some(Ok(written.into()));
            }
            self.document = None;
        }
        if self.points == self.count {
            return None;
        }
        let chunk = self.chunk();
        (!chunk.is_empty()).then(|| Ok(chunk.into()))
    }
}

#[cfg(test)]
mod tests;
