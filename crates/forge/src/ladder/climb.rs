//! The state of a ladder in the making: vectors and events of every level, by position in the order.

use strew_core::{
    Table,
    table::{LADDER_BITS, Ladder, Rung},
};

use super::ground::{Ground, moves_of};
use crate::ForgeError;

/// Levels of vectors. Lengths are in mean spacings of the full set.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Climb {
    /// The share of each level; 1 at level 0.
    pub(super) shares: Vec<f64>,
    /// The number of blocks that each level has vectors for: those left above it.
    pub(super) counts: Vec<usize>,
    pub(super) moves: Vec<Vec<[f64; 2]>>,
    /// The start and the end of the move to each level, as parts of the way from the level before. None
    /// at level 0.
    pub(super) events: Vec<Vec<[f64; 2]>>,
}

/// The blocks of a table by position in the order in which they leave.
pub(super) struct Blocks {
    pub(super) ground: Ground,
    /// The block at each position.
    pub(super) at: Vec<u32>,
    /// The position of each block.
    pub(super) position: Vec<u32>,
    /// The rank below which no point of a position is left, and 1 after the last.
    pub(super) floors: Vec<f64>,
}

impl Blocks {
    /// The blocks of a table with ranks, for neighbors up to `reach` mean spacings apart in the pattern.
    pub(super) fn new(table: &Table, reach: f64) -> Option<Self> {
        let position = table.ranks()?.positions().to_vec();
        let mut at = vec![0; position.len()];
        for (block, &position) in (0..).zip(&position) {
            at[position as usize] = block;
        }
        let mut floors: Vec<f64> = at
            .iter()
            .map(|&block| table.block_ranks(block as usize).start)
            .collect();
        floors.push(1.0);
        Some(Self {
            ground: Ground::new(table.map(), reach),
            at,
            position,
            floors,
        })
    }

    /// The number of positions of which points may be left at a share.
    pub(super) fn alive(&self, share: f64) -> usize {
        self.floors[..self.at.len()].partition_point(|&floor| floor < share)
    }

    /// The part of a position's points that is left at a share.
    pub(super) fn left(&self, position: usize, share: f64) -> f64 {
        let (floor, next) = (self.floors[position], self.floors[position + 1]);
        if share >= next {
            1.0
        } else {
            ((share - floor) / (next - floor)).max(0.0)
        }
    }
}

impl Climb {
    /// Levels at some shares below 1, all with the table's own vectors.
    pub(super) fn start(table: &Table, blocks: &Blocks, below: &[f64]) -> Self {
        let moves = moves_of(table);
        let full: Vec<[f64; 2]> = blocks.at.iter().map(|&b| moves[b as usize]).collect();
        let shares: Vec<f64> = [1.0].iter().chain(below).copied().collect();
        let above = [2.0].iter().chain(&shares);
        let counts: Vec<usize> = above.take(shares.len()).map(|&s| blocks.alive(s)).collect();
        let moves = counts.iter().map(|&count| full[..count].to_vec()).collect();
        let event = |(k, &count): (usize, &usize)| vec![[0.0, 1.0]; if k == 0 { 0 } else { count }];
        Self {
            events: counts.iter().enumerate().map(event).collect(),
            shares,
            counts,
            moves,
        }
    }

    /// The number of segments: ways from a level to the next.
    pub(super) fn segments(&self) -> usize {
        self.shares.len() - 1
    }

    /// The share at a part of the way along a segment.
    pub(super) fn share_at(&self, segment: usize, way: f64) -> f64 {
        let (above, below) = (self.shares[segment], self.shares[segment + 1]);
        above + (below - above) * way
    }

    /// The move of a position toward the next level at a part of the way.
    pub(super) fn part(&self, segment: usize, position: usize, way: f64) -> f64 {
        let [start, end] = self.events[segment + 1][position];
        ((way - start) / (end - start)).clamp(0.0, 1.0)
    }

    /// The vector of a position at a part of the way along a segment.
    pub(super) fn vector(&self, segment: usize, position: usize, way: f64) -> [f64; 2] {
        let (from, to) = (
            self.moves[segment][position],
            self.moves[segment + 1][position],
        );
        let part = self.part(segment, position, way);
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))
    }

    /// Replaces the vectors of all levels, one level after the other.
    pub(super) fn set_moves(&mut self, moves: &[[f64; 2]]) {
        self.moves = split(moves, &self.counts);
    }

    /// Rounds events to what a table file holds.
    pub(super) fn quantize_events(&mut self) {
        for event in self.events.iter_mut().flatten() {
            *event = event_units(*event).map(|v| f64::from(v) / 255.0);
        }
    }

    /// Rounds vectors to what a table file holds.
    pub(super) fn quantize(&mut self, scale: f64) {
        let unit = scale / f64::from(1u32 << LADDER_BITS);
        for level in &mut self.moves[1..] {
            for v in level.iter_mut().flatten() {
                *v = (*v / unit).round() * unit;
            }
        }
    }

    /// The ladder of these levels.
    pub(super) fn ladder(&self, scale: f64) -> Result<Ladder, ForgeError> {
        let unit = scale / f64::from(1u32 << LADDER_BITS);
        let rung = |(vector, event): (&[f64; 2], &[f64; 2])| Rung {
            vector: vector.map(|v| (v / unit).round() as i16),
            event: event_units(*event),
        };
        let levels = (1..self.shares.len()).map(|k| {
            let rungs = self.moves[k].iter().zip(&self.events[k]).map(rung);
            (self.shares[k], rungs.collect())
        });
        Ok(Ladder::new(levels.collect())?)
    }
}

/// Vectors by level, by the numbers of vectors of the levels.
pub(super) fn split(vectors: &[[f64; 2]], counts: &[usize]) -> Vec<Vec<[f64; 2]>> {
    let mut rest = vectors;
    let levels = counts.iter().map(|&count| {
        let (level, after) = rest.split_at(count);
        rest = after;
        level.to_vec()
    });
    levels.collect()
}

/// An event in 255ths, at least one long.
fn event_units([start, end]: [f64; 2]) -> [u8; 2] {
    let start = (start * 255.0).round().clamp(0.0, 254.0);
    let end = (end * 255.0).round().clamp(start + 1.0, 255.0);
    [start as u8, end as u8]
}
