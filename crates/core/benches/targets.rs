//! Ratios of the library that `docs/performance.md` states targets for, each with its baseline in the same rounds.
//!
//! `-- --quick` only checks that everything still runs.

use std::hint::black_box;

use rounds::{
    AT_ONCE, BLOCK, Turns, boxed, cold_boxes, digits, elsewhere, filling, filling_area, plain_fill,
    sets, sets_of, size, star, table_of, with_attributes,
};
use strew_core::{F32, F64, Points, Region};

mod rounds;

fn row(name: &str, value: f64, target: &str, seconds: f64) {
    let note = format!("{:.3} ns a point", 1e9 * seconds);
    rounds::row(name, [digits(value), target.to_string()], &note);
}

/// The speed of cases as multiples of that of their baselines: a name, both cases, and the target.
const RATIOS: [(&str, [&str; 2], &str); 10] = [
    ("f32 ÷ plain fill", ["f32", "fill"], "0.45"),
    ("warped f32 ÷ f32", ["warped f32", "f32"], "0.5"),
    ("warped f64 ÷ f64", ["warped f64", "f64"], ""),
    ("ids ÷ f64", ["ids", "f64"], "0.8"),
    ("ids and two attributes ÷ ids", ["both", "few ids"], "0.7"),
    ("map m ÷ s, f32", ["m", "s"], "0.9"),
    ("map l ÷ s, f32", ["l", "s"], "0.9"),
    ("map m ÷ s, warped f32", ["m warped", "s warped"], "0.9"),
    ("map l ÷ s, warped f32", ["l warped", "s warped"], "0.9"),
    ("star of 100 vertices ÷ box", ["star", "box"], "0.5"),
];

fn bulk() {
    let side = size(3000f64, 40.0);
    let sets = sets();
    let [plain, warped] = sets.each_ref().map(|set| boxed(set, [0.0, 0.0], side));
    let maps = [("s", 49), ("m", 100), ("l", 200)].map(|(name, radius)| {
        let plans = sets_of(table_of(radius)).map(|set| boxed(&set, [0.0, 0.0], side));
        (name, plans)
    });
    let radius = side / std::f64::consts::PI.sqrt() / 0.9;
    let [square, star] = [plain.region().into(), star(radius, 0.8).into()];
    let outline = size(10_000.0, 40.0);
    let mut turns = Turns::new(15);
    turns
        .case("fill", plain_fill(plain.count() as u64))
        .case("f32", filling::<F32>(&plain, BLOCK))
        .case("f64", filling::<F64>(&plain, BLOCK))
        .case("ids", filling::<Points>(&plain, BLOCK))
        .case("few ids", filling::<Points>(&plain, AT_ONCE))
        .case("both", with_attributes(|| plain.clone()))
        .case("warped f32", filling::<F32>(&warped, BLOCK))
        .case("warped f64", filling::<F64>(&warped, BLOCK))
        .case("box", filling_area(&sets[0], &square))
        .case("star", filling_area(&sets[0], &star))
        .case("count", || {
            black_box(boxed(&sets[1], [0.0, 0.0], outline).count());
            (4.0 * outline) as u64
        });
    for (name, [plain, warped]) in &maps {
        turns.case(name, filling::<F32>(plain, BLOCK));
        turns.case(format!("{name} warped"), filling::<F32>(warped, BLOCK));
    }
    let times = turns.run();
    for (name, [case, baseline], target) in RATIOS {
        row(name, times[baseline] / times[case], target, times[case]);
    }
    let name = "warped count of a box, ns a spacing of outline";
    rounds::row(name, [digits(1e9 * times["count"])], "");
}

fn small() {
    let [plain, warped] = sets();
    let elsewhere = elsewhere();
    let chunk = || {
        let region = Region::chunk(64.0, elsewhere()).expect("valid");
        warped.within(region).expect("in range")
    };
    let times = Turns::new(25)
        .case("plain", cold_boxes(&plain, size(500, 3)))
        .case("warped", cold_boxes(&warped, size(500, 3)))
        .case("chunk", with_attributes(chunk))
        .run();
    let [plain, warped, chunk] = ["plain", "warped", "chunk"].map(|name| times[name]);
    let name = "cold box of 1,000 points, warped, µs";
    row(name, 1e6 * warped, "12", 1e-3 * warped);
    row("the same × plain", warped / plain, "2", 1e-3 * plain);
    let name = "chunk of 64 × 64, ids, two attributes, ns";
    row(name, 1e9 * chunk, "100", chunk);
}

fn main() {
    println!("one thread's own time, medians of interleaved rounds");
    rounds::row("", ["measured", "target"].map(String::from), "");
    bulk();
    small();
}
