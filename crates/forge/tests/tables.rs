//! The shipped tables, judged again on twins and windows that their makers never saw. One of them
//! is made again, bit for bit.

mod shipped;

use rayon::prelude::*;
use strew_core::{Alpha, PointSet, Table, Twin, table::Figures};
use strew_forge::{
    Figure, Job, Profile, Target,
    energy::{Cell, Lloyd},
    forge,
    judge::{Bound, RING_WIDTH, complaints, curve_figures, figures},
    measure::{Sample, Spectrum, square_set, twin_set, window_set},
};

const DEFAULT: &str = "(5-sqrt(3))/2";

/// The figures of a set up to ν = 1.5; beside a curve up to ν = 4, with the mean power for ν from 0.1 to 0.2.
fn measured(subject: String, set: &Sample, target: Option<&Target>) -> Figures {
    let spectrum = Spectrum::of(set, target.map_or(1.5, |_| 4.0));
    let mut all = figures(subject, false, set, &spectrum, RING_WIDTH);
    if let Some(target) = target {
        all.values.extend(curve_figures(&spectrum, target));
        let long = spectrum.rings(0.1)[1].power;
        all.values.push(("long_waves".into(), long));
    }
    all
}

fn on_twins(table: &Table, twins: Vec<Twin>, target: Option<&Target>) -> Vec<Figures> {
    let measure = |twin: Twin| {
        let set = twin_set(table, twin).expect("a twin");
        measured(format!("twin {twin}"), &set, target)
    };
    twins.into_par_iter().map(measure).collect()
}

/// Windows of the unbounded pattern that neither the optimizer nor the judge of the table saw.
fn on_windows(table: &Table, target: Option<&Target>) -> Vec<Figures> {
    let measure = |seed| {
        let set = window_set(table, 75_000, seed);
        measured(format!("window {seed}"), &set, target)
    };
    (100..103).map(measure).collect()
}

/// Twins of 50,000 to `most` points that the table was not optimized on.
fn large_twins(table: &Table, most: u64) -> impl Iterator<Item = Twin> {
    let seen = &table.provenance().twins;
    let twins = table.map().twins();
    let twins = twins.take_while(move |twin| twin.points() < most);
    twins.filter(|twin| twin.points() >= 50_000 && !seen.contains(twin))
}

/// Figures on up to `most` twins that the judge did not see either, and on windows.
fn unseen(table: &Table, most: usize) -> Vec<Figures> {
    let judged = table.provenance().figures.iter().map(|f| f.subject.clone());
    let judged: Vec<String> = judged.collect();
    let twins = large_twins(table, 200_000);
    let unseen = twins.filter(|twin| !judged.contains(&format!("twin {twin}")));
    let mut all = on_twins(table, unseen.take(most).collect(), None);
    assert!(all.len() >= most.min(6), "{}", table.alpha());
    all.extend(on_windows(table, None));
    all
}

fn hold(table: &Table, figures: &[Figures], bounds: &[Bound]) {
    let wrong = complaints(bounds, figures);
    let (profile, alpha) = (table.profile(), table.alpha());
    assert!(wrong.is_empty(), "{profile} {alpha}: {wrong:#?}");
}

const BLUE: [Bound; 4] = [
    Bound::at_most(Figure::LowPower, 1e-5),
    Bound::at_least(Figure::DeltaMin, 0.62),
    Bound::at_least(Figure::DeltaAvg, 0.8),
    Bound::at_most(Figure::PeakPower, 2.4),
];
/// Crisper than BNOT.
const SHARP: [Bound; 5] = [
    Bound::at_least(Figure::NuEff, 0.93),
    Bound::at_most(Figure::LowPower, 1e-5),
    Bound::at_least(Figure::DeltaMin, 0.8),
    Bound::at_most(Figure::AreaDeviation, 0.1),
    Bound::at_most(Figure::LargestHole, 0.75),
];
/// Neither close pairs nor wide holes.
const SPACED: [Bound; 3] = [
    Bound::at_least(Figure::DeltaMin, 0.93),
    Bound::at_most(Figure::LowPower, 5e-3),
    Bound::at_most(Figure::LargestHole, 0.85),
];

#[test]
fn small_maps_are_good_on_unseen_twins_and_windows() {
    let all = [DEFAULT, "sqrt(3)", "(1+sqrt(5))/2"];
    for (profile, alphas, twins, bounds) in [
        ("blue", &all[..], 12, &BLUE[..]),
        ("sharp", &all[..1], 6, &SHARP),
        ("spaced", &all, 3, &SPACED),
    ] {
        for alpha in alphas {
            let table = shipped::table(profile, alpha, 49);
            hold(&table, &unseen(&table, twins), bounds);
        }
    }
}

