//! Which addresses have points, and where these are.

use alloc::{sync::Arc, vec, vec::Vec};

use super::{
    Batch,
    pattern::Pattern,
    point::{Point, PointId},
    table::{Table, Turned},
    warp::Shears3,
};
use crate::{
    kernel::PICKS,
    lattice::{Grade, Keep, Placement, Settle, Without, alike},
    table::{Cut, FRACTION_BITS},
};

/// The largest absolute lattice coordinate of a region. Positions fit 64 bits, and `f64` coordinates keep neighbors a
/// ten-thousandth of a spacing apart there.
pub const LATTICE_LIMIT: i64 = 1 << 40;

/// The points of a table at a placement.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    pub(super) table: Table,
    pub(super) placement: Placement,
    pub(super) pattern: Pattern,
    pub(super) turned: Arc<Turned>,
    pub(super) shears: Option<Shears3>,
    /// The world units of a fixed-point unit.
    pub(super) step: f64,
    /// The points that are kept, unless all are.
    pub(super) cut: Option<Cut>,
    /// The field that decides which of these there are.
    pub(super) grade: Option<Grade<3>>,
    /// The points that are left out by their ids.
    pub(super) without: Without<PointId>,
}

/// A lattice coordinate in fixed-point units.
pub(super) const fn fixed(v: i64) -> i64 {
    v << FRACTION_BITS
}

impl Lattice {
    pub(super) fn new(table: Table, placement: Placement) -> Self {
        let alpha = table.map().alpha();
        let turned = table.turned(placement.seed.symmetry_in_space());
        let share = placement.shown();
        let cut = (share < 1.0).then(|| turned.order.cut(table.map(), share));
        let units = f64::from(1u32 << FRACTION_BITS);
        Self {
            placement,
            pattern: Pattern::new(alpha, Pattern::origin(placement.seed)),
            shears: Shears3::new(placement.warp, placement.seed),
            step: placement.spacing.get() * alpha.set_side_f64() / units,
            cut,
            grade: None,
            without: Without::default(),
            turned,
            table,
        }
    }

    /// This lattice at another placement.
    pub(super) fn replaced(&self, placement: Placement) -> Self {
        let share = placement.graded();
        Self {
            grade: self.grade.as_ref().map(|grade| grade.times(share)),
            without: self.without.clone(),
            ..Self::new(self.table.clone(), placement)
        }
    }

    /// All points, whatever the level of detail shows.
    pub(super) fn whole(&self) -> Self {
        match self.placement.lod {
            Keep::ALL => self.clone(),
            _ => self.replaced(self.placement.with_lod(Keep::ALL)),
        }
    }

    /// The mean spacing of the points that are kept, in world units.
    pub(super) fn spacing_kept(&self) -> f64 {
        self.placement.spacing.get() / libm::cbrt(self.placement.keep.get())
    }

