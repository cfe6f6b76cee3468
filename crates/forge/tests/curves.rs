//! The shipped tables that follow a radial power curve, judged again on twins and windows that
//! their makers never saw.

mod shipped;

use rayon::prelude::*;
use strew_core::{Alpha, PointSet, Table, Twin, table::Figures};
use strew_forge::{
    Job, Profile, Report, Resolution, Target, forge,
    judge::complaints,
    measure::{Sample, square_set, twin_set, window_set},
};

fn alpha() -> Alpha {
    "(5-sqrt(3))/2".parse().expect("valid")
}

fn table_of(profile: &Profile) -> Table {
    shipped::table(profile.name, "(5-sqrt(3))/2", 49)
}

/// All profiles that follow a curve.
fn profiles() -> impl Iterator<Item = (&'static Profile, Target)> {
    Profile::ALL.iter().filter_map(|p| Some((p, p.target()?)))
}

/// A set beside the curve that it should follow.
fn compared(subject: String, set: &Sample, target: &Target) -> Report {
    Report::of(subject, false, set, Resolution::default()).compared(target)
}

/// Eight of the twins of 65,000 to 200,000 points, which spread over the interval of α that the map
/// serves: the two next to each of its ends, where curves are missed first, and four in between.
fn far_and_near(table: &Table) -> Vec<Twin> {
    let large = table.map().twins().take_while(|t| t.points() <= 200_000);
    let mut large: Vec<Twin> = large.filter(|t| t.points() >= 65_000).collect();
    assert!(large.len() > 30);
    let ratio = |t: &Twin| t.p() as f64 / t.q() as f64;
    large.sort_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    let last = large.len() - 1;
    let places = [
        0,
        1,
        last / 5,
        2 * last / 5,
        3 * last / 5,
        4 * last / 5,
        last - 1,
        last,
    ];
    places.map(|at| large[at]).to_vec()
}

fn on_twins(table: &Table, target: &Target) -> Vec<Report> {
    let measure = |twin: Twin| {
        let set = twin_set(table, twin).expect("a twin");
        compared(format!("twin {twin}"), &set, target)
    };
    far_and_near(table).into_par_iter().map(measure).collect()
}

/// Two windows of the unbounded pattern, and two regions with the warp, as a server returns them.
fn on_windows(table: &Table, target: &Target) -> Vec<Report> {
    let windows =
        [100, 101].map(|seed| (format!("window {seed}"), window_set(table, 75_000, seed)));
    let warped = [3, 4].map(|seed| (format!("warped, seed {seed}"), warped(table, seed)));
    let all = windows.into_iter().chain(warped);
    all.map(|(name, set)| compared(name, &set, target))
        .collect()
}

/// 300² mean spacings with the warp on, away from the origin.
fn warped(table: &Table, seed: u64) -> Sample {
    let set = PointSet::new(table.clone()).seed(seed);
    square_set(&set, [1000.0 * seed as f64; 2], 300.0, 1.0).expect("near")
}

#[test]
fn shipped_tables_follow_their_curves_on_far_twins_and_windows() {
    for (profile, target) in profiles() {
        let table = table_of(profile);
        let mut all = on_twins(&table, &target);
        all.extend(on_windows(&table, &target));
        if profile.name == "pink" {
            // Strong long waves: power of at least 4 in the ring from ν = 0.1 to 0.2.
            for report in &all {
                let ring = report.spectrum.rings(0.1)[1];
                assert!(ring.power >= 4.0, "{}: {ring:?}", report.figures.subject);
            }
        }
        let figures: Vec<Figures> = all.into_iter().map(|report| report.figures).collect();
        let wrong = complaints(profile.bounds, &figures);
        assert!(wrong.is_empty(), "{}: {wrong:#?}", profile.name);
    }
}

#[test]
fn an_impossible_curve_is_refused_with_its_error() {
    // No power up to ν = 1.2: no set has so few close pairs.
    let target: Target = "0 0\n1.2 0\n1.2 1".parse().expect("valid");
    let job = |profile: &str| Job {
        radius: 15,
        profile: profile.into(),
        target: Some(target.clone()),
        steps: Some(30),
        ..Job::new(alpha())
    };
    let outcome = forge(&job("mine"), &()).expect("a good job");
    assert!(!outcome.accepted);
    let complaints: String = outcome
        .complaints
        .iter()
        .map(|c| format!("{c}; "))
        .collect();
    assert!(
        complaints.contains("target_rms") && complaints.contains("target_worst"),
        "{complaints}"
    );
    let history = outcome.table.provenance();
    let drawn = ("target".to_owned(), "0 0; 1.2 0; 1.2 1".to_owned());
    assert!(history.parameters.contains(&drawn));
    assert_eq!(outcome.table.profile(), "mine");
    // The name of a known profile is taken.
    let refused = forge(&job("step"), &()).expect_err("refused").to_string();
    assert!(refused.contains("step"), "{refused}");
}
