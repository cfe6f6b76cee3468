//! The number of points that pass a sieve: strips of rows first, whose passing runs are counted in closed
//! form, then the other runs point by point.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::tally::product;
use crate::{
    lattice::{
        BAND_WIDTH, Columns, Lattice, PATCH_HEIGHT, Patch, PointId, PrefixCounts, Scale, Span,
    },
    pattern::Axis,
    shape::Area,
    stop::Stop,
    walk::sieve::{LocalSieve, Run, STRIP_ROWS, Sieve},
};

/// The number of points that pass; meaningless once `stop` is raised.
pub(super) fn count(lattice: &Lattice, sieve: &Sieve, [x, y]: [&Span; 2], stop: &Stop) -> u128 {
    let (columns, rows) = (&x.all, &y.all);
    if columns.is_empty() {
        return 0;
    }
    let mut count = 0;
    let mut strip = sieve.local_of_all();
    let mut edges = Edges {
        lattice,
        spans: [x, y],
        stop,
        sieve: sieve.local_of_all(),
        bands: vec![Band::default(); BANDS],
        runs: Vec::new(),
    };
    let mut runs = Vec::new();
    let mut start = rows.start;
    while start < rows.end && !stop.is_raised() {
        let end = rows.end.min((start & !(PATCH_HEIGHT - 1)) + PATCH_HEIGHT);
        let rows = start..end;
        start = end;
        strip.aim(sieve.area(), &rows, columns);
        strip.runs(rows.clone(), columns, &mut runs);
        for run in runs.iter().filter(|run| run.passes) {
            count += product(lattice, &run.columns, &rows);
        }
        runs.retain(|run| !run.passes);
        if let [first, .., last] | [first @ last] = runs.as_slice() {
            let bands = bands_of(&(first.columns.start..last.columns.end));
            count += edges.count_bands(&strip, strip.area(), &runs, (bands, &rows));
        }
    }
    count
}

/// The bands of some columns.
const fn bands_of(columns: &Range<i64>) -> Range<i64> {
    columns.start.div_euclid(BAND_WIDTH)..(columns.end - 1).div_euclid(BAND_WIDTH) + 1
}

/// Counts pieces of patches through which an edge may run, row by row.
struct Edges<'a> {
    lattice: &'a Lattice,
    spans: [&'a Span; 2],
    stop: &'a Stop,
    sieve: LocalSieve,
    /// By the lowest bits of the band's number.
    bands: Vec<Band>,
    runs: Vec<Run>,
}

/// The number of bands whose columns are kept: an outline returns to a band strip after strip.
const BANDS: usize = 16;

/// The columns of a band.
#[derive(Clone, Default)]
struct Band {
    number: Option<i64>,
    columns: Columns,
    prefix: PrefixCounts,
}

impl Edges<'_> {
    /// The number of points in runs of some rows that must be tested, those in some bands. Bands are halved, and the
    /// area with them: many runs, or a run along an edge, can span thousands of bands.
    fn count_bands(
        &mut self,
        strip: &LocalSieve,
        area: Option<&Area>,
        runs: &[Run],
        (bands, rows): (Range<i64>, &Range<i64>),
    ) -> u128 {
        let all = bands.start * BAND_WIDTH..bands.end * BAND_WIDTH;
        let runs = &runs[runs.partition_point(|run| run.columns.end <= all.start)..];
        let runs = &runs[..runs.partition_point(|run| run.columns.start < all.end)];
        if runs.is_empty() || self.stop.is_raised() {
            return 0;
        }
        if bands.end - bands.start > 1 {
            let middle = bands.start.midpoint(bands.end);
            return [bands.start..middle, middle..bands.end]
                .map(|half| {
                    let columns = half.start * BAND_WIDTH..half.end * BAND_WIDTH;
                    let near = area.map(|area| area.focus(&strip.world([&columns, rows])));
                    self.count_bands(strip, near.as_ref(), runs, (half, rows))
                })
                .into_iter()
                .sum();
        }
        let [x, y] = self.spans;
        let patch = Patch::new(self.lattice, bands.start, rows.start, x, y);
        let in_band = |run: &Run| run.columns.start.max(all.start)..run.columns.end.min(all.end);
        let count = |run: &Run| self.count(area, bands.start, &patch, rows.clone(), in_band(run));
        runs.iter().map(count).sum()
    }

    fn count(
        &mut self,
        area: Option<&Area>,
        band: i64,
        patch: &Patch,
        rows: Range<i64>,
        columns: Range<i64>,
    ) -> u128 {
        let lattice = self.lattice;
        if patch.is_warped() {
            let piece = [columns.clone(), rows.clone()];
            let piece = Span::of_piece(lattice, self.spans, piece);
            self.sieve.set_reach(piece.map(|span| span.reach));
        }
        self.sieve.aim(area, &rows, &columns);
        let kept = &mut self.bands[band.rem_euclid(BANDS as i64) as usize];
        if kept.number != Some(band) {
            let all = band * BAND_WIDTH..(band + 1) * BAND_WIDTH;
            kept.columns.list(lattice, all.clone());
            kept.prefix.update(&all, &kept.columns);
            kept.number = Some(band);
        }
        let scale = Scale::new(lattice, patch);
        let mut count = 0;
        let mut known = rows.start;
        for y in rows.clone() {
            // A row along an edge, or one that keeps clear of other sets, takes long.
            if self.stop.is_raised() {
                break;
            }
            let Some((class, block)) = lattice.row(y) else {
                continue;
            };
            if y >= known {
                known = rows.end.min(y + STRIP_ROWS);
                self.sieve.runs(y..known, &columns, &mut self.runs);
            }
            let listed = kept.columns.of_row(lattice, class, block);
            let vectors = lattice.vectors(block);
            let row = patch.relative(Axis::Y, y);
            for run in &self.runs {
                let places = kept.prefix.places(lattice, class, listed, &run.columns);
                let Range { start, end } = places;
                if run.passes {
                    count += end - start;
                    continue;
                }
                for column in &listed[start..end] {
                    let [dx, dy] = vectors[column.block as usize];
                    let x = patch.relative(Axis::X, column.at) + dx;
                    let place = patch.place([x, row + dy]);
                    let id = PointId { x: column.at, y };
                    let passes =
                        patch.holds(place) && self.sieve.passes(run, id, scale.world(place));
                    count += usize::from(passes);
                }
            }
        }
        count as u128
    }
}
