//! Fourier sums over scattered points: a non-uniform FFT of type 1 in two dimensions.
//!
//! Each point is spread onto a regular grid, twice as fine as the frequencies need. Then the grid is transformed by an
//! FFT and the transform of the kernel is divided out. The error is about 10⁻¹¹ of √Σw².
//!
//! The grid is never in memory as a whole: bands of rows are spread, transformed along x and cut to
//! the requested frequencies. Then the columns are transformed one by one.

use std::sync::Arc;

use rayon::prelude::*;
use rustfft::{Fft, FftPlanner, num_complex::Complex};

use super::fourier::Fourier;
use crate::numeric::Kernel;

/// The width of the kernel, in grid cells.
const WIDTH: usize = 12;
type Spreading = Kernel<WIDTH>;
/// Grid rows that are spread and transformed together.
const BAND: usize = 32;

/// Computes Σ w·exp(−2πi k·x) over the points for kx in 0..=`modes` and ky in −`modes`..=`modes`.
///
/// Returns the sums in this order, ky fastest, each mapped by `each(kx, ky, sum)`. Points are in
/// [0, 1)², where 1 is the side of the torus; without weights w = 1.
pub(super) fn transform<T: Send>(
    points: &[[f64; 2]],
    weights: Option<&[f64]>,
    modes: usize,
    each: impl Fn(i64, i64, Complex<f64>) -> T + Sync,
) -> Vec<T> {
    let size = grid_size(modes);
    let fft = FftPlanner::new().plan_fft_forward(size);
    let mut by_row = vec![Vec::new(); size];
    for (index, p) in (0..).zip(points) {
        by_row[Spreading::first(p[1], size).rem_euclid(size as i64) as usize].push(index);
    }
    let columns = modes + 1;
    // Indexed by band, then kx, then row of the band.
    let mut half_done = vec![Complex::default(); columns * size];
    half_done
        .par_chunks_mut(columns * BAND)
        .enumerate()
        .for_each(|(band, out)| {
            let grid = spread(&by_row, points, weights, band * BAND);
            transform_rows(&grid, &*fft, columns, out);
        });
    finish_columns(&half_done, &fft, modes, &each)
}

/// The side of the grid: the least multiple of [`BAND`] that is twice as fine as needed and has no
/// prime factor above 5, for the FFT.
fn grid_size(modes: usize) -> usize {
    Fourier::size_from((2 * (2 * modes + 1)).div_ceil(BAND)) * BAND
}

/// Spreads the points onto the band of grid rows from `first_row` on, given those whose kernels begin in each row.
fn spread(
    by_row: &[Vec<u32>],
    points: &[[f64; 2]],
    weights: Option<&[f64]>,
    first_row: usize,
) -> Vec<f64> {
    let size = by_row.len();
    let mut grid = vec![0.0; BAND * size];
    // Kernels that start up to WIDTH − 1 rows above reach into the band.
    for offset in 1 - WIDTH as i64..BAND as i64 {
        let row = (first_row as i64 + offset).rem_euclid(size as i64) as usize;
        for &index in &by_row[row] {
            let [x, y] = points[index as usize];
            let weight = weights.map_or(1.0, |w| w[index as usize]);
            let [along_x, along_y] = [x, y].map(|v| Spreading::values(v, size));
            let start = Spreading::first(x, size).rem_euclid(size as i64) as usize;
            for (j, ky) in along_y.iter().enumerate() {
                let Ok(in_band) = usize::try_from(offset + j as i64) else {
                    continue;
                };
                if in_band >= BAND {
                    break;
                }
                let row = &mut grid[in_band * size..(in_band + 1) * size];
                add_wrapped(row, start, &along_x, weight * ky);
            }
        }
    }
    grid
}

