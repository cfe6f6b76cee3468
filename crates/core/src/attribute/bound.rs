//! The attributes of one point set, as columns.

use alloc::{sync::Arc, vec::Vec};
use core::fmt;

use super::{
    Attribute, Attributes, Kinds, ScaleRange,
    hash::{angle, hash, in_row, key, of_row, scale, unit},
    scales::{Spread, VariantScales},
};
use crate::{
    error::{Error, ErrorKind},
    kernel::{Backend, PlainLoop, compiled_loop, write_numbers},
    lattice::{Lattice, Point, PointId, kind, rank, seed::Seed},
    pattern::Pattern,
    table::{Mix, Shares, Table, TurnedTable},
};

/// The values of one attribute for some points.
///
/// ```
/// use strew_core::{Attribute, Attributes, Column, PointId, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let list = vec![Attribute::Rank, Attribute::Variant("oak:3,birch".parse()?)];
/// let attributes = PointSet::new(table).attributes(&Attributes::new(list)?)?;
/// let columns = attributes.columns([PointId { x: 4, y: 9 }]);
/// assert!(matches!(columns[..], [Column::Numbers(_), Column::Variants(_)]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// The values of angle, scale, rank and uniform numbers.
    Numbers(Vec<f64>),
    /// Indices into the names of the [`Variants`](crate::Variants).
    Variants(Vec<u32>),
}

impl Column {
    /// The numbers, unless this is a column of variants.
    #[must_use]
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(numbers) => Some(numbers),
            Self::Variants(_) => None,
        }
    }

    /// The indices of variants, unless this is a column of numbers.
    #[must_use]
    pub fn variants(&self) -> Option<&[u32]> {
        match self {
            Self::Numbers(_) => None,
            Self::Variants(indices) => Some(indices),
        }
    }
}

/// The attributes of one point set; see [`PointSet::attributes`](crate::PointSet::attributes). Cheap to
/// clone.
///
/// ```
/// use strew_core::{Attributes, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).seed(7);
/// let attributes = set.attributes(&Attributes::new(vec!["angle".parse()?, "u1".parse()?])?)?;
/// let member = set.nearest([10.0, 3.0], 1)?[0].member;
/// // The values are those that the point itself has.
/// assert_eq!(attributes.value(0, member.id()), Some(member.angle()));
/// assert_eq!(attributes.value(1, member.id()), Some(member.uniform(1)));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundAttributes {
    indexed: Indexed,
    /// The key of variants, on which scales may depend.
    variant_key: u64,
    list: Vec<Bound>,
}

/// The way to a point's place in index space.
#[derive(Clone, Debug)]
enum Indexed {
    Plane(TurnedTable, Pattern),
    /// In the plane, with kinds whose shares vary.
    Varied(Arc<Lattice>),
    Other(Arc<dyn Indices>),
}

/// The ranks and kinds of the points of a set that is not one of the plane.
pub(crate) trait Indices: fmt::Debug + Send + Sync {
    /// The rank of a point, in [0, 1); the greatest for an id without a point.
    fn rank(&self, id: PointId) -> f64;
    /// The kind of a point, `None` for an id without a point and a table without kinds.
    fn kind(&self, id: PointId) -> Option<u8>;
}

impl Indexed {
    fn rank(&self, id: PointId) -> f64 {
        match self {
            Self::Plane(table, pattern) => rank(table, pattern, id),
            Self::Varied(lattice) => lattice.rank(id),
            Self::Other(indices) => indices.rank(id),
        }
    }

    fn kind(&self, id: PointId) -> Option<u8> {
        match self {
            Self::Plane(table, pattern) => kind(table, pattern, id),
            Self::Varied(lattice) => lattice.kind_of(id),
            Self::Other(indices) => indices.kind(id),
        }
    }
}

#[derive(Clone, Debug)]
struct Bound {
    attribute: Attribute,
    key: u64,
}

