//! Nearest-neighbor distances.

use rayon::prelude::*;

use super::Sample;
use crate::cell_list::CellList;

/// Nearest-neighbor distances in units of √(2/√3)·N^−½, the nearest-neighbor distance of the
/// hexagonal lattice of the same density. The smallest distance is at most 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    /// The smallest distance.
    pub delta_min: f64,
    /// The mean distance.
    pub delta_avg: f64,
}

/// The margin of a window, in mean spacings. The nearest neighbor of a point in it may lie outside
/// the window, so its distance is not counted.
const MARGIN: f64 = 4.0;
/// Points per parallel task. It fixes the order of the sum.
const CHUNK: usize = 4096;

impl Distances {
    /// Measures a set; of a window the distances from points at least 4 mean spacings from its edge to all points. A
    /// single point of a periodic set has its own images as neighbors. Both figures are 0 if there are no points.
    #[must_use]
    pub fn of(set: &Sample) -> Self {
        let cells = CellList::of(set, 1.0);
        let [least, mean] = least_and_mean(&cells, |p| set.is_inner(MARGIN, p));
        let unit = (2.0 / 3.0f64.sqrt()).sqrt();
        Self {
            delta_min: least / unit,
            delta_avg: mean / unit,
        }
    }
}

/// The least and the mean distance from the points that count to their nearest neighbors; 0 if there are none.
pub(crate) fn least_and_mean<const D: usize>(
    cells: &CellList<D>,
    counts: impl Fn(&[f64; D]) -> bool + Sync,
) -> [f64; 2] {
    let of_chunk = |chunk: &[(u32, [f64; D])]| {
        let (mut least, mut sum, mut counted) = (f64::INFINITY, 0.0, 0);
        for (index, p) in chunk.iter().filter(|(_, p)| counts(p)) {
            let distance = nearest(cells, *index, *p);
            least = least.min(distance);
            sum += distance;
            counted += 1;
        }
        (least, sum, counted)
    };
    let parts: Vec<(f64, f64, usize)> = cells.members().par_chunks(CHUNK).map(of_chunk).collect();
    let least = parts
        .iter()
        .map(|part| part.0)
        .fold(f64::INFINITY, f64::min);
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    let counted: usize = parts.iter().map(|part| part.2).sum();
    match counted == 0 || !sum.is_finite() {
        true => [0.0; 2],
        false => [least, sum / counted as f64],
    }
}

/// The distance from the point `p` to its nearest neighbor; infinite if it has none.
fn nearest<const D: usize>(cells: &CellList<D>, index: u32, p: [f64; D]) -> f64 {
    let mut least = f64::INFINITY;
    let rings = (cells.members().len() as f64).sqrt() as i64 * 2 + 2;
    for ring in 0..=rings {
        // Points in this ring are at least this far away.
        let far = (ring - 1).max(0) as f64 * cells.width();
        if far * far > least {
            break;
        }
        cells.ring(p, ring, |other, by| {
            let squared = by[1..].iter().fold(by[0] * by[0], |sum, v| sum + v * v);
            // A point is not its own neighbor, but its images on a torus are.
            if squared < least && !(other == index && squared == 0.0) {
                least = squared;
            }
        });
    }
    least.sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn lattice(columns: usize, rows: usize, skew: f64) -> Vec<[f64; 2]> {
        (0..rows)
            .flat_map(|j| {
                let shift = skew * (j % 2) as f64;
                (0..columns)
                    .map(move |i| [(i as f64 + shift) / columns as f64, j as f64 / rows as f64])
            })
            .collect()
    }

    #[test]
    fn lattices_have_their_known_distances() {
        let square = Distances::of(&Sample::torus(1.0, lattice(32, 32, 0.0)));
        assert!((square.delta_min - 0.930_604_859_102_1).abs() < 1e-12);
        assert!((square.delta_avg - 0.930_604_859_102_1).abs() < 1e-12);
        // 97 columns and 112 rows: 97/56 ≈ √3, so rows are √3/2 columns apart.
        let hexagonal = Distances::of(&Sample::torus(1.0, lattice(97, 112, 0.5)));
        assert!((hexagonal.delta_min - 1.0).abs() < 1e-3, "{hexagonal:?}");
        assert!(hexagonal.delta_avg <= 1.001);
    }

    proptest! {
        #[test]
        fn agrees_with_the_search_of_all_pairs(points in proptest::collection::vec([0.0f64..1.0, 0.0f64..1.0], 2..120)) {
            let set = Sample::torus(1.0, points);
            let side = set.side();
            let gap = |a: f64, b: f64| {
                let d = (a - b).abs();
                d.min(side - d)
            };
            let each: Vec<f64> = set.points().iter().enumerate().map(|(i, p)| {
                set.points().iter().enumerate().filter(|&(j, _)| i != j)
                    .map(|(_, q)| gap(p[0], q[0]).hypot(gap(p[1], q[1])))
                    .fold(f64::INFINITY, f64::min)
            }).collect();
            let unit = (2.0 / 3.0f64.sqrt()).sqrt();
            let found = Distances::of(&set);
            let least = each.iter().copied().fold(f64::INFINITY, f64::min) / unit;
            let mean = each.iter().sum::<f64>() / each.len() as f64 / unit;
            prop_assert!((found.delta_min - least).abs() < 1e-12);
            prop_assert!((found.delta_avg - mean).abs() < 1e-12);
        }
    }

    #[test]
    fn only_inner_points_of_a_window_count() {
        let mut points = lattice(40, 40, 0.0);
        points.push([0.001, 0.0005]); // near the edge, close to a neighbor
        let window = Sample::window(1.0, 1600.0, points);
        let found = Distances::of(&window);
        assert!(
            (found.delta_min - 0.930_604_859_102_1).abs() < 1e-9,
            "{found:?}"
        );
        let empty = Distances::of(&Sample::window(1.0, 1.0, vec![]));
        assert_eq!(empty.delta_min, 0.0);
    }
}
