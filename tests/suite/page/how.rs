//! The essay at `/how`: its figures move by themselves in view only, compute what the server does, take pointers and
//! keys, stand still where less motion is wanted, and stay small.

use serde_json::{Value, json};
use strew_testkit::http1;

use crate::support::{
    browser::{
        Browser,
        key::{LEFT, RIGHT},
        looking,
    },
    daemon::Daemon,
};

const FIGURES: [&str; 10] = [
    "chance", "race", "row", "indices", "same", "blocks", "vectors", "found", "seeds", "served",
];

fn open(browser: &Browser, daemon: &Daemon) {
    browser.go("about:blank");
    browser.go(&daemon.url("/how"));
    browser.until("document.documentElement.dataset.state === 'ready'");
}

fn scroll_to(browser: &Browser, id: &str) {
    browser.value(&format!(
        "(document.querySelector('#{id}').scrollIntoView({{ block: 'center' }}), 0)"
    ));
}

fn until_state(browser: &Browser, id: &str, state: &str) {
    browser.until(&format!(
        "document.querySelector('#{id}').dataset.state === '{state}'"
    ));
}

/// Clicks into a figure at a place, as shares of its canvas.
fn click_at(browser: &Browser, id: &str, [x, y]: [f64; 2]) {
    scroll_to(browser, id);
    let place = browser.value(&format!(
        "(() => {{ const b = document.querySelector('#{id} canvas').getBoundingClientRect(); \
         return [b.left + b.width * {x}, b.top + b.height * {y}].map(Math.round); }})()"
    ));
    browser.drag(serde_json::from_value(place).expect("a place"), [0, 0]);
}

#[test]
fn a_figure_moves_while_it_is_in_view() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    open(&browser, &daemon);
    assert_eq!(browser.value("strew.figures.race.pieces[0].length"), 0);
    for (id, moved) in [
        ("chance", "chance.fallen > 3"),
        ("race", "race.pieces[0].length > 3"),
        ("row", "row.at > 0"),
        ("indices", "indices.walked > 3"),
        ("same", "same.laid > 1"),
        ("blocks", "blocks.radius > 1"),
        ("vectors", "vectors.share > 0.1"),
        ("found", "found.round > 3"),
        ("seeds", "seeds.stop > 0"),
    ] {
        scroll_to(&browser, id);
        browser.until(&format!("strew.figures.{moved}"));
        scroll_to(&browser, "served");
        let state = format!("document.querySelector('#{id}').dataset.state");
        browser.until(&format!("{state} === 'resting' || {state} === 'over'"));
    }
    // Its button stops a figure, lets it go on, and plays it again.
    scroll_to(&browser, "row");
    until_state(&browser, "row", "moving");
    browser.click("#row .play");
    until_state(&browser, "row", "resting");
    assert_eq!(browser.text("#row .play"), "Play");
    browser.click("#row .play");
    until_state(&browser, "row", "moving");
    browser.value("(strew.stages[2].take(), 0)");
    assert_eq!(browser.text("#row .play"), "Play again");
    browser.click("#row .play");
    until_state(&browser, "row", "moving");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn figures_stand_at_their_ends_where_less_motion_is_wanted_and_on_paper() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    let all_over = "strew.stages.every(({ isOver }) => isOver)";
    open(&browser, &daemon);
    assert_eq!(browser.value(all_over), false);
    browser.value("(dispatchEvent(new Event('beforeprint')), 0)");
    assert_eq!(browser.value(all_over), true);
    let theme = "document.documentElement.dataset.theme ?? 'none'";
    assert_eq!(browser.value(theme), "light");
    browser.value("(dispatchEvent(new Event('afterprint')), 0)");
    assert_eq!(browser.value(theme), "none");
    browser.reduce_motion();
    open(&browser, &daemon);
    assert_eq!(browser.value(all_over), true);
    assert_eq!(browser.value("strew.figures.race.open.length"), 0);
    for id in FIGURES {
        scroll_to(&browser, id);
        browser.until(&format!(
            "document.querySelector('#{id} .said').textContent"
        ));
    }
    // Where points move after a choice, they are at once where it leads.
    browser.choose("#seeds-warp", "2");
    browser.until("document.querySelector('#seeds-said').textContent.includes('warp 2')");
    assert_eq!(browser.value("strew.figures.seeds.share"), 1);
}

