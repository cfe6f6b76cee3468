//! The kinds of attributes, and lists of them.

use alloc::vec::Vec;
use core::{fmt, str::FromStr};

use super::{Kinds, ScaleRange, VariantScales, Variants};
use crate::error::{Error, ErrorKind, quoted};

/// A value that every point has.
///
/// ```
/// use strew_core::Attribute;
///
/// let parsed: Attribute = "u3".parse()?;
/// assert_eq!(parsed, Attribute::uniform(3)?);
/// // Scales and variants have parameters, so they are not read from a name.
/// assert!("scale".parse::<Attribute>().is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Attribute {
    /// `angle`: a rotation in radians, uniform in [0, 2π).
    Angle,
    /// `rotation`, of points in space: a uniform unit quaternion.
    Rotation,
    /// `scale`: a factor, uniform in a range.
    Scale(ScaleRange),
    /// `scale`: a factor, uniform in a range that depends on the variant.
    VariantScale(VariantScales),
    /// `variant`: one of several named things, chosen by weight.
    Variant(Variants),
    /// `variant`: one of several named things, each spread evenly: the kind of the point.
    Kind(Kinds),
    /// `rank`: a number in [0, 1), uniform over the pattern. The points of rank below λ are a share λ of
    /// all, nested as λ grows.
    Rank,
    /// `u1` to `u16`: a number uniform in [0, 1), a multiple of 2⁻⁵³.
    Uniform(UniformNumber),
}

/// The number of a uniform attribute, from 1 to 16.
///
/// ```
/// use strew_core::{Attribute, UniformNumber};
///
/// assert_eq!(Attribute::Uniform(UniformNumber::new(16)?).name(), "u16");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UniformNumber(u8);

impl UniformNumber {
    /// The largest number.
    pub const MAX: u8 = 16;

    /// The uniform number `n`, from 1 to [`MAX`](Self::MAX).
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] for any other.
    pub fn new(n: u8) -> Result<Self, Error> {
        if (1..=Self::MAX).contains(&n) {
            Ok(Self(n))
        } else {
            let field = "uniform";
            Err(Error::new(ErrorKind::Attribute, field, n, "from 1 to 16"))
        }
    }

    /// The number, from 1 to 16.
    #[must_use]
    pub const fn get(self) -> u8 {
        self.0
    }
}

/// The names of the uniform numbers.
const UNIFORM_NAMES: [&str; UniformNumber::MAX as usize] = [
    "u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8", "u9", "u10", "u11", "u12", "u13", "u14", "u15",
    "u16",
];

impl Attribute {
    /// A scale uniform in [min, max].
    ///
    /// # Errors
    /// As [`ScaleRange::new`].
    pub fn scale(min: f64, max: f64) -> Result<Self, Error> {
        ScaleRange::new(min, max).map(Self::Scale)
    }

    /// The uniform number `n`.
    ///
    /// # Errors
    /// As [`UniformNumber::new`].
    pub fn uniform(n: u8) -> Result<Self, Error> {
        UniformNumber::new(n).map(Self::Uniform)
    }

    /// The name: `angle`, `rotation`, `scale`, `variant`, `rank`, `u1` to `u16`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Rotation => "rotation",
            Self::Scale(_) | Self::VariantScale(_) => "scale",
            Self::Variant(_) | Self::Kind(_) => "variant",
            Self::Rank => "rank",
            Self::Uniform(n) => UNIFORM_NAMES[n.0 as usize - 1],
        }
    }

    /// The codes keep the hashes of attributes apart. Part of the algorithm version.
    pub(crate) const ANGLE: u64 = 1;
    pub(crate) const SCALE: u64 = 2;
    pub(crate) const VARIANT: u64 = 3;
    /// Of the first of three numbers; the next two codes are of the others.
    pub(crate) const ROTATION: u64 = 4;

    pub(crate) const fn uniform_code(n: u8) -> u64 {
        0x100 + n as u64
    }

    /// The variants, if the attribute is a variant, however these are spread.
    #[must_use]
    pub const fn variants(&self) -> Option<&Variants> {
        match self {
            Self::Variant(variants) => Some(variants),
            Self::Kind(kinds) => Some(kinds.variants()),
            _ => None,
        }
    }

    /// The code of this attribute. Those that are not hashed have 0.
    pub(crate) const fn code(&self) -> u64 {
        match self {
            Self::Rank | Self::Kind(_) => 0,
            Self::Angle => Self::ANGLE,
            Self::Rotation => Self::ROTATION,
            Self::Scale(_) | Self::VariantScale(_) => Self::SCALE,
            Self::Variant(_) => Self::VARIANT,
            Self::Uniform(n) => Self::uniform_code(n.0),
        }
    }
}

/// Reads the attributes that consist of a name: `angle`, `rotation`, `rank`, `u1` to `u16`.
impl FromStr for Attribute {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let incomplete = |name, needs: &'static str| {
            let error = Error::new(ErrorKind::Attribute, "attribute", name, needs);
            Err(error.because("incomplete"))
        };
        match text {
            "angle" => Ok(Self::Angle),
            "rotation" => Ok(Self::Rotation),
            "rank" => Ok(Self::Rank),
            "scale" => incomplete("scale", "given with a range, such as 0.8 to 1.2"),
            "variant" => incomplete(
                "variant",
                "given with a list of variants, such as oak:3,birch:1",
            ),
            _ => match (1..).zip(UNIFORM_NAMES).find(|(_, name)| *name == text) {
                Some((n, _)) => Self::uniform(n),
                None => {
                    let value = quoted(text);
                    let allowed =
                        "angle, scale, variant, rank or u1 to u16, in space rotation for angle";
                    Err(Error::new(
                        ErrorKind::Attribute,
                        "attribute",
                        value,
                        allowed,
                    ))
                }
            },
        }
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A list of different attributes, in order. It may be empty.
///
/// It makes columns for many points at once; for single points see [`Member`](crate::Member).
///
/// ```
/// use strew_core::{Attribute, Attributes, PointId, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).seed(7);
/// let attributes = Attributes::new(vec![
///     Attribute::Angle,
///     Attribute::scale(0.8, 1.2)?,
///     Attribute::Variant("oak:3,birch:1".parse()?),
///     "u1".parse()?,
/// ])?;
/// let ids = [PointId { x: -31, y: 52 }, PointId { x: 4, y: 9 }];
/// let columns = set.attributes(&attributes)?.columns(ids);
/// assert_eq!(columns.len(), 4);
/// let scales = columns[1].numbers().expect("scales are numbers");
/// assert!(scales.iter().all(|scale| (0.8..=1.2).contains(scale)));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes(Vec<Attribute>);

impl Attributes {
    /// A list of attributes.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] if two have the same name.
    pub fn new(list: Vec<Attribute>) -> Result<Self, Error> {
        for (i, attribute) in list.iter().enumerate() {
            if list[..i].iter().any(|a| a.name() == attribute.name()) {
                let allowed = "listed once";
                let error =
                    Error::new(ErrorKind::Attribute, "attribute", attribute.name(), allowed);
                return Err(error.because("listed twice"));
            }
        }
        Ok(Self(list))
    }

    /// The attributes in order.
    #[must_use]
    pub fn as_slice(&self) -> &[Attribute] {
        &self.0
    }
}
