//! Other ways to generate points: a hashed jittered grid, a repeated tile, the published row
//! scanner and a Poisson-disk crate, compared with a box of ours written to the same block.

use std::hint::black_box;

use baseline::{RowScanner, Tile, jittered};
use fast_poisson::Poisson2D;
use rounds::{BLOCK, Turns, boxed, filling, giga, in_block, sets, size, table};
use strew_core::F32;

mod baseline;
mod rounds;

/// The side of the repeated tile. It holds 16,384 points, as many as fit in cache.
const TILE: f64 = 128.0;

fn main() {
    let (side, disks) = size((3200.0, 200.0), (300.0, 20.0));
    let scanner = RowScanner::new(&table());
    let [set, _] = sets();
    let plan = boxed(&set, [0.0, 0.0], side);
    let prepared = boxed(&set, [0.0, 0.0], TILE);
    let mut points = vec![[0f32; 2]; prepared.count() as usize];
    prepared.blocks_f32().fill(&mut points);
    let tile = Tile::new(TILE as f32, &points);
    let mut seed = 0;
    let scan = in_block(BLOCK, |block| scanner.scan(side, block));
    let jitter = in_block(BLOCK, |block| jittered(side as u32, 7, block));
    let repeat = in_block(BLOCK, |block| tile.fill(side as f32, block));
    let times = Turns::new(9)
        .case("box, f32", filling::<F32>(&plan, BLOCK))
        .case("published row scanner", scan)
        .case("hashed jittered grid", jitter)
        .case("repeated tile with a grid", repeat)
        .case("fast_poisson", || {
            seed += 1;
            // Maximal Poisson-disk sets have about 0.7 points per squared radius.
            let poisson = Poisson2D::new().with_dimensions([disks, disks], 0.84);
            let points = poisson.with_seed(seed).generate();
            black_box(&points);
            points.len() as u64
        })
        .run();
    let title = format!("{} points, blocks of {BLOCK}, one core", plan.count());
    let over = |seconds| seconds / times["box, f32"];
    times.print(title, &[("G points/s", &giga), ("box ÷ this", &over)]);
}
