//! Distances: to nearest neighbors, and how often each occurs, compared with a random set.

use rayon::prelude::*;

use super::Sample;
use crate::cell_list::CellList;

/// Nearest-neighbor distances in units of √(2/√3)·N^−½, the nearest-neighbor distance of the
/// hexagonal lattice of the same density; in space of (√2/N)^⅓, that of the densest packing. The smallest distance is at
/// most 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    pub delta_min: f64,
    pub delta_avg: f64,
}

/// The margin of a window of the plane, and of one in space, in mean spacings. The nearest neighbor of a point in it may lie
/// outside the window, so its distance is not counted.
const MARGINS: [f64; 2] = [4.0, 1.4];
/// The nearest-neighbor distance of the hexagonal lattice of unit density.
pub(crate) const HEXAGONAL: f64 = 1.074_569_931_823_542;
/// That of the densest packing in space: the sixth root of 2.
const DENSEST: f64 = 1.122_462_048_309_373;
/// Points per parallel task. It fixes the order of sums.
const CHUNK: usize = 4096;

impl Distances {
    /// Measures a set; of a window the distances from points at least 4 mean spacings from its edge, in space 1.4, to all
    /// points. A single point of a periodic set has its own images as neighbors. Both figures are 0 if there are no points.
    pub fn of<const D: usize>(set: &Sample<D>) -> Self {
        let [margin, unit] = match D {
            2 => [MARGINS[0], HEXAGONAL],
            _ => [MARGINS[1], DENSEST],
        };
        let cells = CellList::of(set, 1.0);
        let of_chunk = |chunk: &[(u32, [f64; D])]| {
            let (mut least, mut sum, mut counted) = (f64::INFINITY, 0.0, 0);
            for (index, p) in chunk.iter().filter(|(_, p)| set.is_inner(margin, p)) {
                let distance = nearest(&cells, *index, *p);
                least = least.min(distance);
                sum += distance;
                counted += 1;
            }
            (least, sum, counted)
        };
        let parts: Vec<(f64, f64, usize)> = cells.members.par_chunks(CHUNK).map(of_chunk).collect();
        let least = parts.iter().map(|part| part.0);
        let least = least.fold(f64::INFINITY, f64::min);
        let sum: f64 = parts.iter().map(|part| part.1).sum();
        let counted: usize = parts.iter().map(|part| part.2).sum();
        let [delta_min, delta_avg] = match counted == 0 || !sum.is_finite() {
            true => [0.0; 2],
            false => [least, sum / counted as f64].map(|v| v / unit),
        };
        Self {
            delta_min,
            delta_avg,
        }
    }
}

