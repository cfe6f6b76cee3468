//! The displacement table.

use alloc::{sync::Arc, vec, vec::Vec};
use core::{fmt, ops::Range};

use super::{
    Digest, Displacement, Labels, Mix, Order, Provenance, Ranks, file, parts::Parts,
    turned::PlaneParts, vector::Vector,
};
use crate::{error::Error, map::Map, once::Once, pattern::Alpha};

/// The displacement vectors of one noise profile for one neighborhood map, with their history: a [`Table`] of the plane,
/// or one of [points in space](crate::space::Table).
///
/// A table is immutable: its content has been checked, and its digest names it. Cloning shares the
/// content.
///
/// ```
/// use strew_core::{Table, space};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// assert_eq!(table.displacements().len(), table.map().intervals().pow(2));
/// assert_eq!(Table::from_bytes(&table.to_bytes())?, table);
///
/// let table = space::Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?;
/// assert_eq!(table.vectors().len(), table.map().intervals().pow(3));
/// assert_eq!(space::Table::from_bytes(&table.to_bytes())?, table);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone)]
pub struct TableOf<V: Vector>(Arc<Content<V>>);

/// The table of a point set of the plane, with a vector for each of the n² blocks of its map.
pub type Table = TableOf<Displacement>;

struct Content<V: Vector> {
    parts: Parts<V>,
    digest: Digest,
    /// The order in which blocks leave.
    order: Order,
    /// The least squared distance between two points, once it has been computed.
    least_squared: Once<u64>,
    held: V::Held,
}

impl Table {
    /// A table from its parts. `displacements` has n² vectors, row = interval of dY, column = interval
    /// of dX, in units of 2⁻²⁰ grid units.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a wrong number of vectors, a component of
    /// [`MAX_DISPLACEMENT`](super::MAX_DISPLACEMENT) or more, a profile name that is not 1 to 32 of
    /// `a-z 0-9 -`, or a history beyond the format's limits.
    ///
    /// ```
    /// use strew_core::{Map, Table, table::{Provenance, from_grid_units}};
    ///
    /// let map = Map::new("sqrt(3)".parse()?, 20)?;
    /// let n = map.intervals();
    /// // Every point moves by (0.5, −0.25) grid units.
    /// let vector = [0.5, -0.25].map(|v| from_grid_units(v).expect("short"));
    /// let table = Table::new(map, "moved", vec![vector; n * n], Provenance::default())?;
    /// assert_eq!(table.displacements().len(), n * n);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(
        map: Map,
        profile: &str,
        displacements: Vec<Displacement>,
        provenance: Provenance,
    ) -> Result<Self, Error> {
        let parts = Parts {
            map,
            profile: profile.into(),
            vectors: displacements,
            provenance,
            ranks: None,
            mix: None,
        };
        Self::of_parts(parts)
    }

    /// The α of the pattern that the table displaces.
    #[must_use]
    pub fn alpha(&self) -> Alpha {
        self.map().alpha()
    }

    /// All n² vectors, row = interval of dY, column = interval of dX, in units of 2⁻²⁰ grid units.
    #[must_use]
    pub fn displacements(&self) -> &[Displacement] {
        &self.0.parts.vectors
    }

    /// The kinds of the points of each block, or `None` if the table has none.
    #[must_use]
    pub fn mix(&self) -> Option<&Mix> {
        self.0.parts.mix.as_ref()
    }

    /// The ranks of the points of a block, in [0, 1]: below the start none of them is left, from the end
    /// on all are. Between them points leave in the order of their dX, the greatest first.
    ///
    /// ```
    /// use strew_core::Table;
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let blocks = 0..table.displacements().len();
    /// // The widths are the shares of points that blocks have.
    /// let all: f64 = blocks.map(|block| table.block_ranks(block)).map(|r| r.end - r.start).sum();
    /// assert!((all - 1.0).abs() < 1e-9);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    ///
    /// # Panics
    /// If there is no such block.
    #[must_use]
    pub fn block_ranks(&self, block: usize) -> Range<f64> {
        let order = self.order();
        order.floors(order.position(block))
    }

    /// The kinds of the points of each block.
    pub(crate) fn labels(&self) -> Option<&Labels> {
        self.held().labels.as_ref()
    }

    /// About the memory that the table may come to hold, in bytes: seeds turn it, and each of the eight
    /// ways has a copy of the vectors and their order once it is used.
    ///
    /// ```
    /// use strew_core::Table;
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// // Mostly the vectors, of 8 bytes each.
    /// assert!(table.memory_bytes() > 8 * table.displacements().len());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        // A bound, a label and about two buckets for each interval.
        let map = 32 * self.map().intervals();
        let copies = PlaneParts::COPIES;
        let vectors = (1 + copies) * size_of_val(self.displacements());
        let order = self.0.order.memory_bytes(copies);
        let mix = self.mix().map_or(0, |mix| mix.memory_bytes(1 + copies));
        size_of::<Content<Displacement>>() + vectors + order + mix + map + 4096
    }
    /// The least squared distance of each pair of kinds, computed once.
    pub(crate) fn least_of_kinds(&self, compute: impl FnOnce() -> Arc<[u64]>) -> Arc<[u64]> {
        self.held().least_of_kinds.get_or(compute)
    }
}

