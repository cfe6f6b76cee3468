//! Arrangements, clusters and maps over HTTP, against searches that use membership alone.

use serde_json::{Value, json};
use strew_core::{Map, Pattern, Seed};
use strew_testkit::wait::until;

use crate::support::daemon::Daemon;

const PATH: &str = "/v1/pattern/arrangements";
const ALPHAS: [&str; 5] = ["(5-sqrt(3))/2", "sqrt(3)", "1.3", "13/8", "1.97"];

/// An address with its parameters percent-encoded where that is needed.
fn address(path: &str, parameters: &str) -> String {
    format!("{path}?{}", parameters.replace(' ', "%20"))
}

fn get(daemon: &Daemon, path: &str, parameters: &str) -> Value {
    let answer = daemon.get(&address(path, parameters));
    assert_eq!(answer.status, 200, "{parameters}: {}", answer.text());
    answer.json()
}

/// The places of a box at which all offsets are points, in the order of points.
fn by_search(
    pattern: Pattern,
    offsets: &[(i64, i64)],
    [x0, y0, x1, y1]: [i64; 4],
) -> Vec<(i64, i64)> {
    let occurs = |&(x, y): &(i64, i64)| {
        let all = offsets.iter().chain([&(0, 0)]);
        all.into_iter().all(|(i, j)| pattern.contains(x + i, y + j))
    };
    let mut found: Vec<_> = (y0..y1)
        .flat_map(|y| (x0..x1).map(move |x| (x, y)))
        .filter(occurs)
        .collect();
    found.sort_by_key(|&(x, y)| (x.div_euclid(1024), y, x));
    found
}

fn places(listed: &Value) -> Vec<(i64, i64)> {
    let all = listed["occurrences"].as_array().expect("a list").iter();
    let number = |v: &Value| v.as_i64().expect("an integer");
    all.map(|one| (number(&one["at"][0]), number(&one["at"][1])))
        .collect()
}

#[test]
fn occurrences_are_those_of_a_search_and_exist_iff_the_image_fits() {
    let daemon = Daemon::start(&[]);
    let arrangements: [&[(i64, i64)]; 6] = [
        &[(2, 1), (3, 3)],
        &[(2, 0)],
        &[(1, 0)],
        &[(-3, 5), (7, -2), (0, 4)],
        &[(0, 0)],
        &[(1, 2), (2, 1), (-1, 2), (-2, 1)],
    ];
    let (mut existing, mut missing) = (0, 0);
    for (i, alpha) in ALPHAS.iter().enumerate() {
        for (k, offsets) in arrangements.iter().enumerate() {
            let seed = (i * k) as u64;
            let grid = [-1100 + 40 * k as i64, -37, 1500, 20 + 3 * i as i64];
            let text: Vec<String> = offsets.iter().map(|(x, y)| format!("{x},{y}")).collect();
            let parameters = format!(
                "alpha={alpha}&offsets={}&seed={seed}&grid={}&list=json",
                text.join(if k % 2 == 0 { "+" } else { " " }),
                grid.map(|v| v.to_string()).join(",")
            );
            let listed = get(&daemon, PATH, &parameters);
            let alpha: strew_core::Alpha = alpha.parse().expect("valid");
            let pattern = Pattern::with_origin(alpha, Seed(seed).origin());
            let expected = by_search(pattern, offsets, grid);
            assert_eq!(places(&listed), expected, "{parameters}");
            let facts = &listed["arrangement"];
            assert_eq!(facts["count"], json!(expected.len()), "{parameters}");
            assert_eq!(listed["listed"], json!(expected.len()));
            // The theorem: it exists iff the image is smaller than the set region.
            let side = alpha.set_side_f64();
            let image: [[f64; 2]; 2] =
                serde_json::from_value(facts["image"].clone()).expect("numbers");
            let fits = image.iter().all(|[low, high]| high - low < side);
            assert_eq!(facts["exists"], json!(fits), "{parameters}");
            assert_eq!(facts["margin"].is_null(), !fits);
            if !fits {
                assert!(expected.is_empty());
                missing += 1;
                continue;
            }
            existing += 1;
            let margin: [[f64; 2]; 2] =
                serde_json::from_value(facts["margin"].clone()).expect("numbers");
            let area: f64 = margin.iter().map(|[low, high]| high - low).product();
            let density = facts["density"].as_f64().expect("a number");
            assert!((area - density).abs() < 1e-12, "{parameters}");
            let exact: f64 = facts["area"]
                .as_str()
                .expect("digits")
                .parse()
                .expect("digits");
            assert!((exact / 2f64.powi(128) - density).abs() < 1e-15);
            // A far and wide box has its area times the density.
            let wide = format!(
                "alpha={alpha}&offsets={}&grid=-4e15,-4e15,4e15,4e15",
                text.join("+")
            );
            let count = get(&daemon, PATH, &wide)["count"]
                .as_f64()
                .expect("a number");
            assert!((count / 64e30 - density).abs() < 1e-9, "{wide}");
        }
    }
    assert!(existing > 8 && missing > 8, "{existing} {missing}");
}

