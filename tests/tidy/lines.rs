//! How much there is to hold in one's head: the lines of each part, and the most that it may have.
//!
//! A ceiling only falls: a feature pays for itself by what it merges. `just lines` prints the table. Lines are all lines
//! of the files of a part, its tests, benches and examples too; generated code is not counted.

use std::path::Path;

use super::files;

/// A part, the endings of its files, and the most lines that it may have.
const CEILINGS: &[(&str, &[&str], usize)] = &[
    ("src", &["rs"], 22_487),
    ("crates/access", &["rs"], 1501),
    ("crates/bevy", &["rs"], 1423),
    ("crates/catalog", &["rs"], 5310),
    ("crates/config", &["rs"], 1891),
    ("crates/core", &["rs"], 54_849),
    ("crates/encode", &["rs"], 8336),
    ("crates/error", &["rs"], 1169),
    ("crates/forge", &["rs"], 20_766),
    ("crates/pages", &["rs"], 728),
    ("crates/plan", &["rs"], 4372),
    ("crates/proto", &["rs"], 343),
    ("crates/query", &["rs"], 9737),
    ("crates/raster", &["rs"], 3206),
    ("crates/service", &["rs"], 4945),
    ("crates/testkit", &["rs"], 1236),
    ("tests", &["rs", "py"], 32_181),
    ("fuzz", &["rs"], 747),
    ("benches", &["rs", "py"], 2950),
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
