//! Balls.

use super::Region;
use crate::error::{Error, ErrorKind, number};

/// A ball without its surface: the points nearer to the center than the radius, compared as squared distances in `f64`.
///
/// ```
/// use strew_core::space::Ball;
///
/// let ball = Ball::new([10.0, 0.0, 0.0], 5.0)?;
/// assert!(ball.contains([14.9, 0.0, 0.0]) && !ball.contains([10.0, 0.0, 5.0]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    center: [f64; 3],
    radius: f64,
}

/// Room for rounding, relative.
const SLACK: f64 = 1e-12;

impl Ball {
    /// The ball around a center, with a radius in world units.
    ///
    /// # Errors
    /// [`ErrorKind::Area`] if a number is not finite or the radius is not positive.
    ///
    /// ```
    /// use strew_core::{ErrorKind, space::Ball};
    ///
    /// assert_eq!(Ball::new([0.0; 3], 0.0).unwrap_err().kind(), ErrorKind::Area);
    /// ```
    pub fn new(center: [f64; 3], radius: f64) -> Result<Self, Error> {
        if let Some(&value) = center.iter().find(|value| !value.is_finite()) {
            let value = alloc::format!("at {}", number(value));
            return Err(Error::new(ErrorKind::Area, "center", value, "finite"));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            let (value, allowed) = (number(radius), "a positive finite number");
            return Err(Error::new(ErrorKind::Area, "radius", value, allowed));
        }
        Ok(Self { center, radius })
    }

    /// The center, in world coordinates.
    ///
    /// ```
    /// use strew_core::space::Ball;
    ///
    /// assert_eq!(Ball::new([1.0, 2.0, 3.0], 5.0)?.center(), [1.0, 2.0, 3.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn center(&self) -> [f64; 3] {
        self.center
    }

    /// The radius, in world units.
    ///
    /// ```
    /// use strew_core::space::Ball;
    ///
    /// assert_eq!(Ball::new([1.0, 2.0, 3.0], 5.0)?.radius(), 5.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a place lies inside. The surface does not.
    ///
    /// ```
    /// use strew_core::space::Ball;
    ///
    /// let ball = Ball::new([0.0; 3], 3.0)?;
    /// assert!(ball.contains([1.0, 2.0, 1.9]) && !ball.contains([1.0, 2.0, 2.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 3]) -> bool {
        let [dx, dy, dz] = [0, 1, 2].map(|i| p[i] - self.center[i]);
        dx * dx + dy * dy + dz * dz < self.radius * self.radius
    }

    /// A box around the ball, with room for rounding; `None` if its corners are not finite.
    pub(super) fn bounds(&self) -> Option<Region> {
        let reach = self.radius * (1.0 + SLACK);
        let min = self.center.map(|c| (c - reach).next_down());
        let max = self.center.map(|c| (c + reach).next_up());
        Region::new(min, max).ok()
    }

    /// `Some(true)` if all points of a box, its upper sides included, lie inside, `Some(false)` if none does. Rounded
    /// differences, squares and sums are monotone, so the nearest and the farthest place of the box decide.
    pub(super) fn within(&self, within: &Region) -> Option<bool> {
        let (min, max) = (within.min(), within.max());
        let nearest = [0, 1, 2].map(|i| self.center[i].max(min[i]).min(max[i]));
        let farthest = [0, 1, 2].map(|i| {
            let [a, b] = [min[i], max[i]].map(|v| (v - self.center[i]).abs());
            if a > b { min[i] } else { max[i] }
        });
        if !self.contains(nearest) {
            Some(false)
        } else if self.contains(farthest) {
            Some(true)
        } else {
            None
        }
    }
}
