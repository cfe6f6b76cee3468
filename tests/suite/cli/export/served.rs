//! An export behind a static server: the requests it answers, those it refuses, and the shares of levels.

use std::{fs, io::Read as _};

use strew_testkit::http1::{self, Answer};

use super::{WORLDS, exported, serve, settings};
use crate::support::{
    command::{errors, run},
    daemon::Daemon,
};

fn assert_alike(one: &Answer, other: &Answer, path: &str) {
    assert_eq!((one.status, other.status), (200, 200), "{path}");
    assert!(one.body == other.body, "{path}: other bytes");
    for name in ["content-type", "strew-table", "strew-algorithm"] {
        assert_eq!(one.header(name), other.header(name), "{path}: {name}");
    }
    let optional = |answer: &Answer, name: &str| answer.headers.get(name).cloned();
    for name in ["strew-world", "strew-columns"] {
        assert_eq!(optional(one, name), optional(other, name), "{path}: {name}");
    }
}

#[test]
fn a_static_server_answers_as_the_daemon() {
    let (folder, file) = settings(WORLDS);
    let daemon = Daemon::with_config(WORLDS);
    let world = folder.path().join("world");
    let out = world.display().to_string();
    let flags = [
        "--config",
        &file,
        "--world",
        "forest",
        "--bbox=-16,0,32,32",
        "--chunk=16",
        "--levels=2",
    ];
    exported(&[&flags[..], &["--format", "json", "-o", &out]].concat());
    let Some(nginx) = serve(&world) else { return };
    let get = |address, path: &str| http1::get(address, path, &[]);
    let chunks = [
        ("16/-1/0", ""),
        ("16/1/1", ""),
        ("32/-1/0", "&lod=0.25"),
        ("32/0/0", "&lod=0.25"),
    ];
    for (chunk, lod) in chunks {
        let path = format!("/v1/worlds/forest/chunks/{chunk}?format=json{lod}");
        let (there, here) = (get(daemon.address(), &path), get(nginx.address, &path));
        assert_alike(&there, &here, &path);
        assert!(here.text().contains("\"rock\""), "{}", here.text());
        let packed = http1::get(nginx.address, &path, &[("accept-encoding", "gzip")]);
        assert_eq!(packed.header("content-encoding"), "gzip");
        let mut plain = vec![];
        flate2::read::GzDecoder::new(&*packed.body)
            .read_to_end(&mut plain)
            .expect("gzip");
        assert!(plain == there.body, "{path}");
    }
    let document = |address| get(address, "/v1/worlds/forest");
    assert!(document(nginx.address).body == document(daemon.address()).body);
    let digest = document(nginx.address).json()["digest"]
        .as_str()
        .expect("text")
        .to_owned();
    let pinned = format!("/v1/worlds/forest/chunks/16/0/0?world_digest={digest}&format=json");
    let (there, here) = (get(daemon.address(), &pinned), get(nginx.address, &pinned));
    assert_alike(&there, &here, &pinned);
    assert_eq!(here.header("cache-control"), there.header("cache-control"));
    for address in [daemon.address(), nginx.address] {
        let answer = http1::get(address, &pinned, &[("origin", "https://a.example")]);
        assert_eq!(answer.header("access-control-allow-origin"), "*");
    }
    // Requests that need another answer get none.
    for other in [
        "16/0/0?format=json&seed=8",
        "16/0/0?format=csv",
        "32/0/0?format=json",
        "32/0/0?format=json&lod=0.5",
        "16/7/7?format=json",
    ] {
        let path = format!("/v1/worlds/forest/chunks/{other}");
        assert_eq!(get(nginx.address, &path).status, 404, "{path}");
    }
}

