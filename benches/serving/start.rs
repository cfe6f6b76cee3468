//! The time from the start of the program to its first answer, and its memory when idle.

use std::time::Instant;

use super::{
    download, process,
    timing::{Effort, median},
};

pub fn start(effort: Effort) {
    let rounds = if effort.quick { 1 } else { 15 };
    let (mut listening, mut answered, mut resident) = (vec![], vec![], vec![]);
    for _ in 0..rounds {
        let start = Instant::now();
        let daemon = process::start(&[]);
        listening.push(start.elapsed().as_secs_f64());
        resident.extend(process::resident(&daemon));
        let bytes = download::whole(
            daemon.address(),
            "/v1/points?bbox=0,0,30,30&spacing=1&format=f32",
        );
        answered.push(start.elapsed().as_secs_f64());
        assert!(bytes > 7000);
    }
    println!("\nThe program, its built-in tables");
    println!(
        "{:<34} {:>8.1} ms",
        "start to listening",
        median(listening) * 1e3
    );
    println!(
        "{:<34} {:>8.1} ms",
        "start to the first answer",
        median(answered) * 1e3
    );
    if !resident.is_empty() {
        println!(
            "{:<34} {:>8.1} MiB",
            "idle resident memory",
            median(resident)
        );
    }
}
