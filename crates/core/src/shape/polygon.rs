//! Polygons, with exact and half-open membership.

use alloc::{sync::Arc, vec::Vec};

use super::{
    Region,
    steps::{Edge, Reach, State, Stepper, is_odd},
};
use crate::{
    error::{Error, ErrorKind, number},
    parts::OfPolygons,
};

/// A polygon of one or more rings. A point is inside if a ray from it crosses the rings an odd number
/// of times, so rings within rings are holes. [`with_holes`](Self::with_holes) is for rings that may overlap, as
/// those of files do.
///
/// A point on an edge belongs to its right (greater x), or above it if the edge is horizontal, whatever
/// the order of the vertices. The side of an edge is decided exactly (Shewchuk 1997). So polygons that
/// share an edge, vertex by vertex, share no point and lose none, and a rectangle has the points of the
/// half-open box.
///
/// ```
/// use strew_core::Polygon;
///
/// let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
/// let hole = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
/// let polygon = Polygon::new(&[square, hole])?;
/// assert!(polygon.contains([0.5, 2.0]) && !polygon.contains([2.0, 2.0]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// The edges that rays can cross: all but the horizontal ones. Layers share them.
    edges: Arc<Vec<Edge>>,
    /// The horizontal edges. Rays cross none of them, but strips end there.
    flat: Arc<Vec<Edge>>,
    /// The y at which a ray crosses one more or one fewer of the edges that were left out because they
    /// lie at greater x than the box in focus. Ascending.
    turns: Vec<f64>,
    /// The greatest x of the box in focus.
    right: f64,
    vertices: usize,
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
    _part: OfPolygons,
}

impl Polygon {
    /// A polygon of rings of vertices, in world coordinates. The last vertex of a ring may repeat the first.
    ///
    /// # Errors
    /// [`ErrorKind::Area`] if there is no ring, a ring has fewer than three different vertices in a
    /// row, or a coordinate is not finite.
    pub fn new(rings: &[impl AsRef<[[f64; 2]]>]) -> Result<Self, Error> {
        if rings.is_empty() {
            let (value, allowed) = ("without a ring", "made of at least one");
            return Err(Error::new(ErrorKind::Area, "polygon", value, allowed));
        }
        let mut polygon = Self::empty()?;
        for (which, ring) in rings.iter().enumerate() {
            polygon.add(which, ring.as_ref())?;
        }
        Ok(polygon)
    }

    /// A polygon without a ring.
    pub(super) fn empty() -> Result<Self, Error> {
        Ok(Self {
            edges: Arc::default(),
            flat: Arc::default(),
            turns: Vec::new(),
            right: f64::INFINITY,
            vertices: 0,
            min: [f64::INFINITY; 2],
            max: [f64::NEG_INFINITY; 2],
            _part: OfPolygons::get()?,
        })
    }

    /// Adds a ring, the number `which` of errors.
    pub(super) fn add(&mut self, which: usize, ring: &[[f64; 2]]) -> Result<(), Error> {
        for (vertex, p) in ring.iter().enumerate() {
            if let Some(&value) = p.iter().find(|value| !value.is_finite()) {
                let field = alloc::format!("vertex {vertex} of ring {which}");
                let value = alloc::format!("at {}", number(value));
                return Err(Error::new(ErrorKind::Area, field, value, "finite"));
            }
        }
        let mut vertices: Vec<[f64; 2]> = ring.to_vec();
        vertices.dedup();
        if vertices.len() > 1 && vertices.first() == vertices.last() {
            vertices.pop();
        }
        if vertices.len() < 3 {
            let field = alloc::format!("ring {which}");
            let value = alloc::format!("{} different vertices in a row", vertices.len());
            return Err(Error::new(ErrorKind::Area, field, value, "at least 3"));
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
            Arc::make_mut(edges).push(Edge::new(low, high));
        }
        Ok(())
    }

