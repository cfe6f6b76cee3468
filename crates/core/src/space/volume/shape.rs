//! Volumes: boxes, balls and prisms, combined.

use alloc::{boxed::Box, vec::Vec};

use super::{Ball, Chunk, Prism, Region};

/// A part of space.
///
/// ```
/// use strew_core::space::{Ball, Region, Volume};
///
/// let rock = Volume::from(Region::new([0.0; 3], [10.0; 3])?);
/// let cave = rock.without([Ball::new([5.0; 3], 3.0)?.into()]);
/// assert!(cave.contains([1.0; 3]) && !cave.contains([5.0; 3]));
/// assert_eq!(cave.bounds(), Region::new([0.0; 3], [10.0; 3]).ok());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Volume {
    /// A half-open box.
    Region(Region),
    /// A ball without its surface.
    Ball(Ball),
    /// An upright prism.
    Prism(Prism),
    /// The union of several volumes.
    AnyOf(Vec<Volume>),
    /// The intersection of several volumes; all of space if there are none.
    AllOf(Vec<Volume>),
    /// The complement of a volume.
    Outside(Box<Volume>),
}

impl From<Region> for Volume {
    fn from(region: Region) -> Self {
        Self::Region(region)
    }
}

impl From<Ball> for Volume {
    fn from(ball: Ball) -> Self {
        Self::Ball(ball)
    }
}

impl From<Prism> for Volume {
    fn from(prism: Prism) -> Self {
        Self::Prism(prism)
    }
}

