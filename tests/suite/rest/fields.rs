//! Fields over REST: named and described, in every kind of request, and reloaded.

use serde_json::{Value, json};
use strew_testkit::wait::until;

use crate::support::{
    csv::{Csv, sorted},
    daemon::{Daemon, no_tables},
    fields::{base64, folder, left_half, png, write},
    problem::assert_fault,
};

/// A daemon with the fields of a folder.
fn daemon(fields: &tempfile::TempDir) -> Daemon {
    let setting = format!("fields.folder={}", fields.path().display());
    Daemon::with_tables(no_tables(), &[&setting, "reload.watch_seconds=0"])
}

#[test]
fn fields_are_listed_with_their_digests_descriptions_and_pictures() {
    let folder = folder();
    let daemon = daemon(&folder);
    let list = daemon.get("/v1/fields").json();
    let names: Vec<&Value> = list["fields"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|f| &f["name"])
        .collect();
    assert_eq!(names, ["forest", "left", "portrait", "ramp"]);
    assert_eq!(list["fields"][1]["shape"], "raster");
    assert_eq!(list["fields"][1]["bbox"], json!([0.0, 0.0, 40.0, 40.0]));
    let one = daemon.get("/v1/fields/left").json();
    assert_eq!(one["digest"], list["fields"][1]["digest"]);
    assert_eq!(one["field"]["raster"]["file"], "left.png");
    let none = daemon.get("/v1/fields/right");
    assert_eq!(none.status, 404);
    assert!(
        none.text().contains("forest, left, portrait, ramp"),
        "{}",
        none.text()
    );
    let answer = daemon.get("/v1/fields/left/chunks/40/0/0");
    assert_eq!(answer.header("content-type"), "image/png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(answer.body.clone()))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; 256 * 256];
    reader
        .next_frame(&mut pixels)
        .expect("256 × 256 pixels of gray");
    assert_eq!((pixels[100], pixels[200]), (255, 0));
}

#[test]
fn points_lie_where_the_field_is_and_are_those_of_the_whole_set() {
    let folder = folder();
    let daemon = daemon(&folder);
    let all = Csv::get(&daemon, "bbox=-5,-5,45,45&spacing=1&seed=7");
    let left = Csv::get(&daemon, "bbox=-5,-5,45,45&spacing=1&seed=7&field=left");
    let inside = |x: f64, y: f64| (0.0..20.0).contains(&x) && (0.0..40.0).contains(&y);
    let is_deep =
        |p: &&strew_core::Point| inside(p.x - 1.0, p.y - 1.0) && inside(p.x + 1.0, p.y + 1.0);
    let deep: Vec<_> = all.points.iter().filter(is_deep).copied().collect();
    assert!(deep.len() > 500);
    assert_eq!(
        sorted(left.points.iter().filter(is_deep).copied().collect()),
        sorted(deep)
    );
    assert!(left.points.iter().all(|p| p.x < 20.5 && p.x > -0.5));
    let ramp = Csv::get(&daemon, "bbox=0,0,40,40&spacing=1&seed=7&field=ramp");
    let share = ramp.points.len() as f64 / 1600.0;
    assert!((0.45..0.55).contains(&share), "{share}");
    // The echo names the field and its digest.
    let echo = daemon
        .get("/v1/count?bbox=0,0,40,40&spacing=1&seed=7&field=ramp")
        .json();
    assert_eq!(echo["count"], ramp.points.len());
    assert_eq!(echo["query"]["field"], "ramp");
    let listed = daemon.get("/v1/fields/ramp").json();
    assert_eq!(echo["query"]["field_digest"], listed["digest"]);
}

#[test]
fn chunks_pages_and_parts_are_those_of_the_whole() {
    let folder = folder();
    let daemon = daemon(&folder);
    const SET: &str = "spacing=1&seed=3&field=ramp";
    let whole = Csv::get(&daemon, &format!("bbox=0,0,32,32&{SET}"));
    let mut joined = vec![];
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let chunk = Csv::chunk(&daemon, &format!("16/{x}/{y}?{SET}"));
        joined.extend(chunk.points.iter().map(|p| p.id));
    }
    joined.sort();
    let ids = |csv: &Csv| {
        sorted(csv.points.clone())
            .iter()
            .map(|p| p.id)
            .collect::<Vec<_>>()
    };
    assert_eq!(joined, ids(&whole));
    // Pages.
    let (mut pages, mut cursor) = (vec![], String::new());
    loop {
        let page = Csv::get(&daemon, &format!("bbox=0,0,32,32&{SET}&limit=100{cursor}"));
        pages.extend(page.points);
        match page.answer.headers.get("strew-next") {
            Some(next) => cursor = format!("&cursor={next}"),
            None => break,
        }
    }
    assert_eq!(pages, whole.points);
    // An offset, and parts.
    let late = Csv::get(&daemon, &format!("bbox=0,0,32,32&{SET}&offset=200&limit=9"));
    assert_eq!(late.points, whole.points[200..209]);
    let body =
        json!({ "region": { "bbox": [0, 0, 32, 32] }, "spacing": 1, "seed": 3, "field": "ramp" });
    let parts = daemon.post("/v1/points:split?parts=3", &body).json();
    let mut joined = vec![];
    for part in parts["parts"].as_array().expect("a list") {
        joined.extend(Csv::post(&daemon, &part["query"]).points);
    }
    assert_eq!(joined, whole.points);
    // A cursor of another field is refused.
    let page = Csv::get(&daemon, &format!("bbox=0,0,32,32&{SET}&limit=9"));
    let next = page.answer.header("strew-next");
    let path = format!("/v1/points?bbox=0,0,32,32&spacing=1&seed=3&field=left&cursor={next}");
    assert_fault(&daemon.get(&path), &path, "cursor", &["another"]);
}

