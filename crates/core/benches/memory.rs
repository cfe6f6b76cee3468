//! Fresh memory and two threads: a box written to untouched memory, compared with a plain fill of
//! the same memory; and tiles on two threads, compared with one.
//!
//! `-- --points N` sets the size. The default allocates 2 GB twice, one after the other.

use std::hint::black_box;

use rayon::prelude::*;
use rounds::{BLOCK, boxed, is_quick, medians, medians_by, sets, time_of_day};
use strew_core::{F32, Plan};

mod rounds;

/// Makes the points of a plan on a thread pool, with one block per thread. Returns the number of
/// points. A tile holds many blocks because the work that its rows share is done once per tile.
fn on_threads(plan: &Plan, pool: &rayon::ThreadPool) -> u64 {
    pool.install(|| {
        let tiles: Vec<_> = plan.tiles(16 * BLOCK).collect();
        let fill = |block: &mut Vec<[f32; 2]>, tile| {
            let (mut blocks, mut total) = (plan.tile_blocks::<F32>(tile), 0);
            loop {
                let filled = blocks.fill(block);
                black_box(&mut *block);
                total += filled as u64;
                if filled < block.len() {
                    return total;
                }
            }
        };
        let block = || vec![[0f32; 2]; BLOCK];
        tiles.par_iter().map_init(block, fill).sum()
    })
}

fn main() {
    let argument = std::env::args().skip_while(|arg| arg != "--points").nth(1);
    let argument = argument.map(|text| text.parse::<f64>().expect("a number"));
    let quick = is_quick();
    let points = argument.unwrap_or(if quick { 1e5 } else { 2.5e8 });
    let rounds = if quick { 1 } else { 5 };
    let [set, _] = sets();
    let plan = boxed(&set, [0.0, 0.0], points.sqrt());
    let count = plan.count() as usize;
    let result = medians(
        rounds,
        &mut [
            &mut || {
                // Never zero: the allocator would request zeroed pages and write nothing.
                black_box(vec![[black_box(1f32); 2]; count]);
                count as u64
            },
            &mut || {
                let mut fresh = vec![[0f32; 2]; count];
                let mut blocks = plan.blocks_f32();
                for part in fresh.chunks_mut(BLOCK) {
                    blocks.fill(part);
                }
                black_box(fresh);
                count as u64
            },
        ],
    );
    println!("{count} points of f32 into fresh memory, one core, median of {rounds}");
    for (name, seconds) in ["plain fill", "box"].iter().zip(result) {
        let rate = 1e-9 / seconds;
        println!(
            "{name:<26} {rate:>12.3} G points/s {:>8.2} ÷ fill",
            result[0] / seconds
        );
    }

    let plan = boxed(&set, [0.0, 0.0], (points / 8.0).sqrt());
    let threads = |n| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .expect("threads")
    };
    let (one, two) = (threads(1), threads(2));
    let result = medians_by(
        time_of_day,
        if quick { 1 } else { 15 },
        &mut [&mut || on_threads(&plan, &one), &mut || {
            on_threads(&plan, &two)
        }],
    );
    println!("{} points of f32 as tiles into reused blocks", plan.count());
    for (name, seconds) in ["one thread", "two threads"].iter().zip(result) {
        let rate = 1e-9 / seconds;
        println!(
            "{name:<26} {rate:>12.3} G points/s {:>8.2} ÷ one",
            result[0] / seconds
        );
    }
}
