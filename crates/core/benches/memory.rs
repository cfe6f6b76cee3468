//! Fresh memory and two threads: a box written to untouched memory, compared with a plain fill of
//! the same memory; and tiles on two threads, compared with one.
//!
//! `-- --points N` sets the size. The default allocates 2 GB twice, one after the other.

use std::hint::black_box;

use rayon::prelude::*;
use rounds::{BLOCK, Turns, boxed, drain, giga, sets, size, time_of_day};
use strew_core::{F32, Plan};

mod rounds;

/// A job that makes the points of a plan on a number of threads, with one block per thread. A tile holds many blocks
/// because the work that its rows share is done once per tile.
fn on_threads(plan: &Plan, threads: usize) -> impl FnMut() -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("threads");
    move || {
        pool.install(|| {
            let tiles: Vec<_> = plan.tiles(16 * BLOCK).collect();
            let fill = |block: &mut Vec<[f32; 2]>, tile| {
                let mut blocks = plan.tile_blocks::<F32>(tile);
                drain(block, |block| blocks.fill(block))
            };
            let block = || vec![[0f32; 2]; BLOCK];
            tiles.par_iter().map_init(block, fill).sum()
        })
    }
}

fn main() {
    let argument = std::env::args().skip_while(|arg| arg != "--points").nth(1);
    let argument = argument.map(|text| text.parse::<f64>().expect("a number"));
    let points = argument.unwrap_or(size(2.5e8, 1e5));
    let [set, _] = sets();
    let plan = boxed(&set, [0.0, 0.0], points.sqrt());
    let count = plan.count() as usize;
    let times = Turns::new(5)
        .case("plain fill", || {
            // Never zero: the allocator would request zeroed pages and write nothing.
            black_box(vec![[black_box(1f32); 2]; count]);
            count as u64
        })
        .case("box", || {
            let mut fresh = vec![[0f32; 2]; count];
            let mut blocks = plan.blocks_f32();
            for part in fresh.chunks_mut(BLOCK) {
                blocks.fill(part);
            }
            black_box(fresh);
            count as u64
        })
        .run();
    let title = format!("{count} points of f32 into fresh memory, one core");
    let over = |seconds| times["plain fill"] / seconds;
    times.print(title, &[("G points/s", &giga), ("÷ fill", &over)]);

    let plan = boxed(&set, [0.0, 0.0], (points / 8.0).sqrt());
    let times = Turns::by(time_of_day, 15)
        .case("one thread", on_threads(&plan, 1))
        .case("two threads", on_threads(&plan, 2))
        .run();
    let count = plan.count();
    let title = format!("{count} points of f32 as tiles into reused blocks");
    let over = |seconds| times["one thread"] / seconds;
    times.print(title, &[("G points/s", &giga), ("÷ one", &over)]);
}
