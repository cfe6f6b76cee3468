//! How many points an answer holds, counted as it passes, where its format shows it.

use crate::service::Encoding;

/// The longest beginning of a line that says what the line is.
const BEGINNING: usize = 18;

/// Counts the points of an answer.
pub(super) enum Tally {
    /// A point a line, for lines of a kind.
    Lines(Lines),
    /// A point every so many bytes.
    Bytes {
        /// Of one point.
        each: u64,
        /// So far.
        read: u64,
    },
    /// The format does not show it without being read.
    Unknown,
}

pub(super) struct Lines {
    is_point: fn(&[u8]) -> bool,
    points: u64,
    /// The first bytes of the line that is read.
    beginning: Vec<u8>,
}

impl Tally {
    /// For an answer in a format; `columns` is its header with that name.
    pub(super) fn new(encoding: Encoding, columns: Option<&str>) -> Self {
        let lines = |is_point| {
            Self::Lines(Lines {
                is_point,
                points: 0,
                beginning: vec![],
            })
        };
        let columns = || {
            let list = columns.unwrap_or("[0,0]");
            let list: Vec<serde_json::Value> = serde_json::from_str(list).ok()?;
            Some(list.len() as u64).filter(|columns| *columns > 0)
        };
        let bytes = |width: u64| match columns() {
            Some(columns) => Self::Bytes {
                each: width * columns,
                read: 0,
            },
            None => Self::Unknown,
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
            Self::Lines(lines) => lines.add(part),
            Self::Bytes { read, .. } => *read += part.len() as u64,
            Self::Unknown => {}
        }
    }

    /// Whether all parts together are this many points, and how many they are if not.
    pub(super) fn check(self, points: u64) -> Result<(), String> {
        match self {
            Self::Lines(lines) if lines.points != points => Err(format!("{} points", lines.points)),
            Self::Bytes { each, read } if u128::from(points) * u128::from(each) != read.into() => {
                Err(format!("{read} bytes, {each} a point"))
            }
            _ => Ok(()),
        }
    }
}

impl Lines {
    fn add(&mut self, part: &[u8]) {
        for line in part.split_inclusive(|byte| *byte == b'\n') {
            let room = BEGINNING - self.beginning.len();
            let text = line.strip_suffix(b"\n");
            let more = text.unwrap_or(line);
            self.beginning.extend(more.iter().take(room));
            if text.is_some() {
                self.points += u64::from((self.is_point)(&self.beginning));
                self.beginning.clear();
            }
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