/// Adds the kernel times a factor to a cyclic row, from the cell `start` on.
fn add_wrapped(row: &mut [f64], start: usize, kernel: &[f64; WIDTH], factor: f64) {
    if let Some(cells) = row.get_mut(start..start + WIDTH) {
        for (cell, value) in cells.iter_mut().zip(kernel) {
            *cell += factor * value;
        }
    } else {
        let size = row.len();
        for (j, value) in kernel.iter().enumerate() {
            row[(start + j) % size] += factor * value;
        }
    }
}

/// Transforms the rows of a band, two real rows at a time, and keeps kx = 0..`columns`.
fn transform_rows(grid: &[f64], fft: &dyn Fft<f64>, columns: usize, out: &mut [Complex<f64>]) {
    let size = fft.len();
    let mut line = vec![Complex::default(); size];
    let mut scratch = vec![Complex::default(); fft.get_inplace_scratch_len()];
    for pair in 0..BAND / 2 {
        let (even, odd) = (2 * pair, 2 * pair + 1);
        for (x, value) in line.iter_mut().enumerate() {
            *value = Complex::new(grid[even * size + x], grid[odd * size + x]);
        }
        fft.process_with_scratch(&mut line, &mut scratch);
        for kx in 0..columns {
            // Transforms of real rows are Hermitian, so the sum's even and odd parts separate them.
            let (plus, minus) = (line[kx], line[(size - kx) % size].conj());
            out[kx * BAND + even] = (plus + minus) * 0.5;
            out[kx * BAND + odd] = (plus - minus) * Complex::new(0.0, -0.5);
        }
    }
}

/// Transforms the columns along y and divides by the transform of the kernel.
fn finish_columns<T: Send>(
    half_done: &[Complex<f64>],
    fft: &Arc<dyn Fft<f64>>,
    modes: usize,
    each: &(impl Fn(i64, i64, Complex<f64>) -> T + Sync),
) -> Vec<T> {
    let (size, columns) = (fft.len(), modes + 1);
    let undo = Spreading::undo(modes, size);
    let by_column: Vec<Vec<T>> = (0..columns)
        .into_par_iter()
        .map_init(
            || vec![Complex::default(); fft.get_inplace_scratch_len()],
            |scratch, kx| {
                let mut line: Vec<Complex<f64>> = (0..size / BAND)
                    .flat_map(|band| {
                        let at = (band * columns + kx) * BAND;
                        half_done[at..at + BAND].iter().copied()
                    })
                    .collect();
                fft.process_with_scratch(&mut line, scratch);
                let modes = modes as i64;
                (-modes..=modes)
                    .map(|ky| {
                        let value = line[ky.rem_euclid(size as i64) as usize];
                        let undo = undo[kx] * undo[ky.unsigned_abs() as usize];
                        each(kx as i64, ky, value * undo)
                    })
                    .collect()
            },
        )
        .collect();
    by_column.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn agrees_with_the_direct_sum() {
        let mut random = SplitMix::new(3);
        for (count, modes) in [(1, 5), (40, 0), (300, 17), (900, 60)] {
            let mut points = random.places(count, 1.0);
            points[0] = [0.0, 1.0 - f64::EPSILON]; // both ends of the range
            let weights: Vec<f64> = (0..count).map(|_| random.next_f64() - 0.3).collect();
            let size: f64 = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
            let found = transform(&points, Some(&weights), modes, |kx, ky, v| (kx, ky, v));
            assert_eq!(found.len(), (modes + 1) * (2 * modes + 1));
            for (kx, ky, value) in found {
                let direct: Complex<f64> = points
                    .iter()
                    .zip(&weights)
                    .map(|(p, w)| {
                        let turns = kx as f64 * p[0] + ky as f64 * p[1];
                        Complex::from_polar(*w, -2.0 * std::f64::consts::PI * turns)
                    })
                    .sum();
                let error = (value - direct).norm() / size;
                assert!(error < 1e-9, "{count} {modes} {kx} {ky}: {error:e}");
            }
        }
    }
}
