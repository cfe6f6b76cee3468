//! Ratios of the library that `docs/performance.md` states targets for, each with its baseline in the same rounds.
//!
//! `-- --quick` only checks that everything still runs.

use std::{cell::Cell, hint::black_box};

use rounds::{BLOCK, boxed, fill_all, is_quick, medians, now, sets, table_of};
use strew_core::{
    Attribute, Attributes, Column, F32, F64, Plan, Point, PointSet, Points, Polygon, Region,
};

mod rounds;

/// Points per block with attributes: few enough to stay in cache.
const AT_ONCE: usize = 1024;

/// A number that is `value` with rounds enough to be measured, and small in a quick run.
fn size(value: f64) -> f64 {
    if is_quick() { 40.0 } else { value }
}

fn rounds_of(number: usize) -> usize {
    if is_quick() { 1 } else { number }
}

fn row(name: &str, ratio: f64, target: &str, note: String) {
    println!("{name:<44} {ratio:>8.2} {target:>8}   {note}");
}

fn nanos(seconds: f64) -> String {
    format!("{:.3} ns a point", 1e9 * seconds)
}

/// Makes all points of a plan with ids and two attributes. Returns the number of points.
fn with_attributes(plan: &Plan, points: &mut [Point], columns: &mut Vec<Column>) -> u64 {
    let attributes = vec![Attribute::Angle, Attribute::scale(0.5, 2.0).expect("valid")];
    let attributes = Attributes::new(attributes).expect("different");
    let bound = plan.attributes(&attributes).expect("not of a mix");
    let (mut blocks, mut total) = (plan.blocks_points(), 0);
    loop {
        let filled = blocks.fill(points);
        bound.write_points(&points[..filled], columns);
        black_box(&mut *columns);
        total += filled as u64;
        if filled < points.len() {
            return total;
        }
    }
}

fn bulk() {
    let side = size(3000.0);
    let [plain, warped] = sets().map(|set| boxed(&set, [0.0, 0.0], side));
    let points = plain.count() as u64;
    let (mut fill, mut singles) = (vec![[0f32; 2]; BLOCK], vec![[0f32; 2]; BLOCK]);
    let (mut moved, mut doubles) = (singles.clone(), vec![[0f64; 2]; BLOCK]);
    let mut moved_doubles = doubles.clone();
    let mut ids = vec![Point::default(); BLOCK];
    let (mut few, mut columns) = (vec![Point::default(); AT_ONCE], vec![]);
    let mut few_ids = few.clone();
    let mut marker = 0f32;
    let [
        filled,
        single,
        double,
        id,
        few_id,
        attributes,
        warped_single,
        warped_double,
    ] = medians(
        rounds_of(15),
        &mut [
            &mut || {
                for _ in 0..points.div_ceil(BLOCK as u64) {
                    marker += 1.0;
                    black_box(&mut fill).fill([marker, marker]);
                }
                points.next_multiple_of(BLOCK as u64)
            },
            &mut || fill_all::<F32>(&plain, &mut singles),
            &mut || fill_all::<F64>(&plain, &mut doubles),
            &mut || fill_all::<Points>(&plain, &mut ids),
            &mut || fill_all::<Points>(&plain, &mut few_ids),
            &mut || with_attributes(&plain, &mut few, &mut columns),
            &mut || fill_all::<F32>(&warped, &mut moved),
            &mut || fill_all::<F64>(&warped, &mut moved_doubles),
        ],
    );
    row("f32 ÷ plain fill", filled / single, "0.45", nanos(single));
    row(
        "warped f32 ÷ f32",
        single / warped_single,
        "0.5",
        nanos(warped_single),
    );
    row(
        "warped f64 ÷ f64",
        double / warped_double,
        "",
        nanos(warped_double),
    );
    row("ids ÷ f64", double / id, "0.8", nanos(id));
    row(
        "ids and two attributes ÷ ids",
        few_id / attributes,
        "0.7",
        nanos(attributes),
    );
}

