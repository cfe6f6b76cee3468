//! An answer: a planned query on its way out.

use std::fmt;

use bytes::Bytes;
use strew_core::{F32, F64, Plan};
use strew_error::{Error, Fault};

#[cfg(feature = "columnar")]
use crate::{
    batches::Batches,
    columnar::{Arrow, Columnar, Writer as _},
    parquet::{GROUP_ROWS, Parquet},
};
use crate::{
    blocks::{Blocks, EncodeError},
    csv,
    encoding::Encoding,
    geojson, glb,
    head::Head,
    index::Index,
    json, legend,
    members::Members,
    npy,
    output::Output,
    packed::{Pairs, Triples},
    part::Part,
    place::Place,
    ply, png,
    pose::Pose,
    posed,
    preview::Frame,
    records::{Layout, Records},
    rows::Rows,
    svg,
    text::{TextBlocks, TextFormat},
    usda,
};

/// A planned query on its way out: the blocks of its answer in one format.
#[derive(Debug)]
pub struct Answer {
    /// The bytes before all blocks, if they are known beforehand.
    head: Option<Bytes>,
    blocks: Box<dyn Blocks>,
    size: Option<u64>,
    piece: Option<Piece>,
    origin: Option<Place>,
    legend: Option<String>,
    warning: Option<&'static str>,
    plain: Option<Plain>,
}

/// What an answer is made of, if any part of it can be made alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Points of so many bytes each, and nothing between or after them.
    Bytes(u64),
    /// Blocks of so many points each, whose bytes depend on these alone, and a last block for the end.
    Points(u64),
}

/// An answer that is nothing but a head and the packed points of one plan. Callers with several threads can fill the
/// plan's tiles instead of taking blocks one by one.
#[derive(Clone, Debug)]
pub struct Plain {
    /// The bytes before the points.
    pub head: Option<Bytes>,
    /// The points.
    pub plan: Plan,
    /// Whether coordinates are `f32` relative to the plan's origin, else `f64`.
    pub is_f32: bool,
}

impl Answer {
    /// The answer of some parts, in blocks of about `block_bytes`. `head` is called with their number of points, for
    /// formats that have room for a head: the facts about the answer.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the format cannot hold the answer.
    pub fn new(
        parts: Vec<Part>,
        head: impl FnOnce(u128) -> Head,
        output: &Output,
        block_bytes: usize,
    ) -> Result<Self, Error> {
        Ok(Self {
            warning: output.warning(),
            ..Self::of_parts(parts, head, output, block_bytes)?
        })
    }

