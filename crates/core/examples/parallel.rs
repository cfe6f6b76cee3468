//! Fills a large region on all cores.
//!
//! ```sh
//! cargo run --release -p strew-core --example parallel
//! ```

use std::time::Instant;

use rayon::prelude::*;
use strew_core::{Error, F32, PointSet, Region};

/// The number of points of a tile, and of the buffers that threads reuse: 512 KiB each.
const TILE: usize = 1 << 20;
const BLOCK: usize = 1 << 16;

fn main() -> Result<(), Error> {
    let side = 20_000.0;
    let plan = PointSet::blue().seed(7);
    let plan = plan.within(Region::new([0.0, 0.0], [side, side])?)?;
    println!("{} points; none is made yet", plan.count());

    let start = Instant::now();
    let tiles: Vec<_> = plan.tiles(TILE).collect();
    // The mean of all points, to have something to do with them.
    let sums = tiles.par_iter().map_init(
        || vec![[0f32; 2]; BLOCK],
        |block, tile| {
            let (mut blocks, mut sum) = (plan.tile_blocks::<F32>(tile), [0.0, 0.0]);
            loop {
                let filled = blocks.fill(block);
                for &[x, y] in &block[..filled] {
                    sum = [sum[0] + f64::from(x), sum[1] + f64::from(y)];
                }
                if filled < block.len() {
                    return sum;
                }
            }
        },
    );
    let sum = sums.reduce(|| [0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    let mean = sum.map(|v| v / plan.count() as f64);
    println!(
        "mean {mean:.3?} of {} tiles in {:.2?} on {} threads",
        tiles.len(),
        start.elapsed(),
        rayon::current_num_threads()
    );
    Ok(())
}
