//! The lattice of a point set, laid into the world.

use super::{Placement, Point, PointId, rank::side_for};
use crate::{
    map::Map,
    pattern::{Axis, Class, Pattern},
    sample::warp::{NearShears, Shears, Stretch},
    table::{FRACTION_BITS, Table, Vectors, fixed},
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
    /// The table's vectors, turned by the seed's symmetry.
    vectors: Vectors,
    /// The pattern from the seed's origin, thinned to the share that is kept.
    pub(crate) pattern: Pattern,
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
        let shears = Shears::new(warp, seed);
        Self {
            placement,
            vectors: Vectors::new(&table, seed.symmetry()),
            pattern: Pattern::with_origin(alpha, seed.origin())
                .thinned(side_for(keep.get(), alpha.set_side())),
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

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn vectors(&self, block_y: usize) -> &[[i32; 2]] {
        self.vectors.row(block_y)
    }

    /// The least and the greatest displacement along an axis, without the warp.
    pub(crate) const fn table_reach(&self, axis: Axis) -> [i32; 2] {
        self.vectors.reach()[axis as usize]
    }

    /// The blocks of dX and dY of an address, or `None` if it has no point.
    pub(crate) fn block(&self, id: PointId) -> Option<[usize; 2]> {
        let within = -LATTICE_LIMIT..=LATTICE_LIMIT;
        if !within.contains(&id.x) || !within.contains(&id.y) || !self.pattern.contains(id.x, id.y)
        {
            return None;
        }
        let (index_x, index_y) = self.pattern.index(id.x, id.y);
        let map = self.map();
        Some([map.interval_of(index_x)?, map.interval_of(index_y)?])
    }

    /// The fixed-point place of an address, or `None` if it has no point.
    pub(crate) fn place(&self, id: PointId) -> Option<[i128; 2]> {
        let [block_x, block_y] = self.block(id)?;
        let [dx, dy] = self.vectors(block_y)[block_x];
        let displaced = [fixed(id.x) + i128::from(dx), fixed(id.y) + i128::from(dy)];
        Some(match &self.shears {
            Some(shears) => {
                let (mut near, origin) = NearShears::new(shears, displaced);
                let place = near.apply([0, 1].map(|i| (displaced[i] - origin[i]) as i64));
                [0, 1].map(|i| origin[i] + i128::from(place[i]))
            }
            None => displaced,
        })
    }

    /// The point of an address, or `None` if it has none.
    pub(crate) fn point(&self, id: PointId) -> Option<Point> {
        let [x, y] = self.place(id)?.map(|k| self.world(k));
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
