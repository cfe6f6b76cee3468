//! The shipped tables, work with some numbers of threads, and work that is stopped.

#![allow(dead_code, reason = "each test uses what it needs")]

use std::{fmt::Debug, path::Path, sync::Mutex};

use strew_core::Table;
use strew_forge::{Checkpoint, Progress, Stage, Watch, file_name, read_table};

/// A table of the repository.
pub fn table(profile: &str, alpha: &str, radius: u32) -> Table {
    let name = file_name(profile, alpha.parse().expect("valid"), radius);
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [crates.join("core/tables"), crates.join("catalog/tables")];
    let path = places.map(|place| place.join(&name));
    let path = path.iter().find(|path| path.exists()).expect("shipped");
    read_table(path).unwrap_or_else(|e| panic!("{e}"))
}

/// A watch that stops a stage after a number of steps, and keeps all progress and the last checkpoint.
pub struct Stopper {
    stage: Stage,
    after: u32,
    pub seen: Mutex<Vec<Progress>>,
    kept: Mutex<Option<Checkpoint>>,
}

impl Stopper {
    pub fn new(stage: Stage, after: u32) -> Self {
        Self {
            stage,
            after,
            seen: Mutex::default(),
            kept: Mutex::default(),
        }
    }

    pub fn kept(self) -> Checkpoint {
        let kept = self.kept.into_inner();
        kept.expect("no panic").expect("kept")
    }
}

impl Watch for Stopper {
    fn progress(&self, progress: &Progress) {
        self.seen.lock().expect("no panic").push(*progress);
    }

    fn stop(&self) -> bool {
        let seen = self.seen.lock().expect("no panic");
        let last = seen.last();
        last.is_some_and(|p| p.stage == self.stage && p.step >= self.after)
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        // Through a file's bytes, as after a crash.
        let back = Checkpoint::from_bytes(&checkpoint.to_bytes()).expect("valid");
        *self.kept.lock().expect("no panic") = Some(back);
    }
}

/// What is made, which is the same with any number of threads.
pub fn same<T: PartialEq + Debug + Send>(make: impl Fn() -> T + Sync) -> T {
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(&make)
    });
    assert_eq!(one, three);
    one
}
