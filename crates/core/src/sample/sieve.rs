//! Sieves: which points of a plan's box are asked for, where not all of them are.
//!
//! Row by row the area is asked once, for the strip that the row's points may lie in. What it says
//! becomes runs of lattice columns: those whose points are all inside, which are copied or counted
//! at full speed, and those to be asked one by one, in exact terms.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    Area, Frame, Sampler, Stop,
    area::{State, Steps},
    clear::{ClearOf, Guard},
    fixed,
    patch::PATCH_HEIGHT,
    warp::NearShears,
};
use crate::{
    pattern::{Axis, Class},
    table::FRACTION_BITS,
};

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

/// A sieve for some rows, with less to look at. It keeps memory, so each thread has its own.
#[derive(Clone, Debug)]
pub(super) struct Focus {
    area: Option<Area>,
    guards: Vec<Guard>,
    reach: [[f64; 2]; 2],
    unit: f64,
}

/// Neighboring columns of a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) columns: Range<i64>,
    /// Whether all of their points pass; otherwise each is to be asked.
    pub(super) passes: bool,
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

    /// The sieve of some rows.
    pub(super) fn focus(&self, rows: Range<i64>) -> Focus {
        let mut focus = Focus {
            area: None,
            guards: self.clear.iter().map(ClearOf::guard).collect(),
            reach: self.reach,
            unit: self.unit,
        };
        let strip = focus.strip(rows);
        focus.area = self.area.as_ref().map(|area| area.focus(strip));
        focus
    }
}

impl Focus {
    /// Where the points of some rows may lie along y, and a little more.
    fn strip(&self, rows: Range<i64>) -> [f64; 2] {
        let [least, most] = self.reach[1];
        [
            (rows.start as f64 + least - SLACK) * self.unit,
            (rows.end as f64 - 1.0 + most + SLACK) * self.unit,
        ]
    }

    /// Whether a point passes.
    pub(super) fn passes(&self, p: [f64; 2]) -> bool {
        self.area.as_ref().is_none_or(|area| area.contains(p))
            && self.guards.iter().all(|guard| guard.leaves(p))
    }

    /// Those columns of some rows whose points may pass in any of the rows; those of a run that
    /// passes do in all of them.
    pub(super) fn runs(&self, rows: Range<i64>, columns: &Range<i64>, runs: &mut Vec<Run>) {
        runs.clear();
        let steps = match &self.area {
            Some(area) => area.steps(self.strip(rows)),
            None => Steps::all(State::In),
        };
        let mut push = |run: Range<i64>, passes: bool| {
            let passes = passes && self.guards.is_empty();
            match runs.last_mut() {
                _ if run.is_empty() => {}
                Some(last) if last.passes == passes && last.columns.end == run.start => {
                    last.columns.end = run.end;
                }
                _ => runs.push(Run {
                    columns: run,
                    passes,
                }),
            }
        };
        let mut next = columns.start;
        for (from, to, state) in steps.stretches() {
            if state == State::Test {
                continue;
            }
            let start = self.first_beyond(from).clamp(next, columns.end);
            let end = self.last_before(to).clamp(start, columns.end);
            if start == end {
                continue;
            }
            push(next..start, false);
            if state == State::In {
                push(start..end, true);
            }
            next = end;
        }
        push(next..columns.end, false);
    }

    /// The first column whose points all lie above a world x, wherever they are moved.
    fn first_beyond(&self, x: f64) -> i64 {
        let x = x / self.unit;
        // Casts saturate.
        (x - self.reach[0][0] + room(x)) as i64
    }

    /// The end of the columns whose points all lie below a world x.
    fn last_before(&self, x: f64) -> i64 {
        let x = x / self.unit;
        (x - self.reach[0][1] - room(x)) as i64
    }
}

/// Lattice units that a boundary is given as room for rounding.
const SLACK: f64 = 3.0;

/// The same for a place far out: quotients are off by a few units in the last place. (Not without
/// end: what is asked for stays outermost, ±∞ included.)
fn room(x: f64) -> f64 {
    SLACK + (2e-15 * x.abs()).min(1e300)
}

/// How many points of a stretch of the lattice pass, unless it is stopped before it is through.
pub(super) fn count(
    sampler: &Sampler,
    frame: &Frame,
    sieve: &Sieve,
    [columns, rows]: [&Range<i64>; 2],
    stop: &Stop,
) -> u128 {
    let sets = Class::ALL.map(|class| frame.pattern.axis_set(Axis::X, class));
    let mut count = 0;
    let mut runs = Vec::new();
    let mut start = rows.start;
    while start < rows.end {
        let end = rows.end.min((start & !(PATCH_HEIGHT - 1)) + PATCH_HEIGHT);
        let focused = sieve.focus(start..end);
        for y in start..end {
            let Some((x_parity, index)) = frame.pattern.visit(Axis::Y, y) else {
                continue;
            };
            // A row along an edge, or with other layers near, takes long.
            if stop.is_raised() {
                return count;
            }
            focused.runs(y..y + 1, columns, &mut runs);
            if runs.is_empty() {
                continue;
            }
            let class = Class {
                x: x_parity,
                y: (y & 1) as u8,
            };
            let set = &sets[class.ordinal()];
            let vectors = sampler.row(sampler.map().locate(index));
            let displacement = |x: i64| {
                let index = frame.pattern.axis_index(Axis::X, x, class.y);
                vectors[sampler.map().locate(index)]
            };
            for run in &runs {
                if run.passes {
                    count += u128::from(set.count(run.columns.clone()));
                    continue;
                }
                // Neighbors are moved alike: what moves one is at hand for the next.
                let place = [fixed(run.columns.start), fixed(y)];
                let mut near = frame.shears.as_ref().map(|s| NearShears::new(s, place));
                for x in set.members(run.columns.clone()) {
                    let [dx, dy] = displacement(x);
                    let displaced = [fixed(x) + i128::from(dx), fixed(y) + i128::from(dy)];
                    let position = match &mut near {
                        Some((near, origin)) => {
                            let relative = [0, 1].map(|i| (displaced[i] - origin[i]) as i64);
                            let moved = near.apply(relative);
                            [0, 1].map(|i| origin[i] + i128::from(moved[i]))
                        }
                        None => displaced,
                    };
                    count += u128::from(focused.passes(position.map(|k| frame.world(k))));
                }
            }
        }
        start = end;
    }
    count
}
