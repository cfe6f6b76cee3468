//! Circles and balls.

use alloc::format;
use core::array::from_fn;

use super::{
    Region,
    steps::{State, Steps},
};
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
pub struct Ball<const D: usize> {
    center: [f64; D],
    radius: f64,
}

/// A disk without its rim.
pub type Circle = Ball<2>;

impl<const D: usize> Ball<D> {
    /// The ball around a center, with a radius in world units.
    ///
    /// # Errors
    /// [`ErrorKind::Area`] if a number is not finite or the radius is not positive.
    pub fn new(center: [f64; D], radius: f64) -> Result<Self, Error> {
        if let Some(&value) = center.iter().find(|value| !value.is_finite()) {
            let value = format!("at {}", number(value));
            return Err(Error::new(ErrorKind::Area, "center", value, "finite"));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            let (value, allowed) = (number(radius), "a positive finite number");
            return Err(Error::new(ErrorKind::Area, "radius", value, allowed));
        }
        Ok(Self { center, radius })
    }

    /// The center, in world coordinates.
    #[must_use]
    pub const fn center(&self) -> [f64; D] {
        self.center
    }

    /// The radius, in world units.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a place lies inside. The rim does not.
    #[must_use]
    pub fn contains(&self, p: [f64; D]) -> bool {
        let squares = from_fn::<f64, D, _>(|i| (p[i] - self.center[i]) * (p[i] - self.center[i]));
        squares.iter().sum::<f64>() < self.radius * self.radius
    }

    /// A box around it, with room for rounding; `None` if its corners are not finite.
    pub(super) fn bounds(&self) -> Option<Region<D>> {
        let reach = self.radius * (1.0 + SLACK);
        let min = self.center.map(|c| (c - reach).next_down());
        let max = self.center.map(|c| (c + reach).next_up());
        Region::new(min, max).ok()
    }

    /// `Some(true)` if all points of a box, its upper sides included, lie inside, `Some(false)` if none
    /// does. Rounded differences, squares and sums are monotone, so the nearest and the farthest place
    /// of the box decide.
    pub(super) fn within(&self, within: &Region<D>) -> Option<bool> {
        let (min, max) = (within.min(), within.max());
        let nearest = from_fn(|i| self.center[i].max(min[i]).min(max[i]));
        let farthest = from_fn(|i| {
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

impl Circle {
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