    /// Whether another lattice has the same points.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let is_graded = alike(&self.grade, &other.grade, Grade::is_same);
        let is_placed = self.placement == other.placement && self.table == other.table;
        is_graded && is_placed && self.without.is_same(&other.without)
    }

    /// The blocks along the axes of an address, or `None` if the pattern has no point there.
    pub(super) fn block(&self, id: PointId) -> Option<[usize; 3]> {
        let at = id.lattice();
        if at.iter().any(|v| v.unsigned_abs() > LATTICE_LIMIT as u64) {
            return None;
        }
        let index = self.pattern.index(at);
        let map = self.table.map();
        let [i, j, k] = index.map(|index| map.interval_of(index));
        Some([i?, j?, k?])
    }

    /// The number of a block.
    pub(super) fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        let n = self.table.map().intervals();
        (k * n + j) * n + i
    }

    /// The intervals along the axes of a block.
    pub(super) fn intervals(&self, number: usize) -> [usize; 3] {
        let n = self.table.map().intervals();
        [number % n, number / n % n, number / (n * n)]
    }

    /// The components of the vectors of the blocks of an interval of dZ and one of dY, by that of dX. Some more numbers,
    /// which mean nothing, make their number a multiple of [`PICKS`].
    pub(super) fn vectors(&self, plane: usize, row: usize) -> [&[i32]; 3] {
        [0, 1, 2].map(|axis| self.components(axis, plane, row))
    }

    /// The [`vectors`](Self::vectors) along one axis.
    #[inline]
    pub(super) fn components(&self, axis: usize, plane: usize, row: usize) -> &[i32] {
        let first = self.number([0, row, plane]);
        let n = self.table.map().intervals();
        &self.turned.vectors[axis][first..][..n.next_multiple_of(PICKS)]
    }

    /// Whether the cut keeps all points of a block.
    pub(super) fn is_whole(&self, block: usize) -> bool {
        let position = self.turned.order.position(block) as u32;
        self.cut.is_none_or(|cut| cut.keeps(position, false))
    }

    /// Whether the cut keeps a point of a block.
    #[inline]
    pub(super) fn keeps(&self, block: usize, index_x: u64) -> bool {
        let position = self.turned.order.position(block) as u32;
        self.cut
            .is_none_or(|cut| cut.keeps(position, index_x < cut.strip_end))
    }

    /// The rank of a point of the pattern; the greatest for other addresses.
    pub(super) fn rank(&self, id: PointId) -> f64 {
        let Some(block) = self.block(id) else {
            return 1f64.next_down();
        };
        let interval = self.table.map().interval(block[0]);
        let [index, ..] = self.pattern.index(id.lattice());
        let order = &self.turned.order;
        let length = interval.end - interval.start;
        order.rank(
            order.position(self.number(block)),
            index - interval.start,
            length,
        )
    }

    /// The fixed-point place of an address before its point settles, or `None` if it has no point.
    pub(super) fn place(&self, id: PointId) -> Option<[i64; 3]> {
        let number = self.number(self.block(id)?);
        let at = id.lattice();
        let is_kept = self.cut.is_none() || self.keeps(number, self.pattern.index(at)[0]);
        let place = is_kept.then(|| {
            let vector = self.turned.vector(number);
            let displaced = [0, 1, 2].map(|axis| fixed(at[axis]) + i64::from(vector[axis]));
            match &self.shears {
                Some(shears) => shears.apply(displaced),
                None => displaced,
            }
        })?;
        let part = self.settling().map_or(1.0, |_| self.placement.lod.get());
        let has = |grade: &Grade<3>| {
            let share = grade.share(self.at(place));
            self.rank(id) < part * share
        };
        let is_there = self.grade.as_ref().is_none_or(has) && !self.without.has(id);
        is_there.then_some(place)
    }

    /// Whether a point that settles, of a share, is of the level of detail that is wanted, and not left out by its id.
    pub(super) fn shows(&self, id: PointId, share: f64) -> bool {
        let lod = self.placement.lod;
        (lod == Keep::ALL || self.rank(id) < lod.get() * share) && !self.without.has(id)
    }

    /// How points settle, and their shares before that; `None` if they stay. Full sets in space stay.
    pub(super) fn settling(&self) -> Option<(Settle, Grade<3>)> {
        let Placement { settle, keep, .. } = self.placement;
        match &self.grade {
            Some(grade) => (!settle.is_off()).then(|| (settle, grade.clone())),
            None => {
                let settle = settle
                    .of_share(keep.get())
                    .filter(|settle| !settle.is_near())?;
                Some((settle, Grade::constant(keep.get())))
            }
        }
    }

    /// Whether points are looked at one by one: those of a field, or some by their ids.
    pub(super) fn is_sifted(&self) -> bool {
        self.grade.is_some() || !self.without.is_empty()
    }

    /// Leaves the points of a batch, which has ids, that a field leaves and no list of ids leaves out.
    pub(super) fn sift(&self, batch: &mut Batch) {
        if !self.is_sifted() {
            return;
        }
        let origin = batch.origin;
        let mut shares = vec![1.0; batch.len()];
        if let Some(grade) = &self.grade {
            let places: Vec<[f64; 3]> = self.all_at(batch);
            grade.shares(&places, &mut shares);
        }
        let stays = |(id, &share): (&[i32; 3], &f64)| {
            let id = PointId::of([0, 1, 2].map(|axis| origin[axis] + i64::from(id[axis])));
            let is_left = self.grade.is_none() || (share > 0.0 && self.rank(id) < share);
            is_left && !self.without.has(id)
        };
        let stays: Vec<bool> = batch.ids.iter().zip(&shares).map(stays).collect();
        let mut stays = stays.into_iter();
        batch.retain(|_| stays.next() == Some(true));
    }

    /// The world coordinates of all points of a batch.
    pub(super) fn all_at(&self, batch: &Batch) -> Vec<[f64; 3]> {
        (0..batch.len()).map(|i| self.at(batch.place(i))).collect()
    }

    /// The world coordinates of a fixed-point place.
    #[inline(always)]
    pub(super) fn at(&self, place: [i64; 3]) -> [f64; 3] {
        place.map(|k| self.world(k))
    }

    /// The point at a fixed-point place.
    pub(super) fn point_at(&self, id: PointId, place: [i64; 3]) -> Point {
        let [x, y, z] = self.at(place);
        Point { id, x, y, z }
    }

    /// The world coordinate of a fixed-point one. Monotone.
    #[inline(always)]
    pub(super) fn world(&self, fixed: i64) -> f64 {
        fixed as f64 * self.step
    }

    /// The largest absolute world coordinate of a region.
    pub(super) fn limit(&self) -> f64 {
        self.world(fixed(LATTICE_LIMIT))
    }
}