    /// The number of vertices of all rings. Repeated ones count once.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        self.vertices
    }

    /// The least box around all vertices.
    #[must_use]
    pub fn bounds(&self) -> Region {
        Region::between(self.min, self.max)
    }

    /// Whether a place lies inside, decided exactly.
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        self.is_in_beyond(p[1]) ^ is_odd(self.edges.iter(), p)
    }

    /// Whether rays at a y cross an odd number of the edges left out.
    fn is_in_beyond(&self, y: f64) -> bool {
        self.turns.partition_point(|&turn| turn <= y) % 2 == 1
    }

    /// The polygon for points of a box, its upper sides included, with the edges that matter there;
    /// `Ok` if all of the box is inside or all of it outside.
    pub(super) fn focus(&self, within: &Region) -> Result<bool, Self> {
        let ([x0, y0], [x1, y1]) = (within.min(), within.max());
        let (mut edges, mut all) = (Vec::new(), self.turns.clone());
        for edge in self.edges.iter().filter(|edge| edge.touches([y0, y1])) {
            let [left, right] = edge.ends();
            if left > x1 {
                all.extend([edge.low[1], edge.high[1]]);
            } else if right >= x0 {
                edges.push(*edge);
            }
        }
        let meets = |edge: &&Edge| {
            let [left, right] = edge.ends();
            edge.touches([y0, y1]) && left <= x1 && right >= x0
        };
        let flat: Vec<Edge> = self.flat.iter().filter(meets).copied().collect();
        all.sort_unstable_by(f64::total_cmp);
        // Nothing changes where one edge ends and the next begins.
        let mut turns: Vec<f64> = Vec::new();
        for turn in all.into_iter().take_while(|&turn| turn <= y1) {
            // Of those below all rays of the box only the parity counts.
            let turn = if turn <= y0 { f64::NEG_INFINITY } else { turn };
            if turns.last() == Some(&turn) {
                turns.pop();
            } else {
                turns.push(turn);
            }
        }
        let near = Self {
            edges: Arc::new(edges),
            flat: Arc::new(flat),
            turns,
            right: x1,
            ..*self
        };
        if near.edges.is_empty() && near.flat.is_empty() && near.turns.iter().all(|&t| t <= y0) {
            return Ok(near.is_in_beyond(y0));
        }
        Err(near)
    }

    /// The ends of the edges.
    pub(super) fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let edges = self.edges.iter().chain(self.flat.iter());
        edges.map(|edge| [edge.low, edge.high])
    }

    /// The states of a strip y₀ ≤ y ≤ y₁ along x, within the box in focus.
    pub(super) fn steps(&self, strip: [f64; 2], stepper: &mut Stepper) {
        let Stepper { steps, edges } = stepper;
        let [y0, _] = strip;
        edges.clear();
        let beyond = self.is_in_beyond(y0);
        let mut inside = beyond;
        for edge in self.edges.iter().chain(self.flat.iter()) {
            if edge.touches(strip) {
                let crosses = edge.low[1] <= y0 && y0 < edge.high[1];
                inside ^= crosses;
                let reach = Reach {
                    extent: edge.extent(strip),
                    crosses,
                    edge: *edge,
                };
                edges.push(reach);
            }
        }
        edges.sort_unstable_by(|a, b| a.extent[0].total_cmp(&b.extent[0]));
        let state = |inside| if inside { State::In } else { State::Out };
        steps.restart(state(inside));
        // Edges whose extents meet are tested together. The outline beyond them crosses every level of
        // the strip an even number of times, or every level an odd number.
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
            // An edge that leaves the box may end in the strip, where one that was left out begins.
            if end <= self.right {
                steps.note(start..next, inside);
            }
            steps.push(end, state(inside));
        }
        debug_assert_eq!(inside, beyond, "rings are closed");
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
        assert!(Polygon::new(&none).is_err());
        let error = Polygon::new(&[[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]]);
        let error = error.expect_err("two vertices");
        assert_eq!(error.value(), "2 different vertices in a row");
        assert!(Polygon::new(&[[[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]]]).is_err());
    }

    proptest! {
        /// A fan of triangles around a point partitions a polygon.
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
            // By parity the triangles add up to the whole, whether they overlap or not.
            let mut inside = false;
            for (i, &a) in ring.iter().enumerate() {
                let triangle = [a, ring[(i + 1) % ring.len()], place(center)];
                inside ^= Polygon::new(&[triangle]).is_ok_and(|t| t.contains(p));
            }
            prop_assert_eq!(whole.expect("valid").contains(p), inside);
        }
    }
}
