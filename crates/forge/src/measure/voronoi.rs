//! Voronoi cells of a set: their areas, corners and neighbors.
//!
//! Each cell is cut out of a square by the bisectors to the points around, in the order of a cell list from the inside out.
//! Plain arithmetic in this fixed order yields the same bits on every machine and with any number of threads. Of a window only
//! inner points count.

use rayon::prelude::*;

use super::{Sample, distance::HEXAGONAL};
use crate::cell_list::CellList;

/// The figures of a Voronoi diagram.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Voronoi {
    /// The largest deviation of a cell's area from the mean area, over the mean area.
    pub area_deviation: f64,
    /// The standard deviation of the areas, over the mean area.
    pub area_spread: f64,
    /// The radius of the largest empty circle (the largest distance of a cell's corner from its point), over the
    /// nearest-neighbor distance of the hexagonal lattice of the same density. The hexagonal lattice has 1/√3.
    pub largest_hole: f64,
    /// Bond-orientational order: the mean over points of |mean of exp(6iθ) over the point's bonds|.
    /// It is 1 for a hexagonal lattice, 0 for a square one, about 0.37 for a random set.
    pub q6: f64,
}

/// The width, in mean spacings, of the margin of a window that does not count. Cells farther inside are whole unless there
/// is a hole of half this radius.
const MARGIN: f64 = 6.0;
/// Half the sides of the squares that cells are cut from, in mean spacings: the next one where the cell reaches an edge.
const HALF_SIDES: [f64; 4] = [4.0, 8.0, 16.0, 32.0];

impl Voronoi {
    /// Measures a set; of a window its points at least 6 mean spacings from the edge. All figures are 0 without points. If
    /// points coincide, the deviation and the spread of areas are 1 and the other figures 0.
    pub fn of(set: &Sample) -> Self {
        let found = cells(set, MARGIN, |cell| {
            let [mut real, mut imaginary, mut twice_area] = [0.0; 3];
            for (at, [a, beyond]) in cell.corners.iter().enumerate() {
                let [b, _] = cell.corners[(at + 1) % cell.corners.len()];
                twice_area += a[0] * b[1] - a[1] * b[0];
                let angle = 6.0 * beyond[1].atan2(beyond[0]);
                (real, imaginary) = (real + angle.cos(), imaginary + angle.sin());
            }
            let order = real.hypot(imaginary) / cell.corners.len() as f64;
            let deviation = 0.5 * twice_area - 1.0;
            (!cell.is_shared).then_some([deviation, cell.reach, order])
        });
        let (mut worst, mut spread, mut hole, mut order) = (0.0f64, 0.0, 0.0f64, 0.0);
        let count = found.len().max(1) as f64;
        for (_, cell) in found {
            let Some([deviation, reach, own]) = cell else {
                return Self {
                    area_deviation: 1.0,
                    area_spread: 1.0,
                    ..Self::default()
                };
            };
            worst = worst.max(deviation.abs());
            spread += deviation * deviation;
            hole = hole.max(reach);
            order += own;
        }
        Self {
            area_deviation: worst,
            area_spread: (spread / count).sqrt(),
            largest_hole: hole.sqrt() / HEXAGONAL,
            q6: order / count,
        }
    }
}

/// Cuts the cell of each point, in a window of those at least `margin` from its edge. Returns the numbers of the points and
/// the results of `of`.
pub(crate) fn cells<T: Send>(
    set: &Sample,
    margin: f64,
    of: impl Fn(&Polygon) -> T + Sync,
) -> Vec<(u32, T)> {
    let list = CellList::of(set, 1.0);
    let inner = (list.members.par_iter()).filter(|(_, p)| set.is_inner(margin, p));
    let cells = inner.map_init(Polygon::default, |cell, &(index, p)| {
        cell.begin(&list, index, p);
        (index, of(cell))
    });
    cells.collect()
}

/// The cell of a point, relative to it.
#[derive(Default)]
pub(crate) struct Polygon {
    /// The corners, counterclockwise, each with the point beyond the edge that begins there.
    pub(crate) corners: Vec<[[f64; 2]; 2]>,
    /// The corners of the next cut.
    spare: Vec<[[f64; 2]; 2]>,
    /// The largest squared distance of a corner from the point.
    reach: f64,
    /// Whether another point is at the same place.
    is_shared: bool,
}

impl Polygon {
    /// Cuts the cell of the point `p`, which has the index `own`.
    fn begin(&mut self, list: &CellList, own: u32, p: [f64; 2]) {
        for half in HALF_SIDES {
            let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
            self.corners.clear();
            self.corners
                .extend(corners.map(|corner| [corner, [0.0; 2]]));
            (self.reach, self.is_shared) = (2.0 * half * half, false);
            self.cut_by(list, own, p);
            if self.corners.iter().all(|[_, beyond]| *beyond != [0.0; 2]) {
                break;
            }
        }
    }

    /// Cuts off what is nearer to other points.
    fn cut_by(&mut self, list: &CellList, own: u32, p: [f64; 2]) {
        for ring in 0.. {
            // Bisectors to points in this ring are at least this far away.
            let far = 0.5 * f64::from((ring - 1).max(0)) * list.width();
            if far * far > self.reach {
                break;
            }
            list.ring(p, ring.into(), |index, [dx, dy]| {
                let squared = dx * dx + dy * dy;
                if squared == 0.0 {
                    self.is_shared |= index != own;
                } else if squared < 4.0 * self.reach {
                    self.cut([-dx, -dy], 0.5 * squared);
                }
            });
        }
    }

    /// Keeps the part of the cell where x·n ≤ `limit`.
    fn cut(&mut self, n: [f64; 2], limit: f64) {
        let excess = |[c, _]: &[[f64; 2]; 2]| c[0] * n[0] + c[1] * n[1] - limit;
        if self.corners.iter().all(|c| excess(c) <= 0.0) {
            return;
        }
        self.spare.clear();
        for (at, corner) in self.corners.iter().enumerate() {
            let next = &self.corners[(at + 1) % self.corners.len()];
            let (here, there) = (excess(corner), excess(next));
            if here <= 0.0 {
                self.spare.push(*corner);
            }
            if (here <= 0.0) != (there <= 0.0) {
                let part = here / (here - there);
                let along = |i: usize| corner[0][i] + part * (next[0][i] - corner[0][i]);
                let beyond = if here <= 0.0 { n } else { corner[1] };
                self.spare.push([[along(0), along(1)], beyond]);
            }
        }
        std::mem::swap(&mut self.corners, &mut self.spare);
        let squared = |[c, _]: &[[f64; 2]; 2]| c[0] * c[0] + c[1] * c[1];
        self.reach = self.corners.iter().map(squared).fold(0.0, f64::max);
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
        // Wider holes, too: within half a spacing of the circle that was emptied.
        let mut points = hexagonal(97, 112).points().to_vec();
        points.retain(|p| (p[0] - 52.0).hypot(p[1] - 52.0) > 10.0);
        let wide = Voronoi::of(&Sample::torus(f64::sqrt(97.0 * 112.0), points));
        assert!(
            (wide.largest_hole * HEXAGONAL - 10.0).abs() < 1.0,
            "{wide:?}"
        );
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
