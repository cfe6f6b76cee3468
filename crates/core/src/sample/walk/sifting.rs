//! A walk through a sieve.

use alloc::vec::Vec;
use core::ops::Range;

use crate::sample::{
    lattice::PrefixCounts,
    sieve::{LocalSieve, Run, STRIP_ROWS, Sieve},
};

/// The state of a walk through a sieve.
#[derive(Clone, Debug)]
pub(super) struct Sifting {
    /// The sieve for the band, and for the patch.
    pub(super) band: LocalSieve,
    pub(super) patch: LocalSieve,
    /// Whether the sieve leaves out points of the current patch.
    pub(super) is_cut: bool,
    /// The runs of the current row and those after it, up to `runs_end`.
    pub(super) runs: Vec<Run>,
    pub(super) runs_end: i64,
    pub(super) prefix: PrefixCounts,
}

impl Sifting {
    /// Before the first patch.
    pub(super) fn new(sieve: &Sieve) -> Self {
        Self {
            band: sieve.local(),
            patch: sieve.local(),
            is_cut: false,
            runs: Vec::new(),
            runs_end: i64::MIN,
            prefix: PrefixCounts::default(),
        }
    }

    /// Aims at a patch. Returns whether none of its points pass.
    pub(super) fn next_patch(&mut self, rows: &Range<i64>, columns: &Range<i64>) -> bool {
        self.patch.aim(self.band.area(), rows, columns);
        self.patch.runs(rows.clone(), columns, &mut self.runs);
        self.runs_end = rows.start;
        self.is_cut = match self.runs.as_slice() {
            [] => false,
            // Such a patch lies inside the plan's box as well, and is filled like one.
            [run] => !(run.passes && run.columns == *columns),
            _ => true,
        };
        self.runs.is_empty()
    }

    /// Makes sure that the runs of row `y` are known. Returns whether no point of its strip passes.
    pub(super) fn next_strip(&mut self, y: i64, end: i64, columns: &Range<i64>) -> bool {
        if y >= self.runs_end {
            self.runs_end = end.min(y + STRIP_ROWS);
            self.patch.runs(y..self.runs_end, columns, &mut self.runs);
        }
        self.runs.is_empty()
    }
}
