//! Sieves: which points of a plan's box are requested, where not all of them are.
//!
//! The work narrows in five stages, each of which leaves less to the next:
//!
//! 1. [`Sieve`] has the conditions on all points of a plan: an area, and other sets to keep clear
//!    of.
//! 2. [`LocalSieve`] is aimed at a band and then at a patch: `Area::focus` drops every shape and
//!    edge that does not matter there.
//! 3. For a strip of a few rows, `Area::steps` returns the stretches of x that are inside, outside, or to
//!    be tested.
//! 4. [`LocalSieve::runs`] turns stretches into [`Run`]s of lattice columns. Runs that pass are copied or
//!    counted at full speed.
//! 5. In other runs [`LocalSieve::passes`] tests each point, against the few edges that touch its stretch
//!    where these are known (`shape::Near`).
//!
//! # The problem
//!
//! A request for a polygon of 10⁵ edges and 10⁸ points must not compare every point with every edge. Nearly all points
//! lie clearly inside or outside. So the sieve answers for whole ranges of columns at once, and compares single points
//! only where an edge is near, with the edges that are near.
//!
//! # From stretches to runs
//!
//! For a strip of [`STRIP_ROWS`] rows, `Area::steps` cuts the line of world x into stretches in which all
//! points of the strip are inside, or all outside, or some of each. [`LocalSieve::runs`] turns these into ranges of
//! lattice columns. A point is not at its address but between `reach[0]` and `reach[1]` from it, by its displacement
//! and the warp, and coordinates are rounded. So a column is sure only if the whole reach of its points lies in the
//! stretch. The others, on both sides of each step, are tested:
//!
//! ```text
//!     stretches   ── Out ───┬───────── In ─────────┬─ Test ─┬──── Out ────
//!     columns     · · · · ? ? ? + + + + + + + + ? ? ? ? ? ? ? ? · · · · ·
//!     runs                └─1─┘ └──────2──────┘ └──────3──────┘
//! ```
//!
//! Run 2 passes: its points are copied or counted in closed form. Points of runs 1 and 3 are tested one by one, and
//! columns in no run (·) are never looked at.
//!
//! # Few edges for each test
//!
//! A polygon notes, with each stretch to be tested, the edges that reach into it and whether points right of them are
//! inside (`Near`). A ray to the right then crosses only these. This holds beyond the stretch as well, up to the next
//! one with edges of its own. So a run of points to be tested carries its `Near` if it holds one such stretch alone; if
//! there are several, or a sure stretch between them is too narrow to have a sure column, points are compared with the
//! whole area, as far as [`LocalSieve::aim`] has left it.
//!
//! # Invariants
//!
//! - Runs ascend and do not overlap, and no two that touch are of the same sort.
//! - A point in no run is outside, and one in a run that passes is inside, in every row of the strip. So walking
//!   with runs and testing every point find the same set. The width of the room for rounding changes the cost alone.
//! - Other sets to keep clear of, and kinds that vary from place to place, decide by the single point: with them
//!   no run passes. Points that are left out by their ids are runs of their own.
//!
//! The cost of a strip is that of its stretches, shared by 8 rows, and in each row one test for every column within the
//! reach of an edge: in proportion to the outline, not to the area.
//!
//! The sieve of a whole plan.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::missing::Missing;
use crate::{
    batch::Batch,
    lattice::{Found, Lattice, PointId, Scale},
    near::{Guard, Mask},
    pattern::Axis,
    shape::{Area, Near, Region, State, Stepper},
    table::FRACTION_BITS,
};

/// A sieve aimed at a piece of the lattice. It keeps memory, so each thread has its own.
#[derive(Clone, Debug)]
pub(crate) struct LocalSieve {
    area: Option<Area>,
    guard: Guard,
    /// The set, if its points are left out by their kind one by one.
    picked: Option<Arc<Lattice>>,
    /// The points that are left out by their ids.
    missing: Missing,
    /// The least and the greatest distance of a point from its lattice address, in lattice units, by
    /// axis.
    reach: [[f64; 2]; 2],
    /// World units per lattice unit.
    unit: f64,
    /// Lattice units per world unit.
    per_unit: f64,
    stepper: Stepper,
}

/// A range of neighboring columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) columns: Range<i64>,
    /// Whether all of their points pass; otherwise each must be tested.
    pub(crate) passes: bool,
    /// The edges to compare them with, if not with the whole area.
    near: Option<Near>,
}

