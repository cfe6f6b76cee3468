//! Attributes: values that every point has besides its place.
//!
//! Whoever scatters trees wants each of them turned, scaled and of some kind, and the same tree to
//! look the same whichever query finds it. So an attribute is a function of the point's id and the
//! seed alone: not of the spacing, the warp, the region or the order. All but the rank are hashed;
//! the rank follows from the point's place in index space ([`rank`]).
//!
//! The hash is the finalizer of SplitMix64 (Steele, Lea, Flood, 2014) over column and row, under a
//! key made of the seed and the attribute; numbers are its upper 53 bits, so that they are exact
//! multiples of 2⁻⁵³ below 1.

use alloc::{string::String, vec::Vec};
use core::{f64::consts::TAU, fmt, str::FromStr};

use super::{
    Placement, Point, PointId, Sampler, Seed, Variants, kernel::compiled, rank::rank,
    seed::split_mix,
};
use crate::pattern::Pattern;

/// One value per point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Attribute {
    /// `angle`: a rotation in radians, uniform in [0, 2π).
    Angle,
    /// `scale`: a factor, uniform in a range.
    Scale(ScaleRange),
    /// `variant`: which of several named things stands here, by weight.
    Variant(Variants),
    /// `rank`: a number in [0, 1), uniform over the pattern. The points of rank below λ are a
    /// fraction λ of all, nested as λ grows; see [`rank`].
    Rank,
    /// `u1` to `u16`: a number uniform in [0, 1), a multiple of 2⁻⁵³.
    Uniform(UniformNumber),
}

/// The range of a scale: 0 ≤ min ≤ max.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleRange {
    min: f64,
    max: f64,
}

/// Which of the uniform numbers: 1 to 16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UniformNumber(u8);

/// Why an attribute is not allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AttributeError {
    /// No attribute has this name.
    #[error(
        "there is no attribute {0:?}; there are angle, scale, variant, rank and u1 to u{max}",
        max = UniformNumber::MAX
    )]
    Unknown(String),
    /// The attribute cannot be named alone.
    #[error("attribute `{name}` needs {needs}")]
    Incomplete {
        /// `scale` or `variant`.
        name: &'static str,
        /// What it needs.
        needs: &'static str,
    },
    /// The range of a scale is not allowed.
    #[error(
        "the scale range is {min} to {max}; it must be two numbers with 0 <= min <= max <= {limit:e}",
        limit = ScaleRange::LIMIT
    )]
    Scale {
        /// The lower end as given.
        min: f64,
        /// The upper end as given.
        max: f64,
    },
    /// There is no such uniform number.
    #[error("there is no uniform number {0}; there are 1 to {max}", max = UniformNumber::MAX)]
    Uniform(u8),
    /// An attribute is in a list twice.
    #[error("attribute `{0}` is asked for twice")]
    Repeated(&'static str),
}

impl ScaleRange {
    #[inline]
    fn pick(self, hash: u64) -> f64 {
        // Rounding may carry the sum past the end by a unit.
        (self.min + unit(hash) * (self.max - self.min)).min(self.max)
    }

    /// The greatest scale.
    pub const LIMIT: f64 = 1e9;

    /// The range from `min` to `max`, both included.
    ///
    /// # Errors
    /// [`AttributeError::Scale`] unless 0 ≤ min ≤ max ≤ [`LIMIT`](Self::LIMIT).
    pub fn new(min: f64, max: f64) -> Result<Self, AttributeError> {
        if 0.0 <= min && min <= max && max <= Self::LIMIT {
            Ok(Self { min, max })
        } else {
            Err(AttributeError::Scale { min, max })
        }
    }

    /// The least scale.
    #[must_use]
    pub const fn min(self) -> f64 {
        self.min
    }

    /// The greatest scale.
    #[must_use]
    pub const fn max(self) -> f64 {
        self.max
    }
}

impl UniformNumber {
    /// How many there are.
    pub const MAX: u8 = 16;

    /// The uniform number `n`, from 1 to [`MAX`](Self::MAX).
    ///
    /// # Errors
    /// [`AttributeError::Uniform`] for any other.
    pub const fn new(n: u8) -> Result<Self, AttributeError> {
        if 1 <= n && n <= Self::MAX {
            Ok(Self(n))
        } else {
            Err(AttributeError::Uniform(n))
        }
    }

    /// Its number.
    #[must_use]
    pub const fn get(self) -> u8 {
        self.0
    }
}

/// By number.
const UNIFORM_NAMES: [&str; UniformNumber::MAX as usize] = [
    "u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8", "u9", "u10", "u11", "u12", "u13", "u14", "u15",
    "u16",
];

impl Attribute {
    /// A scale uniform in [min, max].
    ///
    /// # Errors
    /// As [`ScaleRange::new`].
    pub fn scale(min: f64, max: f64) -> Result<Self, AttributeError> {
        ScaleRange::new(min, max).map(Self::Scale)
    }

    /// The uniform number `n`.
    ///
    /// # Errors
    /// As [`UniformNumber::new`].
    pub fn uniform(n: u8) -> Result<Self, AttributeError> {
        UniformNumber::new(n).map(Self::Uniform)
    }

    /// Its name: `angle`, `scale`, `variant`, `rank`, `u1` to `u16`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Scale(_) => "scale",
            Self::Variant(_) => "variant",
            Self::Rank => "rank",
            Self::Uniform(n) => UNIFORM_NAMES[n.0 as usize - 1],
        }
    }

    /// What tells its hash from those of the others. Part of the algorithm version.
    const fn code(&self) -> u64 {
        match self {
            Self::Rank => 0,
            Self::Angle => 1,
            Self::Scale(_) => 2,
            Self::Variant(_) => 3,
            Self::Uniform(n) => 0x100 + n.0 as u64,
        }
    }
}

