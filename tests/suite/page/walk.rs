//! The walk at `/walk`: it draws the server's points, the same on the way back, and keys do all of it.

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

const READY: &str = "document.documentElement.dataset.state === 'ready'";

/// Opens a walk that stands still, drawn as coarsely as it can be.
fn walk(daemon: &Daemon, browser: &Browser, more: &str) {
    let hash = "#at=-126,0&yaw=20&fly=0&quality=0";
    browser.go(&daemon.url(&format!("/walk{hash}{more}")));
    browser.until(READY);
}

/// Goes where the button leads, and waits until points surround the first coordinate `x`.
fn jump(browser: &Browser, x: f64) {
    browser.click("#jump");
    browser.until(&format!("Math.abs(strew.world.around.x.i - {x}) < 2"));
    browser.until(READY);
}

/// The id of what Enter picks.
fn picked(browser: &Browser) -> String {
    browser.value("(strew.walker.canvas.focus(), 0)");
    browser.keys(&["\u{E007}"]);
    let id = browser.until("document.querySelector('#card').dataset.id");
    browser.keys(&["\u{E00C}"]);
    browser.until("document.querySelector('#card').hidden");
    id.as_str().expect("text").into()
}

/// Compares what stands in a leaf with the chunk that the server answers for it: `null` if they agree.
const COMPARED: &str = "(async (leaf) => { \
    const thing = strew.world.sets[0].built.get(`${leaf.level}/${leaf.cx}/${leaf.cy}`); \
    const path = `/v1/chunks/${leaf.size}/${leaf.cx}/${leaf.cy}?spacing=2&seed=7&format=csv&lod=${leaf.keep}`; \
    const lines = (await (await fetch(path)).text()).trim().split('\\n').slice(1); \
    const theirs = lines.map((line) => line.split(',').slice(1).map(Math.fround).join()).sort(); \
    const ours = []; \
    for (let i = 0; i < thing.floats.length; i += 10) ours.push(thing.floats.subarray(i, i + 2).join()); \
    ours.sort(); \
    return theirs.length > 500 && ours.join(' ') === theirs.join(' ') ? null : [ours.length, theirs.length]; })";

#[test]
fn what_stands_there_is_what_the_server_has_there() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    if browser.lacks_webgl2() {
        return;
    }
    walk(&daemon, &browser, "");
    let leaves = "strew.world.sets[0].leaves";
    for leaf in [
        format!("{leaves}[0]"),
        format!("{leaves}.find((one) => one.level === 1)"),
        format!("{leaves}.at(-1)"),
    ] {
        let difference = browser.value(&format!("await {COMPARED}({leaf})"));
        assert!(difference.is_null(), "{leaf}: {difference}");
    }
    let tally = browser.text("#tally");
    assert!(
        tally.contains("points drawn") && tally.contains("chunks"),
        "{tally}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn keys_walk_and_pick_and_the_same_trees_stand_there_on_the_way_back() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    if browser.lacks_webgl2() {
        return;
    }
    walk(&daemon, &browser, "");
    let press = |kind: &str, key: &str| {
        let event = format!("new KeyboardEvent('{kind}', {{ key: '{key}', bubbles: true }})");
        browser.value(&format!("document.activeElement.dispatchEvent({event})"));
    };
    // A tool that was clicked has the focus, and keys walk all the same.
    browser.click("#theme");
    press("keydown", "w");
    browser.until("strew.walker.y.i >= 1");
    press("keyup", "w");
    assert_eq!(browser.value("strew.walker.held.size"), 0);
    // How far the walk went depends on how quickly the key was let go.
    let start = browser
        .value("strew.walker.x.i")
        .as_f64()
        .expect("a number");
    let here = picked(&browser);
    let path = format!("/v1/points/{here}?spacing=2&seed=7");
    assert_eq!(daemon.get(&path).status, 200, "{path}");
    // Far away the walk works as it does here; the address has the place.
    jump(&browser, 1e9);
    let there = picked(&browser);
    assert_ne!(there, here);
    let path = format!("/v1/points/{there}?spacing=2&seed=7");
    let x = daemon.get(&path).json()["point"]["x"].as_f64();
    assert!((x.expect("a number") - 1e9).abs() < 100.0, "{x:?}");
    let nearest = format!("await {COMPARED}(strew.world.sets[0].leaves[0])");
    assert!(browser.value(&nearest).is_null());
    jump(&browser, start);
    assert_eq!(picked(&browser), here);
    browser.until(&format!(
        "Math.abs(parseFloat(location.hash.slice('#at='.length)) - {start}) < 2"
    ));
    let plane = browser.until("document.querySelector('#plane').getAttribute('href').slice(1)");
    assert!(
        plane.as_str().expect("text").contains("variants="),
        "{plane}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn without_graphics_there_is_a_map_and_a_sentence() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    walk(&daemon, &browser, "&map=1");
    assert!(browser.text("#banner").contains("WebGL2 is missing"));
    browser.until("Number(document.documentElement.dataset.drawn) > 500");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
