//! The WebAssembly module of `strew/lite`: sets of one table, their boxes, circles and chunks, neighbors and single
//! points.
//!
//! Calls take numbers. What is longer than a number goes through two buffers of the module: [`input`] makes room that
//! the caller writes to, and after a call [`output`] is where its result lies, or the words of its error. Tables, sets
//! and plans are numbers of their places in lists. A call returns −1 if it fails. No block is unsafe: exported functions
//! have attributes that keep their names. Without the standard library no panic has words: it is a trap.

#![no_std]

extern crate alloc;

mod describe;
mod output;
mod state;

use alloc::{format, vec::Vec};
use core::panic::PanicInfo;

use dlmalloc::GlobalDlmalloc;
use strew_core::{Circle, Error, F32, F64, Offsets, PointId, PointSet, Region, Table};

use crate::{
    describe::{Described, described},
    output::Output,
    state::{Planned, State, with},
};

#[global_allocator]
static ALLOCATOR: GlobalDlmalloc = GlobalDlmalloc;

#[panic_handler]
fn trap(_: &PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}

/// The result of a call that fails.
const FAILED: i32 = -1;

/// Runs a call. Its error becomes the output.
fn guarded(work: impl FnOnce(&mut State) -> Result<i32, Error>) -> i32 {
    with(|state| {
        work(state).unwrap_or_else(|error| {
            state.output = Output::of_error(&error);
            FAILED
        })
    })
}

/// Room for some bytes of the next call.
#[unsafe(no_mangle)]
pub extern "C" fn input(bytes: usize) -> *mut u8 {
    with(|state| {
        state.input.clear();
        state.input.resize(bytes, 0);
        state.input.as_mut_ptr()
    })
}

/// The place of the last output.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    with(|state| state.output.start())
}

/// The bytes of the last output.
#[unsafe(no_mangle)]
pub extern "C" fn output_length() -> usize {
    with(|state| state.output.bytes())
}

/// A table of the input, a table file. Outputs its profile, its alpha and its map, with zeros between them.
#[unsafe(no_mangle)]
pub extern "C" fn table() -> i32 {
    guarded(|state| {
        let table = Table::from_bytes(&state.input)?;
        let (alpha, map) = (table.map().alpha(), table.map().size());
        state.output = Output::Text(format!("{}\0{alpha}\0{map}", table.profile()));
        Ok(state.tables.add(table))
    })
}

/// The points of a table. `amount` is a spacing, or a density or a least distance, as `kind` says (0, 1, 2). Where
/// `warp` is NaN and `settle` negative, they are the default.
#[unsafe(no_mangle)]
pub extern "C" fn set(
    table: u32,
    kind: u32,
    amount: f64,
    seed: u64,
    warp: f64,
    keep: f64,
    settle: i32,
    lod: f64,
) -> i32 {
    guarded(|state| {
        let Some(table) = state.tables.get(table) else {
            return Ok(FAILED);
        };
        let mut set = PointSet::new(table.clone()).seed(seed);
        if !warp.is_nan() {
            set = set.warp(warp)?;
        }
        set = match kind {
            0 => set.spacing(amount)?,
            1 => set.density(amount)?,
            _ => set.min_distance(amount)?,
        };
        set = set.keep(keep)?.lod(lod)?;
        if let Ok(steps) = u32::try_from(settle) {
            set = set.settle(steps)?;
        }
        Ok(state.sets.add(Described::new(set)))
    })
}

/// Sets the attributes of a set. The input has `weights` numbers, then two lines: the names of attributes and those of
/// variants, by commas.
#[unsafe(no_mangle)]
pub extern "C" fn attributes(set: u32, weights: usize, low: f64, high: f64) -> i32 {
    guarded(|state| {
        let attributes = described(&state.input, weights, [low, high])?;
        if let Some(set) = state.sets.get_mut(set) {
            set.attributes = attributes;
        }
        Ok(0)
    })
}

fn planned(set: u32, relative: bool, area: Result<strew_core::Area, Error>) -> i32 {
    guarded(|state| {
        let Some(set) = state.sets.get(set) else {
            return Ok(FAILED);
        };
        let plan = set.points.within(area?)?;
        let bound = plan.attributes(&set.attributes)?;
        Ok(state.plans.add(Planned {
            plan,
            bound,
            relative,
        }))
    })
}

/// The points of a set in a box.
#[unsafe(no_mangle)]
pub extern "C" fn within_box(set: u32, min_x: f64, min_y: f64, max_x: f64, max_y: f64) -> i32 {
    let region = Region::new([min_x, min_y], [max_x, max_y]);
    planned(set, false, region.map(Into::into))
}

