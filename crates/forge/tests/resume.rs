//! Work that was stopped is resumed from its checkpoint, and by no other job.

mod stopper;

use std::sync::Mutex;

use stopper::Stopper;
use strew_forge::{Checkpoint, Job, Progress, Stage, Watch, forge, resume};

fn job(steps: u32) -> Job {
    Job {
        radius: 15,
        steps: Some(steps),
        ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
    }
}

/// Records the first step that is reported, and never stops.
#[derive(Default)]
struct FirstStep(Mutex<Option<u32>>);

impl Watch for FirstStep {
    fn progress(&self, progress: &Progress) {
        let mut first = self.0.lock().expect("no panic");
        first.get_or_insert(progress.step);
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
    for (job, stops) in [
        (of("blue", 15, 40), vec![1, 19, 20, 31]),
        (of("spaced", 15, 30), vec![1, 2, 11, 16, 29]),
        (of("lloyd", 12, 12), vec![5]),
        (of("step", 12, 12), vec![3, 11]),
        (of("single-peak", 12, 20), vec![4, 6, 17]),
    ] {
        // The figures add nothing to the comparison, so measuring is stopped.
        let optimized = |from: Option<Checkpoint>| {
            let stopper = Stopper::new(Stage::Measuring, 0);
            let outcome = match from {
                None => forge(&job, &stopper),
                Some(from) => resume(&job, from, &stopper),
            };
            let outcome = outcome.expect("a good job");
            (
                outcome.table.digest(),
                stopper.kept.into_inner().expect("no panic"),
            )
        };
        let whole = optimized(None);
        for after in stops {
            let stopper = Stopper::new(Stage::Optimizing, after);
            let stopped = forge(&job, &stopper).expect("a good job");
            assert!(stopped.interrupted);
            let kept = stopper.kept.into_inner().expect("no panic").expect("kept");
            assert_eq!((kept.steps(), kept.is_optimized()), (after, false));
            kept.is_of(&job).expect("its own");
            assert_eq!(optimized(Some(kept)), whole, "{} {after}", job.profile);
        }
    }
}

#[test]
fn resumed_measuring_does_not_optimize_again() {
    let whole = forge(&job(9), &()).expect("a good job");
    let stopper = Stopper::new(Stage::Measuring, 1);
    assert!(forge(&job(9), &stopper).expect("a good job").interrupted);
    let kept = stopper.kept.into_inner().expect("no panic").expect("kept");
    assert!(kept.is_optimized());
    let first = FirstStep::default();
    assert_eq!(resume(&job(9), kept, &first).expect("its own"), whole);
    assert_eq!(first.0.into_inner().expect("no panic"), Some(9));
}

#[test]
fn a_checkpoint_of_a_different_job_is_refused_with_the_difference() {
    let stopper = Stopper::new(Stage::Optimizing, 2);
    let _ = forge(&job(9), &stopper).expect("a good job");
    let kept = stopper.kept.into_inner().expect("no panic").expect("kept");
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
}