#[test]
fn pages_and_formats_list_the_same() {
    let daemon = Daemon::start(&[]);
    let base = "alpha=sqrt(3)&offsets=2,0&grid=900,-50,1300,50&seed=3";
    let whole = get(&daemon, PATH, &format!("{base}&list=json"));
    let all = places(&whole);
    assert!(all.len() > 1000);
    let (mut paged, mut cursor) = (vec![], String::new());
    loop {
        let page = daemon.get(&address(
            PATH,
            &format!("{base}&list=json&limit=377{cursor}"),
        ));
        assert_eq!(page.status, 200, "{}", page.text());
        let document = page.json();
        let here = places(&document);
        assert_eq!(page.header("strew-count"), here.len().to_string());
        assert!(here.len() <= 377);
        paged.extend(here);
        let Some(next) = document["next"].as_str() else {
            break;
        };
        assert_eq!(page.header("strew-next"), next);
        cursor = format!("&cursor={next}");
    }
    assert_eq!(paged, all);
    let csv = daemon.get(&address(PATH, &format!("{base}&list=csv")));
    assert_eq!(csv.header("content-type"), "text/csv");
    let lines: Vec<String> = all.iter().map(|(x, y)| format!("{x},{y}")).collect();
    assert_eq!(csv.text(), format!("column,row\n{}\n", lines.join("\n")));
    let lines = daemon.get(&address(PATH, &format!("{base}&list=ndjson")));
    let read = |line: &str| serde_json::from_str::<Value>(line).expect("JSON");
    let lines: Vec<Value> = lines.text().lines().map(read).collect();
    assert_eq!(json!(lines), whole["occurrences"]);
    let body = json!({
        "alpha": "sqrt(3)", "offsets": [[2, 0]], "grid": [900, -50, 1300, 50], "seed": 3, "list": "json",
    });
    let posted = daemon.post(PATH, &body);
    assert_eq!(posted.status, 200, "{}", posted.text());
    assert_eq!(posted.json(), whole);
}

#[test]
fn displaced_places_are_those_of_the_points() {
    let daemon = Daemon::start(&[]);
    let set = "profile=blue&seed=5&spacing=0.7";
    let parameters = format!("offsets=2,1 3,3&grid=-60,-60,60,60&list=json&{set}");
    let listed = get(&daemon, PATH, &parameters);
    let all = listed["occurrences"].as_array().expect("a list");
    assert!(all.len() > 20);
    for one in all.iter().step_by(7) {
        let at = |i: usize| one["at"][i].as_i64().expect("an integer");
        for (i, (x, y)) in [(0, 0), (2, 1), (3, 3)].into_iter().enumerate() {
            let id = format!("{}:{}", at(0) + x, at(1) + y);
            let point = daemon.get(&format!("/v1/points/{id}?{set}")).json();
            let point = &point["point"];
            assert_eq!(one["places"][i], json!([point["x"], point["y"]]), "{id}");
        }
    }
}

