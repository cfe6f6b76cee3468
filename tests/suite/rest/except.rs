//! Excepted points stay away in every region, format and part, and no point appears in their place.

use std::fs;

use serde_json::json;
use strew::grpc::proto::{
    PointSet, StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount,
};
use strew_testkit::{http1, wait::until};

use crate::support::{daemon::Daemon, grpc, problem::assert_fault, sending};

/// The rows of an answer as CSV, without its head.
fn rows(daemon: &Daemon, path: &str) -> Vec<String> {
    let answer = daemon.get(path);
    assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    answer.text().lines().skip(1).map(Into::into).collect()
}

/// The column of ids of rows.
fn id(row: &str, column: usize) -> &str {
    row.split(',').nth(column).expect("an id")
}

/// Every seventh id.
fn some(rows: &[String], column: usize) -> Vec<String> {
    let ids = rows.iter().skip(2).step_by(7);
    ids.map(|row| id(row, column).to_owned()).collect()
}

fn without(rows: &[String], ids: &[String], column: usize) -> Vec<String> {
    let is_left = |row: &&String| !ids.iter().any(|other| other == id(row, column));
    rows.iter().filter(is_left).cloned().collect()
}

#[test]
fn answers_are_those_of_before_without_the_points() {
    let daemon = Daemon::built_in();
    for query in [
        "bbox=-9,3,20,21&spacing=1.5&seed=0",
        "bbox=-9,3,20,21&spacing=1.5&seed=7",
        "bbox=90000000,3,90000020,21&spacing=1.5&seed=7",
        "circle=4,4,11&density=1&seed=3&map=s&profile=step",
        "polygon=0,0,30,4,9,25&spacing=1&keep=0.6&seed=5&map=s",
        "bbox=0,0,40,30&spacing=1&seed=2&field=forest",
        "bbox=0,0,20,20&spacing=1&seed=2&map=s&variants=a:1,b:2&spread=even&only=b",
    ] {
        let address = format!("/v1/points?{query}&format=csv");
        let all = rows(&daemon, &address);
        let gone = some(&all, 0);
        assert!(gone.len() > 10, "{query}: {}", all.len());
        let except = format!("&except={}", gone.join(","));
        let left = without(&all, &gone, 0);
        assert_eq!(
            rows(&daemon, &format!("{address}{except}")),
            left,
            "{query}"
        );
        let count = daemon.get(&format!("/v1/count?{query}{except}")).json();
        assert_eq!(count["count"], left.len(), "{query}");
        // Packed formats announce their length before the first byte.
        let packed = daemon.get(&format!("/v1/points?{query}{except}&format=f64"));
        assert_eq!(packed.body.len(), 16 * left.len(), "{query}");
        let page = rows(&daemon, &format!("{address}{except}&offset=9&limit=20"));
        assert_eq!(page, left[9..29], "{query}");
    }
}

#[test]
fn chunks_parts_and_pages_leave_out_the_same_points() {
    let daemon = Daemon::built_in();
    let set = "spacing=2&seed=7&format=csv";
    for corner in [0_i64, 1 << 40] {
        let chunk = |side: i64, x: i64, y: i64, except: &str| {
            rows(&daemon, &format!("/v1/chunks/{side}/{x}/{y}?{set}{except}"))
        };
        let all = chunk(32, corner, -1, "");
        let gone = some(&all, 0);
        let except = format!("&except={}", gone.join(","));
        let left = without(&all, &gone, 0);
        assert_eq!(chunk(32, corner, -1, &except), left);
        let ids = |rows: &[String]| {
            let mut ids: Vec<String> = rows.iter().map(|row| id(row, 0).to_owned()).collect();
            ids.sort();
            ids
        };
        let quarters = [(0, -2), (1, -2), (0, -1), (1, -1)];
        let parts = quarters.map(|(x, y)| chunk(16, 2 * corner + x, y, &except));
        assert_eq!(ids(&parts.concat()), ids(&left));
        let (mut read, mut cursor) = (vec![], String::new());
        loop {
            let path = format!("/v1/chunks/32/{corner}/-1?{set}{except}&limit=31{cursor}");
            let page = daemon.get(&path);
            read.extend(page.text().lines().skip(1).map(ToString::to_string));
            match page.headers.get("strew-next") {
                Some(next) => cursor = format!("&cursor={next}"),
                None => break,
            }
        }
        assert_eq!(read, left);
    }
    let region = json!({ "chunk": { "size": 32, "x": 0, "y": -1 } });
    let all = rows(&daemon, &format!("/v1/chunks/32/0/-1?{set}"));
    let gone = some(&all, 0);
    let body = json!({ "region": region, "spacing": 2, "seed": 7, "except": gone });
    let split = daemon.post("/v1/points:split?parts=3", &body).json();
    let parts = split["parts"].as_array().expect("parts");
    let points = parts.iter().flat_map(|part| {
        let mut query = part["query"].clone();
        query["format"] = json!("csv");
        let text = daemon.post("/v1/points:query", &query).text().to_owned();
        text.lines()
            .skip(1)
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    });
    assert_eq!(points.collect::<Vec<_>>(), without(&all, &gone, 0));
}

