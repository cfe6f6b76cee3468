//! Errors of counts and low power of sets whose density varies, in boxes and windows in units of the local spacing.
//!
//! What does not depend on the points is worked out once for all numbers of steps: boxes with their expected counts,
//! and windows with the transforms of their shares.

use std::f64::consts::PI;

use rayon::prelude::*;
use rustfft::num_complex::Complex;
use strew_forge::numeric::SplitMix;

use crate::ground::Ground;

/// The sides of windows, in local spacings, and the number of them.
const WINDOW: f64 = 24.0;
const WINDOWS: usize = 300;
/// Modes of a window below ν = 0.5 lie below this.
const MODES: usize = 12;
/// The modes from −[`MODES`] to it.
const ROW: usize = 2 * MODES + 1;

/// A square that holds 4 to 32 points on average.
pub struct Counted {
    corner: [f64; 2],
    side: f64,
    expected: f64,
}

/// Sums over the boxes of an octave of the share.
#[derive(Clone, Copy, Default)]
pub struct Octave {
    pub boxes: f64,
    pub found: f64,
    pub expected: f64,
    /// Squared errors of counts over the expected ones.
    pub errors: f64,
}

/// The boxes of a square ground, which is split in four until they hold few points. Shares are looked up on `across` ×
/// `across` places of each.
pub fn boxes(ground: &Ground<'_>, across: usize) -> Vec<Counted> {
    let mut open = vec![([0.0; 2], ground.size[0])];
    let mut found = Vec::new();
    while let Some((corner, side)) = open.pop() {
        let densities = ground.grid(corner, [side; 2], [across; 2]).densities;
        let expected = densities.iter().sum::<f64>() * (side / across as f64).powi(2);
        if expected > 32.0 {
            let half = side / 2.0;
            let parts = [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]];
            open.extend(parts.map(|[x, y]| ([corner[0] + x, corner[1] + y], half)));
        } else if expected >= 4.0 {
            found.push(Counted {
                corner,
                side,
                expected,
            });
        }
    }
    found
}

/// Counts points in boxes, by octave of the share, the densest first.
pub fn count(boxes: &[Counted], points: &[[f64; 2]]) -> [Octave; 10] {
    let counts = boxes.par_iter().map(|one| {
        let is_in =
            |p: &&[f64; 2]| (0..2).all(|i| (0.0..one.side).contains(&(p[i] - one.corner[i])));
        points.iter().filter(is_in).count() as f64
    });
    let mut octaves = [Octave::default(); 10];
    for (one, found) in boxes.iter().zip(counts.collect::<Vec<_>>()) {
        let share = one.expected / (one.side * one.side);
        let octave = &mut octaves[((-share.log2()).max(0.0) as usize).min(9)];
        octave.boxes += 1.0;
        octave.found += found;
        octave.expected += one.expected;
        octave.errors += (found - one.expected).powi(2) / one.expected;
    }
    octaves
}

/// Windows in which power is measured: tapered as those of `strew_forge::measure`, by sin⁸.
pub struct Windows(Vec<Frame>);

struct Frame {
    corner: [f64; 2],
    side: f64,
    /// The transform of the tapered shares, and the integral of the taper's square over them.
    mean: Vec<Complex<f64>>,
    squares: f64,
}

impl Windows {
    /// Windows around some of the points, so that all points count alike. Shares are looked up on `across` × `across`
    /// places of each.
    pub fn new(ground: &Ground<'_>, points: &[[f64; 2]], across: usize) -> Self {
        let mut random = SplitMix::new(1);
        let places = (0..WINDOWS).map(|_| {
            let p = points[(random.next_f64() * points.len() as f64) as usize];
            let local = 1.0 / ground.density(p).sqrt();
            let side = WINDOW * local;
            // Not at the point itself: that would be no chance place of the set.
            let corner = p.map(|v| v - side / 2.0 + (random.next_f64() - 0.5) * 2.0 * local);
            (corner, side)
        });
        let is_inside = |(corner, side): &([f64; 2], f64)| {
            let fits = |&v: &f64| v >= 0.0 && v + side <= ground.size[0];
            side.is_finite() && corner.iter().all(fits)
        };
        let places: Vec<_> = places.filter(is_inside).collect();
        let line: Vec<_> = (0..across)
            .map(|i| waves((i as f64 + 0.5) / across as f64))
            .collect();
        let frame = |(corner, side): ([f64; 2], f64)| {
            let grid = ground.grid(corner, [side; 2], [across; 2]);
            let cell = grid.cell[0] * grid.cell[1];
            let mut mean = vec![Complex::ZERO; (MODES + 1) * ROW];
            let mut squares = 0.0;
            for (y, densities) in line.iter().zip(grid.densities.chunks_exact(across)) {
                let mut sums = [Complex::ZERO; MODES + 1];
                for (x, density) in line.iter().zip(densities) {
                    squares += density * cell * (x[0].re * y[0].re).powi(2);
                    for (sum, wave) in sums.iter_mut().zip(x) {
                        *sum += wave * density * cell;
                    }
                }
                add(&mut mean, &sums, y);
            }
            Frame {
                corner,
                side,
                mean,
                squares,
            }
        };
        Self(places.into_par_iter().map(frame).collect())
    }

    /// The mean power below ν = 0.5 of each window, where chance has 1.
    pub fn low(&self, points: &[[f64; 2]]) -> Vec<f64> {
        let low = |frame: &Frame| {
            let mut sums: Vec<_> = frame.mean.iter().map(|v| -v).collect();
            for p in points {
                let turns = [0, 1].map(|i| (p[i] - frame.corner[i]) / frame.side);
                if turns.iter().all(|v| (0.0..1.0).contains(v)) {
                    let [x, y] = turns.map(waves);
                    add(&mut sums, &x, &y);
                }
            }
            let (mut power, mut modes) = (0.0, 0.0);
            for (i, sum) in sums.iter().enumerate() {
                let (kx, ky) = ((i / ROW) as i64, (i % ROW) as i64 - MODES as i64);
                let is_low = kx * kx + ky * ky < (MODES * MODES) as i64;
                if is_low && (kx > 0 || ky > 0) {
                    power += sum.norm_sqr();
                    modes += 1.0;
                }
            }
            power / modes / frame.squares
        };
        self.0.par_iter().map(low).collect()
    }
}

/// The tapered waves sin⁸(πu) exp(−2πi k u) for k from 0 to the number of modes.
fn waves(u: f64) -> [Complex<f64>; MODES + 1] {
    let turn = Complex::cis(-2.0 * PI * u);
    let mut all = [Complex::from((PI * u).sin().powi(8)); MODES + 1];
    for k in 1..=MODES {
        all[k] = all[k - 1] * turn;
    }
    all
}

/// Adds the products of waves along x and y, for ky from −[`MODES`] on.
fn add(sums: &mut [Complex<f64>], xs: &[Complex<f64>], ys: &[Complex<f64>]) {
    for (x, row) in xs.iter().zip(sums.chunks_exact_mut(ROW)) {
        for (k, sum) in row.iter_mut().enumerate() {
            let y = ys[k.abs_diff(MODES)];
            *sum += x * if k < MODES { y.conj() } else { y };
        }
    }
}
