//! The displacement table of the plane.

use alloc::{format, string::String, sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    Displacement, FRACTION_BITS, MAX_DISPLACEMENT, Mix, Provenance, TableOf,
    parts::{Parts, Vector},
    symmetry::Held,
    to_grid_units,
};
use crate::{
    error::{Error, number},
    map::Map,
    pattern::Alpha,
};

/// The table of a point set of the plane, with a vector for each of the n² blocks of its map.
pub type Table = TableOf<Displacement>;

impl Vector for Displacement {
    const AXES: u32 = 2;
    const SECTION: [u8; 4] = *b"DISP";
    const FOREIGN: &[([u8; 4], &str)] = &[
        (*b"CUBE", "a table of points in space"),
        (
            *b"BASE",
            "labels of another table: Table::with_labels reads them",
        ),
    ];
    type Held = Held;

    fn held(vectors: &[Self]) -> Held {
        Held::new(vectors)
    }

    fn too_long(&self) -> Option<[String; 2]> {
        let limit = (MAX_DISPLACEMENT as i32) << FRACTION_BITS;
        self.iter().any(|v| !(-limit < *v && *v < limit)).then(|| {
            let [x, y] = self.map(|v| number(to_grid_units(v)));
            let most = number(MAX_DISPLACEMENT);
            [
                format!("({x}, {y})"),
                format!("less than {most} grid units along an axis"),
            ]
        })
    }

    fn read(bytes: &[u8]) -> Self {
        let (numbers, _) = bytes.as_chunks();
        [0, 1].map(|axis| i32::from_le_bytes(numbers[axis]))
    }

    fn write(&self, section: &mut Vec<u8>) {
        section.extend(self.iter().flat_map(|v| v.to_le_bytes()));
    }
}

impl Table {
    /// A table from its parts. `displacements` has n² vectors, row = interval of dY, column = interval
    /// of dX, in units of 2⁻²⁰ grid units.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a wrong number of vectors, a component of
    /// [`MAX_DISPLACEMENT`](super::MAX_DISPLACEMENT) or more, a profile name that is not 1 to 32 of
    /// `a-z 0-9 -`, or a history beyond the format's limits.
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
        &self.parts().vectors
    }

    /// The kinds of the points of each block, or `None` if the table has none.
    #[must_use]
    pub fn mix(&self) -> Option<&Mix> {
        self.parts().mix.as_ref()
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

    /// About the memory that the table may come to hold, in bytes: seeds turn it, and each of the eight
    /// ways has a copy of the vectors and their order once it is used.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.memory_with(Held::COPIES)
    }

    /// The least squared distance of each pair of kinds, computed once.
    pub(crate) fn least_of_kinds(&self, compute: impl FnOnce() -> Arc<[u64]>) -> Arc<[u64]> {
        self.held().least_of_kinds.get_or(compute)
    }
}
