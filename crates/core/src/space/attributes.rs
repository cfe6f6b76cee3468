//! Attributes of points in space.
//!
//! They are those of the plane with one more round of the hash, for z. In place of an angle points have a whole
//! rotation.

use alloc::sync::Arc;

use super::{
    Member,
    lattice::Lattice,
    plan::{Blocks, Plan},
    point::{Point, PointId},
    set::SpaceSet,
};
use crate::{
    Attribute, Attributes,
    attribute::{
        Indices,
        hash::{Hashed, of_row, rotation, turns},
    },
    error::Error,
    kernel::Points,
    lattice::seed::split_mix,
    plan::member::Made,
};

/// The attributes of the points of one set in space.
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
pub type BoundAttributes = crate::BoundAttributes<PointId>;

/// Its hash is that of the plane, under a key that z is hashed into.
impl Hashed for PointId {
    type Point = Point;
    const TURNS: bool = true;

    fn of(point: &Point) -> Self {
        point.id
    }

    #[inline]
    fn shares_row(&self, other: &Self) -> bool {
        [self.y, self.z] == [other.y, other.z]
    }

    #[inline]
    fn of_row(self, key: u64) -> u64 {
        const LEVEL: u64 = 0xa076_1d64_78bd_642f;
        let level = split_mix(key ^ (self.z as u64).wrapping_mul(LEVEL)).wrapping_add(key);
        of_row(level, self.y)
    }

    #[inline]
    fn column(self) -> i64 {
        self.x
    }
}

impl Made for PointId {
    type Blocks = Blocks<Points>;

    fn fill(blocks: &mut Self::Blocks, points: &mut [Point]) -> usize {
        blocks.fill(points)
    }
}

impl Member {
    /// The place, in world coordinates.
    #[must_use]
    pub const fn at(&self) -> [f64; 3] {
        self.point().at()
    }

    /// The attribute `rotation`: a uniform rotation, as a unit quaternion x, y, z, w.
    #[must_use]
    pub fn rotation(&self) -> [f64; 4] {
        rotation(turns(self.seed()), self.id())
    }
}

impl From<Member> for Point {
    fn from(member: Member) -> Self {
        member.point()
    }
}

impl Indices<PointId> for Lattice {
    fn rank(&self, id: PointId) -> f64 {
        self.rank(id)
    }

    fn kind(&self, _: PointId) -> Option<u8> {
        None
    }
}

fn bound(attributes: &Attributes, lattice: &Lattice) -> Result<BoundAttributes, Error> {
    for attribute in attributes.as_slice() {
        let is_even = match attribute {
            Attribute::Angle | Attribute::Kind(_) => true,
            Attribute::VariantScale(scales) => scales.by_chance().is_none(),
            _ => false,
        };
        if is_even {
            let allowed = "rotation, scale, variant (by chance), rank or u1 to u16, in space";
            return Err(attribute.refused(allowed));
        }
    }
    let (seed, lattice) = (lattice.placement.seed, Arc::new(lattice.clone()));
    Ok(BoundAttributes::of(attributes, seed, lattice))
}

impl SpaceSet {
    /// The attributes of the points of this set: `rotation`, `scale`, `variant` by chance, `rank` and `u1` to `u16`.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`](crate::ErrorKind::Attribute) for `angle` and evenly spread variants, which are of the
    /// plane.
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        bound(attributes, &self.lattice)
    }
}

impl Plan {
    /// The attributes of the points; see [`SpaceSet::attributes`].
    ///
    /// # Errors
    /// As [`SpaceSet::attributes`].
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        bound(attributes, &self.scope.lattice)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::{Column, space::Table};

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
