//! The displacement table of points in space.

use alloc::{string::String, sync::Arc, vec, vec::Vec};
use core::fmt;

use super::symmetry::Symmetry;
use crate::{
    error::Error,
    map::Map,
    once::Once,
    pattern::Alpha,
    sample::space::PICKS,
    table::{CubeParts, Digest, FRACTION_BITS, Order, Provenance, Ranks},
};

/// Fraction bits of the components of a vector: a unit is 2⁻¹² grid units.
const VECTOR_BITS: u32 = 12;
/// The bits from a unit of a vector to a fixed-point unit.
const FINER: u32 = FRACTION_BITS - VECTOR_BITS;

/// The displacement vectors of points in space, one for each of the n³ blocks of a neighborhood map, with their
/// history. A block (i, j, k) has the points whose dX, dY and dZ lie in the intervals i, j and k of the map.
///
/// A table is immutable: its content has been checked, and its digest names it. Cloning shares the content.
///
/// ```
/// use strew_core::space::Table;
///
/// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 5, "pattern")?;
/// assert_eq!(table.vectors().len(), table.map().intervals().pow(3));
/// assert_eq!(Table::from_bytes(&table.to_bytes())?, table);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone)]
pub struct Table(Arc<Content>);

struct Content {
    parts: CubeParts,
    digest: Digest,
    order: Order,
    turned: [Once<Arc<Turned>>; Symmetry::ALL],
    /// The least squared distance between two points, once it has been computed.
    pub(super) least_squared: Once<u64>,
}

/// A table turned by a symmetry.
#[derive(Debug)]
pub(super) struct Turned {
    /// The components of the vectors along each axis, in fixed-point units, and [`PICKS`] zeros.
    pub(super) vectors: [Vec<i32>; 3],
    /// Those along x of blocks in the order (k·n + i)·n + j, once they are needed.
    columns: Once<Arc<[i32]>>,
    /// The order in which blocks leave.
    pub(super) order: Order,
    /// The least and the greatest component of the vectors along each axis.
    pub(super) reach: [[i32; 2]; 3],
}

impl Table {
    /// A table from its parts. Block (i, j, k) has vector number (k·n + j)·n + i, in units of 2⁻¹² grid units: a
    /// component reaches 8 grid units, 2.5 mean spacings at the default α.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a wrong number of vectors or ranks, a component of −2¹⁵, a
    /// profile name that is not 1 to 32 of `a-z 0-9 -`, or a history beyond the format's limits.
    ///
    /// ```
    /// use strew_core::{Map, space::Table, table::Provenance};
    ///
    /// let map = Map::new("sqrt(3)".parse()?, 5)?;
    /// let blocks = map.intervals().pow(3);
    /// // Every point moves by half a grid unit along x.
    /// let vectors = vec![[1 << 11, 0, 0]; blocks];
    /// let table = Table::new(map, "moved", vectors, Provenance::default(), None)?;
    /// assert_eq!(table.profile(), "moved");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(
        map: Map,
        profile: &str,
        vectors: Vec<[i16; 3]>,
        provenance: Provenance,
        ranks: Option<Ranks>,
    ) -> Result<Self, Error> {
        let profile = String::from(profile);
        let parts = CubeParts {
            map,
            profile,
            vectors,
            provenance,
            ranks,
        };
        parts.check()?;
        let digest = parts.digest()?;
        Ok(Self::checked(parts, digest))
    }

    /// A table of checked parts.
    fn checked(parts: CubeParts, digest: Digest) -> Self {
        let hashed = || Ranks::hashed(parts.vectors.len());
        let ranks = parts.ranks.clone().unwrap_or_else(hashed);
        let order = Order::weighted(&ranks, all(&parts.map), |block| size(&parts.map, block));
        Self(Arc::new(Content {
            parts,
            digest,
            order,
            turned: [const { Once::new() }; Symmetry::ALL],
            least_squared: Once::new(),
        }))
    }

    /// A table without displacements: the pattern itself.
    ///
    /// # Errors
    /// As [`new`](Self::new), and [`ErrorKind::MapSize`](crate::ErrorKind::MapSize) if `radius` is too large.
    pub fn undisplaced(alpha: Alpha, radius: u32, profile: &str) -> Result<Self, Error> {
        let map = Map::new(alpha, radius)?;
        let vectors = vec![[0; 3]; map.intervals().pow(3)];
        let provenance = Provenance {
            optimizer: "none".into(),
            ..Provenance::default()
        };
        Self::new(map, profile, vectors, provenance, None)
    }

    /// Reads a table file and checks everything in it.
    ///
    /// # Errors
    /// One of the `Table…` kinds of [`ErrorKind`](crate::ErrorKind), `Alpha` or `MapSize`, naming the part of the file
    /// that is wrong.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let (parts, digest) = CubeParts::read(bytes)?;
        Ok(Self::checked(parts, digest))
    }

    /// The table as a file. Equal tables have equal bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.0.parts.write()
    }

    /// This table with an order in which its blocks leave.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) unless there is a position for each block.
    ///
    /// ```
    /// use strew_core::{space::Table, table::Ranks};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?;
    /// let order = Ranks::new((0..table.vectors().len() as u32).collect())?;
    /// assert!(table.with_ranks(order)?.ranks().is_some());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_ranks(&self, ranks: Ranks) -> Result<Self, Error> {
        let CubeParts {
            map,
            profile,
            vectors,
            provenance,
            ..
        } = self.0.parts.clone();
        Self::new(map, &profile, vectors, provenance, Some(ranks))
    }

    /// The map whose intervals, the same along all axes, make the blocks.
    #[must_use]
    pub fn map(&self) -> &Map {
        &self.0.parts.map
    }

    /// The name of the noise profile: 1 to 32 characters of a-z, 0-9 and -.
    #[must_use]
    pub fn profile(&self) -> &str {
        &self.0.parts.profile
    }

    /// All n³ vectors, in units of 2⁻¹² grid units; see [`new`](Self::new).
    #[must_use]
    pub fn vectors(&self) -> &[[i16; 3]] {
        &self.0.parts.vectors
    }

    /// The history of the table: its making and its measurements.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.0.parts.provenance
    }

    /// The order in which blocks leave, if the table has one.
    #[must_use]
    pub fn ranks(&self) -> Option<&Ranks> {
        self.0.parts.ranks.as_ref()
    }

    /// The BLAKE3 digest of the file without its last 32 bytes, which hold it. It names the table.
    #[must_use]
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    /// The table turned by a symmetry.
    pub(super) fn turned(&self, symmetry: Symmetry) -> Arc<Turned> {
        self.0.turned[symmetry.number()].get_or(|| Arc::new(Turned::new(self, symmetry)))
    }

    /// All vectors, in fixed-point units.
    pub(crate) fn fixed_vectors(&self) -> Vec<[i32; 3]> {
        let fixed = |vector: &[i16; 3]| vector.map(|v| i32::from(v) << FINER);
        self.vectors().iter().map(fixed).collect()
    }

    /// The least squared distance between two points, from `compute` if it is not known yet.
    pub(crate) fn least_squared(&self, compute: impl FnOnce() -> u64) -> u64 {
        self.0.least_squared.get_or(compute)
    }
}

