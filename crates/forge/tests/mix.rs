//! Mixes: kinds are even on sets that the forge never saw, and equal on every machine.

mod shipped;

use std::{fs, path::Path};

use strew_core::{Map, PointSet, Table, Twin, table::Provenance};
use strew_forge::{
    MixJob, Stage, ThinnedTwin, labels,
    measure::{Distances, Sample, Spectrum},
    mix, mix_file_name, read_table,
};

/// A twin of 978,121 points, which is larger than those that the judge looks at. Others have other shares of
/// blocks than α: in 1348/825 the kind of a half has 0.493.
fn twin() -> Twin {
    Twin::new(2549, 1560).expect("reduced")
}

fn low(set: &Sample) -> f64 {
    Spectrum::of(set, 0.6).summary(0.04).low_power
}

/// A small table whose points move a little.
fn small() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
    let blocks = map.intervals() * map.intervals();
    let vector = |block: usize| [0, 1].map(|axis| ((block * 7919 + axis * 31) % 4096) as i32 * 300);
    let vectors = (0..blocks).map(vector).collect();
    Table::new(map, "blue", vectors, Provenance::default()).expect("valid")
}

/// FNV-1a.
fn hash(bytes: impl Iterator<Item = u8>) -> u64 {
    let step = |h: u64, byte: u8| (h ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    bytes.fold(0xcbf2_9ce4_8422_2325, step)
}

/// A table with labels for some shares.
fn labeled(table: &Table, shares: &str) -> Table {
    let made = labels(table, &shares.parse().expect("valid"), &());
    made.expect("valid").expect("not stopped")
}

#[test]
fn labels_of_the_default_table_are_even_on_another_twin_and_at_every_share() {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 100);
    for (shares, limit) in [
        ("1:1", 0.055),
        ("1:3", 0.09),
        ("1:1:2", 0.07),
        ("1:3:10", 0.1),
    ] {
        let mixed = labeled(&table, shares);
        assert_eq!(mixed.displacements(), table.displacements());
        let points = ThinnedTwin::new(&mixed, twin()).expect("a twin");
        let mix = mixed.mix().expect("one").shares().clone();
        for keep in [1.0, 0.43, 0.11] {
            let all = points.at(keep, None);
            assert!(
                keep == 1.0 || low(&all) < 0.16,
                "{shares} {keep}: {}",
                low(&all)
            );
            for kind in 0..mix.kinds() as u8 {
                let set = points.at(keep, Some(kind));
                let share = set.points().len() as f64 / all.points().len() as f64;
                assert!(
                    (share - mix.of(kind)).abs() < 0.005,
                    "{shares} {keep}: {share}"
                );
                let limit = if keep == 1.0 { limit } else { 0.14 };
                assert!(
                    low(&set) < limit,
                    "{shares} {keep}, kind {kind}: {}",
                    low(&set)
                );
            }
        }
    }
}

#[test]
fn shipped_joint_tables_keep_their_promises_on_another_twin() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/tables/joint");
    let plain = shipped::table("blue", "(5-sqrt(3))/2", 100);
    let anisotropy = |set: &Sample| Spectrum::of(set, 1.5).summary(0.04);
    let before = ThinnedTwin::new(&plain, twin())
        .expect("a twin")
        .at(1.0, None);
    let before = anisotropy(&before).anisotropy_db;
    for shares in ["1-1", "1-3", "1-1-2", "1-3-10"] {
        let name = format!("blue-5-sqrt3-over-2-m-mix-{shares}.strew");
        let table = read_table(&folder.join(name)).expect("shipped");
        let points = ThinnedTwin::new(&table, twin()).expect("a twin");
        let all = points.at(1.0, None);
        let kinds = table.mix().expect("one").shares().kinds() as u8;
        let sets = (0..kinds).map(|kind| (points.at(1.0, Some(kind)), 0.015, 0.57));
        for (set, low, delta) in sets.chain([(all, 5e-4, 0.54)]) {
            let summary = anisotropy(&set);
            assert!(summary.low_power < low, "{shares}: {}", summary.low_power);
            assert!(summary.peak_power < 4.5, "{shares}: {}", summary.peak_power);
            assert!(
                summary.anisotropy_db < before + 0.5,
                "{shares}: {}",
                summary.anisotropy_db
            );
            let found = Distances::of(&set).delta_min;
            assert!(found > delta, "{shares}: {found}");
        }
    }
}