#[test]
fn clusters_are_those_of_a_window() {
    let daemon = Daemon::start(&[]);
    for (alpha, distance, limit) in [("sqrt(3)", "2", 4), ("(5-sqrt(3))/2", "2.24", 5)] {
        let found = get(
            &daemon,
            "/v1/pattern/clusters",
            &format!("alpha={alpha}&distance={distance}&most=24"),
        );
        let pattern = Pattern::new(alpha.parse().expect("valid"));
        // How many clusters of each shape begin in a window, by walking from each point.
        let side = 300;
        let mut counts = std::collections::BTreeMap::<Vec<(i64, i64)>, u32>::new();
        for y in 0..side {
            for x in 0..side {
                if !pattern.contains(x, y) {
                    continue;
                }
                let (mut cluster, mut next) = (vec![(y, x)], 0);
                while let Some(&(b, a)) = cluster.get(next).filter(|_| cluster.len() <= 24) {
                    next += 1;
                    for (i, j) in (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j))) {
                        let place = (b + j, a + i);
                        let is_near = i * i + j * j <= limit;
                        if is_near && pattern.contains(a + i, b + j) && !cluster.contains(&place) {
                            cluster.push(place);
                        }
                    }
                }
                cluster.sort_unstable();
                if cluster[0] == (y, x) && cluster.len() <= 24 {
                    let shape = cluster.iter().map(|(b, a)| (a - x, b - y));
                    *counts.entry(shape.collect()).or_default() += 1;
                }
            }
        }
        let shapes = found["shapes"].as_array().expect("a list");
        let points = |shape: &Value| -> Vec<(i64, i64)> {
            serde_json::from_value(shape["points"].clone()).expect("pairs")
        };
        for shape in shapes {
            let count = counts.remove(&points(shape)).unwrap_or(0);
            let expected =
                shape["density"].as_f64().expect("a number") * f64::from(side as i32).powi(2);
            let slack = 4.0 * expected.sqrt().max(3.0);
            assert!(
                (f64::from(count) - expected).abs() < slack,
                "{alpha} {shape} {count}"
            );
        }
        assert!(
            counts.is_empty(),
            "{alpha}: shapes that were not found: {counts:?}"
        );
        let merged = get(
            &daemon,
            "/v1/pattern/clusters",
            &format!("alpha={alpha}&distance={distance}&most=24&up_to=symmetry"),
        );
        let classes = merged["shapes"].as_array().expect("a list");
        assert_eq!(json!(classes.len()), found["classes"]);
        let images = classes
            .iter()
            .map(|class| class["images"].as_u64().expect("a number"));
        assert_eq!(images.sum::<u64>(), shapes.len() as u64);
    }
}

#[test]
fn maps_have_the_blocks_and_neighbors_of_the_pattern() {
    let daemon = Daemon::start(&[]);
    for alpha in ALPHAS {
        let parameters = format!("alpha={alpha}&radius=12&refined=30&block=2,1");
        let document = get(&daemon, "/v1/pattern/map", &parameters);
        let read =
            |name: &Value| -> Vec<f64> { serde_json::from_value(name.clone()).expect("numbers") };
        let (starts, fine) = (
            read(&document["starts"]),
            read(&document["refined"]["starts"]),
        );
        let alpha: strew_core::Alpha = alpha.parse().expect("valid");
        let map = Map::new(alpha, 12).expect("in range");
        assert_eq!(starts.len(), map.intervals());
        assert_eq!(document["intervals"], json!(starts.len()));
        let parents: Vec<usize> =
            serde_json::from_value(document["refined"]["parents"].clone()).expect("numbers");
        assert_eq!(parents.len(), fine.len());
        for (start, parent) in fine.iter().zip(parents) {
            let end = starts.get(parent + 1).copied().unwrap_or(1.0);
            // Intervals that only rounding makes may begin at the same double.
            assert!(starts[parent] <= *start && *start <= end);
        }
        // A point of the block in the plane has these neighbors.
        let pattern = Pattern::new(alpha);
        let in_block = |&(x, y): &(i64, i64)| {
            let (dx, dy) = pattern.index(x, y);
            [map.interval_of(dx), map.interval_of(dy)] == [Some(2), Some(1)]
        };
        let mut plane = (-400..400).flat_map(|y| (-400..400).map(move |x| (x, y)));
        let Some((x, y)) = plane.find(in_block) else {
            continue;
        };
        let neighbors: Vec<(i64, i64)> =
            serde_json::from_value(document["neighbors"]["offsets"].clone()).expect("pairs");
        let expected: Vec<(i64, i64)> = (-12..=12)
            .flat_map(|j| (-12..=12).map(move |i| (i, j)))
            .filter(|(i, j)| pattern.contains(x + i, y + j))
            .collect();
        assert_eq!(neighbors, expected, "{alpha}");
    }
}

