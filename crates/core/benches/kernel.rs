//! The speed of filling a box, compared with the published row scanner and a plain fill in the same
//! run.
//!
//! `cargo bench -p strew-core` prints medians of interleaved rounds and their ratios. Ratios hold
//! on noisy machines; absolute times do not. `cargo bench -p strew-core -- --quick` only checks
//! that everything still runs.

use std::hint::black_box;

use rounds::{BLOCK, boxed, fill_all, is_quick, medians, sets, table};
use strew_core::{Attribute, Attributes, Column, F32, F64, Member, Plan, Points};

mod rounds;
#[path = "baseline/row_scanner.rs"]
mod row_scanner;

/// Points per block with attributes: few enough to stay in cache.
const AT_ONCE: usize = 1024;

/// Makes all points of a plan with ids and two attributes. Returns the number of points.
fn fill_with_attributes(plan: &Plan, points: &mut [strew_core::Point]) -> u64 {
    let attributes = vec![Attribute::Angle, Attribute::scale(0.5, 2.0).expect("valid")];
    let attributes = Attributes::new(attributes).expect("different");
    let bound = plan.attributes(&attributes).expect("not of a mix");
    let mut columns: Vec<Column> = vec![];
    let (mut blocks, mut total) = (plan.blocks_points(), 0);
    loop {
        let filled = blocks.fill(points);
        bound.write_points(&points[..filled], &mut columns);
        black_box(&mut columns);
        total += filled as u64;
        if filled < points.len() {
            return total;
        }
    }
}

/// Visits all points of a plan one by one. Returns the number of points.
///
/// The bits are gathered in an integer: a float would be spilled in every step, since no vector register
/// survives the call that makes the next block, and that would be the time measured.
fn iterate(plan: &Plan) -> u64 {
    let (mut bits, mut count) = (0, 0);
    for member in plan {
        let [x, y] = member.at();
        bits ^= x.to_bits() ^ y.to_bits();
        count += 1;
    }
    black_box(bits);
    count
}

fn main() {
    let (side, count) = if is_quick() { (300.0, 1) } else { (5477.0, 9) };
    let scanner = row_scanner::RowScanner::new(&table());
    let [plan, warped] = sets().map(|set| boxed(&set, [0.0, 0.0], side));
    let points = plan.count() as u64;

    let (mut f32s, mut f64s) = (vec![[0f32; 2]; BLOCK], vec![[0f64; 2]; BLOCK]);
    let (mut ids, mut plain) = (vec![Default::default(); BLOCK], vec![[0f32; 2]; BLOCK]);
    let mut scanned = vec![[0f32; 2]; BLOCK];
    let mut warped_f32s = vec![[0f32; 2]; BLOCK];
    let mut with_attributes = vec![Default::default(); AT_ONCE];
    let mut marker = 0f32;
    let result = medians(
        count,
        &mut [
            &mut || scanner.scan(side, &mut scanned),
            &mut || {
                for _ in 0..points.div_ceil(BLOCK as u64) {
                    marker += 1.0;
                    black_box(&mut plain).fill([marker, marker]);
                }
                points.next_multiple_of(BLOCK as u64)
            },
            &mut || fill_all::<F32>(&plan, &mut f32s),
            &mut || fill_all::<F64>(&plan, &mut f64s),
            &mut || fill_all::<F32>(&warped, &mut warped_f32s),
            &mut || fill_all::<Points>(&plan, &mut ids),
            &mut || fill_with_attributes(&plan, &mut with_attributes),
            &mut || iterate(&plan),
            &mut || {
                let gather = |bits: u64, member: Member| {
                    let [x, y] = member.at();
                    bits ^ x.to_bits() ^ y.to_bits()
                };
                black_box(plan.iter().fold(0, gather));
                points
            },
        ],
    );
    let names = [
        "row scanner, f32",
        "plain fill, f32",
        "box, f32",
        "box, f64",
        "box with warp, f32",
        "box, ids and f64",
        "box, ids, two attributes",
        "iterator, `for`",
        "iterator, `fold`",
    ];
    println!("{points} points, blocks of {BLOCK}, one core, median of {count}");
    println!(
        "{:<26} {:>12} {:>12} {:>12}",
        "", "G points/s", "÷ scanner", "÷ fill"
    );
    for (name, seconds) in names.iter().zip(result) {
        println!(
            "{name:<26} {:>12.3} {:>12.2} {:>12.2}",
            1e-9 / seconds,
            result[0] / seconds,
            result[1] / seconds
        );
    }
    // `result[5]` fills blocks of the same points.
    for (name, seconds) in names.iter().zip(result).skip(7) {
        println!("{name}: {:.2} × filling blocks", seconds / result[5]);
    }
}
