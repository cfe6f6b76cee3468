//! Mixes: which kind the points of each block are, and tables with them.
//!
//! A mix labels each block with a kind. Labels alone meet the shares of kinds only within the area of a block,
//! so some blocks are split by a strip along dX, at most one for each kind but the last. Then the share of every
//! kind is exact to 2⁻⁵⁰.
//!
//! In a turned table a split takes the same part of the block's interval of dX, whichever way the block is
//! turned, as the strip of ranks does.

use alloc::{format, vec, vec::Vec};

use super::{Shares, ranks::scattered};
use crate::{
    error::{Error, ErrorKind},
    map::Map,
    parts::OfKinds,
};

/// A block with points of two kinds: those whose dX lies at least `offset` beyond the start of the block's
/// interval of dX are of `kind`, the others of the block's label.
///
/// ```
/// use strew_core::{Map, table::Mix};
///
/// let map = Map::new("sqrt(3)".parse()?, 20)?;
/// let mix = Mix::scattered(&map, "1:3:10".parse()?)?;
/// for split in mix.splits() {
///     let interval = map.interval(split.block as usize % map.intervals());
///     assert!((1..interval.end - interval.start).contains(&split.offset));
///     assert_ne!(mix.labels()[split.block as usize], split.kind);
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Split {
    /// The number of the block: row by row.
    pub block: u32,
    /// The place in the block's interval of dX from which on points are of `kind`, in units of 2⁻⁶⁴; more than
    /// 0 and less than the length of the interval.
    pub offset: u64,
    /// The kind of the points from there on.
    pub kind: u8,
}

/// The kinds of the points of a table, block by block, for given shares.
///
/// ```
/// use strew_core::{Map, table::{Mix, Shares}};
///
/// let map = Map::new("sqrt(3)".parse()?, 20)?;
/// let shares: Shares = "1:3".parse()?;
/// let mix = Mix::scattered(&map, shares.clone())?;
/// assert_eq!(Mix::new(&map, shares.clone(), mix.labels().to_vec())?, mix);
/// // Labels must be near the shares.
/// let blocks = mix.labels().len();
/// assert!(Mix::new(&map, shares, vec![1; blocks]).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mix {
    shares: Shares,
    labels: Vec<u8>,
    splits: Vec<Split>,
    part: OfKinds,
}

impl Mix {
    /// A mix of labels, one for each block, row by row: the number of a kind in the order of the shares. Blocks
    /// are split so that the shares are exact.
    ///
    /// In ascending order, each kind but the last takes what it lacks from the kind after it that has most too
    /// much, or leaves what it has too much to the one that lacks most: a strip of the smallest block that
    /// is larger and not yet split.
    ///
    /// # Errors
    /// [`ErrorKind::Table`] for a wrong number of labels, a label that is no kind, or labels so far from the
    /// shares that no block is large enough.
    pub fn new(map: &Map, shares: Shares, labels: Vec<u8>) -> Result<Self, Error> {
        let refused = |value, allowed| Err(Error::new(ErrorKind::Table, "mix", value, allowed));
        let (n, kinds) = (map.intervals(), shares.kinds());
        if labels.len() != n * n {
            let allowed = format!("{} labels, the number of blocks", n * n);
            return refused(format!("{} labels", labels.len()), allowed);
        }
        if let Some(block) = labels.iter().position(|&kind| usize::from(kind) >= kinds) {
            let value = format!("label {} in block {block}", labels[block]);
            return refused(value, format!("labels from 0 to {}", kinds - 1));
        }
        let splits = splits(map, &shares, &labels)?;
        Ok(Self {
            shares,
            labels,
            splits,
            part: OfKinds::get()?,
        })
    }

    pub(crate) const fn part(&self) -> OfKinds {
        self.part
    }

    /// A mix whose kinds are no more even than random ones: labels in a hashed order of the blocks. The forge makes
    /// even ones.
    ///
    /// # Errors
    /// [`ErrorKind::Table`] if the map has too few blocks for the shares.
    pub fn scattered(map: &Map, shares: Shares) -> Result<Self, Error> {
        let n = map.intervals();
        let targets = targets(map, &shares);
        let mut labels = vec![0; n * n];
        let (mut kind, mut below, mut end) = (0, 0, targets[0]);
        for block in scattered(n * n) {
            let area = area(map, block as usize);
            // A block is of the kind in which its middle lies.
            while kind + 1 < targets.len() && below + area / 2 >= end {
                kind += 1;
                end += targets[kind];
            }
            labels[block as usize] = kind as u8;
            below += area;
        }
        Self::new(map, shares, labels)
    }

