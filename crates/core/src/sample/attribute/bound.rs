//! The attributes of one point set, as columns.

use alloc::vec::Vec;

use super::{
    Attribute, Attributes,
    hash::{angle, hash, key, scale, unit},
};
use crate::{
    pattern::Pattern,
    sample::{
        kernel::write_numbers,
        lattice::{Lattice, Point, PointId, rank},
    },
};

/// The values of one attribute for some points.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Of angle, scale, rank and uniform numbers.
    Numbers(Vec<f64>),
    /// Indices into the names of the [`Variants`].
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
/// clone, and it holds no table.
#[derive(Clone, Debug)]
pub struct BoundAttributes {
    pattern: Pattern,
    list: Vec<Bound>,
}

#[derive(Clone, Debug)]
struct Bound {
    attribute: Attribute,
    key: u64,
}

impl BoundAttributes {
    pub(crate) fn new(attributes: &Attributes, lattice: &Lattice) -> Self {
        let seed = lattice.placement.seed;
        // Ranks are those of the whole pattern, also where only a share is kept.
        let pattern = Pattern::with_origin(lattice.table.alpha(), seed.origin());
        let bind = |attribute: &Attribute| Bound {
            key: key(seed, attribute.code()),
            attribute: attribute.clone(),
        };
        Self {
            pattern,
            list: attributes.as_slice().iter().map(bind).collect(),
        }
    }

    /// The value of attribute number `i` at one point, or `None` past the last attribute. A variant is
    /// its index as a number.
    ///
    /// An id without a point has values as well; its rank is the greatest, 1 − 2⁻⁵³.
    #[must_use]
    pub fn value(&self, i: usize, id: PointId) -> Option<f64> {
        let bound = self.list.get(i)?;
        Some(match &bound.attribute {
            Attribute::Variant(variants) => variants.pick(hash(bound.key, id)).into(),
            attribute => self.number(attribute, bound.key, id),
        })
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

    /// Replaces `columns` by one column per attribute, one value per id, in the memory they have.
    pub fn write(&self, ids: impl Iterator<Item = PointId> + Clone, columns: &mut Vec<Column>) {
        columns.resize_with(self.list.len(), || Column::Numbers(Vec::new()));
        for (bound, column) in self.list.iter().zip(columns) {
            let (key, ids) = (bound.key, ids.clone());
            if let Attribute::Variant(variants) = &bound.attribute {
                let picked = ids.map(|id| variants.pick(hash(key, id)));
                if let Column::Variants(values) = column {
                    values.clear();
                    values.extend(picked);
                } else {
                    *column = Column::Variants(picked.collect());
                }
                continue;
            }
            let mut values = match core::mem::replace(column, Column::Numbers(Vec::new())) {
                Column::Numbers(values) => values,
                Column::Variants(_) => Vec::new(),
            };
            values.resize(ids.clone().count(), 0.0);
            let out = values.as_mut_slice();
            // Loops of their own, without a branch at each point.
            match bound.attribute {
                Attribute::Angle => write_numbers(ids.map(|id| angle(hash(key, id))), out),
                Attribute::Scale(range) => {
                    write_numbers(ids.map(|id| scale(range, hash(key, id))), out);
                }
                Attribute::Uniform(_) => write_numbers(ids.map(|id| unit(hash(key, id))), out),
                ref other => write_numbers(ids.map(|id| self.number(other, key, id)), out),
            }
            *column = Column::Numbers(values);
        }
    }

    /// [`write`](Self::write) for points.
    pub fn write_points(&self, points: &[Point], columns: &mut Vec<Column>) {
        self.write(points.iter().map(|point| point.id), columns);
    }

    fn number(&self, attribute: &Attribute, key: u64, id: PointId) -> f64 {
        match attribute {
            Attribute::Angle => angle(hash(key, id)),
            Attribute::Scale(range) => scale(*range, hash(key, id)),
            Attribute::Rank => {
                let depth = self.pattern.depth(id.x, id.y);
                rank(depth, self.pattern.alpha().set_side())
            }
            Attribute::Uniform(_) => unit(hash(key, id)),
            Attribute::Variant(variants) => variants.pick(hash(key, id)).into(),
        }
    }
}
