//! Levels of detail in an archive: the files of a folder, found by the index.

use std::{collections::BTreeMap, fs};

use super::{WORLDS, exported, number, settings, tree};
use crate::support::command::{errors, run};

/// The content of the members of a stored archive, by name, and the archive's central directory in order.
fn members(archive: &[u8]) -> (Vec<String>, BTreeMap<String, Vec<u8>>) {
    let end = &archive[archive.len() - 22..];
    let (mut at, mut order, mut found) = (number(&end[16..20]) as usize, vec![], BTreeMap::new());
    for _ in 0..number(&end[10..12]) {
        let head = &archive[at..];
        let [length, name, extra, place] =
            [20..24, 28..30, 30..32, 42..46].map(|range| number(&head[range]) as usize);
        let text = String::from_utf8(head[46..46 + name].to_vec()).expect("UTF-8");
        let [own_name, own_extra] =
            [26..28, 28..30].map(|range| number(&archive[place..][range]) as usize);
        let data = place + 30 + own_name + own_extra;
        found.insert(text.clone(), archive[data..data + length].to_vec());
        order.push(text);
        at += 46 + name + extra;
    }
    (order, found)
}

#[test]
fn an_archive_has_all_levels_and_its_index_finds_them() {
    let (folder, file) = settings(WORLDS);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let flags = [
        "--config",
        &file,
        "--world=forest",
        "--bbox=-32,0,64,64",
        "--chunk=16",
        "--levels=3",
        "--format=f32",
    ];
    let (out, archive) = (path("world"), path("world.zip"));
    exported(&[&flags[..], &["-o", &out]].concat());
    exported(&[&flags[..], &["--archive", &archive]].concat());
    exported(&["--check", &archive, "--all", "--config", &file]);
    let files = tree(out.as_ref());
    let (order, members) = members(&fs::read(&archive).expect("written"));
    assert_eq!(order[..2], ["manifest.json", "index.bin"]);
    let world = |all: &BTreeMap<String, Vec<u8>>| -> BTreeMap<String, Vec<u8>> {
        let all = all.iter().filter(|(name, _)| name.starts_with("v1/"));
        all.map(|(name, bytes)| (name.clone(), bytes.clone()))
            .collect()
    };
    // 6 × 4, 3 × 2 and 2 × 1 chunks, and the world's document.
    assert_eq!(world(&files).len(), 24 + 6 + 2 + 1);
    assert!(world(&files) == world(&members));

    let manifest: serde_json::Value =
        serde_json::from_slice(&members["manifest.json"]).expect("JSON");
    let levels = manifest["export"]["levels"].as_array().expect("a list");
    assert_eq!(levels.len(), 3);
    let whole = fs::read(&archive).expect("written");
    let mut entries = members["index.bin"].chunks(16);
    for level in levels {
        let range = |name: &str| {
            let [first, end] = [0, 1].map(|i| level[name][i].as_i64().expect("an integer"));
            first..end
        };
        let size = level["size"].as_f64().expect("a number");
        for (cx, cy) in range("columns").flat_map(|cx| range("rows").map(move |cy| (cx, cy))) {
            let entry = entries.next().expect("an entry of each chunk");
            let [place, length, points] =
                [0..8, 8..12, 12..16].map(|range| number(&entry[range]) as usize);
            let name = format!("v1/worlds/forest/chunks/{size}/{cx}/{cy}");
            assert!(files[&name] == whole[place..place + length], "{name}");
            // Layers add a column to the coordinates.
            assert!(points == 0 || length % points == 0, "{name}");
        }
    }
    assert!(entries.next().is_none());
}

#[test]
fn the_last_line_of_an_archive_says_its_own_size_beside_that_of_its_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let archive = folder.path().join("world.zip").display().to_string();
    let world = "export --bbox 0,0,300,300 --spacing 1 --chunk 64 --format csv --archive";
    let flags: Vec<&str> = world.split(' ').chain([archive.as_str()]).collect();
    let said = errors(&run(&flags, ""));
    let size = fs::metadata(&archive).expect("written").len();
    let last = said.lines().last().expect("a line");
    let end = format!(" bytes in an archive of {size} bytes");
    assert!(last.ends_with(&end), "{said}");
}