#[test]
fn what_the_figures_claim_is_so() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    browser.reduce_motion();
    open(&browser, &daemon);
    // Every cell of the even points has three, four or five.
    scroll_to(&browser, "chance");
    let counts = "(() => { const { strew } = globalThis.strew.figures.chance; const cells = new Array(25).fill(0); \
        for (const [x, y] of strew) cells[Math.floor(y / 2) * 5 + Math.floor(x / 2)] += 1; \
        return strew.length === 100 && cells; })()";
    let counts = browser.until(counts);
    let counts: Vec<u64> = serde_json::from_value(counts).expect("counts");
    assert!(
        counts.iter().all(|count| (3..=5).contains(count)),
        "{counts:?}"
    );
    // Two pieces that are made at once clash, and each alone does not.
    let closest = "(points) => Math.min(...points.flatMap((a, i) => points.slice(i + 1).map((b) => Math.hypot(a[0] - b[0], a[1] - b[1]))))";
    let least = |points: &str| {
        let value = browser.value(&format!("({closest})(strew.figures.race.{points})"));
        value.as_f64().expect("a distance")
    };
    assert!(least("pieces[0]") >= 0.098 && least("pieces[1]") >= 0.098);
    assert_ne!(browser.value("strew.figures.race.clashes.length"), 0);
    browser.click("#race-kind button:last-child");
    assert_eq!(browser.value("strew.figures.race.clashes.length"), 0);
    assert!(least("pieces.flat()") >= 0.098);
    // Points of a color have the same neighbors within the frame; others do not.
    let different = "(() => { const { pattern, alike } = strew.figures.same; const of = ([x, y]) => { let all = ''; \
        for (let j = -6; j <= 6; j += 1) for (let i = -6; i <= 6; i += 1) all += Number(pattern.has(x + i, y + j)); return all; }; \
        return new Set(alike.map(of)).size; })()";
    assert_eq!(browser.value(different), 1);
    assert_eq!(browser.value("strew.figures.same.alike.length > 20"), true);
    browser.click("#same-kind button:last-child");
    assert_ne!(browser.value(different), 1);
    // Pushes move points apart.
    let apart = browser
        .value("strew.figures.found.least")
        .as_f64()
        .expect("a distance");
    assert!(apart > 0.6, "{apart}");
    // The numbers of the text, one of them dragged.
    scroll_to(&browser, "blocks");
    let number = browser.middle("[data-drag='blocks-radius']");
    browser.drag(number, [60, 0]);
    assert_ne!(browser.value("strew.figures.blocks.radius"), 20);
    browser.choose("#blocks-radius", "20");
    assert!(
        browser
            .text("#blocks-said")
            .contains("27 × 27 = 729 blocks")
    );
    let map = daemon.get("/v1/pattern/map?radius=100").json();
    assert_eq!(map["intervals"], 129);
    let table = &daemon.get("/v1/profiles/blue").json()["table"];
    assert_eq!(table["blocks"], 16_641);
    let kilobytes = table["bytes"].as_f64().expect("a size") / 1000.0;
    assert_eq!(kilobytes.round(), 169.0);
    assert!(browser.text("main").contains("169 kilobytes"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn hands_blocks_and_vectors_are_the_servers() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    open(&browser, &daemon);
    // Two points of a block, far from each other, have one vector.
    scroll_to(&browser, "vectors");
    browser.until("strew.figures.vectors.isAlike");
    let before = browser.text("#vectors-said");
    click_at(&browser, "vectors", [0.08, 0.15]);
    browser.until(&format!(
        "document.querySelector('#vectors-said').textContent !== {}",
        json!(before)
    ));
    browser.until("strew.figures.vectors.isAlike");
    // The block that the page computes is the server's, near the origin and far away.
    scroll_to(&browser, "served");
    browser.until("document.querySelector('#served-answer').textContent");
    let check = || {
        assert_eq!(browser.value("strew.figures.served.isAlike"), true);
        let command = browser.text("#served-command");
        let address = command.split('\'').nth(1).expect("an address").to_owned();
        let path = address
            .strip_prefix(&daemon.url(""))
            .expect("of this daemon");
        let answer: Value =
            serde_json::from_str(&browser.text("#served-answer")).expect("an answer");
        assert_eq!(daemon.get(path).json()["point"], answer, "{path}");
        answer
    };
    let near = check();
    click_at(&browser, "served", [0.1, 0.2]);
    browser.until(&format!(
        "!document.querySelector('#served-answer').textContent.includes({})",
        near["id"]
    ));
    assert_ne!(check(), near);
    browser.click("#served-far");
    browser.until("JSON.parse(document.querySelector('#served-answer').textContent).x > 9e8");
    check();
    assert!(browser.text("#served-steps").contains("both in the gate"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn figures_take_pointers_keys_and_sliders() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    open(&browser, &daemon);
    browser.choose("#row-place", "1000000");
    let said = browser.text("#row-said");
    assert!(
        said.contains("1,000,000 × 294.1154273° = 294,115,427.3°"),
        "{said}"
    );
    browser.choose("#row-angle", "200");
    assert_ne!(browser.text("#row-said"), said);
    // Arrow keys choose places and points; what they change is read out.
    for (id, member) in [
        ("row", "at"),
        ("indices", "at"),
        ("same", "point"),
        ("blocks", "point"),
    ] {
        scroll_to(&browser, id);
        browser.value(&format!(
            "(document.querySelector('#{id} canvas').focus(), 0)"
        ));
        let at = format!("String(strew.figures.{id}.{member})");
        let before = browser.value(&at);
        browser.keys(&[RIGHT]);
        browser.until(&format!("{at} !== {before}"));
        browser.keys(&[LEFT]);
        let live = format!("document.querySelector('#{id} .said').getAttribute('aria-live')");
        assert_eq!(browser.value(&live), "polite", "{id}");
    }
    // A finger moves the ring, and the figure leaves it there.
    click_at(&browser, "chance", [0.25, 0.3]);
    until_state(&browser, "chance", "over");
    let ring = browser.value("strew.figures.chance.ring");
    let high = ring[1].as_f64().expect("a coordinate");
    assert!(high > 5.0, "{ring}");
    // The page is no wider than the window.
    assert_eq!(
        browser.value("document.documentElement.scrollWidth <= innerWidth"),
        true
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_server_that_is_busy_or_away_is_said_and_waited_for() {
    let Some((daemon, browser)) = looking(1000, 700) else {
        return;
    };
    open(&browser, &daemon);
    scroll_to(&browser, "served");
    browser.until("document.querySelector('#served-answer').textContent");
    // Answers put in by the test; the page hears them as the server's.
    let answers = |with: &str| {
        browser.value(&format!(
            "(window.kept ??= fetch, window.fetch = {with}, 0)"
        ));
    };
    let said = |words: &str| {
        browser.until(&format!(
            "document.querySelector('#served-said').textContent.includes('{words}')"
        ));
    };
    answers("async () => new Response('{}', { status: 503, headers: { 'retry-after': '1' } })");
    click_at(&browser, "served", [0.1, 0.2]);
    said("busy");
    answers("kept");
    said("stands below");
    answers("async () => { throw new TypeError('no network'); }");
    click_at(&browser, "served", [0.9, 0.8]);
    said("does not answer");
    answers("kept");
    said("stands below");
}

#[test]
fn nothing_jumps_and_little_is_sent() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    open(&browser, &daemon);
    browser.value(
        "(window.shift = 0, new PerformanceObserver((list) => list.getEntries().filter((e) => !e.hadRecentInput) \
         .forEach(({ value }) => (window.shift += value))).observe({ type: 'layout-shift', buffered: true }), 0)",
    );
    for id in FIGURES {
        scroll_to(&browser, id);
        browser.until(&format!(
            "document.querySelector('#{id} .said').textContent"
        ));
    }
    let shift = browser.value("window.shift").as_f64().expect("a sum");
    assert!(shift <= 0.05, "{shift}");
    let packed = http1::get(
        daemon.address(),
        "/page/joined/how.js",
        &[("accept-encoding", "gzip")],
    );
    assert_eq!(packed.header("content-encoding"), "gzip");
    assert!(packed.body.len() <= 30_000, "{}", packed.body.len());
}