/// Ids by rows.
struct Rows {
    ids: Vec<PointId>,
    /// The numbers of neighbors with the same row.
    lengths: Vec<usize>,
}

impl Rows {
    /// Writes the numbers that `number` makes of hashes.
    fn write(&self, key: u64, number: impl Fn(u64) -> f64, out: &mut [f64]) {
        let mut hashed = Hashed {
            rows: self,
            key,
            number,
            out,
        };
        compiled_loop(Backend::best(), &mut hashed);
    }
}

/// The numbers of ids by rows, which share a round of their hashes.
struct Hashed<'a, N> {
    rows: &'a Rows,
    key: u64,
    number: N,
    out: &'a mut [f64],
}

impl<N: Fn(u64) -> f64> PlainLoop for Hashed<'_, N> {
    #[inline(always)]
    fn run(&mut self) {
        let (mut ids, mut out) = (&self.rows.ids[..], &mut *self.out);
        for &length in &self.rows.lengths {
            let (row, more) = ids.split_at(length);
            let (numbers, rest) = out.split_at_mut(length);
            let hash = row.first().map_or(0, |id| of_row(self.key, id.y));
            for (out, id) in numbers.iter_mut().zip(row) {
                *out = (self.number)(in_row(hash, id.x));
            }
            (ids, out) = (more, rest);
        }
    }
}

impl BoundAttributes {
    pub(crate) fn new(attributes: &Attributes, lattice: &Lattice) -> Result<Self, Error> {
        let indexed = match lattice.is_varied() {
            true => Indexed::Varied(Arc::new(lattice.clone())),
            false => Indexed::Plane(lattice.turned.clone(), lattice.pattern),
        };
        let seed = lattice.placement.seed;
        Self::indexed(attributes, (lattice.kind_parts(), seed), indexed)
    }

    /// The attributes of a set that is not one of the plane.
    pub(crate) fn of(
        attributes: &Attributes,
        of: (&Table, Seed),
        indices: Arc<dyn Indices>,
    ) -> Result<Self, Error> {
        let (table, seed) = of;
        let shares = table.mix().map(Mix::shares);
        Self::indexed(attributes, (shares, seed), Indexed::Other(indices))
    }

    fn indexed(
        attributes: &Attributes,
        (shares, seed): (Option<&Shares>, Seed),
        indexed: Indexed,
    ) -> Result<Self, Error> {
        for attribute in attributes.as_slice() {
            if *attribute == Attribute::Rotation {
                let allowed = "angle, scale, variant, rank or u1 to u16, in the plane";
                let (kind, name) = (ErrorKind::Attribute, attribute.name());
                return Err(Error::new(kind, "attribute", name, allowed));
            }
            let kinds = match attribute {
                Attribute::Kind(kinds) => Some(kinds),
                Attribute::VariantScale(scales) => match scales.of() {
                    Spread::Kinds(kinds) => Some(kinds),
                    Spread::Chance(_) => None,
                },
                _ => None,
            };
            kinds.map_or(Ok(()), |kinds| kinds.check(shares))?;
        }
        let bind = |attribute: &Attribute| Bound {
            key: key(seed, attribute.code()),
            attribute: attribute.clone(),
        };
        Ok(Self {
            indexed,
            variant_key: key(seed, Attribute::VARIANT),
            list: attributes.as_slice().iter().map(bind).collect(),
        })
    }

    /// The value of attribute number `i` at one point, or `None` past the last attribute. A variant is
    /// its index as a number.
    ///
    /// An id without a point has values as well; its rank is the greatest, 1 − 2⁻⁵³, and its kind
    /// the rarest.
    #[must_use]
    pub fn value(&self, i: usize, id: PointId) -> Option<f64> {
        let bound = self.list.get(i)?;
        Some(self.number(&bound.attribute, bound.key, id))
    }

