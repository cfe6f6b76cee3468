//! Polygons, with exact and half-open membership.

use alloc::vec::Vec;

use robust::{Coord, orient2d};

use super::{
    AreaError, Region, State,
    steps::{Reach, Stepper},
};

/// A polygon: one ring or several; a point is inside if a ray from it crosses the rings an odd
/// number of times, so rings within rings are holes.
///
/// A point on an edge counts as on its right (greater x), or above it if it is horizontal, whatever
/// the order of the vertices. Left of or right of an edge is decided exactly (Shewchuk 1997). So
/// polygons that share an edge, vertex by vertex, have no point in common and leave none out, and a
/// rectangle has the points of the half-open box.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// The edges that rays can cross.
    edges: Vec<Edge>,
    /// The horizontal ones: rays along them cross nothing, but strips end there.
    flat: Vec<Edge>,
    /// Of edges that have been left out because they lie beyond greater x: from which y on rays
    /// cross one more or one fewer of them. Ascending.
    turns: Vec<f64>,
    /// The greatest x of the box that has been focused on.
    right: f64,
    vertices: usize,
    min: [f64; 2],
    max: [f64; 2],
}

/// An edge, upward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    low: [f64; 2],
    high: [f64; 2],
    /// x per y; infinite if that is more than can be reckoned with.
    slope: f64,
    /// How far from the edge its x by the slope may be.
    slack: f64,
}

impl Polygon {
    /// A polygon of rings. The last vertex of a ring may repeat the first.
    ///
    /// # Errors
    /// [`AreaError`] without a ring, for one of fewer than three vertices, and for coordinates
    /// that are not finite.
    pub fn new(rings: &[impl AsRef<[[f64; 2]]>]) -> Result<Self, AreaError> {
        if rings.is_empty() {
            return Err(AreaError::NoRing);
        }
        let mut polygon = Self {
            edges: Vec::new(),
            flat: Vec::new(),
            turns: Vec::new(),
            right: f64::INFINITY,
            vertices: 0,
            min: [f64::INFINITY; 2],
            max: [f64::NEG_INFINITY; 2],
        };
        for (number, ring) in rings.iter().enumerate() {
            polygon.add(number, ring.as_ref())?;
        }
        Ok(polygon)
    }

    fn add(&mut self, number: usize, ring: &[[f64; 2]]) -> Result<(), AreaError> {
        for (vertex, p) in ring.iter().enumerate() {
            if let Some(&value) = p.iter().find(|value| !value.is_finite()) {
                return Err(AreaError::VertexNotFinite {
                    ring: number,
                    vertex,
                    value,
                });
            }
        }
        let mut vertices: Vec<[f64; 2]> = ring.to_vec();
        vertices.dedup();
        if vertices.len() > 1 && vertices.first() == vertices.last() {
            vertices.pop();
        }
        if vertices.len() < 3 {
            return Err(AreaError::FewVertices {
                ring: number,
                vertices: vertices.len(),
            });
        }
        self.vertices += vertices.len();
        for (i, &a) in vertices.iter().enumerate() {
            let b = vertices[(i + 1) % vertices.len()];
            for (v, (min, max)) in a.iter().zip(self.min.iter_mut().zip(&mut self.max)) {
                *min = min.min(*v);
                *max = max.max(*v);
            }
            let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
            let is_flat = low[1] == high[1];
            let edges = if is_flat {
                &mut self.flat
            } else {
                &mut self.edges
            };
            edges.push(Edge::new(low, high));
        }
        Ok(())
    }

