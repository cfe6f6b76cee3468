//! The warp of points in space: all shears of the three planes, for points in groups of successive ones of a row.
//!
//! A shear waits for the one before it, so four vectors take turns. The places of a group in the lattice and bounds of
//! everything else tell which cells its points can touch, so no point is looked at for that. Along a row only x goes
//! through many cells: six of the twelve shears do not depend on it, and have tables that all four vectors share.

use super::{
    Backend,
    backend::run_vectors,
    lanes::{Lanes, VectorLoop},
    quadratics::{Near, Quadratics, Tables, noise},
};
use crate::{
    sample::warp::{CELL_BITS, PatchShears},
    table::FRACTION_BITS,
};

/// The number of points of a group.
pub(crate) const GROUP: usize = 16;
/// The vectors that take turns.
const TURNS: usize = 4;

/// The axes of each plane, in the order of application.
pub(crate) const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The shears of the three planes for the points of a patch.
#[derive(Clone, Debug)]
pub(crate) struct SpaceShears {
    pub(crate) planes: [PatchShears; 3],
    /// By plane and direction, the least coordinate across of points whose lattice coordinates are 0.
    leads: [[i32; 4]; 3],
    /// The greatest difference of coordinates across of points at one address.
    width: i64,
}

/// The least and the greatest lattice coordinates of a group, relative to the patch's origin.
pub(crate) type Extents = [[i32; 2]; 3];

impl SpaceShears {
    /// The shears of some planes, for points that are displaced by some numbers of fixed-point units.
    pub(crate) fn new(planes: [PatchShears; 3], reach: [[i32; 2]; 3]) -> Self {
        let mut ranges = reach;
        let mut width = 0;
        let mut leads = [[0; 4]; 3];
        for ((shears, [a, b]), leads) in planes.iter().zip(PLANES).zip(&mut leads) {
            let more = |[a, b]: [i32; 2], [c, d]: [i32; 2]| [a + c, b + d];
            let opposite = |[a, b]: [i32; 2]| [-b, -a];
            let [along_b, along_a, rising, falling] = shears.bounds;
            let first = ranges[a];
            let second = more(ranges[b], along_b);
            let moved = more(first, along_a);
            let third = more(moved, opposite(second));
            let raised = [more(moved, rising), more(second, rising)];
            let fourth = more(raised[0], raised[1]);
            let across = [first, second, third, fourth];
            *leads = across.map(|[least, _]| least);
            for [least, most] in across {
                width = width.max(i64::from(most) - i64::from(least));
            }
            ranges[a] = more(raised[0], falling);
            ranges[b] = more(raised[1], opposite(falling));
        }
        Self {
            planes,
            leads,
            width,
        }
    }

    /// Whether the points of a group touch at most some number of cells in each direction.
    fn fits(&self, extents: &Extents, cells: usize) -> bool {
        let sides = extents.map(|[least, most]| i64::from(most) - i64::from(least));
        let both = PLANES.map(|[a, b]| sides[a] + sides[b]);
        let widest = both.into_iter().fold(0, i64::max);
        (widest << FRACTION_BITS) + self.width <= (cells as i64 - 1) << CELL_BITS
    }

    /// The first cell of a direction of a plane that the points of a group touch.
    #[inline(always)]
    fn cell(&self, plane: usize, direction: usize, extents: &Extents) -> i32 {
        let [a, b] = PLANES[plane].map(|axis| extents[axis]);
        let across = match direction {
            0 => a[0],
            1 => b[0],
            2 => a[0] - b[1],
            _ => a[0] + b[0],
        };
        ((across << FRACTION_BITS) + self.leads[plane][direction]) >> CELL_BITS
    }
}

/// Warps points: three lists of their coordinates, whole groups, whose extents are known. Returns false, and leaves them,
/// unless vectors can do it.
pub(crate) fn warp_groups(
    backend: Backend,
    shears: &SpaceShears,
    extents: &[Extents],
    places: [&mut [i32]; 3],
) -> bool {
    let mut groups = Groups {
        shears,
        extents,
        places,
    };
    run_vectors(backend, &mut groups) > 0
}

