//! Windows: the points that matter to where some others settle.
//!
//! A point's last step needs its neighbors as the step before left them, which need theirs, and so on. So from the
//! points that are wanted, the box of those that matter grows step by step, by the reach of the points that move:
//!
//! ```text
//!      ┌───────────────────────────────┐
//!      │ placed only: neighbors in     │      box 0, all that is listed
//!      │ step 1                        │
//!      │    ┌─────────────────────┐    │
//!      │    │ moves in step 1     │    │      box 1
//!      │    │   ┌─────────────┐   │    │
//!      │    │   │ wanted:     │   │    │      the points that are wanted move
//!      │    │   │ moves in 2  │   │    │      in all steps
//!      │    │   └─────────────┘   │    │
//!      │    └─────────────────────┘    │
//!      └───────────────────────────────┘
//! ```
//!
//! A sparse point reaches far, but one that stays needs no neighbors, as where a field fades out. So boxes grow by the
//! points that move. How far these reach is known only once they are listed: so `reach` looks at the field in a few
//! places, the window is listed, and if `prepare` finds that points beyond it matter, it is listed again, larger.
//!
//! # Invariants
//!
//! - A point that moves in step t has every point that can push it in the window, each of which has moved in the steps
//!   before as far as it is free to. So wanted points end where they would if the whole plane moved.
//! - Places are integers from a corner near the middle that `f32` holds exactly. Corners are multiples of a unit; the
//!   bits of a place below a unit are set aside and added again at the end. So the choice of the corner shows nowhere.
//!
//! The cost is a listing and the steps of all points in box 0: many for one wanted point, few more than the wanted
//! ones for a piece of many rows.

use alloc::vec::Vec;
use core::{array::from_fn, ops::Range};

use super::{
    cells::{Cells, Places},
    freedom::{Candidate, Freedoms, constant, root, slipped, weight},
    kernels,
    kin::Kin,
    lister::{Lister, Settling},
    moves::{Moves, Placed, Settled},
    near::Near,
    reach::{Extent, Reach, guess, reached, step_room},
    step::{Kernel, Scale},
};
use crate::{
    kernel::Backend,
    lattice::{Grade, Settle},
};

/// Corners of windows are multiples of this many fixed-point units, in bits.
const CORNER_BITS: u32 = 26;

/// The largest distance from a window's corner, in the units of a window: single precision has all integers up to it,
/// and their differences.
const FARTHEST: i64 = 1 << 23;

/// Settles points, with memory of its own.
#[derive(Clone, Debug)]
pub(crate) struct Settler<S = Lister, const D: usize = 2> {
    set: S,
    pub(crate) moves: Moves<D>,
    backend: Backend,
    kernels: &'static [Kernel],
    /// The points by kinds, if those of a kind push each other.
    kin: Option<Kin<D>>,
    /// How far each step reaches.
    reaches: Vec<Reach>,
    scale: Scale,
    /// The limit of the step of sets with all points; `None` for other sets.
    near: Option<Near<D>>,
    listed: Vec<Listed<D>>,
    places: Places<D>,
    cells: Cells<D>,
    freedoms: Freedoms<D>,
    /// The points that may slip.
    slippery: Vec<u32>,
}

/// A point of a window.
#[derive(Clone, Copy, Debug)]
struct Listed<const D: usize> {
    address: [i64; D],
    share: f64,
    /// The bits of its place below the window's units.
    below: [u16; D],
    is_wanted: bool,
    /// Whether it may have to go back.
    may_slip: bool,
}

