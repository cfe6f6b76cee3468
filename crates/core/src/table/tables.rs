//! Tables of displacement vectors, of the plane or of space.

use alloc::{sync::Arc, vec, vec::Vec};
use core::fmt;

use super::{Digest, Labels, Order, Parts, Provenance, Ranks, Vector, file};
use crate::{error::Error, map::Map, once::Once, pattern::Alpha};

/// The displacement vectors of one noise profile for one neighborhood map, with their history: a [`Table`](crate::Table) of the plane,
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
/// assert!(table.memory_bytes() > 8 * table.displacements().len());
/// assert_eq!(Table::from_bytes(&table.to_bytes())?, table);
///
/// let table = space::Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?;
/// assert_eq!(table.vectors().len(), table.map().intervals().pow(3));
/// assert_eq!(space::Table::from_bytes(&table.to_bytes())?, table);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone)]
pub struct TableOf<V: Vector>(Arc<Content<V>>);

struct Content<V: Vector> {
    parts: Parts<V>,
    digest: Digest,
    /// The order in which blocks leave.
    order: Order,
    /// The kinds of the points of each block.
    labels: Option<Labels>,
    /// The least squared distance between two points, once it has been computed.
    least_squared: Once<u64>,
    held: V::Held,
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
        let mix = parts.mix.as_ref();
        Self(Arc::new(Content {
            digest,
            order: Order::new(&parts.map, V::AXES, &ranks),
            least_squared: Once::new(),
            labels: mix.map(|mix| Labels::new(&parts.map, mix, |block| block)),
            held: V::held(&parts.vectors),
            parts,
        }))
    }

    /// A table without displacements: the AA pattern itself.
    ///
    /// # Errors
    /// As [`Table::new`](crate::Table::new), and [`ErrorKind::MapSize`](crate::ErrorKind::MapSize) if `radius` is too
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

    /// The kinds of the points of each block.
    pub(crate) fn labels(&self) -> Option<&Labels> {
        self.0.labels.as_ref()
    }

    /// About the memory that the table and some turned copies of it hold, in bytes.
    pub(super) fn memory_with(&self, copies: usize) -> usize {
        // A bound, a label and about two buckets for each interval.
        let map = 32 * self.map().intervals();
        let vectors = (1 + copies) * size_of_val(&self.parts().vectors[..]);
        let order = self.order().memory_bytes(copies);
        let mix = self.parts().mix.as_ref();
        let mix = mix.map_or(0, |mix| mix.memory_bytes(1 + copies));
        size_of::<Content<V>>() + vectors + order + mix + map + 4096
    }

    /// The parts of the table.
    pub(crate) fn parts(&self) -> &Parts<V> {
        &self.0.parts
    }

    /// What is derived from the vectors.
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
