//! Fourier sums over scattered points in space: a non-uniform FFT of type 1.
//!
//! Each point is spread onto a regular grid, twice as fine as the frequencies need, the grid is transformed along each
//! axis, and the transform of the kernel is divided out. In single precision the power errs by less than 10⁻⁶. The grid is never in memory as a whole: planes are
//! spread, transformed along x and y, and cut to the frequencies.

use rayon::prelude::*;

use super::fourier::{Fourier, Plane};
use crate::numeric::Kernel;

/// The width of the kernel, in grid cells.
const WIDTH: usize = 8;
type Spreading = Kernel<WIDTH>;

/// The sums w·exp(−2πi k·x) over points, for all k with components up to some number. As k and −k have conjugate sums, kx
/// is not negative.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    modes: i64,
    /// By ky, then kz, then kx; from the least to the greatest.
    values: Vec<[f32; 2]>,
}

impl Sums {
    /// The sums over points in [0, 1)³, up to `modes` along each axis.
    pub(super) fn new(points: &[[f64; 3]], weights: Option<&[f64]>, modes: usize) -> Self {
        let least = (2 * (2 * modes + 1)).max(2 * WIDTH);
        let fourier = Fourier::new(Fourier::size_from(least));
        let spread = Spread::new(points, weights, fourier.size());
        let (size, across) = (fourier.size(), modes + 1);
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
        let slabs: Vec<Vec<[f32; 2]>> = (0..=2 * modes)
            .into_par_iter()
            .map_init(Plane::default, |other, ky| {
                let row = ky * across..(ky + 1) * across;
                let mut slab = Plane::default();
                for plane in &planes {
                    slab.re.extend(&plane.re[row.clone()]);
                    slab.im.extend(&plane.im[row.clone()]);
                }
                fourier.columns(&mut slab, other);
                let mut values = Vec::with_capacity(across * (2 * modes + 1));
                for kz in 0..=2 * modes {
                    for (kx, along_x) in undo.iter().enumerate() {
                        let at = slot(kz) * across + kx;
                        let scale = along_x * undo[ky.abs_diff(modes)] * undo[kz.abs_diff(modes)];
                        let scaled = |v: f32| (f64::from(v) * scale) as f32;
                        values.push([scaled(slab.re[at]), scaled(slab.im[at])]);
                    }
                }
                values
            })
            .collect();
        Self {
            modes: modes as i64,
            values: slabs.concat(),
        }
    }

    /// Each pair of frequencies k and −k once, without 0: the one whose first component that is not 0 is positive.
    pub(super) fn each(&self) -> impl Iterator<Item = ([i64; 3], [f32; 2])> + '_ {
        let (across, along) = (self.modes + 1, 2 * self.modes + 1);
        let all = self.values.iter().enumerate();
        all.filter_map(move |(i, &value)| {
            let i = i as i64;
            let k = [
                i % across,
                i / (across * along) - self.modes,
                i / across % along - self.modes,
            ];
            (k > [0; 3]).then_some((k, value))
        })
    }

    /// The largest component of a frequency.
    pub(super) const fn modes(&self) -> i64 {
        self.modes
    }
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
        let mut next = || random.next_f64();
        let points: Vec<[f64; 3]> = (0..200).map(|_| [next(), next(), next()]).collect();
        let weights: Vec<f64> = (0..200).map(|_| 2.0 * next()).collect();
        let sums = Sums::new(&points, Some(&weights), 5);
        assert_eq!(sums.each().count(), (11 * 11 * 11 - 1) / 2);
        for (k, [re, im]) in sums.each() {
            let mut direct = [0.0; 2];
            for (p, weight) in points.iter().zip(&weights) {
                let turns: f64 = (0..3).map(|i| k[i] as f64 * p[i]).sum();
                let (sin, cos) = (-2.0 * std::f64::consts::PI * turns).sin_cos();
                direct = [direct[0] + weight * cos, direct[1] + weight * sin];
            }
            let error = (f64::from(re) - direct[0]).hypot(f64::from(im) - direct[1]);
            assert!(error < 2e-4, "{k:?} {error:e}");
        }
    }

    #[test]
    fn sums_do_not_depend_on_the_number_of_threads() {
        let mut random = SplitMix::new(4);
        let mut next = || random.next_f64();
        let points: Vec<[f64; 3]> = (0..500).map(|_| [next(), next(), next()]).collect();
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads")
                .install(|| Sums::new(&points, None, 6).values)
        };
        assert_eq!(with(1), with(3));
    }
}
