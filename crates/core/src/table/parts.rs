//! The checked parts of a table: its vectors, in fixed-point coordinates of 2⁻²⁰ grid units, and what goes with them.

use alloc::{format, string::String, vec::Vec};
use core::fmt::Debug;

use super::{Mix, Provenance, Ranks};
use crate::{
    error::{Error, ErrorKind, quoted},
    map::Map,
};

/// The displacement of a block as a table and its file hold it.
pub trait Vector: Copy + Debug + Default + PartialEq {
    /// The number of axes.
    const AXES: u32;
    /// The section of the file that has the vectors.
    const SECTION: [u8; 4];
    /// The sections that such a file may not have, and why.
    const FOREIGN: &[([u8; 4], &str)];
    /// What is derived from the vectors and kept with the table.
    type Held;

    /// Derives it.
    fn held(vectors: &[Self]) -> Self::Held;

    /// The vector and what is allowed, if it is too long.
    fn too_long(&self) -> Option<[String; 2]>;

    /// The vector of as many bytes as it has in memory.
    fn read(bytes: &[u8]) -> Self;

    /// Appends the vector to a section.
    fn write(&self, section: &mut Vec<u8>);
}

/// Fraction bits of every coordinate: one unit is 2⁻²⁰ grid units, about 3·10⁻⁷ mean spacings.
///
/// Rounding to it adds less than 10⁻¹² to the low-frequency power, and the coordinates of a patch fit
/// 32-bit lanes.
pub const FRACTION_BITS: u32 = 20;

/// The bound of a displacement along an axis, in grid units (exclusive). Published tables stay within
/// 13. A vector longer than the map's half-width would leave the surroundings that its block knows.
pub const MAX_DISPLACEMENT: f64 = 127.0;

/// A displacement in units of 2⁻²⁰ grid units.
pub type Displacement = [i32; 2];

/// A lattice coordinate in fixed point.
pub(crate) const fn fixed(v: i64) -> i128 {
    (v as i128) << FRACTION_BITS
}

/// A fixed-point coordinate in grid units.
#[must_use]
pub fn to_grid_units(fixed: i32) -> f64 {
    f64::from(fixed) / f64::from(1 << FRACTION_BITS)
}

/// The fixed-point coordinate nearest to one in grid units, or `None` at [`MAX_DISPLACEMENT`] and
/// beyond, and for NaN.
///
/// ```
/// use strew_core::table::from_grid_units;
///
/// assert_eq!(from_grid_units(-1.25), Some(-5 << 18));
/// assert_eq!(from_grid_units(127.0), None);
/// assert!(from_grid_units(127f64.next_down()).is_some());
/// ```
#[must_use]
pub fn from_grid_units(value: f64) -> Option<i32> {
    let in_range = value > -MAX_DISPLACEMENT && value < MAX_DISPLACEMENT;
    in_range.then(|| libm::round(value * f64::from(1 << FRACTION_BITS)) as i32)
}

/// The content of a table: everything but its digest.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts<V> {
    pub(crate) map: Map,
    pub(crate) profile: String,
    /// A vector for each block: along x first, then along y, and then along z in space.
    pub(crate) vectors: Vec<V>,
    pub(crate) provenance: Provenance,
    /// A position for each block.
    pub(crate) ranks: Option<Ranks>,
    /// A mix of this map, in the plane.
    pub(crate) mix: Option<Mix>,
}

impl<V: Vector> Parts<V> {
    /// The number of blocks of a map.
    pub(crate) fn blocks(map: &Map) -> usize {
        map.intervals().pow(V::AXES)
    }

    /// Refuses a wrong number of vectors, vectors that are too long, a profile name that is not
    /// allowed, and a history beyond the format's limits.
    pub(super) fn check(&self) -> Result<(), Error> {
        let refused = |field, value: String, allowed: String| {
            Err(Error::new(ErrorKind::Table, field, value, allowed))
        };
        let expected = Self::blocks(&self.map);
        if self.vectors.len() != expected {
            let value = format!("{} vectors", self.vectors.len());
            let allowed = format!("{expected} vectors, the number of blocks");
            return refused("displacements", value, allowed);
        }
        let mut vectors = self.vectors.iter().enumerate();
        let long = vectors.find_map(|(block, vector)| Some((block, vector.too_long()?)));
        if let Some((block, [vector, allowed])) = long {
            return refused(
                "displacements",
                format!("{vector} in block {block}"),
                allowed,
            );
        }
        check_profile(&self.profile)?;
        if let Some(ranks) = &self.ranks
            && ranks.positions().len() != expected
        {
            let value = format!("{} positions", ranks.positions().len());
            let allowed = format!("{expected} positions, the number of blocks");
            return refused("ranks", value, allowed);
        }
        if let Some(mix) = &self.mix
            && Mix::new(&self.map, mix.shares().clone(), mix.labels().to_vec())? != *mix
        {
            let (value, allowed) = ("of another map".into(), "a mix of the table's map".into());
            return refused("mix", value, allowed);
        }
        self.provenance.check()
    }
}

/// Refuses the name of a profile that is not allowed.
fn check_profile(profile: &str) -> Result<(), Error> {
    let is_allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-';
    if (1..=32).contains(&profile.len()) && profile.bytes().all(is_allowed) {
        return Ok(());
    }
    let allowed = "1 to 32 characters of a-z, 0-9 and -";
    let value = quoted(profile);
    Err(Error::new(ErrorKind::Table, "profile", value, allowed))
}