impl Volume {
    /// The union of volumes: a single volume itself, and the empty volume if there are none.
    ///
    /// ```
    /// use strew_core::space::{Ball, Volume};
    ///
    /// let balls = [[0.0; 3], [9.0; 3]].map(|center| Ball::new(center, 2.0).map(Volume::from));
    /// let [a, b] = balls;
    /// let both = Volume::any_of([a?, b?]);
    /// assert!(both.contains([0.0; 3]) && both.contains([9.0; 3]) && !both.contains([4.5; 3]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn any_of(volumes: impl IntoIterator<Item = Self>) -> Self {
        let mut volumes: Vec<Self> = volumes.into_iter().collect();
        match volumes.pop() {
            Some(only) if volumes.is_empty() => only,
            last => {
                volumes.extend(last);
                Self::AnyOf(volumes)
            }
        }
    }

    /// The intersection of two volumes.
    ///
    /// ```
    /// use strew_core::space::{Ball, Region, Volume};
    ///
    /// let dome = Volume::from(Ball::new([0.0; 3], 5.0)?);
    /// let above = Region::new([-9.0, -9.0, 0.0], [9.0, 9.0, 9.0])?;
    /// assert!(!dome.and(above.into()).contains([0.0, 0.0, -1.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::AllOf(mut volumes), other) => {
                volumes.push(other);
                Self::AllOf(volumes)
            }
            (volume, other) => Self::AllOf([volume, other].into()),
        }
    }

    /// The volume without the parts that lie in others.
    ///
    /// ```
    /// use strew_core::space::{Ball, Volume};
    ///
    /// let shell = Volume::from(Ball::new([0.0; 3], 5.0)?).without([Ball::new([0.0; 3], 4.0)?.into()]);
    /// assert!(shell.contains([0.0, 0.0, 4.5]) && !shell.contains([0.0; 3]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn without(self, excluded: impl IntoIterator<Item = Self>) -> Self {
        let excluded: Vec<Self> = excluded.into_iter().collect();
        if excluded.is_empty() {
            return self;
        }
        self.and(Self::Outside(Box::new(Self::any_of(excluded))))
    }

    /// Whether a place lies inside.
    ///
    /// ```
    /// use strew_core::space::{Region, Volume};
    ///
    /// let outside = Volume::Outside(Box::new(Region::new([0.0; 3], [1.0; 3])?.into()));
    /// assert!(outside.contains([2.0; 3]) && !outside.contains([0.0; 3]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 3]) -> bool {
        match self {
            Self::Region(region) => region.contains(p),
            Self::Ball(ball) => ball.contains(p),
            Self::Prism(prism) => prism.contains(p),
            Self::AnyOf(volumes) => volumes.iter().any(|volume| volume.contains(p)),
            Self::AllOf(volumes) => volumes.iter().all(|volume| volume.contains(p)),
            Self::Outside(volume) => !volume.contains(p),
        }
    }

    /// A box around the volume, or `None` if it is not bounded.
    ///
    /// ```
    /// use strew_core::space::{Ball, Volume};
    ///
    /// let ball = Volume::from(Ball::new([0.0; 3], 5.0)?);
    /// assert!(ball.bounds().is_some_and(|bounds| bounds.contains([5.0, -5.0, 5.0])));
    /// assert!(Volume::Outside(Box::new(ball)).bounds().is_none());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn bounds(&self) -> Option<Region> {
        let pick = |a: [f64; 3], b: [f64; 3], pick: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|axis| pick(a[axis], b[axis]))
        };
        match self {
            Self::Region(region) => Some(*region),
            Self::Ball(ball) => ball.bounds(),
            Self::Prism(prism) => Some(prism.bounds()),
            Self::AnyOf(volumes) => {
                let mut all = volumes.iter().map(Self::bounds);
                let Some(first) = all.next() else {
                    return Some(Region::between([0.0; 3], [0.0; 3]));
                };
                all.try_fold(first?, |a, b| {
                    let b = b?;
                    let (min, max) = (
                        pick(a.min(), b.min(), f64::min),
                        pick(a.max(), b.max(), f64::max),
                    );
                    Some(Region::between(min, max))
                })
            }
            Self::AllOf(volumes) => {
                let bounded = volumes.iter().filter_map(Self::bounds);
                bounded.reduce(|a, b| {
                    let min = pick(a.min(), b.min(), f64::max);
                    // Nothing may be left between the two.
                    let max = pick(pick(a.max(), b.max(), f64::min), min, f64::max);
                    Region::between(min, max)
                })
            }
            Self::Outside(_) => None,
        }
    }

    /// The chunks of which this is the intersection with something else. Membership of a chunk is exact, which reported
    /// coordinates cannot decide.
    pub(crate) fn chunks(&self) -> Vec<Chunk> {
        match self {
            Self::Region(region) => region.as_chunk().into_iter().collect(),
            Self::AllOf(volumes) => volumes.iter().flat_map(Self::chunks).collect(),
            _ => Vec::new(),
        }
    }

    /// The volume for points of a box, its upper sides included, reduced to what matters there.
    pub(crate) fn focus(&self, within: &Region) -> Self {
        match self {
            Self::Region(region) => match region.within(within) {
                Some(state) => Self::constant(state),
                None => self.clone(),
            },
            Self::Ball(ball) => match ball.within(within) {
                Some(state) => Self::constant(state),
                None => self.clone(),
            },
            Self::Prism(prism) => match prism.focus(within) {
                Ok(state) => Self::constant(state),
                Err(near) => Self::Prism(near),
            },
            Self::AnyOf(volumes) => Self::joined(volumes, within, false),
            Self::AllOf(volumes) => Self::joined(volumes, within, true),
            Self::Outside(volume) => {
                let near = volume.focus(within);
                match near.is_all_or_nothing() {
                    Some(state) => Self::constant(!state),
                    None => Self::Outside(Box::new(near)),
                }
            }
        }
    }

    /// The intersection (`is_all`) or union of volumes in a box.
    fn joined(volumes: &[Self], within: &Region, is_all: bool) -> Self {
        let mut near = Vec::with_capacity(volumes.len());
        for volume in volumes {
            let volume = volume.focus(within);
            match volume.is_all_or_nothing() {
                Some(state) if state != is_all => return Self::constant(state),
                Some(_) => {}
                None => near.push(volume),
            }
        }
        match near.pop() {
            None => Self::constant(is_all),
            Some(only) if near.is_empty() => only,
            Some(last) => {
                near.push(last);
                if is_all {
                    Self::AllOf(near)
                } else {
                    Self::AnyOf(near)
                }
            }
        }
    }

    /// Whether this is all of space or nothing, as volumes are that were reduced to where all or none of them is.
    pub(crate) const fn is_all_or_nothing(&self) -> Option<bool> {
        match self {
            Self::AllOf(volumes) if volumes.is_empty() => Some(true),
            Self::AnyOf(volumes) if volumes.is_empty() => Some(false),
            _ => None,
        }
    }

    /// All of space or nothing.
    const fn constant(state: bool) -> Self {
        if state {
            Self::AllOf(Vec::new())
        } else {
            Self::AnyOf(Vec::new())
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::Polygon;

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![(-4i8..=4).prop_map(f64::from), -4.0..4.0f64]
    }

    fn place() -> impl Strategy<Value = [f64; 3]> {
        [coordinate(), coordinate(), coordinate()]
    }

    fn corners() -> impl Strategy<Value = Region> {
        (place(), place()).prop_map(|(a, b)| {
            let pick = |f: fn(f64, f64) -> f64| [0, 1, 2].map(|i| f(a[i], b[i]));
            Region::new(pick(f64::min), pick(f64::max)).expect("ordered")
        })
    }

    fn any_volume() -> impl Strategy<Value = Volume> {
        let ball = (place(), 0.1..4.0f64)
            .prop_map(|(center, radius)| Volume::from(Ball::new(center, radius).expect("valid")));
        let prism = prop::collection::vec([coordinate(), coordinate()], 3..7).prop_filter_map(
            "different",
            |ring| {
                let prism = Prism::new(Polygon::new(&[ring]).ok()?, [-2.0, 1.5]).expect("ordered");
                Some(Volume::from(prism))
            },
        );
        prop_oneof![corners().prop_map(Volume::from), ball, prism].prop_recursive(
            3,
            8,
            3,
            |inner| {
                prop_oneof![
                    prop::collection::vec(inner.clone(), 1..3).prop_map(Volume::any_of),
                    (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
                    (inner.clone(), inner).prop_map(|(a, b)| a.without([b])),
                ]
            },
        )
    }

    proptest! {
        #[test]
        fn focus_and_bounds_never_contradict_membership(
            volume in any_volume(), within in corners(),
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
