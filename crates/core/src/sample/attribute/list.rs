//! Lists of attributes.

use alloc::vec::Vec;

use super::Attribute;
use crate::error::{Error, ErrorKind};

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
