//! Polygons, with exact and half-open membership.

use alloc::vec::Vec;

use robust::{Coord, orient2d};

use super::{AreaError, Region, State, Steps};

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
    vertices: usize,
    min: [f64; 2],
    max: [f64; 2],
}

/// An edge, upward.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    low: [f64; 2],
    high: [f64; 2],
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
            edges.push(Edge { low, high });
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
        self.edges.iter().filter(|edge| edge.is_right_of(p)).count() % 2 == 1
    }

    /// The same polygon for points with y in the strip.
    pub(super) fn focus(&self, strip: [f64; 2]) -> Self {
        let near = |edges: &[Edge]| {
            let near = edges.iter().filter(|edge| edge.touches(strip));
            near.copied().collect()
        };
        Self {
            edges: near(&self.edges),
            flat: near(&self.flat),
            ..*self
        }
    }

    /// Whether nothing is left of it.
    pub(super) const fn is_nowhere(&self) -> bool {
        self.edges.is_empty() && self.flat.is_empty()
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

    pub(super) fn steps(&self, strip: [f64; 2]) -> Steps {
        let [y0, _] = strip;
        // Where each edge may be within the strip, and whether it crosses the strip's lower side.
        let mut spans: Vec<([f64; 2], bool)> = self
            .edges
            .iter()
            .chain(&self.flat)
            .filter(|edge| edge.touches(strip))
            .map(|edge| (edge.extent(strip), edge.low[1] <= y0 && y0 < edge.high[1]))
            .collect();
        spans.sort_unstable_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let mut steps = Steps::all(State::Out);
        let mut inside = false;
        let mut end = f64::NEG_INFINITY;
        for ([from, to], crosses) in spans {
            if from > end {
                if end > f64::NEG_INFINITY {
                    steps.push(end, if inside { State::In } else { State::Out });
                }
                steps.push(from, State::Test);
            }
            end = end.max(to);
            inside ^= crosses;
        }
        if end > f64::NEG_INFINITY {
            steps.push(end, State::Out);
        }
        steps
    }
}

impl Edge {
    /// Whether a ray from `p` toward greater x crosses the edge.
    fn is_right_of(&self, p: [f64; 2]) -> bool {
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        self.low[1] <= p[1]
            && p[1] < self.high[1]
            && (p[0] < self.low[0].min(self.high[0])
                || p[0] < self.low[0].max(self.high[0])
                    && orient2d(coord(self.low), coord(self.high), coord(p)) > 0.0)
    }

    fn touches(&self, [y0, y1]: [f64; 2]) -> bool {
        self.low[1] <= y1 && self.high[1] >= y0
    }

    /// The x that the edge may have between two y, a little wider than need be.
    fn extent(&self, [y0, y1]: [f64; 2]) -> [f64; 2] {
        let ([x0, low], [x1, high]) = (self.low, self.high);
        let at = |y: f64| x0 + ((y - low) / (high - low)).clamp(0.0, 1.0) * (x1 - x0);
        let slack = 4e-15 * (x0.abs() + x1.abs());
        let (a, b) = if low < high {
            (at(y0), at(y1))
        } else {
            (x0, x1)
        };
        [a.min(b) - slack, a.max(b) + slack]
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