const WORLD: &str = "
[except.felled]
ids = []
[[worlds.forest.layers]]
name = 'trees'
spacing = 3
seed = 1
except = ['felled']
[[worlds.forest.layers]]
name = 'rocks'
spacing = 2
seed = 2
clear_of = { trees = 1.5 }
";
const CHUNK: &str = "/v1/worlds/forest/chunks/32/3/-2?format=csv";

#[test]
fn nothing_appears_where_a_tree_was_felled() {
    let daemon = Daemon::with_config(WORLD);
    let all = rows(&daemon, CHUNK);
    let trees = all.iter().filter(|row| row.starts_with("trees,"));
    let gone = some(&trees.cloned().collect::<Vec<_>>(), 1);
    let tag = daemon.get(CHUNK).header("etag").to_owned();
    let items: Vec<String> = gone.iter().map(|id| format!("trees/{id}")).collect();
    // By the address, by the layer of a body, and by a list that changes while the daemon runs.
    let left = without(&all, &gone, 1);
    assert_eq!(
        rows(&daemon, &format!("{CHUNK}&except={}", items.join(","))),
        left
    );
    let list = serde_json::to_string(&items).expect("JSON");
    let file = daemon.folder().join("strew.toml");
    fs::write(&file, WORLD.replace("ids = []", &format!("ids = {list}"))).expect("writable");
    daemon.signal("HUP");
    until("the list is read", || rows(&daemon, CHUNK) == left);
    assert_ne!(daemon.get(CHUNK).header("etag"), tag);
    let lists = daemon.get("/v1/except").json();
    assert_eq!(lists["lists"][0]["count"], gone.len());
    assert_eq!(lists["lists"][0]["layers"], json!(["trees"]));
    // The rocks alone are as before, too.
    let only = format!("{CHUNK}&only=rocks");
    let is_rock = |row: &&String| row.starts_with("rocks,");
    assert_eq!(
        rows(&daemon, &only),
        left.iter().filter(is_rock).cloned().collect::<Vec<_>>()
    );
    let echo = daemon.get("/v1/worlds/forest/chunks/32/3/-2").json();
    assert_eq!(echo["query"]["layers"][0]["except"], json!(["felled"]));
    assert_eq!(
        echo["query"]["layers"][0]["except_digest"]
            .as_str()
            .map(str::len),
        Some(64)
    );
}

#[test]
fn a_folder_of_lists_is_watched() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |text: &str| fs::write(folder.path().join("dug.txt"), text).expect("writable");
    let setting = format!("except.folder={}", folder.path().display());
    write("# nothing yet\n");
    let daemon = Daemon::start(&[&setting, "reload.watch_seconds=0.05"]);
    let address = "/v1/points?bbox=0,0,9,9&spacing=1&seed=4&format=csv";
    let all = rows(&daemon, address);
    let listed = format!("{address}&except=dug");
    assert_eq!(rows(&daemon, &listed), all);
    // A list that is empty now may have ids later: no cache may keep the answer.
    let table = daemon.get(address).header("strew-table").to_owned();
    let pinned = |address: &str| {
        let answer = daemon.get(&format!("{address}&table={table}"));
        answer.header("cache-control").contains("immutable")
    };
    assert!(pinned(address) && !pinned(&listed));
    let gone = some(&all, 0);
    // Ids that are no points of this set, or are elsewhere, change nothing.
    write(&format!("{}\n\n1:0 # none\n99999:5\n", gone.join("\n")));
    let left = without(&all, &gone, 0);
    until("the list is read", || rows(&daemon, &listed) == left);
    // A wrong list does not replace it.
    write("1:2\nthree\n");
    daemon.signal("HUP");
    fs::write(folder.path().join("new.txt"), "1:2").expect("writable");
    until("the folder is read", || {
        let lists = daemon.get("/v1/except").json();
        lists["lists"].as_array().map(Vec::len) == Some(2)
    });
    assert_eq!(rows(&daemon, &listed), left);
}

