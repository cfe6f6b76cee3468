//! Figures from the Delaunay triangulation: Voronoi cells, holes and bonds.
//!
//! The triangulation library has no torus, so a periodic set gets a border: copies of the points
//! near the opposite edge. Of a window only inner points count.

use spade::{DelaunayTriangulation, Point2, Triangulation};

use super::{Sample, distance::HEXAGONAL, set::wrap};

/// The figures of a Voronoi diagram.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Voronoi {
    /// The largest deviation of a cell's area from the mean area, over the mean area.
    pub area_deviation: f64,
    /// The standard deviation of the areas, over the mean area.
    pub area_spread: f64,
    /// The radius of the largest empty circle (the largest circumradius of a Delaunay triangle),
    /// over the nearest-neighbor distance of the hexagonal lattice of the same density. The
    /// hexagonal lattice has 1/√3.
    pub largest_hole: f64,
    /// Bond-orientational order: the mean over points of |mean of exp(6iθ) over the point's bonds|.
    /// It is 1 for a hexagonal lattice, 0 for a square one, about 0.37 for a random set.
    pub q6: f64,
}

/// The width, in mean spacings, of the border of a torus and of the margin of a window that does
/// not count. Cells farther inside are whole unless there is a hole of half this radius.
const BORDER: f64 = 6.0;

impl Voronoi {
    /// Measures a set; of a window its points at least 6 mean spacings from the edge. All figures are 0 for a set too
    /// small to have a triangulation. If points coincide, the deviation and the spread of areas are 1 and the other
    /// figures 0.
    pub fn of(set: &Sample) -> Self {
        if !set.is_periodic() {
            return Self::of_cells(set.points(), |_, p| set.is_inner(BORDER, p));
        }
        let side = set.side();
        let border = BORDER.min(side);
        let home = set.points().iter().map(|p| p.map(|v| wrap(v, side)));
        let mut points: Vec<[f64; 2]> = home.collect();
        let counted = points.len();
        for index in 0..counted {
            let images = points[index].map(|v| {
                let (left, right) = (v < border, v >= side - border);
                [Some(0.0), left.then_some(side), right.then_some(-side)]
            });
            for (at, dy) in images[1].iter().enumerate() {
                for (also, dx) in images[0].iter().enumerate() {
                    if let (Some(dx), Some(dy), true) = (dx, dy, at + also > 0) {
                        points.push([points[index][0] + dx, points[index][1] + dy]);
                    }
                }
            }
        }
        Self::of_cells(&points, |index, _| index < counted)
    }

    fn of_cells(points: &[[f64; 2]], counts: impl Fn(usize, &[f64; 2]) -> bool) -> Self {
        let vertices = points.iter().map(|p| Point2::new(p[0], p[1])).collect();
        let Ok(mesh) = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(vertices) else {
            return Self::default();
        };
        // Coincident points share a vertex; then vertices and points no longer correspond.
        if mesh.num_vertices() != points.len() {
            return Self {
                area_deviation: 1.0,
                area_spread: 1.0,
                ..Self::default()
            };
        }
        let (mut worst, mut spread, mut hole, mut order, mut counted) =
            (0.0f64, 0.0, 0.0f64, 0.0, 0u64);
        for vertex in mesh.vertices() {
            let p = points[vertex.index()];
            if !counts(vertex.index(), &p) {
                continue;
            }
            let (mut twice_area, mut bonds, mut real, mut imaginary) = (0.0, 0.0, 0.0, 0.0);
            for edge in vertex.out_edges() {
                let q = edge.to().position();
                let angle = 6.0 * (q.y - p[1]).atan2(q.x - p[0]);
                (real, imaginary, bonds) =
                    (real + angle.cos(), imaginary + angle.sin(), bonds + 1.0);
                let corner = |face: spade::handles::FaceHandle<'_, _, _, _, _, _>| {
                    face.as_inner().map(|face| face.circumcenter())
                };
                if let (Some(a), Some(b)) = (corner(edge.rev().face()), corner(edge.face())) {
                    let (ax, ay, bx, by) = (a.x - p[0], a.y - p[1], b.x - p[0], b.y - p[1]);
                    twice_area += ax * by - ay * bx;
                    hole = hole.max(bx * bx + by * by);
                }
            }
            let deviation = 0.5 * twice_area - 1.0;
            worst = worst.max(deviation.abs());
            spread += deviation * deviation;
            order += (real * real + imaginary * imaginary).sqrt() / f64::max(bonds, 1.0);
            counted += 1;
        }
        let count = counted.max(1) as f64;
        Self {
            area_deviation: worst,
            area_spread: (spread / count).sqrt(),
            largest_hole: hole.sqrt() / HEXAGONAL,
            q6: order / count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    fn hexagonal(columns: usize, rows: usize) -> Sample {
        let points = (0..rows).flat_map(|j| {
            let shift = 0.5 * (j % 2) as f64;
            (0..columns).map(move |i| {
                let (columns, rows) = (columns as f64, rows as f64);
                [(i as f64 + shift) / columns, j as f64 / rows]
            })
        });
        Sample::torus(1.0, points.collect())
    }

    #[test]
    fn a_hexagonal_lattice_has_equal_cells_and_the_smallest_holes() {
        // 97 columns and 112 rows: the ratio is √3/2 to within 10⁻⁴.
        let found = Voronoi::of(&hexagonal(97, 112));
        assert!(found.area_deviation < 1e-9, "{found:?}");
        assert!(
            (found.largest_hole - 1.0 / 3f64.sqrt()).abs() < 1e-3,
            "{found:?}"
        );
        assert!((found.q6 - 1.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn a_missing_point_is_a_hole_of_a_known_size() {
        let mut points = hexagonal(97, 112).points().to_vec();
        let window = Sample::window(104.0, 1.0, points.clone());
        let whole = Voronoi::of(&window);
        assert!((whole.largest_hole - 1.0 / 3f64.sqrt()).abs() < 1e-3);
        points.remove(97 * 56 + 48);
        let holed = Voronoi::of(&Sample::window(104.0, 1.0, points));
        // The empty circle reaches the six neighbors, each of which gains a sixth of the cell.
        assert!((holed.largest_hole - 1.0).abs() < 1e-3, "{holed:?}");
        assert!((holed.area_deviation - 1.0 / 6.0).abs() < 1e-3, "{holed:?}");
    }

    #[test]
    fn cells_of_a_random_set_vary_as_known() {
        let points = SplitMix::new(3).places(20_000, 1.0);
        let found = Voronoi::of(&Sample::torus(1.0, points));
        // Known for a Poisson set: the variance of the area is 0.2802 of its squared mean.
        assert!(
            (found.area_spread - 0.2802f64.sqrt()).abs() < 0.02,
            "{found:?}"
        );
        assert!(
            found.area_deviation > 1.5 && found.largest_hole > 1.3,
            "{found:?}"
        );
        assert!((0.3..0.45).contains(&found.q6), "{found:?}");
    }

    #[test]
    fn sets_without_cells_have_figures_too() {
        assert_eq!(Voronoi::of(&Sample::torus(1.0, vec![])).largest_hole, 0.0);
        let twice = Sample::torus(1.0, vec![[0.5, 0.5]; 2]);
        assert_eq!(Voronoi::of(&twice).area_deviation, 1.0);
    }
}
