//! The shipped tables that follow a radial power curve: judged again on twins and windows that
//! their makers never saw.

use std::path::PathBuf;

use strew_core::{Alpha, Table, Twin, table::Figures};
use strew_forge::{
    Job, Profile, Target, file_name, forge,
    judge::{complaints, curve_figures, figures_of_torus, figures_of_window},
    measure::{Spectrum, twin_set, window_set},
    read_table,
};

fn alpha() -> Alpha {
    "(5-sqrt(3))/2".parse().expect("valid")
}

fn shipped(profile: &Profile) -> Table {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../tables")
        .join(file_name(profile.name, alpha(), 49));
    read_table(&path).unwrap_or_else(|e| panic!("{e}"))
}

/// All profiles that follow a curve.
fn profiles() -> impl Iterator<Item = (&'static Profile, Target)> {
    Profile::ALL.iter().filter_map(|p| Some((p, p.target()?)))
}

#[test]
fn shipped_tables_follow_their_curves_on_unseen_twins_and_windows() {
    for (profile, target) in profiles() {
        let table = shipped(profile);
        let with = |mut figures: Figures, spectrum: &Spectrum| {
            figures.values.extend(curve_figures(spectrum, &target));
            figures
        };
        let mut all = Vec::new();
        // 70,225 points each or more; none of them is in the forge's own panel.
        for (t, q) in [(265, 418), (329, 519)] {
            let twin = Twin::new(t + q, q).expect("coprime");
            let set = twin_set(&table, twin).expect("a twin");
            let figures = figures_of_torus(format!("twin {twin}"), false, &set, 4.0);
            all.push(with(figures, &Spectrum::of_torus(&set, 4.0)));
        }
        let set = window_set(&table, 75_000, 100);
        let figures = figures_of_window("window".into(), false, &set, 4.0);
        all.push(with(figures, &Spectrum::of_window(&set, 4.0)));
        let wrong = complaints(profile.bounds, &all);
        assert!(wrong.is_empty(), "{}: {wrong:#?}", profile.name);
    }
}

#[test]
fn curves_make_the_same_table_with_any_number_of_threads() {
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let job = Job {
            radius: 12,
            profile: "step".into(),
            steps: Some(6),
            ..Job::new(alpha())
        };
        let outcome = pool.expect("threads").install(|| forge(&job, &()));
        outcome.expect("a good job").table.to_bytes()
    };
    assert_eq!(made(1), made(2));
}

#[test]
fn an_impossible_curve_is_answered_with_how_near_it_came() {
    // A band of nothing around nu 1 and below: no set has so few close pairs.
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
    let said: String = outcome
        .complaints
        .iter()
        .map(|c| format!("{c}; "))
        .collect();
    assert!(
        said.contains("target_rms") && said.contains("target_worst"),
        "{said}"
    );
    let history = outcome.table.provenance();
    let drawn = ("target".to_owned(), "0 0; 1.2 0; 1.2 1".to_owned());
    assert!(history.parameters.contains(&drawn));
    assert_eq!(outcome.table.profile(), "mine");
    // The name of a known profile is taken.
    let refused = forge(&job("step"), &()).expect_err("refused").to_string();
    assert!(refused.contains("step"), "{refused}");
}
