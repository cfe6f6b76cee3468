//! A fast Fourier transform with the same bits on every machine, because its figures are part of a table's history.
//!
//! Libraries take their sines from the machine. This one is Stockham's, quick for sizes without prime factors above 5, in
//! plain single or double precision. It transforms all columns of a plane side by side, so that its inner loops run over
//! neighboring numbers and vectorize.

use std::ops::{Add, AddAssign, Mul, Sub};

/// A number of either precision.
pub(crate) trait Real:
    Copy + Default + Add<Output = Self> + AddAssign + Mul<Output = Self> + Sub<Output = Self>
{
    fn of(value: f64) -> Self;
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

/// Complex numbers: real and imaginary parts apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plane<T> {
    pub(crate) re: Vec<T>,
    pub(crate) im: Vec<T>,
}

impl<T: Real> Plane<T> {
    /// Zeros.
    pub(crate) fn new(length: usize) -> Self {
        Self {
            re: vec![T::default(); length],
            im: vec![T::default(); length],
        }
    }

    /// The plane with its columns, `width` of them, as rows.
    pub(crate) fn turned(&self, width: usize) -> Self {
        let turned = |all: &[T]| {
            let column = |x| all.iter().skip(x).step_by(width).copied();
            (0..width).flat_map(column).collect()
        };
        Self {
            re: turned(&self.re),
            im: turned(&self.im),
        }
    }
}

/// The transforms of one size.
#[derive(Clone, Debug)]
pub(crate) struct Fourier<T> {
    size: usize,
    factors: Vec<usize>,
    /// exp(−2πi k/size) for all k below the size.
    turns: Vec<[T; 2]>,
}

/// The least size from `least` on that is quick to transform.
pub(crate) fn size_from(least: usize) -> usize {
    let is_smooth = |m: &usize| factors(*m).iter().all(|&factor| factor <= 5);
    (least.max(1)..).find(is_smooth).unwrap_or(least)
}

impl<T: Real> Fourier<T> {
    /// Transforms of `size` numbers.
    pub(crate) fn new(size: usize) -> Self {
        let turn = |k: usize| {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / size as f64;
            [T::of(libm::cos(angle)), T::of(-libm::sin(angle))]
        };
        Self {
            size,
            factors: factors(size),
            turns: (0..size).map(turn).collect(),
        }
    }

    pub(crate) const fn size(&self) -> usize {
        self.size
    }

    /// Transforms each column of a plane of `size` rows, forward. `other` is room of any length.
    pub(crate) fn columns(&self, plane: &mut Plane<T>, other: &mut Plane<T>) {
        let length = plane.re.len();
        other.re.resize(length, T::default());
        other.im.resize(length, T::default());
        // Transforms of the remaining length, and the distance between their elements.
        let (mut rest, mut stride) = (self.size, length / self.size);
        for &radix in &self.factors {
            let part = rest / radix;
            for at in 0..part {
                for k in 0..radix {
                    let to = stride * (radix * at + k);
                    let re = &mut other.re[to..to + stride];
                    let im = &mut other.im[to..to + stride];
                    for j in 0..radix {
                        let turn = j * k * (self.size / radix) + at * k * (self.size / rest);
                        let [cos, sin] = self.turns[turn % self.size];
                        let from = stride * (at + part * j);
                        let inputs = plane.re[from..from + stride]
                            .iter()
                            .zip(&plane.im[from..from + stride]);
                        let outputs = re.iter_mut().zip(im.iter_mut());
                        if j == 0 {
                            for ((re, im), (&x, &y)) in outputs.zip(inputs) {
                                (*re, *im) = (cos * x - sin * y, cos * y + sin * x);
                            }
                        } else {
                            for ((re, im), (&x, &y)) in outputs.zip(inputs) {
                                *re += cos * x - sin * y;
                                *im += cos * y + sin * x;
                            }
                        }
                    }
                }
            }
            std::mem::swap(plane, other);
            (rest, stride) = (part, stride * radix);
        }
    }
}

/// The prime factors up to 5 of a number, but 4 for two of 2, and what is left.
fn factors(mut number: usize) -> Vec<usize> {
    let mut found = Vec::new();
    for factor in [4, 2, 3, 5] {
        while number.is_multiple_of(factor) {
            number /= factor;
            found.push(factor);
        }
    }
    found.extend((number > 1).then_some(number));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn columns_become_their_fourier_sums() {
        let mut random = SplitMix::new(5);
        for size in [1, 2, 8, 14, 30, 90] {
            let width = 3;
            let mut plane = Plane::<f32>::new(size * width);
            for v in plane.re.iter_mut().chain(&mut plane.im) {
                *v = random.next_f64() as f32 - 0.5;
            }
            let given = plane.clone();
            Fourier::new(size).columns(&mut plane, &mut Plane::default());
            for k in 0..size {
                for column in 0..width {
                    let (mut re, mut im) = (0.0, 0.0);
                    for row in 0..size {
                        let turn = -2.0 * std::f64::consts::PI * (k * row % size) as f64;
                        let (sin, cos) = (turn / size as f64).sin_cos();
                        let at = row * width + column;
                        let (x, y) = (f64::from(given.re[at]), f64::from(given.im[at]));
                        re += cos * x - sin * y;
                        im += cos * y + sin * x;
                    }
                    let at = k * width + column;
                    let error = (f64::from(plane.re[at]) - re).abs();
                    assert!(
                        error + (f64::from(plane.im[at]) - im).abs() < 2e-5,
                        "{size}"
                    );
                }
            }
        }
    }

    #[test]
    fn its_bits_are_pinned() {
        let mut plane = Plane::<f32>::new(30);
        for (i, v) in plane.re.iter_mut().enumerate() {
            *v = 1.0 / (i as f32 + 1.0);
        }
        Fourier::new(30).columns(&mut plane, &mut Plane::default());
        let bits = [1, 7, 29].map(|i| [plane.re[i].to_bits(), plane.im[i].to_bits()]);
        let pinned = [
            [0x3fe6_2e59, 0xbf76_0cb9],
            [0x3f49_3787, 0xbeb8_0a1f],
            [0x3fe6_2e59, 0x3f76_0cba],
        ];
        assert_eq!(bits, pinned, "{bits:#x?}");
    }

    #[test]
    fn sizes_have_no_large_factors() {
        assert_eq!([7, 61, 439, 1].map(size_from), [8, 64, 450, 1]);
    }
}