impl<S: Settling<D>, const D: usize> Settler<S, D> {
    /// A settler of a set that a grade thins.
    pub(crate) fn of(set: S, grade: Grade<D>, settle: Settle) -> Self {
        let moves = Moves::new(grade, set.side(), set.step());
        let Moves { unit, shift, .. } = moves;
        let kin = Kin::new(set.mix(), settle);
        let kernels = kin
            .as_ref()
            .map_or(kernels::<D>(settle), |kin| kin.steps().all);
        let reach = |(t, kernel)| {
            let of_kin = kin.as_ref().map(|kin| (kin.kernel(t), kin.least_part()));
            let of_kin = of_kin.as_ref().map(|(kernel, part)| (kernel, *part));
            Reach::new(kernel, of_kin)
        };
        let reaches: Vec<Reach> = kernels.iter().enumerate().map(reach).collect();
        let own = |v: f64| v / f64::from(1u32 << shift);
        let clear = own(set.certified());
        let near = settle.is_near().then(|| {
            let reach = reaches.iter().map(Reach::widest).fold(0.0, f64::max);
            Near::new(clear, reach * own(unit))
        });
        Self {
            reaches,
            set,
            moves,
            backend: Backend::best(),
            kernels,
            kin,
            scale: Scale {
                unit: own(unit) as f32,
                clear: near.as_ref().map_or(clear as f32, |_| 0.0),
            },
            near,
            listed: Vec::new(),
            places: Places::default(),
            cells: Cells::default(),
            freedoms: Freedoms::default(),
            slippery: Vec::new(),
        }
    }

