//! Periodic sets: one exact period of points that tiles the plane.
//!
//! A [twin](crate::map::Twin) of a map is an AA pattern with a period whose points fall into the map's blocks.
//! So a table makes the same point set of it, on a torus: every point has the neighbors it has in the plane,
//! also across the seam. Indices are integers in units of 1/(2q), and positions wrap in fixed point.

mod parts;
mod plan;
mod torus;
pub use plan::{PeriodicBlocks, PeriodicPlan};

use alloc::{sync::Arc, vec::Vec};

use crate::{
    error::{Error, ErrorKind, number},
    lattice::{Grade, Keep, Placement, PointId, Settle, seed::Seed},
    map::{Map, Twin},
    table::{Table, TurnedTable},
    warp::{Warp, Waves, WrappedShears},
};

/// A point set with a period: the points of [0, L)² whose copies, moved by multiples of the side L, continue
/// one another without a seam. It has the table's noise profile; for tileable textures, masks and stipples.
///
/// ```
/// use strew_core::{PeriodicSet, Table};
///
/// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// // The least period of at least 5000 points, on a torus with a side of 1.
/// let tile = PeriodicSet::new(table, 5000)?.side(1.0)?.seed(7);
/// assert_eq!(tile.iter().count(), 5041);
/// assert!(tile.iter().all(|p| p.at().iter().all(|v| (0.0..1.0).contains(v))));
/// # Ok::<(), strew_core::Error>(())
/// ```
///
/// A seed turns the table, moves the pattern, and warps it by shears whose knots wrap. Attributes and ranks
/// are functions of seed and id, as in other sets, and a field that has the same period stays seamless.
#[derive(Clone, Debug)]
pub struct PeriodicSet {
    table: Table,
    twin: Twin,
    /// The block of each index, ascending.
    blocks: Arc<[u32]>,
    side: f64,
    seed: Seed,
    /// The warp that was chosen, if any.
    own_warp: Option<Warp>,
    /// The part of the points that it has.
    parts: Parts,
    made: Arc<Made>,
}

impl PeriodicSet {
    /// The largest number of points in a period.
    pub const MAX_POINTS: u64 = 1 << 32;

    /// The set of the smallest period that has at least `points` points, with mean spacing 1 and seed 0. A
    /// map has periods of particular [sizes](Self::periods) only.
    ///
    /// # Errors
    /// [`ErrorKind::Period`] if the map has no period of that size up to [`MAX_POINTS`](Self::MAX_POINTS)
    /// points. A map has none at all if its thresholds coincide, as they do at small fractions α.
    pub fn new(table: Table, points: u64) -> Result<Self, Error> {
        let refused = |allowed| Error::new(ErrorKind::Period, "periodic", points, allowed);
        if points > Self::MAX_POINTS {
            let allowed = alloc::format!("at most {} points", Self::MAX_POINTS);
            return Err(refused(allowed).with_limit(Self::MAX_POINTS as f64));
        }
        let twin = Self::periods_from(table.map(), points).next();
        let Some(twin) = twin else {
            let allowed =
                "left out, or the table one of an α at which no thresholds of its map coincide";
            let problem = alloc::format!(
                "the map of α = {} and R = {} has no such period",
                table.alpha(),
                table.map().radius()
            );
            return Err(refused(allowed.into()).because(problem));
        };
        Ok(Self::of_twin(table, twin))
    }

    /// The set of a period of the table's map.
    fn of_twin(table: Table, twin: Twin) -> Self {
        let blocks: Arc<[u32]> = twin.blocks(table.map()).into();
        Self {
            made: Arc::new(Made::new(&table, twin, Seed(0), Warp::OFF)),
            side: twin.t() as f64,
            seed: Seed(0),
            own_warp: None,
            parts: Parts::default(),
            table,
            twin,
            blocks,
        }
    }

    /// The periods of a map with at most [`MAX_POINTS`](Self::MAX_POINTS) points, smallest first: its twins in
    /// which every block has points in proportion to its area.
    pub fn periods(map: &Map) -> impl Iterator<Item = Twin> + use<> {
        Self::periods_from(map, 0)
    }

