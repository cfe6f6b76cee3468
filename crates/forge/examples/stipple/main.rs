//! Measures stipples: pictures as points, after 0 to 4 steps of settling, beside weighted Voronoi stippling and chance.
//!
//! `cargo run --release -p strew-forge --example stipple -- [--steps 0,2,3,4] [--points 5000] [--seeds 1,2,3,4,5]
//! [--draw FOLDER]` prints a table in Markdown. `--draw` writes a PNG for each of the pictures, in rows of two: each
//! number of steps, then weighted Voronoi stippling as published, and by the square of the darkness.
//!
//! - *tone*: at places spread by darkness, the density of the points and the darkness of the picture, both seen through
//!   the same Gaussian, whose standard deviation is 1, 2 or 4 local spacings. The difference over the latter,
//!   root mean square, in units of that of points that are independent of one another;
//! - *δ*: the distance to the nearest point in hexagonal distances of the local density: that of the nearest 1 %, and
//!   the mean;
//! - *time*: that of the processor, of the fastest seed, on one thread.

mod draw;
mod judge;
mod pictures;
mod relax;

use std::{
    error::Error,
    path::PathBuf,
    sync::LazyLock,
    thread,
    time::{Duration, Instant},
};

use judge::{Judge, Verdict};
use pictures::Picture;
use relax::Weight;

/// The steps of weighted Voronoi stippling.
const RELAXED: usize = 50;
/// Sets of independent points, the unit of tones.
const CHANCE: u64 = 32;

/// A way to place points.
#[derive(Clone, Copy)]
enum Way {
    Settled(u32),
    Voronoi(Weight),
}

impl Way {
    fn name(self) -> String {
        match self {
            Self::Settled(steps) => format!("`settle` = {steps}"),
            Self::Voronoi(Weight::Darkness) => "weighted Voronoi".into(),
            Self::Voronoi(Weight::Squared) => "the same, darkness squared".into(),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let after = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        arguments.get(at + 1).cloned()
    };
    let numbers = |name: &str, default: &str| -> Result<Vec<u64>, _> {
        let text = after(name).unwrap_or(default.into());
        text.split(',').map(str::parse).collect()
    };
    let steps = numbers("--steps", "0,2,3,4")?;
    let seeds = numbers("--seeds", "1,2,3,4,5")?;
    let &[count] = numbers("--points", "5000")?.as_slice() else {
        return Err("--points is one number".into());
    };
    let folder = after("--draw").map(PathBuf::from);
    let settled = steps.iter().map(|&steps| Way::Settled(steps as u32));
    let voronoi = [Weight::Darkness, Weight::Squared].map(Way::Voronoi);
    let ways: Vec<Way> = settled.chain(voronoi).collect();

    println!("| picture | points | tone at 1 | 2 | 4 | δ of 1 % | mean δ | time |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut means = vec![Verdict::default(); ways.len()];
    let pictures = Picture::all()?;
    for picture in &pictures {
        let ground = picture.ground(count as usize)?;
        let judge = Judge::new(&ground, CHANCE);
        let mut drawn = Vec::new();
        for (way, mean) in ways.iter().zip(&mut means) {
            let mut verdicts = Vec::new();
            for &seed in &seeds {
                let start = seconds();
                let points = points(*way, picture, &ground, count, seed)?;
                verdicts.push(judge.verdict(&points, seconds() - start));
                if seed == seeds[0] {
                    drawn.push(points);
                }
            }
            let verdict = Verdict::of_seeds(&verdicts);
            println!("| {} | {} | {verdict} |", picture.name, way.name());
            mean.add(&verdict, pictures.len());
        }
        if let Some(folder) = &folder {
            draw::side_by_side(picture, &drawn, &folder.join(picture.file()))?;
        }
    }
    for (way, mean) in ways.iter().zip(&means) {
        println!("| all | {} | {mean} |", way.name());
    }
    Ok(())
}

/// Points by a way and a seed.
fn points(
    way: Way,
    picture: &Picture,
    ground: &pictures::Ground,
    count: u64,
    seed: u64,
) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let (steps, weight) = match way {
        Way::Settled(steps) => (steps, None),
        Way::Voronoi(weight) => (0, Some(weight)),
    };
    let mut points = picture.stippled(count, seed, steps)?;
    if let Some(weight) = weight {
        for _ in 0..RELAXED {
            points = relax::step(ground, &points, weight)?;
        }
    }
    Ok(points)
}

/// The seconds for which this thread has had a processor, where Linux counts them; else those of the clock, which are
/// more on a busy machine.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    // The count is brought up to date when the thread gives way.
    thread::sleep(Duration::from_micros(1));
    let counts = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let first = counts.split(' ').next();
    match first.and_then(|count| count.parse::<f64>().ok()) {
        Some(nanoseconds) => nanoseconds * 1e-9,
        None => START.elapsed().as_secs_f64(),
    }
}
