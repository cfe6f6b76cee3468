//! The attributes of one point set, as columns.

use alloc::{sync::Arc, vec::Vec};
use core::fmt;

use super::{
    Attribute, Attributes, Kinds, ScaleRange,
    hash::{Hashed, angle, hash, in_row, key, rotation, scale, turns, unit},
    scales::{Spread, VariantScales},
};
use crate::{
    error::Error,
    kernel::{Backend, PlainLoop, compiled_loop, write_numbers},
    lattice::{Lattice, PointId, seed::Seed},
    table::Shares,
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
pub struct BoundAttributes<Id = PointId> {
    indices: Arc<dyn Indices<Id>>,
    seed: Seed,
    /// The key of variants, on which scales may depend.
    variant_key: u64,
    list: Vec<Bound>,
}

/// The ranks and kinds of the points of a set.
pub(crate) trait Indices<Id = PointId>: fmt::Debug + Send + Sync {
    /// The rank of a point, in [0, 1); the greatest for an id without a point.
    fn rank(&self, id: Id) -> f64;
    /// The kind of a point, `None` for an id without a point and a table without kinds.
    fn kind(&self, id: Id) -> Option<u8>;
}

impl Lattice {
    /// The attributes of its points.
    pub(crate) fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        let of = (self.kind_parts(), self.placement.seed);
        BoundAttributes::new(attributes, of, Arc::new(self.clone()))
    }
}

impl Indices for Lattice {
    fn rank(&self, id: PointId) -> f64 {
        self.rank(id)
    }

    fn kind(&self, id: PointId) -> Option<u8> {
        self.kind_of(id)
    }
}

#[derive(Clone, Debug)]
struct Bound {
    attribute: Attribute,
    key: u64,
}

/// Ids by rows.
struct Rows<Id> {
    ids: Vec<Id>,
    /// The numbers of neighbors with the same row.
    lengths: Vec<usize>,
}

impl<Id: Hashed> Rows<Id> {
    /// Writes the numbers that `number` makes of hashes.
    fn write(&self, key: u64, number: impl Fn(u64) -> f64, out: &mut [f64]) {
        let mut numbers = Numbers {
            rows: self,
            key,
            number,
            out,
        };
        compiled_loop(Backend::best(), &mut numbers);
    }
}

/// The numbers of ids by rows, which share a round of their hashes.
struct Numbers<'a, Id, N> {
    rows: &'a Rows<Id>,
    key: u64,
    number: N,
    out: &'a mut [f64],
}

impl<Id: Hashed, N: Fn(u64) -> f64> PlainLoop for Numbers<'_, Id, N> {
    #[inline(always)]
    fn run(&mut self) {
        let (mut ids, mut out) = (&self.rows.ids[..], &mut *self.out);
        for &length in &self.rows.lengths {
            let (row, more) = ids.split_at(length);
            let (numbers, rest) = out.split_at_mut(length);
            let hash = row.first().map_or(0, |id| id.of_row(self.key));
            for (out, id) in numbers.iter_mut().zip(row) {
                *out = (self.number)(in_row(hash, id.column()));
            }
            (ids, out) = (more, rest);
        }
    }
}

