//! How much there is to hold in one's head: the lines of each part, and the most that it may have.
//!
//! A ceiling only falls: a feature pays for itself by what it merges. All lines count but generated ones.

use std::path::Path;

use super::files;

/// A part, the endings of its files, and the most lines that it may have.
const CEILINGS: &[(&str, &[&str], usize)] = &[
    ("src", &["rs"], 21_599),
    ("crates/catalog", &["rs"], 5040),
    ("crates/config", &["rs"], 1560),
    ("crates/core", &["rs"], 51_391),
    ("crates/encode", &["rs"], 8258),
    ("crates/error", &["rs"], 1073),
    ("crates/forge", &["rs"], 18_544),
    ("crates/pages", &["rs"], 439),
    ("crates/plan", &["rs"], 4326),
    ("crates/proto", &["rs"], 337),
    ("crates/query", &["rs"], 8795),
    ("crates/raster", &["rs"], 2976),
    ("crates/service", &["rs"], 5975),
    ("crates/testkit", &["rs"], 1197),
    ("tests", &["rs", "py"], 29_503),
    ("engines", &["rs", "py", "gd", "cs", "c"], 3894),
    ("fuzz", &["rs"], 747),
    ("benches", &["rs", "py"], 2949),
    ("page", &["js", "css", "html", "rs", "glsl"], 13_859),
    (
        "bindings",
        &["py", "pyi", "js", "mjs", "ts", "rs", "c", "h", "hpp", "cpp"],
        14_484,
    ),
];

/// The modules of core and forge, and the most lines of each.
const MODULES: &[(&str, &str)] = &[
    (
        "crates/core/src",
        "distance 527 map 1811 pattern 2085 shape 1870 space 5767 table 3612",
    ),
    (
        "crates/core/src/sample",
        "attribute 1442 count 667 field 3871 kernel 3819 lattice 2368 near 1340 \
         periodic 1411 plan 462 set 973 settle 2971 sieve 383 walk 2961 warp 1492",
    ),
    (
        "crates/forge/src",
        "curve 721 energy 443 figure 1917 judge 815 mask 681 measure 2178 mix 1764 \
         numeric 314 optimize 1554 profile 710 space 1490 thinned 234",
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
    for &(part, endings, ceiling) in CEILINGS {
        check(part, endings, ceiling);
    }
    for (folder, modules) in MODULES {
        let words: Vec<&str> = modules.split(' ').collect();
        for module in words.chunks_exact(2) {
            let ceiling = module[1].parse().expect("a number");
            check(&format!("{folder}/{}", module[0]), &["rs"], ceiling);
        }
    }
    assert!(outgrown.is_empty(), "{outgrown:#?}");
}
