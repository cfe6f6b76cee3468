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
//! A sparse point reaches far, but one that stays needs no neighbors: where a field fades out, its sparsest
//! points stay because it is steep there. So boxes grow by the points that move, not by bounds of the field. How
//! far these reach is only known when they are listed, so a window is guessed first, and listed again if it
//! was too small. Where points end does not depend on it.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    LEAST_SHARE, MOST_MOVE,
    freedom::{Candidate, Freedoms, local, root, slipped},
    kernels,
    step::{Cells, Kernel, Places, STEP, Scale, WHOLE},
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

/// A point where it has settled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settled {
    pub(crate) id: PointId,
    /// In fixed-point units.
    pub(crate) place: [i128; 2],
    /// The share at its place at full density.
    pub(crate) share: f64,
}

/// A box of places, in fixed-point units.
pub(crate) type Box2 = [Range<i128>; 2];

/// A point where its rank left it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) id: PointId,
    /// In fixed-point units.
    pub(crate) place: [i128; 2],
    pub(crate) share: f64,
    /// The greatest move along each axis, in fixed-point units.
    pub(crate) most: i64,
}

/// The most candidates that are looked at together.
const TOGETHER: usize = 2048;

/// Corners of windows are multiples of this many fixed-point units, in bits.
const CORNER_BITS: u32 = 26;

/// The largest distance from a window's corner, in the units of a window.
const FARTHEST: i64 = 1 << 30;

/// Room for what rounds, in units of a window.
const ROOM: i64 = 64;

/// Places of a box at which a field is looked at to guess how sparse it is.
const SAMPLES: [(f64, f64); 5] = [(0.5, 0.5), (0.1, 0.1), (0.9, 0.1), (0.1, 0.9), (0.9, 0.9)];

/// The greatest reach of a kernel, in local spacings.
fn widest(kernel: &Kernel) -> f64 {
    f64::from(kernel.reach.max(kernel.near))
}

/// How far a point may have gone before step number `t`, which counts from 0, in local spacings.
fn moved_before(t: usize) -> f64 {
    f64::from(WHOLE).min(f64::from(STEP) * t as f64) * core::f64::consts::SQRT_2
}

/// Settles points, with memory of its own.
#[derive(Clone, Debug)]
pub(crate) struct Settler {
    /// The points of all kinds, where their ranks left them.
    lattice: Lattice,
    grade: Grade,
    settle: Settle,
    scale: Scale,
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
}

/// A point of a window.
#[derive(Clone, Copy, Debug)]
struct Listed {
    id: PointId,
    /// From the window's corner, in its units, and the bits below these.
    place: [i32; 2],
    below: [u8; 2],
    share: f64,
    is_wanted: bool,
    /// Whether it may have to go back.
    may_slip: bool,
}

/// The ranges of a box along both axes, from a window's corner.
#[derive(Clone, Copy, Debug)]
struct Extent {
    min: [i64; 2],
    max: [i64; 2],
}

impl Extent {
    const NONE: Self = Self {
        min: [i64::MAX; 2],
        max: [i64::MIN; 2],
    };

    fn add(&mut self, place: [i32; 2], room: i64) {
        for i in 0..2 {
            self.min[i] = self.min[i].min(i64::from(place[i]) - room);
            self.max[i] = self.max[i].max(i64::from(place[i]) + room);
        }
    }

    fn holds(&self, place: [i32; 2]) -> bool {
        (0..2).all(|i| (self.min[i]..=self.max[i]).contains(&i64::from(place[i])))
    }

    fn is_within(&self, other: &Self) -> bool {
        (0..2).all(|i| other.min[i] <= self.min[i] && self.max[i] <= other.max[i])
    }

