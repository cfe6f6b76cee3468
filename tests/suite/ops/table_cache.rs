//! The cache of tables, by alpha, profile and map: of a large folder only heads are read, a table is read by the first
//! query that needs it, once, and what is not used leaves.

use std::{collections::BTreeSet, fs, sync::Arc};

use strew_core::{Alpha, Map, Table, table::Provenance};
use strew_testkit::{http1, wait::until};

use crate::support::{
    daemon::{Daemon, no_tables},
    metrics::{samples, sum},
};

/// The files of the folder.
const FILES: usize = 2000;
/// The most bytes that the cache may hold.
const CACHE: u64 = 8 << 20;

/// The alpha of a file.
fn alpha(file: usize) -> Alpha {
    Alpha::from_fraction(9001 + 3 * (file as u64 / 2), 6000).expect("valid")
}

/// The profile of a file: each alpha has two.
fn profile(file: usize) -> &'static str {
    ["even", "odd"][file % 2]
}

fn query(file: usize) -> String {
    let (profile, alpha) = (profile(file), alpha(file));
    format!("/v1/points?bbox=0,0,9,9&spacing=1&profile={profile}&alpha={alpha}&format=csv")
}

/// A table of a file; its only vector differs from those of others.
fn table(file: usize, radius: u32) -> Table {
    let map = Map::new(alpha(file), radius).expect("small");
    let vectors = vec![[file as i32, 7]; map.intervals() * map.intervals()];
    Table::new(map, profile(file), vectors, Provenance::default()).expect("valid")
}

/// Bytes that a process has read, of files and sockets.
fn bytes_read(daemon: &Daemon) -> u64 {
    let io = fs::read_to_string(format!("/proc/{}/io", daemon.pid())).expect("Linux");
    let line = io.lines().find_map(|line| line.strip_prefix("rchar: "));
    line.expect("a figure").parse().expect("a number")
}

#[cfg(target_os = "linux")]
#[test]
fn two_thousand_files_under_a_small_bound() {
    let folder = no_tables();
    let mut all = 0;
    for file in 0..FILES {
        let bytes = table(file, 49).to_bytes();
        all += bytes.len() as u64;
        fs::write(folder.path().join(format!("{file}.strew")), bytes).expect("writable");
    }
    let bound = format!("limits.cache_bytes={CACHE}");
    let settings = [
        "tables.preload_bytes=0",
        bound.as_str(),
        "reload.watch_seconds=0",
    ];
    let daemon = Daemon::with_tables(folder, &settings);
    // Heads were read, bodies not.
    let read = bytes_read(&daemon);
    assert!(all > 30_000_000 && read < all / 4, "{read} of {all}");
    let listed = daemon.get("/v1/profiles").json();
    let own = listed["profiles"].as_array().expect("a list").iter();
    let own: BTreeSet<_> = own
        .filter(|table| ["even", "odd"].contains(&table["profile"].as_str().expect("a text")))
        .map(|table| table["alpha"].to_string())
        .collect();
    assert_eq!(own.len(), FILES / 2);

    // Each answers by its own table.
    let before = samples(&daemon);
    let figure = |name: &str| sum(&samples(&daemon), name, &[]) - sum(&before, name, &[]);
    let many: Vec<usize> = (0..FILES).step_by(7).collect();
    for &file in &many {
        let answer = daemon.get(&query(file));
        assert_eq!(answer.status, 200, "{file}: {}", answer.text());
        let digest = table(file, 49).digest().to_string();
        assert_eq!(answer.header("strew-table"), digest, "{file}");
    }
    assert_eq!(figure("strew_table_loads_total"), many.len() as f64);
    assert_eq!(
        figure("strew_sampler_cache_misses_total"),
        many.len() as f64
    );
    // A table that has left the cache is read again; a cached one is not.
    let last = *many.last().expect("some");
    for _ in 0..20 {
        assert_eq!(daemon.get(&query(last)).status, 200);
    }
    assert!(figure("strew_sampler_cache_hits_total") >= 20.0);
    assert_eq!(figure("strew_table_loads_total"), many.len() as f64);
    until("the cache keeps its bound", || {
        let held = sum(&samples(&daemon), "strew_sampler_cache_bytes", &[]);
        held <= CACHE as f64
    });
    assert_eq!(daemon.get(&query(many[0])).status, 200);
    assert_eq!(figure("strew_table_loads_total"), many.len() as f64 + 1.0);
    // The heads, the cache and the program, not the files.
    let memory = daemon.memory_kib("VmRSS") << 10;
    assert!(memory < 120 << 20, "{memory} bytes for {all} in files");
}

#[test]
fn many_queries_for_one_table_read_it_once() {
    let folder = no_tables();
    fs::write(folder.path().join("a.strew"), table(0, 200).to_bytes()).expect("writable");
    let daemon = Arc::new(Daemon::with_tables(folder, &["tables.preload_bytes=0"]));
    let threads: Vec<_> = (0..16)
        .map(|_| {
            let daemon = daemon.clone();
            std::thread::spawn(move || http1::get(daemon.address(), &query(0), &[]).status)
        })
        .collect();
    for thread in threads {
        assert_eq!(thread.join().expect("no panic"), 200);
    }
    let now = samples(&daemon);
    assert_eq!(sum(&now, "strew_table_loads_total", &[]), 1.0);
}

#[test]
fn damage_beyond_the_head_shows_at_the_first_use_and_ends_with_it() {
    let folder = no_tables();
    let path = folder.path().join("a.strew");
    let good = table(0, 20).to_bytes();
    let mut bad = good.clone();
    let middle = bad.len() / 2;
    bad[middle] ^= 1;
    fs::write(&path, &bad).expect("writable");
    let daemon = Daemon::with_tables(
        folder,
        &["tables.preload_bytes=0", "reload.watch_seconds=0"],
    );
    let answer = daemon.get(&query(0));
    assert_eq!(answer.status, 503, "{}", answer.text());
    let problem = answer.json();
    assert_eq!(problem["type"], "urn:strew:problem:table-unreadable");
    assert!(
        problem["detail"]
            .as_str()
            .is_some_and(|text| text.contains("`even`"))
    );
    assert!(
        !answer.text().contains("a.strew"),
        "files are the operator's"
    );
    daemon.log_line("a.strew");
    // The file is whole again with the same content: nothing need be reloaded.
    fs::write(&path, &good).expect("writable");
    assert_eq!(daemon.get(&query(0)).status, 200);
    // One that is cut is refused at the start already.
    fs::write(daemon.folder().join("b.strew"), &good[..good.len() - 1]).expect("writable");
    daemon.signal("HUP");
    let line = daemon.log_line("b.strew");
    assert!(line.contains("refused"), "{line}");
}