#[test]
fn single_points_and_counts_know_the_field() {
    let folder = folder();
    let daemon = daemon(&folder);
    const SET: &str = "spacing=1&seed=5&field=ramp";
    let whole = Csv::get(&daemon, &format!("bbox=0,0,40,40&{SET}"));
    for point in whole.points.iter().step_by(97) {
        let found = daemon.get(&format!("/v1/points/{}?{SET}", point.id)).json();
        assert_eq!(
            (found["point"]["x"].as_f64(), found["point"]["y"].as_f64()),
            (Some(point.x), Some(point.y))
        );
    }
    let all = Csv::get(&daemon, "bbox=0,0,10,40&spacing=1&seed=5");
    let gone = all
        .points
        .iter()
        .find(|p| whole.points.iter().all(|q| q.id != p.id));
    let gone = gone.expect("the ramp leaves some out").id;
    assert_eq!(daemon.get(&format!("/v1/points/{gone}?{SET}")).status, 404);
    let at = [12.0, 20.0];
    let distance = |p: &&strew_core::Point| (p.x - at[0]).hypot(p.y - at[1]);
    let nearest = whole
        .points
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let found = daemon.get(&format!("/v1/nearest?at=12,20&{SET}")).json();
    assert_eq!(
        found["neighbors"][0]["id"],
        nearest.expect("some").id.to_string()
    );
    let exact = Csv::get(&daemon, "bbox=0,0,40,40&count=333&seed=5&field=ramp");
    assert_eq!(exact.points.len(), 333);
}

#[test]
fn bodies_describe_fields_each_layer_its_own() {
    let folder = folder();
    let daemon = daemon(&folder);
    let named = Csv::get(&daemon, "bbox=0,0,40,40&spacing=1&seed=7&field=left");
    let mask = json!({ "raster": {
        "png": base64(&left_half()), "bbox": [0, 0, 40, 40], "filter": "nearest",
    } });
    let region = json!({ "bbox": [0, 0, 40, 40] });
    let described = Csv::post(
        &daemon,
        &json!({
            "region": region, "spacing": 1, "seed": 7, "field": mask,
        }),
    );
    assert_eq!(described.points, named.points);
    let echo = daemon.post(
        "/v1/count",
        &json!({
            "region": region, "spacing": 1, "seed": 7, "field": mask,
        }),
    );
    let digest = &daemon.get("/v1/fields/left").json()["digest"];
    assert_eq!(echo.json()["query"]["field_digest"], *digest);
    let body = json!({ "region": region, "layers": [
        { "name": "a", "spacing": 1, "seed": 7, "field": "left" },
        { "name": "b", "spacing": 1, "seed": 7, "field": { "invert": { "name": "left" } } },
        { "name": "c", "spacing": 2, "seed": 8, "clear_of": { "a": 1 },
          "field": { "multiply": [{ "name": "ramp" }, { "constant": 0.5 }] } },
    ] });
    let layers = Csv::post(&daemon, &body);
    let of = |name: &str| {
        let all = layers.points.iter().zip(&layers.columns["layer"]);
        all.filter(|(_, layer)| *layer == name)
            .map(|(p, _)| *p)
            .collect::<Vec<_>>()
    };
    assert_eq!(of("a"), named.points);
    let (a, b, c) = (of("a"), of("b"), of("c"));
    assert!(b.len() > 700 && b.iter().all(|p| p.x > 19.5));
    assert!(c.len() > 20);
    assert!(
        a.iter()
            .all(|p| c.iter().all(|q| (p.x - q.x).hypot(p.y - q.y) >= 1.0))
    );
}

