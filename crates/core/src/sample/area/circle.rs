//! Circles.

use super::{AreaError, Region, State, Steps};

/// A disk: the points nearer to the center than the radius, by squared distances in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    center: [f64; 2],
    radius: f64,
}

impl Circle {
    /// The disk around a center.
    ///
    /// # Errors
    /// [`AreaError`] if a number is not finite or the radius is not positive.
    pub fn new(center: [f64; 2], radius: f64) -> Result<Self, AreaError> {
        if let Some(&value) = center.iter().find(|value| !value.is_finite()) {
            return Err(AreaError::CenterNotFinite(value));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(AreaError::Radius(radius));
        }
        Ok(Self { center, radius })
    }

    /// The center.
    #[must_use]
    pub const fn center(&self) -> [f64; 2] {
        self.center
    }

    /// The radius.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a point lies inside.
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        let [dx, dy] = [p[0] - self.center[0], p[1] - self.center[1]];
        dx * dx + dy * dy < self.radius * self.radius
    }

    /// A box around it, a little wider than need be; `None` if its corners are not finite.
    pub(super) fn bounds(&self) -> Option<Region> {
        let reach = self.radius * (1.0 + SLACK);
        let min = self.center.map(|c| (c - reach).next_down());
        let max = self.center.map(|c| (c + reach).next_up());
        Region::new(min, max).ok()
    }

    /// Whether all points of a box, its upper sides included, are inside or none: rounded
    /// differences, squares and sums grow with what they are made of, so its nearest and its
    /// farthest place decide.
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

    pub(super) fn steps(&self, [y0, y1]: [f64; 2], steps: &mut Steps) {
        let [x, y] = self.center;
        let r2 = self.radius * self.radius;
        let far = (y0 - y).abs().max((y1 - y).abs());
        let near = if y0 <= y && y <= y1 {
            0.0
        } else {
            (y0 - y).abs().min((y1 - y).abs())
        };
        // Squares and differences are off by a few units in the last place of the larger term.
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

/// Relative room for rounding.
const SLACK: f64 = 1e-12;
