//! Measures how a set follows a field: distances in local units, and counts of boxes.
//!
//! `cargo run --release -p strew-forge --example fields -- TABLE [--seed 5] [--seeds 32] [--warp 0]` looks at
//! windows of 400 mean spacings. Var is Var(N − ∫λ)/∫λ over quadtree boxes of 8 to 32 points (a random set has 1),
//! bias that of the count, both by octave of λ; distances are nearest-neighbor distances times √λ over the
//! hexagonal distance. A picture is written with `--svg FIELD`.

use std::{error::Error, path::Path, sync::Arc};

use strew_core::{PointSet, Region};
use strew_forge::read_table;

/// The side of the window, in mean spacings.
const SIDE: f64 = 400.0;

type Share = Arc<dyn Fn([f64; 2]) -> f64 + Send + Sync>;

fn fields() -> Vec<(&'static str, Share)> {
    let middle = SIDE / 2.0;
    let gauss = move |[x, y]: [f64; 2]| {
        let squared = (x - middle).powi(2) + (y - middle).powi(2);
        (-squared / (2.0 * (SIDE / 6.0).powi(2)))
            .exp()
            .max(1.0 / 32.0)
    };
    vec![
        ("constant 0.3", Arc::new(|_| 0.3)),
        (
            "ramp 1 to 1/32",
            Arc::new(|[x, _]| (-5.0 * (x / SIDE).clamp(0.0, 1.0)).exp2()),
        ),
        ("gauss", Arc::new(gauss)),
        (
            "ramp 1 to 1/2",
            Arc::new(|[x, _]| (-(x / SIDE).clamp(0.0, 1.0)).exp2()),
        ),
        (
            "ramp 1/8 to 1/12",
            Arc::new(|[x, _]| 0.125 * (-0.6 * (x / SIDE).clamp(0.0, 1.0)).exp2()),
        ),
        (
            "edge 1 | 1/16",
            Arc::new(move |[x, _]| if x < middle { 1.0 } else { 1.0 / 16.0 }),
        ),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let after = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        arguments.get(at + 1)
    };
    let seed: u64 = after("--seed").map_or(Ok(5), |v| v.parse())?;
    let seeds: u64 = after("--seeds").map_or(Ok(1), |v| v.parse())?;
    let table = read_table(Path::new(arguments.first().ok_or("which table?")?))?;
    let mut set = PointSet::new(table).seed(seed);
    if let Some(warp) = after("--warp") {
        set = set.warp(warp.parse()?)?;
    }
    let window = Region::new([0.0, 0.0], [SIDE, SIDE])?;
    for (name, field) in fields() {
        if let Some(wanted) = after("--svg") {
            if name.starts_with(wanted.as_str()) {
                print_svg(&set, &field)?;
            }
            continue;
        }
        let mut figures = Figures::default();
        for seed in seed..seed + seeds {
            let share = field.clone();
            let graded = set
                .clone()
                .seed(seed)
                .in_field(move |at: [f64; 2]| share(at));
            let points: Vec<[f64; 2]> = graded.within(window)?.iter().map(|m| m.at()).collect();
            figures.add(&points, &*field);
        }
        println!("{name}: {figures}");
    }
    Ok(())
}

/// The middle of the window as a picture, two by one.
fn print_svg(set: &PointSet, field: &Share) -> Result<(), Box<dyn Error>> {
    println!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='100 150 200 100' width='1600' height='800'>"
    );
    println!("<rect x='100' y='150' width='200' height='100' fill='white'/>");
    let middle = Region::new([99.0, 149.0], [301.0, 251.0])?;
    let share = field.clone();
    for member in set.in_field(move |at: [f64; 2]| share(at)).within(middle)? {
        let [x, y] = member.at();
        println!("<circle cx='{x:.2}' cy='{y:.2}' r='0.28'/>");
    }
    println!("</svg>");
    Ok(())
}

/// The figures of a field in windows of some sets.
#[derive(Default)]
struct Figures {
    points: usize,
    least: Vec<f64>,
    near: Vec<f64>,
    mean: Vec<f64>,
    /// By octave: Var(N − ∫λ)/∫λ, and the bias of the count in percent, of each set.
    octaves: Vec<[Vec<f64>; 2]>,
}