impl BoundAttributes {
    /// The attributes of a set of the plane, whose kinds have some shares.
    pub(crate) fn new(
        attributes: &Attributes,
        (shares, seed): (Option<&Shares>, Seed),
        indices: Arc<dyn Indices>,
    ) -> Result<Self, Error> {
        for attribute in attributes.as_slice() {
            if *attribute == Attribute::Rotation {
                let allowed = "angle, scale, variant, rank or u1 to u16, in the plane";
                return Err(attribute.refused(allowed));
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
        Ok(Self::of(attributes, seed, indices))
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
}

impl<Id: Hashed> BoundAttributes<Id> {
    /// Attributes that a set is known to have.
    pub(crate) fn of(attributes: &Attributes, seed: Seed, indices: Arc<dyn Indices<Id>>) -> Self {
        let bind = |attribute: &Attribute| Bound {
            key: key(seed, attribute.code()),
            attribute: attribute.clone(),
        };
        Self {
            indices,
            seed,
            variant_key: key(seed, Attribute::VARIANT),
            list: attributes.as_slice().iter().map(bind).collect(),
        }
    }

    /// One column per attribute, and four for a rotation (x, y, z and w of a unit quaternion), one value per id.
    #[must_use]
    pub fn columns<I>(&self, ids: I) -> Vec<Column>
    where
        I: IntoIterator<Item = Id>,
    {
        let mut columns = Vec::new();
        self.write(ids.into_iter(), &mut columns);
        columns
    }

    /// Replaces `columns` by those of [`columns`](Self::columns), reusing their memory: faster for block after block.
    pub fn write(&self, ids: impl Iterator<Item = Id>, columns: &mut Vec<Column>) {
        let width = |bound: &Bound| bound.attribute.columns();
        let number = self.list.iter().map(width).sum();
        columns.resize_with(number, || Column::Numbers(Vec::new()));
        if self.list.is_empty() {
            return;
        }
        let ids: Vec<Id> = ids.collect();
        let rows = ids.chunk_by(Hashed::shares_row).map(<[Id]>::len);
        let ids = Rows {
            lengths: rows.collect(),
            ids,
        };
        let mut columns = &mut columns[..];
        for bound in &self.list {
            let (own, more) = columns.split_at_mut(width(bound));
            columns = more;
            match own {
                [column] => self.write_one(bound, &ids, column),
                parts if Id::TURNS => self.write_rotations(&ids, parts),
                _ => {}
            }
        }
    }

    fn write_one(&self, bound: &Bound, ids: &Rows<Id>, column: &mut Column) {
        let key = bound.key;
        match &bound.attribute {
            Attribute::Variant(variants) => {
                let picked = ids.ids.iter().map(|&id| variants.pick(hash(key, id)));
                return replace(column, picked);
            }
            Attribute::Kind(kinds) => {
                return replace(column, ids.ids.iter().map(|&id| self.index(kinds, id)));
            }
            _ => {}
        }
        let out = numbers(column, ids.ids.len());
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
    }

    fn write_rotations(&self, ids: &Rows<Id>, parts: &mut [Column]) {
        let keys = turns(self.seed);
        let mut parts: Vec<&mut [f64]> = (parts.iter_mut())
            .map(|part| numbers(part, ids.ids.len()))
            .collect();
        for (i, &id) in ids.ids.iter().enumerate() {
            for (part, v) in parts.iter_mut().zip(rotation(keys, id)) {
                part[i] = v;
            }
        }
    }

    /// Replaces `columns` by the values of some points; see [`write`](Self::write).
    pub fn write_points(&self, points: &[Id::Point], columns: &mut Vec<Column>) {
        self.write(points.iter().map(Id::of), columns);
    }

    fn number(&self, attribute: &Attribute, key: u64, id: Id) -> f64 {
        match attribute {
            Attribute::Angle => angle(hash(key, id)),
            // It has four.
            Attribute::Rotation => 0.0,
            Attribute::Scale(range) => scale(*range, hash(key, id)),
            Attribute::VariantScale(scales) => scale(self.range(scales, id), hash(key, id)),
            Attribute::Rank => self.indices.rank(id),
            Attribute::Uniform(_) => unit(hash(key, id)),
            Attribute::Variant(variants) => variants.pick(hash(key, id)).into(),
            Attribute::Kind(kinds) => self.index(kinds, id).into(),
        }
    }

    /// The range of the scale of a point's variant.
    fn range(&self, scales: &VariantScales, id: Id) -> ScaleRange {
        scales.range(match scales.of() {
            Spread::Chance(variants) => variants.pick(hash(self.variant_key, id)),
            Spread::Kinds(kinds) => self.index(kinds, id),
        })
    }

    /// The index of the variant of a point's kind.
    fn index(&self, kinds: &Kinds, id: Id) -> u32 {
        let kind = self.indices.kind(id).unwrap_or(0);
        kinds.index(kind).unwrap_or(0)
    }
}

/// Makes a column one of numbers, in its memory if it is.
fn numbers(column: &mut Column, length: usize) -> &mut [f64] {
    if let Column::Variants(_) = column {
        *column = Column::Numbers(Vec::new());
    }
    match column {
        Column::Numbers(values) => {
            values.resize(length, 0.0);
            values
        }
        Column::Variants(_) => &mut [],
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
