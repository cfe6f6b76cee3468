//! What requests cost beside what they are charged: random queries over all parameters, one at a time, at a daemon of
//! their own whose rate shows the charge.
//!
//! Work must not take more than ten microseconds of processor time for each point that is charged, and short work must
//! not keep its place for long, whatever its price says.

use std::{f64::consts::TAU, net::SocketAddr, path::Path, time::Instant};

use serde_json::{Map, Value, json};
use strew_testkit::{http1, random::SplitMix, wait::until};

use crate::{replica, tally::Tally};

/// The processor time of a point that is charged, at most, in milliseconds.
const POINT: f64 = 0.01;
/// What costs less than this is not judged, in milliseconds: the clock of processes has steps of ten. Without
/// optimization it says nothing.
const FLOOR: f64 = if cfg!(debug_assertions) { 5000.0 } else { 40.0 };
/// The longest that short work may keep its place, in seconds: its limit, and the way to its next look.
const SHORT: f64 = if cfg!(debug_assertions) { 5.0 } else { 0.1 };

/// Sends queries until the end.
pub fn compare(tables: &Path, tally: &Tally, seed: u64, end: Instant) {
    let settings = ["rate.points_per_second=0.001", "rate.burst_points=1e13"];
    let any_port = SocketAddr::from(([127, 0, 0, 1], 0));
    let daemon = replica::launch(any_port, tables, &settings).expect("ready");
    let at = daemon.address();
    let left = || -> Option<f64> {
        let answer = http1::try_open(at, "GET", "/v1/except", &[], None).ok()?;
        let text = answer.header("ratelimit").strip_prefix("\"points\";r=")?;
        text.split(';').next()?.parse().ok()
    };
    let left = || until("the daemon answers", left);
    let milliseconds = || 10.0 * daemon.cpu_ticks() as f64;
    let mut random = SplitMix::new(seed);
    let mut worst = (0.0, String::new());
    let mut before = left();
    let (mut page, mut sent, mut answered) = (None, 0, 0);
    while Instant::now() < end {
        let (path, mut body) = page.take().unwrap_or_else(|| request(&mut random));
        let text = body.to_string();
        let spent = milliseconds();
        sent += 1;
        let answer =
            http1::try_open(at, "POST", path, &[], Some(text.as_bytes())).and_then(|answer| {
                if answer.status / 100 == 2 {
                    answered += 1;
                }
                let next = answer.header("strew-next");
                if !next.is_empty() && random.once_in(2) {
                    body["cursor"] = next.into();
                    page = Some((path, body));
                }
                answer.body()
            });
        // What is left of the work ends soon, and is charged when it does.
        let mut ended = milliseconds();
        let spent = until("the work is over", || {
            std::thread::park_timeout(std::time::Duration::from_millis(30));
            let now = milliseconds();
            let is_over = std::mem::replace(&mut ended, now) >= now && !daemon.is_at_work();
            is_over.then_some(now)
        }) - spent;
        let now = left();
        let charged = before - now - 1.0;
        before = now;
        let most = FLOOR.max(charged * POINT);
        if spent > worst.0 * charged.max(1.0) {
            worst = (spent / charged.max(1.0), format!("{path} {text}"));
        }
        let what = match spent > most {
            true => Err(crate::tally::Trouble::Wrong(format!(
                "{spent} ms of processor time for {charged} points: {path} {text}"
            ))),
            // Refusals are answers, and clients that are cut off have their reason.
            false => answer.map(|_| 0).or(Ok(0)),
        };
        tally.note("a query with its charge", what, false);
    }
    let metrics = http1::get(at, "/metrics", &[]);
    let longest = metrics.text().lines().find_map(|line| {
        line.strip_prefix("strew_work_short_seconds_max ")?
            .parse::<f64>()
            .ok()
    });
    let longest = longest.expect("the metric");
    if longest > SHORT {
        tally.wrong(format!("short work kept its place for {longest} s"));
    }
    println!(
        "{sent} queries of all kinds, of which {answered} were answered and the rest refused; the dearest: {:.1} us a \
         point charged; short work kept its place for {:.1} ms at most",
        worst.0 * 1e3,
        longest * 1e3
    );
    println!("{}", &worst.1[..worst.1.len().min(1000)]);
}

