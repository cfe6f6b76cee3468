//! The number of points that pass a sieve: strips of rows first, whose passing runs are counted in closed
//! form, then the other runs point by point.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::tally::product;
use crate::{
    pattern::Axis,
    sample::{
        area::Area,
        lattice::{BAND_WIDTH, Columns, Lattice, PATCH_HEIGHT, Patch, PointId, PrefixCounts, Span},
        sieve::{LocalSieve, Run, STRIP_ROWS, Scale, Sieve},
    },
    stop::Stop,
};

/// The number of points that pass; meaningless once `stop` is raised.
pub(super) fn count(lattice: &Lattice, sieve: &Sieve, [x, y]: [&Span; 2], stop: &Stop) -> u128 {
    let (columns, rows) = (&x.all, &y.all);
    if columns.is_empty() {
        return 0;
    }
    let mut count = 0;
    let mut strip = sieve.local();
    let mut edges = Edges {
        lattice,
        spans: [x, y],
        stop,
        sieve: sieve.local(),
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
        for run in &runs {
            if run.passes {
                count += product(lattice, &run.columns, &rows);
                continue;
            }
            let mut from = run.columns.start;
            // A run along an edge can span thousands of bands.
            while from < run.columns.end && !stop.is_raised() {
                let band = from.div_euclid(BAND_WIDTH);
                let to = run.columns.end.min((band + 1) * BAND_WIDTH);
                let patch = Patch::new(lattice, band, rows.start, x, y);
                count += edges.count(strip.area(), band, &patch, rows.clone(), from..to);
                from = to;
            }
        }
    }
    count
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
