//! Worlds: queries that are described once, in the configuration or a folder.

use std::fs;

use serde_json::{Value, json};
use strew::grpc::proto::{ListWorldsRequest, point_service_client::PointServiceClient};
use strew_testkit::wait::until;

use crate::support::{csv::Csv, daemon::Daemon};

const WORLDS: &str = r#"
[worlds.meadow]
spacing = 1.5
seed = 7
attributes = ["u1"]

[[worlds.forest.layers]]
name = "trees"
spacing = 3
seed = 1
[[worlds.forest.layers]]
name = "rocks"
spacing = 2
seed = 2
clear_of = { trees = 1 }
"#;

#[test]
fn a_world_stands_for_what_a_query_leaves_open() {
    let daemon = Daemon::with_config(WORLDS);
    let text = |path: &str| daemon.get(path).text().to_owned();
    let chunk = "/v1/chunks/16/3/-2?format=csv";
    assert_eq!(
        text(&format!("{chunk}&world=meadow")),
        text(&format!("{chunk}&spacing=1.5&seed=7&attributes=u1"))
    );
    // The query overrides the world; another amount replaces the world's.
    assert_eq!(
        text(&format!("{chunk}&world=meadow&seed=8&density=2")),
        text(&format!("{chunk}&density=2&seed=8&attributes=u1"))
    );
    let layers = json!([
        { "name": "trees", "spacing": 3, "seed": 1 },
        { "name": "rocks", "spacing": 2, "seed": 2, "clear_of": { "trees": 1 } },
    ]);
    let region = json!({ "chunk": { "size": 16, "x": 3, "y": -2 } });
    let whole = json!({ "region": region, "layers": layers, "format": "csv" });
    let whole = Csv::post(&daemon, &whole);
    let forest = daemon.get(&format!("{chunk}&world=forest"));
    assert_eq!(forest.text(), whole.answer.text());
    let body = json!({ "region": region, "world": "forest", "format": "csv" });
    assert_eq!(Csv::post(&daemon, &body).points, whole.points);
    let count = daemon
        .get("/v1/count?bbox=48,-32,64,-16&world=forest")
        .json();
    assert_eq!(count["count"], whole.points.len());
    let body = json!({ "region": region, "world": "forest" });
    let split = daemon.post("/v1/points:split?parts=2", &body).json();
    let parts = split["parts"].as_array().expect("a list").clone();
    let points = parts.iter().flat_map(|part| {
        let mut query = part["query"].clone();
        query["format"] = json!("csv");
        Csv::post(&daemon, &query).points
    });
    assert_eq!(points.collect::<Vec<_>>(), whole.points);
}

#[test]
fn a_chunk_of_a_world_is_that_of_its_layers() {
    let daemon = Daemon::with_config(WORLDS);
    let text = |path: &str| daemon.get(path).text().to_owned();
    let of_world = "/v1/worlds/forest/chunks/16/3/-2?format=csv";
    assert_eq!(
        text(of_world),
        text("/v1/chunks/16/3/-2?world=forest&format=csv")
    );
    // Each layer by itself is in it, and nothing else.
    let [trees, rocks] = ["trees", "rocks"].map(|only| text(&format!("{of_world}&only={only}")));
    let rows = |text: &str| {
        text.lines()
            .skip(1)
            .map(Into::into)
            .collect::<Vec<String>>()
    };
    assert_eq!([rows(&trees), rows(&rocks)].concat(), rows(&text(of_world)));
    assert!(!rows(&trees).is_empty() && !rows(&rocks).is_empty());
    let alone = text("/v1/chunks/16/3/-2?spacing=3&seed=1&format=csv");
    let named: Vec<String> = rows(&alone)
        .iter()
        .map(|row| format!("trees,{row}"))
        .collect();
    assert_eq!(rows(&trees), named);
    // Rocks keep clear of the trees that are not in the answer.
    let count = daemon.get("/v1/count?bbox=48,-32,64,-16&world=forest&only=rocks");
    assert_eq!(count.json()["count"], rows(&rocks).len());
    assert_eq!(count.json()["query"]["only"], "rocks");
    let refused = daemon.get(&format!("{of_world}&only=rock"));
    let fault = &refused.json()["errors"][0];
    assert_eq!(
        (&fault["field"], &fault["allowed"]),
        (&json!("only"), &json!("trees, rocks"))
    );
    assert_eq!(daemon.get("/v1/worlds/forrest/chunks/16/3/-2").status, 404);
}

