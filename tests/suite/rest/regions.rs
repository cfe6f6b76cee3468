//! Regions of all kinds: the points they hold. Adjacent regions share no point and lose none.

use serde_json::{Value, json};
use strew_core::Point;

use crate::support::{
    csv::{Csv, sorted},
    daemon::Daemon,
};

fn polygon(rings: &Value) -> Value {
    json!({ "polygon": { "type": "Polygon", "coordinates": rings } })
}

fn ask(daemon: &Daemon, region: &Value) -> Vec<Point> {
    let body = json!({ "region": region, "spacing": 0.7, "seed": 5 });
    Csv::post(daemon, &body).points
}

#[test]
fn polygons_by_get_and_post_and_their_holes() {
    let daemon = Daemon::start(&[]);
    let outer = json!([[0, 0], [30, -4], [36, 22], [10, 31], [0, 0]]);
    let hole = json!([[8, 8], [20, 6], [17, 19]]);
    let got = Csv::get(&daemon, "polygon=0,0,30,-4,36,22,10,31&spacing=0.7&seed=5");
    let whole = ask(&daemon, &polygon(&json!([outer])));
    assert_eq!(whole, got.points);
    let holed = ask(&daemon, &polygon(&json!([outer, hole])));
    let missing = ask(&daemon, &polygon(&json!([hole])));
    assert!(missing.len() > 50 && holed.len() > 500);
    assert_eq!(
        sorted([holed.clone(), missing].concat()),
        sorted(whole.clone())
    );
    // A hole is an exclusion; overlapping polygons are a union.
    let excluded = json!({
        "include": [polygon(&json!([outer]))],
        "exclude": [polygon(&json!([hole]))],
    });
    assert_eq!(ask(&daemon, &excluded), holed);
    let multi = json!({ "polygon": { "type": "MultiPolygon", "coordinates": [[outer], [hole]] } });
    assert_eq!(ask(&daemon, &multi), whole);
}

#[test]
fn chunks_are_seamless_and_relative_to_their_corners() {
    let daemon = Daemon::start(&[]);
    for (size, at, rest) in [
        (8.0, [-1i64, 2], "spacing=0.5&seed=2"),
        (0.1, [3, -4], "spacing=0.01"),
        (1e3, [1_000_000_000, -1_000_000_000], "spacing=40&seed=2"),
    ] {
        let [cx, cy] = at;
        let mut joined = vec![];
        for (x, y) in [(cx, cy), (cx + 1, cy), (cx, cy + 1), (cx + 1, cy + 1)] {
            let chunk = Csv::chunk(&daemon, &format!("{size}/{x}/{y}?{rest}"));
            let origin: Vec<f64> = chunk
                .answer
                .header("strew-origin")
                .split(',')
                .map(|v| v.parse().expect("a number"))
                .collect();
            let corner = [x, y].map(|v| v as f64 * size);
            assert_eq!(origin, corner);
            assert!(chunk.points.len() > 50);
            for p in &chunk.points {
                assert!((0.0..=size * (1.0 + 1e-9)).contains(&p.x), "{p:?}");
                assert!((0.0..=size * (1.0 + 1e-9)).contains(&p.y), "{p:?}");
            }
            joined.extend(chunk.points.into_iter().map(|p| p.id));
        }
        let corners = [cx, cy, cx + 2, cy + 2].map(|v| v as f64 * size);
        let [min_x, min_y, max_x, max_y] = corners;
        let whole = Csv::get(
            &daemon,
            &format!("bbox={min_x},{min_y},{max_x},{max_y}&{rest}"),
        );
        let mut expected: Vec<_> = whole.points.iter().map(|p| p.id).collect();
        expected.sort();
        joined.sort();
        assert_eq!(joined, expected, "{size}");
    }
}

#[test]
fn f32_is_exact_enough_at_any_distance() {
    let daemon = Daemon::start(&[]);
    // 64·15625000000 = 10¹².
    let path = "/v1/chunks/64/15625000000/-15625000000?spacing=1&seed=3";
    let exact = Csv::of(daemon.get(&format!("{path}&format=csv")));
    let packed = daemon.get(&format!("{path}&format=f32"));
    assert_eq!(packed.status, 200);
    assert_eq!(
        packed.header("strew-origin"),
        "1000000000000.0,-1000000000000.0"
    );
    let (pairs, rest) = packed.body.as_chunks::<8>();
    assert!(rest.is_empty() && pairs.len() == exact.points.len() && pairs.len() > 4000);
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().expect("four")));
    for (pair, point) in pairs.iter().zip(&exact.points) {
        let [x, y] = [number(&pair[..4]), number(&pair[4..])];
        assert!(
            (x - point.x).abs() < 4e-4 && (y - point.y).abs() < 4e-4,
            "{point:?}"
        );
        assert!((0.0..64.0).contains(&x) && (0.0..64.0).contains(&y));
    }
}
