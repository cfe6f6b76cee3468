//! The harness of the benches: cases that run by turns, their medians, and figures of these in rows; and the sets,
//! areas and jobs of several benches.

#![allow(dead_code, reason = "each bench takes what it needs")]

use std::{cell::Cell, fmt::Display, hint::black_box, ops::Index, sync::LazyLock, time::Instant};

use strew_core::{
    Alpha, Area, Attribute, Attributes, F32, Format, Map, Plan, Point, PointSet, Polygon, Region,
    Table, table::Provenance,
};

/// Points per reused block: 512 KiB of f32 pairs.
pub const BLOCK: usize = 65_536;

/// Points per block with attributes: few enough to stay in cache.
pub const AT_ONCE: usize = 1024;

/// Whether to check only that everything runs: with `--quick`, or with `--test`, which
/// `cargo test --benches` passes.
pub fn is_quick() -> bool {
    std::env::args().any(|arg| arg == "--quick" || arg == "--test")
}

/// A size of the full run, or the one of a quick run.
pub fn size<T>(full: T, quick: T) -> T {
    if is_quick() { quick } else { full }
}

/// Cases that are measured by turns, so that what else runs on the machine hits all of them.
pub struct Turns<'a> {
    rounds: usize,
    clock: fn() -> f64,
    cases: Vec<(String, Job<'a>)>,
}

/// Returns its amount of work.
type Job<'a> = Box<dyn FnMut() -> u64 + 'a>;

impl<'a> Turns<'a> {
    /// Turns by the time of this thread; a quick run has one round.
    pub fn new(rounds: usize) -> Self {
        Self::by(now, rounds)
    }

    pub fn by(clock: fn() -> f64, rounds: usize) -> Self {
        let (rounds, cases) = (size(rounds, 1), vec![]);
        Self {
            rounds,
            clock,
            cases,
        }
    }

    pub fn case(&mut self, name: impl Display, job: impl FnMut() -> u64 + 'a) -> &mut Self {
        self.cases.push((name.to_string(), Box::new(job)));
        self
    }

    pub fn run(&mut self) -> Times {
        let mut times = vec![vec![]; self.cases.len()];
        for _ in 0..self.rounds {
            for ((_, job), times) in self.cases.iter_mut().zip(&mut times) {
                let start = (self.clock)();
                let amount = job();
                times.push(((self.clock)() - start) / amount.max(1) as f64);
            }
        }
        let median = |mut times: Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        };
        let names = self.cases.drain(..).map(|(name, _)| name);
        let rows = names.zip(times.into_iter().map(median)).collect();
        Times {
            rounds: self.rounds,
            rows,
        }
    }
}

/// The medians of cases: seconds per unit of work, by name.
pub struct Times {
    rounds: usize,
    rows: Vec<(String, f64)>,
}

impl Index<&str> for Times {
    type Output = f64;

    fn index(&self, name: &str) -> &f64 {
        let row = self.rows.iter().find(|row| row.0 == name);
        &row.expect("a case").1
    }
}

impl Times {
    /// Prints a title, then a row for each case. A column has a heading, and a figure of seconds per unit of work.
    pub fn print(&self, title: impl Display, columns: &[(&str, &dyn Fn(f64) -> f64)]) {
        println!("{title}, median of {}", self.rounds);
        row("", columns.iter().map(|column| column.0.to_string()), "");
        for (name, seconds) in &self.rows {
            row(name, columns.iter().map(|(_, of)| digits(of(*seconds))), "");
        }
    }
}

pub fn row(name: &str, columns: impl IntoIterator<Item = String>, note: &str) {
    let columns: String = columns.into_iter().map(|v| format!(" {v:>12}")).collect();
    println!("{name:<46}{columns}   {note}");
}

/// A number in four digits, or more of large ones.
pub fn digits(value: f64) -> String {
    let whole = value.abs().log10().floor().clamp(-4.0, 3.0);
    format!("{value:.*}", (3.0 - whole) as usize)
}

/// 10⁹ units of work per second.
pub fn giga(seconds: f64) -> f64 {
    1e-9 / seconds
}

pub fn micros(seconds: f64) -> f64 {
    1e6 * seconds
}

/// The time that this thread has run, in seconds; elsewhere than on Unix the time of day. Others on the machine
/// take little of it.
pub fn now() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    time_of_day()
}

/// The time since the first call, in seconds: for work of several threads.
pub fn time_of_day() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// A result, and the time of day in seconds that it takes once.
pub fn timed<T>(make: impl FnOnce() -> T) -> (T, f64) {
    let start = time_of_day();
    let made = make();
    (made, time_of_day() - start)
}

/// Pseudorandom numbers, of which the high bits are good.
pub fn numbers() -> impl Fn() -> u64 {
    let state = Cell::new(1u64);
    move || {
        let next = state.get().wrapping_mul(6_364_136_223_846_793_005);
        state.set(next.wrapping_add(1_442_695_040_888_963_407));
        state.get()
    }
}

/// Pairs of numbers, each another, for places that no earlier query was at.
pub fn elsewhere() -> impl Fn() -> [i64; 2] {
    let number = Cell::new(0);
    move || {
        number.set(number.get() + 1);
        [number.get() % 997, number.get() / 997]
    }
}

/// A table of the default size with random displacements.
pub fn table() -> Table {
    table_of(49)
}