#[test]
fn larger_maps_are_as_good_on_windows_and_unseen_twins() {
    for (profile, bounds) in [("blue", &BLUE[..]), ("spaced", &SPACED)] {
        for radius in [100, 200] {
            let table = shipped::table(profile, DEFAULT, radius);
            // Large maps have few twins, and the judge saw the smaller ones.
            let twins = large_twins(&table, 500_000).take(1).collect();
            let mut all = on_twins(&table, twins, None);
            assert_eq!(all.len(), 1);
            all.extend(on_windows(&table, None));
            hold(&table, &all, bounds);
        }
    }
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
    let between = (1..5).map(|part| part * last / 5);
    let places = [0, 1].into_iter().chain(between).chain([last - 1, last]);
    places.map(|at| large[at]).collect()
}

#[test]
fn tables_follow_their_curves_on_far_twins_and_windows_and_as_they_are_served() {
    let curves = Profile::ALL.iter().filter_map(|p| Some((p, p.target()?)));
    for (profile, target) in curves {
        let (table, target) = (shipped::table(profile.name, DEFAULT, 49), Some(&target));
        let mut all = on_twins(&table, far_and_near(&table), target);
        all.extend(on_windows(&table, target));
        // 300² mean spacings with the warp on, away from the origin.
        all.extend([3, 4].map(|seed| {
            let set = PointSet::new(table.clone()).seed(seed);
            let set = square_set(&set, [1000.0 * seed as f64; 2], 300.0, 1.0);
            measured(format!("seed {seed}"), &set.expect("near"), target)
        }));
        hold(&table, &all, profile.bounds);
        let long = |figures: &Figures| figures.value("long_waves").expect("measured");
        assert!(profile.name != "pink" || all.iter().all(|figures| long(figures) >= 4.0));
    }
}

#[test]
fn an_impossible_curve_is_refused_with_its_error() {
    // No power up to ν = 1.2: no set has so few close pairs.
    let target: Target = "0 0\n1.2 0\n1.2 1".parse().expect("valid");
    let alpha: Alpha = DEFAULT.parse().expect("valid");
    let job = |profile: &str| Job {
        radius: 15,
        profile: profile.into(),
        target: Some(target.clone()),
        steps: Some(30),
        ..Job::new(alpha)
    };
    let outcome = forge(&job("mine"), &()).expect("a good job");
    assert!(!outcome.accepted);
    let complaints = outcome.complaints.iter().map(|c| format!("{c}; "));
    let complaints: String = complaints.collect();
    for name in ["target_rms", "target_worst"] {
        assert!(complaints.contains(name), "{complaints}");
    }
    let history = outcome.table.provenance();
    let drawn = ("target".to_owned(), "0 0; 1.2 0; 1.2 1".to_owned());
    assert!(history.parameters.contains(&drawn));
    assert_eq!(outcome.table.profile(), "mine");
    // The name of a known profile is taken.
    let refused = forge(&job("step"), &()).expect_err("refused").to_string();
    assert!(refused.contains("step"), "{refused}");
}

#[test]
fn the_lloyd_table_is_at_rest_on_unseen_twins() {
    let table = shipped::table("lloyd", DEFAULT, 49);
    let twin = large_twins(&table, u64::MAX).find(|twin| twin.points() > 70_000);
    let set = twin_set(&table, twin.expect("endless")).expect("a twin");
    // Points are about as near to the centroids of their cells as a table of this size allows.
    let cells = Lloyd::cells(&set);
    let away = |c: &Cell| (c.first[0] * c.first[0] + c.first[1] * c.first[1]).sqrt() / c.area;
    let mean = cells.iter().map(away).sum::<f64>() / cells.len() as f64;
    assert!(mean < 0.03, "{mean}");
    let bounds = [
        Bound::at_least(Figure::DeltaMin, 0.7),
        Bound::at_most(Figure::LargestHole, 0.8),
    ];
    hold(&table, &unseen(&table, 2), &bounds);
}

#[test]
fn the_pattern_is_undisplaced() {
    let table = shipped::table("pattern", DEFAULT, 49);
    assert!(table.displacements().iter().all(|v| *v == [0, 0]));
}

#[test]
fn a_million_points_are_as_good_as_few() {
    let table = shipped::table("blue", DEFAULT, 49);
    let twin = Twin::new(989 + 1560, 1560).expect("coprime");
    let set = twin_set(&table, twin).expect("a twin");
    assert_eq!(set.points().len(), 978_121);
    let summary = Spectrum::of(&set, 0.6).summary(RING_WIDTH);
    assert!(summary.low_power <= 1e-5, "{summary:?}");
}

#[test]
fn the_default_job_makes_the_shipped_table_again() {
    let table = shipped::table("blue", DEFAULT, 49);
    let outcome = forge(&Job::new(table.alpha()), &()).expect("a good job");
    assert!(outcome.accepted, "{:?}", outcome.complaints);
    assert_eq!(outcome.table.to_bytes(), table.to_bytes());
}