/// The size of a block: the product of the lengths of its intervals, each rounded down to 2²⁴ units.
fn size(map: &Map, block: usize) -> u128 {
    let n = map.intervals();
    let length = |i: usize| {
        let interval = map.interval(i);
        u128::from((interval.end - interval.start) >> 24)
    };
    length(block % n) * length(block / n % n) * length(block / (n * n))
}

/// The sum of the sizes of all blocks.
fn all(map: &Map) -> u128 {
    (0..map.intervals().pow(3))
        .map(|block| size(map, block))
        .sum()
}

impl Turned {
    fn new(table: &Table, symmetry: Symmetry) -> Self {
        let n = table.map().intervals();
        let source = |block: usize| {
            let [i, j, k] = symmetry.source(n, [block % n, block / n % n, block / (n * n)]);
            (k * n + j) * n + i
        };
        let vector = |block: usize| {
            let vector = symmetry.turn(table.vectors()[source(block)]);
            vector.map(|v| i32::from(v) << FINER)
        };
        let mut vectors = [const { Vec::new() }; 3];
        vectors
            .iter_mut()
            .for_each(|list| list.reserve_exact(n.pow(3)));
        for block in 0..n.pow(3) {
            for (list, v) in vectors.iter_mut().zip(vector(block)) {
                list.push(v);
            }
        }
        let reach = vectors.each_ref().map(|list| {
            let ends = |[least, most]: [i32; 2], &v: &i32| [least.min(v), most.max(v)];
            list.iter().fold([i32::MAX, i32::MIN], ends)
        });
        vectors
            .iter_mut()
            .for_each(|list| list.resize(n.pow(3) + PICKS, 0));
        let order = table.0.order.turned(source);
        Self {
            vectors,
            columns: Once::new(),
            order,
            reach,
        }
    }

    /// The vector of a block.
    pub(super) fn vector(&self, block: usize) -> [i32; 3] {
        [0, 1, 2].map(|axis| self.vectors[axis][block])
    }

    /// The components along x, those of blocks that differ along y one after another.
    pub(super) fn columns(&self, n: usize) -> Arc<[i32]> {
        let place = |at: usize| (at / (n * n) * n + at % n) * n + at / n % n;
        let make = || (0..n.pow(3)).map(|at| self.vectors[0][place(at)]).collect();
        self.columns.get_or(make)
    }
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        self.0.digest == other.0.digest
    }
}

impl fmt::Debug for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Table")
            .field("profile", &self.profile())
            .field("map", &self.map().size())
            .field("digest", &self.digest())
            .finish()
    }
}
