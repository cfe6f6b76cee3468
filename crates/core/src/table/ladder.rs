//! The ladder: displacements of their own for the blocks that are left at smaller shares.
//!
//! A *level* holds vectors for a share λ; level 0 is the table itself, at λ = 1. Between two levels a
//! block moves once, on a part of the way from one share to the next, its *event*: when its near neighbors
//! leave. So a point is a continuous function of the share, and at every share the points that are left
//! are spread as evenly as a set made for it, nearly.
//!
//! Level k has a vector for each block of which any point is left on the way down from level k − 1: the
//! first positions of the [order](super::Ranks). Below the last level points return to the table's own vectors
//! while the share halves: those serve fewer points better than vectors that fitted more.

use alloc::{format, vec::Vec};

use super::{Displacement, FRACTION_BITS, MAX_DISPLACEMENT, ranks::Order};
use crate::error::{Error, ErrorKind};

/// Fraction bits of the vectors of a ladder, in grid units: about 1/800 mean spacings.
///
/// ```
/// use strew_core::table::{LADDER_BITS, MAX_DISPLACEMENT};
///
/// // Vectors of up to 127 grid units fit 16 bits.
/// assert!(MAX_DISPLACEMENT * f64::from(1 << LADDER_BITS) < f64::from(i16::MAX));
/// ```
pub const LADDER_BITS: u32 = 8;

/// The unit of a ladder's vectors, in bits of the fixed point of a table.
pub(crate) const SHIFT: u32 = FRACTION_BITS - LADDER_BITS;

/// The unit of [`Rung::event`]: a 255th of the way from one level to the next.
const EVENT_UNITS: f64 = 255.0;

/// The vector of a block at one level, and when the block moves there from the level before.
///
/// ```
/// use strew_core::table::Rung;
///
/// // One grid unit to the right, in the middle third of the way down.
/// let rung = Rung { vector: [256, 0], event: [85, 170] };
/// assert!(rung.event[0] < rung.event[1]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rung {
    /// In units of 2⁻⁸ grid units; see [`LADDER_BITS`].
    pub vector: [i16; 2],
    /// The start and the end of the move, as 255ths of the way from the share of the level before to the
    /// share of this level. The start is less than the end.
    pub event: [u8; 2],
}

/// The displacements of a table's points at smaller shares.
///
/// ```
/// use strew_core::{Table, table::{Ladder, Ranks, Rung}};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let blocks = table.displacements().len();
/// let table = table.with_ranks(Ranks::new((0..blocks as u32).collect())?)?;
/// // On the way to a half all points move by (1, 0) grid units.
/// let rung = Rung { vector: [256, 0], event: [0, 255] };
/// let ladder = Ladder::new(vec![(0.5, vec![rung; blocks])])?;
/// let table = table.with_ladder(ladder)?;
/// assert_eq!(table.ladder().map(|ladder| ladder.least_share()), Some(0.5));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    pub(super) levels: Vec<Level>,
    /// The rungs of all levels, one after another.
    pub(super) rungs: Vec<Rung>,
    /// For each sixteenth of an octave of shares, from 1 down, the first level that may lie below it.
    hints: Vec<u16>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    /// λ, in units of 2⁻³².
    share: u32,
    /// λ as a number.
    least: f64,
    /// The start of its rungs, and their number: by position in the order of blocks.
    pub(super) first: u32,
    pub(super) length: u32,
    /// The share of the level above, and the units of a stage's way down from there that a share of 1 takes.
    pub(super) above: f64,
    pub(super) per_share: f64,
    /// The largest component of a vector of this level or one above it.
    reach: u16,
}

/// A place between two levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stage {
    /// The number of the level below; 0 where the table itself holds.
    below: usize,
    /// The part of the way down to it, in units of [`EVENT_UNITS`].
    way: f64,
    /// Below the last level, the part of the way back to the table's own vectors.
    back: f64,
    /// The units of `way` that a share of 1 takes.
    per_share: f64,
    /// The time by which events begin earlier and end later, in units of `way`, within the segment.
    spread: f64,
}

impl Stage {
    /// The stage at which the table itself holds.
    pub(crate) const FULL: Self = Self {
        below: 0,
        way: 0.0,
        back: 0.0,
        per_share: 0.0,
        spread: 0.0,
    };

