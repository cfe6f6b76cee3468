//! Counts the points of an answer as it passes, where its format shows them.

use serde_json::Value;
use strew_encode::Encoding;

/// Counts the points of an answer.
pub(super) enum Tally {
    /// By lines: those so far, and how many of all are no points. A line break between quotes, where the format has
    /// such, ends none.
    Lines {
        read: u64,
        others: u64,
        is_quoted: Option<bool>,
    },
    /// By bytes: those of a point, and those so far.
    Bytes { each: u64, read: u64 },
    /// The format does not show points without being decoded.
    Unknown,
}

impl Tally {
    /// For an answer in a format, which has a summary or not; `columns` is its header with that name.
    pub(super) fn new(encoding: Encoding, has_summary: bool, columns: Option<&str>) -> Self {
        let lines = |others| Self::Lines {
            read: 0,
            others,
            is_quoted: (encoding == Encoding::Csv).then_some(false),
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
            // The names of the columns.
            Encoding::Csv => lines(1),
            Encoding::Ndjson => lines(has_summary.into()),
            Encoding::Geojsonseq => lines(0),
            // What stands before the points, and the end.
            Encoding::Json | Encoding::Geojson => lines(2),
            Encoding::F32 => bytes(4),
            Encoding::F64 => bytes(8),
            _ => Self::Unknown,
        }
    }

    /// Counts a part of the answer.
    pub(super) fn add(&mut self, part: &[u8]) {
        match self {
            Self::Lines {
                read, is_quoted, ..
            } => {
                for byte in part {
                    match (byte, is_quoted.as_mut()) {
                        (b'"', Some(is_quoted)) => *is_quoted = !*is_quoted,
                        (b'\n', None | Some(false)) => *read += 1,
                        _ => {}
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
            Self::Lines { read, others, .. } if read.checked_sub(others) != Some(expected) => {
                Err(format!("{} points", read.saturating_sub(others)))
            }
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
    fn points_are_counted_by_the_lines_that_the_format_has() {
        let feature = r#"{"type":"Feature","id":"2:-1"}"#;
        let collection = format!("{{\"type\":\"FeatureCollection\"\n{feature},\n{feature}\n]}}\n");
        for (encoding, has_summary, text, points) in [
            (Encoding::Csv, true, "id,x,y\n1:2,3,4\n5:6,7,8\n", 2),
            (Encoding::Csv, true, "layer,id,x,y\nid,1:2,3,4\n", 1),
            (Encoding::Csv, true, "id,x,y\n", 0),
            (
                Encoding::Csv,
                true,
                "layer,id\n\"A,\"\"B\"\"\n/c\",1:2\n",
                1,
            ),
            (Encoding::Ndjson, true, "{}\n{}\n{\"summary\":{}}\n", 2),
            (Encoding::Ndjson, false, "{}\n{}\n", 2),
            (Encoding::Geojsonseq, true, "{}\n{}\n{}\n", 3),
            (Encoding::Geojson, true, collection.as_str(), 2),
            (Encoding::Json, true, "{\"points\":[\n]}\n", 0),
            (Encoding::F32, true, "0123456701234567", 2),
        ] {
            let count = |expected| {
                let mut tally = Tally::new(encoding, has_summary, None);
                let pieces = text.as_bytes().chunks(7);
                pieces.for_each(|part| tally.add(part));
                tally.check(expected)
            };
            assert_eq!(count(points), Ok(()), "{encoding:?}");
            assert!(count(points + 1).is_err(), "{encoding:?}");
        }
    }
}
