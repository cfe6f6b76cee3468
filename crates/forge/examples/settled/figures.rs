//! Figures of sets whose density varies, in units of the local density.
//!
//! What does not depend on the points is worked out once for all numbers of steps: boxes with their expected counts,
//! and windows with the transforms of their shares.

use std::f64::consts::PI;

use strew_core::Field;
use strew_forge::numeric::SplitMix;

/// The neighbor distance of the hexagonal lattice, in mean spacings.
const HEXAGONAL: f64 = 1.074_569_931_823_542;
/// The sides of windows, in local spacings, and the number of them.
const WINDOW: f64 = 24.0;
const WINDOWS: usize = 300;
/// Modes of a window below ν = 0.5 lie below this.
const MODES: usize = 12;
/// Pairs below this many hexagonal distances are near.
const NEAR: f64 = 0.4;

/// A square region of a plane with shares.
pub struct Ground<'a> {
    pub corner: [f64; 2],
    pub side: f64,
    pub shares: &'a dyn Field,
}

impl Ground<'_> {
    /// The shares at the middles of the squares of a grid, row by row.
    fn grid(&self, corner: [f64; 2], side: f64, across: usize) -> Vec<f64> {
        let middle = |i: usize| (i as f64 + 0.5) / across as f64 * side;
        let places: Vec<[f64; 2]> = (0..across * across)
            .map(|i| {
                let offset = [middle(i % across), middle(i / across)];
                [0, 1].map(|a| self.corner[a] + corner[a] + offset[a])
            })
            .collect();
        let mut shares = vec![0.0; places.len()];
        self.shares.shares(&places, &mut shares);
        shares
    }

    fn share(&self, [x, y]: [f64; 2]) -> f64 {
        self.shares.share([self.corner[0] + x, self.corner[1] + y])
    }
}

/// Boxes that are split in four until they hold 8 to 32 points on average.
pub struct Boxes(Vec<Node>);

struct Node {
    corner: [f64; 2],
    side: f64,
    expected: f64,
    /// The first of four parts, or 0.
    parts: usize,
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

impl Boxes {
    pub fn new(ground: &Ground<'_>, across: usize) -> Self {
        let mut nodes = vec![Node {
            corner: [0.0; 2],
            side: ground.side,
            expected: 0.0,
            parts: 0,
        }];
        let mut next = 0;
        while let Some(&Node { corner, side, .. }) = nodes.get(next) {
            let sum: f64 = ground.grid(corner, side, across).iter().sum();
            let expected = sum * side * side / (across * across) as f64;
            nodes[next].expected = expected;
            if expected > 32.0 {
                nodes[next].parts = nodes.len();
                let half = side / 2.0;
                for (x, y) in [(0.0, 0.0), (half, 0.0), (0.0, half), (half, half)] {
                    nodes.push(Node {
                        corner: [corner[0] + x, corner[1] + y],
                        side: half,
                        expected: 0.0,
                        parts: 0,
                    });
                }
            }
            next += 1;
        }
        Self(nodes)
    }

    /// Counts points, by octave of the share, the densest first.
    pub fn count(&self, points: &[[f64; 2]]) -> Vec<Octave> {
        let mut counts = vec![0.0; self.0.len()];
        for p in points {
            let mut at = 0;
            while self.0[at].parts > 0 {
                let Node {
                    corner,
                    side,
                    parts,
                    ..
                } = self.0[at];
                let [x, y] = [0, 1].map(|i| usize::from(p[i] >= corner[i] + side / 2.0));
                at = parts + 2 * y + x;
            }
            counts[at] += 1.0;
        }
        let mut octaves = vec![Octave::default(); 10];
        for (node, found) in self.0.iter().zip(counts) {
            let share = node.expected / (node.side * node.side);
            if node.parts > 0 || node.expected < 4.0 {
                continue;
            }
            let octave = &mut octaves[((-share.log2()).max(0.0) as usize).min(9)];
            octave.boxes += 1.0;
            octave.found += found;
            octave.expected += node.expected;
            octave.errors += (found - node.expected).powi(2) / node.expected;
        }
        octaves
    }
}

/// Windows in which power is measured: tapered as those of `strew_forge::measure`, by sin⁸.
pub struct Windows(Vec<Frame>);

struct Frame {
    corner: [f64; 2],
    side: f64,
    /// The transform of the tapered shares, and the integral of the taper's square over them.
    mean: Vec<[f64; 2]>,
    squares: f64,
}

impl Windows {
    /// Windows around some of the points, so that all points count alike. Shares are looked up on `across` × `across`
    /// places of each.
    pub fn new(ground: &Ground<'_>, points: &[[f64; 2]], across: usize) -> Self {
        let mut random = SplitMix::new(1);
        let mut frames = Vec::new();
        for _ in 0..WINDOWS {
            let p = points[(random.next_f64() * points.len() as f64) as usize];
            let local = 1.0 / ground.share(p).sqrt();
            let side = WINDOW * local;
            // Not at the point itself: that would be no chance place of the set.
            let corner = p.map(|v| v - side / 2.0 + (random.next_f64() - 0.5) * 2.0 * local);
            if !side.is_finite() || corner.iter().any(|&v| v < 0.0 || v + side > ground.side) {
                continue;
            }
            let shares = ground.grid(corner, side, across);
            let cell = (side / across as f64).powi(2);
            let mut mean = vec![[0.0; 2]; (MODES + 1) * (2 * MODES + 1)];
            let mut squares = 0.0;
            let turn = |i: usize| (i as f64 + 0.5) / across as f64;
            let columns: Vec<_> = (0..across)
                .map(|i| (taper(turn(i)), waves(turn(i))))
                .collect();
            for (row, shares) in shares.chunks_exact(across).enumerate() {
                let (along_y, wave_y) = &columns[row];
                let mut line = [[0.0; 2]; MODES + 1];
                for ((along_x, wave_x), share) in columns.iter().zip(shares) {
                    let weight = share * along_x * along_y * cell;
                    squares += weight * along_x * along_y;
                    for (sum, wave) in line.iter_mut().zip(wave_x) {
                        *sum = [0, 1].map(|i| sum[i] + weight * wave[i]);
                    }
                }
                add(&mut mean, &line, wave_y, 1.0);
            }
            frames.push(Frame {
                corner,
                side,
                mean,
                squares,
            });
        }
        Self(frames)
    }

