//! Boxes.

use crate::error::{Error, ErrorKind, number};

/// A half-open box in world coordinates: min ≤ p < max along all axes. It may be empty.
///
/// A point lies in a box by its reported `f64` coordinates. A [chunk](Self::chunk) of a grid is compared exactly instead
/// when its points are requested. Boxes are equal if their corners are.
///
/// ```
/// use strew_core::space::Region;
///
/// let region = Region::new([0.0; 3], [64.0; 3])?;
/// assert!(region.contains([0.0, 0.0, 0.0]) && !region.contains([0.0, 64.0, 0.0]));
/// assert_eq!(Region::chunk(64.0, [0, 0, 0])?, region);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Region {
    min: [f64; 3],
    max: [f64; 3],
    /// The chunk that this is.
    chunk: Option<Chunk>,
}

/// A cube of a grid: size · at ≤ p < size · (at + 1) along all axes, exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chunk {
    pub(crate) size: f64,
    pub(crate) at: [i64; 3],
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        (self.min, self.max) == (other.min, other.max)
    }
}

/// The names of the six numbers of a box.
pub(crate) const CORNERS: [&str; 6] = ["min_x", "min_y", "min_z", "max_x", "max_y", "max_z"];

impl Region {
    /// The largest absolute number of a chunk along an axis.
    pub const MAX_CHUNK: i64 = 1 << 52;

    /// The box from `min` (included) to `max` (excluded), in world coordinates.
    ///
    /// # Errors
    /// [`ErrorKind::Region`] unless all six numbers are finite and max ≥ min along all axes. The
    /// [field](Error::field) is `min_x`, …, `max_z`.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// let region = Region::new([-1.0, 0.0, 0.0], [1.0, 0.5, 2.0])?;
    /// assert_eq!(region.max(), [1.0, 0.5, 2.0]);
    /// assert_eq!(Region::new([0.0; 3], [1.0, 1.0, f64::NAN]).unwrap_err().field(), "max_z");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Result<Self, Error> {
        for (value, name) in min.into_iter().chain(max).zip(CORNERS) {
            if !value.is_finite() {
                let (value, allowed) = (number(value), "a finite number");
                return Err(Error::new(ErrorKind::Region, name, value, allowed));
            }
        }
        for axis in 0..3 {
            if max[axis] < min[axis] {
                let (name, value) = (CORNERS[3 + axis], number(max[axis]));
                let allowed = alloc::format!("at least {}, the lower bound", number(min[axis]));
                return Err(Error::new(ErrorKind::Region, name, value, allowed));
            }
        }
        Ok(Self::between(min, max))
    }

    /// The chunk at the place `at` of a grid of cubes with a side of `size` world units. Chunks partition space exactly:
    /// a point lies in the chunk if its exact position divided by `size` rounds down to `at`.
    ///
    /// # Errors
    /// [`ErrorKind::Chunk`] unless `size` is a positive finite number, the place is within
    /// ±[`MAX_CHUNK`](Self::MAX_CHUNK) along all axes, and the corners are finite and differ in `f64`.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// let [a, b] = [Region::chunk(0.1, [2, 0, 0])?, Region::chunk(0.1, [3, 0, 0])?];
    /// assert_eq!(a.max()[0], b.min()[0]);
    /// assert!(Region::chunk(0.1, [i64::MAX, 0, 0]).is_err());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn chunk(size: f64, at: [i64; 3]) -> Result<Self, Error> {
        const ALLOWED: &str = "a size above 0 and three integers within ±4503599627370496";
        let refused = |problem: &'static str| {
            let value = alloc::format!("{}/{}/{}/{}", number(size), at[0], at[1], at[2]);
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
    pub(crate) const fn between(min: [f64; 3], max: [f64; 3]) -> Self {
        let chunk = None;
        Self { min, max, chunk }
    }

    /// The chunk that this is, if it is one.
    pub(crate) const fn as_chunk(&self) -> Option<Chunk> {
        self.chunk
    }

    /// The lower corner, included, in world coordinates.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// assert_eq!(Region::chunk(64.0, [3, -2, 0])?.min(), [192.0, -128.0, 0.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn min(&self) -> [f64; 3] {
        self.min
    }

    /// The upper corner, excluded, in world coordinates.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// assert_eq!(Region::chunk(64.0, [3, -2, 0])?.max(), [256.0, -64.0, 64.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn max(&self) -> [f64; 3] {
        self.max
    }

    /// Its shadow along z: the rectangle of its x and y.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// let shadow = Region::new([0.0; 3], [4.0, 5.0, 6.0])?.shadow();
    /// assert_eq!(shadow.max(), [4.0, 5.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn shadow(&self) -> crate::Region {
        let ([x, y, _], [max_x, max_y, _]) = (self.min, self.max);
        crate::Region::between([x, y], [max_x, max_y])
    }

    /// Whether the box has no extent along an axis, and so no points.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// assert!(Region::new([0.0; 3], [5.0, 5.0, 0.0])?.is_empty());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.max[i] <= self.min[i])
    }

    /// Whether a place lies inside.
    ///
    /// ```
    /// use strew_core::space::Region;
    ///
    /// let region = Region::new([0.0; 3], [4.0; 3])?;
    /// assert!(region.contains([0.0, 3.9, 1.0]) && !region.contains([0.0, 4.0, 1.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 3]) -> bool {
        (0..3).all(|i| self.min[i] <= p[i] && p[i] < self.max[i])
    }

    /// `Some(true)` if all points of another box, its upper sides included, lie inside, `Some(false)` if none does.
    pub(super) fn within(&self, other: &Self) -> Option<bool> {
        let (min, max) = (other.min, other.max);
        if (0..3).any(|i| max[i] < self.min[i] || self.max[i] <= min[i]) || self.is_empty() {
            Some(false)
        } else {
            (self.contains(min) && self.contains(max)).then_some(true)
        }
    }
}
