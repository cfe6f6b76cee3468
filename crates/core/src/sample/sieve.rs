//! Sieves: which points of a plan's box are asked for, where not all of them are.
//!
//! Row by row the area is asked once, for the strip that the row's points may lie in. What it says
//! becomes runs of lattice columns: those whose points are all inside, which are copied or counted
//! at full speed, and those to be asked one by one, in exact terms.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Area, Frame, Listed, Region, Sampler, Stop,
    area::{Near, State, Stepper},
    before::Before,
    blocks::{list_columns, locate},
    clear::{ClearOf, Guard},
    fixed,
    patch::{BAND_WIDTH, PATCH_HEIGHT, Patch},
    plan::Span,
};
use crate::{pattern::Axis, table::FRACTION_BITS};

/// What every point of a plan must satisfy.
#[derive(Clone, Debug)]
pub(super) struct Sieve {
    /// Where points may lie, if not in all of the plan's box.
    area: Option<Area>,
    /// What they keep clear of.
    clear: Arc<[ClearOf]>,
    /// How far a point may lie from its lattice address, in lattice units, by axis.
    reach: [[f64; 2]; 2],
    /// World units per lattice unit.
    unit: f64,
}

/// A sieve for a piece of the lattice, with less to look at. It keeps memory, so each thread has its
/// own.
#[derive(Clone, Debug)]
pub(super) struct Focus {
    area: Option<Area>,
    guards: Vec<Guard>,
    reach: [[f64; 2]; 2],
    unit: f64,
    /// Lattice units per world unit.
    per_unit: f64,
    stepper: Stepper,
}

/// Neighboring columns of a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) columns: Range<i64>,
    /// Whether all of their points pass; otherwise each is to be asked.
    pub(super) passes: bool,
    /// What they have to be compared with, if not with all of the area.
    near: Option<Near>,
}

impl Sieve {
    /// A sieve, unless everything passes.
    pub(super) fn new(
        sampler: &Sampler,
        frame: &Frame,
        area: Option<Area>,
        clear: Arc<[ClearOf]>,
    ) -> Option<Self> {
        if area.is_none() && clear.is_empty() {
            return None;
        }
        let lattice = |v: i32| f64::from(v) / f64::from(1u32 << FRACTION_BITS);
        let reach = [Axis::X, Axis::Y].map(|axis| sampler.reach(frame, axis).map(lattice));
        Some(Self {
            area,
            clear,
            reach,
            unit: frame.step * f64::from(1u32 << FRACTION_BITS),
        })
    }

    /// The sieve to be aimed at one piece after another.
    pub(super) fn focus(&self) -> Focus {
        Focus {
            area: None,
            guards: self.clear.iter().map(ClearOf::guard).collect(),
            reach: self.reach,
            unit: self.unit,
            per_unit: 1.0 / self.unit,
            stepper: Stepper::default(),
        }
    }

    /// Where points may lie, if not everywhere.
    pub(super) const fn area(&self) -> Option<&Area> {
        self.area.as_ref()
    }
}

impl Focus {
    /// From now on only points of these rows and columns are asked for, and `area` says where they
    /// may lie.
    pub(super) fn aim(&mut self, area: Option<&Area>, rows: &Range<i64>, columns: &Range<i64>) {
        let [x, y] = [self.strip(Axis::X, columns), self.strip(Axis::Y, rows)];
        let within = Region::between([x[0], y[0]], [x[1], y[1]]);
        self.area = area.map(|area| area.focus(&within));
    }

    /// Where points may lie, as far as it matters here.
    pub(super) const fn area(&self) -> Option<&Area> {
        self.area.as_ref()
    }

    /// Where the points of some rows or columns may lie along the axis, and a little more.
    fn strip(&self, axis: Axis, range: &Range<i64>) -> [f64; 2] {
        let [least, most] = self.reach[axis as usize];
        let (start, end) = (range.start as f64 + least, (range.end - 1) as f64 + most);
        [
            (start - room(start)) * self.unit,
            (end + room(end)) * self.unit,
        ]
    }

    /// Whether a point of a run passes: one of the last that were asked for.
    #[inline]
    pub(super) fn passes(&self, run: &Run, p: [f64; 2]) -> bool {
        let inside = match (run.near, &self.area) {
            (Some(near), _) => self.stepper.contains(near, p),
            (None, Some(area)) => area.contains(p),
            (None, None) => true,
        };
        inside && self.guards.iter().all(|guard| guard.leaves(p))
    }

    /// Those columns of some rows whose points may pass in any of the rows; those of a run that
    /// passes do in all of them.
    pub(super) fn runs(&mut self, rows: Range<i64>, columns: &Range<i64>, runs: &mut Vec<Run>) {
        runs.clear();
        let strip = self.strip(Axis::Y, &rows);
        match &self.area {
            Some(area) => area.steps(strip, &mut self.stepper),
            None => self.stepper.steps.restart(State::In),
        }
        let is_guarded = !self.guards.is_empty();
        let mut push = |run: Range<i64>, passes: bool, near: Option<Near>| {
            let passes = passes && !is_guarded;
            match runs.last_mut() {
                _ if run.is_empty() => {}
                Some(last) if last.passes == passes && last.columns.end == run.start => {
                    last.columns.end = run.end;
                    last.near = None;
                }
                _ => runs.push(Run {
                    columns: run,
                    passes,
                    near,
                }),
            }
        };
        let mut next = columns.start;
        // What points have to be compared with since the last sure stretch that has columns.
        let (mut near, mut unsure) = (None, 0);
        for (from, to, state, compared) in self.stepper.steps.stretches() {
            if state == State::Test {
                unsure += 1;
                near = compared.filter(|_| unsure == 1);
                continue;
            }
            let start = self.first_beyond(from).clamp(next, columns.end);
            let end = self.last_before(to).clamp(start, columns.end);
            if start == end {
                continue;
            }
            push(next..start, false, near);
            if state == State::In {
                push(start..end, true, None);
            }
            next = end;
            (near, unsure) = (None, 0);
        }
        push(next..columns.end, false, near);
    }