    /// The shares of the kinds.
    #[must_use]
    pub const fn shares(&self) -> &Shares {
        &self.shares
    }

    /// The kind of each block, row by row. Of a [split](Self::splits) block, the kind of its first points.
    #[must_use]
    pub fn labels(&self) -> &[u8] {
        &self.labels
    }

    /// The blocks with points of two kinds: different blocks, fewer than there are kinds.
    #[must_use]
    pub fn splits(&self) -> &[Split] {
        &self.splits
    }

    /// About the memory that the mix holds, in bytes, with those of `turned` copies.
    pub(super) fn memory_bytes(&self, turned: usize) -> usize {
        (1 + turned) * (self.labels.len() + 16 * self.splits.len() + 128)
    }
}

/// The length of an interval of a map.
fn length(map: &Map, interval: usize) -> u64 {
    let interval = map.interval(interval);
    interval.end - interval.start
}

/// The area of a block.
fn area(map: &Map, block: usize) -> u128 {
    let n = map.intervals();
    u128::from(length(map, block % n)) * u128::from(length(map, block / n))
}

/// The area that each kind is to have, rounded down.
fn targets(map: &Map, shares: &Shares) -> Vec<u128> {
    // The set region has less than 2¹²⁶ units.
    let side = u128::from(map.alpha().set_side());
    let (all, total) = (side * side, u128::from(shares.total()));
    let target = |&part: &u16| {
        let part = u128::from(part);
        all / total * part + all % total * part / total
    };
    shares.parts().iter().map(target).collect()
}

/// The splits that make shares exact.
fn splits(map: &Map, shares: &Shares, labels: &[u8]) -> Result<Vec<Split>, Error> {
    let n = map.intervals();
    // By kind, the area of its blocks beyond its target.
    let targets = targets(map, shares);
    let mut excess: Vec<i128> = targets.iter().map(|&target| -(target as i128)).collect();
    for (block, &kind) in labels.iter().enumerate() {
        excess[usize::from(kind)] += area(map, block) as i128;
    }
    let mut splits: Vec<Split> = Vec::new();
    for own in 0..shares.kinds() - 1 {
        let later = own + 1..shares.kinds();
        // The first of equal ones.
        let other = if excess[own] > 0 {
            later.min_by_key(|&kind| excess[kind])
        } else {
            later.rev().max_by_key(|&kind| excess[kind])
        };
        let Some(other) = other else { continue };
        let (giver, taker) = if excess[own] > 0 {
            (own, other)
        } else {
            (other, own)
        };
        let amount = excess[own].unsigned_abs();
        let width = |block: usize| {
            let height = u128::from(length(map, block / n));
            (amount + height / 2) / height
        };
        let is_enough = |&block: &usize| {
            usize::from(labels[block]) == giver
                && width(block) < u128::from(length(map, block % n))
                && splits.iter().all(|split| split.block as usize != block)
        };
        let smallest = (0..n * n)
            .filter(is_enough)
            .min_by_key(|&block| area(map, block));
        let Some(block) = smallest else {
            let side = map.alpha().set_side() as f64;
            let share = amount as f64 / (side * side);
            let value = format!("labels of whose kind {own} is off its share by {share:.2e}");
            let allowed = "labels whose shares are right to less than a block";
            return Err(Error::new(ErrorKind::Table, "mix", value, allowed));
        };
        let width = width(block);
        if width > 0 {
            splits.push(Split {
                block: block as u32,
                offset: length(map, block % n) - width as u64,
                kind: taker as u8,
            });
            let moved = (width * u128::from(length(map, block / n))) as i128;
            excess[giver] -= moved;
            excess[taker] += moved;
        }
    }
    Ok(splits)
}

/// The kinds of the points of a table, turned or not.
#[derive(Clone, Debug)]
pub(crate) struct Labels {
    labels: Vec<u8>,
    splits: Vec<Strip>,
    _part: OfKinds,
}

/// A split block: its intervals of dX and dY, and the index dX from which on points are of another kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Strip {
    pub(crate) block: [u32; 2],
    pub(crate) start: u64,
    /// The kinds before and from the start.
    pub(crate) kinds: [u8; 2],
}

