//! The radial distribution function: how often a distance occurs, compared with a random set.

use rayon::prelude::*;

use super::Sample;
use crate::cell_list::CellList;

/// The largest distance counted, in mean spacings.
const REACH: f64 = 5.0;
/// The number of bins.
const BINS: usize = 250;
/// Points per parallel task.
const CHUNK: usize = 4096;

/// The radial distribution function g(r), which is 1 for a random set, in bins of equal width up to
/// 5 mean spacings.
#[derive(Clone, Debug, PartialEq)]
pub struct Rdf {
    /// (r, g(r)), ascending; r is the middle of the bin in mean spacings.
    pub bins: Vec<[f64; 2]>,
}

impl Rdf {
    /// Measures a set; of a window the distances from points at least 5 mean spacings from its edge to all points.
    #[must_use]
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
    use super::*;
    use crate::numeric::SplitMix;

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