    /// The stage with events that begin earlier and end later, in units of its way.
    #[inline(always)]
    pub(crate) const fn spread_by(self, spread: f64) -> Self {
        Self { spread, ..self }
    }

    /// The units of the way that a share of 1 takes; 0 where no event goes on.
    #[inline(always)]
    pub(crate) const fn per_share(self) -> f64 {
        self.per_share
    }

    /// The part of a block's move that is done.
    #[inline(always)]
    fn part(self, event: [u8; 2]) -> f64 {
        part([self.way, self.spread], event.map(f64::from))
    }
}

/// The part of a block's move that is done at a place on the way down, with an event that begins earlier and ends
/// later by `spread`.
#[inline(always)]
pub(crate) fn part([way, spread]: [f64; 2], event: [f64; 2]) -> f64 {
    let start = event[0] - spread;
    let start = if start > 0.0 { start } else { 0.0 };
    let end = event[1] + spread;
    let end = if end < EVENT_UNITS { end } else { EVENT_UNITS };
    let part = (way - start) / (end - start);
    let part = if part > 0.0 { part } else { 0.0 };
    if part < 1.0 { part } else { 1.0 }
}

impl Ladder {
    /// The most levels.
    pub const MAX_LEVELS: usize = 512;

    /// A ladder of levels below the table itself: the share of each, and its rungs by position in the
    /// order of blocks. Shares are rounded to 2⁻³².
    ///
    /// # Errors
    /// [`ErrorKind::Table`] unless shares fall from below 1 to above 0, events start before they end, and
    /// vectors are shorter than [`MAX_DISPLACEMENT`] along each axis.
    ///
    /// ```
    /// use strew_core::table::{Ladder, Rung};
    ///
    /// let level = |share| (share, vec![Rung { vector: [0, 0], event: [0, 255] }]);
    /// assert_eq!(Ladder::new(vec![level(0.5), level(0.25)])?.shares().count(), 2);
    /// assert!(Ladder::new(vec![level(0.25), level(0.5)]).is_err());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(levels: Vec<(f64, Vec<Rung>)>) -> Result<Self, Error> {
        // A conversion outside 32 bits saturates, and is refused below.
        let raw = |(share, rungs)| (libm::round(share * SHARE_UNITS) as u32, rungs);
        Self::from_raw(levels.into_iter().map(raw).collect())
    }

    /// The ladder of levels in the file's numbers.
    pub(super) fn from_raw(levels: Vec<(u32, Vec<Rung>)>) -> Result<Self, Error> {
        let refused = |value: alloc::string::String, allowed: &'static str| {
            Err(Error::new(ErrorKind::Table, "ladder", value, allowed))
        };
        if !(1..=Self::MAX_LEVELS).contains(&levels.len()) {
            return refused(format!("{} levels", levels.len()), "1 to 512 levels");
        }
        let falls = levels.windows(2).all(|pair| pair[0].0 > pair[1].0);
        if !falls
            || levels
                .iter()
                .any(|(share, _)| [0, u32::MAX].contains(share))
        {
            return refused(
                "not in order".into(),
                "levels whose shares fall from 1 to 0",
            );
        }
        let limit = (MAX_DISPLACEMENT as i16) << LADDER_BITS;
        let is_valid = |rung: &Rung| {
            rung.event[0] < rung.event[1]
                && rung.vector.iter().all(|v| (1 - limit..limit).contains(v))
        };
        let mut all = levels.iter().flat_map(|(_, rungs)| rungs);
        if let Some(rung) = all.find(|rung| !is_valid(rung)) {
            let allowed =
                "events that start before they end, and vectors shorter than 127 grid units";
            return refused(format!("{rung:?}"), allowed);
        }
        Ok(Self::of_valid(&levels))
    }

    fn of_valid(raw: &[(u32, Vec<Rung>)]) -> Self {
        let (mut reach, mut above) = (0, 1.0);
        let mut levels = Vec::with_capacity(raw.len());
        let mut all = Vec::with_capacity(raw.iter().map(|(_, rungs)| rungs.len()).sum());
        for (share, rungs) in raw {
            let components = rungs.iter().flat_map(|rung| rung.vector);
            reach = components.fold(reach, |reach: u16, v| reach.max(v.unsigned_abs()));
            let least = f64::from(*share) / SHARE_UNITS;
            levels.push(Level {
                share: *share,
                least,
                first: all.len() as u32,
                length: rungs.len() as u32,
                above,
                per_share: EVENT_UNITS / (above - least),
                reach,
            });
            all.extend(rungs);
            above = least;
        }
        let hints = (0..HINTS).map(|bucket| {
            // Shares of this bucket are below its upper end.
            let high = (1.0f64.to_bits() >> HINT_SHIFT) - bucket;
            let most = f64::from_bits(high << HINT_SHIFT);
            levels.partition_point(|level| level.least >= most) as u16
        });
        Self {
            hints: hints.collect(),
            levels,
            rungs: all,
        }
    }

    /// Refuses a ladder whose levels do not have the blocks that an order leaves.
    pub(super) fn check(&self, order: &Order) -> Result<(), Error> {
        let mut before = 1.0;
        for (level, k) in self.levels.iter().zip(1..) {
            let expected = order.alive(before);
            if level.length as usize != expected {
                let value = format!("{} vectors at level {k}", level.length);
                let allowed = format!("{expected}, the number of blocks left above it");
                return Err(Error::new(ErrorKind::Table, "ladder", value, allowed));
            }
            before = level.least;
        }
        Ok(())
    }

    /// The shares of the levels, falling; that of the table itself, 1, is not among them.
    ///
    /// ```
    /// use strew_core::table::{Ladder, Rung};
    ///
    /// let rung = Rung { vector: [0, 0], event: [0, 255] };
    /// let ladder = Ladder::new(vec![(0.5, vec![rung]), (0.25, vec![rung])])?;
    /// assert!(ladder.shares().eq([0.5, 0.25]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        self.levels.iter().map(|level| level.least)
    }

    /// The share of the last level. Below it points return to where they are in the full set, while the share
    /// halves.
    ///
    /// ```
    /// use strew_core::table::{Ladder, Rung};
    ///
    /// let rung = Rung { vector: [0, 0], event: [0, 255] };
    /// assert_eq!(Ladder::new(vec![(0.5, vec![rung])])?.least_share(), 0.5);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn least_share(&self) -> f64 {
        self.levels.last().map_or(1.0, |level| level.least)
    }

    /// The rungs of level `k`, from 1 on, by position in the order of blocks; none past the last level.
    ///
    /// ```
    /// use strew_core::table::{Ladder, Rung};
    ///
    /// let rung = Rung { vector: [8, 0], event: [0, 255] };
    /// let ladder = Ladder::new(vec![(0.5, vec![rung])])?;
    /// assert_eq!(ladder.level(1), [rung]);
    /// assert!(ladder.level(2).is_empty());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn level(&self, k: usize) -> &[Rung] {
        let level = k.checked_sub(1).and_then(|at| self.levels.get(at));
        level.map_or(&[], |level| self.of(level))
    }

    /// The rungs of a level.
    #[inline(always)]
    fn of(&self, level: &Level) -> &[Rung] {
        &self.rungs[level.first as usize..][..level.length as usize]
    }

    /// The place of a share between the levels.
    #[inline]
    pub(crate) fn stage(&self, share: f64) -> Stage {
        let below = self.below(share);
        let Some(level) = self.levels.get(below) else {
            let least = self.least_share();
            return Stage {
                below: self.levels.len(),
                way: EVENT_UNITS,
                back: ((least - share) / (0.5 * least)).min(1.0),
                ..Stage::FULL
            };
        };
        if share >= level.above {
            return Stage::FULL;
        }
        Stage {
            below: below + 1,
            way: (level.above - share) * level.per_share,
            per_share: level.per_share,
            ..Stage::FULL
        }
    }

    /// A bound of the components of all vectors at shares from `share` on, in units of a table's vectors;
    /// those of the table itself not included.
    pub(crate) fn reach(&self, share: f64) -> i32 {
        let level = self.stage(share).below.checked_sub(1);
        let level = level.and_then(|at| self.levels.get(at));
        level.map_or(0, |level| i32::from(level.reach) << SHIFT)
    }

    /// The displacement of a block at a stage: its position in the order, and its vector in the table.
    /// A block that has left stays where it was when it left, or at the last level that knows it.
    #[inline]
    pub(crate) fn displacement(
        &self,
        stage: Stage,
        position: usize,
        full: Displacement,
    ) -> Displacement {
        let Stage { below, back, .. } = stage;
        if back > 0.0 {
            let last = self.last(below, position, full);
            return between(last, full, back);
        }
        let Some(&rung) = self.level(below).get(position) else {
            return self.last(below, position, full);
        };
        let from = match below {
            1 => full,
            _ => widened(self.level(below - 1)[position]),
        };
        between(from, widened(rung), stage.part(rung.event))
    }

    /// The number of levels above a share, the table itself not included.
    #[inline(always)]
    pub(super) fn below(&self, share: f64) -> usize {
        // The highest bits of a number below 1 fall as it falls.
        let high = 1.0f64.to_bits() - 1;
        let bucket = (high >> HINT_SHIFT).saturating_sub(share.to_bits() >> HINT_SHIFT) as usize;
        let mut below = usize::from(self.hints[bucket.min(self.hints.len() - 1)]);
        while self
            .levels
            .get(below)
            .is_some_and(|level| level.least > share)
        {
            below += 1;
        }
        below
    }

    /// The displacement of a block at the last level up to `below` that knows it.
    #[cold]
    fn last(&self, below: usize, position: usize, full: Displacement) -> Displacement {
        let known = (1..=below).rev().find_map(|k| self.level(k).get(position));
        known.map_or(full, |&rung| widened(rung))
    }

    /// About the memory that the ladder holds, in bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        size_of_val(&*self.rungs) + size_of_val(&*self.levels)
    }

    /// The levels in the file's numbers.
    pub(super) fn raw(&self) -> impl Iterator<Item = (u32, &[Rung])> {
        self.levels
            .iter()
            .map(|level| (level.share, self.of(level)))
    }
}

