//! What the text formats share: blocks of points, ids and numbers.

use bytes::Bytes;
use strew_core::{
    Plan, Point, PointId,
    sample::{Blocks, Points},
};

/// A text format: what stands before, at, and after the points.
pub(super) trait TextFormat {
    /// Writes what comes before the first point.
    fn begin(&mut self, out: &mut Vec<u8>);
    /// Writes a point; `first` says that none was written before.
    fn point(&mut self, point: &Point, first: bool, out: &mut Vec<u8>);
    /// Writes what comes after the last of `points` points.
    fn end(&mut self, points: u64, out: &mut Vec<u8>);
}

/// Points are made so many at a time: few enough to stay in the fastest memory.
const POINTS_AT_ONCE: usize = 256;
/// More than any of the formats writes for a point.
const POINT_BYTES: usize = 160;

/// The blocks of a text answer.
#[derive(Debug)]
pub(super) struct TextBlocks<T> {
    blocks: Blocks<Points>,
    made: Box<[Point]>,
    format: T,
    block_bytes: usize,
    points: u64,
    count: u128,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Begin,
    Points,
    Over,
}

impl<T: TextFormat> TextBlocks<T> {
    pub(super) fn new(plan: &Plan, format: T, block_bytes: usize) -> Self {
        Self {
            blocks: plan.blocks(),
            made: vec![Point::default(); POINTS_AT_ONCE].into(),
            format,
            block_bytes,
            points: 0,
            count: plan.count(),
            state: State::Begin,
        }
    }

    /// What a block may take at most; less when little is left.
    fn capacity(&self) -> usize {
        let left = usize::try_from(self.count - u128::from(self.points)).unwrap_or(usize::MAX);
        let whole = self.block_bytes + POINTS_AT_ONCE * POINT_BYTES;
        whole.min(left.saturating_mul(POINT_BYTES).saturating_add(2048))
    }
}

impl<T> TextBlocks<T> {
    pub(super) const fn points(&self) -> u64 {
        self.points
    }
}

impl<T: TextFormat> Iterator for TextBlocks<T> {
    type Item = Bytes;

    fn next(&mut self) -> Option<Bytes> {
        if self.state == State::Over {
            return None;
        }
        let mut out = Vec::with_capacity(self.capacity());
        if self.state == State::Begin {
            self.format.begin(&mut out);
            self.state = State::Points;
        }
        while out.len() < self.block_bytes {
            let filled = self.blocks.fill(&mut self.made);
            if filled == 0 {
                self.format.end(self.points, &mut out);
                self.state = State::Over;
                break;
            }
            for point in &self.made[..filled] {
                self.format.point(point, self.points == 0, &mut out);
                self.points += 1;
            }
        }
        Some(out.into())
    }
}

/// Writes the shortest digits that read back to the same number. It must be finite, as every
/// coordinate is; then the text is a valid number in JSON.
pub fn write_number(value: f64, out: &mut Vec<u8>) {
    out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
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

/// Writes a value as JSON. What is written here has no maps with strange keys, so it cannot fail.
pub(super) fn write_json(value: &impl serde::Serialize, out: &mut Vec<u8>) {
    if let Err(error) = serde_json::to_writer(out, value) {
        debug_assert!(false, "{error}");
    }
}

/// Writes `{"id":"…","x":…,"y":…}`.
pub(super) fn write_point(point: &Point, out: &mut Vec<u8>) {
    out.extend_from_slice(b"{\"id\":\"");
    write_id(point.id, out);
    out.extend_from_slice(b"\",\"x\":");
    write_number(point.x, out);
    out.extend_from_slice(b",\"y\":");
    write_number(point.y, out);
    out.push(b'}');
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn text(value: f64) -> String {
        let mut out = vec![];
        write_number(value, &mut out);
        String::from_utf8(out).expect("digits")
    }

    fn check(value: f64) {
        let text = text(value);
        let back: f64 = text.parse().expect("a number");
        assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        assert!(serde_json::from_str::<f64>(&text).is_ok(), "{text} is JSON");
        // As few digits as Rust's own; where two such numbers are equally near they may differ.
        let digits = |t: &str| {
            let mantissa = t.split(['e', 'E']).next().unwrap_or_default();
            let all: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            all.trim_matches('0').len()
        };
        assert_eq!(digits(&text), digits(&format!("{value:e}")), "{text}");
    }

    #[test]
    fn numbers_at_the_edges_are_json_and_read_back() {
        for value in [
            0.0,
            -0.0,
            5.0,
            0.1,
            1e15,
            1e16,
            1e21,
            1e22,
            -1e300,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            1e-5,
            1e-7,
            123_456_789.123_456_79,
        ] {
            check(value);
            check(-value);
        }
    }

    proptest! {
        #[test]
        fn any_finite_number_is_json_and_reads_back(bits: u64) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            check(value);
        }

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