    /// The mean power below ν = 0.5 of each window, where chance has 1.
    pub fn low(&self, points: &[[f64; 2]]) -> Vec<f64> {
        let each = self.0.iter().map(|frame| {
            let mut sums: Vec<[f64; 2]> = frame.mean.iter().map(|v| v.map(|v| -v)).collect();
            for p in points {
                let turns = [0, 1].map(|i| (p[i] - frame.corner[i]) / frame.side);
                if turns.iter().all(|v| (0.0..1.0).contains(v)) {
                    let weight = taper(turns[0]) * taper(turns[1]);
                    add(&mut sums, &waves(turns[0]), &waves(turns[1]), weight);
                }
            }
            let (mut power, mut modes) = (0.0, 0.0);
            for kx in 0..MODES as i64 {
                for ky in 1 - MODES as i64..MODES as i64 {
                    let squared = kx * kx + ky * ky;
                    if (kx > 0 || ky > 0) && squared < (MODES * MODES) as i64 {
                        let [re, im] =
                            sums[kx as usize * (2 * MODES + 1) + (ky + MODES as i64) as usize];
                        power += re * re + im * im;
                        modes += 1.0;
                    }
                }
            }
            power / modes / frame.squares
        });
        each.collect()
    }
}

fn taper(u: f64) -> f64 {
    (PI * u).sin().powi(8)
}

/// exp(−2πi k u) for k from 0 to the number of modes.
fn waves(u: f64) -> [[f64; 2]; MODES + 1] {
    let (sin, cos) = (-2.0 * PI * u).sin_cos();
    let mut all = [[1.0, 0.0]; MODES + 1];
    for k in 1..=MODES {
        let [re, im] = all[k - 1];
        all[k] = [re * cos - im * sin, re * sin + im * cos];
    }
    all
}

/// Adds the products of waves along x and y, times a weight, for ky from −[`MODES`] on.
fn add(sums: &mut [[f64; 2]], xs: &[[f64; 2]], ys: &[[f64; 2]], weight: f64) {
    for (x, row) in xs.iter().zip(sums.chunks_exact_mut(2 * MODES + 1)) {
        let [re, im] = x.map(|v| v * weight);
        for (k, sum) in row.iter_mut().enumerate() {
            let [c, s] = ys[k.abs_diff(MODES)];
            let s = if k < MODES { -s } else { s };
            sum[0] += re * c - im * s;
            sum[1] += re * s + im * c;
        }
    }
}

/// Nearest-neighbor distances in hexagonal distances of the local density.
pub struct Near {
    pub least: f64,
    /// 1 % of the points have a nearer neighbor.
    pub hundredth: f64,
    pub mean: f64,
    /// Pairs below [`NEAR`], counted by their points.
    pub pairs: f64,
    /// The least distance, in world units.
    pub plain: f64,
}

impl Near {
    /// Distances of points in a square. A pair is measured by its denser point.
    pub fn of(ground: &Ground<'_>, points: &[[f64; 2]]) -> Self {
        let most = points.iter().map(|p| ground.share(*p)).fold(0.0, f64::max);
        let cell = 2.0 / most.sqrt();
        let across = (ground.side / cell) as usize + 1;
        let mut cells = vec![Vec::new(); across * across];
        let home = |p: &[f64; 2]| p.map(|v| ((v / cell) as usize).min(across - 1));
        for p in points {
            let [x, y] = home(p);
            cells[y * across + x].push((*p, ground.share(*p)));
        }
        let nearest = |p: &[f64; 2], share: f64| {
            let [x, y] = home(p);
            let (mut best, mut plain) = (f64::INFINITY, f64::INFINITY);
            for ring in 1..16usize {
                for cy in y.saturating_sub(ring)..(y + ring + 1).min(across) {
                    for cx in x.saturating_sub(ring)..(x + ring + 1).min(across) {
                        for (q, other) in &cells[cy * across + cx] {
                            let distance = (q[0] - p[0]).hypot(q[1] - p[1]);
                            if distance > 0.0 {
                                plain = plain.min(distance);
                                best = best.min(distance * share.max(*other).sqrt());
                            }
                        }
                    }
                }
                if best < ring as f64 * cell * share.sqrt() {
                    break;
                }
            }
            (best / HEXAGONAL, plain)
        };
        let each = cells.iter().flatten();
        let each: Vec<(f64, f64)> = each.map(|(p, share)| nearest(p, *share)).collect();
        let mut all: Vec<f64> = each.iter().map(|(near, _)| *near).collect();
        all.sort_by(f64::total_cmp);
        let near = all.partition_point(|&v| v < NEAR);
        let finite = all.iter().filter(|v| v.is_finite());
        Self {
            least: all[0],
            hundredth: all[all.len() / 100],
            mean: finite.clone().sum::<f64>() / finite.count() as f64,
            pairs: near as f64 / 2.0,
            plain: each.iter().fold(f64::INFINITY, |a, (_, b)| a.min(*b)),
        }
    }
}