/// A table of a neighborhood with random displacements: 49 for the map s, 100 for m and 200 for l.
pub fn table_of(radius: u32) -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse::<Alpha>().expect("valid"), radius).expect("small");
    let blocks = map.intervals() * map.intervals();
    let numbers = numbers();
    let next = || (numbers() >> 42) as i32 - (1 << 21);
    let vectors = (0..blocks).map(|_| [next(), next()]).collect();
    Table::new(map, "bench", vectors, Provenance::default()).expect("valid")
}

/// The plain and a warped set of a table, at mean spacing 1.
pub fn sets_of(table: Table) -> [PointSet; 2] {
    let plain = PointSet::new(table);
    let warped = plain.clone().seed(1);
    [plain, warped]
}

pub fn sets() -> [PointSet; 2] {
    sets_of(table())
}

/// The points in a square of `side` with its lower corner at `min`.
pub fn boxed(set: &PointSet, min: [f64; 2], side: f64) -> Plan {
    let region = Region::new(min, min.map(|v| v + side)).expect("ordered");
    set.within(region).expect("in range")
}

/// A polygon of 100 vertices around the origin, alternately at `radius` and `near * radius`. With
/// `near` 0.8 it is a star whose outline is almost four times as long as a circle's.
pub fn star(radius: f64, near: f64) -> Polygon {
    let vertex = |i: i32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 100.0).sin_cos();
        let radius = if i % 2 == 0 { radius } else { near * radius };
        [radius * cos, radius * sin]
    };
    Polygon::new(&[(0..100).map(vertex).collect::<Vec<_>>()]).expect("a ring")
}

/// A block that is written point by point and begun anew when it is full.
pub struct Output<'a> {
    block: &'a mut [[f32; 2]],
    written: usize,
    total: u64,
}

impl<'a> Output<'a> {
    pub fn new(block: &'a mut [[f32; 2]]) -> Self {
        Self {
            block,
            written: 0,
            total: 0,
        }
    }

    #[inline(always)]
    pub fn push(&mut self, at: [f32; 2]) {
        self.block[self.written] = at;
        self.written += 1;
        if self.written == self.block.len() {
            black_box(&mut *self.block);
            self.total += self.written as u64;
            self.written = 0;
        }
    }

    pub fn total(&self) -> u64 {
        self.total + self.written as u64
    }
}

/// Fills a block again and again, until one is not filled. Returns the number of points.
pub fn drain<T>(block: &mut [T], mut fill: impl FnMut(&mut [T]) -> usize) -> u64 {
    let mut total = 0;
    loop {
        let filled = fill(block);
        black_box(&mut *block);
        total += filled as u64;
        if filled < block.len() {
            return total;
        }
    }
}

/// A job with a block of its own.
pub fn in_block<T: Default + Clone>(
    length: usize,
    mut job: impl FnMut(&mut [T]) -> u64,
) -> impl FnMut() -> u64 {
    let mut block = vec![T::default(); length];
    move || job(&mut block)
}

/// Makes all points of a plan in a reused block. Returns the number of points.
pub fn fill_all<F: Format>(plan: &Plan, block: &mut [F::Item]) -> u64 {
    let mut blocks = plan.blocks::<F>();
    drain(block, |block| blocks.fill(block))
}

/// A job that makes all points of a plan.
pub fn filling<F: Format>(plan: &Plan, length: usize) -> impl FnMut() -> u64 {
    in_block(length, move |block| fill_all::<F>(plan, block))
}

/// A job that plans and makes all points of an area.
pub fn filling_area(set: &PointSet, area: &Area) -> impl FnMut() -> u64 {
    in_block(BLOCK, move |block| {
        fill_all::<F32>(&set.within(area.clone()).expect("in range"), block)
    })
}

/// A job that makes all points of a plan, which is made anew each time, with ids and two attributes.
pub fn with_attributes(plan: impl Fn() -> Plan) -> impl FnMut() -> u64 {
    let mut columns = vec![];
    in_block(AT_ONCE, move |points: &mut [Point]| {
        let attributes = vec![Attribute::Angle, Attribute::scale(0.5, 2.0).expect("valid")];
        let attributes = Attributes::new(attributes).expect("different");
        let plan = plan();
        let bound = plan.attributes(&attributes).expect("not of a mix");
        let mut blocks = plan.blocks_points();
        drain(points, |points| {
            let filled = blocks.fill(points);
            bound.write_points(&points[..filled], &mut columns);
            black_box(&mut columns);
            filled
        })
    })
}

/// A job that writes blocks of as many points without computing any.
pub fn plain_fill(points: u64) -> impl FnMut() -> u64 {
    let mut marker = 0f32;
    in_block(BLOCK, move |mut block| {
        for _ in 0..points.div_ceil(BLOCK as u64) {
            marker += 1.0;
            black_box(&mut block).fill([marker; 2]);
        }
        points.next_multiple_of(BLOCK as u64)
    })
}

/// A job that plans and makes boxes of 1,000 points, each elsewhere. Its work is the number of boxes.
pub fn cold_boxes(set: &PointSet, boxes: u64) -> impl FnMut() -> u64 {
    let elsewhere = elsewhere();
    in_block(4096, move |block| {
        for _ in 0..boxes {
            let plan = boxed(set, elsewhere().map(|v| v as f64 * 40.0), 31.6);
            let count = plan.count() as usize;
            black_box(plan.blocks_f32().fill(&mut block[..count]));
            black_box(&mut *block);
        }
        boxes
    })
}