    /// One column per attribute, one value per id.
    #[must_use]
    pub fn columns<I>(&self, ids: I) -> Vec<Column>
    where
        I: IntoIterator<Item = PointId>,
        I::IntoIter: Clone,
    {
        let mut columns = Vec::new();
        self.write(ids.into_iter(), &mut columns);
        columns
    }

    /// Replaces `columns` by one column per attribute, one value per id, reusing their memory. Faster than
    /// [`columns`](Self::columns) for block after block.
    pub fn write(&self, ids: impl Iterator<Item = PointId> + Clone, columns: &mut Vec<Column>) {
        columns.resize_with(self.list.len(), || Column::Numbers(Vec::new()));
        if self.list.is_empty() {
            return;
        }
        let ids: Vec<PointId> = ids.collect();
        let rows = ids.chunk_by(|a, b| a.y == b.y).map(<[PointId]>::len);
        let ids = Rows {
            lengths: rows.collect(),
            ids,
        };
        for (bound, column) in self.list.iter().zip(columns) {
            let key = bound.key;
            match &bound.attribute {
                Attribute::Variant(variants) => {
                    let picked = ids.ids.iter().map(|&id| variants.pick(hash(key, id)));
                    replace(column, picked);
                    continue;
                }
                Attribute::Kind(kinds) => {
                    replace(column, ids.ids.iter().map(|&id| self.index(kinds, id)));
                    continue;
                }
                _ => {}
            }
            let mut values = match core::mem::replace(column, Column::Numbers(Vec::new())) {
                Column::Numbers(values) => values,
                Column::Variants(_) => Vec::new(),
            };
            values.resize(ids.ids.len(), 0.0);
            let out = values.as_mut_slice();
            // Loops of their own, without a branch at each point.
            match bound.attribute {
                Attribute::Angle => ids.write(key, angle, out),
                Attribute::Scale(range) => ids.write(key, |hash| scale(range, hash), out),
                Attribute::Uniform(_) => ids.write(key, unit, out),
                ref other => {
                    let all = ids.ids.iter().map(|&id| self.number(other, key, id));
                    write_numbers(all, out);
                }
            }
            *column = Column::Numbers(values);
        }
    }

    /// Replaces `columns` by the values of some points; see [`write`](Self::write).
    pub fn write_points(&self, points: &[Point], columns: &mut Vec<Column>) {
        self.write(points.iter().map(|point| point.id), columns);
    }

    fn number(&self, attribute: &Attribute, key: u64, id: PointId) -> f64 {
        match attribute {
            Attribute::Angle => angle(hash(key, id)),
            // Refused when the list was bound.
            Attribute::Rotation => 0.0,
            Attribute::Scale(range) => scale(*range, hash(key, id)),
            Attribute::VariantScale(scales) => scale(self.range(scales, id), hash(key, id)),
            Attribute::Rank => self.indexed.rank(id),
            Attribute::Uniform(_) => unit(hash(key, id)),
            Attribute::Variant(variants) => variants.pick(hash(key, id)).into(),
            Attribute::Kind(kinds) => self.index(kinds, id).into(),
        }
    }

    /// The range of the scale of a point's variant.
    fn range(&self, scales: &VariantScales, id: PointId) -> ScaleRange {
        scales.range(match scales.of() {
            Spread::Chance(variants) => variants.pick(hash(self.variant_key, id)),
            Spread::Kinds(kinds) => self.index(kinds, id),
        })
    }

    /// The index of the variant of a point's kind.
    fn index(&self, kinds: &Kinds, id: PointId) -> u32 {
        let kind = self.indexed.kind(id).unwrap_or(0);
        kinds.index(kind).unwrap_or(0)
    }
}

/// Replaces a column by indices, in its memory if it has such.
fn replace(column: &mut Column, indices: impl Iterator<Item = u32>) {
    if let Column::Variants(values) = column {
        values.clear();
        values.extend(indices);
    } else {
        *column = Column::Variants(indices.collect());
    }
}
