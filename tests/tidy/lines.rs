//! How much there is to hold in one's head: the lines of each part, and the most that it may have.
//!
//! A ceiling only falls: a feature pays for itself by what it merges. All lines count but generated ones.

use std::path::Path;

use super::files;

/// A part, the endings of its files, and the most lines that it may have.
const CEILINGS: &[(&str, &[&str], usize)] = &[
    ("src", &["rs"], 21_557),
    ("crates/catalog", &["rs"], 4968),
    ("crates/config", &["rs"], 1557),
    ("crates/core", &["rs"], 48_763),
    ("crates/encode", &["rs"], 8254),
    ("crates/error", &["rs"], 1073),
    ("crates/forge", &["rs"], 15_876),
    ("crates/pages", &["rs"], 439),
    ("crates/plan", &["rs"], 4299),
    ("crates/proto", &["rs"], 337),
    ("crates/query", &["rs"], 8798),
    ("crates/raster", &["rs"], 2976),
    ("crates/service", &["rs"], 5971),
    ("crates/testkit", &["rs"], 1197),
    ("tests", &["rs", "py"], 29_491),
    ("engines", &["rs", "py", "gd", "cs", "c"], 3894),
    ("fuzz", &["rs"], 747),
    ("benches", &["rs", "py"], 2949),
    ("page", &["js", "css", "html", "rs", "glsl"], 12_998),
    (
        "bindings",
        &["py", "pyi", "js", "mjs", "ts", "rs", "c", "h", "hpp", "cpp"],
        13_787,
    ),
];

/// The modules of core and forge, and the most lines of each.
const MODULES: &[(&str, &str)] = &[
    (
        "crates/core/src",
        "attribute 1355 distance 486 field 3664 kernel 3771 lattice 2605 map 1646 near 1580 pattern 1904 \
         periodic 1240 plan 1045 set 732 settle 3304 shape 1808 space 5020 table 3411 walk 3891 warp 1462",
    ),
    (
        "crates/forge/src",
        "curve 678 energy 291 figure 1602 judge 691 mask 564 measure 1881 mix 1626 numeric 247 \
         optimize 1447 profile 623 space 1233",
    ),
];

#[test]
fn no_part_outgrows_its_ceiling() {
    let mut outgrown = vec![];
    let mut check = |part: &str, endings: &[&str], ceiling: usize| {
        let found = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(part), endings);
        let lines: usize = found.iter().map(|(_, text)| text.lines().count()).sum();
        println!("{part:24} {lines:7} {ceiling:7} {:6}", found.len());
        if lines > ceiling {
            outgrown.push(format!("{part} has {lines} lines, not {ceiling}"));
        }
    };
    let parts = CEILINGS.iter();
    parts.for_each(|&(part, endings, ceiling)| check(part, endings, ceiling));
    for (folder, modules) in MODULES {
        let words: Vec<&str> = modules.split(' ').collect();
        for module in words.chunks_exact(2) {
            let ceiling = module[1].parse().expect("a number");
            check(&format!("{folder}/{}", module[0]), &["rs"], ceiling);
        }
    }
    assert!(outgrown.is_empty(), "{outgrown:#?}");
}
