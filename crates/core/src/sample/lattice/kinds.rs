//! One kind of the points of a mix.
//!
//! A kind has all points of a block, none, or those whose dX lies in a strip; so has a rank below
//! a share. What a set has of a block is therefore an interval of dX, and counts have closed forms.

use alloc::{sync::Arc, vec::Vec};
use core::ops::{Deref, Range};

use crate::{
    error::{Error, ErrorKind},
    map::Map,
    parts::OfKinds,
    table::{Labels, Mix},
};

/// The points of a pattern that are of one kind.
#[derive(Debug)]
pub(crate) struct OneKind {
    kind: u8,
    /// The share that the kind has of all points.
    share: f64,
    /// The part of each block that is of the kind, row by row: [`NONE`], [`WHOLE`], or [`STRIP`] and more for the
    /// strip of that number.
    states: Vec<u8>,
    strips: Vec<Strip>,
}

/// The one kind that a lattice has the points of.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    kind: Arc<OneKind>,
    _part: OfKinds,
}

impl Deref for Chosen {
    type Target = OneKind;

    fn deref(&self) -> &OneKind {
        &self.kind
    }
}

/// The part of a block's interval of dX that is of the kind.
#[derive(Debug)]
struct Strip {
    block: [u32; 2],
    interval: Range<u64>,
}

const NONE: u8 = 0;
const WHOLE: u8 = 1;
const STRIP: u8 = 2;

impl OneKind {
    /// The points of a kind of a mix, by the labels of its blocks, turned or not.
    pub(crate) fn chosen(map: &Map, mix: &Mix, labels: &Labels, kind: u8) -> Chosen {
        let n = map.intervals();
        let state = |&label: &u8| if label == kind { WHOLE } else { NONE };
        let mut states: Vec<u8> = labels.all().iter().map(state).collect();
        let mut strips = Vec::new();
        for split in labels.splits() {
            let [x, y] = split.block.map(|v| v as usize);
            let all = map.interval(x);
            let interval = if split.kinds[0] == kind {
                all.start..split.start
            } else if split.kinds[1] == kind {
                split.start..all.end
            } else {
                continue;
            };
            states[y * n + x] = STRIP + strips.len() as u8;
            strips.push(Strip {
                block: split.block,
                interval,
            });
        }
        let of_kind = Self {
            kind,
            share: mix.shares().of(kind),
            states,
            strips,
        };
        Chosen {
            kind: Arc::new(of_kind),
            _part: mix.part(),
        }
    }

    pub(crate) const fn kind(&self) -> u8 {
        self.kind
    }

    pub(crate) const fn share(&self) -> f64 {
        self.share
    }

    /// The strips that have a column of some interval of dX at an index, as the bits from 1 on.
    #[inline]
    pub(crate) fn strips_at(&self, block_x: usize, index: u64) -> u32 {
        let mut bits = 0;
        for (i, strip) in self.strips.iter().enumerate() {
            let is_here = strip.block[0] as usize == block_x && strip.interval.contains(&index);
            bits |= u32::from(is_here) << (i + 1);
        }
        bits
    }

    /// The parts of the blocks of a row that are of the kind.
    #[inline]
    pub(crate) fn in_row(&self, n: usize, block_y: usize) -> KindRow<'_> {
        KindRow(&self.states[block_y * n..][..n])
    }

    /// The blocks that are partly of the kind, and the interval of dX that is.
    pub(crate) fn parts(&self) -> impl Iterator<Item = ([usize; 2], &Range<u64>)> {
        let strips = self.strips.iter();
        strips.map(|strip| (strip.block.map(|v| v as usize), &strip.interval))
    }
}

/// Refuses a kind that is not one of the first `kinds`.
pub(crate) fn check_kind(kind: u8, kinds: usize) -> Result<(), Error> {
    if usize::from(kind) < kinds {
        return Ok(());
    }
    let allowed = match kinds {
        0 => "left out: the table has no kinds of points".into(),
        _ => alloc::format!("from 0 to {}", kinds - 1),
    };
    Err(Error::new(ErrorKind::Kinds, "only", kind, allowed))
}

/// The parts of the blocks of a row that are of a kind.
#[derive(Clone, Copy)]
pub(crate) struct KindRow<'a>(&'a [u8]);

impl KindRow<'_> {
    /// Whether a column has points of the kind in these rows, by its block and the [strips](OneKind::strips_at)
    /// that it is in.
    #[inline(always)]
    pub(crate) fn keeps(&self, block_x: usize, strips: u32) -> bool {
        match self.0[block_x] {
            NONE => false,
            WHOLE => true,
            strip => strips >> (strip - STRIP + 1) & 1 != 0,
        }
    }
}
