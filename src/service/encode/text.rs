//! What the text formats share: blocks of rows, and ids.

use bytes::Bytes;
use strew_core::PointId;

use super::{
    Blocks, EncodeError,
    rows::{Row, Rows},
};

/// A text format: what stands before, at, and after the rows.
pub(super) trait TextFormat {
    /// Writes what comes before the first row.
    fn begin(&mut self, out: &mut Vec<u8>);
    /// Writes a row; `first` says that none was written before.
    fn row(&mut self, row: Row<'_>, first: bool, out: &mut Vec<u8>);
    /// Writes what comes after the last of `points` rows.
    fn end(&mut self, points: u64, out: &mut Vec<u8>);
    /// More than is usually written for a row.
    fn row_bytes(&self) -> usize;
}

/// Points are made so many at a time: few enough to stay in the fastest memory.
const POINTS_AT_ONCE: usize = 256;

/// The blocks of a text answer.
#[derive(Debug)]
pub(super) struct TextBlocks<T> {
    rows: Rows,
    format: T,
    block_bytes: usize,
    points: u64,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Begin,
    Points,
    Over,
}

impl<T: TextFormat> TextBlocks<T> {
    pub(super) const fn new(rows: Rows, format: T, block_bytes: usize) -> Self {
        Self {
            rows,
            format,
            block_bytes,
            points: 0,
            state: State::Begin,
        }
    }

    /// What a block may take at most; less when little is left.
    fn capacity(&self) -> usize {
        let left = self.rows.count().saturating_sub(self.points.into());
        let left = usize::try_from(left).unwrap_or(usize::MAX);
        let row = self.format.row_bytes();
        let whole = self.block_bytes + POINTS_AT_ONCE * row;
        whole.min(left.saturating_mul(row).saturating_add(2048))
    }
}

impl<T: TextFormat + std::fmt::Debug + Send> Blocks for TextBlocks<T> {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        if self.state == State::Over {
            return None;
        }
        let mut out = Vec::with_capacity(self.capacity());
        if self.state == State::Begin {
            self.format.begin(&mut out);
            self.state = State::Points;
        }
        while out.len() < self.block_bytes {
            let Some(batch) = self.rows.next(POINTS_AT_ONCE) else {
                self.format.end(self.points, &mut out);
                self.state = State::Over;
                break;
            };
            for row in batch.rows() {
                self.format.row(row, self.points == 0, &mut out);
                self.points += 1;
            }
        }
        Some(Ok(out.into()))
    }
}

/// Writes an id: `column:row`.
pub fn write_id(id: PointId, out: &mut Vec<u8>) {
    let mut digits = itoa::Buffer::new();
    out.extend_from_slice(digits.format(id.x).as_bytes());
    out.push(b':');
    out.extend_from_slice(digits.format(id.y).as_bytes());
}

/// An id as a text of its own.
#[must_use]
pub fn id_text(id: PointId) -> String {
    let (mut x, mut y) = (itoa::Buffer::new(), itoa::Buffer::new());
    [x.format(id.x), ":", y.format(id.y)].concat()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::service::encode::{Encoding, Output, sample_rows::answer};

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
        assert_eq!(whole["query"]["decimals"], 2);
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
            let mut out = vec![];
            write_id(id, &mut out);
            prop_assert_eq!(String::from_utf8(out).expect("digits"), id.to_string());
            prop_assert_eq!(id_text(id), id.to_string());
        }
    }
}