impl<V: Vector> TableOf<V> {
    /// A table of parts to check.
    pub(crate) fn of_parts(parts: Parts<V>) -> Result<Self, Error> {
        parts.check()?;
        let digest = file::digest(&parts)?;
        Ok(Self::checked(parts, digest))
    }

    /// A table of checked parts.
    fn checked(parts: Parts<V>, digest: Digest) -> Self {
        let hashed = || Ranks::hashed(parts.vectors.len());
        let ranks = parts.ranks.clone().unwrap_or_else(hashed);
        Self(Arc::new(Content {
            digest,
            order: Order::new(&parts.map, V::AXES, &ranks),
            least_squared: Once::new(),
            held: V::held(&parts),
            parts,
        }))
    }

    /// A table without displacements: the AA pattern itself.
    ///
    /// # Errors
    /// As [`Table::new`], and [`ErrorKind::MapSize`](crate::ErrorKind::MapSize) if `radius` is too
    /// large.
    pub fn undisplaced(alpha: Alpha, radius: u32, profile: &str) -> Result<Self, Error> {
        let map = Map::new(alpha, radius)?;
        let provenance = Provenance {
            optimizer: "none".into(),
            ..Provenance::default()
        };
        Self::of_parts(Parts {
            vectors: vec![V::default(); Parts::<V>::blocks(&map)],
            map,
            profile: profile.into(),
            provenance,
            ranks: None,
            mix: None,
        })
    }

    /// Reads a table file and checks everything in it.
    ///
    /// # Errors
    /// One of the `Table…` kinds, [`ErrorKind::Alpha`](crate::ErrorKind::Alpha) or
    /// [`ErrorKind::MapSize`](crate::ErrorKind::MapSize), naming the part of the file that is wrong.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let (parts, digest) = file::read(bytes)?;
        Ok(Self::checked(parts, digest))
    }

    /// The table as a file. Equal tables have equal bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        file::write(&self.0.parts)
    }

    /// This table with an order in which its blocks leave.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) unless there is a position for each block.
    ///
    /// ```
    /// use strew_core::{Table, table::Ranks};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let blocks = table.displacements().len() as u32;
    /// let ranked = table.with_ranks(Ranks::new((0..blocks).rev().collect())?)?;
    /// assert_eq!(ranked.displacements(), table.displacements());
    /// assert_ne!(ranked.digest(), table.digest());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_ranks(&self, ranks: Ranks) -> Result<Self, Error> {
        let mut parts = self.parts().clone();
        parts.ranks = Some(ranks);
        Self::of_parts(parts)
    }

    /// The neighborhood map whose blocks the vectors belong to.
    #[must_use]
    pub fn map(&self) -> &Map {
        &self.0.parts.map
    }

    /// The name of the noise profile: 1 to 32 characters of a-z, 0-9 and -.
    #[must_use]
    pub fn profile(&self) -> &str {
        &self.0.parts.profile
    }

    /// The history of the table: its making and its measurements.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.0.parts.provenance
    }

    /// The BLAKE3 digest of the file without its last 32 bytes, which hold it. It names the table.
    #[must_use]
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    /// The order in which blocks leave when a set is thinned, or `None` if the table has none. Blocks
    /// then leave in a hashed order, which is no more even than a random choice.
    #[must_use]
    pub fn ranks(&self) -> Option<&Ranks> {
        self.0.parts.ranks.as_ref()
    }

    /// The order in which blocks leave, a hashed one for a table without ranks.
    pub(crate) fn order(&self) -> &Order {
        &self.0.order
    }

    /// The parts of the table.
    pub(crate) fn parts(&self) -> &Parts<V> {
        &self.0.parts
    }

    /// What the table holds beside its parts.
    pub(crate) fn held(&self) -> &V::Held {
        &self.0.held
    }

    /// The result of `compute` when it was first called.
    pub(crate) fn least_squared(&self, compute: impl FnOnce() -> u64) -> u64 {
        self.0.least_squared.get_or(compute)
    }
}

impl<V: Vector> fmt::Debug for TableOf<V> {
    /// Names the table; its vectors would fill pages.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Table")
            .field("profile", &self.profile())
            .field("alpha", &format_args!("{}", self.map().alpha()))
            .field("map", &format_args!("{}", self.map().size()))
            .field("digest", &self.digest())
            .finish()
    }
}

impl<V: Vector> PartialEq for TableOf<V> {
    fn eq(&self, other: &Self) -> bool {
        self.digest() == other.digest() && self.0.parts == other.0.parts
    }
}
