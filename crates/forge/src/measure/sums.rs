//! Fourier sums over scattered points: in the plane by `nufft`, in space by a non-uniform FFT of type 1 of its own.
//!
//! Each point is spread onto a regular grid, twice as fine as the frequencies need, the grid is transformed along each
//! axis, and the transform of the kernel is divided out. In single precision the power errs by less than 10⁻⁶. The grid is
//! never in memory as a whole: planes are spread, transformed along x and y, and cut to the frequencies.

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::{
    Sample,
    fourier::{Fourier, Plane},
    nufft::transform,
};
use crate::numeric::Kernel;

/// The width of the kernel, in grid cells.
const WIDTH: usize = 8;
type Spreading = Kernel<WIDTH>;

/// The Fourier sums w·exp(−2πi k·x) of a sample for all k with components up to `modes`, each with those that `each` wants. Of
/// k and −k, which have conjugate sums, only the one whose first component that is not 0 is positive; without 0.
pub(crate) fn waves<const D: usize, T: Send>(
    set: &Sample<D>,
    weights: Option<&[f64]>,
    modes: usize,
    each: impl Fn([i64; D], [f64; 2]) -> Option<T> + Sync,
) -> Vec<T> {
    if D == 2 {
        let points: Vec<[f64; 2]> = set.turns().iter().map(|p| [p[0], p[1]]).collect();
        let wanted = |kx, ky, sum: Complex<f64>| match [kx, ky] > [0; 2] {
            true => each(std::array::from_fn(|i| [kx, ky][i]), [sum.re, sum.im]),
            false => None,
        };
        let all = transform(&points, weights, modes, wanted);
        return all.into_iter().flatten().collect();
    }
    let points: Vec<[f64; 3]> = set.turns().iter().map(|p| [p[0], p[1], p[2]]).collect();
    let each = |k: [i64; 3], sum| each(std::array::from_fn(|i| k[i]), sum);
    in_space(&points, weights, modes, each)
}

fn in_space<T: Send>(
    points: &[[f64; 3]],
    weights: Option<&[f64]>,
    modes: usize,
    each: impl Fn([i64; 3], [f64; 2]) -> Option<T> + Sync,
) -> Vec<T> {
    let least = (2 * (2 * modes + 1)).max(2 * WIDTH);
    let fourier = Fourier::new(Fourier::size_from(least));
    let spread = Spread::new(points, weights, fourier.size);
    let (size, across) = (fourier.size, modes + 1);
    let slot = |k: usize| (k + size - modes) % size;
    let planes: Vec<Plane> = (0..size)
        .into_par_iter()
        .map_init(Plane::default, |other, z| {
            // Columns are along x, then along y.
            let mut plane = spread.plane(z);
            fourier.columns(&mut plane, other);
            let mut turned = Plane::new(size * across);
            for x in 0..across {
                for y in 0..size {
                    turned.re[y * across + x] = plane.re[x * size + y];
                    turned.im[y * across + x] = plane.im[x * size + y];
                }
            }
            fourier.columns(&mut turned, other);
            let kept = |all: &[f32]| {
                let row = |k| slot(k) * across..(slot(k) + 1) * across;
                let rows = (0..=2 * modes).flat_map(|k| &all[row(k)]);
                rows.copied().collect()
            };
            Plane {
                re: kept(&turned.re),
                im: kept(&turned.im),
            }
        })
        .collect();
    let undo = Spreading::undo(modes, size);
    let slabs: Vec<Vec<T>> = (0..=2 * modes)
        .into_par_iter()
        .map_init(Plane::default, |other, ky| {
            let row = ky * across..(ky + 1) * across;
            let mut slab = Plane::default();
            for plane in &planes {
                slab.re.extend(&plane.re[row.clone()]);
                slab.im.extend(&plane.im[row.clone()]);
            }
            fourier.columns(&mut slab, other);
            let mut values = Vec::new();
            for kz in 0..=2 * modes {
                for (kx, along_x) in undo.iter().enumerate() {
                    let at = slot(kz) * across + kx;
                    let scale = along_x * undo[ky.abs_diff(modes)] * undo[kz.abs_diff(modes)];
                    let sum = [slab.re[at], slab.im[at]].map(|v| f64::from(v) * scale);
                    let k = [kx, ky, kz].map(|k| k as i64);
                    let k = [k[0], k[1] - modes as i64, k[2] - modes as i64];
                    if k > [0; 3] {
                        values.extend(each(k, sum));
                    }
                }
            }
            values
        })
        .collect();
    slabs.into_iter().flatten().collect()
}

/// Points by the plane of the grid that they begin to reach.
struct Spread<'a> {
    points: &'a [[f64; 3]],
    weights: Option<&'a [f64]>,
    size: usize,
    by_plane: Vec<Vec<u32>>,
}

impl<'a> Spread<'a> {
    fn new(points: &'a [[f64; 3]], weights: Option<&'a [f64]>, size: usize) -> Self {
        let mut by_plane = vec![Vec::new(); size];
        for (i, point) in (0..).zip(points) {
            by_plane[Spreading::first(point[2], size).rem_euclid(size as i64) as usize].push(i);
        }
        Self {
            points,
            weights,
            size,
            by_plane,
        }
    }

    /// A plane of the grid, by x, then by y.
    fn plane(&self, z: usize) -> Plane {
        let size = self.size;
        let mut plane = Plane::new(size * size);
        let wrap = |v: i64| v.rem_euclid(size as i64) as usize;
        for cell in 0..WIDTH {
            for &i in &self.by_plane[(z + size - cell) % size] {
                let point = self.points[i as usize];
                let weight = self.weights.map_or(1.0, |weights| weights[i as usize]);
                let [x, y, z] =
                    point.map(|v| (Spreading::first(v, size), Spreading::values(v, size)));
                let weight = weight * z.1[cell];
                for (a, along_x) in x.1.iter().enumerate() {
                    let row = wrap(x.0 + a as i64) * size;
                    let factor = weight * along_x;
                    for (b, along_y) in y.1.iter().enumerate() {
                        plane.re[row + wrap(y.0 + b as i64)] += (factor * along_y) as f32;
                    }
                }
            }
        }
        plane
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn sums_are_the_direct_ones() {
        let mut random = SplitMix::new(3);
        let set = Sample::torus(1.0, random.places::<3>(200, 1.0));
        let weights: Vec<f64> = (0..200).map(|_| 2.0 * random.next_f64()).collect();
        let sums = waves(&set, Some(&weights), 5, |k, sum| Some((k, sum)));
        assert_eq!(sums.len(), (11 * 11 * 11 - 1) / 2);
        for (k, [re, im]) in sums {
            let mut direct = [0.0; 2];
            for (p, weight) in set.turns().iter().zip(&weights) {
                let turns: f64 = (0..3).map(|i| k[i] as f64 * p[i]).sum();
                let (sin, cos) = (-2.0 * std::f64::consts::PI * turns).sin_cos();
                direct = [direct[0] + weight * cos, direct[1] + weight * sin];
            }
            let error = (re - direct[0]).hypot(im - direct[1]);
            assert!(error < 2e-4, "{k:?} {error:e}");
        }
    }

    #[test]
    fn sums_do_not_depend_on_the_number_of_threads() {
        let set = Sample::torus(1.0, SplitMix::new(4).places::<3>(500, 1.0));
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let sums = || waves(&set, None, 6, |_, sum| Some(sum));
            pool.expect("threads").install(sums)
        };
        assert_eq!(with(1), with(3));
    }
}
