//! A planned query as messages: a header, blocks, a summary, made on demand.

use std::sync::Arc;

use bytes::Bytes;
use prost::{
    Message as _,
    encoding::{WireType, encode_key, encode_varint},
};
use strew_core::{ALGORITHM_VERSION, Cursor, F32, F64};
use strew_encode as encode;
use strew_encode::{
    Batch, Coordinates, Encoding as Format, Mark, Output, Packed, Rows, Values, id_text,
    schema::Kind,
};
use strew_error::Error;
use strew_plan::Planned;
use strew_service::Record;

use super::{
    frames,
    proto::{
        Column, ColumnHead, Encoding, PointBlock, StreamHeader, StreamPointsRequest,
        StreamPointsResponse, StreamSummary, stream_points_response::Message,
    },
    region, resolved,
};

/// The messages of an answer.
#[derive(Debug)]
pub(super) struct Messages {
    planned: Planned,
    header: Option<StreamHeader>,
    blocks: Blocks,
    count: u64,
    over: bool,
    /// Where points are noted as they are made.
    record: Option<Arc<Record>>,
}

#[derive(Debug)]
enum Blocks {
    /// Coordinates without anything else, straight from the kernel.
    F32(Packed<F32>),
    F64(Packed<F64>),
    /// All else.
    Rows(Box<Table>),
}

impl Messages {
    /// The messages of a planned query, in blocks of about `block_bytes`.
    pub(super) fn new(
        request: &StreamPointsRequest,
        planned: Planned,
        encoding: Encoding,
        block_bytes: usize,
    ) -> Result<Self, Error> {
        // Answers of more points than the limit, which has 64 bits, are refused.
        let count = u64::try_from(planned.count()).unwrap_or(u64::MAX);
        let format = match encoding {
            Encoding::F32Le => Format::F32,
            Encoding::F64Le | Encoding::Points | Encoding::Unspecified => Format::F64,
        };
        let output = Output {
            relative_to: planned.query.region.corner,
            ..Output::new(format)
        };
        let parts = planned.parts()?;
        let coordinates = Coordinates::of(&output, || encode::Part::corner(&parts));
        let rows = Rows::new(parts, coordinates);
        let heads: Vec<ColumnHead> = own_columns(&rows).iter().map(head).collect();
        let header = StreamHeader {
            query: Some(resolved::query(request, &planned, encoding)),
            count,
            columns: heads.clone(),
            algorithm: ALGORITHM_VERSION,
            origin: coordinates.origin().map(region::position),
        };
        let blocks = match (encoding, rows.plain_plan()) {
            (Encoding::F32Le, Some(plan)) => {
                Blocks::F32(Packed::with_room(plan, block_bytes, ROOM))
            }
            (Encoding::F64Le, Some(plan)) => {
                Blocks::F64(Packed::with_room(plan, block_bytes, ROOM))
            }
            _ => Blocks::Rows(Box::new(Table::new(rows, heads, encoding, block_bytes))),
        };
        Ok(Self {
            planned,
            header: Some(header),
            blocks,
            count,
            over: false,
            record: Record::current(),
        })
    }

    fn message(&mut self) -> Option<StreamPointsResponse> {
        if self.over {
            return None;
        }
        let message = if let Some(header) = self.header.take() {
            Message::Header(header)
        } else if let Some(block) = self.block() {
            Message::Block(block)
        } else {
            self.over = true;
            let next = self.planned.next();
            Message::Summary(StreamSummary {
                count: self.count,
                next_cursor: next.map(|token| token.to_string()).unwrap_or_default(),
            })
        };
        Some(StreamPointsResponse {
            message: Some(message),
        })
    }

