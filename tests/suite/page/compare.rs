//! The page `/compare`: its methods keep their definitions, one view moves all of them, and all of them are measured.

use serde_json::Value;

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

/// Opens the page, and waits until all that is shown is measured.
fn open(browser: &Browser, daemon: &Daemon, hash: &str) {
    browser.go("about:blank");
    browser.go(&daemon.url(&format!("/compare{hash}")));
    measured(browser);
}

fn measured(browser: &Browser) {
    browser.until("document.documentElement.dataset.measured");
}

/// A figure below a method, as a number.
fn figure(browser: &Browser, id: &str) -> f64 {
    let text = browser.text(&format!("#{id}")).replace(',', "");
    text.parse()
        .unwrap_or_else(|_| panic!("{id} is “{text}”, no number"))
}

/// The faults of the methods: their modules run in the page, on the seeds 1 to 3.
const FAULTS: &str = "(async () => {
  const { bridson, LEAST, white, made } = await import('/page/compare/made.js');
  const faults = [];
  const check = (holds, words) => holds || faults.push(words);
  const pairs = (points) => Array.from({ length: points.length / 2 }, (_, p) => [points[2 * p], points[2 * p + 1]]);
  const window = (x, y, width, height) => ({ x: { i: x, f: 0.25 }, y: { i: y, f: 0 }, width, height });
  const perCell = (points, left) => {
    const cells = new Map();
    for (const [x, y] of pairs(points)) {
      const cell = `${Math.floor(x + left)},${Math.floor(y)}`;
      cells.set(cell, (cells.get(cell) ?? 0) + 1);
    }
    return cells;
  };

  for (const seed of [1, 2, 3]) {
    const disks = pairs(bridson(seed, 60));
    const least = Math.min(...disks.map(([x, y], i) => Math.min(...disks.slice(i + 1)
      .map(([u, v]) => Math.hypot(x - u, y - v)), 9)));
    check(least >= LEAST, `Poisson disk: ${least} apart`);
    check(Math.abs(disks.length / 3600 - 1) < 0.03, `Poisson disk: ${disks.length} of 3600 points`);

    const counts = perCell(white(seed, window(0, 0, 100.75, 100)), 0.25);
    const of = (k) => [...counts.values()].filter((count) => count === k).length / 10075;
    const chances = [[1, Math.exp(-1)], [2, Math.exp(-1) / 2], [3, Math.exp(-1) / 6]];
    check(chances.every(([k, chance]) => Math.abs(of(k) - chance) < 0.02), `white: ${chances.map(([k]) => of(k))}`);
  }

  for (const id of ['white', 'poisson']) {
    const points = (x, y, side) => pairs(made(id, 5, window(x, y, side, side)).points);
    const [large, part] = [points(-20, -30, 40), points(-10, -25, 20)];
    const within = large.filter(([x, y]) => x >= 10 && x < 30 && y >= 5 && y < 25).map(([x, y]) => `${(x - 10).toFixed(6)},${(y - 5).toFixed(6)}`);
    const same = part.map(([x, y]) => `${x.toFixed(6)},${y.toFixed(6)}`);
    check(within.sort().join() === same.sort().join(), `${id}: windows differ`);
    check(Math.abs(large.length - 1600) < 150, `${id}: ${large.length} of 1600 points`);
    const far = made(id, 5, window(1e9, 0, 50, 50));
    const isBounded = id === 'poisson';
    check(far.isWhole !== isBounded && (far.points.length === 0) === isBounded, `${id} far away`);
  }
  return faults;
})()";