#[test]
fn what_a_field_leaves_out_is_charged_and_limited() {
    let folder = folder();
    let setting = format!("fields.folder={}", folder.path().display());
    let daemon = Daemon::with_tables(no_tables(), &[&setting, "limits.max_rows=20000"]);
    // Nothing beyond the mask, which is found without looking at points.
    let far = daemon.get("/v1/count?bbox=1000,1000,1e6,1e6&spacing=1&warp=off&field=left");
    assert_eq!(far.json()["count"], 0, "{}", far.text());
    let path = "/v1/count?bbox=-3e3,-3e3,3e3,3e3&spacing=1&warp=off&field=ramp";
    let refused = daemon.get(path);
    assert_eq!(refused.status, 413, "{}", refused.text());
}

#[test]
fn changed_fields_change_answers_and_tags() {
    let folder = folder();
    let daemon = daemon(&folder);
    const PATH: &str = "/v1/chunks/16/0/0?spacing=1&seed=7&field=ramp&format=f32";
    let before = daemon.get(PATH);
    write(folder.path(), "ramp.json", br#"{"constant": 1}"#);
    write(folder.path(), "left.png", b"damaged");
    daemon.signal("HUP");
    until("the field is served", || {
        let shape = &daemon.get("/v1/fields/ramp").json()["shape"];
        shape == "constant"
    });
    let after = daemon.get(PATH);
    assert!(after.body.len() > before.body.len());
    assert_ne!(after.header("etag"), before.header("etag"));
    // The damaged mask is refused, and what it was stays.
    let left = daemon
        .get("/v1/count?bbox=0,0,40,40&spacing=1&field=left")
        .json();
    assert!(
        left["count"].as_u64().is_some_and(|count| count > 700),
        "{left}"
    );
}

#[test]
fn a_field_is_sent_once_and_named_by_its_digest() {
    let daemon = Daemon::with_tables(no_tables(), &["fields.max_sent_bytes=100000"]);
    let mask = json!({ "raster": { "png": base64(&left_half()), "bbox": [0, 0, 32, 32] } });
    let sent = daemon.post("/v1/fields", &mask);
    assert_eq!(sent.status, 200, "{}", sent.text());
    let name = sent.json()["name"].as_str().expect("text").to_owned();
    assert_eq!(sent.json()["digest"], name);
    let path = format!("bbox=0,0,32,32&spacing=1&seed=7&field={name}");
    let named = Csv::get(&daemon, &path);
    let described = Csv::post(
        &daemon,
        &json!({ "region": { "bbox": [0, 0, 32, 32] }, "spacing": 1, "seed": 7, "field": mask }),
    );
    assert!(named.points.len() > 300);
    assert_eq!(named.points, described.points);
    // It has a picture, and is described without its pixels; the list has loaded ones only.
    let one = daemon.get(&format!("/v1/fields/{name}")).json();
    assert!(one["field"]["raster"]["png"].is_null(), "{one}");
    let picture = daemon.get(&format!("/v1/fields/{name}/chunks/32/0/0"));
    assert_eq!(picture.status, 200);
    let list = daemon.get("/v1/fields").json();
    assert_eq!(list["fields"].as_array().expect("a list").len(), 2);
    // Others make it go; what does not fit is refused.
    for x in 0..8 {
        let other = json!({ "radial": { "center": [x, 0], "radii": [1, 2] } });
        assert_eq!(daemon.post("/v1/fields", &other).status, 200);
    }
    assert_fault(
        &daemon.get(&format!("/v1/count?{path}")),
        &path,
        "field",
        &["no such field"],
    );
    let large = json!({ "raster": { "png": base64(&png([400, 400], |x, _| x as u8)) } });
    let refused = daemon.post("/v1/fields", &large);
    assert_fault(&refused, "large", "field", &["no room", "max_sent_bytes"]);
    let wrong = daemon.post("/v1/fields", &json!({ "noise": {} }));
    assert_fault(&wrong, "wrong", "field.noise", &["wavelength"]);
}