    /// The next block of packed coordinates, between what `around` makes of its size and its other fields.
    fn packed(
        &mut self,
        mut around: impl FnMut(usize, PointBlock) -> [Vec<u8>; 2],
    ) -> Option<Bytes> {
        let (planned, made) = (&self.planned, noting(&self.record));
        let mut noted = |bytes, point, cursor: Option<Cursor>| {
            made(bytes / point);
            around(bytes, after(planned, 0, cursor.map(Mark::from)))
        };
        match &mut self.blocks {
            Blocks::F32(packed) => {
                packed.next_between(|bytes, blocks| noted(bytes, 8, blocks.cursor()))
            }
            Blocks::F64(packed) => {
                packed.next_between(|bytes, blocks| noted(bytes, 16, blocks.cursor()))
            }
            Blocks::Rows(_) => None,
        }
    }

    fn block(&mut self) -> Option<PointBlock> {
        let Blocks::Rows(table) = &mut self.blocks else {
            let mut rest = PointBlock::default();
            let data = self.packed(|_, block| {
                rest = block;
                Default::default()
            })?;
            return Some(PointBlock { data, ..rest });
        };
        let (points, block) = table.next()?;
        noting(&self.record)(points);
        let (set, mark) = table.rows.mark().unzip();
        let PointBlock { layer, cursor, .. } = after(&self.planned, set.unwrap_or_default(), mark);
        Some(PointBlock {
            layer,
            cursor,
            ..block
        })
    }

    /// The next message framed: a block of packed coordinates in the buffer that it was made in.
    fn frame(&mut self) -> Option<Bytes> {
        let is_block = self.header.is_none() && !self.over;
        let framed = is_block.then(|| self.packed(|bytes, rest| around(bytes, &rest)));
        framed
            .flatten()
            .or_else(|| Some(frames::framed(&self.message()?)))
    }
}

/// Notes how many points were made.
fn noting(record: &Option<Arc<Record>>) -> impl Fn(usize) + use<'_> {
    move |points| {
        if let Some(record) = record {
            record.made(points as u64);
        }
    }
}

/// A block without its points: its layer and the place after it.
fn after(planned: &Planned, set: usize, mark: Option<Mark>) -> PointBlock {
    let token = mark.and_then(|mark| planned.token(set, mark));
    PointBlock {
        layer: u32::try_from(set).unwrap_or(u32::MAX),
        cursor: token.map(|token| token.to_string()).unwrap_or_default(),
        ..PointBlock::default()
    }
}

/// Room before and after the points of a block: for its prefix, two tags with their lengths; for the
/// longest cursor, 174 digits.
const ROOM: [usize; 2] = [32, 192];

/// The bytes around the data of a block in a message of its own: prefix and tags, and the rest of
/// its fields, all of which come after the data.
fn around(data: usize, rest: &PointBlock) -> [Vec<u8>; 2] {
    const BLOCK: u32 = 2;
    const DATA: u32 = 4;
    let tagged = |tag: u32, length: usize| {
        let mut field = vec![];
        encode_key(tag, WireType::LengthDelimited, &mut field);
        encode_varint(length as u64, &mut field);
        field
    };
    let after = rest.encode_to_vec();
    let data_tag = tagged(DATA, data);
    let block = data_tag.len() + data + after.len();
    let block_tag = tagged(BLOCK, block);
    let prefix = frames::prefix(block_tag.len() + block);
    [[&prefix[..], &block_tag, &data_tag].concat(), after]
}

/// The messages as frames.
impl Iterator for Messages {
    type Item = Bytes;

    fn next(&mut self) -> Option<Bytes> {
        self.frame()
    }
}

/// The columns besides the layer's, which blocks have as a number of their own.
fn own_columns(rows: &Rows) -> &[encode::Column] {
    rows.schema().own()
}

fn head(column: &encode::Column) -> ColumnHead {
    ColumnHead {
        name: column.name.clone(),
        names: match &column.kind {
            Kind::Number => vec![],
            Kind::Dictionary(names) => names.to_vec(),
        },
    }
}

/// Blocks made of rows.
#[derive(Debug)]
struct Table {
    rows: Rows,
    heads: Vec<ColumnHead>,
    encoding: Encoding,
    /// The number of points of a block.
    length: usize,
}

