//! Encoders: planned points as bytes, block by block, on demand.
//!
//! An [`Answer`] is a plain iterator that owns all it needs and can move between threads. It makes the whole document:
//! the head, the points, and the summary after them. Its points come from [`Part`]s, each a [`Source`] with a layer's
//! name and further columns; [`Head`] describes the answer. Formats are made of [`Rows`]; only packed coordinates
//! without further columns come straight from the kernel. Depends on the core and on the words of faults; knows no
//! query, no table and no protocol. Arrow and Parquet come with the feature `columnar`.

mod answer;
#[cfg(feature = "columnar")]
mod batches;
mod blocks;
mod buffer;
mod canvas;
mod chunks;
#[cfg(feature = "columnar")]
mod columnar;
mod crs;
mod csv;
#[cfg(feature = "columnar")]
mod definitions;
mod encoding;
mod geojson;
mod glb;
mod head;
mod ids;
mod index;
mod json;
pub mod legend;
mod members;
mod npy;
mod number;
mod output;
mod packed;
#[cfg(feature = "columnar")]
mod parquet;
pub mod part;
mod place;
mod ply;
mod png;
mod pose;
mod posed;
pub mod preview;
mod records;
#[cfg(feature = "columnar")]
mod row_group;
pub mod rows;
#[cfg(test)]
mod sample_rows;
pub mod schema;
mod shift;
mod source;
mod svg;
mod text;
mod usda;
mod within;
mod writer;

pub use answer::{Answer, Piece, Plain};
pub use blocks::EncodeError;
pub use buffer::Pool;
pub use crs::{CRS, Crs};
pub use encoding::{Encoding, Traits};
pub use head::{Head, Json, Tables};
pub use index::{Cut, Index};
pub use number::{Digits, write_number};
pub use output::{DEFAULT_SIZE, MOST_DECIMALS, Output, ZSTD_LEVEL};
pub use packed::{Packed, Pairs, Scalars, Triples, to_little_endian};
pub use part::{Attributes, Part};
pub use place::{Coordinates, Height, Located, Mark, Place};
pub use pose::ROTATION as POSE_ROTATION;
pub use rows::{Batch, Row, Rows};
pub use schema::{Column, Kind, LAYER, Schema, Values, Z as POSE_Z};
pub use source::{Bound, Source, Walk};
pub use text::id_text;