#[test]
fn figures_are_those_of_the_command_line() {
    let daemon = Daemon::start(&[]);
    for (name, parameters) in [
        ("index", "alpha=13/8&window=32"),
        ("arrangement", "alpha=13/8&window=32&offsets=2,1+3,3"),
        ("clusters", "alpha=13/8&window=32&distance=2"),
        ("map", "alpha=13/8&radius=9&block=1,2"),
    ] {
        let answer = daemon.get(&format!("/v1/pattern/figures/{name}.svg?{parameters}"));
        assert_eq!(answer.status, 200, "{}", answer.text());
        assert_eq!(answer.header("content-type"), "image/svg+xml");
        let mut flags = vec!["figure".to_owned(), name.to_owned()];
        for pair in parameters.split('&') {
            let (flag, value) = pair.split_once('=').expect("a pair");
            flags.extend([format!("--{flag}"), value.replace('+', " ")]);
        }
        let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
        let drawn = crate::support::command::run(&flags, "");
        assert_eq!(
            String::from_utf8_lossy(&drawn.stdout),
            answer.text(),
            "{name}"
        );
    }
}

#[test]
fn more_than_the_limit_is_refused_and_pages_are_the_way_around() {
    let daemon = Daemon::start(&["limits.max_points=1000"]);
    let many = "offsets=2,1&grid=0,0,1000,1000";
    let count = get(&daemon, PATH, many)["count"].clone();
    let refused = daemon.get(&address(PATH, &format!("{many}&list=csv")));
    assert_eq!(refused.status, 413, "{}", refused.text());
    assert!(
        refused.text().contains(&count.to_string()),
        "{}",
        refused.text()
    );
    let page = daemon.get(&address(PATH, &format!("{many}&list=csv&limit=1000")));
    assert_eq!(page.text().lines().count(), 1001);
}

#[test]
fn a_search_that_outlives_its_time_ends() {
    let daemon = Daemon::start(&["server.first_byte_seconds=0.2", "workers.threads=1"]);
    // Clusters of up to 64 points reach far at this distance: a second of work at least.
    let answer = daemon.get("/v1/pattern/clusters?alpha=1.12&distance=16&most=64");
    assert_eq!(answer.status, 503, "{}", answer.text());
    // The one thread for long work is free again.
    until("another search is answered", || {
        let small = daemon.get("/v1/pattern/clusters?alpha=sqrt(3)&distance=1&most=4");
        small.status == 200
    });
}

#[test]
fn figures_are_drawn_as_pixels_too() {
    let daemon = Daemon::built_in();
    for parameters in [
        "index.png?alpha=sqrt(3)&window=32&size=200",
        "arrangement.png?offsets=2,1+3,3&size=200",
        "clusters.png?distance=2&window=32&size=200",
        "map.png?radius=20&size=200",
    ] {
        let picture = daemon.get(&format!("/v1/pattern/figures/{parameters}"));
        assert_eq!(
            picture.header("content-type"),
            "image/png",
            "{}",
            picture.text()
        );
        assert!(picture.body.starts_with(b"\x89PNG"), "{parameters}");
        // The width and the height in the file's head.
        let side = |at: usize| u32::from_be_bytes([0, 1, 2, 3].map(|i| picture.body[at + i]));
        assert_eq!(side(16).max(side(20)), 200, "{parameters}");
    }
}