/// The distance from the point `p` to its nearest neighbor; infinite if it has none.
fn nearest<const D: usize>(cells: &CellList<D>, index: u32, p: [f64; D]) -> f64 {
    let mut least = f64::INFINITY;
    let rings = (cells.members.len() as f64).sqrt() as i64 * 2 + 2;
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

/// The largest distance counted, in mean spacings.
const REACH: f64 = 5.0;
/// The number of bins.
const BINS: usize = 250;

/// The radial distribution function g(r), which is 1 for a random set, in bins of equal width up to
/// 5 mean spacings.
#[derive(Clone, Debug, PartialEq)]
pub struct Rdf {
    /// (r, g(r)), ascending; r is the middle of the bin in mean spacings.
    pub bins: Vec<[f64; 2]>,
}

impl Rdf {
    /// Measures a set; of a window the distances from points at least 5 mean spacings from its edge to all points.
    pub fn of(set: &Sample) -> Self {
        let cells = &CellList::of(set, 1.0);
        let width = REACH / BINS as f64;
        let rings = (REACH / cells.width()).ceil() as i64;
        let (found, from) = cells
            .members
            .par_chunks(CHUNK)
            .map(|chunk| {
                let (mut found, mut from) = (vec![0u64; BINS], 0u64);
                for (index, p) in chunk.iter().filter(|(_, p)| set.is_inner(REACH, p)) {
                    from += 1;
                    for ring in 0..=rings {
                        cells.ring(*p, ring, |other, [dx, dy]| {
                            let bin = ((dx * dx + dy * dy).sqrt() / width) as usize;
                            if bin < BINS && (other != *index || dx != 0.0 || dy != 0.0) {
                                found[bin] += 1;
                            }
                        });
                    }
                }
                (found, from)
            })
            .reduce(
                || (vec![0; BINS], 0),
                |(a, m), (b, n)| (a.iter().zip(&b).map(|(x, y)| x + y).collect(), m + n),
            );
        let bins = found.iter().enumerate().map(|(i, &pairs)| {
            let (inner, outer) = (i as f64 * width, (i + 1) as f64 * width);
            let area = std::f64::consts::PI * (outer * outer - inner * inner);
            [
                inner + width / 2.0,
                pairs as f64 / (area * from.max(1) as f64),
            ]
        });
        Self {
            bins: bins.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::numeric::SplitMix;

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

    /// Compares with the search of all pairs.
    fn check<const D: usize>(points: Vec<[f64; D]>, unit: f64) {
        let set = Sample::torus(1.0, points);
        let gap = |p: &[f64; D], q: &[f64; D]| {
            let along = |axis: usize| (p[axis] - q[axis]).abs();
            let squares = (0..D).map(|axis| along(axis).min(set.side() - along(axis)).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let all = || set.points().iter().enumerate();
        let nearest = |(i, p)| {
            let others = all().filter(|&(j, _)| i != j).map(|(_, q)| gap(p, q));
            others.fold(f64::INFINITY, f64::min)
        };
        let each: Vec<f64> = all().map(nearest).collect();
        let found = Distances::of(&set);
        let least = each.iter().copied().fold(f64::INFINITY, f64::min) / unit;
        let mean = each.iter().sum::<f64>() / each.len() as f64 / unit;
        assert!((found.delta_min - least).abs() < 1e-12);
        assert!((found.delta_avg - mean).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn agrees_with_the_search_of_all_pairs(points in proptest::collection::vec([0.0f64..1.0, 0.0f64..1.0, 0.0f64..1.0], 2..120)) {
            check(points.iter().map(|p| [p[0], p[1]]).collect(), HEXAGONAL);
            check(points, DENSEST);
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
        let empty = Distances::of(&<Sample>::window(1.0, 1.0, vec![]));
        assert_eq!(empty.delta_min, 0.0);
    }

    #[test]
    fn a_random_set_has_one_everywhere_and_a_lattice_its_distances() {
        let points = SplitMix::new(5).places(40_000, 200.0);
        let torus = Rdf::of(&Sample::torus(200.0, points.clone()));
        let window = Rdf::of(&Sample::window(200.0, 1.0, points));
        for rdf in [torus, window] {
            let far = rdf.bins.iter().filter(|[r, _]| *r > 1.0);
            assert!(far.clone().all(|[_, g]| (g - 1.0).abs() < 0.1));
            let mean = far.clone().map(|[_, g]| g).sum::<f64>() / far.count() as f64;
            assert!((mean - 1.0).abs() < 0.01, "{mean}");
        }
        let lattice = (0..900)
            .map(|i| [f64::from(i % 30) + 0.001, f64::from(i / 30)])
            .collect();
        let rdf = Rdf::of(&Sample::torus(30.0, lattice));
        let count = |range: std::ops::Range<f64>| {
            let area = |r: f64| std::f64::consts::TAU * r * REACH / BINS as f64;
            let bins = rdf.bins.iter().filter(|[r, _]| range.contains(r));
            bins.map(|[r, g]| g * area(*r)).sum::<f64>().round()
        };
        assert_eq!(
            (count(0.0..0.9), count(0.9..1.1), count(1.3..1.5)),
            (0.0, 4.0, 4.0)
        );
    }
}
