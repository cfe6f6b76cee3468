//! A planned query as messages: a header, blocks, a summary, made on demand.

use std::sync::Arc;

use strew_core::{ALGORITHM_VERSION, F32, F64};
use strew_encode as encode;
use strew_encode::{
    Batch, Encoding as Format, Mark, Output, Pairs, Rows, Values, id_text, schema::Kind,
};
use strew_error::Error;
use strew_plan::Planned;
use strew_service::Record;

use super::{
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
    F32(Pairs<F32>),
    F64(Pairs<F64>),
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
        let (name, format, bytes) = match encoding {
            Encoding::F32Le => ("f32", Format::F32, 8),
            Encoding::F64Le => ("f64", Format::F64, 16),
            // A usual id has about 16 bytes; the longest has 36.
            Encoding::Points | Encoding::Unspecified => ("points", Format::F64, 32),
        };
        let output = Output {
            relative_to: planned.query.region.corner,
            ..Output::new(format)
        };
        let parts = planned.parts()?;
        let coordinates = output.coordinates(|| encode::Part::corner(&parts));
        let rows = Rows::new(parts, coordinates);
        // The columns besides the layer's, which blocks have as a number of their own.
        let heads: Vec<ColumnHead> = rows.schema().own().iter().map(head).collect();
        let header = StreamHeader {
            query: Some(resolved::query(request, &planned, encoding)),
            count,
            columns: heads.clone(),
            algorithm: ALGORITHM_VERSION,
            origin: coordinates.origin().map(region::position),
        };
        let blocks = match (encoding, rows.plain_plan()) {
            (Encoding::F32Le, Some(plan)) => Blocks::F32(Pairs::new(plan, block_bytes)),
            (Encoding::F64Le, Some(plan)) => Blocks::F64(Pairs::new(plan, block_bytes)),
            _ => {
                let bytes = if rows.schema().is_in_space() {
                    bytes / 2 * 3
                } else {
                    bytes
                };
                // A number, or an index as a varint.
                let value = |head: &ColumnHead| if head.names.is_empty() { 8 } else { 2 };
                let columns: usize = heads.iter().map(value).sum();
                Blocks::Rows(Box::new(Table {
                    rows,
                    heads,
                    encoding,
                    length: block_bytes / (bytes + columns),
                }))
            }
        };
        Record::in_format(name);
        Ok(Self {
            planned,
            header: Some(header),
            blocks,
            count,
            over: false,
            record: Record::current(),
        })
    }

    fn block(&mut self) -> Option<PointBlock> {
        let of_data = |(points, data)| {
            let block = PointBlock {
                data,
                ..PointBlock::default()
            };
            (points, block)
        };
        let ((points, mut block), set, mark) = match &mut self.blocks {
            Blocks::F32(blocks) => (of_data(blocks.block()?), 0, blocks.cursor().map(Mark::from)),
            Blocks::F64(blocks) => (of_data(blocks.block()?), 0, blocks.cursor().map(Mark::from)),
            Blocks::Rows(table) => {
                let block = table.next()?;
                let (set, mark) = table.rows.mark().unwrap_or_default();
                (block, set, mark)
            }
        };
        if let Some(record) = &self.record {
            record.made(points as u64);
        }
        let next = mark.and_then(|mark| self.planned.token(set, mark));
        block.layer = u32::try_from(set).unwrap_or(u32::MAX);
        block.cursor = next.map(|token| token.to_string()).unwrap_or_default();
        Some(block)
    }
}

impl Iterator for Messages {
    type Item = StreamPointsResponse;

    fn next(&mut self) -> Option<StreamPointsResponse> {
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
