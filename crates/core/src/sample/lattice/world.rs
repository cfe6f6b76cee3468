//! The lattice of a point set, laid into the world.

use alloc::{sync::Arc, vec::Vec};

use super::{Keep, Line, Placement, Point, PointId, rank};
use crate::{
    map::Map,
    pattern::{Axis, Class, Pattern},
    sample::warp::{NearShears, Shears, Stretch},
    table::{Cut, Displacement, FRACTION_BITS, Ladder, Order, Table, TurnedTable, fixed},
};

/// The largest absolute lattice coordinate of a region and of an id, 2⁵². Up to there `f64` separates
/// lattice points, and no intermediate value overflows or rounds twice.
///
/// ```
/// use strew_core::{LATTICE_LIMIT, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).spacing(4.0)?;
/// // A lattice unit is t mean spacings.
/// let unit = set.table().alpha().set_side_f64() * 4.0;
/// assert_eq!(set.limit(), LATTICE_LIMIT as f64 * unit);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const LATTICE_LIMIT: i64 = 1 << 52;

/// A table at a placement: which lattice addresses have points, and where these are.
#[derive(Clone, Debug)]
pub(crate) struct Lattice {
    pub(crate) table: Table,
    pub(crate) placement: Placement,
    /// The table, turned by the seed's symmetry.
    pub(crate) turned: TurnedTable,
    /// The pattern from the seed's origin.
    pub(crate) pattern: Pattern,
    /// Which of its points are kept, if not all.
    pub(crate) cut: Option<Cut>,
    /// The vectors where points have moved as others left, if they do.
    moved: Option<Arc<Moved>>,
    pub(crate) shears: Option<Shears>,
    /// The bound of what the warp does to distances.
    pub(crate) stretch: Stretch,
    /// World units per fixed-point unit.
    pub(crate) step: f64,
}

/// Vectors other than the table's own.
#[derive(Debug)]
struct Moved {
    /// As a table has them; zero for blocks that have left.
    vectors: Vec<Displacement>,
    /// The least and the greatest along x and y.
    reach: [[i32; 2]; 2],
}

impl Moved {
    /// The vectors of the blocks that are left at a share.
    fn new(turned: &TurnedTable, ladder: &Ladder, share: f64) -> Self {
        let (order, stage) = (turned.order(), ladder.stage(share));
        let alive = order.alive(share);
        let mut reach = [[0; 2]; 2];
        let vector = |&position: &u32| {
            let position = position as usize;
            if position >= alive {
                return [0, 0];
            }
            let vector = turned.moved(ladder, stage, position);
            for (ends, v) in reach.iter_mut().zip(vector) {
                *ends = [ends[0].min(v), ends[1].max(v)];
            }
            vector
        };
        let vectors = order.all_positions().iter().map(vector).collect();
        Self { vectors, reach }
    }
}

/// Kept out of line, or both conversions would become the slow one.
#[cold]
#[inline(never)]
fn wide(fixed: i128) -> f64 {
    fixed as f64
}

impl Lattice {
    pub(crate) fn new(table: Table, placement: Placement) -> Self {
        let alpha = table.alpha();
        let Placement {
            spacing,
            seed,
            warp,
            keep,
        } = placement;
        // The mean spacing in the grid is 1/t, so a scale of spacing · t makes it `spacing`.
        let scale = spacing.get() * alpha.set_side_f64();
        let shears = Shears::new(warp, seed);
        let turned = TurnedTable::new(&table, seed.symmetry());
        Self {
            placement,
            pattern: Pattern::with_origin(alpha, seed.origin()),
            cut: (keep.get() < 1.0).then(|| turned.order().cut(table.map(), keep.get())),
            moved: match table.ladder() {
                Some(ladder) if keep.moves() && keep.get() < 1.0 => {
                    Some(Arc::new(Moved::new(&turned, ladder, keep.get())))
                }
                _ => None,
            },
            turned,
            stretch: Stretch::of(shears.as_ref()),
            shears,
            step: scale / f64::from(1u32 << FRACTION_BITS),
            table,
        }
    }

    pub(crate) fn map(&self) -> &Map {
        self.table.map()
    }

    /// The class of a row and its block of dY, or `None` if the row holds no points.
    #[inline]
    pub(crate) fn row(&self, y: i64) -> Option<(Class, usize)> {
        let (class, index) = self.pattern.visit(Axis::Y, y)?;
        Some((class, self.map().locate(index)))
    }

    /// The column of an index dX.
    #[inline]
    pub(crate) fn line(&self, at: i64, index: u64) -> Line {
        let block = self.map().locate(index);
        let is_in_strip = self.cut.is_some_and(|cut| cut.is_in_strip(block, index));
        Line {
            at,
            block: block as u32,
            is_in_strip,
        }
    }

