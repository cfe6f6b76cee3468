//! Members: points that know their attributes.

use core::ops::RangeInclusive;

use super::{
    attribute::{
        Attribute, Variants,
        hash::{angle, between, hash, key, unit},
    },
    lattice::{Point, PointId},
    seed::Seed,
};

/// A point of a set.
///
/// Its attributes are functions of the id and the seed alone, so a point has the same values whichever
/// request finds it, and the same as in the [columns](crate::Attributes) of many points.
///
/// ```
/// use strew_core::{PointSet, Table, Variants};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let trees = PointSet::new(table).spacing(4.0)?.seed(7);
/// let kinds: Variants = "oak:3,birch:1".parse()?;
/// for tree in trees.chunk(64.0, [3, -2])? {
///     let [x, y] = tree.at();
///     println!("{} at {x} {y}: {}", tree.id(), tree.variant(&kinds));
///     assert!((0.8..=1.2).contains(&tree.scale(0.8..=1.2)));
///     assert_eq!(trees.point(tree.id()), Some(tree));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    point: Point,
    seed: Seed,
}

impl Member {
    pub(crate) const fn new(point: Point, seed: Seed) -> Self {
        Self { point, seed }
    }

    /// The stable id.
    #[must_use]
    pub const fn id(&self) -> PointId {
        self.point.id
    }

    /// The world coordinates.
    #[must_use]
    pub const fn at(&self) -> [f64; 2] {
        self.point.at()
    }

    /// Id and coordinates.
    #[must_use]
    pub const fn point(&self) -> Point {
        self.point
    }

    /// The attribute `angle`: a rotation in radians, uniform in [0, 2π).
    #[must_use]
    pub fn angle(&self) -> f64 {
        angle(self.hash(Attribute::ANGLE))
    }

    /// The attribute `scale`: a factor, uniform in a range. An empty range returns its end.
    #[must_use]
    pub fn scale(&self, range: RangeInclusive<f64>) -> f64 {
        between(*range.start(), *range.end(), self.hash(Attribute::SCALE))
    }

    /// The attribute `variant`: the name of one of several things, chosen by weight.
    #[must_use]
    pub fn variant<'v>(&self, variants: &'v Variants) -> &'v str {
        let index = variants.pick(self.hash(Attribute::VARIANT));
        variants.name(index).unwrap_or_default()
    }

    /// The attribute `u1`, `u2`, …: a number uniform in [0, 1), independent of those of other `n`. In
    /// output formats `n` is 1 to 16.
    #[must_use]
    pub fn uniform(&self, n: u8) -> f64 {
        unit(self.hash(Attribute::uniform_code(n)))
    }

    fn hash(&self, code: u64) -> u64 {
        hash(key(self.seed, code), self.point.id)
    }
}

impl From<Member> for Point {
    fn from(member: Member) -> Self {
        member.point
    }
}
