//! The view: it shows the points, moves, and stays sharp far from the origin.

use serde_json::Value;
use strew_testkit::wait::until;

use crate::support::{browser::looking, daemon::Daemon};

#[test]
fn the_page_shows_its_points_without_console_errors() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "");
    let count = browser.ready();
    assert!((800..1300).contains(&count), "{count}");
    assert_eq!(browser.in_view().len() as u64, count);
    assert!(browser.text("#tally").contains("points in view"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn dragging_zooming_and_keys_move_the_view_and_its_url() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=10,20&span=40");
    browser.drag([900, 400], [-200, 100]);
    browser.until("location.hash.includes('at=20,25')");
    browser.ready();
    let before = browser.ready();
    browser.wheel([816, 400], 300);
    browser.until("strew.plane.span > 60");
    let after = browser.ready();
    assert!(2 * after > 3 * before, "{before} {after}");
    browser.click("#plane");
    browser.keys(&["\u{E014}", "\u{E013}", "+"]);
    browser.until("strew.plane.span < 60 && strew.plane.view.x.i > 25");
    browser.ready();
    // After all of that, the page shows the number of points that the server counts.
    let count = browser.ready();
    let shown = browser.in_view().len() as u64;
    assert!(count.abs_diff(shown) <= 1, "{count} {shown}");
}

#[test]
fn a_jump_to_1e12_is_as_sharp_as_the_origin_and_back_returns() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=8");
    browser.click("#jump-at");
    let keys: Vec<String> = "1e12, -1e12".chars().map(String::from).collect();
    browser.keys(&keys.iter().map(String::as_str).collect::<Vec<_>>());
    browser.click("#jump button");
    browser.until("strew.plane.view.x.i === 1e12");
    let count = browser.ready();
    let far = browser.in_view();
    assert_eq!(far.len() as u64, count);
    // Points of seed 1 are at least 0.57 apart. Here doubles are 1e-4 apart, the page's own
    // coordinates 1e-7. The server takes the corner of a chunk as a double, so its points agree
    // within 2e-4.
    for (i, a) in far.iter().enumerate() {
        for b in &far[..i] {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) > 0.57, "{a:?} {b:?}");
        }
    }
    let fine = |v: f64| ((v * 8192.0).fract() != 0.0) as usize;
    let digits: usize = far.iter().map(|p| fine(p[0]) + fine(p[1])).sum();
    assert!(digits > far.len(), "coordinates are rounded: {digits}");
    let exact = chunk_points(&daemon);
    assert!(
        exact
            .iter()
            .filter(|p| p[0].abs() < 3.9 && p[1].abs() < 3.9)
            .all(|p| {
                far.iter()
                    .any(|q| (p[0] - q[0]).abs() < 2e-4 && (p[1] - q[1]).abs() < 2e-4)
            }),
        "{exact:?} {far:?}"
    );
    browser.value("history.back()");
    browser.until("strew.plane.view.x.i === 0");
    assert!(browser.ready() > 0);
}

/// The server's points around (1e12, -1e12), relative to there: the four chunks of size 8 that
/// meet.
fn chunk_points(daemon: &Daemon) -> Vec<[f64; 2]> {
    let mut all = vec![];
    for (dx, dy) in [(0, 0), (-1, 0), (0, -1), (-1, -1)] {
        let cell = 125_000_000_000i64;
        let path = format!(
            "/v1/chunks/8/{}/{}?spacing=1&seed=1&format=f32",
            cell + dx,
            -cell + dy
        );
        let answer = daemon.get(&path);
        for bytes in answer.body.chunks_exact(8) {
            let read = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four"));
            let [x, y] = [read(&bytes[..4]), read(&bytes[4..])].map(f64::from);
            all.push([x + 8.0 * dx as f64, y + 8.0 * dy as f64]);
        }
    }
    all
}

#[test]
fn beyond_a_million_points_the_page_thins_and_says_so() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=1500&seed=0");
    let count = browser.ready();
    assert!((400_000..=1_000_000).contains(&count), "{count}");
    let text = browser.text("#tally");
    assert!(
        text.contains("too many to draw") && text.contains("lowest rank"),
        "{text}"
    );
    assert!(browser.in_view().len().abs_diff(count as usize) < 20);
}

