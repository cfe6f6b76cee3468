//! The point set, and single points of it: by id, and near a place.

use alloc::{sync::Arc, vec::Vec};

use super::{
    Cursor, Member, Neighbor, Region, Volume, clearance,
    lattice::Lattice,
    mask::{Mask, Other},
    plan::Plan,
    point::PointId,
    table::Table,
};
use crate::{
    LeastDistance,
    error::Error,
    lattice::{Keep, Placement, Spacing, seed::Seed},
    methods::{placing, requested},
    near::{
        Visits, limits,
        search::{self, Searched},
    },
    plan::amount::{Sought, exactly},
    stop::Stop,
    warp::Warp,
};

#[cfg(feature = "fields")]
use crate::{field::Field, lattice::Grade};

/// An unbounded set of points in space: a table at a spacing, with a seed and a warp.
///
/// No point is stored. A point is a pure function of these parameters and its lattice address, so equal sets have equal
/// points, in whatever place and order a program requests them.
///
/// A set is made from a table, with mean spacing 1 and seed 0; methods that take `self` change that. Sets are cheap to
/// clone and can be shared between threads.
///
#[cfg_attr(feature = "tables", doc = "```")]
#[cfg_attr(not(feature = "tables"), doc = "```ignore")]
/// use strew_core::space::SpaceSet;
/// # fn spawn(_: strew_core::space::PointId, _: [f64; 3], _: [f64; 4]) {}
///
/// let rocks = SpaceSet::blue().spacing(4.0)?.seed(7);
/// for p in rocks.chunk(32.0, [3, -2, 0])? {
///     spawn(p.id(), p.at(), p.rotation());
/// }
/// let near = rocks.nearest([10.0, 3.0, 5.0], 5)?;
/// assert_eq!(rocks.point(near[0].member.id()), Some(near[0].member));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SpaceSet {
    pub(super) lattice: Lattice,
    pub(super) mask: Mask,
    /// Whether the warp was chosen, and so stays when the seed changes.
    has_own_warp: bool,
}

