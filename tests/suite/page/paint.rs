//! Fields by hand: what is painted by mouse, keys and touch is what the server's points follow, and it comes back from
//! the address and from a file.

use serde_json::{Value, json};

use super::export::{assert_same, copied, rows, run};
use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

/// Does something that changes the points, and waits until they are there. Returns how many.
pub(super) fn changed(browser: &Browser, act: impl FnOnce()) -> u64 {
    let before = browser.value("strew.plane.chunks.identity");
    act();
    browser.until(&format!("strew.plane.chunks.identity !== {before}"));
    browser.ready()
}

/// The stroke of an index, as a line with its size.
fn stroke(browser: &Browser, index: usize) -> (Vec<[f64; 2]>, f64) {
    let stroke = browser.value(&format!("strew.paint.work.strokes[{index}]"));
    let line = serde_json::from_value(stroke["line"].clone()).expect("a line");
    (line, stroke["size"].as_f64().expect("a size"))
}

fn distance(line: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let to = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let (dx, dy) = (bx - ax, by - ay);
        let share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy);
        let share = share.clamp(0.0, 1.0);
        (ax + share * dx - x).hypot(ay + share * dy - y)
    };
    line.windows(2).map(to).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_is_painted_is_followed_and_comes_back() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=5,5&span=60&seed=3");
    let all = browser.ready();
    browser.click("#paint-open");
    let [x, y] = browser.middle("#brush");
    let painted = changed(&browser, || browser.drag([x - 200, y - 100], [400, 0]));
    assert!(painted < all / 3, "{painted} of {all}: a tenth elsewhere");
    let (line, size) = stroke(&browser, 0);
    let near = |line: &[[f64; 2]], reach: f64| {
        let points = browser.in_view().into_iter();
        points
            .map(|[u, v]| [u + 5.0, v + 5.0])
            .filter(|&at| distance(line, at) < reach)
            .count()
    };
    // Where the brush was fully, the points are as dense as without a field: one a unit area.
    let length = (line[1][0] - line[0][0]).abs();
    let area = length * size / 2.0 + std::f64::consts::PI * (size / 4.0).powi(2);
    let found = near(&line, size / 4.0) as f64;
    assert!((found / area - 1.0).abs() < 0.1, "{found} points on {area}");
    browser.click("#paint-tool-road");
    changed(&browser, || browser.drag([x, y - 250], [30, 450]));
    let (road, width) = stroke(&browser, 1);
    assert_eq!(near(&road, width / 2.0), 0, "the road is free");
    // The request to paste has the field in it, and needs nothing that this server holds.
    browser.click("#tab-take");
    browser.until("document.documentElement.dataset.weighed");
    browser.allow_clipboard();
    let line = copied(&browser, "curl");
    let (body, other) = (
        line.split("-d '").nth(1).expect("a body"),
        Daemon::built_in(),
    );
    let body: Value = serde_json::from_str(body.trim_end_matches('\'')).expect("JSON");
    let answer = other.post("/v1/points:query", &body);
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert_same(&browser, &rows(answer.text()));
    run(&line, "curl", |text| assert_same(&browser, &rows(text)));
    // The address brings it back from a server that never saw the field, by one request more.
    let (hash, count) = (browser.hash(), browser.ready());
    browser.look(&other, &hash);
    assert_eq!((browser.hash(), browser.ready()), (hash, count));
    assert_eq!(browser.value("strew.paint.work.strokes.length"), 2);
    // An undone stroke is gone, and Back brings it again.
    browser.click("#paint-open");
    let without = changed(&browser, || browser.click("#paint-undo"));
    assert!(without > count);
    assert_eq!(
        changed(&browser, || drop(browser.value("history.back()"))),
        count
    );
    // Clear and nothing painted is left; undone, all of it is back.
    assert_eq!(changed(&browser, || browser.click("#paint-clear")), all);
    assert!(!browser.hash().contains("paint="));
    assert_eq!(changed(&browser, || browser.click("#paint-undo")), count);
    assert!(browser.hash().contains("paint="));
}