    /// The [periods](Self::periods) of a map with at least `points` points.
    ///
    /// ```
    /// use strew_core::{Map, PeriodicSet};
    ///
    /// let map = Map::new("(5-sqrt(3))/2".parse()?, 49)?;
    /// let twin = PeriodicSet::periods_from(&map, 1_000_000).next().expect("a period");
    /// assert_eq!((twin.points(), twin.to_string().as_str()), (1_002_001, "2580/1579"));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn periods_from(map: &Map, points: u64) -> impl Iterator<Item = Twin> + use<> {
        let least = points.saturating_sub(1).isqrt();
        map.twins_within(least..Self::MAX_POINTS.isqrt() + 1)
            .filter(move |twin| twin.points() >= points && twin.is_uniform())
    }

    /// This set on a torus with another side L, in world units.
    ///
    /// # Errors
    /// [`ErrorKind::Period`] unless it is a number from 10⁻¹⁰⁰ to 10¹⁰⁰.
    pub fn side(mut self, side: f64) -> Result<Self, Error> {
        if !(1e-100..=1e100).contains(&side) {
            let allowed = "a number from 1e-100 to 1e100";
            let value = number(side);
            return Err(Error::new(ErrorKind::Period, "side", value, allowed));
        }
        self.side = side;
        Ok(self)
    }

    /// The set of another seed. Unless a [warp](Self::warp) was chosen, it is off for seed 0 and on for all
    /// others.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = Seed(seed);
        self.remade()
    }

    /// The set with another strength of the warp, from 0 (off) to 2.
    ///
    /// # Errors
    /// As [`Warp::new`].
    pub fn warp(mut self, strength: f64) -> Result<Self, Error> {
        self.own_warp = Some(Warp::new(strength)?);
        Ok(self.remade())
    }

    fn remade(mut self) -> Self {
        let warp = self.own_warp.unwrap_or(Placement::default_warp(self.seed));
        self.made = Arc::new(Made::new(&self.table, self.twin, self.seed, warp));
        self
    }

    /// The twin whose period this is. Ids are lattice addresses from 0 up to its
    /// [`period`](Twin::period).
    #[must_use]
    pub const fn twin(&self) -> Twin {
        self.twin
    }

    /// The number of points in a period, before any [are left out](Self::count).
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a period has points")]
    pub const fn len(&self) -> u64 {
        self.twin.points()
    }

    /// The side L of the period, in world units.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.side
    }

    /// The table whose vectors displace the points.
    #[must_use]
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// The parity of the columns that have points in a row, with dY there; `None` for a row without points.
    fn row(&self, y: u64) -> Option<(u64, u64)> {
        let index_y = |parity: u64| self.made.index_y(self.twin, parity, y);
        (0..2).find_map(|parity| Some((parity, index_y(parity)?)))
    }

    /// The columns of a row, with their dX.
    fn columns(&self, y: u64, parity: u64) -> &[(u64, u64)] {
        let [row, column] = [y, parity].map(|v| (v % 2) as usize);
        &self.made.columns[row][column]
    }

    /// The block of a point, as its intervals of dX and dY, or `None` if no point has the id.
    #[must_use]
    pub fn block(&self, id: PointId) -> Option<[usize; 2]> {
        let (_, index) = self.indices(id)?;
        Some(index.map(|index| self.blocks[index as usize] as usize))
    }

    /// The address of an id and its indices, if it is a point of the period.
    fn indices(&self, id: PointId) -> Option<([u64; 2], [u64; 2])> {
        let coordinate = |v: i64| u64::try_from(v).ok().filter(|&v| v < self.twin.period());
        let (x, y) = (coordinate(id.x)?, coordinate(id.y)?);
        let index_x = self.made.index_x(self.twin, x, y)?;
        Some(([x, y], [index_x, self.made.index_y(self.twin, x, y)?]))
    }
}

/// The parts of a period that a set has.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) keep: Keep,
    pub(super) settle: Settle,
    pub(super) lod: Keep,
    pub(super) kind: Option<u8>,
    /// The field, whose shares are those of the whole set.
    pub(super) field: Option<Grade>,
}

/// The parts of a periodic set that follow from the seed and the warp.
#[derive(Debug)]
pub(super) struct Made {
    pub(super) turned: TurnedTable,
    pub(super) shears: Option<WrappedShears>,
    /// The index of column and row 0.
    origin: [u64; 2],
    /// The columns inside the set region with their indices, by the parities of row and column.
    pub(super) columns: [[Vec<(u64, u64)>; 2]; 2],
}

impl Made {
    pub(super) fn new(table: &Table, twin: Twin, seed: Seed, warp: Warp) -> Self {
        let origin = seed.origin();
        let scaled = |v: u64| ((u128::from(v) * u128::from(twin.period())) >> 64) as u64;
        let mut made = Self {
            turned: TurnedTable::new(table, seed.symmetry()),
            shears: WrappedShears::new(Waves::of(table.profile()), warp, seed, twin.period()),
            origin: [scaled(origin.x), scaled(origin.y)],
            columns: Default::default(),
        };
        let listed = |y: u64, parity: u64| {
            let columns = (parity..twin.period()).step_by(2);
            columns
                .filter_map(|x| Some((x, made.index_x(twin, x, y)?)))
                .collect()
        };
        made.columns = [0, 1].map(|y| [0, 1].map(|parity| listed(y, parity)));
        made
    }

    /// dX of an address, in units of 1/(2q), if it is inside the set region.
    pub(super) fn index_x(&self, twin: Twin, x: u64, y: u64) -> Option<u64> {
        let index = (twin.index(x, y % 2) + self.origin[0]) % twin.period();
        (index < twin.t()).then_some(index)
    }

    /// dY of an address, likewise.
    pub(super) fn index_y(&self, twin: Twin, x: u64, y: u64) -> Option<u64> {
        let index = (twin.index(y, x % 2) + self.origin[1]) % twin.period();
        (index < twin.t()).then_some(index)
    }
}
