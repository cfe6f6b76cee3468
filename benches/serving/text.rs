//! Text: the cost of an answer next to that of writing the same numbers and nothing else.
//!
//! The pure cost is that of prepared points written by the fastest formatter for each kind of
//! number, on one thread into memory that stays warm. Next to it: our encoder on one thread, which
//! also makes the points, and the answer as served, on all worker threads.

use std::{hint::black_box, time::Instant};

use strew_catalog::Catalog;
use strew_config::Limits;
use strew_core::Point;
use strew_encode::{Encoding, Output};
use strew_plan::Planned;
use strew_query::{Draft, Query, groups, parse_pairs};

use super::{
    download,
    host::Host,
    timing::{Effort, median},
};

/// The number of prepared points: few enough to stay in the fastest cache.
const PREPARED: usize = 1024;

fn limits() -> Limits {
    let layers = strew_config::Layers::new().expect("the defaults");
    layers.finish().expect("valid").limits
}

fn query(catalog: &Catalog, points: u64) -> Query {
    let side = (points as f64).sqrt();
    let text = format!("bbox=0,0,{side},{side}&spacing=1");
    let draft = Draft::of(parse_pairs(&text, groups::POINTS));
    draft.check(&catalog.clone().into(), 1).expect("valid").0
}

/// The text around the three values of a point.
type Frame = [&'static [u8]; 4];

const CSV: Frame = [b"", b",", b",", b"\n"];
const NDJSON: Frame = [b"{\"id\":\"", b"\",\"x\":", b",\"y\":", b"}\n"];

/// Writes a number with six decimals: one rounding, two digits at a time from a table.
fn write_six(value: f64, out: &mut Vec<u8>) {
    const DIGITS: [[u8; 2]; 100] = {
        let mut digits = [[0; 2]; 100];
        let mut i = 0;
        while i < 100 {
            digits[i] = [b'0' + (i / 10) as u8, b'0' + (i % 10) as u8];
            i += 1;
        }
        digits
    };
    let scaled = (value.abs() * 1e6).round_ties_even() as u64;
    let (mut whole, mut part) = (scaled / 1_000_000, (scaled % 1_000_000) as usize);
    let mut text = [b'0'; 24];
    let mut at = text.len();
    for _ in 0..3 {
        at -= 2;
        text[at..at + 2].copy_from_slice(&DIGITS[part % 100]);
        part /= 100;
    }
    at -= 1;
    text[at] = b'.';
    while whole >= 10 {
        at -= 2;
        text[at..at + 2].copy_from_slice(&DIGITS[(whole % 100) as usize]);
        whole /= 100;
    }
    if whole > 0 || text[at] == b'.' {
        at -= 1;
        text[at] = b'0' + whole as u8;
    }
    if value < 0.0 {
        at -= 1;
        text[at] = b'-';
    }
    out.extend_from_slice(&text[at..]);
}

fn write_shortest(value: f64, out: &mut Vec<u8>) {
    out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
}

/// Writes points and nothing else. Returns seconds per point.
fn pure(points: &[Point], count: u64, frame: &Frame, number: fn(f64, &mut Vec<u8>)) -> f64 {
    let mut out = Vec::with_capacity(256 << 10);
    let start = Instant::now();
    let mut written = 0;
    while written < count {
        if out.len() > 192 << 10 {
            black_box(&mut out).clear();
        }
        for point in points {
            let mut digits = itoa::Buffer::new();
            out.extend_from_slice(frame[0]);
            out.extend_from_slice(digits.format(point.id.x).as_bytes());
            out.push(b':');
            out.extend_from_slice(digits.format(point.id.y).as_bytes());
            out.extend_from_slice(frame[1]);
            number(point.x, &mut out);
            out.extend_from_slice(frame[2]);
            number(point.y, &mut out);
            out.extend_from_slice(frame[3]);
        }
        written += points.len() as u64;
    }
    black_box(&mut out);
    start.elapsed().as_secs_f64() / written as f64
}

/// Makes an answer and throws it away. Returns seconds per point.
fn made(planned: &Planned, output: &Output, limits: &Limits) -> f64 {
    let start = Instant::now();
    let mut answer = planned
        .answer(output, limits.block_bytes)
        .expect("any format");
    for block in &mut answer {
        black_box(block.expect("whole"));
    }
    start.elapsed().as_secs_f64() / answer.points() as f64
}

/// CSV and NDJSON, shortest digits and six decimals.
pub fn text(host: &Host, effort: Effort) {
    let catalog = Catalog::load(true, None).expect("built in");
    let limits = limits();
    let count = if effort.quick { 20_000 } else { 4_000_000 };
    let query = query(&catalog, count);
    let planned = Planned::at_once(query, &limits).expect("within reach");
    let side = (count as f64).sqrt();
    let mut points = vec![Point::default(); PREPARED];
    planned.sets[0].plan.walk().fill(&mut points, &mut vec![]);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let alone = alone.expect("a thread");

    println!("\nText, nanoseconds a point; {count} points an answer");
    println!(
        "{:<26} {:>8} {:>12} {:>8} {:>12} {:>8}",
        "", "pure", "one thread", "÷ pure", "served", "÷ pure"
    );
    for (name, encoding, frame) in [
        ("csv", Encoding::Csv, &CSV),
        ("ndjson", Encoding::Ndjson, &NDJSON),
    ] {
        for decimals in [None, Some(6)] {
            let number = decimals.map_or(write_shortest as fn(f64, &mut Vec<u8>), |_| write_six);
            let output = Output {
                decimals,
                ..Output::new(encoding)
            };
            let digits = decimals.map_or(String::new(), |n| format!("&decimals={n}"));
            let path = format!("/v1/points?bbox=0,0,{side},{side}&spacing=1&format={name}{digits}");
            let mut figures: [Vec<f64>; 3] = Default::default();
            for _ in 0..effort.rounds {
                figures[0].push(pure(&points, count, frame, number));
                figures[1].push(alone.install(|| made(&planned, &output, &limits)));
                let start = Instant::now();
                download::whole(host.address, &path);
                figures[2].push(start.elapsed().as_secs_f64() / count as f64);
            }
            let [pure, made, served] = figures.map(median);
            let title = decimals.map_or("shortest".to_owned(), |n| format!("{n} decimals"));
            println!(
                "{:<26} {:>8.1} {:>12.1} {:>8.2} {:>12.1} {:>8.2}",
                format!("{name}, {title}"),
                pure * 1e9,
                made * 1e9,
                made / pure,
                served * 1e9,
                served / pure
            );
        }
    }
}
