//! Edges of polygons, with the exact, half-open test on which membership rests, and steps: the states of a strip of the
//! plane along x (inside, outside, or to be tested).

use alloc::{vec, vec::Vec};
use core::ops::Range;

use robust::{Coord, orient2d};

use super::Region;

/// The relation of a rectangle of the plane to an area. Ordered so that "any of" is the maximum and "all of" the
/// minimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum State {
    /// All of it is outside.
    Out,
    /// Points must be tested one by one.
    Test,
    /// All of it is inside.
    In,
}

/// A change of state at `from`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    from: f64,
    state: State,
    near: Option<Near>,
}

/// The edges of a [`Stepper`] that decide whether a point of a stretch is inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Near {
    first: u32,
    end: u32,
    /// Whether points are inside whose rays cross none of these edges.
    inside: bool,
}

/// An edge that touches a strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// The x-interval that it covers.
    pub(super) extent: [f64; 2],
    /// Whether it crosses the lower side of the strip.
    pub(super) crosses: bool,
    pub(super) edge: Edge,
}

/// States along x, ascending, the first from −∞. Nothing is known at a step itself; users keep a
/// distance from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Steps(Vec<Step>);

/// Computes the steps of one strip after another in the same memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stepper {
    pub(crate) steps: Steps,
    /// The edges of the last polygon that touch the strip, from left to right.
    pub(super) edges: Vec<Reach>,
}

impl Stepper {
    /// Whether a point of a stretch with known edges is inside.
    #[inline]
    pub(crate) fn contains(&self, near: Near, p: [f64; 2]) -> bool {
        let edges = &self.edges[near.first as usize..near.end as usize];
        near.inside ^ is_odd(edges.iter().map(|reach| &reach.edge), p)
    }
}

impl Default for Steps {
    fn default() -> Self {
        Self::all(State::Out)
    }
}

impl Steps {
    /// Steps with one state everywhere.
    pub(crate) fn all(state: State) -> Self {
        Self(vec![Step {
            from: f64::NEG_INFINITY,
            state,
            near: None,
        }])
    }

    /// Sets one state everywhere.
    pub(crate) fn restart(&mut self, state: State) {
        self.0.clear();
        self.push(f64::NEG_INFINITY, state);
    }

    /// Adds a step at or above the last one.
    pub(super) fn push(&mut self, from: f64, state: State) {
        if self.0.last().is_none_or(|last| last.state != state) {
            let near = None;
            self.0.push(Step { from, state, near });
        }
    }

    /// Records, after a step to [`State::Test`], the edges that decide there, and whether points right of
    /// them are inside.
    pub(super) fn note(&mut self, edges: Range<usize>, inside: bool) {
        if let Some(last) = self.0.last_mut() {
            last.near = Some(Near {
                first: edges.start as u32,
                end: edges.end as u32,
                inside,
            });
        }
    }

    /// Sets the states of a box.
    pub(super) fn set_region(&mut self, region: &Region, [y0, y1]: [f64; 2]) {
        let (min, max) = (region.min(), region.max());
        self.restart(State::Out);
        if region.is_empty() || y1 < min[1] || y0 >= max[1] {
            return;
        }
        let within = min[1] <= y0 && y1 < max[1];
        self.push(min[0], if within { State::In } else { State::Test });
        self.push(max[0], State::Out);
    }

    /// The states of two areas combined by `join`.
    pub(super) fn join(&self, other: &Self, join: fn(State, State) -> State) -> Self {
        let (mut a, mut b) = (self.0.as_slice(), other.0.as_slice());
        let mut state = [State::Out; 2];
        let mut joined = Self(Vec::with_capacity(a.len() + b.len()));
        while let Some(from) = match (a.first(), b.first()) {
            (Some(a), Some(b)) => Some(a.from.min(b.from)),
            (Some(step), None) | (None, Some(step)) => Some(step.from),
            (None, None) => None,
        } {
            for (steps, state) in [&mut a, &mut b].into_iter().zip(&mut state) {
                while let Some((first, rest)) = steps.split_first()
                    && first.from <= from
                {
                    *state = first.state;
                    *steps = rest;
                }
            }
            joined.push(from, join(state[0], state[1]));
        }
        joined
    }

    /// Turns the states of an area into those of its complement.
    pub(super) fn invert(&mut self) {
        for step in &mut self.0 {
            step.state = match step.state {
                State::Out => State::In,
                State::Test => State::Test,
                State::In => State::Out,
            };
            if let Some(near) = &mut step.near {
                near.inside = !near.inside;
            }
        }
    }

    /// The stretches of equal state: start, end, state, and the edges that decide, if known.
    pub(crate) fn stretches(&self) -> impl Iterator<Item = (f64, f64, State, Option<Near>)> {
        let ends = self.0.iter().skip(1).map(|step| step.from);
        let ends = ends.chain([f64::INFINITY]);
        self.0
            .iter()
            .zip(ends)
            .map(|(step, end)| (step.from, end, step.state, step.near))
    }

    #[cfg(test)]
    pub(super) fn at(&self, x: f64) -> State {
        let after = self.0.partition_point(|step| step.from <= x);
        self.0[after - 1].state
    }
}

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