    /// How many vertices it has.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        self.vertices
    }

    /// The box around it.
    #[must_use]
    pub fn bounds(&self) -> Region {
        // Rings have been checked.
        Region::between(self.min, self.max)
    }

    /// Whether a point lies inside.
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        self.is_in_beyond(p[1]) ^ is_odd(self.edges.iter(), p)
    }

    /// Whether rays of this y cross an odd number of the edges left out.
    fn is_in_beyond(&self, y: f64) -> bool {
        self.turns.partition_point(|&turn| turn <= y) % 2 == 1
    }

    /// The same polygon for points within a box, its upper sides included; `Ok` if all of them are
    /// inside or all outside.
    pub(super) fn focus(&self, within: &Region) -> Result<bool, Self> {
        let ([x0, y0], [x1, y1]) = (within.min(), within.max());
        let mut near = Self {
            edges: Vec::new(),
            flat: Vec::new(),
            turns: self.turns.clone(),
            right: x1,
            ..*self
        };
        for edge in self.edges.iter().filter(|edge| edge.touches([y0, y1])) {
            let [left, right] = edge.ends();
            if left > x1 {
                near.turns.extend([edge.low[1], edge.high[1]]);
            } else if right >= x0 {
                near.edges.push(*edge);
            }
        }
        let meets = |edge: &&Edge| {
            let [left, right] = edge.ends();
            edge.touches([y0, y1]) && left <= x1 && right >= x0
        };
        near.flat.extend(self.flat.iter().filter(meets));
        near.turns.sort_unstable_by(f64::total_cmp);
        // Where one edge ends and the next begins nothing changes.
        let mut turns: Vec<f64> = Vec::with_capacity(near.turns.len());
        for &turn in near.turns.iter().filter(|&&turn| turn <= y1) {
            // Those that all rays of the box are above count by their parity.
            let turn = if turn <= y0 { f64::NEG_INFINITY } else { turn };
            if turns.last() == Some(&turn) {
                turns.pop();
            } else {
                turns.push(turn);
            }
        }
        near.turns = turns;
        if near.edges.is_empty() && near.flat.is_empty() && near.turns.iter().all(|&t| t <= y0) {
            return Ok(near.is_in_beyond(y0));
        }
        Err(near)
    }

    /// The boxes around its edges.
    pub(super) fn sides(&self) -> impl Iterator<Item = Region> {
        let side = |edge: &Edge| {
            let (a, b) = (edge.low, edge.high);
            let pick = |f: fn(f64, f64) -> f64| [f(a[0], b[0]), f(a[1], b[1])];
            Region::between(pick(f64::min), pick(f64::max))
        };
        self.edges.iter().chain(&self.flat).map(side)
    }

    /// What a strip is along x, within what has been focused on.
    pub(super) fn steps(&self, strip: [f64; 2], stepper: &mut Stepper) {
        let Stepper { steps, edges } = stepper;
        let [y0, _] = strip;
        edges.clear();
        let beyond = self.is_in_beyond(y0);
        let mut inside = beyond;
        for edge in self.edges.iter().chain(&self.flat) {
            if edge.touches(strip) {
                let crosses = edge.low[1] <= y0 && y0 < edge.high[1];
                inside ^= crosses;
                let reach = Reach {
                    extent: edge.extent(strip),
                    crosses,
                    edge: *edge,
                };
                // They are few, and come in order more often than not.
                let is_after = |other: &&Reach| other.extent[0] > reach.extent[0];
                let after = edges.iter().rev().take_while(is_after).count();
                edges.insert(edges.len() - after, reach);
            }
        }
        let state = |inside| if inside { State::In } else { State::Out };
        steps.restart(state(inside));
        // Edges whose extents meet are asked together. What is beyond them is another part of the
        // outline, which crosses all levels of the strip an even number of times, or all an odd.
        let mut next = 0;
        while let Some(first) = edges.get(next) {
            steps.push(first.extent[0], State::Test);
            let start = next;
            let mut end = first.extent[1];
            while let Some(reach) = edges.get(next)
                && reach.extent[0] <= end
            {
                end = end.max(reach.extent[1]);
                inside ^= reach.crosses;
                next += 1;
            }
            // Edges that go on beyond the box may end in the strip, where those that have been left
            // out begin.
            if end <= self.right {
                steps.note(start..next, inside);
            }
            steps.push(end, state(inside));
        }
        debug_assert_eq!(inside, beyond, "rings are closed");
    }
}

/// Whether a point is left of an odd number of edges, on a level with them.
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

