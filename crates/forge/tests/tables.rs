//! The shipped tables, judged again on twins and windows that their makers never saw. One of them
//! is made again, bit for bit.

mod shipped;

use strew_core::{Table, Twin, table::Figures};
use strew_forge::{
    Figure, Job,
    energy::{Cell, Lloyd},
    forge,
    judge::{Bound, RING_WIDTH, complaints, figures},
    measure::{Sample, Spectrum, twin_set, window_set},
};

const DEFAULT: &str = "(5-sqrt(3))/2";

/// Figures, up to ν = 1.5, on up to `most` twins and on windows that neither the optimizer nor the
/// judge of the table saw.
fn unseen(table: &Table, most: usize) -> Vec<Figures> {
    let judged = table.provenance().figures.iter().map(|f| f.subject.clone());
    let judged: Vec<String> = judged.collect();
    let twins = large_twins(table, 200_000);
    let unseen = twins.filter(|twin| !judged.contains(&format!("twin {twin}")));
    let mut all = on_twins(table, unseen.take(most));
    assert!(all.len() >= most.min(6), "{}", table.alpha());
    all.extend(on_windows(table));
    all
}

/// Twins of 50,000 to `most` points that the table was not optimized on.
fn large_twins(table: &Table, most: u64) -> impl Iterator<Item = Twin> {
    let seen = &table.provenance().twins;
    let twins = table
        .map()
        .twins()
        .take_while(move |twin| twin.points() < most);
    twins.filter(|twin| twin.points() >= 50_000 && !seen.contains(twin))
}

fn measured(subject: String, set: &Sample) -> Figures {
    figures(subject, false, set, &Spectrum::of(set, 1.5), RING_WIDTH)
}

fn on_twins(table: &Table, twins: impl Iterator<Item = Twin>) -> Vec<Figures> {
    let measure = |twin: Twin| {
        let set = twin_set(table, twin).expect("a twin");
        measured(twin.to_string(), &set)
    };
    twins.map(measure).collect()
}

fn on_windows(table: &Table) -> Vec<Figures> {
    let measure = |seed| {
        let set = window_set(table, 70_000, seed);
        measured(format!("window {seed}"), &set)
    };
    (100..103).map(measure).collect()
}

fn hold(table: &Table, figures: &[Figures], bounds: &[Bound]) {
    let complaints = complaints(bounds, figures);
    assert!(
        complaints.is_empty(),
        "{} {}: {complaints:?}",
        table.profile(),
        table.alpha()
    );
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
            let twins = large_twins(&table, 500_000).take(1);
            let mut all = on_twins(&table, twins);
            assert_eq!(all.len(), 1);
            all.extend(on_windows(&table));
            hold(&table, &all, bounds);
        }
    }
}

#[test]
fn the_lloyd_table_is_at_rest_on_unseen_twins() {
    let table = shipped::table("lloyd", DEFAULT, 49);
    let seen = &table.provenance().twins;
    let large = |t: &Twin| t.points() > 70_000 && !seen.contains(t);
    let twin = table.map().twins().find(large).expect("endless");
    let set = twin_set(&table, twin).expect("a twin");
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