#[test]
fn beyond_a_64th_of_the_points_density_is_gray() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    // The least share at which points are drawn has no rows; see docs/quality.md.
    browser.look(&daemon, "#at=0,0&span=7300");
    assert_eq!(browser.value("strew.plane.keep"), 1.0 / 64.0);
    let number = |value: Value| value.as_f64().expect("a number");
    let mean = "(() => { const c = strew.plane.canvas; \
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
        let sum = 0; for (let i = 0; i < d.length; i += 4) sum += d[i]; return 4 * sum / d.length; })()";
    // Points have almost faded by then, and begin to at one in 8: no step is seen where they end.
    let last = number(browser.value(mean));
    let gray = |span: u32| {
        number(browser.value(&format!(
            "(await import('/page/grid.js')).grayOf({{ width: 800, height: 800, unit: {span} / 800 }}, [1])"
        )))
    };
    assert!((0.9..1.0).contains(&number(browser.value("strew.plane.gray"))));
    assert_eq!([gray(1000), gray(2828), gray(8001)], [0.0, 0.0, 1.0]);
    assert!((0.45..0.55).contains(&gray(4757)));
    browser.look(&daemon, "#at=0,0&span=20000");
    assert!(browser.text("#tally").contains("gray shows how dense"));
    let beyond = number(browser.value(mean));
    assert!((last - beyond).abs() < 4.0, "{last} {beyond}");
    let colors = "(() => { const c = strew.plane.canvas; \
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; return new Set(new Uint32Array(d.buffer)).size; })()";
    assert_eq!(browser.value(colors), 1);
    assert_eq!(browser.value("strew.plane.chunks.wanted.length"), 0);
    // A field is drawn in its layer's color, by its means where it is finer than pixels.
    browser.choose("#field", "forest");
    browser.until("!strew.shade.canvas.hidden && strew.shade.canvas.dataset.missing === '0'");
    browser.until("document.querySelector('#tally').textContent.startsWith('Too many points in view to count')");
    let spread = "(() => { const c = strew.shade.canvas; \
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
        const all = Array.from({ length: d.length / 4 }, (_, i) => d[4 * i + 3]); \
        const mean = all.reduce((a, b) => a + b) / all.length; \
        return [mean, Math.sqrt(all.reduce((a, b) => a + (b - mean) ** 2, 0) / all.length)]; })()";
    let spread = browser.value(spread);
    let share = |i: usize| spread[i].as_f64().expect("a share");
    assert!(share(0) > 30.0 && share(1) < 4.0, "{spread}");
    browser.value("strew.plane.zoom(64)");
    assert!(browser.ready() > 10_000);
    browser.until("strew.shade.canvas.hidden");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_server_that_goes_away_is_waited_for() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30");
    let address = daemon.address();
    drop(daemon);
    browser.drag([950, 350], [-580, 0]);
    browser.until("document.documentElement.dataset.presence === 'gone'");
    assert!(
        browser
            .text("#banner")
            .contains("The server does not answer")
    );
    assert_eq!(
        browser.value("document.querySelector('#banner').hidden"),
        false
    );
    let again = until("the port is free", || Daemon::built_in_at(address));
    browser.until("document.documentElement.dataset.presence === 'here'");
    let count = browser.ready();
    assert_eq!(browser.in_view().len() as u64, count);
    assert_eq!(
        browser.value("document.querySelector('#banner').hidden"),
        true
    );
    drop(again);
}

#[test]
fn a_tapped_point_shows_its_details() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=100,-40&span=12&angle=1&variant=1");
    browser.click("#plane");
    let id = browser.until("!document.querySelector('#card').hidden && document.querySelector('#card h2')?.textContent");
    let id = id.as_str().expect("an id");
    let known = daemon.get(&format!(
        "/v1/points/{id}?spacing=1&seed=1&attributes=angle"
    ));
    assert_eq!(known.status, 200, "{}", known.text());
    let point = &known.json()["point"];
    let card = browser.text("#card");
    assert!(card.contains(&point["x"].to_string()), "{card}");
    assert!(card.contains("angle") && card.contains("variant"), "{card}");
    assert_eq!(
        browser.value("document.querySelectorAll('#card tr').length"),
        8
    );
}

/// Run by hand on a quiet machine:
/// `cargo test --release --test suite -- --ignored --nocapture frames`.
#[test]
#[ignore = "a measurement, for a quiet machine"]
fn frames_of_a_drag_over_100_000_points() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=293");
    let count = browser.ready();
    let script = "new Promise((resolve) => { const costs = [], gaps = []; let last = 0, n = 0; \
        const step = (now) => { if (last) gaps.push(now - last); last = now; n += 1; \
        strew.plane.drag(n % 240 < 120 ? -7 : 7, n % 160 < 80 ? 4 : -4); \
        strew.plane.paint(true); costs.push(strew.plane.cost); \
        if (n < 480) requestAnimationFrame(step); else resolve([costs, gaps]); }; \
        requestAnimationFrame(step); })";
    let measured = browser.value(script);
    let sorted = |i: usize| {
        let list = measured[i].as_array().expect("a list").iter();
        let mut list: Vec<f64> = list.filter_map(Value::as_f64).collect();
        list.sort_by(f64::total_cmp);
        let at = |share: f64| list[((list.len() - 1) as f64 * share) as usize];
        (at(0.5), at(0.95), at(1.0))
    };
    let ((median, p95, most), gaps) = (sorted(0), sorted(1));
    eprintln!(
        "{count} points in view: a frame takes {median:.1} ms (median), {p95:.1} ms \
         (95 %), {most:.1} ms (most); frames are {:.1} ms apart, {:.1} ms (95 %)",
        gaps.0, gaps.1
    );
    assert!(median < 16.0 && p95 < 16.0, "{median} {p95}");
}
