//! The kernel by which scattered points are spread onto a regular grid for their Fourier sums: exp(β(√(1 − z²) − 1))
//! (Barnett, Magland, af Klinteberg 2019), for grids twice as fine as the frequencies need. With a kernel 12 cells wide the
//! error is about 10⁻¹¹ of √Σw², with 8 cells less than the rounding of single precision.

use rayon::prelude::*;

use super::exp;

/// A kernel of a width in grid cells.
pub(crate) struct Kernel<const WIDTH: usize>;

impl<const WIDTH: usize> Kernel<WIDTH> {
    const HALF: f64 = WIDTH as f64 / 2.0;
    /// β, in the ratio to the width that Barnett et al. recommend for an upsampling of 2.
    const SHARPNESS: f64 = 2.30 * WIDTH as f64;

    /// The first grid cell under the kernel of a coordinate, where 1 is the side of the grid.
    pub(crate) fn first(coordinate: f64, size: usize) -> i64 {
        (coordinate * size as f64 - Self::HALF).ceil() as i64
    }

    /// The values of the kernel of a coordinate from its first cell on.
    pub(crate) fn values(coordinate: f64, size: usize) -> [f64; WIDTH] {
        let at = coordinate * size as f64;
        let first = Self::first(coordinate, size) as f64;
        std::array::from_fn(|cell| {
            let z = (first + cell as f64 - at) / Self::HALF;
            exp(Self::SHARPNESS * ((1.0 - z * z).max(0.0).sqrt() - 1.0))
        })
    }

    /// One over the transform of the kernel at 0 to `modes` cycles per side of the grid: the transform is its integral
    /// with a cosine, by the trapezoid rule in the angle arcsin z, where the integrand is smooth and ends at 0.
    pub(crate) fn undo(modes: usize, size: usize) -> Vec<f64> {
        const NODES: i32 = 256;
        let step = std::f64::consts::PI / f64::from(NODES);
        let transform = |k: usize| {
            let turn = 2.0 * std::f64::consts::PI * k as f64 * Self::HALF / size as f64;
            let node = |node: i32| {
                let angle = f64::from(node) * step;
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                exp(Self::SHARPNESS * (cos - 1.0)) * libm::cos(turn * sin) * cos
            };
            Self::HALF * step * (-NODES / 2 + 1..NODES / 2).map(node).sum::<f64>()
        };
        let all = (0..=modes).into_par_iter();
        all.map(|k| 1.0 / transform(k)).collect()
    }
}
