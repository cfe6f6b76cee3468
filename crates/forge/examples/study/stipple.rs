//! Measures stipples: pictures as points, after 0 to 4 steps of settling, beside weighted Voronoi stippling (Secord 2002)
//! and chance. `--draw` writes a PNG for each of the pictures, in rows of two: each number of steps, then weighted
//! Voronoi stippling as published, and by the square of the darkness.
//!
//! - *tone*: at places spread by darkness, the density of the points and the darkness of the picture, both seen through
//!   the same Gaussian, whose standard deviation is 1, 2 or 4 local spacings. The difference over the latter,
//!   root mean square, in units of that of points that are independent of one another;
//! - *δ*: the distance to the nearest point in hexagonal distances of the local density: that of the nearest 1 %, and
//!   the mean;
//! - *time*: that of the processor, of the fastest seed, on one thread, in seconds.

use std::{
    f64::consts::PI,
    fs,
    path::Path,
    sync::LazyLock,
    thread,
    time::{Duration, Instant},
};

use rayon::prelude::*;
use spade::{DelaunayTriangulation, Point2};
use strew_forge::numeric::SplitMix;

use crate::{
    Arguments, Outcome, figures,
    ground::{Grid, Ground, Near},
    paint::{self, Dots},
    pictures::Picture,
};

/// The steps of weighted Voronoi stippling.
const RELAXED: usize = 50;
/// Sets of independent points, the unit of tones.
const CHANCE: u64 = 32;
/// Pixels of a picture's longer side.
const LONGER: f64 = 450.0;
/// The area of all dots over that of the paper.
const COVERED: f64 = 0.3;

/// A way to place points: its name, steps of settling, steps to centroids, and the power of the darkness by which cells
/// are weighted. The density tends to the root of the weight, so long steps by the darkness itself, as published, would
/// lighten what is dark.
type Way = (String, u32, usize, i32);

pub fn study(mut arguments: Arguments) -> Outcome {
    let steps: Vec<u32> = arguments.list("--steps", "0,2,3,4")?;
    let seeds: Vec<u64> = arguments.list("--seeds", "1,2,3,4,5")?;
    let count: usize = arguments.value("--points", "5000")?;
    let folder = arguments.after("--draw");
    let settled = |&steps: &u32| (format!("`settle` = {steps}"), steps, 0, 0);
    let mut ways: Vec<Way> = steps.iter().map(settled).collect();
    ways.push(("weighted Voronoi".into(), 0, RELAXED, 1));
    ways.push(("the same, darkness squared".into(), 0, RELAXED, 2));

    let columns = "picture | points | tone at 1 | 2 | 4 | δ of 1 % | mean δ | time";
    figures::head(columns);
    let mut of_ways = vec![Vec::new(); ways.len()];
    for picture in Picture::all()? {
        let ground = picture.ground(count);
        let grid = picture.grid(&ground, count);
        let judge = Judge::new(&ground, &grid, count, CHANCE);
        let mut drawn = Vec::new();
        for (way, verdicts) in ways.iter().zip(&mut of_ways) {
            let mut of_seeds = Vec::new();
            for &seed in &seeds {
                let start = seconds();
                let mut points = picture.stippled(count, seed, way.1)?;
                for _ in 0..way.2 {
                    points = relaxed(&grid, &points, way.3)?;
                }
                let took = seconds() - start;
                let [a, b, c, hundredth, mean] = judge.verdict(&points);
                of_seeds.push([a, b, c, hundredth, mean, took]);
                if seed == seeds[0] {
                    drawn.push(panel(&picture, &points));
                }
            }
            let mut verdict = mean(&of_seeds);
            verdict[5] = of_seeds.iter().map(|v| v[5]).fold(f64::INFINITY, f64::min);
            figures::row(format!("{} | {}", picture.name, way.0), &verdict);
            verdicts.push(verdict);
        }
        if let Some(folder) = &folder {
            let out = Path::new(folder).join(format!("{}.png", picture.name));
            paint::write(&out, &drawn, sizes(&picture).0)?;
        }
    }
    for (way, verdicts) in ways.iter().zip(&of_ways) {
        figures::row(format!("all | {}", way.0), &mean(verdicts));
    }
    Ok(())
}

fn mean(all: &[[f64; 6]]) -> [f64; 6] {
    let mean = |i| all.iter().map(|v| v[i]).sum::<f64>() / all.len() as f64;
    [0, 1, 2, 3, 4, 5].map(mean)
}

/// Each point at the centroid of its cell, weighted by a power of the density. One without weight around it stays.
fn relaxed(grid: &Grid, points: &[[f64; 2]], power: i32) -> Outcome<Vec<[f64; 2]>> {
    let sites = points.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    let sites = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(sites)?;
    let mut sums = vec![[0.0; 3]; points.len()];
    for ([x, y], density) in grid.places().zip(&grid.densities) {
        // The search begins at the nearest point of the cell before.
        let nearest = sites.nearest_neighbor(Point2::new(x, y));
        let sum = &mut sums[nearest.ok_or("no points")?.fix().index()];
        let weight = density.powi(power);
        *sum = [sum[0] + weight * x, sum[1] + weight * y, sum[2] + weight];
    }
    let moved = |(point, [x, y, all]): (&[f64; 2], &[f64; 3])| match *all > 0.0 {
        true => [x / all, y / all],
        false => *point,
    };
    Ok(points.iter().zip(&sums).map(moved).collect())
}