impl Figures {
    fn add(&mut self, points: &[[f64; 2]], share: &dyn Fn([f64; 2]) -> f64) {
        let mut near = distances(points, share);
        near.sort_by(f64::total_cmp);
        self.points += points.len();
        self.mean.push(near.iter().sum::<f64>() / near.len() as f64);
        self.near.push(near[near.len() / 100]);
        self.least.push(near[0]);
        let mut sums = vec![[0.0; 4]; 8];
        boxes([0.0, 0.0], SIDE, points.to_vec(), share, &mut sums);
        self.octaves.resize(sums.len(), Default::default());
        for (octave, [count, found, expected, squares]) in self.octaves.iter_mut().zip(sums) {
            if count > 8.0 {
                octave[0].push(squares / count);
                octave[1].push(100.0 * (found / expected - 1.0));
            }
        }
    }
}

impl std::fmt::Display for Figures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let least = self.least.iter().copied().fold(f64::INFINITY, f64::min);
        let [near, mean] = [&self.near, &self.mean].map(|all| average(all)[0]);
        let number = self.points / self.least.len();
        write!(
            f,
            "{number} points, delta_min {least:.3}, 1 % {near:.3}, mean {mean:.3}; var, bias % by octave:"
        )?;
        for [var, bias] in self.octaves.iter().filter(|[var, _]| !var.is_empty()) {
            let ([var, _], [bias, error]) = (average(var), average(bias));
            write!(f, " [{var:.3} {bias:+.2} ± {error:.2}]")?;
        }
        Ok(())
    }
}

/// The mean, and its standard error.
fn average(all: &[f64]) -> [f64; 2] {
    let number = all.len() as f64;
    let mean = all.iter().sum::<f64>() / number;
    let squares: f64 = all.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, squares.sqrt() / number]
}

/// Splits boxes until they hold 8 to 32 points, and adds up: boxes, points, expected points, squared errors.
fn boxes(
    [x, y]: [f64; 2],
    side: f64,
    points: Vec<[f64; 2]>,
    share: &dyn Fn([f64; 2]) -> f64,
    sums: &mut [[f64; 4]],
) {
    let grid = (0..256).map(|i| {
        let at = [i % 16, i / 16].map(|v| (f64::from(v) + 0.5) / 16.0 * side);
        share([x + at[0], y + at[1]])
    });
    let expected = grid.sum::<f64>() * side * side / 256.0;
    if expected > 32.0 {
        let half = side / 2.0;
        for corner in [[x, y], [x + half, y], [x, y + half], [x + half, y + half]] {
            let inside =
                |p: &&[f64; 2]| (0..2).all(|i| (corner[i]..corner[i] + half).contains(&p[i]));
            let part = points.iter().filter(inside).copied().collect();
            boxes(corner, half, part, share, sums);
        }
        return;
    }
    let octave = (-(expected / (side * side)).log2()).max(0.0) as usize;
    let error = points.len() as f64 - expected;
    let sum = &mut sums[octave.min(7)];
    for (sum, v) in
        sum.iter_mut()
            .zip([1.0, points.len() as f64, expected, error * error / expected])
    {
        *sum += v;
    }
}

/// The distance of each point from its nearest neighbor, in local hexagonal distances.
fn distances(points: &[[f64; 2]], share: &dyn Fn([f64; 2]) -> f64) -> Vec<f64> {
    const CELL: f64 = 2.0;
    let cells = (SIDE / CELL) as usize + 1;
    let mut grid = vec![Vec::new(); cells * cells];
    let cell = |p: &[f64; 2]| p.map(|v| ((v / CELL) as usize).min(cells - 1));
    for (i, p) in points.iter().enumerate() {
        let [x, y] = cell(p);
        grid[y * cells + x].push(i);
    }
    let nearest = |(i, p): (usize, &[f64; 2])| {
        let [x, y] = cell(p);
        let mut best = f64::INFINITY;
        for ring in 1..12 {
            for cy in y.saturating_sub(ring)..(y + ring + 1).min(cells) {
                for cx in x.saturating_sub(ring)..(x + ring + 1).min(cells) {
                    for &j in grid[cy * cells + cx].iter().filter(|&&j| j != i) {
                        let q: [f64; 2] = points[j];
                        let denser = share(*p).max(share(q)).sqrt();
                        best = best.min((q[0] - p[0]).hypot(q[1] - p[1]) * denser);
                    }
                }
            }
            if best < ring as f64 * CELL * share(*p).sqrt() {
                break;
            }
        }
        best / (2.0 / 3f64.sqrt()).sqrt()
    };
    points.iter().enumerate().map(nearest).collect()
}
