//! Questions of one answer: counts, places in the order, points by id, nearest points; in
//! nanoseconds, and in lookups of a displacement at a random place of the table.

use std::{hint::black_box, sync::Arc};

use rounds::{boxed, is_quick, medians, placement, table};
use strew_core::{PointId, Sampler};

mod rounds;

/// Numbers that look random.
fn random(state: &mut u64) -> u64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

fn main() {
    let quick = is_quick();
    let (many, few, rounds) = if quick {
        (100, 2, 1)
    } else {
        (200_000, 500, 9)
    };
    let sampler = Arc::new(Sampler::new(table()));
    let vectors = sampler.table().displacements();
    let mut states = [1u64; 6];
    let [a, b, c, d, e, f] = &mut states;

    // Ids that exist: those of some boxes here and there.
    let mut ids: Vec<PointId> = vec![];
    for i in 0..200 {
        let plan = boxed(
            &sampler,
            [f64::from(i * 7919), f64::from(i * 104_729)],
            20.0,
            0,
        );
        let mut points = vec![Default::default(); plan.count() as usize];
        plan.blocks_points().fill(&mut points);
        ids.extend(points.iter().map(|point| point.id));
    }
    let (plain, warped) = (sampler.finder(placement(0)), sampler.finder(placement(1)));
    let huge = boxed(&sampler, [-1e6, -1e6], 1e7, 0);
    let place = |state: &mut u64| [(); 2].map(|()| random(state) as f64 / 1000.0);
    let names = [
        "a displacement of the table",
        "a point by id",
        "a point by id, warped",
        "the nearest point",
        "the nearest point, warped",
        "a count (1e3 to 1e15 points)",
        "point number k of 1e14",
    ];
    let result = medians(
        rounds,
        &mut [
            &mut || {
                for _ in 0..many {
                    black_box(vectors[random(a) as usize % vectors.len()]);
                }
                many
            },
            &mut || {
                for _ in 0..many {
                    let id = ids[random(b) as usize % ids.len()];
                    black_box(sampler.point(placement(0), id));
                }
                many
            },
            &mut || {
                for _ in 0..many {
                    let id = ids[random(c) as usize % ids.len()];
                    black_box(sampler.point(placement(1), id));
                }
                many
            },
            &mut || {
                for _ in 0..few * 10 {
                    black_box(plain.nearest(place(d), 1).expect("in range"));
                }
                few * 10
            },
            &mut || {
                for _ in 0..few * 10 {
                    black_box(warped.nearest(place(e), 1).expect("in range"));
                }
                few * 10
            },
            &mut || {
                for i in 0..few {
                    let side = 31.6 * 10f64.powi(i as i32 % 7);
                    black_box(boxed(&sampler, [i as f64, 0.5], side, 0).count());
                }
                few
            },
            &mut || {
                for _ in 0..few {
                    let k = u128::from(random(f)) * 46_000 % huge.count();
                    black_box(huge.window(k, Some(1)).cursor());
                }
                few
            },
        ],
    );
    println!("one core, median of {rounds}");
    println!("{:<30} {:>12} {:>16}", "", "ns", "÷ one lookup");
    for (name, seconds) in names.iter().zip(result) {
        println!(
            "{name:<30} {:>12.1} {:>16.1}",
            seconds * 1e9,
            seconds / result[0]
        );
    }
}
