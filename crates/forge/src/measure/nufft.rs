//! Fourier sums over scattered points: a non-uniform FFT of type 1 in two dimensions.
//!
//! Each point is spread onto a regular grid, twice as fine as the frequencies need. Then the grid is transformed by an FFT
//! and the transform of the kernel is divided out; the error is about 10⁻¹¹ of √Σw².
//!
//! The grid is never in memory as a whole: bands of rows are spread, transformed along x and cut to the requested
//! frequencies. Then as many columns at a time are transformed along y.

use rayon::prelude::*;

use crate::numeric::{Fourier, Kernel, Plane, size_from};

/// The width of the kernel, in grid cells.
const WIDTH: usize = 12;
type Spreading = Kernel<WIDTH>;
/// Grid rows, and then columns, that are transformed together.
const BAND: usize = 32;

/// Computes Σ w·exp(−2πi k·x) over the points for kx in 0..=`modes` and ky in −`modes`..=`modes`.
///
/// Returns the sums in this order, ky fastest, each mapped by `each(kx, ky, [real, imaginary])`. Points are in
/// [0, 1)², where 1 is the side of the torus; without weights w = 1.
pub(super) fn transform<T: Send>(
    points: &[[f64; 2]],
    weights: Option<&[f64]>,
    modes: usize,
    each: impl Fn(i64, i64, [f64; 2]) -> T + Sync,
) -> Vec<T> {
    let size = size_from((2 * (2 * modes + 1)).div_ceil(BAND)) * BAND;
    let fourier = Fourier::new(size);
    let rows = RowIndex::new(points, size);
    // By kx, then by row of the band.
    let bands: Vec<Plane<f64>> = (0..size / BAND)
        .into_par_iter()
        .map_init(Plane::default, |other, band| {
            let mut plane = Plane::new(size * BAND);
            plane.re = rows.spread(points, weights, size, band * BAND);
            fourier.columns(&mut plane, other);
            plane.re.truncate((modes + 1) * BAND);
            plane.im.truncate((modes + 1) * BAND);
            plane
        })
        .collect();
    let undo = Spreading::undo(modes, size);
    let columns: Vec<usize> = (0..=modes).collect();
    let columns = columns
        .par_chunks(BAND)
        .map_init(Plane::default, |other, own| {
            let width = own.len();
            let mut plane = Plane::new(size * width);
            for (band, part) in bands.iter().enumerate() {
                for (column, kx) in own.iter().enumerate() {
                    for row in 0..BAND {
                        let to = (band * BAND + row) * width + column;
                        plane.re[to] = part.re[kx * BAND + row];
                        plane.im[to] = part.im[kx * BAND + row];
                    }
                }
            }
            fourier.columns(&mut plane, other);
            let sum = |column: usize, ky: i64| {
                let undo = undo[own[column]] * undo[ky.unsigned_abs() as usize];
                let at = ky.rem_euclid(size as i64) as usize * width + column;
                each(
                    own[column] as i64,
                    ky,
                    [plane.re[at] * undo, plane.im[at] * undo],
                )
            };
            let modes = modes as i64;
            let sums = (0..width).flat_map(|column| (-modes..=modes).map(move |ky| (column, ky)));
            sums.map(|(column, ky)| sum(column, ky)).collect::<Vec<T>>()
        });
    columns.collect::<Vec<_>>().into_iter().flatten().collect()
}

/// Points sorted by the first grid row under their kernel.
struct RowIndex {
    /// The start of the points of each row in `order`, and the end of the last.
    starts: Vec<u32>,
    /// Indices of points.
    order: Vec<u32>,
}

impl RowIndex {
    fn new(points: &[[f64; 2]], size: usize) -> Self {
        let row = |p: &[f64; 2]| Spreading::first(p[1], size).rem_euclid(size as i64) as usize;
        let mut starts = vec![0u32; size + 1];
        for p in points {
            starts[row(p) + 1] += 1;
        }
        for r in 1..starts.len() {
            starts[r] += starts[r - 1];
        }
        let mut next = starts.clone();
        let mut order = vec![0; points.len()];
        for (index, p) in points.iter().enumerate() {
            let slot = &mut next[row(p)];
            order[*slot as usize] = index as u32;
            *slot += 1;
        }
        Self { starts, order }
    }

    /// Spreads the points onto the band of grid rows from `first_row` on, by x, then by row.
    fn spread(
        &self,
        points: &[[f64; 2]],
        weights: Option<&[f64]>,
        size: usize,
        first_row: usize,
    ) -> Vec<f64> {
        let mut grid = vec![0.0; BAND * size];
        // Kernels that start up to WIDTH − 1 rows above reach into the band.
        for offset in 1 - WIDTH as i64..BAND as i64 {
            let row = (first_row as i64 + offset).rem_euclid(size as i64) as usize;
            let inside = (-offset).max(0) as usize..WIDTH.min((BAND as i64 - offset) as usize);
            let first = offset.max(0) as usize;
            for &index in &self.order[self.starts[row] as usize..self.starts[row + 1] as usize] {
                let [x, y] = points[index as usize];
                let weight = weights.map_or(1.0, |w| w[index as usize]);
                let along_y = &Spreading::values(y, size)[inside.clone()];
                let start = Spreading::first(x, size);
                for (i, kx) in (start..).zip(Spreading::values(x, size)) {
                    let at = i.rem_euclid(size as i64) as usize * BAND + first;
                    for (cell, ky) in grid[at..].iter_mut().zip(along_y) {
                        *cell += weight * kx * ky;
                    }
                }
            }
        }
        grid
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn agrees_with_the_direct_sum() {
        let mut random = SplitMix::new(3);
        for (count, modes) in [(1, 5), (40, 0), (300, 17), (900, 60)] {
            let mut points: Vec<[f64; 2]> = (0..count)
                .map(|_| [random.next_f64(), random.next_f64()])
                .collect();
            points[0] = [0.0, 1.0 - f64::EPSILON]; // both ends of the range
            let weights: Vec<f64> = (0..count).map(|_| random.next_f64() - 0.3).collect();
            let size: f64 = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
            let found = transform(&points, Some(&weights), modes, |kx, ky, v| (kx, ky, v));
            assert_eq!(found.len(), (modes + 1) * (2 * modes + 1));
            for (kx, ky, value) in found {
                let mut direct = [0.0; 2];
                for (p, weight) in points.iter().zip(&weights) {
                    let turns = kx as f64 * p[0] + ky as f64 * p[1];
                    let (sin, cos) = (-2.0 * std::f64::consts::PI * turns).sin_cos();
                    direct = [direct[0] + weight * cos, direct[1] + weight * sin];
                }
                let error = (value[0] - direct[0]).hypot(value[1] - direct[1]) / size;
                assert!(error < 1e-9, "{count} {modes} {kx} {ky}: {error:e}");
            }
        }
    }
}
