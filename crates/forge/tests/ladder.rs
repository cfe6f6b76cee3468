//! Ladders: those shipped keep their promises where nobody looked, and making one can be interrupted.

mod shipped;

use std::sync::Mutex;

use strew_core::{Table, Twin};
use strew_forge::{
    Checkpoint, LadderJob, Progress, ThinnedTwin, Watch, ladder,
    measure::{Distances, Spectrum},
};

#[test]
fn the_shipped_ladder_is_even_at_shares_that_no_step_looked_at() {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 100);
    assert_eq!(
        table.ladder().map(|ladder| ladder.least_share()),
        Some(1.0 / 64.0)
    );
    let thinned = ThinnedTwin::new(&table, Twin::new(683, 418).expect("reduced")).expect("a twin");
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..6 * 17 {
        let share = (-(f64::from(i) + 0.23) / 17.0).exp2();
        let set = thinned.at(share, true);
        let low = Spectrum::of_torus(&set, 0.6).summary(0.04).low_power;
        let delta = Distances::of_torus(&set).delta_min;
        assert!(low < 5e-3, "{share}: {low}");
        assert!(delta > 0.5, "{share}: {delta}");
        (sum, count) = (sum + low, count + 1.0);
    }
    assert!(sum / count < 2.5e-3, "{}", sum / count);
}

fn job() -> (Table, LadderJob) {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 49);
    let job = LadderJob {
        per_octave: 3,
        octaves: 1,
        steps: 18,
    };
    (table, job)
}

/// Stops after some steps and keeps the checkpoint.
struct Stopper {
    after: u32,
    kept: Mutex<Option<Checkpoint>>,
    step: Mutex<u32>,
}

impl Watch for Stopper {
    fn progress(&self, progress: &Progress) {
        *self.step.lock().expect("no panic") = progress.step;
    }

    fn stop(&self) -> bool {
        *self.step.lock().expect("no panic") == self.after
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        *self.kept.lock().expect("no panic") = Some(checkpoint.clone());
    }
}

#[test]
fn a_resumed_ladder_has_the_same_bits_with_any_number_of_threads() {
    let (table, job) = job();
    let whole = ladder(&table, &job, None, &()).expect("a good job");
    assert_eq!(whole.table.displacements(), table.displacements());
    assert_eq!(whole.table.ranks(), table.ranks());
    assert!(
        !whole.interrupted && !whole.accepted,
        "three levels an octave are too few"
    );
    for after in [0, 16] {
        let stopper = Stopper {
            after,
            kept: Mutex::default(),
            step: Mutex::default(),
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let pool = pool.expect("threads");
        let stopped = pool
            .install(|| ladder(&table, &job, None, &stopper))
            .expect("a good job");
        assert!(stopped.interrupted && stopped.table.ladder().is_some());
        let kept = stopper.kept.into_inner().expect("no panic").expect("kept");
        let kept = Checkpoint::from_bytes(&kept.to_bytes()).expect("written");
        let resumed = ladder(&table, &job, Some(kept.clone()), &()).expect("the same job");
        assert_eq!(resumed.table, whole.table, "stopped after {after}");
        let other = LadderJob { steps: 19, ..job };
        assert!(ladder(&table, &other, Some(kept), &()).is_err());
    }
}

#[test]
fn bad_jobs_are_refused() {
    let (table, job) = job();
    let bad = [
        LadderJob {
            per_octave: 0,
            ..job
        },
        LadderJob { octaves: 9, ..job },
        LadderJob { steps: 0, ..job },
    ];
    for job in bad {
        assert!(ladder(&table, &job, None, &()).is_err(), "{job:?}");
    }
}
