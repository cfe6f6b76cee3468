//! Boxes.

use alloc::{format, string::String};
use core::array::from_fn;

use crate::error::{Error, ErrorKind, number};

/// A half-open box in world coordinates: min ≤ p < max along all axes. It may be empty. It is a box of the plane
/// unless `D` says otherwise; [`space::Region`](crate::space::Region) is one in space.
///
/// ```
/// use strew_core::{Region, space};
///
/// let region = Region::new([0.0, 0.0], [64.0, 64.0])?;
/// assert!(region.contains([0.0, 0.0]) && !region.contains([64.0, 0.0]));
/// // Chunks of a grid share no point and leave no gap.
/// assert_eq!(Region::chunk(64.0, [0, 0])?, region);
/// let cube = space::Region::chunk(64.0, [0, 0, 1])?;
/// assert!(cube.contains([0.0, 0.0, 64.0]) && cube.shadow() == region);
/// # Ok::<(), strew_core::Error>(())
/// ```
///
/// A point lies in a box by its reported `f64` coordinates. A [chunk](Self::chunk) of a grid is compared
/// exactly instead when its points are requested. Boxes are equal if their corners are.
#[derive(Clone, Copy, Debug)]
pub struct Region<const D: usize = 2> {
    min: [f64; D],
    max: [f64; D],
    /// The chunk that this is.
    chunk: Option<Chunk<D>>,
}

/// A square or cube of a grid: size · at ≤ p < size · (at + 1) along all axes, exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chunk<const D: usize> {
    pub(crate) size: f64,
    pub(crate) at: [i64; D],
}

impl<const D: usize> PartialEq for Region<D> {
    fn eq(&self, other: &Self) -> bool {
        (self.min, self.max) == (other.min, other.max)
    }
}

/// The names of the numbers of a box: of its lower and of its upper corner.
const CORNERS: [[&str; 3]; 2] = [["min_x", "min_y", "min_z"], ["max_x", "max_y", "max_z"]];

impl<const D: usize> Region<D> {
    /// The largest absolute number of a chunk along an axis.
    pub const MAX_CHUNK: i64 = 1 << 52;

    /// The box from `min` (included) to `max` (excluded), in world coordinates.
    ///
    /// # Errors
    /// [`ErrorKind::Region`] unless all numbers are finite and max ≥ min along all axes. The
    /// [field](Error::field) is `min_x`, `min_y`, `max_x` and so on.
    pub fn new(min: [f64; D], max: [f64; D]) -> Result<Self, Error> {
        let region = Self::between(min, max);
        let refused = |name, value, allowed: String| {
            Err(Error::new(ErrorKind::Region, name, number(value), allowed))
        };
        if let Some((name, value)) = region.numbers().find(|(_, value)| !value.is_finite()) {
            return refused(name, value, "a finite number".into());
        }
        match (0..D).find(|&axis| max[axis] < min[axis]) {
            Some(axis) => {
                let allowed = format!("at least {}, the lower bound", number(min[axis]));
                refused(CORNERS[1][axis], max[axis], allowed)
            }
            None => Ok(region),
        }
    }