impl LocalSieve {
    pub(crate) fn new(
        (guard, picked, missing): (Guard, Option<Arc<Lattice>>, Missing),
        reach: [[f64; 2]; 2],
        unit: f64,
    ) -> Self {
        Self {
            area: None,
            guard,
            picked,
            missing,
            reach,
            unit,
            per_unit: 1.0 / unit,
            stepper: Stepper::default(),
        }
    }

    /// Uses other distances of points from their lattice addresses, by axis, in fixed-point units.
    pub(crate) fn set_reach(&mut self, reach: [[i32; 2]; 2]) {
        let unit = f64::from(1u32 << FRACTION_BITS);
        self.reach = reach.map(|reach| reach.map(|v| f64::from(v) / unit));
    }

    /// Narrows the sieve to the points of some rows and columns that lie in `area`.
    pub(crate) fn aim(&mut self, area: Option<&Area>, rows: &Range<i64>, columns: &Range<i64>) {
        let within = self.world([columns, rows]);
        self.area = area.map(|area| area.focus(&within));
    }

    /// The area, reduced to what matters here.
    pub(crate) const fn area(&self) -> Option<&Area> {
        self.area.as_ref()
    }

    /// The box of the points of some columns and rows, with room for rounding.
    pub(crate) fn world(&self, [columns, rows]: [&Range<i64>; 2]) -> Region {
        let [x, y] = [self.strip(Axis::X, columns), self.strip(Axis::Y, rows)];
        Region::between([x[0], y[0]], [x[1], y[1]])
    }

    /// The range of world coordinates of the points of some rows or columns, with room for rounding.
    fn strip(&self, axis: Axis, range: &Range<i64>) -> [f64; 2] {
        let [least, most] = self.reach[axis as usize];
        let (start, end) = (range.start as f64 + least, (range.end - 1) as f64 + most);
        [
            (start - room(start)) * self.unit,
            (end + room(end)) * self.unit,
        ]
    }

    /// Whether a point of one of the last [`runs`](Self::runs) passes.
    #[inline]
    pub(crate) fn passes(&self, run: &Run, id: PointId, p: [f64; 2]) -> bool {
        let inside = match (run.near, &self.area) {
            (Some(near), _) => self.stepper.contains(near, p),
            (None, Some(area)) => area.contains(p),
            (None, None) => true,
        };
        inside && self.is_picked(id) && self.guard.is_clear(p)
    }

    /// Whether a point is of the kind that is wanted, and not left out by its id.
    #[inline]
    fn is_picked(&self, id: PointId) -> bool {
        self.picked.as_ref().is_none_or(|set| set.has_kind(id)) && !self.missing.has(id)
    }

    /// Whether a place is far enough from all points of other sets.
    pub(super) fn is_clear(&self, p: [f64; 2]) -> bool {
        self.guard.is_clear(p)
    }

    /// Whether a point of the piece passes.
    pub(crate) fn permits(&self, id: PointId, p: [f64; 2]) -> bool {
        self.area.as_ref().is_none_or(|area| area.contains(p))
            && self.is_picked(id)
            && self.guard.is_clear(p)
    }

    /// Keeps the points of a patch that pass, by the scale of the patch.
    pub(crate) fn retain(&self, scale: Scale, found: &mut Batch<2, i32>) {
        let [left, bottom] = found.origin;
        let passes = |found: Found| {
            let [x, y] = found.address();
            let id = PointId {
                x: left + x,
                y: bottom + y,
            };
            self.permits(id, scale.world(found.place))
        };
        let kept: Vec<bool> = found.points(0..found.len()).map(passes).collect();
        let mut kept = kept.into_iter();
        found.retain(|_| kept.next() == Some(true));
    }

    /// The columns whose points may pass in any of some rows. The points of a run that passes do so in
    /// all of the rows.
    pub(crate) fn runs(&mut self, rows: Range<i64>, columns: &Range<i64>, runs: &mut Vec<Run>) {
        runs.clear();
        let strip = self.strip(Axis::Y, &rows);
        match &self.area {
            Some(area) => area.steps(strip, &mut self.stepper),
            None => self.stepper.steps.restart(State::In),
        }
        let is_guarded = !self.guard.is_empty() || self.picked.is_some();
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
        // The edges to compare with, if only one stretch is unsure since the last sure one with columns.
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
        if !self.missing.is_empty() {
            let missing = self.missing.columns(columns.start, &rows);
            missing.into_iter().for_each(|x| cut(runs, x));
        }
    }

    /// The first column whose points all lie above a world x, however they are displaced.
    fn first_beyond(&self, x: f64) -> i64 {
        let x = x * self.per_unit;
        at_or_above(x - self.reach[0][0] + room(x))
    }

