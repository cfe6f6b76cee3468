//! Many slow readers and a fast one: the speed of the fast one, and the memory of the daemon.

use std::{
    io::Read as _,
    net::TcpStream,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use strew_testkit::daemon::Daemon;

use super::{
    download, process,
    timing::{Effort, median},
};

/// The bytes that a slow reader takes at a time, and how long it rests after that.
const SIP: usize = 16 << 10;
const REST: Duration = Duration::from_millis(50);

/// Lets readers take a sip each, one after another, then rest, until `over`. Counts their bytes.
fn sip(mut readers: Vec<TcpStream>, over: &AtomicBool, taken: &AtomicU64) {
    let mut buffer = vec![0; SIP];
    while !over.load(Ordering::Relaxed) {
        for reader in &mut readers {
            let read = reader.read(&mut buffer).expect("readable");
            taken.fetch_add(read as u64, Ordering::Relaxed);
        }
        thread::sleep(REST);
    }
}

/// Bytes per second of one reader that reads as fast as it can for a while.
fn fast(daemon: &Daemon, time: Duration) -> f64 {
    let mut stream = download::open(daemon.address(), &endless());
    let mut buffer = vec![0; 1 << 20];
    let (start, mut total) = (Instant::now(), 0);
    while start.elapsed() < time {
        total += stream.read(&mut buffer).expect("readable");
    }
    total as f64 / start.elapsed().as_secs_f64()
}

/// The path of a stream that does not end before the bench does.
fn endless() -> String {
    let side = 1.4e9f64.sqrt();
    format!("/v1/points?bbox=0,0,{side},{side}&spacing=1&format=f32")
}

pub fn readers(effort: Effort) {
    let (slow, time) = if effort.quick {
        (8, Duration::from_millis(50))
    } else {
        (256, Duration::from_secs(1))
    };
    let daemon = process::start(&[
        "limits.max_streams=300",
        "per_address.max_streams=300",
        "per_address.max_bytes_in_flight=1000000000",
    ]);
    let mut alone = vec![];
    for _ in 0..effort.rounds {
        alone.push(fast(&daemon, time));
    }
    let idle = process::resident(&daemon);
    let path = endless();
    let readers = (0..slow).map(|_| download::open(daemon.address(), &path));
    let (over, taken) = (
        Arc::new(AtomicBool::new(false)),
        Arc::new(AtomicU64::new(0)),
    );
    let sipping = thread::spawn({
        let (readers, over, taken) = (readers.collect(), over.clone(), taken.clone());
        move || sip(readers, &over, &taken)
    });
    thread::sleep(time);
    let (start, before) = (Instant::now(), taken.load(Ordering::Relaxed));
    let (mut beside, mut resident) = (vec![], vec![]);
    for _ in 0..effort.rounds {
        beside.push(fast(&daemon, time));
        resident.extend(process::resident(&daemon));
    }
    let sipped = (taken.load(Ordering::Relaxed) - before) as f64 / start.elapsed().as_secs_f64();
    over.store(true, Ordering::Relaxed);
    sipping.join().expect("no panic");

    let (alone, beside) = (median(alone), median(beside));
    println!("\n{slow} slow readers and a fast one, f32 over HTTP/1.1");
    println!("{:<34} {:>8.2} GB/s", "the fast one alone", alone * 1e-9);
    println!(
        "{:<34} {:>8.2} GB/s",
        "the fast one among the slow",
        beside * 1e-9
    );
    println!(
        "{:<34} {:>8.2} GB/s",
        "all slow ones together",
        sipped * 1e-9
    );
    println!("{:<34} {:>8.2}", "the fast one ÷ alone", beside / alone);
    if let (Some(idle), Some(first), Some(last)) = (idle, resident.first(), resident.last()) {
        println!("{:<34} {idle:>8.1} MiB", "resident before");
        println!("{:<34} {first:>8.1} MiB", "with all readers");
        println!("{:<34} {last:>8.1} MiB", "at the end");
    }
}
