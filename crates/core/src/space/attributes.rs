//! Attributes of points in space.
//!
//! They are those of the plane with one more round of the hash, for z. In place of an angle points have a whole
//! rotation.

use alloc::{sync::Arc, vec::Vec};
use core::f64::consts::TAU;

use super::{
    lattice::Lattice,
    plan::Plan,
    point::{Point, PointId},
    set::SpaceSet,
};
use crate::{
    Attribute, Attributes, Column, ScaleRange, VariantScales,
    attribute::hash,
    error::{Error, ErrorKind},
    lattice::seed::split_mix,
};

/// The attributes of the points of one set in space. Cheap to clone.
///
/// ```
/// use strew_core::{Attributes, space::{SpaceSet, Table}};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
/// let list = Attributes::new(vec!["rotation".parse()?, "u1".parse()?])?;
/// let points = set.chunk(8.0, [0, 0, 0])?.to_vec();
/// let columns = set.attributes(&list)?.columns(points.iter().map(|point| point.id));
/// // A rotation takes four columns: x, y, z and w of a unit quaternion.
/// assert_eq!(columns.len(), 5);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundAttributes {
    lattice: Arc<Lattice>,
    list: Attributes,
}

impl BoundAttributes {
    pub(super) fn new(attributes: &Attributes, lattice: &Lattice) -> Result<Self, Error> {
        for attribute in attributes.as_slice() {
            let is_even = match attribute {
                Attribute::Angle | Attribute::Kind(_) => true,
                Attribute::VariantScale(scales) => scales.by_chance().is_none(),
                _ => false,
            };
            if is_even {
                let allowed = "rotation, scale, variant (by chance), rank or u1 to u16, in space";
                let (kind, name) = (ErrorKind::Attribute, attribute.name());
                return Err(Error::new(kind, "attribute", name, allowed));
            }
        }
        Ok(Self {
            lattice: Arc::new(lattice.clone()),
            list: attributes.clone(),
        })
    }

    /// One column per attribute, and four for a rotation, with one value per id. An id without a point has values as
    /// well; its rank is the greatest.
    #[must_use]
    pub fn columns(&self, ids: impl IntoIterator<Item = PointId>) -> Vec<Column> {
        let ids: Vec<PointId> = ids.into_iter().collect();
        let mut columns = Vec::new();
        for attribute in self.list.as_slice() {
            self.push(attribute, &ids, &mut columns);
        }
        columns
    }

    /// The columns of some points; see [`columns`](Self::columns).
    pub fn write_points(&self, points: &[Point], columns: &mut Vec<Column>) {
        *columns = self.columns(points.iter().map(|point| point.id));
    }

    fn push(&self, attribute: &Attribute, ids: &[PointId], columns: &mut Vec<Column>) {
        let seed = self.lattice.placement.seed;
        let key = hash::key(seed, attribute.code());
        let hashed = |key| ids.iter().map(move |&id| in_space(key, id));
        columns.push(match attribute {
            Attribute::Scale(range) => {
                Column::Numbers(hashed(key).map(|bits| hash::scale(*range, bits)).collect())
            }
            Attribute::VariantScale(scales) => {
                let variants = hashed(hash::key(seed, Attribute::VARIANT));
                let pairs = hashed(key).zip(variants);
                let scaled = pairs.map(|(bits, own)| hash::scale(range(scales, own), bits));
                Column::Numbers(scaled.collect())
            }
            Attribute::Uniform(_) => Column::Numbers(hashed(key).map(hash::unit).collect()),
            Attribute::Rank => {
                Column::Numbers(ids.iter().map(|&id| self.lattice.rank(id)).collect())
            }
            Attribute::Variant(variants) => {
                Column::Variants(hashed(key).map(|bits| variants.pick(bits)).collect())
            }
            Attribute::Rotation => {
                let keys = [0, 1, 2].map(|i| hash::key(seed, Attribute::ROTATION + i));
                let mut parts = [0; 4].map(|_| Vec::with_capacity(ids.len()));
                for &id in ids {
                    let all = rotation(keys.map(|key| hash::unit(in_space(key, id))));
                    for (part, v) in parts.iter_mut().zip(all) {
                        part.push(v);
                    }
                }
                columns.extend(parts.map(Column::Numbers));
                return;
            }
            // Refused when the list was bound.
            Attribute::Angle | Attribute::Kind(_) => Column::Numbers(Vec::new()),
        });
    }
}