#[test]
fn sets_without_a_world_are_served_under_their_parameters() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let world = folder.path().join("world");
    let out = world.display().to_string();
    let daemon = Daemon::built_in();
    let set = [
        "--spacing=1.5",
        "--seed=7",
        "--attributes=angle,variant",
        "--variants=oak:3,birch:1",
    ];
    let flags = [
        "--bbox=0,0,32,16",
        "--chunk=16",
        "--levels=2",
        "--format=f32",
        "-o",
        &out,
    ];
    exported(&[&set[..], &flags].concat());
    let Some(nginx) = serve(&world) else { return };
    let query = "spacing=1.5&seed=7&attributes=angle,variant&variants=oak:3,birch:1&format=f32";
    let manifest = fs::read(world.join("manifest.json")).expect("written");
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).expect("JSON");
    for (level, chunk) in [(0, "16/1/0"), (1, "32/0/0")] {
        let query = manifest["export"]["levels"][level]["query"]
            .as_str()
            .expect("text");
        let path = format!("/v1/chunks/{chunk}?{query}");
        let there = http1::get(daemon.address(), &path, &[]);
        assert_alike(&there, &http1::get(nginx.address, &path, &[]), &path);
        assert!(there.body.len() > 12 * 8);
        // Without one of its parameters an address has other points, or another form.
        let pairs: Vec<&str> = query.split('&').collect();
        for k in 0..pairs.len() {
            let mut others = pairs.clone();
            let missing = others.remove(k);
            let path = format!("/v1/chunks/{chunk}?{}", others.join("&"));
            let answer = http1::get(nginx.address, &path, &[]);
            assert_eq!(answer.status, 404, "{path} without {missing}");
        }
        let path = format!("/v1/chunks/{chunk}");
        assert_eq!(http1::get(nginx.address, &path, &[]).status, 404, "{path}");
    }
    let mut words: Vec<&str> = query.split('&').collect();
    let written = manifest["export"]["levels"][0]["query"]
        .as_str()
        .expect("text");
    let mut ours: Vec<&str> = written.split('&').collect();
    words.sort_unstable();
    ours.sort_unstable();
    assert_eq!(ours, words);
}

#[test]
fn a_coarser_level_has_a_part_of_the_points_of_a_finer_one() {
    let (_folder, file) = settings(WORLDS);
    let of = |lod: &str| {
        let chunk = [
            "sample",
            "-q",
            "--chunk=64/0/0",
            "--format=csv",
            "--world=forest",
            "--config",
            &file,
        ];
        let output = run(&[&chunk[..], &["--lod", lod]].concat(), "");
        assert!(output.status.success(), "{}", errors(&output));
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        text.lines()
            .skip(1)
            .map(Into::into)
            .collect::<Vec<String>>()
    };
    let (all, quarter) = (of("1"), of("0.25"));
    assert!(quarter.iter().all(|point| all.contains(point)));
    let share = quarter.len() as f64 / all.len() as f64;
    assert!((0.2..0.3).contains(&share), "{share}");
}

#[test]
fn levels_have_a_quarter_of_the_common_share_each() {
    let (folder, file) = settings(WORLDS);
    let thin = fs::read_to_string(&file).expect("readable")
        + "[worlds.thin]\nlod = 0.5\n"
        + &WORLDS.replace("worlds.forest", "worlds.thin");
    fs::write(&file, thin).expect("writable");
    let shape = [
        "--bbox=0,0,128,128",
        "--chunk=64",
        "--levels=3",
        "--format=f32",
        "--config",
        &file,
    ];
    for (k, flags) in [&["--world=forest", "--lod=0.5"][..], &["--world=thin"]]
        .iter()
        .enumerate()
    {
        let out = folder.path().join(format!("world{k}"));
        exported(&[flags, &shape[..], &["-o", &out.display().to_string()]].concat());
        let manifest = fs::read(out.join("manifest.json")).expect("written");
        let manifest: serde_json::Value = serde_json::from_slice(&manifest).expect("JSON");
        let levels = manifest["export"]["levels"].as_array().expect("levels");
        let lods: Vec<f64> = levels
            .iter()
            .map(|level| level["lod"].as_f64().expect("a number"))
            .collect();
        assert_eq!(lods, [0.5, 0.125, 0.03125], "{flags:?}");
        // Levels 0 and 1 have the same area.
        let points = |k: usize| manifest["levels"][k]["points"].as_f64().expect("a number");
        let ratio = points(1) / points(0);
        assert!((0.22..0.28).contains(&ratio), "{flags:?}: {ratio}");
    }
}