    fn of_parts(
        parts: Vec<Part>,
        head: impl FnOnce(u128) -> Head,
        output: &Output,
        block_bytes: usize,
    ) -> Result<Self, Error> {
        let coordinates = output.coordinates(|| Part::corner(&parts));
        let count = parts.iter().map(|part| part.plan.count()).sum();
        let frame = Frame::new(&parts, output.size).with_dots(output.dot, &parts);
        let parts = match output.encoding {
            Encoding::Png => frame.shown(parts)?,
            _ => parts,
        };
        let head = || head(count);
        let rows = Rows::new(parts, coordinates);
        let rows = match output.decimals {
            Some(decimals) if !output.encoding.traits().is_picture => rows.rounded(decimals)?,
            _ => rows,
        };
        let members = || Members::new(&rows, output);
        let (layout, before) = match output.encoding {
            Encoding::F32 => (Layout::F32, None),
            Encoding::F64 => (Layout::F64, None),
            Encoding::Npy => (Layout::F64, Some(npy::head(&rows))),
            Encoding::Ply => (Layout::Vertex, Some(ply::head(&rows, &head()))),
            Encoding::Multimesh | Encoding::Instances => {
                posed::check(output.encoding, rows.schema(), &Pose::new(rows.schema()))?;
                let layout = match output.encoding {
                    Encoding::Multimesh => Layout::Multimesh,
                    _ => Layout::Instance,
                };
                (layout, None)
            }
            Encoding::Glb => {
                let glb = glb::Glb::new(rows, head())?;
                return Ok(Self {
                    size: glb.size(),
                    ..Self::of_blocks(coordinates.origin(), glb)
                });
            }
            Encoding::Usda => {
                let usda = usda::Usda::new(rows, &head())?;
                return Ok(Self::of_blocks(coordinates.origin(), usda));
            }
            Encoding::Png => {
                let png = png::Png::new(rows, head(), frame, block_bytes);
                return Ok(Self::of_blocks(None, png));
            }
            Encoding::Svg => {
                let most = svg::MOST_POINTS;
                if rows.count() > most.into() {
                    let detail = format!("the answer has {} points", rows.count());
                    let allowed = format!("svg for at most {most} points; png for any number");
                    let fault = Fault::new("format", "svg", detail, allowed);
                    return Err(fault.into());
                }
                let format = svg::Svg::new(&rows, head(), frame, output.decimals);
                return Ok(Self::of_text(rows, format, block_bytes));
            }
            Encoding::Arrow | Encoding::Feather | Encoding::Parquet => {
                return Self::in_columns(rows, &head(), output, block_bytes);
            }
            Encoding::Json => {
                let (head, members) = (head(), members());
                let format = json::Json { head, members };
                return Ok(Self::of_text(rows, format, block_bytes));
            }
            Encoding::Ndjson => {
                let summary = output.has_summary.then(head);
                let format = json::Ndjson {
                    last: summary.map(|summary| json::Last { summary }),
                    members: members(),
                };
                return Ok(Self::of_text(rows, format, block_bytes));
            }
            Encoding::Csv => {
                let format = csv::Csv::new(&rows, output);
                return Ok(Self::of_text(rows, format, block_bytes));
            }
            Encoding::Geojson => {
                let (head, members) = (head(), members());
                let format = geojson::Collection { head, members };
                return Ok(Self::of_text(rows, format, block_bytes));
            }
            Encoding::Geojsonseq => {
                let members = members();
                return Ok(Self::of_text(
                    rows,
                    geojson::Sequence { members },
                    block_bytes,
                ));
            }
        };
        let legend = legend::legend(rows.schema(), output.encoding);
        Ok(Self {
            legend,
            ..Self::of_records(rows, layout, before, block_bytes)
        })
    }

    /// An answer in a columnar format.
    #[cfg(feature = "columnar")]
    fn in_columns(
        rows: Rows,
        head: &Head,
        output: &Output,
        block_bytes: usize,
    ) -> Result<Self, Error> {
        let origin = rows.coordinates().origin();
        if output.encoding == Encoding::Parquet {
            let crs = output.crs.as_ref().map(|crs| {
                let allowed = "a system of EPSG that is projected or geographic and not deprecated, OGC:CRS84, or \
                               with `strew sample` a file of PROJJSON";
                let detail = "its definition is not known here, and Parquet must hold it";
                crs.projjson()
                    .ok_or_else(|| Fault::new("crs", crs, detail, allowed))
            });
            let mut parquet = Parquet::new(rows.schema(), head, crs.transpose()?, output.zstd)?;
            let mark = std::mem::take(parquet.written()).into();
            return Ok(Self {
                head: Some(mark),
                piece: Some(Piece::Points(GROUP_ROWS as u64)),
                ..Self::of_blocks(origin, Columnar::new(rows, parquet))
            });
        }
        let batches = Batches::new(rows.schema(), head, None);
        let writer = Arrow::new(batches, output.encoding == Encoding::Feather, block_bytes)?;
        Ok(Self::of_blocks(origin, Columnar::new(rows, writer)))
    }

    /// Refuses columnar formats: programs that link the library without them have writers of their own.
    #[cfg(not(feature = "columnar"))]
    fn in_columns(_: Rows, _: &Head, output: &Output, _: usize) -> Result<Self, Error> {
        let encoding = output.encoding;
        let allowed = Encoding::names();
        let detail = "only the daemon and `strew sample` write it";
        Err(Fault::new("format", encoding.name(), detail, allowed).into())
    }

