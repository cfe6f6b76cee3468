//! Counts the points of an answer as it passes, where its format shows them.

use serde_json::Value;
use strew_encode::Encoding;

/// The longest beginning of a line that tells lines of points from others.
const BEGINNING: usize = 18;

/// Counts the points of an answer.
pub(super) enum Tally {
    /// By lines, where a line is a point if its beginning says so.
    Lines {
        is_point: fn(&[u8]) -> bool,
        points: u64,
        /// The first bytes of the line that is read.
        beginning: Vec<u8>,
    },
    /// By bytes: those of a point, and those so far.
    Bytes { each: u64, read: u64 },
    /// The format does not show points without being decoded.
    Unknown,
}

impl Tally {
    /// For an answer in a format; `columns` is its header with that name.
    pub(super) fn new(encoding: Encoding, columns: Option<&str>) -> Self {
        let lines = |is_point| Self::Lines {
            is_point,
            points: 0,
            beginning: vec![],
        };
        let bytes = |width: u64| {
            let list: Result<Vec<Value>, _> = serde_json::from_str(columns.unwrap_or("[0,0]"));
            match list {
                Ok(list) if !list.is_empty() => Self::Bytes {
                    each: width * list.len() as u64,
                    read: 0,
                },
                _ => Self::Unknown,
            }
        };
        match encoding {
            Encoding::Csv => lines(|line| !line.starts_with(b"id,")),
            Encoding::Ndjson => lines(|line| !line.starts_with(br#"{"summary":"#)),
            Encoding::Geojsonseq => lines(|line| !line.is_empty()),
            Encoding::Geojson => lines(|line| line.starts_with(br#"{"type":"Feature","#)),
            Encoding::F32 => bytes(4),
            Encoding::F64 => bytes(8),
            _ => Self::Unknown,
        }
    }

    /// Counts a part of the answer.
    pub(super) fn add(&mut self, part: &[u8]) {
        match self {
            Self::Lines {
                is_point,
                points,
                beginning,
            } => {
                for line in part.split_inclusive(|byte| *byte == b'\n') {
                    let end = line.strip_suffix(b"\n");
                    let room = BEGINNING - beginning.len();
                    beginning.extend(end.unwrap_or(line).iter().take(room));
                    if end.is_some() {
                        *points += u64::from(is_point(beginning));
                        beginning.clear();
                    }
                }
            }
            Self::Bytes { read, .. } => *read += part.len() as u64,
            Self::Unknown => {}
        }
    }

    /// Fails with what the parts hold together if it is another number of points.
    pub(super) fn check(self, expected: u64) -> Result<(), String> {
        match self {
            Self::Lines { points, .. } if points != expected => Err(format!("{points} points")),
            Self::Bytes { each, read }
                if u128::from(expected) * u128::from(each) != read.into() =>
            {
                Err(format!("{read} bytes, {each} a point"))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_counted_wherever_the_answer_is_cut() {
        let feature = r#"{"type":"Feature","id":"2:-1"}"#;
        let collection = format!("{{\"type\":\"FeatureCollection\"\n{feature},\n{feature}\n]}}\n");
        for (encoding, text, points) in [
            (Encoding::Csv, "id,x,y\n1:2,3,4\n5:6,7,8\n", 2),
            (Encoding::Csv, "id,x,y\n", 0),
            (
                Encoding::Ndjson,
                "{\"id\":1}\n{\"id\":2}\n{\"summary\":{}}\n",
                2,
            ),
            (Encoding::Geojsonseq, "{}\n{}\n{}\n", 3),
            (Encoding::Geojson, collection.as_str(), 2),
            (Encoding::F32, "0123456701234567", 2),
        ] {
            for size in [1, 7, 1000] {
                let count = |expected| {
                    let mut tally = Tally::new(encoding, None);
                    text.as_bytes()
                        .chunks(size)
                        .for_each(|part| tally.add(part));
                    tally.check(expected)
                };
                assert_eq!(count(points), Ok(()), "{encoding:?}");
                assert!(count(points + 1).is_err(), "{encoding:?}");
            }
        }
    }
}