    /// Its numbers with their names.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let corners = CORNERS.into_iter().zip([self.min, self.max]);
        corners.flat_map(|(names, corner)| names.into_iter().zip(corner))
    }

    /// The chunk at the place `at` (column, row and layer) of a grid of squares or cubes with a side of `size` world
    /// units. Chunks partition the plane, or space, exactly.
    ///
    /// The corners are multiples of `size`, rounded to `f64`. The points of a chunk are found by the exact
    /// multiples: a point lies in the chunk if its exact position divided by `size` rounds down to `at`.
    /// Far from the origin, where `f64` coordinates are coarse, a point next to an edge can lie in a chunk
    /// and be reported with the coordinates of the neighbor's corner.
    ///
    /// # Errors
    /// [`ErrorKind::Chunk`] unless `size` is a positive finite number, the place is within
    /// ±[`MAX_CHUNK`](Self::MAX_CHUNK) along all axes, and the corners are finite and differ in `f64`.
    pub fn chunk(size: f64, at: [i64; D]) -> Result<Self, Error> {
        let refused = |problem: &'static str| {
            let value = at
                .iter()
                .fold(number(size), |text, at| format!("{text}/{at}"));
            let many = if D == 2 { "two" } else { "three" };
            let allowed = format!(
                "a size above 0 and {many} integers within ±{}",
                Self::MAX_CHUNK
            );
            Error::new(ErrorKind::Chunk, "chunk", value, allowed).because(problem)
        };
        if !(size > 0.0 && size.is_finite()) {
            return Err(refused("the size is not a finite number above 0"));
        }
        if at.iter().any(|v| v.unsigned_abs() > Self::MAX_CHUNK as u64) {
            return Err(refused("too far from the origin"));
        }
        let corner = |offset: i64| at.map(|v| (v + offset) as f64 * size);
        let region = Self::new(corner(0), corner(1));
        let region = region.map_err(|_| refused("the corners are not finite"))?;
        if region.is_empty() {
            return Err(refused("too small to have an extent there"));
        }
        let chunk = Some(Chunk { size, at });
        Ok(Self { chunk, ..region })
    }

    /// The box between corners known to be in order. They may be infinite.
    pub(crate) const fn between(min: [f64; D], max: [f64; D]) -> Self {
        let chunk = None;
        Self { min, max, chunk }
    }

    /// The chunk that this is, if it is one.
    pub(crate) const fn as_chunk(&self) -> Option<Chunk<D>> {
        self.chunk
    }

    /// Whether another box lies inside without touching the sides.
    pub(super) fn surrounds(&self, other: &Self) -> bool {
        (0..D).all(|i| self.min[i] < other.min[i] && other.max[i] < self.max[i])
    }

    /// The lower corner, included, in world coordinates.
    #[must_use]
    pub const fn min(&self) -> [f64; D] {
        self.min
    }

    /// The upper corner, excluded, in world coordinates.
    #[must_use]
    pub const fn max(&self) -> [f64; D] {
        self.max
    }

    /// Width, height and depth, in world units.
    #[must_use]
    pub fn sides(&self) -> [f64; D] {
        from_fn(|i| self.max[i] - self.min[i])
    }

    /// The intersection of two boxes; empty if they do not meet.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// let [a, b] = [Region::new([0.0, 0.0], [4.0, 4.0])?, Region::new([3.0, 1.0], [9.0, 2.0])?];
    /// assert_eq!(a.and(b), Region::new([3.0, 1.0], [4.0, 2.0])?);
    /// assert!(a.and(Region::new([4.0, 0.0], [9.0, 4.0])?).is_empty());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn and(&self, other: Self) -> Self {
        let min: [f64; D] = from_fn(|i| self.min[i].max(other.min[i]));
        let max: [f64; D] = from_fn(|i| self.max[i].min(other.max[i]));
        let reversed = (0..D).any(|i| max[i] < min[i]);
        Self::between(min, if reversed { min } else { max })
    }

    /// The smallest box around two.
    pub(crate) fn around(&self, other: &Self) -> Self {
        Self::between(
            from_fn(|i| self.min[i].min(other.min[i])),
            from_fn(|i| self.max[i].max(other.max[i])),
        )
    }

    /// `Some(true)` if all points of another box, its upper sides included, lie inside, `Some(false)` if
    /// none does.
    pub(super) fn within(&self, other: &Self) -> Option<bool> {
        let (min, max) = (other.min, other.max);
        if (0..D).any(|i| max[i] < self.min[i] || self.max[i] <= min[i]) || self.is_empty() {
            Some(false)
        } else {
            (self.contains(min) && self.contains(max)).then_some(true)
        }
    }

    /// Whether the box has no extent along an axis, and so no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        (0..D).any(|i| self.max[i] <= self.min[i])
    }

    /// Whether a place lies inside.
    #[must_use]
    pub fn contains(&self, p: [f64; D]) -> bool {
        (0..D).all(|i| self.min[i] <= p[i] && p[i] < self.max[i])
    }
}

impl Region<3> {
    /// Its shadow along z: the rectangle of its x and y.
    #[must_use]
    pub const fn shadow(&self) -> Region {
        let ([x, y, _], [max_x, max_y, _]) = (self.min, self.max);
        Region::between([x, y], [max_x, max_y])
    }
}