#[test]
fn pages_of_one_layer_join() {
    let daemon = Daemon::with_config(WORLDS);
    let address = "/v1/worlds/forest/chunks/64/0/0?format=csv&only=rocks";
    let whole = daemon.get(address).text().to_owned();
    let (mut rows, mut cursor) = (vec![], String::new());
    loop {
        let page = daemon.get(&format!("{address}&limit=100{cursor}"));
        rows.extend(page.text().lines().skip(1).map(ToString::to_string));
        match page.headers.contains_key("strew-next") {
            true => cursor = format!("&cursor={}", page.header("strew-next")),
            false => break,
        }
    }
    assert_eq!(rows, whole.lines().skip(1).collect::<Vec<_>>());
    assert!(rows.len() > 200);
    // Another layer has other cursors.
    let other = daemon.get(&format!("{}{cursor}", address.replace("rocks", "trees")));
    assert_eq!(other.status, 400);
}

#[test]
fn a_common_seed_makes_another_world() {
    let daemon = Daemon::with_config(
        "[worlds.forest]\nseed = 5\n[[worlds.forest.layers]]\nname = 'oak'\nspacing = 3\n\
         [[worlds.forest.layers]]\nname = 'elm'\nspacing = 3\n\
         [[worlds.forest.layers]]\nname = 'rock'\nspacing = 3\nseed = 9\n",
    );
    let chunk = |more: &str| {
        let path = format!("/v1/worlds/forest/chunks/32/0/0?{more}");
        let answer = daemon.get(&path).json();
        let seeds = answer["query"]["layers"]
            .as_array()
            .expect("layers")
            .clone();
        let seeds: Vec<u64> = seeds
            .iter()
            .map(|l| l["seed"].as_u64().expect("a seed"))
            .collect();
        (seeds, answer["points"].clone())
    };
    let (five, points) = chunk("");
    assert!(five[0] != five[1] && five[2] == 9, "{five:?}");
    assert_eq!(chunk("seed=5").1, points);
    let (six, others) = chunk("seed=6");
    assert!(six[0] != five[0] && six[2] == 9 && others != points);
    // The seeds that the echo shows have the same points by themselves.
    let alone = daemon.get(&format!("/v1/chunks/32/0/0?spacing=3&seed={}", five[0]));
    let ids = |points: &serde_json::Value, layer: Option<&str>| {
        let all = points.as_array().expect("points").iter();
        let of_layer = all.filter(|p| layer.is_none_or(|layer| p["layer"] == layer));
        of_layer.map(|p| p["id"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(
        ids(&alone.json()["points"], None),
        ids(&points, Some("oak"))
    );
}

#[test]
fn a_pinned_world_is_refused_by_a_daemon_that_has_another() {
    let daemon = Daemon::with_config(WORLDS);
    let address = "/v1/worlds/forest/chunks/16/3/-2?format=csv";
    let answer = daemon.get(address);
    let digest = answer.header("strew-world");
    let pinned = format!("{address}&world_digest={digest}");
    let kept = daemon.get(&pinned);
    assert_eq!(kept.text(), answer.text());
    assert!(kept.header("cache-control").contains("immutable"));
    assert!(!answer.header("cache-control").contains("immutable"));
    // The digest does not pin settings that a server could change.
    let own = daemon.get(&format!("{pinned}&seed=4"));
    assert!(own.header("cache-control").contains("immutable"));
    let other = Daemon::with_config(&WORLDS.replace("spacing = 3", "spacing = 4"));
    let refused = other.get(&pinned);
    assert_eq!(refused.status, 409, "{}", refused.text());
    assert_eq!(refused.json()["type"], "urn:strew:problem:other-world");
    assert_ne!(other.get(address).header("etag"), answer.header("etag"));
    let alone = daemon.get(&format!(
        "/v1/points?bbox=0,0,1,1&spacing=1&world_digest={digest}"
    ));
    assert_eq!(alone.json()["errors"][0]["field"], "world_digest");
}

#[test]
fn worlds_are_read_again_and_a_wrong_one_replaces_none() {
    let daemon = Daemon::with_config(WORLDS);
    let file = daemon.folder().join("strew.toml");
    let names = || {
        let list = daemon.get("/v1/worlds").json();
        let worlds = list["worlds"].as_array().expect("a list").clone();
        let name = |world: &serde_json::Value| {
            let [name, digest] = ["name", "digest"].map(|m| world[m].as_str().expect("text"));
            (name.to_owned(), digest.to_owned())
        };
        worlds.iter().map(name).collect::<Vec<_>>()
    };
    let before = names();
    let text = WORLDS.replace("spacing = 1.5", "spacing = 2.5");
    fs::write(&file, format!("{text}\n[worlds.new]\ndensity = 1\n")).expect("writable");
    daemon.signal("HUP");
    until("there is a new world", || names().len() == 3);
    let after = names();
    assert_eq!(after[0], before[0], "the forest is as before");
    assert_ne!(after[1], before[1], "the meadow is another");
    // Wrong ones do not replace good ones; the new one is gone.
    let wrong = text.replace("spacing = 2.5", "spacing = -1");
    fs::write(&file, wrong).expect("writable");
    daemon.signal("HUP");
    until("the new world is gone", || names().len() == 2);
    assert_eq!(names(), after[..2]);
    assert_eq!(daemon.get("/v1/worlds/meadow/chunks/9/0/0").status, 200);
    // A file that is no TOML changes nothing.
    fs::write(&file, "[worlds").expect("writable");
    daemon.signal("HUP");
    fs::write(daemon.folder().join("c.strew"), "no table").expect("writable");
    assert_eq!(names(), after[..2]);
}

#[test]
fn a_folder_has_worlds_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("writable");
    };
    write("dunes.toml", "spacing = 2\nseed = 3");
    write("reef.json", r#"{ "density": 0.5, "seed": 4 }"#);
    write("notes.txt", "no world");
    let setting = format!("worlds.folder={}", folder.path().display());
    let daemon = Daemon::start(&[&setting, "reload.watch_seconds=0.05"]);
    let text = |path: &str| daemon.get(path).text().to_owned();
    assert_eq!(
        text("/v1/worlds/reef/chunks/16/0/0?format=csv"),
        text("/v1/chunks/16/0/0?density=0.5&seed=4&format=csv")
    );
    write("dunes.toml", "spacing = 3\nseed = 3");
    let wanted = text("/v1/chunks/16/0/0?spacing=3&seed=3&format=csv");
    until("the file is noticed", || {
        text("/v1/worlds/dunes/chunks/16/0/0?format=csv") == wanted
    });
}

#[test]
fn settings_decide_so_caches_ask_again() {
    let daemon = Daemon::with_config(WORLDS);
    let address = "/v1/points?bbox=0,0,9,9&world=meadow&format=csv";
    let answer = daemon.get(address);
    let digest = answer.header("strew-table");
    let pinned = daemon.get(&format!("{address}&table={digest}"));
    assert!(!pinned.header("cache-control").contains("immutable"));
    let other = Daemon::with_config(&WORLDS.replace("1.5", "1.6"));
    assert_ne!(other.get(address).header("etag"), answer.header("etag"));
}

#[tokio::test]
async fn worlds_are_listed_by_grpc_too() {
    let daemon = Daemon::with_config(WORLDS);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let list = client.list_worlds(ListWorldsRequest {}).await;
    let worlds = list.expect("a list").into_inner().worlds;
    assert_eq!(worlds.len(), 2);
    for world in worlds {
        let one = daemon.get(&format!("/v1/worlds/{}", world.name)).json();
        assert_eq!(one["digest"], world.digest);
        assert_eq!(one["layers"], json!(world.layers));
        let query: Value = serde_json::from_str(&world.query).expect("JSON");
        assert_eq!(one["query"], query);
    }
}

#[test]
fn worlds_are_listed_and_unknown_ones_refused() {
    let daemon = Daemon::with_config(WORLDS);
    let list = daemon.get("/v1/worlds").json();
    let names: Vec<&str> = (list["worlds"].as_array().expect("a list").iter())
        .map(|world| world["name"].as_str().expect("text"))
        .collect();
    assert_eq!(names, ["forest", "meadow"]);
    assert_eq!(list["worlds"][0]["layers"], json!(["trees", "rocks"]));
    let one = daemon.get("/v1/worlds/meadow").json();
    assert_eq!(one["query"]["spacing"], 1.5);
    assert_eq!(one["digest"], list["worlds"][1]["digest"]);
    let refused = daemon.get("/v1/points?bbox=0,0,9,9&world=medow");
    assert_eq!(refused.status, 400);
    let fault = &refused.json()["errors"][0];
    assert_eq!(fault["detail"], "unknown world; did you mean `meadow`?");
    assert_eq!(fault["allowed"], "forest, meadow");
    // Layers have all else of their own.
    let refused = daemon.get("/v1/points?bbox=0,0,9,9&world=forest&warp=off");
    assert_eq!(refused.json()["errors"][0]["field"], "warp");
}

#[test]
fn what_a_world_leaves_out_stays_out() {
    let daemon = Daemon::with_config(
        "[except.felled]\nids = ['2:-1']\n[worlds.wood]\nspacing = 1\nexcept = ['felled']\n\
         [worlds.tile]\nspacing = 1\nmap = 's'\nperiodic = 2000\n",
    );
    let ids = |more: &str| {
        let answer = daemon.get(&format!("/v1/points?bbox=0,0,3,2&format=csv&{more}"));
        assert_eq!(answer.status, 200, "{more}: {}", answer.text());
        let id = |line: &str| line.split(',').next().unwrap_or_default().to_owned();
        answer.text().lines().skip(1).map(id).collect::<Vec<_>>()
    };
    let all = ids("spacing=1");
    let without = |gone: &[&str]| {
        let left = all.iter().filter(|id| !gone.contains(&id.as_str()));
        left.cloned().collect::<Vec<_>>()
    };
    assert!(all.contains(&"2:-1".into()) && all.contains(&"8:-1".into()));
    assert_eq!(ids("world=wood"), without(&["2:-1"]));
    // A request adds to what the world leaves out.
    assert_eq!(ids("world=wood&except=8:-1"), without(&["2:-1", "8:-1"]));
    // Points that `keep` leaves out anyway may be excepted.
    for id in &all {
        ids(&format!("spacing=1&keep=0.3&except={id}"));
    }
    let refused = daemon.get("/v1/worlds/tile/chunks/8/0/0");
    assert_eq!(refused.status, 400, "{}", refused.text());
    assert_eq!(refused.json()["errors"][0]["field"], "world");
    assert_eq!(daemon.get("/v1/count?world=tile").status, 200);
    let wrong = daemon.get("/v1/count?bbox=0,0,1,1&world=wood&world_digest=zz");
    assert_eq!(wrong.status, 400, "{}", wrong.text());
    assert_eq!(wrong.json()["errors"][0]["detail"], "not a digest");
}
