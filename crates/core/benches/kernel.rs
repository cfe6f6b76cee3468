//! The speed of filling a box, compared with the published row scanner and a plain fill in the same
//! run.
//!
//! `cargo bench -p strew-core` prints medians of interleaved rounds and their ratios. Ratios hold
//! on noisy machines; absolute times do not. `cargo bench -p strew-core -- --quick` only checks
//! that everything still runs.

use std::hint::black_box;

use baseline::RowScanner;
use rounds::{
    BLOCK, Turns, boxed, filling, giga, in_block, plain_fill, sets, size, table, with_attributes,
};
use strew_core::{F32, F64, Member, Plan, Points};

mod baseline;
mod rounds;

/// Adds the bits of a point. A float would be spilled in every step of an iterator, since no vector register survives
/// the call that makes the next block, and that would be the time measured.
fn gather(bits: u64, member: Member) -> u64 {
    let [x, y] = member.at();
    bits ^ x.to_bits() ^ y.to_bits()
}

/// Visits all points of a plan one by one. Returns the number of points.
fn iterate(plan: &Plan) -> u64 {
    let (mut bits, mut count) = (0, 0);
    for member in plan {
        bits = gather(bits, member);
        count += 1;
    }
    black_box(bits);
    count
}

fn main() {
    let side = size(5477.0, 300.0);
    let scanner = RowScanner::new(&table());
    let [plan, warped] = sets().map(|set| boxed(&set, [0.0, 0.0], side));
    let points = plan.count() as u64;
    let scan = in_block(BLOCK, |block| scanner.scan(side, block));
    let times = Turns::new(9)
        .case("row scanner, f32", scan)
        .case("plain fill, f32", plain_fill(points))
        .case("box, f32", filling::<F32>(&plan, BLOCK))
        .case("box, f64", filling::<F64>(&plan, BLOCK))
        .case("box with warp, f32", filling::<F32>(&warped, BLOCK))
        .case("box, ids and f64", filling::<Points>(&plan, BLOCK))
        .case("box, ids, two attributes", with_attributes(|| plan.clone()))
        .case("iterator, `for`", || iterate(&plan))
        .case("iterator, `fold`", || {
            black_box(plan.iter().fold(0, gather));
            points
        })
        .run();
    let title = format!("{points} points, blocks of {BLOCK}, one core");
    let [scanner, fill] = ["row scanner, f32", "plain fill, f32"].map(|name| times[name]);
    times.print(
        title,
        &[
            ("G points/s", &giga),
            ("÷ scanner", &|seconds| scanner / seconds),
            ("÷ fill", &|seconds| fill / seconds),
        ],
    );
    // These fill blocks of the same points.
    for name in ["iterator, `for`", "iterator, `fold`"] {
        let ratio = times[name] / times["box, ids and f64"];
        println!("{name}: {ratio:.2} × filling blocks");
    }
}
