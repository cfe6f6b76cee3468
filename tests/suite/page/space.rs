//! The page of points in space at `/space`: it draws the server's points, flies, and shows the line for curl.

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

const READY: &str = "document.documentElement.dataset.state === 'ready'";

/// Opens a volume that stands still.
fn space(daemon: &Daemon, browser: &Browser, more: &str) {
    browser.go(&daemon.url(&format!("/space#at=4,4,4&reach=8{more}")));
    browser.until(READY);
}

/// The address in the line for curl once it names a chunk.
fn requested(browser: &Browser, chunk: &str) -> String {
    let line = format!(
        "document.querySelector('#command').textContent.includes('{chunk}') && document.querySelector('#command').textContent"
    );
    let line = browser.until(&line);
    let line = line.as_str().expect("text");
    line.split('\'').nth(1).expect("an address").into()
}

/// Compares the points of the chunks in view with what the server answers for each: how many differ.
const DIFFERENT: &str = "await (async () => { \
    let different = 0; \
    for (const { size, cx, cy, cz, data } of strew.volume.chunks.wanted) { \
      const path = `/v1/space/chunks/${size}/${cx}/${cy}/${cz}?spacing=1&seed=7&format=csv`; \
      const lines = (await (await fetch(path)).text()).trim().split('\\n').slice(1); \
      const theirs = lines.flatMap((line) => line.split(',').slice(1, 4).map(Number).map(Math.fround)); \
      if (theirs.join() !== [...data].join()) different += 1; } \
    return different; })()";

#[test]
fn a_volume_is_the_servers_and_so_is_the_line_to_paste() {
    let Some((daemon, browser)) = looking(1100, 800) else {
        return;
    };
    space(&daemon, &browser, "");
    assert_eq!(browser.value(DIFFERENT), 0);
    let tally = browser.text("#tally");
    assert!(
        tally.contains("points in") && tally.contains("chunks"),
        "{tally}"
    );
    let address = requested(&browser, "/chunks/8/0/0/0?");
    let path = address
        .strip_prefix(&daemon.url(""))
        .expect("of this daemon");
    let chunk = daemon.get(path);
    assert_eq!(chunk.status, 200, "{path}");
    let count = chunk.text().trim().lines().count() - 1;
    let drawn = "strew.volume.chunks.wanted.find(({ cx, cy, cz }) => !cx && !cy && !cz).count";
    assert_eq!(browser.value(drawn), count);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn keys_fly_chunks_follow_and_the_address_keeps_the_place() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    space(&daemon, &browser, "&yaw=90&pitch=0&away=0&spacing=1");
    let before = browser.value("strew.volume.chunks.wanted[0].cx");
    browser.value("(document.querySelector('#view').focus(), 0)");
    let press = |kind: &str, key: &str| {
        let event = format!("new KeyboardEvent('{kind}', {{ key: '{key}', bubbles: true }})");
        browser.value(&format!(
            "(document.activeElement.dispatchEvent({event}), 0)"
        ));
    };
    press("keydown", "w");
    browser.until("strew.state.at[0].i >= 9");
    press("keyup", "w");
    browser.until(READY);
    assert_ne!(browser.value("strew.volume.chunks.wanted[0].cx"), before);
    assert_eq!(browser.value(DIFFERENT), 0);
    browser.until("parseFloat(location.hash.slice('#at='.length)) >= 9");
    // Far away there are points as well, and the same ones on the way back.
    browser.click("#jump");
    browser.until(&format!("{READY} && strew.state.at[2].i === 1e9"));
    requested(&browser, "/chunks/8/125000000/125000000/125000000?");
    browser.until("strew.volume.chunks.sums.points > 1000");
    browser.click("#jump");
    browser.until(&format!("{READY} && strew.state.at[0].i < 1000"));
    // The address of a place opens it.
    let hash = browser.until("location.hash.includes('away=0') && location.hash");
    browser.go("about:blank");
    browser.go(&daemon.url(&format!("/space{}", hash.as_str().expect("text"))));
    browser.until(READY);
    assert_eq!(browser.value("strew.state.away"), 0);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn wrong_values_are_said_at_their_fields_and_wrong_links_above() {
    let Some((daemon, browser)) = looking(640, 480) else {
        return;
    };
    space(&daemon, &browser, "");
    browser.choose("#seed", "x");
    browser.until("!document.querySelector('#wrong-seed').hidden");
    assert!(browser.text("#wrong-seed").contains("whole number"));
    browser.choose("#seed", "9");
    browser.until(
        "document.querySelector('#wrong-seed').hidden && \
         document.querySelector('#command').textContent.includes('seed=9')",
    );
    browser.until(READY);
    browser.go("about:blank");
    browser.go(&daemon.url("/space#at=1,2&seed=x&spacing=0"));
    browser.until(READY);
    let banner = browser.text("#banner");
    for word in ["spacing", "place", "seed"] {
        assert!(banner.contains(word), "{banner}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_busy_server_and_one_that_is_away_are_said() {
    let Some((daemon, browser)) = looking(640, 480) else {
        return;
    };
    space(&daemon, &browser, "");
    // Answers put in by the test; the page hears them as the server's.
    let answers = |with: &str| {
        browser.value(&format!(
            "(window.kept ??= fetch, window.fetch = {with}, 0)"
        ));
    };
    let seed = |seed: &str| browser.choose("#seed", seed);
    answers("async () => new Response('{}', { status: 503, headers: { 'retry-after': '1' } })");
    seed("21");
    browser.until("document.querySelector('#banner').textContent.includes('busy')");
    answers("kept");
    browser.until(&format!(
        "{READY} && !/busy|answer/.test(document.querySelector('#banner').textContent)"
    ));
    answers("async () => { throw new TypeError('no network'); }");
    seed("22");
    browser.until("document.querySelector('#banner').textContent.includes('does not answer')");
    answers("kept");
    browser.until(&format!(
        "{READY} && !/busy|answer/.test(document.querySelector('#banner').textContent)"
    ));
    assert_eq!(browser.value("strew.volume.chunks.layers[0].seed"), "22");
}

#[test]
fn nothing_turns_by_itself_where_less_motion_is_wanted() {
    let Some((daemon, browser)) = looking(640, 480) else {
        return;
    };
    browser.go(&daemon.url("/space"));
    browser.until(READY);
    assert_eq!(browser.value("strew.viewer.isTurning"), true);
    browser.reduce_motion();
    browser.go("about:blank");
    browser.go(&daemon.url("/space"));
    browser.until(READY);
    assert_eq!(browser.value("strew.viewer.isTurning"), false);
    // The button turns all the same.
    browser.click("#turn");
    browser.until("document.querySelector('#turn').getAttribute('aria-pressed') === 'true'");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