    /// Works by another backend.
    pub(crate) const fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
    }

    /// About how many times as far as in sets without kinds points matter to others.
    pub(crate) fn width(&self) -> f64 {
        self.kin
            .as_ref()
            .map_or(1.0, |kin| 1.0 / root(kin.least_part()))
    }

    /// The number of points of the last window.
    pub(crate) const fn listed(&self) -> usize {
        self.listed.len()
    }

    /// Where a point settles that was placed somewhere, if it is wanted.
    pub(crate) fn settled(
        &mut self,
        place: [i128; D],
        wants: &mut dyn FnMut(&Placed<D>) -> bool,
    ) -> Option<[i128; D]> {
        let mut found = None;
        let within = place.map(|k| k..k + 1);
        self.settle(&within, wants, &mut |settled| found = Some(settled.place));
        found
    }

    /// Calls `visit` for every point that was placed in a box.
    pub(crate) fn list(&mut self, within: &[Range<i128>; D], mut visit: impl FnMut(Placed<D>)) {
        let (unit, shift) = (self.moves.unit, self.moves.shift);
        let corner = within.each_ref().map(|range| range.start);
        let by = (&self.moves.grade, self.backend);
        self.set.list(within, corner, by, &mut |some| {
            for (found, &share) in some.found.iter().zip(some.shares) {
                let (address, offset) = (some.address(found), some.offset(found));
                let place = from_fn(|i| corner[i] + i128::from(offset[i]));
                visit(Placed::new((address, place, share), (unit, shift)));
            }
        });
    }

    /// Settles points that were placed in a box: those that are wanted. `found` is called for each of them, in the
    /// order in which addresses are listed.
    pub(crate) fn settle(
        &mut self,
        within: &[Range<i128>; D],
        wants: &mut dyn FnMut(&Placed<D>) -> bool,
        found: &mut dyn FnMut(Settled<D>),
    ) {
        if within.iter().any(Range::is_empty) {
            return;
        }
        let corner = from_fn(|i| {
            let Range { start, end } = within[i];
            ((start + (end - start) / 2) >> CORNER_BITS) << CORNER_BITS
        });
        let own = Extent {
            min: from_fn(|i| self.offset(corner, i, within[i].start)),
            max: from_fn(|i| self.offset(corner, i, within[i].end - 1)),
        };
        let mut window = guess(
            &self.moves.grade,
            (self.moves.region(within), own),
            &self.reaches,
            f64::from(self.scale.unit),
        );
        loop {
            self.list_window(corner, window, own, wants);
            let needed = self.prepare(corner, window);
            if needed.is_within(&window) {
                break;
            }
            window = window.and(needed);
        }
        self.take_steps();
        self.go_back(corner);
        for (i, listed) in self.listed.iter().enumerate() {
            if listed.is_wanted {
                found(Settled {
                    address: listed.address,
                    place: self.place(corner, i, &self.places.at),
                    share: listed.share,
                });
            }
        }
    }

    /// The fixed-point place of point number `i` of the window, which keeps the bits below the window's unit.
    fn place(&self, corner: [i128; D], i: usize, at: &[Vec<f32>; D]) -> [i128; D] {
        let below = self.listed[i].below;
        from_fn(|axis| {
            let whole = (at[axis][i] as i64) << self.moves.shift;
            corner[axis] + i128::from(whole | i64::from(below[axis]))
        })
    }

    /// The world coordinates of the place at which point number `i` of the window was placed.
    fn placed(&self, corner: [i128; D], i: usize) -> [f64; D] {
        self.set
            .looked_at(self.place(corner, i, &self.places.placed))
    }

    /// Lists the points of a window.
    fn list_window(
        &mut self,
        corner: [i128; D],
        window: Extent<D>,
        own: Extent<D>,
        wants: &mut dyn FnMut(&Placed<D>) -> bool,
    ) {
        let within = from_fn(|i| {
            let fixed = |v: i64| corner[i] + (i128::from(v) << self.moves.shift);
            fixed(window.min[i])..fixed(window.max[i] + 1)
        });
        let mut listed = core::mem::take(&mut self.listed);
        let mut places = core::mem::take(&mut self.places);
        listed.clear();
        places.clear();
        let (shift, unit) = (self.moves.shift, self.moves.unit);
        let below = (1 << shift) - 1;
        let by = (&self.moves.grade, self.backend);
        self.set.list(&within, corner, by, &mut |some| {
            let offsets = || some.found.iter().map(|found| some.offset(found));
            for (axis, list) in places.placed.iter_mut().enumerate() {
                list.extend(offsets().map(|offset| (offset[axis] >> shift) as i32 as f32));
            }
            match self.moves.grade.known() {
                Some(share) => places
                    .weight
                    .resize(places.placed[0].len(), weight::<D>(share) as f32),
                None => {
                    let weights = some.shares.iter().map(|share| weight::<D>(*share) as f32);
                    places.weight.extend(weights);
                }
            }
            let points = some.found.iter().zip(some.shares);
            listed.extend(points.map(|(found, &share)| {
                let (address, offset) = (some.address(found), some.offset(found));
                let is_wanted = own.holds(offset.map(|v| (v >> shift) as i32 as f32)) && {
                    let place = from_fn(|i| corner[i] + i128::from(offset[i]));
                    wants(&Placed::new((address, place, share), (unit, shift)))
                };
                Listed {
                    address,
                    share,
                    below: offset.map(|v| (v & below) as u16),
                    is_wanted,
                    may_slip: false,
                }
            }));
        });
        for (at, placed) in places.at.iter_mut().zip(&places.placed) {
            at.extend_from_slice(placed);
        }
        places.freedom.resize(listed.len(), 0.0);
        places.until.resize(listed.len(), 0);
        if let Some(kin) = &mut self.kin {
            kin.clear();
            for (i, listed) in listed.iter().enumerate() {
                kin.add(i, self.set.kind_of(listed.address), listed.share);
            }
        }
        (self.listed, self.places) = (listed, places);
    }

    /// Finds out which points move in which steps. Returns the extent of the points that matter to them; if it goes
    /// beyond the window, only about.
    fn prepare(&mut self, corner: [i128; D], window: Extent<D>) -> Extent<D> {
        let unit = f64::from(self.scale.unit);
        let steps = self.reaches.len();
        let mut all = Extent::NONE;
        let mut from = Extent::NONE;
        if let Some(share) = self.moves.grade.known() {
            return self.prepare_alike(share);
        }
        for t in (0..steps).rev() {
            let step = t as u8 + 1;
            self.free(corner, step, (t + 1 < steps).then_some(from));
            let sparsest;
            (from, sparsest) = reached(&self.places, (&self.reaches[t], t), unit);
            all = all.and(from);
            if !all.is_within(&window) {
                // The steps before this one reach on.
                let reach: f64 = self.reaches[..t].iter().map(Reach::widest).sum();
                let room = (reach * 1.2 * unit / root(sparsest)) as i64;
                return all.widened(room);
            }
        }
        all
    }

    /// Does what [`prepare`](Self::prepare) does where all shares are alike, and with them all reaches.
    fn prepare_alike(&mut self, share: f64) -> Extent<D> {
        let Places {
            placed,
            freedom,
            until,
            ..
        } = &mut self.places;
        freedom.fill(constant(share) as f32);
        let mut movers = Extent::NONE;
        let placed = placed.each_ref().map(|list| &list[..until.len()]);
        for (i, (until, listed)) in until.iter_mut().zip(&self.listed).enumerate() {
            if listed.is_wanted {
                movers.add([placed.map(|list| list[i]); 2], 0);
            }
            *until = if listed.is_wanted { u8::MAX } else { 0 };
        }
        for (t, reach) in self.reaches.iter().enumerate().rev() {
            for (i, until) in until.iter_mut().enumerate() {
                let is_new = (*until == 0) & movers.holds(placed.map(|list| list[i]));
                *until = if is_new { t as u8 + 1 } else { *until };
            }
            let weights = [weight::<D>(share); 2];
            let room = step_room(reach, t, weights, f64::from(self.scale.unit));
            movers = movers.widened(room);
        }
        movers
    }

    /// Finds the freedom of the points that move up to a step: of those in an extent, or without one, those that are
    /// wanted.
    fn free(&mut self, corner: [i128; D], step: u8, within: Option<Extent<D>>) {
        let Places { placed, until, .. } = &mut self.places;
        self.freedoms.clear();
        let placed = placed.each_ref().map(|list| &list[..until.len()]);
        for (i, (listed, until)) in self.listed.iter().zip(until).enumerate() {
            let at = placed.map(|list| list[i]);
            let is_new = match &within {
                None => listed.is_wanted,
                Some(within) => *until == 0 && within.holds(at),
            };
            if !is_new {
                continue;
            }
            *until = step;
            self.freedoms.add(Candidate {
                point: i as u32,
                from_corner: at.map(|v| v as i32),
                share: listed.share,
            });
        }
        let (spacing, per_unit) = (
            self.set.spacing(),
            self.set.step() * f64::from(1u32 << self.moves.shift),
        );
        let mut freedoms = core::mem::take(&mut self.freedoms);
        let mut freedom = core::mem::take(&mut self.places.freedom);
        let mut slippery = core::mem::take(&mut self.slippery);
        freedoms.find(
            &self.moves.grade,
            (spacing, per_unit),
            |i| self.placed(corner, i as usize),
            |i, free, is_gentle| {
                freedom[i as usize] = free;
                if !is_gentle {
                    slippery.push(i);
                }
            },
        );
        for i in slippery.drain(..) {
            self.listed[i as usize].may_slip = true;
        }
        (self.freedoms, self.places.freedom, self.slippery) = (freedoms, freedom, slippery);
    }

    fn take_steps(&mut self) {
        for (step, kernel) in (1..).zip(self.kernels) {
            let backend = self.backend;
            if let Some(kin) = &mut self.kin {
                kin.push(&mut self.places, step, self.scale, backend);
            }
            self.cells
                .step(&mut self.places, (kernel, step), self.scale, backend);
        }
        if let Some(near) = &mut self.near {
            near.limit(&mut self.places);
        }
    }

    /// Puts points back that slipped over an edge.
    fn go_back(&mut self, corner: [i128; D]) {
        if self.moves.grade.known().is_some() {
            return;
        }
        for i in 0..self.listed.len() {
            let Listed {
                is_wanted,
                may_slip,
                share,
                ..
            } = self.listed[i];
            if is_wanted && may_slip && self.places.freedom[i] > 0.0 {
                let at = self.place(corner, i, &self.places.at);
                let there = self.moves.grade.share(self.set.looked_at(at));
                if slipped(share, there) {
                    for axis in 0..D {
                        self.places.at[axis][i] = self.places.placed[axis][i];
                    }
                }
            }
        }
    }

    /// A fixed-point coordinate from a window's corner, in its units.
    fn offset(&self, corner: [i128; D], axis: usize, k: i128) -> i64 {
        let limit = i128::from(FARTHEST) << 4;
        ((k - corner[axis]) >> self.moves.shift).clamp(-limit, limit) as i64
    }
}