impl SpaceSet {
    /// The set of a table, with mean spacing 1 and seed 0.
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self {
            lattice: Lattice::new(table, Placement::new(Spacing::ONE, Seed(0))),
            mask: Mask::default(),
            has_own_warp: false,
        }
    }

    /// The blue-noise set of the table built into the crate (feature `tables`).
    #[cfg(feature = "tables")]
    #[must_use]
    pub fn blue() -> Self {
        Self::new(super::shipped::blue())
    }

    /// The set of a table file.
    ///
    /// # Errors
    /// As [`Table::from_bytes`].
    pub fn from_table(bytes: &[u8]) -> Result<Self, Error> {
        Table::from_bytes(bytes).map(Self::new)
    }

    /// The set in a field: the share of its points varies from place to place. The field replaces an earlier one, and
    /// [`keep`](Self::keep) multiplies its shares. A point belongs to the set if its rank is below the share at its place;
    /// counting visits them one by one where bounds of the field leave any.
    ///
    /// ```
    /// use strew_core::{field::{FieldSpec, Noise}, space::{SpaceSet, Table}};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let cloud = FieldSpec::radial([16.0, 16.0, 16.0], [4.0, 16.0], [1.0, 0.0])?;
    /// let patches = FieldSpec::noise(Noise { seed: 1, wavelength: 9.0, octaves: 2, range: [0.0, 1.0] })?;
    /// let droplets = set.in_field(FieldSpec::multiply(vec![cloud, patches])?);
    /// let plan = droplets.chunk(32.0, [0, 0, 0])?;
    /// assert!((1000..5000).contains(&plan.count()));
    /// assert!(plan.iter().all(|point| droplets.point(point.id()) == Some(point)));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[cfg(feature = "fields")]
    #[must_use]
    pub fn in_field(&self, field: impl Field<3> + 'static) -> Self {
        let mut set = self.clone();
        let share = set.lattice.placement.graded();
        set.lattice.grade = Some(Grade::new(Arc::new(field), share));
        set
    }

    /// The points in a volume.
    ///
    /// A box without warp is counted in a fraction of a millisecond, whatever it holds; all else in time proportional to
    /// its surface.
    ///
    /// # Errors
    /// [`ErrorKind::TooFar`](crate::ErrorKind::TooFar) if the volume reaches beyond [`LATTICE_LIMIT`](super::LATTICE_LIMIT) at this spacing,
    /// [`ErrorKind::Unbounded`](crate::ErrorKind::Unbounded) if it is not bounded.
    pub fn within(&self, volume: impl Into<Volume>) -> Result<Plan, Error> {
        self.within_until(volume, Stop::default())
    }

    /// The points in a volume, whose counting stops once a flag is raised.
    ///
    /// # Errors
    /// As [`within`](Self::within), and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
    pub fn within_until(&self, volume: impl Into<Volume>, stop: Stop) -> Result<Plan, Error> {
        Plan::new(&self.lattice, &self.mask, volume.into(), stop, None)
    }

    /// Exactly `count` points in a volume, at the spacing that takes, whatever the set's: see
    /// [`PointSet::exactly`](crate::PointSet::exactly). No spacing below `least` is tried, and counting stops once a flag is
    /// raised.
    ///
    /// # Errors
    /// As [`within_until`](Self::within_until), [`ErrorKind::Count`](crate::ErrorKind::Count) where no spacing has this
    /// count, and [`ErrorKind::TooDense`](crate::ErrorKind::TooDense) where it takes one below `least`.
    ///
    /// ```
    /// use strew_core::{server::Stop, space::{Ball, SpaceSet, Table}};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let plan = set.exactly(1000, Ball::new([5.0; 3], 2.0)?, 0.0, &Stop::default())?;
    /// assert_eq!(plan.count(), 1000);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn exactly(
        &self,
        count: u128,
        volume: impl Into<Volume>,
        least: f64,
        stop: &Stop,
    ) -> Result<Plan, Error> {
        let volume = volume.into();
        let sought = Sought {
            count,
            bounds: self.mask.narrowed(&volume).bounds(),
            least,
            grade: self.lattice.grade.as_ref(),
            share: match &self.lattice.grade {
                Some(_) => 1.0,
                None => self.placement().shown(),
            },
        };
        exactly(&sought, |spacing| {
            let trial = self.clone().at_spacing(spacing);
            trial.within_until(volume.clone(), stop.clone())
        })
    }

    /// The number of steps by which points settle.
    #[must_use]
    pub fn steps(&self) -> u32 {
        let settling = self.lattice.settling();
        settling.map_or(0, |(settle, _)| settle.steps())
    }

    /// The distance that no two points of the set are nearer than, in world units; with warp it is a bound. It is 0 in
    /// fields, where points settle.
    #[must_use]
    pub fn least_distance(&self) -> f64 {
        if self.lattice.grade.is_some() && self.lattice.settling().is_some() {
            return 0.0;
        }
        let Placement { spacing, warp, .. } = self.lattice.placement;
        self.table_distance().with_warp(warp) * spacing.get()
    }

    fn table_distance(&self) -> LeastDistance {
        self.table().least_distance()
    }
}

requested!(
    SpaceSet,
    Volume,
    "space::Region",
    Cursor,
    3,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?)",
    "[0, 0, 0]",
    "[10.0, 3.0, 5.0]"
);
placing!(
    SpaceSet, Table, power: "⅓", 3,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?)",
    "[0, 0, 0]"
);

impl SpaceSet {
    /// The point of an id, or `None` if the set has none there.
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Member> {
        let point = clearance::point(&self.lattice, &self.mask, id)?;
        Some(Member::new(point, self.placement().seed))
    }

    /// The intervals of the three indices of a point, or `None` if the lattice has no point there.
    #[must_use]
    pub fn block(&self, id: PointId) -> Option<[usize; 3]> {
        self.lattice.block(id)
    }
}