impl Labels {
    /// The kinds of a mix of a table whose block at each place is block `source(place)` of the mix.
    pub(super) fn new(map: &Map, mix: &Mix, source: impl Fn(usize) -> usize) -> Self {
        let n = map.intervals();
        let mut places = vec![0; n * n];
        let labels = (0..n * n).map(|place| {
            places[source(place)] = place;
            mix.labels[source(place)]
        });
        let labels: Vec<u8> = labels.collect();
        let splits = mix.splits.iter().map(|split| {
            let block = split.block as usize;
            let (x, y) = (places[block] % n, places[block] / n);
            let (from, to) = (length(map, block % n), length(map, x));
            // The same part of the interval, which is another one if the axes are swapped.
            let offset = u128::from(split.offset) * u128::from(to) / u128::from(from);
            Strip {
                block: [x as u32, y as u32],
                start: map.interval(x).start + offset as u64,
                kinds: [mix.labels[block], split.kind],
            }
        });
        let splits = splits.collect();
        Self {
            labels,
            splits,
            _part: mix.part,
        }
    }

    /// The kinds of all blocks, row by row. Of a split block, the kind of its first points.
    pub(crate) fn all(&self) -> &[u8] {
        &self.labels
    }

    /// The blocks with points of two kinds.
    pub(crate) fn splits(&self) -> &[Strip] {
        &self.splits
    }

    /// The kind of the points of a block at an index dX.
    pub(crate) fn kind(&self, n: usize, [x, y]: [usize; 2], index: u64) -> u8 {
        let is_here = |strip: &&Strip| strip.block == [x as u32, y as u32] && strip.start <= index;
        match self.splits.iter().find(is_here) {
            Some(strip) => strip.kinds[1],
            None => self.labels[y * n + x],
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;
    use crate::table::Symmetry;

    fn map(radius: u32) -> Map {
        Map::new("(5-sqrt(3))/2".parse().expect("valid"), radius).expect("small")
    }

    /// The areas of the kinds of turned labels.
    fn areas(map: &Map, labels: &Labels, kinds: usize) -> Vec<u128> {
        let n = map.intervals();
        let mut areas = vec![0; kinds];
        for (block, &kind) in labels.labels.iter().enumerate() {
            let (width, height) = (length(map, block % n), length(map, block / n));
            areas[usize::from(kind)] += u128::from(width) * u128::from(height);
        }
        for strip in &labels.splits {
            let [x, y] = strip.block.map(|v| v as usize);
            assert!(map.interval(x).contains(&strip.start));
            let width = map.interval(x).end - strip.start;
            let area = u128::from(width) * u128::from(length(map, y));
            areas[usize::from(strip.kinds[0])] -= area;
            areas[usize::from(strip.kinds[1])] += area;
        }
        areas
    }

    #[test]
    fn shares_are_exact_whichever_way_the_table_is_turned() {
        for text in [
            "1:1",
            "1:3",
            "1:3:10",
            "1:1:1:1",
            "1:31",
            "1:2:3:4:5",
            "7:8:9:1000",
        ] {
            for radius in [15, 49] {
                let (map, shares) = (map(radius), text.parse::<Shares>().expect("valid"));
                let n = map.intervals();
                let mix = Mix::scattered(&map, shares.clone()).expect("near");
                assert!(mix.splits().len() < shares.kinds());
                for (i, split) in mix.splits().iter().enumerate() {
                    let mut others = mix.splits()[..i].iter();
                    assert!(others.all(|other| other.block != split.block));
                }
                for number in 0..8 {
                    let source = |block| Symmetry::<2>::numbered(number).source(n, block);
                    let turned = Labels::new(&map, &mix, source);
                    let side = map.alpha().set_side() as f64;
                    let areas = areas(&map, &turned, shares.kinds());
                    for (kind, area) in (0..).zip(areas) {
                        let error = area as f64 / (side * side) - shares.of(kind);
                        assert!(error.abs() < 1.0 / (1u64 << 50) as f64, "{text}: {error:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn labels_that_are_far_off_are_refused() {
        let (map, shares) = (map(15), "1:3".parse::<Shares>().expect("valid"));
        let good = Mix::scattered(&map, shares.clone()).expect("near").labels;
        let mix = |labels| Mix::new(&map, shares.clone(), labels).map_err(|e| e.to_string());
        assert!(mix(good.clone()).is_ok());
        let says = |labels, text: &str| {
            let error = mix(labels).expect_err(text);
            assert!(error.contains(text), "{error}");
        };
        says(
            good[1..].to_vec(),
            "mix is 440 labels; it must be 441 labels",
        );
        says(vec![1; 441], "kind 0 is off its share by 2.50e-1");
        says(
            vec![2; 441],
            "label 2 in block 0; it must be labels from 0 to 1",
        );
    }
}
