//! Kinds by name: variants of which each is spread as evenly as the points of all of them together.

use alloc::{format, string::String, sync::Arc, vec::Vec};

use super::Variants;
use crate::{
    error::{Error, ErrorKind, shown},
    table::Shares,
};

/// Named kinds of points, in the ratio of their weights: each of them is spread evenly, as a table with a
/// [mix](crate::table::Mix) of their shares says.
///
/// There are two ways. *Even* kinds label the points of a set, which stay where they are. *Joint* ones are of a table
/// whose points were moved, so that each kind is nearly as blue as a set of its own. Both are set by
/// [`PointSet::kinds`](crate::PointSet::kinds). Kinds by chance, which clump and leave gaps, are the
/// [variants](Variants) of [members](crate::Member::variant).
///
/// Kinds are numbered by their shares, the rarest first, and those of equal shares in the order of their names. So the
/// order in which they are listed does not matter. Cheap to clone.
///
/// ```
/// use strew_core::{Attribute, Attributes, Kinds, PointSet, Table, table::{Mix, Ranks}};
///
/// let trees = Kinds::even("oak:3,birch:1")?;
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// # let mix = Mix::scattered(table.map(), trees.shares().clone())?;
/// # let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
/// # let table = table.with_mix(mix, ranks)?;
/// let forest = PointSet::new(table).seed(7).kinds(trees.clone())?;
/// for tree in forest.chunk(20.0, [0, 0])? {
///     // Birches are the rarer kind.
///     let is_birch = forest.kind_of(tree.id()) == Some(0);
///     assert_eq!(forest.kind_name(tree.id()), Some(if is_birch { "birch" } else { "oak" }));
/// }
/// // As a column of many points.
/// let variant = forest.attributes(&Attributes::new(vec![Attribute::Kind(trees)])?)?;
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Kinds {
    variants: Variants,
    shares: Shares,
    /// The index of the variant of each kind.
    indices: Arc<[u32]>,
    is_joint: bool,
}

impl Kinds {
    /// Kinds of which each is spread evenly among points that stay where they are, from a text such as `birch:1,oak:3` or
    /// from [variants](Variants).
    ///
    /// # Errors
    /// [`ErrorKind::Variants`] as [`Variants::new`], [`ErrorKind::Shares`] as [`Shares::new`]: there are 2 to 32 kinds,
    /// each of at least 1/1024 of all points.
    pub fn even(variants: impl TryInto<Variants, Error = Error>) -> Result<Self, Error> {
        Self::new(variants.try_into()?, false)
    }

    /// Kinds of points that were moved, so that each kind is nearly as blue as a set of its own.
    ///
    /// # Errors
    /// As [`even`](Self::even).
    pub fn joint(variants: impl TryInto<Variants, Error = Error>) -> Result<Self, Error> {
        Self::new(variants.try_into()?, true)
    }

    fn new(variants: Variants, is_joint: bool) -> Result<Self, Error> {
        let all: Vec<(&str, f64)> = variants.weights().collect();
        let shares = Shares::new(all.iter().map(|(_, weight)| *weight))?;
        let mut order: Vec<u32> = (0..all.len() as u32).collect();
        let of = |i: &u32| all[*i as usize];
        order.sort_by(|a, b| of(a).1.total_cmp(&of(b).1));
        // Weights that differ may have the same share once they are rounded.
        let mut kinds: Vec<(u16, u32)> = shares.parts().iter().copied().zip(order).collect();
        kinds.sort_by(|(part, a), (other, b)| part.cmp(other).then_with(|| of(a).0.cmp(of(b).0)));
        let indices = kinds.into_iter().map(|(_, index)| index).collect();
        Ok(Self {
            variants,
            shares,
            indices,
            is_joint,
        })
    }

    /// Whether they are [joint](Self::joint) kinds.
    #[must_use]
    pub const fn is_joint(&self) -> bool {
        self.is_joint
    }

    /// The kinds as variants, in the order in which they were listed: that of the indices of a column.
    #[must_use]
    pub const fn variants(&self) -> &Variants {
        &self.variants
    }

    /// The shares that the mix of a table must have.
    #[must_use]
    pub const fn shares(&self) -> &Shares {
        &self.shares
    }

    /// The names in the order of their numbers, that of [`PointSet::kind_counts`](crate::PointSet::kind_counts).
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        let name = |&index: &u32| self.variants.name(index).unwrap_or_default();
        self.indices.iter().map(name)
    }

    /// The name of a kind, or `None` past the last one.
    #[must_use]
    pub fn name(&self, kind: u8) -> Option<&str> {
        self.variants.name(self.index(kind)?)
    }

    /// The index among the [variants](Self::variants) of a kind, or `None` past the last one.
    #[must_use]
    pub fn index(&self, kind: u8) -> Option<u32> {
        self.indices.get(usize::from(kind)).copied()
    }

    /// The number of the kind of a name.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<u8> {
        let kind = self.names().position(|known| known == name)?;
        u8::try_from(kind).ok()
    }

    /// The number of the kind of a name.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] for another name, with those that there are.
    pub(crate) fn numbered(&self, name: &str) -> Result<u8, Error> {
        self.number(name).ok_or_else(|| {
            let names: Vec<String> = self.names().map(|name| format!("`{name}`")).collect();
            let (value, allowed) = (format!("`{}`", shown(name)), names.join(" or "));
            Error::new(ErrorKind::Kinds, "the name of the kind", value, allowed)
        })
    }

    /// Refuses points that are not of these kinds.
    pub(crate) fn check(&self, shares: Option<&Shares>) -> Result<(), Error> {
        let value = match shares {
            Some(shares) if *shares == self.shares => return Ok(()),
            Some(shares) => format!("{shares}"),
            None => "none".into(),
        };
        let field = "the ratio of the table's kinds";
        let allowed = format!("{}, that of the named kinds", self.shares);
        Err(Error::new(ErrorKind::Kinds, field, value, allowed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_names_does_not_matter() {
        for text in ["c:1,b:1,a:1", "a:1,c:1,b:1", "b:7,a:7,c:7"] {
            let kinds = Kinds::even(text).expect("valid");
            assert_eq!(
                ["a", "b", "c"].map(|name| kinds.number(name)),
                [0, 1, 2].map(Some)
            );
            for kind in 0..3 {
                let name = kinds.name(kind);
                assert_eq!(name.and_then(|name| kinds.number(name)), Some(kind));
            }
            assert_eq!((kinds.index(3), kinds.name(3)), (None, None));
        }
    }

    #[test]
    fn equal_shares_are_tied_by_name_once_they_are_rounded() {
        // 1:1.0001 has no exact ratio, and both are 512 of 1024.
        for text in ["b:1,a:1.0001", "a:1,b:1.0001", "b:1.0001,a:1"] {
            let kinds = Kinds::joint(text).expect("valid");
            assert_eq!(kinds.shares().parts(), [1, 1]);
            assert_eq!([kinds.number("a"), kinds.number("b")], [Some(0), Some(1)]);
        }
    }
}
