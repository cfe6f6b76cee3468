//! Jobs in the plane and in space: bad ones are refused, equal ones make equal tables, every step is reported, and work that
//! was stopped is resumed from its checkpoint, and by no other job.

mod shipped;

use std::{fmt::Debug, time::Duration};

use strew_core::{Alpha, Table, Twin, space};
use strew_forge::{
    Checkpoint, Job, Stage, TableOf, Task, estimate, forge, resume,
    space::{SpaceJob, SpaceProfile},
};

use shipped::Stopper;

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

fn of(alpha: &str) -> Alpha {
    alpha.parse().expect("valid")
}

/// A change of a job, and words for the part, its value and what is allowed.
type Bad<J> = (fn(&mut J), [&'static str; 3]);

/// Checks that a job is refused after each of some changes.
fn refused<J: Task + Clone>(good: &J, bad: &[Bad<J>]) {
    for (change, words) in bad {
        let mut job = good.clone();
        change(&mut job);
        let errors = [forge(&job, &()).err(), estimate(&job).err()];
        for error in errors.map(|error| error.expect("refused").to_string()) {
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
    }
}

#[test]
fn bad_parts_are_refused_with_name_value_and_allowed_range() {
    const STEPS: &str = "1 to 1000000";
    refused(
        &job(1),
        &[
            (|job| job.alpha = of("3/2"), ["alpha", "3/2", "1.1"]),
            (|job| job.alpha = of("1.01"), ["alpha", "101/100", "1.1"]),
            (|job| job.steps = Some(0), ["steps", "0", STEPS]),
            (
                |job| job.steps = Some(u32::MAX),
                ["steps", "4294967295", STEPS],
            ),
            (|job| job.radius = 0, ["R", "0", "1 to 256"]),
            (|job| job.radius = 257, ["R", "257", "1 to 256"]),
            (
                |job| job.profile = "bleu".into(),
                ["profile", "bleu", "blue"],
            ),
        ],
    );
    refused(
        &in_space(),
        &[
            (|job| job.alpha = of("1.4"), ["alpha", "7/5", "1.51"]),
            (|job| job.radius = 0, ["R", "0", "1 to 22"]),
            (|job| job.radius = 23, ["R", "23", "1 to 22"]),
            (|job| job.steps = Some(0), ["steps", "0", STEPS]),
            (
                |job| (job.alpha, job.radius) = (of("1.999"), 22),
                ["R", "45 intervals", "at most 40"],
            ),
        ],
    );
}

#[test]
fn an_estimate_states_the_steps_and_sizes_of_the_job() {
    let found = estimate(&job(40)).expect("allowed");
    assert_eq!((found.steps, found.blocks), (40, 21 * 21));
    assert!(found.pairs > 60 * found.blocks && found.pairs < 300 * found.blocks);
    assert!(found.measured_points > 3 * 50_000 && found.time > Duration::ZERO);
    let job = SpaceJob {
        radius: 5,
        steps: Some(97),
        ..in_space()
    };
    let found = estimate(&job).expect("allowed");
    assert_eq!((found.steps, found.blocks), (97, 343));
    assert!(found.measured_points > 10_000 && found.time > Duration::ZERO);
}

/// The table of a job, which is the same with any number of threads.
fn made<J: Task + Sync>(job: &J) -> TableOf<J>
where
    TableOf<J>: PartialEq + Debug + Send,
{
    shipped::same(|| forge(job, &()).expect("allowed").table)
}

#[test]
fn equal_jobs_make_equal_tables_with_any_number_of_threads() {
    made(&Job {
        radius: 12,
        profile: "step".into(),
        ..job(6)
    });
    let other = made(&Job { seed: 2, ..job(30) });
    assert_ne!(made(&job(30)).displacements(), other.displacements());
    for profile in SpaceProfile::ALL {
        let of = |seed| SpaceJob {
            profile,
            seed,
            ..in_space()
        };
        let table = made(&of(1));
        assert_ne!(table.vectors(), made(&of(2)).vectors());
        assert!(table.ranks().is_some());
        let least = table.least_distance().relative();
        assert!(least > 0.1, "{least}");
        let history = table.provenance();
        assert!(history.twins.is_empty() && history.figures.iter().all(|f| !f.seen));
        let subjects: Vec<&str> = history.figures.iter().map(|f| f.subject.as_str()).collect();
        assert!(subjects[0].starts_with("twin "), "{subjects:?}");
        let windows = ["window seed 0", "window seed 1", "window seed 2"];
        assert_eq!(subjects[1..], windows);
        assert_eq!(space::Table::from_bytes(&table.to_bytes()), Ok(table));
    }
}

#[test]
fn the_history_records_recipe_twins_and_figures() {
    let outcome = forge(&job(30), &()).expect("a good job");
    let history = outcome.table.provenance();
    assert_eq!((history.optimizer.as_str(), history.seed), ("gaussian", 17));
    for (name, value) in [("steps", "30"), ("sigma", "1")] {
        assert!(history.parameters.contains(&(name.into(), value.into())));
    }
    assert_eq!(history.twins.len(), 6);
    for figures in &history.figures {
        let twin = |t: &Twin| figures.subject == format!("twin {t}");
        let is_seen = history.twins.iter().any(twin);
        assert_eq!(figures.seen, is_seen, "{}", figures.subject);
        assert!(is_seen || figures.points >= 50_000, "{}", figures.subject);
    }
    let mut subjects = history.figures.iter().map(|f| &f.subject);
    assert!(subjects.any(|subject| subject.starts_with("window")));
    assert_eq!(outcome.accepted, outcome.complaints.is_empty());
    let back = Table::from_bytes(&outcome.table.to_bytes());
    assert_eq!(back, Ok(outcome.table));
}

#[test]
fn every_step_is_reported_and_can_be_the_last() {
    let optimizing = [0, 5, 11].map(|step| (Stage::Optimizing, step));
    for (stage, step) in optimizing.into_iter().chain([(Stage::Measuring, 2)]) {
        let stopper = Stopper::new(stage, step);
        let outcome = forge(&job(12), &stopper).expect("a good job");
        assert!(outcome.interrupted && !outcome.accepted, "{stage:?} {step}");
        let history = outcome.table.provenance();
        assert!(history.figures.is_empty());
        assert!(Table::from_bytes(&outcome.table.to_bytes()).is_ok());
        let reported = stopper.seen.into_inner().expect("no panic");
        let optimizing = reported.iter().filter(|p| p.stage == Stage::Optimizing);
        assert!(optimizing.clone().all(|p| p.steps == 12));
        let last = if stage == Stage::Optimizing { step } else { 12 };
        assert!(optimizing.map(|p| p.step).eq(0..=last));
        let stopped_after = ("stopped_after".into(), step.to_string());
        let says_so = history.parameters.contains(&stopped_after);
        assert_eq!(says_so, stage == Stage::Optimizing);
    }
}

#[test]
fn the_smallest_jobs_work() {
    for alpha in ["1.11", "1.95", "183/112", "sqrt(2)"] {
        let job = Job {
            radius: 1,
            alpha: of(alpha),
            ..job(1)
        };
        let outcome = forge(&job, &()).expect("a good job");
        assert!(!outcome.accepted, "{alpha}");
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
        (|job| job.alpha = of("sqrt(3)"), "sqrt(3)"),
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