/// A number between powers of ten.
fn power(random: &mut SplitMix, low: f64, high: f64) -> f64 {
    let value = 10_f64.powf(random.within(low, high));
    format!("{value:.3e}").parse().expect("a number")
}

fn one_of<T: Clone>(random: &mut SplitMix, all: &[T]) -> T {
    all[random.index(all.len())].clone()
}

/// True in so many of a hundred cases.
fn in_hundred(random: &mut SplitMix, times: u64) -> bool {
    random.below(100) < times
}

fn star(random: &mut SplitMix, center: [f64; 2], radius: f64) -> Value {
    let corners = one_of(random, &[3, 10, 100, 3000, 20_000]);
    let inner = one_of(random, &[0.3, 0.9, -0.5]);
    let corner = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i % corners) / f64::from(corners)).sin_cos();
        let radius = radius * if i.is_multiple_of(2) { 1.0 } else { inner };
        [center[0] + radius * cos, center[1] + radius * sin]
    };
    let ring: Vec<[f64; 2]> = (0..=corners).map(corner).collect();
    json!({ "type": "Polygon", "coordinates": [ring] })
}

/// A region of the plane or of space.
fn region(random: &mut SplitMix, is_space: bool, depth: u32) -> Value {
    let far = one_of(random, &[0.0, 0.0, 50.0, 1e7]);
    let axes = if is_space { 3 } else { 2 };
    let low: Vec<f64> = (0..axes).map(|_| random.within(-far, far)).collect();
    let widest = if is_space { 2.0 } else { 3.0 };
    match random.below(if depth < 1 { 8 } else { 6 }) {
        0..=2 => {
            let high = low.iter().map(|low| low + power(random, -0.5, widest));
            let high: Vec<f64> = high.collect();
            let corners = [low, high].concat();
            json!({ "bbox": corners })
        }
        3 | 4 => {
            let name = if is_space { "ball" } else { "circle" };
            json!({ name: { "center": low, "radius": power(random, -0.5, widest) } })
        }
        5 => {
            let radius = power(random, 0.0, widest);
            let polygon = star(random, [low[0], low[1]], radius);
            match low.get(2) {
                Some(&z) => {
                    let top = z + power(random, -0.5, widest);
                    json!({ "prism": { "polygon": polygon, "bottom": z, "top": top } })
                }
                None => json!({ "polygon": polygon }),
            }
        }
        _ => {
            let mut some = |numbers: &[u32]| -> Vec<Value> {
                let number = one_of(random, numbers);
                (0..number)
                    .map(|_| region(random, is_space, depth + 1))
                    .collect()
            };
            let (include, exclude) = (some(&[1, 2, 10, 200]), some(&[0, 1, 5, 100]));
            json!({ "include": include, "exclude": exclude })
        }
    }
}

fn field(random: &mut SplitMix, depth: u32) -> Value {
    match random.below(if depth < 2 { 6 } else { 4 }) {
        0 | 1 => json!({ "noise": {
            "seed": random.below(9), "wavelength": power(random, 0.0, 2.5),
            "octaves": one_of(random, &[1, 4, 8]),
        } }),
        2 => {
            let radii = [power(random, 0.0, 1.0), power(random, 1.1, 3.0)];
            json!({ "radial": { "center": [0, 0], "radii": radii } })
        }
        3 => {
            let to = [power(random, 0.0, 3.0), power(random, 0.0, 3.0)];
            json!({ "ramp": { "from": [0, 0], "to": to } })
        }
        _ => {
            let parts = one_of(random, &[2, 10]);
            let parts: Vec<Value> = (0..parts).map(|_| field(random, depth + 1)).collect();
            json!({ "multiply": parts })
        }
    }
}