/// Sends a list, which must be taken. Returns its digest.
fn sent(daemon: &Daemon, list: &str) -> String {
    let answer = http1::post(daemon.address(), "/v1/except", &[], list.as_bytes());
    assert_eq!(answer.status, 200, "{}", answer.text());
    let held = answer.json();
    assert_eq!(held["name"], held["digest"]);
    held["digest"].as_str().expect("a digest").into()
}

#[tokio::test]
async fn a_list_is_sent_once_and_named_by_its_digest() {
    let daemon = Daemon::built_in();
    let set = "spacing=1&seed=7";
    let address = format!("/v1/points?bbox=0,0,40,40&{set}&format=csv");
    let wide = rows(
        &daemon,
        &format!("/v1/points?bbox=0,0,150,150&{set}&format=csv"),
    );
    let ids: Vec<String> = (wide.iter().step_by(2))
        .map(|row| id(row, 0).into())
        .collect();
    assert!(ids.len() > 10_000, "{}", ids.len());
    let text = ids.join("\n");
    let digest = sent(
        &daemon,
        &format!("# Felled, more than a query has.\n{text}\n"),
    );
    // However it is written, it is the same list, which is held once.
    let lists = [json!({ "ids": ids }).to_string(), format!("\u{feff}{text}")];
    assert_eq!(lists.map(|list| sent(&daemon, &list)), [&*digest, &*digest]);
    let inside = rows(&daemon, &address);
    let inline: Vec<String> = (inside.iter().map(|row| id(row, 0).to_owned()))
        .filter(|id| ids.contains(id))
        .collect();
    let left = rows(&daemon, &format!("{address}&except={}", inline.join(",")));
    assert_eq!(left, without(&inside, &inline, 0));
    let named = format!("{address}&except={digest}");
    assert_eq!(rows(&daemon, &named), left);
    let body = json!({
        "region": { "bbox": [0, 0, 40, 40] }, "spacing": 1, "seed": 7, "except": [digest], "format": "csv",
    });
    let answer = daemon.post("/v1/points:query", &body);
    let lines: Vec<&str> = answer.text().lines().skip(1).collect();
    assert_eq!(lines, left);
    let request = StreamPointsRequest {
        region: grpc::boxed([0.0, 0.0, 40.0, 40.0]),
        set: Some(PointSet {
            amount: Some(Amount::Spacing(1.0)),
            seed: Some(7),
            except: vec![digest.clone()],
            ..PointSet::default()
        }),
        ..StreamPointsRequest::default()
    };
    let mut client = PointServiceClient::new(daemon.channel().await);
    let points = grpc::collect(&mut client, request).await.points();
    let streamed: Vec<&str> = points.iter().filter_map(|p| p["id"].as_str()).collect();
    let expected: Vec<&str> = left.iter().map(|row| id(row, 0)).collect();
    assert_eq!(streamed, expected);
    // However many lie in a region, and whether one point is requested or the nearest.
    let all = format!("/v1/points?bbox=0,0,150,150&{set}&format=csv&except={digest}");
    assert_eq!(rows(&daemon, &all), without(&wide, &ids, 0));
    let single = |id: &str| {
        daemon
            .get(&format!("/v1/points/{id}?{set}&except={digest}"))
            .status
    };
    let felled = &inline[0];
    let stays = id(&left[0], 0);
    assert_eq!((single(felled), single(stays)), (404, 200));
    let place = inside
        .iter()
        .find(|row| id(row, 0) == felled)
        .expect("its row");
    let at: Vec<&str> = place.split(',').skip(1).take(2).collect();
    let near = |except: &str| {
        let path = format!("/v1/nearest?at={}&k=9&{set}{except}", at.join(","));
        let near = daemon.get(&path).json();
        let near = near["neighbors"].as_array().expect("neighbors").iter();
        let ids = near.filter_map(|near| near["id"].as_str().map(ToOwned::to_owned));
        ids.collect::<Vec<_>>()
    };
    let mut expected = near("");
    expected.retain(|id| !ids.contains(id));
    let found = near(&format!("&except={digest}"));
    assert!(!expected.is_empty() && found.starts_with(&expected) && found.len() == 9);
    // The digest pins the content of the list, so caches may keep the answer.
    let table = daemon.get(&named).header("strew-table").to_owned();
    let pinned = daemon.get(&format!("{named}&table={table}"));
    assert!(pinned.header("cache-control").contains("immutable"));
    // Lists that are loaded are listed, others are not.
    assert_eq!(daemon.get("/v1/except").json(), json!({ "lists": [] }));
}

