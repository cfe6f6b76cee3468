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
//! points that move. How far these reach is known when they are listed: a window is guessed, and listed again if need be.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    LEAST_SHARE, MOST_MOVE,
    boxes::{Box2, Placed, Settled, widened},
    cells::{Cells, Places},
    freedom::{Candidate, Freedoms, constant, local, slipped},
    kernels,
    near::Near,
    reach::{Extent, reached, whole_room, widest},
    step::{Scale, WHOLE},
};
use crate::{
    sample::{
        area::Region,
        field::{FieldRows, Source},
        kernel::Backend,
        lattice::{
            BAND_WIDTH, Columns, Grade, Lattice, Patch, PointId, Settle, Span, clip_to_band,
        },
    },
    table::{FRACTION_BITS, fixed},
};

/// The most candidates that are looked at together.
const TOGETHER: usize = 2048;

/// Corners of windows are multiples of this many fixed-point units, in bits.
const CORNER_BITS: u32 = 26;

/// The largest distance from a window's corner, in the units of a window.
const FARTHEST: i64 = 1 << 30;

/// The places along each axis of a box at which a field is looked at to guess how sparse it is.
const SAMPLES: usize = 9;

/// Settles points, with memory of its own.
#[derive(Clone, Debug)]
pub(crate) struct Settler {
    /// The points of all kinds, where their ranks left them.
    lattice: Lattice,
    grade: Grade,
    settle: Settle,
    scale: Scale,
    /// What limits the step of sets with all points, where that is taken.
    near: Option<Near>,
    /// Windows count in units of this many fixed-point units, in bits: more than one where the pattern is sparse.
    shift: u32,
    /// Fixed-point units of a mean spacing at full density.
    unit: f64,
    backend: Backend,
    columns: Columns,
    rows: FieldRows,
    listed: Vec<Listed>,
    places: Places,
    cells: Cells,
    freedoms: Freedoms,
    /// The points that may slip.
    slippery: Vec<u32>,
}

/// A point of a window.
#[derive(Clone, Copy, Debug)]
struct Listed {
    id: PointId,
    share: f64,
    /// The bits of its place below the window's units.
    below: [u8; 2],
    is_wanted: bool,
    /// Whether it may have to go back.
    may_slip: bool,
}

impl Settler {
    /// A settler of a lattice whose points settle; `None` of others.
    pub(crate) fn new(lattice: &Lattice) -> Option<Self> {
        let settle = lattice.settle()?;
        let grade = lattice.grade.clone()?;
        let side = lattice.table.alpha().set_side_f64();
        // Up to some 350 spacings fit a window.
        let mut shift = 0;
        while 400.0 / side > f64::from(1u32 << shift) * 1500.0 {
            shift += 1;
        }
        let unit = f64::from(1u32 << FRACTION_BITS) / side;
        let own = |v: f64| v / f64::from(1u32 << shift);
        let clear = own(lattice.certified());
        let near = settle.is_near().then(|| {
            let reach = kernels(settle).iter().map(widest).fold(0.0, f64::max);
            Near::new(clear, reach * own(unit))
        });
        Some(Self {
            lattice: lattice.of_all_kinds(),
            grade,
            settle,
            scale: Scale {
                unit: own(unit) as f32,
                clear: near.as_ref().map_or(clear as f32, |_| 0.0),
            },
            near,
            shift,
            unit,
            backend: Backend::best(),
            columns: Columns::default(),
            rows: FieldRows::default(),
            listed: Vec::new(),
            places: Places::default(),
            cells: Cells::default(),
            freedoms: Freedoms::default(),
            slippery: Vec::new(),
        })
    }

