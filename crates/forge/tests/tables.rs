//! The tables that ship: judged again, on twins and windows that their makers never saw, and made
//! again, bit by bit.

use std::path::PathBuf;

use strew_core::{Table, Twin};
use strew_forge::{
    Job, file_name, forge,
    judge::{RING_WIDTH, figures_of_torus, figures_of_window},
    measure::{Spectrum, twin_set, window_set},
    read_table,
};

fn shipped(alpha: &str) -> Table {
    let name = file_name("blue", alpha.parse().expect("valid"), 49);
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../tables")
        .join(name);
    read_table(&path).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn shipped_tables_are_good_on_unseen_twins_and_windows() {
    for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"] {
        let table = shipped(alpha);
        let seen = &table.provenance().twins;
        let judged = table.provenance().figures.iter().map(|f| f.subject.clone());
        let judged: Vec<String> = judged.collect();
        let large = |twin: &Twin| (50_000..200_000).contains(&twin.points());
        let twins = table
            .map()
            .twins()
            .take_while(|twin| twin.points() < 200_000);
        let unseen = twins.filter(|twin| {
            large(twin) && !seen.contains(twin) && !judged.contains(&format!("twin {twin}"))
        });
        let mut all = Vec::new();
        for twin in unseen {
            let set = twin_set(&table, twin).expect("a twin");
            all.push(figures_of_torus(twin.to_string(), false, &set, 1.5));
        }
        assert!(all.len() > 5, "{alpha}");
        for seed in 100..103 {
            let set = window_set(&table, 70_000, seed);
            all.push(figures_of_window(
                format!("window {seed}"),
                false,
                &set,
                1.5,
            ));
        }
        for figures in all {
            let value = |name| figures.value(name).expect("measured");
            assert!(value("low_power") <= 1e-5, "{alpha} {figures:?}");
            assert!(value("delta_min") >= 0.62, "{alpha} {figures:?}");
            assert!(value("delta_avg") >= 0.8, "{alpha} {figures:?}");
            assert!(value("peak_power") <= 2.4, "{alpha} {figures:?}");
        }
    }
}

#[test]
fn a_million_points_are_as_good_as_few() {
    let table = shipped("(5-sqrt(3))/2");
    let twin = Twin::new(989 + 1560, 1560).expect("coprime");
    let set = twin_set(&table, twin).expect("a twin");
    assert_eq!(set.points().len(), 978_121);
    let summary = Spectrum::of_torus(&set, 0.6).summary(RING_WIDTH);
    assert!(summary.low_power <= 1e-5, "{summary:?}");
}

#[test]
fn the_default_job_makes_the_shipped_table_again() {
    let table = shipped("(5-sqrt(3))/2");
    let outcome = forge(&Job::new(table.alpha()), &()).expect("a good job");
    assert!(outcome.accepted, "{:?}", outcome.complaints);
    assert_eq!(outcome.table.to_bytes(), table.to_bytes());
}
