//! What is answered without making points: counts, places by number, points by id, neighbors.
//!
//! `cargo bench -p strew-core --bench counts` prints medians of interleaved rounds. The count of a
//! box without warp may not depend on what it holds: 10¹⁸ points may take twice as long as 10⁶.
//! With `-- --quick` it only checks that everything still runs.

use std::{hint::black_box, sync::Arc, time::Instant};

use rounds::{boxed, is_quick, placement, table};
use strew_core::{Circle, PointId, Sampler, sample::Selection};

mod rounds;

struct Subject {
    sampler: Arc<Sampler>,
    /// Where boxes begin: nowhere in particular, so that no two calls ask for the same.
    at: f64,
}

impl Subject {
    fn corner(&mut self) -> f64 {
        self.at = (self.at * 1.618 + 0.37) % 1000.0;
        self.at
    }

    fn count(&mut self, seed: u64, side: f64) -> u128 {
        let [x, y] = [self.corner() - side / 2.0, self.corner() - side / 3.0];
        boxed(&self.sampler, [x, y], side, seed).count()
    }

    fn offset(&mut self, side: f64, share: f64) -> u128 {
        let [x, y] = [self.corner() - side / 2.0, self.corner() - side / 3.0];
        let plan = boxed(&self.sampler, [x, y], side, 0);
        let offset = (plan.count() as f64 * share) as u128;
        plan.window(offset, Some(10)).offset()
    }

    fn circle(&mut self, radius: f64) -> u128 {
        let center = [self.corner(), self.corner()];
        let circle = Circle::new(center, radius).expect("valid");
        let plan = self.sampler.select(Selection::new(placement(0), circle));
        plan.expect("near").count()
    }

    fn point(&mut self) -> u128 {
        let id = PointId {
            x: self.corner() as i64 * 1_000_003,
            y: self.corner() as i64,
        };
        u128::from(self.sampler.point(placement(7), id).is_some())
    }

    fn nearest(&mut self, k: usize) -> u128 {
        let at = [self.corner(), self.corner()];
        let finder = self.sampler.finder(placement(7));
        finder.nearest(at, k).expect("near").len() as u128
    }
}

type Job = (&'static str, fn(&mut Subject) -> u128);

const JOBS: [Job; 11] = [
    ("count, box of 1e3", |s| s.count(0, 31.6)),
    ("count, box of 1e6", |s| s.count(0, 1e3)),
    ("count, box of 1e9", |s| s.count(0, 3.16e4)),
    ("count, box of 1e12", |s| s.count(0, 1e6)),
    ("count, box of 1e18", |s| s.count(0, 1e9)),
    ("count, warped box of 1e6", |s| s.count(7, 1e3)),
    ("count, circle of 1e6", |s| s.circle(564.0)),
    ("count and offset 1e17 of 1e18", |s| s.offset(1e9, 0.1)),
    ("count and offset 1e5 of 1e6", |s| s.offset(1e3, 0.1)),
    ("point by id, warped", Subject::point),
    ("8 nearest, warped", |s| s.nearest(8)),
];

fn main() {
    let (rounds, seconds) = if is_quick() { (1, 0.0) } else { (25, 0.004) };
    let sampler = Arc::new(Sampler::new(table()));
    let mut subject = Subject { sampler, at: 0.5 };
    let mut times = JOBS.map(|_| vec![]);
    for _ in 0..rounds {
        for ((_, job), times) in JOBS.iter().zip(&mut times) {
            let (start, mut runs) = (Instant::now(), 0u32);
            while runs == 0 || start.elapsed().as_secs_f64() < seconds {
                black_box(job(&mut subject));
                runs += 1;
            }
            times.push(start.elapsed().as_secs_f64() / f64::from(runs));
        }
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    for ((name, _), seconds) in JOBS.iter().zip(medians) {
        println!("{name:<32} {:>10.1} µs", seconds * 1e6);
    }
    println!("1e18 : 1e6 {:>32.2}", medians[4] / medians[1]);
}
