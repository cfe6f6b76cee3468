//! Other ways to generate points: a hashed jittered grid, a repeated tile, the published row
//! scanner and a Poisson-disk crate, compared with a box of ours written to the same block.

use std::hint::black_box;

use fast_poisson::Poisson2D;
use rounds::{BLOCK, boxed, fill_all, is_quick, medians, sets, table};
use strew_core::F32;

#[path = "baseline/jittered.rs"]
mod jittered;
mod rounds;
#[path = "baseline/row_scanner.rs"]
mod row_scanner;
#[path = "baseline/tiled.rs"]
mod tiled;

/// The side of the repeated tile. It holds 16,384 points, as many as fit in cache.
const TILE: f64 = 128.0;

fn main() {
    let quick = is_quick();
    let (side, disks, rounds) = if quick {
        (300.0, 20.0, 1)
    } else {
        (3200.0, 200.0, 9)
    };
    let scanner = row_scanner::RowScanner::new(&table());
    let [set, _] = sets();
    let plan = boxed(&set, [0.0, 0.0], side);
    let prepared = boxed(&set, [0.0, 0.0], TILE);
    let mut points = vec![[0f32; 2]; prepared.count() as usize];
    prepared.blocks_f32().fill(&mut points);
    let tile = tiled::Tile::new(TILE as f32, &points);

    let mut blocks = [(); 4].map(|()| vec![[0f32; 2]; BLOCK]);
    let [one, two, three, four] = &mut blocks;
    let mut seed = 0;
    let result = medians(
        rounds,
        &mut [
            &mut || fill_all::<F32>(&plan, one),
            &mut || scanner.scan(side, two),
            &mut || jittered::fill(side as u32, 7, three),
            &mut || tile.fill(side as f32, four),
            &mut || {
                seed += 1;
                // Maximal Poisson-disk sets have about 0.7 points per squared radius.
                let poisson = Poisson2D::new()
                    .with_dimensions([disks, disks], 0.84)
                    .with_seed(seed);
                let points = poisson.generate();
                black_box(&points);
                points.len() as u64
            },
        ],
    );
    let names = [
        "box, f32",
        "published row scanner",
        "hashed jittered grid",
        "repeated tile with a grid",
        "fast_poisson",
    ];
    println!(
        "{} points, blocks of {BLOCK}, one core, median of {rounds}",
        plan.count()
    );
    println!("{:<28} {:>12} {:>12}", "", "G points/s", "box ÷ this");
    for (name, seconds) in names.iter().zip(result) {
        println!(
            "{name:<28} {:>12.4} {:>12.2}",
            1e-9 / seconds,
            seconds / result[0]
        );
    }
}