    /// The first column whose points all lie above a world x, wherever they are moved.
    fn first_beyond(&self, x: f64) -> i64 {
        let x = x * self.per_unit;
        at_or_above(x - self.reach[0][0] + room(x))
    }

    /// The end of the columns whose points all lie below a world x.
    fn last_before(&self, x: f64) -> i64 {
        let x = x * self.per_unit;
        at_or_above(x - self.reach[0][1] - room(x))
    }
}

/// The first whole number at or above. (Casts saturate.)
fn at_or_above(x: f64) -> i64 {
    let whole = x as i64;
    whole.saturating_add(i64::from((whole as f64) < x))
}

/// Lattice rows for which an area is asked at once: more rows leave more points to be asked one by
/// one, fewer cost more questions.
pub(super) const TOGETHER: i64 = 8;

/// Lattice units that a boundary is given as room for rounding: sums, quotients and conversions are
/// off by a few units in the last place. (Not without end: what is asked for stays outermost, ±∞
/// included.)
fn room(x: f64) -> f64 {
    1.0 / 256.0 + (2e-15 * x.abs()).min(1e300)
}

/// How many points of a stretch of the lattice pass. Whole strips of rows are asked first; what is
/// inside them all is counted in closed form. Once it is stopped the number means nothing.
pub(super) fn count(
    sampler: &Sampler,
    frame: &Frame,
    sieve: &Sieve,
    [x, y]: [&Span; 2],
    stop: &Stop,
) -> u128 {
    let (columns, rows) = (&x.all, &y.all);
    if columns.is_empty() {
        return 0;
    }
    let mut count = 0;
    let mut strip = sieve.focus();
    let mut piece = Piece {
        sampler,
        frame,
        stop,
        focus: sieve.focus(),
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
                count += frame.pattern.count(run.columns.clone(), rows.clone());
                continue;
            }
            let mut from = run.columns.start;
            // A run along an edge spans thousands of bands.
            while from < run.columns.end && !stop.is_raised() {
                let band = from.div_euclid(BAND_WIDTH);
                let to = run.columns.end.min((band + 1) * BAND_WIDTH);
                let patch = Patch::new(frame, band, rows.start, x, y);
                count += piece.count(strip.area(), band, &patch, rows.clone(), from..to);
                from = to;
            }
        }
    }
    count
}

/// Counts a piece of a patch row by row.
struct Piece<'a> {
    sampler: &'a Sampler,
    frame: &'a Frame,
    stop: &'a Stop,
    focus: Focus,
    /// By number, the lowest bits of it.
    bands: Vec<Band>,
    runs: Vec<Run>,
}

/// Columns of so many bands are kept: an outline comes back to a band from strip to strip.
const BANDS: usize = 16;

/// The columns of a band.
#[derive(Clone, Default)]
struct Band {
    number: Option<i64>,
    columns: [Listed; 4],
    before: Before,
}

impl Piece<'_> {
    fn count(
        &mut self,
        area: Option<&Area>,
        band: i64,
        patch: &Patch,
        rows: Range<i64>,
        columns: Range<i64>,
    ) -> u128 {
        let (sampler, frame) = (self.sampler, self.frame);
        self.focus.aim(area, &rows, &columns);
        let kept = &mut self.bands[band.rem_euclid(BANDS as i64) as usize];
        if kept.number != Some(band) {
            let all = band * BAND_WIDTH..(band + 1) * BAND_WIDTH;
            list_columns(sampler, frame, all.clone(), &mut kept.columns);
            kept.before.note(&all, &kept.columns);
            kept.number = Some(band);
        }
        let world = World::new(frame, patch);
        let mut count = 0;
        let mut known = rows.start;
        for y in rows.clone() {
            // A row along an edge, or with other layers near, takes long.
            if self.stop.is_raised() {
                break;
            }
            let Some((class, block)) = locate(sampler, frame, y) else {
                continue;
            };
            if y >= known {
                known = rows.end.min(y + TOGETHER);
                self.focus.runs(y..known, &columns, &mut self.runs);
            }
            let (listed, vectors) = (&kept.columns[class.ordinal()], sampler.row(block));
            let row = patch.relative(Axis::Y, y);
            for run in &self.runs {
                let ends = [run.columns.start, run.columns.end];
                let [start, end] = ends.map(|v| kept.before.count(class, v));
                if run.passes {
                    count += end - start;
                    continue;
                }
                for &(x, block) in &listed[start..end] {
                    let [dx, dy] = vectors[block as usize];
                    let place = patch.place([patch.relative(Axis::X, x) + dx, row + dy]);
                    count += usize::from(self.focus.passes(run, world.place(place)));
                }
            }
        }
        count as u128
    }
}

/// Reported coordinates of places relative to a patch's origin, the same as [`Frame::world`] gives:
/// see [`F64`](super::F64).
#[derive(Clone, Copy)]
pub(super) struct World {
    base: [f64; 2],
    step: f64,
}

impl World {
    pub(super) fn new(frame: &Frame, patch: &Patch) -> Self {
        Self {
            base: patch.origin().map(|v| fixed(v) as f64),
            step: frame.step,
        }
    }

    #[inline(always)]
    pub(super) fn place(self, position: [i32; 2]) -> [f64; 2] {
        [0, 1].map(|i| (self.base[i] + f64::from(position[i])) * self.step)
    }
}