    /// Tells which columns have points in the rows of a block of dY.
    #[inline]
    pub(crate) fn keeps(&self, block_y: usize) -> impl Fn(&Line) -> bool + '_ {
        let n = self.map().intervals();
        let positions = self.order().positions(block_y * n..(block_y + 1) * n);
        move |line| {
            let position = positions[line.block as usize];
            self.cut
                .is_none_or(|cut| cut.keeps(position, line.is_in_strip))
        }
    }

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn vectors(&self, block_y: usize) -> &[[i32; 2]] {
        match &self.moved {
            None => self.turned.row(block_y),
            Some(moved) => {
                let n = self.map().intervals();
                &moved.vectors[block_y * n..(block_y + 1) * n]
            }
        }
    }

    /// The order in which blocks leave.
    #[inline]
    pub(crate) fn order(&self) -> &Order {
        self.turned.order()
    }

    /// The least and the greatest displacement along an axis, without the warp.
    pub(crate) fn table_reach(&self, axis: Axis) -> [i32; 2] {
        let reach = match &self.moved {
            None => self.turned.reach(),
            Some(moved) => moved.reach,
        };
        reach[axis as usize]
    }

    /// This lattice at another placement. What does not change is shared.
    pub(crate) fn replaced(&self, placement: Placement) -> Self {
        let is_turned = placement.seed.symmetry() != self.placement.seed.symmetry();
        if placement.keep != self.placement.keep || is_turned {
            return Self::new(self.table.clone(), placement);
        }
        let still = Placement {
            keep: Keep::ALL,
            ..placement
        };
        Self {
            placement,
            cut: self.cut,
            moved: self.moved.clone(),
            ..Self::new(self.table.clone(), still)
        }
    }

    /// The blocks of dX and dY of an address, or `None` if it has no point.
    pub(crate) fn block(&self, id: PointId) -> Option<[usize; 2]> {
        let within = -LATTICE_LIMIT..=LATTICE_LIMIT;
        if !within.contains(&id.x) || !within.contains(&id.y) {
            return None;
        }
        let (index_x, index_y) = self.pattern.index(id.x, id.y);
        let map = self.map();
        let [block_x, block_y] = [map.interval_of(index_x)?, map.interval_of(index_y)?];
        let line = self.line(id.x, index_x);
        (self.keeps(block_y)(&line)).then_some([block_x, block_y])
    }

    /// The rank of a point of the pattern; the greatest for other addresses.
    pub(crate) fn rank(&self, id: PointId) -> f64 {
        rank(&self.turned, &self.pattern, id)
    }

    /// The fixed-point place of an address, or `None` if it has no point.
    pub(crate) fn place(&self, id: PointId) -> Option<[i128; 2]> {
        let [block_x, block_y] = self.block(id)?;
        Some(self.displaced_place(id, self.vectors(block_y)[block_x]))
    }

    /// The fixed-point place of an address that has a point, with a displacement.
    fn displaced_place(&self, id: PointId, [dx, dy]: Displacement) -> [i128; 2] {
        let displaced = [fixed(id.x) + i128::from(dx), fixed(id.y) + i128::from(dy)];
        match &self.shears {
            Some(shears) => {
                let (mut near, origin) = NearShears::new(shears, displaced);
                let place = near.apply([0, 1].map(|i| (displaced[i] - origin[i]) as i64));
                [0, 1].map(|i| origin[i] + i128::from(place[i]))
            }
            None => displaced,
        }
    }

    /// The point of an address, or `None` if it has none.
    pub(crate) fn point(&self, id: PointId) -> Option<Point> {
        Some(self.point_at(id, self.place(id)?))
    }

    /// The point of an address that has one, with a displacement.
    pub(crate) fn displaced_point(&self, id: PointId, vector: Displacement) -> Point {
        self.point_at(id, self.displaced_place(id, vector))
    }

    fn point_at(&self, id: PointId, place: [i128; 2]) -> Point {
        let [x, y] = place.map(|k| self.world(k));
        Point { id, x, y }
    }

    /// The world coordinate of a fixed-point one. Monotone.
    #[inline]
    pub(crate) fn world(&self, fixed: i128) -> f64 {
        // Conversions from 64 bits are faster, and round alike.
        let fixed = match i64::try_from(fixed) {
            Ok(fixed) => fixed as f64,
            Err(_) => wide(fixed),
        };
        fixed * self.step
    }

    /// The largest absolute world coordinate of a region.
    pub(crate) fn limit(&self) -> f64 {
        self.world(fixed(LATTICE_LIMIT))
    }

    /// The least fixed-point coordinate whose world coordinate is ≥ `bound`, for a bound within the
    /// limit. Exact: a bisection on the conversion itself.
    pub(crate) fn first_at_or_above(&self, bound: f64) -> i128 {
        let reaches = |k: i128| self.world(k) >= bound;
        let guess = (bound / self.step) as i128;
        let mut width = 2i128;
        let (mut low, mut high) = (guess - 1, guess + 1);
        while reaches(low) {
            low -= width;
            width *= 2;
        }
        while !reaches(high) {
            high += width;
            width *= 2;
        }
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if reaches(middle) {
                high = middle
            } else {
                low = middle
            }
        }
        high
    }
}
