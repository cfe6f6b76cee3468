//! How fast answers are served, next to answers that cost nothing to make, in one run.
//!
//! `cargo bench --bench serving` prints medians of interleaved rounds and their ratios. Arguments
//! after `--`: names of parts (http, grpc, boxes, text, readers, start) to run only those,
//! `--rounds N`, `--points N` for long streams, `--against ADDRESS/PATH` to alternate our streams
//! with a file of another server, and `--quick` to check only that everything runs.

mod boxes;
mod download;
mod h2c;
mod host;
mod process;
mod readers;
mod start;
mod streams;
mod text;
mod timing;

use timing::Effort;

const PARTS: [&str; 6] = ["http", "grpc", "boxes", "text", "readers", "start"];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let value = |name: &str| {
        let place = arguments.iter().position(|argument| argument == name)?;
        arguments.get(place + 1).cloned()
    };
    let number = |name: &str| value(name).map(|text| text.parse().expect("a number"));
    // `cargo test --benches` runs benches with `--test`.
    let quick = arguments.iter().any(|a| a == "--quick" || a == "--test");
    let effort = Effort {
        quick,
        rounds: number("--rounds").unwrap_or(if quick { 1 } else { 7 }) as usize,
        points: number("--points").unwrap_or(if quick { 100_000 } else { 200_000_000 }),
    };
    let against = value("--against").map(|text| {
        let (address, path) = text.split_once('/').expect("ADDRESS/PATH");
        (address.parse().expect("an address"), format!("/{path}"))
    });
    let none_named = !arguments.iter().any(|a| PARTS.contains(&a.as_str()));
    let wanted = |part: &str| none_named || arguments.iter().any(|argument| argument == part);

    let host = host::Host::start();
    if wanted("http") {
        streams::http(&host, effort, against);
    }
    if wanted("grpc") {
        streams::grpc(&host, effort);
    }
    if wanted("boxes") {
        boxes::boxes(&host, effort);
    }
    if wanted("text") {
        text::text(&host, effort);
    }
    if wanted("readers") {
        readers::readers(effort);
    }
    if wanted("start") {
        start::start(effort);
    }
}
