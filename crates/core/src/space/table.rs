//! The displacement table of points in space.

use alloc::{format, string::String, sync::Arc, vec::Vec};

use crate::{
    error::Error,
    kernel::PICKS,
    map::Map,
    once::Once,
    table::{FRACTION_BITS, Order, Parts, Provenance, Ranks, Symmetry, TableOf, Vector},
};

/// Fraction bits of the components of a vector: a unit is 2⁻¹² grid units.
const VECTOR_BITS: u32 = 12;
/// The bits from a unit of a vector to a fixed-point unit.
const FINER: u32 = FRACTION_BITS - VECTOR_BITS;

/// The table of points in space, with a vector for each of the n³ blocks of its map. A block (i, j, k) has the points
/// whose dX, dY and dZ lie in the intervals i, j and k of the map.
pub type Table = TableOf<[i16; 3]>;

impl Vector for [i16; 3] {
    const AXES: u32 = 3;
    const SECTION: [u8; 4] = *b"CUBE";
    const FOREIGN: &[([u8; 4], &str)] = &[
        (*b"DISP", "not of a table of points in space"),
        (*b"kind", "not of a table of points in space"),
    ];
    type Held = Copies;

    fn held(_: &[Self]) -> Copies {
        Copies([const { Once::new() }; Symmetry::<3>::ALL])
    }

    fn too_long(&self) -> Option<[String; 2]> {
        // The opposite of the least number does not fit.
        let allowed = "within ±32767 along each axis";
        self.contains(&i16::MIN)
            .then(|| [format!("{self:?}"), allowed.into()])
    }

    fn read(bytes: &[u8]) -> Self {
        let (numbers, _) = bytes.as_chunks();
        [0, 1, 2].map(|axis| i16::from_le_bytes(numbers[axis]))
    }

    fn write(&self, section: &mut Vec<u8>) {
        section.extend(self.iter().flat_map(|v| v.to_le_bytes()));
    }
}

/// The copies of a table for all symmetries, made when they are first needed.
#[derive(Debug)]
pub struct Copies([Once<Arc<Turned>>; Symmetry::<3>::ALL]);

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
    pub fn new(
        map: Map,
        profile: &str,
        vectors: Vec<[i16; 3]>,
        provenance: Provenance,
        ranks: Option<Ranks>,
    ) -> Result<Self, Error> {
        Self::of_parts(Parts {
            map,
            profile: profile.into(),
            vectors,
            provenance,
            ranks,
            mix: None,
        })
    }

    /// All n³ vectors, in units of 2⁻¹² grid units; see [`new`](Self::new).
    #[must_use]
    pub fn vectors(&self) -> &[[i16; 3]] {
        &self.parts().vectors
    }

    /// All vectors, in fixed-point units.
    pub(crate) fn fixed_vectors(&self) -> Vec<[i32; 3]> {
        let fixed = |vector: &[i16; 3]| vector.map(|v| i32::from(v) << FINER);
        self.vectors().iter().map(fixed).collect()
    }

    /// The table turned by a symmetry.
    pub(super) fn turned(&self, symmetry: Symmetry<3>) -> Arc<Turned> {
        self.held().0[symmetry.number()].get_or(|| Arc::new(Turned::new(self, symmetry)))
    }
}

impl Turned {
    fn new(table: &Table, symmetry: Symmetry<3>) -> Self {
        let n = table.map().intervals();
        let source = |block: usize| symmetry.source(n, block);
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
        let order = table.order().turned(source);
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
