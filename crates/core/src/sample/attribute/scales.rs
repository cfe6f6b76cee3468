//! Scales that depend on the variant.

use alloc::{sync::Arc, vec::Vec};

use super::{EvenVariants, ScaleRange, Variants};
use crate::error::{Error, ErrorKind};

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

/// How the variants are spread.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spread {
    Chance(Variants),
    Even(EvenVariants),
}

impl Variants {
    /// A range of scales for each of these variants, in their order.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] unless there is one range for each.
    ///
    /// ```
    /// use strew_core::{ErrorKind, ScaleRange, Variants};
    ///
    /// let trees: Variants = "oak:3,birch".parse()?;
    /// let error = trees.scales(vec![ScaleRange::new(0.8, 1.2)?]).unwrap_err();
    /// assert_eq!((error.kind(), error.allowed()), (ErrorKind::Attribute, "2 ranges, one for each variant"));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn scales(&self, ranges: Vec<ScaleRange>) -> Result<VariantScales, Error> {
        VariantScales::new(Spread::Chance(self.clone()), ranges)
    }
}

impl EvenVariants {
    /// A range of scales for each of these variants, in the order in which they were listed.
    ///
    /// # Errors
    /// [`ErrorKind::Attribute`] unless there is one range for each.
    ///
    /// ```
    /// use strew_core::{ScaleRange, Variants};
    ///
    /// let trees = "oak:3,birch".parse::<Variants>()?.evenly()?;
    /// let (tall, short) = (ScaleRange::new(0.9, 1.3)?, ScaleRange::new(0.5, 0.8)?);
    /// assert_eq!(trees.scales(vec![tall, short])?.ranges(), [tall, short]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn scales(&self, ranges: Vec<ScaleRange>) -> Result<VariantScales, Error> {
        VariantScales::new(Spread::Even(self.clone()), ranges)
    }
}

impl VariantScales {
    fn new(of: Spread, ranges: Vec<ScaleRange>) -> Result<Self, Error> {
        let count = match &of {
            Spread::Chance(variants) => variants.count(),
            Spread::Even(even) => even.variants().count(),
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
    ///
    /// ```
    /// use strew_core::{ScaleRange, Variants};
    ///
    /// let range = ScaleRange::new(0.8, 1.2)?;
    /// let scales = "oak:3,birch".parse::<Variants>()?.scales(vec![range; 2])?;
    /// assert_eq!(scales.ranges().len(), 2);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn ranges(&self) -> &[ScaleRange] {
        &self.ranges
    }

    /// The variants that have these scales.
    pub(super) const fn of(&self) -> &Spread {
        &self.of
    }

    /// The range of a variant.
    pub(super) fn range(&self, index: u32) -> ScaleRange {
        self.ranges[index as usize]
    }
}
