//! Work that was stopped is resumed from its checkpoint, and by no other job, in the plane and in space.

use std::{fmt::Debug, sync::Mutex};

use strew_forge::{
    Checkpoint, Job, Progress, Stage, TableOf, Task, Watch, forge, resume,
    space::{SpaceJob, SpaceProfile},
};

/// Keeps the first progress and the last checkpoint, and stops a stage after a number of steps.
struct Stopper {
    stage: Stage,
    after: u32,
    seen: Mutex<Vec<Progress>>,
    kept: Mutex<Option<Checkpoint>>,
}

impl Stopper {
    fn new(stage: Stage, after: u32) -> Self {
        Self {
            stage,
            after,
            seen: Mutex::default(),
            kept: Mutex::default(),
        }
    }

    fn kept(self) -> Checkpoint {
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

fn job(steps: u32) -> Job {
    Job {
        radius: 15,
        steps: Some(steps),
        ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
    }
}

fn in_space() -> SpaceJob {
    SpaceJob {
        radius: 4,
        steps: Some(40),
        ..SpaceJob::new(SpaceProfile::Spaced)
    }
}

/// Stops a job after some steps and compares what is made from there.
fn check<J: Task>(job: &J, stops: &[u32])
where
    TableOf<J>: PartialEq + Debug,
{
    // The figures add nothing to the comparison, so measuring is stopped.
    let optimized = |from: Option<Checkpoint>| {
        let stopper = Stopper::new(Stage::Measuring, 0);
        let outcome = match from {
            None => forge(job, &stopper),
            Some(from) => resume(job, from, &stopper),
        };
        let outcome = outcome.expect("a good job");
        assert!(outcome.interrupted && !outcome.accepted);
        (outcome.table, stopper.kept())
    };
    let whole = optimized(None);
    assert!(whole.1.is_optimized());
    for &after in stops {
        let stopper = Stopper::new(Stage::Optimizing, after);
        assert!(forge(job, &stopper).expect("a good job").interrupted);
        let kept = stopper.kept();
        assert_eq!((kept.steps(), kept.is_optimized()), (after, false));
        kept.is_of(job).expect("its own");
        assert_eq!(optimized(Some(kept)), whole, "{after}");
    }
}

#[test]
fn resumed_work_makes_the_same_table() {
    let of = |profile: &str, radius, steps| Job {
        profile: profile.into(),
        radius,
        ..job(steps)
    };
    // One of each kind of recipe, stopped in each phase and between phases.
    check(&of("blue", 15, 40), &[1, 19, 20, 31]);
    check(&of("spaced", 15, 30), &[1, 2, 11, 16, 29]);
    check(&of("lloyd", 12, 12), &[5]);
    check(&of("step", 12, 12), &[3, 11]);
    check(&of("single-peak", 12, 20), &[4, 6, 17]);
    check(&in_space(), &[0, 3, 7, 11, 25, 37]);
}

#[test]
fn resumed_measuring_does_not_optimize_again() {
    let whole = forge(&job(9), &()).expect("a good job");
    let stopper = Stopper::new(Stage::Measuring, 1);
    assert!(forge(&job(9), &stopper).expect("a good job").interrupted);
    let kept = stopper.kept();
    assert!(kept.is_optimized());
    let endless = Stopper::new(Stage::Optimizing, u32::MAX);
    assert_eq!(resume(&job(9), kept, &endless).expect("its own"), whole);
    assert_eq!(endless.seen.into_inner().expect("no panic")[0].step, 9);
}

#[test]
fn a_checkpoint_of_a_different_job_is_refused_with_the_difference() {
    let stopper = Stopper::new(Stage::Optimizing, 2);
    let _ = forge(&job(9), &stopper).expect("a good job");
    let kept = stopper.kept();
    let good = job(9);
    let others: [(fn(&mut Job), _); 6] = [
        (|job| job.steps = Some(10), "steps"),
        (|job| job.seed = 3, "seed = 3"),
        (|job| job.radius = 14, "radius = 14"),
        (|job| job.profile = "sharp".into(), "profile = sharp"),
        (
            |job| job.alpha = "sqrt(3)".parse().expect("valid"),
            "sqrt(3)",
        ),
        (
            |job| {
                job.profile = "mine".into();
                job.target = Some("0 0\n0.5 1".parse().expect("valid"));
            },
            "profile = mine",
        ),
    ];
    for (change, name) in others {
        let mut other = good.clone();
        change(&mut other);
        let refused = kept.is_of(&other).expect_err("another").to_string();
        assert!(refused.contains(name), "{refused}");
        assert!(resume(&other, kept.clone(), &()).is_err());
    }
    kept.is_of(&good).expect("its own");
    // Jobs in space, and of the plane.
    let stopper = Stopper::new(Stage::Optimizing, 2);
    let _ = forge(&in_space(), &stopper).expect("a good job");
    let kept = stopper.kept();
    let other = SpaceJob {
        seed: 2,
        ..in_space()
    };
    let refused = [kept.is_of(&other), kept.is_of(&good)].map(|r| r.expect_err("another"));
    let [seed, plane] = refused.map(|error| error.to_string());
    assert!(
        seed.contains("seed = 1") && seed.contains("seed = 2"),
        "{seed}"
    );
    assert!(plane.contains("points = in space"), "{plane}");
}