/// The hash of a point: that of the plane, under a key that z is hashed into.
fn in_space(key: u64, id: PointId) -> u64 {
    const LEVEL: u64 = 0xa076_1d64_78bd_642f;
    let level = split_mix(key ^ (id.z as u64).wrapping_mul(LEVEL)).wrapping_add(key);
    hash::in_row(hash::of_row(level, id.y), id.x)
}

/// The range of the scale of the variant that a hash picks.
fn range(scales: &VariantScales, hash: u64) -> ScaleRange {
    let picked = scales.by_chance().map_or(0, |variants| variants.pick(hash));
    scales.range(picked)
}

/// A rotation as a unit quaternion x, y, z, w, uniform for uniform numbers (Shoemake, "Uniform random rotations", 1992).
fn rotation([u, v, w]: [f64; 3]) -> [f64; 4] {
    let (low, high) = (libm::sqrt(1.0 - u), libm::sqrt(u));
    let (sine, cosine) = libm::sincos(TAU * v);
    let (other_sine, other_cosine) = libm::sincos(TAU * w);
    [
        low * sine,
        low * cosine,
        high * other_sine,
        high * other_cosine,
    ]
}

impl SpaceSet {
    /// The attributes of the points of this set: `rotation`, `scale`, `variant` by chance, `rank` and `u1` to `u16`.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] for `angle` and evenly spread variants, which points in space do not have.
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        BoundAttributes::new(attributes, &self.lattice)
    }
}

impl Plan {
    /// The attributes of the points; see [`SpaceSet::attributes`].
    ///
    /// # Errors
    /// As [`SpaceSet::attributes`].
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        BoundAttributes::new(attributes, &self.scope.lattice)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::space::Table;

    fn set() -> SpaceSet {
        let alpha = "sqrt(3)".parse().expect("a number");
        SpaceSet::new(Table::undisplaced(alpha, 5, "pattern").expect("a table")).seed(7)
    }

    #[test]
    fn rotations_are_uniform_unit_quaternions() {
        let list = Attributes::new(vec![Attribute::Rotation]).expect("one");
        let points = set().chunk(40.0, [0, 0, 0]).expect("near").to_vec();
        let columns = set().attributes(&list).expect("known");
        let columns = columns.columns(points.iter().map(|point| point.id));
        let parts: Vec<&[f64]> = columns.iter().filter_map(Column::numbers).collect();
        assert_eq!(parts.len(), 4);
        let n = points.len() as f64;
        let mean = |of: &dyn Fn(usize) -> f64| (0..points.len()).map(of).sum::<f64>() / n;
        for i in 0..points.len() {
            let length: f64 = parts.iter().map(|part| part[i] * part[i]).sum();
            assert!((length - 1.0).abs() < 1e-14);
        }
        // Of a uniform quaternion all first moments vanish, squares are 1/4 and fourth powers 1/8.
        let close = 5.0 / n.sqrt();
        for (a, part) in parts.iter().enumerate() {
            assert!(mean(&|i| part[i]).abs() < close);
            assert!((mean(&|i| part[i].powi(2)) - 0.25).abs() < close);
            assert!((mean(&|i| part[i].powi(4)) - 0.125).abs() < close);
            for other in &parts[..a] {
                assert!(mean(&|i| part[i] * other[i]).abs() < close);
            }
        }
    }
}
