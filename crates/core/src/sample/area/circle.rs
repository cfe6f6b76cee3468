//! Circles.

use super::{
    Region,
    steps::{State, Steps},
};
use crate::error::{Error, ErrorKind, number};

/// A disk without its rim: the points nearer to the center than the radius, compared as squared
/// distances in `f64`.
///
/// ```
/// use strew_core::Circle;
///
/// let circle = Circle::new([10.0, 0.0], 5.0)?;
/// assert!(circle.contains([14.9, 0.0]) && !circle.contains([15.0, 0.0]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    center: [f64; 2],
    radius: f64,
}

impl Circle {
    /// The disk around a center, with a radius in world units.
    ///
    /// # Errors
    /// [`ErrorKind::Area`] if a number is not finite or the radius is not positive.
    ///
    /// ```
    /// use strew_core::{Circle, ErrorKind};
    ///
    /// let circle = Circle::new([10.0, 0.0], 5.0)?;
    /// assert_eq!((circle.center(), circle.radius()), ([10.0, 0.0], 5.0));
    /// assert_eq!(Circle::new([10.0, 0.0], 0.0).unwrap_err().kind(), ErrorKind::Area);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(center: [f64; 2], radius: f64) -> Result<Self, Error> {
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
    /// use strew_core::Circle;
    ///
    /// assert_eq!(Circle::new([10.0, 0.0], 5.0)?.center(), [10.0, 0.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn center(&self) -> [f64; 2] {
        self.center
    }

    /// The radius, in world units.
    ///
    /// ```
    /// use strew_core::Circle;
    ///
    /// assert_eq!(Circle::new([10.0, 0.0], 5.0)?.radius(), 5.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a place lies inside. The rim does not.
    ///
    /// ```
    /// use strew_core::Circle;
    ///
    /// let circle = Circle::new([0.0, 0.0], 5.0)?;
    /// assert!(circle.contains([3.0, 3.9]));
    /// // The rim is outside.
    /// assert!(!circle.contains([3.0, 4.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        let [dx, dy] = [p[0] - self.center[0], p[1] - self.center[1]];
        dx * dx + dy * dy < self.radius * self.radius
    }

    /// A box around the disk, with room for rounding; `None` if its corners are not finite.
    pub(super) fn bounds(&self) -> Option<Region> {
        let reach = self.radius * (1.0 + SLACK);
        let min = self.center.map(|c| (c - reach).next_down());
        let max = self.center.map(|c| (c + reach).next_up());
        Region::new(min, max).ok()
    }

    /// `Some(true)` if all points of a box, its upper sides included, lie inside, `Some(false)` if none
    /// does. Rounded differences, squares and sums are monotone, so the nearest and the farthest place
    /// of the box decide.
    pub(super) fn within(&self, within: &Region) -> Option<bool> {
        let (min, max) = (within.min(), within.max());
        let nearest = [0, 1].map(|i| self.center[i].max(min[i]).min(max[i]));
        let farthest = [0, 1].map(|i| {
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

    /// The states of a strip y₀ ≤ y ≤ y₁ along x.
    pub(super) fn steps(&self, [y0, y1]: [f64; 2], steps: &mut Steps) {
        let [x, y] = self.center;
        let r2 = self.radius * self.radius;
        let far = (y0 - y).abs().max((y1 - y).abs());
        let near = if y0 <= y && y <= y1 {
            0.0
        } else {
            (y0 - y).abs().min((y1 - y).abs())
        };
        // Squares and differences err by a few units in the last place of the larger term.
        let half_width = |distance: f64| {
            let square = r2 - distance * distance;
            (square > 0.0).then(|| libm::sqrt(square))
        };
        let slack = SLACK * (self.radius + x.abs());
        let outer = libm::sqrt((r2 - near * near + 2.0 * SLACK * r2).max(0.0)) + slack;
        steps.restart(State::Out);
        if near > self.radius * (1.0 + SLACK) {
            return;
        }
        let inner = half_width(far * (1.0 + SLACK))
            .map(|w| w * (1.0 - SLACK) - slack)
            .filter(|w| *w > 0.0 && far < self.radius * (1.0 - SLACK));
        steps.push(x - outer, State::Test);
        if let Some(inner) = inner {
            steps.push(x - inner, State::In);
            steps.push(x + inner, State::Test);
        }
        steps.push(x + outer, State::Out);
    }
}

/// Room for rounding, relative.
const SLACK: f64 = 1e-12;