#[test]
fn methods_are_what_they_say() {
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    open(&browser, &daemon, "#at=0,0");
    assert_eq!(browser.value(FAULTS), Value::from(Vec::<String>::new()));
    // Distances and counts as they are known of each kind, in mean spacings.
    for (id, least, mean) in [
        ("strew", 0.6, 0.83..0.92),
        ("poisson", 0.76, 0.82..0.88),
        ("white", 0.0, 0.48..0.52),
    ] {
        let count = figure(&browser, &format!("count-{id}"));
        assert!((count - 1e4).abs() < 400.0, "{id}: {count}");
        let found = figure(&browser, &format!("least-{id}"));
        assert!(found >= least, "{id}: {found}");
        let found = figure(&browser, &format!("mean-{id}"));
        assert!(mean.contains(&found), "{id}: {found}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn what_each_method_has_to_make_is_counted() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    open(&browser, &daemon, "#at=0,0&span=40");
    // The window holds as many points as the server counts, and Strew makes no others.
    let window = "(({ x, y, unit, width, height }) => [-1, 1].flatMap((side) => \
        [x.i + x.f + side * width * unit / 2, y.i + y.f + side * height * unit / 2]).join())(strew.joint.view)";
    let window = browser.value(window);
    let path = format!(
        "/v1/count?bbox={}&spacing=1&seed=1",
        window.as_str().expect("text")
    );
    let count = daemon.get(&path).json()["count"].as_f64().expect("a count");
    assert!(
        (figure(&browser, "made-strew") - count).abs() <= 1.0,
        "{count}"
    );
    let why = browser.text("#price-strew");
    assert!(why.ends_with(&browser.text("#made-strew")), "{why}");
    // All of its square, for any part of it.
    assert!((figure(&browser, "made-poisson") - 65_536.0).abs() < 1000.0);
    // A billion units away Strew makes as many as here, and everything up to there comes first for the other.
    browser.click("#far");
    browser.until("document.documentElement.dataset.measured.startsWith('1000000000,')");
    browser.until("document.querySelector('#made-poisson').textContent === '4 × 10¹⁸'");
    assert!(browser.text("#why-poisson").contains(" in this browser"));
    assert!((figure(&browser, "made-strew") - count).abs() < 60.0);
    assert_eq!(browser.text("#far"), "Back to the origin");
    browser.click("#far");
    browser.until("strew.joint.view.x.i === 0");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_server_that_is_away_is_said_once_and_what_is_drawn_stays() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    open(&browser, &daemon, "#at=0,0&span=30");
    let shown = browser.text("#made-strew");
    browser.value("(window.fetch = () => Promise.reject(new TypeError('away')), 0)");
    browser.value("(strew.joint.lookAt({ i: 5000, f: 0 }, { i: 0, f: 0 }), 0)");
    browser.until("!document.querySelector('#banner').hidden");
    browser.value("(strew.joint.lookAt({ i: 0, f: 0 }, { i: 0, f: 0 }), 0)");
    browser.until(&format!(
        "document.querySelector('#made-strew').textContent === '{shown}'"
    ));
    // Another choice takes nothing of it back, and the other methods go on.
    browser.choose("#seed", "2");
    browser.until("document.querySelector('#made-strew').textContent === '…'");
    let words = "The server does not answer. This page tries again by itself";
    assert!(browser.text("#banner").starts_with(words));
    browser.until("document.querySelector('#made-poisson').textContent.length > 5");
}

#[test]
fn one_view_moves_all_and_stands_in_the_address() {
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    open(&browser, &daemon, "#at=0,0&span=30");
    let plane = |id: &str| {
        let place = browser.value(&format!(
            "(() => {{ const box = document.querySelector('#plane-{id}').getBoundingClientRect(); \
             return [box.left + box.width / 2, box.top + box.height / 2, Math.min(box.width, box.height)].map(Math.round); }})()"
        ));
        serde_json::from_value::<[i32; 3]>(place).expect("a place")
    };
    let [x, y, side] = plane("white");
    browser.drag([x, y], [-side / 4, 0]);
    browser.until(
        "strew.joint.view.x.i === 7 && document.documentElement.dataset.measured.startsWith('7.')",
    );
    // The drawings of all have moved: the middle of each sheet is the view's.
    let shown = browser.value(
        "strew.panels.map((panel) => panel.sheets.front.parts.some(({ done }) => done > 0))",
    );
    assert_eq!(shown, serde_json::json!([true, true, true]));
    browser.wheel([x, y], -300);
    browser.until("strew.joint.state.span < 20");
    browser.value("document.querySelector('#plane-strew').focus()");
    browser.keys(&["\u{E012}"]);
    browser.until("strew.joint.view.x.i < 7");
    browser.choose("#seed", "9");
    browser.until("location.hash.includes('seed=9')");
    measured(&browser);
    let (hash, least) = (browser.hash(), browser.text("#least-strew"));
    open(&browser, &daemon, &hash);
    assert_eq!(browser.hash(), hash);
    assert_eq!(browser.text("#least-strew"), least);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn far_away_on_a_phone_bounded_methods_say_that_they_end() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    open(&browser, &daemon, "#at=1e9,0.5&span=20");
    assert_eq!(
        browser.value("document.documentElement.scrollWidth <= innerWidth"),
        true
    );
    assert_eq!(browser.value("strew.panels[1].outside.hidden"), false);
    assert_eq!(
        browser.text("#least-poisson"),
        "–",
        "there is nothing to measure"
    );
    assert!(figure(&browser, "count-strew") > 9000.0);
    let sizes = "[...document.querySelectorAll('button')].filter((one) => one.offsetWidth > 0) \
         .filter((one) => one.offsetHeight < 44 || one.offsetWidth < 44).map((one) => one.textContent)";
    assert_eq!(browser.value(sizes), Value::from(Vec::<String>::new()));
    browser.choose("#jump-at", "1e15, 0");
    browser.value("document.querySelector('#jump').requestSubmit()");
    browser.until("!document.querySelector('#banner').hidden");
    assert!(browser.text("#banner").contains("too far out"));
    // A meaningless hash leaves the defaults.
    open(&browser, &daemon, "#at=1e18,0&span=-3&seed=x&profile=%22");
    assert_eq!(browser.value("strew.joint.view.x.i"), 1_000_000_000);
    assert!(browser.text("#banner").contains("“seed=x”"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}