    /// Blocks of unknown size, without anything before them.
    fn of_blocks(origin: Option<Place>, blocks: impl Blocks + 'static) -> Self {
        Self {
            head: None,
            size: None,
            piece: None,
            origin,
            legend: None,
            warning: None,
            plain: None,
            blocks: Box::new(blocks),
        }
    }

    /// A text of unknown size.
    fn of_text<T>(rows: Rows, format: T, block_bytes: usize) -> Self
    where
        T: TextFormat + fmt::Debug + Send + 'static,
    {
        let origin = rows.coordinates().origin();
        Self::of_blocks(origin, TextBlocks::new(rows, format, block_bytes))
    }

    /// Records after a head; straight from the kernel where they are no more than coordinates.
    fn of_records(rows: Rows, layout: Layout, head: Option<Bytes>, block_bytes: usize) -> Self {
        let before = head.as_ref().map_or(0, |head| head.len() as u64);
        let bytes = layout.record_bytes(rows.schema()) as u64;
        let size = u64::try_from(rows.count()).ok();
        let size = size.and_then(|rows| bytes.checked_mul(rows)?.checked_add(before));
        let origin = rows.coordinates().origin();
        let plan = rows.plain_plan().cloned();
        let plain = plan.and_then(|plan| {
            Some(Plain {
                head: head.clone(),
                plan,
                is_f32: layout.plain_f32()?,
            })
        });
        let blocks: Box<dyn Blocks> = match &plain {
            // The plan has no points.
            _ if rows.count() == 0 => Box::new(Records::new(rows, layout, block_bytes)),
            Some(Plain { plan, is_f32, .. }) if *is_f32 => {
                Box::new(Pairs::<F32>::new(plan, block_bytes))
            }
            Some(Plain { plan, .. }) => Box::new(Pairs::<F64>::new(plan, block_bytes)),
            None => match (rows.plain_volume(), layout.plain_f32()) {
                (Some(plan), Some(true)) => Box::new(Triples::<F32>::new(plan, block_bytes)),
                (Some(plan), Some(false)) => Box::new(Triples::<F64>::new(plan, block_bytes)),
                _ => Box::new(Records::new(rows, layout, block_bytes)),
            },
        };
        Self {
            head,
            blocks,
            size,
            piece: Some(Piece::Bytes(bytes)),
            origin,
            legend: None,
            warning: None,
            // The tiles of a window would be those of the whole plan.
            plain: plain.filter(|plain| !plain.plan.is_window()),
        }
    }

    /// The exact size in bytes, where it is known before.
    pub const fn size(&self) -> Option<u64> {
        self.size
    }

    /// What it is made of, if any part of it can be made alone.
    pub const fn piece(&self) -> Option<Piece> {
        self.piece
    }

    /// Where its bytes lie, if that is known before they are made.
    pub fn index(&self) -> Option<Index> {
        let (Some(Piece::Bytes(bytes)), size) = (self.piece, self.size?) else {
            return None;
        };
        let front = self.head.clone().unwrap_or_default();
        let rows = (size - front.len() as u64) / bytes;
        Some(Index::even(front, bytes, rows))
    }

    /// The bytes before the points, until they are taken.
    pub const fn head(&self) -> Option<&Bytes> {
        self.head.as_ref()
    }

    /// The origin of the coordinates, if it is not the world's.
    pub const fn origin(&self) -> Option<Place> {
        self.origin
    }

    /// For formats without names in them: the columns, as a JSON list in ASCII. Each has a `name`, a
    /// `type` and, where its values are indices, the `names` that they stand for.
    pub fn legend(&self) -> Option<&str> {
        self.legend.as_deref()
    }

    /// A warning of a mistake that readers of the format may make.
    pub const fn warning(&self) -> Option<&'static str> {
        self.warning
    }

    /// The plan whose tiles are the answer, if that is all there is in it.
    pub const fn plain(&self) -> Option<&Plain> {
        self.plain.as_ref()
    }

    /// The number of points encoded so far.
    pub fn points(&self) -> u64 {
        self.blocks.points()
    }
}

impl Iterator for Answer {
    type Item = Result<Bytes, EncodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.head.take() {
            Some(head) => Some(Ok(head)),
            None => self.blocks.next(),
        }
    }
}