struct Groups<'a> {
    shears: &'a SpaceShears,
    extents: &'a [Extents],
    places: [&'a mut [i32]; 3],
}

impl VectorLoop for Groups<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.extents.len() * GROUP;
        let mut groups = self.extents.iter();
        if self.places.iter().any(|list| list.len() != length)
            || !GROUP.is_multiple_of(L::WIDTH)
            || !groups.all(|extents| self.shears.fits(extents, L::WINDOW))
        {
            return 0;
        }
        for start in (0..length).step_by(TURNS * L::WIDTH) {
            // Beyond the end, the last vector is done again.
            let starts = [0, 1, 2, 3].map(|k| (start + k * L::WIDTH).min(length - L::WIDTH));
            let extents = starts.map(|start| &self.extents[start / GROUP]);
            let mut rows = *extents[0];
            for extents in &extents[1..] {
                for (all, [least, most]) in rows.iter_mut().zip(extents.iter()) {
                    *all = [all[0].min(*least), all[1].max(*most)];
                }
            }
            // Of the directions that x has no part in.
            rows[0] = [0; 2];
            // SAFETY: the machine has the instructions, and the lists have a vector from all starts on.
            unsafe {
                if self.shears.fits(&rows, L::WINDOW) {
                    self.turns::<L, _>(starts, extents, [&rows]);
                } else {
                    self.turns::<L, _>(starts, extents, extents);
                }
            }
        }
        length
    }
}

impl Groups<'_> {
    /// Warps the vectors at some places, with the extents of each, and for shears that x has no part in with one of all or
    /// of each.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the lists have a vector from each of `starts` on.
    #[inline(always)]
    unsafe fn turns<L: Lanes, const ROWS: usize>(
        &mut self,
        starts: [usize; TURNS],
        extents: [&Extents; TURNS],
        rows: [&Extents; ROWS],
    ) {
        // SAFETY: as the caller ensures.
        unsafe {
            let mut all = starts.map(|start| {
                let list = |axis: usize| self.places[axis].as_ptr().add(start);
                [0, 1, 2].map(|axis| L::load_ints(list(axis)))
            });
            for (plane, [a, b]) in PLANES.into_iter().enumerate() {
                let tables = |direction| Tables::new(&self.shears.planes[plane], direction);
                let tables = [tables(0), tables(1), tables(2), tables(3)];
                let shear = |direction: usize, k: usize| {
                    let has_x = match direction {
                        0 => a == 0,
                        1 => b == 0,
                        _ => a == 0 || b == 0,
                    };
                    let extents = if has_x { extents[k] } else { rows[k % ROWS] };
                    let cell = self.shears.cell(plane, direction, extents);
                    Near::<L>::new(tables[direction], cell)
                };
                for (k, at) in all.iter_mut().enumerate() {
                    at[b] = L::add_ints(at[b], noise(shear(0, k), at[a]));
                }
                for (k, at) in all.iter_mut().enumerate() {
                    at[a] = L::add_ints(at[a], noise(shear(1, k), at[b]));
                }
                for (k, at) in all.iter_mut().enumerate() {
                    let rising = noise(shear(2, k), L::sub_ints(at[a], at[b]));
                    at[a] = L::add_ints(at[a], rising);
                    at[b] = L::add_ints(at[b], rising);
                }
                for (k, at) in all.iter_mut().enumerate() {
                    let falling = noise(shear(3, k), L::add_ints(at[a], at[b]));
                    at[a] = L::add_ints(at[a], falling);
                    at[b] = L::sub_ints(at[b], falling);
                }
            }
            for (start, at) in starts.into_iter().zip(all) {
                for (list, v) in self.places.iter_mut().zip(at) {
                    L::store_ints(list.as_mut_ptr().add(start), v);
                }
            }
        }
    }
}
