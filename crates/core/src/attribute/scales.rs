//! Ranges of scales, one for all points or one for each variant.

use alloc::{sync::Arc, vec::Vec};

use super::{Kinds, Variants};
use crate::error::{Error, ErrorKind, number};

/// The range of a scale: 0 ≤ min ≤ max.
///
/// ```
/// use strew_core::{Attribute, ScaleRange};
///
/// let range = ScaleRange::new(0.8, 1.2)?;
/// assert_eq!(Attribute::Scale(range), Attribute::scale(0.8, 1.2)?);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleRange {
    min: f64,
    max: f64,
}

impl ScaleRange {
    /// The greatest scale.
    pub const LIMIT: f64 = 1e9;

    /// The range from `min` to `max`, both included.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] unless 0 ≤ min ≤ max ≤ [`LIMIT`](Self::LIMIT).
    pub fn new(min: f64, max: f64) -> Result<Self, Error> {
        if 0.0 <= min && min <= max && max <= Self::LIMIT {
            Ok(Self { min, max })
        } else {
            let value = alloc::format!("{} to {}", number(min), number(max));
            let allowed = "two numbers with 0 <= min <= max <= 1e9";
            Err(Error::new(
                ErrorKind::Attribute,
                "scale_range",
                value,
                allowed,
            ))
        }
    }

    /// The least scale, included.
    #[must_use]
    pub const fn min(self) -> f64 {
        self.min
    }

    /// The greatest scale, included.
    #[must_use]
    pub const fn max(self) -> f64 {
        self.max
    }
}

/// A range of scales for each variant: oaks and bushes are of different heights.
///
/// The place of a point in its range is the same as in a single range, [`Attribute::Scale`](crate::Attribute::Scale).
/// Cheap to clone.
///
/// ```
/// use strew_core::{Attribute, Attributes, PointSet, ScaleRange, Table, Variants};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let kinds: Variants = "oak:1,bush:3".parse()?;
/// let scales = kinds.scales(vec![ScaleRange::new(0.9, 1.3)?, ScaleRange::new(0.2, 0.4)?])?;
/// let list = vec![Attribute::Variant(kinds), Attribute::VariantScale(scales)];
/// let set = PointSet::new(table).seed(7);
/// let bound = set.attributes(&Attributes::new(list)?)?;
/// for point in set.chunk(20.0, [0, 0])? {
///     let [variant, scale] = [0, 1].map(|i| bound.value(i, point.id()).expect("two attributes"));
///     let range = if variant == 0.0 { 0.9..=1.3 } else { 0.2..=0.4 };
///     assert_eq!(scale, point.scale(range));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct VariantScales {
    of: Spread,
    ranges: Arc<[ScaleRange]>,
}

/// The spread of the variants.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spread {
    Chance(Variants),
    Kinds(Kinds),
}

impl Variants {
    /// A range of scales for each of these variants, in their order.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] unless there is one range for each.
    pub fn scales(&self, ranges: Vec<ScaleRange>) -> Result<VariantScales, Error> {
        VariantScales::new(Spread::Chance(self.clone()), ranges)
    }
}

impl Kinds {
    /// A range of scales for each of these kinds, in the order in which they were listed.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] unless there is one range for each.
    pub fn scales(&self, ranges: Vec<ScaleRange>) -> Result<VariantScales, Error> {
        VariantScales::new(Spread::Kinds(self.clone()), ranges)
    }
}

impl VariantScales {
    fn new(of: Spread, ranges: Vec<ScaleRange>) -> Result<Self, Error> {
        let count = match &of {
            Spread::Chance(variants) => variants.count(),
            Spread::Kinds(kinds) => kinds.variants().count(),
        };
        if ranges.len() == count {
            let ranges = ranges.into();
            return Ok(Self { of, ranges });
        }
        let value = alloc::format!("{} ranges", ranges.len());
        let allowed = alloc::format!("{count} ranges, one for each variant");
        Err(Error::new(
            ErrorKind::Attribute,
            "scale_range",
            value,
            allowed,
        ))
    }

    /// The ranges, in the order of the variants.
    #[must_use]
    pub fn ranges(&self) -> &[ScaleRange] {
        &self.ranges
    }

    /// The variants, in their order.
    #[must_use]
    pub const fn variants(&self) -> &Variants {
        match &self.of {
            Spread::Chance(variants) => variants,
            Spread::Kinds(kinds) => kinds.variants(),
        }
    }

    /// The spread of the variants.
    pub(super) const fn of(&self) -> &Spread {
        &self.of
    }

    /// The variants, if they are chosen by chance.
    pub(crate) const fn by_chance(&self) -> Option<&Variants> {
        match &self.of {
            Spread::Chance(variants) => Some(variants),
            Spread::Kinds(_) => None,
        }
    }

    /// The range of a variant.
    pub(crate) fn range(&self, index: u32) -> ScaleRange {
        self.ranges[index as usize]
    }
}