impl Edge {
    fn new(low: [f64; 2], high: [f64; 2]) -> Self {
        let [width, height] = [high[0] - low[0], high[1] - low[1]];
        // Far from where products overflow.
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

    /// Its least and its greatest x.
    const fn ends(&self) -> [f64; 2] {
        let (a, b) = (self.low[0], self.high[0]);
        if a < b { [a, b] } else { [b, a] }
    }

    /// Whether a ray from `p` toward greater x crosses the edge.
    fn is_right_of(&self, p: [f64; 2]) -> bool {
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        self.low[1] <= p[1]
            && p[1] < self.high[1]
            && (p[0] < self.low[0].min(self.high[0])
                || p[0] < self.low[0].max(self.high[0])
                    && orient2d(coord(self.low), coord(self.high), coord(p)) > 0.0)
    }

    /// [`is_right_of`](Self::is_right_of) by the slope, and whether that may be wrong.
    #[inline(always)]
    fn nearly_is_right_of(&self, p: [f64; 2]) -> [bool; 2] {
        let level = (self.low[1] <= p[1]) & (p[1] < self.high[1]);
        let ahead = self.low[0] + (p[1] - self.low[1]) * self.slope - p[0];
        // Not a number nor infinite where the slope is too steep.
        let sure = (ahead.abs() > self.slack) & (ahead.abs() < f64::INFINITY);
        [level & (ahead > 0.0), level & !sure]
    }

    fn touches(&self, [y0, y1]: [f64; 2]) -> bool {
        self.low[1] <= y1 && self.high[1] >= y0
    }

    /// The x that the edge may have between two y that it touches, a little wider than need be.
    fn extent(&self, [y0, y1]: [f64; 2]) -> [f64; 2] {
        let ([x0, low], [x1, high]) = (self.low, self.high);
        let [a, b] = if self.slope.is_finite() {
            [y0, y1].map(|y| x0 + (y.clamp(low, high) - low) * self.slope)
        } else {
            [x0, x1]
        };
        [a.min(b) - self.slack, a.max(b) + self.slack]
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_rectangle_is_the_half_open_box() {
        let ring = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let polygon = Polygon::new(&[ring]).expect("valid");
        let region = polygon.bounds();
        for x in [-0.5, 0.0, 0.5, 2.0, 2.5] {
            for y in [-0.5, 0.0, 0.5, 1.0, 1.5] {
                assert_eq!(polygon.contains([x, y]), region.contains([x, y]), "{x} {y}");
            }
        }
    }

    #[test]
    fn holes_and_errors() {
        let outer = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let hole = vec![[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
        let polygon = Polygon::new(&[outer, hole]).expect("valid");
        assert!(polygon.contains([0.5, 2.0]) && !polygon.contains([2.0, 2.0]));
        assert!(!polygon.contains([1.0, 1.0]) && polygon.contains([3.0, 3.0]));
        assert_eq!(polygon.vertices(), 8);
        let none: [&[[f64; 2]]; 0] = [];
        assert_eq!(Polygon::new(&none), Err(AreaError::NoRing));
        assert_eq!(
            Polygon::new(&[[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]]),
            Err(AreaError::FewVertices {
                ring: 0,
                vertices: 2
            })
        );
        assert!(Polygon::new(&[[[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]]]).is_err());
    }

    proptest! {
        /// A fan of triangles around a point divides its hull's inside: no point twice, none lost.
        #[test]
        fn triangles_that_share_edges_divide_the_plane(
            corners in prop::collection::vec((-8i32..8, -8i32..8), 3..8),
            center in (-8i32..8, -8i32..8), x in -10i32..10, y in -10i32..10, scale in 1e-3..1e3f64,
        ) {
            let place = |(x, y): (i32, i32)| [f64::from(x) * scale, f64::from(y) * scale];
            let ring: Vec<[f64; 2]> = corners.iter().copied().map(place).collect();
            let whole = Polygon::new(core::slice::from_ref(&ring));
            prop_assume!(whole.is_ok());
            let p = place((x, y));
            // By parity the fan's triangles add up to the whole, overlapping or not.
            let mut inside = false;
            for (i, &a) in ring.iter().enumerate() {
                let triangle = [a, ring[(i + 1) % ring.len()], place(center)];
                inside ^= Polygon::new(&[triangle]).is_ok_and(|t| t.contains(p));
            }
            prop_assert_eq!(whole.expect("valid").contains(p), inside);
        }
    }
}
