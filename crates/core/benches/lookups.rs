//! Queries that make no points: counts, offsets, points by number and by id, and nearest points.
//! Times are in microseconds and in lookups of a displacement at a random place in the table.
//!
//! Counting a box without warp must take about as long whatever the box holds: 10¹⁸ points at most
//! twice as long as 10⁶. `-- --quick` only checks that everything still runs.

use std::hint::black_box;

use rounds::{boxed, is_quick, now, sets};
use strew_core::{Circle, Plan, PointId, PointSet};

mod rounds;

struct Subject {
    /// The plain and a warped set.
    sets: [PointSet; 2],
    /// Ids of points of each.
    ids: [Vec<PointId>; 2],
    /// A box of 10¹⁴ points.
    huge: Plan,
    state: u64,
}

impl Subject {
    fn new() -> Self {
        let sets = sets();
        let ids_of = |set: &PointSet| {
            let corner = |i: i32| [f64::from(i * 7919), f64::from(i * 104_729)];
            let plans = (0..200).map(|i| boxed(set, corner(i), 20.0));
            plans.flatten().map(|member| member.id()).collect()
        };
        let ids = [ids_of(&sets[0]), ids_of(&sets[1])];
        Self {
            huge: boxed(&sets[0], [-1e6, -1e6], 1e7),
            sets,
            ids,
            state: 1,
        }
    }

    /// A pseudorandom number.
    fn random(&mut self) -> u64 {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.state >> 33
    }

    /// A pseudorandom place, so that no two calls make the same query.
    fn place(&mut self) -> [f64; 2] {
        [(); 2].map(|()| self.random() as f64 / 1000.0)
    }

    fn displacement(&mut self) {
        let place = self.random() as usize;
        let vectors = self.sets[0].table().displacements();
        black_box(vectors[place % vectors.len()]);
    }

    fn boxed(&mut self, set: usize, side: f64) -> Plan {
        let [x, y] = self.place();
        let corner = [x % 1000.0 - side / 2.0, y % 1000.0 - side / 3.0];
        boxed(&self.sets[set], corner, side)
    }

    fn count(&mut self, set: usize, side: f64) {
        black_box(self.boxed(set, side).count());
    }

    fn circle(&mut self, radius: f64) {
        let circle = Circle::new(self.place(), radius).expect("valid");
        black_box(self.sets[0].count(circle).expect("near"));
    }

    fn offset(&mut self, side: f64) {
        let plan = self.boxed(0, side);
        let offset = plan.count() / 10;
        black_box(plan.window(offset, Some(10)).offset());
    }

    fn number(&mut self) {
        let k = u128::from(self.random()) * 46_000 % self.huge.count();
        black_box(self.huge.window(k, Some(1)).cursor());
    }

    fn point(&mut self, set: usize) {
        let place = self.random() as usize;
        let id = self.ids[set][place % self.ids[set].len()];
        black_box(self.sets[set].point(id));
    }

    fn nearest(&mut self, set: usize, k: usize) {
        let at = self.place();
        black_box(self.sets[set].nearest(at, k).expect("near"));
    }
}

/// The name of a query, the number of calls between clock readings, and the call.
type Job = (&'static str, u32, fn(&mut Subject));

const JOBS: [Job; 16] = [
    ("a displacement of the table", 10_000, Subject::displacement),
    ("point by id", 1000, |s| s.point(0)),
    ("point by id, warped", 1000, |s| s.point(1)),
    ("nearest", 100, |s| s.nearest(0, 1)),
    ("nearest, warped", 100, |s| s.nearest(1, 1)),
    ("8 nearest, warped", 100, |s| s.nearest(1, 8)),
    ("count, box of 1e3", 10, |s| s.count(0, 31.6)),
    ("count, box of 1e6", 10, |s| s.count(0, 1e3)),
    ("count, box of 1e9", 10, |s| s.count(0, 3.16e4)),
    ("count, box of 1e12", 10, |s| s.count(0, 1e6)),
    ("count, box of 1e18", 10, |s| s.count(0, 1e9)),
    ("count, warped box of 1e6", 1, |s| s.count(1, 1e3)),
    ("count, circle of 1e6", 1, |s| s.circle(564.0)),
    ("count and offset 1e5 of 1e6", 1, |s| s.offset(1e3)),
    ("count and offset 1e17 of 1e18", 1, |s| s.offset(1e9)),
    ("point number k of 1e14", 1, Subject::number),
];

fn main() {
    let (rounds, seconds) = if is_quick() { (1, 0.0) } else { (25, 0.004) };
    let mut subject = Subject::new();
    let mut times = JOBS.map(|_| vec![]);
    for _ in 0..rounds {
        for ((_, batch, job), times) in JOBS.iter().zip(&mut times) {
            let batch = if is_quick() { 1 } else { *batch };
            let (start, mut runs) = (now(), 0u32);
            while runs == 0 || (now() - start) < seconds {
                (0..batch).for_each(|_| job(&mut subject));
                runs += batch;
            }
            times.push((now() - start) / f64::from(runs));
        }
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    println!("one core, median of {rounds}");
    println!("{:<32} {:>12} {:>16}", "", "µs", "÷ one lookup");
    for ((name, ..), seconds) in JOBS.iter().zip(medians) {
        let (micros, lookups) = (seconds * 1e6, seconds / medians[0]);
        println!("{name:<32} {micros:>12.4} {lookups:>16.1}");
    }
    println!("1e18 : 1e6 {:>34.2}", medians[10] / medians[7]);
}