#[test]
fn a_request_to_take_away_holds_what_is_painted() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    let hash = "#at=0,0&span=40&layers=2&seed=18446744073709551615&2.amount=2&2.seed=4&2.clear=0.6\
                &paint=r(4:-9,-9/9,9)e(8,0.7:-10,8/10,8)";
    browser.look(&daemon, hash);
    // The address has no digest, so the page sends the field first.
    browser.click("#paint-open");
    let [x, y] = browser.middle("#brush");
    let count = changed(&browser, || browser.drag([x - 90, y - 150], [60, 0]));
    let body = browser.value("strew.take.request.body");
    let body: Value = serde_json::from_str(body.as_str().expect("text")).expect("JSON");
    assert_eq!(body["layers"][0]["seed"], u64::MAX);
    // A daemon that never held the field counts the same points.
    let other = Daemon::start(&["tables.embedded=true"]);
    let asked = json!({ "layers": body["layers"], "region": body["region"] });
    assert_eq!(other.post("/v1/count", &asked).json()["count"], count);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn keys_and_fingers_paint_too() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=40");
    browser.value("document.querySelector('#paint-open').focus()");
    browser.keys(&["\u{E007}"]);
    browser.until("document.activeElement.id === 'brush'");
    let right = "\u{E014}";
    changed(&browser, || {
        browser.keys(&[" ", right, right, right, right, right, " "]);
    });
    let (line, size) = stroke(&browser, 0);
    assert!(
        (line[1][0] - line[0][0] - 2.5 * size).abs() < 0.1 && line[1][1].abs() < 0.1,
        "{line:?}"
    );
    // A line that is given up leaves nothing.
    browser.keys(&[" ", right, "\u{E00C}"]);
    assert_eq!(browser.value("strew.paint.work.strokes.length"), 1);
    let [x, y] = browser.middle("#brush");
    changed(&browser, || browser.tap([x, y - 100]));
    assert_eq!(browser.value("strew.paint.work.strokes.length"), 2);
    let sizes = "[...document.querySelectorAll('#paint button')].filter((one) => one.offsetWidth > 0) \
         .filter((one) => one.offsetHeight < 44 || one.offsetWidth < 44).map((one) => one.textContent)";
    assert_eq!(browser.value(sizes), json!([]));
    browser.keys(&["\u{E00C}"]);
    browser.until(
        "document.querySelector('#brush').hidden && document.activeElement.id === 'paint-open'",
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn paint_goes_to_the_layer_that_is_picked() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(
        &daemon,
        "#at=0,0&span=60&layers=2&2.seed=2&2.color=3&tab=choose",
    );
    browser.click("#paint-open");
    browser.click("#paint-tool-road");
    let [x, y] = browser.middle("#brush");
    let strokes = |layer: usize| {
        browser.value(&format!(
            "(strew.session.state.layers[{layer}].paint.match(/r\\(/g) ?? []).length"
        ))
    };
    changed(&browser, || browser.drag([x - 200, y - 120], [400, 0]));
    assert_eq!([strokes(0), strokes(1)], [1, 0]);
    // The pen is down on the other layer before the server knows of the first stroke's field.
    browser.drag([x - 200, y - 60], [400, 0]);
    browser.click("#layer-1");
    browser.drag([x - 200, y], [400, 0]);
    browser.until("strew.session.state.layers[1].paint");
    browser.drag([x - 200, y + 60], [400, 0]);
    browser.until("strew.session.state.layers[1].paint.match(/r\\(/g).length === 2");
    assert_eq!([strokes(0), strokes(1)], [2, 2]);
    browser.click("#layer-0");
    assert_eq!(browser.value("strew.paint.work.strokes.length"), 2);
    changed(&browser, || browser.click("#paint-undo"));
    assert_eq!([strokes(0), strokes(1)], [1, 2]);
    browser.ready();
    assert_eq!(browser.errors(), Vec::<String>::new());
}
