//! Figures for any α are well-formed pictures of what they name.

use std::time::Instant;

use strew_core::{Alpha, Table, map::Clusters};
use strew_forge::{
    figure::{self, Drawing, FigureError},
    mask::Mask,
};

const ALPHAS: [&str; 9] = [
    "(5-sqrt(3))/2",
    "sqrt(3)",
    "(1+sqrt(5))/2",
    "3/2",
    "5/3",
    "7/4",
    "1.0001",
    "1.9999",
    "1.37",
];

fn all(alpha: Alpha) -> Result<[(&'static str, Drawing); 4], FigureError> {
    Ok([
        ("index", figure::index(alpha, 40)?),
        (
            "arrangement",
            figure::arrangement(alpha, &[(2, 1), (3, 3)], 40)?,
        ),
        ("clusters", figure::clusters(alpha, 2.24, 16, 40)?),
        ("map", figure::map(alpha, 12, [0, 0])?),
    ])
}

#[test]
fn every_alpha_has_all_figures() {
    for text in ALPHAS {
        let alpha: Alpha = text.parse().expect("valid");
        for (name, drawing) in all(alpha).expect("in range") {
            let svg = drawing.to_svg();
            for bad in ["NaN", "inf", "width=\"-", "height=\"-"] {
                assert!(!svg.contains(bad), "{name} of {text} has {bad}");
            }
            assert!(svg.contains(&format!("α = {alpha}")), "{name} of {text}");
            let count = |mark: &str| svg.matches(mark).count();
            assert_eq!(count("<text"), count("</text>"), "{name} of {text}");
            assert_eq!(count("<"), count(">"), "{name} of {text}");
            assert!(
                svg.len() < 2_000_000,
                "{name} of {text}: {} bytes",
                svg.len()
            );
        }
    }
}

#[test]
fn figures_say_what_they_show() {
    let [alpha, other] = ["sqrt(3)", "(5-sqrt(3))/2"].map(|text| text.parse().expect("valid"));
    let table = Table::undisplaced(other, 49, "pattern").expect("small");
    let mask = Mask::new(&table, 32, 7).expect("in range");
    let clusters = Clusters::new(alpha, 2.0, 16).expect("in range");
    let clusters = figure::found_clusters(&clusters, 2.0, 48);
    assert_eq!(clusters, figure::clusters(alpha, 2.0, 16, 48));
    for (drawing, text) in [
        (figure::index(other, 48), "set region"),
        (
            figure::arrangement(alpha, &[(2, 0), (1, 2)], 40),
            "It occurs",
        ),
        (figure::arrangement(alpha, &[(1, 0)], 40), "It never occurs"),
        (clusters, "4 shapes"),
        (figure::map(other, 20, [3, 8]), "27 × 27 blocks"),
        (Ok(figure::mask_spectrum(&mask)), "Level 1/8"),
    ] {
        let svg = drawing.expect("in range").to_svg();
        assert!(svg.contains(text), "{text}");
    }
    let error = figure::map(alpha, 20, [3, 99]).expect_err("no such block");
    assert_eq!(
        error.to_string(),
        "block is [3, 99]; it must be two integers from 0 to 30"
    );
}

#[test]
fn equal_calls_draw_equal_text() {
    let alpha: Alpha = "sqrt(3)".parse().expect("valid");
    assert_eq!(all(alpha).expect("in range"), all(alpha).expect("in range"));
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let alpha: Alpha = "sqrt(3)".parse().expect("valid");
    let many = vec![(2, 1); 100_000];
    for (result, field) in [
        (figure::index(alpha, 7), "window"),
        (figure::index(alpha, 201), "window"),
        (figure::arrangement(alpha, &many, 40), "offsets"),
        (
            figure::arrangement(alpha, &[(0, i64::MAX)], 40),
            "offsets[0]",
        ),
        (figure::clusters(alpha, 0.0, 16, 40), "distance"),
        (figure::clusters(alpha, 2.0, 1000, 40), "most"),
        (figure::map(alpha, 1_000_000, [0, 0]), "radius"),
        (figure::map(alpha, 20, [1000, 0]), "block"),
    ] {
        assert_eq!(result.expect_err(field).field, field);
    }
}

#[test]
fn the_widest_settings_take_bounded_time() {
    let began = Instant::now();
    for text in ALPHAS {
        let alpha: Alpha = text.parse().expect("valid");
        figure::clusters(alpha, 16.0, 64, 200).expect("in range");
        figure::map(alpha, 200, [0, 0]).expect("in range");
    }
    assert!(began.elapsed().as_secs() < 120, "{:?}", began.elapsed());
}
