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

use spade::{DelaunayTriangulation, Point2};

use crate::{
    Outcome,
    arguments::Arguments,
    figures,
    ground::Grid,
    paint::{self, Dots},
    pictures::Picture,
    tones::Judge,
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
            paint::write(&out, &drawn, sizes(&picture).0, 2)?;
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
fn panel(picture: &Picture, points: &[[f64; 2]]) -> Vec<Dots> {
    let ([width, height], scale) = sizes(picture);
    let diameter = 2.0 * (width * height * COVERED / points.len() as f64 / PI).sqrt();
    let place = |[x, y]: &[f64; 2]| [x * scale, height - y * scale];
    vec![(points.iter().map(place).collect(), diameter, [0; 3])]
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
