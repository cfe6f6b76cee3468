//! A soak: mixed requests over REST and gRPC for a given time, with faults injected, and every
//! answer compared with the library's.
//!
//! Three daemons run. One is never stopped: it must answer everything, and its memory is reported. It
//! gets SIGHUPs while a table in its folder is damaged and repaired. The second is killed and
//! restarted again and again; what fails on it meanwhile is excused, but what it answers must be
//! right. A third one has a rate, and what requests cost is compared with what they are charged. `cargo test` runs this for a few seconds; for longer:
//!
//! ```sh
//! cargo test --release --test soak -- --seconds 1800
//! ```
//!
//! Exits with 1 if any answer was wrong, or missing without an excuse, if a daemon died, or if
//! streams are still in progress afterwards.

#[path = "../suite/support/attack.rs"]
mod attack;
mod attacks;
mod checks;
#[path = "../queries/generate.rs"]
mod generate;
mod grpc;
mod hostile;
#[path = "../queries/library.rs"]
mod library;
#[path = "../suite/support/messages.rs"]
mod messages;
mod prices;
mod replica;
mod tally;

use std::{
    path::Path,
    process::ExitCode,
    time::{Duration, Instant},
};

use strew_core::Table;
use strew_testkit::{random::SplitMix, tables::write};

use library::{Library, library};
use replica::Replica;
use tally::{Done, Tally};

/// The arguments.
struct Arguments {
    seconds: u64,
    /// The number of concurrent clients.
    clients: u64,
    /// Decides the requests.
    seed: u64,
}

/// The seconds of a run by `cargo test`.
const SHORT: u64 = 4;

/// The file of the table that is damaged and repaired.
const DAMAGED: &str = "soak.strew";

/// Reads the arguments; `None` if they select other tests, or ask for a list.
fn arguments() -> Result<Option<Arguments>, String> {
    let mut read = Arguments {
        seconds: SHORT,
        clients: 8,
        seed: 1,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let slot = match name.as_str() {
            "--seconds" => &mut read.seconds,
            "--clients" => &mut read.clients,
            "--seed" => &mut read.seed,
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
    Ok(Some(read))
}

fn main() -> ExitCode {
    let arguments = match arguments() {
        Ok(Some(arguments)) => arguments,
        Ok(None) => return ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    match soak(&arguments) {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

/// Runs the soak. Returns the number of wrong answers.
fn soak(arguments: &Arguments) -> u64 {
    let library = library();
    let tally = Tally::default();
    let tables = tempfile::tempdir().expect("a temporary folder");
    // No query uses this table, so it may be damaged at any time.
    let table = Table::undisplaced("3/2".parse().expect("valid"), 20, "soak").expect("small");
    write(tables.path(), DAMAGED, &table);
    let steady = Replica::start(tables.path());
    let shaky = Replica::start(tables.path());
    let start = Instant::now();
    let end = start + Duration::from_secs(arguments.seconds);
    // Memory is compared with that after a while, since things built on first use are not growth.
    let warm = start + Duration::from_secs((arguments.seconds / 10).min(20));
    let mut memory = None;
    std::thread::scope(|scope| {
        for number in 0..arguments.clients {
            let (steady, shaky, tally) = (&steady, &shaky, &tally);
            let seed = arguments.seed << 32 | number;
            scope.spawn(move || client(library, [steady, shaky], tally, seed, end));
        }
        scope.spawn(|| prices::compare(tables.path(), &tally, arguments.seed, end));
        scope.spawn(|| disturb(&steady, &shaky, &tally, tables.path(), &table, end));
        let mut reported = start;
        while Instant::now() < end {
            std::thread::park_timeout(Duration::from_millis(200));
            if memory.is_none() && Instant::now() > warm {
                memory = Some(steady.memory());
            }
            if reported.elapsed() > Duration::from_secs(60) {
                reported = Instant::now();
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
        arguments.seconds,
        arguments.clients,
        arguments.seed,
        tally.report(),
        memory.unwrap_or_default(),
        warm.duration_since(start).as_secs(),
        steady.memory(),
    );
    tally.wrongs()
}

/// Sends requests one after another, each over a connection of its own.
fn client(library: &Library, replicas: [&Replica; 2], tally: &Tally, seed: u64, end: Instant) {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a runtime");
    let (keys, promising) = library.keys();
    let mut random = SplitMix::new(seed);
    while Instant::now() < end {
        let replica = replicas[usize::from(random.once_in(3))];
        let (at, epoch) = (replica.address, replica.epoch());
        let body = generate::query(&mut random, &keys, &promising);
        let (name, done): (_, Done) = match random.below(100) {
            0..=34 => (
                "a query by REST",
                checks::query(library, at, &mut random, &body),
            ),
            35..=46 => (
                "pages by cursors",
                checks::pages(library, at, &mut random, &body),
            ),
            47..=54 => ("a count", checks::count(library, at, &body)),
            55..=60 => (
                "parts of a split",
                checks::parts(library, at, &mut random, &body),
            ),
            61..=75 => (
                "a stream by gRPC",
                runtime.block_on(grpc::stream(library, at, &body)),
            ),
            76..=80 => ("a long stream", checks::long(library, at, &mut random)),
            81..=87 => (
                "a spoiled query",
                checks::spoiled(library, at, &mut random, &body),
            ),
            88..=89 => ("a client that vanishes", hostile::vanish(at, &mut random)),
            90..=91 => ("half a request", hostile::half(at, &mut random)),
            92..=94 => ("no HTTP at all", hostile::garbage(at, &mut random)),
            95..=96 => (
                "calls that are reset",
                runtime.block_on(grpc::resets(at, &mut random)),
            ),
            97..=98 => ("an attack", runtime.block_on(attacks::any(at, &mut random))),
            _ => ("a command", checks::command(library, &mut random, &body)),
        };
        let later = replica.epoch();
        tally.note(name, done, epoch != later || epoch % 2 == 1);
    }
}

/// Damages and repairs a table, reloads, kills and restarts.
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
                std::fs::write(tables.join(DAMAGED), bytes).expect("writable");
                steady.signal("HUP");
                tally.event("a reload with a damaged table");
            }
            1 => {
                // A daemon does not start on a damaged table.
                write(tables, DAMAGED, table);
                shaky.restart("KILL");
                tally.event("a daemon killed and restarted");
            }
            2 => {
                steady.signal("HUP");
                tally.event("a reload");
            }
            _ => {
                shaky.restart("TERM");
                tally.event("a daemon stopped and restarted");
            }
        }
    }
}