/// The points of a set in a circle.
#[unsafe(no_mangle)]
pub extern "C" fn within_circle(set: u32, x: f64, y: f64, radius: f64) -> i32 {
    let circle = Circle::new([x, y], radius);
    planned(set, false, circle.map(Into::into))
}

/// The points of a set in a chunk.
#[unsafe(no_mangle)]
pub extern "C" fn chunk(set: u32, size: f64, column: i64, row: i64) -> i32 {
    planned(
        set,
        true,
        Region::chunk(size, [column, row]).map(Into::into),
    )
}

/// The number of points of a plan; 2⁶⁴ − 1 also for more.
#[unsafe(no_mangle)]
pub extern "C" fn count(plan: u32) -> u64 {
    with(|state| {
        let count = state
            .plans
            .get(plan)
            .map_or(0, |planned| planned.plan.count());
        u64::try_from(count).unwrap_or(u64::MAX)
    })
}

/// Outputs the place that coordinates are relative to, of chunks or as `f32`.
#[unsafe(no_mangle)]
pub extern "C" fn origin(plan: u32) -> i32 {
    with(|state| {
        let origin = state.plans.get(plan).map(|planned| planned.plan.origin());
        state.output = Output::Places(origin.into_iter().collect());
        0
    })
}

/// Outputs the coordinates as `f64`, of a chunk relative to its corner.
#[unsafe(no_mangle)]
pub extern "C" fn coordinates(plan: u32) -> i32 {
    with(|state| {
        let Some(planned) = state.plans.get(plan) else {
            return FAILED;
        };
        state.output = Output::Places(if planned.relative {
            planned.converted::<Offsets>()
        } else {
            planned.converted::<F64>()
        });
        0
    })
}

/// Outputs the coordinates as `f32`.
#[unsafe(no_mangle)]
pub extern "C" fn offsets(plan: u32) -> i32 {
    with(|state| {
        let Some(planned) = state.plans.get(plan) else {
            return FAILED;
        };
        state.output = Output::Near(planned.converted::<F32>());
        0
    })
}

/// Outputs the ids, then the values of each attribute.
#[unsafe(no_mangle)]
pub extern "C" fn columns(plan: u32) -> i32 {
    with(|state| {
        let Some(planned) = state.plans.get(plan) else {
            return FAILED;
        };
        state.output = Output::Words(planned.words());
        0
    })
}

/// Outputs the points nearest to a place, at most `k` (0 for all) within a radius, which may be infinite: id,
/// coordinates, distance and attributes of each. Returns their number.
#[unsafe(no_mangle)]
pub extern "C" fn nearest(set: u32, x: f64, y: f64, k: usize, radius: f64) -> i32 {
    guarded(|state| {
        let Some(set) = state.sets.get(set) else {
            return Ok(FAILED);
        };
        let (points, at) = (&set.points, [x, y]);
        let found = match (k, radius.is_finite()) {
            (0, true) => points.around(at, radius, PointSet::MAX_NEAREST)?,
            (_, true) => points.nearest_within(at, k, radius)?,
            (_, false) => points.nearest(at, k)?,
        };
        let found: Vec<_> = found
            .iter()
            .map(|n| (n.member.point(), n.distance))
            .collect();
        let count = found.len() as i32;
        state.output = Output::Words(set.words(&found)?);
        Ok(count)
    })
}

/// Outputs the point of an id, as [`nearest`] does. Returns the number of points, 0 or 1.
#[unsafe(no_mangle)]
pub extern "C" fn point(set: u32, x: i64, y: i64) -> i32 {
    guarded(|state| {
        let Some(set) = state.sets.get(set) else {
            return Ok(FAILED);
        };
        let found: Vec<_> = set.points.point(PointId { x, y }).into_iter().collect();
        let found: Vec<_> = found.iter().map(|member| (member.point(), 0.0)).collect();
        let count = found.len() as i32;
        state.output = Output::Words(set.words(&found)?);
        Ok(count)
    })
}

/// Frees a plan.
#[unsafe(no_mangle)]
pub extern "C" fn free_plan(plan: u32) {
    with(|state| state.plans.remove(plan));
}

/// Frees a set. Its plans stay.
#[unsafe(no_mangle)]
pub extern "C" fn free_set(set: u32) {
    with(|state| state.sets.remove(set));
}

/// Frees the output.
#[unsafe(no_mangle)]
pub extern "C" fn free_output() {
    with(|state| state.output = Output::default());
}