    /// Works by another backend.
    pub(crate) const fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
    }

    /// The greatest move of points that were placed in a box, in fixed-point units.
    pub(crate) fn most_move(&self, within: &Box2) -> i64 {
        let low = self.grade.bounds(&self.region(within))[0];
        // With room for what rounds.
        (f64::from(WHOLE) * 1.000_01 * self.unit * local(low)) as i64 + (2 << self.shift)
    }

    /// The box around a box that holds the places of all points that may settle in it.
    pub(crate) fn around(&self, within: &Box2) -> Box2 {
        let most = (MOST_MOVE * 1.001 * self.unit) as i64 + (2 << self.shift);
        let most = self.most_move(&widened(within, most)).min(most);
        widened(within, most)
    }

    /// The greatest share in a box.
    pub(crate) fn greatest_share(&self, within: &Box2) -> f64 {
        self.grade.bounds(&self.region(within))[1]
    }

    /// The number of points of the last window.
    pub(crate) const fn listed(&self) -> usize {
        self.listed.len()
    }

    /// The settled place of an address, or `None` if it has no point.
    pub(crate) fn point(&mut self, lattice: &Lattice, id: PointId) -> Option<[i128; 2]> {
        let place = lattice.place(id)?;
        let within = place.map(|k| k..k + 1);
        let mut found = None;
        self.settle(
            &within,
            |placed| placed.id == id && lattice.shows(id, placed.share),
            |settled| found = Some(settled.place),
        );
        found
    }

    /// The region of a box.
    pub(crate) fn region(&self, within: &Box2) -> Region {
        let [x, y] = within;
        let world = |k: i128| self.lattice.world(k);
        Region::between(
            [world(x.start), world(y.start)],
            [world(x.end.max(x.start)), world(y.end.max(y.start))],
        )
    }

    /// Calls `visit` for every point that was placed in a box.
    pub(crate) fn list(&mut self, within: &Box2, mut visit: impl FnMut(Placed)) {
        let unit = self.unit;
        let shift = self.shift;
        self.visit(within, |id, place, share| {
            let most = f64::from(WHOLE) * 1.000_01 * unit * local(share);
            visit(Placed {
                id,
                place,
                share,
                most: most as i64 + (2 << shift),
            });
        });
    }

    fn visit(&mut self, within: &Box2, mut visit: impl FnMut(PointId, [i128; 2], f64)) {
        let Self {
            lattice,
            grade,
            columns,
            rows,
            backend,
            ..
        } = self;
        if within.iter().any(Range::is_empty) {
            return;
        }
        let [x, y] = Span::of_box(lattice, within.clone());
        if x.all.is_empty() || y.all.is_empty() {
            return;
        }
        let bands = x.all.start.div_euclid(BAND_WIDTH)..=(x.all.end - 1).div_euclid(BAND_WIDTH);
        for band in bands {
            let range = clip_to_band(band, &x.all);
            columns.list(lattice, range.clone());
            let mut next = y.all.start;
            while next < y.all.end {
                let patch = Patch::new(lattice, band, next, &x, &y);
                let end = y.all.end.min(patch.end());
                rows.clear();
                let [left, bottom] = patch.origin();
                let origin = [fixed(left), fixed(bottom)];
                while next < end {
                    let source = Source {
                        lattice,
                        grade,
                        patch: &patch,
                        spans: [&x, &y],
                        columns: (columns, &range),
                    };
                    next = rows.list(source, next..end, TOGETHER, *backend);
                    for (found, share) in rows.with_shares() {
                        let [column, row] = found.address();
                        let id = PointId {
                            x: left + column,
                            y: bottom + row,
                        };
                        let place = [0, 1].map(|i| origin[i] + i128::from(found.place[i]));
                        visit(id, place, share);
                    }
                }
            }
        }
    }

    /// Settles points that were placed in a box: those that are wanted. `found` is called for each of them, in the
    /// order in which addresses are listed.
    pub(crate) fn settle(
        &mut self,
        within: &Box2,
        mut wants: impl FnMut(&Placed) -> bool,
        mut found: impl FnMut(Settled),
    ) {
        if within.iter().any(Range::is_empty) {
            return;
        }
        let corner = [0, 1].map(|i| {
            let Range { start, end } = within[i];
            ((start + (end - start) / 2) >> CORNER_BITS) << CORNER_BITS
        });
        let own = Extent {
            min: [0, 1].map(|i| self.offset(corner, i, within[i].start)),
            max: [0, 1].map(|i| self.offset(corner, i, within[i].end - 1)),
        };
        let mut window = self.guess(within, own);
        loop {
            self.list_window(corner, window, own, &mut wants);
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
                    id: listed.id,
                    place: self.place(corner, i, &self.places.at),
                    share: listed.share,
                });
            }
        }
    }

    /// The fixed-point place of point number `i` of the window, which keeps the bits below the window's unit.
    fn place(&self, corner: [i128; 2], i: usize, at: &[Vec<i32>; 2]) -> [i128; 2] {
        let below = self.listed[i].below;
        let place = |axis: usize| {
            let whole = i64::from(at[axis][i]) << self.shift;
            corner[axis] + i128::from(whole | i64::from(below[axis]))
        };
        [place(0), place(1)]
    }

    /// The world coordinates of the place at which point number `i` of the window was placed.
    fn placed(&self, corner: [i128; 2], i: usize) -> [f64; 2] {
        let [x, y] = self.place(corner, i, &self.places.placed);
        [self.lattice.world(x), self.lattice.world(y)]
    }

    /// About where the points lie that matter to those in a box, from a window's corner.
    fn guess(&mut self, within: &Box2, own: Extent) -> Extent {
        let region = self.region(within);
        let ([left, bottom], [right, top]) = (region.min(), region.max());
        let is_constant = self.grade.known().is_some();
        let samples = if is_constant { 1 } else { SAMPLES };
        let part = |i: usize| i as f64 / (SAMPLES - 1) as f64;
        let parts = || (0..samples).flat_map(|i| (0..samples).map(move |k| [part(i), part(k)]));
        let at = parts().map(|[a, b]| [left + a * (right - left), bottom + b * (top - bottom)]);
        let at: Vec<[f64; 2]> = at.collect();
        let mut shares = vec![0.0; at.len()];
        self.grade.shares(&at, &mut shares);
        let sparse = shares.iter().filter(|share| **share > 0.0);
        let least = sparse.fold(1.0f64, |a, b| a.min(*b));
        let unit = f64::from(self.scale.unit);
        // Points between the samples and around them may be sparser.
        let (least, slack) = if is_constant {
            (least, 1.0)
        } else {
            (0.8 * least, 1.1)
        };
        let kernels = kernels(self.settle);
        if is_constant {
            return own.widened(whole_room(kernels, [least; 2], unit));
        }
        let mut all = own;
        for (parts, share) in parts().zip(shares) {
            let room = whole_room(kernels, [share.max(least), least], slack * unit);
            all = all.and(own.place(parts).widened(room));
        }
        all
    }

    /// Lists the points of a window.
    fn list_window(
        &mut self,
        corner: [i128; 2],
        window: Extent,
        own: Extent,
        wants: &mut impl FnMut(&Placed) -> bool,
    ) {
        let within = [0, 1].map(|i| {
            let fixed = |v: i64| corner[i] + (i128::from(v) << self.shift);
            fixed(window.min[i])..fixed(window.max[i] + 1)
        });
        let mut listed = core::mem::take(&mut self.listed);
        let mut places = core::mem::take(&mut self.places);
        listed.clear();
        places.clear();
        let (shift, unit) = (self.shift, self.unit);
        self.visit(&within, |id, place, share| {
            let [x, y] = [(place[0] - corner[0]) as i64, (place[1] - corner[1]) as i64];
            let at = [(x >> shift) as i32, (y >> shift) as i32];
            let is_wanted = own.holds(at) && {
                let most = f64::from(WHOLE) * 1.000_01 * unit * local(share);
                wants(&Placed {
                    id,
                    place,
                    share,
                    most: most as i64 + (2 << shift),
                })
            };
            let below = (1 << shift) - 1;
            listed.push(Listed {
                id,
                share,
                below: [(x & below) as u8, (y & below) as u8],
                is_wanted,
                may_slip: false,
            });
            places.placed[0].push(at[0]);
            places.placed[1].push(at[1]);
        });
        for (at, placed) in places.at.iter_mut().zip(&places.placed) {
            at.extend_from_slice(placed);
        }
        let shares = listed
            .iter()
            .map(|listed| listed.share.max(LEAST_SHARE) as f32);
        places.share.extend(shares);
        places.freedom.resize(listed.len(), 0.0);
        places.until.resize(listed.len(), 0);
        (self.listed, self.places) = (listed, places);
    }

    /// Finds out which points move in which steps. Returns the extent of the points that matter to them; if it goes
    /// beyond the window, only about.
    fn prepare(&mut self, corner: [i128; 2], window: Extent) -> Extent {
        let kernels = kernels(self.settle);
        let unit = f64::from(self.scale.unit);
        let mut all = Extent::NONE;
        let mut from = Extent::NONE;
        for (t, kernel) in kernels.iter().enumerate().rev() {
            let step = t as u8 + 1;
            self.free(corner, step, (t + 1 < kernels.len()).then_some(from));
            let sparsest;
            (from, sparsest) = reached(&self.places, (kernel, t), unit);
            all = all.and(from);
            if !all.is_within(&window) {
                // The steps before this one reach on.
                let reach: f64 = kernels[..t].iter().map(widest).sum();
                let room = (reach * 1.2 * unit * local(sparsest)) as i64;
                return all.widened(room);
            }
        }
        all
    }

    /// Finds the freedom of the points that move up to a step: of those in an extent, or without one, those that are wanted.
    fn free(&mut self, corner: [i128; 2], step: u8, within: Option<Extent>) {
        let is_constant = self.grade.known().is_some();
        let Places {
            placed: [xs, ys],
            freedom,
            until,
            ..
        } = &mut self.places;
        self.freedoms.clear();
        let placed = xs.iter().zip(ys.iter());
        let lists = self.listed.iter().zip(placed).zip(until).zip(freedom);
        for (i, (((listed, (&x, &y)), until), freedom)) in lists.enumerate() {
            let is_new = match &within {
                None => listed.is_wanted,
                Some(within) => *until == 0 && within.holds([x, y]),
            };
            if !is_new {
                continue;
            }
            *until = step;
            if is_constant {
                *freedom = constant(listed.share) as f32;
            } else {
                self.freedoms.add(Candidate {
                    point: i as u32,
                    from_corner: [x, y],
                    share: listed.share,
                });
            }
        }
        if is_constant {
            return;
        }
        let (spacing, per_unit) = (
            self.lattice.placement.spacing.get(),
            self.lattice.step * f64::from(1u32 << self.shift),
        );
        let mut freedoms = core::mem::take(&mut self.freedoms);
        let mut freedom = core::mem::take(&mut self.places.freedom);
        let mut slippery = core::mem::take(&mut self.slippery);
        freedoms.find(
            &self.grade,
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
        for (step, kernel) in (1..).zip(kernels(self.settle)) {
            self.cells
                .step(&mut self.places, (kernel, step), self.scale, self.backend);
        }
        if let Some(near) = &mut self.near {
            near.limit(&mut self.places);
        }
    }

    /// Puts points back that slipped over an edge.
    fn go_back(&mut self, corner: [i128; 2]) {
        for i in 0..self.listed.len() {
            let Listed {
                is_wanted,
                may_slip,
                share,
                ..
            } = self.listed[i];
            if is_wanted && may_slip && self.places.freedom[i] > 0.0 {
                let at = self.place(corner, i, &self.places.at);
                let there = self.grade.share(at.map(|k| self.lattice.world(k)));
                if slipped(share, there) {
                    for axis in 0..2 {
                        self.places.at[axis][i] = self.places.placed[axis][i];
                    }
                }
            }
        }
    }

    /// A fixed-point coordinate from a window's corner, in its units.
    fn offset(&self, corner: [i128; 2], axis: usize, k: i128) -> i64 {
        let limit = i128::from(FARTHEST) << 4;
        ((k - corner[axis]) >> self.shift).clamp(-limit, limit) as i64
    }
}