#[test]
fn labels_of_the_library_are_those_of_the_forge() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/tables/even");
    let plain = shipped::table("blue", "(5-sqrt(3))/2", 100);
    for shares in ["1:1", "1:3", "1:1:2", "1:3:10"] {
        let made = labeled(&plain, shares);
        let name = shares.replace(':', "-");
        let path = folder.join(format!("blue-5-sqrt3-over-2-m-{name}.labels"));
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            let (mix, ranks) = (made.mix().expect("one"), made.ranks().expect("made"));
            fs::write(&path, plain.labels_of(mix, ranks)).expect("written");
        }
        let file = fs::read(&path).expect("shipped");
        assert_eq!(plain.with_labels(&file), Ok(made), "{shares}");
    }
}

#[test]
fn labels_and_ranks_are_the_same_with_any_number_of_threads_and_pinned() {
    let made = shipped::same(|| labeled(&small(), "10:1:3"));
    let mix = made.mix().expect("one");
    assert_eq!(hash(mix.labels().iter().copied()), 596_408_327_707_228_533);
    let ranks = made.ranks().expect("made").positions();
    assert_eq!(
        hash(ranks.iter().flat_map(|rank| rank.to_le_bytes())),
        4_589_869_531_630_252_071
    );
    // A mix is part of the digest; ids and places are those of the table.
    assert_ne!(made.digest(), small().digest());
    let [plain, mixed] = [small(), made].map(PointSet::new);
    let points = |set: &PointSet| set.chunk(12.0, [3, -4]).expect("near").to_vec();
    assert_eq!(points(&plain), points(&mixed));
}

#[test]
fn joint_tables_are_the_same_with_any_number_of_threads_and_pinned() {
    let mut job = MixJob::joint("1:3".parse().expect("valid"));
    job.steps = 12;
    let made = shipped::same(|| mix(&small(), &job, &()).expect("valid"));
    let made = made.expect("not stopped");
    let vectors = made.table.displacements().iter().flatten();
    assert_eq!(
        hash(vectors.flat_map(|v| v.to_le_bytes())),
        9_788_259_393_124_259_789
    );
    let history = made.table.provenance();
    assert_eq!(history.optimizer, "joint-mix");
    let of = ("of".to_owned(), small().digest().to_string());
    assert!(history.parameters.contains(&of));
}

#[test]
fn work_can_be_stopped_at_any_step() {
    let mut job = MixJob::joint("1:3".parse().expect("valid"));
    job.steps = 12;
    // In the annealing, in the descent, in the order of leaving, while measuring.
    let optimizing = [3, 104, 117].map(|after| (Stage::Optimizing, after));
    for (stage, after) in optimizing.into_iter().chain([(Stage::Measuring, 1)]) {
        let stopper = shipped::Stopper::new(stage, after);
        let made = mix(&small(), &job, &stopper).expect("valid");
        assert!(made.is_none(), "{after}");
        let last = stopper.seen.into_inner().expect("no panic").pop();
        let last = last.expect("some progress");
        assert!(last.stage == stage && last.step <= after + 2, "{last:?}");
    }
}

#[test]
fn impossible_jobs_are_refused() {
    let mut job = MixJob::joint("3:1".parse().expect("valid"));
    assert_eq!((job.shares.to_string().as_str(), job.steps), ("1:3", 240));
    let name = mix_file_name(&small(), &job);
    assert_eq!(name, "blue-5-sqrt3-over-2-r20-mix-1-3.strew");
    job.steps = 0;
    let error = mix(&small(), &job, &()).expect_err("no steps");
    assert_eq!(error.to_string(), "steps is 0; allowed: from 1 to 10000");
    // Three blocks an axis: kinds have less than a block, or none at all.
    let tiny = Table::undisplaced("(5-sqrt(3))/2".parse().expect("valid"), 1, "pattern");
    let tiny = tiny.expect("small");
    for shares in ["1:1023", "1:1", "1:2:3:4:5:6:7:8:9", "31:32:33:34"] {
        match labels(&tiny, &shares.parse().expect("valid"), &()) {
            Ok(made) => assert!(made.expect("not stopped").mix().is_some()),
            Err(error) => assert!(error.to_string().contains("mix"), "{error}"),
        }
    }
}