/// The attributes that need nothing but their name: `angle`, `rank`, `u1` to `u16`.
impl FromStr for Attribute {
    type Err = AttributeError;

    fn from_str(text: &str) -> Result<Self, AttributeError> {
        let incomplete = |name, needs| Err(AttributeError::Incomplete { name, needs });
        match text {
            "angle" => Ok(Self::Angle),
            "rank" => Ok(Self::Rank),
            "scale" => incomplete("scale", "a range, such as 0.8 to 1.2"),
            "variant" => incomplete("variant", "a list of variants, such as oak:3,birch:1"),
            _ => match (1..).zip(UNIFORM_NAMES).find(|(_, name)| *name == text) {
                Some((n, _)) => Self::uniform(n),
                None => Err(AttributeError::Unknown(text.chars().take(40).collect())),
            },
        }
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A list of different attributes, in the order asked for. It may be empty.
///
/// ```
/// use strew_core::{Placement, PointId, Sampler, Seed, Spacing, Table};
/// use strew_core::sample::{Attribute, Attributes, Column};
///
/// let sampler = Sampler::new(Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?);
/// let variants = "oak:3,birch:1".parse()?;
/// let attributes = Attributes::new(vec![
///     Attribute::Angle,
///     Attribute::scale(0.8, 1.2)?,
///     Attribute::Variant(variants),
///     "u1".parse()?,
/// ])?;
/// let placement = Placement::new(Spacing::new(2.0)?, Seed(7));
/// let bound = attributes.bind(&sampler, placement);
/// let columns = bound.columns([PointId { x: -31, y: 52 }, PointId { x: 4, y: 9 }]);
/// assert_eq!(columns.len(), 4);
/// let Column::Numbers(scales) = &columns[1] else { panic!("a scale is a number") };
/// assert!(scales.iter().all(|scale| (0.8..=1.2).contains(scale)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes(Vec<Attribute>);

impl Attributes {
    /// The list.
    ///
    /// # Errors
    /// [`AttributeError::Repeated`] if two have the same name.
    pub fn new(list: Vec<Attribute>) -> Result<Self, AttributeError> {
        for (i, attribute) in list.iter().enumerate() {
            if list[..i].iter().any(|a| a.name() == attribute.name()) {
                return Err(AttributeError::Repeated(attribute.name()));
            }
        }
        Ok(Self(list))
    }

    /// The attributes in order.
    #[must_use]
    pub fn as_slice(&self) -> &[Attribute] {
        &self.0
    }

    /// Makes them ready for the points of one sampler and placement. Spacing and warp do not matter.
    #[must_use]
    pub fn bind(&self, sampler: &Sampler, placement: Placement) -> BoundAttributes {
        let pattern = Pattern::with_origin(sampler.table().alpha(), placement.seed.origin());
        let bind = |attribute: &Attribute| Bound {
            key: key(placement.seed, attribute),
            attribute: attribute.clone(),
        };
        BoundAttributes {
            pattern,
            list: self.0.iter().map(bind).collect(),
        }
    }
}

/// The values of one attribute for a run of points.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Of angle, scale, rank and uniform numbers.
    Numbers(Vec<f64>),
    /// Indices into the names of the [`Variants`].
    Variants(Vec<u32>),
}

/// Attributes ready to be evaluated. Cheap to clone, and independent of any sampler.
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
    /// The value of attribute number `i` at one point, the index of a variant as a number; `None`
    /// past the last attribute.
    ///
    /// An id that is no point of the pattern has a value too; its rank is the greatest there is.
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

    /// Overwrites `columns` with one column per attribute, one value per id. Columns of an earlier
    /// call keep their memory.
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
            // The usual ones have loops of their own, without a question at each point.
            match bound.attribute {
                Attribute::Angle => compiled::write(ids.map(|id| angle(hash(key, id))), out),
                Attribute::Scale(range) => {
                    compiled::write(ids.map(|id| range.pick(hash(key, id))), out);
                }
                Attribute::Uniform(_) => compiled::write(ids.map(|id| unit(hash(key, id))), out),
                ref other => compiled::write(ids.map(|id| self.number(other, key, id)), out),
            }
            *column = Column::Numbers(values);
        }
    }

    /// [`write`](Self::write) for the ids of points.
    pub fn write_points(&self, points: &[Point], columns: &mut Vec<Column>) {
        self.write(points.iter().map(|point| point.id), columns);
    }

    fn number(&self, attribute: &Attribute, key: u64, id: PointId) -> f64 {
        match attribute {
            Attribute::Angle => angle(hash(key, id)),
            Attribute::Scale(range) => range.pick(hash(key, id)),
            Attribute::Rank => {
                let depth = self.pattern.depth(id.x, id.y);
                rank(depth, self.pattern.alpha().set_side())
            }
            Attribute::Uniform(_) => unit(hash(key, id)),
            Attribute::Variant(variants) => variants.pick(hash(key, id)).into(),
        }
    }
}

/// Under which an attribute is hashed.
fn key(seed: Seed, attribute: &Attribute) -> u64 {
    const PURPOSE: u64 = 0x4154_5452_4942_5554;
    split_mix(split_mix(seed.0 ^ PURPOSE).wrapping_add(attribute.code() << 32))
}

/// Uniform over `u64`.
#[inline]
fn hash(key: u64, id: PointId) -> u64 {
    let x = split_mix(key ^ (id.x as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
    split_mix(x.wrapping_add(key) ^ (id.y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
}

/// 2π·(1 − 2⁻⁵³) rounds to the number before 2π.
#[inline]
fn angle(hash: u64) -> f64 {
    unit(hash) * TAU
}

/// The upper 53 bits as a number in [0, 1).
#[inline]
fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}