    fn and(self, other: Self) -> Self {
        Self {
            min: [0, 1].map(|i| self.min[i].min(other.min[i])),
            max: [0, 1].map(|i| self.max[i].max(other.max[i])),
        }
    }
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
        Some(Self {
            lattice: lattice.of_all_kinds(),
            grade,
            settle,
            scale: Scale {
                unit: (unit / f64::from(1u32 << shift)) as f32,
                clear: (lattice.certified() / f64::from(1u32 << shift)) as f32,
            },
            shift,
            unit,
            backend: Backend::best(),
            columns: Columns::default(),
            rows: FieldRows::default(),
            listed: Vec::new(),
            places: Places::default(),
            cells: Cells::default(),
            freedoms: Freedoms::default(),
        })
    }

    /// Works by another backend.
    pub(crate) const fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
    }

    /// The greatest move of points that were placed in a box, in fixed-point units.
    pub(crate) fn most_move(&self, within: &Box2) -> i64 {
        let low = self.grade.bounds(&self.region(within))[0];
        self.move_at(low)
    }

    /// The greatest move of a point of a share along an axis, in fixed-point units.
    fn move_at(&self, share: f64) -> i64 {
        // With room for what rounds.
        (f64::from(WHOLE) * 1.000_01 * self.unit * local(share)) as i64 + (2 << self.shift)
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
            min: [0, 1].map(|i| self.from_corner(corner, i, within[i].start)),
            max: [0, 1].map(|i| self.from_corner(corner, i, within[i].end - 1)),
        };
        let guess = self.guess(within);
        let mut window = Extent {
            min: own.min.map(|v| v - guess),
            max: own.max.map(|v| v + guess),
        };
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
        [0, 1].map(|axis| {
            let whole = i64::from(at[axis][i]) << self.shift;
            corner[axis] + i128::from(whole | i64::from(below[axis]))
        })
    }

    /// About how far around a box points matter to those in it, in units of a window.
    fn guess(&self, within: &Box2) -> i64 {
        let region = self.region(within);
        let ([left, bottom], [right, top]) = (region.min(), region.max());
        let mut least = 1.0f64;
        let is_constant = self.grade.known().is_some();
        for (a, b) in SAMPLES {
            let share = self
                .grade
                .share([left + a * (right - left), bottom + b * (top - bottom)]);
            if share > 0.0 && share < least {
                least = share;
            }
        }
        let pair = if is_constant { 1.0 } else { 1.25 };
        let kernels = kernels(self.settle).iter().enumerate();
        let reach: f64 = kernels
            .map(|(t, kernel)| pair * widest(kernel) + 2.0 * moved_before(t))
            .sum();
        (reach * f64::from(self.scale.unit) * local(least)) as i64 + ROOM
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
        listed.clear();
        let (shift, unit) = (self.shift, self.unit);
        self.visit(&within, |id, place, share| {
            let from = [0, 1].map(|i| (place[i] - corner[i]) as i64);
            let at = from.map(|v| (v >> shift) as i32);
            let is_wanted = own.holds(at) && {
                let most = f64::from(WHOLE) * 1.000_01 * unit * local(share);
                wants(&Placed {
                    id,
                    place,
                    share,
                    most: most as i64 + (2 << shift),
                })
            };
            listed.push(Listed {
                id,
                place: at,
                below: from.map(|v| (v & ((1 << shift) - 1)) as u8),
                share,
                is_wanted,
                may_slip: false,
            });
        });
        self.listed = listed;
        let places = &mut self.places;
        places.clear();
        for listed in &self.listed {
            for axis in 0..2 {
                places.at[axis].push(listed.place[axis]);
                places.placed[axis].push(listed.place[axis]);
            }
            places.share.push(listed.share.max(LEAST_SHARE) as f32);
        }
        places.freedom.resize(self.listed.len(), 0.0);
        places.until.resize(self.listed.len(), 0);
    }

    /// Finds out which points move in which steps. Returns the extent of the points that matter to them; if it goes
    /// beyond the window, only about.
    fn prepare(&mut self, corner: [i128; 2], window: Extent) -> Extent {
        let kernels = kernels(self.settle);
        let unit = f64::from(self.scale.unit);
        let least = self.places.share.iter().fold(1.0f32, |a, &b| a.min(b));
        let least = f64::from(least);
        let mut all = Extent::NONE;
        let mut from = Extent::NONE;
        for (t, kernel) in kernels.iter().enumerate().rev() {
            let step = t as u8 + 1;
            let is_last = t + 1 == kernels.len();
            self.freedoms.clear();
            for (i, listed) in self.listed.iter().enumerate() {
                let is_new = match self.places.until[i] {
                    0 if is_last => listed.is_wanted,
                    0 => from.holds(listed.place),
                    _ => false,
                };
                if is_new {
                    self.places.until[i] = step;
                    let place = self.place(corner, i, &self.places.placed);
                    self.freedoms.add(Candidate {
                        point: i as u32,
                        from_corner: listed.place,
                        at: place.map(|k| self.lattice.world(k)),
                        share: listed.share,
                    });
                }
            }
            let (spacing, per_unit) = (
                self.lattice.placement.spacing.get(),
                self.lattice.step * f64::from(1u32 << self.shift),
            );
            let (freedom, listed) = (&mut self.places.freedom, &mut self.listed);
            self.freedoms
                .find(&self.grade, (spacing, per_unit), |i, free, is_gentle| {
                    freedom[i as usize] = free;
                    listed[i as usize].may_slip = !is_gentle;
                });
            from = Extent::NONE;
            let mut sparsest = 1.0f64;
            for (i, listed) in self.listed.iter().enumerate() {
                if self.places.until[i] >= step && self.places.freedom[i] > 0.0 {
                    let share = f64::from(self.places.share[i]);
                    let pair = root(2.0 / (share + least));
                    let moved = moved_before(t) * (local(share) + local(least));
                    let room = (widest(kernel) * pair + moved) * unit;
                    from.add(listed.place, room as i64 + ROOM);
                    sparsest = sparsest.min(share);
                }
            }
            all = all.and(from);
            if !all.is_within(&window) {
                // The steps before this one reach on.
                let reach: f64 = kernels[..t].iter().map(widest).sum();
                let room = (reach * 1.2 * unit * local(sparsest)) as i64;
                all.min = all.min.map(|v| v - room);
                all.max = all.max.map(|v| v + room);
                return all;
            }
        }
        all
    }

    fn take_steps(&mut self) {
        for (step, kernel) in (1..).zip(kernels(self.settle)) {
            self.cells
                .step(&mut self.places, (kernel, step), self.scale, self.backend);
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
    fn from_corner(&self, corner: [i128; 2], axis: usize, k: i128) -> i64 {
        let limit = i128::from(FARTHEST) << 4;
        ((k - corner[axis]) >> self.shift).clamp(-limit, limit) as i64
    }
}

/// The part of a box in another one.
pub(crate) fn common(a: &Box2, b: &Box2) -> Box2 {
    [0, 1].map(|i| {
        let start = a[i].start.max(b[i].start);
        start..a[i].end.min(b[i].end).max(start)
    })
}

/// A box with some room on all sides.
pub(crate) fn widened([x, y]: &Box2, room: i64) -> Box2 {
    let room = i128::from(room);
    [x.start - room..x.end + room, y.start - room..y.end + room]
}
