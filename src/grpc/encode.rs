//! A planned query as messages: a header, blocks, a summary, made when they are asked for.

use strew_core::{
    ALGORITHM_VERSION, Plan, Point,
    sample::{Blocks, F32, F64, Points},
};

use super::{
    convert,
    proto::{
        Encoding, PointBlock, Position, StreamHeader, StreamPointsResponse, StreamSummary,
        stream_points_response::Message,
    },
};
use crate::service::{
    Error, Planned,
    encode::{Packed, id_text},
};

/// The messages of an answer.
#[derive(Debug)]
pub(super) struct Messages {
    header: Option<StreamHeader>,
    blocks: AnyBlocks,
    count: u64,
    over: bool,
}

#[derive(Debug)]
enum AnyBlocks {
    Points(Fields),
    F32(Packed<F32>),
    F64(Packed<F64>),
}

impl Messages {
    /// The messages of a planned query, in blocks of about `block_bytes`.
    pub(super) fn new(
        planned: &Planned,
        encoding: Encoding,
        block_bytes: usize,
    ) -> Result<Self, Error> {
        let count = u64::try_from(planned.count())
            .map_err(|_| Error::Internal("a count within the limit is too large"))?;
        let plan = &planned.sets[0].plan;
        let [x, y] = plan.origin();
        let header = StreamHeader {
            query: Some(convert::resolved(planned, encoding)),
            count,
            table: planned.entry().digest.clone(),
            algorithm: ALGORITHM_VERSION,
            origin: Some(Position { x, y }),
        };
        let blocks = match encoding {
            Encoding::Unspecified | Encoding::Points => {
                AnyBlocks::Points(Fields::new(plan, block_bytes))
            }
            Encoding::F32Le => AnyBlocks::F32(Packed::new(plan, block_bytes)),
            Encoding::F64Le => AnyBlocks::F64(Packed::new(plan, block_bytes)),
        };
        Ok(Self {
            header: Some(header),
            blocks,
            count,
            over: false,
        })
    }

    fn block(&mut self) -> Option<PointBlock> {
        let data = match &mut self.blocks {
            AnyBlocks::Points(fields) => return fields.next(),
            AnyBlocks::F32(packed) => packed.next()?,
            AnyBlocks::F64(packed) => packed.next()?,
        };
        Some(PointBlock {
            data,
            ..PointBlock::default()
        })
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
            Message::Summary(StreamSummary { count: self.count })
        };
        Some(StreamPointsResponse {
            message: Some(message),
        })
    }
}

/// Blocks with coordinates and ids in fields of their own.
#[derive(Debug)]
struct Fields {
    blocks: Blocks<Points>,
    points: Box<[Point]>,
}

/// A usual point takes two coordinates of 8 bytes and an id of about 16; the longest id has 36.
const POINT_BYTES: usize = 32;

impl Fields {
    fn new(plan: &Plan, block_bytes: usize) -> Self {
        let most = usize::try_from(plan.count()).unwrap_or(usize::MAX);
        let length = (block_bytes / POINT_BYTES).min(most).max(1);
        Self {
            blocks: plan.blocks(),
            points: vec![Point::default(); length].into(),
        }
    }

    fn next(&mut self) -> Option<PointBlock> {
        let filled = self.blocks.fill(&mut self.points);
        let points = &self.points[..filled];
        (filled > 0).then(|| PointBlock {
            x: points.iter().map(|point| point.x).collect(),
            y: points.iter().map(|point| point.y).collect(),
            id: points.iter().map(|point| id_text(point.id)).collect(),
            ..PointBlock::default()
        })
    }
}
