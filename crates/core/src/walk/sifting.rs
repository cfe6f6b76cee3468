//! A walk through a sieve: bands in which an area has nothing are passed over, whatever their number.

use alloc::vec::Vec;
use core::ops::Range;

use super::sieve::{LocalSieve, Run, STRIP_ROWS, Sieve};
use crate::{lattice::PrefixCounts, shape::Area};

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

/// An area reduced to one band after another. Bands are halved down to the next one, so each of n bands costs the edges
/// around it, and each edge is looked at some log n times.
#[derive(Clone, Debug, Default)]
pub(super) struct Halves(Vec<(Range<i64>, Area)>);

impl Halves {
    /// The part of `whole` in the first band in which it has anything, to which `ahead` moves. `None` if there is no such
    /// band. `focus` reduces an area to some bands.
    pub(super) fn next(
        &mut self,
        whole: &Area,
        ahead: &mut Range<i64>,
        focus: impl Fn(&Area, &Range<i64>) -> Area,
    ) -> Option<&Area> {
        while !ahead.is_empty() {
            self.0.retain(|(bands, _)| bands.contains(&ahead.start));
            let (bands, area) = match self.0.last() {
                Some((bands, area)) => (bands.clone(), area),
                None => (ahead.clone(), whole),
            };
            if area.is_all_or_nothing() == Some(false) {
                ahead.start = bands.end;
                continue;
            }
            let half = match bands.end - bands.start {
                1 if !self.0.is_empty() => break,
                1 => bands,
                _ => {
                    let middle = bands.start.midpoint(bands.end);
                    match ahead.start < middle {
                        true => bands.start..middle,
                        false => middle..bands.end,
                    }
                }
            };
            let near = focus(area, &half);
            self.0.push((half, near));
        }
        self.0
            .last()
            .filter(|_| !ahead.is_empty())
            .map(|(_, area)| area)
    }
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;
    use crate::shape::Region;

    #[test]
    fn bands_without_a_part_of_the_area_are_passed_over() {
        let square = |x: f64| Area::from(Region::between([x + 0.2, 0.0], [x + 0.7, 1.0]));
        let both = Area::any_of([square(3.0), square(999_999.0)]);
        let (mut halves, mut ahead, looks) = (Halves::default(), 0..1_000_000, Cell::new(0));
        let focus = |area: &Area, bands: &Range<i64>| {
            looks.set(looks.get() + 1);
            area.focus(&Region::between(
                [bands.start as f64, 0.0],
                [bands.end as f64, 1.0],
            ))
        };
        let mut seen = Vec::new();
        while let Some(near) = halves.next(&both, &mut ahead, focus) {
            assert!(near.contains([ahead.start as f64 + 0.5, 0.5]));
            seen.extend(ahead.next());
        }
        assert_eq!(seen, [3, 999_999]);
        assert!(looks.get() < 100, "{}", looks.get());
    }
}
