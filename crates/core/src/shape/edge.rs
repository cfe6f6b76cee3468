//! Edges of polygons: the exact, half-open test on which membership rests.

use robust::{Coord, orient2d};

/// An edge of a polygon, from its lower to its upper end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    /// x per y; infinite if the quotient would overflow.
    slope: f64,
    /// A bound on the error of an x computed by the slope.
    slack: f64,
}

impl Edge {
    pub(super) fn new(low: [f64; 2], high: [f64; 2]) -> Self {
        let [width, height] = [high[0] - low[0], high[1] - low[1]];
        // So that products stay far from overflow.
        let slope = if width.abs() < 1e300 && height > 0.0 && height < 1e300 {
            width / height
        } else {
            f64::INFINITY
        };
        let slack = 4e-15 * (low[0].abs() + high[0].abs());
        Self {
            low,
            high,
            slope,
            slack,
        }
    }

    /// The least and the greatest x.
    pub(super) const fn ends(&self) -> [f64; 2] {
        let (a, b) = (self.low[0], self.high[0]);
        if a < b { [a, b] } else { [b, a] }
    }

    /// Whether a ray from `p` toward greater x crosses the edge: `p` is on a level with it, the lower
    /// end included and the upper one excluded, and left of it, exactly (Shewchuk 1997).
    fn is_right_of(&self, p: [f64; 2]) -> bool {
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        self.low[1] <= p[1]
            && p[1] < self.high[1]
            && (p[0] < self.low[0].min(self.high[0])
                || p[0] < self.low[0].max(self.high[0])
                    && orient2d(coord(self.low), coord(self.high), coord(p)) > 0.0)
    }

    /// [`is_right_of`](Self::is_right_of) computed by the slope, and whether that may be wrong.
    #[inline(always)]
    fn nearly_is_right_of(&self, p: [f64; 2]) -> [bool; 2] {
        let level = (self.low[1] <= p[1]) & (p[1] < self.high[1]);
        let ahead = self.low[0] + (p[1] - self.low[1]) * self.slope - p[0];
        // NaN or infinite where the slope is.
        let sure = (ahead.abs() > self.slack) & (ahead.abs() < f64::INFINITY);
        [level & (ahead > 0.0), level & !sure]
    }

    /// Whether the edge has points with y₀ ≤ y ≤ y₁.
    pub(super) fn touches(&self, [y0, y1]: [f64; 2]) -> bool {
        self.low[1] <= y1 && self.high[1] >= y0
    }

    /// The range of x of the edge for y₀ ≤ y ≤ y₁, which it touches, with room for rounding.
    pub(super) fn extent(&self, [y0, y1]: [f64; 2]) -> [f64; 2] {
        let ([x0, low], [x1, high]) = (self.low, self.high);
        let [a, b] = if self.slope.is_finite() {
            [y0, y1].map(|y| x0 + (y.clamp(low, high) - low) * self.slope)
        } else {
            [x0, x1]
        };
        [a.min(b) - self.slack, a.max(b) + self.slack]
    }
}

/// Whether a ray from a point toward greater x crosses an odd number of edges.
#[inline(always)]
pub(super) fn is_odd<'a>(edges: impl Iterator<Item = &'a Edge> + Clone, p: [f64; 2]) -> bool {
    let mut odd = false;
    let mut doubtful = false;
    for edge in edges.clone() {
        let [crosses, unsure] = edge.nearly_is_right_of(p);
        odd ^= crosses;
        doubtful |= unsure;
    }
    if doubtful {
        odd = is_odd_exactly(edges, p);
    }
    odd
}

#[cold]
#[inline(never)]
fn is_odd_exactly<'a>(edges: impl Iterator<Item = &'a Edge>, p: [f64; 2]) -> bool {
    edges.filter(|edge| edge.is_right_of(p)).count() % 2 == 1
}