impl Table {
    fn new(rows: Rows, heads: Vec<ColumnHead>, encoding: Encoding, block_bytes: usize) -> Self {
        let coordinates = match encoding {
            // A usual id has about 16 bytes; the longest has 36.
            Encoding::Points | Encoding::Unspecified => 32,
            Encoding::F64Le => 16,
            Encoding::F32Le => 8,
        };
        let is_in_space = rows.schema().is_in_space();
        let coordinates = coordinates + if is_in_space { coordinates / 2 } else { 0 };
        // A number, or an index as a varint.
        let value = |head: &ColumnHead| if head.names.is_empty() { 8 } else { 2 };
        let columns: usize = heads.iter().map(value).sum();
        Self {
            rows,
            heads,
            encoding,
            length: block_bytes / (coordinates + columns),
        }
    }

    /// The next block, and how many points it has.
    fn next(&mut self) -> Option<(usize, PointBlock)> {
        let before = self.rows.schema().columns().len() - self.heads.len();
        let batch = self.rows.next(self.length)?;
        let mut block = coordinates(batch, self.encoding);
        let values = self.heads.iter().zip(&batch.columns[before..]);
        block.columns = values
            .filter_map(|(head, values)| column(head, values))
            .collect();
        Some((batch.points.len(), block))
    }
}

fn coordinates(batch: Batch<'_>, encoding: Encoding) -> PointBlock {
    let points = batch.points;
    let packed = |data: Vec<u8>| PointBlock {
        data: data.into(),
        ..PointBlock::default()
    };
    match encoding {
        Encoding::Points | Encoding::Unspecified => PointBlock {
            x: points.iter().map(|point| point.x).collect(),
            y: points.iter().map(|point| point.y).collect(),
            id: (points.iter().enumerate())
                .map(|(i, point)| id_text(point.id, batch.heights.get(i)))
                .collect(),
            z: batch.heights.iter().map(|height| height.z).collect(),
            ..PointBlock::default()
        },
        Encoding::F64Le => {
            let places = points.iter().map(|point| [point.x, point.y]);
            packed(by_turns(places, batch, f64::to_le_bytes))
        }
        Encoding::F32Le => {
            // Heights are those of the kernel, which `f32` holds.
            let places = batch.near.iter().map(|place| place.map(f64::from));
            packed(by_turns(places, batch, |value| {
                (value as f32).to_le_bytes()
            }))
        }
    }
}

/// The coordinates of points by turns.
fn by_turns<const N: usize>(
    places: impl Iterator<Item = [f64; 2]>,
    batch: Batch<'_>,
    bytes: impl Fn(f64) -> [u8; N],
) -> Vec<u8> {
    let mut out = Vec::with_capacity(3 * N * batch.points.len());
    for (i, place) in places.enumerate() {
        let height = batch.heights.get(i).map(|height| height.z);
        for value in place.into_iter().chain(height) {
            out.extend_from_slice(&bytes(value));
        }
    }
    out
}

/// The values of a column, if the points have them.
fn column(head: &ColumnHead, values: &Values) -> Option<Column> {
    let (mut numbers, mut indices) = (vec![], vec![]);
    match values {
        Values::Numbers(values) => numbers.clone_from(values),
        Values::Indices(values) => indices.clone_from(values),
        Values::Missing => return None,
    }
    Some(Column {
        name: head.name.clone(),
        numbers,
        indices,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn framed_by_hand_a_block_is_what_prost_writes() {
        for (bytes, layer, cursor) in [(1, 0, ""), (127, 0, "c"), (128, 3, "01"), (300_000, 0, "f")]
        {
            let data = Bytes::from(vec![7; bytes]);
            let rest = PointBlock {
                layer,
                cursor: cursor.into(),
                ..PointBlock::default()
            };
            let [before, after] = around(bytes, &rest);
            let message = StreamPointsResponse {
                message: Some(Message::Block(PointBlock {
                    data: data.clone(),
                    ..rest
                })),
            };
            assert_eq!(
                [&before, &data[..], &after].concat(),
                frames::framed(&message)
            );
        }
    }
}