#[test]
fn a_list_that_was_sent_is_for_worlds_too() {
    let daemon = Daemon::with_config(WORLD);
    let all = rows(&daemon, CHUNK);
    let trees = all.iter().filter(|row| row.starts_with("trees,"));
    let gone = some(&trees.cloned().collect::<Vec<_>>(), 1);
    let items: Vec<String> = gone.iter().map(|id| format!("trees/{id}")).collect();
    let digest = sent(&daemon, &items.join("\n"));
    let named = format!("{CHUNK}&except={digest}");
    assert_eq!(rows(&daemon, &named), without(&all, &gone, 1));
    // It stays when the lists of the configuration are read again.
    fs::write(
        daemon.folder().join("strew.toml"),
        WORLD.replace("ids = []", "ids = ['trees/0:0']"),
    )
    .expect("writable");
    daemon.signal("HUP");
    until("the list is read", || {
        let lists = daemon.get("/v1/except").json();
        lists["lists"][0]["count"] == 1
    });
    assert_eq!(rows(&daemon, &named), without(&all, &gone, 1));
}

#[test]
fn lists_that_cannot_be_held_or_are_gone_are_refused() {
    let daemon = Daemon::start(&["except.max_ids=3", "except.max_sent_bytes=10000"]);
    let first = sent(&daemon, "1:2\n3:4 # a comment\n\n1:-2");
    let path = format!("/v1/count?bbox=0,0,9,9&spacing=1&except={first}");
    assert_eq!(daemon.get(&path).status, 200);
    let many_layers: String = (0..1001).map(|i| format!("l{i}/0:0\n")).collect();
    for (list, field, texts) in [
        ("1:2\n3:4\n5:6\n7:8", "ids", ["too many", "at most 3 ids"]),
        (
            r#"{"ids":["1:2","3:4","5:6","7:8"]}"#,
            "ids",
            ["too many", "except.max_ids"],
        ),
        ("1:2\n\nthree", "line 3", ["not an id", "column:row"]),
        (r#"{"ids":["1:2","x"]}"#, "ids[1]", ["not an id", "layer/"]),
        (
            r#"{"id":[]}"#,
            "body",
            ["unknown field `id`", "an id a line"],
        ),
        (r#"{"ids":3}"#, "body", ["invalid type", "an object of ids"]),
    ] {
        let answer = http1::post(daemon.address(), "/v1/except", &[], list.as_bytes());
        assert_fault(&answer, list, field, &texts);
    }
    // Other lists displace it, and the fault names the remedy.
    for i in 0..3 {
        sent(&daemon, &format!("{i}:5"));
    }
    let texts = ["unknown list", "sent again", "POST /v1/except"];
    assert_fault(&daemon.get(&path), &path, "except[0]", &texts);
    assert_eq!(sent(&daemon, r#"{"ids":["1:-2","3:4","1:2"]}"#), first);
    assert_eq!(daemon.get(&path).status, 200);
    let closed = Daemon::start(&["except.max_sent_bytes=0"]);
    let post = |list: &str| http1::post(closed.address(), "/v1/except", &[], list.as_bytes());
    let texts = ["no room", "except.max_sent_bytes"];
    assert_fault(&post("1:2"), "1:2", "ids", &texts);
    let texts = ["one layer too many", "at most 1000 layers"];
    assert_fault(&post(&many_layers), "layers", "line 1001", &texts);
}

#[test]
fn lists_of_one_address_do_not_push_out_those_of_another() {
    let daemon = Daemon::start(&["except.max_sent_bytes=100000"]);
    let first = sent(&daemon, "1:2");
    let mut last = String::new();
    for i in 0..40 {
        last = sending::digest(daemon.address(), "/v1/except", &format!("{i}:3"));
    }
    for digest in [first, last] {
        let path = format!("/v1/count?bbox=0,0,9,9&spacing=1&except={digest}");
        assert_eq!(daemon.get(&path).status, 200);
    }
}
