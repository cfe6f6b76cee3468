//! Queries that make no points: counts, offsets, points by number and by id, and nearest points.
//! Times are in microseconds and in lookups of a displacement at a random place in the table.
//!
//! Counting a box without warp must take about as long whatever the box holds: 10¹⁸ points at most
//! twice as long as 10⁶. `-- --quick` only checks that everything still runs.

use std::hint::black_box;

use rounds::{Turns, boxed, micros, now, numbers, sets, size};
use strew_core::{Circle, PointId, PointSet};

mod rounds;

/// Ids of points in boxes far from each other.
fn ids_of(set: &PointSet) -> Vec<PointId> {
    let corner = |i: i32| [f64::from(i * 7919), f64::from(i * 104_729)];
    let plans = (0..200).map(|i| boxed(set, corner(i), 20.0));
    plans.flatten().map(|member| member.id()).collect()
}

fn main() {
    let [plain, warped] = &sets();
    let ids = [plain, warped].map(ids_of);
    let vectors = plain.table().displacements();
    // 10¹⁴ points.
    let huge = boxed(plain, [-1e6, -1e6], 1e7);
    let numbers = numbers();
    let random = || numbers() >> 33;
    // No two calls make the same query.
    let place = || [(); 2].map(|()| random() as f64 / 1000.0);
    let boxed = |set: &PointSet, side: f64| {
        let [x, y] = place();
        let corner = [x % 1000.0 - side / 2.0, y % 1000.0 - side / 3.0];
        boxed(set, corner, side)
    };
    let count = |set: &PointSet, side: f64| {
        black_box(boxed(set, side).count());
    };
    let circle = |radius: f64| {
        let circle = Circle::new(place(), radius).expect("valid");
        black_box(plain.count(circle).expect("near"));
    };
    let offset = |side: f64| {
        let plan = boxed(plain, side);
        let offset = plan.count() / 10;
        black_box(plan.window(offset, Some(10)).offset());
    };
    let number = || {
        let k = u128::from(random()) * 46_000 % huge.count();
        black_box(huge.window(k, Some(1)).cursor());
    };
    let point = |set: &PointSet, ids: &[PointId]| {
        let id = ids[random() as usize % ids.len()];
        black_box(set.point(id));
    };
    let nearest = |set: &PointSet, k: usize| {
        black_box(set.nearest(place(), k).expect("near"));
    };
    let displacement = || {
        black_box(vectors[random() as usize % vectors.len()]);
    };

    /// The name of a query, the number of calls between clock readings, and the call.
    type Job<'a> = (&'static str, u32, &'a dyn Fn());
    let jobs: [Job<'_>; 16] = [
        ("a displacement of the table", 10_000, &displacement),
        ("point by id", 1000, &|| point(plain, &ids[0])),
        ("point by id, warped", 1000, &|| point(warped, &ids[1])),
        ("nearest", 100, &|| nearest(plain, 1)),
        ("nearest, warped", 100, &|| nearest(warped, 1)),
        ("8 nearest, warped", 100, &|| nearest(warped, 8)),
        ("count, box of 1e3", 10, &|| count(plain, 31.6)),
        ("count, box of 1e6", 10, &|| count(plain, 1e3)),
        ("count, box of 1e9", 10, &|| count(plain, 3.16e4)),
        ("count, box of 1e12", 10, &|| count(plain, 1e6)),
        ("count, box of 1e18", 10, &|| count(plain, 1e9)),
        ("count, warped box of 1e6", 1, &|| count(warped, 1e3)),
        ("count, circle of 1e6", 1, &|| circle(564.0)),
        ("count and offset 1e5 of 1e6", 1, &|| offset(1e3)),
        ("count and offset 1e17 of 1e18", 1, &|| offset(1e9)),
        ("point number k of 1e14", 1, &number),
    ];
    let mut turns = Turns::new(25);
    for (name, batch, job) in jobs {
        let (batch, seconds) = size((batch, 0.004), (1, 0.0));
        turns.case(name, move || {
            let (start, mut runs) = (now(), 0);
            while runs == 0 || (now() - start) < seconds {
                (0..batch).for_each(|_| job());
                runs += batch;
            }
            u64::from(runs)
        });
    }
    let times = turns.run();
    let over = |seconds| seconds / times[jobs[0].0];
    times.print("one core", &[("µs", &micros), ("÷ one lookup", &over)]);
    let [least, most] = ["count, box of 1e6", "count, box of 1e18"].map(|name| times[name]);
    println!("1e18 : 1e6 {:>34.2}", most / least);
}