/// A set of points, about a spacing apart.
fn set(random: &mut SplitMix, is_space: bool, spacing: f64) -> Map<String, Value> {
    let mut set = Map::new();
    let mut put = |name: &str, value: Value| {
        set.insert(name.into(), value);
    };
    match random.below(20) {
        0..=14 => put("spacing", json!(spacing * power(random, -0.4, 0.4))),
        15..=17 => put("min_distance", json!(spacing)),
        _ if is_space => put("density", json!(spacing.powi(-3))),
        _ => put("count", json!(power(random, 1.0, 5.5).round())),
    }
    if in_hundred(random, 60) {
        put("seed", json!(1 + random.below(99)));
    }
    if in_hundred(random, 25) {
        put(
            "warp",
            one_of(random, &[json!("off"), json!(0.5), json!(2)]),
        );
    }
    if in_hundred(random, 30) {
        put("keep", json!(power(random, -3.0, 0.0)));
    }
    let mut attributes = vec![];
    if in_hundred(random, 30) {
        let turn = if is_space { "rotation" } else { "angle" };
        attributes.extend(["rank", "scale", "u1", turn]);
    }
    if in_hundred(random, 15) {
        put(
            "variants",
            json!({ "a": 1, "b": power(random, -1.0, 1.0), "c": 3 }),
        );
        attributes.push("variant");
    }
    if !attributes.is_empty() {
        put("attributes", json!(attributes));
    }
    if is_space {
        if in_hundred(random, 20) {
            put("profile", json!("spaced"));
        }
        return set;
    }
    if in_hundred(random, 20) {
        put("lod", json!(power(random, -3.0, 0.0)));
    }
    if in_hundred(random, 20) {
        put("settle", json!(random.below(5)));
    }
    if in_hundred(random, 30) {
        put("field", field(random, 0));
    }
    if in_hundred(random, 12) {
        put("terrain", field(random, 0));
        put("normals", json!("on"));
    }
    if in_hundred(random, 20) {
        let profiles = ["spaced", "pattern", "sharp", "pink", "green", "step"];
        put("profile", json!(one_of(random, &profiles)));
    }
    set
}

/// A request for points, a count or a split: its path and its body.
fn request(random: &mut SplitMix) -> (&'static str, Value) {
    let is_space = random.once_in(2);
    let spacing = power(random, -1.0, 1.5);
    let mut query = Map::from_iter([("region".into(), region(random, is_space, 0))]);
    if random.once_in(4) {
        let number = one_of(random, &[2, 3, 5, 8, 16]);
        let layers = (0..number).map(|i| {
            let mut layer = set(random, is_space, spacing);
            layer.insert("name".into(), json!(format!("l{i}")));
            let others: Vec<u64> = (0..random.below(5))
                .map(|_| random.below(i.max(1)))
                .collect();
            let clear = others.iter().filter(|_| i > 0).map(|other| {
                let distance = spacing * power(random, -1.3, 0.8);
                (format!("l{other}"), json!(distance))
            });
            let clear: Map<String, Value> = clear.collect();
            if !clear.is_empty() {
                layer.insert("clear_of".into(), clear.into());
            }
            if random.once_in(5) {
                layer.insert("region".into(), region(random, is_space, 1));
            }
            Value::Object(layer)
        });
        let layers: Vec<Value> = layers.collect();
        query.insert("layers".into(), layers.into());
    } else {
        query.append(&mut set(random, is_space, spacing));
    }
    let paths = match is_space {
        true => [
            "/v1/space/points",
            "/v1/space/count",
            "/v1/space/points:split?parts=100",
        ],
        false => [
            "/v1/points:query",
            "/v1/count",
            "/v1/points:split?parts=5000",
        ],
    };
    let path = paths[[0, 0, 0, 1, 2][random.index(5)]];
    if path == paths[0] {
        let formats = [
            "f32",
            "csv",
            "json",
            "arrow",
            "npy",
            "instances",
            "usda",
            "png",
            "svg",
        ];
        query.insert("format".into(), json!(one_of(random, &formats)));
        query.insert("limit".into(), json!(power(random, 1.0, 4.8).round()));
        if in_hundred(random, 20) {
            query.insert("offset".into(), json!(power(random, 0.0, 6.0).round()));
        }
    }
    (path, Value::Object(query))
}
