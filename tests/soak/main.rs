//! A soak: mixed questions by all doors for a given time, with faults injected, and every answer
//! compared with the library's.
//!
//! Two daemons run. One is never stopped: it must answer everything, and its memory is told at start
//! and end. It gets SIGHUPs while a table in its folder is damaged and mended. The other is killed
//! and restarted again and again; what fails on it meanwhile is excused, what it answers has to be
//! right. `cargo test` runs this for a few seconds; for longer:
//!
//! ```sh
//! cargo test --release --test soak -- --seconds 1800
//! ```
//!
//! Ends with 1 if any answer was wrong or missing without an excuse, if a daemon died, or if answers
//! are still under way afterwards.

#[path = "../queries/any.rs"]
mod any;
mod calls;
mod checks;
mod faults;
mod http;
mod replica;
mod tally;
#[path = "../queries/world.rs"]
mod world;

use std::{
    path::Path,
    process::ExitCode,
    time::{Duration, Instant},
};

use any::Dice;
use replica::Replica;
use strew_core::Table;
use tally::{Done, Tally};
use world::{World, world};

/// How long, how many clients, and which questions.
struct Asked {
    seconds: u64,
    clients: u64,
    seed: u64,
}

/// What is run in passing, by `cargo test`.
const SHORT: u64 = 4;

fn asked() -> Result<Option<Asked>, String> {
    let mut asked = Asked {
        seconds: SHORT,
        clients: 8,
        seed: 1,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let slot = match name.as_str() {
            "--seconds" => &mut asked.seconds,
            "--clients" => &mut asked.clients,
            "--seed" => &mut asked.seed,
            // Somebody wants other tests, or their list.
            "--list" => return Ok(None),
            other if !other.starts_with('-') && !"soak".contains(other) => return Ok(None),
            _ => continue,
        };
        let value = arguments.next().unwrap_or_default();
        *slot = value
            .parse()
            .ok()
            .filter(|value| (1..=1 << 20).contains(value))
            .ok_or_else(|| format!("{name} {value}: allowed: 1 to 1048576"))?;
    }
    Ok(Some(asked))
}

fn main() -> ExitCode {
    let asked = match asked() {
        Ok(Some(asked)) => asked,
        Ok(None) => return ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    match soak(&asked) {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

/// How many answers were wrong.
fn soak(asked: &Asked) -> u64 {
    let world = world();
    let tally = Tally::default();
    let tables = tempfile::tempdir().expect("a temporary folder");
    // Nobody asks for it, so that nothing is wrong while it is damaged.
    let table = Table::undisplaced("3/2".parse().expect("valid"), 20, "soak").expect("small");
    mend(tables.path(), &table);
    let steady = Replica::start(tables.path());
    let shaky = Replica::start(tables.path());
    let start = Instant::now();
    let end = start + Duration::from_secs(asked.seconds);
    // What is built on first use is no growth.
    let warm = start + Duration::from_secs((asked.seconds / 10).min(20));
    let mut memory = None;
    std::thread::scope(|scope| {
        for number in 0..asked.clients {
            let (steady, shaky, tally) = (&steady, &shaky, &tally);
            let seed = asked.seed << 32 | number;
            scope.spawn(move || client(world, [steady, shaky], tally, seed, end));
        }
        scope.spawn(|| disturb(&steady, &shaky, &tally, tables.path(), &table, end));
        let mut told = start;
        while Instant::now() < end {
            std::thread::park_timeout(Duration::from_millis(200));
            if memory.is_none() && Instant::now() > warm {
                memory = Some(steady.memory());
            }
            if told.elapsed() > Duration::from_secs(60) {
                told = Instant::now();
                let seconds = start.elapsed().as_secs();
                eprintln!("{seconds} s: {}, {:.0} MiB", tally.short(), steady.memory());
            }
        }
    });
    for (name, replica) in [("steady", &steady), ("restarted", &shaky)] {
        if !replica.is_running() {
            tally.wrong(format!("the {name} daemon died"));
        } else if let Err(what) = replica.streams_at_rest() {
            tally.wrong(format!("the {name} daemon: {what}"));
        }
    }
    println!(
        "{} seconds, {} clients, seed {}\n{}memory of the daemon that was never stopped: {:.1} MiB \
         after {} s, {:.1} MiB at the end",
        asked.seconds,
        asked.clients,
        asked.seed,
        tally.report(),
        memory.unwrap_or_default(),
        warm.duration_since(start).as_secs(),
        steady.memory(),
    );
    tally.wrongs()
}

/// One client after another, each with one question.
fn client(world: &World, replicas: [&Replica; 2], tally: &Tally, seed: u64, end: Instant) {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a runtime");
    let (keys, promising) = world.keys();
    let mut dice = Dice::new(seed);
    while Instant::now() < end {
        let replica = replicas[usize::from(dice.once_in(3))];
        let (at, epoch) = (replica.address, replica.epoch());
        let body = any::query(&mut dice, &keys, &promising);
        let (name, done): (_, Done) = match dice.below(100) {
            0..=34 => (
                "a query by REST",
                checks::query(world, at, &mut dice, &body),
            ),
            35..=46 => (
                "pages by cursors",
                checks::pages(world, at, &mut dice, &body),
            ),
            47..=54 => ("a count", checks::count(world, at, &body)),
            55..=60 => (
                "parts of a split",
                checks::parts(world, at, &mut dice, &body),
            ),
            61..=75 => (
                "a stream by gRPC",
                runtime.block_on(calls::stream(world, at, &body)),
            ),
            76..=80 => ("a long stream", checks::long(world, at, &mut dice)),
            81..=87 => (
                "a spoiled query",
                checks::spoiled(world, at, &mut dice, &body),
            ),
            88..=90 => ("a client that vanishes", faults::vanish(at, &mut dice)),
            91..=93 => ("half a request", faults::half(at, &mut dice)),
            94..=96 => ("no HTTP at all", faults::garbage(at, &mut dice)),
            97..=98 => (
                "calls that are reset",
                runtime.block_on(calls::resets(at, &mut dice)),
            ),
            _ => ("a command", checks::command(world, &mut dice, &body)),
        };
        let later = replica.epoch();
        tally.note(name, done, epoch != later || epoch % 2 == 1);
    }
}

/// Damages and mends a table, signals, kills and restarts.
fn disturb(
    steady: &Replica,
    shaky: &Replica,
    tally: &Tally,
    tables: &Path,
    table: &Table,
    end: Instant,
) {
    for round in 0_u64.. {
        let next = Instant::now() + Duration::from_millis(1500);
        while Instant::now() < next {
            if Instant::now() > end {
                return;
            }
            std::thread::park_timeout(Duration::from_millis(50));
        }
        match round % 4 {
            0 => {
                let mut bytes = table.to_bytes();
                let middle = bytes.len() / 2;
                bytes[middle] ^= 1;
                std::fs::write(tables.join("soak.strew"), bytes).expect("writable");
                steady.signal("-HUP");
                tally.event("a reload with a damaged table");
            }
            1 => {
                // A daemon that starts meanwhile needs it in order.
                mend(tables, table);
                shaky.restart("-KILL");
                tally.event("a daemon killed and restarted");
            }
            2 => {
                steady.signal("-HUP");
                tally.event("a reload");
            }
            _ => {
                shaky.restart("-TERM");
                tally.event("a daemon stopped and restarted");
            }
        }
    }
}

fn mend(tables: &Path, table: &Table) {
    std::fs::write(tables.join("soak.strew"), table.to_bytes()).expect("writable");
}
