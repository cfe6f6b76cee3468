//! Blocks of rows, and ids, for all text formats.

use std::{collections::VecDeque, ops::Range};

use bytes::Bytes;
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelRefMutIterator as _, ParallelIterator as _,
};
use strew_core::PointId;

use super::{
    EncodeError,
    blocks::Blocks,
    buffer::Pool,
    place::Height,
    rows::{Row, Rows},
    writer::Writer,
};

/// A text format: what stands before, at, and after the rows.
pub(super) trait TextFormat: Sync {
    /// Writes what comes before the first row.
    fn begin(&self, _out: &mut Vec<u8>) {}
    /// Writes a row; `first` means that none was written before.
    fn row(&self, row: Row<'_>, first: bool, out: &mut Writer<'_>);
    /// Writes what comes after the last row.
    fn end(&self, _out: &mut Vec<u8>) {}
    /// More than is usually written for a row.
    fn row_bytes(&self) -> usize;
}

/// The blocks of a text answer.
///
/// Digits take ten times as long as points, so that several blocks are written side by side, each
/// on a thread of its own, and handed out one after another.
#[derive(Debug)]
pub(super) struct TextBlocks<T> {
    rows: Rows,
    format: T,
    block_bytes: usize,
    points: u64,
    /// The bytes of a row, by what the last ones took.
    row_bytes: usize,
    ready: VecDeque<Bytes>,
    pool: Pool<u8>,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Begin,
    Points,
    Over,
}

/// No more blocks than this are written at once: they are all held in memory.
const SIDE_BY_SIDE: usize = 4;

impl<T: TextFormat> TextBlocks<T> {
    pub(super) fn new(rows: Rows, format: T, block_bytes: usize) -> Self {
        Self {
            rows,
            row_bytes: format.row_bytes(),
            format,
            block_bytes,
            points: 0,
            ready: VecDeque::new(),
            pool: Pool::new(0),
            state: State::Begin,
        }
    }

    /// Writes some blocks more; the first call writes only one, since it is waited for.
    fn write_more(&mut self) {
        let mut before = self.pool.take_empty();
        let blocks = if self.state == State::Begin {
            self.format.begin(&mut before);
            self.state = State::Points;
            1
        } else {
            rayon::current_num_threads().clamp(1, SIDE_BY_SIDE)
        };
        let per_block = (self.block_bytes / self.row_bytes).max(1);
        let Some(batch) = self.rows.next(per_block * blocks) else {
            self.format.end(&mut before);
            self.ready.push_back(before.into());
            self.state = State::Over;
            return;
        };
        let (format, is_first, row_bytes) = (&self.format, self.points == 0, self.row_bytes);
        let count = batch.points.len();
        let write = |part: Range<usize>, out: &mut Vec<u8>| {
            out.reserve(part.len() * (row_bytes + row_bytes / 16) + 64);
            let start = part.start;
            let mut writer = Writer::new(out);
            for (i, row) in batch.rows_in(part).enumerate() {
                format.row(row, is_first && start + i == 0, &mut writer);
            }
            writer.finish();
        };
        let mut written = vec![before];
        written.resize_with(count.div_ceil(per_block), || self.pool.take_empty());
        if let [only] = written.as_mut_slice() {
            write(0..count, only);
        } else {
            let parts = written.par_iter_mut().enumerate();
            parts.for_each(|(i, out)| {
                let start = i * per_block;
                write(start..count.min(start + per_block), out);
            });
        }
        self.points += count as u64;
        let bytes: usize = written.iter().map(Vec::len).sum();
        self.row_bytes = (bytes / count).max(1);
        let pool = &self.pool;
        self.ready.extend(written.into_iter().map(|block| {
            let length = block.len();
            pool.lend(block, length)
        }));
    }
}

impl<T: TextFormat + std::fmt::Debug + Send> Blocks for TextBlocks<T> {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        if self.ready.is_empty() && self.state != State::Over {
            self.write_more();
        }
        self.ready.pop_front().map(Ok)
    }
}

/// An id as a text of its own; in space with the height of its point.
pub fn id_text(id: PointId, height: Option<&Height>) -> String {
    let (mut x, mut y) = (itoa::Buffer::new(), itoa::Buffer::new());
    let (x, y) = (x.format(id.x), y.format(id.y));
    match height {
        Some(height) => [x, ":", y, ":", itoa::Buffer::new().format(height.address)].concat(),
        None => [x, ":", y].concat(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Encoding, Output, sample_rows::answer};

    /// Both layers in a text format, with two decimals, line by line.
    fn lines(encoding: Encoding) -> Vec<String> {
        let output = Output {
            decimals: Some(2),
            ..Output::new(encoding)
        };
        let (bytes, size) = answer(&output, 4096);
        assert_eq!((bytes.clone(), size), (answer(&output, 1).0, None));
        let text = String::from_utf8(bytes).expect("UTF-8");
        text.lines().map(Into::into).collect()
    }

    #[test]
    fn csv_has_the_layer_first_and_what_is_missing_is_empty() {
        let lines = lines(Encoding::Csv);
        assert_eq!(lines[0], "layer,id,x,y,angle,variant");
        let (tree, rock) = (&lines[1], lines.last().expect("rocks"));
        let fields: Vec<&str> = tree.split(',').collect();
        assert_eq!((fields[0], fields.len()), ("trees", 6));
        assert!(
            fields[2..5]
                .iter()
                .all(|n| n.split_once('.').expect("decimals").1.len() == 2)
        );
        assert!(rock.starts_with("rocks,") && rock.contains(",,"), "{rock}");
        assert!(
            lines
                .iter()
                .any(|line| line.ends_with(",,\"grey, \"\"old\"\"\""))
        );
    }

    #[test]
    fn json_has_columns_as_members_and_leaves_out_what_is_missing() {
        let (ndjson, json) = (lines(Encoding::Ndjson), lines(Encoding::Json));
        let whole: serde_json::Value = serde_json::from_str(&json.concat()).expect("JSON");
        assert_eq!(whole["query"]["bbox"][0], -10.0);
        let points = whole["points"].as_array().expect("a list");
        assert_eq!(points.len(), ndjson.len() - 1);
        for (line, point) in ndjson.iter().zip(points) {
            let own: serde_json::Value = serde_json::from_str(line).expect("JSON");
            assert_eq!(&own, point);
            let is_tree = point["layer"] == "trees";
            assert_eq!(point["angle"].is_number(), is_tree);
            assert_eq!(point.get("angle").is_some(), is_tree);
            assert!(point["variant"].is_string() && point["id"].is_string());
        }
        assert!(
            points
                .iter()
                .any(|point| point["variant"] == "grey, \"old\"")
        );
    }

    proptest! {
        #[test]
        fn ids_are_written_as_the_library_writes_them(x: i64, y: i64) {
            let id = PointId { x, y };
            prop_assert_eq!(id_text(id, None), id.to_string());
            let height = Height { address: x ^ y, z: 0.0 };
            prop_assert_eq!(id_text(id, Some(&height)), format!("{id}:{}", x ^ y));
        }
    }
}
