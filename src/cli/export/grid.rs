//! The chunks of an export: levels of detail, each a rectangle of the world grid, and the addresses of chunks.

use std::ops::Range;

use anyhow::anyhow;
use serde::{Deserialize, Serialize};
use strew_core::Keep;

use crate::cli::Failure;

/// The most levels of detail: an eleventh would have the share 4⁻¹⁰ of the points, less than the smallest, 10⁻⁶.
pub(super) const MOST_LEVELS: u32 = 10;
/// The most chunks: digests and lengths of all files stay in memory until the end, a few hundred bytes for a chunk.
const MOST_CHUNKS: usize = 10_000_000;

/// A level of detail: chunks that are 2ᵏ times as wide, with the share 4⁻ᵏ of the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Level {
    pub(super) size: f64,
    pub(super) lod: f64,
    /// The query of addresses, which the daemon needs for the same answer.
    pub(super) query: String,
    pub(super) columns: [i64; 2],
    pub(super) rows: [i64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) level: usize,
    pub(super) at: [i64; 2],
}

/// All chunks, in the order of levels, columns and rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    path: String,
    pub(super) levels: Vec<Level>,
}

impl Level {
    /// The chunks that a box touches.
    pub(super) fn new(size: f64, lod: f64, query: String, bbox: [f64; 4]) -> Result<Self, Failure> {
        let [min_x, min_y, max_x, max_y] = bbox;
        let between = |min: f64, max: f64| {
            let (first, end) = ((min / size).floor(), (max / size).ceil());
            let is_near = [first, end].iter().all(|v| v.abs() <= FARTHEST);
            let range = [first as i64, (end as i64).max(first as i64 + 1)];
            is_near.then_some(range).ok_or_else(|| {
                Failure::Usage(anyhow!(
                    "--bbox {min_x},{min_y},{max_x},{max_y} reaches too far for --chunk {size}; allowed: columns and \
                     rows of chunks within ±{FARTHEST}"
                ))
            })
        };
        Ok(Self {
            size,
            lod,
            query,
            columns: between(min_x, max_x)?,
            rows: between(min_y, max_y)?,
        })
    }

    /// Checks a level that was read from a file, which may be damaged.
    pub(super) fn validate(&self) -> anyhow::Result<()> {
        let Self { size, lod, .. } = self;
        if !(size.is_finite() && *size > 0.0) {
            return Err(anyhow!("size: {size}; allowed: a finite number above 0"));
        }
        if !(Keep::MIN..=1.0).contains(lod) {
            return Err(anyhow!(
                "lod: {lod}; allowed: a number from {:e} to 1",
                Keep::MIN
            ));
        }
        for (name, [first, end]) in [("columns", self.columns), ("rows", self.rows)] {
            let is_near = [first, end]
                .iter()
                .all(|cell| cell.unsigned_abs() <= FARTHEST as u64);
            if !is_near || first >= end {
                return Err(anyhow!(
                    "{name}: [{first}, {end}]; allowed: the first and the end after it, within ±{FARTHEST}"
                ));
            }
        }
        Ok(())
    }

    fn ranges(&self) -> [Range<i64>; 2] {
        [self.columns, self.rows].map(|[first, end]| first..end)
    }

    pub(super) fn chunks(&self) -> u128 {
        let [columns, rows] = self.ranges().map(|range| range.end.abs_diff(range.start));
        u128::from(columns) * u128::from(rows)
    }

    pub(super) fn bbox(&self) -> [f64; 4] {
        let at = |cell: i64| cell as f64 * self.size;
        [
            at(self.columns[0]),
            at(self.rows[0]),
            at(self.columns[1]),
            at(self.rows[1]),
        ]
    }
}

const FARTHEST: f64 = (1u64 << 52) as f64;

impl Grid {
    pub(super) fn new(world: Option<&str>, levels: Vec<Level>) -> Result<Self, Failure> {
        let grid = Self {
            path: match world {
                Some(name) => format!("v1/worlds/{name}/chunks"),
                None => "v1/chunks".into(),
            },
            levels,
        };
        let chunks: u128 = grid.levels.iter().map(Level::chunks).sum();
        match usize::try_from(chunks) {
            Ok(few) if few <= MOST_CHUNKS => Ok(grid),
            _ => Err(Failure::Usage(anyhow!(
                "--bbox has {chunks} chunks; allowed: at most {MOST_CHUNKS}: choose a smaller box or larger chunks"
            ))),
        }
    }

    pub(super) fn chunks(&self) -> usize {
        self.levels
            .iter()
            .map(|level| level.chunks() as usize)
            .sum()
    }

    pub(super) fn place(&self, mut i: usize) -> Place {
        for (number, level) in self.levels.iter().enumerate() {
            let chunks = level.chunks() as usize;
            if i < chunks {
                let [columns, rows] = level.ranges();
                let height = (rows.end - rows.start) as usize;
                let [column, row] = [i / height, i % height].map(|k| k as i64);
                return Place {
                    level: number,
                    at: [columns.start + column, rows.start + row],
                };
            }
            i -= chunks;
        }
        unreachable!("chunks are counted")
    }

    /// The beginning of the paths of chunks, without the first slash.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    pub(super) fn folder(&self, level: &Level) -> String {
        format!("{}/{}", self.path, level.size)
    }

    /// The path of a chunk below the daemon's address, without the first slash.
    pub(super) fn name(&self, i: usize) -> String {
        let place = self.place(i);
        let [x, y] = place.at;
        format!("{}/{x}/{y}", self.folder(&self.levels[place.level]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_numbered_by_level_column_and_row() {
        let level = |size, bbox| Level::new(size, 1.0, String::new(), bbox).expect("near");
        let bbox = [-65.0, 0.0, 64.0, 128.5];
        let levels = vec![level(64.0, bbox), level(128.0, bbox)];
        let grid = Grid::new(Some("forest"), levels).expect("few");
        assert_eq!(grid.chunks(), 9 + 4);
        let names: Vec<String> = (0..13).map(|i| grid.name(i)).collect();
        assert_eq!(names[0], "v1/worlds/forest/chunks/64/-2/0");
        assert_eq!(names[8], "v1/worlds/forest/chunks/64/0/2");
        assert_eq!(names[9], "v1/worlds/forest/chunks/128/-1/0");
        assert_eq!(names[12], "v1/worlds/forest/chunks/128/0/1");
        assert_eq!(grid.levels[1].bbox(), [-128.0, 0.0, 128.0, 256.0]);
    }

    #[test]
    fn too_many_chunks_are_refused() {
        let far = Level::new(1e-12, 1.0, String::new(), [0.0, 0.0, 1e6, 1.0]);
        assert!(far.is_err());
        let many = Level::new(1.0, 1.0, String::new(), [0.0, 0.0, 1e6, 1e6]).expect("near");
        assert!(Grid::new(None, vec![many.clone()]).is_err());
        let most = Level {
            rows: [0, 10],
            ..many
        };
        assert!(Grid::new(None, vec![most.clone()]).is_ok());
        let more = Level {
            rows: [0, 11],
            ..most
        };
        assert!(Grid::new(None, vec![more]).is_err());
    }
}