/// The size of a picture in pixels, and the pixels of a unit.
fn sizes(picture: &Picture) -> ([f64; 2], f64) {
    let scale = LONGER / picture.size[0].max(picture.size[1]);
    (picture.size.map(|v| v * scale), scale)
}

/// A stipple as a panel.
fn panel(picture: &Picture, points: &[[f64; 2]]) -> Dots {
    let ([width, height], scale) = sizes(picture);
    let diameter = 2.0 * (width * height * COVERED / points.len() as f64 / PI).sqrt();
    let place = |[x, y]: &[f64; 2]| [x * scale, height - y * scale];
    (points.iter().map(place).collect(), diameter)
}

/// The seconds for which this thread has had a processor, where Linux counts them; else those of the clock, which are
/// more on a busy machine.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    // The count is updated when the thread yields.
    thread::sleep(Duration::from_micros(1));
    let counts = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let first = counts.split(' ').next();
    match first.and_then(|count| count.parse::<f64>().ok()) {
        Some(nanoseconds) => nanoseconds * 1e-9,
        None => START.elapsed().as_secs_f64(),
    }
}

/// The widths of Gaussians, in local spacings.
const WIDTHS: [f64; 3] = [1.0, 2.0, 4.0];
/// The standard deviations at which a Gaussian is cut off.
const REACH: f64 = 4.5;
/// Places where tones are looked at.
const PLACES: usize = 4000;

/// A picture to compare points with.
struct Judge<'a> {
    ground: &'a Ground<'a>,
    looks: Vec<Look>,
    /// The mean squared errors of independent points.
    chance: [f64; 3],
}

/// A place, with the picture as it is seen there through each Gaussian.
struct Look {
    at: [f64; 2],
    spreads: [f64; 3],
    tones: [f64; 3],
}

impl<'a> Judge<'a> {
    /// A judge by some sets of `count` independent points.
    fn new(ground: &'a Ground<'a>, grid: &Grid, count: usize, sets: u64) -> Self {
        let cell = grid.cell[0] * grid.cell[1];
        let weights = grid.densities.iter().map(|density| density * cell);
        let cells: Vec<_> = grid.places().zip(weights).collect();
        let look = |at: [f64; 2]| {
            let spreads = WIDTHS.map(|width| width / ground.density(at).sqrt());
            Look {
                at,
                spreads,
                tones: tones(at, spreads, cells.iter().copied()),
            }
        };
        let places = independent(grid, PLACES, 1).into_par_iter();
        let mut judge = Self {
            ground,
            looks: places.map(look).collect(),
            chance: [0.0; 3],
        };
        for set in 0..sets {
            let errors = judge.errors(&independent(grid, count, 1000 + set));
            judge.chance = [0, 1, 2].map(|i| judge.chance[i] + errors[i] / sets as f64);
        }
        judge
    }

    /// The mean squared relative errors of tones.
    fn errors(&self, points: &[[f64; 2]]) -> [f64; 3] {
        let each = self.looks.par_iter().map(|look| {
            let sums = tones(look.at, look.spreads, points.iter().map(|&p| (p, 1.0)));
            [0, 1, 2].map(|i| (sums[i] / look.tones[i] - 1.0).powi(2) / PLACES as f64)
        });
        let add = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + b[i]);
        // In order, so that the sums are the same each time.
        each.collect::<Vec<_>>().into_iter().fold([0.0; 3], add)
    }

    /// The errors of tones over those of chance, the distance of the nearest 1 % and the mean one.
    fn verdict(&self, points: &[[f64; 2]]) -> [f64; 5] {
        let errors = self.errors(points);
        let [a, b, c] = [0, 1, 2].map(|i| (errors[i] / self.chance[i]).sqrt());
        let near = Near::of(self.ground, points);
        [a, b, c, near.hundredth, near.mean]
    }
}

/// Independent places, spread by the densities of a grid.
fn independent(grid: &Grid, count: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = SplitMix::new(seed);
    let mut sum = 0.0;
    let add = |v: &f64| {
        sum += v;
        sum
    };
    let sums: Vec<f64> = grid.densities.iter().map(add).collect();
    let places = (0..count).map(|_| {
        let drawn = random.next_f64() * sum;
        let i = sums.partition_point(|&v| v <= drawn).min(sums.len() - 1);
        let corner = [i % grid.columns, i / grid.columns];
        [0, 1].map(|axis| (corner[axis] as f64 + random.next_f64()) * grid.cell[axis])
    });
    places.collect()
}

/// The density of weighted places through Gaussians around a place.
fn tones(
    at: [f64; 2],
    spreads: [f64; 3],
    places: impl Iterator<Item = ([f64; 2], f64)>,
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for ([x, y], weight) in places {
        let squared = (x - at[0]).powi(2) + (y - at[1]).powi(2);
        for (sum, spread) in sums.iter_mut().zip(spreads) {
            let squared = squared / (spread * spread);
            if squared < REACH * REACH {
                *sum += weight * (-squared / 2.0).exp() / (2.0 * PI * spread * spread);
            }
        }
    }
    sums
}