fn maps() {
    let plans = [49, 100, 200].map(|radius| {
        let plain = PointSet::new(table_of(radius));
        [plain.clone(), plain.seed(1)].map(|set| boxed(&set, [0.0, 0.0], size(3000.0)))
    });
    let block = Cell::new(vec![[0f32; 2]; BLOCK]);
    let fill = |plan: &Plan| {
        let mut room = block.take();
        let made = fill_all::<F32>(plan, &mut room);
        block.set(room);
        made
    };
    let [s, m, l, warped_s, warped_m, warped_l] = medians(
        rounds_of(15),
        &mut [
            &mut || fill(&plans[0][0]),
            &mut || fill(&plans[1][0]),
            &mut || fill(&plans[2][0]),
            &mut || fill(&plans[0][1]),
            &mut || fill(&plans[1][1]),
            &mut || fill(&plans[2][1]),
        ],
    );
    row("map m ÷ s, f32", s / m, "0.9", nanos(m));
    row("map l ÷ s, f32", s / l, "0.9", nanos(l));
    row(
        "map m ÷ s, warped f32",
        warped_s / warped_m,
        "0.9",
        nanos(warped_m),
    );
    row(
        "map l ÷ s, warped f32",
        warped_s / warped_l,
        "0.9",
        nanos(warped_l),
    );
}

fn small() {
    let sets = sets();
    let mut block = vec![[0f32; 2]; 4096];
    let (mut points, mut columns) = (vec![Point::default(); AT_ONCE], vec![]);
    let number = Cell::new(0i64);
    let next = || {
        number.set(number.get() + 1);
        [number.get() % 997, number.get() / 997]
    };
    let mut boxes = |set: usize| {
        let calls = if is_quick() { 3 } else { 500 };
        for _ in 0..calls {
            let plan = boxed(&sets[set], next().map(|v| v as f64 * 40.0), 31.6);
            let count = plan.count() as usize;
            black_box(plan.blocks_f32().fill(&mut block[..count]));
            black_box(&mut block);
        }
        calls
    };
    let (mut plain, mut warped) = (vec![], vec![]);
    let [chunk] = medians(
        rounds_of(25),
        &mut [&mut || {
            for (set, times) in [(0, &mut plain), (1, &mut warped)] {
                let start = now();
                let calls = boxes(set);
                times.push((now() - start) / f64::from(calls));
            }
            0
        }],
    )
    .map(|_| {
        medians(
            rounds_of(25),
            &mut [&mut || {
                let region = Region::chunk(64.0, next()).expect("valid");
                let plan = sets[1].within(region).expect("in range");
                with_attributes(&plan, &mut points, &mut columns)
            }],
        )[0]
    });
    let [plain, warped] = [plain, warped].map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    let note = format!("{:.1} µs, plain {:.1}", 1e6 * warped, 1e6 * plain);
    row(
        "cold box of 1,000 points, warped, µs",
        1e6 * warped,
        "12",
        note.clone(),
    );
    row("the same × plain", warped / plain, "2", note);
    row(
        "chunk of 64 × 64, ids, two attributes, ns",
        1e9 * chunk,
        "100",
        nanos(chunk),
    );
}

fn areas() {
    let points = size(3000.0).powi(2);
    let radius = (points / std::f64::consts::PI).sqrt() / 0.9;
    let vertex = |i: i32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 100.0).sin_cos();
        let radius = if i % 2 == 0 { radius } else { 0.8 * radius };
        [radius * cos, radius * sin]
    };
    let star = Polygon::new(&[(0..100).map(vertex).collect::<Vec<_>>()]).expect("a ring");
    let sets = sets();
    let (mut one, mut two) = (vec![[0f32; 2]; BLOCK], vec![[0f32; 2]; BLOCK]);
    let side = size(10_000.0);
    let [all, of_star, counted] = medians(
        rounds_of(15),
        &mut [
            &mut || fill_all::<F32>(&boxed(&sets[0], [0.0, 0.0], points.sqrt()), &mut one),
            &mut || {
                let plan = sets[0].within(star.clone()).expect("in range");
                fill_all::<F32>(&plan, &mut two)
            },
            &mut || {
                black_box(boxed(&sets[1], [0.0, 0.0], side).count());
                (4.0 * side) as u64
            },
        ],
    );
    row(
        "star of 100 vertices ÷ box",
        all / of_star,
        "0.5",
        nanos(of_star),
    );
    let name = "warped count of a box, ns a spacing of outline";
    row(name, 1e9 * counted, "", String::new());
}

fn main() {
    println!("one thread's own time, medians of interleaved rounds");
    println!("{:<44} {:>8} {:>8}", "", "measured", "target");
    bulk();
    maps();
    small();
    areas();
}
