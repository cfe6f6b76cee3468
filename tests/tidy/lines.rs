//! How much there is to hold in one's head: the lines of each part, and the most that it may have.
//!
//! A ceiling only falls: a feature pays for itself by what it merges. `just lines` prints the table. Lines are all lines
//! of the files of a part, its tests, benches and examples too; generated code is not counted.

use std::path::Path;

use super::files;

/// A part, the endings of its files, and the most lines that it may have.
const CEILINGS: &[(&str, &[&str], usize)] = &[
    ("src", &["rs"], 22_144),
    ("crates/catalog", &["rs"], 4949),
    ("crates/config", &["rs"], 1560),
    ("crates/core", &["rs"], 54_849),
    ("crates/encode", &["rs"], 8259),
    ("crates/error", &["rs"], 985),
    ("crates/forge", &["rs"], 20_766),
    ("crates/pages", &["rs"], 439),
    ("crates/plan", &["rs"], 4170),
    ("crates/proto", &["rs"], 343),
    ("crates/query", &["rs"], 8738),
    ("crates/raster", &["rs"], 2976),
    ("crates/service", &["rs"], 5977),
    ("crates/testkit", &["rs"], 1197),
    ("tests", &["rs", "py"], 32_168),
    ("engines", &["rs", "py", "gd", "cs", "c"], 3894),
    ("fuzz", &["rs"], 747),
    ("benches", &["rs", "py"], 2949),
    ("page", &["js", "css", "html", "rs", "glsl"], 16_872),
    (
        "bindings",
        &["py", "pyi", "js", "mjs", "ts", "rs", "c", "h", "hpp", "cpp"],
        14_141,
    ),
];

#[test]
fn no_part_outgrows_its_ceiling() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut outgrown = vec![];
    println!(
        "{:24} {:>7} {:>7} {:>6}",
        "part", "lines", "ceiling", "files"
    );
    for &(part, endings, ceiling) in CEILINGS {
        let found = files(&root.join(part), endings);
        let lines: usize = found.iter().map(|(_, text)| text.lines().count()).sum();
        println!("{part:24} {lines:7} {ceiling:7} {:6}", found.len());
        if lines > ceiling {
            outgrown.push(format!(
                "{part} has {lines} lines; its ceiling is {ceiling}"
            ));
        }
    }
    assert!(outgrown.is_empty(), "{outgrown:#?}");
}
