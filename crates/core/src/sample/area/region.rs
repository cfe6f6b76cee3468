//! Boxes.

use crate::error::{Error, ErrorKind, number};

/// A half-open box in world coordinates: min ≤ p < max along both axes. It may be empty.
///
/// ```
/// use strew_core::Region;
///
/// let region = Region::new([0.0, 0.0], [64.0, 64.0])?;
/// assert!(region.contains([0.0, 0.0]) && !region.contains([64.0, 0.0]));
/// // Chunks of a grid share no point and leave no gap.
/// assert_eq!(Region::chunk(64.0, [0, 0])?, region);
/// # Ok::<(), strew_core::Error>(())
/// ```
///
/// A point lies in a box by its reported `f64` coordinates. A [chunk](Self::chunk) of a grid is compared
/// exactly instead when its points are requested. Boxes are equal if their corners are.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    min: [f64; 2],
    max: [f64; 2],
    /// The chunk that this is.
    chunk: Option<Chunk>,
}

/// A square of a grid: size · at ≤ p < size · (at + 1) along both axes, exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chunk {
    pub(crate) size: f64,
    pub(crate) at: [i64; 2],
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        (self.min, self.max) == (other.min, other.max)
    }
}

/// The names of the four numbers of a box.
pub(crate) const CORNERS: [&str; 4] = ["min_x", "min_y", "max_x", "max_y"];

impl Region {
    /// The largest absolute column or row of a chunk.
    pub const MAX_CHUNK: i64 = 1 << 52;

    /// The box from `min` (included) to `max` (excluded), in world coordinates.
    ///
    /// # Errors
    /// [`ErrorKind::Region`] unless all four numbers are finite and max ≥ min along both axes. The
    /// [field](Error::field) is `min_x`, `min_y`, `max_x` or `max_y`.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// let region = Region::new([-1.0, 0.0], [1.0, 0.5])?;
    /// assert_eq!((region.min(), region.max()), ([-1.0, 0.0], [1.0, 0.5]));
    /// assert_eq!(Region::new([0.0, 0.0], [f64::NAN, 1.0]).unwrap_err().field(), "max_x");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(min: [f64; 2], max: [f64; 2]) -> Result<Self, Error> {
        for (value, name) in min.into_iter().chain(max).zip(CORNERS) {
            if !value.is_finite() {
                let value = number(value);
                return Err(Error::new(
                    ErrorKind::Region,
                    name,
                    value,
                    "a finite number",
                ));
            }
        }
        for axis in 0..2 {
            if max[axis] < min[axis] {
                let (name, value) = (CORNERS[2 + axis], number(max[axis]));
                let allowed = alloc::format!("at least {}, the lower bound", number(min[axis]));
                return Err(Error::new(ErrorKind::Region, name, value, allowed));
            }
        }
        Ok(Self::between(min, max))
    }

    /// The chunk in column `at[0]` and row `at[1]` of a grid of squares with a side of `size` world
    /// units. Chunks partition the plane exactly.
    ///
    /// The corners are multiples of `size`, rounded to `f64`. The points of a chunk are found by the exact
    /// multiples: a point lies in the chunk if its exact position divided by `size` rounds down to `at`.
    /// Far from the origin, where `f64` coordinates are coarse, a point next to an edge can lie in a chunk
    /// and be reported with the coordinates of the neighbor's corner.
    ///
    /// # Errors
    /// [`ErrorKind::Chunk`] unless `size` is a positive finite number, column and row are within
    /// ±[`MAX_CHUNK`](Self::MAX_CHUNK), and the corners are finite and differ in `f64`.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// let [a, b] = [Region::chunk(0.1, [2, 0])?, Region::chunk(0.1, [3, 0])?];
    /// // 3 · 0.1 is not 0.3 in `f64`, but both chunks end at the same number.
    /// assert_eq!(a.max()[0], b.min()[0]);
    /// assert!(Region::chunk(0.1, [i64::MAX, 0]).is_err());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn chunk(size: f64, at: [i64; 2]) -> Result<Self, Error> {
        const ALLOWED: &str = "a size above 0 and two integers within ±4503599627370496";
        let refused = |problem: &'static str| {
            let value = alloc::format!("{}/{}/{}", number(size), at[0], at[1]);
            Error::new(ErrorKind::Chunk, "chunk", value, ALLOWED).because(problem)
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
    pub(crate) const fn between(min: [f64; 2], max: [f64; 2]) -> Self {
        let chunk = None;
        Self { min, max, chunk }
    }

    /// The chunk that this is, if it is one.
    pub(crate) const fn as_chunk(&self) -> Option<Chunk> {
        self.chunk
    }

    /// Whether another box lies inside without touching the sides.
    pub(super) fn surrounds(&self, other: &Self) -> bool {
        (0..2).all(|i| self.min[i] < other.min[i] && other.max[i] < self.max[i])
    }

    /// The lower corner, included, in world coordinates.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// assert_eq!(Region::chunk(64.0, [3, -2])?.min(), [192.0, -128.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn min(&self) -> [f64; 2] {
        self.min
    }

    /// The upper corner, excluded, in world coordinates.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// assert_eq!(Region::chunk(64.0, [3, -2])?.max(), [256.0, -64.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn max(&self) -> [f64; 2] {
        self.max
    }

    /// Width and height, in world units.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// assert_eq!(Region::new([-1.0, 2.0], [4.0, 4.5])?.sides(), [5.0, 2.5]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn sides(&self) -> [f64; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
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
        let [min, max] = [
            [0, 1].map(|i| self.min[i].max(other.min[i])),
            [0, 1].map(|i| self.max[i].min(other.max[i])),
        ];
        let reversed = (0..2).any(|i| max[i] < min[i]);
        Self::between(min, if reversed { min } else { max })
    }

    /// `Some(true)` if all points of another box, its upper sides included, lie inside, `Some(false)` if
    /// none does.
    pub(super) fn within(&self, other: &Self) -> Option<bool> {
        let (min, max) = (other.min, other.max);
        if (0..2).any(|i| max[i] < self.min[i] || self.max[i] <= min[i]) || self.is_empty() {
            Some(false)
        } else {
            (self.contains(min) && self.contains(max)).then_some(true)
        }
    }

    /// Whether the box has no extent along an axis, and so no points.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// assert!(Region::new([0.0, 0.0], [5.0, 0.0])?.is_empty());
    /// assert!(!Region::new([0.0, 0.0], [5.0, 1e-9])?.is_empty());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.max[0] <= self.min[0] || self.max[1] <= self.min[1]
    }

    /// Whether a place lies inside.
    ///
    /// ```
    /// use strew_core::Region;
    ///
    /// let region = Region::new([0.0, 0.0], [4.0, 4.0])?;
    /// assert!(region.contains([0.0, 3.9]) && !region.contains([0.0, 4.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        (0..2).all(|i| self.min[i] <= p[i] && p[i] < self.max[i])
    }
}
