//! Variants that are spread evenly: the kinds of a table's mix, by name.

use alloc::{sync::Arc, vec::Vec};

use super::Variants;
use crate::{
    error::{Error, ErrorKind},
    table::Shares,
};

/// Variants of which each is spread evenly, as the kinds of a table with a [mix](crate::table::Mix) of their
/// shares are. The variant of a point is its kind.
///
/// Kinds are matched with variants by share, and with those of equal shares in the order of their names. So the order
/// in which variants are listed does not matter. Cheap to clone.
///
/// ```
/// use strew_core::{Attribute, Attributes, PointSet, Table, Variants, table::{Mix, Ranks}};
///
/// let trees = "oak:3,birch:1".parse::<Variants>()?.evenly()?;
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let mix = Mix::scattered(table.map(), trees.shares().clone())?;
/// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
/// let set = PointSet::new(table.with_mix(mix, ranks)?).seed(7);
///
/// let variant = Attributes::new(vec![Attribute::EvenVariant(trees.clone())])?;
/// let variant = set.attributes(&variant)?;
/// for point in set.chunk(20.0, [0, 0])? {
///     // Birches are the rarer kind.
///     let index = variant.value(0, point.id()).expect("the first attribute") as u32;
///     let is_birch = set.kind_of(point.id()) == Some(0);
///     assert_eq!(trees.variants().name(index), Some(if is_birch { "birch" } else { "oak" }));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EvenVariants {
    variants: Variants,
    shares: Shares,
    /// The index of the variant of each kind.
    indices: Arc<[u32]>,
}

impl Variants {
    /// These variants, each spread evenly.
    ///
    /// # Errors
    /// [`ErrorKind::Shares`] as [`Shares::new`].
    ///
    /// ```
    /// use strew_core::{ErrorKind, Variants};
    ///
    /// let trees = "oak:0.75,birch:0.25".parse::<Variants>()?.evenly()?;
    /// assert_eq!(trees.shares().to_string(), "1:3");
    /// let error = "oak:1000000,birch".parse::<Variants>()?.evenly().unwrap_err();
    /// assert_eq!(error.kind(), ErrorKind::Shares);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn evenly(&self) -> Result<EvenVariants, Error> {
        let all: Vec<(&str, f64)> = self.weights().collect();
        let shares = Shares::new(all.iter().map(|(_, weight)| *weight))?;
        let mut order: Vec<u32> = (0..all.len() as u32).collect();
        let of = |i: &u32| all[*i as usize];
        order.sort_by(|a, b| of(a).1.total_cmp(&of(b).1));
        // Weights that differ may have the same share once they are rounded.
        let mut kinds: Vec<(u16, u32)> = shares.parts().iter().copied().zip(order).collect();
        kinds.sort_by(|(part, a), (other, b)| part.cmp(other).then_with(|| of(a).0.cmp(of(b).0)));
        Ok(EvenVariants {
            variants: self.clone(),
            shares,
            indices: kinds.into_iter().map(|(_, index)| index).collect(),
        })
    }
}

impl EvenVariants {
    /// The variants, in the order in which they were listed: that of the indices of a column.
    ///
    /// ```
    /// use strew_core::Variants;
    ///
    /// let trees: Variants = "oak:3,birch".parse()?;
    /// assert_eq!(trees.evenly()?.variants(), &trees);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn variants(&self) -> &Variants {
        &self.variants
    }

    /// The shares that the mix of a table must have.
    ///
    /// ```
    /// use strew_core::Variants;
    ///
    /// let trees = "oak:30,birch:10,bush:100".parse::<Variants>()?.evenly()?;
    /// assert_eq!(trees.shares().to_string(), "1:3:10");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn shares(&self) -> &Shares {
        &self.shares
    }

    /// The index of the variant of a kind, or `None` past the last kind.
    ///
    /// ```
    /// use strew_core::Variants;
    ///
    /// let trees = "oak:3,elm:1,birch:1".parse::<Variants>()?.evenly()?;
    /// let names = (0..3).filter_map(|kind| trees.variants().name(trees.index(kind)?));
    /// assert_eq!(names.collect::<Vec<_>>(), ["birch", "elm", "oak"]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn index(&self, kind: u8) -> Option<u32> {
        self.indices.get(usize::from(kind)).copied()
    }

    /// The kind of the variant of a name, as [`PointSet::only`](crate::PointSet::only) takes it.
    ///
    /// ```
    /// use strew_core::Variants;
    ///
    /// let trees = "oak:3,birch".parse::<Variants>()?.evenly()?;
    /// assert_eq!((trees.kind("birch"), trees.kind("oak"), trees.kind("elm")), (Some(0), Some(1), None));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn kind(&self, name: &str) -> Option<u8> {
        let is_it = |&index: &u32| self.variants.name(index) == Some(name);
        let kind = self.indices.iter().position(is_it)?;
        u8::try_from(kind).ok()
    }

    /// Refuses points that are not of these kinds.
    pub(super) fn check(&self, shares: Option<&Shares>) -> Result<(), Error> {
        let allowed = alloc::format!("those of a mix in the ratio {}", self.shares);
        let value = match shares {
            Some(shares) if *shares == self.shares => return Ok(()),
            Some(shares) => alloc::format!("in the ratio {shares}"),
            None => "none".into(),
        };
        Err(Error::new(
            ErrorKind::Kinds,
            "the kinds of the table",
            value,
            allowed,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_names_does_not_matter() {
        for text in ["c:1,b:1,a:1", "a:1,c:1,b:1", "b:7,a:7,c:7"] {
            let even = text
                .parse::<Variants>()
                .and_then(|v| v.evenly())
                .expect("valid");
            assert_eq!(
                ["a", "b", "c"].map(|name| even.kind(name)),
                [0, 1, 2].map(Some)
            );
            for kind in 0..3 {
                let name = even
                    .index(kind)
                    .and_then(|index| even.variants().name(index));
                assert_eq!(name.and_then(|name| even.kind(name)), Some(kind));
            }
            assert_eq!(even.index(3), None);
        }
    }

    #[test]
    fn equal_shares_are_tied_by_name_once_they_are_rounded() {
        // 1:1.0001 has no exact ratio, and both are 512 of 1024.
        for text in ["b:1,a:1.0001", "a:1,b:1.0001", "b:1.0001,a:1"] {
            let even = text
                .parse::<Variants>()
                .and_then(|v| v.evenly())
                .expect("valid");
            assert_eq!(even.shares().parts(), [1, 1]);
            assert_eq!([even.kind("a"), even.kind("b")], [Some(0), Some(1)]);
        }
    }
}
