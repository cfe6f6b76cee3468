//! The lattice of a point set, laid into the world.

use super::{Keep, Line, Placement, Point, PointId, rank};
use crate::{
    map::Map,
    pattern::{Axis, Class, Pattern},
    sample::warp::{Shears, Stretch},
    table::{Cut, FRACTION_BITS, Table, fixed},
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
    /// The pattern from the seed's origin.
    pub(crate) pattern: Pattern,
    /// Which of its points are kept, if not all.
    pub(crate) cut: Option<Cut>,
    pub(crate) shears: Option<Shears>,
    /// The bound of what the warp does to distances.
    pub(crate) stretch: Stretch,
    /// World units per fixed-point unit.
    pub(crate) step: f64,
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
        let shears = Shears::new(warp, seed, alpha.set_side_f64());
        Self {
            placement,
            pattern: Pattern::with_origin(alpha, seed.origin()),
            cut: (keep != Keep::ALL).then(|| table.order().cut(table.map(), keep.get())),
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
        let positions = self.table.order().positions(block_y * n..(block_y + 1) * n);
        move |line| {
            let position = positions[line.block as usize];
            self.cut.is_none_or(|cut| cut.keeps(position, line.is_in_strip))
        }
    }

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn vectors(&self, block_y: usize) -> &[[i32; 2]] {
        self.table.row(block_y)
    }

    /// The least and the greatest distance of a point from its lattice address along an axis, in
    /// fixed-point units.
    pub(crate) fn reach(&self, axis: Axis) -> [i32; 2] {
        let [least, most] = self.table.reach()[axis as usize];
        let warp = self.shears.map_or(0, |shears| shears.reach());
        [least - warp, most + warp]
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
        rank(&self.table, &self.pattern, id)
    }

    /// The point of an address, or `None` if it has none.
    pub(crate) fn point(&self, id: PointId) -> Option<Point> {
        let [block_x, block_y] = self.block(id)?;
        let [dx, dy] = self.vectors(block_y)[block_x];
        let displaced = [fixed(id.x) + i128::from(dx), fixed(id.y) + i128::from(dy)];
        let warped = match &self.shears {
            Some(shears) => shears.apply(displaced),
            None => displaced,
        };
        let [x, y] = warped.map(|k| self.world(k));
        Some(Point { id, x, y })
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