/// The bits of a number below those that make a hint's bucket: 16 buckets an octave.
const HINT_SHIFT: u32 = 48;
/// The number of buckets: 10 octaves. Below them the last one starts the search.
const HINTS: u64 = 160;

/// The unit of a level's share.
const SHARE_UNITS: f64 = 4_294_967_296.0;

/// A part of the way from one vector to another.
#[inline(always)]
pub(crate) fn between(from: Displacement, to: Displacement, part: f64) -> Displacement {
    let along = |from: i32, to: i32| from + ((f64::from(to) - f64::from(from)) * part) as i32;
    [along(from[0], to[0]), along(from[1], to[1])]
}

/// The vector of a rung, in units of a table's vectors.
#[inline(always)]
fn widened(rung: Rung) -> Displacement {
    let [x, y] = rung.vector;
    [i32::from(x) << SHIFT, i32::from(y) << SHIFT]
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_stage_is_between_the_levels_around_the_share(
            share in prop_oneof![0.0..1.0f64, 0.0..0.01f64, Just(1.0), Just(0.5), Just(2.0)],
            per_octave in 1u32..20, octaves in 1u32..12,
        ) {
            let levels = (1..=per_octave * octaves).map(|k| {
                let rung = Rung { vector: [0, 0], event: [0, 255] };
                (libm::exp2(-f64::from(k) / f64::from(per_octave)), vec![rung])
            });
            let ladder = Ladder::new(levels.collect()).expect("valid");
            let shares: Vec<f64> = [1.0].into_iter().chain(ladder.shares()).collect();
            let Stage { below, way, back, .. } = ladder.stage(share);
            if below == 0 {
                prop_assert!(share >= 1.0);
            } else if share < ladder.least_share() {
                prop_assert_eq!((below, way), (shares.len() - 1, EVENT_UNITS));
                prop_assert!(0.0 < back && back <= 1.0);
            } else {
                prop_assert!(shares[below] <= share && share < shares[below - 1]);
                let expected = (shares[below - 1] - share) / (shares[below - 1] - shares[below]);
                prop_assert!((way - expected * EVENT_UNITS).abs() < 1e-9);
            }
        }
    }
}
