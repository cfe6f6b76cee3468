//! Upright prisms.

use alloc::boxed::Box;

use super::{
    Polygon, Region,
    shape::{Area, Outlined, Shape},
};
use crate::error::{Error, ErrorKind, number};

/// An upright prism: a polygon, holes included, from a height (included) to another (excluded).
///
/// ```
/// use strew_core::{Polygon, space::Prism};
///
/// let roof = Polygon::new(&[[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]])?;
/// let hall = Prism::new(roof, [0.0, 4.0])?;
/// assert!(hall.contains([1.0, 1.0, 3.9]) && !hall.contains([1.0, 1.0, 4.0]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// The polygon.
    base: Box<Area>,
    /// The box around it.
    bounds: Region<3>,
}

impl Prism {
    /// The prism over a polygon between two heights, in world coordinates.
    ///
    /// # Errors
    /// [`ErrorKind::Area`] unless both heights are finite and the second is at least the first.
    pub fn new(base: Polygon, heights: [f64; 2]) -> Result<Self, Error> {
        for (name, value) in ["bottom", "top"].into_iter().zip(heights) {
            if !value.is_finite() {
                let (value, allowed) = (number(value), "a finite number");
                return Err(Error::new(ErrorKind::Area, name, value, allowed));
            }
        }
        let [bottom, top] = heights;
        if top < bottom {
            let allowed = alloc::format!("at least {}, the bottom", number(bottom));
            return Err(Error::new(ErrorKind::Area, "top", number(top), allowed));
        }
        let ([x, y], [end_x, end_y]) = (base.bounds().min(), base.bounds().max());
        Ok(Self {
            base: Box::new(Area::Outlined(base)),
            bounds: Region::between([x, y, bottom], [end_x, end_y, top]),
        })
    }

    /// A box around the prism, of its heights.
    #[must_use]
    pub const fn bounds(&self) -> Region<3> {
        self.bounds
    }

    /// The number of vertices of the polygon.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.base.vertices()
    }

    /// Whether a place lies inside.
    #[must_use]
    pub fn contains(&self, [x, y, z]: [f64; 3]) -> bool {
        self.bounds.min()[2] <= z && z < self.bounds.max()[2] && self.base.contains([x, y])
    }

    /// The prism for points of a box, its upper sides included: whether all or none of them lie inside, or the part of
    /// the polygon that decides.
    pub(super) fn focus(&self, within: &Region<3>) -> Result<bool, Self> {
        let (min, max) = (within.min(), within.max());
        let [bottom, top] = [self.bounds.min()[2], self.bounds.max()[2]];
        if max[2] < bottom || top <= min[2] {
            return Ok(false);
        }
        let near = self
            .base
            .focus(&Region::between([min[0], min[1]], [max[0], max[1]]));
        let is_between = bottom <= min[2] && max[2] < top;
        match near.is_all_or_nothing() {
            Some(false) => Ok(false),
            Some(true) if is_between => Ok(true),
            _ => Err(Self {
                base: Box::new(near),
                bounds: self.bounds,
            }),
        }
    }
}

/// A part of space: boxes, balls and prisms, combined.
pub type Volume = Shape<3, Prism>;

impl From<Prism> for Volume {
    fn from(prism: Prism) -> Self {
        Self::Outlined(prism)
    }
}

impl Outlined<3> for Prism {
    fn contains(&self, p: [f64; 3]) -> bool {
        self.contains(p)
    }

    fn bounds(&self) -> Region<3> {
        self.bounds()
    }

    fn vertices(&self) -> usize {
        self.vertices()
    }

    fn focus(&self, within: &Region<3>) -> Result<bool, Self> {
        self.focus(within)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::shape::shape::tests::{any_box, any_polygon, any_shape};

    fn any_volume() -> impl Strategy<Value = Volume> {
        any_shape(any_polygon().prop_map(|polygon| {
            let prism = Prism::new(polygon, [-2.0, 1.5]);
            Volume::from(prism.expect("ordered"))
        }))
    }

    proptest! {
        #[test]
        fn focus_and_bounds_never_contradict_membership(
            volume in any_volume(), within in any_box(),
            parts in prop::collection::vec(prop::array::uniform3(0.0..=1.0f64), 40),
        ) {
            let near = volume.focus(&within);
            let bounds = volume.bounds();
            for part in parts {
                let p = [0, 1, 2].map(|i| {
                    let (min, max) = (within.min()[i], within.max()[i]);
                    (min + part[i] * (max - min)).min(max)
                });
                prop_assert_eq!(near.contains(p), volume.contains(p), "{:?}", p);
                let around = bounds.is_none_or(|bounds| bounds.contains(p));
                prop_assert!(around || !volume.contains(p), "{p:?}");
            }
        }
    }
}