    /// The end of the columns whose points all lie below a world x, however they are displaced.
    fn last_before(&self, x: f64) -> i64 {
        let x = x * self.per_unit;
        at_or_above(x - self.reach[0][1] - room(x))
    }
}

/// Makes a column a run of its own, whose points are tested.
fn cut(runs: &mut Vec<Run>, x: i64) {
    let holds = |run: &Run| run.passes && run.columns.contains(&x);
    let Some(place) = runs.iter().position(holds) else {
        return;
    };
    let Range { start, end } = runs[place].columns;
    let parts = [(start..x, true), (x..x + 1, false), (x + 1..end, true)];
    let parts = parts.into_iter().filter(|(columns, _)| !columns.is_empty());
    let parts = parts.map(|(columns, passes)| Run {
        columns,
        passes,
        near: None,
    });
    runs.splice(place..=place, parts);
}

/// The first integer at or above `x`. Casts saturate.
fn at_or_above(x: f64) -> i64 {
    let whole = x as i64;
    whole.saturating_add(i64::from((whole as f64) < x))
}

/// The height of a strip in lattice rows. Higher strips leave more points to be tested one by one, lower
/// ones cost more calls of `Area::steps`.
pub(crate) const STRIP_ROWS: i64 = 8;

/// The room for rounding at a boundary, in lattice units: sums, quotients and conversions err by a few
/// units in the last place. It is bounded so that ±∞ stays outermost.
fn room(x: f64) -> f64 {
    1.0 / 256.0 + (2e-15 * x.abs()).min(1e300)
}

/// The conditions on every point of a plan.
#[derive(Clone, Debug)]
pub(crate) struct Sieve {
    /// Its area is `None` where all of the plan's box is requested.
    mask: Mask,
    /// The box around the points.
    region: Region,
    /// The set, if its points are left out by their kind one by one.
    picked: Option<Arc<Lattice>>,
    /// The points that are left out by their ids, and whether all others of the box are there.
    pub(super) missing: Missing,
    pub(super) is_box: bool,
    /// The least and the greatest distance of a point from its lattice address, in lattice units, by
    /// axis.
    reach: [[f64; 2]; 2],
    /// World units per lattice unit.
    unit: f64,
}

impl Sieve {
    /// A sieve. `reach` has the least and the greatest distance of a point from its lattice address by axis, in
    /// fixed-point units.
    pub(crate) fn new(
        lattice: &Lattice,
        (mask, region): (Mask, Region),
        reach: [[i32; 2]; 2],
    ) -> Self {
        let grid_units = |v: i32| f64::from(v) / f64::from(1u32 << FRACTION_BITS);
        Self {
            mask,
            region,
            picked: lattice.picks().then(|| Arc::new(lattice.clone())),
            missing: Missing::default(),
            is_box: false,
            reach: reach.map(|reach| reach.map(grid_units)),
            unit: lattice.step * f64::from(1u32 << FRACTION_BITS),
        }
    }

    /// A sieve to be aimed at one piece of the lattice after another.
    pub(crate) fn local(&self) -> LocalSieve {
        self.local_without(self.missing.clone())
    }

    /// As [`local`](Self::local), with the points that are left out by their ids.
    pub(crate) fn local_of_all(&self) -> LocalSieve {
        self.local_without(Missing::default())
    }

    fn local_without(&self, missing: Missing) -> LocalSieve {
        let each = (self.guard(), self.picked.clone(), missing);
        LocalSieve::new(each, self.reach, self.unit)
    }

    /// This sieve of a scope whose box leaves out no other points than those of some ids.
    pub(super) fn of_box(self) -> Self {
        let is_box = true;
        Self { is_box, ..self }
    }

    /// This sieve, which leaves out some points by their ids, too.
    pub(super) fn without(self, missing: Missing) -> Self {
        Self { missing, ..self }
    }

    /// A test of the other sets alone.
    pub(crate) fn guard(&self) -> Guard {
        self.mask.guard(Some(&self.region))
    }

    /// Whether there are other sets to keep clear of.
    pub(crate) fn is_guarded(&self) -> bool {
        !self.mask.clear.is_empty()
    }

    /// The conditions on the places of points.
    pub(crate) const fn mask(&self) -> &Mask {
        &self.mask
    }

    /// The area in which points lie, if not in all of the box.
    pub(crate) fn area(&self) -> Option<&Area> {
        self.mask.area.as_deref()
    }
}
